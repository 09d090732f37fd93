# Usage faults that only the volume shows, still before any work.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW -o m.ply --iso 20 --region 0,0,0:15,15,16
mc extract ball.raw $RAW -o m.ply --iso 20 --region -1,0,0:15,15,15
mc sample ball.raw $RAW -o m.nrrd --region 0,0,14:3,3,17
MC_SIMD=mmx mc info ball.raw $RAW
ls
