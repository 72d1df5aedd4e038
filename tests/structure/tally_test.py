#!/usr/bin/env python3
"""The counts of `./dev test`: what tests/support/tally.py makes of a JUnit file as CTest writes it."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.sax.saxutils import escape

TALLY = Path(__file__).resolve().parents[1] / "support" / "tally.py"


def tally(*cases):
    """cases: (status, output[, message of skipped]) → (last line, exit status, all lines)."""
    xml = '<?xml version="1.0"?><testsuite>'
    for number, (status, output, *message) in enumerate(cases):
        xml += f'<testcase name="t{number}" status="{status}">'
        xml += f'<skipped message="{message[0]}"/>' if message else ""
        xml += f"<system-out>{escape(output)}</system-out></testcase>"
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(xml + "</testsuite>")
        file.flush()
        run = subprocess.run([sys.executable, str(TALLY), file.name], capture_output=True, text=True)
    lines = run.stdout.splitlines()
    return lines[-1], run.returncode, lines


DOCTEST = "[doctest] test cases:  {} |  {} passed | {} failed | 0 skipped\n"


class Tally(unittest.TestCase):
    def test_adds_up_programs(self):
        self.assertEqual(("8 passed, 0 failed", 0), tally(
            ("run", DOCTEST.format(3, 3, 0)), ("run", "Ran 2 tests in 0.1s\n\nOK\n"),
            ("run", "# pass 2\n# fail 0\n# skipped 0\n"), ("run", "no summary"))[:2])

    def test_own_last_line(self):
        self.assertEqual(("6 passed, 0 failed, 1 skipped", 0), tally(("run", "6 passed, 0 failed, 1 skipped\n"))[:2])

    def test_failed_cases(self):
        last, status, lines = tally(("fail", DOCTEST.format(3, 2, 1)),
                                    ("fail", "Ran 5 tests in 1s\n\nFAILED (failures=1, errors=1, skipped=1)\n"))
        self.assertEqual(("4 passed, 3 failed, 1 skipped", 1), (last, status))
        self.assertIn("FAILED  t0: 1 failed", lines)

    def test_death_after_a_good_summary_fails(self):
        self.assertEqual(("3 passed, 1 failed", 1), tally(("fail", DOCTEST.format(3, 3, 0)))[:2])

    def test_death_without_summary_and_missing_program_fail(self):
        self.assertEqual(("0 passed, 2 failed", 1),
                         tally(("fail", ""), ("notrun", "", "Unable to find executable"))[:2])

    def test_skipped_case_is_not_passed_and_says_why(self):
        last, status, lines = tally(("run", "SKIP window: no X server\n" + DOCTEST.format(3, 3, 0)))
        self.assertEqual(("2 passed, 0 failed, 1 skipped", 0), (last, status))
        self.assertIn("skipped t0: window: no X server", lines)

    def test_skipped_program(self):
        last, status, lines = tally(("run", DOCTEST.format(1, 1, 0)), ("notrun", "", "SKIP_RETURN_CODE=77"))
        self.assertEqual(("1 passed, 0 failed, 1 skipped", 0), (last, status))
        self.assertIn("skipped t1: t1: no reason given", lines)

    def test_nothing_passed_is_a_failure(self):
        self.assertEqual(1, tally(("notrun", "SKIP all: no GPU", "SKIP_RETURN_CODE=77"))[1])

    def test_last_summary_counts(self):
        self.assertEqual("1 passed, 0 failed", tally(("run", DOCTEST.format(9, 9, 0) + DOCTEST.format(1, 1, 0)))[0])


if __name__ == "__main__":
    unittest.main()
