#!/usr/bin/env python3
"""The WebSocket of `alhazen view`: authorisation, refused messages, and the order of its messages.

Usage: view_socket_test.py ALHAZEN
"""

import collections
import itertools
import json
import random
import statistics
import sys
import threading
import time
import unittest

from view_server import SCENE, SLOWDOWN, WISH, Server, ServerTest

ALHAZEN = sys.argv[1]
# A scene that takes minutes to render.
LONG = {**WISH, "width": 2000, "height": 1500, "samples": 1024, "raw": True}


def spoiled(data, chance):
    """The bytes with some of them changed, removed or doubled."""
    data = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 8))):
        i = chance.randrange(len(data))
        how = chance.randrange(5)
        if how == 0:
            data[i] ^= 1 << chance.randrange(8)
        elif how == 1:
            del data[i:i + chance.randrange(1, 20)]
        elif how == 2:
            data[i:i] = data[i:i + chance.randrange(1, 40)]
        elif how == 3:
            data[i:i] = chance.choice((b"-1", b"1e999", b"NaN", b"null", b"[[[[", b"{", b"\xff", b"\0", b"\r\n\r\n", b"1" * 20))
        else:
            del data[i:]
        if not data:
            return b"x"
    return bytes(data)


class ViewSocket(ServerTest):
    # ---- authorisation and refused messages
    def test_a_socket_is_for_the_page_of_this_server(self):
        for origin in (None, "null", "http://evil.com", f"https://{self.server.host}"):
            frames = self.socket_of(Origin=origin)
            self.assertEqual(frames.status, 403, origin)
            frames.close()
        self.assertEqual(self.socket_of(Host="evil.com", Origin="http://evil.com").status, 403)

    def test_a_socket_needs_the_token_first(self):
        for first in ({"token": "0" * 32}, {"token": 1}, {**WISH, "id": 1}, [], b"{"):
            frames = self.socket_of()
            self.assertEqual(frames.status, 101)
            frames.send(first)
            self.assertEqual(frames.end(), 1008, first)
            frames.close()  # the server has eight clients at most, and waits for the end of each

    def test_before_the_token_a_socket_takes_little(self):
        frames = self.socket_of()
        frames.send(b'{"token": "' + b"0" * 2000 + b'"}')
        self.assertIn(frames.end(), (1009, 0))

    def test_a_socket_refuses_what_breaks_the_protocol(self):
        for send, codes in ((lambda f: f.send(WISH, masked=False), (1002, 0)), (lambda f: f.send(b"x" * (1 << 20 | 1)), (1009, 0)),
                            (lambda f: f.send(b"x", 3), (1002, 0)), (lambda f: f.send(b"{"), (1007,)),
                            (lambda f: f.send(b"\xff\xff"), (1007, 0)), (lambda f: f.send(b"x", 0), (1002, 0))):
            frames = self.open()
            send(frames)
            self.assertIn(frames.end(), codes)
            frames.close()
        self.assertEqual(self.server.ask("/state", {})[0], 200)

    def test_a_page_has_its_pictures_while_two_hundred_slow_clients_come(self):
        frames, ids = self.open(), itertools.count()

        def seconds():
            frame, begin = next(ids), time.monotonic()
            frames.send({**WISH, "id": frame, "moving": True})
            frames.picture()
            spent = time.monotonic() - begin
            frames.send({"shown": frame})
            return spent

        alone, memory, sockets = [seconds() for _ in range(9)], self.server.state()["memory"], []

        def come():
            sockets.extend(self.server.connect_slowly(200))

        slow = threading.Thread(target=come)
        slow.start()
        beside = []
        while slow.is_alive() or len(beside) < 9:
            beside.append(seconds())
        slow.join()
        for s in sockets:
            s.close()
        self.assertEqual(len(sockets), 200)
        self.assertLess(statistics.median(beside) - statistics.median(alone), 0.1 * SLOWDOWN)
        self.wait_for_a_place()
        self.server.wait_for(lambda state: state["memory"] - memory < 32 << 20)

    def wait_for_a_place(self):
        """Waits until a connection is accepted again."""
        begin = time.monotonic()
        while self.server.ask("/state", {})[0] != 200:
            self.assertLess(time.monotonic() - begin, 9 * SLOWDOWN)
            time.sleep(0.1)

    def test_random_requests_and_messages_end_nothing(self):
        chance = random.Random(25)
        wish = json.dumps({**WISH, "id": 1, "lights": [{"name": "key", "position": [1, 2, 3]}]}).encode()

        def request(body):
            return (f"POST /frame HTTP/1.1\r\nHost: {self.server.host}\r\nOrigin: http://{self.server.host}\r\n"
                    f"Authorization: Bearer {self.server.token}\r\nContent-Length: {len(body)}\r\n"
                    "Connection: close\r\n\r\n").encode() + body

        memory = self.server.state()["memory"]
        all_over = [spoiled(request(wish), chance) for _ in range(400)]
        bodies = [request(spoiled(wish, chance)) for _ in range(400)]
        answers = collections.Counter(self.server.raw(data)[9:12] for data in all_over + bodies)
        self.assertLessEqual(set(answers), {b"", *(str(n).encode() for n in (200, 204, 400, 401, 403, 404, 405, 408, 413, 431, 501))})
        self.assertGreater(answers[b"200"], 0)
        self.assertGreater(answers[b"400"], 0)
        self.wait_for_a_place()
        for _ in range(60):
            frames = self.open()
            for _ in range(4):
                frames.send(spoiled(wish, chance), chance.choice((0, 1, 1, 1, 1, 2, 3, 8, 9, 10)), chance.random() < 0.9,
                            chance.random() < 0.95)
            frames.close()
            self.wait_for_a_place()
        self.server.wait_for(lambda state: not state["work"] and state["memory"] - memory < 32 << 20)
        frames = self.open()
        frames.send({**WISH, "id": 7})
        self.assertEqual(frames.picture()[0]["status"], 200)

    # ---- pictures
    def test_a_socket_takes_fragments_and_sends_pixels(self):
        frames = self.open()
        text = json.dumps({**WISH, "id": 7, "raw": True}).encode()
        frames.send(text[:50], 1, last=False)
        frames.send(text[50:], 0)
        head, body = frames.picture()
        self.assertEqual((head["id"], head["status"]), (7, 200))
        self.assertEqual(len(body), 4 * head["facts"]["width"] * head["facts"]["height"])
        self.assertEqual(body[3::4], b"\xff" * (80 * 60))

    def test_of_many_wishes_the_newest_is_shown_and_none_waits(self):
        frames = self.open()
        for i in range(200):
            frames.send({**WISH, "id": i, "raw": True, "moving": True})
        ids = []
        while not ids or ids[-1] < 199:
            ids.append(frames.picture()[0]["id"])
            frames.send({"shown": ids[-1]})
        self.assertEqual(ids, sorted(ids))
        self.assertLess(len(ids), 200)

    def test_a_stop_ends_the_running_request_and_the_pending_one(self):
        frames, other = self.open(), self.open()
        for wish in ({**LONG, "id": 1, "client": "me", "moving": True}, {**LONG, "id": 2, "client": "me", "moving": True}):
            frames.send(wish)
        other.send({**LONG, "id": 3, "client": "you"})
        for client in ("me", "you"):
            while not any(w.get("client") == client for w in frames.state()["work"]):
                pass
        frames.send({"stop": True, "client": "me"})
        head, _ = frames.picture()
        self.assertEqual((head["id"], head["status"]), (1, 204))
        frames.send({"shown": 1})
        clients = [w.get("client") for _, body in frames.listen(1.5)[-1:] for w in json.loads(body)["work"]]
        self.assertEqual(clients, ["you"])
        other.send({"stop": True, "client": "you"})
        self.assertEqual(other.picture()[0]["status"], 204)
        for bad in ({"stop": 1}, {"stop": "x"}):
            frames = self.open()
            frames.send(bad)
            self.assertEqual(frames.end(), 1007)

    def test_a_slow_client_has_one_picture_on_its_way(self):
        frames = self.open()
        for i in range(3):
            frames.send({**WISH, "id": i, "raw": True, "moving": True})
            time.sleep(0.3)
        self.assertEqual(frames.picture()[0]["id"], 0)
        frames.send({"shown": 0})
        self.assertEqual(frames.picture()[0]["id"], 2)

    def test_a_frame_is_ended_within_100_ms_of_a_newer_wish(self):
        frames = self.open()
        alone, after, most = [], [], 0.1 * SLOWDOWN
        # On a busy machine one success of twenty suffices.
        for i in range(20):
            if after and min(after) - min(alone) < most:
                break
            begin = time.monotonic()
            frames.send({**WISH, "id": 2 * i, "raw": True})
            self.assertEqual(frames.picture()[0]["id"], 2 * i)
            alone.append(time.monotonic() - begin)
            frames.send({"shown": 2 * i})
            frames.send({**LONG, "id": 1000})
            time.sleep(0.3)
            begin = time.monotonic()
            frames.send({**WISH, "id": 2 * i + 1, "raw": True})
            # The cancelled request reports it, or the newer one's answer replaced its own.
            while (head := frames.picture()[0])["id"] == 1000:
                self.assertEqual(head["status"], 204)
                frames.send({"shown": 1000})
            self.assertEqual((head["id"], head["status"]), (2 * i + 1, 200))
            after.append(time.monotonic() - begin)
            frames.send({"shown": 2 * i + 1})
        self.assertLess(min(after) - min(alone), most, after)

    def test_who_does_not_read_holds_little_memory(self):
        frames = self.open()
        wish = {**WISH, "width": 640, "height": 480, "raw": True, "moving": True}  # 1.2 MB
        # Every thread of the server has rendered: the system's allocator has its caches.
        for i in range(50):
            frames.send({**wish, "id": i})
            frames.picture()
            frames.send({"shown": i})
        before = self.server.state()["memory"]
        for i in range(50, 150):
            frames.send({**wish, "id": i})
            frames.send({"shown": i - 1})  # a lie
            time.sleep(0.03)
        self.assertLess(self.server.state()["memory"] - before, 32 << 20)
        ids = [frames.picture()[0]["id"]]
        while ids[-1] != 149:
            frames.send({"shown": ids[-1]})
            ids.append(frames.picture()[0]["id"])
        self.assertLess(len(ids), 50)

    def test_frames_one_after_another_take_the_memory_of_one(self):
        if SLOWDOWN > 1:
            self.skipTest("sanitizers keep what is freed")
        # A new server: none of its threads has rendered.
        server = Server(ALHAZEN, self.scene)
        self.addCleanup(server.close)
        before = server.state()["memory"]
        frames = server.open_frames()
        self.addCleanup(frames.close)
        for i in range(60):
            frames.send({**WISH, "id": i, "width": 640, "height": 480, "raw": True, "moving": True})
            frames.picture()
            frames.send({"shown": i})
        self.assertLess(server.state()["memory"] - before, 48 << 20)

    def test_eight_clients_have_their_frames_and_a_ninth_is_refused(self):
        # Connections of other tests may remain open briefly.
        clients, begin = [], time.monotonic()
        while len(clients) < 8:
            frames = self.server.frames()
            if frames.status == 101:
                frames.send({"token": self.server.token})
                clients.append(frames)
                self.addCleanup(frames.close)
            else:
                frames.close()
                self.assertLess(time.monotonic() - begin, 10)
                time.sleep(0.1)
        self.assertEqual(self.socket_of().status, 503)
        self.assertEqual(self.server.ask("/state", {})[0], 503)
        # Four more get the files of the page, which says that the server is full.
        for path in ("/", "/view.js", "/view.css"):
            self.assertEqual(self.server.ask(path, b"", "GET", Origin=None)[0], 200)
        time.sleep(0.3)
        slow = self.server.connect_slowly(4)
        time.sleep(0.3)
        self.assertIn(b" 503 ", self.server.raw(b"").split(b"\r\n")[0])
        for s in slow:
            s.close()
        heads = [None] * 8

        def use(k):
            for i in range(5):
                clients[k].send({**WISH, "id": i, "client": str(k), "raw": True})
                heads[k] = clients[k].picture()[0]
                clients[k].send({"shown": i})
        threads = [threading.Thread(target=use, args=(k,)) for k in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
        self.assertEqual([(h["id"], h["status"]) for h in heads], [(4, 200)] * 8)
        clients[0].close()
        begin = time.monotonic()
        while self.server.ask("/state", {})[0] != 200:
            self.assertLess(time.monotonic() - begin, 5)
            time.sleep(0.05)

    # ---- states and heartbeats
    def test_menus_come_at_first_and_moments_as_they_change(self):
        scene = self.scene.with_name("changing.alhazen")
        scene.write_text(SCENE, encoding="utf-8")
        server = Server(ALHAZEN, scene)
        self.addCleanup(server.close)
        frames = server.open_frames()
        self.addCleanup(frames.close)
        state = frames.state()
        while not state["version"]:
            state = frames.state()
        self.assertEqual([c["name"] for c in state["cameras"]], ["front", "side"])
        begin = time.monotonic()
        moment = frames.state()
        self.assertLess(time.monotonic() - begin, 3 * SLOWDOWN)
        self.assertNotIn("cameras", moment)
        self.assertEqual((moment["version"], moment["error"]), (state["version"], ""))
        scene.write_text(SCENE.replace('"side"', '"left"'), encoding="utf-8")
        while "cameras" not in (state := frames.state()):
            self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual([c["name"] for c in state["cameras"]], ["front", "left"])

    def test_work_is_told_while_it_lasts(self):
        frames = self.open()
        frames.send({**WISH, "id": 1, "width": 400, "height": 300, "samples": 64, "raw": True, "client": "worker"})
        seen = []
        while (message := frames.message())[0] == 1:
            seen += [w for w in json.loads(message[1])["work"] if w.get("client") == "worker"]
        self.assertEqual(message[0], 2)
        self.assertTrue(seen)
        self.assertEqual({w["what"] for w in seen}, {"drawing"})
        parts = [w.get("part", 0) for w in seen]
        self.assertEqual(parts, sorted(parts))
        self.assertGreater(parts[-1], 0)
        frames.send({"shown": 1})
        while any(w.get("client") == "worker" for w in frames.state()["work"]):
            pass

    def test_pings_are_answered_and_sent(self):
        frames = self.open()
        frames.state()
        frames.send(b"here?", 9)
        while (message := frames.receive())[0] != 10:
            self.assertEqual(message[0], 1)
        self.assertEqual(message[1], b"here?")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
