#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A run takes its memory once, at the start, however large the mesh becomes.

    steady.py --mc MC

Meshes the same field over 96 and over 960 planes, where planes are copied: a mapping has a page
fault for each of its pages, which is what the copies are for. The minor page faults of the two runs
are nearly the same. Where strace is installed, no call that takes or returns memory comes between
the first part of the mesh that is written and the last. All with one thread: of several, each slot
of the pipeline takes its memory when it is first used, which may be late.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

N, PERIOD = 256, 96
SPEC = {
    "format": "mc-volume", "version": 1, "convention": "density", "iso": 0,
    "grid": {"cells": [N - 1, N - 1, PERIOD - 1], "spacing": 1},
    "field": {"type": "add", "inputs": [
        {"type": "sin", "source": {"type": "mul", "inputs": ["x", 0.2]}},
        {"type": "sin", "source": {"type": "add", "inputs": [
            {"type": "mul", "inputs": ["y", 0.17]},
            {"type": "mul", "inputs": ["z", 2 * 3.141592653589793 / PERIOD * 3]}]}}]},
}
MEMORY_CALLS = ("mmap", "munmap", "mremap", "madvise", "brk")
WRITES = ("write", "pwrite64")


def command(mc, volume, n_planes, to):
    return [mc, "extract", volume, "--dims", f"{N},{N},{n_planes}", "--type", "f32", "--iso", "0",
            "--force", "-q", "--threads", "1", "-o", f"mesh.{to}"]


def faults_of(words, folder):
    """Minor page faults of a run that must succeed."""
    process = subprocess.Popen(words, cwd=folder, env={**os.environ, "MC_READ": "copy"})
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{words}: status {process.returncode}")
    return usage.ru_minflt


def memory_calls(words, folder):
    """Calls that take or return memory between the first part of the mesh and the end of the last.

    Where the mesh has been made, its memory goes back before the output gets its last bytes.
    """
    names = ",".join(MEMORY_CALLS + WRITES)
    subprocess.run(["strace", "-f", "-qq", "-e", f"trace={names}", "-o", "trace", *words],
                   cwd=folder, check=True, env={**os.environ, "MC_READ": "copy"})
    lines = (folder / "trace").read_text(encoding="utf-8").splitlines()
    calls = [(match[1], line) for line in lines if (match := re.match(r"\d+ +(\w+)\(", line))]
    writes = [n for n, (name, _) in enumerate(calls) if name in WRITES]
    return [line for name, line in calls[writes[len(writes) // 20]:writes[-len(writes) // 20]] if name in MEMORY_CALLS]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mc", required=True)
    mc = parser.parse_args().mc
    wrong = []
    with tempfile.TemporaryDirectory(prefix="mc-steady-") as name:
        folder = pathlib.Path(name)
        (folder / "a.json").write_text(json.dumps(SPEC), encoding="utf-8")
        subprocess.run([mc, "sample", "a.json", "-q", "-o", "a.raw"], cwd=folder, check=True)
        (folder / "b.raw").write_bytes((folder / "a.raw").read_bytes() * 10)
        for to in ("ply", "glb", "stl"):
            few = faults_of(command(mc, "a.raw", PERIOD, to), folder)
            many = faults_of(command(mc, "b.raw", 10 * PERIOD, to), folder)
            print(f"{to}: {few} and {many} page faults")
            if many > 1.05 * few:
                wrong.append(f"{to}: more page faults for a larger mesh")
            if shutil.which("strace") is not None:
                late = memory_calls(command(mc, "b.raw", 10 * PERIOD, to), folder)
                wrong += [f"{to}: {call}" for call in late]
        if shutil.which("strace") is None:
            print("strace is not there: calls that take memory are not looked at")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
