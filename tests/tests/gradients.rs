//! Forces are the derivatives of their energies, found here by differences of sixth order.

use nekton::scene::{
    Body, Drive, ForceFormula, Harmonic, Link, Quadrature, Repulsion, Root, Scene, Shape, Signal, Wall,
};
use nekton_tests::*;

/// Three links without any symmetry, as three bodies.
fn links(nodes: usize) -> [[Link<'static, f64>; 1]; 3] {
    let circulating = |shape, density, circulation| [Link { circulation, ..link(shape, density, nodes) }];
    [
        circulating(Shape::Ellipse { a: 0.8, b: 0.4 }, 0.7, 0.8),
        circulating(Shape::Star { radius: 0.5, amplitude: 0.15, lobes: 3 }, 1.4, -0.5),
        circulating(Shape::curve(&POINTS), 1.1, 0.3),
    ]
}

/// A bean.
const POINTS: [[f64; 2]; 8] =
    [[0.6, 0.0], [0.5, 0.4], [0.1, 0.35], [-0.3, 0.5], [-0.6, 0.2], [-0.5, -0.3], [0.0, -0.5], [0.45, -0.35]];

fn bodies<'a>(links: &'a [[Link<'a, f64>; 1]; 3]) -> [Body<'a, f64>; 3] {
    [
        body(&links[0], [-1.3, 0.2, 0.3], [0.4, -0.3, 0.7]),
        body(&links[1], [0.4, -0.9, 1.1], [-0.2, 0.5, -0.4]),
        body(&links[2], [0.7, 0.9, -0.5], [0.3, 0.1, 0.9]),
    ]
}

fn obstacle() -> [Wall<'static, f64>; 1] {
    [Wall { circulation: 0.4, ..wall(Shape::Ellipse { a: 0.3, b: 0.5 }, [2.1, 0.1], 0.4, 96) }]
}

fn tank() -> Wall<'static, f64> {
    wall(Shape::Ellipse { a: 4.0, b: 3.0 }, [0.4, 0.1], 0.2, 128)
}

/// Runs `check` on the three bodies alone, beside an obstacle, and in a tank with the obstacle. With nodes that stay where
/// they are (`Plain`) a force is the derivative of the discrete energy at any resolution; with graded ones, where space is
/// resolved.
fn everywhere(nodes: usize, quadrature: Quadrature, check: impl Fn(&str, &Scene<'_, f64>)) {
    let links = links(nodes);
    let bodies = bodies(&links);
    let obstacles = obstacle();
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    let alone = Scene { repulsion, quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(1.3, 9.81) };
    check("unbounded", &alone);
    let beside = Scene { obstacles: &obstacles, ..alone };
    check("obstacle", &beside);
    check("tank", &Scene { tank: Some(tank()), ..beside });
}

/// Σ_ij ½(∂_j M_ai + ∂_i M_aj − ∂_a M_ij) q̇_i q̇_j from the derivatives of M by differences.
fn contraction(scene: &Scene<'_, f64>) -> Vec<f64> {
    let qd: Vec<f64> = scene.bodies.iter().flat_map(|body| body.velocity).collect();
    let n = qd.len();
    let slopes = derivatives(scene, |sim| matrix(sim, |sim, out| sim.mass_matrix(out)).concat());
    let mut force = vec![0.0; n];
    for a in 0..n {
        for i in 0..n {
            for j in 0..n {
                force[a] += (slopes[j][n * a + i] - 0.5 * slopes[a][n * i + j]) * qd[i] * qd[j];
            }
        }
    }
    force
}

fn check_christoffel(nodes: usize, quadrature: Quadrature) {
    everywhere(nodes, quadrature, |place, scene| {
        let scene = Scene { repulsion: None, ..*scene };
        let force = vector(&mut at_start(&scene).view(), |sim, out| sim.christoffel(out));
        let exact = contraction(&scene);
        println!("{place}, {nodes} nodes: {:.1e}", difference(&force, &exact));
        assert_close(&force, &exact, 2e-12);
    });
}

#[test]
fn christoffel_force_is_the_contraction_of_the_derivative_of_added_mass() {
    check_christoffel(96, Quadrature::Plain);
    check_christoffel(160, Quadrature::Graded);
}

#[test]
fn christoffel_force_is_exact_even_when_space_is_not_resolved() {
    check_christoffel(16, Quadrature::Plain);
}

#[test]
fn christoffel_tensor_contracts_to_the_force_and_comes_from_a_potential() {
    everywhere(32, Quadrature::Plain, |place, scene| {
        let mut sim = at_start(scene);
        let mut sim = sim.view();
        let force = vector(&mut sim, |sim, out| sim.christoffel(out));
        let (n, v) = (force.len(), sim.velocities().to_vec());
        let mut tensor = vec![0.0; n * n * n];
        sim.christoffel_tensor(&mut tensor).unwrap();
        let entry = |a: usize, i: usize, j: usize| tensor[a + n * (i + n * j)];
        let contracted: Vec<f64> =
            (0..n).map(|a| (0..n * n).map(|ij| entry(a, ij % n, ij / n) * v[ij % n] * v[ij / n]).sum()).collect();
        println!("{place}: {:.1e}", difference(&contracted, &force));
        assert_close(&contracted, &force, 1e-13);
        // Γ_aij + Γ_iaj = ∂_j M_ai, whose contraction with v is the rate of M: v·(Γ v v) = ½ v·Ṁ v.
        let power: f64 = force.iter().zip(&v).map(|(f, v)| f * v).sum();
        let scene = Scene { repulsion: None, ..*scene };
        let rates = derivatives(&scene, |sim| {
            let n = size(sim);
            let mut mass = vec![0.0; n * n];
            sim.mass_matrix(&mut mass).unwrap();
            mass
        });
        let rate: f64 = (0..n)
            .flat_map(|k| (0..n * n).map(move |ij| (k, ij)))
            .map(|(k, ij)| v[k] * rates[k][ij] * v[ij % n] * v[ij / n])
            .sum();
        assert_near(power, 0.5 * rate, 1e-9);
    });
}

#[test]
fn boundary_formula_agrees_with_the_exact_gradient_when_space_is_resolved() {
    everywhere(128, Quadrature::Graded, |place, scene| {
        let force = |force| vector(&mut at_start(&Scene { force, ..*scene }).view(), |sim, out| sim.christoffel(out));
        let (exact, boundary) = (force(ForceFormula::ExactGradient), force(ForceFormula::Boundary));
        println!("{place}: {:.1e}", difference(&boundary, &exact));
        assert_close(&boundary, &exact, 4e-13);
    });
}

#[test]
fn boundary_formula_agrees_with_the_exact_gradient_for_a_swimmer() {
    // A prescribed and a torque-driven joint, with the root free and with it prescribed.
    let wave = [Harmonic { amplitude: 0.5, frequency: 2.0, phase: 0.7, offset: 0.1 }];
    let signal = Signal::Harmonic { terms: &wave, window: None };
    let one = link(Shape::Ellipse { a: 0.6, b: 0.25 }, 1.2, 128);
    let torque = Drive::Torque { torque: signal, stiffness: 0.3, damping: 0.1, rest: 0.2, start: [-0.4, 0.8] };
    let swimmer = [
        one,
        hinged(one, 0, [-0.85, 0.0], [0.85, 0.0], Drive::Motion(signal)),
        hinged(one, 0, [0.85, 0.0], [-0.85, 0.0], torque),
    ];
    let obstacles = [wall(Shape::Ellipse { a: 0.3, b: 0.5 }, [0.3, 1.4], 0.4, 128)];
    let given = Root::Prescribed([signal, Signal::Constant(0.1), signal]);
    for (name, root) in [("free", Root::Free), ("prescribed", given)] {
        let bodies = [Body { root, ..body(&swimmer, [0.1, -0.2, 0.2], [0.3, -0.2, 0.4]) }];
        for obstacles in [&obstacles[..0], &obstacles] {
            let results = [ForceFormula::ExactGradient, ForceFormula::Boundary].map(|force| {
                let mut sim = at_start(&Scene { force, obstacles, bodies: &bodies, ..Scene::new(1.3, 0.5) });
                let mut sim = sim.view();
                let (mut torques, mut powers) = (vec![f64::NAN; 2], vec![f64::NAN; 2]);
                sim.joint_torques(&mut torques, &mut powers).unwrap();
                let christoffel = vector(&mut sim, |sim, out| sim.christoffel(out));
                [christoffel, vector(&mut sim, |sim, out| sim.accelerations(out)), torques]
            });
            let [exact, boundary] = results;
            for (boundary, exact) in boundary.iter().zip(&exact) {
                println!("root {name}, {} obstacles: {:.1e}", obstacles.len(), difference(boundary, exact));
                assert_close(boundary, exact, 3e-14);
            }
        }
    }
}

#[test]
fn repulsion_is_the_derivative_of_its_potential() {
    everywhere(48, Quadrature::Plain, |place, scene| {
        let force = vector(&mut at_start(scene).view(), |sim, out| sim.repulsion(out));
        let exact = derivatives(scene, |sim| vec![sim.energy().unwrap().repulsion]).concat();
        println!("{place}: {:.1e}", difference(&force, &exact));
        assert_close(&force, &exact, 1e-10);
    });
}

#[test]
fn circulation_gradient_is_the_derivative_of_the_circulatory_energy() {
    // 48 nodes do not resolve every body: the gradient must be that of the discrete energy.
    for (nodes, quadrature) in [(48, Quadrature::Plain), (96, Quadrature::Plain), (160, Quadrature::Graded)] {
        everywhere(nodes, quadrature, |place, scene| {
            let force = vector(&mut at_start(scene).view(), |sim, out| sim.circulation_gradient(out));
            let exact = derivatives(scene, |sim| vec![sim.energy().unwrap().circulation]).concat();
            println!("{place}, {nodes} nodes: {:.1e}", difference(&force, &exact));
            assert_close(&force, &exact, 5e-12);
        });
    }
}

#[test]
fn buoyancy_is_the_derivative_of_its_potential() {
    everywhere(32, Quadrature::Plain, |place, scene| {
        let force = vector(&mut at_start(scene).view(), |sim, out| sim.buoyancy(out));
        let exact = derivatives(scene, |sim| vec![sim.energy().unwrap().buoyancy]).concat();
        println!("{place}: {:.1e}", difference(&force, &exact));
        assert_close(&force, &exact, 5e-13);
    });
}

#[test]
fn gyroscopic_matrix_is_a_closed_form() {
    // G is the exterior derivative of a momentum plus constants: ∂_a G_bc + ∂_b G_ca + ∂_c G_ab = 0.
    everywhere(96, Quadrature::Plain, |place, scene| {
        let slopes = derivatives(scene, |sim| matrix(sim, |sim, out| sim.gyroscopic(out)).concat());
        let n = slopes.len();
        let g = |a: usize, b: usize, c: usize| slopes[a][n * c + b];
        let mut largest = 0.0_f64;
        let mut defect = 0.0_f64;
        for a in 0..n {
            for b in 0..n {
                for c in 0..n {
                    largest = largest.max(g(a, b, c).abs());
                    defect = defect.max((g(a, b, c) + g(b, c, a) + g(c, a, b)).abs());
                }
            }
        }
        println!("{place}: {:.1e}", defect / largest);
        assert!(defect <= 1e-11 * largest, "{place}: {defect:e} of {largest:e}");
    });
}
