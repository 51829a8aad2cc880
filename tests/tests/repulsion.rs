//! The indicator of the repulsion's quadrature against the error, and its absence where there is no repulsion.

use nekton::scene::{Quadrature, Repulsion, Scene, Shape};
use nekton_tests::*;

/// Gauss–Legendre nodes and weights on (−1, 1), by Newton's method on the Legendre polynomial.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..50 {
                let (mut p, mut before) = (x, 1.0);
                for k in 2..=n {
                    (p, before) = (((2 * k - 1) as f64 * x * p - (k - 1) as f64 * before) / k as f64, p);
                }
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Offsets of a full turn and their weights, on panels halved towards 0 down to `finest`.
fn panels(finest: f64, rule: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (mut out, mut top) = (Vec::new(), std::f64::consts::PI);
    loop {
        let bottom = if top < finest { 0.0 } else { 0.5 * top };
        // Tips elsewhere on the outline ask for panels that are not too long.
        let parts = ((top - bottom) / 0.2).ceil();
        for k in 0..parts as usize {
            let (half, middle) = (0.5 * (top - bottom) / parts, bottom + (top - bottom) / parts * (k as f64 + 0.5));
            out.extend(rule.iter().flat_map(|(x, w)| [(middle + half * x, half * w), (-middle - half * x, half * w)]));
        }
        if bottom == 0.0 {
            return out;
        }
        top = bottom;
    }
}

/// An ellipse: half-axes and pose.
type Oval = ([f64; 2], [f64; 3]);

/// Point and |dγ/dt|.
fn point(([a, b], [x, y, turn]): Oval, t: f64) -> ([f64; 2], f64) {
    let ((s, c), (sin, cos)) = (t.sin_cos(), turn.sin_cos());
    let (u, v) = (a * c, b * s);
    ([x + cos * u - sin * v, y + sin * u + cos * v], f64::hypot(a * s, b * c))
}

/// Where a function of an angle is least, and its value there: a search on ever finer grids.
fn least(f: impl Fn(f64) -> f64) -> (f64, f64) {
    let mut step = std::f64::consts::TAU / 64.0;
    let all = (0..64).map(|k| k as f64 * step).map(|t| (t, f(t)));
    let mut best = all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    while step > 1e-10 {
        step *= 0.5;
        for t in [best.0 - step, best.0 + step] {
            let value = f(t);
            if value < best.1 {
                best = (t, value);
            }
        }
    }
    best
}

fn closest(oval: Oval, z: [f64; 2]) -> (f64, f64) {
    least(|t| {
        let (p, _) = point(oval, t);
        f64::hypot(p[0] - z[0], p[1] - z[1])
    })
}

/// ∂V/∂(x, y, θ) of the second ellipse, and the gap: Gauss panels halved towards the closest points, on both.
fn exact(one: Oval, two: Oval, alpha: f64) -> [f64; 3] {
    let rule = gauss(16);
    let (t, gap) = least(|t| closest(one, point(two, t).0).1);
    let mut sum = [0.0; 3];
    for (v, wv) in panels(gap.sqrt().min(1.0) * 0.1, &rule) {
        let (z, speed) = point(two, t + v);
        let (u, near) = closest(one, z);
        let (mut fx, mut fy) = (0.0, 0.0);
        for (w, ww) in panels(near.min(1.0) * 0.5, &rule) {
            let (x, ds) = point(one, u + w);
            let (dx, dy) = (z[0] - x[0], z[1] - x[1]);
            let square = dx * dx + dy * dy;
            let power = -alpha * square.powf(-0.5 * alpha - 1.0) * ds * ww * speed * wv;
            fx += power * dx;
            fy += power * dy;
        }
        let arm = [z[0] - two.1[0], z[1] - two.1[1]];
        sum[0] += fx;
        sum[1] += fy;
        sum[2] += arm[0] * fy - arm[1] * fx;
    }
    sum
}

/// ∂V/∂q of the second ellipse, the indicator, and the gap.
fn look(pair: [Oval; 2], nodes: usize, quadrature: Quadrature, alpha: f64) -> (Vec<f64>, f64, f64) {
    let links = pair.map(|(axes, _)| [link(Shape::Ellipse { a: axes[0], b: axes[1] }, 1.0, nodes)]);
    let bodies = [body(&links[0], pair[0].1, [0.0; 3]), body(&links[1], pair[1].1, [0.1, 0.2, 0.3])];
    let repulsion = Some(Repulsion { alpha, epsilon: 1.0 });
    let mut sim =
        at_start(&Scene { repulsion, quadrature, bodies: &bodies, allow_unresolved: true, ..Scene::new(0.0, 0.0) });
    let mut sim = sim.view();
    let force = vector(&mut sim, |s, out| s.repulsion(out));
    let (here, full) = (sim.indicators().unwrap(), sim.resolution().unwrap());
    assert_eq!((here.repulsion, here.bound()), (full.repulsion, full.bound()));
    assert!(here.bound() >= 100.0 * here.repulsion);
    (force[3..].to_vec(), here.repulsion, sim.gap().distance)
}

/// The pair with the second ellipse moved along the line of centres until the gap is as wanted.
fn moved([one, two]: [Oval; 2], gap: f64) -> [Oval; 2] {
    let d = f64::hypot(two.1[0], two.1[1]);
    let mut shift = d + gap + 0.1;
    let at = |shift: f64| [one, (two.0, [shift * two.1[0] / d, shift * two.1[1] / d, two.1[2]])];
    for _ in 0..60 {
        shift += gap - look(at(shift), 16, Quadrature::Plain, 2.0).2;
    }
    at(shift)
}

#[test]
fn error_of_repulsion_is_within_a_hundred_times_its_indicator() {
    let pairs: [[Oval; 2]; 4] = [
        [([1.0, 1.0], [0.0; 3]), ([1.0, 1.0], [2.0, 0.0, 0.7])],
        [([1.0, 0.5], [0.0, 0.0, 0.3]), ([0.7, 0.4], [1.0, 1.2, -0.4])],
        [([1.0, 0.5], [0.0; 3]), ([1.0, 0.5], [0.0, 1.0, 0.0])],
        [([1.0, 0.2], [0.0; 3]), ([1.0, 0.2], [1.2, 0.0, 1.57])],
    ];
    let mut ratios = Vec::new();
    for pair in pairs {
        for gap in [1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let pair = moved(pair, gap);
            for alpha in [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0] {
                let truth = exact(pair[0], pair[1], alpha);
                let size = truth.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
                for quadrature in [Quadrature::Graded, Quadrature::Plain] {
                    for nodes in [12, 16, 24, 28, 32, 48, 56, 64, 96, 128] {
                        let (force, indicator, _) = look(pair, nodes, quadrature, alpha);
                        let error = force.iter().zip(&truth).map(|(f, t)| (f - t).abs()).fold(0.0, f64::max) / size;
                        // Above 1 an error needs no finer measure; that of the panels themselves is below 1e-13.
                        assert!(
                            error.min(1.0) <= 100.0 * indicator + 1e-13,
                            "{pair:?}, gap {gap:e}, exponent {alpha}, {nodes} nodes, {quadrature:?}: {error:.1e}, {indicator:.1e}"
                        );
                        if error > 1e-12 && error < 1.0 {
                            ratios.push(error / indicator);
                        }
                        // Resolved is told as resolved.
                        assert!(
                            nodes < 96 || quadrature == Quadrature::Plain || indicator < 3e-6,
                            "{gap} {alpha} {indicator:e}"
                        );
                    }
                }
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    let part = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
    println!(
        "{} errors by indicator: 5 % {:.1e}, median {:.1e}, 99 % {:.1e}, largest {:.1e}",
        ratios.len(),
        part(0.05),
        part(0.5),
        part(0.99),
        part(1.0)
    );
}

#[test]
fn without_repulsion_its_indicator_is_exactly_zero() {
    let links = [link(disc(1.0), 1.0, 16)];
    let bodies = [body(&links, [0.0; 3], [0.1, 0.0, 0.2]), body(&links, [2.1, 0.0, 0.0], [0.0; 3])];
    for repulsion in [None, Some(Repulsion { alpha: 4.0, epsilon: 0.0 })] {
        let mut sim = simulation(&Scene { repulsion, bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-6));
        let mut sim = sim.view();
        for _ in 0..3 {
            assert_eq!((sim.indicators().unwrap().repulsion, sim.resolution().unwrap().repulsion), (0.0, 0.0));
            sim.step().unwrap();
        }
    }
}

#[test]
fn rounding_of_the_coordinates_is_within_a_hundred_times_the_indicator() {
    // In single precision a resolved pair at a tiny gap is as wrong as its coordinates are rounded: the same numbers, given to
    // double precision, have the exact force.
    let mut largest = 0.0_f64;
    for (k, gap) in [1e-1_f32, 3e-2, 1e-2, 3e-3, 1e-3].into_iter().enumerate() {
        for turn in [0.1_f32, 0.7, 1.3, 2.2] {
            let distance = 2.0 + gap;
            let (s, c) = (turn + 0.3 * k as f32).sin_cos();
            let pose = [distance * c, distance * s, turn];
            let (nodes, alpha) = (96, 6.0_f32);
            let links = [link(disc(1.0_f32), 1.0, nodes)];
            let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&links, pose, [0.0; 3])];
            let repulsion = Some(Repulsion { alpha, epsilon: 1.0 });
            let mut sim = at_start(&Scene { repulsion, bodies: &bodies, ..Scene::new(0.0_f32, 0.0) });
            let mut sim = sim.view();
            let force = vector(&mut sim, |sim, out| sim.repulsion(out));
            let told = f64::from(sim.indicators().unwrap().repulsion);
            let links = [link(disc(1.0_f64), 1.0, nodes)];
            let wide = pose.map(f64::from);
            let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&links, wide, [0.0; 3])];
            let repulsion = Some(Repulsion { alpha: 6.0, epsilon: 1.0 });
            let mut sim = at_start(&Scene { repulsion, bodies: &bodies, ..Scene::new(0.0, 0.0) });
            let mut sim = sim.view();
            let exact = vector(&mut sim, |sim, out| sim.repulsion(out));
            let narrow: Vec<f64> = force.iter().map(|f| f64::from(*f)).collect();
            let error = difference(&narrow, &exact);
            println!("gap {gap:.0e}: error {error:.1e}, told {told:.1e}, ratio {:.2}", error / told);
            largest = largest.max(error / told);
        }
    }
    assert!(largest <= 100.0, "{largest}");
}

#[test]
fn what_rounding_of_coordinates_may_do_to_a_distant_pair_is_told() {
    // Far apart the integrals are exact but for rounding. Coordinates as large as the distance d and the reach a are known to ε
    // of that, which the force magnifies by α + 2 over a length, here the reach, by which energy is told as a force.
    let (distance, radius, alpha) = (1e4, 1.0_f64, 4.0);
    let links = [link(disc(radius), 1.0, 64)];
    let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&links, [distance, 0.0, 0.0], [0.0; 3])];
    let repulsion = Some(Repulsion { alpha, epsilon: 1.0 });
    let mut sim = at_start(&Scene { repulsion, bodies: &bodies, ..Scene::new(0.0, 0.0) });
    let mut sim = sim.view();
    let force = f64::abs(vector(&mut sim, |sim, out| sim.repulsion(out))[0]);
    let energy = sim.energy().unwrap().repulsion;
    assert!(force < energy / radius);
    let rounding = f64::EPSILON * (alpha + 2.0) * (distance + radius) / radius;
    assert_near(100.0 * sim.indicators().unwrap().repulsion / rounding, 1.0, 0.1);
}

#[test]
fn the_indicator_does_not_depend_on_the_unit_of_length() {
    // A power of two changes no digit; moments count as forces at the reach of their own body.
    let told = |unit: f64| {
        [([1.0, 0.2], [0.3, 0.2]), ([0.2, 0.3], [1.0, 0.2])].map(|axes: ([f64; 2], [f64; 2])| {
            let oval = |[a, b]: [f64; 2], nodes| [link(Shape::Ellipse { a: a * unit, b: b * unit }, 1.0, nodes)];
            let links = [oval(axes.0, 16), oval(axes.1, 16)];
            let bodies =
                [body(&links[0], [0.0; 3], [0.0; 3]), body(&links[1], [0.7 * unit, 1.1 * unit, 0.9], [0.0; 3])];
            let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 1.0 });
            let quadrature = Quadrature::Plain;
            let mut sim = at_start(&Scene { repulsion, quadrature, bodies: &bodies, ..Scene::new(0.0, 0.0) });
            sim.view().indicators().unwrap().repulsion
        })
    };
    let exact = told(1.0);
    assert!(exact.iter().all(|told| *told > 1e-9), "{exact:?}");
    for unit in [1.0 / 1024.0, 1024.0] {
        assert_close(&told(unit), &exact, 1e-9);
    }
}
