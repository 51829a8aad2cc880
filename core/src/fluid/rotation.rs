//! χ₃, the interior potential of rotation for (2.6) at the nodes of a link: harmonic inside the outline, its normal derivative that of
//! the rotation about the frame's origin. Once, at set-up.
//!
//! Tested by the tests at its end, `fluid/assembly_test.rs:density_form_gives_the_potential_of_the_direct_formulation`, `tests/near_contact`.

use crate::base::complex::{Complex, cis, complex, dot};
use crate::base::features;
use crate::base::memory::{part_mut, put, take, take_as};
use crate::base::scalar::Real;
use crate::base::status::{Result, Status};
use crate::fluid::isolated;
use crate::fluid::near::pole;
use crate::fluid::near::preimage::Source;
use crate::fluid::self_block::{Block, add_flank_terms, fill_self_block};
use crate::geometry::curve::Curve;
use crate::geometry::nodes::{Nodes, write_nodes};
use crate::linear::lu::{Factors, factor};
use crate::model::boundary::{BoundaryRecord, Slots};

/// Fills χ₃ at the nodes: the function harmonic inside the outline with the normal derivative of the rotation about the
/// frame's origin. Closed form for an ellipse; otherwise one interior solve, (I − Im W/π + 1/M) χ = −Re W/π |X|²/2, on the
/// nodes or, where nodes will move, on twice as many, in `scratch`, of which the Fourier sum in s is kept. With the same factors
/// the isolated circulatory flow, where there is memory for it. O(M³) once.
pub(crate) fn fill_rotation_potential<R: Real>(
    record: &mut BoundaryRecord<R>,
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    let n = record.nodes;
    if !matches!(record.view(store).curve, Curve::Ellipse(_)) {
        let m = potential_nodes(&record.slots, n);
        let mut rest = scratch;
        let matrix = take(&mut rest, m * m + m)?;
        let regular = take(&mut rest, m * m)?;
        let pivots = take_as(&mut rest, m)?;
        let data = take(&mut rest, 7 * m)?;
        let table = take(&mut rest, if record.slots.table_len > 0 { 4 * m } else { 0 })?;
        if features::NEAR && !table.is_empty() {
            pole::fill_table(m, table);
        }
        let view = record.view(store);
        write_nodes(&view, record.origin, m, data)?;
        let nodes = Nodes::read(data, m);
        let (block, rhs) = matrix.split_at_mut_checked(m * m).ok_or(Status::Internal)?;
        let (mut a, mut g) = (Block { data: block, ld: m, at: 0 }, Block { data: &mut *regular, ld: m, at: 0 });
        let source = Source { record, nodes, view, table };
        fill_self_block(&nodes, R::one(), R::one() / R::count(m), &mut a, &mut g);
        add_flank_terms(&source, R::one(), &mut a, &mut g);
        rhs.fill(R::zero());
        for (column, x) in regular.chunks_exact(m.max(1)).zip(nodes.points()) {
            crate::base::memory::axpy(rhs, -dot(x, x) * R::HALF, column);
        }
        factor(matrix, m, m, pivots)?;
        let (block, chi) = matrix.split_at_mut_checked(m * m).ok_or(Status::Internal)?;
        let factors = Factors { lu: block, ld: m, pivots };
        factors.back_substitute(chi);
        if record.slots.core_modes > 0 {
            let sums = take(&mut rest, 2 * record.slots.core_modes)?;
            let core = isolated::tabulate(&source, &factors, regular, sums, rest)?;
            crate::base::memory::copy(part_mut(store, record.slots.core_at, sums.len()), sums);
            record.core = core;
        }
        if record.link.is_none() {
            return Ok(());
        }
        fourier_modes(chi, part_mut(store, record.slots.modes_at, record.slots.modes));
        if record.slots.modes == 0 {
            crate::base::memory::copy(part_mut(store, record.slots.data_at + 7 * n, n), chi);
            return Ok(());
        }
    }
    for k in 0..n {
        let column = |c: usize| crate::base::memory::at(store, record.slots.data_at + c * n + k);
        let chi = record
            .rotation_potential(store, complex(column(0), column(1)), || R::TAU * R::count(k) / R::count(n.max(1)));
        put(store, record.slots.data_at + 7 * n + k, chi);
    }
    Ok(())
}

/// Nodes on which χ₃ and the isolated flow are computed: as many as there are numbers kept of their Fourier sums, or the
/// boundary's own.
fn potential_nodes(slots: &Slots, nodes: usize) -> usize {
    match slots.modes.max(slots.core_modes) {
        0 => nodes,
        modes => modes - 2,
    }
}

/// Reals of scratch for χ₃ and the isolated flow of an outline without closed form.
pub(crate) fn potential_scratch(slots: &Slots, nodes: usize) -> Option<usize> {
    let m = potential_nodes(slots, nodes);
    let core = if slots.core_modes > 0 { slots.core_modes.checked_mul(2)?.checked_add(m.checked_mul(2)?)? } else { 0 };
    m.checked_mul(m)?.checked_mul(2)?.checked_add(m.checked_mul(13)?)?.checked_add(core)
}

/// Reals that the Fourier sum of χ₃ on 2·`nodes` points takes.
pub(crate) fn modes_len(nodes: usize) -> Option<usize> {
    nodes.checked_mul(2)?.checked_add(2)
}

/// Reals of each Fourier sum of the isolated flow: on 2·`nodes` points where nodes move, else on the nodes.
pub(crate) fn core_len(graded: bool, nodes: usize) -> Option<usize> {
    if graded { modes_len(nodes) } else { nodes.checked_add(2) }
}

/// Pairs (a_m, b_m), m = 0 … M/2, of M equispaced samples. O(M²).
pub(crate) fn fourier_modes<R: Real>(samples: &[R], modes: &mut [R]) {
    let count = R::count(samples.len().max(1));
    let half = samples.len() / 2;
    for (m, pair) in modes.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let turn = cis(R::TAU * R::count(m) / count);
        let (mut power, mut sum) = (complex(R::one(), R::zero()), Complex::<R>::default());
        for (k, f) in samples.iter().enumerate() {
            // The power is refreshed so that rounding does not pile up.
            if k % 16 == 0 {
                power = cis(R::TAU * R::count(m * k % samples.len().max(1)) / count);
            }
            sum += power * *f;
            power *= turn;
        }
        let scale = if m == 0 || m == half { R::one() } else { R::TWO } / count;
        *pair = [sum.re * scale, sum.im * scale];
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;
    use std::vec::Vec;

    #[test]
    fn fourier_sums_take_the_samples_they_are_made_of() {
        for count in [2, 8, 40] {
            let samples: Vec<f64> = (0..count).map(|k| 0.7 + ((3 * k * k) as f64).sin()).collect();
            let mut modes = vec![f64::NAN; count + 2];
            fourier_modes(&samples, &mut modes);
            for (k, sample) in samples.iter().enumerate() {
                let s = f64::TAU * k as f64 / count as f64;
                let terms = modes.chunks(2).enumerate().map(|(m, ab)| {
                    let (sin, cos) = (m as f64 * s).sin_cos();
                    ab[0] * cos + ab[1] * sin
                });
                let sum: f64 = terms.sum();
                assert!((sum - sample).abs() < 1e-13, "{count}, {k}: {sum} instead of {sample}");
            }
        }
    }
}
