"""A plate with a hole, of a mesh by Gmsh, in CalculiX 2.20 with the volume of plate.prm at all points.

    python3 calculix_plate.py CCX

The intact plate is compared with one of the volume's homogenised stiffness, linear elastic in CalculiX, and with Kirsch's
closed form; the curves of both constants of docs/material.md with that of `feldspar multiscale`. Leaves the curves in
calculix_plate_1.csv and calculix_plate_0.csv, and calculix_plate.png: the curves, and the cracks at the end of the second one.
"""

import os
import re
import sys
import tempfile
from pathlib import Path

import matplotlib.collections
import matplotlib.pyplot
import numpy

import calculix_sample as calculix
import feldspar

here = Path(__file__).resolve().parent
rock = feldspar.Input(here / "plate.prm")
width = height = 0.5  # m
radius = 0.05  # m, of the hole
step = float(rock["Sample/Tension step"])
n_rows = 20  # to where the plate is apart
increments = 10  # of CalculiX in a row


def gmsh(file: Path) -> calculix.Mesh:
    """Reads the quadrilaterals of a mesh in millimetres, format 2.2."""
    text = file.read_text()

    def block(name: str) -> list[list[str]]:
        return [line.split() for line in text.split(f"${name}\n")[1].split(f"$End{name}")[0].splitlines()[1:]]

    nodes = {number: (float(x) / 1e3, float(y) / 1e3) for number, x, y, _ in block("Nodes")}
    place = {number: k for k, number in enumerate(nodes)}
    quadrilateral = "3"
    elements = [words[3 + int(words[2]) :] for words in block("Elements") if words[1] == quadrilateral]
    return list(nodes.values()), [[place[number] for number in corners] for corners in elements]


def elastic() -> str:
    """Returns the homogenised stiffness of the volume as CalculiX reads it: the lower triangle of xx, yy, zz, xy, xz, yz."""
    plane = feldspar.Rve(rock, seed=int(rock["Seeds/Seeds"])).stiffness
    c = numpy.diag([0.0, 0.0, 1.0, 0.0, 0.5, 0.5]) * plane[0, 0]  # nothing loads these
    c[numpy.ix_([0, 1, 3], [0, 1, 3])] = plane
    values = [f"{c[i, j]:.10e}" for i in range(6) for j in range(i + 1)]
    rows = ",\n".join(", ".join(values[k : k + 8]) for k in (0, 8, 16))
    return f"*MATERIAL, NAME=ROCK\n*ELASTIC, TYPE=ANISO\n{rows}\n*SOLID SECTION, ELSET=SAMPLE, MATERIAL=ROCK"


def table(text: str, name: str) -> numpy.ndarray:
    """Returns the last table of a name that a job printed; [points, values]."""
    rows = re.split(rf"^ {name} .*\n", text, flags=re.MULTILINE)[-1].strip().split("\n\n")[0]
    return numpy.array([[float(word) for word in row.split()[2:]] for row in rows.splitlines()])


def mean_stress(text: str) -> numpy.ndarray:
    """Returns share of the displacement and mean stress [Pa], row by row."""
    return numpy.array(calculix.platen_forces(text)) / [1.0, width * calculix.thickness]


def compare_intact(ccx: str, mesh: calculix.Mesh) -> None:
    """Compares the stresses of the intact plate in the first row."""
    wanted = "*EL PRINT, ELSET=SAMPLE\nS, COORD"
    materials = (calculix.user_material("FELDSPAR", 1, "PLATE"), elastic())
    texts = [calculix.run(ccx, calculix.job(mesh, one, 1, step * height, wanted))[0] for one in materials]
    volumes, homogenised = (table(text, "stresses") for text in texts)
    apart = abs(volumes - homogenised).max() / abs(homogenised).max()
    print(f"intact: stresses at {len(volumes)} points differ by {apart:.1e} from those of the homogenised stiffness")
    x, y = (table(texts[0], "global coordinates")[:, :2] - width / 2.0).T
    side = (numpy.hypot(x, y) < 1.2 * radius) & (abs(y) < 0.2 * radius)
    r2 = (radius / numpy.hypot(x, y)[side]) ** 2
    twice = 2.0 * numpy.arctan2(x, y)[side]  # from the direction of the load
    kirsch = 1.0 - r2 * (1.5 * numpy.cos(twice) + numpy.cos(2.0 * twice)) + 1.5 * r2**2 * numpy.cos(2.0 * twice)
    found = volumes[side, 1] / mean_stress(texts[0])[-1, 1]
    print(f"stress at {len(found)} points beside the hole over the mean: {found.mean():.3f}, by Kirsch {kirsch.mean():.3f}")


def draw(mesh: calculix.Mesh, curves: dict[str, numpy.ndarray], cracks: numpy.ndarray) -> None:
    figure, (left, right) = matplotlib.pyplot.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    for (name, curve), marks in zip(curves.items(), ("-", "x", ".")):
        left.plot(*(curve * [1e6, 1e-6]).T, marks, label=name)
    left.set(xlabel="axial strain [microstrain]", ylabel="axial stress [MPa]")
    left.legend()
    nodes, elements = mesh
    shapes = [[(1e3 * nodes[k][0], 1e3 * nodes[k][1]) for k in corners] for corners in elements]
    cells = matplotlib.collections.PolyCollection(shapes, array=cracks, cmap="Reds", edgecolors="0.7", linewidths=0.4)
    right.add_collection(cells)
    right.set(xlabel="x [mm]", ylabel="y [mm]", xlim=(0, 500), ylim=(0, 500), aspect="equal")
    figure.colorbar(cells, label="crack density [1/m]")
    figure.savefig("calculix_plate.png", dpi=120)


def main(ccx: str) -> None:
    mesh = gmsh(here.parent / "plate-with-hole" / "plate.msh")
    compare_intact(ccx, mesh)
    with tempfile.TemporaryDirectory() as folder:
        curve = feldspar.multiscale(here / "plate.prm", Path(folder) / "out").curves["direct_tension_seed_1"]
    own = curve[["axial_strain", "axial_stress_Pa"]].to_numpy()[: n_rows + 1]
    curves = {"feldspar multiscale": own}
    strain = n_rows * step
    wanted = f"*EL PRINT, ELSET=SAMPLE, FREQUENCY={increments}\nSDV"
    for constant in (1, 0):
        material = calculix.user_material("FELDSPAR", constant, "PLATE")
        text, _ = calculix.run(ccx, calculix.job(mesh, material, n_rows * increments, strain * height, wanted))
        rows = numpy.vstack([[0.0, 0.0], mean_stress(text) * [strain, 1.0]])
        curves[f"CalculiX, constant {constant}"] = rows
        header = "axial_strain [-],axial_stress [Pa]"
        numpy.savetxt(f"calculix_plate_{constant}.csv", rows, "%.9g", ",", header=header, comments="")
        first, peak = abs(rows[1, 1] / own[1, 1] - 1.0), abs(rows[:, 1].max() / own[:, 1].max() - 1.0)
        print(f"constant {constant}: {len(rows) - 1} of {n_rows} rows; stiffness {first:.1e}, highest stress {peak:.1e} apart")
    draw(mesh, curves, table(text, "internal state variables")[:, 4].reshape(-1, 8).mean(axis=1))


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
