//! Derivatives of forces and motion against differences of eighth order, identities and closed forms.

use nekton::scene::{Link, Quadrature, Repulsion, Scene, Shape, Wall};
use nekton::{Sim, SimBuf};
use nekton_tests::*;

/// Three links without any symmetry, as three bodies.
fn links(nodes: usize) -> [[Link<'static, f64>; 1]; 3] {
    [
        [link(Shape::Ellipse { a: 0.8, b: 0.4 }, 0.7, nodes)],
        [link(Shape::Star { radius: 0.5, amplitude: 0.15, lobes: 3 }, 1.4, nodes)],
        [link(Shape::Rectangle { width: 1.0, height: 0.6, radius: Some(0.1) }, 1.1, nodes)],
    ]
}

const POSES: [[f64; 3]; 3] = [[-1.3, 0.2, 0.3], [0.4, -0.9, 1.1], [0.7, 0.9, -0.5]];
const VELOCITIES: [[f64; 3]; 3] = [[0.4, -0.3, 0.7], [-0.2, 0.5, -0.4], [0.3, 0.1, 0.9]];

/// Accelerations without any symmetry.
fn accelerations(n: usize) -> Vec<f64> {
    (0..n).map(|k| (1.3 * k as f64 + 0.4).sin()).collect()
}

/// r = M q̈ + F of free bodies in a state.
fn residual(sim: &mut Sim<'_, f64>, y: &[f64], qdd: &[f64]) -> Vec<f64> {
    sim.set_state(0.0, y).unwrap();
    let mass = matrix(sim, |sim, out| sim.mass_matrix(out));
    let parts = [
        vector(sim, |sim, out| sim.buoyancy(out)),
        vector(sim, |sim, out| sim.repulsion(out)),
        vector(sim, |sim, out| sim.christoffel(out)),
    ];
    let force = |a: usize| parts.iter().map(|p| p[a]).sum::<f64>();
    (0..qdd.len()).map(|a| force(a) + mass.iter().zip(qdd).map(|(column, w)| column[a] * w).sum::<f64>()).collect()
}

/// Columns of the derivative of `f` by each of `y`, by central differences of eighth order.
fn by_differences(y: &[f64], step: f64, mut f: impl FnMut(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let mut columns = Vec::new();
    for k in 0..y.len() {
        let mut column: Vec<f64> = Vec::new();
        for (m, weight) in WEIGHTS.iter().enumerate() {
            let mut moved = |shift: f64| {
                let mut y = y.to_vec();
                y[k] += shift;
                f(&y)
            };
            let shift = step * (m + 1) as f64;
            let (forward, back) = (moved(shift), moved(-shift));
            column.resize(forward.len(), 0.0);
            for ((c, f), b) in column.iter_mut().zip(forward).zip(back) {
                *c += weight * (f - b) / step;
            }
        }
        columns.push(column);
    }
    columns
}

/// ∂r/∂q and ∂r/∂q̇ at the state shown.
fn force_derivatives(sim: &mut Sim<'_, f64>, qdd: &[f64]) -> [Vec<f64>; 2] {
    let n = qdd.len();
    let mut memory = vec![f64::NAN; Sim::derivative_requirement(&sim.model()).unwrap()];
    let (mut position, mut velocity) = (vec![f64::NAN; n * n], vec![f64::NAN; n * n]);
    sim.force_derivatives(qdd, &mut position, &mut velocity, &mut memory).unwrap();
    [position, velocity]
}

fn obstacle() -> [Wall<'static, f64>; 1] {
    [wall(Shape::Ellipse { a: 0.3, b: 0.5 }, [2.1, 0.1], 0.4, 48)]
}

fn tank() -> Wall<'static, f64> {
    wall(Shape::Ellipse { a: 4.0, b: 3.0 }, [0.4, 0.1], 0.2, 48)
}

/// Checks both derivatives of a scene of free bodies. The errors relative to the largest entry.
fn check(place: &str, scene: &Scene<'_, f64>, step: f64, tolerance: f64) {
    let mut sim: SimBuf<f64> = at_start(scene);
    let mut sim = sim.view();
    let y = sim.state().to_vec();
    let n = sim.positions().len();
    let qdd = accelerations(n);
    let found = force_derivatives(&mut sim, &qdd);
    let exact = by_differences(&y[..2 * n], step, |moved| residual(&mut sim, &[moved, &y[2 * n..]].concat(), &qdd));
    let exact = [exact[..n].concat(), exact[n..].concat()];
    let errors = [0, 1].map(|k| difference(&found[k], &exact[k]));
    println!("{place}: by position {:.1e}, by velocity {:.1e}", errors[0], errors[1]);
    for k in [0, 1] {
        assert_close(&found[k], &exact[k], tolerance);
    }
}

fn everywhere(nodes: usize, quadrature: Quadrature, repulsion: Option<Repulsion<f64>>, check: impl Fn(&str, &Scene<'_, f64>)) {
    let links = links(nodes);
    let bodies: Vec<_> = (0..3).map(|k| body(&links[k], POSES[k], VELOCITIES[k])).collect();
    let obstacles = obstacle();
    let alone = Scene { repulsion, quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(1.3, 9.81) };
    check("unbounded", &alone);
    check("lone", &Scene { bodies: &bodies[..1], ..alone });
    let beside = Scene { obstacles: &obstacles, ..alone };
    check("obstacle", &beside);
    check("tank", &Scene { tank: Some(tank()), ..beside });
}

#[test]
fn derivatives_of_the_force_are_exact_at_any_resolution() {
    for nodes in [16, 32] {
        everywhere(nodes, Quadrature::Plain, None, |place, scene| check(&format!("{place}, {nodes}"), scene, 2e-3, 5e-12));
    }
}
