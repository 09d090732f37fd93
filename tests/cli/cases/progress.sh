# Progress lines for programs; none where stderr is no terminal.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -q -o m.ply --progress json 2>&1 | python3 -c '
import json, sys
lines = [json.loads(line) for line in sys.stdin]
assert lines and all(list(l) == ["stage", "done", "total", "unit", "seconds"] for l in lines)
print(lines[-1]["stage"], lines[-1]["done"] == lines[-1]["total"])'
mc extract ball.raw $RAW --iso 20 -o n.ply
