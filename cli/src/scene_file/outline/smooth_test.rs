//! Fits lie within their distance, are as smooth as that allows, and leave alone what they should.

use super::line::twice_area;
use super::noise_test::{Random, ellipse, even};
use super::points::Outline;
use super::smooth::{moved, smooth, stands_out};

/// How far points are from an ellipse with a longer axis of 1, at most and on average: to first order.
fn offs(points: &[[f64; 2]], ratio: f64) -> [f64; 2] {
    let one = |[x, y]: [f64; 2]| {
        let (u, v) = (x / 0.5, y / (0.5 * ratio));
        (u * u + v * v - 1.0).abs() / (2.0 * (u / 0.5).hypot(v / (0.5 * ratio)))
    };
    let [most, sum] = points.iter().fold([0.0, 0.0], |[most, sum], p| [f64::max(most, one(*p)), sum + one(*p)]);
    [most, sum / points.len() as f64]
}

fn off(points: &[[f64; 2]], ratio: f64) -> f64 {
    offs(points, ratio)[0]
}

#[test]
fn a_fit_lies_within_its_distance_and_nearer_to_the_outline_than_the_points() {
    let mut random = Random(5);
    for n in [60, 128, 400] {
        for (ratio, sigma) in [(1.0, 1e-3), (1.0, 1e-2), (0.4, 1e-3), (0.4, 5e-3)] {
            let points = random.scattered(&ellipse(ratio, even(n)), sigma);
            for within in [0.1, 1.0, 3.0, 10.0] {
                let fit = smooth(&points, &[], within * sigma);
                let [most, rms] = moved(&points, &fit);
                assert!(most <= within * sigma && rms <= most, "{n} {ratio} {within} {most} {rms}");
                // As smooth as that allows: at the distance, unless an ellipse lies within it.
                assert!(most > 0.9 * within * sigma || off(&fit, ratio) < 3.0 * sigma || within == 10.0);
            }
            let [fit, points] = [&smooth(&points, &[], 2.5 * sigma), &points].map(|p| offs(p, ratio)[1] / sigma);
            assert!(fit < if n == 60 { 0.95 } else { 0.85 } * points, "{n} {ratio} {sigma} {fit} {points}");
        }
    }
}

#[test]
fn a_circle_does_not_shrink_however_far_it_may() {
    let points = Random(6).scattered(&ellipse(1.0, even(400)), 1e-3);
    let area = twice_area(&ellipse(1.0, even(400)));
    for within in [3.5e-3, 1e-2, 1e-1, 0.9] {
        let fit = smooth(&points, &[], within);
        assert!(off(&fit, 1.0) < 1.2e-3, "{within} {}", off(&fit, 1.0));
        assert!((twice_area(&fit) / area - 1.0).abs() < 1e-3, "{within}");
    }
    // One that does not scatter stays, to rounding.
    let clean = ellipse(1.0, even(100));
    assert!(moved(&clean, &smooth(&clean, &[], 0.1))[0] < 1e-9);
}

#[test]
fn corners_stay_where_they_are_and_sides_between_them_become_straight() {
    let mut random = Random(7);
    let side = |k: usize| -> Vec<[f64; 2]> {
        let (a, b) = (
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][k],
            [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][k],
        );
        (0..30).map(|i| f64::from(i) / 30.0).map(|t| [a[0] + t * b[0], a[1] + t * b[1]]).collect()
    };
    let square: Vec<[f64; 2]> = (0..4).flat_map(side).collect();
    let mut points = random.scattered(&square, 2e-3);
    let corners = [0, 30, 60, 90];
    corners.iter().for_each(|k| points[*k] = square[*k]);
    let fit = smooth(&points, &corners, 7e-3);
    for (k, (p, q)) in square.iter().zip(&fit).enumerate() {
        let across = [p[1] - q[1], p[0] - q[0]][(k / 30) % 2].abs();
        assert!(across < 2.5e-3, "{k} {across}");
        assert!(!corners.contains(&k) || p == q, "{k}");
    }
    assert!(moved(&points, &fit)[0] <= 7e-3);
    // Beside a corner the flank goes to where it stays, not to where it would lie without.
    let fit = smooth(&points, &corners, 0.05);
    for k in [1, 29, 31, 59, 61, 89, 91, 119] {
        let across = [square[k][1] - fit[k][1], square[k][0] - fit[k][0]][(k / 30) % 2].abs();
        assert!(across < 3e-4, "{k} {across}");
    }
    // Without them named the corners are rounded.
    assert!(smooth(&points, &[], 7e-3)[30] != points[30]);
    assert!(stands_out(&points, 30, 2e-3) && !stands_out(&points, 31, 2e-3) && !stands_out(&points, 30, 2e-2));
}

#[test]
fn it_is_the_same_wherever_the_list_begins_and_whichever_way_it_goes() {
    let points = Random(11).scattered(&ellipse(0.4, even(50)), 2e-3);
    let usual = smooth(&points, &[], 5e-3);
    for start in [1, 2, 3, 17, 49] {
        let turn = |p: &[[f64; 2]]| [&p[start..], &p[..start]].concat();
        assert!(moved(&turn(&usual), &smooth(&turn(&points), &[], 5e-3))[0] < 1e-9, "{start}");
    }
    let back = |p: &[[f64; 2]]| p.iter().rev().copied().collect::<Vec<_>>();
    assert!(moved(&back(&usual), &smooth(&back(&points), &[], 5e-3))[0] < 1e-9);
}

#[test]
fn any_points_and_corners_give_finite_fits_within_the_distance() {
    let mut random = Random(8);
    for round in 0..400 {
        let n = 8 + (random.part() * 40.0) as usize;
        let size = 10.0_f64.powf(40.0 * random.part() - 20.0);
        let mut points: Vec<[f64; 2]> = (0..n).map(|_| [size * random.part(), size * random.part()]).collect();
        if round % 3 == 0 {
            let k = (random.part() * (n - 1) as f64) as usize;
            points[k + 1] = points[k].map(|x| x * (1.0 + 1e-15));
        }
        let corners: Vec<usize> = (0..n).filter(|_| random.part() < 0.2 * f64::from(round % 5)).collect();
        let within = size * 10.0_f64.powf(-6.0 * random.part());
        let fit = smooth(&points, &corners, within);
        let [most, rms] = moved(&points, &fit);
        assert!(most <= within * (1.0 + 1e-12) && rms.is_finite(), "{round} {n} {most} {within}");
        corners.iter().for_each(|k| assert_eq!(points[*k], fit[*k]));
        assert!(most > 0.5 * within || !corners.is_empty(), "{round} {n} {most} {within}");
        let _ = super::noise::noise(&points, &corners);
    }
}

#[test]
fn many_points_take_no_time() {
    let points = Random(9).scattered(&ellipse(0.4, even(5000)), 1e-3);
    let start = std::time::Instant::now();
    let fit = smooth(&points, &[], 4e-3);
    // A fifth of a second, measured; by elimination of all it would be hours.
    assert!(start.elapsed().as_secs_f64() < 10.0);
    assert!(off(&fit, 0.4) < 4e-3);
}

#[test]
fn what_cannot_be_smoothed_is_refused_and_a_repeated_end_stays_one() {
    let points = Random(10).scattered(&ellipse(0.5, even(64)), 1e-3);
    let refused = |points: Vec<[f64; 2]>, within: f64| Outline::of(points).smoothed(&[], within).unwrap_err();
    let (why, hint) = refused(points.clone(), 2.0);
    assert!(why.starts_with("must be less than the outline's size, 0.99") && why.ends_with(" m, but is 2e0"), "{why}");
    assert_eq!(hint, "a few times the scatter of its points is enough, such as 1e-3");
    assert_eq!(refused(points[..7].to_vec(), 1e-3).0, "needs at least 8 points, but there are 7");
    let mut twice = points.clone();
    twice.insert(20, points[19]);
    assert_eq!(refused(twice, 1e-3).0, "cannot part points that are one: point 20 repeats the one before it");
    assert!(refused([[f64::MAX, 0.0], [-f64::MAX, 0.0]].repeat(5), 1e-3).0.contains("size"));
    let mut closed = points.clone();
    closed.push(points[0]);
    let fit = Outline::of(closed).smoothed(&[64], 3e-3).unwrap();
    assert_eq!((fit.points.len(), fit.points[64], fit.points[0]), (65, points[0], points[0]));
    let told = fit.told.unwrap();
    assert!(told.starts_with("smoothed within 3e-3 m: its points were moved by 3.0e-3 m at most, "), "{told}");
}
