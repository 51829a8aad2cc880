//! What the functions with init in their names fill the definitions with, and the sizes that the definitions have had.

use crate::shared::NEKTON_ABI_VERSION;
use crate::sized::Definition;
use crate::types::*;
use nekton::Real;

fn no_shape<R: Real>() -> ShapeDef<R> {
    let zero = R::zero();
    ShapeDef {
        kind: NEKTON_SHAPE_NONE,
        lobes: 0,
        a: zero,
        b: zero,
        radius: zero,
        amplitude: zero,
        width: zero,
        height: zero,
        corner_radius: zero,
        points: core::ptr::null(),
        point_count: 0,
    }
}

fn no_signal<R: Real>() -> SignalDef<R> {
    let zero = R::zero();
    SignalDef {
        kind: NEKTON_SIGNAL_CONSTANT,
        value: zero,
        harmonics: core::ptr::null(),
        harmonic_count: 0,
        window: WindowDef { from: zero, to: zero, ramp: zero },
        rows: core::ptr::null(),
        row_count: 0,
    }
}

/// The name in the precision of `R`.
const fn named<R>(double: &'static str, single: &'static str) -> &'static str {
    if size_of::<R>() == 8 { double } else { single }
}

impl<R: Real> Definition for SceneDef<R> {
    const SIZES: &'static [usize] = &[core::mem::offset_of!(Self, allow_unresolved), size_of::<Self>()];
    const ADVICE: &'static str = named::<R>("call nekton_scene_def_init", "call nekton32_scene_def_init");
    fn filled(struct_size: u32) -> Self {
        SceneDef {
            struct_size,
            abi_version: NEKTON_ABI_VERSION,
            fluid_density: R::one(),
            gravity: R::zero(),
            repulsion_epsilon: R::zero(),
            repulsion_alpha: R::lit(4.0),
            circulation: NEKTON_CIRCULATION_FULL,
            force: NEKTON_FORCE_EXACT_GRADIENT,
            quadrature: NEKTON_QUADRATURE_GRADED,
            tolerance: R::zero(),
            allow_unresolved: 0,
            reserved: 0,
            shortcuts: 1,
            tank: core::ptr::null(),
            obstacles: core::ptr::null(),
            obstacle_count: 0,
            bodies: core::ptr::null(),
            body_count: 0,
        }
    }
}

impl<R: Real> Definition for WallDef<R> {
    /// At first without `corners` and what follows it.
    const SIZES: &'static [usize] = &[core::mem::offset_of!(Self, corners), size_of::<Self>()];
    const ADVICE: &'static str = named::<R>("call nekton_wall_def_init", "call nekton32_wall_def_init");
    fn filled(struct_size: u32) -> Self {
        let zero = R::zero();
        WallDef {
            struct_size,
            shape: no_shape(),
            position: [zero; 2],
            nodes: 0,
            angle: zero,
            circulation: zero,
            corners: NEKTON_CORNERS_AUTO,
            corners_reserved: 0,
            corner_points: core::ptr::null(),
            corner_count: 0,
        }
    }
}

impl<R: Real> Definition for LinkDef<R> {
    /// At first without `corners` and what follows it.
    const SIZES: &'static [usize] = &[core::mem::offset_of!(Self, corners), size_of::<Self>()];
    const ADVICE: &'static str = named::<R>("call nekton_link_def_init", "call nekton32_link_def_init");
    fn filled(struct_size: u32) -> Self {
        let zero = R::zero();
        LinkDef {
            struct_size,
            shape: no_shape(),
            nodes: 0,
            circulation: zero,
            mass_kind: NEKTON_MASS_DENSITY,
            parent: -1,
            density: R::one(),
            mass: zero,
            inertia: zero,
            centre_of_mass: [zero; 2],
            joint: NEKTON_JOINT_HINGE,
            drive: NEKTON_DRIVE_LOCKED,
            parent_anchor: [zero; 2],
            self_anchor: [zero; 2],
            axis: [R::one(), zero],
            angle: zero,
            locked_value: zero,
            rest: zero,
            signal: no_signal(),
            stiffness: zero,
            damping: zero,
            start: [zero; 2],
            corners: NEKTON_CORNERS_AUTO,
            corners_reserved: 0,
            corner_points: core::ptr::null(),
            corner_count: 0,
        }
    }
}

impl<R: Real> Definition for BodyDef<R> {
    const SIZES: &'static [usize] = &[size_of::<Self>()];
    const ADVICE: &'static str = named::<R>("call nekton_body_def_init", "call nekton32_body_def_init");
    fn filled(struct_size: u32) -> Self {
        BodyDef {
            struct_size,
            root: NEKTON_ROOT_FREE,
            pose: [R::zero(); 3],
            velocity: [R::zero(); 3],
            motion: [no_signal(); 3],
            links: core::ptr::null(),
            link_count: 0,
        }
    }
}

impl<R: Real> Definition for MethodDef<R> {
    /// At first without `max_step` and what follows it.
    const SIZES: &'static [usize] = &[core::mem::offset_of!(Self, max_step), size_of::<Self>()];
    const ADVICE: &'static str = named::<R>("call nekton_method_init", "call nekton32_method_init");
    fn filled(struct_size: u32) -> Self {
        let tolerance = R::lit(if size_of::<R>() == 8 { 1e-9 } else { 1e-4 });
        MethodDef {
            struct_size,
            kind: NEKTON_METHOD_ADAMS,
            step: R::zero(),
            relative: tolerance,
            absolute: tolerance,
            max_step: R::zero(),
            first_step: R::zero(),
        }
    }
}

/// A definition that ended in padding could not grow: what an older caller left there would be taken for the new field. After a
/// lone field that leaves some comes a reserved one of the same type, which must be 0. Items are the last fields.
macro_rules! closed {
    ($($definition:ident.$last:ident: $kind:ty),* $(,)?) => { $(
        closed!(@ f64, $definition, $last, $kind);
        closed!(@ f32, $definition, $last, $kind);
    )* };
    (@ $real:ident, $definition:ident, $last:ident, $kind:ty) => {
        const _: () = {
            #[allow(dead_code)]
            type R = $real;
            let end = core::mem::offset_of!($definition<R>, $last) + size_of::<$kind>();
            assert!(end == size_of::<$definition<R>>());
        };
    };
}

closed!(
    SceneDef.reserved: i32,
    WallDef.corner_count: usize,
    LinkDef.corner_count: usize,
    BodyDef.link_count: usize,
    MethodDef.first_step: R,
);
