#pragma once

#include "app/input/input.h"
#include "app/run/specimen_source.h"

#include <vector>

namespace feldspar
{
/// Refuses specimens that would not fit into the memory that is free now: throws InputError, before any work.
void check_memory(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders);
} // namespace feldspar
