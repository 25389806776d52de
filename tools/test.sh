#!/usr/bin/env bash
# Installs what is missing, then checks everything that a change must keep: format, lints, the lean
# library, all tests. Stops at the first failure and says which step it was.
set -euo pipefail

usage() {
    echo "usage: tools/test.sh [--slow | --static-cost | --driver NAME | --width BITS | --gpu-av]"
    echo "Checks format and lints, builds the library without the program, and runs all tests."
    echo "GPU tests run on any Vulkan device, lavapipe included; without one they fail."
    echo
    echo "Runs of their own, of tests alone:"
    echo "  --slow         the exhaustive versions of the tests that have one"
    echo "  --static-cost  registers, spills and instructions of all passes on a GPU that need not be there"
    echo "  --driver NAME  the tests that render, on another driver: swiftshader, which is fetched"
    echo "  --width BITS   the same on lavapipe with vectors of 128 or 256 bits: subgroups of 4 or 8"
    echo "  --gpu-av       the same under GPU-assisted validation, which finds accesses out of bounds"
}

mode=all
case ${1-} in
    "") ;;
    -h | --help)
        usage
        exit 0
        ;;
    --slow | --static-cost | --gpu-av) mode=${1#--} ;;
    --driver | --width)
        mode=${1#--}
        value=${2-}
        shift
        ;;
    *)
        echo "test: unknown argument $1; see tools/test.sh --help" >&2
        exit 2
        ;;
esac
if [ $# -gt 1 ]; then
    echo "test: one run at a time; see tools/test.sh --help" >&2
    exit 2
fi
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# Tests have few pixels and many pipelines: without optimising them lavapipe takes half the time.
export GALLIVM_PERF=nopt

# A browser for the test of the study's page.
install_packages chromium chromium-driver fonts-dejavu-core
install_packages "${test_packages[@]}"
if [ "$mode" = slow ]; then
    install_packages "${slow_packages[@]}"
fi

step() {
    echo "test: $*"
    local start=$SECONDS
    if ! "$@"; then
        echo "test: FAILED: $*" >&2
        exit 1
    fi
    echo "test: passed in $((SECONDS - start)) s: $*"
}

# What `cargo doc` says, without warnings.
documentation() {
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --all-features --lib
}

# The tests that have a longer version, at full length.
slow_tests() {
    HALFSHADE_SLOW=1 cargo test --bin halfshade --test mutants --test faults --test cycles --test c_api
}

# The tests whose results a driver could change.
rendering_tests() {
    cargo test --test canary --test passes --test agreement --test closed_forms --test properties \
        --test techniques --test effect --test drivers --test faults --test cycles --test irradiance
}

# Debian's Chromium brings a second Vulkan driver, which needs no installation.
fetch_swiftshader() {
    local out=target/swiftshader package=chromium-common
    if [ ! -e "$out/icd.json" ]; then
        echo "test: fetching SwiftShader from Debian's package $package into $out"
        rm -rf "$out.fetching"
        mkdir -p "$out.fetching"
        (cd "$out.fetching" && apt-get download -qq "$package" && dpkg-deb -x "$package"_*.deb .)
        printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.3.0"}}\n' \
            "$PWD/$out/usr/lib/chromium/libvk_swiftshader.so" >"$out.fetching/icd.json"
        rm -rf "$out" "$out.fetching"/*.deb
        mv "$out.fetching" "$out"
    fi
    export VK_DRIVER_FILES=$PWD/$out/icd.json
}

case $mode in
    all)
        step cargo fmt --check
        step cargo clippy --all-targets -- -D warnings
        step cargo check --lib --no-default-features
        step cargo check --lib --no-default-features --features capi
        step documentation
        step cargo test
        ;;
    slow) step slow_tests ;;
    static-cost) step tools/static_cost.sh ;;
    driver)
        if [ "$value" != swiftshader ]; then
            echo "test: the other driver is swiftshader, not \"$value\"" >&2
            exit 2
        fi
        step fetch_swiftshader
        step rendering_tests
        ;;
    width)
        case $value in
            128 | 256) ;;
            *)
                echo "test: lavapipe draws with vectors of 128 or 256 bits, not \"$value\": see docs/drivers.md" >&2
                exit 2
                ;;
        esac
        # The driver's cache of compiled shaders does not tell widths apart.
        export LP_NATIVE_VECTOR_WIDTH=$value MESA_SHADER_CACHE_DIR=$PWD/target/shaders-$value
        step rendering_tests
        ;;
    gpu-av)
        # The layer rewrites shaders, which breaks loops of optimized ones (its blocks are split in the wrong
        # place), and which is of no use to other runs.
        export HALFSHADE_UNOPTIMIZED_SHADERS=1 MESA_SHADER_CACHE_DISABLE=1
        export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT
        step rendering_tests
        ;;
esac
echo "test: all passed"
