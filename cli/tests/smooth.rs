//! Points that scatter are told as such, and a curve within a distance of them is the outline that they were read from.

mod common;
use common::{Place, changed};

/// 400 points of a circle of radius 1, off by 1e-3 m across it.
const NOISY: &str = include_str!("noisy_circle.toml");

fn smoothed(key: &str) -> String {
    let line = NOISY.lines().find(|l| l.starts_with("shape")).unwrap();
    NOISY.replace(line, &line.replace("]] }", &format!("]], {key} }}")))
}

/// Rows of the added mass, and everything else.
fn evaluated(scene: &str) -> ([[f64; 3]; 3], serde_json::Value) {
    let done = Place::new(scene).nekton(&["evaluate", "scene.toml", "--json"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let json: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let mass = [0, 1, 2].map(|i| [0, 1, 2].map(|j| json["added_mass"][i][j].as_f64().unwrap()));
    (mass, json)
}

#[test]
fn a_circle_read_with_noise_is_smoothed_to_one() {
    for distance in ["3.5e-3", "0.05"] {
        let (mass, json) = evaluated(&smoothed(&format!("smooth = {distance}")));
        let pi = std::f64::consts::PI;
        for k in [0, 1] {
            // The points' own noise, 1e-3 by the square root of 400, is what is left.
            assert!((mass[k][k] / pi - 1.0).abs() < 1e-3, "{mass:?}");
            assert!(mass[k][2].abs() < 1e-5, "{mass:?}");
        }
        assert!((0.0..1e-6).contains(&mass[2][2]), "{mass:?}");
        // Ten times 1e-3 m over 2 m: no less is known of points that were moved.
        let error = json["outline_errors"]["body1.link1"].as_f64().unwrap();
        assert!((4e-3..6e-3).contains(&error), "{error}");
        let told = json["outlines"]["body1.link1"].as_str().unwrap();
        let start = format!(
            "smoothed within {distance} m: its points were moved by 3.1e-3 m at most, 1.0e-3 m rms (they scattered by about 1e-3 m)"
        );
        assert!(told.starts_with(&start.replace("0.05", "5e-2")) && !told.contains("smooth ="), "{told}");
        let notice = json["notices"][0].as_str().unwrap();
        assert!(notice.contains("smoothing may have changed its added mass by up to about 0.5"), "{notice}");
    }
}

#[test]
fn points_that_scatter_are_told_with_what_helps() {
    let (mass, json) = evaluated(NOISY);
    assert!(mass[2][2] > 1e-4, "{mass:?}");
    let help = "its points scatter by about 1e-3 m across it: `smooth = 3.";
    let told = json["outlines"]["body1.link1"].as_str().unwrap();
    assert!(told.starts_with(help) && told.contains("its points tell it to about 0."), "{told}");
    let notice = json["notices"][0].as_str().unwrap();
    assert!(notice.contains("no better than to about") && notice.contains(help), "{notice}");
    let place = Place::new(NOISY);
    let done = place.nekton(&["plan", "scene.toml"]);
    assert!(
        done.out.lines().any(|l| l.starts_with("outline of body1.link1: its points scatter by about 1e-3 m")),
        "{}",
        done.out
    );
    // A distance that is too short gets the same advice.
    let (_, json) = evaluated(&smoothed("smooth = 1e-3"));
    let short = json["outlines"]["body1.link1"].as_str().unwrap();
    assert!(short.starts_with("smoothed within 1e-3 m: ") && short.contains(help), "{short}");
    // What the advice says, done.
    let start = told.find("smooth = ").unwrap();
    let advice = told[start..].split('`').next().unwrap();
    let (mass, _) = evaluated(&smoothed(advice));
    assert!((0.0..1e-6).contains(&mass[2][2]), "{advice} {mass:?}");
}

#[test]
fn smoothing_that_changes_an_outline_is_noticed() {
    // A clean ellipse whose tips a distance of a tenth cuts off: its added inertia falls by two fifths.
    let ring: Vec<String> = (0..200)
        .map(|k| (std::f64::consts::TAU * f64::from(k) / 200.0).sin_cos())
        .map(|(s, c)| format!("[{c},{}]", 0.5 * s))
        .collect();
    let scene = |key: &str| {
        format!("[[body]]\n[[body.link]]\nshape = {{ curve = [{}]{key} }}\ndensity = 1.0\n", ring.join(","))
    };
    let (clean, json) = evaluated(&scene(""));
    assert_eq!(json["notices"], serde_json::json!([]));
    let (cut, json) = evaluated(&scene(", smooth = 0.1"));
    let change = (0..3).map(|k| (cut[k][k] - clean[k][k]).abs()).fold(0.0, f64::max) / clean[1][1];
    let told = json["outline_errors"]["body1.link1"].as_f64().unwrap();
    assert!(change > 0.1 && change < told, "{change} {told}");
    assert!(json["notices"][0].as_str().unwrap().contains("smoothing may have changed"), "{json}");
}

#[test]
fn files_and_corners_are_smoothed_too() {
    // A section whose tail is found, off by 3e-4 in turns of no pattern.
    let half =
        |x: f64| 0.6 * (0.2969 * x.sqrt() - 0.1260 * x - 0.3516 * x.powi(2) + 0.2843 * x.powi(3) - 0.1036 * x.powi(4));
    let row = |k: i32| {
        let x = (0.5 + 0.5 * (std::f64::consts::TAU * f64::from(k) / 160.0).cos()).clamp(0.0, 1.0);
        let off = if k == 0 { 0.0 } else { 3e-4 * (f64::from(k * k) * 1.7 + 0.3).sin() };
        let side = if k <= 80 { 1.0 } else { -1.0 };
        format!("{:.9},{:.9}\n", x, side * (if k == 0 { 0.0 } else { half(x) }) + off)
    };
    let file: String = (0..160).map(row).collect();
    let place = Place::new(
        "[[body]]\n[[body.link]]\nshape = { curve = \"wing.csv\", corners = [0], smooth = 6e-4 }\ndensity = 1.0\n",
    );
    place.put("wing.csv", file);
    let done = place.nekton(&["plan", "scene.toml"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let told = done.out.lines().find(|l| l.starts_with("outline of body1.link1: ")).unwrap();
    assert!(told.contains("wing.csv: 160 points") && told.contains("; smoothed within 6e-4 m: "), "{told}");
    assert!(
        told.contains(", the corner at point 0 (counted from 0) kept; the polygon through them has 0.08"),
        "{told}"
    );
}

#[test]
fn what_cannot_be_smoothed_is_refused_by_key_and_line() {
    const HEAD: &str = "shape = { ellipse = [1.0, 0.4] }";
    let ring: Vec<String> = (0..12)
        .map(|k| (std::f64::consts::TAU * f64::from(k) / 12.0).sin_cos())
        .map(|(s, c)| format!("[{},{}]", c, 0.4 * s))
        .collect();
    let curve = |key: &str| format!("{{ curve = [{}], smooth = {key} }}", ring.join(","));
    let hint = "a few times the scatter of its points is enough, such as";
    let only = "is for `curve` only, whose points may scatter";
    for (shape, told) in [
        (curve("0"), "must be greater than 0, but is 0".to_owned()),
        (curve("-1e-3"), "must be greater than 0, but is -0.001".to_owned()),
        (curve("nan"), "must be finite, but is nan".to_owned()),
        (curve("inf"), "must be finite, but is inf".to_owned()),
        (curve("\"auto\""), "must be a number, but is a string".to_owned()),
        (curve("2.5"), format!("must be less than the outline's size, 2 m, but is 2.5e0 ({hint} 2e-3)")),
        ("{ curve = [[0,0],[1,0],[0,1]], smooth = 1e-3 }".to_owned(), "needs at least 8 points, but there are 3 (leave it out)".to_owned()),
        (
            curve("1e-3").replace("[[", "[[1,0],["),
            "cannot part points that are one: point 1 repeats the one before it (leave one of the two out; points count from 0)".to_owned(),
        ),
        ("{ ellipse = [1.0, 0.4], smooth = 1e-3 }".to_owned(), only.to_owned()),
        ("{ polygon = [[0,0],[1,0],[0,1]], smooth = 1e-3 }".to_owned(), only.to_owned()),
        ("{ naca = \"0012\", chord = 1.0, smooth = 1e-3 }".to_owned(), only.to_owned()),
    ] {
        let done = Place::new(&changed(HEAD, &format!("shape = {shape}"))).nekton(&["plan", "scene.toml"]);
        assert_eq!((done.code, done.err.trim()), (Some(2), format!("scene.toml:10: `smooth` {told}").as_str()));
        assert_eq!(done.out, "");
    }
}
