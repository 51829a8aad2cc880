//! Which parts of a file are compiled under test on this machine, by their `cfg` attributes.

use syn::punctuated::Punctuated;
use syn::{Attribute, Meta, Token};

/// Features of core that its tests are built with.
const FEATURES: [&str; 5] = ["default", "std", "alloc", "implicit", "near"];

/// Whether what has these attributes is compiled, and is not itself a test.
pub fn compiled(attributes: &[Attribute]) -> bool {
    attributes.iter().all(|attribute| {
        if attribute.path().is_ident("test") {
            return false;
        }
        if !attribute.path().is_ident("cfg") {
            return true;
        }
        attribute.parse_args::<Meta>().is_ok_and(|meta| holds(&meta))
    })
}

/// `test` does not hold: tests are not changed.
fn holds(meta: &Meta) -> bool {
    match meta {
        Meta::Path(path) => path.is_ident("debug_assertions") || path.is_ident("unix"),
        Meta::NameValue(pair) => {
            let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(value), .. }) = &pair.value else { return false };
            let value = value.value();
            if pair.path.is_ident("feature") {
                FEATURES.contains(&value.as_str())
            } else if pair.path.is_ident("target_arch") {
                value == std::env::consts::ARCH
            } else {
                false
            }
        }
        Meta::List(list) => {
            let Ok(parts) = list.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated) else { return false };
            if list.path.is_ident("not") {
                parts.iter().all(|part| !holds(part))
            } else if list.path.is_ident("all") {
                parts.iter().all(holds)
            } else {
                parts.iter().any(holds)
            }
        }
    }
}
