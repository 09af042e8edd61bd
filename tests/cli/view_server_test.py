#!/usr/bin/env python3
"""`alhazen view`: authorisation, refused requests, and answers.

Usage: view_server_test.py ALHAZEN
"""

import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import time
import unittest

from view_server import DEEP, LIGHTS, SCENE, WISH, Server, ServerTest, png_pixels, rendered

ALHAZEN = sys.argv[1]


class ViewServer(ServerTest):
    def status(self, path="/state", body=None, method="POST", **change):
        return self.server.ask(path, {} if body is None else body, method, **change)[0]

    # ---- authorisation
    def test_it_listens_on_the_loopback_alone_at_a_port_of_its_own(self):
        self.assertEqual(self.server.address, "127.0.0.1")
        other = Server(ALHAZEN, self.scene)
        self.assertNotEqual((other.port, other.token), (self.server.port, self.server.token))
        other.close()
        names = {a[4][0] for a in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
        for name in names - {"127.0.0.1"}:
            if name.startswith("127."):
                continue
            with self.assertRaises(OSError):
                socket.create_connection((name, self.server.port), timeout=2)

    def test_other_addresses_need_allow_remote(self):
        for address, message in (("192.0.2.1", "--allow-remote"), ("0.0.0.0", "one interface"), ("x", "one interface")):
            result = subprocess.run([ALHAZEN, "view", str(self.scene), "--serve", address, "--no-open"],
                                    capture_output=True, text=True, timeout=20)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)

    def test_wrong_tokens_are_refused(self):
        token = self.server.token
        for given in (None, "", "Bearer", "Bearer ", f"Bearer {token[:-1]}", f"Bearer {token}0", token,
                      f"Bearer {'0' * 32}", f"bearer {token}"):
            self.assertEqual(self.status(Authorization=given), 401, given)
        self.assertEqual(self.status(f"/state?token={token}", Authorization=None), 401)

    def test_other_hosts_are_refused(self):
        port = self.server.port
        for host in ("evil.com", f"evil.com:{port}", f"127.0.0.1.evil.com:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}",
                     "", None, f"localhost.:{port}"):
            self.assertIn(self.status(Host=host, Origin=f"http://{host}"), (400, 403), host)
            self.assertIn(self.status("/", b"", "GET", Host=host, Origin=None), (400, 403), host)
        double = f"GET / HTTP/1.1\r\nHost: {self.server.host}\r\nHost: evil.com\r\nConnection: close\r\n\r\n"
        self.assertIn(b" 403 ", self.server.raw(double.encode()).split(b"\r\n")[0])

    def test_this_machine_has_three_names(self):
        for name in ("127.0.0.1", "localhost", "[::1]"):
            host = f"{name}:{self.server.port}"
            self.assertEqual(self.status(Host=host, Origin=f"http://{host}"), 200)

    def test_other_origins_are_refused(self):
        for origin in (None, "null", "http://evil.com", f"https://{self.server.host}", "http://127.0.0.1",
                       f"http://{self.server.host}.evil.com"):
            self.assertEqual(self.status(Origin=origin), 403, origin)
        self.assertEqual(self.status("/", b"", "GET", Origin="http://evil.com"), 403)

    def test_repeated_origins_are_refused(self):
        own, foreign = f"Origin: http://{self.server.host}\r\n", "Origin: http://evil.com\r\n"
        for origins, status in ((own, b" 200 "), (own + foreign, b" 403 "), (foreign + own, b" 403 "), (own + own, b" 403 ")):
            for head, body in (("GET / HTTP/1.1", ""), ("POST /state HTTP/1.1", "{}")):
                text = (f"{head}\r\nHost: {self.server.host}\r\n{origins}Authorization: Bearer {self.server.token}\r\n"
                        f"Content-Length: {len(body)}\r\nConnection: close\r\n\r\n{body}")
                self.assertIn(status, self.server.raw(text.encode()).split(b"\r\n")[0], (head, origins))

    def test_a_simple_request_across_sites_is_refused(self):
        self.assertEqual(self.status("/frame", WISH, Origin="http://evil.com", Authorization=None,
                                     Content_Type="text/plain"), 403)

    # ---- refused requests
    def test_only_files_of_the_page_are_served(self):
        for path in ("/..%2f", "/../../etc/passwd", "/%2e%2e/etc/passwd", "/scene.alhazen", "/view.js/", "//view.js",
                     f"/{self.scene}", "http://evil.com/", "*"):
            self.assertIn(self.status(path, b"", "GET", Origin=None), (400, 404), path)
        for path in ("/", "/view.js", "/view.css"):
            status, headers, body = self.server.ask(path, b"", "GET", Origin=None, Authorization=None)
            self.assertEqual(status, 200)
            self.assertGreater(len(body), 100)
            self.assertNotIn(self.server.token.encode(), body)
        self.assertEqual(self.status("/nothing", {}), 404)
        self.assertEqual((self.status("/state", b""), self.status("/state", b"{")), (200, 400))

    def test_headers_protect_the_page(self):
        for path, method in (("/", "GET"), ("/state", "POST"), ("/none", "GET")):
            _, headers, _ = self.server.ask(path, {} if method == "POST" else b"", method)
            policy = headers["content-security-policy"].split("; ")
            self.assertIn("default-src 'self'", policy)
            self.assertIn(f"connect-src http://{self.server.host} ws://{self.server.host}/frames", policy)
            self.assertIn("frame-ancestors 'none'", policy)
            self.assertNotIn("unsafe", headers["content-security-policy"])
            self.assertEqual(headers["x-content-type-options"], "nosniff")
            self.assertEqual(headers["cross-origin-resource-policy"], "same-origin")
            self.assertFalse([h for h in headers if h.startswith("access-control")])

    def test_other_methods_are_refused(self):
        for method in ("PUT", "DELETE", "OPTIONS", "TRACE", "HEAD", "CONNECT"):
            self.assertIn(self.status("/", b"", method), (400, 405), method)

    def test_large_bodies_and_headers_are_refused(self):
        self.assertEqual(self.status("/frame", b"x" * (1 << 20 | 1)), 413)
        self.assertEqual(self.status("/frame", b"", Content_Length=str(1 << 30)), 413)
        self.assertEqual(self.status(X_Long="x" * 9000), 431)
        self.assertEqual(self.status(f"/{'x' * 9000}"), 431)

    def test_what_is_not_http_is_refused(self):
        for data in (b"\x16\x03\x01\x02\x00\x01", b"GARBAGE\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\0" * 100, b"",
                     b"GET / HTTP/1.1\r\nHost : x\r\n\r\n"):
            answer = self.server.raw(data)
            self.assertTrue(answer == b"" or answer.startswith(b"HTTP/1.1 4"), (data, answer[:80]))

    def test_what_is_no_wish_is_a_clear_error(self):
        def camera(**change):
            return {**WISH, "camera": {**WISH["camera"], **change}}

        for path, body in (("/frame", b""), ("/frame", b"{"), ("/frame", b"[" * 100000), ("/frame", b"[" * 500000 + b"]" * 500000),
                           ("/frame", {}), ("/frame", [1]),
                           ("/frame", {**WISH, "width": 0}), ("/frame", {**WISH, "width": 1e9}),
                           ("/frame", {**WISH, "renderer": "none"}), ("/frame", {**WISH, "accelerator": "none"}),
                           ("/frame", {**WISH, "samples": -1}), ("/frame", {**WISH, "curve": "x"}),
                           ("/frame", {**WISH, "exposure": 1e9}), ("/frame", camera(eye=[0, 0])),
                           ("/frame", camera(look=[0, 0, 0])), ("/frame", camera(eye=["a", 0, 0])),
                           ("/explain", {**WISH, "x": 80, "y": 0}), ("/explain", WISH)):
            status, _, answer = self.server.ask(path, body)
            self.assertEqual(status, 400, (path, body if len(str(body)) < 300 else "...", answer))
            self.assertTrue(json.loads(answer)["error"])
            self.assertNotIn("json.exception", json.loads(answer)["error"])
        self.assertEqual(self.server.ask("/frame", WISH)[0], 200)

    def test_values_of_the_wrong_type_are_named(self):
        for path, change, message in (
                ("/frame", {"renderer": 3}, "renderer must be a text, found 3"),
                ("/frame", {"png": "yes"}, 'png must be true or false, found "yes"'),
                ("/frame", {"exposure": None}, "exposure must be a number, found null"),
                ("/frame", {"samples": "2"}, 'samples must be a whole number from 1 to 1024, found "2"'),
                ("/frame", {"lights_off": "key"}, 'lights_off must be a list of texts, found "key"'),
                ("/frame", {"lights_off": [1]}, "lights_off must be a list of texts, found [1]"),
                ("/frame", {"lights": 1}, "lights must be a list of objects"),
                ("/frame", {"lights": [1]}, "expected an object, found 1"),
                ("/frame", {"lights": [{}]}, "name is missing"),
                ("/frame", {"lights": [{"name": "x", "sizes": 1}]}, "sizes must be a list of numbers, found 1"),
                ("/frame", {"camera": {**WISH["camera"], "eye": [0, "a", 0]}}, "eye must be a list of numbers"),
                ("/frame", {"camera": {**WISH["camera"], "up": [0, 1]}}, "up must be three numbers, found [0,1]"),
                ("/frame", {"camera": [1] * 100}, "expected an object, found [1,1"),
                ("/frame", {"camera": {**WISH["camera"], "of": -1}}, "of must be a whole number from 0"),
                ("/frame", {"camera": {**WISH["camera"], "aspect": 0}}, "the aspect of the camera must be above 0"),
                ("/frame", {"camera": {**WISH["camera"], "lens": 1}}, "expected an object, found 1"),
                ("/frame", {"camera": {**WISH["camera"], "lens": {"radius": -1}}}, "the lens must have a radius"),
                ("/frame", {"camera": {**WISH["camera"], "lens": {"focus_distance": 0}}}, "the lens must have a radius"),
                ("/frame", {"camera": {**WISH["camera"], "lens": {"blades": 2}}}, "no blades or 3 to 1000"),
                ("/frame", {"client": 7}, "client must be a text, found 7"),
                ("/explain", {"x": [], "y": 0}, "x must be a whole number from 0 to 79, found []"),
                ("/explain", {"x": 0}, "y is missing"), ("/stop", {"client": {}}, "client must be a text, found {}")):
            status, _, answer = self.server.ask(path, {**WISH, **change})
            self.assertEqual(status, 400, (path, change))
            self.assertIn(message, json.loads(answer)["error"])
        for body, message in ((b"{", "no JSON, from its byte"), (b'{"x":1e999}', "too large"), (b"[1]", "an object"), (b'"x"', "an object")):
            self.assertIn(message, json.loads(self.server.ask("/frame", body)[2])["error"])

    # ---- answers
    def test_frames_are_the_pictures_of_render(self):
        status, headers, body = self.server.ask("/frame", {**WISH, "png": True})
        self.assertEqual((status, headers["content-type"]), (200, "image/png"))
        self.assertEqual(body[:8], b"\x89PNG\r\n\x1a\n")
        facts = json.loads(headers["x-alhazen"])
        self.assertGreater(facts["rays"], 80 * 60)
        self.assertEqual(self.server.ask("/frame", {**WISH, "png": True})[2], body)
        self.assertEqual(self.server.ask("/frame", {**WISH, "png": True, "accelerator": "octree"})[2], body)
        self.assertNotEqual(self.server.ask("/frame", {**WISH, "png": True, "exposure": 1})[2], body)
        self.assertEqual(self.server.ask("/frame", WISH)[2][:2], b"\xff\xd8")

    def test_the_limit_of_threads_holds_where_pictures_are_encoded(self):
        server = Server(ALHAZEN, self.scene, "-t", "1")
        self.addCleanup(server.close)

        def threads():
            return len(os.listdir(f"/proc/{server.process.pid}/task"))
        self.assertEqual(server.ask("/frame", WISH)[0], 200)
        before = threads()
        large = {**WISH, "png": True, "renderer": "ray_casting", "width": 1024, "height": 768}
        self.assertEqual(server.ask("/frame", large)[0], 200)
        self.assertEqual(threads(), before)

    def test_frames_at_a_camera_of_the_scene_are_those_of_render(self):
        lens = " lens_radius = 0.3; focus_distance = 3; blades = 5; blade_turn_deg = 20 }"
        motion = " motion = [(0, translate(0.1, 0, 0)), (1, translate(0.7, 0, 0))] }"
        field = "fov_deg = 40"
        bare = "\n".join(line for line in SCENE.split("\n") if not line.startswith("point_light"))
        scene = self.scene.with_name("own.alhazen")
        for text in (SCENE.replace(field + " }", field + ";" + lens), SCENE.replace(field + " }", field + ";" + motion),
                     SCENE.replace(field, "fov_deg = 40; aspect = 1.7"), bare, bare.replace("0.1, 0.15, 0.3", "0, 0, 0"),
                     bare.replace('material "red" {', 'material "red" { emission = 2;'),
                     bare.replace("; background = (0.1, 0.15, 0.3)", "")):
            scene.write_text(text, encoding="utf-8")
            server = Server(ALHAZEN, scene)
            try:
                for renderer, camera in (("path_tracing", 0), ("distributed", 1), ("whitted", 1)):
                    wish = server.wish_at(camera, renderer=renderer, samples=4, png=True)
                    status, _, body = server.ask("/frame", wish)
                    self.assertEqual(status, 200, body)
                    own = rendered(ALHAZEN, scene, "--spp", "4", "--renderer", renderer, "--camera", str(camera))
                    self.assertTrue(png_pixels(body) == own, (text[:200], renderer))
                # A view elsewhere keeps the lens, and no motion; an added headlight goes with it.
                moved = {**wish, "renderer": "distributed", "camera": {**wish["camera"], "eye": [6, 1, 0.25]}}
                still = {**moved, "camera": {**moved["camera"], "of": 7}}
                self.assertTrue(server.ask("/frame", moved)[2] == server.ask("/frame", still)[2], text[:200])
            finally:
                server.close()

    def test_a_headlight_is_that_of_the_camera(self):
        scene = self.scene.with_name("bare.alhazen")
        front = 'perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }'
        bare = "\n".join(line for line in SCENE.split("\n") if not line.startswith("point_light"))
        self.assertIn(front, bare)
        scene.write_text(bare.replace(front, 'orthographic_camera "front" { eye = (0, 1, 6); look_at = (0, 0.9, 0); height = 4 }'),
                         encoding="utf-8")
        server = Server(ALHAZEN, scene)
        try:
            state = server.state()
            self.assertEqual(state["added_light"], {"name": "headlight", "follows_light": False})
            self.assertEqual(state["lights"][0]["what"], "directional light")
            self.assertNotIn("headlight", state["cameras"][0])
            light = state["cameras"][1]["headlight"]
            self.assertEqual((light["what"], light["position"]), ("point light", [6, 1, 0]))
            dim = [{"name": "headlight", "position": [6, 2, 0], "color": [0.1, 0.1, 0.1]}]
            plain, changed, off = (server.ask("/frame", server.wish_at(1, png=True, **change))
                                   for change in ({}, {"lights": dim}, {"lights_off": ["headlight"]}))
            self.assertEqual([a[0] for a in (plain, changed, off)], [200] * 3)
            self.assertEqual(len({a[2] for a in (plain, changed, off)}), 3)
            self.assertEqual(server.ask("/frame", server.wish_at(0, lights=dim))[0], 400)
            self.assertIn("position = (6, 2, 0)", server.ask("/blocks", {"lights": dim, "of": 1})[2].decode())
            self.assertEqual(server.ask("/blocks", {"lights": dim})[0], 400)
        finally:
            server.close()

    def test_an_accelerator_of_the_start_is_in_the_menu(self):
        server = Server(ALHAZEN, self.scene, "--bound", "sphere")
        try:
            state = server.state()
            self.assertEqual(state["accelerator"], "bounding_volumes:bound=sphere")
            self.assertEqual([a["name"] for a in state["accelerators"]][:2], [state["accelerator"], "wide_bvh"])
        finally:
            server.close()

    def test_the_policy_of_an_address_of_ipv6_is_the_page_itself(self):
        host = f"[::1]:{self.server.port}"
        _, headers, _ = self.server.ask("/", b"", "GET", Host=host, Origin=f"http://{host}")
        self.assertIn("connect-src 'self'", headers["content-security-policy"].split("; "))

    def test_an_explanation_has_the_tree_of_the_pixel(self):
        status, _, body = self.server.ask("/explain", {**WISH, "x": 40, "y": 30, "steps": "list"})
        self.assertEqual(status, 200)
        data = json.loads(body)
        self.assertEqual(data["tree"]["surfaces"][0]["object"], "ball")
        self.assertEqual((data["width"], data["traversal"]["accelerator"]), (80, "list"))

    def test_a_path_of_path_tracing_is_told_and_adds_up(self):
        scene = self.scene.with_name("path.alhazen")
        scene.write_text(LIGHTS, encoding="utf-8")
        server = Server(ALHAZEN, scene)
        steps, asked = set(), 0
        try:
            for y in range(2, 60, 7):
                for x in range(3, 80, 11):
                    wish = {**WISH, "renderer": "path_tracing", "x": x, "y": y, "steps": "list", "samples": 3, "sample": 2}
                    status, _, body = server.ask("/explain", wish)
                    self.assertEqual(status, 200, body)
                    data = json.loads(body)
                    path, at = data["path"]["vertices"], [0.0, 0.0, 0.0]
                    for i, v in enumerate(path):
                        steps.add(v["step"])
                        light = v.get("light")
                        asked += light is not None
                        for c in range(3):
                            at[c] += v["found"][c] + (light["arrived"][c] if light else 0)
                            if light:
                                self.assertLessEqual(light["arrived"][c], light["offered"][c] * (1 + 1e-12))
                        self.assertEqual(v["step"] in ("scattered", "mirrored", "straight"), i + 1 < len(path), (x, y, path))
                        if i > 0:  # each ray begins where the one before ends
                            before = path[i - 1]
                            for c in range(3):
                                end = before["origin"][c] + before["t"] * before["direction"][c]
                                self.assertAlmostEqual(v["origin"][c], end, delta=1e-9)
                    for c in range(3):
                        self.assertAlmostEqual(at[c], data["path"]["radiance"][c], delta=1e-12)
            self.assertLessEqual({"scattered", "mirrored", "escaped"}, steps)
            self.assertGreater(asked, 20)
            # Depth 0: the floor, and one ray that may hit a light. Other renderers have no such ray.
            one = {**WISH, "x": 40, "y": 55, "steps": "list", "renderer": "path_tracing"}
            self.assertLessEqual(len(json.loads(server.ask("/explain", {**one, "depth": 0})[2])["path"]["vertices"]), 2)
            for renderer in ("whitted", "bidirectional", "path_tracing:manifold=on", "path_tracing:polarization=on"):
                self.assertNotIn("path", json.loads(server.ask("/explain", {**one, "renderer": renderer})[2]))
        finally:
            server.close()

    def test_a_path_in_endless_fog_names_no_surface_that_it_does_not_meet(self):
        # The half space below the floor; the ball, the first part, is far from it.
        scene = self.scene.with_name("fog.alhazen")
        floor = "plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }"
        self.assertIn(floor, LIGHTS)
        scene.write_text(LIGHTS.replace(floor, "plane { normal = (0, 1, 0); material = { diffuse = 0; transmissive = 1; "
                                               "index = 1; scattering = 0.5 } }"), encoding="utf-8")
        server = Server(ALHAZEN, scene)
        in_fog = 0
        try:
            for x in range(3, 80, 7):
                wish = {**WISH, "renderer": "path_tracing", "x": x, "y": 57, "steps": "list"}
                status, _, body = server.ask("/explain", wish)
                self.assertEqual(status, 200, body)
                vertices = json.loads(body)["path"]["vertices"]
                for v in vertices:
                    self.assertEqual(v["t"] is not None, "in_volume" in v)
                    if v.get("in_volume") and v["origin"][1] < 1e-6 and v["direction"][1] < 0:  # down from the floor or below
                        in_fog += 1
                        self.assertFalse({"object", "material", "normal"} & set(v), v)
                    elif v["t"] is not None:
                        self.assertLessEqual({"object", "material", "normal"}, set(v), v)
                        self.assertNotEqual(v["normal"], [0, 0, 0])
            self.assertGreater(in_fog, 5)
        finally:
            server.close()

    def test_numbers_that_are_not_whole_or_out_of_range_are_refused(self):
        pixel = {**WISH, "x": 40, "y": 30, "steps": "list"}
        for key, most in (("samples", 1024), ("depth", 100), ("width", 4096), ("height", 4096)):
            for bad in (2**40, 2**32 + 1, -2**31 - 1, -1, most + 1, 3.9, 1e300):
                status, _, body = self.server.ask("/frame", {**WISH, key: bad})
                self.assertEqual(status, 400, (key, bad))
                self.assertIn(f"{key} must be a whole number from ", body.decode())
        for key in ("x", "y", "sample"):
            for bad in (2**40, 2**32, -2**32, 0.5, -1):
                status, _, body = self.server.ask("/explain", {**pixel, key: bad})
                self.assertEqual(status, 400, (key, bad))
                self.assertIn(f"{key} must be a whole number from 0 to ", body.decode())
        for bad in ("3", None, True, [3]):
            self.assertEqual(self.server.ask("/frame", {**WISH, "depth": bad})[0], 400, bad)
        self.assertEqual(self.server.ask("/frame", {**WISH, "depth": 3.0, "samples": 2})[0], 200)
        self.assertEqual(self.server.ask("/explain", {**pixel, "x": 40.0})[0], 200)

    def test_menus_are_those_of_the_program(self):
        state = self.server.state()
        listed = subprocess.run([ALHAZEN, "list", "accelerators"], capture_output=True, text=True).stdout
        for entry in state["accelerators"]:
            self.assertIn(f"  {entry['name']} ", listed)
        self.assertIn("whitted", [r["name"] for r in state["renderers"]])
        self.assertEqual([c["name"] for c in state["cameras"]], ["front", "side"])

    def test_renderers_that_follow_paths_heed_a_depth_that_is_wished(self):
        def png(renderer, **change):
            status, _, body = self.server.ask("/frame", {**WISH, "png": True, "renderer": renderer, **change})
            self.assertEqual(status, 200, body)
            return body

        followers = {r["name"]: r["depth"] for r in self.server.state()["renderers"] if "depth" in r}
        self.assertEqual(set(followers), {"path_tracing", "light_tracing", "bidirectional", "photon_mapping", "sppm", "vcm"})
        for renderer in ("path_tracing", "bidirectional"):
            usual = png(renderer)
            self.assertNotEqual(png(renderer, depth=0), usual)
            self.assertEqual(png(renderer, depth=0), png(f"{renderer}:depth=1"))
            # The page's defaults.
            self.assertEqual(png(renderer, depth=followers[renderer]), usual)

    def test_lights_are_turned_off_and_surroundings_chosen(self):
        scene = self.scene.with_name("lights.alhazen")
        scene.write_text(LIGHTS, encoding="utf-8")
        server = Server(ALHAZEN, scene)

        def png(renderer="whitted", **change):
            status, _, body = server.ask("/frame", {**WISH, "png": True, "renderer": renderer, **change})
            self.assertEqual(status, 200, body)
            return body

        try:
            state = server.state()
            names = [light["name"] for light in state["lights"]]
            self.assertEqual([(light["name"], light["what"]) for light in state["lights"]],
                             [("spot light 1", "spot light"), ("lamp", "area light"), ("key", "point light"),
                              ("ember", "material that emits")])
            # Each has a separate effect, also on path tracing renderers.
            for renderer in ("whitted", "distributed", "path_tracing"):
                pictures = {png(renderer)} | {png(renderer, lights_off=[name]) for name in names}
                self.assertEqual(len(pictures), 5, renderer)
                self.assertEqual(png(renderer, lights_off=names), png(renderer, lights_off=names[::-1]))
            self.assertEqual(png(lights_off=[]), png())
            dark = png("path_tracing", lights_off=names, environment="none")
            black = png("path_tracing", lights_off=names, environment="none", exposure=16)
            self.assertEqual(dark, black)
            # Environments: those of the table, and for renderers of light transport.
            listed = subprocess.run([ALHAZEN, "list", "environments"], capture_output=True, text=True).stdout
            self.assertEqual([e["name"] for e in state["environments"]], ["none", "sky", "studio"])
            for entry in state["environments"]:
                self.assertIn(f"  {entry['name']} ", listed)
            self.assertEqual(len({png("path_tracing", environment=e) for e in ("", "none", "sky", "studio")}), 4)
            self.assertEqual(png(environment="sky"), png())
            follow = {r["name"] for r in state["renderers"] if r["follows_light"]}
            self.assertTrue({"path_tracing", "ambient_occlusion"} & follow)
            self.assertNotIn("whitted", follow)
            # An explanation belongs to the shown picture.
            pixel = {**WISH, "x": 40, "y": 58, "steps": "list"}
            explained = json.loads(server.ask("/explain", {**pixel, "lights_off": names})[2])
            self.assertEqual((explained["pixel"], explained["rays"]["shadow"]), ([0, 0, 0], 0))
            self.assertGreater(json.loads(server.ask("/explain", pixel)[2])["pixel"][0], 0.1)
            # Missing items are reported.
            for change, text in (({"lights_off": ["moon"]}, "no light 'moon'; expected one of: spot light 1, lamp, key"),
                                 ({"environment": "sea"}, "no environment 'sea'; expected one of none, sky, studio"),
                                 ({"lights_off": 3}, "")):
                status, _, body = server.ask("/frame", {**WISH, **change})
                self.assertEqual(status, 400, body)
                self.assertIn(text, json.loads(body)["error"])
        finally:
            server.close()

    def test_lights_are_moved_and_coloured_and_told_as_blocks(self):
        scene = self.scene.with_name("changed.alhazen")
        scene.write_text(LIGHTS, encoding="utf-8")
        server = Server(ALHAZEN, scene)

        def png(*lights, renderer="whitted"):
            status, _, body = server.ask("/frame", {**WISH, "png": True, "renderer": renderer, "lights": lights})
            self.assertEqual(status, 200, body)
            return body

        try:
            lights = {light["name"]: light for light in server.state()["lights"]}
            key, spot = lights["key"], lights["spot light 1"]
            self.assertEqual((key["position"], key["color"], "direction" in key), ([3, 5, 4], [1, 1, 1], False))
            self.assertEqual((spot["position"], spot["direction"]), ([-3, 5, 4], [3, -5, -4]))
            self.assertEqual({k: v for k, v in lights["lamp"].items() if k not in ("name", "what")},
                             {"color": [2, 2, 1], "position": [1.5, 2.4, 0], "direction": [0, -1, 0],
                              "sizes": [{"name": "radius", "value": 0.4}, {"name": "inner radius", "value": 0}]})
            self.assertEqual(set(lights["ember"]), {"name", "what", "color"})
            changes = [{"name": "key", "position": [-3, 5, 4]}, {"name": "key", "color": [3, 0, 0]},
                       {"name": "spot light 1", "direction": [1, -5, -4]}, {"name": "lamp", "color": [9, 9, 9]},
                       {"name": "ember", "color": [0, 5, 0]}, {"name": "lamp", "position": [0, 3, 2]},
                       {"name": "lamp", "direction": [1, -1, 1]}, {"name": "lamp", "sizes": [0.8, 0.4]}]
            for renderer in ("whitted", "path_tracing"):
                self.assertEqual(len({png(renderer=renderer), *(png(c, renderer=renderer) for c in changes)}), 9)
            # The file's own values change nothing; a file with the same values gives the same picture.
            self.assertEqual(png({k: v for k, v in key.items() if k != "what"}, spot), png())
            as_it_is = {**lights["lamp"], "sizes": [size["value"] for size in lights["lamp"]["sizes"]]}
            self.assertEqual(png(as_it_is, renderer="path_tracing"), png(renderer="path_tracing"))
            status, _, body = server.ask("/blocks", {"lights": [changes[0]]})
            self.assertEqual(json.loads(body)["text"], 'point_light "key" { position = (-3, 5, 4) }\n')
            moved = png(changes[0])
            scene.write_text(LIGHTS.replace("position = (3, 5, 4)", "position = (-3, 5, 4)"), encoding="utf-8")
            server.wait_for(lambda state: state["version"] == 2)
            self.assertEqual(png(), moved)
            # A moved light is visible, hit and explained at its new position only.
            before, over = [0, 1, 3.5], {**WISH, "x": 40, "y": 30, "steps": "list"}
            there = {"name": "lamp", "position": before, "direction": [0, 0, 1], "sizes": [0.5, 0]}

            def first_object(*lights):
                return json.loads(server.ask("/explain", {**over, "lights": lights})[2])["tree"]["surfaces"][0]["object"]
            self.assertEqual((first_object(there), first_object()), ("lamp", "ball"))
            explained = json.loads(server.ask("/explain", {**WISH, "x": 40, "y": 58, "steps": "list",
                                                           "lights": [{"name": "key", "color": [0, 0, 0]}]})[2])
            self.assertNotIn("key", [light["light"] for light in explained["tree"]["surfaces"][0]["lights"]
                                     if any(light["intensity"])])
            for path in ("/frame", "/blocks"):
                for wrong in ({"name": "moon", "color": [1, 1, 1]}, {"name": "ember", "position": [0, 0, 0]}, {"name": "key", "color": [-1, 0, 0]},
                              {"name": "lamp", "sizes": [1]}, {"name": "lamp", "sizes": [1, 1]}, {"name": "lamp", "sizes": [0, 0]},
                              {"name": "lamp", "sizes": 1}, {"name": "key", "sizes": [1]}, {"name": "lamp", "sizes": [None, 0]},
                              {"name": "spot light 1", "direction": [0, 0, 0]}, {"name": "key", "position": [1, 2]},
                              {"name": "key", "color": [None, 0, 0]}, {"color": [1, 1, 1]}, "key"):
                    status, _, body = server.ask(path, {**WISH, "lights": [wrong]})
                    self.assertEqual(status, 400, (path, wrong, body))
        finally:
            server.close()

    def test_a_newer_frame_ends_an_older_one(self):
        long = {**WISH, "width": 2000, "height": 1500, "samples": 1024}
        status = self.server.in_hand("/frame", long)
        begin = time.monotonic()
        self.assertEqual(self.server.ask("/frame", WISH)[0], 200)
        self.assertLess(time.monotonic() - begin, 3)
        self.assertEqual(status(), 204)

    def test_frames_of_another_client_go_on(self):
        long = {**WISH, "width": 400, "height": 300, "samples": 16, "client": "a"}
        status = self.server.in_hand("/frame", long)
        self.assertEqual(self.server.ask("/frame", {**WISH, "client": "b"})[0], 200)
        self.assertEqual(status(), 200)

    def test_an_explanation_is_ended_by_a_newer_question_a_stop_and_the_end(self):
        scene = self.scene.with_name("deep.alhazen")
        scene.write_text(DEEP, encoding="utf-8")
        server = Server(ALHAZEN, scene)
        try:
            long = {**WISH, "x": 40, "y": 30, "samples": 1024, "depth": 100, "steps": "list"}
            for path in ("/frame", "/explain", "/stop"):
                status = server.in_hand("/explain", long)
                begin = time.monotonic()
                self.assertEqual(server.ask(path, {**WISH, "depth": 1, "x": 0, "y": 0})[0], 200)
                self.assertEqual(status(), 204, path)
                self.assertLess(time.monotonic() - begin, 5, path)
            server.in_hand("/explain", long)
            begin = time.monotonic()
        finally:
            server.close()
        self.assertLess(time.monotonic() - begin, 5)

    def test_the_tree_of_an_explanation_has_a_bound_and_says_so(self):
        scene = self.scene.with_name("deep.alhazen")
        scene.write_text(DEEP, encoding="utf-8")
        server = Server(ALHAZEN, scene)
        try:
            wish = {**WISH, "x": 40, "y": 30, "steps": "list"}
            status, _, body = server.ask("/explain", {**wish, "depth": 100})
            self.assertEqual(status, 200)
            data = json.loads(body)
            self.assertEqual(data["cut"], data["max_depth"])
            self.assertLess(data["cut"], 64)
            self.assertLessEqual(sum(data["rays"].values()), 10000)
            self.assertLess(len(body), 32 << 20)
            shallow = json.loads(server.ask("/explain", {**wish, "depth": data["cut"]})[2])
            self.assertEqual((shallow["cut"], shallow["pixel"]), (False, data["pixel"]))
        finally:
            server.close()

    def test_the_state_does_not_wait_for_a_frame(self):
        long = {**WISH, "width": 2000, "height": 1500, "samples": 1024}
        status = self.server.in_hand("/frame", long)
        for _ in range(5):
            begin = time.monotonic()
            self.server.state()
            self.assertLess(time.monotonic() - begin, 1)
        self.assertEqual(self.server.ask("/stop", {})[0], 200)
        self.assertEqual(status(), 204)

    def test_names_of_cameras_do_not_matter(self):
        scene = self.scene.with_name("numbered.alhazen")
        scene.write_text(SCENE.replace('"front"', '"2"').replace('"side"', '"0"'), encoding="utf-8")
        server = Server(ALHAZEN, scene)
        try:
            wish = {**WISH, "png": True}
            self.assertEqual(server.ask("/frame", wish)[2], self.server.ask("/frame", wish)[2])
            pixel = {**WISH, "x": 40, "y": 30, "steps": "list"}
            here, there = (json.loads(s.ask("/explain", pixel)[2]) for s in (server, self.server))
            self.assertEqual(here["tree"], there["tree"])
        finally:
            server.close()

    def test_every_layer_of_the_table_is_a_picture_with_its_scale(self):
        state = self.server.state()
        listed = subprocess.run([ALHAZEN, "list", "layers"], capture_output=True, text=True).stdout
        self.assertGreater(len(state["layers"]), 20)
        pictures = set()
        for entry in state["layers"]:
            self.assertIn(f"  {entry['name']} ", listed)
            status, headers, body = self.server.ask("/frame", {**WISH, "layer": entry["name"], "png": True})
            self.assertEqual(status, 200, body)
            layer = json.loads(headers["x-alhazen"])["layer"]
            self.assertEqual(layer["name"], entry["name"])
            self.assertEqual(struct.unpack(">II", body[16:24]), (80, 60), "the scale is not in the picture")
            if "colors" in layer:
                self.assertIn(layer["colors"], state["scales"])
                self.assertLessEqual(layer["low"], layer["high"])
            pictures.add(body)
        self.assertGreater(len(pictures), 10)
        layer = json.loads(self.server.ask("/frame", {**WISH, "layer": "depth"})[1]["x-alhazen"])["layer"]
        self.assertAlmostEqual(layer["low"], 2.9056, delta=0.001)  # to the floor at the lower edge
        self.assertLess(layer["high"], 50, "the horizon leaves no greys for the rest")
        status, _, body = self.server.ask("/frame", {**WISH, "layer": "none"})
        self.assertEqual(status, 400)
        self.assertIn("expected one of alpha, depth", json.loads(body)["error"])

    # ---- opening the browser
    def test_the_key_is_not_in_the_arguments_of_the_browser(self):
        folder = pathlib.Path(self.temporary.name) / "bin"
        folder.mkdir()
        seen = folder / "seen"
        opener = folder / "xdg-open"
        opener.write_text("#!/bin/sh\n{ echo \"$@\"; stat -c %a \"$1\" \"$(dirname \"$1\")\"; cat \"$1\"; } "
                          f"> {seen}.part\nmv {seen}.part {seen}\n", encoding="utf-8")
        opener.chmod(0o755)
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "XDG_RUNTIME_DIR": str(folder)}
        server = Server(ALHAZEN, self.scene, open_page=True, environment=environment)
        try:
            begin = time.monotonic()
            while not seen.exists():
                self.assertLess(time.monotonic() - begin, 20)
                time.sleep(0.05)
            arguments, *modes, page = seen.read_text(encoding="utf-8").split("\n", 3)
            self.assertNotIn(server.token, arguments)
            self.assertEqual(modes, ["600", "700"])
            self.assertIn(f"url=http://{server.host}/#{server.token}", page)
            path = pathlib.Path(arguments)
            self.assertEqual(server.ask("/state", {}, Authorization="Bearer x")[0], 401)
            self.assertTrue(path.exists(), "nobody had the key")
            server.state()
            self.assertFalse(path.parent.exists(), "the file is there after its use")
        finally:
            server.close()

    def test_no_signal_leaves_the_file_of_the_key(self):
        folder = pathlib.Path(self.temporary.name) / "runtime"
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            folder.mkdir()
            environment = {**os.environ, "PATH": "/nowhere", "XDG_RUNTIME_DIR": str(folder)}
            server = Server(ALHAZEN, self.scene, open_page=True, environment=environment)
            begin = time.monotonic()
            while not list(folder.glob("alhazen-*/view.html")):
                self.assertLess(time.monotonic() - begin, 20)
                time.sleep(0.05)
            server.process.send_signal(number)
            self.assertEqual(server.process.wait(20), 0, number)
            server.close()
            self.assertEqual(list(folder.iterdir()), [], number)
            folder.rmdir()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
