# OpenEXR slices are a volume, whatever their layout; they go round to the last bit; what is missing
# or odd among them is named.
. "$CASES/case.sh"
exr() { python3 "$CASES/exr.py" "$1" "$2"; }
values() { # every sample, plane by plane from the first, rows from j = 0
  rm -f v.raw v.nhdr
  mc sample "$@" -o v.raw
  python3 - <<'PY'
import re, struct
text = open("v.nhdr").read()
size = [int(n) for n in re.search(r"sizes: (.*)", text)[1].split()]
letter = {"float": "f", "uint32": "I"}[re.search(r"type: (.*)", text)[1]]
data = open("v.raw", "rb").read()
values = struct.unpack(f"<{size[0] * size[1] * size[2]}{letter}", data)
print("origin", re.search(r"space origin: (.*)", text)[1])
for k in range(size[2]):
    print(" | ".join(" ".join(f"{v:g}" for v in values[(k * size[1] + j) * size[0]:][:size[0]])
                     for j in range(size[1])))
PY
}
echo "layouts"
mkdir plain tiled zip window
for n in 1 2 10; do
  exr plain/s$n.exr '{"size": [3, 2], "type": "half", "channels": "Y", "first": '$n'00}'
  exr tiled/s0$n.exr '{"size": [3, 2], "type": "float", "channels": "BGR", "tile": [2, 2], "first": '$n'00}'
  exr zip/s.0$n.exr '{"size": [3, 2], "type": "uint", "channels": "YZ", "zip": true, "first": '$n'00}'
  exr window/s-$n.exr '{"size": [3, 2], "type": "float", "channels": "Z", "at": [5, 7], "shown": [1, 2, 99, 11], "first": '$n'00}'
done
mv plain/s10.exr plain/s3.exr
mv tiled/s010.exr tiled/s03.exr
mv zip/s.010.exr zip/s.03.exr
mv window/s-10.exr window/s-3.exr
values plain
values tiled
values tiled --channel B
values zip/*.exr --channel Z
values 'window/*.exr'
values window --origin 1,2,3 --spacing 2,2,2
echo "parts"
exr parts.exr '[{"name": "a", "size": [3, 2], "type": "half", "channels": "RZ", "first": 1},
  {"name": "mask", "size": [9, 9], "type": "half", "channels": "M"},
  {"name": "b", "size": [3, 2], "type": "half", "channels": "R", "first": 50, "tile": [2, 1]}]'
values parts.exr
mc info parts.exr --channel Z
values - < parts.exr
echo "what is wrong"
rm plain/s2.exr
mc info plain
exr plain/s2.exr '{"size": [3, 3], "type": "half", "channels": "Y"}'
mc info plain/s1.exr plain/s3.exr plain/s2.exr
exr plain/s2.exr '{"size": [3, 2], "type": "float", "channels": "Y"}'
mc info plain
exr plain/s2.exr '{"size": [3, 2], "type": "half", "channels": "Z"}'
mc info plain
head -c 300 plain/s1.exr > plain/s2.exr
mc info plain | sed 's/damaged OpenEXR file: .*/damaged/'
echo hello > plain/s2.exr
mc info plain
mc info plain/s1.exr
mc info parts.exr --channel W
mc extract tiled --grid x -o m.ply
mc extract v.nhdr --channel x -o m.ply
echo "round trip"
for spec in csg demo-terrain; do
  mkdir $spec
  mc sample "$DATA/specs/$spec.json" -o $spec/s.##.exr
  mc extract "$DATA/specs/$spec.json" -q -o a.ply
  mc extract $spec -q -o b.ply
  cmp a.ply b.ply
  mc extract "$spec/s.*.exr" --threads 1 --memory 16MiB -q --force -o b.ply
  cmp a.ply b.ply
  rm a.ply b.ply
done
ls demo-terrain | tail -n 2
mc sample demo-terrain -o demo-terrain/t.####.exr
for n in 01 20 21; do cmp demo-terrain/s.$n.exr demo-terrain/t.00$n.exr; done
rm demo-terrain/t.*
mv demo-terrain/s.21.exr last.exr
mc info demo-terrain
mv demo-terrain/s.01.exr first.exr
mc info demo-terrain
echo "writing"
mc sample csg -o csg/s.##.exr
mc sample csg -o csg.exr
mc sample csg -o - --to exr > /dev/null
mc sample csg -o nowhere/s.#.exr
ball ball.raw
mc sample ball.raw $RAW -o u8.#.exr
mc info u8.*.exr | grep -E 'type|dims|range'
mkdir many # more files than may be open
(ulimit -n 32; mc sample ball.raw --dims 8,8,64 --type u8 -o many/#.exr)
ls many | wc -l
mc sample many -q -o many.raw
mc sample ball.raw --dims 8,8,64 --type u8 -q -o once.nrrd
mc info many.raw once.nrrd | grep -E 'dims|range|percentiles'
python3 -c 'import sys; sys.stdout.buffer.write(bytes(64))' > d.raw
mc sample d.raw --dims 2,2,2 --type f64 -o d.#.exr
echo kept > e.5.exr
mc sample ball.raw $RAW -o e.#.exr
ls | grep -E '^(d|e)\.|partial'
