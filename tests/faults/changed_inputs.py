# SPDX-License-Identifier: MIT
"""Inputs that are cut or overwritten while they are read.

The program is stopped before one call after the other, and the file it has mapped is changed. A
file that becomes shorter takes mapped pages away: no crash, but status 3 and one message that names
the file; no output under its name, no partial, an old output untouched. The same where the file
keeps its length and gets other bytes, and in a batch only for that input. Once everything has been
read, a change comes too late to matter.
"""

import json
import os
import random
import signal
import sys
import time

import program

N = 144  # samples along an edge: enough for several slabs


def write_noise(path, seed):
    path.write_bytes(random.Random(seed).randbytes(N * N) * N)
    time.sleep(0.01)  # the clock of the file system goes on in steps


def cut(path):
    os.truncate(path, 5000)


def overwrite(path):
    with open(path, "r+b") as file:
        file.seek(N * N * N // 2)
        file.write(b"\x80" * (N * N))


def check_stop(mc, faults, folder, said, words, call, change, old, wanted):
    """Changes the volume before that call; status, 0 only with the whole output, and messages."""
    path = folder.inputs / "noise.raw"
    write_noise(path, 1)
    folder.clear()
    for name, data in old.items():
        (folder.out / name).write_bytes(data)
    run = mc.start_until(folder, words, call)
    if not faults.expect(run is not None, said, "had ended before"):
        return 0, ""
    change(path)
    run.send_signal(signal.SIGCONT)
    _, stderr = run.communicate(timeout=60)
    stderr = stderr.decode()
    if run.returncode == 0:
        faults.expect(folder.contents() == wanted and not stderr, said, "other bytes", stderr)
        return 0, stderr
    lines = stderr.splitlines()
    faults.expect(run.returncode == 3, said, "status", program.signal_name(run.returncode), stderr)
    faults.expect(len(lines) == 1 and lines[0].startswith(f"mc: error: {path}: "), said, stderr)
    faults.expect(("changed while" if change is overwrite else "while it was read") in stderr, said,
                  "says", stderr)
    faults.expect(folder.contents() == old, said, "left", sorted(folder.contents()))
    return run.returncode, stderr


def check_all(mc, faults, folder, said, words, change, old):
    """Stops before every second call from the mapping on; how many runs."""
    path = folder.inputs / "noise.raw"
    write_noise(path, 1)
    folder.clear()
    calls = mc.run(folder, words, AT=0).calls
    wanted = folder.contents()
    first = next(c.number for c in calls if c.name == "mmap") + 1
    stops = range(first, len(calls) + 1, 2)
    ends = [check_stop(mc, faults, folder, f"{said} before call {n}", words, n, change, old, wanted)
            for n in stops]
    statuses = [status for status, _ in ends]
    faults.expect(statuses == sorted(statuses, reverse=True) and statuses[0] == 3, said, statuses)
    if change is cut:
        faults.expect(any("became shorter" in stderr for _, stderr in ends), said,
                      "no page was missed")
    return len(stops)


def check_batch(mc, faults, folder, threads):
    """The others are converted, also by threads that are at it at the same time."""
    names = ["a", "b", "c"]
    for seed, name in enumerate(names):
        write_noise(folder.inputs / f"{name}.raw", seed)
    folder.clear()
    words = ["extract", *(folder.inputs / f"{name}.raw" for name in names), "--dims", f"{N},{N},{N}",
             "--type", "u8", "--iso", "250.5", "-q", "--threads", threads, "--out-dir",
             folder.out, "--to", "ply", "--report", "-"]
    calls = mc.run(folder, words, AT=0).calls
    begun = next(c.number for c in calls if c.name == "create" and "/b.ply.partial" in c.file)
    folder.clear()
    run = mc.start_until(folder, words, begun)
    cut(folder.inputs / "b.raw")
    run.send_signal(signal.SIGCONT)
    stdout, stderr = run.communicate(timeout=60)
    statuses = [json.loads(line)["status"] for line in stdout.splitlines()]
    faults.expect(run.returncode == 3 and statuses == [0, 3, 0], "batch", run.returncode, statuses,
                  stderr.decode())
    faults.expect(sorted(folder.contents()) == ["a.ply", "c.ply"], "batch left",
                  sorted(folder.contents()))


def main():
    mc, _ = program.arguments()
    faults = program.Faults()
    n_runs = 0
    with program.Folder() as folder:
        noise = folder.inputs / "noise.raw"
        of_noise = [noise, "--dims", f"{N},{N},{N}", "--type", "u8", "-q", "--threads", "1"]
        extract = ["extract", *of_noise, "--iso", "250.5"]
        runs = {
            "extract to ply": ([*extract, "-o", "m.ply"], {}),
            "extract to obj, forced": ([*extract, "-o", "m.obj", "--force"], {"m.obj": b"old"}),
            "sample to nrrd": (["sample", *of_noise, "-o", "m.nrrd"], {}),
        }
        for said, (words, old) in runs.items():
            for change in (cut, overwrite):
                said_all = f"{said}, {change.__name__}"
                n_runs += check_all(mc, faults, folder, said_all, words, change, old)
        check_batch(mc, faults, folder, "1")
        check_batch(mc, faults, folder, "2")
    return faults.end(f"{n_runs + 2} runs")


if __name__ == "__main__":
    sys.exit(main())
