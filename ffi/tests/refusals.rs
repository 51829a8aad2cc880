//! What is refused, and that nothing was touched then.

mod common;

use common::double::*;
use common::{empty_diag, memory, what, with_scene};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut};

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
    // Of the first version of the interface, whatever its size.
    for (version, size) in [(1, 0), (1, 8), (3, 0)] {
        with_scene(|def, _, _| {
            (def.abi_version, def.struct_size) = (version, def.struct_size + size);
            refused(def.get(), Status::AbiVersion, SCENE, "abi_version");
        });
    }
    for wrong in [1_u32.wrapping_neg(), 4, 16] {
        with_scene(|def, _, _| {
            def.struct_size = def.struct_size.wrapping_sub(wrong).max(4);
            refused(def.get(), Status::AbiVersion, SCENE, "struct_size");
        });
    }
    with_scene(|def, _, _| {
        def.struct_size = 0;
        refused(def.get(), Status::AbiVersion, SCENE, "call nekton_scene_def_init");
    });
    macro_rules! init {
        ($init:ident, $definition:ty) => {
            let mut def = std::mem::MaybeUninit::<$definition>::uninit();
            let size = size_of::<$definition>();
            for (at, size, version, status) in [
                (null_mut(), size, 2, Status::NullPointer),
                (def.as_mut_ptr().wrapping_byte_add(1), size, 2, Status::Misaligned),
                (def.as_mut_ptr(), size, 1, Status::AbiVersion),
                (def.as_mut_ptr(), size, 3, Status::AbiVersion),
                (def.as_mut_ptr(), 0, 2, Status::AbiVersion),
                (def.as_mut_ptr(), size - 4, 2, Status::AbiVersion),
                (def.as_mut_ptr(), size + 1, 2, Status::AbiVersion),
                (def.as_mut_ptr(), usize::MAX & !7, 2, Status::AbiVersion),
            ] {
                assert_eq!(unsafe { $init(at, size, version) }, status.code(), "{size} {version}");
            }
        };
    }
    init!(scene_def_init, SceneDef<f64>);
    init!(wall_def_init, WallDef<f64>);
    init!(body_def_init, BodyDef<f64>);
    init!(link_def_init, LinkDef<f64>);
    init!(method_init, MethodDef<f64>);
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
            (MethodDef { max_step: -0.1, ..adams() }, Status::BadStep),
            (MethodDef { max_step: f64::NAN, ..adams() }, Status::BadStep),
            (MethodDef { first_step: f64::INFINITY, ..adams() }, Status::BadStep),
            (MethodDef { max_step: 0.1, ..fixed(NEKTON_METHOD_RK4) }, Status::OutOfRange),
            (MethodDef { first_step: 0.1, ..fixed(NEKTON_METHOD_ABM4) }, Status::OutOfRange),
            (MethodDef { first_step: f64::NAN, ..fixed(NEKTON_METHOD_GAUSS6) }, Status::OutOfRange),
            (MethodDef { struct_size: 0, ..adams() }, Status::AbiVersion),
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
fn tolerances_in_space_that_nothing_meets_are_refused() {
    for (bad, status) in [(-1.0, Status::BadTolerance), (1e-16, Status::BadTolerance), (f64::NAN, Status::NotFinite)] {
        with_scene(|def, _, _| {
            def.tolerance = bad;
            refused(def.get(), status, SCENE, "tolerance");
        });
    }
}
