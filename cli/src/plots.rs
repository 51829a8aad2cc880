//! Plots as SVG text.

pub mod log;

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::record::{Record, Row, base, shortest};

/// Colours that people with any colour vision can tell apart (after Okabe and Ito).
pub const COLOURS: [(u8, u8, u8); 8] = [
    (0, 114, 178),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (150, 110, 40),
    (86, 180, 233),
    (60, 60, 60),
    (230, 159, 0),
];

// Lengths are in tenths of a pixel: the backend rounds to whole units, and whole pixels would make lines jagged.
const FINE: u32 = 10;
const WIDTH: u32 = 860 * FINE;
const HEIGHT: u32 = 420 * FINE;
const MARGIN: u32 = 14 * FINE;
const LEGEND: u32 = 190 * FINE;
const LEFT: u32 = 64 * FINE;
const BOTTOM: u32 = 46 * FINE;
const TITLE: u32 = 34 * FINE;
const THIN: u32 = FINE;
const LINE: u32 = 15;
const THICK: u32 = 24;
const GREY: RGBColor = RGBColor(120, 120, 120);

/// A named line.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points.
    pub points: Vec<(f64, f64)>,
    /// Colour.
    pub colour: RGBColor,
    /// Drawn thick, below thin ones.
    pub thick: bool,
}

/// What drawing gives.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Colour number `k` of [`COLOURS`], which repeat.
pub fn colour(k: usize) -> RGBColor {
    let (r, g, b) = COLOURS[k % COLOURS.len()];
    RGBColor(r, g, b)
}

/// All plots of a run: file name and SVG text.
pub(crate) fn all(record: &Record) -> Outcome<Vec<(&'static str, String)>> {
    let mut plots = vec![
        ("trajectories.svg", trajectories(record)?),
        ("energy.svg", over_time("Energy", "energy", "J/m", &energies(record))?),
        (
            "momentum.svg",
            over_time("Momentum of bodies and fluid", "momentum", "N s/m; angular: N s", &momenta(record))?,
        ),
    ];
    if !record.joints.is_empty() {
        let unit = if record.terms.slider { "hinge: N, slider: N/m" } else { "N" };
        plots.push(("torque.svg", over_time("Joint torques", "torque", unit, &torques(record))?));
    }
    if record.terms.fluid {
        plots.push(("resolution.svg", over_time("Error in space", "relative error", "log₁₀", &resolutions(record))?));
    }
    Ok(plots)
}

/// A quantity over time.
fn line(record: &Record, name: &str, colour: RGBColor, value: impl Fn(&Row) -> f64) -> Series {
    let points = record.rows.iter().map(|r| (r.t, value(r))).filter(|p| p.1.is_finite()).collect();
    Series { name: name.to_owned(), points, colour, thick: false }
}

fn energies(record: &Record) -> Vec<Series> {
    let mut series = vec![line(record, "kinetic, bodies", colour(0), |r| r.energy.kinetic_bodies)];
    if record.terms.fluid {
        series.push(line(record, "kinetic, fluid", colour(1), |r| r.energy.kinetic_fluid));
    }
    if record.terms.gravity {
        series.push(line(record, "buoyancy", colour(2), |r| r.energy.buoyancy));
    }
    if record.terms.repulsion {
        series.push(line(record, "repulsion", colour(3), |r| r.energy.repulsion));
    }
    if record.terms.circulation {
        series.push(line(record, "circulation", colour(4), |r| r.energy.circulation));
    }
    if !record.joints.is_empty() {
        series.push(line(record, "work of the joints", colour(5), |r| r.energy.work));
    }
    let total = line(record, "total", RGBColor(0, 0, 0), |r| r.energy.total);
    series.push(Series { thick: true, ..total });
    series
}

fn momenta(record: &Record) -> Vec<Series> {
    vec![
        line(record, "along x", colour(0), |r| r.impulse[0]),
        line(record, "along y", colour(1), |r| r.impulse[1]),
        line(record, "angular, about 0", colour(2), |r| r.impulse[2]),
    ]
}

fn torques(record: &Record) -> Vec<Series> {
    let torque = |k: usize| move |r: &Row| r.torque.get(k).map_or(f64::NAN, |t| t[0]);
    record.joints.iter().enumerate().map(|(k, name)| line(record, name, colour(k), torque(k))).collect()
}

/// Indicators as powers of ten, not below rounding.
fn resolutions(record: &Record) -> Vec<Series> {
    let power = |x: f64| x.max(1e-17).log10();
    let mut series = vec![
        line(record, "mass", colour(0), |r| power(r.resolution.mass)),
        line(record, "force", colour(1), |r| power(r.resolution.force)),
        line(record, "quadrature", colour(2), |r| power(r.resolution.quadrature)),
    ];
    if record.terms.repulsion {
        series.push(line(record, "repulsion", colour(4), |r| power(r.resolution.repulsion)));
    }
    let bound = line(record, "bound", RGBColor(0, 0, 0), |r| power(r.resolution.bound()));
    series.push(Series { thick: true, ..bound });
    if record.tolerance > 0.0 {
        series.push(line(record, "asked", colour(3), |_| power(record.tolerance)));
    }
    series
}

/// Numbers beyond are not drawn: their differences may be none.
const LARGEST: f64 = 1e300;

/// Smallest interval that holds all values, a little enlarged.
fn bounds(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.abs() <= LARGEST)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if low > high {
        return (-1.0, 1.0);
    }
    let size = high - low;
    let flat = size <= 1e-12 * low.abs().max(high.abs());
    let pad = if !flat {
        0.06 * size
    } else if low == 0.0 {
        1.0
    } else {
        0.1 * low.abs()
    };
    (low - pad, high + pad)
}

/// Power of ten taken out of an axis so that its numbers stay short.
fn exponent(range: (f64, f64)) -> i32 {
    let size = range.0.abs().max(range.1.abs());
    let e = size.log10().floor();
    if (-2.0..4.0).contains(&e) { 0 } else { e as i32 }
}

fn superscript(e: i32) -> String {
    e.to_string()
        .chars()
        .map(|c| match c.to_digit(10) {
            Some(d) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][d as usize],
            None => '⁻',
        })
        .collect()
}

fn axis(name: &str, unit: &str, e: i32) -> String {
    if e == 0 { format!("{name} ({unit})") } else { format!("{name} (10{} {unit})", superscript(e)) }
}

/// The name of a quantity from which a number was taken.
fn less(name: &str, from: f64) -> String {
    match from {
        0.0 => name.to_owned(),
        x if x < 0.0 => format!("{name} + {}", shortest(-x)),
        x => format!("{name} − {}", shortest(x)),
    }
}

/// A tick's number, without the digits that come from binary rounding.
fn tick(x: &f64) -> String {
    let text = format!("{x:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A quantity over time.
///
/// # Errors
/// Only such as the drawing backend has.
pub fn over_time(title: &str, name: &str, unit: &str, series: &[Series]) -> Outcome<String> {
    let times = series.iter().flat_map(|s| s.points.iter().map(|p| p.0));
    let (from, to) = times.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
    let times = if from < to { (from, to) } else { (0.0, 1.0) };
    let (low, high) = bounds(series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
    // Where all values are far from 0 they are drawn from a number near them.
    let from = base(low, high, high - low);
    let moved: Vec<Series>;
    let (name, series) = if from == 0.0 {
        (name.to_owned(), series)
    } else {
        let near = |s: &Series| Series { points: s.points.iter().map(|p| (p.0, p.1 - from)).collect(), ..s.clone() };
        moved = series.iter().map(near).collect();
        (less(name, from), moved.as_slice())
    };
    draw(title, ("time (s)", times), (&name, unit, (low - from, high - from)), HEIGHT, series, &[])
}

fn trajectories(record: &Record) -> Outcome<String> {
    let mut shapes: Vec<(Vec<[f64; 2]>, RGBColor)> = Vec::new();
    let from = record.origin();
    let walls = record.tank.iter().chain(&record.obstacles);
    let near = |w: &Vec<[f64; 2]>| w.iter().map(|p| [p[0] - from[0], p[1] - from[1]]).collect();
    shapes.extend(walls.map(|w| (near(w), GREY)));
    for row in [record.rows.first(), record.rows.last()].into_iter().flatten() {
        let links = record.outlines.iter().zip(&row.pose).enumerate();
        shapes.extend(links.map(|(k, (outline, pose))| (Record::placed_from(outline, pose, from), colour(k))));
    }
    let series: Vec<Series> = record
        .links
        .iter()
        .enumerate()
        .map(|(k, link)| Series {
            name: link.clone(),
            points: record
                .rows
                .iter()
                .filter_map(|r| r.pose.get(k))
                .map(|p| (p[0] - from[0], p[1] - from[1]))
                .collect(),
            colour: colour(k),
            thick: true,
        })
        .collect();
    let all = || {
        let outlines = shapes.iter().flat_map(|(o, _)| o.iter().map(|p| (p[0], p[1])));
        outlines.chain(series.iter().flat_map(|s| s.points.iter().copied()))
    };
    let (x, y) = (bounds(all().map(|p| p.0)), bounds(all().map(|p| p.1)));
    // Equal scales: the height follows from the shape of the picture within limits, the shorter side is widened.
    let inner = f64::from(WIDTH - LEGEND - LEFT - 2 * MARGIN);
    let frame = f64::from(TITLE + BOTTOM + 2 * MARGIN);
    let height = (inner * (y.1 - y.0) / (x.1 - x.0)).clamp(260.0 * f64::from(FINE), 620.0 * f64::from(FINE));
    let unit = ((x.1 - x.0) / inner).max((y.1 - y.0) / height);
    let widen = |r: (f64, f64), size: f64| (0.5 * (r.0 + r.1 - size), 0.5 * (r.0 + r.1 + size));
    let title = "Paths of the centres of mass, bodies at start and end";
    let (x, y) = (widen(x, unit * inner), widen(y, unit * height));
    let x_name = format!("{} (m)", less("x", from[0]));
    draw(title, (&x_name, x), (&less("y", from[1]), "m", y), (height + frame) as u32, &series, &shapes)
}

fn draw(
    title: &str,
    (x_name, x): (&str, (f64, f64)),
    (y_name, y_unit, y): (&str, &str, (f64, f64)),
    height: u32,
    series: &[Series],
    shapes: &[(Vec<[f64; 2]>, RGBColor)],
) -> Outcome<String> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (WIDTH, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let (left, right) = root.split_horizontally(WIDTH - LEGEND);
        legend(&right, series)?;
        let (head, left) = left.split_vertically(TITLE);
        let place = ((LEFT + MARGIN) as i32, MARGIN as i32);
        head.draw(&Text::new(title, place, ("sans-serif", 16 * FINE)))?;
        let e = exponent(y);
        let unit = 10f64.powi(e);
        // A picture of shapes must not be scaled in one direction only.
        let unit = if shapes.is_empty() { unit } else { 1.0 };
        let e = if shapes.is_empty() { e } else { 0 };
        let mut chart = ChartBuilder::on(&left)
            .margin(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(x.0..x.1, y.0 / unit..y.1 / unit)?;
        chart
            .configure_mesh()
            .x_desc(x_name)
            .y_desc(axis(y_name, y_unit, e))
            .x_labels(8)
            .y_labels(8)
            .x_label_formatter(&tick)
            .y_label_formatter(&tick)
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(THIN))
            .axis_style(RGBColor(90, 90, 90).stroke_width(THIN))
            .set_all_tick_mark_size(5 * FINE)
            .label_style(("sans-serif", 13 * FINE))
            .axis_desc_style(("sans-serif", 14 * FINE))
            .draw()?;
        for (outline, colour) in shapes {
            let points: Vec<(f64, f64)> = outline.iter().map(|p| (p[0], p[1])).collect();
            chart.draw_series([Polygon::new(points.clone(), colour.mix(0.12))])?;
            let closed = points.iter().chain(points.first()).copied();
            chart.draw_series([PathElement::new(closed.collect::<Vec<_>>(), colour.mix(0.8).stroke_width(THIN))])?;
        }
        // Thick lines first: where a thin one coincides with them it still shows.
        for s in series.iter().filter(|s| s.thick).chain(series.iter().filter(|s| !s.thick)) {
            let style = s.colour.stroke_width(if s.thick { THICK } else { LINE });
            let scaled: Vec<(f64, f64)> = s.points.iter().map(|p| (p.0, p.1 / unit)).collect();
            chart.draw_series([PathElement::new(scaled, style)])?;
        }
        root.present()?;
    }
    Ok(in_pixels(&text, height))
}

/// Names beside the picture, so that they never cover a line.
fn legend(area: &DrawingArea<SVGBackend<'_>, Shift>, series: &[Series]) -> Outcome<()> {
    let height = area.dim_in_pixel().1 as i32;
    let fine = FINE as i32;
    let room = height - TITLE as i32 - 20 * fine;
    let step = (room / series.len().max(1) as i32).clamp(11 * fine, 20 * fine);
    for (k, s) in series.iter().enumerate() {
        let y = (TITLE + MARGIN) as i32 + step * k as i32;
        if y + step > height {
            break;
        }
        let style = s.colour.stroke_width(if s.thick { THICK } else { LINE });
        area.draw(&PathElement::new(vec![(0, y), (22 * fine, y)], style))?;
        legend_text(area, &s.name, y)?;
    }
    Ok(())
}

/// A name in the legend, cut if it is too long.
fn legend_text(area: &DrawingArea<SVGBackend<'_>, Shift>, name: &str, y: i32) -> Outcome<()> {
    let fine = FINE as i32;
    let name: String =
        if name.chars().count() > 24 { name.chars().take(23).chain(['…']).collect() } else { name.to_owned() };
    area.draw(&Text::new(name, (28 * fine, y - 7 * fine), ("sans-serif", 13 * FINE)))?;
    Ok(())
}

/// Shown in whole pixels, drawn in tenths.
fn in_pixels(svg: &str, height: u32) -> String {
    let fine = format!("width=\"{WIDTH}\" height=\"{height}\"");
    svg.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", WIDTH / FINE, height / FINE), 1)
}

#[cfg(test)]
mod tests {
    use super::{Series, colour, over_time, trajectories};
    use crate::record::{Record, Row};

    /// Every number of the picture is one, and it has ticks that differ.
    fn sound(svg: &str, what: &str) {
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{what}: {svg}");
        let texts: Vec<&str> =
            svg.split("<text").skip(1).filter_map(|t| t.split_once(">\n")?.1.split('\n').next()).collect();
        let ticks = |side: &str| svg.split("<text").skip(1).filter(|t| t.contains(side)).count();
        assert!(ticks("text-anchor=\"end\"") >= 2, "{what}: {texts:?}");
    }

    #[test]
    fn plots_have_an_end_and_numbers_at_any_offset_and_range() {
        let offsets = [0.0, 1.0, -1.0, 1e-20, 1e3, 1e6, -1e9, 123_456_789.123, 1e12, 1e17, -1e17, 1e100, 1e308];
        for offset in offsets {
            for size in [0.0, 1e-300, 1e-20, 1e-6, 1.0, 16.0, 1e5, 1e17, 1e300] {
                let what = format!("{offset} {size}");
                let wave = |k: i32| offset + size * (0.3 * f64::from(k)).sin();
                let points = (0..50).map(|k| (f64::from(k), wave(k))).filter(|p| p.1.is_finite()).collect();
                let series = [Series { name: "s".into(), points, colour: colour(0), thick: false }];
                sound(&over_time("title", "name", "unit", &series).unwrap(), &what);
                let row = |k: i32| Row { pose: vec![[wave(k), offset, 0.1]], ..Row::default() };
                let record = Record {
                    links: vec!["b.l".into()],
                    outlines: vec![vec![[1.0, 0.0], [0.0, 0.5], [-1.0, 0.0]]],
                    rows: (0..50).map(row).collect(),
                    ..Record::default()
                };
                sound(&trajectories(&record).unwrap(), &what);
            }
        }
    }

    #[test]
    fn values_far_from_zero_are_drawn_from_a_number_near_them() {
        let points = (0..9).map(|k| (f64::from(k), 1e9 + 0.25 * f64::from(k))).collect();
        let series = [Series { name: "s".into(), points, colour: colour(0), thick: false }];
        let svg = over_time("title", "energy", "J/m", &series).unwrap();
        assert!(svg.contains("energy − 1e9 (J/m)"), "{svg}");
    }
}
