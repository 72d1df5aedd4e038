#!/usr/bin/env python3
"""`cupola compare` over pictures made here, its figures against ones computed here from their definitions.

compare_test.py BIN. Also the source of the figures in tests/renderer/reference/compare_test.cpp.
"""
import json
import math
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CUPOLA = str(Path(sys.argv.pop(1)) / "cupola")


def pattern(width, height, seed, amplitude):
    """Rows of (r, g, b): two ramps and noise, as in tests/renderer/reference/compare_test.cpp."""
    state, rows = seed, []
    for y in range(height):
        row = []
        for x in range(width):
            pixel = []
            for c in range(3):
                state = (state * 1664525 + 1013904223) % 2**32
                noise = (state >> 24) % (2 * amplitude + 1) - amplitude
                pixel.append(min(max(128 + 5 * (x % 16) - 3 * (y % 20) + 10 * c + noise, 0), 255))
            row.append(tuple(pixel))
        rows.append(row)
    return rows


def flat(width, height, pixel):
    return [[pixel] * width for _ in range(height)]


def differences(a, b):
    return [[[abs(p - q) for p, q in zip(s, t)] for s, t in zip(u, v)] for u, v in zip(a, b)]


def psnr(a, b):
    squares = [d * d for row in differences(a, b) for pixel in row for d in pixel]
    return 10 * math.log10(255**2 * len(squares) / sum(squares))


def ssim(a, b):
    """Two-dimensional windows, one at a time."""
    luma = [[[0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2] for p in row] for row in picture] for picture in (a, b)]
    window = {(i, j): math.exp(-((i - 5) ** 2 + (j - 5) ** 2) / 4.5) for i in range(11) for j in range(11)}
    total = sum(window.values())
    c1, c2, values = 2.55**2, 7.65**2, []
    for y in range(len(a) - 10):
        for x in range(len(a[0]) - 10):
            terms = [(w / total, luma[0][y + i][x + j], luma[1][y + i][x + j]) for (i, j), w in window.items()]
            mp, mq = sum(w * p for w, p, _ in terms), sum(w * q for w, _, q in terms)
            vp, vq = sum(w * (p - mp) ** 2 for w, p, _ in terms), sum(w * (q - mq) ** 2 for w, _, q in terms)
            cov = sum(w * (p - mp) * (q - mq) for w, p, q in terms)
            values.append((2 * mp * mq + c1) * (2 * cov + c2) / ((mp * mp + mq * mq + c1) * (vp + vq + c2)))
    return sum(values) / len(values)


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="cupola-compare-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def picture(self, name, rows):
        """A PPM file: simple enough to be written by hand."""
        path = self.folder / name
        head = f"P6\n{len(rows[0])} {len(rows)}\n255\n".encode()
        path.write_bytes(head + bytes(c for row in rows for pixel in row for c in pixel))
        return str(path)

    def compare(self, *arguments):
        done = subprocess.run([CUPOLA, "compare", *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def test_figures(self):
        a, b = pattern(40, 33, 1, 20), pattern(40, 33, 2, 35)
        code, out, err = self.compare(self.picture("a.ppm", a), self.picture("b.ppm", b), "--json")
        self.assertEqual((code, err), (0, ""))
        answer = json.loads(out)
        self.assertAlmostEqual(answer["psnr_db"], psnr(a, b), places=9)
        self.assertAlmostEqual(answer["ssim"], ssim(a, b), places=9)
        self.assertEqual(answer["max_difference"], max(d for row in differences(a, b) for p in row for d in p))
        self.assertFalse(answer["identical"])

    def test_text(self):
        a, b = pattern(40, 33, 1, 20), pattern(40, 33, 2, 35)
        code, out, _ = self.compare(self.picture("a.ppm", a), self.picture("b.ppm", b))
        self.assertEqual(code, 0)
        lines = out.splitlines()
        self.assertEqual(lines[0], "PSNR: %.2f dB" % psnr(a, b))
        self.assertEqual(lines[1], "SSIM: %.4f" % ssim(a, b))
        self.assertRegex(lines[2], r"^Largest difference: 55 of 255, at \d+,\d+$")

    def test_identical(self):
        a = self.picture("a.ppm", pattern(20, 20, 5, 9))
        code, out, _ = self.compare(a, a, "--min-psnr", 99, "--max-diff", 0)
        self.assertEqual(code, 0)
        self.assertEqual(out.splitlines()[0], "PSNR: 999.00 dB (identical)")
        self.assertEqual(float(re.search(r"PSNR\D*([0-9.]+)", out).group(1)), 999.0)
        code, out, _ = self.compare(a, a, "--json")
        self.assertTrue(json.loads(out)["identical"])
        self.assertEqual(json.loads(out)["psnr_db"], 999)

    def test_limits(self):
        a, b = self.picture("a.ppm", flat(12, 12, (100, 100, 100))), self.picture("b.ppm", flat(12, 12, (103, 99, 100)))
        level = psnr(flat(12, 12, (100, 100, 100)), flat(12, 12, (103, 99, 100)))
        self.assertEqual(self.compare(a, b, "--min-psnr", level - 0.01)[0], 0)
        self.assertEqual(self.compare(a, b, "--min-psnr", level + 0.01)[0], 1)
        self.assertEqual(self.compare(a, b, "--max-diff", 3)[0], 0)
        code, out, _ = self.compare(a, b, "--max-diff", 2)
        self.assertEqual(code, 1)
        self.assertIn("beyond --max-diff 2", out)
        code, out, _ = self.compare(a, b, "--max-diff", 2, "--json")
        self.assertEqual((code, json.loads(out)["within"]), (1, False))

    def test_difference_picture(self):
        a, b = self.picture("a.ppm", flat(8, 8, (100, 100, 100))), self.picture("b.ppm", flat(8, 8, (103, 99, 100)))
        diff = self.folder / "diff.png"
        self.assertEqual(self.compare(a, b, "--diff", diff, "--magnify", 10)[0], 0)
        shown = self.picture("shown.ppm", flat(8, 8, (30, 10, 0)))
        self.assertIn("identical", self.compare(diff, shown)[1])
        code, _, err = self.compare(a, b, "--diff", self.folder / "missing" / "diff.png")
        self.assertEqual(code, 2)
        self.assertIn("OUT-102", err)

    def test_sizes_differ(self):
        a, b = self.picture("a.ppm", flat(8, 8, (1, 2, 3))), self.picture("b.ppm", flat(8, 9, (1, 2, 3)))
        code, out, err = self.compare(a, b)
        self.assertEqual((code, out), (1, ""))
        self.assertIn("8 x 8", err)
        self.assertIn("8 x 9", err)
        code, out, _ = self.compare(a, b, "--json")
        self.assertEqual(code, 1)
        self.assertFalse(json.loads(out)["within"])

    def test_unreadable_and_usage(self):
        a = self.picture("a.ppm", flat(8, 8, (1, 2, 3)))
        code, out, err = self.compare(a, self.folder / "missing.png")
        self.assertEqual((code, out), (2, ""))
        self.assertIn("OUT-103", err)
        code, out, _ = self.compare(a, self.folder, "--json")
        self.assertEqual(code, 2)
        self.assertEqual(json.loads(out)["problems"][0]["code"], "OUT-103")
        self.assertEqual(self.compare(a)[0], 2)
        self.assertEqual(self.compare(a, a, "--min-psnr", "much")[0], 2)


if __name__ == "__main__":
    unittest.main()
