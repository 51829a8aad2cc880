//! What the examples in C and the README's program must print, computed by the library without the C interface: the same
//! numbers to the last bit.

use crate::{adams, body, hinged, link, simulation, wall};
use nekton::scene::{Body, Drive, Harmonic, Link, Scene, Shape, Signal};
use nekton::status::Result;
use nekton::{Formulation, Method, Parameter, Sim};

mod lqr;

/// One line of output: the numbers in it.
pub type Lines = Vec<Vec<f64>>;

/// The lines of an example, by its name.
pub fn lines(example: &str) -> Option<Lines> {
    match example {
        "version_and_plan" => version_and_plan(),
        "one_body_static" => one_body(),
        "two_ellipses" => two_ellipses(),
        "swimmer_prescribed" | "swimmer" => swimmer(),
        "swimmer_closed_loop" => closed_loop(),
        "own_integrator" => own_integrator(),
        "parallel_rollouts" => rollouts(),
        "lqr" => lqr::lines(),
        "fish" => fish(),
        "coasting" => coasting(),
        _ => return None,
    }
    .ok()
}

/// The numbers in what an example printed; a line may begin with a name. Messages are left out.
pub fn numbers(printed: &str) -> Lines {
    let numbers = |line: &str| line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    printed.lines().filter(|line| !line.starts_with("refused: ")).map(numbers).collect()
}

fn ellipse(a: f64, b: f64, density: f64, nodes: usize) -> Link<'static, f64> {
    link(Shape::Ellipse { a, b }, density, nodes)
}

fn harmonic(amplitude: f64, frequency: f64, phase: f64) -> [Harmonic<f64>; 1] {
    [Harmonic { amplitude, frequency, phase, offset: 0.0 }]
}

fn motion(terms: &[Harmonic<f64>]) -> Drive<'_, f64> {
    Drive::Motion(Signal::Harmonic { terms, window: None })
}

fn of<'a>(bodies: &'a [Body<'a, f64>]) -> Scene<'a, f64> {
    Scene { bodies, ..Scene::new(1.0, 0.0) }
}

fn placed(sim: &Sim<'_, f64>, before: &[f64]) -> Vec<f64> {
    before.iter().chain(sim.positions()).copied().collect()
}

fn version_and_plan() -> Result<Lines> {
    let beats = [harmonic(0.5, 2.0, 0.0), harmonic(0.5, 2.0, 1.5)];
    let part = ellipse(1.0, 0.4, 1.0, 48);
    let on = |parent: usize| hinged(part, parent, [-1.2, 0.0], [1.2, 0.0], motion(&beats[parent]));
    let links = [part, on(0), on(1)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let mut sim = simulation(&of(&bodies), adams(1e-8));
    let mut sim = sim.view();
    let plan = *sim.model().plan();
    let resolution = sim.resolution()?;
    assert_eq!(plan.formulation, Formulation::LockedMomentum);
    let counts = [plan.links, sim.model().joint_count(), 3 * plan.links, plan.state_len, plan.unknowns];
    // Version of the interface, heap; status, body, link and value of the error; formulation.
    let mut lines: Lines = [2, 1, -5, 0, 2, 47, 2].into_iter().map(|n| vec![f64::from(n)]).collect();
    lines.extend(counts.into_iter().chain([plan.right_hand_sides]).map(|n| vec![n as f64]));
    lines.extend([vec![plan.operations], vec![resolution.mass, resolution.force]]);
    Ok(lines)
}

fn one_body() -> Result<Lines> {
    let links = [ellipse(0.5, 0.1, 1500.0, 32)];
    let bodies = [body(&links, [0.0, 0.0, 0.4], [0.0; 3])];
    let scene = Scene { bodies: &bodies, ..Scene::new(1000.0, 9.81) };
    let mut sim = simulation(&scene, Method::Rk4 { step: 0.01 });
    let mut sim = sim.view();
    let line = |i| {
        sim.advance(0.2 * f64::from(i))?;
        Ok(placed(&sim, &[sim.time()]))
    };
    (1..=10).map(line).collect()
}

fn two_ellipses() -> Result<Lines> {
    let links = [ellipse(2.0, 0.9, 1.0, 64)];
    let bodies = [1.0, -1.0].map(|side| body(&links, [2.0 * side, -1.1 * side, 0.0], [-0.5 * side, 0.0, 0.0]));
    let mut sim = simulation(&of(&bodies), adams(1e-9));
    let mut sim = sim.view();
    let line = |i| {
        let t = 0.5 * f64::from(i);
        sim.advance_dense(t, 4.0)?;
        let energy = sim.energy()?.total;
        let gap = sim.gap().distance;
        Ok([placed(&sim, &[t]), vec![gap, energy]].concat())
    };
    (1..=8).map(line).collect()
}

fn swimmer() -> Result<Lines> {
    let (front, rear) = (harmonic(-1.0, 1.0, std::f64::consts::FRAC_PI_2), harmonic(1.0, 1.0, 0.0));
    let part = ellipse(1.0, 0.1, 1.0, 64);
    let links = [
        part,
        hinged(part, 0, [-1.2, 0.0], [1.2, 0.0], motion(&front)),
        hinged(part, 0, [1.2, 0.0], [-1.2, 0.0], motion(&rear)),
    ];
    let velocity = [-0.43406482698683885, -0.22678503735025515, -0.3446110319592447];
    let bodies = [body(&links, [0.0; 3], velocity)];
    let mut sim = simulation(&of(&bodies), adams(1e-8));
    let mut sim = sim.view();
    let line = |i| {
        let t = f64::from(i) * std::f64::consts::PI / 4.0;
        sim.advance(t)?;
        let (mut torque, mut power) = ([0.0; 2], [0.0; 2]);
        sim.joint_torques(&mut torque, &mut power)?;
        Ok([&[t][..], &sim.positions()[..3], &torque[..]].concat())
    };
    (1..=8).map(line).collect()
}

fn closed_loop() -> Result<Lines> {
    let beat = harmonic(0.3, 5.0, 0.0);
    let neck = Drive::Torque { torque: Signal::Channel, stiffness: 0.0, damping: 0.2, rest: 0.0, start: [0.0; 2] };
    let beat = Signal::Harmonic { terms: &beat, window: None };
    let fin = Drive::Torque { torque: beat, stiffness: 0.6, damping: 0.1, rest: 0.0, start: [0.0; 2] };
    let links = [
        ellipse(0.6, 0.3, 1.0, 32),
        hinged(ellipse(0.8, 0.3, 1.0, 32), 0, [-0.6 - 0.1, 0.0], [0.8 + 0.1, 0.0], neck),
        hinged(ellipse(0.5, 0.1, 1.0, 32), 1, [-0.8 - 0.1, 0.0], [0.5 + 0.1, 0.0], fin),
    ];
    let bodies = [body(&links, [0.0, 0.0, 0.3], [0.0; 3])];
    let mut sim = simulation(&of(&bodies), Method::Rk4 { step: 0.01 });
    let mut sim = sim.view();
    let (mut lines, mut torque) = (Lines::new(), 0.0);
    for i in 0..400 {
        let t = 0.01 * f64::from(i);
        let (heading, rate) = (sim.positions()[2], sim.velocities()[2]);
        if i % 50 == 0 {
            lines.push([&[t][..], &sim.positions()[..3], &[torque]].concat());
        }
        torque = 4.0 * (heading - 0.0) + 4.0 * rate;
        let end = 0.01 * f64::from(i + 1);
        sim.set_channel(0, [t, torque, 0.0, 0.0], [end, torque, 0.0, 0.0])?;
        sim.advance(end)?;
    }
    lines.push([&[4.0][..], &sim.positions()[..3], &[torque]].concat());
    // What the example is about.
    let heading = lines.last().map_or(f64::NAN, |line| line[3]);
    assert!(heading.abs() < 0.05, "the fish does not hold its course: {heading}");
    Ok(lines)
}

fn own_integrator() -> Result<Lines> {
    let tank = wall(Shape::Ellipse { a: 2.0, b: 2.0 }, [0.0; 2], 0.0, 64);
    let links = [ellipse(0.6, 0.3, 1.2, 32)];
    let bodies = [body(&links, [0.5, 0.0, 0.3], [-0.4, 0.3, 0.5])];
    let scene = Scene { tank: Some(tank), gravity: 0.5, ..of(&bodies) };
    let h = 0.05;
    let mut sim = simulation(&scene, Method::Rk4 { step: h });
    let mut sim = sim.view();
    let mut y = sim.state().to_vec();
    let mut lines = Lines::new();
    for i in 0..40 {
        let mut slope = vec![0.0; y.len()];
        let mut sum = y.clone();
        for (node, weight) in [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)] {
            let stage: Vec<f64> = y.iter().zip(&slope).map(|(y, k)| y + h * node * k).collect();
            sim.rhs(f64::from(i) * h + h * node, &stage, &mut slope)?;
            sum.iter_mut().zip(&slope).for_each(|(s, k)| *s += h * weight * k);
        }
        y = sum;
        if i % 10 == 9 {
            lines.push([&[f64::from(i + 1) * h], &y[..3]].concat());
        }
    }
    sim.advance(40.0 * h)?;
    lines.push(placed(&sim, &[40.0 * h]));
    Ok(lines)
}

fn rollouts() -> Result<Lines> {
    let torque = Drive::Torque { torque: Signal::Channel, stiffness: 0.5, damping: 0.1, rest: 0.0, start: [0.0; 2] };
    let part = ellipse(0.5, 0.2, 1.0, 32);
    let links = [part, hinged(part, 0, [-0.6, 0.0], [0.6, 0.0], torque)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let line = |i| {
        let torque = 0.05 * f64::from(i - 4);
        let mut sim = simulation(&of(&bodies), adams(1e-7));
        let mut sim = sim.view();
        sim.set_channel(0, [0.0, torque, 0.0, 0.0], [0.5, torque, 0.0, 0.0])?;
        sim.advance(1.0)?;
        let q = sim.positions();
        Ok(vec![torque, q[0], q[1], q[2], q[5]])
    };
    (0..8).map(line).collect()
}

/// The README's program.
fn fish() -> Result<Lines> {
    let beat = harmonic(0.5, 2.0, 0.0);
    let part = ellipse(1.0, 0.4, 1.0, 64);
    let links = [part, hinged(part, 0, [-1.3, 0.0], [1.3, 0.0], motion(&beat))];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let mut sim = simulation(&of(&bodies), adams(1e-8));
    let mut sim = sim.view();
    sim.advance(1.0)?;
    Ok(vec![sim.positions()[..3].to_vec()])
}

/// The README's linearization.
fn coasting() -> Result<Lines> {
    let links = [ellipse(1.0, 0.4, 1.0, 0)];
    let bodies = [body(&links, [0.0; 3], [0.5, 0.0, 0.0])];
    let mut sim = simulation(&of(&bodies), adams(1e-9));
    let mut sim = sim.view();
    let mut memory = vec![0.0; Sim::derivative_requirement(&sim.model())?];
    let (mut a, mut b) = ([0.0; 36], [0.0; 6]);
    sim.linearize([Parameter::Wrench(0, 2)], &mut a, &mut b, &mut memory)?;
    Ok(vec![vec![a[5 + 6 * 2], b[5]]])
}
