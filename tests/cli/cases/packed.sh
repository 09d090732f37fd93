# gzip and zstd, files and pipes, told by content: the same bytes as unpacked, and every damage found.
. "$CASES/case.sh"
pack() {
  python3 "$CASES/pack.py" "$@"
}
ball ball.raw
mc extract ball.raw $RAW --iso 20 -q -o m.ply
for kind in gzip members zstd; do
  pack $kind ball.raw b.$kind
  mc extract b.$kind $RAW --iso 20 -q -o - --to ply | cmp - m.ply
  cat b.$kind | "$MC" extract - $RAW --iso 20 -q -o - --to ply | cmp - m.ply
  "$MC" extract - $RAW --iso 20 -q -o - --to ply < b.$kind | cmp - m.ply
  "$MC" extract b.$kind --dims 16,16 --type u8 --iso 20 -q -o - --to ply | cmp - m.ply
  "$MC" extract b.$kind $RAW -q -o otsu.ply && mc extract ball.raw $RAW -q -o - --to ply | cmp - otsu.ply
  rm otsu.ply
done

echo "each kind of file"
mc sample ball.raw $RAW -q -o v.nrrd
mc sample ball.raw $RAW -q -o v.vdb
cp "$DATA/specs/sphere.json" s.json
for file in v.nrrd v.vdb s.json; do
  mc extract $file --iso 20 -q --allow-empty -o plain.ply
  pack gzip $file packed && mc extract packed --iso 20 -q --allow-empty -o - --to ply | cmp - plain.ply
  pack zstd $file packed && "$MC" extract - --iso 20 -q --allow-empty -o - --to ply < packed | cmp - plain.ply
  rm plain.ply
done
for type in ply obj stl glb; do
  mc extract ball.raw $RAW --iso 20 -q -o m.$type --force
  pack gzip m.$type packed && mc check packed | head -1
  pack zstd m.$type packed && mc check - < packed | head -1
done
pack gzip ball.raw b.raw.gz && mc info b.raw.gz $RAW | head -1

echo "raw samples that begin like packed ones"
python3 -c '
import sys
sys.stdout.buffer.write(b"\x1f\x8b\x08\x00" + bytes(4092))' > like.raw
mc extract like.raw $RAW --iso 20 -q -o like.ply && mc check like.ply | head -1

echo "damaged"
head -c 300 b.gzip > cut.gz
mc extract cut.gz $RAW --iso 20 -o no.ply
head -c 3000 b.zstd > cut.zst
mc extract cut.zst $RAW --iso 20 -o no.ply
cat cut.zst | mc extract - $RAW -o no.ply
python3 -c '
data = bytearray(open("b.gzip", "rb").read())
data[-6] ^= 1
open("crc.gz", "wb").write(data)'
mc extract crc.gz $RAW --iso 20 -o no.ply
mc extract crc.gz --dims 16,16 --type u8 --iso 20 -o no.ply
(cat b.gzip; echo more) > more.gz
mc extract more.gz $RAW --iso 20 -o no.ply
(cat b.gzip; head -c 512 /dev/zero) > padded.gz
mc extract padded.gz $RAW --iso 20 -q -o - --to ply | cmp - m.ply
head -c 4000 ball.raw > short.raw && pack gzip short.raw short.gz
mc extract short.gz $RAW --iso 20 -o no.ply
mc extract b.gzip --dims 16,16,15 --type u8 --iso 20 -o no.ply
: > empty && pack gzip empty empty.gz
mc extract empty.gz $RAW --iso 20 -o no.ply
mc extract empty.gz --dims 16,16 --type u8 -o no.ply
python3 -c '
import gzip
open("bomb.gz", "wb").write(gzip.compress(bytes(1 << 24), mtime=0))'
mc extract bomb.gz $RAW --iso 20 -o no.ply
mc extract bomb.gz $RAW -o no.ply
ls | grep no || echo "nothing left"
