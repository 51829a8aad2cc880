//! Complex parameters at which one boundary, continued, passes through a node of another (or of its opposite flank).
//!
//! x = s* − s_j is found relative to a node: γ(t_j + u) − γ(t_j) = z − Γ_j without cancellation ([`super::ellipse`] in closed form,
//! [`super::search`] by Newton's method), then x = s(t_j + u) − s(t_j). The rounded Γ_j is the same number as in the
//! kernel's reciprocal.
//!
//! Tested by `fluid/assembly_test.rs:corrected_weights_and_their_derivatives_integrate_a_constant_exactly`,
//! `tests/near_contact`.
#![allow(clippy::indexing_slicing)] // Indices run over arrays of the same constant length.

use crate::base::complex::{Complex, cabs, cln, complex, dot};
use crate::base::elementary::{exp_m1, quotient, sin_cos};
use crate::base::index::Index;
use crate::base::memory::{at, copy, part_mut};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::near::buffers::{Near, NearMut, PREIMAGE_REALS, PREIMAGES, Preimage};
use crate::geometry::curve::{Curve, OutlineView};
use crate::geometry::grading::Offset;
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::{Poses, relative};
use crate::model::Model;
use crate::model::boundary::BoundaryRecord;

/// The pole term falls like (π/N) e^(−N |Im x|/2) and acts on what is left of the density at the end of its spectrum, which by then
/// has fallen as much: beyond this exponent, e^(−20) in double precision, nothing of it is seen (with e^(−17) it is, in the 13th
/// digit).
pub(crate) fn reach<R: Real>() -> R {
    -R::EPSILON.ln() * R::lit(0.55)
}

/// A boundary as the source of a pole.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a, R> {
    pub record: &'a BoundaryRecord<R>,
    pub nodes: Nodes<'a, R>,
    pub view: OutlineView<'a, R>,
    pub table: &'a [R],
}

/// Points whose preimages are asked for: `shift + turn·x` in the source's frame, or the source's own nodes.
#[derive(Clone, Copy)]
pub(crate) struct Targets<'a, R> {
    pub nodes: Nodes<'a, R>,
    pub turn: Complex<R>,
    pub shift: Complex<R>,
    /// They are the source's own nodes, whose preimages at themselves do not count.
    pub own: bool,
}

/// `L` roots t_j + u, with what the curve gives there.
pub(crate) struct Roots<R, const L: usize> {
    pub node: [usize; L],
    pub offset: Offset<R, L>,
    /// γ′.
    pub tangent: [[R; L]; 2],
}

/// The same as preimages.
pub(crate) struct Completed<R, const L: usize> {
    node: [usize; L],
    height: [R; L],
    tangent: [[R; L]; 2],
    factor: [[R; L]; 2],
    rate: [[R; L]; 2],
    offset: [[R; L]; 2],
}

impl<R: Real, const L: usize> Completed<R, L> {
    /// One of them; `None` where the pole term is lost in rounding.
    #[inline]
    pub(crate) fn get(&self, i: usize, nodes: usize) -> Option<Preimage<R>> {
        let [tangent, factor, rate, offset] =
            [&self.tangent, &self.factor, &self.rate, &self.offset].map(|z| complex(at(&z[0], i), at(&z[1], i)));
        let (height, node) = (at(&self.height, i), self.node.get(i).copied()?);
        let exponent = R::count(nodes) * height.abs() * R::HALF;
        let near = exponent < reach() && height != R::zero() && rate.re.is_finite() && rate.im.is_finite();
        let sign = if height < R::zero() { -R::one() } else { R::one() };
        let factor = if node.is_multiple_of(2) { factor } else { -factor };
        near.then_some(Preimage { node, sign, tangent, factor, rate, offset })
    }
}

impl<'a, R: Real> Source<'a, R> {
    /// A boundary with its own nodes.
    pub(crate) fn of(record: &'a BoundaryRecord<R>, store: &'a [R]) -> Self {
        Source { record, nodes: record.nodes(store), view: record.view(store), table: record.table(store) }
    }
}

once! {
    /// Calls `visit` with (row, preimage) for every preimage of the targets that needs a pole term, at most two to a row.
    pub(crate) fn each_preimage['a, 'b: 'a](
        source: &'a Source<'b, R>, targets: &'a Targets<'b, R>, visit: &'a mut (dyn FnMut(usize, Preimage<R>) + 'a),
    ) {
        match &source.view.curve {
            Curve::Ellipse(e) => source.on_ellipse(*e, targets, visit),
            _ => source.search(targets, visit),
        }
    }
}

impl<R: Real> Source<'_, R> {
    /// Real part and magnitude of the imaginary part of the preimage of z next to the boundary; `None` where it is too far to
    /// matter for the trapezoidal rule.
    pub(crate) fn footprint(&self, z: Complex<R>) -> Option<(R, R)> {
        let t = match &self.view.curve {
            Curve::Ellipse(e) => {
                let t = cln(e.preimage(z + self.record.origin));
                complex(t.im, t.re.abs())
            }
            _ => {
                let size = |k: usize| {
                    let (d, dg) = self.arm(k, z);
                    dot(d, d) / dot(dg, dg)
                };
                let closest = (0..self.nodes.t.len()).map(|k| (size(k), k));
                let (_, j) = closest.fold((R::MAX, 0), |best, new| if new.0 < best.0 { new } else { best });
                // Where Newton's method does not settle, the distance over the speed is the scale.
                let (t_j, distance) = (at(self.nodes.t, j), cabs(self.arm(j, z).0));
                let apart = complex(R::zero(), distance / cabs(self.view.curve.jet_real(t_j)[1]));
                let u = self.newton(j, z).unwrap_or(apart);
                complex(t_j + u.re, u.im.abs())
            }
        };
        let near = self.view.grading.plain() * t.im * R::count(self.nodes.t.len()) < reach();
        (near && t.im > R::zero()).then_some((t.re, t.im))
    }

    /// From roots in the curve's parameter to preimages in that of the nodes.
    #[inline(always)]
    pub(crate) fn complete<const L: usize>(&self, roots: &Roots<R, L>) -> Completed<R, L> {
        let [x, slope] = self.view.grading.difference(&roots.offset);
        let zero = [[R::zero(); L]; 2];
        let (node, offset) = (roots.node, roots.offset.u);
        let mut out = Completed { node, height: x[1], tangent: zero, factor: zero, rate: zero, offset };
        let half = R::count(self.nodes.t.len()) * R::HALF;
        let scale = R::HALF * R::PI / half;
        for i in 0..L {
            let (re, im) = (x[0][i], x[1][i]);
            // tan(x/2) = (sin Re x + i sinh Im x)/(cos Re x + cosh Im x)
            let (sin, cos) = sin_cos(re);
            let (less, power) = exp_m1(im);
            let inverse = R::one() / power;
            let bottom = R::one() / (cos + (power + inverse) * R::HALF);
            (out.tangent[0][i], out.tangent[1][i]) = (sin * bottom, (less + less * inverse) * R::HALF * bottom);
            let (sin, cos) = sin_cos(half * re);
            let (_, decay) = exp_m1(-half * im.abs());
            let sin = if im < R::zero() { -sin } else { sin };
            (out.factor[0][i], out.factor[1][i]) = (decay * scale * cos, decay * scale * sin);
            let rate = quotient([slope[0][i], slope[1][i]], [roots.tangent[0][i], roots.tangent[1][i]]);
            (out.rate[0][i], out.rate[1][i]) = (rate[0], rate[1]);
        }
        out
    }
}

/// An angle brought to [−π, π].
pub(crate) fn wrapped<R: Real>(t: R) -> R {
    t - R::TAU * (t / R::TAU).round()
}

/// Finds the preimages of all nodes on all boundaries of which one moves, on walls whose blocks are formed anew, and on the
/// opposite flank of every boundary whose nodes belong to this configuration.
pub(crate) fn find_all<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, near: &mut NearMut<'_, R>) {
    let NearMut { nodes, rungs, lists, preimage_nodes, preimages, unknowns, .. } = near;
    if preimages.is_empty() {
        return;
    }
    let unknowns = *unknowns;
    let view = Near { nodes, rungs, lists, preimage_nodes: &[], preimages: &[], unknowns };
    let c = Configuration { model: *model, poses, near: view };
    let walls_anew = c.walls_regraded();
    for (j, record, nodes) in c.each_boundary() {
        let source = Source { record, nodes, view: c.outline(j, record), table: record.table(model.store) };
        let strip = source.view.grading.plain() * R::count(record.nodes) * R::HALF;
        // Beyond this multiple of the source's reach every pole term is lost.
        let most = (reach::<R>() / strip).exp();
        for (i, target, points) in c.each_boundary() {
            let (first, count) = ((j * unknowns + target.first) * PREIMAGES, target.nodes * PREIMAGES);
            let found = part_mut(preimage_nodes, first, count);
            found.fill(R::Index::of(0));
            let both_walls = record.link.is_none() && target.link.is_none();
            // What a circulating wall induces at another is summed anew.
            let sheet = record.slots.core_modes > 0 && record.circulation != R::zero();
            let wanted = if i == j {
                c.regraded(i) || (record.link.is_none() && walls_anew)
            } else {
                !both_walls || walls_anew || sheet
            };
            let apart = cabs(c.pose(i).origin - c.pose(j).origin) - target.reach;
            let far = i != j && record.sign < R::zero() && target.sign < R::zero() && apart > most * record.reach;
            if !wanted || far {
                continue;
            }
            let (turn, shift) = if i == j {
                (complex(R::one(), R::zero()), Complex::default())
            } else {
                relative(c.pose(i), c.pose(j))
            };
            let reals = part_mut(preimages, first * PREIMAGE_REALS, count * PREIMAGE_REALS);
            let targets = Targets { nodes: points, turn, shift, own: i == j };
            each_preimage(&source, &targets, &mut |row, p| {
                let free = (row * PREIMAGES..(row + 1) * PREIMAGES)
                    .find(|slot| found.get(*slot).is_some_and(|node| node.get() == 0));
                let Some(slot) = free else { return };
                if let Some(node) = found.get_mut(slot) {
                    *node = R::Index::of(p.node + 1);
                }
                copy(part_mut(reals, slot * PREIMAGE_REALS, PREIMAGE_REALS), &p.reals());
            });
        }
    }
}
