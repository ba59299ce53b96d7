#include "app/commands/report_command.h"

#include "app/commands/commands.h"
#include "app/input/laboratory_curve.h"
#include "app/run/output_folder.h"
#include "app/screen/print_result.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "dem/lab/protocols/protocols.h"
#include "report/report.h"
#include "results/fits/strength_data.h"
#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace feldspar
{
std::vector<std::string> report_on(const ReportOrder& order)
{
  ReportInput input;
  input.one_folder = order.result_folders.size() == 1;
  std::optional<std::filesystem::path> reference = order.reference;
  for (const auto& folder : order.result_folders)
    {
      for (auto& series : read_result_folder(folder, test_kinds()))
        input.all.push_back(std::move(series));
      if (!reference && std::filesystem::exists(folder / result_file::reference))
        reference = folder / result_file::reference;
    }
  std::string calibration_problem;
  if (input.one_folder)
    try
      {
        input.calibration = read_calibration(order.result_folders.front());
      }
    catch (const InputError& error)
      {
        calibration_problem = error.what(); // the tests are there none the less
      }
  for (const auto& curve : order.curves)
    input.all.push_back(read_laboratory_curve(curve));
  for (const auto& series : input.all)
    {
      const auto fitted = order.envelopes.find(series.tests.front().variant);
      input.envelopes.push_back(fitted != order.envelopes.end() ? fitted->second
                                                                : fit_strength_envelopes(strength_data(series.tests)));
    }
  if (reference)
    try
      {
        input.reference = read_reference(*reference);
      }
    catch (const InputError& error)
      {
        input.reference_problem = error.what();
      }
  else
    input.reference_problem =
      "there is no reference file to compare with: name one by Report/Reference file, or by feldspar report --reference";
  auto missing = write_report(input, order.output);
  if (!calibration_problem.empty())
    missing.push_back(calibration_problem);
  return missing;
}

int run_report(const ReportOptions& options)
{
  ReportOrder order{options.result_folders, options.curves, options.reference, {}};
  if (order.result_folders.empty() && order.curves.empty())
    throw InputError("report needs the folders of results, or --curve with a measured one; see feldspar report --help");
  // Of one folder the report goes into it, beside its results.
  const bool beside_results = order.result_folders.size() == 1 && !options.output;
  if (options.reference)
    read_reference(*options.reference); // before anything is written
  const OutputFolder folder(beside_results ? order.result_folders.front() : options.output, "report",
                            beside_results || options.force);
  order.output = folder.path();
  const auto missing = report_on(order);
  if (!options.quiet)
    for (const auto& sentence : missing)
      print_result("{}\n", printable(sentence));
  print_result("{}\n", (order.output / result_file::page).string());
  return 0;
}
} // namespace feldspar
