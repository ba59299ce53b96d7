#pragma once

#include "calibration/elastic_table.h"
#include "calibration/open_turns.h"
#include "calibration/responses.h"
#include "calibration/unknowns.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace feldspar::calibration
{
/// The responses of one set of parameters on one packing, from its tests.
struct TestedPoint
{
  std::string stage; ///< design, scale, step 1, ...
  std::size_t number = 0;
  std::uint64_t seed = 0;
  UnitPoint point;
  MicroParameters parameters{};
  std::vector<std::optional<double>> values; ///< of the responses [SI]
};

/// A place of a calibration: the unknowns, and the two scales.
struct Place
{
  UnitPoint point;
  double log_modulus;  ///< of the joints [Pa]
  double log_strength; ///< of the bonds in tension [Pa]
};

/// Knowledge of a response by tests, in the model's measure.
struct LearntResponse
{
  std::optional<Surrogate> surrogate; ///< none where the design gave too few values
  double noise = 0.0; ///< standard deviation of a value of the design about it, without what packings add to all points
  /// Scatter of a single specimen by the design: root-mean-square standard deviation over the packings of a point.
  std::optional<double> scatter_of_design;
  double correction = 0.0;
  double correction_error = 0.0; ///< its standard error
  std::optional<double>
    scatter; ///< of a single specimen about the mean of packings; none without two corrected packings
};

/// Responses as functions of the micro-parameters. Each response is its scale times a smooth function of the
/// dimensionless parameters, which is learnt from a design, times a correction by later tests. The scale of a stiffness
/// is the response of the intact representative volume, that of a strength the bond tensile strength. Poisson's ratio
/// is a sum of these instead.
class ResponseModel
{
public:
  ResponseModel(std::vector<Response> responses, std::vector<Unknown> unknowns, const MicroParameters& fixed,
                ElasticTable elastic, double gap_of_specimens);

  /// Learns from a design whose points were all tested on the same packings. An effect of a packing that is alike in
  /// all points is no noise of the function: it is left to correct().
  void learn(const std::vector<TestedPoint>& design);

  /// Sets the corrections by tests on other packings, each packing by the mean of its tests.
  void correct(const std::vector<TestedPoint>& tests);

  std::size_t n_responses() const { return all.size(); }
  const Response& response(const std::size_t j) const { return all[j]; }
  /// Title of the response of this name; the name itself where there is none.
  std::string title(const std::string& name) const;
  const std::vector<Unknown>& unknowns() const { return unknown; }
  /// Returns whether the design gave enough values of a response.
  bool knows(const std::size_t j) const { return of_tests[j].surrogate.has_value(); }

  MicroParameters parameters(const Place& place) const;
  /// The predicted response, in the model's measure.
  double predict(std::size_t j, const Place& place) const;
  /// Standard deviation of the prediction, by the surrogate and by the packings of the corrections.
  double deviation(std::size_t j, const UnitPoint& point) const;
  const LearntResponse& learnt(const std::size_t j) const { return of_tests[j]; }

private:
  double base(std::size_t j, const UnitPoint& point, double log_modulus, double log_strength) const;
  double base(std::size_t j, const TestedPoint& tested) const;

  std::vector<Response> all;
  std::vector<Unknown> unknown;
  MicroParameters fixed_values;
  ElasticTable table;
  double gap;                           ///< where it is no unknown
  std::vector<LearntResponse> of_tests; ///< of each response
};
} // namespace feldspar::calibration
