#pragma once

#include <Eigen/Core>

namespace feldspar
{
/// Solves `apply(x) = right` by preconditioned conjugate gradients until the residual's norm, in the preconditioner's
/// measure, has fallen by `tolerance`. `apply` may be singular where `right` lies in its range: nothing is asked of the
/// rest. (Hestenes and Stiefel 1952.)
struct LinearSolution
{
  Eigen::VectorXd x;
  bool converged; ///< false: x is the best within the iterations allowed
};

template <typename Apply, typename Precondition>
LinearSolution conjugate_gradients(const Apply& apply, const Precondition& precondition, const Eigen::VectorXd& right,
                                   const double tolerance, const unsigned int most_iterations)
{
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
  Eigen::VectorXd residual = right;
  Eigen::VectorXd z = precondition(residual);
  Eigen::VectorXd direction = z;
  double measure = residual.dot(z);
  const double goal = tolerance * tolerance * measure;
  for (unsigned int k = 0; measure > goal; ++k)
    {
      if (k == most_iterations)
        return {x, false};
      const Eigen::VectorXd image = apply(direction);
      const double curvature = direction.dot(image);
      if (!(curvature > 0.0)) // only round-off, or a motion without stiffness, is left
        break;
      const double step = measure / curvature;
      x += step * direction;
      residual -= step * image;
      z = precondition(residual);
      const double next = residual.dot(z);
      direction = z + (next / measure) * direction;
      measure = next;
    }
  return {x, true};
}
} // namespace feldspar
