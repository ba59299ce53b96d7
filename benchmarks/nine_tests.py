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
import tempfile
import time

import record  # beside this file

INPUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../examples/beishan-granite/beishan.prm")


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
    record.version_of(wanted.build)
    clock, processor, summary = min((run(wanted.build, wanted.threads) for _ in range(wanted.times)), key=lambda one: one[0])
    result = {
        "threads": wanted.threads,
        "times": wanted.times,
        "clock_s": clock,
        "user_time_s": processor,
        "n_grains": summary["tests"][0]["n_grains"],
        "peak_stress_Pa": {test["name"]: test["peak_stress_Pa"] for test in summary["tests"]},
    }
    record.keep(wanted.build, "nine-tests", result)
    print(f"{clock:.1f} s by the clock, {processor:.1f} s of the processor (user)")


if __name__ == "__main__":
    main()
