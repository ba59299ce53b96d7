#pragma once

#include "coupling/sample/sample_volume.h"
#include "dem/specimen/specimen.h"
#include "results/run.h"

#include <string>

namespace feldspar
{
/// The volume at a point as a test on a specimen would leave it, at rest and as it is, turned and moved to where it
/// stands in the sample. Its cracks are those of its point in `of_sample`.
template <int dim>
FinishedTest as_seen(const Specimen<dim>& specimen, const SampleVolume<dim>& volume, const TestRecord& of_sample,
                     const std::string& name);
} // namespace feldspar
