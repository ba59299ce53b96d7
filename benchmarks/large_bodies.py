#!/usr/bin/env python3
"""Large bodies from genesis to page: time and memory.

    python3 benchmarks/large_bodies.py BUILD [BODY ...]   # writes results/large-bodies-INSTRUCTIONS.json and its table in README.md
    python3 benchmarks/large_bodies.py                    # prints it

BUILD: a build folder, of a commit; two processors that do nothing else, half an hour, and 20 GB of disk. Peak of each process:
VmHWM of the kernel; median: of VmRSS, which is read twice a second.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

from on_ranks import ENVIRONMENT, launcher
from readme_table import HERE, study_of_parts

BODIES = {"million-spheres": (2, 1), "ten-million-discs": (1, 2)}  # the input, processes, threads of each


def memory(process):
    """The peak and the present memory of a process [bytes]."""
    with open(f"/proc/{process}/status", encoding="ascii") as status:
        kilobytes = {line.split(":")[0]: line.split()[1] for line in status if line.startswith("Vm")}
    return 1024 * int(kilobytes.get("VmHWM", 0)), 1024 * int(kilobytes.get("VmRSS", 0))


def processes_of(run, ranks):
    """The processes that compute: those that mpirun started."""
    if ranks == 1:
        return [str(run.pid)]
    with open(f"/proc/{run.pid}/task/{run.pid}/children", encoding="ascii") as children:
        return children.read().split()


def measured(build, body):
    ranks, threads = BODIES[body]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "run")
        command = launcher(ranks) + (["--bind-to", "none"] if ranks > 1 else [])
        command += [os.path.abspath(f"{build}/app/feldspar"), "lab", os.path.join(HERE, body + ".prm"), "--output", out, "--threads",
                    str(threads), "--quiet"]
        begin = time.monotonic()
        run = subprocess.Popen(command, env=ENVIRONMENT)
        peaks, present = {}, {}
        while run.poll() is None:
            time.sleep(0.5)
            try:
                for process in processes_of(run, ranks):
                    peak, now = memory(process)
                    if now > 0:  # it has not ended
                        peaks[process] = max(peak, peaks.get(process, 0))
                        present.setdefault(process, []).append(now)
            except OSError:  # one has ended
                pass
        if run.returncode != 0 or len(peaks) != ranks:
            sys.exit(f"the run ended with code {run.returncode} and {len(peaks)} processes")
        seconds = time.monotonic() - begin
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            test = json.load(file)["tests"][0]
        page = os.path.getsize(os.path.join(out, "report.html"))
    return {
        "ranks": ranks,
        "threads": threads,
        "seconds": seconds,
        "kind": test["kind"],
        "grains": test["n_grains"],
        "joints": test["n_joints"],
        "steps": test["steps"],
        "seconds_of_test": test["wall_time_s"],
        "peak_stress_Pa": test["peak_stress_Pa"],
        "cracks": test["n_tension_cracks"] + test["n_shear_cracks"],
        "bytes_of_page": page,
        "peak_bytes": list(peaks.values()),
        "median_bytes": [statistics.median(of_one) for of_one in present.values()],
    }


def table(result):
    def gigabytes(of_ranks):
        return " and ".join(f"{one / 1e9:.1f}" for one in of_ranks) + " GB"

    def count(number):
        return f"{number:,}".replace(",", " ")

    rows = {
        "processes × threads": lambda one: f"{one['ranks']} × {one['threads']}",
        "grains": lambda one: count(one["grains"]),
        "joints": lambda one: count(one["joints"]),
        "test": lambda one: one["kind"].replace("_", " "),
        "steps": lambda one: count(one["steps"]),
        "broken segments": lambda one: count(one["cracks"]),
        "strength": lambda one: f"{abs(one['peak_stress_Pa']) / 1e6:.2f} MPa" if one["peak_stress_Pa"] else "–",
        "time of the test": lambda one: f"{one['seconds_of_test'] / 60:.1f} min",
        "time of all, with specimen and page": lambda one: f"{one['seconds'] / 60:.1f} min",
        "memory of a process, median": lambda one: gigabytes(one["median_bytes"]),
        "memory of a process, peak": lambda one: gigabytes(one["peak_bytes"]),
        "page": lambda one: f"{one['bytes_of_page'] / 1e6:.1f} MB",
    }
    bodies = [body for body in BODIES if body in result]
    lines = ["| | " + " | ".join(body.replace("-", " ") for body in bodies) + " |", "|---" * (len(bodies) + 1) + "|"]
    lines += [f"| {name} | " + " | ".join(value(result[body]) for body in bodies) + " |" for name, value in rows.items()]
    return "\n".join(lines) + "\n"


study_of_parts(__doc__, "large-bodies", BODIES, measured, table)
