//! The boundary system against identities of potential theory.

#![allow(clippy::indexing_slicing)]
extern crate std;
use crate::boundary::{BoundaryRecord, fill_nodes, self_weights};
use crate::lu::{Factors, factor};
use crate::model::Model;
use crate::nystrom::{Poses, assemble, put_pose};
use crate::owned::ModelBuf;
use crate::potentials::{add_interior_potential, fill_flux};
use crate::scalar::{Complex, Real, cabs, complex};
use crate::scene::{Body, Link, Mass, Root, Scene, Shape, Wall};
use crate::se2::Pose;
use std::vec;
use std::vec::Vec;

/// Largest absolute difference.
#[track_caller]
fn close(computed: &[f64], exact: &[f64], tolerance: f64) {
    assert_eq!(computed.len(), exact.len());
    let error =
        computed.iter().zip(exact).fold(0.0, |m: f64, (c, e)| if (c - e).abs() <= m { m } else { (c - e).abs() });
    std::println!("{error:.1e}");
    assert!(error <= tolerance, "{error:e} > {tolerance:e}");
}

type Rows = Vec<Vec<f64>>;

/// Re W and Im W of an outline with itself, row by row, and its nodes.
fn self_block(shape: &Shape<'_, f64>, nodes: usize) -> (Rows, Rows, Vec<Complex<f64>>) {
    let mut store = vec![0.0; shape.store_len().unwrap() + BoundaryRecord::<f64>::data_len(nodes, true).unwrap()];
    let mut scratch = vec![0.0; shape.scratch_len().unwrap()];
    let store_len = shape.store_len().unwrap();
    let (outline, _) = shape.compile(&mut store[..store_len], &mut scratch).unwrap();
    let mut record =
        BoundaryRecord { nodes, outline, store_len, data_at: store_len, link: Some(0), ..Default::default() };
    fill_nodes(&mut record, &mut store).unwrap();
    let (mut re, mut im) = (vec![vec![0.0; nodes]; nodes], vec![vec![0.0; nodes]; nodes]);
    self_weights(&record, &store, |i, k, y, x| (re[i][k], im[i][k]) = (x, y)).unwrap();
    let points = record.nodes(&store).points().collect();
    (re, im, points)
}

fn apply(rows: &[Vec<f64>], f: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(f).map(|(a, b)| a * b).sum()).collect()
}

#[test]
fn principal_value_is_exact_on_trigonometric_polynomials() {
    // On a circle Γ'/(Γ − z) = (i + cot((s − t)/2))/2, and ½ ∫ cot((s − t)/2) e^{ims} ds = iπ sgn(m) e^{imt}.
    let n = 16;
    let (re, im, _) = self_block(&Shape::Ellipse { a: 0.7, b: 0.7 }, n);
    let wave = |m: usize| -> (Vec<f64>, Vec<f64>) {
        (0..n).map(|k| (f64::TAU * (m * k) as f64 / n as f64).sin_cos()).map(|(s, c)| (c, s)).unzip()
    };
    for m in 0..n / 2 {
        let (cos, sin) = wave(m);
        let mean = if m == 0 { f64::PI } else { 0.0 };
        let sign = if m == 0 { 0.0 } else { f64::PI };
        close(&apply(&re, &cos), &sin.iter().map(|s| -sign * s).collect::<Vec<_>>(), 1e-13);
        close(&apply(&re, &sin), &cos.iter().map(|c| sign * c).collect::<Vec<_>>(), 1e-13);
        close(&apply(&im, &cos), &vec![mean; n], 1e-13);
        close(&apply(&im, &sin), &vec![0.0; n], 1e-13);
    }
}

#[test]
fn principal_value_of_a_polynomial_is_i_pi_times_it() {
    // Cauchy on one outline: W f = iπ f for f analytic inside.
    for shape in [
        Shape::Ellipse { a: 1.0, b: 0.4 },
        Shape::Star { radius: 0.8, amplitude: 0.2, lobes: 3 },
        Shape::Rectangle { width: 1.2, height: 0.8, radius: Some(0.3) },
    ] {
        let (re, im, points) = self_block(&shape, 192);
        for degree in 0..5 {
            let f: Vec<_> = points.iter().map(|z| z.powi(degree)).collect();
            let (x, y): (Vec<f64>, Vec<f64>) = f.iter().map(|f| (f.re, f.im)).unzip();
            let real: Vec<f64> = apply(&re, &x).iter().zip(apply(&im, &y)).map(|(a, b)| a - b).collect();
            let imaginary: Vec<f64> = apply(&im, &x).iter().zip(apply(&re, &y)).map(|(a, b)| a + b).collect();
            close(&real, &y.iter().map(|y| -f64::PI * y).collect::<Vec<_>>(), 2e-12);
            close(&imaginary, &x.iter().map(|x| f64::PI * x).collect::<Vec<_>>(), 2e-12);
        }
    }
}

/// A node in the world.
#[derive(Clone, Copy)]
struct Node {
    point: Complex<f64>,
    /// h dΓ/ds.
    tangent: Complex<f64>,
    /// Of its boundary: sign, first unknown, number of nodes.
    sign: f64,
    first: usize,
    count: usize,
}

/// A boundary system in the world.
struct Assembled {
    model: ModelBuf<f64>,
    /// A and Re G, column-major.
    matrix: Vec<f64>,
    regular: Vec<f64>,
    nodes: Vec<Node>,
}

const POSES: [[f64; 3]; 2] = [[-1.2, 0.3, 0.4], [1.1, -0.6, 1.0]];

fn assembled(in_tank: bool) -> Assembled {
    let wall = |shape, position, nodes| Wall { shape, position, angle: 0.3, nodes, circulation: 0.0 };
    let obstacles = [wall(Shape::Star { radius: 0.5, amplitude: 0.15, lobes: 2 }, [0.1, 1.6], 160)];
    let tank = wall(Shape::Ellipse { a: 4.0, b: 3.2 }, [0.1, 0.2], 192);
    let link = |shape, nodes, circulation| {
        // The centre of mass is not the centroid.
        let mass = Mass::Given { mass: 1.0, inertia: 1.0, centre_of_mass: [0.1, -0.05] };
        [Link { shape, mass, nodes, circulation, joint: None }]
    };
    let links = [
        link(Shape::Ellipse { a: 0.9, b: 0.4 }, 160, 1.0),
        link(Shape::Star { radius: 0.6, amplitude: 0.12, lobes: 3 }, 192, 0.0),
    ];
    let body = |k: usize| Body { pose: POSES[k], velocity: [0.0; 3], root: Root::Free, links: &links[k] };
    let bodies = [body(0), body(1)];
    let tank = if in_tank { Some(tank) } else { None };
    let scene = Scene { tank, obstacles: &obstacles, bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let model = ModelBuf::new(&scene).unwrap();
    let view = model.view();
    let n = view.head.plan.unknowns;
    let mut poses = vec![0.0; 4 * view.boundaries.len()];
    let mut nodes = Vec::new();
    for (i, b, data) in view.each_boundary() {
        let pose = match b.link {
            Some(k) => Pose::new(POSES[k][0], POSES[k][1], POSES[k][2]),
            None => b.pose,
        };
        put_pose(&mut poses, i, &pose);
        for (x, d) in data.points().zip(data.tangents()) {
            let (point, tangent) = (pose.place(x), pose.turned(d) * data.step);
            nodes.push(Node { point, tangent, sign: b.sign, first: b.first, count: b.nodes });
        }
    }
    let (mut matrix, mut regular) = (vec![0.0; n * n], vec![0.0; n * n]);
    let (mut zx, mut zy) = (vec![0.0; n], vec![0.0; n]);
    assemble(&view, Poses(&poses), &mut matrix, n, &mut regular, &mut zx, &mut zy);
    Assembled { model, matrix, regular, nodes }
}

fn product(columns: &[f64], x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    for (column, x) in columns.chunks(x.len()).zip(x) {
        out.iter_mut().zip(column).for_each(|(o, a)| *o += a * x);
    }
    out
}

impl Assembled {
    /// What A adds to the double layer: the mean over the tank's nodes, on the tank.
    fn completion(&self, u: &[f64]) -> Vec<f64> {
        let on_tank = |k: usize| self.nodes[k].sign > 0.0;
        let count = (0..u.len()).filter(|&k| on_tank(k)).count();
        let mean = (0..u.len()).filter(|&k| on_tank(k)).map(|k| u[k]).sum::<f64>() / count as f64;
        (0..u.len()).map(|k| if on_tank(k) { mean } else { 0.0 }).collect()
    }
}

#[test]
fn double_layer_of_one_is_the_solid_angle() {
    for (in_tank, on_solids) in [(false, 2.0), (true, 0.0)] {
        let a = assembled(in_tank);
        let one = vec![1.0; a.nodes.len()];
        let exact: Vec<f64> = a.nodes.iter().map(|node| if node.sign > 0.0 { 1.0 } else { on_solids }).collect();
        close(&product(&a.matrix, &one), &exact, 1e-13);
    }
}

/// A function analytic in the fluid: poles in both bodies and the obstacle; in a tank also a polynomial.
fn analytic(z: Complex<f64>, in_tank: bool) -> Complex<f64> {
    let pole = |x, y, c: Complex<f64>| c / (z - complex(x, y));
    let outside = pole(-1.3, 0.3, complex(1.0, 0.4)) + pole(1.1, -0.5, complex(-0.3, 0.7));
    let outside = outside + pole(0.15, 1.6, complex(0.5, -0.2)) / (z - complex(0.1, 1.55));
    if in_tank { outside + z * z * complex(0.2, 0.1) - z * complex(0.3, 0.5) } else { outside }
}

#[test]
fn green_identity_holds_for_harmonic_functions_inside_and_outside() {
    // With the conjugate function in place of the normal derivative: f = φ + iψ analytic gives A φ = Re(G) ψ and
    // A ψ = −Re(G) φ.
    for in_tank in [false, true] {
        let a = assembled(in_tank);
        let (phi, psi): (Vec<f64>, Vec<f64>) =
            a.nodes.iter().map(|node| analytic(node.point, in_tank)).map(|f| (f.re, f.im)).unzip();
        for (u, conjugate, sign) in [(&phi, &psi, 1.0), (&psi, &phi, -1.0)] {
            let mut left = product(&a.matrix, u);
            if in_tank {
                left.iter_mut().zip(a.completion(u)).for_each(|(l, c)| *l -= c);
            }
            let right: Vec<f64> = product(&a.regular, conjugate).iter().map(|x| sign * x).collect();
            close(&left, &right, 8e-13);
        }
    }
}

/// −(1/π) ∫ log|x − x'| b ds' at every node, for fluxes b ds given at the nodes. On a boundary itself the logarithm is
/// split as log(4 sin²((s − t)/2))/2 and a smooth rest, and the former integrated with the trigonometric weights of
/// Martensen and Kussmaul.
fn single_layer(a: &Assembled, flux: &[f64]) -> Vec<f64> {
    let at = |i: usize| {
        let Node { point: x, tangent: d, first, count: n, .. } = a.nodes[i];
        let half = n / 2;
        let sum: f64 = (0..a.nodes.len())
            .map(|k| {
                let Node { point: y, first: other, .. } = a.nodes[k];
                if other != first {
                    return cabs(x - y).ln() * flux[k];
                }
                let t = f64::TAU * (k as f64 - i as f64) / n as f64;
                let cosines: f64 = (1..half).map(|m| (m as f64 * t).cos() / m as f64).sum();
                // Weight of log(4 sin²(t/2))/2 over h.
                let weight = -cosines - (half as f64 * t).cos() / n as f64;
                let rest = if k == i {
                    (cabs(d) / (f64::TAU / n as f64)).ln()
                } else {
                    (cabs(x - y) / (2.0 * (t / 2.0).sin().abs())).ln()
                };
                (weight + rest) * flux[k]
            })
            .sum();
        -sum / f64::PI
    };
    (0..a.nodes.len()).map(at).collect()
}

#[test]
fn density_form_gives_the_potential_of_the_direct_formulation() {
    for in_tank in [false, true] {
        let a = assembled(in_tank);
        let (model, n): (Model<'_, f64>, usize) = (a.model.view(), a.nodes.len());
        let mut matrix = a.matrix.clone();
        let mut pivots = vec![0.0; n];
        factor(&mut matrix, n, n, &mut pivots).unwrap();
        let factors = Factors { lu: &matrix, ld: n, pivots: &pivots };
        // Motion of both bodies, in their own frames.
        let v = [0.4, -0.7, 0.5, -0.3, 0.2, 0.9];
        let mut potential = vec![0.0; n];
        add_interior_potential(&model, &v, -2.0, &mut potential);
        factors.solve(&mut potential);
        add_interior_potential(&model, &v, 1.0, &mut potential);
        let mut flux = vec![0.0; n];
        fill_flux(&model, &v, &mut flux);
        let mut direct = single_layer(&a, &flux);
        factors.solve(&mut direct);
        // In a tank a potential is determined up to a constant.
        let mean = |u: &[f64]| u.iter().sum::<f64>() / n as f64;
        let (p, d) = (mean(&potential), mean(&direct));
        if !in_tank {
            close(&[p], &[d], 1e-14);
        }
        potential.iter_mut().for_each(|x| *x -= p);
        direct.iter_mut().for_each(|x| *x -= d);
        close(&potential, &direct, 5e-14);
    }
}
