#pragma once

#include "results/fits/run_envelopes.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// What a report is to be made of and where.
struct ReportOrder
{
  std::vector<std::filesystem::path> result_folders;
  std::vector<std::filesystem::path> curves;      ///< measured in a laboratory, one file a test
  std::optional<std::filesystem::path> reference; ///< else that of the first folder that has one
  std::filesystem::path output;                   ///< exists
  RunEnvelopes envelopes{}; ///< of the one folder of a run that has just fitted them; what is not there is fitted
};

/// Reads, and writes the report. Returns what is missing in it and why. Throws InputError for a folder that holds no
/// results and for a curve that cannot be read.
std::vector<std::string> report_on(const ReportOrder& order);
} // namespace feldspar
