# SPDX-License-Identifier: MIT
"""`mc extract --simplify` on shipped documents and real volumes.

    simplify.py MC DATA FOLDER [TEST...]

The volumes are in the folder that MC_TEST_VOLUMES names, else in FOLDER; DATA holds the example
documents. A volume that is not there is skipped, aloud.

The mesh must be as good as it was by `mc check`, with the same components, Euler number and
boundary edges, and the file must have the same bytes for other threads, memory and SIMD targets.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

MC = DATA = VOLUMES = SCRATCH = None  # set by main


def mc(*arguments, **environment):
    return subprocess.run([MC, *map(str, arguments)], capture_output=True, check=False, timeout=300,
                          env={**os.environ, **environment})


def check(path):
    return json.loads(mc("check", "--json", path).stdout)


def extract(source, output, *further, **environment):
    done = mc("extract", *source, "-o", output, "--force", *further, **environment)
    if done.returncode != 0:
        raise AssertionError(done.stderr.decode())
    return output


class Simplify(unittest.TestCase):
    def simplified(self, *source, goal="ratio=0.1"):
        """Extracts with and without --simplify, and returns the two reports of `mc check`."""
        before = check(extract(source, SCRATCH / "before.ply"))
        output = extract(source, SCRATCH / "after.ply", "--simplify", goal)
        after = check(output)
        for key in ("components", "euler", "boundary_edges"):
            self.assertEqual(before[key], after[key], key)
        for key in ("degenerate", "duplicate", "nonmanifold_edges", "nonmanifold_vertices",
                    "misoriented_edges", "not_finite", "unreferenced_vertices"):
            self.assertEqual(0, after[key], key)
        first = output.read_bytes()
        for further, environment in ((("--threads", 1), {}), (("--threads", 2), {}),
                                     (("--threads", 7, "--memory", "128MiB"), {}),
                                     ((), {"MC_SIMD": "scalar"}), ((), {"MC_SIMD": "sse4"})):
            again = extract(source, SCRATCH / "again.ply", "--simplify", goal, *further,
                            **environment)
            self.assertTrue(first == again.read_bytes(), f"{further} {environment}")
        return before["triangles"], after["triangles"]

    def volume(self, *path):
        volume = VOLUMES.joinpath(*path)
        if not volume.exists():
            self.skipTest(f"no {path[0]} in {VOLUMES}")
        return volume

    def test_documents(self):
        for name in ("gyroid", "terrain", "caves"):
            with self.subTest(name):
                before, after = self.simplified(DATA / f"{name}.json")
                self.assertAlmostEqual(after / before, 0.1, delta=0.002)

    def test_error(self):
        before, after = self.simplified(DATA / "terrain.json", goal="error=0.1")
        self.assertLess(after, before / 5)

    def test_open_border(self):
        before, after = self.simplified(DATA / "gyroid.json", "--border", "open")
        self.assertLess(after, 0.15 * before)

    def test_smoke(self):
        before, after = self.simplified(self.volume("vdb-smoke-fog-half", "smoke.vdb"))
        self.assertLess(after, before / 2)

    def test_head(self):
        before, after = self.simplified(
            self.volume("raw-headsq-slices", "quarter.nhdr"), "--iso", "1100")
        self.assertLess(after, before / 2)


if __name__ == "__main__":
    MC, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
    VOLUMES = pathlib.Path(os.environ.get("MC_TEST_VOLUMES", sys.argv[3]))
    with tempfile.TemporaryDirectory() as folder:
        SCRATCH = pathlib.Path(folder)
        unittest.main(argv=[sys.argv[0], "-v", *sys.argv[4:]])
