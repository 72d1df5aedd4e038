#!/usr/bin/env python3
"""The published schema against an independent judge.

python3-jsonschema validates every good and every broken show; its verdict must be that of `cupola validate`,
except where a rule is beyond what a schema can say. Those are listed below by code, with the reason.

schema_test.py CUPOLA
"""
import json
import re
import subprocess
import sys
from pathlib import Path

from jsonschema import Draft202012Validator

ROOT = Path(__file__).resolve().parents[3]

# A file whose only problems have these codes is valid to the schema.
BEYOND_A_SCHEMA = {
    "CFG-006": "a key that stands twice is gone once the text has been parsed",
    "CFG-201": "a name that must be a key of another object",
    "CFG-202": "orientation excludes look_to only when it is not zero",
    "CFG-203": "numbers compared with their neighbours in a list",
    "CFG-204": "a vector that must not be zero, nor parallel to another",
    "CFG-205": "a sum of two values",
    "CFG-206": "equality of two values",
    "CFG-213": "a number of entries that another value gives",
}
# CFG-104 in most cases is a range of one value, but for:
BEYOND_BY_FILE = {"off_axis_outside.json": "the length of a vector",
                  "viewport_of_no_pixel.json": "a product of two values",
                  "unknown_key_endless.json": None}  # the schema sees it as an unknown key, as it should
# These texts never become values, so there is nothing to give to the schema. Python's parser refuses them too,
# but for two.
NOT_JSON = {"CFG-003", "CFG-004"}
PYTHON_ACCEPTS = {"overflow.json": "reads 1e400 as infinity", "lone_surrogate.json": "keeps half a character"}


def uncommented(text):
    """The text with comments blanked; strings are left alone."""
    token = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', re.S)
    return token.sub(lambda m: m.group() if m.group().startswith('"') else " ", text)


def value_of(path):
    """The parsed file, or None where Python too finds no JSON."""
    try:
        return json.loads(uncommented(path.read_bytes().decode("utf-8-sig")), parse_constant=lambda word: 1 / 0,
                          object_pairs_hook=lambda pairs: dict(reversed(pairs)))  # the first of two, as Cupola
    except (ValueError, ZeroDivisionError, UnicodeDecodeError):
        return None


def main(cupola):
    schema = json.loads(subprocess.run([cupola, "schema"], check=True, stdout=subprocess.PIPE).stdout)
    Draft202012Validator.check_schema(schema)
    judge = Draft202012Validator(schema)
    passed, failures = 0, []

    def verdict(path, wanted, why):
        nonlocal passed
        document = value_of(path)
        if document is None:
            failures.append(f"{path.name}: not JSON to Python")
            return
        errors = list(judge.iter_errors(document))
        if (not errors) == wanted:
            passed += 1
        else:
            failures.append(f"{path.name}: the schema says {'valid' if not errors else errors[0].message[:200]!r}, {why}")

    for path in sorted([*ROOT.glob("tests/configs/good/*.json"), *ROOT.glob("configs/shows/*.json")]):
        verdict(path, True, "but it is a good show")
    seen = set()
    for path in sorted(ROOT.glob("tests/configs/broken/*.json")):
        lines = path.with_suffix(".expected").read_text().splitlines()
        codes = {re.search(r"\[([A-Z]{3}-\d+)\]$", line).group(1) for line in lines if ": error: " in line}
        seen |= codes
        if codes & NOT_JSON:
            if (value_of(path) is None) == (path.name not in PYTHON_ACCEPTS):
                passed += 1
            else:
                failures.append(f"{path.name}: Python's parser disagrees")
        else:
            beyond = codes <= BEYOND_A_SCHEMA.keys() or BEYOND_BY_FILE.get(path.name)
            verdict(path, bool(beyond), f"but the loader says {sorted(codes)}")
    for code in sorted(BEYOND_A_SCHEMA.keys() - seen):
        failures.append(f"{code} is listed as beyond a schema, but no broken show has it")

    for failure in failures:
        print("FAILED", failure)
    print(f"{passed} passed, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
