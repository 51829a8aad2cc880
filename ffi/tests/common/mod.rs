//! Scenes as C describes them, one of them for Rust too, and what every test needs.

#![allow(dead_code, unused_imports)]

use nekton_ffi::shared::NEKTON_ABI_VERSION;
use nekton_ffi::types::*;

/// Memory that begins on an 8-byte boundary.
pub fn memory(bytes: usize) -> Vec<u64> {
    vec![0x5a5a_5a5a_5a5a_5a5a; bytes.div_ceil(8)]
}

/// Text of a C array.
pub fn what(diag: &nekton_diag) -> String {
    diag.what.iter().take_while(|c| **c != 0).map(|c| *c as u8 as char).collect()
}

pub fn empty_diag() -> nekton_diag {
    let nowhere = nekton_place { kind: -7, index: -7, link: -7 };
    nekton_diag {
        status: 77,
        place: nowhere,
        other: nowhere,
        item: -7,
        value: 0.0,
        limit: 0.0,
        time: 0.0,
        what: [1; 32],
    }
}

/// A struct after a function that fills it.
pub fn filled<T>(fill: impl FnOnce(*mut T, usize) -> nekton_status) -> T {
    let mut def = std::mem::MaybeUninit::uninit();
    assert_eq!(fill(def.as_mut_ptr(), size_of::<T>()), 0);
    unsafe { def.assume_init() }
}

/// Everything about one precision, under names that do not tell it.
macro_rules! precision {
    ($module:ident, $real:ident, $api:ident, $($long:ident = $short:ident),* $(,)?) => {
        pub mod $module {
            use super::*;
            pub type Real = $real;
            $( pub use nekton_ffi::$api::$long as $short; )*

            pub fn scene() -> SceneDef<Real> {
                filled(|def: *mut SceneDef<Real>, size| unsafe { scene_def_init(def, size, NEKTON_ABI_VERSION) })
            }
            pub fn wall() -> WallDef<Real> {
                filled(|def: *mut WallDef<Real>, size| unsafe { wall_def_init(def, size, NEKTON_ABI_VERSION) })
            }
            pub fn body() -> BodyDef<Real> {
                filled(|def: *mut BodyDef<Real>, size| unsafe { body_def_init(def, size, NEKTON_ABI_VERSION) })
            }
            pub fn link() -> LinkDef<Real> {
                filled(|def: *mut LinkDef<Real>, size| unsafe { link_def_init(def, size, NEKTON_ABI_VERSION) })
            }
            pub fn ellipse(a: Real, b: Real) -> LinkDef<Real> {
                let mut link = link();
                (link.shape.kind, link.shape.a, link.shape.b, link.nodes) = (NEKTON_SHAPE_ELLIPSE, a, b, 32);
                link
            }
            pub fn method() -> MethodDef<Real> {
                filled(|def: *mut MethodDef<Real>, size| unsafe { method_init(def, size, NEKTON_ABI_VERSION) })
            }
            pub fn adams() -> MethodDef<Real> {
                let tolerance = if size_of::<Real>() == 8 { 1e-8 } else { 1e-4 };
                MethodDef { relative: tolerance as Real, absolute: tolerance as Real, ..method() }
            }
            pub fn fixed(kind: i32) -> MethodDef<Real> {
                MethodDef { kind, step: 0.01, ..method() }
            }

            /// A model in memory of its own.
            pub fn compile(def: &SceneDef<Real>) -> (Vec<u64>, *mut ModelHandle<Real>) {
                let mut req = nekton_req::default();
                let mut diag = empty_diag();
                assert_eq!(unsafe { model_req(def, &mut req, &mut diag) }, 0, "{:?} {}", diag, what(&diag));
                let mut mem = memory(req.size);
                let mut model = std::ptr::null_mut();
                let status = unsafe { model_init(mem.as_mut_ptr().cast(), req.size, def, &mut model, &mut diag) };
                assert!(status >= 0, "{:?} {}", diag, what(&diag));
                (mem, model)
            }
            /// A simulation in memory of its own.
            pub fn simulate(model: *const ModelHandle<Real>, method: &MethodDef<Real>) -> (Vec<u64>, *mut SimHandle<Real>) {
                let mut req = nekton_req::default();
                let mut diag = empty_diag();
                assert_eq!(unsafe { sim_req(model, method, &mut req, &mut diag) }, 0, "{:?}", diag);
                let mut mem = memory(req.size);
                let mut sim = std::ptr::null_mut();
                let status = unsafe { sim_init(mem.as_mut_ptr().cast(), req.size, model, method, &mut sim, &mut diag) };
                assert_eq!(status, 0, "{:?} {}", diag, what(&diag));
                (mem, sim)
            }
            pub fn plan(model: *const ModelHandle<Real>) -> nekton_plan {
                let mut plan = std::mem::MaybeUninit::uninit();
                assert_eq!(unsafe { model_plan(model, plan.as_mut_ptr()) }, 0);
                unsafe { plan.assume_init() }
            }
            /// Time and state.
            pub fn state(model: *const ModelHandle<Real>, sim: *const SimHandle<Real>) -> (Real, Vec<Real>) {
                let mut y = vec![0.0; plan(model).state_len];
                let mut t = 0.0;
                assert_eq!(unsafe { sim_get_state(sim, &mut t, y.as_mut_ptr(), y.len()) }, 0);
                (t, y)
            }
        }
    };
}

precision!(
    double,
    f64,
    api64,
    nekton_scene_def_init = scene_def_init,
    nekton_wall_def_init = wall_def_init,
    nekton_body_def_init = body_def_init,
    nekton_link_def_init = link_def_init,
    nekton_method_init = method_init,
    nekton_model_req = model_req,
    nekton_model_init = model_init,
    nekton_model_create = model_create,
    nekton_model_free = model_free,
    nekton_model_plan = model_plan,
    nekton_model_link = model_link,
    nekton_model_outline_error = model_outline_error,
    nekton_model_joint = model_joint,
    nekton_model_notice = model_notice,
    nekton_model_nodes = model_nodes,
    nekton_model_outline_point = model_outline_point,
    nekton_sim_req = sim_req,
    nekton_sim_init = sim_init,
    nekton_sim_create = sim_create,
    nekton_sim_free = sim_free,
    nekton_sim_copy = sim_copy,
    nekton_sim_save_req = sim_save_req,
    nekton_sim_save = sim_save,
    nekton_sim_load = sim_load,
    nekton_sim_model = sim_model,
    nekton_sim_time = sim_time,
    nekton_sim_positions = sim_positions,
    nekton_sim_velocities = sim_velocities,
    nekton_sim_get_state = sim_get_state,
    nekton_sim_set_state = sim_set_state,
    nekton_sim_restart = sim_restart,
    nekton_sim_step = sim_step,
    nekton_sim_advance = sim_advance,
    nekton_sim_advance_dense = sim_advance_dense,
    nekton_sim_set_step_limit = sim_set_step_limit,
    nekton_sim_set_channel = sim_set_channel,
    nekton_sim_rhs = sim_rhs,
    nekton_sim_joint_values = sim_joint_values,
    nekton_sim_joint_torques = sim_joint_torques,
    nekton_sim_accelerations = sim_accelerations,
    nekton_sim_mass_matrix = sim_mass_matrix,
    nekton_sim_added_mass = sim_added_mass,
    nekton_sim_christoffel = sim_christoffel,
    nekton_sim_christoffel_tensor = sim_christoffel_tensor,
    nekton_sim_buoyancy = sim_buoyancy,
    nekton_sim_repulsion = sim_repulsion,
    nekton_sim_circulation_gradient = sim_circulation_gradient,
    nekton_sim_gyroscopic = sim_gyroscopic,
    nekton_sim_derivatives_req = sim_derivatives_req,
    nekton_sim_linearize = sim_linearize,
    nekton_sim_force_derivatives = sim_force_derivatives,
    nekton_sim_energy = sim_energy,
    nekton_sim_energy_drift = sim_energy_drift,
    nekton_sim_impulse = sim_impulse,
    nekton_sim_indicators = sim_indicators,
    nekton_sim_resolution = sim_resolution,
    nekton_sim_time_error = sim_time_error,
    nekton_sim_gap = sim_gap,
    nekton_sim_counters = sim_counters
);

precision!(
    single,
    f32,
    api32,
    nekton32_scene_def_init = scene_def_init,
    nekton32_wall_def_init = wall_def_init,
    nekton32_body_def_init = body_def_init,
    nekton32_link_def_init = link_def_init,
    nekton32_method_init = method_init,
    nekton32_model_req = model_req,
    nekton32_model_init = model_init,
    nekton32_model_create = model_create,
    nekton32_model_free = model_free,
    nekton32_model_plan = model_plan,
    nekton32_model_link = model_link,
    nekton32_model_outline_error = model_outline_error,
    nekton32_model_joint = model_joint,
    nekton32_model_notice = model_notice,
    nekton32_model_nodes = model_nodes,
    nekton32_model_outline_point = model_outline_point,
    nekton32_sim_req = sim_req,
    nekton32_sim_init = sim_init,
    nekton32_sim_create = sim_create,
    nekton32_sim_free = sim_free,
    nekton32_sim_copy = sim_copy,
    nekton32_sim_save_req = sim_save_req,
    nekton32_sim_save = sim_save,
    nekton32_sim_load = sim_load,
    nekton32_sim_model = sim_model,
    nekton32_sim_time = sim_time,
    nekton32_sim_positions = sim_positions,
    nekton32_sim_velocities = sim_velocities,
    nekton32_sim_get_state = sim_get_state,
    nekton32_sim_set_state = sim_set_state,
    nekton32_sim_restart = sim_restart,
    nekton32_sim_step = sim_step,
    nekton32_sim_advance = sim_advance,
    nekton32_sim_advance_dense = sim_advance_dense,
    nekton32_sim_set_step_limit = sim_set_step_limit,
    nekton32_sim_set_channel = sim_set_channel,
    nekton32_sim_rhs = sim_rhs,
    nekton32_sim_joint_values = sim_joint_values,
    nekton32_sim_joint_torques = sim_joint_torques,
    nekton32_sim_accelerations = sim_accelerations,
    nekton32_sim_mass_matrix = sim_mass_matrix,
    nekton32_sim_added_mass = sim_added_mass,
    nekton32_sim_christoffel = sim_christoffel,
    nekton32_sim_christoffel_tensor = sim_christoffel_tensor,
    nekton32_sim_buoyancy = sim_buoyancy,
    nekton32_sim_repulsion = sim_repulsion,
    nekton32_sim_circulation_gradient = sim_circulation_gradient,
    nekton32_sim_gyroscopic = sim_gyroscopic,
    nekton32_sim_derivatives_req = sim_derivatives_req,
    nekton32_sim_linearize = sim_linearize,
    nekton32_sim_force_derivatives = sim_force_derivatives,
    nekton32_sim_energy = sim_energy,
    nekton32_sim_energy_drift = sim_energy_drift,
    nekton32_sim_impulse = sim_impulse,
    nekton32_sim_indicators = sim_indicators,
    nekton32_sim_resolution = sim_resolution,
    nekton32_sim_time_error = sim_time_error,
    nekton32_sim_gap = sim_gap,
    nekton32_sim_counters = sim_counters
);

/// What C sees through a pointer while a test changes it.
pub struct Shared<T>(*mut T);

impl<T> Shared<T> {
    fn new(value: &mut T) -> Self {
        Shared(value)
    }
    pub fn get(&self) -> *const T {
        self.0
    }
}

impl<T> std::ops::Deref for Shared<T> {
    type Target = T;
    fn deref(&self) -> &T {
        unsafe { &*self.0 }
    }
}

impl<T> std::ops::DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut T {
        unsafe { &mut *self.0 }
    }
}

pub type Def = Shared<SceneDef<f64>>;
pub type Bodies = Shared<[BodyDef<f64>; 2]>;
pub type Links = Shared<[LinkDef<f64>; 3]>;

/// Calls `check` with a definition of two ellipses, one with a hinged tail, that it may spoil.
pub fn with_scene(check: impl FnOnce(&mut Def, &mut Bodies, &mut Links)) {
    let mut links = [double::ellipse(0.5, 0.2), double::ellipse(0.5, 0.2), double::ellipse(0.4, 0.3)];
    let mut bodies = [double::body(), double::body()];
    let mut def = double::scene();
    let (mut def, mut bodies, mut links) = (Shared::new(&mut def), Shared::new(&mut bodies), Shared::new(&mut links));
    (links[1].parent, links[1].parent_anchor, links[1].self_anchor) = (0, [-0.7, 0.0], [0.7, 0.0]);
    links[1].drive = NEKTON_DRIVE_TORQUE;
    bodies[1].pose = [3.0, 0.0, 0.5];
    let first = links.get().cast::<LinkDef<f64>>();
    (bodies[0].links, bodies[0].link_count) = (first, 2);
    (bodies[1].links, bodies[1].link_count) = (first.wrapping_add(2), 1);
    def.gravity = 9.81;
    (def.bodies, def.body_count) = (bodies.get().cast(), 2);
    check(&mut def, &mut bodies, &mut links);
}
