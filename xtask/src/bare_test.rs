//! The script against machines that are made up: what stands for apt-get, apt-cache, dpkg-deb, id and cargo are files
//! of a few lines, and nothing leaves this computer.

use super::{made, script};
use nekton_steps::Outcome;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A machine in a folder of its own, removed at the end.
struct Machine(PathBuf);

const TARGET: &str = "bare-none";

impl Machine {
    /// Package lists that offer a version (empty: none), servers that have one, and lists that `apt-get update` brings.
    fn new(name: &str, lists: &str, servers: &str, root: bool) -> Self {
        let place = std::env::temp_dir().join(format!("nekton-bare-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&place);
        std::fs::create_dir_all(place.join("bin")).unwrap();
        let machine = Machine(place);
        machine.write("lists", lists);
        machine.write("servers", servers);
        machine.program("id", if root { "echo 0" } else { "echo 1000" });
        machine.program(
            "apt-cache",
            r#"version=$(cat "$here/lists")
case $1 in
policy) echo "$2:"; echo "  Installed: (none)"; echo "  Candidate: ${version:-(none)}" ;;
depends) echo "$2"; echo "  Depends: libc6"; echo "  Depends: libllvm19" ;;
esac"#,
        );
        // As with servers that have replaced a package: the older version is not found.
        machine.program(
            "apt-get",
            r#"echo "$1" >> "$here/log"
case $1 in
update) cp "$here/servers" "$here/lists" ;;
download)
    grep -qx "$(cat "$here/lists")" "$here/servers" || { echo "404  Not Found" >&2; exit 100; }
    for package in "$@"; do
        case $package in rustc-web=*) cp "$here/lists" rustc-web.deb ;; *) : > "${package%%=*}.deb" ;; esac
    done ;;
esac"#,
        );
        // Unpacks a compiler that says its version.
        machine.program(
            "dpkg-deb",
            r#"mkdir -p "$3/usr/bin" "$3/usr/lib/x-linux-gnu"
case $2 in */rustc-web.deb)
    version=$(sed 's/+.*//' "$2")
    printf '#!/bin/sh\necho "rustc %s (made up)"\n' "$version" > "$3/usr/bin/rustc"
    chmod +x "$3/usr/bin/rustc" ;;
esac"#,
        );
        // Compiles `core`: notes by which compiler.
        machine.program(
            "cargo",
            r#"mkdir -p "target/bare-none/release/deps"
for library in core alloc compiler_builtins; do
    "$RUSTC" --version > "target/bare-none/release/deps/lib$library-1.rlib"
done"#,
        );
        machine
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), format!("{text}\n")).unwrap();
    }

    fn program(&self, name: &str, lines: &str) {
        use std::os::unix::fs::PermissionsExt;
        let file = self.0.join("bin").join(name);
        std::fs::write(&file, format!("#!/bin/sh\nhere='{}'\n{lines}\n", self.0.display())).unwrap();
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o755)).unwrap();
    }

    /// Runs the script on the machine; a name that is not made up is taken from this computer.
    fn make(&self, least: &str) -> Result<(), Outcome> {
        let path = format!("{}:/usr/bin:/bin", self.0.join("bin").display());
        let mut script = script(&self.0.join("toolchain"), least, TARGET);
        made(script.env("PATH", path).env_remove("CARGO").stdout(Stdio::null()), TARGET)
    }

    /// The version of the compiler, and of the one that `core` was compiled with.
    fn versions(&self) -> [String; 2] {
        let said = Command::new(self.0.join("toolchain/bin/rustc")).arg("--version").output().unwrap();
        let core = Path::new("toolchain/root/usr/lib/rustlib").join(TARGET).join("lib/libcore-1.rlib");
        let core = std::fs::read_to_string(self.0.join(core)).unwrap_or_default();
        [String::from_utf8(said.stdout).unwrap(), core].map(|line| line.split(' ').nth(1).unwrap_or("").to_string())
    }

    /// What apt-get was asked for, in order.
    fn log(&self) -> String {
        std::fs::read_to_string(self.0.join("log")).unwrap_or_default().replace('\n', " ")
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn skipped(made: Result<(), Outcome>) -> String {
    match made {
        Err(Outcome::Skipped(why)) => why,
        Err(Outcome::Failed(why)) => panic!("failed: {why}"),
        _ => panic!("made"),
    }
}

#[test]
fn lists_that_are_new_enough_are_taken_as_they_are_and_what_is_fit_is_kept() {
    let machine = Machine::new("new", "1.90.0+dfsg1-1", "1.90.0+dfsg1-1", true);
    assert!(machine.make("1.89").is_ok());
    assert_eq!(machine.versions(), ["1.90.0"; 2]);
    assert!(machine.make("1.89").is_ok());
    assert_eq!(machine.log(), "download ");
    // 1.9 is older than 1.90, and 1.100 newer.
    assert!(machine.make("1.9").is_ok() && machine.make("1.90").is_ok());
    skipped(machine.make("1.100"));
}

#[test]
fn lists_that_are_too_old_or_empty_are_made_new() {
    for (name, old) in [("old", "1.85.0+dfsg3-1~deb12u3"), ("empty", "")] {
        let machine = Machine::new(name, old, "1.89.0+dfsg1-1", true);
        assert!(machine.make("1.89").is_ok(), "{name}");
        assert_eq!(machine.versions(), ["1.89.0"; 2]);
        assert_eq!(machine.log(), "update download ");
    }
}

#[test]
fn what_the_servers_no_longer_have_is_looked_for_in_new_lists() {
    let machine = Machine::new("gone", "1.89.0+dfsg1-1", "1.91.0+dfsg1-1", true);
    assert!(machine.make("1.89").is_ok());
    assert_eq!(machine.versions(), ["1.91.0"; 2]);
    assert_eq!(machine.log(), "download update download ");
}

#[test]
fn an_unpacked_compiler_that_is_too_old_is_replaced_with_all_that_was_made_with_it() {
    let machine = Machine::new("replaced", "1.85.0+dfsg3-1", "1.85.0+dfsg3-1", true);
    assert!(machine.make("1.84").is_ok());
    assert_eq!(machine.versions(), ["1.85.0"; 2]);
    machine.write("servers", "1.90.0+dfsg1-1");
    assert!(machine.make("1.89").is_ok());
    assert_eq!(machine.versions(), ["1.90.0"; 2]);
    // One that does not run is as good as none.
    std::fs::write(machine.0.join("toolchain/root/usr/bin/rustc"), "#!/bin/sh\nexit 1\n").unwrap();
    assert!(machine.make("1.89").is_ok());
    assert_eq!(machine.versions(), ["1.90.0"; 2]);
}

#[test]
fn where_no_fit_compiler_can_be_had_the_step_is_skipped_and_says_what_would_help() {
    let root = Machine::new("unfit-root", "1.85.0+dfsg3-1", "1.86.0+dfsg1-1", true);
    let why = skipped(root.make("1.89"));
    assert!(why.contains("rustup target add bare-none"), "{why}");
    assert!(
        why.contains("even the new package lists offer rustc-web 1.86.0+dfsg1-1, 1.89 or newer is needed"),
        "{why}"
    );
    assert_eq!(root.log(), "update ");

    let user = Machine::new("unfit-user", "1.85.0+dfsg3-1", "1.90.0+dfsg1-1", false);
    let why = skipped(user.make("1.89"));
    assert!(why.contains("offer rustc-web 1.85.0+dfsg3-1") && why.contains("apt-get update, as root"), "{why}");
    assert_eq!(user.log(), "");

    let none = Machine::new("none", "", "", true);
    assert!(skipped(none.make("1.89")).contains("rustc-web not at all"));
}

#[test]
fn a_fit_compiler_that_cannot_be_made_ready_is_a_failure() {
    let machine = Machine::new("broken", "1.90.0+dfsg1-1", "1.90.0+dfsg1-1", true);
    machine.program("cargo", "echo 'core does not compile' >&2; exit 101");
    assert!(matches!(machine.make("1.89"), Err(Outcome::Failed(why)) if why.contains("core does not compile")));
}
