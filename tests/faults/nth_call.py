# SPDX-License-Identifier: MIT
"""Every system call that touches files fails once, the first, the second ... until a run passes.

However it fails: the right status, one message that says what the system said, nothing under the
final name, no partial file, an old output untouched. Where the program can do without the call,
the output is the same, byte for byte.
"""

import errno
import os
import sys

import program

# Calls that only spare work: without them the bytes go through a buffer, a spool has a name for a
# moment, a file is set aside by a rename.
SPARED = {"copy_file_range", "sendfile", "renameat2", "tmpfile", "link"}
# unlink() is not here: what the system does not let go, nobody can take away (see try_unlinks()).
CALLS = ("open,read,pread,mmap,close,create,tmpfile,write,pwrite,fsync,rename,"
         "copy_file_range,sendfile,renameat2,link")
MOST = 3000  # calls of one run


def expected_status(call, error):
    """The statuses that are right when `call` fails with `error`."""
    of_input = "/in/" in call.file or (call.name == "read" and call.file.startswith("pipe:"))
    if call.name in SPARED:
        return {0}
    if call.name == "close":
        return {4} if ".partial-" in call.file else {0}
    if error == errno.ENOMEM:
        return {6}
    if "/spool/" in call.file and call.name in {"mmap", "read", "pread"}:
        return {3, 4}  # what came by a pipe, or what goes into one
    return {3} if of_input else {4}


def check(faults, said, done, call, error, before, after, wanted):
    """What must hold after a run in which `call` failed."""
    statuses = expected_status(call, error)
    faults.expect(done.status in statuses, said, call, "status", program.signal_name(done.status),
                  "not", statuses, done.stderr)
    if done.status == 0:
        faults.expect(after == wanted, said, call, "other bytes", sorted(after))
        faults.expect(done.stderr == "", said, call, "says", done.stderr)
        return
    faults.expect(after == before, said, call, "left", sorted(after), done.stderr)
    faults.expect(len(done.errors()) == 1 and len(done.stderr.splitlines()) == 1, said, call,
                  "messages", done.stderr)
    if error != errno.ENOMEM:
        faults.expect(os.strerror(error) in done.stderr, said, call, "unclear", done.stderr)


def try_all(mc, faults, folder, said, words, error, forced=False, stdin=b"", **more):
    """Fails call after call; the number of calls."""
    folder.clear()
    whole = mc.run(folder, words, stdin)
    faults.expect(whole.status == 0, said, whole.stderr)
    wanted = folder.contents()
    before = {name: b"old" for name in wanted} if forced else {}
    if forced:
        words = [*words, "--force"]
    for n in range(1, MOST):
        folder.clear()
        for name, old in before.items():
            (folder.out / name).write_bytes(old)
        done = mc.run(folder, words, stdin, AT=n, ERRNO=error, **{"CALLS": CALLS, **more})
        call = done.failed_call
        if call is None:
            faults.expect(done.status == 0 and folder.contents() == wanted, said, "without a fault",
                          done.stderr)
            faults.expect(n > 1, said, "no call to fail")
            return n - 1
        check(faults, said, done, call, error, before, folder.contents(), wanted)
        if done.status == 0:
            faults.expect(done.stdout == whole.stdout, said, call, "other bytes on stdout")
    faults.expect(False, said, "has no end")
    return MOST


def try_format(mc, faults, folder, kind):
    to_file = program.output_words(folder, kind, program.output_name(kind))
    one, two = ["--threads", "1"], ["--threads", "2"]
    yield try_all(mc, faults, folder, f"{kind}, no space", [*to_file, *one], errno.ENOSPC, forced=True)
    yield try_all(mc, faults, folder, f"{kind}, two threads", [*to_file, *two], errno.EIO)
    yield try_all(mc, faults, folder, f"{kind}, poor file system", [*to_file, *one], errno.EDQUOT,
                  forced=True, WITHOUT="tmpfile,link,renameat2,copy_file_range,sendfile")
    if kind not in {"gltf", "exr"}:
        to_pipe = [*program.output_words(folder, kind), *one, "--to", kind]
        yield try_all(mc, faults, folder, f"{kind} to a pipe", to_pipe, errno.EIO)


def try_input(mc, faults, folder, kind):
    """From a file, a pipe, and with too little memory to map it."""
    made = folder.inputs / ("made.##.exr" if kind == "exr" else f"made.{kind}")
    sample = ["sample", folder.spec, "-q", "-o", made, "--force"]
    if kind == "exr":  # a few slices are as good as many
        sample += ["--region", "0,0,18:39,39,21"]
    if kind == "json":
        made = folder.spec
    elif not faults.expect(mc.run(folder, sample).status == 0, kind, "cannot be made"):
        return
    source = str(made).replace("##", "*")
    words = ["--iso", "0", "-q", "-o", "m.ply", "--threads", "1"]
    yield try_all(mc, faults, folder, f"from {kind}", ["extract", source, *words], errno.EIO)
    yield try_all(mc, faults, folder, f"{kind} without memory", ["extract", source, *words],
                  errno.ENOMEM, CALLS="mmap")
    if kind == "exr":
        return
    if kind == "raw":
        words += ["--dims", "40,40,40", "--type", "f32"]
    yield try_all(mc, faults, folder, f"{kind} by a pipe", ["extract", "-", *words], errno.EIO,
                  stdin=made.read_bytes())


def try_unlinks(mc, faults, folder, kind):
    """Call after call where no file can be removed: partial files may stay, but under the final name
    is the old file or the new one, whole, as the status says."""
    words = [*program.output_words(folder, kind, program.output_name(kind)), "--threads", "1"]
    folder.clear()
    faults.expect(mc.run(folder, words).status == 0, kind)
    wanted = folder.contents()
    before = {name: b"old" for name in wanted}
    n_left = 0
    for n in range(1, MOST):
        folder.clear()
        for name, old in before.items():
            (folder.out / name).write_bytes(old)
        done = mc.run(folder, [*words, "--force"], AT=n, ERRNO=errno.EIO, CALLS=CALLS,
                      WITHOUT="unlink,tmpfile")
        call = done.failed_call
        after = folder.contents()
        left = [name for name in after if name not in wanted]
        n_left += len(left)
        said = (kind, call or "without another fault")
        statuses = expected_status(call, errno.EIO) if call else {0}
        faults.expect(done.status in statuses, *said, "status", done.status, done.stderr)
        faults.expect(len(done.errors()) == (done.status != 0), *said, "says", done.stderr)
        faults.expect(all(".partial-" in name or ".mc-spool-" in name
                          for name in left), *said, "left", left)
        faults.expect({name: after.get(name) for name in wanted} ==
                      (wanted if done.status == 0 else before), *said, "other bytes", done.stderr)
        if call is None:
            faults.expect(n_left > 0, kind, "no file that could not be removed")
            yield n - 1
            return
    faults.expect(False, kind, "has no end")


def main():
    mc, (direction, *kinds) = program.arguments()
    attempts = {"from": try_input, "to": try_format, "unlinks": try_unlinks}[direction]
    faults = program.Faults()
    with program.Folder() as folder:
        n_runs = sum(n for kind in kinds for n in attempts(mc, faults, folder, kind))
    return faults.end(f"{n_runs} runs with a call that failed")


if __name__ == "__main__":
    sys.exit(main())
