"""Rows of the tables on specimens of grains: from the cells of a row of the page to what they ought to be."""

import math
import re
import statistics

from tables.values import *

# Beishan granite, and as a cylinder

GRANITE, BY_NUMBER, BY_MOTION = (f"beishan-granite/ensemble{of_it}" for of_it in ("", "-by-coordination", "-by-motion"))
CYLINDER = "beishan-cylinder/beishan-cylinder"
LARGE = "+".join(f"beishan-cylinder/full-size-{tests}" for tests in ("tests", "triaxial-10", "triaxial-40"))


def granite(cells):
    ten, decimals = measured(GRANITE, cells[0]), quantity(cells[0])[3]
    return [*means("beishan-granite/beishan", GRANITE)(cells), interval(ten, decimals)]


def granite_confined(cells):
    tests = of(GRANITE, triaxial(cells[0]))
    return [None, shown(values(of("beishan-granite/beishan", triaxial(cells[0]))), 1), shown(values(tests), 1),
            interval(values(tests), 1), None, number(mean(tests, "shear_share_at_peak", 1.0), 4),
            number(mean(tests, "residual_deviator_ratio", 1.0), 2)]


def granite_envelopes(cells):
    form, point = cells[0].split(", ")
    form = {"s and a free": "as_paper", "intact": "intact", "a free": "general"}[form]
    fit = read(GRANITE)["fits"][form][point.replace(" ", "_")]
    return [None, number(fit["sigma_ci_Pa"] / 1e6, 1), number(fit["m"], 2), number(fit["s"], 3), number(fit["a"], 3),
            number(fit["r_squared"], 4), number(fit["uniaxial_compressive_strength_Pa"] / 1e6, 1),
            number(-fit["tensile_cut_off_Pa"] / 1e6, 2)]


def granite_rate(cells):
    return [None, shown(values(of("beishan-granite/rate-study", PRESSED, f"= {cells[0]} 1/s")), 1)]


def granite_platens(cells):
    strengths = [shown(values(of("beishan-granite/platens", triaxial(p), f"= {cells[0]}")), 0)
                 for p in (0, 5, 10, 20, 40, 60)]
    fit = next(one["as_paper"]["with_tension_point"] for one in read("beishan-granite/platens")["fits_of_variants"]
               if one["variant_values"]["Tests/Platen friction"]["value"] == float(cells[0]))
    excess = fit["uniaxial_compressive_strength_Pa"] / fit["measured_uniaxial_compressive_strength_Pa"] - 1.0
    return [None, *strengths, number(fit["s"], 2), f"{100 * excess:+.0f} %"]


def granite_packings(cells):
    one, other = measured(BY_MOTION, cells[0]), measured(BY_NUMBER, cells[0])
    off = (statistics.mean(other) - statistics.mean(one)) / math.hypot(error(one), error(other))
    return [*means(BY_MOTION, BY_NUMBER)(cells), number(off, 1)]


FULL_SIZE = {"grains": ("n_grains", 1.0, 0), "joints": ("n_joints", 1.0, 0), "porosity": ("porosity", 1.0, 3),
             "coordination number, more than three diameters from the walls": ("coordination_number_core", 1.0, 2),
             "radii scaled by": ("radius_multiplier", 1.0, 4), "processor time [s]": ("processor_time_s", 1.0, 0),
             "by the clock, two threads [s]": ("clock_time_s", 1.0, 0), "memory [MB]": ("peak_memory_kB", 1000.0, 0)}


def full_size(cells):
    key, scale, decimals = FULL_SIZE[cells[0]]
    return [None, number(read("beishan-cylinder/full-size")[key] / scale, decimals)]


# Calibrations

CALIBRATED = {"modulus": ("modulus", 1e9, 1), "bond tensile strength": ("bond_tensile_strength", 1e6, 1),
              "bond cohesion": ("bond_cohesion", 1e6, 0), "stiffness ratio": ("stiffness_ratio", 1.0, 2),
              "bond friction angle": ("bond_friction_angle", DEGREE, 1), "friction": ("friction", 1.0, 2)}
TARGETS = {"tensile": "tensile_strength", "Brazilian": "brazilian_strength", "Young's": "youngs_modulus",
           "Poisson's": "poissons_ratio", "uniaxial": "uniaxial_compressive_strength", "strength": "strength_at_{}_MPa",
           "at": "strength_at_{}_MPa"}
LAC_DU_BONNET = "examples/calibrate-lac-du-bonnet/reference.json"


def wanted(reference, label):
    """The mean of a rock's figure."""
    name = TARGETS[label.split()[0]].format(*re.findall(r"at (\d+) MPa", label))
    return next(of_it["mean"] for key, of_it in read(reference)["experiment"].items()
                if re.fullmatch(name + "(_[MG]Pa)?", key))


def targets(answer, decimals_of_modulus=1):
    def row(cells):
        target = read(answer)["targets"][TARGETS[cells[0].split()[0]]]
        _, _, scale, decimals = quantity(cells[0])
        decimals = decimals_of_modulus if "modulus" in cells[0] else decimals
        off, half = abs(target["deviation"]), student(target["n_packings"] - 1) * target["standard_error"] / target["target"]
        allowed = read(answer)["tolerance"]
        verdict = "reached" if off + half <= allowed else "missed" if off - half > allowed else "not decided"
        reached, error_of_it = (number(target[key] / scale, decimals) for key in ("reached", "standard_error"))
        return [None, number(target["target"] / scale, decimals), f"{reached} ± {error_of_it}",
                f"{100 * target['deviation']:+.1f} %", verdict]
    return row


def parameters(answer, more_decimals=0):
    def row(cells):
        key, scale, decimals = CALIBRATED[cells[0].split(" [")[0]]
        decimals += more_decimals if scale > 1.0 else 0
        best, low, high = (number(read(answer)["parameters"][key][name] / scale, decimals)
                           for name in ("best", "lower_90", "upper_90"))
        return [None, best, f"{low} to {high}", read(answer)["parameters"][key]["verdict"]]
    return row


def held_back(answer, tests):
    def row(cells):
        reached = measured(tests, cells[0])
        target = wanted(LAC_DU_BONNET, cells[0])
        band = read(answer)["predictions"][TARGETS["at"].format(cells[0].split()[1])]
        return [None, number(target, 0), shown(reached, 0, error),
                f"{100 * (statistics.mean(reached) / target - 1):+.0f} %",
                f"{band['lower_90'] / 1e6:.0f} to {band['upper_90'] / 1e6:.0f}"]
    return row


def tested_afterwards(cells):
    uniaxial = [wanted(LAC_DU_BONNET, "uniaxial"), mean(of("calibrate-lac-du-bonnet-cylinder/best", PRESSED))]
    target, reached = wanted(LAC_DU_BONNET, cells[0]), measured("calibrate-lac-du-bonnet-cylinder/triaxial", cells[0])
    found = statistics.mean(reached)
    return [None, number(target, 0), shown(reached, 0, error), f"{100 * (found / target - 1):+.0f} %",
            number(target / uniaxial[0], 3), number(found / uniaxial[1], 3)]


def at_laboratory_size(small, large):
    def row(cells):
        target, of_small, of_large = wanted(LAC_DU_BONNET, cells[0]), measured(small, cells[0]), measured(large, cells[0])
        decimals = quantity(cells[0])[3]
        ratios = zip((target, statistics.mean(of_small), of_large[0]),
                     (wanted(LAC_DU_BONNET, "uniaxial"), mean(of(small, PRESSED)), mean(of(large, PRESSED))))
        return [None, number(target, decimals), shown(of_small, decimals), shown(of_large, decimals),
                f"{100 * (of_large[0] / target - 1):+.1f} %", number(of_large[0] / statistics.mean(of_small), 3),
                listed((one / other for one, other in ratios), 3)]
    return row


def sizes_of_cylinder(cells):
    decimals = 4 if "Poisson" in cells[0] else quantity(cells[0])[3]
    large, small = (statistics.mean(measured(body, cells[0])) for body in (LARGE, CYLINDER))
    return [None, number(large, decimals), number(small, decimals), number(large / small, 3)]


def cylinder_at_50_mm(cells):
    name, decimals = "calibrate-beishan-cylinder/", quantity(cells[0])[3]
    target, large = wanted("examples/beishan-granite/reference.json",
                           cells[0]), measured(f"{name}full-size+{name}full-size-seed-2", cells[0])
    found = statistics.mean(large)
    return [None, number(target, decimals), listed(large, decimals), f"{100 * (found / target - 1):+.1f} %",
            number(found / statistics.mean(measured(name + "best", cells[0])), 3), sizes_of_cylinder(cells)[3]]


def platen_friction(cells):
    strengths = [values(of("calibrate-lac-du-bonnet/platen-friction", triaxial(p), f"= {cells[0]}")) for p in (0, 5, 10)]
    row = [None, shown(strengths[0], 0, error)]
    for confined in strengths[1:]:
        row += [shown(confined, 0, error), number(statistics.mean(confined) / statistics.mean(strengths[0]), 2)]
    return row


# Contact models, direct shear

MODELS = ("parallel-bond", "clumped", "grain-based", "flat-joint")


def contact_models(cells):
    if quantity(cells[0]):
        return means(*(f"contact-models/{model}" for model in MODELS))(cells)
    times = read("benchmarks/results/contact-models-benchmark-avx512.json")["benchmarks"]
    time = lambda model: times["step/" + {"clumped": "clumps"}.get(model, model.replace("-", "_"))]["processor_time_ns"]
    fits = lambda model: read("contact-models/" + model)["fits"]
    ratio = lambda model: mean(of("contact-models/" + model, PULLED)) / mean(of("contact-models/" + model, PRESSED))
    value, decimals = {
        "ratio": (ratio, 3),
        "slope": (lambda model: fits(model)["mohr_coulomb"]["slope"], 2),
        "its": (lambda model: fits(model)["mohr_coulomb"]["r_squared"], 4),
        "R²": (lambda model: fits(model)["intact"]["without_tension_point"]["r_squared"], 4),
        "time": (lambda model: time(model) / time("flat-joint"), 1),
    }[cells[0].split()[0]]
    return [None, *(number(value(model), decimals) for model in MODELS)]


def ways_to_break(cells):
    name = "contact-models/parallel-bond"
    if cells[0].endswith("only"):
        name += "-shear-only" if "shear" in cells[0] else "-tension-only"
    strengths = [mean(of(name, triaxial(pressure))) for pressure in (0, 5, 20, 60)]
    rises = [(one - other) / width for one, other, width in zip(strengths[1:], strengths, (5, 15, 40))]
    fits = read(name)["fits"]
    return [None, *(number(one, 1) for one in strengths), listed(rises, 1), number(fits["mohr_coulomb"]["r_squared"], 4),
            number(fits["intact"]["without_tension_point"]["r_squared"], 4)]


def clump_size(cells):
    pulled, pressed = (values(of("contact-models/clump-size", kind, f"= {cells[0]}")) for kind in (PULLED, PRESSED))
    return [None, shown(pulled, 2), shown(pressed, 1), number(statistics.mean(pulled) / statistics.mean(pressed), 3)]


def direct_shear(cells):
    group, stress = f"direct_shear_{cells[0]}_MPa", int(cells[0])
    plane, dilating, bonded = (shown(values(of("direct-shear/smooth-plane", group, n=n)), 2 if n == 3 else 3)
                               for n in (1, 2, 3))
    return [None, number(0.6 * stress, 1), plane, dilating, number(2 + 0.6 * stress, 1), bonded,
            shown(values(of("direct-shear/intact", group)), 1)]


def shear_lines(cells):
    n = {"plane": 1, "dilating plane": 2, "bonded plane": 3}.get(cells[0])
    name = "direct-shear/" + ("smooth-plane" if n else "intact")
    tests = of(name, "direct_shear_5_MPa", n=n)
    fit = read(name)["fits"]["direct_shear"]
    fit = fit[tests[0]["variant"]] if n else fit
    return [None, number(fit["cohesion_Pa"] / 1e6, 3), number(fit["friction_angle_rad"] / DEGREE, 2),
            number(mean(tests, "dilation_angle_rad", DEGREE), 2)]


def emission_tests(body, pressure):
    return of("emission-beishan/" + {"discs": "granite", "spheres": "spheres"}[body],
              PRESSED if pressure == "0" else f"triaxial_compression_{pressure}_MPa")


def emission(cells, body="granite"):
    pressure = "Uniaxial compression" if cells[0] == "0" else f"Triaxial compression, {cells[0]} MPa"
    with open(os.path.join(ROOT, f"examples/emission-beishan/results/{body}-emission.csv"), encoding="utf-8") as file:
        row = next(row for row in csv.DictReader(file) if (row["test"], row["deviator"]) == (pressure, cells[1]))
    columns = ("events", "breaks an event", "b", "b-positive", "tensile [%]", "shear [%]")
    return [None, None, *(row[column] for column in columns)]


def emission_of_spheres(cells):
    return emission(cells, "spheres")


def emission_to_peak(cells):
    tests = emission_tests(*cells[:2])
    return [None, None, shown(values(tests, "n_events_at_peak", 1), 0), shown(values(tests, "b_value", 1), 2),
            shown(values(tests, "b_positive", 1), 2), shown(values(tests, "shear_share_at_peak", 0.01), 1)]


def emission_stresses(cells):
    tests = emission_tests(*cells[:2])
    names = (INITIATION, "crack_initiation_stress_lateral_Pa", "crack_initiation_stress_emission_Pa", DAMAGE,
             "crack_damage_stress_emission_Pa", "peak_stress_Pa")
    return [None, None, *(shown(values(tests, name), 0) for name in names)]


def emission_windows(cells):
    (test,) = (test for test in read("emission-beishan/windows")["tests"]
               if f"radius = {cells[0]}," in test["variant"] and test["variant"].endswith(f"= {cells[1]}"))
    return [None, None, number(test["n_events_at_peak"], 0), f"{test['b_value']:.2f} ± {test['b_value_error']:.2f}",
            number(test["b_positive"], 2)]


# A granite of minerals: study, number of the variant

MINERAL_ROCKS = {"one mineral": ("minerals", 1), "four minerals of their own stiffness": ("minerals", 2),
                 "biotite of 40 % of the strength too": ("minerals", 3), "boundaries of 70 % too": ("minerals", 4),
                 "boundaries of 40 % instead": ("minerals", 5), "the picture, boundaries of 70 %": ("texture", None),
                 "one mineral, strengths scaled": ("scaled", None)}


def granite_minerals(cells):
    study, n = MINERAL_ROCKS[cells[0]]
    pulled, pressed = (of(f"granite-minerals/{study}", kind, n=n) for kind in (PULLED, PRESSED))
    initiation, strength = values(pressed, INITIATION), values(pressed)
    return [None, shown(values(pulled), 2), shown(initiation, 0), shown(strength, 0),
            number(statistics.mean(initiation) / statistics.mean(strength), 2),
            shown(values(pressed, "boundary_crack_share_at_peak", 0.01), 0),
            shown(values(pressed, "shear_share_at_peak", 0.01), 1)]


def stiff_rock(cells):
    row = [None]
    for stress in (2, 5):
        tests = of("direct-shear/stiff-rock", f"direct_shear_{stress}_MPa", f"= {cells[0]}")
        row += [shown(values(tests, "normal_stress_at_peak_Pa"), 2), shown(values(tests), 3)]
    return [*row, number(mean(tests, "dilation_angle_rad", DEGREE), 2)]


# Flawed granite

RADIUS = 0.62e-3 * (1 + 1.66) / 2  # mean of the grains [m]


def strengths(tests):
    return [shown(values(tests), 1), shown(values(tests, INITIATION), 1)]


def first_five(kind):
    return [test for test in of(BY_MOTION, kind) if test["seed"] <= 5]


def one_flaw(cells):
    intact = first_five(PRESSED)
    if not cells[0].startswith(tuple("0123456789")):
        return [None, *strengths(intact)]
    angle = int(cells[0].split("°")[0])
    if "along" in cells[0]:
        return [None, *strengths(of("flawed-granite/flaw", PRESSED, n=8))]
    net = 1.0 - (16.0 * math.cos(angle * DEGREE) + 2.0 * math.sin(angle * DEGREE)) / 50.0
    slot, closed = (of("flawed-granite/" + name, PRESSED, n=angle // 15 + 1) for name in ("flaw", "closed-flaw"))
    return [None, *strengths(slot), number(net * mean(intact), 1), *strengths(closed)]


def two_flaws(cells):
    n = ("intact", "45°", "75°", "105°", "135°").index(cells[0])
    tests = of("flawed-granite/two-flaws", PRESSED, n=n + 1)
    if n == 0:
        return [None, *strengths(tests)]
    rows = [row for row in read("flawed-granite/two-flaws")["joining"] if row["test"] in {test["name"] for test in tests}]
    first, half = ([row[key] for row in rows if key in row] for key in ("segments_1", "segments_2"))
    stresses = [listed((one["stress_Pa"] / 1e6 for one in joined), 0) or "none" for joined in (first, half)]
    counts = (listed((one[key] for one in first), 0) for key in ("n_faces", "n_shear_cracks"))
    return [None, *strengths(tests), *stresses, *counts]


def hole(cells):
    kind = PULLED if cells[0].startswith("tension") else PRESSED
    if cells[0].endswith("intact"):
        return [None, *strengths(first_five(kind))]
    tests = of("flawed-granite/hole", kind, cells[0].split(", ")[1])
    rows = [row for row in read("flawed-granite/hole")["first_cracks"] if row["test"] in {test["name"] for test in tests}]
    return [None, *strengths(tests), shown(values(rows, "first_stress_Pa"), 1),
            listed((row["n_of_first_ten"] for row in rows), 0)]


LENGTHS_MM = (0, 2, 4, 8.25, 12.5, 16.5, 24.5)  # half of that of the flaw


def wide(a):
    return math.sqrt(1.0 / math.cos(math.pi * a / 0.150))


def flaw_length(cells):
    peaks = values(of("flawed-granite/flaw-length", PULLED, n=LENGTHS_MM.index(float(cells[0])) + 1))
    a = float(cells[0]) / 1e3
    toughness = shown([peak * wide(a) * math.sqrt(math.pi * a) for peak in peaks], 2) if a else "–"
    return [None, number(a / RADIUS, 1), shown(peaks, 2), number(wide(a), 3), toughness]


def flaw_length_fits(cells):
    """1/σ² = π (a + c)/K², a straight line over a."""
    least = float(re.search(r"from ([\d.]+) mm", cells[0])[1])
    a = [length / 1e3 for length in LENGTHS_MM if length >= least]
    peaks = [mean(of("flawed-granite/flaw-length", PULLED, n=LENGTHS_MM.index(1e3 * one) + 1)) for one in a]
    line = statistics.linear_regression(a, [(wide(one) * peak) ** -2 for one, peak in zip(a, peaks)])
    return [None, number(math.sqrt(math.pi / line.slope), 2), number(1e3 * line.intercept / line.slope, 1)]


# Toughness

TOUGHNESS, ENERGY = ("fracture_toughness_Pa_sqrt_m", 1e6, 2), ("fracture_energy_J_per_m2", 1.0, 1)
BENT, HALF, PLATE = "three_point_bending", "semicircular_bending", "centre_cracked_plate"


def notched(name, variant, kinds, *quantities):
    return [shown(values(of("toughness/" + name, kind, variant), key, scale), decimals)
            for key, scale, decimals in quantities for kind in kinds]


def intensity(kind, a):
    """K over the measured stress and the root of the depth, or of half the width; docs/theory.md §4.8."""
    if kind == BENT:
        shape = (1.99 - a * (1.0 - a) * (2.15 - 3.93 * a + 2.7 * a * a)) / ((1.0 + 2.0 * a) * (1.0 - a) ** 1.5)
        return math.sqrt(a) * shape
    if kind == HALF:  # span 0.6
        return math.sqrt(math.pi * a) * (4.4126 - 10.3442 * a + 21.7116 * a * a)
    return math.sqrt(math.pi * a / math.cos(0.5 * math.pi * a)) * (1.0 - 0.025 * a * a + 0.06 * a**4)


def longer_notches(name, kind, variant):
    """Mean toughness, were the notches longer by the mean radius of the grains."""
    found = []
    for test in of("toughness/" + name, kind, variant):
        width, height, thickness = test["size_m"]
        depth = 0.5 * width if kind == PLATE else thickness or height
        longer = intensity(kind, 0.5 + width / (2.0 * test["resolution"]) / depth) / intensity(kind, 0.5)
        found.append(test[TOUGHNESS[0]] / 1e6 * longer)
    return number(statistics.mean(found), 2)


def over_root(cells):
    name = "large-plate" if "twice" in cells[0] else "toughness"
    kind = {"beam": BENT, "half disc": HALF}.get(cells[0], PLATE)
    radii = ["= 0.62 mm", "= 0.88 mm", "= 1.24 mm"]
    found = [of("toughness/" + name, kind, radius) for radius in radii]
    roots = [number(mean(tests, TOUGHNESS[0]) / math.sqrt(float(radius.split()[1])), 2) if tests else "–"
             for tests, radius in zip(found, radii)]
    return [None, *roots, *(longer_notches(name, kind, radius) if tests else "–" for tests, radius in zip(found, radii))]


def spheres_and_discs(cells):
    name, variant = ("in-space" if cells[0] == "spheres" else "in-plane"), f"= {cells[1]} mm"
    pulled = of("toughness/" + name, PULLED, variant)
    radius = 0.5 * 0.050 / mean(pulled, "resolution", 1.0)
    return [None, None, shown(values(pulled), 1), number(mean(pulled) * math.sqrt(math.pi * radius), 2),
            *notched(name, variant, (BENT, HALF, PLATE), TOUGHNESS)]


def longer_in_space(cells):
    name = "in-space" if cells[0] == "spheres" else "in-plane"
    return [None, None, *(longer_notches(name, kind, f"= {cells[1]} mm") for kind in (BENT, HALF, PLATE))]


BOND, BOND_STIFFNESS = 22e6, 80e9 / (2.0 * 0.82e-3)  # between grains of the mean radius


def softening(cells):
    pulled, pressed = (values(of("toughness/softening-strength", kind, f"= {cells[0]} um")) for kind in (PULLED, PRESSED))
    return [None, number(0.5 * BOND * (float(cells[0]) / 1e6 + BOND / BOND_STIFFNESS), 0), shown(pulled, 1),
            shown(pressed, 1),
            *notched("softening", f"= {cells[0]} um", (BENT, HALF), TOUGHNESS, ENERGY)]


def scaled_softening(cells):
    """Strengths and opening scaled by one factor to the tensile strength of the granite; a row is found by its opening."""
    for opening in (0, 1, 2, 5, 10):
        pulled, pressed = (mean(of("toughness/softening-strength", kind, f"= {opening} um"))
                           for kind in (PULLED, PRESSED))
        scale = 9.53 / pulled
        if abs(opening * scale - float(cells[0])) < 0.1:
            bent = [of("toughness/softening", kind, f"= {opening} um") for kind in (BENT, HALF)]
            return [number(opening * scale, 1), number(22 * scale, 1), number(400 * scale, 0), number(pressed * scale, 0),
                    *(number(scale * mean(tests, TOUGHNESS[0]), 2) for tests in bent),
                    *(number(scale**2 * mean(tests, ENERGY[0], 1.0), 0) for tests in bent)]
    return []


LAC, CYLINDER_OF_LAC = "calibrate-lac-du-bonnet/", "calibrate-lac-du-bonnet-cylinder/"
TABLES = {
    "granite": granite,
    "granite under pressure": granite_confined,
    "granite envelopes": granite_envelopes,
    "granite resolution": means(BY_NUMBER, "beishan-granite/radius-as-diameter"),
    "granite rate": granite_rate,
    "granite platens": granite_platens,
    "granite neighbours": means(GRANITE, BY_NUMBER),
    "granite packings": granite_packings,
    "cylinder": means(CYLINDER, BY_MOTION),
    "cylinder packing": full_size,
    "cylinder at 50 mm": means(LARGE, CYLINDER),
    "calibrated granite": targets("calibrate-beishan/calibration"),
    "calibrated granite parameters": parameters("calibrate-beishan/calibration"),
    "sizes of a cylinder": sizes_of_cylinder,
    "calibrated cylinder": targets("calibrate-beishan-cylinder/calibration"),
    "calibrated cylinder parameters": parameters("calibrate-beishan-cylinder/calibration"),
    "calibrated cylinder at 50 mm": cylinder_at_50_mm,
    "calibrated sandstone": targets("calibrate-sandstone/calibration", decimals_of_modulus=2),
    "calibrated sandstone parameters": parameters("calibrate-sandstone/calibration", more_decimals=1),
    "Lac du Bonnet": targets(LAC + "calibration"),
    "Lac du Bonnet parameters": parameters(LAC + "calibration"),
    "Lac du Bonnet held back": held_back(LAC + "calibration", LAC + "best"),
    "Lac du Bonnet held back, friction 0.1": held_back(LAC + "friction-0.1-calibration", LAC + "friction-0.1-best"),
    "Lac du Bonnet held back, smooth": held_back(LAC + "smooth-platens-calibration", LAC + "smooth-platens-best"),
    "Lac du Bonnet platens": platen_friction,
    "Lac du Bonnet cylinder": targets(CYLINDER_OF_LAC + "calibration"),
    "Lac du Bonnet cylinder parameters": parameters(CYLINDER_OF_LAC + "calibration"),
    "Lac du Bonnet cylinder held back": tested_afterwards,
    "Lac du Bonnet smooth": targets(CYLINDER_OF_LAC + "smooth-platens-calibration"),
    "Lac du Bonnet smooth parameters": parameters(CYLINDER_OF_LAC + "smooth-platens-calibration"),
    "Lac du Bonnet smooth held back": held_back(
        CYLINDER_OF_LAC + "smooth-platens-calibration", CYLINDER_OF_LAC + "smooth-platens-nearest"
    ),
    "Lac du Bonnet at 50 mm": at_laboratory_size(CYLINDER_OF_LAC + "best", CYLINDER_OF_LAC + "full-size"),
    "Lac du Bonnet smooth at 50 mm": at_laboratory_size(
        CYLINDER_OF_LAC + "smooth-platens-nearest", CYLINDER_OF_LAC + "smooth-platens-full-size"
    ),
    "Lac du Bonnet under pressure at 50 mm": at_laboratory_size(
        CYLINDER_OF_LAC + "smooth-platens-nearest",
        f"{CYLINDER_OF_LAC}smooth-platens-full-size+{CYLINDER_OF_LAC}smooth-platens-full-size-triaxial",
    ),
    "contact models": contact_models,
    "ways to break": ways_to_break,
    "clump size": clump_size,
    "emission": emission,
    "emission of spheres": emission_of_spheres,
    "emission stresses": emission_stresses,
    "emission up to the peak": emission_to_peak,
    "emission windows": emission_windows,
    "granite of minerals": granite_minerals,
    "direct shear": direct_shear,
    "direct shear lines": shear_lines,
    "direct shear in stiff rock": stiff_rock,
    "one flaw": one_flaw,
    "two flaws": two_flaws,
    "hole": hole,
    "length of a flaw": flaw_length,
    "length of a flaw, fitted": flaw_length_fits,
    "toughness": lambda cells: [None, *notched("toughness", f"= {cells[0]} mm", (BENT, HALF, PLATE), TOUGHNESS, ENERGY)],
    "toughness over radius": over_root,
    "toughness of large plates": lambda cells: [
        None,
        shown(values(of("toughness/large-plate", PULLED, f"= {cells[0]} mm")), 1),
        *notched("large-plate", f"= {cells[0]} mm", (PLATE,), TOUGHNESS, ENERGY),
    ],
    "toughness in space": spheres_and_discs,
    "toughness in space, longer notches": longer_in_space,
    "softening": softening,
    "softening scaled": scaled_softening,
}
