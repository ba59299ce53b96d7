#include "runs/shared_tests.h"

#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "runs/part.h"
#include "runs/process_partners.h"

#include <cstdint>
#include <optional>

namespace feldspar
{
namespace
{
/// The checkpoints of a shared test, which the first process writes. Where cracks have gathered the body is divided anew: all
/// take up the test from the checkpoint.
struct SharedCheckpoints
{
  const Checkpoints& files;
  const std::function<void()>& take_up;

  template <int dim>
  void write(LabTest<dim>& test) const
  {
    constexpr double tolerated = 1.1;
    test.collect();
    ranks::first([&] { files.write(test); });
    if (ranks::any(ranks::is_first() && !test.has_ended() && test.unevenness() > tolerated))
      take_up();
    else
      test.drop();
  }
};

template <int dim>
void run_shared_test(const LaboratoryOrder& order, const std::function<Specimen<dim>(std::size_t)>& specimen,
                     const std::filesystem::path& folder, const std::size_t part, RunObserver& observer)
{
  const Checkpoints checkpoints(folder, order.name, order.identity);
  const auto begin = [&] {
    return LabTest<dim>({protocol_of(order.test.kind), order.test.confining_pressure}, specimen(order.specimen),
                        *order.parameters, *order.dynamics);
  };
  ProcessesAsPartners partners;
  std::optional<LabTest<dim>> kept;
  const std::function<void()> take_up = [&] {
    kept.reset();
    ranks::in_turn([&] {
      kept.emplace(checkpoints.open(begin, observer));
      if (!kept->has_ended())
        kept->share(partners);
    });
    if (!kept->has_ended())
      kept->meet();
  };
  take_up();
  LabTest<dim>& test = *kept; // also once it is taken up anew
  if (test.has_ended())
    return;
  std::uint64_t n_asked = 0;
  const auto end_if_one_wants = [&] {
    constexpr std::uint64_t steps_between = 50;
    if (++n_asked % steps_between == 0 && ranks::any(observer.wants_end()))
      throw Interrupted();
  };
  lead(
    test, SharedCheckpoints{checkpoints, take_up}, observer, order.steps_between_checkpoints,
    [&](const auto& /*keep_if_due*/) { return advance(test, end_if_one_wants, part, observer); }, ranks::any);
}
} // namespace

template <int dim>
void run_shared_tests(const std::vector<LaboratoryOrder>& orders,
                      const std::function<Specimen<dim>(std::size_t)>& specimen, const std::filesystem::path& folder,
                      RunObserver& observer)
{
  const std::filesystem::path checkpoint_folder = folder / "checkpoints";
  ranks::first([&] { std::filesystem::create_directories(checkpoint_folder); });
  for (const std::size_t k : longest_first(orders))
    {
      if (ranks::any(observer.wants_end()))
        throw Interrupted();
      try
        {
          run_shared_test<dim>(orders[k], specimen, checkpoint_folder, k, observer);
        }
      catch (const InputError&) // the same on all: run_tests() meets it again, and reports it
        {
        }
      observer.ended(k);
    }
}

template decltype(run_shared_tests<2>) run_shared_tests<2>;
template decltype(run_shared_tests<3>) run_shared_tests<3>;
} // namespace feldspar
