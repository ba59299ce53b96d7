#pragma once

#include "results/evaluation.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

/// Common parts of the fits of strength envelopes. Compression is positive here and in the files that include this
/// one: a confinement is positive, a tensile strength is measured positive and enters as sigma_3 = -sigma_t.
namespace feldspar
{
/// A state at failure [Pa].
struct EnvelopePoint
{
  double sigma_3;
  double sigma_1;
};

/// The data that envelopes are fitted to and compared with; points are means over the seeds, all of the same weight.
struct StrengthData
{
  std::vector<EnvelopePoint> points;                   ///< the uniaxial test is the one at sigma_3 = 0
  std::optional<double> uniaxial_compressive_strength; ///< measured [Pa]
  std::optional<double> tensile_strength;              ///< measured, positive [Pa]
  bool tension_is_indirect = false;                    ///< of Brazilian tests, where there is no direct tension
  bool of_flawed_body = false; ///< then they are highest nominal stresses, and no strengths of the rock
};

/// A fit, or the reason why there is none.
template <typename Fit>
struct FitOrReason
{
  std::optional<Fit> fit;
  std::string reason;
};

/// A parameter with the half-width of its 95 % confidence interval, or the reason why it has none.
struct Estimate
{
  double value;
  Figure half_width;
};

struct PointResidual
{
  EnvelopePoint point;
  double residual; ///< sigma_1 of the point less that of the envelope [Pa]
};

/// Quality of a fit: how near the envelope comes to its points, in sigma_1.
struct FitQuality
{
  int degrees_of_freedom;  ///< points less parameters; 0: any such envelope meets its points, which proves nothing
  Figure r_squared;        ///< none without freedom
  double root_mean_square; ///< of the residuals [Pa]
  std::vector<PointResidual> residuals;

  /// The least and the largest sigma_3 of the points; an envelope is known between them.
  double lowest_sigma_3() const;
  double highest_sigma_3() const;
};

FitQuality quality(const std::vector<EnvelopePoint>& points, const std::vector<double>& fitted_sigma_1,
                   int n_parameters);

/// Why no envelope of so many parameters can be fitted to these points; empty if it can.
std::string objection_to(const std::vector<EnvelopePoint>& points, int n_parameters);

/// Why this is no measured strength; empty if it is one.
std::string objection_to(const std::string& name, double strength);

/// Half-widths of 95 % confidence intervals, t_{0.975, n - p} sqrt(r·r/(n - p) g·(JᵀJ)⁻¹g), of quantities whose
/// gradients g with respect to the fitted parameters are the rows of `gradients`. J is the Jacobian of the residuals at
/// the optimum; where a parameter is held on its bound, J and g have no column for it and n_parameters still counts it.
std::vector<Figure> half_widths(const Eigen::MatrixXd& jacobian, double sum_of_squares, int n_parameters,
                                const Eigen::MatrixXd& gradients);
} // namespace feldspar
