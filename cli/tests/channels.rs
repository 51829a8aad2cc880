//! Channels: functions of time that are given when the scene is run.

mod common;
use common::{Done, Place, changed};

const STROKE: &str = "{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }";
const INTEGRATOR: &str = "{ method = \"adams\", tolerance = 1e-6 }";
const TABLE: &str = "t,u\n0,0\n0.1,0.02\n0.3,0.1\n0.4,0.12\n0.5,0.1\n";

fn run(place: &Place, more: &[&str]) -> Done {
    place.nekton(&[&["run", "scene.toml", "--out", "results"], more].concat())
}

fn refused(place: &Place, more: &[&str], line: &str) {
    let done = run(place, more);
    assert_eq!((done.code, done.err.trim()), (Some(2), line));
    assert!(!place.path("results").exists());
}

/// The fish with this in place of its stroke, and a table `neck.csv`.
fn driven(motion: &str, integrator: &str) -> Place {
    let place = Place::new(&changed(STROKE, motion).replace(INTEGRATOR, integrator));
    place.put("neck.csv", TABLE);
    place
}

#[test]
fn a_channel_that_follows_a_table_gives_what_the_table_in_its_place_gives() {
    for (channel, table) in [
        ("{ channel = \"neck\" }", "{ table = \"neck.csv\" }"),
        ("{ channel = \"neck\", slopes = \"spline\" }", "{ table = \"neck.csv\", slopes = \"spline\" }"),
        (
            "{ torque = { channel = \"neck\" }, stiffness = 0.1 }",
            "{ torque = { table = \"neck.csv\" }, stiffness = 0.1 }",
        ),
    ] {
        for integrator in [INTEGRATOR, "{ method = \"rk4\", step = 0.02 }"] {
            let (a, b) = (driven(channel, integrator), driven(table, integrator));
            let done = run(&a, &["--channel", "neck=neck.csv"]);
            assert_eq!(done.code, Some(0), "{}", done.err);
            assert_eq!(run(&b, &[]).code, Some(0));
            for file in ["trajectory.csv", "energy.csv", "torque.csv"] {
                let file = format!("results/{file}");
                assert!(a.read(&file) == b.read(&file), "{channel} {integrator}");
            }
            assert!(a.read("results/report.html").contains("<th>channel neck</th><td>neck.csv</td>"));
        }
    }
}

#[test]
fn a_channel_without_a_table_keeps_its_value_and_the_report_says_so() {
    let (a, b) = (driven("{ channel = \"neck\", value = 0.25 }", INTEGRATOR), driven("{ locked = 0.25 }", INTEGRATOR));
    let done = run(&a, &[]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert_eq!(run(&b, &[]).code, Some(0));
    let numbers = |p: &Place| -> Vec<f64> {
        p.read("results/trajectory.csv")
            .lines()
            .skip(1)
            .flat_map(|l| l.split(','))
            .map(|x| x.parse().unwrap())
            .collect()
    };
    assert!(numbers(&a).iter().zip(numbers(&b)).all(|(x, y)| (x - y).abs() < 1e-9));
    let text = "channel `neck` stays at 0.25: no table is given (nekton run --channel neck=FILE)";
    assert!(done.out.contains(&format!("notice: {text}")), "{}", done.out);
    let report = a.read("results/report.html");
    assert!(report.contains(text) && report.contains("<th>channel neck</th><td>0.25: no table is given</td>"));
    assert!(a.nekton(&["plan", "scene.toml"]).out.contains(text));
}

#[test]
fn channels_may_stand_for_the_motion_of_a_root() {
    let root = "root = { x = { channel = \"way\", value = 0.1 }, theta = { channel = \"turn\" } }";
    let place = Place::new(&changed("velocity = [0.1, 0.0]", root));
    place.put("turn.csv", "t,u\n0,0\n0.5,1\n");
    let done = run(&place, &["--channel", "turn=turn.csv"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let text = place.read("results/trajectory.csv");
    for line in text.lines().skip(1) {
        let r: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        assert!((r[1] - 0.1).abs() < 1e-15 && (r[3] - 2.0 * r[0]).abs() < 1e-14, "{line}");
    }
}

#[test]
fn channels_and_tables_that_do_not_fit_are_refused() {
    let place = driven("{ channel = \"neck\" }", INTEGRATOR);
    place.put("bad.csv", "t,u\n0,0\n1,x\n");
    place.put("jump.csv", "t,u\n0,0\n1,0\n1,1\n");
    for (arguments, line) in [
        (&["--channel", "nekc=neck.csv"][..], "scene.toml: the scene has no channel `nekc` (did you mean `neck`?)"),
        (&["--channel", "xyz=neck.csv"], "scene.toml: the scene has no channel `xyz` (allowed: neck)"),
        (
            &["--channel", "neck=neck.csv", "--channel", "neck=bad.csv"],
            "scene.toml: channel `neck` is given twice: by neck.csv and by bad.csv (leave one of them out)",
        ),
        (&["--channel", "neck=bad.csv"], "bad.csv:3: `x` in column `u` is not a finite number"),
        (
            &["--channel", "neck=jump.csv"],
            "jump.csv:4: t = 1 stands here and on line 3: a jump, which a motion cannot make (leave out one of the two rows, or \
             move them apart by the time that the change takes)",
        ),
    ] {
        refused(&place, arguments, line);
    }
    let lost = run(&place, &["--channel", "neck=nowhere.csv"]);
    assert!(lost.err.starts_with("nowhere.csv: cannot be read for channel `neck`: "), "{}", lost.err);
    assert_eq!(lost.code, Some(2));
    for wrong in ["neck", "=neck.csv", "neck="] {
        let done = run(&place, &["--channel", wrong]);
        assert!(done.code == Some(2) && done.err.contains("the name of a channel, an equals sign"), "{}", done.err);
    }
    let none = Place::new(&changed("", ""));
    none.put("neck.csv", TABLE);
    refused(&none, &["--channel", "neck=neck.csv"], "scene.toml: the scene has no channel `neck` (it has none)");
    let spline = driven("{ channel = \"neck\", slopes = \"spline\" }", INTEGRATOR);
    spline.put("rates.csv", "t,u,du\n0,0,0\n1,0,0\n");
    refused(
        &spline,
        &["--channel", "neck=rates.csv"],
        "scene.toml:20: `slopes` does not go with rates.csv, which gives `du` (take out one of the two)",
    );
}

#[test]
fn names_of_channels_differ_and_values_go_with_channels_only() {
    let twice = changed("velocity = [0.1, 0.0]", "root = { x = { channel = \"neck\" } }")
        .replace(STROKE, "{ channel = \"neck\" }");
    refused(
        &Place::new(&twice),
        &[],
        "scene.toml:20: two channels are called `neck` (the other is on line 7; names must differ)",
    );
    refused(
        &driven("{ table = \"neck.csv\", value = 1.0 }", INTEGRATOR),
        &[],
        "scene.toml:20: `value` goes with `channel` only",
    );
    refused(
        &driven("{ torque = 0.0, value = 1.0 }", INTEGRATOR),
        &[],
        "scene.toml:20: `value` does not go with `torque` (goes inside: torque = { channel = …, value = … })",
    );
    refused(
        &driven("{ channel = \"a=b\" }", INTEGRATOR),
        &[],
        "scene.toml:20: `channel` cannot be `a=b` (no equals sign, comma or quote, and no blank at its ends)",
    );
}

/// Longest time between two outputs is no matter here; steps are counted by the report.
fn steps(place: &Place) -> u64 {
    let done = run(place, &[]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let text = done.out.split("steps (rejected): ").nth(1).unwrap();
    text.split_whitespace().next().unwrap().parse().unwrap()
}

#[test]
fn the_longest_and_the_first_step_of_adams_are_kept() {
    let free = steps(&driven(STROKE, "{ method = \"adams\", tolerance = 1e-3 }"));
    let place = driven(STROKE, "{ method = \"adams\", tolerance = 1e-3, max_step = 0.004 }");
    let short = steps(&place);
    assert!(free < 125 && short >= 125, "{free} {short}");
    assert!(place.read("results/report.html").contains("tolerance 1e-3, longest step 0.004 s"));
    let careful = steps(&driven(STROKE, "{ method = \"adams\", tolerance = 1e-3, first_step = 1e-9 }"));
    assert!(careful > free + 5, "{free} {careful}");
}

#[test]
fn steps_that_do_not_go_with_a_method_or_are_too_many_are_refused() {
    for (integrator, line) in [
        (
            "{ method = \"rk4\", step = 0.1, max_step = 0.1 }",
            "`max_step` does not go with method `rk4` (all its steps have the length `step`)",
        ),
        (
            "{ method = \"gauss6\", step = 0.1, first_step = 0.1 }",
            "`first_step` does not go with method `gauss6` (all its steps have the length `step`)",
        ),
        (
            "{ method = \"adams\", step = 0.1 }",
            "`step` does not go with method `adams` (its steps are of its own choice; their limit is `max_step`)",
        ),
        ("{ method = \"adams\", max_step = 0 }", "`max_step` must be greater than 0, but is 0"),
        ("{ method = \"adams\", first_step = nan }", "`first_step` must be finite, but is nan"),
        (
            "{ method = \"abm4\", step = 1e-8 }",
            "`step` = 0.00000001 makes 10000000 steps between two rows, of 1000000 that are allowed (lengthen `step`, or \
             shorten `output_interval`)",
        ),
        (
            "{ method = \"adams\", max_step = 1e-8 }",
            "`max_step` = 0.00000001 makes 10000000 steps between two rows, of 1000000 that are allowed (lengthen `max_step`, \
             or shorten `output_interval`)",
        ),
    ] {
        refused(&driven(STROKE, integrator), &[], &format!("scene.toml:34: {line}"));
    }
}
