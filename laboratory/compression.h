#pragma once

#include "laboratory/own_entries.h"

#include <vector>

namespace feldspar
{
/// The pace of a body that is pressed between platens.
struct CompressionParameters
{
  double strain_rate = 1.0;      ///< magnitude [1/s]
  double sampling_strain = 1e-5; ///< between two rows of the curve
};

/// The entries of CompressionParameters.
std::vector<Entry<TestParameters>> compression_entries();
} // namespace feldspar
