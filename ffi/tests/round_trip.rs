//! What C gets is bit for bit what Rust gets.

mod common;

use nekton::scene::{
    Body, Drive, Harmonic, Joint, JointKind, Link, Mass, Repulsion, Root, Scene, Shape, Signal, Wall, Window,
};
use nekton::{Method, ModelBuf, SimBuf};
use nekton_ffi::types::*;
use std::sync::Arc;

macro_rules! round_trip {
    ($name:ident, $module:ident) => {
        #[test]
        fn $name() {
            use common::$module::*;
            let terms = [Harmonic { amplitude: 0.3 as Real, frequency: 2.0, phase: 0.4, offset: 0.1 }];
            let c_terms = [HarmonicDef { amplitude: 0.3 as Real, frequency: 2.0, phase: 0.4, offset: 0.1 }];
            let rows: [[Real; 4]; 2] = [[0.0, 0.2, 0.0, 0.0], [1.0, 0.5, 0.1, 0.0]];
            let corners: [[Real; 2]; 3] = [[0.0, 0.0], [0.6, 0.0], [0.2, 0.5]];
            let knots: [[Real; 2]; 5] = [[0.5, 0.0], [0.15, 0.45], [-0.4, 0.3], [-0.4, -0.3], [0.15, -0.45]];

            // The scene in Rust: every shape, every joint, every drive, walls, a prescribed root, all forces.
            let plain =
                |shape, joint| Link { shape, mass: Mass::Density(1.5 as Real), nodes: 32, circulation: 0.0, joint };
            let joint = |parent, kind, drive| {
                Some(Joint { parent, kind, parent_anchor: [0.9, 0.0], self_anchor: [-0.9, 0.0], drive })
            };
            let ellipse = Shape::Ellipse { a: 0.7, b: 0.2 };
            let window = Some(Window { from: -1.0 as Real, to: 3.0, ramp: 0.5 });
            let fish = [
                Link { circulation: 0.2, ..plain(ellipse, None) },
                plain(ellipse, joint(0, JointKind::Hinge, Drive::Motion(Signal::Harmonic { terms: &terms, window }))),
                plain(
                    ellipse,
                    joint(
                        1,
                        JointKind::Hinge,
                        Drive::Torque {
                            torque: Signal::Channel,
                            stiffness: 0.3,
                            damping: 0.1,
                            rest: 0.05,
                            start: [0.1, 0.2],
                        },
                    ),
                ),
            ];
            let train = [
                plain(Shape::Rectangle { width: 0.8, height: 0.4, radius: Some(0.1) }, None),
                Link {
                    mass: Mass::Given { mass: 0.4, inertia: 0.02, centre_of_mass: [0.05, 0.0] },
                    ..plain(
                        Shape::Star { radius: 0.3, amplitude: 0.2, lobes: 3 },
                        joint(
                            0,
                            JointKind::Slider { axis: [1.0, 0.2], angle: 0.3 },
                            Drive::Motion(Signal::Table(&rows)),
                        ),
                    )
                },
                plain(Shape::curve(&knots), joint(0, JointKind::Hinge, Drive::Locked(2.0))),
            ];
            let given = Root::Prescribed([
                Signal::Constant(0.0),
                Signal::Harmonic { terms: &terms, window: None },
                Signal::Constant(0.0),
            ]);
            let bodies = [
                Body { pose: [-1.0, 1.5, 0.1], velocity: [0.1, 0.0, 0.2], root: Root::Free, links: &fish },
                Body { pose: [0.0, -2.0, 0.0], velocity: [0.0; 3], root: given, links: &train },
            ];
            let polygon = Wall {
                shape: Shape::Polygon { vertices: &corners, radius: None },
                position: [-4.0, 0.0],
                angle: 0.2,
                nodes: 48,
                circulation: 0.1,
            };
            let tank = Wall {
                shape: Shape::Ellipse { a: 9.0, b: 7.0 },
                position: [0.0; 2],
                angle: 0.1,
                nodes: 64,
                circulation: 0.0,
            };
            let obstacles = [polygon];
            let scene = Scene {
                repulsion: Some(Repulsion { alpha: 4.0, epsilon: 0.01 }),
                tank: Some(tank),
                obstacles: &obstacles,
                bodies: &bodies,
                // No notices.
                tolerance: Some(9.0),
                ..Scene::new(1.1 as Real, 0.3)
            };

            // The same in C.
            let base = ellipse_def(ellipse, common::$module::ellipse(0.7, 0.2));
            fn ellipse_def(_: Shape<'_, Real>, mut link: LinkDef<Real>) -> LinkDef<Real> {
                link.density = 1.5;
                (link.parent_anchor, link.self_anchor) = ([0.9, 0.0], [-0.9, 0.0]);
                link
            }
            let mut c_fish = [base; 3];
            c_fish[0].circulation = 0.2;
            (c_fish[1].parent, c_fish[1].drive) = (0, NEKTON_DRIVE_MOTION);
            c_fish[1].signal.kind = NEKTON_SIGNAL_HARMONIC;
            (c_fish[1].signal.harmonics, c_fish[1].signal.harmonic_count) = (c_terms.as_ptr(), 1);
            c_fish[1].signal.window = WindowDef { from: -1.0, to: 3.0, ramp: 0.5 };
            (c_fish[2].parent, c_fish[2].drive) = (1, NEKTON_DRIVE_TORQUE);
            c_fish[2].signal.kind = NEKTON_SIGNAL_CHANNEL;
            (c_fish[2].stiffness, c_fish[2].damping, c_fish[2].rest, c_fish[2].start) = (0.3, 0.1, 0.05, [0.1, 0.2]);
            let mut c_train = [base; 3];
            let shape = &mut c_train[0].shape;
            (shape.kind, shape.width, shape.height, shape.corner_radius) = (NEKTON_SHAPE_RECTANGLE, 0.8, 0.4, 0.1);
            let shape = &mut c_train[1].shape;
            (shape.kind, shape.radius, shape.amplitude, shape.lobes) = (NEKTON_SHAPE_STAR, 0.3, 0.2, 3);
            let l = &mut c_train[1];
            (l.mass_kind, l.mass, l.inertia, l.centre_of_mass) = (NEKTON_MASS_GIVEN, 0.4, 0.02, [0.05, 0.0]);
            (l.parent, l.joint, l.axis, l.angle, l.drive) =
                (0, NEKTON_JOINT_SLIDER, [1.0, 0.2], 0.3, NEKTON_DRIVE_MOTION);
            (l.signal.kind, l.signal.rows, l.signal.row_count) = (NEKTON_SIGNAL_TABLE, rows.as_ptr(), 2);
            let l = &mut c_train[2];
            (l.shape.kind, l.shape.points, l.shape.point_count) = (NEKTON_SHAPE_CURVE, knots.as_ptr(), knots.len());
            (l.parent, l.drive, l.locked_value) = (0, NEKTON_DRIVE_LOCKED, 2.0);
            let mut c_bodies = [body(), body()];
            (c_bodies[0].pose, c_bodies[0].velocity) = ([-1.0, 1.5, 0.1], [0.1, 0.0, 0.2]);
            (c_bodies[0].links, c_bodies[0].link_count) = (c_fish.as_ptr(), 3);
            (c_bodies[1].pose, c_bodies[1].root) = ([0.0, -2.0, 0.0], NEKTON_ROOT_PRESCRIBED);
            let y = &mut c_bodies[1].motion[1];
            (y.kind, y.harmonics, y.harmonic_count) = (NEKTON_SIGNAL_HARMONIC, c_terms.as_ptr(), 1);
            (c_bodies[1].links, c_bodies[1].link_count) = (c_train.as_ptr(), 3);
            let (mut c_tank, mut c_obstacle) = (wall(), wall());
            c_tank.nodes = 64;
            (c_tank.shape.kind, c_tank.shape.a, c_tank.shape.b, c_tank.angle) = (NEKTON_SHAPE_ELLIPSE, 9.0, 7.0, 0.1);
            let o = &mut c_obstacle;
            (o.shape.kind, o.shape.points, o.shape.point_count) = (NEKTON_SHAPE_POLYGON, corners.as_ptr(), 3);
            (o.position, o.angle, o.nodes, o.circulation) = ([-4.0, 0.0], 0.2, 48, 0.1);
            let mut def = common::$module::scene();
            (def.fluid_density, def.gravity, def.tolerance) = (1.1, 0.3, 9.0);
            (def.repulsion_alpha, def.repulsion_epsilon) = (4.0, 0.01);
            def.tank = &c_tank;
            (def.obstacles, def.obstacle_count) = (&c_obstacle, 1);
            (def.bodies, def.body_count) = (c_bodies.as_ptr(), 2);

            let model = Arc::new(ModelBuf::new(&scene).unwrap_or_else(|e| panic!("{e}")));
            let (_memory, handle) = compile(&def);
            let p = plan(handle);
            assert_eq!((p.links, p.joints, p.walls, p.channels), (6, 4, 2, 1));
            assert_eq!((p.unknowns, p.state_len), (model.view().plan().unknowns, model.view().plan().state_len));
            for i in 0..6 {
                let mut info = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { model_link(handle, i, info.as_mut_ptr()) }, 0);
                let (c, r) = (unsafe { info.assume_init() }, model.view().link(i).unwrap());
                assert_eq!((c.mass, c.inertia, c.area, c.perimeter), (r.mass, r.inertia, r.area, r.perimeter));
                assert_eq!((c.centroid, c.nodes), (r.centroid, r.nodes));
                assert_eq!(
                    (c.place.kind, c.place.index, c.place.link),
                    (NEKTON_PLACE_LINK, i as i32 / 3, i as i32 % 3)
                );
                let mut point = [0.0; 2];
                assert_eq!(unsafe { model_outline_point(handle, &c.place, 0.7, point.as_mut_ptr()) }, 0);
                assert_eq!(Some(point), model.view().outline_point(r.place, 0.7));
            }
            let methods = [
                (fixed(NEKTON_METHOD_RK4), Method::Rk4 { step: 0.01 }),
                (fixed(NEKTON_METHOD_ABM4), Method::Abm4 { step: 0.01 }),
                (fixed(NEKTON_METHOD_GAUSS6), Method::Gauss6 { step: 0.01 }),
                (adams(), Method::adams(adams().relative, adams().absolute)),
            ];
            for (c_method, method) in methods {
                let mut owner = SimBuf::new(model.clone(), method).unwrap_or_else(|e| panic!("{e}"));
                let mut rust = owner.view();
                let (_memory, c) = simulate(handle, &c_method);
                let (from, to): ([Real; 4], [Real; 4]) = ([0.0, 0.1, 0.0, 0.0], [0.1, 0.2, 0.0, 0.0]);
                rust.set_channel(0, from, to).unwrap();
                let null = std::ptr::null_mut();
                assert_eq!(unsafe { sim_set_channel(c, 0, from.as_ptr(), to.as_ptr(), null) }, 0);
                rust.step().unwrap();
                assert_eq!(unsafe { sim_step(c, null) }, 0);
                let t = rust.time() + 0.05;
                rust.advance(t).unwrap();
                assert_eq!(unsafe { sim_advance(c, t, null) }, 0);
                rust.advance_dense(t + 0.015, t + 0.05).unwrap();
                assert_eq!(unsafe { sim_advance_dense(c, t + 0.015, t + 0.05, null) }, 0);
                assert_eq!(state(handle, c), (rust.time(), rust.state().to_vec()));

                type Ask = unsafe extern "C" fn(*mut SimHandle<Real>, *mut Real, usize, *mut nekton_diag) -> i32;
                type Answer<'a> = &'a mut dyn FnMut(&mut [Real]) -> nekton::Result<()>;
                let same = |rank: u32, ask: Ask, answer: Answer<'_>| {
                    let n = 18usize.pow(rank);
                    let (mut ours, mut theirs) = (vec![0.0; n], vec![0.0; n]);
                    answer(&mut ours).unwrap();
                    assert_eq!(unsafe { ask(c, theirs.as_mut_ptr(), n, null) }, 0);
                    assert_eq!(ours, theirs);
                    assert!(ours.iter().any(|x| *x != 0.0));
                };
                same(1, sim_accelerations, &mut |o| rust.accelerations(o));
                same(1, sim_christoffel, &mut |o| rust.christoffel(o));
                same(1, sim_buoyancy, &mut |o| rust.buoyancy(o));
                same(1, sim_repulsion, &mut |o| rust.repulsion(o));
                same(1, sim_circulation_gradient, &mut |o| rust.circulation_gradient(o));
                same(2, sim_mass_matrix, &mut |o| rust.mass_matrix(o));
                same(2, sim_added_mass, &mut |o| rust.added_mass(o));
                same(2, sim_gyroscopic, &mut |o| rust.gyroscopic(o));
                same(3, sim_christoffel_tensor, &mut |o| rust.christoffel_tensor(o));

                // Derivatives, that of circulation among them.
                let rows = rust.state().len();
                let mut req = nekton_req::default();
                assert_eq!(unsafe { sim_derivatives_req(handle, &mut req, null) }, 0);
                let mut mem = common::memory(req.size);
                let reals = nekton::Sim::derivative_requirement(&rust.model()).unwrap();
                assert_eq!(req.size, (reals * size_of::<Real>()).next_multiple_of(8));
                let (mut ours, mut theirs) = (vec![1.0 as Real; rows * rows], vec![1.0 as Real; rows * rows]);
                let mut none = [0.0 as Real; 1];
                let whole = rust.linearize([], &mut ours, &mut [], &mut vec![0.0; reals]).unwrap();
                let mut diag = common::empty_diag();
                let (out, bound, place) = (theirs.as_mut_ptr(), none.as_mut_ptr(), mem.as_mut_ptr().cast());
                let (p, b) = (std::ptr::null(), std::ptr::null_mut());
                let answer =
                    unsafe { sim_linearize(c, p, 0, out, rows * rows, b, 0, bound, place, req.size, &mut diag) };
                assert_eq!((answer, none[0]), (0, whole.bound));
                assert_eq!(ours, theirs);

                let (mut q, mut qd) = (vec![0.0; 18], vec![0.0; 18]);
                assert_eq!(unsafe { sim_positions(c, q.as_mut_ptr(), 18) }, 0);
                assert_eq!(unsafe { sim_velocities(c, qd.as_mut_ptr(), 18) }, 0);
                assert_eq!((q.as_slice(), qd.as_slice()), (rust.positions(), rust.velocities()));
                let (mut a, mut b, mut c_a, mut c_b) = ([0.0; 4], [0.0; 4], [0.0; 4], [0.0; 4]);
                rust.joint_values(&mut a, &mut b);
                assert_eq!(unsafe { sim_joint_values(c, c_a.as_mut_ptr(), c_b.as_mut_ptr(), 4) }, 0);
                assert_eq!((a, b), (c_a, c_b));
                rust.joint_torques(&mut a, &mut b).unwrap();
                assert_eq!(unsafe { sim_joint_torques(c, c_a.as_mut_ptr(), c_b.as_mut_ptr(), 4, null) }, 0);
                assert_eq!((a, b), (c_a, c_b));
                let mut energy = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { sim_energy(c, energy.as_mut_ptr(), null) }, 0);
                let (e, energy) = (rust.energy().unwrap(), unsafe { energy.assume_init() });
                assert_eq!((e.kinetic_fluid, e.kinetic_bodies), (energy.kinetic_fluid, energy.kinetic_bodies));
                assert_eq!((e.buoyancy, e.repulsion), (energy.buoyancy, energy.repulsion));
                assert_eq!((e.circulation, e.total, e.work), (energy.circulation, energy.total, energy.work));
                let mut impulse = [0.0; 3];
                assert_eq!(unsafe { sim_impulse(c, impulse.as_mut_ptr(), null) }, 0);
                assert_eq!(impulse, rust.impulse().unwrap());
                let (mut drift, balance) = ([0.0; 3], rust.energy_drift().unwrap());
                assert_eq!(unsafe { sim_energy_drift(c, drift.as_mut_ptr(), null) }, 0);
                assert_eq!(drift, [balance.amount, balance.kinetic, balance.allowed]);
                let mut resolution = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { sim_resolution(c, resolution.as_mut_ptr(), null) }, 0);
                let (r, resolution) = (rust.resolution().unwrap(), unsafe { resolution.assume_init() });
                assert_eq!((r.mass, r.force, r.quadrature), (resolution.mass, resolution.force, resolution.quadrature));
                assert_eq!((r.repulsion, r.bound()), (resolution.repulsion, resolution.bound));
                let mut error = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { sim_time_error(c, error.as_mut_ptr()) }, 0);
                let (r, e) = (rust.time_error(), unsafe { error.assume_init() });
                let bits = |all: [Real; 8]| all.map(Real::to_bits);
                assert_eq!(
                    bits([r.length, r.angle, r.speed, r.spin, r.length_sum, r.angle_sum, r.speed_sum, r.spin_sum]),
                    bits([e.length, e.angle, e.speed, e.spin, e.length_sum, e.angle_sum, e.speed_sum, e.spin_sum])
                );
                assert_eq!(r.unknown, e.unknown);
                let mut gap = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { sim_gap(c, gap.as_mut_ptr(), null) }, 0);
                let gap = unsafe { gap.assume_init() };
                assert_eq!(gap.distance, rust.gap().distance);
                assert!(gap.first.kind != NEKTON_PLACE_NONE && gap.second.kind != NEKTON_PLACE_NONE);
                let mut counters = nekton_counters::default();
                assert_eq!(unsafe { sim_counters(c, &mut counters) }, 0);
                assert_eq!(
                    (counters.evaluations, counters.steps),
                    (rust.counters().evaluations, rust.counters().steps)
                );
                let y = rust.state().to_vec();
                let (mut ours, mut theirs) = (vec![0.0; y.len()], vec![0.0; y.len()]);
                rust.rhs(t, &y, &mut ours).unwrap();
                assert_eq!(unsafe { sim_rhs(c, t, y.as_ptr(), theirs.as_mut_ptr(), y.len(), null) }, 0);
                assert_eq!(ours, theirs);
                rust.set_state(0.5, &y).unwrap();
                assert_eq!(unsafe { sim_set_state(c, 0.5, y.as_ptr(), y.len(), null) }, 0);
                rust.restart();
                assert_eq!(unsafe { sim_restart(c) }, 0);
                rust.advance(0.55).unwrap();
                assert_eq!(unsafe { sim_advance(c, 0.55, null) }, 0);
                assert_eq!(state(handle, c), (rust.time(), rust.state().to_vec()));
            }
        }
    };
}

round_trip!(double_precision_from_c_is_bitwise_that_of_rust, double);
round_trip!(single_precision_from_c_is_bitwise_that_of_rust, single);
