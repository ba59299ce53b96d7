#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace feldspar
{
/// Solves `apply(x) = right` by preconditioned conjugate gradients until the residual's norm, in the preconditioner's
/// measure √(r·P r), has fallen by `tolerance` or to `least`. `apply` may be singular where `right` lies in its range: nothing is asked of the
/// rest. (Hestenes and Stiefel 1952.)
struct LinearSolution
{
  Eigen::VectorXd x;
  bool converged; ///< false: x is the best within the iterations allowed
};

template <typename Apply, typename Precondition>
LinearSolution conjugate_gradients(const Apply& apply, const Precondition& precondition, const Eigen::VectorXd& right,
                                   const double tolerance, const unsigned int most_iterations, const double least = 0.0)
{
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
  Eigen::VectorXd residual = right;
  Eigen::VectorXd z = precondition(residual);
  Eigen::VectorXd direction = z;
  double measure = residual.dot(z);
  const double goal = std::max(tolerance * tolerance * measure, least * least);
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

/// The same for an `apply` that is not symmetric, by stabilised bi-conjugate gradients; what is measured is the plain norm
/// of the preconditioned residual. (van der Vorst 1992.)
template <typename Apply, typename Precondition>
LinearSolution bi_conjugate_gradients(const Apply& apply, const Precondition& precondition,
                                      const Eigen::VectorXd& right, const double tolerance,
                                      const unsigned int most_iterations)
{
  // On P A x = P b, from the left: what is small in forces may be large in motions.
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
  Eigen::VectorXd residual = precondition(right);
  const Eigen::VectorXd shadow = residual;
  Eigen::VectorXd direction = residual;
  double measure = shadow.dot(residual);
  const double goal = tolerance * residual.norm();
  for (unsigned int k = 0; k < most_iterations; ++k)
    {
      if (residual.norm() <= goal)
        return {x, true};
      const Eigen::VectorXd image = precondition(apply(direction));
      const double alpha = measure / shadow.dot(image);
      const Eigen::VectorXd half = residual - alpha * image;
      const Eigen::VectorXd half_image = precondition(apply(half));
      const double omega = half_image.dot(half) / half_image.squaredNorm();
      x += alpha * direction + omega * half;
      residual = half - omega * half_image;
      const double next = shadow.dot(residual);
      const double beta = next / measure * alpha / omega;
      direction = residual + beta * (direction - omega * image);
      measure = next;
      if (!std::isfinite(beta) || !x.allFinite())
        return {Eigen::VectorXd::Zero(right.size()), false};
    }
  return {x, false};
}
} // namespace feldspar
