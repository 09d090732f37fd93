# SPDX-License-Identifier: MIT
# Read by every case: the program by its name, its status shown where it is not 0, and a volume.

exec 2>&1 # in the order in which things are said

mc() {
  "$MC" "$@" || echo "status $?"
}

ball() {
  python3 "$CASES/ball.py" "$@"
}

# How raw balls are read.
RAW="--dims 16,16,16 --type u8"
