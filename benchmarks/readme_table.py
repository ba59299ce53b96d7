"""Figures of a benchmark in results/NAME-INSTRUCTIONS.json, and their table between markers in benchmarks/README.md."""

import json
import os
import re
import sys

from record import compare, version_of

HERE = os.path.dirname(os.path.abspath(__file__))
README = os.path.join(HERE, "README.md")


def kept(name, instructions):
    """The figures as they are kept; nothing where there are none."""
    results = os.path.join(HERE, "results", f"{name}-{instructions}.json")
    if not os.path.exists(results):
        return {}
    with open(results, encoding="utf-8") as file:
        return json.load(file)


def study_of_parts(usage, name, parts, measured, table, instructions=None):
    """A script with the arguments [BUILD [PART ...]]: measures these parts, or all, and keeps them beside the others, or prints
    the table of the kept figures. measured(build, part) is what one part gave."""
    build, wanted = (sys.argv[1], sys.argv[2:] or list(parts)) if len(sys.argv) > 1 else (None, [])
    if set(wanted) - set(parts):
        sys.exit(usage)
    instructions = instructions or ("avx512" if build is None else compare.vector_instructions(build))
    result = kept(name, instructions)
    for part in wanted:
        made = {"feldspar_version": version_of(build), "flags": compare.flags(build), "processor": compare.processor()}
        result[part] = made | measured(build, part)
    keep_and_show(name, instructions, table, result if wanted else None)


def keep_and_show(name, instructions, table, result=None):
    """Keeps a new result as figures and as a table in the README, and prints the table of the kept figures. `table` makes
    its lines of a result."""
    results = os.path.join(HERE, "results", f"{name}-{instructions}.json")
    if result is not None:
        with open(results, "w", encoding="utf-8") as out:
            json.dump(result, out, indent=1)
            out.write("\n")
        with open(README, encoding="utf-8") as file:
            text = file.read()
        marked = re.compile(rf"(<!-- {name} {instructions} -->\n).*?(<!-- /{name} {instructions} -->)", re.DOTALL)
        if not marked.search(text):
            sys.exit(f"{README} has no place for the table of {instructions}; the figures are in {results}")
        text = marked.sub(lambda found: found[1] + table(result) + found[2], text)
        with open(README, "w", encoding="utf-8") as file:
            file.write(text)
    print(table(kept(name, instructions)), end="")
