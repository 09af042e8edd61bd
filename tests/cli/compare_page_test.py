#!/usr/bin/env python3
"""The page of `alhazen compare --html`: its contents and its behaviour in a browser.

Usage: compare_page_test.py ALHAZEN [SCREENSHOT_FOLDER]

Without a browser (chromium, google-chrome) the tests of the page in a browser are skipped, with a message; the others run. With
SCREENSHOT_FOLDER screenshots of the page are written there. `scripts/setup --browser` installs one.
"""

import html.parser
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from browser_session import FilePages

ALHAZEN = sys.argv[1]
SCREENSHOTS = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None

SCENE = """alhazen 1
perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.5, 0); up = (0, 1, 0); fov_deg = 40 }
point_light { position = (3, 5, 4); color = (1, 1, 1) }
material "mirror" { diffuse = 0.1; reflective = 0.8 }
material "glass" { transmissive = 0.8; index = 1.4 }
sphere { center = (0, 1, 0); radius = 1; material = "mirror" }
sphere { center = (1.5, 0.6, 1); radius = 0.6; material = "glass" }
box { lo = (-2, 0, 0); hi = (-1.2, 0.8, 0.8); material = "mirror" }
plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }
"""

# Inserted into a copy of the page: uses it as a reader would, and records the results in the document.
BEFORE = """<script>window.seen = {errors: []};
addEventListener("error", e => seen.errors.push(String(e.message)));
addEventListener("securitypolicyviolation", e => seen.errors.push("policy: " + e.blockedURI));</script>"""
AFTER = """<script>
const report = () => {
  const table = document.querySelector("table"), heads = [...table.tHead.rows[0].cells];
  const column = n => [...table.tBodies[0].rows].map(r => Number(r.cells[n].dataset.value));
  heads[1].querySelector("button").click();
  seen.up = column(1);
  heads[1].querySelector("button").click();
  seen.down = column(1);
  seen.sort = heads[1].getAttribute("aria-sort");
  const thumbs = [...document.querySelectorAll(".thumbs button")];
  const over = document.querySelectorAll(".stage img")[1];
  thumbs[1].click();
  seen.shown = document.querySelector(".shown").textContent;
  seen.alt = over.alt;
  seen.pressed = thumbs.filter(b => b.getAttribute("aria-pressed") === "true").length;
  const range = document.querySelector(".viewer input");
  range.value = "80";
  range.dispatchEvent(new Event("input"));
  seen.cut = document.querySelector(".stage").style.getPropertyValue("--cut");
  const ground = () => getComputedStyle(document.body).backgroundColor;
  seen.ground = [ground()];
  document.getElementById("theme").click();
  seen.ground.push(ground());
  document.getElementById("theme").click();
  seen.images = [...document.images].every(i => i.complete && i.naturalWidth > 0);
  seen.overflow = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  const result = document.createElement("pre");
  result.id = "seen";
  result.textContent = JSON.stringify(seen);
  document.body.append(result);
};
addEventListener("load", report);
</script>"""


class Elements(html.parser.HTMLParser):
    """Records unclosed elements, ids, and the attributes of all elements."""

    EMPTY = {"meta", "link", "img", "input", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.wrong, self.elements = [], [], []

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.wrong.append((tag, self.getpos()))


class ComparePage(FilePages, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.open_browser()
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        # A name that would end text and attributes if it were not escaped.
        scene = cls.folder / 'a <b> & "c".alhazen'
        scene.write_text(SCENE, encoding="utf-8")
        cls.page = cls.folder / "page.html"
        result = subprocess.run(
            [ALHAZEN, "compare", str(scene), "--size", "48x36", "--time-limit", "0.3", "--html", str(cls.page),
             "--json", str(cls.folder / "report.json"), "-q"],
            capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, result.stderr
        cls.terminal = result.stdout
        cls.text = cls.page.read_text(encoding="utf-8")
        cls.report = json.loads((cls.folder / "report.json").read_text(encoding="utf-8"))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def names(self):
        return [a["accelerator"] for a in self.report["scenes"][0]["accelerators"]]

    def test_the_page_is_well_formed_and_says_what_its_pictures_are(self):
        parser = Elements()
        parser.feed(self.text)
        parser.close()
        self.assertEqual((parser.open, parser.wrong), ([], []))
        for tag, attributes in parser.elements:
            if tag == "img":
                self.assertTrue(attributes.get("alt"), attributes)
                self.assertTrue(attributes["src"].startswith("data:image/png;base64,"))
            if tag == "input":
                self.assertIn("aria-label", attributes)
        ids = [a["id"] for _, a in parser.elements if "id" in a]
        self.assertEqual(len(ids), len(set(ids)))
        self.assertNotIn("<b>", self.text.split("</style>")[1].split('<b class="shown">')[0])

    def test_the_page_names_every_accelerator_and_no_other_place(self):
        for name in self.names():
            self.assertIn(name.split(":")[0], self.text)
            self.assertIn(name.split(":")[0], self.terminal)
        without_pictures = re.sub(r"base64,[A-Za-z0-9+/=]*", "", self.text)
        self.assertEqual(re.findall(r"(?:https?:)?//[a-z]", without_pictures), [])
        self.assertIn("default-src 'none'", self.text)

    def in_browser(self, width, height, dark=False, change=lambda text: text):
        """Uses the page; returns its results, the console output and its network requests."""
        page = self.folder / "used.html"
        page.write_text(change(self.text).replace("<style>", BEFORE + "<style>", 1).replace("</body>", AFTER + "</body>"),
                        encoding="utf-8")
        name = f"page_{width}x{height}{'_dark' if dark else ''}.png"
        return self.used(page, width, height, dark, [(self.page, SCREENSHOTS / name)] if SCREENSHOTS else [])

    def test_the_test_would_notice_a_request(self):
        def with_request(text):
            text = text.replace("default-src 'none'; img-src data:;", "img-src http: data:;")
            return text.replace("</main>", '<img alt="" src="http://unknown.invalid/x.png"></main>')

        _, _, requests = self.in_browser(1200, 1400, change=with_request)
        self.assertIn("http://unknown.invalid/x.png", requests)

    def check(self, width, height, dark=False):
        seen, console, requests = self.in_browser(width, height, dark)
        self.assertEqual(seen["errors"], [])
        self.assertEqual(console, [])
        self.assertEqual(requests, [])
        self.assertEqual(seen["up"], sorted(seen["up"]))
        self.assertEqual(seen["down"], sorted(seen["up"], reverse=True))
        self.assertEqual(len(seen["up"]), len(self.names()))
        self.assertEqual(seen["sort"], "descending")
        self.assertEqual(seen["shown"], "list")
        self.assertEqual(seen["alt"], "Cost of each pixel with list")
        self.assertEqual(seen["pressed"], 1)
        self.assertEqual(seen["cut"], "80%")
        self.assertNotEqual(seen["ground"][0], seen["ground"][1])
        self.assertTrue(seen["images"])
        self.assertLessEqual(seen["overflow"], 0)
        return seen

    def test_a_browser_shows_it_without_errors_and_without_the_network(self):
        self.check(1200, 1400)

    def test_it_fits_a_phone_and_a_dark_one(self):
        light = self.check(500, 1200)
        dark = self.check(500, 1200, dark=True)
        self.assertEqual(light["ground"][1], dark["ground"][0])


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if program.result.skipped else 0)
