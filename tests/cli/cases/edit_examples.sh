# Every script of data/scripts does what it says.
. "$CASES/case.sh"
S="$DATA/scripts"
edit() { # edit INPUT SCRIPT OPTIONS...: how the mesh changes
  input=$1 script=$2
  shift 2
  mc extract "$input" "$@" -o before.ply --force -q
  mc edit "$input" "$@" --script "$S/$script" -o after.ply --force -q
  echo "$script"
  for when in before after; do mc check $when.ply | sed -n 2,3p; done
}
edit "$DATA/specs/demo-terrain.json" demo-brush.jsonl
edit "$DATA/specs/terrain.json" tunnel.json
edit "$S/plain.json" craters.jsonl
edit "$S/plain.json" arch.json
edit "$DATA/specs/sphere.json" clear-and-draw.jsonl --border closed
# Stand-ins of the scans: a rough ball, and one in the head's samples.
cat > rough.json <<'END'
{ "format": "mc-volume", "version": 1, "grid": { "samples": [48, 62, 42] }, "field": { "type": "add", "inputs": [
  { "type": "sphere", "center": [24, 30, 21], "radius": 18 }, { "type": "mul", "inputs": [2, { "type": "white" }] } ] } }
END
edit rough.json smooth-scan.json
cat > head.json <<'END'
{ "format": "mc-volume", "version": 1, "grid": { "samples": [64, 64, 93] }, "field": {
  "type": "ellipsoid", "center": [32, 32, 46], "radii": [26, 28, 40] } }
END
edit head.json cut-head.json
