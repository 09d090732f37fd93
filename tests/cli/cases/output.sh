# Outputs that cannot be written: status 4, found before the work, nothing left behind.
. "$CASES/case.sh"
ball ball.raw
echo old > m.ply
mc extract ball.raw $RAW -o m.ply
cat m.ply
mc extract ball.raw $RAW -o nowhere/m.ply
mc extract ball.raw $RAW --iso 20 -o n.ply --report nowhere/r.json
mc extract ball.raw $RAW --iso 20 -o /dev/full --to ply
mc extract ball.raw $RAW --out-dir nowhere
mc sample ball.raw $RAW -o nowhere/v.nrrd
"$MC" --version > /dev/full || echo "status $?"
ls
mc extract ball.raw $RAW --iso 20 -o m.ply --force
head -c 3 m.ply
