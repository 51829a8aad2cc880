//! What a scene requires to be modelled: what is absent here costs nothing later.

use crate::base::features;
use crate::base::scalar::Real;
use crate::model::Formulation;
use crate::scene::{Description, Drive, Quadrature, Root, each_link, wall_count};
use crate::setup::items::items;

/// What a scene requires.
#[derive(Clone, Copy)]
pub(crate) struct Traits {
    pub(crate) fluid: bool,
    pub(crate) circulation: bool,
    pub(crate) formulation: Formulation,
    /// Nodes follow the configuration.
    pub(crate) graded: bool,
    /// Pole terms are used: also by a lone thin body.
    pub(crate) tables: bool,
    pub(crate) repels: bool,
}

impl Traits {
    pub(crate) fn of<R: Real, S: Description<R>>(scene: &S) -> Traits {
        let settings = scene.settings();
        let fluid = settings.fluid_density > R::zero();
        let circulation = fluid && items(scene).any(|i| i.circulation != R::zero());
        let lone = settings.shortcuts && scene.body_count() == 1 && wall_count(scene) == 0;
        let free_root =
            (0..scene.body_count()).all(|b| scene.body(b).is_some_and(|body| matches!(body.root, Root::Free)));
        let links = each_link(scene).count();
        let given_joints =
            each_link(scene).all(|(_, _, l)| l.joint.is_none_or(|j| !matches!(j.drive, Drive::Torque { .. })));
        let formulation = if lone && free_root && links == 1 && fluid {
            Formulation::Kirchhoff
        } else if lone && free_root && links > 1 && given_joints && settings.gravity == R::zero() && !circulation {
            Formulation::LockedMomentum
        } else {
            Formulation::Velocity
        };
        let repels = settings.repulsion.is_some_and(|r| r.epsilon != R::zero());
        let tables = features::NEAR && settings.quadrature == Quadrature::Graded && (fluid || repels);
        let graded = tables && wall_count(scene) + links > 1;
        Traits { fluid, circulation, formulation, graded, tables, repels }
    }
}
