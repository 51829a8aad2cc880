//! `cargo xtask dist --prefix P`: headers, both libraries, pkg-config file and CMake package in an installed tree that can be
//! moved as a whole.

use crate::steps::{cargo, root};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The functions of the interface, one per line.
pub const SYMBOLS: &str = "include/nekton.symbols";
const VERSION: &str = env!("CARGO_PKG_VERSION");

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

/// Runs a command and gives what it prints; the error names the command and what it says.
pub fn ask(command: &mut Command) -> Result<String, String> {
    let line = format!("{command:?}");
    let output = command.output().map_err(|error| format!("{line}: {error}"))?;
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if output.status.success() { Ok(out.into_owned()) } else { Err(format!("{line}: {}\n{out}{err}", output.status)) }
}

pub fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
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
    for folder in [&include, &pkg_config, &cmake] {
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    for header in ["nekton.h", "nekton.hpp"] {
        copy(&root().join("include").join(header), &include.join(header))?;
    }
    let soname = soname()?;
    copy(&target.join("release/libnekton_ffi.so"), &lib.join(&soname))?;
    let link = lib.join("libnekton.so");
    let _ = std::fs::remove_file(&link);
    #[cfg(unix)]
    std::os::unix::fs::symlink(&soname, &link).map_err(|error| format!("{}: {error}", link.display()))?;
    archive(&target.join("release/libnekton_ffi.a"), &target.join("release/prelink"), &lib.join("libnekton.a"))?;

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

/// The static library as one object in which only the interface's functions are global, so that it can be linked next to
/// other libraries written in Rust. What no function needs is left out.
fn archive(whole: &Path, work: &Path, result: &Path) -> Result<(), String> {
    std::fs::create_dir_all(work).map_err(|error| format!("{}: {error}", work.display()))?;
    let (linked, object) = (work.join("whole.o"), work.join("nekton.o"));
    let symbols = root().join(SYMBOLS);
    // Groups are dissolved: of a group that another library has as well, the linker would drop one, whose names are hidden.
    let mut link = Command::new("ld");
    link.args(["-r", "--gc-sections", "--force-group-allocation", "-o"]).arg(&linked);
    for name in read(&symbols)?.lines() {
        link.args(["-u", name]);
    }
    ask(link.arg(whole))?;
    let mut hide = Command::new("objcopy");
    hide.arg("--keep-global-symbols").arg(&symbols).arg("--strip-unneeded");
    ask(hide.args(["--remove-section", ".llvmbc", "--remove-section", ".llvmcmd"]).arg(&linked).arg(&object))?;
    let _ = std::fs::remove_file(result);
    ask(Command::new("ar").arg("rcsD").arg(result).arg(&object)).map(drop)
}
