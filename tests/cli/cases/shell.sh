# As shells put it together: xargs, loops, redirections and pipes.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -q -o m.ply

echo "xargs"
seq 1 50 | xargs -P2 -I{} "$MC" extract ball.raw $RAW --iso {} -q -o x{}.ply
ls x*.ply | wc -l
mc extract ball.raw $RAW --iso 20 -q -o - --to ply | cmp - x20.ply

echo "a loop's stdin is the loop's"
printf '%s\n' a b c | while read -r name; do
  "$MC" extract ball.raw $RAW --iso 20 -q -o $name.ply
  "$MC" info ball.raw $RAW -q > /dev/null
  "$MC" check $name.ply | head -1
done

echo "redirections"
mc extract - --from raw $RAW --iso 20 -q -o - --to glb < ball.raw > m.glb
mc check - < m.glb | head -1
mc sample "$DATA/specs/sphere.json" -q -o - --to nrrd | mc extract - -q -o s.ply
mc extract - -q -o - --to ply < "$DATA/specs/sphere.json" | cmp - s.ply
cat "$DATA/specs/sphere.json" | mc extract - -q -o - --to ply | cmp - s.ply
cat s.ply | mc check - | head -1
mc extract - -q -o - --to ply < "$DATA/specs/sphere.json" | mc check - | head -1
mc sample ball.raw $RAW -q -o v.vdb
mc info - < v.vdb | head -2
cat v.vdb | mc info - | head -2
mc extract - --iso 20 -q -o - --to ply < v.vdb | mc check - | head -1
mc sample - -q -o - --to nrrd < v.vdb | mc info - | head -1
cat ball.raw | mc extract - $RAW --iso 20 -q -o - --to stl | gzip | mc check - | head -1
