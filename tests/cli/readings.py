#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files that are mapped, and files whose planes are copied: equal meshes, and no byte read twice.

    readings.py --mc MC

MC_READ forces either. The system counts the bytes that read calls moved: pages of a mapping are not
among them.
"""

import argparse
import os
import pathlib
import random
import subprocess
import sys
import tempfile

NX, NY, NZ = 128, 128, 400
STARTUP = 1 << 20  # bytes of libraries and of reports
SOURCES = {"a.raw": ["--dims", f"{NX},{NY},{NZ}", "--type", "f32"], "a.nrrd": []}
FEW, MANY = "0.9999", "0.95"  # isos: spikes whose faces are spooled, and that are counted first


def make_inputs(folder):
    """White noise over [0.5, 1), and a NRRD file of it; how many bytes of samples."""
    rng = random.Random(7)
    words = b"".join(rng.getrandbits(23).to_bytes(3, "little") + b"\x3f" for _ in range(NX * NY))
    words = words.replace(b"\x80\x3f", b"\x40\x3f")
    planes = b"".join(words[4 * 31 * k:] + words[:4 * 31 * k] for k in range(NZ))
    (folder / "a.raw").write_bytes(planes)
    head = (f"NRRD0005\ntype: float\ndimension: 3\nsizes: {NX} {NY} {NZ}\nencoding: raw\n"
            "endian: little\n\n")
    (folder / "a.nrrd").write_bytes(head.encode() + planes)
    return len(planes)


def run(mc, folder, reading, words):
    """The mesh that it wrote, and how many bytes its read calls moved."""
    process = subprocess.Popen([mc, "extract", *words, "-q", "--force", "-o", "m.ply"], cwd=folder,
                               env={**os.environ, "MC_READ": reading})
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    counts = pathlib.Path(f"/proc/{process.pid}/io").read_text(encoding="ascii")
    if process.wait() != 0:
        sys.exit(f"{reading} {words}: status {process.returncode}")
    return (folder / "m.ply").read_bytes(), int(counts.split("rchar:")[1].split()[0])


def check(mc, folder, source, iso, n_bytes):
    words = [source, *SOURCES[source], "--iso", iso]
    wanted, n_mapped = run(mc, folder, "map", [*words, "--threads", "1"])
    spooled = n_mapped if iso == FEW else 0
    if n_mapped > STARTUP + len(wanted):
        sys.exit(f"{source}: read {n_mapped} bytes of a mapped file")
    n_passes = 1 if iso == FEW else 2
    for threads in ("1", "2", "7"):
        mesh, n_read = run(mc, folder, "copy", [*words, "--threads", threads])
        print(f"{source}, iso {iso}, {threads} threads: {n_read / n_bytes:.3f} of the file")
        if mesh != wanted:
            sys.exit("other bytes than of a mapped file")
        # Planes that slots still hold from the first pass are not read in the second.
        if not n_bytes <= n_read <= 1.02 * n_passes * n_bytes + spooled + STARTUP:
            sys.exit(f"that is more than {n_passes} passes, or less than one")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mc", required=True)
    mc = parser.parse_args().mc
    with tempfile.TemporaryDirectory(prefix="mc-readings-") as name:
        folder = pathlib.Path(name)
        n_bytes = make_inputs(folder)
        for source in SOURCES:
            for iso in (FEW, MANY):
                check(mc, folder, source, iso, n_bytes)
        bad = subprocess.run([mc, "info", "a.raw", *SOURCES["a.raw"]], cwd=folder, text=True,
                             env={**os.environ, "MC_READ": "guess"}, capture_output=True)
        print(bad.stderr.strip())
        if bad.returncode != 2 or "MC_READ" not in bad.stderr:
            sys.exit(f"MC_READ=guess: status {bad.returncode}")


if __name__ == "__main__":
    main()
