#pragma once

#include "report/sections/comparison.h"

#include <string>
#include <vector>

namespace feldspar
{
/// Whether the model is the rock, in words.
struct Verdict
{
  std::string headline;
  std::vector<std::string> points; ///< property by property
};

Verdict verdict(const std::vector<ComparisonRow>& rows, const std::string& reason_for_no_reference);
} // namespace feldspar
