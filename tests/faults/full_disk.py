# SPDX-License-Identifier: MIT
"""Places that take no more: full disks, file size limits, folders that are read-only or go away.

    full_disk.py MC LIBRARY tmpfs|quota|size-limit|read-only|vanishing KIND...

Status 4, one message with what the system said, an old output untouched, nothing else left.
`tmpfs` mounts small file systems in a name space of its own, `quota` a Btrfs in a file, whose
quotas need nothing but its own tools; `size-limit` is RLIMIT_FSIZE. What a machine does not allow is
skipped.
"""

import os
import resource
import shutil
import signal
import subprocess
import sys

import program

PAGE = 4096
BTRFS_ITSELF = 3 << 14  # nodes of its trees


def check_refused(faults, said, done, text):
    """Whether the run ended as it must; `text` is in the one message."""
    faults.expect(done.status == 4, said, "status", program.signal_name(done.status), done.stderr)
    faults.expect(len(done.stderr.splitlines()) == 1 and len(done.errors()) == 1
                  and text in done.stderr, said, "says", done.stderr)


def expect_refused(mc, faults, folder, words, said, text):
    """A run for which there is no room: it says so, and leaves what was there."""
    (folder.out / "old").write_bytes(b"old")
    check_refused(faults, said, mc.run(folder, words), text)
    faults.expect(folder.contents() == {"old": b"old"}, said, sorted(folder.contents()))


def sizes(folder):
    """Bytes of all outputs together; of the largest."""
    every = [len(data) for data in folder.contents().values()]
    return sum(every), max(every)


def full_disk(mc, faults, folder, kinds):
    """Outputs and spools on file systems from nothing to nearly enough."""
    n_runs = 0
    for kind in kinds:
        words = program.output_words(folder, kind, program.output_name(kind))
        folder.clear()
        faults.expect(mc.run(folder, words).status == 0, kind)
        total, _ = sizes(folder)
        for part in (0.0, 0.3, 0.6, 0.95):
            n_pages = 1 + int(part * total / PAGE)
            subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={n_pages * PAGE}", "none",
                            folder.out], check=True)
            try:
                expect_refused(mc, faults, folder, words, f"{kind}, disk of {n_pages} pages",
                               "No space left on device")
                n_runs += 1
            finally:
                subprocess.run(["umount", folder.out], check=True)
    return n_runs


def full_spool(mc, faults, folder, kinds):
    """To a pipe, with $TMPDIR full."""
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={2 * PAGE}", "none", folder.spool],
                   check=True)
    try:
        for kind in kinds:
            words = [*program.output_words(folder, kind), "--to", kind]
            done = mc.run(folder, words)
            check_refused(faults, f"{kind} to a pipe", done, "No space left on device")
            faults.expect("TMPDIR" in done.stderr, kind, "names no remedy", done.stderr)
            faults.expect(not list(folder.spool.iterdir()), kind, "left a spool")
    finally:
        subprocess.run(["umount", folder.spool], check=True)
    return len(kinds)


def tool(*words):
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


def quota(mc, faults, folder, kinds):
    """Outputs on a disk that has room, of which only a part may be used."""
    if not (shutil.which("mkfs.btrfs") and shutil.which("btrfs")):
        program.skip("no tools for Btrfs, which has quotas")
    return sum(quota_for(mc, faults, folder, kind) for kind in kinds if kind != "exr")


def quota_for(mc, faults, folder, kind):
    image = folder.path / "disk"
    image.unlink(missing_ok=True)
    with open(image, "wb") as disk:
        disk.truncate(128 << 20)
    if not (tool("mkfs.btrfs", "-q", image) and tool("mount", "-o", "loop", image, folder.out)):
        program.skip("no Btrfs can be mounted here")
    n_runs = 0
    try:
        words = program.output_words(folder, kind, program.output_name(kind))
        whole = mc.run(folder, words)
        if not faults.expect(whole.status == 0, kind, whole.stderr):
            return 0
        total, _ = sizes(folder)
        folder.clear()
        (folder.out / "old").write_bytes(b"old")
        if not tool("btrfs", "quota", "enable", folder.out):
            program.skip("this system's Btrfs has no quotas")
        for part in (0.1, 0.3, 0.6):
            limit = int(part * total) + BTRFS_ITSELF
            tool("btrfs", "filesystem", "sync", folder.out)
            faults.expect(tool("btrfs", "qgroup", "limit", str(limit), folder.out), kind, "no limit")
            expect_refused(mc, faults, folder, words, f"{kind}, {limit} of {total} bytes allowed",
                           "Disk quota exceeded")
            n_runs += 1
    finally:
        subprocess.run(["umount", folder.out], check=True)
    return n_runs


def in_own_name_space(arguments):
    """Runs this script again where it may mount; its status, or a skip."""
    for flags in (["-m"], ["-Urm"]):
        probe = "mount -t tmpfs none /tmp"
        if shutil.which("unshare") and subprocess.run(
                ["unshare", *flags, "sh", "-c", probe], capture_output=True, check=False).returncode == 0:
            os.environ["MC_MAY_MOUNT"] = "1"
            return subprocess.run(["unshare", *flags, sys.executable, *arguments],
                                  check=False).returncode
    program.skip("no file system can be mounted here")


def size_limit(mc, faults, folder, kinds):
    """A limit on the size of files, which comes as an error or, by default, as SIGXFSZ."""
    n_runs = 0
    for kind in kinds:
        words = program.output_words(folder, kind, program.output_name(kind))
        folder.clear()
        faults.expect(mc.run(folder, words).status == 0, kind)
        _, largest = sizes(folder)
        for part in (0.0, 0.5, 0.99):
            folder.clear()
            limit = int(part * largest)
            said = f"{kind}, files of {limit} bytes"
            done = subprocess.run(
                [mc.mc, *map(str, words)], capture_output=True, cwd=folder.out, check=False,
                stdin=subprocess.DEVNULL, env=mc.environment(folder), text=True,
                preexec_fn=lambda most=limit: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
            check_refused(faults, said, program.Ended(done.returncode, b"", done.stderr, []),
                          "File too large")
            faults.expect(not folder.contents(), said, "left", sorted(folder.contents()))
            n_runs += 1
    return n_runs


def read_only(mc, faults, folder, kinds):
    """A folder that another user may not write to."""
    as_nobody = []
    if os.geteuid() == 0:
        if not shutil.which("setpriv"):
            program.skip("root may write anywhere, and there is no setpriv")
        as_nobody = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        for path in (folder.path, folder.inputs, folder.spool):
            path.chmod(0o755)
        folder.spool.chmod(0o777)
        if subprocess.run([*as_nobody, mc.mc, "--version"], capture_output=True,
                          check=False).returncode != 0:
            program.skip("another user cannot run the program where it was built")
    for kind in kinds:
        folder.out.chmod(0o755)
        folder.clear()
        (folder.out / f"m.{kind}").write_bytes(b"old")
        folder.out.chmod(0o555)
        words = [*program.output_words(folder, kind, program.output_name(kind)), "--force"]
        done = subprocess.run([*as_nobody, mc.mc, *map(str, words)], capture_output=True,
                              cwd=folder.out, stdin=subprocess.DEVNULL, text=True, check=False,
                              env=mc.environment(folder))
        check_refused(faults, kind, program.Ended(done.returncode, b"", done.stderr, []),
                      "Permission denied; choose a folder that can be written")
        faults.expect(folder.contents() == {f"m.{kind}": b"old"}, kind, sorted(folder.contents()))
    folder.out.chmod(0o755)
    return len(kinds)


def vanishing(mc, faults, folder, kinds):
    """The output's folder is removed, or becomes another, before one call after the other."""
    n_runs = 0
    for kind in kinds:
        words = program.output_words(folder, kind, f"../gone/{program.output_name(kind)}")
        gone = folder.path / "gone"
        shutil.rmtree(gone, ignore_errors=True)
        gone.mkdir()
        calls = mc.run(folder, words, AT=0).calls
        wanted = {p.name: p.read_bytes() for p in gone.iterdir()}
        for call in calls:
            shutil.rmtree(gone)
            gone.mkdir()
            run = mc.start_until(folder, words, call.number)
            shutil.rmtree(gone)
            run.send_signal(signal.SIGCONT)
            _, stderr = run.communicate(timeout=60)
            said = f"{kind}, no folder before {call.name} {call.file}"
            if run.returncode == 0:  # it went when all was done
                gone.mkdir()
                faults.expect(call.name == "close", said, "is a success")
            else:
                done = program.Ended(run.returncode, b"", stderr.decode(), [])
                check_refused(faults, said, done, "No such file or directory")
                faults.expect(not gone.exists(), said, "is there again")
                gone.mkdir()
            n_runs += 1
        faults.expect(wanted, kind, "nothing was written")
    return n_runs


def main():
    mc, (how, *kinds) = program.arguments()
    faults = program.Faults()
    if how in {"tmpfs", "quota"} and "MC_MAY_MOUNT" not in os.environ:
        return in_own_name_space(sys.argv)
    with program.Folder(size=64 if how == "quota" else 32) as folder:
        if how == "tmpfs":
            streams = [kind for kind in kinds if kind not in {"gltf", "exr", "nrrd", "raw"}]
            n_runs = full_disk(mc, faults, folder, kinds) + full_spool(mc, faults, folder, streams)
        else:
            places = {"quota": quota, "size-limit": size_limit, "read-only": read_only, "vanishing": vanishing}
            n_runs = places[how](mc, faults, folder, kinds)
    return faults.end(f"{how}: {n_runs} runs")


if __name__ == "__main__":
    sys.exit(main())
