//! Ladders of nodes appear and vanish while bodies move; what is computed must not jump by more than it is wrong.

use nekton_tests::regrading::{largest_jump, paths};

#[test]
fn regrading_does_not_kick() {
    for (k, path) in paths().iter().enumerate() {
        for nodes in [24, 48] {
            let jump = largest_jump(path, nodes, 200, 4);
            println!("{}, {nodes} nodes: {:.1e} of the indicator; {jump:?}", path.name, jump.ratio());
            // Measured: up to 4 times the indicator, a 25th of the bound; between ellipses there is none.
            let allowed = if k < 4 { 0.0 } else { 10.0 * jump.indicator };
            assert!(jump.mass.max(jump.force) <= allowed + 1e-13, "{}, {nodes} nodes: {jump:?}", path.name);
        }
    }
}
