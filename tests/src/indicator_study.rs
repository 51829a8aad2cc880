//! Random scenes, and how their errors compare with the indicators: of added mass, force and accelerations, body by body.

mod scenes;

use crate::size;
use nekton::Sim;
use nekton::scene::Quadrature;
use scenes::Random;
use std::fmt::Write;

/// What is compared, and the largest indicator of a step.
struct Values {
    mass: Vec<f64>,
    added: Vec<f64>,
    force: Vec<f64>,
    circulation: Vec<f64>,
    accelerations: Vec<f64>,
    velocity: Vec<f64>,
    indicators: [f64; 3],
}

fn values(sim: &mut Sim<'_, f64>) -> Result<Values, nekton::Error> {
    let n = size(sim);
    let r = sim.indicators()?;
    let (mut mass, mut added) = (vec![0.0; n * n], vec![0.0; n * n]);
    let (mut force, mut circulation, mut accelerations) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    sim.accelerations(&mut accelerations)?;
    sim.circulation_gradient(&mut circulation)?;
    sim.christoffel(&mut force)?;
    sim.mass_matrix(&mut mass)?;
    sim.added_mass(&mut added)?;
    let velocity = sim.velocities().to_vec();
    Ok(Values { mass, added, force, circulation, accelerations, velocity, indicators: [r.mass, r.force, r.quadrature] })
}

/// Errors of mass and force, and of accelerations, of the body where they are largest.
fn errors(a: &Values, exact: &Values, scene: &Random) -> [f64; 2] {
    let (sizes, n) = (scene.sizes(), exact.force.len());
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let mut mass = 0.0_f64;
    for k in 0..n * n {
        let scale = (exact.mass[k / n * (n + 1)] * exact.mass[k % n * (n + 1)]).sqrt();
        mass = mass.max((a.mass[k] - exact.mass[k]).abs() / scale);
    }
    // Torques count over the size, spins times it.
    let size_of = |f: &[f64], s: f64| f[0].abs().max(f[1].abs()).max(f[2].abs() / s);
    let of = |f: &[f64], k: usize, s: f64| size_of(&f[3 * k..3 * k + 3], s);
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let energy = |k: usize| {
        let row = |i: usize| (0..n).map(|j| exact.added[i * n + j] * exact.velocity[j]).sum::<f64>();
        (3 * k..3 * k + 3).map(|i| row(i) * exact.velocity[i]).sum::<f64>() / 2.0
    };
    let energies: Vec<f64> = (0..sizes.len()).map(energy).collect();
    // The natural size of the forces on every body, given those that act on it by themselves.
    let scales = |forces: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let all = (0..sizes.len()).map(forces).fold(energies.iter().sum::<f64>() / largest, f64::max);
        let own = |(k, s): (usize, &f64)| forces(k).max(energies[k].abs() / s).max(all * s / largest);
        sizes.iter().enumerate().map(own).collect()
    };
    let relative = |x: f64, scale: f64| if scale > 0.0 { x / scale } else { 0.0 };
    let own = scales(&|k| of(&exact.force, k, sizes[k]));
    let wrong = off(&a.force, &exact.force);
    let force = (0..sizes.len()).fold(0.0, |m: f64, k| m.max(relative(of(&wrong, k, sizes[k]), own[k])));
    let gammas = scene.circulations();
    let lift = |k: usize| gammas[k].abs() * exact.velocity[3 * k].hypot(exact.velocity[3 * k + 1]);
    let own = scales(&|k| of(&exact.force, k, sizes[k]).max(of(&exact.circulation, k, sizes[k])).max(lift(k)));
    let wrong = off(&a.accelerations, &exact.accelerations);
    let acceleration = (0..sizes.len()).fold(0.0, |m: f64, k| {
        // As the force that would make it, or by the largest acceleration of that body, whichever is less.
        let inertial =
            |i: usize| (0..3).map(|j| exact.mass[(3 * k + i) * n + 3 * k + j] * wrong[3 * k + j]).sum::<f64>();
        let needed = size_of(&[0, 1, 2].map(inertial), sizes[k]);
        let by_itself = relative(of(&wrong, k, 1.0 / sizes[k]), of(&exact.accelerations, k, 1.0 / sizes[k]));
        m.max(relative(needed, own[k]).min(by_itself))
    });
    [mass.max(force), acceleration]
}

/// One evaluation.
struct Seen {
    scene: u64,
    plain: bool,
    circulates: bool,
    /// Bodies alone have none.
    gap: Option<f64>,
    ratio: f64,
    row: bool,
    nodes: usize,
    /// Of mass and force, of accelerations.
    errors: [f64; 2],
    /// To which the reference is known.
    floors: [f64; 2],
    indicators: [f64; 3],
}

impl Seen {
    fn bound(&self) -> f64 {
        100.0 * self.indicators.iter().copied().fold(0.0, f64::max)
    }
    /// Error by indicator; 0: within rounding or what is known of the reference. Above 1 an error needs no finer measure.
    fn by_indicator(&self, quantity: usize) -> f64 {
        let (error, floor) = (self.errors[quantity], 3.0 * self.floors[quantity] + 1e-12);
        if error < floor { 0.0 } else { 100.0 * error.min(1.0) / self.bound() }
    }
    /// Whether the reference is too bad to say if an error is within the bound.
    fn open(&self, quantity: usize) -> bool {
        let (error, floor) = (self.errors[quantity], 3.0 * self.floors[quantity]);
        error > 1e-12 && error < floor && floor > self.bound()
    }
    fn line(&self) -> String {
        let Seen { scene, plain, circulates, ratio, row, nodes, .. } = self;
        let (gap, [a, b], [c, d], [e, f, g]) = (self.gap.unwrap_or(-1.0), self.errors, self.floors, self.indicators);
        format!(
            "{scene} {plain} {circulates} {gap:e} {ratio:e} {row} {nodes} {a:e} {b:e} {c:e} {d:e} {e:e} {f:e} {g:e}"
        )
    }
    fn read(line: &str) -> Option<Seen> {
        let words: Vec<&str> = line.split(' ').collect();
        let number = |k: usize| words.get(k)?.parse::<f64>().ok();
        let flag = |k: usize| words.get(k).map(|w| *w == "true");
        Some(Seen {
            scene: words.first()?.parse().ok()?,
            plain: flag(1)?,
            circulates: flag(2)?,
            gap: number(3).filter(|g| *g > 0.0),
            ratio: number(4)?,
            row: flag(5)?,
            nodes: number(6)? as usize,
            errors: [number(7)?, number(8)?],
            floors: [number(9)?, number(10)?],
            indicators: [number(11)?, number(12)?, number(13)?],
        })
    }
}

/// Nodes of the reference, and of those it must agree with.
const REFERENCE: [usize; 3] = [224, 192, 160];

/// A reference that is not known to this says nothing.
const KNOWN: f64 = 1e-4;

/// What became of a scene.
enum Outcome {
    /// Bodies could not be placed.
    NoScene,
    /// The reference is refused or does not converge.
    NoReference,
    /// Evaluations, and how many were refused: those are told.
    Seen(Vec<Seen>, usize),
}

fn look(index: u64) -> Outcome {
    let Some(scene) = Random::new(index) else { return Outcome::NoScene };
    let reference = |nodes| scene.ask(nodes, true, Quadrature::Graded, values);
    let [Ok(exact), Ok(second), Ok(third)] = REFERENCE.map(reference) else { return Outcome::NoReference };
    let [second, third] = [second, third].map(|other| errors(&other, &exact, &scene));
    let floors = [0, 1].map(|k| second[k].max(third[k]));
    if !floors.iter().all(|f| *f < KNOWN) {
        return Outcome::NoReference;
    }
    let (mut seen, mut refused) = (Vec::new(), 0);
    for plain in [false, true] {
        if plain && scene.gap < 0.1 && !scene.alone() {
            continue;
        }
        let quadrature = if plain { Quadrature::Plain } else { Quadrature::Graded };
        for nodes in [12, 16, 24, 32, 48, 64, 96] {
            match scene.ask(nodes, false, quadrature, values) {
                Ok(here) => seen.push(Seen {
                    scene: index,
                    plain,
                    circulates: scene.circulations().iter().any(|g| *g != 0.0),
                    gap: (!scene.alone()).then_some(scene.gap),
                    ratio: scene.ratio(),
                    row: scene.row,
                    nodes,
                    errors: errors(&here, &exact, &scene),
                    floors,
                    indicators: here.indicators,
                }),
                Err(_) => refused += 1,
            }
        }
    }
    Outcome::Seen(seen, refused)
}

/// The evaluations of scenes `from` to `to`, one a line, and a line for each scene that has none.
pub fn lines(from: u64, to: u64, mut write: impl FnMut(&str)) {
    for index in from..to {
        match look(index) {
            Outcome::NoScene => write(&format!("{index} not_placed")),
            Outcome::NoReference => write(&format!("{index} no_reference")),
            Outcome::Seen(seen, refused) => {
                seen.iter().for_each(|s| write(&s.line()));
                write(&format!("{index} refused {refused}"));
            }
        }
    }
}

/// What a scene is.
pub fn told(index: u64) -> String {
    Random::new(index).map_or(String::new(), |scene| scene.told())
}

/// What a study came to.
pub struct Summary {
    /// The table as CSV.
    pub table: String,
    /// Largest error by indicator without circulation and with it: of mass and force, of accelerations.
    pub largest: [[f64; 2]; 2],
    /// Scenes, those whose references were no use, and refused evaluations.
    pub counts: [usize; 3],
}

/// Errors by indicator of at least so many evaluations.
pub fn summary(evaluations: usize) -> Summary {
    let (mut all, mut index, mut count) = (String::new(), 0, 0);
    while count < evaluations {
        lines(index, index + 1, |line| {
            all += line;
            all.push('\n');
            count += usize::from(Seen::read(line).is_some());
        });
        index += 1;
    }
    summary_of(&all)
}

/// Ranges of gaps and of size ratios in the table.
const GAPS: [[f64; 2]; 4] = [[1e-4, 1e-3], [1e-3, 1e-2], [1e-2, 0.1], [0.1, 1.0]];
const RATIOS: [[f64; 2]; 3] = [[1.0, 3.0], [3.0, 100.0], [100.0, 2e4]];

/// The same of lines that [`lines`] wrote.
pub fn summary_of(lines: &str) -> Summary {
    let seen: Vec<Seen> = lines.lines().filter_map(Seen::read).collect();
    let mut counts = [0; 3];
    for line in lines.lines() {
        match line.split(' ').collect::<Vec<_>>()[..] {
            [_, "no_reference"] => counts[1] += 1,
            [_, "refused", count] => {
                counts[0] += 1;
                counts[2] += count.parse().unwrap_or(0);
            }
            _ => {}
        }
    }
    let mut table = String::from(
        "quantity,circulation,quadrature,gap_from,gap_to,ratio_from,ratio_to,kind,evaluations,open,told,median,p95,p99,largest,above_bound,above_3x\n",
    );
    let mut largest = [[0.0; 2]; 2];
    let mut line = |quantity: usize,
                    circulates: bool,
                    [quadrature, gap, ratio, kind]: [&str; 4],
                    which: &dyn Fn(&Seen) -> bool| {
        let mine: Vec<&Seen> = seen.iter().filter(|s| s.circulates == circulates && which(s)).collect();
        let mut ratios: Vec<f64> = mine.iter().map(|s| s.by_indicator(quantity)).filter(|r| *r > 0.0).collect();
        if ratios.is_empty() {
            return;
        }
        ratios.sort_by(f64::total_cmp);
        let part = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
        let above = |times: f64| ratios.iter().filter(|r| **r > 100.0 * times).count();
        let _ = writeln!(
            table,
            "{},{},{quadrature},{gap},{ratio},{kind},{},{},{},{:.1e},{:.1e},{:.1e},{:.1e},{},{}",
            ["mass_or_force", "acceleration"][quantity],
            if circulates { "yes" } else { "no" },
            mine.len(),
            mine.iter().filter(|s| s.open(quantity)).count(),
            ratios.len(),
            part(0.5),
            part(0.95),
            part(0.99),
            part(1.0),
            above(1.0),
            above(3.0)
        );
        let l = &mut largest[usize::from(circulates)][quantity];
        *l = f64::max(*l, part(1.0));
    };
    let range = |[from, to]: [f64; 2]| format!("{from:e},{to:e}");
    let within = |[from, to]: [f64; 2], x: f64| x >= from && x < to;
    for circulates in [false, true] {
        for quantity in [0, 1] {
            for (quadrature, plain) in [("graded", false), ("plain", true)] {
                line(quantity, circulates, [quadrature, ",", ",", "alone"], &|s| s.gap.is_none() && s.plain == plain);
                for (gap, ratio) in GAPS.iter().flat_map(|g| RATIOS.iter().map(move |r| (*g, *r))) {
                    let which =
                        |s: &Seen| s.gap.is_some_and(|g| within(gap, g)) && within(ratio, s.ratio) && s.plain == plain;
                    line(quantity, circulates, [quadrature, &range(gap), &range(ratio), "several"], &which);
                }
            }
            line(quantity, circulates, ["all", ",", ",", "three in a row"], &|s| s.row);
            line(quantity, circulates, ["all", ",", ",", "all"], &|_| true);
        }
    }
    Summary { table, largest, counts }
}
