#!/usr/bin/env python3
"""Compares two builds of the program bit by bit.

    scripts/compare-bits.py OLD NEW [--keep FOLDER] [--expect KEY ...] [--only NAME ...]

OLD and NEW: a built `feldspar` each, or the folder of results that an earlier comparison kept of one. Each input of
scripts/bits is run by both (the first word of its name is the command): ten seeds of laboratory tests, of paths of
representative volumes by both solvers and of samples, smaller pieces in space, and a calibration. Compared are all numbers
and words of summary.json, calibration.json, curves/*.csv, cracks.csv and grains/*.csv. Numbers are written so that they
can be read back to the last bit, so equal text is equal bits.

What NEW has beyond OLD, a column, a key or an entry, is named and allowed; anything that is gone or different is a
difference, but for versions, machines and times (MAY_DIFFER). Renamed keys and columns (RENAMED) are compared as one, and
so are records of summary.json that stand in the same order under other names, with their files.

--keep FOLDER    leaves the results in FOLDER/old and FOLDER/new, which can stand for the builds the next time
--expect KEY     a key or column that is to be different, for a reason that the caller knows; it is counted apart
--only NAME      of the inputs, those whose name begins so

Exit code 0: equal; 1: not. Takes a minute or two of one processor for each build.
"""

import argparse
import collections
import csv
import glob
import io
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

INPUTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bits")

# The only keys that may differ from build to build: who made a result, where and in how much time.
MAY_DIFFER = {
    "feldspar_version",
    "commit",
    "host",
    "wall_time_s",
    "seconds_in_points",
    "mean_s",
    "longest_s",
    "longest_unmoved_s",
    "schema_version",
}

# Keys and columns of layout 1 of summary.json, by their names of today.
RENAMED = {"volumes": "rves", "volume": "rve"}


def run(feldspar, name, folder):
    """The exit code of one input's run, which is part of the result: some specimens have no result, and that is one."""
    environment = dict(os.environ)
    with tempfile.TemporaryDirectory() as without_figures:
        gnuplot = os.path.join(without_figures, "gnuplot")  # pictures are not compared and would take most of the time
        with open(gnuplot, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\nexit 1\n")
        os.chmod(gnuplot, 0o755)
        environment["PATH"] = without_figures + os.pathsep + environment["PATH"]
        environment |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "HWLOC_COMPONENTS": "-gl"}
        command = ["nice", feldspar, name.split("-")[0], os.path.join(INPUTS, name + ".prm")]
        outcome = subprocess.run(
            command + ["--output", folder, "--force", "--quiet", "--threads", "1"],
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    if not os.path.exists(os.path.join(folder, "summary.json")):
        sys.exit(f"{name}: {feldspar} left no results: {outcome.stderr.strip()}")
    with open(os.path.join(folder, "exit-code.json"), "w", encoding="utf-8") as file:
        json.dump({"exit_code": outcome.returncode}, file)


def results_of(build, names, into):
    """The folder with the results of one build, run if it is a program."""
    if os.path.isdir(build):
        return build
    if not os.access(build, os.X_OK):
        sys.exit(f"{build}: neither a program nor a folder of results")
    for name in names:
        run(os.path.realpath(build), name, os.path.join(into, name))
    return into


def entries(value, path=()):
    """(path, value) of all that a JSON holds. Records with a name go by it, so that their order does not matter."""
    if isinstance(value, dict):
        for key, part in value.items():
            if key not in MAY_DIFFER:
                yield from entries(part, path + (RENAMED.get(key, key),))
    elif isinstance(value, list):
        for k, part in enumerate(value):
            name = part.get("name", k) if isinstance(part, dict) else k
            yield from entries(part, path + (name,))
    else:
        yield path, repr(value)


def names_of(folder):
    """The names of records and of their groups in a summary, in their order."""

    def walk(value):
        if isinstance(value, dict):
            yield from (value[key] for key in ("name", "group") if isinstance(value.get(key), str))
            value = list(value.values())
        if isinstance(value, list):
            for part in value:
                yield from walk(part)

    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return list(dict.fromkeys(walk(json.load(file))))


def renaming(old_folder, new_folder):
    """Turns text with the names of old records into text with those of the new ones, if there are as many."""
    old, new = names_of(old_folder), names_of(new_folder)
    if old == new or len(old) != len(new):
        return lambda text: text
    names = dict(zip(old, new))
    any_name = re.compile(r"(?<!\w)(" + "|".join(re.escape(name) for name in old) + r")(?!\w)")
    return lambda text: any_name.sub(lambda match: names[match[1]], text)


def values_of(file, rename=lambda text: text):
    """{where: text} of a file, with a column's or key's name as the last part of where."""
    with open(file, encoding="utf-8") as opened:
        text = rename(opened.read())
        if file.endswith(".json"):
            return dict(entries(json.loads(text)))
        rows = csv.reader(io.StringIO(text))
        names = [RENAMED.get(name, name) for name in next(rows)]
        return {(row, name): cell for row, cells in enumerate(rows) for name, cell in zip(names, cells)}


def relative_difference(old, new):
    try:
        a, b = float(old), float(new)
    except ValueError:
        return math.inf
    return abs(a - b) / max(abs(a), abs(b)) if a != b else 0.0


def key_of(where):
    """The last word of a place in a file."""
    return next((part for part in reversed(where) if isinstance(part, str)), "")


class Comparison:
    def __init__(self, expected):
        self.expected = expected
        self.n_files = 0
        self.n_values = 0
        self.different = {}  # of each file and key: how many, and the largest relative difference
        self.n_expected = collections.Counter()
        self.new_keys = collections.Counter()

    def add(self, label, old, new):
        self.n_files += 1
        for where, text in old.items():
            self.n_values += 1
            if new.get(where) == text:
                continue
            key = key_of(where)
            if key in self.expected:
                self.n_expected[key] += 1
                continue
            count, largest = self.different.get((label, key), (0, 0.0))
            off = relative_difference(text, new[where]) if where in new else math.inf
            self.different[label, key] = (count + 1, max(largest, off))
        old_rows = {where[0] for where in old}
        for where in new.keys() - old.keys():
            # A row more is a difference, a column more is none.
            if isinstance(where[0], int) and where[0] not in old_rows:
                count, _ = self.different.get((label, "more rows"), (0, 0.0))
                self.different[label, "more rows"] = (count + 1, math.inf)
            else:
                self.new_keys[key_of(where)] += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--keep")
    parser.add_argument("--expect", nargs="+", default=[])
    parser.add_argument("--only", nargs="+", default=[""])
    wanted = parser.parse_args()

    names = sorted(os.path.basename(file)[:-4] for file in glob.glob(os.path.join(INPUTS, "*.prm")))
    names = [name for name in names if name.startswith(tuple(wanted.only))]
    work = wanted.keep or tempfile.mkdtemp(prefix="compare-bits-")
    old_results = results_of(wanted.old, names, os.path.join(work, "old"))
    new_results = results_of(wanted.new, names, os.path.join(work, "new"))

    whole = Comparison(set(wanted.expect))
    for name in names:
        part = Comparison(whole.expected)
        folders = [os.path.join(results, name) for results in (old_results, new_results)]
        files = []
        for pattern in ("summary.json", "calibration.json", "exit-code.json", "cracks.csv", "steps.csv", "curves/*.csv", "grains/*.csv"):
            files += sorted(os.path.relpath(file, folders[0]) for file in glob.glob(os.path.join(folders[0], pattern)))
        if "summary.json" not in files:
            sys.exit(f"{folders[0]}: no results")
        rename = renaming(*folders)
        for file in files:
            old, new = os.path.join(folders[0], file), os.path.join(folders[1], rename(file))
            part.add(f"{name}/{file}", values_of(old, rename), values_of(new) if os.path.exists(new) else {})
        n_different = sum(count for count, _ in part.different.values())
        print(f"{name}: {part.n_files} files, {part.n_values} values, {n_different} different")
        whole.n_files += part.n_files
        whole.n_values += part.n_values
        whole.different |= part.different
        whole.n_expected += part.n_expected
        whole.new_keys += part.new_keys

    for (label, key), (count, largest) in whole.different.items():
        by = "not in both, or not a number" if math.isinf(largest) else f"by at most {largest:.1e}"
        print(f"  {label}: {key}: {count} different, {by}")
    for key, count in whole.n_expected.items():
        print(f"  expected to differ: {key}: {count}")
    for key, count in sorted(whole.new_keys.items()):
        print(f"  only in the new one: {key}: {count}")
    print(f"{whole.n_files} files, {whole.n_values} values: {'not all equal' if whole.different else 'all equal'}")
    if not wanted.keep:
        shutil.rmtree(work)
    sys.exit(1 if whole.different else 0)


if __name__ == "__main__":
    main()
