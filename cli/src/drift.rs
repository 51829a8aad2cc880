//! Energy minus work, which nothing but errors can change.

use nekton::status::Status;

use crate::record::Row;
use crate::scene_file::Integrator;

/// Part of the largest kinetic energy so far from which on a drift is told.
const PART: f64 = 1e-3;
/// Part of the largest energy or work so far below which a drift is rounding.
const ROUNDING: f64 = 1e-12;

/// What a tolerance allows, as part of the largest kinetic energy of the whole run, is this many times the tolerance: while
/// something slowly comes off from rest, that may be all its energy.
const TOLERATED: f64 = 10.0;
/// The tolerance of methods that have none.
const TOLERANCE: f64 = 1e-9;

/// What the user should know of the drift along the rows of a run, if it ever was too large: since when, and its largest.
pub fn notice(rows: &[Row], integrator: Integrator) -> Option<String> {
    let balance = |r: &Row| r.energy.total - r.energy.work;
    let moving = |r: &Row| r.energy.kinetic_fluid + r.energy.kinetic_bodies;
    let first = balance(rows.first()?);
    let tolerance = match integrator {
        Integrator::Adams { tolerance, .. } => tolerance,
        _ => TOLERANCE,
    };
    let tolerated = (TOLERATED * tolerance).min(PART) * rows.iter().map(moving).fold(0.0, f64::max);
    let (mut kinetic, mut largest) = (0.0_f64, 0.0_f64);
    let mut since = None;
    // Time, drift, and the largest kinetic energy up to then.
    let mut worst = (0.0, 0.0_f64, 0.0);
    for row in rows {
        let e = &row.energy;
        kinetic = kinetic.max(moving(row));
        let parts = [e.kinetic_fluid, e.kinetic_bodies, e.buoyancy, e.repulsion, e.circulation, e.work];
        largest = parts.iter().fold(largest, |a, b| a.max(b.abs()));
        let drift = balance(row) - first;
        if drift.abs() > (PART * kinetic).max(ROUNDING * largest).max(tolerated) {
            since = since.or(Some(row.t));
            if drift.abs() > worst.1.abs() {
                worst = (row.t, drift, kinetic);
            }
        }
    }
    let (since, (time, drift, kinetic)) = (since?, worst);
    Some(format!(
        "from t = {since:.6} s: {}: their difference has changed by {drift:.3e} J/m at t = {time:.6} s, where the largest kinetic \
         energy so far is {kinetic:.3e} J/m (see whether a tighter tolerance, a `max_step` or a shorter step changes the motion)",
        Status::EnergyDrift.text()
    ))
}

#[cfg(test)]
mod tests {
    use super::notice;
    use crate::record::{Energies, Row};
    use crate::scene_file::Integrator;

    const RK4: Integrator = Integrator::Rk4 { step: 1.0 };

    fn rows(list: &[(f64, f64, f64)]) -> Vec<Row> {
        let row = |(k, (kinetic_bodies, buoyancy, work)): (usize, &(f64, f64, f64))| Row {
            t: k as f64,
            energy: Energies {
                kinetic_bodies: *kinetic_bodies,
                buoyancy: *buoyancy,
                total: kinetic_bodies + buoyancy,
                work: *work,
                ..Energies::default()
            },
            ..Row::default()
        };
        list.iter().enumerate().map(row).collect()
    }

    #[test]
    fn a_drift_is_told_from_a_thousandth_of_the_largest_kinetic_energy_so_far() {
        assert_eq!(notice(&rows(&[(0.0, 5.0, 0.0), (2.0, 3.0, 0.0019), (0.5, 4.5, 0.0)]), RK4), None);
        let told =
            notice(&rows(&[(0.0, 5.0, 0.0), (2.0, 3.0, 0.0021), (0.1, 5.0, 0.2), (9.0, 1.0, 0.0)]), RK4).unwrap();
        assert!(told.starts_with("from t = 1.000000 s: energy and the work"), "{told}");
        assert!(
            told.contains("by 4.996e0 J/m at t = 3.000000 s") || told.contains("by 5.000e0 J/m at t = 3"),
            "{told}"
        );
        // Work without motion is no rounding; a potential that keeps its digits is.
        assert!(notice(&rows(&[(0.0, 0.0, 0.0), (0.0, 0.0, 1e-9)]), RK4).is_some());
        assert_eq!(notice(&rows(&[(0.0, 1e6, 0.0), (0.0, 1e6 + 1e-7, 0.0)]), RK4), None);
        assert_eq!(notice(&[], RK4), None);
        // Slowly off from rest: what the tolerance allows is told only where the whole run has no more energy than that.
        let slow = [(0.0, 0.0, 0.0), (1e-9, 0.0, 0.9e-9), (2.0, 0.0, 2.0)];
        assert_eq!(notice(&rows(&slow), Integrator::adams(1e-9)), None);
        assert!(notice(&rows(&slow[..2]), Integrator::adams(1e-9)).is_some());
        assert!(notice(&rows(&slow), Integrator::adams(1e-12)).is_some());
    }
}
