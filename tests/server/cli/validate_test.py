#!/usr/bin/env python3
"""`cupola validate` from the outside: exit status, places, formats.

validate_test.py CUPOLA
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
CUPOLA = Path(sys.argv.pop(1)).resolve()
GOOD, WARNED = "tests/configs/good/least.json", "tests/configs/good/warned_unused.json"
BROKEN = "tests/configs/broken/many_things.json"


def cupola(*arguments):
    return subprocess.run([CUPOLA, *map(str, arguments)], cwd=ROOT, text=True, timeout=30,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class Validate(unittest.TestCase):
    def test_exit_status(self):
        for status, arguments in [(0, [GOOD]), (1, [BROKEN]), (1, [GOOD, BROKEN]), (0, [WARNED]), (1, ["--strict", WARNED]),
                                  (0, ["--strict", GOOD]), (2, ["missing.json"]), (2, ["tests"]), (2, [BROKEN, "tests"]),
                                  (2, ["/dev/null"]), (2, []), (2, ["--format", "xml", GOOD]), (2, ["--bogus", GOOD])]:
            with self.subTest(arguments):
                self.assertEqual(cupola("validate", *arguments).returncode, status)

    def test_program(self):
        self.assertRegex(cupola("--version").stdout, r"^cupola \d+\.\d+\.\d+\n$")
        self.assertEqual(cupola("--version").returncode, 0)
        self.assertEqual(cupola("--help").returncode, 0)
        self.assertEqual(cupola("validate", "--help").returncode, 0)
        for arguments in ([], ["bogus"], ["schema", "extra"]):
            with self.subTest(arguments):
                done = cupola(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stdout, "")
                self.assertNotEqual(done.stderr, "")

    def test_fifo_and_large_file_are_refused_at_once(self):
        with tempfile.TemporaryDirectory() as folder:
            fifo, large = Path(folder, "fifo.json"), Path(folder, "large.json")
            os.mkfifo(fifo)
            with open(large, "wb") as stream:
                stream.truncate(100 << 20)
            for path, words in [(fifo, "a FIFO"), (large, "104857600 bytes")]:
                done = cupola("validate", path)
                self.assertEqual(done.returncode, 2)
                self.assertIn(words, done.stdout)

    def test_text(self):
        done = cupola("validate", BROKEN)
        wanted = (ROOT / BROKEN).with_suffix(".expected").read_text()
        self.assertEqual(done.stdout, re.sub("^", "tests/configs/broken/", wanted.strip(), flags=re.M) + "\n")
        self.assertEqual(cupola("validate", GOOD).stdout, GOOD + ": valid\n")
        self.assertIn("warning: /projections/spare", cupola("validate", WARNED).stdout)

    def test_geometry_and_scene_are_checked_too(self):
        """What the daemon would find only when it prepares the show."""
        outputs = '"outputs": {"o": {"viewports": {"v": {"projection": "p",\n "method": "%s"}}}}'
        projections = '"projections": {"p": {"kind": "fisheye"}}'
        with tempfile.TemporaryDirectory() as folder:
            show, model = Path(folder, "show.json"), Path(folder, "model.gltf")
            wide = '"projections": {"p": {"kind": "panini", "distance": 0,\n "horizontal_fov": 200}}'
            show.write_text('{"version": 1, %s, %s}' % (wide, outputs % "piecewise"))
            done = cupola("validate", show)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stdout, r"show\.json:2:20: error: /projections/p/horizontal_fov: .*\[PLN-102\]")

            content = '"scene": {"content": {"kind": "gltf",\n\n "file": "model.gltf"}}'
            show.write_text('{"version": 1, %s, %s, %s}' % (content, projections, outputs % "cubemap"))
            done = cupola("validate", show)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stdout, r"show\.json:3:10: error: /scene/content/file: .*\[SCN-101\]")

            model.write_text('{"asset": {"version": "2.0"}, "accessors": [{"count": -1}], "scenes": [{"nodes": [7]}]}')
            done = cupola("validate", show)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stdout, r"model\.gltf: error: /")

            model.write_text('{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}')
            self.assertNotIn("model.gltf: error: /nodes", cupola("validate", show).stdout)

    def test_json(self):
        problems = json.loads(cupola("validate", "--format", "json", BROKEN, WARNED, "tests").stdout)
        self.assertEqual(len(problems), 9)
        self.assertEqual([p["severity"] for p in problems], ["error"] * 7 + ["warning", "error"])
        width = next(p for p in problems if p["pointer"].endswith("/width"))
        self.assertEqual((width["code"], width["line"], width["column"], width["found"]), ("CFG-104", 9, 79, "800"))
        self.assertNotIn("line", problems[-1])
        self.assertEqual(json.loads(cupola("validate", "--format", "json", GOOD).stdout), [])

    def test_sarif(self):
        done = cupola("validate", "--format", "sarif", BROKEN, WARNED, "tests", "tests/configs/broken/latin1.json")
        self.assertEqual(done.returncode, 2)
        log = json.loads(done.stdout)
        self.assertEqual(log["version"], "2.1.0")
        run, = log["runs"]
        rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
        self.assertEqual(len(rules), len(set(rules)))
        self.assertEqual(len(run["results"]), 10)
        for result in run["results"]:
            self.assertEqual(rules[result["ruleIndex"]], result["ruleId"])
            self.assertIn(result["level"], ("error", "warning"))
            self.assertTrue(result["message"]["text"])
            physical = result["locations"][0]["physicalLocation"]
            self.assertTrue((ROOT / physical["artifactLocation"]["uri"]).exists())
            region = physical.get("region", {"startLine": 1, "startColumn": 1})
            self.assertGreaterEqual(min(region["startLine"], region["startColumn"]), 1)
        empty = json.loads(cupola("validate", "--format", "sarif", GOOD).stdout)
        self.assertEqual(empty["runs"][0]["results"], [])

    def test_sarif_counts_characters(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "ä b.json")
            path.write_text('\ufeff{ "name": "äöü🌐", "bogus": 1 }', encoding="utf-8")
            log = json.loads(cupola("validate", "--format", "sarif", path).stdout)
            result = next(r for r in log["runs"][0]["results"] if "bogus" in r["message"]["text"])
            physical = result["locations"][0]["physicalLocation"]
            self.assertEqual(physical["region"]["startColumn"], 19)
            self.assertTrue(physical["artifactLocation"]["uri"].endswith("/%C3%A4%20b.json"))
            self.assertIn(":1:25: ", cupola("validate", path).stdout)  # ours are bytes


if __name__ == "__main__":
    unittest.main()
