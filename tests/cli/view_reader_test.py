#!/usr/bin/env python3
"""The pages of `alhazen view` and `alhazen explain` with screen readers and without a mouse.

Usage: view_reader_test.py ALHAZEN

Tests Chromium's accessibility tree, the input of screen readers. Skipped, with a message, without a browser:
`scripts/setup --browser` installs one.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from browser_session import Browser, browser
from page_reader import Reader
from view_server import LIGHTS, SCENE, Server

ALHAZEN = sys.argv[1]
FINE = "globalThis.viewer?.frames > 0 && viewer.done() && viewer.shownGeneration === viewer.generation"
EXPLAINED = "document.querySelectorAll('#explanation .ray').length > 0"
# A scene that the cone and beam renderers accept: no torus, no endless plane.
FLAT = "\n".join(line for line in SCENE.split("\n") if not line.startswith("plane")).replace("sphere", "// sphere") + \
    'rectangle "floor" { corner = (-4, 0, -4); edge_u = (0, 0, 8); edge_v = (8, 0, 0); material = "mirror" }\n'


@unittest.skipIf(browser() is None, "no chromium here: scripts/setup --browser installs it")
class PageForReaders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.scene = self.folder / "scene.alhazen"
        self.page = self.browser.open(1300, 900)
        self.server = None

    def tearDown(self):
        self.page.close()
        if self.server:
            self.server.close()
        self.temporary.cleanup()

    def open(self, text):
        self.scene.write_text(text, encoding="utf-8")
        self.server = Server(ALHAZEN, self.scene)
        self.page.call("Page.navigate", url=self.server.url)
        self.page.wait(FINE)

    def choose(self, key, value):
        self.page.value(f"viewer.controls.choose('{key}', '{value}')")
        self.page.wait(FINE)

    def explain(self, u=0.5, v=0.6):
        self.page.value(f"document.getElementById('explanation').replaceChildren(); viewer.explain({u}, {v})")
        self.page.wait(EXPLAINED)

    def check(self, what):
        reader = Reader(self.page)
        self.assertEqual(reader.faults(), [], what)
        self.assertEqual(reader.mouse_only(), [], what)
        self.assertEqual(reader.not_reached(), [], what)
        return reader

    def tab_to(self, name):
        """Presses Tab until an element with this name has the focus."""
        for _ in range(300):
            self.page.key("Tab")
            if any(n.name.startswith(name) for n in Reader(self.page).nodes if n.properties.get("focused")):
                return
        self.fail(f"the Tab key does not come to {name!r}")

    def test_every_control_has_a_role_and_a_name_and_is_reached_by_keys(self):
        self.open(LIGHTS)
        self.check("at first")
        self.page.value("document.getElementById('lights').open = true")
        self.page.value("document.querySelectorAll('#lights .light button').forEach(b => b.click())")
        for button in ("Camera block", "Light blocks"):
            self.page.value(f"[...document.querySelectorAll('button')].find(b => b.textContent === '{button}').click()")
        self.choose("layer", "depth")
        self.choose("layer", "")
        self.explain()
        self.page.value("document.querySelectorAll('#explanation details').forEach(d => { d.open = true; })")
        reader = self.check("explained")
        roles = {n.role for n in reader.controls()}
        self.assertLessEqual({"button", "checkbox", "combobox", "spinbutton", "slider", "textbox", "DisclosureTriangle",
                              "application"}, roles)
        self.choose("renderer", "path_tracing")
        self.explain()
        self.check("path_tracing")

    def test_explanations_of_cones_and_beams_are_for_readers_too(self):
        self.open(FLAT)
        for renderer, place in (("cone_tracing", "#cones .cone"), ("beam_tracing", "#beams tbody tr")):
            self.choose("renderer", renderer)
            self.explain(0.26, 0.8)
            self.page.wait(f"document.querySelectorAll('{place}').length > 0")
            reader = self.check(renderer)
            if renderer == "cone_tracing":
                self.check_levels(reader, reader.of("list", "Cones")[0], 1)

    def test_the_page_of_explain_is_for_readers_too(self):
        self.scene.write_text(SCENE, encoding="utf-8")
        page = self.folder / "page.html"
        subprocess.run([ALHAZEN, "explain", str(self.scene), "-o", str(page), "--pixel", "80,60", "--steps", "octree",
                        "--spp", "4", "-q"], check=True, timeout=60)
        self.page.call("Page.navigate", url=page.as_uri())
        self.page.wait("document.querySelectorAll('.ray').length > 0")
        reader = self.check("explain")
        self.check_levels(reader, reader.of("list", "Rays")[0], 1)

    def test_a_label_that_is_missing_is_found(self):
        self.open(LIGHTS)
        self.page.value("document.getElementById('lights').open = true")
        self.page.value("document.querySelectorAll('#lights .light button').forEach(b => b.click())")
        self.explain()
        self.assertEqual(Reader(self.page).faults(), [])
        # An element outside the Tab order, and one that only a mouse can click.
        self.page.value("document.querySelector('[name=samples]').tabIndex = -1")
        self.assertEqual([n.name for n in Reader(self.page).not_reached()], ["samples"])
        self.page.value("document.getElementById('status').onclick = () => {}")
        self.assertEqual(Reader(self.page).mouse_only(), ["P"])
        # A name that is removed alone is missed, and found again when it is back: a button, the label of a field, a fold.
        for selector in "#lights .light button", "label:has([name=samples])", "#lights summary":
            self.assertEqual(self.page.value(f"""(() => {{
                const e = globalThis.one = document.querySelector({json.dumps(selector)});
                globalThis.before = [e.getAttribute('aria-label'), e.title];
                e.removeAttribute('aria-label'); e.removeAttribute('title');
                const texts = document.createTreeWalker(e, NodeFilter.SHOW_TEXT);
                globalThis.words = [];
                while (texts.nextNode()) {{ words.push([texts.currentNode, texts.currentNode.data]); texts.currentNode.data = ''; }}
                return e.checkVisibility();
            }})()"""), True, selector)
            self.assertNotEqual(Reader(self.page).faults(), [], selector)
            self.page.value("""words.forEach(([node, data]) => { node.data = data; });
                if (before[0] !== null) one.setAttribute('aria-label', before[0]);
                if (before[1]) one.title = before[1];""")
            self.assertEqual(Reader(self.page).faults(), [], selector)
        # Names by attributes, by labels, by texts: each one that is removed is missed.
        self.page.value("""globalThis.names = [...document.querySelectorAll('[aria-label],[alt],label,button,summary')]
            .filter(e => e.checkVisibility() && !['UL', 'SECTION', 'FORM'].includes(e.tagName) && e.id !== 'explanation')""")
        what = self.page.value("names.map(e => e.outerHTML.slice(0, 400))")
        self.assertGreater(len(what), 60)
        self.page.value("""names.forEach(e => {
            if (e.hasAttribute('aria-label')) e.removeAttribute('aria-label');
            else if (e.alt) e.removeAttribute('alt');
            else {
                const texts = document.createTreeWalker(e, NodeFilter.SHOW_TEXT), list = [];
                while (texts.nextNode()) if (!texts.currentNode.parentElement.closest('option')) list.push(texts.currentNode);
                list.forEach(t => { t.data = ''; });
                e.removeAttribute('title');
            }
        })""")
        reader = Reader(self.page)
        missed = {n.element for n in reader.without_role() + reader.without_name()}
        for i, html in enumerate(what):
            found = self.page.call("Runtime.evaluate", expression=f"names[{i}].control ?? names[{i}]")["result"]["objectId"]
            element = self.page.call("DOM.describeNode", objectId=found)["node"]["backendNodeId"]
            if not re.match(r'<button[^>]*aria-label="[^>]*>\w', html):  # a button that keeps a name, its words
                self.assertIn(element, missed, f"not missed: {html}")

    def check_levels(self, reader, node, level):
        """Checks that each item of an outline has its level and its fold its state; returns the deepest level."""
        items = reader.below(node, "listitem")
        self.assertTrue(items)
        deepest = level
        for item in items:
            self.assertEqual(item.properties.get("level"), level)
            self.assertIsInstance(reader.below(item, "DisclosureTriangle")[0].properties.get("expanded"), bool)
            for inner in reader.below(item, "list"):
                deepest = max(deepest, self.check_levels(reader, inner, level + 1))
        return deepest

    def test_the_tree_of_rays_is_an_outline_with_levels_that_folds(self):
        self.open(SCENE)
        self.explain(0.45, 0.5)
        reader = Reader(self.page)
        rays = reader.of("list", "Rays")[0]
        self.assertGreaterEqual(self.check_levels(reader, rays, 1), 2)
        first = reader.below(rays, "DisclosureTriangle")[0]
        self.assertIn("eye ray", first.name)
        self.assertTrue(first.properties["expanded"])
        self.page.value("document.querySelector('.outline summary').focus()")
        self.page.key("Enter")
        reader = Reader(self.page)
        first = reader.below(reader.of("list", "Rays")[0], "DisclosureTriangle")[0]
        self.assertFalse(first.properties["expanded"])
        self.assertTrue(first.properties["focused"])

    def test_the_picture_is_told_in_words(self):
        self.open(SCENE)

        def picture():
            found, = Reader(self.page).of("application", "Picture")
            self.assertIn("arrow keys turn", found.description)
            return found.name

        self.assertEqual(picture(), "Picture of scene.alhazen, from camera front, by whitted")
        self.choose("camera", "1")
        self.choose("layer", "depth")
        self.choose("renderer", "ray_casting")
        self.page.value("viewer.image.focus()")
        self.page.key("ArrowLeft")
        self.page.wait(FINE)
        self.assertEqual(picture(), "Picture of scene.alhazen, layer depth, from a view that began at camera side, by ray_casting")

    def test_what_happens_is_said_and_no_more(self):
        self.open(SCENE)
        self.assertRegex(Reader(self.page).said("polite"), r"The picture is done: 160 by 120, 4 samples a pixel, [\d.]+ m?s")
        self.assertEqual(Reader(self.page).said("assertive"), "")
        # Moving changes no live region more than needed: each change would be read aloud.
        said = self.page.value("""(async () => {
            let count = 0;
            const watch = new MutationObserver(list => {
                const heard = node => !(node instanceof Element ? node : node.parentElement).closest('[aria-hidden]');
                count += list.filter(r => heard(r.target)).length;
            });
            for (const e of document.querySelectorAll('[aria-live],[role=status],[role=alert],output')) {
                watch.observe(e, {childList: true, characterData: true, subtree: true, attributeFilter: ['role', 'aria-live']});
            }
            const shown = viewer.frames, begin = performance.now();
            while (performance.now() - begin < 1500) {
                viewer.move(camera => camera.orbit(0.01, 0), false);
                await new Promise(go => setTimeout(go, 16));
            }
            return [viewer.frames - shown, count];
        })()""")
        self.assertGreater(said[0], 3)
        self.assertLessEqual(said[1], 2)
        self.page.wait(FINE)
        # An explanation gets the focus; its thousands of words are not live.
        self.page.value("viewer.image.focus()")
        self.page.key("Enter")
        self.page.wait(EXPLAINED + " && document.activeElement.id === 'explanation'")
        reader = Reader(self.page)
        focused, = [n for n in reader.nodes if n.properties.get("focused") and n.role != "RootWebArea"]
        self.assertEqual((focused.role, focused.name), ("region", "Explanation of pixel 80,60"))
        self.assertIsNone(focused.properties.get("live"))
        # The message of an error at its line, and of its removal.
        self.scene.write_text(SCENE.replace("radius = 1;", "radius = = 1;"), encoding="utf-8")
        self.page.wait("document.getElementById('message').textContent.includes('scene.alhazen:9:')")
        self.assertIn("scene.alhazen:9:", Reader(self.page).said("assertive"))
        self.scene.write_text(SCENE.replace("radius = 1;", "radius = 0.7;"), encoding="utf-8")
        self.page.wait(f"document.getElementById('message').hidden && viewer.scene.version > 1 && {FINE}")
        reader = Reader(self.page)
        self.assertEqual(reader.said("assertive"), "")
        self.assertIn("The picture is done", reader.said("polite"))
        # The server is lost.
        self.server.process.kill()
        self.page.wait("document.getElementById('message').textContent.includes('does not answer')")
        self.assertIn("does not answer", Reader(self.page).said("assertive"))

    def test_reading_a_large_file_is_said(self):
        self.scene.write_text(SCENE + "".join(
            f'sphere {{ center = ({i % 700}, -500, {i // 700}); radius = 0.4; material = "red" }}\n' for i in range(200000)),
            encoding="utf-8")
        self.server = Server(ALHAZEN, self.scene)
        self.page.call("Page.navigate", url=self.server.url)
        self.page.wait("globalThis.viewer && document.getElementById('work')?.textContent.startsWith('reading scene.alhazen')")
        self.assertIn("reading scene.alhazen", Reader(self.page).said("polite"))

    def test_a_pixel_is_chosen_and_explained_by_keys_alone(self):
        self.open(SCENE)
        self.tab_to("Column of the pixel")
        self.page.call("Input.insertText", text="47")
        self.tab_to("Row of the pixel")
        self.page.call("Input.insertText", text="62")
        self.page.key("Enter")
        self.page.wait(EXPLAINED + " && document.activeElement.id === 'explanation'")
        self.assertTrue(Reader(self.page).of("heading", "Pixel 47,62 of scene.alhazen"))
        # The rays in space are rotated, moved and selected by keys.
        self.tab_to("show shadow rays")
        self.page.key("Tab", modifiers=8)
        drawn = set()
        for key, shift in (("ArrowLeft", 0), ("ArrowUp", 0), ("ArrowLeft", 8), ("ArrowUp", 8), ("+", 0), ("0", 0)):
            self.page.key(key, modifiers=shift)
            drawn.add(self.page.value("document.querySelector('canvas.space').toDataURL()"))
        self.assertEqual(len(drawn), 6)


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(77 if program.result.skipped else 0)
