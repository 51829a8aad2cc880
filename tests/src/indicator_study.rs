//! Random scenes, and how their errors compare with the indicators: of added mass, force and accelerations.

use crate::{Numbers, body, disc, link, size, wall};
use nekton::scene::{Body, Link, Quadrature, Scene, Shape, Wall};
use nekton::{Method, ModelBuf, Sim, SimBuf};
use std::fmt::Write;

/// Outline, pose, velocity, circulation.
type Part = (Shape<'static, f64>, [f64; 3], [f64; 3], f64);

/// A random scene.
struct Random {
    /// The first is an obstacle if there is one.
    all: Vec<Part>,
    obstacle: bool,
    tank: Option<f64>,
}

impl Random {
    fn ask<T>(
        &self,
        nodes: usize,
        quadrature: Quadrature,
        question: impl FnOnce(&mut Sim<'_, f64>) -> Result<T, nekton::Error>,
    ) -> Result<T, nekton::Error> {
        let moving = &self.all[usize::from(self.obstacle)..];
        let links: Vec<[Link<'_, f64>; 1]> =
            moving.iter().map(|(s, .., gamma)| [Link { circulation: *gamma, ..link(*s, 1.0, nodes) }]).collect();
        let bodies: Vec<Body<'_, f64>> =
            moving.iter().zip(&links).map(|((_, pose, v, _), l)| body(l, *pose, *v)).collect();
        let walls: Vec<Wall<'_, f64>> = self.all[..usize::from(self.obstacle)]
            .iter()
            .map(|(s, [x, y, turn], ..)| wall(*s, [*x, *y], *turn, nodes))
            .collect();
        let tank = self.tank.map(|radius| wall(disc(radius), [0.0; 2], 0.0, nodes));
        let scene = Scene { bodies: &bodies, obstacles: &walls, tank, quadrature, ..Scene::new(1.0, 0.0) };
        let model = ModelBuf::new(&scene)?;
        let mut sim = SimBuf::new(model.into(), Method::Rk4 { step: 0.01 })?;
        question(&mut sim.view())
    }

    fn gap(&self) -> Option<f64> {
        self.ask(16, Quadrature::Plain, |sim| Ok(sim.gap().distance)).ok()
    }

    /// Two to four bodies at gaps near `gap`, perhaps with an obstacle, a tank, circulation. `None` if they cannot be placed.
    fn new(number: &mut Numbers, gap: f64) -> Option<Random> {
        let count = number.between(2.0, 5.0) as usize;
        let (obstacle, circulates) = (number.chance(0.25), number.chance(0.3));
        let mut scene = Random { all: Vec::new(), obstacle: false, tank: None };
        for k in 0..count + usize::from(obstacle) {
            let a = number.between(0.5, 1.2);
            let shape = if number.chance(0.75) {
                Shape::Ellipse { a, b: a / 20f64.powf(number.between(0.0, 1.0)) }
            } else if number.chance(0.5) {
                Shape::Star { radius: 0.7 * a, amplitude: number.between(0.05, 0.25), lobes: 3 }
            } else {
                Shape::Rectangle { width: 1.5 * a, height: a, radius: Some(number.between(0.05, 0.3) * a) }
            };
            let (s, c) = number.between(0.0, std::f64::consts::TAU).sin_cos();
            let turn = number.between(0.0, std::f64::consts::TAU);
            let v = [0; 3].map(|_| number.between(-1.0, 1.0));
            let gamma = number.between(-2.0, 2.0);
            let centre = if k == 0 { [0.0; 2] } else { [scene.all[k - 1].1[0], scene.all[k - 1].1[1]] };
            let mut shift = if k == 0 { 0.0 } else { 3.5 };
            let gamma = if circulates && !(obstacle && k == 0) { gamma } else { 0.0 };
            scene.all.push((shape, [0.0, 0.0, turn], v, gamma));
            // Two are needed before an obstacle may be one.
            scene.obstacle = obstacle && k > 0;
            for round in 0..60 {
                scene.all[k].1[0] = centre[0] + shift * c;
                scene.all[k].1[1] = centre[1] + shift * s;
                if k == 0 {
                    break;
                }
                let pair = Random { all: scene.all[k - 1..].to_vec(), obstacle: false, tank: None };
                let d = pair.gap()?;
                if (d - gap).abs() < 0.01 * gap {
                    break;
                }
                if round == 59 {
                    return None;
                }
                shift += gap - d;
            }
        }
        if number.chance(0.25) {
            let far = scene.all.iter().map(|(_, p, ..)| p[0].hypot(p[1])).fold(0.0, f64::max);
            scene.tank = Some(far + 1.2 + number.between(0.1, 1.5));
        }
        (scene.gap()? > 0.5 * gap).then_some(scene)
    }
}

/// What is compared, and the largest indicator of a step.
struct Values {
    mass: Vec<f64>,
    force: Vec<f64>,
    accelerations: Vec<f64>,
    energy: f64,
    indicator: f64,
}

/// Reach that torques and spins are compared by; all bodies are about that large.
const REACH: f64 = 1.0;

fn values(sim: &mut Sim<'_, f64>) -> Result<Values, nekton::Error> {
    let n = size(sim);
    let r = sim.indicators()?;
    let (mut mass, mut force, mut accelerations) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
    sim.accelerations(&mut accelerations)?;
    let energy = sim.energy()?.kinetic_fluid;
    sim.christoffel(&mut force)?;
    sim.mass_matrix(&mut mass)?;
    Ok(Values { mass, force, accelerations, energy, indicator: 0.01 * r.bound() })
}

/// Errors of mass and force as the indicators are defined, and of the accelerations relative to the largest of them.
fn errors(a: &Values, exact: &Values) -> [f64; 2] {
    let n = a.force.len();
    let mut mass = 0.0_f64;
    for k in 0..n * n {
        let scale = (exact.mass[k / n * (n + 1)] * exact.mass[k % n * (n + 1)]).sqrt();
        mass = mass.max((a.mass[k] - exact.mass[k]).abs() / scale);
    }
    let largest = |f: &mut dyn Iterator<Item = f64>| f.fold(0.0_f64, |m, x| m.max(x.abs()));
    let difference = |a: &[f64], b: &[f64]| largest(&mut a.iter().zip(b).map(|(a, b)| a - b));
    let force =
        difference(&a.force, &exact.force) / largest(&mut exact.force.iter().copied()).max(exact.energy / REACH);
    let acceleration =
        difference(&a.accelerations, &exact.accelerations) / largest(&mut exact.accelerations.iter().copied());
    [mass.max(force), acceleration]
}

/// One evaluation: errors by indicator.
struct Seen {
    plain: bool,
    circulates: bool,
    gap: f64,
    ratios: [f64; 2],
}

/// Ranges of gaps in the table.
const RANGES: [[f64; 2]; 4] = [[1e-4, 1e-3], [1e-3, 1e-2], [1e-2, 0.1], [0.1, 1.0]];

/// Evaluates random scenes until there are as many evaluations as wanted.
fn study(wanted: usize) -> Vec<Seen> {
    let mut number = Numbers::new(88_172_645_463_325_252);
    let mut seen = Vec::new();
    while seen.len() < wanted {
        let gap = 10f64.powf(number.between(-4.0, 0.0));
        let Some(scene) = Random::new(&mut number, gap) else { continue };
        let circulates = scene.all.iter().any(|(.., gamma)| *gamma != 0.0);
        for quadrature in [Quadrature::Graded, Quadrature::Plain] {
            let plain = quadrature == Quadrature::Plain;
            if plain && gap < 0.3 {
                continue;
            }
            let Ok(exact) = scene.ask(208, Quadrature::Graded, values) else { continue };
            let Ok(second) = scene.ask(144, Quadrature::Graded, values) else { continue };
            let floor = errors(&second, &exact);
            for nodes in [12, 16, 24, 32, 48, 64, 96] {
                // Refused is told.
                let Ok(here) = scene.ask(nodes, quadrature, values) else { continue };
                let found = errors(&here, &exact);
                let ratios = [0, 1].map(|k| {
                    // Below what the reference is known to, and below rounding, nothing can be said; above 1 nothing finer.
                    if found[k] < 3.0 * floor[k] + 1e-12 { 0.0 } else { found[k].min(1.0) / here.indicator }
                });
                seen.push(Seen { plain, circulates, gap, ratios });
            }
        }
    }
    seen
}

/// What a study came to.
pub struct Summary {
    /// The table as CSV.
    pub table: String,
    /// Largest error by indicator without circulation and with it: of mass and force, of accelerations.
    pub largest: [[f64; 2]; 2],
}

/// Errors by indicator of at least so many evaluations.
pub fn summary(evaluations: usize) -> Summary {
    let seen = study(evaluations);
    let mut table = String::from(
        "quantity,circulation,quadrature,gap_from,gap_to,evaluations,told,median,p95,p99,largest,above_100\n",
    );
    let mut line = |quantity: usize, circulates: bool, plain: Option<bool>, [from, to]: [f64; 2]| {
        let kind = |s: &Seen| s.circulates == circulates && plain.is_none_or(|p| p == s.plain);
        let mine = |s: &&Seen| kind(s) && s.gap >= from && s.gap < to;
        let all: Vec<&Seen> = seen.iter().filter(mine).collect();
        let mut ratios: Vec<f64> = all.iter().map(|s| s.ratios[quantity]).filter(|r| *r > 0.0).collect();
        if ratios.is_empty() {
            return 0.0;
        }
        ratios.sort_by(f64::total_cmp);
        let part = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
        let above = ratios.iter().filter(|r| **r > 100.0).count();
        let _ = writeln!(
            table,
            "{},{},{},{from:e},{to:e},{},{},{:.1e},{:.1e},{:.1e},{:.1e},{above}",
            ["mass_or_force", "acceleration"][quantity],
            if circulates { "yes" } else { "no" },
            plain.map_or("all", |p| if p { "plain" } else { "graded" }),
            all.len(),
            ratios.len(),
            part(0.5),
            part(0.95),
            part(0.99),
            part(1.0)
        );
        ratios.last().copied().unwrap_or(0.0)
    };
    let mut largest = [[0.0; 2]; 2];
    for (circulates, largest) in [false, true].into_iter().zip(&mut largest) {
        for (quantity, largest) in largest.iter_mut().enumerate() {
            for range in RANGES {
                line(quantity, circulates, Some(false), range);
            }
            line(quantity, circulates, Some(true), RANGES[3]);
            *largest = line(quantity, circulates, None, [1e-4, 1.0]);
        }
    }
    Summary { table, largest }
}
