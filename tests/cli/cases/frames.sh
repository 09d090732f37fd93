# Frames and units: what the source says, and what is chosen instead.
. "$CASES/case.sh"
ball ball.raw
bounds() {
  "$MC" check "$1" --json | python3 -c '
import json, sys
print([[round(x, 4) for x in p] for p in json.load(sys.stdin)["bounds"]])'
}
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 16 16 16\n'
  printf 'space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (100,200,300)\n'
  printf 'encoding: raw\n\n'; cat ball.raw; } > scan.nrrd
mc extract scan.nrrd --iso 100 -q -o a.ply
bounds a.ply
mc extract scan.nrrd --iso 100 -q -o b.ply --frame ras
bounds b.ply
mc extract scan.nrrd --iso 100 -q -o c.glb
bounds c.glb
mc extract scan.nrrd --iso 100 -q -o d.ply --up z
mc extract ball.raw $RAW --origin 100,200,300 --iso 100 -q -o e.glb --up z
bounds e.glb
mc extract ball.raw $RAW --origin 100,200,300 --iso 100 -q -o f.glb --frame lps
bounds f.glb
mc extract ball.raw $RAW --iso 100 -o far.ply --origin 1e6,0,0
mc extract ball.raw $RAW --iso 100 -o far.stl --origin 1e6,0,0
mc extract ball.raw $RAW --iso 100 -q -o far.glb --origin 1e6,0,0
for name in far.ply far.glb; do bounds $name; done
