#pragma once

#include "laboratory/compression.h"
#include "laboratory/stage_walk.h"

#include <vector>

namespace feldspar
{
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
  double strain_of(double time) const { return time * wanted.of<CompressionParameters>().strain_rate; }
  /// Takes it to the end of the stage. Returns how long that takes [s].
  double way(const LoadingStage& stage, StageMoment& from) const;

  TestParameters wanted;
  double modulus;
  StageWalk walk;
  std::vector<CurveSample> rows;
  StageMoment now{};
  double time_at_start = 0.0;
  bool is_over = false; ///< after its last stage, or where one cannot be reached
};
} // namespace feldspar
