//! Pairs of boundaries at a given gap, and the errors of added mass and force there.

use crate::{at_start, body, link, wall};
use nekton::Sim;
use nekton::scene::{Body, Quadrature, Scene, Shape, Wall};

/// A scene with one gap to be set.
pub struct Case {
    /// Name in tables.
    pub name: &'static str,
    /// Bodies: shape and pose.
    pub bodies: &'static [(Shape<'static, f64>, [f64; 3])],
    /// Pose of the last body: a point on a line, and the direction in which the gap opens.
    pub last: (Shape<'static, f64>, [f64; 3], [f64; 2]),
    /// Tank: shape and position.
    pub tank: Option<(Shape<'static, f64>, [f64; 2])>,
    /// Obstacle: shape and position.
    pub obstacle: Option<(Shape<'static, f64>, [f64; 2])>,
}

/// Added mass (by columns), force, and the indicators (mass, force).
pub type Values = (Vec<f64>, Vec<f64>, [f64; 2]);

impl Case {
    /// Evaluates the scene with the last body at distance `shift` along its line.
    pub fn at<T>(
        &self,
        shift: f64,
        nodes: usize,
        quadrature: Quadrature,
        circulation: &[f64],
        then: impl FnOnce(&mut Sim<'_, f64>) -> T,
    ) -> T {
        let (shape, pose, d) = self.last;
        let last = (shape, [pose[0] + shift * d[0], pose[1] + shift * d[1], pose[2]]);
        let all: Vec<_> = self.bodies.iter().copied().chain([last]).collect();
        let gamma = |i: usize| circulation.get(i).copied().unwrap_or(0.0);
        let links: Vec<_> = all
            .iter()
            .enumerate()
            .map(|(i, (s, _))| [nekton::scene::Link { circulation: gamma(i), ..link(*s, 1.0, nodes) }])
            .collect();
        let velocities = [[0.3, -0.5, 0.7], [-0.2, 0.4, 0.9], [0.5, 0.1, -0.6]];
        let bodies: Vec<Body<'_, f64>> =
            all.iter().zip(&links).zip(velocities).map(|(((_, pose), links), v)| body(links, *pose, v)).collect();
        let tank = self.tank.map(|(s, p)| wall(s, p, 0.0, nodes));
        let obstacles: Vec<Wall<'_, f64>> = self.obstacle.iter().map(|(s, p)| wall(*s, *p, 0.0, nodes)).collect();
        let scene = Scene { quadrature, tank, obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.0) };
        then(&mut at_start(&scene).view())
    }

    /// How far along its line the last body is when the smallest gap is as wanted.
    pub fn shift(&self, gap: f64) -> f64 {
        let mut shift = gap + 0.1;
        for _ in 0..80 {
            shift += gap - self.at(shift, 64, Quadrature::Plain, &[], |sim| sim.gap().distance);
        }
        shift
    }

    /// [`Case::values`], or what refuses them.
    pub fn try_values(&self, shift: f64, nodes: usize, quadrature: Quadrature) -> nekton::Result<Values> {
        self.at(shift, nodes, quadrature, &[], |sim| {
            let n = crate::size(sim);
            let (mut mass, mut force) = (vec![0.0; n * n], vec![0.0; n]);
            sim.added_mass(&mut mass)?;
            sim.christoffel(&mut force)?;
            let r = sim.resolution()?;
            Ok((mass, force, [r.mass, r.force]))
        })
    }

    /// Added mass, force and indicators.
    pub fn values(&self, shift: f64, nodes: usize, quadrature: Quadrature) -> Values {
        self.try_values(shift, nodes, quadrature).unwrap_or_else(|error| panic!("not evaluated: {error}"))
    }
}

/// Largest difference, relative to the largest entry.
pub fn error(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / size
}

const fn ellipse(a: f64, b: f64) -> Shape<'static, f64> {
    Shape::Ellipse { a, b }
}

const fn rectangle(width: f64, height: f64, radius: f64) -> Shape<'static, f64> {
    Shape::Rectangle { width, height, radius: Some(radius) }
}

const UP: [f64; 2] = [0.0, 1.0];
const ORIGIN: [f64; 3] = [0.0; 3];
const DISC: Shape<'static, f64> = ellipse(1.0, 1.0);
const FLAT: Shape<'static, f64> = ellipse(1.0, 0.1);
const THIN: Shape<'static, f64> = ellipse(1.0, 0.01);
const BAR: Shape<'static, f64> = rectangle(2.0, 0.2, 0.002);

/// The cases of the table.
pub const CASES: [Case; 11] = [
    Case {
        name: "two discs",
        bodies: &[(DISC, ORIGIN)],
        last: (DISC, [2.0, 0.0, 0.0], [1.0, 0.0]),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "two discs, turned",
        bodies: &[(DISC, [0.0, 0.0, -2.345])],
        last: (DISC, [2.0, 0.0, 1.234], [1.0, 0.0]),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "ellipses 1:.5 and .7:.4",
        bodies: &[(ellipse(1.0, 0.5), ORIGIN)],
        last: (ellipse(0.7, 0.4), [0.2, 0.9, 0.1], UP),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "ellipse at a tank wall",
        bodies: &[],
        last: (ellipse(1.0, 0.5), [0.3, 1.0, 0.0], [0.0, -1.0]),
        tank: Some((ellipse(2.0, 1.5), [0.3, 0.0])),
        obstacle: None,
    },
    Case {
        name: "three bodies",
        bodies: &[(ellipse(1.0, 0.5), ORIGIN), (ellipse(0.7, 0.4), [0.2, 0.912, 0.1])],
        last: (ellipse(0.6, 0.6), [0.1, -1.1, 0.4], [0.0, -1.0]),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "1:10 face to face",
        bodies: &[(FLAT, ORIGIN)],
        last: (FLAT, [0.1, 0.2, 0.0], UP),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "1:10 oblique",
        bodies: &[(FLAT, ORIGIN)],
        last: (FLAT, [0.3, 0.27, 0.15], UP),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "1:100 face to face",
        bodies: &[(THIN, ORIGIN)],
        last: (THIN, [0.1, 0.02, 0.0], UP),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "rectangles side by side",
        bodies: &[(BAR, ORIGIN)],
        last: (BAR, [0.0, 0.2, 0.0], UP),
        tank: None,
        obstacle: None,
    },
    Case {
        name: "swimmer beside corners",
        bodies: &[],
        last: (ellipse(0.5, 0.1), [0.1, 1.1, 0.0], UP),
        tank: None,
        obstacle: Some((rectangle(2.0, 2.0, 0.02), [0.0, 0.0])),
    },
    Case {
        name: "tank, obstacle, two ellipses",
        bodies: &[(ellipse(0.4, 0.2), [-1.2, 0.3, 0.3])],
        last: (ellipse(0.3, 0.2), [0.9, 0.5, 0.4], UP),
        tank: Some((ellipse(2.5, 2.0), [0.0, 0.0])),
        obstacle: Some((ellipse(0.3, 0.3), [0.1, -0.9])),
    },
];

/// The case of a name.
pub fn case(name: &str) -> &'static Case {
    CASES.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no case {name}"))
}
