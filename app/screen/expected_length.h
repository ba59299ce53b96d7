#pragma once

#include "app/input/input.h"
#include "laboratory/kinds.h"
#include "laboratory/stage_walk.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace feldspar
{
/// Young's modulus of the specimen, a guess by that of its bonds [Pa].
double expected_modulus(const Input& input);

/// The strain at which a test will probably peak, from the strength and modulus of its bonds: a guess, for the time left
/// before the curve has told more. Positive in the sense of the test; none of a test whose protocol has no forecast.
std::optional<double> expected_strain_at_peak(const TestCase& test, const Input& input);

/// The strain at which a test will probably end, from that at its peak.
double expected_last_strain(double strain_at_peak, const TestParameters& tests);

/// The same from the input alone.
double expected_last_strain(const TestCase& test, const Input& input);

/// Work of a test, in any unit that the tests of a run have in common.
struct TestCost
{
  double per_strain;   ///< mean over the test
  double growth = 1.0; ///< the work that is done grows as this power of the strain

  double whole(const double last_strain) const { return per_strain * last_strain; }
  /// Share of it that is done, of a last strain above 0.
  double share(double strain, double last_strain) const;
};

/// Cost of a test on a specimen of grains. A step costs as the grains that it moves; a strain takes the more steps the
/// lower its rate [1/s].
TestCost cost_of_specimen(std::size_t n_grains, double strain_rate);

/// Cost of a test on a sample with RVEs, in which a step of the curve costs as what is broken.
TestCost cost_of_sample(const TestKind& kind, const SampleParameters& sample);

/// Expected length of a test that follows a loading table, and how far it has come, both as the strain that its rate of
/// compression brings in the same time. Ways to a stress are guessed by a modulus.
class StageLength
{
public:
  StageLength(const TestParameters& parameters, double modulus_of_body);

  /// Takes each row of its curve, from the first one on.
  void follow(const CurveSample& row);

  double gone() const;
  double left() const;

private:
  double strain_of(double time) const { return time * strain_rate; }
  /// Takes it to the end of the stage. Returns how long that takes [s].
  double way(const LoadingStage& stage, StageMoment& from) const;

  std::vector<LoadingStage> stages;
  double strain_rate; ///< of compression
  double modulus;
  StageWalk walk;
  std::vector<CurveSample> rows;
  StageMoment now{};
  double time_at_start = 0.0;
  bool is_over = false; ///< after its last stage, or where one cannot be reached
};
} // namespace feldspar
