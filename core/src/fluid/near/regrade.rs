//! Nodes of the present configuration on the boundaries that carry ladders.
//!
//! Tested by `tests/regrading`, `tests/near_contact`.

use crate::base::index::Index;
use crate::base::memory::{part_mut, put};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::fluid::near::buffers::{COLUMNS, LISTS, NearMut, listed};
use crate::geometry::curve::OutlineView;
use crate::geometry::grading::{Grading, Ladder, write_fitting};
use crate::geometry::nodes::write_nodes;
use crate::model::Model;
use crate::model::boundary::BoundaryRecord;

/// Rewrites grading and nodes of every boundary with ladders; the others keep the model's.
///
/// # Errors
/// `Internal` if a node could not be placed to rounding.
pub(crate) fn regrade<R: Real>(model: &Model<'_, R>, near: &mut NearMut<'_, R>) -> Result<()> {
    for (i, b) in model.boundaries.iter().enumerate() {
        let Some(finest) = listed(near.lists, near.ladders, i).next() else { continue };
        // Repulsion is steeper than what the flow needs resolved.
        let flow = need(b, b.view(model.store).grading.plain(), finest.beta);
        let need = if model.head.repulsion.is_some() { R::one() } else { flow };
        if need <= R::zero() {
            continue;
        }
        let rungs = part_mut(near.rungs, b.slots.rungs_at, b.slots.rungs_len);
        // With no need left the top comes down to the scale itself, and the rungs fade.
        let faded = |l: Ladder<R>| Ladder { top: l.beta * (l.top / l.beta).powf(need), ..l };
        let ladders = b.ladders(model.store).chain(listed(near.lists, near.ladders, i).map(faded));
        let (count, _) = write_fitting(ladders, rungs)?;
        let view = OutlineView { grading: Grading::read(rungs, count), ..b.view(model.store) };
        let nodes = part_mut(near.nodes, COLUMNS * b.first, COLUMNS * b.nodes);
        write_nodes(&view, b.origin, b.nodes, nodes).map_err(|e| e.at(b.place))?;
        if b.link.is_some() {
            fill_potential(b, model.store, nodes);
        }
        if let Some(rungs) = near.lists.get_mut(i * LISTS + 1) {
            *rungs = R::Index::of(count + 1);
        }
    }
    Ok(())
}

/// How much a boundary needs ladders of which the finest has the scale `beta`: 1 where its own nodes do not resolve that, 0 where
/// they do to rounding (an error like e^(−N β)), continuous in between.
fn need<R: Real>(b: &BoundaryRecord<R>, plain: R, beta: R) -> R {
    let resolved = R::count(b.nodes) * plain * beta / (-R::EPSILON.ln() * R::lit(1.25));
    ((R::one() - resolved) * R::lit(5.0)).max(R::zero()).min(R::one())
}

/// The interior potential of rotation at the nodes.
fn fill_potential<R: Real>(b: &BoundaryRecord<R>, store: &[R], nodes: &mut [R]) {
    let n = b.nodes;
    let own = b.view(store).grading;
    for k in 0..n {
        let column = |c: usize| crate::base::memory::at(nodes, c * n + k);
        let (x, y, t) = (column(0), column(1), column(4));
        let chi = b.rotation_potential(store, crate::base::complex::complex(x, y), || own.jet(t)[0]);
        put(nodes, 7 * n + k, chi);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ladders_are_whole_where_rounding_would_not_hide_the_error_and_gone_where_it_does() {
        let record = BoundaryRecord::<f64> { nodes: 64, ..Default::default() };
        // Of the nodes' own error e^(−N β), with β in the plain parameter.
        let of = |error: f64, plain: f64| need(&record, plain, -error.ln() / (64.0 * plain));
        for plain in [1.0, 0.4] {
            for (power, exact) in
                [(0.1, 1.0), (0.9, 1.0), (1.0, 1.0), (1.125, 0.5), (1.25, 0.0), (2.0, 0.0), (9.0, 0.0)]
            {
                let found = of(f64::EPSILON.powf(power), plain);
                assert!((found - exact).abs() < 1e-14, "{power}: {found}");
            }
        }
    }
}
