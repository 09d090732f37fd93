#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The program keeps within --memory, and says before what it will take.

    budget.py --mc MC mesh|statistics|least|simplify|estimate [--vdb] [--exr]

Every run with a budget has the kernel's own limit on memory that is not of files (RLIMIT_DATA), is
watched from outside, and gives the bytes of a run that may take all it wants.
"""

import argparse
import json
import math
import os
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile
import time

MIB = 1 << 20
STACK_BYTES = 9 * MIB  # a thread's, of which it touches a page or two
FREE = 1 << 30


def anonymous_bytes(pid, program):
    """Now, pages of files aside; 0 where it has ended, or is still what started it."""
    try:
        words = pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()
        started = os.readlink(f"/proc/{pid}/exe") == program
    except OSError:
        return 0
    if len(words) < 3 or not started:
        return 0
    return (int(words[1]) - int(words[2])) * os.sysconf("SC_PAGE_SIZE")


def watched(command, limit_bytes, folder, piped=None):
    """Runs a command; returns its status, stderr, and most bytes resident that are not of files."""

    def limit():
        resource.setrlimit(resource.RLIMIT_DATA, (limit_bytes, limit_bytes))

    with open(folder / "stderr", "w+b") as err:
        feeder = subprocess.Popen(["cat", piped], cwd=folder, stdout=subprocess.PIPE) \
            if piped else None
        process = subprocess.Popen(command, cwd=folder, stderr=err, preexec_fn=limit,
                                   stdin=feeder.stdout if feeder else subprocess.DEVNULL)
        if feeder:
            feeder.stdout.close()
        most = 0
        while process.poll() is None:
            most = max(most, anonymous_bytes(process.pid, command[0]))
            time.sleep(0.001)
        if feeder:
            feeder.wait()
        err.seek(0)
        return process.returncode, err.read().decode(), most


def noise_bytes(n, seed):
    return random.Random(seed).randbytes(n)


def make_inputs(folder):
    """White noise, a file larger than its budget, a spec."""
    head = "NRRD0004\ntype: int16\ndimension: 3\nsizes: 512 512 4\nencoding: raw\nendian: little\n\n"
    (folder / "noise.nrrd").write_bytes(head.encode() + noise_bytes(2 * 512 * 512 * 4, 2))
    with open(folder / "large.raw", "wb") as large:
        large.truncate(512 * 512 * 256)
        large.seek(512 * 512 * 100 + 1000)
        large.write(noise_bytes(512 * 512, 3))
    (folder / "hills.json").write_text(json.dumps({
        "format": "mc-volume", "version": 1, "convention": "density", "iso": 0,
        "grid": {"cells": [500, 400, 40], "spacing": 1},
        "field": {"type": "perlin", "frequency": 0.31}}))
    large = ["--dims", "512,512,256", "--type", "u8", "--iso", "127.5"]
    return {
        "noise": (["noise.nrrd", "--iso", "0.5"], 28),
        "large": (["large.raw", *large], 24),
        "hills": (["hills.json"], 28),
    }


def extract(mc, words, output, budget_mib, threads, folder):
    """A run within a budget; returns what it wrote."""
    command = [mc, "extract", *words, "-o", output, "--force", "-q", "--memory", f"{budget_mib}MiB",
               "--threads", str(threads), "--report", "report.json"]
    limit = budget_mib * MIB + (threads + 2) * STACK_BYTES
    status, err, most = watched(command, limit, folder)
    what = f"{words[0]} -> {output}, {budget_mib} MiB, {threads} threads"
    if status != 0:
        sys.exit(f"{what}: status {status}: {err}")
    reported = json.loads((folder / "report.json").read_text())["peak_bytes"]
    print(f"{what}: {most / MIB:.1f} MiB, reported {reported / MIB:.1f}")
    if max(most, reported) > budget_mib * MIB:
        sys.exit(f"{what}: took more than it may")
    if not 0.5 * most <= reported <= 2 * most + MIB:
        sys.exit(f"{what}: reports a peak of {reported}, but {most} were seen")
    return (folder / output).read_bytes()


def check_mesh(mc, folder):
    inputs = make_inputs(folder)
    outputs = {"noise": ["m.glb"], "large": ["m.ply"], "hills": ["m.ply", "m.glb"]}
    for name, (words, budget) in inputs.items():
        for output in outputs[name]:
            free = extract(mc, words, output, 1024, 2, folder)
            for threads in (1, 7):
                if extract(mc, words, output, budget, threads, folder) != free:
                    sys.exit(f"{name} -> {output}: other bytes within {budget} MiB")


def check_statistics(mc, folder):
    """Thresholds and percentiles of wide types, whose counters are large."""
    (folder / "i32.raw").write_bytes(noise_bytes(64 * 64 * 64 * 4, 4))
    raw = ["i32.raw", "--dims", "64,64,64", "--type", "i32"]
    for iso in ("otsu", "p1,p20,p50,p77,p99"):
        free = extract(mc, [*raw, "--iso", iso], "m.obj", 1024, 7, folder)
        if extract(mc, [*raw, "--iso", iso], "m.obj", 32, 7, folder) != free:
            sys.exit(f"{iso}: other bytes within 32 MiB")


def check_least(mc, folder):
    """The least budget that a refusal names works, and no smaller one."""
    for words, _ in make_inputs(folder).values():
        refused = subprocess.run([mc, "extract", *words, "-o", "r.ply", "--memory", "1MiB"],
                                 cwd=folder, capture_output=True, text=True)
        named = re.search(r"needs at least (\d+) MiB", refused.stderr)
        if refused.returncode != 6 or not named or (folder / "r.ply").exists():
            sys.exit(f"{words[0]}: no refusal that names a budget: {refused.stderr}")
        least = int(named.group(1))
        extract(mc, words, "r.ply", least, 1, folder)
        (folder / "r.ply").unlink()
        less = subprocess.run([mc, "extract", *words, "-o", "r.ply", "--memory", f"{least - 1}MiB"],
                              cwd=folder, capture_output=True, text=True)
        if less.returncode != 6:
            sys.exit(f"{words[0]}: {least - 1} MiB are less than the least, but status is "
                     f"{less.returncode}")


def check_simplify(mc, folder):
    """Simplification keeps within the least budget that a dry run names, and is refused below."""
    inputs = make_inputs(folder)
    for name in ("noise", "large"):
        words, _ = inputs[name]
        simplified = [*words, "--simplify", "ratio=0.2"]
        told = subprocess.run([mc, "extract", *simplified, "-o", "s.ply", "--dry-run", "-v"],
                              cwd=folder, capture_output=True, text=True, check=True)
        least = math.ceil(float(re.search(r"([0-9.]+) MiB would do", told.stdout).group(1)))
        free = extract(mc, simplified, "s.ply", 4096, 2, folder)
        for budget, threads in ((least, 1), (least, 7), (least + least // 2, 7)):
            if extract(mc, simplified, "s.ply", budget, threads, folder) != free:
                sys.exit(f"{words[0]}: other bytes within {budget} MiB")
        less = subprocess.run([mc, "extract", *simplified, "-o", "r.ply", "--memory",
                               f"{least - 1}MiB"], cwd=folder, capture_output=True, text=True)
        if less.returncode != 6 or "simplify needs at least" not in less.stderr:
            sys.exit(f"{words[0]}: {least - 1} MiB are less than the least, but status is "
                     f"{less.returncode}: {less.stderr}")


def ball_spec(cells):
    return {"format": "mc-volume", "version": 1, "convention": "sdf", "iso": 0,
            "grid": {"cells": [cells] * 3, "spacing": 1, "origin": [-cells / 2] * 3},
            "field": {"type": "sphere", "radius": 0.45 * cells}}


def make_volumes(mc, folder, vdb, exr):
    """A ball and noise as every kind of input; of each the words of the command, and the pipe."""
    (folder / "ball.json").write_text(json.dumps(ball_spec(255)))
    (folder / "slices").mkdir()
    outputs = ["ball.nrrd", *["ball.vdb"] * vdb, *["slices/ball.####.exr"] * exr]
    for output in outputs:
        subprocess.run([mc, "sample", "ball.json", "-q", "-o", output], cwd=folder, check=True)
    (folder / "small.json").write_text(json.dumps(ball_spec(127)))
    subprocess.run([mc, "sample", "small.json", "-q", "-o", "small.nrrd"], cwd=folder, check=True)
    named = ball_spec(255)
    named["field"] = {"type": "volume", "path": "small.nrrd"}
    (folder / "named.json").write_text(json.dumps(named))
    (folder / "noise.raw").write_bytes(noise_bytes(512 * 512 * 40, 5))
    noise = ["--dims", "512,512,40", "--type", "u8"]
    volumes = {
        "file": (["ball.nrrd"], None),
        "stdin": (["-"], "ball.nrrd"),
        "spec": (["ball.json"], None),
        "spec of a volume": (["named.json"], None),
        "vdb": (["ball.vdb"], None),
        "slices": (["slices"], None),
        "noise": (["noise.raw", *noise], None),
        "noise from stdin": (["-", *noise], "noise.raw"),
    }
    return {name: volumes[name] for name in volumes
            if (vdb or name != "vdb") and (exr or name != "slices")}


def estimate_of(mc, words, piped, budget_mib, threads, folder):
    command = [mc, "info", *words, "--memory-estimate", "--json", "--memory", f"{budget_mib}MiB",
               "--threads", str(threads)]
    with open(folder / piped, "rb") if piped else open(os.devnull, "rb") as data:
        with subprocess.Popen(["cat"], stdin=data, stdout=subprocess.PIPE) as cat:
            done = subprocess.run(command, cwd=folder, stdin=cat.stdout, capture_output=True,
                                  check=True)
    grid = json.loads(done.stdout)["grids"][0]
    return grid["memory"], grid["suggested_iso"]


def is_loose(expected, most, alone, threads):
    """Whether an estimate is over three times what the run could take.

    A pipeline of several threads has two chunks a thread, but how many of them are filled is the
    scheduler's choice (one where the machine has one processor free): so many times what one
    thread takes is as good a peak as the one seen.
    """
    slots = 1 if threads == 1 else 2 * threads
    return expected > 3 * max(most, slots * alone) + 16 * MIB


def check_estimate(mc, folder, vdb, exr):
    """What a run takes is what was said: no more, and not much less."""
    faults = 0
    estimates, peaks = {}, {}
    for name, (words, piped) in make_volumes(mc, folder, vdb, exr).items():
        for budget, threads, formats in ((1024, 1, ("ply", "glb")), (1024, 2, ("ply", "glb")),
                                         (64, 1, ("glb",)), (64, 2, ("glb",))):
            memory, iso = estimate_of(mc, words, piped, budget, threads, folder)
            estimates[name, budget, threads] = memory["expected"]
            for to in formats:
                command = [mc, "extract", *words, "-o", f"m.{to}", "--force", "-q", "--iso",
                           str(iso), "--memory", f"{budget}MiB", "--threads", str(threads)]
                status, err, most = watched(command, FREE * 4, folder, piped)
                if status != 0:
                    sys.exit(f"{name}: status {status}: {err}")
                peaks[name, budget, threads, to] = most
                loose = is_loose(memory["expected"], most, peaks[name, budget, 1, to], threads)
                wrong = loose or not most <= memory["expected"] <= memory["most"] <= budget * MIB
                faults += wrong
                print(f"{name} -> {to}, {budget} MiB, {threads} threads: took {most / MIB:.1f} of "
                      f"{memory['expected'] / MIB:.1f} expected, {memory['most'] / MIB:.1f} at most"
                      f"{'  WRONG' if wrong else ''}")
    # Had the ball's estimate been given for the noise, it would have been found wrong.
    if peaks["noise", 1024, 2, "glb"] <= estimates["file", 1024, 2]:
        sys.exit("the noise takes too little to show anything")
    if faults:
        sys.exit(f"{faults} wrong estimates")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True)
    parser.add_argument("--vdb", action="store_true", help="VDB can be written and read")
    parser.add_argument("--exr", action="store_true", help="and OpenEXR")
    checks = {"mesh": check_mesh, "statistics": check_statistics, "least": check_least,
              "simplify": check_simplify, "estimate": check_estimate}
    parser.add_argument("part", choices=checks)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        volumes = [args.vdb, args.exr] if args.part == "estimate" else []
        checks[args.part](os.path.realpath(args.mc), pathlib.Path(name), *volumes)


if __name__ == "__main__":
    main()
