//! Views of nalgebra, against what the functions that fill slices say and against mechanics.

use nalgebra::{DMatrixView, DVectorView, Matrix6, RealField, Vector6};
use nekton::scalar::Real;
use nekton::scene::{Link, Repulsion, Scene, Shape};
use nekton::{Result, Sim, SimBuf, Status};
use nekton_tests::*;

/// Two free bodies with every force: different ellipses, one with circulation, in a tank.
fn two<R: Real>() -> SimBuf<R> {
    let lit = R::lit;
    let ellipse = |a: f64, b: f64| link(Shape::Ellipse { a: lit(a), b: lit(b) }, lit(1.3), 40);
    let (one, other) = ([Link { circulation: lit(0.7), ..ellipse(0.8, 0.3) }], [ellipse(0.5, 0.4)]);
    let at = |x: f64, y: f64, z: f64| [lit(x), lit(y), lit(z)];
    let bodies =
        [body(&one, at(-0.9, 0.1, 0.4), at(0.3, -0.1, 0.2)), body(&other, at(0.8, -0.2, 0.0), at(-0.2, 0.4, 0.5))];
    let tank = Some(wall(disc(lit(3.0)), [R::zero(); 2], R::zero(), 64));
    let repulsion = Some(Repulsion { alpha: lit(3.0), epsilon: lit(0.02) });
    at_start(&Scene { tank, repulsion, bodies: &bodies, ..Scene::new(R::one(), lit(0.5)) })
}

fn six<R: Real>(view: DVectorView<'_, R>) -> Vector6<R> {
    assert_eq!(view.shape(), (6, 1));
    view.fixed_rows::<6>(0).clone_owned()
}

fn square<R: Real>(view: DMatrixView<'_, R>) -> Matrix6<R> {
    assert_eq!(view.shape(), (6, 6));
    view.fixed_view::<6, 6>(0, 0).clone_owned()
}

fn same_numbers_in_the_same_places<R: Real>() {
    let mut sim = two::<R>();
    let mut sim = sim.view();
    let mut buffer = [R::NAN; 36];
    let matrices: [(Vec<Vec<R>>, Matrix6<R>); 3] = [
        (matrix(&mut sim, |sim, out| sim.mass_matrix(out)), square(sim.mass_matrix_view(&mut buffer).unwrap())),
        (matrix(&mut sim, |sim, out| sim.added_mass(out)), square(sim.added_mass_view(&mut buffer).unwrap())),
        (matrix(&mut sim, |sim, out| sim.gyroscopic(out)), square(sim.gyroscopic_view(&mut buffer).unwrap())),
    ];
    for (columns, view) in matrices {
        for (j, column) in columns.iter().enumerate() {
            column.iter().enumerate().for_each(|(i, x)| assert_eq!(view[(i, j)], *x));
        }
    }
    let out = &mut [R::NAN; 6];
    let vectors: [(Vec<R>, Vector6<R>); 7] = [
        (sim.positions().to_vec(), six(sim.positions_view())),
        (sim.velocities().to_vec(), six(sim.velocities_view())),
        (vector(&mut sim, |sim, out| sim.accelerations(out)), six(sim.accelerations_view(out).unwrap())),
        (vector(&mut sim, |sim, out| sim.christoffel(out)), six(sim.christoffel_view(out).unwrap())),
        (vector(&mut sim, |sim, out| sim.buoyancy(out)), six(sim.buoyancy_view(out).unwrap())),
        (vector(&mut sim, |sim, out| sim.repulsion(out)), six(sim.repulsion_view(out).unwrap())),
        (vector(&mut sim, |sim, out| sim.circulation_gradient(out)), six(sim.circulation_gradient_view(out).unwrap())),
    ];
    for (slice, view) in vectors {
        assert_eq!(slice, view.as_slice());
        assert!(view.iter().any(|x| *x != R::zero()), "nothing is compared: {view:?}");
    }
}

#[test]
fn views_hold_the_numbers_of_the_slices_in_both_precisions() {
    same_numbers_in_the_same_places::<f64>();
    same_numbers_in_the_same_places::<f32>();
}

fn accelerations_from_views<R: Real + RealField>(tolerance: f64) {
    let mut sim = two::<R>();
    let mut sim = sim.view();
    let (mut mass, mut gyroscopic) = ([R::NAN; 36], [R::NAN; 36]);
    let (mass, gyroscopic) = (sim.mass_matrix_view(&mut mass).unwrap(), sim.gyroscopic_view(&mut gyroscopic).unwrap());
    let velocities = six(sim.velocities_view());
    // M q̈ + ⟨Γ, q̇, q̇⟩ + ∂P/∂q + ∂V/∂q + ∂T_c/∂q − G q̇ = 0; the views live side by side.
    let mut memory = [[R::NAN; 6]; 5];
    let [christoffel, buoyancy, repulsion, circulation, accelerations] = &mut memory;
    let forces = six(sim.christoffel_view(christoffel).unwrap())
        + sim.buoyancy_view(buoyancy).unwrap().fixed_rows::<6>(0)
        + sim.repulsion_view(repulsion).unwrap().fixed_rows::<6>(0)
        + sim.circulation_gradient_view(circulation).unwrap().fixed_rows::<6>(0)
        - square(gyroscopic) * velocities;
    let mass = square(mass);
    assert_eq!(mass, mass.transpose());
    let solved = mass.cholesky().expect("M is positive definite").solve(&-forces);
    let accelerations = six(sim.accelerations_view(accelerations).unwrap());
    assert_close(solved.as_slice(), accelerations.as_slice(), tolerance);
}

#[test]
fn the_equation_of_motion_holds_for_the_views() {
    accelerations_from_views::<f64>(1e-13);
    accelerations_from_views::<f32>(1e-4);
}

#[test]
fn the_gyroscopic_matrix_is_antisymmetric_and_acts_from_the_left() {
    let mut sim = two::<f64>();
    let mut sim = sim.view();
    let mut buffer = [0.0; 36];
    let g = square(sim.gyroscopic_view(&mut buffer).unwrap());
    assert!(g.norm() > 0.1 && (g + g.transpose()).norm() < 1e-12 * g.norm(), "{g}");
}

#[test]
fn a_lone_body_with_circulation_is_pushed_to_the_side_that_lift_says() {
    // Kutta and Joukowski: a disc in unbounded fluid with circulation Γ (counter-clockwise) that moves with u along x is pushed to its
    // left, by ρ Γ u along y; as a matrix: entries (1, 0) and (0, 1), of opposite sign. Rows and columns exchanged would turn it round.
    let mut held = [0.0; 36];
    let far = [[Link { circulation: 0.7, ..link(disc(0.5), 1.3, 40) }], [link(disc(0.5), 1.3, 40)]];
    let bodies = [body(&far[0], [0.0; 3], [0.3, 0.0, 0.0]), body(&far[1], [1e3, 0.0, 0.0], [0.0; 3])];
    let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(2.0, 0.0) });
    let mut sim = sim.view();
    let g = square(sim.gyroscopic_view(&mut held).unwrap());
    let mass = square(sim.mass_matrix_view(&mut [0.0; 36]).unwrap());
    let mut out = [0.0; 6];
    let force = mass * six(sim.accelerations_view(&mut out).unwrap());
    assert_near(g[(1, 0)], 2.0 * 0.7, 1e-2);
    assert_near(force[1], g[(1, 0)] * 0.3, 1e-2);
}

type Asked<'s> = fn(&mut Sim<'s, f64>, &mut [f64]) -> Result<usize>;

#[test]
fn a_buffer_of_another_length_is_refused() {
    let mut sim = two::<f64>();
    let mut sim = sim.view();
    let asked: [(usize, Asked<'_>); 8] = [
        (36, |sim, out| sim.mass_matrix_view(out).map(|m| m.len())),
        (36, |sim, out| sim.added_mass_view(out).map(|m| m.len())),
        (36, |sim, out| sim.gyroscopic_view(out).map(|m| m.len())),
        (6, |sim, out| sim.accelerations_view(out).map(|v| v.len())),
        (6, |sim, out| sim.christoffel_view(out).map(|v| v.len())),
        (6, |sim, out| sim.buoyancy_view(out).map(|v| v.len())),
        (6, |sim, out| sim.repulsion_view(out).map(|v| v.len())),
        (6, |sim, out| sim.circulation_gradient_view(out).map(|v| v.len())),
    ];
    for (needed, ask) in asked {
        assert_eq!(ask(&mut sim, &mut vec![0.0; needed]), Ok(needed));
        for given in [0, 1, needed - 1, needed + 1, 2 * needed] {
            let refused = ask(&mut sim, &mut vec![0.0; given]).map_err(|e| (e.status, e.what, e.value));
            assert_eq!(refused, Err((Status::Length, "length", given as f64)));
        }
    }
}
