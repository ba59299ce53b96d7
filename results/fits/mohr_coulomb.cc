#include "results/fits/mohr_coulomb.h"

#include <Eigen/QR>
#include <fmt/format.h>

#include <cmath>

namespace feldspar
{
double MohrCoulombFit::sigma_1(const double sigma_3) const { return uniaxial_strength.value + slope.value * sigma_3; }

FitOrReason<MohrCoulombFit> fit_mohr_coulomb(const StrengthData& data)
{
  std::vector<EnvelopePoint> points = data.points;
  std::erase_if(points, [](const EnvelopePoint& point) { return point.sigma_3 < 0.0; });
  constexpr int n_parameters = 2;
  if (const auto objection = objection_to(points, n_parameters); !objection.empty())
    return {std::nullopt, objection};

  const auto n = Eigen::Index(points.size());
  Eigen::MatrixXd jacobian(n, n_parameters);
  Eigen::VectorXd sigma_1(n);
  for (Eigen::Index i = 0; i < n; ++i)
    {
      jacobian.row(i) << 1.0, points[std::size_t(i)].sigma_3;
      sigma_1[i] = points[std::size_t(i)].sigma_1;
    }
  const Eigen::VectorXd line = jacobian.colPivHouseholderQr().solve(sigma_1);
  const double q_u = line[0];
  const double N = line[1];
  if (N < 1.0)
    return {std::nullopt,
            fmt::format("sigma_1 grows by {:.3g} of sigma_3; a friction angle needs growth by 1 or more", N)};

  const double root = std::sqrt(N);
  Eigen::MatrixXd gradients(4, n_parameters);
  gradients.row(0) << 1.0, 0.0;
  gradients.row(1) << 0.0, 1.0;
  gradients.row(2) << 0.0, 1.0 / ((N + 1.0) * root);        // phi = asin((N - 1)/(N + 1))
  gradients.row(3) << 0.5 / root, -0.25 * q_u / (N * root); // c = q_u/(2 sqrt N)
  const Eigen::VectorXd fitted = jacobian * line;
  const auto half_width = half_widths(jacobian, (sigma_1 - fitted).squaredNorm(), n_parameters, gradients);
  MohrCoulombFit fit;
  fit.uniaxial_strength = {q_u, half_width[0]};
  fit.slope = {N, half_width[1]};
  fit.friction_angle = {std::asin((N - 1.0) / (N + 1.0)), half_width[2]};
  fit.cohesion = {0.5 * q_u / root, half_width[3]};
  fit.quality = quality(points, {fitted.begin(), fitted.end()}, n_parameters);
  return {fit, ""};
}
} // namespace feldspar
