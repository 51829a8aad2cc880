//! The copy of core and its tests in which changes wait for their switches.

use crate::Folders;
use crate::sample::{Order, read, walk};
use std::path::Path;

/// Which change is on, and which switches a run passes, both told by the environment before `main`.
const SWITCH: &str = r#"
#[allow(unsafe_code, missing_docs)]
pub(crate) mod mutant {
    use std::sync::atomic::{AtomicBool, Ordering};

    const COVER: u32 = u32::MAX - 1;
    // Written before `main` alone; a plain load may leave loops.
    static mut ACTIVE: u32 = u32::MAX;
    static PASSED: [AtomicBool; 65536] = [const { AtomicBool::new(false) }; 65536];

    #[inline(always)]
    pub(crate) fn on(id: u32) -> bool {
        let active = unsafe { ACTIVE };
        if active == id {
            return true;
        }
        if active == COVER {
            pass(id);
        }
        false
    }

    #[cold]
    #[inline(never)]
    fn pass(id: u32) {
        PASSED[id as usize].store(true, Ordering::Relaxed);
    }

    extern "C" fn begin() {
        let Ok(word) = std::env::var("NEKTON_MUTANT") else { return };
        unsafe { ACTIVE = if word == "cover" { COVER } else { word.parse().unwrap_or(u32::MAX) } };
    }

    extern "C" fn end() {
        let Ok(path) = std::env::var("NEKTON_COVER") else { return };
        let passed = PASSED.iter().enumerate().filter(|(_, passed)| passed.load(Ordering::Relaxed));
        let ids: std::vec::Vec<std::string::String> = passed.map(|(id, _)| std::format!("{id}")).collect();
        // Time of the processor in hundredths of a second, of the process and all of its threads.
        let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
        let times = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
        let spent: u64 = times.filter_map(|word| word.parse::<u64>().ok()).sum();
        let _ = std::fs::write(path, std::format!("{spent}\n{}", ids.join(" ")));
    }

    #[used]
    #[unsafe(link_section = ".init_array")]
    static BEGIN: extern "C" fn() = begin;
    #[used]
    #[unsafe(link_section = ".fini_array")]
    static END: extern "C" fn() = end;
}
"#;

/// Where the switches of a file of the copy are: bytes and number, the outer before the inner.
pub struct Written {
    pub file: String,
    pub text: String,
    pub switches: Vec<(std::ops::Range<usize>, usize)>,
}

/// Puts the chosen changes into the text of a file.
fn switched(file: &str, text: &str, order: &Order, chosen: &[usize]) -> Written {
    let mut mine: Vec<usize> = chosen.iter().copied().filter(|&id| order.mutants[id].file == file).collect();
    mine.sort_by_key(|&id| (order.mutants[id].start, std::cmp::Reverse(order.mutants[id].end), id));
    let (mut out, mut at) = (String::new(), 0);
    let mut switches: Vec<(std::ops::Range<usize>, usize)> = Vec::new();
    // Switches that are open: where they end in the source, what closes them, and which they are.
    let mut open: Vec<(usize, &'static str, usize)> = Vec::new();
    let close_until = |limit: usize,
                       open: &mut Vec<(usize, &'static str, usize)>,
                       out: &mut String,
                       at: &mut usize,
                       switches: &mut Vec<(std::ops::Range<usize>, usize)>| {
        while let Some((end, close, slot)) = open.pop_if(|(end, ..)| *end <= limit) {
            out.push_str(&text[*at..end]);
            *at = end;
            out.push_str(close);
            switches[slot].0.end = out.len();
        }
    };
    for id in mine {
        let mutant = &order.mutants[id];
        // One that begins where another ends lies behind it.
        close_until(mutant.start, &mut open, &mut out, &mut at, &mut switches);
        out.push_str(&text[at..mutant.start]);
        at = mutant.start;
        let (before, behind) = mutant.switch(id);
        switches.push((out.len()..out.len(), id));
        out.push_str(&before);
        if mutant.end == mutant.start {
            out.push_str(behind);
            let last = switches.len() - 1;
            switches[last].0.end = out.len();
        } else {
            open.push((mutant.end, behind, switches.len() - 1));
        }
    }
    close_until(usize::MAX, &mut open, &mut out, &mut at, &mut switches);
    out.push_str(&text[at..]);
    if file == "core/src/lib.rs" {
        out.push_str(SWITCH);
    }
    Written { file: file.into(), text: out, switches }
}

/// The workspace's description with two members. A change may leave names unused or make a comparison absurd: no lints.
fn workspace(text: &str) -> String {
    let (mut out, mut lints) = (String::new(), false);
    for line in text.lines() {
        if line.starts_with('[') {
            lints = line.starts_with("[workspace.lints");
        } else if lints || line.starts_with("default-members") {
            continue;
        }
        out += if line.starts_with("members") { "members = [\"core\", \"tests\"]" } else { line };
        out.push('\n');
    }
    out.replace("[workspace.lints.rust]", "[workspace.lints.rust]\nwarnings = \"allow\"\nunsafe_code = \"allow\"")
}

/// Writes the copy with the chosen changes; gives where their switches are.
pub fn write(folders: &Folders, order: &Order, chosen: &[usize]) -> Result<Vec<Written>, String> {
    let (root, copy) = (&folders.root, folders.copy());
    put(&copy.join("Cargo.toml"), &workspace(&read(&root.join("Cargo.toml"))?))?;
    // The examples' plots are not needed.
    let tests: String = read(&root.join("tests/Cargo.toml"))?.replace("nekton-cli = { path = \"../cli\" }", "");
    put(&copy.join("tests/Cargo.toml"), &tests)?;
    put(&copy.join("core/Cargo.toml"), &read(&root.join("core/Cargo.toml"))?)?;
    put(&copy.join("README.md"), &read(&root.join("README.md"))?)?;
    if !copy.join("Cargo.lock").exists() {
        put(&copy.join("Cargo.lock"), &read(&root.join("Cargo.lock"))?)?;
    }
    let mut kept = Vec::new();
    for folder in ["core/tests", "tests/src", "tests/tests"] {
        let mut paths = Vec::new();
        walk(&root.join(folder), &mut paths)?;
        for path in paths {
            let to = copy.join(path.strip_prefix(root).map_err(|error| error.to_string())?);
            put(&to, &read(&path)?)?;
            kept.push(to);
        }
    }
    let mut written = Vec::new();
    for (file, text) in &order.files {
        let one = switched(file, text, order, chosen);
        put(&copy.join(file), &one.text)?;
        kept.push(copy.join(file));
        written.push(one);
    }
    // What a run before this one had and this one has not.
    for folder in ["core/src", "core/tests", "tests/src", "tests/tests"] {
        let mut paths = Vec::new();
        walk(&copy.join(folder), &mut paths)?;
        for path in paths.iter().filter(|path| !kept.contains(path)) {
            std::fs::remove_file(path).map_err(|error| format!("{}: {error}", path.display()))?;
        }
    }
    Ok(written)
}

/// Writes a file unless it is so already, so that what is compiled stays compiled.
fn put(path: &Path, text: &str) -> Result<(), String> {
    if std::fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, text))
        .map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod test {
    use super::*;
    use crate::find::mutants;
    use std::collections::BTreeSet;

    #[test]
    fn nested_switches_choose_between_the_piece_and_its_change() {
        let text = "fn f(x: f64) -> f64 {\n    g(x);\n    -x * 2.0 // twice\n}\n#[cfg(test)]\nfn t() { g(1.0); }\nconst N: usize = 1 + 1;\n";
        let (mutants, _) = mutants("core/src/a.rs", text).unwrap();
        let changes: Vec<String> = mutants.iter().map(|m| m.change()).collect();
        assert_eq!(
            changes,
            ["g(x); → (nothing)", "begins with return 0.0;", "-x * 2.0 → -x / 2.0", "-x → x", "2.0 → 1.0"]
        );
        let order = Order { mutants, idle: BTreeSet::new(), files: Vec::new(), hash: 0 };
        let written = switched("core/src/a.rs", text, &order, &[0, 1, 2, 3, 4]);
        let body: Vec<&str> = written.text.lines().skip(1).take(2).map(str::trim).collect();
        assert_eq!(body[0], "if !crate::mutant::on(0) {  if crate::mutant::on(1) { return 0.0; } g(x); }");
        assert_eq!(
            body[1],
            "(if crate::mutant::on(2) { -x / 2.0 } else { (if crate::mutant::on(3) { x } else { -x }) * \
             (if crate::mutant::on(4) { 1.0 } else { 2.0 }) }) // twice"
        );
        let whole = &written.switches.iter().find(|(_, id)| *id == 2).unwrap().0;
        assert!(written.text[whole.clone()].starts_with("(if") && written.text[whole.clone()].ends_with("})"));
    }

    #[test]
    fn the_copy_has_two_members_and_no_lints() {
        let text = "[workspace]\nmembers = [\"core\", \"cli\"]\ndefault-members = [\"cli\"]\n[workspace.lints.rust]\nunsafe_code = \"deny\"\n[profile.dev]\nopt-level = 2\n";
        let kept = workspace(text);
        assert!(kept.contains("members = [\"core\", \"tests\"]") && kept.contains("[profile.dev]\nopt-level = 2"));
        assert!(kept.contains("warnings = \"allow\"") && !kept.contains("deny") && !kept.contains("default-members"));
    }
}
