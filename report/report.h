#pragma once

#include "report/pictures/picture.h"
#include "results/emission.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/runs/series.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The contents of a report.
struct ReportInput
{
  std::vector<Series> all;                  ///< the first is the one that is compared in words
  std::vector<StrengthEnvelopes> envelopes; ///< of each series
  std::optional<Reference> reference;
  std::string reference_problem;                               ///< why there is none although there should be one
  std::optional<CalibrationRecord> calibration = std::nullopt; ///< of the one folder, if it is of one
  bool one_folder = true; ///< the names of tests are unlike; every test gets pictures of its own, as files
  std::vector<EmissionCatalogue> catalogues = {}; ///< of acoustic emission, recorded in a laboratory
};

/// Writes report.html, figures/ and tables/ into a folder that exists. Once watch.is_over() says so no more pictures are drawn,
/// which take nearly all of the time; words and tables come all the same. Returns what is missing in the report and why, each in
/// a sentence; the report says it too.
std::vector<std::string> write_report(const ReportInput& input, const std::filesystem::path& folder,
                                      const DrawingWatch& watch = {});

/// The same of a calibration of which no specimen tested an answer: its section alone. Returns what is missing.
std::vector<std::string> write_report(const CalibrationRecord& calibration, const std::filesystem::path& folder,
                                      const DrawingWatch& watch = {});
} // namespace feldspar
