//! Derivatives of the force of circulation, ∂T_c/∂q − G q̇: by velocity exactly, −G; by position in closed form for a lone body, else
//! by central differences of fourth order, an evaluation for each: the only term that is not differentiated exactly.
//!
//! Tested by `tests/derivatives`.

use crate::base::complex::{complex, perp};
use crate::base::memory::{add, at, axpy, part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::dynamics::evaluation::{Counters, Evaluation};
use crate::fluid::configuration::Configuration;
use crate::fluid::potentials::{fill_flux, to_link_frames};
use crate::geometry::pose::{Pose, put_pose, twist_of};
use crate::model::Model;

/// Steps of the differences in units of the step, and their weights.
const STENCIL: [(f64, f64); 4] = [(1.0, 2.0 / 3.0), (-1.0, -2.0 / 3.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0)];
/// The step over the reach of the link: the error, about its fourth power, is that of rounding.
const STEP: f64 = 1e-3;
/// The step over the gap, at most.
const SHARE: f64 = 0.02;

/// Adds those of a lone body: −ρ (γ J ṙ − J p ω, ṙ × p) with the impulse p of its circulation, which turns with it.
pub(crate) fn add_lone<R: Real>(c: &Configuration<'_, R>, qd: &[R], position: &mut [R], velocity: &mut [R]) {
    let Some((body, _)) = c.boundary(0).filter(|_| c.model.head.gyroscopic) else { return };
    let [px, py, _] = c.model.head.lone_impulse;
    let (density, v) = (c.model.head.fluid_density, twist_of(qd, 0));
    let (p, strength) = (c.pose(0).turned(complex(px, py)) * density, body.circulation * density);
    let turned = perp(p);
    for (entry, value) in [(1, -strength), (2, p.im), (3, strength), (5, -p.re), (6, turned.re), (7, turned.im)] {
        add(velocity, entry, value);
    }
    let along = v.linear.re * p.re + v.linear.im * p.im;
    for (entry, value) in [(6, -p.re * v.angular), (7, -p.im * v.angular), (8, along)] {
        add(position, entry, value);
    }
}

impl<R: Real> Evaluation<'_, R> {
    /// Adds those of the state evaluated last. `gap`: the smallest one. 12n + 1 evaluations of the fluid for n links and as many solves; what
    /// the arrays held is lost.
    ///
    /// # Errors
    /// As an evaluation.
    pub(crate) fn add_circulation_derivatives(
        &mut self,
        model: &Model<'_, R>,
        gap: R,
        position: &mut [R],
        velocity: &mut [R],
    ) -> Result<()> {
        self.kept.shown = false;
        let (rows, walls) = (3 * model.links.len(), model.head.plan.walls);
        for (k, column) in position.chunks_exact_mut(rows.max(1)).enumerate() {
            let (link, angle) = (k / 3, k % 3 == 2);
            let reach = model.boundaries.get(walls + link).map_or(R::one(), |b| b.reach);
            let length = (reach * R::lit(STEP)).min(gap * R::lit(SHARE));
            let step = if angle { length / reach } else { length };
            let here = at(self.placement.q, k);
            for (shift, weight) in STENCIL {
                self.put_link(walls, link, k, here + step * R::lit(shift));
                self.circulate(model)?;
                axpy(column, R::lit(weight) / step, self.forces.outer);
            }
            self.put_link(walls, link, k, here);
        }
        if model.head.gyroscopic {
            self.circulate(model)?;
            for (k, column) in velocity.chunks_exact_mut(rows.max(1)).enumerate() {
                self.gyroscopic_column(model, k);
                axpy(column, R::one(), self.forces.force);
            }
        }
        Ok(())
    }

    /// Puts one coordinate of a link.
    fn put_link(&mut self, walls: usize, link: usize, k: usize, value: R) {
        let placement = &mut self.placement;
        put(placement.q, k, value);
        if let &mut [x, y, theta] = part_mut(placement.q, 3 * link, 3) {
            put_pose(placement.poses, walls + link, &Pose::new(x, y, theta));
        }
    }

    /// The force of circulation where the links are, into `outer`.
    fn circulate(&mut self, model: &Model<'_, R>) -> Result<()> {
        self.grade(model)?;
        self.solve_fluid(model, &mut Counters::default())?;
        let (c, motion) = (&self.placement.configuration(model), &mut self.velocity);
        to_link_frames(c, motion.qd, motion.in_links);
        fill_flux(c, motion.in_links, motion.adjoint);
        self.system.factors().solve_transposed(motion.adjoint);
        self.forces.outer.fill(R::zero());
        self.add_circulation(model);
        Ok(())
    }
}
