#!/usr/bin/env python3
"""Compares the speed of two builds in one run, by processor time.

    scripts/compare-speed.py OLD_BUILD NEW_BUILD [--times N] [--only PROGRAM ...] [--filter REGEX] [--json FILE]

OLD_BUILD and NEW_BUILD: build folders of two trees with FELDSPAR_BENCHMARKS=ON. The programs of benchmarks/ that both have
run in turns, old, new, new, old and so on, so that whatever else the machine does falls on both alike; of each benchmark
the least processor time of N runs (5) of each build is set against the other. Compare within one run only. FILE gets the
ratios, with the versions of both builds, their compiler flags and the processor.

Exit code 0: no benchmark is slower by more than 2 %; 1: one is.
"""

import argparse
import json
import os
import re
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


def version(build):
    with open(os.path.join(build, "generated", "feldspar_version.h")) as header:
        return re.search(r'"(.*)"', header.read().split("version = ")[1]).group(1)


def flags(build):
    with open(os.path.join(build, "CMakeCache.txt")) as cache:
        entries = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read(), re.MULTILINE))
    level = entries.get("FELDSPAR_LEVEL") or ("native" if entries.get("FELDSPAR_NATIVE") == "ON" else "")
    return " ".join(f"{entries.get('CMAKE_CXX_FLAGS', '')} {level and '-march=' + level}".split())


def processor():
    with open("/proc/cpuinfo") as info:
        return re.search(r"model name\s*: (.*)", info.read()).group(1)


def vector_instructions(build):
    """Returns the instructions that the packs of a build use, as names of files of figures have it: avx512, avx2 or
    base."""
    chosen = re.search(r"-march=(\S+)", flags(build))
    levels = {"x86-64-v3": "avx2", "x86-64-v4": "avx512"}
    if not chosen or chosen.group(1) != "native":
        return levels.get(chosen.group(1) if chosen else "", "base")
    with open("/proc/cpuinfo") as info:
        has = set(re.search(r"flags\s*: (.*)", info.read()).group(1).split())
    return "avx512" if "avx512f" in has else "avx2" if "avx2" in has else "base"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--times", type=int, default=5)
    parser.add_argument("--only", nargs="+", default=PROGRAMS, choices=PROGRAMS)
    parser.add_argument("--filter", default="")
    parser.add_argument("--json")
    wanted = parser.parse_args()
    os.environ.setdefault("FELDSPAR_THREADS", "1")

    ratios = {}
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
                ratios[name] = least[wanted.new][name] / seconds
                print(f"{program} {name}: new over old {ratios[name]:.3f}", flush=True)
    worst = max(ratios.values(), default=0.0)
    print(f"the slowest: {worst:.3f}")
    if wanted.json:
        made = {
            "processor": processor(),
            "vector_instructions": vector_instructions(wanted.new),
            "flags": flags(wanted.new),
            "old": version(wanted.old),
            "feldspar_version": version(wanted.new),
        }
        with open(wanted.json, "w") as out:
            json.dump({**made, "new_over_old": ratios}, out, indent=2)
            out.write("\n")
    sys.exit(1 if worst > ALLOWED else 0)


if __name__ == "__main__":
    main()
