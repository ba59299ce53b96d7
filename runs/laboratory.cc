#include "runs/laboratory.h"

#include "base/input_error.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "runs/jobs.h"
#include "runs/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
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

/// Gives specimens to their tests: copies, and to the last test the grains and joints themselves.
template <int dim>
class SpecimensOfTests
{
public:
  SpecimensOfTests(const std::vector<LaboratoryOrder>& orders, std::vector<Specimen<dim>>& all,
                   const std::function<Specimen<dim>(std::size_t)>& read_again)
    : specimens(all)
    , again(read_again)
    , n_tests_left(all.size(), 0)
  {
    for (const LaboratoryOrder& order : orders)
      ++n_tests_left[order.specimen];
  }

  Specimen<dim> give(const std::size_t k, const bool for_the_first_time)
  {
    const std::lock_guard lock(one_at_a_time);
    if (!for_the_first_time)
      return again(k);
    Specimen<dim>& specimen = specimens[k];
    if (--n_tests_left[k] > 0)
      return specimen;
    Grains<dim> grains = std::exchange(specimen.grains, {});
    Joints<dim> joints = std::exchange(specimen.joints, {});
    Specimen<dim> taken = specimen;
    taken.grains = std::move(grains);
    taken.joints = std::move(joints);
    return taken;
  }

private:
  std::vector<Specimen<dim>>& specimens;
  const std::function<Specimen<dim>(std::size_t)>& again;
  std::vector<std::size_t> n_tests_left;
  std::mutex one_at_a_time;
};
} // namespace

std::vector<std::size_t> longest_first(const std::vector<LaboratoryOrder>& orders)
{
  const auto length = [&](const std::size_t k) {
    return std::pair(orders[k].test.kind.duration_rank, orders[k].test.confining_pressure);
  };
  std::vector<std::size_t> sorted(orders.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t(0));
  std::ranges::stable_sort(sorted, [&](const auto a, const auto b) { return length(a) > length(b); });
  return sorted;
}

template <int dim>
bool advance(LabTest<dim>& test, const std::function<void()>& check, const std::size_t part, RunObserver& observer)
{
  try
    {
      test.advance(check);
    }
  catch (const Interrupted&)
    {
      if (!test.is_seated())
        throw;
    }
  if (test.went_wrong())
    return false;
  const CurveSample& row = test.curve().back();
  observer.advanced(part, {&row, 0.0, fmt::format(", {} cracks", row.n_tension_cracks + row.n_shear_cracks)});
  return true;
}

template <int dim>
TestOutcome run_test(const LaboratoryOrder& order, const std::function<Specimen<dim>()>& specimen,
                     const Checkpoints& checkpoints, const std::size_t part, RunObserver& observer)
{
  const auto begin = [&] {
    return LabTest<dim>({protocol_of(order.test.kind), order.test.confining_pressure}, specimen(), *order.parameters,
                        *order.dynamics);
  };
  LabTest<dim> test = checkpoints.open(begin, [&](const std::string& sentence) { observer.goes_back(sentence); });
  lead(test, checkpoints, observer, order.steps_between_checkpoints, [&](const auto& /*keep_if_due*/) {
    return advance(
      test, [&] { observer.end_if_wanted(); }, part, observer);
  });
  const bool interrupted = !test.has_ended();
  return std::move(test).finish(interrupted);
}

template <int dim>
std::vector<FinishedTest> run_tests(const std::vector<LaboratoryOrder>& orders, std::vector<Specimen<dim>>& specimens,
                                    const std::function<Specimen<dim>(std::size_t)>& again,
                                    const std::filesystem::path& folder, RunObserver& observer)
{
  const std::filesystem::path checkpoint_folder = folder / "checkpoints";
  std::filesystem::create_directories(checkpoint_folder);
  const auto sorted = longest_first(orders);
  SpecimensOfTests<dim> of_tests(orders, specimens, again);
  std::vector<std::optional<FinishedTest>> slots(orders.size());
  for_each_job(orders.size(), [&](const std::size_t position) {
    const std::size_t k = sorted[position];
    const LaboratoryOrder& order = orders[k];
    if (observer.wants_end())
      return;
    TestOutcome outcome;
    try
      {
        const Checkpoints checkpoints(checkpoint_folder, order.name, order.identity);
        const auto specimen = [&, is_first = true]() mutable {
          return of_tests.give(order.specimen, std::exchange(is_first, false));
        };
        outcome = run_test<dim>(order, specimen, checkpoints, k, observer);
      }
    catch (const Interrupted&)
      {
        return;
      }
    catch (const InputError& error) // one test that cannot be made must not cost the others
      {
        outcome = failure(order, specimens[order.specimen], error.what());
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

template decltype(advance<2>) advance<2>;
template decltype(advance<3>) advance<3>;
template decltype(run_test<2>) run_test<2>;
template decltype(run_test<3>) run_test<3>;
template decltype(run_tests<2>) run_tests<2>;
template decltype(run_tests<3>) run_tests<3>;
} // namespace feldspar
