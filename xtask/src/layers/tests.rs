use super::imports::{Sources, read};
use super::list::{LAYERS, layer_of};
use super::{circles, lists_layers, upward};

/// Reads made-up files.
fn crate_of(files: &[(&str, &str)]) -> Sources {
    read(&|path| files.iter().find(|(name, _)| *name == path).map(|(_, text)| text.to_string())).unwrap()
}

/// Imports as "from:line to", those that are only passed on in brackets.
fn imports(sources: &Sources) -> Vec<String> {
    let name = |i: usize| sources.files[i].trim_end_matches(".rs");
    let mut all: Vec<String> = sources
        .imports
        .iter()
        .map(|i| match i.passed_on {
            false => format!("{}:{} {}", name(i.from), i.line, name(i.to)),
            true => format!("[{}:{} {}]", name(i.from), i.line, name(i.to)),
        })
        .collect();
    all.sort();
    all.dedup();
    all
}

const LIB: (&str, &str) =
    ("lib.rs", "pub mod base; pub mod linear; mod integrate; mod scene; pub mod fluid;\npub use base::scalar::Real;");
const BASE: (&str, &str) = ("base/mod.rs", "pub mod scalar; pub mod status;");
const SCALAR: (&str, &str) = ("base/scalar.rs", "pub trait Real {} pub struct Bits; pub fn dot() {}");

/// A small core with the given text as linear/mod.rs.
fn with(linear: &str) -> Sources {
    crate_of(&[
        LIB,
        BASE,
        SCALAR,
        ("base/status.rs", "pub enum Status { Ok }"),
        ("linear/mod.rs", linear),
        ("linear/lu.rs", "pub struct Lu; pub fn solve() {}"),
        ("integrate.rs", "pub struct Rk4;"),
        ("scene.rs", "pub struct Scene;"),
        ("fluid/mod.rs", "mod pairs; pub(crate) use pairs::near;"),
        ("fluid/pairs.rs", "pub fn near() {}"),
    ])
}

/// What linear/mod.rs imports.
fn of_linear(text: &str) -> Vec<String> {
    let mut all = imports(&with(text));
    all.retain(|line| line.trim_start_matches('[').starts_with("linear/mod"));
    all
}

#[test]
fn an_import_upward_is_found_with_its_line() {
    let faults = upward(&with("\nuse crate::base::scalar::dot;\nuse crate::fluid::near;"));
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(
        faults[0].starts_with("core/src/linear/mod.rs:3: linear uses crate::fluid::near of core/src/fluid/pairs.rs")
    );
    // So are one to the same level and one to lib.rs, and a file that belongs nowhere.
    assert_eq!(upward(&with("use crate::integrate::Rk4;")).len(), 1);
    let stray =
        [("lib.rs", "mod stray; mod base; pub const N: usize = 1;"), ("stray.rs", ""), ("base.rs", "use crate::N;")];
    let faults = upward(&crate_of(&stray));
    assert!(faults.len() == 2 && faults[0].contains("core/src/stray.rs belongs to no layer"), "{faults:?}");
    assert!(faults[1].contains("base uses crate::N of core/src/lib.rs"), "{faults:?}");
    assert!(upward(&with("use crate::base::status::Status;")).is_empty());
}

#[test]
fn names_are_followed_through_re_exports_to_the_file_that_defines_them() {
    assert_eq!(of_linear("use crate::Real;"), ["linear/mod:1 base/scalar"]);
    assert_eq!(of_linear("fn f() { crate::fluid::near() }"), ["linear/mod:1 fluid/pairs"]);
    assert_eq!(of_linear("use crate::fluid;\nfn f() { fluid::near() }"), ["linear/mod:2 fluid/pairs"]);
    assert_eq!(of_linear("mod lu;\npub use lu::Lu;"), ["[linear/mod:2 linear/lu]"]);
    // Used as well as passed on.
    assert_eq!(
        of_linear("mod lu;\npub use lu::Lu;\nstruct S(Lu);"),
        ["[linear/mod:2 linear/lu]", "linear/mod:3 linear/lu"]
    );
    // What macros make is not seen: it is taken as the module's own.
    assert_eq!(of_linear("use crate::base::scalar::Made;"), ["linear/mod:1 base/scalar"]);
}

#[test]
fn nested_groups_renamed_names_and_globs_are_read() {
    let text =
        "use crate::{base::{scalar::{self, Real as R, dot}, status::Status}, scene::*};\nfn f() { scalar::dot() }";
    assert_eq!(
        of_linear(text),
        ["linear/mod:1 base/scalar", "linear/mod:1 base/status", "linear/mod:1 scene", "linear/mod:2 base/scalar"]
    );
    assert_eq!(of_linear("fn f() {\n use crate::{scene::Scene as S, base::scalar::{dot}}; }").len(), 2);
}

#[test]
fn names_in_comments_strings_and_tests_do_not_count() {
    let text = r##"
        //! [`crate::fluid::near`]
        // crate::fluid::near
        /* use crate::fluid::near; */
        const S: &str = "crate::fluid::near"; const T: &str = r#"use crate::fluid::near;"#;
        #[cfg(test)] mod tests { use crate::fluid::near; }
        #[cfg(all(test, feature = "alloc"))] use crate::fluid::near;
        #[cfg(test)] #[path = "elsewhere_test.rs"] mod other;
        struct A; impl A { #[cfg(test)] fn f() { crate::fluid::near() } }
        #[test] fn t() { crate::fluid::near() }
    "##;
    assert!(of_linear(text).is_empty());
    // What may also be compiled otherwise counts.
    assert_eq!(of_linear("#[cfg(any(test, feature = \"a\"))] use crate::fluid::near;").len(), 1);
    assert_eq!(of_linear("#[cfg(not(test))] use crate::fluid::near;").len(), 1);
}

#[test]
fn bodies_and_arguments_of_macros_are_read() {
    assert_eq!(of_linear("macro_rules! m { () => {\n $crate::fluid::near() } }"), ["linear/mod:2 fluid/pairs"]);
    assert_eq!(of_linear("fn f() { assert!(x == crate::fluid::near()) }"), ["linear/mod:1 fluid/pairs"]);
    assert_eq!(of_linear("made! { use crate::{fluid::{near}}; }"), ["linear/mod:1 fluid/pairs"]);
    let files = [
        ("lib.rs", "#[macro_use] mod base; mod linear;"),
        ("base.rs", "macro_rules! buffers { () => {} }"),
        ("linear.rs", "\nbuffers!();"),
    ];
    assert_eq!(imports(&crate_of(&files)), ["linear:2 base"]);
}

#[test]
fn super_climbs_as_often_as_it_is_written() {
    let deep = |text: &'static str| {
        crate_of(&[
            ("lib.rs", "mod base; mod fluid;"),
            ("base.rs", "pub fn dot() {}"),
            ("fluid/mod.rs", "mod near; pub fn pair() {}"),
            ("fluid/near/mod.rs", "mod pole; pub struct Near;"),
            ("fluid/near/pole.rs", text),
        ])
    };
    assert_eq!(imports(&deep("use super::super::super::base::dot;")), ["fluid/near/pole:1 base"]);
    assert_eq!(imports(&deep("fn f() { super::super::pair() }")), ["fluid/near/pole:1 fluid/mod"]);
    assert_eq!(
        imports(&deep("use super::Near; mod inner { use super::super::Near; }")),
        ["fluid/near/pole:1 fluid/near/mod"]
    );
}

#[test]
fn fields_methods_and_other_crates_are_no_imports() {
    let text = "use nalgebra::Complex; fn f(x: A) { x.fluid.near(); ::fluid::near(); <A as T>::fluid::near(); core::mem::swap() }";
    assert!(of_linear(text).is_empty(), "{:?}", of_linear(text));
}

#[test]
fn circles_are_found_and_small_ones_inside_a_folder_are_let_pass_where_they_may() {
    let two = crate_of(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "\nuse crate::b::B; pub struct A;"),
        ("b.rs", "use crate::a::A; pub struct B;"),
    ]);
    let faults = circles::faults("ffi/src", &two, 1);
    assert!(faults.len() == 1 && faults[0].contains("ffi/src/a.rs:2 uses crate::b::B"), "{faults:?}");
    assert!(circles::faults("core/src", &two, 3).is_empty());
    // A file of a folder and one beside it.
    let apart = [
        ("lib.rs", "mod a; mod b;"),
        ("a/mod.rs", "use crate::b::B; pub struct A;"),
        ("b.rs", "use crate::a::A; pub struct B;"),
    ];
    assert_eq!(circles::faults("core/src", &crate_of(&apart), 3).len(), 1);
    // A ring of four, though no two of them use each other.
    let ring = |face: &'static str| {
        crate_of(&[
            ("lib.rs", "mod f;"),
            ("f/mod.rs", face),
            ("f/a.rs", "use super::b::B; pub struct A;"),
            ("f/b.rs", "use super::c::C; pub struct B;"),
            ("f/c.rs", "use super::F; pub struct C;"),
        ])
    };
    let faults = circles::faults("core/src", &ring("mod a; mod b; mod c; use a::A; pub struct F(A);"), 3);
    assert!(faults.len() == 1 && faults[0].contains("4 files use each other"), "{faults:?}");
    // A face that only declares and passes on closes no circle.
    assert!(circles::faults("core/src", &ring("mod a; mod b; mod c; pub use a::A; pub struct F;"), 1).is_empty());
}

#[test]
fn pages_show_the_layers_in_their_order_within_one_block() {
    let names: Vec<String> = LAYERS.iter().map(|layer| format!("`{}`", layer.name)).collect();
    let mut page = format!("# Map\n\n{}\n\nEnd.", names.join(" → "));
    assert!(lists_layers(&page));
    assert!(!lists_layers(&page.replace("`fluid`", "`model`")));
    page = page.replace("`scene` →", "`scene`\n\n");
    assert!(!lists_layers(&page));
    assert_eq!(layer_of("dynamics/forces/buoyancy.rs"), layer_of("dynamics/mod.rs"));
    assert_eq!((layer_of("scene.rs"), layer_of("work.rs")), (Some(2), None));
}
