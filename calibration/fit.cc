#include "calibration/fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace feldspar::calibration
{
namespace
{
constexpr double weight_of_middle = 0.1; // its square beside 1 for a deviation of one tolerance

/// Deviations over the tolerance, then distances from the middle.
struct Residuals
{
  const ResponseModel& model;
  const std::vector<Target>& targets;
  const FitFreedom& freedom;
  const Place& start;
  std::vector<double> widths; ///< of the targets, in the model's measure

  double deviation(const std::size_t t, const Place& place) const
  {
    const Response& response = model.response(targets[t].response);
    return (model.predict(targets[t].response, place) - response.in_model(targets[t].value)) / widths[t];
  }

  /// Nearest of all places with these ratios. A scale adds to the logarithms of its own responses, so that the best one
  /// makes their weighted deviations sum up to nothing.
  Place place_at(const double* const ratios) const
  {
    Place place{UnitPoint(ratios, ratios + model.unknowns().size()), start.log_modulus, start.log_strength};
    const auto set_scale = [&](const ResponseScale of, double& log_scale) {
      double sum = 0.0, weights = 0.0;
      for (std::size_t t = 0; t < targets.size(); ++t)
        if (model.response(targets[t].response).scale == of)
          {
            sum += deviation(t, place) / widths[t];
            weights += 1.0 / (widths[t] * widths[t]);
          }
      if (weights > 0.0)
        log_scale -= sum / weights;
    };
    if (freedom.modulus)
      set_scale(ResponseScale::modulus, place.log_modulus);
    if (freedom.strength)
      set_scale(ResponseScale::strength, place.log_strength);
    return place;
  }

  bool operator()(const double* const* parameters, double* residuals) const
  {
    const Place place = place_at(parameters[0]);
    for (std::size_t t = 0; t < targets.size(); ++t)
      residuals[t] = deviation(t, place);
    for (std::size_t k = 0; k < place.point.size(); ++k)
      residuals[targets.size() + k] = weight_of_middle * (place.point[k] - 0.5);
    return true;
  }
};

/// The bounds of a ratio in its region.
std::pair<double, double> bounds_of(const FitFreedom& freedom, const std::size_t k)
{
  return {std::max(0.0, freedom.centre[k] - freedom.half_width), std::min(1.0, freedom.centre[k] + freedom.half_width)};
}

/// The best ratios near these, which are moved into their region first, and their cost.
std::pair<UnitPoint, double> solve(const Residuals& residuals, UnitPoint x)
{
  const std::size_t n = x.size();
  ceres::NumericDiffOptions steps;
  steps.relative_step_size = 1e-5;
  // The residuals outlive the problem.
  auto* const cost = new ceres::DynamicNumericDiffCostFunction<Residuals, ceres::CENTRAL>(
    &residuals, ceres::DO_NOT_TAKE_OWNERSHIP, steps); // owned by the problem
  cost->AddParameterBlock(int(n));
  cost->SetNumResiduals(int(residuals.targets.size() + n));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  for (std::size_t k = 0; k < n; ++k)
    {
      const auto [lower, upper] = bounds_of(residuals.freedom, k);
      x[k] = std::clamp(x[k], lower, upper);
      problem.SetParameterLowerBound(x.data(), int(k), lower);
      problem.SetParameterUpperBound(x.data(), int(k), upper);
    }
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1; // the same bits for any number of threads
  options.max_num_iterations = 60;
  options.function_tolerance = 1e-8;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {x, summary.final_cost};
}
} // namespace

Fit best_fit(const ResponseModel& model, const std::vector<Target>& targets, const double tolerance,
             const FitFreedom& freedom, const Place& start)
{
  const std::size_t n = model.unknowns().size();
  Residuals residuals{model, targets, freedom, start, {}};
  for (const Target& target : targets)
    residuals.widths.push_back(std::hypot(tolerance * model.response(target.response).per_share(target.value),
                                          model.deviation(target.response, start.point)));
  std::vector<UnitPoint> starts{start.point};
  constexpr std::size_t n_starts = 6;
  constexpr std::uint64_t seed_of_starts = 1;
  for (const UnitPoint& point : sobol_points(n_starts, n, seed_of_starts))
    {
      starts.push_back(point);
      for (std::size_t k = 0; k < n; ++k)
        starts.back()[k] = std::clamp(freedom.centre[k] + freedom.half_width * (2.0 * point[k] - 1.0), 0.0, 1.0);
    }
  std::optional<std::pair<UnitPoint, double>> best;
  for (const UnitPoint& point : starts)
    if (auto found = solve(residuals, point); !best || found.second < best->second)
      best = std::move(found);
  Fit fit{residuals.place_at(best->first.data()), 0.0, {}};
  for (const Target& target : targets)
    {
      const Response& response = model.response(target.response);
      const double deviation = response.in_si(model.predict(target.response, fit.place)) / target.value - 1.0;
      fit.deviations.push_back(deviation);
      fit.misfit += std::pow(deviation / tolerance, 2);
    }
  return fit;
}
} // namespace feldspar::calibration
