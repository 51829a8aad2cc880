//! Steps that resolve the drives, taken from the drives alone: what the second opinion goes by.

use nekton::scene::{Drive, Root, Scene, Signal};

/// Times at which trajectories are compared, after the start.
pub const OUTPUTS: usize = 16;

/// Steps in a period of a harmonic …
const PERIOD: f64 = 8.0;
/// … in a ramp of a window, the steepest of smooth functions …
const RAMP: f64 = 12.0;
/// … and in a stretch of a table that one quintic describes so well, relative to the range of its values.
const STRETCH: f64 = 2.0;
const DESCRIBED: f64 = 1e-6;

/// A time during which steps should not be longer than `step`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    from: f64,
    to: f64,
    step: f64,
}

/// Equal steps from one time to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stride {
    /// Start.
    pub from: f64,
    /// End.
    pub to: f64,
    /// How many.
    pub steps: usize,
}

/// The way from 0 to `until`, cut at the output times and wherever a drive may change its character. O(rows log rows).
pub fn strides(scene: &Scene<'_, f64>, until: f64) -> Vec<Stride> {
    let mut drives = Vec::new();
    for body in scene.bodies {
        if let Root::Prescribed(signals) = &body.root {
            drives.extend(signals.iter().map(spans));
        }
        drives.extend(body.links.iter().filter_map(|l| match &l.joint.as_ref()?.drive {
            Drive::Motion(signal) | Drive::Torque { torque: signal, .. } => Some(spans(signal)),
            Drive::Locked(_) => None,
        }));
    }
    let outputs = |k: usize| until * k as f64 / OUTPUTS as f64;
    // What differs by rounding is one time, and an output time is never the one that goes.
    let slack = 16.0 * f64::EPSILON * until;
    let own = |t: &f64| (t - outputs((t / until * OUTPUTS as f64).round() as usize)).abs() > slack;
    let edges = drives.iter().flatten().flat_map(|s| [s.from, s.to]).filter(|t| *t > 0.0 && *t < until).filter(own);
    let mut times: Vec<f64> = (0..=OUTPUTS).map(outputs).chain(edges).collect();
    times.sort_by(f64::total_cmp);
    times.dedup_by(|next, last| *next - *last <= slack);
    let mut all = Vec::new();
    for pair in times.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let (middle, length) = (0.5 * (from + to), to - from);
        // Spans of one drive that do not overlap are in order; of a drive with several terms they are few.
        let step = drives.iter().map(|spans| here(spans, middle)).fold(f64::INFINITY, f64::min);
        let steps = (length / step - 1e-9).ceil().clamp(1.0, 1e9) as usize;
        all.push(Stride { from, to, steps });
    }
    all
}

/// The shortest step asked for at a time.
fn here(spans: &[Span], t: f64) -> f64 {
    let after = spans.partition_point(|s| s.from <= t);
    let near = spans.iter().take(after).rev().take(8);
    near.filter(|s| s.to > t).map(|s| s.step).fold(f64::INFINITY, f64::min)
}

/// The times during which a function asks for short steps, by their starts.
fn spans(signal: &Signal<'_, f64>) -> Vec<Span> {
    match signal {
        Signal::Constant(_) | Signal::Channel => Vec::new(),
        Signal::Harmonic { terms, window } => {
            let fastest = terms.iter().filter(|h| h.amplitude != 0.0).map(|h| h.frequency.abs()).fold(0.0, f64::max);
            let step = std::f64::consts::TAU / fastest / PERIOD;
            let Some(w) = window else { return vec![Span { from: 0.0, to: f64::INFINITY, step }] };
            let ramp = step.min(w.ramp / RAMP);
            let [up, down] = [w.from + w.ramp, w.to - w.ramp];
            let all = [(w.from, up, ramp), (up, down, step), (down, w.to, ramp)];
            all.into_iter().filter(|(a, b, _)| b > a).map(|(from, to, step)| Span { from, to, step }).collect()
        }
        Signal::Table(rows) => {
            let values = rows.iter().map(|r| r[1]);
            let range = values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min);
            let mut spans = Vec::new();
            let mut first = 0;
            while first + 1 < rows.len() {
                let last = stretch(rows, first, DESCRIBED * range);
                let (from, to) = (rows[first][0], rows[last][0]);
                if to > from {
                    spans.push(Span { from, to, step: (to - from) / STRETCH });
                }
                first = last;
            }
            spans
        }
    }
}

/// The last of the rows from `first` on that one quintic through both ends describes, found by doubling. Where the time stands
/// still there is a jump, and no quintic goes across it.
fn stretch(rows: &[[f64; 4]], first: usize, within: f64) -> usize {
    let fits = |last: usize| {
        let (a, b) = (&rows[first], &rows[last]);
        (first + 1..last).all(|k| (quintic(a, b, rows[k][0]) - rows[k][1]).abs() <= within)
            && (first..last).all(|k| last == first + 1 || rows[k + 1][0] > rows[k][0])
    };
    let mut length = 1;
    while first + 2 * length < rows.len() && fits(first + 2 * length) {
        length *= 2;
    }
    first + length
}

/// The quintic with the values, rates and accelerations of two rows.
fn quintic(a: &[f64; 4], b: &[f64; 4], t: f64) -> f64 {
    let h = b[0] - a[0];
    let side = |r: &[f64; 4], x: f64, h: f64| {
        let (p, q, s) = (r[1], r[2] * h, 0.5 * r[3] * h * h);
        (1.0 - x).powi(3) * (p * (1.0 + 3.0 * x + 6.0 * x * x) + q * x * (1.0 + 3.0 * x) + s * x * x)
    };
    let x = (t - a[0]) / h;
    side(a, x, h) + side(b, 1.0 - x, -h)
}

#[cfg(test)]
mod tests {
    use nekton::scene::{
        Body, CirculationModel, Drive, ForceFormula, Harmonic, Joint, JointKind, Link, Mass, Quadrature, Root, Scene,
        Shape, Signal, Window,
    };

    use super::{Stride, strides};

    /// The strides of a scene with these drives at its joints.
    fn of(drives: &[Drive<'_, f64>], until: f64) -> Vec<Stride> {
        let joint = |drive| Joint {
            parent: 0,
            kind: JointKind::Hinge,
            parent_anchor: [1.2, 0.0],
            self_anchor: [-1.2, 0.0],
            drive,
        };
        let links: Vec<Link<'_, f64>> = std::iter::once(None)
            .chain(drives.iter().map(|d| Some(joint(*d))))
            .map(|joint| Link {
                shape: Shape::Ellipse { a: 1.0, b: 0.3 },
                mass: Mass::Density(1.0),
                nodes: 24,
                circulation: 0.0,
                joint,
            })
            .collect();
        let bodies = [Body { pose: [0.0; 3], velocity: [0.0; 3], root: Root::Free, links: &links }];
        let scene = Scene {
            fluid_density: 1.0,
            gravity: 0.0,
            repulsion: None,
            circulation: CirculationModel::Full,
            tank: None,
            obstacles: &[],
            bodies: &bodies,
            force: ForceFormula::ExactGradient,
            quadrature: Quadrature::Graded,
            tolerance: None,
            allow_unresolved: false,
            shortcuts: true,
        };
        let all = strides(&scene, until);
        // They follow each other from 0 to the end.
        assert_eq!((all[0].from, all[all.len() - 1].to), (0.0, until));
        assert!(all.windows(2).all(|p| p[0].to == p[1].from && p[0].from < p[0].to));
        all
    }

    /// Longest step of strides that have something of (from, to).
    fn longest(all: &[Stride], from: f64, to: f64) -> f64 {
        let within = all.iter().filter(|s| s.from < to && s.to > from);
        within.map(|s| (s.to - s.from) / s.steps as f64).fold(0.0, f64::max)
    }

    #[test]
    fn steps_are_short_where_a_drive_is_fast_and_only_there() {
        let terms = [Harmonic { amplitude: 1.0, frequency: 50.0, phase: 0.0, offset: 0.0 }];
        let window = Some(Window { from: 600.0, to: 600.01, ramp: 0.004 });
        let all = of(&[Drive::Motion(Signal::Harmonic { terms: &terms, window })], 1000.0);
        assert!(longest(&all, 600.0, 600.004).max(longest(&all, 600.006, 600.01)) < 0.0004, "{all:?}");
        assert!(longest(&all, 0.0, 600.0) > 30.0 && all.len() < 25, "{all:?}");
    }

    #[test]
    fn smooth_rows_are_taken_together_and_pulses_and_jumps_between_long_rests_are_not() {
        let smooth: Vec<[f64; 4]> =
            (0..=20_000).map(|k| 1e-3 * f64::from(k)).map(|t| [t, t.sin(), t.cos(), -t.sin()]).collect();
        let all = of(&[Drive::Motion(Signal::Table(&smooth))], 20.0);
        assert!(longest(&all, 0.0, 20.0) < 1.0 && all.len() < 200, "{}", all.len());
        let mut rows: Vec<[f64; 4]> = (0..5000).map(|k| [0.2 * f64::from(k), 0.0, 0.0, 0.0]).collect();
        for (k, u) in [(2000, 1e-3), (2001, 1.0), (2002, 1e-3)] {
            rows[k] = [400.0 + 0.001 * (k as f64 - 2000.0), u, 0.0, 0.0];
        }
        let torque = |table| Drive::Torque {
            torque: Signal::Table(table),
            stiffness: 0.0,
            damping: 0.0,
            rest: 0.0,
            start: [0.0; 2],
        };
        let all = of(&[torque(&rows)], 999.0);
        assert!(longest(&all, 400.0, 400.002) <= 0.0006, "{all:?}");
        assert!(all.len() < 100, "{}", all.len());
        let jump = [[0.0, 0.0, 0.0, 0.0], [3.3, 0.0, 0.0, 0.0], [3.3, 1.0, 0.0, 0.0], [9.0, 1.0, 0.0, 0.0]];
        assert!(of(&[torque(&jump)], 10.0).iter().any(|s| s.to == 3.3));
        // An edge that is an output time but for rounding takes nothing away.
        let edge = 5.0_f64.next_down();
        let near = [[0.0, 0.0, 0.0, 0.0], [edge, 0.0, 0.0, 0.0], [9.0, 1.0, 0.0, 0.0]];
        let all = of(&[torque(&near)], 10.0);
        assert!(all.iter().any(|s| s.to == 5.0) && all.iter().all(|s| s.to != edge), "{all:?}");
    }
}
