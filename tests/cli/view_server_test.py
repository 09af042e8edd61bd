#!/usr/bin/env python3
"""`alhazen view`: addresses, authorisation, refused requests.

Usage: view_server_test.py ALHAZEN
"""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import time
import unittest

from view_server import WISH, Server, ServerTest

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

    def test_the_policy_of_an_address_of_ipv6_is_the_page_itself(self):
        host = f"[::1]:{self.server.port}"
        _, headers, _ = self.server.ask("/", b"", "GET", Host=host, Origin=f"http://{host}")
        self.assertIn("connect-src 'self'", headers["content-security-policy"].split("; "))

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
