#!/usr/bin/env python3
"""Compares the speed of two builds in one run, by processor time.

    scripts/compare-speed.py OLD_BUILD NEW_BUILD [--times N] [--only PROGRAM ...] [--filter REGEX]

OLD_BUILD and NEW_BUILD: build folders of two trees with FELDSPAR_BENCHMARKS=ON. The programs of benchmarks/ that both have
run in turns, old, new, new, old and so on, so that whatever else the machine does falls on both alike; of each benchmark
the least processor time of N runs (5) of each build is set against the other. Compare within one run only.

Exit code 0: no benchmark is slower by more than 2 %; 1: one is.
"""

import argparse
import json
import os
import subprocess
import sys

PROGRAMS = ("dynamics_benchmark", "space_benchmark", "representative_volume_benchmark", "explicit_volume_benchmark")
ALLOWED = 1.02


def timed(build, program, wanted):
    command = [os.path.join(build, "benchmarks", program), "--benchmark_format=json"]
    if wanted:
        command.append("--benchmark_filter=" + wanted)
    out = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    return {one["name"]: one["cpu_time"] for one in json.loads(out)["benchmarks"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--times", type=int, default=5)
    parser.add_argument("--only", nargs="+", default=PROGRAMS, choices=PROGRAMS)
    parser.add_argument("--filter", default="")
    wanted = parser.parse_args()
    os.environ.setdefault("FELDSPAR_THREADS", "1")

    worst = 0.0
    for program in wanted.only:
        if not all(os.path.exists(os.path.join(build, "benchmarks", program)) for build in (wanted.old, wanted.new)):
            sys.exit(f"{program}: not in both builds; configure them with -DFELDSPAR_BENCHMARKS=ON")
        least = {wanted.old: {}, wanted.new: {}}
        for k in range(wanted.times):
            turn = (wanted.old, wanted.new) if k % 2 == 0 else (wanted.new, wanted.old)
            for build in turn:
                for name, seconds in timed(build, program, wanted.filter).items():
                    least[build][name] = min(seconds, least[build].get(name, seconds))
        for name, seconds in least[wanted.old].items():
            if name in least[wanted.new]:
                ratio = least[wanted.new][name] / seconds
                worst = max(worst, ratio)
                print(f"{program} {name}: new over old {ratio:.3f}", flush=True)
    print(f"the slowest: {worst:.3f}")
    sys.exit(1 if worst > ALLOWED else 0)


if __name__ == "__main__":
    main()
