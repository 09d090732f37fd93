# Far away, very large, very small, endless, and read only once.
. "$CASES/case.sh"
ball a.raw
same() {
  python3 -c '
import json, sys
r, c = json.load(open("r.json")), json.loads(sys.stdin.read())
print(all(abs(r[k] - c[k]) <= 1e-4 * abs(c[k]) for k in ("area", "volume")), c["defective"])'
}
for to in ply obj glb; do
  mc extract a.raw $RAW --iso 20 --origin 1e9,1e9,-1e9 -o far.$to --report r.json -q
  "$MC" check far.$to --json | same
done
mc extract a.raw $RAW --iso 20 --origin 1e9,0,0 -o far.stl -q
mc extract a.raw $RAW --iso 20 --origin 1e18,0,0 -o farther.ply -q
mc extract a.raw $RAW --iso 20 --spacing 1e300,1e300,1e300 -o huge.glb -q
mc extract a.raw $RAW --iso 20 --spacing 1e-300,1e-300,1e-300 -o tiny.ply -q
mc check tiny.ply -q
mc extract /dev/zero $RAW --iso 20 -o zero.ply -q
mc extract /dev/zero -o zero.ply -q
mkfifo spec out
cat "$DATA/specs/demo-terrain.json" > spec &
mc extract spec -o fifo.ply -q
mc extract "$DATA/specs/demo-terrain.json" -o file.ply -q
cmp fifo.ply file.ply && echo same bytes
mc extract a.raw $RAW -o out --to gltf
mc extract a.raw $RAW --iso 20 -o b.ply --report a.raw
ls
