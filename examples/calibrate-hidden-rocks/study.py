#!/usr/bin/env python3
"""Hides micro-parameters, makes their rock's laboratory values, and lets `feldspar calibrate` find them.

    python3 examples/calibrate-hidden-rocks/study.py FELDSPAR FOLDER [ROCK ...]

ROCK is a number from 1 to 10; without one all are calibrated. FOLDER keeps the runs; rocks that are done there are not run
again, and an interrupted one is resumed. Once all are done, results/hidden-rocks.json is written. Without arguments only the
tables of the README are printed, from that file.
"""

import json
import math
import os
import random
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results", "hidden-rocks.json")
INPUT = os.path.join(HERE, "calibrate.prm")
N_ROCKS = 10
LABORATORY = "1001..1020"  # seeds of the specimens that give the targets; the calibration begins at 1
DEGREE = math.pi / 180.0

# Name in calibration.json, heading, unit in SI, decimals, and the bounds between which the truth is drawn: those of section
# Calibration for the ratios. Factors are drawn evenly over their logarithm.
PARAMETERS = (
    ("modulus", "modulus [GPa]", 1e9, 1, 30e9, 120e9, True),
    ("bond_tensile_strength", "bond tensile strength [MPa]", 1e6, 1, 8e6, 40e6, True),
    ("stiffness_ratio", "stiffness ratio", 1.0, 2, 1.0, 4.0, True),
    ("cohesion_ratio", "cohesion over tensile strength", 1.0, 1, 4.0, 40.0, True),
    ("bond_friction_angle", "bond friction angle [deg]", DEGREE, 0, 0.0, 40.0 * DEGREE, False),
    ("friction", "friction", 1.0, 2, 0.2, 1.2, False),
)
TARGETS = (  # name in calibration.json, in the reference file, unit there, group and figure in summary.json
    ("youngs_modulus", "youngs_modulus_GPa", 1e9, "uniaxial_compression", "youngs_modulus_initial_Pa"),
    ("poissons_ratio", "poissons_ratio", 1.0, "uniaxial_compression", "poissons_ratio_initial"),
    ("tensile_strength", "tensile_strength_MPa", 1e6, "direct_tension", "peak_stress_Pa"),
    ("uniaxial_compressive_strength", "uniaxial_compressive_strength_MPa", 1e6, "uniaxial_compression", "peak_stress_Pa"),
)


def hidden(rock):
    """The truth: other numbers for each rock, the same on every machine."""
    draw = random.Random(rock)
    truth = {}
    for name, _, _, _, lower, upper, is_factor in PARAMETERS:
        share = draw.random()
        truth[name] = lower * (upper / lower) ** share if is_factor else lower + share * (upper - lower)
    truth["bond_cohesion"] = truth["cohesion_ratio"] * truth["bond_tensile_strength"]
    return truth


def settings_of(truth):
    """Returns the entries of its specimens. Entries that a calibration ties are tied: coefficients of variation, and
    the particle contact."""
    contact = {"Modulus": f"{truth['modulus']:.9g} Pa", "Stiffness ratio": f"{truth['stiffness_ratio']:.9g}",
               "Friction": f"{truth['friction']:.9g}"}
    strength, cohesion = truth["bond_tensile_strength"], truth["bond_cohesion"]
    bond = {"Bond tensile strength": f"{strength:.9g} Pa",
            "Bond tensile strength standard deviation": f"{0.1 * strength:.9g} Pa",
            "Bond cohesion": f"{cohesion:.9g} Pa",
            "Bond cohesion standard deviation": f"{0.1 * cohesion:.9g} Pa",
            "Bond friction angle": f"{truth['bond_friction_angle'] / DEGREE:.9g} deg"}
    return [f"Flat joint/{entry} = {value}" for entry, value in {**contact, **bond}.items()] + [
        f"Particle contact/{entry} = {value}" for entry, value in contact.items()]


def feldspar_run(feldspar, command, folder, settings, allowed=(0,), input_file=INPUT):
    """A run of an input that is done, resumed or made anew; its exit code, none of one that was done."""
    if os.path.exists(os.path.join(folder, "summary.json")):
        return None
    if os.path.exists(folder):
        arguments = [command, "--resume", folder]
    else:
        arguments = [command, input_file, "--output", folder]
        for setting in settings:
            arguments += ["--set", setting]
    code = subprocess.run([feldspar, *arguments, "--threads", os.environ.get("THREADS", "2"), "--quiet"]).returncode
    if code not in allowed:
        raise SystemExit(f"feldspar {' '.join(arguments)}: exit code {code}")
    return code


def read(folder, name):
    with open(os.path.join(folder, name)) as file:
        return json.load(file)


def calibrate(feldspar, work, rock):
    truth = hidden(rock)
    laboratory = os.path.join(work, f"rock-{rock}-laboratory")
    feldspar_run(feldspar, "lab", laboratory, [*settings_of(truth), f"Seeds/Seeds = {LABORATORY}"])
    ensemble = read(laboratory, "summary.json")["ensemble"]
    experiment = {}
    for _, key, unit, group, figure in TARGETS:
        of_figure = ensemble[group][figure]
        experiment[key] = {"mean": of_figure["mean"] / unit, "standard_deviation": of_figure["standard_deviation"] / unit,
                           "n": of_figure["n"]}
    reference = os.path.join(work, f"rock-{rock}.json")
    with open(reference, "w") as file:
        json.dump({"rock": f"hidden rock {rock}", "experiment": experiment}, file, indent=2)
    feldspar_run(feldspar, "calibrate", os.path.join(work, f"rock-{rock}"), [f"Report/Reference file = {reference}"],
                 allowed=(0, 4, 5))


def merged(work):
    """Returns the results of all rocks, with the provenance of the last run."""
    rocks = []
    for rock in range(1, N_ROCKS + 1):
        answer = read(os.path.join(work, f"rock-{rock}"), "calibration.json")
        truth = hidden(rock)
        rocks.append({"rock": rock, "verdict": answer["verdict"], "statement": answer["statement"],
                      "targets": {name: {key: of[key] for key in ("target", "target_standard_deviation", "reached",
                                                                   "standard_error", "n_packings")}
                                  for name, of in answer["targets"].items()},
                      "strain_scale_effects": answer["strain_scale_effects"],
                      "parameters": {name: {"truth": truth[name],
                                            **{key: of[key] for key in ("best", "lower_90", "upper_90", "verdict")}}
                                     for name, of in answer["parameters"].items()}})
    provenance = {key: answer[key] for key in ("schema_version", "feldspar_version", "commit", "host")}
    return {**provenance, "laboratory_seeds": LABORATORY, "rocks": rocks}


def holds(parameter):
    return parameter["lower_90"] <= parameter["truth"] <= parameter["upper_90"]


def print_tables():
    with open(RESULTS) as file:
        rocks = json.load(file)["rocks"]
    print("| | truth held by the 90 % interval | root-mean-square deviation of the answer | determined, bounded, not determined |")
    print("|---|---|---|---|")
    derived = ("bond_cohesion", "bond cohesion [MPa]", 1e6, 0, None, None, True)
    for name, heading, unit, *_, is_factor in (*PARAMETERS, derived):
        of = [rock["parameters"][name] for rock in rocks]
        if is_factor:
            off = math.sqrt(statistics.mean((p["best"] / p["truth"] - 1.0) ** 2 for p in of))
            error = f"{100 * off:.0f} %"
        else:
            off = math.sqrt(statistics.mean((p["best"] - p["truth"]) ** 2 for p in of))
            error = f"{off / unit:.{2 if unit == 1.0 else 0}f}"
        verdicts = [sum(p["verdict"] == verdict for p in of) for verdict in ("determined", "bounded", "not determined")]
        print(f"| {heading} | {sum(map(holds, of))} of {len(of)} | {error} | {', '.join(map(str, verdicts))} |")
    print()
    print("| rock | " + " | ".join(heading for _, heading, *_ in PARAMETERS) + " |")
    print("|---|" + "---|" * len(PARAMETERS))
    for rock in rocks:
        cells = []
        for name, _, unit, decimals, *_ in PARAMETERS:
            p = rock["parameters"][name]
            shown = [f"{p[key] / unit:.{decimals}f}" for key in ("truth", "best", "lower_90", "upper_90")]
            cell = f"{shown[0]}: {shown[1]} ({shown[2]} to {shown[3]})"
            cells.append(cell if holds(p) else f"**{cell}**")
        print(f"| {rock['rock']} | " + " | ".join(cells) + " |")


def main():
    if len(sys.argv) > 2:
        feldspar, work = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2])
        subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), feldspar], check=True)
        os.makedirs(work, exist_ok=True)
        for rock in map(int, sys.argv[3:] or range(1, N_ROCKS + 1)):
            calibrate(feldspar, work, rock)
        if not all(os.path.exists(os.path.join(work, f"rock-{rock}", "calibration.json")) for rock in range(1, N_ROCKS + 1)):
            return
        with open(RESULTS, "w") as file:
            json.dump(merged(work), file)
        subprocess.run([os.path.join(HERE, "../../scripts/keep-results.py"), RESULTS], check=True)
    print_tables()


if __name__ == "__main__":
    main()
