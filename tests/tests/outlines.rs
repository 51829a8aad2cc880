//! One outline described in two ways is one outline: in memory, in nodes, and in what it does.

use nekton::scene::{Quadrature, Scene, Shape};
use nekton::{Model, ModelBuf};
use nekton_tests::*;

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
