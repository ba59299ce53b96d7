#!/usr/bin/env python3
"""Has clang read what no other build gives it, finite elements, reports and the command among it, and makes no code of it:
that takes some two minutes of a core, a build ten times as long. Warnings are errors.

    scripts/read-with-clang.py BUILD BUILT    of two folders configured for clang: BUILD has everything, of which BUILT has
                                              compiled a part
"""
import concurrent.futures
import functools
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile


def reading(command, folder):
    """The command that compiles a unit, without its output, its sanitizers and what else only code needs. Headers that it has
    precompiled are those that read() has left in `folder`."""
    words = shlex.split(command)
    words = words[next(k for k, word in enumerate(words) if re.search(r"clang\+\+[^/]*$", word)):]
    kept = []
    skip = 0
    for k, word in enumerate(words):
        if skip:
            skip -= 1
        elif word in ("-o", "-MT", "-MF"):
            skip = 1
        elif word.endswith(".pch"):
            kept.append(in_folder(word, folder))
        elif word != "-MD" and not re.match(r"-f(no-)?sanitize", word):
            kept.append(word)
    long_page = "-Wno-overlength-strings"  # the page's template is one string
    return kept + ["-Werror", long_page]


def in_folder(path, folder):
    return os.path.join(folder, os.path.abspath(path).replace("/", "_"))


def output_of(command):
    words = shlex.split(command)
    return words[words.index("-o") + 1]


def is_of_headers(entry):
    return output_of(entry["command"]).endswith(".pch")


def read(entry, folder):
    """Headers come out precompiled, of other units nothing."""
    if is_of_headers(entry):
        path = os.path.join(entry["directory"], output_of(entry["command"]))
        made = ["-o", in_folder(path, folder)]
    else:
        made = ["-fsyntax-only"]
    done = subprocess.run(reading(entry["command"], folder) + made, cwd=entry["directory"], capture_output=True, text=True,
                          errors="replace")
    return done.returncode, done.stderr


def main(build, built):
    with open(os.path.join(build, "compile_commands.json")) as file:
        units = json.load(file)
    left = [
        unit
        for unit in units
        if is_of_headers(unit) or not os.path.exists(os.path.join(built, output_of(unit["command"])))
    ]
    if all(is_of_headers(unit) for unit in left):
        sys.exit(f"{build}: no unit is left to be read")
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as readers:
        results = []
        for of_headers in (True, False):
            of_kind = [unit for unit in left if is_of_headers(unit) == of_headers]
            results += readers.map(functools.partial(read, folder=folder), of_kind)
    for code, words in results:
        if code != 0:
            print(words, file=sys.stderr)
    print(f"{len(left)} units read, {sum(code != 0 for code, _ in results)} with faults")
    return any(code != 0 for code, _ in results)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
