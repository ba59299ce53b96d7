#!/usr/bin/env python3
"""Records of what a committed picture of examples/ or benchmarks/ was made, once it is made.

    scripts/record-picture.py PICTURE COMMAND RESULTS...

COMMAND made PICTURE; RESULTS are the committed files whose figures it shows. examples/pictures.json keeps their checksums,
and a test compares them: a picture does not stay when its results go on.
"""

import argparse
import hashlib
import json
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
RECORD = os.path.join(ROOT, "examples", "pictures.json")


def checksum(name):
    with open(os.path.join(ROOT, name), "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def from_root(name):
    inside = os.path.relpath(os.path.abspath(name), ROOT)
    if inside.startswith("..") or not os.path.isfile(name):
        sys.exit(f"{name}: no file of this tree")
    return inside


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=from_root)
    parser.add_argument("command")
    parser.add_argument("results", type=from_root, nargs="+")
    wanted = parser.parse_args()
    record = {}
    if os.path.exists(RECORD):
        with open(RECORD, encoding="utf-8") as file:
            record = json.load(file)
    record[wanted.picture] = {
        "command": wanted.command,
        "sha256": checksum(wanted.picture),
        "results": {name: checksum(name) for name in wanted.results},
    }
    with open(RECORD, "w", encoding="utf-8") as file:
        json.dump(dict(sorted(record.items())), file, indent=2)
        file.write("\n")


if __name__ == "__main__":
    main()
