//! Derivatives of the kinematics of a tree of links along one direction of its coordinates, rates and accelerations: what
//! `articulation` computes, differentiated.
//!
//! Tested by `tests/derivatives`.

use crate::base::complex::{Complex, complex, dot, perp};
use crate::base::memory::{add, at, put};
use crate::base::scalar::Real;
use crate::geometry::pose::{Pose, Poses, put_three, twist_of};
use crate::model::{Hold, Model};

/// The state of a tree: coordinates, rates, accelerations · c each, and the links' placements, velocities and accelerations.
#[derive(Clone, Copy)]
pub(crate) struct Tree<'a, R> {
    pub s: &'a [R],
    pub ds: &'a [R],
    pub dds: &'a [R],
    pub poses: Poses<'a, R>,
    /// World · 3n.
    pub qd: &'a [R],
    pub qdd: &'a [R],
}

/// A direction: derivatives of s, ṡ, s̈ · c each.
#[derive(Clone, Copy)]
pub(crate) struct Direction<'a, R> {
    pub s: &'a [R],
    pub ds: &'a [R],
    pub dds: &'a [R],
}

/// What follows along it, world · 3n each: derivatives of positions, velocities and accelerations of the links.
pub(crate) struct Along<'a, R> {
    pub q: &'a mut [R],
    pub qd: &'a mut [R],
    pub qdd: &'a mut [R],
}

/// World offsets of a link's two anchors and the axis of a slider, and their derivatives.
struct Arms<R> {
    parent: [Complex<R>; 2],
    own: [Complex<R>; 2],
    axis: [Complex<R>; 2],
}

impl<R: Real> Tree<'_, R> {
    fn pose(&self, model: &Model<'_, R>, link: usize) -> Pose<R> {
        self.poses.get(model.head.plan.walls + link)
    }

    fn arms(&self, model: &Model<'_, R>, i: usize, ds: R, [of_parent, of_own]: [R; 2]) -> Arms<R> {
        let none = [Complex::default(); 2];
        let Some(link) = model.links.get(i) else { return Arms { parent: none, own: none, axis: none } };
        let (parent, own) = (self.pose(model, link.parent), self.pose(model, i));
        let turning = |arm: Complex<R>, rate: R| [arm, perp(arm) * rate];
        match link.hold {
            Hold::Root => Arms { parent: none, own: none, axis: none },
            Hold::Hinge { parent: h, own: o } => {
                Arms { parent: turning(parent.turned(h), of_parent), own: turning(own.turned(o), of_own), axis: none }
            }
            Hold::Slider { parent: h, own: o, axis, .. } => {
                let axis = turning(parent.turned(axis), of_parent);
                let [arm, slope] = turning(parent.turned(h) + axis[0] * at(self.s, link.coordinate), of_parent);
                Arms { parent: [arm, slope + axis[0] * ds], own: turning(own.turned(o), of_own), axis }
            }
        }
    }

    /// Derivatives of the links' motion along a direction. O(links).
    pub(crate) fn along(&self, model: &Model<'_, R>, d: Direction<'_, R>, out: &mut Along<'_, R>) {
        for (i, link) in model.links.iter().enumerate() {
            let c = link.coordinate;
            if let Hold::Root = link.hold {
                for (to, from) in [(&mut *out.q, d.s), (&mut *out.qd, d.ds), (&mut *out.qdd, d.dds)] {
                    put_three(to, i, complex(at(from, c), at(from, c + 1)), at(from, c + 2));
                }
                continue;
            }
            let p = link.parent;
            let hinge = matches!(link.hold, Hold::Hinge { .. });
            let (ds, dds, ddds) = (at(d.s, c), at(d.ds, c), at(d.dds, c));
            let turn = |x: R| if hinge { x } else { R::zero() };
            let (q, v, a) = (twist_of(out.q, p), twist_of(out.qd, p), twist_of(out.qdd, p));
            let (angle, spin, push) = (q.angular + turn(ds), v.angular + turn(dds), a.angular + turn(ddds));
            let arms = self.arms(model, i, ds, [q.angular, angle]);
            let ([h, dh], [o, d_o], [e, de]) = (arms.parent, arms.own, arms.axis);
            let (w_p, w) = (twist_of(self.qd, p).angular, twist_of(self.qd, i).angular);
            let (b_p, b) = (twist_of(self.qdd, p).angular, twist_of(self.qdd, i).angular);
            let (rate, acceleration) = (at(self.ds, c), at(self.dds, c));
            // A hinge has no axis: all of its terms are 0.
            let linear = q.linear + dh - d_o;
            let velocity =
                v.linear + perp(h) * v.angular + perp(dh) * w_p + de * rate + e * dds - perp(o) * spin - perp(d_o) * w;
            let coriolis = perp(e) * (v.angular * rate + w_p * dds) + perp(de) * (w_p * rate);
            let turned = |arm: Complex<R>, slope: Complex<R>, w: R, dw: R, b: R, db: R| {
                perp(arm) * db - arm * (R::TWO * w * dw) + perp(slope) * b - slope * (w * w)
            };
            let force = a.linear + turned(h, dh, w_p, v.angular, b_p, a.angular) - turned(o, d_o, w, spin, b, push)
                + coriolis * R::TWO
                + de * acceleration
                + e * ddds;
            put_three(out.q, i, linear, angle);
            put_three(out.qd, i, velocity, spin);
            put_three(out.qdd, i, force, push);
        }
    }

    /// Adds (δN)ᵀ f to `out` · c: how the generalized forces of fixed forces `f` on the links (world · 3n, overwritten by the sums that
    /// are carried to the roots) change along a direction of which `q` are the links' derivatives. `moments` · 3n is scratch. O(links).
    pub(crate) fn add_projection(
        &self,
        model: &Model<'_, R>,
        ds: &[R],
        q: &[R],
        f: &mut [R],
        moments: &mut [R],
        out: &mut [R],
    ) {
        moments.fill(R::zero());
        for (i, link) in model.links.iter().enumerate().rev() {
            let (c, p) = (link.coordinate, link.parent);
            let (force, change) = (twist_of(f, i), at(moments, 3 * i));
            if let Hold::Root = link.hold {
                add(out, c + 2, change);
                continue;
            }
            let hinge = matches!(link.hold, Hold::Hinge { .. });
            let Arms { parent: [h, dh], own: [o, d_o], axis: [_, de] } =
                self.arms(model, i, at(ds, c), [at(q, 3 * p + 2), at(q, 3 * i + 2)]);
            let (moment, slope) = (force.angular - dot(perp(o), force.linear), change - dot(perp(d_o), force.linear));
            add(out, c, if hinge { slope } else { dot(de, force.linear) });
            let carried = twist_of(f, p);
            put_three(f, p, carried.linear + force.linear, carried.angular + moment + dot(perp(h), force.linear));
            let before = at(moments, 3 * p);
            put(moments, 3 * p, before + slope + dot(perp(dh), force.linear));
        }
    }
}
