//! The programs without an operating system: built, run, compared with the same program on this computer, and measured.

use crate::archive::{HERE, Machine, build_package, finish, proven};
use crate::bare::{CORTEX_M, Compiler, compiler};
use nekton_steps::{Outcome, ask, cargo, output, require, root};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What QEMU emulates.
struct Board {
    name: &'static str,
    machine: Machine,
    /// QEMU's name of the board.
    emulated: &'static str,
    floating_point: &'static str,
}

const fn cortex(processor: &'static str) -> Machine {
    let target = Some((CORTEX_M, processor));
    Machine { folder: processor, target, tools: "arm-none-eabi-", format: "elf32-littlearm", features: "" }
}

const BOARDS: [Board; 2] = [
    Board { name: "Cortex-M4F", machine: cortex("cortex-m4"), emulated: "mps2-an386", floating_point: "fpv4-sp-d16" },
    Board { name: "Cortex-M7", machine: cortex("cortex-m7"), emulated: "mps2-an500", floating_point: "fpv5-d16" },
];

/// The names of the boards.
pub fn boards() -> impl Iterator<Item = &'static str> {
    BOARDS.iter().map(|board| board.name)
}

/// Name, compiler option, and largest difference from this computer's trajectory: the arithmetic is the same, operation by
/// operation, so that only the rounding of the printed numbers may differ.
const PRECISIONS: [(&str, &str, f64); 2] = [("f32", "-DSINGLE", 1e-6), ("f64", "-DDOUBLE", 1e-12)];

/// QEMU executes one instruction per nanosecond (`-icount shift=0`); the boards' clock ticks every 40 ns.
const INSTRUCTIONS_PER_TICK: u64 = 40;

const FIGURES: &str = "docs/embedded.csv";
const COLUMNS: [&str; 10] = [
    "processor",
    "precision",
    "flash_bytes",
    "static_ram_bytes",
    "stack_bytes",
    "model_bytes",
    "sim_bytes",
    "setup_instructions",
    "rk4_step_instructions",
    "abm4_step_instructions",
];

const WARNINGS: [&str; 6] = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Werror"];

fn sources(folder: &str, names: &[&str]) -> Vec<PathBuf> {
    names.iter().map(|name| root().join("examples-c").join(folder).join(name)).collect()
}

/// What the program printed: numbers by the words before them, and the rows of the trajectory.
struct Printed {
    numbers: BTreeMap<String, u64>,
    rows: BTreeMap<String, Vec<f64>>,
}

impl Printed {
    fn of(text: &str) -> Result<Self, String> {
        if text.lines().last() != Some("done") {
            return Err(format!("the program did not come to its end:\n{text}"));
        }
        let mut printed = Printed { numbers: BTreeMap::new(), rows: BTreeMap::new() };
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.as_slice() {
                [method, step, x, y, angle] if x.contains('.') => {
                    let row: Result<Vec<f64>, _> = [x, y, angle].map(|w| w.parse()).into_iter().collect();
                    printed.rows.insert(format!("{method} {step}"), row.map_err(|_| line.to_string())?);
                }
                [what, kind, value, ..] => {
                    printed.numbers.insert(format!("{what} {kind}"), value.parse().map_err(|_| line.to_string())?);
                }
                [what, value] if *what == "stack" => {
                    printed.numbers.insert((*what).into(), value.parse().map_err(|_| line.to_string())?);
                }
                _ => {}
            }
        }
        Ok(printed)
    }

    fn number(&self, name: &str) -> u64 {
        self.numbers.get(name).copied().unwrap_or(0)
    }

    /// The largest difference of two trajectories.
    fn distance(&self, other: &Printed) -> Result<f64, String> {
        if self.rows.is_empty() || !self.rows.keys().eq(other.rows.keys()) {
            return Err("the trajectories have different rows".into());
        }
        let pairs = self.rows.values().flatten().zip(other.rows.values().flatten());
        Ok(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    }
}

/// The trajectory on this computer, by the ordinary library.
fn on_desktop(precision: &str, option: &str) -> Result<Printed, String> {
    let target = root().join("target");
    ask(cargo(&["build", "--quiet", "--package", "nekton-ffi", "--target-dir"]).arg(&target))?;
    let folder = target.join("firmware");
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let program = folder.join(format!("desktop-{precision}"));
    let mut link = Command::new("cc");
    link.args(WARNINGS).args(["-O2", option]).args(sources("firmware", &["main.c", "desktop.c"]));
    link.arg(target.join("debug/libnekton_ffi.a")).args(["-Wl,--gc-sections", "-lm", "-lpthread", "-ldl", "-o"]);
    ask(link.arg(&program))?;
    Printed::of(&ask(&mut Command::new(&program))?)
}

fn compare(precision: &str, printed: &Printed, desktop: &Printed, allowed: f64) -> Result<(), String> {
    let distance = printed.distance(desktop)?;
    println!("{precision}: {} positions, largest difference from this computer's {distance:.1e}", desktop.rows.len());
    // Written so that a NaN fails.
    if distance <= allowed { Ok(()) } else { Err(format!("{precision}: trajectories differ by {distance:e}")) }
}

/// A program without C library on this computer: linked with the prelinked archive, run, compared.
pub fn freestanding() -> Result<(), String> {
    let prelinked = proven(&HERE, &Compiler::usual())?;
    for (precision, option, allowed) in PRECISIONS {
        let program = HERE.place().join(precision);
        let mut link = Command::new("cc");
        link.args(WARNINGS).args(["-O2", option, "-ffreestanding", "-fno-builtin", "-fno-stack-protector"]);
        // The compiler must not make memcpy out of memcpy's own loop.
        link.args(["-fno-tree-loop-distribute-patterns", "-nostdlib", "-static", "-Wl,--gc-sections"]);
        link.args(sources("firmware", &["main.c"])).args(sources("freestanding", &["linux.c"]));
        ask(link.arg(&prelinked.archive).arg("-o").arg(&program))?;
        let printed = Printed::of(&ask(&mut Command::new(&program))?)?;
        compare(precision, &printed, &on_desktop(precision, option)?, allowed)?;
    }
    Ok(())
}

/// One row of the table of figures, in the order of `COLUMNS`.
type Figures = Vec<String>;

impl Board {
    /// Links a program with an archive, runs it, and reads what it prints.
    fn print(&self, program: &Path, main: &[PathBuf], archive: &Path, option: &str) -> Result<Printed, String> {
        let (_, processor) = self.machine.target.unwrap_or_default();
        let mut link = self.machine.tool("gcc");
        link.args([format!("-mcpu={processor}"), format!("-mfpu={}", self.floating_point)]);
        link.args(["-mthumb", "-mfloat-abi=hard", "-Os", option, "-ffunction-sections", "-fdata-sections"]);
        link.args(WARNINGS).args(main).args(sources("firmware", &["board.c"])).arg(archive).arg("-T");
        link.args(sources("firmware", &["firmware.ld"])).args(["-nostartfiles", "--specs=nano.specs"]);
        ask(link.args(["-Wl,--gc-sections", "-o"]).arg(program))?;
        let mut emulate = Command::new("timeout");
        emulate.args(["300", "qemu-system-arm", "-M", self.emulated, "-icount", "shift=0", "-display", "none"]);
        emulate.args(["-serial", "null", "-monitor", "none", "-chardev", "stdio,id=out", "-semihosting-config"]);
        emulate.args(["enable=on,target=native,chardev=out", "-kernel"]);
        Printed::of(&ask(emulate.arg(program))?)
    }

    fn measure(&self, compiler: &Compiler) -> Result<Vec<Figures>, String> {
        let prelinked = proven(&self.machine, compiler)?;
        PRECISIONS.iter().map(|p| self.run(&prelinked.archive, p)).collect()
    }

    fn run(&self, archive: &Path, &(precision, option, allowed): &(&str, &str, f64)) -> Result<Figures, String> {
        let program = self.machine.place().join(format!("{precision}.elf"));
        let printed = self.print(&program, &sources("firmware", &["main.c"]), archive, option)?;
        compare(precision, &printed, &on_desktop(precision, option)?, allowed)?;

        // Second line: text, data, bss.
        let sizes = ask(self.machine.tool("size").arg(&program))?;
        let sizes: Vec<u64> =
            sizes.lines().nth(1).unwrap_or("").split_whitespace().filter_map(|w| w.parse().ok()).collect();
        let [text, data, bss, ..] = sizes[..] else { return Err("size printed no figures".into()) };
        let stack_reserved = 32 * 1024;
        let figures = [
            text + data,
            data + bss - stack_reserved,
            printed.number("stack"),
            printed.number("model bytes"),
            printed.number("sim bytes"),
            printed.number("setup ticks") * INSTRUCTIONS_PER_TICK,
            printed.number("rk4 ticks") * INSTRUCTIONS_PER_TICK,
            printed.number("abm4 ticks") * INSTRUCTIONS_PER_TICK,
        ];
        let names = [self.name.to_string(), precision.to_string()];
        Ok(names.into_iter().chain(figures.map(|f| f.to_string())).collect())
    }
}

/// `cargo xtask firmware --counts`: prints, as CSV, instructions of one evaluation of the swimmer, and of the factorization alone
/// for each of its multiply-adds.
pub fn print_counts() -> ExitCode {
    match counts() {
        Ok(table) => {
            print!("{table}");
            ExitCode::SUCCESS
        }
        Err(why) => {
            eprintln!("{why}");
            ExitCode::FAILURE
        }
    }
}

/// Counts on every board, in every precision that its processor computes itself. Cost: a build and six runs.
fn counts() -> Result<String, String> {
    require(&PROGRAMS)?;
    let compiler = compiler(CORTEX_M).map_err(Outcome::why)?;
    let mut table = String::from("processor,precision,evaluation,per_multiply_add\n");
    for board in &BOARDS {
        let whole = build_package("nekton-ffi", &board.machine, &compiler)?;
        let lu = build_package("nekton-bench-bare", &board.machine, &compiler)?;
        for (precision, option, _) in PRECISIONS {
            if precision == "f64" && board.floating_point == "fpv4-sp-d16" {
                continue;
            }
            let run = |source: &str, archive: &Path| {
                let program = board.machine.place().join(format!("{source}-{precision}.elf"));
                let source = root().join("bench/bare").join(source);
                board.print(&program, &[source], archive, option)
            };
            let instructions = |ticks: u64| (ticks * INSTRUCTIONS_PER_TICK) as f64;
            let (evaluation, lu) = (run("evaluation.c", &whole)?, run("lu.c", &lu)?);
            let evaluation = instructions(evaluation.number("evaluation ticks"));
            let per_multiply_add = instructions(lu.number("lu ticks")) / lu.number("multiply adds") as f64;
            table += &format!("{},{precision},{evaluation},{per_multiply_add}\n", board.name);
        }
    }
    Ok(table)
}

const PROGRAMS: [(&str, &str); 4] = [
    ("cc", "gcc"),
    ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
    ("qemu-system-arm", "qemu-system-arm"),
    // The library has no program of its own; the compiler says where it is.
    ("arm-none-eabi-gcc && test -e $(arm-none-eabi-gcc -print-file-name=nano.specs)", "libnewlib-arm-none-eabi"),
];

/// Runs the firmware on one board and holds its figures against the committed ones.
pub fn step(name: &str) -> Outcome {
    let Some(board) = BOARDS.iter().find(|board| board.name == name) else {
        return Outcome::Failed(format!("no board {name}"));
    };
    let compiler = match require(&PROGRAMS).map_err(Outcome::Skipped).and_then(|()| compiler(CORTEX_M)) {
        Ok(compiler) => compiler,
        Err(outcome) => return outcome,
    };
    board.measure(&compiler).and_then(|rows| hold(&rows)).into()
}

/// Committed figures, and README's table of them, must be those measured, but for what another compiler's version makes of it.
fn hold(measured: &[Figures]) -> Result<(), String> {
    let (_, rows) = committed()?;
    for row in measured {
        println!("{}", row.join(","));
        let old =
            rows.iter().find(|old| old[..2] == row[..2]).ok_or(format!("{FIGURES} has no row {:?}", &row[..2]))?;
        for ((old, new), name) in old.iter().zip(row).zip(COLUMNS).skip(2) {
            let (old, new): (f64, f64) = (old.parse().unwrap_or(f64::NAN), new.parse().unwrap_or(f64::NAN));
            let close = (new - old).abs() <= 0.1 * old;
            if !close {
                return Err(format!("{name} is {new}, {FIGURES} says {old} (cargo xtask firmware)"));
            }
        }
    }
    let readme = std::fs::read_to_string(root().join("README.md")).map_err(|error| error.to_string())?;
    let table = table()?;
    if readme.contains(&table) { Ok(()) } else { Err(format!("README's table should be:\n{table}")) }
}

/// The committed figures: the line that says how they were measured, and the rows.
fn committed() -> Result<(String, Vec<Figures>), String> {
    let text = std::fs::read_to_string(root().join(FIGURES)).map_err(|error| format!("{FIGURES}: {error}"))?;
    let how = text.lines().next().unwrap_or("").trim_start_matches("# ").to_string();
    let rows = text.lines().skip(2).map(|line| line.split(',').map(str::to_string).collect::<Figures>());
    let rows: Vec<Figures> = rows.collect();
    if rows.iter().all(|row| row.len() == COLUMNS.len()) { Ok((how, rows)) } else { Err(format!("{FIGURES}: columns")) }
}

/// README's table.
fn table() -> Result<String, String> {
    let (how, rows) = committed()?;
    let mut text = String::from(
        "| processor | precision | flash, kB | static RAM, kB | stack, kB | set-up, 10⁶ instructions | RK4 step | ABM4 step |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let number = |i: usize| row[i].parse::<f64>().unwrap_or(f64::NAN);
        let (kilo, mega) = (|i| number(i) / 1e3, |i| number(i) / 1e6);
        text += &format!(
            "| {} | {} | {:.0} | {:.0} | {:.1} | {:.2} | {:.2} | {:.2} |\n",
            row[0],
            row[1],
            kilo(2),
            kilo(3),
            kilo(4),
            mega(7),
            mega(8),
            mega(9)
        );
    }
    Ok(format!("{text}\nMeasured {how}.\n"))
}

/// `cargo xtask firmware`: measures and writes the figures, and prints README's table.
pub fn run() -> ExitCode {
    let compiler = require(&PROGRAMS).and_then(|()| compiler(CORTEX_M).map_err(Outcome::why));
    let made = compiler.and_then(|compiler| {
        let mut rows = Vec::new();
        for board in &BOARDS {
            rows.extend(board.measure(&compiler)?);
        }
        let date = output("date", &["-u", "+%Y-%m-%d"]).unwrap_or_default();
        let emulator = output("qemu-system-arm", &["--version"]).unwrap_or_default();
        let emulator =
            emulator.lines().next().unwrap_or("").split(" (").next().unwrap_or("").replace("emulator version ", "");
        let mut text = format!("# {date}, {emulator}, {}\n{}\n", compiler.version(), COLUMNS.join(","));
        for row in rows {
            text += &(row.join(",") + "\n");
        }
        std::fs::write(root().join(FIGURES), text).map_err(|error| format!("{FIGURES}: {error}"))?;
        println!("{}", table()?);
        Ok(())
    });
    finish(made, FIGURES)
}
