#!/usr/bin/env python3
"""The OSC door with liblo's own tools and with raw packets: osc_test.py FAKE_DAEMON."""
import random
import socket
import struct
import subprocess
import time
import unittest

import fake


def padded(text):
    data = text.encode() if isinstance(text, str) else text
    return data + b"\0" * (4 - len(data) % 4)


def message(address, types="", *values):
    out = padded(address) + padded("," + types)
    values = list(values)
    for kind in types:
        if kind in "ifd":
            out += struct.pack({"i": ">i", "f": ">f", "d": ">d"}[kind], values.pop(0))
        elif kind == "s":
            out += padded(values.pop(0))
    return out


def bundle(*elements):
    return b"#bundle\0" + struct.pack(">Q", 1) + b"".join(struct.pack(">I", len(e)) + e for e in elements)


def parsed(packet):
    """(address, types, values) of a message"""
    address, rest = packet.split(b"\0", 1)[0], packet[len(packet.split(b"\0", 1)[0]) // 4 * 4 + 4:]
    types = rest.split(b"\0", 1)[0][1:].decode()
    rest, values = rest[(len(types) + 1) // 4 * 4 + 4:], []
    for kind in types:
        if kind in "if":
            values.append(struct.unpack(">" + kind, rest[:4])[0])
            rest = rest[4:]
        elif kind == "s":
            text = rest.split(b"\0", 1)[0]
            values.append(text.decode())
            rest = rest[len(text) // 4 * 4 + 4:]
    return address.decode(), types, values


class Osc(fake.WithDaemon):
    def setUp(self):
        super().setUp()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(20)
        self.socket.connect(("127.0.0.1", self.osc))

    def tearDown(self):
        self.socket.close()
        super().tearDown()

    def send(self, *words):
        subprocess.run(["oscsend", "127.0.0.1", str(self.osc), *words], check=True, timeout=30)

    def answer(self, packet):
        self.socket.send(packet)
        return parsed(self.socket.recv(65536))

    def reaches(self, path, wanted):
        """Packets have no answer: a question after them is answered when they are through the door; then the
        show needs a moment."""
        for _ in range(6000):
            if self.get("show" + path) == wanted:
                return
            time.sleep(0.01)
        self.fail(f"{path} is {self.get('show' + path)}, not {wanted}")

    def unchanged(self):
        self.assertEqual(self.answer(message("/projections/wall/horizontal_fov")),
                         ("/projections/wall/horizontal_fov", "f", [180.0]))
        self.assertEqual(self.get("status")["revision"], 1)

    def test_oscsend(self):
        self.send("/projections/wall/horizontal_fov", "f", "120.1")
        self.reaches("/projections/wall/horizontal_fov", 120.1)
        self.send("/projections/wall/vertical_fov", "i", "50")
        self.reaches("/projections/wall/vertical_fov", 50)
        self.send("/camera/position", "fff", "1", "2.5", "-3")
        self.reaches("/camera/position", [1, 2.5, -3])
        self.send("/camera/loop", "F")
        self.reaches("/camera/loop", False)
        self.send("/quality/cubemap_mipmaps", "i", "1")
        self.reaches("/quality/cubemap_mipmaps", True)
        self.send("/scene/style/kind", "s", "hatching")
        self.reaches("/scene/style/kind", "hatching")
        self.send("/quality/cubemap_size", "i", "256")
        self.reaches("/quality/cubemap_size", 256)
        self.send("/quality/cubemap_size", "s", "auto")
        self.reaches("/quality/cubemap_size", "auto")

    def test_questions(self):
        self.assertEqual(self.answer(message("/scene/style/kind")), ("/scene/style/kind", "s", ["textured"]))
        self.assertEqual(self.answer(message("/outputs/main/width")), ("/outputs/main/width", "i", [320]))
        self.assertEqual(self.answer(message("/camera/loop"))[1], "T")
        self.assertEqual(self.answer(message("/camera/look_to"))[1], "N")
        self.assertEqual(self.answer(message("/camera/up")), ("/camera/up", "fff", [0, 1, 0]))

    def test_a_bundle_is_one_change(self):
        inner = bundle(message("/projections/wall/fov", "f", 210.0))
        self.socket.send(bundle(message("/projections/wall/kind", "s", "fisheye"), inner,
                                message("/name", "s", "Kuppel")))
        self.reaches("/name", "Kuppel")
        self.assertEqual(self.get("show/projections/wall/fov"), 210)
        self.assertEqual(self.get("status")["revision"], 2)

    def test_a_bundle_with_one_bad_message_changes_nothing(self):
        address, types, values = self.answer(bundle(message("/name", "s", "new"),
                                                    message("/projections/wall/horizontal_fov", "f", 999.0)))
        self.assertEqual((address, types), ("/cupola/problem", "sss"))
        self.assertEqual(values[:2], ["/projections/wall/horizontal_fov", "CFG-104"])
        address, _, values = self.answer(bundle(message("/name", "s", "new"), message("/camera/up", "f", 1.0)))
        self.assertEqual((address, values[0]), ("/cupola/problem", "/camera/up"))
        self.unchanged()

    def test_refusals_are_answered_with_the_reason(self):
        for packet, pointer, code in (
                (message("/projections/wall/horizontal_fov", "f", float("nan")), "/projections/wall/horizontal_fov",
                 "CFG-103"),
                (message("/projections/wall/horizontal_fov", "f", 0.0), "/projections/wall/horizontal_fov", "CFG-104"),
                (message("/projections/wall/horizontal_fov", "s", "wide"), "/projections/wall/horizontal_fov",
                 "CFG-103"),
                (message("/projections/wall/horizontal_fow", "f", 1.0), "/projections/wall/horizontal_fow", "CTL-102"),
                (message("/projections/wall/horizontal_fow"), "/projections/wall/horizontal_fow", "CTL-102"),
                (message("/scene/style/kind", "s", "comic"), "/scene/style/kind", "CFG-105"),
                (message("/control/osc/port", "i", 1), "/control/osc/port", "CFG-210"),
                (message("/projections", "i", 1), "/projections", "CFG-103"),
                (message("/projections/*/zoom", "f", 2.0), "/projections/*/zoom", "CTL-102"),
                (message("/quality/samples", "f", 1.5), "/quality/samples", "CFG-103")):
            address, types, values = self.answer(packet)
            self.assertEqual((address, types, values[:2]), ("/cupola/problem", "sss", [pointer, code]))
        self.unchanged()

    def test_what_is_not_osc(self):
        for packet in (b"", b"x", padded("/projections/wall/zoom"), b"/abc", b"\0" * 4, b"#bundle\0",
                       b"#bundle\0" + b"\0" * 8 + b"\xff" * 8, padded("/name") + padded(",s") + b"abcd",
                       padded("/name") + padded(",b") + b"\x7f\xff\xff\xff", b"/" * 65_507, bytes(65_507),
                       padded("/name") + padded("," + "f" * 60_000)):
            address, _, values = self.answer(packet)
            self.assertEqual((address, values[1]), ("/cupola/problem", "CTL-101"), packet[:20])
        self.unchanged()

    def test_thousands_of_random_packets(self):
        source = random.Random(20080611)
        seeds = [message("/projections/wall/horizontal_fov", "f", float("nan")),
                 bundle(message("/camera/position", "fff", 1e9, 0, 0), bundle(message("/quality/samples", "i", -1)))]
        self.socket.setblocking(False)
        for i in range(5000):
            if i % 3 == 0:
                packet = source.randbytes(source.randrange(1, 300))
            else:
                packet = bytearray(source.choice(seeds))
                # Numbers stay what they are: no damaged packet may become a good one by chance.
                for _ in range(source.randrange(1, 5)):
                    packet[source.randrange(16)] = source.randrange(256)
                packet = bytes(packet[:source.randrange(1, len(packet) + 1)])
            try:
                self.socket.send(packet)
                self.socket.recv(65536)
            except BlockingIOError:
                time.sleep(0.0005)
        time.sleep(0.5)
        try:
            while True:
                self.socket.recv(65536)
        except BlockingIOError:
            pass
        self.socket.settimeout(20)
        self.unchanged()

    def test_a_fader_at_a_thousand_a_second_arrives_at_its_end(self):
        for i in range(1000):
            self.socket.send(message("/scene/fog/density", "f", i / 1000.0))
            time.sleep(0.001)
        self.socket.send(message("/scene/fog/density", "f", 1.0))
        self.reaches("/scene/fog/density", 1.0)


if __name__ == "__main__":
    unittest.main()
