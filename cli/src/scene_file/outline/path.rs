//! From the pieces of a path to points so dense that the smooth curve through them follows it: steps that turn by a few degrees
//! at most, that grow slowly, and that begin anew at every corner. All points are on the path.

use std::f64::consts::PI;

use kurbo::{Arc, CubicBez, Line as Straight, ParamCurve, PathSeg, Point, QuadBez, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};

use super::points::MOST;

/// Pieces, at most.
const PIECES: usize = 20_000;
/// Steps turn by this angle at most: the curve through the points of a circle then has its area to 5e-9.
const TURN: f64 = PI / 45.0;
/// Longest step: this part of the length of the path.
const LONGEST: f64 = 1.0 / 128.0;
/// Steps between two corners, at least.
const BETWEEN: f64 = 8.0;
/// Steps as long as the one beside a corner between it and the next one, at least.
const BESIDE: f64 = 40.0;
/// A step is longer than one at distance s by this times s at most.
const GROWTH: f64 = 0.25;
/// A turn by more than this, 14.6°, is a corner; by less, between straight pieces, one that stands for a smooth line. No regular polygon
/// turns by just this.
const CORNER: f64 = 0.255;
/// A turn by more than this is a place for a point.
const KINK: f64 = PI / 180.0;
/// A straight piece between others is a step as it is if it is not longer than this times either of them.
const EVEN: f64 = 3.0;
/// What is shorter than this part of the path's extent is nothing.
const NOTHING: f64 = 1e-6;

/// What is wrong, and what helps.
type Wrong = (String, String);

/// A part that is drawn in one go.
pub struct Part {
    pub pieces: Vec<PathSeg>,
    /// Whether it is said to return to its start.
    pub closed: bool,
}

/// Points along a closed path.
#[derive(Debug)]
pub struct Line {
    pub points: Vec<[f64; 2]>,
    pub curved: usize,
    pub straight: usize,
    /// Which of them are corners.
    pub corners: Vec<usize>,
}

/// The parts of path data that draw something, with arcs as Bézier curves that are off by 1e-9 of their radius.
pub fn parts(data: &str) -> Result<Vec<Part>, String> {
    let mut parts: Vec<Part> = Vec::new();
    let (mut start, mut now) = (Point::ZERO, Point::ZERO);
    // Control points that a smooth continuation mirrors.
    let (mut cubic, mut quadratic) = (None, None);
    let mut fresh = true;
    for segment in PathParser::from(data) {
        let segment = segment.map_err(|e| format!("has a d that is not understood: {e}"))?;
        let base = if segment.is_abs() { Vec2::ZERO } else { now.to_vec2() };
        let p = |x: f64, y: f64| Point::new(x, y) + base;
        let mirrored = |control: Option<Point>| control.map_or(now, |c: Point| now + (now - c));
        let mut pieces = Vec::new();
        let (mut cubic_next, mut quadratic_next) = (None, None);
        match segment {
            PathSegment::MoveTo { x, y, .. } => {
                now = p(x, y);
                start = now;
                fresh = true;
            }
            PathSegment::LineTo { x, y, .. } => pieces.push(Straight::new(now, p(x, y)).into()),
            PathSegment::HorizontalLineTo { x, .. } => pieces.push(Straight::new(now, (x + base.x, now.y)).into()),
            PathSegment::VerticalLineTo { y, .. } => pieces.push(Straight::new(now, (now.x, y + base.y)).into()),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                pieces.push(PathSeg::Cubic(CubicBez::new(now, p(x1, y1), p(x2, y2), p(x, y))));
                cubic_next = Some(p(x2, y2));
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                pieces.push(PathSeg::Cubic(CubicBez::new(now, mirrored(cubic), p(x2, y2), p(x, y))));
                cubic_next = Some(p(x2, y2));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                pieces.push(PathSeg::Quad(QuadBez::new(now, p(x1, y1), p(x, y))));
                quadratic_next = Some(p(x1, y1));
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                let control = mirrored(quadratic);
                pieces.push(PathSeg::Quad(QuadBez::new(now, control, p(x, y))));
                quadratic_next = Some(control);
            }
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                arc(now, p(x, y), Vec2::new(rx, ry), x_axis_rotation.to_radians(), [large_arc, sweep], &mut pieces);
            }
            PathSegment::ClosePath { .. } => {
                if let Some(part) = parts.last_mut().filter(|_| !fresh) {
                    part.closed = true;
                }
                now = start;
                fresh = true;
            }
        }
        (cubic, quadratic) = (cubic_next, quadratic_next);
        if let Some(last) = pieces.last() {
            now = last.end();
            if fresh {
                parts.push(Part { pieces: Vec::new(), closed: false });
                fresh = false;
            }
            if let Some(part) = parts.last_mut() {
                part.pieces.extend(pieces);
            }
        }
        if !now.is_finite() {
            return Err("has a d with a number that is not finite".into());
        }
    }
    let draws = |p: &Part| p.pieces.iter().any(|piece| controls(piece).iter().any(|c| *c != piece.start()));
    parts.retain(draws);
    Ok(parts)
}

/// An elliptic arc as cubic pieces.
fn arc(from: Point, to: Point, radii: Vec2, x_rotation: f64, [large_arc, sweep]: [bool; 2], pieces: &mut Vec<PathSeg>) {
    // As large as 1: kurbo takes small radii for none.
    let size = radii.x.abs().max(radii.y.abs()).max((to - from).hypot());
    let scaled = |v: Vec2| v / size;
    let svg = SvgArc {
        from: Point::ZERO,
        to: scaled(to - from).to_point(),
        radii: scaled(radii),
        x_rotation,
        large_arc,
        sweep,
    };
    let (mut now, before) = (from, pieces.len());
    if let Some(arc) = Arc::from_svg_arc(&svg).filter(|_| size > 0.0) {
        let there = |p: Point| from + p.to_vec2() * size;
        arc.to_cubic_beziers(1e-9 * arc.radii.x.max(arc.radii.y), |a, b, c| {
            pieces.push(PathSeg::Cubic(CubicBez::new(now, there(a), there(b), there(c))));
            now = there(c);
        });
    }
    // What comes next begins where the file says.
    match pieces.get_mut(before..).and_then(<[_]>::last_mut) {
        Some(PathSeg::Cubic(last)) => last.p3 = to,
        _ => pieces.push(Straight::new(from, to).into()),
    }
}

fn controls(piece: &PathSeg) -> Vec<Point> {
    match piece {
        PathSeg::Line(l) => vec![l.p0, l.p1],
        PathSeg::Quad(q) => vec![q.p0, q.p1, q.p2],
        PathSeg::Cubic(c) => vec![c.p0, c.p1, c.p2, c.p3],
    }
}

fn is_straight(piece: &PathSeg) -> bool {
    matches!(piece, PathSeg::Line(_))
}

/// Where a point may be: a fine division of the path.
struct Sample {
    piece: usize,
    t: f64,
    at: Point,
    /// Distance from the start.
    s: f64,
    /// The length that a step may have here.
    step: f64,
    /// Whether a point must be here.
    fixed: bool,
    corner: bool,
}

/// Points along a path that returns to its start; else what is wrong, and what helps.
pub fn along(pieces: &[PathSeg], closed: bool) -> Result<Line, Wrong> {
    let all = || pieces.iter().flat_map(controls);
    if !all().all(Point::is_finite) {
        return Err(("has a point that is not finite".into(), "check its d and the transforms".into()));
    }
    let range = |c: fn(Point) -> f64| {
        let [a, b] = all().map(c).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        b - a
    };
    let size = range(|p| p.x).hypot(range(|p| p.y));
    let pieces = joined(pieces, closed, NOTHING * size)?;
    if pieces.len() > PIECES {
        let message = format!("has {} pieces; at most {PIECES} are taken", pieces.len());
        return Err((message, "in Inkscape: Path > Simplify".into()));
    }
    let curved = pieces.iter().filter(|p| !is_straight(p)).count();
    let (mut samples, length) = divided(&pieces, 0.1 * NOTHING * size);
    let bare = steps(&mut samples, &pieces, length, NOTHING * size);
    let (points, corners) = points(&samples, &pieces, &bare, length)?;
    Ok(Line { points, curved, straight: pieces.len() - curved, corners })
}

/// The pieces without those that are nothing, and with the one that closes the path.
fn joined(pieces: &[PathSeg], closed: bool, nothing: f64) -> Result<Vec<PathSeg>, Wrong> {
    let Some(start) = pieces.first().map(PathSeg::start) else { return Ok(Vec::new()) };
    let mut kept: Vec<PathSeg> = Vec::new();
    let mut now = start;
    for piece in pieces {
        let around: f64 = controls(piece).windows(2).map(|w| (w[1] - w[0]).hypot()).sum();
        if is_straight(piece) || around <= nothing {
            // From the end of what was kept: many small steps are not lost.
            let line = Straight::new(now, piece.end());
            if (line.p1 - line.p0).hypot() > nothing {
                kept.push(line.into());
                now = line.p1;
            }
        } else {
            kept.push(*piece);
            now = piece.end();
        }
    }
    let gap = (start - now).hypot();
    if gap > nothing {
        if !closed {
            let message = format!(
                "is open: it begins at [{}, {}] and ends at [{}, {}] (y upwards)",
                start.x, start.y, now.x, now.y
            );
            return Err((message, "close it, by a Z at the end of its d".into()));
        }
        kept.push(Straight::new(now, start).into());
    }
    Ok(kept)
}

/// The angle by which a line turns from one direction to another.
fn turn(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b)).abs()
}

/// Samples so fine that the path hardly turns between them, and its length.
fn divided(pieces: &[PathSeg], nothing: f64) -> (Vec<Sample>, f64) {
    let least = if pieces.len() <= 256 { 6 } else { 3 };
    let mut samples = Vec::new();
    let mut s = 0.0;
    for (k, piece) in pieces.iter().enumerate() {
        let mut open = vec![(0.0, 1.0, 0)];
        let mut before = piece.start();
        while let Some((a, b, depth)) = open.pop() {
            let m = 0.5 * (a + b);
            let [p, q, r] = [a, m, b].map(|t| piece.eval(t));
            let turned = !is_straight(piece)
                && turn(q - p, r - q) > 0.25 * TURN
                && (q - p).hypot().max((r - q).hypot()) > nothing
                && depth < 40;
            if depth < least || turned {
                open.extend([(m, b, depth + 1), (a, m, depth + 1)]);
                continue;
            }
            s += (p - before).hypot();
            before = p;
            samples.push(Sample { piece: k, t: a, at: p, s, step: f64::INFINITY, fixed: false, corner: false });
        }
        s += (piece.end() - before).hypot();
    }
    (samples, s)
}

/// Says where points must be and how long steps may be, and which pieces are steps as they are.
fn steps(samples: &mut [Sample], pieces: &[PathSeg], length: f64, least: f64) -> Vec<bool> {
    let n = samples.len();
    let chord = |samples: &[Sample], k: usize| samples[(k + 1) % n].at - samples[k % n].at;
    let straight = |k: usize| is_straight(&pieces[k % pieces.len()]);
    let lengths: Vec<f64> = pieces.iter().map(|p| (p.end() - p.start()).hypot()).collect();
    // Turn at the start of each piece.
    let mut turns = vec![0.0; pieces.len()];
    for k in 0..n {
        let [a, b] = [chord(samples, k + n - 1), chord(samples, k)];
        let angle = turn(a, b);
        let piece = samples[k].piece;
        let joint = samples[k].t == 0.0;
        if joint {
            turns[piece] = angle;
            samples[k].fixed = angle > KINK || (straight(piece) && straight(piece + pieces.len() - 1));
        }
        samples[k].corner = angle > CORNER;
        samples[k].fixed |= samples[k].corner;
        if !samples[k].fixed {
            samples[k].step = 0.5 * (a.hypot() + b.hypot()) * TURN / angle;
        }
    }
    let m = pieces.len();
    let bare: Vec<bool> = (0..m)
        .map(|k| {
            let [before, after] = [(k + m - 1) % m, (k + 1) % m];
            let smooth = turns[k] <= CORNER && turns[after] <= CORNER;
            let even = lengths[k] <= EVEN * lengths[before].min(lengths[after]);
            m > 2 && [before, k, after].iter().all(|j| straight(*j)) && smooth && even
        })
        .collect();
    let corners: Vec<usize> = (0..n).filter(|k| samples[*k].corner).collect();
    // From each corner to the next one.
    let section = |k: usize| {
        let after = corners[(k + 1) % corners.len()];
        let span = samples[after].s - samples[corners[k]].s;
        if span > 0.0 { span } else { span + length }
    };
    let sections: Vec<f64> = (0..corners.len()).map(section).collect();
    let mut now = sections.last().copied().unwrap_or(f64::INFINITY);
    let mut next = 0;
    for (k, sample) in samples.iter_mut().enumerate() {
        let mut most = LONGEST * length;
        if corners.get(next) == Some(&k) {
            most = most.min(now.min(sections[next]) / BESIDE);
            now = sections[next];
            next += 1;
        }
        let own = if bare[sample.piece] { lengths[sample.piece] } else { most.min(now / BETWEEN) };
        sample.step = sample.step.min(own).max(least);
    }
    // Twice around, both ways.
    let gap = |samples: &[Sample], k: usize| chord(samples, k).hypot();
    for k in 0..2 * n {
        let most = samples[k % n].step + GROWTH * gap(samples, k);
        let sample = &mut samples[(k + 1) % n];
        sample.step = sample.step.min(most);
    }
    for k in (0..2 * n).rev() {
        let most = samples[(k + 1) % n].step + GROWTH * gap(samples, k);
        let sample = &mut samples[k % n];
        sample.step = sample.step.min(most);
    }
    bare
}

/// The number of steps over a length in which their own length goes from one value to another, and the part of it that the first
/// steps take.
fn count(a: f64, b: f64, length: f64) -> f64 {
    if (b - a).abs() < 1e-6 * a { length / a } else { length * (b / a).ln() / (b - a) }
}

fn part(a: f64, b: f64, length: f64, steps: f64) -> f64 {
    let slope = (b - a) / length;
    let share = if (b - a).abs() < 1e-6 * a { steps * a / length } else { a * (slope * steps).exp_m1() / (b - a) };
    share.clamp(0.0, 1.0)
}

/// Places the points: all fixed ones, and equal numbers of steps between them. Says which are corners.
fn points(
    samples: &[Sample],
    pieces: &[PathSeg],
    bare: &[bool],
    length: f64,
) -> Result<(Vec<[f64; 2]>, Vec<usize>), Wrong> {
    let n = samples.len();
    let first = samples.iter().position(|s| s.fixed).unwrap_or(0);
    let end = |k: usize| if k + 1 == n { length } else { samples[k + 1].s };
    let steps = |k: usize| {
        let [a, b] = [&samples[k], &samples[(k + 1) % n]];
        count(a.step, b.step, end(k) - a.s)
    };
    let (mut points, mut corners) = (Vec::new(), Vec::new());
    let mut from = first;
    while from < first + n {
        let to = (from + 1..first + n).find(|k| samples[k % n].fixed).unwrap_or(first + n);
        let sum: f64 = (from..to).map(|k| steps(k % n)).sum();
        let number = if bare[samples[from % n].piece] { 1.0 } else { (sum - 0.25).ceil().max(1.0) };
        if points.len() as f64 + number > MOST as f64 {
            let message = format!("has so fine details that more than {MOST} points were needed");
            return Err((message, "in Inkscape: Path > Simplify".into()));
        }
        if samples[from % n].corner {
            corners.push(points.len());
        }
        let (mut k, mut passed) = (from, 0.0);
        for j in 0..number as usize {
            let wanted = sum * j as f64 / number;
            while k + 1 < to && passed + steps(k % n) <= wanted {
                passed += steps(k % n);
                k += 1;
            }
            let [a, b] = [&samples[k % n], &samples[(k + 1) % n]];
            let share = part(a.step, b.step, end(k % n) - a.s, wanted - passed);
            let until = if b.piece == a.piece && b.t > a.t { b.t } else { 1.0 };
            let p = if share == 0.0 { a.at } else { pieces[a.piece].eval(a.t + share * (until - a.t)) };
            points.push([p.x, p.y]);
        }
        from = to;
    }
    Ok((points, corners))
}
