"""Feldspar: laboratory tests and representative volumes of brittle rock, as grains joined by faces that break.

SI throughout. Stresses and strains of laboratory tests are positive in the sense of the test, those of representative
volumes in tension. Quantities may be given as text with a unit, such as "10 MPa".

>>> import feldspar
>>> rock = feldspar.Input({"Specimen/Width": "20 mm", "Specimen/Height": "40 mm"})
>>> test = feldspar.Specimen(rock, seed=1).test("uniaxial_compression")
>>> test.run().curve
"""

from feldspar._core import Error
from feldspar.bodies import Press, Specimen, Test, fit_envelopes
from feldspar.commands import Run, calibrate, contact, lab, multiscale, report, rve_path
from feldspar.commands import open as open  # not in __all__, where it would hide Python's own
from feldspar.inputs import Input, entries, set_threads, version
from feldspar.volumes import Rve, Trial, Volumes

__all__ = [
    "Error",
    "Input",
    "Press",
    "Run",
    "Rve",
    "Specimen",
    "Test",
    "Trial",
    "Volumes",
    "calibrate",
    "contact",
    "entries",
    "fit_envelopes",
    "lab",
    "multiscale",
    "report",
    "rve_path",
    "set_threads",
    "version",
]
