//! One outline described in two ways is one outline: in memory, in nodes, and in what it does; and what its points leave open is told.

use nekton::scene::{Corners, Quadrature, Scene, Shape};
use nekton::{Model, ModelBuf, Place, SimBuf, Status};
use nekton_tests::*;
use std::f64::consts::{PI, TAU};

#[test]
fn a_rectangle_takes_what_the_polygon_of_its_corners_takes() {
    for (width, height) in [(1.0, 1.0), (2.0, 0.6), (0.3, 3.0)] {
        let (x, y) = (0.5 * width, 0.5 * height);
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
        for radius in [None, Some(0.02), Some(0.1)] {
            let rectangle = Shape::Rectangle { width, height, radius };
            let polygon = Shape::Polygon { vertices: &corners, radius };
            let needed = |shape| {
                let links = [link(shape, 1.0, 64)];
                let bodies = [body(&links, [0.0; 3], [0.0; 3])];
                Model::requirement(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap()
            };
            assert_eq!(needed(rectangle), needed(polygon));
        }
    }
}

/// Nodes that the rule gives a shape.
fn chosen(shape: Shape<'_, f64>, quadrature: Quadrature, tolerance: f64) -> usize {
    let links = [link(shape, 1.0, 0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let scene = Scene { bodies: &bodies, quadrature, tolerance: Some(tolerance), ..Scene::new(1.0, 0.0) };
    nodes_by_rule(&scene)[0]
}

#[test]
fn a_square_takes_as_many_nodes_as_the_polygon_of_its_corners_and_a_triangle_more_per_corner() {
    let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let triangle = [[-0.5, -0.4], [0.5, -0.4], [0.0, 0.5]];
    for tolerance in [1e-4, 1e-8] {
        let radius = Some(0.05);
        let four = chosen(Shape::Polygon { vertices: &square, radius }, Quadrature::Graded, tolerance);
        assert_eq!(four, chosen(Shape::Rectangle { width: 1.0, height: 1.0, radius }, Quadrature::Graded, tolerance));
        let three = chosen(Shape::Polygon { vertices: &triangle, radius }, Quadrature::Graded, tolerance);
        assert!(three > four, "acute corners take more: {three}, {four}");
    }
}

#[test]
fn nodes_chosen_for_polygons_meet_the_tolerance() {
    let square = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let triangle = [[-0.5, -0.4], [0.5, -0.4], [0.0, 0.5]];
    for vertices in [&square[..], &triangle] {
        let mass = |nodes: usize, tolerance: Option<f64>| {
            let links = [link(Shape::Polygon { vertices, radius: Some(0.05) }, 1.0, nodes)];
            let bodies = [body(&links, [0.0; 3], [0.0; 3])];
            let scene = Scene { bodies: &bodies, tolerance, ..Scene::new(1.0, 0.0) };
            matrix(&mut at_start(&scene).view(), |sim, out| sim.mass_matrix(out)).concat()
        };
        let exact = mass(320, None);
        for tolerance in [1e-4, 1e-8] {
            let error = difference(&mass(0, Some(tolerance)), &exact);
            assert!(error < tolerance, "{} corners: {error:e} > {tolerance:e}", vertices.len());
        }
    }
}

#[test]
fn a_curve_drawn_far_from_the_origin_is_the_same_curve() {
    // Seven digits are lost to the distance.
    let ring = |far: f64| -> Vec<[f64; 2]> {
        let point = |k: usize| (std::f64::consts::TAU * k as f64 / 24.0).sin_cos();
        (0..24).map(|k| [far + point(k).1, 0.1 * point(k).0 - far]).collect()
    };
    let mass = |far: f64| {
        let points = ring(far);
        let links = [link(Shape::curve(&points), 1.0, 96)];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        matrix(&mut at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).view(), |sim, out| {
            sim.mass_matrix(out)
        })
    };
    let (near, far) = (mass(0.0).concat(), mass(1e7).concat());
    println!("{:e}", difference(&near, &far));
    assert_close(&far, &near, 1e-6);
}

#[test]
fn points_coincide_or_not_in_every_unit_of_length_alike() {
    let ring = |unit: f64, gap: f64| -> Vec<[f64; 2]> {
        let point = |k: usize| (std::f64::consts::TAU * k as f64 / 12.0).sin_cos();
        let mut points: Vec<_> = (0..12).map(|k| [unit * point(k).1, 0.6 * unit * point(k).0]).collect();
        if gap > 0.0 {
            points.insert(4, [points[3][0] - gap * unit, points[3][1]]);
        }
        points
    };
    let model = |points: &[[f64; 2]]| {
        let links = [link(Shape::curve(points), 1.0, 32)];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) })
    };
    let area = |unit: f64| model(&ring(unit, 0.0)).unwrap().view().link(0).unwrap().mass / (unit * unit);
    for unit in [1e-12, 1e-6, 1e6, 1e12] {
        assert_near(area(unit), area(1.0), 1e-13);
        let error = model(&ring(unit, 1e-15)).unwrap_err();
        assert_eq!((error.status, error.value), (nekton::Status::BadShape, 4.0), "{unit:e}: {error}");
    }
}

/// Added mass of a lone body along x and along y, and its area.
fn mass_and_area(shape: Shape<'_, f64>) -> Option<[f64; 3]> {
    let links = [link(shape, 1.0, 0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let scene = Scene { bodies: &bodies, allow_unresolved: true, tolerance: Some(1e-4), ..Scene::new(1.0, 0.0) };
    let mut sim = SimBuf::new(ModelBuf::new(&scene).ok()?.into(), adams(1e-6)).ok()?;
    let m = matrix(&mut sim.view(), |s, out| s.added_mass(out));
    let area = sim.view().model().link(0)?.area;
    Some([m[0][0], m[1][1], area])
}

/// The estimated error of a curve through points, and that found.
fn estimated(points: &[[f64; 2]], corners: Corners<'_>, exact: [f64; 3]) -> (f64, f64) {
    let shape = Shape::Curve { points, corners };
    let estimate = shape.outline_error().unwrap().unwrap();
    let found = mass_and_area(shape).unwrap();
    let scale = exact[0].max(exact[1]);
    let error = (0..2).fold((found[2] / exact[2] - 1.0).abs(), |e, k| e.max((found[k] - exact[k]).abs() / scale));
    (estimate, error)
}

fn ring(a: f64, b: f64, steps: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    steps.map(|t| [a * (TAU * t).cos(), b * (TAU * t).sin()]).collect()
}

/// The unit square, or one of another height, by so many steps along its sides in turn, and where its corners are.
fn plate(height: f64, steps: [usize; 4]) -> (Vec<[f64; 2]>, [usize; 4]) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, height], [0.0, height]];
    let along = |k: usize, i: usize| {
        let t = i as f64 / steps[k] as f64;
        [0, 1].map(|c| corners[k][c] * (1.0 - t) + corners[(k + 1) % 4][c] * t)
    };
    let points = (0..4).flat_map(|k| (0..steps[k]).map(move |i| (k, i))).map(|(k, i)| along(k, i)).collect();
    (points, [0, steps[0], steps[0] + steps[1], steps[0] + steps[1] + steps[2]])
}

#[test]
fn points_that_leave_the_outline_uncertain_are_noticed_and_those_that_tell_it_are_not() {
    let even = |n: usize, shift: f64| (0..n).map(move |k| (k as f64 + shift) / n as f64);
    // Few points, none at the tips; few on one side only; corners that nobody knows of.
    let uneven =
        |n: usize| (0..n).map(move |k| 0.5 * k as f64 / n as f64).chain((0..100).map(|k| 0.5 + k as f64 / 200.0));
    let disc = [PI, PI, PI];
    let thin = [PI * 0.01, PI, PI * 0.1];
    let square = |height: f64| {
        let shape = Shape::Rectangle { width: 1.0, height, radius: Some(1e-5 * height) };
        mass_and_area(shape).unwrap()
    };
    let mut rough: Vec<(Vec<[f64; 2]>, Corners<'_>, [f64; 3])> = vec![
        (ring(1.0, 0.1, even(16, 0.5)), Corners::Auto, thin),
        (ring(1.0, 0.1, even(24, 0.5)), Corners::Auto, thin),
        (ring(1.0, 1.0, uneven(4)), Corners::Auto, disc),
    ];
    let three = [0, 20, 40];
    for (height, steps, corners) in [
        (1.0, [2, 2, 2, 2], Corners::Auto),
        (1.0, [3, 3, 3, 3], Corners::Auto),
        (1.0, [20, 20, 20, 20], Corners::None),
        (1.0, [20, 20, 20, 20], Corners::At(&three)),
        (1.0, [20, 1, 20, 1], Corners::None),
        (1.0, [40, 10, 5, 3], Corners::Auto),
        (0.1, [2, 2, 2, 2], Corners::Auto),
        (0.1, [20, 2, 20, 2], Corners::Auto),
    ] {
        rough.push((plate(height, steps).0, corners, square(height)));
    }
    // Sides without points beside dense arcs: a stadium, whose area is known, and a disc with a flat.
    for n in [9, 33] {
        let cap = |x: f64, from: f64| {
            (0..n)
                .map(move |k| PI * (from + f64::from(k) / f64::from(n - 1)))
                .map(move |t| [x + 0.5 * t.cos(), 0.5 * t.sin()])
        };
        let points: Vec<_> = cap(1.0, -0.5).chain(cap(-1.0, 0.5)).collect();
        let estimate = Shape::curve(&points).outline_error().unwrap().unwrap();
        let area = mass_and_area(Shape::curve(&points)).unwrap()[2];
        let error = (area / (2.0 + PI / 4.0) - 1.0).abs();
        println!("stadium: estimate {estimate:.1e}, error {error:.1e}");
        assert!(error > 1e-2 && estimate > error && estimate < 10.0 * error, "{n}: {estimate:e} {error:e}");
        for half in [0.3, 0.7] {
            let turn = |k: i32| half + (TAU - 2.0 * half) * f64::from(k) / f64::from(n - 1);
            let flat: Vec<_> = (0..n).map(|k| [turn(k).cos(), turn(k).sin()]).collect();
            let estimate = Shape::curve(&flat).outline_error().unwrap().unwrap();
            assert!(estimate > 1e-3, "{n} {half}: {estimate:e}");
        }
    }
    for (points, corners, exact) in rough {
        let (estimate, error) = estimated(&points, corners, exact);
        println!("{} points: estimate {estimate:.1e}, error {error:.1e}", points.len());
        assert!(error > 1e-3 && estimate > error / 6.0, "{estimate:e} {error:e} {points:?}");
    }
    for n in [32, 64, 128] {
        let (estimate, error) = estimated(&ring(1.0, 1.0, even(n, 0.0)), Corners::Auto, disc);
        assert!(estimate < 1e-7 && error < estimate, "{n}: {estimate:e} {error:e}");
    }
    let (estimate, error) = estimated(&ring(1.0, 0.1, even(160, 0.5)), Corners::Auto, thin);
    println!("thin: {estimate:.1e} {error:.1e}");
    assert!(estimate < 1e-3 && error < 1e-5, "{estimate:e} {error:e}");
    for (height, steps) in [(1.0, [1; 4]), (1.0, [2; 4]), (0.1, [40, 10, 5, 3])] {
        // With its corners given a plate is known from any points on its sides.
        let (points, corners) = plate(height, steps);
        let (estimate, error) = estimated(&points, Corners::At(&corners), square(height));
        assert!(estimate < 1e-6 && error < 1e-4, "{steps:?}: {estimate:e} {error:e}");
    }
}

#[test]
fn a_pair_of_close_points_that_bends_the_curve_is_noticed_and_one_on_the_curve_is_not() {
    // A point more at a part of a step from another, and as many times that part off the curve.
    let with = |n: usize, b: f64, gap: f64, off: f64| {
        let mut points = ring(1.0, b, (0..n).map(|k| k as f64 / n as f64));
        let k = n / 5;
        let t = TAU * (k as f64 + gap) / n as f64;
        let (x, y) = (t.cos(), b * t.sin());
        let step = (x - points[k][0]).hypot(y - points[k][1]);
        let normal = [b * t.cos(), t.sin()].map(|c| c / (b * t.cos()).hypot(t.sin()));
        points.insert(k + 1, [x + off * step * normal[0], y + off * step * normal[1]]);
        points
    };
    for b in [1.0, 0.6] {
        let exact = [PI * b * b, PI, PI * b];
        for n in [24, 40] {
            for gap in [1e-2, 1e-4, 1e-6] {
                let (estimate, error) = estimated(&with(n, b, gap, 1.0), Corners::None, exact);
                println!("{b} {n} {gap:e}: estimate {estimate:.1e}, error {error:.1e}");
                assert!(
                    error > 3e-4 && estimate > 1e-3f64.max(error) && estimate < 50.0 * error,
                    "{estimate:e} {error:e}"
                );
                // Closer ones bend it by what is rounded of them.
                if gap >= 1e-4 {
                    let (estimate, error) = estimated(&with(n, b, gap, 0.0), Corners::None, exact);
                    assert!(error < 1e-3 && estimate < 1e-3, "on it: {estimate:e} {error:e}");
                }
            }
        }
    }
    let points = with(24, 1.0, 1e-4, 1.0);
    let links = [link(Shape::curve(&points), 1.0, 64)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let model = ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap();
    assert!(model.view().notices().any(|(_, status)| status == Status::OutlineUncertain));
}

#[test]
fn a_corner_that_is_named_twice_is_refused_by_its_number() {
    let (points, _) = plate(1.0, [4; 4]);
    for corners in [&[0, 4, 4][..], &[4, 0, 8, 4]] {
        let shape = Shape::Curve { points: &points, corners: Corners::At(corners) };
        let links = [link(shape, 1.0, 64)];
        let bodies = [body(&links, [0.0; 3], [0.0; 3])];
        let error = ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap_err();
        assert_eq!((error.status, error.what, error.value), (Status::BadShape, "corner", 4.0));
    }
}

#[test]
fn the_estimate_falls_with_noise_and_does_not_hang_on_place_size_or_direction() {
    let mut state = 3_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let noisy = |size: f64, noise: &mut dyn FnMut() -> f64| -> f64 {
        let points: Vec<[f64; 2]> =
            ring(1.0, 1.0, (0..100).map(|k| k as f64 / 100.0)).iter().map(|p| p.map(|x| x + size * noise())).collect();
        Shape::curve(&points).outline_error().unwrap().unwrap()
    };
    for size in [1e-2, 1e-3, 1e-4] {
        let estimate = noisy(size, &mut noise);
        assert!(estimate > 0.5 * size && estimate < 5.0 * size, "{size}: {estimate:e}");
    }
    let points = ring(1.0, 0.3, (0..24).map(|k| (k as f64 + 0.2) / 24.0));
    let estimate = |points: &[[f64; 2]]| Shape::curve(points).outline_error().unwrap().unwrap();
    let moved: Vec<_> = points.iter().map(|[x, y]| [5.0 - 1e-3 * y, 3.0 + 1e-3 * x]).collect();
    let backwards: Vec<_> = points.iter().rev().copied().collect();
    let later: Vec<_> = points[7..].iter().chain(&points[..7]).copied().collect();
    let first = estimate(&points);
    for other in [moved, backwards, later] {
        assert!((estimate(&other) / first - 1.0).abs() < 0.2, "{first:e} {:e}", estimate(&other));
    }
    // What makes no outline has no estimate.
    let refused = |points: &[[f64; 2]]| Shape::curve(points).outline_error().unwrap_err().status;
    assert_eq!(refused(&[[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]]), Status::NotFinite);
    assert_eq!(refused(&points[..2]), Status::BadShape);
    // One point twice does not make a side shorter.
    let repeated: Vec<_> = points.iter().chain(&points[..1]).copied().collect();
    assert_eq!(estimate(&repeated), first);
}

#[test]
fn a_model_tells_how_well_its_points_tell_every_outline_and_whose_do_not() {
    let (rough, fine) = (plate(1.0, [2; 4]).0, ring(0.5, 0.4, (0..24).map(|k| f64::from(k) / 24.0)));
    let shapes = [Shape::curve(&rough), Shape::Ellipse { a: 0.5, b: 0.3 }, Shape::curve(&fine), Shape::curve(&rough)];
    let links = shapes.map(|shape| [link(shape, 1.0, 64)]);
    let bodies: Vec<_> =
        links.iter().zip(0..).map(|(l, k)| body(l, [4.0 * f64::from(k), 0.0, 0.0], [0.0; 3])).collect();
    let obstacles = [wall(Shape::curve(&rough), [0.0, 9.0], 0.0, 64)];
    let scene = Scene { bodies: &bodies, obstacles: &obstacles, ..Scene::new(1.0, 0.0) };
    let model = ModelBuf::new(&scene).unwrap();
    let view = model.view();
    let told = |place| view.outline_error(place);
    let known = Shape::curve(&rough).outline_error().unwrap();
    assert!(known > Some(1e-2));
    assert_eq!([Place::Link(0, 0), Place::Link(3, 0), Place::Obstacle(0)].map(told), [known; 3]);
    assert_eq!((told(Place::Link(1, 0)), told(Place::Tank)), (None, None));
    let fine = told(Place::Link(2, 0)).unwrap();
    assert!(fine < 1e-3 && fine > 1e-8, "{fine:e}");
    let noticed: Vec<_> = view.notices().collect();
    let places = [Place::Obstacle(0), Place::Link(0, 0), Place::Link(3, 0)];
    assert_eq!(noticed, places.map(|place| (place, Status::OutlineUncertain)));
    // A tolerance that is asked for is what the points are held to.
    let strict = Scene { tolerance: Some(0.5 * fine), ..scene };
    assert!(ModelBuf::new(&strict).unwrap().view().notices().any(|(place, _)| place == Place::Link(2, 0)));
}

#[test]
fn a_body_or_wall_drawn_far_from_the_origin_is_the_one_drawn_near() {
    // Coordinates as maps and drawings have them, the last ones with a tenth of a micrometre on a metre.
    let section: Vec<_> = (0..160)
        .map(|k| {
            let x = 0.5 * (1.0 + (TAU * f64::from(k) / 160.0).cos());
            let y = 0.6 * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
            [x, if k < 80 { y } else { -y }]
        })
        .collect();
    let triangle = [[0.1, 0.2], [1.3, 0.0], [0.6, 0.9]];
    let mass = |points: &[[f64; 2]], vertices: &[[f64; 2]], position: [f64; 2]| {
        let links = [[link(Shape::curve(points), 1.0, 0)], [link(Shape::Polygon { vertices, radius: None }, 1.0, 0)]];
        let bodies = [body(&links[0], [0.0; 3], [0.0; 3]), body(&links[1], [2.0, 0.0, 0.3], [0.0; 3])];
        let obstacles = [wall(Shape::curve(points), position, 0.0, 0)];
        let mut sim = at_start(&Scene { bodies: &bodies, obstacles: &obstacles, ..Scene::new(1.0, 0.0) });
        let mut sim = sim.view();
        let told: Vec<_> = sim.model().notices().map(|(_, status)| status).collect();
        assert_eq!(told, [Status::CornersFound; 2]);
        assert!(sim.resolution().unwrap().bound() < 1e-3);
        matrix(&mut sim, |s, out| s.added_mass(out)).concat()
    };
    let near = mass(&section, &triangle, [0.0, -2.0]);
    for (offset, error) in [([40.0, -30.0], 1e-9), ([5e5, 5.6e6], 5e-9), ([-1e9, 3e8], 1e-6)] {
        let moved =
            |points: &[[f64; 2]]| -> Vec<_> { points.iter().map(|p| [p[0] + offset[0], p[1] + offset[1]]).collect() };
        let far = mass(&moved(&section), &moved(&triangle), [-offset[0], -2.0 - offset[1]]);
        let largest = near.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
        let difference = near.iter().zip(&far).fold(0.0, |d: f64, (a, b)| d.max((a - b).abs()));
        println!("{offset:?}: {:.1e}", difference / largest);
        assert!(difference < error * largest, "{offset:?}: {difference:e}");
    }
}
