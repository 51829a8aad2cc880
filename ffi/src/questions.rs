//! What simulations are asked about the state shown.

use crate::buffers::{disjoint, length, output, sound};
use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome, place_or_none};
use crate::memory::copy;
use crate::model::give;
use crate::sim_object::{SimParts, sim};
use crate::types::*;
use nekton::{Real, Resolution, Result, Sim, Status};

/// Number of coordinates (3 per link) to the power `rank`.
fn size<R: Real>(parts: &SimParts<'_, R>, rank: u32) -> usize {
    parts.model.link_count().saturating_mul(3).saturating_pow(rank)
}

/// What an array-valued question asks.
pub(crate) type Question<R> = for<'a, 'b, 'c> fn(&'a mut Sim<'b, R>, &'c mut [R]) -> Result<()>;

/// Fills an array of (3 links)^rank numbers.
pub(crate) unsafe fn ask<R: Real>(
    handle: *mut SimHandle<R>,
    out: *mut R,
    n: usize,
    rank: u32,
    question: Question<R>,
) -> Outcome<Status> {
    // SAFETY: checked in `sim` and `output`.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let out = output(&parts, "out", out, n, size(&parts, rank))?;
        let answer = question(&mut parts.view()?, out);
        if let Err(error) = answer {
            out.fill(R::zero());
            return Err(error.into());
        }
        sound(out.iter().copied())
    }
}

/// Positions or velocities.
pub(crate) unsafe fn shown<R: Real>(
    handle: *const SimHandle<R>,
    out: *mut R,
    n: usize,
    velocities: bool,
) -> Outcome<Status> {
    // SAFETY: checked in `sim` and `output`.
    unsafe {
        let mut parts = sim(handle)?;
        let out = output(&parts, "out", out, n, size(&parts, 1))?;
        let sim = parts.view()?;
        copy(out, if velocities { sim.velocities() } else { sim.positions() });
    }
    Ok(Status::Ok)
}

/// Two arrays with one entry per joint.
pub(crate) unsafe fn joints<R: Real>(
    handle: *mut SimHandle<R>,
    first: (&'static str, *mut R),
    second: (&'static str, *mut R),
    n: usize,
    question: impl FnOnce(&mut Sim<'_, R>, &mut [R], &mut [R]) -> Result<()>,
) -> Outcome<Status> {
    // SAFETY: checked in `sim` and `output`.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let need = parts.model.joint_count();
        length(n, need)?;
        disjoint(second.0, first.1.cast_const(), second.1.cast_const(), n)?;
        let a = output(&parts, first.0, first.1, n, need)?;
        let b = output(&parts, second.0, second.1, n, need)?;
        let answer = question(&mut parts.view()?, a, b);
        if let Err(error) = answer {
            a.fill(R::zero());
            b.fill(R::zero());
            return Err(error.into());
        }
        sound(a.iter().chain(b.iter()).copied())
    }
}

pub(crate) fn joint_values<R: Real>(sim: &mut Sim<'_, R>, u: &mut [R], du: &mut [R]) -> Result<()> {
    sim.joint_values(u, du);
    Ok(())
}

pub(crate) unsafe fn energy<R: Real>(handle: *mut SimHandle<R>, out: *mut EnergyOut<R>) -> Outcome<Status> {
    check_pointer("energy", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let e = sim(handle.cast_const())?.view()?.energy()?;
        sound([e.total, e.work])?;
        let energy = EnergyOut {
            kinetic_fluid: e.kinetic_fluid,
            kinetic_bodies: e.kinetic_bodies,
            buoyancy: e.buoyancy,
            repulsion: e.repulsion,
            circulation: e.circulation,
            total: e.total,
            work: e.work,
        };
        give(out, energy)
    }
}

pub(crate) unsafe fn impulse<R: Real>(handle: *mut SimHandle<R>, out: *mut [R; 3]) -> Outcome<Status> {
    check_pointer("impulse", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let impulse = sim(handle.cast_const())?.view()?.impulse()?;
        sound(impulse)?;
        give(out, impulse)
    }
}

pub(crate) unsafe fn energy_drift<R: Real>(handle: *mut SimHandle<R>, out: *mut [R; 3]) -> Outcome<Status> {
    check_pointer("drift", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let drift = sim(handle.cast_const())?.view()?.energy_drift()?;
        let drift = [drift.amount, drift.kinetic, drift.allowed];
        sound(drift)?;
        give(out, drift)
    }
}

pub(crate) unsafe fn resolution<R: Real>(
    handle: *mut SimHandle<R>,
    out: *mut ResolutionOut<R>,
    question: impl FnOnce(&mut Sim<'_, R>) -> Result<Resolution<R>>,
) -> Outcome<Status> {
    check_pointer("resolution", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let r = question(&mut sim(handle.cast_const())?.view()?)?;
        sound([r.mass, r.force, r.quadrature, r.repulsion])?;
        let Resolution { mass, force, quadrature, repulsion } = r;
        give(out, ResolutionOut { mass, force, quadrature, repulsion, bound: r.bound() })
    }
}

pub(crate) unsafe fn time_error<R: Real>(handle: *const SimHandle<R>, out: *mut TimeErrorOut<R>) -> Outcome<Status> {
    check_pointer("error", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let e = sim(handle)?.view()?.time_error();
        let error = TimeErrorOut {
            length: e.length,
            angle: e.angle,
            speed: e.speed,
            spin: e.spin,
            length_sum: e.length_sum,
            angle_sum: e.angle_sum,
            speed_sum: e.speed_sum,
            spin_sum: e.spin_sum,
            unknown: e.unknown,
        };
        give(out, error)
    }
}

pub(crate) unsafe fn gap<R: Real>(handle: *mut SimHandle<R>, out: *mut GapOut<R>) -> Outcome<Status> {
    check_pointer("gap", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let g = sim(handle.cast_const())?.view()?.gap();
        let gap = GapOut {
            distance: g.distance,
            first: place_or_none(g.between.map(|b| b.0)),
            second: place_or_none(g.between.map(|b| b.1)),
        };
        if gap.distance.is_nan() {
            return Err(Fault::of(Status::NonFiniteState, "gap", f64::NAN));
        }
        give(out, gap)
    }
}

pub(crate) unsafe fn counters<R: Real>(handle: *const SimHandle<R>, out: *mut nekton_counters) -> Outcome<Status> {
    check_pointer("counters", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe {
        let c = sim(handle)?.view()?.counters();
        let counters = nekton_counters {
            evaluations: c.evaluations,
            factorizations: c.factorizations,
            steps: c.steps,
            rejected: c.rejected,
        };
        give(out, counters)
    }
}
