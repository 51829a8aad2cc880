//! Objects in the caller's memory: a head with a mark at the front, records and reals behind it.

use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome};
use crate::shared::{NEKTON_ABI_VERSION, NEKTON_ALIGN as ALIGN};
use crate::types::{ModelHandle, SimHandle, nekton_req};
use core::mem::MaybeUninit;
use nekton::boundary::BoundaryRecord;
use nekton::model::{CoordinateRecord, LinkRecord};
use nekton::{Model, ModelHead, ModelRequirement, Real, Sim, SimHead, Status};

/// Reals begin on a cache line, wherever the object begins.
const LINE: usize = 64;

const MODEL_MARK: u64 = 0x6e65_6b74_6f6e_4d30;
const SIM_MARK: u64 = 0x6e65_6b74_6f6e_5330;

/// The mark of an object of a precision.
fn mark<R>(of: u64) -> u64 {
    of ^ size_of::<R>() as u64 ^ (u64::from(NEKTON_ABI_VERSION) << 8)
}

/// Front of a model.
#[repr(C)]
pub(crate) struct ModelObject<R> {
    mark: u64,
    /// Came from `create`.
    owned: u64,
    bytes: usize,
    /// Number that tells models apart.
    stamp: u64,
    links: usize,
    coordinates: usize,
    boundaries: usize,
    reals: usize,
    reals_at: usize,
    head: MaybeUninit<ModelHead<R>>,
}

/// Front of a simulation.
#[repr(C)]
pub(crate) struct SimObject<R> {
    mark: u64,
    owned: u64,
    bytes: usize,
    stamp: u64,
    model: *const ModelHandle<R>,
    reals: usize,
    reals_at: usize,
    /// Reals remembered from one call to the next; a copy of them lies behind the reals.
    kept: usize,
    head: MaybeUninit<SimHead<R>>,
    saved: MaybeUninit<SimHead<R>>,
}

const _: () = assert!(align_of::<ModelObject<f64>>() <= ALIGN && align_of::<SimObject<f64>>() <= ALIGN);
const _: () = assert!(align_of::<ModelObject<f32>>() <= ALIGN && align_of::<SimObject<f32>>() <= ALIGN);

/// Adds up bytes.
struct Sum(Option<usize>);

impl Sum {
    /// Adds `n` items; returns where they begin.
    fn items<T>(&mut self, n: usize) -> usize {
        let at = self.0.and_then(|at| at.checked_next_multiple_of(align_of::<T>()));
        self.0 = at.and_then(|at| at.checked_add(n.checked_mul(size_of::<T>())?));
        at.unwrap_or(0)
    }
    fn bytes(&self) -> Outcome<usize> {
        self.0.filter(|n| *n <= isize::MAX as usize).ok_or(Status::SizeOverflow.into())
    }
}

/// Where a model's arrays begin, in bytes from its front (reals: before they are moved to a cache line).
struct ModelPlaces {
    links: usize,
    coordinates: usize,
    boundaries: usize,
    reals: usize,
    bytes: usize,
}

impl ModelPlaces {
    fn of<R: Real>(need: &ModelRequirement) -> Outcome<Self> {
        let mut sum = Sum(Some(size_of::<ModelObject<R>>()));
        let links = sum.items::<LinkRecord<R>>(need.links);
        let coordinates = sum.items::<CoordinateRecord<R>>(need.coordinates);
        let boundaries = sum.items::<BoundaryRecord<R>>(need.boundaries);
        let reals = sum.items::<R>(need.reals);
        sum.items::<u8>(LINE);
        Ok(ModelPlaces { links, coordinates, boundaries, reals, bytes: round(sum.bytes()?)? })
    }
}

fn round(bytes: usize) -> Outcome<usize> {
    bytes.checked_next_multiple_of(ALIGN).ok_or(Status::SizeOverflow.into())
}

/// What a model needs.
pub(crate) fn model_req<R: Real>(need: &ModelRequirement) -> Outcome<nekton_req> {
    Ok(nekton_req { size: ModelPlaces::of::<R>(need)?.bytes, align: ALIGN })
}

/// Reals of a simulation: all, and those remembered.
fn sim_reals<R: Real>(model: &Model<'_, R>) -> Outcome<(usize, usize)> {
    Ok((Sim::requirement(model)?.reals, Sim::remembered(model)?))
}

/// What a simulation needs.
pub(crate) fn sim_req<R: Real>(model: &Model<'_, R>) -> Outcome<nekton_req> {
    let (reals, kept) = sim_reals(model)?;
    let mut sum = Sum(Some(size_of::<SimObject<R>>()));
    sum.items::<R>(reals);
    sum.items::<R>(kept);
    sum.items::<u8>(LINE);
    Ok(nekton_req { size: round(sum.bytes()?)?, align: ALIGN })
}

/// Whether two stretches of memory have a byte in common.
fn overlap(a: usize, a_len: usize, b: usize, b_len: usize) -> bool {
    a < b.saturating_add(b_len) && b < a.saturating_add(a_len)
}

/// Refuses memory that is NULL, misaligned or short, or that what it is made from lies in. Writes nothing.
pub(crate) fn check_memory(mem: *mut u8, len: usize, req: &nekton_req, source: (usize, usize)) -> Outcome {
    if mem.is_null() {
        return Err(Fault::of(Status::NullPointer, "mem", f64::NAN));
    }
    if !mem.addr().is_multiple_of(ALIGN) {
        return Err(Fault::of(Status::Misaligned, "mem", ALIGN as f64));
    }
    if len < req.size {
        return Err(Fault::of(Status::MemoryTooSmall, "len", len as f64));
    }
    if overlap(mem.addr(), req.size, source.0, source.1) {
        return Err(Fault::of(Status::Aliasing, "mem", f64::NAN));
    }
    Ok(())
}

/// The offset at or behind `at` that lies on a cache line.
fn on_line(mem: *const u8, at: usize) -> usize {
    at + mem.wrapping_add(at).addr().wrapping_neg() % LINE
}

/// Fills `n` items with a value and gives them as a slice.
unsafe fn fill<'a, T: Copy>(mem: *mut u8, at: usize, n: usize, value: T) -> &'a mut [T] {
    // SAFETY: the memory was checked to be long enough and aligned for offsets made by `Sum`.
    unsafe {
        let first = mem.add(at).cast::<T>();
        for i in 0..n {
            first.add(i).write(value);
        }
        core::slice::from_raw_parts_mut(first, n)
    }
}

/// A model's arrays in checked memory, filled with defaults; the object is marked as no object yet.
pub(crate) struct ModelParts<'a, R> {
    pub(crate) memory: nekton::ModelMemory<'a, R>,
    mem: *mut u8,
    need: ModelRequirement,
    reals_at: usize,
    bytes: usize,
}

pub(crate) unsafe fn begin_model<'a, R: Real>(mem: *mut u8, need: &ModelRequirement) -> Outcome<ModelParts<'a, R>> {
    let places = ModelPlaces::of::<R>(need)?;
    let reals_at = on_line(mem, places.reals);
    // SAFETY: `check_memory` was passed with this requirement.
    unsafe {
        mem.cast::<u64>().write(0);
        let memory = nekton::ModelMemory {
            links: fill(mem, places.links, need.links, LinkRecord::default()),
            coordinates: fill(mem, places.coordinates, need.coordinates, CoordinateRecord::default()),
            boundaries: fill(mem, places.boundaries, need.boundaries, BoundaryRecord::default()),
            reals: fill(mem, reals_at, need.reals, R::zero()),
        };
        Ok(ModelParts { memory, mem, need: *need, reals_at, bytes: places.bytes })
    }
}

impl<R: Real> ModelParts<'_, R> {
    /// Writes the head and marks the object as a model.
    pub(crate) unsafe fn finish(self, head: ModelHead<R>, owned: bool) -> Outcome<*mut ModelHandle<R>> {
        let stamp = self.stamp(&head);
        let object = ModelObject {
            mark: mark::<R>(MODEL_MARK),
            owned: u64::from(owned),
            bytes: self.bytes,
            stamp,
            links: self.need.links,
            coordinates: self.need.coordinates,
            boundaries: self.need.boundaries,
            reals: self.need.reals,
            reals_at: self.reals_at,
            head: MaybeUninit::new(head),
        };
        // SAFETY: checked memory; the records lie behind this struct.
        unsafe { self.mem.cast::<ModelObject<R>>().write(object) };
        Ok(self.mem.cast())
    }

    /// A number that differs between models that differ.
    fn stamp(&self, head: &ModelHead<R>) -> u64 {
        let m = &self.memory;
        let model = Model::view(head, m.links, m.coordinates, m.boundaries, m.reals);
        let plan = model.plan();
        let mut stamp = 0xcbf2_9ce4_8422_2325_u64;
        let mut add = |x: u64| stamp = (stamp ^ x).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29);
        for n in [
            plan.links,
            plan.walls,
            plan.unknowns,
            plan.free_coordinates,
            plan.prescribed_coordinates,
            plan.state_len,
            self.need.reals,
            model.channel_count(),
            usize::from(plan.gravity),
            usize::from(plan.repulsion),
            usize::from(plan.circulation),
        ] {
            add(n as u64);
        }
        for x in m.reals.iter() {
            add(x.to_f64().to_bits());
        }
        for l in m.links.iter() {
            for x in [l.mass, l.inertia, l.area, l.centroid.re, l.centroid.im] {
                add(x.to_f64().to_bits());
            }
        }
        stamp
    }
}

/// The front of a model after all checks.
unsafe fn model_object<'a, R: Real>(model: *const ModelHandle<R>) -> Outcome<&'a ModelObject<R>> {
    let object = model.cast::<ModelObject<R>>();
    check_pointer("model", object)?;
    // SAFETY: not NULL, aligned; only the mark is read before it is known to be a model.
    unsafe {
        if object.cast::<u64>().read() != mark::<R>(MODEL_MARK) {
            return Err(Fault::of(Status::BadHandle, "model", f64::NAN));
        }
        Ok(&*object)
    }
}

/// The model behind a handle.
pub(crate) unsafe fn model<'a, R: Real>(handle: *const ModelHandle<R>) -> Outcome<Model<'a, R>> {
    // SAFETY: a marked object was completed by `ModelParts::finish`; its memory is the caller's to keep.
    unsafe {
        let o = model_object(handle)?;
        let need =
            ModelRequirement { links: o.links, coordinates: o.coordinates, boundaries: o.boundaries, reals: o.reals };
        let at = ModelPlaces::of::<R>(&need)?;
        let mem = handle.cast::<u8>();
        Ok(Model::view(
            o.head.assume_init_ref(),
            core::slice::from_raw_parts(mem.add(at.links).cast(), o.links),
            core::slice::from_raw_parts(mem.add(at.coordinates).cast(), o.coordinates),
            core::slice::from_raw_parts(mem.add(at.boundaries).cast(), o.boundaries),
            core::slice::from_raw_parts(mem.add(o.reals_at).cast(), o.reals),
        ))
    }
}

/// Sets a simulation up in checked memory.
pub(crate) unsafe fn make_sim<R: Real>(
    mem: *mut u8,
    handle: *const ModelHandle<R>,
    mut head: SimHead<R>,
    owned: bool,
) -> Outcome<*mut SimHandle<R>> {
    // SAFETY: `check_memory` was passed with this model's requirement.
    unsafe {
        let stamp = model_object(handle)?.stamp;
        let model = model(handle)?;
        let (reals, kept) = sim_reals(&model)?;
        let bytes = sim_req(&model)?.size;
        let reals_at = on_line(mem, size_of::<SimObject<R>>());
        mem.cast::<u64>().write(0);
        let memory = fill(mem, reals_at, reals + kept, R::zero());
        let (memory, _) = memory.split_at_mut_checked(reals).ok_or(Status::Internal)?;
        Sim::init(model, &mut head, memory)?;
        let object = SimObject {
            mark: mark::<R>(SIM_MARK),
            owned: u64::from(owned),
            bytes,
            stamp,
            model: handle,
            reals,
            reals_at,
            kept,
            head: MaybeUninit::new(head),
            saved: MaybeUninit::new(head),
        };
        mem.cast::<SimObject<R>>().write(object);
        Ok(mem.cast())
    }
}

/// What a simulation remembers, read only: any number of threads may look at once.
pub(crate) struct Remembered<'a, R> {
    pub(crate) handle: *const ModelHandle<R>,
    head: &'a SimHead<R>,
    reals: &'a [R],
}

/// The front of a simulation whose mark and model are in order.
unsafe fn sim_object<'a, R: Real>(handle: *const SimHandle<R>) -> Outcome<&'a SimObject<R>> {
    let object = handle.cast::<SimObject<R>>();
    check_pointer("sim", object)?;
    // SAFETY: not NULL, aligned; the mark is read first.
    unsafe {
        if object.cast::<u64>().read() != mark::<R>(SIM_MARK) {
            return Err(Fault::of(Status::BadHandle, "sim", f64::NAN));
        }
        let o = &*object;
        if model_object(o.model).map(|m| m.stamp).ok() != Some(o.stamp) {
            return Err(Fault::of(Status::BadHandle, "model", f64::NAN));
        }
        Ok(o)
    }
}

pub(crate) unsafe fn remembered<'a, R: Real>(handle: *const SimHandle<R>) -> Outcome<Remembered<'a, R>> {
    // SAFETY: a marked object was completed by `make_sim`; the caller promises that no thread changes it meanwhile.
    unsafe {
        let o = sim_object(handle)?;
        let first = handle.cast::<u8>().add(o.reals_at).cast::<R>();
        let reals = core::slice::from_raw_parts(first, o.kept);
        Ok(Remembered { handle: o.model, head: o.head.assume_init_ref(), reals })
    }
}

/// A simulation's parts after all checks.
pub(crate) struct SimParts<'a, R> {
    pub(crate) handle: *const ModelHandle<R>,
    pub(crate) model: Model<'a, R>,
    pub(crate) head: &'a mut SimHead<R>,
    pub(crate) reals: &'a mut [R],
    saved_head: &'a mut SimHead<R>,
    saved: &'a mut [R],
    /// Where the object is, and its bytes: no buffer of the caller may lie among them.
    range: (usize, usize),
}

pub(crate) unsafe fn sim<'a, R: Real>(handle: *const SimHandle<R>) -> Outcome<SimParts<'a, R>> {
    // SAFETY: a marked object was completed by `make_sim`; it is this thread's during the call.
    unsafe {
        sim_object(handle)?;
        let object = handle.cast_mut().cast::<SimObject<R>>();
        let o = &mut *object;
        let first = object.cast::<u8>().add(o.reals_at).cast::<R>();
        Ok(SimParts {
            handle: o.model,
            model: model(o.model)?,
            head: o.head.assume_init_mut(),
            reals: core::slice::from_raw_parts_mut(first, o.reals),
            saved_head: o.saved.assume_init_mut(),
            saved: core::slice::from_raw_parts_mut(first.add(o.reals), o.kept),
            range: (object.addr(), o.bytes),
        })
    }
}

impl<R: Real> SimParts<'_, R> {
    /// The simulation.
    pub(crate) fn view(&mut self) -> Outcome<Sim<'_, R>> {
        Ok(Sim::view(self.model, self.head, self.reals)?)
    }

    /// Runs a call that changes the state. If it fails, the simulation is put back to what it was, bit for bit.
    pub(crate) fn attempt(&mut self, call: impl FnOnce(&mut Sim<'_, R>) -> nekton::Result<()>) -> Outcome {
        *self.saved_head = *self.head;
        copy(self.saved, self.reals);
        let mut sim = Sim::view(self.model, self.head, self.reals)?;
        let outcome = call(&mut sim);
        let time = sim.time().to_f64();
        outcome.map_err(|error| {
            *self.head = *self.saved_head;
            self.head.forget_evaluation();
            copy(self.reals, self.saved);
            Fault { time, ..Fault::from(error) }
        })
    }

    /// Takes over what another simulation of the same model remembers.
    pub(crate) fn assign(&mut self, from: &Remembered<'_, R>) {
        *self.head = *from.head;
        self.head.forget_evaluation();
        copy(self.reals, from.reals);
    }

    /// Whether a buffer of the caller lies within this object.
    pub(crate) fn overlaps<T>(&self, first: *const T, n: usize) -> bool {
        overlap(first.addr(), n.saturating_mul(size_of::<T>()), self.range.0, self.range.1)
    }
}

fn copy<R: Copy>(to: &mut [R], from: &[R]) {
    for (t, f) in to.iter_mut().zip(from) {
        *t = *f;
    }
}

/// What `free` needs to know: where, how many bytes.
#[cfg(feature = "std")]
pub(crate) struct Owned {
    pub(crate) mem: *mut u8,
    pub(crate) bytes: usize,
}

/// Ends the life of an object that came from `create`: the mark goes, the memory is to be freed.
#[cfg(feature = "std")]
pub(crate) unsafe fn retire_model<R: Real>(handle: *mut ModelHandle<R>) -> Outcome<Owned> {
    // SAFETY: as for `model`.
    unsafe {
        let o = model_object(handle.cast_const())?;
        let owned = Owned { mem: handle.cast(), bytes: o.bytes };
        retire(owned, o.owned, "model")
    }
}

/// The same for a simulation. Its model need not be there any more.
#[cfg(feature = "std")]
pub(crate) unsafe fn retire_sim<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Owned> {
    let object = handle.cast::<SimObject<R>>();
    check_pointer("sim", object.cast_const())?;
    // SAFETY: as for `sim`.
    unsafe {
        if object.cast::<u64>().read() != mark::<R>(SIM_MARK) {
            return Err(Fault::of(Status::BadHandle, "sim", f64::NAN));
        }
        let owned = Owned { mem: handle.cast(), bytes: (*object).bytes };
        retire(owned, (*object).owned, "sim")
    }
}

#[cfg(feature = "std")]
unsafe fn retire(object: Owned, owned: u64, what: &'static str) -> Outcome<Owned> {
    if owned == 0 {
        return Err(Fault::of(Status::BadHandle, what, f64::NAN));
    }
    // SAFETY: the front of a live object. Volatile, or the write before a deallocation might be dropped.
    unsafe { object.mem.cast::<u64>().write_volatile(0) };
    Ok(object)
}

/// Bytes of a model.
pub(crate) unsafe fn model_bytes<R: Real>(handle: *const ModelHandle<R>) -> Outcome<usize> {
    // SAFETY: checked in `model_object`.
    Ok(unsafe { model_object(handle) }?.bytes)
}
