#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws every op, shape and falloff of mc-edits(5) as a small picture, from what mc edit writes.

    edit_pictures.py MC [NAME...]     data/pictures/edits/NAME.png and the page data/edits.md

A picture is the square from -2 to 2 of the plane z = 0, x to the right, y up. Warm is solid, with lines
of equal value every 1/4; where the surface was before is a white line. Of a falloff the area under the
weight is shown, from the middle of a ball to its rim. Look at the pictures before they are committed.
"""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile

from node_pictures import ROOT, SIDE, STEP, node, png, shade, write_page

LOW = -2 + STEP / 2
HILLS = node("sub", a=node("mul", inputs=[0.5, node("sin", source=node("mul", inputs=["x", 1.5]))]), b="y")
ROUGH = node("add", inputs=[HILLS, node("mul", inputs=[0.35, node("perlin", frequency=3)])])
AIR = node("constant", value=-4)
NOTHING = node("constant", value=0)


def shape(kind, **keys):
    return {"type": kind, **keys}


def edit(op, *, base=HILLS, **keys):
    return base, [{"op": op, **keys}]


def built(kind, **keys):
    """A shape alone."""
    return edit("add", base=AIR, blend="csg", shape=shape(kind, **keys))


def weight(falloff):
    return edit("set", base=NOTHING, value=1, shape=shape("sphere", radius=2), falloff=falloff)


BALL = shape("sphere", center=[0.5, 0.3, 0], radius=1)
DOT = shape("sphere", radius=0.5)
BEND = [[-1.3, -0.9, 0], [-0.2, 1, 0], [1.3, 0.6, 0]]
STAR = {"type": "capsule", "from": [0, 0.2, 0], "to": [0.9, 0.9, 0], "radius": [0.35, 0.15]}

# Section, then name: (field, edits).
SECTIONS = {
    "Ops": {
        "add": edit("add", shape=BALL),
        "add-csg": edit("add", blend="csg", smooth=0.4, shape=BALL),
        "subtract": edit("subtract", shape=BALL),
        "subtract-csg": edit("subtract", blend="csg", smooth=0.4, shape=BALL),
        "set": edit("set", value=0.5, shape=BALL),
        "fill": edit("fill", value=-0.5),
        "smooth": edit("smooth", base=ROUGH, shape=shape("sphere", radius=1.5), radius=6, iterations=3),
        "flatten": edit("flatten", shape=shape("sphere", center=[0.9, 0.2, 0], radius=1.1),
                        plane={"point": [0.9, 0.1, 0], "normal": [-0.3, 1, 0]}),
        "inflate": edit("inflate", strength=0.4, shape=shape("sphere", radius=1.5)),
        "noise": edit("noise", noise=node("perlin", frequency=2.5), strength=0.6,
                      shape=shape("sphere", radius=1.5)),
        "revert": (HILLS, [{"op": "subtract", "shape": shape("sphere", center=[0, 0.2, 0], radius=1.6),
                            "strength": 2},
                           {"op": "revert", "shape": shape("sphere", center=[0.6, 0, 0], radius=1)}]),
        "stamp": edit("stamp", file="specs/torus.json", translate=[0.4, 0.4, 0], rotate=[0, 0, 30],
                      scale=0.6, smooth=0.2),
        "paint": edit("paint", material=1, shape=BALL),
    },
    "Shapes": {
        "sphere": built("sphere", radius=1.2),
        "box": built("box", size=[2.4, 1.4, 2], rotate=[0, 0, 20], rounding=0.3),
        "capsule": built("capsule", to=[0.9, 0.8, 0], radius=[0.8, 0.3], **{"from": [-0.6, -0.6, 0]}),
        "cylinder": built("cylinder", radius=0.8, height=2.4, rotate=[0, 0, 30]),
        "cone": built("cone", radius=[1.2, 0.4], height=2.2),
        "ellipsoid": built("ellipsoid", radii=[1.5, 0.8, 1]),
        "plane": built("plane", normal=[1, 2, 0]),
        "node": built("node", field=node("gyroid", period=2, thickness=0.3),
                      bounds=[[-1.5, -1.2, -1], [1.5, 1.2, 1]]),
    },
    "Falloffs": {
        "none": weight("none"), "hard": weight("hard"), "linear": weight("linear"),
        "smoothstep": weight("smoothstep"),
        "smoothstep-inner": weight({"type": "smoothstep", "inner": 0.5}),
        "smootherstep": weight("smootherstep"), "spherical": weight("spherical"), "tip": weight("tip"),
        "curve": weight({"type": "curve", "points": [[0, 0.4], [0.3, 1], [0.6, 0.3], [1, 0]]}),
    },
    "Paths, copies and masks": {
        "dabs": edit("add", shape=DOT, path={"points": BEND, "spacing": 1.2}),
        "sweep": edit("add", shape=DOT, path={"points": BEND, "mode": "sweep"}),
        "sweep-csg": edit("add", blend="csg", shape=shape("capsule", radius=[0.5, 0.15]),
                          path={"points": BEND, "mode": "sweep"}),
        "mirror": edit("add", base=AIR, blend="csg", shape=STAR, mirror="x"),
        "radial": edit("add", base=AIR, blend="csg", shape=STAR, radial={"count": 5, "axis": "z"}),
        "mask": edit("subtract", shape=shape("sphere", radius=1.6), strength=1.5, falloff="hard",
                     mask=node("smoothstep", source="x", edges=[-1, 1])),
    },
}


def run(mc, base, edits, folder):
    """Rows of values before and after, the upper row first; painted vertices in the plane."""
    grid = {"samples": [SIDE, SIDE, 2], "spacing": STEP, "origin": [LOW, LOW, 0]}
    volume = {"format": "mc-volume", "version": 1, "grid": grid, "field": base}
    script = {"format": "mc-edits", "version": 1, "edits": edits}
    (folder / "specs").symlink_to(ROOT / "data" / "specs")
    (folder / "volume.json").write_text(json.dumps(volume))
    (folder / "script.json").write_text(json.dumps(script))
    words = [mc, "edit", "-q", "volume.json", "--iso", "0", "--inside", "above", "--script", "script.json",
             "-o", "after.raw", "-o", "after.ply", "--ascii", "--allow-empty", "--normals", "none"]
    subprocess.run(words, check=True, cwd=folder)
    subprocess.run([mc, "sample", "-q", "volume.json", "-o", "before.raw"], check=True, cwd=folder)
    def rows(name):
        values = struct.unpack_from(f"<{SIDE * SIDE}f", (folder / name).read_bytes())
        return [values[n * SIDE:(n + 1) * SIDE] for n in reversed(range(SIDE))]
    head, body = (folder / "after.ply").read_text().split("end_header\n")
    n_vertices = int(head.split("element vertex ")[1].split()[0])
    painted = []
    if "material" in head:
        vertices = [line.split() for line in body.splitlines()[:n_vertices]]
        painted = [(float(v[0]), float(v[1]), int(v[3])) for v in vertices]
    return rows("before.raw"), rows("after.raw"), painted


def dot(pixels, x, y, color):
    column, row = round((x - LOW) / STEP), SIDE - 1 - round((y - LOW) / STEP)
    for j in range(max(row - 2, 0), min(row + 3, SIDE)):
        for i in range(max(column - 2, 0), min(column + 3, SIDE)):
            pixels[j][i] = color


def field_picture(before, after, painted):
    pixels = [[shade(v) for v in row] for row in after]
    for j, row in enumerate(before):
        for i, v in enumerate(row):
            if abs(v) < 0.7 * STEP and abs(after[j][i]) > 2 * STEP:
                pixels[j][i] = [255, 255, 255]
    for x, y, material in painted:
        if material:
            dot(pixels, x, y, [190, 60, 30])
    return pixels


def weight_picture(after):
    """The area under the weight, over the distance from the ball's middle to its rim."""
    middle = after[SIDE // 2]
    pixels = []
    for j in range(SIDE):
        height = 1.15 - 1.3 * (j + 0.5) / SIDE
        row = [[222, 176, 118] if 0 <= height < middle[SIDE // 2 + i // 2] else [176, 198, 214]
               for i in range(SIDE)]
        pixels.append([[40, 36, 32]] * SIDE if abs(height) < 0.006 else row)
    return pixels


def draw(mc, section, name, base, edits):
    with tempfile.TemporaryDirectory() as folder:
        before, after, painted = run(mc, base, edits, pathlib.Path(folder))
    pixels = weight_picture(after) if section == "Falloffs" else field_picture(before, after, painted)
    (ROOT / "data" / "pictures" / "edits" / f"{name}.png").write_bytes(png(pixels))


def text_of_edits(_, what):
    return " ".join(f"`{json.dumps(record)}`" for record in what[1])


HEAD = [
    "# Ops, shapes and falloffs of mc-edits", "",
    "Written by `scripts/edit_pictures.py`, which drew the pictures from what `mc edit` wrote. mc-edits(5)",
    "has the formulas. Each picture is the square from -2 to 2, x to the right, y up. Warm is solid, lines",
    "are 1/4 apart, white is where the surface was. Of a falloff it is the area under the weight, from the",
    "middle of the ball to its rim.",
]


def main():
    mc, *wanted = sys.argv[1:]
    mc = str(pathlib.Path(mc).resolve())
    (ROOT / "data" / "pictures" / "edits").mkdir(exist_ok=True)
    for section, pictures in SECTIONS.items():
        for name, (base, edits) in pictures.items():
            if not wanted or name in wanted:
                draw(mc, section, name, base, edits)
    write_page(ROOT / "data" / "edits.md", HEAD, "edits", SECTIONS, text_of_edits)


if __name__ == "__main__":
    main()
