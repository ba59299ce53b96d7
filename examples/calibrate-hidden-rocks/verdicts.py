#!/usr/bin/env python3
"""Calibrates ten hidden rocks and tests each answer on eleven fresh packings: do the verdicts hold?

    python3 examples/calibrate-hidden-rocks/verdicts.py FELDSPAR FOLDER [ROCK ...]

The rocks are those of study.py, the specimens smaller (verdicts.prm). FOLDER keeps the runs; rocks that are done there are not
run again. Once all are done, results/verdicts.json is written and the tables of the README between their markers are made
anew. Without arguments the tables are printed from that file.
"""

import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True  # nothing beside the example
from study import HERE, N_ROCKS, feldspar_run, hidden, read, settings_of

RESULTS = os.path.join(HERE, "results", "verdicts.json")
README = os.path.join(HERE, "README.md")
INPUT = os.path.join(HERE, "verdicts.prm")
MARKERS = ("<!-- verdicts.py: begin -->\n", "<!-- verdicts.py: end -->\n")
LABORATORY = "1001..1011"  # seeds of the specimens that give the targets; the calibration begins at 1
FRESH = "2001..2011"  # of those by which nothing was chosen and nothing judged
TARGETS = (  # name in calibration.json, heading, key and unit of the reference, group and figure in summary.json
    ("youngs_modulus", "Young's modulus", "youngs_modulus_GPa", 1e9, "uniaxial_compression", "youngs_modulus_initial_Pa"),
    ("tensile_strength", "tensile strength", "tensile_strength_MPa", 1e6, "direct_tension", "peak_stress_Pa"),
    ("uniaxial_compressive_strength", "compressive strength", "uniaxial_compressive_strength_MPa", 1e6,
     "uniaxial_compression", "peak_stress_Pa"),
)
ENDS = {0: "reached", 4: "missed", 5: "not_decided"}  # exit codes of a calibration


def calibrate(feldspar, work, rock):
    laboratory = os.path.join(work, f"rock-{rock}-laboratory")
    # Shape of the gap and size are those of the calibration, the bonds are hidden.
    feldspar_run(feldspar, "lab", laboratory, [*settings_of(hidden(rock)), f"Seeds/Seeds = {LABORATORY}"], input_file=INPUT)
    ensemble = read(laboratory, "summary.json")["ensemble"]
    experiment = {key: {"mean": ensemble[group][figure]["mean"] / unit,
                        "standard_deviation": ensemble[group][figure]["standard_deviation"] / unit,
                        "n": ensemble[group][figure]["n"]} for _, _, key, unit, group, figure in TARGETS}
    reference = os.path.join(work, f"rock-{rock}.json")
    with open(reference, "w") as file:
        json.dump({"rock": f"hidden rock {rock}", "experiment": experiment}, file, indent=2)
    folder = os.path.join(work, f"rock-{rock}")
    code = feldspar_run(feldspar, "calibrate", folder, [f"Report/Reference file = {reference}"], input_file=INPUT,
                        allowed=tuple(ENDS))
    answer = read(folder, "calibration.json")
    if code is not None and ENDS[code] != answer["verdict"]:
        raise SystemExit(f"rock {rock}: exit code {code}, but the verdict is {answer['verdict']}")
    best = os.path.join(folder, "nearest.prm" if answer["verdict"] == "missed" else "best.prm")
    feldspar_run(feldspar, "lab", os.path.join(work, f"rock-{rock}-fresh"), [f"Seeds/Seeds = {FRESH}"], input_file=best)


def merged(work):
    """Returns the results of all rocks, with the provenance of the last run."""
    rocks = []
    for rock in range(1, N_ROCKS + 1):
        answer = read(os.path.join(work, f"rock-{rock}"), "calibration.json")
        fresh = read(os.path.join(work, f"rock-{rock}-fresh"), "summary.json")["ensemble"]
        targets = {}
        for name, _, _, _, group, figure in TARGETS:
            of = answer["targets"][name]
            targets[name] = {key: of.get(key) for key in ("target", "reached", "lower_95", "upper_95", "n_packings", "verdict")}
            targets[name]["fresh"] = {key: fresh[group][figure][key] for key in ("mean", "standard_error", "n")}
        rocks.append({"rock": rock, "verdict": answer["verdict"], "statement": answer["statement"], "targets": targets})
    provenance = {key: answer[key] for key in ("schema_version", "feldspar_version", "commit", "host")}
    return {**provenance, "tolerance": answer["tolerance"], "laboratory_seeds": LABORATORY, "fresh_seeds": FRESH,
            "rocks": rocks}


def tables():
    with open(RESULTS) as file:
        results = json.load(file)
    tolerance, rocks = results["tolerance"], results["rocks"]
    off = lambda target, value: value / target["target"] - 1.0
    holds = lambda target: abs(off(target, target["fresh"]["mean"])) <= tolerance
    lines = ["| verdict | targets | of these within the tolerance on eleven fresh packings | rocks | of these with all three |",
             "|---|---|---|---|---|"]
    for verdict in ("reached", "not_decided", "missed"):
        targets = [target for rock in rocks for target in rock["targets"].values() if target["verdict"] == verdict]
        of_rocks = [rock for rock in rocks if rock["verdict"] == verdict]
        all_hold = sum(all(map(holds, rock["targets"].values())) for rock in of_rocks)
        lines.append(f"| {verdict.replace('_', ' ')} | {len(targets)} | {sum(map(holds, targets))} | {len(of_rocks)} | {all_hold} |")
    kept = sum(all(holds(target) for target in rock["targets"].values() if target["verdict"] == "reached") for rock in rocks)
    lines += ["", "| | rocks |", "|---|---|",
              f"| all that is called reached lies within the tolerance on eleven fresh packings | {kept} of {len(rocks)} |", "",
              "| rock | verdict | packings | " + " | ".join(f"{heading} [%]" for _, heading, *_ in TARGETS) + " |",
              "|---|---|---|" + "---|" * len(TARGETS)]
    for rock in rocks:
        cells = []
        for name, *_ in TARGETS:
            target = rock["targets"][name]
            if target["upper_95"] is None:
                cell = f"{100 * off(target, target['reached']):+.0f} predicted; {100 * off(target, target['fresh']['mean']):+.0f}"
            else:
                half = 50.0 * (target["upper_95"] - target["lower_95"]) / target["target"]
                cell = (f"{100 * off(target, target['reached']):+.0f} ± {half:.0f}, {target['verdict'].replace('_', ' ')}; "
                        f"{100 * off(target, target['fresh']['mean']):+.0f}")
            cells.append(cell if target["verdict"] != "reached" or holds(target) else f"**{cell}**")
        n = max(target["n_packings"] for target in rock["targets"].values())
        lines.append(f"| {rock['rock']} | {rock['verdict'].replace('_', ' ')} | {n} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) > 2:
        feldspar, work = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
        subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), feldspar], check=True)
        os.makedirs(work, exist_ok=True)
        for rock in map(int, sys.argv[3:] or range(1, N_ROCKS + 1)):
            calibrate(feldspar, work, rock)
        if not all(os.path.exists(os.path.join(work, f"rock-{rock}-fresh", "summary.json")) for rock in range(1, N_ROCKS + 1)):
            return
        with open(RESULTS, "w") as file:
            json.dump(merged(work), file)
        subprocess.run([os.path.join(HERE, "../../scripts/keep-results.py"), RESULTS], check=True)
        with open(README) as file:
            before, rest = file.read().split(MARKERS[0])
        with open(README, "w") as file:
            file.write(before + MARKERS[0] + "\n" + tables() + "\n" + MARKERS[1] + rest.split(MARKERS[1])[1])
    print(tables(), end="")


if __name__ == "__main__":
    main()
