//! Nothing is allocated while stepping, with every term on, and no heap is needed at all.

#![allow(unsafe_code)]

use nekton::BoundaryRecord;
use nekton::scene::{Drive, Harmonic, Link, Repulsion, Scene, Shape, Signal, Wall};
use nekton::{CoordinateRecord, LinkRecord};
use nekton::{Formulation, Method, Model, ModelMemory, Parameter, Result, Sim, Status};
use nekton_tests::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Mutex;

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
    // Without circulation, which is differentiated by differences.
    let without = [body(&still, [0.3, -0.8, 0.3], [0.0; 3]), both[1]];
    let walls = [wall(disc(0.3), [1.4, 0.8], 0.0, 32)];
    let scenes = [
        everything,
        Scene { bodies: &without, obstacles: &walls, ..everything },
        Scene { bodies: &swimmer_alone, ..Scene::new(1.0, 0.0) },
        Scene { bodies: &body_alone, ..Scene::new(1.0, 0.5) },
    ];
    for scene in scenes {
        for method in [Method::Rk4 { step: 0.02 }, Method::Abm4 { step: 0.02 }, adams(1e-6)] {
            let mut sim = simulation(&scene, method);
            let joints = sim.view().model().joint_count();
            let (mut u, mut du) = (vec![0.0; joints], vec![0.0; joints]);
            let (rows, n) = (sim.view().state().len(), sim.view().positions().len());
            let mut memory = vec![0.0; Sim::derivative_requirement(&sim.view().model()).unwrap()];
            let (mut a, mut b, qdd) = (vec![0.0; rows * rows], vec![0.0; 2 * rows], vec![0.1; n]);
            let (mut position, mut velocity) = (vec![0.0; n * n], vec![0.0; n * n]);
            let parameters = [Parameter::FluidDensity, Parameter::Mass(0)];
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
                let answer = sim.linearize(parameters, &mut a, &mut b, &mut memory).map(|_| ());
                assert_eq!(answer.map_err(|e| e.status), Ok(()));
                let answer = sim.force_derivatives(&qdd, &mut position, &mut velocity, &mut memory);
                assert_eq!(answer.map_err(|e| e.status), Ok(()));
            });
            assert_eq!(calls, 0, "{method:?}");
        }
    }
}

/// Memory for the longest scene below.
static MODEL: Mutex<[f64; 40_000]> = Mutex::new([0.0; 40_000]);
static SIM: Mutex<[f64; 80_000]> = Mutex::new([0.0; 80_000]);

/// Everything that a simulation shows after a while, to the bit.
fn shown(sim: &mut Sim<'_, f64>, out: &mut [u64; 64]) {
    for _ in 0..3 {
        sim.step().unwrap();
    }
    sim.advance(0.3).unwrap();
    let energy = sim.energy().unwrap();
    let mut torques = [0.0; 4];
    let joints = sim.model().joint_count();
    sim.joint_torques(&mut torques[..joints], &mut [0.0; 4][..joints]).unwrap();
    let resolution = sim.resolution().unwrap();
    let numbers = [sim.time(), energy.total, energy.work, sim.gap().distance, resolution.mass, resolution.force];
    let all = sim.state().iter().chain(sim.positions()).chain(sim.velocities()).chain(&numbers).chain(&torques);
    for (out, x) in out.iter_mut().zip(all) {
        *out = x.to_bits();
    }
}

#[test]
fn models_and_simulations_in_fixed_arrays_allocate_nothing_and_are_those_on_the_heap_to_the_bit() {
    let wave = [Harmonic { amplitude: 0.5, frequency: 2.0, phase: 0.2, offset: 0.0 }];
    let signal = Signal::Harmonic { terms: &wave, window: None };
    let one = link(Shape::Ellipse { a: 0.5, b: 0.2 }, 1.2, 32);
    let swimmer = [one, hinged(one, 0, [-0.75, 0.0], [0.75, 0.0], Drive::Motion(signal))];
    let star = [Link { circulation: 0.3, ..link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32) }];
    let both = [body(&swimmer, [0.3, -0.8, 0.3], [0.1, 0.2, 0.3]), body(&star, [-0.5, 0.9, 0.2], [0.1, 0.2, 0.3])];
    let tank = Some(wall(Shape::Ellipse { a: 3.5, b: 3.0 }, [0.0; 2], 0.0, 64));
    let repulsion = Some(Repulsion { alpha: 4.0, epsilon: 0.01 });
    let everything = Scene { tank, repulsion, bodies: &both, ..Scene::new(1.0, 0.5) };
    let lone_swimmer = Scene { bodies: &both[..1], ..Scene::new(1.0, 0.0) };
    let lone_body = Scene { bodies: &both[1..], ..Scene::new(1.0, 0.5) };
    let vacuum = Scene { bodies: &both, ..Scene::new(0.0, 0.5) };
    let (mut reals, mut state) = (MODEL.lock().unwrap(), SIM.lock().unwrap());
    for (scene, formulation) in [
        (everything, Formulation::Velocity),
        (lone_swimmer, Formulation::LockedMomentum),
        (lone_body, Formulation::Kirchhoff),
        (vacuum, Formulation::Velocity),
    ] {
        for method in [Method::Rk4 { step: 0.02 }, Method::Abm4 { step: 0.02 }, adams(1e-6)] {
            let mut on_heap = [0; 64];
            let mut sim = simulation(&scene, method);
            assert_eq!(sim.view().model().plan().formulation, formulation);
            shown(&mut sim.view(), &mut on_heap);
            // Larger arrays than required, with what another scene left in them.
            let mut fixed = [0; 64];
            let mut links = [LinkRecord::default(); 5];
            let mut coordinates = [CoordinateRecord::default(); 9];
            let mut boundaries = [BoundaryRecord::default(); 6];
            let calls = allocations(|| {
                let need = Model::requirement(&scene).unwrap();
                assert!(need.links <= 5 && need.coordinates <= 9 && need.boundaries <= 6 && need.reals <= reals.len());
                let mut memory = ModelMemory {
                    links: &mut links,
                    coordinates: &mut coordinates,
                    boundaries: &mut boundaries,
                    reals: &mut *reals,
                };
                let head = Model::init(&scene, &mut memory).unwrap();
                let model = Model::view(&head, &links, &coordinates, &boundaries, &*reals);
                assert!(Sim::requirement(&model).unwrap().reals <= state.len());
                let mut head = Sim::head(method).unwrap();
                Sim::init(model, &mut head, &mut *state).unwrap();
                shown(&mut Sim::view(model, &mut head, &mut *state).unwrap(), &mut fixed);
            });
            assert_eq!(calls, 0, "{formulation:?}, {method:?}");
            assert_eq!(fixed[..], on_heap[..], "{formulation:?}, {method:?}");
        }
    }
}

#[test]
fn memory_of_exactly_the_required_length_suffices_and_one_less_is_refused() {
    let one = [link(Shape::Star { radius: 0.5, amplitude: 0.1, lobes: 3 }, 0.8, 32)];
    let bodies = [body(&one, [-0.7, 0.0, 0.2], [0.1, 0.2, 0.3]), body(&one, [0.7, 0.0, 0.2], [0.0; 3])];
    let scene = Scene { bodies: &bodies, ..Scene::new(1.0, 0.5) };
    let need = Model::requirement(&scene).unwrap();
    let compile = |less: [usize; 4], then: &mut dyn FnMut(Result<Model<'_, f64>>)| {
        let mut links = vec![LinkRecord::default(); need.links - less[0]];
        let mut coordinates = vec![CoordinateRecord::default(); need.coordinates - less[1]];
        let mut boundaries = vec![BoundaryRecord::default(); need.boundaries - less[2]];
        let mut reals = vec![0.0; need.reals - less[3]];
        let mut memory = ModelMemory {
            links: &mut links,
            coordinates: &mut coordinates,
            boundaries: &mut boundaries,
            reals: &mut reals,
        };
        match Model::init(&scene, &mut memory) {
            Ok(head) => then(Ok(Model::view(&head, &links, &coordinates, &boundaries, &reals))),
            Err(error) => then(Err(error)),
        }
    };
    for k in 0..4 {
        let mut less = [0; 4];
        less[k] = 1;
        compile(less, &mut |model| assert_eq!(model.unwrap_err().status, Status::MemoryTooSmall));
    }
    compile([0; 4], &mut |model| {
        let model = model.unwrap();
        let reals = Sim::requirement(&model).unwrap().reals;
        let mut head = Sim::head(Method::Rk4 { step: 0.1 }).unwrap();
        let refused = Sim::init(model, &mut head, &mut vec![0.0; reals - 1]).err().map(|error| error.status);
        assert_eq!(refused, Some(Status::MemoryTooSmall));
        let mut memory = vec![0.0; reals];
        Sim::init(model, &mut head, &mut memory).unwrap().step().unwrap();
    });
}
