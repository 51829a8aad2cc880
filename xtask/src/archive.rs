//! The archive for programs without an operating system: built, proven to be free of panics and of a heap, and linked
//! into one object of which only nekton's own symbols can be seen.

use crate::bare::Compiler;
use nekton_steps::{ask, cargo, read, root};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Symbols that a program links against, one per line.
pub const SYMBOLS: &str = "include/nekton.symbols";
/// What the compiler may take from the C library, or from the program.
const MEMORY_FUNCTIONS: [&str; 5] = ["memcpy", "memmove", "memset", "memcmp", "bcmp"];

/// Processor and compiler that an archive is for.
#[derive(Clone, Copy)]
pub struct Machine {
    /// Folder under `target/`.
    pub folder: &'static str,
    /// Target triple and processor; `None`: this computer.
    pub target: Option<(&'static str, &'static str)>,
    /// What the names of the binary utilities begin with.
    pub tools: &'static str,
    /// Their name of its object files.
    pub format: &'static str,
    /// Features that the archive has beyond the least.
    pub features: &'static str,
}

/// This computer, without its operating system; with every feature, so that the proofs are about all code.
pub const HERE: Machine =
    Machine { folder: "freestanding", target: None, tools: "", format: FORMAT, features: "near,implicit,derivatives" };
const FORMAT: &str = if cfg!(target_arch = "aarch64") { "elf64-littleaarch64" } else { "elf64-x86-64" };

impl Machine {
    pub fn tool(&self, name: &str) -> Command {
        Command::new(format!("{}{name}", self.tools))
    }

    /// A folder for what is made for this machine.
    pub fn place(&self) -> PathBuf {
        root().join("target").join(self.folder)
    }
}

/// Builds the archive without std, without heap and without a panic handler of its own.
pub fn build(machine: &Machine, compiler: &Compiler) -> Result<PathBuf, String> {
    build_package("nekton-ffi", machine, compiler)
}

/// An archive of one of the packages that can do without std.
pub fn build_package(package: &str, machine: &Machine, compiler: &Compiler) -> Result<PathBuf, String> {
    let mut command = cargo(&["rustc", "--quiet", "--package", package, "--lib", "--crate-type", "staticlib"]);
    command.args(["--no-default-features", "--profile", "embedded", "--target-dir"]).arg(machine.place());
    let mut folder = machine.place();
    if !machine.features.is_empty() {
        command.args(["--features", machine.features]);
    }
    if let Some((target, processor)) = machine.target {
        command.args(["--target", target]).env("RUSTFLAGS", format!("-Ctarget-cpu={processor}"));
        folder.push(target);
    }
    ask(compiler.used_by(&mut command))?;
    Ok(folder.join(format!("embedded/lib{}.a", package.replace('-', "_"))))
}

/// Symbols of an object or archive of which `nm` says one of these letters.
fn symbols(machine: &Machine, file: &Path, letters: &str) -> Result<BTreeSet<String>, String> {
    // With the format said, no plug-in tries its own reading.
    let listing = ask(machine.tool("nm").arg(format!("--target={}", machine.format)).arg(file))?;
    let symbol = |line: &str| {
        let mut words = line.split_whitespace().rev();
        let (name, letter) = (words.next()?, words.next()?);
        (letter.len() == 1 && letters.contains(letter)).then(|| name.to_string())
    };
    Ok(listing.lines().filter_map(symbol).collect())
}

/// The symbols that the archive offers.
fn offered(machine: &Machine, archive: &Path) -> Result<BTreeSet<String>, String> {
    let mut names = symbols(machine, archive, "T")?;
    names.retain(|name| name.starts_with("nekton"));
    Ok(names)
}

/// The committed list.
fn promised() -> Result<BTreeSet<String>, String> {
    let text = read(&root().join(SYMBOLS))?;
    Ok(text.lines().map(str::to_string).collect())
}

/// An archive linked into one object with everything it uses and nothing else, only nekton's own symbols global: it can be
/// linked next to other Rust libraries, and without the option that drops unused functions.
pub struct Prelinked {
    /// The new archive.
    pub archive: PathBuf,
    /// Every symbol that the object needs from elsewhere.
    pub needs: BTreeSet<String>,
    /// Every name in the object before the private ones were dropped.
    pub names: BTreeSet<String>,
}

/// Prelinks an archive into `libnekton.a` in the machine's folder.
pub fn prelink(machine: &Machine, archive: &Path) -> Result<Prelinked, String> {
    let place = machine.place();
    std::fs::create_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
    let (whole, object, result) = (place.join("whole.o"), place.join("nekton.o"), place.join("libnekton.a"));
    // Groups of sections are dissolved: of a group that another library has as well, a linker would drop ours or theirs, and
    // ours has hidden names.
    let mut link = machine.tool("ld");
    link.args(["-r", "--gc-sections", "--force-group-allocation", "-o"]).arg(&whole);
    for name in promised()? {
        link.args(["-u", &name]);
    }
    ask(link.arg(archive))?;
    let mut hide = machine.tool("objcopy");
    hide.arg("--keep-global-symbols").arg(root().join(SYMBOLS)).arg("--strip-unneeded");
    for section in [".llvmbc", ".llvmcmd", ".comment"] {
        hide.args(["--remove-section", section]);
    }
    ask(hide.arg(&whole).arg(&object))?;
    let _ = std::fs::remove_file(&result);
    ask(machine.tool("ar").arg("rcsD").arg(&result).arg(&object))?;
    let seen = symbols(machine, &object, "TDBRVWC")?;
    if seen != promised()? {
        return Err(format!("the prelinked archive shows other symbols than {SYMBOLS}: {seen:?}"));
    }
    Ok(Prelinked {
        archive: result,
        needs: symbols(machine, &object, "U")?,
        names: symbols(machine, &whole, "TtDdRrBbVWU")?,
    })
}

/// Builds, prelinks and proves: the promised symbols and no others; nothing needed beyond memory functions; nothing in it
/// that panics or allocates.
///
/// The panic handler calls `nekton_panicked`, which nothing defines, and there is no allocator: a path from any exported function
/// to either would be a missing symbol, and the functions on the way would be there by name.
pub fn proven(machine: &Machine, compiler: &Compiler) -> Result<Prelinked, String> {
    let archive = build(machine, compiler)?;
    let (offered, promised) = (offered(machine, &archive)?, promised()?);
    if offered != promised {
        let differences: Vec<_> = offered.symmetric_difference(&promised).collect();
        return Err(format!("{SYMBOLS} is out of date (cargo xtask symbols): {differences:?}"));
    }
    let prelinked = prelink(machine, &archive)?;
    let missing: Vec<_> = prelinked.needs.iter().filter(|n| !MEMORY_FUNCTIONS.contains(&n.as_str())).collect();
    if !missing.is_empty() {
        return Err(format!("exported functions reach what is not there: {missing:?}"));
    }
    let forbidden =
        ["panick", "rust_begin_unwind", "unwrap_failed", "expect_failed", "__rust_alloc", "__rdl_", "__rg_"];
    // Without names the search for names would prove nothing.
    if !prelinked.names.iter().any(|n| n.contains("nekton") && !promised.contains(n)) {
        return Err("the archive has no names of private functions".into());
    }
    let found: Vec<_> = prelinked.names.iter().filter(|n| forbidden.iter().any(|f| n.contains(f))).collect();
    if !found.is_empty() {
        return Err(format!("exported functions reach panics or an allocator: {found:?}"));
    }
    let needs: Vec<_> = prelinked.needs.iter().map(String::as_str).collect();
    println!("{} exported functions; needs {}; no panic, no allocator", promised.len(), needs.join(" "));
    Ok(prelinked)
}

/// `cargo xtask symbols`: writes the list.
pub fn write_symbols() -> ExitCode {
    let written = build(&HERE, &Compiler::usual()).and_then(|archive| {
        let lines: String = offered(&HERE, &archive)?.into_iter().map(|name| name + "\n").collect();
        std::fs::write(root().join(SYMBOLS), lines).map_err(|error| format!("{SYMBOLS}: {error}"))
    });
    finish(written, SYMBOLS)
}

/// `cargo xtask prelink`.
pub fn write_prelinked() -> ExitCode {
    let made = proven(&HERE, &Compiler::usual());
    finish(made.map(|_| ()), "target/freestanding/libnekton.a")
}

/// Prints what was made, or why not.
pub fn finish(made: Result<(), String>, what: &str) -> ExitCode {
    match made {
        Ok(()) => {
            println!("{what}: written");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}
