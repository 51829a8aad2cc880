//! Examples, wrapper and installed package, as users of C and C++ meet them.

use crate::archive::SYMBOLS;
use crate::dist::{install, soname};
use nekton_steps::{Outcome, Steps, ask, read, require, root};
use nekton_tests::printed::{Lines, lines, numbers};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::OnceLock;

const WARNINGS: [&str; 6] = ["-O2", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];
/// Examples that must not use the heap.
const WITHOUT_HEAP: [&str; 2] = ["one_body_static", "swimmer_closed_loop"];

/// Where the steps install.
fn prefix() -> PathBuf {
    root().join("target/nekton")
}

/// Installs there, once in a run: whichever of the steps is run first does not meet what an earlier run left behind.
fn installed() -> Result<(), String> {
    static DONE: OnceLock<Result<(), String>> = OnceLock::new();
    let install = || {
        let _ = std::fs::remove_dir_all(prefix());
        install(&prefix())
    };
    DONE.get_or_init(install).clone()
}

/// A folder for what a step builds, empty.
fn fresh(name: &str) -> Result<PathBuf, String> {
    let folder = root().join("target/c").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    Ok(folder)
}

/// The steps alone.
pub fn run() -> ExitCode {
    let mut steps = Steps::default();
    add(&mut steps);
    steps.finish()
}

/// A step that needs the installed tree, and programs, given with their packages.
fn step(steps: &mut Steps, name: &str, programs: &[(&str, &str)], action: impl FnOnce() -> Result<(), String>) {
    steps.run(name, || match require(&[programs, &[CC, BINUTILS]].concat()) {
        Err(why) => Outcome::Skipped(why),
        Ok(()) => installed().and_then(|()| action()).into(),
    });
}

const CC: (&str, &str) = ("cc", "gcc");
const CXX: (&str, &str) = ("c++", "g++");
const BINUTILS: (&str, &str) = ("objcopy", "binutils");
const CMAKE: (&str, &str) = ("cmake", "cmake");

/// Adds the steps to a run.
pub fn add(steps: &mut Steps) {
    step(steps, "installed package", &[CC, BINUTILS], || Ok(()));
    step(steps, "exported symbols", &[BINUTILS], symbols);
    step(steps, "examples in C99 and C++17, static and shared", &[CC, CXX], examples);
    step(steps, "examples by the lines in their headers", &[CC, CXX], compiler_lines);
    step(steps, "examples by CMake", &[CC, CXX, CMAKE], || examples_by_cmake(&prefix()));
    step(steps, "examples under valgrind", &[CC, CXX, ("valgrind", "valgrind")], valgrind);
    step(steps, "C++ wrapper", &[CXX], || wrapper("c++"));
    // Not installed for its own sake: a second opinion where there is one.
    if ask(Command::new("clang++").arg("--version")).is_ok() {
        step(steps, "C++ wrapper by clang", &[], || wrapper("clang++"));
    }
    step(steps, "static library next to another one in Rust", &[CC], neighbours);
    step(steps, "program of the README by CMake", &[CC, CMAKE, ("make", "make")], consumer_by_cmake);
    step(steps, "program of the README by pkg-config", &[CC, ("pkg-config", "pkg-config")], consumer_by_pkg_config);
    step(steps, "commands of examples-c/README.md", &[CC], readme_of_examples);
}

/// Both libraries offer the functions that the headers declare, and nothing else.
fn symbols() -> Result<(), String> {
    let promised: BTreeSet<String> = read(&root().join(SYMBOLS))?.lines().map(str::to_string).collect();
    let headers = ["nekton.h", "nekton32.h"].map(|name| read(&prefix().join("include").join(name)));
    let [double, single] = headers;
    let header = double? + &single?;
    // A name at the left of a parenthesis, not in a comment.
    let declared: BTreeSet<String> = header
        .lines()
        .filter(|line| !line.trim_start().starts_with(['*', '/', '#']))
        .filter_map(|line| line.split_once('(')?.0.rsplit([' ', '*']).next())
        .filter(|name| name.starts_with("nekton"))
        .map(str::to_string)
        .collect();
    let offered = |arguments: &[&str], library: &str| -> Result<BTreeSet<String>, String> {
        let listing = ask(Command::new("nm").args(arguments).arg(prefix().join("lib").join(library)))?;
        Ok(listing.lines().filter_map(|line| Some(line.split_whitespace().nth(2)?.to_string())).collect())
    };
    let kinds = [
        ("nekton.h with nekton32.h", declared),
        ("libnekton.so", offered(&["-D", "--defined-only"], "libnekton.so")?),
        ("libnekton.a", offered(&["-g", "--defined-only"], "libnekton.a")?),
    ];
    for (name, offered) in kinds {
        let differing: Vec<_> = offered.symmetric_difference(&promised).collect();
        if !differing.is_empty() {
            return Err(format!("{name} and {SYMBOLS} differ in {differing:?}"));
        }
    }
    let dynamic = ask(Command::new("readelf").arg("-d").arg(prefix().join("lib/libnekton.so")))?;
    let soname = soname()?;
    if dynamic.contains(&format!("soname: [{soname}]")) {
        Ok(())
    } else {
        Err(format!("the shared library does not call itself {soname}"))
    }
}

/// Every example: its name and its source.
fn sources() -> Result<Vec<(String, PathBuf)>, String> {
    let folder = root().join("examples-c");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "c" || extension == "cpp"));
    files.sort();
    let name = |file: &Path| file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(files.into_iter().map(|file| (name(&file), file)).collect())
}

/// Runs an example and compares what it prints with the library's own numbers, bit for bit.
fn compare(name: &str, run: &mut Command) -> Result<(), String> {
    let expected = lines(name).ok_or(format!("{name}: nothing is expected of it"))?;
    let printed = ask(run)?;
    let printed = numbers(&printed);
    let bits = |line: &Vec<f64>| line.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for (i, (printed, expected)) in printed.iter().zip(&expected).enumerate() {
        if bits(printed) != bits(expected) {
            return Err(format!("{name}, line {}: printed {printed:?}, expected {expected:?}", i + 1));
        }
    }
    if printed.len() == expected.len() { Ok(()) } else { Err(format!("{name}: {} lines", printed.len())) }
}

/// Compiles a program against the installed tree.
fn compile(source: &Path, cxx: bool, shared: bool, out: &Path) -> Result<(), String> {
    let lib = prefix().join("lib");
    let mut compiler = Command::new(if cxx { "c++" } else { "cc" });
    // Contracted products and sums would change the last bits of what a program computes itself.
    compiler.args(WARNINGS).arg("-ffp-contract=off").args(if cxx {
        ["-std=c++17", "-xc++"]
    } else {
        ["-std=c99", "-xc"]
    });
    compiler.arg(source).args(["-xnone", "-I"]).arg(prefix().join("include"));
    if shared {
        compiler.arg("-L").arg(&lib).args(["-lnekton", &format!("-Wl,-rpath,{}", lib.display())]);
    } else {
        compiler.arg(lib.join("libnekton.a"));
    }
    ask(compiler.args(["-lm", "-lpthread", "-o"]).arg(out)).map(drop)
}

fn examples() -> Result<(), String> {
    let folder = fresh("examples")?;
    for (name, source) in sources()? {
        for cxx in [false, true] {
            if !cxx && source.extension().is_some_and(|extension| extension == "cpp") {
                continue;
            }
            for shared in [false, true] {
                let standard = if cxx { "c++17" } else { "c99" };
                let program = folder.join(format!("{name}-{standard}-{}", if shared { "shared" } else { "static" }));
                compile(&source, cxx, shared, &program)?;
                compare(&name, &mut Command::new(&program))?;
                println!("{}", program.display());
            }
        }
    }
    Ok(())
}

/// The line after "Compile:" in an example's header works as it stands.
fn compiler_lines() -> Result<(), String> {
    let folder = fresh("lines")?;
    for (name, source) in sources()? {
        let text = read(&source)?;
        let mut rest = text.lines().skip_while(|line| line.trim() != "* Compile:");
        let line = rest.nth(1).and_then(|line| line.trim().strip_prefix("* ")).ok_or(format!("{name}: no line"))?;
        let line = line.trim();
        let place = format!("-o {name}");
        let line = line.strip_suffix(&place).ok_or(format!("{name}: the line does not end in {place}"))?;
        let program = folder.join(&name);
        let line = format!("{line} -o '{}'", program.display());
        ask(Command::new("sh").args(["-c", &line]).current_dir(root().join("examples-c")))?;
        compare(&name, &mut Command::new(program))?;
    }
    Ok(())
}

fn configure(source: &Path, build: &Path, prefix: &Path) -> Result<(), String> {
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(source).arg("-B").arg(build).arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display()));
    ask(&mut cmake)?;
    ask(Command::new("cmake").arg("--build").arg(build)).map(drop)
}

fn examples_by_cmake(prefix: &Path) -> Result<(), String> {
    let build = fresh("examples-cmake")?;
    configure(&root().join("examples-c"), &build, prefix)?;
    for (name, _) in sources()? {
        for kind in ["static", "shared"] {
            compare(&name, &mut Command::new(build.join(format!("{name}_{kind}"))))?;
        }
    }
    Ok(())
}

/// No invalid access, no use of what was never written, nothing leaked; no call of the heap where none is allowed.
fn valgrind() -> Result<(), String> {
    let folder = fresh("valgrind")?;
    let sources = sources()?;
    for (name, source) in &sources {
        let cxx = source.extension().is_some_and(|extension| extension == "cpp");
        compile(source, cxx, false, &folder.join(name))?;
    }
    // Programs are slow there, so they run side by side.
    std::thread::scope(|scope| {
        let runs: Vec<_> = sources.iter().map(|(name, _)| scope.spawn(|| memory_checked(name, &folder))).collect();
        runs.into_iter().try_for_each(|run| run.join().map_err(|_| "a check ended early")?)
    })?;
    // No two threads touch the same memory without an order.
    let mut threads = Command::new("valgrind");
    threads.args(["--quiet", "--tool=helgrind", "--error-exitcode=9"]).arg(folder.join("parallel_rollouts"));
    ask(&mut threads).map(drop)
}

fn memory_checked(name: &str, folder: &Path) -> Result<(), String> {
    let log = folder.join(format!("{name}.log"));
    let mut run = Command::new("valgrind");
    run.args(["--error-exitcode=9", "--leak-check=full", "--show-leak-kinds=all", "--errors-for-leak-kinds=all"]);
    let ran = ask(run.arg(format!("--log-file={}", log.display())).arg(folder.join(name)));
    let log = read(&log)?;
    ran.map_err(|why| format!("{why}\n{log}"))?;
    let usage = log.lines().find_map(|line| line.split_once("total heap usage: ")).map_or("", |(_, usage)| usage);
    println!("{name}: {usage}");
    if WITHOUT_HEAP.contains(&name) && !usage.starts_with("0 allocs, 0 frees") {
        return Err(format!("{name} used the heap: {usage}"));
    }
    Ok(())
}

/// Every member function, with and without exceptions.
fn wrapper(compiler: &str) -> Result<(), String> {
    wrapped()?;
    let folder = fresh("wrapper")?;
    for mode in ["-fexceptions", "-fno-exceptions", "-DNEKTON_NO_EXCEPTIONS"] {
        let program = folder.join("wrapper");
        let mut command = Command::new(compiler);
        command.args(WARNINGS).args(["-std=c++17", "-Wshadow", mode, "-I"]).arg(prefix().join("include"));
        command.arg(root().join("tests/c/wrapper.cpp")).arg(prefix().join("lib/libnekton.a"));
        ask(command.args(["-lm", "-lpthread", "-o"]).arg(&program))?;
        ask(&mut Command::new(&program))?;
    }
    Ok(())
}

/// Every function of the interface but those without an object has its place in the wrapper.
fn wrapped() -> Result<(), String> {
    let wrapper = read(&root().join("include/nekton/api.hpp"))?;
    let symbols = read(&root().join(SYMBOLS))?;
    for name in symbols.lines().filter_map(|name| name.strip_prefix("nekton_")) {
        let free = ["abi_version", "capabilities", "status_text", "status_name", "diag_text"].contains(&name);
        if !free && !wrapper.contains(&format!("&P##_{name};")) {
            return Err(format!("the wrapper does not know nekton_{name}"));
        }
    }
    Ok(())
}

/// Two Rust libraries of the same compiler have hundreds of symbols in common; all of both are linked.
fn neighbours() -> Result<(), String> {
    let folder = fresh("neighbours")?;
    let sources = root().join("tests/c");
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()));
    rustc.args(["--edition=2024", "--crate-type=staticlib", "-Copt-level=2", "-o"]).arg(folder.join("libother.a"));
    ask(rustc.arg(sources.join("other.rs")))?;
    let mut cc = Command::new("cc");
    cc.args(WARNINGS).arg("-std=c99").arg(sources.join("neighbours.c")).arg("-I").arg(prefix().join("include"));
    cc.arg("-Wl,--whole-archive").arg(prefix().join("lib/libnekton.a")).arg(folder.join("libother.a"));
    ask(cc.args(["-Wl,--no-whole-archive", "-lm", "-lpthread", "-ldl", "-o"]).arg(folder.join("neighbours")))?;
    ask(&mut Command::new(folder.join("neighbours"))).map(drop)
}

/// The first block of a language in a Markdown file.
fn block(file: &str, language: &str) -> Result<String, String> {
    block_below("", file, language)
}

/// The same below a heading.
fn block_below(heading: &str, file: &str, language: &str) -> Result<String, String> {
    let text = read(&root().join(file))?;
    let (_, text) = text.split_once(heading).ok_or(format!("{file} has no {heading}"))?;
    let from = text.split_once(&format!("```{language}\n")).map(|(_, rest)| rest);
    let inside = from.and_then(|rest| rest.split_once("```")).map(|(inside, _)| inside.to_string());
    inside.ok_or(format!("{file} has no block of {language}"))
}

/// The installed tree moved to another place, which is removed at the end.
struct Moved(PathBuf);

impl Moved {
    fn new(name: &str) -> Result<Self, String> {
        let place = std::env::temp_dir().join(format!("nekton-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&place);
        std::fs::create_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
        let moved = Moved(place);
        ask(Command::new("cp").arg("-a").arg(prefix()).arg(moved.tree()))?;
        let coasting = block_below("## Linearize", "README.md", "c")?;
        for (name, text) in [("fish.c", block("README.md", "c")?), ("coasting.c", coasting)] {
            std::fs::write(moved.0.join(name), text).map_err(|error| error.to_string())?;
        }
        Ok(moved)
    }
    fn tree(&self) -> PathBuf {
        self.0.join("installed")
    }
}

impl Drop for Moved {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs the README's program and compares the six digits that it prints.
fn fish(run: &mut Command) -> Result<(), String> {
    six_digits("fish", run)
}

fn six_digits(name: &str, run: &mut Command) -> Result<(), String> {
    let digits = |lines: Lines| -> Vec<String> { lines.concat().iter().map(|x| format!("{x:.5e}")).collect() };
    let expected = digits(lines(name).ok_or("nothing is expected of the README's program")?);
    let printed = digits(numbers(&ask(run)?));
    if printed == expected { Ok(()) } else { Err(format!("{run:?} printed {printed:?}, expected {expected:?}")) }
}

fn consumer_by_cmake() -> Result<(), String> {
    let moved = Moved::new("cmake")?;
    let source = root().join("tests/c/consumer/CMakeLists.txt");
    std::fs::copy(&source, moved.0.join("CMakeLists.txt")).map_err(|error| error.to_string())?;
    let build = moved.0.join("build");
    configure(&moved.0, &build, &moved.tree())?;
    fish(&mut Command::new(build.join("fish_static")))?;
    fish(&mut Command::new(build.join("fish_shared")))?;
    // An incompatible version is not taken.
    let text = read(&source)?.replace("nekton 0.1 ", "nekton 0.2 ");
    std::fs::write(moved.0.join("CMakeLists.txt"), text).map_err(|error| error.to_string())?;
    match configure(&moved.0, &moved.0.join("other"), &moved.tree()) {
        Ok(()) => Err("version 0.1 was taken for version 0.2".into()),
        Err(_) => Ok(()),
    }
}

fn consumer_by_pkg_config() -> Result<(), String> {
    let moved = Moved::new("pkg-config")?;
    let lib = moved.tree().join("lib");
    let compile_one = |program: &str, line: &str| {
        let line = format!("cc -std=c99 {program} {line}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &line]).current_dir(&moved.0).env("PKG_CONFIG_PATH", lib.join("pkgconfig"));
        ask(&mut shell)
    };
    let compile = |line: &str| compile_one("fish.c", line);
    compile("$(pkg-config --cflags --libs nekton) -o shared")?;
    compile("-static $(pkg-config --static --cflags --libs nekton) -o static")?;
    fish(Command::new(moved.0.join("shared")).env("LD_LIBRARY_PATH", &lib))?;
    fish(&mut Command::new(moved.0.join("static")))?;
    compile_one("coasting.c", "-static $(pkg-config --static --cflags --libs nekton) -o coasting")?;
    six_digits("coasting", &mut Command::new(moved.0.join("coasting")))
}

/// Copy and paste.
fn readme_of_examples() -> Result<(), String> {
    let commands = block("examples-c/README.md", "sh")?;
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", &commands]).current_dir(root());
    let printed = ask(&mut shell)?;
    let expected = lines("swimmer_prescribed").unwrap_or_default();
    if numbers(&printed).ends_with(&expected) { Ok(()) } else { Err(format!("it printed {printed}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printing(lines: &Lines) -> Command {
        let text: Vec<String> = lines.iter().flatten().map(f64::to_string).collect();
        let mut command = Command::new("printf");
        command.arg("%s %s %s %s\\n").args(text);
        command
    }

    #[test]
    fn a_difference_in_the_last_bit_or_a_missing_line_is_noticed() {
        let name = "one_body_static";
        let good = lines(name).unwrap();
        assert_eq!(compare(name, &mut printing(&good)), Ok(()));
        let mut off = good.clone();
        off[9][3] = off[9][3].next_up();
        assert!(compare(name, &mut printing(&off)).unwrap_err().contains("line 10"));
        assert!(compare(name, &mut printing(&good[..9].to_vec())).is_err());
        assert!(compare(name, &mut Command::new("false")).is_err());
    }
}
