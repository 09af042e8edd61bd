#!/usr/bin/env python3
"""Renders from the command line: identical bits for all settings, layers, views, interruption.

Usage: pictures_test.py ALHAZEN SOURCE_FOLDER
"""

import json
import os
import signal
import struct
import subprocess
import sys
import time
import unittest

from command_line import ALHAZEN, CommandLineCase, processor_seconds, run, SOURCE

# Limit in seconds for a short command; sanitizers make programs slower (tests/cli/CMakeLists.txt).
PATIENCE = 60 * int(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))


class Pictures(CommandLineCase):
    def test_the_same_bits_for_any_threads_tiles_and_accelerator(self):
        self.render("-t", "1", "--tile-size", "64", "--spp", "4", output="a.png")
        self.render("-t", "7", "--tile-size", "5", "--spp", "4", output="b.png")
        self.render("-t", "2", "--accelerator", "list", "--spp", "4", output="c.png")
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        self.assertEqual(self.read("a.png"), self.read("c.png"))

    def test_rounds_are_the_same_bits_for_any_threads_and_tiles(self):
        settings = ("--noise", "0.05", "--spp", "64", "--filter", "mitchell", "--seed", "3")
        self.render("-t", "1", "--tile-size", "64", *settings, output="a.png")
        self.render("-t", "7", "--tile-size", "5", *settings, "--stats", self.path("s.json"), output="b.png")
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        sampling = json.loads(self.read("s.json"))["sampling"]
        self.assertEqual(sampling["sampler"], "sobol")
        self.assertGreater(len(sampling["rounds"]), 1)
        self.assertLessEqual(sampling["most_samples"], 64)

    def test_a_crop_is_that_part_of_the_picture(self):
        self.render("--full-float", output="whole.exr")
        self.render("--full-float", "--crop", "10,20,40,30", output="part.exr")
        self.render("--crop", "10,20,40,30", output="part.pfm")
        self.assertEqual(run("diff", self.path("part.exr"), self.path("part.pfm")).returncode, 0)
        self.assertEqual(run("diff", self.path("part.pfm"), self.path("part.exr")).returncode, 0)
        # The rest of the full frame is black.
        result = run("diff", self.path("part.exr"), self.path("whole.exr"), "--json")
        self.assertEqual(result.returncode, 1, result.stderr)
        report = json.loads(result.stdout)
        self.assertGreaterEqual(report["identical"], 30 * 10)
        self.assertLess(report["identical"], report["pixels"])

    def test_every_picture_format_is_written_and_read_back(self):
        self.render(output="reference.pfm")
        for name, bound in (("a.exr", 2e-3), ("b.hdr", 1e-2), ("c.pfm", 0)):
            self.assertEqual(self.render(output=name).returncode, 0)
            result = run("diff", self.path("reference.pfm"), self.path(name), "--max", str(bound))
            self.assertEqual(result.returncode, 0, name + result.stdout)
        self.render(output="reference.png")
        for name, options, bound in (("d.png", ["--bits", "16"], 1 / 250), ("e.jpg", [], 0.2), ("f.png", [], 0)):
            self.assertEqual(self.render(*options, output=name).returncode, 0)
            result = run("diff", self.path("reference.png"), self.path(name), "--max", str(bound))
            self.assertEqual(result.returncode, 0, name + result.stdout)

    def test_numbers_beyond_half_are_the_largest_half_with_a_warning(self):
        scene = self.write("bright.alhazen", "alhazen 1\npicture { background = (70000, 1, -1e6) }\n"
                           "perspective_camera { eye = (0, 0, 5); look_at = (0, 0, 0) }\n"
                           "ambient_light { color = 1 }\nsphere { center = (0, 0, 99) }\n")
        half, whole = self.path("half.exr"), self.path("whole.exr")
        result = run("render", scene, "-o", half, "--size", "2x2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("warning: 4 pixels are beyond the largest number of a half, 65504", result.stderr)
        self.assertIn("--full-float keeps them", result.stderr)
        self.assertEqual(run("render", scene, "-o", half, "--size", "2x2", "-q").stderr, "")
        result = run("render", scene, "-o", whole, "--size", "2x2", "--full-float")
        self.assertNotIn("warning", result.stderr)
        report = json.loads(run("diff", half, whole, "--json").stdout)
        self.assertEqual(report["max"], 1e6 - 65504)

    def test_diff_tells_of_a_file_whose_pixels_lie_outside_of_the_picture(self):
        self.render("--crop", "0,0,4,4", output="part.exr", size="8x8")
        part = bytearray(self.read("part.exr"))
        name = b"displayWindow\0box2i\0"
        at = part.index(name) + len(name) + 4
        part[at:at + 16] = struct.pack("<4i", 100, 100, 107, 107)
        with open(self.path("none.exr"), "wb") as file:
            file.write(part)
        result = run("diff", self.path("none.exr"), self.path("none.exr"), "--json")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(json.loads(result.stdout)["pixels"], 64)
        self.assertEqual(result.stderr.count("warning: "), 2)
        self.assertIn("none.exr: the data window of the file lies outside", result.stderr)
        self.assertEqual(run("diff", self.path("part.exr"), self.path("part.exr")).stderr, "")

    def test_layers_go_into_the_exr_and_do_not_change_the_picture(self):
        result = self.render("--aov", "all", output="layers.exr")
        self.assertEqual(result.returncode, 0, result.stderr)
        header = self.read("layers.exr")[:8192]
        for channel in ("R", "A", "depth.Z", "N.X", "Ng.Y", "P.Z", "uv.U", "albedo.G", "id.object", "id.material",
                        "id.instance", "error_bound", "count.rays", "count.node_visits", "count.box_tests",
                        "count.primitive_tests", "time.seconds"):
            self.assertIn(b"\0" + channel.encode() + b"\0", header, channel)
        self.assertIn(b'"1":"mirror"', header)
        self.assertEqual(os.listdir(self.folder.name).count("layers.depth.png"), 0)
        self.render("--aov", "depth,N,id,count", output="few.exr")
        self.render(output="plain.exr")
        self.assertEqual(run("diff", self.path("plain.exr"), self.path("few.exr")).returncode, 0)

    def test_layers_have_the_same_bits_for_any_threads_and_tiles(self):
        wanted = ["--aov", "alpha,depth,N,Ng,P,uv,albedo,id,count", "--spp", "4", "--crop", "5,6,50,40"]
        self.render("-t", "1", "--tile-size", "64", *wanted, output="a.exr")
        self.render("-t", "7", "--tile-size", "5", *wanted, output="b.exr")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))

    def test_layers_of_other_pictures_are_pictures_beside_them(self):
        result = self.render("--aov", "depth,id.object,count.rays")
        self.assertEqual(result.returncode, 0, result.stderr)
        names = ["out.count.rays.png", "out.depth.png", "out.id.object.png", "out.png"]
        self.assertEqual(sorted(n for n in os.listdir(self.folder.name) if n.startswith("out")), names)
        for name in names:
            self.assertTrue(self.read(name).startswith(b"\x89PNG"), name)
        self.assertIn(b"alhazen.aov.high", self.read("out.depth.png"))
        self.assertIn("out.depth.png: depth, ", result.stderr)
        self.assertEqual(self.render("--aov", "depth", "--aov-png", output="both.exr").returncode, 0)
        self.assertTrue(os.path.exists(self.path("both.depth.png")))
        os.mkdir(self.path("folder.depth.png"))
        self.assertEqual(self.render("--aov", "depth", output="folder.png").returncode, 4)
        self.assertFalse(os.path.exists(self.path("folder.png")))

    def test_a_scene_without_camera_and_lights_is_framed_and_lit_and_told(self):
        bare = self.write("bare.alhazen", "alhazen 1\nsphere { center = (5, 0, 0) }\n")
        result = run("render", bare, "-o", self.path("bare.png"), "--size", "40x30", "--strict")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no camera in the file: framed from azimuth 30, elevation 20\n", result.stderr)
        self.assertIn("no lights in the file: a headlight was added\n", result.stderr)
        quiet = run("render", bare, "-o", self.path("quiet.png"), "--size", "40x30", "-q")
        self.assertEqual(quiet.stderr, "")
        self.assertEqual(self.read("bare.png"), self.read("quiet.png"))
        self.assertNotIn("framed", run("render", self.scene, "-o", self.path("a.png"), "--size", "8x8").stderr)

    def test_a_view_replaces_the_camera_of_the_file(self):
        self.render(output="front.png")
        for view in ("0,90", "-120.5,10"):
            result = self.render("--view", view, output="view.png")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertNotEqual(self.read("front.png"), self.read("view.png"))

    def test_scenes_with_nothing_to_frame_exit_3(self):
        for text in ("", "plane { }\n"):
            scene = self.write("nothing.alhazen", "alhazen 1\n" + text)
            result = run("render", scene, "-o", self.path("nothing.png"))
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn("camera", result.stderr)

    def test_a_file_that_means_darkness_stays_dark(self):
        dark = self.write("dark.nff", "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n"
                                      "f 1 1 1 1 0 0 0 1\ns 0 0 0 1\n")
        result = run("render", dark, "-o", self.path("dark.png"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("headlight", result.stderr)

    def at_work(self, *arguments, command="render"):
        """A program that renders or draws, which has begun: it has taken as much processor time as starting takes, many times over."""
        process = subprocess.Popen([ALHAZEN, command, *arguments], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        begin = time.monotonic()
        while processor_seconds(process.pid) < PATIENCE / 120:
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic() - begin, PATIENCE)
            time.sleep(0.01)
        return process

    def test_interrupted_rendering_writes_what_is_done_and_exits_75(self):
        process = self.at_work(self.scene, "-o", self.path("out.png"), "--size", "2000x2000", "--spp", "400", "--tile-size", "4")
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)  # a second signal, as timeout(1) may send
        _, messages = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 75)
        self.assertRegex(messages, "stopped: .* the others are missing from the picture in .*out.png")
        self.assertTrue(self.read("out.png").startswith(b"\x89PNG"))

    def test_an_interrupt_in_a_round_keeps_the_rounds_before(self):
        # One tile: no tile of the last round is done.
        process = self.at_work(self.scene, "-o", self.path("out.pfm"), "--size", "32x32", "-t", "1", "--renderer", "path_tracing",
                               "--time-limit", f"{10 * PATIENCE:.0f}")
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 75)
        self.assertIn("stopped in round", messages)
        self.assertTrue(self.read("out.pfm").startswith(b"PF"))

    def test_rendering_stops_within_one_pixel(self):
        # Each surface splits a ray in two: an eye ray spawns up to 2^200 others.
        glass = "material = { diffuse = 0; reflective = 1; transmissive = 1; index = 1.5 }"
        scene = self.write("slow.alhazen", "alhazen 1\nconventions { max_depth = 200 }\n"
                           "perspective_camera { eye = (0, 0, 3); look_at = (0, 0, 0) }\n"
                           f"sphere {{ radius = 1; {glass} }}\nsphere {{ radius = 0.8; {glass} }}\n")
        process = self.at_work(scene, "-o", self.path("slow.png"), "--size", "64x64")
        before = processor_seconds(process.pid)
        process.send_signal(signal.SIGTERM)
        begin = time.monotonic()
        while not (end := os.wait4(process.pid, os.WNOHANG))[0]:
            self.assertLess(time.monotonic() - begin, PATIENCE)
            time.sleep(0.01)
        process.returncode = os.waitstatus_to_exitcode(end[1])
        # The smaller of both: a busy machine lengthens the time by the clock, threads that of the processors.
        work = end[2].ru_utime + end[2].ru_stime - before
        self.assertLess(min(work, time.monotonic() - begin), 5)
        self.assertEqual(process.returncode, 75)

    def test_a_signal_ends_a_drawing_at_once(self):
        scene = self.write("tori.alhazen", "alhazen 1\n" + "torus {}\n" * 20)
        for style in "shaded", "technical":
            process = self.at_work(scene, "-o", self.path("out.svg"), "--style", style, "--tolerance", "0.00001",
                                   command="vector")
            process.send_signal(signal.SIGTERM)
            begin = time.monotonic()
            _, messages = process.communicate(timeout=PATIENCE)
            self.assertLess(time.monotonic() - begin, 5, style)
            self.assertEqual(process.returncode, 75, style)
            self.assertIn("stopped", messages)
            self.assertFalse(os.path.exists(self.path("out.svg")))

    def test_a_signal_while_the_scene_is_read_exits_75_at_once(self):
        big = self.path("big.obj")
        with open(big, "w", encoding="ascii") as file:
            file.write("v 0.123456 1.2345678 -9.87654321\n" * 3_000_000)
        ends = []
        # Repeats with a longer delay if the signal comes before the first line of the program on a busy machine.
        for seconds in 0.1, 0.2, 0.4, 0.8:
            process = subprocess.Popen([ALHAZEN, "render", big, "-o", self.path("big.png")],
                                       stderr=subprocess.PIPE, text=True)
            time.sleep(seconds)
            process.send_signal(signal.SIGTERM)
            _, messages = process.communicate(timeout=PATIENCE)
            ends.append(process.returncode)
            if ends[-1] == 75:
                break
        self.assertEqual(ends[-1], 75, ends)
        self.assertIn("the work in hand has no result", messages)
        self.assertFalse(os.path.exists(self.path("big.png")))

    def test_the_first_scene_of_the_guide_renders(self):
        with open(os.path.join(SOURCE, "docs/guide/first_scene.md"), encoding="utf-8") as guide:
            text = guide.read()
        scene = self.write("first.alhazen", text[text.index("alhazen 1\n"):].split("```")[0])
        self.assertEqual(run("render", scene, "-o", self.path("first.png"), "--size", "32x32", "--strict").returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
