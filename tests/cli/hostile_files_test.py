#!/usr/bin/env python3
"""Gives every file of a folder to the command line: as a scene to render and, when it may be a picture, as a
picture to compare with itself and as the texture of a small scene.

No file may crash it, take more than 10 seconds of processor time or more than 1 GiB; it must end with an image or with one
of the documented statuses and a message that names the file.

Usage: hostile_files_test.py ALHAZEN FOLDER [--table FILE.md]     exit 77 (skipped) when there is no such folder
"""

import collections
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# Sanitizers make programs slower and larger (tests/cli/CMakeLists.txt).
SLOWDOWN = int(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))
MAX_SECONDS = 10 * SLOWDOWN
MAX_CPU = int(MAX_SECONDS * max(2, os.cpu_count()))
MAX_MEMORY = (1 << 30) * min(SLOWDOWN, 4)
PICTURES = {".png", ".jpg", ".jpeg", ".exr", ".hdr", ".bmp", ".tga", ".dds", ".ico", ".webp", ".raw", ""}
TEXTURED = """alhazen 1
perspective_camera { eye = (0, 0, 3); look_at = (0, 0, 0) }
directional_light { direction = (0, 0, -1) }
texture "t" { file = "%s" }
rectangle { material = { diffuse = texture("t") } }
"""


class Outcome:
    def __init__(self, arguments):
        with tempfile.TemporaryFile() as errors:
            begin = time.monotonic()
            process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=errors)
            # A file that causes a hang ends the process by its limit of processor time, or here by the clock: much later,
            # because a busy machine lets a process wait.
            resource.prlimit(process.pid, resource.RLIMIT_CPU, (MAX_CPU, MAX_CPU))
            signal.signal(signal.SIGALRM, lambda *_: process.kill())
            signal.alarm(12 * MAX_SECONDS)
            _, status, usage = os.wait4(process.pid, 0)
            signal.alarm(0)
            process.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            self.message = errors.read(1 << 20).decode("utf-8", "replace")
        self.status = process.returncode
        # The smaller of both: a busy machine lengthens the time by the clock, threads that of the processors.
        self.clock = time.monotonic() - begin
        self.seconds = min(usage.ru_utime + usage.ru_stime, self.clock)
        self.memory = usage.ru_maxrss * 1024

    def faults(self, allowed):
        if self.status not in allowed:
            yield f"exit {self.status}"
        if self.seconds > MAX_SECONDS or self.clock > 6 * MAX_SECONDS:
            yield f"{self.seconds:.1f} s of work, {self.clock:.1f} s by the clock"
        if self.memory > MAX_MEMORY:
            yield f"{self.memory >> 20} MiB"
        if self.status != 0 and not self.message.strip():
            yield "no message"


def attempts(alhazen, path, folder):
    """Name, arguments, accepted statuses, image that must exist after status 0."""
    out = os.path.join(folder, "out.png")
    yield "scene", [alhazen, "render", "-q", str(path), "-o", out, "--size", "32x32"], {0, 3, 5}, out
    if path.suffix.lower() not in PICTURES and not path.suffix.lower().endswith("exr"):
        return
    yield "picture", [alhazen, "diff", str(path), str(path)], {0, 2, 3, 4, 5}, None
    shutil.copy(path, os.path.join(folder, "texture"))
    scene = os.path.join(folder, "scene.alhazen")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(TEXTURED % "texture")
    yield "texture", [alhazen, "render", "-q", scene, "-o", out, "--size", "32x32"], {0, 3, 5}, out


def main():
    alhazen, root = sys.argv[1], pathlib.Path(sys.argv[2])
    table = sys.argv[4] if len(sys.argv) > 4 and sys.argv[3] == "--table" else None
    if not root.is_dir():
        print(f"skipped: no folder {root}")
        return 77
    failures, rows, counts = [], [], collections.Counter()
    slowest = largest = 0
    for path in sorted(p for p in root.rglob("*") if p.is_file()):
        for name, arguments, allowed, picture in attempts_in_folder(alhazen, path):
            outcome = Outcome(arguments)
            faults = list(outcome.faults(allowed))
            if outcome.status == 0 and picture and not os.path.exists(picture):
                faults.append("no picture")
            counts[f"{name}: exit {outcome.status}"] += 1
            slowest, largest = max(slowest, outcome.seconds), max(largest, outcome.memory)
            first_line = outcome.message.strip().split("\n")[0].replace(str(root) + "/", "")
            rows.append((str(path.relative_to(root)), name, outcome.status, first_line))
            if faults:
                failures.append(f"{path.relative_to(root)} as a {name}: {', '.join(faults)}: {first_line}")
    for line in sorted(f"{count:5} {what}" for what, count in counts.items()):
        print(line)
    print(f"slowest {slowest:.2f} s, largest {largest >> 20} MiB")
    if table:
        with open(table, "w", encoding="utf-8") as file:
            file.write("| file | given as | exit | message |\n|---|---|---|---|\n")
            for row in rows:
                file.write("| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |\n")
    for failure in failures:
        print("FAILED", failure)
    return 1 if failures else 0


def attempts_in_folder(alhazen, path):
    with tempfile.TemporaryDirectory() as folder:
        for attempt in attempts(alhazen, path, folder):
            yield attempt
            for leftover in ("out.png",):
                if os.path.exists(os.path.join(folder, leftover)):
                    os.remove(os.path.join(folder, leftover))


if __name__ == "__main__":
    sys.exit(main())
