//! The rows of the table: what is measured against what, and what must come out.

use crate::lapack::{Lapack, diagonal_dominant};
use crate::linearize;
use crate::passing;
use crate::scenes::{Evaluation, array, banks, ellipse, scene, swimmer};
use crate::setups::{Kind, set_up};
use crate::timing::{Measured, Turns};
use nekton::Method;
use nekton::scene::{Body, Harmonic, Quadrature, Root, Scene, Signal};
use nekton_tests::{body, simulation};
use std::sync::atomic::{AtomicU8, Ordering};

pub(crate) type Run = Box<dyn Fn(&Lapack) -> Result<Measured, String>>;

/// A measurement: a ratio of two times, or one time.
pub struct Row {
    /// What is measured, and against what.
    pub name: &'static str,
    /// Unknowns of the boundary system, or what else tells rows of a name apart.
    pub size: usize,
    /// Largest value that is acceptable; infinite where none is asked.
    pub must: f64,
    /// What would be better.
    pub aim: f64,
    /// Whether the guard holds it to `must`.
    pub held: Held,
    pub(crate) run: Run,
}

/// What the guard does with a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Held {
    /// It must be reached.
    Yes,
    /// Not reached yet, or only told, or depends on more than one free processor or another program.
    No,
}

impl Row {
    /// Columns of [`Row::line`].
    pub const HEAD: &'static str = "measure,size,value,must,aim,seconds,divisor_seconds,note";

    /// Runs it.
    pub fn measure(&self, lapack: &Lapack) -> Result<Measured, String> {
        (self.run)(lapack)
    }

    /// A line of a table.
    pub fn line(&self, measured: &Result<Measured, String>) -> String {
        let number = |x: f64| if x.is_finite() { x.to_string() } else { String::new() };
        let (name, size, must, aim) = (self.name, self.size, number(self.must), number(self.aim));
        match measured {
            Ok(m) => {
                format!("{name},{size},{:.3e},{must},{aim},{:.4e},{:.4e},{}", m.ratio, m.time, m.by, m.note)
            }
            Err(why) => format!("{name},{size},,{must},{aim},,,{}", why.replace([',', '\n'], ";")),
        }
    }
}

/// A scene's evaluation against LAPACK's factorization of order `order`.
fn against_getrf(lapack: &Lapack, mut evaluation: Evaluation<f64>, order: usize) -> Measured {
    beside_getrf(lapack, order, &mut || evaluation.run())
}

/// The factorization alone against LAPACK's.
fn factorization(lapack: &Lapack, order: usize) -> Measured {
    let ld = order + 8;
    let a = diagonal_dominant(order, ld);
    let (mut copy, mut pivots) = (a.clone(), vec![0u64; order]);
    let mut measured = beside_getrf(lapack, order, &mut || {
        copy.copy_from_slice(&a);
        nekton::lu::factor(&mut copy, ld, order, &mut pivots).expect("far from singular");
    });
    measured.note = format!("{:.1} GFlop/s", 2e-9 / 3.0 * (order as f64).powi(3) / measured.time);
    measured
}

fn beside_getrf(lapack: &Lapack, order: usize, candidate: &mut dyn FnMut()) -> Measured {
    let ld = order + 8;
    let a = diagonal_dominant(order, ld);
    let mut copy = a.clone();
    let mut pivots = vec![0; order];
    let turns = if order > 600 { Turns { rounds: 9, ..Turns::THREAD } } else { Turns::THREAD };
    let (times, ratios) = turns.run(&mut [
        candidate,
        // The matrix must come from somewhere; an evaluation makes its own.
        &mut || {
            copy.copy_from_slice(&a);
            lapack.dgetrf(&mut copy, ld, order, &mut pivots);
        },
    ]);
    Measured { time: times[0], by: times[1], ratio: ratios[0], note: String::new() }
}

fn one_against_other(mut one: Evaluation<f64>, mut other: Evaluation<f64>) -> Measured {
    let (times, ratios) = Turns::THREAD.run(&mut [&mut || one.run(), &mut || other.run()]);
    let note = format!("{} and {} unknowns", one.unknowns(), other.unknowns());
    Measured { time: times[0], by: times[1], ratio: ratios[0], note }
}

/// The evaluation of ellipses in an array.
pub fn ellipses(columns: usize, rows: usize, gap: f64, nodes: usize, quadrature: Quadrature) -> Evaluation<f64> {
    let link = [ellipse(nodes)];
    Evaluation::new(&scene(&array(&link, columns, rows, gap), quadrature))
}

/// The fewest nodes per body with which accelerations differ from converged ones by no more than `error` (relative to the
/// largest).
fn fewest_nodes(columns: usize, rows: usize, gap: f64, error: f64) -> Result<usize, String> {
    let mut reference = ellipses(columns, rows, gap, 320, Quadrature::Graded);
    reference.run();
    let scale = reference.accelerations().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let accurate = |nodes: usize| {
        let mut evaluation = ellipses(columns, rows, gap, nodes, Quadrature::Graded);
        evaluation.run();
        let pairs = evaluation.accelerations().iter().zip(reference.accelerations());
        pairs.fold(0.0f64, |m, (x, y)| m.max((x - y).abs())) <= error * scale
    };
    (16..=256).step_by(4).find(|n| accurate(*n)).ok_or_else(|| format!("not reached with 256 nodes, gap {gap}"))
}

fn at_equal_accuracy(lapack: &Lapack, columns: usize, rows: usize, gap: f64, error: f64) -> Result<Measured, String> {
    let nodes = fewest_nodes(columns, rows, gap, error)?;
    let mut measured = against_getrf(lapack, ellipses(columns, rows, gap, nodes, Quadrature::Graded), 256);
    measured.note = format!("{nodes} nodes per body");
    Ok(measured)
}

fn swimming(nodes: usize) -> Measured {
    let beat = [Harmonic { amplitude: 0.3, frequency: 2.0, phase: 0.3, offset: 0.1 }];
    let joined = swimmer(6, nodes, &beat);
    let neighbour = [ellipse(nodes)];
    let far = body(&neighbour, [0.0, 4.0, 0.0], [0.1, 0.0, 0.0]);
    let whole = [body(&joined, [0.0; 3], [0.1, 0.0, 0.1]), far];
    let free = [ellipse(nodes)];
    let parts: Vec<Body<'_, f64>> =
        (0..6).map(|i| body(&free, [-2.6 * f64::from(i), 0.0, 0.0], [0.1, 0.0, 0.1])).chain([far]).collect();
    let of = |bodies: &[Body<'_, f64>]| {
        Evaluation::new(&Scene { bodies, quadrature: Quadrature::Plain, ..Scene::new(1.0, 0.0) })
    };
    one_against_other(of(&whole), of(&parts))
}

fn walls(nodes: usize) -> Measured {
    let link = [ellipse(nodes / 2)];
    let bodies = [body(&link, [-1.3, 0.0, 0.1], [0.1, 0.0, 0.1]), body(&link, [1.3, 0.0, 0.0], [0.0, 0.1, 0.0])];
    let obstacles = banks(3 * nodes / 2);
    let fixed = Scene { bodies: &bodies, obstacles: &obstacles, ..scene(&[], Quadrature::Plain) };
    let wall_links = obstacles.map(|o| [nekton_tests::link(o.shape, 1.0, o.nodes)]);
    let held = Root::Prescribed([Signal::Constant(0.0); 3]);
    let moving = [0, 1].map(|i| Body {
        root: held,
        ..body(&wall_links[i], [obstacles[i].position[0], obstacles[i].position[1], 0.0], [0.0; 3])
    });
    let all: Vec<Body<'_, f64>> = bodies.into_iter().chain(moving).collect();
    one_against_other(Evaluation::new(&fixed), Evaluation::new(&scene(&all, Quadrature::Plain)))
}

fn lone_step() -> Measured {
    let link = [ellipse(64)];
    let bodies = [body(&link, [0.0; 3], [0.3, 0.1, 0.4])];
    let mut sim = simulation(&scene(&bodies, Quadrature::Graded), Method::Rk4 { step: 1e-6 });
    let mut sim = sim.view();
    let (times, _) = Turns::THREAD.run(&mut [&mut || sim.step().expect("a lone body can step")]);
    Measured::seconds(times[0], String::new())
}

/// Time of two rollouts at once on two threads, divided by that of the two one after the other; and in the note the same of
/// LAPACK's factorization, to tell what the machine's second thread is worth. The second thread stays awake between its turns, as
/// a controller's would: to wake a processor takes some virtual machines milliseconds.
fn rollouts(lapack: &Lapack) -> Measured {
    const IDLE: u8 = 0;
    const PEER: u8 = 1;
    const ROLLOUT: u8 = 2;
    const STOP: u8 = 3;
    let link = [ellipse(32)];
    let bodies = array(&link, 2, 2, 0.5);
    let model = std::sync::Arc::new(nekton::ModelBuf::new(&scene(&bodies, Quadrature::Plain)).expect("accepted"));
    let make = || nekton::SimBuf::new(model.clone(), Method::Rk4 { step: 1e-7 }).expect("accepted");
    let run = |sim: &mut nekton::SimBuf<f64>| {
        for _ in 0..50 {
            sim.view().step().expect("can step");
        }
    };
    let (order, ld) = (128, 136);
    let a = diagonal_dominant(order, ld);
    let peer = |copy: &mut Vec<f64>| {
        let mut pivots = vec![0; order];
        for _ in 0..200 {
            copy.copy_from_slice(&a);
            lapack.dgetrf(copy, ld, order, &mut pivots);
        }
    };
    let (mut p, mut q, mut r, mut s) = (a.clone(), a.clone(), a.clone(), a.clone());
    let (mut t, mut u, mut v, mut w) = (make(), make(), make(), make());
    let job = AtomicU8::new(IDLE);
    let beside = |other: u8, mine: &mut dyn FnMut()| {
        job.store(other, Ordering::Release);
        mine();
        while job.load(Ordering::Acquire) != IDLE {
            std::hint::spin_loop();
        }
    };
    let (times, ratios) = std::thread::scope(|scope| {
        scope.spawn(|| {
            loop {
                match job.load(Ordering::Acquire) {
                    PEER => peer(&mut r),
                    ROLLOUT => run(&mut v),
                    STOP => return,
                    _ => {
                        std::hint::spin_loop();
                        continue;
                    }
                }
                job.store(IDLE, Ordering::Release);
            }
        });
        let measured = Turns::WALL.run(&mut [
            &mut || {
                peer(&mut p);
                peer(&mut q);
            },
            &mut || beside(PEER, &mut || peer(&mut s)),
            &mut || {
                run(&mut t);
                run(&mut u);
            },
            &mut || beside(ROLLOUT, &mut || run(&mut w)),
        ]);
        job.store(STOP, Ordering::Release);
        measured
    });
    let note = format!("inverse of the gain; that of dgetrf(128): {:.3}", times[1] / times[0]);
    Measured { time: times[3], by: times[2], ratio: 1.0 / ratios[2], note }
}

/// Every row that this build of the program measures: those of the usual one, or those of `--cfg nekton_portable`.
pub fn rows() -> Vec<Row> {
    let mut all = Vec::new();
    let mut row = |name, size, (must, aim), held, run: Run| all.push(Row { name, size, must, aim, held, run });
    let of_four =
        |n: usize| move |lapack: &Lapack| Ok(against_getrf(lapack, ellipses(2, 2, 1.0, n / 4, Quadrature::Plain), n));
    if cfg!(nekton_portable) {
        for (n, held) in [(64, Held::Yes), (128, Held::Yes), (256, Held::Yes), (512, Held::Yes)] {
            row("build without SIMD dispatch / dgetrf(N)", n, (2.5, 2.0), held, Box::new(of_four(n)));
        }
        return all;
    }
    for (n, must, aim, held) in [
        (64, 1.1, 0.7, Held::No),
        (128, 0.88, 0.65, Held::No),
        (256, 0.84, 0.66, Held::Yes),
        (512, 0.85, 0.7, Held::Yes),
        (1024, 0.88, 0.76, Held::Yes),
    ] {
        row("evaluation of 4 bodies / dgetrf(N)", n, (must, aim), held, Box::new(of_four(n)));
    }
    for n in [64, 128, 256, 512, 1024] {
        let run = move |lapack: &Lapack| Ok(factorization(lapack, n));
        row("factorization alone / dgetrf(N)", n, (f64::INFINITY, f64::INFINITY), Held::No, Box::new(run));
    }
    row(
        "4 ellipses at gap 0.5 to 1e-12 / dgetrf(256)",
        256,
        (0.25, 0.15),
        Held::No,
        Box::new(|lapack| at_equal_accuracy(lapack, 2, 2, 0.5, 1e-12)),
    );
    row(
        "2 ellipses at gap 0.1 to 5e-12 / dgetrf(256)",
        256,
        (0.2, 0.12),
        Held::Yes,
        Box::new(|lapack| at_equal_accuracy(lapack, 2, 1, 0.1, 5e-12)),
    );
    let near = |_: &Lapack| {
        let of = |quadrature| ellipses(2, 1, 1e-3, 64, quadrature);
        Ok(one_against_other(of(Quadrature::Graded), of(Quadrature::Plain)))
    };
    row("near contact (gap 1e-3) / plain with the same nodes", 128, (4.0, 2.0), Held::Yes, Box::new(near));
    let crowd = |lapack: &Lapack| Ok(against_getrf(lapack, ellipses(5, 4, 1.0, 64, Quadrature::Plain), 1280));
    row("20 ellipses of 64 nodes / dgetrf(1280)", 1280, (1.0, 0.5), Held::Yes, Box::new(crowd));
    row("fixed walls with 3/4 of the nodes / moving walls", 256, (0.6, 0.45), Held::Yes, Box::new(|_| Ok(walls(64))));
    row("articulated body of 6 links / the links free", 224, (1.0, 0.8), Held::Yes, Box::new(|_| Ok(swimming(32))));
    for (columns, rows) in [(2, 1), (2, 2), (4, 2)] {
        let run = move |_: &Lapack| Ok(linearize::ellipses(columns, rows, 32));
        let name = "linearization with its evaluation / evaluation";
        row(name, 32 * columns * rows, (2.3, 2.0), Held::No, Box::new(run));
    }
    let name = "the same of a swimmer of 3 links, graded";
    row(name, 96, (2.0, 1.8), Held::No, Box::new(|_| Ok(linearize::fish())));
    row("lone rigid body: one step of rk4 (s)", 64, (1e-6, 3e-7), Held::No, Box::new(|_| Ok(lone_step())));
    let gain = (1.0 / 1.9, 0.5);
    row(
        "two rollouts on 2 threads / one after the other",
        128,
        gain,
        Held::No,
        Box::new(|lapack| Ok(rollouts(lapack))),
    );
    row("paper 9.2 to t = 10 within 1e-9 (s)", 10, (0.05, 0.02), Held::No, Box::new(|_| passing::whole()));
    row("the same: evaluations", 10, (700.0, 350.0), Held::Yes, Box::new(|_| passing::evaluations()));
    row(
        "the same / plain trapezoid with (2.15)",
        10,
        (0.1, 1.0 / 30.0),
        Held::Yes,
        Box::new(|_| passing::against_plain()),
    );
    row(
        "the same / the paper's algorithm in Octave",
        10,
        (0.01, 0.001),
        Held::No,
        Box::new(|_| passing::against_octave()),
    );
    for (name, kind, points, wanted) in [
        ("set-up of a section / dgetrf(nodes)", Kind::Section, 161, 1.0),
        ("set-up of a section / dgetrf(nodes)", Kind::Section, 401, 1.0),
        ("set-up of a smooth outline / dgetrf(nodes)", Kind::Blob, 5000, 3.0),
        ("set-up of a polygon / dgetrf(nodes)", Kind::Polygon, 50, 2.0),
        ("set-up of a gear / dgetrf(nodes)", Kind::Gear, 150, 2.0),
        ("set-up of a gear / dgetrf(nodes)", Kind::Gear, 500, 2.0),
        ("set-up of a star / dgetrf(nodes)", Kind::Star, 150, 2.0),
        ("set-up of a star / dgetrf(nodes)", Kind::Star, 500, 2.0),
    ] {
        let run = move |lapack: &Lapack| set_up(lapack, kind, points, wanted);
        row(name, points, (f64::INFINITY, f64::INFINITY), Held::No, Box::new(run));
    }
    all
}
