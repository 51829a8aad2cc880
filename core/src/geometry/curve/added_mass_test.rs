//! The outlines and their nodes, judged by the added mass that they lead to: a Nyström solution of the double layer.

#![allow(clippy::indexing_slicing)]
extern crate std;
use super::tests::compile;
use super::*;
use crate::scene::Shape;
use std::vec;
use std::vec::Vec;

fn solve(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for k in 0..n {
        let p = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap();
        a.swap(k, p);
        let pivot = a[k].clone();
        for row in a.iter_mut().skip(k + 1) {
            let f = row[k] / pivot[k];
            for j in k..=n {
                row[j] -= f * pivot[j];
            }
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        x[k] = (a[k][n] - (k + 1..n).map(|j| a[k][j] * x[j]).sum::<f64>()) / a[k][k];
    }
    x
}

/// Added mass of translation along `direction` at fluid density 1, from n nodes.
fn added_mass(view: &OutlineView<'_, f64>, n: usize, direction: Complex<f64>) -> f64 {
    let h = f64::TAU / n as f64;
    let nodes: Vec<_> = (0..n).map(|k| view.node(k, n).unwrap()).collect();
    // Stream function of the translation, and (I - Im G) psi = -Re(G) chi with G = -W/pi.
    let chi: Vec<_> = nodes.iter().map(|p| direction.im * p.x.re - direction.re * p.x.im).collect();
    let rows = (0..n).map(|i| {
        let mut row = vec![0.0; n + 1];
        for k in 0..n {
            let weight = if i == k {
                nodes[i].ddx / (nodes[i].dx * 2.0) * h
            } else {
                let half = h * (k as f64 - i as f64) * 0.5;
                let sign = if (k + n - i).is_multiple_of(2) { 1.0 } else { -1.0 };
                (nodes[k].dx / (nodes[k].x - nodes[i].x) - sign * 0.5 * half.cos() / half.sin()) * h
            };
            let g = -weight / f64::PI;
            row[k] = if i == k { 1.0 } else { 0.0 } - g.im;
            row[n] -= g.re * chi[k];
        }
        row
    });
    let psi = solve(rows.collect());
    // b ds = -d(chi), integrated against psi; positive for a body in fluid.
    nodes.iter().zip(psi).map(|(p, psi)| (direction.im * p.dx.re - direction.re * p.dx.im) * psi * h).sum()
}

const X: Complex<f64> = Complex { re: 1.0, im: 0.0 };

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} against {b}, difference {:e}", a - b);
}

#[test]
fn added_mass_of_ellipse_is_rho_pi_b2() {
    for (a, b) in [(1.0, 0.5), (0.3, 1.0)] {
        close(added_mass(&compile(Shape::Ellipse { a, b }).view(), 64, X), f64::PI * b * b, 1e-14);
    }
}

#[test]
fn added_mass_of_rounded_square_is_that_of_an_independent_computation() {
    // Filter widths of 1/2.37 of the radii named; side 2. The reference agrees with the closed form of the sharp
    // square, 4.753758460905903, up to the effect of rounding.
    let factor = (f64::PI / 8.0).tan() / (f64::PI / 4.0).cos() / (2.0 * core::f64::consts::LN_2 * 1.107);
    for (part, mass, n) in
        [(1e-2, 4.7389860256, 128), (1e-3, 4.7530557934, 192), (1e-4, 4.7537256755, 240), (1e-6, 4.7537583902, 320)]
    {
        let radius = Some(2.0 * part / 2.37 / factor);
        let square = compile(Shape::Rectangle { width: 2.0, height: 2.0, radius });
        for direction in [X, complex(0.6, 0.8)] {
            close(added_mass(&square.view(), n, direction), mass, 3e-10);
        }
    }
}

#[test]
fn added_mass_of_cornered_bodies_converges() {
    let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    // A thinner wedge needs the opposite flank's correction, which is no matter of the outline.
    let (s, c) = (f64::PI / 12.0).sin_cos();
    let wedge = [[0.0, 0.0], [c, -s], [c, s]];
    for (vertices, radius) in [(&l[..], 0.02), (&wedge, 1e-2)] {
        let outline = compile(Shape::Polygon { vertices, radius: Some(radius) });
        let direction = complex(0.8, 0.6);
        let (coarse, fine) = (added_mass(&outline.view(), 160, direction), added_mass(&outline.view(), 320, direction));
        close(coarse, fine, 1e-9);
    }
}

#[test]
fn added_mass_of_curve_through_points_converges_with_three_nodes_per_point() {
    let points: Vec<_> = (0..24)
        .map(|k| {
            let t = f64::TAU * k as f64 / 24.0;
            let r = 1.0 + 0.2 * (2.0 * t).cos() + 0.1 * (3.0 * t).sin();
            [r * t.cos(), r * t.sin()]
        })
        .collect();
    let outline = compile(Shape::curve(&points));
    close(added_mass(&outline.view(), 72, X), added_mass(&outline.view(), 200, X), 2e-14);
}

#[test]
fn permanent_ladders_at_bends_pay() {
    let points: Vec<_> = (0..48)
        .map(|k| {
            let t = f64::TAU * k as f64 / 48.0;
            let r = 1.0 + 0.3 * (5.0 * t).cos();
            [r * t.cos(), r * t.sin()]
        })
        .collect();
    let outline = compile(Shape::curve(&points));
    let view = outline.view();
    let plain = OutlineView { curve: view.curve, grading: Grading::uniform() };
    let exact = added_mass(&view, 400, X);
    let (with, without) = (added_mass(&view, 160, X) - exact, added_mass(&plain, 160, X) - exact);
    assert!(with.abs() < 1e-9 && without.abs() > 1e-9, "{with:e} {without:e}");
}
