# SPDX-License-Identifier: MIT
"""`mc extract --keep` against scipy.ndimage, which labels the dense samples on its own.

    components.py MC DATA FOLDER [TEST...]

The volumes are in the folder that MC_TEST_VOLUMES names, else in FOLDER; DATA holds the example
documents. Without scipy or a volume the test is skipped, aloud.

A vertex lies on a lattice edge between a solid sample and another one, so its component is the label
of the solid sample. The volume of each component is summed with numpy from the mesh of all of them.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
    import scipy.ndimage
except ImportError as missing:
    print(f"skipped: {missing}; install python3-scipy")
    sys.exit(77)

MC = DATA = VOLUMES = SCRATCH = None  # set by main


def mc(*arguments):
    done = subprocess.run([MC, *map(str, arguments)], capture_output=True, check=False, timeout=300)
    if done.returncode != 0:
        raise AssertionError(done.stderr.decode())
    return done


def read_nrrd(path):
    """The samples of an attached, unpacked NRRD, indexed [k, j, i]."""
    head, _, body = path.read_bytes().partition(b"\n\n")
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    kind = {"float": "f4", "double": "f8", "uint8": "u1", "unsigned char": "u1", "short": "i2",
            "int16": "i2", "ushort": "u2", "uint16": "u2", "unsigned short": "u2"}[fields["type"]]
    order = ">" if fields.get("endian") == "big" else "<"
    sizes = [int(n) for n in fields["sizes"].split()]
    return numpy.frombuffer(body, dtype=order + kind).reshape(sizes[::-1])


def read_ply(path):
    """Positions and triangles of a binary PLY without normals."""
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    counts = {w[1]: int(w[2]) for w in (l.split() for l in head.decode().splitlines())
              if w[0] == "element"}
    n = counts["vertex"]
    positions = numpy.frombuffer(body, dtype="<f4", count=3 * n).reshape(n, 3)
    face = numpy.dtype([("n", "u1"), ("v", "<i4", 3)])
    faces = numpy.frombuffer(body, dtype=face, offset=12 * n, count=counts["face"])
    assert (faces["n"] == 3).all()
    return positions.astype("f8"), faces["v"]


class Labelled:
    """A volume, its components by scipy, and the mesh of all of them."""

    def __init__(self, samples, iso, inside):
        self.path = SCRATCH / "volume.raw"
        self.samples = numpy.ascontiguousarray(samples)
        self.samples.astype(self.samples.dtype.newbyteorder("<")).tofile(self.path)
        name = {"f": "f", "u": "u", "i": "i"}[samples.dtype.kind] + str(8 * samples.dtype.itemsize)
        dims = ",".join(str(n) for n in samples.shape[::-1])
        self.options = ["--dims", dims, "--type", name, "--iso", iso, "--inside", inside,
                        "--border", "closed", "--normals", "none", "--force"]
        self.above = inside == "above"
        solid = samples >= iso if self.above else samples < iso
        reach = 1 if self.above else 2  # 6 neighbours, or 18
        structure = scipy.ndimage.generate_binary_structure(3, reach)
        labels, self.n = scipy.ndimage.label(solid, structure)
        self.labels = numpy.pad(labels, 1)
        self.positions, triangles = self.extract()
        self.of_vertex = self.components_of(self.positions)
        of_triangle = self.of_vertex[triangles[:, 0]]
        assert (of_triangle == self.of_vertex[triangles[:, 1]]).all()
        assert (of_triangle == self.of_vertex[triangles[:, 2]]).all()
        middle = self.positions.mean(axis=0)
        a, b, c = (self.positions[triangles[:, n]] - middle for n in range(3))
        cross = numpy.cross(b - a, c - a)
        self.volumes = numpy.bincount(of_triangle, (a * cross).sum(axis=1) / 6, self.n + 1)
        self.areas = numpy.bincount(
            of_triangle, numpy.sqrt((cross * cross).sum(axis=1)) / 2, self.n + 1)

    def extract(self, *further):
        output = SCRATCH / "mesh.ply"
        mc("extract", self.path, "-o", output, *self.options, *further)
        return read_ply(output)

    def components_of(self, positions):
        """The label of the solid sample at the end of each vertex's lattice edge."""
        lower = numpy.floor(positions).astype(int)
        upper = numpy.ceil(positions).astype(int)
        at = [self.labels[tuple((end + 1)[:, ::-1].T)] for end in (lower, upper)]
        assert ((at[0] == 0) != (at[1] == 0)).all()
        return at[0] + at[1]


class Components(unittest.TestCase):
    def check(self, samples, iso, inside="above"):
        volume = Labelled(samples, iso, inside)
        sizes = numpy.sort(volume.volumes[1:])[::-1]
        middle = float(numpy.median(volume.areas[1:]))
        rules = {
            "largest": volume.volumes >= sizes[0],
            "3": volume.volumes >= sizes[min(2, len(sizes) - 1)],
            f"volume>={sizes[len(sizes) // 2]:.3f}":
                volume.volumes >= float(f"{sizes[len(sizes) // 2]:.3f}"),
            f"area>={middle:.3f}": volume.areas >= float(f"{middle:.3f}"),
        }
        for rule, kept in rules.items():
            kept[0] = False
            if not kept.any():
                continue
            with self.subTest(rule=rule):
                report = SCRATCH / "report.json"
                positions, _ = volume.extract("--keep", rule, "--report", report)
                wanted = volume.positions[kept[volume.of_vertex]]
                numpy.testing.assert_array_equal(positions, wanted)
                told = json.loads(report.read_text())
                self.assertEqual(int(kept.sum()), told["kept_components"])
                self.assertEqual(volume.n - int(kept.sum()), told["dropped_components"])
                self.assertAlmostEqual(1, told["volume"] / volume.volumes[kept].sum(), 5)
                self.compare_bytes(volume, rule)

    def compare_bytes(self, volume, rule):
        """The same file from 1, 2 and 7 threads, with little memory."""
        mesh = SCRATCH / "mesh.ply"
        first = mesh.read_bytes()
        for threads, memory in ((1, "1GiB"), (2, "48MiB"), (7, "1GiB"), (1, "48MiB")):
            volume.extract("--keep", rule, "--threads", threads, "--memory", memory)
            self.assertTrue(first == mesh.read_bytes(), f"{threads} threads, {memory}")

    def sampled(self, *source):
        output = SCRATCH / "samples.nrrd"
        mc("sample", *source, "-o", output, "--force")
        return read_nrrd(output)

    def volume(self, name):
        if not (VOLUMES / name).exists():
            self.skipTest(f"no {name} in {VOLUMES}")
        return VOLUMES / name

    def test_white_noise(self):
        samples = numpy.random.default_rng(7).integers(0, 256, (48, 40, 56)).astype("u1")
        self.check(samples, 190)
        self.check(samples, 100, "below")

    def test_gyroid(self):
        self.check(self.sampled(DATA / "gyroid.json", "--region", "0,0,0:63,63,63"), 0.6)

    def test_caves(self):
        self.check(self.sampled(DATA / "caves.json"), 0.3)
        self.check(self.sampled(DATA / "caves.json"), -0.2, "below")

    def test_smoke(self):
        self.check(self.sampled(self.volume("vdb-smoke-fog-half") / "smoke.vdb"), 0.5)

    def test_head(self):
        slices = self.volume("raw-headsq-slices") / "quarter.nhdr"
        self.check(self.sampled(slices), 1100)


if __name__ == "__main__":
    MC, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
    VOLUMES = pathlib.Path(os.environ.get("MC_TEST_VOLUMES", sys.argv[3]))
    with tempfile.TemporaryDirectory() as folder:
        SCRATCH = pathlib.Path(folder)
        unittest.main(argv=[sys.argv[0], "-v", *sys.argv[4:]])
