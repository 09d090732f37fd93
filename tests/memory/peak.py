#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Peak memory under --memory: white noise, whose mesh is many times the volume, a document, a VDB.

    peak.py --mc MC [--vdb]

Anonymous resident memory is looked at every millisecond while the program runs: mapped input does
not count. The same with all the memory it wants must take more than the budget, or the test would
show nothing.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from budget import MIB, anonymous_bytes

DATA = pathlib.Path(__file__).resolve().parent.parent.parent / "data"
DIMS = (1024, 1024, 8)
CLOUDS = {"format": "mc-volume", "version": 1, "convention": "density", "iso": 0.2,
          "grid": {"cells": [319] * 3, "spacing": 1},
          "field": {"type": "perlin", "frequency": 0.05}}
NOISE = ["--dims", ",".join(map(str, DIMS)), "--type", "u8", "--iso", "128"]


def peak(words, stdin=subprocess.DEVNULL):
    """Greatest anonymous memory of a run that must succeed."""
    run = subprocess.Popen(words, stdin=stdin, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    most = 0
    while run.poll() is None:
        most = max(most, anonymous_bytes(run.pid, words[0]))
        time.sleep(0.001)
    assert run.returncode == 0, (words, run.stderr.read())
    return most


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True)
    parser.add_argument("--vdb", action="store_true", help="VDB can be written and read")
    args = parser.parse_args()
    mc = args.mc
    faults = 0
    with tempfile.TemporaryDirectory(prefix="mc-peak-") as folder:
        noise = pathlib.Path(folder) / "noise.raw"
        noise.write_bytes(os.urandom(DIMS[0] * DIMS[1] * DIMS[2]))
        terrain = json.loads((DATA / "specs/terrain.json").read_text(encoding="utf-8"))
        terrain["grid"] = {"cells": [512, 192, 512], "spacing": 0.5, "origin": [-128, -24, -128]}
        spec = pathlib.Path(folder) / "terrain.json"
        spec.write_text(json.dumps(terrain), encoding="utf-8")
        out = pathlib.Path(folder) / "out"

        def extract(budget, threads, to, *words, stdin=None, output=None):
            nonlocal faults
            command = [mc, "extract", *map(str, words), "-q", "--force", "--memory", f"{budget}MiB",
                       "--threads", str(threads), "--to", to, "-o", str(output or f"{out}.{to}")]
            most = peak(command, *([stdin] if stdin else []))
            if budget < 1024:
                faults += most > budget * MIB
            print(f"{budget} MiB, {threads} threads, {to}: {most / MIB:.1f} MiB"
                  f"{'  TOO MUCH' if budget < 1024 and most > budget * MIB else ''}")
            return most

        clouds = pathlib.Path(folder) / "clouds.vdb"
        document = pathlib.Path(folder) / "clouds.json"
        document.write_text(json.dumps(CLOUDS), encoding="utf-8")
        if args.vdb:
            subprocess.run([mc, "sample", document, "-q", "-o", clouds], check=True)

        for threads in (1, 2):
            if args.vdb:
                extract(64, threads, "ply", clouds, "--iso", "0.2")
            for to in ("ply", "glb", "obj", "stl"):
                extract(64, threads, to, noise, *NOISE)
            extract(96, threads, "glb", spec)
        with noise.open("rb") as data:
            with subprocess.Popen(["cat"], stdin=data, stdout=subprocess.PIPE) as cat:
                extract(64, 2, "ply", "-", *NOISE, stdin=cat.stdout, output="-")
        for what, *words in ((noise, *NOISE), (clouds, "--iso", "0.2")):
            if what.exists() and extract(4096, 2, "ply", what, *words) <= 64 * MIB:
                print(f"{what.name} is too small to show anything")
                faults += 1
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
