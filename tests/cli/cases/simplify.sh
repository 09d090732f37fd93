# Fewer triangles of a box and of a ball; the report has the distances.
. "$CASES/case.sh"
python3 - <<'END_OF_SCRIPT'
import itertools
def at(p):
    box = min(min(x - 10.5, 70.5 - x) for x in p)
    return max(-9, min(9, box))
with open("box.raw", "wb") as out:
    for k, j in itertools.product(range(80), range(80)):
        out.write(bytes(int(128 + 10 * at((i, j, k))) for i in range(80)))
END_OF_SCRIPT
RAW="--dims 80,80,80 --type u8 --iso 128"
mc extract box.raw $RAW -o all.ply -q
mc check all.ply | grep -E 'good|triangles'
mc extract box.raw $RAW -o small.ply --simplify ratio=0.1 --report report.json
mc check --closed small.ply | grep -E 'good|triangles|components|euler'
grep -oE '"(triangles|extracted_triangles)":[0-9]+' report.json
grep -oE '"distance_[a-z_]+"' report.json
for how in '--threads 1' '--threads 2' '--memory 32MiB'; do
  mc extract box.raw $RAW -o again.ply --simplify ratio=0.1 --force -q $how
  cmp small.ply again.ply
done
mc extract - -o piped.ply --simplify ratio=0.1 -q $RAW < box.raw
cmp small.ply piped.ply
mc extract box.raw $RAW -o flat.ply --simplify error=0.01
mc extract box.raw $RAW -o few.ply --simplify count=3
mc check --closed few.ply | head -1
mc extract box.raw $RAW -o none.ply --simplify 0.5
mc extract box.raw $RAW -o none.ply --simplify ratio=0.1 --memory 10MiB
printf '%s\n' '{"format":"mc-edits","version":1,"space":"index","defaults":{"strength":200}}' > nothing.jsonl
mc edit box.raw $RAW --script nothing.jsonl -o edited.ply --simplify ratio=0.1 -q
cmp small.ply edited.ply
mc edit box.raw $RAW --script nothing.jsonl --emit chunks --chunk-dir chunks --simplify ratio=0.1
