#pragma once

#include "coupling/sample/sample_volume.h"
#include "dem/specimen/specimen.h"
#include "results/appearance.h"

#include <vector>

namespace feldspar
{
/// The representative volume at a point as a test on a specimen would leave its grains and cracks.
struct VolumeView
{
  TestAppearance appearance; ///< at rest and as it is
  std::vector<Crack> cracks; ///< where they are at rest
};

/// Turned and moved to where the volume stands in the sample; its cracks are those of its point in `of_sample`.
template <int dim>
VolumeView as_seen(const Specimen<dim>& specimen, const SampleVolume<dim>& volume, const TestRecord& of_sample);
} // namespace feldspar
