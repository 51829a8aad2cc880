//! Circulation against closed forms.

use nekton::scene::{CirculationModel, Link, Mass, Scene, Shape};
use nekton_tests::*;
use std::f64::consts::PI;

const RADIUS: f64 = 0.6;
const GAMMA: f64 = 1.7;
/// Densities of the disc and of the fluid.
const BODY: f64 = 1.5;
const FLUID: f64 = 1.2;

/// Where a disc with circulation starts.
const POSE: [f64; 3] = [0.3, -0.2, 0.1];
const VELOCITY: [f64; 3] = [0.4, 0.1, 0.2];

fn circulating_disc() -> [Link<'static, f64>; 1] {
    [Link { circulation: GAMMA, ..link(disc(RADIUS), BODY, 32) }]
}

/// Position of the disc at time `t`, by the linear equation (m + m_a) v' = i ρ γ v − i (m − m_f) g: a trochoid.
fn trochoid(gravity: f64, t: f64) -> [f64; 2] {
    let area = PI * RADIUS * RADIUS;
    let rate = FLUID * GAMMA / ((BODY + FLUID) * area);
    let drift = (BODY - FLUID) * area * gravity / (FLUID * GAMMA);
    // v = drift + w e^{i rate t}
    let w = [VELOCITY[0] - drift, VELOCITY[1]];
    let (s, c) = (rate * t).sin_cos();
    [POSE[0] + drift * t + (w[0] * s + w[1] * (c - 1.0)) / rate, POSE[1] + (w[1] * s - w[0] * (c - 1.0)) / rate]
}

/// Asserts that the disc is on its trochoid throughout three turns.
fn check_trochoid(gravity: f64, shortcuts: bool) {
    let links = circulating_disc();
    let bodies = [body(&links, POSE, VELOCITY)];
    let mut sim = simulation(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, gravity) }, adams(1e-12));
    let mut sim = sim.view();
    for k in 1..=8 {
        let t = f64::from(k);
        sim.advance(t).unwrap();
        let exact = trochoid(gravity, t);
        assert_near(sim.positions()[0], exact[0], 2e-11);
        assert_near(sim.positions()[1], exact[1], 2e-11);
        assert_near(sim.positions()[2], POSE[2] + VELOCITY[2] * t, 1e-13);
    }
}

#[test]
fn disc_with_circulation_circles_at_rho_gamma_over_total_mass() {
    check_trochoid(0.0, true);
    check_trochoid(0.0, false);
}

#[test]
fn heavy_disc_with_circulation_drifts_along_a_trochoid() {
    check_trochoid(2.0, true);
    check_trochoid(2.0, false);
}

#[test]
fn paper_variant_lets_a_lone_disc_go_straight() {
    for shortcuts in [true, false] {
        let links = circulating_disc();
        let bodies = [body(&links, POSE, VELOCITY)];
        let circulation = CirculationModel::Paper;
        let scene = Scene { circulation, shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.0) };
        let mut sim = simulation(&scene, adams(1e-12));
        let mut sim = sim.view();
        sim.advance(4.0).unwrap();
        assert_near(sim.positions()[0], POSE[0] + 4.0 * VELOCITY[0], 5e-15);
        assert_near(sim.positions()[1], POSE[1] + 4.0 * VELOCITY[1], 5e-15);
    }
}

/// A disc of circulation 1 without mass. The fluid resists no rotation of a disc, hence the moment of inertia.
fn vortex_disc(radius: f64, nodes: usize) -> [Link<'static, f64>; 1] {
    let mass = Mass::Given { mass: 0.0, inertia: 1.0, centre_of_mass: [0.0; 2] };
    [Link { mass, circulation: 1.0, ..link(disc(radius), 0.0, nodes) }]
}

/// Speed of a point vortex of strength 1 at `x` in a disc tank.
fn point_vortex_speed(x: f64, tank: f64) -> f64 {
    x / (2.0 * PI * (tank * tank - x * x))
}

#[test]
fn quasi_steady_speed_of_a_massless_disc_tends_to_the_point_vortex() {
    // Without inertia the velocity is the one whose gyroscopic force balances the gradient of the circulatory energy.
    let (x, radius) = (0.7, 2.0);
    let speed = |r: f64| {
        let links = vortex_disc(r, 32);
        let bodies = [body(&links, [x, 0.0, 0.0], [0.0; 3])];
        let tank = Some(wall(disc(radius), [0.0; 2], 0.0, 96));
        let mut sim = at_start(&Scene { tank, bodies: &bodies, ..Scene::new(1.0, 0.0) });
        let mut sim = sim.view();
        let g = matrix(&mut sim, |sim, out| sim.gyroscopic(out));
        let force = vector(&mut sim, |sim, out| sim.circulation_gradient(out));
        let plane: Vec<Vec<f64>> = g[..2].iter().map(|column| column[..2].to_vec()).collect();
        let v = solve(&plane, &force[..2]);
        assert_near(v[0], 0.0, 1e-16);
        v[1]
    };
    assert_near(speed(0.05), 0.0317177, 6e-8);
    // The error falls as r².
    let exact = point_vortex_speed(x, radius);
    let errors = [0.1, 0.05, 0.025].map(|r| speed(r) - exact);
    println!("errors {errors:?}");
    for pair in errors.windows(2) {
        assert_near(pair[0] / pair[1], 4.0, 0.1);
    }
}

#[test]
fn small_massless_disc_follows_the_point_vortex_round_the_tank() {
    let (x, radius, r, t) = (0.7, 2.0, 0.05, 10.0);
    let speed = point_vortex_speed(x, radius);
    let links = vortex_disc(r, 16);
    let bodies = [body(&links, [x, 0.0, 0.0], [0.0, speed, 0.0])];
    let tank = Some(wall(disc(radius), [0.0; 2], 0.0, 48));
    let mut sim = simulation(&Scene { tank, bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-9));
    let mut sim = sim.view();
    sim.advance(t).unwrap();
    let angle = speed / x * t;
    println!("{:?} against {:?}, {:?}", &sim.positions()[..2], [x * angle.cos(), x * angle.sin()], sim.counters());
    // Finite size: a relative error 7e-4 of the speed, over a path of 0.32.
    assert_near(sim.positions()[0], x * angle.cos(), 3e-4);
    assert_near(sim.positions()[1], x * angle.sin(), 3e-4);
}

#[test]
fn energy_of_a_vortex_disc_in_an_eccentric_tank() {
    // The annulus between eccentric circles is conformal to a concentric one: T_c = ρ γ² Δ/4π with
    // cosh Δ = (R² + a² − d²)/2aR; only differences are compared, a constant is free.
    let (a, radius): (f64, f64) = (0.5, 2.0);
    let exact = |d: f64| {
        let cosh = (radius * radius + a * a - d * d) / (2.0 * a * radius);
        FLUID * GAMMA * GAMMA / (4.0 * PI) * cosh.acosh()
    };
    let energy = |d: f64| {
        let links = [Link { circulation: GAMMA, ..link(disc(a), 1.0, 64) }];
        let bodies = [body(&links, [d, 0.0, 0.0], [0.0; 3])];
        let tank = Some(wall(disc(radius), [0.0; 2], 0.0, 96));
        let mut sim = at_start(&Scene { tank, bodies: &bodies, ..Scene::new(FLUID, 0.0) });
        sim.view().energy().unwrap().circulation
    };
    for d in [0.3, 0.6, 0.9] {
        assert_near(energy(d) - energy(0.0), exact(d) - exact(0.0), 2e-15);
    }
}

#[test]
fn lift_of_a_disc_is_rho_gamma_v_and_does_no_work() {
    let links = circulating_disc();
    let bodies = [body(&links, POSE, VELOCITY)];
    for shortcuts in [true, false] {
        let mut sim = at_start(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.0) });
        let g = matrix(&mut sim.view(), |sim, out| sim.gyroscopic(out));
        let lift = times(&g, &VELOCITY);
        let k = FLUID * GAMMA;
        assert_close(&lift, &[-k * VELOCITY[1], k * VELOCITY[0], 0.0], 1e-15);
    }
}

#[test]
fn lift_of_a_body_that_bends_round_its_own_middle_is_rho_gamma_v_too() {
    // The mean of its nodes lies in the fluid, where no vortex may be put.
    let bay = [[-1.0, -0.8], [1.0, -0.8], [1.0, -0.4], [-0.6, -0.4], [-0.6, 0.4], [1.0, 0.4], [1.0, 0.8], [-1.0, 0.8]];
    let links = [Link { circulation: GAMMA, ..link(Shape::Polygon { vertices: &bay, radius: Some(0.1) }, BODY, 400) }];
    let bodies = [body(&links, POSE, VELOCITY)];
    for shortcuts in [true, false] {
        let mut sim = at_start(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.0) });
        let g = matrix(&mut sim.view(), |sim, out| sim.gyroscopic(out));
        let k = FLUID * GAMMA;
        println!("{:e}", times(&g, &[VELOCITY[0], VELOCITY[1], 0.0])[0] / (-k * VELOCITY[1]) - 1.0);
        let lift = times(&g, &[VELOCITY[0], VELOCITY[1], 0.0]);
        assert_close(&lift[..2], &[-k * VELOCITY[1], k * VELOCITY[0]], 1e-9);
        assert!(sim.view().resolution().unwrap().quadrature < 1e-6);
    }
}
