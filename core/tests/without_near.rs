//! What a build without the feature `near` promises: `cargo test -p nekton --no-default-features --test without_near`.
#![cfg(not(feature = "near"))]

use nekton::scene::{Body, Link, Mass, Quadrature, Root, Scene, Shape};
use nekton::{Model, Status};

#[test]
fn graded_quadrature_is_refused_by_name_and_plain_accepted() {
    let links = [Link {
        shape: Shape::Ellipse { a: 1.0, b: 0.5 },
        mass: Mass::Density(1.0),
        nodes: 16,
        circulation: 0.0,
        joint: None,
    }];
    let bodies = [Body { pose: [0.0; 3], velocity: [0.0; 3], root: Root::Free, links: &links }];
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    let refused = Model::<f64>::requirement(&scene).err().map(|e| (e.status, e.what));
    assert_eq!(refused, Some((Status::Unsupported, "quadrature")));
    assert!(Model::requirement(&Scene { quadrature: Quadrature::Plain, ..scene }).is_ok());
}
