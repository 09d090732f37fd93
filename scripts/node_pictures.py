#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws every node of mc-volume(5) as a small picture, from what mc sample writes.

    node_pictures.py MC [NAME...]     data/pictures/nodes/NAME.png and the page data/nodes.md

A picture is the square from -2 to 2 of the plane z = 0, x to the right, y up (noises of xz: z up). A
shape is warm where the field is solid, with lines of equal value every 1/4; a value is grey from its
least to its largest. A node that is not in SECTIONS is drawn with the keys that it needs. Look at the pictures before they are committed.
"""

import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[1]
SIDE = 128
STEP = 4 / SIDE


def graph_of(node):
    """The area under a function of x."""
    return {"type": "sub", "a": node, "b": "y"}


def node(name, **keys):
    return {"type": name, **keys}


BOX = node("box", size=[2, 1.2, 2])
BALL = node("sphere", radius=0.9, center=[0.6, 0.4, 0])
THING = node("union", smooth=0.2, a=node("box", size=[1.2, 0.5, 1], center=[0.2, 0, 0]),
             b=node("sphere", radius=0.35, center=[0.8, 0.3, 0]))
SMALL = node("scale", factor=0.4, values="scale", source=THING)
PERLIN = node("perlin", frequency=1.2)

# Section, then name: (style, field). Styles: shape; value; graph, the shape under a function of x.
SECTIONS = {
    "Arithmetic": {
        "constant": ("value", node("constant", value=0.5)),
        "x": ("value", "x"), "y": ("value", "y"), "z": ("value", "z"),
        "add": ("shape", node("add", a="x", b="y")),
        "mul": ("shape", node("mul", a="x", b="y")),
        "min": ("shape", node("min", a="x", b="y")),
        "max": ("shape", node("max", a="x", b="y")),
        "sub": ("shape", node("sub", a="x", b="y")),
        "div": ("graph", node("div", a=0.5, b="x")),
        "mod": ("graph", node("mod", a="x", b=0.75)),
        "pow": ("graph", node("pow", a=node("abs", source="x"), b=1.5)),
        "abs": ("graph", node("abs", source="x")),
        "neg": ("graph", node("neg", source="x")),
        "sqrt": ("graph", node("sqrt", source="x")),
        "floor": ("graph", node("floor", source="x")),
        "fract": ("graph", node("fract", source="x")),
        "sin": ("graph", node("sin", source=node("mul", inputs=["x", 3]))),
        "clamp": ("graph", node("clamp", source="x", min=-0.5, max=1)),
        "remap": ("graph", node("remap", source="x", **{"from": [-2, 2], "to": [1, -0.5]})),
        "smoothstep": ("graph", node("smoothstep", source="x", edges=[-1, 1])),
        "mix": ("value", node("mix", a="x", b=PERLIN, t=node("smoothstep", source="y", edges=[-1, 1]))),
        "select": ("value", node("select", a="x", b=PERLIN, control="y", blend=0.5)),
        "curve": ("graph", node("curve", source="x", interpolation="smooth",
                                points=[[-1.5, -1], [-0.5, 0.8], [0.5, 0.2], [1.5, 1.4]])),
        "terrace": ("graph", node("terrace", source="x", step=0.8, offset=0.2, ramp=0.25)),
        "floor-hard": ("shape", node("floor-hard", source=node("mul", inputs=[PERLIN, 0.6]),
                                     height=-1.2, weight=1.5)),
    },
    "Generators": {
        "white": ("value", node("white", frequency=8)),
        "value": ("value", node("value", frequency=2)),
        "value-cubic": ("value", node("value-cubic", frequency=2)),
        "perlin": ("value", node("perlin", frequency=2)),
        "simplex": ("value", node("simplex", frequency=1.6)),
        "opensimplex2": ("value", node("opensimplex2", frequency=1.6)),
        "cellular": ("value", node("cellular", frequency=2, **{"return": "f2-f1"})),
        "unity-perlin2d": ("value", node("unity-perlin2d", frequency=2, dims="xy")),
        "fbm": ("value", node("fbm", octaves=5, source=node("perlin", frequency=0.8))),
        "ridged": ("value", node("ridged", octaves=5, source=node("perlin", frequency=0.8))),
        "billow": ("value", node("billow", octaves=5, source=node("perlin", frequency=0.8))),
        "pingpong": ("value", node("pingpong", octaves=3, source=node("perlin", frequency=0.8))),
        "heightmap": ("value", node("heightmap", path="specs/heightmap/island.png", size=4,
                                    origin=[-2, -2], dims="xy", height=0.5)),
        "volume": ("shape", node("neg", source=node("volume", path="specs/torus.json"))),
        "warp": ("value", node("warp", amplitude=0.5, warp=node("simplex", frequency=0.7),
                               source=node("fbm", octaves=4, source=node("perlin", frequency=0.8)))),
    },
    "Transforms": {
        "translate": ("shape", node("translate", by=[0.6, 0.8, 0], source=THING)),
        "rotate": ("shape", node("rotate", degrees=35, axis="z", source=THING)),
        "scale": ("shape", node("scale", factor=1.7, values="scale", source=THING)),
        "affine": ("shape", node("affine", matrix=[1, 0.8, 0, 0, 0, 1.5, 0, 0, 0, 0, 1, 0],
                                 source=THING)),
        "mirror": ("shape", node("mirror", axis="x", source=node("translate", by=[0.4, 0, 0],
                                                                   source=THING))),
        "repeat": ("shape", node("repeat", period=[0.9, 0.8, 0], source=SMALL)),
    },
    "Solids": {
        "sphere": ("shape", node("sphere", radius=1.2)),
        "box": ("shape", node("box", size=[2.4, 1.6, 2])),
        "plane": ("shape", node("plane", normal=[1, 2, 0])),
        "torus": ("shape", node("torus", radius=1.1, tube=0.4, axis="x")),
        "roundbox": ("shape", node("roundbox", size=[2.4, 1.6, 2], radius=0.5)),
        "capsule": ("shape", node("capsule", to=[0.9, 0.8, 0], radius=[0.8, 0.3],
                                  **{"from": [-0.6, -0.6, 0]})),
        "cylinder": ("shape", node("cylinder", radius=0.9, height=2.4)),
        "cone": ("shape", node("cone", radius=1.2, height=2.4)),
        "ellipsoid": ("shape", node("ellipsoid", radii=[1.5, 0.8, 1])),
        "gyroid": ("shape", node("gyroid", period=2, thickness=0.3)),
    },
    "Combinations": {
        "union": ("shape", node("union", smooth=0.5, a=BOX, b=BALL)),
        "intersection": ("shape", node("intersection", a=BOX, b=BALL)),
        "difference": ("shape", node("difference", a=BOX, b=BALL)),
        "complement": ("shape", node("complement", source=BALL)),
        "offset": ("shape", node("offset", source=BOX, distance=0.4)),
        "shell": ("shape", node("shell", source=BOX, thickness=0.25)),
    },
}


def plain_value(schema):
    """A value that a key's schema takes: of numbers 1, of nodes x."""
    if "enum" in schema:
        return schema["enum"][0]
    if schema.get("$ref") == "#/$defs/node":
        return "x"
    if schema.get("type") == "array":
        return [plain_value(schema["items"])] * schema["minItems"]
    return plain_value(schema["oneOf"][0]) if "oneOf" in schema else 1


def with_plain_nodes(sections):
    """The sections, and in each the nodes that mc-volume(5) has there besides: what they need, no more."""
    page = (ROOT / "man" / "mc-volume.5.md").read_text()
    schema = json.loads((ROOT / "data" / "mc-volume.schema.json").read_text())
    out = {}
    for section, nodes in sections.items():
        out[section] = dict(nodes)
        text = page.split(f"\n## {section}\n")[1].split("\n## ")[0]
        for head in re.findall(r"^(\*\*.*)\n:   ", text, re.MULTILINE):
            for name in re.findall(r"\*\*([a-z0-9-]+)\*\*", head):
                if name in nodes:
                    continue
                keys = schema["$defs"][f"{name}-node"]
                needed = {key: plain_value(keys["properties"][key])
                          for key in keys["required"] if key != "type"}
                style = "graph" if "source" in needed else "value" if section == "Generators" else "shape"
                out[section][name] = (style, node(name, **needed))
    return out


def sample(mc, field, upright):
    """Rows of values, the upper row first; of the plane y = 0 or, upright, z = 0."""
    low = -2 + STEP / 2
    document = {
        "format": "mc-volume", "version": 1, "field": field,
        "grid": {"samples": [SIDE, SIDE, 2] if upright else [SIDE, 2, SIDE], "spacing": STEP,
                 "origin": [low, low, 0] if upright else [low, 0, low]},
    }
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "specs").symlink_to(ROOT / "data" / "specs")
        spec = pathlib.Path(folder, "node.json")
        raw = pathlib.Path(folder, "node.raw")
        spec.write_text(json.dumps(document))
        subprocess.run([mc, "sample", "-q", str(spec), "-o", str(raw)], check=True)
        values = struct.unpack(f"<{raw.stat().st_size // 4}f", raw.read_bytes())
    stride = SIDE if upright else 2 * SIDE
    return [values[n * stride:n * stride + SIDE] for n in reversed(range(SIDE))]


def grey(rows):
    low = min(v for row in rows for v in row)
    high = max(v for row in rows for v in row)
    span = high - low or 1
    return [[[round(255 * (v - low) / span) if high > low else 128] * 3 for v in row]
            for row in rows]


def shade(v):
    """The colour of a value: warm where solid, a dark line at 0, faint ones every 1/4."""
    if v != v:
        return [255, 255, 255]
    near = abs(v) / STEP
    if near < 0.9:
        return [40, 36, 32]
    base = [222, 176, 118] if v > 0 else [176, 198, 214]
    to_line = abs((v * 4 + 0.5) % 1 - 0.5) / 4 / STEP
    light = 0.86 if to_line < 0.5 else 1.0
    return [round(c * light) for c in base]


def png(pixels):
    rows = b"".join(b"\0" + bytes(c for pixel in row for c in pixel) for row in pixels)
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))
    head = struct.pack(">IIBBBBB", len(pixels[0]), len(pixels), 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) +
            chunk(b"IEND", b""))


def draw(mc, name, style, field):
    rows = sample(mc, graph_of(field) if style == "graph" else field, upright=name != "z")
    pixels = grey(rows) if style == "value" else [[shade(v) for v in row] for row in rows]
    (ROOT / "data" / "pictures" / "nodes" / f"{name}.png").write_bytes(png(pixels))


def write_page(path, head, pictures, sections, text_of):
    """A table of pictures for each section, each with its name and text_of(name, what it shows)."""
    lines = [*head, ""]
    for section, shown in sections.items():
        lines += [f"## {section}", "", "| | |", "|---|---|"]
        for name, what in shown.items():
            lines.append(f"| ![](pictures/{pictures}/{name}.png) | **{name}** {text_of(name, what)} |")
        lines.append("")
    path.write_text("\n".join(lines[:-1]) + "\n")


def text_of_node(_, what):
    style, field = what
    of = "the area under " if style == "graph" else ""
    return f"{of}`{json.dumps(field)}`"


HEAD = [
    "# The nodes of mc-volume", "",
    "Written by `scripts/node_pictures.py`, which drew the pictures from what `mc sample` wrote.",
    "mc-volume(5) has the formulas. Each picture is the square from -2 to 2, x to the right, y up (for",
    "z itself, z). Warm is solid, lines are 1/4 apart; grey runs from the least value to the largest. The",
    "graph of a function of x is shown as the area under it.",
]


def main():
    mc, *wanted = sys.argv[1:]
    sections = with_plain_nodes(SECTIONS)
    for nodes in sections.values():
        for name, (style, field) in nodes.items():
            if not wanted or name in wanted:
                draw(mc, name, style, field)
    write_page(ROOT / "data" / "nodes.md", HEAD, "nodes", sections, text_of_node)


if __name__ == "__main__":
    main()
