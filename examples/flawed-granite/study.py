#!/usr/bin/env python3
"""Runs two-flaws.prm and hole.prm, reads their lists of cracks and writes their results.

    python3 examples/flawed-granite/study.py FELDSPAR NAME ...

NAME is two-flaws, hole or all. results/NAME.json is the summary of the run with one more list: joining (of two flaws) or
first_cracks (of a hole). Of two flaws it also draws results/two-flaws.png (gnuplot), the first specimen of each bridge when
the flaws are joined; scripts/record-picture.py then records it, and scripts/write-tables.py writes the tables of the README.

Two flaws are joined as soon as a way leads from one to the other that crosses only cracked faces: with one segment broken, or
half of them, or all. The joints of a specimen in the plane are the edges of a planar graph, with the grains as its corners;
its cells are the pores between grains, and a flaw is one of them. The way goes from pore to pore, inside the specimen.
"""

import collections
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = os.path.join(HERE, "results")
PICTURE = os.path.join(RESULTS, "two-flaws.png")
SEGMENTS = 4  # of a face, as in the inputs
RADIUS = 0.62e-3 * (1 + 1.66) / 2  # mean of the grains [m]
BRIDGES = (45, 75, 105, 135)  # angles [deg], in the order of the variants behind the intact one


def joints_of(grains, n_joints):
    """Pairs of grains, each (x, y, radius), in the order of the specimen's joints: those that lie closest together."""
    size = 2.5 * max(radius for _, _, radius in grains)
    cells = collections.defaultdict(list)
    for i, (x, y, _) in enumerate(grains):
        cells[int(x // size), int(y // size)].append(i)
    gaps = []
    for (column, row), inside in cells.items():
        around = [j for x in (-1, 0, 1) for y in (-1, 0, 1) for j in cells.get((column + x, row + y), ())]
        for i in inside:
            for j in around:
                if j > i:
                    length = math.hypot(grains[j][0] - grains[i][0], grains[j][1] - grains[i][1])
                    gaps.append((length - grains[i][2] - grains[j][2], i, j))
    return sorted((i, j) for _, i, j in sorted(gaps)[:n_joints])


def pores_of(grains, joints):
    """The corners of each cell of the graph of the joints, and the two cells beside each joint."""
    around = [[] for _ in grains]
    for i, j in joints:
        around[i].append(j)
        around[j].append(i)
    before = {}  # the neighbour next to j clockwise round i
    for i, neighbours in enumerate(around):
        neighbours.sort(key=lambda j: math.atan2(grains[j][1] - grains[i][1], grains[j][0] - grains[i][0]))
        for k, j in enumerate(neighbours):
            before[i, j] = neighbours[k - 1]
    cell, corners = {}, []
    for start in before:
        if start not in cell:
            corners.append([])
            i, j = start
            while (i, j) not in cell:
                cell[i, j] = len(corners) - 1
                corners[-1].append(i)
                i, j = j, before[j, i]
    return corners, [(cell[i, j], cell[j, i]) for i, j in joints]


def twice_the_area(points):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1]))


def surrounds(points, x, y):
    inside = False
    for a, b in zip(points, points[1:] + points[:1]):
        if (a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]):
            inside = not inside
    return inside


def way(grains, joints, cracked, points):
    """The joints that are crossed on the shortest way between the pores about two points, when the first one opens; or None.
    cracked: the step at which each joint counts as cracked."""
    corners, beside = pores_of(grains, joints)
    outlines = [[grains[i] for i in of_cell] for of_cell in corners]
    is_outside = [twice_the_area(outline) <= 0.0 for outline in outlines]  # cells are run round anticlockwise
    ends = []
    for x, y in points:
        found = [k for k, outline in enumerate(outlines) if not is_outside[k] and surrounds(outline, x, y)]
        if len(found) != 1:
            raise ValueError(f"{len(found)} pores about a flaw")
        ends += found
    if ends[0] == ends[1]:
        raise ValueError("the flaws are joined from the beginning")
    group = list(range(len(corners)))

    def root(k):
        while group[k] != k:
            group[k] = k = group[group[k]]
        return k

    doors = collections.defaultdict(list)
    for joint in sorted(cracked, key=cracked.get):
        one, other = beside[joint]
        if is_outside[one] or is_outside[other]:
            continue
        doors[one].append((joint, other))
        doors[other].append((joint, one))
        group[root(one)] = root(other)
        if root(ends[0]) == root(ends[1]):
            return shortest(doors, *ends)
    return None


def shortest(doors, start, goal):
    came = {start: None}
    queue = collections.deque([start])
    while goal not in came:
        pore = queue.popleft()
        for joint, other in doors[pore]:
            if other not in came:
                came[other] = (joint, pore)
                queue.append(other)
    path = []
    while came[goal]:
        joint, goal = came[goal]
        path.append(joint)
    return path[::-1]


class Body:
    """Grains and joints of a test, and which cracks broke each joint."""

    def __init__(self, test, cracks, grains):
        self.grains = [tuple(float(row[key]) for key in ("start_x_m", "start_y_m", "radius_m")) for row in grains]
        self.joints = joints_of(self.grains, test["n_joints"])
        self.cracks = collections.defaultdict(list)
        for crack in cracks:
            self.cracks[int(crack["joint"])].append(crack)
        for joint, of_joint in self.cracks.items():
            (x, y), radius = self.middle(joint), 0.62e-3 * 1.66
            # Half a face from the middle, and what the specimen moves until most cracks are there.
            if math.hypot(float(of_joint[0]["x_m"]) - x, float(of_joint[0]["y_m"]) - y) > 3.0 * radius:
                raise ValueError(f"{test['name']}: crack of joint {joint} is not at the joint")
        self.points = [(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])) for a, b, _ in slots_of(test)]

    def cracked(self, n):
        """The step at which n segments of a joint were broken, for each that came so far."""
        steps = {joint: sorted(int(crack["step"]) for crack in of_joint) for joint, of_joint in self.cracks.items()}
        return {joint: of_joint[n - 1] for joint, of_joint in steps.items() if len(of_joint) >= n}

    def way(self, n):
        """Between the slots, over faces with n segments broken, and the step that opened it; or None."""
        cracked = self.cracked(n)
        path = way(self.grains, self.joints, cracked, self.points)
        return path and (path, max(cracked[joint] for joint in path))

    def middle(self, joint):
        i, j = self.joints[joint]
        return [0.5 * (self.grains[i][axis] + self.grains[j][axis]) for axis in (0, 1)]

    def face(self, joint):
        """Both ends of the straight line that is a joint's face, before the test."""
        i, j = self.joints[joint]
        along = [self.grains[j][axis] - self.grains[i][axis] for axis in (0, 1)]
        half = min(self.grains[i][2], self.grains[j][2]) / math.hypot(*along)
        x, y = self.middle(joint)
        return [(x - side * half * along[1], y + side * half * along[0]) for side in (-1, 1)]


def stress_at(step, curve):
    return next(float(row["axial_stress_Pa"]) for row in curve if int(row["step"]) >= step)


def slots_of(test):
    """Begin, end and width of each."""
    number = r"([\d.]+)"
    form = rf"slot from {number}, {number} mm to {number}, {number} mm width {number} mm"
    lengths = ([float(word) / 1e3 for word in words] for words in re.findall(form, test["variant"]))
    return [((a, b), (c, d), width) for a, b, c, d, width in lengths]


def joining(test, body, curve):
    """Returns when and how the two slots of a test are joined."""
    row = {"test": test["name"]}
    for n in (1, SEGMENTS // 2, SEGMENTS):
        found = body.way(n)
        row[f"segments_{n}"] = None
        if found:
            path, step = found
            cracks = [crack for joint in path for crack in body.cracks[joint] if int(crack["step"]) <= step]
            strain = next(float(one["axial_strain"]) for one in curve if int(one["step"]) >= step)
            row[f"segments_{n}"] = {
                "stress_Pa": stress_at(step, curve),
                "strain_over_strain_at_peak": strain / test["strain_at_peak"],
                "n_faces": len(path),
                "n_tension_cracks": sum(crack["kind"] == "tension" for crack in cracks),
                "n_shear_cracks": sum(crack["kind"] == "shear" for crack in cracks),
            }
    return row


def first_cracks(test, cracks, curve):
    """Returns how many of the first ten cracks lie where Kirsch's hoop stress is the highest tension, within 30° and
    five mean diameters of the rim: the crowns in compression, the sides in tension. Returns also the stress at the
    first of them."""
    x, y, radius = (
        float(word) / 1e3
        for word in re.search(r"hole centre ([\d.]+), ([\d.]+) mm radius ([\d.]+) mm", test["variant"]).groups()
    )
    is_compression = test["kind"] == "uniaxial_compression"
    there = []
    for k, crack in enumerate(cracks):
        across, along = float(crack["x_m"]) - x, float(crack["y_m"]) - y
        off = math.atan2(abs(across), abs(along)) if is_compression else math.atan2(abs(along), abs(across))
        if math.degrees(off) <= 30.0 and math.hypot(across, along) <= radius + 10.0 * RADIUS:
            there.append(k)
    return {
        "test": test["name"],
        "n_of_first_ten": sum(k < 10 for k in there),
        "n_of_first_ten_in_tension": sum(crack["kind"] == "tension" for crack in cracks[:10]),
        "first_stress_Pa": stress_at(int(cracks[there[0]]["step"]), curve) if there else None,
    }


NAMES = ("two-flaws", "hole")


def run(feldspar, name):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        command = [feldspar, "lab", os.path.join(HERE, name + ".prm"), "--output", out, "--quiet"]
        if subprocess.run(command, check=False).returncode not in (0, 2):
            sys.exit(f"{name}: {' '.join(command)} failed")
        keep(name, out)


def draw(specimens):
    """Slots, cracked faces when the slots are joined (else at the end) and the way between them, a panel for each bridge."""
    script = [
        'set terminal pngcairo size 1320,620 font "sans,11"',
        f'set output "{PICTURE}"',
        f"set multiplot layout 1,{len(specimens)}",
        "set size ratio -1",
        "set xrange [0:60]",
        "set yrange [0:120]",
        "unset key",
        'set xlabel "x [mm]"',
    ]
    for (slots, body), bridge in zip(specimens, BRIDGES):
        path, until = body.way(1) or ([], math.inf)
        script.append(f'set title "bridge {bridge}°{"" if path else ", not joined"}"')
        plots = []
        for name, lines, style in (
            ("slots", [slot[:2] for slot in slots], 'lw 6 lc rgb "#a0a0a0"'),
            ("cracked", [body.face(joint) for joint, step in body.cracked(1).items() if step <= until], 'lc rgb "#606060"'),
            ("way", [body.face(joint) for joint in path], 'lw 3 lc rgb "#d95f02"'),
        ):
            if lines:
                script.append(f"${name} << EOD")
                for line in lines:
                    script += [f"{1e3 * x:.3f} {1e3 * y:.3f}" for x, y in line] + [""]
                script.append("EOD")
                plots.append(f"${name} with lines {style}")
        script.append("plot " + ", ".join(plots))
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def keep(name, out):
    """The summary of a run, with what its cracks say, as results/NAME.json."""
    with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    cracks = collections.defaultdict(list)
    for crack in rows_of(os.path.join(out, "cracks.csv")):
        cracks[crack["test"]].append(crack)
    curve = lambda test: rows_of(os.path.join(out, "curves", test["name"] + ".csv"))
    if name == "hole":
        summary["first_cracks"] = [first_cracks(test, cracks[test["name"]], curve(test)) for test in summary["tests"]]
    else:
        bodies = {}
        for test in summary["tests"]:
            if slots_of(test):
                grains = rows_of(os.path.join(out, "grains", test["name"] + ".csv"))
                bodies[test["name"]] = Body(test, cracks[test["name"]], grains)
        tests = [test for test in summary["tests"] if test["name"] in bodies]
        summary["joining"] = [joining(test, bodies[test["name"]], curve(test)) for test in tests]
        draw([(slots_of(test), bodies[test["name"]]) for test in tests if test["seed"] == 1])
    path = os.path.join(RESULTS, name + ".json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(summary, file)
    subprocess.run([os.path.join(HERE, "../../scripts/keep-results.py"), path], check=True)


def main():
    names = sys.argv[2:]
    if names == ["all"]:
        names = NAMES
    if names:
        subprocess.run([os.path.join(HERE, "../../scripts/provenance.sh"), sys.argv[1]], check=True)
    for name in names:
        run(os.path.realpath(sys.argv[1]), name)


if __name__ == "__main__":
    main()
