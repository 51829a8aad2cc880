//! Simulations as bytes across the C interface: every way in which they are refused, and that nothing changes then.

mod common;

use common::double::*;
use common::{empty_diag, what, with_scene};
use nekton::Status;
use nekton_ffi::types::*;
use std::ptr::{null, null_mut};

fn saved(sim: *const SimHandle<f64>) -> Vec<u8> {
    let (mut need, mut written) = (0, 0);
    assert_eq!(unsafe { sim_save_req(sim, &mut need) }, 0);
    let mut bytes = vec![7; need];
    assert_eq!(unsafe { sim_save(sim, bytes.as_mut_ptr().cast(), need, &mut written, null_mut()) }, 0);
    assert_eq!(written, need);
    bytes
}

#[test]
fn saving_is_refused_as_documented_and_then_writes_nothing() {
    with_scene(|def, _, _| {
        let (_m, model) = compile(def);
        let (mut memory, sim) = simulate(model, &adams());
        let need = saved(sim).len();
        let (mut out, mut written, mut diag) = (vec![7_u8; need], 7_usize, empty_diag());
        let first = out.as_mut_ptr().cast();
        let inside = memory.as_mut_ptr().cast();
        let cases: [(_, _, _, *mut usize, Status, &str); 6] = [
            (null(), first, need, &mut written, Status::NullPointer, "sim"),
            (sim.cast_const(), null_mut(), need, &mut written, Status::NullPointer, "out"),
            (sim, first, need, null_mut(), Status::NullPointer, "written"),
            (sim, first, need - 1, &mut written, Status::MemoryTooSmall, "len"),
            (sim, first, 0, &mut written, Status::MemoryTooSmall, "len"),
            (sim, inside, need, &mut written, Status::Aliasing, "out"),
        ];
        for (sim, out, len, written, status, named) in cases {
            assert_eq!(unsafe { sim_save(sim, out, len, written, &mut diag) }, status.code(), "{named}");
            assert_eq!((diag.status, what(&diag).as_str()), (status.code(), named));
        }
        assert!(out.iter().all(|x| *x == 7) && written == 7);
        assert_eq!(unsafe { sim_save_req(sim, null_mut()) }, Status::NullPointer.code());
        assert_eq!(unsafe { sim_save_req(null(), &mut written) }, Status::NullPointer.code());
        // Any address will do for bytes.
        let mut room = vec![7_u8; need + 3];
        for shift in 0..3 {
            let at = room[shift..].as_mut_ptr().cast();
            assert_eq!(unsafe { sim_save(sim, at, need, &mut written, null_mut()) }, 0);
            assert_eq!(unsafe { sim_load(sim, at, need, null_mut()) }, 0);
        }
    });
}

#[test]
fn loading_is_refused_as_documented_and_then_changes_nothing() {
    with_scene(|def, _, _| {
        let (_m, model) = compile(def);
        let (memory, sim) = simulate(model, &adams());
        let (_o, other) = simulate(model, &fixed(NEKTON_METHOD_RK4));
        assert!(unsafe { sim_advance(sim, 0.3, null_mut()) } >= 0);
        let mut bytes = saved(sim);
        let before = saved(other);
        let n = bytes.len();
        let refused = |from: *const u8, len: usize, status: Status, named: &str| {
            let mut diag = empty_diag();
            assert_eq!(unsafe { sim_load(other, from.cast(), len, &mut diag) }, status.code(), "{named}");
            assert_eq!((diag.status, what(&diag).as_str()), (status.code(), named));
            assert_eq!(before, saved(other));
        };
        refused(null(), n, Status::NullPointer, "from");
        refused(null(), 0, Status::BadSave, "length");
        refused(bytes.as_ptr(), n - 1, Status::BadSave, "length");
        refused(bytes.as_ptr(), n - 8, Status::BadSave, "length");
        refused(_o.as_ptr().cast(), n, Status::Aliasing, "from");
        bytes[n / 2] ^= 1;
        refused(bytes.as_ptr(), n, Status::BadSave, "checksum");
        bytes[n / 2] ^= 1;
        bytes[0] ^= 1;
        refused(bytes.as_ptr(), n, Status::BadSave, "mark");
        bytes[0] ^= 1;

        // Of a heavier fluid.
        let heavier = SceneDef { fluid_density: 1.25 * def.fluid_density, ..**def };
        let (_h, model) = compile(&heavier);
        let (_s, apart) = simulate(model, &adams());
        let mut diag = empty_diag();
        assert_eq!(unsafe { sim_load(apart, bytes.as_ptr().cast(), n, &mut diag) }, Status::BadSave.code());
        assert_eq!(what(&diag), "model");
        drop(memory);
    });
}
