# Edited volumes keep their materials, and paint reaches the mesh.
. "$CASES/case.sh"
cat > m.json <<'JSON'
{"format": "mc-volume", "version": 1, "grid": {"cells": [8, 8, 8], "origin": [-4, -4, -4]}, "field": {"type": "sphere", "radius": 3},
 "material": {"type": "select", "control": "y", "a": 2, "b": 5}}
JSON
head='{"format":"mc-edits","version":1}'
paint() { printf '{"op":"paint","material":%s,"shape":{"type":"sphere","center":[3,0,0],"radius":1.5}}\n' "$1"; }
far='{"op":"add","shape":{"type":"sphere","center":[90,0,0],"radius":1},"strength":1}'

echo "nothing touched: the bytes of extract"
printf '%s\n%s\n' "$head" "$far" > far.jsonl
for format in ply glb; do
  mc extract -q m.json -o "m.$format"
  mc edit -q m.json --script far.jsonl -o "far.$format"
  cmp "m.$format" "far.$format"
done

echo "painted, also with 0 over the document's own; undone: the bytes of extract"
count() { sed '1,/end_header/d' "$1" | head -174 | awk '{ print $4 }' | sort -n | uniq -c | sed 's/^ *//'; }
for material in 9 0; do
  { echo "$head"; paint $material; } > paint.jsonl
  mc edit -q m.json --script paint.jsonl --normals none --ascii -o "p$material.ply"
  count "p$material.ply"
done
{ echo "$head"; paint 9; echo '{"op":"undo"}'; } > undone.jsonl
mc edit -q m.json --script undone.jsonl -o undone.ply
cmp m.ply undone.ply

echo "sparse, without materials of its own, any number of threads"
mc sample -q m.json -o m.vdb
mc edit -q m.vdb --script paint.jsonl --normals none --ascii --threads 1 -o v.ply
{ echo "$head"; paint 9; } > paint.jsonl
mc edit -q m.vdb --script paint.jsonl --normals none --ascii --threads 1 -o v9.ply
count v9.ply
mc edit -q m.vdb --script paint.jsonl --normals none --ascii --threads 2 -o - --to ply | cmp - v9.ply

echo "a format that holds none says so"
mc edit m.json --script paint.jsonl -o p.obj
