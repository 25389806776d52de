#!/usr/bin/env python3
"""Measures every technique on the same shots: error against ray-traced truth, and time of the visibility passes.

Writes techniques.csv and techniques.md to the output folder, row by row: interrupted and started again it goes on
where it was. Truth is traced once and kept in the folder's `truth/`.

    tools/measure_techniques.py -o benches/results/lavapipe scenes/*.json
"""

import argparse
import csv
import json
import subprocess
import sys
from pathlib import Path

TECHNIQUES = {
    "packet-contour S=1": ["--split", "1"],
    "packet-contour S=2": ["--split", "2"],
    "packet-contour S=4": ["--split", "4"],
    "pixel-contour": ["--technique", "pixel-contour"],
    "pixel-contour hierarchical": ["--technique", "pixel-contour", "--hierarchical"],
    "micropatch": ["--technique", "micropatch"],
    "micropatch with gaps": ["--technique", "micropatch", "--no-gap-filling"],
    "micropatch-hierarchical": ["--technique", "micropatch-hierarchical"],
    "bitmask 8x8": ["--technique", "bitmask", "--light-samples", "8"],
    "bitmask 16x16": ["--technique", "bitmask"],
    "bitmask 16x16, 2 layers": ["--technique", "bitmask", "--layers", "2"],
    "depth-peeling, 4 layers": ["--technique", "depth-peeling"],
    "depth-peeling, 2 layers of contours": ["--technique", "depth-peeling", "--layers", "2", "--occluders", "contours"],
    "pcss 16+32": ["--technique", "pcss"],
    "hard": ["--technique", "hard"],
    "hard 3x3": ["--technique", "hard", "--percentage-closer"],
    "reference-maps 256": ["--technique", "reference-maps", "--maps", "256"],
}
COLUMNS = ["shot", "technique", "mae", "rmse", "bias", "p99", "visibility_ms", "min_ms", "max_ms", "samples_per_pixel", "device", "note"]


def run(command, seconds):
    """Standard output of a command, or an error's last line."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"took more than {seconds} s") from None
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return done.stdout


def visibility_times(stats):
    """Median, least and largest sum of the passes that integrate visibility, in ms."""
    passes = [entry["gpu_ms"] for entry in stats["passes"] if "visibility" in entry["name"]]
    return [sum(entry[key] for entry in passes) for key in ("median", "min", "max")]


def measure(args, shot, flags, truth, scratch):
    """One row, without its names."""
    visibility, stats_file = scratch / "visibility.exr", scratch / "stats.json"
    render = [args.program, "render", shot, "--size", args.size, "--map", str(args.map), "--light", "0", *flags]
    render += ["--visibility", visibility, "--stats", stats_file]
    run([*render, "--repeat", str(args.repeat)], args.seconds)
    stats = json.loads(stats_file.read_text())
    median, least, most = visibility_times(stats)
    metrics = json.loads(run([args.program, "compare", visibility, truth, "--facing", "--json"], 60))
    # Counting takes time, so it is a run of its own.
    run([*render, "--counters"], args.seconds)
    counters = json.loads(stats_file.read_text())["counters"]
    pixels = max(counters["pixels"], 1)
    return {
        **metrics_of(metrics),
        "visibility_ms": f"{median:.1f}",
        "min_ms": f"{least:.1f}",
        "max_ms": f"{most:.1f}",
        "samples_per_pixel": f"{counters['samples_read'] / pixels:.1f}",
        "device": f"{stats['device']}, {stats['driver']}",
    }


def metrics_of(metrics):
    return {
        "mae": f"{metrics['mae_shadow']:.4f}",
        "rmse": f"{metrics['rmse_shadow']:.4f}",
        "bias": f"{metrics['bias_shadow']:+.4f}",
        "p99": f"{metrics['p99']:.3f}",
    }


def write_markdown(args, rows):
    """Tables by shot."""
    device = next((row["device"] for row in rows if row["device"]), "unknown")
    lines = [
        "# Every technique on the same shots",
        "",
        f"Device: {device}. Image {args.size}, map {args.map}², {args.repeat} timed frames, one light. Error over shadow",
        f"pixels that face the whole light, against {args.samples} rays a pixel; time: median (least to largest) of the",
        "visibility passes; samples: depths and depth bounds read by them for each pixel and view.",
    ]
    shots = list(dict.fromkeys(row["shot"] for row in rows))
    for shot in shots:
        lines += ["", f"## {shot}", "", "| technique | MAE | RMSE | bias | 99 % | ms | samples |", "|---|---|---|---|---|---|---|"]
        for row in (row for row in rows if row["shot"] == shot):
            if row["note"]:
                lines.append(f"| {row['technique']} | {row['note']} | | | | | |")
                continue
            time = f"{row['visibility_ms']} ({row['min_ms']} to {row['max_ms']})"
            cells = [row[key] for key in ("technique", "mae", "rmse", "bias", "p99")]
            lines.append("| " + " | ".join([*cells, time, row["samples_per_pixel"]]) + " |")
    (args.output / "techniques.md").write_text("\n".join(lines) + "\n")


def truth_of(args, shot):
    folder = args.output / "truth"
    folder.mkdir(exist_ok=True)
    truth = folder / f"{Path(shot).stem}-{args.size}-{args.samples}.exr"
    if not truth.exists():
        print(f"tracing {truth}", file=sys.stderr)
        run([args.program, "reference", shot, "-o", truth, "--size", args.size, "--samples", str(args.samples)], 3600)
    return truth


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shots", nargs="+", metavar="SHOT")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder of the results")
    parser.add_argument("--program", default="target/release/halfshade", help="default: %(default)s")
    parser.add_argument("--size", default="256x256", help="default: %(default)s")
    parser.add_argument("--map", type=int, default=512, help="default: %(default)s")
    parser.add_argument("--samples", type=int, default=1024, help="rays a pixel; default: %(default)s")
    parser.add_argument("--repeat", type=int, default=5, help="timed frames; default: %(default)s")
    parser.add_argument("--seconds", type=int, default=300, help="that a run may take; default: %(default)s")
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    table = args.output / "techniques.csv"
    rows = list(csv.DictReader(table.open())) if table.exists() else []
    with table.open("a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        if not rows:
            writer.writeheader()
        try:
            for row in missing_rows(args, rows):
                print(row, file=sys.stderr)
                writer.writerow(row)
                file.flush()
                rows.append(row)
        except KeyboardInterrupt:
            print("interrupted; run again to go on", file=sys.stderr)
    write_markdown(args, rows)


def missing_rows(args, rows):
    """Measures what the table lacks, row by row."""
    known = {(row["shot"], row["technique"]) for row in rows}
    for shot in args.shots:
        truth = truth_of(args, shot)
        for technique, flags in TECHNIQUES.items():
            row = dict.fromkeys(COLUMNS, "") | {"shot": Path(shot).stem, "technique": technique}
            if (row["shot"], technique) in known:
                continue
            try:
                row |= measure(args, shot, flags, truth, args.output / "truth")
            except RuntimeError as error:
                row["note"] = str(error)
            yield row


if __name__ == "__main__":
    main()
