//! Where results go: what cannot be written is found before the run, or ends the command with an error.
#![cfg(unix)]

mod common;
use common::{GOOD, Place, changed, names};

use std::fs::OpenOptions;
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};

fn command(place: &Place, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nekton"));
    command.current_dir(place.path("")).args(arguments);
    command
}

#[test]
fn standard_output_that_is_full_is_an_error() {
    let place = Place::new(GOOD);
    for arguments in [
        &["evaluate", "scene.toml", "--json"][..],
        &["evaluate", "scene.toml"],
        &["plan", "scene.toml"],
        &["plan", "scene.toml", "--ingredients", "--csv"],
        &["run", "scene.toml", "--out", "results"],
        &["trade", "scene.toml", "--quick", "--until", "0.1", "--limit", "0.2"],
        &["--help"],
        &["--version"],
        &["help", "run"],
        &["plan", "--help"],
    ] {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = command(&place, arguments).stdout(full).output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{arguments:?}");
        // What takes longer than two seconds says so before.
        let told: Vec<&str> = err.lines().filter(|l| !l.starts_with("measuring settings: ")).collect();
        assert!(told.len() == 1 && told[0].starts_with("standard output: cannot be written: "), "{err}");
    }
    // The results of the run are there all the same.
    assert!(place.path("results/report.html").is_file());
}

#[test]
fn a_reader_that_has_gone_away_is_no_error() {
    let place = Place::new(GOOD);
    for arguments in [&["evaluate", "scene.toml", "--json"][..], &["plan", "scene.toml"], &["--help"], &["--version"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let done = command(&place, arguments).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!((done.status.code(), done.stderr.as_slice()), (Some(0), &b""[..]), "{arguments:?}");
    }
}

#[test]
fn standard_error_that_is_full_changes_no_exit_code() {
    let place = Place::new(GOOD);
    for (arguments, code) in
        [(&["plan", "absent.toml"][..], 2), (&["plan"], 2), (&["no-such-command"], 2), (&["plan", "scene.toml"], 0)]
    {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = command(&place, arguments).stderr(full).output().unwrap();
        assert_eq!(done.status.code(), Some(code), "{arguments:?}");
    }
}

#[test]
fn a_bad_folder_is_found_before_the_run_and_nothing_is_left() {
    // This run would take for ever.
    let place = Place::new(&changed("duration = 0.5", "duration = 1e7").replace("interval = 0.1", "interval = 1e3"));
    symlink("nowhere", place.path("dangling")).unwrap();
    place.put("file", "");
    place.put("closed/inner/kept", "");
    let before = place.names();
    let long = "n".repeat(300);
    let deep = "n/".repeat(2500);
    for (out, told) in [
        ("dangling", "dangling: cannot be written: dangling is a link to nowhere, which is not there"),
        ("dangling/inner", "dangling/inner: cannot be written: dangling is a link to nowhere, which is not there"),
        (&long, &*format!("{long}: cannot be written: File name too long")),
        (&format!("new/{long}/more"), &format!("new/{long}/more: cannot be written: File name too long")),
        (&deep, &format!("{deep}: cannot be written: File name too long")),
        ("file", "file: is not a folder"),
        ("file/more", "file/more: cannot be written: Not a directory"),
        ("new/..", "new/..: is no name for a new folder"),
    ] {
        for arguments in [["run", "scene.toml", "--out", out], ["trade", "scene.toml", "--out", out]] {
            let done = place.nekton(&arguments);
            assert_eq!(done.code, Some(2), "{arguments:?}");
            assert!(done.err.starts_with(told) && done.err.lines().count() == 1, "{}", done.err);
            assert!(done.err.trim().ends_with("(name another folder with --out)"), "{}", done.err);
            assert_eq!((place.names(), done.out.as_str()), (before.clone(), ""));
        }
    }
    std::fs::create_dir_all(place.path("out/recommended.csv")).unwrap();
    let done = place.nekton(&["trade", "scene.toml", "--out", "out"]);
    assert_eq!(done.err.trim(), "out/recommended.csv: is a folder where a file is to be written");
    assert_eq!(names(&place.path("out")), ["recommended.csv"]);
}

#[test]
fn a_link_to_a_folder_is_a_folder() {
    let place = Place::new(GOOD);
    std::fs::create_dir(place.path("real")).unwrap();
    symlink("real", place.path("results")).unwrap();
    assert_eq!(place.run().code, Some(0));
    assert!(place.path("real/report.html").is_file());
}

/// Runs the report's script with a canvas that counts, if there is node: lines of the grid, and texts.
fn drawn(page: &str) -> Option<(usize, Vec<String>)> {
    let script = page.split_once("<script>")?.1.split_once("</script>")?.0;
    let stub = r#"
        const texts = [], elements = {}; let lines = 0, at = null;
        const check = (...all) => { for (const x of all) if (!Number.isFinite(x)) throw new Error("not finite"); };
        const pen = { setTransform() {}, fillRect() {}, beginPath() {}, closePath() {}, fill() {}, arc: (x, y) => check(x, y),
            moveTo(x, y) { check(x, y); at = [x, y]; }, stroke() {},
            lineTo(x, y) { check(x, y); if (pen.strokeStyle === "rgba(0,0,0,.09)") lines += 1; },
            fillText(text, x, y) { check(x, y); texts.push(text); } };
        const make = id => ({ addEventListener() {}, style: {}, checked: true, value: id === "view" ? view : "1",
            getContext: () => pen, clientWidth: 900 });
        globalThis.document = { getElementById: id => elements[id] ||= make(id), addEventListener() {} };
        globalThis.window = { devicePixelRatio: 1, addEventListener() {} };
        globalThis.requestAnimationFrame = () => {};
        process.on("exit", () => { if (lines) console.log(JSON.stringify([lines, texts])); });
    "#;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.js");
    let mut all = (0, Vec::new());
    for view in ["whole", "follow"] {
        std::fs::write(&file, format!("const view = {view:?};{{{stub}}}\n{{{script}}}")).unwrap();
        let output = Command::new("timeout").args(["20", "node"]).arg(&file).output().ok()?;
        if output.status.code() == Some(127) {
            return None;
        }
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let (lines, texts): (usize, Vec<String>) = serde_json::from_slice(&output.stdout).unwrap();
        all.0 += lines;
        all.1.extend(texts);
    }
    Some(all)
}

#[test]
fn reports_are_drawn_at_any_offset() {
    let scene = |root: &str| {
        format!(
            "[fluid]\ndensity = 0.0\n[[body]]\n{root}\n[[body.link]]\nshape = {{ ellipse = [4, 2] }}\ndensity = 1\n[run]\n\
             duration = 1.0\n"
        )
    };
    let at = |offset: &str| scene(&format!("position = [{offset}, 1]\nvelocity = [1, 0]\nangular_velocity = 1"));
    // A path so long that no point is near all of it.
    let far = scene("root = { x = { table = \"way.csv\" } }");
    for (offset, names, text) in [
        ("0.0", None, at("0.0")),
        ("3.0", None, at("3.0")),
        ("1e6", Some("1e6"), at("1e6")),
        ("-1e12", Some("-1e12"), at("-1e12")),
        ("1e17", Some("1e17"), at("1e17")),
        ("far", None, far),
    ] {
        let place = Place::new(&text);
        place.put("way.csv", "t,u\n0,-1e17\n1,1e17\n");
        let done = place.run();
        assert!(matches!(done.code, Some(0 | 3)), "{offset}: {}", done.err);
        let report = place.read("results/report.html");
        let svg = place.read("results/trajectories.svg");
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        if let Some(names) = names {
            assert!(report.contains(&format!("\"origin\":[\"{names}\"")), "{offset}");
        } else {
            assert!(report.contains("\"origin\":null"), "{offset}");
        }
        if let Some((lines, texts)) = drawn(&report) {
            assert!((6..200).contains(&lines), "{offset}: {lines}");
            let told = texts.iter().any(|t| t.starts_with("from x = "));
            assert_eq!(told, names.is_some(), "{texts:?}");
        }
    }
}

#[test]
fn names_that_a_spreadsheet_takes_for_a_formula_or_a_comment_are_refused() {
    let told = |c: char, name: &str, line: usize, key: &str| {
        format!(
            "scene.toml:{line}: `{key}` cannot be `{name}` (spreadsheets take what begins with {c} for a formula or a comment; \
             begin with a letter)"
        )
    };
    for c in "=+-@#".chars() {
        for name in [format!("{c}fish"), format!(" {c}1")] {
            for (from, line) in [("\"fish\"", 5), ("\"tail\"", 14)] {
                let place = Place::new(&changed(from, &format!("{name:?}")));
                let done = place.run();
                assert_eq!((done.code, done.err.trim()), (Some(2), &*told(c, &name, line, "name")));
            }
        }
        if c != '=' {
            let channel = format!("{{ channel = \"{c}neck\" }}");
            let place = Place::new(&changed("{ harmonic = [{ amplitude = 0.3, frequency = 2.0 }] }", &channel));
            let done = place.run();
            assert_eq!((done.code, done.err.trim()), (Some(2), &*told(c, &format!("{c}neck"), 20, "channel")));
        }
    }
    assert_eq!(Place::new(&changed("\"tail\"", "\"t-1 = @#\"")).nekton(&["plan", "scene.toml"]).code, Some(0));
}
