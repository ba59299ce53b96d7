// A program that has its own Eigen, with its own alignment and instructions. Prints the stiffness of a representative volume,
// whose making solves by Eigen too, between two solutions of its own.

#include <feldspar/feldspar.h>

#include <Eigen/Dense>

#include <cstdio>
#include <cstdlib>

namespace
{
// The same templates as in the library's Rve: a product, a factorisation by Householder's reflections, a sum.
bool solves()
{
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(60, 60);
  const Eigen::VectorXd right = Eigen::VectorXd::Random(60);
  const Eigen::VectorXd solution = Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).solve(right);
  return (matrix * solution - right).norm() < 1e-9 * right.norm(); // round-off times the condition, some 1e3 here
}
} // namespace

int main()
{
  feldspar::Input cell;
  cell.set("Specimen/Shape", "periodic");
  cell.set("Specimen/Width", "8 mm");
  cell.set("Specimen/Height", "8 mm");
  const bool before = solves();
  const feldspar::Rve rve(feldspar::Specimen(cell, 1), cell);
  for (const double modulus : rve.stiffness())
    std::printf("%.17g\n", modulus);
  return before && solves() ? EXIT_SUCCESS : EXIT_FAILURE;
}
