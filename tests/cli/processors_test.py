#!/usr/bin/env python3
"""Scenes of scenes/ on emulated processors: the program begins, and its pictures have the bytes of this machine's.

An instruction that the emulated processor lacks ends the program (SIGILL), wherever it stands: also outside of the kernels
that are chosen at run time. A processor without the least instruction set must get a message.

Usage: processors_test.py ALHAZEN SOURCE_FOLDER [PATTERN]    PATTERN: only runs whose arguments match it
ALHAZEN_TEST_THOROUGH=1: every renderer in every scene; else two of them and one other, in turn.
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ALHAZEN, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
PATTERN = re.compile(sys.argv[3] if len(sys.argv) > 3 else "")
THOROUGH = os.environ.get("ALHAZEN_TEST_THOROUGH") == "1"
# Kernels for SSE4 (the second with AVX, which no kernel uses), for AVX2; the emulator has no AVX-512.
PROCESSORS = ("Westmere", "IvyBridge", "Haswell")
# Without SSE4.2, and with it but without AES and PCLMUL.
TOO_OLD = ("qemu64", "Conroe", "Nehalem")
SETTINGS = {"photon_mapping": ":photons=2000,caustics=1000,gather=4,cache=0.3", "sppm": ":photons=1000",
            "vcm": ":photons=200", "path_tracing": ":manifold=on"}
WITHOUT_SAMPLES = {"beam_tracing", "cone_tracing", "lane_carpenter", "clark"}


def emulated(processor):
    return ["qemu-x86_64", "-cpu", processor]


def renderers():
    text = subprocess.run([ALHAZEN, "list", "renderers"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  (\w+) ", text, re.MULTILINE)


def scenes():
    return sorted(path for path in (SOURCE / "scenes").rglob("*") if path.suffix in (".alhazen", ".bpt", ".obj"))


def renderings():
    names = renderers()
    always = ["whitted", "path_tracing"]
    others = [name for name in names if name not in always]
    for i, scene in enumerate(scenes()):
        for name in names if THOROUGH else [*always, others[i % len(others)]]:
            samples = [] if name in WITHOUT_SAMPLES else ["--spp", "2"]
            yield [scene, "--size", "16x12", "--threads", "2", "--quiet", *samples, "--renderer", name + SETTINGS.get(name, "")]


def rendered(prefix, arguments):
    """Exit status, picture, messages."""
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "o.pfm"
        result = subprocess.run([*prefix, ALHAZEN, "render", *map(str, arguments), "-o", picture], timeout=1200,
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
        return result.returncode, picture.read_bytes() if picture.exists() else b"", result.stderr


def fault(arguments):
    """What is wrong with a picture, or nothing."""
    status, picture, _ = rendered([], arguments)
    for processor in PROCESSORS:
        there, other, said = rendered(emulated(processor), arguments)
        if there != status:
            return f"{processor}: exit {there}, here {status}: {said[-1000:]}"
        if other != picture:
            return f"{processor}: another picture"
    return None


def main():
    failures = []
    for processor in TOO_OLD:
        status, _, said = rendered(emulated(processor), [SOURCE / "scenes" / "one_plane.alhazen"])
        if status != 2 or "needs (SSE4.2, AES and PCLMUL)" not in said:
            failures.append(f"{processor}: exit {status}: {said[-1000:]}")
            print("FAILED", failures[-1], flush=True)
    runs = [r for r in renderings() if PATTERN.search(" ".join(map(str, r)))]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for arguments, wrong in zip(runs, pool.map(fault, runs)):
            if wrong:
                failures.append(f"alhazen render {' '.join(map(str, arguments))}: {wrong}")
                print("FAILED", failures[-1], flush=True)
    print(f"{len(runs)} pictures on {len(PROCESSORS)} processors, {len(failures)} failed")
    return 1 if failures or not runs else 0


sys.exit(main())
