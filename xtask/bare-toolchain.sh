#!/bin/sh
# A private compiler for targets without an operating system, for machines whose own compiler has no `core` library
# for them: Debian's rustc with the source of `core`, unpacked (not installed) in a folder, and `core` compiled once
# per target. Idempotent: what is there already is not made again.
#
#   sh xtask/bare-toolchain.sh FOLDER TARGET...
#   RUSTC=FOLDER/bin/rustc cargo build --target TARGET ...
#
# Needs apt-get and dpkg-deb with package lists that know `rustc-web`, cargo and cc; no root. About 150 MB of packages,
# 1 GB unpacked.
set -eu
[ $# -ge 2 ] || { echo "usage: $0 FOLDER TARGET..." >&2; exit 2; }
mkdir -p "$1/packages" "$1/bin" "$1/seed/src"
folder=$(cd "$1" && pwd)
shift

# One version for compiler, libraries and source: a compiler only builds the `core` of its own version.
if [ ! -e "$folder/unpacked" ]; then
    candidate() { apt-cache policy rustc-web | sed -n 's/^ *Candidate: *//p' | grep -v '(none)' || true; }
    version=$(candidate)
    if [ -z "$version" ] && [ "$(id -u)" = 0 ]; then
        apt-get update -q
        version=$(candidate)
    fi
    [ -n "$version" ] || { echo "no package rustc-web; apt-get update may help" >&2; exit 1; }
    short=$(echo "$version" | cut -d. -f1,2)
    llvm=$(apt-cache depends "libstd-rust-web-$short" rustc-web | sed -n 's/.*Depends: *\(libllvm[0-9.]*\)$/\1/p' | head -n 1)
    [ -n "$llvm" ] || { echo "rustc-web $version names no LLVM" >&2; exit 1; }
    rm -rf "$folder/root" "$folder"/packages/*
    (cd "$folder/packages" && apt-get download -q \
        "rustc-web=$version" "rust-web-src=$version" "libstd-rust-web-dev=$version" "libstd-rust-web-$short=$version" "$llvm")
    for package in "$folder"/packages/*.deb; do dpkg-deb -x "$package" "$folder/root"; done
    rm -f "$folder"/packages/*.deb
    touch "$folder/unpacked"
fi

# The unpacked compiler finds its own libraries only when told where they are.
cat > "$folder/bin/rustc.new" <<'WRAPPER'
#!/bin/sh
root=$(cd "$(dirname "$0")/../root/usr" && pwd)
LD_LIBRARY_PATH="$(echo "$root"/lib/*-linux-gnu)${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" exec "$root/bin/rustc" "$@"
WRAPPER
chmod +x "$folder/bin/rustc.new"
cmp -s "$folder/bin/rustc.new" "$folder/bin/rustc" 2>/dev/null || cp -p "$folder/bin/rustc.new" "$folder/bin/rustc"
rm "$folder/bin/rustc.new"
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
