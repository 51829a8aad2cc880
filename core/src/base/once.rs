//! What is compiled once for each scalar type, here, and not again in every crate that uses the library: everything with
//! loops for the machine's own vectors.
#![allow(private_interfaces)] // The trait is sealed by its only implementors.

use crate::base::status::Result;
use crate::dynamics::christoffel::PairScratch;
use crate::fluid::configuration::{Configuration, Poses};
use crate::fluid::near::preimage::{Source, Targets};
use crate::fluid::near::{NearMut, Preimage};
use crate::fluid::pair_pass::{PassResult, pair_pass};
use crate::fluid::potentials::BoundarySystem;
use crate::geometry::grading::Grading;
use crate::model::Model;

macro_rules! compiled {
    ($( fn $name:ident ($($arg:ident: $type:ty),*) $(-> $out:ty)? = $run:expr; )*) => {
        /// Calls of the generic functions of the same purpose.
        pub trait Compiled: Sized {
            $( #[doc(hidden)] fn $name($($arg: $type),*) $(-> $out)?; )*
        }
        compiled!(@for f64, $( fn $name ($($arg: $type),*) $(-> $out)? = $run; )*);
        compiled!(@for f32, $( fn $name ($($arg: $type),*) $(-> $out)? = $run; )*);
    };
    (@for $t:ty, $( fn $name:ident ($($arg:ident: $type:ty),*) $(-> $out:ty)? = $run:expr; )*) => {
        impl Compiled for $t {
            $( #[inline(never)] fn $name($($arg: $type),*) $(-> $out)? { $run } )*
        }
    };
}

compiled! {
    fn prepare(near: &mut NearMut<'_, Self>, model: &Model<'_, Self>, poses: Poses<'_, Self>) -> Result<()> =
        near.prepare_here(model, poses);
    fn each_preimage(source: &Source<'_, Self>, targets: &Targets<'_, Self>, visit: &mut dyn FnMut(usize, Preimage<Self>)) =
        source.each_preimage_here(targets, visit);
    fn walk(grading: &Grading<'_, Self>, n: usize, visit: &mut dyn FnMut([Self; 3])) -> Result<()> =
        grading.walk_here(n, visit);
    fn solve_system(
        system: &mut BoundarySystem<'_, Self>, c: &Configuration<'_, Self>, motions: &[Self], scratch: [&mut [Self]; 2]
    ) -> Result<()> = {
        let [zx, zy] = scratch;
        system.solve(c, motions, zx, zy)
    };
    fn momenta(
        system: &BoundarySystem<'_, Self>, c: &Configuration<'_, Self>, motions: &[Self], scratch: [&mut [Self]; 3], out: &mut [Self]
    ) = system.momenta(c, motions, scratch, out);
    fn pair_pass(
        c: &Configuration<'_, Self>, qd: &[Self], density: &[Self], adjoint: &[Self], s: &mut PairScratch<'_, Self>,
        out: PassResult<'_, Self>
    ) = pair_pass(c, qd, density, adjoint, s, out);
}
