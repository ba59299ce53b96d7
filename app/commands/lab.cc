#include "app/commands/commands.h"
#include "app/commands/report_command.h"
#include "app/input/input.h"
#include "app/run/interrupt.h"
#include "app/run/lab_run.h"
#include "app/run/output_folder.h"
#include "app/run/progress.h"
#include "app/run/provenance.h"
#include "app/run/run_record.h"
#include "app/run/specimen_source.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "report/sections/comparison.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/field_output.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace feldspar
{
namespace
{
std::optional<Reference> reference_of(const Input& input)
{
  if (input.reference_file.empty())
    return std::nullopt;
  return read_reference(input.reference_file);
}

/// What the screen and log.txt show: specimens, the comparison of each variant, and what is missing and why.
template <int dim>
std::string describe_run(const std::vector<Variant>& variants, const std::vector<Specimen<dim>>& specimens,
                         const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes,
                         const std::vector<std::string>& missing)
{
  std::string text;
  for (const auto& specimen : specimens)
    text += fmt::format("Specimen, seed {}\n{}\n", specimen.seed, describe(specimen.report));
  for (const Variant& variant : variants)
    {
      std::vector<FinishedTest> of_variant;
      std::copy_if(tests.begin(), tests.end(), std::back_inserter(of_variant),
                   [&](const FinishedTest& test) { return test.variant == variant.label; });
      if (!variant.label.empty())
        text += fmt::format("{}\n", variant.label);
      text += as_text(compare(of_variant, reference_of(variant.input))) + "\n";
      if (const auto found = envelopes.find(variant.label);
          found != envelopes.end() && found->second.data.points.size() > 1)
        text += as_text(found->second) + "\n";
    }
  for (const auto& test : tests)
    if (!test.results.peak_stress.value)
      text += fmt::format("{}: {}\n", test.name, test.results.peak_stress.reason);
  for (const auto& sentence : missing)
    text += sentence + "\n";
  return text;
}

void say_how_to_resume(const std::filesystem::path& folder)
{
  fmt::print(stderr, "feldspar: interrupted; go on with: feldspar lab --resume {}\n", folder.string());
}

/// Specimens, tests and report of a run in its folder, from wherever it stands.
template <int dim>
int run_in(const std::filesystem::path& folder, const Input& input, const std::filesystem::path& input_file,
           const bool quiet)
{
  Progress progress(quiet);
  watch_for_interrupt();

  // Make the rock.
  const auto all_variants = variants(input);
  const auto orders = specimen_orders(all_variants);
  const auto specimens = provide_specimens<dim>(all_variants, orders, folder, progress);
  for (const auto& specimen : specimens)
    if (specimen.periodic)
      throw InputError(fmt::format("{}: Specimen/Specimen file: is a periodic cell; a laboratory test needs a specimen "
                                   "between walls (feldspar rve takes a cell)",
                                   input_file.string()));

  // Break it.
  const auto tests = run_programme(all_variants, orders, specimens, folder, progress);
  const auto failed =
    std::find_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); });
  if (std::all_of(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); }) &&
      !tests.empty())
    throw InputError(failed->record.failure);

  // Report.
  const RunEnvelopes envelopes = fit_each_rock(tests);
  write_result_folder(provenance(input, input_file), tests, envelopes, folder);
  std::filesystem::create_directories(folder / "fields");
  for (const auto& test : tests)
    write_fields(test.name, test.record.kind, test.record.cracks, test.appearance, folder / "fields");
  if (!input.reference_file.empty())
    std::filesystem::copy_file(input.reference_file, folder / result_file::reference,
                               std::filesystem::copy_options::overwrite_existing);
  const auto missing = tests.empty() ? std::vector<std::string>{} : report_on({{folder}, {}, {}, folder, envelopes});
  const std::string text = describe_run(all_variants, specimens, tests, envelopes, missing);
  write_whole_file(folder / "log.txt", text);
  if (!quiet)
    fmt::print("\n{}\n", text);
  fmt::print("{}\n", folder.string());
  if (interrupted())
    {
      say_how_to_resume(folder);
      return exit_code::interrupted;
    }
  std::filesystem::remove_all(folder / "checkpoints");
  mark_complete(folder);
  if (failed == tests.end())
    return 0;
  fmt::print(stderr, "feldspar: {}: {}\n", failed->name, failed->record.failure);
  return exit_code::user_error;
}

/// What can be told before any work.
void check(const Input& input, const std::filesystem::path& file)
{
  const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", file.string(), what)); };
  for (const Variant& variant : variants(input))
    {
      const SpecimenParameters& specimen = variant.input.specimen;
      const TestParameters& tests = variant.input.tests;
      if (specimen.shape == "periodic")
        refuse("Specimen/Shape = periodic: a laboratory test needs a specimen between walls; set Shape = box, or use "
               "feldspar rve");
      for (const TestKind& kind : variant.input.test_list)
        if (const std::string objection = objection_to_grains(kind, specimen.dimension); !objection.empty())
          refuse(objection);
      if (!specimen.specimen_file.empty())
        continue; // it brings its own shape
      if (tests.lateral_boundary == LateralBoundary::membrane && specimen.shape != "cylinder")
        refuse("Tests/Lateral boundary = membrane: goes round a cylinder; set Shape = cylinder and Dimension = 3");
      if (tests.intermediate_stress && (specimen.shape != "box" || specimen.dimension != 3))
        refuse("Tests/Intermediate stress: presses on two sides of a box in space; set Shape = box and Dimension = 3");
      const bool is_confined = any_takes_confining_pressure(variant.input.test_list);
      for (const double confinement : variant.input.confinements)
        if (is_confined && tests.intermediate_stress && *tests.intermediate_stress < confinement)
          refuse(
            fmt::format("Tests/Intermediate stress = {:g} MPa: must be at least the least stress, and Confinements "
                        "has {:g} MPa",
                        *tests.intermediate_stress / 1e6, confinement / 1e6));
    }
  reference_of(input);
}
} // namespace

int run_lab(const CommonOptions& options)
{
  if (options.input.empty() && !options.resume)
    throw InputError("lab needs an INPUT, or --resume with the folder of a run; see feldspar lab --help");
  const auto run_or_say_how_to_resume = [&](const auto& folder, const Input& input, const auto& input_file) {
    try
      {
        return input.specimen.dimension == 2 ? run_in<2>(folder, input, input_file, options.quiet)
                                             : run_in<3>(folder, input, input_file, options.quiet);
      }
    catch (const Interrupted&)
      {
        say_how_to_resume(folder);
        return exit_code::interrupted;
      }
    catch (const OutputError& error)
      {
        throw OutputError(
          fmt::format("{}; once it can, go on with: feldspar lab --resume {}", error.what(), folder.string()));
      }
  };
  if (options.resume)
    {
      const RunRecord run = read_run_record("lab", *options.resume);
      if (run.complete)
        {
          fmt::print("{}: this run is complete\n", options.resume->string());
          return 0;
        }
      return run_or_say_how_to_resume(*options.resume, run.input, run.input_file);
    }

  const Input input = read_input(options.input);
  check(input, options.input);
  const OutputFolder folder(options.output, options.input, options.force);
  remove_run(folder.path()); // with --force: what an earlier run left would be taken for this one's
  try
    {
      write_run_record("lab", options.input, folder.path());
    }
  catch (const OutputError&)
    {
      remove_run(folder.path());
      throw;
    }
  try
    {
      return run_or_say_how_to_resume(folder.path(), input, options.input);
    }
  catch (const InputError&)
    {
      remove_run(folder.path()); // a mistake leaves nothing
      throw;
    }
}
} // namespace feldspar
