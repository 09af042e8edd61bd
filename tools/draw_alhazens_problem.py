#!/usr/bin/env python3
"""Draws docs/figures/alhazens_problem.svg: a light A and an eye B in a round mirror, the points that reflect one to the
other, and Huygens' hyperbola, which meets the mirror in them.

Usage: draw_alhazens_problem.py [OUT.svg]
"""

import cmath
import math
import sys

A, B = complex(0.74, 0.30), complex(-0.52, 0.54)
SCALE, MARGIN = 260.0, 70.0
STYLE = {
    "mirror": 'fill="none" stroke="#1f2a44" stroke-width="2.5"',
    "hyperbola": 'fill="none" stroke="#c0392b" stroke-width="1.4"',
    "asymptote": 'fill="none" stroke="#c0392b" stroke-width="0.8" stroke-dasharray="5 4"',
    "ray": 'fill="none" stroke="#2471a3" stroke-width="1.6"',
    "normal": 'fill="none" stroke="#7f8c8d" stroke-width="0.8" stroke-dasharray="2 3"',
}


def page(z):
    return f"{MARGIN + SCALE * (1 + z.real):.1f},{MARGIN + SCALE * (1 - z.imag):.1f}"


def line(points, style):
    return f'<polyline points="{" ".join(page(z) for z in points)}" {STYLE[style]}/>'


def dot(z, name, right=10.0, up=8.0, color="#1f2a44"):
    x, y = (float(c) for c in page(z).split(","))
    return (f'<circle cx="{x}" cy="{y}" r="4" fill="{color}"/>'
            f'<text x="{x + right:.1f}" y="{y - up:.1f}" fill="{color}">{name}</text>')


def on_hyperbola(z):
    """0 where a point, of any distance from the centre, is on it."""
    return (A * B * z.conjugate() ** 2 - (A + B) * z.conjugate()).imag


def mirror_points():
    """Zeros of the same on the circle, by bisection of a scan."""
    def f(angle):
        return on_hyperbola(cmath.exp(1j * angle))
    found, steps = [], 3600
    for i in range(steps):
        lo, hi = (2 * math.pi * (k + 0.31) / steps for k in (i, i + 1))
        if f(lo) * f(hi) >= 0:
            continue
        for _ in range(60):
            middle = (lo + hi) / 2
            lo, hi = (middle, hi) if f(lo) * f(middle) > 0 else (lo, middle)
        found.append(cmath.exp(1j * lo))
    return found


def hyperbola():
    """Both branches: z = m + r exp(i t) with r^2 = c / sin(2 (t - t0)) about its middle m."""
    middle = ((A + B) / (2 * A * B)).conjugate()
    turn = cmath.phase(A * B) / 2
    constant = -on_hyperbola(middle) / abs(A * B)
    branches = []
    for start in (0.0, math.pi):
        points = []
        for i in range(1, 600):
            t = math.pi / 2 * i / 600
            angle = turn + start + (-t if constant > 0 else t)
            # Im(ab exp(-2i angle)) r^2 = constant |ab|
            sine = math.sin(2 * (turn - angle))
            if constant / sine > 0:
                points.append(middle + math.sqrt(constant / sine) * cmath.exp(1j * angle))
        branches.append([z for z in points if abs(z.real) < 1.24 and abs(z.imag) < 1.24])
    return middle, turn, branches


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else "docs/figures/alhazens_problem.svg"
    side = 2 * (SCALE + MARGIN)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side:.0f} {side:.0f}" width="{side:.0f}" '
             f'height="{side:.0f}" font-family="serif" font-size="20" font-style="italic">',
             f'<rect width="{side:.0f}" height="{side:.0f}" fill="#ffffff"/>',
             f'<circle cx="{MARGIN + SCALE}" cy="{MARGIN + SCALE}" r="{SCALE}" {STYLE["mirror"]}/>']
    middle, turn, branches = hyperbola()
    for quarter in (0, math.pi / 2):
        along = 3 * cmath.exp(1j * (turn + quarter))
        points = [middle + along * (k / 300 - 1) for k in range(601)]
        parts.append(line([z for z in points if abs(z.real) < 1.24 and abs(z.imag) < 1.24], "asymptote"))
    parts += [line(branch, "hyperbola") for branch in branches if branch]
    points = mirror_points()
    for z in points:
        parts += [line([0, z], "normal"), line([A, z, B], "ray")]
    for i, z in enumerate(points):
        out_x, out_y = 26 * z.real - 8, 26 * z.imag - 6
        parts.append(dot(z, f"z<tspan dy='5' font-size='14'>{i + 1}</tspan>", out_x, out_y, "#2471a3"))
    parts += [dot(A, "A"), dot(B, "B", -22), dot(0, "O", -8, -22)]
    for name, p in (("A′", A), ("B′", B)):
        inverse = 1 / p.conjugate()
        if abs(inverse.real) < 1.24 and abs(inverse.imag) < 1.24:
            parts.append(dot(inverse, name, color="#c0392b"))
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(parts) + "\n</svg>\n")
    print(f"{out}: {len(points)} points")


if __name__ == "__main__":
    main()
