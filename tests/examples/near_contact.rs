//! Errors of added mass and force near contact: the table of docs/accuracy.md, as CSV.

use nekton::Sim;
use nekton::scene::{Body, Quadrature, Scene, Shape, Wall};
use nekton_tests::{at_start, body, disc, link, matrix, vector, wall};

struct Pair {
    name: &'static str,
    shapes: [Shape<'static, f64>; 2],
    /// Place and heading of the second body at a gap.
    place: fn(f64) -> [f64; 3],
    first: [f64; 3],
    tank: Option<(Shape<'static, f64>, [f64; 2])>,
    obstacle: Option<(Shape<'static, f64>, [f64; 2])>,
}

fn setup<T>(
    case: &Pair,
    gap: f64,
    nodes: usize,
    quadrature: Quadrature,
    then: impl FnOnce(&mut Sim<'_, f64>) -> T,
) -> T {
    let links = case.shapes.map(|s| [link(s, 1.0, nodes)]);
    let velocities = [[0.3, -0.5, 0.7], [-0.2, 0.4, 0.9]];
    let poses = [case.first, (case.place)(gap)];
    let bodies: Vec<Body<'_, f64>> = (0..2).map(|i| body(&links[i], poses[i], velocities[i])).collect();
    let bodies = if case.tank.is_some() && case.obstacle.is_none() { &bodies[1..] } else { &bodies[..] };
    let tank = case.tank.map(|(s, p)| wall(s, p, 0.0, nodes));
    let obstacles: Vec<Wall<'_, f64>> = case.obstacle.iter().map(|(s, p)| wall(*s, *p, 0.0, nodes)).collect();
    let bodies = if case.tank.is_none() && case.obstacle.is_some() { &bodies[1..] } else { bodies };
    let scene = Scene { quadrature, tank, obstacles: &obstacles, bodies, ..Scene::new(1.0, 0.0) };
    let mut sim = at_start(&scene);
    then(&mut sim.view())
}

fn evaluate(case: &Pair, gap: f64, nodes: usize, quadrature: Quadrature) -> (Vec<f64>, Vec<f64>, [f64; 2]) {
    setup(case, gap, nodes, quadrature, evaluation)
}

fn evaluation(sim: &mut Sim<'_, f64>) -> (Vec<f64>, Vec<f64>, [f64; 2]) {
    let mass = matrix(sim, |s, out| s.added_mass(out)).concat();
    let force = vector(sim, |s, out| s.christoffel(out));
    let r = sim.resolution().unwrap();
    (mass, force, [r.mass, r.force])
}

/// The parameter of `place` at which the smallest gap is as wanted.
fn parameter(case: &Pair, gap: f64) -> f64 {
    let mut g = gap + 0.2;
    for _ in 0..60 {
        g += gap - setup(case, g, 64, Quadrature::Plain, |sim| sim.gap().distance);
    }
    g
}

fn error(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / size
}

const fn ellipse(a: f64, b: f64) -> Shape<'static, f64> {
    Shape::Ellipse { a, b }
}

fn main() {
    let none = None;
    let cases = [
        Pair {
            name: "discs",
            shapes: [disc(1.0), disc(1.0)],
            place: |g| [2.0 + g, 0.0, 0.0],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "turned",
            shapes: [disc(1.0), disc(1.0)],
            place: |g| [2.0 + g, 0.0, 1.234],
            first: [0.0, 0.0, -2.345],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "ellipses",
            shapes: [ellipse(1.0, 0.5), ellipse(0.7, 0.4)],
            place: |g| [0.2, 0.5 + 0.4 + g, 0.1],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "wall",
            shapes: [ellipse(1.0, 0.5), ellipse(1.0, 0.5)],
            place: |g| [0.3, 1.5 - 0.5 - g, 0.0],
            first: [0.0; 3],
            tank: Some((ellipse(2.0, 1.5), [0.3, 0.0])),
            obstacle: none,
        },
        Pair {
            name: "flat1:10",
            shapes: [ellipse(1.0, 0.1), ellipse(1.0, 0.1)],
            place: |g| [0.1, 0.2 + g, 0.0],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "flat1:10obl",
            shapes: [ellipse(1.0, 0.1), ellipse(1.0, 0.1)],
            place: |g| [0.3, 0.27 + g, 0.15],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "flat1:100",
            shapes: [ellipse(1.0, 0.01), ellipse(1.0, 0.01)],
            place: |g| [0.1, 0.02 + g, 0.0],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "rect1%",
            shapes: [Shape::Rectangle { width: 2.0, height: 0.2, radius: Some(0.002) }; 2],
            place: |g| [0.0, 0.2 + g, 0.0],
            first: [0.0; 3],
            tank: none,
            obstacle: none,
        },
        Pair {
            name: "corner1%",
            shapes: [ellipse(0.5, 0.1); 2],
            place: |g| [0.1, 1.0 + 0.1 + g, 0.0],
            first: [0.0; 3],
            tank: none,
            obstacle: Some((Shape::Rectangle { width: 2.0, height: 2.0, radius: Some(0.02) }, [0.0, 0.0])),
        },
        Pair {
            name: "tank+obst",
            shapes: [ellipse(0.4, 0.2), ellipse(0.3, 0.3)],
            place: |_| [0.9, 0.5, 0.4],
            first: [-1.2, 0.3, 0.3],
            tank: Some((ellipse(2.5, 2.0), [0.0, 0.0])),
            obstacle: Some((disc(0.3), [0.1, -0.9])),
        },
    ];
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!("case,gap,nodes,mass,force,asym_mass,asym_force");
    for case in cases.iter().filter(|c| wanted.is_empty() || wanted.iter().any(|w| c.name == w)) {
        for gap in [0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let at = if case.name == "tank+obst" { gap } else { parameter(case, gap) };
            let (m, f, _) = evaluate(case, at, 320, Quadrature::Graded);
            for nodes in [32, 48, 64, 96, 128, 160, 192] {
                let (mass, force, r) = evaluate(case, at, nodes, Quadrature::Graded);
                println!(
                    "{},{gap:e},{nodes},{:.1e},{:.1e},{:.1e},{:.1e}",
                    case.name,
                    error(&mass, &m),
                    error(&force, &f),
                    r[0],
                    r[1]
                );
            }
        }
    }
}
