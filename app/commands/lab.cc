#include "app/commands/commands.h"
#include "app/commands/report_command.h"
#include "app/input/input.h"
#include "app/input/parameter_table.h"
#include "app/run/interrupt.h"
#include "app/run/lab_run.h"
#include "app/run/provenance.h"
#include "app/run/reference_body.h"
#include "app/run/specimen_source.h"
#include "app/screen/print_result.h"
#include "app/screen/progress.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/whole_file.h"
#include "report/sections/comparison.h"
#include "results/fits/run_envelopes.h"
#include "results/folder/field_output.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"
#include "results/trust.h"

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
    text +=
      fmt::format("Specimen, seed {}\n{}{}\n", specimen.seed, describe(specimen.report), describe(specimen.flaws));
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
  text += trust_as_text(tests);
  for (const auto& sentence : missing)
    text += sentence + "\n";
  return text;
}

/// Refuses entries that have no use on this body.
void check_bodies(const std::vector<Variant>& all, const Body body, const std::filesystem::path& file)
{
  for (const Variant& variant : all)
    try
      {
        check_body(variant.input, body);
      }
    catch (const InputError& error)
      {
        throw InputError(fmt::format("{}: {}", file.string(), error.what()));
      }
}

/// Specimens, tests and report of a run in its folder, from wherever it stands.
template <int dim>
RunEnd go(const Run& run)
{
  const auto& [folder, input_file, input, quiet] = run;
  Progress progress(quiet);

  // Make the rock.
  const auto all_variants = variants(input);
  const auto orders = specimen_orders(all_variants);
  const auto specimens = provide_specimens<dim>(all_variants, orders, folder, progress);
  for (const auto& specimen : specimens)
    if (specimen.periodic)
      throw InputError(fmt::format("{}: Specimen/Specimen file: is a periodic cell; a laboratory test needs a specimen "
                                   "between walls (feldspar rve takes a cell)",
                                   input_file.string()));

  if (!input.specimen.specimen_file.empty()) // it brought its own shape
    check_bodies(all_variants,
                 dim == 2                  ? Body::plane_box
                 : specimens.front().round ? Body::cylinder
                                           : Body::box,
                 input_file);

  // Break it.
  const auto tests = run_programme(all_variants, orders, specimens, folder, progress);
  const auto failed =
    std::find_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); });
  const auto has_nothing = [](const FinishedTest& test) {
    return !test.record.failure.empty() && test.record.curve.empty();
  };
  if (!tests.empty() && std::all_of(tests.begin(), tests.end(), has_nothing))
    throw InputError(failed->record.failure);

  // Report.
  const bool was_interrupted = interrupted();
  const RunEnvelopes envelopes = fit_each_rock(tests);
  write_result_folder(provenance(input, input_file), tests, envelopes, folder);
  std::filesystem::create_directories(folder / "fields");
  for (const auto& test : tests)
    write_fields(test.name, test.record.kind, test.record.cracks, test.appearance, folder / "fields");
  if (!input.reference_file.empty())
    std::filesystem::copy_file(input.reference_file, folder / result_file::reference,
                               std::filesystem::copy_options::overwrite_existing);
  auto missing = tests.empty() ? std::vector<std::string>{} : report_on({{folder}, {}, {}, folder, envelopes});
  std::vector<SpecimenReport> bodies;
  for (const auto& specimen : specimens)
    bodies.push_back(specimen.report);
  append(missing, beside_reference_body(input, bodies));
  const std::string text = describe_run(all_variants, specimens, tests, envelopes, missing);
  write_whole_file(folder / "log.txt", text);
  if (!quiet)
    print_result("\n{}\n", text);
  print_result("{}\n", folder.string());
  return {was_interrupted, failed == tests.end() ? "" : fmt::format("{}: {}", failed->name, failed->record.failure)};
}

Body body_of(const SpecimenParameters& specimen)
{
  if (specimen.dimension == 2)
    return Body::plane_box;
  return specimen.shape == "cylinder" ? Body::cylinder : Body::box;
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
      if (specimen.specimen_file.empty())
        check_bodies({variant}, body_of(specimen), file);
      const bool is_confined = any_takes_confining_pressure(variant.input.test_list);
      for (const double confinement : variant.input.confinements)
        if (is_confined && tests.intermediate_stress && *tests.intermediate_stress < confinement)
          refuse(
            fmt::format("Tests/Intermediate stress = {:g} MPa: must be at least the least stress, and Confinements "
                        "has {:g} MPa",
                        *tests.intermediate_stress / 1e6, confinement / 1e6));
    }
  reference_of(input);
  try
    {
      reference_body(input);
    }
  catch (const InputError& error)
    {
      refuse(error.what());
    }
}
} // namespace

int run_lab(const CommonOptions& options)
{
  const RunCommand lab{"lab", check,
                       [](const Run& run) { return run.input.specimen.dimension == 2 ? go<2>(run) : go<3>(run); }};
  return run_command(lab, options);
}
} // namespace feldspar
