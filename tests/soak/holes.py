#!/usr/bin/env python3
"""A closed room from random views, every projection, engine and sample count: not one pixel of background.

holes.py --bin FOLDER [--short] [--views N]
"""
import argparse
import os
import re
import subprocess
import sys
import time
from pathlib import Path

VIEWS, SHORT_VIEWS = 1000, 3


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--views", type=int)
    given = parser.parse_args()
    views = given.views or (SHORT_VIEWS if given.short else VIEWS)
    program = given.bin.parent / "tests" / "closed_room_test"
    started = time.monotonic()
    run = subprocess.run([str(program)], env={**os.environ, "CUPOLA_VIEWS": str(views)}, capture_output=True,
                         text=True)
    print(run.stdout[-6000:])
    summary = re.search(r"assertions:\s*(\d+) \|\s*(\d+) passed \|\s*(\d+) failed", run.stdout)
    if run.returncode != 0 or summary is None or int(summary[3]) > 0:
        print("holes: FAILED\n" + run.stderr[-2000:])
        return 1
    print(f"holes: {views} views a way, {summary[1]} checks, none failed, {time.monotonic() - started:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
