#!/usr/bin/env python3
"""Writes the tables of pages from committed results.

    scripts/write-tables.py           writes each table between <!-- table: NAME --> and <!-- /table -->
    scripts/write-tables.py --check   fails, with the rows, where a page is not as this script writes it

scripts/tables/ has for each NAME a function from the cells of a row of the page to what they ought to be. The first cells say
what the row shows and stay, as the heading does and each cell for which the function has None or nothing. Values are "mean ±
standard deviation" over tests, or a single one.
"""

import glob
import os
import re
import sys

sys.dont_write_bytecode = True

from tables import benchmarks, grains, samples
from tables.values import ROOT

TABLES = grains.TABLES | samples.TABLES | benchmarks.TABLES
PAGES = ("docs/*.md", "examples/*/README.md", "benchmarks/*.md")
MARKED = re.compile(r"<!-- table: (?P<name>.+?) -->\n(?P<rows>(?:\|.*\n)+)<!-- /table -->")
BY_HEADING = re.compile(rf"^(?P<rows>(?P<name>{'|'.join(map(re.escape, benchmarks.TABLES))})(?:.*\n)(?:\|.*\n)+)",
                        re.MULTILINE)


def row(name, line):
    cells = line[1:-1].split("|")
    new = list(TABLES[name]([cell.strip() for cell in cells]))[: len(cells)]
    new += [None] * (len(cells) - len(new))
    return "|" + "|".join(old if cell in (None, old.strip()) else f" {cell} " for cell, old in zip(new, cells)) + "|"


def written(page, used):
    def table(match):
        used.append(match["name"])
        heading, rule, *lines = match["rows"].splitlines()
        rows = "\n".join((heading, rule, *(row(match["name"], line) for line in lines))) + "\n"
        return match[0].replace(match["rows"], rows)

    return MARKED.sub(table, page) if "<!-- table: " in page else BY_HEADING.sub(table, page)


def main():
    used, different = [], []
    for path in sorted(path for pattern in PAGES for path in glob.glob(os.path.join(ROOT, pattern))):
        with open(path, encoding="utf-8") as file:
            page = file.read()
        text = written(page, used)
        for old, new in zip(page.splitlines(), text.splitlines()):
            if old != new:
                different.append(f"{os.path.relpath(path, ROOT)}: {old}\n  -> {new}")
        if text != page and "--check" not in sys.argv:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
    if sorted(used) != sorted(TABLES):
        sys.exit(f"no page has {sorted(set(TABLES) - set(used))}, or several have one table")
    print("\n".join(different))
    if different and "--check" in sys.argv:
        sys.exit("tables are not those of the committed results: run scripts/write-tables.py")


if __name__ == "__main__":
    main()
