//! Functions of time given by tables: they keep within their rows, or the command says that they do not.

mod common;
use common::{Done, GOOD, Place, changed};

const STROKE: &str = "{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }";

/// A body without fluid whose root moves along x by a table.
fn moved(table: &str, more: &str) -> Place {
    let place = Place::new(&format!(
        "[fluid]\ndensity = 0.0\n[[body]]\nname = \"b\"\nroot = {{ x = {{ table = \"way.csv\"{more} }} }}\n[[body.link]]\n\
         name = \"b\"\nshape = {{ ellipse = [0.5, 0.1] }}\ndensity = 1.0\n[run]\nduration = 30.0\noutput_interval = 0.05\n"
    ));
    place.put("way.csv", table);
    place
}

fn ran(place: &Place) -> Done {
    let done = place.run();
    assert_eq!(done.code, Some(0), "{}", done.err);
    done
}

/// Columns t, x and vx of the run.
fn way(place: &Place) -> Vec<[f64; 3]> {
    let text = place.read("results/trajectory.csv");
    let rows = text.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>());
    rows.map(|r| [r[0], r[1], r[4]]).collect()
}

fn notices(done: &Done) -> Vec<String> {
    done.out.lines().filter_map(|l| l.split_once("notice: ")).map(|(_, text)| text.to_owned()).collect()
}

fn refused(place: &Place, line: &str) {
    let done = place.run();
    assert_eq!((done.code, done.err.trim()), (Some(2), line));
    assert!(!place.path("results").exists());
}

/// A short bump between long rests.
const BUMP: &str = "t,u\n0,0\n8,0\n8.2,0.04\n8.4,0.1\n8.5,0.07\n8.8,0\n15,0\n30,0\n";

#[test]
fn a_bump_between_long_rests_stays_within_its_rows() {
    let place = moved(BUMP, "");
    let done = ran(&place);
    let way = way(&place);
    assert!(way.iter().all(|[_, x, _]| (-1e-15..=0.1 + 1e-15).contains(x)));
    assert!(way.iter().filter(|w| w[0] < 8.0 || w[0] > 8.81).all(|w| w[1].abs() < 1e-15 && w[2].abs() < 1e-15));
    assert!(way.iter().any(|w| w[1] > 0.0999));
    assert_eq!(notices(&done), [""; 0]);
}

#[test]
fn a_spline_that_leaves_its_rows_is_told_with_line_times_and_values() {
    let place = moved(BUMP, ", slopes = \"spline\"");
    let done = ran(&place);
    let least = way(&place).iter().map(|w| w[1]).fold(0.0, f64::min);
    assert!(least < -10.0, "{least}");
    let told = notices(&done);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("way.csv:2: between t = 0 and 8 the interpolant goes to "), "{told:?}");
    let value: f64 = told[0].split("goes to ").nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((value - least).abs() < 1e-3 * least.abs(), "{value} {least}");
    assert!(told[0].contains("far from its rows' 0 and 0, the farthest of "), "{told:?}");
    assert!(place.read("results/report.html").contains("way.csv:2: between t = 0 and 8"));
    let plan = place.nekton(&["plan", "scene.toml"]);
    assert_eq!(notices(&plan), told);
}

#[test]
fn given_rates_that_lead_out_of_the_rows_are_told() {
    let done = ran(&moved("t,u,du,ddu\n0,0,0,0\n10,0,0.5,0\n20,1,0,0\n30,1,0,0\n", ""));
    let told = notices(&done);
    assert!(told.len() == 1 && told[0].starts_with("way.csv:2: between t = 0 and 10 "), "{told:?}");
    // A whole sine with its own rates: between its rows it rises above them, as it should.
    let sine: String = (0..=31).map(f64::from).map(|t| format!("{t},{},{}\n", t.sin(), t.cos())).collect();
    assert_eq!(notices(&ran(&moved(&format!("t,u,du\n{sine}"), ""))), [""; 0]);
}

#[test]
fn smooth_rows_that_lose_by_a_rate_of_zero_at_their_turns_are_told_unless_slopes_are_chosen() {
    let sine: String = (0..=62).map(|k| 0.5 * f64::from(k)).map(|t| format!("{t},{}\n", t.sin())).collect();
    let sine = format!("t,u\n{sine}");
    let told = notices(&ran(&moved(&sine, "")));
    assert!(told.len() == 1 && told[0].contains("the rows turn smoothly about t = "), "{told:?}");
    for chosen in ["monotone", "spline"] {
        let place = moved(&sine, &format!(", slopes = \"{chosen}\""));
        assert_eq!(notices(&ran(&place)), [""; 0], "{chosen}");
        let worst = way(&place).iter().map(|[t, x, _]| (x - t.sin()).abs()).fold(0.0, f64::max);
        // The spline has an error of order 4, the monotone one of order 2 where the sine turns.
        assert!(if chosen == "spline" { worst < 2e-3 } else { worst < 0.04 }, "{chosen}: {worst}");
    }
}

#[test]
fn slopes_have_two_names_and_make_no_sense_beside_given_rates_or_without_a_table() {
    refused(
        &moved(BUMP, ", slopes = \"splines\""),
        "scene.toml:5: `slopes` cannot be `splines` (did you mean `spline`?)",
    );
    refused(
        &moved("t,u,du\n0,0,0\n1,1,0\n", ", slopes = \"spline\""),
        "scene.toml:5: `slopes` does not go with way.csv, which gives `du` (take out one of the two)",
    );
    refused(
        &Place::new(&changed(STROKE, "{ harmonic = [{ offset = 1.0 }], slopes = \"spline\" }")),
        "scene.toml:20: `slopes` goes with `table` and `channel` only",
    );
    refused(
        &Place::new(&changed(STROKE, "{ torque = 0.0, slopes = \"spline\" }")),
        "scene.toml:20: `slopes` does not go with `torque` (goes inside: torque = { table = …, slopes = … })",
    );
}

#[test]
fn a_motion_cannot_jump() {
    refused(
        &moved("t,u\n0,0\n# here\n1,0\n1,2\n3,2\n", ""),
        "way.csv:5: t = 1 stands here and on line 4: a jump, which a motion cannot make (leave out one of the two rows, or \
         move them apart by the time that the change takes)",
    );
    let place = Place::new(&changed(STROKE, "{ table = \"stroke.csv\" }"));
    place.put("stroke.csv", "t,u,du\n0,0,0\n0,0,0\n");
    refused(
        &place,
        "stroke.csv:3: t = 0 stands here and on line 2: a jump, which a motion cannot make (leave out one of the two rows, or \
         move them apart by the time that the change takes)",
    );
}

/// GOOD with its joint driven by a torque from a table.
fn pushed(table: &str) -> Place {
    let place = Place::new(&changed(STROKE, "{ torque = { table = \"push.csv\" } }"));
    place.put("push.csv", table);
    place
}

#[test]
fn a_torque_may_jump_and_each_part_has_slopes_of_its_own() {
    let place = pushed("t,u\n0,0\n0.2,0\n0.2,0.3\n0.3,0.3\n0.3,-0.1\n0.5,-0.1\n");
    ran(&place);
    let steps = place.read("results/trajectory.csv");
    // The same as three constants one after the other, each from the state that the one before left.
    let mut state: Option<Vec<f64>> = None;
    for (duration, torque) in [(0.2, 0.0), (0.1, 0.3), (0.2, -0.1)] {
        let mut scene = GOOD.replace(STROKE, &format!("{{ torque = {torque}, start = [START] }}"));
        scene = scene.replace("duration = 0.5", &format!("duration = {duration}")).replace("1e-6", "1e-11");
        let s =
            state.unwrap_or_else(|| vec![0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        // head: x y θ vx vy ω, joint: u du from the tail; stone.
        scene = scene
            .replace("position = [0.0, 0.0]", &format!("position = [{:e}, {:e}]\nangle = {:e}", s[0], s[1], s[2]))
            .replace(
                "velocity = [0.1, 0.0]",
                &format!("velocity = [{:e}, {:e}]\nangular_velocity = {:e}", s[3], s[4], s[5]),
            )
            .replace("START", &format!("{:e}, {:e}", s[6], s[7]))
            .replace(
                "position = [0.0, 3.0]",
                &format!(
                    "position = [{:e}, {:e}]\nangle = {:e}\nvelocity = [{:e}, {:e}]\nangular_velocity = {:e}",
                    s[8], s[9], s[10], s[11], s[12], s[13]
                ),
            );
        let part = Place::new(&scene);
        ran(&part);
        let text = part.read("results/trajectory.csv");
        let r: Vec<f64> = text.lines().last().unwrap().split(',').skip(1).map(|x| x.parse().unwrap()).collect();
        let mut next = r[0..6].to_vec();
        next.extend([r[8] - r[2], r[11] - r[5]]);
        next.extend(&r[12..18]);
        state = Some(next);
    }
    let s = state.unwrap();
    let r: Vec<f64> = steps.lines().last().unwrap().split(',').skip(1).map(|x| x.parse().unwrap()).collect();
    for (a, b) in r[0..6].iter().zip(&s[0..6]).chain(r[12..18].iter().zip(&s[8..14])) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    assert!((r[8] - r[2] - s[6]).abs() < 1e-5);
    assert!(s[6].abs() > 1e-4, "{s:?}");
}

#[test]
fn three_rows_of_one_time_are_refused() {
    refused(
        &pushed("t,u\n0,0\n0.2,0\n0.2,0.3\n0.2,0.1\n1,0\n"),
        "push.csv:5: t = 0.2 stands in three rows, of which the one between means nothing (two rows of one time are a jump: \
         before and after)",
    );
    refused(&pushed("t,u\n0,0\n0.2,0\n0.1,0.3\n"), "push.csv:4: times must increase, but 0.1 follows 0.2");
}

#[test]
fn a_table_of_a_million_rows_is_read_in_the_time_of_its_rows() {
    let rows: String = (0..1_000_000).map(|k| format!("{},{}\n", k, (1e-3 * f64::from(k)).sin())).collect();
    for slopes in ["monotone", "spline"] {
        let place = moved(&format!("t,u\n{rows}"), &format!(", slopes = \"{slopes}\""));
        let clock = std::time::Instant::now();
        let done = place.nekton(&["plan", "scene.toml"]);
        assert_eq!(done.code, Some(0), "{}", done.err);
        // A second or two; anything quadratic would take hours.
        assert!(clock.elapsed().as_secs() < 60, "{slopes}");
    }
}
