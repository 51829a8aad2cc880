//! Scatter that was put on outlines is found again, and none on those without.

use std::f64::consts::TAU;

use super::naca::{Naca, Tail};
use super::noise::noise;

type Points = Vec<[f64; 2]>;

/// Xorshift, and from it normal numbers by Box and Muller.
pub struct Random(pub u64);

impl Random {
    pub fn part(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.part()).ln()).sqrt() * (TAU * self.part()).cos()
    }

    pub fn scattered(&mut self, points: &[[f64; 2]], sigma: f64) -> Points {
        points.iter().map(|p| p.map(|x| x + sigma * self.normal())).collect()
    }
}

/// Points of an ellipse with a longer axis of 1, at these parts of the turn.
pub fn ellipse(ratio: f64, parts: impl IntoIterator<Item = f64>) -> Points {
    parts.into_iter().map(|t| (TAU * t).sin_cos()).map(|(s, c)| [0.5 * c, 0.5 * ratio * s]).collect()
}

pub fn even(n: usize) -> impl Iterator<Item = f64> {
    (0..n).map(move |k| k as f64 / n as f64)
}

fn star(lobes: usize, amplitude: f64, n: usize) -> Points {
    let radius = |t: f64| 0.5 * (1.0 + amplitude * (lobes as f64 * TAU * t).cos());
    even(n).map(|t| [radius(t) * (TAU * t).cos(), radius(t) * (TAU * t).sin()]).collect()
}

fn section(name: &str, count: usize) -> Points {
    Naca::new(name, Tail::Sharp).unwrap().outline(1.0, count).unwrap()
}

/// A regular polygon, each side of so many parts.
fn polygon(corners: usize, side: usize) -> Points {
    let corner = |k: usize| (TAU * (k % corners) as f64 / corners as f64).sin_cos();
    let point = |k: usize| {
        let ((s, c), (t, d)) = (corner(k / side), corner(k / side + 1));
        let part = (k % side) as f64 / side as f64;
        [0.5 * (c + part * (d - c)), 0.5 * (s + part * (t - s))]
    };
    (0..corners * side).map(point).collect()
}

fn sigma(points: &[[f64; 2]], corners: &[usize]) -> f64 {
    noise(points, corners).map_or(0.0, |noise| noise.sigma)
}

#[test]
fn outlines_that_do_not_scatter_are_said_to_scatter_by_nothing() {
    let mut random = Random(1);
    for n in [60, 100, 160, 400] {
        assert!(sigma(&ellipse(1.0, even(n)), &[]) < 1e-15, "{n}");
    }
    for n in [100, 160, 400] {
        assert!(sigma(&ellipse(0.4, even(n)), &[]) < 3e-9, "{n}");
        // Read at uneven lengths.
        let parts = (0..n).map(|k| (k as f64 + 0.9 * random.part()) / n as f64).collect::<Vec<_>>();
        assert!(sigma(&ellipse(1.0, parts.clone()), &[]) < 4e-7, "{n}");
        assert!(sigma(&ellipse(0.5, parts), &[]) < 4e-7, "{n}");
        assert!(sigma(&ellipse(0.6, even(n).map(|t| t + 0.08 * (TAU * t).sin())), &[]) < 1e-9, "{n}");
    }
    for name in ["0012", "2412", "23012"] {
        assert!(sigma(&section(name, 161), &[0]) < 1e-9, "{name}");
    }
    for (corners, side) in [(3, 20), (4, 12), (5, 8), (12, 5)] {
        let points = polygon(corners, side);
        assert!(sigma(&points, &[]) < 1e-15, "{corners} {side}");
        assert!(sigma(&points, &(0..corners).map(|k| side * k).collect::<Vec<_>>()) < 1e-15, "{corners} {side}");
    }
}

#[test]
fn corners_that_are_known_are_not_taken_for_scatter() {
    let points = Random(12).scattered(&ellipse(1.0, even(96)), 1e-3);
    assert!(sigma(&points, &[]) > 5e-4);
    assert_eq!(noise(&points, &(0..96).collect::<Vec<_>>()), None);
}

#[test]
fn scatter_is_found_within_a_factor_of_1_5() {
    let mut random = Random(2);
    for n in [60, 100, 200, 400] {
        for (points, corners) in [
            (ellipse(1.0, even(n)), &[][..]),
            (ellipse(0.4, even(n)), &[]),
            (section("0012", n + 1), &[0]),
            (section("2424", n + 1), &[0]),
        ] {
            for given in [1e-4, 1e-3, 3e-3, 1e-2] {
                let all: Vec<f64> =
                    (0..16).map(|_| sigma(&random.scattered(&points, given), corners) / given).collect();
                let mean = (all.iter().map(|s| s.ln()).sum::<f64>() / 16.0).exp();
                assert!((0.8..1.5).contains(&mean), "{n} {given} {mean}");
                // One estimate from few points spreads by more.
                assert!(all.iter().all(|s| (0.25..2.6).contains(s)), "{n} {given} {all:?}");
            }
        }
    }
    // Denser than they scatter: their order along the line is lost.
    for _ in 0..40 {
        let found = sigma(&random.scattered(&section("0012", 1601), 1e-2), &[0]) / 1e-2;
        assert!((0.7..1.4).contains(&found), "{found}");
    }
}

#[test]
fn digits_that_were_cut_off_scatter_by_about_0_29_of_the_last_one() {
    for digit in [1e-3, 1e-4] {
        let round =
            |points: Points| -> Points { points.iter().map(|p| p.map(|x| (x / digit).round() * digit)).collect() };
        let of = |points: Points, corners: &[usize]| (sigma(&round(points), corners) / digit).ln();
        let all: Vec<f64> = [160, 250, 400]
            .iter()
            .flat_map(|n| {
                [of(ellipse(1.0, even(*n)), &[]), of(ellipse(0.4, even(*n)), &[]), of(section("2412", n + 1), &[0])]
            })
            .collect();
        let mean = (all.iter().sum::<f64>() / all.len() as f64).exp();
        assert!((0.2..0.45).contains(&mean), "{digit} {mean}");
    }
}

#[test]
fn scatter_that_matters_is_seen_and_bends_are_not_taken_for_it() {
    let mut random = Random(3);
    let matters = |points: &[[f64; 2]], corners: &[usize]| noise(points, corners).is_some_and(|n| n.matters);
    for (n, given) in [(100, 1e-3), (400, 3e-4), (400, 3e-3), (200, 1e-2), (1600, 1e-3)] {
        for ratio in [1.0, 0.4] {
            let seen = (0..20).filter(|_| matters(&random.scattered(&ellipse(ratio, even(n)), given), &[])).count();
            assert!(seen >= 18, "{n} {given} {ratio} {seen}");
        }
    }
    for n in [12, 20, 24, 32, 48, 64, 100, 160, 400] {
        for ratio in [1.0, 0.7, 0.4, 0.2, 0.1, 0.03] {
            assert!(!matters(&ellipse(ratio, even(n)), &[]), "{n} {ratio}");
            for uneven in [0.3, 0.9] {
                let parts: Vec<f64> = (0..n).map(|k| (k as f64 + uneven * random.part()) / n as f64).collect();
                assert!(!matters(&ellipse(ratio, parts), &[]), "{n} {ratio} {uneven}");
            }
            let mut parts: Vec<f64> = (0..n).map(|_| random.part()).collect();
            parts.sort_by(f64::total_cmp);
            assert!(!matters(&ellipse(ratio, parts), &[]), "{n} {ratio}");
        }
    }
    for lobes in 2..9 {
        for (per, amplitude) in [(8, 0.1), (8, 0.4), (12, 0.6), (16, 0.2), (16, 0.6), (24, 0.6)] {
            assert!(!matters(&star(lobes, amplitude, lobes * per), &[]), "{lobes} {per} {amplitude}");
        }
    }
    for count in [21, 41, 81, 161, 401] {
        for name in ["0006", "0012", "0030", "2412", "23012"] {
            let points = section(name, count);
            assert!(!matters(&points, &[0]) && !matters(&points, &[]), "{name} {count}");
        }
    }
    for (corners, side) in [(3, 20), (4, 12), (5, 8), (12, 5), (4, 2), (12, 2), (24, 3)] {
        assert!(!matters(&polygon(corners, side), &[]), "{corners} {side}");
    }
    (12..60).for_each(|n| assert!(!matters(&polygon(n, 1), &[]), "{n}"));
}

#[test]
fn where_and_how_large_the_outline_is_is_of_no_importance() {
    let points = Random(4).scattered(&ellipse(0.5, even(128)), 2e-3);
    let usual = noise(&points, &[]).unwrap();
    for (size, at) in [(1e-150, 0.0), (1e150, 0.0), (1e3, 1e6), (1e-3, -5.0)] {
        let moved: Points = points.iter().map(|p| p.map(|x| size * x + at)).collect();
        let found = noise(&moved, &[]).unwrap();
        assert!((found.sigma / size / usual.sigma - 1.0).abs() < 1e-6, "{size} {at} {found:?}");
        assert_eq!(found.matters, usual.matters);
    }
}
