#!/usr/bin/env python3
"""Runs the command line as a user would: usage, messages, exit statuses, files.

Usage: command_line_test.py ALHAZEN SOURCE_FOLDER
"""

import json
import os
import re
import resource
import subprocess
import sys
import time
import unittest

from command_line import ALHAZEN, CommandLineCase, run

# Limit in seconds for a short command; sanitizers make programs slower (tests/cli/CMakeLists.txt).
PATIENCE = 60 * int(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))


class CommandLine(CommandLineCase):
    def test_help_and_version_go_to_stdout_and_succeed(self):
        for arguments in (["--help"], ["render", "--help"], ["--version"]):
            result = run(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertTrue(result.stdout)
            self.assertEqual(result.stderr, "")

    def test_help_is_a_command_too(self):
        for command in [], ["render"]:
            result = run("help", *command)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(result.stdout, run(*command, "--help").stdout)
        self.assertEqual(run("help", "help").stdout, run("--help").stdout)
        self.assertRegex(run("help", "paint").stderr, "'paint'.*render, convert")

    def test_help_tells_the_samples_of_each_renderer_and_the_time_that_a_shutter_shows(self):
        text = " ".join(run("render", "--help").stdout.split())
        usual = re.search(r"default: 64 for ([\w, ]+); 16 for ([\w, ]+); else 1\.", text)
        self.assertEqual([set(names.split(", ")) for names in usual.groups()],
                         [{"path_tracing", "light_tracing", "bidirectional", "sppm", "vcm"},
                          {"distributed", "photon_mapping", "ambient_occlusion"}])
        self.assertIn("`distributed` and the renderers of light transport render all of this time", text)

    def test_help_names_every_value_and_says_the_same_of_quiet(self):
        commands = re.findall(r"^  (\w+) ", run("--help").stdout.partition("Subcommands:")[2], re.MULTILINE)
        self.assertGreater(len(commands), 15)
        quiet = set()
        for command in commands:
            text = run(command, "--help").stdout
            self.assertEqual(re.findall(r"^  [-\w,]+ (?:TEXT|U?INT|FLOAT)\b.*", text, re.MULTILINE), [], command)
            quiet.update(re.findall(r"-q,--quiet +(.*)", text))
        self.assertEqual(quiet, {"No progress, no warnings, no summary"})

    def test_limits_of_time_have_units_and_older_names(self):
        for limit in (["--time-limit", "0.1"], ["--time-limit", "0.1s"], ["--time", "0.1s"]):
            result = self.render("--renderer", "path_tracing", *limit, "--stats", "-", size="4x3")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIsNotNone(json.loads(result.stdout)["sampling"]["rounds"], limit)
        for name in ("--time-limit", "--budget"):
            for limit in ("0.05", "0.05s", "0.001m"):
                for command in (["measure"], ["section", "--plane", "0,0,1,1", "--json", self.path("s.json")]):
                    result = run(*command, self.scene, name, limit)
                    self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertRegex(run("measure", self.scene, "--time-limit", "2x").stderr, "expected seconds, or a time .*not 2x")
        # At most 1e6 seconds.
        self.assertEqual(run("compare", self.scene, "--time-limit", "1000h").returncode, 2)

    def test_an_option_given_twice_is_said_to_be(self):
        result = self.render("-t", "1", "-t", "2")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--threads: was given more than once\n", result.stderr)
        self.assertIn("--shutter: was given more than once\n",
                      self.render("--shutter", "0,1", "--shutter", "0,2").stderr)
        self.assertIn("--shutter '0,1,2': expected OPEN,CLOSE, two finite times", self.render("--shutter", "0,1,2").stderr)

    def test_switches_of_the_programs_for_ray_files_get_a_hint(self):
        width, depth = self.render("-w", "512"), self.render("-r", "5")
        self.assertEqual((width.returncode, depth.returncode), (2, 2))
        self.assertIn("not expected: 512 -w; the size of a picture is --size WIDTHxHEIGHT\n", width.stderr)
        self.assertIn("not expected: 5 -r; the depth of recursion is --depth N\n", depth.stderr)
        self.assertNotIn("--depth", width.stderr)
        self.assertNotIn("is --", self.render("--wide").stderr)
        self.assertIn("--width 512: nodes of the accelerator have 4, 8 or 16 children; the size of a picture is --size",
                      self.render("--width", "512").stderr)

    def test_the_limit_of_the_terms_of_a_polynomial_is_told(self):
        start = "alhazen 1\nalgebraic { clip_box = ((-1, -1, -1), (1, 1, 1)); expression = "
        self.assertEqual(run("info", self.write("f.alhazen", start + '"1e149*(x^2+y^2-1)" }\n')).returncode, 0)
        result = run("info", self.write("g.alhazen", start + '"1e150*(x^2+y^2-1)" }\n'))
        self.assertEqual(result.returncode, 3)
        self.assertIn("must be below 1e150 within clip_box", result.stderr)

    def test_a_renderer_without_an_accelerator_says_that_options_of_one_have_no_effect(self):
        scene = self.write("flat.alhazen", "alhazen 1\nrectangle { corner = (0, 0, 0); edge_u = (1, 0, 0); edge_v = (0, 1, 0) }\n")
        start = ["render", scene, "-o", self.path("out.png"), "--size", "4x4", "--renderer", "lane_carpenter"]
        for options in ["--accelerator", "octree"], ["--build", "high"], ["--width", "4"], ["--compact"]:
            result = run(*start, *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("'lane_carpenter' has no accelerator", result.stderr)
            self.assertNotIn("no accelerator", run(*start, *options, "-q").stderr)
        self.assertNotIn("no accelerator", run(*start).stderr)

    def test_options_without_effect_are_told_by_all_commands_and_refused_with_strict(self):
        flat = self.write("flat.alhazen", "alhazen 1\nperspective_camera { eye = (0, 0, 5); look_at = (0, 0, 0) }\n"
                                          "rectangle { corner = (0, 0, 0); edge_u = (1, 0, 0); edge_v = (0, 1, 0) }\n")
        small = ["--accelerator", "octree", "--compact"]
        idle = "accelerator 'octree' is built without --build, --width and --compact"
        vector = ["vector", flat, "-o", self.path("out.svg")]
        technical = [*vector, "--style", "technical", "--hidden", "dashed"]
        for command, message in (["verify", flat, "--rays", "100"], idle), (technical, idle), \
                (vector, "has no accelerator"), (["spans", flat, "--ray", "0,0,1,0,0,-1"], idle), \
                (["render", flat, "-o", self.path("out.png"), "--size", "4x4"], idle):
            result = run(*command, *small)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stderr.count("warning: " + message if message == idle else message), 1, result.stderr)
            self.assertNotIn(message, run(*command, *small, "-q").stderr)
            self.assertNotIn(message, run(*command).stderr)
            strict = run(*command, *small, "--strict")
            self.assertEqual(strict.returncode, 2, strict.stderr)
            self.assertIn("alhazen: ", strict.stderr)
            self.assertIn(message, strict.stderr)
        self.assertNotIn("--compact", run("verify", flat, "--rays", "100", "--compact").stderr)
        both = self.render("--accelerator", "light_buffer:density=4,resolution=8")
        self.assertEqual(both.returncode, 2)
        self.assertIn("accelerator 'light_buffer': density has no effect beside resolution", both.stderr)
        self.assertEqual(self.render("--accelerator", "light_buffer:density=4,resolution=0").returncode, 0)
        grid = self.render("--accelerator", "uniform_grid:density=4,nx=2,ny=2,nz=2")
        self.assertIn("accelerator 'uniform_grid': density has no effect beside nx, ny and nz", grid.stderr)
        self.assertEqual(self.render("--accelerator", "uniform_grid:density=4,nx=2,ny=2").returncode, 0)

    def test_options_for_files_that_are_not_written_are_refused(self):
        section = ["section", self.scene, "--plane", "0,1,0,1"]
        for options, message in (["--size", "9x9"], "--size needs -o"), (["--camera", "top"], "--camera needs -o"), \
                (["--unit", "cm"], "--unit needs --svg"), (["--grid", "64"], "--grid needs --svg"), \
                (["--tolerance", "1"], "--tolerance needs --svg"), (["--json", "/no/folder/a"], "cannot write /no/folder/a"):
            result = run(*section, *options)
            self.assertEqual(result.returncode, 4 if "cannot" in message else 2, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual(result.stdout, "")
        technical = run("vector", self.scene, "-o", self.path("out.svg"), "--style", "technical", "--tolerance", "1", "--depth", "1")
        self.assertIn("--depth is for drawings with mirror images", technical.stderr)
        self.assertIn("--allow-remote needs --serve", run("view", self.scene, "--no-open", "--allow-remote").stderr)
        self.assertIn("expected a file .svg", run("samples", "sobol", "-o", self.path("out.png")).stderr)
        for command in "verify", "measure":
            result = run(command, self.scene, "--json", "/no/folder/a")
            self.assertEqual(result.returncode, 4)
            self.assertEqual(result.stdout, "")

    def test_a_value_of_the_wrong_kind_is_told_with_its_option(self):
        self.assertIn("--spp: expected a number of its kind (see --help), not x\n", self.render("--spp", "x").stderr)
        self.assertIn("--seed: expected a number of its kind", run("verify", self.scene, "--seed", "1.5").stderr)
        self.assertIn("expected --ray or --rays (see", run("spans", self.scene).stderr)
        self.assertIn("expected --point or --points (see", run("inside", self.scene).stderr)

    def test_files_of_points_may_begin_with_a_byte_order_mark(self):
        points = self.path("points.txt")
        with open(points, "wb") as file:
            file.write(b"\xef\xbb\xbf0,1,0\r\n")
        result = run("inside", self.scene, "--points", points, "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('"point":[0.0,1.0,0.0]', result.stdout)
        for encoding in "utf-16", "utf-16-le", "utf-32":
            with open(points, "wb") as file:
                file.write("0,1,0\n".encode(encoding))
            result = run("inside", self.scene, "--points", points, "-q")
            self.assertEqual(result.returncode, 3, result.stderr)
            self.assertIn(f"points.txt:1:1: the file is {encoding[:6].upper()} text; expected ASCII or UTF-8", result.stderr)

    def test_help_is_of_one_command_and_lists_of_qualities_are_complete(self):
        result = run("help", "render", "convert")
        self.assertEqual(result.returncode, 2)
        self.assertIn("help: expected one command", result.stderr)
        self.assertEqual(run("help", "render").stdout, run("render", "--help").stdout)
        self.assertIn("the valid names are: auto, fast, default, high", self.render("--build", "zz").stderr)
        self.assertIn("the valid names are: fast, default, high", run("info", self.scene, "--build", "zz").stderr)

    def test_compare_keeps_what_it_has_measured(self):
        report = self.path("report.json")
        options = ["--accelerators", "kd_tree", "--no-tuning", "--size", "24x18", "--time-limit", "0.05", "-q"]
        missing = run("compare", self.scene, self.path("none.alhazen"), "--json", report, *options)
        self.assertEqual(missing.returncode, 4)
        self.assertIn("none.alhazen: cannot open the file: No such file or directory", missing.stderr)
        self.assertFalse(os.path.exists(report))
        bad = self.write("bad.alhazen", "alhazen 1\nsphere { radius = -1 }\n")
        self.assertEqual(run("compare", self.scene, bad, "--json", report, *options).returncode, 3)
        with open(report, encoding="utf-8") as file:
            self.assertEqual(len(json.load(file)["scenes"]), 1)

    def test_a_signal_ends_compare_and_leaves_the_scenes_before(self):
        report = self.path("report.json")
        process = subprocess.Popen(
            [ALHAZEN, "compare", self.scene, self.scene, "--json", report, "--accelerators", "kd_tree", "--no-tuning",
             "--size", "64x48", "--time-limit", "20", "-q"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        begin = time.time()
        while not os.path.exists(report) and process.poll() is None and time.time() < begin + 120:
            time.sleep(0.01)
        process.terminate()
        process.communicate(timeout=PATIENCE)
        self.assertIn(process.returncode, (75, 0))  # 0: finished before the signal
        with open(report, encoding="utf-8") as file:
            self.assertIn(len(json.load(file)["scenes"]), (1, 2))
        claims = subprocess.Popen([ALHAZEN, "compare", "--claim", "A3", "-q"], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True)
        time.sleep(1)
        claims.terminate()
        claims.communicate(timeout=PATIENCE)
        self.assertEqual(claims.returncode, 75)

    def test_wrong_usage_exits_2_and_says_why(self):
        picture = self.path("out.png")
        for arguments in ([], ["paint"], ["render"], ["render", self.scene], ["render", self.scene, "-o", "x.gif"],
                          ["render", self.scene, "-o", picture, "--accelerator", "octopus"],
                          ["render", self.scene, "-o", picture, "--csg", "octopus"],
                          ["verify", self.scene, "--accelerator", "octopus"], ["info", self.scene, "--csg", "octopus"],
                          ["vector", self.scene, "-o", self.path("out.svg"), "--accelerator", "octopus"],
                          ["convert", self.scene, self.path("out.ply"), "--accelerator", "wide_bvh"],
                          ["convert", self.scene, self.path("out.ply"), "--csg", "roth"],
                          ["render", self.scene, "-o", picture, "--renderer", "magic"],
                          ["render", self.scene, "-o", picture, "--size", "10"],
                          ["render", self.scene, "-o", picture, "--size", "0x10"],
                          ["render", self.scene, "-o", picture, "--spp", "0"],
                          ["render", self.scene, "-o", picture, "--seed", "-1"],
                          ["render", self.scene, "-o", picture, "--seed", "18446744073709551616"], ["samples", "sobol", "--seed=-1"],
                          ["render", self.scene, "-o", picture, "--crop", "5,5,5,9"],
                          ["render", self.scene, "-o", picture, "--camera", "nobody"],
                          ["render", self.scene, "-o", picture, "--encoding", "gamma"],
                          ["render", self.path("none.alhazen"), "-o", picture, "--tonemap", "filmic"],
                          ["render", self.scene, "-o", picture, "--exposure", "nan"],
                          ["render", self.scene, "-o", picture, "--white-balance", "0"],
                          ["render", self.scene, "-o", picture, "--environment", "studio"],
                          ["render", self.scene, "-o", picture, "--protocol", "spd", "--spp", "4"],
                          ["render", self.scene, "-o", picture, "--stats", self.path("./out.png")],
                          ["compare", self.scene, "--json", picture, "--html", self.path("./out.png")],
                          ["section", self.scene, "--plane", "0,0,1,1", "-o", picture, "--svg", picture],
                          ["render", self.scene, "-o", picture, "--aov", "depth", "--stats", self.path("out.depth.png")],
                          ["render", self.scene, "-o", picture, "--aov", "depht"],
                          ["render", self.scene, "-o", picture, "--view", "30"],
                          ["render", self.scene, "-o", picture, "--view", "30,91"],
                          ["render", self.scene, "-o", picture, "--view", "30,20", "--camera", "top"],
                          ["render", self.scene, "-o", picture, "--time", "inf"],
                          ["render", self.scene, "-o", picture, "--sampler", "soboll"],
                          ["render", self.scene, "-o", picture, "--sampler", "regular", "--noise", "0.1"],
                          ["render", self.scene, "-o", picture, "--filter", "tent:radius=99"],
                          ["render", self.scene, "-o", picture, "--filter", "tent:width=1"],
                          ["render", self.scene, "-o", picture, "--noise", "0"],
                          ["render", self.scene, "-o", picture, "--time", "5x"],
                          ["render", self.scene, "-o", picture, "--time", "0s"],
                          ["render", self.scene, "-o", picture, "--time", "3s", "--time", "1m"],
                          ["render", self.scene, "-o", picture, "--time-limit", "0"],
                          ["render", self.scene, "-o", picture, "--time-limit", "infs"],
                          ["render", self.scene, "-o", picture, "--time-limit", "5 parsecs"],
                          ["render", self.scene, "-o", picture, "--time-limit", "3s", "--time", "1m"],
                          ["measure", self.scene, "--time-limit", "1s", "--budget", "1"],
                          ["info", self.scene, "--time", "3s"],
                          ["render", self.scene, "-o", picture, "--noise", "0.1", "--antialias", "whitted"],
                          ["render", self.scene, "-o", picture, "--sampler", "sobol", "--protocol", "spd"],
                          ["render", self.scene, "-o", picture, "--noise", "0.1", "--aov", "time"],
                          ["render", self.scene, "-o", picture, "--filter", "box", "--renderer", "lane_carpenter"],
                          ["samples", "soboll"], ["samples", "sobol", "--dimension", "3"],
                          ["samples", "sobol", "-n", "0"],
                          ["render", self.scene, "-o", picture, "--max-image-pixels", "0"],
                          ["render", self.scene, "-o", picture, "--max-image-mib", "0"],
                          # Options without effect.
                          ["render", self.scene, "-o", picture, "--animation", "0"],
                          ["render", self.scene, "-o", picture, "--shutter", "0,-1"],
                          ["render", self.scene, "-o", picture, "--shutter", "0"],
                          ["render", self.scene, "-o", picture, "--shutter", "0,1", "--time", "0.5"],
                          ["info", self.scene, "--animation", "0"],
                          ["render", self.scene, "-o", picture, "--aov-png"],
                          ["render", self.scene, "-o", self.path("out.jpg"), "--bits", "16"],
                          ["render", self.scene, "-o", self.path("out.exr"), "--bits", "16"],
                          ["render", self.scene, "-o", picture, "--full-float"],
                          ["render", self.scene, "-o", self.path("out.exr"), "--encoding", "srgb"],
                          ["render", self.scene, "-o", self.path("out.exr"), "--exposure", "1"],
                          ["render", self.scene, "-o", self.path("out.pfm"), "--exposure", "0"],
                          ["render", self.scene, "-o", self.path("out.exr"), "--tonemap", "none"],
                          ["render", self.scene, "-o", picture, "--time", "nan"],
                          ["section", self.scene, "--plane", "0,0,1,1", "--svg", self.path("s.svg"), "--tolerance", "nan"],
                          ["section", self.scene, "--plane", "0,0,1,1", "--svg", self.path("s.svg"), "--time-limit", "nan"],
                          ["measure", self.scene, "--error", "nan"], ["measure", self.scene, "--density", "nan"],
                          ["compare", self.scene, "--time-limit", "nan"],
                          ["compare", "--claim", "B1", "--size", "10x10"],
                          ["compare", "--claim", "B1", "--accelerators", "octree"],
                          ["generate", "balls", "--size", "99999999999999999999", "-o", self.path("b.nff")],
                          ["generate", "balls", "--size", "", "-o", self.path("b.nff")],
                          ["generate", "balls", "--size", "-1", "-o", self.path("b.nff")],
                          ["diff", self.scene, self.scene, "--max", "nan"],
                          ["verify", self.scene, "--rays", "-1"],
                          ["explain", self.scene, "--pixel", "1,1", "-o", self.path("e.json"), "--view", "0,0", "--camera", "top"],
                          ["diff", self.scene], ["list", "colours"]):
            result = run(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr, arguments)
            self.assertEqual(result.stdout, "", arguments)
        self.assertEqual(os.listdir(self.folder.name), ["scene with space.alhazen"])

    def test_every_renderer_renders(self):
        scene = self.path("facets.alhazen")
        with open(scene, "w") as file:
            file.write("""alhazen 1
                perspective_camera { eye = (0, 0, 4); look_at = (0, 0, 0); lens_radius = 0.1; focus_distance = 4 }
                point_light { position = (1, 2, 3) }
                rectangle_light { corner = (-1, 2, 1); edge_u = (0, 0, 1); edge_v = (1, 0, 0); radiance = 2 }
                box { motion = [(0, translate(0, 0, 0)), (1, translate(0.2, 0, 0))] }""")
        names = [line.split()[0] for line in run("list", "renderers").stdout.splitlines() if line.startswith("  ")]
        self.assertIn("distributed", names)
        for name in names:
            picture = self.path(f"{name}.png")
            result = run("render", scene, "-o", picture, "--size", "9x7", "--renderer", name)
            self.assertEqual(result.returncode, 0, (name, result.stderr))
            self.assertTrue(os.path.getsize(picture) > 50, name)

    def test_names_that_are_not_known_are_answered_with_those_that_are(self):
        self.assertIn("wide_bvh", self.render("--accelerator", "octopus").stderr)
        self.assertIn("whitted", self.render("--renderer", "magic").stderr)
        self.assertIn("'top'", self.render("--camera", "nobody").stderr)
        self.assertIn("id.material", self.render("--aov", "depht").stderr)
        self.assertRegex(run("paint").stderr, "'paint'.*render, convert")
        self.assertIn(".nff", run("generate", "balls", "-o", self.path("balls.png")).stderr)

    def test_renderers_are_named_that_take_the_option(self):
        for option, refused in (["--sampler", "sobol"], ()), (["--time-limit", "1s"], ("sppm", "vcm", "light_tracing")):
            message = self.render("--renderer", "cone_tracing", *option).stderr
            self.assertIn(option[0], message)
            named = message.split("renderers ")[1].split(";")[0].split(", ")
            self.assertIn("path_tracing", named)
            self.assertEqual("vcm:merge=off" in named, option[0] == "--time-limit")
            for renderer in named:
                result = self.render("--renderer", renderer, "--spp", "1", *option, size="2x2")
                self.assertEqual(result.returncode, 0, result.stderr)
            for renderer in refused:
                self.assertEqual(self.render("--renderer", renderer, *option, size="2x2").returncode, 2, renderer)

    def test_limits_of_numbers_are_told_in_words(self):
        for wrong in "0", "-1", "nan", "inf":
            result = run("vector", self.scene, "-o", self.path("f.svg"), "--tolerance", wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertIn(f"expected a number above 0, not {wrong}", result.stderr)

    def test_memory_limits_are_whole_numbers_up_to_the_bound_that_help_prints(self):
        text = run("info", "--help").stdout
        for option in "--max-image-pixels", "--max-image-mib", "--max-import-mib":
            shown = text.split(option)[1].split("--")[0]
            self.assertNotIn("FLOAT", shown)
            most = re.search(r"INT in \[1 - (\d+)\]", shown).group(1)
            result = run("info", self.scene, option, most)
            self.assertEqual(result.returncode, 0, result.stderr)
            for wrong in "0", "1.5", "1e3", str(int(most) + 1):
                result = run("info", self.scene, option, wrong)
                self.assertEqual(result.returncode, 2, wrong)
                self.assertIn(f"expected a whole number from 1 to {most}, not {wrong}", result.stderr)

    def test_a_bad_scene_exits_3_with_every_place(self):
        bad = self.write("bad.alhazen", "alhazen 1\nsphere { radius = -1 }\nsphere { radius = nan }\nbanana { }\n")
        result = run("render", bad, "-o", self.path("out.png"))
        self.assertEqual(result.returncode, 3)
        for place in (":2:", ":3:", ":4:"):
            self.assertIn(bad + place, result.stderr)

    def test_strict_turns_warnings_of_every_command_into_errors(self):
        scene = self.write("bare.obj", "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        picture = self.path("out.png")
        size = ("--size", "8x8")
        for arguments in (("render", scene, "-o", picture, *size), ("info", scene),
                          ("convert", scene, self.path("out.ply")), ("verify", scene, "--rays", "8"),
                          ("measure", scene, "--time-limit", "1s"), ("spans", scene, "--ray", "0,0,1,0,0,-1"),
                          ("section", scene, "--plane", "0,0,1,0", "-o", picture, *size),
                          ("compare", scene, "--accelerators", "kd_tree", "--no-tuning", *size)):
            result = run(*arguments, "--strict")
            self.assertEqual(result.returncode, 3, (arguments, result.stderr))
            self.assertIn(scene + ":1:", result.stderr)
            self.assertIn(": error: ", result.stderr)
            self.assertFalse(os.path.exists(picture))
        self.assertEqual(run("info", scene).returncode, 0)
        self.assertEqual(run("info", self.scene, "--strict").returncode, 0)

    def test_files_that_are_missing_or_no_files_exit_4(self):
        for name in (self.path("absent.alhazen"), self.folder.name):
            self.assertEqual(run("info", name).returncode, 4, name)
        os.mkfifo(self.path("pipe"))
        self.assertEqual(run("info", self.path("pipe")).returncode, 4)

    def test_a_failed_write_exits_4_and_keeps_the_old_picture(self):
        self.assertEqual(self.render().returncode, 0)
        before = self.read("out.png")
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
        result = run("render", self.scene, "-o", self.path("out.png"), "--size", "200x200", preexec_fn=limit)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(self.read("out.png"), before)
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["out.png", "scene with space.alhazen"])
        missing = os.path.join(self.folder.name, "no", "out.png")
        self.assertEqual(run("render", self.scene, "-o", missing).returncode, 4)

    def test_a_picture_that_cannot_be_written_is_told_before_the_work(self):
        started = time.monotonic()
        result = run("render", self.scene, "-o", self.path("no/out.png"), "--size", "4000x4000", "--spp", "1000")
        self.assertEqual(result.returncode, 4)
        self.assertLess(time.monotonic() - started, 30)

    def test_standard_output_that_is_full_exits_4(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            result = subprocess.run([ALHAZEN, "list"], stdout=full, stderr=subprocess.PIPE, check=False, timeout=PATIENCE)
        self.assertEqual(result.returncode, 4)

    def test_links_do_not_lead_out_of_the_folder_of_the_scene(self):
        os.mkdir(self.path("outside"))
        os.mkdir(self.path("inside"))
        self.write("outside/part.alhazen", "alhazen 1\nsphere { }\n")
        os.symlink("../outside", self.path("inside/link"))
        scene = self.write("inside/scene.alhazen", 'alhazen 1\ninclude "link/part.alhazen"\n')
        self.assertEqual(run("info", scene).returncode, 3)
        self.assertEqual(run("info", scene, "--allow-path", self.folder.name).returncode, 0)

    def test_allowed_folders_are_added_to_that_of_the_scene(self):
        for name in "own", "one", "two":
            os.mkdir(self.path(name))
            self.write(name + "/part.alhazen", "alhazen 1\nsphere { }\n")
        self.write("own/away.alhazen", f'alhazen 1\ninclude "{self.path("two")}/part.alhazen"\n')
        scene = self.write("own/scene.alhazen", 'alhazen 1\ninclude "part.alhazen"\ninclude "../one/part.alhazen"\n'
                           f'include "{self.path("two")}/part.alhazen"\n')
        one, two = ["--allow-path", self.path("one")], ["--allow-path", self.path("two")]
        for allowed, status in (([], 3), (one, 3), (two, 3), (one + two, 0), (["--allow-path", self.folder.name], 0)):
            result = run("info", scene, *allowed)
            self.assertEqual(result.returncode, status, allowed)
            self.assertEqual("--allow-path" in result.stderr, status == 3)
        # The argument after the option's folder is the scene.
        self.assertEqual(run("info", *one, *two, scene).returncode, 0)
        # A link in an allowed folder must not lead outside the allowed folders.
        os.symlink("../two/part.alhazen", self.path("one/link.alhazen"))
        scene = self.write("own/link.alhazen", 'alhazen 1\ninclude "../one/link.alhazen"\n')
        self.assertEqual(run("info", scene, *one).returncode, 3)
        self.assertEqual(run("info", scene, *one, *two).returncode, 0)

    def test_control_characters_of_names_do_not_reach_the_terminal(self):
        bad = 'x\x1b[31m\a\x7f\x9b\0y'
        name = bad.replace("\0", "")  # a NUL would make it binary
        self.write("m.mtl", f"newmtl {name}\nKd 1 0 0\nmap_Kd {name}.png\n")
        mesh = self.write("m.obj", f"mtllib m.mtl\nmtllib {name}\no {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl {name}\n"
                                   f"f 1 2 3\nusemtl not{name}\nf 1 2 3\n")
        gltf = self.write("m.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"name": bad + "\nnext", "camera": 0}], "materials": [{"name": bad + "\nnext"}],
            "cameras": [{"name": bad, "type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
            "images": [{"uri": name + "\n.png"}], "textures": [{"source": 0}]}))
        missing = run("info", gltf)
        self.assertEqual(missing.returncode, 3)
        self.write(name + "\n.png", "no picture")
        results = [missing, run("render", mesh, "-o", self.path("o.png"), "--size", "8x8"), run("info", mesh),
                   run("info", mesh, "--json"), run("info", gltf), run("info", gltf, "--json"),
                   run("render", gltf, "-o", self.path("o.png"), "--camera", "nobody"), run("info", self.path(name))]
        for result in results:
            text = result.stdout + result.stderr
            self.assertFalse([c for c in text if c != "\n" and (ord(c) < 32 or 127 <= ord(c) < 160)], repr(text))
            # No name begins a line.
            self.assertNotIn("\nnext", text)
            self.assertTrue(text)
        self.assertIn(r"x\x1b[31m\x07\x7f\xc2\x9b", results[2].stdout)
        self.assertEqual(json.loads(results[5].stdout)["materials"][0]["name"], bad + "\nnext")
        self.assertIn(r"\x00y", results[4].stdout)

    def test_diff_exits_1_above_the_bound(self):
        self.render(output="a.png")
        self.render("--camera", "top", output="b.png")
        result = run("diff", self.path("a.png"), self.path("b.png"), "-o", self.path("d.png"), "--json")
        self.assertEqual(result.returncode, 1)
        self.assertGreater(json.loads(result.stdout)["different"], 0.1)
        self.assertTrue(self.read("d.png").startswith(b"\x89PNG"))

    def test_a_picture_that_cannot_be_used_has_one_exit_status(self):
        for content, status in ((b"no picture", 3), (b"PF\n8 8\n-1.0\n1234", 3), (b"PF\n-1 4\n-1.0\n", 3),
                                (b"PF\n100000 100000\n-1.0\n", 5)):
            with open(self.path("p.pfm"), "wb") as file:
                file.write(content)
            scene = self.write("textured.alhazen", 'alhazen 1\ntexture "t" { file = "p.pfm" }\nsphere {}\n')
            told = run("diff", self.path("p.pfm"), self.path("p.pfm"))
            rendered = run("render", scene, "-o", self.path("out.png"), "--size", "8x8", "-q")
            self.assertEqual((told.returncode, rendered.returncode), (status, status), content)
            self.assertIn("textured.alhazen:2:1: error: texture: ", rendered.stderr)

    def test_small_work_does_not_start_the_library_of_tasks(self):
        def starts_tasks(*arguments):
            # glibc's loader tells what is loaded: TBB loads its allocator when it starts.
            result = subprocess.run([ALHAZEN, "render", self.scene, "-o", self.path("out.png"), "-q", *arguments],
                                    capture_output=True, text=True, env={**os.environ, "LD_DEBUG": "files"})
            self.assertEqual(result.returncode, 0)
            return "libtbbmalloc" in result.stderr

        if not starts_tasks("--size", "640x480", "-t", "2"):
            self.skipTest("no TBB with an allocator, one core, or another loader")
        self.assertFalse(starts_tasks("--size", "640x480", "-t", "1"))
        self.assertFalse(starts_tasks("--size", "16x12"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
