# A volume goes round through NRRD and VDB and stays what it is.
. "$CASES/case.sh"
ball ball.raw
mc info ball.raw $RAW
mc sample ball.raw $RAW --spacing 1,2,3 --origin -1,-2,-3 -o v.nrrd
mc info v.nrrd
mc sample ball.raw $RAW --region 2,2,2:9,9,9 -o part.nrrd
mc info part.nrrd | grep -E 'dims|origin'
mc extract v.nrrd --iso 20 -q -o a.ply
mc extract ball.raw $RAW --spacing 1,2,3 --origin -1,-2,-3 --iso 20 -q -o b.ply
cmp a.ply b.ply
mc info v.nrrd nope.nrrd --json > info.json
python3 -c '
import json, sys
for line in sys.stdin:
    if line.startswith("{"):
        info = json.loads(line)
        print(info["input"], info["error"], [g["suggested_iso"] for g in info["grids"]])
    else:
        print(line, end="")' < info.json
mc sample ball.raw $RAW -o v.nrrd
