#!/usr/bin/env python3
"""Pulls a sample with a weak row apart on three meshes, with softening scaled by the size of the elements and as it is.

    python3 examples/multiscale-beishan/mesh-study.py FELDSPAR [GEOMETRY ...]

GEOMETRY is plane or axisymmetric; without one both are run. Writes results/mesh-study.json and draws
results/mesh-study.png (gnuplot); scripts/write-tables.py writes the tables of the READMEs. The inputs are mesh-study.prm here and in
../multiscale-beishan-cylinder. On the coarsest mesh elements are as large as the representative volume, and both ways of
softening are the same; it is run once.

Work after the peak is the work of the platens from the row of the highest stress to the end, per area. Loss after the
peak is the energy released, dissipated by slip and settled from there on, by the energies of the run.
"""

import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results")
INPUTS = {
    "plane": os.path.join(HERE, "mesh-study.prm"),
    "axisymmetric": os.path.join(HERE, "../multiscale-beishan-cylinder/mesh-study.prm"),
}
MESHES = {"plane": ((2, 2), (3, 3), (4, 4)), "axisymmetric": ((1, 2), (2, 4), (3, 6))}  # across, along
LOSSES = ("slip_energy_J", "released_energy_J", "damping_energy_J")


def measured(geometry, test, curve):
    """Figures of one test from its summary and the rows of its curve."""
    strain = [float(row["axial_strain"]) for row in curve]
    stress = [float(row["axial_stress_Pa"]) for row in curve]
    loss = [sum(float(row[name]) for name in LOSSES) for row in curve]
    peak = stress.index(max(stress))
    width, height = test["size_m"][0], test["size_m"][2 if geometry == "axisymmetric" else 1]
    area = 0.25 * math.pi * width**2 if geometry == "axisymmetric" else width  # the plane is one metre thick
    work = sum(
        0.5 * (stress[k] + stress[k - 1]) * (strain[k] - strain[k - 1]) * height for k in range(peak + 1, len(curve))
    )
    return {
        "seed": test["seed"],
        "peak_stress_Pa": stress[peak],
        "strain_at_peak": strain[peak],
        "strain_at_end": strain[-1],
        "work_after_peak_J_per_m2": work,
        "loss_after_peak_J_per_m2": (loss[-1] - loss[peak]) / area,
        "energy_imbalance_over_work": test["energy_imbalance_over_work"],
        "wall_time_s": test["wall_time_s"],
        "strain": [round(value, 9) for value in strain],
        "stress_Pa": [round(value) for value in stress],
    }


def run(feldspar, geometry, mesh, softening):
    with open(INPUTS[geometry], encoding="utf-8") as file:
        text = file.read()
    for entry, value in (("Elements across", mesh[0]), ("Elements along", mesh[1]), ("Softening", softening)):
        text = re.sub(rf"set {entry}( *)= .*", rf"set {entry}\g<1>= {value}", text)
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "study.prm"), "w", encoding="utf-8") as file:
            file.write(text)
        subprocess.run(
            [feldspar, "multiscale", "study.prm", "--output", "out", "--quiet", "--threads", "1"],
            cwd=folder,
            check=True,
            stdout=subprocess.DEVNULL,
        )
        with open(os.path.join(folder, "out/summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        tests = []
        for test in summary["tests"]:
            with open(os.path.join(folder, "out/curves", test["name"] + ".csv"), encoding="utf-8") as file:
                tests.append(measured(geometry, test, list(csv.DictReader(file))))
    of_run = {"geometry": geometry, "elements": list(mesh), "softening": softening, "tests": tests}
    return of_run, {key: summary[key] for key in ("feldspar_version", "commit", "host")}


def draw(runs):
    """The curves of the first seed: a panel a geometry and way of softening."""
    panels = [
        (geometry, softening)
        for geometry in INPUTS
        for softening in ("scaled", "as it is")
        if any(one["geometry"] == geometry for one in runs)
    ]
    script = [
        f'set terminal pngcairo size 1120,{420 * (len(panels) // 2)} font "sans,12"',
        'set output "mesh-study.png"',
        f"set multiplot layout {len(panels) // 2},2",
        'set xlabel "axial strain [1e-3]"',
        'set ylabel "axial stress [MPa]"',
        "set yrange [0:*]",
        "set key top right",
    ]
    for geometry, softening in panels:
        coarsest = list(MESHES[geometry][0])
        shown = [
            one
            for one in runs
            if one["geometry"] == geometry and (one["softening"] == softening or one["elements"] == coarsest)
        ]
        script.append(f'set title "{geometry}, softening {softening}"')
        for k, one in enumerate(shown):
            test = one["tests"][0]
            rows = (f"{1e3 * x:.6g} {1e-6 * y:.6g}" for x, y in zip(test["strain"], test["stress_Pa"]))
            script += [f"$curve{k} << EOD", *rows, "EOD"]
        colours = ("#0050c8", "#c85000", "#008060")
        script.append(
            "plot "
            + ", ".join(
                f'$curve{k} with lines lw 1.5 lc rgb "{colours[k]}" title "{one["elements"][0]} x '
                f'{one["elements"][1]} elements"'
                for k, one in enumerate(shown)
            )
        )
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, cwd=RESULTS, check=True)


def main():
    feldspar = os.path.realpath(sys.argv[1])
    subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), feldspar], check=True)
    results = os.path.join(RESULTS, "mesh-study.json")
    geometries = sys.argv[2:] or list(INPUTS)
    runs = []
    for geometry in geometries:
        for mesh in MESHES[geometry]:
            for softening in ("scaled",) if mesh == MESHES[geometry][0] else ("scaled", "as it is"):
                of_run, made_with = run(feldspar, geometry, mesh, softening)
                runs.append({**of_run, **made_with})
                for test in of_run["tests"]:
                    print(
                        f"{geometry}, {mesh[0]} x {mesh[1]}, {softening}, seed {test['seed']}: "
                        f"peak {test['peak_stress_Pa'] / 1e6:.2f} MPa, after it work "
                        f"{test['work_after_peak_J_per_m2']:.1f}, loss {test['loss_after_peak_J_per_m2']:.1f} J/m^2",
                        flush=True,
                    )
    if os.path.exists(results):  # of the other geometry
        with open(results, encoding="utf-8") as file:
            runs += [one for one in json.load(file)["runs"] if one["geometry"] not in geometries]
    runs.sort(key=lambda one: list(INPUTS).index(one["geometry"]))
    with open(results, "w", encoding="utf-8") as file:
        json.dump({"schema_version": 1, "runs": runs}, file)
    subprocess.run([os.path.join(HERE, "../../scripts/keep-results.py"), results], check=True)
    draw(runs)


if __name__ == "__main__":
    main()
