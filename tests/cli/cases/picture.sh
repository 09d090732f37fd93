# A slice becomes a picture, the right way up, and a picture becomes terrain.
. "$CASES/case.sh"
cat > grey.py <<'PY'
import struct, sys, zlib
data, at, rows = open(sys.argv[1], "rb").read(), 8, b""
while at < len(data):
    n, kind = struct.unpack(">I4s", data[at:at + 8])
    body = data[at + 8:at + 8 + n]
    if kind == b"IHDR":
        width, height, depth = struct.unpack(">IIB", body[:9])
    elif kind == b"IDAT":
        rows += body
    elif kind == b"tEXt" and not body.startswith(b"generator"):
        print(body.replace(b"\0", b": ").decode())
    at += n + 12
rows, pitch, before = zlib.decompress(rows), width * depth // 8, None
step = depth // 8
for r in range(height):
    kind, row = rows[r * (pitch + 1)], bytearray(rows[r * (pitch + 1) + 1:(r + 1) * (pitch + 1)])
    before = before or bytearray(pitch)
    for i in range(pitch):
        left, up = row[i - step] if i >= step else 0, before[i]
        corner = before[i - step] if i >= step else 0
        near = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
        row[i] = row[i] + (0, left, up, (left + up) // 2, near)[kind] & 255
    before = row
    print(*struct.unpack(f">{width}{'H' if depth == 16 else 'B'}", row))
PY
GREY=$PWD/grey.py
grey() { python3 "$GREY" "$1"; }
python3 -c 'import sys; sys.stdout.buffer.write(bytes(range(24)))' > v.raw # 4 x 3 x 2
RAW="--dims 4,3,2 --type u8 --origin 10,20,30"
for slice in z=30 k=1 x=10 i=3 y=22 j=0; do
  rm -f a.png
  echo "$slice"
  mc sample v.raw $RAW --slice $slice --bits 8 --range 0,255 -q -o a.png
  grey a.png
done
mc sample v.raw $RAW --slice z=30.4 --force -o a.png
grey a.png
mc sample v.raw $RAW --slice z=30 --region 1,0,0:2,2,1 --range 6,5 --force -o a.png
grey a.png
mc sample v.raw $RAW --slice z=32 -o b.png
mc sample v.raw $RAW --slice k=-1 -o b.png
mc sample v.raw $RAW -o b.png
mc sample v.raw $RAW --slice w=1 -o b.png
mc sample v.raw $RAW --slice z=30 -o b.nrrd
mc sample v.raw $RAW --slice z=30 -o b.exr --bits 8
mc sample v.raw $RAW --slice z=30 -o b.png --range 1,1
mc sample v.raw $RAW --slice z=30 -o b.png --bits 12
mc sample v.raw $RAW --slice z=30 -o a.png
mc extract a.png -o m.ply
# The picture seen from above, laid on the ground again: a terrain through the same points.
cat > up.json <<'JSON'
{ "format": "mc-volume", "version": 1, "grid": { "samples": [4, 2, 2], "origin": [10, 0, 30] },
  "field": { "type": "heightmap", "path": "maps/above.png", "origin": [9.5, 29.5], "size": [4, 2], "height": 65535 } }
JSON
mkdir maps
mc sample v.raw $RAW --slice j=1 --range 0,65535 -q -o maps/above.png
mkdir elsewhere
cd elsewhere
mc sample ../up.json --slice y=0 --range 0,255 --bits 8 -q -o back.png
grey back.png
cd ..
mc sample v.raw $RAW --slice j=1 -q -o maps/above.exr
sed 's/above.png/above.exr/; s/65535/1/' up.json > up2.json
mc sample up2.json --slice y=0 --range 0,255 --bits 8 -q -o back.png
grey back.png
sed 's/"height"/"channel": "R", "height"/' up.json > bad.json
mc info bad.json
mc sample v.raw --dims 4,3,2 --type u8 --slice z=0 --to png -q -o - > c.png
cmp -n 16 a.png c.png
