//! What is refused, and that nothing was touched then.

mod common;

use common::double::*;
use common::{empty_diag, memory, what};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut};

/// What C sees through a pointer while a test changes it.
struct Shared<T>(*mut T);

impl<T> Shared<T> {
    fn new(value: &mut T) -> Self {
        Shared(value)
    }
    fn get(&self) -> *const T {
        self.0
    }
}

impl<T> std::ops::Deref for Shared<T> {
    type Target = T;
    fn deref(&self) -> &T {
        unsafe { &*self.0 }
    }
}

impl<T> std::ops::DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut T {
        unsafe { &mut *self.0 }
    }
}

type Def = Shared<SceneDef<f64>>;
type Bodies = Shared<[BodyDef<f64>; 2]>;
type Links = Shared<[LinkDef<f64>; 3]>;

/// Calls `check` with a definition of two ellipses, one with a hinged tail, that it may spoil.
fn with_scene(check: impl FnOnce(&mut Def, &mut Bodies, &mut Links)) {
    let mut links = [ellipse(0.5, 0.2), ellipse(0.5, 0.2), ellipse(0.4, 0.3)];
    let mut bodies = [body(), body()];
    let mut def = scene();
    let (mut def, mut bodies, mut links) = (Shared::new(&mut def), Shared::new(&mut bodies), Shared::new(&mut links));
    (links[1].parent, links[1].parent_anchor, links[1].self_anchor) = (0, [-0.7, 0.0], [0.7, 0.0]);
    links[1].drive = NEKTON_DRIVE_TORQUE;
    bodies[1].pose = [3.0, 0.0, 0.5];
    let first = links.get().cast::<LinkDef<f64>>();
    (bodies[0].links, bodies[0].link_count) = (first, 2);
    (bodies[1].links, bodies[1].link_count) = (first.wrapping_add(2), 1);
    def.gravity = 9.81;
    (def.bodies, def.body_count) = (bodies.get().cast(), 2);
    check(&mut def, &mut bodies, &mut links);
}

/// The scene is refused with this status, place and quantity, by both functions, and the memory is as it was.
fn refused(def: *const SceneDef<f64>, status: Status, place: (i32, i32, i32), quantity: &str) {
    let mut diag = empty_diag();
    let mut req = nekton_req { size: 7, align: 7 };
    assert_eq!(unsafe { model_req(def, &mut req, &mut diag) }, status.code(), "{diag:?}");
    assert_eq!(req, nekton_req { size: 7, align: 7 });
    let mut mem = memory(1 << 20);
    let before = mem.clone();
    let mut model = null_mut();
    let got = unsafe { model_init(mem.as_mut_ptr().cast(), 1 << 20, def, &mut model, &mut diag) };
    assert_eq!(got, status.code());
    assert!(model.is_null() && mem == before);
    assert_eq!(diag.status, got);
    assert_eq!((diag.place.kind, diag.place.index, diag.place.link), place);
    assert_eq!(what(&diag), quantity);
    // Without a diag the outcome is the same.
    assert_eq!(unsafe { model_req(def, &mut req, null_mut()) }, got);
    let mut made = null_mut();
    assert_eq!(unsafe { model_create(def, &mut made, null_mut()) }, got);
    assert!(made.is_null());
}

const SCENE: (i32, i32, i32) = (NEKTON_PLACE_SCENE, -1, -1);

#[test]
fn a_scene_of_another_version_or_size_is_refused() {
    refused(null(), Status::NullPointer, SCENE, "def");
    with_scene(|def, _, _| {
        let address = def.get().wrapping_byte_add(4);
        refused(address, Status::Misaligned, SCENE, "def");
    });
    with_scene(|def, _, _| {
        def.abi_version += 1;
        refused(def.get(), Status::AbiVersion, SCENE, "abi_version");
    });
    with_scene(|def, _, _| {
        def.struct_size -= 8;
        refused(def.get(), Status::AbiVersion, SCENE, "struct_size");
    });
    let mut def = scene();
    let size = size_of::<SceneDef<f64>>();
    unsafe {
        assert_eq!(scene_def_init(&mut def, size + 8, 1), Status::AbiVersion.code());
        assert_eq!(scene_def_init(&mut def, size, 2), Status::AbiVersion.code());
        assert_eq!(scene_def_init(null_mut(), size, 1), Status::NullPointer.code());
        assert_eq!(wall_def_init(null_mut()), Status::NullPointer.code());
        assert_eq!(body_def_init(null_mut()), Status::NullPointer.code());
        assert_eq!(link_def_init(null_mut()), Status::NullPointer.code());
    }
}

#[test]
fn every_pointer_count_and_kind_of_a_scene_is_checked() {
    let link1 = (NEKTON_PLACE_LINK, 0, 1);
    with_scene(|def, _, _| {
        def.bodies = null();
        refused(def.get(), Status::NullPointer, SCENE, "bodies");
        def.bodies = std::ptr::without_provenance(4);
        refused(def.get(), Status::Misaligned, SCENE, "bodies");
    });
    with_scene(|def, _, _| {
        def.body_count = usize::MAX / 2;
        refused(def.get(), Status::SizeOverflow, SCENE, "bodies");
        def.body_count = 0;
        refused(def.get(), Status::EmptyScene, SCENE, "");
    });
    with_scene(|def, _, _| {
        def.obstacle_count = 1;
        refused(def.get(), Status::NullPointer, SCENE, "obstacles");
    });
    with_scene(|def, _, _| {
        def.tank = std::ptr::without_provenance(12);
        refused(def.get(), Status::Misaligned, SCENE, "tank");
    });
    with_scene(|def, bodies, _| {
        bodies[1].links = null();
        refused(def.get(), Status::NullPointer, (NEKTON_PLACE_BODY, 1, -1), "links");
    });
    with_scene(|def, bodies, _| {
        bodies[1].root = 9;
        refused(def.get(), Status::UnknownKind, (NEKTON_PLACE_BODY, 1, -1), "root");
        bodies[1].root = NEKTON_ROOT_PRESCRIBED;
        bodies[1].motion[2].kind = 4;
        refused(def.get(), Status::UnknownKind, (NEKTON_PLACE_BODY, 1, -1), "signal.kind");
    });
    for (spoil, quantity) in [
        ((|l| l.shape.kind = 0) as fn(&mut LinkDef<f64>), "shape.kind"),
        (|l| l.shape.kind = -1, "shape.kind"),
        (|l| l.shape.kind = 6, "shape.kind"),
        (|l| l.mass_kind = 2, "mass_kind"),
        (|l| l.joint = 2, "joint"),
        (|l| l.drive = 3, "drive"),
        (|l| l.signal.kind = -1, "signal.kind"),
    ] {
        with_scene(|def, _, links| {
            spoil(&mut links[1]);
            refused(def.get(), Status::UnknownKind, link1, quantity);
        });
    }
    for (spoil, quantity) in [
        ((|l| (l.shape.kind, l.shape.point_count) = (NEKTON_SHAPE_CURVE, 5)) as fn(&mut LinkDef<f64>), "points"),
        (|l| (l.shape.kind, l.shape.point_count) = (NEKTON_SHAPE_POLYGON, 3), "points"),
        (|l| (l.signal.kind, l.signal.row_count) = (NEKTON_SIGNAL_TABLE, 2), "rows"),
        (|l| (l.signal.kind, l.signal.harmonic_count) = (NEKTON_SIGNAL_HARMONIC, 1), "harmonics"),
    ] {
        with_scene(|def, _, links| {
            spoil(&mut links[1]);
            refused(def.get(), Status::NullPointer, link1, quantity);
        });
    }
    for spoil in [-2, 1, 2, i32::MIN, i32::MAX] {
        with_scene(|def, _, links| {
            links[1].parent = spoil;
            refused(def.get(), Status::BadParent, link1, "parent");
        });
    }
    for (spoil, quantity) in [
        ((|d| d.circulation = 2) as fn(&mut SceneDef<f64>), "circulation"),
        (|d| d.force = -1, "force"),
        (|d| d.quadrature = 2, "quadrature"),
        (|d| d.shortcuts = 2, "shortcuts"),
    ] {
        with_scene(|def, _, _| {
            spoil(def);
            refused(def.get(), Status::UnknownKind, SCENE, quantity);
        });
    }
}

#[test]
fn every_number_of_a_scene_must_be_finite() {
    const POINTS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, f64::NAN], [0.0, 1.0]];
    const ROWS: [[f64; 4]; 2] = [[0.0; 4], [1.0, f64::INFINITY, 0.0, 0.0]];
    const TERMS: [HarmonicDef<f64>; 1] = [HarmonicDef { amplitude: 1.0, frequency: f64::NAN, phase: 0.0, offset: 0.0 }];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (spoil, quantity) in [
            ((|d, x| d.fluid_density = x) as fn(&mut SceneDef<f64>, f64), "fluid_density"),
            (|d, x| d.gravity = x, "gravity"),
            (|d, x| d.repulsion_epsilon = x, "repulsion_epsilon"),
            (|d, x| d.repulsion_alpha = x, "repulsion_alpha"),
        ] {
            with_scene(|def, _, _| {
                spoil(def, bad);
                refused(def.get(), Status::NotFinite, SCENE, quantity);
            });
        }
        for (spoil, quantity) in [
            ((|b, x| b.pose[2] = x) as fn(&mut BodyDef<f64>, f64), "pose"),
            (|b, x| b.velocity[0] = x, "velocity"),
            (|b, x| (b.root, b.motion[1].value) = (NEKTON_ROOT_PRESCRIBED, x), "signal.value"),
        ] {
            with_scene(|def, bodies, _| {
                spoil(&mut bodies[1], bad);
                refused(def.get(), Status::NotFinite, (NEKTON_PLACE_BODY, 1, -1), quantity);
            });
        }
        for (spoil, quantity) in [
            ((|l, x| l.shape.a = x) as fn(&mut LinkDef<f64>, f64), "a"),
            (|l, x| l.shape.b = x, "b"),
            (|l, x| (l.shape.kind, l.shape.amplitude) = (NEKTON_SHAPE_STAR, x), "amplitude"),
            (|l, x| (l.shape.kind, l.shape.corner_radius) = (NEKTON_SHAPE_RECTANGLE, x), "corner_radius"),
            (|l, x| l.circulation = x, "circulation"),
            (|l, x| l.density = x, "density"),
            (|l, x| (l.mass_kind, l.inertia) = (NEKTON_MASS_GIVEN, x), "inertia"),
            (|l, x| l.parent_anchor[1] = x, "anchor"),
            (|l, x| (l.joint, l.axis[1]) = (NEKTON_JOINT_SLIDER, x), "axis"),
            (|l, x| l.start[1] = x, "start"),
            (|l, x| (l.signal.kind, l.signal.window.ramp) = (NEKTON_SIGNAL_HARMONIC, x), "window.ramp"),
        ] {
            with_scene(|def, _, links| {
                spoil(&mut links[1], bad);
                refused(def.get(), Status::NotFinite, (NEKTON_PLACE_LINK, 0, 1), quantity);
            });
        }
        let mut wall = wall();
        (wall.shape.kind, wall.shape.a, wall.shape.b, wall.position) = (NEKTON_SHAPE_ELLIPSE, 1.0, 1.0, [0.0, bad]);
        with_scene(|def, _, _| {
            (def.obstacles, def.obstacle_count) = (&wall, 1);
            refused(def.get(), Status::NotFinite, (NEKTON_PLACE_OBSTACLE, 0, -1), "position");
        });
    }
    for (spoil, quantity, item) in [
        (
            (|l| (l.shape.kind, l.shape.points, l.shape.point_count) = (NEKTON_SHAPE_CURVE, POINTS.as_ptr(), 4))
                as fn(&mut LinkDef<f64>),
            "points",
            2,
        ),
        (|l| (l.signal.kind, l.signal.rows, l.signal.row_count) = (NEKTON_SIGNAL_TABLE, ROWS.as_ptr(), 2), "rows", 1),
        (
            |l| {
                (l.signal.kind, l.signal.harmonics, l.signal.harmonic_count) =
                    (NEKTON_SIGNAL_HARMONIC, TERMS.as_ptr(), 1)
            },
            "harmonics",
            0,
        ),
    ] {
        with_scene(|def, _, links| {
            spoil(&mut links[1]);
            refused(def.get(), Status::NotFinite, (NEKTON_PLACE_LINK, 0, 1), quantity);
            let (mut req, mut diag) = (nekton_req::default(), empty_diag());
            unsafe { model_req(def.get(), &mut req, &mut diag) };
            assert_eq!(diag.item, item);
        });
    }
}

#[test]
fn memory_that_is_null_misaligned_or_short_is_refused_untouched() {
    with_scene(|def, _, _| {
        let (mut need, mut diag, mut model) = (nekton_req::default(), empty_diag(), null_mut());
        assert_eq!(unsafe { model_req(def.get(), &mut need, &mut diag) }, 0);
        assert_eq!(need.align, nekton_ffi::shared::NEKTON_ALIGN);
        let mut mem = memory(need.size + 64);
        let before = mem.clone();
        let first: *mut u8 = mem.as_mut_ptr().cast();
        for (at, len, status) in [
            (null_mut(), need.size, Status::NullPointer),
            (first.wrapping_add(4), need.size, Status::Misaligned),
            (first, need.size - 1, Status::MemoryTooSmall),
            (first, 0, Status::MemoryTooSmall),
        ] {
            assert_eq!(unsafe { model_init(at.cast(), len, def.get(), &mut model, &mut diag) }, status.code());
            assert_eq!(diag.status, status.code());
        }
        assert_eq!(
            unsafe { model_init(first.cast(), need.size, def.get(), null_mut(), &mut diag) },
            Status::NullPointer.code()
        );
        assert!(mem == before && model.is_null());
        // The definition lies in the memory that it would be compiled into.
        let inside = first.wrapping_add(256).cast::<SceneDef<f64>>();
        unsafe { inside.write(std::ptr::read(def.get())) };
        let before = mem.clone();
        let got = unsafe { model_init(mem.as_mut_ptr().cast(), need.size, inside, &mut model, &mut diag) };
        assert_eq!(got, Status::Aliasing.code());
        assert!(mem == before && model.is_null());

        let (_model_memory, model) = compile(def);
        let mut sim = null_mut();
        assert_eq!(unsafe { sim_req(model, &adams(), &mut need, &mut diag) }, 0);
        let mut mem = memory(need.size + 64);
        let before = mem.clone();
        let first: *mut u8 = mem.as_mut_ptr().cast();
        for (at, len, status) in [
            (null_mut(), need.size, Status::NullPointer),
            (first.wrapping_add(4), need.size, Status::Misaligned),
            (first, need.size - 1, Status::MemoryTooSmall),
        ] {
            assert_eq!(unsafe { sim_init(at.cast(), len, model, &adams(), &mut sim, &mut diag) }, status.code());
        }
        for (method, status) in [
            (MethodDef { kind: 0, ..adams() }, Status::UnknownKind),
            (MethodDef { kind: 5, ..adams() }, Status::UnknownKind),
            (MethodDef { step: 0.0, ..fixed(NEKTON_METHOD_RK4) }, Status::BadStep),
            (MethodDef { step: f64::NAN, ..fixed(NEKTON_METHOD_ABM4) }, Status::BadStep),
            (MethodDef { relative: f64::NAN, ..adams() }, Status::BadTolerance),
            (MethodDef { absolute: 0.0, ..adams() }, Status::BadTolerance),
        ] {
            let got = unsafe { sim_init(first.cast(), need.size, model, &method, &mut sim, &mut diag) };
            assert_eq!(got, status.code());
        }
        let len = need.size;
        unsafe {
            assert_eq!(sim_init(first.cast(), len, model, null(), &mut sim, &mut diag), Status::NullPointer.code());
            assert_eq!(sim_init(first.cast(), len, model, &adams(), null_mut(), &mut diag), Status::NullPointer.code());
            assert_eq!(sim_init(first.cast(), len, null(), &adams(), &mut sim, &mut diag), Status::NullPointer.code());
        }
        assert!(mem == before && sim.is_null());
        // The simulation would lie on its model.
        let mut both = memory(1 << 20);
        let mut model = null_mut();
        assert_eq!(unsafe { model_init(both.as_mut_ptr().cast(), 1 << 20, def.get(), &mut model, &mut diag) }, 0);
        let before = both.clone();
        let at = both.as_mut_ptr().wrapping_add(8);
        let got = unsafe { sim_init(at.cast(), (1 << 20) - 64, model, &adams(), &mut sim, &mut diag) };
        assert_eq!(got, Status::Aliasing.code());
        assert!(both == before && sim.is_null());
    });
}

#[test]
fn simulations_of_one_model_on_threads_give_the_bits_of_one_alone() {
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        let run = |model: *mut ModelHandle<f64>| {
            let (_memory, sim) = simulate(model, &adams());
            assert_eq!(unsafe { sim_advance(sim, 0.2, null_mut()) }, 0);
            state(model, sim)
        };
        let alone = run(model);
        let address = model.expose_provenance();
        std::thread::scope(|scope| {
            let threads: Vec<_> =
                (0..4).map(|_| scope.spawn(move || run(std::ptr::with_exposed_provenance_mut(address)))).collect();
            for thread in threads {
                assert_eq!(thread.join().unwrap(), alone);
            }
        });
    });
}

#[test]
fn memory_is_used_exactly_as_far_as_required_and_anywhere() {
    with_scene(|def, _, _| {
        let (mut need, mut model, mut sim) = (nekton_req::default(), null_mut(), null_mut());
        let mut states = Vec::new();
        for offset in [0, 8, 24, 56] {
            assert_eq!(unsafe { model_req(def.get(), &mut need, null_mut()) }, 0);
            let (size, mark) = (need.size, 0x5a);
            let mut mem = memory(size + 128);
            let first = mem.as_mut_ptr().cast::<u8>().wrapping_add(offset);
            assert_eq!(unsafe { model_init(first.cast(), size, def.get(), &mut model, null_mut()) }, 0);
            assert_eq!(unsafe { sim_req(model, &adams(), &mut need, null_mut()) }, 0);
            let mut sim_mem = memory(need.size + 128);
            let sim_first = sim_mem.as_mut_ptr().cast::<u8>().wrapping_add(offset);
            assert_eq!(unsafe { sim_init(sim_first.cast(), need.size, model, &adams(), &mut sim, null_mut()) }, 0);
            assert_eq!(unsafe { sim_advance(sim, 0.05, null_mut()) }, 0);
            states.push(state(model, sim));
            let outside = |first: *const u8, size: usize, end: usize| {
                (0..end)
                    .filter(|i| *i < offset || *i >= offset + size)
                    .all(|i| unsafe { *first.wrapping_sub(offset).wrapping_add(i) } == mark)
            };
            assert!(outside(first, size, size.div_ceil(8) * 8 + 120));
            assert!(outside(sim_first, need.size, need.size.div_ceil(8) * 8 + 120));
        }
        assert!(states.windows(2).all(|w| w[0] == w[1]));
    });
}

#[test]
fn what_is_no_object_is_refused() {
    with_scene(|def, _, _| {
        let (mut model_memory, model) = compile(def);
        let (mut sim_memory, sim) = simulate(model, &adams());
        let bad = Status::BadHandle.code();
        let null_pointer = Status::NullPointer.code();
        let misaligned = Status::Misaligned.code();
        let (mut t, mut req) = (0.0, nekton_req::default());
        let mut plan = std::mem::MaybeUninit::uninit();
        let mut rubbish = memory(4096);
        unsafe {
            let no_model = rubbish.as_mut_ptr().cast::<ModelHandle<f64>>();
            let no_sim = rubbish.as_mut_ptr().cast::<SimHandle<f64>>();
            assert_eq!(model_plan(no_model, plan.as_mut_ptr()), bad);
            assert_eq!(model_plan(null(), plan.as_mut_ptr()), null_pointer);
            assert_eq!(model_plan(model.wrapping_byte_add(1), plan.as_mut_ptr()), misaligned);
            assert_eq!(model_plan(sim.cast(), plan.as_mut_ptr()), bad);
            assert_eq!(sim_req(no_model, &adams(), &mut req, null_mut()), bad);
            assert_eq!(sim_time(no_sim, &mut t), bad);
            assert_eq!(sim_time(null(), &mut t), null_pointer);
            assert_eq!(sim_time(sim.wrapping_byte_add(4), &mut t), misaligned);
            assert_eq!(sim_time(model.cast(), &mut t), bad);
            assert_eq!(sim_step(no_sim, null_mut()), bad);
            // The other precision.
            let mut t32 = 0.0;
            assert_eq!(common::single::sim_time(sim.cast(), &mut t32), bad);
            // Not from create.
            assert_eq!(model_free(model), bad);
            assert_eq!(sim_free(sim), bad);
            assert_eq!(model_free(null_mut()), 0);
            assert_eq!(sim_free(null_mut()), 0);
            assert_eq!(sim_time(sim, &mut t), 0);
        }
        // Another scene takes the model's memory: its simulation is stale.
        def.gravity = 1.0;
        def.body_count = 1;
        let mut again = null_mut();
        let len = model_memory.len() * 8;
        assert_eq!(unsafe { model_init(model_memory.as_mut_ptr().cast(), len, def.get(), &mut again, null_mut()) }, 0);
        assert_eq!(unsafe { sim_time(sim, &mut t) }, bad);
        assert_eq!(unsafe { sim_step(sim, null_mut()) }, bad);
        sim_memory.fill(0);
        assert_eq!(unsafe { sim_time(sim, &mut t) }, bad);
    });
}

#[test]
fn a_failed_set_up_leaves_no_object() {
    with_scene(|def, bodies, _| {
        let (mut memory, model) = compile(def);
        // A bow tie crosses itself: found while the outline is being built.
        const TIE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let mut tie = link();
        (tie.shape.kind, tie.shape.points, tie.shape.point_count) = (NEKTON_SHAPE_POLYGON, TIE.as_ptr(), 4);
        bodies[1].links = &raw const tie;
        let (mut diag, mut again) = (empty_diag(), null_mut());
        let mut need = nekton_req::default();
        assert_eq!(unsafe { model_req(def.get(), &mut need, &mut diag) }, 0);
        memory.resize(need.size / 8 + 8, 0);
        let got = unsafe { model_init(memory.as_mut_ptr().cast(), need.size, def.get(), &mut again, &mut diag) };
        assert_eq!(got, Status::SelfIntersection.code());
        assert_eq!((diag.place.kind, diag.place.index, diag.place.link), (NEKTON_PLACE_LINK, 1, 0));
        assert!(again.is_null());
        let mut plan = std::mem::MaybeUninit::uninit();
        let handle = memory.as_ptr().cast::<ModelHandle<f64>>();
        assert_eq!(unsafe { model_plan(handle, plan.as_mut_ptr()) }, Status::BadHandle.code());
        let _ = model;
    });
    with_scene(|def, bodies, _| {
        bodies[1].pose = [0.1, 0.0, 0.0];
        let (_memory, model) = compile(def);
        let mut need = nekton_req::default();
        assert_eq!(unsafe { sim_req(model, &adams(), &mut need, null_mut()) }, 0);
        let (mut mem, mut sim, mut diag) = (memory(need.size), null_mut(), empty_diag());
        let got = unsafe { sim_init(mem.as_mut_ptr().cast(), need.size, model, &adams(), &mut sim, &mut diag) };
        assert_eq!(got, Status::Overlap.code());
        assert_eq!((diag.place.kind, diag.other.kind), (NEKTON_PLACE_LINK, NEKTON_PLACE_LINK));
        assert!(sim.is_null());
    });
}

#[test]
fn outlines_that_were_turned_round_are_a_notice() {
    with_scene(|def, bodies, _| {
        const CLOCKWISE: [[f64; 2]; 3] = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
        let mut triangle = link();
        (triangle.shape.kind, triangle.shape.points, triangle.shape.point_count) =
            (NEKTON_SHAPE_POLYGON, CLOCKWISE.as_ptr(), 3);
        bodies[1].links = &raw const triangle;
        let mut diag = empty_diag();
        let (mut model, mut status) = (null_mut(), 0);
        assert_eq!(unsafe { model_create(def.get(), &mut model, &mut diag) }, Status::OutlineReversed.code());
        assert_eq!((diag.place.kind, diag.place.index), (NEKTON_PLACE_LINK, 1));
        assert_eq!(plan(model).notices, 1);
        let mut place = diag.other;
        assert_eq!(unsafe { model_notice(model, 0, &mut place, &mut status) }, 0);
        assert_eq!((place, status), (diag.place, Status::OutlineReversed.code()));
        assert_eq!(unsafe { model_notice(model, 1, &mut place, &mut status) }, Status::OutOfRange.code());
        assert_eq!(unsafe { model_free(model) }, 0);
    });
}

#[test]
fn tolerances_in_space_that_nothing_meets_are_refused() {
    for (bad, status) in [(-1.0, Status::BadTolerance), (1e-16, Status::BadTolerance), (f64::NAN, Status::NotFinite)] {
        with_scene(|def, _, _| {
            def.tolerance = bad;
            refused(def.get(), status, SCENE, "tolerance");
        });
    }
}

#[test]
fn steps_that_exceed_the_tolerance_in_space_return_a_notice() {
    // Two discs side by side: a mirror image of itself, where asymmetry shows nothing.
    let mut link = ellipse(1.0, 1.0);
    link.nodes = 32;
    let mut bodies = [body(), body()];
    for (b, x) in [(0, 0.0), (1, 2.2)] {
        (bodies[b].pose, bodies[b].velocity) = ([x, 0.0, 0.0], [0.0, 0.1, 0.0]);
        (bodies[b].links, bodies[b].link_count) = (&link, 1);
    }
    for (tolerance, expected) in [(0.0, 0), (0.9, 0), (1e-9, Status::Unresolved.code())] {
        let mut def = scene();
        (def.bodies, def.body_count, def.tolerance) = (bodies.as_ptr(), 2, tolerance);
        def.quadrature = NEKTON_QUADRATURE_PLAIN;
        let (mut model, mut sim, mut diag) = (null_mut(), null_mut(), empty_diag());
        unsafe {
            assert_eq!(model_create(&def, &mut model, &mut diag), 0);
            assert_eq!(plan(model).tolerance, tolerance);
            assert_eq!(sim_create(model, &adams(), &mut sim, &mut diag), 0);
            for k in 1..=3 {
                assert_eq!(sim_advance(sim, 0.1 * f64::from(k), &mut diag), expected);
            }
            assert_eq!(sim_step(sim, &mut diag), expected);
            if expected > 0 {
                assert_eq!((diag.place.index, diag.other.index, diag.item), (0, 1, -1));
                assert!(diag.value > 1e-9 && diag.time >= 0.3, "{} {}", diag.value, diag.time);
                assert_eq!(diag.what[..6].iter().map(|c| *c as u8).collect::<Vec<_>>(), b"error\0");
            }
            assert_eq!((sim_free(sim), model_free(model)), (0, 0));
        }
    }
}

#[test]
fn calls_that_fail_leave_the_simulation_bit_for_bit_as_it_was() {
    let fixed_steps = [NEKTON_METHOD_RK4, NEKTON_METHOD_ABM4, NEKTON_METHOD_GAUSS6].map(fixed);
    for method in fixed_steps.into_iter().chain([adams()]) {
        // Two bodies on a collision course.
        let link = ellipse(0.5, 0.5);
        let mut bodies = [body(), body()];
        for (b, x, v) in [(0, 0.0, 1.0), (1, 2.0, -1.0)] {
            (bodies[b].pose, bodies[b].velocity) = ([x, 0.0, 0.0], [v, 0.0, 0.0]);
            (bodies[b].links, bodies[b].link_count) = (&link, 1);
        }
        let mut def = scene();
        // In vacuum nothing keeps them apart.
        (def.bodies, def.body_count, def.fluid_density) = (bodies.as_ptr(), 2, 0.0);
        let (_model_memory, model) = compile(&def);
        let (_memory, sim) = simulate(model, &method);
        let (_twin_memory, twin) = simulate(model, &method);
        for s in [sim, twin] {
            assert_eq!(unsafe { sim_advance(s, 0.1, null_mut()) }, 0);
            assert_eq!(unsafe { sim_advance_dense(s, 0.12, 0.2, null_mut()) }, 0);
        }
        let shown = |s| {
            let (mut q, mut qd, mut c) = ([0.0; 6], [0.0; 6], nekton_counters::default());
            unsafe {
                assert_eq!(sim_positions(s, q.as_mut_ptr(), 6), 0);
                assert_eq!(sim_velocities(s, qd.as_mut_ptr(), 6), 0);
                assert_eq!(sim_counters(s, &mut c), 0);
            }
            (state(model, s), q, qd, c)
        };
        let before = shown(sim);
        let mut diag = empty_diag();
        let n = before.0.1.len();
        let (mut out, nan) = (vec![0.0; n], f64::NAN);
        let mut y = before.0.1.clone();
        y[0] = 2.0;
        unsafe {
            assert_eq!(sim_advance(sim, 5.0, &mut diag), Status::Contact.code());
            assert!(diag.time > 0.12 && diag.time < 1.0, "{diag:?}");
            assert_eq!(diag.place.kind, NEKTON_PLACE_LINK);
            assert_eq!(shown(sim), before);
            assert_eq!(sim_advance_dense(sim, 5.0, 6.0, &mut diag), Status::Contact.code());
            assert_eq!(sim_advance(sim, 0.0, &mut diag), Status::BadStep.code());
            assert_eq!(sim_set_step_limit(sim, 0), Status::OutOfRange.code());
            // Of free flight the variable-step method makes one step.
            if method.kind != NEKTON_METHOD_ADAMS {
                assert_eq!(sim_set_step_limit(sim, 1), 0);
                assert_eq!(sim_advance(sim, 0.3, &mut diag), Status::TooManySteps.code());
                assert!(diag.time > 0.12 && diag.time < 0.3, "{diag:?}");
            }
            assert_eq!(sim_set_step_limit(sim, 1_000_000), 0);
            assert_eq!(sim_advance(sim, nan, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_advance(sim, f64::INFINITY, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_advance_dense(sim, 0.3, 0.2, &mut diag), Status::BadStep.code());
            assert_eq!(sim_set_state(sim, 0.0, y.as_ptr(), n, &mut diag), Status::Contact.code());
            assert_eq!(sim_set_state(sim, nan, y.as_ptr(), n, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_set_state(sim, 0.0, y.as_ptr(), n - 1, &mut diag), Status::Length.code());
            assert_eq!(sim_set_state(sim, 0.0, null(), n, &mut diag), Status::NullPointer.code());
            assert_eq!(sim_rhs(sim, 0.0, y.as_ptr(), out.as_mut_ptr(), n, &mut diag), Status::Contact.code());
            assert!(out.iter().all(|x| *x == 0.0));
            y[1] = nan;
            assert_eq!(sim_set_state(sim, 0.0, y.as_ptr(), n, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_rhs(sim, 0.0, y.as_ptr(), out.as_mut_ptr(), n, &mut diag), Status::NotFinite.code());
            let y = y.as_mut_ptr();
            assert_eq!(sim_rhs(sim, 0.0, y, y.add(1), n, &mut diag), Status::Aliasing.code());
            assert_eq!(
                sim_set_channel(sim, 0, [0.0; 4].as_ptr(), [1.0; 4].as_ptr(), &mut diag),
                Status::Unsupported.code()
            );
            assert_eq!(
                sim_set_channel(sim, 0, [nan; 4].as_ptr(), [1.0; 4].as_ptr(), &mut diag),
                Status::NotFinite.code()
            );
            assert_eq!(
                sim_set_channel(sim, 0, [1.0; 4].as_ptr(), [1.0; 4].as_ptr(), &mut diag),
                Status::BadTable.code()
            );
            // Buffers: wrong length, NULL, misaligned, inside the object.
            assert_eq!(sim_positions(sim, out.as_mut_ptr(), 5), Status::Length.code());
            assert_eq!(sim_positions(sim, null_mut(), 6), Status::NullPointer.code());
            assert_eq!(sim_positions(sim, out.as_mut_ptr().wrapping_byte_add(1), 6), Status::Misaligned.code());
            assert_eq!(sim_positions(sim, sim.cast::<f64>().wrapping_add(40), 6), Status::Aliasing.code());
            assert_eq!(sim_mass_matrix(sim, out.as_mut_ptr(), 6, &mut diag), Status::Length.code());
            assert_eq!(sim_mass_matrix(sim, out.as_mut_ptr(), usize::MAX, &mut diag), Status::Length.code());
            assert_eq!(sim_energy(sim, null_mut(), &mut diag), Status::NullPointer.code());
        }
        assert_eq!(shown(sim), before);
        // It goes on as if nothing had been tried.
        for s in [sim, twin] {
            assert_eq!(unsafe { sim_step(s, null_mut()) }, 0);
            let (t, _) = state(model, s);
            assert_eq!(unsafe { sim_advance(s, t + 1e-3, null_mut()) }, 0);
        }
        assert_eq!(shown(sim), shown(twin));
    }
}

#[test]
fn a_copy_goes_on_like_its_original() {
    with_scene(|def, _, links| {
        links[1].signal.kind = NEKTON_SIGNAL_CHANNEL;
        let (_model_memory, model) = compile(def);
        for method in [adams(), fixed(NEKTON_METHOD_ABM4), fixed(NEKTON_METHOD_GAUSS6)] {
            let (_a, original) = simulate(model, &method);
            let (_b, copy) = simulate(model, &fixed(NEKTON_METHOD_RK4));
            let (from, to) = ([0.0; 4], [0.5, 0.2, 0.0, 0.0]);
            unsafe {
                assert_eq!(sim_set_channel(original, 0, from.as_ptr(), to.as_ptr(), null_mut()), 0);
                assert_eq!(sim_advance_dense(original, 0.05, 0.06, null_mut()), 0);
                // The copy has been elsewhere.
                assert_eq!(sim_advance(copy, 0.2, null_mut()), 0);
                assert_eq!(sim_copy(copy, original, null_mut()), 0);
                assert_eq!(state(model, copy), state(model, original));
                for s in [original, copy] {
                    assert_eq!(sim_step(s, null_mut()), 0);
                    assert_eq!(sim_advance(s, 0.2, null_mut()), 0);
                }
                assert_eq!(state(model, copy), state(model, original));
                assert_eq!(sim_copy(copy, copy, null_mut()), 0);
                let (_m, other_model) = compile(def);
                let (_s, other) = simulate(other_model, &method);
                assert_eq!(sim_copy(other, original, null_mut()), Status::BadHandle.code());
                assert_eq!(sim_copy(null_mut(), original, null_mut()), Status::NullPointer.code());
            }
        }
    });
}

#[test]
fn objects_from_the_heap_work_and_are_freed() {
    with_scene(|def, _, _| unsafe {
        let (mut model, mut sim, mut back, mut diag) = (null_mut(), null_mut(), null(), empty_diag());
        assert_eq!(model_create(def.get(), &mut model, &mut diag), 0);
        assert_eq!(diag.status, 0);
        assert_eq!(sim_create(model, &adams(), &mut sim, &mut diag), 0);
        assert_eq!(sim_model(sim, &mut back), 0);
        assert_eq!(back, model.cast_const());
        assert_eq!(sim_advance(sim, 0.1, &mut diag), 0);
        let (_memory, mine) = simulate(model, &adams());
        assert_eq!(sim_advance(mine, 0.1, &mut diag), 0);
        assert_eq!(state(model, mine), state(model, sim));
        let mut info = std::mem::MaybeUninit::<nekton_joint_info>::uninit();
        assert_eq!(model_joint(model, 0, info.as_mut_ptr()), 0);
        assert_eq!(info.assume_init().prescribed, 0);
        assert_eq!(model_joint(model, 1, info.as_mut_ptr()), Status::OutOfRange.code());
        assert_eq!(sim_free(sim), 0);
        assert_eq!(model_free(model), 0);
    });
}

#[test]
fn texts_say_what_where_and_which_value() {
    let text = |diag: &nekton_diag| {
        let mut buffer = [1u8; 200];
        unsafe { nekton_ffi::shared::nekton_diag_text(diag, buffer.as_mut_ptr().cast(), 200) };
        String::from_utf8(buffer.iter().copied().take_while(|b| *b != 0).collect()).unwrap()
    };
    with_scene(|def, _, links| {
        links[1].shape.b = f64::INFINITY;
        let (mut req, mut diag) = (nekton_req::default(), empty_diag());
        unsafe { model_req(def.get(), &mut req, &mut diag) };
        assert_eq!(text(&diag), "body 0, link 1: a value is not finite (b = inf)");
        let mut short = [1u8; 9];
        unsafe { nekton_ffi::shared::nekton_diag_text(&diag, short.as_mut_ptr().cast(), 8) };
        assert_eq!(&short, b"body 0,\0\x01");
        for (value, expected) in [
            (-0.0012345, "-1.23450e-3"),
            (1.5, "1.50000"),
            (-42.0, "-42"),
            (6.02e23, "6.02000e23"),
            (9.9999999, "1.00000e1"),
        ] {
            diag.value = value;
            assert!(text(&diag).ends_with(&format!("(b = {expected})")), "{}", text(&diag));
        }
        for value in [f64::MAX, f64::MIN_POSITIVE, 5e-324, 0.0, -0.0] {
            diag.value = value;
            text(&diag);
        }
    });
    for status in Status::ALL {
        let of = |text: *const core::ffi::c_char| unsafe { std::ffi::CStr::from_ptr(text) }.to_str().unwrap();
        assert_eq!(of(nekton_ffi::shared::nekton_status_text(status.code())), status.text());
        assert_eq!(of(nekton_ffi::shared::nekton_status_name(status.code())), status.name());
    }
}
