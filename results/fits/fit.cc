#include "results/fits/fit.h"

#include "results/statistics.h"

#include <Eigen/QR>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace feldspar
{
namespace
{
// No rock is weaker or stronger; beyond them a fit in units of its largest stress works with round-off alone [Pa].
constexpr double least_strength = 1.0;
constexpr double greatest_stress = 1e15;

double confinement(const PointResidual& one) { return one.point.sigma_3; }
} // namespace

double FitQuality::lowest_sigma_3() const { return confinement(std::ranges::min(residuals, {}, confinement)); }

double FitQuality::highest_sigma_3() const { return confinement(std::ranges::max(residuals, {}, confinement)); }

FitQuality quality(const std::vector<EnvelopePoint>& points, const std::vector<double>& fitted_sigma_1,
                   const int n_parameters)
{
  const double n = double(points.size());
  double mean = 0.0;
  for (const auto& point : points)
    mean += point.sigma_1 / n;

  FitQuality result;
  result.degrees_of_freedom = int(points.size()) - n_parameters;
  double squares = 0.0;
  double squares_about_mean = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double residual = points[i].sigma_1 - fitted_sigma_1[i];
      result.residuals.push_back({points[i], residual});
      squares += residual * residual;
      squares_about_mean += (points[i].sigma_1 - mean) * (points[i].sigma_1 - mean);
    }
  result.root_mean_square = std::sqrt(squares / n);
  if (result.degrees_of_freedom < 1)
    result.r_squared.reason = "there are no more points than parameters";
  else if (squares_about_mean > 0.0)
    result.r_squared.value = 1.0 - squares / squares_about_mean;
  else
    result.r_squared.reason = "sigma_1 is the same at every point";
  return result;
}

std::string objection_to(const std::vector<EnvelopePoint>& points, const int n_parameters)
{
  std::set<double> confinements;
  for (const auto& [sigma_3, sigma_1] : points)
    {
      if (!std::isfinite(sigma_3) || !std::isfinite(sigma_1))
        return "a point is not a finite number";
      const double largest = std::max(std::abs(sigma_3), sigma_1);
      if (largest < least_strength || largest > greatest_stress)
        return fmt::format("the point sigma_3 = {:.6g} MPa, sigma_1 = {:.6g} MPa lies beyond all rock: one stress of a "
                           "point must be 1e-6 MPa or more, and none more than 1e9 MPa",
                           sigma_3 / 1e6, sigma_1 / 1e6);
      if (sigma_1 < sigma_3)
        return fmt::format("sigma_1 = {:.6g} MPa lies below sigma_3 = {:.6g} MPa", sigma_1 / 1e6, sigma_3 / 1e6);
      confinements.insert(sigma_3);
    }
  if (confinements.size() < std::size_t(n_parameters))
    return fmt::format("{} parameters need points at {} different sigma_3 or more; there {}", n_parameters,
                       n_parameters,
                       confinements.empty()       ? "are none"
                       : confinements.size() == 1 ? "is one"
                                                  : fmt::format("are {}", confinements.size()));
  return "";
}

std::string objection_to(const std::string& name, const double strength)
{
  if (std::isfinite(strength) && strength >= least_strength && strength <= greatest_stress)
    return "";
  return fmt::format("the measured {} is {:.6g} MPa; it must be a positive number from 1e-6 to 1e9 MPa", name,
                     strength / 1e6);
}

std::vector<Figure> half_widths(const Eigen::MatrixXd& jacobian, const double sum_of_squares, const int n_parameters,
                                const Eigen::MatrixXd& gradients)
{
  const auto none = [&](const std::string& reason) {
    return std::vector<Figure>(std::size_t(gradients.rows()), Figure{std::nullopt, reason});
  };
  const auto degrees_of_freedom = jacobian.rows() - n_parameters;
  if (degrees_of_freedom < 1)
    return none("there are no more points than parameters");
  if (jacobian.cols() == 0)
    return none("every parameter sits on a bound");

  // JᵀJ = D P RᵀR Pᵀ D with the columns scaled by D: parameters differ by orders of magnitude.
  const Eigen::VectorXd scale = jacobian.colwise().norm();
  if ((scale.array() == 0.0).any())
    return none("the points do not tell all parameters");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian * scale.cwiseInverse().asDiagonal());
  const auto p = jacobian.cols();
  if (qr.rank() < p)
    return none("the points do not tell the parameters apart");
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * gradients.transpose();
  const Eigen::MatrixXd permuted = qr.colsPermutation().transpose() * scaled;
  const Eigen::MatrixXd root =
    qr.matrixR().topLeftCorner(p, p).triangularView<Eigen::Upper>().transpose().solve(permuted);

  const double t = student_factor_95(degrees_of_freedom);
  const double deviation = std::sqrt(sum_of_squares / double(degrees_of_freedom));
  std::vector<Figure> result;
  for (Eigen::Index i = 0; i < root.cols(); ++i)
    result.push_back({t * deviation * root.col(i).norm(), ""});
  return result;
}
} // namespace feldspar
