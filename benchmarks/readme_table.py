"""Figures of a benchmark in results/NAME-INSTRUCTIONS.json, and their table between markers in benchmarks/README.md."""

import json
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
README = os.path.join(HERE, "README.md")


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
        with open(README, "w", encoding="utf-8") as file:
            file.write(marked.sub(lambda found: found[1] + table(result) + found[2], text))
    with open(results, encoding="utf-8") as file:
        print(table(json.load(file)), end="")
