#include "app/commands/commands.h"
#include "app/input/input.h"
#include "app/programme/checks.h"
#include "app/programme/lab_run.h"
#include "app/programme/laboratory_effort.h"
#include "app/programme/reference_body.h"
#include "app/programme/run_report.h"
#include "app/programme/specimen_source.h"
#include "app/run/interrupt.h"
#include "app/run/provenance.h"
#include "base/append.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/ranks/ranks.h"
#include "dem/lab/seating.h"
#include "report/sections/study_text.h"
#include "results/folder/result_folder.h"
#include "results/runs/trust.h"
#include "runs/share_out.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace feldspar
{
namespace
{
std::string line_by_line(const std::vector<std::string>& sentences)
{
  return sentences.empty() ? "" : fmt::format("{}\n", fmt::join(sentences, "\n"));
}

/// The text of the screen and log.txt: specimens, the comparison of each variant, missing results with their reasons.
template <int dim>
std::string describe_run(const std::vector<Variant>& variants, const std::vector<Specimen<dim>>& specimens,
                         const std::vector<FinishedTest>& tests, const RunEnvelopes& envelopes,
                         const std::vector<std::string>& missing)
{
  constexpr std::size_t most_in_full = 3; // more variants are lines of one table
  std::string text;
  std::set<std::string> written; // variants of one seed may have the same body
  for (const auto& specimen : specimens)
    if (const std::string body =
          fmt::format("Specimen, seed {}\n{}{}\n", specimen.seed, describe(specimen.report), describe(specimen.flaws));
        written.insert(body).second)
      text += body;
  if (variants.size() > most_in_full)
    return text + study_as_text(tests, reference_of(variants.front().input)) + "\n" + trust_as_text(tests) +
           line_by_line(missing);
  for (const Variant& variant : variants)
    {
      std::vector<FinishedTest> of_variant;
      std::ranges::copy_if(tests, std::back_inserter(of_variant),
                           [&](const FinishedTest& test) { return test.variant == variant.label; });
      if (!variant.label.empty())
        text += fmt::format("{}\n", variant.label);
      text += describe_tests(of_variant, reference_of(variant.input), envelopes, any_has_flaws(tests));
    }
  return text + trust_as_text(tests) + line_by_line(missing);
}

/// Each process makes its share of the specimens, and then of the tests, or all make all tests together.
template <int dim>
void share_out_tests(const Run& run, Progress& progress)
{
  const RunPlan plan(run.input);
  bool together = false;
  ranks::first([&] { // memory that is free differs from machine to machine
    check_memory_of_tests(plan);
    together = makes_tests_together(plan);
  });
  together = ranks::any(together);
  share_out_specimens<dim>(plan, run.folder, progress);
  if (together)
    {
      run_together<dim>(plan, run.folder, progress);
      return;
    }
  together_or_interrupted([&] {
    const auto own_tests = [&](const std::vector<SpecimenSize>& known) {
      const auto all = plan_tests(plan, known);
      std::vector<LaboratoryOrder> own;
      for (const std::size_t k : share_of_this_process(longest_first(all)))
        own.push_back(all[k]);
      return own;
    };
    const auto tests = own_tests(std::vector<SpecimenSize>(plan.orders.size()));
    auto specimens = provide_specimens_of<dim>(tests, plan, run.folder, progress);
    // The first process meets again what cannot be made, and reports it.
    if (!tests.empty() && std::ranges::none_of(specimens, [](const auto& specimen) { return specimen.is_periodic(); }))
      run_programme(plan, own_tests(sizes_of(specimens)), specimens, run.folder, progress, false);
    end_if_interrupted();
  });
}

/// Throws InputError where no specimen fills its box, once in place of once for each test.
template <int dim>
void check_that_one_fills_its_box(const std::vector<Specimen<dim>>& specimens)
{
  std::string refusal;
  for (const Specimen<dim>& specimen : specimens)
    if (refusal = refusal_of([&] { check_fills_its_box(specimen); }); refusal.empty())
      return;
  if (!refusal.empty())
    throw InputError(refusal);
}

/// Specimens, tests and report of a run in its folder, from wherever it stands, by this process.
template <int dim>
RunEnd test_alone(const Run& run, Progress& progress)
{
  const std::filesystem::path& folder = run.folder;
  const std::filesystem::path& input_file = run.input_file;
  const Input& input = run.input;

  // Make the rock.
  const RunPlan plan(input);
  if (ranks::number() == 1) // else tests have been made, and a refusal would take them away
    check_memory_of_tests(plan);
  auto specimens = provide_specimens<dim>(plan, folder, progress);
  if (!input.specimen.specimen_file.empty())
    with_name_of(input_file, [&] { check_specimen_of_file(input, specimens.front().shape); });

  // Break it.
  check_that_one_fills_its_box(specimens);
  const auto tests = run_programme(plan, plan_tests(plan, sizes_of(specimens)), specimens, folder, progress);
  const auto has_nothing = [](const FinishedTest& test) {
    return !test.record.failure.empty() && test.record.curve.empty();
  };
  if (!tests.empty() && std::ranges::all_of(tests, has_nothing))
    throw InputError(tests.front().record.failure);

  // Report.
  const bool was_interrupted = interrupted();
  auto [envelopes, missing] =
    write_and_report(provenance(input, input_file), tests, input.reference_file, folder, progress);
  const auto bodies = mapped<SpecimenReport>(specimens, [](const auto& specimen) { return specimen.report; });
  append(missing, beside_reference_body(input, bodies));
  write_log(folder, describe_run(plan.variants, specimens, tests, envelopes, missing), run.quiet);
  // Pictures are still to be made if the run was interrupted while it drew them.
  return {was_interrupted || interrupted(), failures(tests)};
}
} // namespace

int run_lab(const CommonOptions& options)
{
  return run_shared("lab", check_laboratory_input, {share_out_tests<2>, test_alone<2>},
                    {share_out_tests<3>, test_alone<3>}, options);
}
} // namespace feldspar
