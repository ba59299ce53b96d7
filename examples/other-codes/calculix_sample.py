"""The sample in CalculiX 2.20, built by scripts/build-calculix.sh.

    python3 calculix_sample.py CCX [CONSTANT [INCREMENTS]]    compares the curve with that of `feldspar multiscale`
    python3 calculix_sample.py CCX cost                       times 8192 intact points beside an elastic UMAT

CONSTANT as in docs/material.md, INCREMENTS in a row of the curve. The loader must find libFELDSPAR.so. The curve is left in
calculix.csv: `feldspar report FOLDER --curve calculix.csv --curve-test direct_tension` shows it beside that of a run.
"""

import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import cascade

thickness = 0.012  # m; one layer of elements, which does not move across its plane


Mesh = tuple[list[tuple[float, float]], list[list[int]]]
"""Nodes [m], and the four corners of each element, counted from 0."""


def rectangle(across: int, along: int) -> Mesh:
    nodes = [
        (i * cascade.width / across, j * cascade.height / along) for j in range(along + 1) for i in range(across + 1)
    ]
    first = [i + (across + 1) * j for j in range(along) for i in range(across)]
    return nodes, [[k, k + 1, k + across + 2, k + across + 1] for k in first]


def job(mesh: Mesh, material: str, n_increments: int, displacement: float, output: str = "") -> str:
    """Returns the input of CalculiX, which reads 20 characters of a number: a plate of C3D8 between rough platens at its lowest
    and highest nodes, pulled to a displacement."""
    plane, elements = mesh
    n = len(plane)
    nodes = [
        f"{1 + k + n * layer}, {x:.11e}, {y:.11e}, {layer * thickness:.11e}"
        for layer in range(2) for k, (x, y) in enumerate(plane)
    ]
    layers = [[1 + k + n * layer for layer in range(2) for k in corners] for corners in elements]

    def platen(name: str, height: float) -> str:
        held = [f"{1 + k + n * layer}" for k, (_, y) in enumerate(plane) for layer in range(2) if abs(y - height) < 1e-9]
        return f"*NSET, NSET={name}\n" + ",\n".join(held)

    return "\n".join([
        "*NODE, NSET=ALL", *nodes,
        "*ELEMENT, TYPE=C3D8, ELSET=SAMPLE", *[f"{1 + k}, {', '.join(map(str, one))}" for k, one in enumerate(layers)],
        platen("BOTTOM", min(y for _, y in plane)), platen("TOP", max(y for _, y in plane)),
        material,
        "*BOUNDARY", "ALL, 3, 3", "BOTTOM, 1, 2", "TOP, 1, 1",
        f"*STEP, INC={2 * n_increments}", "*STATIC, DIRECT", f"{1.0 / n_increments:.11e}, 1.",
        "*CONTROLS, PARAMETERS=FIELD", "1e-8, 1e-3",
        "*BOUNDARY", f"TOP, 2, 2, {displacement:.11e}",
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF", output, "*END STEP", "",
    ])  # fmt: skip


def user_material(library: str, constant: int, rock: str = "SAMPLE") -> str:
    """Returns the material of a library at all elements."""
    name = f"@ABAQUS_{library}@{rock}"
    return (
        f"*MATERIAL, NAME={name}\n*USER MATERIAL, CONSTANTS=1\n{constant}\n*DEPVAR\n11\n"
        f"*SOLID SECTION, ELSET=SAMPLE, MATERIAL={name}"
    )


# The response of a UMAT that costs next to nothing, so that a job takes the time of CalculiX alone.
elastic_umat = """
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran)
{
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b)
      ddsdde[a + 6 * b] = a != b ? (a < 3 && b < 3 ? 8e9 : 0.0) : a < 3 ? 72e9 : 32e9;
  for (int a = 0; a < 6; ++a)
    {
      stress[a] = 0.0;
      for (int b = 0; b < 6; ++b)
        stress[a] += ddsdde[a + 6 * b] * (stran[b] + dstran[b]);
    }
}
"""


def run(ccx: str, text: str) -> tuple[str, float]:
    """Runs a job. Returns what it printed, and its processor time [s]."""
    here = Path(__file__).resolve().parent
    with tempfile.TemporaryDirectory() as parent:
        shutil.copytree(here.parent / "plate-with-hole", Path(parent) / "plate-with-hole")  # plate.prm has its mesh from there
        folder = Path(parent) / here.name
        folder.mkdir()
        for rock in here.glob("*.prm"):
            shutil.copy(rock, folder)
        (folder / "job.inp").write_text(text)
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([ccx, "-i", "job"], cwd=folder, capture_output=True, text=True)
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        forces = folder / "job.dat"
        if not forces.exists() or not forces.read_text().strip():
            sys.exit(f"CalculiX gave no forces:\n{done.stdout[-2000:]}{done.stderr}")
        seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
        return forces.read_text(), seconds


def platen_forces(text: str) -> list[tuple[float, float]]:
    """Returns the share of the displacement and the force of the upper platen [N], increment by increment."""
    found = re.findall(r"total force .* time\s+(\S+)\s+\S+\s+(\S+)\s+\S+", text)
    return [(float(share), float(force)) for share, force in found]


def curve(ccx: str, constant: int, increments: int) -> cascade.Curve:
    """Returns the rows of the curve, up to where CalculiX finds no equilibrium."""
    strain = cascade.n_steps * cascade.step
    material = user_material("FELDSPAR", constant)
    text, _ = run(ccx, job(rectangle(2, 4), material, cascade.n_steps * increments, strain * cascade.height))
    rows = [(share * strain, force / (thickness * cascade.width), 0) for share, force in platen_forces(text)]
    return rows[increments - 1 :: increments]


def cost(ccx: str) -> None:
    """Times 8192 intact points (32 x 32 elements) in ten increments, and the same job with a UMAT that costs nothing, nine
    times each in turn."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["cc", "-O2", "-shared", "-fPIC", "-x", "c", "-", "-o", f"{folder}/libELASTIC.so"]
        subprocess.run(command, input=elastic_umat, text=True, check=True)
        os.environ["LD_LIBRARY_PATH"] = f"{folder}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        mesh, displacement = rectangle(32, 32), 1e-5 * cascade.height
        jobs = [job(mesh, user_material(library, 0), 10, displacement) for library in ("ELASTIC", "FELDSPAR")]
        pairs = [[run(ccx, text)[1] for text in jobs] for _ in range(9)]
    without, with_volumes = (statistics.median(column) for column in zip(*pairs))
    print(f"processor time of 10 increments: {without:.3f} s with an elastic UMAT, {with_volumes:.3f} s with volumes, "
          f"ratio of the rest {with_volumes / without - 1.0:.3f}")


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    if sys.argv[2:] == ["cost"]:
        cost(program)
        sys.exit()
    rows = curve(program, *[int(word) for word in (sys.argv[2:] + ["1", "10"][len(sys.argv) - 2 :])])
    lines = [f"{strain!r},{stress!r}\n" for strain, stress, _ in rows]
    Path("calculix.csv").write_text("axial_strain [-],axial_stress [Pa]\n0,0\n" + "".join(lines))
    cascade.compare("CalculiX", rows)
