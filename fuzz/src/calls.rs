//! Sequences of calls. `double` and `single` are the same lines for the two precisions.

use nekton_ffi::types::{nekton_diag, nekton_status};

/// Memory for an object between guards, and a pattern everywhere.
struct Guarded {
    words: Vec<u64>,
    bytes: usize,
}

const PATTERN: u64 = 0xa5a5_a5a5_a5a5_a5a5;
const GUARD: usize = 8;

impl Guarded {
    fn new(bytes: usize) -> Self {
        Guarded { words: vec![PATTERN; bytes.div_ceil(8) + 2 * GUARD], bytes }
    }
    fn memory(&mut self) -> *mut core::ffi::c_void {
        self.words[GUARD..].as_mut_ptr().cast()
    }
    /// The guards are whole.
    fn check(&self) {
        let end = self.words.len() - GUARD;
        assert!(
            self.words[..GUARD].iter().chain(&self.words[end..]).all(|w| *w == PATTERN),
            "wrote outside its memory"
        );
        assert!(self.bytes.is_multiple_of(8), "the size asked for is a multiple of the alignment");
    }
    fn untouched(&self) -> bool {
        self.words.iter().all(|w| *w == PATTERN)
    }
}

/// What is reported fits what was returned, and can be said in any number of characters.
fn check_report(status: nekton_status, diag: &nekton_diag) -> bool {
    assert_eq!(status, diag.status);
    assert!(diag.what.contains(&0), "the quantity's name has an end");
    for size in [0, 1, 7, 200] {
        let mut text = vec![-1 as core::ffi::c_char; size + 1];
        // SAFETY: the buffer is longer than said.
        unsafe { nekton_ffi::shared::nekton_diag_text(diag, text.as_mut_ptr(), size) };
        assert!(text[size] == -1 && (size == 0 || text[..size].contains(&0)));
    }
    status >= 0
}

macro_rules! precision {
    ($module:ident, $api:ident, $real:ty, { $($call:ident = $name:ident),* $(,)? }) => {
        /// One precision.
        pub mod $module {
            $(use nekton_ffi::$api::$name as $call;)*
            use super::{Guarded, check_report};
            use crate::Reached;
            use crate::bytes::Bytes;
            use crate::scene::{Definition, Number, own_size, zeroed};
            use core::ptr::{null, null_mut};
            use nekton_ffi::shared::NEKTON_ABI_VERSION;
            use nekton_ffi::types::*;

            type R = $real;
            /// Objects beyond this size are not made: the time is better spent on others.
            const LARGEST: usize = 4 << 20;

            /// What can be seen of a simulation, as bits.
            type Seen = Vec<u64>;

            struct Run<'m> {
                model: *mut ModelHandle<R>,
                sim: *mut SimHandle<R>,
                plan: nekton_plan,
                method: MethodDef<R>,
                memory: [&'m Guarded; 2],
            }

            fn number(bytes: &mut Bytes<'_>, ordinary: f64) -> R {
                R::of(bytes.real(ordinary))
            }

            /// Runs the bytes.
            pub fn run(bytes: &mut Bytes<'_>) -> Reached {
                let definition = Definition::<R>::new(bytes, NEKTON_ABI_VERSION);
                let def = &raw const definition.def;
                let mut diag = zeroed::<nekton_diag>();
                let mut req = nekton_req::default();
                // SAFETY (all calls below): pointers are true, NULL or misaligned; memory has the length said.
                unsafe {
                    if !check_report(model_req(def, &mut req, &mut diag), &diag) || req.size > LARGEST {
                        return Reached::Scene;
                    }
                    let mut memory = Guarded::new(req.size);
                    let mut model = null_mut();
                    // Refusals come before the first byte is written.
                    let at = memory.memory();
                    for (mem, len) in [(null_mut(), req.size), (at, req.size - 1), (at.byte_add(1), req.size)] {
                        assert!(!check_report(model_init(mem, len, def, &mut model, &mut diag), &diag));
                        assert!(memory.untouched() && model.is_null());
                    }
                    let made = check_report(model_init(at, req.size, def, &mut model, &mut diag), &diag);
                    memory.check();
                    if !made {
                        assert!(model.is_null());
                        return Reached::Model;
                    }
                    let mut plan = zeroed::<nekton_plan>();
                    assert!(model_plan(model, &mut plan) >= 0 && plan.model_bytes == req.size);
                    let method = MethodDef {
                        struct_size: own_size::<MethodDef<R>>(bytes),
                        kind: if bytes.chance(3) { bytes.kind(6) } else { 1 + bytes.below(4) as i32 },
                        step: number(bytes, 0.05),
                        relative: number(bytes, 1e-4),
                        absolute: number(bytes, 1e-4),
                        max_step: if bytes.below(8) == 0 { number(bytes, 0.05) } else { 0.0 },
                        first_step: if bytes.below(8) == 0 { number(bytes, 0.001) } else { 0.0 },
                    };
                    if !check_report(sim_req(model, &method, &mut req, &mut diag), &diag) || req.size > LARGEST {
                        return Reached::Model;
                    }
                    let mut sim_memory = Guarded::new(req.size);
                    let mut sim = null_mut();
                    let at = sim_memory.memory();
                    for (mem, len) in [(null_mut(), req.size), (at, req.size - 1), (at.byte_add(1), req.size)] {
                        assert!(!check_report(sim_init(mem, len, model, &method, &mut sim, &mut diag), &diag));
                        assert!(sim_memory.untouched() && sim.is_null());
                    }
                    let made = check_report(sim_init(at, req.size, model, &method, &mut sim, &mut diag), &diag);
                    sim_memory.check();
                    if !made {
                        assert!(sim.is_null());
                        return Reached::Model;
                    }
                    // No call is to take long; sometimes none may do anything, which is refused.
                    let limit = 50 * bytes.below(4) as u64;
                    let set = sim_set_step_limit(sim, limit);
                    assert!(set >= 0 || limit == 0);
                    if limit == 0 {
                        assert!(sim_set_step_limit(sim, 100) >= 0);
                    }
                    let run = Run { model, sim, plan, method, memory: [&memory, &sim_memory] };
                    let mut moved = false;
                    for _ in 0..24 {
                        if bytes.is_empty() {
                            break;
                        }
                        moved |= run.call(bytes);
                        run.memory.iter().for_each(|m| m.check());
                    }
                    assert!(definition.arrays() > 0);
                    if moved { Reached::Motion } else { Reached::Simulation }
                }
            }

            impl Run<'_> {
                unsafe fn seen(&self, sim: *const SimHandle<R>) -> Seen {
                    let n = self.plan.coordinates;
                    let (mut q, mut v) = (vec![R::NAN; n], vec![R::NAN; n]);
                    let (mut t, mut y) = (R::NAN, vec![R::NAN; self.plan.state_len]);
                    // SAFETY: true pointers and lengths.
                    unsafe {
                        assert!(sim_positions(sim, q.as_mut_ptr(), n) >= 0);
                        assert!(sim_velocities(sim, v.as_mut_ptr(), n) >= 0);
                        assert!(sim_get_state(sim, &mut t, y.as_mut_ptr(), y.len()) >= 0);
                    }
                    let all = q.iter().chain(&v).chain(&y).chain([&t]);
                    all.map(|x| {
                        assert!(x.is_finite(), "a state is shown that is not finite");
                        u64::from(x.to_bits())
                    })
                    .collect()
                }

                /// Does something that may move the simulation; if it fails, everything is as before.
                unsafe fn moving(&self, action: impl FnOnce(*mut SimHandle<R>, &mut nekton_diag) -> nekton_status) -> bool {
                    let mut diag = zeroed::<nekton_diag>();
                    // SAFETY: a live simulation.
                    let before = unsafe { self.seen(self.sim) };
                    let done = check_report(action(self.sim, &mut diag), &diag);
                    // SAFETY: as above.
                    let after = unsafe { self.seen(self.sim) };
                    assert!(done || before == after, "a call failed and left its marks");
                    done
                }

                /// Advances to `end`; if it fails, the steps until then are kept, and nothing is marked by a call without one.
                unsafe fn advancing(&self, end: R, action: impl FnOnce(*mut SimHandle<R>, &mut nekton_diag) -> nekton_status) -> bool {
                    let mut diag = zeroed::<nekton_diag>();
                    // SAFETY (all): a live simulation.
                    let (before, from) = unsafe { (self.seen(self.sim), self.now()) };
                    let done = check_report(action(self.sim, &mut diag), &diag);
                    let (after, to) = unsafe { (self.seen(self.sim), self.now()) };
                    let part = from < to && to <= end && diag.time == f64::from(to);
                    assert!(done && to <= end || !done && (part || before == after), "a call failed and left its marks");
                    done
                }

                unsafe fn now(&self) -> R {
                    let mut t = R::NAN;
                    // SAFETY: a live simulation.
                    assert!(unsafe { sim_time(self.sim, &mut t) } >= 0);
                    t
                }

                unsafe fn call(&self, bytes: &mut Bytes<'_>) -> bool {
                    let (sim, plan) = (self.sim, &self.plan);
                    let mut diag = zeroed::<nekton_diag>();
                    // SAFETY: true pointers and lengths, or ones that are refused.
                    unsafe {
                        match bytes.below(17) {
                            0..=2 => self.moving(|sim, diag| sim_step(sim, diag)),
                            3 => {
                                let by = number(bytes, 0.1);
                                let end = self.now() + by;
                                self.advancing(end, |sim, diag| sim_advance(sim, end, diag))
                            }
                            4 => {
                                let (by, more) = (number(bytes, 0.05), number(bytes, 0.1));
                                let out = self.now() + by;
                                self.advancing(out + more, |sim, diag| sim_advance_dense(sim, out, out + more, diag))
                            }
                            5 => {
                                let mut t = 0.0;
                                let mut y = vec![0.0; plan.state_len];
                                assert!(sim_get_state(sim, &mut t, y.as_mut_ptr(), y.len()) >= 0);
                                t = number(bytes, f64::from(t));
                                for x in &mut y {
                                    *x = number(bytes, f64::from(*x) + 0.01);
                                }
                                let n = bytes.count(y.len());
                                self.moving(|sim, diag| sim_set_state(sim, t, y.as_ptr(), n, diag)) && n == y.len()
                            }
                            6 => {
                                let t = f64::from(self.now());
                                let from = [t, 0.1, 0.0, 0.0].map(|x| number(bytes, x));
                                let to = [t + 0.1, 0.2, 0.1, 0.0].map(|x| number(bytes, x));
                                let channel = bytes.count(0);
                                self.moving(|sim, diag| sim_set_channel(sim, channel, from.as_ptr(), to.as_ptr(), diag))
                            }
                            7 => {
                                let (mut t, n) = (0.0, plan.state_len);
                                let (mut y, mut rates) = (vec![0.0; n], vec![0.0; n]);
                                assert!(sim_get_state(sim, &mut t, y.as_mut_ptr(), n) >= 0);
                                for x in &mut y {
                                    *x = number(bytes, f64::from(*x) + 0.01);
                                }
                                let before = self.seen(sim);
                                if check_report(sim_rhs(sim, t, y.as_ptr(), rates.as_mut_ptr(), n, &mut diag), &diag) {
                                    assert!(rates.iter().all(|x| x.is_finite()));
                                }
                                assert!(before == self.seen(sim), "a question moved the simulation");
                                false
                            }
                            8..=10 => {
                                self.ask(bytes);
                                false
                            }
                            11 => {
                                self.look();
                                false
                            }
                            12 => {
                                assert!(sim_restart(sim) >= 0);
                                self.moving(|sim, diag| sim_step(sim, diag))
                            }
                            13 => self.twin(bytes),
                            14 => {
                                self.wrong_handles();
                                false
                            }
                            15 => {
                                self.linearize(bytes);
                                false
                            }
                            _ => {
                                self.facts(bytes);
                                false
                            }
                        }
                    }
                }

                /// Arrays.
                unsafe fn ask(&self, bytes: &mut Bytes<'_>) {
                    type Question = unsafe extern "C" fn(*mut SimHandle<R>, *mut R, usize, *mut nekton_diag) -> nekton_status;
                    const QUESTIONS: [(Question, u32); 9] = [
                        (sim_accelerations, 1),
                        (sim_mass_matrix, 2),
                        (sim_added_mass, 2),
                        (sim_christoffel, 1),
                        (sim_christoffel_tensor, 3),
                        (sim_buoyancy, 1),
                        (sim_repulsion, 1),
                        (sim_circulation_gradient, 1),
                        (sim_gyroscopic, 2),
                    ];
                    let (question, rank) = QUESTIONS[bytes.below(QUESTIONS.len())];
                    let n = self.plan.coordinates.pow(rank);
                    if rank == 3 && n > 1000 {
                        return;
                    }
                    let mut out = vec![R::NAN; n + 1];
                    let mut diag = zeroed::<nekton_diag>();
                    // SAFETY: a live simulation; the buffer is longer than said, or the call is refused.
                    unsafe {
                        let before = self.seen(self.sim);
                        for wrong in [n - 1, n + 1] {
                            assert!(!check_report(question(self.sim, out.as_mut_ptr(), wrong, &mut diag), &diag));
                        }
                        assert!(question(self.sim, out.as_mut_ptr().byte_add(1), n, &mut diag) < 0);
                        assert!(question(self.sim, null_mut(), n, &mut diag) < 0);
                        assert!(question(self.sim, self.sim.cast(), n, null_mut()) < 0, "its own memory is no buffer");
                        assert!(out.iter().all(|x| x.is_nan()), "refused and yet written");
                        if check_report(question(self.sim, out.as_mut_ptr(), n, &mut diag), &diag) {
                            assert!(out[..n].iter().all(|x| x.is_finite()));
                        }
                        assert!(out[n].is_nan() && before == self.seen(self.sim));
                    }
                }

                /// Derivatives by any parameters, in memory between guards.
                unsafe fn linearize(&self, bytes: &mut Bytes<'_>) {
                    let (mut diag, mut req) = (zeroed::<nekton_diag>(), nekton_req::default());
                    let count = bytes.below(4);
                    let kinds = |bytes: &mut Bytes<'_>| nekton_parameter {
                        kind: if bytes.chance(3) { bytes.kind(14) } else { 1 + bytes.below(12) as i32 },
                        index: bytes.kind(4),
                        component: bytes.kind(4),
                        reserved: i32::from(bytes.below(16) == 0),
                    };
                    let parameters: Vec<_> = (0..count).map(|_| kinds(bytes)).collect();
                    let (d, n) = (self.plan.state_len, self.plan.coordinates);
                    let (mut a, mut b, mut bound) = (vec![R::NAN; d * d + 1], vec![R::NAN; d * count + 1], R::NAN);
                    let (mut h, mut c) = (vec![R::NAN; n * n + 1], vec![R::NAN; n * n + 1]);
                    let qdd: Vec<R> = (0..n).map(|_| number(bytes, 0.5)).collect();
                    let (p, a_len, b_len) = (parameters.as_ptr(), d * d, d * count);
                    // SAFETY: a live simulation; buffers are longer than said, or the call is refused.
                    unsafe {
                        let before = self.seen(self.sim);
                        assert!(check_report(sim_derivatives_req(self.model, &mut req, &mut diag), &diag));
                        let mut memory = Guarded::new(req.size);
                        let (at, len, sim) = (memory.memory(), req.size, self.sim);
                        let (pa, pb) = (a.as_mut_ptr(), b.as_mut_ptr());
                        let known = sim_linearize(sim, p, count, pa, a_len, pb, b_len, &mut bound, at, len, &mut diag);
                        if check_report(known, &diag) {
                            assert!(a[..a_len].iter().chain(&b[..b_len]).all(|x| x.is_finite()) && bound >= 0.0);
                        } else {
                            assert!(bound.is_nan(), "refused and yet written");
                            assert!(a.iter().chain(&b).all(|x| x.is_nan() || *x == 0.0), "half an answer");
                        }
                        let (ph, pc) = (h.as_mut_ptr(), c.as_mut_ptr());
                        let known = sim_force_derivatives(sim, qdd.as_ptr(), n, ph, pc, at, len, &mut diag);
                        if check_report(known, &diag) {
                            assert!(h[..n * n].iter().chain(&c[..n * n]).all(|x| x.is_finite()));
                        } else {
                            assert!(h.iter().chain(&c).all(|x| x.is_nan() || *x == 0.0), "half an answer");
                        }
                        for short in [0, len - 1] {
                            assert!(sim_force_derivatives(sim, qdd.as_ptr(), n, ph, pc, at, short, null_mut()) < 0);
                        }
                        let ends = [a[a_len], b[b_len], h[n * n], c[n * n]];
                        assert!(ends.iter().all(|x| x.is_nan()), "wrote beyond the end");
                        memory.check();
                        assert!(before == self.seen(sim), "a question moved the simulation");
                    }
                }

                /// Numbers.
                unsafe fn look(&self) {
                    let mut diag = zeroed::<nekton_diag>();
                    let n = self.plan.joints;
                    let (mut a, mut b) = (vec![R::NAN; n + 1], vec![R::NAN; n + 1]);
                    let (mut energy, mut resolution) = (zeroed::<EnergyOut<R>>(), zeroed::<ResolutionOut<R>>());
                    let (mut gap, mut counters) = (zeroed::<GapOut<R>>(), zeroed::<nekton_counters>());
                    let mut time_error = zeroed::<TimeErrorOut<R>>();
                    let mut impulse = [R::NAN; 3];
                    // SAFETY: a live simulation and true buffers.
                    unsafe {
                        let before = self.seen(self.sim);
                        assert!(sim_joint_values(self.sim, a.as_mut_ptr(), b.as_mut_ptr(), n) >= 0);
                        let known = sim_joint_torques(self.sim, a.as_mut_ptr(), b.as_mut_ptr(), n, &mut diag);
                        if check_report(known, &diag) {
                            assert!(a[..n].iter().chain(&b[..n]).all(|x| x.is_finite()));
                        }
                        assert!(a[n].is_nan() && b[n].is_nan());
                        if check_report(sim_energy(self.sim, &mut energy, &mut diag), &diag) {
                            assert!(energy.total.is_finite() && energy.kinetic_fluid.is_finite());
                        }
                        if check_report(sim_impulse(self.sim, impulse.as_mut_ptr(), &mut diag), &diag) {
                            assert!(impulse.iter().all(|x| x.is_finite()));
                        }
                        if check_report(sim_energy_drift(self.sim, impulse.as_mut_ptr(), &mut diag), &diag) {
                            assert!(impulse.iter().all(|x| x.is_finite()));
                        }
                        for question in [sim_resolution, sim_indicators] {
                            if check_report(question(self.sim, &mut resolution, &mut diag), &diag) {
                                assert!(resolution.mass.is_finite() && resolution.force.is_finite());
                                assert!(resolution.quadrature.is_finite() && resolution.repulsion.is_finite());
                                assert!(resolution.bound >= R::default());
                            }
                        }
                        if check_report(sim_gap(self.sim, &mut gap, &mut diag), &diag) {
                            assert!(!gap.distance.is_nan());
                        }
                        assert!(sim_counters(self.sim, &mut counters) >= 0);
                        assert!(sim_time_error(self.sim, &mut time_error) >= 0);
                        assert!(!(time_error.length_sum < 0.0 || time_error.spin_sum < 0.0));
                        assert!(before == self.seen(self.sim), "a question moved the simulation");
                    }
                }

                /// A copy goes on exactly like the original.
                unsafe fn twin(&self, bytes: &mut Bytes<'_>) -> bool {
                    let mut diag = zeroed::<nekton_diag>();
                    let mut memory = Guarded::new(self.plan.sim_bytes);
                    let mut twin = null_mut();
                    // SAFETY: live objects.
                    unsafe {
                        let at = memory.memory();
                        let made = sim_init(at, self.plan.sim_bytes, self.model, &self.method, &mut twin, &mut diag);
                        assert!(check_report(made, &diag), "what could be made once can be made again");
                        assert!(check_report(sim_copy(twin, self.sim, &mut diag), &diag));
                        assert!(self.seen(twin) == self.seen(self.sim));
                        // The twin goes on from bytes, now and then damaged before.
                        let (mut len, mut written) = (0, 0);
                        assert!(sim_save_req(self.sim, &mut len) >= 0);
                        let mut saved = vec![0_u8; len];
                        let to = saved.as_mut_ptr().cast();
                        assert!(check_report(sim_save(self.sim, to, len, &mut written, &mut diag), &diag), "not saved");
                        assert_eq!(written, len);
                        let at = bytes.below(len);
                        saved[at] ^= 1 << bytes.below(8);
                        assert!(!check_report(sim_load(twin, saved.as_ptr().cast(), len, &mut diag), &diag));
                        saved = vec![0; len];
                        assert!(sim_save(self.sim, saved.as_mut_ptr().cast(), len, &mut written, &mut diag) >= 0);
                        assert!(check_report(sim_load(twin, saved.as_ptr().cast(), len, &mut diag), &diag), "not loaded");
                        assert!(self.seen(twin) == self.seen(self.sim));
                        let first = sim_step(self.sim, null_mut());
                        assert_eq!(first, sim_step(twin, null_mut()), "a copy steps otherwise");
                        assert!(self.seen(twin) == self.seen(self.sim), "a copy goes elsewhere");
                        memory.check();
                        first >= 0
                    }
                }

                /// Handles that are none.
                unsafe fn wrong_handles(&self) {
                    let mut text = [0_u64; 64];
                    let no_object = text.as_mut_ptr();
                    // SAFETY: every one of these is refused before more than its first word is read.
                    unsafe {
                        let misaligned = self.sim.byte_add(1);
                        for sim in [null_mut(), misaligned, self.model.cast(), no_object.cast()] {
                            assert!(sim_step(sim, null_mut()) < 0 && sim_restart(sim) < 0);
                            assert!(sim_copy(sim, self.sim, null_mut()) < 0 && sim_copy(self.sim, sim, null_mut()) < 0);
                        }
                        let mut plan = zeroed::<nekton_plan>();
                        for model in [null(), self.sim.cast_const().cast(), no_object.cast_const().cast()] {
                            assert!(model_plan(model, &mut plan) < 0);
                        }
                        assert!(model_plan(self.model, null_mut()) < 0);
                        // Neither is from the heap.
                        assert!(sim_free(self.sim) < 0 && model_free(self.model) < 0);
                    }
                }

                /// What a model tells.
                unsafe fn facts(&self, bytes: &mut Bytes<'_>) {
                    let ordinary = bytes.below(4);
                    let i = bytes.count(ordinary);
                    let mut link = zeroed::<LinkOut<R>>();
                    let mut joint = zeroed::<nekton_joint_info>();
                    let (mut place, mut status) = (zeroed::<nekton_place>(), 0);
                    let wanted = nekton_place { kind: bytes.kind(6), index: bytes.kind(3), link: bytes.kind(3) };
                    let t = number(bytes, 1.0);
                    let mut point = [R::NAN; 2];
                    // SAFETY: a live model and true buffers.
                    unsafe {
                        assert_eq!(model_link(self.model, i, &mut link) >= 0, i < self.plan.links);
                        assert_eq!(model_joint(self.model, i, &mut joint) >= 0, i < self.plan.joints);
                        assert_eq!(model_notice(self.model, i, &mut place, &mut status) >= 0, i < self.plan.notices);
                        let mut nodes = 0;
                        if model_nodes(self.model, &wanted, &mut nodes) >= 0 {
                            assert!(nodes >= 8 && nodes % 2 == 0);
                        }
                        if model_outline_point(self.model, &wanted, t, (&raw mut point).cast()) >= 0 {
                            assert!(point.iter().all(|x| x.is_finite()), "a point of an outline that is not finite");
                        }
                    }
                }
            }
        }
    };
}

precision!(double, api64, f64, {
    model_req = nekton_model_req,
    model_init = nekton_model_init,
    model_plan = nekton_model_plan,
    model_link = nekton_model_link,
    model_joint = nekton_model_joint,
    model_notice = nekton_model_notice,
    model_nodes = nekton_model_nodes,
    model_outline_point = nekton_model_outline_point,
    model_free = nekton_model_free,
    sim_req = nekton_sim_req,
    sim_init = nekton_sim_init,
    sim_free = nekton_sim_free,
    sim_copy = nekton_sim_copy,
    sim_time = nekton_sim_time,
    sim_positions = nekton_sim_positions,
    sim_velocities = nekton_sim_velocities,
    sim_get_state = nekton_sim_get_state,
    sim_set_state = nekton_sim_set_state,
    sim_restart = nekton_sim_restart,
    sim_step = nekton_sim_step,
    sim_advance = nekton_sim_advance,
    sim_advance_dense = nekton_sim_advance_dense,
    sim_set_step_limit = nekton_sim_set_step_limit,
    sim_save_req = nekton_sim_save_req,
    sim_save = nekton_sim_save,
    sim_load = nekton_sim_load,
    sim_set_channel = nekton_sim_set_channel,
    sim_rhs = nekton_sim_rhs,
    sim_joint_values = nekton_sim_joint_values,
    sim_joint_torques = nekton_sim_joint_torques,
    sim_accelerations = nekton_sim_accelerations,
    sim_mass_matrix = nekton_sim_mass_matrix,
    sim_added_mass = nekton_sim_added_mass,
    sim_christoffel = nekton_sim_christoffel,
    sim_christoffel_tensor = nekton_sim_christoffel_tensor,
    sim_buoyancy = nekton_sim_buoyancy,
    sim_repulsion = nekton_sim_repulsion,
    sim_circulation_gradient = nekton_sim_circulation_gradient,
    sim_gyroscopic = nekton_sim_gyroscopic,
    sim_derivatives_req = nekton_sim_derivatives_req,
    sim_linearize = nekton_sim_linearize,
    sim_force_derivatives = nekton_sim_force_derivatives,
    sim_energy = nekton_sim_energy,
    sim_energy_drift = nekton_sim_energy_drift,
    sim_impulse = nekton_sim_impulse,
    sim_indicators = nekton_sim_indicators,
    sim_resolution = nekton_sim_resolution,
    sim_time_error = nekton_sim_time_error,
    sim_gap = nekton_sim_gap,
    sim_counters = nekton_sim_counters,
});
precision!(single, api32, f32, {
    model_req = nekton32_model_req,
    model_init = nekton32_model_init,
    model_plan = nekton32_model_plan,
    model_link = nekton32_model_link,
    model_joint = nekton32_model_joint,
    model_notice = nekton32_model_notice,
    model_nodes = nekton32_model_nodes,
    model_outline_point = nekton32_model_outline_point,
    model_free = nekton32_model_free,
    sim_req = nekton32_sim_req,
    sim_init = nekton32_sim_init,
    sim_free = nekton32_sim_free,
    sim_copy = nekton32_sim_copy,
    sim_time = nekton32_sim_time,
    sim_positions = nekton32_sim_positions,
    sim_velocities = nekton32_sim_velocities,
    sim_get_state = nekton32_sim_get_state,
    sim_set_state = nekton32_sim_set_state,
    sim_restart = nekton32_sim_restart,
    sim_step = nekton32_sim_step,
    sim_advance = nekton32_sim_advance,
    sim_advance_dense = nekton32_sim_advance_dense,
    sim_set_step_limit = nekton32_sim_set_step_limit,
    sim_save_req = nekton32_sim_save_req,
    sim_save = nekton32_sim_save,
    sim_load = nekton32_sim_load,
    sim_set_channel = nekton32_sim_set_channel,
    sim_rhs = nekton32_sim_rhs,
    sim_joint_values = nekton32_sim_joint_values,
    sim_joint_torques = nekton32_sim_joint_torques,
    sim_accelerations = nekton32_sim_accelerations,
    sim_mass_matrix = nekton32_sim_mass_matrix,
    sim_added_mass = nekton32_sim_added_mass,
    sim_christoffel = nekton32_sim_christoffel,
    sim_christoffel_tensor = nekton32_sim_christoffel_tensor,
    sim_buoyancy = nekton32_sim_buoyancy,
    sim_repulsion = nekton32_sim_repulsion,
    sim_circulation_gradient = nekton32_sim_circulation_gradient,
    sim_gyroscopic = nekton32_sim_gyroscopic,
    sim_derivatives_req = nekton32_sim_derivatives_req,
    sim_linearize = nekton32_sim_linearize,
    sim_force_derivatives = nekton32_sim_force_derivatives,
    sim_energy = nekton32_sim_energy,
    sim_energy_drift = nekton32_sim_energy_drift,
    sim_impulse = nekton32_sim_impulse,
    sim_indicators = nekton32_sim_indicators,
    sim_resolution = nekton32_sim_resolution,
    sim_time_error = nekton32_sim_time_error,
    sim_gap = nekton32_sim_gap,
    sim_counters = nekton32_sim_counters,
});
