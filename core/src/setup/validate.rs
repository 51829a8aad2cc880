//! What a scene must satisfy before anything is built: every refusal names the place, the quantity and its value.

use crate::base::features;
use crate::base::lanes::LEAST_NODES;
use crate::base::scalar::Real;
use crate::base::status::{Error, Place, Result, Status};
use crate::scene::{Description, Drive, JointKind, Link, Mass, Quadrature, each_link};
use crate::setup::items::items;

/// Most nodes allowed on one boundary.
const MOST_NODES: usize = 1 << 16;

fn finite<R: Real>(what: &'static str, x: R) -> Result<()> {
    if x.is_finite() { Ok(()) } else { Err(Error::new(Status::NotFinite).of(what, x.to_f64())) }
}

fn at_least_zero<R: Real>(what: &'static str, x: R) -> Result<()> {
    finite(what, x)?;
    if x >= R::zero() { Ok(()) } else { Err(Error::new(Status::OutOfRange).of(what, x.to_f64())) }
}

pub(crate) fn validate<R: Real, S: Description<R>>(scene: &S) -> Result<()> {
    let settings = scene.settings();
    if !features::NEAR && settings.quadrature == Quadrature::Graded {
        return Err(Error::new(Status::Unsupported).of("quadrature", f64::NAN));
    }
    at_least_zero("density", settings.fluid_density)?;
    finite("gravity", settings.gravity)?;
    if let Some(r) = settings.repulsion {
        at_least_zero("epsilon", r.epsilon)?;
        finite("alpha", r.alpha)?;
        if r.alpha <= R::zero() {
            return Err(Error::new(Status::OutOfRange).of("alpha", r.alpha.to_f64()));
        }
    }
    crate::setup::automatic_nodes::check(settings.tolerance)?;
    if scene.body_count() == 0 {
        return Err(Status::EmptyScene.into());
    }
    for item in items(scene) {
        let at_place = |e: Error| e.at(item.place);
        if item.nodes < LEAST_NODES || item.nodes % 2 != 0 || item.nodes > MOST_NODES {
            return Err(at_place(Error::new(Status::NodeCount).of("nodes", item.nodes as f64)));
        }
        for (what, x) in [
            ("circulation", item.circulation),
            ("position", item.pose.origin.re),
            ("position", item.pose.origin.im),
            ("angle", item.pose.turn.re),
        ] {
            finite(what, x).map_err(at_place)?;
        }
        if item.place == Place::Tank && item.circulation != R::zero() {
            return Err(at_place(Error::new(Status::OutOfRange).of("circulation", item.circulation.to_f64())));
        }
    }
    for (b, body) in (0..scene.body_count()).filter_map(|b| Some((b, scene.body(b)?))) {
        let at_place = |e: Error| e.at(Place::Body(b));
        for (what, values) in [("position", body.pose), ("velocity", body.velocity)] {
            for x in values {
                finite(what, x).map_err(at_place)?;
            }
        }
        if scene.link_count(b) == 0 {
            return Err(at_place(Error::new(Status::EmptyScene).of("links", 0.0)));
        }
    }
    for (b, l, link) in each_link(scene) {
        validate_link(settings.fluid_density, l, &link).map_err(|e| e.at(Place::Link(b, l)))?;
    }
    Ok(())
}

fn validate_link<R: Real>(fluid_density: R, l: usize, link: &Link<'_, R>) -> Result<()> {
    let zero = R::zero();
    match link.mass {
        Mass::Density(d) => {
            at_least_zero("density", d)?;
            if d == zero && fluid_density == zero {
                return Err(Status::Massless.into());
            }
        }
        Mass::Given { mass, inertia, centre_of_mass } => {
            at_least_zero("mass", mass)?;
            at_least_zero("inertia", inertia)?;
            finite("centre_of_mass", centre_of_mass[0])?;
            finite("centre_of_mass", centre_of_mass[1])?;
            if fluid_density == zero && (mass == zero || inertia == zero) {
                return Err(Status::Massless.into());
            }
        }
    }
    let Some(joint) = link.joint else {
        return if l == 0 { Ok(()) } else { Err(Status::BadParent.into()) };
    };
    if l == 0 || joint.parent >= l {
        return Err(Error::new(Status::BadParent).of("parent", joint.parent as f64));
    }
    for x in joint.parent_anchor.into_iter().chain(joint.self_anchor) {
        finite("anchor", x)?;
    }
    if let JointKind::Slider { axis, angle } = joint.kind {
        finite("angle", angle)?;
        finite("axis", axis[0])?;
        finite("axis", axis[1])?;
        let length = axis[0].hypot(axis[1]);
        if !(length.is_finite() && length > zero) {
            return Err(Error::new(Status::OutOfRange).of("axis", length.to_f64()));
        }
    }
    match joint.drive {
        Drive::Locked(value) => finite("locked", value),
        Drive::Motion(_) => Ok(()),
        Drive::Torque { stiffness, damping, rest, start, .. } => {
            at_least_zero("stiffness", stiffness)?;
            at_least_zero("damping", damping)?;
            finite("rest", rest)?;
            finite("start", start[0])?;
            finite("start", start[1])
        }
    }
}
