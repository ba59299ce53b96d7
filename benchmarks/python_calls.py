#!/usr/bin/env python3
"""Calls of the Python module beside the same calls from C++, in one run on one core.

    python3 benchmarks/python_calls.py BUILD                  measures, and writes the table in the README
    python3 benchmarks/python_calls.py --table INSTRUCTIONS   prints the table of the committed figures

INSTRUCTIONS: avx2 or avx512, of the processor; the figures are in benchmarks/results/python-INSTRUCTIONS.json.

BUILD: a build folder with FELDSPAR_BENCHMARKS=ON and FELDSPAR_PYTHON=ON. Least processor times over several rounds; half a minute.
The load average stands beside the figures: other work takes caches and clock rate.
"""

import datetime
import json
import os
import subprocess
import sys
import time

import readme_table

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "scripts"))
compare = __import__("compare-speed")


def least(rounds, calls, call):
    """Returns the least time of a call over several rounds [s]."""
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        for _ in range(calls):
            call()
        times.append((time.process_time() - begin) / calls)
    return min(times)


def from_python():
    import feldspar
    import numpy

    feldspar.set_threads(1)
    cell = feldspar.Input({"Specimen/Shape": "periodic", "Specimen/Width": "10 mm", "Specimen/Height": "10 mm"})
    rve = feldspar.Rve(cell)
    strain = numpy.array([0.0, 1e-5, 0.0])
    volumes = feldspar.Volumes(cell, 10000)
    strains = numpy.tile(strain, (10000, 1))
    rock = feldspar.Input({"Specimen/Width": "20 mm", "Specimen/Height": "40 mm"})
    body = feldspar.Specimen(rock)

    def batch(tangent):
        # Each outcome that is not built on is kept: as of a solver, a new state is accepted now and then.
        return lambda: volumes.update(strains, 0, tangent)

    test = body.test("uniaxial_compression").run()
    each = lambda test: test.stress < 0

    return {
        "scalar trial": least(20, 2000, lambda: rve.trial(strain).stress),
        "10000 volumes": least(20, 5, batch(False)),
        "10000 volumes with tangents": least(20, 5, batch(True)),
        "test": least(5, 1, lambda: body.test("uniaxial_compression").run()),
        f"callback after each of its {test.n_rows} rows": least(20, 500, lambda: each(test)),
    }


def table(result):
    lines = ["| call | from C++ | from Python |", "|---|---|---|"]
    for name, python in result["python"].items():
        cpp = result["cpp"].get(name)
        scale, unit = (1e6, "µs") if python < 1e-4 else (1e3, "ms")
        lines.append(f"| {name} | {'–' if cpp is None else f'{scale * cpp:.2f} {unit}'} | {scale * python:.2f} {unit} |")
    load = f", load average {result['load_average']}" if "load_average" in result else ""
    lines += ["", f"{result['processor']}, one core, {result['date']}, Feldspar {result['feldspar_version']}{load}."]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--table":
        readme_table.keep_and_show("python", sys.argv[2], table)
        return
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    build = sys.argv[1]
    sys.path.insert(0, os.path.join(build, "python"))
    program = os.path.join(build, "benchmarks", "library_calls")
    result = {
        "feldspar_version": compare.version(build),
        "processor": compare.processor(),
        "date": datetime.date.today().isoformat(),
        "cpp": json.loads(subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout),
        "python": from_python(),
        "load_average": round(os.getloadavg()[0], 1),
    }
    readme_table.keep_and_show("python", compare.vector_instructions(build), table, result)


if __name__ == "__main__":
    main()
