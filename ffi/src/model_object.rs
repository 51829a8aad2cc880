//! Models in the caller's memory.

use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome};
use crate::memory::{LINE, Sum, fill, mark, on_line, round};
#[cfg(feature = "std")]
use crate::memory::{Owned, retire};
use crate::shared::NEKTON_ALIGN as ALIGN;
use crate::types::{ModelHandle, nekton_req};
use core::mem::MaybeUninit;
use nekton::BoundaryRecord;
use nekton::{CoordinateRecord, LinkRecord};
use nekton::{Model, ModelHead, ModelRequirement, Real, Status};

const MODEL_MARK: u64 = 0x6e65_6b74_6f6e_4d30;

/// Front of a model.
#[repr(C)]
pub(crate) struct ModelObject<R> {
    mark: u64,
    /// Came from `create`.
    owned: u64,
    bytes: usize,
    /// Number that tells models apart.
    pub(crate) stamp: u64,
    links: usize,
    coordinates: usize,
    boundaries: usize,
    reals: usize,
    reals_at: usize,
    head: MaybeUninit<ModelHead<R>>,
}

const _: () = assert!(align_of::<ModelObject<f64>>() <= ALIGN);
const _: () = assert!(align_of::<ModelObject<f32>>() <= ALIGN);

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

/// What a model needs.
pub(crate) fn model_req<R: Real>(need: &ModelRequirement) -> Outcome<nekton_req> {
    Ok(nekton_req { size: ModelPlaces::of::<R>(need)?.bytes, align: ALIGN })
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
        let m = &self.memory;
        let stamp = Model::view(&head, m.links, m.coordinates, m.boundaries, m.reals).fingerprint();
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
}

/// The front of a model after all checks.
pub(crate) unsafe fn model_object<'a, R: Real>(model: *const ModelHandle<R>) -> Outcome<&'a ModelObject<R>> {
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

/// Bytes of a model.
pub(crate) unsafe fn model_bytes<R: Real>(handle: *const ModelHandle<R>) -> Outcome<usize> {
    // SAFETY: checked in `model_object`.
    Ok(unsafe { model_object(handle) }?.bytes)
}
