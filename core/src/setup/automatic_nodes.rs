//! Nodes from a tolerance: what a boundary needs by itself, and how far an asked tolerance can be met.
//!
//! Tested by `tests/indicators.rs:automatic_nodes_meet_the_tolerance`.

use crate::base::scalar::Real;
use crate::base::status::{Error, Result, Status};
use crate::geometry::curve::{SHARP, distinct};
#[cfg(feature = "alloc")]
use crate::scene::{Body, Description, Link, Scene, Wall, each_link};
use crate::scene::{Quadrature, Shape};

/// Tolerance in space of automatic nodes when the scene asks for none.
pub const DEFAULT_TOLERANCE: f64 = 1e-6;

/// Bound of the relative error in space that is noticed where the scene asks for no tolerance.
pub const NOTICED_BOUND: f64 = 1e-3;

/// The tolerance that automatic nodes aim at: the scene's, or [`DEFAULT_TOLERANCE`], or what the precision allows.
pub(crate) fn target<R: Real>(asked: Option<R>) -> R {
    asked.unwrap_or(R::lit(DEFAULT_TOLERANCE).max(R::lit(1e4) * R::EPSILON))
}

/// The bound of the relative error above which there is a notice: the scene's tolerance, or [`NOTICED_BOUND`], but nothing that automatic
/// nodes may reach.
pub(crate) fn noticed<R: Real>(asked: Option<R>) -> R {
    asked.unwrap_or(R::lit(NOTICED_BOUND).max(target(None)))
}

/// Whether some node count is automatic.
#[cfg(feature = "alloc")]
pub(crate) fn automatic<R: Real, S: Description<R>>(scene: &S) -> bool {
    scene.tank().is_some_and(|w| w.nodes == 0)
        || (0..scene.obstacle_count()).any(|i| scene.obstacle(i).is_some_and(|w| w.nodes == 0))
        || each_link(scene).any(|(_, _, l)| l.nodes == 0)
}

/// Refuses a tolerance that no number of nodes can meet.
pub(crate) fn check<R: Real>(asked: Option<R>) -> Result<()> {
    match asked {
        Some(t) if !(t.is_finite() && t >= R::lit(10.0) * R::EPSILON) => {
            Err(Error::new(Status::BadTolerance).of("tolerance", t.to_f64()))
        }
        _ => Ok(()),
    }
}

/// Nodes that an outline needs for a relative error `tolerance` of added mass and force: by itself, and beside others at gaps
/// of half its size ([`Quadrature::Plain`]) or a hundredth ([`Quadrature::Graded`]). Fitted to measured errors; a multiple of 4,
/// at most [`MOST`].
pub(crate) fn nodes<R: Real>(shape: &Shape<'_, R>, tolerance: R, quadrature: Quadrature) -> usize {
    let digits = -Real::ln(tolerance.to_f64().clamp(1e-15, 0.1)) / core::f64::consts::LN_10;
    let plain = quadrature == Quadrature::Plain;
    let neighbours = if plain { 6.0 * digits } else { 12.0 + 5.0 * digits };
    let own = match *shape {
        Shape::Ellipse { a, b } => {
            let aspect = ratio(a, b);
            if plain {
                // Poles of the kernel inside: an error 4 ((aspect − 1)/(aspect + 1))ᴺ.
                let decay = Real::ln((aspect + 1.0) / (aspect - 1.0).max(1e-3));
                (digits * core::f64::consts::LN_10 + 1.4) / decay
            } else {
                neighbours * (1.0 + 0.35 * Real::ln(aspect))
            }
        }
        Shape::Star { amplitude, lobes, .. } => {
            let lobes = lobes.min(1 << 16) as f64;
            digits * lobes * (0.2 + 1.6 * Real::abs(amplitude.to_f64()) * lobes)
        }
        Shape::Rectangle { width, height, radius } => {
            let short = width.to_f64().min(height.to_f64());
            let radius = radius.map_or(SHARP, |r| r.to_f64() / short);
            let corners = 4.0 * corner(digits, radius);
            let flanks = 1.3 * digits * 2.0 * (1.0 + ratio(width, height));
            if plain { corners.max(flanks) } else { corners * (1.0 + 0.25 * Real::ln(ratio(width, height))) }
        }
        Shape::Polygon { vertices, radius } => {
            let vertices = distinct(vertices);
            let sides = || vertices.iter().zip(vertices.iter().cycle().skip(1));
            let length = |(a, b): (&[R; 2], &[R; 2])| (b[0] - a[0]).hypot(b[1] - a[1]).to_f64();
            let short = sides().map(length).fold(f64::MAX, f64::min);
            // Acute corners need more than right ones.
            let blunt = if vertices.len() < 4 { 1.6 } else { 1.0 };
            blunt * vertices.len() as f64 * corner(digits, radius.map_or(SHARP, |r| r.to_f64() / short))
        }
        Shape::Curve { .. } => shape.ladder_counts().map_or(0.0, |(points, _)| points as f64 * (1.0 + 0.2 * digits)),
    };
    let count = own.max(neighbours).min(MOST as f64);
    // NaN, of a shape that is refused later, counts as 0.
    (count as usize).max(16).div_ceil(4) * 4
}

/// Most nodes that are chosen automatically for one boundary.
pub(crate) const MOST: usize = 1024;

/// Most nodes of all boundaries together with which a start is tried: a matrix of 128 MiB.
#[cfg(feature = "alloc")]
pub const MOST_CHECKED: usize = 4096;

/// Nodes for one corner of a radius relative to the shortest side.
fn corner(digits: f64, radius: f64) -> f64 {
    digits * (0.4 + 0.5 * Real::ln((1.0 / radius.max(1e-12)).max(1.0)))
}

/// The larger over the smaller, at least 1, at most a million.
fn ratio<R: Real>(a: R, b: R) -> f64 {
    let (a, b) = (a.to_f64(), b.to_f64());
    (a.max(b) / a.min(b)).clamp(1.0, 1e6)
}

/// A scene whose automatic node counts were compared with its start, or are those of the rule (feature `alloc`): it describes the same with counts that are given.
#[cfg(feature = "alloc")]
pub struct Resolved<'s, S> {
    pub(crate) scene: &'s S,
    /// By which the counts of the rule are multiplied.
    pub(crate) factor: f64,
}

#[cfg(feature = "alloc")]
impl<'s, S> Resolved<'s, S> {
    /// The same scene with the counts of the rule, not compared with its start.
    pub fn by_rule(scene: &'s S) -> Self {
        Resolved { scene, factor: 1.0 }
    }

    fn nodes<R: Real>(&self, given: usize, shape: &Shape<'_, R>) -> usize
    where
        S: Description<R>,
    {
        if given > 0 {
            return given;
        }
        let settings = self.scene.settings();
        let rule = nodes(shape, target(settings.tolerance), settings.quadrature);
        ((rule as f64 * self.factor) as usize).div_ceil(4) * 4
    }
    /// Nodes of all boundaries.
    pub(crate) fn total<R: Real>(&self) -> usize
    where
        S: Description<R>,
    {
        let walls = self
            .scene
            .tank()
            .into_iter()
            .chain((0..self.scene.obstacle_count()).filter_map(|i| self.scene.obstacle(i)));
        let walls = walls.map(|w| (w.nodes, w.shape));
        let all = walls.chain(each_link(self.scene).map(|(_, _, l)| (l.nodes, l.shape)));
        all.fold(0, |sum, (nodes, shape)| sum.saturating_add(self.nodes(nodes, &shape)))
    }
    fn wall<'a, R: Real>(&self, w: Wall<'a, R>) -> Wall<'a, R>
    where
        S: Description<R>,
    {
        Wall { nodes: self.nodes(w.nodes, &w.shape), ..w }
    }
}

#[cfg(feature = "alloc")]
impl<R: Real, S: Description<R>> Description<R> for Resolved<'_, S> {
    fn settings(&self) -> Scene<'_, R> {
        self.scene.settings()
    }
    fn tank(&self) -> Option<Wall<'_, R>> {
        self.scene.tank().map(|w| self.wall(w))
    }
    fn obstacle_count(&self) -> usize {
        self.scene.obstacle_count()
    }
    fn obstacle(&self, i: usize) -> Option<Wall<'_, R>> {
        self.scene.obstacle(i).map(|w| self.wall(w))
    }
    fn body_count(&self) -> usize {
        self.scene.body_count()
    }
    fn body(&self, b: usize) -> Option<Body<'_, R>> {
        self.scene.body(b)
    }
    fn link_count(&self, b: usize) -> usize {
        self.scene.link_count(b)
    }
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.scene.link(b, l).map(|link| Link { nodes: self.nodes(link.nodes, &link.shape), ..link })
    }
    fn link_as_given(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.scene.link_as_given(b, l)
    }
}
