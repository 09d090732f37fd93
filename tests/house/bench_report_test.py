# SPDX-License-Identifier: MIT
"""scripts/bench without its programs: contests among stand-ins, the README's section, the plots."""

import pathlib
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True

import bench  # noqa: E402
import bench_report  # noqa: E402
import plot  # noqa: E402


def result(ms, faces=1_000_000):
    return {"ms": ms, "least_ms": ms, "spread_ms": ms / 100, "rounds": 10, "vertices": faces // 2,
            "faces": faces}


def row(volume, size, **results):
    return {"volume": volume, "size": size, "threads": 1, "normals": "none",
            "results": {name.replace("_", " "): value for name, value in results.items()}}


def results_of(dense):
    growth = [row("sphere", size, mc=result(size, size**2), read=result(size / 2),
                  vtk_kept=result(8 * size)) for size in (64, 128, 256)]
    growth += [row("gyroid", 256, mc=result(n, 1000 * n), read=result(5)) for n in (1, 2, 4)]
    return {"machine": {"mc": "0", "processor": "a processor", "cores": 2, "simd": "avx2",
                        "compiler": "c++ 12",
                        "memory": [{"threads": 1, "read": 14e9}],
                        "demo": [{"cells": 50, "time": {"ms": 0.0831}}]},
            "dense": dense, "sparse": [], "growth": growth}


class Contest(unittest.TestCase):
    # Says that it is ready, and then as its seconds how many turns it has had.
    STAND_IN = ("import sys\nprint('ready', flush=True)\n"
                "for n, _ in enumerate(sys.stdin): print(0.001 * (n + 1), 7, {}, flush=True)")

    def test_each_has_its_turns(self):
        commands = {name: [sys.executable, "-c", self.STAND_IN.format(faces)]
                    for name, faces in (("mc", 11), ("vtk", 22))}
        results = bench.contest(commands, 5)
        self.assertEqual({name: r["faces"] for name, r in results.items()}, {"mc": 11, "vtk": 22})
        for one in results.values():
            self.assertEqual((one["rounds"], one["vertices"]), (5, 7))
            self.assertAlmostEqual(one["ms"], 3)  # the median of 1 to 5
            self.assertAlmostEqual(one["least_ms"], 1)
            self.assertAlmostEqual(one["spread_ms"], 1)

    def test_a_program_that_fails_ends_it(self):
        with self.assertRaises(SystemExit):
            bench.contest({"mc": [sys.executable, "-c", "print('no')"]}, 1)


class Table(unittest.TestCase):
    def test_line_of_all_peers(self):
        line = bench_report.table_line(row("sphere", 512, mc=result(45.04), read=result(20),
                                           vtk_kept=result(363), vtk_plain=result(645),
                                           vdb=result(1500)))
        self.assertEqual(line, "| sphere 512³ | 1.00 M | 1 |  | **45.0** | 2.25 | 363 (8.1 ×) | "
                               "645 (14.3 ×) | 1500 (33.3 ×) |")

    def test_peers_that_are_missing_leave_gaps(self):
        line = bench_report.table_line(row("fog.vdb", 512, mc=result(0.5)))
        self.assertEqual(line, "| fog.vdb 512³ | 1.00 M | 1 |  | **0.500** |  |  |  |  |")

    def test_readme_is_replaced_between_its_marks(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "data" / "pictures").mkdir(parents=True)
            readme = root / "README.md"
            readme.write_text(f"before\n{bench_report.BEGIN}old\n{bench_report.END}after\n",
                              encoding="utf-8")
            for ms in (10, 20):
                bench_report.write_readme(root, results_of([row("sphere", 512, mc=result(ms))]))
            text = readme.read_text(encoding="utf-8")
            self.assertTrue(text.startswith("before\n" + bench_report.BEGIN + "| volume"))
            self.assertTrue(text.endswith(bench_report.END + "after\n"))
            self.assertEqual(text.count("| sphere 512³"), 1)
            self.assertIn("| **20.0** |", text)
            self.assertIn("50³ cells takes 0.0831 ms", text)
            for name in re.findall(r"\((data/pictures/[^)]*)\)", text):
                xml.etree.ElementTree.parse(root / name)

    def test_the_readme_has_the_marks(self):
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        self.assertIn(bench_report.BEGIN, text)
        self.assertIn(bench_report.END, text)


class Plot(unittest.TestCase):
    def test_is_whole_and_the_same_each_time(self):
        lines = [plot.Line("mc & co", "#123456", [(1, 1), (100, 10)]), plot.Line("none", "#0", [])]
        picture = plot.svg("a < b", "x", "y", lines)
        self.assertEqual(picture, plot.svg("a < b", "x", "y", lines))
        words = [node.text for node in xml.etree.ElementTree.fromstring(picture).iter()
                 if node.tag.endswith("text")]
        self.assertIn("mc & co", words)
        self.assertNotIn("none", words)

    def test_names_of_lines_do_not_overlap(self):
        places = plot.apart([100, 101, 102, 300], 17)
        self.assertEqual(places, [100, 117, 134, 300])

    def test_ticks_are_round_and_within(self):
        self.assertEqual(plot.decades(3, 40), [5, 10, 20])
        self.assertEqual(plot.decades(0.5, 2000), [1, 10, 100, 1000])
        self.assertEqual([plot.number(n) for n in (0.1, 10, 2e4, 5e6)], ["0.1", "10", "20 k", "5 M"])


if __name__ == "__main__":
    unittest.main()
