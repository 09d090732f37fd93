# The report: its keys, on success and on failure.
. "$CASES/case.sh"
ball ball.raw
mc extract ball.raw $RAW --iso 20 -o m.ply -q --report r.json
mc extract ball.raw $RAW --iso 250 -o n.ply -q --report empty.json
mc extract nope.raw $RAW -o n.ply --report missing.json
mc extract ball.raw $RAW --iso x -o n.ply --report usage.json
mc extract ball.raw $RAW --iso 20 -q -o n.stl --origin 1e6,0,0 --report - > warned.json
python3 - <<'PY'
import json
KEYS = ("mc status error input output iso inside dims affine vertices triangles boundary_edges "
        "nonmanifold_edges euler components area volume bounds stages peak_bytes warnings").split()
for name in ("r", "empty", "missing", "usage"):
    text = open(name + ".json").read()
    report = json.loads(text)
    assert list(report) == KEYS, list(report)
    assert text.count("\n") == 1 and text.endswith("\n")
    print(name, report["status"], report["error"], report["vertices"], report["iso"])
r = json.load(open("r.json"))
assert r["input"]["place"] == "ball.raw" and r["input"]["type"] == "u8"
assert r["dims"] == [16, 16, 16] and r["affine"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
assert r["euler"] == 2 and r["boundary_edges"] == 0 and r["components"] is None
assert r["area"] > 0 and r["volume"] > 0 and len(r["bounds"]) == 2
assert [s["name"] for s in r["stages"]] == ["open", "extract"] and r["peak_bytes"] > 0
line = [l for l in open("warned.json") if l.startswith("{")][0]
print(json.loads(line)["warnings"])
PY
ls
