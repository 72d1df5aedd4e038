#!/usr/bin/env python3
"""`cupola get` and `cupola set` against a daemon's door: get_set_test.py FAKE_DAEMON CUPOLA."""
import json
import subprocess
import sys
import unittest

import fake

CUPOLA = sys.argv.pop(1)


class GetSet(fake.WithDaemon):
    def run_cupola(self, *words, url=None):
        at = ["--url", url or f"http://127.0.0.1:{self.http}"]
        done = subprocess.run([CUPOLA, words[0], *at, *words[1:]], capture_output=True, text=True,
                              timeout=60)
        return done.returncode, done.stdout, done.stderr

    def test_get(self):
        self.assertEqual(self.run_cupola("get", "/projections/wall/horizontal_fov"), (0, "180.0\n", ""))
        self.assertEqual(self.run_cupola("get", "projections/wall/kind"), (0, "cylinder\n", ""))
        self.assertEqual(self.run_cupola("get", "/projections/wall/kind", "--json"), (0, '"cylinder"\n', ""))
        self.assertEqual(self.run_cupola("get", "/camera/up"), (0, "[0.0,1.0,0.0]\n", ""))
        code, out, _ = self.run_cupola("get", "/")
        self.assertEqual((code, json.loads(out)["name"]), (0, "small"))

    def test_set(self):
        self.assertEqual(self.run_cupola("set", "/projections/wall/horizontal_fov", "120"),
                         (0, "revision 2 (rebuild)\n", ""))
        self.assertEqual(self.run_cupola("set", "/projections/wall/horizontal_fov", "120")[1],
                         "revision 2 (as it was)\n")
        self.assertEqual(self.run_cupola("set", "/scene/style/kind", "wireframe")[0], 0)
        self.assertEqual(self.run_cupola("set", "/name", "Grüße, Welt")[0], 0)
        self.assertEqual(self.get("show/name"), "Grüße, Welt")
        self.assertEqual(self.run_cupola("set", "/camera/position", "[1, 2, 3]")[0], 0)
        self.assertEqual(self.get("show/camera/position"), [1, 2, 3])
        self.assertEqual(self.run_cupola("set", "/camera/orientation/yaw", "--", "-30.5")[0], 0)
        self.assertEqual(self.get("show/camera/orientation/yaw"), -30.5)
        self.assertEqual(self.run_cupola("set", "/camera/orientation/yaw", "-20")[0], 0)
        self.assertEqual(self.get("show/camera/orientation/yaw"), -20)
        self.assertEqual(self.run_cupola("set", "/projections/wall/horizontal_fov", "null")[0], 0)
        self.assertEqual(self.get("show/projections/wall/horizontal_fov"), 180)

    def test_wait(self):
        code, out, _ = self.run_cupola("set", "/scene/fog/density", "0.5", "--wait")
        self.assertEqual(code, 0)
        self.assertRegex(out, r"^revision 2 \(uniform\), shown by frame \d+\n$")
        code, out, _ = self.run_cupola("set", "/scene/fog/density", "0.6", "--wait", "--json")
        self.assertGreater(json.loads(out)["frame"], 0)
        self.run_cupola("set", "/name", "still")
        code, out, error = self.run_cupola("set", "/scene/fog/density", "0.7", "--wait", "--timeout", "0.1")
        self.assertEqual(code, 1)
        self.assertIn("no frame has shown it", error)

    def test_refused(self):
        code, out, error = self.run_cupola("set", "/projections/wall/horizontal_fov", "400")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("/projections/wall/horizontal_fov", error)
        self.assertIn("[CFG-104]", error)
        code, out, error = self.run_cupola("get", "/projections/wall/zom")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("zoom", error)
        code, out, _ = self.run_cupola("get", "/projections/wall/zom", "--json")
        self.assertEqual((code, json.loads(out)["problems"][0]["code"]), (1, "CTL-102"))

    def test_unusable(self):
        for words, url in ((("get", "/name"), "http://127.0.0.1:9"), (("get", "/name"), "ftp://x"),
                           (("get",), None), (("set", "/name"), None), (("set", "/name", "x", "--nonsense"), None)):
            code, out, error = self.run_cupola(*words, url=url)
            self.assertEqual((code, out), (2, ""), words)
            self.assertTrue(error)
        code, out, _ = self.run_cupola("get", "/name", "--json", url="http://127.0.0.1:9")
        self.assertEqual((code, json.loads(out)["problems"][0]["code"]), (2, "CTL-105"))


if __name__ == "__main__":
    unittest.main()
