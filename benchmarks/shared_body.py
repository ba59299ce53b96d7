#!/usr/bin/env python3
"""One body on two ranks beside two threads, and a model of more ranks.

    python3 benchmarks/shared_body.py BUILD [BODY ...]     # writes results/shared-body-INSTRUCTIONS.json and the tables of README.md
    python3 benchmarks/shared_body.py                      # prints them

BUILD: a build folder with FELDSPAR_BENCHMARKS=ON, of a commit; two processors that do nothing else, some minutes. Each is
the least of its blocks of ten steps, in five runs in turn.

The model takes what was measured: time a joint and step of one thread, joints computed twice and copied grains a cut, both
by the number of grains on a side of the cut. A rank of n grains has six cuts of n^(2/3) grains. Assumed: a message takes 2 µs and
10 GB/s; a gather goes in log2(ranks) rounds and brings the terms of both platens, 16 bytes a grain of an end, to all.
"""

import json
import math
import os
import subprocess
import sys

from on_ranks import ENVIRONMENT
from readme_table import study_of_parts

BODIES = {"plane": ("15", "200"), "space": ("4", "100")}  # packings along an axis, steps
WAYS = {"two threads": (1, 2), "two ranks": (2, 1), "one thread": (1, 1)}
MESSAGE, BYTES_PER_SECOND, BYTES_OF_SPHERE, BYTES_HELD = 2e-6, 10e9, 72, 270


def measured(build, body):
    program = os.path.join(build, "benchmarks", "shared_body")
    bricks, steps = BODIES[body]
    runs = {way: [] for way in WAYS}
    for _ in range(5):
        for way, (ranks, threads) in WAYS.items():
            command = ["mpirun", "-np", str(ranks), "--oversubscribe", "--bind-to", "none", program, body, bricks, steps,
                       str(threads)]
            out = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=ENVIRONMENT)
            runs[way].append(json.loads(out.stdout))
    works = {run["boundary_work_J"] for of_way in runs.values() for run in of_way}
    if len(works) != 1:
        sys.exit(f"{body}: the bits differ: {works}")
    return {way: min(of_way, key=lambda run: run["step_s"]) for way, of_way in runs.items()}


def model(space, grains, ranks):
    """Seconds of a step, and its shares of joints computed twice, exchange and gather."""
    one, two = space["one thread"], space["two ranks"]
    of_joint = one["step_s"] / one["joints"]
    side = one["grains"] ** (2 / 3)  # grains at the one cut between the two ranks
    twice_a_cut = (two["joints_computed"] - two["joints"]) / 2 / side
    copies_a_cut = two["bytes_exchanged"] / 2 / BYTES_OF_SPHERE / side
    here = grains / ranks
    cuts = 6 * here ** (2 / 3) if ranks > 1 else 0.0
    joints = of_joint * here * one["joints"] / one["grains"]
    twice = of_joint * cuts * twice_a_cut
    exchange = 6 * MESSAGE + cuts * copies_a_cut * BYTES_OF_SPHERE / BYTES_PER_SECOND if ranks > 1 else 0.0
    gather = math.log2(ranks) * MESSAGE + 2 * grains ** (2 / 3) * 16 / BYTES_PER_SECOND if ranks > 1 else 0.0
    total = joints + twice + exchange + gather
    return total, twice / total, exchange / total, gather / total


def table(result):
    lines = ["| body | grains | joints | one thread | two threads | two ranks | ranks over threads | computed twice | exchange "
             "| gather, with waiting |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for body in BODIES:
        of_body = result[body]
        threads, ranks = of_body["two threads"], of_body["two ranks"]
        lines.append(
            f"| {body} | {ranks['grains']:,} | {ranks['joints']:,} | {1e3 * of_body['one thread']['step_s']:.2f} ms | "
            f"{1e3 * threads['step_s']:.2f} ms | {1e3 * ranks['step_s']:.2f} ms | "
            f"{ranks['step_s'] / threads['step_s']:.2f} | {100 * (ranks['joints_computed'] / ranks['joints'] - 1):.2f} % | "
            f"{1e3 * ranks['exchange_s']:.2f} ms | {1e3 * ranks['gather_s']:.2f} ms |".replace(",", " "))
    lines += ["", "| spheres | ranks | step | computed twice | exchange | gather | grains held by a rank |", "|---|---|---|---|---|---|---|"]
    for grains, counts in ((1e6, (1, 16, 256)), (1e8, (64, 1024, 10000)), (1e9, (1024, 10000))):
        for ranks in counts:
            total, *shares = model(result["space"], grains, ranks)
            lines.append(f"| 10^{round(math.log10(grains))} | {ranks} | {1e3 * total:.3g} ms | "
                         + " | ".join(f"{100 * share:.0f} %" for share in shares) + f" | {BYTES_HELD * grains / 1e9:.3g} GB |")
    return "\n".join(lines) + "\n"


study_of_parts(__doc__, "shared-body", BODIES, measured, table)
