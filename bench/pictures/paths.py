#!/usr/bin/env python3
"""Measures the part of path tracing that is ray queries: the rays of a picture by the kernels and by the renderer.

Usage: bench/pictures/paths.py ALHAZEN PATH_BENCH DATA [--scenes NAME,...] [--keep DIR] [options of alhazen_path_bench]
Writes the scenes of light_scenes.py and runs alhazen_path_bench on them (path_bench.cpp describes the measurement).
"""

import argparse
import os
import subprocess
import tempfile

from light import write_sky
from light_scenes import HEAVY, SCENES, write_alhazen


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("path_bench")
    parser.add_argument("data")
    parser.add_argument("--scenes", default="cornell,sponza,interior,heavy_interior,many_lights")
    parser.add_argument("--keep", help="folder for the scenes (default: a temporary one)")
    args, options = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.keep or temporary
        os.makedirs(folder, exist_ok=True)
        files = []
        for name in args.scenes.split(","):
            scene = (SCENES | HEAVY)[name](args.data)
            files.append(os.path.join(folder, name + ".alhazen"))
            if scene.sky:
                write_sky(args.alhazen, os.path.join(folder, scene.sky))
            write_alhazen(scene, files[-1])
        subprocess.run([args.path_bench, *files, *options], check=True)


if __name__ == "__main__":
    main()
