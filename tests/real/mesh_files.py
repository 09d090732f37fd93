# SPDX-License-Identifier: MIT
"""Binary PLY and GLB files read anew, and measured: an oracle that shares no code with mc.

Only what mc writes is understood, and every deviation from it is an error: that is the point.
"""

import array
import json
import math
import pathlib
import struct

SKIPPED = 77  # the exit status that ctest takes for "did not run"


class Mesh:
    """positions: x, y, z each, in doubles; corners: three vertex indices a triangle."""

    def __init__(self, positions, corners):
        self.positions = positions
        self.corners = corners
        self.n_vertices = len(positions) // 3
        self.n_triangles = len(corners) // 3
        if corners and max(corners) >= self.n_vertices:
            raise ValueError(f"index {max(corners)} of {self.n_vertices} vertices")

    def bounds(self):
        """Lowest and highest x, y, z."""
        axes = [self.positions[axis::3] for axis in range(3)]
        return [min(axis) for axis in axes], [max(axis) for axis in axes]

    def area_and_volume(self):
        """Sum of triangle areas; signed volume, about the first vertex."""
        p, c = self.positions, self.corners
        ox, oy, oz = p[0:3]
        area = volume = 0.0
        for n in range(0, len(c), 3):
            i, j, k = 3 * c[n], 3 * c[n + 1], 3 * c[n + 2]
            ax, ay, az = p[i] - ox, p[i + 1] - oy, p[i + 2] - oz
            bx, by, bz = p[j] - ox, p[j + 1] - oy, p[j + 2] - oz
            cx, cy, cz = p[k] - ox, p[k + 1] - oy, p[k + 2] - oz
            ux, uy, uz = bx - ax, by - ay, bz - az
            vx, vy, vz = cx - ax, cy - ay, cz - az
            nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            area += math.sqrt(nx * nx + ny * ny + nz * nz)
            volume += ax * nx + ay * ny + az * nz
        return area / 2, volume / 6

    def boundary_edges(self):
        """Sides without their opposite. A side that occurs twice is a ValueError."""
        c = self.corners
        sides = set()
        for n in range(0, len(c), 3):
            i, j, k = c[n], c[n + 1], c[n + 2]
            sides.update((i << 32 | j, j << 32 | k, k << 32 | i))
        if len(sides) != len(c):
            raise ValueError(f"{len(c) - len(sides)} sides occur more than once")
        return sum((side & 0xFFFFFFFF) << 32 | side >> 32 not in sides for side in sides)


def read_ply(path):
    """A binary little-endian PLY with float or double coordinates, perhaps with normals."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode("ascii").splitlines()
    if lines[:2] != ["ply", "format binary_little_endian 1.0"]:
        raise ValueError(f"{path}: begins {lines[:2]}")
    words = [line.split() for line in lines]
    n_vertices, n_faces = (int(w[2]) for w in words if w[0] == "element")
    properties = [w for w in words if w[0] == "property"]
    vertex = "<" + "".join({"float": "f", "double": "d"}[w[1]] for w in properties[:-1])
    if [w[-1] for w in properties] not in (
        ["x", "y", "z", "vertex_indices"],
        ["x", "y", "z", "nx", "ny", "nz", "vertex_indices"],
    ):
        raise ValueError(f"{path}: properties {properties}")
    faces_at = end + n_vertices * struct.calcsize(vertex)
    if len(data) != faces_at + 13 * n_faces:
        raise ValueError(f"{path}: {len(data)} bytes, not {faces_at + 13 * n_faces}")
    positions = array.array("d")
    for record in struct.iter_unpack(vertex, data[end:faces_at]):
        positions.extend(record[:3])
    corners = array.array("Q")
    for n, i, j, k in struct.iter_unpack("<BIII", data[faces_at:]):
        if n != 3:
            raise ValueError(f"{path}: a face of {n} corners")
        corners.extend((i, j, k))
    return Mesh(positions, corners)


def glb_parts(path):
    """The JSON document and the binary chunk of a GLB."""
    data = pathlib.Path(path).read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    if (magic, version, length) != (b"glTF", 2, len(data)):
        raise ValueError(f"{path}: {magic} version {version}, {length} of {len(data)} bytes")
    json_length, json_type = struct.unpack_from("<I4s", data, 12)
    binary_length, binary_type = struct.unpack_from("<I4s", data, 20 + json_length)
    if (json_type, binary_type) != (b"JSON", b"BIN\0"):
        raise ValueError(f"{path}: chunks {json_type} and {binary_type}")
    return json.loads(data[20 : 20 + json_length]), data[28 + json_length :][:binary_length]


def read_glb(path):
    """The one triangle primitive of a GLB, moved by its node's translation."""
    document, binary = glb_parts(path)
    (mesh,), (node,) = document["meshes"], [n for n in document["nodes"] if "mesh" in n]
    (primitive,) = mesh["primitives"]
    shift = node.get("translation", [0, 0, 0])

    def records(accessor_index, layout):
        accessor = document["accessors"][accessor_index]
        view = document["bufferViews"][accessor["bufferView"]]
        at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", struct.calcsize(layout))
        padded = layout + f"{stride - struct.calcsize(layout)}x"
        # The last record may lack the padding that the stride brings.
        piece = binary[at : at + stride * accessor["count"]].ljust(stride * accessor["count"], b"\0")
        return struct.iter_unpack(padded, piece)

    positions = array.array("d")
    for x, y, z in records(primitive["attributes"]["POSITION"], "<fff"):
        positions.extend((x + shift[0], y + shift[1], z + shift[2]))
    accessor = document["accessors"][primitive["indices"]]
    corners = array.array("Q")
    corners.extend(i for (i,) in records(primitive["indices"], {5123: "<H", 5125: "<I"}[accessor["componentType"]]))
    return Mesh(positions, corners)
