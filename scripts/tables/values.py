"""Committed results, and how tables of pages show them."""

import csv
import functools
import json
import math
import os
import re
import statistics

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
DEGREE = math.pi / 180.0
PEAK, STRAIN = "peak_stress_Pa", "strain_at_peak"
E_0, NU_0, NU_50 = "youngs_modulus_initial_Pa", "poissons_ratio_initial", "poissons_ratio_secant"
INITIATION, DAMAGE = "crack_initiation_stress_Pa", "crack_damage_stress_Pa"
PULLED, PRESSED = "direct_tension", "uniaxial_compression"


def number(value, decimals):
    return f"{value:.{decimals}f}"


def listed(values, decimals):
    return ", ".join(number(value, decimals) for value in values)


def shown(values, decimals, deviation=statistics.stdev):
    if len(values) < 2:
        return number(values[0], decimals) if values else "–"
    return f"{number(statistics.mean(values), decimals)} ± {number(deviation(values), decimals)}"


def error(values):
    return statistics.stdev(values) / math.sqrt(len(values))


def student(degrees):
    """The 97.5 % quantile of Student's t by the expansion of Cornish and Fisher, exact to a thousandth from 4 degrees on."""
    z = 1.959964
    return z + (z**3 + z) / (4 * degrees) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * degrees**2)


def difference(one, other):
    """Difference of the means, over the other mean, with its 95 % interval by Welch's t."""
    of_one, of_other = error(one) ** 2, error(other) ** 2
    degrees = (of_one + of_other) ** 2 / (of_one**2 / (len(one) - 1) + of_other**2 / (len(other) - 1))
    scale = 100.0 / statistics.mean(other)
    interval = student(degrees) * math.sqrt(of_one + of_other)
    return f"{scale * (statistics.mean(one) - statistics.mean(other)):+.0f} ± {scale * interval:.0f} %"


def over(one, other):
    """Ratios, pair by pair, of what two dictionaries both have."""
    return [value / other[key] for key, value in one.items() if key in other]


@functools.lru_cache(None)
def read(name):
    """Results by EXAMPLE/NAME, or a file of examples/ or benchmarks/ by its path."""
    path = name if name.startswith(("examples/",
                                    "benchmarks/")) else "examples/{}/results/{}.json".format(*name.split("/"))
    with open(os.path.join(ROOT, path), encoding="utf-8", newline="") as file:
        return json.load(file) if path.endswith("json") else list(csv.reader(file))


def of(names, group="", variant="", n=None):
    """Tests or RVEs of results joined by "+": those of a group (a kind, with its pressure), and of a variant with these words
    in it, or of the n-th variant of the group, from 1."""
    all_of = [one for name in names.split("+") for one in read(name).get("tests") or read(name)["rves"]]
    found = [one for one in all_of if not group or f"{one['name']}_".startswith(group + "_")]
    if n is not None:
        wanted = list(dict.fromkeys(one["variant"] for one in found))[n - 1]
        return [one for one in found if one["variant"] == wanted]
    return [one for one in found if not variant or f"{variant} " in f"{one.get('variant', '')} "]


def values(tests, key=PEAK, scale=1e6):
    return [test[key] / scale for test in tests if key in test]


def by_seed(tests, key=PEAK, scale=1e6):
    return {test["seed"]: test[key] / scale for test in tests if key in test}


def mean(tests, key=PEAK, scale=1e6):
    return statistics.mean(values(tests, key, scale))


def triaxial(pressure):
    return PRESSED if int(pressure) == 0 else f"triaxial_compression_{pressure}_MPa"


QUANTITIES = {  # group, key, scale, decimals
    "tensile strength [MPa]": (PULLED, PEAK, 1e6, 2),
    "strain at the tensile peak [1e-4]": (PULLED, STRAIN, 1e-4, 2),
    "uniaxial compressive strength [MPa]": (PRESSED, PEAK, 1e6, 1),
    "Brazilian strength [MPa]": ("brazilian", PEAK, 1e6, 2),
    "Young's modulus, tangent": (PRESSED, "youngs_modulus_tangent_Pa", 1e9, 1),
    "Young's modulus, initial": (PRESSED, E_0, 1e9, 1),
    "Poisson's ratio, secant": (PRESSED, NU_50, 1.0, 3),
    "Poisson's ratio, initial": (PRESSED, NU_0, 1.0, 3),
    "crack initiation stress in compression [MPa]": (PRESSED, INITIATION, 1e6, 1),
    "crack damage stress in compression [MPa]": (PRESSED, DAMAGE, 1e6, 1),
    "installation gap over mean radius": (PULLED, "installation_gap_ratio", 1.0, 4),
    "coordination number far from the walls": (PULLED, "coordination_number_core", 1.0, 3),
    "porosity": (PULLED, "porosity", 1.0, 4),
}
GROUPS = {"direct tension": PULLED, "uniaxial compression": PRESSED, "triaxial compression at 20 MPa": triaxial(20),
          "triaxial compression at 60 MPa": triaxial(60)}


def quantity(label):
    if pressure := re.search(r"at (\d+) MPa", label):
        return triaxial(pressure[1]), PEAK, 1e6, 1
    return next((of_it for start, of_it in QUANTITIES.items() if label.startswith(start)), None)


def measured(body, label):
    group, key, scale, _ = quantity(label)
    return values(of(body, group), key, scale)


def means(*bodies):
    """A row a quantity, a column a body."""
    return lambda cells: [None, *(shown(measured(body, cells[0]), quantity(cells[0])[3]) for body in bodies)]


def interval(ten, decimals):
    """95 % of a standard deviation of ten; chi-squared of nine degrees of freedom."""
    low, high = (statistics.stdev(ten) * math.sqrt(9.0 / quantile) for quantile in (19.02277, 2.700390))
    return f"{number(low, decimals)} to {number(high, decimals)}"
