"""The sample in CalculiX 2.20, built by scripts/build-calculix.sh.

    python3 calculix_sample.py CCX [CONSTANT [INCREMENTS]]    compares the curve with that of `feldspar multiscale`
    python3 calculix_sample.py CCX cost                       times 8192 intact points beside an elastic material

CONSTANT as in docs/material.md, INCREMENTS in a row of the curve. The loader must find libFELDSPAR.so. The curve is left in
calculix.csv: `feldspar report FOLDER --curve calculix.csv --curve-test direct_tension` shows it beside that of a run.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
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


def volume(constant: int) -> str:
    name = "@ABAQUS_FELDSPAR@SAMPLE"
    return (
        f"*MATERIAL, NAME={name}\n*USER MATERIAL, CONSTANTS=1\n{constant}\n*DEPVAR\n11\n"
        f"*SOLID SECTION, ELSET=SAMPLE, MATERIAL={name}"
    )


elastic = "*MATERIAL, NAME=ELASTIC\n*ELASTIC\n70e9, 0.1\n*SOLID SECTION, ELSET=SAMPLE, MATERIAL=ELASTIC"


def run(ccx: str, text: str) -> tuple[str, float]:
    """Runs a job. Returns what it printed of the platen, and its time [s]."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(Path(cascade.__file__).parent / "sample.prm", folder)
        (Path(folder) / "job.inp").write_text(text)
        began = time.monotonic()
        done = subprocess.run([ccx, "-i", "job"], cwd=folder, capture_output=True, text=True)
        seconds = time.monotonic() - began
        forces = Path(folder) / "job.dat"
        if not forces.exists() or not forces.read_text().strip():
            sys.exit(f"CalculiX gave no forces:\n{done.stdout[-2000:]}{done.stderr}")
        return forces.read_text(), seconds


def curve(ccx: str, constant: int, increments: int) -> cascade.Curve:
    """Returns the rows of the curve, up to where CalculiX finds no equilibrium."""
    strain = cascade.n_steps * cascade.step
    text, _ = run(ccx, job(volume(constant), (2, 4), cascade.n_steps * increments, strain))
    found = re.findall(r"time\s+(\S+)\s+\S+\s+(\S+)\s+\S+", text)
    rows = [(float(share) * strain, float(y) / (thickness * cascade.width), 0) for share, y in found]
    return rows[increments - 1 :: increments]


def cost(ccx: str) -> None:
    """Times 8192 points (32 x 32 elements) in ten increments, intact, three times each in turn."""
    jobs = {name: job(material, (32, 32), 10, 1e-5) for name, material in (("volumes", volume(0)), ("elastic", elastic))}
    seconds = {name: min(run(ccx, text)[1] for _ in range(3)) for name, text in jobs.items()}
    more = seconds["volumes"] - seconds["elastic"]
    print(f"8192 points, 10 increments: elastic {seconds['elastic']:.2f} s, volumes {seconds['volumes']:.2f} s (+{more:.2f} s)")


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    if sys.argv[2:] == ["cost"]:
        cost(program)
        sys.exit()
    rows = curve(program, *[int(word) for word in (sys.argv[2:] + ["1", "10"][len(sys.argv) - 2 :])])
    lines = [f"{strain!r},{stress!r}\n" for strain, stress, _ in rows]
    Path("calculix.csv").write_text("axial_strain [-],axial_stress [Pa]\n" + "".join(lines))
    cascade.compare("CalculiX", rows)
