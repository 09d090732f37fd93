#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whole runs from file to file, beside what the machine needs for them at least.

    bench_files.py [--mc PROGRAM] [--size N] [--rounds R] [--dir DIR] [--threads T[,T...]]
                   [--to EXT[,EXT...]] [--from EXT[,EXT...]] [--types TYPE[,TYPE...]] [--no-peers]
                   [--readme]

Makes fields of N^3 samples in DIR (default /dev/shm, so that no disk is measured; files are in the
page cache): a sphere and a gyroid of eight periods. Each row is one `mc extract`, and what it is
compared with, in milliseconds:

  S    start: `mc --version`
  P    plain I/O of the same bytes: reading the input and writing a file as large as the output, in
       blocks of 1 MiB
  E    the engine alone, in memory: `mc bench` of the same field, type, threads and normals
  run  the whole process, from start to end

The ratio of one thread is run / (S + P + E). That of more threads is run / max(P, sum / T), with
E of one thread: what is left if all of the sum but plain I/O were shared. A round runs everything in
turns; P and run are the least of R rounds, since what disturbs a measurement only adds to it. Where
PLY and GLB count the mesh first, that is part of the run only, and so is unpacking a VDB, whose E is
that of the dense field. Where python3-vtk9 is installed, VTK's reader, Flying Edges and writer do the
same once; not with --no-peers.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PIECE = 1 << 20  # bytes of a plain read or write
TAU = 6.283185307179586
WITH_NORMALS = ("ply", "glb", "obj")
NUMPY_TYPES = {"u8": "uint8", "u16": "uint16", "i16": "int16", "f32": "float32", "f64": "float64"}
VTK_PYTHON = "/usr/bin/python3"
VTK_RUN = """
import sys, vtk
raw, out, size = sys.argv[1], sys.argv[2], int(sys.argv[3])
read = vtk.vtkImageReader2()
read.SetFileName(raw); read.SetFileDimensionality(3); read.SetDataScalarTypeToFloat()
read.SetDataExtent(0, size - 1, 0, size - 1, 0, size - 1); read.SetDataByteOrderToLittleEndian()
edges = vtk.vtkFlyingEdges3D()
edges.SetInputConnection(read.GetOutputPort()); edges.SetValue(0, 0.0)
edges.SetComputeNormals(len(sys.argv) > 4); edges.SetComputeScalars(False)
write = {"ply": vtk.vtkPLYWriter, "stl": vtk.vtkSTLWriter, "obj": vtk.vtkOBJWriter}[out[-3:]]()
if out[-3:] != "obj": write.SetFileTypeToBinary()
write.SetInputConnection(edges.GetOutputPort()); write.SetFileName(out); write.Write()
"""


def wave(axis, phase):
    """sin(8 tau axis / 2 + phase) over [-1, 1]: eight periods."""
    turned = {"type": "mul", "inputs": [axis, 4 * TAU]}
    return {"type": "sin", "source": {"type": "add", "inputs": [turned, phase]}}


def field_of(name):
    if name == "sphere":
        return {"type": "sphere", "radius": 0.8}
    terms = [{"type": "mul", "inputs": [wave(a, 0), wave(b, TAU / 4)]}
             for a, b in (("x", "y"), ("y", "z"), ("z", "x"))]
    return {"type": "mul", "inputs": [{"type": "add", "inputs": terms}, 0.5]}


@dataclasses.dataclass
class Volume:
    """An input file and what `mc extract` must be told of it."""
    field: str
    kind: str  # raw, nrrd or vdb
    type: str
    path: pathlib.Path
    words: list


@dataclasses.dataclass
class Row:
    volume: Volume
    to: str
    normals: bool
    threads: int
    n_bytes: int = 0
    n_triangles: int = 0
    start: float = 0
    plain: float = 0
    engine: float = 0
    engine_alone: float = 0  # on one thread
    run: float = 0
    faults: int = 0
    peer: float = 0

    def ratio(self):
        total = self.start + self.plain + self.engine_alone
        if self.threads == 1:
            return self.run / total
        return self.run / max(self.plain, total / self.threads)


def quiet(command, **more):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, **more).stdout


def process(command):
    """Milliseconds of a process from start to end, and its minor page faults."""
    began = time.perf_counter()
    pid = os.posix_spawn(str(command[0]), [str(word) for word in command], os.environ,
                         file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(pid, 0)
    spent = 1000 * (time.perf_counter() - began)
    if status != 0:
        sys.exit(f"{command}: status {os.waitstatus_to_exitcode(status)}")
    return spent, usage.ru_minflt


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


def converted(raw, sample_type):
    """The float samples of [-1, 1] as another type, and the iso that 0 becomes."""
    if sample_type == "f32":
        return raw, 0
    import numpy  # only for other types
    target = numpy.dtype(NUMPY_TYPES[sample_type])
    samples = numpy.fromfile(raw, numpy.float32)
    iso = 0
    if target.kind in "iu":
        limits = numpy.iinfo(target)
        half = (float(limits.max) - limits.min) / 2
        iso = (float(limits.max) + limits.min) / 2
        samples = numpy.clip(numpy.rint(samples * half + iso), limits.min, limits.max)
    path = raw.with_name(f"{raw.stem}.{sample_type}.raw")
    samples.astype(target).tofile(path)
    return path, iso


def make_volume(args, folder, field, kind, sample_type):
    spec, cells, spacing = folder / f"{field}.json", args.size - 1, 2 / (args.size - 1)
    spec.write_text(json.dumps({
        "format": "mc-volume", "version": 1, "convention": "density", "iso": 0,
        "grid": {"cells": [cells] * 3, "spacing": spacing, "origin": [-1, -1, -1]},
        "field": field_of(field)}))
    if kind != "raw":
        path = folder / f"{field}.{kind}"
        quiet([args.mc, "sample", spec, "-o", path])
        return Volume(field, kind, "f32", path, ["--iso", "0"])
    raw = folder / f"{field}.raw"
    quiet([args.mc, "sample", spec, "-o", raw])
    path, iso = converted(raw, sample_type)
    if path != raw:
        raw.unlink()
    words = ["--dims", ",".join([str(args.size)] * 3), "--type", sample_type, "--iso", str(iso),
             "--spacing", ",".join([str(spacing)] * 3), "--origin=-1,-1,-1"]
    return Volume(field, kind, sample_type, path, words)


def engine_times(args, volume, normals, threads):
    """Milliseconds of the engine by number of threads, and the triangles of its mesh."""
    said = json.loads(quiet([args.mc, "bench", "--json", "--fields", volume.field, "--size",
                             args.size, "--type", volume.type, "--normals",
                             "gradient" if normals else "none", "--threads",
                             ",".join(str(t) for t in sorted({1, *threads}))]))
    rows = said["fields"]
    return {row["threads"]: row["time"]["ms"] for row in rows}, rows[0]["triangles"]


def peer_time(row, args, folder):
    """Milliseconds of VTK for the same; 0 where it cannot."""
    if not args.peers or row.volume.kind != "raw" or row.volume.type != "f32" or row.to == "glb":
        return 0
    out = folder / f"vtk.{row.to}"
    words = [VTK_PYTHON, "-c", VTK_RUN, row.volume.path, out, args.size]
    spent, _ = process([*words, "normals"] if row.normals else words)
    out.unlink()
    return spent


def measure(args, folder, row, block):
    out, plain = folder / f"mesh.{row.to}", folder / "plain"
    extract = [args.mc, "extract", row.volume.path, *row.volume.words, "-q", "--force", "-o", out,
               "--threads", row.threads, "--normals", "gradient" if row.normals else "none"]
    report = json.loads(quiet([*extract, "--report", "-"]))
    row.n_triangles, row.n_bytes = report["triangles"], out.stat().st_size
    starts, plains, runs = [], [], []
    for _ in range(args.rounds):
        out.unlink(missing_ok=True)
        runs.append(process(extract))
        out.unlink()
        read = 0 if row.volume.kind == "vdb" else timed(lambda: read_plainly(row.volume.path))
        plains.append(read + timed(lambda: write_plainly(plain, block, row.n_bytes)))
        plain.unlink()
        starts.append(process([args.mc, "--version"])[0])
    row.run, row.faults = min(runs)
    row.plain, row.start = min(plains), statistics.median(starts)
    row.peer = peer_time(row, args, folder)


def columns(rows):
    peers = any(row.peer for row in rows)
    head = ["input", "output", "MB", "triangles", "normals", "threads", "S + P + E",
            "**mc, ms**", "ratio", "MB/s", "faults", *(["VTK"] if peers else [])]
    yield head
    yield ["---", "---", *["--:"] * (len(head) - 2)]
    for row in rows:
        parts = " + ".join(f"{ms:.0f}" for ms in (row.start, row.plain, row.engine_alone))
        yield [f"{row.volume.field} {row.volume.kind} {row.volume.type}", row.to.upper(),
               f"{row.n_bytes / 1e6:.0f}", f"{row.n_triangles / 1e6:.2f} M",
               "yes" if row.normals else "", str(row.threads), parts, f"**{row.run:.0f}**",
               f"{row.ratio():.2f}", f"{row.n_bytes / row.run / 1e3:.0f}", str(row.faults),
               *([f"{row.peer:.0f} ({row.peer / row.run:.1f} ×)" if row.peer else ""]
                 if peers else [])]


def table(rows):
    return "\n".join("| " + " | ".join(cells) + " |" for cells in columns(rows))


def machine():
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    model = re.search(r"model name\s*: (.*)", text)
    return f"{model[1] if model else 'unknown processor'}, {os.cpu_count()} cores"


def write_readme(rows, args):
    """Replaces what lies between the marks of the README."""
    readme = ROOT / "README.md"
    begin, end = "<!-- files: written by scripts/bench_files.py --readme -->", "<!-- end of files -->"
    text = readme.read_text(encoding="utf-8")
    if begin not in text or end not in text:
        sys.exit(f"README.md: no line {begin!r} or {end!r}")
    before, rest = text.split(begin, 1)
    after = rest.split(end, 1)[1]
    note = (f"\n\n{args.size}³ samples, files on tmpfs; the least of {args.rounds} rounds in turns, "
            f"in ms. Machine: {machine()}.\n")
    readme.write_text(f"{before}{begin}\n{table(rows)}{note}{end}{after}", encoding="utf-8")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words = lambda text: text.split(",")
    parser.add_argument("--mc", default=str(ROOT / "build/release/mc"))
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--dir", default="/dev/shm")
    parser.add_argument("--threads", type=words, default=sorted({"1", str(os.cpu_count())}))
    parser.add_argument("--to", type=words, default=["ply", "glb", "stl", "obj"])
    parser.add_argument("--from", dest="kinds", type=words, default=["raw"])
    parser.add_argument("--types", type=words, default=["f32"])
    parser.add_argument("--fields", type=words, default=["sphere", "gyroid"])
    parser.add_argument("--normals", type=words, default=["no", "yes"])
    parser.add_argument("--no-peers", dest="peers", action="store_false")
    parser.add_argument("--readme", action="store_true", help="write the table into README.md")
    args = parser.parse_args()
    args.threads = [int(t) for t in args.threads]
    has_vtk = shutil.which(VTK_PYTHON) and subprocess.run(
        [VTK_PYTHON, "-c", "import vtk"], stderr=subprocess.DEVNULL, check=False).returncode == 0
    args.peers = bool(has_vtk) and args.peers
    if not has_vtk:
        print("python3-vtk9 is not installed: no peer", file=sys.stderr)
    return args


def main():
    args = parse_arguments()
    block = memoryview(os.urandom(PIECE))
    rows = []
    with tempfile.TemporaryDirectory(dir=args.dir, prefix="mc-bench-") as name:
        folder = pathlib.Path(name)
        for field in args.fields:
            for kind in args.kinds:
                for sample_type in args.types if kind == "raw" else ["f32"]:
                    rows += measure_volume(args, folder, (field, kind, sample_type), block)
    print(table(rows))
    if args.readme:
        write_readme(rows, args)


def measure_volume(args, folder, what, block):
    volume = make_volume(args, folder, *what)
    rows = []
    for normals in (word == "yes" for word in args.normals):
        engine, n_triangles = engine_times(args, volume, normals, args.threads)
        for to in args.to:
            if normals and to not in WITH_NORMALS:
                continue
            for threads in args.threads:
                row = Row(volume, to, normals, threads, engine=engine[threads],
                          engine_alone=engine[1])
                measure(args, folder, row, block)
                if volume.kind != "vdb" and abs(row.n_triangles - n_triangles) > 0.02 * n_triangles:
                    sys.exit(f"mc bench meshes another {volume.field}: {n_triangles} triangles, "
                             f"not {row.n_triangles}")
                rows.append(row)
                print(" | ".join(list(columns([row]))[2]), file=sys.stderr, flush=True)
    volume.path.unlink()
    return rows


if __name__ == "__main__":
    main()
