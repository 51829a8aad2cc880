//! A model whose memory was used for another scene is noticed by its old simulations, however little the scenes differ. Every field
//! of every definition is changed in turn; the definitions are taken apart without `..`, so that this file does not compile
//! while a field is missing.

mod common;

use common::double::*;
use common::empty_diag;
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::null_mut;

/// A scene in which every kind of shape, mass, joint, drive and signal has its part.
struct Set {
    scene: SceneDef<f64>,
    bodies: [BodyDef<f64>; 3],
    links: [LinkDef<f64>; 7],
    walls: [WallDef<f64>; 3],
    terms: [HarmonicDef<f64>; 3],
    rows: [[f64; 4]; 3],
    corners: [[f64; 2]; 4],
    knots: [[f64; 2]; 6],
}

const STAR: usize = 0;
const FIN: usize = 1;
const SLIDE: usize = 2;
const CORNERED: usize = 3;
const TAIL: usize = 4;
const BOX: usize = 5;
const CURVE: usize = 6;

impl Set {
    /// On the heap, since definitions point to each other.
    fn new() -> Box<Set> {
        let mut set = Box::new(Set {
            scene: scene(),
            bodies: [body(); 3],
            links: [ellipse(0.5, 0.2); 7],
            walls: [wall(); 3],
            terms: [[0.1, 2.0, 0.3, 0.01], [0.05, 3.0, 0.1, 0.0], [0.02, 4.0, 0.2, 0.0]]
                .map(|[amplitude, frequency, phase, offset]| HarmonicDef { amplitude, frequency, phase, offset }),
            rows: [[0.0, 0.1, 0.0, 0.0], [0.5, 0.2, 0.1, 0.0], [1.0, 0.1, 0.0, 0.0]],
            corners: [[0.0, 0.0], [0.8, 0.0], [0.8, 0.4], [0.0, 0.4]],
            knots: [[0.5, 0.0], [0.25, 0.3], [-0.25, 0.3], [-0.5, 0.0], [-0.25, -0.3], [0.25, -0.3]],
        });
        let s = &mut *set;
        for link in &mut s.links {
            link.nodes = 16;
        }
        for (l, parent) in [(FIN, 0), (SLIDE, 0), (CORNERED, 1), (TAIL, 3)] {
            (s.links[l].parent, s.links[l].parent_anchor, s.links[l].self_anchor) = (parent, [-0.7, 0.1], [0.7, 0.1]);
        }
        (s.links[SLIDE].parent_anchor, s.links[SLIDE].self_anchor) = ([0.0, 1.0], [0.1, -0.5]);
        let shape = &mut s.links[STAR].shape;
        (shape.kind, shape.radius, shape.amplitude, shape.lobes) = (NEKTON_SHAPE_STAR, 0.4, 0.1, 3);
        s.links[STAR].circulation = 0.2;
        let fin = &mut s.links[FIN];
        (fin.drive, fin.signal.kind) = (NEKTON_DRIVE_MOTION, NEKTON_SIGNAL_HARMONIC);
        (fin.signal.harmonics, fin.signal.harmonic_count) = (s.terms.as_ptr(), 2);
        fin.signal.window = WindowDef { from: -1.0, to: 9.0, ramp: 0.5 };
        let slide = &mut s.links[SLIDE];
        (slide.joint, slide.axis, slide.angle) = (NEKTON_JOINT_SLIDER, [1.0, 0.1], 0.2);
        (slide.drive, slide.stiffness, slide.damping, slide.rest) = (NEKTON_DRIVE_TORQUE, 1.0, 0.1, 0.01);
        slide.start = [0.02, 0.03];
        (slide.signal.kind, slide.signal.rows, slide.signal.row_count) = (NEKTON_SIGNAL_TABLE, s.rows.as_ptr(), 3);
        let cornered = &mut s.links[CORNERED];
        (cornered.shape.kind, cornered.shape.points, cornered.shape.point_count) =
            (NEKTON_SHAPE_POLYGON, s.corners.as_ptr(), 4);
        (cornered.shape.corner_radius, cornered.locked_value) = (0.05, 0.1);
        (cornered.mass_kind, cornered.mass, cornered.inertia) = (NEKTON_MASS_GIVEN, 0.4, 0.05);
        cornered.centre_of_mass = [0.02, 0.01];
        (s.links[TAIL].drive, s.links[TAIL].signal.value) = (NEKTON_DRIVE_TORQUE, 0.1);
        let shape = &mut s.links[BOX].shape;
        (shape.kind, shape.width, shape.height, shape.corner_radius) = (NEKTON_SHAPE_RECTANGLE, 0.8, 0.4, 0.1);
        let shape = &mut s.links[CURVE].shape;
        (shape.kind, shape.points, shape.point_count) = (NEKTON_SHAPE_CURVE, s.knots.as_ptr(), 6);
        let curve = &mut s.links[CURVE];
        (curve.corners, curve.corner_points, curve.corner_count) = (NEKTON_CORNERS_GIVEN, EVEN.as_ptr(), 2);
        for (b, (first, count)) in [(STAR, 5), (BOX, 1), (CURVE, 1)].into_iter().enumerate() {
            let body = &mut s.bodies[b];
            (body.pose, body.velocity) = ([6.0 * b as f64, 0.1, 0.2], [0.1, 0.0, 0.05]);
            (body.links, body.link_count) = (&raw const s.links[first], count);
        }
        s.bodies[1].root = NEKTON_ROOT_PRESCRIBED;
        for (w, wall) in s.walls.iter_mut().enumerate() {
            (wall.shape.kind, wall.shape.a, wall.shape.b, wall.nodes) = (NEKTON_SHAPE_ELLIPSE, 1.0, 0.8, 16);
            (wall.position, wall.angle) = ([6.0 * w as f64, -6.0], 0.1);
        }
        let tank = &mut s.walls[2];
        (tank.shape.a, tank.shape.b, tank.position, tank.nodes) = (40.0, 30.0, [0.0, 0.0], 32);
        s.walls[0].circulation = 0.1;
        let cornered = &mut s.walls[0];
        (cornered.shape.kind, cornered.shape.points, cornered.shape.point_count) =
            (NEKTON_SHAPE_CURVE, s.knots.as_ptr(), 6);
        (cornered.corners, cornered.corner_points, cornered.corner_count) = (NEKTON_CORNERS_GIVEN, EVEN.as_ptr(), 2);
        let scene = &mut s.scene;
        (scene.gravity, scene.repulsion_epsilon, scene.quadrature) = (0.5, 1e-4, NEKTON_QUADRATURE_PLAIN);
        // Few nodes, so that it is quick.
        scene.allow_unresolved = 1;
        (scene.tank, scene.obstacles, scene.obstacle_count) = (&raw const s.walls[2], s.walls.as_ptr(), 2);
        (scene.bodies, scene.body_count) = (s.bodies.as_ptr(), 3);
        set
    }
}

/// Corners of the curves.
static EVEN: [usize; 2] = [0, 2];
static ODD: [usize; 2] = [1, 3];

type Change = fn(&mut Set);

/// The changes of a definition's fields, one or more for each.
macro_rules! fields {
    ($def:ident { $($field:ident: [$($change:expr),* $(,)?]),* $(,)? }) => {{
        // Every field is named.
        let _ = |def: $def<f64>| {
            let $def { $($field: _),* } = def;
        };
        let all: Vec<(&'static str, Change)> =
            vec![$($((concat!(stringify!($def), ".", stringify!($field)), $change as Change),)*)*];
        all
    }};
}

fn changes() -> Vec<(&'static str, Change)> {
    [
        fields!(SceneDef {
            // Not of the scene, but of who describes it.
            struct_size: [],
            abi_version: [],
            fluid_density: [|s| s.scene.fluid_density = 1.5],
            gravity: [|s| s.scene.gravity = 0.5f64.next_up(), |s| s.scene.gravity = 0.0],
            repulsion_epsilon: [|s| s.scene.repulsion_epsilon = 1.1e-4, |s| s.scene.repulsion_epsilon = 0.0],
            repulsion_alpha: [|s| s.scene.repulsion_alpha = 3.0],
            circulation: [|s| s.scene.circulation = NEKTON_CIRCULATION_PAPER],
            force: [|s| s.scene.force = NEKTON_FORCE_BOUNDARY],
            quadrature: [|s| s.scene.quadrature = NEKTON_QUADRATURE_GRADED],
            tolerance: [|s| s.scene.tolerance = 0.5],
            allow_unresolved: [|s| s.scene.allow_unresolved = 0],
            // Refused unless it is 0.
            reserved: [],
            shortcuts: [|s| s.scene.shortcuts = 0],
            tank: [|s| s.scene.tank = std::ptr::null()],
            obstacles: [|s| s.walls.swap(0, 1)],
            obstacle_count: [|s| s.scene.obstacle_count = 1, |s| s.scene.obstacle_count = 0],
            bodies: [|s| s.bodies.swap(0, 2)],
            body_count: [|s| s.scene.body_count = 2],
        }),
        fields!(WallDef {
            struct_size: [],
            shape: [|s| s.walls[1].shape.b = 0.9, |s| s.walls[2].shape.a = 41.0],
            position: [
                |s| s.walls[0].position[0] = 0.1,
                |s| s.walls[1].position[1] = -6.1,
                |s| s.walls[2].position[1] = 0.1
            ],
            nodes: [|s| s.walls[1].nodes = 18, |s| s.walls[2].nodes = 34],
            angle: [|s| s.walls[1].angle = 0.2, |s| s.walls[2].angle = 0.2],
            circulation: [|s| s.walls[0].circulation = 0.2, |s| s.walls[1].circulation = 0.2],
            corners: [|s| s.walls[0].corners = NEKTON_CORNERS_NONE, |s| s.walls[0].corners = NEKTON_CORNERS_AUTO],
            // Refused unless it is 0.
            corners_reserved: [],
            corner_points: [|s| s.walls[0].corner_points = ODD.as_ptr()],
            corner_count: [|s| s.walls[0].corner_count = 1],
        }),
        fields!(LinkDef {
            struct_size: [],
            shape: [|s| s.links[TAIL].shape.a = 0.45],
            nodes: [|s| s.links[TAIL].nodes = 18],
            circulation: [|s| s.links[STAR].circulation = 0.3, |s| s.links[BOX].circulation = 0.3],
            mass_kind: [|s| s.links[CORNERED].mass_kind = NEKTON_MASS_DENSITY],
            parent: [|s| s.links[TAIL].parent = 1],
            density: [|s| s.links[STAR].density = 1.1, |s| s.links[CURVE].density = 1.1],
            mass: [|s| s.links[CORNERED].mass = 0.5],
            inertia: [|s| s.links[CORNERED].inertia = 0.06],
            centre_of_mass: [
                |s| s.links[CORNERED].centre_of_mass[0] = 0.03,
                |s| s.links[CORNERED].centre_of_mass[1] = 0.0,
            ],
            joint: [|s| s.links[SLIDE].joint = NEKTON_JOINT_HINGE],
            drive: [
                |s| s.links[TAIL].drive = NEKTON_DRIVE_LOCKED,
                |s| s.links[TAIL].drive = NEKTON_DRIVE_MOTION,
                |s| s.links[FIN].drive = NEKTON_DRIVE_TORQUE,
            ],
            parent_anchor: [|s| s.links[FIN].parent_anchor[0] = -0.8, |s| s.links[SLIDE].parent_anchor[1] = 1.1],
            self_anchor: [|s| s.links[FIN].self_anchor[1] = 0.0, |s| s.links[SLIDE].self_anchor[0] = 0.0],
            axis: [|s| s.links[SLIDE].axis[0] = 0.9, |s| s.links[SLIDE].axis[1] = 0.0],
            angle: [|s| s.links[SLIDE].angle = 0.1],
            locked_value: [|s| s.links[CORNERED].locked_value = 0.2],
            rest: [|s| s.links[SLIDE].rest = 0.0],
            signal: [|s| s.links[TAIL].signal.kind = NEKTON_SIGNAL_CHANNEL],
            stiffness: [|s| s.links[SLIDE].stiffness = 1.1],
            damping: [|s| s.links[SLIDE].damping = 0.2, |s| s.links[TAIL].damping = 0.1],
            start: [|s| s.links[SLIDE].start[0] = 0.0, |s| s.links[SLIDE].start[1] = 0.0],
            corners: [
                |s| s.links[CURVE].corners = NEKTON_CORNERS_NONE,
                |s| s.links[CURVE].corners = NEKTON_CORNERS_AUTO
            ],
            // Refused unless it is 0.
            corners_reserved: [],
            corner_points: [|s| s.links[CURVE].corner_points = ODD.as_ptr()],
            corner_count: [|s| s.links[CURVE].corner_count = 1],
        }),
        fields!(BodyDef {
            struct_size: [],
            root: [|s| s.bodies[1].root = NEKTON_ROOT_FREE],
            pose: [|s| s.bodies[0].pose[0] = 0.1, |s| s.bodies[1].pose[1] = 0.0, |s| s.bodies[2].pose[2] = 0.3],
            velocity: [
                |s| s.bodies[0].velocity[0] = 0.2,
                |s| s.bodies[2].velocity[1] = 0.1,
                |s| s.bodies[2].velocity[2] = 0.1,
            ],
            motion: [
                |s| s.bodies[1].motion[0].value = 0.1,
                |s| s.bodies[1].motion[1].value = 0.1,
                |s| s.bodies[1].motion[2].kind = NEKTON_SIGNAL_CHANNEL,
            ],
            links: [|s| s.bodies[2].links = &raw const s.links[BOX]],
            link_count: [|s| s.bodies[0].link_count = 4],
        }),
        fields!(ShapeDef {
            kind: [
                |s| s.links[BOX].shape.kind = NEKTON_SHAPE_ELLIPSE,
                |s| s.links[CURVE].shape.kind = NEKTON_SHAPE_POLYGON
            ],
            lobes: [|s| s.links[STAR].shape.lobes = 4],
            a: [|s| s.links[FIN].shape.a = 0.51],
            b: [|s| s.links[FIN].shape.b = 0.21],
            radius: [|s| s.links[STAR].shape.radius = 0.41],
            amplitude: [|s| s.links[STAR].shape.amplitude = 0.11],
            width: [|s| s.links[BOX].shape.width = 0.81],
            height: [|s| s.links[BOX].shape.height = 0.41],
            corner_radius: [
                |s| s.links[BOX].shape.corner_radius = 0.11,
                |s| s.links[CORNERED].shape.corner_radius = 0.06
            ],
            points: [|s| s.knots[2][1] = 0.31, |s| s.corners[1][0] = 0.81],
            point_count: [|s| s.links[CURVE].shape.point_count = 5],
        }),
        fields!(SignalDef {
            kind: [|s| s.links[SLIDE].signal.kind = NEKTON_SIGNAL_CONSTANT],
            value: [|s| s.links[TAIL].signal.value = 0.2],
            harmonics: [|s| s.links[FIN].signal.harmonics = &raw const s.terms[1], |s| s.terms.swap(0, 1)],
            harmonic_count: [|s| s.links[FIN].signal.harmonic_count = 1],
            window: [|s| s.links[FIN].signal.window = WindowDef { from: 0.0, to: 0.0, ramp: 0.0 }],
            rows: [|s| s.rows[1][0] = 0.6, |s| s.rows[1][1] = 0.3, |s| s.rows[2][2] = 0.1, |s| s.rows[2][3] = 0.1],
            row_count: [|s| s.links[SLIDE].signal.row_count = 2],
        }),
        fields!(WindowDef {
            from: [|s| s.links[FIN].signal.window.from = -1.1],
            to: [|s| s.links[FIN].signal.window.to = 9.1],
            ramp: [|s| s.links[FIN].signal.window.ramp = 0.6],
        }),
        fields!(HarmonicDef {
            amplitude: [|s| s.terms[0].amplitude = 0.11],
            frequency: [|s| s.terms[1].frequency = 3.1],
            phase: [|s| s.terms[0].phase = 0.31],
            offset: [|s| s.terms[1].offset = 0.01],
        }),
    ]
    .concat()
}

/// Nothing moves as prescribed, which the boundary formula of the force does not allow.
fn free(s: &mut Set) {
    s.bodies[1].root = NEKTON_ROOT_FREE;
    s.links.iter_mut().for_each(|l| l.drive = NEKTON_DRIVE_TORQUE);
}

/// What an old simulation says after its model was made anew, in place, of a changed scene.
fn after(memory: &mut [u64], prepare: Change, change: Change, name: &str) -> nekton_status {
    let set = Box::into_raw(Set::new());
    let bytes = size_of_val(memory);
    let (mut model, mut again, mut diag) = (null_mut(), null_mut(), empty_diag());
    unsafe {
        prepare(&mut *set);
        let def = &raw const (*set).scene;
        let made = model_init(memory.as_mut_ptr().cast(), bytes, def, &mut model, &mut diag);
        assert!(made >= 0, "{name}: {diag:?} {}", common::what(&diag));
        let (_memory, sim) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        assert!(sim_step(sim, &mut diag) >= 0, "{name}: {diag:?}");
        change(&mut *set);
        let made = model_init(memory.as_mut_ptr().cast(), bytes, def, &mut again, &mut diag);
        assert!(made >= 0, "{name}: the change is refused: {diag:?} {}", common::what(&diag));
        assert_eq!(again, model);
        let status = sim_step(sim, &mut diag);
        drop(Box::from_raw(set));
        status
    }
}

#[test]
fn a_model_that_was_replaced_by_one_that_differs_in_one_field_is_noticed() {
    let mut memory = common::memory(8 << 20);
    let nothing: Change = |_| ();
    assert!(after(&mut memory, nothing, nothing, "nothing") >= 0);
    assert!(after(&mut memory, free, nothing, "nothing of the free ones") >= 0);
    let changes = changes();
    assert!(changes.len() > 80);
    let unseen: Vec<_> = changes
        .into_iter()
        .filter(|(name, change)| {
            let prepare = if *name == "SceneDef.force" { free } else { nothing };
            after(&mut memory, prepare, *change, name) != Status::BadHandle.code()
        })
        .map(|(name, _)| name)
        .collect();
    assert!(unseen.is_empty(), "not noticed: {unseen:?}");
}
