//! The shared library's name carries the version of the interface.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=src/shared.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("linux") {
        return;
    }
    let source = std::fs::read_to_string("src/shared.rs").expect("src/shared.rs is there");
    let version = source
        .lines()
        .find_map(|line| line.strip_prefix("pub const NEKTON_ABI_VERSION: u32 = ")?.strip_suffix(';'))
        .expect("src/shared.rs names the version");
    println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libnekton.so.{version}");
}
