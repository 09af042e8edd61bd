"""The interfaces of trimesh and Open3D, and the package as such."""
import ast
import doctest
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from types import SimpleNamespace

import numpy as np

import alhazen
import alhazen.raycasting
import alhazen.trimesh
from closed_forms import cube, random_rays


class Trimesh(unittest.TestCase):
    def setUp(self):
        vertices, faces = cube(-0.5, 0.5)
        self.mesh = SimpleNamespace(vertices=vertices, faces=faces)
        self.ray = alhazen.trimesh.RayMeshIntersector(self.mesh)
        rays = random_rays(2000)
        self.origins, self.directions = rays[:, :3], rays[:, 3:]

    def test_all_locations_lie_on_their_triangles_and_rays(self):
        locations, index_ray, index_tri = self.ray.intersects_location(self.origins, self.directions)
        self.assertEqual(locations.shape, (len(index_ray), 3))
        corners = self.mesh.vertices[self.mesh.faces[index_tri]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        np.testing.assert_allclose(((locations - corners[:, 0]) * normals).sum(axis=1), 0, atol=1e-12)
        offset = locations - self.origins[index_ray]
        np.testing.assert_allclose(np.cross(offset, self.directions[index_ray]), 0, atol=1e-11)
        self.assertTrue((np.bincount(index_ray) % 2 == 0).all())

    def test_first_hits_are_among_all_hits(self):
        first = self.ray.intersects_first(self.origins, self.directions)
        any_hit = self.ray.intersects_any(self.origins, self.directions)
        np.testing.assert_array_equal(first >= 0, any_hit)
        index_tri, index_ray = self.ray.intersects_id(self.origins, self.directions)
        starts = np.searchsorted(index_ray, np.flatnonzero(any_hit))
        np.testing.assert_array_equal(index_tri[starts], first[any_hit])
        once_tri, once_ray, locations = self.ray.intersects_id(self.origins, self.directions, multiple_hits=False,
                                                               return_locations=True)
        np.testing.assert_array_equal(once_ray, np.flatnonzero(any_hit))
        np.testing.assert_array_equal(once_tri, first[any_hit])
        self.assertEqual(locations.shape, (any_hit.sum(), 3))

    def test_contained_points_are_those_of_the_cube(self):
        points = np.random.default_rng(2).uniform(-1, 1, (500, 3))
        expected = (np.abs(points) < 0.5).all(axis=1)
        np.testing.assert_array_equal(self.ray.contains_points(points), expected)
        # A face is missing, but not one that the lines through these points cross.
        open_mesh = SimpleNamespace(vertices=self.mesh.vertices, faces=self.mesh.faces[:-1])
        inner = np.array([[0.0, 0.0, -0.4], [0.0, 0.0, 2.0]])
        np.testing.assert_array_equal(alhazen.trimesh.RayMeshIntersector(open_mesh).contains_points(inner),
                                      [True, False])

    def test_wrong_shapes_are_errors(self):
        with self.assertRaises(alhazen.UsageError):
            self.ray.intersects_any(np.zeros((3, 3)), np.zeros((2, 3)))


class Open3D(unittest.TestCase):
    def test_two_cubes_have_ids_and_all_queries_agree(self):
        scene = alhazen.raycasting.RaycastingScene()
        for i, low in enumerate((0.0, 3.0)):
            vertices, faces = cube(low, low + 1)
            self.assertEqual(scene.add_triangles(vertices.astype(np.float32), faces.astype(np.uint32)), i)
        rays = np.float32([[[0.2, 0.3, 9, 0, 0, -1], [3.2, 3.3, 9, 0, 0, -1], [9, 9, 9, 0, 0, -1]]])
        hits = scene.cast_rays(rays)
        self.assertEqual(hits["t_hit"].tolist(), [[8, 5, np.inf]])
        self.assertEqual(hits["geometry_ids"].tolist(), [[0, 1, scene.INVALID_ID]])
        self.assertEqual(hits["primitive_normals"][0, 0].tolist(), [0, 0, 1])
        self.assertEqual(scene.count_intersections(rays).tolist(), [[2, 2, 0]])
        self.assertEqual(scene.test_occlusions(rays).tolist(), [[True, True, False]])
        self.assertEqual(scene.test_occlusions(rays, tfar=6).tolist(), [[False, True, False]])
        self.assertEqual(scene.test_occlusions(rays, tnear=7).tolist(), [[True, False, False]])
        lists = scene.list_intersections(rays)
        self.assertEqual(lists["ray_splits"].tolist(), [0, 2, 4, 4])
        self.assertEqual(lists["t_hit"].tolist(), [8, 9, 5, 6])
        self.assertEqual(scene.compute_occupancy(np.float32([[0.5, 0.5, 0.5], [2, 2, 2]])).tolist(), [1, 0])

    def test_pinhole_rays_pass_through_the_middles_of_pixels(self):
        rays = alhazen.raycasting.RaycastingScene.create_rays_pinhole(90, [0, 0, 0], [0, -2, 0], [0, 0, 1], 4, 2)
        self.assertEqual((rays.shape, rays.dtype), ((2, 4, 6), np.float32))
        np.testing.assert_allclose(rays[0, 0], [0, -2, 0, -0.75, 1, 0.25], atol=1e-6)
        np.testing.assert_allclose(rays[1, 3], [0, -2, 0, 0.75, 1, -0.25], atol=1e-6)


class Package(unittest.TestCase):
    def test_the_examples_of_the_docstrings_hold(self):
        tried = 0
        for name in ("alhazen", "alhazen._scene", "alhazen.trimesh", "alhazen.raycasting", "alhazen.blocks"):
            result = doctest.testmod(importlib.import_module(name))
            self.assertEqual(result.failed, 0)
            tried += result.attempted
        self.assertGreater(tried, 8)

    def test_stubs_have_every_block_with_its_keys(self):
        with open(os.path.join(os.path.dirname(alhazen.__file__), "blocks.pyi"), encoding="utf-8") as file:
            functions = {node.name: node for node in ast.parse(file.read()).body if isinstance(node, ast.FunctionDef)}
        for name, _, keys in alhazen.blocks.VOCABULARY:
            self.assertEqual([argument.arg for argument in functions[name].args.kwonlyargs], [key for key, *_ in keys])
            self.assertEqual(ast.get_docstring(functions[name]), getattr(alhazen, name).__doc__)

    def test_public_functions_are_documented(self):
        for owner in (alhazen, alhazen.Scene, alhazen.trimesh.RayMeshIntersector, alhazen.raycasting.RaycastingScene):
            names = owner.__all__ if owner is alhazen else [n for n in vars(owner) if not n.startswith("_")]
            for name in names:
                if name not in ("INVALID_ID",):
                    self.assertTrue(getattr(owner, name).__doc__, f"{owner} {name}")

    def test_a_wheel_holds_all_of_the_package(self):
        folder = os.path.dirname(os.path.abspath(__file__))
        sys.path.insert(0, os.path.join(folder, "..", "tools"))
        import wheel_backend
        with tempfile.TemporaryDirectory() as place:
            name = wheel_backend.pack(os.path.dirname(alhazen.__file__), place)
            with zipfile.ZipFile(os.path.join(place, name)) as wheel:
                self.assertIsNone(wheel.testzip())
                wheel.extractall(place)
            env = {**os.environ, "PYTHONPATH": place}
            code = "import alhazen; print(alhazen.__file__, alhazen.Scene().add(alhazen.box()).measure()[0]['name'])"
            output = subprocess.run([sys.executable, "-c", code], env=env, check=True, capture_output=True,
                                    text=True).stdout
            self.assertEqual(output.split(), [os.path.join(place, "alhazen", "__init__.py"), "box"])

    def test_errors_are_those_of_python_too(self):
        for kind, python in ((alhazen.UsageError, ValueError), (alhazen.SceneError, ValueError),
                             (alhazen.FileError, OSError), (alhazen.ResourceError, MemoryError),
                             (alhazen.RenderError, RuntimeError)):
            self.assertTrue(issubclass(kind, alhazen.Error) and issubclass(kind, python))

    @unittest.skipUnless(shutil.which("mypy"), "mypy is not installed")
    def test_types_of_the_package_hold(self):
        result = subprocess.run(["mypy", "--python-executable", sys.executable, "--ignore-missing-imports",
                                 "--cache-dir", os.devnull, os.path.dirname(alhazen.__file__)],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
