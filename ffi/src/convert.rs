//! C definitions as the core's: pointers become slices, kinds become variants. O(1) per item, nothing is copied but the item.

use crate::diag::{Fault, Outcome};
use crate::types::*;
use nekton::scene::{
    Body, CirculationModel, Corners, Drive, ForceFormula, Harmonic, Joint, JointKind, Link, Mass, Quadrature,
    Repulsion, Root, Scene, Shape, Signal, Wall, Window,
};
use nekton::{Method, Real, Status};

/// A kind that does not exist.
fn unknown<T>(what: &'static str, kind: i32) -> Outcome<T> {
    Err(Fault::of(Status::UnknownKind, what, f64::from(kind)))
}

/// A flag: 0 or 1.
fn flag(what: &'static str, value: i32) -> Outcome<bool> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => unknown(what, value),
    }
}

/// A caller's array after all checks that are possible.
pub(crate) unsafe fn array<'a, T>(what: &'static str, first: *const T, count: usize) -> Outcome<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_pointer(what, first)?;
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Fault::of(Status::SizeOverflow, what, count as f64));
    }
    // SAFETY: not NULL, aligned, of an addressable size; the caller promises that the items are there.
    Ok(unsafe { core::slice::from_raw_parts(first, count) })
}

/// Refuses NULL and misaligned pointers.
pub(crate) fn check_pointer<T>(what: &'static str, pointer: *const T) -> Outcome {
    if pointer.is_null() {
        return Err(Fault::of(Status::NullPointer, what, f64::NAN));
    }
    if !pointer.is_aligned() {
        return Err(Fault::of(Status::Misaligned, what, align_of::<T>() as f64));
    }
    Ok(())
}

unsafe fn corners<'a>(kind: i32, reserved: i32, points: *const usize, count: usize) -> Outcome<Corners<'a>> {
    if reserved != 0 {
        return Err(Fault::of(Status::Unsupported, "corners_reserved", f64::from(reserved)));
    }
    Ok(match kind {
        NEKTON_CORNERS_AUTO => Corners::Auto,
        NEKTON_CORNERS_NONE => Corners::None,
        // SAFETY: the caller's promise about the definition.
        NEKTON_CORNERS_GIVEN => Corners::At(unsafe { array("corner_points", points, count) }?),
        kind => return unknown("corners", kind),
    })
}

unsafe fn shape<'a, R: Real>(s: &ShapeDef<R>, corners: Corners<'a>) -> Outcome<Shape<'a, R>> {
    let radius = if s.corner_radius == R::zero() { None } else { Some(s.corner_radius) };
    // SAFETY: the caller's promise about the definition.
    let points = || unsafe { array("points", s.points, s.point_count) };
    Ok(match s.kind {
        NEKTON_SHAPE_ELLIPSE => Shape::Ellipse { a: s.a, b: s.b },
        NEKTON_SHAPE_STAR => Shape::Star { radius: s.radius, amplitude: s.amplitude, lobes: s.lobes as usize },
        NEKTON_SHAPE_RECTANGLE => Shape::Rectangle { width: s.width, height: s.height, radius },
        NEKTON_SHAPE_POLYGON => Shape::Polygon { vertices: points()?, radius },
        NEKTON_SHAPE_CURVE => Shape::Curve { points: points()?, corners },
        kind => return unknown("shape.kind", kind),
    })
}

const _: () = assert!(size_of::<HarmonicDef<f64>>() == size_of::<Harmonic<f64>>());
const _: () = assert!(size_of::<HarmonicDef<f32>>() == size_of::<Harmonic<f32>>());

pub(crate) unsafe fn signal<'a, R: Real>(s: &SignalDef<R>) -> Outcome<Signal<'a, R>> {
    Ok(match s.kind {
        NEKTON_SIGNAL_CONSTANT => Signal::Constant(s.value),
        NEKTON_SIGNAL_HARMONIC => {
            let WindowDef { from, to, ramp } = s.window;
            let none = [from, to, ramp].iter().all(|x| *x == R::zero());
            Signal::Harmonic {
                // SAFETY: both types are four reals in C's layout; the caller's promise about the definition.
                terms: unsafe { array("harmonics", s.harmonics.cast::<Harmonic<R>>(), s.harmonic_count) }?,
                window: if none { None } else { Some(Window { from, to, ramp }) },
            }
        }
        // SAFETY: the caller's promise about the definition.
        NEKTON_SIGNAL_TABLE => Signal::Table(unsafe { array("rows", s.rows, s.row_count) }?),
        NEKTON_SIGNAL_CHANNEL => Signal::Channel,
        kind => return unknown("signal.kind", kind),
    })
}

pub(crate) unsafe fn wall<'a, R: Real>(w: &WallDef<R>) -> Outcome<Wall<'a, R>> {
    Ok(Wall {
        // SAFETY: the caller's promise about the definition.
        shape: unsafe { shape(&w.shape, corners(w.corners, w.corners_reserved, w.corner_points, w.corner_count)?) }?,
        position: w.position,
        angle: w.angle,
        nodes: w.nodes,
        circulation: w.circulation,
    })
}

pub(crate) unsafe fn link<'a, R: Real>(l: &LinkDef<R>) -> Outcome<Link<'a, R>> {
    let mass = match l.mass_kind {
        NEKTON_MASS_DENSITY => Mass::Density(l.density),
        NEKTON_MASS_GIVEN => Mass::Given { mass: l.mass, inertia: l.inertia, centre_of_mass: l.centre_of_mass },
        kind => return unknown("mass_kind", kind),
    };
    // SAFETY (all): the caller's promise about the definition.
    let joint = if l.parent == -1 { None } else { Some(unsafe { joint(l) }?) };
    let corners = unsafe { corners(l.corners, l.corners_reserved, l.corner_points, l.corner_count) }?;
    let shape = unsafe { shape(&l.shape, corners) }?;
    Ok(Link { shape, mass, nodes: l.nodes, circulation: l.circulation, joint })
}

unsafe fn joint<'a, R: Real>(l: &LinkDef<R>) -> Outcome<Joint<'a, R>> {
    let Ok(parent) = usize::try_from(l.parent) else {
        return Err(Fault::of(Status::BadParent, "parent", f64::from(l.parent)));
    };
    let kind = match l.joint {
        NEKTON_JOINT_HINGE => JointKind::Hinge,
        NEKTON_JOINT_SLIDER => JointKind::Slider { axis: l.axis, angle: l.angle },
        kind => return unknown("joint", kind),
    };
    // SAFETY: the caller's promise about the definition.
    let signal = || unsafe { signal(&l.signal) };
    let drive = match l.drive {
        NEKTON_DRIVE_LOCKED => Drive::Locked(l.locked_value),
        NEKTON_DRIVE_MOTION => Drive::Motion(signal()?),
        NEKTON_DRIVE_TORQUE => Drive::Torque {
            torque: signal()?,
            stiffness: l.stiffness,
            damping: l.damping,
            rest: l.rest,
            start: l.start,
        },
        kind => return unknown("drive", kind),
    };
    Ok(Joint { parent, kind, parent_anchor: l.parent_anchor, self_anchor: l.self_anchor, drive })
}

/// A body without its links.
pub(crate) unsafe fn body<'a, R: Real>(b: &BodyDef<R>) -> Outcome<Body<'a, R>> {
    let root = match b.root {
        NEKTON_ROOT_FREE => Root::Free,
        NEKTON_ROOT_PRESCRIBED => {
            let [x, y, theta] = &b.motion;
            // SAFETY: the caller's promise about the definition.
            unsafe { Root::Prescribed([signal(x)?, signal(y)?, signal(theta)?]) }
        }
        kind => return unknown("root", kind),
    };
    Ok(Body { pose: b.pose, velocity: b.velocity, root, links: &[] })
}

/// A scene without its walls and bodies.
pub(crate) fn settings<'a, R: Real>(s: &SceneDef<R>) -> Outcome<Scene<'a, R>> {
    if s.reserved != 0 {
        return Err(Fault::of(Status::Unsupported, "reserved", f64::from(s.reserved)));
    }
    Ok(Scene {
        repulsion: if s.repulsion_epsilon == R::zero() {
            None
        } else {
            Some(Repulsion { alpha: s.repulsion_alpha, epsilon: s.repulsion_epsilon })
        },
        circulation: match s.circulation {
            NEKTON_CIRCULATION_FULL => CirculationModel::Full,
            NEKTON_CIRCULATION_PAPER => CirculationModel::Paper,
            kind => return unknown("circulation", kind),
        },
        force: match s.force {
            NEKTON_FORCE_EXACT_GRADIENT => ForceFormula::ExactGradient,
            NEKTON_FORCE_BOUNDARY => ForceFormula::Boundary,
            kind => return unknown("force", kind),
        },
        quadrature: match s.quadrature {
            NEKTON_QUADRATURE_GRADED => Quadrature::Graded,
            NEKTON_QUADRATURE_PLAIN => Quadrature::Plain,
            kind => return unknown("quadrature", kind),
        },
        tolerance: if s.tolerance == R::zero() { None } else { Some(s.tolerance) },
        allow_unresolved: flag("allow_unresolved", s.allow_unresolved)?,
        shortcuts: flag("shortcuts", s.shortcuts)?,
        ..Scene::new(s.fluid_density, s.gravity)
    })
}

pub(crate) fn method<R: Real>(m: &MethodDef<R>) -> Outcome<Method<R>> {
    let fixed = match m.kind {
        NEKTON_METHOD_RK4 => Method::Rk4 { step: m.step },
        NEKTON_METHOD_ABM4 => Method::Abm4 { step: m.step },
        NEKTON_METHOD_GAUSS6 => Method::Gauss6 { step: m.step },
        NEKTON_METHOD_ADAMS => {
            return Ok(Method::Adams {
                relative: m.relative,
                absolute: m.absolute,
                max_step: m.max_step,
                first_step: m.first_step,
            });
        }
        kind => return unknown("method.kind", kind),
    };
    for (what, x) in [("max_step with a fixed step", m.max_step), ("first_step with a fixed step", m.first_step)] {
        if x != R::zero() {
            return Err(Fault::of(Status::OutOfRange, what, x.to_f64()));
        }
    }
    Ok(fixed)
}
