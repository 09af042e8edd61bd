#!/usr/bin/env python3
"""The pictures of `alhazen view` at the cameras of a scene, and its camera blocks, in a browser: they are those of
`alhazen render`, to the bit.

Usage: view_cameras_test.py ALHAZEN [SCREENSHOT_FOLDER]

Skipped, with a message, without a browser: `scripts/setup --browser` installs one.
"""

import re
import subprocess

from view_server import SCENE, rendered
from viewer_page import ALHAZEN, FINE, ViewerPage, run_tests

CAMERA = 'perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }'
LENS = CAMERA.replace(" }", "; lens_radius = 0.3; focus_distance = 3; blades = 5; blade_turn_deg = 20 }")
MOVING = CAMERA.replace(" }", "; motion = [(0, translate(0.1, 0, 0)), (1, translate(0.7, 0, 0))] }")
MIRRORED = ('sheared_camera "front" { eye = (0, 1, 6); look = (0, -0.1, -6); right = (-6, 0, 0); up = (0, 4.4, 0); '
            'aspect = 1.3333333333333333 }')
SHEARED = ('sheared_camera "front" { eye = (0, 1, 6); look = (0.3, -0.2, -2); right = (2, 0.2, 0); up = (0.3, 1.4, 0.1); '
           'aspect = 1.3333333333333333 }')
PARALLEL = 'orthographic_camera "front" { eye = (0, 3, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); height = 4 }'
SHEARED_PARALLEL = ('sheared_orthographic_camera "front" { eye = (0, 1, 6); direction = (0.3, -0.2, -2); right = (4, 0.2, 0); '
                    'up = (0.3, 3, 0.1); aspect = 1.3333333333333333 }')
TALL_PIXELS = """Format 160 120 2
Projection "perspective" "fov" [40]
WorldBegin
LightSource "pointlight" 1 "from" [3 5 -4] "intensity" [30]
Translate 0 0 6
Surface "matte"
Color [0.8 0.2 0.2]
Sphere 1 -1 1 360
WorldEnd
"""
PLY = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n" \
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0.2\n0 1 0.4\n3 0 1 2\n"


def far(offset):
    """The scene away from the origin."""
    return re.sub(r"(eye|look_at|position|center|lo|hi) = \(([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\)",
                  lambda m: f"{m[1]} = ({float(m[2]) + offset!r}, {m[3]}, {float(m[4]) + offset!r})", SCENE)


class ViewCameras(ViewerPage):
    def check(self, scene, *options, **choices):
        for key, value in choices.items():
            self.choose(key, value)
        self.page.wait(FINE)
        shown, picture = self.shown(), rendered(ALHAZEN, scene, "--spp", "4", *options)
        self.assertEqual(shown[:2], picture[:2])
        self.assertTrue(shown[2] == picture[2], f"the picture of {scene.name} {options} differs")

    def check_block(self, text, kind=None):
        """The picture is that of the scene whose first camera is the block."""
        self.page.wait(FINE)
        block = self.page.value("viewer.camera.block()")
        if kind:
            self.assertTrue(block.startswith(f'{kind}_camera "view"'), block)
        at = re.search(r"^\w*_camera", text, re.MULTILINE)
        place = at.start() if at else text.index("\n", text.index("picture")) + 1
        renderer = self.page.value("viewer.controls.get('renderer')")
        shown, picture = self.shown(), rendered(ALHAZEN, self.write("block.alhazen", text[:place] + block + text[place:]),
                                                "--spp", "4", "--renderer", renderer)
        self.assertTrue(shown == picture, block)

    def turn(self):
        self.page.value("viewer.move(c => c.orbit(0.3, 0.1), true)")

    def test_a_lens_is_kept_and_a_motion_where_the_camera_is_that_of_the_scene(self):
        for name, camera in (("lens", LENS), ("moving", MOVING)):
            text = SCENE.replace(CAMERA, camera)
            self.assertNotEqual(text, SCENE)
            scene = self.write(f"{name}.alhazen", text)
            self.serve(scene)
            for renderer in ("distributed", "path_tracing"):
                self.check(scene, "--renderer", renderer, renderer=renderer)
                self.check_block(text)
            lens = "JSON.stringify(viewer.wish(viewer.camera, 64).camera.lens ?? null)"
            before = self.page.value(lens)
            self.turn()
            self.assertEqual(self.page.value(lens), before)
            self.check_block(text, "perspective")
            self.click("Home")
            self.check(scene, "--renderer", "path_tracing")
            self.check_quiet()

    def test_blocks_give_the_same_picture(self):
        for name, text, kind in (("plain", SCENE, "perspective"), ("mirrored", SCENE.replace(CAMERA, MIRRORED), "sheared"),
                                 ("sheared", SCENE.replace(CAMERA, SHEARED), "sheared"),
                                 ("parallel", SCENE.replace(CAMERA, PARALLEL), "orthographic"),
                                 ("sheared_parallel", SCENE.replace(CAMERA, SHEARED_PARALLEL), "sheared_orthographic"),
                                 ("far", far(1e6), "sheared"), ("farther", far(1e8), "sheared")):
            scene = self.write(f"{name}.alhazen", text)
            self.serve(scene)
            self.check(scene)
            self.check_block(text, kind)
            self.turn()
            self.check_block(text, kind)
            self.page.value("viewer.move(c => c.zoom(0.8), true)")
            self.check_block(text, kind)
            self.check_quiet()

    def test_mirrored_cameras_are_moved_as_others(self):
        eyes = []
        for name, camera in (("plain", CAMERA), ("mirrored", MIRRORED)):
            self.serve(self.write(f"{name}.alhazen", SCENE.replace(CAMERA, camera)))
            at = []
            for key, count in (("ArrowUp", 3), ("ArrowLeft", 2), ("ArrowUp", 40)):
                self.page.value("viewer.image.focus()")
                for _ in range(count):
                    self.page.key(key)
                at.append(self.page.value("viewer.camera.eye"))
                # Upright: the pole is not crossed.
                self.assertGreater(self.page.value("viewer.camera.up[1]"), 0)
            eyes.append(at)
        plain, mirrored = eyes
        for i, (x, y, z) in enumerate(plain):
            # The same height, and the other side.
            for a, b in zip(mirrored[i], (-x, y, z)):
                self.assertAlmostEqual(a, b, delta=0.02)
        self.assertGreater(plain[0][1], 2)

    def test_pictures_have_the_size_and_the_proportions_of_the_scene(self):
        wide = SCENE.replace("width = 160; height = 120; ", "").replace("fov_deg = 40 }", "fov_deg = 40; aspect = 2 }", 1)
        wide = wide.replace("fov_deg = 40 }", "fov_deg = 40; aspect = 0.5 }", 1)
        size = "width = 160; height = 120"
        for name, text, expected in (("pixels.rib", TALL_PIXELS, (160, 120)), ("no_camera.ply", PLY, (683, 512)),
                                     ("tiny.alhazen", SCENE.replace(size, "width = 32; height = 24"), (32, 24)),
                                     ("thin.alhazen", SCENE.replace(size, "width = 3; height = 200"), (3, 200)),
                                     ("odd.alhazen", SCENE.replace(size, "width = 101; height = 67"), (101, 67)),
                                     ("aspects.alhazen", wide, (1024, 512))):
            scene = self.write(name, text)
            self.serve(scene)
            self.check(scene)
            self.assertEqual(self.shown()[:2], expected)
        self.check(scene, "--camera", "1", camera="1")
        self.assertEqual(self.shown()[:2], (256, 512))
        # Pictures with a side above 4096 are made smaller.
        for size_of, expected in (("width = 1000; height = 8000", (512, 4096)), ("width = 9000; height = 60", (4096, 27))):
            self.serve(self.write("huge.alhazen", SCENE.replace(size, size_of)))
            self.choose("samples", "1")
            self.page.wait(FINE, 60)
            self.assertEqual(self.shown()[:2], expected)
            self.check_quiet()

    def test_a_scene_without_lights_is_lit_as_by_render(self):
        bare = "\n".join(line for line in SCENE.split("\n") if not line.startswith("point_light"))
        glowing = bare.replace('material "red" { ', 'material "red" { emission = (2, 1, 0.5); ')
        dark = glowing.replace("; background = (0.1, 0.15, 0.3)", "")
        black = bare.replace("0.1, 0.15, 0.3", "0, 0, 0")
        for name, text in (("bare", bare), ("glowing", glowing), ("dark", dark), ("black", black)):
            scene = self.write(f"{name}.alhazen", text)
            self.serve(scene)
            for renderer in ("whitted", "path_tracing"):
                for camera in ("0", "1"):
                    self.check(scene, "--renderer", renderer, "--camera", camera, renderer=renderer, camera=camera)
            self.assertNotIn("headlight", self.page.value("viewer.controls.lights.element.textContent"))
            self.choose("environment", "studio")
            self.check(scene, "--renderer", "path_tracing", "--camera", "1", "--environment", "studio")
            self.choose("environment", "")
            self.choose("renderer", "whitted")
            self.page.wait(FINE)
            self.assertIn("headlight", self.page.value("viewer.controls.lights.element.textContent"))
            # The headlight is that of the chosen camera, also in its fields and its block.
            self.assertEqual(self.page.value("viewer.controls.lights.lights.find(l => l.name === 'headlight').position"), [6, 1, 0])
            self.check_quiet()

    def test_a_headlight_goes_with_the_view(self):
        bare = "\n".join(line for line in SCENE.split("\n") if not line.startswith("point_light"))
        scene = self.write("headlight.alhazen", bare)
        self.serve(scene)
        headlight = "viewer.controls.lights.lights.find(l => l.name === 'headlight')"
        self.check_block(bare)
        self.turn()
        self.check_block(bare)
        self.page.wait(f"{headlight}.position.every((x, i) => x === viewer.camera.eye[i])")
        # With another colour it still goes with the view.
        self.page.value("viewer.controls.lights.edited(" + headlight + ", {..." + headlight + ", times: 2, sizes: []}, true)")
        self.assertEqual(self.page.value("viewer.controls.lights.changes()[0].position ?? null"), None)
        self.page.value("viewer.undo()")
        self.click("Home")
        self.check(scene)
        self.check_quiet()

    def test_an_edit_keeps_the_chosen_one_of_cameras_without_names(self):
        text = SCENE.replace('"front"', "").replace('"side"', "")
        self.serve(self.write("unnamed.alhazen", text))
        self.choose("camera", "1")
        self.page.wait(FINE)
        scene = self.scene = self.folder / "unnamed.alhazen"
        self.edit(text + "// changed\n")
        self.page.wait(FINE)
        self.assertEqual(self.page.value("viewer.controls.get('camera')"), "1")
        self.check(scene, "--camera", "1")

    def test_a_rib_file_is_converted_to_the_block_of_its_camera(self):
        rib = self.write("window.rib", TALL_PIXELS.replace("Format 160 120 2", "Format 160 120 1").replace(
            "WorldBegin", "ScreenWindow -0.5 1.5 -0.5 1\nWorldBegin"))
        converted = self.folder / "window.alhazen"
        subprocess.run([ALHAZEN, "convert", str(rib), str(converted), "-q"], check=True)
        self.serve(rib)
        self.check(rib)
        text = converted.read_text()
        self.check_block(text, "sheared")
        # Its headlight stays where the camera was; a light of the scene does not depend on it.
        text += "point_light { position = (3, 5, -4); color = (1, 1, 1) }\n"
        self.serve(self.write("lit.alhazen", text))
        self.turn()
        self.check_block(text, "sheared")


if __name__ == "__main__":
    run_tests()
