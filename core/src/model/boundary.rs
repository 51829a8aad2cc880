//! Nodes of one boundary in its own frame, and what rigid motion leaves unchanged: the self block of the
//! matrix and the interior potential of rotation.
//!
//! With n out of the fluid and G = (sign/π) W, W_ik ≈ ∫ ds Γ'/(Γ − z_i): sign = −1 on links and obstacles, +1 on
//! the tank. The matrix is A = I − Im G. On one boundary W is a principal value:
//! W_ik = h Γ'_k/(Γ_k − Γ_i) − (−1)^(k−i) (h/2) cot((s_k − s_i)/2), W_ii = h Γ''_i/(2Γ'_i); the cotangent is real
//! and matters only for Re G.

use crate::base::complex::{Complex, complex, dot};
use crate::base::features;
use crate::base::machine::Machine;
use crate::base::memory::{part, part_mut, put, take};
use crate::base::scalar::Real;
use crate::base::status::{Place, Result, Status};
use crate::fluid::near::preimage::{Source, Targets};
use crate::fluid::near::{Preimage, pole};
use crate::geometry::curve::{Curve, Outline, OutlineView};
use crate::geometry::grading::Ladder;
use crate::geometry::pose::Pose;
use crate::linear::lu::{Factors, factor};

/// One boundary of the fluid.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryRecord<R> {
    /// Where it stands in the scene.
    pub place: Place,
    /// Link that carries it; `None` for a wall.
    pub link: Option<usize>,
    /// −1 for links and obstacles, +1 for the tank.
    pub sign: R,
    /// Number of nodes.
    pub nodes: usize,
    /// First unknown.
    pub first: usize,
    /// Compiled shape.
    pub outline: Outline<R>,
    /// Where the shape's numbers are in the store.
    pub store_at: usize,
    /// How many they are.
    pub store_len: usize,
    /// Origin of the boundary's frame in the shape's drawing frame.
    pub origin: Complex<R>,
    /// Where the permanent ladders are in the store, and how many.
    pub ladders_at: usize,
    /// Number of permanent ladders.
    pub ladders: usize,
    /// Where the parameters of tips and corners are in the store.
    pub tips_at: usize,
    /// Number of tips and corners.
    pub tips: usize,
    /// Where the Fourier sum of the potential of rotation is in the store.
    pub modes_at: usize,
    /// Reals of that sum (0: closed form or fixed nodes).
    pub modes: usize,
    /// Where the table of pole terms is in the store.
    pub table_at: usize,
    /// Its length (0: plain rule).
    pub table_len: usize,
    /// Where the rungs of a configuration are in a simulation's buffer.
    pub rungs_at: usize,
    /// Reals of them.
    pub rungs_len: usize,
    /// Where the node arrays are in the store.
    pub data_at: usize,
    /// Where the self block of A is in the store (links only).
    pub self_at: usize,
    /// Where Re G of the self block is in the store (links with circulation in the scene only).
    pub regular_at: usize,
    /// Circulation.
    pub circulation: R,
    /// Its isolated circulatory flow.
    pub core: Core<R>,
    /// Placement of a wall.
    pub pose: Pose<R>,
    /// Greatest distance of the outline from the frame's origin.
    pub reach: R,
    /// Greatest distance between neighbouring nodes.
    pub spacing: R,
    /// What set-up noticed.
    pub notice: Status,
}

/// Isolated circulatory flow of one boundary, analytic outside: log z' about a point, or log W of an ellipse.
#[derive(Clone, Copy, Debug, Default)]
pub struct Core<R> {
    /// Origin of z' in the boundary's frame.
    pub centre: Complex<R>,
    /// Semi-axes of an ellipse; (0, 0) for a point vortex.
    pub axes: [R; 2],
}

impl<R: Real> Default for BoundaryRecord<R> {
    fn default() -> Self {
        BoundaryRecord {
            place: Place::Scene,
            link: None,
            sign: -R::one(),
            nodes: 0,
            first: 0,
            outline: Outline::default(),
            store_at: 0,
            store_len: 0,
            origin: Complex::default(),
            ladders_at: 0,
            ladders: 0,
            tips_at: 0,
            tips: 0,
            modes_at: 0,
            modes: 0,
            table_at: 0,
            table_len: 0,
            rungs_at: 0,
            rungs_len: 0,
            data_at: 0,
            self_at: 0,
            regular_at: 0,
            circulation: R::zero(),
            core: Core::default(),
            pose: Pose::default(),
            reach: R::zero(),
            spacing: R::zero(),
            notice: Status::Ok,
        }
    }
}

/// Node arrays of one boundary in its own frame (origin: centre of mass, or the drawing origin of a wall).
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a, R> {
    /// x of the nodes.
    pub x: &'a [R],
    /// y of the nodes.
    pub y: &'a [R],
    /// dx/ds.
    pub dx: &'a [R],
    /// dy/ds.
    pub dy: &'a [R],
    /// Outline parameter t.
    pub t: &'a [R],
    /// d²x/ds².
    pub ddx: &'a [R],
    /// d²y/ds².
    pub ddy: &'a [R],
    /// Interior potential of rotation (empty for walls and without fluid).
    pub chi: &'a [R],
    /// Step h = 2π/N of the parameter s.
    pub step: R,
}

impl<'a, R: Real> Nodes<'a, R> {
    /// Reads the columns x, y, x', y', t, x'', y'', χ of `n` nodes (without the last: χ is empty).
    pub(crate) fn read(data: &'a [R], n: usize) -> Self {
        let column = |k: usize| part(data, k * n, n);
        Nodes {
            x: column(0),
            y: column(1),
            dx: column(2),
            dy: column(3),
            t: column(4),
            ddx: column(5),
            ddy: column(6),
            chi: column(7),
            step: R::TAU / R::count(n.max(1)),
        }
    }
}

impl<R: Real> BoundaryRecord<R> {
    /// Reals of the node arrays.
    pub(crate) fn data_len(nodes: usize, with_chi: bool) -> Option<usize> {
        nodes.checked_mul(if with_chi { 8 } else { 7 })
    }
    pub(crate) fn nodes<'a>(&self, store: &'a [R]) -> Nodes<'a, R> {
        Nodes::read(part(store, self.data_at, self.nodes * if self.link.is_some() { 8 } else { 7 }), self.nodes)
    }
    /// Curve and permanent grading.
    pub(crate) fn view<'a>(&self, store: &'a [R]) -> OutlineView<'a, R> {
        self.outline.view(part(store, self.store_at, self.store_len))
    }
    /// Cosines and sines of the pole terms (empty for the plain rule).
    pub(crate) fn table<'a>(&self, store: &'a [R]) -> &'a [R] {
        if features::NEAR { part(store, self.table_at, self.table_len) } else { &[] }
    }
    /// The boundary with its own nodes as the source of poles.
    pub(crate) fn source<'a>(&'a self, store: &'a [R]) -> Source<'a, R> {
        Source { record: self, nodes: self.nodes(store), view: self.view(store), table: self.table(store) }
    }
    /// Permanent ladders.
    pub(crate) fn ladders<'a>(&self, store: &'a [R]) -> impl Iterator<Item = Ladder<R>> + use<'a, R> {
        let list = part(store, self.ladders_at, 3 * self.ladders);
        list.as_chunks::<3>().0.iter().map(|&[t, beta, top]| Ladder { t, beta, top })
    }
    /// χ₃ at a point of the outline, whose permanent parameter s is asked for where there is no closed form.
    pub(crate) fn rotation_potential(&self, store: &[R], x: Complex<R>, s: impl FnOnce() -> R) -> R {
        match self.view(store).curve {
            Curve::Ellipse(e) => {
                // About the centre: ratio·x y. The frame's origin is off the centre by `origin`: rotation about it differs
                // by the translation −i·origin, whose potential is linear.
                let (a, b) = (e.a * e.a, e.b * e.b);
                let centred = x + self.origin;
                let shift = complex(self.origin.im, -self.origin.re);
                (a - b) / (a + b) * centred.re * centred.im + dot(shift, x)
            }
            _ => fourier_sum(part(store, self.modes_at, self.modes), s()),
        }
    }
}

/// Σ a_m cos ms + b_m sin ms of pairs (a_m, b_m), by Clenshaw's recurrence.
fn fourier_sum<R: Real>(modes: &[R], s: R) -> R {
    let (sin, cos) = s.sin_cos();
    let twice = cos * R::TWO;
    let (mut a1, mut a2, mut b1, mut b2) = (R::zero(), R::zero(), R::zero(), R::zero());
    let mut pairs = modes.as_chunks::<2>().0.iter();
    let first = pairs.next().map_or(R::zero(), |[a, _]| *a);
    // Downwards: the list is short, and an iterator from the back needs no index.
    while let Some([a, b]) = pairs.next_back() {
        (a1, a2) = (*a + twice * a1 - a2, a1);
        (b1, b2) = (*b + twice * b1 - b2, b1);
    }
    first + cos * a1 - a2 + sin * b1
}

impl<R: Real> Nodes<'_, R> {
    /// Positions.
    #[inline]
    pub(crate) fn points(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.x.iter().zip(self.y).map(|(x, y)| complex(*x, *y))
    }
    /// Tangents dΓ/ds.
    #[inline]
    pub(crate) fn tangents(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.dx.iter().zip(self.dy).map(|(x, y)| complex(*x, *y))
    }
    /// d²Γ/ds².
    #[inline]
    pub(crate) fn seconds(&self) -> impl Iterator<Item = Complex<R>> + Clone + '_ {
        self.ddx.iter().zip(self.ddy).map(|(x, y)| complex(*x, *y))
    }
}

/// Writes the columns x, y, x', y', t, x'', y'' of `n` nodes about `origin`; returns the largest distance from it and the
/// largest speed.
pub(crate) fn write_nodes<R: Real>(
    view: &OutlineView<'_, R>,
    origin: Complex<R>,
    n: usize,
    data: &mut [R],
) -> Result<(R, R)> {
    let (mut reach, mut speed) = (R::zero(), R::zero());
    let mut k = 0;
    view.walk(n, |node| {
        let x = node.x - origin;
        let values = [x.re, x.im, node.dx.re, node.dx.im, node.t, node.ddx.re, node.ddx.im];
        for (c, value) in values.into_iter().enumerate() {
            put(data, c * n + k, value);
        }
        reach = reach.max(crate::base::complex::cabs(x));
        speed = speed.max(crate::base::complex::cabs(node.dx));
        k += 1;
    })?;
    Ok((reach, speed))
}

/// Fills the node arrays of a boundary whose frame origin is known, its reach and spacing, and its table of pole terms.
pub(crate) fn fill_nodes<R: Real>(record: &mut BoundaryRecord<R>, store: &mut [R]) -> Result<()> {
    let n = record.nodes;
    let (outlines, data) = store.split_at_mut_checked(record.data_at).ok_or(Status::Internal)?;
    let (reach, speed) = write_nodes(&record.view(outlines), record.origin, n, data)?;
    record.spacing = speed * R::TAU / R::count(n.max(1));
    // The outline may bulge beyond its nodes by at most half a spacing.
    record.reach = reach + record.spacing * R::HALF;
    if features::NEAR && record.table_len > 0 {
        pole::fill_table(n, part_mut(store, record.table_at, record.table_len));
    }
    if reach.is_finite() && speed.is_finite() { Ok(()) } else { Err(Status::NotFinite.into()) }
}

/// Where the entries of a block go: column-major, the block's first entry at `at`.
pub(crate) struct Block<'a, R> {
    pub data: &'a mut [R],
    pub ld: usize,
    pub at: usize,
}

impl<R: Real> Block<'_, R> {
    /// Column `k` of the block, `n` rows.
    #[inline]
    pub(crate) fn column(&mut self, k: usize, n: usize) -> &mut [R] {
        part_mut(self.data, self.at + k * self.ld, n)
    }
}

/// Fills the block of A = I − Im G of a boundary with itself by the plain rule, with `completion` in every entry, and of
/// Re G if there is memory for it. O(N²).
pub(crate) fn fill_self_block<R: Real>(
    nodes: &Nodes<'_, R>,
    sign: R,
    completion: R,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    let (n, h, factor) = (nodes.x.len(), nodes.step, sign / R::PI);
    for (k, ((g, dg), ddg)) in nodes.points().zip(nodes.tangents()).zip(nodes.seconds()).enumerate() {
        let weight = dg * (h * factor);
        let own = ddg / dg * (h * R::HALF * factor);
        for (i, (a, z)) in matrix.column(k, n).iter_mut().zip(nodes.points()).enumerate() {
            let d = g - z;
            let im = (weight.im * d.re - weight.re * d.im) / (d.re * d.re + d.im * d.im);
            *a = completion + if i == k { R::one() - own.im } else { -im };
        }
        if regular.data.is_empty() {
            continue;
        }
        for (i, (a, z)) in regular.column(k, n).iter_mut().zip(nodes.points()).enumerate() {
            if i == k {
                *a = own.re;
                continue;
            }
            let half = R::count(k.abs_diff(i)) * h * R::HALF;
            let (s, c) = half.sin_cos();
            let cot = if (k > i) == (k.abs_diff(i) % 2 == 0) { c / s } else { -c / s };
            *a = (weight / (g - z)).re - cot * h * R::HALF * factor;
        }
    }
}

/// Adds the pole term of a preimage to row `i` of both blocks.
pub(crate) fn add_pole_term<R: Real>(
    p: &Preimage<R>,
    table: &[R],
    nodes: usize,
    sign: R,
    i: usize,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    let factor = sign / R::PI;
    let (at, from) = (matrix.at + i, regular.at + i);
    let out = [
        pole::RowOf { data: regular.data.get_mut(from..).unwrap_or(&mut []), stride: regular.ld, scale: factor },
        pole::RowOf { data: matrix.data.get_mut(at..).unwrap_or(&mut []), stride: matrix.ld, scale: -factor },
    ];
    pole::add_weights(Machine::here(), p, table, nodes, out);
}

/// Adds the pole terms of the opposite flank to a boundary's block with itself.
pub(crate) fn add_flank_terms<R: Real>(
    source: &Source<'_, R>,
    sign: R,
    matrix: &mut Block<'_, R>,
    regular: &mut Block<'_, R>,
) {
    if !features::NEAR || source.table.is_empty() {
        return;
    }
    let (turn, shift) = (complex(R::one(), R::zero()), Complex::default());
    let targets = Targets { nodes: source.nodes, turn, shift, own: true };
    source.each_preimage(&targets, |i, p| {
        add_pole_term(&p, source.table, source.nodes.x.len(), sign, i, matrix, regular);
    });
}

/// Fills χ₃ at the nodes: the function harmonic inside the outline with the normal derivative of the rotation about the
/// frame's origin. Closed form for an ellipse; otherwise one interior solve, (I − Im W/π + 1/M) χ = −Re W/π |X|²/2, on the
/// nodes or, where nodes will move, on twice as many, in `scratch`, of which the Fourier sum in s is kept. O(M³) once.
pub(crate) fn fill_rotation_potential<R: Real>(
    record: &BoundaryRecord<R>,
    store: &mut [R],
    scratch: &mut [R],
) -> Result<()> {
    let n = record.nodes;
    if !matches!(record.view(store).curve, Curve::Ellipse(_)) {
        let m = potential_nodes(record.modes, n);
        let mut rest = scratch;
        let matrix = take(&mut rest, m * m + m)?;
        let regular = take(&mut rest, m * m)?;
        let pivots = take(&mut rest, m)?;
        let data = take(&mut rest, 7 * m)?;
        let table = take(&mut rest, if record.table_len > 0 { 4 * m } else { 0 })?;
        if features::NEAR && !table.is_empty() {
            pole::fill_table(m, table);
        }
        let view = record.view(store);
        write_nodes(&view, record.origin, m, data)?;
        let nodes = Nodes::read(data, m);
        let (block, rhs) = matrix.split_at_mut_checked(m * m).ok_or(Status::Internal)?;
        let (mut a, mut g) = (Block { data: block, ld: m, at: 0 }, Block { data: &mut *regular, ld: m, at: 0 });
        fill_self_block(&nodes, R::one(), R::one() / R::count(m), &mut a, &mut g);
        add_flank_terms(&Source { record, nodes, view, table }, R::one(), &mut a, &mut g);
        rhs.fill(R::zero());
        for (column, x) in regular.chunks_exact(m.max(1)).zip(nodes.points()) {
            crate::base::memory::axpy(rhs, -dot(x, x) * R::HALF, column);
        }
        factor(matrix, m, m, pivots)?;
        let (block, chi) = matrix.split_at_mut_checked(m * m).ok_or(Status::Internal)?;
        Factors { lu: block, ld: m, pivots }.back_substitute(chi);
        fourier_modes(chi, part_mut(store, record.modes_at, record.modes));
        if record.modes == 0 {
            crate::base::memory::copy(part_mut(store, record.data_at + 7 * n, n), chi);
            return Ok(());
        }
    }
    for k in 0..n {
        let column = |c: usize| crate::base::memory::at(store, record.data_at + c * n + k);
        let chi = record
            .rotation_potential(store, complex(column(0), column(1)), || R::TAU * R::count(k) / R::count(n.max(1)));
        put(store, record.data_at + 7 * n + k, chi);
    }
    Ok(())
}

/// Nodes on which χ₃ is computed: as many as there are numbers kept of its Fourier sum, or the boundary's own.
fn potential_nodes(modes: usize, nodes: usize) -> usize {
    if modes == 0 { nodes } else { modes - 2 }
}

/// Reals of scratch for χ₃ of an outline without closed form.
pub(crate) fn potential_scratch(modes: usize, nodes: usize) -> Option<usize> {
    let m = potential_nodes(modes, nodes);
    m.checked_mul(m)?.checked_mul(2)?.checked_add(m.checked_mul(13)?)
}

/// Reals that the Fourier sum of χ₃ on 2·`nodes` points takes.
pub(crate) fn modes_len(nodes: usize) -> Option<usize> {
    nodes.checked_mul(2)?.checked_add(2)
}

/// Pairs (a_m, b_m), m = 0 … M/2, of M equispaced samples. O(M²).
fn fourier_modes<R: Real>(samples: &[R], modes: &mut [R]) {
    let count = R::count(samples.len().max(1));
    let half = samples.len() / 2;
    for (m, pair) in modes.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let turn = crate::base::complex::cis(R::TAU * R::count(m) / count);
        let (mut power, mut sum) = (complex(R::one(), R::zero()), Complex::<R>::default());
        for (k, f) in samples.iter().enumerate() {
            // The power is refreshed so that rounding does not pile up.
            if k % 16 == 0 {
                power = crate::base::complex::cis(R::TAU * R::count(m * k % samples.len().max(1)) / count);
            }
            sum += power * *f;
            power *= turn;
        }
        let scale = if m == 0 || m == half { R::one() } else { R::TWO } / count;
        *pair = [sum.re * scale, sum.im * scale];
    }
}
