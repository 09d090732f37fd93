#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""File to file: `mc extract` of a raw volume against plain reading and writing of the same bytes.

    bench_files.py [--mc PROGRAM] [--size N] [--rounds R] [--dir DIR] [--threads T[,T...]] [--to EXT[,EXT...]]

Makes two fields of N^3 floats in DIR (default /dev/shm, so that no disk is measured), a sphere and a
gyroid of eight periods. A round reads the volume with read(), writes the mesh of that format with
write() to a new file, and runs `mc extract` as a new process, one after the other; the table has the
medians of R rounds, and the ratio of the run to reading and writing together. Page cache is warm.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

PIECE = 1 << 20  # bytes of a plain read or write
TAU = 6.283185307179586


def wave(axis, phase):
    """sin(8 tau axis / 2 + phase) over [-1, 1]: eight periods."""
    turned = {"type": "mul", "inputs": [axis, 4 * TAU]}
    return {"type": "sin", "source": {"type": "add", "inputs": [turned, phase]}}


def field_of(name):
    if name == "sphere":
        return {"type": "sphere", "radius": 0.8}
    terms = [{"type": "mul", "inputs": [wave(a, 0), wave(b, TAU / 4)]}
             for a, b in (("x", "y"), ("y", "z"), ("z", "x"))]
    return {"type": "add", "inputs": terms}


def make_volume(mc, folder, name, size):
    spec, raw = folder / f"{name}.json", folder / f"{name}.raw"
    cells, spacing = size - 1, 2 / (size - 1)
    spec.write_text(json.dumps({
        "format": "mc-volume", "version": 1, "convention": "density",
        "grid": {"cells": [cells] * 3, "spacing": spacing, "origin": [-1, -1, -1]},
        "field": field_of(name)}))
    subprocess.run([mc, "sample", spec, "-o", raw, "--force"], check=True, stderr=subprocess.DEVNULL)
    return raw


def timed(work):
    began = time.perf_counter()
    work()
    return 1000 * (time.perf_counter() - began)


def read_plainly(path):
    block = bytearray(PIECE)
    with open(path, "rb", buffering=0) as file:
        while file.readinto(block):
            pass


def write_plainly(path, block, n_bytes):
    with open(path, "wb", buffering=0) as file:
        for first in range(0, n_bytes, PIECE):
            file.write(block[: min(PIECE, n_bytes - first)])


def measure(mc, raw, size, to, threads, rounds):
    out, plain = raw.with_suffix("." + to), raw.with_suffix(".plain")
    spacing = 2 / (size - 1)
    command = [mc, "extract", raw, "--dims", f"{size},{size},{size}", "--type", "f32",
               "--iso", "0", "--spacing", f"{spacing},{spacing},{spacing}", "--origin=-1,-1,-1",
               "-q", "-o", out, "--threads", str(threads)]
    block = memoryview(bytes(os.urandom(PIECE)))
    reads, writes, runs = [], [], []
    for _ in range(rounds):
        out.unlink(missing_ok=True)
        runs.append(timed(lambda: subprocess.run(command, check=True)))
        n_bytes = out.stat().st_size
        out.unlink()
        reads.append(timed(lambda: read_plainly(raw)))
        writes.append(timed(lambda: write_plainly(plain, block, n_bytes)))
        plain.unlink()
    return n_bytes, *(statistics.median(times) for times in (reads, writes, runs))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    here = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--mc", default=str(here / "build/release/mc"))
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--dir", default="/dev/shm")
    parser.add_argument("--threads", default=str(os.cpu_count()))
    parser.add_argument("--to", default="ply,glb,stl,obj")
    parser.add_argument("--fields", default="sphere,gyroid")
    args = parser.parse_args()
    print("| field | output | threads | MB | read ms | write ms | mc ms | mc / (read + write) | MB/s |")
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory(dir=args.dir, prefix="mc-bench-") as folder:
        for name in args.fields.split(","):
            raw = make_volume(args.mc, pathlib.Path(folder), name, args.size)
            for to in args.to.split(","):
                for threads in args.threads.split(","):
                    n_bytes, read, write, run = measure(args.mc, raw, args.size, to, int(threads),
                                                        args.rounds)
                    print(f"| {name} {args.size}^3 | {to} | {threads} | {n_bytes / 1e6:.0f} "
                          f"| {read:.0f} | {write:.0f} | {run:.0f} | {run / (read + write):.2f} "
                          f"| {n_bytes / run / 1e3:.0f} |", flush=True)
            raw.unlink()


if __name__ == "__main__":
    main()
