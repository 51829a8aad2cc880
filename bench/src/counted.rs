//! Scenes whose instructions are counted.

use crate::linearize::Linearization;
use crate::rows::ellipses;
use crate::scenes::{Evaluation, array, ellipse, scene, swimmer};
use nekton::Method;
use nekton::scene::{Harmonic, Quadrature};
use nekton_tests::{body, simulation};

/// Makes a call that is repeated.
type Make = fn() -> Box<dyn FnMut()>;

/// Name, calls of the longer of two runs, what is called.
pub const COUNTED: [(&str, usize, Make); 8] = [
    ("4 bodies of 16 nodes", 40, || evaluation(ellipses(2, 2, 1.0, 16, Quadrature::Plain))),
    ("4 bodies of 32 nodes", 20, || evaluation(ellipses(2, 2, 1.0, 32, Quadrature::Plain))),
    ("4 bodies of 64 nodes", 4, || evaluation(ellipses(2, 2, 1.0, 64, Quadrature::Plain))),
    ("graded: 2 bodies of 32 nodes at gap 1e-1", 10, || evaluation(ellipses(2, 1, 1e-1, 32, Quadrature::Graded))),
    ("graded: 2 bodies of 32 nodes at gap 1e-3", 10, || evaluation(ellipses(2, 1, 1e-3, 32, Quadrature::Graded))),
    ("swimmer of 6 links of 16 nodes", 10, articulated),
    ("lone body: step of rk4", 1000, lone),
    ("linearization: 4 bodies of 32 nodes, evaluated before", 10, linearization),
];

/// Of these the loops without the machine's own instructions are counted as well (`--cfg nekton_portable`).
pub const PORTABLE: &str = "4 bodies of 32 nodes";

fn evaluation(mut of: Evaluation<f64>) -> Box<dyn FnMut()> {
    Box::new(move || of.run())
}

fn articulated() -> Box<dyn FnMut()> {
    let beat = [Harmonic { amplitude: 0.3, frequency: 2.0, phase: 0.3, offset: 0.1 }];
    let links = swimmer(6, 16, &beat);
    let bodies = [body(&links, [0.0; 3], [0.1, 0.0, 0.1])];
    evaluation(Evaluation::new(&scene(&bodies, Quadrature::Plain)))
}

fn linearization() -> Box<dyn FnMut()> {
    let link = [ellipse(32)];
    let bodies = array(&link, 2, 2, 1.0);
    let mut of = Linearization::new(&scene(&bodies, Quadrature::Plain));
    // The evaluation is that of the first call, which is counted with setting up.
    of.run();
    Box::new(move || of.run())
}

fn lone() -> Box<dyn FnMut()> {
    let link = [ellipse(64)];
    let bodies = [body(&link, [0.0; 3], [0.3, 0.1, 0.4])];
    let mut sim = simulation(&scene(&bodies, Quadrature::Graded), Method::Rk4 { step: 1e-6 });
    Box::new(move || sim.view().step().expect("a lone body can step"))
}
