//! Every boundary as the scene gives it, in the order of the unknowns.
//!
//! Tested by `tests/walls`, `tests/articulated`, whose links share a shape.

use crate::base::scalar::Real;
use crate::base::status::Place;
use crate::geometry::pose::Pose;
use crate::scene::{Description, Link, Mass, Shape, each_link, each_link_as_given};
use crate::setup::automatic_nodes::target;

/// One boundary as the scene gives it.
#[derive(Clone, Copy)]
pub(crate) struct Item<'a, R> {
    pub(crate) place: Place,
    pub(crate) link: Option<usize>,
    pub(crate) shape: Shape<'a, R>,
    /// Chosen where none are given.
    pub(crate) nodes: usize,
    /// Centre of mass from the centroid; `None` for walls (frame = drawing frame).
    pub(crate) centre: Option<[R; 2]>,
    pub(crate) circulation: R,
    pub(crate) pose: Pose<R>,
}

pub(crate) fn items<'a, R: Real, S: Description<R>>(scene: &'a S) -> impl Iterator<Item = Item<'a, R>> + Clone {
    let settings = scene.settings();
    let tolerance = target(settings.tolerance);
    let nodes = move |given: usize, shape: &Shape<'a, R>| {
        if given == 0 { crate::setup::automatic_nodes::nodes(shape, tolerance, settings.quadrature) } else { given }
    };
    let wall = move |place, w: crate::scene::Wall<'a, R>| Item {
        place,
        link: None,
        shape: w.shape,
        nodes: nodes(w.nodes, &w.shape),
        centre: None,
        circulation: w.circulation,
        pose: Pose::new(w.position[0], w.position[1], w.angle),
    };
    let tank = scene.tank().into_iter().map(move |w| wall(Place::Tank, w));
    let obstacles = (0..scene.obstacle_count()).filter_map(move |i| Some(wall(Place::Obstacle(i), scene.obstacle(i)?)));
    let links = each_link(scene).enumerate().map(move |(i, (b, l, link))| Item {
        place: Place::Link(b, l),
        link: Some(i),
        shape: link.shape,
        nodes: nodes(link.nodes, &link.shape),
        centre: Some(match link.mass {
            Mass::Density(_) => [R::zero(); 2],
            Mass::Given { centre_of_mass, .. } => centre_of_mass,
        }),
        circulation: link.circulation,
        pose: Pose::default(),
    });
    tank.chain(obstacles).chain(links)
}

/// The outlines of the same, without their nodes.
#[cfg(feature = "alloc")]
pub(crate) fn shapes<'a, R: Real, S: Description<R>>(scene: &'a S) -> impl Iterator<Item = (Place, Shape<'a, R>)> {
    let tank = scene.tank().into_iter().map(|w| (Place::Tank, w.shape));
    let obstacles = (0..scene.obstacle_count()).filter_map(|i| Some((Place::Obstacle(i), scene.obstacle(i)?.shape)));
    let places = (0..scene.body_count()).flat_map(|b| (0..scene.link_count(b)).map(move |l| Place::Link(b, l)));
    tank.chain(obstacles).chain(places.zip(each_link_as_given(scene).map(|link| link.shape)))
}

/// The first boundary before boundary `i` whose compiled outline, nodes and self block serve for it as well, if any: a link
/// of the same shape, nodes and centre of mass. O(links).
pub(crate) fn twin_of<R: Real, S: Description<R>>(scene: &S, i: usize, item: &Item<'_, R>) -> Option<usize> {
    let own = item.link?;
    let centre = |link: &Link<'_, R>| match link.mass {
        Mass::Density(_) => [R::zero(); 2],
        Mass::Given { centre_of_mass, .. } => centre_of_mass,
    };
    // What is given alike is chosen alike.
    let given = each_link_as_given(scene).nth(own)?.nodes;
    let same =
        |other: &Link<'_, R>| other.nodes == given && other.shape == item.shape && Some(centre(other)) == item.centre;
    let twin = each_link_as_given(scene).take(own).position(|other| same(&other))?;
    Some(i.checked_sub(own)? + twin)
}
