#pragma once

#include "results/quantities.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace feldspar
{
/// A stage of a test, read off its curve; compression positive.
struct StageResults
{
  double strain_at_start = 0.0;
  double strain_at_end = 0.0;
  double stress_at_start = 0.0; ///< axial [Pa]
  double stress_at_end = 0.0;   ///< axial [Pa]
  Figure lateral_stress_at_end; ///< of the side walls [Pa]
  Figure slope;                 ///< of axial stress over axial strain, by least squares [Pa]
  std::uint64_t n_cracks = 0;
  double duration = 0.0; ///< [s]
};

/// The first row with 1 % of the cracks at the peak; none if there is no crack up to there.
std::optional<std::size_t> crack_initiation_row(const TestRecord& record, std::size_t peak);

/// Reads the results off the curve (docs/theory.md §5), quantity by quantity; the functions are in results/evaluation/.
TestResults evaluate(const TestRecord& record);

/// One for each stage of the record, whose rows must lie on its curve.
std::vector<StageResults> evaluate_stages(const TestRecord& record);
} // namespace feldspar
