# SPDX-License-Identifier: MIT
"""Real volumes against figures from another program (VTK; see each folder's reference.json).

    real_volumes.py MC FOLDER [TEST...]

The volumes are in the folder that MC_TEST_VOLUMES names, else in FOLDER; without them the test is
skipped, aloud. Vertices are counted exactly, since
every right extractor puts one on each crossed lattice edge; area, volume and bounds may differ as
much as the choice of triangles lets them.
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import mesh_files

MC = VOLUMES = SCRATCH = None  # set by main


def mc(*arguments, stdin=subprocess.DEVNULL):
    return subprocess.run(
        [MC, *map(str, arguments)], stdin=stdin, capture_output=True, check=False, timeout=300
    )


def reference(folder):
    """Its entries, each with the --grid that picks its grid."""
    entries = json.loads((VOLUMES / folder / "reference.json").read_text())["entries"]
    for entry in entries:
        entry["grid"] = entry.get("vdb_grid")
    return entries


def grids_by_active_count(path):
    """--grid for each number of active samples: where several grids have one name, the figures
    number them by a metadata field, mc as OpenVDB does, and the two differ."""
    done = mc("info", "--json", path)
    return {grid["active"]: grid["name"] for grid in json.loads(done.stdout)["grids"]}


class RealVolume(unittest.TestCase):
    maxDiff = None

    def extract(self, inputs, iso, suffix, options=()):
        """Runs mc; the output's path and the report."""
        output = SCRATCH / f"{self.id()}-{iso}{suffix}"
        report = SCRATCH / "report.json"
        arguments = ["--iso", iso, "-o", output, "--force", "--report", report, *options]
        done = mc("extract", *inputs, *arguments)
        self.assertEqual((0, b""), (done.returncode, done.stdout), done.stderr.decode())
        return output, json.loads(report.read_text())

    def assert_within(self, share, wanted, got, what):
        self.assertLessEqual(abs(got - wanted), share * abs(wanted), f"{what}: {got}, not {wanted}")

    def assert_bounds(self, wanted, got, share=1e-3):
        """Corners of the two boxes lie within a share of the wanted diagonal."""
        diagonal = math.dist(*wanted)
        for a, b in zip(sum(wanted, []), sum(got, []), strict=True):
            self.assertLessEqual(abs(a - b), share * diagonal, f"bounds {got}, not {wanted}")

    def assert_report_tells_the_truth(self, report, mesh):
        """The report against the file, read and measured anew."""
        area, volume = mesh.area_and_volume()
        self.assertEqual(mesh.n_vertices, report["vertices"])
        self.assertEqual(mesh.n_triangles, report["triangles"])
        self.assertEqual(mesh.boundary_edges(), report["boundary_edges"])
        self.assert_within(1e-4, area, report["area"], "the report's area")
        if report["boundary_edges"] == 0:  # an open surface encloses none
            self.assert_within(1e-4, volume, report["volume"], "the report's volume")
        self.assert_bounds(list(mesh.bounds()), report["bounds"], 1e-6)

    def assert_as_reference(self, mesh, wanted):
        area, volume = mesh.area_and_volume()
        self.assertEqual(wanted["points"], mesh.n_vertices)
        self.assertEqual(wanted["boundary_edges"], mesh.boundary_edges())
        self.assert_within(0.01, wanted["surface_area"], area, "area")
        self.assert_bounds([wanted["bounds_min"], wanted["bounds_max"]], list(mesh.bounds()))
        if wanted["boundary_edges"] == 0:
            self.assert_within(0.005, wanted["enclosed_volume"], volume, "signed volume")

    def check(self, path, *options):
        done = mc("check", path, "--json", *options)
        self.assertEqual(0, done.returncode, done.stdout.decode() + done.stderr.decode())

    def as_is(self, inputs, entry, options=()):
        """PLY and GLB of the surface as it is, against the reference and each other."""
        ply, report = self.extract(inputs, entry["iso"], ".ply", options)
        mesh = mesh_files.read_ply(ply)
        self.assert_as_reference(mesh, entry["as_is"])
        self.assert_report_tells_the_truth(report, mesh)
        self.assertEqual("below" if "<" in entry["inside"] else "above", report["inside"])
        self.check(ply)
        glb, report = self.extract(inputs, entry["iso"], ".glb", options)
        other = mesh_files.read_glb(glb)
        self.assertEqual(mesh.corners, other.corners)
        self.assert_bounds(list(mesh.bounds()), list(other.bounds()), 1e-6)
        self.check(glb)

    def closed(self, inputs, entry, options=()):
        """The same with a closed border: no boundary left, and solid inside."""
        ply, _ = self.extract(inputs, entry["iso"], ".ply", ["--border", "closed", *options])
        mesh = mesh_files.read_ply(ply)
        self.assertEqual(0, mesh.boundary_edges())
        self.assertGreater(mesh.area_and_volume()[1], 0)
        self.check(ply, "--closed")
        return mesh

    def vdb_file(self, path):
        for entry in reference(path.split("/", maxsplit=1)[0]):
            with self.subTest(entry["what"]):
                grid = ["--grid", entry["grid"]] if entry["grid"] else []
                self.as_is([VOLUMES / path], entry, grid)
                self.closed([VOLUMES / path], entry, grid)


class Vdb(RealVolume):
    def test_half_float_level_set_of_a_cube(self):
        self.vdb_file("vdb-cube-levelset-half/cube.vdb")

    def test_half_float_fog_of_an_old_version(self):
        self.vdb_file("vdb-smoke-fog-half/smoke.vdb")

    def test_grids_of_one_name(self):
        path = VOLUMES / "vdb-three-density-grids/grids.vdb"
        grids = grids_by_active_count(path)
        self.assertEqual({"density[0]", "density[1]", "density[2]"}, set(grids.values()))
        for entry in reference("vdb-three-density-grids"):
            with self.subTest(entry["what"]):
                self.as_is([path], entry, ["--grid", grids[entry["vdb_active"]]])

    def test_fog_torus(self):
        self.vdb_file("vdb-torus-bifrost-fog/torus01.vdb")

    def test_grid_without_a_name(self):
        self.vdb_file("vdb-zeno-sphere-levelset/sphere.vdb")
        (entry,) = reference("vdb-zeno-sphere-levelset")
        sphere = VOLUMES / "vdb-zeno-sphere-levelset/sphere.vdb"
        self.as_is([sphere], entry, ["--grid", "#0"])

    def test_the_first_of_several_grids_with_a_note_of_the_others(self):
        grids = VOLUMES / "vdb-three-density-grids/grids.vdb"
        done = mc("extract", grids, "--iso", 5, "-o", SCRATCH / "first.ply", "--force")
        self.assertEqual(0, done.returncode, done.stderr.decode())
        self.assertEqual(222, mesh_files.read_ply(SCRATCH / "first.ply").n_vertices)
        self.assertIn("density[1]", done.stderr.decode())
        self.assertIn("density[2]", done.stderr.decode())
        script = SCRATCH / "none.json"
        script.write_text('{"format":"mc-edits","version":1,"edits":[]}', encoding="utf-8")
        for words in (["sample", grids], ["edit", grids, "--script", script]):
            done = mc(*words, "-o", SCRATCH / "first.nrrd", "--force")
            self.assertEqual(0, done.returncode, done.stderr.decode())
            self.assertIn("grid density[2] is taken; others: density[1], density[0]",
                          done.stderr.decode())
            done = mc(*words, "--grid", "#0", "-o", SCRATCH / "first.nrrd", "--force")
            self.assertNotIn("is taken", done.stderr.decode())

    def test_the_default_surface_of_a_level_set_is_its_zero(self):
        (entry,) = reference("vdb-zeno-sphere-levelset")
        output = SCRATCH / "default.ply"
        sphere = VOLUMES / "vdb-zeno-sphere-levelset/sphere.vdb"
        self.assertEqual(0, mc("extract", sphere, "-o", output, "--force").returncode)
        self.assert_as_reference(mesh_files.read_ply(output), entry["as_is"])

    def test_what_cannot_be_meshed_is_refused_by_name_and_type(self):
        for name, grid, kind in (
            ("points.vdb", "points", "ptdataidx32"),
            ("vel_VDB_bound_v02.vdb", "vel", "vec3s"),
        ):
            with self.subTest(name):
                output = SCRATCH / (name + ".glb")
                done = mc("extract", VOLUMES / "vdb-unmeshable" / name, "-o", output)
                message = done.stderr.decode()
                self.assertEqual(3, done.returncode, message)
                self.assertRegex(message, r"^mc: error: \S+" + re.escape(name) + ": ")
                self.assertIn(grid, message)
                self.assertIn(kind, message)
                self.assertEqual([], list(SCRATCH.glob(name + "*")))


class RawSlices(RealVolume):
    layout = ["--dims", "64,64", "--type", "i16", "--spacing", "3.2,3.2,1.5"]

    def head(self, inputs, options=()):
        for entry in reference("raw-headsq-slices"):
            with self.subTest(entry["what"]):
                self.as_is(inputs, entry, options)
                # The cap lies on the border here and beyond it there, but crosses as many edges.
                mesh = self.closed(inputs, entry, options)
                self.assertEqual(entry["capped"]["points"], mesh.n_vertices)

    def test_quoted_glob_in_natural_order(self):
        self.head([VOLUMES / "raw-headsq-slices/quarter.[0-9]*"], self.layout)

    def test_list_of_files_in_the_shell_s_order(self):
        files = sorted(map(str, (VOLUMES / "raw-headsq-slices").glob("quarter.[0-9]*")))
        self.assertEqual(93, len(files))
        self.head(files, self.layout)

    def test_detached_nrrd_header(self):
        self.head([VOLUMES / "raw-headsq-slices/quarter.nhdr"])

    def test_pipe_gives_the_same_bytes_as_the_file(self):
        folder = VOLUMES / "raw-headsq-slices"
        head = SCRATCH / "head_64x64x93_i16.raw"
        head.write_bytes(b"".join((folder / f"quarter.{n}").read_bytes() for n in range(1, 94)))
        layout = ["--dims", "64,64,93", *self.layout[2:]]
        from_file, _ = self.extract([head], 500.5, ".glb", layout)
        with head.open("rb") as stdin:
            done = mc("extract", "-", "--iso", 500.5, "-o", "-", "--to", "glb", *layout, stdin=stdin)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        self.assertTrue(from_file.read_bytes() == done.stdout, "the bytes differ")


class Exr(unittest.TestCase):
    """Rendered pictures: no volume, but every channel of them can be laid over the ground."""

    FOLDER = "exr-beachball"

    def picture(self, name, channel, columns):
        return {"type": "heightmap", "path": str(VOLUMES / self.FOLDER / name), "channel": channel,
                "size": [columns, 876], "filter": "nearest"}

    def value_range(self, field):
        """Least and greatest value over the pixels that both pictures have."""
        spec = SCRATCH / "exr.json"
        grid = {"samples": [877, 2, 876], "origin": [0.5, 0, 0.5]}
        spec.write_text(json.dumps(
            {"format": "mc-volume", "version": 1, "grid": grid, "field": field}))
        done = mc("info", "--json", spec)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        found = json.loads(done.stdout)["grids"][0]
        return tuple(found["range"])

    def test_one_frame_in_two_layouts_is_the_same(self):
        for channel in "RGBA":
            one = self.picture("singlepart.0001.exr", channel, 911)
            several = self.picture("multipart.0001.exr", channel, 877)
            low, high = self.value_range(one)
            self.assertEqual(0, low)
            self.assertGreater(high, 0.4)
            self.assertEqual((0, 0), self.value_range({"type": "sub", "a": one, "b": several}))

    def refusal(self, *inputs):
        done = mc("extract", *inputs, "-o", SCRATCH / "exr.ply")
        self.assertEqual(3, done.returncode)
        return done.stderr.decode().splitlines()[-1].replace(str(VOLUMES / self.FOLDER) + "/", "")

    def test_unlike_slices_are_named(self):
        frames = [VOLUMES / self.FOLDER / f"singlepart.000{n}.exr" for n in (1, 2, 3)]
        self.assertEqual(
            "mc: error: singlepart.0002.exr: 912x888 f16 at 759,301, but singlepart.0001.exr is "
            "911x876 f16 at 654,435; the slices of one volume must be alike",
            self.refusal(*frames))
        self.assertEqual(
            "mc: error: multipart.0001.exr part rgba_left: 877x876 f16 at 688,435, but "
            "multipart.0001.exr part rgba_right is 877x876 f16 at 654,435; the slices of one volume "
            "must be alike", self.refusal(VOLUMES / self.FOLDER / "multipart.0001.exr"))


class Nrrd(RealVolume):
    PATH = "nrrd-bunny-ct-gz/bunnyPadded.nrrd"

    def test_a_gzipped_scan_with_a_mirrored_axis(self):
        (entry,) = reference("nrrd-bunny-ct-gz")
        ply, report = self.extract([VOLUMES / self.PATH], entry["iso"], ".ply")
        mesh = mesh_files.read_ply(ply)
        self.assert_as_reference(mesh, entry["as_is"])
        self.assert_report_tells_the_truth(report, mesh)
        self.check(ply, "--closed")
        # glTF is turned upright, in metres.
        glb, _ = self.extract([VOLUMES / self.PATH], entry["iso"], ".glb")
        other = mesh_files.read_glb(glb)
        self.assertEqual(mesh.n_triangles, other.n_triangles)
        volume = mesh.area_and_volume()[1]
        self.assert_within(1e-4, volume * 1e-9, other.area_and_volume()[1], "volume in metres")

    def test_it_is_unpacked_as_it_passes(self):
        file, pipe = (SCRATCH / f"bunny-{name}.ply" for name in ("file", "pipe"))
        options = ["--iso", 127.5, "-v"]
        done = mc("extract", VOLUMES / self.PATH, *options, "-o", file)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        self.assertNotIn("copied", done.stderr.decode())
        with open(VOLUMES / self.PATH, "rb") as bunny:
            cat = subprocess.Popen(["cat"], stdin=bunny, stdout=subprocess.PIPE)
            done = mc("extract", "-", *options, "-o", pipe, stdin=cat.stdout)
            cat.stdout.close()
            self.assertEqual(0, cat.wait())
        self.assertEqual(0, done.returncode, done.stderr.decode())
        self.assertNotIn("copied", done.stderr.decode())
        self.assertEqual(file.read_bytes(), pipe.read_bytes())


def main():
    global MC, VOLUMES, SCRATCH
    MC = sys.argv[1]
    VOLUMES = pathlib.Path(os.environ.get("MC_TEST_VOLUMES") or sys.argv[2]).resolve()
    if not VOLUMES.is_dir():
        print(f"SKIPPED: no volumes at {VOLUMES}; set MC_TEST_VOLUMES to the folder that has them")
        return mesh_files.SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        SCRATCH = pathlib.Path(scratch)
        tests = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False)
    return 0 if tests.result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
