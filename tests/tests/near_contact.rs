//! Accuracy where boundaries nearly touch: added mass, force, circulation, and motion through near contact.

use nekton::scene::{Quadrature, Repulsion, Scene, Shape};
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

/// The passage of the paper's section 9.2 to t = 10: where both bodies are, drift of the energy relative to it, evaluations.
fn passage(nodes: usize, quadrature: Quadrature, tolerance: f64) -> (Vec<f64>, f64, u64) {
    let links = [link(Shape::Ellipse { a: 2.0, b: 0.9 }, 1.0, nodes)];
    let bodies = two_ellipses(&links);
    let mut sim = simulation(&Scene { quadrature, bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(tolerance));
    let mut sim = sim.view();
    let start = sim.energy().unwrap().total;
    let mut drift = 0.0f64;
    for k in 1..=20 {
        sim.advance_dense(0.5 * f64::from(k), 10.0).unwrap();
        drift = drift.max((sim.energy().unwrap().total / start - 1.0).abs());
    }
    (sim.positions().to_vec(), drift, sim.counters().evaluations)
}

#[test]
fn passage_of_two_ellipses_needs_few_nodes_and_evaluations() {
    let (exact, _, _) = passage(72, Quadrature::Graded, 3e-13);
    for (nodes, bound, drift_bound) in [(24, 2e-7, 2e-7), (32, 1e-9, 1e-9), (40, 1e-11, 1e-11)] {
        let (at, drift, evaluations) = passage(nodes, Quadrature::Graded, 8e-13);
        let error = at.iter().zip(&exact).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        println!("{nodes} nodes: error {error:.1e}, energy {drift:.1e}, {evaluations} evaluations");
        assert!(
            error <= bound && drift <= drift_bound && evaluations < 700,
            "{nodes}: {error:e} {drift:e} {evaluations}"
        );
    }
}

/// ∂V/∂d of two unit discs at a gap: the inner integral by adaptive subdivision is not needed, a fine rule on both is.
fn repulsion_exact(gap: f64, alpha: f64) -> f64 {
    // V = ∬ |x − y|^(−α); by symmetry one disc's points at angle p, the other's at angle q from the line of centres.
    // Substitution p = sinh(u) β-wise resolves the contact: t = 2 atan(κ sinh u) covers a full turn.
    let nodes = |scale: f64| -> Vec<(f64, f64)> {
        let kappa = scale / 2.0;
        let (h, top) = (0.02, (1e9f64 / kappa).asinh());
        let n = (top / h) as i64;
        (-n..=n)
            .map(|k| {
                let u = k as f64 * h;
                let x = kappa * u.sinh();
                (2.0 * x.atan(), h * 2.0 * kappa * u.cosh() / (1.0 + x * x))
            })
            .collect()
    };
    let distance = 2.0 + gap;
    let outer = nodes(gap.sqrt());
    let mut sum = 0.0;
    for (p, wp) in outer {
        let (x, y) = (p.cos(), p.sin());
        // The point of the other disc that faces this one, and its distance.
        let (dx, dy) = (distance - x, y);
        let (r, q0) = (dx.hypot(dy), dy.atan2(dx));
        for (v, wq) in nodes(r - 1.0) {
            let q = q0 + v;
            let (ex, ey) = (distance - q.cos() - x, q.sin() - y);
            let square = ex * ex + ey * ey;
            sum += -alpha * square.powf(-alpha / 2.0 - 1.0) * ex * wp * wq;
        }
    }
    sum
}

#[test]
fn repulsion_near_contact_is_the_double_integral() {
    for (alpha, gap, bound) in [
        (1.0, 1e-1, 1e-9),
        (2.0, 1e-1, 1e-9),
        (4.0, 1e-1, 1e-9),
        (2.0, 1e-3, 1e-8),
        (4.0, 1e-3, 1e-8),
        (12.0, 1e-2, 1e-7),
        (4.0, 1e-5, 1e-6),
    ] {
        let links = [link(disc(1.0), 1.0, 64)];
        let bodies = [body(&links, [0.0; 3], [0.0; 3]), body(&links, [2.0 + gap, 0.0, 0.7], [0.0; 3])];
        let repulsion = Some(Repulsion { alpha, epsilon: 1.0 });
        let force =
            vector(&mut at_start(&Scene { repulsion, bodies: &bodies, ..Scene::new(1.0, 0.0) }).view(), |s, out| {
                s.repulsion(out)
            });
        let exact = repulsion_exact(gap, alpha);
        println!("exponent {alpha}, gap {gap:e}: {:.1e}", (force[3] / exact - 1.0).abs());
        assert!((force[3] / exact - 1.0).abs() <= bound, "{} {exact}", force[3]);
    }
}

/// Two bodies driven at each other, thrown back by the repulsion: smallest gap, largest drift of the energy, and its end.
fn bounce(shapes: [Shape<'_, f64>; 2], poses: [[f64; 3]; 2], epsilon: f64, nodes: usize) -> (f64, f64) {
    let links = shapes.map(|s| [link(s, 1.0, nodes)]);
    let bodies = [body(&links[0], poses[0], [0.5, 0.0, 0.0]), body(&links[1], poses[1], [-0.5, 0.0, 0.0])];
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon });
    let mut sim = simulation(&Scene { repulsion, bodies: &bodies, ..Scene::new(1.0, 0.0) }, adams(1e-12));
    let mut sim = sim.view();
    let start = sim.energy().unwrap().total;
    let (mut gap, mut drift) = (f64::MAX, 0.0f64);
    while sim.time() < 2.4 {
        sim.step().unwrap();
        gap = gap.min(sim.gap().distance);
        drift = drift.max((sim.energy().unwrap().total / start - 1.0).abs());
    }
    println!("{nodes} nodes: gap {gap:.1e}, energy {drift:.1e}, {:?}", sim.counters());
    (gap, drift)
}

#[test]
fn bounces_at_tiny_gaps_conserve_energy() {
    let discs = ([disc(1.0), disc(1.0)], [[0.0, 0.0, 0.3], [2.8, 0.0, -0.8]]);
    let oblique =
        ([Shape::Ellipse { a: 1.0, b: 0.5 }, Shape::Ellipse { a: 0.7, b: 0.4 }], [[0.0, 0.0, 0.4], [2.5, 0.3, 1.0]]);
    for ((shapes, poses), epsilon, most) in [(discs, 3e-8, 1.0e-3), (discs, 1e-10, 1.05e-4), (oblique, 1e-10, 3e-4)] {
        let (gap, drift) = bounce(shapes, poses, epsilon, 48);

        assert!(gap <= most && drift <= 1e-10, "gap {gap:e}: {drift:e}");
    }
}

/// Added mass of a body alone, per unit density.
fn alone(shape: Shape<'_, f64>, nodes: usize) -> Vec<f64> {
    let links = [link(shape, 1.0, nodes)];
    let bodies = [body(&links, [0.0; 3], [0.1, 0.2, 0.3])];
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) };
    matrix(&mut at_start(&scene).view(), |s, out| s.added_mass(out)).concat()
}

#[test]
fn thin_and_cornered_bodies_alone_need_few_nodes() {
    for b in [0.1, 0.01] {
        // Lamb: π b², π a², π (a² − b²)²/8.
        let (mass, pi) = (alone(Shape::Ellipse { a: 1.0, b }, 32), std::f64::consts::PI);
        let exact = [pi * b * b, 0.0, 0.0, 0.0, pi, 0.0, 0.0, 0.0, pi * (1.0 - b * b).powi(2) / 8.0];
        println!("1:{}: {:.1e}", 1.0 / b, error(&mass, &exact));
        assert!(error(&mass, &exact) <= 1e-13, "{:e}", error(&mass, &exact));
    }
    let square = Shape::Rectangle { width: 2.0, height: 2.0, radius: Some(0.02) };
    let square = error(&alone(square, 128), &alone(square, 256));
    println!("square: {square:.1e}");
    assert!(square <= 1e-11, "{square:e}");
}

#[test]
fn circulation_about_thin_bodies_is_as_accurate_as_about_fat_ones() {
    // The tip of one ellipse 1:10 on the flank of another.
    let evaluate = |nodes: usize| {
        let flat = Shape::Ellipse { a: 1.0, b: 0.1 };
        let links = [0.7, -1.2].map(|circulation| [nekton::scene::Link { circulation, ..link(flat, 1.0, nodes) }]);
        let quarter = std::f64::consts::FRAC_PI_2;
        let bodies = [
            body(&links[0], [0.0; 3], [0.1, 0.2, 0.3]),
            body(&links[1], [0.2, 0.1 + 0.1 + 1.0, quarter], [-0.3, 0.1, 0.2]),
        ];
        let mut sim = at_start(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) });
        vector(&mut sim.view(), |s, out| s.circulation_gradient(out))
    };
    let (few, many) = (evaluate(64), evaluate(128));
    println!("{:.1e}", error(&few, &many));
    assert!(error(&few, &many) <= 1e-13, "{:e}", error(&few, &many));
}
