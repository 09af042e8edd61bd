#!/usr/bin/env python3
"""The choices and actions of the page of `alhazen view` in a browser: refused numbers, accelerators with settings, keys,
saving, many pages, an address of IPv6.

Usage: view_choices_test.py ALHAZEN [SCREENSHOT_FOLDER]

Skipped, with a message, without a browser: `scripts/setup --browser` installs one.
"""

import socket
import threading
import time

from view_server import SCENE, SLOWDOWN, png_pixels
from viewer_page import ALHAZEN, FINE, MESSAGE, READY, ViewerPage, run_tests

LONG = "400"  # samples that take seconds


class ViewChoices(ViewerPage):
    def type(self, key, text):
        self.page.value(f"(f => (f.focus(), f.select()))(document.querySelector('input[name={key}]'))")
        for c in text:
            self.page.call("Input.dispatchKeyEvent", type="keyDown", key=c, text=c)
            self.page.call("Input.dispatchKeyEvent", type="keyUp", key=c)
        self.page.key("Enter")

    def begin_long(self):
        self.choose("samples", LONG)
        self.page.wait("viewer.level === 4")

    def key(self, key, modifiers=0):
        self.page.key(key, modifiers)

    def wait_for_work(self, client, there):
        self.server.wait_for(lambda state: any(w.get("client") == client for w in state["work"]) == there)

    def test_numbers_that_cannot_be_used_are_refused_with_a_message(self):
        self.open(900, 700)
        page, first = self.page, self.shown()
        for key, bad, good, usual in (("depth", ("-1", "1.5", "101"), "3", 4), ("samples", ("0", "-3", "2.5", "2000"), "2", 4),
                                      ("exposure", ("65", "-1e9"), "1", 0)):
            field = f"document.querySelector('input[name={key}]')"
            for text in bad:
                self.type(key, text)
                page.wait(f"{MESSAGE}.startsWith('{key} must be a ')")
                self.assertEqual(page.value(f"{field}.getAttribute('aria-invalid')"), "true")
                self.assertEqual(page.value(f"viewer.controls.number('{key}')"), usual)
                # The view goes on with the number before.
                self.changes(lambda: page.value("viewer.image.focus()") or self.key("ArrowLeft"))
                page.value("viewer.explain(0.5, 0.5)")
                page.wait("viewer.explaining === undefined && document.querySelectorAll('#explanation .ray').length > 0")
                self.click("Home")
                page.wait(FINE)
                self.assertTrue(self.shown() == first)
            self.type(key, good)
            page.wait(f"{MESSAGE} === '' && {FINE}")
            self.assertEqual(page.value(f"viewer.controls.number('{key}')"), float(good))
            self.assertFalse(page.value(f"{field}.hasAttribute('aria-invalid')"))
            self.type(key, bad[0])
            page.wait(f"{MESSAGE} !== ''")
            self.click("Undo")
            page.wait(f"{MESSAGE} === '' && {FINE}")
            self.choose(key, "")
            page.wait(FINE)
        self.check_quiet()

    def test_a_depth_below_the_moving_one_comes_back(self):
        self.open(900, 700)
        for depth in ("0", "4"):
            self.choose("depth", depth)
            self.page.wait(FINE)
        self.assertEqual(self.page.value("viewer.pace.next({full: 160, depth: -1, deepens: true}).depth"), 0)

    def test_an_accelerator_with_a_setting_stays_in_use(self):
        chosen = "bounding_volumes:bound=sphere"
        self.serve(self.scene, "--bound", "sphere")
        for _ in range(2):
            self.assertEqual(self.page.value("viewer.controls.get('accelerator')"), chosen)
            self.assertEqual(self.server.state()["accelerator"], chosen)
            self.edit(SCENE + "// changed\n")
            self.page.wait(FINE)
        # It comes back from another one.
        for choice in ("octree", chosen):
            self.choose("accelerator", choice)
            self.page.wait(FINE)
            self.assertEqual(self.server.state()["accelerator"], choice)
        self.check_quiet()

    def test_keys_act_wherever_the_focus_is(self):
        self.open(900, 700)
        page, client = self.page, self.page.value("viewer.client")
        for focus in ("button", "select[name=renderer]", "input[name=depth]", "canvas"):
            page.value("viewer.controls.set('samples', '4')")
            self.begin_long()
            self.wait_for_work(client, True)
            page.value(f"document.querySelector('{focus}').focus()")
            self.key("Escape")
            self.wait_for_work(client, False)
            page.value("viewer.controls.set('samples', '4'); viewer.changed()")
            page.wait(FINE)
            for letter in ("z", "Z"):
                self.choose("renderer", "ray_casting")
                page.wait(FINE)
                page.value(f"document.querySelector('{focus}').focus()")
                self.key(letter, 2)
                self.assertEqual(page.value("viewer.controls.get('renderer')"), "whitted", (focus, letter))
        # A text that is being changed keeps both keys.
        page.value("(f => (f.focus(), f.select()))(document.querySelector('input[name=depth]'))")
        page.call("Input.dispatchKeyEvent", type="keyDown", key="7", text="7")
        count = page.value("viewer.undone.length")
        self.key("z", 2)
        self.assertEqual(page.value("viewer.undone.length"), count)
        self.check_quiet()

    def test_an_explanation_is_ended_from_its_own_button(self):
        self.open(900, 700)
        page, client = self.page, self.page.value("viewer.client")
        page.value("viewer.controls.set('samples', '1024'); viewer.controls.set('depth', '100')")
        # The server is kept at work by the page's own wish for many steps.
        page.value("""globalThis.fetch = (own => (path, wish) => path === "/explain"
            ? own("/frame", {...wish, body: JSON.stringify({...JSON.parse(wish.body), samples: 1024, width: 2000, height: 1500, png: true})})
            : own(path, wish))(fetch)""")
        page.value("document.querySelector('.pixel-choice button').focus()")
        page.key("Enter")
        page.wait("document.getElementById('status').textContent.startsWith('Explaining')")
        self.wait_for_work(client, True)
        page.key("Escape")
        self.wait_for_work(client, False)
        self.assertFalse(page.value("document.getElementById('status').textContent.startsWith('Explaining')"))

    def test_the_view_moves_on_while_a_picture_is_saved(self):
        self.open(900, 700)
        page = self.page
        page.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(self.folder))
        page.value("viewer.controls.set('samples', '1000')")
        self.click("Save picture")
        self.wait_for_work(page.value("viewer.client"), True)
        page.value("viewer.controls.set('samples', '4')")
        self.changes(lambda: page.value("viewer.image.focus()") or page.key("ArrowLeft"))
        page.wait(MESSAGE + ".includes('not saved')")
        self.assertFalse(list(self.folder.glob("*.png")))
        # The next one is the picture that is shown.
        page.key("ArrowLeft")
        page.wait(f"{FINE} && {MESSAGE} === ''")
        self.click("Save picture")
        saved, begin = self.folder / "view.png", time.monotonic()
        while not saved.exists():
            self.assertLess(time.monotonic() - begin, 20 * SLOWDOWN)
            time.sleep(0.05)
        self.assertTrue(png_pixels(saved.read_bytes()) == self.shown())
        self.check_quiet()

    def test_eight_pages_are_stopped_and_told_that_the_server_is_full(self):
        self.open(900, 700)
        page = self.page

        def leave(frames):
            frames.socket.shutdown(socket.SHUT_RDWR)
            frames.thread.join(10 * SLOWDOWN)
            frames.close()

        others, begin = [], time.monotonic()
        while len(others) < 7:  # what the page was loaded by stays connected for a while
            frames = self.server.frames()
            if frames.status == 101:
                frames.send({"token": self.server.token})
                others.append(frames)
                # Answers its pings.
                frames.thread = threading.Thread(target=frames.listen, args=(90 * SLOWDOWN,), daemon=True)
                frames.thread.start()
                continue
            frames.close()
            self.assertLess(time.monotonic() - begin, 10 * SLOWDOWN)
            time.sleep(0.1)
        try:
            self.assertEqual(self.server.ask("/state", {})[0], 503)
            self.begin_long()
            work = ("viewer.seen = viewer.link.events.state, viewer.link.events.state = s => "
                    "(viewer.working = s.work.some(w => w.client === viewer.client), viewer.seen(s))")
            page.value(f"({work}, 0)")
            page.wait("viewer.working === true")
            self.click("Stop")
            page.wait("viewer.working === false")
            self.assertEqual(page.value("document.getElementById('spoken').textContent"), "Stopped")
            page.value("viewer.controls.set('samples', '4'); viewer.changed()")
            page.wait(FINE)
            for start in (lambda: page.value("viewer.explain(0.5, 0.5)"), lambda: self.click("Save picture")):
                start()
                page.wait(MESSAGE + ".includes('has 8 clients at most')", 30)
                self.changes(lambda: page.value("viewer.image.focus()") or page.key("ArrowLeft"))
                self.assertEqual(page.value(MESSAGE), "")
            # A ninth page says so, too, and begins when there is a place.
            ninth = self.browser.open(700, 600)
            self.addCleanup(ninth.close)
            ninth.call("Page.navigate", url=self.server.url)
            ninth.wait(MESSAGE + ".includes('has 8 clients at most')")
            leave(others.pop())
            ninth.wait(f"{FINE} && {MESSAGE} === ''")
            # With a place free again the page gets it.
            page.value("viewer.explain(0.5, 0.5)")
            time.sleep(1)
            leave(others.pop())
            page.wait("document.querySelectorAll('#explanation .ray').length > 0")
            self.assertEqual([c for c in page.console if "503" not in c], [])
        finally:
            for frames in others:
                leave(frames)

    def test_a_stop_keeps_the_accelerator_of_the_page(self):
        self.open(900, 700)
        self.choose("accelerator", "octree")
        self.page.wait(FINE)
        # Another page chooses another one.
        wish = self.server.wish_at(0, accelerator="kd_tree", client="other")
        self.assertEqual(self.server.ask("/frame", wish)[0], 200)
        self.page.wait("viewer.scene.accelerator === 'kd_tree'")
        self.click("Stop")
        self.assertEqual(self.page.value("viewer.controls.get('accelerator')"), "octree")

    def test_a_page_at_an_address_of_ipv6_has_its_pictures(self):
        try:
            with socket.socket(socket.AF_INET6) as s:
                s.bind(("::1", 0))
        except OSError:
            self.open(900, 700)
            return
        self.serve(self.scene, "--serve", "::1")
        self.assertTrue(self.server.url.startswith("http://[::1]:"))
        self.assertTrue(self.page.value(READY))
        self.check_quiet()


if __name__ == "__main__":
    run_tests()
