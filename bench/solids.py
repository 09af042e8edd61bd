#!/usr/bin/env python3
"""Solids made of others beside POV-Ray: same scene, same eye rays, flat colours, one thread, in turn, medians.

Usage: bench/solids.py ALHAZEN [--sizes plate=1000,menger=1000,spheres=1000] [--side N] [--rounds N] [--json FILE] [--keep FOLDER]
Seconds are those that each program says it traced (without reading the scene); pixels are compared by colour.
"""

import argparse
import array
import json
import os
import re
import shutil
import statistics
import subprocess
import tempfile

GENERATORS = {"plate": "perforated_plate", "menger": "menger_sponge", "spheres": "drilled_spheres"}
FLAT = {"skin": (1, 0, 0), "cut": (0, 1, 0)}  # the background is blue
NUMBER = r"[-+0-9.e]+"


def generate(alhazen, kind, size, path):
    """The generated scene as flat native text; returns that text."""
    subprocess.run([alhazen, "generate", GENERATORS[kind], "--size", str(size), "-o", path, "-q"], check=True)
    with open(path, encoding="ascii") as file:
        text = file.read()
    text = re.sub(r"(?m)^(ambient|directional)_light .*\n", "", text)
    text = re.sub(r"(?m)^material .*\n", "", text)
    text = re.sub(r"(?m)^(picture|conventions) \{[^}]*\}\n", "", text)
    flat = "picture { background = (0, 0, 1) }\nconventions { headlight = false }\n"
    for name, color in FLAT.items():
        flat += f'material "{name}" {{ emission = {color} }}\n'
    text = text.replace("alhazen 1\n", "alhazen 1\n" + flat, 1)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
    return text


def vectors(line):
    return {key: tuple(map(float, value.split(","))) for key, value in re.findall(r"(\w+) = \(([^()]*)\)", line)}


def angle(v):
    return "<" + ",".join(f"{x:.17g}" for x in v) + ">"


def pov_shape(line):
    kind = line.split()[0]
    v = vectors(line)
    number = lambda key, usual: float((re.search(rf"\b{key} = ({NUMBER})", line) or [0, usual])[1])
    texture = f"texture {{ {re.search(r'material = .(\w+).', line)[1]} }}"
    if kind == "box":
        return f"box {{ {angle(v['lo'])}, {angle(v['hi'])} {texture} }}"
    if kind == "sphere":
        return f"sphere {{ {angle(v['center'])}, {number('radius', 1):.17g} {texture} }}"
    if kind == "cylinder":
        return f"cylinder {{ {angle(v['base'])}, {angle(v['top'])}, {number('radius', 1):.17g} {texture} }}"
    raise ValueError(line)


def write_povray(text, path):
    """The subset of the native format that the generators write."""
    camera = vectors(re.search(r"sheared_camera[^{]*\{(.*?)\}", text, re.S)[1])
    with open(path, "w", encoding="ascii") as out:
        out.write("#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { rgb <0,0,1> }\n")
        out.write(f"camera {{ perspective location {angle(camera['eye'])} direction {angle(camera['look'])} "
                  f"right {angle(camera['right'])} up {angle(camera['up'])} }}\n")
        for name, color in FLAT.items():
            out.write(f"#declare {name} = texture {{ pigment {{ rgb {angle(color)} }} "
                      "finish { ambient 0 diffuse 0 emission 1 } }\n")
        for body in re.findall(r"(?ms)^object [^{]*\{\n(.*?)^\}", text):
            lines = [line.strip() for line in body.splitlines()]
            shapes = [pov_shape(line) for line in lines if re.match(r"(box|sphere|cylinder)\b", line)]
            out.write("difference {\n" + "\n".join(shapes) + "\n}\n")


def alhazen_seconds(command, stats):
    subprocess.run(command + ["--stats", stats], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(stats, encoding="utf-8") as file:
        seconds = json.load(file)["seconds"]
    return {"trace": seconds["render"], "begin": seconds["load"] + seconds["build"]}


def povray_seconds(command):
    run = subprocess.run(command, check=True, capture_output=True, text=True, errors="replace")
    said = lambda what: float((re.search(rf"{what} Time:.*?\(([0-9.]+) seconds\)", run.stderr) or [0, "nan"])[1])
    return {"trace": said("Trace"), "begin": said("Parse")}


def pixels(path):
    """Colours from the top left on: of a PPM (POV-Ray) or a PFM (Alhazen), both binary."""
    with open(path, "rb") as file:
        kind, size = file.readline().strip(), file.readline()
        while size.startswith(b"#"):
            size = file.readline()
        width, height = map(int, size.split())
        file.readline()
        data = file.read()
    if kind == b"P6":
        return [tuple(data[i:i + 3]) for i in range(0, 3 * width * height, 3)]
    values = array.array("f", data)
    rows = [[tuple(values[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)] for y in range(height)]
    return [p for row in reversed(rows) for p in row]


def differences(a, b):
    name = lambda p: max(range(3), key=lambda k: p[k])
    pairs = {}
    for p, q in zip(pixels(a), pixels(b)):
        if name(p) != name(q):
            key = f"{'rgb'[name(p)]}{'rgb'[name(q)]}"
            pairs[key] = pairs.get(key, 0) + 1
    return pairs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("--sizes", default="plate=1000,menger=1000,spheres=1000,plate=100000,menger=100000")
    parser.add_argument("--side", type=int, default=256)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--json")
    parser.add_argument("--keep", help="folder for scenes and pictures (default: a temporary one)")
    args = parser.parse_args()
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    results = {}
    for scene in args.sizes.split(","):
        kind, size = scene.split("=")
        at = lambda suffix: os.path.join(folder, f"{kind}_{size}{suffix}")
        text = generate(args.alhazen, kind, size, at(".alhazen"))
        write_povray(text, at(".pov"))
        ours = [args.alhazen, "render", at(".alhazen"), "-o", at("_alhazen.pfm"), "--size",
                f"{args.side}x{args.side}", "--renderer", "ray_casting", "-t", "1", "-q"]
        theirs = ["povray", f"+I{at('.pov')}", f"+O{at('_povray.ppm')}", f"+W{args.side}", f"+H{args.side}", "+WT1",
                  "-D", "-A", "+FP"]
        seconds = {"alhazen": [], "povray": []}
        for _ in range(args.rounds):
            seconds["alhazen"].append(alhazen_seconds(ours, at(".json")))
            if shutil.which("povray"):
                seconds["povray"].append(povray_seconds(theirs))
        median = lambda program, what: statistics.median(s[what] for s in seconds[program])
        row = {"alhazen": {w: median("alhazen", w) for w in ("trace", "begin")}}
        line = f"{kind} {size}: alhazen {row['alhazen']['trace']:.3f} s"
        if seconds["povray"]:
            row["povray"] = {w: median("povray", w) for w in ("trace", "begin")}
            row["ratio"] = row["povray"]["trace"] / row["alhazen"]["trace"]
            row["different_pixels"] = differences(at("_alhazen.pfm"), at("_povray.ppm"))
            line += (f", povray {row['povray']['trace']:.3f} s, ratio {row['ratio']:.1f}, pixels that differ "
                     f"{row['different_pixels'] or 'none'} of {args.side ** 2}")
        results[scene] = row
        print(line, flush=True)
    if args.json:
        with open(args.json, "w", encoding="ascii") as out:
            json.dump(results, out, indent=2)


if __name__ == "__main__":
    main()
