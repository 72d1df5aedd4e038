#!/usr/bin/env python3
"""Counts the test cases behind a CTest JUnit file and prints "N passed, N failed[, N skipped]" last.

A program's own summary is believed where it has one (doctest, unittest, node --test, or a last line in the form
above); without one the program counts as one test. Lines "SKIP NAME: REASON" of a program are skipped cases: they
are repeated before the last line and not counted as passed. Exit status 1 unless something passed and nothing
failed.
"""
import re
import sys
import xml.etree.ElementTree as ElementTree
from typing import NamedTuple


class Count(NamedTuple):
    passed: int
    failed: int
    skipped: int


OURS = re.compile(r"^(\d+) passed, (\d+) failed(?:, (\d+) skipped)?\s*$", re.M)
DOCTEST = re.compile(r"test cases:\s*\d+ \|\s*(\d+) passed \|\s*(\d+) failed")
UNITTEST = re.compile(r"^Ran (\d+) tests? in .*\n\n(?:OK|FAILED)(?: \((.*)\))?$", re.M)
NODE = re.compile(r"^(?:#|ℹ) (pass|fail|skipped) (\d+)\s*$", re.M)
SKIP = re.compile(r"^SKIP (\S.*)$", re.M)
COLOUR = re.compile(r"\x1b\[[0-9;]*m")


def own_summary(text):
    """What the program says of itself, or None. Of several summaries of one form the last one counts."""
    if found := OURS.findall(text):
        return Count(*(int(number or 0) for number in found[-1]))
    if found := DOCTEST.findall(text):
        return Count(int(found[-1][0]), int(found[-1][1]), 0)
    if found := UNITTEST.findall(text):
        total, details = int(found[-1][0]), dict(re.findall(r"(\w+)=(\d+)", found[-1][1]))
        failed = int(details.get("failures", 0)) + int(details.get("errors", 0))
        skipped = int(details.get("skipped", 0))
        return Count(total - failed - skipped, failed, skipped)
    found = dict(NODE.findall(text))
    if "pass" in found:
        return Count(int(found["pass"]), int(found.get("fail", 0)), int(found.get("skipped", 0)))
    return None


def count_program(status, text):
    """Counts of one CTest entry. status: "run", "fail" or "notrun", as CTest writes it."""
    text = COLOUR.sub("", text)
    reasons = SKIP.findall(text)
    summary = own_summary(text)
    if status == "notrun":
        return (Count(0, 0, max(1, len(reasons))), reasons) if reasons else (Count(0, 1, 0), [])
    if summary is None:
        if status == "fail":
            return Count(0, 1, len(reasons)), reasons
        return Count(0 if reasons else 1, 0, len(reasons)), reasons
    passed, failed, skipped = summary
    told = max(0, len(reasons) - skipped)  # skipped cases that the framework counted as passed
    passed, skipped = max(0, passed - told), skipped + told
    if status == "fail" and failed == 0:
        failed = 1  # died after its summary, timed out, or a sanitizer spoke at exit
    return Count(passed, failed, skipped), reasons


def main(path):
    passed = failed = skipped = 0
    failures, skips = [], []
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        name, status = case.get("name"), case.get("status")
        text = case.findtext("system-out") or ""
        element = case.find("skipped")
        if status == "notrun" and element is not None and "SKIP_RETURN_CODE" in (element.get("message") or ""):
            text += "" if SKIP.search(text) else f"\nSKIP {name}: no reason given"
        count, reasons = count_program(status, text)
        passed, failed, skipped = passed + count.passed, failed + count.failed, skipped + count.skipped
        skips += [f"{name}: {reason}" for reason in reasons]
        if count.failed:
            failures.append(f"{name}: {count.failed} failed")
    for line in skips:
        print("skipped", line)
    for line in failures:
        print("FAILED ", line)
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
