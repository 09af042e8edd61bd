"""Common parts of the command line tests: the program, a small scene, a folder for output."""

import os
import subprocess
import sys
import tempfile
import unittest

ALHAZEN, SOURCE = sys.argv[1:3]

SPHERES = """alhazen 1
perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.5, 0); up = (0, 1, 0); fov_deg = 40 }
perspective_camera "top" { eye = (0, 9, 0.1); look_at = (0, 0, 0); up = (0, 1, 0); fov_deg = 40 }
point_light { position = (3, 5, 4); color = (1, 1, 1) }
material "mirror" { diffuse = 0.1; reflective = 0.8 }
sphere { center = (0, 1, 0); radius = 1; material = "mirror" }
plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }
"""


def run(*arguments, **options):
    # Everything is piped, so that colours and progress of a terminal have no effect.
    return subprocess.run([ALHAZEN, *arguments], capture_output=True, text=True, timeout=120, **options)


def processor_seconds(pid):
    """The processor time of a running program and its threads; how busy the machine is does not change it."""
    with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class CommandLineCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene = self.write("scene with space.alhazen", SPHERES)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def render(self, *arguments, output="out.png", size="64x48"):
        return run("render", self.scene, "-o", self.path(output), "--size", size, *arguments)
