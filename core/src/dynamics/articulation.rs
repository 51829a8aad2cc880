//! q = F(p, u): link placements, velocities and accelerations from the coordinates of a tree of links (section 6
//! of the paper).
//!
//! Per link (x, y, θ) of the centre of mass. Hinge: r_c + R_c h_c = r_p + R_p h_p, θ_c = θ_p + u. Slider:
//! r_c + R_c h_c = r_p + R_p (h_p + u a), θ_c = θ_p + angle. Every routine walks the links once: O(links).
//!
//! Tested by `tests/articulated`, `tests/conservation`.

use crate::base::complex::{Complex, cis, complex, perp};
use crate::base::memory::{at, part_mut, put};
use crate::base::scalar::Real;
use crate::geometry::pose::{Pose, Poses, put_pose, put_three, twist_of};
use crate::model::signal::Moment;
use crate::model::{Control, Hold, LinkRecord, Model};

/// Placement of every link from the coordinates `s`: writes q (3 per link) and the poses behind the walls'.
pub(crate) fn place_links<R: Real>(model: &Model<'_, R>, s: &[R], q: &mut [R], poses: &mut [R]) {
    let walls = model.head.plan.walls;
    for (i, link) in model.links.iter().enumerate() {
        let c = link.coordinate;
        let parent_pose = pose_of(model, poses, link.parent);
        let parent_theta = at(q, 3 * link.parent + 2);
        let (origin, turn, theta) = match link.hold {
            Hold::Root => (complex(at(s, c), at(s, c + 1)), cis(at(s, c + 2)), at(s, c + 2)),
            Hold::Hinge { parent, own } => {
                let theta = parent_theta + at(s, c);
                let turn = cis(theta);
                (parent_pose.place(parent) - turn * own, turn, theta)
            }
            Hold::Slider { parent, own, axis, angle } => {
                let theta = parent_theta + angle;
                let turn = cis(theta);
                (parent_pose.place(parent + axis * at(s, c)) - turn * own, turn, theta)
            }
        };
        for (slot, value) in part_mut(q, 3 * i, 3).iter_mut().zip([origin.re, origin.im, theta]) {
            *slot = value;
        }
        put_pose(poses, walls + i, &Pose { origin, turn });
    }
}

/// Placement of a link, which stands behind those of the walls.
fn pose_of<R: Real>(model: &Model<'_, R>, poses: &[R], link: usize) -> Pose<R> {
    Poses(poses).get(model.head.plan.walls + link)
}

/// World offsets of the two anchors of a link from their links' centres, and the world axis of a slider.
fn arms<R: Real>(
    link: &LinkRecord<R>,
    s: &[R],
    parent: &Pose<R>,
    own: &Pose<R>,
) -> (Complex<R>, Complex<R>, Complex<R>) {
    match link.hold {
        Hold::Root => Default::default(),
        Hold::Hinge { parent: h, own: o } => (parent.turned(h), own.turned(o), Complex::default()),
        Hold::Slider { parent: h, own: o, axis, .. } => {
            (parent.turned(h + axis * at(s, link.coordinate)), own.turned(o), parent.turned(axis))
        }
    }
}

/// Velocities of the links for coordinate rates `ds`: out = ∂F/∂s · ds.
pub(crate) fn velocities<R: Real>(model: &Model<'_, R>, s: &[R], ds: &[R], poses: &[R], out: &mut [R]) {
    for (i, link) in model.links.iter().enumerate() {
        let c = link.coordinate;
        if let Hold::Root = link.hold {
            put_three(out, i, complex(at(ds, c), at(ds, c + 1)), at(ds, c + 2));
            continue;
        }
        let (pose, own) = (pose_of(model, poses, link.parent), pose_of(model, poses, i));
        let (arm_p, arm_c, axis) = arms(link, s, &pose, &own);
        let parent = twist_of(out, link.parent);
        let rate = at(ds, c);
        let hinge = matches!(link.hold, Hold::Hinge { .. });
        let angular = if hinge { parent.angular + rate } else { parent.angular };
        let linear = parent.at(arm_p) + axis * rate - perp(arm_c) * angular;
        put_three(out, i, linear, angular);
    }
}

/// Accelerations of the links for coordinate accelerations `dds` at rates `ds` (link velocities `qd`).
pub(crate) fn accelerations<R: Real>(
    model: &Model<'_, R>,
    s: &[R],
    ds: &[R],
    dds: &[R],
    poses: &[R],
    qd: &[R],
    out: &mut [R],
) {
    for (i, link) in model.links.iter().enumerate() {
        let c = link.coordinate;
        if let Hold::Root = link.hold {
            put_three(out, i, complex(at(dds, c), at(dds, c + 1)), at(dds, c + 2));
            continue;
        }
        let (pose, own) = (pose_of(model, poses, link.parent), pose_of(model, poses, i));
        let (arm_p, arm_c, axis) = arms(link, s, &pose, &own);
        let (parent, w_p) = (twist_of(out, link.parent), twist_of(qd, link.parent).angular);
        let w_c = twist_of(qd, i).angular;
        let (rate, acceleration) = (at(ds, c), at(dds, c));
        let hinge = matches!(link.hold, Hold::Hinge { .. });
        let angular = if hinge { parent.angular + acceleration } else { parent.angular };
        let coriolis = perp(axis) * (R::TWO * w_p * rate);
        let linear = parent.at(arm_p) - arm_p * (w_p * w_p) + coriolis + axis * acceleration - perp(arm_c) * angular
            + arm_c * (w_c * w_c);
        put_three(out, i, linear, angular);
    }
}

/// Generalized force on every coordinate from forces on the links: out = (∂F/∂s)ᵀ f. Walks the tree from its
/// leaves, carrying each link's force and moment to its parent. `f` is overwritten by the carried sums.
pub(crate) fn project<R: Real>(model: &Model<'_, R>, s: &[R], poses: &[R], f: &mut [R], out: &mut [R]) {
    for (i, link) in model.links.iter().enumerate().rev() {
        let c = link.coordinate;
        let own_force = twist_of(f, i);
        let (force, moment) = (own_force.linear, own_force.angular);
        let (pose, own) = (pose_of(model, poses, link.parent), pose_of(model, poses, i));
        let (arm_p, arm_c, axis) = arms(link, s, &pose, &own);
        // v_c = v_p + ω_p×arm_p + axis u̇ − ω_c×arm_c: the force acts at the anchor.
        let at_anchor = moment - crate::base::complex::dot(perp(arm_c), force);
        match link.hold {
            Hold::Root => {
                put(out, c, force.re);
                put(out, c + 1, force.im);
                put(out, c + 2, moment);
                continue;
            }
            Hold::Hinge { .. } => put(out, c, at_anchor),
            Hold::Slider { .. } => put(out, c, crate::base::complex::dot(axis, force)),
        }
        let carried = twist_of(f, link.parent);
        let moment = carried.angular + at_anchor + crate::base::complex::dot(perp(arm_p), force);
        put_three(f, link.parent, carried.linear + force, moment);
    }
}

/// Velocities of the links for a unit rate of one coordinate. `unit` is scratch of one real per coordinate.
pub(crate) fn jacobian_column<R: Real>(
    model: &Model<'_, R>,
    coordinate: usize,
    s: &[R],
    poses: &[R],
    unit: &mut [R],
    out: &mut [R],
) {
    for (i, x) in unit.iter_mut().enumerate() {
        *x = if i == coordinate { R::one() } else { R::zero() };
    }
    velocities(model, s, unit, poses, out);
}

/// Coordinates, rates and (for prescribed ones) accelerations at a time. `p`, `dp` hold the free ones.
pub(crate) fn set_coordinates<R: Real>(
    model: &Model<'_, R>,
    at_time: Moment<R>,
    p: &[R],
    dp: &[R],
    channels: &[R],
    s: &mut [R],
    ds: &mut [R],
    dds: &mut [R],
) {
    let slots = s.iter_mut().zip(ds.iter_mut()).zip(dds.iter_mut());
    for (c, ((s, ds), dds)) in model.coordinates.iter().zip(slots) {
        if c.control == Control::Prescribed {
            let [u, du, ddu] = c.signal.evaluate(at_time, model.store, channels);
            (*s, *ds, *dds) = (if c.component < 3 { c.base + u } else { u }, du, ddu);
        } else {
            // Rates may be unknown.
            let rate = dp.get(c.free).copied().unwrap_or(R::NAN);
            (*s, *ds, *dds) = (at(p, c.free), rate, R::zero());
        }
    }
}
