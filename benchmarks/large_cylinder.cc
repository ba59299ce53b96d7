#include "benchmarks/committed_version.h"
#include "dem/genesis/coring.h"
#include "dem/genesis/genesis.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <sys/resource.h>

#include <cstdint>
#include <ctime>
#include <stdexcept>
#include <string>

namespace
{
using namespace feldspar;

constexpr unsigned int n_steps = 300;
constexpr unsigned int n_first_steps = 50; // not timed: contacts are looked for, pages come to be

struct Enough : std::exception
{
};

double processor_time() { return double(std::clock()) / CLOCKS_PER_SEC; }

long peak_memory_kB()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// Time of one step of work that calls check() at each step [s]; the work is left after n_steps.
template <typename Work>
double seconds_of_a_step(const Work& work)
{
  unsigned int n = 0;
  double start = 0.0;
  double end = 0.0;
  try
    {
      work([&] {
        if (n == n_first_steps)
          start = processor_time();
        if (n++ == n_steps)
          {
            end = processor_time();
            throw Enough();
          }
      });
    }
  catch (const Enough&)
    {
    }
  if (end == 0.0)
    throw std::runtime_error("the phase ended before its steps were made");
  return (end - start) / (n_steps - n_first_steps);
}
} // namespace

/// Some 200 000 spheres for 300 steps of each phase on one thread: the static packing of a cylinder of 79.5 mm × 159 mm,
/// then tension and compression of one cut out of a periodic packing that is set side by side. Writes
/// benchmarks/results/large-cylinder.json to the screen; minutes and a few gigabytes.
int main()
{
  const std::string version_of_results = committed_version();
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  constexpr unsigned int n_across = 3;
  SpecimenParameters wanted;
  wanted.dimension = 3;
  wanted.porosity = 0.37;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;

  wanted.shape = BodyShape::cylinder;
  wanted.width = n_across * 0.0265;
  wanted.height = 2.0 * wanted.width;
  const double packing_step =
    seconds_of_a_step([&](const auto& check) { make_specimen<3>(wanted, joint, {}, 1, check); });
  const long memory_of_packing = peak_memory_kB();

  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = 0.0265;
  const auto specimen = cored<3>(
    repeated<3>(make_specimen<3>(wanted, joint, {}, 1), {n_across, n_across, 2 * n_across}), BodyShape::cylinder);
  std::string tests;
  for (const LaboratoryCase& test : {LaboratoryCase{direct_tension}, LaboratoryCase{uniaxial_compression},
                                     LaboratoryCase{triaxial_compression, 10e6}})
    {
      LabTest<3> running(test, specimen, TestParameters{}, DynamicsParameters{});
      const double step = seconds_of_a_step([&](const auto& check) {
        while (running.advance(check))
          ;
      });
      tests +=
        fmt::format("{}  {{\"kind\": \"{}\", \"step_s\": {:.4g}, \"step_per_joint_s\": {:.3g}}}",
                    tests.empty() ? "" : ",\n", test.protocol.kind.name, step, step / double(specimen.joints.size()));
    }
  fmt::print("{{\"feldspar_version\": \"{}\", \"n_grains\": {}, \"n_joints\": {}, \"packing_iteration_s\": {:.4g}, "
             "\"packing_peak_memory_kB\": {}, \"peak_memory_kB\": {}, \"tests\": [\n{}\n]}}\n",
             version_of_results, specimen.grains.size(), specimen.joints.size(), packing_step, memory_of_packing,
             peak_memory_kB(), tests);
}
