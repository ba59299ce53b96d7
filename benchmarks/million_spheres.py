#!/usr/bin/env python3
"""A million spheres pulled to failure by two ranks: time and memory.

    python3 benchmarks/million_spheres.py BUILD   # writes results/million-spheres-INSTRUCTIONS.json and its table in README.md
    python3 benchmarks/million_spheres.py         # prints it

BUILD: a build folder, of a commit; two processors that do nothing else, twenty minutes, and 10 GB of disk. Peak of
each rank: VmHWM of the kernel; median: of VmRSS, which is read twice a second.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

from on_ranks import ENVIRONMENT, launcher
from readme_table import HERE, keep_and_show
from record import compare, version_of


def memory(process):
    """The peak and the present memory of a process [bytes]."""
    with open(f"/proc/{process}/status", encoding="ascii") as status:
        kilobytes = {line.split(":")[0]: line.split()[1] for line in status if line.startswith("Vm")}
    return 1024 * int(kilobytes.get("VmHWM", 0)), 1024 * int(kilobytes.get("VmRSS", 0))


def ranks_of(run):
    """The processes that mpirun started."""
    with open(f"/proc/{run.pid}/task/{run.pid}/children", encoding="ascii") as children:
        return children.read().split()


def measured(build):
    result = {"feldspar_version": version_of(build), "processor": compare.processor(), "ranks": 2}
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "million")
        command = launcher(2) + ["--bind-to", "none", os.path.abspath(f"{build}/app/feldspar"), "lab",
                                 os.path.join(HERE, "million_spheres.prm"), "--output", out, "--threads", "1", "--quiet"]
        begin = time.monotonic()
        run = subprocess.Popen(command, env=ENVIRONMENT)
        peaks, present = {}, {}
        while run.poll() is None:
            time.sleep(0.5)
            try:
                for rank in ranks_of(run):
                    peak, now = memory(rank)
                    if now > 0:  # it has not ended
                        peaks[rank] = max(peak, peaks.get(rank, 0))
                        present.setdefault(rank, []).append(now)
            except OSError:  # one has ended
                pass
        if run.returncode != 0 or len(peaks) != 2:
            sys.exit(f"the run ended with code {run.returncode} and {len(peaks)} ranks")
        result["seconds"] = time.monotonic() - begin
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    test = summary["tests"][0]
    result |= {
        "grains": test["n_grains"],
        "joints": test["n_joints"],
        "steps": test["steps"],
        "seconds_of_test": test["wall_time_s"],
        "peak_stress_Pa": test["peak_stress_Pa"],
        "cracks": test["n_tension_cracks"] + test["n_shear_cracks"],
        "peak_bytes": list(peaks.values()),
        "median_bytes": [statistics.median(of_rank) for of_rank in present.values()],
    }
    return result


def table(result):
    peak = " and ".join(f"{bytes_ / 1e9:.1f}" for bytes_ in result["peak_bytes"])
    median = " and ".join(f"{bytes_ / 1e9:.1f}" for bytes_ in result["median_bytes"])
    rows = [
        ("spheres", f"{result['grains']:,}".replace(",", " ")),
        ("joints", f"{result['joints']:,}".replace(",", " ")),
        ("steps", f"{result['steps']:,}".replace(",", " ")),
        ("time of the test", f"{result['seconds_of_test'] / 60:.1f} min"),
        ("time of all, with specimen and report", f"{result['seconds'] / 60:.1f} min"),
        ("tensile strength", f"{abs(result['peak_stress_Pa']) / 1e6:.2f} MPa"),
        ("broken segments", f"{result['cracks']:,}".replace(",", " ")),
        ("memory of the ranks, median", f"{median} GB"),
        ("memory of the ranks, peak", f"{peak} GB"),
    ]
    return "| | |\n|---|---|\n" + "".join(f"| {name} | {value} |\n" for name, value in rows)


def main():
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    build = sys.argv[1] if len(sys.argv) == 2 else None
    keep_and_show("million-spheres", "avx512" if build is None else compare.vector_instructions(build), table,
                  measured(build) if build else None)


if __name__ == "__main__":
    main()
