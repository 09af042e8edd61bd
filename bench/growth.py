#!/usr/bin/env python3
"""Draws the table of alhazen_growth_bench as an SVG file: time per ray against triangles on logarithmic axes.

Usage: bench/growth.py TABLE.csv PICTURE.svg
"""

import csv
import math
import sys

COLORS = ["#0b62a4", "#c2410c", "#3f7d20", "#7b3fa0"]
LEFT, TOP, WIDTH, HEIGHT, GAP = 70, 40, 400, 320, 90


def read(path):
    """The table as {rays: {tracer: [(triangles, ns, lower, upper)]}}, in the order of the file."""
    panels = {}
    with open(path, encoding="ascii", newline="") as file:
        for row in csv.DictReader(file):
            values = tuple(float(row[k]) for k in ("triangles", "ns_per_ray", "lower_quartile", "upper_quartile"))
            panels.setdefault(row["rays"], {}).setdefault(row["tracer"], []).append(values)
    return panels


def slope(points):
    """Slope of the least-squares line of the logarithms; None for a single size."""
    x = [math.log(p[0]) for p in points]
    y = [math.log(p[1]) for p in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    spread = sum((a - mx) ** 2 for a in x)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / spread if spread > 0 else None


def decimal(n):
    return f"{n / 1e6:g} M" if n >= 1e6 else f"{n / 1e3:g} k" if n >= 1e3 else f"{n:g}"


class Axes:
    """Maps the numbers of one panel to positions in the drawing."""

    def __init__(self, left, panel):
        numbers = [p for points in panel.values() for p in points]
        self.left = left
        self.x = (min(p[0] for p in numbers) / 1.3, max(p[0] for p in numbers) * 1.3)
        self.y = (min(p[2] for p in numbers) / 1.2, max(p[3] for p in numbers) * 1.2)

    def at_x(self, value):
        return self.left + WIDTH * math.log(value / self.x[0]) / math.log(self.x[1] / self.x[0])

    def at_y(self, value):
        return TOP + HEIGHT - HEIGHT * math.log(value / self.y[0]) / math.log(self.y[1] / self.y[0])


def ticks(low, high, steps):
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [s * 10.0**p for p in powers for s in steps if low <= s * 10.0**p <= high]


def text(x, y, words, anchor="start", extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{extra}>{words}</text>'


def draw_axes(axes, title):
    bottom, right = TOP + HEIGHT, axes.left + WIDTH
    out = [text(axes.left + WIDTH / 2, TOP - 14, title, "middle", ' font-weight="bold"')]
    for value in ticks(*axes.x, (1,)):
        x = axes.at_x(value)
        out.append(f'<path class="grid" d="M{x:.1f} {TOP}V{bottom}"/>')
        out.append(text(x, bottom + 18, decimal(value), "middle"))
    for value in ticks(*axes.y, (1, 2, 5)):
        y = axes.at_y(value)
        out.append(f'<path class="grid" d="M{axes.left} {y:.1f}H{right}"/>')
        out.append(text(axes.left - 8, y + 4, f"{value:g}", "end"))
    out.append(f'<rect x="{axes.left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#444"/>')
    out.append(text(axes.left + WIDTH / 2, bottom + 38, "triangles", "middle"))
    middle = TOP + HEIGHT / 2
    out.append(text(axes.left - 48, middle, "nanoseconds per ray", "middle",
                    f' transform="rotate(-90 {axes.left - 48} {middle})"'))
    return out


def draw_curve(axes, points, color, name, row):
    path = "".join(f"{'L' if i else 'M'}{axes.at_x(p[0]):.1f} {axes.at_y(p[1]):.1f}" for i, p in enumerate(points))
    out = [f'<path d="{path}" fill="none" stroke="{color}" stroke-width="2"/>']
    for n, ns, lower, upper in points:
        x = axes.at_x(n)
        out.append(f'<path d="M{x:.1f} {axes.at_y(lower):.1f}V{axes.at_y(upper):.1f}" stroke="{color}"/>')
        out.append(f'<circle cx="{x:.1f}" cy="{axes.at_y(ns):.1f}" r="3" fill="{color}"/>')
    s = slope(points)
    label = name if s is None else f"{name}: slope {s:.2f}"
    y = TOP + 20 + 18 * row
    out.append(f'<path d="M{axes.left + 12} {y - 4}h18" stroke="{color}" stroke-width="2"/>')
    out.append(text(axes.left + 36, y, label))
    return out


def picture(panels):
    width = LEFT + len(panels) * (WIDTH + GAP)
    height = TOP + HEIGHT + 60
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           'font-family="sans-serif" font-size="13">',
           "<style>.grid{stroke:#ddd}</style>", f'<rect width="{width}" height="{height}" fill="white"/>']
    for i, (rays, curves) in enumerate(panels.items()):
        axes = Axes(LEFT + i * (WIDTH + GAP), curves)
        out += draw_axes(axes, {"shuffled": "bounce, shuffled", "lines": "random lines"}.get(rays, rays))
        for row, (name, points) in enumerate(curves.items()):
            out += draw_curve(axes, points, COLORS[row % len(COLORS)], name, row)
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[2], "w", encoding="ascii") as file:
        file.write(picture(read(sys.argv[1])))


if __name__ == "__main__":
    main()
