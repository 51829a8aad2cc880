//! Derivatives of the motion at the state shown.
//!
//! Tested by `tests/derivatives`.

use crate::base::memory::copy;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::derivatives::motion::{Linearizer, MotionDims, MotionScratch, Parameter};
use crate::dynamics::derivatives::{DerivativeDims, Derivatives, supported};
use crate::fluid::tangent_pass::TangentScratch;
use crate::model::Model;
use crate::simulation::sim::Sim;

/// What is known of a linearization.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Linearization<R> {
    /// Bound of its relative error in space: twice that of the force (see [`Resolution::bound`](crate::Resolution::bound)), since it has
    /// a derivative more.
    pub bound: R,
}

impl<R: Real> Sim<'_, R> {
    /// Reals of memory that [`Sim::force_derivatives`] and [`Sim::linearize`] take beside the simulation's own: about 15 n N for n links
    /// with N nodes in all, and N times the nodes of the largest boundary.
    ///
    /// # Errors
    /// `SizeOverflow`.
    pub fn derivative_requirement(model: &Model<'_, R>) -> Result<usize> {
        let dims = DerivativeDims::of(model);
        let motion = MotionScratch::<R>::len(&Self::motion_dims(model));
        let parts = [Derivatives::<R>::len(&dims), TangentScratch::<R>::len(&dims.longest), motion];
        let sum = parts.into_iter().try_fold(0usize, |sum, len| sum.checked_add(len?));
        sum.ok_or(Status::SizeOverflow.into())
    }

    /// Derivatives of the force r = M q̈ + F by positions and velocities at the state shown, for given accelerations `qdd` of the links
    /// (3n, world): `position` = ∂r/∂q and `velocity` = ∂r/∂q̇, 3n × 3n each, column-major, in N, kg/s and so on per unit of the
    /// coordinates. F is everything but inertia: the Christoffel force (2.15), weight and buoyancy (2.16), repulsion (5.1); not the
    /// forces of joints. Exact derivatives of the discrete force with nodes that stay where they are in their outlines. `memory`:
    /// [`Sim::derivative_requirement`]. The simulation does not change. The price of two to three evaluations, and of one more if nothing was
    /// asked at this state.
    ///
    /// # Errors
    /// `Length`, `NotFinite`, `MemoryTooSmall`; `Unsupported` with the name of what has no derivatives: `circulation`,
    /// `force formula` (the boundary formula). As [`Sim::energy`].
    pub fn force_derivatives(
        &mut self,
        qdd: &[R],
        position: &mut [R],
        velocity: &mut [R],
        memory: &mut [R],
    ) -> Result<()> {
        let rows = self.rows();
        for (given, needed) in [(qdd.len(), rows), (position.len(), rows * rows), (velocity.len(), rows * rows)] {
            if given != needed {
                return Err(Error::new(Status::Length).of("length", given as f64));
            }
        }
        if !qdd.iter().all(|x| x.is_finite()) {
            return Err(Status::NotFinite.into());
        }
        let model = self.model;
        supported(&model)?;
        let given = memory.len() as f64;
        let short = |e: Error| if e.status == Status::MemoryTooSmall { e.of("length", given) } else { e };
        let dims = DerivativeDims::of(&model);
        let rest = &mut { memory };
        let mut d = Derivatives::take(&dims, rest).map_err(short)?;
        let mut s = TangentScratch::take(&dims.longest, rest).map_err(short)?;
        self.evaluated()?;
        self.evaluation.force_derivatives(&model, qdd, &mut d, &mut s);
        copy(position, d.position);
        copy(velocity, d.velocity);
        Ok(())
    }

    fn motion_dims(model: &Model<'_, R>) -> MotionDims {
        MotionDims { rows: 3 * model.links.len(), coordinates: model.coordinates.len() }
    }

    /// The linearization of ẏ = f(t, y, θ) at the state shown, y as [`Sim::state`] gives it (d reals): `a` = ∂f/∂y, d × d, and `b` = ∂f/∂θ,
    /// d × `parameters.len()`, column-major. Derivatives of the discrete right-hand side [`Sim::rhs`], of the work of the drives too,
    /// with nodes that stay where they are in their outlines. `memory`: [`Sim::derivative_requirement`]. The simulation does not change:
    /// a run goes on by the same bits. The price of two to three evaluations more, and O(n³) for n links.
    ///
    /// # Errors
    /// `Length`, `MemoryTooSmall`; `OutOfRange` with the name of a parameter that the model does not have; `Unsupported` as
    /// [`Sim::force_derivatives`]. As [`Sim::energy`].
    pub fn linearize<P>(
        &mut self,
        parameters: P,
        a: &mut [R],
        b: &mut [R],
        memory: &mut [R],
    ) -> Result<Linearization<R>>
    where
        P: IntoIterator<Item = Parameter>,
        P::IntoIter: ExactSizeIterator + Clone,
    {
        let parameters = parameters.into_iter();
        let rows = self.state.y.len();
        for (given, needed) in [(a.len(), rows * rows), (b.len(), rows * parameters.len())] {
            if given != needed {
                return Err(Error::new(Status::Length).of("length", given as f64));
            }
        }
        let model = self.model;
        supported(&model)?;
        for (k, parameter) in parameters.clone().enumerate() {
            parameter.checked(&model).map_err(|name| Error::new(Status::OutOfRange).of(name, k as f64))?;
        }
        let given = memory.len() as f64;
        let short = |e: Error| if e.status == Status::MemoryTooSmall { e.of("length", given) } else { e };
        let dims = DerivativeDims::of(&model);
        let rest = &mut { memory };
        let d = Derivatives::take(&dims, rest).map_err(short)?;
        let mut s = TangentScratch::take(&dims.longest, rest).map_err(short)?;
        let m = MotionScratch::take(&Self::motion_dims(&model), rest).map_err(short)?;
        let bound = self.evaluated()?.bound() * R::TWO;
        let (evaluation, impulse) = (&mut self.evaluation, self.progress.impulse);
        Linearizer { evaluation, model, impulse, d, m }.fill(&mut s, parameters, a, b);
        Ok(Linearization { bound })
    }
}
