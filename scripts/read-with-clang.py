#!/usr/bin/env python3
"""Has clang read what no other build gives it, finite elements, reports and the command among it, and makes no code of it:
that takes some two minutes of a core, a build ten times as long. Warnings are errors.

    scripts/read-with-clang.py BUILD BUILT    of two folders configured for clang: BUILD has everything, of which BUILT has
                                              compiled a part
"""
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys


def reading(command):
    """The command that compiles a unit, without its output, its sanitizers and precompiled headers."""
    words = shlex.split(command)
    words = words[next(k for k, word in enumerate(words) if re.search(r"clang\+\+[^/]*$", word)):]
    kept = []
    skip = 0
    for k, word in enumerate(words):
        if skip:
            skip -= 1
        elif word in ("-o", "-MT", "-MF"):
            skip = 1
        elif word == "-Xclang" and words[k + 1] == "-include-pch":
            skip = 3
        elif word != "-MD" and not re.match(r"-f(no-)?sanitize", word):
            kept.append(word)
    long_page = "-Wno-overlength-strings"  # the page's template is one string
    return kept + ["-fsyntax-only", "-Werror", long_page]


def output_of(command):
    words = shlex.split(command)
    return words[words.index("-o") + 1]


def read(entry):
    done = subprocess.run(reading(entry["command"]), cwd=entry["directory"], capture_output=True, text=True,
                          errors="replace")
    return done.returncode, done.stderr


def main(build, built):
    with open(os.path.join(build, "compile_commands.json")) as file:
        units = json.load(file)
    left = [unit for unit in units if not os.path.exists(os.path.join(built, output_of(unit["command"])))]
    if not left:
        sys.exit(f"{build}: no unit is left to be read")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as readers:
        results = list(readers.map(read, left))
    for code, words in results:
        if code != 0:
            print(words, file=sys.stderr)
    print(f"{len(left)} units read, {sum(code != 0 for code, _ in results)} with faults")
    return any(code != 0 for code, _ in results)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
