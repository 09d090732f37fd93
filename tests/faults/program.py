# SPDX-License-Identifier: MIT
"""What the tests of faults share: volumes, the program under failing calls, and what must hold
however a run ends."""

import array
import dataclasses
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

SKIPPED = 77  # as ctest is told

SPEC = {
    "format": "mc-volume", "version": 1, "convention": "density", "iso": 0,
    "grid": {"samples": [40, 40, 40], "spacing": 1, "origin": [-20, -20, -20]},
    "field": {"type": "add", "inputs": [
        {"type": "sphere", "center": [0, 0, 0], "radius": 14},
        {"type": "mul", "inputs": [4, {"type": "perlin", "frequency": 0.1}]}]},
}

MESHES = ("ply", "obj", "stl", "glb", "gltf")
VOLUMES = ("nrrd", "raw", "vdb", "exr")


def bumpy_ball(n):
    """u8 samples of a ball whose radius goes up and down: some thousand triangles."""
    samples = array.array("B")
    middle = (n - 1) / 2
    for k in range(n):
        for j in range(n):
            for i in range(n):
                x, y, z = i - middle, j - middle, k - middle
                bumps = 2 * math.sin(x) * math.sin(y) * math.sin(z)
                distance = math.sqrt(x * x + y * y + z * z) + bumps
                samples.append(max(0, min(255, int(128 + 12 * (n / 3 - distance)))))
    return samples.tobytes()


class Folder:
    """A folder of a test's own, with folders for inputs, outputs and spools."""

    def __init__(self, size=32):
        self._held = tempfile.TemporaryDirectory(prefix="mc-faults-")
        self.path = pathlib.Path(self._held.name).resolve()
        self.inputs, self.out, self.spool = (self.path / name for name in ("in", "out", "spool"))
        for folder in (self.inputs, self.out, self.spool):
            folder.mkdir()
        self.size = size
        self.raw = self.inputs / "ball.raw"
        self.raw.write_bytes(bumpy_ball(size))
        self.spec = self.inputs / "ball.json"
        self.spec.write_text(json.dumps(SPEC))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._held.cleanup()

    def raw_options(self, iso=True):
        n = self.size
        return ["--dims", f"{n},{n},{n}", "--type", "u8", *(["--iso", "128.5"] if iso else [])]

    def contents(self):
        """Name and bytes of all outputs."""
        return {p.name: p.read_bytes() for p in self.out.iterdir()}

    def clear(self):
        for path in self.out.iterdir():
            path.unlink()


@dataclasses.dataclass
class Call:
    number: int
    name: str
    file: str
    other: str
    end: str  # "fails", "interrupted" or ""


@dataclasses.dataclass
class Ended:
    status: int
    stdout: bytes
    stderr: str
    calls: list

    @property
    def failed_call(self):
        return next((call for call in self.calls if call.end == "fails"), None)

    def errors(self):
        return [line for line in self.stderr.splitlines() if line.startswith("mc: error: ")]


class Program:
    def __init__(self, mc, shim):
        self.mc = mc
        self.shim = shim

    def environment(self, folder, **faults):
        """For the program in `folder`; AT=3 becomes MC_FAULT_AT=3."""
        env = {k: v for k, v in os.environ.items() if not k.startswith(("MC_", "LC_", "LANG"))}
        env.update(TMPDIR=str(folder.spool), TERM="dumb")
        if faults:
            env.update(LD_PRELOAD=str(self.shim), MC_FAULT_FOLDER=str(folder.path),
                       ASAN_OPTIONS="verify_asan_link_order=0")
            env.update({f"MC_FAULT_{key}": str(value) for key, value in faults.items()})
        return env

    def run(self, folder, words, stdin=b"", timeout=60, **faults):
        """Runs to the end; faults that are asked for are logged."""
        log = folder.path / "calls.log"
        log.unlink(missing_ok=True)
        if faults:
            faults["LOG"] = log
        done = subprocess.run([self.mc, *map(str, words)], input=stdin, capture_output=True,
                              cwd=folder.out, env=self.environment(folder, **faults),
                              timeout=timeout, check=False)
        # Where the log is not, the library was not loaded.
        calls = read_calls(log) if faults else []
        return Ended(done.returncode, done.stdout, done.stderr.decode(errors="replace"), calls)

    def start_until(self, folder, words, call):
        """The program, stopped by SIGSTOP before that call; None where it ended before."""
        log = folder.path / "calls.log"
        run = subprocess.Popen([self.mc, *map(str, words)], stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder.out,
                               env=self.environment(folder, STOP=call, LOG=log))
        _, status = os.waitpid(run.pid, os.WUNTRACED)
        if os.WIFSTOPPED(status):
            return run
        run.returncode = os.waitstatus_to_exitcode(status)
        return None


def read_calls(log):
    calls = []
    for line in log.read_text().splitlines():
        number, *rest = line.split("\t")
        calls.append(Call(int(number), *rest))
    return calls


def output_words(folder, kind, to="-"):
    """The command that writes `kind`, from the raw volume, to a file of the output folder."""
    options = folder.raw_options(iso=kind in MESHES)
    if kind == "exr":  # a few slices are as good as many
        options += ["--region", "0,0,0:31,31,3"]
    command = "extract" if kind in MESHES else "sample"
    return [command, folder.raw, *options, "-q", "-o", to]


def output_name(kind):
    return "slices.##.exr" if kind == "exr" else f"m.{kind}"


class Faults:
    """Collects what does not hold; a test ends with its exit status."""

    def __init__(self):
        self.found = []

    def expect(self, holds, *what):
        if not holds:
            self.found.append(" ".join(map(str, what)))
        return holds

    def end(self, said):
        for fault in self.found[:40]:
            print("FAULT:", fault)
        print(f"{said}; {len(self.found)} faults")
        return 1 if self.found else 0


def signal_name(status):
    return signal.Signals(-status).name if status < 0 else str(status)


def skip(why):
    print(f"SKIPPED: {why}")
    sys.exit(SKIPPED)


def arguments():
    """The program, and further words of the command line."""
    mc, shim, *rest = sys.argv[1:]
    return Program(mc, shim), rest
