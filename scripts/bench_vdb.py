#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What starting mc and loading VDB files costs: medians, with the machine named.

    bench_vdb.py [--build DIR] [--runs N] [--size N] [--folder DIR]

Needs a build with MC_BENCH=ON (mc_vdb_bench makes the files and times both readers in one process,
alternately; files are in the page cache). Prints Markdown. SIZE is the fog's extent in samples: 460
has 51 M active samples.
"""

import argparse
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
QUIET = [(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)]


def run_ms(command):
    """Wall time of one process, start to end."""
    start = time.perf_counter()
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=QUIET)
    _, status = os.waitpid(pid, 0)
    spent = 1e3 * (time.perf_counter() - start)
    if status != 0:
        sys.exit(f"{' '.join(command)}: failed")
    return spent


def median_ms(command, n_runs):
    return statistics.median(run_ms(command) for _ in range(n_runs))


def machine():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    model = next((l.split(": ")[1] for l in lines if l.startswith("model name")), platform.machine())
    return f"{model}, {os.cpu_count()} threads, {platform.system()} {platform.release()}"


def start_up(mc, bench, folder, n_runs):
    (folder / "a.raw").write_bytes(bytes(2048) + b"\xff" * 64 + bytes(1984))
    raw = [str(folder / "a.raw"), "--dims", "16,16,16", "--type", "u8", "--iso", "128"]
    sphere = str(ROOT / "data/specs/sphere.json")
    tiny = str(folder / "tiny.vdb")
    subprocess.run([bench, "make", "sphere", "blosc", "32", tiny], check=True)
    out = ["--force", "-q", "-o"]
    print("| process | ms |\n|---|--:|")
    for name, args in {
        "`true`": None,
        "`mc --version`": ["--version"],
        "`mc extract`, raw 16^3 to PLY": ["extract", *raw, *out, str(folder / "a.ply")],
        "`mc extract`, raw 16^3 to GLB": ["extract", *raw, *out, str(folder / "a.glb")],
        "`mc extract`, spec 64^3 to PLY": ["extract", sphere, *out, str(folder / "a.ply")],
        "`mc extract`, tiny VDB to PLY": ["extract", tiny, *out, str(folder / "a.ply")],
    }.items():
        command = ["/bin/true"] if args is None else [mc, *args]
        print(f"| {name} | {median_ms(command, n_runs):.2f} |")


def plain_write_ms(path, n_bytes, n_runs):
    """Writing so many bytes to a new file in one call."""
    data = os.urandom(1 << 20) * (n_bytes // (1 << 20) + 1)
    spent = []
    for _ in range(n_runs):
        path.unlink(missing_ok=True)
        start = time.perf_counter()
        with open(path, "wb", buffering=0) as out:
            view = memoryview(data)[:n_bytes]
            while view:
                view = view[out.write(view):]
        spent.append(1e3 * (time.perf_counter() - start))
    return statistics.median(spent)


def loading(bench, mc, folder, size, n_runs):
    print("\n`load`, `extract` (in memory, warm) and `write` (plain) in ms; `whole` is `mc extract` to")
    print("GLB, a cold process; its ratio is to OpenVDB's load + our extract + plain write.\n")
    print("| VDB file | threads | load | OpenVDB's load | ratio | extract | write | whole | ratio |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    glb = folder / "a.glb"
    for kind, extent in (("fog", size), ("sphere", 4 * size)):
        for packing in ("none", "blosc"):
            path = str(folder / f"{kind}.vdb")
            subprocess.run([bench, "make", kind, packing, str(extent), path], check=True)
            for threads in ("1", "2"):
                said = subprocess.run(
                    [bench, "load", str(n_runs), threads, path],
                    check=True, capture_output=True, text=True,
                ).stdout.split()
                ours, theirs, extract = (float(x) for x in said[:3])
                out = ["-o", str(glb), "--force", "-q", "--threads", threads]
                whole = median_ms([mc, "extract", path, *out], n_runs)
                write = plain_write_ms(folder / "plain", glb.stat().st_size, n_runs)
                print(
                    f"| {kind}, {packing}, {int(said[3]) / 1e6:.0f} M active | {threads} "
                    f"| {ours:.0f} | {theirs:.0f} | {ours / theirs:.2f} | {extract:.0f} | {write:.0f} "
                    f"| {whole:.0f} | {whole / (theirs + extract + write):.2f} |"
                )
            pathlib.Path(path).unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--size", type=int, default=460)
    parser.add_argument("--folder", default="/dev/shm", help="where files are made")
    args = parser.parse_args()
    mc = str(args.build / "mc")
    bench = str(args.build / "tests/bench/mc_vdb_bench")
    if not os.path.exists(bench):
        sys.exit("bench_vdb.py: no mc_vdb_bench: configure with -DMC_BENCH=ON")
    print(f"{machine()}\n")
    with tempfile.TemporaryDirectory(dir=args.folder) as name:
        start_up(mc, bench, pathlib.Path(name), 10 * args.runs)
        loading(bench, mc, pathlib.Path(name), args.size, args.runs)


if __name__ == "__main__":
    main()
