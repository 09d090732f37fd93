# No surface: status 5, the data's range in the message, and no file.
. "$CASES/case.sh"
ball ball.raw
ball flat.raw --value 7
ball nan.raw --type f32 --nan
mc extract ball.raw $RAW --iso 250 -o m.ply
mc extract ball.raw $RAW --iso 20,250 -o m.obj
mc extract flat.raw $RAW -o m.ply
mc extract nan.raw --dims 16,16,16 --type f32 -o m.ply
mc extract nan.raw --dims 16,16,16 --type f32 --iso 1 -o m.ply
ls
mc extract ball.raw $RAW --iso 250 -o - --to ply
mc extract ball.raw $RAW --iso 250 -o none.ply --allow-empty
mc check none.ply | head -3
