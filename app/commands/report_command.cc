#include "app/commands/commands.h"
#include "app/programme/run_report.h"
#include "app/run/file_list.h"
#include "app/run/output_folder.h"
#include "app/screen/print_result.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "dem/lab/protocols/protocols.h"
#include "report/film.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"

namespace feldspar
{
int run_report(const ReportOptions& options)
{
  ReportOrder order{options.result_folders,
                    measured_curves(options.curves, options.curve_sizes, options.curve_tests),
                    options.reference,
                    {}};
  for (const std::filesystem::path& file : options.catalogues)
    order.catalogues.push_back(read_emission_catalogue(file));
  if (options.quakeml)
    order.quakeml = parse_quakeml_origin(*options.quakeml);
  if (order.quakeml && order.result_folders.size() != 1)
    throw InputError("--quakeml needs the results of one folder, whose tests have names of their own");
  if (order.result_folders.empty() && order.curves.empty())
    throw InputError("report needs the folders of results, or --curve with a measured one; see feldspar report --help");
  // The report of one folder goes into it, beside its results.
  if (options.film)
    check_film_is_possible(); // before anything is written
  const bool beside_results = order.result_folders.size() == 1 && !options.output;
  if (options.reference)
    read_reference(*options.reference, test_kinds()); // before anything is written
  const auto write_over = [&](const std::filesystem::path& results) {
    std::vector<std::filesystem::path> inputs = options.curves;
    append(inputs, options.catalogues);
    if (options.reference)
      inputs.push_back(*options.reference);
    if (!beside_results)
      check_write_over(results, places_of_reports, inputs);
  };
  const OutputFolder folder(beside_results ? order.result_folders.front() : options.output, "report",
                            beside_results || options.force ? write_over
                                                            : std::function<void(const std::filesystem::path&)>());
  const FolderLock lock(folder.path());
  const FileList list(folder.path());
  order.output = folder.path();
  Progress progress(options.quiet);
  const auto missing = report_on(order, progress);
  if (!options.quiet)
    for (const auto& sentence : missing)
      print_result("{}\n", printable(sentence));
  print_result("{}\n", (order.output / result_file::page).string());
  if (options.film)
    {
      progress.start("film");
      write_film(order.output / result_file::page, order.output / result_file::film);
      progress.finish("done");
      print_result("{}\n", (order.output / result_file::film).string());
    }
  return 0;
}
} // namespace feldspar
