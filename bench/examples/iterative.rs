//! What an iterative solution of the boundary system would give against the factorization: GMRES with the inverses of the
//! bodies' own blocks, which are constant in their frames, as preconditioner; the matrix dense. Arrays of ellipses 1 : ½.
//!
//! A counts as a product of the dense matrix with a vector, which streams the matrix from memory.

use nekton::lu::{Factors, factor};
use nekton_bench::timing::{median, thread_seconds};

/// Relative residual that ends an iteration.
const TOLERANCE: f64 = 1e-12;

/// A complex number.
type Point = (f64, f64);

fn minus(a: Point, b: Point) -> Point {
    (a.0 - b.0, a.1 - b.1)
}

/// Im a/b.
fn quotient(a: Point, b: Point) -> f64 {
    (a.1 * b.0 - a.0 * b.1) / (b.0 * b.0 + b.1 * b.1)
}

/// The matrix I − Im G of `columns` × `rows` ellipses with `nodes` nodes each, a gap apart, by columns.
fn system(columns: usize, rows: usize, nodes: usize, gap: f64) -> Vec<f64> {
    let (n, step) = (columns * rows * nodes, std::f64::consts::TAU / nodes as f64);
    let (mut x, mut dx, mut ddx) = (Vec::new(), Vec::new(), Vec::new());
    for body in 0..columns * rows {
        let centre = ((body % columns) as f64 * (2.0 + gap), (body / columns) as f64 * (1.0 + gap));
        for k in 0..nodes {
            let (s, c) = (k as f64 * step).sin_cos();
            x.push((centre.0 + c, centre.1 + 0.5 * s));
            dx.push((-s, 0.5 * c));
            ddx.push((-c, -0.5 * s));
        }
    }
    let factor = -step / std::f64::consts::PI;
    let mut a = vec![0.0; n * n];
    for k in 0..n {
        for i in 0..n {
            a[k * n + i] = if i == k {
                1.0 - factor * 0.5 * quotient(ddx[k], dx[k])
            } else {
                -factor * quotient(dx[k], minus(x[k], x[i]))
            };
        }
    }
    a
}

/// y = A x.
fn product(a: &[f64], x: &[f64], y: &mut [f64]) {
    y.fill(0.0);
    // Four columns at a time: y is read and written less often.
    for (columns, x) in a.chunks_exact(4 * y.len()).zip(x.chunks_exact(4)) {
        let (first, second) = columns.split_at(2 * y.len());
        let ((a, b), (c, d)) = (first.split_at(y.len()), second.split_at(y.len()));
        for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *y += a * x[0] + b * x[1] + c * x[2] + d * x[3];
        }
    }
}

/// The factors of a body's own block.
struct Block {
    lu: Vec<f64>,
    pivots: Vec<u64>,
}

impl Block {
    fn new(a: &[f64], n: usize, nodes: usize) -> Self {
        let mut lu: Vec<f64> = (0..nodes).flat_map(|k| a[k * n..k * n + nodes].to_vec()).collect();
        let mut pivots = vec![0; nodes];
        factor(&mut lu, nodes, nodes, &mut pivots).expect("a body alone has a solution");
        Block { lu, pivots }
    }

    fn solve(&self, b: &mut [f64]) {
        let nodes = self.pivots.len();
        let factors = Factors { lu: &self.lu, ld: nodes, pivots: &self.pivots };
        b.chunks_exact_mut(nodes).for_each(|part| factors.solve(part));
    }
}

fn inner(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// Iterations of GMRES (no restart) until the preconditioned residual is small; the solution replaces `b`.
fn gmres(a: &[f64], block: &Block, b: &mut [f64]) -> usize {
    let n = b.len();
    block.solve(b);
    let size = inner(b, b).sqrt();
    let mut basis = vec![b.iter().map(|x| x / size).collect::<Vec<f64>>()];
    let (mut upper, mut turns, mut g) = (Vec::<Vec<f64>>::new(), Vec::new(), vec![size]);
    for k in 0..200 {
        let mut w = vec![0.0; n];
        product(a, &basis[k], &mut w);
        block.solve(&mut w);
        let mut h = Vec::new();
        for v in &basis {
            let c = inner(&w, v);
            w.iter_mut().zip(v).for_each(|(w, v)| *w -= c * v);
            h.push(c);
        }
        let rest = inner(&w, &w).sqrt();
        for (i, (c, s)) in turns.iter().enumerate() {
            (h[i], h[i + 1]) = (c * h[i] + s * h[i + 1], c * h[i + 1] - s * h[i]);
        }
        let length = h[k].hypot(rest);
        let (c, s) = (h[k] / length, rest / length);
        h[k] = length;
        turns.push((c, s));
        upper.push(h);
        g.push(-s * g[k]);
        g[k] *= c;
        if g[k + 1].abs() <= TOLERANCE * size || rest == 0.0 {
            break;
        }
        basis.push(w.iter().map(|x| x / rest).collect());
    }
    let steps = upper.len();
    let mut y = g[..steps].to_vec();
    for i in (0..steps).rev() {
        y[i] = (y[i] - (i + 1..steps).map(|j| upper[j][i] * y[j]).sum::<f64>()) / upper[i][i];
    }
    b.fill(0.0);
    for (y, v) in y.iter().zip(&basis) {
        b.iter_mut().zip(v).for_each(|(b, v)| *b += y * v);
    }
    steps
}

fn timed(mut run: impl FnMut()) -> f64 {
    let once = |run: &mut dyn FnMut()| {
        let start = thread_seconds();
        run();
        thread_seconds() - start
    };
    median((0..3).map(|_| once(&mut run)).collect())
}

fn main() {
    println!(
        "bodies,nodes,unknowns,gap,factorization_s,product_s,iterations,solve_s,difference,right_hand_sides,iterative/direct"
    );
    for (columns, rows, nodes) in [(2, 2, 256), (4, 4, 64), (2, 2, 512), (8, 4, 64), (2, 2, 1024), (8, 8, 64)] {
        for gap in [1.0, 0.2] {
            let n = columns * rows * nodes;
            let a = system(columns, rows, nodes, gap);
            let (mut lu, mut pivots) = (a.clone(), vec![0; n]);
            let start = thread_seconds();
            factor(&mut lu, n, n, &mut pivots).expect("far from singular");
            let direct = thread_seconds() - start;
            let block = Block::new(&a, n, nodes);
            let mut y = vec![0.0; n];
            let x = vec![1.0; n];
            let streamed = timed(|| product(&a, &x, &mut y));
            let right: Vec<f64> = (0..n)
                .map(|i| if i < nodes { (i as f64 / nodes as f64 * std::f64::consts::TAU).cos() } else { 0.0 })
                .collect();
            let (mut b, mut iterations) = (right.clone(), 0);
            let start = thread_seconds();
            iterations += gmres(&a, &block, &mut b);
            let solve = thread_seconds() - start;
            let mut exact = right.clone();
            Factors { lu: &lu, ld: n, pivots: &pivots }.solve(&mut exact);
            let largest = |x: &[f64]| x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let difference: Vec<f64> = exact.iter().zip(&b).map(|(x, y)| x - y).collect();
            // A column for each coordinate, and three more systems for the force.
            let sides = 3 * columns * rows + 3;
            println!(
                "{},{nodes},{n},{gap},{direct:.3e},{streamed:.3e},{iterations},{solve:.3e},{:.0e},{sides},{:.2}",
                columns * rows,
                largest(&difference) / largest(&exact),
                sides as f64 * solve / direct
            );
        }
    }
}
