# SPDX-License-Identifier: MIT
"""Holds data/mc-edits.schema.json against its meta-schema, the reader's ops and shapes, and scripts.

Every shipped script and every example of mc-edits(5) is valid; every op and every shape of the
reader has its schema, its entry in the page and its place in a good script of the corpus; and of the
scripts that the reader refuses, in the corpus and in the unit test's list, the schema refuses all
but those whose fault only a program can see.
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
CORPUS = ROOT / "data" / "corpus" / "script"

# Faults of names, of files, of counts and of numbers against each other.
BEYOND_A_SCHEMA = re.compile(
    r"there is no node|cannot be read|duplicate key|half the shape's least|has no direction|"
    r"hold nothing|does not rise|expected t to run|out of range|takes more than|makes more|"
    r"has no radius|cannot be swept|radius of a|is too large|key of a shape of type \"capsule\"|no \"to\"|no \"from\"|"
    r"no \"rate\"|no \"duration\""
)
CORPUS_BEYOND = {
    "text-after-document.json", "deep-groups.jsonl", "huge-path.jsonl", "many-dabs.jsonl",
    "tiny-duration.jsonl", "ring.jsonl", "missing-stamp.jsonl", "stdin-stamp.jsonl",
    "expands.jsonl", "odd-clamp.jsonl", "good-torn-journal.jsonl", "deep-arrays.jsonl",
}

WITHOUT_A_BRUSH = {"group", "undo", "redo", "write"}  # so that they cannot be drawn


def parsed(text):
    """The values of a text, a line each where it is JSON Lines; None where it is no strict JSON."""
    def refuse(word):
        raise ValueError(word)
    try:
        return [json.loads(text, parse_constant=refuse)]
    except (ValueError, RecursionError):
        pass
    try:
        return [json.loads(line, parse_constant=refuse) for line in text.splitlines() if line.strip()]
    except (ValueError, RecursionError):
        return None


class Schema:
    def __init__(self):
        schema = json.loads((ROOT / "data" / "mc-edits.schema.json").read_text())
        volume = json.loads((ROOT / "data" / "mc-volume.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        self.definitions = schema["$defs"]
        def validator(root):
            resolver = jsonschema.RefResolver("file:///data/mc-edits.schema.json", schema,
                                              {"file:///data/mc-volume.schema.json": volume})
            return jsonschema.Draft202012Validator(root, resolver=resolver)
        self.header = validator(schema)
        self.record = validator({"$ref": "#/$defs/record"})

    def takes(self, text):
        values = parsed(text)
        return bool(values) and self.header.is_valid(values[0]) and all(
            self.record.is_valid(value) for value in values[1:])


def named_in(value, key):
    if isinstance(value, dict):
        if isinstance(value.get(key), str):
            yield value[key]
        for item in value.values():
            yield from named_in(item, key)
    elif isinstance(value, list):
        for item in value:
            yield from named_in(item, key)


def fault_list():
    """(script, fault) of the unit test's list."""
    text = (ROOT / "tests/unit/source/script_faults.inc").read_text()
    head = '{"format": "mc-edits", "version": 1, "x-": 0, "edits": ['
    pairs = re.findall(r'\{R"\((.*?)\)",\s*R"\((.*?)\)"\},\n', text, re.DOTALL)
    return [(head + record + "]}", fault) for record, fault in pairs]


def faults_of_pictures(names, schema):
    """Names without a picture, and edits of the page that are none."""
    page = (ROOT / "data" / "edits.md").read_text()
    for name in sorted(names):
        picture = ROOT / "data" / "pictures" / "edits" / f"{name}.png"
        if f"pictures/edits/{name}.png" not in page or not picture.is_file():
            yield f"{name}: has no picture: see scripts/edit_pictures.py"
    edits = [text for text in re.findall(r"`(.*?)`", page) if text.startswith("{")]
    for text in edits:
        if not schema.record.is_valid(json.loads(text)):
            yield f"edits.md: {text}: the schema refuses it"
    if len(edits) < len(names):
        yield "edits.md: its edits were not found"


def source(name):
    return (ROOT / "src/source/script" / name).read_text()


def main():
    schema = Schema()
    faults = []

    def expect(good, text, place):
        if schema.takes(text) != good:
            faults.append(f"{place}: the schema {'refuses' if good else 'takes'} it")

    page = (ROOT / "man" / "mc-edits.5.md").read_text()
    examples = re.findall(r"```json\n(.*?)```", page, re.DOTALL)
    for n, example in enumerate(examples):
        expect(True, example, f"example {n} of the page")
    for path in sorted((ROOT / "data" / "scripts").glob("*.json*")):
        if '"mc-edits"' in path.read_text():
            expect(True, path.read_text(), path.name)
    shown = {"op": set(), "type": set()}
    for path in sorted(CORPUS.iterdir()):
        text = path.read_bytes().decode("utf-8", errors="surrogateescape")
        good = path.name.startswith("good-")
        if path.name not in CORPUS_BEYOND and path.name != "bad-utf8.jsonl":
            expect(good, text, path.name)
        if good and path.name not in CORPUS_BEYOND:
            for key, names in shown.items():
                names.update(named_in(parsed(text), key))
    listed = fault_list()
    for text, fault in listed:
        if not BEYOND_A_SCHEMA.search(fault):
            expect(False, text, fault)

    ops = set(re.findall(r'\{"([a-z]+)", RecordKind::', source("record_reader.cpp")))
    names = re.search(r"shape_names\(\).*?kNames\{(.*?)\};", source("brush.cpp"), re.DOTALL)
    shapes = set(re.findall(r'"([a-z]+)"', names.group(1)))
    for key, known, kind in (("op", ops, "record"), ("type", shapes, "shape")):
        named = set(schema.definitions[kind]["properties"][key]["enum"])
        for name in sorted(known ^ named):
            faults.append(f"{name}: known to the reader or to the schema, not to both")
        for name in sorted(known - shown[key] - {"stamp"}):
            faults.append(f"{name}: in no good script of the corpus")
        for name in sorted(known):
            if not re.search(rf"^\*\*.*\b{name}\*\*|^\*\*{name}\*\*", page, re.MULTILINE):
                faults.append(f"{name}: has no entry in mc-edits(5)")
    falloffs = {*schema.definitions["falloff"]["else"]["enum"], "curve"}
    faults += faults_of_pictures((ops | shapes | falloffs) - WITHOUT_A_BRUSH, schema)
    if len(ops) < 15 or len(shapes) < 8 or len(listed) < 60 or not examples:
        faults.append("the reader's names, the page's examples or the list of faults were not found")
    print("\n".join(faults) or f"{len(ops)} ops, {len(shapes)} shapes, {len(listed)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
