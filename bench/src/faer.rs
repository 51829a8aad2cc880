//! faer's factorization as a peer, on one thread and on two: alone beside LAPACK's, and in evaluations beside the own one. By the
//! clock on the wall, since two threads have no processor time in common: on a busy machine these values say little.

use crate::lapack::Lapack;
use crate::lapack::diagonal_dominant;
use crate::rows::{Held, Row, ellipses};
use crate::timing::{Measured, Turns};
use nekton::Factorization;
use nekton::scene::Quadrature;

fn turns() -> Turns {
    Turns { rounds: 11, ..Turns::WALL }
}

fn evaluation(order: usize, by: Factorization) -> Result<Measured, String> {
    let mut one = ellipses(2, 2, 1.0, order / 4, Quadrature::Plain);
    let mut other = ellipses(2, 2, 1.0, order / 4, Quadrature::Plain);
    one.factorize(by).map_err(|error| error.to_string())?;
    let (times, ratios) = turns().run(&mut [&mut || one.run(), &mut || other.run()]);
    Ok(Measured { time: times[0], by: times[1], ratio: ratios[0], note: String::new() })
}

fn alone(lapack: &Lapack, order: usize, by: Factorization) -> Result<Measured, String> {
    let ld = order + 8;
    let a = diagonal_dominant(order, ld);
    let (mut copy, mut pivots) = (a.clone(), vec![0u64; order]);
    nekton::lu::factor_with(by, &mut copy, ld, order, &mut pivots).map_err(|error| error.to_string())?;
    let (mut others_copy, mut others_pivots) = (a.clone(), vec![0; order]);
    let (times, ratios) = turns().run(&mut [
        &mut || {
            copy.copy_from_slice(&a);
            nekton::lu::factor_with(by, &mut copy, ld, order, &mut pivots).expect("far from singular");
        },
        &mut || {
            others_copy.copy_from_slice(&a);
            lapack.dgetrf(&mut others_copy, ld, order, &mut others_pivots);
        },
    ]);
    let note = format!("{:.1} GFlop/s", 2e-9 / 3.0 * (order as f64).powi(3) / times[0]);
    Ok(Measured { time: times[0], by: times[1], ratio: ratios[0], note })
}

/// The rows; none can be measured by a program that was built without the feature `faer`.
pub fn rows() -> Vec<Row> {
    let mut all = Vec::new();
    let nothing = f64::INFINITY;
    for (threads, alone_name, evaluation_name) in [
        (1, "factorization alone by faer / dgetrf(N)", "evaluation of 4 bodies by faer / by the own factorization"),
        (
            2,
            "factorization alone by faer on 2 threads / dgetrf(N) on one",
            "evaluation of 4 bodies by faer on 2 threads / by the own factorization",
        ),
    ] {
        let by = Factorization::Faer { threads };
        let mut row = |name, size, run| all.push(Row { name, size, must: nothing, aim: nothing, held: Held::No, run });
        for n in [512, 1024, 2048] {
            row(alone_name, n, Box::new(move |lapack: &Lapack| alone(lapack, n, by)));
        }
        for n in [512, 1024, 2048] {
            row(evaluation_name, n, Box::new(move |_: &Lapack| evaluation(n, by)));
        }
    }
    all
}
