#!/usr/bin/env bash
# Installs what the build, the demo and the tests need and is not there yet; sourced by demo.sh and
# test.sh. Safe to run twice: the second run only looks.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(mesa-vulkan-drivers libvulkan1 vulkan-validationlayers libshaderc-dev glslang-dev
          spirv-tools binutils cmake ninja-build g++)

install_packages() {
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || {
        echo "setup: not a Debian-like system; please install the equivalents of: ${packages[*]}" >&2
        return 0
    }
    local missing=() name
    for name in "${packages[@]}"; do
        dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    echo "setup: installing ${missing[*]}"
    local sudo=()
    [ "$(id -u)" -eq 0 ] || sudo=(sudo)
    "${sudo[@]}" apt-get update -qq
    DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

# Debian's libshaderc is underlinked, so linking it fails; its static archives, merged into one, do
# link. That saves the 5 to 8 minutes of building shaderc from source.
merge_shaderc() {
    local out=target/shaderc from name archives=()
    [ -e "$out/libshaderc_combined.a" ] && return 0
    from=/usr/lib/$(uname -m)-linux-gnu
    for name in shaderc_combined glslang SPIRV OSDependent MachineIndependent GenericCodeGen \
                OGLCompiler SPIRV-Tools-opt SPIRV-Tools; do
        [ -e "$from/lib$name.a" ] || {
            echo "setup: $from/lib$name.a is not there; shaderc will be built from source (5 to 8 minutes)"
            return 0
        }
        archives+=("ADDLIB $from/lib$name.a")
    done
    echo "setup: merging the static shaderc archives into $out"
    mkdir -p "$out"
    # The temporary name keeps an interrupted merge from being taken for a finished one.
    printf '%s\n' "CREATE $out/merging.a" "${archives[@]}" SAVE END | ar -M
    mv "$out/merging.a" "$out/libshaderc_combined.a"
    # A shaderc-sys built before the folder existed is linked to what it found then.
    cargo clean -q -p shaderc-sys 2>/dev/null || true
    cargo clean -q --release -p shaderc-sys 2>/dev/null || true
}

command -v cargo >/dev/null || { echo "setup: cargo is not there; install Rust from https://rustup.rs" >&2; exit 1; }
install_packages
merge_shaderc
