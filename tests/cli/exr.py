# SPDX-License-Identifier: MIT
"""Writes OpenEXR files without a library: uncompressed or ZIPS, scan lines or tiles, several parts.

    exr.py FILE JSON

JSON is a part or a list of parts: {"size": [w, h], "type": "half|float|uint", "channels": "BGR",
"at": [x, y] of the data window, "shown": [x0, y0, x1, y1], "tile": [w, h], "zip": true, "name": ...,
"first": value}. Channel number c has the value first + 100 c + x + 10 y at column x of row y, from
the top.
"""

import json
import struct
import sys
import zlib

TYPES = {"uint": (0, "I"), "half": (1, "e"), "float": (2, "f")}


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(data)) + data


def packed(raw):
    """ZIPS: bytes of even places first, then differences, then deflate."""
    turned = raw[0::2] + raw[1::2]
    steps = bytes([turned[0]]) + bytes((b - a + 128) & 255 for a, b in zip(turned, turned[1:]))
    done = zlib.compress(steps)
    return done if len(done) < len(raw) else raw


def header(part, several, n_chunks):
    w, h = part["size"]
    x, y = part.get("at", [0, 0])
    number, _ = TYPES[part["type"]]
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", number, 0, 1, 1)
                        for name in sorted(part["channels"]))
    window = (x, y, x + w - 1, y + h - 1)
    out = attribute("channels", "chlist", channels + b"\0")
    out += attribute("compression", "compression", bytes([2 if part.get("zip") else 0]))
    out += attribute("dataWindow", "box2i", struct.pack("<4i", *window))
    out += attribute("displayWindow", "box2i", struct.pack("<4i", *part.get("shown", window)))
    out += attribute("lineOrder", "lineOrder", b"\0")
    out += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    out += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    out += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    if "tile" in part:
        out += attribute("tiles", "tiledesc", struct.pack("<IIB", *part["tile"], 0))
    if several:
        out += attribute("name", "string", part["name"].encode())
        out += attribute("type", "string", b"tiledimage" if "tile" in part else b"scanlineimage")
        out += attribute("chunkCount", "int", struct.pack("<i", n_chunks))
    return out + b"\0"


def block(part, x0, y0, x1, y1):
    """The rows y0..y1 of columns x0..x1, channel after channel in each row."""
    letter = TYPES[part["type"]][1]
    raw = b""
    for y in range(y0, y1):
        for c in range(len(part["channels"])):
            row = [part.get("first", 0) + 100 * c + x + 10 * y for x in range(x0, x1)]
            raw += struct.pack(f"<{len(row)}{letter}", *row)
    return packed(raw) if part.get("zip") else raw


def chunks(part):
    w, h = part["size"]
    top = part.get("at", [0, 0])[1]
    if "tile" not in part:
        for y in range(h):
            raw = block(part, 0, y, w, y + 1)
            yield struct.pack("<ii", top + y, len(raw)) + raw
        return
    tw, th = part["tile"]
    for y in range(0, h, th):
        for x in range(0, w, tw):
            raw = block(part, x, y, min(x + tw, w), min(y + th, h))
            yield struct.pack("<5i", x // tw, y // th, 0, 0, len(raw)) + raw


def main():
    parts = json.loads(sys.argv[2])
    several = isinstance(parts, list)
    parts = parts if several else [parts]
    data = [list(chunks(part)) for part in parts]
    flags = 0x1000 if several else 0x200 if "tile" in parts[0] else 0
    out = struct.pack("<II", 20000630, 2 | flags)
    out += b"".join(header(p, several, len(d)) for p, d in zip(parts, data))
    out += b"\0" if several else b""
    at = len(out) + 8 * sum(map(len, data))
    table = body = b""
    for n, part in enumerate(data):
        for chunk in part:
            chunk = (struct.pack("<i", n) if several else b"") + chunk
            table += struct.pack("<Q", at)
            body += chunk
            at += len(chunk)
    with open(sys.argv[1], "wb") as file:
        file.write(out + table + body)


if __name__ == "__main__":
    main()
