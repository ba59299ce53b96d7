#pragma once

#include "dem/dynamics/parameters.h"
#include "dem/specimen/specimen.h"
#include "laboratory/parameters.h"
#include "laboratory/test_outcome.h"
#include "results/runs/run.h"
#include "runs/checkpoints.h"
#include "runs/observer.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Laboratory tests on specimens of grains.
namespace feldspar
{
template <int dim>
class LabTest;

/// A test that is to be made.
struct LaboratoryOrder
{
  TestCase test;
  const TestParameters* parameters; ///< outlives the run
  const DynamicsParameters* dynamics;
  std::size_t specimen = 0; ///< number among the specimens of the run
  std::size_t variant = 0;  ///< number among the variants of the run
  std::string group = {};   ///< as FinishedTest has it, as the following
  std::string name = {};
  std::string label = {}; ///< of the variant
  std::vector<VariantSetting> settings = {};
  std::string identity = {}; ///< of its checkpoints: program, input and test
  std::uint64_t steps_between_checkpoints = 20000;
};

/// The numbers of the tests in the order in which they are begun: the longest first, so that none is left alone at the end.
std::vector<std::size_t> longest_first(const std::vector<LaboratoryOrder>& orders);

/// Brings a test to its next row and tells the observer; `check` may throw Interrupted. Returns false where its numbers went
/// wrong. Throws Interrupted out of a seating, which is begun anew.
template <int dim>
bool advance(LabTest<dim>& test, const std::function<void()>& check, std::size_t part, RunObserver& observer);

/// Runs a test from where its checkpoint stands to its end, or to where the observer wants the end. `specimen` gives the
/// specimen, once for each checkpoint that is tried and once for the start. Throws Interrupted where there is nothing to
/// keep, and InputError where the test cannot be made.
template <int dim>
TestOutcome run_test(const LaboratoryOrder& order, const std::function<Specimen<dim>()>& specimen,
                     const Checkpoints& checkpoints, std::size_t part, RunObserver& observer);

/// Runs tests on the specimens, as many at a time as there are threads, longest first. Each leaves its last two checkpoints
/// in `folder`/checkpoints, by which a later call takes it up; a test that has ended is not run again. A test that cannot be
/// made is in the results with its reason. Where the observer wanted the end, tests that had not begun are not. The last test
/// of a specimen takes its grains and joints, which needs half of the memory of a copy; the rest of it stays. `again`: the
/// specimen of a number once more, for a test whose checkpoint cannot be used.
template <int dim>
std::vector<FinishedTest> run_tests(const std::vector<LaboratoryOrder>& orders, std::vector<Specimen<dim>>& specimens,
                                    const std::function<Specimen<dim>(std::size_t)>& again,
                                    const std::filesystem::path& folder, RunObserver& observer);
} // namespace feldspar
