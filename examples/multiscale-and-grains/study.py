#!/usr/bin/env python3
"""Runs the experiments of this folder and writes their results; without names only tables and figure are made anew.

    python3 examples/multiscale-and-grains/study.py FELDSPAR [NAME ...]

NAME is an experiment of EXPERIMENTS, or all. results/NAME.json is the summary of its run; for turned cells it also has
the course after the peak (after_peak), read off the curves, and of cells by their boundaries only what is told of them
(TOLD_OF_CELLS). Prints the tables of the README and draws ../../docs/figures/multiscale-and-grains.png (gnuplot).
"""

import cmath
import csv
import itertools
import json
import math
import os
import re
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


PRESSURES_MPA = (5, 20, 60)
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


# Not the end of their paths: a cell that is torn apart holds nothing there but round-off.
TOLD_OF_CELLS = (
    "name",
    "seed",
    "variant",
    "boundary",
    "n_grains",
    "n_joints",
    "coordination_number",
    "installation_gap_ratio",
    "porosity",
    "cell_m",
    "stiffness_Pa",
    "youngs_modulus_Pa",
    "poissons_ratio",
    "highest_stress",
    "lowest_stress",
    "increments",
    "ended_early",
    "energy_imbalance",
    "hill_mandel_residual",
    "wall_time_s",
)


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
    if name.startswith("boundaries"):
        summary["rves"] = [{key: rve[key] for key in TOLD_OF_CELLS if key in rve} for rve in summary["rves"]]
    with open(os.path.join(RESULTS, name + ".json"), "w", encoding="utf-8") as file:
        file.write(json.dumps(summary, indent=2) + "\n")


def results(name):
    path = os.path.join(RESULTS, name + ".json")
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def tests_of(name, kind, variant=None):
    summary = results(name)
    if summary is None:
        return []
    return [
        test
        for test in summary["tests"]
        if test["kind"] == kind
        and test["peak_stress_Pa"] is not None
        and (variant is None or test["variant"].endswith(variant))
    ]


def peaks(name, kind, variant=None):
    return [test["peak_stress_Pa"] / 1e6 for test in tests_of(name, kind, variant)]


def shown(values, decimals):
    if not values:
        return "–"
    if len(values) == 1:
        return f"{values[0]:.{decimals}f}"
    return f"{statistics.mean(values):.{decimals}f} ± {statistics.stdev(values):.{decimals}f}"


def difference(one, other):
    """Of the means, over the other, with its 95 % interval by Welch's t [%]."""
    mean = statistics.mean(one) - statistics.mean(other)
    of_one, of_other = statistics.variance(one) / len(one), statistics.variance(other) / len(other)
    error = math.sqrt(of_one + of_other)
    degrees = (of_one + of_other) ** 2 / (of_one**2 / (len(one) - 1) + of_other**2 / (len(other) - 1))
    # Student's t by the expansion of Cornish and Fisher, exact to a thousandth from four degrees of freedom on.
    z = 1.959964
    t = z + (z**3 + z) / (4 * degrees) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * degrees**2)
    scale = 100.0 / statistics.mean(other)
    return f"{scale * mean:+.0f} ± {scale * t * error:.0f} %"


BODIES = (
    ("walled, gap 0.0237", "laboratory", "0.0237"),
    ("walled, gap 0.0457", "laboratory", "0.0457"),
    ("cored, gap 0.0457", "cored", "= free sides"),
    ("cored at the sides only, gap 0.0457", "cored", "= sides only"),
    ("sample, gap 0.0457", "sample", None),
)


RATES = ("1", "0.5", "0.25")


def crushed_at(rate):
    """By seed, UCS at a rate [MPa]."""
    tests = tests_of("rate", "uniaxial_compression", f"= {rate} 1/s")
    return {test["seed"]: test["peak_stress_Pa"] / 1e6 for test in tests}


def slow_tests():
    return tests_of("rate", "uniaxial_compression", "= 0.25 1/s")


def print_rates():
    print("| rate [1/s] | UCS [MPa] | over that at 1/s, seed by seed |\n|---|---|---|")
    fast = crushed_at("1")
    for rate in RATES:
        strengths = crushed_at(rate)
        shares = [strengths[seed] / fast[seed] for seed in strengths]
        print(f"| {rate} | {shown(list(strengths.values()), 1)} | {shown(shares, 3)} |")
    print()


def print_bodies():
    print("| body | seeds | gap | z in the bulk | porosity | σ_t [MPa] | UCS [MPa] | E_0 [GPa] | σ_ci [MPa] |")
    print("|---|---|---|---|---|---|---|---|---|")
    for label, name, variant in BODIES:
        crushed = tests_of(name, "uniaxial_compression", variant)
        if not crushed:
            continue
        column = lambda key, scale: [test[key] / scale for test in crushed if test[key] is not None]
        cells = [
            label,
            str(len(crushed)),
            f"{statistics.mean(column('installation_gap_ratio', 1.0)):.4f}",
            f"{statistics.mean(column('coordination_number_core', 1.0)):.2f}",
            f"{statistics.mean(column('porosity', 1.0)):.3f}",
            shown(peaks(name, "direct_tension", variant), 2),
            shown(column("peak_stress_Pa", 1e6), 1),
            shown(column("youngs_modulus_initial_Pa", 1e9), 1),
            shown(column("crack_initiation_stress_Pa", 1e6), 1),
        ]
        print(f"| {' | '.join(cells)} |")
    print()


BEFORE_THE_PEAK = (  # key of a test, heading, unit, decimals
    ("crack_initiation_stress_Pa", "σ_ci [MPa]", 1e6, 0),
    ("crack_initiation_stress_lateral_Pa", "σ_ci by the lateral strain [MPa]", 1e6, 0),
    ("crack_damage_stress_Pa", "σ_cd [MPa]", 1e6, 0),
    ("poissons_ratio_initial", "ν, initial", 1.0, 3),
    ("poissons_ratio_secant", "ν, at half of the peak", 1.0, 2),
)


def print_before_the_peak():
    """How damage begins in uniaxial compression; what separates the samples from the grains at 0.25/s."""
    bodies = (
        ("cored at the sides only, 1/s", "cored", "= sides only"),
        ("cored at the sides only, 0.25/s", "rate", "= 0.25 1/s"),
        ("sample", "sample", None),
        ("sample, edge cells", "sample-edges", None),
    )
    print(f"| body | seeds | {' | '.join(heading for _, heading, _, _ in BEFORE_THE_PEAK)} |")
    print("|---" * (2 + len(BEFORE_THE_PEAK)) + "|")
    columns = {}
    for label, name, variant in bodies:
        crushed = tests_of(name, "uniaxial_compression", variant)
        if crushed:
            columns[name] = [
                [test[key] / unit for test in crushed if test[key] is not None] for key, _, unit, _ in BEFORE_THE_PEAK
            ]
            cells = [shown(values, decimals) for values, (_, _, _, decimals) in zip(columns[name], BEFORE_THE_PEAK)]
            print(f"| {label} | {len(crushed)} | {' | '.join(cells)} |")
    for label, name, _ in bodies[2:]:
        if name in columns:
            cells = [difference(one, other) for one, other in zip(columns[name], columns["rate"])]
            print(f"| {label}, from the grains at 0.25/s | | {' | '.join(cells)} |")
    print()


def print_first_cracks():
    """The stress at equal shares of broken segments."""
    print("| broken segments, of all | grains, 0.25/s [MPa] | sample [MPa] | sample from grains |\n|---|---|---|---|")
    names = ("first-cracks-grains", "first-cracks-sample")
    if not all(results(name) for name in names):
        return
    for share in BROKEN_SHARES:
        grains, sample = (
            [test["stress_at_broken_share_Pa"][share] / 1e6 for test in results(name)["tests"]] for name in names
        )
        cells = [f"{1e3 * float(share):g} ‰", shown(grains, 1), shown(sample, 1), difference(sample, grains)]
        print(f"| {' | '.join(cells)} |")
    print()


DEALINGS = (
    ("4 packings, turned", "sample"),
    ("4 packings, as they lie", "sample-unturned"),
    ("one a point, turned", "sample-own"),
    ("one a point, as they lie", "sample-own-unturned"),
    ("4 packings, one an element, turned", "sample-elements"),
    ("4 packings, as they lie, edge cells at the sides", "sample-edges"),
)


def print_dealings():
    """T8: samples by the packings at their points, over the seeds that all of them have."""
    print("| cells | seeds | σ_t [MPa] | UCS [MPa] | strain at it [1e-3] | σ_ci [MPa] | over turned, seed by seed |")
    print("|---|---|---|---|---|---|---|")
    base = {test["seed"]: test for test in tests_of("sample", "uniaxial_compression")}
    for label, name in DEALINGS:
        crushed = [test for test in tests_of(name, "uniaxial_compression") if test["seed"] <= 5]
        if not crushed:
            continue
        pulled = [test for test in tests_of(name, "direct_tension") if test["seed"] <= 5]
        column = lambda tests, key, scale: [test[key] / scale for test in tests if test[key] is not None]
        ratios = [test["peak_stress_Pa"] / base[test["seed"]]["peak_stress_Pa"] for test in crushed]
        cells = [
            label,
            str(len(crushed)),
            shown(column(pulled, "peak_stress_Pa", 1e6), 1),
            shown(column(crushed, "peak_stress_Pa", 1e6), 0),
            shown(column(crushed, "strain_at_peak", 1e-3), 2),
            shown(column(crushed, "crack_initiation_stress_Pa", 1e6), 0),
            shown(ratios, 2),
        ]
        print(f"| {' | '.join(cells)} |")
    print()


def without_surface(kind):
    """Of cylinders cut free at their sides: the strength by a line over 1/diameter, where that is nothing [MPa]."""
    inverse, strengths = [], []
    for diameter in DIAMETERS_MM:
        for strength in peaks(f"cored-cylinder-{diameter:g}-mm", kind):
            inverse.append(1 / diameter)
            strengths.append(strength)
    return statistics.linear_regression(inverse, strengths).intercept


def print_sizes():
    """T4 and T5: specimens of several sizes, of one gap, crossed by as many waves: in the plane, then cylinders."""
    print("| body | width [mm] | specimens | joints a grain in the bulk | porosity | σ_t [MPa] | UCS [MPa] | E_0 [GPa] |")
    print("|---|---|---|---|---|---|---|---|")
    bodies = [("walled, plane", width, f"laboratory-{width}-mm", None) for width in WIDTHS_MM]
    bodies.insert(1, ("walled, plane", 50, "laboratory", "Flat joint/Installation gap ratio = 0.0457"))
    for sides in ("walled", "cored"):
        label = f"{sides} cylinder" if sides == "walled" else "cylinder cut free at its sides"
        bodies += [(label, diameter, f"{sides}-cylinder-{diameter:g}-mm", None) for diameter in DIAMETERS_MM]
        large = "cored-cylinder-50-mm" if sides == "cored" else "../../beishan-cylinder/results/full-size-tests"
        bodies.append((label, 50, large, None))
    for label, width, name, variant in bodies:
        pulled, crushed = (tests_of(name, kind, variant) for kind in ("direct_tension", "uniaxial_compression"))
        if not crushed:
            continue
        column = lambda tests, key, scale, decimals: shown([test[key] / scale for test in tests], decimals)
        cells = [
            label,
            f"{width:g}",
            str(len(crushed)),
            column(crushed, "coordination_number_core", 1, 2),
            column(crushed, "porosity", 1, 3),
            column(pulled, "peak_stress_Pa", 1e6, 1),
            column(crushed, "peak_stress_Pa", 1e6, 0),
            column(crushed, "youngs_modulus_initial_Pa", 1e9, 1),
        ]
        print(f"| {' | '.join(cells)} |")
    for kind in ("direct_tension", "uniaxial_compression"):
        print(f"cylinders cut free, {kind}: {without_surface(kind):.1f} MPa where 1 / diameter is nothing")
    print()


CONFINED_CYLINDERS = (  # label, width [mm], results at each pressure
    ("walled cylinder", 20, 2 * ("../../beishan-cylinder/results/beishan-cylinder",)),
    ("walled cylinder", 50, [f"../../beishan-cylinder/results/full-size-triaxial-{p}" for p in PRESSURES_OF_CYLINDERS_MPA]),
    *(
        ("cylinder cut free at its sides", diameter, 2 * (f"cored-cylinder-{diameter:g}-mm-confined",))
        for diameter in (*CONFINED_DIAMETERS_MM, 50)
    ),
)


def print_confined_cylinders():
    """Cylinders of several sizes, of one gap, between walls and cut free at their sides, under pressure."""
    at = [f"σ_1 at {pressure} MPa [MPa] | at a strain of [1e-3]" for pressure in PRESSURES_OF_CYLINDERS_MPA]
    print(f"| body | width [mm] | specimens | {' | '.join(at)} |\n|---|---|---|---|---|---|---|")
    for label, width, names in CONFINED_CYLINDERS:
        cells = []
        for name, pressure in zip(names, PRESSURES_OF_CYLINDERS_MPA):
            tests = [
                test for test in tests_of(name, "triaxial_compression") if test["confining_pressure_Pa"] == 1e6 * pressure
            ]
            cells += [
                shown([test["peak_stress_Pa"] / 1e6 for test in tests], 0),
                shown([test["strain_at_peak"] * 1e3 for test in tests], 1),
            ]
        print(f"| {label} | {width:g} | {len(tests)} | {' | '.join(cells)} |")
    print()


def print_confined():
    """Strengths under pressure beside those without; where a sample has no peak, what it bore at the end."""
    print(
        "| pressure [MPa] | grains, 1/s: σ_1 [MPa] | grains, 0.25/s: σ_1 [MPa] | over that at 1/s, seed by seed "
        "| sample: σ_1 [MPa] | sample from grains at 1/s and at 0.25/s | σ_ci: grains at 1/s, sample [MPa] |"
    )
    print("|---|---|---|---|---|---|---|")
    for pressure in PRESSURES_MPA:
        bodies = [
            [
                test
                for name in names
                for test in (results(name) or {"tests": ()})["tests"]
                if round(test["confining_pressure_Pa"] / 1e6) == pressure
            ]
            for names in (("confined",), ("confined-slow",), ("sample-confined", "sample-5-mpa"))
        ]
        highest = [
            [(test["peak_stress_Pa"] or test["stress_at_end_Pa"]) / 1e6 for test in tests] for tests in bodies
        ]
        initiation = [
            [test["crack_initiation_stress_Pa"] / 1e6 for test in tests if test["crack_initiation_stress_Pa"] is not None]
            for tests in bodies
        ]
        n_rising = sum(test["peak_stress_Pa"] is None for test in bodies[2])
        without_peak = f", {n_rising} of {len(bodies[2])} without a peak up to 1.2 %" if n_rising else ""
        fast = {test["seed"]: test["peak_stress_Pa"] for test in bodies[0]}
        cells = [
            str(pressure),
            shown(highest[0], 0),
            shown(highest[1], 0),
            shown([test["peak_stress_Pa"] / fast[test["seed"]] for test in bodies[1]], 3),
            shown(highest[2], 0) + without_peak,
            f"{difference(highest[2], highest[0])}, {difference(highest[2], highest[1])}",
            f"{shown(initiation[0], 0)}, {shown(initiation[2], 0)}",
        ]
        print(f"| {' | '.join(cells)} |")
    print()


def print_kinematics():
    """The sample under pressure by both kinematics of its cells: the highest stress and its strain."""
    print("| pressure [MPa] | seed | small strains: highest σ_1 [MPa] | at [1e-3] ", end="")
    print("| finite: highest σ_1 [MPa] | at [1e-3] |")
    print("|---|---|---|---|---|---|")

    def by_pressure_and_seed(name):
        tests = (results(name) or {"tests": ()})["tests"]
        pressed = [test for test in tests if test["kind"] != "direct_tension"]
        return {(round(test["confining_pressure_Pa"] / 1e6), test["seed"]): test for test in pressed}

    small, finite = {}, {}
    for name in ("sample", "sample-confined", "sample-5-mpa"):
        small |= by_pressure_and_seed(name)
    for name in ("sample-finite-uniaxial", "sample-finite-5-mpa", "sample-finite", "sample-finite-later-seeds"):
        finite |= by_pressure_and_seed(name)
    for key in sorted(finite):
        cells = [str(part) for part in key]
        for one in (small.get(key), finite[key]):
            if one is None:  # not run
                cells += ["–", "–"]
                continue
            has_peak = one["peak_stress_Pa"] is not None
            cells.append(f"{(one['peak_stress_Pa'] or one['stress_at_end_Pa']) / 1e6:.0f}")
            cells.append(f"{1e3 * one['strain_at_peak']:.1f}" if has_peak else "no peak")
        print(f"| {' | '.join(cells)} |")

    def highest(test):
        return (test["peak_stress_Pa"] or test["stress_at_end_Pa"]) / 1e6

    slow = {0: list(crushed_at("0.25").values())}
    for test in (results("confined-slow") or {"tests": ()})["tests"]:
        slow.setdefault(round(test["confining_pressure_Pa"] / 1e6), []).append(highest(test))
    for pressure in sorted({key[0] for key in finite}):
        keys = [key for key in finite if key[0] == pressure]
        ratios = [highest(finite[key]) / highest(small[key]) for key in keys if key in small]
        values = [highest(finite[key]) for key in keys]
        print(f"| {pressure} | {len(keys)} | {shown(values, 0)} | {shown(ratios, 3)} ({len(ratios)}) |")
        print(f"from grains at 0.25/s: {difference(values, slow[pressure])}")
    print()

    grains = {(0, test["seed"]): test for test in slow_tests()}
    for test in (results("confined-slow") or {"tests": ()})["tests"]:
        grains[round(test["confining_pressure_Pa"] / 1e6), test["seed"]] = test
    bodies = {"grains, 0.25/s": grains, "sample, small strains": small, "sample, contacts turn": finite}
    print("| without pressure | highest σ_1 [MPa] | at a strain of [1e-3] |\n|---|---|---|")
    for name, tests in bodies.items():
        pressed = [test for (pressure, _), test in tests.items() if pressure == 0]
        strains = [1e3 * test["strain_at_peak"] for test in pressed]
        print(f"| {name} | {shown([highest(test) for test in pressed], 0)} | {shown(strains, 2)} |")
    print("\n| pressure [MPa] | body | σ_ci [MPa] | σ_cd [MPa] | ν at half of the peak |\n|---|---|---|---|---|")
    for pressure in PRESSURES_MPA:
        of_grains = {}
        for name, tests in bodies.items():
            cells, differences = [], []
            for key, scale, decimals in (
                ("crack_initiation_stress_Pa", 1e6, 0),
                ("crack_damage_stress_Pa", 1e6, 0),
                ("poissons_ratio_secant", 1.0, 3),
            ):
                values = [
                    test[key] / scale for (at, _), test in tests.items() if at == pressure and test[key] is not None
                ]
                of_grains.setdefault(key, values)
                count = f" ({len(values)})" if decimals == 0 else ""
                cells.append(shown(values, decimals) + count)
                differences.append(difference(values, of_grains[key]))
            print(f"| {pressure} | {name} | {' | '.join(cells)} |")
            if tests is not grains:
                print(f"from grains at 0.25/s: {', '.join(differences)}")
    print()


def print_meshes():
    """One seed on each mesh; four points an element, cells of one size."""
    print("| elements | points | UCS [MPa] | strain at it [1e-3] | σ_ci [MPa] | E_0 [GPa] | over that of 2 × 4 elements |")
    print("|---|---|---|---|---|---|---|")
    base = None
    for across, along in MESHES:
        name = "sample" if (across, along) == MESHES[0] else f"sample-{across}-by-{along}"
        for test in tests_of(name, "uniaxial_compression"):
            if test["seed"] == 1:
                strength = test["peak_stress_Pa"] / 1e6
                base = base or strength
                cells = [
                    f"{across} × {along}",
                    str(4 * across * along),
                    f"{strength:.1f}",
                    f"{test['strain_at_peak'] * 1e3:.1f}",
                    f"{test['crack_initiation_stress_Pa'] / 1e6:.0f}",
                    f"{test['youngs_modulus_initial_Pa'] / 1e9:.1f}",
                    f"{strength / base:.2f}",
                ]
                print(f"| {' | '.join(cells)} |")
    print()


SAME_CELLS = (
    ("grains side by side, 1/s", "same-cells-grains"),
    ("periodic", "same-cells-sample"),
    ("periodic, turned at random", "same-cells-sample-turned"),
) + tuple(
    (boundary, "same-cells-sample-" + boundary.replace(" ", "-")) for boundary in BOUNDARIES[:3]
)


def print_same_cells():
    """Values of the single seeds; the time of one point's response from all its iterations and cascades."""
    print("| body | σ_t [MPa] | UCS [MPa] | σ_ci [MPa] | E_0 [GPa] | energy, at most off by | a response takes [ms] |")
    print("|---|---|---|---|---|---|---|")
    for label, name in SAME_CELLS:
        crushed = tests_of(name, "uniaxial_compression")
        if not crushed:
            continue
        listed = lambda values, decimals: ", ".join(f"{value:.{decimals}f}" for value in values)
        cells = [
            label,
            listed(peaks(name, "direct_tension"), 1),
            listed(peaks(name, "uniaxial_compression"), 0),
            listed([test["crack_initiation_stress_Pa"] / 1e6 for test in crushed], 0),
            listed([test["youngs_modulus_initial_Pa"] / 1e9 for test in crushed], 1),
            f"{100 * max(test['energy_imbalance_over_work'] for test in crushed):.1f} %",
        ]
        times = []
        for test in crushed:
            if "solver_work" in test:
                work = test["solver_work"]
                times.append(1e3 * work["seconds_in_points"] / ((work["iterations"] + work["cascades"]) * N_POINTS))
        print(f"| {' | '.join(cells + [listed(times, 0) or '–'])} |")
    print()


def of_angle(name, key):
    """By angle, one value a packing."""
    summary = results(name)
    table = {}
    for row in summary["after_peak"] if summary else []:
        table.setdefault(int(float(row["variant"].split("=")[1].split()[0])), []).append(row[key])
    return table


def print_angles():
    print("| angle [deg] | σ_t [MPa] | work after it [J/m²] | left at the end | UCS [MPa] |\n|---|---|---|---|---|")
    columns = (
        ("angles-tension", "peak_stress_Pa", 1e6, 2),
        ("angles-tension", "work_after_peak_J_per_m2", 1.0, 2),
        ("angles-tension", "stress_at_end_over_peak", 1.0, 2),
        ("angles-compression", "peak_stress_Pa", 1e6, 0),
    )
    tables = [(of_angle(name, key), scale, decimals) for name, key, scale, decimals in columns]
    for angle in sorted(tables[0][0]):
        cells = [shown([v / scale for v in table.get(angle, [])], decimals) for table, scale, decimals in tables]
        print(f"| {angle} | {' | '.join(cells)} |")
    print()


ALONG = (0, 45, 90)  # angles at which a diagonal or an edge of the cell lies along the axis
WEAK = 200.0  # MPa


def print_weak_cells():
    """What a cell in compression can fail by."""
    rows = results("angles-compression")["after_peak"]
    print(f"| angle | cells | UCS [MPa] | below {WEAK:g} MPa | no equilibrium found | cracks in a band 10 to 35 deg from the axis |")
    print("|---|---|---|---|---|---|")
    groups = {"along the axis: 0, 45, 90 deg": [], "oblique: 15, 30, 60, 75 deg": []}
    for row in rows:
        angle = int(float(row["variant"].split("=")[1].split()[0]))
        groups[tuple(groups)[angle not in ALONG]].append(row)
    strengths = {}
    for label, cells in groups.items():
        strengths[label] = [row["peak_stress_Pa"] / 1e6 for row in cells]
        oblique = [row for row in cells if 10.0 <= row["band_to_axis_deg"] <= 35.0]
        weak = sum(strength < WEAK for strength in strengths[label])
        early = sum(row["ended_early"] for row in cells)
        weak_oblique = sum(row["peak_stress_Pa"] < WEAK * 1e6 for row in oblique)
        print(
            f"| {label} | {len(cells)} | {shown(strengths[label], 0)} | {weak} | {early} | "
            f"{len(oblique)}, of those below {WEAK:g} MPa {weak_oblique} |"
        )
    print(f"oblique from along: {difference(*reversed(strengths.values()))}\n")


def cells_of(way, size, boundary):
    """By seed."""
    summary = results(f"boundaries-{way}-{size:g}-mm")
    return {rve["seed"]: rve for rve in (summary["rves"] if summary else []) if rve["boundary"].startswith(boundary)}


def strengths_of(way, size, boundary):
    """By seed, along the axis [MPa]."""
    key, sign = ("highest_stress", 1e-6) if way == "tension" else ("lowest_stress", -1e-6)
    return {seed: sign * rve[key]["yy"]["stress_Pa"] for seed, rve in cells_of(way, size, boundary).items()}


def print_boundaries():
    """The bracket: a row a size and boundary, means over the packings; then how it narrows and where it fails."""
    print("| edge [mm] | boundary | E [GPa] | σ_t [MPa] | UCS [MPa] | pressed to the end |\n|---|---|---|---|---|---|")
    moduli = {}
    for size in SIZES_MM:
        for boundary in BOUNDARIES:
            pulled, pressed = (cells_of(way, size, boundary) for way in ("tension", "compression"))
            moduli[size, boundary] = [rve["youngs_modulus_Pa"] / 1e9 for rve in pulled.values()]
            cells = [
                f"{size:g}",
                boundary,
                shown(moduli[size, boundary], 1),
                shown(list(strengths_of("tension", size, boundary).values()), 1),
                shown(list(strengths_of("compression", size, boundary).values()), 0),
                f"{sum('ended_early' not in rve for rve in pressed.values())} of {len(pressed)}" if pressed else "–",
            ]
            print(f"| {' | '.join(cells)} |")
    print()
    for size in SIZES_MM:
        mean = {boundary: statistics.mean(moduli[size, boundary] or [math.nan]) for boundary in BOUNDARIES}
        width = (mean["affine"] - mean["minimal kinematic"]) / mean["periodic"]
        print(f"bracket of E over E, {size:g} mm: {100 * width:.1f} %, times the edge {width * size:.2f} mm")
    for way in ("tension", "compression"):
        for below, above in (("minimal kinematic", "periodic"), ("periodic", "affine")):
            pairs = [
                (strength, strengths_of(way, size, above)[seed])
                for size in SIZES_MM
                for seed, strength in strengths_of(way, size, below).items()
            ]
            wrong = sum(one > other for one, other in pairs)
            print(f"{way}: {below} stronger than {above} in {wrong} of {len(pairs)} packings")
    print()


def print_one_cell():
    """A minimal kinematic cell beside a body of the same packing that is cut free on all sides."""
    print("| packings | | cell [MPa] | body [MPa] | cell over body, packing by packing |\n|---|---|---|---|---|")
    for kind, way, key, sign in (
        ("direct_tension", "tension", "highest_stress", 1e-6),
        ("uniaxial_compression", "compression", "lowest_stress", -1e-6),
    ):
        body = {test["seed"]: test["peak_stress_Pa"] / 1e6 for test in tests_of("one-box", kind)}
        rves = (results(f"one-cell-{way}") or {"rves": ()})["rves"]
        cell = {rve["seed"]: sign * rve[key]["yy"]["stress_Pa"] for rve in rves}
        ratios = [cell[seed] / body[seed] for seed in cell if seed in body]
        decimals = 1 if way == "tension" else 0
        values = (shown(list(cell.values()), decimals), shown(list(body.values()), decimals), shown(ratios, 2))
        print(f"| {len(cell)} | {kind.replace('_', ' ')} | {' | '.join(values)} |")
    print()


def print_softening():
    """The sample of bonds that soften beside grains of examples/toughness, a row an opening."""
    path = os.path.join(HERE, "../toughness/results/softening-strength.json")
    with open(path, encoding="utf-8") as file:
        of_grains = [test for test in json.load(file)["tests"] if test["kind"] == "direct_tension"]
    print("| opening [µm] | σ_t of grains [MPa] | σ_t of the sample [MPa] | over | lost in one step [%] | its cracks, of all |")
    print("|---|---|---|---|---|---|")
    base = {}
    for opening in OPENINGS_UM:
        tests = tests_of(f"softening-{opening}-um", "direct_tension")
        if not tests:
            continue
        grains = [
            test["peak_stress_Pa"] / 1e6 for test in of_grains if test["variant"].endswith(f"= {opening} um")
        ]
        falls = [test["largest_fall"] for test in tests]
        lost = [
            100.0 * (fall["stress_before_Pa"] - fall["stress_after_Pa"]) / test["peak_stress_Pa"]
            for fall, test in zip(falls, tests)
        ]
        cracks = [100.0 * fall["n_cracks"] / test["n_tension_cracks"] for fall, test in zip(falls, tests)]
        strengths = {test["seed"]: test["peak_stress_Pa"] / 1e6 for test in tests}
        base = base or strengths
        over = [strengths[seed] / base[seed] for seed in strengths]
        cells = [str(opening), shown(grains, 1), shown(list(strengths.values()), 1), shown(over, 2), shown(lost, 0)]
        print(f"| {' | '.join(cells)} | {shown(cracks, 0)} |")
    print()


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
    print_bodies()
    print_rates()
    bodies = {label: (name, variant) for label, name, variant in BODIES if label.endswith("gap 0.0457")}
    for (one, of_one), (other, of_other) in itertools.combinations(bodies.items(), 2):
        for kind in ("direct_tension", "uniaxial_compression"):
            values = [peaks(name, kind, variant) for name, variant in (of_other, of_one)]
            if all(len(v) > 1 for v in values):
                print(f"{other} from {one}, {kind}: {difference(*values)}")
    slow = list(crushed_at("0.25").values())
    of_sample = peaks("sample", "uniaxial_compression")
    if slow and of_sample:
        print(f"sample from cored at the sides only at 0.25/s, uniaxial_compression: {difference(of_sample, slow)}")
    walled = [peaks("laboratory", "uniaxial_compression", gap) for gap in ("0.0237", "0.0457")]
    if all(walled):
        print(f"walled at gap 0.0237 from 0.0457: {difference(*walled)}\n")
    print_before_the_peak()
    print_first_cracks()
    print_dealings()
    print_sizes()
    print_confined_cylinders()
    print_confined()
    print_kinematics()
    print_softening()
    print_meshes()
    print_same_cells()
    print_one_cell()
    print_angles()
    print_weak_cells()
    print_boundaries()
    draw()


if __name__ == "__main__":
    main()
