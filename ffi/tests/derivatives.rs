//! Derivatives from C: what is refused, by name, and that asking changes nothing.

mod common;

use common::double::*;
use common::{empty_diag, memory, what, with_scene};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut};

/// A call with everything right, to be spoiled in one place.
struct Call {
    sim: *mut SimHandle<f64>,
    parameters: *const nekton_parameter,
    count: usize,
    a: *mut f64,
    a_len: usize,
    b: *mut f64,
    b_len: usize,
    bound: *mut f64,
    mem: *mut u64,
    len: usize,
}

impl Call {
    /// Status, and the diag.
    fn made(&self) -> (i32, nekton_diag) {
        let Call { sim, parameters, count, a, a_len, b, b_len, bound, mem, len } = *self;
        let mut diag = empty_diag();
        let status =
            unsafe { sim_linearize(sim, parameters, count, a, a_len, b, b_len, bound, mem.cast(), len, &mut diag) };
        (status, diag)
    }
}

fn of(kind: i32, index: i32) -> nekton_parameter {
    nekton_parameter { kind, index, component: 0, reserved: 0 }
}

fn requirement(model: *const ModelHandle<f64>) -> usize {
    let mut req = nekton_req::default();
    assert_eq!(unsafe { sim_derivatives_req(model, &mut req, null_mut()) }, 0);
    req.size
}

const METHODS: [i32; 3] = [NEKTON_METHOD_RK4, NEKTON_METHOD_ABM4, NEKTON_METHOD_GAUSS6];

fn methods() -> Vec<MethodDef<f64>> {
    METHODS.into_iter().map(fixed).chain([adams()]).collect()
}

/// Runs on by a few steps: time and state, bit for bit.
fn goes_on(model: *const ModelHandle<f64>, sim: *mut SimHandle<f64>) -> (u64, Vec<u64>) {
    for _ in 0..3 {
        assert_eq!(unsafe { sim_step(sim, null_mut()) }, 0);
    }
    let (t, y) = state(model, sim);
    (t.to_bits(), y.into_iter().map(f64::to_bits).collect())
}

/// Swimmer with a driven tail and, beside it, an ellipse; or the tail prescribed.
fn with_model(prescribed: bool, check: impl FnOnce(*const ModelHandle<f64>)) {
    with_scene(|def, _, links| {
        if prescribed {
            links[1].drive = NEKTON_DRIVE_MOTION;
            links[1].signal.kind = NEKTON_SIGNAL_CONSTANT;
        }
        let (_memory, model) = compile(def);
        check(model);
    });
}

#[test]
fn every_wrong_argument_is_named_and_the_simulation_goes_on_as_if_it_had_not_been_asked() {
    with_model(false, |model| {
        for method in methods() {
            let (_a, sim) = simulate(model, &method);
            let (_b, twin) = simulate(model, &method);
            for s in [sim, twin] {
                assert_eq!(unsafe { sim_advance(s, 0.05, null_mut()) }, 0);
            }
            let d = plan(model).state_len;
            let size = requirement(model);
            let mut parameters = [of(NEKTON_PARAMETER_GRAVITY, 0), of(NEKTON_PARAMETER_TORQUE, 0)];
            let mut mem = memory(size + 16);
            let place = mem.as_mut_ptr();
            let mut out = vec![7.0; d * d + 2 * d + 1];
            let (a, b, bound) = (out.as_mut_ptr(), out.as_mut_ptr().wrapping_add(d * d), d * d + 2 * d);
            let bound = out.as_mut_ptr().wrapping_add(bound);
            let call = |parameters: *const nekton_parameter| Call {
                sim,
                parameters,
                count: 2,
                a,
                a_len: d * d,
                b,
                b_len: 2 * d,
                bound,
                mem: place,
                len: size,
            };
            let given = parameters.as_ptr();
            let sound = || call(given);
            let refused = |spoilt: Call, status: Status, name: &str, item: i32, value: Option<f64>| {
                let (answer, diag) = spoilt.made();
                assert_eq!((answer, diag.status), (status.code(), status.code()), "{name} {}", what(&diag));
                assert_eq!((what(&diag).as_str(), diag.item), (name, item));
                if let Some(value) = value {
                    assert_eq!(diag.value, value, "{name}");
                }
                let out = unsafe { std::slice::from_raw_parts(a, d * d + 2 * d + 1) };
                assert!(out.iter().all(|x| *x == 0.0 || *x == 7.0), "{name}: half an answer");
            };
            // Lengths.
            for a_len in [0, d * d - 1, d * d + 1, usize::MAX] {
                refused(Call { a_len, ..sound() }, Status::Length, "length", -1, Some(a_len as f64));
            }
            for b_len in [0, 2 * d - 1, 2 * d + 1, usize::MAX] {
                refused(Call { b_len, ..sound() }, Status::Length, "length", -1, Some(b_len as f64));
            }
            refused(Call { count: 1, ..sound() }, Status::Length, "length", -1, None);
            refused(Call { count: usize::MAX, ..sound() }, Status::Length, "length", -1, None);
            // Pointers.
            let odd = |p: *mut f64| p.wrapping_byte_add(4);
            refused(Call { sim: null_mut(), ..sound() }, Status::NullPointer, "sim", -1, None);
            refused(Call { parameters: null(), ..sound() }, Status::NullPointer, "parameters", -1, None);
            let shifted = sound().parameters.wrapping_byte_add(2);
            refused(Call { parameters: shifted, ..sound() }, Status::Misaligned, "parameters", -1, None);
            refused(Call { a: null_mut(), ..sound() }, Status::NullPointer, "a", -1, None);
            refused(Call { b: null_mut(), ..sound() }, Status::NullPointer, "b", -1, None);
            refused(Call { bound: null_mut(), ..sound() }, Status::NullPointer, "bound", -1, None);
            refused(Call { bound: odd(bound), ..sound() }, Status::Misaligned, "bound", -1, None);
            refused(Call { a: odd(place.cast()), ..sound() }, Status::Aliasing, "mem", -1, None);
            let mut elsewhere = vec![0.0; d * d + 1];
            refused(Call { a: odd(elsewhere.as_mut_ptr()), ..sound() }, Status::Misaligned, "a", -1, None);
            refused(Call { b: odd(elsewhere.as_mut_ptr()), ..sound() }, Status::Misaligned, "b", -1, None);
            // Memory.
            refused(Call { mem: null_mut(), ..sound() }, Status::NullPointer, "mem", -1, None);
            let shifted = place.wrapping_byte_add(4);
            refused(Call { mem: shifted, ..sound() }, Status::Misaligned, "mem", -1, None);
            refused(Call { len: size - 1, ..sound() }, Status::MemoryTooSmall, "len", -1, Some((size - 1) as f64));
            refused(Call { len: 0, ..sound() }, Status::MemoryTooSmall, "len", -1, Some(0.0));
            // What lies on one another.
            refused(Call { b: a.wrapping_add(d * d - 1), ..sound() }, Status::Aliasing, "b", -1, None);
            refused(Call { bound: a, ..sound() }, Status::Aliasing, "bound", -1, None);
            refused(Call { bound: b, ..sound() }, Status::Aliasing, "bound", -1, None);
            refused(Call { bound: place.cast(), ..sound() }, Status::Aliasing, "mem", -1, None);
            refused(Call { mem: a.cast(), ..sound() }, Status::Aliasing, "mem", -1, None);
            refused(Call { mem: b.cast(), ..sound() }, Status::Aliasing, "mem", -1, None);
            for inside in [sim.cast::<f64>(), sim.cast::<f64>().wrapping_add(40)] {
                refused(Call { a: inside, ..sound() }, Status::Aliasing, "a", -1, None);
                refused(Call { b: inside, ..sound() }, Status::Aliasing, "b", -1, None);
                refused(Call { bound: inside, ..sound() }, Status::Aliasing, "bound", -1, None);
                refused(Call { mem: inside.cast(), ..sound() }, Status::Aliasing, "mem", -1, None);
            }
            let given = given.cast_mut();
            refused(Call { a: given.cast(), ..sound() }, Status::Aliasing, "a", -1, None);
            refused(Call { b: given.cast(), ..sound() }, Status::Aliasing, "b", -1, None);
            refused(Call { bound: given.cast(), ..sound() }, Status::Aliasing, "bound", -1, None);
            refused(Call { mem: given.cast(), ..sound() }, Status::Aliasing, "mem", -1, None);
            // Parameters, the second of which is wrong.
            let wrench = |index, component| nekton_parameter { component, ..of(NEKTON_PARAMETER_WRENCH, index) };
            let reserved = nekton_parameter { reserved: 1, ..of(NEKTON_PARAMETER_MASS, 0) };
            for (wrong, status, name, value) in [
                (of(0, 0), Status::UnknownKind, "parameter", 0),
                (of(13, 0), Status::UnknownKind, "parameter", 13),
                (of(-1, 0), Status::UnknownKind, "parameter", -1),
                (of(i32::MIN, 0), Status::UnknownKind, "parameter", i32::MIN),
                (of(NEKTON_PARAMETER_MASS, 3), Status::OutOfRange, "mass", 3),
                (of(NEKTON_PARAMETER_INERTIA, i32::MAX), Status::OutOfRange, "inertia", i32::MAX),
                (of(NEKTON_PARAMETER_MASS, -1), Status::OutOfRange, "index", -1),
                (of(NEKTON_PARAMETER_TORQUE, 1), Status::OutOfRange, "torque", 1),
                (of(NEKTON_PARAMETER_STIFFNESS, 1), Status::OutOfRange, "stiffness", 1),
                (of(NEKTON_PARAMETER_DAMPING, 1), Status::OutOfRange, "damping", 1),
                (of(NEKTON_PARAMETER_REST, i32::MIN), Status::OutOfRange, "index", i32::MIN),
                // Driven by a torque.
                (of(NEKTON_PARAMETER_POSITION, 0), Status::OutOfRange, "position", 0),
                (of(NEKTON_PARAMETER_RATE, 0), Status::OutOfRange, "rate", 0),
                (of(NEKTON_PARAMETER_ACCELERATION, 0), Status::OutOfRange, "acceleration", 0),
                (wrench(3, 0), Status::OutOfRange, "wrench", 3),
                (wrench(0, 3), Status::OutOfRange, "component", 3),
                (wrench(0, -1), Status::OutOfRange, "component", -1),
                (reserved, Status::Unsupported, "reserved", 1),
            ] {
                parameters[1] = wrong;
                refused(call(parameters.as_ptr()), status, name, 1, Some(f64::from(value)));
            }
            assert_eq!(goes_on(model, sim), goes_on(model, twin));
        }
    });
}

#[test]
fn a_joint_that_moves_as_prescribed_has_no_torque_to_differentiate_by() {
    with_model(true, |model| {
        let (_memory, sim) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        let (d, size) = (plan(model).state_len, requirement(model));
        let (mut mem, mut a, mut b, mut bound) = (memory(size), vec![7.0; d * d], vec![7.0; 3 * d], 7.0);
        let names = ["torque", "stiffness", "damping", "rest"];
        for (kind, name) in (NEKTON_PARAMETER_TORQUE..).zip(names) {
            let parameters = [of(NEKTON_PARAMETER_RATE, 0), of(NEKTON_PARAMETER_POSITION, 0), of(kind, 0)];
            let call = Call {
                sim,
                parameters: parameters.as_ptr(),
                count: 3,
                a: a.as_mut_ptr(),
                a_len: d * d,
                b: b.as_mut_ptr(),
                b_len: 3 * d,
                bound: &mut bound,
                mem: mem.as_mut_ptr(),
                len: size,
            };
            let (status, diag) = call.made();
            assert_eq!((status, diag.item, diag.value), (Status::OutOfRange.code(), 2, 0.0));
            assert_eq!(what(&diag), name);
            assert_eq!(call.made().0, status);
        }
        assert!(a.iter().chain(&b).all(|x| *x == 0.0) && bound == 7.0);
    });
}

#[test]
fn circulation_is_differentiated_and_a_run_goes_on_by_the_same_bits() {
    with_scene(|def, _, links| {
        links[2].circulation = 0.3;
        let (_model_memory, model) = compile(def);
        let (_a, sim) = simulate(model, &adams());
        let (_b, twin) = simulate(model, &adams());
        let (d, n, size) = (plan(model).state_len, plan(model).coordinates, requirement(model));
        let (mut mem, mut a, mut b, mut bound) = (memory(size), vec![7.0; d * d], vec![7.0; n * n], 7.0);
        let (mut c, place) = (vec![7.0; n * n], mem.as_mut_ptr().cast());
        let p = a.as_mut_ptr();
        let status =
            unsafe { sim_linearize(sim, null(), 0, p, d * d, null_mut(), 0, &mut bound, place, size, null_mut()) };
        assert!(status == 0 && a.iter().any(|x| *x != 0.0) && bound < 1.0);
        let qdd = vec![0.5; n];
        let (h, c) = (b.as_mut_ptr(), c.as_mut_ptr());
        let status = unsafe { sim_force_derivatives(sim, qdd.as_ptr(), n, h, c, place, size, null_mut()) };
        assert!(status == 0 && b.iter().all(|x| x.is_finite()) && b.iter().any(|x| *x != 0.0));
        assert_eq!(goes_on(model, sim), goes_on(model, twin));
    });
}

#[test]
fn the_boundary_formula_is_refused_by_name() {
    with_scene(|def, _, _| {
        def.force = NEKTON_FORCE_BOUNDARY;
        let (_model_memory, model) = compile(def);
        let (_memory, sim) = simulate(model, &adams());
        let (d, size) = (plan(model).state_len, requirement(model));
        let (mut mem, mut a, mut bound) = (memory(size), vec![7.0; d * d], 7.0);
        let (p, place, mut diag) = (a.as_mut_ptr(), mem.as_mut_ptr().cast(), empty_diag());
        let status =
            unsafe { sim_linearize(sim, null(), 0, p, d * d, null_mut(), 0, &mut bound, place, size, &mut diag) };
        assert_eq!((status, what(&diag).as_str()), (Status::Unsupported.code(), "force formula"));
        assert!(a.iter().all(|x| *x == 0.0) && bound == 7.0);
    });
}

#[test]
fn every_wrong_argument_of_the_derivatives_of_forces_is_named() {
    with_model(false, |model| {
        let (_a, sim) = simulate(model, &fixed(NEKTON_METHOD_ABM4));
        let (_b, twin) = simulate(model, &fixed(NEKTON_METHOD_ABM4));
        let (n, size) = (plan(model).coordinates, requirement(model));
        let mut mem = memory(size);
        let (mut qdd, mut out) = (vec![0.1; n], vec![7.0; 2 * n * n]);
        let (q, p) = (qdd.as_mut_ptr(), out.as_mut_ptr());
        let (v, m) = (p.wrapping_add(n * n), mem.as_mut_ptr());
        let odd = |p: *mut f64| p.wrapping_byte_add(4);
        type Arguments = (*mut f64, usize, *mut f64, *mut f64, *mut u64, usize);
        let refused = |(q, n, p, v, m, len): Arguments, status: Status, name: &str| {
            let mut diag = empty_diag();
            let answer = unsafe { sim_force_derivatives(sim, q, n, p, v, m.cast(), len, &mut diag) };
            assert_eq!((answer, what(&diag).as_str()), (status.code(), name));
        };
        refused((q, n - 1, p, v, m, size), Status::Length, "length");
        refused((q, usize::MAX, p, v, m, size), Status::Length, "length");
        refused((null_mut(), n, p, v, m, size), Status::NullPointer, "qdd");
        refused((odd(q), n, p, v, m, size), Status::Misaligned, "qdd");
        refused((q, n, null_mut(), v, m, size), Status::NullPointer, "position");
        refused((q, n, p, null_mut(), m, size), Status::NullPointer, "velocity");
        refused((q, n, p, p, m, size), Status::Aliasing, "velocity");
        refused((q, n, p, p.wrapping_add(n * n - 1), m, size), Status::Aliasing, "velocity");
        refused((q, n, q, v, m, size), Status::Aliasing, "position");
        refused((q, n, p, q, m, size), Status::Aliasing, "velocity");
        refused((q, n, p, v, p.cast(), size), Status::Aliasing, "mem");
        refused((q, n, p, v, q.cast(), size), Status::Aliasing, "mem");
        refused((q, n, p, v, null_mut(), size), Status::NullPointer, "mem");
        refused((q, n, p, v, m.wrapping_byte_add(4), size), Status::Misaligned, "mem");
        refused((q, n, p, v, m, size - 1), Status::MemoryTooSmall, "len");
        refused((q, n, sim.cast(), v, m, size), Status::Aliasing, "position");
        refused((q, n, p, sim.cast(), m, size), Status::Aliasing, "velocity");
        assert!(out.iter().all(|x| *x == 0.0 || *x == 7.0));
        for wrong in [f64::NAN, f64::INFINITY] {
            qdd[3] = wrong;
            refused((qdd.as_mut_ptr(), n, p, v, m, size), Status::NotFinite, "qdd");
        }
        assert_eq!(goes_on(model, sim), goes_on(model, twin));
    });
}

#[test]
fn asking_between_two_steps_changes_no_bit_and_memory_is_used_exactly_as_far_as_required() {
    with_model(false, |model| {
        for method in methods() {
            let (_a, sim) = simulate(model, &method);
            let (_b, twin) = simulate(model, &method);
            let (d, n, size) = (plan(model).state_len, plan(model).coordinates, requirement(model));
            let mut mem = memory(size + 8);
            let parameters = [of(NEKTON_PARAMETER_GRAVITY, 0), of(NEKTON_PARAMETER_TORQUE, 0)];
            let (mut a, mut b, mut bound) = (vec![7.0; d * d], vec![7.0; 2 * d], -1.0);
            let qdd = vec![0.5; n];
            let (mut position, mut velocity) = (vec![7.0; n * n], vec![7.0; n * n]);
            for _ in 0..3 {
                let call = Call {
                    sim,
                    parameters: parameters.as_ptr(),
                    count: 2,
                    a: a.as_mut_ptr(),
                    a_len: d * d,
                    b: b.as_mut_ptr(),
                    b_len: 2 * d,
                    bound: &mut bound,
                    mem: mem.as_mut_ptr(),
                    len: size,
                };
                assert_eq!(call.made().0, 0);
                let (p, v, place) = (position.as_mut_ptr(), velocity.as_mut_ptr(), mem.as_mut_ptr().cast());
                let status = unsafe { sim_force_derivatives(sim, qdd.as_ptr(), n, p, v, place, size, null_mut()) };
                assert_eq!(status, 0);
                assert_eq!(goes_on(model, sim), goes_on(model, twin));
            }
            assert!(bound >= 0.0 && a.iter().chain(&b).chain(&position).any(|x| *x != 0.0));
            assert_eq!(mem[size / 8], 0x5a5a_5a5a_5a5a_5a5a);
            // A torque drives its joint.
            assert!(b[d..].iter().any(|x| *x != 0.0));
        }
    });
}

#[test]
fn nothing_to_differentiate_by_needs_no_array() {
    with_model(false, |model| {
        let (_memory, sim) = simulate(model, &adams());
        let (d, size) = (plan(model).state_len, requirement(model));
        let (mut mem, mut a, mut bound) = (memory(size), vec![7.0; d * d], -1.0);
        let (p, place) = (a.as_mut_ptr(), mem.as_mut_ptr().cast());
        let status =
            unsafe { sim_linearize(sim, null(), 0, p, d * d, null_mut(), 0, &mut bound, place, size, null_mut()) };
        assert_eq!(status, 0);
        assert!(bound >= 0.0 && a.iter().any(|x| *x != 0.0));
    });
}
