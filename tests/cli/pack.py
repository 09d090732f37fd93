#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Packs bytes without the shell's programs: pack.py gzip|members|zstd FILE OUT.

members: gzip, in two members. zstd: frames of stored blocks, as RFC 8878 allows, so that no zstd
program is needed.
"""

import gzip
import pathlib
import sys

kind, source, target = sys.argv[1:]
data = pathlib.Path(source).read_bytes()


def zstd_frame(part):
    """One frame: content size in 8 bytes, blocks of at most 64 KiB, as they are."""
    frame = b"\x28\xb5\x2f\xfd" + bytes([0xE0]) + len(part).to_bytes(8, "little")
    blocks = [part[i : i + 65536] for i in range(0, len(part), 65536)] or [b""]
    for n, block in enumerate(blocks):
        header = (len(block) << 3) | (n == len(blocks) - 1)
        frame += header.to_bytes(3, "little") + block
    return frame


half = len(data) // 2
if kind == "gzip":
    packed = gzip.compress(data, mtime=0)
elif kind == "members":
    packed = gzip.compress(data[:half], mtime=0) + gzip.compress(data[half:], mtime=0)
else:
    packed = zstd_frame(data[:half]) + zstd_frame(data[half:])
pathlib.Path(target).write_bytes(packed)
