"""Representative volumes in other codes: the examples, and a mock of preCICE's micro-manager."""

import importlib
import os
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

import feldspar

examples = Path(__file__).resolve().parents[2] / "examples" / "other-codes"


def example(name: str):
    if str(examples) not in sys.path:
        sys.path.insert(0, str(examples))
    return importlib.import_module(name)


class Materials(unittest.TestCase):
    def test_a_sample_in_getfem_is_that_of_feldspar(self) -> None:
        # The same elements, points and cascades: what differs is the order of sums and the precision of both equilibria.
        cascade, code = example("cascade"), example("getfem_sample").Getfem()
        rows, own = cascade.curve_of(code, n_rows=36), cascade.of_feldspar()[:36]
        self.assertGreater(rows[-1][2], 0)  # some segments break
        for (strain, stress, broken), (own_strain, own_stress, own_broken) in zip(rows, own):
            self.assertAlmostEqual(strain, own_strain, delta=1e-12)
            self.assertAlmostEqual(stress / own_stress, 1.0, delta=1e-6)
            self.assertEqual(broken, own_broken)

    def test_kept_bonds_answer_beyond_the_first_break(self) -> None:
        rock = {"Specimen/Shape": "periodic", "Specimen/Width": "10 mm", "Specimen/Height": "10 mm"}
        specimen = feldspar.Specimen(rock, seed=1)
        volumes, rve = feldspar.Volumes(specimen, n=1), feldspar.Rve(specimen)
        strain = [0.0, 2.0 * rve.first_break([0.0, 1.0, 0.0]), 0.0]
        token, kept, _ = volumes.update([strain], bonds_break=False)
        # Linear but for grains without a joint that come into contact.
        numpy.testing.assert_allclose(kept[0], rve.stiffness @ strain, rtol=1e-3, atol=1e3)
        self.assertEqual(volumes.n_broken(token)[0], 0)
        broken, stress, _ = volumes.update([strain])
        self.assertGreater(volumes.n_broken(broken)[0], 0)
        self.assertLess(stress[0][1], kept[0][1])

    def test_a_micro_manager_couples_implicitly(self) -> None:
        # The coupling steps forward, finds that the coupling has not converged, goes back, and steps again.
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                Path("micro.prm").write_text(
                    "subsection Specimen\n  set Shape = periodic\n  set Width = 10 mm\n  set Height = 10 mm\nend\n"
                )
                micro = example("micro_simulation")
                points = [micro.MicroSimulation(k) for k in range(2)]
                self.assertEqual(points[0].initialize()["broken"], 0.0)
                for step in range(1, 4):
                    states = [point.get_state() for point in points]
                    strain = {"strain_xx": 0.0, "strain_yy": 1.5e-4 * step, "strain_xy": 0.0}
                    too_far = points[0].solve({**strain, "strain_yy": 2e-4 * step}, 1.0)
                    points[0].set_state(states[0])
                    fields = [point.solve(strain, 1.0) for point in points]
                    self.assertEqual(fields[0], fields[1])  # as one that never went too far
                    self.assertNotEqual(fields[0], too_far)
                self.assertGreater(fields[0]["broken"], 0.0)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    unittest.main()
