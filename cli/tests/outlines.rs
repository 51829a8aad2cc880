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
    let line = format!("outline of fish.head: {told}; its points tell it to about 0.11 %");
    for arguments in [&["plan", "scene.toml"][..], &["evaluate", "scene.toml"]] {
        let done = place.nekton(arguments);
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert!(done.out.lines().any(|l| l == line), "{}", done.out);
    }
    let json: serde_json::Value =
        serde_json::from_str(&place.nekton(&["evaluate", "scene.toml", "--json"]).out).unwrap();
    assert!(json["outlines"]["fish.head"].as_str().unwrap().starts_with(told));
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.lines().any(|l| l.trim() == line), "{}", done.out);
    assert!(place.read("results/report.html").contains(&format!("<th>outline of fish.head</th><td>{told};")));
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
    // Of 32 nodes the corners of its tail would want more.
    let scene = |shape: &str| changed(HEAD, &format!("shape = {shape}")).replace("nodes = 32", "nodes = \"auto\"");
    let place = Place::new(&scene("{ naca = \"0030\", chord = 2.0, points = 41 }"));
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
    place.put("scene.toml", scene("{ curve = \"wing.csv\" }"));
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
    for (name, text) in [("wing.dxf", "  0\nSECTION\n  2\nENTITIES\n"), ("wing.dat", "0\r\nSECTION\r\n")] {
        let place = with(&format!("{{ curve = \"{name}\" }}"));
        place.put(name, text);
        let told = "is a DXF drawing, which is not read (save the outline as one path of an SVG picture, or its vertices as lines \
                    x,y of a CSV file)";
        refused(&place, &format!("{name}: {told}"));
    }
    for (shape, told) in [
        ("{ curve = \"wing.csv\", path = \"a\" }", "`path` is for SVG pictures only"),
        ("{ ellipse = [1.0, 0.4], path = \"a\" }", "`path` is for `curve` with an SVG picture only"),
    ] {
        let place = with(shape);
        place.put("wing.csv", ellipse(","));
        refused(&place, &format!("scene.toml:10: {told}"));
    }
}

fn picture(inside: &str) -> String {
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{inside}\n</svg>\n")
}

/// The head of GOOD alone, with another shape and as many nodes as it takes: mass matrix and added mass.
fn alone(shape: &str, file: &str) -> (serde_json::Value, [Vec<f64>; 2]) {
    let place = Place::new(&format!("[[body]]\n[[body.link]]\nshape = {shape}\ndensity = 1.0\n"));
    place.put("a.svg", file);
    let done = place.nekton(&["evaluate", "scene.toml", "--json"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let json: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let matrix = |name: &str| -> Vec<f64> {
        let rows = json[name].as_array().unwrap().iter();
        rows.flat_map(|r| r.as_array().unwrap().iter().map(|x| x.as_f64().unwrap())).collect()
    };
    let matrices = [matrix("mass_matrix"), matrix("added_mass")];
    (json, matrices)
}

#[test]
fn the_curve_through_a_path_s_points_follows_the_path() {
    // A circle of four cubic pieces encloses 4 (1/2 + 3 k/5 - 3 k²/20) r², by Green's formula on each.
    let k = 4.0 / 3.0 * (2.0_f64.sqrt() - 1.0);
    let four = format!("M1 0C1 {k} {k} 1 0 1S-1 {k}-1 0S-{k}-1 0-1S1-{k} 1 0Z");
    let arcs = "M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0Z".to_owned();
    let pi = std::f64::consts::PI;
    for (data, area, mass, off) in [(four, 2.0 + 2.4 * k - 0.6 * k * k, pi * 1.0003, 3e-4), (arcs, pi, pi, 1e-8)] {
        let (_, [all, added]) = alone("{ curve = \"a.svg\" }", &picture(&format!("<path d=\"{data}\"/>")));
        assert!(((all[0] - added[0]) / area - 1.0).abs() < 1e-8, "{} {area}", all[0] - added[0]);
        assert!((added[0] / mass - 1.0).abs() < off, "{} {mass}", added[0]);
    }
    // An ellipse of arcs, moved: its added mass in closed form.
    let data = "<g transform=\"translate(7 7) scale(2 1)\"><path d=\"M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0Z\"/></g>";
    let (_, [_, added]) = alone("{ curve = \"a.svg\" }", &picture(data));
    for (k, right) in [(0, pi), (1, 0.0), (2, 0.0), (4, 4.0 * pi), (5, 0.0), (8, 9.0 * pi / 8.0)] {
        assert!((added[k] - right).abs() < 1e-7, "{k} {} {right}", added[k]);
    }
    // A rectangle with rounded corners.
    let data = "M1.1 1H4.9A.1 .1 0 0 1 5 1.1V1.9A.1 .1 0 0 1 4.9 2H1.1A.1 .1 0 0 1 1 1.9V1.1A.1 .1 0 0 1 1.1 1Z";
    let (json, drawn) = alone("{ curve = \"a.svg\" }", &picture(&format!("<g><path id=\"box\" d=\"{data}\"/></g>")));
    let told = json["outlines"]["body1.link1"].as_str().unwrap();
    let start = "a.svg (path `box`, 36 curved pieces, 4 straight pieces, y turned upwards): ";
    assert!(told.starts_with(start), "{told}");
    assert!(
        told.contains("chord (along x) 4 m, height (along y) 1 m, area of the polygon through them 3.99"),
        "{told}"
    );
    let area = 4.0 - (4.0 - pi) * 0.01;
    assert!((drawn[0][0] - drawn[1][0] - area).abs() < 1e-8 * area, "{drawn:?} {area}");
    // That of the scene is rounded a little otherwise.
    let (_, plain) = alone("{ rectangle = [4.0, 1.0], radius = 0.1 }", "");
    for (a, b) in drawn.iter().flatten().zip(plain.iter().flatten()) {
        assert!((a - b).abs() < 2e-4 * plain[0][4], "{drawn:?}\n{plain:?}");
    }
    // One of several by its name, and nothing beside it.
    let many = picture(&format!("<rect/><path id=\"one\" d=\"M0 0H9V9Z\"/><path id=\"two\" d=\"{data}\"/>"));
    assert_eq!(alone("{ curve = \"a.svg\", path = \"two\" }", &many).1, drawn);
}

#[test]
fn bad_pictures_are_refused_with_file_line_and_a_way_out() {
    let place = with("{ curve = \"wing.svg\" }");
    for (text, told) in [
        (picture(""), "wing.svg: has no path (an outline is a <path> that is drawn)"),
        (
            picture("<path id=\"a\" d=\"M0 0H2V1\"/>"),
            "wing.svg:2: path `a` is open: it begins at [0, 0] and ends at [2, -1] (y upwards) (close it, by a Z at the end of its d)",
        ),
        (
            picture("<path d=\"M0 0H2V1Z\"/><circle r=\"1\"/>"),
            "wing.svg: draws 2 things, but an outline is one: a path without id, a <circle> (name one with path = \"id\" beside \
             `curve`, or delete the others)",
        ),
        ("1,2\n2,3\n".to_owned(), "wing.svg: has 2 points"),
    ] {
        place.put("wing.svg", &text);
        let done = place.nekton(&["plan", "scene.toml"]);
        assert!(done.code == Some(2) && done.err.starts_with(told) && done.err.lines().count() == 1, "{}", done.err);
    }
    place.put("wing.svg", b"\x1f\x8b\x08\x00");
    refused(&place, "wing.svg: is compressed (save it as plain SVG or CSV)");
    place.put("wing.svg", b"\x89PNG\r\n\x1a\n\x00\x00");
    let hint = "an outline is a CSV file with columns x,y, an aerofoil's .dat file, or an SVG picture";
    refused(&place, &format!("wing.svg: is not text ({hint})"));
    let place = with("{ curve = \"wing.svg\", path = \"fin\" }");
    place.put("wing.svg", picture("<path id=\"fun\" d=\"M0 0H2V1Z\"/>"));
    refused(&place, "wing.svg: has no path with the id `fin` (did you mean `fun`?)");
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

#[test]
fn points_that_leave_an_outline_uncertain_are_noticed_and_those_where_it_turns_by_far_named() {
    let told = |shape: &str, command: &[&str]| {
        let scene = changed(HEAD, &format!("shape = {shape}")).replace("nodes = 32", "nodes = \"auto\"");
        let done = Place::new(&scene).nekton(&[command, &["scene.toml"]].concat());
        assert_eq!(done.code, Some(0), "{}", done.err);
        done.out
    };
    let plan = |shape: &str| told(shape, &["plan"]);
    const UNCERTAIN: &str = "link `fish.head`: its points tell its outline no better than to about";
    // A square by its corners and the middles of its sides is a smooth curve, 5 % off; with its corners named it is a square.
    let square = "[[1,1],[0,1],[-1,1],[-1,0],[-1,-1],[0,-1],[1,-1],[1,0]]".replace('1', "0.4");
    let smooth = plan(&format!("{{ curve = {square} }}"));
    assert!(smooth.contains(&format!("notice: {UNCERTAIN} 29 % of added mass")), "{smooth}");
    assert!(
        smooth.contains("it turns by up to 90° at its points 0, 2, 4, 6 (counted from 0), which are no corners"),
        "{smooth}"
    );
    let named = plan(&format!("{{ curve = {square}, corners = [6, 0, 2, 4] }}"));
    assert!(
        !named.contains("no better than") && named.contains("outline of fish.head: its points tell it to about"),
        "{named}"
    );
    // All but one of them named: the last one is.
    let three = plan(&format!("{{ curve = {square}, corners = [0, 2, 4] }}"));
    assert!(three.contains("by up to 90° at its points 6 (counted"), "{three}");
    // Round outlines, a section and closed forms are well told.
    let ring = |n: usize| -> String {
        let points = (0..n).map(|k| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos());
        points.map(|(s, c)| format!("[{},{}],", 0.4 * c, 0.4 * s)).collect()
    };
    let round = format!("{{ curve = [{}] }}", ring(12));
    for shape in [&round, "{ naca = \"0006\", chord = 1.0 }", "{ ellipse = [0.4, 0.1] }"] {
        assert!(!plan(shape).contains("no better than"), "{shape}");
    }
    // A tip between two points of an ellipse 1 : 10 is nowhere sharp, and half as long again would not show in any bound.
    let thin: String = (0..16)
        .map(|k| (std::f64::consts::TAU * (k as f64 + 0.5) / 16.0).sin_cos())
        .map(|(s, c)| format!("[{},{}],", 0.4 * c, 0.04 * s))
        .collect();
    assert!(plan(&format!("{{ curve = [{thin}] }}")).contains(UNCERTAIN));
    let json: serde_json::Value = serde_json::from_str(&told(&round, &["evaluate", "--json"])).unwrap();
    let error = json["outline_errors"]["fish.head"].as_f64().unwrap();
    assert!(error > 1e-9 && error < 1e-4, "{error}");
}

#[test]
fn a_corner_named_twice_points_too_close_and_drawings_too_far_are_told_as_what_they_are() {
    let ring = |n: usize, far: f64, twin: Option<f64>| -> String {
        let point = |t: f64| format!("[{:.17e},{:.17e}],", far + t.cos(), 0.8 * t.sin());
        let at = |k: usize| std::f64::consts::TAU * k as f64 / n as f64;
        let mut points: Vec<String> = (0..n).map(|k| point(at(k))).collect();
        if let Some(off) = twin {
            let t = at(5) + 1e-4 * at(1);
            points.insert(6, format!("[{:.17e},{:.17e}],", (1.0 + off) * t.cos(), 0.8 * (1.0 + off) * t.sin()));
        }
        points.concat()
    };
    let plan = |shape: String| with(&shape).nekton(&["plan", "scene.toml"]);
    let done = plan(format!("{{ curve = [{}], corners = [3, 0, 3] }}", ring(24, 0.0, None)));
    assert!(done.code == Some(2) && done.err.contains("names the corner 3 twice"), "{}", done.err);
    let done = plan(format!("{{ curve = [{}] }}", ring(24, 0.0, Some(3e-5))));
    assert!(done.out.contains("its points 5 and 6 (counted from 0) are so close that"), "{}", done.out);
    // Its points are off by what their coordinates do not hold: more of them would not help.
    for far in [1e13, 1e15] {
        let done = plan(format!("{{ curve = [{}] }}", ring(400, far, None)));
        let told = format!("{}{}", done.out, done.err);
        assert!(
            told.contains("draw it nearer to its origin")
                && !told.contains("give more")
                && !told.contains("give it some"),
            "{far:e}: {told}"
        );
    }
}
