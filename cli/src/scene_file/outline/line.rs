//! Closed lines through points: turns, extent, area.

/// The amount in degrees by which a closed line turns at point `k`.
pub fn turn(points: &[[f64; 2]], k: usize) -> f64 {
    let n = points.len();
    let [a, b, c] = [k + n - 1, k, k + 1].map(|i| points[i % n]);
    let [u, v] = [[b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]];
    (u[0] * v[1] - u[1] * v[0]).abs().atan2(u[0] * v[0] + u[1] * v[1]).to_degrees()
}

/// Points without those at the end that repeat the first or the one before, to a millionth of their mean distance, as the core drops them.
pub fn distinct(points: &[[f64; 2]]) -> &[[f64; 2]] {
    let mut rest = points;
    let gap = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let way: f64 = points.windows(2).map(|w| gap(w[0], w[1])).sum();
    while let (&[first, .., before, last], true) = (rest, rest.len() > 3) {
        let nearest = gap(last, first).min(gap(last, before));
        let near = nearest <= 1e-3 * gap(first, before) && nearest <= 1e-6 * way / points.len() as f64;
        if nearest > 0.0 && !near {
            break;
        }
        rest = &rest[..rest.len() - 1];
    }
    rest
}

/// Twice the signed area of the polygon through points.
pub fn twice_area(points: &[[f64; 2]]) -> f64 {
    // About one of them: far from the origin the digits would be lost.
    let [x, y] = points.first().copied().unwrap_or_default();
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(p, q)| (p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)).sum()
}

/// Sizes along x and along y.
pub fn extent(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|c| {
        let all = points.iter().map(|p| p[c]);
        let [a, b] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        b - a
    })
}
