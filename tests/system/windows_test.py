#!/usr/bin/env python3
"""Windows of the real daemon on a virtual display: what stands on the screen is the picture of the output.

windows_test.py FOLDER_OF_CUPOLAD
"""
import shutil
import sys
import unittest
from pathlib import Path

from daemon import Daemon, VirtualDisplay, small_show

CUPOLAD = Path(sys.argv.pop(1)) / "cupolad"


def windowed_show():
    """Two windows, and headless outputs that show the same."""
    show = small_show()
    outputs = show["outputs"]
    for name, x, y in (("front", 40, 60), ("dome", 400, 300)):
        outputs[name + "-window"] = {**outputs[name], "kind": "window", "x": x, "y": y, "decorated": False}
    return show


class Windows(unittest.TestCase):
    def setUp(self):
        self.display = VirtualDisplay()
        self.display.__enter__()
        self.addCleanup(self.display.__exit__)

    def daemon(self, show):
        daemon = Daemon(CUPOLAD, show, environment={"DISPLAY": self.display.name}).__enter__()
        self.addCleanup(daemon.__exit__)
        return daemon

    def seen(self, daemon, x, y, picture):
        daemon.wait_until(
            lambda: self.display.screen().part(x, y, picture.width, picture.height).rgb == picture.rgb,
            f"the picture at {x}, {y} on the screen")

    def test_several_windows_show_what_their_headless_twins_show(self):
        daemon = self.daemon(windowed_show())
        outputs = daemon.get("/api/v1/status")["outputs"]
        self.assertRegex(outputs["front-window"]["description"], r"^window, 160x120 on monitor \S+")
        front, dome = daemon.picture("front"), daemon.picture("dome")
        self.assertGreater(len(front.colors()), 10)
        self.seen(daemon, 40, 60, front)
        self.seen(daemon, 400, 300, dome)
        self.assertEqual(front.rgb, daemon.picture("front-window").rgb)

        # A change reaches the windows too, and all of them count the same frames.
        status, answer = daemon.patch({"projections": {"flat": {"horizontal_fov": 50}}})
        self.assertEqual(200, status, answer)
        changed = daemon.picture("front")
        self.assertNotEqual(front.rgb, changed.rgb)
        self.seen(daemon, 40, 60, changed)
        counts = {name: output["frames"] for name, output in daemon.get("/api/v1/status")["outputs"].items()}
        self.assertEqual(1, len(set(counts.values())), counts)

    def test_windows_open_and_close_live(self):
        daemon = self.daemon(windowed_show())
        front = daemon.picture("front")
        self.seen(daemon, 40, 60, front)
        status, answer = daemon.patch({"outputs": {"front-window": {"x": 700, "y": 500}}})
        self.assertEqual(200, status, answer)
        self.seen(daemon, 700, 500, front)
        status, answer = daemon.patch({"outputs": {"front-window": None}})
        self.assertEqual(200, status, answer)
        daemon.wait_until(lambda: len(self.display.screen().part(700, 500, 160, 120).colors()) == 1, "an empty screen")
        self.seen(daemon, 400, 300, daemon.picture("dome"))

    def test_a_missing_monitor_is_refused_with_the_names_of_those_there(self):
        daemon = self.daemon(windowed_show())
        status, answer = daemon.patch({"outputs": {"front-window": {"monitor": "HDMI-7"}}})
        self.assertEqual(422, status, answer)
        problem = answer["problems"][0]
        self.assertEqual(("OUT-101", "/outputs/front-window/monitor"), (problem["code"], problem["pointer"]))
        self.assertIn("0 (", problem["expected"])
        self.seen(daemon, 40, 60, daemon.picture("front"))

    def test_automatic_outputs_are_windows_here(self):
        show = small_show()
        for output in show["outputs"].values():
            del output["kind"]
        daemon = self.daemon(show)
        for output in daemon.get("/api/v1/status")["outputs"].values():
            self.assertTrue(output["description"].startswith("window"), output)
        picture = daemon.picture("front")

        def found():
            screen = self.display.screen()
            row = picture.rgb[:picture.width * 3]
            return row in screen.rgb
        daemon.wait_until(found, "the picture somewhere on the screen")

    def test_end_with_windows_within_a_second(self):
        daemon = self.daemon(windowed_show())
        status, seconds = daemon.stop()
        self.assertEqual(0, status, daemon.log())
        self.assertLess(seconds, 1.0)

    def test_a_lost_display_is_not_waited_for(self):
        daemon = self.daemon(windowed_show())
        self.display.process.terminate()
        self.display.process.wait()
        self.assertEqual(4, daemon.process.wait(30), "systemd is to start it again")
        self.assertIn("the display is gone", daemon.log())


if __name__ == "__main__":
    if not shutil.which("Xvfb"):
        print("SKIP windows: Xvfb is not installed")
        sys.exit(77)
    unittest.main()
