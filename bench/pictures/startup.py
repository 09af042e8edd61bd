#!/usr/bin/env python3
"""Time from the start of the program to the first ray of a small scene, milliseconds.

Usage: bench/pictures/startup.py ALHAZEN [--rounds N] [--threads N]
A picture of one pixel: the time of the whole process, less that of writing the picture (as `--stats` tells it). So it
is an upper bound: shading, the statistics and the exit are in it. The files are in memory (/dev/shm), where that is
mounted: the wait until a disk has the statistics is no part of a start. Beside it the process /bin/true, which does
nothing. Time on the clock, and processor time of the whole process.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time

SCENE = """alhazen 1
perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.5, 0); up = (0, 1, 0); fov_deg = 40 }
point_light { position = (3, 5, 4); color = (1, 1, 1) }
sphere { center = (0, 1, 0); radius = 1; material = { diffuse = (0.1, 0.4, 0.8) } }
plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }
"""


def seconds_of(command):
    """(on the clock, of the processor) of a process."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    end = time.perf_counter()
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{command[0]} failed")
    return end - begin, usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("alhazen")
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    memory = "/dev/shm"
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as folder:
        scene, stats = os.path.join(folder, "small.alhazen"), os.path.join(folder, "stats.json")
        with open(scene, "w", encoding="ascii") as file:
            file.write(SCENE)
        command = [args.alhazen, "render", scene, "-o", os.path.join(folder, "out.pfm"), "--size", "1x1", "-q",
                   "-t", str(args.threads), "--no-counts", "--stats", stats]
        rows = {"first ray": [], "/bin/true": []}
        for round_number in range(args.rounds + 1):
            clock, processor = seconds_of(command)
            with open(stats, encoding="ascii") as file:
                clock -= json.load(file)["seconds"]["write"]
            nothing = seconds_of(["/bin/true"])
            if round_number > 0:  # the first round warms the file cache
                rows["first ray"].append((clock, processor))
                rows["/bin/true"].append(nothing)
    for name, times in rows.items():
        clock, processor = ([1e3 * t[i] for t in times] for i in (0, 1))
        print(f"{name}: on the clock {statistics.median(clock):.1f} [{min(clock):.1f}, {max(clock):.1f}], "
              f"processor {statistics.median(processor):.1f} [{min(processor):.1f}, {max(processor):.1f}]")


if __name__ == "__main__":
    main()
