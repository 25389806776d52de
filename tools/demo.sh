#!/usr/bin/env bash
# Installs what is missing, builds, and renders the demo shots to out/: for each a picture, the
# visibility of its light, and what it cost. `tools/demo.sh tree` renders only that one.
set -euo pipefail
# shellcheck source=tools/setup.sh
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

shots=("$@")
if [ ${#shots[@]} -eq 0 ]; then
    shots=(colonnade tree knot)
fi
# Asked of cargo, because a user may keep build folders elsewhere.
echo "demo: building"
program=$(cargo build --release --bin halfshade --message-format=json-render-diagnostics |
    sed -n 's/.*"executable":"\([^"]*\)".*/\1/p' | tail -n 1)
mkdir -p out
for shot in "${shots[@]}"; do
    echo "demo: $shot"
    "$program" render "scenes/$shot.json" --size 512x512 --output "out/$shot.png" \
        --visibility "out/$shot.exr" --stats "out/$shot.stats.json"
done
echo "demo: wrote to $PWD/out:"
for shot in "${shots[@]}"; do
    echo "  $shot.png (the picture), $shot.exr (visibility), $shot.stats.json (times and memory)"
done
