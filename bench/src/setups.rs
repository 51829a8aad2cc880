//! Set-up with automatic nodes, of outlines that take long: seconds, beside one factorization of the nodes that come out.

use crate::lapack::{Lapack, diagonal_dominant};
use crate::timing::{Measured, median, thread_seconds};
use nekton::scene::{Scene, Shape};
use nekton::{ModelBuf, Place};
use nekton_tests::{body, link};
use std::f64::consts::{PI, TAU};

/// Calls of which the median counts.
const CALLS: usize = 3;

/// An outline by its kind and the number of its points.
#[derive(Clone, Copy)]
pub enum Kind {
    /// NACA 0012 with a sharp tail.
    Section,
    /// A smooth outline without corners.
    Blob,
    /// Trapezoidal teeth of ten points.
    Gear,
    /// A star of five points with straight sides.
    Star,
    /// A polygon.
    Polygon,
}

impl Kind {
    fn points(self, n: usize) -> Vec<[f64; 2]> {
        let polar = |k: usize, r: f64| {
            let t = TAU * k as f64 / n as f64;
            [r * t.cos(), r * t.sin()]
        };
        match self {
            Kind::Section => {
                let half = (n - 1) / 2;
                let x = |k: usize| 0.5 + 0.5 * (PI * k as f64 / half as f64).cos();
                let y = |x: f64| 0.6 * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
                let below = (1..half).map(|k| [x(half - k), -y(x(half - k))]);
                (0..=half).map(|k| [x(k), y(x(k))]).chain(below).collect()
            }
            Kind::Blob | Kind::Polygon => (0..n)
                .map(|k| {
                    let t = TAU * k as f64 / n as f64;
                    polar(k, 1.0 + 0.2 * (3.0 * t).cos() + 0.05 * (7.0 * t).sin())
                })
                .collect(),
            Kind::Gear => {
                let height = |u: f64| (4.0 * u - 1.0).clamp(0.0, 1.0) - (4.0 * u - 3.0).max(0.0);
                (0..n).map(|k| polar(k, 1.0 + 0.15 * height((k % 10) as f64 / 10.0))).collect()
            }
            Kind::Star => {
                let side = n / 10;
                let tip = |k: usize| {
                    let (t, r) = (TAU * k as f64 / 10.0, if k.is_multiple_of(2) { 1.0 } else { 0.5 });
                    [r * t.cos(), r * t.sin()]
                };
                (0..10 * side)
                    .map(|i| {
                        let (a, b, t) = (tip(i / side), tip(i / side + 1), (i % side) as f64 / side as f64);
                        [0, 1].map(|c| a[c] + (b[c] - a[c]) * t)
                    })
                    .collect()
            }
        }
    }
}

/// Seconds of the set-up of a lone body, and its ratio to one factorization.
pub fn set_up(lapack: &Lapack, kind: Kind, points: usize, wanted: f64) -> Result<Measured, String> {
    let points = kind.points(points);
    let shape = match kind {
        Kind::Polygon => Shape::Polygon { vertices: &points, radius: None },
        _ => Shape::curve(&points),
    };
    let links = [link(shape, 1.0, 0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let mut nodes = 0;
    let mut times = Vec::new();
    for _ in 0..CALLS {
        let start = thread_seconds();
        let model = ModelBuf::<f64>::new(&scene).map_err(|e| e.to_string())?;
        times.push(thread_seconds() - start);
        nodes = model.view().nodes(Place::Link(0, 0)).unwrap_or(0);
    }
    let ld = nodes + 8;
    let a = diagonal_dominant(nodes, ld);
    let mut pivots = vec![0; nodes];
    let mut others = Vec::new();
    for _ in 0..CALLS {
        let mut copy = a.clone();
        let start = thread_seconds();
        lapack.dgetrf(&mut copy, ld, nodes, &mut pivots);
        others.push(thread_seconds() - start);
    }
    let (time, by) = (median(times), median(others));
    Ok(Measured { time, by, ratio: time / by, note: format!("{nodes} nodes; wanted {wanted} s") })
}
