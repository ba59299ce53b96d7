#pragma once

#include "results/variant_setting.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Names that tell several variants apart in the names of files: their entries and values, such as
/// `bond_cohesion_80_MPa`. They consist of letters, digits, `.`, `_` and `-`; no two are alike, also where capitals
/// make no difference. A name that would be too long, or the same as another, ends in the number of the variant.
std::vector<std::string> names_in_files(const std::vector<std::vector<VariantSetting>>& variants);
} // namespace feldspar
