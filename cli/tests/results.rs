//! What the command writes: tables, plots, report, JSON.

mod common;
use common::{GOOD, Place, changed, names, nekton};
use std::path::Path;

fn finished() -> Place {
    let place = Place::new(GOOD);
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert_eq!(done.err, "");
    place
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect()
}

#[test]
fn run_writes_exactly_these_files() {
    let place = finished();
    assert_eq!(place.names(), ["results", "scene.toml"]);
    let expected = [
        "energy.csv",
        "energy.svg",
        "momentum.svg",
        "report.html",
        "resolution.csv",
        "resolution.svg",
        "torque.csv",
        "torque.svg",
        "trajectories.svg",
        "trajectory.csv",
    ];
    assert_eq!(names(&place.path("results")), expected);
}

#[test]
fn tables_have_the_documented_headers_and_17_digits() {
    let place = finished();
    let trajectory = place.read("results/trajectory.csv");
    let columns = ["x", "y", "theta", "vx", "vy", "omega"];
    let links = ["fish.head", "fish.tail", "stone.stone"];
    let names: Vec<String> = links.iter().flat_map(|l| columns.map(|c| format!("{l}.{c}"))).collect();
    assert_eq!(trajectory.lines().next().unwrap(), format!("t,{}", names.join(",")));
    let energy = place.read("results/energy.csv");
    let header = "t,kinetic_fluid,kinetic_bodies,buoyancy,repulsion,circulation,total,work";
    assert_eq!(energy.lines().next().unwrap(), header);
    let torque = place.read("results/torque.csv");
    assert_eq!(torque.lines().next().unwrap(), "t,fish.tail.torque,fish.tail.power");
    let resolution = place.read("results/resolution.csv");
    assert_eq!(
        resolution.lines().next().unwrap(),
        "t,mass,force,quadrature,repulsion,bound,time_length,time_angle,time_speed,time_spin"
    );
    for table in [&trajectory, &energy, &torque, &resolution] {
        let times: Vec<f64> = rows(table).iter().map(|r| r[0]).collect();
        assert_eq!(times.len(), 6);
        assert!(times.iter().enumerate().all(|(k, t)| (t - 0.1 * k as f64).abs() < 1e-15), "{times:?}");
        assert_eq!(times[5], 0.5);
        // Before the first step no error of time integration is known.
        for cell in table.lines().skip(1).flat_map(|l| l.split(',')).filter(|c| *c != "NaN") {
            let digits = cell.split('e').next().unwrap().chars().filter(char::is_ascii_digit).count();
            assert_eq!(digits, 17, "{cell}");
        }
    }
}

#[test]
fn an_interval_that_does_not_divide_the_duration_ends_at_the_duration() {
    let place = Place::new(&changed("output_interval = 0.1", "output_interval = 0.2"));
    assert_eq!(place.run().code, Some(0));
    let times: Vec<f64> = rows(&place.read("results/energy.csv")).iter().map(|r| r[0]).collect();
    assert_eq!(times, [0.0, 0.2, 0.4, 0.5]);
}

#[test]
fn energy_changes_by_the_work_of_the_joints() {
    let place = finished();
    let rows = rows(&place.read("results/energy.csv"));
    let balance: Vec<f64> = rows.iter().map(|r| r[6] - r[7]).collect();
    let scale = rows.iter().map(|r| r[6].abs()).fold(0.0, f64::max);
    assert!(balance.iter().all(|b| (b - balance[0]).abs() < 1e-4 * scale), "{balance:?}");
    assert!(rows.iter().all(|r| (r[6] - r[1..6].iter().sum::<f64>()).abs() <= 1e-13 * scale));
}

#[test]
fn links_may_be_listed_in_any_order() {
    let (before, rest) = GOOD.split_once("[[body.link]]\nname = \"head\"").unwrap();
    let (head, rest) = rest.split_once("[[body.link]]\n").unwrap();
    let (tail, rest) = rest.split_once("[[body]]").unwrap();
    let place = Place::new(&format!("{before}[[body.link]]\n{tail}[[body.link]]\nname = \"head\"{head}[[body]]{rest}"));
    assert_eq!(place.run().code, Some(0));
    let swapped = place.read("results/trajectory.csv");
    assert!(swapped.starts_with("t,fish.tail.x,"));
    let usual = rows(&finished().read("results/trajectory.csv"));
    for (a, b) in rows(&swapped).iter().zip(&usual) {
        assert_eq!(a[1..7], b[7..13]);
        assert_eq!(a[7..13], b[1..7]);
        assert_eq!(a[13..], b[13..]);
    }
}

#[test]
fn report_is_self_contained() {
    let place = finished();
    let report = place.read("results/report.html");
    // The only address is the name of the SVG name space.
    let stripped = report.replace("http://www.w3.org/2000/svg", "");
    for word in ["http:", "https:", "src=", "href=", "@import", "url(", "{{", "}}"] {
        assert!(!stripped.contains(word), "{word}");
    }
    assert_eq!(report.matches("<svg").count(), 5);
    for part in ["<canvas", "fish.tail", "boundary unknowns", "evaluations", "Plan", "Settings"] {
        assert!(report.contains(part), "{part}");
    }
}

#[test]
fn markup_in_names_stays_text() {
    let scene = changed("\"stone\"\nposition", "\"</script><b>&\"\nposition");
    let place = Place::new(&scene);
    assert_eq!(place.run().code, Some(0));
    let report = place.read("results/report.html");
    assert!(!report.contains("<b>"));
    assert_eq!(report.matches("</script>").count(), 1);
}

#[test]
fn plots_name_axes_units_and_lines() {
    let place = finished();
    let has = |file: &str, words: &[&str]| {
        let svg = place.read(&format!("results/{file}"));
        assert!(svg.starts_with("<svg"));
        for word in words {
            assert!(svg.contains(word), "{file}: {word}");
        }
    };
    has("trajectories.svg", &["x (m)", "y (m)", "fish.head", "fish.tail", "stone.stone"]);
    has("energy.svg", &["time (s)", "J/m", "total", "work of the joints"]);
    has("momentum.svg", &["time (s)", "along x", "angular"]);
    has("resolution.svg", &["time (s)", "relative error (log₁₀)", "bound"]);
    has("torque.svg", &["time (s)", "torque", "fish.tail"]);
}

#[test]
fn a_second_run_replaces_the_first_and_leaves_other_files_alone() {
    let place = finished();
    place.put("results/notes.txt", "mine");
    let without_joint = GOOD
        .replace("parent = \"head\"\n", "")
        .replace("[[body.link]]\nname = \"tail\"", "[[body]]\nname = \"tail\"\nposition = [9, 9]\n[[body.link]]");
    let drop = |line: &&str| !line.starts_with("hinge") && !line.starts_with("motion");
    place.put("scene.toml", without_joint.lines().filter(drop).collect::<Vec<_>>().join("\n"));
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    let left = names(&place.path("results"));
    assert!(!left.contains(&"torque.svg".to_owned()) && left.contains(&"notes.txt".to_owned()), "{left:?}");
    assert_eq!(place.read("results/torque.csv").lines().next().unwrap(), "t");
    assert!(left.iter().all(|n| !n.starts_with('.')), "{left:?}");
}

#[test]
fn folders_on_the_way_are_made() {
    let place = Place::new(GOOD);
    assert_eq!(place.nekton(&["run", "scene.toml", "--out", "a/b/c"]).code, Some(0));
    assert!(place.path("a/b/c/report.html").is_file());
    assert_eq!(names(&place.path("a/b")), ["c"]);
}

#[test]
fn tables_and_outlines_are_read_relative_to_the_scene() {
    let scene = changed("{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }", "{ table = \"stroke.csv\" }");
    let place = Place::new(&scene.replace("{ ellipse = [0.8, 0.3] }", "{ curve = \"outline.csv\" }"));
    let times = || (0..=20).map(|k| 0.05 * f64::from(k));
    let rows: String = times().map(|t| format!("{t},{}\n", 0.3 * (2.0 * t).sin())).collect();
    place.put("stroke.csv", format!("t,u\n{rows}"));
    let angle = |k: i32| std::f64::consts::TAU * f64::from(k) / 24.0;
    let points: String = (0..24).map(|k| format!("{},{}\n", 0.8 * angle(k).cos(), 0.3 * angle(k).sin())).collect();
    place.put("outline.csv", format!("x,y\n{points}"));
    let elsewhere = tempfile::tempdir().unwrap();
    let scene = place.path("scene.toml");
    let out = place.path("results");
    let done = nekton(elsewhere.path(), &["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let table = self::rows(&place.read("results/trajectory.csv"));
    for row in table {
        let (head, tail) = (row[3], row[9]);
        assert!((tail - head - 0.3 * (2.0 * row[0]).sin()).abs() < 1e-5);
    }
}

#[test]
fn a_run_that_ends_in_contact_keeps_its_results_and_says_why() {
    let scene = changed("amplitude = 0.3", "amplitude = 2.8").replace("duration = 0.5", "duration = 2.0");
    // Too few nodes would end it a little earlier, for another reason.
    let few = Place::new(&scene).run();
    assert_eq!(few.code, Some(3), "{}", few.err);
    assert!(
        few.err.contains("link `fish.head` and link `fish.tail`: the error in space may be as large"),
        "{}",
        few.err
    );
    let place = Place::new(&scene.replace("nodes = 32\n", ""));
    let done = place.run();
    assert_eq!(done.code, Some(3), "{}", done.err);
    assert!(done.err.starts_with("stopped at t = ") && done.err.contains("contact"), "{}", done.err);
    assert_eq!(done.err.lines().count(), 1);
    let rows = rows(&place.read("results/trajectory.csv"));
    let last = rows.last().unwrap()[0];
    assert!(rows.len() > 3 && last < 2.0, "{last}");
    assert!(rows.iter().flatten().all(|x| x.is_finite()));
    let report = place.read("results/report.html");
    assert!(report.contains("The run stopped early: t = ") && !report.contains("reached its end"));
}

/// Trajectory of GOOD with one passage replaced.
fn trajectory(from: &str, to: &str) -> Vec<Vec<f64>> {
    let place = Place::new(&changed(from, to));
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    rows(&place.read("results/trajectory.csv"))
}

const STROKE: &str = "{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }";
const HINGE: &str = "hinge = { parent = [-1.2, 0.0], self = [1.0, 0.0] }";

#[test]
fn a_prescribed_root_follows_its_signals() {
    let root = "root = { x = { harmonic = [{ amplitude = 0.1, frequency = 3.0 }] }, theta = 0.2 }";
    for r in trajectory("velocity = [0.1, 0.0]", root) {
        assert!((r[1] - 0.1 * (3.0 * r[0]).sin()).abs() < 1e-14);
        assert!(r[2] == 0.0 && (r[3] - 0.2).abs() < 1e-15);
        assert!((r[4] - 0.3 * (3.0 * r[0]).cos()).abs() < 1e-14);
    }
}

#[test]
fn a_slider_moves_along_its_axis() {
    let slider = "slider = { parent = [-1.2, 0.0], self = [1.0, 0.0], axis = [-2.0, 0.0], angle = 0.3 }";
    for r in trajectory(HINGE, slider) {
        let u = 0.3 * (2.0 * r[0]).sin();
        let (s, c) = r[3].sin_cos();
        let (st, ct) = r[9].sin_cos();
        assert!((r[9] - r[3] - 0.3).abs() < 1e-14);
        assert!((r[7] + ct - (r[1] - (1.2 + u) * c)).abs() < 1e-13);
        assert!((r[8] + st - (r[2] - (1.2 + u) * s)).abs() < 1e-13);
    }
}

#[test]
fn a_locked_joint_stays_where_it_is() {
    for r in trajectory(STROKE, "{ locked = 0.25 }") {
        assert!((r[9] - r[3] - 0.25).abs() < 1e-14);
    }
}

#[test]
fn a_torque_driven_joint_starts_where_told() {
    let rows = trajectory(STROKE, "{ torque = 0.01, stiffness = 0.1, damping = 0.1, rest = 0.1, start = [0.2, -0.1] }");
    assert!((rows[0][9] - rows[0][3] - 0.2).abs() < 1e-15);
    assert!((rows[0][12] - rows[0][6] + 0.1).abs() < 1e-15);
    assert!((rows[5][9] - rows[5][3] - 0.2).abs() > 1e-3);
}

#[test]
fn integrators_agree() {
    let adams = "{ method = \"adams\", tolerance = 1e-6 }";
    let usual = trajectory(adams, "{ method = \"adams\", tolerance = 1e-10 }");
    for other in ["rk4", "abm4", "gauss6"] {
        let rows = trajectory(adams, &format!("{{ method = \"{other}\", step = 0.01 }}"));
        for (a, b) in rows.iter().flatten().zip(usual.iter().flatten()) {
            assert!((a - b).abs() < 1e-6, "{other}: {a} {b}");
        }
    }
}

#[test]
fn repeated_runs_write_the_same_bytes() {
    let (a, b) = (finished(), finished());
    for name in names(&a.path("results")) {
        assert!(a.read(&format!("results/{name}")) == b.read(&format!("results/{name}")), "{name}");
    }
}

/// Reference positions of this scene, converged to the digits given.
#[test]
fn two_ellipses_arrive_where_they_should() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let place = Place::new("");
    let out = place.path("results");
    let done = nekton(&folder, &["run", "two_ellipses.toml", "--out", out.to_str().unwrap()]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let rows = rows(&place.read("results/trajectory.csv"));
    for (t, expected) in [
        (4.0, [-0.0631558367301, -1.1605272570319, 0.1087586354437]),
        (8.0, [-1.95119755853, -1.19464491956, 0.69460723836]),
        (16.0, [-4.4566299139, -0.0703918602, 2.6164405953]),
    ] {
        let row = rows.iter().find(|r| (r[0] - t).abs() < 1e-9).unwrap();
        for (a, b) in row[1..4].iter().zip(expected) {
            assert!((a - b).abs() < 1e-9, "t = {t}: {a} instead of {b}");
        }
    }
}

#[test]
fn evaluate_prints_every_documented_key() {
    let place = Place::new(GOOD);
    let done = place.nekton(&["evaluate", "scene.toml", "--json"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let value: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    for key in ["q", "qd", "christoffel", "buoyancy", "repulsion", "circulation_gradient"] {
        let list = value[key].as_array().unwrap_or_else(|| panic!("{key}"));
        assert_eq!(list.len(), 9, "{key}");
        assert!(list.iter().all(serde_json::Value::is_f64), "{key}");
    }
    let matrix = |key: &str| -> Vec<Vec<f64>> {
        let rows = value[key].as_array().unwrap_or_else(|| panic!("{key}"));
        let rows: Vec<Vec<f64>> =
            rows.iter().map(|r| r.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()).collect();
        assert!(rows.len() == 9 && rows.iter().all(|r| r.len() == 9), "{key}");
        rows
    };
    let (mass, added) = (matrix("mass_matrix"), matrix("added_mass"));
    matrix("gyroscopic");
    for i in 0..9 {
        for j in 0..9 {
            assert!((mass[i][j] - mass[j][i]).abs() < 1e-12 * mass[i][i].max(mass[j][j]));
            if i != j {
                assert!((mass[i][j] - added[i][j]).abs() < 1e-14 * mass[i][i].max(mass[j][j]));
            }
        }
    }
    for key in ["kinetic_fluid", "kinetic_bodies", "buoyancy", "repulsion", "circulation", "total", "work"] {
        assert!(value["energy"][key].is_f64(), "{key}");
    }
    assert!(value["resolution"]["mass"].is_f64() && value["resolution"]["force"].is_f64());
    assert_eq!(value["plan"]["links"], 3);
    assert_eq!(value["links"], serde_json::json!(["fish.head", "fish.tail", "stone.stone"]));
    let table = place.nekton(&["evaluate", "scene.toml"]);
    assert_eq!(table.code, Some(0));
    assert!(table.out.contains("mass_matrix") && table.out.contains("fish.tail.theta"));
}

#[test]
fn help_names_the_exit_codes() {
    let done = nekton(Path::new("."), &["run", "--help"]);
    assert_eq!(done.code, Some(0));
    assert!(done.out.contains("Exit codes") && done.out.contains("stopped before its end"));
}

#[test]
fn every_scene_says_where_it_comes_from_and_compiles() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let scenes: Vec<String> = names(&folder).into_iter().filter(|n| n.ends_with(".toml")).collect();
    assert_eq!(scenes.len(), 14, "{scenes:?}");
    for name in &scenes {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.starts_with("# ") && text.contains("# From: ") && text.contains("# Look at: "), "{name}");
        let done = nekton(&folder, &["plan", name]);
        assert_eq!(done.code, Some(0), "{name}: {}", done.err);
    }
}

#[test]
fn a_tolerance_in_space_that_is_missed_is_one_notice_on_the_terminal_and_in_the_report() {
    let scene = changed("nodes = 32", "nodes = 16").replace("duration = 0.5", "duration = 0.5\ntolerance = 1e-10");
    let place = Place::new(&scene);
    let done = place.run();
    assert_eq!(done.code, Some(0), "a notice is no error: {}", done.err);
    let notices: Vec<&str> = done.out.lines().filter(|l| l.contains("notice")).collect();
    assert_eq!(notices.len(), 1, "one episode: {}", done.out);
    for part in
        ["t = 0.000000 to 0.500000 s", "the error in space may exceed the tolerance asked for", "asked 1.0e-10", "gap"]
    {
        assert!(notices[0].contains(part), "{part}: {}", notices[0]);
    }
    let (_, text) = notices[0].split_once("notice: ").unwrap();
    assert!(place.read("results/report.html").replace("&quot;", "\"").contains(text));
    assert!(place.read("results/resolution.svg").contains("asked"));
    let met = Place::new(&changed("duration = 0.5", "duration = 0.5\ntolerance = 50"));
    assert!(!met.run().out.contains("notice"));
}

#[test]
fn steps_too_long_for_the_motion_are_one_notice() {
    // A disc that circles once a second.
    let scene = |step: f64| {
        format!(
            "[fluid]\ndensity = 1.0\n[[body]]\nname = \"disc\"\nvelocity = [1.0, 0.0]\n[[body.link]]\nname = \"disc\"\n\
             shape = {{ ellipse = [1.0, 1.0] }}\ndensity = 1.0\ncirculation = 39.5\n[run]\nduration = 8.0\n\
             output_interval = {step}\nintegrator = {{ method = \"rk4\", step = {step} }}\n"
        )
    };
    let done = Place::new(&scene(0.5)).run();
    assert_eq!(done.code, Some(0), "a notice is no error: {}", done.err);
    let told =
        |text: &str| -> Vec<&str> { done.out.lines().filter(|l| l.contains("notice") && l.contains(text)).collect() };
    let notices = told("the step is too long for the motion");
    assert!(notices.len() == 1 && notices[0].contains("to 8.000000 s: "), "one episode: {}", done.out);
    // Such steps lose energy, which is told too.
    assert_eq!(told("energy and the work of the drives do not balance").len(), 1, "{}", done.out);
    assert!(!Place::new(&scene(0.025)).run().out.contains("notice"));
}

#[test]
fn steps_that_miss_a_drive_are_told_with_the_joint_and_the_step_that_would_have_seen_it() {
    let stroke = "{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }";
    let pulse = "{ torque = { harmonic = [{ offset = 3.0 }], window = { from = 0.21, to = 0.29, ramp = 0.04 } } }";
    let scene = |step: f64| {
        let fixed = format!("{{ method = \"rk4\", step = {step} }}");
        changed(stroke, pulse).replace("{ method = \"adams\", tolerance = 1e-6 }", &fixed)
    };
    let done = Place::new(&scene(0.1)).run();
    assert_eq!(done.code, Some(0), "a notice is no error: {}", done.err);
    let told: Vec<&str> = done.out.lines().filter(|l| l.contains("for what a drive does within it")).collect();
    assert!(
        told.len() == 1 && told[0].contains("link `fish.tail`") && told[0].contains("(it takes steps of "),
        "{}",
        done.out
    );
    assert!(!Place::new(&scene(0.002)).run().out.contains("notice"));
}

#[test]
fn energy_that_no_work_explains_is_one_notice_on_the_terminal_and_in_the_report() {
    // A disc that circles once a second, by steps that lose energy, though no single one is a tenth of a body off.
    let scene = |step: f64| {
        format!(
            "[fluid]\ndensity = 1.0\n[[body]]\nname = \"disc\"\nvelocity = [1.0, 0.0]\n[[body.link]]\nname = \"disc\"\n\
             shape = {{ ellipse = [1.0, 1.0] }}\ndensity = 1.0\ncirculation = 39.5\n[run]\nduration = 40.0\n\
             output_interval = {step}\nintegrator = {{ method = \"rk4\", step = {step} }}\n"
        )
    };
    let place = Place::new(&scene(0.1));
    let done = place.run();
    assert_eq!(done.code, Some(0), "a notice is no error: {}", done.err);
    let notices: Vec<&str> = done.out.lines().filter(|l| l.contains("notice")).collect();
    assert_eq!(notices.len(), 1, "{}", done.out);
    // Runge's method of order 4 multiplies the energy of a turn by an angle x in each step by 1 − x⁶/72; the turn here is
    // that of 39.5 kg/(m s) and 2 π kg/m.
    let x = 0.1 * 39.5 / std::f64::consts::TAU;
    let first = 0.5 * std::f64::consts::TAU;
    let lost = first * (1.0 - (1.0 - x.powi(6) / 72.0).powi(400));
    let told: f64 = notices[0].split("(drift = -").nth(1).unwrap().split(')').next().unwrap().parse().unwrap();
    assert!((told / lost - 1.0).abs() < 0.1, "{told} {lost}");
    assert!(notices[0].contains(" to 40.000000 s: ") && notices[0].contains("worst at t = 40.0"), "{}", notices[0]);
    assert!(place.read("results/report.html").contains("energy and the work of the drives do not balance"));
    assert!(!Place::new(&scene(0.01)).run().out.contains("notice"));
}

#[test]
fn a_bound_above_a_thousandth_is_noticed_everywhere_and_above_one_refused_with_what_would_do() {
    let bare = |nodes: &str, run: &str| {
        format!(
            "[fluid]\ndensity = 1.0\n[[body]]\n[[body.link]]\nshape = {{ ellipse = [1.0, 0.2] }}\ndensity = 1.0\n{nodes}\n\
             [[body]]\nposition = [0.0, 0.6]\nvelocity = [1.0, 0.0]\n[[body.link]]\nshape = {{ ellipse = [1.0, 0.2] }}\ndensity = 1.0\n{nodes}\n\
             [run]\nduration = 0.1\nquadrature = \"plain\"\n{run}\n"
        )
    };
    let say = |place: &Place, command: &[&str]| {
        let done = place.nekton(command);
        assert_eq!(done.code, Some(0), "{command:?} {}", done.err);
        done.out
    };
    let commands = [&["evaluate", "scene.toml"][..], &["evaluate", "--json", "scene.toml"]];
    for (nodes, noticed) in [("nodes = 64", true), ("", false)] {
        let place = Place::new(&bare(nodes, ""));
        for command in commands {
            let out = say(&place, command);
            assert_eq!(out.contains("the error in space may be as large as"), noticed, "{command:?} {out}");
        }
        assert_eq!(place.run().out.contains("the error in space may exceed"), noticed, "{nodes}");
    }
    let few = Place::new(&bare("nodes = 20", ""));
    for command in [&["evaluate", "scene.toml"][..], &["run", "scene.toml", "--out", "results"]] {
        let done = few.nekton(command);
        let told = format!("{}{}", done.out, done.err);
        assert!(done.code == Some(2) || done.code == Some(3), "{command:?} {told}");
        assert!(told.contains("more nodes are needed (bound = "), "{command:?} {told}");
    }
    assert!(
        few.nekton(&["evaluate", "scene.toml"]).err.contains("without any `nodes` in the scene it gets "),
        "{}",
        few.nekton(&["evaluate", "scene.toml"]).err
    );
    let allowed = Place::new(&bare("nodes = 20", "allow_unresolved = true"));
    assert_eq!(allowed.run().code, Some(0));
    assert!(say(&allowed, &["evaluate", "scene.toml"]).contains("notice: the error in space"));
}

#[test]
fn memory_that_no_machine_has_is_refused_before_it_is_taken_with_the_largest_boundary() {
    // Children come before their parent, whom the core places first.
    let link = |name: &str, k: usize, nodes: usize| {
        let a = 0.4 + 0.01 * k as f64;
        format!(
            "[[body.link]]\nname = \"{name}\"\nshape = {{ ellipse = [{a}, 0.1] }}\ndensity = 1.0\nnodes = {nodes}\n"
        )
    };
    let hinge = |k: usize| {
        format!("parent = \"hub\"\nhinge = {{ parent = [{}.0, 0.0] }}\nmotion = {{ locked = 0 }}\n", 2 * k + 2)
    };
    let children = (0..16).map(|k| link(&format!("c{k}"), k, if k == 3 { 65536 } else { 60000 }) + &hinge(k));
    let scene = format!(
        "[fluid]\ndensity = 1.0\n[[body]]\nname = \"fan\"\n{}{}",
        children.collect::<String>(),
        link("hub", 20, 32)
    );
    let done = Place::new(&scene).nekton(&["evaluate", "scene.toml"]);
    assert_eq!(done.code, Some(2), "{}", done.out);
    assert_eq!(done.err.lines().count(), 1, "{}", done.err);
    assert!(
        done.err.contains(" bytes of memory, and ") && done.err.contains("most nodes has link `fan.c3`: 65536"),
        "{}",
        done.err
    );
}

#[test]
fn a_plan_of_thousands_of_nodes_takes_no_matrices() {
    let body = |k: usize| {
        format!(
            "[[body]]\nname = \"b{k}\"\nposition = [{}.0, 0.0]\n[[body.link]]\nname = \"l\"\nshape = {{ ellipse = [0.4, 0.1] }}\n\
             density = 1.0\nnodes = 1024\n",
            2 * k
        )
    };
    let scene = format!("[fluid]\ndensity = 1.0\n{}", (0..400).map(body).collect::<String>());
    let done = Place::new(&scene).nekton(&["plan", "scene.toml"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    // A matrix of 1.3 terabytes.
    assert!(done.out.contains("boundary unknowns        409600 "), "{}", done.out);
    assert!(done.out.contains("told by `nekton evaluate`"), "{}", done.out);
}

#[test]
fn automatic_nodes_are_shown_by_the_plan() {
    let place = Place::new(&changed("nodes = 32", "nodes = \"auto\""));
    let plan = place.nekton(&["plan", "scene.toml"]);
    assert_eq!(plan.code, Some(0), "{}", plan.err);
    let line = |name: &str| plan.out.lines().find(|l| l.starts_with(name)).unwrap_or_default().to_owned();
    assert_eq!(line("noticed error in space").split_whitespace().last(), Some("1e-3"));
    let nodes = line("nodes");
    let counts: Vec<usize> = nodes.split(',').map(|n| n.split_whitespace().last().unwrap().parse().unwrap()).collect();
    assert_eq!(counts.len(), 3, "{nodes}");
    assert!(nodes.contains("fish.head") && counts[0].is_multiple_of(2) && counts[0] > 16, "{nodes}");
    let explicit = Place::new(&changed("", "")).nekton(&["plan", "scene.toml"]).out;
    assert!(explicit.contains("fish.head 32") && !explicit.contains("about"), "{explicit}");
    assert!(nodes.contains("fish.head about ") && plan.out.contains("about: by the rule"), "{}", plan.out);
    let without = Place::new(&changed("nodes = 32\n", "")).nekton(&["plan", "scene.toml"]).out;
    assert_eq!(without, plan.out);
}
