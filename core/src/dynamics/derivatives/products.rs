//! Products of W = Im dG[q̇] = Im(ż ∘ D) with columns, of which W is never formed whole: the columns of one source at a time.
//!
//! Tested by `tests/derivatives`.

use crate::base::complex::{Complex, complex};
use crate::base::features;
use crate::base::lanes::{LANES, lanes, put_lanes, sum_of};
use crate::base::machine::{Machine, Task};
use crate::base::memory::{add, at, part, part_mut, put};
use crate::base::once::once;
use crate::base::scalar::Real;
use crate::fluid::configuration::Configuration;
use crate::fluid::induced::{PairScratch, Relative};
use crate::fluid::near::pole;
use crate::geometry::nodes::Nodes;

/// Columns that are multiplied together.
const COLUMNS: usize = 4;

once! {
    /// `to += W from` for each pair of columns with leading dimension `ld`. `panel`: `ld` reals for every node of the largest boundary.
    /// 2N² operations a column.
    pub(crate) fn add_products['a, 'b: 'a](
        c: &'a Configuration<'a, R>, qd: &'a [R], ld: usize, s: &'a mut PairScratch<'b, R>, panel: &'a mut [R],
        from: [&'a [R]; 2], to: [&'a mut [R]; 2],
    ) {
        let machine = Machine::here();
        let [first, second] = to;
        for (j, source, nodes) in c.each_boundary() {
            let panel = part_mut(panel, 0, ld * source.nodes);
            panel.fill(R::zero());
            for (i, target, points) in c.each_boundary() {
                if i == j || (source.link.is_none() && target.link.is_none()) {
                    continue;
                }
                let n = target.nodes;
                let columns = [&mut *s.zx, &mut *s.zy, &mut *s.hx, &mut *s.hy];
                let [zx, zy, vx, vy] = columns.map(|x| part_mut(x, 0, n));
                let Relative { place: [z0, z1], rate: [v0, v1] } = Relative::of(c, i, j, qd);
                for (k, x) in points.points().enumerate() {
                    let (z, v) = (z0 + z1 * x, v0 + v1 * x);
                    for (column, value) in [&mut *zx, &mut *zy, &mut *vx, &mut *vy].into_iter().zip([z.re, z.im, v.re, v.im]) {
                        put(column, k, value);
                    }
                }
                let factor = nodes.step * source.sign / R::PI;
                let at_targets = [&*zx, &*zy, &*vx, &*vy];
                machine.run(Panel { nodes, factor, at_targets, first: target.first, ld, panel: &mut *panel });
                let table = source.table(c.model.store);
                if features::NEAR && !table.is_empty() {
                    for k in 0..n {
                        let rate = complex(at(vx, k), at(vy, k)) * (source.sign / R::PI);
                        for p in c.preimages(j, target.first + k) {
                            pole::each_slope(&p, table, source.nodes, Complex::default(), |column, d, _| {
                                add(panel, column * ld + target.first + k, (rate * d).im);
                            });
                        }
                    }
                }
            }
            for (from, to) in from.into_iter().zip([&mut *first, &mut *second]) {
                machine.run(Product { panel, from, to, ld, row: source.first, depth: source.nodes });
            }
        }
    }
}

/// Im(ż D) for the nodes of one source at those of one target, `first` of the columns' rows.
struct Panel<'a, 'b, R> {
    nodes: Nodes<'a, R>,
    factor: R,
    /// Places of the targets and how they move, in the source's frame.
    at_targets: [&'b [R]; 4],
    first: usize,
    ld: usize,
    panel: &'b mut [R],
}

impl<R: Real> Task for Panel<'_, '_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Panel { nodes, factor, at_targets: [zx, zy, vx, vy], first, ld, panel } = self;
        for ((g, dg), column) in nodes.points().zip(nodes.tangents()).zip(panel.chunks_exact_mut(ld.max(1))) {
            let w = dg * factor;
            let out = part_mut(column, first, zx.len());
            for ((out, (x, y)), (vx, vy)) in out.iter_mut().zip(zx.iter().zip(zy)).zip(vx.iter().zip(vy)) {
                let (dx, dy) = (g.re - *x, g.im - *y);
                let inverse = R::one() / (dx * dx + dy * dy);
                let (ex, ey) = (dx * inverse, -dy * inverse);
                let (sx, sy) = (ex * ex - ey * ey, (ex + ex) * ey);
                let (hx, hy) = (w.re * sx - w.im * sy, w.re * sy + w.im * sx);
                *out = *vx * hy + *vy * hx;
            }
        }
    }
}

/// C += A B: A the panel, B the rows from `row` on of `from`, C all rows of `to`.
struct Product<'b, R> {
    panel: &'b [R],
    from: &'b [R],
    to: &'b mut [R],
    ld: usize,
    row: usize,
    depth: usize,
}

impl<R: Real> Task for Product<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Product { panel, from, to, ld, row, depth } = self;
        let width = (COLUMNS * ld).max(1);
        for (from, to) in from.chunks(width).zip(to.chunks_mut(width)) {
            if to.len() == width {
                tile::<R, COLUMNS>(panel, ld, from, row, depth, to);
            } else {
                for (from, to) in from.chunks(ld.max(1)).zip(to.chunks_mut(ld.max(1))) {
                    tile::<R, 1>(panel, ld, from, row, depth, to);
                }
            }
        }
    }
}

/// The same for `M` columns, eight rows at a time.
#[inline(always)]
fn tile<R: Real, const M: usize>(panel: &[R], ld: usize, from: &[R], row: usize, depth: usize, to: &mut [R]) {
    let b: [&[R]; M] = core::array::from_fn(|m| part(from, m * ld + row, depth));
    for first in (0..ld).step_by(LANES) {
        let mut sums = [[R::zero(); LANES]; M];
        for (k, column) in panel.chunks_exact(ld.max(1)).take(depth).enumerate() {
            let a: [R; LANES] = lanes(column.get(first..).unwrap_or(&[]), R::zero());
            for (sum, b) in sums.iter_mut().zip(&b) {
                let b = b.get(k).copied().unwrap_or(R::zero());
                for (s, a) in sum.iter_mut().zip(a) {
                    *s += a * b;
                }
            }
        }
        for (m, sum) in sums.into_iter().enumerate() {
            let out = part_mut(to, m * ld + first, ld - first);
            let mut before = lanes(out, R::zero());
            before.iter_mut().zip(sum).for_each(|(x, s)| *x += s);
            put_lanes(before, out);
        }
    }
}

once! {
    /// `out_ab += scale · left_a · right_b` over the first `n` rows of columns with leading dimension `ld`, `count` of each; `out`
    /// column-major.
    pub(crate) fn add_inner_products['a](
        left: &'a [R], right: &'a [R], ld: usize, n: usize, count: usize, scale: R, out: &'a mut [R],
    ) {
        Machine::here().run(Inner { left, right, ld, n, count, scale, out });
    }
}

struct Inner<'b, R> {
    left: &'b [R],
    right: &'b [R],
    ld: usize,
    n: usize,
    count: usize,
    scale: R,
    out: &'b mut [R],
}

impl<R: Real> Task for Inner<'_, R> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Inner { left, right, ld, n, count, scale, out } = self;
        for b in 0..count {
            let r = part(right, b * ld, n);
            // A link has three unit motions: their products share what they read.
            for a in (0..count).step_by(3) {
                let columns = [0, 1, 2].map(|k| part(left, (a + k) * ld, n));
                for (k, sum) in three_products(columns, r).into_iter().enumerate() {
                    add(out, b * count + a + k, scale * sum);
                }
            }
        }
    }
}

/// Three scalar products with one vector. Chunks are arrays: of another length the compiler would not know that it is not 0.
#[inline(always)]
fn three_products<R: Real>(columns: [&[R]; 3], r: &[R]) -> [R; 3] {
    let mut sums = [[R::zero(); LANES]; 3];
    let ([x, y, z], (r, r_rest)) = (columns.map(|column| column.as_chunks::<LANES>()), r.as_chunks::<LANES>());
    let mut take = |columns: [[R; LANES]; 3], r: [R; LANES]| {
        for (sum, column) in sums.iter_mut().zip(columns) {
            for ((s, c), r) in sum.iter_mut().zip(column).zip(r) {
                *s += c * r;
            }
        }
    };
    for (r, (x, (y, z))) in r.iter().zip(x.0.iter().zip(y.0.iter().zip(z.0))) {
        take([*x, *y, *z], *r);
    }
    if !r_rest.is_empty() {
        take([x.1, y.1, z.1].map(|rest| lanes(rest, R::zero())), lanes(r_rest, R::zero()));
    }
    sums.map(sum_of)
}
