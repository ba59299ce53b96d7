#!/usr/bin/env python3
"""Times the nine tests of one packing of Beishan granite, as a user runs them: packing, tests and page, by the clock.

    benchmarks/nine_tests.py BUILD [--threads N] [--times N]

BUILD: a build folder of a commit. The least time of N runs (3) counts. results/nine-tests-INSTRUCTIONS.json beside this file
(avx2 or avx512, as the build uses) gets it, with the strengths. On a machine that does nothing else.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "scripts"))
compare = __import__("compare-speed")
INPUT = os.path.join(HERE, "../examples/beishan-granite/beishan.prm")


def run(build, threads):
    """Time by the clock and of the processor [s], and the summary."""
    with tempfile.TemporaryDirectory() as folder:
        before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        subprocess.run(
            [os.path.join(build, "app/feldspar"), "lab", INPUT, "--output", folder + "/out", "--threads", str(threads)],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        clock, after = time.monotonic() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(folder + "/out/summary.json", encoding="utf-8") as file:
            return clock, after.ru_utime - before.ru_utime, json.load(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--times", type=int, default=3)
    wanted = parser.parse_args()
    made_by = compare.version(wanted.build)
    if made_by.endswith(".modified"):
        sys.exit(f"{wanted.build} ({made_by}) is of no commit: commit, build again, and measure with that")
    clock, processor, summary = min((run(wanted.build, wanted.threads) for _ in range(wanted.times)), key=lambda one: one[0])
    made = {
        "feldspar_version": made_by,
        "flags": compare.flags(wanted.build),
        "processor": compare.processor(),
        "threads": wanted.threads,
        "times": wanted.times,
        "clock_s": clock,
        "user_time_s": processor,
        "n_grains": summary["tests"][0]["n_grains"],
        "peak_stress_Pa": {test["name"]: test["peak_stress_Pa"] for test in summary["tests"]},
    }
    file = os.path.join(HERE, "results", f"nine-tests-{compare.vector_instructions(wanted.build)}.json")
    with open(file, "w", encoding="utf-8") as out:
        json.dump(made, out, indent=2)
        out.write("\n")
    print(f"{clock:.1f} s by the clock, {processor:.1f} s of the processor (user)")


if __name__ == "__main__":
    main()
