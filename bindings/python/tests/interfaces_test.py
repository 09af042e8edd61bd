"""The interfaces of trimesh and Open3D."""
import pathlib
import tempfile
import unittest
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

    def test_masked_numbers_are_errors(self):
        masked, message = np.ma.masked_greater(self.origins, 0), "some numbers are masked"
        for query in (self.ray.intersects_any, self.ray.intersects_first):
            with self.assertRaisesRegex(alhazen.UsageError, "ray_origins: " + message):
                query(masked, self.directions)
        near = alhazen.trimesh.ProximityQuery(self.mesh)
        for query in (self.ray.contains_points, near.on_surface, near.signed_distance):
            with self.assertRaisesRegex(alhazen.UsageError, "points: " + message):
                query(masked)
        scene = alhazen.raycasting.RaycastingScene()
        scene.add_triangles(self.mesh.vertices.astype(np.float32), self.mesh.faces.astype(np.uint32))
        with self.assertRaisesRegex(alhazen.UsageError, "rays: " + message):
            scene.cast_rays(np.ma.masked_greater(random_rays(9), 0))
        with self.assertRaisesRegex(alhazen.UsageError, "query_points: " + message):
            scene.compute_distance(masked)

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

    def test_cases_that_the_tests_of_trimesh_ask_for_hold(self):
        vertices, faces = self.mesh.vertices, self.mesh.faces
        # From the middle through each corner, where six triangles meet: one hit.
        middle = np.zeros_like(vertices)
        self.assertTrue(self.ray.intersects_any(middle, vertices).all())
        _, index_ray, _ = self.ray.intersects_location(middle, vertices)
        self.assertEqual(np.bincount(index_ray, minlength=len(vertices)).tolist(), [1] * len(vertices))
        # Corners drawn in or out, and the middle.
        self.assertTrue(self.ray.contains_points(vertices / 1.5).all())
        self.assertFalse(self.ray.contains_points(vertices * 1.5).any())
        self.assertTrue(self.ray.contains_points([[0, 0, 0]]).all())
        # First hits of a view of one side lie on its two triangles, all hits on more.
        grid = np.stack(np.meshgrid(np.linspace(-0.03, 0.03, 40), np.linspace(-0.03, 0.03, 40)), axis=-1).reshape(-1, 2)
        directions = np.c_[grid, np.ones(len(grid))]
        origins = np.tile([0, 0, -15.0], (len(grid), 1))
        self.assertEqual(len(np.unique(self.ray.intersects_id(origins, directions, multiple_hits=False)[0])), 2)
        self.assertGreater(len(np.unique(self.ray.intersects_id(origins, directions)[0])), 2)
        # Along an axis, over the borders: hits keep the other coordinates, and lie on top or bottom.
        grid = np.stack(np.meshgrid(*[np.linspace(-0.52, 0.52, 53)] * 2), axis=-1).reshape(-1, 2)
        locations, index_ray, _ = self.ray.intersects_location(np.c_[grid, np.full(len(grid), -100.0)], np.tile([0, 0, 1.0], (len(grid), 1)))
        np.testing.assert_allclose(locations[:, :2], grid[index_ray], atol=1e-12)
        np.testing.assert_allclose(np.abs(locations[:, 2]), 0.5, atol=1e-12)
        # No hits are arrays, too; a large mesh is left once.
        for answer in (*self.ray.intersects_id(origins, -directions), *self.ray.intersects_location(origins, -directions)):
            self.assertEqual((type(answer), len(answer)), (np.ndarray, 0))
        large = alhazen.trimesh.RayMeshIntersector(SimpleNamespace(vertices=1e4 * vertices, faces=faces))
        self.assertEqual(len(large.intersects_id([[1, 2, 4999.0]], [[0, 0, -1.0]])[0]), 1)

    def test_queries_follow_the_mesh(self):
        class Tracked(np.ndarray):  # as trimesh's arrays: known by a hash
            def __hash__(self):
                return hash(self.tobytes())

        origin, direction = [[0.1, 0.2, 5.0]], [[0, 0, -1.0]]
        for kind in (np.ndarray, Tracked):
            vertices, faces = cube(-0.5, 0.5)
            mesh = SimpleNamespace(vertices=vertices.view(kind), faces=faces.view(kind))
            ray = alhazen.trimesh.RayMeshIntersector(mesh)
            self.assertAlmostEqual(ray.intersects_location(origin, direction)[0][0, 2], 0.5, places=12)
            before = ray._scene
            self.assertIs(ray._scene, before)
            mesh.vertices += (0, 0, 1)  # in place, as apply_transform may
            self.assertAlmostEqual(ray.intersects_location(origin, direction)[0][0, 2], 1.5, places=12)
            self.assertTrue(ray.contains_points([[0, 0, 1.0]])[0])
            mesh.vertices = mesh.vertices * 2  # another array
            self.assertAlmostEqual(ray.intersects_location(origin, direction)[0][0, 2], 3.0, places=12)
            mesh.faces = mesh.faces[:0]
            self.assertFalse(ray.intersects_any(origin, direction)[0])

    def test_wrong_shapes_are_errors(self):
        with self.assertRaises(alhazen.UsageError):
            self.ray.intersects_any(np.zeros((3, 3)), np.zeros((2, 3)))
        open_mesh = SimpleNamespace(vertices=self.mesh.vertices, faces=self.mesh.faces[:-1])
        for ray in (self.ray, alhazen.trimesh.RayMeshIntersector(open_mesh)):
            with self.assertRaisesRegex(alhazen.UsageError, r"points: expected the shape .*3\), found \(1, 2\)"):
                ray.contains_points([[1, 2]])


    def test_distances_are_those_of_the_cube(self):
        near = alhazen.trimesh.ProximityQuery(self.mesh)
        points = np.random.default_rng(3).uniform(-1.5, 1.5, (3000, 3))
        closest, distance, triangle = near.on_surface(points)
        self.assertEqual((closest.shape, distance.shape, triangle.dtype), ((3000, 3), (3000,), np.int64))
        np.testing.assert_allclose(np.linalg.norm(points - closest, axis=1), distance, rtol=1e-15)
        signed = near.signed_distance(points)
        np.testing.assert_allclose(signed, -signed_distance_of_cube(points), atol=1e-15)
        self.assertEqual(near.signed_distance([[0.5, 0, 0]]).tolist(), [0])
        self.mesh.vertices = self.mesh.vertices * 2
        self.assertEqual(near.signed_distance([[0.0, 0, 0], [0, 0, 3.0]]).tolist(), [1, -2])
        self.mesh.faces = self.mesh.faces[:0]
        self.assertEqual([a.tolist() for a in near.on_surface([[0.0, 0, 0]])], [[[0, 0, 0]], [np.inf], [-1]])

    def test_signs_of_open_meshes_are_of_the_nearest_normal(self):
        # As trimesh 4 has them: of the side of the triangle, and aside of it of the crossings of rays.
        vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float64)
        square = SimpleNamespace(vertices=vertices, faces=np.array([[0, 1, 2], [0, 2, 3]]))
        points = np.array([[0.3, 0.6, 1], [0.3, 0.6, -1], [0.5, 0.5, -2], [3, 0.5, -0.1], [3, 0.5, 0.1], [1, 0.5, -1]])
        signed = alhazen.trimesh.ProximityQuery(square).signed_distance(points)
        np.testing.assert_allclose(signed, [-1, 1, 2, -np.hypot(2, 0.1), -np.hypot(2, 0.1), 1], rtol=1e-15)
        vertices, faces = cube()
        top = (vertices[faces][:, :, 2] == 1).all(axis=1)
        for offset in (0.0, 1e5):
            box = SimpleNamespace(vertices=vertices + offset, faces=faces[~top])
            signed = alhazen.trimesh.ProximityQuery(box).signed_distance(
                np.array([[0.5, 0.4, 0.7], [0.5, 0.5, 0.2], [0.5, 0.5, -1], [3, 0.4, 0.3]]) + offset)
            np.testing.assert_allclose(signed, [0.4, 0.2, -1, -2], rtol=1e-9)
        # A closed mesh that is inside out holds what it holds.
        turned = SimpleNamespace(vertices=vertices, faces=faces[:, ::-1])
        signed = alhazen.trimesh.ProximityQuery(turned).signed_distance([[0.5, 0.4, 0.7], [0.5, 0.5, 3]])
        np.testing.assert_allclose(signed, [0.3, -2], rtol=1e-15)
        empty = SimpleNamespace(vertices=np.zeros((0, 3)), faces=np.zeros((0, 3), dtype=np.int64))
        self.assertEqual(alhazen.trimesh.ProximityQuery(empty).signed_distance([[0, 0, 0]]).tolist(), [-np.inf])


def signed_distance_of_cube(points, half=0.5):
    """Negative inside."""
    beyond = np.abs(points) - half
    return np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(axis=-1), 0)


def closest_by_brute_force(points, corners):
    """Distances (p,) and, by projection, points (p, 3) of the nearest of triangles (t, 3, 3)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    candidates = []
    for p, q in ((a, b), (b, c), (c, a)):
        along = q - p
        t = np.clip(((points[:, None] - p) * along).sum(-1) / (along ** 2).sum(-1), 0, 1)
        candidates.append(p + t[..., None] * along)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    foot = points[:, None] - ((points[:, None] - a) * normal).sum(-1)[..., None] * normal
    inside = np.all([(np.cross(q - p, foot - p) * normal).sum(-1) >= 0 for p, q in ((a, b), (b, c), (c, a))], axis=0)
    candidates.append(np.where(inside[..., None], foot, np.inf))
    candidates = np.concatenate(candidates, axis=1)
    distance = np.linalg.norm(points[:, None] - candidates, axis=-1)
    best = distance.argmin(axis=1)
    rows = np.arange(len(points))
    return distance[rows, best], candidates[rows, best]


class Open3D(unittest.TestCase):
    def test_the_nearest_points_are_those_of_brute_force(self):
        random = np.random.default_rng(8)
        scene = alhazen.raycasting.RaycastingScene()
        all_corners, owners = [], []
        for i in range(3):
            vertices = random.uniform(-1, 1, (60, 3)) + (2 * i, 0, 0)
            faces = random.permuted(np.tile(np.arange(60), (40, 1)), axis=1)[:, :3]
            scene.add_triangles(vertices, faces)
            all_corners.append(vertices[faces])
            owners += [(i, k) for k in range(40)]
        corners, owners = np.concatenate(all_corners), np.array(owners)
        points = random.uniform(-3, 7, (40, 30, 3))
        found = scene.compute_closest_points(points)
        self.assertEqual(sorted(found), ["geometry_ids", "points", "primitive_ids", "primitive_normals", "primitive_uvs"])
        self.assertEqual((found["points"].shape, found["points"].dtype), ((40, 30, 3), np.float64))
        self.assertEqual(found["geometry_ids"].dtype, np.uint32)
        distance, closest = closest_by_brute_force(points.reshape(-1, 3), corners)
        np.testing.assert_allclose(scene.compute_distance(points).ravel(), distance, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(found["points"].reshape(-1, 3), closest, atol=1e-9)
        # The ids, the weights and the normal are of the triangle that has the point.
        ids = np.stack([found["geometry_ids"], found["primitive_ids"]], axis=-1).reshape(-1, 2)
        mine = corners[40 * ids[:, 0] + ids[:, 1]]
        self.assertTrue((owners[40 * ids[:, 0] + ids[:, 1]] == ids).all())
        u, v = found["primitive_uvs"].reshape(-1, 2).T[..., None]
        np.testing.assert_allclose((1 - u - v) * mine[:, 0] + u * mine[:, 1] + v * mine[:, 2],
                                   found["points"].reshape(-1, 3), atol=1e-14)
        normals = np.cross(mine[:, 1] - mine[:, 0], mine[:, 2] - mine[:, 0])
        np.testing.assert_allclose(found["primitive_normals"].reshape(-1, 3),
                                   normals / np.linalg.norm(normals, axis=1, keepdims=True), atol=1e-9)
        for threads in (1, 2):
            np.testing.assert_array_equal(scene.compute_closest_points(points, threads)["points"], found["points"])

    def test_signed_distances_are_negative_inside(self):
        points = np.random.default_rng(9).uniform(-1, 1, (50, 40, 3))
        vertices, faces = cube(-0.5, 0.5)
        scene = alhazen.raycasting.RaycastingScene()
        scene.add_triangles(vertices, faces)
        signed = scene.compute_signed_distance(points)
        np.testing.assert_allclose(signed, signed_distance_of_cube(points), atol=1e-15)
        single = scene.compute_signed_distance(points.astype(np.float32), nthreads=1, nsamples=3)
        self.assertEqual(single.dtype, np.float32)
        np.testing.assert_allclose(single, signed_distance_of_cube(points.astype(np.float32).astype(np.float64)), atol=1e-7)
        np.testing.assert_array_equal(scene.compute_distance(points), np.abs(signed))
        self.assertEqual(str(scene.compute_signed_distance([[0.5, 0.25, 0]])[0]), "0.0")
        # Where a mesh is open, rays vote.
        open_scene = alhazen.raycasting.RaycastingScene()
        open_scene.add_triangles(vertices, faces[:-1])
        self.assertAlmostEqual(open_scene.compute_signed_distance([[-0.1, -0.1, -0.2]], nsamples=5)[0], -0.3, places=12)

    def test_meshes_are_counted_by_parity(self):
        points = np.array([[1.5, 1.5, 1.4], [0.5, 0.5, 0.5], [5, 5, 5]])
        far_vertices, far_faces = cube(20, 21)
        far_vertices += (0, 0, 5)  # out of the way of rays that vote
        for far in (None, far_faces, far_faces[:-1]):
            scene = alhazen.raycasting.RaycastingScene()
            if far is not None:
                scene.add_triangles(far_vertices, far)
            for box in (cube(0, 3), cube(1, 2)):
                scene.add_triangles(*box)
            np.testing.assert_allclose(scene.compute_signed_distance(points), [0.4, -0.5, np.sqrt(12)], rtol=1e-14)
            self.assertEqual(scene.compute_occupancy(points.reshape(3, 1, 3)).tolist(), [[0], [1], [0]])
            # On a surface: in the wall between, and where the inner one begins.
            self.assertEqual(scene.compute_occupancy([[3, 0.5, 0.5], [1, 1.5, 1.5]]).tolist(), [1, 1])
        # The far one is open, and is asked by rays; the closed are not.
        self.assertEqual(scene.compute_occupancy(np.float32([[20.2, 20.3, 25.1], [2.5, 2.5, 2.5]])).tolist(), [1, 1])
        # An open mesh within a closed one.
        mixed = alhazen.raycasting.RaycastingScene()
        mixed.add_triangles(*cube(0, 3))
        vertices, faces = cube(1, 2)
        mixed.add_triangles(vertices, faces[:-1])
        np.testing.assert_array_equal(mixed.compute_occupancy([[1.2, 1.3, 1.1], [0.5, 0.4, 0.5]], nsamples=3), [0, 1])
        mixed.add_triangles(*cube(-1, 4))  # the meshes are sorted again
        np.testing.assert_array_equal(mixed.compute_occupancy([[1.2, 1.3, 1.1], [0.5, 0.4, 0.5]]), [1, 0])

    def test_what_has_no_nearest_point_is_said(self):
        scene = alhazen.raycasting.RaycastingScene()
        with self.assertWarnsRegex(alhazen.SceneWarning, "empty"):
            self.assertEqual(scene.compute_distance(np.zeros((2, 3))).tolist(), [np.inf, np.inf])
        scene.add_triangles(*cube())
        bad = np.array([[np.nan, 0, 0], [0, np.inf, 0], [0.5, 0.5, 3]])
        np.testing.assert_array_equal(scene.compute_distance(bad), [np.nan, np.nan, 2])
        self.assertEqual(scene.compute_closest_points(bad)["geometry_ids"].tolist(), [scene.INVALID_ID] * 2 + [0])
        with self.assertRaisesRegex(alhazen.UsageError, r"shape \(\.\.\., 3\)"):
            scene.compute_distance(np.zeros((2, 4)))
        self.assertEqual(scene.compute_signed_distance(np.zeros((0, 3))).shape, (0,))
        # Placed, and turned inside out.
        placed = alhazen.Scene().add_mesh(*cube(), transform=np.diag([-2, 2, 2.0, 1]))
        found = placed.closest_points([-1.5, 0.5, 5])
        self.assertEqual((found["distance"], found["points"].tolist(), found["normals"].tolist()),
                         (3, [-1.5, 0.5, 2], placed.intersect([-1.5, 0.5, 5, 0, 0, -1])["normals"].tolist()))
        for name, what in (("ball", alhazen.superellipsoid("ball", east=0.5, north=0.5)),
                           ("ring", alhazen.torus("ring", transform=np.diag([1, 1, 2.0, 1]))),
                           ("hole", alhazen.difference("hole", alhazen.sphere(radius=2), alhazen.sphere(radius=1)))):
            with self.assertRaisesRegex(alhazen.UsageError, f"'{name}'"):
                alhazen.Scene(*cube()).add(what).closest_points([0, 0, 0])

    def test_nearest_points_of_shapes_beside_closed_forms_and_meshes(self):
        points = np.random.default_rng(21).uniform(-4, 4, (300, 3))
        x, y, z = points.T
        across = np.hypot(x, y)
        shapes = {
            "ball": (alhazen.sphere("ball", radius=1.5), np.abs(np.linalg.norm(points, axis=1) - 1.5)),
            "ring": (alhazen.torus("ring", major_radius=2, minor_radius=0.5), np.abs(np.hypot(across - 2, z) - 0.5)),
            "floor": (alhazen.plane("floor", point=(0, 0, -1), normal=(0, 0, 2)), np.abs(z + 1)),
            "disc": (alhazen.disc("disc", radius=2, inner_radius=1), np.hypot(z, np.maximum(0, np.maximum(across - 2, 1 - across)))),
            "pipe": (alhazen.cylinder("pipe", base=(0, 0, -1), top=(0, 0, 1), radius=1, capped=False),
                     np.hypot(across - 1, np.maximum(0, np.abs(z) - 1))),
            "box": (alhazen.box("box", lo=(-1, -1, -1), hi=(1, 1, 1)), np.where(
                np.abs(points).max(axis=1) < 1, 1 - np.abs(points).max(axis=1),
                np.linalg.norm(np.maximum(0, np.abs(points) - 1), axis=1))),
        }
        for name, (shape, expected) in shapes.items():
            found = alhazen.Scene().add(shape).closest_points(points)
            np.testing.assert_allclose(found["distance"], expected, atol=2e-15 * 8, err_msg=name)
            np.testing.assert_allclose(np.linalg.norm(found["points"] - points, axis=1), expected, atol=2e-15 * 8, err_msg=name)
            self.assertEqual((set(found["geometry_ids"].tolist()), set(found["primitive_ids"].tolist())), ({0}, {0}))
            self.assertFalse(found["uvs"].any())
        # All together, beside a mesh: the nearest of them, by name, whatever the number of threads.
        together = alhazen.Scene(*cube())
        for shape, _ in shapes.values():
            together.add(shape)
        found = together.closest_points(points)
        one_by_one = np.array([alhazen.Scene(*cube()).closest_points(points)["distance"]] +
                              [alhazen.Scene().add(shape).closest_points(points)["distance"] for shape, _ in shapes.values()])
        np.testing.assert_array_equal(found["distance"], one_by_one.min(axis=0))
        np.testing.assert_array_equal(found["geometry_ids"], one_by_one.argmin(axis=0))
        for threads in (1, 3):
            for key, values in together.closest_points(points, threads=threads).items():
                np.testing.assert_array_equal(values, found[key])
        self.assertEqual(together.closest_points(points.astype(np.float32))["distance"].dtype, np.float32)
        self.assertTrue(np.isnan(together.closest_points([[np.nan, 0, 0]])["distance"]).all())

    def test_nearest_points_of_shapes_in_instances_are_where_they_are_placed(self):
        text = ('alhazen 1\nobject "pair" { sphere "ball" { radius = 1 } box "block" { lo = (2, -1, -1); hi = (3, 1, 1) } }\n'
                'instance "pair" { transform = [scale(1, 2, 0.5), rotate((0, 0, 1), 90), translate(0, 0, 5)] }\n'
                'instance "pair" { transform = translate(0, 0, -5) }\n')
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.alhazen"
            path.write_text(text, encoding="utf-8")
            scene = alhazen.load(path)
        # The stretched ball is an ellipsoid of semi-axes 2, 1, 0.5.
        found = scene.closest_points([[5, 0, 5], [0, 0, 5], [0, 0, -5], [0, 4, 5], [2.5, 0, -3]])
        np.testing.assert_allclose(found["distance"], [3, 0.5, 1, 1, 1], atol=1e-14)
        names = [scene.geometry_names[i] for i in found["geometry_ids"]]
        self.assertEqual(names, ["ball", "ball", "ball", "block", "block"])
        np.testing.assert_allclose(np.abs(found["normals"]), [[1, 0, 0], [0, 0, 1], np.abs(found["normals"][2]), [0, 1, 0], [0, 0, 1]],
                                   atol=1e-14)

    def test_shapes_in_very_many_instances_are_refused_by_their_bytes(self):
        # 280^3 stretched balls are fewer than the 2^25 triangles that there may be, and take more.
        def scene(depth):
            text = 'alhazen 1\nobject "0" { sphere "ball" { radius = 1 } }\n'
            for i in range(1, depth + 1):
                places = " ".join(f'instance "{i - 1}" {{ transform = translate({3 * 280 ** (i - 1) * k}, 0, 0) }}'
                                  for k in range(280))
                text += f'object "{i}" {{ {places} }}\n'
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "scene.alhazen"
                path.write_text(text + f'instance "{depth}" {{ transform = scale(1, 1, 2) }}\n', encoding="utf-8")
                return alhazen.load(path)

        with self.assertRaisesRegex(alhazen.ResourceError, r"take up to [\d.]+ GB"):
            scene(3).closest_points([[0, 0, 5]])
        self.assertEqual(scene(1).closest_points([[0, 0, 5]])["distance"].tolist(), [3])

    def test_nearest_points_of_instances_are_those_of_their_copies(self):
        # Turned, mirrored and stretched, in each other, beside a mesh that is no instance.
        vertices, faces = cube(-0.5, 0.5)
        points = np.random.default_rng(11).uniform(-6, 6, (400, 3))
        lists = "points = [{}]; faces = [{}]".format(
            ", ".join(str(tuple(map(float, v))) for v in vertices), ", ".join(str(tuple(map(int, f))) for f in faces))
        transforms = {"row": ["translate(3, 0, 0)", "scale(1, -2, 0.5)"],
                      "scene": ["[rotate((1, 2, 3), 40), translate(0, 1, 0)]", "[scale(0.3), translate(0, -4, 2)]"]}
        text = (f'alhazen 1\nobject "pair" {{ mesh "box" {{ {lists} }} mesh "small" {{ {lists}; transform = [scale(0.2), '
                f'translate(0, 0, 2)] }} }}\nobject "row" {{ {" ".join(f"""instance "pair" {{ transform = {t} }}""" for t in transforms["row"])} }}\n'
                + "".join(f'instance "row" {{ transform = {t} }}\n' for t in transforms["scene"])
                + f'mesh "alone" {{ {lists}; transform = translate(-4, -4, 0) }}\n')
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.alhazen"
            path.write_text(text, encoding="utf-8")
            scene = alhazen.load(path)
            flat = path.with_suffix(".obj")
            scene.save(flat)
            copies = alhazen.load(flat)
        # Beside the faces, too: most points are nearest to a corner.
        hits = scene.intersect(np.concatenate([points, np.random.default_rng(12).uniform(-3, 3, points.shape) - points], axis=1),
                               fields=("t_hit", "points", "normals"))
        met = np.isfinite(hits["t_hit"])
        points = np.concatenate([points, hits["points"][met] + 0.01 * hits["normals"][met]])
        found, expected = scene.closest_points(points), copies.closest_points(points)
        self.assertGreater(scene.info["instances"], 0)
        self.assertEqual(copies.info["instances"], 0)
        for key in ("distance", "points"):
            np.testing.assert_allclose(found[key], expected[key], atol=1e-6)
        # On an edge rounding decides which of its triangles is named.
        inside = np.ones(len(points), dtype=bool)
        for answer in (found, expected):
            weights = np.c_[answer["uvs"], 1 - answer["uvs"].sum(axis=1)]
            inside &= weights.min(axis=1) > 1e-4
        self.assertGreater(inside.sum(), 50)
        np.testing.assert_allclose(found["normals"][inside], expected["normals"][inside], atol=1e-6)
        # Parts and triangles are those of a ray that is shot there.
        rays = np.concatenate([points, found["points"] - points], axis=1)[inside]
        hits = scene.intersect(rays)
        for ids in ("geometry_ids", "primitive_ids"):
            np.testing.assert_array_equal(hits[ids], found[ids][inside])
        np.testing.assert_allclose(hits["t_hit"], 1, rtol=1e-9)

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
        self.assertEqual((lists["ray_splits"].dtype, lists["ray_ids"].dtype), (np.uint32, np.uint32))
        self.assertEqual(lists["t_hit"].tolist(), [8, 9, 5, 6])
        self.assertEqual(scene.compute_occupancy(np.float32([[0.5, 0.5, 0.5], [2, 2, 2]])).tolist(), [1, 0])

    def test_open_meshes_are_voted_on(self):
        vertices, faces = cube()
        scene = alhazen.raycasting.RaycastingScene()
        scene.add_triangles(vertices, faces[:-1])
        # The rays of the last point, inside too, leave through the hole.
        points = np.float32([[[0.2, 0.3, 0.1], [0.2, 0.3, 1.4]], [[0.8, 0.7, 0.5], [0.4, 0.6, 0.8]]])
        for samples in (1, 3, 11):
            occupancy = scene.compute_occupancy(points, nthreads=1, nsamples=samples)
            self.assertEqual((occupancy.dtype, occupancy.tolist()), (np.float32, [[1, 0], [1, 0]]))
        for samples in (0, 2, -1):
            with self.assertRaisesRegex(alhazen.UsageError, "expected an odd number"):
                scene.compute_occupancy(points, nsamples=samples)
        with self.assertRaisesRegex(alhazen.UsageError, r"shape \(\.\.\., 3\)"):
            scene.compute_occupancy(np.zeros((2, 4)))

    def test_every_query_takes_nthreads(self):
        scene = alhazen.raycasting.RaycastingScene()
        scene.add_triangles(*cube())
        ray, point = np.float32([[0.2, 0.3, 9, 0, 0, -1]]), np.float32([[0.5, 0.5, 0.5]])
        self.assertEqual(scene.cast_rays(ray, nthreads=1)["t_hit"][0], 8)
        self.assertTrue(scene.test_occlusions(ray, 0.0, np.inf, 1)[0])
        self.assertEqual(scene.count_intersections(ray, nthreads=1)[0], 2)
        self.assertEqual(len(scene.list_intersections(ray, nthreads=1)["t_hit"]), 2)
        self.assertEqual(scene.compute_occupancy(point, nthreads=1)[0], 1)

    def test_pinhole_rays_pass_through_the_middles_of_pixels(self):
        pinhole = alhazen.raycasting.RaycastingScene.create_rays_pinhole
        # By the definition: a pixel (x + 1/2, y + 1/2, 1) is the intrinsic matrix times a point of the camera.
        rays = pinhole(90, [0, 0, 0], [0, -2, 0], [0, 0, -1], 4, 2)
        self.assertEqual((rays.shape, rays.dtype), ((2, 4, 6), np.float32))
        np.testing.assert_allclose(rays[0, 0], [0, -2, 0, -0.75, 1, 0.25], atol=1e-6)
        np.testing.assert_allclose(rays[1, 3], [0, -2, 0, 0.75, 1, -0.25], atol=1e-6)
        np.testing.assert_array_equal(pinhole(up=[0, 0, 1], fov_deg=90, center=[0, 0, 0], eye=[0, -2, 0], width_px=4,
                                              height_px=2), rays[::-1, ::-1])
        intrinsic = np.array([[500, 1, 310], [0, 480, 250], [0, 0, 1.0]])
        turn, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
        extrinsic = np.eye(4)
        extrinsic[:3, :3], extrinsic[:3, 3] = turn * np.sign(np.linalg.det(turn)), (1, 2, 3)
        rays = pinhole(intrinsic, extrinsic_matrix=extrinsic, width_px=640, height_px=480).astype(np.float64)
        origin = (extrinsic @ np.append(rays[7, 9, :3], 1))[:3]
        np.testing.assert_allclose(origin, 0, atol=1e-6)
        inside = (extrinsic[:3, :3] @ rays[..., 3:, None])[..., 0]
        np.testing.assert_allclose(inside[..., 2], 1, atol=1e-6)
        pixels = (intrinsic @ inside[..., None])[..., 0]
        np.testing.assert_allclose(pixels[123, 456], [456.5, 123.5, 1], rtol=1e-6)
        np.testing.assert_allclose(pixels[0, 639], [639.5, 0.5, 1], rtol=1e-5)

    def test_wrong_cameras_are_errors(self):
        pinhole = alhazen.raycasting.RaycastingScene.create_rays_pinhole
        with self.assertRaisesRegex(alhazen.UsageError, "expected fov_deg, center, eye, up, .* found 2 by position"):
            pinhole(60, [0, 0, 0])
        with self.assertRaisesRegex(alhazen.UsageError, "and fov"):
            pinhole(fov=60, center=[0, 0, 0], eye=[1, 0, 0], up=[0, 0, 1], width_px=2, height_px=2)
        with self.assertRaisesRegex(alhazen.UsageError, r"extrinsic_matrix: expected the shape \(4, 4\)"):
            pinhole(np.eye(3), np.eye(3), 2, 2)
        with self.assertRaisesRegex(alhazen.UsageError, "parallel"):
            pinhole(60, [0, 0, 0], [0, 0, 1], [0, 0, 1], 2, 2)
        with self.assertRaisesRegex(alhazen.UsageError, "eye and center are the same"):
            pinhole(60, [0, 0, 1], [0, 0, 1], [0, 1, 0], 2, 2)
        for width in (-1, 2.5):
            with self.assertRaisesRegex(alhazen.UsageError, "width_px: expected a whole number from 0, found"):
                pinhole(60, [0, 0, 0], [0, 0, 1], [0, 1, 0], width, 2)
        for center in (0, [0, 0], [[0, 0, 0]], [0, 0, 0, 0]):
            with self.assertRaisesRegex(alhazen.UsageError, r"center: expected the shape \(3,\)"):
                pinhole(60, center, [0, 0, 1], [0, 1, 0], 2, 2)
        with self.assertRaisesRegex(alhazen.UsageError, "up: expected an array of numbers"):
            pinhole(60, [0, 0, 0], [0, 0, 1], "up", 2, 2)
        with self.assertRaisesRegex(alhazen.UsageError, "intrinsic_matrix: it has no inverse"):
            pinhole(np.zeros((3, 3)), np.eye(4), 2, 2)

    def test_cameras_are_of_finite_numbers(self):
        pinhole = alhazen.raycasting.RaycastingScene.create_rays_pinhole
        camera = {"fov_deg": 60, "center": [0, 0, 0], "eye": [0, 0, 1], "up": [0, 1, 0]}
        matrices = {"intrinsic_matrix": np.eye(3), "extrinsic_matrix": np.eye(4)}
        for given in (camera, matrices):
            for name, value in given.items():
                for bad in (np.nan, np.inf, -np.inf):
                    numbers = np.array(value, dtype=np.float64)
                    numbers.reshape(-1)[-1] = bad
                    with self.assertRaisesRegex(alhazen.UsageError, f"{name}: expected finite numbers"):
                        pinhole(**{**given, name: numbers}, width_px=2, height_px=2)
        for far in (1e39, 1e200):
            with self.assertRaisesRegex(alhazen.UsageError, "eye: expected finite numbers of float32"):
                pinhole(**{**camera, "eye": [0, 0, far]}, width_px=2, height_px=2)
        with self.assertRaisesRegex(alhazen.UsageError, "the rays are beyond the numbers of float32"):
            pinhole(np.diag([1e-39, 1, 1]), np.eye(4), 2, 2)
        # An angle of 0: all rays are parallel to the view.
        np.testing.assert_array_equal(np.abs(pinhole(**{**camera, "fov_deg": 0}, width_px=2, height_px=2)[..., 3:]),
                                      np.broadcast_to([0, 0, 1], (2, 2, 3)))

    def test_cameras_without_pixels_have_no_rays(self):
        pinhole = alhazen.raycasting.RaycastingScene.create_rays_pinhole
        self.assertEqual(pinhole(60, [0, 0, 0], [0, 0, 1], [0, 1, 0], 0, 2).shape, (2, 0, 6))
        self.assertEqual(pinhole(np.eye(3), np.eye(4), 3, 0).shape, (0, 3, 6))

    def test_meshes_and_tensors_of_open3d_are_taken(self):
        class Tensor:  # numpy does not know Open3D's
            def __init__(self, numbers):
                self.numbers = np.asarray(numbers)

            def numpy(self):
                return self.numbers

        vertices, faces = cube()
        with_tensors = SimpleNamespace(vertex={"positions": Tensor(vertices)}, triangle={"indices": Tensor(faces)})
        without = SimpleNamespace(vertices=vertices, triangles=faces)
        ray, point = Tensor(np.float32([[0.2, 0.3, 9, 0, 0, -1]])), Tensor(np.float32([[0.5, 0.5, 3]]))
        scene = alhazen.raycasting.RaycastingScene
        for add in (lambda s: s.add_triangles(with_tensors), lambda s: s.add_triangles(mesh=with_tensors),
                    lambda s: s.add_triangles(without), lambda s: s.add_triangles(Tensor(vertices), Tensor(faces)),
                    lambda s: s.add_triangles(vertex_positions=vertices, triangle_indices=faces)):
            made = scene()
            self.assertEqual(add(made), 0)
            self.assertEqual(made.cast_rays(ray)["t_hit"].tolist(), [8])
            self.assertEqual(made.test_occlusions(ray, tfar=7).tolist(), [False])
            self.assertEqual(made.count_intersections(ray).tolist(), [2])
            self.assertEqual(made.list_intersections(ray)["t_hit"].tolist(), [8, 9])
            self.assertEqual(made.compute_signed_distance(point).tolist(), [2])
            self.assertEqual(made.compute_closest_points(point)["points"].tolist(), [[0.5, 0.5, 1]])
        self.assertEqual(scene.create_rays_pinhole(Tensor(np.eye(3)), Tensor(np.eye(4)), 3, 2).shape, (2, 3, 6))
        for wrong in ({}, {"vertex_positions": vertices, "mesh": without}, {"triangle_indices": faces},
                      {"mesh": without, "triangle_indices": faces}):
            with self.assertRaisesRegex(alhazen.UsageError, "expected vertex_positions, triangle_indices, or mesh"):
                scene().add_triangles(**wrong)
        with self.assertRaisesRegex(alhazen.UsageError, "ndarray is no mesh"):
            scene().add_triangles(vertices)

    def test_rays_have_six_columns(self):
        scene = alhazen.raycasting.RaycastingScene()
        scene.add_triangles(*cube())
        for query in (scene.cast_rays, scene.test_occlusions, scene.count_intersections, scene.list_intersections):
            for wrong in (np.zeros((2, 8)), np.zeros((2, 3)), 0.0):
                with self.assertRaisesRegex(alhazen.UsageError, r"rays: expected the shape \(\.\.\., 6\), found"):
                    query(wrong)
            with self.assertRaisesRegex(alhazen.UsageError, "rays: expected an array of numbers"):
                query([[0, 0, 0, 0, 0, 1], [0]])

    def test_votes_go_the_ways_of_open3d(self):
        # std::mt19937 of seed 42, std::uniform_real_distribution<float>(-0.001, 0.001), by GNU's library.
        expected = [[0.999749064, 1.00059307, 1.00090146], [0.999366879, 1.00046396, 1.00055933],
                    [1.00019729, 1.00019372, 0.999312043]]
        np.testing.assert_array_equal(alhazen.raycasting._vote_directions(3), np.float32(expected))


if __name__ == "__main__":
    unittest.main()
