#!/usr/bin/env python3
"""Path tracing beside Cycles of Debian's blender: the same scenes, two threads, equal time.

Usage: bench/pictures/light.py ALHAZEN DATA [--scenes NAME,...] [--seconds T] [--long N] [--size WxH] [--filter NAME] [--json FILE]
       [--keep DIR]
Each renders for T seconds, and for N T seconds to make the reference of its error; prints the difference of both
references. RMSE is of linear light, unlimited and clamped to 1 (as a picture shows it). Neither program denoises,
clamps or samples adaptively. Both have the same pixel filter: by default that of Cycles (Blackman-Harris of radius
1.5), for which Alhazen shares samples between pixels, or a box. Times exclude the building of the scene.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile

from light_scenes import SCENES, write_alhazen, write_json

HERE = os.path.dirname(os.path.abspath(__file__))
MANY = 1 << 20
# Alhazen's filters, by their name in Cycles.
FILTERS = {"blackman_harris": "blackman_harris:radius=1.5,shared=on", "box": "box"}


def blender(*arguments):
    """Output of Blender, which takes the modules of the first Python in PATH: that of the system, which has numpy."""
    done = subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P",
                           os.path.join(HERE, "cycles.py"), "--", *map(str, arguments)],
                          capture_output=True, text=True, env={**os.environ, "PATH": os.defpath})
    if done.returncode != 0:
        raise SystemExit(f"blender: {done.stdout}{done.stderr}")
    return done.stdout


def compared(a, b):
    return json.loads(re.search(r"^compared (.*)$", blender("compare", a, b), re.M).group(1))


def write_sky(alhazen, path):
    """Writes the clear sky with its sun as a picture of all directions, whose centre is along x."""
    scene = os.path.splitext(path)[0] + "_source.alhazen"
    with open(scene, "w", encoding="ascii") as out:
        out.write("alhazen 1\nenvironment { kind = sky; up = (0, 0, 1); to_sun = (0.25, 0.3, 1) }\n"
                  "panorama_camera { eye = (0, 0, 0); direction = (1, 0, 0); up = (0, 0, 1) }\n"
                  "sphere { center = (0, 0, -1000); radius = 0.001; material = { diffuse = 0 } }\n")
    subprocess.run([alhazen, "render", scene, "-o", path, "--full-float", "--size", "1024x512", "--renderer",
                    "path_tracing", "--spp", "64", "-q"], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("data")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--long", type=float, default=12, help="times the seconds, of references")
    parser.add_argument("--size", default="400x300")
    parser.add_argument("--renderer", default="path_tracing")
    parser.add_argument("--filter", choices=FILTERS, default="blackman_harris")
    parser.add_argument("--json", help="file for the figures")
    parser.add_argument("--keep", help="folder for scenes and pictures (default: a temporary one)")
    args = parser.parse_args()
    if not shutil.which("blender"):
        raise SystemExit("blender is not installed: scripts/setup --blender")
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    at = lambda name: os.path.join(folder, name)
    width, height = (int(n) for n in args.size.split("x"))
    scenes = {name: SCENES[name](args.data) for name in args.scenes.split(",")}
    figures = {}

    # Each renders the scene of a name; returns samples per pixel and seconds.
    def alhazen(name, out, seconds, seed):
        stats = at("stats.json")
        subprocess.run([args.alhazen, "render", at(name + ".alhazen"), "-o", at(out), "--full-float", "--size",
                        args.size, "-t", "2", "-q", "--renderer", f"{args.renderer}:depth={scenes[name].depth + 1}", "--spp",
                        str(MANY), "--filter", FILTERS[args.filter], "--time-limit", f"{seconds:g}s", "--seed", str(seed), "--stats", stats,
                        "--no-counts"], check=True)
        with open(stats, encoding="utf-8") as source:
            given = json.load(source)
        return given["sampling"]["samples_per_pixel"], given["seconds"]["render"]

    def cycles(name, out, seconds, seed):
        told = blender("render", at(name + ".json"), at(out), width, height, seconds, MANY, seed, args.filter.upper())
        return max(int(n) for n in re.findall(r"Sample (\d+)/", told)), seconds

    for name, scene in scenes.items():
        if scene.sky:
            write_sky(args.alhazen, at(scene.sky))
        write_alhazen(scene, at(name + ".alhazen"))
        write_json(scene, at(name + ".json"))
        row = figures[name] = {}
        for program, render in (("alhazen", alhazen), ("cycles", cycles)):
            picture = lambda kind: f"{name}_{program}{kind}.exr"
            render(name, picture("_long"), args.long * args.seconds, 2)
            samples, took = render(name, picture(""), args.seconds, 1)
            row[program] = {"samples": samples, "seconds": took}
        both = compared(at(name + "_alhazen_long.exr"), at(name + "_cycles_long.exr"))
        row["references"] = both
        for program in ("alhazen", "cycles"):
            error = compared(at(f"{name}_{program}.exr"), at(f"{name}_{program}_long.exr"))
            row[program].update(rmse=error["rmse"], shown=error["shown"])
        for program in ("alhazen", "cycles"):
            r = row[program]
            print(f"{name}: {program}: {r['samples']:.0f} samples in {r['seconds']:.1f} s, RMSE {r['rmse']:.5f}, "
                  f"shown {r['shown']:.5f}", flush=True)
        print(f"{name}: the references differ by {both['rmse']:.5f}, shown {both['shown']:.5f}, their means are "
              f"{both['means'][0]:.5f} and {both['means'][1]:.5f}", flush=True)
    if args.json:
        with open(args.json, "w", encoding="utf-8") as out:
            json.dump(figures, out, indent=1)


if __name__ == "__main__":
    main()
