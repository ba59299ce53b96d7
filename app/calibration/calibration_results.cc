#include "app/calibration/calibration_results.h"

#include "app/calibration/calibrated_input.h"
#include "app/programme/run_report.h"
#include "app/run/provenance.h"
#include "base/whole_file.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>

namespace feldspar::calibration
{
void finish(const Run& run, const ResponseModel& model, const CalibrationOutcome& outcome,
            const std::vector<TestedPoint>& tested, const Input& best_input,
            const std::vector<FinishedTest>& finished_tests)
{
  const auto& folder = run.folder;
  std::filesystem::copy_file(run.input.reference_file, folder / result_file::reference,
                             std::filesystem::copy_options::overwrite_existing);
  Input shown = best_input;
  shown.reference_file = result_file::reference;
  write_whole_file(folder / (outcome.has_reached ? calibration_file::best : calibration_file::nearest),
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
  std::filesystem::remove_all(folder / "calibration");
  write_log(folder, text, run.quiet);
}
} // namespace feldspar::calibration
