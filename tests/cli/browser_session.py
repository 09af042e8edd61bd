"""A browser controlled by tests: Chromium by its DevTools protocol, over WebSockets (RFC 6455)."""

import base64
import json
import os
import re
import shutil
import socket
import struct
import subprocess
import tempfile
import time

# Factor of time limits, for example under a sanitizer.
SLOWDOWN = float(os.environ.get("ALHAZEN_TEST_SLOWDOWN", "1"))


def browser():
    for name in ("chromium", "chromium-browser", "google-chrome"):
        if shutil.which(name):
            return shutil.which(name)
    return None


class Connection:
    """A WebSocket of the DevTools protocol."""

    def __init__(self, port, path):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n"
                             "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        self.stream = self.socket.makefile("rb")
        while self.stream.readline() != b"\r\n":
            pass
        self.last = 0

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        size = len(data)
        head = bytes([0x81, 0x80 | size]) if size < 126 else struct.pack(">BBH", 0x81, 0xFE, size) if size < 65536 \
            else struct.pack(">BBQ", 0x81, 0xFF, size)
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def receive(self):
        text = b""
        while True:
            first, size = self.stream.read(2)
            if size == 126:
                size, = struct.unpack(">H", self.stream.read(2))
            elif size == 127:
                size, = struct.unpack(">Q", self.stream.read(8))
            text += self.stream.read(size)
            if first & 0x80:
                return json.loads(text)

    def call(self, method, **parameters):
        self.last += 1
        self.send(json.dumps({"id": self.last, "method": method, "params": parameters}))
        while True:
            message = self.receive()
            if message.get("id") == self.last:
                assert "error" not in message, message
                return message["result"]
            self.note(message)

    def note(self, message):
        """Takes a message that answers no call."""

    def close(self):
        self.stream.close()
        self.socket.close()


class Browser(Connection):
    """A process for the pages of all tests of a program: starting one takes more processor time than most of these tests."""

    def __init__(self, *options):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # A file, since nobody reads what the browser says later.
        self.said = open(os.path.join(self.folder.name, "stderr"), "w+", encoding="utf-8", errors="replace")
        self.process = subprocess.Popen(
            [browser(), "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-extensions",
             "--remote-debugging-port=0", f"--user-data-dir={self.folder.name}", *options, "about:blank"],
            stderr=self.said)
        begin = time.monotonic()
        while not (match := re.search(r"ws://127\.0\.0\.1:(\d+)(/\S+)\n", self.text())):
            assert self.process.poll() is None and time.monotonic() - begin < 60 * SLOWDOWN, self.text()
            time.sleep(0.02)
        self.port = int(match.group(1))
        super().__init__(self.port, match.group(2))

    def text(self):
        """What the browser has said."""
        with open(self.said.name, encoding="utf-8", errors="replace") as file:
            return file.read()

    def open(self, width, height):
        return Page(self, width, height)

    def close(self):
        super().close()
        self.process.terminate()
        self.process.wait(20)
        self.said.close()
        self.folder.cleanup()


class Page(Connection):
    """A new tab in a window of this size. `console`: its messages; `requests`: the addresses that it requested. Pages share
    what a browser keeps for an address; each server has an address of its own."""

    def __init__(self, owner, width, height):
        self.owner = owner
        self.target = owner.call("Target.createTarget", url="about:blank")["targetId"]
        window = owner.call("Browser.getWindowForTarget", targetId=self.target)["windowId"]
        owner.call("Browser.setWindowBounds", windowId=window, bounds={"width": width, "height": height})
        super().__init__(owner.port, f"/devtools/page/{self.target}")
        self.console, self.requests = [], []
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def note(self, message):
        parameters = message.get("params", {})
        if message.get("method") == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])
        elif message.get("method") == "Network.webSocketCreated":
            self.requests.append(parameters["url"])
        elif message.get("method") == "Log.entryAdded":
            self.console.append(parameters["entry"]["text"])
        elif message.get("method") == "Runtime.consoleAPICalled":
            self.console.append(json.dumps(parameters["args"])[:500])
        elif message.get("method") == "Runtime.exceptionThrown":
            self.console.append(json.dumps(parameters["exceptionDetails"])[:500])

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def wait(self, expression, seconds=20):
        """Waits until the expression is true; returns the seconds that took."""
        seconds *= SLOWDOWN
        begin = time.monotonic()
        while not self.value(expression):
            assert time.monotonic() - begin < seconds, f"not true in {seconds} s: {expression}"
            time.sleep(0.02)
        return time.monotonic() - begin

    def mouse(self, kind, x, y, buttons=0):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1)

    def key(self, key, modifiers=0):
        # These keys act on a focused field only if the event has their text.
        text = {"Enter": {"text": "\r", "windowsVirtualKeyCode": 13}, " ": {"text": " ", "windowsVirtualKeyCode": 32},
                "Tab": {"windowsVirtualKeyCode": 9}}.get(key, {})
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers, **text)

    def screenshot(self, path):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        super().close()
        self.owner.call("Target.closeTarget", targetId=self.target)


class FilePages:
    """For tests of files that are pages: a browser without any host."""

    @classmethod
    def open_browser(cls):
        cls.browser = Browser("--host-resolver-rules=MAP * ~NOTFOUND") if browser() else None
        if cls.browser:
            cls.addClassCleanup(cls.browser.close)

    def used(self, path, width, height, dark=False, screenshots=()):
        """Opens a page whose own script uses it and leaves what it saw, as JSON, in the element `seen`. Returns that, the
        console's messages, and the addresses that it requested beside its own. `screenshots`: of which pages, and where."""
        if self.browser is None:
            self.skipTest("no chromium here: scripts/setup --browser installs it")
        page = self.browser.open(width, height)
        self.addCleanup(page.close)
        if dark:
            page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        page.call("Page.navigate", url=path.as_uri())
        page.wait("document.getElementById('seen') !== null", 60)
        seen = json.loads(page.value("document.getElementById('seen').textContent"))
        time.sleep(0.2)  # for requests made last
        page.value("0")  # takes the messages that have come
        requests = [url for url in page.requests if url != path.as_uri() and not url.startswith(("data:", "blob:"))]
        found = seen, list(page.console), requests
        for shown, picture in screenshots:
            page.call("Page.navigate", url=shown.as_uri())
            page.wait("document.readyState === 'complete'")
            page.screenshot(picture)
        return found
