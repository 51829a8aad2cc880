//! Where nodes must crowd: at closest points of two boundaries, and where a tip or corner of one faces the other.
//!
//! The density between two curves varies on the scale of the foci of their osculating circles. With distance d and
//! curvatures k, k' towards the fluid, D = k k' d + k + k' and f = (k d + 2)(k' d + 2)(k k' d + 2 (k + k')), they lie
//! c = √(d f/4)/D to both sides of a point between the curves. A ladder resolves the distance of the farther one.
//!
//! Tested by the tests at its end, `tests/near_contact` (accuracy at few nodes), `tests/regrading`.

use crate::base::complex::{Complex, cabs};
use crate::base::index::Index;
use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::fluid::gap::{Placed, apart, closest_points, foot};
use crate::fluid::near::buffers::LadderLists;
use crate::fluid::near::preimage::wrapped;
use crate::geometry::curve::Curve;
use crate::geometry::grading::Ladder;
use crate::geometry::pose::Poses;
use crate::model::Model;

/// Scale at which a ladder at a closest point has faded out: its own, by which these ladders are known.
const TOP: f64 = 2.0;
/// Size of a ladder at a tip or its foot, in units of c.
const TIP: f64 = 1.25;
/// Beyond this many reaches of the larger body no ladder of a pair acts: ln(1 + d/R) exceeds [`TOP`] on a disc.
const FAR: f64 = 6.4;

/// Half-distance c of the foci and the share x of the gap that belongs to the first curve (curvature `k`); `None` where the
/// curves do not narrow.
fn foci<R: Real>(d: R, k: R, other: R) -> Option<(R, R)> {
    let (p, q) = (k * d + R::TWO, other * d + R::TWO);
    let (sum, f) = (k * other * d + k + other, k * other * d + R::TWO * (k + other));
    let positive = [d, p, q, f, sum].into_iter().all(|x| x > R::zero());
    positive.then(|| ((d * p * q * f).sqrt() * R::HALF / sum, d * q * k * R::HALF / sum))
}

/// The parameter's imaginary part at distance `x` beside a curve: |γ'|² β² + |γ''|² β⁴/4 = x².
fn lift<R: Real>(tangent: Complex<R>, second: Complex<R>, x: R) -> R {
    let (p, q) = (tangent.re * tangent.re + tangent.im * tangent.im, second.re * second.re + second.im * second.im);
    (R::TWO * x * x / (p + (p * p + q * x * x).sqrt())).sqrt()
}

/// A point of a placed boundary as ladders need it.
struct Site<R> {
    t: R,
    /// Derivatives of the curve by t, world directions.
    tangent: Complex<R>,
    second: Complex<R>,
    /// Into the fluid.
    normal: Complex<R>,
    /// Towards the fluid.
    curvature: R,
}

fn site<R: Real>(p: &Placed<'_, R>, store: &[R], t: R) -> Site<R> {
    let [_, tangent, second, normal] = p.jet(store, t, p.pose.origin);
    let speed = cabs(tangent);
    let bend = (tangent.re * second.im - tangent.im * second.re) / (speed * speed * speed);
    Site { t, tangent, second, normal, curvature: -p.record.sign * bend }
}

/// Appends a ladder to the list of a boundary, finest first; a full list drops its coarsest.
fn push<R: Real>(lists: &mut LadderLists<'_, R>, boundary: usize, mut ladder: Ladder<R>) {
    let Some((count, slots)) = lists.of(boundary) else { return };
    if ladder.beta.is_nan() || ladder.beta >= ladder.top {
        return;
    }
    let listed = count.get();
    for (i, slot) in slots.iter_mut().enumerate().take(listed + 1) {
        if i >= listed {
            *slot = [ladder.t, ladder.beta, ladder.top];
            *count = R::Index::of(listed + 1);
        } else if let [t, beta, top] = slot
            && ladder.beta < *beta
        {
            let mine = ladder;
            ladder = Ladder { t: *t, beta: *beta, top: *top };
            (*t, *beta, *top) = (mine.t, mine.beta, mine.top);
        }
    }
}

/// Fills the lists of all boundaries for all pairs of which one moves.
pub(crate) fn place<R: Real>(model: &Model<'_, R>, poses: Poses<'_, R>, lists: &mut LadderLists<'_, R>) {
    lists.clear();
    let placed = |i: usize| model.boundary(i).map(|(record, nodes)| Placed { record, nodes, pose: poses.get(i) });
    for i in 0..model.boundaries.len() {
        for j in i + 1..model.boundaries.len() {
            if let (Some(a), Some(b)) = (placed(i), placed(j))
                && (a.record.link.is_some() || b.record.link.is_some())
            {
                place_pair(model.store, (i, &a), (j, &b), lists);
            }
        }
    }
    for i in 0..model.boundaries.len() {
        if let Some((count, slots)) = lists.of(i) {
            thin(slots.get_mut(..count.get()).unwrap_or(&mut []));
        }
    }
}

/// Fades ladders of tips and their feet where a closest point already asks for as much: mostly it lies at the tip itself.
fn thin<R: Real>(ladders: &mut [[R; 3]]) {
    let at_closest_point = |top: R| top == R::lit(TOP);
    for i in 0..ladders.len() {
        let Some(&[t, beta, top]) = ladders.get(i) else { continue };
        if at_closest_point(top) {
            continue;
        }
        let mut cover = R::zero();
        for &[t2, beta2, top2] in &*ladders {
            if at_closest_point(top2) {
                // At this distance the other one resolves that much, as far as it has not faded itself.
                let finest = beta2.max(wrapped(t - t2).abs() * R::lit(3.0));
                let strength = R::one().min((top2 / beta2).ln());
                cover = cover.max((R::lit(1.5) - finest / beta) / R::HALF * strength);
            }
        }
        if let Some([_, _, faded]) = ladders.get_mut(i) {
            *faded = beta * (top / beta).powf(R::one() - cover.min(R::one()));
        }
    }
}

/// Adds the ladders of one pair.
pub(crate) fn place_pair<R: Real>(
    store: &[R],
    (i, a): (usize, &Placed<'_, R>),
    (j, b): (usize, &Placed<'_, R>),
    lists: &mut LadderLists<'_, R>,
) {
    if apart(a, b) > R::lit(FAR) * a.record.reach.max(b.record.reach) {
        return;
    }
    closest_points(a, b, store, |s, t, d| {
        let (p, q) = (site(a, store, s), site(b, store, t));
        for (at, place, own, other) in [(i, a, &p, &q), (j, b, &q, &p)] {
            let Some((c, share)) = foci(d, own.curvature, other.curvature) else { continue };
            let delta = share + c;
            let curve = place.record.view(store).curve;
            let beta = match &curve {
                Curve::Ellipse(e) => {
                    let x = curve.jet_real(own.t)[0] + place.pose.unturned(own.normal) * delta;
                    cabs(e.preimage(x)).ln().abs()
                }
                _ => lift(own.tangent, own.second, delta),
            };
            push(lists, at, Ladder { t: own.t, beta, top: R::lit(TOP) });
        }
    });
    for ((at, place), (beside, other)) in [((i, a), (j, b)), ((j, b), (i, a))] {
        for &t in part(store, place.record.slots.tips_at, place.record.tips) {
            let tip = site(place, store, t);
            let (opposite, d) = foot(other, store, place.point(store, t));
            let flank = site(other, store, opposite);
            let Some((c, _)) = foci(d, tip.curvature, flank.curvature.max(R::zero())) else { continue };
            for (at, s) in [(at, &tip), (beside, &flank)] {
                let beta = lift(s.tangent, s.second, R::lit(TIP) * c);
                push(lists, at, Ladder { t: s.t, beta, top: R::lit(crate::geometry::grading::TOP) });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ladder_of_a_tip_fades_as_far_as_that_of_a_closest_point_resolves_its_scale() {
        // The closest point resolves its own scale, or a third of what is away from it.
        let (beta, tip) = (0.01_f64, crate::geometry::grading::TOP);
        for (scale, distance, cover) in
            [(0.3, 0.0, 1.0), (1.0, 0.0, 1.0), (1.25, 0.0, 0.5), (1.5, 0.0, 0.0), (4.0, 0.0, 0.0), (0.3, 0.3, 1.0)]
                .into_iter()
                .chain([(0.3, 1.25 / 3.0, 0.5), (0.3, 0.5, 0.0), (1.25, -0.2, 0.5), (0.3, f64::TAU / beta + 0.1, 1.0)])
        {
            let closest = [1.0 + distance * beta, scale * beta, TOP];
            let mut ladders = [closest, [1.0, beta, tip]];
            thin(&mut ladders);
            let left = (ladders[1][2] / beta).ln() / (tip / beta).ln();
            assert!((left - (1.0 - cover)).abs() < 1e-11, "{scale} {distance}: {left} is left");
            assert_eq!(ladders[0], closest);
        }
    }
}
