# SPDX-License-Identifier: MIT
"""Feeds scripts/includes.py small trees, bad and good, and compares every word it says."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "includes.py"


def run_on(files):
    """Exit status and output lines of the script on a tree of {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "src").mkdir()
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        done = subprocess.run(
            [sys.executable, SCRIPT, root], capture_output=True, text=True, check=False
        )
        return done.returncode, done.stdout.splitlines()


class IncludeLaw(unittest.TestCase):
    def forbidden(self, path, include, why):
        """The include stands in line 2 of the file and is the only fault."""
        name = include.strip('"<>')
        self.assertEqual(
            run_on({path: f"// first line\n#include {include}\n"}),
            (1, [f"{path}:2: forbidden include {name}: {why}"]),
        )

    def test_a_lawful_tree_passes_in_silence(self):
        tree = {
            "include/mc/base.hpp": '#include <vector>\n#include "mc/field.hpp"\n',
            "src/base/file.cpp": "#include <sys/mman.h>\n#include <fmt/format.h>\n",
            "src/base/parallel.cpp": "#include <tbb/parallel_for.h>\n",
            "src/extract/rows_simd.cpp": '#define HWY_WANT_AVX3_DL 1\n#include "hwy/highway.h"\n',
            "src/sink/vdb/module/grid.cpp": '#include <openvdb/openvdb.h>\n#include "mc/field.hpp"\n',
            "src/cli/main.cpp": '#include <CLI/CLI.hpp>\n#include "sink/ply/ply.hpp"\n',
        }
        self.assertEqual(run_on(tree), (0, []))

    def test_rooms(self):
        self.forbidden("src/base/a.hpp", '"field/a.hpp"', "room base may include no other room")
        self.forbidden(
            "src/sink/ply/a.cpp", '"source/a.hpp"', "room sink may include base field mesh"
        )
        self.forbidden("src/mesh/a.cpp", '"extract/a.hpp"', "room mesh may include base")
        self.forbidden(
            "src/process/a.cpp", '"pipe/a.hpp"', "room process may include base field mesh"
        )
        self.forbidden(
            "src/utils/a.cpp", "<vector>", "src/utils is no room: it has no line in scripts/includes.py"
        )
        self.forbidden("src/mesh/a.cpp", '"a.hpp"', 'write "room/file.hpp", from src/')

    def test_folders_of_a_room(self):
        bits = "src/extract/bits may include no other folder of its room"
        self.forbidden("src/extract/bits/a.hpp", '"extract/cubes/a.hpp"', bits)
        self.forbidden("src/extract/bits/a.hpp", '"extract/sparse/a.hpp"', bits)
        cubes = "src/extract/cubes may include bits components of its room"
        self.forbidden("src/extract/cubes/a.cpp", '"extract/sparse/a.hpp"', cubes)
        tree = {
            "src/extract/cubes/a.cpp": '#include "extract/bits/a.hpp"\n',
            "src/extract/sparse/a.cpp": '#include "extract/cubes/a.hpp"\n',
            "src/sink/ply/a.cpp": '#include "sink/part.hpp"\n',
        }
        self.assertEqual(run_on(tree), (0, []))

    def test_the_core_knows_no_file_format(self):
        why = "room pipe is of the core, which knows no file format"
        self.forbidden("src/pipe/a.cpp", '"mc/sink.hpp"', why)

    def test_library_doors(self):
        vdb = "its door is src/sink/vdb/module/*"
        self.forbidden("src/source/vdb/a.cpp", "<openvdb/openvdb.h>", vdb)
        self.forbidden("src/sink/ply/a.cpp", "<tiny_gltf.h>", "its door is src/sink/gltf/*")
        self.forbidden("src/source/a.cpp", "<CLI/CLI.hpp>", "its door is src/cli/*")
        self.forbidden(
            "src/extract/a.cpp", "<tbb/task_arena.h>", "its door is src/base/parallel.cpp"
        )
        self.forbidden(
            "src/extract/a.cpp", '"hwy/highway.h"', "its door is src/*_simd.cpp or src/*-inl.hpp"
        )
        self.forbidden(
            "src/mesh/a.cpp",
            "<boost/any.hpp>",
            "unknown library: give it a door in scripts/includes.py",
        )

    def test_simd_files_want_the_same_targets(self):
        status, lines = run_on({"src/mesh/a_simd.cpp": "#include <hwy/highway.h>\n"})
        self.assertEqual(status, 1)
        self.assertEqual(lines, ["src/mesh/a_simd.cpp: wants no AVX3_DL: see src/base/highway_simd.cpp"])

    ROWS = {
        "src/source/abc/abc.hpp": 'inline constexpr SourceFormat kAbcFormat{.name = "abc",\n',
        "src/source/formats.cpp": "// the list\n{&kAbcFormat}\n",
        "src/sink/xyz/xyz.hpp": 'inline constexpr SinkFormat kXyzFormat{\n    .name = "xyz"};\n',
    }

    def test_formats_are_named_in_their_folder(self):
        tree = {
            "src/source/abc/abc.cpp": 'f("abc", kAbcFormat);\n',
            "src/cli/help.cpp": '// "abc"\nf("smoke.abc", "abc files", abc, "other", ".other");\n',
        }
        self.assertEqual(run_on(self.ROWS | tree), (0, []))

    def test_formats_are_named_nowhere_else(self):
        why = 'format name "{0}": ask its row, in src/{1}/{0}/*'
        tree = {
            "src/cli/a.cpp": '\nif (format == "abc") f(".xyz");\n',
            "src/sink/xyz/xyz.cpp": 'f("xyz", "abc");\n',
        }
        self.assertEqual(
            run_on(self.ROWS | tree),
            (
                1,
                [
                    "src/cli/a.cpp:2: " + why.format("abc", "source"),
                    "src/cli/a.cpp:2: " + why.format("xyz", "sink"),
                    "src/sink/xyz/xyz.cpp:1: " + why.format("abc", "source"),
                ],
            ),
        )

    def test_rows_are_listed_once(self):
        tree = {"src/source/registry.cpp": "f(kAbcFormat);\n"}
        why = "row kAbcFormat: only src/source/abc and src/source/formats.cpp name it"
        self.assertEqual(
            run_on(self.ROWS | tree), (1, ["src/source/registry.cpp:1: " + why])
        )

    def test_words_with_another_meaning(self):
        tree = {
            "src/source/raw/raw.hpp": 'constexpr SourceFormat kRawFormat{.name = "raw"};\n',
            "src/source/nrrd/header.cpp": 'encoding == "raw"\n',
        }
        self.assertEqual(run_on(tree), (0, []))

    def test_public_headers(self):
        why = "public headers include the standard library and mc/ only"
        self.forbidden("include/mc/base.hpp", "<fmt/format.h>", why)
        self.forbidden("include/mc/base.hpp", '"base/checked.hpp"', why)
        self.forbidden("include/mc/base.hpp", "<unistd.h>", why)


if __name__ == "__main__":
    unittest.main()
