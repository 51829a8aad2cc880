//! Made from api64.rs by `cargo xtask header`: the same in single precision.

use crate::diag::{report, report_notice};
use crate::types::*;
use crate::{derivatives, model, questions, sim, sized};
use core::ffi::c_void;
use core::ptr::null_mut;

/// Fills a scene definition with defaults: fluid of density 1, nothing else. Call it as nekton32_scene_def_init(&def,
/// sizeof def, NEKTON_ABI_VERSION).
/// Errors: NULL_POINTER, MISALIGNED, ABI_VERSION (header and library do not fit). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_scene_def_init(
    def: *mut SceneDef<f32>,
    struct_size: usize,
    abi_version: u32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sized::init(def, struct_size, abi_version)) }
}

/// Fills a wall definition with defaults: at the origin, automatic nodes, no circulation; the shape is still to be set. Call it as
/// nekton32_wall_def_init(&def): a macro of that name adds size and version.
/// Errors: as nekton32_scene_def_init. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_wall_def_init(
    def: *mut WallDef<f32>,
    struct_size: usize,
    abi_version: u32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sized::init(def, struct_size, abi_version)) }
}

/// Fills a body definition with defaults: free, at rest at the origin; the links are still to be set. Call it as
/// nekton32_body_def_init(&def).
/// Errors: as nekton32_scene_def_init. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_body_def_init(
    def: *mut BodyDef<f32>,
    struct_size: usize,
    abi_version: u32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sized::init(def, struct_size, abi_version)) }
}

/// Fills a link definition with defaults: density 1, automatic nodes, no circulation, no parent; if it gets one, a hinge
/// locked at 0. The shape is still to be set. Call it as nekton32_link_def_init(&def).
/// Errors: as nekton32_scene_def_init. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_link_def_init(
    def: *mut LinkDef<f32>,
    struct_size: usize,
    abi_version: u32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sized::init(def, struct_size, abi_version)) }
}

/// Fills a method with defaults: ADAMS, both tolerances 1e-9 (single precision: 1e-4), steps of its own choice. Call it as
/// nekton32_method_init(&method).
/// Errors: as nekton32_scene_def_init. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_method_init(
    def: *mut MethodDef<f32>,
    struct_size: usize,
    abi_version: u32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sized::init(def, struct_size, abi_version)) }
}

/// Memory that nekton32_model_init needs for this scene. Checks everything but geometry.
/// Errors: NULL_POINTER, MISALIGNED, ABI_VERSION, UNKNOWN_KIND, NOT_FINITE, OUT_OF_RANGE, EMPTY_SCENE, NODE_COUNT,
/// BAD_TOLERANCE, BAD_PARENT, MASSLESS, SIZE_OVERFLOW, UNSUPPORTED (a field of a newer header is set). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_req(
    def: *const SceneDef<f32>,
    req: *mut nekton_req,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, model::req(def, req)) }
}

/// Compiles a scene into mem (len bytes, aligned to NEKTON_ALIGN), which must stay as long as the model is used and
/// needs no other clean-up; def is not needed afterwards. *model is set on success only. Returns a notice (> 0, the
/// first; all by nekton32_model_notice) when something was mended. How well points tell a curve is looked at by nekton32_model_create only.
/// Errors: as nekton32_model_req, MEMORY_TOO_SMALL: nothing was written to mem. BAD_SHAPE, SELF_INTERSECTION,
/// OUT_OF_RANGE, BAD_TABLE, SINGULAR: mem holds no model. O(n^3) once for shapes other than ellipses. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_init(
    mem: *mut c_void,
    len: usize,
    def: *const SceneDef<f32>,
    model: *mut *mut ModelHandle<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report_notice(diag, model::init(mem.cast(), len, def, model)) }
}

/// The same in memory from the heap; to be given to nekton32_model_free.
/// Errors: as nekton32_model_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_create(
    def: *const SceneDef<f32>,
    model: *mut *mut ModelHandle<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report_notice(diag, model::create(def, model)) }
}

/// Frees a model from nekton32_model_create (NULL: does nothing), after its simulations.
/// Errors: BAD_HANDLE if it is not from there. Any thread, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_free(model: *mut ModelHandle<f32>) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::free(model)) }
}

/// What the model computes, how long its arrays are, and what it costs.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_plan(model: *const ModelHandle<f32>, plan: *mut nekton_plan) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::plan(model, plan)) }
}

/// Facts about a link, counted through all bodies.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_link(
    model: *const ModelHandle<f32>,
    link: usize,
    info: *mut LinkOut<f32>,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::link(model, link, info)) }
}

/// Facts about a joint, counted in the order of the links they move.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_joint(
    model: *const ModelHandle<f32>,
    joint: usize,
    info: *mut nekton_joint_info,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::joint(model, joint, info)) }
}

/// What set-up noticed and mended, such as an outline that was turned round.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (there are as many as nekton_plan tells). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_notice(
    model: *const ModelHandle<f32>,
    notice: usize,
    place: *mut nekton_place,
    status: *mut nekton_status,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::notice(model, notice, place, status)) }
}

/// Nodes on a boundary, given or automatic.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_nodes(
    model: *const ModelHandle<f32>,
    place: *const nekton_place,
    nodes: *mut usize,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::nodes(model, place, nodes)) }
}

/// Of a curve through points, the relative error of added mass and area that may come from what is between the points: an
/// estimate, and no part of nekton_resolution, which knows the curve only. From the tolerance of the scene (0: a thousandth) on
/// the model has the notice OUTLINE_UNCERTAIN. -1 for other shapes, and in a model from nekton32_model_init, which uses no heap.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (no such place). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_outline_error(
    model: *const ModelHandle<f32>,
    place: *const nekton_place,
    error: *mut f32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::outline_error(model, place, error)) }
}

/// Point (x, y: 2 numbers) of an outline at parameter t in [0, 2 pi): links in their own frame with the centre of
/// mass as origin, walls in the world.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NOT_FINITE, OUT_OF_RANGE (no such place). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_model_outline_point(
    model: *const ModelHandle<f32>,
    place: *const nekton_place,
    t: f32,
    point: *mut f32,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::outline_point(model, place, t, point.cast())) }
}

/// Memory that nekton32_sim_init needs.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, ABI_VERSION (the method was not filled by nekton32_method_init),
/// UNKNOWN_KIND, BAD_STEP, BAD_TOLERANCE, OUT_OF_RANGE (max_step or first_step with a fixed step), SIZE_OVERFLOW,
/// UNSUPPORTED. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_req(
    model: *const ModelHandle<f32>,
    method: *const MethodDef<f32>,
    req: *mut nekton_req,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::req(model, method, req)) }
}

/// Starts a simulation at time 0 and the scene's initial state in mem (len bytes, aligned to NEKTON_ALIGN), which
/// must stay, like the model, as long as the simulation is used, and needs no other clean-up. *sim is set on
/// success only.
/// Errors: as nekton32_sim_req, MEMORY_TOO_SMALL: nothing was written to mem. OVERLAP, OUTSIDE_TANK, SINGULAR: mem
/// holds no simulation. Any thread; the simulation is then used by one thread at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_init(
    mem: *mut c_void,
    len: usize,
    model: *const ModelHandle<f32>,
    method: *const MethodDef<f32>,
    sim: *mut *mut SimHandle<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::init(mem.cast(), len, model, method, sim, false)) }
}

/// The same in memory from the heap; to be given to nekton32_sim_free.
/// Errors: as nekton32_sim_init; OUT_OF_MEMORY; UNSUPPORTED without NEKTON_CAP_ALLOC. Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_create(
    model: *const ModelHandle<f32>,
    method: *const MethodDef<f32>,
    sim: *mut *mut SimHandle<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::create(model, method, sim)) }
}

/// Frees a simulation from nekton32_sim_create (NULL: does nothing).
/// Errors: BAD_HANDLE if it is not from there; BUSY: it is still there. Any thread, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_free(sim: *mut SimHandle<f32>) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), model::free_sim(sim)) }
}

/// Makes a simulation go on exactly as another one of the same model: time, state, integrator and its past,
/// channels, counters.
/// Errors: BAD_HANDLE (also if the models differ), NULL_POINTER, MISALIGNED, BUSY. One thread for to; any number may copy
/// from from while nobody else uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_copy(
    to: *mut SimHandle<f32>,
    from: *const SimHandle<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::assign(to, from)) }
}

/// Bytes that nekton32_sim_save writes; they depend on the model alone.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_save_req(sim: *const SimHandle<f32>, bytes: *mut usize) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::save_req(sim, bytes)) }
}

/// Writes all that a simulation remembers to out, which has room for len bytes: time, state, method, integrator and its past,
/// channels, counters, estimates, limit of steps. nekton32_sim_load of any simulation of an equal model, in any process and on any
/// machine, goes on from there bit for bit (with the same build of this library). The bytes have no alignment and no pointers;
/// written tells how many there are.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, MEMORY_TOO_SMALL (out is then not written), BAD_SAVE (a number
/// of the simulation is not finite). One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_save(
    sim: *const SimHandle<f32>,
    out: *mut c_void,
    len: usize,
    written: *mut usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::save(sim, out.cast(), len, written)) }
}

/// Makes a simulation what was saved by nekton32_sim_save, by itself or by another one of an equal model (every value of its scene is
/// the same); the method becomes the saved one, too. from are exactly the len bytes that were written.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, BUSY, ALIASING, BAD_SAVE: diag->what names what is wrong, "mark" (these are other
/// bytes), "version" (of another version of this library), "precision", "model" (another scene), "length", "checksum" (damaged) or
/// a value. The simulation is then as it was, bit for bit. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_load(
    sim: *mut SimHandle<f32>,
    from: *const c_void,
    len: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::load(sim, from.cast(), len)) }
}

/// The simulation's model.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_model(
    sim: *const SimHandle<f32>,
    model: *mut *const ModelHandle<f32>,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::model_of(sim, model)) }
}

/// Time of the state shown, s.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_time(sim: *const SimHandle<f32>, t: *mut f32) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::time(sim, t)) }
}

/// x, y, theta of every link's centre of mass; n = 3 links.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_positions(sim: *const SimHandle<f32>, q: *mut f32, n: usize) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), questions::shown(sim, q, n, false)) }
}

/// Rates of x, y, theta of every link; n = 3 links.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_velocities(sim: *const SimHandle<f32>, qd: *mut f32, n: usize) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), questions::shown(sim, qd, n, true)) }
}

/// Time and integrated state: free coordinates, their rates (not for a lone swimmer), and last the work of the
/// drives if anything is driven; n = state_len of the plan.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_get_state(
    sim: *const SimHandle<f32>,
    t: *mut f32,
    y: *mut f32,
    n: usize,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::get_state(sim, t, y, n)) }
}

/// Sets time and state as nekton32_sim_get_state gives them; the integrator starts anew.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT; the simulation is then as
/// it was. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_set_state(
    sim: *mut SimHandle<f32>,
    t: f32,
    y: *const f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::set_state(sim, t, y, n)) }
}

/// Forgets the integrator's past, as after a jump of the drives.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_restart(sim: *mut SimHandle<f32>) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::restart(sim)) }
}

/// One step of the method (ADAMS: one step of its own choice). Returns a notice (> 0): STEP_TOO_LONG if the estimated error
/// of the step is a tenth of a body's reach, or of a radian, or more (see nekton32_sim_time_error; GAUSS6 has no estimate);
/// UNRESOLVED if the bound of the error in space exceeded the scene's tolerance (1e-3 without); diag tells the bound,
/// when, and what is closest.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE, STEP_TOO_SMALL, NO_CONVERGENCE;
/// the simulation is then as it was, bit for bit. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_step(sim: *mut SimHandle<f32>, diag: *mut nekton_diag) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report_notice(diag, sim::step(sim)) }
}

/// Advances to exactly t_end; nothing is evaluated beyond it. A fixed-step method shortens its last step. This is
/// the step function of a controller: set channels, advance by a sample time, read the state. Notices as nekton32_sim_step,
/// with the largest error met.
/// Errors: as nekton32_sim_step, and PAST_TIME (t_end lies before the time shown), NOT_FINITE, TOO_MANY_STEPS (see
/// nekton32_sim_set_step_limit; of fixed steps at once, with how many it takes and how many are allowed). The steps made until then are kept: the state shown is that of the last good step
/// (nekton32_sim_time and diag->time tell when), and the simulation may go on, as if it had been asked to come this far.
/// If no step was good, it is as it was before the call, bit for bit. To get back further, copy before you advance
/// (nekton32_sim_copy). One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_advance(
    sim: *mut SimHandle<f32>,
    t_end: f32,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report_notice(diag, sim::advance(sim, t_end, t_end)) }
}

/// Shows the state at t_out; the integrator may run ahead, but not beyond t_stop. Cheaper than nekton32_sim_advance
/// when output is wanted at many times: ADAMS keeps its steps and interpolates.
/// Errors: as nekton32_sim_advance; PAST_TIME also if t_out > t_stop. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_advance_dense(
    sim: *mut SimHandle<f32>,
    t_out: f32,
    t_stop: f32,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report_notice(diag, sim::advance(sim, t_out, t_stop)) }
}

/// How many steps one call of nekton32_sim_advance or nekton32_sim_advance_dense may make (at first 1000000) before it
/// ends with TOO_MANY_STEPS, so that no call takes for ever.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, OUT_OF_RANGE (0). One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_set_step_limit(sim: *mut SimHandle<f32>, steps: u64) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), sim::set_step_limit(sim, steps)) }
}

/// Sets a channel (NEKTON_SIGNAL_CHANNEL; counted body by body, first the root, then the joints): t, u, du/dt,
/// d2u/dt2 (4 numbers) at both ends of the coming interval, quintic in between, constant outside. For a torque
/// these are the torque and its rates. What continues the piece before (u, du/dt, d2u/dt2 of a motion, the value of a torque), and
/// the same piece again, does not disturb the integrator; where d2u/dt2 or a torque jumps, fixed-step methods forget past
/// rates and ADAMS evaluates once more. A motion whose u or du/dt jumps once it has begun is noticed (DRIVE_UNRESOLVED): it would
/// take an impulse, which is not made. For control loops: RK4 or ABM4 with a step that divides the sample and is a sixteenth of
/// the fastest period or less; ADAMS where time per sample need not be bounded.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NOT_FINITE, BAD_TABLE (times do not increase), UNSUPPORTED (no
/// such channel). One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_set_channel(
    sim: *mut SimHandle<f32>,
    channel: usize,
    from: *const f32,
    to: *const f32,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::set_channel(sim, channel, from.cast(), to.cast())) }
}

/// Right-hand side dy/dt for an integrator of your own; y and ydot as in nekton32_sim_get_state, n = state_len, not
/// overlapping. The simulation's own state does not change.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, NOT_FINITE, ALIASING, CONTACT, SINGULAR, NON_FINITE_STATE;
/// ydot is then 0. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_rhs(
    sim: *mut SimHandle<f32>,
    t: f32,
    y: *const f32,
    ydot: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, sim::rhs(sim, t, y, ydot, n)) }
}

/// u and du/dt of every joint; n = joints each.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_joint_values(
    sim: *mut SimHandle<f32>,
    u: *mut f32,
    du: *mut f32,
    n: usize,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), questions::joints(sim, ("u", u), ("du", du), n, questions::joint_values)) }
}

/// Torque (slider: force) that drives every joint, and its power; n = joints each.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One
/// evaluation if there was none since the last step. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_joint_torques(
    sim: *mut SimHandle<f32>,
    torque: *mut f32,
    power: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe {
        report(diag, questions::joints(sim, ("torque", torque), ("power", power), n, |s, a, b| s.joint_torques(a, b)))
    }
}

/// Accelerations of every link; n = 3 links. One evaluation if there was none since the last step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_accelerations(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 1, |s, out| s.accelerations(out))) }
}

/// Mass matrix: bodies and added mass; n = (3 links)^2, column-major. 3 links + 1 solves.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_mass_matrix(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 2, |s, out| s.mass_matrix(out))) }
}

/// Added mass of the fluid, symmetrized; n = (3 links)^2, column-major. 3 links + 1 solves.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_added_mass(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 2, |s, out| s.added_mass(out))) }
}

/// Christoffel force, quadratic in the velocities, by the scene's formula; n = 3 links. One evaluation if there was
/// none since the last step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_christoffel(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 1, |s, out| s.christoffel(out))) }
}

/// Full tensor of the Christoffel force, entry (a, i, j) at a + 3 links (i + 3 links j); n = (3 links)^3. For
/// inspection: (3 links)^2 forces.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_christoffel_tensor(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 3, |s, out| s.christoffel_tensor(out))) }
}

/// Gradient of the potential energy of weight and buoyancy; n = 3 links. One evaluation if there was none since the
/// last step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_buoyancy(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 1, |s, out| s.buoyancy(out))) }
}

/// Gradient of the potential energy of repulsion; n = 3 links. One evaluation if there was none since the last
/// step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_repulsion(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 1, |s, out| s.repulsion(out))) }
}

/// Gradient of the energy of the circulatory flow; n = 3 links. One evaluation if there was none since the last
/// step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_circulation_gradient(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 1, |s, out| s.circulation_gradient(out))) }
}

/// Antisymmetric matrix G of the force G qd of circulation; n = (3 links)^2, column-major. 6 links solves.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread
/// per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_gyroscopic(
    sim: *mut SimHandle<f32>,
    out: *mut f32,
    n: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::ask(sim, out, n, 2, |s, out| s.gyroscopic(out))) }
}

/// Memory that nekton32_sim_linearize and nekton32_sim_force_derivatives need for a simulation of this model.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, SIZE_OVERFLOW, UNSUPPORTED (an archive without the feature derivatives). Any thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_derivatives_req(
    model: *const ModelHandle<f32>,
    req: *mut nekton_req,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, derivatives::req(model, req)) }
}

/// Linearization of dy/dt = f(t, y, parameters) at the state shown, y as nekton32_sim_get_state gives it (d numbers): a = df/dy, d x d,
/// and b = df/dparameters, d x count, column-major; a_len and b_len are their numbers of entries. Derivatives of what
/// nekton32_sim_rhs computes, with nodes that stay where they are on their outlines. *bound gets a bound of their relative error in
/// space. mem: len bytes as nekton32_sim_derivatives_req says, used while the call runs. The simulation does not change, and a run goes
/// on by the same bits. Costs two to three evaluations more; with circulation, whose force is differentiated by differences unless the body
/// is alone, 12 links + 2 more.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, LENGTH, ALIASING, MEMORY_TOO_SMALL, UNKNOWN_KIND and OUT_OF_RANGE (a parameter that the
/// model does not have: diag says which), UNSUPPORTED (the boundary formula), CONTACT, SINGULAR, BOUND_EXCEEDED,
/// NON_FINITE_STATE; a and b are then 0. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_linearize(
    sim: *mut SimHandle<f32>,
    parameters: *const nekton_parameter,
    count: usize,
    a: *mut f32,
    a_len: usize,
    b: *mut f32,
    b_len: usize,
    bound: *mut f32,
    mem: *mut c_void,
    len: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    let mem = mem.cast();
    let asked = derivatives::Asked { parameters, count, a, a_len, b, b_len, bound, mem, len };
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, derivatives::linearize(sim, &asked)) }
}

/// Derivatives of the links' force r = M qdd + F at the state shown for given accelerations qdd (n = 3 links), F without inertia and
/// without the forces of joints: position = dr/dq and velocity = dr/dqd, n x n each, column-major. For mechanics of your own. mem as for
/// nekton32_sim_linearize.
/// Errors: as nekton32_sim_linearize, NOT_FINITE. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_force_derivatives(
    sim: *mut SimHandle<f32>,
    qdd: *const f32,
    n: usize,
    position: *mut f32,
    velocity: *mut f32,
    mem: *mut c_void,
    len: usize,
    diag: *mut nekton_diag,
) -> nekton_status {
    let asked = derivatives::AskedForces { qdd, n, position, velocity, mem: mem.cast(), len };
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, derivatives::force_derivatives(sim, &asked)) }
}

/// Energies at the state shown. One evaluation if there was none since the last step.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_energy(
    sim: *mut SimHandle<f32>,
    energy: *mut EnergyOut<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::energy(sim, energy)) }
}

/// Balance of energy, 3 numbers: total - work now minus what it was when an energy was first asked for (ask at the start, too); the
/// largest kinetic energy met; the drift from where on ENERGY_DRIFT is noticed. It sees the error of the whole motion, also what
/// no estimate of single steps can see. Cost and errors: as nekton32_sim_energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_energy_drift(
    sim: *mut SimHandle<f32>,
    drift: *mut f32,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::energy_drift(sim, drift.cast())) }
}

/// Linear impulse (x, y) and angular impulse about the origin, 3 numbers, of bodies, fluid and circulation.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, BOUND_EXCEEDED, NON_FINITE_STATE. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_impulse(
    sim: *mut SimHandle<f32>,
    impulse: *mut f32,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::impulse(sim, impulse.cast())) }
}

/// Error indicators of the steps: the largest over the last call that stepped; before the first step those of the state
/// shown. They come with every step at the cost of one solve; see nekton_scene_def.tolerance.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED; before the first step CONTACT, SINGULAR, NON_FINITE_STATE. One thread per
/// simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_indicators(
    sim: *mut SimHandle<f32>,
    indicators: *mut ResolutionOut<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::resolution(sim, indicators, |s| s.indicators())) }
}

/// Error indicators of the space discretization at the state shown, from all of the added mass. 6 links + 7 solves.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, CONTACT, SINGULAR, NON_FINITE_STATE. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_resolution(
    sim: *mut SimHandle<f32>,
    resolution: *mut ResolutionOut<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::resolution(sim, resolution, |s| s.resolution())) }
}

/// Estimated local errors of time integration since the start or the last nekton32_sim_set_state. Where the motion
/// neither amplifies nor forgets errors, the sums of the coordinates plus those of their rates times the time that is left bound
/// the error: they were 2 to 8 times (RK4), 2 to 22 times (ABM4) and 3 to 400 times (ADAMS) as large. RK4 estimates from the eighth
/// step on, ABM4 from the fourth, GAUSS6 never. No evaluation.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_time_error(
    sim: *const SimHandle<f32>,
    error: *mut TimeErrorOut<f32>,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), questions::time_error(sim, error)) }
}

/// The smallest gap between boundaries of which one moves. No evaluation.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED, NON_FINITE_STATE. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_gap(
    sim: *mut SimHandle<f32>,
    gap: *mut GapOut<f32>,
    diag: *mut nekton_diag,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(diag, questions::gap(sim, gap)) }
}

/// What the simulation did since its start.
/// Errors: BAD_HANDLE, NULL_POINTER, MISALIGNED. One thread per simulation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nekton32_sim_counters(
    sim: *const SimHandle<f32>,
    counters: *mut nekton_counters,
) -> nekton_status {
    // SAFETY: every pointer is checked as the crate's documentation says.
    unsafe { report(null_mut(), questions::counters(sim, counters)) }
}
