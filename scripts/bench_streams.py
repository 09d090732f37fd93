#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Pipes and batches: what passing by costs beside `cat`, how much memory it holds, files a second.

    bench_streams.py [--mc PROGRAM] [--rounds R] [--dir DIR] [--gib G] [--files N]

1. `cat volume | mc extract - ... -o /dev/null` against `cat volume | cat > /dev/null` and against the
   mapped file, f32 and u8 balls of 512^3 in DIR (default /dev/shm): medians of R rounds in turns.
2. G GiB of f32 samples that a spec makes on the fly, through stdin, to a PLY on stdout into a pipe,
   with --memory 256MiB: the most resident memory of the process.
3. N balls of 32^3 u8, as one batch and as a process each: milliseconds a file.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time


def timed(work):
    began = time.perf_counter()
    work()
    return 1000 * (time.perf_counter() - began)


def spec(path, samples, radius):
    path.write_text(json.dumps({
        "format": "mc-volume", "version": 1, "convention": "density",
        "grid": {"samples": samples}, "field": {"type": "sphere", "radius": radius,
                                                "center": [n / 2 for n in samples]}}))
    return path


def through_cat(source, command):
    cat = subprocess.Popen(["cat", source], stdout=subprocess.PIPE)
    subprocess.run(command, stdin=cat.stdout, stdout=subprocess.DEVNULL, check=True)
    cat.stdout.close()
    cat.wait()


def beside_cat(mc, folder, rounds):
    print("| 512^3 | cat to cat ms | mapped file ms | pipe ms | pipe / cat |\n|---|--:|--:|--:|--:|")
    size = 512
    f32 = folder / "f32.raw"
    subprocess.run([mc, "sample", spec(folder / "s.json", [size] * 3, 200), "-q", "-o", f32],
                   check=True)
    u8 = folder / "u8.raw"
    with open(f32, "rb") as wide, open(u8, "wb") as narrow:
        while block := wide.read(1 << 24):  # the byte of sign and exponent: two values
            narrow.write(block[3::4])
    for kind, path, iso in (("f32", f32, "0"), ("u8", u8, "100.5")):
        options = ["--dims", f"{size},{size},{size}", "--type", kind, "--iso", iso, "-q", "--to", "ply",
                   "-o", "/dev/null"]
        cats, files, pipes = [], [], []
        for _ in range(rounds):
            cats.append(timed(lambda: through_cat(path, ["cat"])))
            files.append(timed(lambda: subprocess.run([mc, "extract", path, *options], check=True)))
            pipes.append(timed(lambda: through_cat(path, [mc, "extract", "-", *options])))
        cat, file, pipe = (statistics.median(times) for times in (cats, files, pipes))
        print(f"| {kind} | {cat:.0f} | {file:.0f} | {pipe:.0f} | {pipe / cat:.2f} |", flush=True)
        path.unlink()


def drain(pipe, count):
    while block := pipe.read(1 << 20):
        count.append(len(block))


def memory(mc, folder, gib):
    planes = int(gib * 256)
    source = spec(folder / "big.json", [1024, 1024, planes], 0.4 * min(1024, planes))
    maker = subprocess.Popen([mc, "sample", source, "-q", "-o", "-", "--to", "raw"],
                             stdout=subprocess.PIPE)
    run = subprocess.Popen([mc, "extract", "-", "--dims", f"1024,1024,{planes}", "--type", "f32",
                            "--iso", "0", "-q", "--memory", "256MiB", "-o", "-", "--to", "ply"],
                           stdin=maker.stdout, stdout=subprocess.PIPE)
    maker.stdout.close()
    count = []
    reader = threading.Thread(target=drain, args=(run.stdout, count))
    reader.start()
    _, status, usage = os.wait4(run.pid, 0)
    reader.join()
    maker.wait()
    print(f"{planes * 4 / 1024:g} GiB of samples to {sum(count) / 1e6:.0f} MB of PLY: "
          f"status {status}, {usage.ru_maxrss / 1024:.0f} MiB resident at most", flush=True)


def batches(mc, folder, n_files):
    ball = folder / "ball.raw"
    subprocess.run([mc, "sample", spec(folder / "b.json", [32] * 3, 12), "-q", "-o", ball], check=True)
    names = [folder / f"v{n}.raw" for n in range(n_files)]
    for name in names:
        os.link(ball, name)
    options = ["--dims", "32,32,32", "--type", "f32", "--iso", "0", "-q", "--to", "ply"]
    few = names[: max(1, n_files // 10)]
    singly = timed(lambda: [subprocess.run([mc, "extract", name, *options, "-o",
                                            name.with_suffix(".ply")], check=True) for name in few])
    print(f"a process each: {singly / len(few):.2f} ms a file")
    for threads in sorted({1, os.cpu_count()}):
        out = folder / f"out{threads}"
        out.mkdir()
        together = timed(lambda: subprocess.run(
            [mc, "extract", "--files-from", "-", "--out-dir", out, "--threads", str(threads), *options],
            input="\n".join(map(str, names)).encode(), check=True))
        print(f"one batch, {threads} threads: {together / n_files:.2f} ms a file", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    here = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--mc", default=str(here / "build/release/mc"))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--dir", default="/dev/shm")
    parser.add_argument("--gib", type=float, default=4)
    parser.add_argument("--files", type=int, default=2000)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=args.dir, prefix="mc-bench-") as name:
        folder = pathlib.Path(name)
        beside_cat(args.mc, folder, args.rounds)
        memory(args.mc, folder, args.gib)
        batches(args.mc, folder, args.files)
    return 0


if __name__ == "__main__":
    sys.exit(main())
