//! `cargo xtask dist --prefix P`: headers, both libraries, pkg-config file and CMake package in an installed tree that can be
//! moved as a whole.

use crate::archive::{HERE, Machine, prelink};
use nekton_steps::{cargo, read, root};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// This computer, with its operating system.
const DESKTOP: Machine = Machine { folder: "desktop", ..HERE };
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// What programs include, and the parts of the C++ layer.
const HEADERS: [&str; 9] = [
    "nekton.h",
    "nekton32.h",
    "nekton.hpp",
    "nekton/api.hpp",
    "nekton/definitions.hpp",
    "nekton/error.hpp",
    "nekton/model.hpp",
    "nekton/sim.hpp",
    "nekton/span.hpp",
];

pub fn run(prefix: &str) -> ExitCode {
    match install(Path::new(prefix)) {
        Ok(()) => {
            println!("installed in {prefix}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    // A file in use, such as a library, is replaced, not overwritten.
    let _ = std::fs::remove_file(to);
    std::fs::copy(from, to).map(drop).map_err(|error| format!("{} to {}: {error}", from.display(), to.display()))
}

/// The name by which programs find the shared library: it changes with the version of the interface.
pub fn soname() -> Result<String, String> {
    let header = read(&root().join("include/nekton.h"))?;
    let version = header.lines().find_map(|line| line.strip_prefix("#define NEKTON_ABI_VERSION "));
    Ok(format!("libnekton.so.{}", version.ok_or("include/nekton.h tells no version")?))
}

/// Builds and installs.
pub fn install(prefix: &Path) -> Result<(), String> {
    if !cfg!(target_os = "linux") {
        return Err("so far for Linux only; elsewhere: cargo build --release --package nekton-ffi".into());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root().join("target"), PathBuf::from);
    let built = cargo(&["build", "--release", "--package", "nekton-ffi", "--target-dir"]).arg(&target).status();
    if !built.is_ok_and(|status| status.success()) {
        return Err("the library was not built".into());
    }
    let (include, lib) = (prefix.join("include"), prefix.join("lib"));
    let (pkg_config, cmake) = (lib.join("pkgconfig"), lib.join("cmake/nekton"));
    for folder in [&include.join("nekton"), &pkg_config, &cmake] {
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    for header in HEADERS {
        copy(&root().join("include").join(header), &include.join(header))?;
    }
    let soname = soname()?;
    copy(&target.join("release/libnekton_ffi.so"), &lib.join(&soname))?;
    let link = lib.join("libnekton.so");
    let _ = std::fs::remove_file(&link);
    #[cfg(unix)]
    std::os::unix::fs::symlink(&soname, &link).map_err(|error| format!("{}: {error}", link.display()))?;
    // With the standard library inside, but hidden, it can be linked next to other libraries written in Rust.
    let object = prelink(&DESKTOP, &target.join("release/libnekton_ffi.a"))?;
    copy(&object.archive, &lib.join("libnekton.a"))?;

    let major_minor = VERSION.rsplit_once('.').map_or(VERSION, |(rest, _)| rest);
    let files = [("nekton.pc", &pkg_config), ("nekton-config.cmake", &cmake), ("nekton-config-version.cmake", &cmake)];
    for (name, folder) in files {
        let text = read(&root().join(format!("packaging/{name}.in")))?
            .replace("@VERSION@", VERSION)
            .replace("@MAJOR_MINOR@", major_minor)
            .replace("@SONAME@", &soname);
        std::fs::write(folder.join(name), text).map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}
