//! The report: one HTML page without any reference to the network.

use serde_json::{Value, json};

use crate::plots::COLOURS;
use crate::record::{Record, shortest};

const PAGE: &str = include_str!("report.html");
/// The animation interpolates between its frames; more than this many only make the page large.
const MOST_FRAMES: usize = 2000;

/// What a page says of a run that reached its end.
pub const COMPLETE: &str = "<p class=\"ok\">The run reached its end.</p>";

/// The page.
pub fn page(title: &str, record: &Record, plots: &[(&'static str, String)], scene_text: &str) -> String {
    let figures: String = plots.iter().map(|(_, svg)| format!("<figure>{}</figure>\n", inline(svg))).collect();
    let status = match &record.stopped {
        None => COMPLETE.to_owned(),
        Some(why) => format!("<p class=\"stopped\">The run stopped early: {}.</p>", escape(why)),
    };
    let notices: String = record.notices.iter().map(|n| format!("<li>{}</li>", escape(n))).collect();
    let notices = if notices.is_empty() { String::new() } else { format!("<h2>Notices</h2><ul>{notices}</ul>") };
    let fill = |name: &str| match name {
        "title" => escape(title),
        "status" => status.clone(),
        "notices" => notices.clone(),
        "plots" => figures.clone(),
        "settings" => rows(&record.settings),
        "figures" => rows(&record.figures),
        "plan" => escape(&record.plan),
        "scene" => escape(scene_text),
        "version" => escape(env!("CARGO_PKG_VERSION")),
        // `<` never appears in the data, so nothing in it can end the script.
        "data" => data(record).to_string().replace('<', "\\u003c"),
        _ => String::new(),
    };
    let mut page = String::new();
    let mut rest = PAGE;
    while let Some((before, after)) = rest.split_once("{{") {
        let Some((name, tail)) = after.split_once("}}") else { break };
        page.push_str(before);
        page.push_str(&fill(name));
        rest = tail;
    }
    page.push_str(rest);
    page
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn rows(pairs: &[(String, String)]) -> String {
    pairs.iter().map(|(k, v)| format!("<tr><th>{}</th><td>{}</td></tr>", escape(k), escape(v))).collect()
}

/// An SVG file as part of a page: no XML head, size by the page.
fn inline(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |k| &svg[k..])
}

/// A number short enough for a picture.
fn short(x: f64) -> Value {
    if x.is_finite() { format!("{x:.6e}").parse::<f64>().map_or(Value::Null, |x| json!(x)) } else { Value::Null }
}

fn outline(points: &[[f64; 2]]) -> Value {
    points.iter().map(|p| json!([short(p[0]), short(p[1])])).collect()
}

fn data(record: &Record) -> Value {
    let stride = record.rows.len().div_ceil(MOST_FRAMES).max(1);
    let last = record.rows.len().saturating_sub(1);
    let chosen = || record.rows.iter().enumerate().filter(|(k, _)| k % stride == 0 || *k == last).map(|(_, r)| r);
    let origin = record.origin();
    let near = |points: &[[f64; 2]]| -> Value {
        outline(&points.iter().map(|p| [p[0] - origin[0], p[1] - origin[1]]).collect::<Vec<_>>())
    };
    let pose = |p: &[f64; 3]| [short(p[0] - origin[0]), short(p[1] - origin[1]), short(p[2])];
    json!({
        "links": record.links,
        "origin": origin.iter().any(|x| *x != 0.0).then(|| origin.map(shortest)),
        "colours": COLOURS.iter().map(|(r, g, b)| format!("rgb({r},{g},{b})")).collect::<Vec<_>>(),
        "outlines": record.outlines.iter().map(|o| outline(o)).collect::<Vec<_>>(),
        "obstacles": record.obstacles.iter().map(|o| near(o)).collect::<Vec<_>>(),
        "tank": record.tank.as_ref().map(|t| near(t)),
        "t": chosen().map(|r| short(r.t)).collect::<Vec<_>>(),
        "gap": chosen().map(|r| short(r.gap)).collect::<Vec<_>>(),
        "pose": chosen().map(|r| r.pose.iter().flat_map(pose).collect()).collect::<Vec<Value>>(),
    })
}
