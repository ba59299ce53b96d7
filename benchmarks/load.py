#!/usr/bin/env python3
"""Large bodies and long programmes by the command as a user runs it: time and memory.

    python3 benchmarks/load.py build/release/app/feldspar                 # all; writes results/load.json; half an hour
    python3 benchmarks/load.py build/release/app/feldspar discs           # one of discs, spheres, variants
    python3 benchmarks/load.py build/release/app/feldspar --share 0.01    # all, smaller by this factor; writes nothing

discs:    10⁶ discs, on a lattice from a packing file, some hundred steps of direct tension
spheres:  400 000 spheres, the same
variants: 1 000 variants of a small rock in one input, each pulled; the report on all of them

For each: seconds by the clock and of the processor, the peak of the memory, and what the program foresaw of both before
it began.
"""

import datetime
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time

from on_ranks import committed_version

HERE = os.path.dirname(os.path.abspath(__file__))
RESULT = os.path.join(HERE, "results", "load.json")
RADIUS = 0.62e-3  # [m]
# Gap up to which neighbours on the lattice get a face: a hundredth of the radius is more than their gaps.
GAP = 0.02


def number(k):
    """Returns a number of a fixed scatter, in [0, 1)."""
    return math.modf(math.sin(12.9898 * (k + 1)) * 43758.5453)[0] % 1.0


def discs(path, n):
    """Hexagonal rows; returns width and height [m]."""
    across = math.isqrt(n)
    width = (across + 0.5) * 2 * RADIUS
    rise = math.sqrt(3.0) * RADIUS
    up = n // across
    with open(path, "w", encoding="ascii") as file:
        for k in range(across * up):
            i, j = k % across, k // across
            radius = RADIUS * (1.0 - 0.01 * number(k))
            file.write(f"{(2 * i + 1 + j % 2) * RADIUS:.9g} {RADIUS + j * rise:.9g} {radius:.9g}\n")
    return width, RADIUS * 2 + (up - 1) * rise


def spheres(path, n):
    """Face-centred cubic: layers of squares, every other one shifted; returns width and height [m]."""
    side = round((n / math.sqrt(2.0)) ** (1 / 3))
    rise = math.sqrt(2.0) * RADIUS
    up = n // side**2
    with open(path, "w", encoding="ascii") as file:
        for k in range(side * side * up):
            i, j, layer = k % side, k // side % side, k // side**2
            radius = RADIUS * (1.0 - 0.01 * number(k))
            x, y = ((2 * m + 1 + layer % 2) * RADIUS for m in (i, j))
            file.write(f"{x:.9g} {y:.9g} {RADIUS + layer * rise:.9g} {radius:.9g}\n")
    return (side + 0.5) * 2 * RADIUS, RADIUS * 2 + (up - 1) * rise


def lattice_input(dimension, width, height):
    return f"""subsection Specimen
  set Dimension    = {dimension}
  set Width        = {1e3 * width:.9g} mm
  set Height       = {1e3 * height:.9g} mm
  set Packing file = packing.txt
end
subsection Flat joint
  set Coordination number    = none
  set Installation gap ratio = {GAP}
end
subsection Tests
  set List                    = direct_tension
  set Tension sampling strain = 1e-6
  set Stop strain             = 4e-6
end
"""


def variants_input(n):
    rates = "; ".join(f"{0.328 * (1 + k / n):.6g} 1/s" for k in range(n))
    return f"""subsection Specimen
  set Width  = 8 mm
  set Height = 12 mm
end
subsection Tests
  set List        = direct_tension
end
subsection Variants
  set Entry  = Tests/Tension strain rate
  set Values = {rates}
end
"""


def run(arguments, folder):
    """Words on the screen, seconds by the clock and of the processor, and the peak of the memory of the process [bytes]."""
    begin = time.monotonic()
    with open(os.path.join(folder, "screen.txt"), "w+", encoding="utf-8") as screen:
        process = subprocess.Popen(arguments, cwd=folder, stdout=screen, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - begin
        screen.seek(0)
        words = screen.read()
    if process.returncode != 0:
        sys.exit(f"{' '.join(arguments)}: exit code {process.returncode}\n{words[-2000:]}")
    return words, {
        "seconds": round(seconds, 1),
        "processor_seconds": round(usage.ru_utime + usage.ru_stime, 1),
        "peak_bytes": 1024 * usage.ru_maxrss,
    }


def foreseen(words):
    """The lines in which the program says before its work what this will take."""
    return [line.strip() for line in words.splitlines() if re.search(r"about [0-9.]+ (MB|GB)", line)]


def size_of(folder):
    return sum(os.path.getsize(os.path.join(where, name)) for where, _, names in os.walk(folder) for name in names)


def tests_of(folder):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def lattice(feldspar, dimension, make, n):
    with tempfile.TemporaryDirectory(prefix="load-") as folder:
        width, height = make(os.path.join(folder, "packing.txt"), n)
        with open(os.path.join(folder, "large.prm"), "w", encoding="utf-8") as file:
            file.write(lattice_input(dimension, width, height))
        words, result = run([feldspar, "lab", "large.prm", "--output", "out"], folder)
        summary = tests_of(os.path.join(folder, "out"))
        test = summary["tests"][0]
        return (
            {"grains": test["n_grains"], "joints": test["n_joints"], "steps": test["steps"]}
            | result
            | {"bytes_per_grain": round(result["peak_bytes"] / test["n_grains"])}
            | {"foreseen": foreseen(words), "folder_bytes": size_of(os.path.join(folder, "out"))}
        ), summary["host"]


def variants(feldspar, n):
    with tempfile.TemporaryDirectory(prefix="load-") as folder:
        with open(os.path.join(folder, "many.prm"), "w", encoding="utf-8") as file:
            file.write(variants_input(n))
        words, result = run([feldspar, "lab", "many.prm", "--output", "out"], folder)
        out = os.path.join(folder, "out")
        summary = tests_of(out)
        parts = {
            part: size_of(os.path.join(out, part)) for part in sorted(os.listdir(out)) if os.path.isdir(os.path.join(out, part))
        }
        page = os.path.getsize(os.path.join(out, "report.html"))
        _, report = run([feldspar, "report", "out"], folder)
        return (
            {"variants": n, "tests": len(summary["tests"]), "steps": sum(test["steps"] for test in summary["tests"])}
            | result
            | {
                "foreseen": foreseen(words),
                "folder_bytes": size_of(out),
                "bytes_of_parts": parts,
                "page_bytes": page,
                "report_again": report,
            }
        ), summary["host"]


def main():
    arguments = sys.argv[1:]
    share = 1.0
    if "--share" in arguments:
        at = arguments.index("--share")
        share = float(arguments[at + 1])
        del arguments[at : at + 2]
    feldspar = os.path.abspath(arguments[0])
    version = committed_version(feldspar) if share == 1.0 else ""
    studies = {
        "discs": lambda: lattice(feldspar, 2, discs, round(1e6 * share)),
        "spheres": lambda: lattice(feldspar, 3, spheres, round(4e5 * share)),
        "variants": lambda: variants(feldspar, round(1000 * share)),
    }
    results = {}
    if share == 1.0 and os.path.exists(RESULT):
        with open(RESULT, encoding="utf-8") as file:
            results = json.load(file)
    for name in arguments[1:] or studies:
        result, machine = studies[name]()
        results[name] = {"feldspar_version": version, "date": datetime.date.today().isoformat(), "machine": machine} | result
        print(json.dumps({name: results[name]}, indent=1), flush=True)
        if share == 1.0:
            with open(RESULT, "w", encoding="utf-8") as file:
                json.dump(results, file, indent=1)
                file.write("\n")


main()
