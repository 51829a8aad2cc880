//! The regulator of examples-c/lqr.c, every operation in its order.

use super::{Lines, ellipse, of};
use crate::{body, hinged, simulation};
use nekton::scene::{Drive, Signal};
use nekton::status::Result;
use nekton::{Method, Parameter, Sim};

const ACROSS: [usize; 5] = [2, 3, 5, 6, 7];
const STATE: usize = 9;
const SAMPLE: f64 = 0.02;

type Square = [[f64; 5]; 5];

fn discretize(a: &Square, b: &[f64; 5]) -> (Square, [f64; 5]) {
    let mut term = [[0.0; 6]; 5];
    let (mut f, mut g) = ([[0.0; 5]; 5], [0.0; 5]);
    for i in 0..5 {
        for j in 0..5 {
            term[i][j] = a[i][j] * SAMPLE;
            f[i][j] = term[i][j];
        }
        term[i][5] = b[i] * SAMPLE;
        g[i] = term[i][5];
        f[i][i] += 1.0;
    }
    for m in 2..12 {
        let mut next = [[0.0; 6]; 5];
        for i in 0..5 {
            for j in 0..6 {
                let sum = (0..5).fold(0.0, |sum, k| sum + a[i][k] * term[k][j]);
                next[i][j] = sum * SAMPLE / f64::from(m);
            }
        }
        term = next;
        for i in 0..5 {
            for j in 0..5 {
                f[i][j] += term[i][j];
            }
            g[i] += term[i][5];
        }
    }
    (f, g)
}

fn regulator(f: &Square, g: &[f64; 5]) -> [f64; 5] {
    let (q, r) = ([1.0, 0.1, 0.0, 0.0, 0.0], 1.0);
    let (mut p, mut k) = ([[0.0; 5]; 5], [0.0; 5]);
    for i in 0..5 {
        p[i][i] = q[i];
    }
    for _ in 0..3000 {
        let pg: [f64; 5] = std::array::from_fn(|i| (0..5).fold(0.0, |sum, j| sum + p[i][j] * g[j]));
        let s = (0..5).fold(r, |s, i| s + g[i] * pg[i]);
        k = std::array::from_fn(|j| (0..5).fold(0.0, |sum, i| sum + pg[i] * f[i][j]) / s);
        let closed: Square = std::array::from_fn(|i| std::array::from_fn(|j| f[i][j] - g[i] * k[j]));
        let pf: Square =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..5).fold(0.0, |sum, m| sum + p[i][m] * closed[m][j])));
        p = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let first = r * k[i] * k[j] + if i == j { q[i] } else { 0.0 };
                (0..5).fold(first, |sum, m| sum + closed[m][i] * pf[m][j])
            })
        });
    }
    k
}

fn gains(sim: &mut Sim<'_, f64>) -> Result<[f64; 5]> {
    let mut memory = vec![0.0; Sim::derivative_requirement(&sim.model())?];
    let (mut a, mut b) = ([0.0; STATE * STATE], [0.0; STATE]);
    sim.linearize([Parameter::Torque(0)], &mut a, &mut b, &mut memory)?;
    let (f, g) = discretize(&ACROSS.map(|i| ACROSS.map(|j| a[i + STATE * j])), &ACROSS.map(|i| b[i]));
    Ok(regulator(&f, &g))
}

fn run(sim: &mut Sim<'_, f64>, k: [f64; 5]) -> Result<[f64; 2]> {
    let (mut largest, mut last) = (0.0, 0.0);
    for i in 0..500 {
        let feedback = ACROSS.iter().zip(k).fold(0.0, |u, (i, k)| u - k * sim.state()[*i]);
        let torque = if i < 10 { 0.5 } else { feedback };
        let [from, to] = [i, i + 1].map(|i| [SAMPLE * f64::from(i), torque, 0.0, 0.0]);
        sim.set_channel(0, from, to)?;
        sim.advance(to[0])?;
        last = sim.state()[2].abs();
        if last > largest {
            largest = last;
        }
    }
    Ok([largest, last])
}

pub(super) fn lines() -> Result<Lines> {
    let tail = Drive::Torque { torque: Signal::Channel, stiffness: 2.0, damping: 0.5, rest: 0.0, start: [0.0; 2] };
    let links = [ellipse(1.0, 0.3, 1.0, 48), hinged(ellipse(0.5, 0.1, 1.0, 64), 0, [-1.1, 0.0], [0.6, 0.0], tail)];
    let bodies = [body(&links, [0.0; 3], [1.0, 0.0, 0.0])];
    let start = || simulation(&of(&bodies), Method::Rk4 { step: SAMPLE });
    let k = gains(&mut start().view())?;
    let (free, held) = (run(&mut start().view(), [0.0; 5])?, run(&mut start().view(), k)?);
    // What the example is about.
    assert!(free[1] > 0.5 && held[1] < 1e-3, "the swimmer does not hold its heading: {free:?}, {held:?}");
    Ok(vec![k.to_vec(), free.to_vec(), held.to_vec()])
}
