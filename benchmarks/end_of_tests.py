#!/usr/bin/env python3
"""Makes all laboratory tests on 200 small specimens, and looks at how they begin and end.

    python3 benchmarks/end_of_tests.py build/release/app/feldspar    # writes results/end-of-tests.json
    python3 benchmarks/end_of_tests.py FELDSPAR --piece              # prints the rows of a few of them, and writes nothing
    python3 benchmarks/end_of_tests.py                               # prints the table of README.md

Each specimen has a seed and one test. A test of a strength in tension or compression is made again to 2.5 in place of 1.6 times the
strain of its peak, to see whether a higher one follows. About a quarter of an hour on one core.
"""

import csv
import json
import os
import re
import subprocess
import sys
import tempfile

from on_ranks import committed_version

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results", "end-of-tests.json")
BODIES = {
    "plane": ["Specimen/Width = 12 mm", "Specimen/Height = 24 mm"],
    "box": ["Specimen/Dimension = 3", "Specimen/Width = 8 mm", "Specimen/Height = 16 mm", "Specimen/Minimum radius = 0.9 mm"],
    "cylinder": ["Specimen/Dimension = 3", "Specimen/Shape = cylinder", "Specimen/Width = 8 mm", "Specimen/Height = 16 mm",
                 "Specimen/Minimum radius = 0.8 mm"],
}
# Number of specimens of each body, for each test.
TESTS = {
    "direct_tension": {"plane": 24, "box": 8, "cylinder": 8},
    "uniaxial_compression": {"plane": 48, "box": 8, "cylinder": 10},
    "triaxial_compression": {"plane": 10, "box": 4, "cylinder": 4},
    "brazilian": {"plane": 10, "box": 4, "cylinder": 6},
    "three_point_bending": {"plane": 8, "box": 4},
    "semicircular_bending": {"plane": 8, "box": 4, "cylinder": 4},
    "centre_cracked_plate": {"plane": 8, "box": 4},
    "direct_shear": {"plane": 6, "box": 2},
    "own_loading": {"plane": 4, "box": 2, "cylinder": 2},
}
GOES_ON = ("direct_tension", "uniaxial_compression")
STAGES = "axial_strain,axial_stress_Pa,hold_s,confining_pressure_Pa,strain_rate_per_s\n0.001,,,,\n0.0005,,,,\n0.006,,,,\n"


def run(feldspar, folder, name, body, kind, seeds, more=()):
    """The tests of a run; curves lie beside. A test that cannot be made is in it with its reason."""
    settings = [*BODIES[body], "Flat joint/Installation gap ratio = 0.05", f"Tests/List = {kind}", "Tests/Confinements = 5 MPa",
                "Tests/Shear strain rate = 0.4 1/s", f"Seeds/Seeds = {seeds[0]}..{seeds[1]}", *more]
    if kind == "own_loading":
        settings.append("Tests/Loading table = stages.csv")
    arguments = [feldspar, "lab", "empty.prm", "--output", name, "--quiet", "--threads", "1"]
    for setting in settings:
        arguments += ["--set", setting]
    done = subprocess.run(arguments, cwd=folder, capture_output=True, text=True)
    summary = os.path.join(folder, name, "summary.json")
    if not os.path.exists(summary):  # none of its specimens could be tested
        reasons = dict(re.findall(rf"^feldspar: {kind}_seed_(\d+) cannot be made: (.*)$", done.stderr, re.MULTILINE))
        return [{"kind": kind, "seed": seed, "peak_stress_Pa": None, "failure": reasons.get(str(seed), done.stderr.strip())}
                for seed in range(seeds[0], seeds[1] + 1)]
    with open(summary, encoding="utf-8") as file:
        return json.load(file)["tests"]


def toe(folder, test):
    """Strain at 5 % of the peak over that of a straight line from zero to half of it: about 1 where the body is held from the
    start, large where nothing holds it at first."""
    strains, stresses = [], []
    with open(os.path.join(folder, "curves", test["name"] + ".csv"), encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            strains.append(abs(float(row["axial_strain"])))
            pressure = test.get("confining_pressure_Pa", 0.0) if test["kind"] == "triaxial_compression" else 0.0
            stresses.append(abs(float(row["axial_stress_Pa"])) - pressure)
    peak = max(stresses)
    at_5, at_50 = (next(e for e, s in zip(strains, stresses) if s >= share * peak) for share in (0.05, 0.5))
    return at_5 / (0.1 * at_50)


def record(folder, name, body, test):
    one = {"body": body, "kind": test["kind"], "seed": test["seed"], "peak_stress_Pa": test["peak_stress_Pa"],
           "strain_at_peak": test.get("strain_at_peak")}
    if test["peak_stress_Pa"] is None:
        one["reason"] = test.get("failure") or test["peak_stress_Pa_reason"]
    else:
        one["way_to_grains_m"] = test["way_to_grains_m"]
        one["toe"] = round(toe(os.path.join(folder, name), test), 3)
    return one


def study(feldspar, tests):
    records = []
    with tempfile.TemporaryDirectory() as folder:
        open(os.path.join(folder, "empty.prm"), "w", encoding="utf-8").close()
        with open(os.path.join(folder, "stages.csv"), "w", encoding="utf-8") as file:
            file.write(STAGES)
        first = {body: 1 for body in BODIES}
        for kind in TESTS:
            for body in TESTS[kind]:
                n = tests.get(kind, {}).get(body, 0)
                seeds = (first[body], first[body] + n - 1)
                first[body] += TESTS[kind][body]
                if n == 0:
                    continue
                name = f"{kind}-{body}"
                tested = [record(folder, name, body, test) for test in run(feldspar, folder, name, body, kind, seeds)]
                if kind in GOES_ON:
                    further = run(feldspar, folder, name + "-on", body, kind, seeds, ["Tests/Stop strain over peak strain = 2.5"])
                    for one, other in zip(tested, further):
                        one["peak_stress_further_on_Pa"] = other["peak_stress_Pa"]
                records += tested
                if sys.stderr.isatty():
                    print(f"{name}: {len(tested)}", file=sys.stderr)
    return records


def table(records):
    lines = ["| test | specimens: plane, box, cylinder | with a strength | without, each with its reason | largest toe | "
             "a higher peak up to 2.5 times the strain |", "|---|---|---|---|---|---|"]
    for kind in TESTS:
        of = [one for one in records if one["kind"] == kind]
        made = [one for one in of if one["peak_stress_Pa"] is not None]
        further = [one for one in made if one.get("peak_stress_further_on_Pa")]
        higher = [one for one in further if one["peak_stress_further_on_Pa"] > 1.001 * one["peak_stress_Pa"]]
        bodies = ", ".join(str(sum(one["body"] == body for one in of)) for body in BODIES)
        lines.append(f"| `{kind}` | {bodies} | {len(made)} | {len(of) - len(made)} | "
                     f"{max(one['toe'] for one in made):.1f} | {f'{len(higher)} of {len(further)}' if further else '–'} |")
    return "\n".join(lines)


def main():
    arguments = [one for one in sys.argv[1:] if one != "--piece"]
    if not arguments:
        with open(RESULTS, encoding="utf-8") as file:
            print(table(json.load(file)["tests"]))
        return
    feldspar = os.path.realpath(arguments[0])
    if "--piece" in sys.argv:
        print(json.dumps(study(feldspar, {"direct_tension": {"plane": 2, "cylinder": 1}, "uniaxial_compression": {"box": 1}})))
        return
    version = committed_version(feldspar)
    records = study(feldspar, TESTS)
    with open(RESULTS, "w", encoding="utf-8") as file:
        file.write(json.dumps({"feldspar_version": version, "tests": records}, indent=1) + "\n")
    print(table(records))


if __name__ == "__main__":
    main()
