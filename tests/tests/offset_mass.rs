//! Bodies whose centre of mass lies beside their centroid, where every arm counts: weight and buoyancy, circulation.

use nekton::scene::{Link, Mass, Scene, Shape};
use nekton::{Formulation, Sim};
use nekton_tests::*;
use std::f64::consts::PI;

/// Of a body with a disc's outline.
const RADIUS: f64 = 0.6;
const MASS: f64 = 2.1;
const INERTIA: f64 = 0.4;
/// Centre of mass from the centroid.
const CENTRE: [f64; 2] = [0.25, -0.1];
const GAMMA: f64 = 1.7;
/// Density of the fluid.
const FLUID: f64 = 1.2;

const POSE: [f64; 3] = [0.3, -0.2, 0.7];
const VELOCITY: [f64; 3] = [0.4, 0.1, 0.9];

fn offset<'a>(shape: Shape<'a, f64>, nodes: usize, circulation: f64) -> [Link<'a, f64>; 1] {
    let mass = Mass::Given { mass: MASS, inertia: INERTIA, centre_of_mass: CENTRE };
    [Link { mass, circulation, ..link(shape, 0.0, nodes) }]
}

/// World vector from the centre of mass to the centroid.
fn arm(heading: f64) -> [f64; 2] {
    let (s, c) = heading.sin_cos();
    [-(c * CENTRE[0] - s * CENTRE[1]), -(s * CENTRE[0] + c * CENTRE[1])]
}

/// Placement and velocity of the centroid.
fn centroid(q: &[f64], v: &[f64]) -> ([f64; 2], [f64; 2]) {
    let a = arm(q[2]);
    ([q[0] + a[0], q[1] + a[1]], [v[0] - v[2] * a[1], v[1] + v[2] * a[0]])
}

#[test]
fn buoyancy_acts_at_the_centroid_and_weight_at_the_centre_of_mass() {
    // Tilted bodies of two links: ∂P/∂q by (2.16), from the areas alone, and by differences of the potential.
    let gravity = 9.81;
    let bean =
        [[0.6, 0.0], [0.5, 0.4], [0.1, 0.35], [-0.3, 0.5], [-0.6, 0.2], [-0.5, -0.3], [0.0, -0.5], [0.45, -0.35]];
    let links = [offset(Shape::Ellipse { a: 0.8, b: 0.4 }, 16, 0.0), offset(Shape::curve(&bean), 32, 0.0)];
    let bodies = [body(&links[0], POSE, VELOCITY), body(&links[1], [2.5, 0.4, -1.9], [0.0; 3])];
    for bodies in [&bodies[..1], &bodies] {
        let scene = Scene { bodies, ..Scene::new(FLUID, gravity) };
        let mut sim = at_start(&scene);
        let mut sim = sim.view();
        let force = vector(&mut sim, |sim, out| sim.buoyancy(out));
        let mut exact = Vec::new();
        for i in 0..bodies.len() {
            let displaced = FLUID * sim.model().link(i).unwrap().area;
            let heading = sim.positions()[3 * i + 2];
            exact.extend([0.0, gravity * (MASS - displaced), -gravity * displaced * arm(heading)[0]]);
        }
        assert_close(&force, &exact, 1e-14);
        let slopes = derivatives(&scene, |sim| vec![sim.energy().unwrap().buoyancy]).concat();
        assert_close(&force, &slopes, 1e-11);
        // It turns the body from rest as it does in the table of forces.
        let still = bodies.iter().map(|body| nekton::scene::Body { velocity: [0.0; 3], ..*body }).collect::<Vec<_>>();
        let mut sim = at_start(&Scene { bodies: &still, ..scene });
        let mut sim = sim.view();
        let accelerations = vector(&mut sim, |sim, out| sim.accelerations(out));
        let pushed = times(&matrix(&mut sim, |sim, out| sim.mass_matrix(out)), &accelerations);
        assert_close(&pushed, &force.iter().map(|f| -f).collect::<Vec<_>>(), 1e-13);
    }
}

#[test]
fn a_lopsided_disc_swings_about_its_buoyancy_like_a_pendulum() {
    // Neutrally buoyant, a disc turns about a point between centre of mass and centroid: with ma = ρπa² and the reduced mass
    // μ = m ma/(m + ma) of the arm c, (I + μ c²) θ″ = g m_f c₁, and the sum of momenta stays zero.
    let area = PI * RADIUS * RADIUS;
    let (added, gravity) = (FLUID * area, 3.0);
    let mass = Mass::Given { mass: added, inertia: INERTIA, centre_of_mass: CENTRE };
    let links = [Link { mass, ..link(disc(RADIUS), 0.0, 32) }];
    let bodies = [body(&links, POSE, [0.0; 3])];
    let square = CENTRE[0] * CENTRE[0] + CENTRE[1] * CENTRE[1];
    let inertia = INERTIA + 0.5 * added * square;
    let rate = |y: [f64; 2]| [y[1], gravity * added * arm(y[0])[0] / inertia];
    let (steps, duration) = (4000, 2.0);
    let (mut y, h) = ([POSE[2], 0.0], duration / f64::from(steps));
    for _ in 0..steps {
        let shifted = |k: [f64; 2], c: f64| [y[0] + c * k[0], y[1] + c * k[1]];
        let k1 = rate(y);
        let k2 = rate(shifted(k1, h / 2.0));
        let k3 = rate(shifted(k2, h / 2.0));
        let k4 = rate(shifted(k3, h));
        y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    for shortcuts in [true, false] {
        let mut sim = simulation(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, gravity) }, adams(1e-12));
        let mut sim = sim.view();
        sim.advance(duration).unwrap();
        assert!((y[0] - POSE[2]).abs() > 0.5, "it hardly swings: {y:?}");
        assert_near(sim.positions()[2], y[0], 1e-10);
        assert_near(sim.velocities()[2], y[1], 1e-10);
        // The middle between centre of mass and centroid rests.
        let middle = |heading: f64| arm(heading).map(|a| 0.5 * a);
        let (now, start) = (middle(y[0]), middle(POSE[2]));
        for k in 0..2 {
            assert_near(sim.positions()[k] + now[k], POSE[k] + start[k], 1e-10);
        }
    }
}

#[test]
fn circulation_about_a_lopsided_disc_lifts_at_its_centre() {
    // The lift ργ i v_c of the centre's velocity v_c = v + iω c acts at the centre: G q̇ = ργ (i v_c, c·v_c).
    let links = offset(disc(RADIUS), 32, GAMMA);
    let bodies = [body(&links, POSE, VELOCITY)];
    for shortcuts in [true, false] {
        let mut sim = at_start(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.0) });
        let mut sim = sim.view();
        assert_eq!(sim.model().plan().formulation == Formulation::Kirchhoff, shortcuts);
        let (c, (_, v)) = (arm(POSE[2]), centroid(&POSE, &VELOCITY));
        let strength = FLUID * GAMMA;
        let exact = [-strength * v[1], strength * v[0], strength * (c[0] * v[0] + c[1] * v[1])];
        let g = matrix(&mut sim, |sim, out| sim.gyroscopic(out));
        assert_close(&times(&g, &VELOCITY), &exact, 1e-14);
        // M q̈ + ⟨Γ, q̇, q̇⟩ = G q̇.
        let accelerations = vector(&mut sim, |sim, out| sim.accelerations(out));
        let christoffel = vector(&mut sim, |sim, out| sim.christoffel(out));
        let mut force = times(&matrix(&mut sim, |sim, out| sim.mass_matrix(out)), &accelerations);
        force.iter_mut().zip(&christoffel).for_each(|(f, c)| *f += c);
        assert_close(&force, &exact, 1e-13);
    }
}

/// What a lopsided circulating disc keeps, by hand: with m_a = ρπa² at the centre c, m v + m_a v_c − iργ c and
/// I ω + r × m v + c × m_a v_c − ργ |c|²/2; and its energy.
fn kept(sim: &Sim<'_, f64>) -> [f64; 4] {
    let (q, v) = (sim.positions(), sim.velocities());
    let (c, u) = centroid(q, v);
    let added = FLUID * PI * RADIUS * RADIUS;
    let strength = FLUID * GAMMA;
    let cross = |a: &[f64], b: &[f64]| a[0] * b[1] - a[1] * b[0];
    [
        MASS * v[0] + added * u[0] + strength * c[1],
        MASS * v[1] + added * u[1] - strength * c[0],
        INERTIA * v[2] + MASS * cross(q, v) + added * cross(&c, &u) - strength * 0.5 * (c[0] * c[0] + c[1] * c[1]),
        0.5 * (MASS * (v[0] * v[0] + v[1] * v[1]) + added * (u[0] * u[0] + u[1] * u[1]) + INERTIA * v[2] * v[2]),
    ]
}

#[test]
fn a_lopsided_circulating_disc_keeps_impulse_and_energy_as_computed_by_hand() {
    let links = offset(disc(RADIUS), 32, GAMMA);
    let bodies = [body(&links, POSE, VELOCITY)];
    for shortcuts in [true, false] {
        let mut sim = simulation(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.0) }, adams(1e-12));
        let mut sim = sim.view();
        let start = kept(&sim);
        for k in 0..=5 {
            sim.advance(0.8 * f64::from(k)).unwrap();
            assert_close(&kept(&sim), &start, 2e-11);
            // What is told is that, and of the flow's own −ργ a²/2.
            let (told, energy) = (sim.impulse().unwrap(), sim.energy().unwrap());
            let own = FLUID * GAMMA * 0.5 * RADIUS * RADIUS;
            assert_close(&told[..2], &start[..2], 2e-11);
            assert_near(told[2], start[2] - own, 2e-11);
            assert_near(energy.kinetic_bodies + energy.kinetic_fluid, start[3], 2e-11);
        }
    }
}

#[test]
fn a_lone_circulating_body_without_symmetry_moves_as_on_the_general_path() {
    let bean =
        [[0.6, 0.0], [0.5, 0.4], [0.1, 0.35], [-0.3, 0.5], [-0.6, 0.2], [-0.5, -0.3], [0.0, -0.5], [0.45, -0.35]];
    let star = Shape::Star { radius: 0.6, amplitude: 0.15, lobes: 3 };
    for shape in [disc(RADIUS), Shape::Ellipse { a: 0.7, b: 0.4 }, star, Shape::curve(&bean)] {
        let links = offset(shape, 96, GAMMA);
        let bodies = [body(&links, POSE, VELOCITY)];
        let [short, general] = [true, false].map(|shortcuts| {
            let mut sim = simulation(&Scene { shortcuts, bodies: &bodies, ..Scene::new(FLUID, 0.7) }, adams(1e-11));
            let mut sim = sim.view();
            let (before, forces) = (sim.impulse().unwrap(), matrix(&mut sim, |sim, out| sim.gyroscopic(out)).concat());
            sim.advance(2.0).unwrap();
            (sim.positions().to_vec(), before, forces)
        });
        assert_close(&short.0, &general.0, 1e-9);
        assert_close(&short.1, &general.1, 1e-9);
        assert_close(&short.2, &general.2, 1e-9);
    }
}
