"""Tells whether an installation works: python3 -m feldspar.check

Breaks a small specimen in this process and by the command, and compares both with the numbers stored here, which are the
same to the last bit on any processor.
"""

import sys
import tempfile
from pathlib import Path

import feldspar

_ROCK = {"Specimen/Width": "12 mm", "Specimen/Height": "24 mm", "Tests/List": "direct_tension"}
_STRENGTH = 9465304.05026648  # [Pa]
_CRACKS = 39


def main() -> int:
    """Returns 0 if the installation works, else 1; says what was found."""
    print(f"feldspar {feldspar.version()}")
    test = feldspar.Specimen(feldspar.Input(_ROCK)).test("direct_tension").run()
    with tempfile.TemporaryDirectory() as folder:
        [by_command] = feldspar.lab(feldspar.Input(_ROCK), Path(folder) / "run").summary["tests"]
    figures = {
        "in Python": (test.summary["peak_stress_Pa"], len(test.cracks)),
        "by the command": (by_command["peak_stress_Pa"], by_command["n_tension_cracks"] + by_command["n_shear_cracks"]),
    }
    for where, (strength, cracks) in figures.items():
        print(f"{where}: tensile strength {strength!r} Pa, {cracks} broken segments")
    if any(one != (_STRENGTH, _CRACKS) for one in figures.values()):
        print(f"expected: {_STRENGTH!r} Pa, {_CRACKS}; the installation is not sound")
        return 1
    print("as expected; the installation works")
    return 0


if __name__ == "__main__":
    sys.exit(main())
