#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lets mc and its peers take turns on the same volumes, and says what came out.

Every program holds its volume in a process of its own and makes one mesh at a time, when it is told
to, so that what disturbs the machine disturbs all of them alike: round after round, one after the
other. Times are taken inside the programs, around the one call. Figures are medians over the rounds;
their spread is the median absolute deviation. All figures go to results.json in the build folder.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

import bench_report

FIELDS = ("sphere", "terrain", "gyroid", "noise")
PARTS = ("dense", "sparse", "growth")


@dataclasses.dataclass
class Bench:
    """Where programs and volumes are, and how many rounds are asked for."""
    programs: pathlib.Path
    volumes: pathlib.Path
    rounds: int

    def program(self, name):
        return self.programs / "tests" / "bench" / name

    def has(self, name):
        return self.program(name).exists()

    def run(self, name, *words):
        done = subprocess.run([self.program(name), *map(str, words)], check=True,
                              capture_output=True, text=True)
        return done.stdout.strip()

    def field(self, name, size, periods=8):
        """A raw file of the field's samples; only the last one made is kept."""
        path = self.volumes / f"{name}_{size}_{periods}.raw"
        if not path.exists():
            for old in self.volumes.glob("*.raw"):
                old.unlink()
            self.run("mc_peer", "fields", name, size, periods, path)
        return path


class Contestant:
    """A program that holds its volume and makes a mesh at a time."""

    def __init__(self, name, command):
        self.name = name
        self.seconds = []
        self.vertices = self.faces = 0
        self.process = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        if self.process.stdout.readline() != "ready\n":
            self.close()
            sys.exit(f"bench: {name} failed: {command}")

    def turn(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        seconds, vertices, faces = self.process.stdout.readline().split()
        self.seconds.append(float(seconds))
        self.vertices, self.faces = int(vertices), int(faces)

    def close(self):
        self.process.communicate()  # the end of its stdin ends it

    def result(self):
        median = statistics.median(self.seconds)
        spread = statistics.median(abs(s - median) for s in self.seconds)
        return {"ms": 1e3 * median, "least_ms": 1e3 * min(self.seconds), "spread_ms": 1e3 * spread,
                "rounds": len(self.seconds), "vertices": self.vertices, "faces": self.faces}


def contest(commands, rounds):
    """Results by name, of programs that take turns; no two run at once."""
    contestants = [Contestant(name, command) for name, command in commands.items()]
    for _ in range(rounds):
        for contestant in contestants:
            contestant.turn()
    for contestant in contestants:
        contestant.close()
    return {contestant.name: contestant.result() for contestant in contestants}


def free_bytes():
    with open("/proc/meminfo", encoding="ascii") as file:
        for line in file:
            if line.startswith("MemAvailable:"):
                return 1024 * int(line.split()[1])
    return 0


def vtk_commands(bench, path, size, threads, normals, heaps):
    """VTK with one thread without its thread pools, with more in each of them."""
    backends = ("Sequential",) if threads == 1 else ("STDThread", "TBB")
    return {f"vtk {heap} {backend}": [bench.program("vtk_peer"), path, size, backend, threads, heap,
                                      normals]
            for heap in heaps for backend in backends}


def dense_contest(bench, path, size, threads, normals, heaps=("kept", "plain"), vdb=True):
    """One field: ours, reading it, and the peers there are; of VTK's back ends the best counts."""
    mc = bench.program("mc_peer")
    commands = {"mc": [mc, "dense", path, size, threads, normals],
                "read": [mc, "read", path, size, threads]}
    peers = {}
    if bench.has("vtk_peer"):
        peers |= vtk_commands(bench, path, size, threads, normals, heaps)
    if vdb and bench.has("vdb_peer") and normals == "none":
        peers["vdb"] = [bench.program("vdb_peer"), "dense", path, size, threads]
    # Each program has a copy of the samples, and a mesh of at most 80 triangles to a column.
    room = 0.9 * free_bytes() / (4 * size**3 + 80 * 20 * size**2) - len(commands)
    for name in list(peers)[max(0, int(room)):]:
        print(f"bench: {name} is left out at {size}^3: memory is short", file=sys.stderr)
        del peers[name]
    results = contest(commands | peers, bench.rounds)
    for heap in ("kept", "plain"):
        tried = [r for name, r in results.items() if name.startswith(f"vtk {heap} ")]
        if tried:
            results[f"vtk {heap}"] = min(tried, key=lambda r: r["ms"])
    ours, kept = results["mc"], results.get("vtk kept", results["mc"])
    if (kept["vertices"], kept["faces"]) != (ours["vertices"], ours["faces"]):
        print(f"bench: {path.name}: VTK made {kept['faces']} triangles, we {ours['faces']}",
              file=sys.stderr)
    return {name: r for name, r in results.items() if len(name.split()) < 3}


def dense(bench, size, threads):
    rows = []
    for field in FIELDS:
        path = bench.field(field, size)
        for n_threads in threads:
            for normals in ("none", "gradient"):
                results = dense_contest(bench, path, size, n_threads, normals)
                rows.append({"volume": field, "size": size, "threads": n_threads,
                             "normals": normals, "results": results})
                print(bench_report.text_row(rows[-1]), flush=True)
    return rows


def sparse(bench, sizes, threads):
    """A level set and a fog, each in a VDB file that ours and OpenVDB have read."""
    if not bench.has("vdb_peer"):
        return []
    rows = []
    for kind, iso in (("sphere", 0), ("fog", 0.2)):
        path = bench.volumes / f"{kind}.vdb"
        active = int(bench.run("vdb_peer", "make", kind, sizes[kind], path))
        for n_threads in threads:
            results = contest({"mc": [bench.program("mc_peer"), "sparse", path, iso, n_threads],
                               "vdb": [bench.program("vdb_peer"), "sparse", path, iso, n_threads]},
                              bench.rounds)
            rows.append({"volume": f"{kind}.vdb", "size": sizes[kind], "active": active,
                         "threads": n_threads, "normals": "none", "results": results})
            print(bench_report.text_row(rows[-1]), flush=True)
        path.unlink()
    return rows


def growth(bench, sizes, triangle_size, periods):
    """One thread: time against samples (a sphere), and against triangles (gyroids of one size)."""
    rows = []
    for field, size, n in ([("sphere", size, 8) for size in sizes] +
                           [("gyroid", triangle_size, n) for n in periods]):
        path = bench.field(field, size, n)
        results = dense_contest(bench, path, size, 1, "none", heaps=("kept",), vdb=size <= 512)
        rows.append({"volume": field, "size": size, "periods": n, "threads": 1, "normals": "none",
                     "results": results})
        print(bench_report.text_row(rows[-1]), flush=True)
    return rows


def machine(bench):
    """What mc bench says of machine, memory and the demo's terrain."""
    done = subprocess.run([bench.programs / "mc", "bench", "--json", "--size", "64"], check=True,
                          capture_output=True, text=True)
    found = json.loads(done.stdout)
    found["cores"] = os.cpu_count()
    found["compiler"] = subprocess.run(["c++", "--version"], check=False, capture_output=True,
                                       text=True).stdout.partition("\n")[0]
    return found


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/bench", description=__doc__.partition("\n")[0])
    parser.add_argument("--build", required=True, type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--size", type=int, default=512, help="samples an axis (default: 512)")
    parser.add_argument("--rounds", type=int, default=10, help="turns of each (default: 10)")
    parser.add_argument("--quick", action="store_true", help="small volumes, 5 rounds: a trial")
    parser.add_argument("--parts", default="dense,sparse", metavar="LIST",
                        help="of dense, sparse and growth (default: the first two)")
    parser.add_argument("--readme", action="store_true",
                        help="all parts; then write README.md's section on speed and its plots")
    return parser.parse_args()


def measure(bench, args, parts):
    """All results, by part. Volumes of --quick are an eighth of the others along each axis."""
    threads = sorted({1, os.cpu_count()})
    scale = 8 if args.quick else 1
    size = args.size // (4 if args.quick else 1)
    results = {"machine": machine(bench)}
    for name in ("vtk_peer", "vdb_peer"):
        if not bench.has(name):
            print(f"bench: no {name}: its package is not installed; see scripts/bench --install",
                  file=sys.stderr)
    print(bench_report.text_head(results["machine"]), flush=True)
    if "dense" in parts:
        results["dense"] = dense(bench, size, threads)
    if "sparse" in parts:
        results["sparse"] = sparse(bench, {"sphere": 2000 // scale, "fog": 512 // scale}, threads)
    if "growth" in parts:
        sizes = [64, 128, 256] if args.quick else [64, 128, 256, 512, 1024]
        results["growth"] = growth(bench, sizes, 64 if args.quick else 256, [1, 2, 4, 8, 16, 32])
    return results


def main():
    args = arguments()
    parts = PARTS if args.readme else args.parts.split(",")
    unknown = set(parts) - set(PARTS)
    if unknown:
        sys.exit(f"bench: --parts: unknown {', '.join(unknown)}: expected {', '.join(PARTS)}")
    # Not in a file system in memory: a large field would take the room of a program.
    volumes = tempfile.mkdtemp(prefix="mc-bench-", dir=args.build)
    try:
        bench = Bench(args.build, pathlib.Path(volumes), 5 if args.quick else args.rounds)
        results = measure(bench, args, parts)
    finally:
        shutil.rmtree(volumes)
    (args.build / "results.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if args.readme:
        root = pathlib.Path(__file__).resolve().parent.parent
        bench_report.write_readme(root, results)


if __name__ == "__main__":
    main()
