"""A running `alhazen view`, for its tests."""

import base64
import json
import os
import pathlib
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zlib

# Factor of time limits, for example under a sanitizer.
SLOWDOWN = float(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))

SCENE = """alhazen 1
picture { width = 160; height = 120; background = (0.1, 0.15, 0.3) }
conventions { max_depth = 4 }
perspective_camera "front" { eye = (0, 1, 6); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }
perspective_camera "side" { eye = (6, 1, 0); look_at = (0, 0.9, 0); up = (0, 1, 0); fov_deg = 40 }
point_light "key" { position = (3, 5, 4); color = (1, 1, 1) }
material "mirror" { diffuse = 0.1; reflective = 0.8 }
material "red" { diffuse = (0.8, 0.1, 0.1) }
sphere "ball" { center = (0, 1, 0); radius = 1; material = "mirror" }
box "block" { lo = (-2, 0, 0); hi = (-1.2, 0.8, 0.8); material = "red" }
plane { normal = (0, 1, 0); material = { diffuse = (0.7, 0.6, 0.5) } }
"""

# A named light, an unnamed one, a visible area light, and an emitting surface.
LIGHTS = SCENE.replace('point_light "key"', '''
spot_light { position = (-3, 5, 4); direction = (3, -5, -4); color = (0.4, 0.4, 0.5) }
disc_light "lamp" { center = (1.5, 2.4, 0); normal = (0, -1, 0); radius = 0.4; radiance = (2, 2, 1) }
material "ember" { diffuse = 0.2; emission = (0.9, 0.3, 0.05) }
sphere { center = (1.4, 0.3, 1); radius = 0.3; material = "ember" }
point_light "key"''')

WISH = {"width": 80, "height": 60, "renderer": "whitted", "accelerator": "wide_bvh",
        "camera": {"eye": [0, 1, 6], "look": [0, 0, -1], "right": [0.9, 0, 0], "up": [0, 0.7, 0]}}

# Every ray splits at every surface: 2^100 rays.
DEEP = SCENE.replace("max_depth = 4", "max_depth = 4; min_contribution = 0") + '''
material "glass" { transmissive = 0.9; reflective = 0.5; index = 1.3 }
''' + "".join(f'sphere {{ center = (0, 1, 0); radius = {1.2 + 0.2 * i}; material = "glass" }}\n' for i in range(8))


def png_pixels(data):
    """Width, height and the bytes of red, green and blue of a PNG of 8 bits without alpha or palette."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:20]
    at, packed, channels = 8, b"", 3
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", body[:10])
            assert (bits, color) in ((8, 0), (8, 2)), (bits, color)
            channels = 3 if color == 2 else 1
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, stride = zlib.decompress(packed), channels * width
    rows, above = [], bytes(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride if kind else 0):
            left, up = line[i - channels] if i >= channels else 0, above[i]
            corner = above[i - channels] if i >= channels else 0
            if kind == 4:
                p = left + up - corner
                guess = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            line[i] = (line[i] + guess) & 255
        above = bytes(line)
        rows.append(above if channels == 3 else bytes(c for c in above for _ in range(3)))
    return width, height, b"".join(rows)


def rendered(alhazen, scene, *options):
    """Width, height and pixels of the picture of `alhazen render`."""
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.png"
        subprocess.run([alhazen, "render", str(scene), "-o", str(picture), "-q", *options], check=True,
                       timeout=120 * SLOWDOWN)
        return png_pixels(picture.read_bytes())


class Server:
    """Starts the server of a scene, and sends it requests like a page's, or malformed ones."""

    def __init__(self, alhazen, scene, *options, open_page=False, environment=None):
        command = [alhazen, "view", str(scene), *([] if open_page else ["--no-open"]), *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
        self.url = self.process.stdout.readline().strip()
        match = re.fullmatch(r"http://([^/]+):(\d+)/#([0-9a-f]{32})", self.url)
        if match is None:
            raise RuntimeError(f"{self.url!r}: {self.process.stderr.read()}")
        self.address, self.port, self.token = match.group(1), int(match.group(2)), match.group(3)
        self.host = f"{self.address}:{self.port}"

    def close(self):
        """Ends the server; fails if it ended before with an unexpected status or signal, such as a sanitizer's."""
        status = self.process.poll()
        self.process.terminate()
        self.process.wait(10 * SLOWDOWN)
        said = self.process.stderr.read()
        self.process.stdout.close()
        self.process.stderr.close()
        if status not in (None, 0, 3, 75, -signal.SIGKILL):
            raise RuntimeError(f"the server had ended with {status}: {said}")

    def connect(self):
        return socket.create_connection((self.address.strip("[]"), self.port), timeout=20 * SLOWDOWN)

    def connect_slowly(self, count):
        """Sockets with incomplete requests."""
        sockets = []
        for _ in range(count):
            s = self.connect()
            try:
                s.sendall(b"POST /state HTTP/1.1\r\nHost: ")
            except OSError:
                pass  # refused at once
            sockets.append(s)
        return sockets

    def raw(self, data):
        """Sends bytes; returns the whole answer."""
        with self.connect() as s:
            try:
                s.sendall(data)
                s.shutdown(socket.SHUT_WR)
            except OSError:
                pass  # refused before all was sent
            answer = b""
            try:
                while part := s.recv(65536):
                    answer += part
            except ConnectionResetError:
                pass
            return answer

    def ask(self, path, body=None, method="POST", **change):
        """Status, headers and body of an answer; `change` replaces headers, None omits one."""
        data = b"" if body is None else body if isinstance(body, bytes) else json.dumps(body).encode()
        headers = {"Host": self.host, "Origin": f"http://{self.host}", "Authorization": f"Bearer {self.token}",
                   "Content-Length": str(len(data)), "Connection": "close"}
        headers.update({k.replace("_", "-"): v for k, v in change.items()})
        text = f"{method} {path} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in headers.items() if v is not None)
        answer = self.raw(text.encode() + b"\r\n" + data)
        head, _, rest = answer.partition(b"\r\n\r\n")
        lines = head.decode("latin-1").split("\r\n")
        status = int(lines[0].split()[1]) if lines[0] else 0
        return status, {k.lower(): v for k, v in (line.split(": ", 1) for line in lines[1:])}, rest

    def wait_for(self, holds, seconds=20):
        """The first state of which `holds` is true."""
        begin = time.monotonic()
        while not holds(state := self.state()):
            assert time.monotonic() - begin < seconds * SLOWDOWN, state
            time.sleep(0.05)
        return state

    def in_hand(self, path, wish):
        """Sends a request in another thread; returns a function that waits for the status."""
        results = []
        thread = threading.Thread(target=lambda: results.append(self.ask(path, wish)[0]))
        thread.start()
        time.sleep(0.5)

        def status():
            thread.join(30 * SLOWDOWN)
            return results[0]
        return status

    def moment(self):
        """The current state, also without a scene."""
        status, _, body = self.ask("/state", {})
        assert status == 200, body
        return json.loads(body)

    def state(self):
        """The state after a scene is loaded."""
        begin = time.monotonic()
        while not (state := self.moment())["version"]:
            assert time.monotonic() - begin < 60 * SLOWDOWN, state
            time.sleep(0.02)
        return state

    def wish_at(self, camera, **change):
        """The request of a page at a camera of the scene, for its whole picture."""
        own = self.state()["cameras"][camera]
        keys = ("eye", "look", "right", "up", "parallel", "aspect", "lens")
        return {**WISH, "width": own["width"], "height": own["height"],
                "camera": {**{key: own[key] for key in keys if key in own}, "of": camera}, **change}

    def frames(self, **change):
        return FrameSocket(self, change)

    def open_frames(self):
        """A socket whose client has the token."""
        frames = self.frames()
        assert frames.status == 101, frames.status
        frames.send({"token": self.token})
        return frames


class FrameSocket:
    """A WebSocket client without a library, so that it can violate the protocol. `status` is that of the upgrade."""

    def __init__(self, server, change):
        headers = {"Host": server.host, "Origin": f"http://{server.host}", "Upgrade": "websocket", "Connection": "Upgrade",
                   "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(), "Sec-WebSocket-Version": "13", **change}
        self.socket = server.connect()
        self.socket.sendall(("GET /frames HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in headers.items() if v is not None)
                             + "\r\n").encode())
        self.stream = self.socket.makefile("rb")
        self.status = int(self.stream.readline().split()[1])
        while self.stream.readline() not in (b"\r\n", b""):
            pass

    def send(self, data, opcode=1, last=True, masked=True):
        data = data if isinstance(data, bytes) else json.dumps(data).encode()
        size, mask, bit = len(data), os.urandom(4), 0x80 if masked else 0
        head = bytes([opcode | (0x80 if last else 0)]) + (
            bytes([bit | size]) if size < 126 else struct.pack(">BH", bit | 126, size) if size < 65536
            else struct.pack(">BQ", bit | 127, size))
        if masked:
            key = (mask * (size // 4 + 1))[:size]
            data = mask + (int.from_bytes(data, "big") ^ int.from_bytes(key, "big")).to_bytes(size, "big")
        try:
            self.socket.sendall(head + data)
        except OSError:
            pass  # refused before all was sent

    def receive(self):
        """Opcode and body of a message; 8 and the code of a close, 0 of a lost connection."""
        try:
            first, size = self.stream.read(2)
            if size >= 126:
                size = int.from_bytes(self.stream.read(2 if size == 126 else 8), "big")
            body = self.stream.read(size)
        except (ValueError, OSError):
            return 8, 0
        return (8, int.from_bytes(body[:2], "big")) if first & 15 == 8 else (first & 15, body)

    def message(self):
        """The next message; pings are answered."""
        while (message := self.receive())[0] == 9:
            self.send(message[1], 10)
        return message

    def end(self):
        """The code of the next close."""
        while (message := self.message())[0] != 8:
            pass
        return message[1]

    def state(self):
        """The next state; pictures before it are dropped."""
        while (message := self.message())[0] != 1:
            assert message[0] == 2, message
        return json.loads(message[1])

    def picture(self):
        """Head and body of the next picture; states before it are dropped."""
        while (message := self.message())[0] != 2:
            assert message[0] == 1, message
        data = message[1]
        size, = struct.unpack("<I", data[:4])
        return json.loads(data[4:4 + size]), data[4 + size:]

    def listen(self, seconds):
        """The messages within a duration; the server sends one each second."""
        begin, messages = time.monotonic(), []
        while time.monotonic() - begin < seconds and (not messages or messages[-1][0] != 8):
            messages.append(self.message())
        return messages

    def close(self):
        self.stream.close()
        self.socket.close()


class ServerTest(unittest.TestCase):
    """Tests of one server of `SCENE`; the program is the first argument."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.scene = pathlib.Path(cls.temporary.name) / "scene.alhazen"
        cls.scene.write_text(SCENE, encoding="utf-8")
        cls.server = Server(sys.argv[1], cls.scene)

    @classmethod
    def tearDownClass(cls):
        cls.server.close()
        cls.temporary.cleanup()

    def socket_of(self, **change):
        frames = self.server.frames(**change)
        self.addCleanup(frames.close)
        return frames

    def open(self):
        frames = self.server.open_frames()
        self.addCleanup(frames.close)
        return frames
