# Inputs that are not there, or not what they claim to be: status 3 and no output.
. "$CASES/case.sh"
ball ball.raw
: > empty.raw
head -c 4000 ball.raw > short.raw
mkdir folder
echo "some text" > folder/notes.txt
mc extract nope.raw $RAW -o m.ply
mc extract nope.vdb -o m.ply
mc extract empty.raw $RAW -o m.ply
mc extract short.raw $RAW -o m.ply
mc extract ball.raw --dims 16,16,16 --type u16 -o m.ply
mc extract folder -o m.ply
mc extract folder/notes.txt -o m.ply
mc check nope.ply
mc check folder/notes.txt
mc info nope.raw $RAW
ls
