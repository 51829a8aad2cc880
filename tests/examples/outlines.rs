//! How well points tell outlines, estimated and found: `cargo run --release -p nekton-tests --example outlines > docs/accuracy/outlines.csv`.
//! Errors of added mass are relative to its largest entry of translation, or of rotation, and of area to itself.

use nekton::scene::{Corners, Scene, Shape};
use nekton::{ModelBuf, SimBuf};
use nekton_tests::{adams, body, link, matrix};
use std::f64::consts::{PI, TAU};

type Points = Vec<[f64; 2]>;

/// m₁₁, m₂₂, m₁₂, m₃₃ and the area.
fn mass(shape: Shape<'_, f64>) -> Option<[f64; 5]> {
    let links = [link(shape, 1.0, 0)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3])];
    let scene = Scene { bodies: &bodies, allow_unresolved: true, tolerance: Some(1e-5), ..Scene::new(1.0, 0.0) };
    let mut sim = SimBuf::new(ModelBuf::new(&scene).ok()?.into(), adams(1e-6)).ok()?;
    let mut sim = sim.view();
    let area = sim.model().link(0)?.area;
    let m = matrix(&mut sim, |s, out| s.added_mass(out));
    Some([m[0][0], m[1][1], m[0][1], m[2][2], area])
}

/// The same, which must be.
fn exact(shape: Shape<'_, f64>) -> [f64; 5] {
    mass(shape).expect("an outline of many points or in closed form")
}

fn report(name: &str, exact: &[f64; 5], points: &[[f64; 2]], corners: Corners<'_>) {
    let shape = Shape::Curve { points, corners };
    let estimate = shape.outline_error().map_or(f64::NAN, |e| e.unwrap_or(f64::NAN));
    let (mass_error, area_error) = mass(shape).map_or((f64::NAN, f64::NAN), |m| {
        let difference = |k: usize| (m[k] - exact[k]).abs();
        let scale = exact[0].max(exact[1]);
        let moves = (0..3).fold(0.0, |e: f64, k| e.max(difference(k) / scale));
        (moves.max(difference(3) / exact[3].max(0.1 * scale * exact[4])), difference(4) / exact[4])
    });
    println!("{name},{},{estimate:.1e},{mass_error:.1e},{area_error:.1e}", points.len());
}

fn ellipse(b: f64) -> impl Fn(f64) -> [f64; 2] {
    move |t| [t.cos(), b * t.sin()]
}

/// Parameters in even steps.
fn even(n: usize, shift: f64) -> impl Iterator<Item = f64> {
    (0..n).map(move |k| TAU * (k as f64 + shift) / n as f64)
}

/// Parameters in even lengths.
fn by_length(curve: impl Fn(f64) -> [f64; 2], n: usize, shift: f64) -> Vec<f64> {
    let fine: Points = even(20_000, 0.0).chain([TAU]).map(curve).collect();
    let mut ways = vec![0.0];
    for w in fine.windows(2) {
        ways.push(ways[ways.len() - 1] + (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]));
    }
    let whole = ways[20_000];
    let at = |k: usize| ways.partition_point(|s| *s < whole * (k as f64 + shift) / n as f64);
    (0..n).map(|k| TAU * at(k) as f64 / 2e4).collect()
}

/// A polygon by points along its sides, as many on each as listed, over and over.
fn sides(corners: &[[f64; 2]], each: &[usize]) -> Points {
    let n = corners.len();
    let side = |a: usize| {
        let (from, to, m) = (corners[a], corners[(a + 1) % n], each[a % each.len()]);
        (0..m).map(move |i| i as f64 / m as f64).map(move |t| [0, 1].map(|c| from[c] * (1.0 - t) + to[c] * t))
    };
    (0..n).flat_map(side).collect()
}

fn noisy(points: &[[f64; 2]], size: f64) -> Points {
    let mut state = 7_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        size * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    };
    points.iter().map(|[x, y]| [x + noise(), y + noise()]).collect()
}

fn ellipses() {
    for b in [1.0, 0.5, 0.1, 0.02] {
        let known = exact(Shape::Ellipse { a: 1.0, b });
        for n in [6, 7, 8, 9, 10, 12, 13, 16, 24, 32, 48, 100] {
            for shift in [0.0, 0.5] {
                let points: Points = even(n, shift).map(ellipse(b)).collect();
                report(&format!("ellipse 1:{b} even angles shift {shift}"), &known, &points, Corners::Auto);
                let points: Points = by_length(ellipse(b), n, shift).into_iter().map(ellipse(b)).collect();
                report(&format!("ellipse 1:{b} even lengths shift {shift}"), &known, &points, Corners::Auto);
            }
        }
    }
}

fn discs() {
    let known = exact(Shape::Ellipse { a: 1.0, b: 1.0 });
    for n in [4, 8, 16, 30] {
        let lower = (0..100).map(|k| PI * (1.0 + f64::from(k) / 100.0));
        let points: Points = (0..n).map(|k| PI * f64::from(k) / f64::from(n)).chain(lower).map(ellipse(1.0)).collect();
        report(&format!("disc of {n} + 100 steps"), &known, &points, Corners::Auto);
    }
    for size in [1e-2, 1e-3, 1e-4] {
        for n in [24, 100, 300] {
            let points: Points = even(n, 0.0).map(ellipse(1.0)).collect();
            report(&format!("disc noise {size}"), &known, &noisy(&points, size), Corners::Auto);
        }
    }
}

fn waves() {
    let blob = |t: f64| {
        let r = 1.0 + 0.2 * (2.0 * t).cos() + 0.1 * (3.0 * t).sin() + 0.05 * (5.0 * t + 1.0).cos();
        [r * t.cos(), r * t.sin()]
    };
    let known = exact(Shape::curve(&even(200, 0.0).map(blob).collect::<Points>()));
    for n in [8, 12, 16, 24, 32, 48, 64] {
        report("blob", &known, &even(n, 0.3).map(blob).collect::<Points>(), Corners::Auto);
        let uneven: Points = even(n, 0.0).map(|t| blob(t + 0.7 * t.sin())).collect();
        report("blob uneven", &known, &uneven, Corners::Auto);
    }
    let star = |t: f64| {
        let r = 1.0 + 0.3 * (5.0 * t).cos();
        [r * t.cos(), r * t.sin()]
    };
    let known = exact(Shape::Star { radius: 1.0, amplitude: 0.3, lobes: 5 });
    for n in [10, 15, 20, 30, 40, 60, 100] {
        for shift in [0.0, 0.5] {
            report(
                &format!("star shift {shift}"),
                &known,
                &even(n, shift).map(star).collect::<Points>(),
                Corners::Auto,
            );
        }
    }
}

/// With corners as found, none, all and all but the last.
fn cornered(name: &str, known: &[f64; 5], points: &[[f64; 2]], corners: &[usize]) {
    report(&format!("{name} corners auto"), known, points, Corners::Auto);
    report(&format!("{name} corners none"), known, points, Corners::None);
    report(&format!("{name} corners given"), known, points, Corners::At(corners));
    let fewer = &corners[..corners.len() - 1];
    report(&format!("{name} corners but one given"), known, points, Corners::At(fewer));
}

fn plates() {
    for height in [1.0, 0.1, 0.02] {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, height], [0.0, height]];
        let known = exact(Shape::Polygon { vertices: &vertices, radius: Some(1e-5 * height) });
        for each in [
            &[1_usize][..],
            &[2],
            &[3],
            &[4],
            &[5],
            &[8],
            &[20],
            &[20, 1],
            &[20, 2],
            &[20, 4],
            &[40, 10, 5, 3],
            &[100, 7],
        ] {
            let points = sides(&vertices, each);
            let mut corners = vec![0];
            (0..3).for_each(|k| corners.push(corners[k] + each[k % each.len()]));
            let text: Vec<String> = each.iter().map(usize::to_string).collect();
            let name = format!("plate 1:{height} sides of {}", text.join("+"));
            cornered(&name, &known, &points, &corners);
            report(&format!("{name} noise 1e-3"), &known, &noisy(&points, 1e-3 * height), Corners::Auto);
        }
    }
}

fn arcs() {
    let half = |m: usize, n: usize| -> Points {
        let arc = (0..m).map(|k| ellipse(1.0)(PI * k as f64 / m as f64));
        arc.chain((0..n).map(|k| [2.0 * k as f64 / n as f64 - 1.0, 0.0])).collect()
    };
    let known = exact(Shape::Curve { points: &half(200, 200), corners: Corners::At(&[0, 200]) });
    for (m, n) in [(4, 4), (6, 6), (6, 100), (8, 8), (12, 12), (16, 16), (32, 32), (32, 2), (32, 1)] {
        cornered(&format!("half disc {m} + {n}"), &known, &half(m, n), &[0, m]);
    }
    for turn in [20.0_f64, 40.0, 90.0] {
        let (lower, span) = ((turn.to_radians() / 2.0).sin(), PI - turn.to_radians());
        let arc = |n: usize, side: f64| {
            let t = move |k: usize| PI / 2.0 - span / 2.0 + span * k as f64 / n as f64;
            (0..n).map(move |k| [side * t(k).cos(), side * (t(k).sin() - lower)])
        };
        let lens = |n: usize| -> Points { arc(n, 1.0).chain(arc(n, -1.0)).collect() };
        let known = exact(Shape::Curve { points: &lens(200), corners: Corners::At(&[0, 200]) });
        for n in [4, 8, 16, 32, 64] {
            cornered(&format!("lens turning {turn} deg"), &known, &lens(n), &[0, n]);
        }
    }
}

fn sections() {
    for (thickness, tail) in [(0.12, 0.1015), (0.12, 0.1036), (0.06, 0.1015), (0.24, 0.1036)] {
        let y = |x: f64| 5.0 * thickness * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - tail * x))));
        let section = |n: usize, cosine: bool| -> (Points, Vec<usize>) {
            let part = |k: usize| k as f64 / n as f64;
            let x = |k: usize| if cosine { 0.5 + 0.5 * (PI * part(k)).cos() } else { 1.0 - part(k) };
            let upper = (0..=n).map(|k| [x(k), y(x(k))]);
            let mut points: Points = upper.chain((1..n).rev().map(|k| [x(k), -y(x(k))])).collect();
            let mut corners = vec![0];
            if y(1.0) > 1e-6 {
                points.push([1.0, -y(1.0)]);
                corners.push(points.len() - 1);
            }
            (points, corners)
        };
        let (points, corners) = section(300, true);
        let known = exact(Shape::Curve { points: &points, corners: Corners::At(&corners) });
        for cosine in [true, false] {
            for n in [8, 10, 16, 20, 40, 80] {
                let (points, corners) = section(n, cosine);
                let spacing = if cosine { "cosine" } else { "even" };
                let tail = if corners.len() > 1 { "blunt" } else { "sharp" };
                let name = format!("section {thickness} {tail} tail {spacing} spacing");
                report(&format!("{name} corners auto"), &known, &points, Corners::Auto);
                report(&format!("{name} corners none"), &known, &points, Corners::None);
            }
        }
    }
}

/// Straight sides without points beside dense arcs, as drawings export them, and arcs of which points were lost.
fn gaps() {
    let arc = |x: f64, y: f64, r: f64, [from, to]: [f64; 2], n: usize| {
        (0..n)
            .map(move |k| from + (to - from) * k as f64 / (n - 1) as f64)
            .map(move |t| [x + r * t.cos(), y + r * t.sin()])
    };
    let half = PI / 2.0;
    for n in [9, 33, 100, 300] {
        for c in [0.5, 1.0, 1.25] {
            let cap =
                |side: f64| arc(side * c, 0.0, 0.5, if side > 0.0 { [-half, half] } else { [half, 3.0 * half] }, n);
            let points: Points = cap(1.0).chain(cap(-1.0)).collect();
            let sides = |m: usize| {
                let side = move |s: f64| (1..m).map(move |k| [s * c * (1.0 - 2.0 * k as f64 / m as f64), s * 0.5]);
                arc(c, 0.0, 0.5, [-half, half], 200)
                    .chain(side(1.0))
                    .chain(arc(-c, 0.0, 0.5, [half, 3.0 * half], 200))
                    .chain(side(-1.0))
                    .collect::<Points>()
            };
            report(
                &format!("stadium centres {c} empty sides"),
                &exact(Shape::curve(&sides(128))),
                &points,
                Corners::Auto,
            );
        }
        let shaft = |a: f64, n: usize| arc(0.0, 0.0, 1.0, [a, TAU - a], n).collect::<Points>();
        for a in [0.7, 0.3] {
            let known = exact(Shape::Curve { points: &shaft(a, 400), corners: Corners::At(&[0, 399]) });
            report(&format!("shaft with a flat of {a} rad"), &known, &shaft(a, n), Corners::Auto);
        }
    }
    let known = exact(Shape::Ellipse { a: 1.0, b: 0.5 });
    for (n, lost) in [(100, 10), (100, 20), (400, 40)] {
        let points: Points = even(n, 0.0).skip(lost).map(ellipse(0.5)).collect();
        report(&format!("ellipse 1:0.5 without {lost} of {n}"), &known, &points, Corners::Auto);
    }
}

fn main() {
    println!("outline,points,estimate,mass_error,area_error");
    ellipses();
    discs();
    waves();
    plates();
    arcs();
    sections();
    gaps();
}
