//! `nekton plan --ingredients`: what each ingredient of a scene adds, by counts: the plan of the scene with it, and without.

use std::path::Path;

use nekton::scene::{Body, CirculationModel, Drive, Link, Scene, Wall};
use nekton::{Model, Plan, Status};

use crate::ending::{Ending, say};
use crate::scene_file::{Problem, SceneFile};

/// Something that a scene may contain.
struct Ingredient {
    name: &'static str,
    present: fn(&Scene<'_, f64>) -> bool,
    remove: fn(&mut Parts<'_>),
}

/// A scene that can be changed.
struct Parts<'a> {
    scene: Scene<'a, f64>,
    obstacles: Vec<Wall<'a, f64>>,
    bodies: Vec<(Body<'a, f64>, Vec<Link<'a, f64>>)>,
}

fn links<'s, 'a>(scene: &'s Scene<'a, f64>) -> impl Iterator<Item = &'s Link<'a, f64>> {
    scene.bodies.iter().flat_map(|b| b.links)
}

fn hold(parts: &mut Parts<'_>, which: fn(&Drive<'_, f64>) -> bool) {
    for joint in parts.bodies.iter_mut().flat_map(|(_, links)| links).filter_map(|l| l.joint.as_mut()) {
        if which(&joint.drive) {
            joint.drive = Drive::Locked(0.0);
        }
    }
}

fn is_motion(drive: &Drive<'_, f64>) -> bool {
    matches!(drive, Drive::Motion(_))
}

fn is_torque(drive: &Drive<'_, f64>) -> bool {
    matches!(drive, Drive::Torque { .. })
}

const INGREDIENTS: [Ingredient; 10] = [
    Ingredient { name: "gravity", present: |s| s.gravity != 0.0, remove: |p| p.scene.gravity = 0.0 },
    Ingredient { name: "repulsion", present: |s| s.repulsion.is_some(), remove: |p| p.scene.repulsion = None },
    Ingredient {
        name: "lift of circulation",
        present: |s| circulates(s) && s.circulation == CirculationModel::Full,
        remove: |p| p.scene.circulation = CirculationModel::Paper,
    },
    Ingredient {
        name: "circulation",
        present: circulates,
        remove: |p| {
            p.obstacles.iter_mut().for_each(|o| o.circulation = 0.0);
            p.bodies.iter_mut().flat_map(|(_, links)| links).for_each(|l| l.circulation = 0.0);
        },
    },
    Ingredient { name: "tank", present: |s| s.tank.is_some(), remove: |p| p.scene.tank = None },
    Ingredient { name: "obstacles", present: |s| !s.obstacles.is_empty(), remove: |p| p.obstacles.clear() },
    Ingredient {
        name: "prescribed joints",
        present: |s| links(s).any(|l| l.joint.is_some_and(|j| is_motion(&j.drive))),
        remove: |p| hold(p, is_motion),
    },
    Ingredient {
        name: "driven joints",
        present: |s| links(s).any(|l| l.joint.is_some_and(|j| is_torque(&j.drive))),
        remove: |p| hold(p, is_torque),
    },
    Ingredient { name: "other bodies", present: |s| s.bodies.len() > 1, remove: |p| p.bodies.truncate(1) },
    Ingredient { name: "fluid", present: |s| s.fluid_density != 0.0, remove: |p| p.scene.fluid_density = 0.0 },
];

fn circulates(scene: &Scene<'_, f64>) -> bool {
    let obstacle = scene.obstacles.iter().any(|o| o.circulation != 0.0);
    scene.fluid_density != 0.0 && (obstacle || links(scene).any(|l| l.circulation != 0.0))
}

/// The plan of a scene without an ingredient; `None` if nothing is left that could move.
fn plan_without(scene: &Scene<'_, f64>, ingredient: &Ingredient) -> Result<Option<Plan>, nekton::Error> {
    let mut parts = Parts {
        scene: *scene,
        obstacles: scene.obstacles.to_vec(),
        bodies: scene.bodies.iter().map(|b| (*b, b.links.to_vec())).collect(),
    };
    (ingredient.remove)(&mut parts);
    let bodies: Vec<Body<'_, f64>> = parts.bodies.iter().map(|(b, links)| Body { links, ..*b }).collect();
    match plan_of(&Scene { obstacles: &parts.obstacles, bodies: &bodies, ..parts.scene }) {
        Ok(plan) => Ok(Some(plan)),
        Err(e) if e.status == Status::Massless => Ok(None),
        Err(e) => Err(e),
    }
}

fn plan_of(scene: &Scene<'_, f64>) -> Result<Plan, nekton::Error> {
    Model::planned(scene)
}

fn difference(with: usize, without: usize) -> i128 {
    with as i128 - without as i128
}

/// What an ingredient adds: unknowns, right-hand sides, state, bytes of model and simulation; negative if it saves.
fn counts(with: &Plan, without: &Plan) -> [i128; 5] {
    [
        difference(with.unknowns, without.unknowns),
        difference(with.right_hand_sides, without.right_hand_sides),
        difference(with.state_len, without.state_len),
        difference(with.model_bytes, without.model_bytes),
        difference(with.sim_bytes, without.sim_bytes),
    ]
}

/// Prints the table.
pub fn print(path: &Path, csv: bool) -> Result<Ending, Problem> {
    let file = SceneFile::open(path)?;
    let name = path.file_stem().map_or("scene".into(), |s| s.to_string_lossy());
    file.with_core(|scene| {
        let wrong = |e| file.problem(&e);
        let whole = plan_of(scene).map_err(wrong)?;
        let nothing = Plan::default();
        let mut rows = vec![("whole scene", "yes", Some((counts(&whole, &nothing), whole.operations)))];
        for ingredient in &INGREDIENTS {
            let without = plan_without(scene, ingredient).map_err(wrong)?;
            let present = if (ingredient.present)(scene) { "yes" } else { "no" };
            let added = without.map(|w| (counts(&whole, &w), whole.operations - w.operations));
            rows.push((ingredient.name, present, added));
        }
        let general = plan_of(&Scene { shortcuts: false, ..*scene }).map_err(wrong)?;
        let present = if general.formulation == whole.formulation { "no" } else { "yes" };
        rows.push(("shortcut of symmetry", present, Some((counts(&whole, &general), whole.operations - general.operations))));
        if csv {
            say("scene,ingredient,present,unknowns,right_hand_sides,state,model_bytes,simulation_bytes,operations");
        } else {
            say("what each ingredient adds per evaluation (negative: saves)");
            say(&format!(
                "{:<22} {:>7} {:>9} {:>16} {:>6} {:>12} {:>16} {:>11}",
                "ingredient", "present", "unknowns", "right-hand sides", "state", "model bytes", "simulation bytes", "operations"
            ));
        }
        for (ingredient, present, added) in rows {
            // What nothing can move without has no price of its own.
            let ([unknowns, sides, state, model, sim], operations) = match added {
                Some((counts, operations)) => (counts.map(|c| c.to_string()), format!("{operations:.3e}")),
                None => (std::array::from_fn(|_| String::new()), String::new()),
            };
            say(&if csv {
                format!("{name},{ingredient},{present},{unknowns},{sides},{state},{model},{sim},{operations}")
            } else {
                format!(
                    "{ingredient:<22} {present:>7} {unknowns:>9} {sides:>16} {state:>6} {model:>12} {sim:>16} {operations:>11}"
                )
            });
        }
        Ok(Ending::Complete)
    })
}
