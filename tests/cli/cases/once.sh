# Dense samples from a pipe are read once, in order, where one pass is enough; else they are copied.
. "$CASES/case.sh"
ball ball.raw
ball f.raw --type f32
# Where no copy can be made: what ends well here made none.
run() {
  TMPDIR=$PWD/nowhere "$MC" "$@" || echo "status $?"
}
echo "one pass"
mc extract ball.raw $RAW --iso 20 -q -o m.ply
for threads in 1 2 7; do
  cat ball.raw | run extract - $RAW --iso 20 -q --threads $threads -o p.ply && cmp p.ply m.ply && rm p.ply
done
mkfifo fifo
cat ball.raw > fifo &
run extract fifo $RAW --iso 20 -q -o p.ply && cmp p.ply m.ply && rm p.ply
mc sample f.raw --dims 16,16,16 --type f32 -q -o f.nrrd
mc extract f.nrrd --iso 20 -q -o f.ply
cat f.nrrd | run extract - --iso 20 -q -o p.ply && cmp p.ply f.ply && rm p.ply
cat f.nrrd | run sample - -q -o p.nrrd && cmp p.nrrd f.nrrd
(head -c 7 f.raw; cat f.raw) | run extract - --dims 16,16,16 --type f32 --skip 7 --iso 20 -q -o p.ply
cmp p.ply f.ply

echo "copied"
cat ball.raw | mc extract - $RAW -v -o p.ply --force 2>&1 | grep -e copied -e otsu
cat ball.raw | mc extract - $RAW --iso 20,30 -v -o p.obj 2>&1 | grep copied
cat ball.raw | mc extract - $RAW --iso 20 --region 0,0,0:7,7,7 -v -o p.stl 2>&1 | grep copied
cat ball.raw | mc extract - --dims 16,16 --type u8 --iso 20 -v -o q.stl 2>&1 | grep copied
cat f.nrrd | mc info - -q | head -1
cat f.nrrd > fifo &
mc info fifo -q | grep -e fifo -e range
cat ball.raw | run extract - $RAW -q -o no.ply 2>&1 | sed 's/mc-spool-....../mc-spool-XXXXXX/'

echo "the data's range"
cat ball.raw | mc extract - $RAW --iso 250 -q -o no.ply
cat f.raw | mc extract - --dims 16,16,16 --type f32 --iso 250 -q -o no.ply
mc extract f.raw --dims 16,16,16 --type f32 --iso 250 -q -o no.ply
ball nan.raw --type f32 --nan
cat nan.raw | mc extract - --dims 16,16,16 --type f32 --iso 20 -q -o no.ply

echo "of the wrong length"
head -c 4000 ball.raw | mc extract - $RAW --iso 20 -q -o no.ply
(cat ball.raw; echo) | mc extract - $RAW --iso 20 -q -o no.ply
head -c 4000 ball.raw | mc extract - $RAW --iso 20 -q -o - --to ply | wc -c
head -c 10000 f.nrrd | mc extract - --iso 20 -q -o no.ply
(cat f.nrrd; echo) | mc extract - --iso 20 -q -o p.ply --force
mc extract - $RAW --iso 20 -q -o no.ply < /dev/null
head -c 3 ball.raw | mc extract - $RAW --skip 5 --iso 20 -q -o no.ply

echo "the rest of a file"
(printf before; cat ball.raw) > after.raw
(head -c 6 > /dev/null; "$MC" extract - $RAW --iso 20 -q -o rest.ply) < after.raw && cmp rest.ply m.ply
ls | grep no || echo "nothing left"
