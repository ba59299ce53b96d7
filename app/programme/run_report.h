#pragma once

#include "app/input/curves/laboratory_curve.h"
#include "app/screen/progress.h"
#include "base/text.h"
#include "results/emission.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/quakeml.h"
#include "results/folder/reference.h"
#include "results/runs/run.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The sources of a report and its folder.
struct ReportOrder
{
  std::vector<std::filesystem::path> result_folders;
  std::vector<MeasuredCurve> curves;              ///< measured in a laboratory
  std::optional<std::filesystem::path> reference; ///< else that of the first folder that has one
  std::filesystem::path output;                   ///< exists
  RunEnvelopes envelopes{}; ///< of the one folder of a run that has just fitted them; what is not there is fitted
  std::vector<EmissionCatalogue> catalogues{}; ///< recorded in a laboratory
  std::optional<QuakemlOrigin> quakeml{};      ///< of the tests of the one folder
};

/// Reads, and writes the report, until is_over() says that no more pictures are to be drawn. Returns what is missing in it and
/// why. Throws InputError for a folder that holds no results and for a curve that cannot be read.
std::vector<std::string> report_on(
  const ReportOrder& order, Progress& progress, const std::function<bool()>& is_over = [] { return false; });

/// The tests of a run in its folder, and their report.
struct ReportedTests
{
  RunEnvelopes envelopes;
  std::vector<std::string> missing; ///< in the report, and why
};

/// Writes results, fields of grains, reference file (empty: none) and report.
ReportedTests write_and_report(const Provenance& made_by, const std::vector<FinishedTest>& tests,
                               const std::filesystem::path& reference_file, const std::filesystem::path& folder,
                               Progress& progress);

/// Comparison with the reference, stages and strength envelope of the tests of one variant, for a terminal. `beside_flaws`: as
/// compare().
std::string describe_tests(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference,
                           const RunEnvelopes& envelopes, bool beside_flaws = false);

/// The parts of a run that failed for the reason of the first of them, this reason, and how many others failed; empty if none
/// did.
template <typename Part>
std::string failures(const std::vector<Part>& parts)
{
  std::vector<std::string> names;
  std::string reason;
  std::size_t n_others = 0;
  for (const Part& part : parts)
    if (const std::string& own = part.record.failure; !own.empty())
      {
        if (reason.empty())
          reason = own;
        if (own == reason)
          names.push_back(part.name);
        else
          ++n_others;
      }
  return names.empty() ? ""
                       : fmt::format("{}: {}{}", some_of(names), reason,
                                     n_others > 0 ? fmt::format("; {} more failed for other reasons", n_others) : "");
}

/// The words of a run: into its log.txt, unless quiet onto the terminal. The last line names the page of the report, or how
/// to make it; where quiet, and of a run without tests, the folder.
void write_log(const std::filesystem::path& folder, const std::string& text, bool quiet);
} // namespace feldspar
