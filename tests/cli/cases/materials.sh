# Vertices get the indices of the document's materials, in formats that hold them.
. "$CASES/case.sh"
cat > m.json <<'JSON'
{"format": "mc-volume", "version": 1, "grid": {"cells": [8, 8, 8], "origin": [-4, -4, -4]}, "field": {"type": "sphere", "radius": 3},
 "material": {"type": "select", "control": "y", "a": 2, "b": 5}}
JSON
for format in ply obj stl glb gltf; do
  mc extract m.json -o "m.$format"
  mc check "m.$format" | grep -E "good|defect"
done

echo "ply"
mc extract -q m.json --ascii --normals none --to ply -o - > text.ply
grep property text.ply
vertices() { sed '1,/end_header/d' | head -174; }
vertices < text.ply | awk '{ print ($2 < 0) ? "below" : "above", $4 }' | sort | uniq -c | sed 's/^ *//'

echo "glb: one attribute for programs, one for eyes"
grep -ao '"_MATERIAL":[0-9]*' m.glb
grep -ao '"COLOR_0":[0-9]*' m.glb

echo "moved, the materials move along"
mc extract -q m.json --origin 100,200,300 --ascii --normals none --to ply -o - | vertices |
  awk '{ print ($2 < 204) ? "below" : "above", $4 }' | sort | uniq -c | sed 's/^ *//'

echo "numbers that are no index"
sed 's/"a": 2/"a": -3/' m.json > held.json
mc extract held.json -o held.ply
