#!/usr/bin/env python3
"""Replays measured costs of representative volumes (RVEs) on 1 ... 10 000 cores: the limit of scaling, and the best
distribution of the cells.

    build/release/benchmarks/rve_costs > benchmarks/results/rve-costs.json
    python3 benchmarks/rank_queue.py    # writes results/rank-queue.json and .csv; some minutes
    python3 benchmarks/rank_queue.py 16    # prints one run of the smaller sample, on 16 cores, and writes nothing
    cd benchmarks && gnuplot rank_queue.gp

A square sample has n x n cells with four RVEs each, along the curve of p4est. A band of one tenth of the cells, like a
shear band, follows the whole measured path; the others follow 10 to 35 % of it. The packing of an RVE and its speed are
drawn from a fixed seed. In a row of the curve every RVE computes stress and tangent eight times and its breaks four times,
and all ranks wait for the last each time. Costs are those of the measured row, equal in every round.

Distributions. A rank has one core, or 16 that take its RVEs one by one:
  equal          as many cells to each rank, for good
  measured       cut anew by the time of each cell since the last cut, once the time lost equals the cost of a move
                 (ski-rental rule)
  last row       the same by the time of the last row only
  longest first  free cores of a rank take first what took longest in the row before
  queue          one for all cores: a free core asks the first rank for the next RVE, a message there and back
  bound          no distribution can be faster: all work over all cores, or the slowest RVE
Not replayed: the solution of the system of the finite elements, which is the same for all.
"""

import heapq
import json
import math
import os
import random
import sys

HERE = os.path.dirname(os.path.abspath(__file__))

N_ROWS = 30
ITERATIONS_A_ROW = 8
RELAXATIONS_A_ROW = 4
POINTS_A_CELL = 4
POLICIES = {  # how ranks get cells, cores of each, whether these take first what took longest in the row before
    "equal": ("equal", 1, False),
    "measured": ("measured", 1, False),
    "last row": ("last row", 1, False),
    "equal, 16 cores": ("equal", 16, False),
    "measured, 16 cores": ("measured", 16, False),
    "measured, 16 cores, longest first": ("measured", 16, True),
}
# Latency of a message between nodes, and bandwidth of a network between them; as their makers state it, not measured
# here.
LATENCY_S = 2e-6
BANDWIDTH_B_PER_S = 10e9
BYTES_OF_A_VOLUME = 7000  # damaged, some 240 discs; benchmarks/README.md has 12 kB for 408
LEAST_SHARE_OF_MEAN = 1e-3  # fem/mesh/partition.cc
WORTH_WHILE = 0.9  # fem/solid/solid.cc
FIRST_COST_OF_MOVING_S = 0.01


def cells_along_curve(n):
    """(x, y) of n x n cells in the order of Morton, in units of the edge."""

    def key(x, y):
        return sum(((x >> bit & 1) << 2 * bit) | ((y >> bit & 1) << 2 * bit + 1) for bit in range(16))

    cells = sorted(((x, y) for x in range(n) for y in range(n)), key=lambda cell: key(*cell))
    return [((x + 0.5) / n, (y + 0.5) / n) for x, y in cells]


def costs_of_rows(paths, n_cells_across, rng):
    """For each row, for each RVE along the curve: seconds of an iteration and of a relaxation."""
    steep = math.radians(60)
    rves = []
    for x, y in cells_along_curve(n_cells_across):
        in_band = abs((x - 0.5) * math.sin(steep) - (y - 0.5) * math.cos(steep)) < 0.05 * 0.87
        for _ in range(POINTS_A_CELL):
            speed = rng.uniform(0.8, 1.0) if in_band else rng.uniform(0.1, 0.35)
            rves.append((paths[rng.randrange(len(paths))], speed))
    rows = []
    for row in range(1, N_ROWS + 1):
        of_row = []
        for path, speed in rves:
            k = min(len(path) - 1, int(speed * row / N_ROWS * len(path)))
            of_row.append((path[k][1], path[k][2]))
        rows.append(of_row)
    return rows


def cut(weights, n_ranks):
    """Returns where each rank begins, and the end, as fem/mesh/partition.cc does."""
    n = len(weights)
    mean = sum(weights) / n
    limited = [w / mean + LEAST_SHARE_OF_MEAN for w in weights] if mean > 0 else [1.0] * n
    for _ in range(50):
        limit = sum(limited) / n_ranks
        if max(limited) <= limit * (1 + 1e-12):
            break
        limited = [min(w, limit) for w in limited]
    total = sum(limited)
    cuts, before, cell = [0], 0.0, 0
    for rank in range(1, n_ranks + 1):
        share = total * rank / n_ranks * (1 - 1e-12)
        while cell < n and before < share:
            before += limited[cell]
            cell += 1
        cuts.append(cell if rank < n_ranks else n)
    return cuts


def longest_share(seconds, cuts):
    return max(sum(seconds[begin:end]) for begin, end in zip(cuts, cuts[1:]))


def of_cells(seconds):
    return [sum(seconds[k : k + POINTS_A_CELL]) for k in range(0, len(seconds), POINTS_A_CELL)]


def time_on_cores(seconds, n_cores, expected):
    """Returns the time of RVEs that free cores take one by one; those with the longest expected time first, if any is
    expected."""
    if n_cores == 1:
        return sum(seconds)
    if len(seconds) <= n_cores:
        return max(seconds, default=0.0)
    if expected:
        seconds = [s for _, s in sorted(zip(expected, seconds), key=lambda pair: -pair[0])]
    free = list(seconds[:n_cores])
    heapq.heapify(free)
    for s in seconds[n_cores:]:
        heapq.heapreplace(free, free[0] + s)
    return max(free)


def collective(n_ranks):
    return 2 * LATENCY_S * (n_ranks - 1).bit_length()


def rounds(of_row):
    """(How often, seconds of each volume) of each kind of round in a row."""
    return [(ITERATIONS_A_ROW, [c[0] for c in of_row]), (RELAXATIONS_A_ROW, [c[1] for c in of_row])]


def in_pieces(rows, n_ranks, n_cores, policy, longest_first=False):
    """Seconds, and how often cells moved."""
    n = len(rows[0]) // POINTS_A_CELL
    cuts = [rank * n // n_ranks for rank in range(n_ranks + 1)]
    since_move, lost = [0.0] * n, 0.0
    time, moves, cost_of_moving = 0.0, 0, FIRST_COST_OF_MOVING_S
    before = [[], []]  # as in the row before
    for of_row in rows:
        for (times, seconds), expected in zip(rounds(of_row), before):
            longest = 0.0
            for begin, end in zip(cuts, cuts[1:]):
                piece = slice(POINTS_A_CELL * begin, POINTS_A_CELL * end)
                longest = max(longest, time_on_cores(seconds[piece], n_cores, expected[piece]))
            time += times * (longest + collective(n_ranks))
        if longest_first:
            before = [seconds for _, seconds in rounds(of_row)]
        if policy == "equal" or n_ranks == 1:
            continue
        of_this = of_cells([ITERATIONS_A_ROW * a + RELAXATIONS_A_ROW * b for a, b in of_row])
        since_move = [a + b for a, b in zip(since_move, of_this)]
        weights = since_move if policy == "measured" else of_this
        anew = cut(weights, n_ranks)
        now, then = longest_share(weights, cuts), longest_share(weights, anew)
        lost = now - then if policy == "measured" else lost + now - then
        if then < WORTH_WHILE * now and lost / n_cores > cost_of_moving:
            cuts = anew
            largest = max(end - begin for begin, end in zip(cuts, cuts[1:]))
            cost_of_moving = 20 * collective(n_ranks) + POINTS_A_CELL * largest * BYTES_OF_A_VOLUME / BANDWIDTH_B_PER_S
            time += cost_of_moving
            moves += 1
            since_move, lost = [0.0] * n, 0.0
    return time, moves


def queue(rows, n_cores):
    """The first rank hands out one volume at a time."""
    time = 0.0
    for of_row in rows:
        for times, seconds in rounds(of_row):
            if n_cores == 1:
                time += times * sum(seconds)
                continue
            free, clerk = [0.0] * n_cores, 0.0
            for s in seconds:
                clerk = max(clerk, free[0] + LATENCY_S) + LATENCY_S
                heapq.heapreplace(free, clerk + s)
            time += times * (max(free) + collective(n_cores))
    return time


def bound(rows, n_cores):
    return sum(
        times * max(sum(seconds) / n_cores, max(seconds)) for of_row in rows for times, seconds in rounds(of_row)
    )


def quantiles(values):
    ordered = sorted(values)
    return {f"{int(100 * q)} %": ordered[min(len(ordered) - 1, int(q * len(ordered)))] for q in (0.1, 0.5, 0.9, 0.99)} | {
        "n": len(ordered)
    }


def replay(rows, cells, n_cores):
    """One sample on one number of cores."""
    alone = bound(rows, 1)
    run = {"cells": cells, "volumes": len(rows[0]), "cores": n_cores, "speed_up": {}, "moves": {}}
    for name, (policy, n_of_rank, longest_first) in POLICIES.items():
        n_ranks = n_cores // n_of_rank
        if 1 <= n_ranks <= cells:
            time, run["moves"][name] = in_pieces(rows, n_ranks, n_of_rank, policy, longest_first)
            run["speed_up"][name] = round(alone / time, 2)
    run["speed_up"]["queue"] = round(alone / queue(rows, n_cores), 2)
    run["speed_up"]["bound"] = round(alone / bound(rows, n_cores), 2)
    return run


def main():
    with open(os.path.join(HERE, "results", "rve-costs.json"), encoding="utf-8") as file:
        measurement = json.load(file)
    measured = measurement["volumes"]
    compression = [v["rows"] for v in measured if v["test"] == "compression"]
    if sys.argv[1:]:
        print(json.dumps(replay(costs_of_rows(compression, 32, random.Random(1)), 32 * 32, int(sys.argv[1]))))
        return
    if "feldspar_version" not in measurement:
        sys.exit("results/rve-costs.json does not say by which build it was measured: measure it anew")
    everything = [row for v in measured for row in v["rows"]]
    result = {
        "feldspar_version": measurement["feldspar_version"],
        "costs_s": {
            "iteration, intact": quantiles([row[1] for row in everything if row[3] == 0]),
            "iteration, damaged": quantiles([row[1] for row in everything if row[3] > 0]),
            "relaxation, intact": quantiles([row[2] for row in everything if row[3] == 0]),
            "relaxation, damaged": quantiles([row[2] for row in everything if row[3] > 0]),
        },
        "runs": [],
    }
    for name, of in result["costs_s"].items():
        print(name, of)
    for across in (32, 128):
        rows = costs_of_rows(compression, across, random.Random(1))
        for n_cores in [2**k for k in range(14)] + [10000]:
            run = replay(rows, across * across, n_cores)
            result["runs"].append(run)
            print(run["cells"], n_cores, run["speed_up"], run["moves"], flush=True)
    with open(os.path.join(HERE, "results", "rank-queue.json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    with open(os.path.join(HERE, "results", "rank-queue.csv"), "w", encoding="utf-8") as file:
        columns = list(POLICIES) + ["queue", "bound"]
        file.write(",".join(["cells", "cores"] + [column.replace(",", "") for column in columns]) + "\n")
        for run in result["runs"]:
            row = [run["cells"], run["cores"]] + [run["speed_up"].get(column, "") for column in columns]
            file.write(",".join(str(entry) for entry in row) + "\n")


if __name__ == "__main__":
    main()
