#!/usr/bin/env python3
"""`cupola render` and `cupola bench` as a shell sees them: files, sizes, exit codes, words.

render_test.py BIN.
"""
import json
import re
import struct
import sys
import unittest
from pathlib import Path

from shell import CupolaTest

CUPOLA = str(Path(sys.argv.pop(1)) / "cupola")

SHOW = {
    "version": 1,
    "frame_rate": 10,
    "scene": {"content": {"kind": "room"}},
    "camera": {"position": [0, 0, 0]},
    "projections": {"wall": {"kind": "cylinder", "horizontal_fov": 360, "vertical_fov": 90},
                    "dome": {"kind": "fisheye", "fov": 180}},
    "outputs": {"wall": {"width": 64, "height": 32, "viewports": {"all": {"projection": "wall", "method": "piecewise"}}},
                "dome": {"width": 32, "height": 32, "viewports": {"all": {"projection": "dome", "method": "cubemap"}}}},
}


def png_size(file):
    head = file.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", file
    return struct.unpack(">II", head[16:24])


class Render(CupolaTest):
    CUPOLA, SHOW = CUPOLA, SHOW

    def render(self, *arguments, expect=0):
        return self.cupola("render", self.show, *arguments, expect=expect)

    def test_every_output_becomes_a_picture_in_a_folder(self):
        self.render("-o", self.folder / "out")
        self.assertEqual(png_size(self.folder / "out/wall.png"), (64, 32))
        self.assertEqual(png_size(self.folder / "out/dome.png"), (32, 32))

    def test_one_output_becomes_one_file_with_every_option_and_method(self):
        for method in ("piecewise", "cubemap", "reference"):
            file = self.folder / f"{method}.png"
            self.render("--output", "wall", "--method", method, "--size", "80x40", "--cubemap-size", "64", "--samples", "4",
                        "--supersampling", "2", "--anisotropy", "2", "--quiet", "-o", file)
            self.assertEqual(png_size(file), (80, 40))
        for method in ("piecewise", "cubemap"):
            done = self.cupola("compare", self.folder / f"{method}.png", self.folder / "reference.png")
            self.assertGreater(float(re.match(r"PSNR: ([\d.]+) dB", done.stdout)[1]), 18)

    def test_options_outrank_automatic_quality(self):
        def picture(name, quality, *options):
            self.show.write_text(json.dumps({**SHOW, "quality": quality}))
            file = self.folder / name
            self.render("--output", "wall", "-o", file, *options)
            return file.read_bytes()
        plain = picture("plain.png", {})
        self.assertNotEqual(picture("automatic.png", {"automatic": True}), plain)
        self.assertEqual(picture("told.png", {"automatic": True}, "--samples", "1"), plain)

    def test_frames_are_numbered(self):
        self.render("--output", "dome", "--frames", "3..5", "-o", self.folder / "frames")
        self.assertEqual(sorted(f.name for f in (self.folder / "frames").iterdir()),
                         ["dome_000003.png", "dome_000004.png", "dome_000005.png"])
        self.render("--output", "dome", "--frames", "3..3", "-o", self.folder / "third.png")
        self.assertEqual((self.folder / "third.png").read_bytes(), (self.folder / "frames/dome_000003.png").read_bytes())

    def test_progress_goes_to_standard_error_and_quiet_silences_it(self):
        done = self.render("--output", "wall", "--method", "reference", "-o", self.folder / "a.png")
        self.assertEqual(done.stdout, "")
        self.assertIn("100 %", done.stderr)
        done = self.render("--output", "wall", "--method", "reference", "--quiet", "-o", self.folder / "a.png")
        self.assertEqual(done.stdout + done.stderr, "")

    def test_json_alone_on_standard_output(self):
        done = self.render("--output", "dome", "--frames", "1..2", "--json", "-o", self.folder / "frames")
        report = json.loads(done.stdout)
        self.assertTrue(report["device"])
        self.assertEqual([(p["output"], p["frame"], p["width"], p["height"]) for p in report["pictures"]],
                         [("dome", 1, 32, 32), ("dome", 2, 32, 32)])
        for picture in report["pictures"]:
            self.assertEqual(png_size(Path(picture["file"])), (32, 32))

    def test_what_cannot_be_done_is_said_with_its_exit_code(self):
        to = ("-o", self.folder / "x.png")
        self.assertIn("dome", self.render("--output", "dom", *to, expect=2).stderr)
        self.assertIn("--size", self.render("--size", "80", *to, expect=2).stderr)
        self.assertIn("--frames", self.render("--frames", "5..3", *to, expect=2).stderr)
        self.assertIn("--cubemap-size", self.render("--cubemap-size", "7", *to, expect=2).stderr)
        self.render("--method", "magic", *to, expect=2)
        self.render(expect=2)
        self.cupola("render", self.folder / "absent.json", *to, expect=2)
        (self.folder / "bad.json").write_text("{}")
        self.cupola("render", self.folder / "bad.json", *to, expect=1)
        self.assertIn(".bmp", self.render("--output", "dome", "-o", self.folder / "x.bmp", expect=1).stderr)
        # A problem of the show, with its place: a perspective of more than half a turn.
        show = json.loads(json.dumps(SHOW))
        show["projections"]["wall"] = {"kind": "panini", "distance": 0, "horizontal_fov": 200}
        (self.folder / "wide.json").write_text(json.dumps(show))
        done = self.cupola("render", self.folder / "wide.json", "-o", self.folder / "out", expect=1)
        self.assertRegex(done.stderr, r"/projections/wall/horizontal_fov: .*\[PLN-102\]")
        done = self.render("--output", "wall", "-o", "/proc/cupola/x.png", expect=1)
        self.assertIn("[OUT-102]", done.stderr)
        self.assertIn("a folder for several", self.render(*to, expect=2).stderr)
        self.assertFalse((self.folder / "x.png").exists())
        self.assertFalse((self.folder / "out").exists())

    def test_the_version(self):
        self.assertRegex(self.cupola("--version").stdout, r"^cupola \d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    unittest.main()
