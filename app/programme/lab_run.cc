#include "app/programme/lab_run.h"

#include "app/programme/checks.h"
#include "app/programme/genesis_effort.h"
#include "app/programme/laboratory_effort.h"
#include "app/programme/run_board.h"
#include "app/run/run_record.h"
#include "app/screen/expected_length.h"
#include "base/byte_archive.h"
#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_file.h"
#include "runs/share_out.h"
#include "runs/shared_tests.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
LaboratoryOrder laboratory_order(const TestCase& test, const Input& input, const std::string& name)
{
  return {.test = test,
          .parameters = &input.tests,
          .dynamics = &input.dynamics,
          .name = name,
          .identity = run_identity(input, name),
          .steps_between_checkpoints = input.steps_between_checkpoints};
}

std::vector<LaboratoryOrder> plan_tests(const RunPlan& plan, const std::vector<SpecimenSize>& specimens)
{
  std::vector<LaboratoryOrder> planned;
  for (const auto& [v, s] : plan.parts())
    {
      const Variant& variant = plan.variants[v];
      const std::uint64_t seed = specimens[s].n_grains > 0 ? specimens[s].seed : plan.orders[s].seed;
      for (const TestCase& test : test_cases(variant.input.test_list, variant.input.confinements))
        {
          const std::string& own = variant.name_in_files;
          const std::string group = own.empty() ? name(test) : fmt::format("{}_{}", name(test), own);
          LaboratoryOrder& order =
            planned.emplace_back(laboratory_order(test, variant.input, fmt::format("{}_seed_{}", group, seed)));
          order.specimen = s;
          order.variant = v;
          order.group = group;
          order.label = variant.label;
          order.settings = variant.settings;
        }
    }
  return planned;
}

namespace
{
std::vector<BoardPart> parts_of(const RunPlan& plan, const std::vector<LaboratoryOrder>& tests,
                                const std::vector<SpecimenSize>& specimens)
{
  std::vector<BoardPart> parts;
  for (const LaboratoryOrder& one : tests)
    {
      const Input& input = plan.variants[one.variant].input;
      const double rate = (*protocol_of(one.test.kind).strain_rate)(input.tests);
      parts.push_back(
        {one.name, 1.0, BoardTest{one.test, &input, cost_of_specimen(specimens[one.specimen].n_grains, rate)}});
    }
  return parts;
}

/// Reads the specimen of a number from the folder.
template <int dim>
std::function<Specimen<dim>(std::size_t)> specimens_in(const RunPlan& plan, const std::filesystem::path& folder)
{
  return [&](const std::size_t k) { return read_specimen<dim>(folder / (plan.orders[k].name + ".h5")); };
}

bool has_clumps(const Input& input)
{
  return input.clumps.diameter || input.minerals.form_of_rock() == MineralGrainForm::rigid;
}
} // namespace

bool makes_tests_together(const RunPlan& plan)
{
  constexpr double large = 1e5; // grains
  const Input& first = plan.variants.front().input;
  if (first.shared_body == SharedBody::never)
    return false;
  for (const Variant& variant : plan.variants)
    if (has_clumps(variant.input))
      {
        if (first.shared_body == SharedBody::always)
          throw InputError(
            "Tests/Shared body = always: clumps cannot be computed by several processes together yet; set "
            "by size or never");
        return false;
      }
  return first.shared_body == SharedBody::always || std::ranges::any_of(plan.orders, [&](const SpecimenOrder& order) {
           return expected_effort(plan.input_of(order).specimen).n_grains >= large;
         });
}

template <int dim>
void run_together(const RunPlan& plan, const std::filesystem::path& folder, Progress& progress)
{
  std::vector<SpecimenSize> sizes;
  std::string effort;
  together_or_interrupted([&] {
    if (!ranks::is_first())
      return;
    const auto specimens = provide_specimens<dim>(plan, folder, progress);
    sizes = sizes_of(specimens);
    effort = describe_shared_effort<dim>(plan_tests(plan, sizes), plan.variants, specimens);
  });
  progress.remark(effort);
  sizes = values_of<SpecimenSize>(ranks::of_first(bytes_of(sizes)));
  const auto tests = plan_tests(plan, sizes);
  RunBoard board(progress, "tests", parts_of(plan, tests, sizes));
  const std::size_t n_made = run_shared_tests<dim>(tests, specimens_in<dim>(plan, folder), folder, board);
  progress.finish(fmt::format("{} of {} by {} processes together", n_made, tests.size(), ranks::number()));
}

template <int dim>
std::vector<FinishedTest> run_programme(const RunPlan& plan, const std::vector<LaboratoryOrder>& tests,
                                        std::vector<Specimen<dim>>& specimens, const std::filesystem::path& folder,
                                        Progress& progress, const bool tells_failures)
{
  for (const std::string& sentence : entries_without_effect(plan.variants))
    progress.remark(sentence);
  if (ranks::number() == 1 || !makes_tests_together(plan)) // else they have been made
    progress.remark(describe_effort<dim>(tests, plan.variants, specimens));
  RunBoard board(progress, "tests", parts_of(plan, tests, sizes_of(specimens)), tells_failures);
  auto finished_tests = run_tests<dim>(tests, specimens, specimens_in<dim>(plan, folder), folder, board);
  const auto n_made = std::ranges::count_if(finished_tests, &FinishedTest::was_made);
  const auto n_failed =
    std::ranges::count_if(finished_tests, [](const FinishedTest& test) { return !test.record.failure.empty(); });
  progress.finish(
    fmt::format("{} of {} done{}", n_made, tests.size(), n_failed > 0 ? fmt::format(", {} failed", n_failed) : ""));
  return finished_tests;
}

template decltype(run_together<2>) run_together<2>;
template decltype(run_together<3>) run_together<3>;
template decltype(run_programme<2>) run_programme<2>;
template decltype(run_programme<3>) run_programme<3>;
} // namespace feldspar
