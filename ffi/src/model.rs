//! Models, for both precisions.

use crate::check::Checked;
use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome, place_of};
use crate::memory::check_memory;
use crate::model_object::{begin_model, model, model_req};
#[cfg(feature = "std")]
use crate::shared::NEKTON_ALIGN;
use crate::types::*;
use nekton::scene::Description;
use nekton::{Formulation, Model, ModelMemory, ModelRequirement, Real, Status};

/// Writes a result through a pointer that was checked before anything was computed.
pub(crate) unsafe fn give<T>(to: *mut T, value: T) -> Outcome<Status> {
    // SAFETY: `check_pointer` was passed.
    unsafe { to.write(value) };
    Ok(Status::Ok)
}

pub(crate) unsafe fn req<R: Real>(def: *const SceneDef<R>, req: *mut nekton_req) -> Outcome<Status> {
    check_pointer("req", req.cast_const())?;
    // SAFETY: the caller's promise about the definition.
    unsafe {
        let scene = Checked::new(def)?;
        give(req, model_req::<R>(&Model::requirement(&scene)?)?)
    }
}

/// Compiles into memory; the notice of the first boundary that has one.
pub(crate) unsafe fn init<R: Real>(
    mem: *mut u8,
    len: usize,
    def: *const SceneDef<R>,
    out: *mut *mut ModelHandle<R>,
) -> Outcome<Option<Fault>> {
    check_pointer("model", out.cast_const())?;
    // SAFETY: the caller's promise about the definition; the memory is checked before it is written.
    unsafe {
        let scene = Checked::new(def)?;
        let need = Model::requirement(&scene)?;
        check_memory(mem, len, &model_req::<R>(&need)?, (def.addr(), size_of::<SceneDef<R>>()))?;
        compile(mem, &scene, &need, out, false, |_| Ok(()))
    }
}

/// Compiles into memory that was checked.
unsafe fn compile<R: Real>(
    mem: *mut u8,
    scene: &impl Description<R>,
    need: &ModelRequirement,
    out: *mut *mut ModelHandle<R>,
    owned: bool,
    look: impl FnOnce(&mut ModelMemory<'_, R>) -> nekton::Result<()>,
) -> Outcome<Option<Fault>> {
    // SAFETY: the caller's promise.
    unsafe {
        let mut parts = begin_model(mem, need)?;
        let head = Model::init(scene, &mut parts.memory)?;
        look(&mut parts.memory)?;
        let handle = parts.finish(head, owned)?;
        give(out, handle)?;
        let notice = model(handle.cast_const())?.notices().next();
        Ok(notice.map(|(place, status)| Fault::from(status).at(place)))
    }
}

/// Memory from the heap.
#[cfg(feature = "std")]
fn allocate(req: &nekton_req) -> Outcome<*mut u8> {
    let layout = std::alloc::Layout::from_size_align(req.size, req.align)
        .map_err(|_| Fault::of(Status::SizeOverflow, "size", req.size as f64))?;
    // SAFETY: the size is not 0: every object has a front.
    let mem = unsafe { std::alloc::alloc(layout) };
    if mem.is_null() { Err(Fault::of(Status::OutOfMemory, "size", req.size as f64)) } else { Ok(mem) }
}

#[cfg(feature = "std")]
unsafe fn release(mem: *mut u8, bytes: usize) {
    if let Ok(layout) = std::alloc::Layout::from_size_align(bytes, NEKTON_ALIGN) {
        // SAFETY: from `allocate` with the same layout.
        unsafe { std::alloc::dealloc(mem, layout) };
    }
}

/// Makes an object in memory from the heap, which is given back if that fails.
#[cfg(feature = "std")]
pub(crate) unsafe fn on_heap<T>(req: &nekton_req, make: impl FnOnce(*mut u8) -> Outcome<T>) -> Outcome<T> {
    let mem = allocate(req)?;
    let made = make(mem);
    if made.is_err() {
        // SAFETY: just allocated, and nothing was made of it.
        unsafe { release(mem, req.size) };
    }
    made
}

#[cfg(feature = "std")]
pub(crate) unsafe fn create<R: Real>(def: *const SceneDef<R>, out: *mut *mut ModelHandle<R>) -> Outcome<Option<Fault>> {
    check_pointer("model", out.cast_const())?;
    // SAFETY: the caller's promise about the definition.
    unsafe {
        let scene = Checked::new(def)?;
        let scene = nekton::Resolved::of(&scene)?;
        let need = Model::requirement(&scene)?;
        on_heap(&model_req::<R>(&need)?, |mem| {
            compile(mem, &scene, &need, out, true, |memory| memory.look_at_points(&scene))
        })
    }
}

#[cfg(feature = "std")]
pub(crate) unsafe fn free<R: Real>(handle: *mut ModelHandle<R>) -> Outcome<Status> {
    if handle.is_null() {
        return Ok(Status::Ok);
    }
    // SAFETY: `retire_model` checks that the object came from `create`.
    unsafe {
        let owned = crate::model_object::retire_model(handle)?;
        release(owned.mem, owned.bytes);
    }
    Ok(Status::Ok)
}

#[cfg(feature = "std")]
pub(crate) unsafe fn free_sim<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Status> {
    if handle.is_null() {
        return Ok(Status::Ok);
    }
    // SAFETY: `retire_sim` checks that the object came from `create`.
    unsafe {
        let owned = crate::sim_object::retire_sim(handle)?;
        release(owned.mem, owned.bytes);
    }
    Ok(Status::Ok)
}

#[cfg(not(feature = "std"))]
pub(crate) unsafe fn create<R: Real>(_: *const SceneDef<R>, _: *mut *mut ModelHandle<R>) -> Outcome<Option<Fault>> {
    Err(Status::Unsupported.into())
}

#[cfg(not(feature = "std"))]
pub(crate) unsafe fn free<R: Real>(handle: *mut ModelHandle<R>) -> Outcome<Status> {
    if handle.is_null() { Ok(Status::Ok) } else { Err(Status::Unsupported.into()) }
}

#[cfg(not(feature = "std"))]
pub(crate) unsafe fn free_sim<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Status> {
    if handle.is_null() { Ok(Status::Ok) } else { Err(Status::Unsupported.into()) }
}

pub(crate) unsafe fn plan<R: Real>(handle: *const ModelHandle<R>, out: *mut nekton_plan) -> Outcome<Status> {
    check_pointer("plan", out.cast_const())?;
    // SAFETY: checked in `model`.
    let model = unsafe { model(handle) }?;
    let p = model.plan();
    let plan = nekton_plan {
        formulation: match p.formulation {
            Formulation::Velocity => NEKTON_FORMULATION_VELOCITY,
            Formulation::Kirchhoff => NEKTON_FORMULATION_KIRCHHOFF,
            Formulation::LockedMomentum => NEKTON_FORMULATION_LOCKED_MOMENTUM,
        },
        fluid: i32::from(p.fluid),
        gravity: i32::from(p.gravity),
        repulsion: i32::from(p.repulsion),
        circulation: i32::from(p.circulation),
        links: p.links,
        walls: p.walls,
        joints: model.joint_count(),
        channels: model.channel_count(),
        notices: model.notices().count(),
        coordinates: 3 * p.links,
        free_coordinates: p.free_coordinates,
        prescribed_coordinates: p.prescribed_coordinates,
        state_len: p.state_len,
        unknowns: p.unknowns,
        moving_unknowns: p.moving_unknowns,
        right_hand_sides: p.right_hand_sides,
        tolerance: p.tolerance,
        // SAFETY: checked in `model`.
        model_bytes: unsafe { crate::model_object::model_bytes(handle) }?,
        sim_bytes: crate::sim_object::sim_req(&model)?.size,
        operations: p.operations,
    };
    // SAFETY: checked above.
    unsafe { give(out, plan) }
}

fn out_of_range(what: &'static str, i: usize) -> Fault {
    Fault::of(Status::OutOfRange, what, i as f64)
}

pub(crate) unsafe fn link<R: Real>(handle: *const ModelHandle<R>, i: usize, out: *mut LinkOut<R>) -> Outcome<Status> {
    check_pointer("info", out.cast_const())?;
    // SAFETY: checked in `model`.
    let l = unsafe { model(handle) }?.link(i).ok_or(out_of_range("link", i))?;
    let info = LinkOut {
        place: l.place.into(),
        nodes: l.nodes,
        mass: l.mass,
        inertia: l.inertia,
        area: l.area,
        perimeter: l.perimeter,
        centroid: l.centroid,
    };
    // SAFETY: checked above.
    unsafe { give(out, info) }
}

pub(crate) unsafe fn joint<R: Real>(
    handle: *const ModelHandle<R>,
    j: usize,
    out: *mut nekton_joint_info,
) -> Outcome<Status> {
    check_pointer("info", out.cast_const())?;
    // SAFETY: checked in `model`.
    let joint = unsafe { model(handle) }?.joint(j).ok_or(out_of_range("joint", j))?;
    // SAFETY: checked above.
    unsafe { give(out, nekton_joint_info { place: joint.place.into(), prescribed: i32::from(joint.prescribed) }) }
}

pub(crate) unsafe fn notice<R: Real>(
    handle: *const ModelHandle<R>,
    i: usize,
    place: *mut nekton_place,
    status: *mut nekton_status,
) -> Outcome<Status> {
    check_pointer("place", place.cast_const())?;
    check_pointer("status", status.cast_const())?;
    // SAFETY: checked in `model`.
    let notice = unsafe { model(handle) }?.notices().nth(i).ok_or(out_of_range("notice", i))?;
    // SAFETY: checked above.
    unsafe {
        give(place, notice.0.into())?;
        give(status, notice.1.code())
    }
}

/// −1 where it is not known.
pub(crate) unsafe fn outline_error<R: Real>(
    handle: *const ModelHandle<R>,
    place: *const nekton_place,
    out: *mut R,
) -> Outcome<Status> {
    check_pointer("place", place)?;
    check_pointer("error", out.cast_const())?;
    // SAFETY: checked above and in `model`.
    unsafe {
        let place = *place;
        let there = place_of(&place).zip(Some(model(handle)?)).filter(|(p, model)| model.nodes(*p).is_some());
        let (p, model) = there.ok_or(Fault::of(Status::OutOfRange, "place", f64::from(place.kind)))?;
        give(out, model.outline_error(p).unwrap_or(-R::one()))
    }
}

pub(crate) unsafe fn nodes<R: Real>(
    handle: *const ModelHandle<R>,
    place: *const nekton_place,
    out: *mut usize,
) -> Outcome<Status> {
    check_pointer("place", place)?;
    check_pointer("nodes", out.cast_const())?;
    // SAFETY: checked above and in `model`.
    unsafe {
        let place = *place;
        let nodes = place_of(&place).zip(Some(model(handle)?)).and_then(|(p, model)| model.nodes(p));
        give(out, nodes.ok_or(Fault::of(Status::OutOfRange, "place", f64::from(place.kind)))?)
    }
}

pub(crate) unsafe fn outline_point<R: Real>(
    handle: *const ModelHandle<R>,
    place: *const nekton_place,
    t: R,
    out: *mut [R; 2],
) -> Outcome<Status> {
    check_pointer("place", place)?;
    check_pointer("point", out.cast_const())?;
    if !t.is_finite() {
        return Err(Fault::of(Status::NotFinite, "t", t.to_f64()));
    }
    // SAFETY: checked above and in `model`.
    unsafe {
        let place = *place;
        let model = model(handle)?;
        let point = place_of(&place).and_then(|p| model.outline_point(p, t));
        give(out, point.ok_or(Fault::of(Status::OutOfRange, "place", f64::from(place.kind)))?)
    }
}
