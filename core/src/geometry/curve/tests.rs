#![allow(clippy::indexing_slicing)]
extern crate std;
use super::*;
use crate::base::complex::cis;
use crate::base::status::{Error, Status};
use crate::scene::Shape;
use std::vec::Vec;
use std::{format, vec};

pub(super) struct Compiled<R> {
    outline: Outline<R>,
    store: Vec<R>,
    status: Status,
}

impl<R: Real> Compiled<R> {
    pub(super) fn view(&self) -> OutlineView<'_, R> {
        self.outline.view(&self.store)
    }
}

pub(super) fn try_compile<R: Real>(shape: Shape<'_, R>) -> Result<Compiled<R>> {
    let mut store = vec![R::NAN; shape.store_len()?];
    let mut scratch = vec![R::NAN; shape.scratch_len()?];
    let (outline, status) = shape.compile(&mut store, &mut scratch)?;
    Ok(Compiled { outline, store, status })
}

pub(super) fn compile<R: Real>(shape: Shape<'_, R>) -> Compiled<R> {
    try_compile(shape).unwrap_or_else(|e| panic!("{shape:?}: {e}"))
}

fn refused<R: Real>(shape: Shape<'_, R>) -> Error {
    try_compile(shape).err().unwrap_or_else(|| panic!("{shape:?} was accepted"))
}

const L_SHAPE: [[f64; 2]; 6] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
/// 8 degrees at the first corner.
const WEDGE: [[f64; 2]; 3] = [[0.0, 0.0], [2.0, -0.13985362388702103], [2.0, 0.13985362388702103]];

fn blob(n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|k| {
            let t = (k as f64 + 0.2 * (k as f64 * 1.7).sin()) * f64::TAU / n as f64;
            let r = 1.0 + 0.2 * (2.0 * t).cos() + 0.1 * (3.0 * t).sin();
            [0.3 + r * t.cos(), -0.2 + r * t.sin()]
        })
        .collect()
}

/// One of every kind.
fn zoo(points: &[[f64; 2]]) -> Vec<Shape<'_, f64>> {
    vec![
        Shape::Ellipse { a: 1.0, b: 0.3 },
        Shape::Ellipse { a: 0.01, b: 1.0 },
        Shape::Star { radius: 1.0, amplitude: 0.3, lobes: 5 },
        Shape::Rectangle { width: 2.0, height: 0.2, radius: Some(0.02) },
        Shape::Rectangle { width: 1.0, height: 1.0, radius: Some(0.4) },
        Shape::Rectangle { width: 1.0, height: 1.0, radius: None },
        Shape::Polygon { vertices: &L_SHAPE, radius: Some(0.05) },
        Shape::Polygon { vertices: &WEDGE, radius: Some(1e-3) },
        Shape::curve(points),
    ]
}

fn close(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a} against {b}, difference {:e}", a - b);
}

/// Taylor coefficients by a mean over a small circle of complex parameters.
fn cauchy(f: impl Fn(Complex<f64>) -> Complex<f64>, radius: f64) -> [Complex<f64>; 3] {
    let n = 32;
    let mut sums = [Complex::default(); 3];
    for k in 0..n {
        let z = cis(f64::TAU * (k as f64 + 0.5) / n as f64);
        let x = f(z * radius) / n as f64;
        sums[0] += x;
        sums[1] += x / z / radius;
        sums[2] += x / (z * z) / (radius * radius) * 2.0;
    }
    sums
}

#[test]
fn derivatives_match_cauchys_formula() {
    let points = blob(24);
    for shape in zoo(&points) {
        let c = compile(shape);
        let view = c.view();
        for k in 0..97 {
            let node = view.node(k, 97).unwrap();
            let t = node.t;
            // A fraction of the local scale, well inside the strip of analyticity.
            let scale = 0.02 / view.grading.jet(t)[1].max(1.0);
            let real = view.curve.jet_real(t);
            let same = view.curve.jet(complex(t, 0.0));
            let means = cauchy(|u| view.curve.jet(u + t)[0], scale);
            let rates = cauchy(|u| view.curve.jet(u + t)[1], scale);
            let shift = cauchy(|u| view.curve.change(t, u)[0], scale);
            let speed = cabs(real[1]);
            let what = format!("{shape:?} at {t}");
            for i in 0..3 {
                close(cabs(same[i] - real[i]), 0.0, 1e-13 * (cabs(real[i]) + speed), &what);
            }
            close(cabs(means[0] - real[0]), 0.0, 1e-14, &what);
            close(cabs(means[1] - real[1]), 0.0, 1e-13 * speed + 2e-15 / scale, &what);
            close(cabs(rates[1] - real[2]), 0.0, (1e-12 + 1e-15 / scale) * (cabs(real[2]) + speed / scale), &what);
            close(cabs(shift[0]), 0.0, 1e-13 * speed * scale, &what);
            close(cabs(shift[1] - real[1]), 0.0, 1e-12 * speed, &what);
        }
    }
}

#[test]
fn delta_matches_subtraction_at_large_offsets_and_the_tangent_at_small_ones() {
    let points = blob(24);
    for shape in zoo(&points) {
        let c = compile(shape);
        let view = c.view();
        for k in 0..61 {
            let t = view.node(k, 61).unwrap().t;
            let [x, d, dd] = view.curve.jet_real(t);
            for u in [-6.0, -3.2, -1.0, -0.1, -1e-3, 1e-3, 0.02, 0.7, 3.1, 5.0, 7.0] {
                let direct = view.curve.jet_real(t + u)[0] - x;
                close(
                    cabs(view.curve.change(t, complex(u, 0.0))[0] - direct),
                    0.0,
                    2e-14,
                    &format!("{shape:?} {t} {u}"),
                );
            }
            let scale = 1e-7 / view.grading.jet(t)[1];
            for turn in [0.0, 1.0, 2.5, 4.0] {
                let u = cis(turn) * scale;
                let expected = d * u + dd * u * u / 2.0;
                let got = view.curve.change(t, u)[0];
                close(cabs(got - expected), 0.0, 2e-12 * cabs(expected), &format!("{shape:?} {t} small"));
            }
        }
    }
}

#[test]
fn complex_delta_matches_subtraction() {
    let points = blob(24);
    for shape in zoo(&points) {
        let c = compile(shape);
        let view = c.view();
        for k in 0..61 {
            let t = view.node(k, 61).unwrap().t;
            for j in 0..61 {
                let t2 = view.node(j, 61).unwrap().t;
                let u = complex(t2 - t, 0.08 / view.grading.jet(t2)[1]);
                let direct = view.curve.jet(u + t)[0] - view.curve.jet_real(t)[0];
                close(cabs(view.curve.change(t, u)[0] - direct), 0.0, 5e-14, &format!("{shape:?} {t} {u}"));
            }
        }
    }
}

#[test]
fn ellipse_properties_are_the_closed_forms() {
    for (a, b, perimeter) in [(2.0, 2.0, 4.0 * f64::PI), (1.0, 0.5, 4.844224110273838), (1e-3, 1.0, 4.000015588104688)]
    {
        let p = compile(Shape::Ellipse { a, b }).view().properties().unwrap();
        close(p.area, f64::PI * a * b, 1e-15, "area");
        close(p.perimeter, perimeter, 1e-14, "perimeter");
        close(p.polar_moment, f64::PI * a * b * (a * a + b * b) / 4.0, 1e-14, "moment");
        close(p.reach, a.max(b), 0.0, "reach");
    }
}

#[test]
fn star_properties_are_the_closed_forms() {
    let (r, e) = (0.7, 0.3);
    let p = compile(Shape::Star { radius: r, amplitude: e, lobes: 5 }).view().properties().unwrap();
    close(p.area, f64::PI * r * r * (1.0 + e * e / 2.0), 1e-14, "area");
    close(cabs(p.centroid), 0.0, 1e-15, "centroid");
    // ∫ r⁴/4 dt with the mean of (1 + e cos)⁴ = 1 + 3 e² + 3 e⁴/8
    let mean = 1.0 + 3.0 * e * e + 0.375 * e * e * e * e;
    close(p.polar_moment, f64::PI / 2.0 * r * r * r * r * mean, 1e-14, "moment");
    close(p.reach, r * (1.0 + e), 1e-15, "reach");
}

#[test]
fn square_properties_approach_those_of_the_sharp_square() {
    for (radius, tolerance) in [(1e-2, 3e-4), (1e-4, 3e-8), (1e-6, 3e-12)] {
        let p =
            compile(Shape::Rectangle { width: 2.0, height: 2.0, radius: Some(radius) }).view().properties().unwrap();
        // A corner filtered with r cuts r² π²/6 off.
        let r = radius * (f64::PI / 8.0).tan() / (f64::PI / 4.0).cos() / (2.0 * core::f64::consts::LN_2 * 1.107);
        close(p.area, 4.0 - 4.0 * r * r * f64::PI * f64::PI / 6.0, 2e-14, "area");
        close(p.polar_moment, 8.0 / 3.0, 2.0 * tolerance, "moment");
        close(p.perimeter, 8.0, 8.0 * radius, "perimeter");
        close(p.reach, 2f64.sqrt(), radius, "reach");
        close(cabs(p.centroid), 0.0, 1e-14, "centroid");
        close(radius / r, 2.62, 5e-3, "radius over r");
    }
}

#[test]
fn properties_move_and_scale_with_the_vertices() {
    let at = |scale: f64, shift: Complex<f64>| {
        let vertices: Vec<_> = L_SHAPE.iter().map(|[x, y]| [x * scale + shift.re, y * scale + shift.im]).collect();
        compile(Shape::Polygon { vertices: &vertices, radius: Some(1e-3 * scale) }).view().properties().unwrap()
    };
    let (one, other) = (at(1.0, Complex::default()), at(3.0, complex(5.0, -7.0)));
    close(one.area, 3.0, 1e-5, "area");
    close(cabs(one.centroid - complex(5.0, 5.0) / 6.0), 0.0, 1e-5, "centroid");
    close(other.area, one.area * 9.0, 1e-12, "area");
    close(cabs(other.centroid - one.centroid * 3.0 - complex(5.0, -7.0)), 0.0, 1e-13, "centroid");
    close(other.polar_moment, one.polar_moment * 81.0, 1e-11, "moment");
    close(other.perimeter, one.perimeter * 3.0, 1e-13, "perimeter");
    close(other.reach, one.reach * 3.0, 1e-13, "reach");
}

#[test]
fn rectangle_measures_what_was_asked_for() {
    for (width, height, radius) in [(1.0, 1.0, 0.5), (3.0, 1.0, 0.4), (0.2, 2.0, 0.1), (1.0, 1.0, 0.01)] {
        let c = compile(Shape::Rectangle { width, height, radius: Some(radius) });
        let view = c.view();
        let (mut x, mut y) = (0.0, 0.0);
        for k in 0..4000 {
            let z = view.curve.jet_real(f64::TAU * k as f64 / 4000.0)[0];
            (x, y) = (f64::max(x, z.re), f64::max(y, z.im));
        }
        assert!(2.0 * x < width + 4e-16 && 2.0 * y < height + 4e-16);
        close(2.0 * x, width, 1e-6 * width, "width");
        close(2.0 * y, height, 1e-6 * height, "height");
    }
}

#[test]
fn sides_of_polygons_lie_inside_by_the_documented_depth() {
    for part in [0.5, 0.2, 0.1, 1.0 / 28.0] {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let c = compile(Shape::Polygon { vertices: &vertices, radius: Some(part) });
        let depth = c.view().curve.jet_real(f64::TAU / 8.0)[0].im;
        let expected = 0.76 * part * (-1.31 / part).exp().ln_1p();
        close(depth, expected, 0.05 * expected + 1e-17, "depth");
    }
}

#[test]
fn nodes_advance_and_meet_their_parameter() {
    let points = blob(24);
    for shape in zoo(&points) {
        let c = compile(shape);
        let view = c.view();
        let mut last = -1.0;
        for k in 0..160 {
            let node = view.node(k, 160).unwrap();
            let [s, slope, _] = view.grading.jet(node.t);
            close(s, f64::TAU * k as f64 / 160.0, 1e-14 + 1e-15 * slope, "residual");
            assert!(node.t > last && node.t < f64::TAU, "{shape:?}");
            last = node.t;
        }
        assert_eq!(view.node(160, 160).unwrap_err().status, Status::OutOfRange);
    }
}

#[test]
fn node_derivatives_match_differences_in_s() {
    let points = blob(24);
    for shape in zoo(&points) {
        let c = compile(shape);
        let view = c.view();
        let n = 1 << 14;
        let h = f64::TAU / n as f64;
        for k in (1..n).step_by(997) {
            let at = |k: usize| view.node(k, n).unwrap();
            let (a, b, c) = (at(k - 1), at(k), at(k + 1));
            let size = cabs(b.dx) + cabs(b.ddx) * 0.1;
            close(cabs((c.x - a.x) / (2.0 * h) - b.dx), 0.0, 1e-4 * size, &format!("{shape:?}"));
            close(cabs((c.dx - a.dx) / (2.0 * h) - b.ddx), 0.0, 1e-3 * (cabs(b.ddx) + size), &format!("{shape:?}"));
        }
    }
}

#[test]
fn curve_passes_through_its_points() {
    for n in [3, 4, 5, 8, 24, 60] {
        let points = blob(n);
        let c = compile(Shape::curve(&points));
        let view = c.view();
        let mut worst: f64 = 0.0;
        for (k, p) in points.iter().enumerate() {
            // Nearest parameter by Newton's method from a fine grid.
            let target = complex(p[0], p[1]);
            let distance = |t: f64| cabs(view.curve.jet_real(t)[0] - target);
            let grid = (0..3000).map(|i| f64::TAU * i as f64 / 3000.0);
            let mut t = grid.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap();
            for _ in 0..6 {
                let [x, d, _] = view.curve.jet_real(t);
                t -= dot(x - target, d) / dot(d, d);
            }
            worst = worst.max(distance(t));
            if k == 0 {
                close(cabs(view.curve.jet_real(0.0)[0] - target), 0.0, 2e-14, "point 0");
            }
        }
        assert!(worst < 2e-14, "{n}: {worst:e}");
    }
}

#[test]
fn curve_through_points_of_an_ellipse_converges_to_it() {
    let error = |n: usize| {
        let points: Vec<_> = (0..n)
            .map(|k| {
                let z: Complex<f64> = cis(f64::TAU * k as f64 / n as f64);
                [z.re, 0.5 * z.im]
            })
            .collect();
        let c = compile(Shape::curve(&points));
        (0..997)
            .map(|i| {
                let z = c.view().curve.jet_real(i as f64 * 0.0063)[0];
                ((z.re * z.re + 4.0 * z.im * z.im).sqrt() - 1.0).abs()
            })
            .fold(0.0, f64::max)
    };
    // Quintic splines converge with order 6; the filter's share falls faster at first.
    let (coarse, fine) = (error(24), error(48));
    assert!(coarse < 1.5e-4 && fine < coarse / 64.0, "{coarse:e} {fine:e}");
}

#[test]
fn clockwise_outlines_are_turned_round() {
    let points = blob(12);
    let backwards = |p: &[[f64; 2]]| -> Vec<_> { p.iter().rev().copied().collect() };
    let (l, b) = (backwards(&L_SHAPE), backwards(&points));
    for (shape, turned) in [
        (Shape::Polygon { vertices: &L_SHAPE, radius: Some(0.1) }, Shape::Polygon { vertices: &l, radius: Some(0.1) }),
        (Shape::curve(&points), Shape::curve(&b)),
    ] {
        let (one, other) = (compile(shape), compile(turned));
        assert_eq!((one.status, other.status), (Status::Ok, Status::OutlineReversed));
        let (p, q) = (one.view().properties().unwrap(), other.view().properties().unwrap());
        close(p.area, q.area, 1e-13, "area");
        close(p.polar_moment, q.polar_moment, 1e-13, "moment");
        close(cabs(p.centroid - q.centroid), 0.0, 1e-13, "centroid");
    }
}

#[test]
fn crossing_and_touching_outlines_are_refused() {
    let bow: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let lopsided = [[0.0, 0.0], [2.0, 1.0], [2.0, 0.0], [0.0, 3.0]];
    // A corner on the opposite side; a corner used twice; a side that runs back along the one before.
    let touch = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    let twice = [[0.0, 0.0], [1.0, -1.0], [1.0, 1.0], [0.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]];
    let spike = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    for vertices in [&bow[..], &lopsided, &touch, &twice, &spike] {
        for radius in [None, Some(1e-3)] {
            let e = refused(Shape::Polygon { vertices, radius });
            assert_eq!((e.status, e.what), (Status::SelfIntersection, "vertex"), "{vertices:?}");
            assert!((e.value as usize) < vertices.len());
        }
    }
    for points in [&bow[..], &lopsided, &twice] {
        let e = refused(Shape::curve(points));
        assert_eq!((e.status, e.what), (Status::SelfIntersection, "point"), "{points:?}");
        assert!((e.value as usize) < points.len());
    }
    let eight: Vec<_> = (0..40)
        .map(|k| {
            let (s, c) = (0.1 + f64::TAU * k as f64 / 40.0).sin_cos();
            [c, s * c]
        })
        .collect();
    assert_eq!(refused(Shape::curve(&eight)).status, Status::SelfIntersection);
}

#[test]
fn bad_measures_are_named() {
    let nan = f64::NAN;
    let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
    let repeated = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let hole = [[0.0, 0.0], [1.0, 0.0], [nan, 1.0]];
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let r = Some(0.1);
    let cases: Vec<(Shape<'_, f64>, Status, &str)> = vec![
        (Shape::Ellipse { a: nan, b: 1.0 }, Status::NotFinite, "a"),
        (Shape::Ellipse { a: 1.0, b: f64::INFINITY }, Status::NotFinite, "b"),
        (Shape::Ellipse { a: 1.0, b: 0.0 }, Status::BadShape, "b"),
        (Shape::Ellipse { a: -1.0, b: 1.0 }, Status::BadShape, "a"),
        (Shape::Ellipse { a: 1e200, b: 1.0 }, Status::OutOfRange, "a"),
        (Shape::Star { radius: 1.0, amplitude: 1.0, lobes: 3 }, Status::OutOfRange, "amplitude"),
        (Shape::Star { radius: 1.0, amplitude: nan, lobes: 3 }, Status::NotFinite, "amplitude"),
        (Shape::Star { radius: 0.0, amplitude: 0.1, lobes: 3 }, Status::BadShape, "radius"),
        (Shape::Star { radius: 1.0, amplitude: 0.1, lobes: usize::MAX }, Status::OutOfRange, "lobes"),
        (Shape::Rectangle { width: 1.0, height: -2.0, radius: r }, Status::BadShape, "height"),
        (Shape::Rectangle { width: 1.0, height: 1.0, radius: Some(0.51) }, Status::OutOfRange, "radius"),
        (Shape::Rectangle { width: 1.0, height: 1.0, radius: Some(nan) }, Status::NotFinite, "radius"),
        (Shape::Polygon { vertices: &square, radius: Some(0.0) }, Status::OutOfRange, "radius"),
        (Shape::Polygon { vertices: &square, radius: Some(-0.1) }, Status::OutOfRange, "radius"),
        (Shape::Polygon { vertices: &square, radius: Some(0.51) }, Status::OutOfRange, "radius"),
        (Shape::Polygon { vertices: &WEDGE, radius: Some(0.2) }, Status::OutOfRange, "radius"),
        (Shape::Polygon { vertices: &hole, radius: r }, Status::NotFinite, "vertex"),
        (Shape::Polygon { vertices: &line, radius: r }, Status::BadShape, "area"),
        (Shape::Polygon { vertices: &repeated, radius: r }, Status::BadShape, "vertex"),
        (Shape::Polygon { vertices: &square[..2], radius: r }, Status::BadShape, "vertices"),
        (Shape::Polygon { vertices: &[], radius: r }, Status::BadShape, "vertices"),
        (Shape::curve(&hole), Status::NotFinite, "point"),
        (Shape::curve(&line), Status::BadShape, "area"),
        (Shape::curve(&repeated), Status::BadShape, "point"),
        (Shape::curve(&square[..2]), Status::BadShape, "points"),
    ];
    for (shape, status, what) in cases {
        // The sizes may be asked for before anything has been checked.
        let mut store = vec![0.0; shape.store_len().unwrap_or(0).min(1 << 20)];
        let mut scratch = vec![0.0; shape.scratch_len().unwrap_or(0)];
        let e = shape.compile(&mut store, &mut scratch).unwrap_err();
        assert_eq!((e.status, e.what), (status, what), "{shape:?}");
    }
    let shape = Shape::Rectangle { width: 1.0, height: 1.0, radius: None };
    assert_eq!(shape.compile(&mut [], &mut []).unwrap_err().status, Status::MemoryTooSmall);
}

#[test]
fn single_precision_agrees_with_double() {
    let points = blob(16);
    let narrow: Vec<[f32; 2]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let l: Vec<[f32; 2]> = L_SHAPE.iter().map(|p| p.map(|x| x as f32)).collect();
    let pairs: Vec<(Shape<'_, f64>, Shape<'_, f32>)> = vec![
        (Shape::Ellipse { a: 1.0, b: 0.3 }, Shape::Ellipse { a: 1.0, b: 0.3 }),
        (Shape::Star { radius: 1.0, amplitude: 0.3, lobes: 5 }, Shape::Star { radius: 1.0, amplitude: 0.3, lobes: 5 }),
        (
            Shape::Rectangle { width: 2.0, height: 0.2, radius: Some(0.02) },
            Shape::Rectangle { width: 2.0, height: 0.2, radius: Some(0.02) },
        ),
        (
            Shape::Rectangle { width: 1.0, height: 1.0, radius: None },
            Shape::Rectangle { width: 1.0, height: 1.0, radius: None },
        ),
        (
            Shape::Polygon { vertices: &L_SHAPE, radius: Some(0.05) },
            Shape::Polygon { vertices: &l, radius: Some(0.05) },
        ),
        (Shape::curve(&points), Shape::curve(&narrow)),
    ];
    for (wide, narrow) in pairs {
        let (a, b) = (compile(wide), compile(narrow));
        let (p, q) = (a.view().properties().unwrap(), b.view().properties().unwrap());
        let what = format!("{wide:?}");
        close(f64::from(q.area), p.area, 1e-5, &what);
        close(f64::from(q.perimeter), p.perimeter, 2e-5, &what);
        close(f64::from(q.polar_moment), p.polar_moment, 1e-5, &what);
        close(f64::from(q.reach), p.reach, 2e-6, &what);
        for k in 0..128 {
            let (m, n) = (a.view().node(k, 128).unwrap(), b.view().node(k, 128).unwrap());
            close(f64::from(n.x.re), m.x.re, 1e-5, &what);
            close(f64::from(n.x.im), m.x.im, 1e-5, &what);
            let d = complex(f64::from(n.dx.re), f64::from(n.dx.im));
            close(cabs(d - m.dx), 0.0, 1e-4, &what);
        }
    }
}
#[test]
fn arbitrary_outlines_are_compiled_or_refused_for_a_reason() {
    fn judge<R: Real>(shape: Shape<'_, R>) -> bool {
        match try_compile(shape) {
            Ok(c) => {
                let area = c.view().properties().unwrap_or_else(|e| panic!("{shape:?}: {e}")).area;
                assert!(area > R::zero(), "{shape:?}");
                (0..64).all(|k| c.view().node(k, 64).unwrap_or_else(|e| panic!("{shape:?}: {e}")).x.re.is_finite())
            }
            Err(e) => {
                let reasons = [Status::SelfIntersection, Status::OutOfRange, Status::BadShape];
                assert!(reasons.contains(&e.status) && !e.what.is_empty(), "{shape:?}: {e}");
                false
            }
        }
    }
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut accepted = 0;
    for case in 0..60 {
        let n = 3 + case % 6;
        // Every third list of corners jumps about and mostly crosses itself.
        let vertices: Vec<_> = (0..n)
            .map(|k| {
                let z = cis((k as f64 + 0.8 * random()) * f64::TAU / n as f64) * (0.05 + random());
                if case % 3 == 0 && k % 2 == 0 { [-z.re, -z.im] } else { [z.re, z.im] }
            })
            .collect();
        let narrow: Vec<_> = vertices.iter().map(|p| p.map(|x| x as f32)).collect();
        let radius = 10f64.powf(-1.0 - 4.0 * random());
        accepted += usize::from(judge(Shape::Polygon { vertices: &vertices, radius: Some(radius) }));
        accepted += usize::from(judge(Shape::Polygon { vertices: &narrow, radius: Some(radius as f32) }));
        accepted += usize::from(judge(Shape::curve(&vertices)));
    }
    assert!(accepted > 60 && accepted < 150, "{accepted}");
}

#[test]
fn tangent_is_continuous_to_rounding_where_a_side_ends() {
    // Corners so round that the filter reaches round the whole outline and back to the corner itself.
    for radius in [0.05, 0.2, 0.3, 0.45] {
        let shape = compile(Shape::Rectangle { width: 1.0, height: 1.0, radius: Some(radius) });
        let view = shape.view();
        for corner in [0.25, 0.5, 0.75, 1.0] {
            let t = corner * f64::TAU;
            let [_, before, bend] = view.curve.jet_real(t - 1e-9);
            for ulps in -8..=8 {
                let [_, d, _] = view.curve.jet_real(t * (1.0 + f64::from(ulps) * f64::EPSILON));
                assert!(cabs(d - before) < 3e-9 * cabs(bend) + 1e-13, "radius {radius}, corner {corner}, {ulps} ulps");
                let [_, d, _] = view.curve.jet(complex(t * (1.0 + f64::from(ulps) * f64::EPSILON), 0.0));
                assert!(cabs(d - before) < 3e-9 * cabs(bend) + 1e-13, "radius {radius}, corner {corner}, {ulps} ulps");
            }
        }
    }
}

#[test]
fn ellipses_have_tips_where_curvature_times_perimeter_exceeds_4_pi() {
    for aspect in [1.0, 1.2, 1.4, 1.5, 1.6, 1.8, 3.0, 100.0] {
        for (a, b) in [(aspect, 1.0), (0.2, 0.2 * aspect)] {
            let ellipse = compile(Shape::Ellipse { a, b });
            let mut tips = Vec::new();
            ellipse.outline.each_feature(&ellipse.store, |_, t| tips.push(t));
            let step = f64::TAU / 4096.0;
            let perimeter: f64 = (0..4096)
                .map(|k| {
                    let (sin, cos) = (step * f64::from(k)).sin_cos();
                    (a * sin).hypot(b * cos) * step
                })
                .sum();
            let (long, short) = (f64::max(a, b), f64::min(a, b));
            let expected = if long / (short * short) * perimeter > 2.0 * f64::TAU { 2 } else { 0 };
            assert_eq!(tips.len(), expected, "{a} {b}");
            // They are the ends of the longer axis.
            for t in tips {
                assert!((crate::base::complex::cabs(ellipse.view().curve.jet_real(t)[0]) - long).abs() < 1e-14 * long);
            }
        }
    }
}

#[test]
fn curves_far_away_enclose_what_they_enclose() {
    for distance in [0.0, 1e3, 3e7] {
        let points: Vec<_> = blob(24).into_iter().map(|[x, y]| [x + distance, y - distance]).collect();
        let area = |points: &[[f64; 2]]| compile(Shape::curve(points)).view().properties().unwrap().area;
        let (far, near) = (area(&points), area(&blob(24)));
        close(far / near, 1.0, 1e-15 * (1.0 + 10.0 * distance), "area");
    }
}
