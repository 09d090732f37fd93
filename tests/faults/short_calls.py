# SPDX-License-Identifier: MIT
"""Calls that move less than they were asked to, and calls that signals interrupt.

Reads, writes and copies of one byte to half of what was asked; every second or third call
interrupted before it has done anything; SIGALRM every fifth of a millisecond without SA_RESTART,
over files and over pipes that are full or empty most of the time. The output is the same, byte for
byte, and nothing is said.
"""

import pathlib
import subprocess
import sys

import program

STORMS = ({"SHORT": 1}, {"EINTR": 2}, {"SHORT": 1, "EINTR": 3}, {"SHORT": 1, "ALARM": 200})


def slowly_through(mc, folder, words, source, **faults):
    """stdout of the program, fed and drained by `dd`s of small blocks."""
    feed = subprocess.Popen(["dd", "bs=700", "status=none", f"if={source}"], stdout=subprocess.PIPE)
    run = subprocess.Popen([mc.mc, *map(str, words)], cwd=folder.out, stdin=feed.stdout,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                           env=mc.environment(folder, **faults))
    feed.stdout.close()
    drain = subprocess.Popen(["dd", "bs=900", "status=none"], stdin=run.stdout,
                             stdout=subprocess.PIPE)
    run.stdout.close()
    data, _ = drain.communicate(timeout=60)
    stderr = run.stderr.read().decode()
    return run.wait(timeout=60), data, stderr + (b"" if feed.wait() == 0 else b"feed").decode()


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    n_runs = 0
    with program.Folder() as folder:
        for kind in kinds:
            words = program.output_words(folder, kind, program.output_name(kind))
            folder.clear()
            faults.expect(mc.run(folder, words).status == 0, kind)
            wanted = folder.contents()
            for storm in STORMS:
                folder.clear()
                done = mc.run(folder, words, **storm)
                faults.expect(done.status == 0 and not done.stderr and folder.contents() == wanted,
                              kind, storm, done.status, done.stderr)
                n_runs += 1
            if kind in {"gltf", "exr"}:
                continue
            to_pipe = [*program.output_words(folder, kind), "--to", kind]
            to_pipe[1] = "-"
            plain = mc.run(folder, to_pipe, stdin=pathlib.Path(folder.raw).read_bytes())
            for storm in STORMS:
                status, data, stderr = slowly_through(mc, folder, to_pipe, folder.raw, **storm)
                faults.expect(status == 0 and data == plain.stdout and not stderr, kind,
                              "through pipes", storm, status, len(data), stderr)
                n_runs += 1
    return faults.end(f"{n_runs} runs")


if __name__ == "__main__":
    sys.exit(main())
