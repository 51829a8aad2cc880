//! C programs compiled with the system's compiler against nekton.h, nekton32.h and the static library.

use nekton::scene::{Body, Drive, Harmonic, Joint, JointKind, Link, Mass, Repulsion, Root, Scene, Shape, Signal, Wall};
use nekton::{Method, ModelBuf, Parameter, Place, Real, Sim, SimBuf};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().into()
}

/// The static library that cargo built next to this test.
fn library() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let library = test.parent().unwrap().join("libnekton_ffi.a");
    assert!(library.is_file(), "{} is not there", library.display());
    library
}

/// A program's text in single precision: other names, other type, other header.
fn single(source: &str) -> String {
    let mut text = source.replace("typedef double real;", "typedef float real;").replace("nekton.h\"", "nekton32.h\"");
    for name in [
        "scene_def",
        "wall_def",
        "body_def",
        "link_def",
        "shape",
        "signal",
        "harmonic",
        "method",
        "model",
        "sim",
        "link_info",
        "energy",
        "resolution",
        "time_error",
        "gap",
    ] {
        text = text.replace(&format!("nekton_{name}"), &format!("nekton32_{name}"));
    }
    for name in ["MODEL", "SIM"] {
        text = text.replace(&format!("NEKTON_{name}_BYTES"), &format!("NEKTON32_{name}_BYTES"));
    }
    text
}

const STRICT: [&str; 5] = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];

/// Compiles a program.
fn compile(name: &str, source: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (c, program) = (folder.join(format!("{name}.c")), folder.join(name));
    std::fs::write(&c, source).unwrap();
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c99", "-O1"]).args(STRICT).arg("-I").arg(root().join("include")).arg("-o").arg(&program);
    let status = compiler.arg(&c).arg(library()).args(["-lm", "-lpthread", "-ldl"]).status().expect("cc runs");
    assert!(status.success(), "{name}.c does not compile");
    program
}

/// Runs a program; what it prints.
fn output_of(program: &Path, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{} ends with {}:\n{text}", program.display(), output.status);
    text
}

/// Compiles and runs a program; what it prints.
fn run(name: &str, source: &str) -> String {
    output_of(&compile(name, source), &[])
}

fn source(name: &str) -> String {
    std::fs::read_to_string(root().join("ffi/tests/c").join(name)).unwrap()
}

/// Compiles a header alone, included twice.
fn accepts(header: &str, compiler: &str, standard: &str, suffix: &str) {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{header}{standard}.{suffix}"));
    let bytes = format!("{}_SIM_BYTES", header.trim_end_matches(".h").to_uppercase());
    let text = format!(
        "#include \"{header}\"\n#include \"{header}\"\nint main(void) {{ return (int){bytes}(1, 0, 8, 0, 0, 0, 0, 0, 1) == 0; }}\n"
    );
    std::fs::write(&file, text).unwrap();
    let mut command = Command::new(compiler);
    command.arg(standard).args(STRICT).arg("-I").arg(root().join("include"));
    let status = command.args(["-fsyntax-only"]).arg(&file).status().expect("a compiler");
    assert!(status.success(), "{header} by {compiler} {standard}");
}

#[test]
fn headers_are_clean_c99_c11_and_cpp17() {
    for header in ["nekton.h", "nekton32.h"] {
        accepts(header, "cc", "-std=c99", "c");
        accepts(header, "cc", "-std=c11", "c");
        accepts(header, "c++", "-std=c++17", "cpp");
    }
}

/// Reads "tried N model X sim Y".
fn ratios(text: &str) -> (f64, f64) {
    let words: Vec<&str> = text.split_whitespace().collect();
    (words[3].parse().unwrap(), words[5].parse().unwrap())
}

#[test]
fn size_macros_are_enough_and_not_much_more() {
    for (name, text) in [("sizes", source("sizes.c")), ("sizes32", single(&source("sizes.c")))] {
        let (model, sim) = ratios(&run(name, &text));
        assert!(model < 1.5 && sim < 1.5, "{name}: {model} {sim}");
    }
}

#[test]
fn programs_of_older_and_newer_headers_are_understood() {
    let source = source("older_and_newer.c");
    for (name, text) in [("older_and_newer", source.clone()), ("older_and_newer32", single(&source))] {
        let printed = run(name, &text);
        assert!(printed.lines().count() > 30 && !printed.contains("WRONG"), "{printed}");
    }
}

#[test]
fn what_one_process_saves_goes_on_in_another_bit_for_bit() {
    let source = source("saved.c");
    for (name, text) in [("saved", source.clone()), ("saved32", single(&source))] {
        let program = compile(name, &text);
        let file = program.with_extension("bin");
        let file = file.to_str().unwrap();
        let whole = output_of(&program, &[file, "whole"]);
        assert!(whole.lines().count() == 10, "{whole}");
        assert_eq!(output_of(&program, &[file, "save"]), "");
        assert_eq!(output_of(&program, &[file, "load"]), whole);
    }
}

/// Every function that the headers declare.
fn functions() -> Vec<String> {
    let headers =
        ["nekton.h", "nekton32.h"].map(|name| std::fs::read_to_string(root().join("include").join(name)).unwrap());
    let header = headers.concat();
    let declared = header.lines().filter(|l| !l.starts_with([' ', '#', '/', '}']) && l.contains('('));
    let name = |l: &str| {
        let before = l.split('(').next().unwrap_or("");
        before.rsplit([' ', '*']).next().unwrap_or("").to_string()
    };
    declared.map(name).filter(|n| n.starts_with("nekton")).collect()
}

/// The program's scene in Rust, driven the same way.
fn expected<R: Real>(mut check: impl FnMut(&str, &[R])) {
    let r = R::lit;
    let terms = [Harmonic { amplitude: r(0.4), frequency: r(2.0), phase: r(0.0), offset: r(0.0) }];
    let ellipse = |joint| Link {
        shape: Shape::Ellipse { a: r(0.5), b: r(0.125) },
        mass: Mass::Density(r(1.5)),
        nodes: 32,
        circulation: r(0.0),
        joint,
    };
    let hinge = |parent, drive| {
        Some(Joint {
            parent,
            kind: JointKind::Hinge,
            parent_anchor: [r(-0.625), r(0.0)],
            self_anchor: [r(0.625), r(0.0)],
            drive,
        })
    };
    let torque = Drive::Torque {
        torque: Signal::Channel,
        stiffness: r(0.0),
        damping: r(0.125),
        rest: r(0.0),
        start: [r(0.0); 2],
    };
    let links = [
        ellipse(None),
        ellipse(hinge(0, Drive::Motion(Signal::Harmonic { terms: &terms, window: None }))),
        ellipse(hinge(1, torque)),
    ];
    let bodies = [Body { pose: [r(0.0); 3], velocity: [r(0.0); 3], root: Root::Free, links: &links }];
    let tank = Wall {
        shape: Shape::Ellipse { a: r(6.0), b: r(6.0) },
        position: [r(0.0); 2],
        angle: r(0.0),
        nodes: 48,
        circulation: r(0.0),
    };
    let scene = Scene {
        repulsion: Some(Repulsion { alpha: r(4.0), epsilon: r(0.015625) }),
        tank: Some(tank),
        bodies: &bodies,
        tolerance: Some(r(0.015625)),
        ..Scene::new(r(1.0), r(0.5))
    };
    let model = Arc::new(ModelBuf::new(&scene).unwrap());
    check("outline_error", &[model.view().outline_error(Place::Link(0, 2)).unwrap_or(-R::one())]);
    check("outline_point", &model.view().outline_point(Place::Link(0, 2), r(1.0)).unwrap());
    let mut owner = SimBuf::new(model, Method::Abm4 { step: r(0.0078125) }).unwrap();
    let mut sim = owner.view();
    let (mut a, mut b) = (vec![r(0.0); 2], vec![r(0.0); 2]);
    for k in 0..8 {
        let t = r(f64::from(k) * 0.0625);
        sim.joint_values(&mut a, &mut b);
        let nu = r(0.25) - a[1];
        let end = t + r(0.0625);
        sim.set_channel(0, [t, nu, r(0.0), r(0.0)], [end, nu, r(0.0), r(0.0)]).unwrap();
        sim.advance(end).unwrap();
    }
    sim.step().unwrap();
    sim.advance_dense(r(0.53125), r(0.5625)).unwrap();
    check("time", &[sim.time()]);
    check("positions", sim.positions());
    check("velocities", sim.velocities());
    let y = sim.state().to_vec();
    check("state", &y);
    let mut ydot = y.clone();
    let t = sim.time();
    sim.rhs(t, &y, &mut ydot).unwrap();
    check("rhs", &ydot);
    sim.joint_torques(&mut a, &mut b).unwrap();
    check("torque", &a);
    check("power", &b);
    type Question<'q, R> = &'q mut dyn FnMut(&mut Sim<'_, R>, &mut [R]) -> nekton::Result<()>;
    let mut ask = |name: &str, n: usize, question: Question<'_, R>| {
        let mut out = vec![r(0.0); n];
        question(&mut sim, &mut out).unwrap();
        check(name, &out);
    };
    ask("accelerations", 9, &mut |s, o| s.accelerations(o));
    ask("christoffel", 9, &mut |s, o| s.christoffel(o));
    ask("buoyancy", 9, &mut |s, o| s.buoyancy(o));
    ask("repulsion", 9, &mut |s, o| s.repulsion(o));
    ask("circulation_gradient", 9, &mut |s, o| s.circulation_gradient(o));
    ask("mass_matrix", 81, &mut |s, o| s.mass_matrix(o));
    ask("added_mass", 81, &mut |s, o| s.added_mass(o));
    ask("gyroscopic", 81, &mut |s, o| s.gyroscopic(o));
    ask("christoffel_tensor", 729, &mut |s, o| s.christoffel_tensor(o));
    let parameters = [Parameter::FluidDensity, Parameter::Wrench(1, 2), Parameter::Torque(1)];
    let rows = sim.state().len();
    let mut mem = vec![r(0.0); Sim::derivative_requirement(&sim.model()).unwrap()];
    let (mut a, mut b) = (vec![r(0.0); rows * rows], vec![r(0.0); rows * 3]);
    let linearization = sim.linearize(parameters, &mut a, &mut b, &mut mem).unwrap();
    check("linearize_a", &a);
    check("linearize_b", &b);
    check("linearize_bound", &[linearization.bound]);
    let (mut qdd, mut position, mut velocity) = (vec![r(0.0); 9], vec![r(0.0); 81], vec![r(0.0); 81]);
    sim.accelerations(&mut qdd).unwrap();
    sim.force_derivatives(&qdd, &mut position, &mut velocity, &mut mem).unwrap();
    check("by_position", &position);
    check("by_velocity", &velocity);
    let energy = sim.energy().unwrap();
    check("total", &[energy.total]);
    check("work", &[energy.work]);
    check("impulse", &sim.impulse().unwrap());
    let drift = sim.energy_drift().unwrap();
    check("energy_drift", &[drift.amount, drift.kinetic, drift.allowed]);
    check("resolution", &[sim.resolution().unwrap().mass]);
    check("indicators", &[sim.indicators().unwrap().bound()]);
    let e = sim.time_error();
    check("time_error", &[e.length_sum, e.angle_sum, e.speed_sum, e.spin_sum]);
    check("unknown", &[R::count(e.unknown as usize)]);
    check("gap", &[sim.gap().distance]);
    check("steps", &[R::count(sim.counters().steps as usize)]);
}

fn compare<R: Real>(text: &str) {
    let mut lines: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let name = words.next().unwrap();
        lines.insert(name, words.map(|w| w.parse().unwrap()).collect());
    }
    let mut seen = 0;
    expected::<R>(|name, values| {
        let values: Vec<f64> = values.iter().map(|x| x.to_f64()).collect();
        assert_eq!(lines.get(name), Some(&values), "{name}");
        seen += 1;
    });
    assert_eq!(seen, lines.len());
}

#[test]
fn every_function_works_from_c_and_gives_the_bits_of_rust() {
    let double = source("every_function.c");
    let float = single(&double);
    let all = functions();
    assert!(all.len() > 80, "{all:?}");
    for name in &all {
        assert!(double.contains(&format!("{name}(")) || float.contains(&format!("{name}(")), "{name} is not called");
    }
    compare::<f64>(&run("every_function", &double));
    compare::<f32>(&run("every_function32", &float));
}
