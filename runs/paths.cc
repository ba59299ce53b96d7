#include "runs/paths.h"

#include "base/parallel.h"
#include "runs/checkpoints.h"
#include "runs/jobs.h"
#include "runs/part.h"

#include <fmt/format.h>

#include <chrono>
#include <concepts>

namespace feldspar
{
namespace
{
template <int dim>
std::string describe(const PathSample<dim>& sample)
{
  std::string stresses;
  for (const double component : sample.stress)
    stresses += fmt::format("{}{:.2f}", stresses.empty() ? "" : ", ", component / 1e6);
  return fmt::format("stress {} MPa, {} cracks", stresses, sample.n_tension_cracks + sample.n_shear_cracks);
}

template <int dim>
FinishedRve<dim> run_path(const PathOrder<dim>& order, const Specimen<dim>& specimen,
                          const std::filesystem::path& checkpoint_folder, const std::size_t part, RunObserver& observer)
{
  using Clock = std::chrono::steady_clock;
  const auto started = Clock::now();
  // Shared: the run and its result refer to it.
  const auto network = std::make_shared<const Network<dim>>(specimen, order.turn, order.boundary);
  const auto start = order.start ? order.start(*network) : std::nullopt;
  const auto bounds = stiffness_bounds(specimen, order.turn);
  const Checkpoints checkpoints(checkpoint_folder, order.name, order.identity);
  const auto go = [&](const auto& begin) -> FinishedRve<dim> {
    auto run = checkpoints.open(begin, [&](const std::string& sentence) { observer.goes_back(sentence); });
    lead(run, checkpoints, observer, 0, [&](const auto& /*keep_if_due*/) {
      if constexpr (std::same_as<decltype(run), PathRun<dim>>)
        try
          {
            run.advance([&] { return observer.wants_end(); });
          }
        catch (const GivenUp&) // a resumed run repeats the increment
          {
          }
      else
        run.advance();
      observer.advanced(part, {nullptr, run.progress(), describe(run.record().samples.back())});
      return true;
    });
    return {order.name,      order.label,
            order.settings,  specimen.seed,
            specimen.report, network,
            bounds,          run.record(),
            run.state(),     std::chrono::duration<double>(Clock::now() - started).count()};
  };
  if (const auto* const explicitly = std::get_if<ExplicitParameters>(&order.solver))
    return go([&] { return ExplicitRun<dim>(specimen, network, order.legs, *explicitly); });
  return go([&] { return PathRun<dim>(network, order.legs, std::get<PathParameters>(order.solver), start); });
}
} // namespace

template <int dim>
std::vector<FinishedRve<dim>> run_paths(const std::vector<PathOrder<dim>>& orders,
                                        const std::vector<Specimen<dim>>& specimens,
                                        const std::filesystem::path& folder, RunObserver& observer)
{
  std::filesystem::create_directories(folder / "checkpoints");
  std::vector<FinishedRve<dim>> rves(orders.size());
  for_each_job(orders.size(), [&](const std::size_t k) {
    rves[k] = run_path(orders[k], specimens[orders[k].specimen], folder / "checkpoints", k, observer);
    observer.ended(k);
  });
  return rves;
}

template decltype(run_paths<2>) run_paths<2>;
template decltype(run_paths<3>) run_paths<3>;
} // namespace feldspar
