#!/usr/bin/env python3
"""Compares vector drawings with the ray-traced picture: SVG drawn by Chromium, PDF by pdftoppm and pdftocairo.

Usage: bench/pictures/drawings.py ALHAZEN [--scene FILE | --size BOXES] [--side N] [--factors K,...] [--rows N] [--keep FOLDER]
The scene is a city of BOXES boxes (alhazen generate city; default 1667: 10 003 polygons), its side N (512) pixels.
A pixel differs if a channel at its centre differs by more than 1 % from that of `whitted`. Programs that colour a pixel
by its centre draw N x N pixels. pdftoppm colours each pixel that a region touches: it draws K times as many along both
axes, K odd, of which the central one of each pixel is compared. Its antialiased picture is compared with that of
`--antialias exact`, by 10 %. Programs that are not installed are skipped (scripts/setup --peers, --browser). --rows:
the number of evenly spaced rows to compare; default: all.
"""

import argparse
import pathlib
import resource
import shutil
import subprocess
import tempfile


def run(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True)


def processor_seconds(*command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run(*command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def pixels_of(path):
    """Width, height and bytes of a picture, converted to a portable pixmap."""
    if path.suffix != ".ppm":
        run("convert", path, "-depth", "8", path.with_suffix(".ppm"))
    data = path.with_suffix(".ppm").read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        while data[at:at + 1].isspace():
            at += 1
        end = at
        while not data[end:end + 1].isspace():
            end += 1
        fields.append(data[at:end])
        at = end
    assert fields[0] == b"P6" and fields[3] == b"255", fields
    return int(fields[1]), int(fields[2]), data[at + 1:]


def differing(a, b, bound):
    """Number of pixels of two rows of bytes with a channel that differs by more."""
    return sum(any(abs(a[k + c] - b[k + c]) > bound for c in range(3)) for k in range(0, len(a), 3))


def compare(path, rows, bound):
    width, height, data = pixels_of(path)
    assert width == height == len(rows), (path, width, height)
    return sum(differing(data[3 * width * j:3 * width * (j + 1)], rows[j], bound) for j in range(height))


def pdf_middles(pdf, rows, which, factor, work):
    """Number of pixels of the rows `which` whose centres differ, drawn `factor` times as large by pdftoppm."""
    side, wrong = len(rows), 0
    for j in which:
        run("pdftoppm", "-aaVector", "no", "-r", 72 * factor, "-x", 0, "-y", factor * j + factor // 2, "-W", side * factor,
            "-H", 1, "-singlefile", pdf, work / "strip")
        width, _, data = pixels_of(work / "strip.ppm")
        assert width == side * factor, width
        row = bytearray(3 * side)
        for c in range(3):
            row[c::3] = data[3 * (factor // 2) + c::3 * factor]
        wrong += differing(row, rows[j], 0.01 * 255)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("--scene")
    parser.add_argument("--size", type=int, default=1667)
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--factors", default="31")
    parser.add_argument("--rows", type=int)
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    work = pathlib.Path(arguments.keep or tempfile.mkdtemp())
    work.mkdir(parents=True, exist_ok=True)
    side, alhazen = arguments.side, arguments.alhazen
    scene = arguments.scene or work / "city.alhazen"
    if not arguments.scene:
        run(alhazen, "generate", "city", "--size", arguments.size, "-o", scene)
    look = ["-q", scene, "--size", f"{side}x{side}", "-o"]
    for suffix in ("svg", "pdf"):
        print(f"alhazen vector, {suffix}: {processor_seconds(alhazen, 'vector', *look, work / f'd.{suffix}'):.2f} s")
    run(alhazen, "render", *look, work / "rays.png", "--renderer", "whitted")
    run(alhazen, "render", *look, work / "exact.png", "--renderer", "beam_tracing", "--antialias", "exact")
    rows, exact = ([data[3 * side * j:3 * side * (j + 1)] for j in range(side)]
                   for _, _, data in (pixels_of(work / name) for name in ("rays.png", "exact.png")))

    def say(name, wrong, of=side * side):
        print(f"{name}: {wrong} of {of} pixels, {100 * wrong / of:.2f} %", flush=True)

    if shutil.which("chromium"):
        run("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--window-size={side},{side}",
            f"--screenshot={work / 'svg.png'}", f"file://{(work / 'd.svg').resolve()}")
        say("SVG by Chromium", compare(work / "svg.png", rows, 0.01 * 255))
    if shutil.which("pdftoppm"):
        run("pdftocairo", "-antialias", "none", "-r", 72, "-png", "-singlefile", work / "d.pdf", work / "cairo")
        say("PDF by pdftocairo", compare(work / "cairo.png", rows, 0.01 * 255))
        run("pdftoppm", "-r", 72, "-singlefile", work / "d.pdf", work / "smooth")
        say("PDF by pdftoppm, smoothed, by 10 % from exact areas", compare(work / "smooth.ppm", exact, 0.1 * 255))
        count = arguments.rows or side
        which = [(2 * n + 1) * side // (2 * count) for n in range(count)]
        for factor in map(int, arguments.factors.split(",")):
            say(f"PDF by pdftoppm, {factor} times as large",
                pdf_middles(work / "d.pdf", rows, which, factor, work), count * side)
    if not arguments.keep:
        shutil.rmtree(work)


main()
