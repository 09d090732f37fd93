#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs command-line cases: NAME.sh against NAME.stdout, NAME.stderr and NAME.exit beside it.

A case runs under `sh -eu` in a fresh folder, with $MC the program, $DATA the shipped inputs and
$CASES this folder. A missing .stdout or .stderr means nothing is printed, a missing .exit status 0.
In a .stderr or .stdout file a line `...` stands for any lines. --accept rewrites what differs.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
DATA = HERE.parent.parent / "data"


def matches(expected, actual):
    """Whether the text is as expected, `...` lines standing for anything."""
    parts = re.split(r"^\.\.\.\n", expected, flags=re.MULTILINE)
    pattern = "(?:.*\n)*?".join(re.escape(part) for part in parts)
    return re.fullmatch(pattern, actual) is not None


def read(path):
    return path.read_text(encoding="utf-8") if path.exists() else ""


def run(script, mc):
    """Exit status, stdout and stderr of one case."""
    with tempfile.TemporaryDirectory(prefix="mc-cli-") as folder:
        env = {k: v for k, v in os.environ.items() if not k.startswith(("MC_SIMD", "LC_", "LANG"))}
        env.update(MC=str(mc), DATA=str(DATA), CASES=str(HERE), TERM="dumb")
        done = subprocess.run(["sh", "-eu", str(script)], cwd=folder, env=env,
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)
    def text(data):
        return data.decode("utf-8", "backslashreplace").replace(folder, "FOLDER")
    return done.returncode, text(done.stdout), text(done.stderr)


def accept(path, text):
    if text:
        path.write_text(text, encoding="utf-8")
    else:
        path.unlink(missing_ok=True)


def check(script, mc, accepting):
    """Whether the case passes; shows how it does not."""
    status, stdout, stderr = run(script, mc)
    good = True
    for suffix, actual in ((".stdout", stdout), (".stderr", stderr)):
        path = script.with_suffix(suffix)
        if matches(read(path), actual):
            continue
        if accepting:
            accept(path, actual)
            continue
        good = False
        print(f"{script.name}: {suffix[1:]} differs\n--- expected\n{read(path)}--- found\n{actual}---")
    wanted = int(read(script.with_suffix(".exit")).strip() or 0)
    if status != wanted:
        if accepting:
            accept(script.with_suffix(".exit"), f"{status}\n" if status else "")
        else:
            good = False
            print(f"{script.name}: status {status}, expected {wanted}\n{stderr}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True, type=pathlib.Path)
    parser.add_argument("--accept", action="store_true")
    parser.add_argument("cases", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    cases = args.cases or sorted((HERE / "cases").glob("*.sh"))
    results = [check(case.resolve(), args.mc.resolve(), args.accept) for case in cases]
    print(f"{sum(results)} of {len(results)} cases pass")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
