# A dry run says what would be done, and does nothing.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --dry-run -o m.stl -q | grep -v '^memory'
mc extract ball.raw $RAW --dry-run -o m.glb --iso 20,30 --inside below --border closed -q | grep -v '^memory'
mc extract ball.raw $RAW --dry-run -o m.stl -q --report - | python3 -c 'import json, sys; print(json.load(sys.stdin)["iso"])'
mc extract nope.raw $RAW --dry-run -o m.stl
ls
