"""Scenes of blocks: vocabulary, errors at their places, files, pictures."""
import copy
import os
import pickle
import subprocess
import sys
import tempfile
import time
import unittest
import warnings

import numpy as np

import alhazen
from closed_forms import cube


def small_scene():
    vertices, faces = cube(-0.5, 0.5)
    scene = alhazen.Scene().add(
        alhazen.picture(width=64, height=48, background=(0.1, 0.1, 0.2)),
        alhazen.perspective_camera("main", eye=(0, -6, 2), look_at=(0, 0, 0.5), up=(0, 0, 1), fov_deg=40),
        alhazen.point_light(position=(3, -4, 6)),
        alhazen.solid_texture("marble", kind="marble", size=0.2),
        alhazen.material("stone", diffuse=alhazen.texture_input("marble", 0.8), specular=0.3, shininess=20),
        alhazen.plane("floor", normal=(0, 0, 1), point=(0, 0, -0.5)),
        alhazen.union("cross", alhazen.box(lo=(-1.5, -0.2, 0), hi=(-0.7, 0.2, 0.4)),
                      alhazen.sphere(center=(-1.1, 0, 0.4), radius=0.3), material="stone"))
    return scene.add_mesh(vertices, faces, name="cube", material="stone",
                          transform=[alhazen.rotate((0, 0, 1), 30), alhazen.translate(0.8, 0, 0)])


class Blocks(unittest.TestCase):
    def test_the_text_of_a_block_is_that_of_the_format(self):
        self.assertEqual(repr(alhazen.sphere("ball", center=(0, 0, 1), radius=0.5)),
                         'sphere "ball" { center = (0, 0, 1); radius = 0.5 }')
        self.assertEqual(repr(alhazen.environment(kind="sky")), "environment { kind = sky }")
        self.assertEqual(repr(alhazen.difference(alhazen.sphere(), alhazen.box(), cut_material="minuend")),
                         "difference { cut_material = minuend; sphere { }; box { } }")
        self.assertEqual(repr(alhazen.sphere(transform=np.eye(4))),
                         "sphere { transform = matrix((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), "
                         "(0.0, 0.0, 1.0, 0.0)) }")
        self.assertEqual(repr(alhazen.sphere('a"\n', visible_to=("eye", "shadow"))),
                         'sphere "a\\"\\n" { visible_to = (eye, shadow) }')

    def test_every_block_of_the_reader_has_a_function_with_its_keys(self):
        self.assertGreater(len(alhazen.blocks.VOCABULARY), 50)
        for name, _, keys in alhazen.blocks.VOCABULARY:
            made = getattr(alhazen, name)
            for key, *_ in keys:
                self.assertIn(f"- {key}", made.__doc__)
        keys = {name: [key for key, *_ in keys] for name, _, keys in alhazen.blocks.VOCABULARY}
        self.assertLessEqual({"center", "radius", "material", "transform"}, set(keys["sphere"]))
        self.assertLessEqual({"kind", "file", "turbidity"}, set(keys["environment"]))
        self.assertLessEqual({"eye", "fov_deg", "lens_radius"}, set(keys["perspective_camera"]))

    def test_errors_name_the_statement_that_made_the_block(self):
        def wrong():
            return alhazen.sphere(radus=2)

        line = wrong.__code__.co_firstlineno + 1
        with self.assertRaises(alhazen.SceneError) as caught:
            alhazen.Scene().add(alhazen.box(), wrong()).build()
        self.assertEqual(caught.exception.file, __file__)
        self.assertEqual(caught.exception.line, line)
        self.assertIn(f"scenes_test.py:{line}: error: sphere: unknown key 'radus'; known are", str(caught.exception))

    def test_errors_inside_of_a_block_and_of_the_whole_scene_have_places_too(self):
        inner = alhazen.plane()
        line = inner.origin[1]
        with self.assertRaisesRegex(alhazen.SceneError, f":{line}: error: plane bounds no volume"):
            alhazen.Scene().add(alhazen.difference(alhazen.sphere(), inner)).build()
        with self.assertRaisesRegex(alhazen.SceneError, 'material "gold" is not defined'):
            alhazen.Scene().add(alhazen.sphere(material="gold")).build()
        with self.assertRaisesRegex(alhazen.UsageError, "expected one of constant, picture, sky, studio"):
            alhazen.environment(kind="night")
        with self.assertRaisesRegex(alhazen.UsageError, "finite"):
            alhazen.Scene().add(alhazen.sphere(radius=float("nan"))).build()

    def test_meshes_of_arrays_are_parts_of_solids(self):
        vertices, faces = cube(-1, 1)
        scene = alhazen.Scene().add(alhazen.difference("hollow", alhazen.mesh(points=vertices, faces=faces),
                                                       alhazen.sphere(radius=0.5)))
        lo, hi = scene.measure("hollow", error=1e-3, time_limit=2)[0]["volume"]["interval"]
        self.assertTrue(lo < 8 - np.pi / 6 < hi)

    def test_text_of_a_name_cannot_leave_its_block(self):
        scene = alhazen.Scene().add(alhazen.sphere('x" { } box "y'))
        self.assertEqual(scene.geometry_names, ['x" { } box "y'])
        with self.assertRaises(alhazen.UsageError):
            alhazen.Block("sphere", **{"radius = 1 } box { hi": 3})


class Files(unittest.TestCase):
    def test_a_saved_scene_renders_to_the_same_bits(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.alhazen")
            scene = small_scene()
            self.assertIn(path, scene.save(path))
            again = alhazen.load(path)
            np.testing.assert_array_equal(again.render(), scene.render())
            self.assertEqual(again.geometry_names, scene.geometry_names)

    def test_a_picture_that_cannot_be_written_is_a_file_error(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "missing", "picture.png")
            with self.assertRaisesRegex(alhazen.FileError, "cannot write"):
                small_scene().render(width=4, height=4).save(path)

    def test_a_loaded_scene_can_be_extended(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.alhazen")
            small_scene().save(path)
            scene = alhazen.load(path).add(alhazen.sphere(center=(0, 0, 3), radius=0.5, material="stone"))
            vertices, faces = cube(5, 6)
            scene.add_mesh(vertices, faces, material="stone")
            self.assertEqual(float(scene.intersect([0, 0, 9, 0, 0, -1])["t_hit"]), 5.5)
            self.assertEqual(float(scene.intersect([5.2, 5.3, 9, 0, 0, -1])["t_hit"]), 3.0)
            scene.save(os.path.join(folder, "more.alhazen"))
            again = alhazen.load(os.path.join(folder, "more.alhazen"))
            np.testing.assert_array_equal(again.render(), scene.render())

    def test_mesh_files_hold_meshes_and_the_refusal_names_the_way_out(self):
        scene = alhazen.Scene(*cube()).add(alhazen.sphere(center=(5, 0, 0)))
        with tempfile.TemporaryDirectory() as folder:
            for suffix in ("ply", "obj", "stl"):
                path = os.path.join(folder, "meshes." + suffix)
                with self.assertRaisesRegex(alhazen.UsageError, "has 1 sphere: meshes_only=True leaves them out, "):
                    scene.save(path)
                with self.assertWarnsRegex(alhazen.SceneWarning, "left out"):
                    self.assertIn(path, scene.save(path, meshes_only=True))
                self.assertEqual(alhazen.load(path).info["triangles"], 12)
                self.assertEqual(alhazen.load(path).info["shapes"], 0)

    def test_saving_tells_what_the_file_does_not_hold(self):
        vertices, faces = cube()
        scene = alhazen.Scene().add(alhazen.mesh(points=vertices, faces=faces, visible_to="eye"))
        text = "mesh files do not keep the visibility masks of 1 part "
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "masked.ply")
            for strict in (scene, alhazen.Scene(strict=True).add(*scene._blocks)):
                with self.assertRaisesRegex(alhazen.SceneError, text):
                    strict.save(path, strict=True if strict is scene else None)
            self.assertEqual(os.listdir(folder), [])
            with self.assertWarnsRegex(alhazen.SceneWarning, text) as told:
                self.assertEqual(scene.save(path), [path])
            self.assertEqual(told.filename, __file__)
            with self.assertWarnsRegex(alhazen.SceneWarning, "left out, as they are not meshes: 1 sphere"):
                alhazen.Scene(vertices, faces).add(alhazen.sphere()).save(path, meshes_only=True)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                scene.save(os.path.join(folder, "masked.alhazen"), strict=True)

    def test_arrays_and_geometries_of_one_name_keep_apart(self):
        vertices, faces = cube()
        named = alhazen.geometry("array_0", points=vertices + 5, faces=faces)
        placed = alhazen.mesh("b", geometry="array_0")
        below = [[0.3, 0.4, 9, 0, 0, -1], [5.3, 5.4, 9, 0, 0, -1]]
        before = alhazen.Scene().add(named, placed).add_mesh(vertices, faces, name="a")
        after = alhazen.Scene().add_mesh(vertices, faces, name="a")
        copied = copy.copy(after)
        after.add(named, placed)
        for scene in (before, after):
            self.assertEqual(sorted(scene.geometry_names), ["a", "b"])
            names = [scene.geometry_names[i] for i in scene.intersect(below)["geometry_ids"]]
            self.assertEqual(names, ["a", "b"])
        self.assertEqual(copied.count_intersections(below).tolist(), [2, 0])

    def test_files_lie_in_the_folder_of_the_time_the_scene_was_made(self):
        here = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            alhazen.Scene(*cube()).save(os.path.join(folder, "cube.ply"))
            small_scene().save(os.path.join(folder, "scene.alhazen"))
            os.chdir(folder)
            try:
                made = alhazen.Scene().add(alhazen.mesh(file="cube.ply"))
                loaded = alhazen.load("scene.alhazen")
            finally:
                os.chdir(here)
            self.assertEqual(made.info["triangles"], 12)
            before = len(loaded.geometry_names)
            self.assertEqual(len(loaded.add(alhazen.mesh(file="cube.ply")).geometry_names), before + 1)

    def test_errors_of_a_file_have_its_line_and_column(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.alhazen")
            with open(path, "w") as file:
                file.write("alhazen 1\n\nsphere { radius = (1, 2) }\n")
            with self.assertRaises(alhazen.SceneError) as caught:
                alhazen.load(path)
            self.assertEqual((caught.exception.file, caught.exception.line, caught.exception.column), (path, 3, 19))
        with self.assertRaises(alhazen.FileError) as caught:
            alhazen.load("/nowhere/scene.alhazen")
        self.assertIsInstance(caught.exception, OSError)
        self.assertIn("/nowhere/scene.alhazen", str(caught.exception))


class Copies(unittest.TestCase):
    def both_kinds(self, folder):
        """A scene of blocks and arrays, and one that was loaded and extended."""
        path = os.path.join(folder, "scene.alhazen")
        small_scene().save(path)
        vertices, faces = cube(1, 2)
        loaded = alhazen.load(path).add(alhazen.sphere(center=(0, 0, 3), radius=0.5, material="stone"))
        return small_scene(), loaded.add_mesh(vertices, faces, normals=vertices, uvs=vertices[:, :2], material="stone")

    def test_copies_are_the_same_and_independent(self):
        with tempfile.TemporaryDirectory() as folder:
            for scene in self.both_kinds(folder):
                expected = scene.render()
                for make in (copy.copy, copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene))):
                    other = make(scene)
                    np.testing.assert_array_equal(other.render(), expected)
                    self.assertEqual(other.geometry_names, scene.geometry_names)
                    other.add(alhazen.sphere(radius=9))
                    self.assertNotEqual(other.geometry_names, scene.geometry_names)

    def test_pickles_need_no_file(self):
        with tempfile.TemporaryDirectory() as folder:
            scenes = self.both_kinds(folder)
            expected = [scene.render() for scene in scenes]
            data = pickle.dumps([*scenes, alhazen.load(os.path.join(folder, "scene.alhazen"))])
        program = ("import pickle, sys\n"
                   "pickle.dump([s.render() for s in pickle.load(sys.stdin.buffer)], sys.stdout.buffer)")
        result = subprocess.run([sys.executable, "-c", program], input=data, check=True, capture_output=True)
        one, two, loaded = pickle.loads(result.stdout)
        np.testing.assert_array_equal(one, expected[0])
        np.testing.assert_array_equal(two, expected[1])
        np.testing.assert_array_equal(loaded, expected[0])

    def test_pickles_hold_what_files_of_blocks_said(self):
        below = [[0.3, 0.4, 9, 0, 0, -1], [2.3, 0.4, 9, 0, 0, -1]]
        vertices, faces = cube()
        with tempfile.TemporaryDirectory() as folder:
            alhazen.Scene(vertices, faces).save(os.path.join(folder, "cube.ply"))
            scene = alhazen.Scene(folder=folder).add(
                alhazen.material("red", diffuse=(1, 0, 0)),
                alhazen.group(alhazen.mesh("a", file="cube.ply", material="red")))
            scene.add_mesh(vertices + (2, 0, 0), faces, name="b", material="red")
            expected, names = scene.intersect(below), scene.geometry_names
            data = pickle.dumps(scene)
        other = pickle.loads(data)
        self.assertEqual(other.geometry_names, names)
        for field, values in other.intersect(below).items():
            np.testing.assert_array_equal(values, expected[field])
        other.add(alhazen.sphere("more", material="red")).add_mesh(vertices, faces, name="c")
        self.assertEqual(other.geometry_names, [*names, "more", "c"])
        self.assertEqual(pickle.loads(pickle.dumps(other)).geometry_names, [*names, "more", "c"])

    def test_pickles_hold_the_meshes_of_point_keys(self):
        vertices, faces = cube()
        with tempfile.TemporaryDirectory() as folder:
            alhazen.Scene(vertices + (0, 0, 1), faces).save(os.path.join(folder, "higher.ply"))
            data = pickle.dumps(alhazen.Scene(folder=folder).add(
                alhazen.mesh("a", points=vertices, faces=faces, point_keys=[(0, vertices), (1, "higher.ply")])))
        self.assertEqual(pickle.loads(data).geometry_names, ["a"])

    def test_files_that_a_copy_names_lie_where_they_lay(self):
        with tempfile.TemporaryDirectory() as folder:
            self.both_kinds(folder)
            alhazen.Scene(*cube()).save(os.path.join(folder, "cube.ply"))
            scene = pickle.loads(pickle.dumps(alhazen.load(os.path.join(folder, "scene.alhazen"))))
            before = len(scene.geometry_names)
            scene.add(alhazen.mesh(file="cube.ply"))
            self.assertEqual(len(scene.geometry_names), before + 1)

    def test_pictures_keep_their_layers_and_errors_their_places(self):
        picture = small_scene().render(layers="depth")
        for other in (pickle.loads(pickle.dumps(picture)), copy.copy(picture), copy.deepcopy(picture)):
            np.testing.assert_array_equal(other, picture)
            np.testing.assert_array_equal(other.layers["depth.Z"], picture.layers["depth.Z"])
            self.assertEqual((other.notes, other.rays), (picture.notes, picture.rays))
        for kind in (alhazen.SceneError, alhazen.FileError, alhazen.UsageError):
            error = pickle.loads(pickle.dumps(kind("what is wrong", "scene.alhazen", 3, 4)))
            self.assertIs(type(error), kind)
            self.assertEqual((str(error), error.file, error.line, error.column),
                             ("what is wrong", "scene.alhazen", 3, 4))


class Pictures(unittest.TestCase):
    def test_messages_name_arguments_and_not_options_of_the_command_line(self):
        scene = small_scene()
        for arguments, words in (({"antialias": "whitted", "spp": 4}, "antialias chooses the samples of each pixel"),
                                 ({"sampler": "none"}, "sampler"), ({"environment": "sky"}, "environment requires"),
                                 ({"view": 3}, "view: expected (azimuth, elevation)"),
                                 ({"view": (1, 2, 3)}, "view: expected (azimuth, elevation)"),
                                 ({"layers": "none"}, "unknown AOV 'none'")):
            with self.assertRaises(alhazen.UsageError) as raised:
                scene.render(**arguments)
            self.assertIn(words, str(raised.exception))
            self.assertNotIn("--", str(raised.exception))

    def test_names_of_files_in_messages_stay(self):
        with self.assertRaises(alhazen.FileError) as raised:
            alhazen.load("no--spp.alhazen")
        self.assertIn("no--spp.alhazen", str(raised.exception))

    def test_a_picture_is_an_array_with_layers(self):
        picture = small_scene().render(layers=("depth", "N"))
        self.assertEqual((picture.shape, picture.dtype), ((48, 64, 3), np.float32))
        self.assertEqual(sorted(picture.layers), ["N.X", "N.Y", "N.Z", "depth.Z"])
        self.assertEqual(picture.layers["depth.Z"].shape, (48, 64))
        self.assertTrue(picture._repr_png_().startswith(b"\x89PNG"))
        self.assertIsNone(picture[0, 0]._repr_png_())
        self.assertTrue(picture.complete)

    def test_depth_holds_for_what_follows_paths(self):
        one, same, more = (small_scene().render(width=16, height=12, spp=1, **given) for given in (
            {"renderer": "path_tracing", "depth": 0}, {"renderer": "path_tracing:depth=1"}, {"renderer": "path_tracing"}))
        np.testing.assert_array_equal(one, same)
        self.assertTrue((one != more).any())

    def test_the_depth_layer_is_what_intersect_finds(self):
        scene = alhazen.Scene().add(
            alhazen.orthographic_camera(eye=(0, 0, 5), look_at=(0, 0, 0), up=(0, 1, 0), height=4),
            alhazen.sphere(radius=1), alhazen.ambient_light(color=1))
        depth = scene.render(40, 40, layers="depth").layers["depth.Z"]
        x = (np.arange(40) + 0.5) / 10 - 2
        rays = np.zeros((40, 40, 6))
        rays[..., 0], rays[..., 1], rays[..., 2], rays[..., 5] = x[None, :], -x[:, None], 5, -1
        np.testing.assert_allclose(depth, scene.intersect(rays)["t_hit"], rtol=1e-6)

    def test_a_scene_without_camera_and_light_gets_both(self):
        picture = alhazen.Scene(*cube()).render(32, 32)
        self.assertEqual(len(picture.notes), 2)
        self.assertGreater(picture.max(), 0.1)
        self.assertTrue(alhazen.Scene(*cube())._repr_png_().startswith(b"\x89PNG"))

    def test_progress_is_told_and_may_end_the_render(self):
        scene = small_scene()
        told = []
        scene.render(progress=lambda *report: told.append(report))
        self.assertEqual(told[-1][0], "render")
        self.assertEqual(told[-1][1], told[-1][2])

        class Enough(Exception):
            pass

        def stop(phase, done, total):
            raise Enough

        start = time.perf_counter()
        with self.assertRaises(Enough):
            scene.render(2000, 1500, spp=256, progress=stop)
        self.assertLess(time.perf_counter() - start, 20)

    def test_renderers_that_need_more_get_it(self):
        scene = small_scene()
        path = scene.render(16, 12, renderer="path_tracing", environment="studio", spp=2)
        self.assertTrue(path.complete and path.max() > 0)
        np.testing.assert_array_equal(scene.render(16, 12, renderer="distributed"),
                                      scene.render(16, 12, renderer="distributed", spp=16))
        smooth = scene.render(antialias="whitted:threshold=0.02,depth=2")
        self.assertFalse(np.array_equal(smooth, scene.render()))
        with self.assertRaisesRegex(alhazen.UsageError, "environment"):
            scene.render(environment="night", renderer="path_tracing")

    def test_values_of_the_wrong_type_are_usage_errors(self):
        scene = small_scene()
        with self.assertRaisesRegex(alhazen.UsageError, r"render: crop is \(1, 2\), which has the wrong type"):
            scene.render(8, 8, crop=(1, 2))
        with self.assertRaisesRegex(alhazen.UsageError, "render: width is 'a'"):
            scene.render("a", 8)

    def test_limits_of_rounds_are_numbers(self):
        scene = small_scene()
        for value in (-1, float("nan")):
            with self.assertRaisesRegex(alhazen.UsageError, "the noise to work for is .*; expected a number above 0"):
                scene.render(8, 6, noise=value)
            with self.assertRaisesRegex(alhazen.UsageError, "the time limit is .*; expected a number from 0"):
                scene.render(8, 6, time_limit=value)

    def test_settings_of_another_kind_are_usage_errors(self):
        for threads in (-1, 4097, 2**31, 2.5, "2", None):
            with self.assertRaisesRegex(alhazen.UsageError, "threads: expected a whole number from 0 to 4096"):
                alhazen.Scene(threads=threads)
        with self.assertRaisesRegex(alhazen.UsageError, "threads: expected a whole number"):
            small_scene().render(8, 6, threads=-1)
        with self.assertRaisesRegex(alhazen.UsageError, "Scene: build is 3, which has the wrong type"):
            alhazen.Scene(build=3).build()
        for name in ("\ud800", "a\udfffb"):
            with self.assertRaisesRegex(alhazen.UsageError, r"is no text: it has half a pair of surrogates"):
                alhazen.Scene().add(alhazen.sphere(name)).build()
        self.assertEqual(alhazen.Scene().add(alhazen.sphere("\U0001f52d")).geometry_names, ["\U0001f52d"])

    def test_crops_and_files(self):
        scene = small_scene()
        whole = scene.render()
        np.testing.assert_array_equal(scene.render(crop=(8, 4, 40, 20)), whole[4:20, 8:40])
        with tempfile.TemporaryDirectory() as folder:
            for suffix in ("png", "exr", "pfm"):
                whole.save(os.path.join(folder, "p." + suffix))
            with self.assertRaises(alhazen.UsageError):
                whole.save(os.path.join(folder, "p.gif"))


if __name__ == "__main__":
    unittest.main()
