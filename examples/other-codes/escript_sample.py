"""The sample in escript 5.6 (Debian: python3-escript; `run-escript escript_sample.py`)."""

import numpy
from esys.escript import Data, Function, Lsup, Vector, grad, inner, integrate, kronecker, whereNonNegative, whereZero
from esys.escript.linearPDEs import LinearPDE, SolverOptions
from esys.finley import Rectangle

import cascade

places = [(0, 0), (1, 1), (0, 1)]  # of xx, yy, xy in a tensor


class Escript:
    def __init__(self) -> None:
        # Integration of order 3: 2 by 2 points.
        self.domain = Rectangle(2, 4, l0=cascade.width, l1=cascade.height, order=1, integrationOrder=3)
        heights = self.domain.getX()[1]
        self.top = whereNonNegative(heights - cascade.height * (1.0 - 1e-9))
        held = whereZero(heights) + self.top
        self.pde = LinearPDE(self.domain, numEquations=2, numSolutions=2)
        self.pde.getSolverOptions().setSolverMethod(SolverOptions.DIRECT)
        self.pde.setValue(q=held * [1.0, 1.0])
        self.free = (1.0 - held) * [1.0, 1.0]
        self.heights = heights
        self.moved = Vector(0.0, self.domain.getX().getFunctionSpace())
        self.n_points = Data(0.0, Function(self.domain)).getNumberOfDataPoints()

    def pull(self, displacement: float) -> None:
        self.moved = self.heights * (displacement / cascade.height) * [0.0, 1.0]

    def strains(self) -> numpy.ndarray:
        gradient = numpy.array(grad(self.moved, Function(self.domain)).toListOfTuples()).reshape(-1, 2, 2)
        return numpy.column_stack([gradient[:, 0, 0], gradient[:, 1, 1], gradient[:, 0, 1] + gradient[:, 1, 0]])

    def at_points(self, values: numpy.ndarray) -> Data:
        data = Data(0.0, values.shape[1:], Function(self.domain), True)
        for k, value in enumerate(values):
            data.setValueOfDataPoint(k, value)
        return data

    def stress(self, stresses: numpy.ndarray) -> Data:
        tensors = numpy.zeros((self.n_points, 2, 2))
        for k, (i, j) in enumerate(places):
            tensors[:, i, j] = tensors[:, j, i] = stresses[:, k]
        return self.at_points(tensors)

    def correct(self, stresses: numpy.ndarray, tangents: numpy.ndarray) -> None:
        stiffness = numpy.zeros((self.n_points, 2, 2, 2, 2))
        for a, (i, j) in enumerate(places):
            for b, (k, m) in enumerate(places):
                for one in {(i, j), (j, i)}:
                    for other in {(k, m), (m, k)}:
                        stiffness[:, one[0], one[1], other[0], other[1]] = tangents[:, a, b]
        self.pde.setValue(A=self.at_points(stiffness), X=-self.stress(stresses))
        self.moved = self.moved + self.pde.getSolution()

    def forces(self, stresses: numpy.ndarray) -> Data:
        """Nodal forces, as the right side of a problem without anything held."""
        problem = LinearPDE(self.domain, numEquations=2, numSolutions=2)
        problem.setValue(X=self.stress(stresses))
        return problem.getRightHandSide()

    def residual(self, stresses: numpy.ndarray) -> float:
        forces = self.forces(stresses)
        return Lsup(forces * self.free) / Lsup(forces)

    def platen_force(self, stresses: numpy.ndarray) -> float:
        # Virtual work of a uniform extension: the ends do all of it, and the lower one does not move.
        strain = numpy.zeros((2, 2))
        strain[1, 1] = 1.0 / cascade.height
        return integrate(inner(self.stress(stresses), strain))


if __name__ == "__main__":
    cascade.compare("escript", cascade.curve_of(Escript()))
