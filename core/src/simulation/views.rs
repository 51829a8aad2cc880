//! Vectors and matrices of a simulation as views of [nalgebra](crate::nalgebra), without a heap: of its own memory, or of the slice
//! that the caller gives. Those that are computed are what the functions without `_view` write (these say with which equation), in the
//! same order: rows and columns 3i, 3i + 1, 3i + 2 are x, y, θ of link i.
//!
//! A matrix of nalgebra that owns its numbers takes them directly, since both are stored column by column:
//! `sim.mass_matrix(matrix.as_mut_slice())`.
//!
//! Tested by `tests/views`.

use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::simulation::sim::Sim;
use nalgebra::{DMatrixView, DVectorView};

/// The square matrix that fills a slice, of as many rows as `n` says.
fn square<R: Real>(data: &[R], n: usize) -> DMatrixView<'_, R> {
    DMatrixView::from_slice(data, n, n)
}

fn vector<R: Real>(data: &[R]) -> DVectorView<'_, R> {
    DVectorView::from_slice(data, data.len())
}

/// Views of nalgebra. `buffer` must have the length that is named, and is written; its view outlives the call, so that several can be
/// used together.
impl<R: Real> Sim<'_, R> {
    /// x, y (m) and θ (rad) of every link's centre of mass (3 per link). O(1).
    pub fn positions_view(&self) -> DVectorView<'_, R> {
        vector(self.positions())
    }

    /// q̇: ẋ, ẏ (m/s) and θ̇ (rad/s) of every link (3 per link). O(1).
    pub fn velocities_view(&self) -> DVectorView<'_, R> {
        vector(self.velocities())
    }

    /// Mass matrix M of bodies and fluid, symmetric and positive definite: 3n × 3n for n links; kg, kg m, kg m² per m of depth.
    /// 3n solves. `buffer`: 9n².
    ///
    /// ```
    /// # use nekton::scene::{Body, Link, Mass, Root, Scene, Shape};
    /// # use nekton::{Method, ModelBuf, SimBuf};
    /// # let shape = Shape::Ellipse { a: 1.0, b: 0.4 };
    /// # let links = [Link { shape, mass: Mass::Density(1.2), nodes: 32, circulation: 0.0, joint: None }];
    /// # let body = Body { pose: [0.0; 3], velocity: [0.2, 0.1, 0.3], root: Root::Free, links: &links };
    /// # let bodies = [body, Body { pose: [3.0, 0.5, 0.3], ..body }];
    /// # let model = std::sync::Arc::new(ModelBuf::<f64>::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) })?);
    /// # let mut sim = SimBuf::new(model, Method::Rk4 { step: 0.01 })?;
    /// # let mut sim = sim.view();
    /// // A simulation of two bodies. Sizes that are known make matrices that need no heap.
    /// let mut buffer = [0.0_f64; 36];
    /// let mass = sim.mass_matrix_view(&mut buffer)?.fixed_view::<6, 6>(0, 0).clone_owned();
    /// let velocity = sim.velocities_view().fixed_rows::<6>(0).clone_owned();
    ///
    /// // The total momentum is the sum of both bodies' M q̇.
    /// let momentum = mass * velocity;
    /// let total = momentum.fixed_rows::<2>(0) + momentum.fixed_rows::<2>(3);
    /// let impulse = sim.impulse()?;
    /// assert!((total.x - impulse[0]).abs() < 1e-12 && (total.y - impulse[1]).abs() < 1e-12);
    ///
    /// // Symmetric and positive definite: it has a Cholesky factor, here for the motion that an impulse makes.
    /// assert_eq!(mass, mass.transpose());
    /// let motion = mass.cholesky().expect("positive definite").solve(&momentum);
    /// assert!((motion - velocity).norm() < 1e-12);
    /// # Ok::<(), nekton::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Sim::mass_matrix`]: `Length`, `Contact`, `Singular`, `NonFiniteState`.
    pub fn mass_matrix_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DMatrixView<'b, R>> {
        self.mass_matrix(buffer)?;
        Ok(square(buffer, self.rows()))
    }

    /// Symmetrized added mass M^f, the fluid's part of M, in its units. 3n solves. `buffer`: 9n².
    ///
    /// # Errors
    /// As [`Sim::added_mass`].
    pub fn added_mass_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DMatrixView<'b, R>> {
        self.added_mass(buffer)?;
        Ok(square(buffer, self.rows()))
    }

    /// The antisymmetric matrix G of the force +G q̇ that circulation makes (3n × 3n; N s/m, N s, N m s per m of depth). 6n solves.
    /// `buffer`: 9n².
    ///
    /// # Errors
    /// As [`Sim::gyroscopic`].
    pub fn gyroscopic_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DMatrixView<'b, R>> {
        self.gyroscopic(buffer)?;
        Ok(square(buffer, self.rows()))
    }

    /// q̈: m/s², rad/s² (3 per link). `buffer`: 3n.
    ///
    /// # Errors
    /// As [`Sim::accelerations`].
    pub fn accelerations_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DVectorView<'b, R>> {
        self.accelerations(buffer)?;
        Ok(vector(buffer))
    }

    /// Christoffel force ⟨Γ, q̇, q̇⟩: N, N m per m of depth (3 per link). O(N²) beside the evaluation. `buffer`: 3n.
    ///
    /// # Errors
    /// As [`Sim::christoffel`].
    pub fn christoffel_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DVectorView<'b, R>> {
        self.christoffel(buffer)?;
        Ok(vector(buffer))
    }

    /// ∂P/∂q of weight and buoyancy: N, N m per m of depth (3 per link). `buffer`: 3n.
    ///
    /// # Errors
    /// As [`Sim::buoyancy`].
    pub fn buoyancy_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DVectorView<'b, R>> {
        self.buoyancy(buffer)?;
        Ok(vector(buffer))
    }

    /// ∂V/∂q of repulsion: N, N m per m of depth (3 per link). `buffer`: 3n.
    ///
    /// # Errors
    /// As [`Sim::repulsion`].
    pub fn repulsion_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DVectorView<'b, R>> {
        self.repulsion(buffer)?;
        Ok(vector(buffer))
    }

    /// ∂T_c/∂q of the circulatory flow's energy: N, N m per m of depth (3 per link). `buffer`: 3n.
    ///
    /// # Errors
    /// As [`Sim::circulation_gradient`].
    pub fn circulation_gradient_view<'b>(&mut self, buffer: &'b mut [R]) -> Result<DVectorView<'b, R>> {
        self.circulation_gradient(buffer)?;
        Ok(vector(buffer))
    }
}
