//! Elementary potentials of rigid motion and their fluxes on the links, and the small vectors that surround them.
//!
//! Per link and per unit density of the fluid, in the link's frame: X = (x, y, χ₃) are the potentials of rigid motion
//! inside, B = h (−y', x', x x' + y y') the fluxes b ds. A u = −2 X v gives the density of the motion v, and
//! ψ = u + X v its potential on the boundary. The added mass is Bᵀ ψ; its transpose costs no further solve of
//! its own: M_hᵀ v = Xᵀ (B v − 2 λ) with Aᵀ λ = B v.

use crate::base::complex::{Complex, complex, dot};
use crate::base::memory::{part, part_mut};
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::{Twist, put_three, twist_of};

/// Three reals per link, world to link frame (linear parts turned).
pub(crate) fn to_link_frames<R: Real>(c: &Configuration<'_, R>, world: &[R], out: &mut [R]) {
    for i in 0..c.model.links.len() {
        let v = twist_of(world, i);
        put_three(out, i, c.pose(c.model.head.plan.walls + i).unturned(v.linear), v.angular);
    }
}

/// Three reals per link, link frame to world, in place, scaled.
pub(crate) fn to_world<R: Real>(c: &Configuration<'_, R>, scale: R, vector: &mut [R]) {
    for i in 0..c.model.links.len() {
        let v = twist_of(vector, i);
        put_three(vector, i, c.pose(c.model.head.plan.walls + i).turned(v.linear) * scale, v.angular * scale);
    }
}

pub(crate) fn potential<'a, R: Real>(nodes: &'a Nodes<'a, R>, v: Twist<R>) -> impl Iterator<Item = R> + 'a {
    nodes
        .x
        .iter()
        .zip(nodes.y)
        .zip(nodes.chi)
        .map(move |((x, y), chi)| v.linear.re * *x + v.linear.im * *y + v.angular * *chi)
}

/// Normal velocity times ds of a rigid motion given in the boundary's frame.
fn flux<'a, R: Real>(nodes: &'a Nodes<'a, R>, v: Twist<R>) -> impl Iterator<Item = R> + 'a {
    let h = nodes.step;
    nodes
        .points()
        .zip(nodes.tangents())
        .map(move |(x, d)| h * (v.linear.im * d.re - v.linear.re * d.im + v.angular * dot(x, d)))
}

/// `out += scale · X v` on the links' nodes (v in link frames).
pub(crate) fn add_interior_potential<R: Real>(c: &Configuration<'_, R>, v: &[R], scale: R, out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        if let Some(link) = b.link {
            for (o, x) in part_mut(out, b.first, b.nodes).iter_mut().zip(potential(&nodes, twist_of(v, link))) {
                *o += scale * x;
            }
        }
    }
}

/// `out = B v` on the links' nodes, 0 on walls.
pub(crate) fn fill_flux<R: Real>(c: &Configuration<'_, R>, v: &[R], out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let out = part_mut(out, b.first, b.nodes);
        match b.link {
            Some(link) => {
                for (o, f) in out.iter_mut().zip(flux(&nodes, twist_of(v, link))) {
                    *o = f;
                }
            }
            None => out.fill(R::zero()),
        }
    }
}

/// `out = Bᵀ f`: three reals per link, link frames.
pub(crate) fn flux_moments<R: Real>(c: &Configuration<'_, R>, f: &[R], out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let (mut linear, mut angular) = (Complex::default(), R::zero());
        for ((x, d), f) in nodes.points().zip(nodes.tangents()).zip(part(f, b.first, b.nodes)) {
            linear += complex(-d.im, d.re) * *f;
            angular += dot(x, d) * *f;
        }
        put_three(out, link, linear * nodes.step, angular * nodes.step);
    }
}

/// `out += scale · Xᵀ f`: three reals per link, link frames.
pub(crate) fn add_potential_moments<R: Real>(c: &Configuration<'_, R>, f: &[R], scale: R, out: &mut [R]) {
    for (_, b, nodes) in c.each_boundary() {
        let Some(link) = b.link else { continue };
        let mut sum = [R::zero(); 3];
        for (((f, x), y), chi) in part(f, b.first, b.nodes).iter().zip(nodes.x).zip(nodes.y).zip(nodes.chi) {
            sum[0] += *f * *x;
            sum[1] += *f * *y;
            sum[2] += *f * *chi;
        }
        for (o, s) in part_mut(out, 3 * link, 3).iter_mut().zip(sum) {
            *o += scale * s;
        }
    }
}
