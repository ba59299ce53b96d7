#include "app/programme/lab_run.h"

#include "app/programme/laboratory_effort.h"
#include "app/run/interrupt.h"
#include "app/run/jobs.h"
#include "app/run/run_record.h"
#include "app/screen/expected_length.h"
#include "app/screen/progress_board.h"
#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace feldspar
{
namespace
{
/// One test of the programme.
template <int dim>
struct PlannedTest
{
  TestCase test;
  const Variant* variant;
  const Specimen<dim>* specimen;
  std::size_t order; ///< number of the specimen
  std::string group;
  std::string name;
  std::string identity; ///< of its checkpoints: program, input and test
};

/// A specimen out of a file keeps its own.
template <int dim>
std::uint64_t seed_of(const SpecimenOrder& order, const Specimen<dim>& specimen)
{
  return specimen.grains.size() > 0 ? specimen.seed : order.seed;
}

template <int dim>
std::vector<PlannedTest<dim>> plan(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                   const std::vector<Specimen<dim>>& specimens)
{
  std::vector<PlannedTest<dim>> planned;
  const auto add_tests = [&](const std::size_t v, const std::size_t s) {
    const Variant& variant = variants[v];
    for (const TestCase& test : test_cases(variant.input.test_list, variant.input.confinements))
      {
        const std::string& own = variant.name_in_files;
        const std::string group = own.empty() ? name(test) : fmt::format("{}_{}", name(test), own);
        const std::string full_name = fmt::format("{}_seed_{}", group, seed_of(orders[s], specimens[s]));
        planned.push_back({test, &variant, &specimens[s], s, group, full_name, run_identity(variant.input, full_name)});
      }
  };
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (std::size_t s = 0; s < orders.size(); ++s)
      if (std::count(orders[s].variants.begin(), orders[s].variants.end(), v) > 0)
        add_tests(v, s);
  return planned;
}

/// The order in which the tests are begun: the longest first, so that none is left alone at the end.
template <int dim>
std::vector<std::size_t> longest_first(const std::vector<PlannedTest<dim>>& planned)
{
  const auto length = [&](const std::size_t k) {
    const TestCase& test = planned[k].test;
    return std::pair(test.kind.duration_rank, test.confining_pressure);
  };
  std::vector<std::size_t> order(planned.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](const auto a, const auto b) { return length(a) > length(b); });
  return order;
}

template <int dim>
std::vector<PlannedTest<dim>> of_share(std::vector<PlannedTest<dim>> planned, const Share& share)
{
  if (share.is_all())
    return planned;
  const auto order = longest_first(planned);
  std::vector<PlannedTest<dim>> own;
  for (std::size_t position = 0; position < order.size(); ++position)
    if (share.has(position))
      own.push_back(std::move(planned[order[position]]));
  return own;
}

template <int dim>
std::vector<BoardTest> for_board(const std::vector<PlannedTest<dim>>& planned)
{
  std::vector<BoardTest> shown;
  for (const auto& one : planned)
    shown.push_back({one.name, one.test, &one.variant->input,
                     cost_of_specimen(one.specimen->grains.size(),
                                      (*protocol_of(one.test.kind).strain_rate)(one.variant->input.tests))});
  return shown;
}

template <int dim>
std::vector<TestOrder<dim>> orders_of(const std::vector<PlannedTest<dim>>& planned)
{
  std::vector<TestOrder<dim>> orders;
  for (const auto& one : planned)
    orders.push_back({&one.test, &one.variant->input, one.specimen});
  return orders;
}

/// Outcome of a test that could not be run.
template <int dim>
TestOutcome failure(const PlannedTest<dim>& planned, const std::string& why)
{
  TestOutcome outcome;
  TestRecord& record = outcome.record;
  record.kind = planned.test.kind;
  record.confining_pressure = planned.test.confining_pressure;
  record.seed = planned.specimen->seed;
  const auto& body_size = protocol_of(record.kind).body_size<dim>();
  record.size =
    in_space<dim>(body_size ? (*body_size)(*planned.specimen, planned.variant->input.tests) : planned.specimen->size);
  record.specimen = planned.specimen->report;
  record.bulk_density = planned.specimen->bulk_density;
  record.interrupted = true;
  record.failure = why;
  return outcome;
}

} // namespace

template <int dim>
TestOutcome run_test(const TestCase& wanted, const Input& input, const Specimen<dim>& specimen,
                     const Checkpoints& checkpoints, const std::function<void(const CurveSample&)>& show)
{
  LabTest<dim> test = checkpoints.open([&] {
    return LabTest<dim>({protocol_of(wanted.kind), wanted.confining_pressure}, specimen, input.tests, input.dynamics);
  });
  CheckpointClock clock;
  const std::uint64_t interval = input.steps_between_checkpoints;
  std::uint64_t next_checkpoint = test.n_steps() + interval;
  while (!test.has_ended() && !interrupted())
    {
      try
        {
          test.advance(end_if_interrupted);
        }
      catch (const Interrupted&)
        {
          if (!test.is_seated())
            throw; // a seating is begun anew
        }
      if (test.went_wrong())
        break;
      show(test.curve().back());
      if (test.has_ended() || test.n_steps() >= next_checkpoint || clock.is_due() || interrupted())
        {
          clock.time([&] { checkpoints.write(test); });
          next_checkpoint = test.n_steps() + interval;
        }
    }
  return test.finish(!test.has_ended());
}

std::vector<std::size_t> specimens_of(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                      const Share& share)
{
  const std::vector<Specimen<2>> unknown(orders.size()); // of any dimension: nothing is known of them yet
  std::set<std::size_t> numbers;
  for (const auto& one : of_share(plan(variants, orders, unknown), share))
    numbers.insert(one.order);
  return {numbers.begin(), numbers.end()};
}

template <int dim>
std::vector<FinishedTest> run_programme(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                        const std::vector<Specimen<dim>>& specimens,
                                        const std::filesystem::path& folder, Progress& progress, const Share& share)
{
  const auto planned = of_share(plan(variants, orders, specimens), share);
  const auto order = longest_first(planned);
  const std::filesystem::path checkpoint_folder = folder / "checkpoints";
  std::filesystem::create_directories(checkpoint_folder);

  progress.remark(describe_effort(orders_of(planned)));
  ProgressBoard board(progress, for_board(planned));
  std::vector<std::optional<FinishedTest>> slots(planned.size());
  for_each_job(planned.size(), [&](const std::size_t position) {
    const std::size_t k = order[position];
    if (interrupted())
      return;
    TestOutcome outcome;
    try
      {
        outcome =
          run_test(planned[k].test, planned[k].variant->input, *planned[k].specimen,
                   Checkpoints(checkpoint_folder, planned[k].name, planned[k].identity), [&](const CurveSample& row) {
                     board.update(k, row, fmt::format(", {} cracks", row.n_tension_cracks + row.n_shear_cracks));
                   });
      }
    catch (const Interrupted&)
      {
        return;
      }
    catch (const InputError& error)
      {
        // One test that cannot be made must not cost the others.
        outcome = failure(planned[k], error.what());
        if (planned.size() > 1 && share.is_all()) // else the run ends with it, or the first process comes upon it again
          board.say(fmt::format("{} cannot be made: {}", planned[k].name, error.what()));
      }
    board.finish(k);
    slots[k] = finished(std::move(outcome), planned[k].group, planned[k].name, planned[k].variant->label,
                        planned[k].variant->settings);
  });

  std::vector<FinishedTest> tests;
  for (auto& slot : slots)
    if (slot)
      tests.push_back(std::move(*slot));
  const auto n_made =
    std::count_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return test.was_made(); });
  const auto n_failed =
    std::count_if(tests.begin(), tests.end(), [](const FinishedTest& test) { return !test.record.failure.empty(); });
  progress.finish(
    fmt::format("{} of {} done{}", n_made, planned.size(), n_failed > 0 ? fmt::format(", {} failed", n_failed) : ""));
  return tests;
}

template TestOutcome run_test<2>(const TestCase&, const Input&, const Specimen<2>&, const Checkpoints&,
                                 const std::function<void(const CurveSample&)>&);
template TestOutcome run_test<3>(const TestCase&, const Input&, const Specimen<3>&, const Checkpoints&,
                                 const std::function<void(const CurveSample&)>&);
template std::vector<FinishedTest> run_programme<2>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                    const std::vector<Specimen<2>>&, const std::filesystem::path&,
                                                    Progress&, const Share&);
template std::vector<FinishedTest> run_programme<3>(const std::vector<Variant>&, const std::vector<SpecimenOrder>&,
                                                    const std::vector<Specimen<3>>&, const std::filesystem::path&,
                                                    Progress&, const Share&);
} // namespace feldspar
