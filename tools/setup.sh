#!/usr/bin/env bash
# Installs what the build, the demo and the tests need and is not there yet; sourced by demo.sh and
# test.sh, which it takes to the root of the repository. Safe to run twice: the second run only looks.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# A C++ compiler and ar, a Vulkan driver that runs anywhere, the validation layer, and the archives
# that make up a shader compiler.
packages=(g++ binutils libvulkan1 mesa-vulkan-drivers vulkan-validationlayers
          libshaderc-dev glslang-dev spirv-tools)
# What the tests of the C library take: Vulkan's headers, what finds installed libraries, numpy for the script.
test_packages=(libvulkan-dev pkg-config cmake make python3-numpy)
# What only `tools/test.sh --slow` takes.
slow_packages=(valgrind)
# What building the shader compiler from source takes, where the archives are of no use.
source_packages=(cmake ninja-build git python3)

# Installs those of the named packages that are not there.
install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "setup: not a Debian-like system; please install the equivalents of: $*" >&2
        return 0
    fi
    local missing=() name status
    for name in "$@"; do
        status=$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null || true)
        [ "$status" = installed ] || missing+=("$name")
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return 0
    fi
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "setup: please run as root: apt-get install ${missing[*]}" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "setup: installing ${missing[*]}"
    # A package source that is down must not keep the others from being used.
    "${as_root[@]}" apt-get update -qq || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# Whether the archive in folder $1 has all of a shader compiler.
links() {
    local source=$1/probe.c
    printf '%s\n' 'void *shaderc_compiler_initialize(void);' \
        'void *shaderc_compile_into_spv(void *, const char *, unsigned long, int, const char *, const char *, void *);' \
        'int main(void) { return !shaderc_compile_into_spv(shaderc_compiler_initialize(), "", 0, 0, "", "main", 0); }' \
        >"$source"
    c++ -x c "$source" -x none -o "$1/probe" "-L$1" -lshaderc_combined -lpthread >"$1/probe.log" 2>&1
}

# The distribution's libshaderc is underlinked, so linking it fails; the static archives that it is
# made of, merged into one, do link. That saves the 5 to 8 minutes of building shaderc from source.
merge_shaderc() {
    local out=target/shaderc from name archives=()
    if [ -e "$out/libshaderc_combined.a" ]; then
        return 0
    fi
    from=/usr/lib/$(uname -m)-linux-gnu
    # Which of them there are depends on the version of glslang; linking tells whether any is lacking.
    for name in shaderc_combined glslang SPIRV OSDependent MachineIndependent GenericCodeGen \
                OGLCompiler SPIRV-Tools-opt SPIRV-Tools; do
        if [ -e "$from/lib$name.a" ]; then
            archives+=("ADDLIB $from/lib$name.a")
        fi
    done
    if [ ! -e "$from/libshaderc_combined.a" ]; then
        build_shaderc_from_source "$from/libshaderc_combined.a is not there"
        return
    fi
    echo "setup: merging the static shaderc archives into $out"
    # The temporary folder keeps an interrupted merge from being taken for a finished one.
    rm -rf "$out.merging"
    mkdir -p "$out.merging"
    printf '%s\n' "CREATE $out.merging/libshaderc_combined.a" "${archives[@]}" SAVE END | ar -M
    if ! links "$out.merging"; then
        rm -rf "$out.merging"
        build_shaderc_from_source "the archives in $from do not link"
        return
    fi
    rm -f "$out.merging"/probe*
    rm -rf "$out"
    mv "$out.merging" "$out"
    # A shaderc-sys built before the folder existed is linked to what it found then. Where none was
    # built there is nothing to clean.
    cargo clean -q -p shaderc-sys 2>/dev/null || true
    cargo clean -q --release -p shaderc-sys 2>/dev/null || true
}

# Says why; cargo does the building.
build_shaderc_from_source() {
    echo "setup: $1; shaderc will be built from source (5 to 8 minutes, once)"
    install_packages "${source_packages[@]}"
}

if ! command -v cargo >/dev/null && [ -e "$HOME/.cargo/env" ]; then
    # shellcheck source=/dev/null
    . "$HOME/.cargo/env"
fi
if ! command -v cargo >/dev/null; then
    echo "setup: cargo is not there; install Rust from https://rustup.rs" >&2
    exit 1
fi
install_packages "${packages[@]}"
merge_shaderc
