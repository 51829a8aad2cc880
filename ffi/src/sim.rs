//! What simulations are asked to do: start, step, take a state over.

use crate::buffers::{disjoint, finite, input, length, output, sound};
use crate::convert::{array, check_pointer, method as read_method};
use crate::diag::{Fault, Outcome};
use crate::memory::{check_memory, copy};
use crate::model::give;
use crate::model_object::{model, model_bytes};
use crate::sim_object::{Failed, make_sim, remembered, sim, sim_req};
use crate::sized;
use crate::types::*;
use nekton::{Method, Real, Result, Sim, Status};

unsafe fn method<R: Real>(def: *const MethodDef<R>) -> Outcome<Method<R>> {
    // SAFETY: the caller's promise.
    read_method(&unsafe { sized::one("method", def) }?)
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

pub(crate) unsafe fn save_req<R: Real>(handle: *const SimHandle<R>, bytes: *mut usize) -> Outcome<Status> {
    check_pointer("bytes", bytes.cast_const())?;
    // SAFETY: checked above and in `sim`.
    unsafe { give(bytes, sim(handle)?.view()?.save_len()) }
}

pub(crate) unsafe fn save<R: Real>(
    handle: *const SimHandle<R>,
    out: *mut u8,
    len: usize,
    written: *mut usize,
) -> Outcome<Status> {
    check_pointer("written", written.cast_const())?;
    // SAFETY: checked above, in `sim` and in `output`; the caller promises room for `len` bytes, and they are enough.
    unsafe {
        let mut parts = sim(handle)?;
        let need = parts.view()?.save_len();
        if len < need {
            return Err(Fault::of(Status::MemoryTooSmall, "len", len as f64));
        }
        let out = output(&parts, "out", out, need, need)?;
        give(written, parts.view()?.save(out)?)
    }
}

pub(crate) unsafe fn load<R: Real>(handle: *mut SimHandle<R>, from: *const u8, len: usize) -> Outcome<Status> {
    // SAFETY: checked in `sim` and `array`.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        if parts.overlaps(from, len) {
            return Err(Fault::of(Status::Aliasing, "from", f64::NAN));
        }
        let bytes = array("from", from, len)?;
        parts.view()?.load(bytes)?;
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
        parts.attempt(Failed::LeavesNothing, |sim| sim.set_state(t, y)).map_err(|f| Fault { time: f64::NAN, ..f })?;
    }
    Ok(Status::Ok)
}

pub(crate) unsafe fn restart<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Status> {
    // SAFETY: checked in `sim`.
    unsafe { sim(handle.cast_const())?.view()?.restart() };
    Ok(Status::Ok)
}

/// Attempts steps; the notice if there is one.
unsafe fn steps<R: Real>(
    handle: *mut SimHandle<R>,
    call: impl FnOnce(&mut Sim<'_, R>) -> Result<()>,
) -> Outcome<Option<Fault>> {
    // SAFETY: checked in `sim`.
    let mut parts = unsafe { sim(handle.cast_const()) }?;
    parts.attempt(Failed::KeepsSteps, call)?;
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
        let done = sim(handle.cast_const())?.attempt(Failed::LeavesNothing, |sim| sim.set_channel(channel, from, to));
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
        parts.attempt(Failed::LeavesNothing, |sim| sim.rhs(t, y, ydot)).map_err(|f| Fault { time: f64::NAN, ..f })?;
        sound(ydot.iter().copied())
    }
}
