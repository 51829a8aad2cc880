//! Prints the largest jumps along all paths: `cargo run --release -p nekton-tests --example regrading > docs/accuracy/regrading.csv`.

use nekton_tests::regrading::{largest_jump, paths};

fn main() {
    println!("path,nodes,at,jump_mass,jump_force,indicator,jump_by_indicator");
    for path in paths() {
        for nodes in [16, 24, 32, 48, 64] {
            let j = largest_jump(&path, nodes, 1000, 20);
            println!(
                "{},{nodes},{:.6},{:.1e},{:.1e},{:.1e},{:.2}",
                path.name.replace(',', ""),
                j.at,
                j.mass,
                j.force,
                j.indicator,
                j.ratio()
            );
        }
    }
}
