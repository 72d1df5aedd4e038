#!/usr/bin/env python3
"""Files made from the parameter table. generated.json says which program writes which file.

generated.py BIN           exit 1 where a checked-in file is not what the programs in BIN print now
generated.py --write BIN   writes them (`./dev docs`)
generated.py --table       prints the table of include directions for docs/ARCHITECTURE.md
"""
import difflib
import json
import subprocess
import sys
from pathlib import Path

import rules

ROOT = Path(__file__).resolve().parents[2]


def printed(bin_folder, command):
    program, *arguments = command
    return subprocess.run([str(Path(bin_folder, program)), *arguments], cwd=ROOT, check=True, text=True,
                          stdout=subprocess.PIPE).stdout


def main(arguments):
    if arguments == ["--table"]:
        print(rules.table_of_directions(json.loads((ROOT / rules.HOUSE).read_text())), end="")
        return 0
    write = arguments[0] == "--write"
    passed = failed = 0
    for entry in json.loads((ROOT / "tests/structure/generated.json").read_text()):
        path, text = ROOT / entry["file"], printed(arguments[-1], entry["command"])
        old = path.read_text() if path.exists() else ""
        if old == text:
            passed += 1
        elif write:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
            print("written:", entry["file"])
        else:
            failed += 1
            sys.stdout.writelines(difflib.unified_diff(old.splitlines(True), text.splitlines(True),
                                                       entry["file"], " ".join(entry["command"]), n=1))
            print(f"{entry['file']} is stale: ./dev docs writes it")
    if not write:
        print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
