#include "benchmarks/committed_version.h"
#include "coupling/sample/grain_material.h"
#include "dem/genesis/genesis.h"

#include <fmt/format.h>

#include <ctime>
#include <memory>
#include <string>

/// Cost of a representative volume of some 240 discs of Table 1 to its rank, step by step as it cracks: twelve packings,
/// pulled and pressed with their sides free. An iteration is stress and tangent with bonds frozen, a relaxation the breaks
/// of the step. In processor time of one core. Writes benchmarks/results/rve-costs.json, for rank_queue.py, to the
/// screen; some minutes.
namespace feldspar
{
namespace
{
double processor_time()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

std::shared_ptr<const Network<2>> network(const std::uint64_t seed)
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = 0.025;
  wanted.packed_by_descent = false; // as in the results that are committed
  FlatJointParameters joint;
  joint.coordination_number = 4.2;
  return std::make_shared<const Network<2>>(make_specimen<2>(wanted, joint, {}, seed));
}

/// The time of the calls of one kind in a step.
struct Calls
{
  double seconds = 0.0;
  int n = 0;

  template <typename Call>
  void time(const Call& call)
  {
    const double begin = processor_time();
    call();
    seconds += processor_time() - begin;
    ++n;
  }
  double mean() const { return seconds / n; }
};

/// Rows of one RVE: strain, seconds of an iteration and of a relaxation, broken segments.
std::string path(const std::shared_ptr<const Network<2>>& of, const double step, const double end)
{
  RepresentativeVolume<2> free_to_widen(of); // says which strain there is
  GrainPoint<2> point(of, Tensor<2>::Identity(), {});
  Control<2> control;
  control.stress_given = {true, false, true};
  Voigt<2> before = Voigt<2>::Zero();
  std::string rows;
  for (int k = 1; k * std::abs(step) <= end * (1.0 + 1e-9); ++k)
    {
      control.strain[1] = k * step;
      Trial<2> found = free_to_widen.trial(control);
      if (!found.in_equilibrium)
        break;
      const Voigt<2> strain = found.state.strain;
      free_to_widen.accept(std::move(found));

      Calls iterations, relaxations;
      try
        {
          // Trials approach the strain as Newton's method does.
          for (const double share : {0.9, 1.0})
            iterations.time([&] { point.trial(before + share * (strain - before)); });
          std::size_t n_events = 1;
          while (n_events > 0)
            {
              relaxations.time([&] { n_events = point.relax(strain); });
              if (n_events > 0)
                iterations.time([&] { point.trial(strain); });
            }
          relaxations.time([&] { point.accept(strain); });
          relaxations.n -= 1; // it is part of the last
        }
      catch (const fem::PointFailure&)
        {
          break;
        }
      const auto& state = point.rve().state();
      rows += fmt::format("{}[{:.4g}, {:.3g}, {:.3g}, {}]", rows.empty() ? "" : ", ", strain[1], iterations.mean(),
                          relaxations.mean(), state.n_tension_breaks + state.n_shear_breaks);
      before = strain;
    }
  return rows;
}
} // namespace
} // namespace feldspar

int main()
{
  using namespace feldspar;
  const std::string version_of_results = committed_version();
  std::string rves;
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    {
      const auto of = network(seed);
      for (const bool pulled : {true, false})
        rves += fmt::format("{}  {{\"seed\": {}, \"n_grains\": {}, \"n_segments\": {}, \"test\": \"{}\", \"rows\": "
                            "[{}]}}",
                            rves.empty() ? "" : ",\n", seed, of->n_grains(), of->n_segments(),
                            pulled ? "tension" : "compression", pulled ? path(of, 1e-5, 3e-4) : path(of, -1e-4, 4e-3));
    }
  fmt::print("{{\"feldspar_version\": \"{}\", \"columns\": [\"strain\", \"iteration_s\", \"relaxation_s\", "
             "\"broken_segments\"], \"volumes\": [\n{}\n]}}\n",
             version_of_results, rves);
}
