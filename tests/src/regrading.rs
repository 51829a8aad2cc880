//! Smooth paths of bodies past each other, along which ladders of nodes appear and vanish, and how far added mass and force jump
//! there: by no more than they are wrong anyway.

use crate::{adams, body, disc, hinged, link, simulation, wall};
use nekton::scene::{Body, Drive, Link, Scene, Shape, Signal};
use nekton::{Sim, SimBuf};

/// A scene and how its coordinates change along the path, from 0 to 1.
pub struct Path {
    /// Name in tables.
    pub name: &'static str,
    make: fn(usize) -> SimBuf<f64>,
    /// Change of the free coordinates: from the start, and how often they swing on the way.
    change: &'static [f64],
}

const VELOCITIES: [[f64; 3]; 3] = [[0.3, -0.5, 0.7], [-0.2, 0.4, 0.9], [0.5, 0.1, -0.6]];

fn make(shapes: &[Shape<'_, f64>], poses: &[[f64; 3]], tank: Option<Shape<'_, f64>>, nodes: usize) -> SimBuf<f64> {
    let links: Vec<[Link<'_, f64>; 1]> = shapes.iter().map(|s| [link(*s, 1.0, nodes)]).collect();
    let bodies: Vec<Body<'_, f64>> =
        links.iter().zip(poses).zip(VELOCITIES).map(|((l, pose), v)| body(l, *pose, v)).collect();
    let tank = tank.map(|s| wall(s, [0.0; 2], 0.0, nodes));
    simulation(&Scene { bodies: &bodies, tank, allow_unresolved: true, ..Scene::new(1.0, 0.0) }, adams(1e-6))
}

const ELLIPSE: Shape<'static, f64> = Shape::Ellipse { a: 1.0, b: 0.5 };
const THIN: Shape<'static, f64> = Shape::Ellipse { a: 1.0, b: 0.2 };
const STAR: Shape<'static, f64> = Shape::Star { radius: 0.8, amplitude: 0.15, lobes: 5 };
const BOX: Shape<'static, f64> = Shape::Rectangle { width: 1.6, height: 0.8, radius: Some(0.1) };

/// The paths.
pub fn paths() -> [Path; 8] {
    [
        Path {
            name: "ellipses pass",
            make: |n| make(&[ELLIPSE; 2], &[[0.0; 3], [-2.6, 1.07, 0.1]], None, n),
            change: &[0.0, 0.0, 0.0, 5.2, 0.0, -0.2],
        },
        Path {
            name: "thin ellipse turns beside another",
            make: |n| make(&[THIN; 2], &[[0.0; 3], [0.1, 1.25, 0.0]], None, n),
            change: &[0.0, 0.0, 0.0, 0.0, 0.0, 3.3],
        },
        Path {
            name: "ellipse approaches",
            make: |n| make(&[ELLIPSE; 2], &[[0.0; 3], [0.4, 3.5, 0.4]], None, n),
            change: &[0.0, 0.0, 0.0, 0.0, -2.35, -0.2],
        },
        Path {
            name: "disc between two bodies",
            make: |n| make(&[ELLIPSE, disc(0.6), disc(0.5)], &[[0.0; 3], [0.3, 2.05, 0.0], [-2.5, 0.98, 0.0]], None, n),
            change: &[0.0, 0.0, 0.0, 0.0, 0.12, 0.0, 4.0, 0.05, 0.0],
        },
        Path {
            name: "star turns beside an ellipse",
            make: |n| make(&[ELLIPSE, STAR], &[[0.0; 3], [0.1, 1.6, 0.0]], None, n),
            change: &[0.0, 0.0, 0.2, 0.0, 0.0, 1.4],
        },
        Path {
            name: "stars pass",
            make: |n| make(&[STAR; 2], &[[0.0; 3], [-2.2, 1.85, 0.2]], None, n),
            change: &[0.0, 0.0, 0.4, 4.4, 0.0, -0.7],
        },
        Path {
            name: "swimmer beside a rounded box",
            make: |nodes| {
                let drive = Drive::Torque {
                    torque: Signal::Constant(0.0),
                    stiffness: 0.0,
                    damping: 0.0,
                    rest: 0.0,
                    start: [0.3, 0.4],
                };
                let one = link(Shape::Ellipse { a: 0.8, b: 0.3 }, 1.0, nodes);
                let links = [one, hinged(one, 0, [-1.0, 0.0], [1.0, 0.0], drive)];
                let bodies = [body(&links, [-1.5, 0.95, 0.0], VELOCITIES[0])];
                let obstacles = [wall(BOX, [0.0; 2], 0.0, nodes)];
                simulation(
                    &Scene { bodies: &bodies, obstacles: &obstacles, allow_unresolved: true, ..Scene::new(1.0, 0.0) },
                    adams(1e-6),
                )
            },
            change: &[3.5, 0.0, 0.15, -0.5],
        },
        Path {
            name: "ellipse along a tank wall",
            make: |n| make(&[ELLIPSE], &[[0.9, 0.0, 0.2]], Some(Shape::Ellipse { a: 2.0, b: 1.6 }), n),
            change: &[-0.9, 0.9, 2.5],
        },
    ]
}

/// What is looked at.
#[derive(Clone)]
struct Look {
    mass: Vec<f64>,
    force: Vec<f64>,
    energy: f64,
    indicator: f64,
}

/// The largest jump of a path.
#[derive(Clone, Copy, Debug, Default)]
pub struct Jump {
    /// Where on the path.
    pub at: f64,
    /// Of the mass matrix, relative to its diagonal.
    pub mass: f64,
    /// Of the force, relative to the largest, or to the energy over a length.
    pub force: f64,
    /// The largest error indicator there.
    pub indicator: f64,
}

impl Jump {
    /// Jump by indicator.
    pub fn ratio(&self) -> f64 {
        self.mass.max(self.force) / self.indicator
    }
}

fn look(sim: &mut Sim<'_, f64>, start: &[f64], change: &[f64], s: f64) -> Look {
    let mut y = start.to_vec();
    y.iter_mut().zip(change).for_each(|(y, c)| *y += s * c);
    sim.set_state(0.0, &y).unwrap_or_else(|e| panic!("{s}: {e}"));
    let n = sim.positions().len();
    let (mut mass, mut force) = (vec![0.0; n * n], vec![0.0; n]);
    let r = sim.indicators().unwrap();
    let energy = sim.energy().unwrap().kinetic_fluid;
    sim.christoffel(&mut force).unwrap();
    sim.mass_matrix(&mut mass).unwrap();
    Look { mass, force, energy, indicator: r.mass.max(r.force).max(r.quadrature) }
}

/// Second difference of mass and force over three places; all lengths here are near 1.
fn bend(a: &Look, m: &Look, b: &Look) -> [f64; 2] {
    let n = m.force.len();
    let mut mass = 0.0_f64;
    for i in 0..n {
        for j in 0..n {
            let k = i * n + j;
            let scale = (m.mass[i * n + i] * m.mass[j * n + j]).sqrt();
            mass = mass.max((a.mass[k] - 2.0 * m.mass[k] + b.mass[k]).abs() / scale);
        }
    }
    let size = m.force.iter().fold(m.energy, |most, f| most.max(f.abs()));
    let three = a.force.iter().zip(&m.force).zip(&b.force);
    [mass, three.fold(0.0_f64, |most, ((a, m), b)| most.max((a - 2.0 * m + b).abs())) / size]
}

/// Halvings of a step: what bends is then 10¹³ times less, what jumps is as large as before.
const HALVINGS: usize = 22;

/// Walks a path in `samples` steps, and follows those where mass or force bend most (in units of the indicator) down to a
/// millionth of a step: what is left of their second differences is a jump. The largest, in the same units.
pub fn largest_jump(path: &Path, nodes: usize, samples: usize, followed: usize) -> Jump {
    let mut sim = (path.make)(nodes);
    let mut sim = sim.view();
    let start = sim.state().to_vec();
    let mut at = |s: f64| look(&mut sim, &start, path.change, s);
    let step = 1.0 / samples as f64;
    let looks: Vec<Look> = (0..=samples).map(|k| at(k as f64 * step)).collect();
    // Differences of these differences take away most of what is smooth.
    let bends: Vec<[f64; 2]> = (1..samples).map(|k| bend(&looks[k - 1], &looks[k], &looks[k + 1])).collect();
    let mut places: Vec<(f64, usize)> = (1..bends.len() - 1)
        .map(|k| {
            let rough =
                (0..2).map(|c| (bends[k][c] - 0.5 * (bends[k - 1][c] + bends[k + 1][c])).abs()).fold(0.0, f64::max);
            (rough / looks[k + 1].indicator, k + 1)
        })
        .collect();
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut worst = Jump::default();
    for (_, k) in places.into_iter().take(followed) {
        let (mut middle, mut half) = (k as f64 * step, step);
        let mut three = [looks[k - 1].clone(), looks[k].clone(), looks[k + 1].clone()];
        for _ in 0..HALVINGS {
            half *= 0.5;
            let [a, m, b] = three;
            let (p, q) = (at(middle - half), at(middle + half));
            let size = |[mass, force]: [f64; 2]| mass.max(force);
            let all = [
                (middle - half, [a, p.clone(), m.clone()]),
                (middle, [p, m.clone(), q.clone()]),
                (middle + half, [m, q, b]),
            ];
            let most = all.into_iter().max_by(|x, y| {
                let [x, y] = [x, y].map(|(_, [a, m, b])| size(bend(a, m, b)));
                x.total_cmp(&y)
            });
            (middle, three) = most.expect("there are three");
        }
        let [a, m, b] = &three;
        let [mass, force] = bend(a, m, b);
        let jump = Jump { at: middle, mass, force, indicator: a.indicator.max(b.indicator).max(m.indicator) };
        if worst.indicator == 0.0 || jump.ratio() > worst.ratio() {
            worst = jump;
        }
    }
    worst
}
