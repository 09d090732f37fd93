#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What shells complete, asked of the shells themselves and held against the option tables.

    completion.py --mc MC SHELL

Every option of every command is offered, values of options that have a list are, and the lists are
those that the program names when it is given something else. A shell that is not installed skips its
test, aloud.
"""

import argparse
import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
COMMANDS = ["extract", "edit", "sample", "info", "check", "bench", "completion", "help"]
# Values that a command refuses by name, without any file.
LISTED = [
    ("extract", "--inside"), ("extract", "--border"), ("extract", "--interpolation"),
    ("extract", "--normals"), ("extract", "--frame"), ("extract", "--up"), ("extract", "--units"),
    ("extract", "--precision"), ("extract", "--from"), ("extract", "--type"),
    ("extract", "--endian"), ("extract", "--progress"), ("extract", "--topology"),
    ("sample", "--bits"), ("info", "--progress"), ("info", "--type"),
    ("bench", "--type"), ("bench", "--normals"),
]


def options(mc, command):
    listed = subprocess.run([mc, "help", "--options", command], capture_output=True, text=True,
                            check=True).stdout
    return set(listed.split())


def named_values(mc, command, option):
    """What the program says it expected instead of a value that it does not know."""
    needs = {"--precision": ["--to", "ply"], "--bits": ["--to", "png", "--slice", "k=0"],
             "--type": ["--dims", "2,2,2"], "--endian": ["--dims", "2,2,2", "--type", "u8"]}
    words = [mc, command, option, "no-such"]
    words += [] if command == "bench" else needs.get(option, [])
    if command in ("extract", "sample"):
        words += ["in", "-o", "out.ply" if command == "extract"
                  else "out.png" if option == "--bits" else "out.nrrd"]
    elif command == "info":
        words.append("in")
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    message = done.stderr.strip().split("expected ", 1)[-1].split(";")[0]
    return set(re.split(r", | or ", message))


class Bash:
    def __init__(self, script, folder):
        self.script, self.folder = script, folder

    def offers(self, *words):
        """What is offered for the last word."""
        quoted = " ".join(f"'{word}'" for word in words)
        lines = (f". {self.script}; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; "
                 '_mc; printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "--norc", "-c", lines], cwd=self.folder, text=True,
                              capture_output=True, check=True)
        assert not done.stderr, done.stderr
        return set(done.stdout.split())

    def offers_files(self, *words):
        """Readline does where the function offers nothing and -o default is set."""
        lines = f". {self.script}; complete -p mc"
        done = subprocess.run(["bash", "--norc", "-c", lines], text=True, capture_output=True,
                              check=True)
        return "-o default" in done.stdout and not self.offers(*words)


class Fish:
    def __init__(self, script, folder):
        self.script, self.folder = script, folder

    def offers(self, *words):
        lines = f"source {self.script}; complete -C '{' '.join(words)}'"
        env = dict(os.environ, HOME=self.folder, XDG_CONFIG_HOME=self.folder)
        done = subprocess.run(["fish", "--no-config", "-c", lines], cwd=self.folder, text=True,
                              capture_output=True, check=True, env=env)
        return {line.split("\t")[0] for line in done.stdout.splitlines()}

    def offers_files(self, *words):
        return "some-file" in self.offers(*words)


class Zsh:
    """A shell on a terminal of its own, whose compadd writes down what it is given."""

    START = r"""
PROMPT= RPROMPT= ; unsetopt zle_bracketed_paste; autoload -Uz compinit; compinit -D -u
source %s
compadd() {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return $?; fi
  typeset -a hits; builtin compadd -A hits "$@"
  (( $#hits )) && print -rl -- $hits >> offers
  builtin compadd "$@"
}
zstyle ':completion:*' completer _complete
zstyle ':completion:*' menu no
setopt no_beep no_list_beep
set_done() { print done >> ended; zle -I; BUFFER= }
zle -N set_done; bindkey '^X' set_done
print ready > ended
"""

    def __init__(self, script, folder):
        self.folder = pathlib.Path(folder)
        pid, self.terminal = pty.fork()
        if pid == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", HOME=folder, ZDOTDIR=folder)
            os.execvp("zsh", ["zsh", "-f", "-i"])
        start = self.folder / "start.zsh"
        start.write_text(self.START % script)
        self.send(f"source {start}\n")

    def send(self, text):
        """Types it, and waits until it is through."""
        ended = self.folder / "ended"
        ended.unlink(missing_ok=True)
        os.write(self.terminal, text.encode())
        for _ in range(1000):
            if ended.exists() and ended.read_text():
                return
            os.set_blocking(self.terminal, False)
            try:
                os.read(self.terminal, 65536)
            except BlockingIOError:
                pass
            time.sleep(0.01)
        raise TimeoutError(text)

    def offers(self, *words):
        kept = self.folder / "offers"
        kept.unlink(missing_ok=True)
        # Tab completes; ^X, typed ahead, is taken when that has ended, and empties the line.
        self.send(" ".join(words) + "\t\x18")
        return set(kept.read_text().splitlines()) if kept.exists() else set()

    def offers_files(self, *words):
        return "some-file" in self.offers(*words)


def faults_of(mc, shell):
    """What is not offered, or offered and wrong."""
    for command in COMMANDS:
        wanted = options(mc, command)
        got = {word.rstrip("=+") for word in
               shell.offers("mc", command, "--") | shell.offers("mc", command, "-")}
        for name in sorted(wanted - got):
            yield f"mc {command}: {name} is not offered: {sorted(got)}"
    got = shell.offers("mc", "")
    for name in set(COMMANDS) - got:
        yield f"mc: {name} is not offered: {sorted(got)}"
    for command, option in LISTED:
        wanted, got = named_values(mc, command, option), shell.offers("mc", command, option, "")
        if wanted != got:
            yield f"mc {command} {option}: offered {sorted(got)}, but {sorted(wanted)} is meant"
    for kind in sorted(shell.offers("mc", "extract", "--to", "")):
        done = subprocess.run([mc, "extract", "no-such.vdb", "-o", "out", "--to", kind],
                              capture_output=True, text=True, check=False)
        if done.returncode != 3:  # it got as far as the input
            yield f"mc extract --to: {kind} is offered, but {done.stderr}"
    if shell.offers("mc", "completion", "") != {"bash", "zsh", "fish"}:
        yield "mc completion: the shells are not offered"
    for words in (["mc", "extract", ""], ["mc", "extract", "-o", ""], ["mc", "check", ""]):
        if not shell.offers_files(*words):
            yield f"{' '.join(words)}: no files are offered"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True, type=pathlib.Path)
    parser.add_argument("shell", choices=["bash", "zsh", "fish"])
    args = parser.parse_args()
    if not shutil.which(args.shell):
        print(f"SKIPPED: {args.shell} is not installed")
        return SKIPPED
    mc = args.mc.resolve()
    with tempfile.TemporaryDirectory(prefix="mc-completion-") as folder:
        script = pathlib.Path(folder, "script")
        script.write_text(subprocess.run([mc, "completion", args.shell], capture_output=True,
                                         text=True, check=True).stdout)
        files = pathlib.Path(folder, "files")
        files.mkdir()
        (files / "some-file").touch()
        shell = {"bash": Bash, "zsh": Zsh, "fish": Fish}[args.shell](script, str(files))
        faults = list(faults_of(mc, shell))
    print("\n".join(faults) or f"{args.shell} completes every option of {len(COMMANDS)} commands")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
