#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a volume: ball.py FILE [--n N] [--type u8|f32] [--value V | --nan].

A ball in a cube of N^3 samples (16): 200 at the middle, falling linearly to 0 at its border.
"""

import argparse
import array
import math
import sys

parser = argparse.ArgumentParser()
parser.add_argument("file")
parser.add_argument("--n", type=int, default=16)
parser.add_argument("--type", default="u8", choices=["u8", "f32"])
parser.add_argument("--value", type=float, help="everywhere, in place of the ball")
parser.add_argument("--nan", action="store_true")
args = parser.parse_args()

n, middle = args.n, (args.n - 1) / 2


def value(i, j, k):
    if args.nan:
        return math.nan
    if args.value is not None:
        return args.value
    r = math.dist((i, j, k), (middle,) * 3)
    return max(0.0, 200 * (1 - r / middle))


rows = (value(i, j, k) for k in range(n) for j in range(n) for i in range(n))
samples = array.array("B", (int(v) for v in rows)) if args.type == "u8" else array.array("f", rows)
if sys.byteorder == "big":
    samples.byteswap()
with open(args.file, "wb") as out:
    samples.tofile(out)
