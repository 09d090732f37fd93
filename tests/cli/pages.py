#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds the manual pages against the program.

Every option in a command's table has its entry in the page and the other way round, --from and --to
list the same formats, and every line of the EXAMPLES section runs, in order, in a folder that holds
ball.raw.
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
COMMANDS = {"mc": "", "mc-extract": "extract", "mc-edit": "edit",
            "mc-sample": "sample", "mc-info": "info",
            "mc-check": "check", "mc-bench": "bench", "mc-completion": "completion"}


def options_in_page(text):
    section = re.search(r"^# OPTIONS\n(.*?)^# ", text, re.MULTILINE | re.DOTALL).group(1)
    heads = [line for line in section.splitlines() if line.startswith("**-")]
    return {name for head in heads for name in re.findall(r"\*\*(--?[a-z0-9-]+)\*\*", head)}


def options_in_program(mc, command):
    words = [mc, "help", "--options"] + ([command] if command else [])
    listed = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    return set(listed.split())


def formats_in_page(text, option):
    entry = re.search(rf"^\*\*{option}\*\* \*TYPE\*\n(.*?)\n\n", text, re.MULTILINE | re.DOTALL)
    return set(re.findall(r"`(\w+)`", entry.group(1))) if entry else set()


def formats_in_program(mc):
    """{(command, option): formats}, as the shell completes them."""
    script = subprocess.run([mc, "completion", "bash"], capture_output=True, text=True,
                            check=True).stdout
    values = re.findall(r"^ *(\w+):(--from|--to)\) words='(.*)' ;;$", script, re.MULTILINE)
    return {(command, option): set(words.split()) for command, option, words in values}


def examples(text):
    section = re.search(r"^# EXAMPLES\n(.*?)^# ", text, re.MULTILINE | re.DOTALL).group(1)
    return [line[4:] for line in section.splitlines() if line.startswith("    ")]


def failing_example(mc, lines):
    """The first example that fails, with its stderr, or None."""
    with tempfile.TemporaryDirectory(prefix="mc-pages-") as folder:
        subprocess.run([sys.executable, str(HERE / "ball.py"), "ball.raw"], cwd=folder, check=True)
        pathlib.Path(folder, "bin").mkdir()
        pathlib.Path(folder, "bin", "mc").symlink_to(mc)
        env = dict(os.environ, PATH=f"{folder}/bin:{os.environ['PATH']}")
        for line in lines:
            done = subprocess.run(["sh", "-c", line], cwd=folder, env=env, capture_output=True,
                                  text=True, check=False)
            if done.returncode != 0:
                return f"{line}\n{done.stderr}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True, type=pathlib.Path)
    parser.add_argument("--man", required=True, type=pathlib.Path)
    args = parser.parse_args()
    mc = args.mc.resolve()
    faults = []
    formats = formats_in_program(mc)
    for page, command in COMMANDS.items():
        text = (args.man / f"{page}.1.md").read_text(encoding="utf-8")
        in_page, in_program = options_in_page(text), options_in_program(mc, command)
        faults += [f"{page}: {name} is not in the page" for name in sorted(in_program - in_page)]
        faults += [f"{page}: {name} is not an option" for name in sorted(in_page - in_program)]
        for option in ("--from", "--to"):
            listed = formats.get((command, option))
            if listed and formats_in_page(text, option) != listed:
                faults.append(f"{page}: {option} does not list {' '.join(sorted(listed))}")
        failed = failing_example(mc, examples(text))
        if failed:
            faults.append(f"{page}: example fails: {failed}")
    print("\n".join(faults) or f"{len(COMMANDS)} pages agree with the program")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
