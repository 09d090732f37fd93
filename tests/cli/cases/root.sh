# With --root no file that an input names lies outside of a folder, whatever the way there.
. "$CASES/case.sh"
mkdir -p box/inner away
ball away/ball.raw
cp away/ball.raw box/ball.raw
header() {
  printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 16 16 16\nencoding: raw\ndata file: %s\n' "$1"
}
spec() {
  printf '{"format": "mc-volume", "version": 1, "grid": {"samples": [16, 16, 16]}, "iso": 20,\n'
  printf ' "field": {"type": "volume", "path": "%s"}}\n' "$1"
}
try() {
  mc extract "$@" --iso 20 -q --root box -o m.ply && rm -f m.ply
}
header ball.raw > box/in.nhdr
header ../away/ball.raw > box/out.nhdr
header "$PWD/away/ball.raw" > box/whole.nhdr
header inner/../ball.raw > box/round.nhdr
header link.raw > box/link.nhdr
ln -s ../away/ball.raw box/link.raw
ln -s ../away box/folder
header folder/ball.raw > box/folder.nhdr
for n in in out whole round link folder; do
  echo "$n.nhdr"
  try box/$n.nhdr
done
echo "specs"
spec in.nhdr > box/in.json
spec out.nhdr > box/out.json
spec ../away/v.nhdr > box/beside.json
spec beside.json > box/nested.json
header ball.raw > away/v.nhdr
for n in in out beside nested; do
  echo "$n.json"
  try box/$n.json
done
printf '{"format": "mc-volume", "version": 1, "grid": {"samples": [16, 16, 16]},\n' > box/picture.json
printf ' "field": {"type": "heightmap", "path": "../away/a.png", "size": [1, 1]}}\n' >> box/picture.json
try box/picture.json
echo "without --root"
mc extract box/out.json -q -o m.ply
echo "no folder"
mc extract box/in.json --root none -o n.ply
mc info box/out.nhdr --root box
mc sample box/out.nhdr --root box -o n.nrrd
