//! Accuracy where boundaries nearly touch: added mass, force, circulation, and motion through near contact.

use nekton::Sim;
use nekton::scene::{Body, Link, Mass, Quadrature, Scene, Shape};
use nekton_tests::near::{case, error};
use nekton_tests::*;

/// Case, nodes per boundary, gap, allowed relative errors of the added mass and of the force.
const TABLE: &[(&str, usize, f64, f64, f64)] = &[
    ("two discs", 64, 1e-1, 1e-14, 1e-13),
    ("two discs", 64, 1e-3, 3e-14, 2e-12),
    ("two discs", 64, 1e-5, 1e-12, 2e-9),
    ("two discs, turned", 64, 1e-3, 3e-14, 1e-11),
    ("two discs, turned", 64, 1e-5, 1e-12, 2e-9),
    ("ellipses 1:.5 and .7:.4", 64, 1e-1, 1e-14, 3e-14),
    ("ellipses 1:.5 and .7:.4", 64, 1e-3, 2e-13, 4e-12),
    ("ellipses 1:.5 and .7:.4", 64, 1e-5, 1e-10, 1e-9),
    ("ellipse at a tank wall", 96, 1e-1, 1e-14, 1e-13),
    ("ellipse at a tank wall", 96, 1e-3, 1e-13, 1e-11),
    ("ellipse at a tank wall", 96, 1e-5, 1e-11, 1e-8),
    ("three bodies", 96, 1e-1, 1e-14, 1e-13),
    ("three bodies", 96, 1e-3, 1e-13, 1e-11),
    ("three bodies", 96, 1e-5, 1e-11, 1e-8),
    ("1:10 face to face", 96, 1e-1, 1e-12, 1e-11),
    ("1:10 face to face", 96, 1e-3, 1e-11, 1e-9),
    ("1:10 face to face", 96, 1e-5, 1e-8, 1e-7),
    ("1:10 oblique", 96, 1e-1, 1e-12, 1e-11),
    ("1:10 oblique", 96, 1e-3, 1e-11, 1e-9),
    ("1:10 oblique", 96, 1e-5, 1e-8, 1e-7),
    ("1:100 face to face", 192, 1e-1, 1e-11, 1e-11),
    ("1:100 face to face", 192, 1e-3, 1e-10, 1e-9),
    ("rectangles side by side", 160, 1e-1, 1e-11, 1e-10),
    ("rectangles side by side", 160, 1e-3, 1e-9, 1e-8),
    ("swimmer beside corners", 160, 1e-1, 1e-10, 1e-9),
    ("swimmer beside corners", 160, 1e-3, 3e-10, 1e-9),
    ("swimmer beside corners", 160, 1e-5, 1e-9, 1e-8),
    ("tank, obstacle, two ellipses", 64, 0.0, 1e-14, 1e-13),
];

#[test]
fn added_mass_and_force_near_contact_are_as_accurate_as_the_table_says() {
    let mut missed = Vec::new();
    for &(name, nodes, gap, mass_bound, force_bound) in TABLE {
        let case = case(name);
        let shift = if gap > 0.0 { case.shift(gap) } else { 0.0 };
        let (mass, force, _) = case.values(shift, nodes, Quadrature::Graded);
        let (m, f, _) = case.values(shift, nodes * 3 / 2, Quadrature::Graded);
        let (em, ef) = (error(&mass, &m), error(&force, &f));
        println!("{name}, {nodes} nodes, gap {gap:e}: {em:.1e} {ef:.1e}");
        if !(em <= mass_bound && ef <= force_bound) {
            missed.push(format!("{name}, {nodes} nodes, gap {gap:e}: {em:.1e} {ef:.1e}"));
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}

/// Added mass of the relative motion along the line of centres of two unit discs, per unit density: from the exact image
/// dipoles of either disc in the other.
fn discs_exact(gap: f64) -> f64 {
    // Both move towards each other at unit speed: a plane of symmetry. The dipole of strength 1 at the centre has the images
    // μ_{n+1} = μ_n/d_n² at distance 1/d_n from the centres.
    let distance = 2.0 + gap;
    let (mut strength, mut place, mut sum) = (1.0f64, 0.0, 0.0);
    loop {
        sum += strength;
        let d = distance - place;
        strength /= d * d;
        place = 1.0 / d;
        if strength < 1e-18 * sum {
            break;
        }
    }
    // Kinetic energy of both: ½ m (1 + 1), m = π (2 Σμ − 1).
    std::f64::consts::PI * (2.0 * sum - 1.0)
}

#[test]
fn added_mass_of_two_discs_is_that_of_their_image_dipoles_down_to_tiny_gaps() {
    for (gap, bound) in
        [(1e-1, 1e-14), (1e-2, 1e-14), (1e-3, 3e-14), (1e-4, 3e-13), (1e-5, 3e-12), (1e-6, 3e-11), (1e-7, 3e-10)]
    {
        let (mass, _, _) = case("two discs").values(gap, 64, Quadrature::Graded);
        // (1, 0, 0, −1, 0, 0) M (1, 0, 0, −1, 0, 0)ᵀ/2
        let m = |i: usize, j: usize| mass[6 * j + i];
        let relative = 0.5 * (m(0, 0) - m(0, 3) - m(3, 0) + m(3, 3));
        let exact = discs_exact(gap);
        println!("gap {gap:e}: {:.1e}", (relative / exact - 1.0).abs());
        assert!((relative / exact - 1.0).abs() <= bound, "{relative} {exact}");
    }
}

#[test]
fn circulations_of_opposite_sign_near_contact_have_exact_energy_and_force() {
    // γ = ±1 about two unit discs: T = cosh⁻¹(1 + d/2) · γ²/2π + constant (bipolar coordinates); the force is its derivative.
    let energy = |gap: f64| {
        case("two discs").at(gap, 64, Quadrature::Graded, &[1.0, -1.0], |sim| {
            (sim.energy().unwrap().circulation, vector(sim, |s, out| s.circulation_gradient(out)))
        })
    };
    let exact = |d: f64| (d / 2.0 + (d + d * d / 4.0).sqrt()).ln_1p() / (2.0 * std::f64::consts::PI) * 1.0;
    let (reference, _) = energy(1.0);
    for gap in [1e-1, 1e-2, 1e-3] {
        let (t, gradient) = energy(gap);
        let difference = t - reference;
        let slope = 1.0 / (2.0 * std::f64::consts::PI) / 2.0 / (gap + gap * gap / 4.0).sqrt();
        println!("gap {gap:e}: {difference} {} force {} {slope}", exact(gap) - exact(1.0), gradient[3]);
        assert!((difference - (exact(gap) - exact(1.0))).abs() < 1e-12);
        assert!((gradient[3] / slope - 1.0).abs() < 1e-12, "{:e}", gradient[3] / slope - 1.0);
    }
}
