#!/usr/bin/env python3
"""Installs the library, builds the example against it, and runs the example; the same for a program in C and for
Python, where the build has these.

Usage: library_install_test.py BUILD_FOLDER SOURCE_FOLDER TRACE_RAYS CONFIG PREFIXES [CMAKE_OPTION...]

The library is not rebuilt. TRACE_RAYS is the example of this build: the one built against the
installed library must print the same. PREFIXES: where this build found its packages; CMAKE_OPTIONs:
how it compiles.
"""

import os
import pathlib
import re
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


def check_exr(installed, folder):
    """The installed program finds its module of OpenEXR, which it loads with the first EXR picture."""
    module = next(installed.rglob("libalhazen_exr.so"), None)
    if module is None:  # linked to the program
        return
    program = installed / "bin" / "alhazen"
    scene, picture = folder / "ball.alhazen", folder / "ball.exr"
    scene.write_text("alhazen 1\nsphere { center = (0, 0, 0); radius = 1 }\n", encoding="ascii")
    command = ("render", scene, "-o", picture, "--size", "8x8", "-q")
    run(program, *command)
    assert picture.read_bytes().startswith(b"\x76\x2f\x31\x01")
    away = folder / "away.so"
    module.rename(away)
    # Reported before the work: this picture would take hours.
    command = ("render", scene, "-o", picture, "--size", "8192x8192", "--spp", "4096", "-q")
    lost = subprocess.run([program, *map(str, command)], capture_output=True, text=True, timeout=60)
    assert lost.returncode == 5 and "needs the module libalhazen_exr.so" in lost.stderr, lost
    module.write_bytes(b"no library")
    spoiled = subprocess.run([program, *map(str, command)], capture_output=True, text=True, timeout=60)
    assert spoiled.returncode == 5 and ("too short" in spoiled.stderr or "ELF" in spoiled.stderr), spoiled
    module.unlink()
    away.rename(module)


def check_c(installed, source, folder):
    """A program in C99 by pkg-config."""
    packages = next(installed.rglob("alhazen.pc"), None)
    if packages is None:
        return
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "alhazen"], check=True, capture_output=True, text=True,
                           env={**os.environ, "PKG_CONFIG_PATH": str(packages.parent)}).stdout.split()
    if packages.parent == installed / "lib" / "pkgconfig":  # CMAKE_INSTALL_LIBDIR as by default
        guide = (source / "docs" / "guide" / "c.md").read_text(encoding="utf-8")
        assert "PKG_CONFIG_PATH=PREFIX/lib/pkgconfig " in guide, "docs/guide/c.md: another folder than the installed one"
    library = next(installed.rglob("libalhazen.so")).parent
    program = folder / "api_test"
    run("cc", "-std=c99", "-o", program, source / "bindings" / "c" / "tests" / "api_test.c", *flags, "-lm",
        f"-Wl,-rpath,{library}")
    assert run(program) == "0 failures\n"


def check_python(installed):
    package = next(installed.rglob("alhazen/__init__.py"), None)
    if package is None:
        return
    code = "import alhazen; print(alhazen.Scene().add(alhazen.sphere()).intersect([0, 0, 5, 0, 0, -1])['t_hit'])"
    # The module was built for the system's Python (cmake/AlhazenPython.cmake).
    version = re.search(r"cpython-(\d)(\d+)", next(package.parent.glob("_alhazen*")).name)
    python = "/usr/bin/python3" if pathlib.Path("/usr/bin/python3").exists() else sys.executable
    number = run(python, "-c", "import sys; print(*sys.version_info[:2], sep='')").strip()
    if version and number == "".join(version.groups()):
        os.environ["PYTHONPATH"] = str(package.parent.parent)
        assert run(python, "-c", code) == "4.0\n"


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
        check_exr(folder / "moved", folder)
        check_c(folder / "moved", pathlib.Path(source), folder)
        check_python(folder / "moved")
        for name in folder.rglob("alhazen*.cmake"):
            assert source not in name.read_text(encoding="utf-8"), f"{name} knows {source}"


if __name__ == "__main__":
    main()
