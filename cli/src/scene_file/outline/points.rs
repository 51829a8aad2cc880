//! The points of an outline and what is told of them.

use super::line::{extent, twice_area};
use super::noise::Noise;

/// Points of a file, at most.
pub const MOST: usize = 100_000;

/// A turn in degrees from which on a corner is a cusp, which the core rounds better as a smooth curve.
pub const CUSP: f64 = 175.0;

/// Points along a closed line, and what the user is told of them if they did not write them into the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// In order.
    pub points: Vec<[f64; 2]>,
    /// Where they are from and what they enclose.
    pub told: Option<String>,
    /// Which points are corners, if that is known.
    pub corners: Option<Vec<usize>>,
    /// By how much the points scatter, if that is looked at and they are enough.
    pub noise: Option<Noise>,
    /// What smoothing may have changed the added mass by, relatively, if it was asked for.
    pub smoothing: Option<f64>,
}

impl Outline {
    /// Points with a word on where they are from.
    pub fn new(points: Vec<[f64; 2]>, from: &str) -> Self {
        Self::of(points).described(from)
    }

    /// Points of which nothing is told.
    pub fn of(points: Vec<[f64; 2]>) -> Self {
        Outline { points, told: None, corners: None, noise: None, smoothing: None }
    }

    pub fn described(self, from: &str) -> Self {
        Outline { told: Some(format!("{from}: {}", description(&self.points))), ..self }
    }
}

/// A number with six digits.
pub fn six(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// Number of points, direction, extent along x and y, and the area of the polygon through the points.
pub fn description(points: &[[f64; 2]]) -> String {
    let twice = twice_area(points);
    let way = if twice < 0.0 { "clockwise" } else { "counter-clockwise" };
    let [along, up] = extent(points).map(six);
    format!(
        "{} points, {way}, chord (along x) {along} m, height (along y) {up} m, area of the polygon through them {} m²",
        points.len(),
        six(0.5 * twice.abs())
    )
}
