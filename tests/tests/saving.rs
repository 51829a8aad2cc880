//! Saving and loading: a simulation goes on from its bytes as if nothing had been, and bytes that are not its own change nothing.

use nekton::scalar::Real;
use nekton::scene::{Body, Drive, Harmonic, Joint, JointKind, Link, Repulsion, Root, Scene, Shape, Signal, Window};
use nekton::{Error, Method, ModelBuf, Result, Sim, SimBuf, Status};
use nekton_tests::*;
use std::sync::Arc;

/// Scenes that take different ways through the equations. `touch` is a value that distinguishes a model from another.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Case {
    /// A lone swimmer: its impulse is constant, its rates are not integrated.
    LoneSwimmer,
    /// A lone rigid body with circulation, by Kirchhoff's equations.
    LoneBody,
    /// A swimmer with a channel for a motion and one for a torque, beside a prescribed body, in a tank.
    Channels,
    /// Two circulating bodies under gravity.
    Circulation,
    /// Discs that are pushed against each other.
    NearContact,
}

const CASES: [Case; 5] = [Case::LoneSwimmer, Case::LoneBody, Case::Channels, Case::Circulation, Case::NearContact];

fn model<R: Real>(case: Case, gravity: f64) -> Arc<ModelBuf<R>> {
    let lit = R::lit;
    let ellipse = |a: f64, b: f64, density: f64| link(Shape::Ellipse { a: lit(a), b: lit(b) }, lit(density), 16);
    let at = |x: f64, y: f64, z: f64| [lit(x), lit(y), lit(z)];
    let beat = [Harmonic { amplitude: lit(0.5), frequency: lit(3.0), phase: lit(0.2), offset: lit(0.1) }];
    let window = Some(Window { from: lit(0.1), to: lit(9.0), ramp: lit(0.6) });
    let beating = Signal::Harmonic { terms: &beat, window };
    let anchors = (at(-1.2, 0.0, 0.0), at(1.2, 0.0, 0.0));
    let hang =
        |l: Link<'static, R>, drive| hinged(l, 0, [anchors.0[0], anchors.0[1]], [anchors.1[0], anchors.1[1]], drive);
    let torque = Drive::Torque {
        torque: Signal::Channel,
        stiffness: lit(2.0),
        damping: lit(0.1),
        rest: lit(0.1),
        start: [lit(0.2), lit(0.0)],
    };
    let tail = ellipse(0.9, 0.3, 1.1);
    let slider = Joint {
        parent: 0,
        kind: JointKind::Slider { axis: [lit(0.2), lit(1.0)], angle: lit(0.1) },
        parent_anchor: [lit(0.0), lit(1.0)],
        self_anchor: [lit(0.0), lit(-0.8)],
        drive: torque,
    };
    let swimmer = [tail, hang(tail, Drive::Motion(beating))];
    let driven = [tail, hang(tail, Drive::Motion(Signal::Channel)), Link { joint: Some(slider), ..tail }];
    let circulating = [Link { circulation: lit(0.7), ..ellipse(0.8, 0.3, 1.3) }];
    let discs = [ellipse(0.5, 0.5, 1.0)];
    let still = at(0.0, 0.0, 0.0);
    let moved = Root::Prescribed([beating, Signal::Constant(lit(0.0)), beating]);
    let repulsion = Some(Repulsion { alpha: lit(3.0), epsilon: lit(1e-4) });
    let tank = Some(wall(disc(lit(9.0)), [R::zero(); 2], R::zero(), 32));
    let bodies = match case {
        Case::LoneSwimmer => vec![body(&swimmer, still, still)],
        Case::LoneBody => vec![body(&circulating, still, at(0.3, 0.2, 0.4))],
        Case::Channels => vec![
            body(&driven, still, at(0.1, 0.0, 0.2)),
            nekton::scene::Body { root: moved, ..body(&discs, at(4.0, -2.0, 0.0), still) },
        ],
        Case::Circulation => vec![
            body(&circulating, still, at(0.3, 0.2, 0.4)),
            body(&circulating, at(3.0, 0.5, 0.3), at(-0.2, 0.1, -0.3)),
        ],
        Case::NearContact => vec![
            body(&discs, at(0.0, 0.0, 0.0), at(0.005, 0.1, 0.1)),
            body(&discs, at(1.01, 0.02, 0.3), at(-0.005, 0.0, 0.0)),
        ],
    };
    let scene = Scene {
        bodies: &bodies,
        repulsion: repulsion.filter(|_| case == Case::NearContact),
        tank: tank.filter(|_| case == Case::Channels),
        tolerance: Some(lit(1e-3)),
        allow_unresolved: true,
        ..Scene::new(R::one(), lit(if case == Case::LoneSwimmer { 0.0 } else { gravity }))
    };
    Arc::new(ModelBuf::new(&scene).unwrap())
}

fn methods<R: Real>() -> [Method<R>; 4] {
    let step = R::lit(0.02);
    [Method::Rk4 { step }, Method::Abm4 { step }, Method::Gauss6 { step }, adams(1e-5)]
}

/// The `k`-th thing that is done to a simulation, whatever was before.
fn act<R: Real>(sim: &mut Sim<'_, R>, k: usize) {
    attempt(sim, k).unwrap();
}

fn attempt<R: Real>(sim: &mut Sim<'_, R>, k: usize) -> Result<()> {
    let lit = R::lit;
    let t = sim.time().to_f64();
    if k.is_multiple_of(3) {
        for channel in 0..sim.model().channel_count() {
            let (from, to) = (lit(0.1 * k as f64), lit(0.1 * k as f64 + 0.05));
            let zero = R::zero();
            sim.set_channel(channel, [lit(t), from, zero, zero], [lit(t + 0.09), to, zero, zero])?;
        }
    }
    match k % 4 {
        // Not a multiple of the step: a shortened step, after which the past is forgotten.
        0 => sim.advance(lit(t + 0.05)),
        1 => sim.step(),
        // Output while the integrator is ahead.
        _ => sim.advance_dense(lit(t + 0.03), lit(t + 1.0)),
    }
}

/// All that can be asked, every digit.
fn all<R: Real>(sim: &mut Sim<'_, R>) -> String {
    let n = sim.model().joint_count();
    let (mut u, mut du) = (vec![R::NAN; n], vec![R::NAN; n]);
    sim.joint_values(&mut u, &mut du);
    let before = (sim.time(), sim.counters(), sim.time_error(), sim.indicators().ok(), sim.notice());
    let shown = (sim.state().to_vec(), sim.positions().to_vec(), sim.velocities().to_vec(), u, du);
    format!("{before:?} {shown:?} {:?} {:?}", sim.energy().ok(), sim.impulse().ok())
}

fn goes_on_from_its_bytes<R: Real>(case: Case, method: Method<R>) {
    const ACTIONS: usize = 24;
    for save_at in [0, 1, 6, 11] {
        let mut first = SimBuf::new(model::<R>(case, 0.3), method).unwrap();
        (0..save_at).for_each(|k| act(&mut first.view(), k));
        let bytes = first.save().unwrap();

        // Another model, another simulation with another method and a past. One view is used for all that follows.
        let mut second = SimBuf::new(model::<R>(case, 0.3), Method::Rk4 { step: R::lit(0.01) }).unwrap();
        let mut second = second.view();
        second.advance(R::lit(0.1)).unwrap();
        second.load(&bytes).unwrap();
        for k in save_at..ACTIONS {
            assert_eq!(all(&mut first.view()), all(&mut second), "{case:?} {method:?} saved at {save_at}, at {k}");
            act(&mut first.view(), k);
            act(&mut second, k);
        }
        let mut again = vec![0; second.save_len()];
        second.save(&mut again).unwrap();
        assert_eq!(first.save().unwrap(), again);
    }
}

#[test]
fn a_loaded_simulation_goes_on_bit_for_bit_with_every_method() {
    for case in CASES {
        methods::<f64>().into_iter().for_each(|method| goes_on_from_its_bytes(case, method));
    }
}

#[test]
fn a_loaded_simulation_goes_on_bit_for_bit_in_single_precision() {
    for case in CASES {
        methods::<f32>().into_iter().for_each(|method| goes_on_from_its_bytes(case, method));
    }
}

#[test]
fn another_process_goes_on_bit_for_bit() {
    const NAME: &str = "saving::another_process_goes_on_bit_for_bit";
    const FILE: &str = "NEKTON_TEST_SAVED";
    let new = || SimBuf::new(model::<f64>(Case::Channels, 0.3), adams(1e-6)).unwrap();
    let finish = |sim: &mut SimBuf<f64>| {
        (7..15).for_each(|k| act(&mut sim.view(), k));
        all(&mut sim.view())
    };
    if let Some(file) = std::env::var_os(FILE) {
        let mut sim = new();
        sim.load(&std::fs::read(file).unwrap()).unwrap();
        println!("\nfound {}", finish(&mut sim));
        return;
    }
    let mut sim = new();
    (0..7).for_each(|k| act(&mut sim.view(), k));
    let file = std::env::temp_dir().join(format!("nekton-saved-{}", std::process::id()));
    std::fs::write(&file, sim.save().unwrap()).unwrap();
    let program = std::env::current_exe().unwrap();
    let mut command = std::process::Command::new(program);
    let output = command.args(["--exact", NAME, "--nocapture"]).env(FILE, &file).output().unwrap();
    std::fs::remove_file(&file).unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    let found = printed.lines().find_map(|line| line.strip_prefix("found "));
    assert_eq!(found, Some(finish(&mut sim).as_str()), "{printed}");
}

/// A simulation under way, and its bytes.
fn under_way<R: Real>(case: Case, method: Method<R>) -> (SimBuf<R>, Vec<u8>) {
    let mut sim = SimBuf::new(model::<R>(case, 0.3), method).unwrap();
    (0..7).for_each(|k| act(&mut sim.view(), k));
    let bytes = sim.save().unwrap();
    (sim, bytes)
}

#[track_caller]
fn refused<R: Real>(sim: &mut SimBuf<R>, bytes: &[u8]) -> Error {
    // Asked first: the balance of energy remembers what was asked.
    let before = (all(&mut sim.view()), sim.save().unwrap());
    let error = sim.load(bytes).unwrap_err();
    assert_eq!(error.status, Status::BadSave);
    assert!(before == (all(&mut sim.view()), sim.save().unwrap()), "{error}: refused, but changed");
    error
}

#[test]
fn every_damaged_byte_is_refused_and_nothing_changes() {
    for (case, method) in [(Case::LoneSwimmer, adams(1e-5)), (Case::LoneBody, Method::Abm4 { step: 0.02 })] {
        let (_, bytes) = under_way::<f64>(case, method);
        let (mut sim, _) = under_way(case, Method::Rk4 { step: 0.01 });
        let before = sim.save().unwrap();
        for i in 0..bytes.len() {
            for mask in [1 << (i % 8), 0xff] {
                let mut damaged = bytes.clone();
                damaged[i] ^= mask;
                let error = sim.load(&damaged).unwrap_err();
                assert_eq!(error.status, Status::BadSave, "byte {i}");
                assert!(before == sim.save().unwrap(), "byte {i}: refused, but changed");
            }
        }
    }
}

#[test]
fn a_refusal_names_what_is_wrong_and_changes_nothing() {
    let method = adams(1e-5);
    let (_, bytes) = under_way::<f64>(Case::Channels, method);
    let (mut sim, _) = under_way(Case::Channels, method);
    assert_eq!(refused(&mut sim, &[]).what, "length");
    assert_eq!(refused(&mut sim, &bytes[..bytes.len() - 8]).what, "length");
    assert_eq!(refused(&mut sim, &bytes[..bytes.len() - 1]).what, "length");
    assert_eq!(refused(&mut sim, &[&bytes[..], &[0]].concat()).what, "length");
    assert_eq!(refused(&mut sim, &[b'x'; 1000]).what, "mark");
    let with = |word: usize, value: u64| {
        let mut other = bytes.clone();
        other[8 * word..8 * word + 8].copy_from_slice(&value.to_le_bytes());
        other
    };
    assert_eq!(refused(&mut sim, &with(1, 2)).what, "version");
    assert_eq!(refused(&mut sim, &with(2, 2)).what, "version");
    let middle = bytes.len() / 16;
    assert_eq!(refused(&mut sim, &with(middle, 2)).what, "checksum");

    let (_, single) = under_way::<f32>(Case::Channels, adams(1e-5));
    assert_eq!(refused(&mut sim, &single).what, "precision");
    let mut heavier = SimBuf::new(model::<f64>(Case::Channels, 0.31), method).unwrap();
    assert_eq!(refused(&mut heavier, &bytes).what, "model");
    assert_eq!(refused(&mut under_way(Case::Circulation, method).0, &bytes).what, "model");
}

#[test]
fn too_little_room_is_refused_and_not_written() {
    let (mut sim, bytes) = under_way::<f64>(Case::Circulation, adams(1e-5));
    let sim = sim.view();
    let mut out = vec![7; bytes.len() + 3];
    let error = sim.save(&mut out[..bytes.len() - 1]).unwrap_err();
    assert_eq!((error.status, error.value), (Status::MemoryTooSmall, (bytes.len() - 1) as f64));
    assert!(out.iter().all(|x| *x == 7));
    // More room than needed is left alone.
    assert_eq!(sim.save(&mut out).unwrap(), bytes.len());
    assert_eq!(out[..bytes.len()], bytes);
    assert_eq!(out[bytes.len()..], [7; 3]);
}

/// The checksum, written anew from its description: MurmurHash3's last step of (digest ^ word) + 2⁶⁴/φ.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(0, |digest: u64, word| {
        let mut x = (digest ^ u64::from_le_bytes(word.try_into().unwrap())).wrapping_add(0x9e37_79b9_7f4a_7c15);
        for factor in [0xff51_afd7_ed55_8ccd, 0xc4ce_b9fe_1a85_ec53] {
            x = (x ^ (x >> 33)).wrapping_mul(factor);
        }
        x ^ (x >> 33)
    })
}

#[test]
fn bytes_that_somebody_made_up_are_refused_or_do_no_harm() {
    let words = [
        u64::MAX,
        1 << 63,
        u64::MAX / 2,
        u64::from(u32::MAX),
        13,
        f64::NAN.to_bits(),
        f64::INFINITY.to_bits(),
        f64::MAX.to_bits(),
        (-1.0_f64).to_bits(),
        1e-300_f64.to_bits(),
        1e9_f64.to_bits(),
        0,
        1,
        2,
    ];
    let (mut harmless, mut refusals) = (0, 0);
    let methods = methods::<f64>().into_iter();
    for (case, method) in
        methods.zip([Case::NearContact, Case::LoneSwimmer, Case::LoneBody, Case::Channels]).map(|(m, c)| (c, m))
    {
        let (mut sim, bytes) = under_way::<f64>(case, method);
        let last = bytes.len() - 8;
        assert_eq!(checksum(&bytes[..last]).to_le_bytes(), bytes[last..]);
        for word in 6..last / 8 {
            // Beyond the fields, some of the reals are enough.
            if word > 150 && word % 7 > 0 {
                continue;
            }
            for value in words {
                let mut forged = bytes.clone();
                forged[8 * word..8 * word + 8].copy_from_slice(&value.to_le_bytes());
                let sum = checksum(&forged[..last]).to_le_bytes();
                forged[last..].copy_from_slice(&sum);
                match sim.load(&forged) {
                    Ok(()) => {
                        harmless += 1;
                        let mut sim = sim.view();
                        sim.set_step_limit(3).unwrap();
                        let _ = (sim.gap(), sim.notice(), sim.energy());
                        let _ = sim.advance_dense(sim.time() + 0.04, sim.time() + 1.0);
                        let _ = sim.step();
                        let _ = (sim.save(&mut []), sim.indicators());
                    }
                    Err(error) => {
                        refusals += 1;
                        assert_eq!(error.status, Status::BadSave);
                        assert!(!error.what.is_empty());
                    }
                }
            }
        }
    }
    println!("{refusals} refused, {harmless} loaded");
    assert!(refusals > 1000 && harmless > 1000);
}

#[test]
fn a_simulation_is_not_viewed_with_another_model() {
    let (own, equal, other) =
        (model::<f64>(Case::Channels, 0.3), model(Case::Channels, 0.3), model(Case::Channels, 0.31));
    let mut reals = vec![0.0; Sim::requirement(&own.view()).unwrap().reals];
    let mut head = Sim::head(Method::Rk4 { step: 0.01 }).unwrap();
    let view = |model: &ModelBuf<f64>, head: &mut _, reals: &mut _| Sim::view(model.view(), head, reals).map(|_| ());
    assert_eq!(view(&own, &mut head, &mut reals).unwrap_err().status, Status::BadHandle);
    Sim::init(own.view(), &mut head, &mut reals).unwrap();
    view(&equal, &mut head, &mut reals).unwrap();
    assert_eq!(view(&other, &mut head, &mut reals).unwrap_err().status, Status::BadHandle);
}

#[test]
fn equal_scenes_have_equal_fingerprints_and_others_have_not() {
    let of = |case, gravity| model::<f64>(case, gravity).view().fingerprint();
    assert_eq!(of(Case::Channels, 0.3), of(Case::Channels, 0.3));
    assert_ne!(of(Case::Channels, 0.3), of(Case::Channels, 0.300_000_000_000_000_04));
    assert_ne!(of(Case::Channels, 0.3), model::<f32>(Case::Channels, 0.3).view().fingerprint());
}

#[test]
fn what_is_told_on_arriving_where_a_motion_ends_is_told_after_loading_too() {
    // At its last row a table leaves its acceleration for rest.
    let rows = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.4, 0.0, -0.7]];
    let still = Signal::Constant(0.0);
    let links = [link(Shape::Ellipse { a: 0.5, b: 0.3 }, 1.0, 16)];
    let root = Root::Prescribed([Signal::Table(&rows), still, still]);
    let bodies = [Body { pose: [0.0; 3], velocity: [0.0; 3], root, links: &links }];
    let model = Arc::new(ModelBuf::new(&Scene { bodies: &bodies, ..Scene::new(1.0, 0.0) }).unwrap());
    let told = |sim: &mut SimBuf<f64>| {
        let mut out = [f64::NAN; 3];
        sim.view().accelerations(&mut out).unwrap();
        out[0]
    };
    let step = 0.125;
    for method in [Method::Rk4 { step }, Method::Gauss6 { step }] {
        let new = || SimBuf::new(model.clone(), method).unwrap();
        let (mut arrived, mut put) = (new(), new());
        arrived.view().advance(1.0).unwrap();
        let state = arrived.view().state().to_vec();
        put.view().set_state(1.0, &state).unwrap();
        assert!((told(&mut arrived) + 0.7).abs() < 1e-12 && told(&mut put).abs() < 1e-12);
        let saved = [arrived.save().unwrap(), put.save().unwrap()];
        for (from, bytes) in [&mut arrived, &mut put].into_iter().zip(&saved) {
            let expected = told(from);
            let mut other = new();
            other.load(bytes).unwrap();
            assert_eq!(told(&mut other), expected);
        }
        // Nor does what the other one was before matter.
        arrived.load(&saved[1]).unwrap();
        put.load(&saved[0]).unwrap();
        assert!((told(&mut put) + 0.7).abs() < 1e-12 && told(&mut arrived).abs() < 1e-12);
    }
}
