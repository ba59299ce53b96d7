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


def job(material: str, divisions: tuple[int, int], n_increments: int, strain: float) -> str:
    """Returns the input of CalculiX, which reads 20 characters of a number: a plate of C3D8 between rough platens, pulled to
    a strain."""
    across, along = divisions

    def node(i: int, j: int, k: int) -> int:
        return 1 + i + (across + 1) * (j + (along + 1) * k)

    nodes = [
        f"{node(i, j, k)}, {i * cascade.width / across:.11e}, {j * cascade.height / along:.11e}, {k * thickness:.11e}"
        for k in range(2) for j in range(along + 1) for i in range(across + 1)
    ]
    elements = []
    for j in range(along):
        for i in range(across):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            numbers = ", ".join(str(node(a, b, k)) for k in range(2) for a, b in corners)
            elements.append(f"{1 + i + across * j}, {numbers}")

    def platen(name: str, j: int) -> str:
        numbers = [f"{node(i, j, k)}" for i in range(across + 1) for k in range(2)]
        return f"*NSET, NSET={name}\n" + ",\n".join(numbers)

    return "\n".join([
        "*NODE, NSET=ALL", *nodes,
        "*ELEMENT, TYPE=C3D8, ELSET=SAMPLE", *elements,
        platen("BOTTOM", 0), platen("TOP", along),
        material,
        "*BOUNDARY", "ALL, 3, 3", "BOTTOM, 1, 2", "TOP, 1, 1",
        f"*STEP, INC={2 * n_increments}", "*STATIC, DIRECT", f"{1.0 / n_increments:.11e}, 1.",
        "*CONTROLS, PARAMETERS=FIELD", "1e-8, 1e-3",
        "*BOUNDARY", f"TOP, 2, 2, {strain * cascade.height:.11e}",
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF", "*END STEP", "",
    ])  # fmt: skip


def user_material(library: str, constant: int) -> str:
    """Returns the material of a library at all elements."""
    name = f"@ABAQUS_{library}@SAMPLE"
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
    """Runs a job. Returns what it printed of the platen, and its processor time [s]."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(Path(cascade.__file__).parent / "sample.prm", folder)
        (Path(folder) / "job.inp").write_text(text)
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([ccx, "-i", "job"], cwd=folder, capture_output=True, text=True)
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        forces = Path(folder) / "job.dat"
        if not forces.exists() or not forces.read_text().strip():
            sys.exit(f"CalculiX gave no forces:\n{done.stdout[-2000:]}{done.stderr}")
        seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
        return forces.read_text(), seconds


def curve(ccx: str, constant: int, increments: int) -> cascade.Curve:
    """Returns the rows of the curve, up to where CalculiX finds no equilibrium."""
    strain = cascade.n_steps * cascade.step
    text, _ = run(ccx, job(user_material("FELDSPAR", constant), (2, 4), cascade.n_steps * increments, strain))
    found = re.findall(r"time\s+(\S+)\s+\S+\s+(\S+)\s+\S+", text)
    rows = [(float(share) * strain, float(y) / (thickness * cascade.width), 0) for share, y in found]
    return rows[increments - 1 :: increments]


def cost(ccx: str) -> None:
    """Times 8192 intact points (32 x 32 elements) in ten increments, and the same job with a UMAT that costs nothing, nine
    times each in turn."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["cc", "-O2", "-shared", "-fPIC", "-x", "c", "-", "-o", f"{folder}/libELASTIC.so"]
        subprocess.run(command, input=elastic_umat, text=True, check=True)
        os.environ["LD_LIBRARY_PATH"] = f"{folder}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        jobs = [job(user_material(library, 0), (32, 32), 10, 1e-5) for library in ("ELASTIC", "FELDSPAR")]
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
    Path("calculix.csv").write_text("axial_strain [-],axial_stress [Pa]\n" + "".join(lines))
    cascade.compare("CalculiX", rows)
