#!/bin/sh
# A private compiler for targets without an operating system, for machines whose own compiler has no `core` library
# for them: Debian's rustc with the source of `core`, unpacked (not installed) in a folder, and `core` compiled once
# per target. Idempotent: what is there already is not made again, unless it is older than LEAST.
#
#   sh xtask/bare-toolchain.sh FOLDER LEAST TARGET...
#   RUSTC=FOLDER/bin/rustc cargo build --target TARGET ...
#
# Needs apt-get and dpkg-deb with package lists that know a `rustc-web` of version LEAST or newer, cargo and cc. Root is
# needed only where the lists are too old. About 150 MB of packages, 1 GB unpacked.
# Exit status 3: no such compiler can be had here; the last line of the errors says why.
set -eu
[ $# -ge 3 ] || { echo "usage: $0 FOLDER LEAST TARGET..." >&2; exit 2; }
mkdir -p "$1/packages" "$1/bin" "$1/seed/src"
folder=$(cd "$1" && pwd)
least=$2
shift 2

unfit() { echo "$*" >&2; exit 3; }
# Whether a version is LEAST or newer.
fits() { [ -n "$1" ] && [ "$(printf '%s\n' "$least" "$1" | sort -V | head -n 1)" = "$least" ]; }

# The unpacked compiler finds its own libraries only when told where they are.
cat > "$folder/bin/rustc.new" <<'WRAPPER'
#!/bin/sh
root=$(cd "$(dirname "$0")/../root/usr" && pwd)
LD_LIBRARY_PATH="$(echo "$root"/lib/*-linux-gnu)${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$root/bin/rustc" "$@"
WRAPPER
chmod +x "$folder/bin/rustc.new"
cmp -s "$folder/bin/rustc.new" "$folder/bin/rustc" 2>/dev/null || cp -p "$folder/bin/rustc.new" "$folder/bin/rustc"
rm "$folder/bin/rustc.new"

candidate() { apt-cache policy rustc-web | sed -n 's/^ *Candidate: *//p' | grep -v '(none)' || true; }
# New package lists, once, where that is allowed.
updated=no
update() {
    [ "$updated" = no ] && [ "$(id -u)" = 0 ] || return 1
    updated=yes
    apt-get update -q || echo "apt-get update failed" >&2
}
# One version for compiler, libraries and source: a compiler only builds the `core` of its own version.
download() {
    short=$(echo "$version" | cut -d. -f1,2)
    llvm=$(apt-cache depends "libstd-rust-web-$short" rustc-web | sed -n 's/.*Depends: *\(libllvm[0-9.]*\)$/\1/p' | head -n 1)
    [ -n "$llvm" ] || unfit "rustc-web $version names no LLVM"
    rm -f "$folder"/packages/*
    (cd "$folder/packages" && apt-get download -q \
        "rustc-web=$version" "rust-web-src=$version" "libstd-rust-web-dev=$version" "libstd-rust-web-$short=$version" "$llvm")
}

# The compiler itself is asked, so that no note beside it can be wrong.
unpacked=
[ ! -e "$folder/unpacked" ] || unpacked=$("$folder/bin/rustc" --version 2>/dev/null | cut -d' ' -f2) || unpacked=
if ! fits "$unpacked"; then
    [ -z "$unpacked" ] || echo "the unpacked compiler $unpacked is older than $least: another one is looked for"
    command -v apt-get >/dev/null && command -v apt-cache >/dev/null && command -v dpkg-deb >/dev/null \
        || unfit "this is no Debian: there is no apt-get, apt-cache or dpkg-deb"
    version=$(candidate)
    if ! fits "$version" && update; then version=$(candidate); fi
    if ! fits "$version"; then
        [ "$updated" = yes ] || unfit "the package lists offer rustc-web ${version:-not at all}, $least or newer is needed;" \
            "apt-get update, as root, may bring it"
        unfit "even the new package lists offer rustc-web ${version:-not at all}, $least or newer is needed"
    fi
    # What stale lists name may be gone from the servers.
    if ! download; then
        update || unfit "rustc-web $version cannot be downloaded; apt-get update, as root, may help"
        version=$(candidate)
        fits "$version" || unfit "the new package lists offer rustc-web ${version:-not at all}, $least or newer is needed"
        download || unfit "rustc-web $version cannot be downloaded"
    fi
    # Also what was made with the old one goes: `core` for each target, and the lock file of its build.
    rm -rf "$folder/unpacked" "$folder/root" "$folder/seed/Cargo.lock" "$folder/seed/target"
    for package in "$folder"/packages/*.deb; do dpkg-deb -x "$package" "$folder/root"; done
    rm -f "$folder"/packages/*.deb
    "$folder/bin/rustc" --version >/dev/null || { echo "the unpacked rustc-web $version does not run" >&2; exit 1; }
    touch "$folder/unpacked"
fi
"$folder/bin/rustc" --version

# `core` for each target, by way of an empty crate; copied to where the compiler looks for it.
printf '[package]\nname = "seed"\nversion = "0.0.0"\nedition = "2024"\n[profile.release]\npanic = "abort"\n[workspace]\n' \
    > "$folder/seed/Cargo.toml"
echo '#![no_std]' > "$folder/seed/src/lib.rs"
for target in "$@"; do
    place="$folder/root/usr/lib/rustlib/$target/lib"
    [ -d "$place" ] && continue
    # With bitcode, so that link-time optimization reaches into `core`.
    (cd "$folder/seed" && env -u CARGO_ENCODED_RUSTFLAGS -u CARGO_TARGET_DIR -u RUSTUP_TOOLCHAIN RUSTC="$folder/bin/rustc" \
        RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Cembed-bitcode=yes "${CARGO:-cargo}" build --release --target "$target" \
        -Z build-std=core,alloc -Z build-std-features=compiler-builtins-mem)
    rm -rf "$place.new" && mkdir -p "$place.new"
    for library in core alloc compiler_builtins; do
        cp "$folder/seed/target/$target/release/deps/lib$library"-*.rlib "$place.new/"
    done
    mv "$place.new" "$place"
done
rm -rf "$folder/seed/target"
