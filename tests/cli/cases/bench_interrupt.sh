# A benchmark that is interrupted dies by the signal within a fifth of a second. Of three times the
# least counts, since the machine may be busy.
. "$CASES/case.sh"
python3 - <<'PY'
import os, signal, subprocess, time

def seconds_to_end():
    run = subprocess.Popen([os.environ["MC"], "bench", "--seconds", "3600", "--threads", "1"],
                           stdout=subprocess.PIPE)
    run.stdout.readline()  # it is under way
    began = time.monotonic()
    run.send_signal(signal.SIGINT)
    assert run.wait() == -signal.SIGINT, run.returncode
    return time.monotonic() - began

print(any(seconds_to_end() < 0.2 for _ in range(3)))
PY
