//! A scene in single precision.

use nekton::scene::{
    Body, Corners, Drive, Harmonic, Joint, JointKind, Link, Mass, Repulsion, Root, Scene, Shape, Signal, Wall, Window,
};

/// The same scene, every number rounded. What it refers to is kept until the process ends: a command converts one scene, once.
pub fn single(scene: &Scene<'_, f64>) -> Scene<'static, f32> {
    Scene {
        fluid_density: scene.fluid_density as f32,
        gravity: scene.gravity as f32,
        repulsion: scene.repulsion.map(|r| Repulsion { alpha: r.alpha as f32, epsilon: r.epsilon as f32 }),
        circulation: scene.circulation,
        tank: scene.tank.as_ref().map(wall),
        obstacles: keep(scene.obstacles, wall),
        bodies: keep(scene.bodies, |b| Body {
            pose: b.pose.map(|x| x as f32),
            velocity: b.velocity.map(|x| x as f32),
            root: match &b.root {
                Root::Free => Root::Free,
                Root::Prescribed(signals) => Root::Prescribed(signals.each_ref().map(signal)),
            },
            links: keep(b.links, link),
        }),
        force: scene.force,
        quadrature: scene.quadrature,
        tolerance: scene.tolerance.map(|x| x as f32),
        allow_unresolved: scene.allow_unresolved,
        shortcuts: scene.shortcuts,
    }
}

fn keep<A, B>(list: &[A], convert: impl Fn(&A) -> B) -> &'static [B] {
    Vec::leak(list.iter().map(convert).collect())
}

fn points(list: &[[f64; 2]]) -> &'static [[f32; 2]] {
    keep(list, |p| p.map(|x| x as f32))
}

fn wall(w: &Wall<'_, f64>) -> Wall<'static, f32> {
    Wall {
        shape: shape(&w.shape),
        position: w.position.map(|x| x as f32),
        angle: w.angle as f32,
        nodes: w.nodes,
        circulation: w.circulation as f32,
    }
}

fn shape(s: &Shape<'_, f64>) -> Shape<'static, f32> {
    match *s {
        Shape::Ellipse { a, b } => Shape::Ellipse { a: a as f32, b: b as f32 },
        Shape::Star { radius, amplitude, lobes } => {
            Shape::Star { radius: radius as f32, amplitude: amplitude as f32, lobes }
        }
        Shape::Rectangle { width, height, radius } => {
            Shape::Rectangle { width: width as f32, height: height as f32, radius: radius.map(|r| r as f32) }
        }
        Shape::Polygon { vertices, radius } => {
            Shape::Polygon { vertices: points(vertices), radius: radius.map(|r| r as f32) }
        }
        Shape::Curve { points: list, corners } => Shape::Curve {
            points: points(list),
            corners: match corners {
                Corners::At(at) => Corners::At(at.to_vec().leak()),
                Corners::Auto => Corners::Auto,
                Corners::None => Corners::None,
            },
        },
    }
}

fn link(l: &Link<'_, f64>) -> Link<'static, f32> {
    Link {
        shape: shape(&l.shape),
        mass: match l.mass {
            Mass::Density(density) => Mass::Density(density as f32),
            Mass::Given { mass, inertia, centre_of_mass } => Mass::Given {
                mass: mass as f32,
                inertia: inertia as f32,
                centre_of_mass: centre_of_mass.map(|x| x as f32),
            },
        },
        nodes: l.nodes,
        circulation: l.circulation as f32,
        joint: l.joint.as_ref().map(|j| Joint {
            parent: j.parent,
            kind: match j.kind {
                JointKind::Hinge => JointKind::Hinge,
                JointKind::Slider { axis, angle } => {
                    JointKind::Slider { axis: axis.map(|x| x as f32), angle: angle as f32 }
                }
            },
            parent_anchor: j.parent_anchor.map(|x| x as f32),
            self_anchor: j.self_anchor.map(|x| x as f32),
            drive: drive(&j.drive),
        }),
    }
}

fn drive(d: &Drive<'_, f64>) -> Drive<'static, f32> {
    match d {
        Drive::Locked(value) => Drive::Locked(*value as f32),
        Drive::Motion(s) => Drive::Motion(signal(s)),
        Drive::Torque { torque, stiffness, damping, rest, start } => Drive::Torque {
            torque: signal(torque),
            stiffness: *stiffness as f32,
            damping: *damping as f32,
            rest: *rest as f32,
            start: start.map(|x| x as f32),
        },
    }
}

fn signal(s: &Signal<'_, f64>) -> Signal<'static, f32> {
    match s {
        Signal::Constant(value) => Signal::Constant(*value as f32),
        Signal::Harmonic { terms, window } => Signal::Harmonic {
            terms: keep(terms, |h| Harmonic {
                amplitude: h.amplitude as f32,
                frequency: h.frequency as f32,
                phase: h.phase as f32,
                offset: h.offset as f32,
            }),
            window: window.map(|w| Window { from: w.from as f32, to: w.to as f32, ramp: w.ramp as f32 }),
        },
        Signal::Table(rows) => Signal::Table(keep(rows, |r| r.map(|x| x as f32))),
        Signal::Channel => Signal::Channel,
    }
}
