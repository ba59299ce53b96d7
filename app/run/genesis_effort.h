#pragma once

#include "app/input/input.h"
#include "app/run/specimen_source.h"

#include <string>
#include <vector>

namespace feldspar
{
/// What the genesis of one specimen will probably take. All 0 of one that is read from a file.
struct GenesisEffort
{
  double n_grains = 0.0;
  double n_steps = 0.0; ///< of the packing
  double bytes = 0.0;   ///< of memory, in genesis and in a test
  double seconds = 0.0; ///< of one core
};

GenesisEffort expected_effort(const SpecimenParameters& specimen);

/// The effort of all of them in a sentence; empty where nothing is made.
std::string describe_effort(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders);

/// Refuses specimens that would not fit into the memory that is free now: throws InputError, before any work.
void check_memory(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders);
} // namespace feldspar
