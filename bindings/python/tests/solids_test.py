"""Spans, points inside, thickness, measures and sections by closed forms."""
import unittest

import numpy as np

import alhazen
from closed_forms import cube, random_rays


class Solids(unittest.TestCase):
    def setUp(self):
        self.scene = alhazen.Scene().add(
            alhazen.sphere("ball", center=(0, 0, 0), radius=1),
            alhazen.difference("ring", alhazen.box(lo=(2, -1, -1), hi=(4, 1, 1)),
                               alhazen.cylinder(base=(3, 0, -2), top=(3, 0, 2), radius=0.5)))

    def test_thickness_of_a_ball_is_its_chord(self):
        rays = random_rays(5000, radius=2.0)
        rays[:, 3:] /= np.linalg.norm(rays[:, 3:], axis=1, keepdims=True)
        ball = alhazen.Scene().add(alhazen.sphere())
        along = -(rays[:, :3] * rays[:, 3:]).sum(axis=1)
        below = 1 - ((rays[:, :3] + along[:, None] * rays[:, 3:]) ** 2).sum(axis=1)
        np.testing.assert_allclose(ball.thickness(rays), 2 * np.sqrt(np.maximum(below, 0)), atol=1e-9)

    def test_spans_of_a_ray_through_both(self):
        spans = self.scene.spans([[-5, 0, 0, 1, 0, 0], [0, 5, 0, 1, 0, 0]])
        self.assertEqual(spans["ray_splits"].tolist(), [0, 3, 3])
        self.assertEqual(spans["solid_ids"].tolist(), [0, 1, 1])
        np.testing.assert_allclose(spans["t_enter"], [4, 7, 8.5])
        np.testing.assert_allclose(spans["t_exit"], [6, 7.5, 9])
        self.assertEqual(self.scene.solid_names, ["ball", "ring"])

    def test_points_inside_are_found(self):
        points = np.array([[[0, 0, 0], [0.6, 0.6, 0.6]], [[3, 0, 0], [2.2, 0, 0]]])
        self.assertEqual(self.scene.inside(points).tolist(), [[True, False], [False, True]])
        found = self.scene.solids_at([[0, 0, 1], [2.2, 0, 0], [9, 9, 9]])
        self.assertEqual(found["point_splits"].tolist(), [0, 1, 2, 2])
        self.assertEqual(found["solid_ids"].tolist(), [0, 1])
        self.assertEqual(found["on_surface"].tolist(), [True, False])

    def test_intervals_of_measures_hold_the_truth(self):
        ball, ring = self.scene.measure(error=1e-3, time_limit=1)
        for report, volume in ((ball, 4 / 3 * np.pi), (ring, 8 - np.pi * 0.5)):
            lo, hi = report["volume"]["interval"]
            self.assertLess(lo, volume)
            self.assertGreater(hi, volume)
            self.assertLess(hi - lo, 0.01 * volume)
        named, = self.scene.measure("ring", error=1e-2, time_limit=1)
        self.assertEqual(named["name"], "ring")

    def test_sections_enclose_the_area_of_the_cut(self):
        ball, ring = self.scene.section((0, 0, 1), 0.0, tolerance=1e-4)
        self.assertAlmostEqual(ball["area"], np.pi, delta=1e-3)
        self.assertAlmostEqual(ring["area"], 4 - np.pi * 0.25, delta=1e-3)
        self.assertEqual(len(ring["loops"]), 2)
        np.testing.assert_allclose(np.linalg.norm(ball["points"][0], axis=1), 1, atol=1e-9)
        self.assertEqual(self.scene.section((0, 0, 1), 5.0), [])

    def test_a_closed_mesh_is_a_solid_and_an_open_one_is_none(self):
        vertices, faces = cube()
        self.assertAlmostEqual(alhazen.Scene(vertices, faces).measure()[0]["volume"]["value"], 1, places=9)
        with self.assertRaisesRegex(alhazen.SceneError, "the scene has no solid"):
            alhazen.Scene(vertices, faces[:-1]).measure()

    def test_older_names_of_arguments_are_taken(self):
        vertices, faces = cube()
        scene = alhazen.Scene(vertices, faces, quality="fast")
        self.assertEqual(scene._settings["build"], "fast")
        self.assertEqual(len(scene.measure(seconds=0.1)), 1)
        self.assertEqual(scene.render(4, 3, spp=2, seconds=0.1).shape, (3, 4, 3))
        for wrong in (lambda: alhazen.Scene(vertices, faces, build="high", quality="fast"),
                      lambda: scene.measure(time_limit=1, seconds=1),
                      lambda: scene.render(4, 3, time_limit=1, seconds=1)):
            with self.assertRaisesRegex(alhazen.UsageError, "is the older name of (build|time_limit): expected one"):
                wrong()

    def test_limits_of_measures_are_numbers_from_zero(self):
        ball = alhazen.Scene().add(alhazen.sphere())
        for value in (-1, float("nan"), -float("inf")):
            with self.assertRaisesRegex(alhazen.UsageError, "the time limit is .*; expected a number from 0"):
                ball.measure(error=1e-2, time_limit=value)
            with self.assertRaisesRegex(alhazen.UsageError, "the relative error is .*; expected a number from 0"):
                ball.measure(error=value, time_limit=0.1)
        for seed in (-1, 2**64, 0.5, "1"):
            with self.assertRaisesRegex(alhazen.UsageError, "seed: expected a whole number from 0 to"):
                ball.measure(seed=seed)
        for cells in (-1, 2**40, 2.5):
            with self.assertRaisesRegex(alhazen.UsageError, "cells: expected a whole number"):
                ball.section(cells=cells)

    def test_an_unknown_solid_is_an_error(self):
        with self.assertRaisesRegex(alhazen.UsageError, "no solid 'cup'"):
            self.scene.measure("cup")


if __name__ == "__main__":
    unittest.main()
