//! Derivatives of the motion, in memory of the caller. Without the feature `derivatives` they are refused.

use crate::buffers::{input, length, output, sound};
use crate::convert::{array, check_pointer};
use crate::diag::{Fault, Outcome};
use crate::memory::{check_memory, fill, overlap};
use crate::model::give;
use crate::model_object::model;
use crate::shared::NEKTON_ALIGN;
use crate::sim_object::{SimParts, sim};
use crate::types::*;
use nekton::{Model, Real, Status};

#[cfg(feature = "derivatives")]
fn reals<R: Real>(model: &Model<'_, R>) -> Outcome<usize> {
    Ok(nekton::Sim::derivative_requirement(model)?)
}

#[cfg(not(feature = "derivatives"))]
fn reals<R: Real>(_: &Model<'_, R>) -> Outcome<usize> {
    Err(Fault::of(Status::Unsupported, "derivatives", f64::NAN))
}

fn requirement<R: Real>(model: &Model<'_, R>) -> Outcome<nekton_req> {
    let bytes = reals(model)?.checked_mul(size_of::<R>()).and_then(|b| b.checked_next_multiple_of(NEKTON_ALIGN));
    let size = bytes.filter(|b| *b <= isize::MAX as usize).ok_or(Status::SizeOverflow)?;
    Ok(nekton_req { size, align: NEKTON_ALIGN })
}

pub(crate) unsafe fn req<R: Real>(handle: *const ModelHandle<R>, out: *mut nekton_req) -> Outcome<Status> {
    check_pointer("req", out.cast_const())?;
    // SAFETY: checked above and in `model`.
    unsafe { give(out, requirement(&model(handle)?)?) }
}

/// Memory that lies apart from the simulation and from `others` (first byte, bytes).
unsafe fn scratch<'a, R: Real>(
    parts: &SimParts<'_, R>,
    mem: *mut u8,
    len: usize,
    others: &[(usize, usize)],
) -> Outcome<&'a mut [R]> {
    let need = requirement(&parts.model)?;
    check_memory(mem, len, &need, (0, 0))?;
    let meets = others.iter().any(|(at, bytes)| overlap(mem.addr(), need.size, *at, *bytes));
    if meets || parts.overlaps(mem.cast_const(), need.size) {
        return Err(Fault::of(Status::Aliasing, "mem", f64::NAN));
    }
    // SAFETY: long enough and aligned.
    Ok(unsafe { fill(mem, 0, need.size / size_of::<R>(), R::zero()) })
}

fn bytes<T>(first: *const T, n: usize) -> (usize, usize) {
    (first.addr(), n.saturating_mul(size_of::<T>()))
}

/// Refuses outputs that have a byte in common.
fn apart(what: &'static str, a: (usize, usize), b: (usize, usize)) -> Outcome {
    if overlap(a.0, a.1, b.0, b.1) { Err(Fault::of(Status::Aliasing, what, f64::NAN)) } else { Ok(()) }
}

/// A linearization as the caller asks for it.
pub(crate) struct Asked<R> {
    pub(crate) parameters: *const nekton_parameter,
    pub(crate) count: usize,
    pub(crate) a: *mut R,
    pub(crate) a_len: usize,
    pub(crate) b: *mut R,
    pub(crate) b_len: usize,
    pub(crate) bound: *mut R,
    pub(crate) mem: *mut u8,
    pub(crate) len: usize,
}

pub(crate) unsafe fn linearize<R: Real>(handle: *mut SimHandle<R>, asked: &Asked<R>) -> Outcome<Status> {
    check_pointer("bound", asked.bound.cast_const())?;
    // SAFETY: checked above, in `sim`, `array` and `output`; the caller's promise about the lengths.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let rows = parts.view()?.state().len();
        let (square, columns) = (rows.saturating_mul(rows), rows.saturating_mul(asked.count));
        length(asked.a_len, square)?;
        length(asked.b_len, columns)?;
        let definitions = array("parameters", asked.parameters, asked.count)?;
        let (a, b, bound) = (bytes(asked.a, square), bytes(asked.b, columns), bytes(asked.bound, 1));
        let given = bytes(asked.parameters, asked.count);
        apart("b", a, b)?;
        apart("a", a, given)?;
        apart("b", b, given)?;
        [a, b, given].into_iter().try_for_each(|other| apart("bound", bound, other))?;
        if parts.overlaps(asked.bound.cast_const(), 1) {
            return Err(Fault::of(Status::Aliasing, "bound", f64::NAN));
        }
        let memory = scratch(&parts, asked.mem, asked.len, &[a, b, given, bound])?;
        let a = output(&parts, "a", asked.a, asked.a_len, square)?;
        let b = output(&parts, "b", asked.b, asked.b_len, columns)?;
        let answer = fill_in(&mut parts, definitions, a, b, memory);
        let answer = answer.and_then(|bound| sound(a.iter().chain(b.iter()).copied()).map(|_| bound));
        match answer {
            Ok(bound) => give(asked.bound, bound),
            Err(fault) => {
                a.fill(R::zero());
                b.fill(R::zero());
                Err(fault)
            }
        }
    }
}

#[cfg(feature = "derivatives")]
fn fill_in<R: Real>(
    parts: &mut SimParts<'_, R>,
    definitions: &[nekton_parameter],
    a: &mut [R],
    b: &mut [R],
    memory: &mut [R],
) -> Outcome<R> {
    let at = |k: usize, status: Status, what: &'static str, value: i32| {
        let item = i32::try_from(k).unwrap_or(i32::MAX);
        Err(Fault { item, ..Fault::of(status, what, f64::from(value)) })
    };
    for (k, definition) in definitions.iter().enumerate() {
        if let Err((status, what, value)) = parameter(definition) {
            return at(k, status, what, value);
        }
    }
    // Each was read above.
    let parameters = definitions.iter().map(|d| parameter(d).unwrap_or(nekton::Parameter::Gravity));
    match parts.view()?.linearize(parameters, a, b, memory) {
        Ok(linearization) => Ok(linearization.bound),
        // The value is the number of the parameter that the model does not have.
        Err(error) if error.status == Status::OutOfRange => {
            let k = if error.value >= 0.0 { error.value as usize } else { usize::MAX };
            at(k, error.status, error.what, definitions.get(k).map_or(-1, |d| d.index))
        }
        Err(error) => Err(error.into()),
    }
}

/// What a definition means.
#[cfg(feature = "derivatives")]
fn parameter(definition: &nekton_parameter) -> Result<nekton::Parameter, (Status, &'static str, i32)> {
    use nekton::Parameter as P;
    let nekton_parameter { kind, index, component, reserved } = *definition;
    if reserved != 0 {
        return Err((Status::Unsupported, "reserved", reserved));
    }
    let of = || usize::try_from(index).map_err(|_| (Status::OutOfRange, "index", index));
    Ok(match kind {
        NEKTON_PARAMETER_FLUID_DENSITY => P::FluidDensity,
        NEKTON_PARAMETER_GRAVITY => P::Gravity,
        NEKTON_PARAMETER_MASS => P::Mass(of()?),
        NEKTON_PARAMETER_INERTIA => P::Inertia(of()?),
        NEKTON_PARAMETER_WRENCH => {
            let known = usize::try_from(component).ok().filter(|k| *k < 3);
            P::Wrench(of()?, known.ok_or((Status::OutOfRange, "component", component))?)
        }
        NEKTON_PARAMETER_TORQUE => P::Torque(of()?),
        NEKTON_PARAMETER_STIFFNESS => P::Stiffness(of()?),
        NEKTON_PARAMETER_DAMPING => P::Damping(of()?),
        NEKTON_PARAMETER_REST => P::Rest(of()?),
        NEKTON_PARAMETER_POSITION => P::Position(of()?),
        NEKTON_PARAMETER_RATE => P::Rate(of()?),
        NEKTON_PARAMETER_ACCELERATION => P::Acceleration(of()?),
        other => return Err((Status::UnknownKind, "parameter", other)),
    })
}

#[cfg(not(feature = "derivatives"))]
fn fill_in<R: Real>(
    _: &mut SimParts<'_, R>,
    _: &[nekton_parameter],
    _: &mut [R],
    _: &mut [R],
    _: &mut [R],
) -> Outcome<R> {
    Err(Fault::of(Status::Unsupported, "derivatives", f64::NAN))
}

/// H and C of the links' forces.
pub(crate) struct AskedForces<R> {
    pub(crate) qdd: *const R,
    pub(crate) n: usize,
    pub(crate) position: *mut R,
    pub(crate) velocity: *mut R,
    pub(crate) mem: *mut u8,
    pub(crate) len: usize,
}

pub(crate) unsafe fn force_derivatives<R: Real>(handle: *mut SimHandle<R>, asked: &AskedForces<R>) -> Outcome<Status> {
    // SAFETY: checked in `sim`, `input` and `output`; the caller's promise about the lengths.
    unsafe {
        let mut parts = sim(handle.cast_const())?;
        let rows = parts.model.link_count().saturating_mul(3);
        let qdd = input("qdd", asked.qdd, asked.n, rows)?;
        let square = rows.saturating_mul(rows);
        let (h, c) = (bytes(asked.position, square), bytes(asked.velocity, square));
        let given = bytes(asked.qdd, rows);
        apart("velocity", h, c)?;
        apart("position", h, given)?;
        apart("velocity", c, given)?;
        let memory = scratch(&parts, asked.mem, asked.len, &[h, c, given])?;
        let position = output(&parts, "position", asked.position, square, square)?;
        let velocity = output(&parts, "velocity", asked.velocity, square, square)?;
        let answer = forces(&mut parts, qdd, position, velocity, memory);
        let answer = answer.and_then(|()| sound(position.iter().chain(velocity.iter()).copied()));
        if answer.is_err() {
            position.fill(R::zero());
            velocity.fill(R::zero());
        }
        answer
    }
}

#[cfg(feature = "derivatives")]
fn forces<R: Real>(
    parts: &mut SimParts<'_, R>,
    qdd: &[R],
    position: &mut [R],
    velocity: &mut [R],
    memory: &mut [R],
) -> Outcome {
    Ok(parts.view()?.force_derivatives(qdd, position, velocity, memory)?)
}

#[cfg(not(feature = "derivatives"))]
fn forces<R: Real>(_: &mut SimParts<'_, R>, _: &[R], _: &mut [R], _: &mut [R], _: &mut [R]) -> Outcome {
    Err(Fault::of(Status::Unsupported, "derivatives", f64::NAN))
}
