//! Added mass of NACA sections through 161 points with default nodes, against 2000 nodes: `cargo run --release -p nekton-tests --example
//! sections > docs/accuracy/sections.csv`. Twenty sections of four digits, each with a sharp and a blunt tail.

use nekton::scene::{Scene, Shape};
use nekton::{ModelBuf, SimBuf};
use nekton_tests::{adams, body, link, matrix};
use std::f64::consts::TAU;
use std::time::Instant;

/// Points from the tail along the upper surface and back, by cosine spacing; the nose is point 80.
fn section([camber, place, thickness]: [f64; 3], tail: f64) -> Vec<[f64; 2]> {
    let point = |k: usize| {
        let x = 0.5 * (1.0 + (TAU * k as f64 / 160.0).cos());
        let half = 5.0 * thickness * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - tail * x))));
        let (line, slope) = if place == 0.0 {
            (0.0, 0.0)
        } else if x < place {
            let scale = camber / (place * place);
            (scale * (2.0 * place * x - x * x), 2.0 * scale * (place - x))
        } else {
            let scale = camber / ((1.0 - place) * (1.0 - place));
            (scale * (1.0 - 2.0 * place + 2.0 * place * x - x * x), 2.0 * scale * (place - x))
        };
        let (s, c) = slope.atan().sin_cos();
        let side = if k <= 80 { 1.0 } else { -1.0 };
        [x - side * half * s, line + side * half * c]
    };
    (0..=160).map(point).collect()
}

struct Looked {
    mass: Vec<f64>,
    nodes: usize,
    bound: f64,
    noticed: bool,
    seconds: f64,
}

fn look(points: &[[f64; 2]], nodes: usize) -> Result<Looked, nekton::Error> {
    let links = [link(Shape::curve(points), 0.0, nodes)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let start = Instant::now();
    let model = ModelBuf::new(&Scene { bodies: &bodies, allow_unresolved: nodes > 0, ..Scene::new(1.0, 0.0) })?;
    let seconds = start.elapsed().as_secs_f64();
    let mut sim = SimBuf::new(model.into(), adams(1e-6))?;
    let mut sim = sim.view();
    let mass = matrix(&mut sim, |s, out| s.added_mass(out)).concat();
    let nodes = sim.model().link(0).map_or(0, |l| l.nodes);
    Ok(Looked { mass, nodes, bound: sim.resolution()?.bound(), noticed: sim.notice().is_some(), seconds })
}

fn main() {
    println!("section,tail,nodes,m11,m22,m33,largest_error,bound,noticed,seconds");
    let mut worst = 0.0_f64;
    for digits in [
        "0006", "0009", "0012", "0015", "0018", "0024", "1408", "1412", "2408", "2412", "2415", "2424", "4409", "4412",
        "4415", "4424", "6409", "6412", "6415", "6716",
    ] {
        let part = |range: std::ops::Range<usize>| digits[range].parse::<f64>().unwrap_or(0.0);
        let numbers = [0.01 * part(0..1), 0.1 * part(1..2), 0.01 * part(2..4)];
        for (tail, coefficient) in [("sharp", 0.1036), ("blunt", 0.1015)] {
            let points = section(numbers, coefficient);
            match (look(&points, 0), look(&points, 2000)) {
                (Ok(here), Ok(fine)) => {
                    let scale = |k: usize| (fine.mass[4 * (k / 3)] * fine.mass[4 * (k % 3)]).sqrt();
                    let error = (0..9).fold(0.0_f64, |m, k| m.max((here.mass[k] - fine.mass[k]).abs() / scale(k)));
                    worst = worst.max(if here.noticed { 0.0 } else { error });
                    println!(
                        "{digits},{tail},{},{:.8},{:.8},{:.8},{error:.1e},{:.1e},{},{:.2}",
                        here.nodes,
                        here.mass[0],
                        here.mass[4],
                        here.mass[8],
                        here.bound,
                        if here.noticed { "yes" } else { "no" },
                        here.seconds
                    );
                }
                (Err(error), _) | (_, Err(error)) => println!("{digits},{tail},,,,,,,{error},"),
            }
        }
    }
    eprintln!("largest error that was not noticed: {worst:.1e}");
}
