use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::path::Path;

use svgtypes::{SimplePathSegment, SimplifyingPathParser};

use super::drawing::read;
use super::path::{along, parts};
use super::points::Outline;

type Points = Vec<[f64; 2]>;

fn outline(text: &str) -> Result<(Outline, String), String> {
    read(Path::new("o.svg"), text, None).map_err(|p| p.to_string())
}

fn reads(text: &str) -> Result<(Points, String), String> {
    outline(text).map(|(outline, kind)| (outline.points, kind))
}

fn picture(inside: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">\n{inside}\n</svg>\n"
    )
}

fn points(inside: &str) -> Points {
    reads(&picture(inside)).unwrap().0
}

fn path(data: &str) -> Points {
    points(&format!("<path d=\"{data}\"/>"))
}

fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let [u, v] = [[b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]];
    (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).abs()
}

/// The step after each point and the turn at it.
fn walk(points: &[[f64; 2]]) -> Vec<(f64, f64)> {
    let n = points.len();
    let at = |k: usize| points[k % n];
    let step = |k: usize| (at(k + 1)[0] - at(k)[0]).hypot(at(k + 1)[1] - at(k)[1]);
    (0..n).map(|k| (step(k), turn(at(k + n - 1), at(k), at(k + 1)))).collect()
}

#[test]
fn every_command_draws_what_the_same_line_drawn_otherwise_does() {
    for [a, b] in [
        ["M0 0L4 0L4 1L0 1Z", "M0,0 4,0 4,1 0,1z"],
        ["M0 0L4 0L4 1L0 1Z", "M0 0H4V1H0Z"],
        ["M1 2L5 2L5 3L1 3Z", "m1 2h4v1h-4z"],
        ["M1 2L5 2L5 3L1 3Z", "m1 2 4 0 0 1-4 0z"],
        ["M0 0C1-1 3-1 4 0C5 1-1 1 0 0Z", "M0 0c1-1 3-1 4 0S-1 1 0 0"],
        ["M0 0C1-1 3-1 4 0C5 1-1 1 0 0Z", "m0 0c1-1 3-1 4 0s-5 1-4 0z"],
        ["M0 0Q2-2 4 0Q6 2 0 3Z", "M0 0q2-2 4 0t-4 3z"],
        ["M0 0Q2-2 4 0Q6 2 0 3Z", "M0 0Q2-2 4 0T0 3Z"],
        // Without a curve before it, the control point is the point itself.
        ["M0 0L4 0C4 0 3 2 0 2Z", "M0 0H4S3 2 0 2Z"],
        // A part that draws nothing is none.
        ["M0 0L4 0L4 1Z", "M9 9M0 0L4 0L4 1Zm0 0z"],
        ["M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0Z", "M1 0a1 1 0 11-2 0a1 1 0 112 0"],
    ] {
        let [a, b] = [path(a), path(b)];
        assert_eq!(a.len(), b.len());
        assert!(a.iter().flatten().zip(b.iter().flatten()).all(|(x, y)| (x - y).abs() < 1e-14), "{a:?}\n{b:?}");
    }
}

#[test]
fn random_paths_have_the_pieces_that_the_parser_of_its_crate_makes_of_them() {
    let mut seed = 7_u64;
    let mut random = |n: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % n
    };
    for _ in 0..2000 {
        let mut data = String::from("M3 4");
        for _ in 0..1 + random(9) {
            let (command, numbers) =
                [("L", 2), ("H", 1), ("V", 1), ("C", 6), ("S", 4), ("Q", 4), ("T", 2)][random(7) as usize];
            data += &if random(2) == 0 { command.to_owned() } else { command.to_lowercase() };
            (0..numbers).for_each(|_| data += &format!(" {}.{}", random(40), random(1000)));
        }
        let part = parts(&data).unwrap().remove(0);
        let mut right: Points = Vec::new();
        for segment in SimplifyingPathParser::from(data.as_str()) {
            match segment.unwrap() {
                SimplePathSegment::LineTo { x, y } => right.push([x, y]),
                SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => right.extend([[x1, y1], [x2, y2], [x, y]]),
                SimplePathSegment::Quadratic { x1, y1, x, y } => right.extend([[x1, y1], [x, y]]),
                _ => {}
            }
        }
        let ours: Points = part
            .pieces
            .iter()
            .flat_map(|p| match p {
                kurbo::PathSeg::Line(l) => vec![l.p1],
                kurbo::PathSeg::Quad(q) => vec![q.p1, q.p2],
                kurbo::PathSeg::Cubic(c) => vec![c.p1, c.p2, c.p3],
            })
            .map(|p| [p.x, p.y])
            .collect();
        assert_eq!(ours.len(), right.len(), "{data}");
        assert!(ours.iter().flatten().zip(right.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-9), "{data}");
    }
}

#[test]
fn points_of_arcs_lie_on_their_circle_or_ellipse_at_any_size() {
    for r in [1e-7, 1.0, 1e6] {
        for p in path(&format!("M{r} 0A{r} {r} 0 0 1 -{r} 0A{r} {r} 0 0 1 {r} 0Z")) {
            assert!((p[0].hypot(p[1]) / r - 1.0).abs() < 2e-9, "{p:?}");
        }
        // Twice as wide as high, its axis turned by 45 degrees in SVG's sense: downwards to the right.
        let [a, b] = [2.0 * r * FRAC_1_SQRT_2; 2];
        for p in path(&format!("M{a} {b}A{} {r} 45 0 1 -{a} -{b}A{} {r} 45 0 1 {a} {b}Z", 2.0 * r, 2.0 * r)) {
            let [u, v] = [(p[0] - p[1]) * FRAC_1_SQRT_2, (p[0] + p[1]) * FRAC_1_SQRT_2];
            assert!(((u / (2.0 * r)).hypot(v / r) - 1.0).abs() < 2e-9, "{p:?}");
        }
    }
}

#[test]
fn y_points_upwards_and_transforms_of_all_groups_apply() {
    let corner = "<path d=\"M0 0H4V1Z\"/>";
    assert!(points(corner).iter().any(|p| *p == [4.0, -1.0]));
    let plain = points(corner);
    let (s, c) = 0.5_f64.sin_cos();
    let degrees = 0.5_f64.to_degrees();
    for (transforms, by) in [
        (["translate(2 3)", ""], (|[x, y]| [x + 2.0, y + 3.0]) as fn([f64; 2]) -> [f64; 2]),
        (["scale(2)", "translate(1,-1)"], |[x, y]| [2.0 * (x + 1.0), 2.0 * (y - 1.0)]),
        (["translate(1,-1)", "scale(2 3)"], |[x, y]| [2.0 * x + 1.0, 3.0 * y - 1.0]),
        (["matrix(1 2 3 4 5 6)", "matrix(0 1 1 0 0 0)"], |[x, y]| [y + 3.0 * x + 5.0, 2.0 * y + 4.0 * x + 6.0]),
    ] {
        let [outer, inner] = transforms;
        let moved =
            points(&format!("<g transform=\"{outer}\"><g><path transform=\"{inner}\" d=\"M0 0H4V1Z\"/></g></g>"));
        for corner in [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0]] {
            let [x, y] = by(corner);
            assert!(
                moved.iter().any(|p| (p[0] - x).abs() < 1e-14 && (p[1] + y).abs() < 1e-14),
                "{transforms:?} {moved:?}"
            );
        }
    }
    let turned = points(&format!("<path transform=\"rotate({degrees} 0 0)\" d=\"M0 0H4V1Z\"/>"));
    for (p, q) in plain.iter().zip(&turned) {
        // SVG turns from x to y, which points downwards there.
        let [x, y] = [c * p[0] + s * p[1], -s * p[0] + c * p[1]];
        assert!((q[0] - x).abs() < 1e-14 && (q[1] - y).abs() < 1e-14);
    }
}

#[test]
fn corners_are_single_points_with_points_on_both_sides_and_steps_turn_little() {
    for (data, corners) in [
        ("M0 0H4V1H0Z", 4),
        ("M0 0H4V.001H0Z", 4),
        ("M0 0L4 0L2 2Z", 3),
        ("M0 0Q2 1 4 0Q2-1 0 0Z", 2),
        ("M0 0C2 1.5 3 1 3 0C3-1 2-1.5 0 0Z", 1),
        // A cusp within a piece, and control points at the ends.
        ("M0 0C2 2 0 2 2 0L1-2Z", 4),
        ("M0 0C0 0 3 2 3 2C3 2 0 4 0 4Z", 3),
        ("M.1 0H3.9A.1 .1 0 0 1 4 .1V.9A.1 .1 0 0 1 3.9 1H.1A.1 .1 0 0 1 0 .9V.1A.1 .1 0 0 1 .1 0Z", 0),
        (
            "M.0001 0H3.9999A.0001 .0001 0 0 1 4 .0001V.9A.1 .1 0 0 1 3.9 1H.1A.1 .1 0 0 1 0 .9V.0001A.0001 .0001 0 0 1 .0001 0Z",
            0,
        ),
        ("M1 0C1 .005 0 .01 -1 0C0 -.01 1 -.005 1 0Z", 1),
    ] {
        let outline = outline(&picture(&format!("<path d=\"{data}\"/>"))).unwrap().0;
        let points = &outline.points;
        let walk = walk(points);
        let n = walk.len();
        let sharp: Vec<usize> = (0..n).filter(|k| walk[*k].1 > 0.255).collect();
        assert_eq!(sharp.len(), corners, "{data}: {points:?}");
        // Cusps are none to the core.
        let corner = |k: &usize| walk[*k].1.to_degrees() < 175.0;
        assert_eq!(outline.corners, Some(sharp.iter().copied().filter(corner).collect()), "{data}");
        for k in 0..n {
            let [before, step] = [walk[(k + n - 1) % n].0, walk[k].0];
            let corner = sharp.contains(&k);
            assert!(corner || walk[k].1 < 1.5 * TAU / 90.0, "{data}: {k} of {n}, {:?} {}", points[k], walk[k].1);
            assert!(step > 0.0 && (0.5..2.0).contains(&(step / before)), "{data}: {k} of {n}, {before} {step}");
            // Eight at least from corner to corner.
            assert!(!corner || (1..8).all(|j| !sharp.contains(&((k + j) % n))), "{data}: {k}");
        }
        assert!(n < 1000, "{data}: {n}");
    }
}

#[test]
fn a_line_of_many_straight_pieces_is_taken_as_its_vertices_and_few_have_corners() {
    let ring = |n: usize| -> String {
        let vertex = |k: usize| (TAU * k as f64 / n as f64).sin_cos();
        (0..n).map(vertex).map(|(y, x)| format!("{}{x} {y}", if x == 1.0 { "M" } else { "L" })).collect::<String>()
            + "Z"
    };
    for n in [25, 100, 1000] {
        assert_eq!(path(&ring(n)).len(), n);
    }
    for n in [3, 12, 24] {
        let points = path(&ring(n));
        assert_eq!(walk(&points).iter().filter(|w| w.1 > 0.2).count(), n);
        assert!(points.len() >= 8 * n);
    }
    // Steps of nothing do not add up: this is a square of many tiny ones.
    let sides = [("h", 1), ("v", 1), ("h", -1), ("v", -1)];
    let tiny: String = sides.iter().map(|(c, d)| format!("{c}{}e-7 ", 5 * d).repeat(20_000)).collect();
    let part = parts(&format!("M0 0{tiny}Z")).unwrap().remove(0);
    let error = along(&part.pieces, true).unwrap_err().0;
    assert!(error.contains("pieces; at most 20000 are taken"), "{error}");
    let part = parts(&format!("M0 0{}L1e-2 0 1e-2 1e-2 0 1e-2Z", "h5e-9 ".repeat(20_000))).unwrap().remove(0);
    let line = along(&part.pieces, true).unwrap();
    assert!(line.corners.len() == 4 && (6_000..8_000).contains(&line.straight), "{:?} {}", line.corners, line.straight);
}

#[test]
fn what_is_no_single_closed_path_is_refused_with_file_line_and_a_way_out() {
    let p = "<path d=\"M0 0H1V1Z\"/>";
    for (inside, told) in [
        ("", "o.svg: has no path (an outline is a <path> that is drawn)"),
        ("<defs><path id=\"a\" d=\"M0 0H1V1Z\"/></defs>", "o.svg: has no path"),
        ("<circle r=\"1\"/>", "o.svg: has no path, but a <circle> (in Inkscape: Path > Object to Path)"),
        ("<g><path/></g>", "o.svg:3: the path has no d, so it draws nothing"),
        ("<path d=\" \"/>", "o.svg:3: the path has no d"),
        ("<path d=\"M1 1\"/>", "o.svg:3: the path draws nothing: it has no pieces"),
        ("<path d=\"M1 1L1 1Z\"/>", "o.svg:3: the path draws nothing"),
        (
            "\n<path id=\"a\"\n d=\"M0 0H1V1\"/>",
            "o.svg:4: path `a` is open: it begins at [0, 0] and ends at [1, -1] (y upwards) (close it",
        ),
        (
            "<path d=\"M0 0H1V1ZM5 5h1v1z\"/>",
            "o.svg:3: the path has 2 parts (subpaths), but an outline is one closed line (in Inkscape: Path > Break Apart",
        ),
        ("<path d=\"M0 0H1V1Z L3 3 4 4\"/>", "o.svg:3: the path has 2 parts"),
        ("<path d=\"M0 0L1 1Z\"/>", "o.svg:3: the path encloses no area"),
        ("<path d=\"M0 0L1 nan 1 1Z\"/>", "o.svg:3: the path has a d that is not understood: "),
        ("<path d=\"M0 0L1 1e999 1 1Z\"/>", "o.svg:3: the path has a d "),
        ("<path d=\"M0 0L1 1 1e308 1 -1e308 0Z\"/>", "o.svg:3: the path "),
        ("<path d=\"L0 0 1 1Z\"/>", "o.svg:3: the path has a d that is not understood: unexpected data at position 1"),
        ("<path d=\"M0 0H1V1 oops Z\"/>", "o.svg:3: the path has a d that is not understood: "),
        (
            "<path d=\"M0 0H1V1Z\" transform=\"turn(3)\"/>",
            "o.svg:3: the path has a transform that is not understood, `turn(3)` in the path: ",
        ),
        ("<g transform=\"scale(0)\"><path d=\"M0 0H1V1Z\"/></g>", "o.svg:3: the path is pressed flat by a transform"),
        (
            "<path style=\"fill:red; transform: scale(2)\" d=\"M0 0H1V1Z\"/>",
            "o.svg:3: the path has `transform` in the style of the path, which is not read",
        ),
        ("<path style=\"d: path('M0 0')\" d=\"M0 0H1V1Z\"/>", "o.svg:3: the path has `d` in the style"),
        (
            "<g transform-origin=\"1 1\" id=\"g\"><path d=\"M0 0H1V1Z\"/></g>",
            "o.svg:3: the path has a `transform-origin` in <g> `g`",
        ),
        (
            "<style>path { transform: scale(2) }</style><path d=\"M0 0H1V1Z\"/>",
            "o.svg:3: the path is in a picture whose style sheet",
        ),
        (
            "<svg><path d=\"M0 0H1V1Z\"/></svg>",
            "o.svg: draws 2 things, but an outline is one: a <svg>, a path without id (name one with path = \"id\"",
        ),
        (
            &format!("{p}<path id=\"b\" d=\"\"/>"),
            "o.svg: draws 2 things, but an outline is one: a path without id, path `b` (name",
        ),
        (&format!("{p}<rect/>"), "o.svg: draws 2 things, but an outline is one: a path without id, a <rect>"),
        (&p.repeat(9), "o.svg: draws 9 things"),
        ("<path d=\"M0 0H1V1Z\">", "o.svg: is not valid XML: "),
    ] {
        let done = reads(&picture(inside));
        assert!(done.as_ref().is_err_and(|e| e.starts_with(told) && e.lines().count() == 1), "{inside}\n{done:?}");
    }
    for (text, told) in [
        ("<html><body/></html>", "o.svg: is XML, but no SVG picture: it begins with <html>"),
        ("<svg xmlns=\"http://example.org/\"/>", "o.svg: is XML, but no SVG picture"),
        (
            "<!DOCTYPE svg [<!ENTITY a \"b\">]><svg/>",
            "o.svg: declares entities, which are not read (save it as plain SVG)",
        ),
        ("", "o.svg: is not valid XML: "),
        ("<", "o.svg: is not valid XML: "),
        ("<svg", "o.svg: is not valid XML: "),
    ] {
        let done = reads(text);
        assert!(done.as_ref().is_err_and(|e| e.starts_with(told)), "{text}\n{done:?}");
    }
    // Deep within each other is no harm, and neither is a document type.
    let deep = format!("{}<path d=\"M0 0H1V1Z\"/>{}", "<g>".repeat(100_000), "</g>".repeat(100_000));
    assert!(reads(&picture(&deep)).is_ok());
    let doctype =
        "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">";
    assert!(reads(&format!("<!-- by hand -->\n{doctype}<svg>{p}</svg>")).is_ok());
}

#[test]
fn rubbish_never_panics() {
    let good =
        picture("<g transform=\"rotate(3)\"><path id=\"a\" d=\"M0 0C1-1 3-1 4 0A3 2 5 0 1 0 0.5Q1 1 0 0z\"/></g>");
    let mut seed = 3_u64;
    for _ in 0..3000 {
        let mut bytes = good.clone().into_bytes();
        for _ in 0..1 + seed % 3 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = (seed >> 33) as usize % bytes.len();
            bytes[at] = b"MmLlHhVvCcSsQqTtAaZz0123456789.-e+ <>\"'/&;"[(seed >> 20) as usize % 42];
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Ok((points, _)) = reads(&text) {
            assert!(points.iter().flatten().all(|x| x.is_finite()), "{text}");
            assert!(walk(&points).iter().all(|w| w.0 > 0.0), "{text}");
        }
    }
}
