//! Derivatives of forces and motion against differences of eighth order, identities and closed forms.

use nekton::scene::{
    CirculationModel, Drive, Harmonic, Joint, JointKind, Link, Mass, Quadrature, Repulsion, Scene, Shape, Signal, Wall,
};
use nekton::{Parameter, Sim, SimBuf};
use nekton_tests::*;

mod closed_forms;
mod untouched;

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
    let circulation = vector(sim, |sim, out| sim.circulation_gradient(out));
    let gyroscopic = matrix(sim, |sim, out| sim.gyroscopic(out));
    let velocities = sim.velocities().to_vec();
    let turning = |a: usize| gyroscopic.iter().zip(&velocities).map(|(column, v)| column[a] * v).sum::<f64>();
    let force = |a: usize| circulation[a] - turning(a) + parts.iter().map(|p| p[a]).sum::<f64>();
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

fn everywhere(
    nodes: usize,
    quadrature: Quadrature,
    repulsion: Option<Repulsion<f64>>,
    check: impl Fn(&str, &Scene<'_, f64>),
) {
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
        everywhere(nodes, Quadrature::Plain, None, |place, scene| {
            check(&format!("{place}, {nodes}"), scene, 2e-3, 5e-12)
        });
    }
}

#[test]
fn derivatives_with_circulation_are_those_of_its_force() {
    let mut links = links(24);
    for (link, circulation) in links.iter_mut().zip([0.8, -0.5, 0.3]) {
        link[0].circulation = circulation;
    }
    let bodies: Vec<_> = (0..3).map(|k| body(&links[k], POSES[k], VELOCITIES[k])).collect();
    let obstacles = [Wall { circulation: 0.4, ..obstacle()[0] }];
    let quadrature = Quadrature::Plain;
    let alone = Scene { quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(1.3, 9.81) };
    check("lone, closed form", &Scene { bodies: &bodies[..1], ..alone }, 2e-3, 5e-12);
    check("unbounded", &alone, 2e-3, 1e-10);
    check("obstacle", &Scene { obstacles: &obstacles, ..alone }, 2e-3, 1e-10);
    check_motion("motion with circulation", &alone);
    let paper = Scene { circulation: CirculationModel::Paper, ..alone };
    check("the paper's model", &paper, 2e-3, 1e-10);
}

#[test]
fn derivatives_of_repulsion_are_exact() {
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    everywhere(16, Quadrature::Plain, repulsion, |place, scene| check(place, scene, 2e-3, 5e-12));
    let odd = Some(Repulsion { alpha: 3.3, epsilon: 0.02 });
    everywhere(16, Quadrature::Plain, odd, |place, scene| check(place, scene, 2e-3, 5e-12));
}

#[test]
fn derivatives_with_graded_nodes_are_those_of_the_force_where_space_is_resolved() {
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    everywhere(128, Quadrature::Graded, repulsion, |place, scene| check(place, scene, 2e-3, 1e-10));
}

/// ∂ẏ/∂y and ∂ẏ/∂θ.
fn linearized(sim: &mut Sim<'_, f64>, parameters: &[Parameter]) -> [Vec<f64>; 2] {
    let n = sim.state().len();
    let mut memory = vec![f64::NAN; Sim::derivative_requirement(&sim.model()).unwrap()];
    let (mut a, mut b) = (vec![f64::NAN; n * n], vec![f64::NAN; n * parameters.len()]);
    sim.linearize(parameters.iter().copied(), &mut a, &mut b, &mut memory).unwrap();
    [a, b]
}

/// Columns against differences, each relative to its largest entry.
fn compare(name: &str, found: &[f64], exact: &[Vec<f64>], tolerance: f64) {
    for (k, (found, exact)) in found.chunks_exact(exact[0].len()).zip(exact).enumerate() {
        let scale = exact.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        let error = found.iter().zip(exact).fold(0.0, |m: f64, (f, e)| m.max((f - e).abs())) / scale;
        println!("{name} {k}: {error:.1e}");
        assert!(error <= tolerance, "{name} {k}: {error:.1e}\n{found:?}\n{exact:?}");
    }
}

/// Three links of a swimmer, the second hinged and the third sliding, with anchors off every axis.
fn swimmer(nodes: usize, drives: [Drive<'static, f64>; 2]) -> [Link<'static, f64>; 3] {
    let [[first], [second], [third]] = links(nodes);
    let slider = Joint {
        parent: 1,
        kind: JointKind::Slider { axis: [0.6, 0.8], angle: 0.4 },
        parent_anchor: [0.7, 0.4],
        self_anchor: [-0.8, -0.2],
        drive: drives[1],
    };
    [first, hinged(second, 0, [1.1, 0.2], [-0.7, 0.1], drives[0]), Link { joint: Some(slider), ..third }]
}

const STROKE: Harmonic<f64> = Harmonic { offset: 0.2, amplitude: 0.3, frequency: 0.4, phase: 0.7 };

const STROKES: [Harmonic<f64>; 1] = [STROKE];

fn prescribed() -> Drive<'static, f64> {
    Drive::Motion(Signal::Harmonic { terms: &STROKES, window: None })
}

fn driven() -> Drive<'static, f64> {
    let torque = Signal::Harmonic { terms: &STROKES, window: None };
    Drive::Torque { torque, stiffness: 0.7, damping: 0.3, rest: 0.25, start: [0.5, -0.4] }
}

fn check_motion(name: &str, scene: &Scene<'_, f64>) {
    let mut sim = at_start(scene);
    let mut sim = sim.view();
    let y = sim.state().to_vec();
    let [a, _] = linearized(&mut sim, &[]);
    let exact = by_differences(&y, 2e-3, |y| {
        let mut rates = vec![0.0; y.len()];
        sim.rhs(0.0, y, &mut rates).unwrap();
        rates
    });
    compare(name, &a, &exact, 1e-10);
}

#[test]
fn linearization_of_free_and_articulated_bodies_is_the_derivative_of_the_right_hand_side() {
    for (name, drives) in [
        ("hinge and slider prescribed", [prescribed(), prescribed()]),
        ("torque and prescribed", [driven(), prescribed()]),
        ("prescribed and torque", [prescribed(), driven()]),
    ] {
        let links = swimmer(24, drives);
        let lone = [body(&links, [0.2, -0.1, 0.3], [0.4, -0.3, 0.7])];
        let scene =
            Scene { bodies: &lone, quadrature: Quadrature::Plain, allow_unresolved: true, ..Scene::new(1.3, 0.0) };
        check_motion(&format!("{name}, lone"), &scene);
        let heavy = Scene { gravity: 9.81, ..scene };
        check_motion(&format!("{name}, heavy"), &heavy);
        let other = self::links(24);
        let two = [lone[0], body(&other[0], [0.3, 2.4, 0.7], [0.2, -0.4, 0.5])];
        check_motion(&format!("{name}, beside another"), &Scene { bodies: &two, ..heavy });
        let obstacles = [wall(Shape::Ellipse { a: 0.3, b: 0.5 }, [-1.9, 0.9], 0.4, 32)];
        check_motion(&format!("{name}, beside an obstacle"), &Scene { obstacles: &obstacles, ..scene });
    }
}

#[test]
fn derivatives_by_parameters_are_those_of_other_models() {
    // What is changed in turn.
    type Change = fn(&mut Values, f64);
    struct Values {
        density: f64,
        gravity: f64,
        mass: f64,
        inertia: f64,
        torque: f64,
        stiffness: f64,
        damping: f64,
        rest: f64,
        stroke: Harmonic<f64>,
    }
    let values = || Values {
        density: 1.3,
        gravity: 9.81,
        mass: 0.9,
        inertia: 0.2,
        torque: 0.4,
        stiffness: 0.7,
        damping: 0.3,
        rest: 0.25,
        stroke: STROKE,
    };
    let rates = |v: &Values, look: &mut dyn FnMut(&mut Sim<'_, f64>) -> Vec<f64>| -> Vec<f64> {
        let strokes = [v.stroke];
        let torque = Drive::Torque {
            torque: Signal::Constant(v.torque),
            stiffness: v.stiffness,
            damping: v.damping,
            rest: v.rest,
            start: [0.5, -0.4],
        };
        let mut links = swimmer(24, [torque, torque]);
        if let Some(joint) = &mut links[2].joint {
            joint.drive = Drive::Motion(Signal::Harmonic { terms: &strokes, window: None });
        }
        links[1].mass = Mass::Given { mass: v.mass, inertia: v.inertia, centre_of_mass: [0.05, -0.02] };
        let lone = [body(&links, [0.2, -0.1, 0.3], [0.4, -0.3, 0.7])];
        let quadrature = Quadrature::Plain;
        let scene = Scene { bodies: &lone, quadrature, allow_unresolved: true, ..Scene::new(v.density, v.gravity) };
        let mut sim = at_start(&scene);
        look(&mut sim.view())
    };
    let mut y = Vec::new();
    let parameters = [
        Parameter::FluidDensity,
        Parameter::Gravity,
        Parameter::Mass(1),
        Parameter::Inertia(1),
        Parameter::Torque(0),
        Parameter::Stiffness(0),
        Parameter::Damping(0),
        Parameter::Rest(0),
        Parameter::Position(1),
        Parameter::Rate(1),
        Parameter::Acceleration(1),
    ];
    let b = rates(&values(), &mut |sim| {
        y = sim.state().to_vec();
        linearized(sim, &parameters)[1].clone()
    });
    let n = y.len();
    let column = |k: usize| b[k * n..(k + 1) * n].to_vec();
    let sum =
        |terms: [f64; 3]| -> Vec<f64> { (0..n).map(|i| (0..3).map(|k| terms[k] * b[(8 + k) * n + i]).sum()).collect() };
    let Harmonic { amplitude, frequency: w, phase, .. } = STROKE;
    let (s, c) = phase.sin_cos();
    let cases: [(&str, Vec<f64>, Change); 12] = [
        ("density", column(0), |v, x| v.density += x),
        ("gravity", column(1), |v, x| v.gravity += x),
        ("mass", column(2), |v, x| v.mass += x),
        ("inertia", column(3), |v, x| v.inertia += x),
        ("torque", column(4), |v, x| v.torque += x),
        ("stiffness", column(5), |v, x| v.stiffness += x),
        ("damping", column(6), |v, x| v.damping += x),
        ("rest", column(7), |v, x| v.rest += x),
        ("offset", sum([1.0, 0.0, 0.0]), |v, x| v.stroke.offset += x),
        ("amplitude", sum([s, w * c, -w * w * s]), |v, x| v.stroke.amplitude += x),
        ("frequency", sum([0.0, amplitude * c, -2.0 * amplitude * w * s]), |v, x| v.stroke.frequency += x),
        ("phase", sum([amplitude * c, -amplitude * w * s, -amplitude * w * w * c]), |v, x| v.stroke.phase += x),
    ];
    for (name, found, change) in cases {
        let exact = by_differences(&[0.0], 2e-3, |x| {
            let mut v = values();
            change(&mut v, x[0]);
            rates(&v, &mut |sim| {
                let mut out = vec![0.0; n];
                sim.rhs(0.0, &y, &mut out).unwrap();
                out
            })
        });
        compare(name, &found, &exact, 1e-9);
    }
}
