# A budget that cannot be kept is refused before the work.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -o m.ply --memory 1KiB
mc sample ball.raw $RAW -o m.nrrd --memory 64
ls
