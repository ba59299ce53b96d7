#include "app/programme/run_report.h"

#include "app/programme/checks.h"
#include "app/run/interrupt.h"
#include "app/screen/print_result.h"
#include "base/append.h"
#include "base/readable_file.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "dem/lab/protocols/protocols.h"
#include "report/report.h"
#include "report/sections/comparison.h"
#include "report/sections/tables.h"
#include "report/sections/verdict.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/calibration_record.h"
#include "results/folder/csv_tables.h"
#include "results/folder/field_output.h"
#include "results/folder/result_folder.h"
#include "results/folder/sample_field_output.h"

#include <fmt/format.h>

#include <utility>

namespace feldspar
{
std::vector<std::string> report_on(const ReportOrder& order, Progress& progress, const std::function<bool()>& is_over)
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
  std::string calibration_problem; // the tests are there none the less
  if (input.one_folder)
    calibration_problem = refusal_of([&] { input.calibration = read_calibration(order.result_folders.front()); });
  input.catalogues = order.catalogues;
  if (!order.curves.empty())
    input.all.push_back(read_laboratory_curves(order.curves));
  for (const auto& series : input.all)
    {
      const auto fitted = order.envelopes.find(series.tests.front().variant);
      input.envelopes.push_back(fitted != order.envelopes.end() ? fitted->second
                                                                : fit_strength_envelopes(strength_data(series.tests)));
    }
  input.reference_problem =
    reference ? refusal_of([&] { input.reference = read_reference(*reference, test_kinds()); })
              : "there is no reference file; name one by Report/Reference file, or by feldspar report --reference";
  if (order.quakeml)
    write_quakeml(input.all, *order.quakeml, order.output / result_file::quakeml);
  progress.start("pictures");
  DrawingWatch watch{is_over, [&](const std::size_t n_done, const std::size_t n) {
                       progress.update(double(n_done) / double(n), fmt::format("{} of {}", n_done, n));
                     }};
  auto missing = write_report(input, order.output, watch);
  progress.finish(is_over() ? "called off" : "done");
  if (!calibration_problem.empty())
    missing.push_back(calibration_problem);
  return missing;
}

ReportedTests write_and_report(const Provenance& made_by, const std::vector<FinishedTest>& tests,
                               const std::filesystem::path& reference_file, const std::filesystem::path& folder,
                               Progress& progress)
{
  ReportedTests reported{fit_each_rock(tests), {}};
  write_result_folder(made_by, tests, reported.envelopes, folder);
  std::filesystem::create_directories(folder / result_file::fields);
  for (const auto& test : tests)
    if (test.record.body == TestBody::grains)
      write_fields(test.name, test.record.kind, test.record.cracks, test.record.events, test.appearance,
                   folder / result_file::fields, group_name(test.record));
    else if (std::filesystem::exists(folder / result_file::fields / (test.name + ".xdmf"))) // written step by step
      if (const std::string refusal = refusal_of(
            [&] { write_sample_fields(test.name, test.record.kind, test.record.curve, folder / result_file::fields); });
          !refusal.empty())
        reported.missing.push_back(refusal);
  if (!reference_file.empty())
    write_whole_file(folder / result_file::reference, content_of(reference_file));
  if (!tests.empty())
    append(reported.missing, report_on({{folder}, {}, {}, folder, reported.envelopes}, progress, end_of_patience()));
  return reported;
}

std::string describe_tests(const std::vector<FinishedTest>& tests, const std::optional<Reference>& reference,
                           const RunEnvelopes& envelopes, const bool beside_flaws)
{
  const std::vector<ComparisonRow> rows = compare(tests, reference, {}, beside_flaws);
  std::string text = as_text(rows, reference) + "\n";
  if (const std::string sentence = verdict_sentence(rows); !sentence.empty())
    text += fmt::format("{}\n\n", fmt::join(in_lines(sentence, 80), "\n"));
  if (const Table stages = stage_table(tests); !stages.rows.empty())
    text += as_text(stages) + "\n";
  if (const auto found = envelopes.find(tests.empty() ? "" : tests.front().variant);
      found != envelopes.end() && found->second.data.points.size() > 1)
    text += as_text(found->second) + "\n";
  return text;
}

void write_log(const std::filesystem::path& folder, const std::string& text, const bool quiet)
{
  write_whole_file(folder / "log.txt", text);
  if (!quiet)
    print_result("\n{}\n", for_terminal(text));
  // The last line: for scripts (--quiet) the folder, for the eye the page.
  if (!quiet && std::filesystem::exists(folder / result_file::page))
    print_result("{}\n", (folder / result_file::page).string());
  else if (!quiet && std::filesystem::exists(folder / result_file::tests))
    print_result("{0}: make its page with: feldspar report {0}\n", folder.string());
  else
    print_result("{}\n", folder.string());
}
} // namespace feldspar
