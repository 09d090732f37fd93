# SPDX-License-Identifier: MIT
"""Line plots with logarithmic axes as SVG, readable on light and on dark ground.

No library is needed, and the same figures give the same bytes. Lines are named at their right ends.
"""

import dataclasses
import math

WIDTH, HEIGHT = 760, 440
LEFT, RIGHT, TOP, BOTTOM = 74, 176, 44, 56
INK = "#7a7a7a"  # as far from white as from black


@dataclasses.dataclass
class Line:
    name: str
    color: str
    points: list  # (x, y), in the order of x
    dashed: bool = False


def escaped(text):
    return text.replace("&", "&amp;").replace("<", "&lt;")


def number(value):
    """A tick's label: 0.1, 10, 20 M."""
    for factor, suffix in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if value >= factor:
            return f"{value / factor:g}{suffix}"
    return f"{value:g}"


def decades(low, high):
    """The powers of ten in a range, with 2 and 5 between them where there are few."""
    powers = [10.0**e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
    if math.log10(high / low) < 2.5:
        powers = [p * step for p in powers for step in (1, 2, 5)]
    return [p for p in powers if low * 0.999 <= p <= high * 1.001]


class Scale:
    """Logarithmic, from a range of values to one of pixels."""

    def __init__(self, low, high, first, last):
        self.low, self.high, self.first, self.last = low, high, first, last

    def __call__(self, value):
        share = math.log(value / self.low) / math.log(self.high / self.low)
        return self.first + share * (self.last - self.first)


def apart(places, least):
    """The same places in order, moved so that neighbours are `least` apart."""
    moved = []
    for place in sorted(places):
        moved.append(max(place, moved[-1] + least) if moved else place)
    overlap = max(0, moved[-1] - (HEIGHT - BOTTOM)) if moved else 0
    return [place - overlap for place in moved]


def text(x, y, content, anchor="middle", color=INK, more=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}"{more}>'
            f"{escaped(content)}</text>")


def axes(x_scale, y_scale, x_ticks, y_name, x_name):
    left, right, top, bottom = LEFT, WIDTH - RIGHT, TOP, HEIGHT - BOTTOM
    parts = []
    for y in decades(y_scale.low, y_scale.high):
        at = y_scale(y)
        parts.append(f'<path d="M{left} {at:.1f}H{right}" stroke="{INK}" stroke-opacity="0.25"/>')
        parts.append(text(left - 8, at + 4, number(y), "end"))
    for x, label in x_ticks:
        at = x_scale(x)
        parts.append(f'<path d="M{at:.1f} {bottom}v5" stroke="{INK}"/>')
        parts.append(text(at, bottom + 20, label))
    parts.append(f'<path d="M{left} {top}V{bottom}H{right}" fill="none" stroke="{INK}"/>')
    parts.append(text((left + right) / 2, HEIGHT - 14, x_name))
    parts.append(text(18, (top + bottom) / 2, y_name,
                      more=f' transform="rotate(-90 18 {(top + bottom) / 2:.1f})"'))
    return parts


def drawn(line, x_scale, y_scale):
    path = "L".join(f"{x_scale(x):.1f} {y_scale(y):.1f}" for x, y in line.points)
    dash = ' stroke-dasharray="6 5"' if line.dashed else ""
    parts = [f'<path d="M{path}" fill="none" stroke="{line.color}" stroke-width="2"{dash}/>']
    if not line.dashed:
        parts += [f'<circle cx="{x_scale(x):.1f}" cy="{y_scale(y):.1f}" r="3" fill="{line.color}"/>'
                  for x, y in line.points]
    return parts


def svg(title, x_name, y_name, lines, x_ticks=None):
    """The whole picture. x_ticks: (value, label) pairs; by default the decades."""
    lines = [line for line in lines if line.points]
    xs = [x for line in lines for x, _ in line.points]
    ys = [y for line in lines for _, y in line.points]
    x_scale = Scale(min(xs), max(xs), LEFT + 12, WIDTH - RIGHT - 8)
    y_scale = Scale(min(ys) / 1.3, max(ys) * 1.3, HEIGHT - BOTTOM, TOP)
    ticks = x_ticks or [(x, number(x)) for x in decades(x_scale.low, x_scale.high)]
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
             'font-family="system-ui, sans-serif" font-size="13">',
             f"<title>{escaped(title)}</title>",
             text(LEFT, 24, title, "start", more=' font-size="15" font-weight="600"')]
    parts += axes(x_scale, y_scale, ticks, y_name, x_name)
    for line in lines:
        parts += drawn(line, x_scale, y_scale)
    by_end = sorted(lines, key=lambda line: y_scale(line.points[-1][1]))
    ends = apart([y_scale(line.points[-1][1]) for line in by_end], 17)
    for line, y in zip(by_end, ends):
        x = x_scale(line.points[-1][0]) + 10
        parts.append(text(x, y + 4, line.name, "start", line.color))
    return "\n".join(parts + ["</svg>"]) + "\n"
