"""The sample in GetFEM 5.4.2 (Debian: python3-getfem)."""

import getfem
import numpy
import scipy.sparse.linalg

import cascade


class Getfem:
    def __init__(self) -> None:
        mesh = getfem.Mesh(
            "cartesian", numpy.linspace(0.0, cascade.width, 3), numpy.linspace(0.0, cascade.height, 5)
        )
        self.space = getfem.MeshFem(mesh, 2)
        self.space.set_classical_fem(1)
        self.rule = getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS_PARALLELEPIPED(2, 3)"))  # 2 by 2 points
        stress, tangent = getfem.MeshImData(self.rule, -1, 3), getfem.MeshImData(self.rule, -1, [3, 3])
        self.model = getfem.Model("real")
        self.model.add_fem_variable("u", self.space)
        self.model.add_im_data("stress", stress)
        self.model.add_im_data("tangent", tangent)
        self.points = stress
        self.n_points = stress.nbpts()
        heights = self.space.basic_dof_nodes()[1]
        numbers = numpy.arange(self.space.nbdof())
        self.held = numbers[(heights < 1e-9) | (heights > cascade.height - 1e-9)]
        self.free = numpy.setdiff1d(numbers, self.held)
        self.top = numbers[heights > cascade.height - 1e-9][1::2]
        self.heights = heights
        self.moved = numpy.zeros(len(numbers))

    def pull(self, displacement: float) -> None:
        self.moved[:] = 0.0
        self.moved[1::2] = displacement * self.heights[1::2] / cascade.height

    def strains(self) -> numpy.ndarray:
        self.model.set_variable("u", self.moved)
        strain = "[Grad_u(1,1); Grad_u(2,2); Grad_u(1,2) + Grad_u(2,1)]"
        return self.model.interpolation(strain, self.points).reshape(-1, 3)

    def forces(self, stresses: numpy.ndarray) -> numpy.ndarray:
        self.model.set_variable("stress", stresses.ravel())
        return getfem.asm("generic", self.rule, 1, virtual_work("stress"), -1, self.model)

    def correct(self, stresses: numpy.ndarray, tangents: numpy.ndarray) -> None:
        right = -self.forces(stresses)[self.free]
        self.model.set_variable("tangent", tangents.transpose(0, 2, 1).ravel())  # columns first
        work = virtual_work("(tangent*[Grad_u(1,1); Grad_u(2,2); Grad_u(1,2) + Grad_u(2,1)])")
        matrix = getfem.asm("generic", self.rule, 2, work, -1, self.model)
        dense = matrix.full()[numpy.ix_(self.free, self.free)]
        self.moved[self.free] += numpy.linalg.solve(dense, right)

    def residual(self, stresses: numpy.ndarray) -> float:
        forces = self.forces(stresses)
        return numpy.linalg.norm(forces[self.free]) / numpy.linalg.norm(forces)

    def platen_force(self, stresses: numpy.ndarray) -> float:
        return self.forces(stresses)[self.top].sum()


def virtual_work(stress: str) -> str:
    return (
        f"{stress}(1)*Grad_Test_u(1,1) + {stress}(2)*Grad_Test_u(2,2) + {stress}(3)*(Grad_Test_u(1,2) + Grad_Test_u(2,1))"
    )


if __name__ == "__main__":
    cascade.compare("GetFEM", cascade.curve_of(Getfem()))
