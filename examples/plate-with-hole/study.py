#!/usr/bin/env python3
"""Runs the plate with a hole and counts its cracks by place; without names only the figure is made anew.

    python3 examples/plate-with-hole/study.py FELDSPAR [NAME ...]

NAME is sample, sample-edges (edge cells at free sides) or grains, or all. results/NAME.json is the summary of the run with
`crack_density`: for each stage of stages.csv the length of cracks over area [m/m²] by ring about the hole and by sector
from the direction across the load, all four quadrants together, and `map`, the same at the last stage by place: at the
points of the mesh, or in squares of 10 mm. Draws ../../docs/figures/plate-with-hole.png (gnuplot);
scripts/write-tables.py writes the tables of the README.
"""

import csv
import json
import math
import os
import subprocess
import sys
import tempfile

import mesh

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results")
FIGURE = os.path.join(HERE, "../../docs/figures/plate-with-hole.png")
RUNS = {
    "sample": ("multiscale", "sample", []),
    "sample-edges": ("multiscale", "sample", ["--set", "Representative volume/Boundary = edge"]),
    "grains": ("lab", "grains", []),
}
RINGS_MM = (50.0, 62.5, 75.0, 100.0, 125.0, 150.0, 200.0)
SECTORS_DEG = (0.0, 22.5, 45.0, 67.5, 90.0)
CELL_M2 = 0.025**2
SEED = 1


def ring_areas():
    return [math.pi * (b**2 - a**2) / 1e6 for a, b in zip(RINGS_MM, RINGS_MM[1:])]


def points_of_mesh():
    """The quadrature points of plate.msh with their areas: x, y [m], area [m²]. Two by two Gauss points an element."""
    gauss = 1.0 / math.sqrt(3.0)
    points = []
    for ring in range(mesh.OUTWARD):
        for ray in range(mesh.AROUND):
            corners = [mesh.node(ray + i, ring + j) for j, i in ((0, 0), (1, 0), (1, 1), (0, 1))]
            for a in (-gauss, gauss):
                for b in (-gauss, gauss):
                    shape = [0.25 * (1 + s * a) * (1 + t * b) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    of_a = [0.25 * s * (1 + t * b) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    of_b = [0.25 * t * (1 + s * a) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    total = lambda weights, k: sum(w * corner[k] for w, corner in zip(weights, corners))
                    area = abs(total(of_a, 0) * total(of_b, 1) - total(of_a, 1) * total(of_b, 0))
                    points.append((total(shape, 0) / 1e3, total(shape, 1) / 1e3, area / 1e6))
    return points


def bin_of(x, y):
    """Ring and sector of a place [m], or None."""
    across, along = abs(1e3 * x - 0.5 * mesh.SIDE), abs(1e3 * y - 0.5 * mesh.SIDE)
    distance, angle = math.hypot(across, along), math.degrees(math.atan2(along, across))
    ring = sum(distance >= edge for edge in RINGS_MM) - 1
    sector = min(sum(angle >= edge for edge in SECTORS_DEG) - 1, len(SECTORS_DEG) - 2)
    # A hole of grains has no sharp wall, and one of straight elements lies a little within the circle.
    ring = max(ring, 0)
    return (ring, sector) if ring < len(RINGS_MM) - 1 else None


def stages():
    with open(os.path.join(HERE, "stages.csv"), encoding="utf-8") as file:
        return [float(row["axial_stress_Pa"]) for row in csv.DictReader(file)]


def cracks_by_stage(out):
    """Returns for each stage its name and the cracks until its end: x, y, length [m]."""
    name = f"own_loading_seed_{SEED}"
    with open(os.path.join(out, "curves", name + ".csv"), encoding="utf-8") as file:
        curve = [(float(row["axial_strain"]), float(row["axial_stress_Pa"])) for row in csv.DictReader(file)]
    with open(os.path.join(out, "cracks.csv"), encoding="utf-8") as file:
        keys = ("axial_strain", "x_m", "y_m", "size_m")
        cracks = [[float(row[key]) for key in keys] for row in csv.DictReader(file)]
    for stage in stages():
        # The platens of the last stage stop where its stress is passed; that of grains swings by a thousandth.
        until = max((strain for strain, stress in curve if stress <= 1.001 * stage), default=0.0)
        yield f"{stage / 1e6:g} MPa", [crack[1:] for crack in cracks if crack[0] <= until]


class Patches:
    """The places over whose area cracks are counted: the points of a mesh, each with the area of its cell, or any."""

    def __init__(self, of_points):
        self.points = points_of_mesh() if of_points else []
        self.share = {(round(x, 6), round(y, 6)): area / CELL_M2 for x, y, area in self.points}
        n_sectors = len(SECTORS_DEG) - 1
        if of_points:
            self.area = [[0.0] * n_sectors for _ in RINGS_MM[1:]]
            for x, y, area in self.points:
                place = bin_of(x, y)
                if place:
                    self.area[place[0]][place[1]] += area
        else:
            self.area = [[area / n_sectors] * n_sectors for area in ring_areas()]

    def length_of(self, crack):
        """Returns the length that a crack stands for [m]."""
        x, y, length = crack
        return length * self.share[round(x, 6), round(y, 6)] if self.share else length

    def by_ring_and_sector(self, cracks):
        length = [[0.0] * len(row) for row in self.area]
        for crack in cracks:
            place = bin_of(*crack[:2])
            if place:
                length[place[0]][place[1]] += self.length_of(crack)
        return [[one / area for one, area in zip(*rows)] for rows in zip(length, self.area)]

    def map(self, cracks):
        """Returns the places of cracks and their length per area: x, y [mm], m/m²."""
        density = {}
        for x, y, length in cracks:
            if self.share:
                place, area = (round(1e3 * x, 2), round(1e3 * y, 2)), CELL_M2
            else:
                place, area = (10 * int(100 * x) + 5, 10 * int(100 * y) + 5), 1e-4
            density[place] = density.get(place, 0.0) + length / area
        return [[*place, round(value, 1)] for place, value in sorted(density.items())]


def run(feldspar, name):
    command, of_input, settings = RUNS[name]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        arguments = [feldspar, command, os.path.join(HERE, of_input + ".prm"), "--output", out, *settings]
        outcome = subprocess.run(arguments, check=False)
        if outcome.returncode != 0:
            sys.exit(f"{name}: exit code {outcome.returncode}")
        keep(name, out)


def keep(name, out):
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    patches = Patches(of_points=name != "grains")
    by_stage = dict(cracks_by_stage(out))
    summary["crack_density"] = {stage: patches.by_ring_and_sector(cracks) for stage, cracks in by_stage.items()}
    summary["map"] = patches.map(list(by_stage.values())[-1])
    os.makedirs(RESULTS, exist_ok=True)
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


def draw():
    """Draws where the cracks are at the last stage, over log of their length per area."""
    titles = {"sample": "finite elements with cells of grains", "grains": "93 000 grains"}
    names = [name for name in titles if results(name)]
    script = [
        f'set terminal pngcairo size {520 * len(names) + 80},520 font "sans,11"',
        f'set output "{FIGURE}"',
        f"set multiplot layout 1,{len(names)}",
        "set size ratio -1",
        "set xrange [0:500]",
        "set yrange [0:500]",
        'set xlabel "x [mm]"',
        'set ylabel "y [mm]"',
        'set cblabel "cracks [m/m²]"',
        "set logscale cb",
        "set cbrange [3:1000]",
        'set palette defined (0 "#fde0c0", 1 "#e06010", 2 "#601060")',
        "set object circle at 250,250 size 50 fc rgb 'black' fs empty border lw 1.5",
        "unset key",
    ]
    for name in names:
        rows = results(name)["map"]
        script += [f"$map_{len(script)} << EOD", *(" ".join(map(str, row)) for row in rows if row[2] >= 3.0), "EOD"]
        block = [line.split()[0] for line in script if line.startswith("$map_")][-1]
        script += [f'set title "{titles[name]}, 120 MPa along y"', f"plot {block} using 1:2:3 with points pt 7 ps 0.8 lc palette"]
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, cwd=HERE, check=True)


def main():
    feldspar = os.path.realpath(sys.argv[1])
    names = sys.argv[2:]
    if names == ["all"]:
        names = list(RUNS)
    if names:
        subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), feldspar], check=True)
    for name in names:
        run(feldspar, name)
    draw()


if __name__ == "__main__":
    main()
