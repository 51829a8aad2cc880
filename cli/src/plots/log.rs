//! Charts with logarithmic scales.

use plotters::coord::ranged1d::{NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;

use super::{
    BOTTOM, FINE, HEIGHT, LEFT, LEGEND, LINE, MARGIN, Outcome, THIN, TITLE, WIDTH, in_pixels, legend_text, superscript,
};

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marks {
    /// Joined points.
    Line,
    /// Joined dots.
    DottedLine,
    /// A broken horizontal line through the first point, which does not count for the ranges.
    Level,
    /// Dots.
    Dots,
    /// Rings.
    Rings,
    /// Crosses.
    Crosses,
    /// Triangles.
    Triangles,
}

/// A named curve or cloud of points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points, all coordinates greater than 0.
    pub points: Vec<(f64, f64)>,
    /// Colour.
    pub colour: RGBColor,
    /// How it is drawn.
    pub marks: Marks,
}

/// A range that holds all values, a little enlarged.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|x| x.is_finite() && *x > 0.0)
        .fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return (0.1, 10.0);
    }
    let pad = (high / low).powf(0.05).max(1.2);
    (low / pad, high * pad)
}

/// Decades of a range, thinned to at most nine, or steps of 1, 2, 5 where there are few decades.
fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let (first, last) = (low.log10().ceil() as i32, high.log10().floor() as i32);
    let factors: &[f64] = if last - first < 1 {
        &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]
    } else if last - first < 3 {
        &[1.0, 2.0, 5.0]
    } else {
        &[1.0]
    };
    let stride = 1 + (last - first).max(0) / 9;
    let decades = (first - 1..=last).filter(|e| e.rem_euclid(stride) == 0);
    let all = decades.flat_map(|e| factors.iter().map(move |f| f * 10f64.powi(e)));
    all.filter(|x| (low..=high).contains(x)).collect()
}

fn label(x: f64) -> String {
    if (1e-2..1e4).contains(&x) {
        let text = format!("{x:.3}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let e = (x.log10() + 1e-9).floor() as i32;
    let factor = (x / 10f64.powi(e)).round();
    if factor == 1.0 { format!("10{}", superscript(e)) } else { format!("{factor}·10{}", superscript(e)) }
}

/// A logarithmic axis: log10 of the values, with ticks where we want them.
struct Axis {
    range: (f64, f64),
    ticks: Vec<f64>,
}

impl Axis {
    fn new(range: (f64, f64)) -> Self {
        Axis { ticks: ticks(range), range: (range.0.log10(), range.1.log10()) }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let part = (value.log10() - self.range.0) / (self.range.1 - self.range.0);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }
    fn key_points<Hint: plotters::coord::ranged1d::KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }
    fn range(&self) -> std::ops::Range<f64> {
        10f64.powf(self.range.0)..10f64.powf(self.range.1)
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        label(*value)
    }
}

/// Draws curves over two logarithmic axes, the legend beside.
///
/// # Errors
/// Only such as the drawing backend has.
pub fn chart(title: &str, x_name: &str, y_name: &str, curves: &[Curve]) -> Outcome<String> {
    let shown = || curves.iter().filter(|c| c.marks != Marks::Level).flat_map(|c| &c.points);
    let (x, y) = (range(shown().map(|p| p.0)), range(shown().map(|p| p.1)));
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, HEIGHT)).into_drawing_area();
        root.fill(&WHITE)?;
        let (left, right) = root.split_horizontally(WIDTH - LEGEND);
        let (head, left) = left.split_vertically(TITLE);
        let place = ((LEFT + MARGIN) as i32, MARGIN as i32);
        head.draw(&Text::new(title, place, ("sans-serif", 16 * FINE)))?;
        let mut chart = ChartBuilder::on(&left)
            .margin(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(Axis::new(x), Axis::new(y))?;
        chart
            .configure_mesh()
            .x_desc(x_name)
            .y_desc(y_name)
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(THIN))
            .axis_style(RGBColor(90, 90, 90).stroke_width(THIN))
            .set_all_tick_mark_size(5 * FINE)
            .label_style(("sans-serif", 13 * FINE))
            .axis_desc_style(("sans-serif", 14 * FINE))
            .draw()?;
        let size = 3 * FINE as i32;
        for c in curves {
            let line = c.colour.stroke_width(LINE);
            let inside = |p: &&(f64, f64)| p.0 > 0.0 && p.1 > 0.0 && p.0.is_finite() && p.1.is_finite();
            let points: Vec<(f64, f64)> = c.points.iter().filter(inside).copied().collect();
            match c.marks {
                Marks::Level => {
                    if let Some((_, level)) = points.first().filter(|p| (y.0..y.1).contains(&p.1)) {
                        let ends = [(x.0, *level), (x.1, *level)];
                        let dash = 5 * FINE as i32;
                        chart.draw_series(DashedLineSeries::new(ends, dash, dash, line))?;
                    }
                }
                Marks::Line | Marks::DottedLine => {
                    chart.draw_series([PathElement::new(points.clone(), line)])?;
                    if c.marks == Marks::DottedLine {
                        chart.draw_series(points.into_iter().map(|p| Circle::new(p, size, c.colour.filled())))?;
                    }
                }
                Marks::Dots => {
                    chart.draw_series(points.into_iter().map(|p| Circle::new(p, size, c.colour.filled())))?;
                }
                Marks::Rings => {
                    chart.draw_series(points.into_iter().map(|p| Circle::new(p, size, c.colour.stroke_width(THIN))))?;
                }
                Marks::Crosses => {
                    chart.draw_series(points.into_iter().map(|p| Cross::new(p, size, c.colour.stroke_width(THIN))))?;
                }
                Marks::Triangles => {
                    let draw = |p| TriangleMarker::new(p, size, c.colour.stroke_width(THIN));
                    chart.draw_series(points.into_iter().map(draw))?;
                }
            }
        }
        let fine = FINE as i32;
        let step = (((HEIGHT - TITLE) as i32 - 20 * fine) / curves.len().max(1) as i32).clamp(11 * fine, 20 * fine);
        for (k, c) in curves.iter().enumerate() {
            let y = (TITLE + MARGIN) as i32 + step * k as i32;
            let middle = (11 * fine, y);
            let (full, thin) = (c.colour.filled(), c.colour.stroke_width(THIN));
            if matches!(c.marks, Marks::Line | Marks::DottedLine | Marks::Level) {
                right.draw(&PathElement::new(vec![(0, y), (22 * fine, y)], c.colour.stroke_width(LINE)))?;
            }
            match c.marks {
                Marks::Line | Marks::Level => {}
                Marks::Dots | Marks::DottedLine => right.draw(&Circle::new(middle, size, full))?,
                Marks::Rings => right.draw(&Circle::new(middle, size, thin))?,
                Marks::Crosses => right.draw(&Cross::new(middle, size, thin))?,
                Marks::Triangles => right.draw(&TriangleMarker::new(middle, size, thin))?,
            }
            legend_text(&right, &c.name, y)?;
        }
        root.present()?;
    }
    Ok(in_pixels(&text, HEIGHT))
}

#[cfg(test)]
mod tests {
    use super::{label, ticks};

    #[test]
    fn ticks_are_powers_of_ten_or_simple_multiples() {
        assert_eq!(ticks((1e-3, 1.5)).iter().map(|x| label(*x)).collect::<Vec<_>>(), ["10⁻³", "0.01", "0.1", "1"]);
        assert_eq!(ticks((9.0, 300.0)).iter().map(|x| label(*x)).collect::<Vec<_>>(), ["10", "20", "50", "100", "200"]);
        assert!(ticks((1e-16, 1.0)).len() <= 9);
    }
}
