#!/usr/bin/env python3
"""Names and kinds in what the command line writes: text, JSON, pages.

Usage: names_test.py ALHAZEN SOURCE_FOLDER
"""

import json
import os
import unittest

from command_line import CommandLineCase, run

CAMERA = 'perspective_camera { eye = (0, -6, 0); look_at = (0, 0, 0); up = (0, 0, 1) }\n'


class Names(CommandLineCase):
    def test_info_tells_of_every_kind_of_texture_and_camera(self):
        scene = self.write("kinds.alhazen", """alhazen 1
fisheye_camera "f" { eye = (0, 0, 5); look_at = (0, 0, 0) }
panorama_camera "p" { eye = (0, 0, 5); look_at = (0, 0, 0) }
orthographic_camera "o" { eye = (0, 0, 5); look_at = (0, 0, 0); up = (0, 1, 0); height = 2 }
solid_texture "w" { kind = checks }
sphere { radius = 1; material = { diffuse = texture("w") } }
""")
        result = run("info", scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("w: solid, checks", result.stdout)
        self.assertIn("f: fisheye, 180 x 180 degrees", result.stdout)
        self.assertIn("p: panorama, 360 x 180 degrees", result.stdout)
        self.assertNotIn("unknown", result.stdout)

    def test_a_name_cannot_begin_a_line_of_output(self):
        scene = self.write("lines.alhazen", 'alhazen 1\n' + CAMERA + 'sphere "s\\nX: area 9" { radius = 1 }\n')
        for arguments in (["section", scene, "--plane", "0,1,0,0.5"], ["measure", scene, "--time-limit", "0.05"]):
            result = run(*arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("s\\x0aX: area 9", result.stdout)
        torus = 'torus "t\\nX" { axis = (0, 0, 1); major_radius = 1; minor_radius = 0.3 }\n'
        solid = self.write("solid.alhazen", 'alhazen 1\n' + CAMERA + torus)
        refused = run("render", solid, "-o", self.path("o.png"), "--renderer", "beam_tracing")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("t\\x0aX", refused.stderr)

    def test_reports_of_files_whose_names_are_no_text(self):
        name = os.fsencode(self.folder.name) + b"/a\xff.alhazen"
        with open(name, "wb") as file:
            file.write(("alhazen 1\n" + CAMERA + "sphere { radius = 1 }\n").encode())
        data, page = self.path("c.json"), self.path("c.html")
        result = run("compare", name, "--accelerators", "list", "--no-tuning", "--time-limit", "0.05", "--size", "8x6",
                     "--json", data, "--html", page, "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(self.read(data))["scenes"][0]["scene"], "a\ufffd.alhazen")
        self.assertIn("a\\xff.alhazen", self.read(page).decode("utf-8"))

    def test_compare_writes_ascii(self):
        scene = self.write("\u00e9.alhazen", "alhazen 1\n" + CAMERA + "sphere { radius = 1 }\n")
        data = self.path("c.json")
        result = run("compare", scene, "--accelerators", "list", "--no-tuning", "--time-limit", "0.05", "--size", "8x6",
                     "--json", data, "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.read(data).isascii())
        self.assertEqual(json.loads(self.read(data))["scenes"][0]["scene"], "\u00e9.alhazen")


if __name__ == "__main__":
    unittest.main(argv=["names_test.py"], verbosity=2)
