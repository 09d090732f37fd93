# SPDX-License-Identifier: MIT
"""Readers that go away: at once, after a byte, in the middle, before the last byte.

The program dies by SIGPIPE without a word, whatever it writes, and leaves no spool; also where its
parent had SIGPIPE ignored.
"""

import signal
import subprocess
import sys

import program


def start(mc, folder, words, **more):
    return subprocess.Popen([mc.mc, *map(str, words)], cwd=folder.out, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env=mc.environment(folder), bufsize=0, **more)


def leave_after(run, n_bytes):
    """Reads so much, and leaves; status and messages."""
    while n_bytes > 0 and (data := run.stdout.read(min(n_bytes, 4096))):
        n_bytes -= len(data)
    run.stdout.close()
    stderr = run.stderr.read().decode()
    return run.wait(timeout=60), stderr


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    n_runs = 0
    with program.Folder(size=64) as folder:
        for kind in kinds:
            words = [*program.output_words(folder, kind), "--to", kind]
            whole = len(mc.run(folder, words).stdout)
            faults.expect(whole > 200_000, kind, "fits into a pipe", whole)
            for n_bytes in (0, 1, 4000, whole // 2, whole - 90_000):
                status, stderr = leave_after(start(mc, folder, words), n_bytes)
                said = f"{kind}, reader left after {n_bytes} of {whole}"
                faults.expect(status == -signal.SIGPIPE and not stderr, said,
                              program.signal_name(status), stderr)
                faults.expect(not list(folder.spool.iterdir()), said, "left a spool")
                n_runs += 1
        ignoring = start(mc, folder, words, restore_signals=False)  # as Python has it
        status, stderr = leave_after(ignoring, 1)
        faults.expect(status == -signal.SIGPIPE and not stderr, "SIGPIPE ignored",
                      program.signal_name(status), stderr)
    return faults.end(f"{n_runs + 1} runs")


if __name__ == "__main__":
    sys.exit(main())
