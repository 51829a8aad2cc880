//! The boundary system in density form: A u = −2χ with A = I − Im G, and the weights that pairs of boundaries add.
//!
//! For target z and source node Γ_k of boundary j (both in j's frame) G_ik = (sign_j/π) h Γ'_k/(Γ_k − z_i).
//! n points out of the fluid. On the tank A also carries 1/N_T in every entry, which fixes the mean of u over the
//! tank's nodes to 0. Blocks of a boundary with itself and of walls with walls come ready from the model; only
//! blocks between different boundaries of which one moves are computed: one division per pair of nodes.

use crate::boundary::{BoundaryRecord, Nodes, self_weights};
use crate::model::{Model, ModelHead};
use crate::scalar::{Complex, Real, complex};
use crate::se2::Pose;
use crate::workspace::{copy, part, part_mut, put};

/// Placements of all boundaries, kept as four reals each.
#[derive(Clone, Copy)]
pub(crate) struct Poses<'a, R>(pub &'a [R]);

impl<R: Real> Poses<'_, R> {
    #[inline]
    pub(crate) fn get(&self, boundary: usize) -> Pose<R> {
        match part(self.0, 4 * boundary, 4) {
            &[x, y, c, s] => Pose { origin: complex(x, y), turn: complex(c, s) },
            _ => Pose::default(),
        }
    }
}

/// Writes a placement.
pub(crate) fn put_pose<R: Real>(poses: &mut [R], boundary: usize, pose: &Pose<R>) {
    let values = [pose.origin.re, pose.origin.im, pose.turn.re, pose.turn.im];
    copy(part_mut(poses, 4 * boundary, 4), &values);
}

/// Nodes of one boundary in another's frame: z = conj(turn_j)(r_i − r_j + turn_i X). Differences of origins are
/// taken first, so a scene far from the world's origin loses no digits.
#[inline]
pub(crate) fn targets<'a, R: Real>(
    nodes: &'a Nodes<'a, R>,
    pose: Pose<R>,
    source: Pose<R>,
) -> impl Iterator<Item = Complex<R>> + 'a {
    let turn = source.unturned(pose.turn);
    let shift = source.unturned(pose.origin - source.origin);
    nodes.points().map(move |x| shift + turn * x)
}

/// Writes the nodes of one boundary in another's frame.
pub(crate) fn fill_targets<R: Real>(nodes: &Nodes<'_, R>, pose: Pose<R>, source: Pose<R>, zx: &mut [R], zy: &mut [R]) {
    for ((x, y), z) in zx.iter_mut().zip(zy).zip(targets(nodes, pose, source)) {
        (*x, *y) = (z.re, z.im);
    }
}

/// Fills the constant block of the walls (and of Re G) in the store.
pub(crate) fn fill_walls<R: Real>(
    walls: &[BoundaryRecord<R>],
    head: &ModelHead<R>,
    circulation: bool,
    store: &mut [R],
) {
    let n = head.wall_nodes;
    let Some((data, blocks)) = store.split_at_mut_checked(head.walls_at) else { return };
    let Some((block, rest)) = blocks.split_at_mut_checked(n * n) else { return };
    let regular: &mut [R] = if circulation { part_mut(rest, 0, n * n) } else { &mut [] };
    for source in walls {
        let factor = source.sign / R::PI;
        let sources = source.nodes(data);
        for target in walls {
            if target.first == source.first {
                let completion =
                    if source.sign > R::zero() { R::one() / R::count(source.nodes.max(1)) } else { R::zero() };
                // The outline was checked when its nodes were made: the weights exist.
                let _ = self_weights(source, data, |i, k, im, re| {
                    let at = (source.first + k) * n + source.first + i;
                    put(block, at, if i == k { R::one() } else { R::zero() } - factor * im + completion);
                    put(regular, at, factor * re);
                });
                continue;
            }
            for (k, (g, dg)) in sources.points().zip(sources.tangents()).enumerate() {
                for (i, z) in targets(&target.nodes(data), target.pose, source.pose).enumerate() {
                    let w = dg / (g - z) * (sources.step * factor);
                    let at = (source.first + k) * n + target.first + i;
                    put(block, at, -w.im);
                    put(regular, at, w.re);
                }
            }
        }
    }
}

/// Assembles A (leading dimension `ld`) and, if `regular` is not empty, Re G (leading dimension N).
/// `zx`, `zy` are scratch of length N. O(N²).
pub(crate) fn assemble<R: Real>(
    model: &Model<'_, R>,
    poses: Poses<'_, R>,
    matrix: &mut [R],
    ld: usize,
    regular: &mut [R],
    zx: &mut [R],
    zy: &mut [R],
) {
    let (n, walls) = (zx.len(), model.head.wall_nodes);
    let with_regular = !regular.is_empty();
    for (j, source, nodes) in model.each_boundary() {
        for (i, target, points) in
            model.each_boundary().filter(|(i, t, _)| *i != j && (t.link.is_some() || source.link.is_some()))
        {
            let (zx, zy) = (part_mut(zx, target.first, target.nodes), part_mut(zy, target.first, target.nodes));
            fill_targets(&points, poses.get(i), poses.get(j), zx, zy);
        }
        let factor = nodes.step * source.sign / R::PI;
        // Rows that come ready: the walls' for a wall, its own for a link.
        let (ready, ready_len) = if source.link.is_some() { (source.first, source.nodes) } else { (0, walls) };
        for (k, (g, dg)) in nodes.points().zip(nodes.tangents()).enumerate() {
            let (column, weight) = (source.first + k, dg * factor);
            let block = match source.link {
                Some(_) => part(model.store, source.self_at + k * ready_len, ready_len),
                None => part(model.store, model.head.walls_at + column * walls, walls),
            };
            let entries = part_mut(matrix, column * ld, n);
            copy(part_mut(entries, ready, ready_len), block);
            for (from, len) in [(0, ready), (ready + ready_len, n - ready - ready_len)] {
                kernel_column(part(zx, from, len), part(zy, from, len), g, weight, part_mut(entries, from, len));
            }
            if with_regular {
                let block = match source.link {
                    Some(_) => part(model.store, source.regular_at + k * ready_len, ready_len),
                    None => part(model.store, model.head.walls_regular_at + column * walls, walls),
                };
                let entries = part_mut(regular, column * n, n);
                copy(part_mut(entries, ready, ready_len), block);
                for (from, len) in [(0, ready), (ready + ready_len, n - ready - ready_len)] {
                    // Re(w/(g−z)) = −Im(−i w/(g−z)): the same kernel with the weight turned by −90°.
                    let turned = complex(weight.im, -weight.re);
                    kernel_column(part(zx, from, len), part(zy, from, len), g, turned, part_mut(entries, from, len));
                }
            }
        }
    }
}

/// −Im(weight/(g − z)) for a column of targets.
#[inline]
fn kernel_column<R: Real>(zx: &[R], zy: &[R], g: Complex<R>, weight: Complex<R>, out: &mut [R]) {
    for ((a, x), y) in out.iter_mut().zip(zx).zip(zy) {
        let (dx, dy) = (g.re - *x, g.im - *y);
        *a = (weight.re * dy - weight.im * dx) / (dx * dx + dy * dy);
    }
}

/// Complex velocity that a density `w` (real and imaginary part; an empty imaginary part is 0) on boundary j
/// induces at the targets: Σ_k D_ik w_k, D = (sign_j/π) h Γ'_k/(Γ_k − z_i)². Adds to `hx`, `hy`. One division per pair.
pub(crate) fn induced_velocity<R: Real>(
    source: &BoundaryRecord<R>,
    nodes: &Nodes<'_, R>,
    wx: &[R],
    wy: &[R],
    zx: &[R],
    zy: &[R],
    hx: &mut [R],
    hy: &mut [R],
) {
    let factor = nodes.step * source.sign / R::PI;
    for (k, ((g, dg), wx)) in nodes.points().zip(nodes.tangents()).zip(wx).enumerate() {
        let c = dg * complex(*wx, wy.get(k).copied().unwrap_or(R::zero())) * factor;
        for (((hx, hy), x), y) in hx.iter_mut().zip(hy.iter_mut()).zip(zx).zip(zy) {
            let (dx, dy) = (g.re - *x, g.im - *y);
            let inverse = R::one() / (dx * dx + dy * dy);
            let (ex, ey) = (dx * inverse, -dy * inverse);
            let (sx, sy) = (ex * ex - ey * ey, (ex + ex) * ey);
            *hx += c.re * sx - c.im * sy;
            *hy += c.re * sy + c.im * sx;
        }
    }
}

/// [`induced_velocity`] of a real density together with its transpose: also adds Im Σ_i f_i D_ik to `out_k`, from the same
/// reciprocals. The sums over targets run in eight lanes so that they vectorize.
pub(crate) fn induced_velocity_both<R: Real>(
    source: &BoundaryRecord<R>,
    nodes: &Nodes<'_, R>,
    w: &[R],
    t: &mut TargetColumns<'_, R>,
    out: &mut [R],
) {
    let factor = nodes.step * source.sign / R::PI;
    for (((g, dg), w), out) in nodes.points().zip(nodes.tangents()).zip(w).zip(out) {
        let weight = dg * factor;
        let c = weight * *w;
        let (mut re, mut im) = ([R::zero(); LANES], [R::zero(); LANES]);
        let chunks = t.hx.chunks_mut(LANES).zip(t.hy.chunks_mut(LANES));
        let points = t.zx.chunks(LANES).zip(t.zy.chunks(LANES)).zip(t.fx.chunks(LANES).zip(t.fy.chunks(LANES)));
        for ((hx, hy), ((zx, zy), (fx, fy))) in chunks.zip(points) {
            let sums = re.iter_mut().zip(im.iter_mut());
            let targets = hx.iter_mut().zip(hy).zip(zx.iter().zip(zy)).zip(fx.iter().zip(fy));
            for ((((hx, hy), (x, y)), (fx, fy)), (re, im)) in targets.zip(sums) {
                let (dx, dy) = (g.re - *x, g.im - *y);
                let inverse = R::one() / (dx * dx + dy * dy);
                let (ex, ey) = (dx * inverse, -dy * inverse);
                let (sx, sy) = (ex * ex - ey * ey, (ex + ex) * ey);
                *hx += c.re * sx - c.im * sy;
                *hy += c.re * sy + c.im * sx;
                *re += sx * *fx - sy * *fy;
                *im += sx * *fy + sy * *fx;
            }
        }
        let sum = re.iter().zip(&im).fold(Complex::default(), |s: Complex<R>, (re, im)| s + complex(*re, *im));
        *out += (weight * sum).im;
    }
}

/// Lanes of the sums over targets.
const LANES: usize = 8;

/// Columns over the targets of a pair: their nodes z in the source's frame, weights f, and the velocity h that adds up.
pub(crate) struct TargetColumns<'a, R> {
    pub zx: &'a [R],
    pub zy: &'a [R],
    pub fx: &'a [R],
    pub fy: &'a [R],
    pub hx: &'a mut [R],
    pub hy: &'a mut [R],
}
