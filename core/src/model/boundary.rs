//! One boundary of the fluid: its compiled outline, and where its nodes and blocks are in the store.
//!
//! Tested by `fluid/assembly_test.rs` (χ₃).

use crate::base::complex::{Complex, complex, dot};
use crate::base::features;
use crate::base::memory::part;
use crate::base::scalar::Real;
use crate::base::status::{Place, Status};
use crate::geometry::curve::{AreaProperties, Curve, Outline, OutlineView};
use crate::geometry::grading::Ladder;
use crate::geometry::nodes::Nodes;
use crate::geometry::pose::Pose;

/// Where the numbers of one boundary are in the store (`rungs`: in a simulation's buffer).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slots {
    /// The shape's own numbers.
    pub(crate) store_at: usize,
    pub(crate) store_len: usize,
    /// Permanent ladders, three reals each.
    pub(crate) ladders_at: usize,
    /// Parameters of tips and corners.
    pub(crate) tips_at: usize,
    /// Fourier sum of the potential of rotation (no reals: closed form or fixed nodes).
    pub(crate) modes_at: usize,
    pub(crate) modes: usize,
    /// Fourier sums of the isolated circulatory flow, this many reals each (none: closed form or not needed).
    pub(crate) core_at: usize,
    pub(crate) core_modes: usize,
    /// Table of pole terms (no reals: plain rule).
    pub(crate) table_at: usize,
    pub(crate) table_len: usize,
    /// Rungs of a configuration.
    pub(crate) rungs_at: usize,
    pub(crate) rungs_len: usize,
    /// Node arrays.
    pub(crate) data_at: usize,
    /// Self block of A (links only).
    pub(crate) self_at: usize,
    /// Re G of the self block (links only, where there is circulation).
    pub(crate) regular_at: usize,
}

/// One boundary of the fluid.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryRecord<R> {
    /// Where it stands in the scene.
    pub(crate) place: Place,
    /// Link that carries it; `None` for a wall.
    pub(crate) link: Option<usize>,
    /// −1 for links and obstacles, +1 for the tank.
    pub(crate) sign: R,
    /// Number of nodes.
    pub(crate) nodes: usize,
    /// First unknown.
    pub(crate) first: usize,
    /// Compiled shape.
    pub(crate) outline: Outline<R>,
    /// Where its numbers are in the store.
    pub(crate) slots: Slots,
    /// Origin of the boundary's frame in the shape's drawing frame.
    pub(crate) origin: Complex<R>,
    /// Number of permanent ladders.
    pub(crate) ladders: usize,
    /// Number of tips and corners.
    pub(crate) tips: usize,
    /// Circulation.
    pub(crate) circulation: R,
    /// Its isolated circulatory flow.
    pub(crate) core: Core<R>,
    /// Placement of a wall.
    pub(crate) pose: Pose<R>,
    /// Greatest distance of the outline from the frame's origin.
    pub(crate) reach: R,
    /// Greatest distance between neighbouring nodes.
    pub(crate) spacing: R,
    /// Measures of what a link's outline encloses.
    pub(crate) measures: AreaProperties<R>,
    /// What set-up noticed.
    pub(crate) notice: Status,
    /// Estimate of the relative error that comes from what is between the points of a curve; NaN where none was made.
    pub(crate) outline_error: R,
}

/// Isolated circulatory flow of one boundary, analytic outside: log W of an ellipse in closed form, else tabulated.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Core<R> {
    /// Centre of an ellipse in the boundary's frame.
    pub(crate) centre: Complex<R>,
    /// Its semi-axes.
    pub(crate) axes: [R; 2],
    /// Stream function on the boundary where it is log |z| far away (the logarithm of the outline's capacity), and by how much
    /// the tabulated one varies along the boundary.
    pub(crate) level: R,
    pub(crate) spread: R,
}

impl<R: Real> Default for BoundaryRecord<R> {
    fn default() -> Self {
        BoundaryRecord {
            place: Place::Scene,
            link: None,
            sign: -R::one(),
            nodes: 0,
            first: 0,
            outline: Outline::default(),
            slots: Slots::default(),
            origin: Complex::default(),
            ladders: 0,
            tips: 0,
            circulation: R::zero(),
            core: Core::default(),
            pose: Pose::default(),
            reach: R::zero(),
            spacing: R::zero(),
            measures: AreaProperties::default(),
            notice: Status::Ok,
            outline_error: R::NAN,
        }
    }
}

impl<R: Real> BoundaryRecord<R> {
    /// Reals of the node arrays.
    pub(crate) fn data_len(nodes: usize, with_chi: bool) -> Option<usize> {
        nodes.checked_mul(if with_chi { 8 } else { 7 })
    }
    pub(crate) fn nodes<'a>(&self, store: &'a [R]) -> Nodes<'a, R> {
        Nodes::read(part(store, self.slots.data_at, self.nodes * if self.link.is_some() { 8 } else { 7 }), self.nodes)
    }
    /// Curve and permanent grading.
    pub(crate) fn view<'a>(&self, store: &'a [R]) -> OutlineView<'a, R> {
        self.outline.view(part(store, self.slots.store_at, self.slots.store_len))
    }
    /// Cosines and sines of the pole terms (empty for the plain rule).
    pub(crate) fn table<'a>(&self, store: &'a [R]) -> &'a [R] {
        if features::NEAR { part(store, self.slots.table_at, self.slots.table_len) } else { &[] }
    }
    /// Permanent ladders.
    pub(crate) fn ladders<'a>(&self, store: &'a [R]) -> impl Iterator<Item = Ladder<R>> + use<'a, R> {
        let list = part(store, self.slots.ladders_at, 3 * self.ladders);
        list.as_chunks::<3>().0.iter().map(|&[t, beta, top]| Ladder { t, beta, top })
    }
    /// Whether a lone body's χ₃ is known: in closed form, or on the way to its isolated flow.
    pub(crate) fn knows_rotation(&self, store: &[R]) -> bool {
        self.slots.core_modes > 0 || matches!(self.view(store).curve, Curve::Ellipse(_))
    }
    /// χ₃ at a point of the outline, whose permanent parameter s is asked for where there is no closed form.
    pub(crate) fn rotation_potential(&self, store: &[R], x: Complex<R>, s: impl FnOnce() -> R) -> R {
        match self.view(store).curve {
            Curve::Ellipse(e) => {
                // About the centre: ratio·x y. The frame's origin is off the centre by `origin`: rotation about it differs
                // by the translation −i·origin, whose potential is linear.
                let (a, b) = (e.a * e.a, e.b * e.b);
                let centred = x + self.origin;
                let shift = complex(self.origin.im, -self.origin.re);
                (a - b) / (a + b) * centred.re * centred.im + dot(shift, x)
            }
            _ => fourier_sum(part(store, self.slots.modes_at, self.slots.modes), s()),
        }
    }
    /// Harmonic conjugate θ of the isolated flow's stream function at permanent parameter s: θ′(s) and θ(s) − s.
    pub(crate) fn isolated(&self, store: &[R], s: R) -> [R; 2] {
        let (at, len) = (self.slots.core_at, self.slots.core_modes);
        [at, at + len].map(|at| fourier_sum(part(store, at, len), s))
    }
}

/// Σ a_m cos ms + b_m sin ms of pairs (a_m, b_m), by Clenshaw's recurrence.
pub(crate) fn fourier_sum<R: Real>(modes: &[R], s: R) -> R {
    let (sin, cos) = s.sin_cos();
    let twice = cos * R::TWO;
    let (mut a1, mut a2, mut b1, mut b2) = (R::zero(), R::zero(), R::zero(), R::zero());
    let mut pairs = modes.as_chunks::<2>().0.iter();
    let first = pairs.next().map_or(R::zero(), |[a, _]| *a);
    // Downwards: the list is short, and an iterator from the back needs no index.
    while let Some([a, b]) = pairs.next_back() {
        (a1, a2) = (*a + twice * a1 - a2, a1);
        (b1, b2) = (*b + twice * b1 - b2, b1);
    }
    first + cos * a1 - a2 + sin * b1
}
