#!/usr/bin/env python3
"""`cupola pieces`: its figures, its pictures against plain ones, its words where something is wrong.

pieces_test.py BIN.
"""
import json
import math
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from shell import CupolaTest

CUPOLA = str(Path(sys.argv.pop(1)) / "cupola")
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "system"))
from daemon import decode_png  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"
SHOW = {
    "version": 1,
    "scene": {"content": {"kind": "room"}},
    "camera": {"position": [0, 0, 0]},
    "projections": {"wall": {"kind": "cylinder", "horizontal_fov": 360, "vertical_fov": 90},
                    "dome": {"kind": "fisheye", "fov": 180},
                    "globe": {"kind": "equirectangular"},
                    "flat": {"kind": "perspective"}},
    "outputs": {"wall": {"width": 200, "height": 80, "viewports": {"all": {"projection": "wall"}}},
                "dome": {"width": 192, "height": 160, "viewports": {
                    "round": {"projection": "dome", "x": 0.25, "width": 0.75},
                    "side": {"projection": "flat", "width": 0.25}}},
                "globe": {"width": 128, "height": 64, "viewports": {"all": {"projection": "globe"}}}},
}


def corners(polygon):
    return [tuple(map(float, pair.split(","))) for pair in polygon.get("points").split()]


def distance(x, y, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    along = max(0.0, min(1.0, ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)))
    return math.hypot(x - a[0] - along * dx, y - a[1] - along * dy)


class Pieces(CupolaTest):
    CUPOLA, SHOW = CUPOLA, SHOW

    def pieces(self, *arguments, expect=0):
        return self.cupola("pieces", self.show, *arguments, expect=expect)

    def figures(self, *arguments):
        viewports = json.loads(self.pieces("--json", *arguments).stdout)["viewports"]
        return {f"{v['output']}/{v['viewport']}": v for v in viewports}

    def svg(self, output, *arguments):
        file = self.folder / f"{output}.svg"
        self.pieces("--output", output, *arguments, "-o", file)
        return ElementTree.parse(file).getroot()

    def pictures(self, output):
        """With borders, and plain."""
        lined, plain = self.folder / "lined.png", self.folder / "plain.png"
        self.pieces("--output", output, "-o", lined)
        self.cupola("render", self.show, "--output", output, "--method", "piecewise", "--quiet", "-o", plain)
        return decode_png(lined.read_bytes()), decode_png(plain.read_bytes())

    def test_figures_of_strips_triangles_and_a_perspective(self):
        all_of_them = self.figures()
        self.assertEqual(sorted(all_of_them), ["dome/round", "dome/side", "globe/all", "wall/all"])
        wall, dome, flat, globe = (all_of_them[n] for n in ("wall/all", "dome/round", "dome/side", "globe/all"))
        self.assertEqual([v["kind"] for v in (wall, dome, flat, globe)],
                         ["strips", "triangles", "perspective", "triangles"])
        self.assertAlmostEqual(wall["pieces"] * wall["width"]["mean"], 200)
        self.assertEqual(wall["height"], {"smallest": 80, "mean": 80, "largest": 80})
        self.assertEqual(wall["pixels_measured"], 200 * 80)
        self.assertEqual((flat["pieces"], flat["width"]["largest"], flat["height"]["largest"]), (1, 48, 160))
        self.assertLess(flat["largest_error"], 1e-6)
        self.assertGreater(dome["pieces"], 20)
        circle = math.pi * 72 ** 2
        self.assertAlmostEqual(dome["pixels_measured"], circle, delta=0.01 * circle)
        for viewport in (wall, dome):
            self.assertLess(viewport["rms_error"], viewport["largest_error"])
            self.assertGreater(viewport["largest_error"], 0.01)
            self.assertLessEqual(viewport["largest_error"], 0.25)
            self.assertEqual((viewport["looked_up"], viewport["step"]), (0, 1))
            self.assertGreater(viewport["milliseconds"], 0)
            for side in ("width", "height"):
                size = viewport[side]
                self.assertLessEqual(size["smallest"], size["mean"])
                self.assertLessEqual(size["mean"], size["largest"])
        self.assertGreater(globe["looked_up"], 0)  # about the poles

    def test_options_narrow_and_change_what_is_planned(self):
        self.assertEqual(list(self.figures("--viewport", "round")), ["dome/round"])
        self.assertEqual(list(self.figures("--output", "wall")), ["wall/all"])
        self.assertGreater(self.figures("--max-error", "0.05")["dome/round"]["pieces"],
                           self.figures("--max-error", "1")["dome/round"]["pieces"])
        self.assertEqual(self.figures("--size", "400x90")["wall/all"]["height"]["mean"], 90)
        large = self.figures("--output", "wall", "--size", "4000x2000")["wall/all"]
        self.assertEqual(large["step"], 2)
        self.assertEqual(large["pixels_measured"], 2000 * 1000)

    def test_words(self):
        words = self.pieces("--output", "wall").stdout
        self.assertRegex(words, r"^wall/all: strips, \d+ in number\n")
        self.assertIn("looked up in a cubemap: 0 %", words)

    def test_lines_alone_change_the_picture_and_are_black_along_strips(self):
        lined, plain = self.pictures("wall")
        borders = {round(x) for p in self.svg("wall").iter(f"{SVG}polygon") for x, y in corners(p)}
        self.assertGreater(len(borders), 3)
        for x in range(200):
            near = min(abs(x - border) for border in borders)
            for y in range(80):
                if near == 0:
                    self.assertEqual(lined.at(x, y), (0, 0, 0), (x, y))
                elif near > 1 and 1 < y < 79:
                    self.assertEqual(lined.at(x, y), plain.at(x, y), (x, y))
                elif near == 1 and 1 < y < 79:  # the halo
                    self.assertGreater(sum(lined.at(x, y)), 3 * 126, (x, y))

    def test_lines_follow_triangles(self):
        lined, plain = self.pictures("dome")
        sides = []
        for polygon in self.svg("dome", "--viewport", "round").iter(f"{SVG}polygon"):
            c = corners(polygon)
            sides += zip(c, c[1:] + c[:1])
        sides = {tuple(sorted(side)) for side in sides}
        far = 0
        for x in range(5, 144, 7):
            for y in range(5, 156, 6):
                nearest = min(distance(x, y, *side) for side in sides)  # lines go through middles of pixels
                if nearest > 2.0:
                    self.assertEqual(lined.at(48 + x, y), plain.at(48 + x, y), (x, y))
                    far += 1
                if nearest == 0.0:
                    self.assertEqual(lined.at(48 + x, y), (0, 0, 0), (x, y))
        self.assertGreater(far, 30)

    def test_svg_has_a_polygon_a_piece_over_the_picture(self):
        figures = self.figures()
        for output, names in (("wall", ["wall/all"]), ("dome", ["dome/round", "dome/side"]),
                              ("globe", ["globe/all"])):
            root = self.svg(output)
            self.assertEqual(len(list(root.iter(f"{SVG}polygon"))), sum(figures[n]["pieces"] for n in names))
            self.assertEqual(len(list(root.iter(f"{SVG}path"))) > 0, output == "globe")
            self.assertEqual(int(root.get("width")), SHOW["outputs"][output]["width"])
            self.assertTrue(root.find(f"{SVG}image").get("href").startswith("data:image/png;base64,iVBOR"))

    def test_what_cannot_be_done_is_said_with_its_exit_code(self):
        self.assertIn("dome", self.pieces("--output", "dom", expect=2).stderr)
        self.assertIn("Did you mean 'round'?", self.pieces("--viewport", "rund", expect=2).stderr)
        self.assertIn("--size", self.pieces("--size", "80", expect=2).stderr)
        self.assertIn("--output NAME", self.pieces("-o", self.folder / "x.png", expect=2).stderr)
        self.pieces("--max-error", "0", expect=2)
        self.cupola("pieces", self.folder / "absent.json", expect=2)
        for name in ("x.png", "x.svg"):
            done = self.pieces("--output", "wall", "-o", f"/proc/cupola/{name}", expect=1)
            self.assertIn("[OUT-102]", done.stderr)
        show = json.loads(json.dumps(SHOW))
        show["projections"]["wall"] = {"kind": "panini", "distance": 0, "horizontal_fov": 200}
        self.show.write_text(json.dumps(show))
        self.assertRegex(self.pieces(expect=1).stderr, r"/projections/wall/horizontal_fov: .*\[PLN-102\]")


if __name__ == "__main__":
    unittest.main()
