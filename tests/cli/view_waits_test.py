#!/usr/bin/env python3
"""Clients that keep `alhazen view` waiting are disconnected after 5 seconds. Little processor time, so other tests may run
in parallel.

Usage: view_waits_test.py ALHAZEN
"""

import threading
import time
import unittest

from view_server import SLOWDOWN, ServerTest


class ViewWaits(ServerTest):
    def test_a_socket_without_a_token_is_let_go(self):
        frames = self.socket_of()
        begin = time.monotonic()
        self.assertEqual(frames.receive()[0], 8)
        self.assertLess(time.monotonic() - begin, 5 + 3 * SLOWDOWN)

    def test_slow_clients_are_let_go_and_others_answered(self):
        memory = self.server.state()["memory"]
        sockets = self.server.connect_slowly(200)
        begin = time.monotonic()
        while self.server.ask("/state", {})[0] != 200:
            self.assertLess(time.monotonic() - begin, 5 + 4 * SLOWDOWN, "slow clients keep their places")
            time.sleep(0.2)
        for s in sockets:
            s.close()
        self.assertLess(self.server.state()["memory"] - memory, 32 << 20)

    def test_a_quiet_page_stays_and_one_that_is_gone_does_not(self):
        quiet, gone = self.open(), self.open()
        end = []
        thread = threading.Thread(target=lambda: end.append(self.until_closed(gone)))
        thread.start()
        messages = quiet.listen(9)
        self.assertNotIn(8, [opcode for opcode, _ in messages])
        self.assertGreaterEqual(len(messages), 7)
        thread.join(20 * SLOWDOWN)
        self.assertLess(end[0], 5 + 4 * SLOWDOWN)

    @staticmethod
    def until_closed(frames):
        """Reads without answering pings until the server closes; returns the seconds."""
        begin = time.monotonic()
        while frames.receive()[0] != 8 and time.monotonic() - begin < 20 * SLOWDOWN:
            pass
        return time.monotonic() - begin


if __name__ == "__main__":
    unittest.main(argv=["view_waits_test.py"])
