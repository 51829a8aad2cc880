//! Callers that were compiled against an older or a newer header: their structs are smaller or larger, and mean the same.

mod common;

use common::{empty_diag, what};
use nekton::Status;
use nekton_ffi::shared::NEKTON_ABI_VERSION;
use nekton_ffi::types::*;
use std::mem::{MaybeUninit, offset_of};
use std::ptr::null_mut;

/// A definition as a newer header has it: something was appended.
#[repr(C)]
#[derive(Clone, Copy)]
struct Newer<T> {
    known: T,
    appended: [f64; 2],
}

/// Writes what the library sees through a pointer.
fn set<T>(field: *mut T, value: T) {
    unsafe { field.write_volatile(value) };
}

macro_rules! sizes {
    ($name:ident, $module:ident, $advice:literal) => {
        #[test]
        fn $name() {
            use common::$module::*;

            /// Filled by the library, which knows less of it.
            fn newer<T>(fill: impl FnOnce(*mut T, usize) -> nekton_status) -> Newer<T> {
                let mut def = MaybeUninit::<Newer<T>>::uninit();
                unsafe { def.as_mut_ptr().write_bytes(0xa5, 1) };
                assert_eq!(fill(def.as_mut_ptr().cast(), size_of::<Newer<T>>()), 0);
                let def = unsafe { def.assume_init() };
                assert_eq!(def.appended, [0.0; 2], "a field that the library does not know is none");
                def
            }
            let version = NEKTON_ABI_VERSION;
            let known = [ellipse(0.5, 0.2), ellipse(0.4, 0.3), ellipse(0.5, 0.3)];
            let mut links = [(); 3].map(|()| newer(|def, size| unsafe { link_def_init(def, size, version) }));
            for (new, old) in links.iter_mut().zip(&known) {
                assert_eq!(new.known.struct_size as usize, size_of::<Newer<LinkDef<Real>>>());
                new.known = LinkDef { struct_size: new.known.struct_size, ..*old };
            }
            let mut known = known;
            (known[1].parent, known[1].parent_anchor, known[1].self_anchor) = (0, [-0.7, 0.0], [0.7, 0.0]);
            known[1].drive = NEKTON_DRIVE_TORQUE;
            known[1].start = [0.1, 0.2];
            links[1].known = LinkDef { struct_size: links[1].known.struct_size, ..known[1] };
            let mut bodies = [(); 2].map(|()| newer(|def, size| unsafe { body_def_init(def, size, version) }));
            let mut old_bodies = [body(), body()];
            for (b, (new, old)) in bodies.iter_mut().zip(&mut old_bodies).enumerate() {
                let at = 2 * b;
                (old.pose, old.links, old.link_count) = ([3.0 * b as Real, 0.0, 0.5], &known[at], 2 - b);
                let first = &raw const links[at];
                new.known = BodyDef { struct_size: new.known.struct_size, links: first.cast(), ..*old };
            }
            let mut walls = [(); 2].map(|()| newer(|def, size| unsafe { wall_def_init(def, size, version) }));
            let mut old_walls = [wall(), wall()];
            for (w, (new, old)) in walls.iter_mut().zip(&mut old_walls).enumerate() {
                (old.shape.kind, old.shape.a, old.shape.b, old.nodes) = (NEKTON_SHAPE_ELLIPSE, 1.0, 0.5, 32);
                old.position = [0.0, -4.0 - 4.0 * w as Real];
                new.known = WallDef { struct_size: new.known.struct_size, ..*old };
            }
            let (mut tank, mut old_tank) = (walls[0], old_walls[0]);
            for def in [&mut tank.known, &mut old_tank] {
                (def.shape.a, def.shape.b, def.position, def.nodes) = (20.0, 20.0, [0.0; 2], 64);
            }
            let mut old = scene();
            old.gravity = 9.0;
            (old.tank, old.obstacles, old.obstacle_count) = (&old_tank, old_walls.as_ptr(), 2);
            (old.bodies, old.body_count) = (old_bodies.as_ptr(), 2);
            let mut new = newer(|def, size| unsafe { scene_def_init(def, size, version) });
            new.known = SceneDef {
                struct_size: new.known.struct_size,
                tank: (&raw const tank).cast(),
                obstacles: walls.as_ptr().cast(),
                bodies: bodies.as_ptr().cast(),
                ..old
            };

            // A newer caller's scene and method move as one of the same age does.
            let run = |def: *const SceneDef<Real>, method: *const MethodDef<Real>| unsafe {
                let (_model_memory, model) = compile(&*def);
                let (_memory, sim) = simulate(model, &*method);
                assert_eq!(sim_advance(sim, 0.1, null_mut()), 0);
                let mut counters = nekton_counters::default();
                assert_eq!(sim_counters(sim, &mut counters), 0);
                (state(model, sim), counters)
            };
            let of_today = run(&old, &adams());
            let mut method = newer(|def, size| unsafe { method_init(def, size, version) });
            method.known = MethodDef { struct_size: method.known.struct_size, ..adams() };
            assert_eq!(run((&raw const new).cast(), (&raw const method).cast()), of_today);

            // A caller from before `allow_unresolved` gets none of it, whatever lies behind.
            let before = offset_of!(SceneDef<Real>, allow_unresolved) as u32;
            let older = SceneDef { struct_size: before, allow_unresolved: 77, reserved: 77, ..old };
            assert_eq!(run(&older, &adams()), of_today);

            // Nor does one from before `corners`: his array is walked by the size that he knows.
            let end = offset_of!(LinkDef<Real>, corners);
            let mut bytes = vec![0xa5_u8; 2 * end + size_of::<LinkDef<Real>>()];
            let mut aligned = vec![0_u64; bytes.len() / 8 + 1];
            for (k, def) in known.iter().take(2).enumerate() {
                let old = LinkDef { struct_size: end as u32, corners: 77, ..*def };
                unsafe {
                    let to = bytes.as_mut_ptr().add(k * end);
                    core::ptr::copy_nonoverlapping((&raw const old).cast::<u8>(), to, end);
                }
            }
            unsafe {
                core::ptr::copy_nonoverlapping(bytes.as_ptr(), aligned.as_mut_ptr().cast::<u8>(), bytes.len());
            }
            let end = offset_of!(WallDef<Real>, corners) as u32;
            let of_old = old_walls.map(|wall| WallDef { struct_size: end, corners: 77, ..wall });
            let lone = LinkDef { struct_size: offset_of!(LinkDef<Real>, corners) as u32, corners: 77, ..known[2] };
            let mut bodies_of_old = old_bodies;
            (bodies_of_old[0].links, bodies_of_old[1].links) = (aligned.as_ptr().cast(), &lone);
            let older = SceneDef { obstacles: &of_old[0], obstacle_count: 1, bodies: bodies_of_old.as_ptr(), ..old };
            let one = SceneDef { obstacle_count: 1, ..old };
            assert_eq!(run(&older, &adams()), run(&one, &adams()));

            // A field that this library does not know, set by a newer caller, is refused, and the place is told.
            let mut diag = empty_diag();
            let mut req = nekton_req::default();
            macro_rules! refused {
                ($field:expr, $place:expr) => {
                    set(&raw mut $field, 1e-300);
                    let at: *const SceneDef<Real> = (&raw const new).cast();
                    assert_eq!(unsafe { model_req(at, &mut req, &mut diag) }, Status::Unsupported.code());
                    assert_eq!((diag.place.kind, diag.place.index, diag.place.link), $place);
                    assert_eq!(what(&diag), "a field of a newer header");
                    set(&raw mut $field, 0.0);
                };
            }
            // Read by the library through pointers to them.
            new.known.tank = (&raw const tank).cast();
            refused!(new.appended[0], (NEKTON_PLACE_SCENE, -1, -1));
            refused!(new.appended[1], (NEKTON_PLACE_SCENE, -1, -1));
            refused!(tank.appended[1], (NEKTON_PLACE_TANK, -1, -1));
            refused!(walls[1].appended[0], (NEKTON_PLACE_OBSTACLE, 1, -1));
            refused!(bodies[1].appended[0], (NEKTON_PLACE_BODY, 1, -1));
            refused!(links[1].appended[1], (NEKTON_PLACE_LINK, 0, 1));
            let (_model_memory, model) = compile(unsafe { &*(&raw const new).cast() });
            set(&raw mut method.appended[1], 1.0);
            let status = unsafe { sim_req(model, (&raw const method).cast(), &mut req, &mut diag) };
            assert_eq!((status, what(&diag).as_str()), (Status::Unsupported.code(), "a field of a newer header"));

            // One item of an array of another size, or of none: refused with its number.
            let own = size_of::<Newer<LinkDef<Real>>>() as u32;
            for (size, quantity, item) in [(own + 8, "struct_size", 1), (own - 16, "struct_size", 1), (0, $advice, -1)]
            {
                set(&raw mut links[1].known.struct_size, size);
                let at: *const SceneDef<Real> = (&raw const new).cast();
                assert_eq!(unsafe { model_req(at, &mut req, &mut diag) }, Status::AbiVersion.code());
                assert_eq!((diag.place.kind, diag.place.index, diag.place.link), (NEKTON_PLACE_LINK, 0, 1));
                assert_eq!((what(&diag).as_str(), diag.item), (quantity, item));
                set(&raw mut links[1].known.struct_size, own);
            }
            // Rubbish where a size should be: nothing is read by it.
            for size in [1, 4, size_of::<LinkDef<Real>>() as u32 - 8, own + 1, 1 << 20, u32::MAX - 7] {
                set(&raw mut links[0].known.struct_size, size);
                let at: *const SceneDef<Real> = (&raw const new).cast();
                assert_eq!(unsafe { model_req(at, &mut req, &mut diag) }, Status::AbiVersion.code());
                assert_eq!(
                    (diag.place.kind, diag.place.link, what(&diag).as_str()),
                    (NEKTON_PLACE_LINK, 0, "struct_size")
                );
                set(&raw mut links[0].known.struct_size, own);
            }

            // An older caller's method ends before max_step: what lies behind it is not looked at.
            let older = offset_of!(MethodDef<Real>, max_step);
            let mut method = MethodDef { max_step: Real::NAN, first_step: -1.0, ..adams() };
            method.struct_size = older as u32;
            assert_eq!(run(&old, &method), of_today);
            unsafe { (&raw mut method).write_bytes(0xa5, 1) };
            assert_eq!(unsafe { method_init(&mut method, older, version) }, 0);
            assert_eq!((method.struct_size as usize, method.kind), (older, NEKTON_METHOD_ADAMS));
            assert_eq!(method.max_step.to_ne_bytes(), [0xa5; size_of::<Real>()], "not the library's to write");
            // With the new field the longest step is kept.
            let short = MethodDef { max_step: 0.005, first_step: 0.0025, ..adams() };
            let (_, counters) = run(&old, &short);
            assert!(counters.steps >= 21 && counters.steps < 30, "{counters:?}");
        }
    };
}

sizes!(definitions_of_older_and_newer_callers_mean_the_same, double, "call nekton_link_def_init");
sizes!(definitions_of_older_and_newer_callers_mean_the_same_in_single_precision, single, "call nekton32_link_def_init");
