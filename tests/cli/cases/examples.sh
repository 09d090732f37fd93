# Every document of data/specs gives a sound mesh with these counts, closed unless it says otherwise.
. "$CASES/case.sh"
for spec in "$DATA"/specs/*.json; do
  name=$(basename "$spec" .json)
  mc extract -q "$spec" -o "$name.ply"
  mc check "$name.ply" | grep -E "good|defect|vertices  |triangles|boundary|components"
done

echo "perlin-planes inside out: the same surface, turned over"
mc extract -q --invert "$DATA/specs/perlin-planes.json" -o inverted.ply
for mesh in perlin-planes inverted; do
  mc check "$mesh.ply" | grep -E "triangles|area|volume"
done
