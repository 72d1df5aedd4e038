"""`cupola` run as a shell runs it, on a show in a folder of its own."""
import json
import subprocess
import tempfile
import unittest
from pathlib import Path


class CupolaTest(unittest.TestCase):
    CUPOLA = None  # the program
    SHOW = None    # a document

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.show = self.folder / "show.json"
        self.show.write_text(json.dumps(self.SHOW))

    def cupola(self, *arguments, expect=0):
        done = subprocess.run([self.CUPOLA, *map(str, arguments)], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, expect, done.stderr + done.stdout)
        return done
