#!/usr/bin/env python3
"""Converts from the command line: preserved data, rejected input, remaining files.

Usage: conversions_test.py ALHAZEN SOURCE_FOLDER
"""

import json
import math
import os
import pathlib
import random
import resource
import struct
import sys
import unittest

from command_line import CommandLineCase, run, SOURCE, SPHERES


class Conversions(CommandLineCase):
    def test_a_converted_scene_renders_to_the_same_bits(self):
        scene = os.path.join(SOURCE, "scenes", "showcase.alhazen")
        os.mkdir(self.path("new"))
        result = run("convert", scene, self.path("new/copy.alhazen"))
        self.assertEqual((result.returncode, result.stdout), (0, ""))
        self.assertIn("copy.alhazen: 12 triangles", result.stderr)
        self.assertEqual(sorted(os.listdir(self.path("new"))), ["copy.alhazen", "copy_files"])
        os.rename(self.path("new"), self.path("moved"))
        pictures = []
        for path in scene, self.path("moved/copy.alhazen"):
            self.assertEqual(run("render", path, "-q", "-o", self.path("out.pfm"), "--size", "48x27").returncode, 0)
            pictures.append(self.read("out.pfm"))
        self.assertEqual(pictures[0], pictures[1])

    def test_meshes_are_converted_and_shapes_only_dropped_when_asked(self):
        for suffix in "ply", "obj", "stl":
            out = self.path("out." + suffix)
            scene = os.path.join(SOURCE, "scenes", "showcase.alhazen")
            result = run("convert", scene, out)
            self.assertEqual(result.returncode, 2)
            self.assertRegex(result.stderr, "also has 8 spheres, 1 plane, .*: --tolerance X makes triangles of them, --meshes-only "
                                            "leaves them out, .alhazen keeps everything")
            result = run("convert", scene, out, "--tolerance", "0.5")
            self.assertEqual(result.returncode, 3)
            self.assertRegex(result.stderr, "no triangles: .*\n--meshes-only leaves them out, .alhazen keeps them")
            self.assertFalse(os.path.exists(out))
            result = run("convert", scene, out, "--meshes-only")
            self.assertEqual(result.returncode, 0)
            self.assertIn("warning: left out, as they are not meshes: 8 spheres", result.stderr)
            self.assertEqual(run("convert", scene, out, "--meshes-only", "-q").stderr, "")
            info = json.loads(run("info", out, "--json").stdout)
            self.assertEqual(info["triangles"], 12)

    def test_shapes_and_solids_become_triangles_within_a_tolerance(self):
        scene = self.write("solid.alhazen", '''alhazen 1
sphere { center = (3, 0, 0); radius = 1 }
superellipsoid { center = (-3, 0, 0); east = 0.5; north = 0.5 }
difference "bored" {
    transform = translate(0, 4, 0)
    box { lo = (-1, -1, -1); hi = (1, 1, 1) }
    cylinder { base = (0, 0, -2); top = (0, 0, 2); radius = 0.5 }
}
''')
        result = run("convert", scene, self.path("out.ply"), "--tolerance", "0.05")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("3 shapes became", result.stderr)
        for place, added in (100, "3\\.71e-06"), (1e7, None):
            far = self.write("far.alhazen", f"alhazen 1\nsphere {{ center = ({place}, 0, 0) }}\n")
            result = run("convert", far, self.path("far.stl"), "--tolerance", "0.05")
            self.assertRegex(result.stderr, "1 shape became .* within 0.05 of it, and the file's "
                             "floats move corners by up to " + (added or "0\\.503"))
            self.assertEqual("more than the tolerance of 0.05" in result.stderr, added is None)
        volumes = []
        for path in scene, self.path("out.ply"):
            result = run("measure", path, "--error", "1e-3", "--json", self.path("measured.json"))
            self.assertEqual(result.returncode, 0, result.stderr)
            solids = json.loads(self.read("measured.json"))["solids"]
            volumes.append(sum(solid["volume"]["value"] for solid in solids))
        exact, volume = volumes
        self.assertAlmostEqual(volume, exact, delta=0.05 * (12.6 + 12 + 29))

    def test_triangles_have_the_textures_of_the_shapes(self):
        self.write_waves("waves.pfm")
        shapes = {
            "sphere": "sphere { radius = 1; MATERIAL }",
            "ellipsoid": "ellipsoid { axis_a = (1, 0, 0); axis_b = (0, 0.7, 0.3); axis_c = (0, 0, 0.7); MATERIAL }",
            "disc": "disc { radius = 1; inner_radius = 0.4; MATERIAL }",
            "cylinder": "cylinder { base = (0, -0.8, 0); top = (0, 0.8, 0.3); radius = 0.7; MATERIAL }",
            "cone": "cone { base = (0, -0.8, 0); top = (0, 0.8, 0.3); base_radius = 0.8; MATERIAL }",
            "torus": "torus { major_radius = 0.7; minor_radius = 0.25; MATERIAL }",
            "paraboloid": "paraboloid { transform = scale(0.8); MATERIAL }",
            "box": "box { lo = (-0.8, -0.7, -0.6); hi = (0.6, 0.7, 0.8); MATERIAL }",
            "polygon": "polygon { vertices = [(-1, -1, 0), (1, -1, 0), (0, 1, 0)]; MATERIAL }",
            "height_field": "height_field { columns = 3; heights = [0, 0.1, 0.2, 0.1, 0.3, 0.2, 0, 0.4, 0.1]; lo = (-1, -1); hi = (1, 1); MATERIAL }",
            "lathe": "lathe { profile = [(0, -0.9), (0.9, -0.9), curve((0.9, 0), (0.5, 0.8), (0.3, 0.8)), (0, 0.8)]; MATERIAL }",
            "steiner_patch": "steiner_patch { points = [(-1, -1, 0), (0, -1, 0.5), (0, 0, 0), (0, -0.5, 0.2), (0.5, 0.5, 0), (0, 1, 0)]; MATERIAL }",
            "superellipsoid": "superellipsoid { east = 0.8; north = 0.8; MATERIAL }",
            "blob": "blob { components = [sphere((-0.2, 0, 0), 1.2, 1), sphere((0.4, 0, 0), 1, 1)]; MATERIAL }",
            "prism": "prism { profile = [(-0.7, -0.7), (0.7, -0.7), curve((0.7, 0), (0.7, 0.7), (0, 0.7)), (-0.7, -0.7)]; h0 = -0.5; h1 = 0.5; MATERIAL }",
            "difference": "difference { MATERIAL; box { lo = (-0.8, -0.8, -0.8); hi = (0.8, 0.8, 0.8) } sphere { center = (0.8, 0.8, 0.8); radius = 0.7 } }",
            "mirrored": "object \"o\" { sphere { radius = 0.8; MATERIAL } torus { major_radius = 0.9; minor_radius = 0.1; MATERIAL } } instance \"o\" { transform = scale(-1, 1, 1) }",
            "nurbs_surface": "nurbs_surface { degree_u = 1; degree_v = 1; knots_u = [0, 0, 2, 2]; knots_v = [0, 0, 1, 1]; points = [(-1, -1, 0), (-1, 1, 0), (1, -1, 0), (1, 1, 0)]; transform = scale(-1, 1, 1); MATERIAL }",
        }
        for name, text in shapes.items():
            with self.subTest(name):
                scene = self.textured(text.replace("MATERIAL", 'material = "m"'))
                exact = self.picture(scene, "ray_casting")
                for way in "beam_tracing", "OBJ":
                    if way == "OBJ":
                        scene = self.back_from_obj(scene, "--tolerance", "0.01")
                    picture = self.picture(scene, "ray_casting" if way == "OBJ" else "beam_tracing:tolerance=0.01")
                    both = [k for k in range(0, len(exact), 3) if exact[k] != 0 and picture[k] != 0]
                    self.assertGreater(len(both), 100, way)
                    off = sum(max(abs(exact[k + c] - picture[k + c]) for c in range(3)) > 0.1 for k in both)
                    self.assertLess(off, 0.02 * len(both), way)

    def write_waves(self, name):
        """A picture that repeats without a seam and differs by u, by v, and by their directions."""
        size, wave = 64, lambda turns: 0.55 + 0.4 * math.sin(2 * math.pi * turns)
        texels = [[wave(x / size), wave(x / size + 0.25), wave(y / size + 0.1)] for y in range(size) for x in range(size)]
        data = b"".join(struct.pack("<3f", *texel) for texel in texels)
        with open(self.path(name), "wb") as file:
            file.write(b"PF\n%d %d\n-1.0\n" % (size, size) + data)

    VIEW = ("alhazen 1\northographic_camera { eye = (3, 4, 10); look_at = (0, 0, 0); up = (0, 1, 0); height = 3; aspect = 1 }\n"
            "ambient_light { color = 1 }\n")

    def picture(self, path, renderer):
        result = run("render", path, "-q", "-o", self.path("out.pfm"), "--size", "48x48", "--renderer", renderer)
        self.assertEqual(result.returncode, 0, result.stderr)
        return struct.unpack("<%df" % (3 * 48 * 48), self.read("out.pfm")[-12 * 48 * 48:])

    def textured(self, text):
        return self.write("shape.alhazen", self.VIEW + 'texture "t" { file = "waves.pfm"; filter = mipmapped }\n'
                          'material "m" { diffuse = texture("t"); ambient = texture("t") }\n' + text + "\n")

    def back_from_obj(self, scene, *options):
        result = run("convert", scene, self.path("out.obj"), *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = run("convert", self.path("out.obj"), self.path("back.alhazen"))
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.write("viewed.alhazen", self.read("back.alhazen").decode().replace("alhazen 1\n", self.VIEW, 1))

    def test_mirrored_patches_keep_their_textures_in_an_obj(self):
        self.write_waves("waves.pfm")
        net = "degree_u = 1; degree_v = 2; points = [(-1, -1, 0), (-1, 0, 0.5), (-1, 1, 0), (1, -1, 0), (0.9, 0, 0), (0.8, 1, 0)]"
        for text in ("bezier_patch { " + net, "nurbs_surface { knots_u = [1, 1, 3, 3]; knots_v = [0, 0, 0, 1, 1, 1]; " + net,
                     "nurbs_surface { knots_u = [1, 1, 3, 3]; knots_v = [0, 0, 0, 1, 1, 1]; "
                     "trims = [[polyline((1.1, 0.1), (2.5, 0.2), (2, 0.9), (1.1, 0.1))]]; " + net):
            with self.subTest(text):
                both = "%s; material = \"m\" }\n" % text
                scene = self.textured(both.replace("}", "; transform = scale(-1, 1, 1) }"))
                exact, back = self.picture(scene, "ray_casting"), self.picture(self.back_from_obj(scene), "ray_casting")
                self.assertGreater(sum(value != 0 for value in exact), 300)
                self.assertLess(max(abs(a - b) for a, b in zip(exact, back)), 1e-4)

    def test_an_obj_loses_the_normal_map_of_mirrored_patches_alone(self):
        self.write_waves("waves.pfm")
        for transform, loses in ("scale(-1, 1, 1)", True), ("scale(1, -1, -1)", False):
            scene = self.write("mapped.alhazen", '''alhazen 1
texture "t" { file = "waves.pfm" }
material "m" { normal_map = texture("t") }
bilinear_patch { material = "m"; transform = %s }
''' % transform)
            result = run("convert", scene, self.path("out.obj"), "--strict")
            self.assertEqual(result.returncode, 3 if loses else 0, result.stderr)
            self.assertEqual("error: the MTL file cannot express the normal map of mirrored patches (material 'm')" in result.stderr, loses)

    def test_solids_tell_what_they_lose_of_their_meshes(self):
        corners = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
        for names, values, told in (("x y z", "", ""), ("x y z u2 v2", " 0.5 0.5", "second texture coordinates"),
                                    ("x y z red green blue", " 1 0.5 0", "vertex colours")):
            self.write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 4\n"
                       + "".join("property float %s\n" % name for name in names.split())
                       + "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                       + "".join("%g %g %g%s\n" % (*corner, values) for corner in corners)
                       + "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n")
            scene = self.write("cut.alhazen", 'alhazen 1\ndifference "cut" { mesh { file = "mesh.ply" } '
                               "sphere { radius = 0.5 } }\n")
            result = run("convert", scene, self.path("out.ply"), "--tolerance", "0.1")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stderr.count("warning: "), 1 if told else 0, result.stderr)
            self.assertIn(told, result.stderr)
            result = run("convert", scene, self.path("out.ply"), "--tolerance", "0.1", "--strict", "-q")
            self.assertEqual(result.returncode, 3 if told else 0, result.stderr)

    def test_what_is_thinner_than_the_tolerance_is_told(self):
        small = ('difference "small" { box { lo = (8, 8, 8); hi = (8.5, 8.5, 8.5) } '
                 "box { lo = (8.1, 8.1, 8.1); hi = (9, 9, 9) } }\n")
        told = 'small: no triangles: the solid is empty or thinner than the tolerance'
        scene = self.write("thin.alhazen", "alhazen 1\nbox { lo = (0, 0, 0); hi = (5, 5, 5) }\n" + small)
        result = run("convert", scene, self.path("out.ply"), "--tolerance", "2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("thin.alhazen:3:1: " + told, result.stderr)
        self.assertRegex(result.stderr, r"1 shape became \d+ triangles within 2 of it")
        result = run("convert", scene, self.path("strict.ply"), "--tolerance", "2", "--strict", "-q")
        self.assertEqual(result.returncode, 3)
        self.assertIn(told, result.stderr)
        alone = self.write("alone.alhazen", "alhazen 1\n" + small)
        result = run("convert", alone, self.path("alone.ply"), "--tolerance", "2")
        self.assertEqual(result.returncode, 3)
        self.assertIn("warning: ", result.stderr)
        self.assertIn(told, result.stderr)
        self.assertIn("the scene has no triangles to write", result.stderr)

    def test_parts_that_are_too_thin_are_told(self):
        text = ('alhazen 1\nunion "pin" {{ sphere {{ radius = 1 }} '
                "cylinder {{ base = (1.5, 0.3, -2); top = (1.5, 0.5, 2); radius = {} }} }}\n")
        for radius, told in ("0.0002", True), ("0.05", False):
            scene = self.write("pin.alhazen", text.format(radius))
            result = run("convert", scene, self.path("out.ply"), "--tolerance", "0.02")
            self.assertEqual(result.returncode, 0, result.stderr)
            line = "warning: " + scene + ":2:1: pin: 1 of its parts and gaps is thinner than the tolerance and left out"
            self.assertEqual(line in result.stderr, told, result.stderr)
            self.assertEqual(result.stderr.count("warning: "), int(told), result.stderr)

    def test_what_has_no_triangles_is_refused_or_stays(self):
        scene = self.write("plane.alhazen", "alhazen 1\nsphere { radius = 1 }\nplane \"floor\" { point = (0, -1, 0) }\n")
        result = run("convert", scene, self.path("out.ply"), "--tolerance", "0.1")
        self.assertEqual(result.returncode, 3)
        self.assertIn("plane.alhazen:3:1: error: plane 'floor': no triangles: the shape is endless", result.stderr)
        self.assertFalse(os.path.exists(self.path("out.ply")))
        for out in "out.alhazen", "out.ply":
            options = ["--meshes-only"] if out.endswith("ply") else []
            result = run("convert", scene, self.path(out), "--tolerance", "0.1", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("warning: ", result.stderr)
            self.assertIn("plane 'floor': no triangles", result.stderr)
        info = json.loads(run("info", self.path("out.alhazen"), "--json").stdout)
        self.assertEqual(info["parts"], {"mesh": 1, "plane": 1})
        for bad in "0", "-1", "nan", "x":
            result = run("convert", scene, self.path("bad.ply"), "--tolerance", bad)
            self.assertEqual(result.returncode, 2, bad)

    def test_a_picture_never_replaces_a_file_of_the_scene(self):
        self.assertEqual(self.render(output="wood.png", size="8x8").returncode, 0)
        os.rename(self.path("wood.png"), self.path("wood.depth.png"))
        wood = self.read("wood.depth.png")
        scene = self.write("wood.alhazen", SPHERES + 'texture "wood" { file = "wood.depth.png" }\n')
        os.symlink("wood.depth.png", self.path("link.png"))
        for arguments in (["-o", self.path("wood.depth.png")], ["-o", self.path("link.png")],
                          ["-o", self.path("wood.png"), "--aov", "depth"],
                          ["-o", self.path("new.png"), "--stats", self.path("wood.depth.png")],
                          ["-o", self.path("new.png"), "--stats", scene]):
            result = run("render", scene, "--size", "8x8", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn("belongs to the scene", result.stderr)
        self.assertEqual(self.read("wood.depth.png"), wood)
        self.assertFalse(os.path.exists(self.path("new.png")))
        self.assertEqual(run("render", scene, "--size", "8x8", "-o", self.path("new.png")).returncode, 0)

    def test_a_failed_conversion_leaves_nothing_behind(self):
        self.render(output="dot.png", size="1x1")
        # The image is below the limit of 600 bytes, the scene above.
        scene = self.write("s.alhazen", SPHERES + 'texture "t" { file = "dot.png" }\n')
        before = sorted(os.listdir(self.folder.name))
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (600, 600))
        result = run("convert", scene, self.path("out.alhazen"), preexec_fn=limit)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder.name)), before)

    def test_an_obj_tells_what_its_materials_cannot_say(self):
        self.render(output="dot.png", size="4x4")
        scene = self.write("s.alhazen", """alhazen 1
texture "t" { file = "dot.png"; wrap_u = mirror; wrap_v = mirror }
material "m" { diffuse = texture("t") }
mesh { material = "m"; points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]; faces = [[0, 1, 2]]
    uvs = [(0, 0), (1, 0), (0, 1)] }
""")
        result = run("convert", scene, self.path("out.obj"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: the MTL file cannot express the mirrored repeat of a texture (material 'm'", result.stderr)
        os.remove(self.path("out.obj"))
        result = run("convert", scene, self.path("out.obj"), "--strict")
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("error: the MTL file cannot express the mirrored repeat of a texture", result.stderr)
        self.assertFalse(os.path.exists(self.path("out.obj")))

    def test_cut_faces_keep_their_material_in_an_obj(self):
        scene = self.write("cut.alhazen", """alhazen 1
material "red" { diffuse = (1, 0, 0) }
material "blue" { diffuse = (0, 0, 1) }
difference "e" { box { material = "red" } cylinder { base = (0, 0, -1); top = (0, 0, 1); radius = 0.3; material = "blue" } }
""")
        result = run("convert", scene, self.path("out.obj"), "--tolerance", "0.05")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("warning", result.stderr)
        text = self.read("out.obj").decode()
        self.assertIn("usemtl red\n", text)
        self.assertIn("usemtl blue\n", text)

    def test_convert_refuses_what_it_cannot_write(self):
        for arguments, status, message in (
            ([self.scene, self.path("out.gltf")], 2, ".alhazen (the whole scene), .ply .obj .stl"),
            ([self.scene, self.path("out")], 2, ".alhazen (the whole scene), .ply .obj .stl"),
            ([self.scene, self.scene], 2, "is the scene itself"),
            ([self.path("missing.obj"), self.path("out.ply")], 4, "missing.obj"),
            ([self.scene, self.path("no folder/out.alhazen")], 4, "no folder"),
            ([self.scene, self.path("out.ply"), "--meshes-only"], 3, "no triangles"),
        ):
            result = run("convert", *arguments)
            self.assertEqual(result.returncode, status, arguments)
            self.assertIn(message, result.stderr)
        self.assertEqual(self.read("scene with space.alhazen").decode(), SPHERES)

    def test_a_conversion_that_fails_leaves_the_one_before_as_it_was(self):
        def textured(name, seed):
            with open(self.path(name + ".bmp"), "wb") as file:
                pixels = random.Random(seed).randbytes(3 * 64 * 64)
                file.write(b"BM" + struct.pack("<IIIIiiHHIIiiII", 54 + len(pixels), 0, 54, 40, 64, 64, 1, 24, 0, 0, 0, 0, 0, 0))
                file.write(pixels)
            with open(self.path(name + ".alhazen"), "w", encoding="utf-8") as file:
                file.write('alhazen 1\ntexture "t" { file = "%s.bmp" }\n'
                           'rectangle { material = { diffuse = texture("t") } }\n' % name)
            return self.path(name + ".alhazen")

        def files():
            folder = self.path("out_files")
            return {name: pathlib.Path(folder, name).read_bytes() for name in os.listdir(folder)}

        self.assertEqual(run("convert", textured("first", 1), self.path("out.alhazen")).returncode, 0)
        before, scene = files(), self.read("out.alhazen")
        self.assertTrue(before)
        second = textured("second", 2)
        with open(second, "a", encoding="utf-8") as file:
            file.write("".join(f"sphere {{ center = ({i}, 5, 0); radius = 0.1 }}\n" for i in range(2000)))

        def limit():  # the texture fits, the scene does not
            resource.setrlimit(resource.RLIMIT_FSIZE, (40000, 40000))

        self.assertEqual(run("convert", second, self.path("out.alhazen"), preexec_fn=limit).returncode, 4)
        self.assertTrue(files() == before and self.read("out.alhazen") == scene)
        self.assertEqual(run("convert", second, self.path("out.alhazen")).returncode, 0)
        self.assertTrue(files() != before)
        self.assertEqual(sorted(files()), sorted(before))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
