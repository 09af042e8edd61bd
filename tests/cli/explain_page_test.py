#!/usr/bin/env python3
"""`alhazen explain`: the data, and the page in a browser.

Usage: explain_page_test.py ALHAZEN [SCREENSHOT_FOLDER]

Without a browser (chromium, google-chrome) the tests of the page in a browser are skipped, with a message; the others
run. With SCREENSHOT_FOLDER screenshots of the page are written there. `scripts/setup --browser` installs one.
"""

import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

from browser_session import FilePages

ALHAZEN = sys.argv[1]
SCREENSHOTS = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None

# A name that would end text and a script if it were not escaped.
NAME = "</script><img src=x onerror=alert(1)>"
SCENE = """alhazen 1
picture { width = 60; height = 45 }
conventions { max_depth = 4 }
perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }
ambient_light { color = 0.2 }
point_light "key" { position = (3, 5, 4); color = (1, 1, 1) }
material "mirror" { diffuse = 0.1; reflective = 0.8 }
material "glass" { diffuse = 0.05; specular = 0.5; shininess = 50; transmissive = 0.8; reflective = 0.1; index = 1.4 }
difference "ball with a hole" {
    sphere "NAME" { center = (0, 1, 0); radius = 1; material = "glass" }
    cylinder "drill" { base = (0, 1, -2); top = (0, 1, 2); radius = 0.3; material = "glass" }
}
torus "ring" { center = (0, 1, -2); axis = (0, 0, 1); major_radius = 1; minor_radius = 0.4; material = "mirror" }
box { lo = (-2, 0, 0); hi = (-1.2, 0.8, 0.8); material = "mirror" }
plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }
""".replace("NAME", NAME)

BEFORE = """<script>window.seen = {errors: []};
addEventListener("error", e => seen.errors.push(String(e.message)));
addEventListener("securitypolicyviolation", e => seen.errors.push("policy: " + e.blockedURI));</script>"""
# Uses the page as a reader would, and records its texts.
AFTER = """<script type="module">
const all = query => [...document.querySelectorAll(query)];
const data = JSON.parse(document.getElementById("data").textContent);
seen.rays = all(".ray").length;
seen.tables = all("table.equation").length;
seen.headings = all("h2").map(h => h.textContent);
seen.sum = all("table.equation tfoot")[0].textContent;
seen.selected = [all("summary.selected").length];
const canvas = document.querySelector("canvas"), ink = () => canvas.toDataURL();
seen.pictures = [ink()];
all(".ray>summary")[1].click();
seen.selected.push(all("summary.selected").length, all(".ray>summary").findIndex(s => s.classList.contains("selected")));
seen.pictures.push(ink());
canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
seen.pictures.push(ink());
const next = document.querySelector("[aria-label='One step on']");
for (let i = 0; i < 3; ++i) next.click();
seen.step = document.querySelector("output").textContent;
seen.pictures.push(ink());
document.querySelector("input[type=checkbox]").click();
seen.pictures.push(ink());
all("details").forEach(d => { d.open = true; });
seen.in = all(".roth td.yes").length;
seen.roots = all("circle.root").length;
seen.unnamed = all("canvas,[role=img],input,button").filter(e => !e.getAttribute("aria-label") && !e.textContent.trim() &&
  !e.closest("label")).length;
seen.images = [...document.images].map(i => i.complete && i.naturalWidth > 0);
seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
seen.pictures = [seen.pictures.length, new Set(seen.pictures).size];
const result = document.createElement("pre");
result.id = "seen";
result.textContent = JSON.stringify(seen);
document.body.append(result);
</script>"""

# A scene that the cone and beam renderers accept.
FLAT = """alhazen 1
conventions { max_depth = 3 }
perspective_camera { eye = (0, 1, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }
ambient_light { color = 0.1 }
point_light "key" { position = (3, 5, 4); color = (1, 1, 1) }
material "mirror" { diffuse = 0.1; reflective = 0.8 }
material "matt" { diffuse = (0.7, 0.6, 0.5) }
box "block" { lo = (-2, 0, 0); hi = (-0.6, 1.2, 0.8); material = "mirror" }
rectangle "floor" { corner = (-4, 0, -4); edge_u = (0, 0, 8); edge_v = (8, 0, 0); material = "matt" }
"""


def times(a, b):
    return [x * y for x, y in zip(a, b)]


def plus(a, b):
    return [x + y for x, y in zip(a, b)]


class ExplainPage(FilePages, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.open_browser()
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.scene = cls.folder / "scene.alhazen"
        cls.scene.write_text(SCENE, encoding="utf-8")
        cls.page = cls.folder / "page.html"
        result = cls.explain("-o", str(cls.page), "--pixel", "22,22", "--steps", "octree", "--spp", "4")
        assert result.returncode == 0, result.stderr
        cls.text = cls.page.read_text(encoding="utf-8")

    @classmethod
    def explain(cls, *options):
        return subprocess.run([ALHAZEN, "explain", str(cls.scene), *options], capture_output=True, text=True, timeout=60)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def data(self, *options):
        result = self.explain("-o", "-", "--pixel", "22,22", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def check_ray(self, ray, background):
        total = times(ray.get("left", [0, 0, 0]), background)
        for surface in ray["surfaces"]:
            color = surface["emission"]
            for term in surface["ambient"] + surface["lights"]:
                color = plus(color, term["value"])
            for key in ("reflected", "refracted"):
                if "ray" not in surface[key]:
                    self.assertNotEqual(surface[key]["reason"], "sent")
                    continue
                color = plus(color, times(surface[key]["factor"], surface[key]["ray"]["radiance"]))
                self.check_ray(surface[key]["ray"], background)
            color = times(color, surface.get("filter", [1, 1, 1]))
            for a, b in zip(color, surface["color"]):
                self.assertAlmostEqual(a, b, delta=1e-12)
            total = plus(total, times(surface["share"], color))
        for a, b, weight, in_pixel in zip(total, ray["radiance"], ray["weight"], ray["in_pixel"]):
            self.assertAlmostEqual(a, b, delta=1e-12)
            self.assertAlmostEqual(weight * b, in_pixel, delta=1e-12)

    def test_the_terms_of_the_json_add_up(self):
        data = self.data()
        self.assertEqual(data["format"], "alhazen explanation 1")
        self.assertEqual(data["tree"]["surfaces"][0]["object"], NAME)
        self.check_ray(data["tree"], data["background"])
        self.assertEqual(data["tree"]["radiance"], data["pixel"])
        self.assertEqual(data["points"], [])

    def test_the_samples_are_those_of_the_picture(self):
        data = self.data("--spp", "4", "--sample", "2")
        self.assertEqual(len(data["samples"]), 4)
        self.assertEqual(data["tree"]["radiance"], data["samples"][2]["radiance"])
        for sample in data["samples"]:
            self.assertTrue(all(0 <= c <= 1 for c in sample["place"]))
        picture = self.folder / "pixel.pfm"
        subprocess.run([ALHAZEN, "render", str(self.scene), "-o", str(picture), "--spp", "4", "--crop", "22,22,23,23",
                        "-q"], check=True, timeout=60)
        values = struct.unpack("<3f", picture.read_bytes()[-12:])
        for a, b in zip(values, data["pixel"]):
            self.assertAlmostEqual(a, b, delta=1e-6)

    def test_spans_and_steps_are_there(self):
        data = self.data("--steps", "kd_tree")
        solid = data["solids"][0]
        self.assertEqual(solid["combination"]["operator"], "difference")
        self.assertEqual([o["name"] for o in solid["combination"]["operands"]], [NAME, "drill"])
        self.assertEqual(data["traversal"]["accelerator"], "kd_tree")
        self.assertEqual([w["accelerator"] for w in data["traversal"]["work"]], ["kd_tree", "list", "wide_bvh"])

    def pixel_of(self, scene, renderer, x, y):
        """The renderer's colour of a pixel."""
        picture = self.folder / "pixel.pfm"
        subprocess.run([ALHAZEN, "render", str(scene), "-o", str(picture), "--size", "60x45", "--renderer", renderer,
                        "--crop", f"{x},{y},{x + 1},{y + 1}", "-q"], check=True, timeout=60)
        return struct.unpack("<3f", picture.read_bytes()[-12:])

    def of_method(self, scene, renderer, x, y):
        result = subprocess.run([ALHAZEN, "explain", str(scene), "-o", "-", "--pixel", f"{x},{y}", "--size", "60x45",
                                 "--renderer", renderer, "--steps", "list"], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def check_cone(self, cone, background):
        total = [cone["left"] * c for c in background]
        for part in cone["parts"]:
            total = plus(total, [part["weight"] * c for c in part["color"]])
            self.assertTrue(0 < part["weight"] <= 1 and 0 < part["share"] <= 1.0001, part)
            for onward in part["cones"]:
                if onward["kind"] != "shadow":
                    self.check_cone(onward, background)
        for a, b in zip(total, cone["radiance"]):
            self.assertAlmostEqual(a, b, delta=1e-9)

    def test_cones_add_up_to_the_pixel_of_their_renderer(self):
        scene = self.folder / "cones.alhazen"
        scene.write_text(FLAT + 'sphere "ball" { center = (0.5, 1, 0); radius = 0.8; material = "mirror" }\n', encoding="utf-8")
        kinds = set()
        for x, y in ((18, 24), (34, 20), (43, 14)):  # block, ball, and its edge
            data = self.of_method(scene, "cone_tracing", x, y)
            tree = data["cones"]["tree"]
            self.check_cone(tree, data["background"])
            for a, b in zip(self.pixel_of(scene, "cone_tracing", x, y), tree["radiance"]):
                self.assertAlmostEqual(a, b, delta=1e-6)
            kinds |= {c["kind"] for p in tree["parts"] for c in p["cones"]}
        self.assertEqual(kinds, {"shadow", "reflection"})
        refused = self.of_method(self.scene, "cone_tracing", 22, 22)["cones"]
        self.assertIn("torus", refused["unavailable"])

    def test_pieces_of_beams_add_up_to_the_pixel_of_their_renderer(self):
        scene = self.folder / "beams.alhazen"
        scene.write_text(FLAT, encoding="utf-8")
        deepest = 0
        for x, y in ((18, 24), (30, 36), (40, 20), (2, 2)):
            beams = self.of_method(scene, "beam_tracing", x, y)["beams"]
            pieces = {p["id"]: p for p in beams["pieces"]}
            total = [0, 0, 0]
            for piece in beams["pieces"]:
                self.assertTrue(-1e-9 <= piece["share"] <= 1 + 1e-6)
                self.assertIn(piece["from"], pieces)
                if not piece["here"]:
                    continue
                deepest = max(deepest, piece["depth"])
                total = plus(total, piece["own"])
                for light in piece["lights"]:
                    total = plus(total, light["color"]) if light["here"] else total
            self.assertAlmostEqual(sum(p["share"] for p in beams["pieces"] if p["depth"] == 0), 1, delta=1e-6)
            for a, b, c in zip(self.pixel_of(scene, "beam_tracing", x, y), beams["color"], total):
                self.assertAlmostEqual(a, b, delta=1e-6)
                self.assertAlmostEqual(b, c, delta=1e-12)
        self.assertGreater(deepest, 0, "no mirror image in view")

    def test_patches_are_subdivided_around_their_crossings(self):
        scene = self.folder / "patch.alhazen"
        points = ", ".join(f"({x}, {0.6 * ((x + y) % 2)}, {y})" for x in range(-2, 2) for y in range(-2, 2))
        scene.write_text(FLAT + f'bezier_patch "sheet" {{ points = [{points}]; material = "matt" }}\n', encoding="utf-8")
        data = self.of_method(scene, "whitted", 30, 28)
        [patch] = data["patches"]
        self.assertEqual((patch["object"], patch["degree"], patch["cut"]), ("sheet", [3, 3], False))
        self.assertTrue(patch["crossings"])
        if data["tree"]["surfaces"][0]["object"] == "sheet":
            self.assertAlmostEqual(patch["crossings"][0]["t"], data["tree"]["surfaces"][0]["t"], delta=1e-9)
        met = {(p["level"], p["u"], p["v"]) for p in patch["parts"] if p["met"]}
        deepest = max(p["level"] for p in patch["parts"])
        for crossing in patch["crossings"]:
            for level in range(deepest):
                self.assertIn((level, int(crossing["u"] * 2 ** level), int(crossing["v"] * 2 ** level)), met)
        self.assertLess(len(patch["parts"]), 600)

    def test_wrong_usage_says_what_was_expected(self):
        for options, message in ((("--pixel", "60,0", "-o", "-"), "is not in a picture of 60x45"),
                                 (("--pixel", "1;2", "-o", "-"), "expected X,Y"),
                                 (("--pixel", "1,2", "-o", "x.png"), "ends in .html or .json"),
                                 (("--pixel", "1,2", "-o", "-", "--sample", "1"), "the pixel has 1"),
                                 (("--pixel", "1,2", "-o", "-", "--renderer", "sppm"), "beam_tracing"),
                                 (("--pixel", "1,2", "-o", "-", "--steps", "wide_bvh"), "traceable accelerators: list")):
            result = self.explain(*options)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(message, result.stderr)

    def test_the_page_names_no_other_place(self):
        without = re.sub(r"base64,[A-Za-z0-9+/=]*", "", self.text).replace("http://www.w3.org/2000/svg", "")
        self.assertEqual(re.findall(r"(?:https?:)?//[a-z]+\.", without), [])
        self.assertIn("default-src 'none'", self.text)
        self.assertNotIn("<img src=x", self.text)

    def in_browser(self, width, height, dark):
        """Uses the page; returns its results, the console output and its network requests."""
        page = self.folder / "used.html"
        page.write_text(self.text.replace("<style>", BEFORE + "<style>", 1).replace("</body>", AFTER + "</body>"),
                        encoding="utf-8")
        name = f"explain_{width}x{height}{'_dark' if dark else ''}.png"
        return self.used(page, width, height, dark, [(self.page, SCREENSHOTS / name)] if SCREENSHOTS else [])

    def check(self, width, height, dark=False):
        seen, console, requests = self.in_browser(width, height, dark)
        data = json.loads(re.search(r'id="data">(.*?)</script>', self.text, re.DOTALL).group(1))
        rays = data["rays"]
        self.assertEqual((seen["errors"], console, requests), ([], [], []))
        self.assertEqual(seen["rays"], rays["eye"] + rays["reflection"] + rays["refraction"])
        self.assertGreater(seen["rays"], 4)
        self.assertGreater(seen["tables"], 3)
        self.assertIn("The samples of the pixel", seen["headings"])
        self.assertEqual(seen["selected"], [1, 1, 1])
        self.assertEqual(seen["pictures"], [5, 5], "some action drew nothing new")
        self.assertTrue(seen["step"].startswith("Step 3 of "), seen["step"])
        self.assertGreater(seen["in"], 0)
        self.assertGreaterEqual(seen["roots"], 2)
        self.assertEqual(seen["unnamed"], 0)
        self.assertEqual(seen["images"], [True])
        self.assertLessEqual(seen["overflow"], 0)

    def test_a_browser_shows_it_without_errors_and_without_the_network(self):
        self.check(1400, 1400)

    def test_it_fits_a_phone_in_the_dark(self):
        self.check(500, 1600, dark=True)


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if program.result.skipped else 0)
