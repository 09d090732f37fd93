# SPDX-License-Identifier: MIT
"""SIGINT, SIGTERM, SIGHUP and SIGKILL while the program works.

    signals.py MC LIBRARY every-call        each signal before every call of a run
    signals.py MC LIBRARY random N [SEED]   N signals at random moments, over outputs and batches

The program ends by the signal at once, says nothing, and leaves no partial file, except after
SIGKILL. What has its final name is whole: the old output or the new one, of several files all old
or all new. No system renames several files at once, so SIGKILL alone may fall between two of them:
then the first ones are new, those that follow old, and each old file that gave way is still there
as a partial. The file that names the others comes last.
"""

import json
import random
import signal
import subprocess
import sys
import time

import program

GENTLE = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
MOST_SECONDS = 5.0  # cli.signals measures 0.2 s; this is for machines under load


def seed_old(folder, old):
    folder.clear()
    for name, data in old.items():
        (folder.out / name).write_bytes(data)


def states(before, wanted):
    """What may lie there in the end: the old or the new, of several files all or none."""
    return [before, {**before, **wanted}]


def killed_between(before, wanted, left):
    """Whether SIGKILL fell between two renames of several files, and nothing is lost."""
    # The order of renames: slices by number, what names the others last.
    names = sorted(wanted, key=lambda name: (name.endswith((".gltf", ".nhdr")), name))
    for n_new in range(1, len(names)):
        new, kept = names[:n_new], names[n_new:]
        if (all(left.get(name) == wanted[name] for name in new)
                and all(left.get(name) == before.get(name) for name in kept)
                and all(name not in before or before[name] in
                        [data for other, data in left.items()
                         if other.startswith(f"{name}.partial-")] for name in new)):
            return True
    return False


def check_end(faults, said, run, number, began, folder, allowed, several=None):
    stdout, stderr = run.communicate(timeout=60)
    took = time.monotonic() - began
    faults.expect(run.returncode in {-number, 0}, said, program.signal_name(run.returncode), stderr)
    faults.expect(not stderr, said, "says", stderr)
    faults.expect(run.returncode == 0 or took < MOST_SECONDS, said, "took", took)
    left = folder.contents()
    partials = [name for name in left if ".partial-" in name]
    faults.expect(number == signal.SIGKILL or not partials, said, "left", partials)
    whole = {name: data for name, data in left.items() if name not in partials}
    between = (number == signal.SIGKILL and several is not None
               and killed_between(*several, left))
    faults.expect(whole in allowed or between, said, "left", sorted(left),
                  {name: len(data) for name, data in whole.items()})
    return run.returncode


def every_call(mc, faults, folder, kinds):
    """The number of signals."""
    n_signals = 0
    for kind in kinds:
        words = [*program.output_words(folder, kind, program.output_name(kind)), "--force"]
        folder.clear()
        calls = mc.run(folder, words, AT=0).calls
        wanted = folder.contents()
        old = {name: b"old" for name in wanted}
        for call, number in ((call, number) for call in calls
                             for number in (GENTLE[call.number % len(GENTLE)], signal.SIGKILL)):
            seed_old(folder, old)
            run = mc.start_until(folder, words, call.number)
            began = time.monotonic()
            run.send_signal(number)
            run.send_signal(signal.SIGCONT)
            check_end(faults, f"{kind}, {number.name} before {call}", run, number, began, folder,
                      states(old, wanted), (old, wanted))
            n_signals += 1
    return n_signals


class Subject:
    """A command, what it makes, and how long it takes."""

    def __init__(self, mc, folder, said, words, old):
        self.said, self.words, self.old = said, words, old
        self.seconds = min(self.seconds_of_run(mc, folder) for _ in range(2))
        self.wanted = folder.contents()
        # Of a batch any number of outputs may be there, each whole.
        self.is_batch = "--out-dir" in words
        self.has_report = "--report" in words

    def seconds_of_run(self, mc, folder):
        folder.clear()
        began = time.monotonic()
        done = mc.run(folder, self.words)
        assert done.status == 0, done.stderr
        return time.monotonic() - began

    def allowed(self, left):
        if self.is_batch:
            return [{name: self.wanted.get(name) for name in left if ".partial-" not in name}]
        if not self.has_report:
            return states(self.old, self.wanted)
        mesh = {"m.obj": self.wanted["m.obj"]}
        report = left.get("r.json")
        if report == self.old["r.json"]:
            return [self.old, {**self.old, **mesh}]
        # It comes last, of a run that got to its end, and no two are alike.
        return [{**mesh, "r.json": report}] if tells_success(report) else []


def tells_success(report):
    try:
        return report.endswith(b"}\n") and json.loads(report)["status"] == 0
    except (AttributeError, ValueError):
        return False


def subjects(mc, folder):
    for kind in (*program.MESHES, "nrrd", "vdb", "exr"):
        words = program.output_words(folder, kind, program.output_name(kind))
        yield kind, [*words, "--force"]
    batch = []
    for name in "abcdef":
        path = folder.inputs / f"{name}.raw"
        path.write_bytes(folder.raw.read_bytes())
        batch.append(path)
    yield "batch", ["extract", *batch, *folder.raw_options(), "-q", "--out-dir", folder.out, "--to",
                    "glb"]
    yield "report", [*program.output_words(folder, "obj", "m.obj"), "--report", "r.json", "--force"]


def at_random(mc, faults, folder, n_signals, seed):
    chance = random.Random(seed)
    print("seed", seed)
    every = []
    for said, words in subjects(mc, folder):
        subject = Subject(mc, folder, said, words, {})
        if not subject.is_batch:
            subject.old = {name: b"old" for name in subject.wanted}
        every.append(subject)
    n_ended_by_signal = 0
    for n in range(n_signals):
        subject = chance.choice(every)
        number = chance.choice((*GENTLE, signal.SIGKILL))
        seed_old(folder, subject.old)
        environment = mc.environment(folder)
        if number == signal.SIGKILL:  # AddressSanitizer's search for leaks complains of it
            options = environment.get("ASAN_OPTIONS", "")
            environment["ASAN_OPTIONS"] = f"{options}:detect_leaks=0"
        run = subprocess.Popen([mc.mc, *map(str, subject.words)], cwd=folder.out,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, env=environment)
        time.sleep(chance.uniform(0, 1.1 * subject.seconds))
        began = time.monotonic()
        run.send_signal(number)
        said = f"{subject.said}, signal {n}, {number.name}"
        run.wait(timeout=60)
        allowed = subject.allowed(folder.contents())
        several = None if subject.is_batch or subject.has_report else (subject.old, subject.wanted)
        status = check_end(faults, said, run, number, began, folder, allowed, several)
        n_ended_by_signal += status != 0
    # Not a law, but a run in which no signal came in time would show nothing.
    faults.expect(n_ended_by_signal > n_signals / 4, "only", n_ended_by_signal, "came in time")
    return f"{n_signals} signals, {n_ended_by_signal} in time"


def main():
    mc, (how, *rest) = program.arguments()
    faults = program.Faults()
    with program.Folder(size=32 if how == "every-call" else 56) as folder:
        if how == "every-call":
            return faults.end(f"{every_call(mc, faults, folder, rest)} signals")
        seed = int(rest[1]) if len(rest) > 1 else random.randrange(1 << 32)
        return faults.end(at_random(mc, faults, folder, int(rest[0]), seed))


if __name__ == "__main__":
    sys.exit(main())
