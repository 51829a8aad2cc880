//! Objects that were accepted: what a failed call leaves of them, copies, threads, memory, notices and texts.

mod common;

use common::double::*;
use common::{empty_diag, memory, with_scene};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut};

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
fn corners_of_curves_are_found_given_or_left_out_and_a_wrong_number_is_refused() {
    with_scene(|def, bodies, _| {
        let corner = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        // Three points on each side between the corners.
        let point = |k: usize| -> [f64; 2] {
            let (a, b, t): ([f64; 2], [f64; 2], f64) = (corner[k / 4], corner[(k / 4 + 1) % 4], (k % 4) as f64 / 4.0);
            [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
        };
        let points: Vec<[f64; 2]> = (0..16).map(point).collect();
        let mut square = link();
        (square.shape.kind, square.shape.points, square.shape.point_count) =
            (NEKTON_SHAPE_CURVE, points.as_ptr(), points.len());
        // Between the others' curved flanks a smooth curve is larger.
        let mut area = |corners: i32, given: &[usize]| {
            (square.corners, square.corner_points, square.corner_count) = (corners, given.as_ptr(), given.len());
            (bodies[0].links, bodies[0].link_count) = (&raw const square, 1);
            bodies[0].pose = [0.0, 5.0, 0.0];
            let (mut model, mut diag) = (null_mut(), empty_diag());
            let status = unsafe { model_create(def.get(), &mut model, &mut diag) };
            if status < 0 {
                return (status, [f64::NAN; 2], diag.value);
            }
            let mut error = f64::NAN;
            let place = nekton_place { kind: NEKTON_PLACE_LINK, index: 0, link: 0 };
            assert_eq!(unsafe { model_outline_error(model, &place, &mut error) }, 0);
            let mut info = unsafe { std::mem::zeroed::<LinkOut<f64>>() };
            assert_eq!(unsafe { model_link(model, 0, &mut info) }, 0);
            assert_eq!(unsafe { model_free(model) }, 0);
            (status, [info.area, error], f64::NAN)
        };
        let (found, [by_itself, error], _) = area(NEKTON_CORNERS_AUTO, &[]);
        assert_eq!(found, Status::CornersFound.code());
        assert!((by_itself - 4.0).abs() < 1e-9, "{by_itself}");
        assert!(error < 1e-6, "{error:e}");
        let (given, [same, _], _) = area(NEKTON_CORNERS_GIVEN, &[12, 0, 4, 8]);
        assert_eq!((given, same.to_bits()), (0, by_itself.to_bits()));
        let (smooth, [bulging, error], _) = area(NEKTON_CORNERS_NONE, &[]);
        assert_eq!(smooth, Status::OutlineUncertain.code());
        assert!(bulging > 4.0 + 1e-3 && error > 1e-2, "{bulging} {error:e}");
        let (wrong, _, value) = area(NEKTON_CORNERS_GIVEN, &[0, 16]);
        assert_eq!((wrong, value), (Status::OutOfRange.code(), 16.0));
        assert_eq!(area(3, &[]).0, Status::UnknownKind.code());
        let reserved = LinkDef { corners: NEKTON_CORNERS_NONE, corners_reserved: 1, ..square };
        bodies[0].links = &raw const reserved;
        let (mut model, mut diag) = (null_mut(), empty_diag());
        assert_eq!(unsafe { model_create(def.get(), &mut model, &mut diag) }, Status::Unsupported.code());
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
fn steps_that_exceed_the_tolerance_in_space_return_a_notice() {
    // Two discs side by side: a mirror image of itself, where asymmetry shows nothing.
    let mut link = ellipse(1.0, 1.0);
    link.nodes = 32;
    let mut bodies = [body(), body()];
    for (b, x) in [(0, 0.0), (1, 2.2)] {
        (bodies[b].pose, bodies[b].velocity) = ([x, 0.0, 0.0], [0.0, 0.1, 0.0]);
        (bodies[b].links, bodies[b].link_count) = (&link, 1);
    }
    for (tolerance, expected) in [(0.0, Status::Unresolved.code()), (9.0, 0), (1e-9, Status::Unresolved.code())] {
        let mut def = scene();
        (def.bodies, def.body_count, def.tolerance) = (bodies.as_ptr(), 2, tolerance);
        def.quadrature = NEKTON_QUADRATURE_PLAIN;
        let (mut model, mut sim, mut diag) = (null_mut(), null_mut(), empty_diag());
        unsafe {
            assert_eq!(model_create(&def, &mut model, &mut diag), 0);
            assert_eq!(plan(model).tolerance, if tolerance > 0.0 { tolerance } else { 1e-3 });
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
fn steps_too_long_for_the_motion_return_a_notice() {
    // A disc that circles once a second.
    let mut link = ellipse(1.0, 1.0);
    link.circulation = 39.5;
    let mut disc = body();
    (disc.velocity, disc.links, disc.link_count) = ([1.0, 0.0, 0.0], &link, 1);
    let mut def = scene();
    (def.bodies, def.body_count) = (&disc, 1);
    let (_model_memory, model) = compile(&def);
    for (step, too_long) in [(0.01, false), (0.5, true)] {
        let (_memory, sim) = simulate(model, &MethodDef { step, ..fixed(NEKTON_METHOD_RK4) });
        let mut diag = empty_diag();
        let status = unsafe { sim_advance(sim, 20.0 * step, &mut diag) };
        assert_eq!(status, if too_long { Status::StepTooLong.code() } else { 0 });
        if too_long {
            assert!(diag.value >= 0.1 && diag.time > 6.0 * step && diag.time <= 20.0 * step, "{diag:?}");
            assert_eq!(common::what(&diag), "error");
        }
        // It is over with the call.
        unsafe {
            assert_eq!(sim_restart(sim), 0);
            assert_eq!(sim_step(sim, &mut diag), 0);
        }
    }
}

/// A model of two discs on a collision course, which touch at t = 0.5: in vacuum nothing keeps them apart.
fn collision() -> (Vec<u64>, *mut ModelHandle<f64>) {
    let link = ellipse(0.5, 0.5);
    let mut bodies = [body(), body()];
    for (b, x, v) in [(0, 0.0, 1.0), (1, 2.0, -1.0)] {
        (bodies[b].pose, bodies[b].velocity) = ([x, 0.0, 0.0], [v, 0.0, 0.0]);
        (bodies[b].links, bodies[b].link_count) = (&link, 1);
    }
    let mut def = scene();
    (def.bodies, def.body_count, def.fluid_density) = (bodies.as_ptr(), 2, 0.0);
    compile(&def)
}

/// State, positions, velocities and counters.
type Shown = ((f64, Vec<f64>), Vec<f64>, Vec<f64>, nekton_counters);

fn shown(model: *const ModelHandle<f64>, sim: *const SimHandle<f64>) -> Shown {
    let n = plan(model).coordinates;
    let (mut q, mut qd, mut c) = (vec![0.0; n], vec![0.0; n], nekton_counters::default());
    unsafe {
        assert_eq!(sim_positions(sim, q.as_mut_ptr(), n), 0);
        assert_eq!(sim_velocities(sim, qd.as_mut_ptr(), n), 0);
        assert_eq!(sim_counters(sim, &mut c), 0);
    }
    (state(model, sim), q, qd, c)
}

fn every_method() -> [MethodDef<f64>; 4] {
    let [rk4, abm4, gauss6] = [NEKTON_METHOD_RK4, NEKTON_METHOD_ABM4, NEKTON_METHOD_GAUSS6].map(fixed);
    [rk4, abm4, gauss6, adams()]
}

#[test]
fn calls_that_fail_leave_the_simulation_bit_for_bit_as_it_was() {
    for method in every_method() {
        let (_model_memory, model) = collision();
        let (_memory, sim) = simulate(model, &method);
        let (_twin_memory, twin) = simulate(model, &method);
        for s in [sim, twin] {
            assert_eq!(unsafe { sim_advance(s, 0.1, null_mut()) }, 0);
            assert_eq!(unsafe { sim_advance_dense(s, 0.12, 0.2, null_mut()) }, 0);
        }
        let shown = |s| shown(model, s);
        let before = shown(sim);
        let mut diag = empty_diag();
        let n = before.0.1.len();
        let (mut out, nan) = (vec![0.0; n], f64::NAN);
        let mut y = before.0.1.clone();
        y[0] = 2.0;
        unsafe {
            assert_eq!(sim_advance(sim, 0.0, &mut diag), Status::PastTime.code());
            assert_eq!(sim_set_step_limit(sim, 0), Status::OutOfRange.code());
            assert_eq!(sim_advance(sim, nan, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_advance(sim, f64::INFINITY, &mut diag), Status::NotFinite.code());
            assert_eq!(sim_advance_dense(sim, 0.3, 0.2, &mut diag), Status::PastTime.code());
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
fn an_advance_that_fails_keeps_the_steps_that_it_made_and_a_step_that_fails_nothing() {
    for method in every_method() {
        let (_model_memory, model) = collision();
        let (_memory, sim) = simulate(model, &method);
        let mut diag = empty_diag();
        let on_course = |t: f64| {
            let ((time, _), q, ..) = shown(model, sim);
            assert!(time == t && (q[0] - t).abs() < 1e-12 && (q[3] - (2.0 - t)).abs() < 1e-12, "{t} {time} {q:?}");
        };
        unsafe {
            assert_eq!(sim_advance(sim, 0.1, &mut diag), 0);
            assert_eq!(sim_advance(sim, 5.0, &mut diag), Status::Contact.code());
            assert_eq!(diag.place.kind, NEKTON_PLACE_LINK);
            assert!(diag.time > 0.1 && diag.time < 0.5, "{diag:?}");
            on_course(diag.time);
            if method.kind != NEKTON_METHOD_ADAMS {
                assert!(diag.time > 0.485);
                let before = shown(model, sim);
                assert_eq!(sim_step(sim, &mut diag), Status::Contact.code());
                assert_eq!(sim_advance(sim, 5.0, &mut diag), Status::Contact.code());
                assert_eq!(shown(model, sim), before);
                assert_eq!(sim_advance(sim, 0.495, &mut diag), 0);
                on_course(0.495);
            }
        }
    }
}

#[test]
fn an_advance_cut_off_by_the_limit_of_steps_goes_on_as_if_it_had_not_been() {
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        // How many steps the variable-step method takes is not known before.
        let (_a, whole) = simulate(model, &adams());
        let (_b, parts) = simulate(model, &adams());
        let (mut diag, mut cut, mut last) = (empty_diag(), 0, 0.0);
        unsafe {
            assert_eq!(sim_advance(whole, 0.2, null_mut()), 0);
            assert_eq!(sim_set_step_limit(parts, 3), 0);
            while sim_advance(parts, 0.2, &mut diag) != 0 {
                assert_eq!(diag.status, Status::TooManySteps.code());
                assert!(diag.time > last && diag.time < 0.2 && cut < 100, "{diag:?}");
                assert_eq!(state(model, parts).0, diag.time);
                (last, cut) = (diag.time, cut + 1);
            }
        }
        assert!(cut > 0);
        assert_eq!(shown(model, parts), shown(model, whole));
        // Of fixed steps it is: nothing is begun that would not be finished, and both numbers are told.
        for method in &every_method()[..3] {
            let (_memory, sim) = simulate(model, method);
            unsafe {
                assert_eq!(sim_set_step_limit(sim, 3), 0);
                assert_eq!(sim_advance(sim, 0.2, &mut diag), Status::TooManySteps.code());
                assert_eq!((diag.value, diag.limit, diag.time, state(model, sim).0), (20.0, 3.0, 0.0, 0.0));
            }
        }
    });
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
        let mut buffer = [1u8; 256];
        unsafe { nekton_ffi::shared::nekton_diag_text(diag, buffer.as_mut_ptr().cast(), 256) };
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
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        let (_memory, sim) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        let mut diag = empty_diag();
        unsafe {
            assert_eq!(sim_advance(sim, 1e6, &mut diag), Status::TooManySteps.code());
            assert!(text(&diag).ends_with(" (steps = 1.00000e8 beside 1.00000e6) at t = 0"), "{}", text(&diag));
            assert_eq!(sim_advance(sim, 0.5, &mut diag), 0);
            assert_eq!(sim_advance(sim, 0.25, &mut diag), Status::PastTime.code());
            assert!(text(&diag).ends_with(" (t = 2.50000e-1 beside 5.00000e-1) at t = 5.00000e-1"), "{}", text(&diag));
        }
    });
    for status in Status::ALL {
        let of = |text: *const core::ffi::c_char| unsafe { std::ffi::CStr::from_ptr(text) }.to_str().unwrap();
        assert_eq!(of(nekton_ffi::shared::nekton_status_text(status.code())), status.text());
        assert_eq!(of(nekton_ffi::shared::nekton_status_name(status.code())), status.name());
    }
}
