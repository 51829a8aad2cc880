//! Random scenes of the study.

use crate::{Numbers, body, disc, link, wall};
use nekton::scene::{Body, Corners, Link, Quadrature, Scene, Shape, Wall};
use nekton::{Error, Method, ModelBuf, Sim, SimBuf};
use std::f64::consts::TAU;

enum Outline {
    Closed(Shape<'static, f64>),
    Polygon(Vec<[f64; 2]>, f64),
    Through(Vec<[f64; 2]>),
}

impl Outline {
    fn shape(&self) -> Shape<'_, f64> {
        match self {
            Outline::Closed(shape) => *shape,
            Outline::Polygon(vertices, radius) => Shape::Polygon { vertices, radius: Some(*radius) },
            Outline::Through(points) => Shape::Curve { points, corners: Corners::None },
        }
    }

    /// A random one that reaches about `a`; `thin`: an ellipse of 1:5 to 1:20.
    fn new(number: &mut Numbers, a: f64, thin: bool) -> Outline {
        let kind = number.between(0.0, 1.0);
        if thin || kind < 0.55 {
            let least = if thin { 0.55 } else { 0.0 };
            return Outline::Closed(Shape::Ellipse { a, b: a / 20f64.powf(number.between(least, 1.0)) });
        }
        if kind < 0.65 {
            let amplitude = number.between(0.05, 0.25);
            return Outline::Closed(Shape::Star { radius: a / 1.25, amplitude, lobes: 3 });
        }
        if kind < 0.75 {
            let radius = Some(number.between(0.05, 0.3) * a);
            return Outline::Closed(Shape::Rectangle { width: 1.5 * a, height: a, radius });
        }
        if kind < 0.85 {
            let n = number.between(3.0, 7.0).floor();
            let mut vertex = |k: f64| {
                let (s, c) = (TAU * (k + number.between(-0.2, 0.2)) / n).sin_cos();
                let r = a * number.between(0.7, 1.0);
                [r * c, r * s]
            };
            let vertices = (0..n as usize).map(|k| vertex(k as f64)).collect();
            return Outline::Polygon(vertices, a * number.between(0.03, 0.15));
        }
        let waves = [2.0, 3.0, 4.0, 5.0].map(|k| [k, number.between(-0.25, 0.25) / k, number.between(0.0, TAU)]);
        let n = (number.between(12.0, 25.0) as usize) * 2;
        let point = |k: usize| {
            let t = TAU * k as f64 / n as f64;
            let r = 0.75 * a * (1.0 + waves.iter().map(|[k, c, phase]| c * (k * t + phase).cos()).sum::<f64>());
            [r * t.cos(), r * t.sin()]
        };
        Outline::Through((0..n).map(point).collect())
    }
}

struct Part {
    outline: Outline,
    size: f64,
    pose: [f64; 3],
    velocity: [f64; 3],
    circulation: f64,
    /// By which a count of nodes is multiplied, as given and in references.
    nodes: [f64; 2],
}

/// A random scene.
pub(super) struct Random {
    /// The first is an obstacle if there is one.
    parts: Vec<Part>,
    obstacle: bool,
    tank: Option<f64>,
    /// Of the closest two, by the smaller one.
    pub gap: f64,
    pub row: bool,
}

fn asked<T>(scene: &Scene<'_, f64>, question: impl FnOnce(&mut Sim<'_, f64>) -> Result<T, Error>) -> Result<T, Error> {
    let mut sim = SimBuf::new(ModelBuf::new(scene)?.into(), Method::Rk4 { step: 0.01 })?;
    question(&mut sim.view())
}

/// Gap of two of the parts.
fn gap(a: &Part, b: &Part) -> Option<f64> {
    let links = [a, b].map(|p| [link(p.outline.shape(), 1.0, 16)]);
    let bodies = [body(&links[0], a.pose, [0.0; 3]), body(&links[1], b.pose, [0.0; 3])];
    let scene = Scene { bodies: &bodies, quadrature: Quadrature::Plain, ..Scene::new(0.0, 0.0) };
    asked(&scene, |sim| Ok(sim.gap().distance)).ok()
}

impl Random {
    /// Moving bodies' sizes.
    pub(super) fn sizes(&self) -> Vec<f64> {
        self.moving().iter().map(|p| p.size).collect()
    }
    /// Moving bodies' circulations.
    pub(super) fn circulations(&self) -> Vec<f64> {
        self.moving().iter().map(|p| p.circulation).collect()
    }
    fn moving(&self) -> &[Part] {
        &self.parts[usize::from(self.obstacle)..]
    }
    /// Largest size by smallest.
    pub(super) fn ratio(&self) -> f64 {
        let sizes = || self.parts.iter().map(|p| p.size);
        sizes().fold(0.0, f64::max) / sizes().fold(f64::MAX, f64::min)
    }
    pub(super) fn alone(&self) -> bool {
        self.parts.len() == 1 && self.tank.is_none()
    }
    pub(super) fn told(&self) -> String {
        let part = |p: &Part| {
            let shape = match &p.outline {
                Outline::Closed(shape) => format!("{shape:?}"),
                Outline::Polygon(v, r) => format!("polygon {v:?} {r}"),
                Outline::Through(v) => format!("through {} points from {:?}", v.len(), v[0]),
            };
            format!("{shape} at {:?} v {:?} γ {} nodes {:?}\n", p.pose, p.velocity, p.circulation, p.nodes)
        };
        let parts: String = self.parts.iter().map(part).collect();
        format!("gap {:e} row {} obstacle {} tank {:?}\n{parts}", self.gap, self.row, self.obstacle, self.tank)
    }

    /// With about that many nodes on each boundary. `reference`: more where a small body is close to a large one.
    pub(super) fn ask<T>(
        &self,
        nodes: usize,
        reference: bool,
        quadrature: Quadrature,
        question: impl FnOnce(&mut Sim<'_, f64>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let count = |p: &Part| ((nodes as f64 * p.nodes[usize::from(reference)] / 4.0).ceil() as usize * 4).max(8);
        let moving = self.moving();
        let links: Vec<[Link<'_, f64>; 1]> = moving
            .iter()
            .map(|p| [Link { circulation: p.circulation, ..link(p.outline.shape(), 1.0, count(p)) }])
            .collect();
        let bodies: Vec<Body<'_, f64>> = moving.iter().zip(&links).map(|(p, l)| body(l, p.pose, p.velocity)).collect();
        let walls: Vec<Wall<'_, f64>> = self.parts[..usize::from(self.obstacle)]
            .iter()
            .map(|p| wall(p.outline.shape(), [p.pose[0], p.pose[1]], p.pose[2], count(p)))
            .collect();
        let tank = self.tank.map(|radius| wall(disc(radius), [0.0; 2], 0.0, nodes));
        let scene = Scene { bodies: &bodies, obstacles: &walls, tank, quadrature, ..Scene::new(1.0, 0.0) };
        asked(&scene, question)
    }

    /// The scene of a number: one body or two to four, largest size by smallest to 1e4 and speeds to 1e3, at gaps of 1e-4 to 1 smaller
    /// bodies, perhaps three in a row, with an obstacle, a tank, circulation. `None` if they cannot be placed.
    pub(super) fn new(index: u64) -> Option<Random> {
        let number = &mut Numbers::new((index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        // The first numbers of neighbouring seeds are alike.
        for _ in 0..8 {
            number.between(0.0, 1.0);
        }
        let gap = 10f64.powf(number.between(-4.0, 0.0));
        let (row, lone) = (number.chance(0.2), number.chance(0.1));
        let row = row && !lone;
        let count = if lone {
            1
        } else if row {
            3
        } else {
            number.between(2.0, 5.0) as usize
        };
        let (obstacle, circulates) = (!row && number.chance(0.25), number.chance(0.3));
        let digits = if number.chance(0.4) { 0.0 } else { number.between(0.0, 4.0) };
        let rest = number.chance(0.2).then(|| number.between(0.0, count as f64) as usize);
        let uneven = number.chance(0.3);
        let all = count + usize::from(obstacle);
        // One has the largest size and one the smallest.
        let extreme = [number.between(0.0, all as f64) as usize, number.between(0.0, all as f64) as usize];
        let mut shares: Vec<f64> = (0..all).map(|_| number.between(0.0, 1.0)).collect();
        (shares[extreme[0]], shares[extreme[1]]) = (0.0, 1.0);
        if !row {
            // Each beside larger ones, which would not fit between smaller ones.
            shares.sort_by(f64::total_cmp);
        }
        let (first, turned) = (number.between(0.0, TAU), number.between(-0.1, 0.1));
        let mut scene = Random { parts: Vec::new(), obstacle, tank: None, gap, row };
        for k in 0..all {
            let share = if k == extreme[0] {
                0.0
            } else if k == extreme[1] {
                1.0
            } else {
                number.between(0.0, 1.0)
            };
            let size = number.between(0.7, 1.2) * 10f64.powf(-digits * share);
            let outline = Outline::new(number, size, row && k == 1);
            let speed = 10f64.powf(number.between(-1.5, 1.5)) * f64::from(u8::from(rest != Some(k)));
            let velocity = [1.0, 1.0, 1.0 / size].map(|s| speed * s * number.between(-1.0, 1.0));
            let gamma = size * speed * number.between(-2.0, 2.0);
            let circulation = if circulates { gamma } else { 0.0 };
            let factor = if uneven { 2f64.powf(number.between(-1.0, 1.0)) } else { 1.0 };
            let angle = if row { first + turned * k as f64 } else { number.between(0.0, TAU) };
            let parent = if row { k.max(1) - 1 } else { number.between(0.0, k as f64) as usize };
            let turn = number.between(0.0, TAU);
            let pose = [0.0, 0.0, turn];
            scene.parts.push(Part { outline, size, pose, velocity, circulation, nodes: [factor, 1.0] });
            scene.place(k, parent, angle)?;
        }
        let largest = scene.parts.iter().map(|p| p.size).fold(0.0, f64::max);
        for k in 0..all {
            let near = |j: usize| j != k && scene.parts[j].size < 0.1 * scene.parts[k].size;
            scene.parts[k].nodes[1] = if (0..all).any(near) { 1.5 } else { 1.0 };
        }
        if obstacle {
            // Which one must not follow from its size.
            scene.parts.swap(0, number.between(0.0, all as f64) as usize);
            scene.parts[0].circulation = 0.0;
        }
        if number.chance(0.25) {
            let far = scene.parts.iter().map(|p| p.pose[0].hypot(p.pose[1]) + p.size).fold(0.0, f64::max);
            scene.tank = Some(far + largest * number.between(0.1, 1.5));
            if all == 1 {
                // As far from the wall as others from each other.
                scene.tank = Some(3.0 * largest);
                scene.parts[0].pose[0] = largest * (3.0 - 1.0 - gap);
            }
        }
        Some(scene)
    }

    /// Moves part k towards another one until it is as near as wanted.
    fn place(&mut self, k: usize, parent: usize, angle: f64) -> Option<()> {
        if k == 0 {
            return Some(());
        }
        let (s, c) = angle.sin_cos();
        let [x, y, _] = self.parts[parent].pose;
        let wanted = self.gap * self.parts[k].size.min(self.parts[parent].size);
        let mut shift = 1.2 * (self.parts[k].size + self.parts[parent].size) + wanted;
        let mut found = false;
        for _ in 0..60 {
            (self.parts[k].pose[0], self.parts[k].pose[1]) = (x + shift * c, y + shift * s);
            let d = gap(&self.parts[k], &self.parts[parent])?;
            found = (d - wanted).abs() < 0.01 * wanted;
            if found {
                break;
            }
            shift += wanted - d;
        }
        let clear = |j: usize| {
            let least = 0.5 * self.gap * self.parts[k].size.min(self.parts[j].size);
            j == parent || gap(&self.parts[k], &self.parts[j]).is_some_and(|d| d > least)
        };
        (found && (0..k).all(clear)).then_some(())
    }
}
