#!/usr/bin/env python3
"""The service as `cmake --install` lays it out: systemd accepts it, and its sandbox stays as tight as it is.

units_test.py BUILD_FOLDER
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = Path(sys.argv.pop(1))
EXPOSURE_LIMIT = 20  # tenths; systemd calls up to 2.0 "OK" at best for a service with network and devices


def run(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, stdin=subprocess.DEVNULL)


class Units(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = Path(cls.folder.name) / "prefix"
        installed = run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        assert installed.returncode == 0, installed.stdout + installed.stderr
        # The unit names the prefix it was configured for; the copy that is checked names the one used here.
        text = (cls.prefix / "lib/systemd/system/cupolad.service").read_text()
        cls.unit = Path(cls.folder.name) / "cupolad.service"
        cls.unit.write_text(re.sub(r"[^\s=]*/bin/(cupolad?)\b", rf"{cls.prefix}/bin/\1", text))
        cls.text = text

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_programs_of_the_unit_are_installed(self):
        commands = re.findall(r"^Exec\w+=[-+!@:]*(\S+)", self.unit.read_text(), re.M)
        self.assertGreaterEqual(len(commands), 3)
        for command in commands:
            self.assertTrue(os.access(command, os.X_OK), command)
            self.assertFalse(command.endswith("sh"), "no shell in a unit")

    def test_systemd_accepts_the_unit(self):
        verdict = run("systemd-analyze", "verify", "--man=no", self.unit)
        said = [line for line in verdict.stderr.splitlines() if "cupolad" in line]
        self.assertEqual((0, []), (verdict.returncode, said), verdict.stderr)

    def test_systemd_would_refuse_a_broken_unit(self):
        broken = self.unit.with_name("broken.service")
        broken.write_text(self.unit.read_text().replace(f"{self.prefix}/bin/cupolad", "/nowhere/cupolad"))
        self.assertNotEqual(0, run("systemd-analyze", "verify", "--man=no", broken).returncode)

    def test_sandbox_is_tight(self):
        verdict = run("systemd-analyze", "security", "--offline=true", "--no-pager",
                      f"--threshold={EXPOSURE_LIMIT}", self.unit)
        self.assertEqual(0, verdict.returncode, verdict.stdout.strip().splitlines()[-1:] + [verdict.stderr])

    def test_sandbox_bound_can_be_missed(self):
        bare = self.unit.with_name("bare.service")
        bare.write_text("[Service]\nExecStart=/bin/true\n")
        self.assertNotEqual(0, run("systemd-analyze", "security", "--offline=true", "--no-pager",
                                   f"--threshold={EXPOSURE_LIMIT}", bare).returncode)

    def test_every_hole_is_explained(self):
        lines = self.text.splitlines()
        holes = [number for number, line in enumerate(lines)
                 if re.match(r"(Private|Protect|Proc|Memory)\w+=(no|all)$|DeviceAllow=|BindReadOnlyPaths=", line)]
        self.assertGreaterEqual(len(holes), 5)
        for number in holes:
            start = max(index for index in range(number) if lines[index].startswith("#"))
            self.assertRegex(" ".join(lines[max(0, start - 2):start + 1]), r"# Hole: ", lines[number])

    def test_user_and_first_show(self):
        root = Path(self.folder.name) / "root"
        for path in ("etc", "usr/share/cupola/shows", "var/lib"):
            (root / path).mkdir(parents=True)
        sysusers = self.prefix / "lib/sysusers.d/cupola.conf"
        self.assertEqual(0, run("systemd-sysusers", f"--root={root}", sysusers).returncode)
        self.assertRegex((root / "etc/passwd").read_text(), r"(?m)^cupola:x:")
        self.assertRegex((root / "etc/group").read_text(), r"(?m)^video:x:\d+:cupola$")
        tmpfiles = Path(self.folder.name) / "tmpfiles.conf"
        text = (self.prefix / "lib/tmpfiles.d/cupola.conf").read_text()
        tmpfiles.write_text(re.sub(r"\S+/share/cupola", "/usr/share/cupola", text))
        (root / "usr/share/cupola/shows/demo.json").write_text("{}")
        made = run("systemd-tmpfiles", f"--root={root}", "--create", tmpfiles)
        self.assertEqual(0, made.returncode, made.stderr)
        show = root / "etc/cupola/show.json"
        self.assertEqual("{}", show.read_text())
        show.write_text("mine")
        run("systemd-tmpfiles", f"--root={root}", "--create", tmpfiles)
        self.assertEqual("mine", show.read_text(), "a show that is there stays")


if __name__ == "__main__":
    if not shutil.which("systemd-analyze"):
        print("SKIP units: systemd-analyze is not installed")
        sys.exit(77)
    unittest.main()
