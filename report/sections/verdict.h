#pragma once

#include "report/page/page.h"
#include "report/sections/comparison.h"

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// Verdict in words on whether the model agrees with the rock.
struct Verdict
{
  std::string headline;
  std::vector<Tile> tiles;         ///< property by property
  std::vector<std::string> points; ///< properties without a result
};

/// Sentence on the properties that both have; empty where there is none.
std::string verdict_sentence(const std::vector<ComparisonRow>& rows);

/// `reason_for_no_reference`: why there is none although there should be one.
Verdict verdict(const std::vector<ComparisonRow>& rows, const std::optional<Reference>& reference,
                const std::string& reason_for_no_reference);

/// Names of a few properties as the subject of a sentence, with its verb; of many their number.
std::string subject_of(const std::vector<std::string>& properties, const char* singular, const char* plural);
} // namespace feldspar
