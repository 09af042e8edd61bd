#!/usr/bin/env python3
"""What commands answer about scenes: reports, statistics, queries of solids, drawings, generated scenes.

Usage: command_answers_test.py ALHAZEN SOURCE_FOLDER
"""

import json
import sys
import unittest

from command_line import CommandLineCase, run, SPHERES


class CommandAnswers(CommandLineCase):
    def test_vector_draws(self):
        scene = self.path("boxes.alhazen")
        with open(scene, "w") as file:
            file.write("alhazen 1\nbox {}\nbox { lo = (1, 0, 0); hi = (2, 1, 1) }")
        for name, start in (("a.svg", "<svg"), ("b.pdf", "%PDF-")):
            result = run("vector", scene, "-o", self.path(name), "--style", "lined", "--size", "64x48")
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(self.path(name), "rb") as file:
                self.assertIn(start.encode(), file.read()[:200])
        for arguments in (["-o", self.path("c.png")], ["-o", self.path("c.svg"), "--style", "fancy"]):
            self.assertEqual(run("vector", scene, *arguments).returncode, 2, arguments)
        with open(scene, "a") as file:
            file.write("\nsphere {}")
        result = run("vector", scene, "-o", self.path("d.svg"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("sphere", result.stderr)
        result = run("vector", scene, "-o", self.path("d.svg"), "--tolerance", "0.1")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = run("vector", scene, "-o", self.path("e.svg"), "--style", "technical", "--hidden", "dashed")
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("e.svg")) as file:
            drawn = file.read()
        self.assertIn('class="hidden"', drawn)
        self.assertRegex(drawn, 'd="M[^"]*A')
        for arguments in (["--hidden", "dashed"], ["--style", "technical", "--hidden", "x"], ["--tolerance", "-1"]):
            self.assertEqual(run("vector", scene, "-o", self.path("f.svg"), *arguments).returncode, 2, arguments)
        result = run("render", scene, "-o", self.path("g.png"), "--size", "32x24", "--renderer",
                     "beam_tracing:tolerance=0.1")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_vector_says_what_it_mends(self):
        scene = self.path("bow_tie.alhazen")
        corners = "(-1, -1, 0), (1, 1, 0), (1, -0.8, 0), (-1, 1, 0)"
        with open(scene, "w") as file:
            file.write('alhazen 1\npolygon "bow tie" { loops = [[%s]] }\n' % corners)
        result = run("vector", scene, "-o", self.path("a.svg"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, "alhazen:2:1: polygon 'bow tie': 1 crossing")
        with open(scene, "w") as file:
            bent = corners.replace("1, 1, 0", "1, 1, 0.9")
            file.write("alhazen 1\npolygon { loops = [[%s], [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)]] }\n" % bent)
        result = run("vector", scene, "-o", self.path("a.svg"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stderr, "off its plane.*line 2")

    def test_samples_draws_every_sampler(self):
        names = [line.split()[0] for line in run("list", "samplers").stdout.splitlines() if line.startswith("  ")]
        self.assertIn("sobol", names)
        for name in names:
            result = run("samples", name, "-n", "64", "--sets", "4", "-o", self.path("samples.svg"))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"{name}: 64 points", result.stdout)
            self.assertEqual(self.read("samples.svg").count(b"<circle"), 64)

    def test_statistics_have_what_is_promised(self):
        result = self.render("--stats", "-", "-q")
        stats = json.loads(result.stdout)
        self.assertEqual(stats["rays"]["eye"]["cast"], 64 * 48)
        for kind in ("eye", "shadow", "reflection", "refraction"):
            self.assertLessEqual(stats["rays"][kind]["hit"], stats["rays"][kind]["cast"])
        self.assertIn("total_internal", stats["rays"]["refraction"])
        for key in ("box", "primitive", "primitive_hit", "mailbox_saved", "node_visits"):
            self.assertIn(key, stats["tests"])
        self.assertGreater(stats["tests"]["primitive"], 0)
        for key in ("accelerator_bytes", "scene_bytes", "peak_rss_bytes", "effective_primitives"):
            self.assertGreater(stats["memory"][key], 0, key)
        for key in ("load", "build", "render", "write"):
            self.assertGreaterEqual(stats["seconds"][key], 0)

    def test_statistics_without_counts_have_the_same_rays_and_no_tests(self):
        counted = json.loads(self.render("--stats", "-", "-q").stdout)
        plain = json.loads(self.render("--stats", "-", "--no-counts", "-q").stdout)
        self.assertIsNone(plain["tests"])
        self.assertEqual(plain["rays"], counted["rays"])

    def test_databases_are_generated_as_nff_and_as_native_scenes(self):
        for name in ("tetra.nff", "tetra.alhazen"):
            result = run("generate", "tetra", "--size", "2", "-q", "-o", self.path(name))
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            info = json.loads(run("info", self.path(name), "--json").stdout)
            self.assertEqual(info["triangles"], 16)
        run("render", self.path("tetra.nff"), "-o", self.path("a.pfm"), "--size", "64x64", "-q")
        run("render", self.path("tetra.alhazen"), "-o", self.path("b.pfm"), "--size", "64x64", "-q")
        self.assertEqual(self.read("a.pfm"), self.read("b.pfm"))
        run("generate", "balls", "--size", "1", "--digits", "3", "-q", "-o", self.path("b.nff"))
        self.assertIn(b"\ns 0.272 0.272 0.544 0.167\n", self.read("b.nff"))
        for wrong in (["balls", "--size", "9", "-o", "x.nff"], ["field", "-o", "x.nff"],
                      ["balls", "--digits", "3", "-o", "x.alhazen"], ["ball", "-o", "x.nff"],
                      ["balls", "--digits", "30", "-o", "x.nff"], ["balls", "-o", "x.png"]):
            result = run("generate", *wrong)
            self.assertEqual(result.returncode, 2, wrong)
            self.assertTrue(result.stderr, wrong)

    def test_sizes_and_formats_that_generators_do_not_have_are_refused_as_they_were_written(self):
        result = run("generate", "balls", "--size", "-1", "-o", self.path("b.nff"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("--size '-1'", result.stderr)
        result = run("generate", "balls", "--size", "1", "-o", self.path("b.stl"))
        self.assertEqual(result.returncode, 2)
        self.assertNotIn("--meshes-only", result.stderr)

    def test_the_bytes_of_instances_are_told(self):
        run("generate", "field", "--size", "1000000", "-q", "-o", self.path("field.alhazen"))
        memory = json.loads(run("info", self.path("field.alhazen"), "--json").stdout)["memory"]
        self.assertLess(memory["bytes_per_effective_primitive"], 2)
        self.assertIn("primitives as rays see them",
                      run("info", self.path("field.alhazen")).stdout)

    def test_info_and_verify(self):
        info = json.loads(run("info", self.scene, "--json").stdout)
        self.assertEqual(info["parts"], {"plane": 1, "sphere": 1})
        self.assertIsNone(info["bounds"])
        result = run("verify", self.scene, "--rays", "500", "--json", "-", "-q")
        self.assertEqual(result.returncode, 0)
        reports = json.loads(result.stdout)
        self.assertTrue(all(report["holds"] for report in reports))
        query_paths = {name: path["rays"] for name, path in reports[0]["query_paths"].items()}
        self.assertEqual(query_paths, {"single": 500, "stream": 500, "coherent": 128})
        result = run("verify", self.solids(), "--exact", "--rays", "300", "--json", "-", "-q")
        exact = [report for report in json.loads(result.stdout) if report.get("exact")]
        self.assertEqual([(report["solids"], report["unchecked"]) for report in exact], [(2, 0)])

    def solids(self):
        return self.write("solids.alhazen", """alhazen 1
material "steel" { diffuse = (0.3, 0.4, 0.5); density = 2 }
sphere "ball" { radius = 2; material = "steel" }
box "block" { lo = (3, -1, -1); hi = (5, 1, 1) }
plane { point = (0, 0, -9) }
""")

    def test_light_below_zero_and_idle_keys_of_profiles_are_errors(self):
        for text, message in (('material "m" { emission = (-1, 0, 0) }\nsphere { material = "m" }',
                               "emission of material 'm' must be finite and not negative, found -1"),
                              ("point_light { position = (0, 0, 3); profile_down = (0, 0, 1) }", "'profile_down' needs 'profile'"),
                              ("spot_light { position = (0, 0, 3); direction = (0, 0, -1); profile_front = (0, 1, 0) }",
                               "'profile_front' needs 'profile'")):
            result = run("info", self.write("bad.alhazen", f"alhazen 1\n{text}\nsphere {{}}\n"))
            self.assertEqual(result.returncode, 3, text)
            self.assertIn(message, result.stderr)

    def test_one_thing_is_told_in_the_singular(self):
        one = self.write("one.alhazen", 'alhazen 1\npolygon { vertices = [(0,0,0), (1,0,0), (0,1,0)] }\n')
        result = run("convert", one, self.path("one.ply"), "--tolerance", "1")
        self.assertIn("1 shape became 1 triangle within 1 of it\n", result.stderr)
        self.assertIn("one.ply: 1 triangle, ", result.stderr)
        solid = self.write("solid.alhazen", "alhazen 1\nunion { sphere {} }\n")
        self.assertIn("1 made of 1 other\n", run("info", solid).stdout)

    def test_questions_about_solids_are_answered_in_lines_of_json(self):
        scene = self.solids()
        result = run("spans", scene, "--ray", "-4,0,0,2,0,0", "--rays", "-", "-q", input="0 0 0 0 0 1\n# none\n9,9,9,0,0,1\n")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([len(line["spans"]) for line in lines], [2, 1, 0])
        ball, block = lines[0]["spans"]
        self.assertEqual((ball["name"], ball["entry"]["t"], ball["exit"]["t"]), ("ball", 1, 3))
        self.assertEqual((ball["entry"]["normal"], ball["entry"]["material"]), ([-1, 0, 0], "steel"))
        self.assertEqual((block["length"], block["exit"]["point"]), (2, [5, 0, 0]))
        self.assertTrue(lines[1]["spans"][0]["entry"]["inside"])
        result = run("thickness", scene, "--ray=-4,0,0,2,0,0")
        self.assertEqual(json.loads(result.stdout)["thickness"], 6)
        self.assertIn("1 surface of the scene bounds no volume: it is left out", result.stderr)
        points = self.write("points.txt", "0 0 0\n3,0,0\n8 8 8\n")
        lines = run("inside", scene, "--points", points).stdout.splitlines()
        inside = [[(s["name"], s["on_surface"]) for s in json.loads(line)["inside"]] for line in lines]
        self.assertEqual(inside, [[("ball", False)], [("block", True)], []])
        for arguments in (["spans", scene], ["spans", scene, "--ray", "1,2,3"], ["inside", scene, "--point", "a,b,c"],
                          ["spans", scene, "--ray", "0,0,0,0,0,0"], ["measure", scene, "nothing"],
                          ["measure", scene, "--overlap", "ball"], ["measure", scene, "--overlap", "ball,nothing"], ["section", scene, "--plane", "0,0,0,1"],
                          ["section", scene, "--plane", "0,0,1"], ["section", scene, "--plane", "0,0,1,0", "-o", "x.gif"]):
            result = run(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr)
        self.assertEqual(run("spans", scene, "--rays", self.path("missing")).returncode, 4)

    def test_measure_gives_figures_with_intervals(self):
        scene = self.solids()
        result = run("measure", scene, "--json", "-", "--error", "1e-3", "-q", "--section", "1,0,0,4",
                     "--overlap", "0,1", "--clearance", "ball,block", "ball", "block")
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(result.stdout)
        ball, block = report["solids"]
        low, high = ball["volume"]["interval"]
        self.assertLess(abs(ball["volume"]["value"] / 33.510321638 - 1), 2e-3)
        self.assertLess(high - low, 0.1)
        self.assertAlmostEqual(ball["mass"]["value"], 2 * ball["volume"]["value"])
        self.assertAlmostEqual(block["volume"]["value"], 8, 9)
        self.assertAlmostEqual(block["area"]["value"], 24, 9)
        self.assertAlmostEqual(block["section_area"]["value"], 4, 9)
        overlap, clearance = report["pairs"]
        self.assertEqual(overlap["overlap_volume"]["value"], 0)
        self.assertAlmostEqual(clearance["clearance"]["at_least"], 1, 9)
        self.assertAlmostEqual(clearance["clearance"]["at_most"], 1, 9)
        self.assertIn("volume", run("measure", scene, "block").stdout)
        self.assertEqual(run("measure", scene, "--json", scene).returncode, 2)

    def test_section_writes_a_picture_and_outlines(self):
        scene = self.solids()
        result = run("section", scene, "--plane", "0,0,1,0", "-o", self.path("cut.png"), "--size", "96x64", "--svg",
                     self.path("cut.svg"), "--json", self.path("cut.json"), "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.read("cut.png")[:4], b"\x89PNG")
        svg = self.read("cut.svg").decode()
        self.assertIn('inkscape:label="ball"', svg)
        self.assertEqual(run("section", scene, "--plane", "0,0,1,0", "--svg", "-").stdout, svg)
        self.assertEqual(svg.count("<path"), 2)
        areas = [solid["area"]["value"] for solid in json.loads(self.read("cut.json"))["solids"]]
        self.assertAlmostEqual(areas[0], 12.566370614, 4)
        self.assertAlmostEqual(areas[1], 4, 9)

    def test_a_section_of_nothing_says_so(self):
        scene = self.solids()
        result = run("section", scene, "--plane", "0,0,1,50", "--svg", self.path("none.svg"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("cuts nothing", result.stdout)
        for report in "--svg", "--json":
            result = run("section", scene, "--plane", "0,0,1,50", report, "-")
            self.assertIn("cuts nothing", result.stderr)
            self.assertNotIn("cuts nothing", result.stdout)
            self.assertEqual(run("section", scene, "--plane", "0,0,1,50", report, "-", "-q").stderr, "")
        with open(self.path("none.svg")) as svg:
            self.assertRegex(svg.read(), 'width="7.[0-9]+mm"')
        result = run("section", scene, "--plane", "0,0,1,0", "--svg", self.path("fine.svg"), "--tolerance", "1e-12")
        self.assertEqual(result.returncode, 2)
        self.assertIn("expected at least", result.stderr)
        result = run("section", scene, "--plane", "0,0,1,0", "-o", self.path("x.png"), "--size", "1000000000x1000000000")
        self.assertEqual(result.returncode, 2)
        self.assertIn("out of range", result.stderr)

    def test_a_section_passes_over_solids_of_nothing_and_of_a_point(self):
        scene = self.write("points.alhazen", """alhazen 1
            intersection "nothing" { sphere { } sphere { center = (5, 0, 0) } }
            intersection "point" { box { lo = (0, 0, 0); hi = (1, 1, 1) } box { lo = (1, 1, 1); hi = (2, 2, 2) } }
            box "far" { lo = (1e6, 1, 1); hi = (1000000.000001, 1.000001, 1.000001) }""")
        for objects in (["nothing"], ["point"], ["far"], []):
            result = run("section", scene, *objects, "--plane", "0,0,1,1", "--svg", self.path("points.svg"))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertNotIn("not bounded", result.stderr)

    def test_info_tells_areas_volumes_and_cameras(self):
        mesh = self.write("cube.obj", "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) +
                          "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
        info = json.loads(run("info", mesh, "--json").stdout)
        self.assertEqual(info["triangles"], 12)
        self.assertAlmostEqual(info["mesh_area"], 6)
        self.assertAlmostEqual(abs(info["mesh_volume"]), 1)
        self.assertIs(info["meshes_closed"], True)
        for side in info["bounds"]["max"]:
            self.assertAlmostEqual(side, 1)
        self.assertGreater(info["memory"]["per_triangle"]["accelerator"], 0)
        text = run("info", mesh).stdout
        for words in ("area 6", "closed", "cameras       none", "bytes per triangle"):
            self.assertIn(words, text)
        cameras = json.loads(run("info", self.scene, "--json").stdout)["cameras"]
        self.assertEqual([c["name"] for c in cameras], ["front", "top"])
        self.assertAlmostEqual(cameras[0]["fov_y_deg"], 40)

    def test_open_edges_are_named(self):
        corners = "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1))
        mesh = self.write("bin.obj", corners + "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\n")  # no lid
        info = json.loads(run("info", mesh, "--json").stdout)
        self.assertIs(info["meshes_closed"], False)
        edges = info["meshes"][0]["edges"]
        self.assertEqual((edges["open"], len(edges["first_open"])), (4, 4))
        self.assertEqual(edges["open_between"]["min"], [0, 0, 1])
        said = "4 of 17 edges are open: ("
        self.assertIn(said, run("info", mesh).stdout)
        result = run("measure", mesh)
        self.assertEqual(result.returncode, 3)
        self.assertIn(said, result.stderr)
        self.assertIn(said, run("spans", mesh, "--ray", "0.5,0.5,-1,0,0,1").stderr)
        # Two cubes that share an edge: four triangles there, no opening.
        moved = "".join(f"v {x} {y} {z}\n" for x in (1, 2) for y in (1, 2) for z in (0, 1))
        faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
        two = self.write("two.obj", corners + moved + "".join(
            "f " + " ".join(str(v + first) for v in face) + "\n" for first in (0, 8) for face in faces))
        info = json.loads(run("info", two, "--json").stdout)
        self.assertIs(info["meshes_closed"], True)
        self.assertEqual(info["meshes"][0]["edges"]["of_four_or_more"], 1)
        report = json.loads(run("measure", two, "--json", "-", "-q", "--error", "1e-3").stdout)
        low, high = report["solids"][0]["volume"]["interval"]
        self.assertTrue(low <= 2 <= high, (low, high))
        # A line along the shared edge, and one across it.
        for ray in ("1,1,-1,0,0,1", "0,0,0.5,1,1,0"):
            self.assertEqual(run("spans", two, "--ray", ray).returncode, 0)

    def test_reports_and_difference_pictures_spare_what_was_read(self):
        self.assertEqual(run("render", self.scene, "-q", "-o", self.path("a.png"), "--size", "8x8").returncode, 0)
        before = self.read("a.png")
        result = run("diff", self.path("a.png"), self.path("a.png"), "-o", self.path("a.png"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("is one of the pictures", result.stderr)
        self.assertEqual(self.read("a.png"), before)
        result = run("verify", self.scene, "-q", "--rays", "10", "--json", self.scene)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(self.read("scene with space.alhazen").decode(), SPHERES)

    def test_bounds_are_those_of_the_vertices(self):
        mesh = self.write("m.obj", "v 0.1 -0.3 0\nv 1 0 0.7\nv 0.2 1 -5\nf 1 2 3\n")
        bounds = json.loads(run("info", mesh, "--json").stdout)["bounds"]
        self.assertEqual((bounds["min"], bounds["max"]), ([0.1, -0.3, -5], [1, 1, 0.7]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=1)
