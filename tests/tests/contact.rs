//! Contact at any ratio of sizes, against distances by other means: ellipses by bisection for the foot, polygons by their
//! sides, stars in polar coordinates; the least of them along the smaller outline by sampling and golden section.

use nekton::scene::{Body, Scene, Shape};
use nekton::{Method, Status};
use nekton_tests::*;
use std::f64::consts::{PI, TAU};

/// An outline about its centroid, as this file knows it.
#[derive(Clone, Debug)]
enum Kind {
    Ellipse(f64, f64),
    Star(f64, f64, usize),
    Polygon(Vec<[f64; 2]>),
}

fn length(z: [f64; 2]) -> f64 {
    z[0].hypot(z[1])
}

fn turned(z: [f64; 2], angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * z[0] - s * z[1], s * z[0] + c * z[1]]
}

/// The least value of a function between two places, by golden section, and where.
fn golden(f: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let ratio = (5f64.sqrt() - 1.0) / 2.0;
    let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    let mut least = fc.min(fd);
    for _ in 0..46 {
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - ratio * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + ratio * (b - a);
            fd = f(d);
        }
        least = least.min(fc).min(fd);
    }
    least
}

/// The least value of a periodic function of [0, 1): samples, then golden section about the lowest of them.
fn least(f: &impl Fn(f64) -> f64, samples: usize) -> f64 {
    let values: Vec<f64> = (0..samples).map(|k| f(k as f64 / samples as f64)).collect();
    let mut minima: Vec<(f64, usize)> = (0..samples)
        .filter(|&k| values[k] <= values[(k + 1) % samples] && values[k] <= values[(k + samples - 1) % samples])
        .map(|k| (values[k], k))
        .collect();
    minima.sort_by(|a, b| a.0.total_cmp(&b.0));
    let place = |k: usize| k as f64 / samples as f64;
    let about = |k: usize| golden(f, place(k) - 1.0 / samples as f64, place(k) + 1.0 / samples as f64);
    minima.iter().take(3).map(|&(value, k)| value.min(about(k))).fold(f64::MAX, f64::min)
}

impl Kind {
    /// A polygon moved so that its centroid is the origin.
    fn polygon(points: &[[f64; 2]]) -> Kind {
        let (mut area, mut first) = (0.0, [0.0; 2]);
        for (i, p) in points.iter().enumerate() {
            let q = points[(i + 1) % points.len()];
            let w = p[0] * q[1] - p[1] * q[0];
            area += w / 2.0;
            first = [first[0] + w * (p[0] + q[0]) / 6.0, first[1] + w * (p[1] + q[1]) / 6.0];
        }
        Kind::Polygon(points.iter().map(|p| [p[0] - first[0] / area, p[1] - first[1] / area]).collect())
    }

    fn scaled(&self, s: f64) -> Kind {
        match self {
            Kind::Ellipse(a, b) => Kind::Ellipse(a * s, b * s),
            Kind::Star(r, a, n) => Kind::Star(r * s, *a, *n),
            Kind::Polygon(p) => Kind::Polygon(p.iter().map(|[x, y]| [x * s, y * s]).collect()),
        }
    }

    fn shape(&self) -> Shape<'_, f64> {
        match self {
            Kind::Ellipse(a, b) => Shape::Ellipse { a: *a, b: *b },
            Kind::Star(radius, amplitude, lobes) => {
                Shape::Star { radius: *radius, amplitude: *amplitude, lobes: *lobes }
            }
            Kind::Polygon(vertices) => Shape::Polygon { vertices, radius: None },
        }
    }

    fn size(&self) -> f64 {
        match self {
            Kind::Ellipse(a, b) => a.max(*b),
            Kind::Star(r, a, _) => r * (1.0 + a),
            Kind::Polygon(p) => p.iter().fold(0.0, |most, z| most.max(length(*z))),
        }
    }

    /// How far the outline may be from what this file takes it for: corners are rounded at 1e-4 of the shortest side.
    fn slack(&self) -> f64 {
        let Kind::Polygon(p) = self else { return 0.0 };
        let side = |i: usize| {
            let (a, b) = (p[i], p[(i + 1) % p.len()]);
            length([a[0] - b[0], a[1] - b[1]])
        };
        3e-4 * (0..p.len()).map(side).fold(f64::MAX, f64::min)
    }

    /// A point of the outline, t in turns.
    fn point(&self, t: f64) -> [f64; 2] {
        let t = t - t.floor();
        let (s, c) = (TAU * t).sin_cos();
        match self {
            Kind::Ellipse(a, b) => [a * c, b * s],
            Kind::Star(r, a, n) => {
                let r = r * (1.0 + a * (*n as f64 * TAU * t).cos());
                [r * c, r * s]
            }
            Kind::Polygon(p) => {
                let u = t * p.len() as f64;
                let i = (u as usize).min(p.len() - 1);
                let (a, b, x) = (p[i], p[(i + 1) % p.len()], u - i as f64);
                [a[0] + x * (b[0] - a[0]), a[1] + x * (b[1] - a[1])]
            }
        }
    }

    /// Signed distance of a point: negative inside.
    fn distance(&self, z: [f64; 2]) -> f64 {
        match self {
            Kind::Ellipse(a, b) => {
                // The foot (x, y) has x = a² u/(t + a²), y = b² v/(t + b²): t by bisection, with a the longer axis.
                let (a, b, u, v) =
                    if a >= b { (*a, *b, z[0].abs(), z[1].abs()) } else { (*b, *a, z[1].abs(), z[0].abs()) };
                let side = if (u / a).hypot(v / b) < 1.0 { -1.0 } else { 1.0 };
                let f = |t: f64| (a * u / (t + a * a)).hypot(b * v / (t + b * b)) - 1.0;
                // In s = t + b², which keeps its digits near a tip.
                let (mut low, mut high) = (0.0, b * b + a * u + b * v);
                for _ in 0..1100 {
                    let middle = if low > 0.0 { f64::midpoint(low, high) } else { high / 2.0 };
                    if middle <= low || middle >= high || high < 1e-300 {
                        break;
                    }
                    if f(middle - b * b) > 0.0 { low = middle } else { high = middle }
                }
                let s = high;
                let x = a * a * u / (s + (a - b) * (a + b));
                let y = if v > 0.0 { (b * b * v / s).min(b) } else { b * (1.0 - (x / a).powi(2)).max(0.0).sqrt() };
                side * (u - x).hypot(v - y)
            }
            Kind::Star(r, a, n) => {
                let own = r * (1.0 + a * (*n as f64 * z[1].atan2(z[0])).cos());
                let side = if length(z) < own { -1.0 } else { 1.0 };
                let away = |t: f64| {
                    let x = self.point(t);
                    length([x[0] - z[0], x[1] - z[1]])
                };
                side * least(&away, 12 * n)
            }
            Kind::Polygon(p) => {
                let (mut inside, mut square) = (false, f64::MAX);
                for (i, a) in p.iter().enumerate() {
                    let b = p[(i + 1) % p.len()];
                    let (d, w) = ([b[0] - a[0], b[1] - a[1]], [z[0] - a[0], z[1] - a[1]]);
                    let x = ((w[0] * d[0] + w[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
                    square = square.min((w[0] - x * d[0]).powi(2) + (w[1] - x * d[1]).powi(2));
                    if (a[1] > z[1]) != (b[1] > z[1]) && w[0] < d[0] * w[1] / d[1] {
                        inside = !inside;
                    }
                }
                if inside { -square.sqrt() } else { square.sqrt() }
            }
        }
    }

    /// Samples that see every bend of the outline.
    fn samples(&self) -> usize {
        match self {
            Kind::Ellipse(..) => 96,
            Kind::Star(_, _, n) => 32 * n,
            Kind::Polygon(p) => 12 * p.len(),
        }
    }
}

/// Signed gap of an outline, placed in the other's frame, to the other.
fn gap(small: &Kind, [x, y, angle]: [f64; 3], big: &Kind, tank: bool) -> f64 {
    let place = |t: f64| {
        let z = turned(small.point(t), angle);
        [z[0] + x, z[1] + y]
    };
    let sign = if tank { -1.0 } else { 1.0 };
    let nearest = least(&|t| sign * big.distance(place(t)), small.samples());
    let z = turned([big.point(0.1)[0] - x, big.point(0.1)[1] - y], -angle);
    // The other may be inside.
    if small.distance(z) < 0.0 { nearest.min(-nearest.abs()) } else { nearest }
}

/// Outlines of size about 1: round, thin, starry, with corners, with deep slots.
fn outlines(random: &mut Numbers) -> Kind {
    let comb = |teeth: usize, slot: f64| {
        let width = 2.0 / (2 * teeth - 1) as f64;
        let mut points = vec![[-1.0, -0.7], [1.0, -0.7]];
        for k in (0..teeth).rev() {
            let left = -1.0 + 2.0 * k as f64 * width;
            points.push([left + width, 0.7]);
            points.push([left, 0.7]);
            if k > 0 {
                points.push([left, 0.7 - slot]);
                points.push([left - width, 0.7 - slot]);
            }
        }
        Kind::polygon(&points)
    };
    match random.between(0.0, 8.0) as usize {
        0 => Kind::Ellipse(1.0, 1.0),
        1 => Kind::Ellipse(1.0, random.between(0.2, 1.0)),
        2 => Kind::Ellipse(random.between(0.01, 0.1), 1.0),
        3 => Kind::Star(0.8, random.between(0.05, 0.4), random.between(2.0, 9.0) as usize),
        4 => Kind::polygon(&[[-1.0, -0.02], [1.0, -0.02], [1.0, 0.02], [-1.0, 0.02]]),
        5 => comb(random.between(2.0, 5.0) as usize, random.between(0.3, 1.2)),
        6 => {
            let inner = random.between(0.4, 0.9);
            let tips = |k: usize| if k.is_multiple_of(2) { 1.0 } else { inner };
            let corner = |k: usize| turned([tips(k), 0.0], k as f64 * PI / 5.0);
            Kind::polygon(&(0..10).map(corner).collect::<Vec<_>>())
        }
        _ => Kind::polygon(&[[-0.8, -0.5], [0.9, random.between(-0.6, 0.2)], [random.between(-0.5, 0.5), 0.8]]),
    }
}

/// Placements per pair of outlines, and pairs, of the study: 10 000 placements.
const PLACEMENTS: usize = 50;
const PAIRS: usize = 200;

#[test]
fn ten_thousand_placements_are_told_apart_as_by_brute_force() {
    let mut random = Numbers::new(0x5eed_c047_ac70_0001);
    let (mut clear, mut met, mut open) = (0, 0, 0);
    let mut faults = Vec::new();
    for pair in 0..PAIRS {
        let big = outlines(&mut random);
        let ratio = 10f64.powf(random.between(-6.0, 0.0));
        let small = outlines(&mut random).scaled(ratio);
        let tank = random.chance(0.3);
        let wall_or_body = random.chance(0.3);
        let nodes = |random: &mut Numbers| 2 * random.between(6.0, 80.0) as usize;
        let (few, many) = (nodes(&mut random), nodes(&mut random));
        let turn = random.between(0.0, TAU);
        let (one, other) = ([link(small.shape(), 1.0, few)], [link(big.shape(), 1.0, many)]);
        let far = [40.0, 0.0, 0.0];
        let bodies = [body(&one, far, [0.0; 3]), body(&other, [0.0, 0.0, turn], [0.0; 3])];
        let walls = [wall(big.shape(), [0.0; 2], turn, many)];
        let scene = Scene::new(0.0, 0.0);
        let fixed = tank || wall_or_body;
        // In a tank the start must be inside: a large one is set at first, whose place the outline takes.
        let scene = match (tank, wall_or_body) {
            (true, _) => Scene { tank: Some(walls[0]), bodies: &bodies[..1], ..scene },
            (_, true) => Scene { obstacles: &walls, bodies: &bodies[..1], ..scene },
            _ => Scene { bodies: &bodies, ..scene },
        };
        let deepest = (0..400)
            .map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)])
            .min_by(|a, b| big.distance(*a).total_cmp(&big.distance(*b)))
            .unwrap();
        if tank && big.distance(deepest) > -1.01 * small.size() {
            continue;
        }
        let start = if tank { turned(deepest, turn) } else { [40.0, 0.0] };
        let bodies = [Body { pose: [start[0], start[1], 0.0], ..bodies[0] }, bodies[1]];
        let scene = Scene { bodies: if fixed { &bodies[..1] } else { &bodies }, ..scene };
        let mut sim = simulation(&scene, Method::Rk4 { step: 0.1 });
        let mut sim = sim.view();
        let mut state = sim.state().to_vec();
        for _ in 0..PLACEMENTS {
            // A place beside the outline, at about a gap from 1e-7 to 1 sizes of the small body, or as deep inside.
            let t = random.between(0.0, 1.0);
            let (x, ahead) = (big.point(t), big.point(t + 1e-7));
            let speed = length([ahead[0] - x[0], ahead[1] - x[1]]);
            let n = [(ahead[1] - x[1]) / speed, -(ahead[0] - x[0]) / speed];
            let angle = random.between(0.0, TAU);
            let side = if tank { -1.0 } else { 1.0 };
            let support = (0..64).fold(0.0f64, |most, k| {
                let z = turned(small.point(k as f64 / 64.0), angle);
                most.max(-side * (z[0] * n[0] + z[1] * n[1]))
            });
            let depth = if random.chance(0.3) { -1.0 } else { 1.0 };
            let slack = small.slack() + big.slack() + 2e-8 * small.size() + 2e-12;
            let aim = depth * (2.0 * slack + small.size() * 10f64.powf(random.between(-7.0, 0.0)));
            let off = side * (support + aim);
            let place = [x[0] + off * n[0], x[1] + off * n[1], angle];
            let exact = gap(&small, place, &big, tank);
            let world = turned([place[0], place[1]], turn);
            state[..2].copy_from_slice(&world);
            state[2] = angle + turn;
            let told = sim.set_state(0.0, &state).map_err(|e| e.status);
            if exact.abs() <= slack {
                open += 1;
                continue;
            }
            let what = || {
                format!("pair {pair}: {small:?} ({few}) at {place:?} in {big:?} ({many}), tank {tank}, gap {exact:e}")
            };
            match (told, exact > 0.0) {
                (Ok(()), true) => {
                    clear += 1;
                    let shown = sim.gap().distance;
                    if (shown - exact).abs() > slack + 1e-6 * exact {
                        faults.push(format!("gap told as {shown:e}: {}", what()));
                    }
                }
                (Err(Status::Contact), false) => met += 1,
                (told, _) => faults.push(format!("{told:?}: {}", what())),
            }
        }
    }
    println!("clear {clear}, met {met}, not to be told {open}");
    for fault in faults.iter().take(20) {
        println!("{fault}");
    }
    assert!(faults.is_empty(), "{} of {}", faults.len(), clear + met);
    assert!(clear > 3000 && met > 1500);
}

#[test]
fn discs_that_nearly_fill_their_tank_or_pass_each_other_closely_are_told_from_contact() {
    let one = [link(disc(1.0), 1.0, 16)];
    for (radius, offset, clear) in [
        (1.0 + 1e-3, 0.9e-3, true),
        (1.0 + 1e-3, 1.1e-3, false),
        (1.0 + 1e-6, 0.5e-6, true),
        (1.0 + 1e-6, 1.5e-6, false),
        (2.0, 0.999, true),
        (2.0, 1.001, false),
    ] {
        let bodies = [body(&one, [0.0; 3], [0.0; 3])];
        let tank = Some(wall(disc(radius), [0.0; 2], 0.0, 16));
        let mut sim = at_start(&Scene { tank, bodies: &bodies, ..Scene::new(0.0, 0.0) });
        let mut sim = sim.view();
        let mut state = sim.state().to_vec();
        for turn in [0.0_f64, 2.0, 4.0] {
            (state[0], state[1]) = (offset * turn.cos(), offset * turn.sin());
            let told = sim.set_state(0.0, &state).map_err(|e| e.status);
            assert_eq!(told, if clear { Ok(()) } else { Err(Status::Contact) }, "{radius} {offset}");
            if clear {
                assert_near(sim.gap().distance, radius - 1.0 - offset, 1e-15);
            }
        }
    }
    // One step past a disc that rests, at a given distance of the centres, from far to far; or up to it, or away from it.
    for (distance, from, to, clear) in [
        (2.0 + 1e-6, -30.0, 30.0, true),
        (2.0 - 1e-6, -30.0, 30.0, false),
        (0.0, -30.0, 30.0, false),
        (0.0, -30.0, -2.0 - 1e-6, true),
        (0.0, -30.0, -1.9, false),
        (0.0, 2.1, 30.0, true),
    ] {
        let bodies =
            [body(&one, [from, distance, 0.0], [(to - from) / 0.1, 0.0, 3.0]), body(&one, [0.0; 3], [0.0, 0.0, -1.0])];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, Method::Rk4 { step: 0.1 });
        let told = sim.view().step().map_err(|e| e.status);
        assert_eq!(told, if clear { Ok(()) } else { Err(Status::Contact) }, "{distance} {from} {to}");
    }
}

#[test]
fn a_fast_body_meets_what_is_on_its_way_and_nothing_else() {
    let mut random = Numbers::new(0x5eed_c047_ac70_0002);
    let (mut clear, mut met) = (0, 0);
    for scene_number in 0..1500 {
        let big = outlines(&mut random);
        let radius = 10f64.powf(random.between(-5.0, -1.0));
        // A passage at about a gap, past a point of the outline, while the other turns.
        let (t, turn) = (random.between(0.0, 1.0), random.between(-2.0, 2.0));
        let aim = radius * 10f64.powf(random.between(-2.0, 2.0));
        let (x, ahead) = (big.point(t), big.point(t + 1e-7));
        let speed = length([ahead[0] - x[0], ahead[1] - x[1]]);
        let along = [(ahead[0] - x[0]) / speed, (ahead[1] - x[1]) / speed];
        let middle = [x[0] + along[1] * (radius + aim), x[1] - along[0] * (radius + aim)];
        let way = turned(along, if random.chance(0.5) { 0.0 } else { random.between(-1.5, 1.5) });
        let travel = 10f64.powf(random.between(-2.0, 1.0));
        let turn = if random.chance(0.5) { 0.0 } else { turn };
        let at = |s: f64| {
            let z = [middle[0] + way[0] * travel * (s - 0.5), middle[1] + way[1] * travel * (s - 0.5)];
            turned(z, -turn * s)
        };
        // The distance changes no faster than the point moves: the path in steps of it.
        let bound = travel + turn.abs() * (length(middle) + travel);
        let (mut s, mut nearest) = (0.0, f64::MAX);
        let floor = 1e-7 * radius + big.slack();
        while s <= 1.0 && nearest > -floor {
            let d = big.distance(at(s)) - radius;
            nearest = nearest.min(d);
            s += d.abs().max(floor) / bound;
        }
        let starts = big.distance(at(0.0)) - radius;
        if (nearest > -floor && nearest <= 2.0 * floor) || starts <= floor {
            continue;
        }
        let (one, other) = ([link(disc(radius), 1.0, 16)], [link(big.shape(), 1.0, 64)]);
        let start = at(0.0);
        let h = 0.1;
        let bodies = [
            body(
                &one,
                [start[0], start[1], 0.3],
                [way[0] * travel / h, way[1] * travel / h, random.between(-9.0, 9.0)],
            ),
            body(&other, [0.0; 3], [0.0, 0.0, turn / h]),
        ];
        let mut sim = simulation(&Scene { bodies: &bodies, ..Scene::new(0.0, 0.0) }, Method::Rk4 { step: h });
        let told = sim.view().step().map_err(|e| e.status);
        let what =
            format!("{scene_number}: radius {radius:e} past {big:?}, travel {travel}, turn {turn}, gap {nearest:e}");
        assert_eq!(told, if nearest > 0.0 { Ok(()) } else { Err(Status::Contact) }, "{what}");
        if nearest > 0.0 { clear += 1 } else { met += 1 }
    }
    println!("passed {clear}, met {met}");
    assert!(clear > 400 && met > 300);
}

/// A small ellipse close to the flank of a large one, 1e-4 of its size, both moving.
fn beside(nodes: [usize; 2], check: impl Fn(&Scene<'_, f64>)) {
    let large = [link(Shape::Ellipse { a: 1.0, b: 0.5 }, 1.0, nodes[0])];
    let small = [link(Shape::Ellipse { a: 1e-4, b: 5e-5 }, 1.0, nodes[1])];
    let bodies = [
        body(&large, [0.0; 3], [0.3, 0.2, 0.5]),
        body(&small, [0.26752632654352454, 0.481977193350832, 0.4], [-0.2, 0.4, 0.3]),
    ];
    check(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
}

#[test]
fn a_body_of_a_ten_thousandth_beside_a_large_one_does_not_overlap_it_whatever_the_nodes() {
    let exact =
        gap(&Kind::Ellipse(1e-4, 5e-5), [0.26752632654352454, 0.481977193350832, 0.4], &Kind::Ellipse(1.0, 0.5), false);
    for large in (8..84).step_by(2) {
        for small in [16, 24, 64] {
            beside([large, small], |scene| {
                let scene = Scene { fluid_density: 0.0, ..*scene };
                let mut sim = at_start(&scene);
                let told = sim.view().gap().distance;
                assert!((told / exact - 1.0).abs() < 1e-9, "{large}, {small}: {told:e} {exact:e}");
            });
        }
    }
}

#[test]
fn a_body_of_a_ten_thousandth_moves_away_from_a_large_one_without_contact() {
    beside([64, 64], |scene| {
        let mut sim = simulation(scene, Method::Rk4 { step: 1e-5 });
        let mut sim = sim.view();
        let mut before = 0.0;
        for _ in 0..200 {
            sim.step().unwrap();
            let gap = sim.gap().distance;
            assert!(gap > before && gap < 2e-3, "{} {gap:e}", sim.time());
            before = gap;
        }
    });
}
