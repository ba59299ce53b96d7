#!/usr/bin/env python3
"""A step on the same grains and joined pairs by Feldspar and by the peers that Debian has, in one run.

    python3 benchmarks/peers/peers.py BUILD                  runs them, and writes the table in the README
    python3 benchmarks/peers/peers.py --table INSTRUCTIONS   prints the table of the committed figures

INSTRUCTIONS: avx2 or avx512, of the processor; the figures are in benchmarks/results/peers-INSTRUCTIONS.json.
BUILD: a build folder with FELDSPAR_BENCHMARKS=ON, of a commit. The peers come from the packages yade and esys-particle; one
that is missing is refused. Programs run in turns, least time of three; on a machine that does nothing else, some half an
hour.
"""

import datetime
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path += [os.path.join(ROOT, "scripts"), os.path.join(ROOT, "benchmarks")]
compare = __import__("compare-speed")
readme_table = __import__("readme_table")

TIMES = 3
BODIES = {"plane": "discs", "space": "spheres"}
OURS = {"flat-joint": "Feldspar, flat joint", "parallel-bond": "Feldspar, parallel bond"}
PEERS = {"cohesive": "YADE, cohesive bond with moments", "jcfpm": "YADE, jointed cohesive particles", "esys": "ESyS-Particle, rotational bond"}
# A few seconds each on one core.
STEPS = {"ours": {"plane": 50_000, "space": 600}, "peers": {"plane": 3000, "space": 30}}


def last_line(command, **environment):
    ended = subprocess.run(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, **environment}, check=False
    )
    found = re.findall(r"\{.*\}", ended.stdout)
    if not found:
        sys.exit(f"{' '.join(command)}:\n{ended.stdout[-2000:]}{ended.stderr[-2000:]}")
    return json.loads(found[-1])


def version_of(package):
    found = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], stdout=subprocess.PIPE, text=True, check=False)
    if found.returncode != 0:
        sys.exit(f"package {package} is not installed: apt-get install --no-install-recommends yade esys-particle")
    return found.stdout


def step(program, build, folder, body, cores):
    if program in OURS:
        steps = str(STEPS["ours"][body])
        return last_line([os.path.join(build, "benchmarks", "own_step"), "time", f"{body}-{program}", folder, steps, str(cores)])
    grains = os.path.join(folder, f"{body}-flat-joint")
    steps = str(STEPS["peers"][body])
    if program == "esys":
        script = os.path.join(HERE, "esys_step.py")
        ranks = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(cores + 1)]
        return last_line([*ranks, "esysparticle", script, grains, steps, str(cores)])
    script = os.path.join(HERE, "yade_step.py")
    return last_line(["yade", f"-j{cores}", "-n", "-x", script], FELDSPAR_PEER=f"{program} {grains} {steps}")


def measured(build):
    made_by = compare.version(build)
    if made_by.endswith(".modified"):
        sys.exit(f"{build} ({made_by}) is of no commit: commit, build again, and measure with that")
    result = {
        "feldspar_version": made_by,
        "flags": compare.flags(build),
        "processor": compare.processor(),
        "date": datetime.date.today().isoformat(),
        "yade": version_of("yade"),
        "esys-particle": version_of("esys-particle"),
        "steps": STEPS,
        "bodies": {},
    }
    with tempfile.TemporaryDirectory() as folder:
        for body in BODIES:
            of_body = {law: last_line([os.path.join(build, "benchmarks", "own_step"), "make", f"{body}-{law}", folder]) for law in OURS}
            joints = of_body["flat-joint"]["joints"]
            least = {}
            for cores in (1, 2):
                for _ in range(TIMES):
                    for program in (*OURS, *PEERS):
                        once = step(program, build, folder, body, cores)
                        if once["bonds"] != joints:
                            sys.exit(f"{program}: {once['bonds']} bonds of {joints}")
                        key = (program, cores)
                        least[key] = min(once["seconds_of_a_step"], least.get(key, once["seconds_of_a_step"]))
                        print(f"{body}, {program}, {cores} cores: {once['seconds_of_a_step']:.3g} s", flush=True)
            result["bodies"][body] = {
                "grains": of_body["flat-joint"]["grains"],
                "joints": joints,
                "segments_of_a_joint": {law: of_body[law]["segments_of_a_joint"] for law in OURS},
                "nanoseconds_a_bond_and_step": {
                    program: {str(cores): float(f"{1e9 * least[program, cores] / joints:.4g}") for cores in (1, 2)}
                    for program in (*OURS, *PEERS)
                },
            }
    return result


def three_digits(value):
    return f"{float(f'{value:.3g}'):g}"


def table(result):
    lines = [
        "| body | program and bond | segments of a bond | one core [ns a bond] | two cores [ns a bond] | bonds a second and core | over Feldspar's flat joint |",
        "|---|---|---|---|---|---|---|",
    ]
    for body, figures in result["bodies"].items():
        taken = figures["nanoseconds_a_bond_and_step"]
        for program, name in {**OURS, **PEERS}.items():
            segments = figures["segments_of_a_joint"].get(program, 1)
            one = taken[program]["1"]
            lines.append(
                f"| {figures['grains']} {BODIES[body]}, {figures['joints']} bonds | {name} | {segments} | {three_digits(one)} | "
                f"{three_digits(taken[program]['2'])} | {1e3 / one:.3g} million | {one / taken['flat-joint']['1']:.2g} |"
            )
    return "\n".join(lines) + "\n"


def main():
    is_shown = sys.argv[1:2] == ["--table"]
    if len(sys.argv) != (3 if is_shown else 2):
        sys.exit(__doc__)
    if is_shown:
        readme_table.keep_and_show("peers", sys.argv[2], table)
    else:
        result = measured(sys.argv[1])
        readme_table.keep_and_show("peers", compare.vector_instructions(sys.argv[1]), table, result)


if __name__ == "__main__":
    main()
