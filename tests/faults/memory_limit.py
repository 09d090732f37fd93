# SPDX-License-Identifier: MIT
"""Too little address space (RLIMIT_AS): from what the program cannot even start with, in steps, to
what is enough.

Wherever memory ends, in this program, in a library or while a thread is made: status 6, one message,
no output under its name, no partial, an old output untouched; never a crash or a hang.
"""

import resource
import subprocess
import sys

import program

MIB = 1 << 20
STEP = 2 * MIB


def run_within(mc, folder, words, limit):
    """None where the loader could not start the program."""
    done = subprocess.run([mc.mc, *map(str, words)], cwd=folder.out, stdin=subprocess.DEVNULL,
                          capture_output=True, env=mc.environment(folder), timeout=60, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    stderr = done.stderr.decode(errors="replace")
    if done.returncode == 127 or "error while loading shared libraries" in stderr:
        return None
    return program.Ended(done.returncode, done.stdout, stderr, [])


def least_to_start(mc, folder):
    """The least limit with which `mc --version` runs."""
    low, high = 0, 4096
    while high - low > 1:
        middle = (low + high) // 2
        done = run_within(mc, folder, ["--version"], middle * MIB)
        low, high = (low, middle) if done is not None and done.status == 0 else (middle, high)
    return high * MIB


def try_all(mc, faults, folder, kind, words, start):
    """The number of limits that were too small."""
    folder.clear()
    faults.expect(mc.run(folder, words).status == 0, kind)
    wanted = folder.contents()
    old = {name: b"old" for name in wanted}
    for n in range(1000):
        limit = start + n * STEP
        for name, data in old.items():
            (folder.out / name).write_bytes(data)
        done = run_within(mc, folder, [*words, "--force"], limit)
        if done is None:
            continue
        said = f"{kind} within {limit / MIB:.0f} MiB"
        if done.status == 0:
            faults.expect(folder.contents() == wanted, said, "other bytes")
            return n
        faults.expect(done.status == 6, said, "status", program.signal_name(done.status),
                      done.stderr)
        faults.expect(len(done.errors()) == 1, said, "says", done.stderr)
        faults.expect(folder.contents() == old, said, "left", sorted(folder.contents()))
    faults.expect(False, kind, "never has enough")
    return n


def main():
    mc, kinds = program.arguments()
    if b"libasan" in subprocess.run(["ldd", mc.mc], capture_output=True, check=False).stdout:
        program.skip("address sanitizer wants all address space there is")
    faults = program.Faults()
    with program.Folder() as folder:
        start = least_to_start(mc, folder)
        n_small = 0
        for kind in kinds:
            for threads in ("1", "2"):
                words = program.output_words(folder, kind, program.output_name(kind))
                n_small += try_all(mc, faults, folder, kind, [*words, "--threads", threads], start)
            words = ["extract", folder.spec, "-q", "-o", "m.ply"]
        n_small += try_all(mc, faults, folder, "spec", words, start)
    return faults.end(f"{n_small} limits that are too small, from {start // MIB} MiB")


if __name__ == "__main__":
    sys.exit(main())
