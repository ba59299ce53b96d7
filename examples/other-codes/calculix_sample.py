"""The sample in CalculiX 2.20, built by scripts/build-calculix.sh: `python3 calculix_sample.py CCX [CONSTANT]`.

The program writes the job, runs it, reads the forces of the upper platen, and compares the curve with `feldspar multiscale`.
CONSTANT as in docs/material.md.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cascade

n_across, n_along, thickness = 2, 4, 0.012
depth = 2  # layers of nodes across the plane


def node(i: int, j: int, k: int) -> int:
    return 1 + i + (n_across + 1) * (j + (n_along + 1) * k)


def job(constant: int, n_increments: int, strain: float) -> str:
    """Returns the input of CalculiX: a plate of one layer of C3D8 that does not move across its plane."""
    nodes, elements = [], []
    for k in range(depth):
        for j in range(n_along + 1):
            for i in range(n_across + 1):
                x, y = i * cascade.width / n_across, j * cascade.height / n_along
                nodes.append(f"{node(i, j, k)}, {x!r}, {y!r}, {k * thickness!r}")
    for j in range(n_along):
        for i in range(n_across):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            of_element = [node(a, b, k) for k in range(depth) for a, b in corners]
            elements.append(f"{1 + i + n_across * j}, " + ", ".join(map(str, of_element)))
    end = {name: [node(i, j, k) for i in range(n_across + 1) for k in range(depth)] for name, j in (("BOTTOM", 0), ("TOP", n_along))}
    sets = "".join(f"*NSET, NSET={name}\n" + ",\n".join(map(str, members)) + "\n" for name, members in end.items())
    return (
        "*NODE, NSET=ALL\n" + "\n".join(nodes) + "\n*ELEMENT, TYPE=C3D8, ELSET=SAMPLE\n" + "\n".join(elements) + "\n" + sets
        + f"*MATERIAL, NAME=@ABAQUS_FELDSPAR@SAMPLE\n*USER MATERIAL, CONSTANTS=1\n{constant}\n*DEPVAR\n11\n"
        + "*SOLID SECTION, ELSET=SAMPLE, MATERIAL=@ABAQUS_FELDSPAR@SAMPLE\n"
        + "*BOUNDARY\nALL, 3, 3\nBOTTOM, 1, 2\nTOP, 1, 1\n"
        + f"*STEP, INC={10 * n_increments}\n*STATIC, DIRECT\n{1.0 / n_increments!r}, 1.\n"
        + f"*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-3\n"
        + f"*BOUNDARY\nTOP, 2, 2, {strain * cascade.height!r}\n"
        + "*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP\n"
    )


def curve(ccx: str, constant: int, increments_per_row: int) -> cascade.Curve:
    """Runs the job. Returns the rows of cascade.n_steps, or those before CalculiX gave up."""
    strain = cascade.n_steps * cascade.step
    n_increments = cascade.n_steps * increments_per_row
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(Path(cascade.__file__).parent / "sample.prm", folder)
        (Path(folder) / "job.inp").write_text(job(constant, n_increments, strain))
        environment = dict(os.environ, OMP_NUM_THREADS=os.environ.get("OMP_NUM_THREADS", "2"))
        done = subprocess.run([ccx, "-i", "job"], cwd=folder, env=environment, capture_output=True, text=True)
        forces = (Path(folder) / "job.dat").read_text() if (Path(folder) / "job.dat").exists() else ""
    found = re.findall(r"time\s+(\S+)\s+([-+\dEe.]+)\s+([-+\dEe.]+)\s+([-+\dEe.]+)", forces.replace("\n", " "))
    if not found:
        sys.exit(f"CalculiX gave no forces:\n{done.stdout[-2000:]}{done.stderr}")
    return [(float(time) * strain, float(y) / (thickness * cascade.width), 0) for time, _, y, _ in found]


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    which = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    rows = curve(program, which, int(sys.argv[3]) if len(sys.argv) > 3 else 10)
    cascade.compare("CalculiX", rows)
