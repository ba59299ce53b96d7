"""The sample in dolfinx 0.5.2 (Debian: python3-dolfinx-real)."""

import basix
import dolfinx
import numpy
import ufl
from mpi4py import MPI
from petsc4py import PETSc

import cascade


class Dolfinx:
    def __init__(self) -> None:
        self.mesh = dolfinx.mesh.create_rectangle(
            MPI.COMM_SELF, [[0.0, 0.0], [cascade.width, cascade.height]], [2, 4], dolfinx.mesh.CellType.quadrilateral
        )
        space = dolfinx.fem.VectorFunctionSpace(self.mesh, ("CG", 1))
        degree = 3  # 2 by 2 points
        self.points, _ = basix.make_quadrature(basix.CellType.quadrilateral, degree)
        cell = self.mesh.ufl_cell()

        def at_points(size: int) -> dolfinx.fem.Function:
            element = ufl.VectorElement("Quadrature", cell, degree, size, quad_scheme="default")
            return dolfinx.fem.Function(dolfinx.fem.FunctionSpace(self.mesh, element))

        self.stress, self.tangent = at_points(3), at_points(9)
        self.moved = dolfinx.fem.Function(space)
        trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
        dx = ufl.Measure("dx", metadata={"quadrature_degree": degree, "quadrature_scheme": "default"})
        matrix = ufl.as_matrix([[self.tangent[3 * i + j] for j in range(3)] for i in range(3)])
        self.expression = dolfinx.fem.Expression(voigt(self.moved), self.points)
        self.jacobian = dolfinx.fem.form(ufl.inner(ufl.dot(matrix, voigt(trial)), voigt(test)) * dx)
        self.internal = dolfinx.fem.form(ufl.inner(self.stress, voigt(test)) * dx)
        places = space.tabulate_dof_coordinates()[:, 1]
        nodes = numpy.arange(len(places))
        self.bottom, self.top = nodes[places < 1e-9], nodes[places > cascade.height - 1e-9]
        held = numpy.concatenate([self.bottom, self.top])
        self.held = numpy.concatenate([2 * held, 2 * held + 1]).astype(numpy.int32)
        self.n_points = self.mesh.topology.index_map(2).size_local * len(self.points)

    def pull(self, displacement: float) -> None:
        heights = self.moved.function_space.tabulate_dof_coordinates()[:, 1]
        self.moved.x.array[:] = 0.0
        self.moved.x.array[1::2] = displacement * heights / cascade.height

    def strains(self) -> numpy.ndarray:
        cells = numpy.arange(self.mesh.topology.index_map(2).size_local, dtype=numpy.int32)
        return self.expression.eval(cells).reshape(-1, 3)

    def forces(self, stresses: numpy.ndarray) -> numpy.ndarray:
        self.stress.x.array[:] = stresses.ravel()
        return dolfinx.fem.petsc.assemble_vector(self.internal).array.copy()

    def correct(self, stresses: numpy.ndarray, tangents: numpy.ndarray) -> None:
        self.tangent.x.array[:] = tangents.ravel()
        right = -self.forces(stresses)
        right[self.held] = 0.0
        matrix = dolfinx.fem.petsc.assemble_matrix(self.jacobian)
        matrix.assemble()
        matrix.zeroRowsColumns(self.held)
        solver = PETSc.KSP().create(MPI.COMM_SELF)
        solver.setOperators(matrix)
        solver.setType("preonly")
        solver.getPC().setType("lu")
        change = matrix.createVecRight()
        solver.solve(PETSc.Vec().createWithArray(right, comm=MPI.COMM_SELF), change)
        self.moved.x.array[:] += change.array

    def residual(self, stresses: numpy.ndarray) -> float:
        forces = self.forces(stresses)
        free = forces.copy()
        free[self.held] = 0.0
        return numpy.linalg.norm(free) / numpy.linalg.norm(forces)

    def platen_force(self, stresses: numpy.ndarray) -> float:
        return self.forces(stresses)[2 * self.top + 1].sum()


def voigt(displacement):
    gradient = ufl.grad(displacement)
    return ufl.as_vector([gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]])


if __name__ == "__main__":
    cascade.compare("dolfinx", cascade.curve_of(Dolfinx()))
