#!/usr/bin/env python3
"""What badly behaved clients may not do to the HTTP door: http_guard_test.py FAKE_DAEMON."""
import random
import socket
import time
import unittest

import fake
from fake import receive_all

GET = b"GET /api/v1/status HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


def status_of(answer):
    return int(answer.split(b" ", 2)[1]) if answer.startswith(b"HTTP/1.") else None


class Tight(fake.WithDaemon):
    """Limits of tenths of a second, 4 kB of header, 64 kB of body, 8 connections."""

    arguments = ["--tight"]

    def exchange(self, data, finish=False):
        with self.connect() as connection:
            connection.sendall(data)
            if finish:
                connection.shutdown(socket.SHUT_WR)
            return receive_all(connection)

    def still_well(self):
        """Whoever is refused for want of room is let in a moment later."""
        for _ in range(200):
            code, answer, _ = self.ask("GET", "/api/v1/status")
            if code != 503:
                break
            time.sleep(0.02)
        self.assertEqual((code, answer["revision"]), (200, 1))

    def test_garbage(self):
        self.assertEqual(status_of(self.exchange(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\x00" * 64)), 400)
        for data in (b"nonsense\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"GET / HTTP/1.1\r\nHost\r\n\r\n",
                     b"GET / HTTP/1.1\r\nContent-Length: -1\r\nHost: x\r\n\r\n",
                     b"GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\nHost: x\r\n\r\n",
                     b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
                     b"GET /%zz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"):
            answer = self.exchange(data)
            self.assertEqual(status_of(answer), 400, (data, answer))
            self.assertIn(b'"problems"', answer, data)
        self.still_well()

    def test_random_bytes(self):
        source = random.Random(7)
        for _ in range(60):
            self.exchange(source.randbytes(source.randrange(1, 400)), finish=True)
        for _ in range(60):
            damaged = bytearray(b"PATCH /api/v1/show HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
                                b"Content-Length: 2\r\nConnection: close\r\n\r\n{}")
            for _ in range(3):
                damaged[source.randrange(len(damaged))] = source.randrange(256)
            self.exchange(bytes(damaged), finish=True)
        self.still_well()

    def test_sizes(self):
        answer = self.exchange(b"GET / HTTP/1.1\r\nHost: x\r\nX: " + b"a" * 100_000 + b"\r\n\r\n")
        self.assertEqual(status_of(answer), 431)
        answer = self.exchange(b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\nHost: x\r\n\r\n")
        self.assertEqual(status_of(answer), 431)
        answer = self.exchange(b"PATCH /api/v1/show HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999\r\n\r\n")
        self.assertEqual(status_of(answer), 413)
        chunk = b"1000\r\n" + b" " * 4096 + b"\r\n"
        answer = self.exchange(b"PATCH /api/v1/show HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n" +
                               chunk * 32)
        self.assertEqual(status_of(answer), 413)
        self.still_well()

    def test_chunked(self):
        answer = self.exchange(b"PATCH /api/v1/show HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
                               b"Connection: close\r\nTransfer-Encoding: chunked\r\n\r\n"
                               b"8\r\n{\"name\":\r\n5\r\n \"x\"}\r\n0\r\n\r\n")
        self.assertEqual(status_of(answer), 200, answer)

    def test_pipelining_keeps_the_order(self):
        paths = [b"status", b"show/name", b"nothing", b"outputs/main.png", b"show/projections/wall/kind"]
        sent = b"".join(b"GET /api/v1/" + path + b" HTTP/1.1\r\nHost: x\r\n\r\n" for path in paths)
        answer = self.exchange(sent + b"GET /last HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
        self.assertEqual(answer.count(b"HTTP/1.1 "), 6)
        order = [answer.index(mark) for mark in (b'"uptime"', b'"small"\n', b"/api/v1/nothing", b"IHDR",
                                                 b'"cylinder"', b"/last")]
        self.assertEqual(order, sorted(order))

    def test_keep_alive(self):
        with self.connect() as connection:
            for _ in range(20):
                connection.sendall(GET)
                self.assertEqual(status_of(connection.recv(65536)), 200)
        answer = self.exchange(b"GET /api/v1/show/name HTTP/1.0\r\n\r\n")
        self.assertTrue(answer.startswith(b"HTTP/1.0 200"), answer)

    def test_a_dripping_header_is_cut_off(self):
        with self.connect() as connection:
            began = time.monotonic()
            try:
                for byte in GET * 5:
                    connection.sendall(bytes([byte]))
                    time.sleep(0.02)
                    connection.setblocking(False)
                    try:
                        if connection.recv(10) == b"":
                            break
                    except BlockingIOError:
                        pass
                    connection.setblocking(True)
                self.assertLess(time.monotonic() - began, 5 * len(GET) * 0.02)
            except (ConnectionResetError, BrokenPipeError):
                pass
        self.still_well()

    def test_a_body_that_never_comes(self):
        head = b"PATCH /api/v1/show HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 50\r\n\r\n"
        self.assertEqual(self.exchange(head + b'{"name": "half'), b"")  # cut off by time
        self.assertEqual(self.exchange(head + b'{"name": "half', finish=True), b"")
        self.still_well()

    def test_idle_connections_lock_nobody_out(self):
        idle = []
        try:
            for _ in range(300):
                idle.append(self.connect())
                if len(idle) % 50 == 0:
                    self.still_well()
            self.still_well()
        finally:
            for connection in idle:
                connection.close()

    def test_an_idle_connection_ends_by_itself(self):
        with self.connect() as connection:
            connection.sendall(GET)
            self.assertEqual(status_of(connection.recv(65536)), 200)
            self.assertEqual(receive_all(connection), b"")

    def test_busy_connections_are_refused_beyond_the_limit(self):
        self.ask("PUT", "/api/v1/show/name", '"still"', {"Content-Type": "application/json"})
        busy = []
        body = b'{"scene":{"fog":{"density":0.1}}}'
        try:
            for _ in range(8):
                connection = self.connect()
                connection.sendall(b"PATCH /api/v1/show?wait=shown&timeout=2 HTTP/1.1\r\nHost: x\r\n"
                                   b"Content-Type: application/json\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
                busy.append(connection)
            time.sleep(0.3)
            answer = self.exchange(GET)
            self.assertEqual(status_of(answer), 503, answer)
            self.assertIn(b"Retry-After", answer)
            self.assertIn(b"CTL-106", answer)
            for connection in busy:
                self.assertEqual(status_of(connection.recv(65536)), 202)
        finally:
            for connection in busy:
                connection.close()
        self.assertEqual(self.get("show/name"), "still")

    def test_clients_that_leave_before_the_answer(self):
        for _ in range(100):
            connection = self.connect()
            connection.sendall(b"GET /api/v1/outputs/main.png HTTP/1.1\r\nHost: x\r\n\r\n")
            connection.close()
        self.still_well()

    def test_a_client_that_does_not_read(self):
        with self.connect() as connection:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.sendall(GET * 400)
            self.still_well()


class EndWhileBusy(fake.WithDaemon):
    def test_the_daemon_ends_with_requests_under_way(self):
        self.ask("PATCH", "/api/v1/show", {"name": "still"})
        waiting = [self.connect() for _ in range(5)]
        body = b'{"scene":{"fog":{"density":0.1}}}'
        for connection in waiting:
            connection.sendall(b"PATCH /api/v1/show?wait=shown HTTP/1.1\r\nHost: x\r\n"
                               b"Content-Type: application/json\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
        pictures = [self.connect() for _ in range(5)]
        for connection in pictures:
            connection.sendall(b"GET /api/v1/outputs/main.png HTTP/1.1\r\nHost: x\r\n\r\n")
        began = time.monotonic()
        self.daemon.stdin.close()
        self.daemon.wait(timeout=30)
        self.assertEqual(self.daemon.returncode, 0)
        self.assertLess(time.monotonic() - began, 9)  # it does not wait for those who wait 10 s
        for connection in waiting + pictures:
            connection.close()

    def tearDown(self):
        self.daemon.stdout.close()
        self.daemon.stderr.close()


if __name__ == "__main__":
    unittest.main()
