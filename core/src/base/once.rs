//! Functions with loops for the machine's own vectors, compiled once for each scalar type, here, and not again in every crate
//! that uses the library.

/// Declares generic functions `fn name['a, 'b: 'a](argument: Type<'a, 'b, R>, …) -> Output { … }` (any lifetimes; `R` is the
/// scalar, of which the output knows nothing) whose bodies are compiled in this crate, once for each scalar.
macro_rules! once {
    ($(
        $(#[$doc:meta])*
        $vis:vis fn $name:ident[$($life:lifetime $(: $longer:lifetime)?),*]($($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)? $body:block
    )*) => { $(
        $(#[$doc])*
        #[inline]
        $vis fn $name<$($life $(: $longer)?,)* R: Real>($($arg: $type),*) $(-> $out)? {
            use $crate::base::scalar::{Of, Which};
            struct Arguments<$($life),*>($(core::marker::PhantomData<&$life ()>),*);
            impl<$($life $(: $longer)?),*> Of for Arguments<$($life),*> {
                type With<R: Real> = ($($type,)*);
            }
            #[inline(always)]
            fn body<$($life $(: $longer)?,)* R: Real>(($($arg,)*): ($($type,)*)) $(-> $out)? $body
            #[inline(never)]
            fn double<$($life $(: $longer)?),*>(all: <Arguments<$($life),*> as Of>::With<f64>) $(-> $out)? {
                body::<f64>(all)
            }
            #[inline(never)]
            fn single<$($life $(: $longer)?),*>(all: <Arguments<$($life),*> as Of>::With<f32>) $(-> $out)? {
                body::<f32>(all)
            }
            match R::which::<Arguments<$($life),*>>(($($arg,)*)) {
                Which::Double(all) => double(all),
                Which::Single(all) => single(all),
            }
        }
    )* };
}
pub(crate) use once;
