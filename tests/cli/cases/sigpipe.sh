# A reader that goes away is no error: no message, dead by SIGPIPE.
. "$CASES/case.sh"
ball ball.raw --n 64
cat > away.py <<'PY'
import os, subprocess
run = subprocess.Popen([os.environ["MC"], "extract", "ball.raw", "--dims", "64,64,64", "--type",
                        "u8", "--iso", "20", "-q", "-o", "-", "--to", "obj"],
                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
run.stdout.read(10)
run.stdout.close()
print(run.wait(), run.stderr.read())
PY
python3 away.py
ls
