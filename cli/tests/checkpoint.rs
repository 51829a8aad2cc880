//! Runs that are interrupted: what they leave behind, and that they go on as if nothing had been.

mod common;

use common::{Place, changed, names};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Two bodies for some seconds of the wall clock: rows often, nodes enough. With notices, which a checkpoint has to keep.
fn long(integrator: &str) -> Place {
    let scene =
        changed("duration = 0.5\noutput_interval = 0.1", "duration = 24.0\noutput_interval = 0.01\ntolerance = 1e-13");
    let scene = scene.replace("{ method = \"adams\", tolerance = 1e-6 }", integrator);
    Place::new(&scene)
}

const KEPT: [&str; 8] = ["run", "scene.toml", "--out", "results", "--checkpoint", "kept", "--every", "0.05s"];

fn start(place: &Place, more: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nekton"));
    command.current_dir(place.path("")).args(KEPT).args(more).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Until the file has been replaced a few times.
fn wait_for_checkpoints(place: &Place) {
    let file = place.path("kept/checkpoint.nekton");
    let (begun, mut seen, mut last) = (Instant::now(), 0, None);
    while seen < 3 {
        assert!(begun.elapsed() < Duration::from_secs(60), "no checkpoint appears");
        let now = std::fs::metadata(&file).and_then(|m| m.modified()).ok();
        seen += usize::from(now.is_some() && now != last);
        last = now;
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn files(place: &Place, folder: &str) -> Vec<(String, Vec<u8>)> {
    let names = names(&place.path(folder)).into_iter();
    names.map(|name| (name.clone(), std::fs::read(place.path(&format!("{folder}/{name}"))).unwrap())).collect()
}

#[test]
fn a_run_that_was_killed_goes_on_to_the_files_of_one_that_was_not() {
    for integrator in ["{ method = \"adams\", tolerance = 1e-6 }", "{ method = \"abm4\", step = 0.01 }"] {
        let place = long(integrator);
        let whole = place.nekton(&["run", "scene.toml", "--out", "whole"]);
        assert_eq!(whole.code, Some(0), "{}", whole.err);
        assert!(whole.out.contains("notice"), "{}", whole.out);

        for round in 0..2 {
            let mut child = start(&place, if round == 0 { &[] } else { &["--resume"] });
            wait_for_checkpoints(&place);
            child.kill().unwrap();
            child.wait().unwrap();
            assert!(!place.path("results").exists(), "the run had come to its end");
        }
        let done = place.nekton(&[&KEPT[..], &["--resume"]].concat());
        assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
        assert!(done.out.starts_with("the run goes on at t = "), "{}", done.out);
        for (own, other) in files(&place, "results").iter().zip(&files(&place, "whole")) {
            assert!(own == other, "{} differs", own.0);
        }
        assert_eq!(names(&place.path("results")), names(&place.path("whole")));
        // There is nothing left to go on with, nor any temporary file.
        assert_eq!(names(&place.path("kept")), Vec::<String>::new());
    }
}

#[cfg(unix)]
#[test]
fn signals_end_a_run_with_what_it_has() {
    for signal in ["INT", "TERM"] {
        let place = long("{ method = \"adams\", tolerance = 1e-6 }");
        let child = start(&place, &[]);
        wait_for_checkpoints(&place);
        let sent = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let output = child.wait_with_output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{err}");
        assert!(err.contains(&format!("interrupted by SIG{signal}; --resume goes on from there")), "{err}");
        let report = place.read("results/report.html");
        assert!(report.contains(&format!("interrupted by SIG{signal}")));
        let table = place.read("results/trajectory.csv");
        let times: Vec<f64> = table.lines().skip(1).map(|l| l.split(',').next().unwrap().parse().unwrap()).collect();
        assert!(times.len() > 3 && times.len() < 2401, "{}", times.len());
        assert!(table.lines().all(|l| l.split(',').count() == 19));

        let whole = place.nekton(&["run", "scene.toml", "--out", "whole"]);
        assert_eq!(whole.code, Some(0));
        let done = place.nekton(&[&KEPT[..], &["--resume"]].concat());
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert_eq!(files(&place, "results"), files(&place, "whole"));
    }
}

#[test]
fn another_run_or_a_damaged_file_is_refused_with_a_sentence() {
    let place = long("{ method = \"adams\", tolerance = 1e-6 }");
    let scene = place.read("scene.toml");
    let mut child = start(&place, &[]);
    wait_for_checkpoints(&place);
    child.kill().unwrap();
    child.wait().unwrap();
    let file = place.path("kept/checkpoint.nekton");
    let kept = std::fs::read(&file).unwrap();
    let refused = |more: &[&str], words: &[&str]| {
        let done = place.nekton(&[&KEPT[..], more].concat());
        assert_eq!((done.code, done.out.as_str(), done.err.lines().count()), (Some(2), "", 1), "{}", done.err);
        for word in words {
            assert!(done.err.contains(word), "{}", done.err);
        }
        assert_eq!(std::fs::read(&file).unwrap(), kept);
        assert!(!place.path("results").exists());
    };
    refused(&[], &["kept", "--resume", "--force"]);
    for (from, to, word) in [
        ("velocity = [0.1, 0.0]", "velocity = [0.1000001, 0.0]", "the scene is not the same"),
        ("duration = 24.0", "duration = 25.0", "duration was 24 s, now it is 25 s"),
        ("output_interval = 0.01", "output_interval = 0.02", "output interval was 0.01 s"),
        ("tolerance = 1e-6", "tolerance = 1e-7", "integrator was adams"),
        ("name = \"stone\"\nposition", "name = \"rock\"\nposition", "links was"),
    ] {
        assert!(scene.contains(from));
        place.put("scene.toml", scene.replacen(from, to, 1));
        refused(&["--resume"], &["another run", word]);
    }
    place.put("scene.toml", &scene);
    for (k, byte) in kept.iter().enumerate().step_by(kept.len() / 40) {
        let mut damaged = kept.clone();
        damaged[k] = byte ^ 8;
        std::fs::write(&file, &damaged).unwrap();
        let done = place.nekton(&[&KEPT[..], &["--resume"]].concat());
        assert_eq!(done.code, Some(2), "byte {k}");
        assert!(done.err.contains("damaged"), "{}", done.err);
    }
    std::fs::write(&file, &kept[..kept.len() - 5]).unwrap();
    assert_eq!(place.nekton(&[&KEPT[..], &["--resume"]].concat()).code, Some(2));
}

#[test]
fn a_complete_result_is_not_replaced_by_a_shorter_one() {
    let place = Place::new(&changed("", ""));
    assert_eq!(place.run().code, Some(0));
    let before = files(&place, "results");
    place.put("scene.toml", changed("duration = 0.5", "duration = 0.3"));
    let done = place.run();
    assert_eq!(
        (done.code, done.err.as_str()),
        (
            Some(2),
            "results: holds the results of a complete run to t = 0.5 s, and this one ends at 0.3 s (name another \
             folder with --out, or replace them with --force)\n"
        )
    );
    assert!(before == files(&place, "results"));

    // One that stops early: the bodies meet.
    let meeting = changed("velocity = [0.1, 0.0]", "velocity = [0.0, 20.0]");
    place.put("scene.toml", &meeting);
    let done = place.run();
    assert_eq!(done.code, Some(3), "{}", done.err);
    assert!(
        done.err.contains("results holds the results of a complete run to t = 0.5 s, which are kept"),
        "{}",
        done.err
    );
    assert!(before == files(&place, "results"));
    assert!(place.read("results-stopped/report.html").contains("stopped early"));

    let done = place.nekton(&["run", "scene.toml", "--out", "results", "--force"]);
    assert_eq!(done.code, Some(3));
    assert!(place.read("results/report.html").contains("stopped early"));
    // What stopped early may be replaced.
    place.put("scene.toml", changed("duration = 0.5", "duration = 0.3"));
    assert_eq!(place.run().code, Some(0));
}

#[test]
fn without_a_checkpoint_a_run_that_may_resume_begins_at_its_start() {
    let place = Place::new(&changed("", ""));
    let done = place.nekton(&[&KEPT[..], &["--resume"]].concat());
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    assert!(done.out.contains("there is no checkpoint yet"), "{}", done.out);
    for wrong in
        [&["--resume"][..], &["--checkpoint", "kept", "--every", "soon"], &["--checkpoint", "kept", "--error", "1e-3"]]
    {
        let done = place.nekton(&[&["run", "scene.toml", "--out", "other"], wrong].concat());
        assert_eq!(done.code, Some(2), "{wrong:?}");
    }
    let file = place.nekton(&["run", "scene.toml", "--out", "other", "--checkpoint", "scene.toml"]);
    assert!(file.code == Some(2) && file.err.contains("is not a folder"), "{}", file.err);
}
