//! The target for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    nekton_fuzz::run(bytes);
});
