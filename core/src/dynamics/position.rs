//! The part of an evaluation that depends on the position: coordinates, placements, nodes of this configuration, motions to solve for.
//!
//! Tested by `tests/driving`, `tests/articulated`, `tests/walls`.

use crate::base::memory::part_mut;
use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::dynamics::articulation::{jacobian_column, place_links, set_coordinates, velocities};
use crate::dynamics::evaluation::Evaluation;
use crate::fluid::contact::first_contact;
use crate::fluid::near;
use crate::geometry::pose::{Poses, put_pose};
use crate::model::signal::Moment;
use crate::model::{Control, Model};

impl<R: Real> Evaluation<'_, R> {
    /// Places everything at (t, p), without any check: coordinates, q, poses.
    pub(crate) fn place_only(&mut self, model: &Model<'_, R>, t: R, p: &[R], dp: &[R]) {
        self.kept.shown = false;
        let (c, at_time) = (&mut self.coordinates, Moment { t, after: !self.kept.before });
        set_coordinates(model, at_time, p, dp, c.channels, c.s, c.ds, c.dds);
        place_links(model, c.s, self.placement.q, self.placement.poses);
    }

    /// Places everything at (t, p, ṗ): coordinates, poses, velocities. Refuses contact and non-finite states.
    pub(crate) fn place(&mut self, model: &Model<'_, R>, t: R, p: &[R], dp: &[R]) -> Result<()> {
        self.place_only(model, t, p, dp);
        let (q, poses, qd) = (&*self.placement.q, &*self.placement.poses, &mut *self.velocity.qd);
        velocities(model, self.coordinates.s, self.coordinates.ds, poses, qd);
        if !q.iter().chain(qd.iter()).all(|x| x.is_finite()) {
            return Err(Status::NonFiniteState.into());
        }
        match first_contact(model, Poses(poses)) {
            Some((a, b, gap)) => Err(Error::new(Status::Contact).at(a).with(b).of("gap", gap.to_f64())),
            None => Ok(()),
        }
    }

    /// Ladders, nodes and preimages where the scene was placed last.
    pub(crate) fn grade(&mut self, model: &Model<'_, R>) -> Result<()> {
        let (mut near, poses) = self.placement.near(self.system.unknowns);
        near::prepare(&mut near, model, poses)
    }

    /// Writes the walls' poses, once.
    pub(crate) fn place_walls(&mut self, model: &Model<'_, R>) {
        for (i, b) in model.boundaries.iter().enumerate().filter(|(_, b)| b.link.is_none()) {
            put_pose(self.placement.poses, i, &b.pose);
        }
    }

    /// Jacobian columns of the free coordinates and, if prescribed coordinates move, the motion they alone make.
    pub(crate) fn fill_jacobian(&mut self, model: &Model<'_, R>) {
        let rows = 3 * model.links.len();
        let (s, poses) = (&*self.coordinates.s, &*self.placement.poses);
        let (unit, jacobian) = (&mut *self.scratch.unit, &mut *self.columns.jacobian);
        for (i, c) in model.coordinates.iter().enumerate().filter(|(_, c)| c.control != Control::Prescribed) {
            jacobian_column(model, i, s, poses, unit, part_mut(jacobian, c.free * rows, rows));
        }
        if model.head.prescribed_moves {
            for ((u, ds), c) in unit.iter_mut().zip(self.coordinates.ds.iter()).zip(model.coordinates) {
                *u = if c.control == Control::Prescribed { *ds } else { R::zero() };
            }
            let at = model.head.plan.free_coordinates * rows;
            velocities(model, s, unit, poses, part_mut(jacobian, at, rows));
        }
    }
}
