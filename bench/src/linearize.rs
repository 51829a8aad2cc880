//! What the linearization of a motion costs beside its evaluation.

use crate::scenes::{Evaluation, array, ellipse, scene, swimmer};
use crate::timing::{Measured, Turns};
use nekton::scene::{Harmonic, Quadrature, Scene};
use nekton::{Sim, SimBuf};
use nekton_tests::{at_start, body};

/// A linearization to be done again and again at one state.
pub(crate) struct Linearization {
    sim: SimBuf<f64>,
    matrix: Vec<f64>,
    memory: Vec<f64>,
}

impl Linearization {
    pub(crate) fn new(scene: &Scene<'_, f64>) -> Self {
        let mut sim = at_start(scene);
        let (rows, need) = {
            let view = sim.view();
            (view.state().len(), Sim::derivative_requirement(&view.model()).expect("fits"))
        };
        Linearization { sim, matrix: vec![0.0; rows * rows], memory: vec![0.0; need] }
    }

    /// All of A, of an evaluation that is there.
    pub(crate) fn run(&mut self) {
        let done = self.sim.view().linearize([], &mut self.matrix, &mut [], &mut self.memory);
        done.expect("the scene can be linearized");
        std::hint::black_box(&self.matrix);
    }
}

/// A linearization, its own evaluation included, over an evaluation; in the note one-sided differences over an evaluation.
fn measured(scene: &Scene<'_, f64>) -> Measured {
    let (mut whole, mut one) = (Linearization::new(scene), Evaluation::new(scene));
    let columns = whole.sim.view().state().len();
    let (times, ratios) = Turns::THREAD.run(&mut [&mut || whole.run(), &mut || one.run()]);
    let note = format!("one-sided differences: {}", columns + 1);
    Measured { time: times[0] + times[1], by: times[1], ratio: ratios[0] + 1.0, note }
}

/// Free ellipses by the plain rule.
pub(crate) fn ellipses(columns: usize, rows: usize, nodes: usize) -> Measured {
    let link = [ellipse(nodes)];
    let bodies = array(&link, columns, rows, 0.5);
    measured(&Scene { allow_unresolved: true, ..scene(&bodies, Quadrature::Plain) })
}

/// A swimmer of three links on graded nodes.
pub(crate) fn fish() -> Measured {
    let beat = [Harmonic { offset: 0.1, amplitude: 0.4, frequency: 2.0, phase: 0.3 }];
    let links = swimmer(3, 32, &beat);
    let bodies = [body(&links, [0.0; 3], [0.1, 0.0, 0.1])];
    measured(&Scene { allow_unresolved: true, ..scene(&bodies, Quadrature::Graded) })
}
