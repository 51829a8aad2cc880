//! `nekton evaluate`: matrices, forces and energies at the initial state.

use std::fmt::Write;
use std::path::Path;

use nekton::status::Result as CoreResult;
use serde_json::{Value, json};

use crate::ending::{Ending, say};
use crate::scene_file::{Integrator, Problem};
use crate::setup::Setup;
use crate::waiting::Waiting;
use nekton::Sim;

/// Prints everything, as a table or as one JSON object.
pub fn evaluate(path: &Path, as_json: bool) -> Result<Ending, Problem> {
    let setup = Setup::open(path)?;
    // The method does not matter: no step is made.
    let mut sim = setup.simulate(Integrator::Rk4 { step: 1.0 })?;
    let _told = Waiting::new("evaluating the start");
    let values = Values::new(&setup, &mut sim.view()).map_err(|e| setup.problem(&e))?;
    say(&if as_json { values.json(&setup).to_string() } else { values.table(&setup) });
    Ok(Ending::Complete)
}

/// Everything in the user's order of links; matrices as lists of rows.
struct Values {
    q: Vec<f64>,
    qd: Vec<f64>,
    matrices: Vec<(&'static str, Vec<Vec<f64>>)>,
    vectors: Vec<(&'static str, Vec<f64>)>,
    energy: Vec<(&'static str, f64)>,
    resolution: Vec<(&'static str, f64)>,
}

type Fill<'a> = &'a mut dyn FnMut(&mut [f64]) -> CoreResult<()>;

impl Values {
    fn new(setup: &Setup, sim: &mut Sim<'_, f64>) -> CoreResult<Self> {
        // For every coordinate in the user's order, the core's.
        let order: Vec<usize> = setup.links.iter().flat_map(|core| (0..3).map(move |c| 3 * core + c)).collect();
        let n = order.len();
        let sorted = |v: &[f64]| -> Vec<f64> { order.iter().filter_map(|k| v.get(*k).copied()).collect() };
        let vector = |fill: Fill<'_>| -> CoreResult<Vec<f64>> {
            let mut v = vec![0.0; n];
            fill(&mut v)?;
            Ok(sorted(&v))
        };
        let matrix = |fill: Fill<'_>| -> CoreResult<Vec<Vec<f64>>> {
            let mut m = vec![0.0; n * n];
            fill(&mut m)?;
            // Column-major: entry (i, j) is at i + n j.
            let row = |i: &usize| order.iter().filter_map(|j| m.get(i + n * j).copied()).collect();
            Ok(order.iter().map(row).collect())
        };
        let mass_matrix = matrix(&mut |m| sim.mass_matrix(m))?;
        let added_mass = matrix(&mut |m| sim.added_mass(m))?;
        let christoffel = vector(&mut |v| sim.christoffel(v))?;
        let buoyancy = vector(&mut |v| sim.buoyancy(v))?;
        let repulsion = vector(&mut |v| sim.repulsion(v))?;
        let circulation_gradient = vector(&mut |v| sim.circulation_gradient(v))?;
        let gyroscopic = matrix(&mut |m| sim.gyroscopic(m))?;
        let e = sim.energy()?;
        let r = sim.resolution()?;
        Ok(Values {
            q: sorted(sim.positions()),
            qd: sorted(sim.velocities()),
            matrices: vec![("mass_matrix", mass_matrix), ("added_mass", added_mass), ("gyroscopic", gyroscopic)],
            vectors: vec![
                ("christoffel", christoffel),
                ("buoyancy", buoyancy),
                ("repulsion", repulsion),
                ("circulation_gradient", circulation_gradient),
            ],
            energy: vec![
                ("kinetic_fluid", e.kinetic_fluid),
                ("kinetic_bodies", e.kinetic_bodies),
                ("buoyancy", e.buoyancy),
                ("repulsion", e.repulsion),
                ("circulation", e.circulation),
                ("total", e.total),
                ("work", e.work),
            ],
            resolution: vec![
                ("mass", r.mass),
                ("force", r.force),
                ("quadrature", r.quadrature),
                ("repulsion", r.repulsion),
                ("bound", r.bound()),
            ],
        })
    }

    fn notices(&self, setup: &Setup) -> Vec<String> {
        let bound = self.resolution.iter().find(|(name, _)| *name == "bound").map_or(0.0, |(_, bound)| *bound);
        setup.notices().into_iter().chain(setup.unresolved(bound)).collect()
    }

    fn json(&self, setup: &Setup) -> Value {
        let object = |pairs: &[(&'static str, f64)]| -> Value {
            Value::Object(pairs.iter().map(|(k, v)| ((*k).to_owned(), json!(v))).collect())
        };
        let view = setup.model.view();
        let p = view.plan();
        let mut out = json!({ "links": setup.scene.labels(), "q": self.q, "qd": self.qd });
        for (name, m) in &self.matrices {
            out[*name] = json!(m);
        }
        for (name, v) in &self.vectors {
            out[*name] = json!(v);
        }
        out["energy"] = object(&self.energy);
        out["resolution"] = object(&self.resolution);
        out["plan"] = json!({
            "formulation": p.formulation.to_string(),
            "links": p.links,
            "walls": p.walls,
            "unknowns": p.unknowns,
            "moving_unknowns": p.moving_unknowns,
            "right_hand_sides": p.right_hand_sides,
            "free_coordinates": p.free_coordinates,
            "prescribed_coordinates": p.prescribed_coordinates,
            "state_len": p.state_len,
            "fluid": p.fluid,
            "gravity": p.gravity,
            "repulsion": p.repulsion,
            "circulation": p.circulation,
            "model_bytes": p.model_bytes,
            "sim_bytes": p.sim_bytes,
            "operations": p.operations,
        });
        let outlines = setup.outlines().into_iter().map(|(whose, what)| (whose, json!(what)));
        out["outlines"] = Value::Object(outlines.collect());
        out["outline_errors"] = Value::Object(setup.outline_errors().map(|(whose, e)| (whose, json!(e))).collect());
        out["notices"] = json!(self.notices(setup));
        out
    }

    fn table(&self, setup: &Setup) -> String {
        let coordinates: Vec<String> =
            setup.scene.labels().iter().flat_map(|l| ["x", "y", "theta"].map(|c| format!("{l}.{c}"))).collect();
        let width = coordinates.iter().map(|c| c.chars().count()).max().unwrap_or(0);
        let mut text = String::new();
        // Writing to a string cannot fail.
        let head: String = ["q", "qd"].into_iter().chain(self.vectors.iter().map(|(n, _)| *n)).fold(
            String::new(),
            |mut line, name| {
                let _ = write!(line, " {name:>21}");
                line
            },
        );
        let _ = writeln!(text, "{:width$}{head}", "");
        for (k, name) in coordinates.iter().enumerate() {
            let _ = write!(text, "{name:width$}");
            let columns = [&self.q, &self.qd].into_iter().chain(self.vectors.iter().map(|(_, v)| v));
            for value in columns.filter_map(|v| v.get(k)) {
                let _ = write!(text, " {value:>21.12e}");
            }
            text.push('\n');
        }
        for (name, m) in &self.matrices {
            let _ = writeln!(text, "\n{name}");
            for (label, row) in coordinates.iter().zip(m) {
                let _ = write!(text, "{label:width$}");
                for value in row {
                    let _ = write!(text, " {value:>14.6e}");
                }
                text.push('\n');
            }
        }
        for (title, pairs) in [("energy (J/m)", &self.energy), ("resolution (relative error)", &self.resolution)] {
            let _ = writeln!(text, "\n{title}");
            for (name, value) in pairs {
                let _ = writeln!(text, "  {name:16} {value:>20.12e}");
            }
        }
        let _ = write!(text, "\nplan\n{}", setup.model.view().plan());
        for (whose, what) in setup.outlines() {
            let _ = write!(text, "\noutline of {whose}: {what}");
        }
        for notice in self.notices(setup) {
            let _ = write!(text, "\nnotice: {notice}");
        }
        text
    }
}
