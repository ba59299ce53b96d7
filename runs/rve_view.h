#pragma once

#include "coupling/sample/realisation.h"
#include "dem/specimen/specimen.h"
#include "laboratory/appearance.h"

#include <vector>

namespace feldspar
{
/// The representative volume at a point as a test on a specimen would leave its grains and cracks.
struct RveView
{
  TestAppearance appearance; ///< at rest and as it is
  std::vector<Crack> cracks; ///< where they are at rest
};

/// Turned and moved to where the RVE stands in the sample; its cracks are those of its point in `of_sample`.
template <int dim>
RveView as_seen(const Specimen<dim>& specimen, const SampleRve<dim>& rve, const TestRecord& of_sample);
} // namespace feldspar
