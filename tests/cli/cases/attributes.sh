# Vertices carry the values of the document's attributes, in formats that hold them.
. "$CASES/case.sh"
cat > a.json <<'JSON'
{"format": "mc-volume", "version": 1, "grid": {"cells": [8, 8, 8], "origin": [-4, -4, -4]}, "field": {"type": "sphere", "radius": 3},
 "attributes": {"heat": "x", "Odd": {"type": "div", "a": 1, "b": "y"}}}
JSON
for format in ply obj glb gltf; do
  mc extract a.json -o "a.$format"
  mc check "a.$format" | grep -E "good|defect"
done

echo "ply: the value of x at each vertex"
mc extract -q a.json --ascii --normals none --to ply -o - > text.ply
grep property text.ply
sed '1,/end_header/d' text.ply | head -174 | awk '$1 != $4' | wc -l | tr -d ' '

echo "glb"
grep -ao '"_[A-Z]*":[0-9]*' a.glb

echo "with a material"
sed 's/"field"/"material": 7, "field"/' a.json > both.json
mc extract both.json -o both.stl
mc extract -q both.json --ascii --normals none --to ply -o - | grep property

echo "a name that is taken"
sed 's/"heat"/"nx"/' a.json > bad.json
mc extract bad.json -o bad.ply
