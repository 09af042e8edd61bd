#!/usr/bin/env python3
"""`alhazen view` and the files of its scene: read while the page is served, reread when they change, stopped on request.

Usage: view_files_test.py ALHAZEN
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from view_server import SCENE, SLOWDOWN, WISH, Server

ALHAZEN = sys.argv[1]


def many_spheres(count):
    return "".join(f"sphere {{ center = ({i % 700}, -500, {i // 700}); radius = 0.4; material = \"red\" }}\n"
                   for i in range(count))


class ViewFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.scene = pathlib.Path(cls.temporary.name) / "scene.alhazen"
        cls.large = cls.scene.with_name("large.alhazen")
        # A scene that takes seconds to read and build.
        cls.large.write_text(SCENE + many_spheres(400000), encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def view(self, scene, *options):
        server = Server(ALHAZEN, scene, *options)
        self.addCleanup(server.close)
        return server

    def seconds_until(self, holds, most=30):
        begin = time.monotonic()
        while not holds():
            self.assertLess(time.monotonic() - begin, most)
            time.sleep(0.01)
        return time.monotonic() - begin

    # ---- a long first reading
    def test_the_server_is_there_while_a_scene_is_read_and_says_so(self):
        server = self.view(self.large)
        moment = server.moment()
        self.assertEqual((moment["version"], [w["what"] for w in moment["work"]]), (0, ["reading large.alhazen"]))
        self.assertNotIn("cameras", moment)
        # A frame waits for the scene.
        self.assertEqual(server.ask("/frame", WISH)[0], 200)
        self.assertEqual(server.moment()["version"], 1)

    def test_reading_ends_within_a_moment_of_a_stop_and_begins_again_on_request(self):
        taken = []
        server = self.view(self.large)
        for pause in (0.0, 0.2, 0.5):
            time.sleep(pause)
            self.assertEqual(server.ask("/stop", {})[0], 200)
            taken.append(self.seconds_until(lambda: not server.moment()["work"]))
            moment = server.moment()
            self.assertEqual((moment["version"], moment["stopped"], moment["error"]), (0, True, ""))
            self.assertEqual(server.ask("/read", {})[0], 200)
            self.seconds_until(lambda: server.moment()["work"])
        self.assertLess(min(taken), 0.2 * SLOWDOWN, taken)
        server.wait_for(lambda state: state["version"] == 1 and not state["stopped"])

    def test_a_first_reading_that_fails_is_the_end(self):
        late = self.scene.with_name("late.alhazen")
        for text, waits in ((SCENE.replace("radius = 1;", "radius = = 1;"), False),
                            (SCENE + many_spheres(400000) + "sphere { radius = = 1 }\n", True)):
            late.write_text(text, encoding="utf-8")
            begin = time.monotonic()
            result = subprocess.run([ALHAZEN, "view", str(late), "--no-open"], capture_output=True, text=True, timeout=120)
            self.assertEqual(result.returncode, 3)
            self.assertIn("late.alhazen:", result.stderr)
            self.assertEqual(result.stdout.startswith("http"), waits, time.monotonic() - begin)

    def test_the_page_learns_why_there_is_no_scene(self):
        late = self.scene.with_name("late_too.alhazen")
        late.write_text(SCENE + many_spheres(400000) + "sphere { radius = = 1 }\n", encoding="utf-8")
        server = self.view(late)
        frames = server.open_frames()
        self.addCleanup(frames.close)
        while not (state := frames.state())["error"]:
            pass
        self.assertIn("late_too.alhazen:", state["error"])
        self.assertEqual(server.process.wait(10), 3)

    def test_an_interrupt_ends_reading_at_once(self):
        server = self.view(self.large)
        begin = time.monotonic()
        server.process.terminate()
        server.process.wait(10)
        self.assertLess(time.monotonic() - begin, 1 * SLOWDOWN)

    # ---- accelerators
    def test_building_an_accelerator_ends_with_a_newer_wish_a_stop_and_its_client(self):
        server = self.view(self.large)
        state = server.state()
        slow = {**WISH, "accelerator": "kd_tree", "client": "a"}
        taken = []
        for path, body in (("/frame", {**WISH, "client": "a"}), ("/stop", {"client": "a"})):
            status = server.in_hand("/frame", slow)
            self.assertIn("building kd_tree", [w["what"] for w in server.moment()["work"]])
            begin = time.monotonic()
            self.assertEqual(server.ask(path, body)[0], 200)
            self.assertEqual(status(), 204)
            taken.append(time.monotonic() - begin)
        frames = server.open_frames()
        frames.send({**slow, "id": 1})
        self.seconds_until(lambda: "building kd_tree" in [w["what"] for w in server.moment()["work"]])
        frames.close()
        taken.append(self.seconds_until(lambda: not server.moment()["work"]))
        self.assertLess(min(taken), 0.3 * SLOWDOWN, taken)
        after = server.state()
        self.assertEqual((after["accelerator"], after["version"]), (state["accelerator"], state["version"]))

    # ---- changes
    def test_a_changed_file_is_read_again_and_a_bad_one_keeps_the_last(self):
        scene = self.scene.with_name("changing.alhazen")
        scene.write_text(SCENE, encoding="utf-8")
        server = self.view(scene)
        version = server.state()["version"]
        frame = server.ask("/frame", {**WISH, "png": True})[2]
        scene.write_text(SCENE.replace("radius = 1;", "radius = = 1;"), encoding="utf-8")
        state = server.wait_for(lambda s: "changing.alhazen:9:" in s["error"])
        self.assertEqual(state["version"], version)
        self.assertEqual(server.ask("/frame", {**WISH, "png": True})[2], frame)
        scene.write_text(SCENE.replace("radius = 1;", "radius = 0.5;").replace('"side"', '"left"'), encoding="utf-8")
        state = server.wait_for(lambda s: s["version"] > version)
        self.assertEqual((state["version"], state["error"]), (version + 1, ""))
        self.assertEqual([c["name"] for c in state["cameras"]], ["front", "left"])
        self.assertNotEqual(server.ask("/frame", {**WISH, "png": True})[2], frame)

    def test_a_change_that_time_and_size_do_not_show_is_seen(self):
        scene = self.scene.with_name("racy.alhazen")
        scene.write_text(SCENE, encoding="utf-8")
        server = self.view(scene)
        version = server.state()["version"]
        scene.write_text(SCENE.replace("radius = 1;", "radius = 3;"), encoding="utf-8")
        server.wait_for(lambda s: s["version"] > version)
        stat = scene.stat()
        scene.write_text(SCENE.replace("radius = 1;", "radius = 2;"), encoding="utf-8")
        os.utime(scene, ns=(stat.st_atime_ns, stat.st_mtime_ns))
        server.wait_for(lambda s: s["version"] > version + 1, 5)

    def test_an_edit_while_the_file_is_loaded_is_not_lost(self):
        scene = self.scene.with_name("slow.alhazen")
        many = many_spheres(60000)
        scene.write_text(SCENE + many, encoding="utf-8")
        server = self.view(scene)
        for pause in (0.15, 0.4):
            version = server.state()["version"]
            scene.write_text(SCENE.replace("radius = 1;", "radius = 0.7;") + many, encoding="utf-8")
            time.sleep(pause)
            scene.write_text(SCENE.replace("radius = 1;", "radius = 0.5;"), encoding="utf-8")
            wanted = self.server_of(SCENE.replace("radius = 1;", "radius = 0.5;"))
            server.wait_for(lambda s: s["version"] > version)
            begin = time.monotonic()
            while server.ask("/frame", {**WISH, "png": True})[2] != wanted:
                self.assertLess(time.monotonic() - begin, 15, "the edit was lost")
                time.sleep(0.1)

    def server_of(self, text):
        """The picture of a scene."""
        scene = self.scene.with_name("other.alhazen")
        scene.write_text(text, encoding="utf-8")
        server = self.view(scene)
        return server.ask("/frame", {**WISH, "png": True})[2]

    def test_a_missing_included_file_is_waited_for(self):
        scene = self.scene.with_name("including.alhazen")
        part = self.scene.with_name("included.alhazen")
        scene.write_text(SCENE, encoding="utf-8")
        server = self.view(scene)
        version = server.state()["version"]
        scene.write_text(SCENE + "include \"included.alhazen\"\n", encoding="utf-8")
        state = server.wait_for(lambda s: s["error"])
        self.assertIn("include", state["error"])
        part.write_text("alhazen 1\nsphere { center = (1.5, 1, 0); radius = 0.5; material = \"red\" }\n", encoding="utf-8")
        state = server.wait_for(lambda s: s["version"] > version)
        self.assertEqual(state["error"], "")
        frame = server.ask("/frame", {**WISH, "png": True})[2]
        part.write_text("alhazen 1\nsphere { center = (1.5, 1, 0); radius = 0.9; material = \"red\" }\n", encoding="utf-8")
        server.wait_for(lambda s: s["version"] > state["version"])
        self.assertNotEqual(server.ask("/frame", {**WISH, "png": True})[2], frame)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
