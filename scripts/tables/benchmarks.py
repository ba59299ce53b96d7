"""Rows of the tables in benchmarks/README.md and benchmarks/notes.md, which are found by how their headings begin."""

import re

from tables.values import number, read


def results(name):
    return read(f"benchmarks/results/{name}.json")


def machine(label):
    return {"AVX2, EPYC": "avx2", "AVX2, Xeon": "avx2-xeon", "AVX-512, Xeon": "avx512", "AVX2": "avx2",
            "AVX-512": "avx512"}[label]


def significant(value, digits):
    return f"{value:.{digits}g}"


def steps(cells):
    n, grains = cells[0].split()
    ratios = results("steps-" + machine(cells[1]))["new_over_old"]
    of_body = (f"engine_step/{n}/real_time", f"engine_step_broken/{n}/real_time")
    if grains == "spheres":
        of_body = f"space_step/{n}", f"space_step_broken/{n}"
    row = [None, None, *(number(1.0 / ratios[name], 1) if name in ratios else "–" for name in of_body), "–"]
    if grains == "discs":
        times = results("dynamics-benchmark-" + machine(cells[1]))["benchmarks"]
        plain, engine = (times[f"{name}_step/{n}/real_time"]["processor_time_ns"] for name in ("plain", "engine"))
        row[-1] = number(plain / engine, 1)
    return row


def before_and_now(test):
    return [number(test["old_s"], 1), number(test["new_s"], 1), number(test["old_s"] / test["new_s"], 2)]


def whole_tests(file):
    def row(cells):
        grains = "discs" if "discs" in cells[0] else "spheres"
        test = results(file)["tests"]["plane" if grains == "discs" else "space"]
        return [f"{test['n_grains']} {grains}, {test['n_joints']} joints", *before_and_now(test)]
    return row


def whole_samples(cells):
    name = cells[0].split(",")[0]
    test = results("whole-samples-" + machine(cells[1]))["tests"][name]
    return [re.sub(r"\d+( \w+)$", rf"{test['n_grains']}\1", cells[0]), None, *before_and_now(test)]


def factors(cells):
    dim, width = {"408 discs": (2, 325), "100 spheres": (3, 74), "602 spheres": (3, 133)}[cells[0]]
    times = results("factor-benchmark-avx512")["benchmarks"]
    return [None, *(significant(times[f"{name.format(what, dim)}>/{width}"]["processor_time_ns"] / unit, 3)
                    for what, unit in (("factorise", 1e6), ("solve", 1e3))
                    for name in ("block_{}<{}", "library_{}<{}, OfEigen", "library_{}<{}, OfCholmod"))]


DAMAGED = {"increment of 408 discs without a break": "damaged_increment<2>/150",
           "increment of 602 spheres, 30 breaks": "damaged_increment<3>/110",
           "increment of 602 spheres, 15 breaks": "damaged_increment<3>/120",
           "increment of 602 spheres without a break": "damaged_increment<3>/150",
           "tangent of 602 damaged spheres": "damaged_tangent<3>/150", "reference of 602 spheres": "reference<3>"}


def damaged(cells):
    return [None, *(number(1.0 / results(f"damaged-{processor}")["new_over_old"][DAMAGED[cells[0]]], 1)
                    for processor in ("avx512", "avx2"))]


POLICIES = ("equal", "measured", "equal, 16 cores", "measured, 16 cores", "measured, 16 cores, longest first", "queue",
            "bound")


def queue(cells):
    run = next(run for run in results("rank-queue")["runs"] if [str(run["volumes"]), str(run["cores"])] == cells[:2])
    return [None, None, *(number(run["speed_up"][policy], 1) if policy in run["speed_up"] else "–"
                          for policy in POLICIES)]


def ranks(cells):
    test = {"pulled": "direct_tension", "pressed": "uniaxial_compression"}[cells[0]]
    run = next(run for run in results("many-ranks")["runs"]
               if [run["test"], str(run["ranks"]), str(run["threads"])] == [test, *cells[1:3]])
    of_ranks = run["in_volumes"]
    longest = (number(of_ranks[key] / of_ranks["mean_s"], 2) for key in ("longest_unmoved_s", "longest_s"))
    speed_up = number(run["speed_up_by_clock"], 2) if "speed_up_by_clock" in run else "–"
    return [None, None, None, number(run["clock_s"], 1), number(run["processor_s"], 1), *longest, str(of_ranks["moves"]),
            speed_up]


def packings(cells):
    times = results("packing-benchmark-" + machine(cells[1]))["benchmarks"]
    descent, motion = (times[f"{way}<{2 if 'discs' in cells[0] else 3}>"]["processor_time_ns"] / 1e9
                       for way in ("by_descent", "by_motion"))
    return [None, None, significant(descent, 2), significant(motion, 2), number(motion / descent, 0)]


def large_cylinder(cells):
    large = results("large-cylinder")
    n = ("direct", "uniaxial", "triaxial").index(cells[0].split()[0]) if "packing" not in cells[0] else None
    return [None, number(1e3 * (large["packing_iteration_s"] if n is None else large["tests"][n]["step_s"]), 0)]


def nine_tests(cells):
    nine = results("nine-tests-" + machine(cells[0]))
    return [None, number(nine["clock_s"], 0), number(nine["user_time_s"], 0)]


def costs(cells):
    quantiles = results("rank-queue")["costs_s"][cells[0]]
    return [None, *(significant(1e3 * quantiles[share], 3) for share in ("10 %", "50 %", "90 %", "99 %"))]


TABLES = {
    "| lattice |": steps,
    "| uniaxial compression |": whole_tests("whole-tests-avx2"),
    "| RVE | factorise": factors,
    "| what is timed |": damaged,
    "| sample | with": whole_samples,
    "| | 10 % |": costs,
    "| RVEs | cores |": queue,
    "| | ranks | threads |": ranks,
    "| with | by the clock": nine_tests,
    "| body | with | by descent": packings,
    "| packed by damped motion": whole_tests("packings-avx512"),
    "| 200 000 spheres | one step": large_cylinder,
}
