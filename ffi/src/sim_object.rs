//! Simulations in the caller's memory.

use crate::convert::check_pointer;
use crate::diag::{Fault, Outcome};
use crate::memory::{LINE, Sum, copy, fill, mark, on_line, overlap, round};
#[cfg(feature = "std")]
use crate::memory::{Owned, retire};
use crate::model_object::{model, model_object};
use crate::shared::NEKTON_ALIGN as ALIGN;
use crate::turns::{Turn, Turns};
use crate::types::{ModelHandle, SimHandle, nekton_req};
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use nekton::{Model, Real, Sim, SimHead, Status};

const SIM_MARK: u64 = 0x6e65_6b74_6f6e_5330;

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
    /// Who uses what follows, and the reals. All before it stays as it is.
    turns: Turns,
    head: UnsafeCell<MaybeUninit<SimHead<R>>>,
    saved: UnsafeCell<MaybeUninit<SimHead<R>>>,
}

const _: () = assert!(align_of::<SimObject<f64>>() <= ALIGN);
const _: () = assert!(align_of::<SimObject<f32>>() <= ALIGN);

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
            turns: Turns::new(),
            head: UnsafeCell::new(MaybeUninit::new(head)),
            saved: UnsafeCell::new(MaybeUninit::new(head)),
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
    _turn: Turn<'a>,
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
    // SAFETY: a marked object was completed by `make_sim`; while this is read, nobody gets a turn to write.
    unsafe {
        let o = sim_object(handle)?;
        let turn = o.turns.read()?;
        let first = handle.cast::<u8>().add(o.reals_at).cast::<R>();
        let reals = core::slice::from_raw_parts(first, o.kept);
        Ok(Remembered { handle: o.model, head: (*o.head.get()).assume_init_ref(), reals, _turn: turn })
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
    _turn: Turn<'a>,
}

pub(crate) unsafe fn sim<'a, R: Real>(handle: *const SimHandle<R>) -> Outcome<SimParts<'a, R>> {
    // SAFETY: a marked object was completed by `make_sim`; nobody else gets a turn during the call.
    unsafe {
        let o = sim_object(handle)?;
        let turn = o.turns.write()?;
        let first = handle.cast_mut().cast::<u8>().add(o.reals_at).cast::<R>();
        Ok(SimParts {
            handle: o.model,
            model: model(o.model)?,
            head: (*o.head.get()).assume_init_mut(),
            reals: core::slice::from_raw_parts_mut(first, o.reals),
            saved_head: (*o.saved.get()).assume_init_mut(),
            saved: core::slice::from_raw_parts_mut(first.add(o.reals), o.kept),
            range: (handle.addr(), o.bytes),
            _turn: turn,
        })
    }
}

/// What a call that fails leaves behind.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Failed {
    /// Nothing: the simulation is put back to what it was, bit for bit.
    LeavesNothing,
    /// The steps that it made before, if there are any.
    KeepsSteps,
}

impl<R: Real> SimParts<'_, R> {
    /// The simulation.
    pub(crate) fn view(&mut self) -> Outcome<Sim<'_, R>> {
        Ok(Sim::view(self.model, self.head, self.reals)?)
    }

    /// Runs a call that changes the state. The error tells the time that was reached.
    pub(crate) fn attempt(
        &mut self,
        failed: Failed,
        call: impl FnOnce(&mut Sim<'_, R>) -> nekton::Result<()>,
    ) -> Outcome {
        *self.saved_head = *self.head;
        copy(self.saved, self.reals);
        let mut sim = Sim::view(self.model, self.head, self.reals)?;
        let before = sim.time();
        let outcome = call(&mut sim);
        let time = sim.time();
        outcome.map_err(|error| {
            if failed == Failed::LeavesNothing || time == before {
                self.head.put_back(self.saved_head);
                copy(self.reals, self.saved);
            }
            Fault { time: time.to_f64(), ..Fault::from(error) }
        })
    }

    /// Takes over what another simulation of the same model remembers.
    pub(crate) fn assign(&mut self, from: &Remembered<'_, R>) {
        self.head.put_back(from.head);
        copy(self.reals, from.reals);
    }

    /// Whether a buffer of the caller lies within this object.
    pub(crate) fn overlaps<T>(&self, first: *const T, n: usize) -> bool {
        overlap(first.addr(), n.saturating_mul(size_of::<T>()), self.range.0, self.range.1)
    }
}

/// Ends the life of a simulation that came from `create`. Its model need not be there any more.
#[cfg(feature = "std")]
pub(crate) unsafe fn retire_sim<R: Real>(handle: *mut SimHandle<R>) -> Outcome<Owned> {
    let object = handle.cast::<SimObject<R>>();
    check_pointer("sim", object.cast_const())?;
    // SAFETY: as for `sim`.
    unsafe {
        if object.cast::<u64>().read() != mark::<R>(SIM_MARK) {
            return Err(Fault::of(Status::BadHandle, "sim", f64::NAN));
        }
        let turn = (*object).turns.write()?;
        let owned = Owned { mem: handle.cast(), bytes: (*object).bytes };
        let ended = retire(owned, (*object).owned, "sim");
        if ended.is_ok() {
            // There is nothing left to give back.
            core::mem::forget(turn);
        }
        ended
    }
}
