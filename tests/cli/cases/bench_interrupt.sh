# A benchmark that is interrupted dies by the signal within a fifth of a second.
. "$CASES/case.sh"
python3 - <<'PY'
import os, signal, subprocess, time
run = subprocess.Popen([os.environ["MC"], "bench", "--seconds", "3600", "--threads", "1"],
                       stdout=subprocess.PIPE)
run.stdout.readline()  # it is under way
began = time.monotonic()
run.send_signal(signal.SIGINT)
status = run.wait()
print(signal.Signals(-status).name, time.monotonic() - began < 0.2)
PY
