//! The boundary system against identities of potential theory.

#![allow(clippy::indexing_slicing)]
extern crate std;
use crate::base::complex::{Complex, cabs, complex};
use crate::base::scalar::Real;
use crate::fluid::assembly::assemble;
use crate::fluid::configuration::Configuration;
use crate::fluid::near::pole;
use crate::fluid::near::preimage::Source;
use crate::fluid::potentials::{add_interior_potential, fill_flux};
use crate::fluid::self_block::{Block, add_flank_terms, fill_self_block};
use crate::linear::lu::{Factors, factor};
use crate::model::boundary::{BoundaryRecord, Slots};
use crate::scene::{Body, Link, Mass, Quadrature, Root, Scene, Shape, Wall};
use crate::setup::owned::{ModelBuf, SimBuf};
use crate::setup::records::fill_nodes;
use crate::simulation::sim::Sim;
use crate::simulation::state::Method;
use std::sync::Arc;
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
    let (store_len, table_len) = (shape.store_len().unwrap(), pole::table_len(nodes).unwrap());
    let mut store = vec![0.0; store_len + table_len + BoundaryRecord::<f64>::data_len(nodes, true).unwrap()];
    let mut scratch = vec![0.0; shape.scratch_len().unwrap()];
    let (outline, _) = shape.compile(&mut store[..store_len], &mut scratch).unwrap();
    let data_at = store_len + table_len;
    let mut record = BoundaryRecord {
        nodes,
        outline,
        slots: Slots { store_len, table_at: store_len, table_len, data_at, ..Slots::default() },
        link: Some(0),
        ..Default::default()
    };
    fill_nodes(&mut record, &mut store).unwrap();
    // With sign +1: A = 1 − Im W/π.
    let (mut a, mut g) = (vec![0.0; nodes * nodes], vec![0.0; nodes * nodes]);
    let source = Source::of(&record, &store);
    let (mut matrix, mut regular) =
        (Block { data: &mut a, ld: nodes, at: 0 }, Block { data: &mut g, ld: nodes, at: 0 });
    fill_self_block(&source.nodes, 1.0, 0.0, &mut matrix, &mut regular);
    add_flank_terms(&source, 1.0, &mut matrix, &mut regular);
    let pi = core::f64::consts::PI;
    let rows = |f: &dyn Fn(usize, usize) -> f64| -> Rows {
        (0..nodes).map(|i| (0..nodes).map(|k| f(i, k)).collect()).collect()
    };
    let one = |i, k| if i == k { 1.0 } else { 0.0 };
    let re = rows(&|i, k| g[k * nodes + i] * pi);
    let im = rows(&|i, k| (one(i, k) - a[k * nodes + i]) * pi);
    (re, im, record.nodes(&store).points().collect())
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
    sim: SimBuf<f64>,
    /// A and Re G, column-major.
    matrix: Vec<f64>,
    regular: Vec<f64>,
    nodes: Vec<Node>,
}

const POSES: [[f64; 3]; 2] = [[-1.2, 0.3, 0.4], [1.1, -0.6, 1.0]];

fn assembled(in_tank: bool, quadrature: Quadrature) -> Assembled {
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
    let scene = Scene { tank, obstacles: &obstacles, bodies: &bodies, quadrature, ..Scene::new(1.0, 0.0) };
    let model = Arc::new(ModelBuf::new(&scene).unwrap());
    let mut sim = SimBuf::new(model, Method::Rk4 { step: 0.1 }).unwrap();
    let mut view = sim.view();
    let n = view.model.head.plan.unknowns;
    let mut nodes = Vec::new();
    let (mut matrix, mut regular) = (vec![0.0; n * n], vec![0.0; n * n]);
    let (mut zx, mut zy) = (vec![0.0; n], vec![0.0; n]);
    at_rest(&mut view, |c| {
        for (i, b, data) in c.each_boundary() {
            for (x, d) in data.points().zip(data.tangents()) {
                let (point, tangent) = (c.pose(i).place(x), c.pose(i).turned(d) * data.step);
                nodes.push(Node { point, tangent, sign: b.sign, first: b.first, count: b.nodes });
            }
        }
        assemble(c, false, &mut matrix, n, &mut regular, &mut zx, &mut zy);
    });
    Assembled { sim, matrix, regular, nodes }
}

/// What an evaluation sees of the state shown.
fn at_rest<T>(sim: &mut Sim<'_, f64>, then: impl FnOnce(&Configuration<'_, f64>) -> T) -> T {
    sim.refresh().unwrap();
    then(&sim.evaluation.placement.configuration(&sim.model))
}

const BOTH: [Quadrature; 2] = [Quadrature::Graded, Quadrature::Plain];

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
    for (in_tank, on_solids, quadrature) in BOTH.into_iter().flat_map(|q| [(false, 2.0, q), (true, 0.0, q)]) {
        let a = assembled(in_tank, quadrature);
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
    for (in_tank, quadrature) in BOTH.into_iter().flat_map(|q| [(false, q), (true, q)]) {
        let a = assembled(in_tank, quadrature);
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
        // The logarithms below know no poles.
        let mut a = assembled(in_tank, Quadrature::Plain);
        let n = a.nodes.len();
        let mut matrix = a.matrix.clone();
        let mut pivots = vec![0; n];
        factor(&mut matrix, n, n, &mut pivots).unwrap();
        let factors = Factors { lu: &matrix, ld: n, pivots: &pivots };
        // Motion of both bodies, in their own frames.
        let v = [0.4, -0.7, 0.5, -0.3, 0.2, 0.9];
        let mut potential = vec![0.0; n];
        at_rest(&mut a.sim.view(), |c| add_interior_potential(c, &v, -2.0, &mut potential));
        factors.solve(&mut potential);
        at_rest(&mut a.sim.view(), |c| add_interior_potential(c, &v, 1.0, &mut potential));
        let mut flux = vec![0.0; n];
        at_rest(&mut a.sim.view(), |c| fill_flux(c, &v, &mut flux));
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

/// Two discs at a small gap, turned so that no node lies at the contact or all symmetric ones do.
fn discs(gap: f64, turns: [f64; 2], nodes: usize) -> SimBuf<f64> {
    let link = Link {
        shape: Shape::Ellipse { a: 1.0, b: 1.0 },
        mass: Mass::Density(1.0),
        nodes,
        circulation: 0.0,
        joint: None,
    };
    let links = [link];
    let body = |x, turn| Body { pose: [x, 0.0, turn], velocity: [0.3, 0.2, 0.1], root: Root::Free, links: &links };
    let bodies = [body(0.0, turns[0]), body(2.0 + gap, turns[1])];
    let model = ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap();
    SimBuf::new(Arc::new(model), Method::Rk4 { step: 0.1 }).unwrap()
}

#[test]
fn corrected_weights_and_their_derivatives_integrate_a_constant_exactly() {
    use crate::fluid::induced::{add_pole_velocity, induced_velocity};
    use crate::geometry::nodes::fill_targets;
    for gap in [1e-1, 1e-3, 1e-5] {
        for turns in [[0.0, 0.0], [-2.345, 1.234]] {
            let nodes = 64;
            let mut sim = discs(gap, turns, nodes);
            at_rest(&mut sim.view(), |c| {
                let (one, zero) = (vec![1.0; nodes], vec![0.0; nodes]);
                for (j, i) in [(0, 1), (1, 0)] {
                    let ((source, points), (target, t)) = (c.boundary(j).unwrap(), c.boundary(i).unwrap());
                    let (mut zx, mut zy) = (vec![0.0; nodes], vec![0.0; nodes]);
                    fill_targets(&t, c.pose(i), c.pose(j), &mut zx, &mut zy);
                    let (mut hx, mut hy) = (vec![0.0; nodes], vec![0.0; nodes]);
                    induced_velocity(source, &points, &one, &[], &zx, &zy, &mut hx, &mut hy);
                    add_pole_velocity(
                        c,
                        (j, source),
                        target.first,
                        [&one, &zero],
                        [&[], &[]],
                        [&mut hx, &mut hy],
                        &mut [],
                    );
                    for k in 0..nodes {
                        let h = hx[k].hypot(hy[k]);
                        // What the rounding of the nodes leaves of the largest term.
                        let z = complex(zx[k], zy[k]);
                        let entries = points.points().zip(points.tangents());
                        let largest =
                            entries.map(|(g, d)| cabs(d) * points.step / cabs(g - z).powi(2)).fold(0.0, f64::max);
                        assert!(h < 1.5e-13 * largest + 1e-12, "gap {gap}, row {k}: {h:e} of {largest:e}");
                    }
                }
            });
        }
    }
}

#[test]
fn a_footprint_on_an_ellipse_is_the_parameter_wherever_the_frame_has_its_origin() {
    // a cos t + i b sin t at t = u + iv is as far outside as v is below 0.
    let (a, b, nodes) = (1.3_f64, 0.4_f64, 32);
    for origin in [complex(0.0, 0.0), complex(0.3, -0.2), complex(-7.0, 4.0)] {
        let shape = Shape::Ellipse { a, b };
        let mut store = vec![0.0; shape.store_len().unwrap() + BoundaryRecord::<f64>::data_len(nodes, true).unwrap()];
        let (own, mut scratch) = (shape.store_len().unwrap(), vec![0.0; shape.scratch_len().unwrap()]);
        let (outline, _) = shape.compile(&mut store[..own], &mut scratch).unwrap();
        let slots = Slots { store_len: own, data_at: own, ..Slots::default() };
        let mut record = BoundaryRecord { nodes, outline, slots, origin, link: Some(0), ..Default::default() };
        fill_nodes(&mut record, &mut store).unwrap();
        let source = Source::of(&record, &store);
        for (u, v) in [(0.0, 0.05), (0.7, 0.1), (2.9, 0.2), (-2.2, 0.01)] {
            let (sin, cos) = f64::sin_cos(u);
            let z = complex(a * cos * v.cosh() + b * cos * v.sinh(), b * sin * v.cosh() + a * sin * v.sinh());
            let (t, height) = source.footprint(z - origin).unwrap();
            assert!((t - u).abs() < 1e-13 && (height - v).abs() < 1e-13, "{u} {v}: {t} {height}");
        }
    }
}
