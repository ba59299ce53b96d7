#include "runs/shared_tests.h"

#include "base/input_error.h"
#include "base/ranks/ranks.h"
#include "base/whole_file.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "runs/part.h"
#include "runs/process_partners.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>

namespace feldspar
{
namespace
{
/// The checkpoints of a shared test, which the first process writes.
struct SharedCheckpoints
{
  const Checkpoints& files;
  bool& uneven; ///< the body is to be divided anew; all processes then resume from the checkpoint

  template <int dim>
  void write(LabTest<dim>& test) const
  {
    constexpr double tolerated = 1.1; // for less all would hardly read the body again
    ranks::first([&] { files.set_newest_aside(); });
    ranks::together([&] { files.write_newest(test); });
    uneven = test.unevenness() > tolerated;
  }
};

/// The end of a test that was led.
enum class End
{
  interrupted,
  failed,
  made
};

template <int dim>
End run_shared_test(const LaboratoryOrder& order, const std::function<Specimen<dim>(std::size_t)>& specimen,
                    const std::filesystem::path& folder, const std::size_t part, RunObserver& observer)
{
  const Checkpoints checkpoints(folder, order.name, order.identity);
  ProcessesAsPartners partners;
  const auto begin = [&] {
    LabTest<dim> test({protocol_of(order.test.kind), order.test.confining_pressure}, specimen(order.specimen),
                      *order.parameters, *order.dynamics);
    test.share(partners);
    return test;
  };
  const auto tell = [&](const std::string& sentence) {
    if (ranks::is_first()) // all find the same
      observer.goes_back(sentence);
  };
  std::optional<LabTest<dim>> kept;
  bool uneven = false;
  const auto resume = [&] {
    kept.reset();
    uneven = false;
    ranks::in_turn([&] { kept.emplace(checkpoints.open(begin, tell)); });
    const std::string state = fmt::format("{} {}", kept->n_steps(), kept->has_ended());
    if (ranks::any(state != ranks::of_first(state)))
      throw OutputError(fmt::format("{}: not all processes could read its newest checkpoint", order.name));
    if (!kept->has_ended())
      kept->meet();
  };
  resume();
  LabTest<dim>& test = *kept; // also after it was resumed once more
  std::uint64_t n_asked = 0;
  const auto end_if_one_wants = [&] {
    constexpr std::uint64_t steps_between = 50;
    if (++n_asked % steps_between == 0 && ranks::any(observer.wants_end()))
      throw Interrupted();
  };
  lead(
    test, SharedCheckpoints{checkpoints, uneven}, observer, order.steps_between_checkpoints,
    [&](const auto& /*keep_if_due*/) {
      if (uneven)
        resume();
      return advance(test, end_if_one_wants, part, observer);
    },
    ranks::any);
  return test.went_wrong() ? End::failed : test.has_ended() ? End::made : End::interrupted;
}
} // namespace

template <int dim>
std::size_t run_shared_tests(const std::vector<LaboratoryOrder>& orders,
                             const std::function<Specimen<dim>(std::size_t)>& specimen,
                             const std::filesystem::path& folder, RunObserver& observer)
{
  const std::filesystem::path checkpoint_folder = folder / "checkpoints";
  ranks::first([&] { std::filesystem::create_directories(checkpoint_folder); });
  std::size_t n_made = 0;
  for (const std::size_t k : longest_first(orders))
    {
      if (ranks::any(observer.wants_end()))
        throw Interrupted();
      End end = End::failed;
      try
        {
          end = run_shared_test<dim>(orders[k], specimen, checkpoint_folder, k, observer);
        }
      catch (const InputError&) // the same on all: run_tests() meets it again, and reports it
        {
        }
      if (end == End::interrupted)
        throw Interrupted();
      n_made += end == End::made ? 1 : 0;
      observer.ended(k);
    }
  return n_made;
}

template decltype(run_shared_tests<2>) run_shared_tests<2>;
template decltype(run_shared_tests<3>) run_shared_tests<3>;
} // namespace feldspar
