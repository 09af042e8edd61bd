#!/usr/bin/env python3
"""Compares CSG solids and curved surfaces with POV-Ray: same scene, eye rays, flat colours; one thread, medians.

Usage: bench/pictures/solids.py ALHAZEN [--sizes plate=1000,menger=1000@64,torus,...] [--side N] [--rounds N] [--lit] [--patch-type N] [--flatness X] [--json FILE] [--markdown FILE] [--keep FOLDER]
A scene is KIND[=SIZE][@SIDE]: plate, menger, spheres (SIZE leaves), or torus, quartic, sextic, blob (one surface).
teapot=N: the patches of ALHAZEN_TEST_DATA (default ../shared/data) patches/teapot.bpt, which POV-Ray divides up to 2^N
times each way: with --patch-type 1 (the default) when it reads them, with 0 for every ray; until they are flat to
--flatness X (default 0: always 2^N times).
--lit shades with a point light without shadows in both programs, so that normals are computed too.
Seconds are the processor time of tracing as each program reports it (without reading the scene); pixels are compared by
colour. "Whole" is the processor time of the program from start to end, with its peak memory.
"""

import argparse
import array
import concurrent.futures
import json
import os
import re
import shutil
import statistics
import subprocess
import tempfile

GENERATORS = {"plate": "perforated_plate", "menger": "menger_sponge", "spheres": "drilled_spheres"}
ALL = "spheres=1000,plate=1000,plate=100000@16,menger=1000,menger=100000@16,torus,quartic,sextic,blob"
COLORS = {"skin": (1, 0, 0), "cut": (0, 1, 0)}  # the background is blue
GLOW = 0.2  # emission of a lit surface, so that its colour is recognizable at grazing incidence
NUMBER = r"[-+0-9.e]+"


def vector(v, scale=1.0):
    return "(" + ", ".join(f"{scale * x:.17g}" for x in v) + ")"


def light_of(eye):
    """A position beside the eye, away from the origin."""
    return tuple(1.5 * x + y for x, y in zip(eye, (1.0, -0.5, 2.0)))


def native_head(eye, lit, colors):
    head = "picture { background = (0, 0, 1) }\nconventions { headlight = false }\n"
    if lit:
        head += f"point_light {{ position = {vector(light_of(eye))}; color = (1, 1, 1) }}\n"
    for name in colors:
        color = COLORS[name]
        shading = f"emission = {vector(color, GLOW)}; diffuse = {vector(color, 1 - GLOW)}" if lit else f"emission = {vector(color)}"
        head += f'material "{name}" {{ {shading} }}\n'
    return head


def generate(alhazen, kind, size, path, lit):
    """Writes the generated scene as native text with other materials; returns that text."""
    subprocess.run([alhazen, "generate", GENERATORS[kind], "--size", str(size), "-o", path, "-q"], check=True)
    with open(path, encoding="ascii") as file:
        text = file.read()
    text = re.sub(r"(?m)^(ambient|directional)_light .*\n", "", text)
    text = re.sub(r"(?m)^material .*\n", "", text)
    text = re.sub(r"(?m)^(picture|conventions) \{[^}]*\}\n", "", text)
    eye = vectors(re.search(r"sheared_camera[^{]*\{(.*?)\}", text, re.S)[1])["eye"]
    text = text.replace("alhazen 1\n", "alhazen 1\n" + native_head(eye, lit, COLORS), 1)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)
    return text


# One surface in front of a plain background: a polynomial of x, y and z, a torus, or a blob.
CAMERA = {"eye": (1.0, -6.0, 3.0), "look": (-1.0, 6.0, -3.0), "right": (3.6, 0.6, 0.0), "up": (-0.27, 1.62, 3.33)}
POLYNOMIALS = {
    "quartic": ("x^4 + y^4 + z^4 - 1.5*(x^2 + y^2 + z^2) + 0.3*x*y*z + 0.9", 1.5),
    # Barth's sextic with the golden ratio in decimals.
    "sextic": ("4*(2.618033988749895*x^2 - y^2)*(2.618033988749895*y^2 - z^2)*(2.618033988749895*z^2 - x^2)"
               " - 4.23606797749979*(x^2 + y^2 + z^2 - 1)^2", 1.4),
}


def blob_parts():
    """Thirty spheres, the same for both programs."""
    value, parts = 12345, []
    for _ in range(30):
        numbers = []
        for _ in range(4):
            value = (1103515245 * value + 12345) % 2**31
            numbers.append(value / 2**31)
        parts.append((tuple(round(2 * n - 1, 3) for n in numbers[:3]), round(0.5 + 0.3 * numbers[3], 3)))
    return parts


def teapot_patches():
    """The sixteen points of each bicubic patch, moved in front of the camera."""
    data = os.environ.get("ALHAZEN_TEST_DATA", os.path.join(os.path.dirname(__file__), "../../../shared/data"))
    with open(os.path.join(data, "patches/teapot.bpt"), encoding="ascii") as file:
        numbers = list(map(float, file.read().split()))
    place = lambda p: (0.5 * (p[0] - 0.2), 0.5 * p[1], 0.5 * (p[2] - 1.575))
    return [[place(numbers[first + 3 * k:first + 3 * k + 3]) for k in range(16)] for first in range(3, len(numbers), 50)]


def teapot(steps, patch_type, flatness):
    patches = teapot_patches()
    points = ", ".join(vector(p) for patch in patches for p in patch)
    ours = (f'patch_mesh {{ points = [{points}]; patches = [{", ".join(map(str, range(16 * len(patches))))}]; '
            'material = "skin" }')
    theirs = "\n".join(f"bicubic_patch {{ type {patch_type} flatness {flatness:g} u_steps {steps} v_steps {steps} {', '.join(map(angle, patch))} "
                       "texture { skin } }" for patch in patches)
    return ours, theirs


class Polynomial(dict):
    """{(i, j, k): c} for the terms c x^i y^j z^k, with the operators that eval of an expression needs."""

    def __add__(self, other):
        other = other if isinstance(other, Polynomial) else Polynomial({(0, 0, 0): other})
        total = Polynomial(self)
        for key, c in other.items():
            total[key] = total.get(key, 0.0) + c
        return total

    def __mul__(self, other):
        other = other if isinstance(other, Polynomial) else Polynomial({(0, 0, 0): other})
        product = Polynomial()
        for a, c in self.items():
            for b, d in other.items():
                key = tuple(i + j for i, j in zip(a, b))
                product[key] = product.get(key, 0.0) + c * d
        return product

    def __sub__(self, other):
        return self + (other * -1.0 if isinstance(other, Polynomial) else -other)

    def __pow__(self, n):
        power = Polynomial({(0, 0, 0): 1.0})
        for _ in range(n):
            power = power * self
        return power

    __rmul__ = __mul__
    __radd__ = __add__


def pov_polynomial(expression, side):
    axes = {name: Polynomial({tuple(int(i == k) for i in range(3)): 1.0}) for k, name in enumerate("xyz")}
    f = eval(expression.replace("^", "**"), {}, axes)  # the two expressions above
    degree = max(map(sum, f))
    coefficients = [f.get((i, j, k), 0.0) for i in range(degree, -1, -1) for j in range(degree - i, -1, -1)
                    for k in range(degree - i - j, -1, -1)]
    box = f"box {{ <-{side},-{side},-{side}>, <{side},{side},{side}> }}"
    return (f"intersection {{ poly {{ {degree}, <{','.join(f'{c:.17g}' for c in coefficients)}> sturm }} {box} "
            "texture { skin } }")


def one_surface(kind, size, args):
    """The surface in the native format and for POV-Ray."""
    if kind == "teapot":
        return teapot(size or 4, args.patch_type, args.flatness)
    if kind == "torus":
        return ('torus { axis = (0, 1, 0); major_radius = 1.2; minor_radius = 0.45; material = "skin" }',
                "torus { 1.2, 0.45 sturm texture { skin } }")
    if kind == "blob":
        parts = blob_parts()
        ours = ", ".join(f"sphere(({c[0]}, {c[1]}, {c[2]}), {r}, 1)" for c, r in parts)
        theirs = " ".join(f"sphere {{ {angle(c)}, {r}, 1 }}" for c, r in parts)
        return (f'blob {{ threshold = 0.6; components = [{ours}]; material = "skin" }}',
                f"blob {{ threshold 0.6 {theirs} sturm texture {{ skin }} }}")
    expression, side = POLYNOMIALS[kind]
    return (f'algebraic {{ expression = "{expression}"; material = "skin"; '
            f"clip_box = ((-{side}, -{side}, -{side}), ({side}, {side}, {side})) }}", pov_polynomial(expression, side))


def write_one_surface(kind, size, path, pov_path, args):
    ours, theirs = one_surface(kind, size, args)
    lit = args.lit
    camera = "; ".join(f"{key} = ({value[0]}, {value[1]}, {value[2]})" for key, value in CAMERA.items())
    with open(path, "w", encoding="ascii") as out:
        out.write("alhazen 1\n" + native_head(CAMERA["eye"], lit, ["skin"]))
        out.write(f'sheared_camera "main" {{ {camera}; aspect = 1 }}\n{ours}\n')
    with open(pov_path, "w", encoding="ascii") as out:
        out.write(pov_head(CAMERA, lit) + theirs + "\n")


def vectors(line):
    return {key: tuple(map(float, value.split(","))) for key, value in re.findall(r"(\w+) = \(([^()]*)\)", line)}


def angle(v):
    return "<" + ",".join(f"{x:.17g}" for x in v) + ">"


def pov_shape(line):
    kind = line.split()[0]
    v = vectors(line)
    number = lambda key, usual: float((re.search(rf"\b{key} = ({NUMBER})", line) or [0, usual])[1])
    material = re.search(r"material = .(\w+).", line)[1]
    texture = f"texture {{ {material} }}"
    if kind == "box":
        return f"box {{ {angle(v['lo'])}, {angle(v['hi'])} {texture} }}"
    if kind == "sphere":
        return f"sphere {{ {angle(v['center'])}, {number('radius', 1):.17g} {texture} }}"
    if kind == "cylinder":
        return f"cylinder {{ {angle(v['base'])}, {angle(v['top'])}, {number('radius', 1):.17g} {texture} }}"
    raise ValueError(line)


def pov_head(camera, lit):
    head = ("#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { rgb <0,0,1> }\n"
            f"camera {{ perspective location {angle(camera['eye'])} direction {angle(camera['look'])} "
            f"right {angle(camera['right'])} up {angle(camera['up'])} }}\n")
    if lit:
        head += f"light_source {{ {angle(light_of(camera['eye']))} rgb 1 shadowless }}\n"
    finish = f"ambient 0 diffuse {1 - GLOW} emission {GLOW}" if lit else "ambient 0 diffuse 0 emission 1"
    for name, color in COLORS.items():
        head += f"#declare {name} = texture {{ pigment {{ rgb {angle(color)} }} finish {{ {finish} }} }}\n"
    return head


def write_povray(text, path, lit):
    """Converts the subset of the native format that the generators write."""
    camera = vectors(re.search(r"sheared_camera[^{]*\{(.*?)\}", text, re.S)[1])
    with open(path, "w", encoding="ascii") as out:
        out.write(pov_head(camera, lit))
        # Joins long blocks, which are written over several lines.
        joined = lambda block: "; ".join(line.strip() for line in block[0].splitlines()).replace("{;", "{").replace("; }", " }")
        text = re.sub(r"(?ms)^    (?:box|sphere|cylinder) \{\n.*?^    \}", joined, text)
        for body in re.findall(r"(?ms)^object [^{]*\{\n(.*?)^\}", text):
            lines = [line.strip() for line in body.splitlines()]
            shapes = [pov_shape(line) for line in lines if re.match(r"(box|sphere|cylinder)\b", line)]
            out.write("difference {\n" + "\n".join(shapes) + "\n}\n")


def measured(command):
    """The output of the program to stderr, its processor seconds and its peak memory in MB."""
    with tempfile.TemporaryFile() as err:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        err.seek(0)
        text = err.read().decode(errors="replace")
    if process.returncode != 0:
        raise RuntimeError(f"{command[0]} failed: {text}")
    return text, {"whole": usage.ru_utime + usage.ru_stime, "memory": usage.ru_maxrss / 1024}


def alhazen_seconds(command, stats):
    _, whole = measured(command + ["--stats", stats, "--no-counts"])
    with open(stats, encoding="utf-8") as file:
        seconds = json.load(file)["seconds"]
    return {"trace": seconds["render_processor"], "begin": seconds["load"] + seconds["build"]} | whole


def povray_seconds(command):
    text, whole = measured(command)
    said = lambda what: float((re.search(rf"{what} Time:.*?with ([0-9.]+) CPU-seconds", text, re.S) or [0, "nan"])[1])
    return {"trace": said("Trace"), "begin": said("Parse")} | whole


def pixels(path):
    """Colours of a binary PPM (POV-Ray) or PFM (Alhazen), top left first."""
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
    """Counts in another process: the peak memory of a program is at least that of the process that starts it."""
    with concurrent.futures.ProcessPoolExecutor(1) as pool:
        return pool.submit(count_differences, a, b).result()


def count_differences(a, b):
    name = lambda p: max(range(3), key=lambda k: p[k])
    pairs = {}
    for p, q in zip(pixels(a), pixels(b)):
        if name(p) != name(q):
            key = f"{'rgb'[name(p)]}{'rgb'[name(q)]}"
            pairs[key] = pairs.get(key, 0) + 1
    return pairs


def markdown_row(scene, row):
    cells = [scene, f"{row['alhazen']['trace']:.3f}", f"{row['rays_per_second'] / 1e6:.2f}"]
    if "povray" in row:
        differ = sum(row["different_pixels"].values())
        cells += [f"{row['povray']['trace']:.2f}", f"{row['ratio']:.1f}", f"{differ} of {row['pixels']}"]
    return "| " + " | ".join(cells) + " |\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("--sizes", default=ALL)
    parser.add_argument("--side", type=int, default=256)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--patch-type", type=int, choices=(0, 1), default=1, help="of POV-Ray's bicubic_patch")
    parser.add_argument("--flatness", type=float, default=0.0, help="of POV-Ray's bicubic_patch")
    parser.add_argument("--lit", action="store_true", help="surfaces shaded by a light, not flat")
    parser.add_argument("--json")
    parser.add_argument("--markdown", help="writes the rows of the table of docs/benchmarks.md")
    parser.add_argument("--keep", help="folder for scenes and pictures (default: a temporary one)")
    args = parser.parse_args()
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    results = {}
    for scene in args.sizes.split(","):
        kind, size, side = re.fullmatch(r"(\w+)(?:=(\d+))?(?:@(\d+))?", scene).groups()
        side = int(side or args.side)
        at = lambda suffix: os.path.join(folder, f"{kind}_{size or 1}{suffix}")
        if kind in GENERATORS:
            write_povray(generate(args.alhazen, kind, size or "1000", at(".alhazen"), args.lit), at(".pov"), args.lit)
        else:
            write_one_surface(kind, size, at(".alhazen"), at(".pov"), args)
        ours = [args.alhazen, "render", at(".alhazen"), "-o", at("_alhazen.pfm"), "--size", f"{side}x{side}",
                "--renderer", "ray_casting", "-t", "1", "-q"]
        theirs = ["povray", f"+I{at('.pov')}", f"+O{at('_povray.ppm')}", f"+W{side}", f"+H{side}", "+WT1",
                  "-D", "-A", "+FP"]
        seconds = {"alhazen": [], "povray": []}
        for _ in range(args.rounds):
            seconds["alhazen"].append(alhazen_seconds(ours, at(".json")))
            if shutil.which("povray"):
                seconds["povray"].append(povray_seconds(theirs))
        median = lambda program, what: statistics.median(s[what] for s in seconds[program])
        all_of = lambda program: {w: median(program, w) for w in ("trace", "begin", "whole", "memory")}
        row = {"alhazen": all_of("alhazen")}
        line = f"{kind} {size}: alhazen {row['alhazen']['trace']:.3f} s"
        if seconds["povray"]:
            row["povray"] = all_of("povray")
            row["ratio"] = row["povray"]["trace"] / row["alhazen"]["trace"]
            row["different_pixels"] = differences(at("_alhazen.pfm"), at("_povray.ppm"))
            line += (f", povray {row['povray']['trace']:.3f} s, ratio {row['ratio']:.1f}, pixels that differ "
                     f"{row['different_pixels'] or 'none'} of {side ** 2}; reading {row['alhazen']['begin']:.3f} and {row['povray']['begin']:.3f} s, "
                     f"whole {row['alhazen']['whole']:.3f} and {row['povray']['whole']:.3f} s, "
                     f"{row['alhazen']['memory']:.0f} and {row['povray']['memory']:.0f} MB")
        row["rays_per_second"] = side ** 2 / row["alhazen"]["trace"]
        row["pixels"] = side ** 2
        results[scene] = row
        print(line, flush=True)
    if args.markdown:
        with open(args.markdown, "w", encoding="ascii") as out:
            out.writelines(markdown_row(scene, row) for scene, row in results.items())
    if args.json:
        with open(args.json, "w", encoding="ascii") as out:
            json.dump(results, out, indent=2)


if __name__ == "__main__":
    main()
