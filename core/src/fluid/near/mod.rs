//! What boundaries that come close to each other (or to themselves) need beyond fixed nodes and the trapezoidal rule:
//! ladders at closest points and at tips and corners ([`ladders`]) → nodes of this configuration ([`regrade`]) → complex
//! preimages of nodes on the other boundaries ([`preimage`]) → the closed-form pole term of the quadrature ([`pole`]).
//!
//! All of it lives in a simulation's memory, in four buffers; a scene that is plain, or has one boundary, has none.

pub(crate) mod buffers;
mod ellipse;
pub(crate) mod ladders;
pub(crate) mod pole;
pub(crate) mod preimage;
pub(crate) mod regrade;
mod search;

use crate::base::features;
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::geometry::pose::Poses;
use crate::model::Model;

use buffers::{LadderLists, NearMut};

once! {
    /// Places ladders and nodes for this configuration and finds every preimage that needs a pole term.
    ///
    /// # Errors
    /// `Internal` if a node could not be placed to rounding.
    pub(crate) fn prepare['a, 'b: 'a](near: &'a mut NearMut<'b, R>, model: &'a Model<'b, R>, poses: Poses<'a, R>) -> Result<()> {
        if !features::NEAR || near.ladders.is_empty() {
            return Ok(());
        }
        ladders::place(model, poses, &mut LadderLists { lists: near.lists, ladders: near.ladders });
        regrade::regrade(model, near)?;
        preimage::find_all(model, poses, near);
        Ok(())
    }
}
