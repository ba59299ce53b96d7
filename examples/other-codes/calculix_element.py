"""One element of C3D8 in CalculiX 2.20 along the paths of `feldspar rve`.

    python3 calculix_element.py CCX

A path has a hundred increments; `feldspar rve` ends an increment where a bond breaks, and CalculiX takes its rows as steps.
Bonds break at each strain that is tried (constant 1). CalculiX prints seven digits; a UMAT between it and Feldspar writes all.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

import feldspar

n = 100  # increments of a path
volumes: dict[str, dict[str, str]] = {
    "plane": {"Specimen/Shape": "periodic", "Specimen/Width": "12 mm", "Specimen/Height": "12 mm"},
    "space": {
        "Specimen/Dimension": "3", "Specimen/Shape": "periodic", "Specimen/Width": "7 mm", "Specimen/Height": "7 mm",
    },
}  # fmt: skip
common = {
    "Representative volume/Final tolerance": "1e-9",
    "Sample/Realisations": "1",
    "Sample/Orientation": "fixed",
}
axes = ("xx", "yy", "zz", "yz", "xz", "xy")  # of a strain, tensor shear
# Ends of the paths.
paths: dict[str, dict[str, tuple[float, ...]]] = {
    "plane": {
        "tension": (-3e-5, 3e-4, 0, 0, 0, 0),
        "compression": (1e-4, -1.2e-3, 0, 0, 0, 0),
        "shear": (0, 0, 0, 0, 0, 4e-4),
    },
    "space": {
        "tension": (-3e-5, -3e-5, 3e-4, 0, 0, 0),
        "compression": (1e-4, 1e-4, -1.2e-3, 0, 0, 0),
        "shear": (0, 0, 0, 4e-4, 0, 0),
    },
}  # fmt: skip

record_umat = r"""
#include <dlfcn.h>
#include <stdio.h>
typedef void umat(double *, double *, double *, double *, double *, double *, double *, double *, double *, double *,
                  const double *, const double *, const double *, const double *, const double *, const double *,
                  const double *, const double *, const char *, const int *, const int *, const int *, const int *,
                  const double *, const int *, const double *, const double *, double *, const double *, const double *,
                  const double *, const int *, const int *, const int *, const int *, const int *, const int *, int);
void umat_(double *stress, double *statev, double *ddsdde, double *a, double *b, double *c, double *d, double *e,
           double *f, double *g, const double *stran, const double *dstran, const double *h, const double *i,
           const double *j, const double *k, const double *l, const double *m, const char *cmname, const int *ndi,
           const int *nshr, const int *ntens, const int *nstatv, const double *props, const int *nprops,
           const double *o, const double *p, double *pnewdt, const double *q, const double *r, const double *s,
           const int *noel, const int *npt, const int *t, const int *u, const int *jstep, const int *kinc, int length)
{
  static umat *feldspar;
  if (!feldspar)
    feldspar = (umat *)dlsym(dlopen("libFELDSPAR.so", RTLD_NOW | RTLD_GLOBAL), "umat_");
  feldspar(stress, statev, ddsdde, a, b, c, d, e, f, g, stran, dstran, h, i, j, k, l, m, cmname, ndi, nshr, ntens,
           nstatv, props, nprops, o, p, pnewdt, q, r, s, noel, npt, t, u, jstep, kinc, length);
  FILE *file = fopen("record", "a");
  fprintf(file, "%d %d", jstep[0], *npt);
  for (int n = 0; n < 6; ++n)
    fprintf(file, " %.17g", stress[n]);
  fprintf(file, "\n");
  fclose(file);
}
"""


def job(strains: numpy.ndarray) -> str:
    """Returns the input of CalculiX: a cube, whose corners all move with the strain, a step for each."""
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    lines = [
        "*NODE, NSET=ALL", *[f"{1 + k}, {x}., {y}., {z}." for k, (x, y, z) in enumerate(corners)],
        "*ELEMENT, TYPE=C3D8, ELSET=SAMPLE", "1, 1, 2, 3, 4, 5, 6, 7, 8",
        "*MATERIAL, NAME=@ABAQUS_RECORD@ROCK", "*USER MATERIAL, CONSTANTS=1", "1", "*DEPVAR", "11",
        "*SOLID SECTION, ELSET=SAMPLE, MATERIAL=@ABAQUS_RECORD@ROCK",
    ]  # fmt: skip
    for xx, yy, zz, yz, xz, xy in strains:
        moves = numpy.array(corners) @ [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        lines += ["*STEP", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY"]
        lines += [f"{1 + k}, {1 + c}, {1 + c}, {moves[k, c]:.12e}" for k in range(8) for c in range(3)]
        lines += ["*NODE PRINT, NSET=ALL, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def in_calculix(ccx: str, strains: numpy.ndarray, folder: Path) -> numpy.ndarray:
    """Returns the stresses at the first point at the end of each step, in the order of `axes`; [n, 6]."""
    command = ["cc", "-O2", "-shared", "-fPIC", "-x", "c", "-", "-o", f"{folder}/libRECORD.so", "-ldl"]
    subprocess.run(command, input=record_umat, text=True, check=True)
    (folder / "job.inp").write_text(job(strains))
    libraries = f"{folder}:{os.environ.get('LD_LIBRARY_PATH', '')}"
    done = subprocess.run(
        [ccx, "-i", "job"], cwd=folder, env={**os.environ, "LD_LIBRARY_PATH": libraries}, capture_output=True, text=True
    )
    if done.returncode != 0 or not (folder / "record").exists():
        sys.exit(done.stdout[-2000:] + done.stderr)
    last = {}
    for line in (folder / "record").read_text().splitlines():
        step, point, *stress = line.split()
        if point == "1":
            last[int(step)] = [float(value) for value in stress]
    if sorted(last) != list(range(1, len(strains) + 1)):
        sys.exit(f"CalculiX ended after {len(last)} of {len(strains)} steps:\n{done.stdout[-2000:]}")
    xx, yy, zz, xy, xz, yz = numpy.array([last[step] for step in sorted(last)]).T
    return numpy.array([xx, yy, zz, yz, xz, xy]).T


def compare(name: str, path: str, ccx: str) -> bool:
    """Prints a row of the table. Returns whether the stresses are equal within what is promised."""
    end = paths[name][path]
    own = [k for k in range(6) if name == "space" or axes[k] in ("xx", "yy", "xy")]
    rock = feldspar.Input({**volumes[name], **common})
    with tempfile.TemporaryDirectory() as parent:
        folder = Path(parent)
        (folder / "rock.json").write_text(rock.to_json())
        titles = [f"strain_{axes[k]}" for k in own]
        (folder / "path.csv").write_text(",".join(titles) + "\n" + ",".join(str(end[k]) for k in own) + "\n")
        rock["Strain path/File"] = str(folder / "path.csv")
        rock["Strain path/Largest step"] = f"{max(abs(component) for component in end) / n!r}"
        curve = next(iter(feldspar.rve_path(rock, folder / "out").curves.values()))[1:]
        strains = numpy.zeros((len(curve), 6))
        strains[:, own] = curve[titles]
        stresses = in_calculix(ccx, strains, folder)[:, own]
    expected = curve[[f"stress_{axes[k]}_Pa" for k in own]].to_numpy()
    apart = abs(stresses - expected).max(axis=1) / abs(expected).max(axis=1)
    broken = (curve["n_tension_cracks"] + curve["n_shear_cracks"]).to_numpy()
    intact, after = apart[broken == 0].max(), apart[broken > 0].max()
    print(f"| {name} | {path} | {len(curve)} | {broken[-1]} | {intact:.0e} | {after:.0e} |")
    return intact < 1e-12 and after < 1e-6


if __name__ == "__main__":
    print("| volume | path | rows | broken segments | difference while intact | after breaks |\n|---|---|---|---|---|---|")
    program = os.path.abspath(sys.argv[1])
    are_equal = [compare(name, path, program) for name in volumes for path in paths[name]]
    sys.exit(0 if all(are_equal) else 1)
