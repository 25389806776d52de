#!/usr/bin/env bash
# What the passes of the built-in shots cost on an AMD NAVI21, as Mesa's RADV compiles them without one, against the committed table.
# Fails when a pass takes a tenth more than there, or other passes run. UPDATE_GOLDENS=1 writes the table.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

table=benches/results/radv-navi21/static_cost.csv
driver=/usr/share/vulkan/icd.d/radeon_icd.x86_64.json
# A shot of each kind of light and surface, and one of a single view: what a scene does not need is not compiled in.
shots=("plate" "plate --split 1" "knot" "knot --technique pcss" "colonnade" "tree" "staircase" "grid --near-points 0")

if [ ! -e "$driver" ]; then
    echo "static_cost: $driver is missing: install Mesa's Vulkan drivers (mesa-vulkan-drivers)" >&2
    exit 1
fi
cargo build --quiet --bin halfshade
found=$(mktemp)
trap 'rm -f "$found"' EXIT
for shot in "${shots[@]}"; do
    read -r name flags <<<"$shot"
    # shellcheck disable=SC2086 # Flags are words.
    VK_DRIVER_FILES=$driver RADV_FORCE_FAMILY=navi21 target/debug/halfshade shaders "scenes/$name.json" $flags --csv |
        if [ -s "$found" ]; then sed 1d; else sed '1s/^/shot,/'; fi |
        sed "/^shot,/!s/^/$shot,/" >>"$found"
done
if [ -n "${UPDATE_GOLDENS-}" ]; then
    cp "$found" "$table"
    exit
fi
# Rows stand in the same order where the same passes run.
awk -F, '
    NR == FNR { if (FNR == 1) for (i = 1; i <= NF; ++i) column[$i] = i; wanted[FNR] = $0; rows = FNR; next }
    FNR == 1 { next }
    {
        split(wanted[FNR], old, ",")
        if (old[1] "," old[2] "," old[3] "," old[4] != $1 "," $2 "," $3 "," $4) {
            printf "static_cost: %s runs %s %s %s times, where the table has: %s\n", $1, $2, $4, $3, wanted[FNR]
            bad = 1
            exit
        }
        count = split("VGPRs|Spilled SGPRs|Spilled VGPRs|LDS size|Scratch size|Instructions", names, "|")
        for (i = 1; i <= count; ++i) {
            c = column[names[i]]
            if ($c > 1.1 * old[c] + 1e-9) {
                printf "static_cost: %s: %s of %s (%s) grew from %s to %s\n", $1, names[i], $2, $4, old[c], $c
                bad = 1
            }
        }
    }
    END {
        if (!bad && FNR != rows) { print "static_cost: the table has " rows " rows, now there are " FNR; bad = 1 }
        if (bad) print "static_cost: if that should be, run UPDATE_GOLDENS=1 tools/static_cost.sh"
        exit bad
    }' "$table" "$found" >&2
