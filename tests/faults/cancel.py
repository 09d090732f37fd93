# SPDX-License-Identifier: MIT
"""SIGINT, SIGTERM and SIGHUP while the program waits for somebody else.

A pipe that nobody reads, a FIFO without reader or writer, a call of the system that takes ten
seconds (every one of a run in turn: a write, the copy of a spool, a rename, a sync): it ends by the
signal within 0.2 s and leaves nothing. The time is taken three times, the least counts, since the
machine may be busy.
"""

import os
import signal
import subprocess
import sys
import time

import program

MOST_SECONDS = 0.2
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def asleep(pid):
    """Whether all threads of the process wait for something."""
    tasks = f"/proc/{pid}/task"
    states = [open(f"{tasks}/{task}/stat").read().rsplit(")", 1)[1].split()[0]
              for task in os.listdir(tasks)]
    return len(states) > 1 and all(state == "S" for state in states)


def seconds_to_end(mc, faults, folder, said, words, number, stdin, ready, **more):
    folder.clear()
    run = subprocess.Popen([mc.mc, *map(str, words)], cwd=folder.out, stdin=stdin,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                           env=mc.environment(folder, **more))
    until = time.monotonic() + 30
    while not ready(run):
        assert time.monotonic() < until and run.poll() is None, said
        time.sleep(0.005)
    began = time.monotonic()
    run.send_signal(number)
    status = run.wait(timeout=60)
    took = time.monotonic() - began
    faults.expect(status == -number, said, "status", program.signal_name(status))
    stderr = run.stderr.read().decode()
    run.stdout.close()
    faults.expect(not stderr, said, "says", stderr)
    faults.expect(not folder.contents(), said, "left", sorted(folder.contents()))
    faults.expect(not list(folder.spool.iterdir()), said, "left a spool")
    return took


def check(mc, faults, folder, said, words, stdin=subprocess.DEVNULL, ready=None, **more):
    blocked = ready or (lambda run: asleep(run.pid))
    times = []
    for number in SIGNALS:
        times.append(seconds_to_end(mc, faults, folder, said, words, number, stdin, blocked, **more))
        if min(times) < MOST_SECONDS and len(times) == 1 and more:
            break  # one signal is enough for each slow call
    faults.expect(min(times) < MOST_SECONDS, said, "takes", times)


def slow_calls(mc, faults, folder, kind):
    """Every call of a run in turn takes ten seconds."""
    words = [*program.output_words(folder, kind, program.output_name(kind)), "--sync"]
    folder.clear()
    calls = mc.run(folder, words, AT=0).calls
    log = folder.path / "slow.log"

    def is_slow(_):
        # Other threads go on with their calls meanwhile.
        return log.exists() and any(line.endswith("slow") for line in log.read_text().splitlines())

    for call in calls:
        if call.name == "close" and "/in/" in call.file:
            continue
        log.unlink(missing_ok=True)
        said = f"{kind}, slow {call.name} {call.file}"
        check(mc, faults, folder, said, words, ready=is_slow, SLOW=call.number, LOG=log)
    return len(calls)


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    with program.Folder(size=64) as folder:
        for kind in kinds:
            if kind not in {"gltf", "exr"}:
                to_pipe = [*program.output_words(folder, kind), "--to", kind]
                check(mc, faults, folder, f"{kind}, nobody reads the pipe", to_pipe)
        fifo = folder.inputs / "fifo"
        os.mkfifo(fifo)
        check(mc, faults, folder, "no reader",
              [*program.output_words(folder, "ply", fifo), "--to", "ply"])
        check(mc, faults, folder, "no writer",
              ["extract", fifo, *folder.raw_options(), "-q", "-o", "m.ply"])
        reading, writing = os.pipe()
        check(mc, faults, folder, "nothing comes by the pipe",
              ["extract", "-", *folder.raw_options(), "-q", "-o", "m.ply"], stdin=reading)
        os.close(writing)
        os.close(reading)
        n_calls = sum(slow_calls(mc, faults, folder, kind) for kind in ("obj", "gltf"))
    return faults.end(f"{n_calls} slow calls")


if __name__ == "__main__":
    sys.exit(main())
