//! Nothing is allocated while stepping, with every term on.

#![allow(unsafe_code)]

use nekton::Method;
use nekton::scene::{Drive, Harmonic, Link, Repulsion, Scene, Shape, Signal, Wall};
use nekton_tests::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting the calls of each thread.
struct Counting;

thread_local! {
    static CALLS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends has no counter any more.
    let _ = CALLS.try_with(|calls| calls.set(calls.get() + 1));
}

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count();
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(action: impl FnOnce()) -> usize {
    let before = CALLS.get();
    action();
    CALLS.get() - before
}

#[test]
fn counter_counts() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1.0; 100]))) >= 2);
}

#[test]
fn nothing_is_allocated_while_stepping() {
    let wave = [Harmonic { amplitude: 0.5, frequency: 2.0, phase: 0.2, offset: 0.0 }];
    let signal = Signal::Harmonic { terms: &wave, window: None };
    let one = Link { circulation: 0.4, ..link(Shape::Ellipse { a: 0.5, b: 0.2 }, 1.2, 32) };
    let torque = Drive::Torque { torque: signal, stiffness: 0.1, damping: 0.1, rest: 0.0, start: [0.0; 2] };
    let swimmer = [
        one,
        hinged(one, 0, [-0.75, 0.0], [0.75, 0.0], Drive::Motion(signal)),
        hinged(one, 0, [0.75, 0.0], [-0.75, 0.0], torque),
    ];
    let star = [link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32)];
    let both = [body(&swimmer, [0.3, -0.8, 0.3], [0.0; 3]), body(&star, [-0.5, 0.9, 0.2], [0.0; 3])];
    let obstacles = [Wall { circulation: -0.2, ..wall(disc(0.3), [1.4, 0.8], 0.0, 32) }];
    let tank = Some(wall(Shape::Ellipse { a: 3.5, b: 3.0 }, [0.0; 2], 0.0, 64));
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    let everything = Scene { tank, repulsion, obstacles: &obstacles, bodies: &both, ..Scene::new(1.0, 0.5) };
    // The shortcuts: a lone swimmer, a lone body.
    let still = swimmer.map(|link| Link { circulation: 0.0, ..link });
    let swimmer_alone = [body(&still, [0.0; 3], [0.0; 3])];
    let body_alone = [body(&star, [0.0; 3], [0.1, 0.2, 0.3])];
    let scenes = [
        everything,
        Scene { bodies: &swimmer_alone, ..Scene::new(1.0, 0.0) },
        Scene { bodies: &body_alone, ..Scene::new(1.0, 0.5) },
    ];
    for scene in scenes {
        for method in [Method::Rk4 { step: 0.02 }, Method::Abm4 { step: 0.02 }, adams(1e-6)] {
            let mut sim = simulation(&scene, method);
            let joints = sim.view().model().joint_count();
            let (mut u, mut du) = (vec![0.0; joints], vec![0.0; joints]);
            let calls = allocations(|| {
                let mut sim = sim.view();
                for _ in 0..8 {
                    sim.step().unwrap();
                }
                let t = sim.time();
                sim.advance(t + 0.1).unwrap();
                sim.advance_dense(t + 0.15, t + 1.0).unwrap();
                sim.energy().unwrap();
                sim.impulse().unwrap();
                sim.gap();
                sim.joint_values(&mut u, &mut du);
                sim.joint_torques(&mut u, &mut du).unwrap();
                sim.resolution().unwrap();
            });
            assert_eq!(calls, 0, "{method:?}");
        }
    }
}
