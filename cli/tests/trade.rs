//! `nekton trade`, `nekton run --error`, `nekton plan --ingredients`.

mod common;
use common::{Done, GOOD, Place, changed, names};

/// A short scene of few nodes: two ellipses.
const SMALL: &str = r#"[[body]]
name = "a"
velocity = [0.3, 0.0]
angular_velocity = 0.5
[[body.link]]
shape = { ellipse = [1.0, 0.4] }
density = 1.0
nodes = 24

[[body]]
name = "b"
position = [0.0, 2.5]
[[body.link]]
shape = { ellipse = [0.7, 0.6] }
density = 1.0
nodes = 24

[run]
duration = 1.0
output_interval = 0.25
"#;

fn trade(place: &Place, more: &[&str]) -> Done {
    let done = place.nekton(&[&["trade", "scene.toml"], more].concat());
    assert_eq!(done.code, Some(0), "{}", done.err);
    done
}

fn rows(place: &Place, file: &str) -> Vec<Vec<String>> {
    place.read(file).lines().skip(1).map(|l| l.split(',').map(str::to_owned).collect()).collect()
}

/// Settings of all rows: everything but what the clock says.
fn settings(place: &Place) -> Vec<Vec<String>> {
    let mut all: Vec<_> = rows(place, "scene.trade/trade.csv").into_iter().map(|r| r[..11].to_vec()).collect();
    all.sort();
    all
}

#[test]
fn trade_writes_table_picture_and_reference_and_recommends() {
    let place = Place::new(SMALL);
    let done = trade(&place, &["--limit", "2"]);
    assert_eq!(names(&place.path("scene.trade")), ["recommended.csv", "reference.csv", "trade.csv", "trade.svg"]);
    let table = place.read("scene.trade/trade.csv");
    assert_eq!(
        table.lines().next().unwrap(),
        "scene,until,quadrature,force,precision,integrator,step_or_tolerance,nodes,unknowns,status,error,\
         seconds_per_second,evaluations_per_second"
    );
    let rows = rows(&place, "scene.trade/trade.csv");
    assert!(rows.iter().all(|r| r.len() == 13));
    for (column, values) in [
        (2, &["graded", "plain"][..]),
        (3, &["exact", "boundary"]),
        (4, &["f64", "f32"]),
        (5, &["adams", "rk4", "abm4", "gauss6"]),
    ] {
        assert!(values.iter().all(|v| rows.iter().any(|r| r[column] == *v)), "{values:?}");
    }
    for line in ["for 1e-3: nodes ", "for 1e-6: nodes ", "for 1e-9: nodes "] {
        assert!(done.out.contains(line), "{}", done.out);
    }
    let recommended = self::rows(&place, "scene.trade/recommended.csv");
    for (row, wanted) in recommended.iter().zip([1e-3, 1e-6, 1e-9]) {
        assert_eq!(row[0].parse(), Ok(wanted));
        assert!(row[11].parse::<f64>().unwrap() <= wanted, "{row:?}");
    }
    let svg = place.read("scene.trade/trade.svg");
    for word in ["front", "adams", "rk4 f32", "boundary plain", "relative error", "s/s"] {
        assert!(svg.contains(word), "{word}");
    }
}

#[test]
fn a_row_that_is_known_is_not_measured_again_and_a_cut_off_line_is() {
    let place = Place::new(SMALL);
    trade(&place, &["--quick"]);
    let whole = settings(&place);
    let table = place.read("scene.trade/trade.csv");
    let again = trade(&place, &["--quick"]);
    assert!(again.out.contains("\n0 settings measured"), "{}", again.out);
    assert_eq!(place.read("scene.trade/trade.csv"), table);
    // Killed in the middle of a line: that line is measured again, the others are as they were.
    let kept = table.lines().take(6).collect::<Vec<_>>().join("\n");
    place.put("scene.trade/trade.csv", &table[..kept.len() - 20]);
    trade(&place, &["--quick"]);
    assert_eq!(settings(&place), whole);
    assert!(place.read("scene.trade/trade.csv").starts_with(&table[..kept.len() - 200]));
}

#[test]
fn another_scene_in_the_same_folder_keeps_its_own_rows() {
    let place = Place::new(SMALL);
    trade(&place, &["--quick"]);
    let before = rows(&place, "scene.trade/trade.csv");
    place.put("scene.toml", SMALL.replace("0.3, 0.0", "0.2, 0.0"));
    let done = trade(&place, &["--quick"]);
    assert!(done.out.contains(", 0 known from before"), "{}", done.out);
    let after = rows(&place, "scene.trade/trade.csv");
    assert_eq!(after[..before.len()], before);
    assert!(after[before.len()..].iter().all(|r| r[0] != before[0][0]));
}

/// Poses of the last row of a trajectory.
fn end(place: &Place, folder: &str) -> Vec<f64> {
    let row: Vec<f64> =
        rows(place, &format!("{folder}/trajectory.csv")).pop().unwrap().iter().map(|x| x.parse().unwrap()).collect();
    row[1..].chunks(6).flat_map(|link| link[..3].to_vec()).collect()
}

#[test]
fn run_with_an_error_takes_the_cheapest_setting_of_the_table_and_keeps_the_promise() {
    let place = Place::new(SMALL);
    trade(&place, &["--quick"]);
    let exact = SMALL.to_owned() + "integrator = { method = \"adams\", tolerance = 1e-12 }\n";
    place.put("exact.toml", exact.replace("nodes = 24", "nodes = 64"));
    assert_eq!(place.nekton(&["run", "exact.toml", "--out", "exact"]).code, Some(0));
    let exact = end(&place, "exact");
    for error in ["1e-3", "1e-5", "1e-8"] {
        let done = place.nekton(&["run", "scene.toml", "--out", error, "--error", error]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert!(done.out.starts_with("from scene.trade/trade.csv: nodes "), "{}", done.out);
        // The travel to which errors are relative is less than 1 m here.
        let worst = end(&place, error).iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= error.parse().unwrap(), "{error}: {worst:e}");
    }
}

#[test]
fn run_with_an_error_measures_where_there_is_no_table() {
    let place = Place::new(SMALL);
    let done = place.nekton(&["run", "scene.toml", "--out", "results", "--error", "1e-5"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.contains(" settings measured in "), "{}", done.out);
    assert_eq!(place.names(), ["results", "scene.toml"]);
    let refused = place.nekton(&["run", "scene.toml", "--out", "more", "--error", "1e-15"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.err.contains("scene.toml: no setting with an error of 1e-15 was found"), "{}", refused.err);
    assert_eq!(place.names(), ["results", "scene.toml"]);
}

#[test]
fn several_errors_may_follow_one_another_as_the_help_says() {
    let place = Place::new(SMALL);
    for arguments in [
        &["scene.toml", "--quick", "--error", "1e-3", "2.5e-6"][..],
        &["--error", "1e-3", "2.5e-6", "--quick", "scene.toml"],
        &["--quick", "--error", "1e-3", "--error=2.5e-6", "scene.toml"],
        &["--quick", "--error", "1e-3,2.5e-6", "scene.toml"],
        &["--error", "1e-3", "2.5e-6", "scene.toml", "--quick"],
    ] {
        let done = place.nekton(&[&["trade"], arguments].concat());
        assert_eq!(done.code, Some(0), "{arguments:?}: {}", done.err);
        let told: Vec<&str> = done.out.lines().filter_map(|l| l.strip_prefix("for ")?.split(':').next()).collect();
        assert_eq!(told, ["1e-3", "2.5e-6"], "{arguments:?}");
        assert_eq!(rows(&place, "scene.trade/recommended.csv").len(), 2);
    }
    let done = place.nekton(&["trade", "scene.toml", "--error", "1e-3", "-1"]);
    assert_eq!(done.code, Some(2), "{}", done.out);
    let help = place.nekton(&["trade", "--help"]).out;
    assert!(help.contains("--error 1e-3 1e-6") && help.contains("[default: 1e-3"), "{help}");
}

#[test]
fn bad_wishes_are_refused_and_nothing_is_written() {
    let place = Place::new(SMALL);
    place.put("plain.csv", "x\n");
    for (arguments, word) in [
        (&["trade", "scene.toml", "--error=-1"][..], "greater than 0"),
        (&["trade", "scene.toml", "--limit", "nan"], "greater than 0"),
        (&["trade", "scene.toml", "--until", "0"], "greater than 0"),
        (&["trade", "scene.toml", "--out", "plain.csv"], "plain.csv"),
        (&["trade", "scene.toml", "--limit", "1e-9"], "too slow"),
        (&["trade", "nowhere.toml"], "cannot be read"),
        (&["run", "scene.toml", "--out", "results", "--error", "0"], "greater than 0"),
        (&["plan", "scene.toml", "--csv"], "--ingredients"),
    ] {
        let done = place.nekton(arguments);
        assert_eq!(done.code, Some(2), "{arguments:?}: {}", done.err);
        assert!(done.err.contains(word), "{}", done.err);
        assert_eq!(place.names(), ["plain.csv", "scene.toml"], "{arguments:?}");
    }
    place.put("out/trade.csv", "a,b\n1,2\n");
    let done = place.nekton(&["trade", "scene.toml", "--out", "out"]);
    assert_eq!(done.code, Some(2));
    assert_eq!(
        done.err.trim(),
        "out/trade.csv:1: is not a table of this command (name another folder, or move it away)"
    );
    assert_eq!(names(&place.path("out")), ["trade.csv"]);
}

#[test]
fn a_scene_that_ends_in_contact_is_compared_until_then() {
    let scene = changed("amplitude = 0.3", "amplitude = 2.8").replace("duration = 0.5", "duration = 2.0");
    let place = Place::new(&scene);
    let done = trade(&place, &["--quick"]);
    let horizon = done.out.lines().find(|l| l.starts_with("horizon")).unwrap();
    let until: f64 = horizon.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(until > 0.1 && until < 2.0, "{horizon}");
}

#[test]
fn ingredients_that_are_absent_add_exactly_zero() {
    let place = Place::new(GOOD);
    let done = place.nekton(&["plan", "scene.toml", "--ingredients", "--csv"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    let rows: Vec<Vec<&str>> = done.out.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows[0].len(), 9);
    for row in &rows[1..] {
        let zero = row[3..].iter().all(|x| x.parse::<f64>() == Ok(0.0));
        match row[2] {
            "no" => assert!(zero, "{row:?}"),
            _ => assert!(!zero, "{row:?}"),
        }
    }
    let present: Vec<&str> = rows[1..].iter().filter(|r| r[2] == "yes").map(|r| r[1]).collect();
    assert_eq!(present, ["whole scene", "prescribed joints", "other bodies", "fluid"]);
    let table = place.nekton(&["plan", "scene.toml", "--ingredients"]);
    assert!(table.out.contains("right-hand sides") && table.out.contains("prescribed joints"));
}
