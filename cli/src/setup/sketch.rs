//! A scene without its fluid: its outlines and nodes, and no matrices.

use nekton::scene::{Body, Description, Link, Mass, Scene, Wall};

/// The same outlines, nodes, joints and drives, of bodies of unit mass.
pub struct Dry<'a, S>(pub &'a S);

impl<S: Description<f64>> Description<f64> for Dry<'_, S> {
    fn settings(&self) -> Scene<'_, f64> {
        Scene { fluid_density: 0.0, repulsion: None, ..self.0.settings() }
    }
    fn tank(&self) -> Option<Wall<'_, f64>> {
        self.0.tank()
    }
    fn obstacle_count(&self) -> usize {
        self.0.obstacle_count()
    }
    fn obstacle(&self, i: usize) -> Option<Wall<'_, f64>> {
        self.0.obstacle(i)
    }
    fn body_count(&self) -> usize {
        self.0.body_count()
    }
    fn body(&self, b: usize) -> Option<Body<'_, f64>> {
        self.0.body(b)
    }
    fn link_count(&self, b: usize) -> usize {
        self.0.link_count(b)
    }
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, f64>> {
        self.0.link(b, l).map(weightless)
    }
    fn link_as_given(&self, b: usize, l: usize) -> Option<Link<'_, f64>> {
        self.0.link_as_given(b, l).map(weightless)
    }
}

/// The same of unit mass, which needs no fluid.
fn weightless(link: Link<'_, f64>) -> Link<'_, f64> {
    Link { mass: Mass::Given { mass: 1.0, inertia: 1.0, centre_of_mass: [0.0; 2] }, ..link }
}
