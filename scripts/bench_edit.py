#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How long a dab of a brush takes, up to the new meshes of the chunks that it reaches.

    bench_edit.py [--build DIR] [--plot]

Needs a build with MC_BENCH=ON and libbenchmark-dev (mc_bench makes the dabs, on one thread).
Prints Markdown; --plot also writes data/pictures/edit-latency.svg. Nothing else should run meanwhile.
"""

import argparse
import json
import pathlib
import subprocess
import sys

import plot

ROOT = pathlib.Path(__file__).resolve().parent.parent

#: Cases as mc_bench names them, as people do, and their colours.
CASES = {
    "Dab/demo": ("demo, radius 1, 20x10x20", "#2f8f4e"),
    "Dab/dense/128": ("radius 8, dense 128³", "#3d7fc1"),
    "Dab/dense/512": ("radius 8, dense 512³", "#8163c4"),
    "Dab/dense/1024": ("radius 8, dense 1024³", "#b0467c"),
    "Dab/sparse/1024": ("radius 8, sparse 1024³", "#c2662d"),
}
SHARES = {"p01": 0.01, "p10": 0.1, "p25": 0.25, "p50": 0.5, "p75": 0.75, "p90": 0.9, "p95": 0.95,
          "p99": 0.99, "p999": 0.999}
TICKS = [(1 / (1 - share), f"{100 * share:g} %") for share in (0.01, 0.5, 0.75, 0.9, 0.99, 0.999)]


def measured(bench):
    """Counters of all runs, by name."""
    said = subprocess.run(
        [bench, "--benchmark_filter=^Dab/", "--benchmark_format=json"],
        check=True, capture_output=True, text=True).stdout
    runs = json.loads(said)["benchmarks"]
    for run in runs:
        if run.get("error_occurred"):
            sys.exit(f"bench_edit.py: {run['name']}: {run['error_message']}")
    return {run["name"].split("/iterations:")[0]: run for run in runs}


def microseconds(us):
    return f"{us:.0f}" if us >= 100 else f"{us:#.3g}"


def table(runs):
    lines = ["| brush, volume | median, µs | 99th percentile | of it the edit | undo, median | chunks "
             "| triangles |", "|---|--:|--:|--:|--:|--:|--:|"]
    for name, (title, _) in CASES.items():
        whole, edit, undo = runs[name], runs[name + "/edit"], runs[name + "/undo"]
        cells = [title, f"**{microseconds(whole['p50'])}**", microseconds(whole["p99"]),
                 microseconds(edit["p50"]), microseconds(undo["p50"]), f"{whole['chunks']:.1f}",
                 f"{whole['triangles']:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def picture(runs):
    lines = [plot.Line(title, color,
                       [(1 / (1 - share), runs[name][key]) for key, share in SHARES.items()])
             for name, (title, color) in CASES.items()]
    return plot.svg("A dab of a brush, up to the new meshes, one thread", "share of dabs that took at "
                    "most so long", "microseconds", lines, TICKS)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--plot", action="store_true", help="write data/pictures/edit-latency.svg")
    args = parser.parse_args()
    bench = args.build / "tests/bench/mc_bench"
    if not bench.exists():
        sys.exit("bench_edit.py: no mc_bench: configure with -DMC_BENCH=ON, with libbenchmark-dev")
    runs = measured(str(bench))
    print(table(runs))
    if args.plot:
        path = ROOT / "data/pictures/edit-latency.svg"
        path.write_text(picture(runs), encoding="utf-8")


if __name__ == "__main__":
    main()
