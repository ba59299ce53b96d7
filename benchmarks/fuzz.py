#!/usr/bin/env python3
"""Fuzzes the readers of files from outside and keeps how many inputs each was given.

    python3 benchmarks/fuzz.py                            # an hour of a core over all readers; writes results/fuzz.json
    python3 benchmarks/fuzz.py 600 rock variants          # ten minutes over these two
    python3 benchmarks/fuzz.py 600 rock --file FILE       # the same into FILE

The run itself is scripts/fuzz.sh, which builds the preset `asan` of this work tree. A work tree with changes is refused,
for the figures name a commit. All readers in a file are of one run of one build: a run over some of them needs --file.
"""

import argparse
import datetime
import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
compare = __import__("compare-speed")


def git(*words):
    return subprocess.run(["git", *words], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()


def statistic(log, name):
    """Returns a number of the statistics that libFuzzer prints at its end; none where it ended before."""
    found = re.search(rf"^stat::{name}: *(\d+)", log, re.MULTILINE)
    return int(found[1]) if found else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", nargs="?", type=int, default=3600, help="of all readers together")
    parser.add_argument("readers", nargs="*")
    parser.add_argument("--file", default=os.path.join(HERE, "results", "fuzz.json"))
    wanted = parser.parse_args()
    if wanted.readers and wanted.file == parser.get_default("file"):
        parser.error("the committed figures are of all readers: name another --file")
    if git("status", "--porcelain", "--untracked-files=no"):
        sys.exit("the work tree has changes that are in no commit: commit, and fuzz that")
    commit = git("rev-parse", "--short", "HEAD")
    readers = wanted.readers or sorted(os.listdir(os.path.join(ROOT, "tests", "fuzz", "corpus")))
    script = os.path.join(ROOT, "scripts", "fuzz.sh")
    # The script tells by its exit code too whether it found anything; the figures are written either way.
    ended = subprocess.run([script, str(wanted.seconds), *readers], check=False).returncode
    if git("rev-parse", "--short", "HEAD") != commit:
        sys.exit("the work tree has gone to another commit meanwhile")
    results = {}
    for reader in readers:
        with open(os.path.join(ROOT, "build", "fuzz", reader + ".log"), encoding="utf-8", errors="replace") as file:
            log = file.read()
        inputs = statistic(log, "number_of_executed_units")
        if inputs is None:
            sys.exit(f"reader {reader}: build/fuzz/{reader}.log has no number of inputs")
        results[reader] = {"inputs": inputs, "found": len(re.findall(r"^artifact_prefix=", log, re.MULTILINE))}
    result = {
        "feldspar_version": compare.version(os.path.join(ROOT, "build", "asan")),
        "date": datetime.date.today().isoformat(),
        "machine": compare.processor(),
        "sanitizers": "address, undefined",
        "seconds": wanted.seconds,
        "seconds_limit_of_an_input": 60,
        "readers": results,
        "inputs": sum(one["inputs"] for one in results.values()),
    }
    with open(wanted.file, "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    sys.exit(ended)


main()
