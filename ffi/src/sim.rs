//! Simulations, for both precisions.

use crate::convert::{check_pointer, method as read_method};
use crate::diag::{Fault, Outcome, place_or_none};
use crate::memory::{SimParts, check_memory, make_sim, model, model_bytes, remembered, sim, sim_req};
use crate::model::give;
use crate::types::*;
use nekton::{Method, Real, Resolution, Result, Sim, Status};

unsafe fn method<R: Real>(def: *const MethodDef<R>) -> Outcome<Method<R>> {
    check_pointer("method", def)?;
    // SAFETY: checked; the caller's promise.
    read_method(unsafe { &*def })
}

pub(crate) unsafe fn req<R: Real>(
    handle: *const ModelHandle<R>,
    def: *const MethodDef<R>,
    req: *mut nekton_req,
) -> Outcome<Status> {
    check_pointer("req", req.cast_const())?;
    // SAFETY: checked in `model` and `method`.
    unsafe {
        let model = model(handle)?;
        Sim::head(method(def)?)?;
        give(req, sim_req(&model)?)
    }
}

pub(crate) unsafe fn init<R: Real>(
    mem: *mut u8,
    len: usize,
    handle: *const ModelHandle<R>,
    def: *const MethodDef<R>,
    out: *mut *mut SimHandle<R>,
    owned: bool,
) -> Outcome<Status> {
    check_pointer("sim", out.cast_const())?;
    // SAFETY: checked in `model` and `method`; the memory is checked before it is written.
    unsafe {
        let model = model(handle)?;
        let head = Sim::head(method(def)?)?;
        check_memory(mem, len, &sim_req(&model)?, (handle.addr(), model_bytes(handle)?))?;
        give(out, make_sim(mem, handle, head, owned)?)
    }
}

#[cfg(feature = "std")]
pub(crate) unsafe fn create<R: Real>(
    handle: *const ModelHandle<R>,
    def: *const MethodDef<R>,
    out: *mut *mut SimHandle<R>,
) -> Outcome<Status> {
    let mut need = nekton_req::default();
    // SAFETY: as in `init`.
    unsafe {
        check_pointer("sim", out.cast_const())?;
        req(handle, def, &mut need)?;
        crate::model::on_heap(&need, |mem| init(mem, need.size, handle, def, out, true))
    }
}

#[cfg(not(feature = "std"))]
pub(crate) unsafe fn create<R: Real>(
    _: *const ModelHandle<R>,
    _: *const MethodDef<R>,
    _: *mut *mut SimHandle<R>,
) -> Outcome<Status> {
    Err(Status::Unsupported.into())
}

pub(crate) unsafe fn assign<R: Real>(to: *mut SimHandle<R>, from: *const SimHandle<R>) -> Outcome<Status> {
    // SAFETY: checked in `sim`; two objects, since their handles differ.
    unsafe {
        if core::ptr::eq(to.cast_const(), from) {
            remembered(from)?;
            return Ok(Status::Ok);
        }
        let from = remembered(from)?;
        let mut to = sim(to.cast_const())?;
        if !core::ptr::eq(to.handle, from.handle) {
            return Err(Fault::of(Status::BadHandle, "model", f64::NAN));
        }
        to.assign(&from);
    }
    Ok(Status::Ok)
}

pub(crate) unsafe fn model_of<R: Real>(
    handle: *const SimHandle<R>,
    out: *mut *const ModelHandle<R>,
) -> Outcome<Status> {
    check_pointer("model", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe { give(out, remembered(handle)?.handle) }
}

pub(crate) unsafe fn time<R: Real>(handle: *const SimHandle<R>, out: *mut R) -> Outcome<Status> {
    check_pointer("t", out.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe { give(out, sim(handle)?.view()?.time()) }
}

/// An input buffer of a known length.
unsafe fn input<'a, R: Real>(what: &'static str, first: *const R, n: usize, need: usize) -> Outcome<&'a [R]> {
    length(n, need)?;
    // SAFETY: the caller's promise about the buffer.
    let values = unsafe { crate::convert::array(what, first, n) }?;
    for x in values {
        finite(what, *x)?;
    }
    Ok(values)
}

/// An output buffer of a known length, outside the object, filled with zeros.
unsafe fn output<'a, R: Real>(
    parts: &SimParts<'_, R>,
    what: &'static str,
    first: *mut R,
    n: usize,
    need: usize,
) -> Outcome<&'a mut [R]> {
    length(n, need)?;
    if n == 0 {
        return Ok(&mut []);
    }
    check_pointer(what, first.cast_const())?;
    if n > isize::MAX as usize / size_of::<R>() {
        return Err(Fault::of(Status::SizeOverflow, what, n as f64));
    }
    if parts.overlaps(first.cast_const(), n) {
        return Err(Fault::of(Status::Aliasing, what, f64::NAN));
    }
    // SAFETY: not NULL, aligned, of an addressable size; the caller promises room. Written before it is a slice, since it
    // may never have been.
    Ok(unsafe {
        for i in 0..n {
            first.add(i).write(R::zero());
        }
        core::slice::from_raw_parts_mut(first, n)
    })
}

fn length(given: usize, need: usize) -> Outcome {
    if given == need { Ok(()) } else { Err(Fault::of(Status::Length, "length", given as f64)) }
}

fn finite<R: Real>(what: &'static str, x: R) -> Outcome {
    if x.is_finite() { Ok(()) } else { Err(Fault::of(Status::NotFinite, what, x.to_f64())) }
}

/// Refuses to call a result that is not finite a success.
fn sound<R: Real>(values: impl IntoIterator<Item = R>) -> Outcome<Status> {
    match values.into_iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Fault::of(Status::NonFiniteState, "result", x.to_f64())),
        None => Ok(Status::Ok),
    }
}

fn disjoint<R>(what: &'static str, a: *const R, b: *const R, n: usize) -> Outcome {
    let bytes = n.saturating_mul(size_of::<R>());
    let (a, b) = (a.addr(), b.addr());
    if n > 0 && a < b.saturating_add(bytes) && b < a.saturating_add(bytes) {
        return Err(Fault::of(Status::Aliasing, what, f64::NAN));
    }
    Ok(())
}

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

fn copy<R: Copy>(to: &mut [R], from: &[R]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t = *f;
    }
}

pub(crate) unsafe fn get_state<R: Real>(
    handle: *const SimHandle<R>,
    t: *mut R,
    y: *mut R,
    n: usize,
) -> Outcome<Status> {
    check_pointer("t", t.cast_const())?;
    // SAFETY: checked above, in `sim` and in `output`.
    unsafe {
        let mut parts = sim(handle)?;
        let need = parts.model.plan().state_len;
        let y = output(&parts, "y", y, n, need)?;
        let sim = parts.view()?;
        copy(y, sim.state());
        give(t, sim.time())
    }
}

pub(crate) unsafe fn set_state<R: Real>(handle: *mut SimHandle<R>, t: R, y: *const R, n: usize) -> Outcome<Status> {
    finite("t", t)?;
    // SAFETY: checked in `sim` and `input`.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let need = parts.model.plan().state_len;
        if parts.overlaps(y, n) {
            return Err(Fault::of(Status::Aliasing, "y", f64::NAN));
        }
        let y = input("y", y, n, need)?;
        parts.attempt(|sim| sim.set_state(t, y)).map_err(|f| Fault { time: f64::NAN, ..f })?;
    }
    Ok(Status::Ok)
}

pub(crate) unsafe fn restart<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Status> {
    // SAFETY: checked in `sim`.
    unsafe { sim(handle.cast_const())?.view()?.restart() };
    Ok(Status::Ok)
}

/// Attempts steps; the notice if the tolerance in space was not met.
unsafe fn steps<R: Real>(
    handle: *mut SimHandle<R>,
    call: impl FnOnce(&mut Sim<'_, R>) -> Result<()>,
) -> Outcome<Option<Fault>> {
    // SAFETY: checked in `sim`.
    let mut parts = unsafe { sim(handle.cast_const()) }?;
    parts.attempt(call)?;
    let notice = parts.view()?.notice();
    Ok(notice.map(|(time, error)| Fault { time: time.to_f64(), ..Fault::from(error) }))
}

pub(crate) unsafe fn step<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Option<Fault>> {
    // SAFETY: as above.
    unsafe { steps(handle, |sim| sim.step()) }
}

pub(crate) unsafe fn advance<R: Real>(handle: *mut SimHandle<R>, t_out: R, t_stop: R) -> Outcome<Option<Fault>> {
    finite("t", t_out)?;
    finite("t_stop", t_stop)?;
    // SAFETY: as above.
    unsafe { steps(handle, |sim| sim.advance_dense(t_out, t_stop)) }
}

pub(crate) unsafe fn set_step_limit<R: Real>(handle: *mut SimHandle<R>, steps: u64) -> Outcome<Status> {
    // SAFETY: checked in `sim`.
    unsafe { sim(handle.cast_const())?.view()?.set_step_limit(steps)? };
    Ok(Status::Ok)
}

pub(crate) unsafe fn set_channel<R: Real>(
    handle: *mut SimHandle<R>,
    channel: usize,
    from: *const [R; 4],
    to: *const [R; 4],
) -> Outcome<Status> {
    check_pointer("from", from)?;
    check_pointer("to", to)?;
    // SAFETY: checked above and in `sim`; the caller promises four numbers each.
    unsafe {
        let (from, to) = (*from, *to);
        let done = sim(handle.cast_const())?.attempt(|sim| sim.set_channel(channel, from, to));
        done.map_err(|f| Fault { time: f64::NAN, ..f })?;
    }
    Ok(Status::Ok)
}

pub(crate) unsafe fn rhs<R: Real>(
    handle: *mut SimHandle<R>,
    t: R,
    y: *const R,
    ydot: *mut R,
    n: usize,
) -> Outcome<Status> {
    finite("t", t)?;
    // SAFETY: checked in `sim`, `input` and `output`.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let need = parts.model.plan().state_len;
        length(n, need)?;
        disjoint("ydot", y, ydot.cast_const(), n)?;
        if parts.overlaps(y, n) {
            return Err(Fault::of(Status::Aliasing, "y", f64::NAN));
        }
        let y = input("y", y, n, need)?;
        let ydot = output(&parts, "ydot", ydot, n, need)?;
        parts.attempt(|sim| sim.rhs(t, y, ydot)).map_err(|f| Fault { time: f64::NAN, ..f })?;
        sound(ydot.iter().copied())
    }
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
