#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Talks to `mc edit --script -` line by line, as an engine would that lets a user sculpt.

Each answer is waited for before the next edit is sent, so what is buffered anywhere shows as a hang.
"""

import argparse
import json
import os
import pathlib
import resource
import select
import signal
import struct
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


def triangles_of(glb):
    """Each triangle by its corners' positions and normals, from the least one on."""
    magic, version, length, json_length = struct.unpack_from("<4sIII", glb)
    assert magic == b"glTF" and version == 2 and length == len(glb)
    document = json.loads(glb[20:20 + json_length])
    data = glb[28 + json_length:]
    views, accessors = document["bufferViews"], document["accessors"]
    found = []
    for mesh in document["meshes"]:
        primitive = mesh["primitives"][0]
        indices = accessors[primitive["indices"]]
        letter = {5123: "H", 5125: "I"}[indices["componentType"]]
        start = views[indices["bufferView"]].get("byteOffset", 0)
        ids = struct.unpack_from(f"<{indices['count']}{letter}", data, start)
        view = views[accessors[primitive["attributes"]["POSITION"]]["bufferView"]]
        corner = [data[at:at + 24] for at in
                  range(view.get("byteOffset", 0),
                        view.get("byteOffset", 0) + view["byteLength"], view["byteStride"])]
        for n in range(0, len(ids), 3):
            three = [corner[i] for i in ids[n:n + 3]]
            first = three.index(min(three))
            found.append(tuple(three[first:] + three[:first]))
    return found


class Follower:
    """A viewer: takes the chunks of one record as one state of the surface."""

    def __init__(self, session):
        self.session, self.chunks = session, {}

    def record(self):
        coming = {}
        while "chunk" in (line := self.session.answer()):
            coming[tuple(line["chunk"])] = self.session.take(line["bytes"])
        assert {tuple(c["id"]): c["bytes"] for c in line["chunks"]} == {
            at: len(glb) for at, glb in coming.items()}, line
        for gone in map(tuple, line["removed"]):
            del self.chunks[gone]
        self.chunks.update(coming)
        assert line["surface"]["chunks"] == len(self.chunks), line
        return line

    def ask(self, record):
        self.session.send(record)
        return self.record()


FOLLOWED = [ball("subtract", [20, 20, 29], radius=5, strength=200),
            ball("add", [12, 12, 12], radius=6, strength=200),
            {**ball("add", [0, 0, 0]), "path": {"points": [[5, 30, 20], [35, 30, 22]]},
             "strength": 90},
            ball("smooth", [20, 20, 27], radius=4),
            ball("paint", [20, 20, 10], radius=3, material=3), {"op": "undo", "count": 2},
            {"op": "redo"}, ball("paint", [14, 14, 26], radius=3, material=3),
            {"op": "fill", "value": 0}, {"op": "undo"}, ball("add", [300, 0, 0])]
CHUNKS = ["--emit", "chunks", "--chunk-cells", "16"]


def chunks_of(mc, volume, *options):
    """All chunks of a volume, as a fresh run hands them out."""
    script = json.dumps(HEADER).encode() + b"\n"
    done = subprocess.run([mc, "edit", volume, "--iso", "100", "--script", "-", *CHUNKS, "-q",
                           *options], input=script, capture_output=True, check=True)
    chunks, rest = {}, done.stdout
    while rest:
        line, rest = rest.split(b"\n", 1)
        line = json.loads(line)
        if "chunk" in line:
            chunks[tuple(line["chunk"])], rest = rest[:line["bytes"]], rest[line["bytes"]:]
    return chunks


def test_who_follows_has_the_surface(mc):
    for options in ([], ["--normals", "face", "--border", "closed"]):
        session = Session(mc, *CHUNKS, "-o", "-", "-o", "end.glb", "-o", "end.nrrd",
                          "--force", *options)
        follower = Follower(session)
        opened = follower.record()
        assert (opened["record"], opened["op"], opened["removed"]) == (0, "open", []), opened
        for number, edit in enumerate(FOLLOWED, 1):
            line = follower.ask(edit)
            assert line["record"] == number and line["seconds"] > 0, line
            if edit["op"] == "fill":
                assert not follower.chunks and line["removed"], line
            if edit["op"] in ("smooth", "paint"):
                assert 0 < len(line["chunks"]) < line["surface"]["chunks"], line
        last_state = follower.chunks
        status, rest, err = session.end()
        assert status == 0 and json.loads(rest.splitlines()[-1])["records"] == len(FOLLOWED), err
        # The same chunks as afresh, but for what the volume's file does not hold: paint.
        fresh = chunks_of(mc, "end.nrrd", *options)
        assert set(fresh) == set(last_state) and len(fresh) >= 8, sorted(fresh)
        painted = [at for at in fresh if fresh[at] != last_state[at]]
        assert 0 < len(painted) < len(fresh), painted
        assert all(b"MATERIAL" in last_state[at] for at in painted), painted
        # All of them are the mesh.
        parts = sorted(t for glb in last_state.values() for t in triangles_of(glb))
        assert parts == sorted(triangles_of(pathlib.Path("end.glb").read_bytes()))


def test_what_stays_is_not_sent_again(mc):
    follower = Follower(Session(mc, *CHUNKS))
    follower.record()
    line = follower.ask(ball("add", [20, 20, 20], radius=3, strength=1))
    assert line["changed"] > 0 and line["chunks"] == line["removed"] == [], line
    edit = ball("subtract", [20, 20, 29], radius=3, strength=200)
    assert {tuple(c["id"]) for c in follower.ask(edit)["chunks"]} == {(1, 1, 1)}
    assert follower.session.end()[0] == 0


def test_chunks_can_wait_for_writes(mc):
    at_once = Follower(Session(mc, *CHUNKS))
    waiting = Follower(Session(mc, *CHUNKS, "--emit-at", "write", "--force"))
    at_once.record()
    waiting.record()
    edits = [edit for edit in FOLLOWED if edit["op"] not in ("undo", "redo")]
    for n, edit in enumerate(edits):
        at_once.ask(edit)
        waiting.session.send(edit)
        line = waiting.session.answer()
        assert line["record"] == n + n // 3 + 1 and "chunks" not in line, line
        if n % 3 == 2:
            mesh = waiting.session.ask({"op": "write", "path": "now.ply"})
            assert mesh["output"] == "now.ply", mesh
            line = waiting.record()
            assert line["op"] == "write" and waiting.chunks == at_once.chunks, line
    assert waiting.chunks != at_once.chunks
    waiting.session.process.stdin.close()
    line = waiting.record()
    assert line["op"] == "end" and "touched" not in line and waiting.chunks == at_once.chunks, line
    assert at_once.session.end()[0] == 0 and waiting.session.process.wait(PATIENCE) == 0


def test_chunks_are_files(mc):
    folder = pathlib.Path("chunks")
    folder.mkdir()
    (folder / "readme.txt").write_text("stays", encoding="ascii")
    session = Session(mc, *CHUNKS, "--chunk-dir", "chunks")
    opened = session.answer()

    def names():
        return sorted(path.name for path in folder.iterdir() if path.suffix != ".txt")
    assert names() == sorted(chunk["file"] for chunk in opened["chunks"]) and len(names()) == 8
    sent = chunks_of(mc, "ball.raw", *RAW[:4])
    for at, glb in sent.items():
        assert (folder / "chunk_{}_{}_{}.glb".format(*at)).read_bytes() == glb
    before = (folder / "chunk_0_0_0.glb").read_bytes()
    line = session.ask(ball("subtract", [13, 13, 13], radius=2, strength=200))
    assert [chunk["file"] for chunk in line["chunks"]] == ["chunk_0_0_0.glb"], line
    after = (folder / "chunk_0_0_0.glb").read_bytes()
    assert after != before and len(after) == line["chunks"][0]["bytes"]
    line = session.ask({"op": "fill", "value": 0})
    assert len(line["removed"]) == 8 and not names(), line
    session.ask({"op": "undo", "count": 2})
    assert (folder / "chunk_0_0_0.glb").read_bytes() == before
    assert session.end()[0] == 0 and len(names()) == 8
    # Another run must not leave chunks of this one among its own.
    session = Session(mc, *CHUNKS, "--chunk-dir", "chunks")
    status, _, err = session.end()
    assert status == 4 and "chunk_0_0_0.glb: exists" in err and len(names()) == 8, (status, err)
    session = Session(mc, *CHUNKS, "--chunk-dir", "chunks", "--force", "--region",
                      "0,0,0:14,39,39")
    assert session.answer()["surface"]["chunks"] == len(names()) == 4, names()
    assert session.end()[0] == 0 and (folder / "readme.txt").exists()


def test_a_full_disk_leaves_whole_chunks(mc):
    folder = pathlib.Path("full")
    folder.mkdir()
    session = Session(mc, *CHUNKS, "--chunk-dir", "full")
    session.answer()
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    most = max(map(len, before.values()))
    resource.prlimit(session.process.pid, resource.RLIMIT_FSIZE, (most // 2, most // 2))
    session.send(ball("subtract", [20, 20, 29], radius=5, strength=200))
    status, _, err = session.end()
    assert status == 4 and "cannot write" in err, (status, err)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_follower_may_leave(mc):
    session = Session(mc, *CHUNKS)
    session.answer()
    session.process.stdout.close()
    session.send(ball("subtract", [20, 20, 29], radius=5, strength=200))
    assert session.process.wait(PATIENCE) == -signal.SIGPIPE
    assert session.process.stderr.read() == b"mc: iso 100\n"


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


def follow_for_long(mc, n_edits):
    """Chunks down a pipe, undo full, an undo now and then: resident memory after 3/10 and at the end."""
    session = Session(mc, *CHUNKS, "--undo", "16", "-q")
    follower = Follower(session)
    follower.record()
    held = 0
    for n in range(n_edits):
        op = "subtract" if n % 2 else "add"
        edit = ball(op, [8 + n % 24, 8 + n * 7 % 24, 8 + n * 11 % 24], strength=1)
        follower.ask({"op": "undo", "count": 3} if n % 50 == 49 else edit)
        if n == n_edits * 3 // 10:
            held = session.anonymous_kib()
    grown = session.anonymous_kib() - held
    assert session.end()[0] == 0
    return held, grown


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True)
    parser.add_argument("--edits", type=int, help="only: whether memory stays flat for so many")
    args = parser.parse_args()
    mc = os.path.abspath(args.mc)
    tests = [test for name, test in globals().items() if name.startswith("test_")]
    with tempfile.TemporaryDirectory(prefix="mc-live-") as folder:
        os.chdir(folder)
        subprocess.run([sys.executable, str(HERE / "ball.py"), "ball.raw", "--n", "40", "--type",
                        "f32"], check=True)
        if args.edits:
            held, grown = follow_for_long(mc, args.edits)
            assert grown < 1024, f"{grown} KiB more than {held} KiB"
            print(f"{held} KiB, then {grown} more")
            tests = []
        for test in tests:
            test(mc)
            print(test.__name__)
        os.chdir("/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
