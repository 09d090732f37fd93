#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The include law: which room may see which, and the one door of each library; and where the name
of a file format may stand.

    includes.py [ROOT]

Reads every source below ROOT/include and ROOT/src (default: this tree), prints one line for each
forbidden include or name, and ends with 1 if there was any. Tests may include what they like.
"""

import fnmatch
import pathlib
import re
import sys

# room: rooms it may include, besides itself.
ROOMS = {
    "base": "",
    "field": "base",
    "graph": "base field",
    "edit": "base field graph",
    "mesh": "base",
    "extract": "base field mesh",
    "process": "base field mesh",
    "pipe": "base field edit extract mesh process",
    "source": "base field graph edit mesh",
    "sink": "base field mesh",
    "convert": "base field graph edit mesh extract process pipe source sink",
    "cli": "base field graph edit mesh extract process pipe source sink convert",
}
CORE = {"base", "field", "graph", "edit", "mesh", "extract", "process", "pipe"}

# Folder of a room that keeps a law of its own: folders of the room that it may include, besides
# itself.
FOLDERS = {
    "extract/bits": "",
    "extract/components": "bits",
    "extract/cubes": "bits components",
    "extract/sparse": "bits components cubes",
}

# Public headers that the core does not see: it knows no file format.
IO_HEADERS = {"mc/source.hpp", "mc/sink.hpp", "mc/convert.hpp", "mc/host.hpp"}

# include pattern: the files below src/ that are the library's door.
DOORS = {
    "openvdb/*": ["sink/vdb/module/*"],
    "blosc.h": ["source/vdb/*"],
    "libdeflate.h": ["source/vdb/*"],
    "OpenEXR/*": ["source/image/module/*", "sink/image/module/*"],
    "openexr*": ["source/image/module/*", "sink/image/module/*"],
    "png.h": ["source/image/module/*", "sink/image/module/*"],
    "tiny_gltf*": ["sink/gltf/*"],
    "nlohmann/*": ["source/json/*", "source/mesh/*", "sink/gltf/*", "cli/*"],
    "CLI/*": ["cli/*"],
    "tbb/*": ["base/parallel.cpp"],
    "oneapi/tbb*": ["base/parallel.cpp"],
    "hwy/*": ["*_simd.cpp", "*-inl.hpp"],
    "fmt/*": ["*"],
    "meshoptimizer.h": ["mesh/*", "sink/gltf/*"],
    "zlib.h": ["source/stream/gzip.cpp"],
    "zstd*.h": ["source/stream/zstd.cpp"],
}

# What a system brings without a library: the C++ and C headers have no suffix or are listed.
SYSTEM = re.compile(
    r"[a-z_0-9]+|(sys|linux|asm)/[a-z_0-9]+\.h|"
    r"(cpuid|dirent|dlfcn|errno|fcntl|glob|malloc|poll|pthread|sched|signal|spawn|stdio|termios|time|unistd)\.h"
)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]')

# A format is a row in a folder below src/source or src/sink. Its name may stand only there and where
# a row has it as an extension; the row itself also in its room's list.
ROW = re.compile(r'constexpr (?:Source|Sink)Format (k\w+)\s*\{\s*\.name = "(\w*)"')
EXTENSIONS = re.compile(r'\.extensions = "([\w ]*)"')
ROW_LIST = "formats.cpp"
# A literal that is nothing but a name, perhaps as an extension.
QUOTED = re.compile(r'"\.?(\w+)"')
# The same words with another meaning: an encoding of NRRD, a class of volumes.
OTHER_MEANINGS = {"raw": ["source/nrrd/*"], "spec": ["*/surface_choice.cpp"]}


def library_fault(path, name):
    """Why the file `path`, relative to src/, may not include the library header `name`."""
    for pattern, doors in DOORS.items():
        if fnmatch.fnmatchcase(name, pattern):
            if any(fnmatch.fnmatchcase(path, door) for door in doors):
                return None
            return f"its door is {' or '.join('src/' + door for door in doors)}"
    if SYSTEM.fullmatch(name):
        return None
    return "unknown library: give it a door in scripts/includes.py"


def folder_fault(path, name):
    """Why the file `path` may not include `name` of the same room; None if it may."""
    folder, target = ("/".join(p.split("/")[:-1]) for p in (path, name))
    if folder not in FOLDERS or target == folder:
        return None
    room = folder.split("/")[0]
    if target in (f"{room}/{allowed}" for allowed in FOLDERS[folder].split()):
        return None
    return f"src/{folder} may include {FOLDERS[folder] or 'no other folder'} of its room"


def source_fault(path, quote, name):
    """Why the file `path`, relative to src/, may not include `name`; None if it may."""
    room = path.split("/")[0]
    if room not in ROOMS:
        return f"src/{room} is no room: it has no line in scripts/includes.py"
    if name.startswith("mc/"):
        if room in CORE and name in IO_HEADERS:
            return f"room {room} is of the core, which knows no file format"
        return None
    target = name.split("/")[0]
    if target in ROOMS:
        if target == room:
            return folder_fault(path, name)
        if target in ROOMS[room].split():
            return None
        return f"room {room} may include {ROOMS[room] or 'no other room'}"
    if quote == '"' and not any(fnmatch.fnmatchcase(name, p) for p in DOORS):
        return 'write "room/file.hpp", from src/'
    return library_fault(path, name)


def public_fault(_path, _quote, name):
    """Why a public header may not include `name`."""
    if re.fullmatch(r"mc/[a-z_]+\.hpp|[a-z_0-9]+", name):
        return None
    return "public headers include the standard library and mc/ only"


def simd_fault(path, text):
    """Files that differ in their SIMD targets would share Highway's choice among them."""
    if path.endswith("_simd.cpp") and "#define HWY_WANT_AVX3_DL 1\n" not in text:
        return "wants no AVX3_DL: see src/base/highway_simd.cpp"
    return None


class Formats:
    """The rows of the formats below src/, and where each may be named."""

    def __init__(self, source):
        self.homes = {}  # name: folders
        self.others = {word: list(paths) for word, paths in OTHER_MEANINGS.items()}
        self.rows = {}  # room, row: folder
        for room in ("source", "sink"):
            for file in sorted((source / room).rglob("*.hpp")):
                folder = file.parent.relative_to(source).as_posix()
                text = file.read_text(encoding="utf-8")
                for words in EXTENSIONS.findall(text):
                    for word in words.split():
                        self.others.setdefault(word, []).append(folder + "/*")
                for row, name in ROW.findall(text):
                    self.rows[room, row] = folder
                    if name:
                        self.homes.setdefault(name, []).append(folder + "/*")

    def faults(self, path, line):
        """What is wrong with the names in a line of the file `path`, relative to src/."""
        if line.lstrip().startswith("//"):
            return
        for name in QUOTED.findall(line):
            homes = self.homes.get(name, [])
            allowed = homes + self.others.get(name, [])
            if homes and not any(fnmatch.fnmatchcase(path, home) for home in allowed):
                yield f'format name "{name}": ask its row, in src/{" or src/".join(homes)}'
        room = path.split("/")[0]
        for word in re.findall(r"\bk\w+Format\b", line):
            home = self.rows.get((room, word))
            if home and not path.startswith(home + "/") and path != f"{room}/{ROW_LIST}":
                yield f"row {word}: only src/{home} and src/{room}/{ROW_LIST} name it"


def faults(root):
    formats = Formats(root / "src")
    for folder, fault in (("include", public_fault), ("src", source_fault)):
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in {".hpp", ".cpp", ".h", ".inl"}:
                continue
            path = file.relative_to(root / folder).as_posix()
            text = file.read_text(encoding="utf-8")
            if folder == "src" and (why := simd_fault(path, text)):
                yield f"{folder}/{path}: {why}"
            for number, line in enumerate(text.splitlines(), start=1):
                match = INCLUDE.match(line)
                why = match and fault(path, match[1], match[2])
                if why:
                    yield f"{folder}/{path}:{number}: forbidden include {match[2]}: {why}"
                for why in formats.faults(path, line) if folder == "src" else ():
                    yield f"src/{path}:{number}: {why}"


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here
    if not (root / "src").is_dir():
        sys.exit(f"includes.py: {root}: has no src/")
    found = list(faults(root))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
