# Interrupted: dead by the signal within a fifth of a second, and nothing left behind.
. "$CASES/case.sh"
cat > slow.json <<JSON
{ "format": "mc-volume", "version": 1, "convention": "density",
  "grid": { "samples": [400, 400, 400], "spacing": 1 }, "iso": 0,
  "field": { "type": "fbm", "source": { "type": "perlin", "frequency": 0.01 }, "octaves": 8 } }
JSON
cat > interrupt.py <<'PY'
import os, pathlib, signal, subprocess, sys, time

def interrupted(number, words, ready, **more):
    """Sends the signal once ready() holds; checks how the program ends."""
    run = subprocess.Popen([os.environ["MC"], "extract", *words], stderr=subprocess.PIPE, **more)
    until = time.monotonic() + 60
    while not ready():
        assert run.poll() is None, run.stderr.read()
        assert time.monotonic() < until, "nothing was begun"
        time.sleep(0.01)
    began = time.monotonic()
    run.send_signal(number)
    status = run.wait()
    took = time.monotonic() - began
    assert status == -number, status
    assert took < 0.2, took
    left = sorted(p.name for p in pathlib.Path(".").iterdir())
    assert left == ["interrupt.py", "slow.json"], left
    print(signal.Signals(number).name, "ends it")

def partial(name):
    return lambda: any(p.name.startswith(name + ".partial-") for p in pathlib.Path(".").iterdir())

for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    interrupted(number, ["slow.json", "-q", "-o", "m.ply"], partial("m.ply"))
raw = ["--dims", "16,16,16", "--type", "u8", "-o", "m.ply", "--report", "r.json"]
interrupted(signal.SIGINT, ["-", *raw], partial("r.json"), stdin=subprocess.PIPE)
PY
python3 interrupt.py
