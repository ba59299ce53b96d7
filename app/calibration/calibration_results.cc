#include "app/calibration/calibration_results.h"

#include "app/calibration/calibrated_input.h"
#include "app/programme/run_report.h"
#include "app/run/file_list.h"
#include "app/run/provenance.h"
#include "base/readable_file.h"
#include "base/whole_file.h"
#include "report/pictures/calibration_pictures.h"
#include "report/report.h"
#include "results/folder/calibration_record.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <string>

namespace feldspar::calibration
{
namespace
{
std::vector<CalibrationRecord::ParameterRow> nearest_parameters(const ResponseModel& model, const Input& nearest)
{
  std::vector<CalibrationRecord::ParameterRow> rows;
  for (const ParameterAnswer& one : reported_parameters(model.unknowns(), true, true))
    rows.push_back({one.name, one.title, one.si_unit(), one.value(micro_parameters(nearest)), {}, {}, {}, "", ""});
  return rows;
}

std::string as_text(const std::vector<CalibrationRecord::ParameterRow>& nearest)
{
  std::string text = fmt::format("{:44} {:>10}\n", "", "nearest");
  for (const auto& row : nearest)
    {
      const ShownUnit unit = shown_unit(row.unit, row.best);
      text +=
        fmt::format("{:44} {:>10.4g}\n", unit.name.empty() ? row.title : fmt::format("{} [{}]", row.title, unit.name),
                    row.best / unit.size);
    }
  return text;
}
} // namespace

void finish(const Run& run, const ResponseModel& model, const CalibrationOutcome& outcome,
            const std::vector<TestedPoint>& tested, const Input& best_input,
            const std::vector<FinishedTest>& finished_tests)
{
  const auto& folder = run.folder;
  write_whole_file(folder / result_file::reference, content_of(run.input.reference_file));
  Input shown = best_input;
  shown.reference_file = result_file::reference;
  write_whole_file(folder /
                     (outcome.verdict == TargetVerdict::missed ? calibration_file::nearest : calibration_file::best),
                   as_prm(shown, fmt::format("{}\n{}\nWritten by feldspar calibrate from {}.", outcome.rock,
                                             outcome.statement, run.input_file.filename().string())));
  const Provenance made_by = provenance(run.input, run.input_file);
  write_calibration(made_by, outcome, model, tested, folder);
  std::string text = as_text(outcome, model);
  if (!finished_tests.empty())
    {
      Progress progress(run.quiet);
      for (const auto& sentence :
           write_and_report(provenance(best_input, run.input_file), finished_tests, "", folder, progress).missing)
        text += sentence + "\n";
    }
  else if (auto record = read_calibration(folder))
    {
      record->parameters = nearest_parameters(model, best_input);
      text += "\n" + as_text(record->parameters);
      for (const auto& sentence : write_report(*record, folder))
        text += sentence + "\n";
    }
  remove_listed_files(folder, "calibration/");
  write_log(folder, text, run.quiet);
}
} // namespace feldspar::calibration
