# A budget that cannot be kept is refused before the work.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -o m.ply --memory 1KiB
mc sample ball.raw $RAW -o m.nrrd --memory 64
echo '{"format": "mc-volume", "version": 1, "grid": {"cells": [9, 9, 9]},
  "field": {"type": "volume", "path": "ball.nrrd"}}' > named.json
mc sample ball.raw $RAW -o ball.nrrd -q
mc extract named.json --iso 20 -o m.ply --memory 31KiB
ls
