#!/usr/bin/env python3
"""Installs the library, builds the example against it, and runs the example.

Usage: library_install_test.py BUILD_FOLDER SOURCE_FOLDER TRACE_RAYS CONFIG PREFIXES [CMAKE_OPTION...]

Nothing of the library is built anew. TRACE_RAYS is the example as this build has it: the one against the
installed library must print the same. PREFIXES is where this build found its packages; CMAKE_OPTIONs say
how it compiles.
"""

import pathlib
import subprocess
import sys
import tempfile


def run(*command):
    """Returns the output of a command; ends the test if it fails."""
    command = [str(word) for word in command]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\nfailed with {done.returncode}:\n{done.stdout}")
    return done.stdout


def check_picture(picture, expected):
    rows = picture.splitlines()
    assert len(rows) == 20 and all(len(row) == 64 for row in rows), picture
    assert set(picture) == set(" -#oO\n"), picture
    # The eye lies in the ball's plane of symmetry, the light to the right of it.
    assert rows[8][31] in "oO" and rows[8][32] in "oO", picture
    assert sum(row[:32].count("#") for row in rows) > sum(row[32:].count("#") for row in rows), picture
    assert picture == expected, f"{picture}differs from that of the build:\n{expected}"


def main():
    build, source, trace_rays, config, prefixes = sys.argv[1:6]
    with tempfile.TemporaryDirectory(prefix="alhazen_install_") as folder:
        folder = pathlib.Path(folder)
        run("cmake", "--install", build, "--prefix", folder / "first", "--config", config)
        # The installed package must not contain its installation path.
        (folder / "first").rename(folder / "moved")
        example = folder / "example"
        run("cmake", "-S", pathlib.Path(source) / "examples" / "trace_rays", "-B", example,
            f"-DCMAKE_PREFIX_PATH={folder / 'moved'};{prefixes}", f"-DCMAKE_BUILD_TYPE={config}", *sys.argv[6:])
        run("cmake", "--build", example, "--config", config)
        check_picture(run(example / "trace_rays"), run(trace_rays))
        run(folder / "moved" / "bin" / "alhazen", "--version")
        for name in folder.rglob("alhazen*.cmake"):
            assert source not in name.read_text(encoding="utf-8"), f"{name} knows {source}"


if __name__ == "__main__":
    main()
