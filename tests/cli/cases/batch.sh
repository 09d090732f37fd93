# Each input by itself: one that fails does not stop the others; its status is the batch's.
. "$CASES/case.sh"
ball a.raw
ball c.raw --value 7
ball d.raw
mkdir out other
cp a.raw other/
mc extract a.raw nope.raw c.raw d.raw $RAW --iso 20 --out-dir out --to ply --report r.json
python3 -c '
import json
for line in open("r.json"):
    r = json.loads(line)
    print(r["input"]["place"], r["status"], r["output"], r["triangles"])'
ls out
mc extract a.raw other/a.raw $RAW --iso 20 --out-dir out
mc extract - $RAW --iso 20 --out-dir out
mc extract a.raw d.raw $RAW --iso 20 --out-dir out --to ply -q
