#!/usr/bin/env python3
"""Runs the experiments of this folder and writes their results; without names only the figure is made anew.

    python3 examples/multiscale-and-grains/study.py FELDSPAR [NAME ...]

NAME is an experiment of EXPERIMENTS, or all. results/NAME.json is the summary of its run, shortened by
scripts/keep-results.py; for turned cells it also has the course after the peak (after_peak), read off the curves. Draws
../../docs/figures/multiscale-and-grains.png (gnuplot); scripts/write-tables.py writes the tables of the README.
"""

import cmath
import csv
import itertools
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results")
FIGURE = os.path.join(HERE, "../../docs/figures/multiscale-and-grains.png")


class Experiment:
    """An input of this folder and what it is run for: `runs` has the entries that are set anew, one tuple a run."""

    def __init__(self, command, name, runs=((),)):
        self.command = command
        self.input = os.path.join(HERE, name + ".prm")
        self.runs = runs


def with_seeds(first, last, *entries):
    """Samples take minutes each: one run a seed can be kept by itself."""
    return tuple((f"Seeds/Seeds = {seed}", *entries) for seed in range(first, last + 1))


SIZES_MM = (12.5, 18.0, 25.0, 36.0)  # of cells by their boundaries; those of 36 mm are only pulled
BOUNDARIES = ("minimal kinematic", "weakly periodic", "edge", "periodic", "affine")
N_POINTS = 32  # of a sample of 2 x 4 elements
N_SEGMENTS = 4  # of a joint
TURNED = "Sample/Orientation = random"
UNTURNED = "Sample/Orientation = fixed"
OWN = (f"Sample/Realisations = {N_POINTS}", "Sample/Draw = in turn")  # a packing of its own at every point


OPENINGS_UM = (0, 1, 2, 5)  # over which bonds soften
MESHES = ((2, 4), (3, 6), (4, 8))  # elements across and along
SLOW = "Tests/Compression strain rate = 0.25 1/s"
TURNING = "Representative volume/Kinematics = finite"  # contacts turn with their grains
PULLED = ("Strain path/Direction = free, 1, free", "Strain path/Size = 5e-4", "Strain path/Largest step = 2e-6")


def under(pressures, *entries):
    """Samples under these pressures [MPa]."""
    return (
        "Tests/List = triaxial_compression",
        f"Tests/Confinements = {pressures} MPa",
        "Tests/Stop strain = 12e-3",  # at 60 MPa not every sample has a peak
        *entries,
    )


WIDTHS_MM = (25,)  # of walled specimens, beside those of 50 mm
DIAMETERS_MM = (13.2, 20, 33)  # of cylinders: 8, 12 and 20 mean grain diameters; one of 50 mm beside them
POROSITIES = {"cored": 0.365, "walled": 0.39}  # walls leave voids; with which grains are packed, and keep their radii nearly


def at_width(width, *rates):
    """Rates are those of 50 mm: as many waves cross each body up to its peak."""
    return (
        f"Specimen/Width = {width:g} mm",
        f"Specimen/Height = {2 * width:g} mm",
        *(f"Tests/{name} strain rate = {rate * 50 / width:.4g} 1/s" for name, rate in rates),
    )


BEGUN = ("Tests/List = uniaxial_compression", "Tests/Stop strain = 9e-4")  # some 60 MPa
BROKEN_SHARES = ("0.001", "0.002", "0.005")  # of all segments


def at_boundary(boundary):
    return f"Representative volume/Boundary = {boundary}"


EXPERIMENTS = {
    "laboratory": Experiment("lab", "laboratory"),
    "sample": Experiment("multiscale", "sample", with_seeds(1, 10)),
    "cored": Experiment("lab", "cored"),
    "rate": Experiment("lab", "rate"),
    "first-cracks-grains": Experiment("lab", "rate", (("Variants/Values = 0.25 1/s", *BEGUN),)),
    "first-cracks-sample": Experiment("multiscale", "sample", with_seeds(1, 10, *BEGUN)),
    "same-cells-grains": Experiment("lab", "same-cells-grains"),
    "same-cells-sample": Experiment("multiscale", "same-cells-sample", with_seeds(1, 2)),
    "same-cells-sample-turned": Experiment("multiscale", "same-cells-sample", with_seeds(1, 2, TURNED)),
    "one-box": Experiment("lab", "one-box"),
    "one-cell-compression": Experiment("rve", "one-cell"),
    "one-cell-tension": Experiment("rve", "one-cell", (PULLED,)),
    "angles-tension": Experiment("rve", "angles-tension"),
    "angles-compression": Experiment("rve", "angles-compression"),
    "sample-unturned": Experiment("multiscale", "sample", with_seeds(1, 5, UNTURNED)),
    "sample-own": Experiment("multiscale", "sample", with_seeds(1, 5, *OWN)),
    "sample-own-unturned": Experiment("multiscale", "sample", with_seeds(1, 5, *OWN, UNTURNED)),
    "confined": Experiment("lab", "confined"),
    "confined-slow": Experiment("lab", "confined", ((SLOW,),)),
    "sample-confined": Experiment("multiscale", "sample", with_seeds(1, 5, *under("5, 20, 60"))),
    "sample-5-mpa": Experiment("multiscale", "sample", with_seeds(5, 10, *under("5"))),
    "sample-finite": Experiment("multiscale", "sample", with_seeds(1, 4, *under("20, 60", TURNING))),
    "sample-finite-later-seeds": Experiment("multiscale", "sample", with_seeds(5, 10, *under("20, 60", TURNING))),
    "sample-finite-5-mpa": Experiment("multiscale", "sample", with_seeds(1, 10, *under("5", TURNING))),
    "sample-finite-uniaxial": Experiment(
        "multiscale", "sample", with_seeds(1, 10, "Tests/List = uniaxial_compression", TURNING)
    ),
    "sample-elements": Experiment("multiscale", "sample", with_seeds(1, 5, "Sample/Dealing = to elements")),
    "sample-edges": Experiment("multiscale", "sample", with_seeds(1, 5, at_boundary("edge"))),
}
for across, along in MESHES[1:]:
    EXPERIMENTS[f"sample-{across}-by-{along}"] = Experiment(
        "multiscale",
        "sample",
        with_seeds(
            1,
            1,
            "Tests/List = uniaxial_compression",
            f"Sample/Elements across = {across}",
            f"Sample/Elements along = {along}",
        ),
    )
RATES_OF_50_MM = (("Compression", 1.0), ("Tension", 0.164))
CONFINED_DIAMETERS_MM = DIAMETERS_MM[:2]
PRESSURES_OF_CYLINDERS_MPA = (10, 40)
CONFINED_CYLINDER = (
    "Tests/List = triaxial_compression",
    f"Tests/Confinements = {', '.join(map(str, PRESSURES_OF_CYLINDERS_MPA))} MPa",
    "Tests/Stop stress over peak = 0.9",
)
for width in WIDTHS_MM:
    one_gap = ("Variants/Entry = none", "Variants/Values = none", *at_width(width, *RATES_OF_50_MM))
    EXPERIMENTS[f"laboratory-{width}-mm"] = Experiment("lab", "laboratory", (one_gap,))
for sides, coring in (("cored", "sides only"), ("walled", "none")):
    body = (f"Specimen/Coring = {coring}", f"Specimen/Porosity = {POROSITIES[sides]}")
    for diameter in DIAMETERS_MM:
        EXPERIMENTS[f"{sides}-cylinder-{diameter:g}-mm"] = Experiment(
            "lab", "cylinder", ((*body, *at_width(diameter, *RATES_OF_50_MM)),)
        )
    if sides == "cored":  # that of 50 mm between walls is examples/beishan-cylinder/full-size.prm
        one = (*body, *at_width(50, *RATES_OF_50_MM), "Seeds/Seeds = 1")
        EXPERIMENTS["cored-cylinder-50-mm"] = Experiment("lab", "cylinder", (one,))
        EXPERIMENTS["cored-cylinder-50-mm-confined"] = Experiment("lab", "cylinder", ((*one, *CONFINED_CYLINDER),))
        for diameter in CONFINED_DIAMETERS_MM:
            three = (*body, *at_width(diameter, *RATES_OF_50_MM), *CONFINED_CYLINDER)
            EXPERIMENTS[f"cored-cylinder-{diameter:g}-mm-confined"] = Experiment("lab", "cylinder", (three,))
for opening in OPENINGS_UM:
    EXPERIMENTS[f"softening-{opening}-um"] = Experiment(
        "multiscale", "softening", ((f"Softening flat joint/Softening opening = {opening} um",),)
    )
for way, sizes in (("tension", SIZES_MM), ("compression", SIZES_MM[:3])):
    for size in sizes:
        EXPERIMENTS[f"boundaries-{way}-{size:g}-mm"] = Experiment(
            "rve", f"boundaries-{way}", ((f"Specimen/Width = {size:g} mm", f"Specimen/Height = {size:g} mm"),)
        )
for boundary in BOUNDARIES[:3]:
    EXPERIMENTS["same-cells-sample-" + boundary.replace(" ", "-")] = Experiment(
        "multiscale", "same-cells-sample", with_seeds(1, 1, at_boundary(boundary))
    )


def after_peak(rve, curve):
    """Stress along the axis, tension or compression positive: its peak, the work after it and what is left at the end."""
    sign = 1.0 if max(float(row["strain_yy"]) for row in curve) > 0.0 else -1.0
    strain = [sign * float(row["strain_yy"]) for row in curve]
    stress = [sign * float(row["stress_yy_Pa"]) for row in curve]
    peak = stress.index(max(stress))
    edge = rve["cell_m"][0][0] ** 2 + rve["cell_m"][1][0] ** 2
    work = sum(0.5 * (stress[k] + stress[k - 1]) * (strain[k] - strain[k - 1]) for k in range(peak + 1, len(curve)))
    return {
        "variant": rve["variant"],
        "seed": rve["seed"],
        "peak_stress_Pa": stress[peak],
        "strain_at_peak": strain[peak],
        "strain_at_end": strain[-1],
        "work_after_peak_J_per_m2": work * math.sqrt(edge),  # of the one crack across the cell
        "stress_at_end_over_peak": stress[-1] / stress[peak],
    }


# Orders of the waves in which late cracks may lie: bands that close on themselves after one or two crossings of the cell.
WAVES = ((1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (2, -1), (1, -2))


def band(rve, cracks, strain_at_peak):
    """The plane wave that the cracks from 97 % of the strain at the peak on (the last 60 at least) follow most: the angle of
    its crests to the axis [degrees, 0 to 90] and its amplitude over that of cracks on a line (1) or everywhere (0)."""
    late = [crack for crack in cracks if -float(crack["strain_yy"]) >= 0.97 * strain_at_peak]
    late = late if len(late) >= 60 else cracks[-60:]
    a, b = rve["cell_m"][:2]
    area = a[0] * b[1] - a[1] * b[0]
    reciprocal = [[2.0 * math.pi * x / area for x in way] for way in ((b[1], -b[0]), (-a[1], a[0]))]
    found = []
    for n, m in WAVES:
        wave = [n * one + m * other for one, other in zip(*reciprocal)]
        phases = [(float(c["size_m"]), wave[0] * float(c["x_m"]) + wave[1] * float(c["y_m"])) for c in late]
        total = sum(size * cmath.exp(1j * phase) for size, phase in phases)
        across = math.degrees(math.atan2(wave[1], wave[0])) % 180.0
        found.append((abs(total) / sum(size for size, _ in phases), min(across, 180.0 - across)))
    share, angle = max(found)
    return {"band_to_axis_deg": angle, "band_share": share}


def run(feldspar, name):
    experiment = EXPERIMENTS[name]
    with tempfile.TemporaryDirectory() as folder:
        outs = []
        for entries in experiment.runs:
            outs.append(os.path.join(folder, f"out-{len(outs)}"))
            settings = [word for entry in entries for word in ("--set", entry)]
            outcome = subprocess.run(
                [feldspar, experiment.command, experiment.input, "--output", outs[-1], "--quiet", *settings],
                check=False,
            )
            if outcome.returncode not in (0, 2):  # a path or test that ended early is a result too
                sys.exit(f"{name}: exit code {outcome.returncode}")
        keep(name, outs)


def add_ends(out, summary):
    """Adds the last row of its curve to each test."""
    for test in summary["tests"]:
        with open(os.path.join(out, "curves", test["name"] + ".csv"), encoding="utf-8") as file:
            row = list(csv.DictReader(file))[-1]
        test["strain_at_end"] = abs(float(row["axial_strain"]))
        test["stress_at_end_Pa"] = abs(float(row["axial_stress_Pa"]))


def add_largest_falls(out, summary):
    """Adds to each test the step in which its stress fell most: the stress before and after, and the cracks in it."""
    for test in summary["tests"]:
        with open(os.path.join(out, "curves", test["name"] + ".csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        stress = [float(row["axial_stress_Pa"]) for row in rows]
        cracks = [int(row["n_tension_cracks"]) + int(row["n_shear_cracks"]) for row in rows]
        k = max(range(1, len(rows)), key=lambda row: stress[row - 1] - stress[row])
        test["largest_fall"] = {
            "stress_before_Pa": stress[k - 1],
            "stress_after_Pa": stress[k],
            "n_cracks_before": cracks[k - 1],
            "n_cracks": cracks[k] - cracks[k - 1],
        }


def stress_at(n, rows):
    """At which so many segments are broken, of (stress, number) rows; their number grows as an exponential of the stress."""
    for (before, n_before), (after, n_after) in itertools.pairwise(rows):
        if n_after >= n:
            if n_before > 0:
                n, n_before, n_after = math.log(n), math.log(n_before), math.log(n_after)
            return abs(before + (after - before) * (n - n_before) / (n_after - n_before))
    return None


def add_first_cracks(out, summary, n_points):
    """Adds to each test the stress at which a share of all its segments is broken; null where it is not reached."""
    for test in summary["tests"]:
        with open(os.path.join(out, "curves", test["name"] + ".csv"), encoding="utf-8") as file:
            rows = [
                (float(row["axial_stress_Pa"]), int(row["n_tension_cracks"]) + int(row["n_shear_cracks"]))
                for row in csv.DictReader(file)
            ]
        n_segments = N_SEGMENTS * n_points * test["n_joints"]  # of a sample by its first packing
        test["stress_at_broken_share_Pa"] = {share: stress_at(float(share) * n_segments, rows) for share in BROKEN_SHARES}


def keep(name, outs):
    """The summaries of result folders as results/NAME.json: that of the first, with the tests or paths of all."""
    summaries = []
    for out in outs:
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            summaries.append(json.load(file))
        if name in ("sample-confined", "sample-finite", "sample-finite-later-seeds"):
            add_ends(out, summaries[-1])
        if name.startswith("softening"):
            add_largest_falls(out, summaries[-1])
        if name.startswith("first-cracks"):
            add_first_cracks(out, summaries[-1], N_POINTS if name.endswith("sample") else 1)
    summary = summaries[0]
    command = EXPERIMENTS[name].command
    if command == "multiscale":
        tests = [test for one in summaries for test in one["tests"] if not test["interrupted"]]
        summary["tests"] = sorted(tests, key=lambda test: (test["seed"], test["kind"]))
        for of_first in ("ensemble", "fits", "verdict"):
            summary.pop(of_first, None)
    if name.startswith("angles"):
        summary["after_peak"] = []
        cracks = {}
        with open(os.path.join(outs[0], "cracks.csv"), encoding="utf-8") as file:
            for crack in csv.DictReader(file):
                cracks.setdefault(crack["rve"], []).append(crack)
        for rve in summary["rves"]:
            with open(os.path.join(outs[0], "curves", rve["name"] + ".csv"), encoding="utf-8") as file:
                curve = list(csv.DictReader(file))
            if rve["at_end"]["strain_yy"] != 0.0:  # else it found no equilibrium at its first increment
                row = after_peak(rve, curve)
                if name == "angles-compression":
                    row |= {"ended_early": "ended_early" in rve, **band(rve, cracks[rve["name"]], row["strain_at_peak"])}
                summary["after_peak"].append(row)
        if name == "angles-compression":
            del summary["rves"]  # 140, told by after_peak
    path = os.path.join(RESULTS, name + ".json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(summary, file)
    subprocess.run([os.path.join(HERE, "../../scripts/keep-results.py"), path], check=True)


def results(name):
    path = os.path.join(RESULTS, name + ".json")
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def tests_of(name, kind, variant=None):
    tests = (results(name) or {"tests": ()})["tests"]
    return [
        test
        for test in tests
        if test["kind"] == kind and "peak_stress_Pa" in test and (variant is None or test["variant"].endswith(variant))
    ]


def peaks(name, kind, variant=None):
    return [test["peak_stress_Pa"] / 1e6 for test in tests_of(name, kind, variant)]


BODIES = (
    ("walled, gap 0.0237", "laboratory", "0.0237"),
    ("walled, gap 0.0457", "laboratory", "0.0457"),
    ("cored, gap 0.0457", "cored", "= free sides"),
    ("cored at the sides only, gap 0.0457", "cored", "= sides only"),
    ("sample, gap 0.0457", "sample", None),
)


def crushed_at(rate):
    """Returns the UCS at a rate by seed [MPa]."""
    tests = tests_of("rate", "uniaxial_compression", f"= {rate} 1/s")
    return {test["seed"]: test["peak_stress_Pa"] / 1e6 for test in tests}


def of_angle(name, key):
    """Returns values by angle, one a packing."""
    summary = results(name)
    table = {}
    for row in summary["after_peak"] if summary else []:
        table.setdefault(int(float(row["variant"].split("=")[1].split()[0])), []).append(row[key])
    return table


def draw():
    """UCS of the bodies; strength and work of a cell over its angle."""
    script = [
        'set terminal pngcairo size 1320,440 font "sans,11"',
        f'set output "{FIGURE}"',
        "set multiplot layout 1,3",
        "set style data yerrorbars",
        "set bars 0.6",
        "unset key",
        "set bmargin 5",
    ]
    short = ("walled\\n0.0237", "walled\\n0.0457", "cut all\\nround", "cut at\\nsides", "sample\\nturned")
    bars = [(label, peaks(name, "uniaxial_compression", variant)) for label, (_, name, variant) in zip(short, BODIES)]
    bars.insert(-1, ("sides,\\n0.25/s", list(crushed_at("0.25").values())))
    bars.append(("sample\\nas it lies", peaks("sample-unturned", "uniaxial_compression")))
    bars = [(label, values) for label, values in bars if len(values) > 1]
    tics = ", ".join(f'"{label}" {k}' for k, (label, _) in enumerate(bars))
    script += ['set title "Bodies: mean and single seeds"', 'set ylabel "UCS [MPa]"', "set yrange [80:260]"]
    script += [f"set xtics ({tics}) font \"sans,8\"", f"set xrange [-0.6:{len(bars) - 0.4}]"]
    script += ["$mean << EOD"] + [f"{k} {statistics.mean(v)} {statistics.stdev(v)}" for k, (_, v) in enumerate(bars)]
    script += ["EOD", "$single << EOD"] + [f"{k + 0.15} {x}" for k, (_, v) in enumerate(bars) for x in v] + ["EOD"]
    script.append(
        'plot $single with points pt 7 ps 0.6 lc rgb "#a0a0a0", $mean with yerrorbars pt 5 ps 1.2 lw 2 lc rgb "#0050c8"'
    )
    script += ["set xtics auto font \"sans,11\"", "set xrange [-8:98]", "set xtics 0,15,90", "set key bottom right"]
    script += ['set xlabel "angle of the cell [deg]"']
    script += ['set title "One cell turned: 5 pulled, 20 pressed"', 'set ylabel "strength over its mean"']
    script += ["set yrange [0:1.6]"]
    for block, name in (("tension", "angles-tension"), ("compression", "angles-compression")):
        table = of_angle(name, "peak_stress_Pa")
        script.append(f"${block} << EOD")
        if table:
            mean = statistics.mean(value for values in table.values() for value in values)
            for angle in sorted(table):
                over = [value / mean for value in table[angle]]
                shift = -1.5 if block == "tension" else 1.5
                script.append(f"{angle + shift} {statistics.mean(over)} {statistics.stdev(over)}")
        script.append("EOD")
    script.append(
        'plot $tension with yerrorbars pt 7 lw 2 lc rgb "#008060" title "tension", '
        '$compression with yerrorbars pt 5 lw 2 lc rgb "#0050c8" title "uniaxial compression"'
    )
    script += ['set title "Work after the tensile peak"', 'set ylabel "work over area [J/m²]"', "set yrange [0:20]"]
    script += ["unset key", "$work << EOD"]
    for angle, values in sorted(of_angle("angles-tension", "work_after_peak_J_per_m2").items()):
        script.append(f"{angle} {statistics.mean(values)} {statistics.stdev(values)}")
    script += ["EOD", 'plot $work with yerrorbars pt 7 lw 2 lc rgb "#008060"']
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, cwd=RESULTS, check=True)


def main():
    feldspar = os.path.realpath(sys.argv[1])
    names = sys.argv[2:]
    if names == ["all"]:
        names = list(EXPERIMENTS)
    if names:
        subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), feldspar], check=True)
    for name in names:
        run(feldspar, name)
    draw()


if __name__ == "__main__":
    main()
