# SPDX-License-Identifier: MIT
"""Holds data/mc-volume.schema.json against its meta-schema, the loader's node types and documents.

Every shipped document and every example of mc-volume(5) is valid; every node type of the loader has
its schema, its picture and its place in a good document of the corpus or of the pictures; and of the documents that the loader
refuses, in the corpus and in the unit test's list, the schema refuses all but those whose fault only
a program can see.
"""

import json
import pathlib
import re
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: no python3-jsonschema")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT / "data" / "corpus" / "spec"

# Faults of names, rings, expansion and of numbers against each other.
BEYOND_A_SCHEMA = re.compile(
    r"there is no node|closes a ring|expand to more|nest deeper|more bytes of samples|past world|"
    r"cannot be read|duplicate key|works out to|cannot be inverted|has no direction|does not rise|"
    r"is above \\?\"max|two equal numbers|at most half|cannot be told apart"
)
CORPUS_BEYOND = {
    "duplicate-key.json", "expands.json", "far-grid.json", "huge-grid.json", "long-chain.json",
    "plane-without-direction.json", "ring.json", "self-ring.json", "unknown-name.json",
    "warps.json", "lone-surrogate.json",
}

NEEDS_A_FILE = {"heightmap", "volume"}  # which the corpus does not have; data/specs has


def parsed(text):
    """The document, or None where it is not strict JSON."""
    def refuse(word):
        raise ValueError(word)
    try:
        return json.loads(text, parse_constant=refuse)
    except ValueError:
        return None


def fault_list():
    """(document, fault) of the unit test's list."""
    text = (ROOT / "tests/unit/source/spec_faults.inc").read_text()
    head = '{"format": "mc-volume", "version": 1, "grid": {"cells": [2, 2, 2]}, "x-": 0, '
    pairs = re.findall(r'\{R"\((.*?)\)",\s*R"\((.*?)\)"\},\n', text, re.DOTALL)
    return [(head + rest + "}", fault) for rest, fault in pairs]


def types_in(value):
    if isinstance(value, dict):
        if isinstance(value.get("type"), str):
            yield value["type"]
        for item in value.values():
            yield from types_in(item)
    elif isinstance(value, list):
        for item in value:
            yield from types_in(item)


def main():
    schema = json.loads((ROOT / "data" / "mc-volume.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    faults = []

    def expect(good, text, place):
        document = parsed(text)
        valid = document is not None and validator.is_valid(document)
        if valid != good:
            faults.append(f"{place}: the schema {'takes' if valid else 'refuses'} it")

    page = (ROOT / "man" / "mc-volume.5.md").read_text()
    for n, example in enumerate(re.findall(r"```json\n(.*?)```", page, re.DOTALL)):
        expect(True, example, f"example {n} of the page")
    for path in sorted((ROOT / "data" / "specs").glob("*.json")):
        expect(True, path.read_text(), path.name)
    shown = set()
    for path in sorted(CORPUS.iterdir()):
        text = path.read_bytes().decode("utf-8", errors="replace")
        good = path.name.startswith("good-")
        if path.name != "byte-order-mark.json" and path.name not in CORPUS_BEYOND:
            expect(good, text, path.name)
        if good:
            shown.update(types_in(parsed(text)))
    listed = fault_list()
    for text, fault in listed:
        if not BEYOND_A_SCHEMA.search(fault):
            expect(False, text, fault)

    drawn = (ROOT / "data" / "nodes.md").read_text()
    frame = {"format": "mc-volume", "version": 1, "grid": {"cells": [2, 2, 2]}}
    for name, example in re.findall(r"\*\*(.*?)\*\* [^`]*`(.*)`", drawn):
        field = parsed(example)
        expect(True, json.dumps({**frame, "field": field}), f"the picture of {name}")
        shown.update(types_in(field))
    rows = "".join(path.read_text() for path in sorted((ROOT / "src/graph/nodes").glob("*.hpp")))
    types = set(re.findall(r'\.name = "([a-z0-9-]+)"', rows))
    named = set(schema["$defs"]["object"]["properties"]["type"]["enum"])
    for name in sorted(types ^ named):
        faults.append(f"{name}: known to the loader or to the schema, not to both")
    for name in sorted(types - shown - NEEDS_A_FILE):
        faults.append(f"{name}: in no good document of the corpus, nor in a picture's")
    for name in sorted(types):
        if not re.search(rf"^\*\*.*\b{name}\*\*|^\*\*{name}\*\*", page, re.MULTILINE):
            faults.append(f"{name}: has no entry in mc-volume(5)")
    for name in sorted(types):
        picture = ROOT / "data" / "pictures" / "nodes" / f"{name}.png"
        if f"pictures/nodes/{name}.png" not in drawn or not picture.is_file():
            faults.append(f"{name}: has no picture: see scripts/node_pictures.py")
    if len(types) < 35 or len(listed) < 40:
        faults.append("the loader's types or the list of faults were not found")
    print("\n".join(faults) or f"{len(types)} types, {len(listed)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
