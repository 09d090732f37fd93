# Of two balls, one hollow, only some remain; the report counts what was dropped.
. "$CASES/case.sh"
python3 - <<'END'
import itertools
def ball(p, at, r):
    return r - sum((x - c) ** 2 for x, c in zip(p, at)) ** 0.5
data = bytearray()
for k, j, i in itertools.product(range(24), range(24), range(48)):
    hollow = min(ball((i, j, k), (12, 12, 12), 9), -ball((i, j, k), (12, 12, 12), 4))
    small = ball((i, j, k), (34, 12, 12), 6)
    data.append(int(min(255, max(0, 128 + 20 * max(hollow, small)))))
open("balls.raw", "wb").write(data)
END
RAW="--dims 48,24,24 --type u8 --iso 128"
mc extract balls.raw $RAW -o all.ply
mc check all.ply | grep components
mc extract balls.raw $RAW -o largest.ply --keep largest --report report.json
grep -oE '"(kept|dropped)_components":[0-9]+' report.json
mc check --closed largest.ply | grep -E 'good|components|euler'
mc extract balls.raw $RAW -o two.ply --keep 2
cmp all.ply two.ply
mc extract - -o piped.ply --keep largest $RAW < balls.raw
cmp largest.ply piped.ply
mc extract balls.raw $RAW -o small.ply --keep 'volume>=2000'
mc extract balls.raw $RAW -o none.ply --keep 'area>=1e6'
mc extract balls.raw $RAW -o none.ply --keep 'area>=1e6' --allow-empty
mc check none.ply | head -1
mc extract balls.raw $RAW -o none.ply --keep some --force
printf '%s\n' '{"format":"mc-edits","version":1,"space":"index","defaults":{"strength":200}}' \
  '{"op":"add","shape":{"type":"sphere","center":[42,4,4],"radius":2}}' > add.jsonl
mc edit balls.raw $RAW --script add.jsonl -o edited.ply --keep largest
cmp largest.ply edited.ply
mc edit balls.raw $RAW --script add.jsonl --emit chunks --chunk-dir chunks --keep largest
