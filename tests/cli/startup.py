#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Libraries that are slow to load are loaded only by runs that need them.

    startup.py --mc MC --specs DIR [--with-assertions]

Runs the program with the loader's own tracing and looks which libraries it opened.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

HEAVY = ("libopenvdb", "libhwy", "libOpenEXR", "libpng", "libboost", "libIex")


def libraries_of(command, folder, heavy):
    """What the loader opened for a run; fails where the run does."""
    trace = folder / "trace"
    for old in folder.glob("trace*"):
        old.unlink()
    env = {**os.environ, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(trace)}
    subprocess.run(command, env=env, check=True, capture_output=True, cwd=folder)
    text = "".join(path.read_text() for path in folder.glob("trace*"))
    if "libstdc++" not in text:
        sys.exit(f"{command}: the loader traced nothing")
    return {name for name in heavy if name in text}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--mc", required=True)
    parser.add_argument("--specs", type=pathlib.Path, required=True)
    parser.add_argument("--with-assertions", action="store_true",
                        help="of a build in which Highway's may need its library")
    args = parser.parse_args()
    heavy = [name for name in HEAVY if name != "libhwy" or not args.with_assertions]
    sphere = str(args.specs / "sphere.json")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "a.raw").write_bytes(bytes(13) + b"\1" + bytes(13))
        raw = ["a.raw", "--dims", "3,3,3", "--type", "u8", "--iso", "0.5", "--force", "-q"]
        writes = libraries_of([args.mc, "sample", sphere, "--force", "-q", "-o", "a.vdb"], folder,
                              heavy)
        if writes - {"libopenvdb", "libboost"} or "libopenvdb" not in writes:
            sys.exit(f"writing a VDB file loads {writes}")
        for run in (
            ["--version"],
            ["extract", *raw, "-o", "a.ply"],
            ["extract", *raw, "-o", "a.glb"],
            ["extract", sphere, "--force", "-q", "-o", "a.stl"],
            ["extract", "a.vdb", "--force", "-q", "-o", "a.ply"],
            ["info", "a.vdb"],
        ):
            loaded = libraries_of([args.mc, *run], folder, heavy)
            if loaded:
                sys.exit(f"mc {' '.join(run)} loads {loaded}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
