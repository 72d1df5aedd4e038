#!/usr/bin/env python3
"""cupolad from start to end: readiness, watchdog, reload, live changes, signals and exit codes.

daemon_test.py FOLDER_OF_CUPOLAD
"""
import json
import re
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

from daemon import PATIENCE, Daemon, small_show

CUPOLAD = Path(sys.argv.pop(1)) / "cupolad"


def run(*arguments):
    return subprocess.run([str(CUPOLAD), *map(str, arguments)], capture_output=True, text=True, timeout=PATIENCE)


class Life(unittest.TestCase):
    def test_ready_after_the_first_frame_and_status(self):
        with Daemon(CUPOLAD, small_show()) as daemon:
            status = daemon.get("/api/v1/status")
            self.assertGreaterEqual(status["frames"], 1)
            self.assertEqual({"front", "dome"}, set(status["outputs"]))
            self.assertEqual("headless 160x120", status["outputs"]["front"]["description"])
            self.assertEqual([], status["problems"])
            line = daemon.notify.wait(lambda text: re.match(r"STATUS=revision 1, \d+\.\d frames a second, ", text))
            self.assertTrue(line)
            for name, size in (("front", (160, 120)), ("dome", (96, 96))):
                picture = daemon.picture(name)
                self.assertEqual(size, (picture.width, picture.height))
                self.assertGreater(len(picture.colors()), 10, "a picture of something")
            # The loop goes on by itself.
            frames = daemon.get("/api/v1/status")["frames"]
            daemon.wait_until(lambda: daemon.get("/api/v1/status")["frames"] > frames + 5, "more frames")

    def test_sigterm_and_sigint_end_within_a_second(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with Daemon(CUPOLAD, small_show()) as daemon:
                status, seconds = daemon.stop(number)
                self.assertEqual(0, status, daemon.log())
                self.assertLess(seconds, 1.0)
                self.assertIn("STOPPING=1", daemon.notify.lines())

    def test_sigterm_ends_a_long_load(self):
        show = small_show(scene={"content": {"kind": "city", "triangles": 5_000_000}})
        with Daemon(CUPOLAD, show, wait=False) as daemon:
            daemon.wait_until(lambda: "cupolad" in daemon.log(), "the first log line")
            time.sleep(0.3)
            status, seconds = daemon.stop()
            self.assertEqual(0, status)
            self.assertLess(seconds, 1.0)
            self.assertNotIn("READY=1", daemon.notify.lines())

    def test_watchdog_is_fed_by_frames(self):
        with Daemon(CUPOLAD, small_show(), watchdog_seconds=0.6) as daemon:
            mark = daemon.notify.mark()
            for _ in range(5):
                mark = daemon.notify.wait("WATCHDOG=1", mark)
        with Daemon(CUPOLAD, small_show()) as daemon:
            daemon.notify.wait(lambda text: text.startswith("STATUS=revision"))
            self.assertNotIn("WATCHDOG=1", daemon.notify.lines(), "no watchdog, no beats")

    def test_json_log(self):
        with Daemon(CUPOLAD, small_show(), ["--log-format", "json"]) as daemon:
            daemon.stop()
            lines = [json.loads(line) for line in daemon.log().splitlines()]
            self.assertGreater(len(lines), 2)
            for line in lines:
                self.assertEqual(["time", "level", "thread", "message"], list(line))
            self.assertTrue(any(line["message"].startswith("ready") for line in lines))

    def test_threads_are_named(self):
        with Daemon(CUPOLAD, small_show()) as daemon:
            tasks = Path(f"/proc/{daemon.process.pid}/task")
            names = {(task / "comm").read_text().strip() for task in tasks.iterdir()}
            self.assertLessEqual({"cupolad", "render", "prepare", "control", "shown"}, names)


class Changes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = Daemon(CUPOLAD, small_show()).__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.daemon.__exit__()

    def test_a_change_is_seen_and_a_refused_one_is_not(self):
        before = self.daemon.png("front")
        self.assertEqual(before, self.daemon.png("front"), "the camera stands still: the same bytes")
        status, answer = self.daemon.patch({"projections": {"flat": {"horizontal_fov": 50}}})
        self.assertEqual(200, status, answer)
        self.assertIsInstance(answer["frame"], int)
        changed = self.daemon.png("front")
        self.assertNotEqual(before, changed)
        self.assertEqual(answer["revision"], self.daemon.get("/api/v1/status")["shown_revision"])

        refused = ({"projections": {"flat": {"horizontal_fov": 500}}},
                   {"projections": {"flat": {"horizontal_fov": 60}}, "outputs": {"front": {"widht": 9}}},
                   {"outputs": None},
                   {"control": {"http": {"port": 1}}})
        for change in refused:
            status, answer = self.daemon.patch(change)
            self.assertEqual(422, status, answer)
            self.assertTrue(answer["problems"])
            self.assertEqual(changed, self.daemon.png("front"), change)

        status, answer = self.daemon.patch({"projections": {"flat": {"horizontal_fov": 80}}})
        self.assertEqual(200, status, answer)
        self.assertEqual(before, self.daemon.png("front"), "back to the first picture, byte for byte")

    def test_outputs_come_and_go_live(self):
        dome = self.daemon.png("dome")
        added = {"kind": "headless", "width": 64, "height": 48, "viewports": {"all": {"projection": "flat"}}}
        status, answer = self.daemon.patch({"outputs": {"side": added}})
        self.assertEqual(200, status, answer)
        self.assertEqual(64, self.daemon.picture("side").width)
        status, answer = self.daemon.patch({"outputs": {"side": {"width": 80}}})
        self.assertEqual(200, status, answer)
        self.assertEqual(80, self.daemon.picture("side").width)
        status, answer = self.daemon.patch({"outputs": {"side": None}})
        self.assertEqual(200, status, answer)
        self.assertEqual({"front", "dome"}, set(self.daemon.get("/api/v1/status")["outputs"]))
        self.assertEqual(dome, self.daemon.png("dome"), "the other output has not noticed")

    def test_a_window_without_a_display_is_refused(self):
        revision = self.daemon.get("/api/v1/status")["revision"]
        status, answer = self.daemon.patch({"outputs": {"front": {"kind": "window"}}})
        self.assertEqual(422, status, answer)
        self.assertEqual("OUT-101", answer["problems"][0]["code"])
        self.assertEqual(revision, self.daemon.get("/api/v1/status")["revision"])
        self.assertEqual(160, self.daemon.picture("front").width)


class Reload(unittest.TestCase):
    def test_broken_files_keep_the_show_and_good_ones_replace_it(self):
        with Daemon(CUPOLAD, small_show()) as daemon:
            before = daemon.png("front")
            for broken in ('{ "version": 1,\n  "outputs": {', json.dumps(small_show(frame_rate=-3)),
                           json.dumps(small_show(scene={"content": {"kind": "gltf", "file": "missing.glb"}}))):
                mark = daemon.notify.mark()
                daemon.write_show(broken)
                daemon.send(signal.SIGHUP)
                mark = daemon.notify.wait("RELOADING=1", mark)
                mark = daemon.notify.wait("READY=1", mark)
                refusal = daemon.notify.wait(lambda text: text.startswith("STATUS=reload refused"), mark - 1)
                self.assertTrue(refusal)
                self.assertEqual(before, daemon.png("front"))
            self.assertRegex(daemon.log(), r"show\.json:2:\d+: error: ")  # the first one: where it broke off

            mark = daemon.notify.mark()
            good = small_show()
            good["projections"]["flat"]["horizontal_fov"] = 40
            daemon.write_show(good)
            daemon.send(signal.SIGHUP)
            daemon.wait_ready(daemon.notify.wait("RELOADING=1", mark))
            self.assertNotEqual(before, daemon.png("front"))
            self.assertEqual(2, daemon.get("/api/v1/status")["shown_revision"])
            self.assertEqual(40, daemon.get("/api/v1/show")["projections"]["flat"]["horizontal_fov"])

    def test_many_reloads_at_once_end_ready(self):
        with Daemon(CUPOLAD, small_show()) as daemon:
            for _ in range(10):
                daemon.send(signal.SIGHUP)
                time.sleep(0.01)
            daemon.notify.wait(lambda text: text.startswith("STATUS=revision"), daemon.notify.mark())
            lines = [line for line in daemon.notify.lines() if line in ("RELOADING=1", "READY=1")]
            self.assertIn("RELOADING=1", lines)
            self.assertEqual("READY=1", lines[-1])
            self.assertEqual((0, True), (daemon.stop()[0], True))


class CommandLine(unittest.TestCase):
    def test_version_and_usage(self):
        self.assertRegex(run("--version").stdout, r"^cupolad \d+\.\d+\.\d+\n$")
        self.assertEqual(0, run("--help").returncode)
        for wrong in ((), ("--config",), ("--config", "x", "--log-format", "xml"), ("--nonsense",)):
            self.assertEqual(2, run(*wrong).returncode, wrong)

    def test_check(self):
        with Daemon(CUPOLAD, small_show(), wait=False) as daemon:  # for its folder
            daemon.stop()
            good = run("--config", daemon.show_file, "--check")
            self.assertEqual((0, f"{daemon.show_file}: valid\n", ""), (good.returncode, good.stdout, good.stderr))
            for show, line in ((small_show(frame_rate=0), r"show\.json:\d+:\d+: error: /frame_rate: expected "),
                               (small_show(outputs={}), r"show\.json:\d+:\d+: error: "),
                               ("{", r"show\.json:\d+:\d+: error: ")):
                daemon.write_show(show)
                bad = run("--config", daemon.show_file, "--check")
                self.assertEqual((1, ""), (bad.returncode, bad.stdout), bad.stderr)
                self.assertRegex(bad.stderr, line)
            self.assertEqual(2, run("--config", daemon.folder / "missing.json", "--check").returncode)
            self.assertEqual(2, run("--config", daemon.folder, "--check").returncode)

    def test_problems_at_the_start(self):
        with Daemon(CUPOLAD, small_show(frame_rate=0), wait=False) as daemon:
            self.assertEqual(1, daemon.process.wait(PATIENCE))
            self.assertRegex(daemon.log(), r"show\.json:\d+:\d+: error: /frame_rate: expected ")
        window = small_show()
        window["outputs"]["front"]["kind"] = "window"
        with Daemon(CUPOLAD, window, wait=False) as daemon:
            self.assertEqual(3, daemon.process.wait(PATIENCE))
            self.assertIn("OUT-101", daemon.log())
        with Daemon(CUPOLAD, small_show()) as first:
            taken = small_show(control={"http": {"port": first.port}})
            with Daemon(CUPOLAD, taken, wait=False) as second:
                self.assertEqual(3, second.process.wait(PATIENCE))
                self.assertIn("CTL-104", second.log())


class Files(unittest.TestCase):
    def test_image_sequence(self):
        show = small_show()
        show["outputs"]["front"].update({"kind": "files", "directory": "frames", "limit": 5})
        with Daemon(CUPOLAD, show) as daemon:
            frames = daemon.folder / "frames"
            daemon.wait_until(lambda: daemon.get("/api/v1/status")["outputs"]["front"]["frames"] == 5, "five pictures")
            self.assertEqual([f"front-{number:06}.png" for number in range(5)],
                             sorted(path.name for path in frames.iterdir()))
            self.assertEqual(daemon.picture("front").rgb, read_png(frames / "front-000004.png").rgb)


def read_png(path):
    from daemon import decode_png
    return decode_png(Path(path).read_bytes())


if __name__ == "__main__":
    unittest.main()
