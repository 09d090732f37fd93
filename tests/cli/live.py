#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Talks to `mc edit --script -` line by line, as an engine would that lets a user sculpt.

Each answer is waited for before the next edit is sent, so what is buffered anywhere shows as a hang.
"""

import argparse
import json
import os
import pathlib
import select
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
HEADER = {"format": "mc-edits", "version": 1, "space": "index"}
RAW = ["--dims", "40,40,40", "--type", "f32", "--iso", "100"]
PATIENCE = 30  # seconds


def ball(op, center, radius=4, **more):
    return {"op": op, "shape": {"type": "sphere", "center": center, "radius": radius}, **more}


class Session:
    """A running `mc edit` and its pipes."""

    def __init__(self, mc, *options):
        self.process = subprocess.Popen([mc, "edit", "ball.raw", *RAW, "--script", "-", *options],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)
        self.rest = b""
        self.send(HEADER)

    def send(self, record):
        self.process.stdin.write(json.dumps(record).encode() + b"\n")
        self.process.stdin.flush()

    def _more(self):
        ready, _, _ = select.select([self.process.stdout], [], [], PATIENCE)
        data = os.read(self.process.stdout.fileno(), 1 << 16) if ready else b""
        assert data, "no answer: " + (self.process.stderr.read().decode() if ready else "waited")
        self.rest += data

    def take(self, n_bytes):
        while len(self.rest) < n_bytes:
            self._more()
        taken, self.rest = self.rest[:n_bytes], self.rest[n_bytes:]
        return taken

    def answer(self):
        while b"\n" not in self.rest:
            self._more()
        return json.loads(self.take(self.rest.index(b"\n") + 1))

    def ask(self, record):
        self.send(record)
        return self.answer()

    def end(self):
        """Status, the rest of stdout, stderr."""
        out, err = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, self.rest + out, err.decode()

    def anonymous_kib(self):
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(text.split("RssAnon:")[1].split()[0])


def test_each_record_is_answered(mc):
    session = Session(mc, "--report", "-", "-o", "dented.nrrd")
    first = session.ask(ball("subtract", [20, 32, 20], strength=50))
    assert first["record"] == 1 and first["changed"] > 0 and first["dabs"] == 1, first
    assert first["touched"][0] == [17, 29, 17] and first["touched"][1] == [23, 35, 23], first
    undone = session.ask({"op": "undo", "count": 3})
    assert undone["count"] == 1, undone
    assert session.ask({"op": "redo"})["count"] == 1
    written = [session.ask({"op": "write", "path": "step-{n:02}.ply"}), session.answer()]
    assert any(line.get("op") == "write" and line["output"] == "step-01.ply" for line in written)
    assert pathlib.Path("step-01.ply").stat().st_size > 0
    outside = session.ask(ball("add", [500, 0, 0]))
    assert outside["outside"] == 1 and outside["touched"] is None, outside
    status, rest, err = session.end()
    last = json.loads(rest.splitlines()[-1])
    assert status == 0 and last["records"] == 5 and last["outside"] == 1, (status, last)
    assert err.count("lies outside the volume") == 1 and "1 of 3 steps undone" in err, err
    assert pathlib.Path("dented.nrrd").exists()


def test_a_bad_record_ends_it(mc):
    session = Session(mc, "--report", "-", "-o", "stands.ply")
    session.ask(ball("subtract", [20, 32, 20], strength=50))
    session.send({"op": "subtrac"})
    status, _, err = session.end()
    assert status == 2 and 'did you mean "subtract"?' in err and "<stdin>:3:" in err, (status, err)
    assert pathlib.Path("stands.ply").exists()


def test_it_can_be_kept_going(mc):
    session = Session(mc, "--report", "-", "--keep-going", "-o", "going.ply")
    session.send({"op": "subtrac"})
    assert session.ask(ball("subtract", [20, 32, 20], strength=50))["record"] == 2
    status, _, _ = session.end()
    assert status == 2 and pathlib.Path("going.ply").exists()


EDITS = [ball("subtract", [10 + n % 20, 12 + n % 17, 30 - n % 19], strength=5 + n % 7)
         for n in range(40)]


def replay(mc, script, output):
    done = subprocess.run([mc, "edit", "ball.raw", *RAW, "--script", script, "-o", output, "-q"],
                          capture_output=True, text=True, check=False, timeout=PATIENCE)
    return done.returncode, done.stderr


def test_a_journal_survives_a_kill(mc):
    session = Session(mc, "--report", "-", "--journal", "killed.jsonl")
    for edit in EDITS[:25]:
        session.ask(edit)
    session.process.send_signal(signal.SIGKILL)
    session.end()
    journal = pathlib.Path("killed.jsonl").read_bytes()
    assert journal.endswith(b"\n") and journal.count(b"\n") == 26
    lines = [json.dumps(line) for line in [HEADER, *EDITS[:25]]]
    pathlib.Path("same.jsonl").write_text("\n".join(lines) + "\n", encoding="ascii")
    assert replay(mc, "killed.jsonl", "killed.nrrd")[0] == 0
    assert replay(mc, "same.jsonl", "same.nrrd")[0] == 0
    assert pathlib.Path("killed.nrrd").read_bytes() == pathlib.Path("same.nrrd").read_bytes()
    # What a kill can leave of a line that was being written.
    pathlib.Path("torn.jsonl").write_bytes(journal + journal.splitlines()[-1][:40])
    status, err = replay(mc, "torn.jsonl", "torn.nrrd")
    assert status == 0 and "torn.jsonl:27" in err and "torn" in err, (status, err)
    assert pathlib.Path("torn.nrrd").read_bytes() == pathlib.Path("same.nrrd").read_bytes()
    # Another volume is not what was recorded.
    wrong = journal.replace(b'"after":"', b'"after":"0', 1).splitlines(keepends=True)
    wrong[1] = wrong[1].replace(b'"}', b"", 1)[:-2] + b'"}\n'
    pathlib.Path("wrong.jsonl").write_bytes(b"".join(wrong))
    status, err = replay(mc, "wrong.jsonl", "wrong.nrrd")
    assert status == 3 and "differs from the one that was recorded" in err, (status, err)


def test_memory_stays_flat(mc):
    session = Session(mc, "--report", "-", "--undo", "16")
    held = 0
    for n in range(2000):
        op = "subtract" if n % 2 else "add"
        session.ask(ball(op, [8 + n % 24, 8 + n * 7 % 24, 8 + n * 11 % 24], strength=1))
        if n == 600:
            held = session.anonymous_kib()
    grown = session.anonymous_kib() - held
    assert session.end()[0] == 0
    assert grown < 1024, f"{grown} KiB more after 1400 edits"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True)
    mc = os.path.abspath(parser.parse_args().mc)
    tests = [test for name, test in globals().items() if name.startswith("test_")]
    with tempfile.TemporaryDirectory(prefix="mc-live-") as folder:
        os.chdir(folder)
        subprocess.run([sys.executable, str(HERE / "ball.py"), "ball.raw", "--n", "40", "--type",
                        "f32"], check=True)
        for test in tests:
            test(mc)
            print(test.__name__)
        os.chdir("/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
