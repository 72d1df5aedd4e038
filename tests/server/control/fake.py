"""Starts fake_daemon for a test case and speaks plain HTTP to it."""
import http.client
import json
import socket
import subprocess
import sys
import time
import unittest

DAEMON = sys.argv.pop(1)


class WithDaemon(unittest.TestCase):
    """One daemon for each test; its end must be clean, whatever the test did to it."""

    arguments = []

    def setUp(self):
        self.daemon = subprocess.Popen([DAEMON, *self.arguments], stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        ports = json.loads(self.daemon.stdout.readline())
        self.http, self.osc = ports["http"], ports["osc"]

    def tearDown(self):
        self.assertIsNone(self.daemon.poll(), "the daemon has ended by itself")
        _, self.log = self.daemon.communicate(timeout=60)
        self.assertEqual(self.daemon.returncode, 0, self.log[-4000:])

    def ask(self, method, path, body=None, headers=None):
        """(status, JSON or bytes, header lines)"""
        connection = http.client.HTTPConnection("127.0.0.1", self.http, timeout=30)
        try:
            given = dict(headers or {})
            if body is not None and not isinstance(body, (bytes, str)):
                body = json.dumps(body)
                given.setdefault("Content-Type", "application/json")
            connection.request(method, path, body, given)
            answer = connection.getresponse()
            raw = answer.read()
            is_json = "json" in (answer.getheader("Content-Type") or "")
            return answer.status, json.loads(raw) if is_json and raw else raw, answer.headers
        finally:
            connection.close()

    def get(self, path):
        status, value, _ = self.ask("GET", "/api/v1/" + path)
        self.assertEqual(status, 200, value)
        return value

    def wait_for(self, what, condition):
        """What `condition` returns as soon as it is true of something; a busy machine is given time."""
        end = time.monotonic() + 30
        while not (value := condition()):
            self.assertLess(time.monotonic(), end, "no " + what + " in 30 s")
            time.sleep(0.02)
        return value

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.http), timeout=30)

    def assert_problems(self, value, *codes):
        self.assertEqual([problem["code"] for problem in value["problems"]], list(codes), value)
        for problem in value["problems"]:
            for key in ("title", "severity", "pointer", "expected", "found", "advice", "text"):
                self.assertIn(key, problem)


def receive_all(connection):
    """What comes until the other side closes."""
    got = b""
    while True:
        try:
            part = connection.recv(65536)
        except ConnectionResetError:
            return got
        if not part:
            return got
        got += part
