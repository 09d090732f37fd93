#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Progress on a terminal: terminal.py --mc MC.

stderr is a pseudo-terminal, stdin a pipe that is fed slowly, so that there is something to wait for.
"""

import argparse
import fcntl
import os
import pathlib
import pty
import re
import struct
import subprocess
import tempfile
import termios
import threading
import time
import unittest

MC = None  # set by main
SIDE, PLANES, SECONDS = 512, 64, 1.5


def feed(pipe, planes):
    """A slope along k, plane by plane, over SECONDS."""
    for k in range(planes):
        pipe.write(bytes([k]) * SIDE * SIDE)
        pipe.flush()
        time.sleep(SECONDS / planes)
    pipe.close()


def run(*options, columns=80, output="m.ply", **environment):
    """What a run writes to its terminal, as [(seconds, text)]."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    env = {k: v for k, v in os.environ.items() if k not in ("TERM", "NO_COLOR")}
    env.update({"TERM": "xterm", **environment})
    with tempfile.TemporaryDirectory() as folder:
        words = [MC, "extract", "-", "--dims", f"{SIDE},{SIDE},{PLANES}", "--type", "u8", "--iso", "20.5",
                 "--threads", "1", "-o", output if output == "-" else str(pathlib.Path(folder, output)), *options]
        done = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=theirs, env=env)
        os.close(theirs)
        feeder = threading.Thread(target=feed, args=(done.stdin, PLANES))
        feeder.start()
        seen = []
        while True:
            try:
                part = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            seen.append((time.monotonic(), part.decode()))
        feeder.join()
        status = done.wait()
    os.close(ours)
    assert status == 0, (status, seen)
    return seen


def text_of(seen):
    return "".join(part for _, part in seen)


class Terminal(unittest.TestCase):
    def test_a_bar_with_part_rate_and_time_left(self):
        seen = text_of(run("-q", "--progress", "always"))
        bars = [line for line in re.split("\r", seen) if "[" in line]
        self.assertGreater(len(bars), 3, seen)
        for bar in bars:
            self.assertRegex(
                bar, r"^extract \[#*\.*\] +\d+ %  [\d.]+ [kMG]?samples/s(  ETA \d+:\d\d)? *$")
        self.assertRegex(bars[1], "ETA")
        parts = [int(re.search(r"(\d+) %", bar).group(1)) for bar in bars]
        self.assertEqual(sorted(parts), parts)

    def test_it_is_drawn_ten_times_a_second_at_most_and_taken_away(self):
        seen = run("--progress", "auto")
        times = [at for at, part in seen if "%" in part]
        self.assertGreater(len(times), 3)
        # Two that were drawn just in time may arrive a little closer.
        self.assertLessEqual(len(times), 10 * (times[-1] - times[0]) * 1.1 + 2)
        last = re.split("\r\n|\n", text_of(seen))[-1]
        self.assertEqual("", re.split("\r", last)[-1].strip(), repr(last))

    def test_no_escapes_so_no_colour_changes_nothing(self):
        self.assertNotIn("\x1b", text_of(run()))
        self.assertIn("%", text_of(run(NO_COLOR="1")))

    def test_none_where_lines_cannot_be_drawn_over_or_nobody_wants_it(self):
        for options, environment in (((), {"TERM": "dumb"}), (("-q",), {}),
                                     (("--progress", "never"), {})):
            with self.subTest(options=options, environment=environment):
                self.assertNotIn("%", text_of(run(*options, **environment)))

    def test_the_last_line_says_what_was_written(self):
        last = re.split("\r\n|\n", text_of(run("--progress", "never")).rstrip())[-1]
        self.assertRegex(last, r"^mc: .*m\.ply: \d+ vertices, \d+ triangles, [\d.]+ [KM]iB, \d+\.\d\d s$")
        self.assertNotIn("vertices", text_of(run("-q")))
        self.assertNotIn("vertices", text_of(run("--to", "ply", output="-")))

    def test_it_fits_the_terminal(self):
        for bar in re.split("\r", text_of(run("-q", "--progress", "always", columns=40))):
            self.assertLess(len(bar.rstrip("\n")), 40)


def main():
    global MC
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mc", required=True, type=pathlib.Path)
    MC = str(parser.parse_args().mc.resolve())
    unittest.main(argv=["terminal"])


if __name__ == "__main__":
    main()
