//! Writes the tables of the extremes to the folder given: `cargo run --release -p nekton-tests --example extremes docs/accuracy`; one
//! table if it is named after that; of `long_run` the runs of one motion, method and precision if these are named too.

use nekton_tests::extremes::*;
use nekton_tests::long_run::{drift_table, step_table};

type Table = (&'static str, &'static str, Vec<f64>, fn(f64) -> Case);

fn powers(from: i32, to: i32) -> Vec<f64> {
    (from..=to).map(|k| 10f64.powi(k)).collect()
}

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = std::path::PathBuf::from(arguments.next().unwrap_or_else(|| ".".into()));
    let only = arguments.next();
    let ratios = powers(-6, 6).into_iter().chain([f64::INFINITY]).collect();
    let tables: [Table; 10] = [
        ("gap", "gap_in_sizes", (1..=7).map(|k| 10f64.powi(-k)).collect(), gap),
        ("aspect", "aspect_ratio", vec![1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0], aspect),
        ("density", "density_ratio", ratios, density),
        ("length_same_durations", "length_m", powers(-6, 6), |l| scale(l, 1.0)),
        ("length_same_speeds", "length_m", powers(-6, 6), |l| scale(l, l)),
        ("bodies", "bodies", [1, 2, 5, 10, 20, 50].map(f64::from).to_vec(), |n| bodies(n as usize)),
        ("tank", "gap_in_radii", vec![3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4], tank),
        ("circulation", "circulation_by_speed_and_size", powers(-2, 6), circulation),
        ("spin", "spin_by_translation", powers(1, 6), spin),
        ("repulsion", "exponent", (1..=12).map(f64::from).collect(), repulsion),
    ];
    let names: Vec<&str> = tables.iter().map(|t| t.0).chain(["steps", "long_run"]).collect();
    if let Some(unknown) = only.as_deref().filter(|o| !names.contains(o)) {
        eprintln!("no table `{unknown}`; there are {}", names.join(", "));
        std::process::exit(2);
    }
    for (name, parameter, values, case) in tables {
        if only.as_deref().is_some_and(|o| o != name) {
            continue;
        }
        let rows: Vec<Row> = values.into_iter().flat_map(|x| case(x).rows(x)).collect();
        let text = csv(parameter, &rows);
        println!("{name}\n{text}");
        std::fs::write(folder.join(format!("extremes_{name}.csv")), text)?;
    }
    let wanted = |name: &str| only.as_deref().is_none_or(|o| o == name);
    if wanted("steps") {
        let mut text = String::new();
        step_table(&mut text, 10_000);
        println!("steps\n{text}");
        std::fs::write(folder.join("extremes_steps.csv"), text)?;
    }
    if wanted("long_run") {
        let path = folder.join("extremes_long_run.csv");
        let runs: [Option<String>; 3] = std::array::from_fn(|_| arguments.next());
        let old = if runs[0].is_some() { std::fs::read_to_string(&path)? } else { String::new() };
        let text = drift_table(&old, runs.each_ref().map(Option::as_deref), &mut |text| {
            if let Err(error) = std::fs::write(&path, text) {
                eprintln!("{}: {error}", path.display());
            }
        });
        println!("long_run\n{text}");
    }
    Ok(())
}
