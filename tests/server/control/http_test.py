#!/usr/bin/env python3
"""The HTTP door over real sockets: http_test.py FAKE_DAEMON."""
import json
import re
import struct
import subprocess
import tempfile
import threading
import unittest
import zlib
from pathlib import Path

import fake

FOV = "show/projections/wall/horizontal_fov"


def png_pixel(data, x, y):
    """(width, height, pixel) of an 8-bit RGB PNG."""
    position, idat, size = 8, b"", None
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        chunk = data[position + 8:position + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">IIBB", chunk[:10])
        elif kind == b"IDAT":
            idat += chunk
        position += 12 + length
    width, height, depth, colour = size
    assert (depth, colour) == (8, 2), size
    raw, stride, above = zlib.decompress(idat), width * 3, bytes(width * 3)
    for row in range(y + 1):
        kind, line = raw[row * (stride + 1)], bytearray(raw[row * (stride + 1) + 1:(row + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - 3] if i > 2 else 0, above[i], above[i - 3] if i > 2 else 0
            p = a + b - c
            nearest = min((abs(p - v), k, v) for k, v in enumerate((a, b, c)))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) % 256
        above = bytes(line)
    return width, height, tuple(above[x * 3:x * 3 + 3])


class Reading(fake.WithDaemon):
    def test_status(self):
        status = self.get("status")
        self.assertEqual(status["version"], "test")
        self.assertEqual(status["revision"], 1)
        self.assertEqual(status["device"], "no device")
        self.wait_for("first frame", lambda: self.get("status")["outputs"]["main"]["frames"] > 0)
        self.assertGreaterEqual(status["uptime"], 0)
        self.assertEqual([p for p in status["problems"] if p["severity"] == "error"], [])

    def test_show_and_its_values(self):
        code, show, headers = self.ask("GET", "/api/v1/show")
        self.assertEqual(code, 200)
        self.assertEqual(headers["ETag"], '"1"')
        self.assertEqual(headers["Cache-Control"], "no-store")
        self.assertEqual(show["projections"]["wall"]["horizontal_fov"], 180)
        self.assertIn("fog", show["scene"])  # defaults are told too
        self.assertEqual(self.get(FOV), 180)
        self.assertEqual(self.get("show/projections/wall/kind"), "cylinder")
        self.assertIsNone(self.get("show/camera/look_to"))
        self.assertEqual(self.get("show/outputs"), show["outputs"])

    def test_unchanged(self):
        code, body, _ = self.ask("GET", "/api/v1/show", headers={"If-None-Match": '"0", "1"'})
        self.assertEqual((code, body), (304, b""))
        self.assertEqual(self.ask("GET", "/api/v1/show", headers={"If-None-Match": '"2"'})[0], 200)

    def test_unknown_value(self):
        code, body, _ = self.ask("GET", "/api/v1/show/projections/wall/horizontal_fow")
        self.assertEqual(code, 404)
        self.assert_problems(body, "CTL-102")
        self.assertIn("horizontal_fov", body["problems"][0]["advice"])

    def test_every_parameter_is_described_and_has_an_address(self):
        parameters = self.get("parameters")["parameters"]
        self.assertGreater(len(parameters), 60)
        for parameter in parameters:
            self.assertEqual(self.get("show" + parameter["path"]), parameter["value"])
            self.assertIn(parameter["cost"], ("uniform", "rebuild", "reopen", "restart"))
        fov = next(p for p in parameters if p["path"] == "/projections/wall/horizontal_fov")
        self.assertEqual((fov["kind"], fov["unit"], fov["range"]), ("number", "°", [1, 360]))

    def test_schema(self):
        self.assertIn("2020-12", self.get("schema")["$schema"])

    def test_outputs(self):
        outputs = {output["name"]: output for output in self.get("outputs")["outputs"]}
        self.assertEqual(set(outputs), {"main", "side"})
        self.assertEqual((outputs["main"]["width"], outputs["main"]["kind"]), (320, "headless"))
        self.assertEqual(outputs["side"]["png"], "/api/v1/outputs/side.png")

    def test_head_options_and_methods(self):
        for path in ("/", "/api/v1/status", "/api/v1/show", "/api/v1/outputs/main.png"):
            code, body, headers = self.ask("HEAD", path)
            self.assertEqual((code, body), (200, b""), path)
            self.assertGreater(int(headers["Content-Length"]), 100)
        code, _, headers = self.ask("OPTIONS", "/api/v1/show")
        self.assertEqual((code, headers["Allow"]), (204, "GET, HEAD, OPTIONS, PATCH, PUT"))
        self.assertEqual(self.ask("OPTIONS", "*")[0], 204)
        for method, path in (("POST", "/api/v1/show"), ("DELETE", "/api/v1/show"), ("PATCH", "/api/v1/status"),
                             ("PUT", "/"), ("BREW", "/api/v1/show")):
            code, body, headers = self.ask(method, path)
            self.assertEqual(code, 405, (method, path))
            self.assertIn("GET", headers["Allow"])
            self.assert_problems(body, "CTL-101")

    def test_nothing_there(self):
        for path in ("/nothing", "/api", "/api/v1", "/api/v1/statu", "/api/v1/show2", "/../etc/passwd"):
            code, body, _ = self.ask("GET", path)
            self.assertEqual(code, 404, path)
            self.assert_problems(body, "CTL-108")

    def test_page_is_locked_down(self):
        code, page, headers = self.ask("GET", "/")
        self.assertEqual(code, 200)
        policy = headers["Content-Security-Policy"]
        nonce = re.search(r"script-src 'nonce-([0-9a-f]{32})'", policy).group(1)
        text = page.decode()
        self.assertIn("default-src 'none'", policy)
        self.assertEqual(text.count(f'nonce="{nonce}"'), 2)
        self.assertNotIn("CUPOLA-NONCE", text)
        self.assertTrue(text.rstrip().endswith("</html>"))
        self.assertNotRegex(text, r"(?:src|href)=\"(?!data:)")
        self.assertNotEqual(nonce, re.search(r"nonce-([0-9a-f]{32})", self.ask("GET", "/")[2]
                                             ["Content-Security-Policy"]).group(1))


class Changing(fake.WithDaemon):
    def patch(self, body, query="", **headers):
        return self.ask("PATCH", "/api/v1/show" + query, body, {k.replace("_", "-"): v for k, v in headers.items()})

    def test_patch(self):
        code, answer, headers = self.patch({"projections": {"wall": {"horizontal_fov": 120}}})
        self.assertEqual(code, 200, answer)
        self.assertEqual((answer["revision"], answer["cost"]), (2, "rebuild"))
        self.assertEqual(answer["changes"], [{"pointer": "/projections/wall/horizontal_fov", "cost": "rebuild"}])
        self.assertEqual(headers["ETag"], '"2"')
        self.assertEqual(self.get(FOV), 120)

    def test_patch_until_shown(self):
        code, answer, _ = self.patch({"scene": {"fog": {"density": 0.2}}}, "?wait=shown")
        self.assertEqual(code, 200)
        self.assertEqual(answer["cost"], "uniform")
        self.assertGreater(answer["frame"], 0)
        code, again, _ = self.patch({"scene": {"fog": {"density": 0.2}}}, "?wait=shown")  # alters nothing
        self.assertEqual((code, again["revision"], again["frame"]), (200, 2, answer["frame"]))
        self.patch({"name": "still"})
        code, answer, _ = self.patch({"scene": {"fog": {"density": 0.3}}}, "?wait=shown&timeout=0.05")
        self.assertEqual((code, answer["frame"]), (202, None))

    def test_refused_as_a_whole(self):
        before = self.get("show")
        code, answer, _ = self.patch({"scene": {"fog": {"density": 0.5}},
                                      "projections": {"wall": {"horizontal_fov": 400, "horizontal_fow": 1}}})
        self.assertEqual(code, 422)
        pointers = {problem["pointer"]: problem["code"] for problem in answer["problems"]}
        self.assertEqual(pointers["/projections/wall/horizontal_fov"], "CFG-104")
        self.assertEqual(pointers["/projections/wall/horizontal_fow"], "CFG-101")
        self.assertEqual(self.get("show"), before)
        code, answer, _ = self.patch({"control": {"http": {"port": 1}}})
        self.assertEqual(code, 422)
        self.assert_problems(answer, "CFG-210")

    def test_malformed(self):
        merge = {"Content-Type": "application/merge-patch+json"}
        code, answer, _ = self.ask("PATCH", "/api/v1/show", '{"name":\n  oops}', merge)
        self.assertEqual(code, 400)
        self.assert_problems(answer, "CFG-003")
        self.assertEqual((answer["problems"][0]["line"], answer["problems"][0]["column"]), (2, 3))
        for body in ("[]", "3", "null"):
            self.assertEqual(self.ask("PATCH", "/api/v1/show", body, merge)[0], 400)
        for body in ("", "{", '{"a":1e999}', '{"name":"a","name":"b"}', "[" * 50_000, b'{"name":"\xff"}'):
            code, answer, _ = self.ask("PATCH", "/api/v1/show", body, merge)
            self.assertEqual(code, 400, body[:40])
        for query in ("?wait=forever", "?timeout=x&wait=shown", "?timeout=-1", "?timeout=nan"):
            self.assertEqual(self.patch({}, query)[0], 400, query)
        self.assertEqual(self.get("status")["revision"], 1)

    def test_content_type(self):
        for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""):
            code, answer, headers = self.ask("PATCH", "/api/v1/show", "{}", {"Content-Type": kind})
            self.assertEqual(code, 415, kind)
            self.assertIn("merge-patch", headers["Accept-Patch"])
        for kind in ("application/json", "application/merge-patch+json", "Application/JSON; charset=utf-8"):
            self.assertEqual(self.ask("PATCH", "/api/v1/show", "{}", {"Content-Type": kind})[0], 200, kind)

    def test_expected_revision(self):
        self.assertEqual(self.patch({"name": "a"}, If_Match='"1"')[0], 200)
        code, answer, _ = self.patch({"name": "b"}, If_Match='"1"')
        self.assertEqual(code, 412)
        self.assert_problems(answer, "CTL-103")
        self.assertEqual(self.patch({"name": "c"}, If_Match='"1", "2"')[0], 200)
        self.assertEqual(self.patch({"name": "d"}, If_Match="*")[0], 200)
        for bad in ("2", 'W/"2"', '"x"', '"99999999999999999999999"'):
            self.assertEqual(self.patch({"name": "e"}, If_Match=bad)[0], 400, bad)
        self.assertEqual(self.get("show/name"), "d")

    def test_put_and_delete(self):
        json_type = {"Content-Type": "application/json"}
        put = lambda path, value: self.ask("PUT", "/api/v1/show" + path, json.dumps(value), json_type)
        self.assertEqual(put("/projections/wall/horizontal_fov", 90)[0], 200)
        self.assertEqual(self.get(FOV), 90)
        code, answer, _ = put("/projections/wall", {"kind": "fisheye"})  # replaces: no field of view is left over
        self.assertEqual(code, 200, answer)
        self.assertEqual(self.get("show/projections/wall/fov"), 180)
        self.assertEqual(put("/projections/spare", {"kind": "perspective"})[0], 200)
        self.assertEqual(self.ask("DELETE", "/api/v1/show/projections/spare")[0], 200)
        self.assertNotIn("spare", self.get("show/projections"))
        self.assertEqual(self.ask("DELETE", "/api/v1/show/projections/wall/fov")[0], 200)
        self.assertEqual(put("/projections/wal/zoom", 2)[0], 404)
        self.assertEqual(put("/projections/wall/zoom", "wide")[0], 422)
        show = self.get("show")
        show["name"] = "whole"
        self.assertEqual(put("", show)[0], 200)
        self.assertEqual(self.get("show/name"), "whole")

    def test_from_browsers(self):
        own, other = f"127.0.0.1:{self.http}", "evil.example"
        for headers, wanted in (
                ({"Origin": f"http://{own}", "Sec-Fetch-Site": "same-origin"}, 200),
                ({"Origin": f"http://{other}", "Sec-Fetch-Site": "cross-site"}, 403),
                ({"Origin": "null"}, 403),
                ({"Sec-Fetch-Site": "cross-site"}, 403),
                ({"Sec-Fetch-Site": "same-site"}, 403),
                # A foreign name that resolves to this machine: its page may name itself as origin.
                ({"Origin": f"http://{other}:{self.http}", "Host": f"{other}:{self.http}"}, 403),
                ({"Origin": f"http://localhost:{self.http}", "Host": f"localhost:{self.http}"}, 200)):
            code, answer, reply = self.patch({"name": "x"}, **headers)
            self.assertEqual(code, wanted, headers)
            self.assertNotIn("Access-Control-Allow-Origin", reply)
            if wanted == 403:
                self.assert_problems(answer, "CTL-107")
                self.assertEqual(self.ask("DELETE", "/api/v1/show/name", headers=headers)[0], 403)

    def test_sixty_a_second_from_several_at_once(self):
        failures = []

        def work(number):
            for i in range(40):
                value = 60 + (i * 7 + number) % 100
                code, answer, _ = self.patch({"projections": {"wall": {"horizontal_fov": value}}}, "?wait=shown")
                if code != 200 or answer["frame"] is None:
                    failures.append((code, answer))

        threads = [threading.Thread(target=work, args=(number,)) for number in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_curl(self):
        url = f"http://127.0.0.1:{self.http}/api/v1/"
        run = lambda *words: subprocess.run(["curl", "-sS", *words], capture_output=True, text=True, timeout=60)
        done = run("-X", "PATCH", "-H", "Content-Type: application/merge-patch+json", "-d",
                   '{"projections":{"wall":{"horizontal_fov":77}}}', url + "show?wait=shown")
        self.assertEqual(json.loads(done.stdout)["revision"], 2, done)
        self.assertEqual(run(url + FOV).stdout, "77.0\n")
        with tempfile.TemporaryDirectory() as folder:
            body = Path(folder) / "big.json"
            body.write_text(json.dumps({"camera": {"position": [0, 0, 0]}}) + " " * 900_000)
            done = run("-X", "PATCH", "-H", "Content-Type: application/json", "-H", "Expect: 100-continue",
                       "--data-binary", f"@{body}", "-w", "%{http_code}", url + "show")
            self.assertTrue(done.stdout.endswith("200"), done)
            body.write_text("{" + " " * 2_000_000 + "}")
            done = run("-X", "PATCH", "-H", "Content-Type: application/json", "--data-binary", f"@{body}",
                       "-w", "%{http_code}", url + "show")
            self.assertTrue(done.stdout.endswith("413"), done)
            self.assertIn("CTL-101", done.stdout)


class Pictures(fake.WithDaemon):
    def test_png(self):
        code, data, headers = self.ask("GET", "/api/v1/outputs/main.png")
        self.assertEqual((code, headers["Content-Type"]), (200, "image/png"))
        self.assertEqual(png_pixel(data, 0, 0), (320, 200, (90, 0, 0)))
        self.assertEqual(png_pixel(data, 160, 100)[2], (90, 127, 127))

    def test_follows_the_show(self):
        for fov in (100, 140, 60):
            self.ask("PATCH", "/api/v1/show?wait=shown", {"projections": {"wall": {"horizontal_fov": fov}}})
            self.assertEqual(png_pixel(self.ask("GET", "/api/v1/outputs/main.png")[1], 0, 0)[2][0], fov // 2)

    def test_scaled(self):
        code, data, _ = self.ask("GET", "/api/v1/outputs/main.png?width=80")
        width, height, pixel = png_pixel(data, 40, 25)
        self.assertEqual((code, width, height), (200, 80, 50))
        self.assertLessEqual(max(abs(a - b) for a, b in zip(pixel, (90, 129, 129))), 1)
        self.assertEqual(png_pixel(self.ask("GET", "/api/v1/outputs/main.png?width=9999")[1], 0, 0)[0], 320)
        code, data, headers = self.ask("GET", "/api/v1/outputs/side.jpg?width=64")
        self.assertEqual((code, headers["Content-Type"], data[:3]), (200, "image/jpeg", b"\xff\xd8\xff"))
        for width in ("0", "-5", "15", "x", "", "99999999999"):
            self.assertEqual(self.ask("GET", f"/api/v1/outputs/main.png?width={width}")[0], 400, width)

    def test_unknown(self):
        for name in ("mian.png", "main.gif", "main", ".png", "main.png/x", "..%2fmain.png"):
            code, answer, _ = self.ask("GET", "/api/v1/outputs/" + name)
            self.assertEqual(code, 404, name)
            self.assert_problems(answer, "CTL-108")
            self.assertIn("main.png, main.jpg, side.png", answer["problems"][0]["expected"])

    def test_no_picture(self):
        self.ask("PATCH", "/api/v1/show", {"name": "broken"})
        code, answer, _ = self.ask("GET", "/api/v1/outputs/main.png")
        self.assertEqual(code, 503)
        self.assert_problems(answer, "CTL-109")
        self.assertIn("broken output", answer["problems"][0]["found"])
        self.ask("PATCH", "/api/v1/show", {"name": "silent"})
        code, answer, _ = self.ask("GET", "/api/v1/outputs/main.jpg")
        self.assertEqual(code, 503)
        self.assertIn("within 1000 ms", answer["problems"][0]["expected"])

    def test_many_viewers(self):
        got = []

        def view():
            for _ in range(5):
                got.append(self.ask("GET", "/api/v1/outputs/main.jpg?width=160")[0])

        threads = [threading.Thread(target=view) for _ in range(12)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(got, [200] * 60)


if __name__ == "__main__":
    unittest.main()
