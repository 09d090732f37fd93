# An open border is said; a closed one leaves no boundary edge.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 --region 0,0,0:7,15,15 -o half.ply
mc extract ball.raw $RAW --iso 20 --region 0,0,0:7,15,15 --border open -o open.ply
cmp half.ply open.ply
mc extract ball.raw $RAW --iso 20 --region 0,0,0:7,15,15 --border closed -o closed.ply
mc check --closed closed.ply | head -1
mc extract ball.raw $RAW --iso 20 --invert --border closed -o shell.ply
mc check --closed shell.ply | grep -E 'good|components|euler'
