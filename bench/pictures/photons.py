#!/usr/bin/env python3
"""The cognac glass of scenes/light beside POV-Ray and its photons: time and noise, one thread, in turn.

Usage: bench/pictures/photons.py ALHAZEN [--side N] [--rounds N] [--caustics N] [--noise X] [--shadows N] [--spp N]
                        [--photons N] [--keep DIR]
Each program is compared with its own references, because their light differs: POV-Ray does not bounce light from wall
to table here. A reference is the mean of pictures with more photons and samples, whose photons differ from those of the
measured picture: in alhazen by the seed, in POV-Ray, which has no seed, by their number. Noise: the root mean squared
difference from that mean, less the remaining noise of the mean itself (estimated by the spread of its pictures; squares
are subtracted), in display values from 0 to 255; over all pixels, those around the caustic and those in the bowl. It
includes the bias of pictures with few photons, but no error that the references share. Deviation: the difference of two
pictures with the same settings and different photons, divided by the root of 2. But 1 %: the difference without the 1 %
of the pixels where it is largest. Times: processor seconds, the minimum over the rounds.
"""

import argparse
import math
import os
import resource
import shutil
import struct
import subprocess
import tempfile
import zlib

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
GLASS = [("line", (0, 0.004), (0.8, 0.004)), ("curve", (0.8, 0.004), (0.85, 0.004), (0.85, 0.05), (0.8, 0.06)),
         ("curve", (0.8, 0.06), (0.4, 0.1), (0.1, 0.12), (0.1, 0.3)),
         ("curve", (0.1, 0.3), (0.1, 0.42), (0.25, 0.46), (0.45, 0.55)),
         ("curve", (0.45, 0.55), (0.95, 0.77), (1.2, 1.1), (1.2, 1.5)),
         ("curve", (1.2, 1.5), (1.2, 2.0), (0.85, 2.3), (0.72, 2.7)),
         ("curve", (0.72, 2.7), (0.71, 2.73), (0.685, 2.73), (0.68, 2.7)),
         ("curve", (0.68, 2.7), (0.8, 2.28), (1.15, 1.98), (1.15, 1.5)),
         ("curve", (1.15, 1.5), (1.15, 1.13), (0.92, 0.82), (0.43, 0.61)),
         ("curve", (0.43, 0.61), (0.3, 0.55), (0.15, 0.52), (0, 0.52))]
# Slightly inside the glass: POV-Ray drops the colour of a body that overlaps another.
COGNAC = [("curve", (0, 0.523), (0.15, 0.523), (0.3, 0.553), (0.428, 0.612)),
          ("curve", (0.428, 0.612), (0.918, 0.822), (1.147, 1.132), (1.147, 1.5)),
          ("line", (1.147, 1.5), (1.147, 1.8)), ("line", (1.147, 1.8), (0, 1.8))]


def lathe(profile):
    """A POV-Ray lathe around z of lines and curves."""
    points = []
    for kind, *given in profile:
        if kind == "line":
            (ax, ay), (bx, by) = given
            given = [(ax + (bx - ax) * k / 3, ay + (by - ay) * k / 3) for k in range(4)]
        points += given
    listed = ", ".join(f"<{x:.6g}, {y:.6g}>" for x, y in points)
    return f"lathe {{ bezier_spline {len(points)}, {listed} sturm rotate 90*x }}"


def body(index, color, distance):
    """A transparent material with Fresnel reflection and Beer's law: exp(-(1 - fade_color) path / distance)."""
    short = 0.1
    fade = ", ".join(f"{1 + short * math.log(c) / distance:.6g}" for c in color)
    return (f"pigment {{ rgbf <1, 1, 1, 1> }} finish {{ ambient 0 diffuse 0 specular 0 reflection {{ 0, 1 fresnel on }} "
            f"conserve_energy }} interior {{ ior {index} fade_distance {short} fade_power 1001 fade_color <{fade}> }}")


def write_povray(path, photons):
    fall = 0.05  # light falls by 2 / (1 + (d / fall)^2), twice the square of fall over that of the distance
    lamp = [radiance * 0.25 ** 2 / (2 * fall ** 2) for radiance in (330, 310, 280)]
    room = [radiance * 36 / 3.14159265 / (2 * fall ** 2) for radiance in (0.6, 0.65, 0.75)]
    rgb = lambda c: "rgb <" + ", ".join(f"{x:.6g}" for x in c) + ">"
    glows = lambda *c: f"pigment {{ {rgb((1, 1, 1))} }} finish {{ ambient 0 diffuse 0 emission {rgb(c)} }}"
    table = "pigment { rgb <0.55, 0.47, 0.4> } finish { ambient 0 diffuse 1 }"
    with open(path, "w", encoding="ascii") as out:
        out.write(f"""#version 3.7;
global_settings {{ assumed_gamma 1.0 max_trace_level 24 ambient_light 0
                  photons {{ count {photons} autostop 0 max_trace_level 24 }} }}
camera {{ location <0.9, -8.4, 5.2> sky z right -x up z angle 30 look_at <0.35, 0.1, 0.95> }}
light_source {{ <-5, 2.5, 6.5> {rgb(lamp)} fade_distance {fall} fade_power 2
               area_light 0.5*x, 0.5*y, 4, 4 circular orient adaptive 1 jitter
               looks_like {{ sphere {{ 0, 0.25 {glows(330, 310, 280)} }} }}
               photons {{ reflection on refraction on }} }}
light_source {{ <0, -6, 9> {rgb(room)} fade_distance {fall} fade_power 2
               area_light 6*x, 6*y, 4, 4 adaptive 1 jitter photons {{ reflection off refraction off }}
               looks_like {{ polygon {{ 5, <-3, -3>, <3, -3>, <3, 3>, <-3, 3>, <-3, -3>
                                        {glows(0.6, 0.65, 0.75)} }} }} }}
polygon {{ 5, <-9, -9>, <9, -9>, <9, 9>, <-9, 9>, <-9, -9> {table} }}
polygon {{ 5, <-9, 0>, <9, 0>, <9, 9>, <-9, 9>, <-9, 0> rotate 90*x translate 7*y {table} }}
#declare Glass = object {{ {lathe(GLASS)} {body(1.5, (0.9, 0.96, 0.94), 6)} }}
#declare Cognac = intersection {{ {lathe(COGNAC)} plane {{ z, 1.15 }} {body(1.36, (0.92, 0.5, 0.1), 1)} }}
object {{ Glass photons {{ target reflection on refraction on collect off }} }}
object {{ Cognac photons {{ target reflection on refraction on collect off }} }}
""")


def processor_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def pixels(path, side):
    """The bytes (red, green, blue) of an 8-bit PNG picture."""
    with open(path, "rb") as source:
        data = source.read()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            assert struct.unpack(">IIBB", data[at + 8:at + 18]) == (side, side, 8, 2), path
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    rows, width = zlib.decompress(packed), 3 * side
    above, shown = bytearray(width), bytearray()
    for y in range(side):
        kind, row = rows[y * (width + 1)], bytearray(rows[y * (width + 1) + 1:(y + 1) * (width + 1)])
        for x in range(width):
            left, up, corner = (row[x - 3], above[x], above[x - 3]) if x >= 3 else (0, above[x], 0)
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda value: abs(guess - value))
            row[x] = (row[x] + (0, left, up, (left + up) // 2, nearest)[kind]) & 255
        shown += row
        above = row
    return bytes(shown)


def parts(side):
    """Pixels by name: all, the lower right, where the caustic lies, and the bowl."""
    places = [(x, y) for y in range(side) for x in range(side)]
    bowl = lambda x, y: ((x / side - 0.43) / 0.225) ** 2 + ((y / side - 0.36) / 0.23) ** 2 < 1
    return {"all": places, "caustic": [(x, y) for x, y in places if 2 * x >= side and 2 * y >= side],
            "bowl": [(x, y) for x, y in places if bowl(x, y)]}


def squared_difference(a, b, side, places):
    """The mean squared difference over pixels and channels."""
    at = [3 * (y * side + x) + c for x, y in places for c in range(3)]
    return sum((a[i] - b[i]) ** 2 for i in at) / len(at)


def noise(picture, references, side, places):
    """The noise of a picture compared with the mean of references, and the noise of that mean."""
    count = len(references)
    mean = [sum(values) / count for values in zip(*references)]
    own = sum(squared_difference(r, mean, side, places) for r in references) / (count - 1) / count
    return max(0.0, squared_difference(picture, mean, side, places) - own) ** 0.5, own ** 0.5


def but_hundredth(picture, references, side, places):
    """The difference from the mean of references without the 1 % of the pixels where it is largest."""
    mean = [sum(values) / len(references) for values in zip(*references)]
    squares = sorted(squared_difference(picture, mean, side, [place]) for place in places)
    kept = squares[:int(0.99 * len(squares))]
    return (sum(kept) / len(kept)) ** 0.5


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("--side", type=int, default=160)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--caustics", type=int, default=1200000, help="photons of the caustic map of alhazen")
    parser.add_argument("--noise", type=float, default=0.08, help="of alhazen, as --noise of render")
    parser.add_argument("--split", type=float, default=0.2, help="of alhazen, as split of photon_mapping")
    parser.add_argument("--shadows", type=int, default=1, help="of alhazen, as shadows of photon_mapping")
    parser.add_argument("--spp", type=int, default=160, help="of alhazen, at most")
    parser.add_argument("--photons", type=int, default=200000, help="of POV-Ray")
    parser.add_argument("--long", type=int, default=6, help="times the photons of references, ours at half of --noise")
    parser.add_argument("--references", type=int, default=2, help="of each program, 2 or more")
    parser.add_argument("--keep", help="folder for scenes and pictures (default: a temporary one)")
    args = parser.parse_args()
    if args.references < 2:
        parser.error(f"--references {args.references}, expected 2 or more: their noise is known by their differences")
    least = {"--photons": 2, "--long": 2, "--side": 1, "--rounds": 1, "--spp": 1}
    for name, few in least.items():
        if getattr(args, name[2:]) < few:
            parser.error(f"{name} {getattr(args, name[2:])}, expected {few} or more")
    if not shutil.which("povray"):
        raise SystemExit("povray is not installed: scripts/setup --peers")
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    at = lambda name: os.path.join(folder, name)
    counts = {"povray": args.photons, "povray_other": args.photons * 199 // 200}
    for k in range(args.references):
        counts[f"povray_long{k}"] = args.long * args.photons * (3 * args.references - k) // (3 * args.references)
    for name, count in counts.items():
        write_povray(at(name + ".pov"), count)

    def povray(scene, out, more):
        return ["povray", f"+I{at(scene)}", f"+O{at(out)}", f"+W{args.side}", f"+H{args.side}", "+WT1", "-D", "-GA",
                "+FN", "File_Gamma=sRGB"] + more

    def alhazen(out, times, noise, seed):
        renderer = (f"photon_mapping:caustics={times * args.caustics},photons={times * 150000},nearest=150,"
                    f"irradiance=on,every=4,clamp=1,roulette=16,split={args.split},shadows={args.shadows}")
        return [args.alhazen, "render", os.path.join(ROOT, "scenes/light/cognac.alhazen"), "-o", at(out), "--size",
                f"{args.side}x{args.side}", "-t", "1", "-q", "--renderer", renderer, "--spp", str(args.spp),
                "--noise", str(noise), "--seed", str(seed)]

    usual, fine = ["+A0.1", "+AM1", "+R3"], ["+A0.0", "+AM1", "+R4"]
    long = [f"_long{k}" for k in range(args.references)]
    runs = {"povray" + k: povray(f"povray{k}.pov", f"povray{k}.png", fine if k in long else usual)
            for k in ["", "_other"] + long}
    runs.update({"alhazen": alhazen("alhazen.png", 1, args.noise, 1),
                 "alhazen_other": alhazen("alhazen_other.png", 1, args.noise, 2)})
    runs.update({f"alhazen{k}": alhazen(f"alhazen{k}.png", args.long, 0.5 * args.noise, 11 + i)
                 for i, k in enumerate(long)})
    seconds = {name: min(processor_seconds(run) for _ in range(args.rounds if name in ("povray", "alhazen") else 1))
               for name, run in runs.items()}
    for name in ("povray", "alhazen"):
        show = lambda more: pixels(at(name + more + ".png"), args.side)
        picture, other, references = show(""), show("_other"), [show(k) for k in long]
        print(f"{name}: {seconds[name]:.2f} s, references {seconds[name + long[0]]:.0f} s each")
        for part, places in parts(args.side).items():
            beside, own = noise(picture, references, args.side, places)
            deviation = (0.5 * squared_difference(picture, other, args.side, places)) ** 0.5
            print(f"  {part}: noise {beside:.2f} (references {own:.2f}), deviation {deviation:.2f}, "
                  f"but 1 % {but_hundredth(picture, references, args.side, places):.2f}", flush=True)


if __name__ == "__main__":
    main()
