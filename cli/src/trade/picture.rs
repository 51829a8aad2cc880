//! `trade.svg`: error against time per simulated second.

use plotters::style::{BLACK, RGBColor};

use crate::plots::log::{Curve, Marks, chart};
use crate::plots::{Outcome, colour};

use super::reference::Reference;
use super::setting::shown;
use super::study::{Measured, Status, front};

/// Errors smaller than this are drawn at it.
const LEAST: f64 = 1e-16;

/// Draws all runs; those on the front are joined.
pub fn draw(title: &str, rows: &[Measured], reference: &Reference) -> Outcome<String> {
    let done = || rows.iter().filter(|m| m.status == Status::Done && m.error.is_finite() && m.error < 1.0);
    let point = |m: &Measured| (m.cost, m.error.max(LEAST));
    let mut curves = vec![Curve {
        name: "front".into(),
        points: front(rows, reference.error).into_iter().map(point).collect(),
        colour: BLACK,
        marks: Marks::Line,
    }];
    let mut families: Vec<[&str; 4]> = Vec::new();
    for m in done() {
        if !families.contains(&m.setting.names()) {
            families.push(m.setting.names());
        }
    }
    for family in &families {
        let [quadrature, force, precision, method] = family;
        curves.push(Curve {
            name: family_name(family),
            points: done().filter(|m| m.setting.names() == *family).map(point).collect(),
            colour: if *precision == "f32" { pale(method_index(method)) } else { colour(method_index(method)) },
            marks: match (*quadrature, *force) {
                ("graded", "exact") => Marks::Dots,
                ("graded", _) => Marks::Rings,
                (_, "exact") => Marks::Crosses,
                _ => Marks::Triangles,
            },
        });
    }
    let floor = [(1.0, reference.error)];
    curves.push(Curve {
        name: "error of the reference".into(),
        points: floor.to_vec(),
        colour: RGBColor(150, 150, 150),
        marks: Marks::Level,
    });
    chart(
        &format!("{title}: error against time, to t = {} s", shown(reference.until)),
        "time per simulated second (s/s)",
        "relative error",
        &curves,
    )
}

fn method_index(name: &str) -> usize {
    match name {
        "adams" => 0,
        "rk4" => 1,
        "abm4" => 2,
        _ => 3,
    }
}

/// The colour of single precision.
fn pale(k: usize) -> RGBColor {
    let RGBColor(r, g, b) = colour(k);
    let mix = |x: u8| 255 - (255 - x) / 2;
    RGBColor(mix(r), mix(g), mix(b))
}

/// Short: only what is not usual.
fn family_name([quadrature, force, precision, method]: &[&str; 4]) -> String {
    let mut name = (*method).to_owned();
    for (word, usual) in [(precision, "f64"), (force, "exact"), (quadrature, "graded")] {
        if *word != usual {
            name = format!("{name} {word}");
        }
    }
    name
}
