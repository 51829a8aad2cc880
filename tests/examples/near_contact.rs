//! Errors of added mass and force near contact against a run with many nodes: the table of docs/accuracy.md, as CSV.
//! Arguments: parts of the cases' names (none: all).

use nekton::scene::Quadrature;
use nekton_tests::near::{CASES, error};

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    println!("case,gap,nodes,error_mass,error_force,indicator_mass,indicator_force");
    for case in CASES.iter().filter(|c| wanted.is_empty() || wanted.iter().any(|w| c.name.contains(w.as_str()))) {
        let far = case.name.starts_with("tank");
        let most = if far { 1 } else { 5 };
        for gap in [0.1, 1e-2, 1e-3, 1e-4, 1e-5].into_iter().take(most) {
            let shift = if far { 0.0 } else { case.shift(gap) };
            let (m, f, _) = case.values(shift, 320, Quadrature::Graded);
            for nodes in [32, 48, 64, 96, 128, 160, 192] {
                let Ok((mass, force, r)) = case.try_values(shift, nodes, Quadrature::Graded) else {
                    println!("\"{}\",{gap:e},{nodes},refused,refused,,", case.name);
                    continue;
                };
                let [em, ef] = [error(&mass, &m), error(&force, &f)];
                println!("\"{}\",{gap:e},{nodes},{em:.1e},{ef:.1e},{:.1e},{:.1e}", case.name, r[0], r[1]);
            }
        }
    }
}
