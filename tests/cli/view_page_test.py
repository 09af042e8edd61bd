#!/usr/bin/env python3
"""The page of `alhazen view` in a browser.

Usage: view_page_test.py ALHAZEN [SCREENSHOT_FOLDER]

Skipped, with a message, without a browser: `scripts/setup --browser` installs one.
"""

import signal
import struct
import time

from browser_session import SLOWDOWN
from view_server import SCENE, Server
from viewer_page import ALHAZEN, FINE, MESSAGE, READY, ViewerPage, run_tests


class ViewPage(ViewerPage):
    def test_it_moves_explains_switches_and_follows_the_file(self):
        page = None
        self.open(1300, 900)
        page = self.page
        self.assertEqual(page.value("location.hash"), "")
        self.shoot("view")
        first = self.picture()

        def drag():
            x, y = self.place(0.5, 0.5)
            page.mouse("mousePressed", x, y, 1)
            for i in range(1, 9):
                page.mouse("mouseMoved", x + 12 * i, y + 4 * i, 1)
            page.mouse("mouseReleased", x + 96, y + 32)

        self.changes(drag)
        self.changes(lambda: page.value("[...document.querySelectorAll('button')].find(b => b.textContent === 'Undo').click()"))
        self.assertEqual(self.picture(), first)
        page.value("viewer.image.focus()")
        for key in ("ArrowLeft", "+", "w", "D"):
            self.changes(lambda: page.key(key))
        # Shift and an arrow key translate instead of rotating.
        look = page.value("viewer.camera.look.join()")
        for key in ("ArrowLeft", "ArrowUp"):
            self.changes(lambda: page.key(key, modifiers=8))
        self.assertEqual(page.value("viewer.camera.look.join()"), look)
        self.changes(lambda: self.choose("renderer", "ray_casting"))
        self.changes(lambda: self.choose("camera", "1"))
        self.choose("accelerator", "octree")
        page.wait(FINE)
        # A layer shows its scale, also as text.
        self.changes(lambda: self.choose("layer", "depth"))
        self.assertRegex(page.value("viewer.scale.textContent"), r"^depth\d")
        self.assertIn("linear-gradient", page.value("document.querySelector('.bar-of-scale').style.background"))
        self.shoot("view_layer")
        self.changes(lambda: self.choose("layer", ""))
        self.assertTrue(page.value("viewer.scale.hidden"))
        # A click explains a pixel; the ball is in the middle.
        x, y = self.place(0.5, 0.5)
        page.mouse("mousePressed", x, y, 1)
        page.mouse("mouseReleased", x, y)
        page.wait("document.querySelectorAll('#explanation .ray').length > 0")
        self.assertIn("ball", page.value("document.querySelector('#explanation summary').textContent"))
        self.assertIn("samples a pixel", page.value("document.getElementById('status').textContent"))
        self.shoot("view_explained")
        # The text block is a camera with the same view.
        block = page.value("viewer.camera.block()")
        self.assertIn("perspective_camera \"view\"", block)
        # After a change of the file: an error at its line with the last good picture, then the new one.
        shown = self.picture()
        self.scene.write_text(SCENE.replace("radius = 1;", "radius = = 1;"), encoding="utf-8")
        page.wait("" + MESSAGE + ".includes('scene.alhazen:9:')")
        self.assertEqual(self.picture(), shown)
        self.shoot("view_error")
        # The menus are updated, and the selection stays.
        better = SCENE.replace("radius = 1;", "radius = 0.5;").replace("point_light",
            'perspective_camera "top" { eye = (0, 7, 1); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }\npoint_light')
        self.changes(lambda: (self.scene.write_text(better, encoding="utf-8"),
                              page.wait("viewer.scene.version > 1 && document.getElementById('message').hidden")))
        self.assertEqual(page.value("viewer.controls.options('camera').join()"), "front,side,top")
        self.assertEqual(page.value("viewer.controls.get('camera') + viewer.controls.get('renderer')"), "1ray_casting")
        self.check_quiet()
        # After the loss of the server the page reports it and keeps the picture.
        self.server.process.kill()
        page.wait(MESSAGE + ".includes('does not answer')")
        self.assertTrue(page.value(READY))
        self.shoot("view_lost")

    def test_a_depth_is_sent_where_one_is_chosen(self):
        self.open(900, 700)
        page = self.page
        depth = "viewer.controls.number('depth')"

        def sent():
            return page.value("viewer.wish(viewer.camera, 64).depth ?? null")

        self.assertEqual((page.value(depth), sent()), (4, None))
        # A path tracing renderer has its own default depth until one is chosen.
        self.changes(lambda: self.choose("renderer", "path_tracing"))
        self.assertEqual((page.value(depth), sent()), (63, None))
        self.changes(lambda: self.choose("depth", "0"))
        self.assertEqual(sent(), 0)
        self.changes(lambda: self.choose("renderer", "whitted"))
        self.assertEqual((page.value(depth), sent()), (0, 0))
        # An emptied field restores the default, the scene's depth.
        self.changes(lambda: self.choose("depth", ""))
        self.assertEqual((page.value(depth), sent()), (4, None))
        self.changes(lambda: self.edit(SCENE.replace("max_depth = 4", "max_depth = 0")))
        self.assertEqual((page.value(depth), sent()), (0, None))
        self.check_quiet()

    def test_refinement_goes_on_after_an_explanation_and_after_a_frame_that_was_ended(self):
        self.open(900, 700)
        page = self.page

        def begin_long():
            self.choose("samples", "400")
            page.wait("viewer.level === 4")

        begin_long()
        page.value("viewer.explain(0.5, 0.5)")
        page.wait("document.querySelectorAll('#explanation .ray').length > 0")
        page.value("viewer.controls.set('samples', '30')")
        page.wait(FINE)
        # The server ends without a request of the page.
        begin_long()
        self.assertEqual(self.server.ask("/stop", {"client": page.value("viewer.client")})[0], 200)
        page.value("viewer.controls.set('samples', '20')")
        page.wait(FINE)
        # Stop keeps the picture; a change continues rendering.
        begin_long()
        page.wait("document.getElementById('work').textContent.startsWith('drawing')")
        self.shoot("view_work")
        page.key("Escape") if page.value("viewer.image.focus() || true") else None
        page.value("viewer.controls.set('samples', '2')")
        page.wait("document.getElementById('work').textContent === ''")
        time.sleep(0.5)
        self.assertEqual(page.value("viewer.level"), 4)
        page.value("viewer.changed()")
        page.wait(FINE)
        self.check_quiet()

    def test_it_waits_for_a_server_that_is_away_and_goes_on(self):
        self.open(900, 700)
        page = self.page
        shown = self.picture()
        # The open connection delivers nothing.
        self.server.process.send_signal(signal.SIGSTOP)
        page.wait(MESSAGE + ".includes('does not answer')")
        self.assertEqual(self.picture(), shown)
        page.value("viewer.image.focus()")
        page.key("ArrowLeft")
        self.server.process.send_signal(signal.SIGCONT)
        page.wait(f"document.getElementById('message').hidden && {FINE}")
        self.assertNotEqual(self.picture(), shown)
        # The connection breaks.
        page.value("viewer.link.socket.close()")
        page.wait(MESSAGE + ".includes('does not answer')")
        self.changes(lambda: (page.key("ArrowLeft"), page.wait("document.getElementById('message').hidden")))
        # A new server at the same address has another key.
        self.server.process.kill()
        self.server.process.wait()
        again = Server(ALHAZEN, self.scene, "--port", str(self.server.port))
        self.addCleanup(again.close)
        page.wait(MESSAGE + ".startsWith('The server was replaced') && " + MESSAGE + ".includes('no key')")

    def test_the_policy_allows_this_server_alone(self):
        self.open(900, 700)
        other = Server(ALHAZEN, self.scene)
        self.addCleanup(other.close)
        blocked = self.page.value("""(async () => {
            const seen = [];
            addEventListener("securitypolicyviolation", e => seen.push(e.effectiveDirective + " " + e.blockedURI));
            for (const address of ["ws://%s/frames", "ws://%s/other"]) try { new WebSocket(address); } catch { }
            await fetch("http://%s/").catch(() => {});
            await new Promise(go => setTimeout(go, 300));
            return seen;
        })()""" % (other.host, self.server.host, other.host))
        self.assertEqual(len(blocked), 3, blocked)
        self.assertEqual({b.split()[0] for b in blocked}, {"connect-src"})

    def test_reading_and_building_are_ended_from_the_page(self):
        many = "".join(f'sphere {{ center = ({i % 700}, -500, {i // 700}); radius = 0.4; material = "red" }}\n'
                       for i in range(400000))
        self.server.close()
        self.scene.write_text(SCENE + many, encoding="utf-8")
        self.server = Server(ALHAZEN, self.scene)
        self.page = page = self.browser.open(900, 700)
        stop = "[...document.querySelectorAll('button')].find(b => b.textContent === 'Stop').click()"
        page.call("Page.navigate", url=self.server.url)
        page.wait("globalThis.viewer && document.getElementById('work')?.textContent.startsWith('reading scene.alhazen')")
        self.shoot("view_reading")
        page.value(stop)
        page.wait(MESSAGE + ".includes('was ended')")
        self.shoot("view_reading_ended")
        page.value("[...document.querySelectorAll('button')].find(b => b.textContent === 'Read again').click()")
        page.wait(f"document.getElementById('message').hidden && {FINE}", 60)
        self.choose("accelerator", "kd_tree")
        page.wait("document.getElementById('work').textContent.startsWith('building kd_tree')")
        self.shoot("view_building")
        page.value(stop)
        page.wait("document.getElementById('work').textContent === ''", 2)
        self.assertEqual(page.value("viewer.controls.get('accelerator')"), "wide_bvh")
        self.changes(lambda: page.value("viewer.image.focus()") or page.key("ArrowLeft"))
        self.check_quiet()

    def test_rays_that_are_not_those_of_the_picture_are_said_to_be(self):
        self.open(900, 700)
        page = self.page
        for renderer, said in (("whitted", None), ("path_tracing", "draws rays at random"), ("distributed", "at random"),
                               ("ray_casting", "by ray_casting; the tree of rays is that of whitted")):
            self.choose("renderer", renderer)
            page.wait(FINE)
            page.value("document.getElementById('explanation').replaceChildren()")
            page.value("viewer.explain(0.5, 0.5)")
            page.wait("document.querySelectorAll('#explanation .ray').length > 0")
            text = page.value("document.getElementById('other')?.textContent ?? null")
            self.assertEqual(text is None, said is None)
            if said:
                self.assertIn(said, text)
            self.assertEqual(page.value("document.querySelectorAll('#path .vertex').length > 0"), renderer == "path_tracing")
            if renderer == "path_tracing":
                ink = "document.querySelector('canvas.space').toDataURL()"
                drawn = page.value(ink)
                page.value("document.querySelector('#path input').click()")
                self.assertNotEqual(page.value(ink), drawn)
                page.value("document.querySelector('#path input').click()")
                self.assertEqual(page.value(ink), drawn)
                self.assertEqual(page.value("document.getElementById('path-title').textContent"),
                                 "One path of a picture with 4 samples")
                self.shoot("view_path_space")
                page.value("document.getElementById('path').scrollIntoView()")
                self.shoot("view_path")
        self.check_quiet()

    def test_samples_of_the_pixel_are_shown_and_explained_one_by_one(self):
        self.open(1300, 1000)
        page = self.page
        radiance = "[...document.querySelectorAll('.samples tbody tr')].map(r => [1, 2, 3].map(i => Number(r.cells[i].textContent)))"
        # A pixel where the ball hides the floor.
        page.value("viewer.explainPixel(56, 46)")
        page.wait("document.querySelectorAll('.samples tbody tr').length === 4")
        page.value("document.getElementById('samples').scrollIntoView()")
        self.shoot("view_samples")
        samples = page.value(radiance)
        self.assertGreater(len(set(map(tuple, samples))), 1)
        shown = "document.querySelector('.samples .selected').rowIndex - 1"
        told = "document.querySelector('#tree .ray p').textContent"
        self.assertEqual(page.value(shown), 0)
        for i in (2, 3):
            page.value(f"document.querySelector('[aria-label=\"Explain sample {i}\"]').click()")
            page.wait(f"{shown} === {i}")
            self.assertEqual(page.value(radiance), samples)
            self.assertIn("radiance (" + ", ".join(f"{c:.4g}" for c in samples[i]) + ")", page.value(told))
        # The chosen number of them.
        self.choose("samples", "9")
        page.value("viewer.explainPixel(56, 46)")
        page.wait("document.querySelectorAll('.samples tbody tr').length === 9")
        self.check_quiet()

    def test_the_picture_is_saved(self):
        self.open(900, 700)
        self.page.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(self.folder))
        self.page.value("[...document.querySelectorAll('button')].find(b => b.textContent === 'Save picture').click()")
        saved = self.folder / "view.png"
        for _ in range(int(400 * SLOWDOWN)):
            if saved.exists():
                break
            time.sleep(0.05)
        data = saved.read_bytes()
        self.assertEqual((data[:8], struct.unpack(">2I", data[16:24])), (b"\x89PNG\r\n\x1a\n", (160, 120)))

    def test_methods_are_explained_by_their_cones_and_beams(self):
        self.scene.write_text("\n".join(line for line in SCENE.split("\n") if not line.startswith(("sphere", "plane"))) +
                              'rectangle { corner = (-4, 0, -4); edge_u = (0, 0, 8); edge_v = (8, 0, 0); material = "mirror" }\n',
                              encoding="utf-8")
        self.open(1300, 1000)
        page = self.page
        for renderer, place in (("cone_tracing", "#cones .cone"), ("beam_tracing", "#beams tbody tr")):
            self.choose("renderer", renderer)
            page.wait(FINE)
            page.value("viewer.explain(0.26, 0.8)")
            page.wait(f"document.querySelectorAll('{place}').length > 0")
            page.value("document.querySelector('#cones, #beams').scrollIntoView()")
            if renderer == "cone_tracing":
                names = page.value("[...document.querySelectorAll('#cones summary')].map(s => s.textContent)")
                shadows = [name for name in names if "cone to" in name]
                self.assertIn("cone to \u2018key\u2019 from \u2018", shadows[0])
                self.assertEqual(len(set(shadows)), len(shadows))
            self.shoot(f"view_{renderer}")
        # The message about a refused scene stays.
        self.check_quiet()

    def test_it_fits_a_phone_and_is_named_for_readers(self):
        self.open(480, 1000)
        self.shoot("view_phone")
        self.page.value("document.getElementById('lights').open = true")
        self.shoot("view_phone_lights")
        self.assertLessEqual(self.page.value("document.documentElement.scrollWidth - innerWidth"), 0)
        self.assertEqual(self.page.value("""[...document.querySelectorAll("img,canvas,progress,input,select,textarea,button")].filter(e =>
            !e.alt && !e.getAttribute("aria-label") && !e.textContent.trim() && !e.closest("label")).length"""), 0)
        self.page.value("viewer.image.focus()")
        self.page.key("Enter")
        self.page.wait("document.querySelectorAll('#explanation .ray').length > 0")
        # The table of the first surface is as wide as the page.
        self.assertLessEqual(self.page.value("(t => t.scrollWidth - t.clientWidth)(document.querySelector('.equation').parentElement)"), 0)
        self.page.value("document.getElementById('tree').scrollIntoView()")
        self.shoot("view_phone_tree")
        self.check_quiet()

    def test_without_its_key_the_page_shows_nothing(self):
        self.page = self.browser.open(800, 600)
        self.page.call("Page.navigate", url=f"http://{self.server.host}/")
        self.page.wait(MESSAGE + ".includes('no key')")
        self.assertFalse(self.page.value("viewer.frames > 0"))
        self.shoot("view_without_key")


if __name__ == "__main__":
    run_tests()
