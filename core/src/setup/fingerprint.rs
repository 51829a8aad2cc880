//! A number that tells scenes apart: of every field of every definition, and of the nodes that were chosen.
//!
//! Each definition is taken apart without `..`, so that a new field cannot be forgotten. Cases are numbered and lists begin with their
//! lengths: no two descriptions are the same sequence of words. Numbers that are not used (the velocity of a prescribed root) count too.
//!
//! Tested by the tests at its end, `tests/saving`.

use crate::base::digest::Digest;
use crate::base::scalar::Real;
use crate::scene::{
    Body, CirculationModel, Corners, Description, Drive, ForceFormula, Harmonic, Joint, JointKind, Link, Mass,
    Quadrature, Repulsion, Root, Scene, Shape, Signal, Wall, Window,
};
use crate::setup::items::items;

/// The fingerprint of a scene: of two that differ in a bit it is the same by chance only, once in 2⁶⁴. The same on every machine. 0 and
/// −0 differ, and so do both precisions.
pub(crate) fn fingerprint<R: Real, S: Description<R>>(scene: &S) -> u64 {
    let mut digest = Digest::new();
    let d = &mut digest;
    d.count(size_of::<R>());
    settings(d, &scene.settings());
    optional(d, scene.tank(), |d, tank| wall(d, &tank));
    list(d, scene.obstacle_count(), |d, i| optional(d, scene.obstacle(i), |d, obstacle| wall(d, &obstacle)));
    list(d, scene.body_count(), |d, b| {
        optional(d, scene.body(b), |d, own| body(d, &own));
        list(d, scene.link_count(b), |d, l| optional(d, scene.link(b, l), |d, own| link(d, &own)));
    });
    // What automatic counts came to.
    items(scene).for_each(|item| d.count(item.nodes));
    digest.value()
}

fn optional<T>(d: &mut Digest, value: Option<T>, add: impl FnOnce(&mut Digest, T)) {
    d.count(usize::from(value.is_some()));
    if let Some(value) = value {
        add(d, value);
    }
}

fn list(d: &mut Digest, count: usize, mut add: impl FnMut(&mut Digest, usize)) {
    d.count(count);
    (0..count).for_each(|i| add(d, i));
}

fn reals<R: Real, const N: usize>(d: &mut Digest, values: [R; N]) {
    values.into_iter().for_each(|x| d.real(x));
}

fn settings<R: Real>(d: &mut Digest, scene: &Scene<'_, R>) {
    let Scene {
        fluid_density,
        gravity,
        repulsion,
        circulation,
        // Walls and bodies come one by one.
        tank: _,
        obstacles: _,
        bodies: _,
        force,
        quadrature,
        tolerance,
        allow_unresolved,
        shortcuts,
    } = *scene;
    reals(d, [fluid_density, gravity]);
    optional(d, repulsion, |d, Repulsion { alpha, epsilon }| reals(d, [alpha, epsilon]));
    d.count(match circulation {
        CirculationModel::Full => 0,
        CirculationModel::Paper => 1,
    });
    d.count(match force {
        ForceFormula::ExactGradient => 0,
        ForceFormula::Boundary => 1,
    });
    d.count(match quadrature {
        Quadrature::Graded => 0,
        Quadrature::Plain => 1,
    });
    optional(d, tolerance, |d, x| d.real(x));
    d.count(usize::from(allow_unresolved));
    d.count(usize::from(shortcuts));
}

fn wall<R: Real>(d: &mut Digest, wall: &Wall<'_, R>) {
    let Wall { shape: outline, position, angle, nodes, circulation } = wall;
    shape(d, outline);
    reals(d, *position);
    reals(d, [*angle, *circulation]);
    d.count(*nodes);
}

fn body<R: Real>(d: &mut Digest, body: &Body<'_, R>) {
    // Links come one by one.
    let Body { pose, velocity, root, links: _ } = body;
    reals(d, *pose);
    reals(d, *velocity);
    match root {
        Root::Free => d.count(0),
        Root::Prescribed(signals) => {
            d.count(1);
            signals.iter().for_each(|s| signal(d, s));
        }
    }
}

fn link<R: Real>(d: &mut Digest, link: &Link<'_, R>) {
    let Link { shape: outline, mass, nodes, circulation, joint: held } = link;
    shape(d, outline);
    match *mass {
        Mass::Density(density) => {
            d.count(0);
            d.real(density);
        }
        Mass::Given { mass, inertia, centre_of_mass } => {
            d.count(1);
            reals(d, [mass, inertia]);
            reals(d, centre_of_mass);
        }
    }
    d.count(*nodes);
    d.real(*circulation);
    optional(d, held.as_ref(), joint);
}

fn joint<R: Real>(d: &mut Digest, joint: &Joint<'_, R>) {
    let Joint { parent, kind, parent_anchor, self_anchor, drive } = joint;
    d.count(*parent);
    match *kind {
        JointKind::Hinge => d.count(0),
        JointKind::Slider { axis, angle } => {
            d.count(1);
            reals(d, axis);
            d.real(angle);
        }
    }
    reals(d, *parent_anchor);
    reals(d, *self_anchor);
    match drive {
        Drive::Locked(value) => {
            d.count(0);
            d.real(*value);
        }
        Drive::Motion(motion) => {
            d.count(1);
            signal(d, motion);
        }
        Drive::Torque { torque, stiffness, damping, rest, start } => {
            d.count(2);
            signal(d, torque);
            reals(d, [*stiffness, *damping, *rest]);
            reals(d, *start);
        }
    }
}

fn signal<R: Real>(d: &mut Digest, signal: &Signal<'_, R>) {
    match signal {
        Signal::Constant(value) => {
            d.count(0);
            d.real(*value);
        }
        Signal::Harmonic { terms, window } => {
            d.count(1);
            d.count(terms.len());
            for Harmonic { amplitude, frequency, phase, offset } in *terms {
                reals(d, [*amplitude, *frequency, *phase, *offset]);
            }
            optional(d, window.as_ref(), |d, Window { from, to, ramp }| reals(d, [*from, *to, *ramp]));
        }
        Signal::Table(rows) => {
            d.count(2);
            d.count(rows.len());
            rows.iter().for_each(|row| reals(d, *row));
        }
        Signal::Channel => d.count(3),
    }
}

fn shape<R: Real>(d: &mut Digest, shape: &Shape<'_, R>) {
    let points = |d: &mut Digest, points: &[[R; 2]]| {
        d.count(points.len());
        points.iter().for_each(|p| reals(d, *p));
    };
    match *shape {
        Shape::Ellipse { a, b } => {
            d.count(0);
            reals(d, [a, b]);
        }
        Shape::Star { radius, amplitude, lobes } => {
            d.count(1);
            reals(d, [radius, amplitude]);
            d.count(lobes);
        }
        Shape::Rectangle { width, height, radius } => {
            d.count(2);
            reals(d, [width, height]);
            optional(d, radius, |d, r| d.real(r));
        }
        Shape::Polygon { vertices, radius } => {
            d.count(3);
            points(d, vertices);
            optional(d, radius, |d, r| d.real(r));
        }
        Shape::Curve { points: through, corners } => {
            d.count(4);
            points(d, through);
            match corners {
                Corners::Auto => d.count(0),
                Corners::None => d.count(1),
                Corners::At(list) => {
                    d.count(2);
                    d.count(list.len());
                    list.iter().for_each(|k| d.count(*k));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Gives values out one by one and changes the one whose number it was told.
    struct Changes {
        given: usize,
        change: usize,
    }

    impl Changes {
        fn pick<T>(&mut self, usual: T, other: T) -> T {
            self.given += 1;
            if self.given == self.change { other } else { usual }
        }
        /// The change is in the last bit.
        fn x<R: Real>(&mut self, x: f64) -> R {
            let x = R::lit(x);
            self.pick(x, R::from_word(x.to_word() ^ 1))
        }
        fn xs<R: Real, const N: usize>(&mut self, values: [f64; N]) -> [R; N] {
            values.map(|x| self.x(x))
        }
        fn joint<'a, R: Real>(&mut self, kind: JointKind<R>, drive: Drive<'a, R>) -> Joint<'a, R> {
            Joint {
                parent: self.pick(0, 1),
                kind,
                parent_anchor: self.xs([-1.3, 0.1]),
                self_anchor: self.xs([1.3, 0.2]),
                drive,
            }
        }
        fn link<'a, R: Real>(
            &mut self,
            shape: Shape<'a, R>,
            mass: Mass<R>,
            joint: Option<Joint<'a, R>>,
        ) -> Link<'a, R> {
            Link {
                shape,
                mass,
                nodes: self.pick(16, 18),
                circulation: self.x(0.3),
                joint: joint.and_then(|j| self.pick(Some(j), None)),
            }
        }
        fn wall<'a, R: Real>(&mut self, shape: Shape<'a, R>) -> Wall<'a, R> {
            Wall {
                shape,
                position: self.xs([0.5, 0.6]),
                angle: self.x(0.7),
                nodes: self.pick(20, 22),
                circulation: self.x(0.1),
            }
        }
    }

    /// The fingerprint of a scene with every case of every definition, the change of that number made (0: none), and how many changes
    /// there are. Structs are written without `..`: the compiler asks for a new field.
    fn print<R: Real>(change: usize) -> (u64, usize) {
        let c = &mut Changes { given: 0, change };
        let mut term = || Harmonic::<R> { amplitude: c.x(0.3), frequency: c.x(2.0), phase: c.x(0.1), offset: c.x(0.2) };
        let terms = [term(), term()];
        let rows: [[R; 4]; 2] = [c.xs([0.0, 0.1, 0.0, 0.2]), c.xs([1.0, 0.3, 0.1, 0.0])];
        let window = Some(Window { from: c.x(0.5), to: c.x(4.0), ramp: c.x(0.7) });
        let window = c.pick(window, None);
        let harmonic = Signal::Harmonic { terms: c.pick(&terms[..], &terms[..1]), window };
        let table = Signal::Table(c.pick(&rows[..], &rows[..1]));
        let table = c.pick(table, Signal::Channel);
        let constant = Signal::Constant(c.x(0.4));
        let constant = c.pick(constant, Signal::Harmonic { terms: &[], window: None });

        let corners: [[R; 2]; 3] = [c.xs([1.0, 0.5]), c.xs([-1.0, 0.5]), c.xs([0.0, -0.5])];
        let (all, fewer) = (&corners[..], &corners[..2]);
        let (a, b) = (c.x(1.0), c.x(0.4));
        let ellipse = c.pick(Shape::Ellipse { a, b }, Shape::Rectangle { width: a, height: b, radius: None });
        let star = Shape::Star { radius: c.x(1.0), amplitude: c.x(0.2), lobes: c.pick(3, 4) };
        let radius = Some(c.x(0.1));
        let rectangle = Shape::Rectangle { width: c.x(1.0), height: c.x(0.4), radius: c.pick(radius, None) };
        let radius = Some(c.x(0.1));
        let polygon = Shape::Polygon { vertices: c.pick(all, fewer), radius: c.pick(radius, None) };
        let given = c.pick(Corners::At(&[0, 2]), Corners::At(&[1]));
        let corners = c.pick(given, Corners::Auto);
        let curve = Shape::Curve { points: c.pick(all, fewer), corners };
        let curve = c.pick(curve, Shape::Polygon { vertices: all, radius: None });
        let density = Mass::Density(c.x(1.2));
        let given = Mass::Given { mass: c.x(1.2), inertia: c.x(0.3), centre_of_mass: c.xs([0.1, 0.2]) };

        let hinge = JointKind::Hinge;
        let slider = JointKind::Slider { axis: c.xs([1.0, 0.5]), angle: c.x(0.2) };
        let locked = R::lit(0.4);
        let locked = c.pick(Drive::Locked(locked), Drive::Motion(Signal::Constant(locked)));
        let value = Drive::Locked(c.x(0.4));
        let torque = Drive::Torque {
            torque: constant,
            stiffness: c.x(2.0),
            damping: c.x(0.5),
            rest: c.x(0.1),
            start: c.xs([0.2, 0.3]),
        };
        let joints = [
            c.joint(hinge, Drive::Motion(harmonic)),
            c.joint(slider, Drive::Motion(table)),
            c.joint(hinge, torque),
            c.joint(hinge, locked),
            c.joint(hinge, value),
        ];
        let links = [
            c.link(ellipse, density, None),
            c.link(star, given, Some(joints[0])),
            c.link(rectangle, density, Some(joints[1])),
            c.link(polygon, density, Some(joints[2])),
            c.link(curve, density, Some(joints[3])),
            c.link(ellipse, density, Some(joints[4])),
        ];
        // A link may change its body.
        let first = c.pick(5, 4);
        let roots = Root::Prescribed([Signal::Constant(c.x(0.1)), Signal::Channel, Signal::Constant(c.x(0.2))]);
        let bodies = [
            Body {
                pose: c.xs([0.1, 0.2, 0.3]),
                velocity: c.xs([0.4, 0.5, 0.6]),
                root: c.pick(roots, Root::Free),
                links: &links[..first],
            },
            Body {
                pose: c.xs([3.1, 0.2, 0.3]),
                velocity: c.xs([0.4, 0.5, 0.6]),
                root: Root::Free,
                links: &links[first..],
            },
        ];
        let tank = c.wall(ellipse);
        let obstacles = [c.wall(star), c.wall(polygon)];
        let repulsion = Some(Repulsion { alpha: c.x(3.0), epsilon: c.x(0.02) });
        let tolerance = Some(c.x(1e-3));
        let scene = Scene {
            fluid_density: c.x(1.0),
            gravity: c.x(9.81),
            repulsion: c.pick(repulsion, None),
            circulation: c.pick(CirculationModel::Full, CirculationModel::Paper),
            tank: c.pick(Some(tank), None),
            obstacles: c.pick(&obstacles[..], &obstacles[1..]),
            bodies: c.pick(&bodies[..], &bodies[..1]),
            force: c.pick(ForceFormula::ExactGradient, ForceFormula::Boundary),
            quadrature: c.pick(Quadrature::Graded, Quadrature::Plain),
            tolerance: c.pick(tolerance, None),
            allow_unresolved: c.pick(true, false),
            shortcuts: c.pick(true, false),
        };
        (fingerprint(&scene), c.given)
    }

    fn every_change_is_seen<R: Real>() {
        let (usual, changes) = print::<R>(0);
        assert_eq!((usual, changes), print::<R>(0));
        assert!(changes > 140, "{changes}");
        let mut seen = BTreeMap::from([(usual, 0)]);
        for change in 1..=changes {
            if let Some(other) = seen.insert(print::<R>(change).0, change) {
                panic!("change {change} gives the fingerprint of change {other}");
            }
        }
    }

    #[test]
    fn every_change_of_every_field_changes_the_fingerprint() {
        every_change_is_seen::<f64>();
        every_change_is_seen::<f32>();
    }

    #[test]
    fn a_term_that_goes_over_to_the_next_motion_changes_the_fingerprint() {
        use crate::scene::{Harmonic, Signal};
        let term = |frequency| Harmonic { amplitude: 0.5, frequency, phase: 0.0, offset: 0.0 };
        let terms = [term(1.0), term(2.0), term(3.0)];
        let of = |first: usize| {
            let (one, other) = terms.split_at(first);
            let signal = |terms| Signal::Harmonic { terms, window: None };
            let root = Root::Prescribed([signal(one), signal(other), Signal::Constant(0.0)]);
            let shape = Shape::Ellipse { a: 1.0, b: 0.5 };
            let links = [Link { shape, mass: Mass::Density(1.0), nodes: 16, circulation: 0.0, joint: None }];
            let bodies = [Body { pose: [0.0; 3], velocity: [0.0; 3], root, links: &links }];
            fingerprint(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) })
        };
        assert_ne!(of(1), of(2));
    }

    #[test]
    fn precisions_automatic_counts_and_the_sign_of_zero_are_told_apart() {
        fn of<R: Real>(nodes: usize, angle: f64) -> u64 {
            let shape = Shape::Ellipse { a: R::one(), b: R::HALF };
            let links = [Link { shape, mass: Mass::Density(R::one()), nodes, circulation: R::zero(), joint: None }];
            let pose = [R::zero(), R::zero(), R::lit(angle)];
            let bodies = [Body { pose, velocity: [R::zero(); 3], root: Root::Free, links: &links }];
            fingerprint(&Scene { bodies: &bodies, ..Scene::new(R::one(), R::zero()) })
        }
        let chosen = crate::setup::automatic_nodes::nodes(&Shape::Ellipse { a: 1.0, b: 0.5 }, 1e-8, Quadrature::Graded);
        let all = [of::<f64>(0, 0.0), of::<f64>(chosen, 0.0), of::<f64>(0, -0.0), of::<f32>(0, 0.0)];
        for (i, x) in all.iter().enumerate() {
            assert!(!all[..i].contains(x), "{i}");
        }
    }
}
