//! `cargo bench -p nekton-bench`: every stage of an evaluation, whole evaluations, steps and set-up, in both precisions, for arrays of moving
//! ellipses: plain quadrature at gap 1, graded quadrature at gaps of 0.1 and 0.001.

use divan::Bencher;
use nekton::lu::{Factors, factor};
use nekton::scene::Quadrature;
use nekton::stages::Stage;
use nekton::{Method, ModelBuf, Real, SimBuf};
use nekton_bench::lapack::diagonal_dominant;
use nekton_bench::scenes::{array, ellipse, scene};
use nekton_tests::simulation;
use std::fmt;
use std::hint::black_box;

fn main() {
    divan::main();
}

/// A scene.
#[derive(Clone, Copy)]
struct Case {
    bodies: usize,
    nodes: usize,
    gap: f64,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Case { bodies, nodes, gap } = self;
        match self.quadrature() {
            Quadrature::Plain => write!(f, "plain, {bodies} x {nodes}"),
            Quadrature::Graded => write!(f, "graded, {bodies} x {nodes}, gap {gap}"),
        }
    }
}

const fn plain(nodes: usize) -> Case {
    Case { bodies: 4, nodes, gap: 1.0 }
}

const fn graded(nodes: usize, gap: f64) -> Case {
    Case { bodies: 2, nodes, gap }
}

const CASES: [Case; 8] = [
    plain(16),
    plain(32),
    plain(64),
    plain(128),
    graded(32, 0.1),
    graded(64, 0.1),
    graded(32, 0.001),
    graded(64, 0.001),
];

const ORDERS: [usize; 5] = [64, 128, 256, 512, 1024];

impl Case {
    fn quadrature(self) -> Quadrature {
        if self.gap < 1.0 { Quadrature::Graded } else { Quadrature::Plain }
    }

    fn sim<R: Real>(self, method: Method<R>) -> SimBuf<R> {
        let link = [ellipse(self.nodes)];
        simulation(&scene(&array(&link, 2, self.bodies / 2, self.gap), self.quadrature()), method)
    }

    fn stage<R: Real>(self, bencher: Bencher<'_, '_>, stage: Stage) {
        let mut sim = self.sim::<R>(Method::Rk4 { step: R::lit(1e-3) });
        let mut sim = sim.view();
        let state = sim.state().to_vec();
        let mut rate = state.clone();
        sim.rhs(R::zero(), &state, &mut rate).expect("the scene can be evaluated");
        bencher.bench_local(|| sim.stage(stage).expect("it can be done again"));
    }

    fn step<R: Real>(self, bencher: Bencher<'_, '_>, method: Method<R>) {
        let mut sim = self.sim(method);
        let mut sim = sim.view();
        bencher.bench_local(|| sim.step().expect("the scene can step"));
    }
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn a1_kinematics_and_contact<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.stage::<R>(bencher, Stage::Place);
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn a2_ladders_nodes_preimages<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.stage::<R>(bencher, Stage::Grade);
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn a3_assembly<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.stage::<R>(bencher, Stage::Assemble);
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn a4_assembly_factorization_solves<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.stage::<R>(bencher, Stage::Solve);
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn a5_forces<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.stage::<R>(bencher, Stage::Force);
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn b_evaluation<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    let mut sim = case.sim::<R>(Method::Rk4 { step: R::lit(1e-3) });
    let mut sim = sim.view();
    let state = sim.state().to_vec();
    let mut rate = state.clone();
    bencher.bench_local(|| sim.rhs(R::zero(), &state, &mut rate).expect("the scene can be evaluated"));
}

/// Steps so short that nothing comes closer while they are timed.
const STEP: f64 = 1e-6;

#[divan::bench(types = [f64, f32], args = CASES)]
fn c_step_rk4<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.step::<R>(bencher, Method::Rk4 { step: R::lit(STEP) });
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn c_step_abm4<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.step::<R>(bencher, Method::Abm4 { step: R::lit(STEP) });
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn c_step_gauss6<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    case.step::<R>(bencher, Method::Gauss6 { step: R::lit(STEP) });
}

/// Each from the start, whose first steps are short: steps of this method grow as the motion allows.
#[divan::bench(types = [f64, f32], args = CASES)]
fn c_first_step_adams<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    let tolerance = R::lit(1e-6);
    let mut sim = case.sim::<R>(Method::adams(tolerance, tolerance));
    let mut sim = sim.view();
    let state = sim.state().to_vec();
    bencher.bench_local(|| {
        sim.set_state(R::zero(), &state).expect("the state it had");
        sim.step().expect("the scene can step");
    });
}

#[divan::bench(types = [f64, f32], args = CASES)]
fn d_setup<R: Real>(bencher: Bencher<'_, '_>, case: &Case) {
    let link = [ellipse::<R>(case.nodes)];
    let bodies = array(&link, 2, case.bodies / 2, case.gap);
    let scene = scene(&bodies, case.quadrature());
    bencher.bench_local(|| {
        let model = std::sync::Arc::new(ModelBuf::new(&scene).expect("accepted"));
        SimBuf::new(model, Method::Rk4 { step: R::lit(STEP) }).expect("accepted")
    });
}

/// Matrix, leading dimension as in a simulation.
fn matrix<R: Real>(n: usize) -> (Vec<R>, usize) {
    let ld = n + 8;
    (diagonal_dominant(n, ld).into_iter().map(R::lit).collect(), ld)
}

/// A copy of the matrix is part of it.
#[divan::bench(types = [f64, f32], args = ORDERS)]
fn e_factorization<R: Real>(bencher: Bencher<'_, '_>, n: usize) {
    let (a, ld) = matrix::<R>(n);
    let (mut lu, mut pivots) = (a.clone(), vec![R::Index::default(); n]);
    bencher.bench_local(|| {
        lu.copy_from_slice(&a);
        factor(&mut lu, ld, n, &mut pivots).expect("far from singular")
    });
}

fn solve<R: Real>(bencher: Bencher<'_, '_>, n: usize, how: fn(&Factors<'_, R>, &mut [R])) {
    let (mut lu, ld) = matrix::<R>(n);
    let mut pivots = vec![R::Index::default(); n];
    factor(&mut lu, ld, n, &mut pivots).expect("far from singular");
    let factors = Factors { lu: &lu, ld, pivots: &pivots };
    let right = vec![R::one(); n];
    let mut b = right.clone();
    bencher.bench_local(|| {
        b.copy_from_slice(&right);
        how(&factors, &mut b);
        black_box(&b);
    });
}

#[divan::bench(types = [f64, f32], args = ORDERS)]
fn e_solve<R: Real>(bencher: Bencher<'_, '_>, n: usize) {
    solve::<R>(bencher, n, |factors, b| factors.solve(b));
}

#[divan::bench(types = [f64, f32], args = ORDERS)]
fn e_solve_transposed<R: Real>(bencher: Bencher<'_, '_>, n: usize) {
    solve::<R>(bencher, n, |factors, b| factors.solve_transposed(b));
}
