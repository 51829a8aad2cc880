//! Random drives that begin late, pause, jump or are short, each against a run that is cut wherever a drive changes and goes through
//! every piece with fixed steps of that piece's own time scale.

use crate::{Numbers, adams, body, hinged, link};
use nekton::scene::{Body, Drive, Harmonic, Link, Root, Scene, Shape, Signal, Window};
use nekton::{Method, ModelBuf, Result, SimBuf};
use std::fmt::Write;
use std::sync::Arc;

/// Tolerance of the runs that are judged.
pub const TOLERANCE: f64 = 1e-7;

/// A drive, what it is called, and where it changes: pieces with steps that resolve it in each.
struct Random {
    kind: &'static str,
    terms: Vec<Harmonic<f64>>,
    window: Option<Window<f64>>,
    rows: Vec<[f64; 4]>,
    /// A torque, else a motion.
    torque: bool,
    /// Of the first link's x, else of the joint.
    root: bool,
    /// A second body beside.
    neighbour: bool,
    /// (begin, end, step) of every piece, without the rest before the first.
    pieces: Vec<[f64; 3]>,
    pause: f64,
    pulse: f64,
}

impl Random {
    fn new(n: &mut Numbers) -> Random {
        let decades = |n: &mut Numbers, low: f64, high: f64| 10f64.powf(n.between(low, high));
        let pause = if n.chance(0.2) { 0.0 } else { decades(n, -3.0, 3.0) };
        let pulse = decades(n, -3.0, 1.0);
        let torque = n.chance(0.4);
        // Speeds and spins of the order of one at the most, whatever the pulse.
        let size = n.between(0.05, 0.25) * if torque { 1.0 / pulse.max(0.2) } else { pulse.min(1.0) };
        let turns = n.between(0.5, 6.0);
        let (mut terms, mut window, mut rows) = (Vec::new(), None, Vec::new());
        let end = pause + pulse;
        let mut pieces = Vec::new();
        let kind = match n.between(0.0, 5.0) as usize {
            0 => {
                // Vanishes at the start and at every half period.
                let frequency = std::f64::consts::TAU * turns / pulse.max(0.2);
                let phase = if torque { 0.0 } else { n.between(0.0, 6.0) };
                terms.push(Harmonic { amplitude: size, frequency, phase, offset: 0.0 });
                pieces.push([0.0, pulse.max(0.2), 0.05 / frequency]);
                "harmonic"
            }
            1 | 2 => {
                let frequency = std::f64::consts::TAU * turns / pulse;
                terms.push(Harmonic { amplitude: size / turns, frequency, phase: n.between(0.0, 6.0), offset: 0.0 });
                let ramp = pulse * n.between(0.1, 0.5);
                window = Some(Window { from: pause, to: end, ramp });
                pieces.push([pause, end, 0.004 * ramp.min(pulse / turns)]);
                "window"
            }
            3 if torque => {
                let (half, more) = (pause + 0.5 * pulse, if n.chance(0.5) { -size } else { 0.0 });
                rows = [
                    (0.0, 0.0),
                    (pause, 0.0),
                    (pause, size),
                    (half, size),
                    (half, more),
                    (end, more),
                    (end, 0.0),
                    (2.0 * end, 0.0),
                ]
                .map(|(t, u)| [t, u, 0.0, 0.0])
                .to_vec();
                pieces.extend([[pause, half, pulse / 100.0], [half, end, pulse / 100.0]]);
                "jumps"
            }
            _ => {
                let back = if n.chance(0.6) { 0.0 } else { n.between(-1.0, 1.0) * size };
                let (first, second) = (pause + pulse * n.between(0.2, 0.5), pause + pulse * n.between(0.5, 0.8));
                let bend = n.between(-1.0, 1.0) * size;
                rows = [(0.0, 0.0), (pause, 0.0), (first, size), (second, bend), (end, back), (end + 50.0, back)]
                    .map(|(t, u)| [t, u, 0.0, 0.0])
                    .to_vec();
                pieces.extend(
                    [[pause, first, 0.0], [first, second, 0.0], [second, end, 0.0]]
                        .map(|[a, b, _]| [a, b, (b - a) / 100.0]),
                );
                "table"
            }
        };
        if pause == 0.0 && !rows.is_empty() {
            // No row before the first.
            rows.remove(0);
        }
        let (last, step) = pieces.last().map_or((0.0, 0.01), |p| (p[1], p[2]));
        pieces.push([last, last + 1.0, if kind == "harmonic" { step } else { 0.01 }]);
        let root = !torque && n.chance(0.3);
        Random { kind, terms, window, rows, torque, root, neighbour: n.chance(0.4), pieces, pause, pulse }
    }

    fn model(&self) -> Result<Arc<ModelBuf<f64>>> {
        let signal = if self.rows.is_empty() {
            Signal::Harmonic { terms: &self.terms, window: self.window }
        } else {
            Signal::Table(&self.rows)
        };
        let one = link(Shape::Ellipse { a: 0.6, b: 0.2 }, 1.0, 24);
        let still = Signal::Constant(0.0);
        let drive = match (self.torque, self.root) {
            (true, _) => Drive::Torque { torque: signal, stiffness: 0.2, damping: 0.05, rest: 0.0, start: [0.0; 2] },
            (false, false) => Drive::Motion(signal),
            (false, true) => Drive::Torque { torque: still, stiffness: 0.2, damping: 0.05, rest: 0.0, start: [0.0; 2] },
        };
        let links = [one, hinged(one, 0, [-0.8, 0.0], [0.8, 0.0], drive)];
        let root = if self.root { Root::Prescribed([signal, still, still]) } else { Root::Free };
        let alone: [Link<'_, f64>; 1] = [link(Shape::Ellipse { a: 0.4, b: 0.3 }, 1.0, 24)];
        let bodies = [Body { root, ..body(&links, [0.0; 3], [0.0; 3]) }, body(&alone, [-0.7, 1.4, 0.2], [0.0; 3])];
        let bodies = &bodies[..1 + usize::from(self.neighbour)];
        Ok(Arc::new(ModelBuf::new(&Scene { bodies, ..Scene::new(1.0, 0.0) })?))
    }

    fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p[1])
    }

    /// Piece by piece: nothing moves before the first.
    fn reference(&self) -> Result<Vec<f64>> {
        let model = self.model()?;
        let mut state = SimBuf::new(model.clone(), adams(1e-9))?.view().state().to_vec();
        for [from, to, step] in &self.pieces {
            let steps = ((to - from) / step).ceil().max(1.0);
            let mut sim = SimBuf::new(model.clone(), Method::Rk4 { step: (to - from) / steps })?;
            let mut sim = sim.view();
            sim.set_step_limit(10_000_000)?;
            sim.set_state(*from, &state)?;
            sim.advance(*to)?;
            state = sim.state().to_vec();
        }
        Ok(state)
    }
}

/// What one scene came to.
pub struct Judged {
    /// A row of the table.
    pub row: String,
    /// Largest error in tolerances.
    pub error: f64,
    /// Whether anything was noticed.
    pub noticed: bool,
}

/// Names of the columns of [`Judged::row`].
pub const HEADER: &str =
    "scene,drive,torque,root,neighbour,pause,pulse,method,error_in_tolerances,evaluations,notice\n";

/// Scene number `k` of the seeded sequence, by `adams` at once and in calls of ten steps.
pub fn judge(k: u64) -> Result<Vec<Judged>> {
    judge_at(k, TOLERANCE)
}

/// The same with another tolerance.
pub fn judge_at(k: u64, tolerance: f64) -> Result<Vec<Judged>> {
    let mut numbers = Numbers::new(0x9e37_79b9_7f4a_7c15 ^ (k + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9));
    for _ in 0..8 {
        numbers.between(0.0, 1.0);
    }
    let scene = Random::new(&mut numbers);
    let reference = scene.reference()?;
    let mut all = Vec::new();
    for (name, method) in [("adams", adams(tolerance)), ("steps", adams(tolerance))] {
        let mut sim = SimBuf::new(scene.model()?, method)?;
        let mut sim = sim.view();
        let mut noticed = None;
        if name == "adams" {
            sim.advance(scene.end())?;
            noticed = sim.notice();
        } else {
            // In calls of ten steps at the most, and what is left at once.
            sim.set_step_limit(10)?;
            while let Err(error) = sim.advance(scene.end()) {
                if error.status != nekton::Status::TooManySteps {
                    return Err(error);
                }
                noticed = noticed.or(sim.notice());
            }
        }
        let size = reference.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        let error =
            sim.state().iter().zip(&reference).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / (size * tolerance);
        let notice = noticed.map_or(String::new(), |(_, e)| e.status.name().into());
        let mut row = String::new();
        let Random { kind, torque, root, neighbour, pause, pulse, .. } = &scene;
        let evaluations = sim.counters().evaluations;
        let _ = writeln!(
            row,
            "{k},{kind},{torque},{root},{neighbour},{pause:.4e},{pulse:.4e},{name},{error:.2e},{evaluations},{notice}"
        );
        all.push(Judged { row, error, noticed: !notice.is_empty() });
    }
    Ok(all)
}
