//! A simulation that is in use is refused to others, and free again after every call, also one that failed.

mod common;

use common::double::*;
use common::{empty_diag, memory, what, with_scene};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut, with_exposed_provenance_mut};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

const BUSY: i32 = Status::Busy as i32;

/// A handle for another thread.
fn over(address: usize) -> *mut SimHandle<f64> {
    with_exposed_provenance_mut(address)
}

/// Every way of using a simulation, on one that is busy: what each returned.
unsafe fn uses(sim: *mut SimHandle<f64>, other: *mut SimHandle<f64>, n: usize) -> Vec<i32> {
    let (mut a, mut b, mut t, mut diag) = (vec![7.0; n * n * n], vec![7.0; n * n * n], 7.0, empty_diag());
    let (p, q) = (a.as_mut_ptr(), b.as_mut_ptr());
    let (from, to) = ([0.0; 4], [1.0; 4]);
    let square = plan_of(other).state_len.pow(2);
    let mut mem = memory(derivatives_size(other));
    let forces = vec![0.0; n];
    let mut size = 7;
    let mut counters = nekton_counters::default();
    let (mut energy, mut gap) = (std::mem::MaybeUninit::uninit(), std::mem::MaybeUninit::uninit());
    let (mut resolution, mut error) = (std::mem::MaybeUninit::uninit(), std::mem::MaybeUninit::uninit());
    let d: *mut nekton_diag = &mut diag;
    let all = unsafe {
        vec![
            sim_time(sim, &mut t),
            sim_positions(sim, p, n),
            sim_velocities(sim, p, n),
            sim_get_state(sim, &mut t, p, plan_of(other).state_len),
            sim_set_state(sim, 0.0, p, plan_of(other).state_len, d),
            sim_restart(sim),
            sim_save_req(sim, &mut size),
            sim_save(sim, p.cast(), 8 * n, &mut size, d),
            sim_load(sim, p.cast(), 8 * n, d),
            sim_step(sim, d),
            sim_advance(sim, 3.0, d),
            sim_advance_dense(sim, 3.0, 4.0, d),
            sim_set_step_limit(sim, 5),
            sim_set_channel(sim, 0, from.as_ptr(), to.as_ptr(), d),
            sim_rhs(sim, 0.0, p, q, plan_of(other).state_len, d),
            sim_joint_values(sim, p, q, 1),
            sim_joint_torques(sim, p, q, 1, d),
            sim_accelerations(sim, p, n, d),
            sim_mass_matrix(sim, p, n * n, d),
            sim_added_mass(sim, p, n * n, d),
            sim_christoffel(sim, p, n, d),
            sim_christoffel_tensor(sim, p, n * n * n, d),
            sim_buoyancy(sim, p, n, d),
            sim_repulsion(sim, p, n, d),
            sim_circulation_gradient(sim, p, n, d),
            sim_gyroscopic(sim, p, n * n, d),
            sim_linearize(sim, null(), 0, p, square, q, 0, &mut t, mem.as_mut_ptr().cast(), 8 * mem.len(), d),
            sim_force_derivatives(sim, forces.as_ptr(), n, p, q, mem.as_mut_ptr().cast(), 8 * mem.len(), d),
            sim_energy(sim, energy.as_mut_ptr(), d),
            sim_energy_drift(sim, p, d),
            sim_impulse(sim, p, d),
            sim_indicators(sim, resolution.as_mut_ptr(), d),
            sim_resolution(sim, resolution.as_mut_ptr(), d),
            sim_time_error(sim, error.as_mut_ptr()),
            sim_gap(sim, gap.as_mut_ptr(), d),
            sim_counters(sim, &mut counters),
            sim_copy(other, sim, d),
            sim_copy(sim, other, d),
            sim_copy(sim, sim, d),
            sim_free(sim),
        ]
    };
    if all.iter().all(|status| *status == BUSY) {
        assert!(t == 7.0 && a.iter().chain(&b).all(|x| *x == 7.0), "a call that was refused wrote something");
        assert_eq!(what(&diag), "sim");
    }
    all
}

/// Bytes of memory that derivatives take.
fn derivatives_size(sim: *const SimHandle<f64>) -> usize {
    let (mut model, mut req) = (null(), nekton_req::default());
    assert_eq!(unsafe { sim_model(sim, &mut model) }, 0);
    assert_eq!(unsafe { sim_derivatives_req(model, &mut req, null_mut()) }, 0);
    req.size
}

fn plan_of(sim: *const SimHandle<f64>) -> nekton_plan {
    let mut model = null();
    assert_eq!(unsafe { sim_model(sim, &mut model) }, 0);
    plan(model)
}

#[test]
fn a_simulation_that_steps_is_refused_to_other_threads_and_is_none_the_worse() {
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        let n = plan(model).coordinates;
        let (_a, alone) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        assert_eq!(unsafe { sim_advance(alone, 1.0, null_mut()) }, 0);
        // On a busy computer the long step may end before everything was tried: then once more.
        for attempt in 0.. {
            assert!(attempt < 50, "the simulation was never found busy from first to last");
            let (_b, sim) = simulate(model, &fixed(NEKTON_METHOD_RK4));
            let (_c, other) = simulate(model, &fixed(NEKTON_METHOD_RK4));
            let idle = state(model, other);
            let at = sim.expose_provenance();
            let over_yet = AtomicBool::new(false);
            let refused = std::thread::scope(|scope| {
                let stepping = scope.spawn(|| {
                    let status = unsafe { sim_advance(over(at), 1.0, null_mut()) };
                    over_yet.store(true, Ordering::Release);
                    status
                });
                let mut refused = Vec::new();
                while refused.is_empty() && !over_yet.load(Ordering::Acquire) {
                    // A call that does nothing either way finds out whether the other thread is at it.
                    let status = unsafe { sim_advance(sim, -1.0, null_mut()) };
                    assert!(status == BUSY || status == Status::PastTime.code(), "{status}");
                    if status == BUSY {
                        refused = unsafe { uses(sim, other, n) };
                    }
                }
                (stepping.join().unwrap(), refused)
            });
            // If this thread's harmless question came first, the advance was the one that was refused.
            if refused.0 == 0 && !refused.1.is_empty() && refused.1.iter().all(|status| *status == BUSY) {
                assert_eq!(state(model, other), idle);
                assert_eq!(state(model, sim), state(model, alone));
                break;
            }
        }
    });
}

#[test]
fn any_number_of_threads_copy_from_one_simulation_at_once() {
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        let (_a, from) = simulate(model, &adams());
        assert_eq!(unsafe { sim_advance(from, 0.05, null_mut()) }, 0);
        let shown = state(model, from);
        let (model_at, from_at, inside) = (model.expose_provenance(), from.expose_provenance(), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let model = with_exposed_provenance_mut::<ModelHandle<f64>>(model_at);
                    let (_memory, to) = simulate(model, &adams());
                    inside.fetch_add(1, Ordering::AcqRel);
                    while inside.load(Ordering::Acquire) < 4 {
                        std::hint::spin_loop();
                    }
                    for _ in 0..2000 {
                        assert_eq!(unsafe { sim_copy(to, over(from_at), null_mut()) }, 0);
                    }
                    assert_eq!(state(model, to), shown);
                });
            }
        });
        // Everybody gave the turn back.
        assert_eq!(unsafe { sim_step(from, null_mut()) }, 0);
    });
}

#[test]
fn a_call_that_failed_leaves_the_simulation_free() {
    with_scene(|def, _, _| {
        let (_model_memory, model) = compile(def);
        let (_a, sim) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        let (_other_memory, other_model) = compile(def);
        let (_b, other) = simulate(other_model, &fixed(NEKTON_METHOD_RK4));
        let (mut x, n) = ([0.0; 64], plan(model).state_len);
        let p = x.as_mut_ptr();
        unsafe {
            for (status, expected) in [
                (sim_advance(sim, -1.0, null_mut()), Status::PastTime),
                (sim_positions(sim, p, 1), Status::Length),
                (sim_positions(sim, null_mut(), 9), Status::NullPointer),
                (sim_rhs(sim, 0.0, p, p, n, null_mut()), Status::Aliasing),
                (sim_set_step_limit(sim, 0), Status::OutOfRange),
                (sim_copy(sim, other, null_mut()), Status::BadHandle),
                (sim_copy(other, sim, null_mut()), Status::BadHandle),
                (sim_free(sim), Status::BadHandle),
            ] {
                assert_eq!(status, expected.code());
                assert_eq!(sim_positions(sim, p, 9), 0);
                assert_eq!(sim_positions(other, p, 9), 0);
            }
            assert_eq!(sim_set_step_limit(sim, 2), 0);
            assert_eq!(sim_advance(sim, 1.0, null_mut()), Status::TooManySteps.code());
            assert_eq!(sim_set_step_limit(sim, 9), 0);
            assert_eq!(sim_step(sim, null_mut()), 0);
        }
    });
}
