//! `cargo xtask header`: what is made from the sources of the C interface and from the list of errors. The results are
//! committed, so that users need neither this command nor cbindgen; a test compares them.

use nekton::Status;
use nekton_steps::root;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// Types whose names in C depend on the precision.
const TYPES: [(&str, &str); 16] = [
    ("SceneDef", "scene_def"),
    ("WallDef", "wall_def"),
    ("BodyDef", "body_def"),
    ("LinkDef", "link_def"),
    ("ShapeDef", "shape"),
    ("SignalDef", "signal"),
    ("HarmonicDef", "harmonic"),
    ("WindowDef", "window"),
    ("MethodDef", "method"),
    ("LinkOut", "link_info"),
    ("EnergyOut", "energy"),
    ("ResolutionOut", "resolution"),
    ("TimeErrorOut", "time_error"),
    ("GapOut", "gap"),
    ("ModelHandle", "model"),
    ("SimHandle", "sim"),
];

/// What the headers say before the declarations.
const PREAMBLES: [&str; 2] = [include_str!("header_preamble.h"), include_str!("header_preamble32.h")];
/// Macros for static memory.
const MACROS: [&str; 2] = [include_str!("header_macros.h"), include_str!("header_macros32.h")];

/// Writes the files.
pub fn run() -> ExitCode {
    // The headers are made from the twin, so the twin comes first.
    for make in [twin, header, header32, errors] {
        let (path, content) = make();
        if std::fs::read_to_string(&path).is_ok_and(|old| old == content) {
            println!("{}: up to date", path.display());
        } else if let Err(error) = std::fs::write(&path, content) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        } else {
            println!("{}: written", path.display());
        }
    }
    ExitCode::SUCCESS
}

/// Functions in single precision: those in double precision with other names.
fn twin() -> (PathBuf, String) {
    let source = std::fs::read_to_string(root().join("ffi/src/api64.rs")).expect("ffi/src/api64.rs is there");
    let (_, rest) = source.split_once('\n').expect("a first line");
    let mut text = String::from("//! Made from api64.rs by `cargo xtask header`: the same in single precision.\n");
    for line in rest.lines() {
        // Types and constants without precision keep their names, and so do names in comments of what has no twin.
        let mut line = line.replace("f64", "f32");
        for group in
            ["scene_def_init", "wall_def_init", "body_def_init", "link_def_init", "method_init", "model_", "sim_"]
        {
            line = line.replace(&format!("nekton_{group}"), &format!("nekton32_{group}"));
        }
        text.push_str(&line);
        text.push('\n');
    }
    (root().join("ffi/src/api32.rs"), formatted(&text))
}

/// Longer names may break lines elsewhere.
fn formatted(source: &str) -> String {
    use std::io::Write;
    use std::process::{Command, Stdio};
    let config = root().join("rustfmt.toml");
    let mut child = Command::new("rustfmt")
        .args(["--edition", "2024", "--emit", "stdout", "--config-path"])
        .arg(config)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("rustfmt is installed");
    child.stdin.take().expect("a pipe").write_all(source.as_bytes()).expect("rustfmt reads");
    let output = child.wait_with_output().expect("rustfmt ends");
    assert!(output.status.success(), "rustfmt refuses the text");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// A name such as `BadHandle` as `BAD_HANDLE`.
fn screaming(name: &str) -> String {
    let mut text = String::new();
    for (i, c) in name.chars().enumerate() {
        if c.is_uppercase() && i > 0 {
            text.push('_');
        }
        text.push(c.to_ascii_uppercase());
    }
    text
}

/// The name of a status in C.
fn constant(status: Status) -> String {
    let kind = match status.code() {
        0 => return "NEKTON_OK".into(),
        1.. => "N",
        _ => "E",
    };
    format!("NEKTON_{kind}_{}", screaming(status.name()))
}

/// include/nekton.h.
fn header() -> (PathBuf, String) {
    let mut errors = String::from("/**\n * Outcomes: 0 ok, > 0 notices, < 0 errors.\n */\nenum {\n");
    for status in Status::ALL {
        let comma = if Some(status) == Status::ALL.last() { "" } else { "," };
        let _ = writeln!(errors, "    /** {} */\n    {} = {}{comma}", status.text(), constant(*status), status.code());
    }
    errors.push_str("};\n");
    let [body, _] = declarations();
    let text = format!("{}\n{errors}\n{body}\n\n{}\n#endif /* NEKTON_H */\n", PREAMBLES[0], MACROS[0]);
    (root().join("include/nekton.h"), text)
}

/// include/nekton32.h.
fn header32() -> (PathBuf, String) {
    let [_, body] = declarations();
    let text = format!("{}\n{body}\n\n{}\n#endif /* NEKTON32_H */\n", PREAMBLES[1], MACROS[1]);
    (root().join("include/nekton32.h"), text)
}

/// What is declared, without the names of single precision and with them alone.
fn declarations() -> [String; 2] {
    let config = cbindgen::Config {
        language: cbindgen::Language::C,
        cpp_compat: true,
        style: cbindgen::Style::Both,
        documentation: true,
        documentation_style: cbindgen::DocumentationStyle::Doxy,
        usize_is_size_t: true,
        no_includes: true,
        line_length: 120,
        tab_width: 4,
        braces: cbindgen::Braces::SameLine,
        ..Default::default()
    };
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in ["types/definitions", "types/answers", "shared", "api64", "api32"] {
        builder = builder.with_src(root().join(format!("ffi/src/{file}.rs")));
    }
    let mut bytes = Vec::new();
    builder.generate().expect("cbindgen understands the sources").write(&mut bytes);
    let mut body = String::from_utf8(bytes).expect("UTF-8");
    for (rust, c) in TYPES {
        body = body.replace(&format!("{rust}_f64"), &format!("nekton_{c}"));
        body = body.replace(&format!("{rust}_f32"), &format!("nekton32_{c}"));
    }
    let body = tidy(&body);
    // One declaration with its comment, or one of the lines about C++, which both headers need.
    let items: Vec<&str> = body.trim().split("\n\n").collect();
    let single = |item: &str| item.contains("nekton32_");
    let of = |wanted: bool| {
        let own = items.iter().filter(|item| item.contains("__cplusplus") || single(item) == wanted);
        own.copied().collect::<Vec<_>>().join("\n\n")
    };
    [of(false), of(true)]
}

/// Comments of one line on one line, negative constants in parentheses, names of a family of outcomes as they are written.
fn tidy(text: &str) -> String {
    let lines: Vec<&str> = text.trim().lines().collect();
    let mut out = String::new();
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let short = lines.get(at + 1).and_then(|l| l.trim_start().strip_prefix("* "));
        match (line.trim(), short, lines.get(at + 2).map(|l| l.trim())) {
            ("/**", Some(short), Some("*/")) => {
                let indent = line.len() - line.trim_start().len();
                let _ = writeln!(out, "{:indent$}/** {short} */", "");
                at += 3;
                continue;
            }
            (line, ..) if line.starts_with("}") && line.ends_with("// extern \"C\"") => {
                out.push_str("} /* extern C */\n")
            }
            (line, ..) if line.starts_with("#endif") => out.push_str("#endif\n"),
            (define, ..) if define.starts_with("#define") && define.contains(" -") => {
                let (name, value) = define.rsplit_once(' ').unwrap_or((define, ""));
                let _ = writeln!(out, "{name} ({value})");
            }
            _ => {
                out.push_str(line);
                out.push('\n');
            }
        }
        at += 1;
    }
    out
}

/// docs/errors.md.
fn errors() -> (PathBuf, String) {
    let mut text = String::from(
        "# Errors and notices\n\n\
         Made by `cargo xtask header` from the one list in core/src/base/status.rs. A call returns the number; \
         `nekton_status_text` gives the text, `nekton_diag` says where and which value.\n\n\
         | number | C | Rust | Matlab identifier | meaning |\n|---:|---|---|---|---|\n",
    );
    for s in Status::ALL {
        let _ = writeln!(
            text,
            "| {} | `{}` | `Status::{}` | `nekton:{}` | {} |",
            s.code(),
            constant(*s),
            s.name(),
            s.name(),
            s.text()
        );
    }
    (root().join("docs/errors.md"), text)
}

#[cfg(test)]
mod tests {
    #[test]
    fn generated_files_are_up_to_date() {
        for (path, content) in [super::twin, super::header, super::header32, super::errors].map(|make| make()) {
            let found = std::fs::read_to_string(&path).unwrap_or_default();
            assert!(found == content, "{} is out of date: run `cargo xtask header`", path.display());
        }
    }

    #[test]
    fn headers_are_ascii() {
        for (_, header) in [super::header(), super::header32()] {
            let strange: Vec<_> = header.lines().filter(|line| !line.is_ascii()).collect();
            assert!(strange.is_empty(), "{strange:?}");
        }
    }

    #[test]
    fn each_header_declares_one_precision() {
        let ([double, single], macros) = (super::declarations(), super::MACROS);
        assert!(!double.contains("nekton32") && !macros[0].contains("NEKTON32"));
        // Functions and types with the prefix of double precision are declared in the other header alone.
        let declares = |line: &str| line.starts_with("typedef ") || line.starts_with("nekton_status ");
        let lines: Vec<_> = single.lines().filter(|line| declares(line)).collect();
        assert!(lines.len() > 60 && lines.iter().all(|line| line.contains("nekton32_")), "{lines:?}");
    }
}
