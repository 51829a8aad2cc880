//! The arrays of one evaluation of the equations of motion, in the order in which they are computed. All lie in the caller's
//! memory; what is written there belongs to the state that was evaluated last until [`Evaluation::place`] is called again.
//!
//! Shapes: n links, b boundaries, c coordinates of which p are free, N unknowns of the boundary system, k columns: the p free
//! coordinates and, if prescribed ones move, their common motion. Three reals of a link are x, y, θ (velocities ẋ, ẏ, θ̇;
//! forces fx, fy, torque about the centre of mass), *world* or *link*: directions of its linear part.
//!
//! Tested by `tests/walls.rs:an_evaluation_between_walls_depends_on_its_state_alone`, `tests/driving`, `tests/allocation`.

use crate::base::memory::buffers;
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::dynamics::forces::circulation::Flow;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::PairScratch;
use crate::fluid::near::buffers::{COLUMNS, LADDERS, LISTS, Near, NearMut, PREIMAGE_REALS, PREIMAGES};
use crate::fluid::system::BoundarySystem;
use crate::geometry::pose::Poses;
use crate::linear::lu::Factorization;
use crate::model::{Model, ModelHead, NearDims};

/// Numbers that the arrays' lengths follow from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dims {
    pub links: usize,
    pub boundaries: usize,
    pub coordinates: usize,
    pub free: usize,
    /// Unknowns of the boundary system while stepping (0: none).
    pub unknowns: usize,
    /// Leading dimension of its matrix.
    pub ld: usize,
    pub columns: usize,
    /// Unknowns if there is circulation, else 0.
    pub circulating: usize,
    /// Driven channels.
    pub channels: usize,
    /// What near contact needs; 0 where it needs nothing.
    pub near: NearDims,
}

impl Dims {
    pub(crate) fn of<R: Real>(head: &ModelHead<R>, coordinates: usize) -> Dims {
        let p = &head.plan;
        Dims {
            links: p.links,
            boundaries: p.links + p.walls,
            coordinates,
            free: p.free_coordinates,
            unknowns: p.unknowns,
            ld: leading(p.unknowns),
            columns: p.free_coordinates + usize::from(head.prescribed_moves),
            circulating: if p.circulation { p.unknowns } else { 0 },
            channels: head.channels,
            near: head.near,
        }
    }
}

/// Leading dimension of the boundary system: an odd multiple of a cache line keeps columns from falling on the same lines,
/// and each begins where a line begins if the first does.
pub(crate) fn leading(unknowns: usize) -> usize {
    if unknowns == 0 { 0 } else { (unknowns.div_ceil(8) | 1) * 8 }
}

/// Reals by which the matrix may be moved to begin with a cache line, where vectors are that long.
fn slack<R>(unknowns: usize) -> usize {
    if unknowns > 0 && cfg!(target_arch = "x86_64") { LINE / size_of::<R>() } else { 0 }
}

/// Bytes of a cache line.
const LINE: usize = 64;

// ------------------------------------------------------------------------------------------ depends on time and position

buffers! {
    /// The tree's coordinates s. Written by [`Evaluation::place`]; `ds` of free ones by `unlock` too where a lone swimmer's rates
    /// follow from its impulse; `dds` by `accelerate`.
    pub(crate) struct Coordinates(d: Dims) {
        /// Inputs of the channels: (t, u, u̇, ü) at both ends of the coming step · 8 per channel · a copy of the simulation's.
        channels: R = d.channels * crate::model::signal::CHANNEL_LEN,
        /// s · c.
        s: R = d.coordinates,
        /// ṡ · c.
        ds: R = d.coordinates,
        /// s̈ · c: of prescribed coordinates as they are driven; of free ones 0, then as computed.
        dds: R = d.coordinates,
    }
}

buffers! {
    /// Where everything is. Written by [`Evaluation::place`] (`q`, `poses`) and [`Evaluation::grade`] (the rest).
    pub(crate) struct Placement(d: Dims) {
        /// x, y, θ of every link · 3n.
        q: R = 3 * d.links,
        /// Placements of all boundaries, see [`Poses`] · 4b; the walls' once, when the simulation begins.
        poses: R = 4 * d.boundaries,
        /// Node arrays of this configuration · 8 columns per boundary · where it has ladders.
        nodes: R = COLUMNS * d.near.nodes,
        /// Rungs of its ladders.
        rungs: R = d.near.rungs,
        /// Numbers of ladders and of rungs · 2b.
        lists: R::Index = if d.near.nodes > 0 { LISTS * d.boundaries } else { 0 },
        /// Ladders · [`LADDERS`] reals per boundary.
        ladders: R = if d.near.nodes > 0 { LADDERS * d.boundaries } else { 0 },
        /// Nodes from which preimages are counted, plus 1 (0: none) · [`PREIMAGES`] per boundary and unknown.
        preimage_nodes: R::Index = if d.near.nodes > 0 { PREIMAGES * d.boundaries * d.unknowns } else { 0 },
        /// The preimages · [`PREIMAGE_REALS`] each.
        preimages: R = if d.near.nodes > 0 { PREIMAGES * PREIMAGE_REALS * d.boundaries * d.unknowns } else { 0 },
    }
}

buffers! {
    /// The motions that are solved for, column by column. Written by `fill_jacobian` and `solve_columns`.
    pub(crate) struct Columns(d: Dims) {
        /// N = ∂F/∂p and N_u u̇, world · 3n × k.
        jacobian: R = 3 * d.links * d.columns,
        /// The same, link · 3n × k.
        in_links: R = 3 * d.links * d.columns,
        /// M^f N: momenta of the fluid, one half of the added mass, world, with density · 3n × k.
        momenta: R = 3 * d.links * d.columns,
    }
}

buffers! {
    /// Memory of [`BoundarySystem`]: factors of A and the densities of the columns behind them.
    struct SystemMemory(d: Dims) {
        matrix: R = d.ld * (d.unknowns + d.columns) + slack::<R>(d.unknowns),
        pivots: R::Index = d.unknowns,
        regular: R = d.circulating * d.circulating,
    }
}

buffers! {
    /// The equations of the free coordinates. `mass` by `reduce_mass`, `rhs` by `accelerate` (and `unlock`).
    pub(crate) struct Reduced(d: Dims) {
        /// N_pᵀ M N_p, in its lower triangle the factors L D Lᵀ · p × p.
        mass: R = d.free * d.free,
        /// Inverse pivots · p.
        inverse_pivots: R = d.free,
        /// Right-hand side, then the solution: p̈, or ṗ of a lone swimmer · p.
        rhs: R = d.free,
    }
}

// ----------------------------------------------------------------------------------------------------- depends on velocity

buffers! {
    /// The velocity and what the fluid makes of it. `qd` by [`Evaluation::place`] (or `unlock`); to `momentum` by `solve_motion`;
    /// the rest by `pass`, per unit density but for the gradient.
    pub(crate) struct Velocity(d: Dims) {
        /// q̇, world · 3n.
        qd: R = 3 * d.links,
        /// q̇, link · 3n.
        in_links: R = 3 * d.links,
        /// u with A u = −2 X q̇ · N.
        density: R = d.unknowns,
        /// λ with Aᵀ λ = B q̇ · N.
        adjoint: R = d.unknowns,
        /// p = M^f q̇, symmetrized, world, with density · 3n.
        momentum: R = 3 * d.links,
        /// a = Im(ż ∘ D u) · N.
        rate: R = d.unknowns,
        /// l = Im((λ ż)ᵀ D) · N; by the boundary formula its kernel.
        transposed: R = d.unknowns,
        /// q̇ᵀ (∂M^f/∂q) q̇ without the turning of the frames, with density · 3n.
        gradient: R = 3 * d.links,
    }
}

// ------------------------------------------------------------------------------------------------- depends on acceleration

buffers! {
    /// Forces and accelerations, world.
    pub(crate) struct Forces(d: Dims) {
        /// Forces that come neither from inertia nor from drives, as terms of the left-hand side · 3n · by `outer_forces`.
        outer: R = 3 * d.links,
        /// q̈ at p̈ = 0: a + N_u ü · 3n · by `accelerate`.
        drift: R = 3 * d.links,
        /// M w + f of the accelerations w asked for last · 3n · by `fluid_force` and who called it.
        force: R = 3 * d.links,
        /// (∂F/∂s)ᵀ of it · c.
        generalized: R = d.coordinates,
        /// q̈ · 3n · by `accelerate`.
        qdd: R = 3 * d.links,
    }
}

buffers! {
    /// What a function needs while it runs: nothing here outlives it.
    pub(crate) struct Scratch(d: Dims) {
        /// One real per coordinate · c.
        unit: R = d.coordinates,
        /// Two vectors of the links · 3n.
        three: R = 3 * d.links,
        other: R = 3 * d.links,
        /// A right-hand side, then its solution · N.
        solution: R = d.unknowns,
        /// The same of a transposed system · N.
        transposed: R = d.unknowns,
    }
}

/// Error indicators that an evaluation finds by the way (see [`crate::Resolution`]).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Indicators<R> {
    pub mass: R,
    pub force: R,
    pub repulsion: R,
    pub circulation: R,
}

/// What the arrays hold from one call to the next: the one place that knows.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Kept<R> {
    /// They hold the evaluation of the state shown, accelerations included. [`Evaluation::place`] and everything that writes
    /// over arrays unset it; [`crate::Sim`] sets it, after an evaluation of that state.
    pub shown: bool,
    /// At a time at which drives jump, they are taken as they were before it: at the end of a step, not at its beginning.
    pub before: bool,
    /// The walls' own rows and columns of the matrix hold their factors.
    pub walls_ready: bool,
    /// Where in its memory the matrix begins: a number, so that memory that is moved keeps its meaning.
    matrix_at: usize,
    pub indicators: Indicators<R>,
    /// Who factorizes the matrix.
    #[cfg(feature = "faer")]
    pub factorization: Factorization,
}

impl<R> Kept<R> {
    /// Who factorizes the matrix.
    #[inline]
    pub(crate) fn factorization(&self) -> Factorization {
        #[cfg(feature = "faer")]
        return self.factorization;
        #[cfg(not(feature = "faer"))]
        Factorization::Own
    }
}

/// All arrays of one evaluation.
pub(crate) struct Evaluation<'a, R: Real> {
    pub kept: &'a mut Kept<R>,
    pub coordinates: Coordinates<'a, R>,
    pub placement: Placement<'a, R>,
    pub columns: Columns<'a, R>,
    pub system: BoundarySystem<'a, R>,
    pub reduced: Reduced<'a, R>,
    pub velocity: Velocity<'a, R>,
    pub circulation: Flow<'a, R>,
    pub forces: Forces<'a, R>,
    pub scratch: Scratch<'a, R>,
    pub pairs: PairScratch<'a, R>,
}

impl<'a, R: Real> Evaluation<'a, R> {
    /// Number of reals needed.
    pub(crate) fn len(d: &Dims) -> Option<usize> {
        let parts = [
            Coordinates::<R>::len(d),
            Placement::<R>::len(d),
            Columns::<R>::len(d),
            SystemMemory::<R>::len(d),
            Reduced::<R>::len(d),
            Velocity::<R>::len(d),
            Flow::<R>::len(&d.circulating),
            Forces::<R>::len(d),
            Scratch::<R>::len(d),
            PairScratch::<R>::len(&d.unknowns),
        ];
        parts.into_iter().try_fold(0usize, |sum, len| sum.checked_add(len?))
    }

    /// Takes the arrays from the front of a slab of at least `len` reals.
    pub(crate) fn take(d: &Dims, kept: &'a mut Kept<R>, rest: &mut &'a mut [R]) -> Result<Self> {
        let coordinates = Coordinates::take(d, rest)?;
        let placement = Placement::take(d, rest)?;
        let columns = Columns::take(d, rest)?;
        let memory = SystemMemory::take(d, rest)?;
        if !kept.shown && !kept.walls_ready {
            let to_line = memory.matrix.as_ptr().align_offset(LINE);
            kept.matrix_at = if to_line <= slack::<R>(d.unknowns) { to_line } else { 0 };
        }
        let matrix = memory.matrix.get_mut(kept.matrix_at..).ok_or(Status::Internal)?;
        Ok(Evaluation {
            kept,
            coordinates,
            placement,
            columns,
            system: BoundarySystem {
                matrix,
                ld: d.ld,
                unknowns: d.unknowns,
                pivots: memory.pivots,
                regular: memory.regular,
            },
            reduced: Reduced::take(d, rest)?,
            velocity: Velocity::take(d, rest)?,
            circulation: Flow::take(&d.circulating, rest)?,
            forces: Forces::take(d, rest)?,
            scratch: Scratch::take(d, rest)?,
            pairs: PairScratch::take(&d.unknowns, rest)?,
        })
    }
}

impl<R: Real> Placement<'_, R> {
    /// What an evaluation sees of the scene where it was placed.
    #[inline]
    pub(crate) fn configuration<'s>(&'s self, model: &Model<'s, R>) -> Configuration<'s, R> {
        let Placement { poses, nodes, rungs, lists, preimage_nodes, preimages, .. } = self;
        let unknowns = model.head.plan.unknowns;
        let near = Near { nodes, rungs, lists, preimage_nodes, preimages, unknowns };
        Configuration { model: *model, poses: Poses(poses), near }
    }

    /// The part that follows the configuration, to be filled, and the placements.
    pub(crate) fn near(&mut self, unknowns: usize) -> (NearMut<'_, R>, Poses<'_, R>) {
        let Placement { poses, nodes, rungs, lists, ladders, preimage_nodes, preimages, .. } = self;
        (NearMut { nodes, rungs, lists, ladders, preimage_nodes, preimages, unknowns }, Poses(poses))
    }
}

/// Counts that a simulation keeps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counters {
    /// Evaluations of the equations of motion.
    pub evaluations: u64,
    /// Factorizations of the boundary system.
    pub factorizations: u64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
}
