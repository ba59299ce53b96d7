#include "runs/laboratory.h"

#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "runs/jobs.h"
#include "runs/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
/// Outcome of a test that could not be made.
template <int dim>
TestOutcome failure(const LaboratoryOrder& order, const Specimen<dim>& specimen, const std::string& why)
{
  TestOutcome outcome;
  TestRecord& record = outcome.record;
  record.kind = order.test.kind;
  record.confining_pressure = order.test.confining_pressure;
  record.seed = specimen.seed;
  const auto& body_size = protocol_of(record.kind).body_size<dim>();
  record.size = in_space<dim>(body_size ? (*body_size)(specimen, *order.parameters) : specimen.size);
  record.specimen = specimen.report;
  record.bulk_density = specimen.bulk_density;
  record.interrupted = true;
  record.failure = why;
  return outcome;
}
} // namespace

std::vector<std::size_t> longest_first(const std::vector<LaboratoryOrder>& orders)
{
  const auto length = [&](const std::size_t k) {
    return std::pair(orders[k].test.kind.duration_rank, orders[k].test.confining_pressure);
  };
  std::vector<std::size_t> sorted(orders.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t(0));
  std::stable_sort(sorted.begin(), sorted.end(), [&](const auto a, const auto b) { return length(a) > length(b); });
  return sorted;
}

template <int dim>
TestOutcome run_test(const LaboratoryOrder& order, const Specimen<dim>& specimen, const Checkpoints& checkpoints,
                     const std::size_t part, RunObserver& observer)
{
  LabTest<dim> test = checkpoints.open([&] {
    return LabTest<dim>({protocol_of(order.test.kind), order.test.confining_pressure}, specimen, *order.parameters,
                        *order.dynamics);
  });
  lead(test, checkpoints, observer, order.steps_between_checkpoints, [&](const auto& /*keep_if_due*/) {
    try
      {
        test.advance([&] { observer.end_if_wanted(); });
      }
    catch (const Interrupted&)
      {
        if (!test.is_seated())
          throw; // a seating is begun anew
      }
    if (test.went_wrong())
      return false;
    const CurveSample& row = test.curve().back();
    observer.advanced(part, {&row, 0.0, fmt::format(", {} cracks", row.n_tension_cracks + row.n_shear_cracks)});
    return true;
  });
  return test.finish(!test.has_ended());
}

template <int dim>
std::vector<FinishedTest> run_tests(const std::vector<LaboratoryOrder>& orders,
                                    const std::vector<Specimen<dim>>& specimens, const std::filesystem::path& folder,
                                    RunObserver& observer)
{
  const std::filesystem::path checkpoint_folder = folder / "checkpoints";
  std::filesystem::create_directories(checkpoint_folder);
  const auto sorted = longest_first(orders);
  std::vector<std::optional<FinishedTest>> slots(orders.size());
  for_each_job(orders.size(), [&](const std::size_t position) {
    const std::size_t k = sorted[position];
    const LaboratoryOrder& order = orders[k];
    const Specimen<dim>& specimen = specimens[order.specimen];
    if (observer.wants_end())
      return;
    TestOutcome outcome;
    try
      {
        outcome = run_test(order, specimen, Checkpoints(checkpoint_folder, order.name, order.identity), k, observer);
      }
    catch (const Interrupted&)
      {
        return;
      }
    catch (const InputError& error) // one test that cannot be made must not cost the others
      {
        outcome = failure(order, specimen, error.what());
        observer.cannot_be_made(k, error.what());
      }
    observer.ended(k);
    slots[k] = finished(std::move(outcome), order.group, order.name, order.label, order.settings);
  });
  std::vector<FinishedTest> tests;
  for (auto& slot : slots)
    if (slot)
      tests.push_back(std::move(*slot));
  return tests;
}

template TestOutcome run_test<2>(const LaboratoryOrder&, const Specimen<2>&, const Checkpoints&, std::size_t,
                                 RunObserver&);
template TestOutcome run_test<3>(const LaboratoryOrder&, const Specimen<3>&, const Checkpoints&, std::size_t,
                                 RunObserver&);
template std::vector<FinishedTest> run_tests<2>(const std::vector<LaboratoryOrder>&, const std::vector<Specimen<2>>&,
                                                const std::filesystem::path&, RunObserver&);
template std::vector<FinishedTest> run_tests<3>(const std::vector<LaboratoryOrder>&, const std::vector<Specimen<3>>&,
                                                const std::filesystem::path&, RunObserver&);
} // namespace feldspar
