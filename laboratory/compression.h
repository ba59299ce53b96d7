#pragma once

#include "laboratory/own_entries.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The rate of a laboratory's machine, which a run may have to exceed.
struct LoadingRate
{
  enum class Of
  {
    stress, ///< [Pa/s]
    force,  ///< [N/s]
    travel  ///< of both platens [m/s]
  };

  Of of;
  double value;
  std::string text; ///< as it was written
};

/// The pace and the machine of a body that is pressed between platens.
struct CompressionParameters
{
  double strain_rate = 1.0;                ///< magnitude [1/s]
  double sampling_strain = 1e-5;           ///< between two rows of the curve
  std::optional<LoadingRate> loading_rate; ///< of the laboratory
  std::optional<double> machine_stiffness; ///< between crosshead and platens; none: rigid [N/m]
};

/// The entries of the pace.
std::vector<Entry<TestParameters>> compression_entries();

/// The entries of the machine.
std::vector<Entry<TestParameters>> machine_entries();
} // namespace feldspar
