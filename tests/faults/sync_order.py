# SPDX-License-Identifier: MIT
"""--sync: the order of writes, syncs and renames, as the system was asked for them.

Every file is synced after its last write and before it gets its name; the folder is synced after
the last rename; where several files belong together, also before the one that names the others gets
its name. A sync that fails fails the run, and nothing is left. Without --sync nothing is synced.
"""

import errno
import sys

import program

CALLS = "write,pwrite,copy_file_range,sendfile,fsync,rename,renameat2,close"


def check_order(faults, folder, kind, calls):
    """What must hold of the calls of a run that wrote `kind`."""
    writes = {"write", "pwrite", "copy_file_range", "sendfile"}
    renames = [c for c in calls if c.name in {"rename", "renameat2"}]
    folder_syncs = [c for c in calls if c.name == "fsync" and c.file == str(folder.out)]
    for rename in renames:
        partial = str(folder.out / rename.file)
        written = [c.number for c in calls if c.name in writes and partial in (c.file, c.other)]
        synced = [c.number for c in calls if c.name == "fsync" and c.file == partial]
        faults.expect(written and synced and max(written) < max(synced) < rename.number, kind,
                      rename, "written", written, "synced", synced)
    faults.expect(renames and folder_syncs and folder_syncs[-1].number > renames[-1].number, kind,
                  "the folder is not synced last")
    if len(renames) > 1:
        between = [c for c in folder_syncs if renames[-2].number < c.number < renames[-1].number]
        faults.expect(between, kind, "names are not synced before the last")


def check_failures(mc, faults, folder, kind, words, n_syncs):
    for n in range(1, n_syncs + 1):
        for old in ({}, {program.output_name(kind): b"old"}):
            folder.clear()
            for name, data in old.items():
                (folder.out / name).write_bytes(data)
            forced = ["--force"] if old else []
            done = mc.run(folder, [*words, *forced], AT=n, ERRNO=errno.EIO, CALLS="fsync")
            faults.expect(done.status == 4 and len(done.errors()) == 1, kind, n, done.stderr)
            faults.expect(folder.contents() == old, kind, "left", sorted(folder.contents()))


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    with program.Folder() as folder:
        for kind in kinds:
            folder.clear()
            words = program.output_words(folder, kind, program.output_name(kind))
            done = mc.run(folder, words, CALLS=CALLS)
            faults.expect(not any(c.name == "fsync" for c in done.calls), kind, "syncs unasked")
            unsynced = folder.contents()
            folder.clear()
            words.append("--sync")
            done = mc.run(folder, words, CALLS=CALLS)
            faults.expect(done.status == 0 and folder.contents() == unsynced, kind, done.stderr)
            check_order(faults, folder, kind, done.calls)
            n_syncs = sum(c.name == "fsync" for c in done.calls)
            check_failures(mc, faults, folder, kind, words, n_syncs)
        script = folder.out.parent / "none.jsonl"
        script.write_text('{"format":"mc-edits","version":1}\n')
        folder.clear()
        for name in ("m.ply", "m.nrrd"):  # of an edit, both kinds of outputs
            words = ["edit", folder.raw, *folder.raw_options(iso=True), "--script", script]
            done = mc.run(folder, [*words, "-o", name, "-q", "--sync"], CALLS=CALLS)
            faults.expect(done.status == 0, "edit", name, done.stderr)
            check_order(faults, folder, f"edit {name}", done.calls)
            folder.clear()
        to_pipe = [*program.output_words(folder, "ply"), "--to", "ply", "--sync"]
        done = mc.run(folder, to_pipe)
        faults.expect(done.status == 0 and done.stdout, "a pipe cannot be synced", done.stderr)
    return faults.end(f"{len(kinds)} formats")


if __name__ == "__main__":
    sys.exit(main())
