"""Rows of the tables on representative volumes and samples: from the cells of a row of the page to what they ought to be."""

import math
import re
import statistics

from tables.values import *

BY_MOTION, CYLINDER = "beishan-granite/ensemble-by-motion", "beishan-cylinder/beishan-cylinder"
LARGE = "+".join(f"beishan-cylinder/full-size-{tests}" for tests in ("tests", "triaxial-10", "triaxial-40"))

# Representative volumes


def peak_of(rve, which, axis="yy", key="stress_Pa", scale=1e6):
    """The highest stress, tension positive, or the lowest, compression positive; or the strain there."""
    return (1.0 if which == "highest" else -1.0) * rve[which + "_stress"][axis][key] / scale


def compressed(name, variant="", axis="yy"):
    return [peak_of(rve, "lowest", axis) for rve in of(name, variant=variant)]


def pulled(name, variant=""):
    return [peak_of(rve, "highest") for rve in of(name, variant=variant)]


def cracks_of(rve):
    return rve["at_end"]["n_tension_cracks"] + rve["at_end"]["n_shear_cracks"]


def dissipated(rve):
    return sum(rve["at_end"][f"{way}_energy_J"] for way in ("slip", "released", "settling"))


def rve_strengths(cells):
    """Strengths by the laboratory, event by event and by explicit dynamics; the second table, of single cells, has no
    laboratory."""
    group, name = GROUPS[cells[0]], "rve-beishan/"
    if group == PULLED:
        columns = pulled(name + "tension"), pulled(name + "explicit-tension", "= 100000")
    else:
        results = {PRESSED: "uniaxial", triaxial(20): "triaxial-20", triaxial(60): "triaxial-60"}[group]
        solvers = ("= event by event", "= explicit") if group == triaxial(20) else ("", "= explicit")
        columns = [compressed(name + results, solver) for solver in solvers]
        if group == PRESSED:
            columns[1] = compressed(name + "size-32.5-mm-compression")
    if len(cells) == 3:
        return [None, *(listed(column, 0) or None for column in columns)]
    decimals = 2 if group == PULLED else 0
    return [None, shown(values(of(BY_MOTION, group)), decimals),
            *(shown(column, decimals) if column else None for column in columns)]


def rve_kinematics(cells):
    def peaks(modulus, solver, kinematics):
        wanted = (f"pressure = {cells[0]} MPa,", f"joint/Modulus = {modulus} GPa,", f"Solver = {solver},",
                  f"Kinematics = {kinematics},")
        return {rve["seed"]: peak_of(rve, "lowest") for rve in of("rve-beishan/kinematics")
                if all(part in rve["variant"] for part in wanted)}

    small, finite = (peaks(80, "event by event", kinematics) for kinematics in ("small strains", "finite"))
    dynamic = peaks(80, "explicit", "small strains")
    stiff, stiff_dynamic = (peaks(1280, solver, "small strains") for solver in ("event by event", "explicit"))
    column = lambda peaks: shown(list(peaks.values()), 0)
    return [None, column(small), column(finite), column(dynamic), shown(over(small, dynamic), 3),
            shown(over(finite, dynamic), 3),
            column(stiff), column(stiff_dynamic), shown(over(stiff, stiff_dynamic), 3)]


def rve_free_sides(cells):
    name = cells[0]
    wanted = [f"angle = {30 if 'turned' in name else 0} deg", "= explicit" if "explicit" in name else "= event by event"]
    wanted.append("= finite" if "finite" in name else "= small strains")
    if steps := re.search(r"(\d+) steps", name):
        wanted.append(f"millistrain = {steps[1]}")
    rves = [rve for rve in of("rve-beishan/kinematics-free-sides") if all(part in rve["variant"] for part in wanted)]
    left = [-rve["at_end"]["stress_yy_Pa"] / 1e6 for rve in rves if "ended_early" not in rve]
    at = [peak_of(rve, "lowest", key="strain", scale=1e-3) for rve in rves]
    return [None, shown([peak_of(rve, "lowest") for rve in rves], 0), shown(at, 2),
            f"{len(rves) - len(left)} of {len(rves)}", shown(left, 0)]


def networks(cells):
    rows = [row for row in read("benchmarks/results/networks-in-space.json")["networks"]
            if row["installation_gap_ratio"] == float(cells[0])]
    return [None, number(mean(rows, "coordination_number", 1.0), 2),
            number(mean(rows, "youngs_modulus_over_joint_modulus", 1.0), 3)]


def rve_in_space(cells):
    kind, _, solver = cells[0].partition(", ")
    confined = "triaxial-" + "".join(re.findall(r"\d+", kind))
    name = {"tension": "tension", "uniaxial compression": "uniaxial"}.get(kind, confined)
    which, sign = ("highest", 1e3) if kind == "tension" else ("lowest", -1e3)
    rve = of(f"rve-beishan/{name}-3d", variant="" if kind == "tension" else f"Solver = {solver or 'event by event'}")[0]
    end = rve["at_end"]
    return [None, number(peak_of(rve, which, "zz"), 1), number(peak_of(rve, which, "zz", "strain", 1e-3), 2),
            number(sign * end["strain_zz"], 2),
            str(cracks_of(rve)), number(end["crack_area_share"], 2), f"{rve['energy_imbalance']:.1e}"]


def cell_and_box(cells):
    body, size = cells[0].split(", ")
    name = f"rve-beishan/free-sides-{2 if body == 'plane' else 3}d-{size.replace(' ', '-')}"
    return [None, number(mean(of(name + "-cell"), "n_grains", 1.0), 0),
            shown(compressed(name + "-cell", axis="yy" if body == "plane" else "zz"), 0),
            shown(values(of(name + "-box", PRESSED)), 0)]


def rve_rates(cells):
    rule = {"event by event": "near worst", "the same, the worst segment only": "only worst"}.get(cells[0])
    if rule:
        rves = of("rve-beishan/break-rules", variant=f"= {rule}")
    else:
        rves = of("rve-beishan/explicit-tension", variant="= " + cells[0].split(", ")[1].replace(" ", ""))
    return [None, shown([peak_of(rve, "highest") for rve in rves], 2), shown([cracks_of(rve) for rve in rves], 0),
            shown([dissipated(rve) for rve in rves], 3), number(mean(rves, "wall_time_s", 1.0), 1)]


def rve_sizes(cells):
    row = next(row for row in read("examples/rve-beishan/results/sizes.csv") if row[0] == cells[0])
    column = lambda k, decimals: f"{float(row[k]):.{decimals}f} ± {float(row[k + 1]):.{decimals}f}"
    return [None, row[1], column(2, 1), column(4, 1), column(8, 0), column(6, 1)]


# Samples of Beishan granite, and of its cylinder


def costs(test, n_points):
    work, changes = test["solver_work"], test["solver_work"]["iterations"] + test["solver_work"].get("cascades", 0)
    seconds = work["seconds_in_points"]
    update = f"{1e3 * seconds / (changes * n_points):.2g}"
    return [str(test["steps"]), number(work["iterations"] / test["steps"], 1),
            number(work["cascades"] / test["steps"], 1), number(seconds, 0), update]


def samples(cells):
    peaks, grains = (values(of(name, GROUPS[cells[0]])) for name in ("multiscale-beishan/beishan", "beishan-granite/ensemble"))
    return [None, listed(peaks, 1), shown(peaks, 1), shown(grains, 1)]


def samples_turning(cells):
    return [None, *(", ".join(number(test[PEAK] / 1e6, 1) if PEAK in test else "no peak"
                              for test in of("multiscale-beishan/" + name, GROUPS[cells[0]]))
                    for name in ("beishan-by-coordination", "beishan-finite"))]


FIGURES_OF_MESHES = ((PEAK, 1e6, 2), ("work_after_peak_J_per_m2", 1.0, 1), ("loss_after_peak_J_per_m2", 1.0, 1))


def meshes(geometry):
    def row(cells):
        runs = [run for run in read("multiscale-beishan/mesh-study")["runs"] if run["geometry"] == geometry]
        if re.match(r"\d", cells[0]):
            run = next(run for run in runs
                       if "{} x {}".format(*run["elements"]) == cells[0] and run["softening"] == cells[1])
            return [None, None, *(listed(values(run["tests"], key, scale), decimals) for key, scale,
                                  decimals in FIGURES_OF_MESHES)]
        finer, off = [run for run in runs[1:] if run["softening"] == cells[1]], []
        for key, _, decimals in FIGURES_OF_MESHES:
            of_seeds = (100 * max(abs(run["tests"][k][key] / test[key] - 1) for run in finer) for k,
                        test in enumerate(runs[0]["tests"]))
            off.append(listed(of_seeds, decimals - 1) + " %")
        return [None, None, *off]
    return row


def cylinder_pulled(cells):
    name = {"section": "multiscale-beishan-cylinder/tension", "whole": "multiscale-beishan-cylinder/cylinder",
            "specimen of grains of 50 mm": LARGE,
            "specimens of grains of 20 mm": CYLINDER}.get(cells[0].split(",")[0])
    if not name:
        return []
    tests = of(name, PULLED)
    return [None, shown(values(tests), 1 if len(tests) == 1 else 2), shown(values(tests, STRAIN, 1e-4), 2),
            shown(values(of(name, PULLED), E_0, 1e9), 1)]


def at_pressure(cells):
    return triaxial("".join(re.findall(r"at (\d+) MPa", cells[0])) or 0)


WHOLE = "multiscale-beishan-cylinder/compression-whole+multiscale-beishan-cylinder/compression-whole-confined"


def cylinder_pressed(cells):
    columns = [None]
    for name in ("compression", "compression-finite", WHOLE, "compression-edges", LARGE, CYLINDER):
        tests = of(name if "/" in name else "multiscale-beishan-cylinder/" + name, at_pressure(cells))
        columns.append(f"{shown(values(tests), 0)} at {shown(values(tests, STRAIN, 1e-3), 1)}" if tests else "–")
    return columns


COSTS_OF_CYLINDERS = {
    "section, `tension.prm`": "tension",
    "section, `compression.prm`": "compression",
    "whole, `cylinder.prm`": "cylinder",
    "first steps of `published-size.prm`": "published-size",
    "first steps of `published-size.prm`, uniaxial": "published-compression",
    "fine section, uniaxial": "compression-fine",
}


def cylinder_costs(cells):
    name = COSTS_OF_CYLINDERS.get(cells[0])
    if name:
        test = of("multiscale-beishan-cylinder/" + name)[0]
    else:  # with what it was pressed under
        name = COSTS_OF_CYLINDERS[cells[0].rpartition(", ")[0]]
        test = of(WHOLE if name == "cylinder" else "multiscale-beishan-cylinder/" + name, at_pressure(cells))[0]
    return [None, None, *costs(test, int(cells[1]))]


# Sample and grains

MG = "multiscale-and-grains/"
SLOW, SIDES = (MG + "rate", "= 0.25 1/s"), (MG + "cored", "= sides only")
SAMPLE = (MG + "sample", "")
BODIES = {"walled, gap 0.0237": (MG + "laboratory", "= 0.0237"), "walled, gap 0.0457": (MG + "laboratory", "= 0.0457"),
          "cored, gap 0.0457": (MG + "cored", "= free sides"), "cored at the sides only, gap 0.0457": SIDES,
          "sample, gap 0.0457": SAMPLE,
          "cored at the sides only, 1/s": SIDES, "cored at the sides only, 0.25/s": SLOW, "sample": SAMPLE}


def bodies(cells):
    (name, variant) = BODIES[cells[0]]
    crushed = [test for test in of(name, PRESSED, variant) if PEAK in test]
    middle = [number(mean(crushed, key, 1.0), n) for key,
              n in (("installation_gap_ratio", 4), ("coordination_number_core", 2), ("porosity", 3))]
    return [None, str(len(crushed)), *middle, shown(values(of(name, PULLED, variant)), 2), shown(values(crushed), 1),
            shown(values(crushed, E_0, 1e9), 1), shown(values(crushed, INITIATION), 1)]


def before_the_peak(cells):
    columns = ((INITIATION, 1e6, 0), ("crack_initiation_stress_lateral_Pa", 1e6, 0), (DAMAGE, 1e6, 0), (NU_0, 1.0, 3),
               (NU_50, 1.0, 2))
    name, variant = BODIES[cells[0].split(", from")[0]]
    tests, slow = of(name, PRESSED, variant), of(SLOW[0], PRESSED, SLOW[1])
    if "from" in cells[0]:
        return [None, "", *(difference(values(tests, key, scale), values(slow, key, scale)) for key, scale, _ in columns)]
    return [None, str(len(tests)), *(shown(values(tests, key, scale), decimals) for key, scale, decimals in columns)]


def first_cracks(cells):
    share = f"{int(cells[0].split()[0]) / 1e3:g}"
    grains, sample = ([test["stress_at_broken_share_Pa"][share] / 1e6 for test in of(MG + "first-cracks-" + body)]
                      for body in ("grains", "sample"))
    return [None, shown(grains, 1), shown(sample, 1), difference(sample, grains)]


def rates(cells):
    at, fast = (by_seed(of(MG + "rate", PRESSED, f"= {rate} 1/s")) for rate in (cells[0], "1"))
    return [None, shown(list(at.values()), 1), shown(over(at, fast), 3)]


def of_size(cells, ending=""):
    """The results of a specimen by its kind and width [mm]."""
    kind, width = cells[:2]
    if kind == "walled, plane":
        return MG + ("laboratory" if width == "50" else f"laboratory-{width}-mm"), "= 0.0457" if width == "50" else ""
    if kind == "walled cylinder" and (width == "50" or ending):
        return LARGE if width == "50" else CYLINDER, ""
    return MG + ("walled" if kind == "walled cylinder" else "cored") + f"-cylinder-{width}-mm{ending}", ""


def sizes(cells):
    name, variant = of_size(cells)
    crushed = of(name, PRESSED, variant)
    return [None, None, str(len(crushed)), shown(values(crushed, "coordination_number_core", 1.0), 2),
            shown(values(crushed, "porosity", 1.0), 3),
            shown(values(of(name, PULLED, variant)), 1), shown(values(crushed), 0), shown(values(crushed, E_0, 1e9), 1)]


def sizes_confined(cells):
    row = [None, None, None]
    for pressure in (10, 40):
        tests = of(of_size(cells, "-confined")[0], triaxial(pressure))
        row[2] = str(len(tests))
        row += [shown(values(tests), 0), shown(values(tests, STRAIN, 1e-3), 1)]
    return row


def highest(test):
    """Highest stress of a test; the stress at its end where a sample has no peak [MPa]."""
    return test.get(PEAK, test.get("stress_at_end_Pa")) / 1e6


def at(names, pressure):
    """Strengths by seed, compressed under a pressure [MPa]."""
    tests = of("+".join(MG + name for name in names), triaxial(pressure))
    return {test["seed"]: test for test in tests}


SMALL = ("sample", "sample-confined", "sample-5-mpa")
FINITE = ("sample-finite-uniaxial", "sample-finite-5-mpa", "sample-finite", "sample-finite-later-seeds")


def slow_grains(pressure):
    if int(pressure):
        return at(("confined-slow",), pressure)
    return {test["seed"]: test for test in of(SLOW[0], PRESSED, SLOW[1])}


def strengths_of(tests):
    return {seed: highest(test) for seed, test in tests.items()}


def confined(cells):
    fast, slow, sample = at(("confined",), cells[0]), slow_grains(cells[0]), at(SMALL, cells[0])
    first, second, third = (list(strengths_of(body).values()) for body in (fast, slow, sample))
    n_rising = sum(PEAK not in test for test in sample.values())
    without_peak = f", {n_rising} of {len(sample)} without a peak up to 1.2 %" if n_rising else ""
    initiation = ", ".join(shown(values(body.values(), INITIATION), 0) for body in (fast, sample))
    return [None, shown(first, 0), shown(second, 0), shown(over(strengths_of(slow), strengths_of(fast)), 3),
            shown(third, 0) + without_peak,
            f"{difference(third, first)}, {difference(third, second)}", initiation]


def turning(cells):
    finite, small, slow = map(strengths_of, (at(FINITE, cells[0]), at(SMALL, cells[0]), slow_grains(cells[0])))
    ratios = over(finite, small)
    return [None, str(len(finite)), shown(list(finite.values()), 0), f"{shown(ratios, 3)} ({len(ratios)})",
            difference(list(finite.values()), list(slow.values()))]


def body_under(label, pressure):
    return slow_grains(pressure) if label.startswith("grains") else at(SMALL if "small" in label else FINITE, pressure)


def without_pressure(cells):
    tests = body_under(cells[0], 0)
    return [None, shown(list(strengths_of(tests).values()), 0), shown(values(tests.values(), STRAIN, 1e-3), 2)]


def damage_under_pressure(cells):
    tests = body_under(cells[1], cells[0]).values()
    counted = (f"{shown(values(tests, key), 0)} ({len(values(tests, key))})" for key in (INITIATION, DAMAGE))
    return [None, None, *counted, shown(values(tests, NU_50, 1.0), 3)]


def seed_by_seed(cells):
    row = [None, None]
    for names in (SMALL, FINITE):
        test = at(names, cells[0]).get(int(cells[1]))
        row += [number(highest(test), 0), number(1e3 * test[STRAIN], 1)
                if PEAK in test else "no peak"] if test else ["–", "–"]
    return row


def sample_softening(cells):
    grains = values(of("toughness/softening-strength", PULLED, f"= {cells[0]} um"))
    tests, base = of(MG + f"softening-{cells[0]}-um"), by_seed(of(MG + "softening-0-um"))
    lost = [100 * (test["largest_fall"]["stress_before_Pa"] - test["largest_fall"]["stress_after_Pa"]) / test[PEAK]
            for test in tests]
    cracks = [100 * test["largest_fall"]["n_cracks"] / test["n_tension_cracks"] for test in tests]
    return [None, shown(grains, 1), shown(values(tests), 1), shown(over(by_seed(tests), base), 2), shown(lost, 0),
            shown(cracks, 0)]


def finer_meshes(cells):
    elements = tuple(map(int, cells[0].split(" × ")))
    name = "sample" if elements == (2, 4) else "sample-{}-by-{}".format(*elements)
    base, test = (of(MG + one, PRESSED)[0] for one in ("sample", name))
    return [None, str(4 * elements[0] * elements[1]), number(test[PEAK] / 1e6, 1), number(1e3 * test[STRAIN], 1),
            number(test[INITIATION] / 1e6, 0),
            number(test[E_0] / 1e9, 1), number(test[PEAK] / base[PEAK], 2)]


def same_cells(cells):
    name = {"grains side by side, 1/s": "grains", "periodic": "sample",
            "periodic, turned at random": "sample-turned"}.get(
        cells[0], "sample-" + cells[0].replace(" ", "-"))
    pulled_ones, crushed = (of(f"{MG}same-cells-{name}", kind) for kind in (PULLED, PRESSED))
    work = [test["solver_work"] for test in crushed if "solver_work" in test]
    times = (1e3 * one["seconds_in_points"] / ((one["iterations"] + one["cascades"]) * 32) for one in work)
    return [None, listed(values(pulled_ones), 1), listed(values(crushed), 0), listed(values(crushed, INITIATION), 0),
            listed(values(crushed, E_0, 1e9), 1),
            f"{100 * max(test['energy_imbalance_over_work'] for test in crushed):.1f} %", listed(times, 0) or "–"]


def one_cell(cells):
    which, name, decimals = ("highest", "tension", 1) if "tension" in cells[1] else ("lowest", "compression", 0)
    cell = {rve["seed"]: peak_of(rve, which) for rve in of(f"{MG}one-cell-{name}")}
    body = by_seed(of(MG + "one-box", GROUPS[cells[1]]))
    return [str(len(cell)), None, shown(list(cell.values()), decimals), shown(list(body.values()), decimals),
            shown(over(cell, body), 2)]


def at_angle(way, *angles):
    return [row for row in read(f"{MG}angles-{way}")["after_peak"] if int(row["variant"].split()[-2]) in angles]


def angles(cells):
    pulled_ones, pressed = (at_angle(way, int(cells[0])) for way in ("tension", "compression"))
    after = ("work_after_peak_J_per_m2", "stress_at_end_over_peak")
    return [None, shown(values(pulled_ones), 2), *(shown(values(pulled_ones, key, 1.0), 2) for key in after),
            shown(values(pressed), 0)]


def weak_cells(cells):
    rows = at_angle("compression", *map(int, re.findall(r"\d+", cells[0])))
    inclined = [row for row in rows if 10.0 <= row["band_to_axis_deg"] <= 35.0]
    weak = lambda some: sum(row[PEAK] < 200e6 for row in some)
    return [None, str(len(rows)), shown(values(rows), 0), str(weak(rows)), str(sum(row["ended_early"] for row in rows)),
            f"{len(inclined)}, of those below 200 MPa {weak(inclined)}"]


DEALINGS = {"4 packings, turned": "sample", "4 packings, as they lie": "sample-unturned",
            "one a point, turned": "sample-own",
            "one a point, as they lie": "sample-own-unturned", "4 packings, one an element, turned": "sample-elements",
            "4 packings, as they lie, edge cells at the sides": "sample-edges"}


def dealings(cells):
    pulled_ones, crushed = ([test for test in of(MG + DEALINGS[cells[0]], kind) if test["seed"] <= 5]
                            for kind in (PULLED, PRESSED))
    ratios = over(by_seed(crushed), by_seed(of(MG + "sample", PRESSED)))
    return [None, str(len(crushed)), shown(values(pulled_ones), 1), shown(values(crushed), 0),
            shown(values(crushed, STRAIN, 1e-3), 2),
            shown(values(crushed, INITIATION), 0), shown(ratios, 2)]


def boundaries(cells):
    cells_of = lambda way: [rve for rve in of(f"{MG}boundaries-{way}-{cells[0]}-mm")
                            if rve["boundary"].startswith(cells[1])]
    tension = cells_of("tension")
    row = [None, None, shown(values(tension, "youngs_modulus_Pa", 1e9), 1),
           shown([peak_of(rve, "highest") for rve in tension], 1)]
    if cells[0] == "36":  # only pulled
        return [*row, "–", "–"]
    pressed = cells_of("compression")
    return [*row, shown([peak_of(rve, "lowest") for rve in pressed], 0),
            f"{sum('ended_early' not in rve for rve in pressed)} of {len(pressed)}"]


# A plate with a hole: rings and sectors are those of examples/plate-with-hole/study.py

RINGS_MM = (50.0, 62.5, 75.0, 100.0, 125.0, 150.0, 200.0)
SECTORS_DEG = (0.0, 22.5, 45.0, 67.5, 90.0)


def cracks_of_plate(cells):
    """Length of the cracks, their mean distance from the middle of the hole and mean angle from across the load."""
    rings, sectors = (list(zip(edges, edges[1:])) for edges in (RINGS_MM, SECTORS_DEG))
    length = distance = angle = 0.0
    for (near, far), densities in zip(rings, read("plate-with-hole/" + cells[1])["crack_density"][f"{cells[0]} MPa"]):
        for (low, high), density in zip(sectors, densities):
            share = density * math.pi * (far**2 - near**2) / 1e6 / len(sectors)
            length += share
            distance += share * 0.5 * (near + far)
            angle += share * 0.5 * (low + high)
    return [None, None, number(length, 3), number(distance / length, 0), number(angle / length, 0)]


def rings_of_plate(body):
    def row(cells):
        ring = RINGS_MM.index(float(cells[0].split("–")[0]))
        return [None, *(number(density, 0)
                        for density in read("plate-with-hole/" + body)["crack_density"]["120 MPa"][ring])]
    return row


# The program under load (docs/reliability.md)


def study(name):
    return read(f"benchmarks/results/{name}.json")


def in_thousands(n):
    return f"{n:,}".replace(",", " ")


def fuzzing(cells):
    readers = study("fuzz")["readers"]
    of_all = {key: sum(reader[key] for reader in readers.values()) for key in ("inputs", "found")}
    found = of_all if cells[0] == "all" else readers[cells[0]]
    return [None, in_thousands(found["inputs"]), str(found["found"])]


def load(cells):
    result = study("load")["variants" if "variants" in cells[0] else cells[0].split()[-1]]
    is_long = "variants" in cells[0]
    name = re.sub(r"^[\d ]*\d", in_thousands(result["variants" if is_long else "grains"]), cells[0])
    return [name, in_thousands(result["steps"]) if is_long else str(result["steps"]), number(result["seconds"] / 60, 1),
            number(result["processor_seconds"] / 60, 1), number(result["peak_bytes"] / 1e9, 2)]


def soak(_):
    result = study("soak")
    return [number(result["seconds"] / 60, 0), in_thousands(result["steps"]), in_thousands(result["rows"]),
            str(result["checkpoints_seen"]),
            f"{result['least_bytes'] / 1e6:.1f} to {result['most_bytes'] / 1e6:.1f}",
            f"{100 * result['largest_deviation_from_mean']:.2f} %"]


TABLES = {
    "plate with a hole": cracks_of_plate,
    "rings of the sample": rings_of_plate("sample"),
    "rings of the grains": rings_of_plate("grains"),
    "fuzzing": fuzzing,
    "load": load,
    "soak": soak,
    "RVE strengths": rve_strengths,
    "RVE strengths, cell by cell": rve_strengths,
    "RVE kinematics": rve_kinematics,
    "RVE without pressure": rve_free_sides,
    "networks in space": networks,
    "RVE in space": rve_in_space,
    "RVE and box": cell_and_box,
    "RVE rates": rve_rates,
    "RVE sizes": rve_sizes,
    "samples": samples,
    "samples, contacts turn": samples_turning,
    "sample meshes": meshes("plane"),
    "sample demo cost": lambda cells: [None, *costs(of("multiscale-beishan/demo", GROUPS[cells[0]])[0], 32)],
    "sample cylinder pulled": cylinder_pulled,
    "sample cylinder pressed": cylinder_pressed,
    "sample cylinder meshes": meshes("axisymmetric"),
    "sample cylinder cost": cylinder_costs,
    "bodies": bodies,
    "before the peak": before_the_peak,
    "first cracks": first_cracks,
    "rates": rates,
    "sizes": sizes,
    "sizes under pressure": sizes_confined,
    "under pressure": confined,
    "contacts that turn": turning,
    "without pressure": without_pressure,
    "damage under pressure": damage_under_pressure,
    "seed by seed": seed_by_seed,
    "sample softening": sample_softening,
    "finer meshes": finer_meshes,
    "same cells": same_cells,
    "one cell": one_cell,
    "angles": angles,
    "weak cells": weak_cells,
    "dealings": dealings,
    "boundaries": boundaries,
}
