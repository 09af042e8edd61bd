#!/usr/bin/env python3
"""Whole pictures compared with POV-Ray and Tachyon: same scene, 1024x1024, depth 5, one thread, in turn, medians.

Usage: bench/pictures/whole_pictures.py ALHAZEN DATA_FOLDER [--json FILE] [--rounds N] [--side N] [--keep FOLDER]
Peers that are not installed are skipped (scripts/setup --peers installs them).
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time

import peer_scenes


def commands(alhazen, scene, name, native, folder, side):
    """{program: command} for one scene; pictures go to `folder`."""
    picture = lambda program: os.path.join(folder, f"{name}_{program}.png")
    result = {"alhazen": [alhazen, "render", native, "-o", picture("alhazen"), "--size", f"{side}x{side}",
                          "--depth", "4", "-t", "1", "-q"]}
    if shutil.which("povray"):
        pov = os.path.join(folder, name + ".pov")
        peer_scenes.write_povray(scene, pov)
        result["povray"] = ["povray", f"+I{pov}", f"+O{picture('povray')}", f"+W{side}", f"+H{side}", "+WT1", "-D",
                            "-A", "-GA", "+FN"]
    if shutil.which("tachyon"):
        dat = os.path.join(folder, name + ".dat")
        peer_scenes.write_tachyon(scene, dat, side)
        result["tachyon"] = ["tachyon", dat, "-numthreads", "1", "-res", str(side), str(side), "-format", "PNG", "-o",
                             picture("tachyon")]
    return result


def measure(programs, rounds):
    seconds = {program: [] for program in programs}
    for round_number in range(rounds + 1):
        for program, command in programs.items():
            start = time.perf_counter()
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            if round_number > 0:  # the first round warms the file cache
                seconds[program].append(time.perf_counter() - start)
    return {p: {"median": statistics.median(s), "min": min(s), "max": max(s)} for p, s in seconds.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("data")
    parser.add_argument("--json")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--side", type=int, default=1024)
    parser.add_argument("--keep", help="folder for scenes and pictures (default: a temporary one)")
    args = parser.parse_args()
    folder = args.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    results = {}

    balls = os.path.join(args.data, "nff/spd_default/balls_s4.nff")
    bunny = os.path.join(args.data, "meshes/alecjacobson/data/stanford-bunny.obj")
    shutil.copy(bunny, os.path.join(folder, "bunny.obj"))
    bunny_scene = peer_scenes.read_obj(bunny)
    native = os.path.join(folder, "bunny.alhazen")
    peer_scenes.write_native_mesh(bunny_scene, native, "bunny.obj")
    for name, scene, file in (("balls", peer_scenes.read_nff(balls), balls), ("bunny", bunny_scene, native)):
        results[name] = measure(commands(args.alhazen, scene, name, file, folder, args.side), args.rounds)
        row = "  ".join(f"{p} {s['median']:.3f} s [{s['min']:.3f}, {s['max']:.3f}]" for p, s in results[name].items())
        print(f"{name}: {row}", flush=True)
    if args.json:
        with open(args.json, "w", encoding="ascii") as out:
            json.dump(results, out, indent=2)


if __name__ == "__main__":
    main()
