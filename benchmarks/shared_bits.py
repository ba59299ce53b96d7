#!/usr/bin/env python3
"""Bytes of shared bodies: tests by one process beside the same by up to eight, also killed and resumed on another number.

    python3 benchmarks/shared_bits.py build/release [BODY ...]    # writes results/shared-bits.json and its table in README.md
    python3 benchmarks/shared_bits.py                             # prints it

Compared are cracks.csv, emission.csv, curves/ and grains/. A run is killed by SIGKILL in its longest test, after the second
checkpoint. On two processors, which need not be idle, an hour for all bodies.
"""

import csv
import glob
import hashlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

from on_ranks import ENVIRONMENT, launcher
from readme_table import study_of_parts

PLANE = {"Width": "50 mm", "Height": "100 mm"}
SPACE = {"Dimension": "3", "Shape": "cylinder", "Coring": "free sides", "Width": "14 mm", "Height": "28 mm"}
LOADED = {"List": "direct_tension, uniaxial_compression, triaxial_compression", "Confinements": "10 MPa"}
SQUEEZED = {"List": "triaxial_compression", "Confinements": "10 MPa", "Lateral boundary": "membrane"}
BODIES = {
    "plane": (PLANE, LOADED | {"Compression strain rate": "0.8 1/s", "Tension strain rate": "0.04 1/s"}),
    "plane, membrane": (PLANE, SQUEEZED),
    "space": (SPACE, LOADED | {"Compression strain rate": "2 1/s", "Tension strain rate": "0.3 1/s"}),
    "space, membrane": (SPACE, SQUEEZED | {"Compression strain rate": "4 1/s"}),
}
RUNS = [(ranks, threads) for ranks in (1, 2, 3, 4, 8) for threads in (1, 2)]
KILLED = [(1, 4), (2, 3), (8, 2)]  # on so many ranks, and resumed on so many


def start(feldspar, ranks, threads, arguments, folder):
    command = launcher(ranks) + [feldspar, "lab", "--quiet", "--threads", str(threads), *arguments]
    return subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def finish(process):
    error = process.communicate()[1]
    if process.returncode != 0:
        sys.exit(error)


def kill_in_longest_test(process, ranks, folder, test):
    while not os.path.exists(os.path.join(folder, "checkpoints", test + ".previous.h5")):
        if process.poll() is not None:
            sys.exit(f"{folder} ended before it was killed")
        time.sleep(0.02)
    children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout.split()
    for one in children if ranks > 1 else [process.pid]:
        os.kill(int(one), signal.SIGKILL)
    process.communicate()


def bytes_of(folder):
    """sha256 of all that is compared."""
    files = ["cracks.csv", "emission.csv"]
    files += sorted(os.path.relpath(file, folder) for part in ("curves", "grains") for file in glob.glob(f"{folder}/{part}/*.csv"))
    total = hashlib.sha256()
    for file in files:
        with open(os.path.join(folder, file), "rb") as content:
            total.update(file.encode() + content.read())
    return total.hexdigest()


def of_body(feldspar, folder, specimen, tests):
    entries = {"Specimen": specimen, "Tests": tests | {"Shared body": "always"}}
    with open(os.path.join(folder, "input.prm"), "w", encoding="utf-8") as file:
        for section, values in entries.items():
            lines = "".join(f"  set {name} = {value}\n" for name, value in values.items())
            file.write(f"subsection {section}\n{lines}end\n")
    runs = []
    for ranks, threads in RUNS:
        name = f"{ranks}x{threads}"
        finish(start(feldspar, ranks, threads, ["input.prm", "--output", name], folder))
        runs.append({"ranks": ranks, "threads": threads, "sha256": bytes_of(os.path.join(folder, name))})
        print(runs[-1], flush=True)
    with open(os.path.join(folder, "1x1", "tests.csv"), encoding="utf-8") as file:
        made = list(csv.DictReader(file))
    longest = max(made, key=lambda test: int(test["steps"]))["name"]
    for ranks, then in KILLED:
        name = f"killed-{ranks}"
        out = os.path.join(folder, name)
        kill_in_longest_test(start(feldspar, ranks, 1, ["input.prm", "--output", name], folder), ranks, out, longest)
        finish(start(feldspar, then, 1, ["--resume", name], folder))
        runs.append({"killed_on": ranks, "ranks": then, "threads": 1, "sha256": bytes_of(out)})
        print(runs[-1], flush=True)
    keys = ("kind", "n_grains", "n_joints", "steps", "n_tension_cracks", "n_shear_cracks")
    return {"tests": [{key: test[key] for key in keys} for test in made], "runs": runs}


def measured(build, body):
    specimen, tests = BODIES[body]
    with tempfile.TemporaryDirectory() as folder:
        return of_body(os.path.abspath(f"{build}/app/feldspar"), folder, specimen, tests)


def table(result):
    lines = "| body | grains | test | steps | breaks | runs with the same bytes |\n|---|---|---|---|---|---|\n"
    for name in (name for name in BODIES if name in result):
        runs = [run["sha256"] for run in result[name]["runs"]]
        for test in result[name]["tests"]:
            breaks = int(test["n_tension_cracks"]) + int(test["n_shear_cracks"])
            kind = test["kind"].replace("_", " ")
            lines += f"| {name} | {test['n_grains']} | {kind} | {test['steps']} | {breaks} | {runs.count(runs[0])} of {len(runs)} |\n"
    return lines


study_of_parts(__doc__, "shared", BODIES, measured, table, "bits")
