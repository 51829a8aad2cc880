//! Circulation around outlines without closed form: every force is the derivative of its energy, and the flow is as exact about
//! thin and cornered bodies as about discs.

use nekton::scene::{Corners, Link, Quadrature, Scene, Shape, Wall};
use nekton_tests::*;
use std::f64::consts::TAU;

const CORNER: [[f64; 2]; 6] = [[0.0, 0.0], [1.2, 0.0], [1.2, 0.3], [0.3, 0.3], [0.3, 1.0], [0.0, 1.0]];
const THIN: Shape<'static, f64> = Shape::Rectangle { width: 2.0, height: 0.04, radius: Some(0.01) };
const STAR: Shape<'static, f64> = Shape::Star { radius: 0.6, amplitude: 0.2, lobes: 3 };

/// Points of a symmetric section of chord 2, 12 % thick, with a blunt tail.
fn section() -> Vec<[f64; 2]> {
    let half = |x: f64| {
        let square = x * x;
        1.2 * (0.2969 * x.sqrt() - 0.126 * x - 0.3516 * square + 0.2843 * square * x - 0.1015 * square * square)
    };
    let points = (0..60).map(|k| {
        let (sin, cos) = (TAU * f64::from(k) / 60.0).sin_cos();
        let x = 0.5 * (1.0 + cos);
        [2.0 * x, if sin >= 0.0 { half(x).max(0.008) } else { -half(x).max(0.008) }]
    });
    points.collect()
}

fn circulating(shape: Shape<'_, f64>, circulation: f64, nodes: usize) -> [Link<'_, f64>; 1] {
    [Link { circulation, ..link(shape, 1.0, nodes) }]
}

const BESIDE: [f64; 3] = [1.1, 1.0, 0.3];

/// `check` with the scene of a shape of circulation 1 and, at `at`, an ellipse of circulation −1/2.
fn beside_ellipse<T>(
    shape: Shape<'_, f64>,
    nodes: usize,
    at: [f64; 3],
    quadrature: Quadrature,
    check: impl FnOnce(&Scene<'_, f64>) -> T,
) -> T {
    let first = circulating(shape, 1.0, nodes);
    let second = circulating(Shape::Ellipse { a: 0.6, b: 0.4 }, -0.5, nodes.min(128));
    let bodies = [body(&first, [0.0; 3], [0.1, 0.2, 0.3]), body(&second, at, [0.3, -0.1, 0.5])];
    check(&Scene { quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(1.0, 0.0) })
}

fn gradient(scene: &Scene<'_, f64>) -> Vec<f64> {
    vector(&mut at_start(scene).view(), |sim, out| sim.circulation_gradient(out))
}

/// Greatest error of the gradient against differences of the energy.
fn slope_error(scene: &Scene<'_, f64>) -> f64 {
    let exact = derivatives(scene, |sim| vec![sim.energy().unwrap().circulation]).concat();
    difference(&gradient(scene), &exact)
}

#[test]
fn gradient_of_circulation_is_the_derivative_of_its_energy_around_any_shape() {
    let section = section();
    let shapes = [
        ("star", STAR, 96),
        ("rectangle", Shape::Rectangle { width: 2.0, height: 0.2, radius: Some(0.02) }, 128),
        ("thin rectangle", THIN, 128),
        ("polygon", Shape::Polygon { vertices: &CORNER, radius: Some(0.05) }, 128),
        ("smooth section", Shape::Curve { points: &section, corners: Corners::None }, 256),
        // Its tail is a corner, of 2e-6 of the chord.
        ("section", Shape::curve(&section), 448),
    ];
    for (name, shape, nodes) in shapes {
        // Nodes that stay: exact at any resolution.
        let plain = beside_ellipse(shape, 48, BESIDE, Quadrature::Plain, slope_error);
        // Nodes that follow: where they resolve the flow.
        let graded = beside_ellipse(shape, nodes, BESIDE, Quadrature::Graded, slope_error);
        println!("{name}: plain {plain:.1e}, graded {graded:.1e}");
        assert!(plain <= 5e-12, "{name}: {plain:e}");
        assert!(graded <= 1e-8, "{name}: {graded:e}");
    }
}

#[test]
fn gradient_of_circulation_near_contact_of_a_thin_body_is_exact_or_told() {
    // An ellipse over the flank of the thin rectangle, and before its end.
    for ([x, y], gap) in [([0.3, 0.42], 1e-2), ([0.3, 0.42], 1e-3), ([1.6, 0.0], 1e-3)] {
        let at = if y > 0.0 { [x, y + gap, 0.0] } else { [x + gap, y, 0.0] };
        let of = |nodes| {
            beside_ellipse(THIN, nodes, at, Quadrature::Graded, |scene| {
                let mut sim = at_start(scene);
                let bound = sim.view().resolution().unwrap().bound();
                (gradient(scene), bound)
            })
        };
        let (exact, _) = of(448);
        for (nodes, most) in [(96, 1e-3), (128, 1e-4), (192, 2e-7)] {
            let (computed, bound) = of(nodes);
            let error = difference(&computed, &exact);
            println!("{at:?}, {nodes} nodes: {error:.1e}, bound {bound:.1e}");
            assert!(error <= most && error <= bound, "{error:e} {bound:e}");
        }
    }
}

#[test]
fn outlines_through_points_of_ellipses_have_the_flow_of_the_ellipses() {
    for (a, b, nodes, tolerance) in [(0.5, 0.5, 64, 1e-10), (1.0, 0.3, 128, 1e-7), (1.0, 0.1, 192, 1e-6)] {
        let points: Vec<[f64; 2]> = (0..160)
            .map(|k| {
                let (sin, cos) = (TAU * f64::from(k) / 160.0).sin_cos();
                [a * cos, b * sin]
            })
            .collect();
        let of = |shape| {
            beside_ellipse(shape, nodes, [1.1, 1.0, 0.3], Quadrature::Graded, |scene| {
                let mut sim = at_start(scene);
                let energy = sim.view().energy().unwrap().circulation;
                let gyroscopic = matrix(&mut sim.view(), |sim, out| sim.gyroscopic(out)).concat();
                [vec![energy], gradient(scene), gyroscopic]
            })
        };
        let (curve, ellipse) = (of(Shape::curve(&points)), of(Shape::Ellipse { a, b }));
        let errors: Vec<f64> = curve.iter().zip(&ellipse).map(|(x, y)| difference(x, y)).collect();
        println!("{a} × {b}: {errors:?}");
        assert!(errors.iter().all(|e| *e <= tolerance), "{errors:?}");
    }
}

#[test]
fn mirror_images_of_outlines_feel_mirrored_forces() {
    // Two polygons without symmetry that face each other, of opposite circulations, the one a mirror image of the other.
    let mut image = CORNER.map(|[x, y]| [x, -y]);
    image.reverse();
    let [first, second] = [(&CORNER, 1.0), (&image, -1.0)]
        .map(|(vertices, circulation)| circulating(Shape::Polygon { vertices, radius: Some(0.05) }, circulation, 128));
    let bodies = [body(&first, [0.0, 0.7, 0.4], [0.0; 3]), body(&second, [0.0, -0.7, -0.4], [0.0; 3])];
    let force = gradient(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
    println!("{force:?}");
    assert_close(&force[..3], &[force[3], -force[4], -force[5]], 1e-10);
    assert_near(force[0], 0.0, 1e-10);
}

#[test]
fn circulating_walls_act_as_circulating_bodies_that_are_held() {
    // A star and, so close that each needs its pole terms, a rectangle; a disc too far away to move their nodes.
    let (plate, nodes) = (Shape::Rectangle { width: 1.2, height: 0.3, radius: Some(0.05) }, 160);
    let (first, second) = ([0.0, 0.0, 0.2], [0.15, -0.84, 0.1]);
    let disc = circulating(disc(0.4), 0.8, 96);
    let free = body(&disc, [4.0, 3.0, 0.0], [0.0; 3]);
    let walls = [(STAR, 1.0, first), (plate, -0.6, second)]
        .map(|(shape, circulation, [x, y, angle])| Wall { circulation, ..wall(shape, [x, y], angle, nodes) });
    let of_walls = |tank| {
        let bodies = [free];
        gradient(&Scene { tank, obstacles: &walls, bodies: &bodies, ..Scene::new(1.0, 0.0) })
    };
    let of_bodies = |tank| {
        let (star, plate) = (circulating(STAR, 1.0, nodes), circulating(plate, -0.6, nodes));
        let bodies = [free, body(&star, first, [0.0; 3]), body(&plate, second, [0.0; 3])];
        gradient(&Scene { tank, bodies: &bodies, ..Scene::new(1.0, 0.0) })
    };
    for tank in [None, Some(wall(Shape::Ellipse { a: 12.0, b: 11.0 }, [0.0; 2], 0.1, 192))] {
        let (held, free) = (of_walls(tank), of_bodies(tank));
        println!("{:.1e}", difference(&held[..2], &free[..2]));
        assert_close(&held[..2], &free[..2], 1e-13);
    }
}

#[test]
fn energy_of_a_circulating_thin_body_is_conserved() {
    beside_ellipse(THIN, 160, [1.1, 1.2, 0.3], Quadrature::Graded, |scene| {
        let mut sim = simulation(scene, adams(1e-10));
        let mut sim = sim.view();
        let start = sim.energy().unwrap().total;
        let mut drift = 0.0f64;
        for k in 1..=4 {
            sim.advance(0.1 * f64::from(k)).unwrap();
            drift = drift.max((sim.energy().unwrap().total - start).abs());
        }
        println!("{drift:.1e} of {start}");
        assert!(drift <= 1e-8 * start, "{drift:e} of {start}");
    });
}
