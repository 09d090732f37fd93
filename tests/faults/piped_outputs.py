# SPDX-License-Identifier: MIT
"""What comes by a pipe is what a file gets, byte for byte.

Every format, from a mapped file (counts may be known before), a pipe and a document, with several
isos where a file holds them, text forms, one thread and many. What has to be spooled goes to
$TMPDIR, -v says so, and nothing stays there.
"""

import sys

import program

SEVERAL = {"obj", "glb"}
ASCII = {"ply", "stl"}
SPOOLED = {"obj", "stl", "glb", "vdb"}  # whatever is known before


def commands(folder, kind):
    """Each a command without its output, and what stdin gives."""
    from_file = program.output_words(folder, kind)[:-3]
    by_pipe = [from_file[0], "-", *from_file[2:]]
    yield from_file, b""
    yield by_pipe, folder.raw.read_bytes()
    if kind in program.MESHES:
        yield ["extract", folder.spec], b""
    else:
        yield ["sample", folder.spec], b""
    if kind in SEVERAL:
        yield [word.replace("128.5", "100.5,128.5,150.5") for word in map(str, from_file)], b""
    if kind in ASCII:
        yield [*from_file, "--ascii"], b""


def check(mc, faults, folder, kind, words, stdin):
    for threads in ("1", "3"):
        folder.clear()
        more = ["--threads", threads]
        to_file = mc.run(folder, [*words, *more, "-q", "-o", f"m.{kind}"], stdin)
        to_pipe = mc.run(folder, [*words, *more, "-v", "-o", "-", "--to", kind], stdin)
        said = f"{kind}, {words[2:]}, {threads} threads"
        if not faults.expect(to_file.status == 0 and to_pipe.status == 0, said, to_file.stderr,
                             to_pipe.stderr):
            continue
        wanted = folder.contents()[f"m.{kind}"]
        faults.expect(wanted and to_pipe.stdout == wanted, said, len(to_pipe.stdout), "not",
                      len(wanted))
        told = to_pipe.stderr.count("<stdout>: is no file: spooled to a temporary file in "
                                    + str(folder.spool))
        faults.expect(told == 1 if kind in SPOOLED else told <= 1, said, "spooled, said", told)
        faults.expect(not list(folder.spool.iterdir()), said, "left a spool")


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    n_commands = 0
    with program.Folder() as folder:
        for kind in kinds:
            for words, stdin in commands(folder, kind):
                check(mc, faults, folder, kind, list(map(str, words)), stdin)
                n_commands += 1
    return faults.end(f"{n_commands} commands")


if __name__ == "__main__":
    sys.exit(main())
