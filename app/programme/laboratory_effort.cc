#include "app/programme/laboratory_effort.h"

#include "app/programme/genesis_effort.h"
#include "app/programme/lab_run.h"
#include "app/screen/expected_length.h"
#include "base/input_error.h"
#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "base/simd.h"
#include "base/text.h"
#include "dem/dynamics/time_step.h"
#include "dem/lab/protocols/protocols.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>

namespace feldspar
{
namespace
{
// The peak of a test of 992 000 discs and of 405 000 spheres (2.2 and 3.5 joints a grain), less program and grains: 385 and 697
// bytes of a joint, rounded up. A disc that was kept without states of its grains, after few rows, took 282 bytes.
constexpr double bytes_of_running_joint(const int dimension) { return dimension == 2 ? 400.0 : 700.0; }

/// Memory of a grain in a state that is kept.
constexpr double bytes_of_state(const int dimension) { return dimension == 2 ? 10.0 : 80.0; }

/// Memory of a grain of a test that has ended.
constexpr double bytes_of_kept_grain(const int dimension, const double n_states)
{
  return (dimension == 2 ? 300.0 : 440.0) + n_states * bytes_of_state(dimension);
}

/// Memory of a grain that a process stores, whoever computes it.
constexpr double bytes_of_held_grain(const int dimension) { return dimension == 2 ? 170.0 : 270.0; }
constexpr double bytes_of_program = 4e7;

/// Processor time of a joint and step, with the cracks of a test past its peak (benchmarks/README.md): 2 and 5 in 1e-8 s by
/// packs of eight numbers (AVX-512), 3.4 in the plane by packs of four (AVX2).
constexpr double seconds_of_joint_and_step(const int dimension)
{
  constexpr double narrower = simd::width<simd::Pack> < 8 ? 1.7 : 1.0;
  return narrower * (dimension == 2 ? 2e-8 : 5e-8);
}

/// Time in which the processes of a shared body wait for each other in a step. Of 308 discs a step took 16 µs by one process, 17 µs by
/// two, and 46 to 57 µs by three on two cores (a Xeon).
constexpr double seconds_of_agreement(const bool are_more_than_processors)
{
  return are_more_than_processors ? 5e-5 : 1e-5;
}

/// Processor time of the pictures of a report: measured on runs of one test to eight, without and with a reference.
double seconds_of_pictures(const std::size_t n_tests)
{
  constexpr std::size_t most_pictured = 20; // of more tests, means over them and not each
  return 1.0 + 0.6 * double(std::min(n_tests, most_pictured));
}

double bytes_of_tests(const int dimension, const double n_tests, const double n_grains, const double n_joints,
                      const double n_states)
{
  const double at_a_time = std::min(n_tests, double(number_of_threads()));
  return at_a_time * n_joints * bytes_of_running_joint(dimension) +
         n_tests * n_grains * bytes_of_kept_grain(dimension, n_states);
}

/// Memory of a body that all processes compute together.
struct BytesOfShared
{
  double each;    ///< of a process
  double reading; ///< of a process, one at a time of those on a machine
  double first;   ///< of the first when it stores results

  double of_machine() const { return ranks::number_on_this_machine() * each + first - each; }
};

BytesOfShared bytes_of_shared(const int dimension, const double n_grains, const double n_joints, const double n_states)
{
  const double of_grains = bytes_of_program + n_grains * bytes_of_held_grain(dimension);
  const double of_joints = n_joints * bytes_of_running_joint(dimension);
  const double each = of_grains + of_joints / ranks::number();
  return {each, of_grains + of_joints, of_grains + of_joints + n_grains * n_states * bytes_of_state(dimension)};
}

/// Memory of the specimens that stay beside their tests; the only test of a specimen takes it.
template <int dim>
double bytes_of_specimens(const std::vector<LaboratoryOrder>& tests, const std::span<const Specimen<dim>> specimens)
{
  std::map<std::size_t, std::size_t> n_tests_of;
  for (const LaboratoryOrder& one : tests)
    ++n_tests_of[one.specimen];
  double sum = 0.0;
  for (const auto& [k, n_tests] : n_tests_of)
    if (n_tests > 1)
      sum += double(specimens[k].grains.size()) * bytes_of_grain(dim);
  return sum;
}

/// "3 tests of some 20000 steps". Throws InputError for endless ones.
std::string steps_in_words(const TestEffort& effort)
{
  constexpr double most_steps = 1e12; // weeks with a hundred joints
  if (effort.n_steps > most_steps)
    throw InputError("Tests: a test would take some {:.0e} steps; a strain rate is far too low", effort.n_steps);
  return fmt::format("{} of some {:.0f} steps",
                     effort.n_tests == 1 ? "1 test" : fmt::format("{} tests", effort.n_tests), effort.n_steps);
}
} // namespace

template <int dim>
TestEffort expected_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                           const std::span<const Specimen<dim>> specimens)
{
  TestEffort effort;
  effort.n_tests = tests.size();
  std::map<std::size_t, double> stiffest; // over inertia, by specimen
  double most_grains = 0.0;
  double most_joints = 0.0;
  double most_states = 0.0;
  for (const LaboratoryOrder& one : tests)
    {
      const Specimen<dim>& specimen = specimens[one.specimen];
      const auto [known, is_new] = stiffest.try_emplace(one.specimen, 0.0);
      if (is_new)
        known->second = largest_stiffness_over_inertia(specimen);
      const double time_step = one.dynamics->time_step_safety / std::sqrt(known->second);
      const double rate = (*protocol_of(one.test.kind).strain_rate)(*one.parameters);
      const double n_steps = expected_last_strain(one.test, variants[one.variant].input) / (rate * time_step);
      effort.n_steps = std::max(effort.n_steps, n_steps);
      effort.n_steps_of_all += n_steps;
      effort.processor_seconds += n_steps * double(specimen.joints.size()) * seconds_of_joint_and_step(dim);
      most_grains = std::max(most_grains, double(specimen.grains.size()));
      most_joints = std::max(most_joints, double(specimen.joints.size()));
      most_states = std::max(most_states, double(one.parameters->snapshots_of(specimen.grains.size())));
    }
  effort.bytes = bytes_of_tests(dim, double(tests.size()), most_grains, most_joints, most_states);
  return effort;
}

template <int dim>
std::string describe_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                            const std::span<const Specimen<dim>> specimens)
{
  const TestEffort effort = expected_effort<dim>(tests, variants, specimens);
  const double bytes = bytes_of_program + bytes_of_specimens<dim>(tests, specimens) + effort.bytes;
  const double seconds = // threads help each other within a test too
    (effort.processor_seconds + seconds_of_pictures(effort.n_tests)) / n_threads_served();
  return fmt::format("{}: about {:.0f} MB with specimens and program, {} with pictures{}", steps_in_words(effort),
                     bytes / 1e6, duration_in_words(seconds), load_in_words(effort.bytes));
}

template <int dim>
std::string describe_shared_effort(const std::vector<LaboratoryOrder>& tests, const std::vector<Variant>& variants,
                                   const std::span<const Specimen<dim>> specimens)
{
  const TestEffort effort = expected_effort<dim>(tests, variants, specimens);
  BytesOfShared most{0.0, 0.0, 0.0}; // of the tests, which are made one after the other
  for (const LaboratoryOrder& one : tests)
    {
      const double n_grains = double(specimens[one.specimen].grains.size());
      const BytesOfShared bytes = bytes_of_shared(dim, n_grains, double(specimens[one.specimen].joints.size()),
                                                  one.parameters->snapshots_of(std::size_t(n_grains)));
      if (bytes.first > most.first)
        most = bytes;
    }
  const double n_here = ranks::number_on_this_machine();
  const double n_processors = std::thread::hardware_concurrency();
  const double n_threads = std::min(double(number_of_threads()), n_processors / n_here);
  const double seconds = effort.processor_seconds / (ranks::number() * n_threads) +
                         effort.n_steps_of_all * seconds_of_agreement(n_here > n_processors) +
                         seconds_of_pictures(effort.n_tests) / n_threads_served();
  return fmt::format("{} by {} processes together: about {:.0f} MB for each, {:.0f} MB while it reads the specimen and "
                     "{:.0f} MB for the first when it stores results; {} with pictures{}",
                     steps_in_words(effort), ranks::number(), most.each / 1e6, most.reading / 1e6, most.first / 1e6,
                     duration_in_words(seconds), load_in_words(most.of_machine()));
}

void check_memory_of_tests(const RunPlan& plan)
{
  double of_genesis = 0.0;
  double largest_specimen = 0.0;
  double of_kept = 0.0; // specimens beside their tests; the only test of one takes it
  double most_grains = 0.0;
  double n_tests = 0.0;
  unsigned int most_states = 0;
  int dimension = 2;
  for (const SpecimenOrder& order : plan.orders)
    {
      const SpecimenParameters& specimen = plan.input_of(order).specimen;
      const GenesisEffort genesis = expected_effort(specimen);
      double n_tests_of_it = 0.0;
      for (const std::size_t v : order.variants)
        {
          const Input& input = plan.variants[v].input;
          n_tests_of_it += double(test_cases(input.test_list, input.confinements).size());
          most_states = std::max(most_states, input.tests.snapshots_of(std::size_t(genesis.n_grains)));
        }
      n_tests += n_tests_of_it;
      of_genesis += genesis.bytes;
      largest_specimen = std::max(largest_specimen, genesis.bytes);
      of_kept += n_tests_of_it > 1.0 ? genesis.bytes : 0.0;
      most_grains = std::max(most_grains, genesis.n_grains);
      dimension = specimen.dimension;
    }
  const double most_joints = (dimension == 2 ? 2.2 : 3.5) * most_grains;
  // Specimens with one test each wait, but for those whose tests run.
  of_kept = std::max(of_kept, of_genesis - number_of_threads() * largest_specimen);
  double bytes =
    std::max(of_genesis, of_kept + bytes_of_tests(dimension, n_tests, most_grains, most_joints, most_states));
  // Specimens of shared tests are made before, and read from their files.
  if (ranks::number() > 1 && makes_tests_together(plan))
    bytes = std::max(largest_specimen, bytes_of_shared(dimension, most_grains, most_joints, most_states).of_machine());
  const auto free = free_memory();
  if (free && bytes > *free)
    throw InputError("Tests: {:.0f} test(s) of {} specimen(s) of some {:.1e} grains need some {:.1f} GB of "
                     "memory, and {:.1f} GB are free; make the specimens smaller, the tests or variants "
                     "fewer, or use fewer threads (--threads)",
                     n_tests, plan.orders.size(), most_grains, bytes / 1e9, *free / 1e9);
}

template decltype(expected_effort<2>) expected_effort<2>;
template decltype(expected_effort<3>) expected_effort<3>;
template decltype(describe_effort<2>) describe_effort<2>;
template decltype(describe_effort<3>) describe_effort<3>;
template decltype(describe_shared_effort<2>) describe_shared_effort<2>;
template decltype(describe_shared_effort<3>) describe_shared_effort<3>;
} // namespace feldspar
