//! Bad input gives one line with file, line and a way out, exit code 2, and no output.

mod common;
use common::{Place, changed};

/// The command refuses the scene with this line, alone, and leaves nothing behind.
fn refuses(scene: &str, expected: &str) {
    refuses_in(&Place::new(scene), expected);
}

fn refuses_in(place: &Place, expected: &str) {
    let before = place.names();
    let done = place.run();
    assert_eq!(done.err.lines().collect::<Vec<_>>(), [expected], "{}", done.out);
    assert_eq!(done.code, Some(2));
    assert_eq!(done.out, "");
    assert_eq!(place.names(), before);
}

#[test]
fn unknown_key() {
    refuses(
        &changed("velocity", "velocty"),
        "scene.toml:7: unknown key `velocty` in [[body]] 1 (did you mean `velocity`?)",
    );
    refuses(&changed("[fluid]", "[fluids]"), "scene.toml:1: unknown key `fluids` in the scene (did you mean `fluid`?)");
    refuses(
        &changed("parent = [-1.2", "parnt = [-1.2"),
        "scene.toml:19: unknown key `parnt` in a hinge (did you mean `parent`?)",
    );
    refuses(
        &changed("ellipse = [1.0", "elipse = [1.0"),
        "scene.toml:10: unknown key `elipse` in `shape` (did you mean `ellipse`?)",
    );
    refuses(
        &changed("output_interval", "zzz"),
        "scene.toml:33: unknown key `zzz` in [run] (allowed: duration, output_interval, integrator, force, quadrature, tolerance, allow_unresolved, shortcuts)",
    );
}

#[test]
fn wrong_type() {
    refuses(
        &changed("density = 1.0", "density = \"1.0\""),
        "scene.toml:2: `density` must be a number, but is a string",
    );
    refuses(&changed("nodes = 32", "nodes = 32.0"), "scene.toml:12: `nodes` must be a whole number, but is a number");
    refuses(&changed("[0.0, 0.0]", "[0.0]"), "scene.toml:6: `position` must have 2 numbers, but has 1");
    refuses(&changed("[0.0, 0.0]", "[0.0, true]"), "scene.toml:6: `position` must be a number, but is true or false");
    refuses(&changed("{ ellipse = [1.0, 0.4] }", "3"), "scene.toml:10: `shape` must be a table, but is a whole number");
}

#[test]
fn missing_key() {
    refuses(&changed("shape = { ellipse = [1.0, 0.4] }\n", ""), "scene.toml:8: link 1 of body `fish` needs `shape`");
    refuses(
        &changed("density = 1.0\nnodes = 32\n[[", "[["),
        "scene.toml:8: link 1 of body `fish` needs `density` (or `mass` and `inertia`)",
    );
    refuses(
        &changed("motion = { harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }\n", ""),
        "scene.toml:13: link 2 of body `fish` needs `motion` ({ harmonic = … }, { table = … }, { channel = … } or { torque = … }; \
         a stiff joint is { locked = 0.0 }, a free one { torque = 0.0 })",
    );
    refuses("[run]\nduration = 1\n", "scene.toml: the scene has no body (add [[body]] with one or more [[body.link]])");
    let scene = &changed("", "");
    let (without_run, _) = scene.split_once("[run]").unwrap();
    refuses(without_run, "scene.toml: there is no [run] section (add [run] with duration = … (s))");
}

#[test]
fn not_toml() {
    let place = Place::new(&changed("velocity = [", "velocity = "));
    let done = place.run();
    assert!(done.err.starts_with("scene.toml:7: not valid TOML: "), "{}", done.err);
    assert_eq!(done.err.lines().count(), 1);
    assert_eq!(done.code, Some(2));
    place.put("scene.toml", b"[fluid]\n\n# \xff");
    refuses_in(&place, "scene.toml:3: this is not UTF-8 text");
}

#[test]
fn unreadable_scene() {
    let place = Place::new("");
    let done = place.nekton(&["plan", "nowhere.toml"]);
    assert!(done.err.starts_with("nowhere.toml: cannot be read: "), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));
}

#[test]
fn missing_parent() {
    refuses(
        &changed("parent = \"head\"", "parent = \"haed\""),
        "scene.toml:18: `parent` `haed` of link `tail` is not a link of this body (did you mean `head`?)",
    );
    refuses(
        &changed("parent = \"head\"\n", ""),
        "scene.toml:18: `hinge` of link `tail` needs `parent` (name the link on which it hangs)",
    );
    let joint = "parent = \"head\"\nhinge = { parent = [-1.2, 0.0], self = [1.0, 0.0] }\n\
                 motion = { harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }\n";
    refuses(
        &changed(joint, ""),
        "scene.toml:13: link `tail` of body `fish` has no parent, and neither has link `head` (only one link of a body \
         hangs on nothing; did you mean `parent = \"head\"` with a hinge?)",
    );
}

#[test]
fn hinge_cycle() {
    let head = "nodes = 32\nparent = \"tail\"\nhinge = {}\nmotion = { locked = 0 }\n[[body.link]]\nname = \"tail\"";
    refuses(
        &changed("nodes = 32\n[[body.link]]\nname = \"tail\"", head),
        "scene.toml:4: the parents of body `fish` lead round: head -> tail -> head \
         (one link of the body must have no parent)",
    );
    let ring = "[[body.link]]\nname = \"a\"\nshape = { ellipse = [1, 1] }\ndensity = 1\nparent = \"b\"\nhinge = {}\n\
                motion = { locked = 0 }\n[[body.link]]\nname = \"b\"\nshape = { ellipse = [1, 1] }\ndensity = 1\n\
                parent = \"a\"\nhinge = {}\nmotion = { locked = 0 }\n\n[[body]]\nname = \"stone\"";
    refuses(
        &changed("[[body]]\nname = \"stone\"", ring),
        "scene.toml:22: the parents of body `fish` lead round: a -> b -> a \
         (hinges must form a tree that starts at one link without parent)",
    );
    refuses(
        &changed("parent = \"head\"", "parent = \"tail\""),
        "scene.toml:13: the parents of body `fish` lead round: tail -> tail \
         (hinges must form a tree that starts at one link without parent)",
    );
}

#[test]
fn duplicate_names() {
    refuses(
        &changed("name = \"stone\"\nposition", "name = \"fish\"\nposition"),
        "scene.toml:23: two bodies are called `fish` (the other is on line 5; names must differ)",
    );
    refuses(
        &changed("name = \"tail\"", "name = \"head\""),
        "scene.toml:14: two links of body `fish` are called `head` (the other is on line 9; names must differ)",
    );
    refuses(&changed("\"tail\"", "\"t,l\""), "scene.toml:14: `name` cannot be `t,l` (no dot, comma or quote)");
}

#[test]
fn values_out_of_range() {
    refuses(&changed("density = 2.0", "density = -2.0"), "scene.toml:28: `density` must not be negative, but is -2");
    refuses(&changed("density = 1.0", "density = -1"), "scene.toml:2: `density` must not be negative, but is -1");
    refuses(&changed("density = 2.0", "density = nan"), "scene.toml:28: `density` must be finite, but is nan");
    refuses(&changed("[0.0, 3.0]", "[0.0, inf]"), "scene.toml:24: `position` must be finite, but is inf");
    refuses(
        &changed("nodes = 32", "nodes = 0"),
        "scene.toml:12: `nodes` must be even and at least 8, but is 0 (try 8)",
    );
    refuses(&changed("nodes = 32", "nodes = \"many\""), "scene.toml:12: `nodes` cannot be `many` (allowed: auto)");
    refuses(
        &changed("duration = 0.5", "duration = 0.5\ntolerance = 0"),
        "scene.toml:33: `tolerance` must be greater than 0, but is 0",
    );
    refuses(
        &changed("duration = 0.5", "duration = 0.5\ntolerance = nan"),
        "scene.toml:33: `tolerance` must be finite, but is nan",
    );
    refuses(
        &changed("nodes = 32", "nodes = 31"),
        "scene.toml:12: `nodes` must be even and at least 8, but is 31 (try 32)",
    );
    refuses(
        &changed("nodes = 32", "nodes = -32"),
        "scene.toml:12: `nodes` must be a whole number that is not negative, but is -32",
    );
    refuses(
        &changed("[1.0, 0.4]", "[1.0, 0.0]"),
        "scene.toml:10: `ellipse` needs two lengths greater than 0, but one is 0",
    );
    refuses(
        &changed("duration = 0.5", "duration = 0.5\nquadrature = \"grated\""),
        "scene.toml:33: `quadrature` cannot be `grated` (did you mean `graded`?)",
    );
    refuses(&changed("duration = 0.5", "duration = 0"), "scene.toml:32: `duration` must be greater than 0, but is 0");
    refuses(
        &changed("output_interval = 0.1", "output_interval = 1e-9"),
        "scene.toml:33: `output_interval` makes 500000000 rows (make output_interval larger)",
    );
    refuses(&changed("\"adams\"", "\"adam\""), "scene.toml:34: `method` cannot be `adam` (did you mean `adams`?)");
    refuses(
        &changed("\"adams\"", "\"rk4\""),
        "scene.toml:34: `tolerance` does not go with method `rk4` (its accuracy is that of its `step`)",
    );
    refuses(
        &changed("{ ellipse = [1.0, 0.4] }", "{ polygon = [[0, 0], [1, 0]] }"),
        "scene.toml:10: `polygon` needs at least 3 points, but has 2",
    );
    refuses(
        &changed("frequency = 2.0 }]", "frequency = 2.0 }], window = { from = 0, to = 1, ramp = 0.6 }"),
        "scene.toml:20: `ramp` must be at most half of the window, but is 0.6 of 1",
    );
}

#[test]
fn bodies_without_any_inertia() {
    let empty = changed("density = 1.0", "density = 0.0").replace("density = 2.0", "density = 0.0");
    refuses(
        &empty,
        "scene.toml:28: link `stone.stone`: a body without mass cannot be accelerated in a fluid without density \
         (give it a density, or give the fluid one)",
    );
}

#[test]
fn tolerance_below_rounding() {
    refuses(
        &changed("1e-6", "1e-17"),
        "scene.toml:34: a tolerance must be positive and not below rounding (relative = 1.000e-17) \
         (1e-12 is near the least that can be met)",
    );
}

#[test]
fn overlapping_bodies() {
    let place = Place::new(&changed("[0.0, 3.0]", "[0.0, 0.7]"));
    let done = place.run();
    assert!(done.err.starts_with("scene.toml:24: "), "{}", done.err);
    assert!(done.err.contains("`stone.stone`") && done.err.contains("`fish.head`"), "{}", done.err);
    assert!(done.err.contains("overlap") && done.err.contains("move them apart"), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));
    assert_eq!(place.names(), ["scene.toml"]);
}

#[test]
fn body_outside_the_tank() {
    let tank = "[tank]\nshape = { ellipse = [4.0, 2.0] }\n\n[run]";
    let place = Place::new(&changed("[run]", tank));
    let done = place.run();
    assert!(done.err.contains("`stone.stone`") && done.err.contains("tank"), "{}", done.err);
    assert!(done.err.starts_with("scene.toml:24: "), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));
}

#[test]
fn outline_that_crosses_itself() {
    let bow_tie = "polygon = [[0, 0], [1, 1], [1, 0], [0, 1]], radius = 0.05";
    let place = Place::new(&changed("rectangle = [1.0, 1.0], radius = 0.3", bow_tie));
    let done = place.run();
    assert!(done.err.starts_with("scene.toml:27: link `stone.stone`: the outline crosses itself"), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));
}

#[test]
fn clockwise_outline_is_turned_round_with_a_notice() {
    let clockwise = "polygon = [[0, 0], [0, 1], [1, 1], [1, 0]], radius = 0.1";
    let place = Place::new(&changed("rectangle = [1.0, 1.0], radius = 0.3", clockwise));
    let done = place.nekton(&["plan", "scene.toml"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.contains("notice: link `stone.stone`: the outline runs clockwise and was turned round"));
}

#[test]
fn unreadable_table() {
    let table = "motion = { table = \"stroke.csv\" }";
    let scene = changed("motion = { harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }", table);
    let place = Place::new(&scene);
    let done = place.run();
    assert!(done.err.starts_with("scene.toml:20: `table` names stroke.csv, which cannot be read: "), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));

    let bad = |text: &str, expected: &str| {
        place.put("stroke.csv", text);
        refuses_in(&place, expected);
    };
    bad("t,u\n0,0\n1,x\n", "stroke.csv:3: `x` in column `u` is not a finite number");
    bad("t,u\n0,0\n1,nan\n", "stroke.csv:3: `nan` in column `u` is not a finite number");
    bad("t,u\n0,0\n1\n", "stroke.csv:3: 1 columns instead of 2 (the header is t,u)");
    bad("t,u\n0,0\n2,1\n1,1\n", "stroke.csv:4: times must increase, but 1 follows 2");
    bad("t,du\n0,0\n", "stroke.csv:1: the header lacks column `u`");
    bad("time,u\n0,0\n", "stroke.csv:1: unknown column `time` (allowed: t, u, du, ddu)");
    bad("0,0\n1,1\n", "stroke.csv:1: unknown column `0` (the first line must be the header t,u,du,ddu)");
    bad("t,u,u\n", "stroke.csv:1: column `u` appears twice");
    bad("t,u\n", "stroke.csv: has a header but no rows");
    bad("", "stroke.csv: is empty; expected a header t,u,du,ddu");
}

#[test]
fn unwritable_output() {
    let place = Place::new(common::GOOD);
    place.put("results", "a file");
    refuses_in(&place, "results: is not a folder (name another folder with --out)");
    assert_eq!(place.read("results"), "a file");

    let place = Place::new(common::GOOD);
    place.put("file", "");
    let done = place.nekton(&["run", "scene.toml", "--out", "file/results"]);
    assert!(done.err.starts_with("file/results: cannot be written: "), "{}", done.err);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1));

    let place = Place::new(common::GOOD);
    std::fs::create_dir_all(place.path("results/energy.csv")).unwrap();
    refuses_in(&place, "results/energy.csv: is a folder where a file is to be written");
}
