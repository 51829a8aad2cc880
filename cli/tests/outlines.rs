//! Outlines from files and by formula: what was read is told, and what is no outline is refused.

mod common;
use common::{Place, changed};

const HEAD: &str = "shape = { ellipse = [1.0, 0.4] }";

/// Points of the ellipse of GOOD's head, as a line each.
fn ellipse(separator: &str) -> String {
    let points = (0..32).map(|k| f64::from(k) / 32.0 * std::f64::consts::TAU).map(|t| (t.cos(), 0.4 * t.sin()));
    points.map(|(x, y)| format!("{x:.9}{separator}{y:.9}\n")).collect()
}

fn with(shape: &str) -> Place {
    Place::new(&changed(HEAD, &format!("shape = {shape}")))
}

fn refused(place: &Place, line: &str) {
    let done = place.nekton(&["plan", "scene.toml"]);
    assert_eq!((done.code, done.err.trim()), (Some(2), line));
    assert_eq!(done.out, "");
}

#[test]
fn what_was_read_is_told_by_plan_evaluate_and_run() {
    let place = with("{ curve = \"wing.dat\" }");
    place.put("wing.dat", format!("Wing 7\r\n{}   \r\n", ellipse("  ")));
    let told = "wing.dat (`Wing 7`): 32 points, counter-clockwise, chord (along x) 2 m, height (along y) 0.8 m, \
                area of the polygon through them 1.24858 m²";
    let line = format!("outline of fish.head: {told}");
    for arguments in [&["plan", "scene.toml"][..], &["evaluate", "scene.toml"]] {
        let done = place.nekton(arguments);
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert!(done.out.lines().any(|l| l == line), "{}", done.out);
    }
    let json: serde_json::Value =
        serde_json::from_str(&place.nekton(&["evaluate", "scene.toml", "--json"]).out).unwrap();
    assert_eq!(json["outlines"]["fish.head"], told);
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.lines().any(|l| l.trim() == line), "{}", done.out);
    assert!(place.read("results/report.html").contains(&format!("<th>outline of fish.head</th><td>{told}</td>")));
    // Points that the scene shows need no word.
    assert!(!Place::new(common::GOOD).nekton(&["plan", "scene.toml"]).out.contains("outline"));
}

#[test]
fn the_same_outline_in_other_files_is_the_same_body() {
    let matrices = |place: &Place| {
        let done = place.nekton(&["evaluate", "scene.toml", "--json"]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        let json: serde_json::Value = serde_json::from_str(&done.out).unwrap();
        json["added_mass"].clone()
    };
    let place = with("{ curve = \"wing.csv\" }");
    place.put("wing.csv", format!("x,y\n{}", ellipse(",")));
    let usual = matrices(&place);
    let rows = ellipse(";").replace('.', ",");
    place.put("wing.csv", format!("\u{feff}X [m];Y [m]\r\n{};;\r\n", rows.replace('\n', "\r\n")));
    assert_eq!(matrices(&place), usual);
    place.put("wing.csv", format!("Wing\n{}", ellipse("\t")));
    assert_eq!(matrices(&place), usual);
}

#[test]
fn a_section_by_formula_is_the_curve_through_its_points() {
    let place = with("{ naca = \"0030\", chord = 2.0, points = 41 }");
    let json = |place: &Place| -> serde_json::Value {
        let done = place.nekton(&["evaluate", "scene.toml", "--json"]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        serde_json::from_str(&done.out).unwrap()
    };
    let by_name = json(&place);
    let told = by_name["outlines"]["fish.head"].as_str().unwrap();
    assert!(told.starts_with("naca 0030, blunt tail: 41 points, counter-clockwise, chord (along x) 2 m, "), "{told}");
    let half =
        |x: f64| 1.5 * (0.2969 * x.sqrt() - 0.1260 * x - 0.3516 * x.powi(2) + 0.2843 * x.powi(3) - 0.1015 * x.powi(4));
    let point = |k: i32| {
        let x = 0.5 * (1.0 + (std::f64::consts::PI * f64::from(k) / 20.0).cos());
        format!("{:e},{:e}\n", 2.0 * x, 2.0 * half(x) * if k <= 20 { 1.0 } else { -1.0 })
    };
    place.put("scene.toml", changed(HEAD, "shape = { curve = \"wing.csv\" }"));
    place.put("wing.csv", (0..=40).map(point).collect::<String>());
    let by_points = json(&place);
    let list = |json: &serde_json::Value| -> Vec<f64> {
        let rows = json["added_mass"].as_array().unwrap().iter();
        rows.flat_map(|r| r.as_array().unwrap().iter().map(|x| x.as_f64().unwrap())).collect()
    };
    for (a, b) in list(&by_name).iter().zip(list(&by_points)) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn bad_sections_are_refused_with_key_and_line() {
    for (shape, told) in [
        ("{ naca = \"0012\" }", "`shape` needs `chord`"),
        ("{ naca = 2412, chord = 1.0 }", "`naca` must be a string, but is a number (write naca = \"2412\")"),
        ("{ naca = \"2412\", chord = 0.0 }", "`chord` must be greater than 0, but is 0"),
        ("{ naca = \"2412\", chord = 1.0, tail = \"round\" }", "`tail` cannot be `round` (allowed: blunt, sharp)"),
        (
            "{ naca = \"2412\", chord = 1.0, points = 160 }",
            "`points` must be odd, from 21 to 10001, both ends at the tail counted, but is 160",
        ),
        (
            "{ naca = \"64-215\", chord = 1.0 }",
            "`naca` cannot be `64-215`: known are those of four digits, such as 2412, and of five, 210 to 250 for the mean \
             line, such as 23012",
        ),
        ("{ ellipse = [1.0, 0.4], chord = 1.0 }", "`chord` is for `naca` only"),
        ("{ naca = \"2412\", chord = 1.0, radius = 0.1 }", "`radius` is for rectangles and polygons only"),
    ] {
        refused(&with(shape), &format!("scene.toml:10: {told}"));
    }
}

#[test]
fn bad_outline_files_are_refused_with_file_line_and_text() {
    let place = with("{ curve = \"wing.csv\" }");
    for (text, told) in [
        (
            "x,y\n0,0\n1,oops\n1,1\n",
            "wing.csv:3: `oops` in `1,oops` is not a number (each point is two numbers; a name before the points begins with a word)",
        ),
        ("x,y\n0,0\n1,0\n", "wing.csv: has 2 points; an outline needs at least 3"),
        ("", "wing.csv: is empty (each point is a line of two numbers, such as 0.5,0.1)"),
    ] {
        place.put("wing.csv", text);
        refused(&place, told);
    }
    let place = with("{ curve = \"wing.svg\" }");
    place.put("wing.svg", "<svg/>");
    refused(
        &place,
        "wing.svg: is an SVG picture, which is not read (write points along its path as lines x,y into a CSV file)",
    );
}

#[cfg(unix)]
#[test]
fn what_has_no_end_is_no_outline_and_no_table() {
    let pipe = |place: &Place| {
        let made = std::process::Command::new("mkfifo").arg(place.path("pipe.csv")).status().unwrap();
        assert!(made.success());
    };
    let curve = |file: &str| with(&format!("{{ curve = \"{file}\" }}"));
    let told = |what: &str| format!("scene.toml:10: `curve` names {what}, not a regular file");
    let place = curve("pipe.csv");
    pipe(&place);
    refused(&place, &told("pipe.csv, which cannot be read: it is a pipe"));
    refused(&curve("/dev/urandom"), &told("/dev/urandom, which cannot be read: it is a device"));
    refused(&curve("."), &told("., which cannot be read: it is a folder"));
    let place = curve("large.csv");
    std::fs::File::create(place.path("large.csv")).unwrap().set_len((16 << 20) + 1).unwrap();
    let large = "which cannot be read: it has more than the 16 MiB that are read of such a file";
    refused(&place, &format!("scene.toml:10: `curve` names large.csv, {large}"));

    let motion = "{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }";
    let place = Place::new(&changed(motion, "{ table = \"pipe.csv\" }"));
    pipe(&place);
    refused(&place, "scene.toml:20: `table` names pipe.csv, which cannot be read: it is a pipe, not a regular file");
    let place = Place::new(&changed(motion, "{ channel = \"neck\" }"));
    pipe(&place);
    let done = place.nekton(&["run", "scene.toml", "--out", "results", "--channel", "neck=pipe.csv"]);
    let told = "pipe.csv: cannot be read for channel `neck`: it is a pipe, not a regular file";
    assert_eq!((done.code, done.err.trim()), (Some(2), told));
    // A scene may come through a pipe or be a device, but has an end.
    let done = place.nekton(&["plan", "/dev/zero"]);
    let told = "/dev/zero: cannot be read: it has more than the 64 MiB that are read of such a file";
    assert_eq!((done.code, done.err.trim()), (Some(2), told));
}
