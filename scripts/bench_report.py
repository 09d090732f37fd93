# SPDX-License-Identifier: MIT
"""The figures of scripts/bench for people: lines on a terminal, README.md's section, two plots."""

import re
import textwrap

import plot

PEERS = {"vtk kept": "VTK, heap kept", "vtk plain": "VTK", "vdb": "OpenVDB"}
BEGIN = "<!-- speed: written by scripts/bench --readme -->\n"
END = "<!-- end of speed -->\n"

COLORS = {"mc": "#2f8f4e", "vtk kept": "#c2662d", "vdb": "#8163c4",
          "read": plot.INK}
NAMES = {"mc": "mc", "vtk kept": "VTK, heap kept", "vdb": "OpenVDB", "read": "reading once"}


def milliseconds(ms):
    """Three digits, or more: 0.0831, 8.30, 831, 1870."""
    return f"{ms:.0f}" if ms >= 100 else f"{ms:#.3g}"


def millions(n):
    return f"{n / 1e6:.2f} M" if n >= 1e5 else f"{n / 1e3:.1f} k"


def memory_of(machine):
    """With one thread."""
    return next(m for m in machine["memory"] if m["threads"] == 1)


def text_head(machine):
    lines = [f"mc {machine['mc']}, {machine['processor']}, {machine['cores']} cores, simd "
             f"{machine['simd']}; {machine['compiler']}"]
    for m in machine["memory"]:
        lines.append(f"read {m['read'] / 1e9:.1f} GB/s, write {m['write'] / 1e9:.1f}, past the cache "
                     f"{m['write_past_cache'] / 1e9:.1f}, threads: {m['threads']}")
    lines += [f"demo {d['cells']}^3: {milliseconds(d['time']['ms'])} ms" for d in machine["demo"]]
    return "\n".join(lines)


def text_row(row):
    ours = row["results"]["mc"]
    threads = "1 thread" if row["threads"] == 1 else f"{row['threads']} threads"
    text = (f"{row['volume']:10} {row['size']:4}^3 {threads:9}, normals "
            f"{row['normals']:8} {millions(ours['faces']):>8} triangles  mc "
            f"{milliseconds(ours['ms']):>6} ms +-{100 * ours['spread_ms'] / ours['ms']:.1f} %")
    if "read" in row["results"]:
        text += f" = {ours['ms'] / row['results']['read']['ms']:.2f} reads"
    for key, name in PEERS.items():
        peer = row["results"].get(key)
        if peer:
            text += f"; {name} {milliseconds(peer['ms'])} ({peer['ms'] / ours['ms']:.1f} x)"
    return text


def table_line(row):
    results = row["results"]
    ours = results["mc"]
    cells = [f"{row['volume']} {row['size']}³", millions(ours["faces"]), str(row["threads"]),
             "yes" if row["normals"] == "gradient" else "", f"**{milliseconds(ours['ms'])}**",
             f"{ours['ms'] / results['read']['ms']:.2f}" if "read" in results else ""]
    for key in PEERS:
        peer = results.get(key)
        cells.append(f"{milliseconds(peer['ms'])} ({peer['ms'] / ours['ms']:.1f} ×)" if peer else "")
    return "| " + " | ".join(cells) + " |"


def method_text(results):
    machine = results["machine"]
    rounds = max(row["results"]["mc"]["rounds"] for row in results["dense"])
    return (
        f"Medians of {rounds} rounds in which all programs take turns, each timed inside its own "
        "process around the one call; f32 samples in memory, the mesh made in memory. *÷ read* is the "
        "time by that of reading the samples once with as many threads. VTK 9.1 is vtkFlyingEdges3D "
        "without scalars and gradients, the best of its back ends; *heap kept* tells glibc not to give "
        "memory back, as a loop over volumes would want. OpenVDB 10 is volumeToMesh, adaptivity 0, on "
        "the narrow band of the same field; it makes quads and has no normals. Machine: "
        f"{machine['processor']}, {machine['cores']} cores, {machine['simd']}, reading "
        f"{memory_of(machine)['read'] / 1e9:.1f} GB/s with one thread; {machine['compiler']}, -O3. "
        "`scripts/bench --readme` makes these figures, `mc bench` those without peers.")


def section(results):
    demo = results["machine"]["demo"][-1]
    lines = [
        f"| volume | triangles | threads | normals | mc, ms | ÷ read | "
        f"{' | '.join(f'{name}, ms' for name in PEERS.values())} |",
        "|---|--:|--:|:-:|--:|--:|" + "--:|" * len(PEERS)]
    lines += [table_line(row) for row in results.get("dense", []) + results.get("sparse", [])]
    lines += [
        "",
        f"The terrain of the demo with {demo['cells']}³ cells takes "
        f"{milliseconds(demo['time']['ms'])} ms.",
        "",
        "![Time against samples](data/pictures/speed-samples.svg)",
        "",
        "![Time against triangles](data/pictures/speed-triangles.svg)",
        "",
        textwrap.fill(method_text(results), 100),
        ""]
    return "\n".join(lines)


def plot_lines(rows, x_of):
    lines = []
    for key, name in NAMES.items():
        points = sorted((x_of(row), row["results"][key]["ms"]) for row in rows
                        if key in row["results"])
        lines.append(plot.Line(name, COLORS[key], points, dashed=key == "read"))
    return lines


def plots(results):
    """The two pictures by name."""
    spheres = [row for row in results["growth"] if row["volume"] == "sphere"]
    gyroids = [row for row in results["growth"] if row["volume"] == "gyroid"]
    size = gyroids[0]["size"]
    return {
        "speed-samples.svg": plot.svg(
            "A sphere in more and more samples, one thread", "samples", "milliseconds",
            plot_lines(spheres, lambda row: row["size"] ** 3),
            [(row["size"] ** 3, f"{row['size']}³") for row in spheres]),
        "speed-triangles.svg": plot.svg(
            f"Gyroids of more and more periods in {size}³ samples, one thread", "triangles",
            "milliseconds", plot_lines(gyroids, lambda row: row["results"]["mc"]["faces"]))}


def write_readme(root, results):
    """Replaces what lies between the marks in README.md, and the plots that it shows."""
    for name, picture in plots(results).items():
        (root / "data" / "pictures" / name).write_text(picture, encoding="utf-8")
    path = root / "README.md"
    text = path.read_text(encoding="utf-8")
    marked = re.compile(re.escape(BEGIN) + ".*?" + re.escape(END), re.DOTALL)
    if not marked.search(text):
        raise SystemExit(f"bench: README.md: no line {BEGIN.strip()}")
    path.write_text(marked.sub(lambda _: BEGIN + section(results) + END, text), encoding="utf-8")
