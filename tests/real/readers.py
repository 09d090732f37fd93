# SPDX-License-Identifier: MIT
"""Opens what mc writes in programs that know nothing of ours.

    readers.py assimp|vtk MC
    readers.py gltf-validator MC SCRIPT MODULES TESTS

Extracts a small terrain and a ball to every mesh format and compares the counts that assimp or VTK
find with those mc reports; or runs the Khronos glTF validator through SCRIPT, for node, with the npm
packages in MODULES/node_modules, also against a glTF in many small parts that the unit tests TESTS
write. A reader that is not installed is a skip, said aloud.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import mesh_files

# Closed and open, with u16 and with u32 indices, with materials and attributes.
SPECS = {
    "ball": {
        "grid": {"cells": [24, 24, 24], "spacing": 0.25, "origin": [-3, -3, -3]},
        "field": {"type": "sphere", "center": [0, 0, 0], "radius": 2},
    },
    "painted": {
        "grid": {"cells": [24, 24, 24], "spacing": 0.25, "origin": [-3, -3, -3]},
        "field": {"type": "sphere", "center": [0, 0, 0], "radius": 2},
        "material": {"type": "select", "control": "y", "a": 2, "b": 300},
    },
    "warm": {
        "grid": {"cells": [24, 24, 24], "spacing": 0.25, "origin": [-3, -3, -3]},
        "field": {"type": "sphere", "center": [0, 0, 0], "radius": 2},
        "material": 3,
        "attributes": {"heat": "x", "cold": {"type": "div", "a": 1, "b": "y"}},
    },
    "hills": {
        "grid": {"cells": [200, 24, 200], "spacing": 1, "origin": [0, 0, 0]},
        "field": {
            "type": "add",
            "inputs": [
                {"type": "neg", "source": "y"},
                10,
                {"type": "mul", "inputs": [6, {"type": "perlin", "frequency": 0.05}]},
            ],
        },
    },
}


def extract(mc, spec, output, *options):
    """The report of a run."""
    report = output.with_suffix(".report")
    subprocess.run(
        [mc, "extract", spec, "-o", output, "--force", "--report", report, *options],
        stdin=subprocess.DEVNULL,
        check=True,
        stderr=subprocess.PIPE,
    )
    return json.loads(report.read_text())


def assimp_counts(path):
    """Vertices and triangles as assimp tells them."""
    said = subprocess.run(
        ["assimp", "info", path], capture_output=True, text=True, check=True
    ).stdout
    return tuple(int(re.search(rf"^{name}:\s+(\d+)", said, re.M)[1]) for name in ("Vertices", "Faces"))


def vtk_counts(path):
    """Vertices and triangles as VTK tells them."""
    from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader

    readers = {".ply": vtkPLYReader, ".obj": vtkOBJReader, ".stl": vtkSTLReader}
    reader = readers.get(path.suffix, vtkGLTFReader)()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    return data.GetNumberOfPoints(), data.GetNumberOfCells()


def write_specs(folder):
    """Name and path of each."""
    for name, document in SPECS.items():
        spec = folder / f"{name}.json"
        spec.write_text(json.dumps({"format": "mc-volume", "version": 1, "iso": 0, **document}))
        yield name, spec


def compare(counts, mc, folder):
    """Faults found over all specs and formats."""
    for name, spec in write_specs(folder):
        for suffix in ("ply", "obj", "stl", "glb", "gltf"):
            for options in ([], ["--normals", "none"], ["--ascii"]):
                if options == ["--ascii"] and suffix not in {"ply", "stl"}:
                    continue
                path = folder / f"{name}.{suffix}"
                report = extract(mc, spec, path, *options)
                got = counts(path)
                wanted = (report["vertices"], report["triangles"])
                # STL has corners and no vertices; assimp welds some of them, VTK all.
                loose = suffix == "stl" and counts is assimp_counts
                if got[1] != wanted[1] or not (got[0] == wanted[0] or loose):
                    yield f"{name}.{suffix} {options}: {got} vertices and triangles, not {wanted}"
                else:
                    print(f"{name}.{suffix} {options}: {got[0]} vertices, {got[1]} triangles")


def validate(mc, script, modules, tests, folder):
    """What the Khronos validator says against our glTF."""

    def said_of(path, options):
        done = subprocess.run(
            ["node", script, "--modules", modules, path], capture_output=True, text=True, check=False
        )
        print(f"{path.name} {options}: {done.stdout.strip()[:2000]}")
        if done.returncode != 0:
            yield f"{path.name} {options}: status {done.returncode} {done.stderr}"

    subprocess.run(
        [tests, "--gtest_filter=GltfParts.AreThereForReaders"],
        env={**os.environ, "MC_TEST_PARTS": str(folder)},
        check=True,
        stdout=subprocess.DEVNULL,
    )
    yield from said_of(folder / "parts.gltf", "in parts")
    for name, spec in write_specs(folder):
        for suffix in ("glb", "gltf"):
            for options in ([], ["--normals", "none"]):
                path = folder / f"{name}.{suffix}"
                extract(mc, spec, path, *options)
                yield from said_of(path, options)


def missing(reader, arguments):
    """Why the reader cannot be used; None if it can."""
    if reader == "vtk":
        try:
            import vtkmodules.vtkIOPLY  # noqa: F401
        except ImportError:
            return f"no VTK for {sys.executable} (package python3-vtk9)"
        return None
    if reader == "assimp":
        return None if shutil.which("assimp") else "no assimp (package assimp-utils)"
    if not shutil.which("node"):
        return "no node (package nodejs)"
    package = pathlib.Path(arguments[1], "node_modules", "gltf-validator")
    if not package.is_dir():
        return f"no {package} (scripts/test installs it with npm)"
    return None


def main():
    reader, mc, *rest = sys.argv[1:]
    why = missing(reader, rest)
    if why:
        print(f"SKIPPED: {why}")
        return mesh_files.SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        if reader == "gltf-validator":
            faults = list(validate(mc, *rest, folder))
        else:
            counts = assimp_counts if reader == "assimp" else vtk_counts
            faults = list(compare(counts, mc, folder))
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
