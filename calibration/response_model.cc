#include "calibration/response_model.h"

#include "results/statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace feldspar::calibration
{
ResponseModel::ResponseModel(std::vector<Response> responses, std::vector<Unknown> unknowns,
                             const MicroParameters& fixed, ElasticTable elastic, const double gap_of_specimens)
  : all(std::move(responses))
  , unknown(std::move(unknowns))
  , fixed_values(fixed)
  , table(std::move(elastic))
  , gap(gap_of_specimens)
  , of_tests(all.size())
{
}

MicroParameters ResponseModel::parameters(const Place& place) const
{
  MicroParameters parameters = parameters_at(place.point, unknown, fixed_values);
  parameters.modulus = std::exp(place.log_modulus);
  parameters.bond_tensile_strength = std::exp(place.log_strength);
  return parameters;
}

double ResponseModel::base(const std::size_t j, const UnitPoint& point, const double log_modulus,
                           const double log_strength) const
{
  if (all[j].scale == ResponseScale::strength)
    return log_strength;
  if (all[j].scale == ResponseScale::ratio)
    return 0.0;
  const MicroParameters parameters = parameters_at(point, unknown, fixed_values);
  const ElasticTable::Constants intact = table.at(parameters.stiffness_ratio, parameters.gap.value_or(gap));
  return all[j].scale == ResponseScale::modulus ? log_modulus + std::log(intact.modulus_ratio) : intact.poissons_ratio;
}

double ResponseModel::base(const std::size_t j, const TestedPoint& tested) const
{
  return base(j, tested.point, std::log(tested.parameters.modulus), std::log(tested.parameters.bond_tensile_strength));
}

std::string ResponseModel::title(const std::string& name) const
{
  const auto found = std::ranges::find(all, name, &Response::name);
  return found == all.end() ? name : found->title;
}

void ResponseModel::learn(const std::vector<TestedPoint>& design)
{
  std::size_t n_points = 0;
  std::map<std::uint64_t, std::size_t> packings;
  for (const TestedPoint& tested : design)
    {
      n_points = std::max(n_points, tested.number + 1);
      packings.emplace(tested.seed, packings.size());
    }
  for (std::size_t j = 0; j < all.size(); ++j)
    {
      std::vector<std::vector<double>> of_point(n_points);
      std::vector<UnitPoint> places(n_points);
      for (const TestedPoint& tested : design)
        if (tested.values[j] && *tested.values[j] <= all[j].largest_in_design.value_or(*tested.values[j]))
          {
            of_point[tested.number].push_back(all[j].in_model(*tested.values[j]) - base(j, tested));
            places[tested.number] = tested.point;
          }
      // Points that broke on every packing.
      std::vector<UnitPoint> points;
      std::vector<double> means;
      std::vector<std::vector<double>> values;
      for (std::size_t i = 0; i < n_points; ++i)
        if (of_point[i].size() == packings.size())
          {
            points.push_back(places[i]);
            values.push_back(of_point[i]);
            means.push_back(statistics(of_point[i])->mean);
          }
      LearntResponse& learnt = of_tests[j];
      learnt = {};
      if (points.size() < unknown.size() + 3)
        continue;
      // Rows and columns without interaction: points and packings (two-way analysis of variance).
      std::vector<double> of_packing(packings.size(), 0.0);
      for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t m = 0; m < packings.size(); ++m)
          of_packing[m] += (values[i][m] - means[i]) / double(points.size());
      double squares = 0.0;
      double about_points = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t m = 0; m < packings.size(); ++m)
          {
            squares += std::pow(values[i][m] - means[i] - of_packing[m], 2);
            about_points += std::pow(values[i][m] - means[i], 2);
          }
      learnt.scatter_of_design = std::sqrt(about_points / double(points.size() * (packings.size() - 1)));
      const double variance = squares / double((points.size() - 1) * (packings.size() - 1));
      learnt.noise = std::sqrt(variance);
      learnt.surrogate.emplace(points, means, std::vector<double>(points.size(), variance / double(packings.size())));
    }
}

void ResponseModel::correct(const std::vector<TestedPoint>& tests)
{
  for (std::size_t j = 0; j < all.size(); ++j)
    {
      LearntResponse& learnt = of_tests[j];
      if (!learnt.surrogate)
        continue;
      // Small changes of the parameters lead a packing to another failure: all tests of it count alike.
      std::map<std::uint64_t, std::vector<double>> of_packing;
      for (const TestedPoint& tested : tests)
        if (tested.values[j])
          of_packing[tested.seed].push_back(all[j].in_model(*tested.values[j]) - base(j, tested) -
                                            learnt.surrogate->mean(tested.point));
      std::vector<double> residuals;
      for (const auto& [seed, of_tests] : of_packing)
        residuals.push_back(statistics(of_tests)->mean);
      const auto over_packings = statistics(residuals);
      learnt.correction = over_packings ? over_packings->mean : 0.0;
      learnt.correction_error = over_packings ? over_packings->standard_error.value_or(0.0) : 0.0;
      learnt.scatter = over_packings ? over_packings->standard_deviation : std::nullopt;
    }
}

double ResponseModel::predict(const std::size_t j, const Place& place) const
{
  return base(j, place.point, place.log_modulus, place.log_strength) + of_tests[j].surrogate->mean(place.point) +
         of_tests[j].correction;
}

double ResponseModel::deviation(const std::size_t j, const UnitPoint& point) const
{
  return std::hypot(of_tests[j].surrogate->deviation(point), of_tests[j].correction_error);
}
} // namespace feldspar::calibration
