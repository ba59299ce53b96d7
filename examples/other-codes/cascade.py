"""A sample of representative volumes in another finite-element code: what the codes of this folder have in common.

The code gives the strains at its points and solves one linear step; the volumes answer. Newton's method runs with all bonds
kept. At equilibrium the volumes break what is overloaded at their strains, and the search begins again, until nothing
breaks: the cascade of `feldspar multiscale` (docs/theory.md, section 10).
"""

import sys
import tempfile
from pathlib import Path
from typing import Protocol

import numpy

import feldspar

width, height = 0.024, 0.048  # m
rock = feldspar.Input(Path(__file__).resolve().parent / "sample.prm")
step = float(rock["Sample/Tension step"])
n_steps = round(float(rock["Tests/Stop strain"]) / step)
tolerance = 1e-8  # unbalanced over internal force


class Code(Protocol):
    """A finite-element code with the sample in 2 by 4 elements, its ends held by rough platens."""

    n_points: int

    def pull(self, displacement: float) -> None:
        """Moves the upper platen to a displacement [m]."""

    def strains(self) -> numpy.ndarray:
        """Returns xx, yy, xy (engineering) at all points; [n_points, 3]."""

    def correct(self, stresses: numpy.ndarray, tangents: numpy.ndarray) -> None:
        """Takes one step of Newton's method; stresses [n_points, 3], tangents [n_points, 3, 3]."""

    def residual(self, stresses: numpy.ndarray) -> float:
        """Returns unbalanced over internal force."""

    def platen_force(self, stresses: numpy.ndarray) -> float:
        """Returns the force of the upper platen, per metre across the plane [N/m]."""


Curve = list[tuple[float, float, int]]
"""Strain, stress [Pa] and broken segments, row by row."""


def equilibrium(code: Code, volumes: feldspar.Volumes, token: int) -> numpy.ndarray:
    """Newton's method with the bonds of a state kept. Returns the stresses at the points."""
    for _ in range(50):
        _, stresses, tangents = volumes.update(code.strains(), token, tangent=True, bonds_break=False)
        if code.residual(stresses) < tolerance:
            return stresses
        code.correct(stresses, tangents)
    raise RuntimeError("no equilibrium")


def curve_of(code: Code, n_rows: int = n_steps) -> Curve:
    """Pulls the sample apart."""
    volumes = feldspar.Volumes(feldspar.Specimen(rock, seed=int(rock["Seeds/Seeds"])), n=code.n_points)
    token, n_broken = 0, 0
    rows: Curve = []
    for row in range(1, n_rows + 1):
        code.pull(row * step * height)
        while True:
            stresses = equilibrium(code, volumes, token)
            token, _, _ = volumes.update(code.strains(), token)
            n_before, n_broken = n_broken, int(volumes.n_broken(token).sum())
            if n_broken == n_before:
                break
        rows.append((row * step, code.platen_force(stresses) / width, n_broken))
    return rows


def of_feldspar() -> Curve:
    """Returns the curve of `feldspar multiscale sample.prm`."""
    with tempfile.TemporaryDirectory() as folder:
        table = feldspar.multiscale(rock, Path(folder) / "out").curves["direct_tension_seed_1"]
    cracks = table["n_tension_cracks"] + table["n_shear_cracks"]
    return [row for row in zip(table["axial_strain"], table["axial_stress_Pa"], cracks) if row[0] > 0.0]


def compare(name: str, rows: Curve) -> None:
    """Prints stiffness and peak beside those of Feldspar; ends with 1 where they differ by more than is promised."""
    curves = {name: rows, "feldspar multiscale": of_feldspar()}
    stiffness = {one: rows[0][1] / rows[0][0] for one, rows in curves.items()}
    peak = {one: max(stress for _, stress, _ in rows) for one, rows in curves.items()}
    for one in curves:
        print(f"{one:20} E {stiffness[one] / 1e9:.6f} GPa, peak {peak[one] / 1e6:.4f} MPa, broken {curves[one][-1][2]}")

    def apart(values: dict[str, float]) -> float:
        return abs(values[name] / values["feldspar multiscale"] - 1.0)

    print(f"{name} differs by {apart(stiffness):.1e} in stiffness and {apart(peak):.1e} in the peak")
    if apart(stiffness) > 1e-6 or apart(peak) > 5e-3:
        sys.exit(1)
