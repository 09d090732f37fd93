# SPDX-License-Identifier: MIT
"""-o on what is no plain file: FIFOs, devices, links.

FIFOs and devices are written in place, with the bytes a file gets, and need no --force. Of a link
the target is replaced and the link stays: whole, dangling, chained, relative, to another file
system. A loop of links, a link into no folder, and a folder are refused.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import threading

import program


def through_fifo(mc, faults, folder, kind, wanted):
    path = folder.out / "fifo"
    os.mkfifo(path)
    got = []
    reader = threading.Thread(target=lambda: got.append(path.read_bytes()))
    reader.start()
    words = [*program.output_words(folder, kind, path), "--to", kind]
    done = mc.run(folder, words)
    reader.join(timeout=60)
    faults.expect(done.status == 0 and not done.stderr and got == [wanted], kind, "by a FIFO",
                  done.status, done.stderr)
    faults.expect(path.is_fifo(), kind, "replaced the FIFO")
    path.unlink()


def to_devices(mc, faults, folder, kind):
    done = mc.run(folder, [*program.output_words(folder, kind, "/dev/null"), "--to", kind])
    faults.expect(done.status == 0 and not done.stderr, kind, "/dev/null", done.stderr)
    done = mc.run(folder, [*program.output_words(folder, kind, "/dev/full"), "--to", kind])
    faults.expect(done.status == 4 and "/dev/full: cannot write: No space left" in done.stderr
                  and len(done.errors()) == 1, kind, "/dev/full", done.status, done.stderr)
    faults.expect(pathlib.Path("/dev/full").is_char_device(), "replaced a device")


def through_links(mc, faults, folder, elsewhere, kind, wanted):
    """Each a name of the link, and where the bytes have to be."""
    (folder.out / "there").mkdir()
    links = {
        "dangling": (f"there/a.{kind}", folder.out / f"there/a.{kind}"),
        "absolute": (folder.out / f"there/b.{kind}", folder.out / f"there/b.{kind}"),
        "elsewhere": (elsewhere / f"c.{kind}", elsewhere / f"c.{kind}"),
        "chained": ("dangling", folder.out / f"there/a.{kind}"),
    }
    for name, (to, target) in links.items():
        link = folder.out / name
        link.symlink_to(to)
        for old in (None, b"old"):
            target.unlink(missing_ok=True)
            if old:
                target.write_bytes(old)
            words = [*program.output_words(folder, kind, link), "--to", kind]
            if old:
                refused = mc.run(folder, words)
                faults.expect(refused.status == 4 and "exists; add --force" in refused.stderr
                              and target.read_bytes() == old, kind, name, refused.stderr)
                words.append("--force")
            done = mc.run(folder, words)
            faults.expect(done.status == 0 and target.read_bytes() == wanted and link.is_symlink(),
                          kind, "by link", name, done.status, done.stderr)
        beside = [p.name for p in target.parent.iterdir() if ".partial-" in p.name]
        faults.expect(not beside, kind, name, "left", beside)


def refused(mc, faults, folder, kind):
    (folder.out / "loop").symlink_to("loop")
    (folder.out / "nowhere").symlink_to("no-folder/m")
    (folder.out / "folder").mkdir()
    for name, text in (("loop", "Too many levels of symbolic links"),
                       ("nowhere", "create the folder"), ("folder", "is a folder")):
        done = mc.run(folder, [*program.output_words(folder, kind, name), "--to", kind, "--force"])
        faults.expect(done.status == 4 and text in done.stderr and len(done.errors()) == 1, name,
                      done.status, done.stderr)


def clear(folder):
    subprocess.run(["rm", "-rf", *folder.out.iterdir()], check=True)


def main():
    mc, kinds = program.arguments()
    faults = program.Faults()
    other = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with program.Folder() as folder, tempfile.TemporaryDirectory(dir=other) as elsewhere:
        elsewhere = pathlib.Path(elsewhere)
        if os.stat(elsewhere).st_dev == os.stat(folder.out).st_dev:
            print("SKIPPED: no other file system here; a link to the same is tried")
        for kind in kinds:
            words = program.output_words(folder, kind, f"m.{kind}")
            faults.expect(mc.run(folder, words).status == 0, kind)
            wanted = (folder.out / f"m.{kind}").read_bytes()
            clear(folder)
            through_fifo(mc, faults, folder, kind, wanted)
            to_devices(mc, faults, folder, kind)
            through_links(mc, faults, folder, elsewhere, kind, wanted)
            clear(folder)
        refused(mc, faults, folder, kinds[0])
        clear(folder)
    return faults.end(f"{len(kinds)} formats")


if __name__ == "__main__":
    sys.exit(main())
