#!/usr/bin/env python3
"""Runs benchmarks of a build and keeps what they took.

    benchmarks/record.py BUILD PROGRAM ...

BUILD: a build folder with FELDSPAR_BENCHMARKS=ON, of a commit. PROGRAM: dynamics_benchmark, space_benchmark,
representative_volume_benchmark, factor_benchmark, explicit_volume_benchmark, contact_models_benchmark or
packing_benchmark. Each gets results/PROGRAM-INSTRUCTIONS.json beside this file (with - for _; avx2 or avx512, as the
build uses): version, compiler flags and processor, and of each benchmark the least processor time of
three runs with its counters. On a machine that does nothing else.
"""

import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "scripts"))
compare = __import__("compare-speed")


def runs(build, program):
    command = [os.path.join(build, "benchmarks", program), "--benchmark_format=json", "--benchmark_repetitions=3"]
    out = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return [one for one in json.loads(out)["benchmarks"] if one["run_type"] == "iteration"]


def version_of(build):
    """The commit of a build; one with changes of its own is refused."""
    made_by = compare.version(build)
    if made_by.endswith(".modified"):
        sys.exit(f"{build} ({made_by}) is of no commit: commit, build again, and measure with that")
    return made_by


def keep(build, name, result):
    """Writes what a build took to results/NAME-INSTRUCTIONS.json."""
    made = {
        "feldspar_version": version_of(build),
        "flags": compare.flags(build),
        "processor": compare.processor(),
        **result,
    }
    file = os.path.join(HERE, "results", f"{name}-{compare.vector_instructions(build)}.json")
    with open(file, "w", encoding="utf-8") as out:
        json.dump(made, out, indent=2)
        out.write("\n")


def main():
    os.environ.setdefault("FELDSPAR_THREADS", "1")  # as the programs have it
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    build, programs = sys.argv[1], sys.argv[2:]
    made_by = version_of(build)
    known = {"name", "run_name", "run_type", "repetitions", "repetition_index", "threads", "iterations", "real_time"}
    known |= {"family_index", "per_family_instance_index", "cpu_time", "time_unit"}
    for program in programs:
        least = {}
        for run in runs(build, program):
            if run["run_name"] not in least or run["cpu_time"] < least[run["run_name"]]["cpu_time"]:
                least[run["run_name"]] = run
        result = {
            "threads": os.environ["FELDSPAR_THREADS"],
            "benchmarks": {
                name: {
                    f"processor_time_{run['time_unit']}": run["cpu_time"],
                    **{key: value for key, value in run.items() if key not in known},
                }
                for name, run in least.items()
            },
        }
        keep(build, program.replace("_", "-"), result)
        print(f"{program}: {len(least)} benchmarks by {made_by}")


if __name__ == "__main__":
    main()
