#!/usr/bin/env bash
# Installs what is missing, then checks everything that a change must keep: format, lints, the lean
# library, all tests. Stops at the first failure and says which step it was.
set -euo pipefail

if [ $# -gt 0 ]; then
    case $1 in
        -h | --help)
            echo "usage: tools/test.sh"
            echo "Checks format and lints, builds the library without the program, and runs all tests."
            echo "GPU tests run on any Vulkan device, lavapipe included; without one they fail."
            exit 0
            ;;
        *)
            echo "test: unknown argument $1; see tools/test.sh --help" >&2
            exit 2
            ;;
    esac
fi
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# Tests have few pixels and many pipelines: without optimising them lavapipe takes half the time.
export GALLIVM_PERF=nopt

# A browser for the test of the study's page.
install_packages chromium chromium-driver fonts-dejavu-core

step() {
    echo "test: $*"
    local start=$SECONDS
    if ! "$@"; then
        echo "test: FAILED: $*" >&2
        exit 1
    fi
    echo "test: passed in $((SECONDS - start)) s: $*"
}

step cargo fmt --check
step cargo clippy --all-targets -- -D warnings
step cargo check --lib --no-default-features
step cargo test
echo "test: all passed"
