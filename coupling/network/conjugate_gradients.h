#pragma once

#include <Eigen/Core>

#include <cmath>

namespace feldspar
{
/// A solution for one right side, or for several, column by column.
template <typename Columns>
struct LinearSolution
{
  Columns x;
  bool converged;            ///< all; false: x is the best within the iterations allowed
  unsigned int n_iterations; ///< how often the operator and the preconditioner were applied
};

/// Solves `apply(x) = right` by preconditioned conjugate gradients until the residual's norm, in the preconditioner's
/// measure √(r·P r), has fallen by `tolerance` or to `least`. `apply` may be singular where `right` lies in its range: nothing is
/// asked of the rest. Several right sides go on together, each until it has converged. (Hestenes and Stiefel 1952.)
template <typename Columns, typename Apply, typename Precondition>
LinearSolution<Columns> conjugate_gradients(const Apply& apply, const Precondition& precondition, const Columns& right,
                                            const double tolerance, const unsigned int most_iterations,
                                            const Eigen::Array<double, 1, Columns::ColsAtCompileTime>& least =
                                              Eigen::Array<double, 1, Columns::ColsAtCompileTime>::Zero())
{
  using Row = Eigen::Array<double, 1, Columns::ColsAtCompileTime>;
  const auto dots = [](const Columns& a, const Columns& b) { return Row(a.cwiseProduct(b).colwise().sum()); };
  const auto scaled = [](const Columns& a, const Row& factors) { return a * factors.matrix().asDiagonal(); };
  Columns x = Columns::Zero(right.rows(), right.cols());
  Columns residual = right;
  Columns z = precondition(residual);
  Columns direction = z;
  Row measure = dots(residual, z);
  const Row goal = (tolerance * tolerance * measure).max(least.square());
  auto goes_on = (measure > goal).eval();
  unsigned int k = 0;
  for (; goes_on.any(); ++k)
    {
      if (k == most_iterations)
        return {x, false, k};
      const Columns image = apply(direction);
      const Row curvature = dots(direction, image);
      goes_on = goes_on && curvature > 0.0; // else only round-off, or a motion without stiffness, is left
      const Row step = goes_on.select(measure / curvature, Row::Zero());
      x += scaled(direction, step);
      residual -= scaled(image, step);
      z = precondition(residual);
      const Row next = dots(residual, z);
      direction = z + scaled(direction, goes_on.select(next / measure, Row::Zero()));
      measure = goes_on.select(next, measure);
      goes_on = goes_on && measure > goal;
    }
  return {x, true, k};
}

/// The same for an `apply` that is not symmetric, by stabilised bi-conjugate gradients; what is measured is the plain norm
/// of the preconditioned residual. (van der Vorst 1992.)
template <typename Apply, typename Precondition>
LinearSolution<Eigen::VectorXd> bi_conjugate_gradients(const Apply& apply, const Precondition& precondition,
                                                       const Eigen::VectorXd& right, const double tolerance,
                                                       const unsigned int most_iterations)
{
  // The iteration solves P A x = P b, preconditioned from the left: a residual that is small in forces may be large in
  // motions.
  Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
  Eigen::VectorXd residual = precondition(right);
  const Eigen::VectorXd shadow = residual;
  Eigen::VectorXd direction = residual;
  double measure = shadow.dot(residual);
  const double goal = tolerance * residual.norm();
  for (unsigned int k = 0; k < most_iterations; ++k)
    {
      if (residual.norm() <= goal)
        return {x, true, 2 * k};
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
        return {Eigen::VectorXd::Zero(right.size()), false, 2 * k};
    }
  return {x, false, 2 * most_iterations};
}
} // namespace feldspar
