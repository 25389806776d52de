#!/usr/bin/env bash
# Writes include/halfshade.h and include/halfshade_vulkan.h anew from src/c_api. The tests compare them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
HALFSHADE_WRITE_HEADERS=1 cargo test --quiet --test c_api header::
