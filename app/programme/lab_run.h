#pragma once

#include "app/input/input.h"
#include "app/programme/specimen_source.h"
#include "app/run/checkpoints.h"
#include "app/screen/progress.h"
#include "dem/specimen/specimen.h"
#include "laboratory/test_outcome.h"
#include "results/runs/run.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace feldspar
{
/// Runs a test from where its checkpoint stands to its end or to Ctrl-C; `show` sees every row of its curve. Throws
/// Interrupted where there is nothing to keep, and InputError where it cannot be made.
template <int dim>
TestOutcome run_test(const TestCase& wanted, const Input& input, const Specimen<dim>& specimen,
                     const Checkpoints& checkpoints, const std::function<void(const CurveSample&)>& show);

/// The share of one process in a programme that several carry out: of the tests, longest first, each `number`-th.
struct Share
{
  std::size_t number = 1;
  std::size_t mine = 0;

  bool is_all() const { return number == 1; }
  bool has(const std::size_t position) const { return position % number == mine; }
};

/// Numbers of the specimens that the tests of a share are made on.
std::vector<std::size_t> specimens_of(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                      const Share& share);

/// Runs the whole programme of an input on its specimens, as many tests at a time as there are threads, longest first.
/// Each leaves its last two checkpoints in `folder`/checkpoints, by which a later call takes it up; a test that
/// has ended is not run again. After Ctrl-C comes what is there. Results stand in the order of variants, seeds, tests.
/// With a share, only its tests are run, and only its specimens need be there.
template <int dim>
std::vector<FinishedTest> run_programme(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                        const std::vector<Specimen<dim>>& specimens,
                                        const std::filesystem::path& folder, Progress& progress,
                                        const Share& share = {});
} // namespace feldspar
