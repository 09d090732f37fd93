# Pipes, devices and FIFOs; the same bytes everywhere.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -q -o m.ply
"$MC" extract - $RAW --iso 20 -q -o - --to ply < ball.raw | cmp - m.ply
cat ball.raw | "$MC" extract - $RAW --iso 20 -q -o - --to ply | cmp - m.ply
mc extract ball.raw $RAW --iso 20 -q -o /dev/null --to ply
mc extract ball.raw $RAW --iso 20 -q -o m.glb
"$MC" extract ball.raw $RAW --iso 20 -q -o - --to glb | cat | cmp - m.glb
mkfifo pipe.ply
cat pipe.ply > through.ply &
mc extract ball.raw $RAW --iso 20 -q -o pipe.ply
wait
cmp through.ply m.ply
ln -s target.ply link.ply
mc extract ball.raw $RAW --iso 20 -q -o link.ply
test -L link.ply && cmp target.ply m.ply
for threads in 1 2 7; do
  mc extract ball.raw $RAW --iso 20 -q -o - --to ply --threads $threads | cmp - m.ply
done
MC_SIMD=scalar mc extract ball.raw $RAW --iso 20 -q -o - --to ply | cmp - m.ply
LC_ALL=de_DE.UTF-8 mc extract ball.raw $RAW --iso 2.5 -o comma.ply
ls
