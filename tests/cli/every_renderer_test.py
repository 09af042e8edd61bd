#!/usr/bin/env python3
"""Every scene of scenes/ by every renderer, small, and by the other commands; accelerators, builds, and the end by a signal.

For programs with sanitizers above all (`scripts/sanitize light`): whatever the picture shows, the program ends with a
documented status, a refusal says why, and no sanitizer reports anything.

Usage: every_renderer_test.py ALHAZEN SOURCE_FOLDER [PATTERN]    PATTERN: only runs whose arguments match it
"""

import concurrent.futures
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

ALHAZEN, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PATTERN = re.compile(sys.argv[3] if len(sys.argv) > 3 else "")
SLOWDOWN = int(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))
SMALL = ["--size", "12x12", "--threads", "4", "--quiet"]
# Photons are many unless few are asked for.
SETTINGS = {"photon_mapping": ":photons=2000,caustics=1000,gather=4,cache=0.3", "sppm": ":photons=1000",
            "vcm": ":photons=200", "path_tracing": ":manifold=on"}
WITHOUT_SAMPLES = {"beam_tracing", "cone_tracing", "lane_carpenter", "clark"}
# A report of a sanitizer ends the program with this status, which no command has.
REPORT = 99
REPORTS = re.compile(r"\w+Sanitizer|runtime error:|terminate called|Assertion")
ENVIRONMENT = dict(os.environ)
for variable in ("ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"):
    ENVIRONMENT[variable] = f"{os.environ.get(variable, '')}:exitcode={REPORT}"


def names(what):
    text = subprocess.run([ALHAZEN, "list", what], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  (\w+) ", text, re.MULTILINE)


def scenes():
    return sorted(path for path in (SOURCE / "scenes").rglob("*") if path.suffix in (".alhazen", ".bpt", ".obj"))


def renderings():
    for scene in scenes():
        for renderer in names("renderers"):
            samples = [] if renderer in WITHOUT_SAMPLES else ["--spp", "2"]
            yield ["render", scene, "-o", "o.png", *SMALL, *samples, "--renderer", renderer + SETTINGS.get(renderer, "")]


def commands():
    for scene in scenes():
        yield ["info", scene, "--all"]
        yield ["measure", scene, "--time-limit", "0.1", "--quiet"]
        yield ["inside", scene, "--point", "0,0,0", "--point", "0.1,0.5,-0.2", "--quiet"]
        yield ["section", scene, "--plane", "0,0,1,0.1", "--grid", "24", "--time-limit", "0.1", "--svg", "o.svg", "--quiet"]
        yield ["verify", scene, "--rays", "200", "--quiet"]
        yield ["explain", scene, "--pixel", "5,6", "--size", "12x12", "-o", "o.html", "--quiet"]
        yield ["vector", scene, "--size", "64x64", "--tolerance", "0.1", "-o", "o.svg", "--quiet"]
        for output in ("o.alhazen", "o.ply", "o.obj", "o.stl", "o.bpt"):
            yield ["convert", scene, output]


def accelerators():
    for scene in ("showcase", "solids", "cornell"):
        path = SOURCE / "scenes" / f"{scene}.alhazen"
        for name in names("accelerators"):
            yield ["render", path, "-o", "o.png", *SMALL, "--accelerator", name]
        for quality in ("fast", "default", "high"):
            for width in ("4", "8", "16"):
                yield ["render", path, "-o", "o.png", *SMALL, "--build", quality, "--width", width]
        yield ["render", path, "-o", "o.png", *SMALL, "--csg", "roth"]
        for rounds in (["--time-limit", "1s"], ["--noise", "0.1"]):
            yield ["render", path, "-o", "o.png", *SMALL, "--renderer", "path_tracing", "--spp", "32", *rounds]
        for layers in (["--renderer", "path_tracing:polarization=on"], ["--renderer", "path_tracing", "--spectral"], []):
            yield ["render", path, "-o", "o.exr", *SMALL, "--aov", "all", *layers]


def fault(arguments):
    """What is wrong with a run, or nothing."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            result = subprocess.run([ALHAZEN, *map(str, arguments)], cwd=folder, env=ENVIRONMENT, timeout=120 * SLOWDOWN,
                                    stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
        except subprocess.TimeoutExpired:
            return "takes too long"
    output = result.stdout + result.stderr
    if result.returncode not in (0, 1, 2, 3) or REPORTS.search(output):
        return f"exit {result.returncode}: {output[-4000:]}"
    return None if result.returncode == 0 or output.strip() else f"exit {result.returncode} without a word"


def interrupted():
    """A rendering that SIGINT stops while tiles are rendered writes what is done and exits with 75."""
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "o.png")
        process = subprocess.Popen(
            [ALHAZEN, "render", SOURCE / "scenes" / "cornell.alhazen", "-o", picture, "--size", "64x64", "--threads", "4",
             "--renderer", "path_tracing", "--spp", "100000"],
            env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(1 + 0.5 * SLOWDOWN)
        process.send_signal(signal.SIGINT)
        output = process.communicate(timeout=60 * SLOWDOWN)[1]
        if process.returncode != 75 or REPORTS.search(output):
            return f"exit {process.returncode}: {output[-4000:]}"
    return None


def main():
    runs = [r for r in [*renderings(), *commands(), *accelerators()] if PATTERN.search(" ".join(map(str, r)))]
    failures = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for arguments, wrong in zip(runs, pool.map(fault, runs)):
            if wrong:
                failures.append(f"alhazen {' '.join(map(str, arguments))}: {wrong}")
                print("FAILED", failures[-1], flush=True)
    if wrong := interrupted():
        failures.append(wrong)
        print("FAILED the end by SIGINT:", wrong)
    print(f"{len(runs) + 1} runs, {len(failures)} failed")
    return 1 if failures or not runs else 0


sys.exit(main())
