#!/usr/bin/env python3
"""Kills a multiscale run by SIGKILL at ten random moments and takes it up on the same and on another number of ranks.

    python3 benchmarks/kill_study.py build/release/app/feldspar    # writes results/kill-study.json; needs python3-h5py

Expected each time, beside the run on one rank that nothing happened to: the same segments broken in the same steps and
order; curves and, at the end, displacements and stresses to 1e-8 of their largest value. Moments are drawn from a fixed
seed, as shares of the time that an uninterrupted run on as many ranks takes.
"""

import csv
import glob
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

from on_ranks import ENVIRONMENT, committed_version, launcher

HERE = os.path.dirname(os.path.abspath(__file__))
NAME = "uniaxial_compression_seed_1"
# Eight elements of 12 mm with RVEs of some 75 discs. Tolerances are far below what is compared.
INPUT = """subsection Specimen
  set Shape              = periodic
  set Width              = 14 mm
  set Height             = 14 mm
  set Packing relaxation = dynamics
end
subsection Sample
  set Width            = 24 mm
  set Height           = 48 mm
  set Elements across  = 2
  set Elements along   = 4
  set Realisations     = 2
  set Compression step = 1e-4
  set Newton tolerance = 1e-9
end
subsection Representative volume
  set Final tolerance = 1e-10
end
subsection Tests
  set List        = uniaxial_compression
  set Stop strain = 1.2e-3
end
"""


def start(feldspar, n_ranks, arguments, folder):
    return subprocess.Popen(
        launcher(n_ranks) + [feldspar, "multiscale", "--quiet", "--threads", "1"] + arguments,
        cwd=folder,
        env=ENVIRONMENT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def children(pid):
    listed = subprocess.run(["pgrep", "-P", str(pid)], capture_output=True, text=True, check=False)
    return [int(child) for child in listed.stdout.split()]


def finish(process):
    error = process.communicate()[1]
    if process.returncode != 0:
        raise RuntimeError(error)
    return error


def checkpoints(run):
    return sorted(glob.glob(os.path.join(run, "states", NAME, "step-*")))


def events(run):
    with open(os.path.join(run, "cracks.csv"), encoding="utf-8") as file:
        return [row[:5] for row in csv.reader(file)]  # test, kind, point, segment, step


def curve(run):
    with open(os.path.join(run, "curves", NAME + ".csv"), encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns = {name: numpy.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(rows[0]) if rows[1][k]}
    return columns


def state(run):
    """The last: displacements, stresses and tangents of cells in the order of their numbers, in full precision."""
    last = checkpoints(run)[-1]
    parts = {"cells": [], "displacement_m": [], "responses_Pa": []}
    for part in sorted(os.listdir(last)):
        with h5py.File(os.path.join(last, part), "r") as file:
            n = len(file["cells"])
            for name, values in parts.items():
                values.append(file[name][:].reshape(n, -1))
    whole = {name: numpy.concatenate(values) for name, values in parts.items()}
    order = numpy.argsort(whole.pop("cells").reshape(-1))
    stress = whole["responses_Pa"].reshape(len(order), -1, 3 + 9)[:, :, :3]  # then the tangent
    return {"displacement_m": whole["displacement_m"][order], "stress_Pa": stress[order]}


def largest_difference(one, other):
    """Returns the difference in the worst column, over the largest value of any column of that unit."""
    assert one.keys() == other.keys()
    scales = {}
    for name, values in one.items():
        unit = name.rsplit("_", 1)[-1] if name.endswith(("_Pa", "_J", "_m")) else name
        scales[unit] = max(scales.get(unit, 0.0), numpy.abs(values).max())
    worst = 0.0
    for name, values in one.items():
        unit = name.rsplit("_", 1)[-1] if name.endswith(("_Pa", "_J", "_m")) else name
        if values.shape != other[name].shape:
            return numpy.inf
        if scales[unit] > 0:
            worst = max(worst, numpy.abs(values - other[name]).max() / scales[unit])
    return float(worst)


def main():
    feldspar = os.path.abspath(sys.argv[1])
    version = committed_version(feldspar)
    folder = tempfile.mkdtemp(prefix="kill-study-")
    with open(os.path.join(folder, "press.prm"), "w", encoding="utf-8") as file:
        file.write(INPUT)

    def path(name):
        return os.path.join(folder, name)

    seconds = {}
    for n_ranks in range(1, 5):
        began = time.monotonic()
        finish(start(feldspar, n_ranks, ["press.prm", "--output", f"whole-{n_ranks}"], folder))
        seconds[n_ranks] = time.monotonic() - began
    whole = path("whole-1")
    whole_events, whole_curve, whole_state = events(whole), curve(whole), state(whole)

    def difference(name):
        run = path(name)
        return {
            "moves": json.load(open(os.path.join(run, "summary.json"), encoding="utf-8"))["tests"][0]["ranks"]["moves"],
            "same_events": events(run) == whole_events,
            "curve_difference": largest_difference(whole_curve, curve(run)),
            "field_difference": largest_difference(whole_state, state(run)),
        }

    result = {
        "feldspar_version": version,
        "n_events": len(whole_events) - 1,
        "n_steps": int(whole_curve["step"][-1]),
        "kills": [],
    }
    print(result, flush=True)
    draw = random.Random(1)
    for k in range(10):
        n_ranks = 1 + k % 4
        other = (1, 2, 3, 4)[(k % 4 + draw.randrange(1, 4)) % 4]
        name = f"killed-{k}"
        share = draw.uniform(0.1, 0.9)
        process = start(feldspar, n_ranks, ["press.prm", "--output", name], folder)
        time.sleep(share * seconds[n_ranks])
        for pid in [process.pid] + children(process.pid):
            os.kill(pid, signal.SIGKILL)
        process.communicate()
        with open(path(f"{name}/run.json"), encoding="utf-8") as file:
            if json.load(file)["complete"]:
                raise RuntimeError("killed after its end")
        states = [os.path.basename(state) for state in checkpoints(path(name))]
        kill = {"ranks": n_ranks, "share_of_time": round(share, 3), "checkpoints": states, "resumed": []}
        for n in (n_ranks, other):
            copy = f"{name}-on-{n}"
            shutil.copytree(path(name), path(copy))
            said = finish(start(feldspar, n, ["--resume", copy], folder))
            kill["resumed"].append({"ranks": n} | difference(copy) | ({"said": said} if said else {}))
        result["kills"].append(kill)
        print(kill, flush=True)
    with open(os.path.join(HERE, "results", "kill-study.json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    shutil.rmtree(folder)


main()
