#!/usr/bin/env python3
"""Whole laboratory tests by Feldspar and by plain scalar code on the same discs, in one run.

    python3 benchmarks/plain.py BUILD [TIMES]          runs them in turns, TIMES (5) times, and writes the table in the README
    python3 benchmarks/plain.py --table INSTRUCTIONS   prints the table of the committed figures

INSTRUCTIONS: avx2 or avx512, of the processor; the figures are in benchmarks/results/plain-INSTRUCTIONS.json.
BUILD: a build folder with FELDSPAR_BENCHMARKS=ON, of a commit. Processor time on one core, some ten minutes.
"""

import datetime
import json
import os
import statistics
import subprocess
import sys
import tempfile

import readme_table

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "scripts"))
compare = __import__("compare-speed")

# Width [mm] of a body twice as high, of Beishan granite; tests, and the strain [1] up to which they go if not to their end.
INTACT = ("direct_tension", "1e-4")
TESTS = {10: [INTACT], 50: [INTACT, ("direct_tension",), ("uniaxial_compression",)], 80: [INTACT]}


def measured(build, times):
    result = {
        "feldspar_version": compare.version(build),
        "flags": compare.flags(build),
        "processor": compare.processor(),
        "date": datetime.date.today().isoformat(),
        "tests": [],
    }
    with tempfile.TemporaryDirectory() as folder:
        for width, tests in TESTS.items():
            rock = os.path.join(folder, "rock.prm")
            with open(rock, "w", encoding="utf-8") as file:
                file.write(f"subsection Specimen\n  set Width = {width} mm\n  set Height = {2 * width} mm\nend\n")
            specimen = [os.path.join(build, "app/feldspar"), "specimen", rock, "--output", folder, "--force", "--quiet"]
            subprocess.run(specimen, check=True, stdout=subprocess.DEVNULL)
            for name, *strain in tests:
                program = os.path.join(build, "benchmarks/laboratory_benchmark")
                command = [program, os.path.join(folder, "specimen.h5"), name, times, *strain]
                ended = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
                result["tests"].append(json.loads(ended.stdout))
                print(ended.stdout, end="", flush=True)
    return result


def table(result):
    lines = [
        "| test | discs, joints | steps | strain | Feldspar [ns a joint and step] | plain code | plain over Feldspar: least, median |",
        "|---|---|---|---|---|---|---|",
    ]
    for test in result["tests"]:
        n = 1e-9 * test["steps"] * test["joints"]
        pairs = list(zip(test["processor_s"], test["plain_processor_s"]))
        ratios = [plain / own for own, plain in pairs]
        own, plain = (min(times) / n for times in zip(*pairs))
        what = test["test"].replace("_", " ") + (", intact" if test["cracks"] == 0 else ", to its end")
        lines.append(
            f"| {what} | {test['grains']}, {test['joints']} | {test['steps']} | {test['strain']:.3g} | {own:.1f} | {plain:.1f} | "
            f"{min(ratios):.2f}, {statistics.median(ratios):.2f} |"
        )
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    if sys.argv[1] == "--table":
        readme_table.keep_and_show("plain", sys.argv[2], table)
    else:
        result = measured(sys.argv[1], (sys.argv[2:] or ["5"])[0])
        readme_table.keep_and_show("plain", compare.vector_instructions(sys.argv[1]), table, result)


if __name__ == "__main__":
    main()
