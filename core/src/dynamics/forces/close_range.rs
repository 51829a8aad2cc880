//! Nodes for an integral over one outline seen from a point close to it.
//!
//! The integrand |z − γ(t)|^(−α) varies on the scale |Im t*| of the point's preimage t*, far below the spacing of the
//! outline's own nodes. A ladder centred at Re t* resolves it; its nodes depend on the scale alone, up to a shift, so they
//! are tabulated for the scales 3^(−q), of which the next finer one is taken.

use crate::base::complex::{Complex, cabs, complex};
use crate::base::memory::{part, put};
use crate::base::scalar::Real;
use crate::base::status::Result;
use crate::geometry::curve::Curve;
use crate::geometry::grading::{Grading, Ladder, grading_len, write_grading};

/// Nodes of a table on each side of the centre.
const SIDE: usize = 48;
/// Reals of a node: offset, its cosine and sine, weight dt.
const NODE: usize = 4;
/// Reals of one table.
const TABLE: usize = SIDE * NODE;

/// Number of scales: down to where neighbouring numbers end.
fn scales<R: Real>() -> usize {
    // 3^(−q) ≥ 2000 ε
    let most = -(R::EPSILON * R::lit(2000.0)).ln() / R::lit(3.0).ln();
    most.to_f64() as usize + 1
}

/// Reals of all tables.
pub(crate) fn tables_len<R: Real>() -> usize {
    scales::<R>() * TABLE
}

/// Reals of scratch to fill them.
pub(crate) fn scratch_len<R: Real>() -> Option<usize> {
    grading_len(scales::<R>() + 2)
}

/// Fills the tables.
///
/// # Errors
/// `MemoryTooSmall`, `Internal`.
pub(crate) fn fill_tables<R: Real>(tables: &mut [R], scratch: &mut [R]) -> Result<()> {
    let mut beta = R::one();
    for table in tables.chunks_exact_mut(TABLE) {
        let rungs = write_grading(core::iter::once(Ladder { t: R::zero(), beta, top: R::TWO }), scratch)?;
        let grading = Grading::read(scratch, rungs);
        let h = R::PI / R::count(SIDE);
        let mut t = R::zero();
        for k in 0..SIDE {
            // Between equispaced parameters, so that the two sides mirror each other.
            let s = (R::count(k) + R::HALF) * h;
            t = grading.inverse(s, t)?;
            let (sin, cos) = t.sin_cos();
            for (c, x) in [t, cos, sin, h / grading.jet(t)[1]].into_iter().enumerate() {
                put(table, k * NODE + c, x);
            }
        }
        beta /= R::lit(3.0);
    }
    Ok(())
}

/// Visits (point, |dγ|) of nodes around the parameter `t`, dense down to the scale `beta`.
pub(crate) fn each_node<R: Real>(
    curve: &Curve<'_, R>,
    tables: &[R],
    t: R,
    beta: R,
    mut visit: impl FnMut(Complex<R>, R),
) {
    let q = (-beta.ln() / R::lit(3.0).ln() + R::lit(0.99)).floor().max(R::zero()).min(R::count(scales::<R>() - 1));
    let table = part(tables, q.to_f64() as usize * TABLE, TABLE);
    let (sin, cos) = t.sin_cos();
    for &[v, c, s, weight] in table.as_chunks::<NODE>().0 {
        for (v, s) in [(v, s), (-v, -s)] {
            match curve {
                Curve::Ellipse(e) => {
                    let (c, s) = (cos * c - sin * s, sin * c + cos * s);
                    let speed = (e.a * e.a * s * s + e.b * e.b * c * c).sqrt();
                    visit(complex(e.a * c, e.b * s), speed * weight);
                }
                _ => {
                    let [x, d, _] = curve.jet_real(t + v);
                    visit(x, cabs(d) * weight);
                }
            }
        }
    }
}
