"""The page of `alhazen view` in a browser, for its tests. Program and, if given, folder of screenshots are the arguments."""

import base64
import pathlib
import sys
import tempfile
import unittest

from browser_session import Browser, browser
from view_server import SCENE, Server

ALHAZEN = sys.argv[1]
SCREENSHOTS = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
READY = "globalThis.viewer?.frames > 0 && viewer.image.width > 0"
# True if the last frame of the view is shown, after all levels.
FINE = f"({READY}) && viewer.done() && viewer.shownGeneration === viewer.generation"
MESSAGE = "(document.getElementById('message')?.textContent ?? '')"


@unittest.skipIf(browser() is None, "no chromium here: scripts/setup --browser installs it")
class ViewerPage(unittest.TestCase):
    """A server of `SCENE` and, once it is opened, its page; all tests of a class share the browser."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.scene = self.folder / "scene.alhazen"
        self.scene.write_text(SCENE, encoding="utf-8")
        self.server = Server(ALHAZEN, self.scene)

    def tearDown(self):
        self.page.close()
        self.server.close()
        self.temporary.cleanup()

    def open(self, width, height):
        self.page = self.browser.open(width, height)
        self.page.call("Page.navigate", url=self.server.url)
        self.page.wait(READY)
        self.page.wait(FINE)

    def shoot(self, name):
        if SCREENSHOTS:
            self.page.screenshot(SCREENSHOTS / f"{name}.png")

    def picture(self):
        """The colours of the picture at a coarse resolution."""
        return self.page.value("""(() => {
            const c = document.createElement("canvas");
            c.width = 16; c.height = 12;
            const g = c.getContext("2d");
            g.drawImage(viewer.image, 0, 0, 16, 12);
            return [...g.getImageData(0, 0, 16, 12).data].join();
        })()""")

    def shown(self):
        """Width, height and pixels of the picture."""
        width, height, text = self.page.value("""(() => {
            const i = viewer.image, c = document.createElement("canvas");
            [c.width, c.height] = [i.width, i.height];
            const g = c.getContext("2d", {willReadFrequently: true});
            g.drawImage(i, 0, 0);
            const d = g.getImageData(0, 0, i.width, i.height).data;
            let s = "";
            for (let k = 0; k < d.length; k += 8192) s += String.fromCharCode(...d.subarray(k, k + 8192));
            return [i.width, i.height, btoa(s)];
        })()""")
        data = base64.b64decode(text)
        return width, height, b"".join(data[i:i + 3] for i in range(0, len(data), 4))

    def serve(self, scene, *options):
        """A server of another scene, and its page."""
        self.server.close()
        if hasattr(self, "page"):
            self.page.close()
        self.server = Server(ALHAZEN, scene, *options)
        self.open(900, 700)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def click(self, text):
        self.page.value(f"[...document.querySelectorAll('button')].find(b => b.textContent === '{text}').click()")

    def place(self, u, v):
        box = self.page.value("(b => [b.left, b.top, b.width, b.height])(viewer.image.getBoundingClientRect())")
        return box[0] + u * box[2], box[1] + v * box[3]

    def changes(self, act):
        """Expects that `act` changes the picture."""
        before = self.picture()
        act()
        self.page.wait(FINE)
        self.assertNotEqual(self.picture(), before)

    def edit(self, text):
        before = self.page.value("viewer.scene.version")
        self.scene.write_text(text, encoding="utf-8")
        self.page.wait(f"viewer.scene.version > {before}")

    def choose(self, key, value):
        self.page.value(f"viewer.controls.choose('{key}', '{value}')")

    def check_quiet(self):
        self.assertEqual(self.page.console, [])
        own = (f"http://{self.server.host}/", f"ws://{self.server.host}/frames", "blob:", "data:", "about:")
        for url in self.page.requests:
            self.assertTrue(url.startswith(own), url)


def run_tests():
    program = unittest.main(argv=sys.argv[:1], exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if program.result.skipped else 0)
