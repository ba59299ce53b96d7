#pragma once

#include "app/input/input.h"
#include "app/programme/specimen_source.h"
#include "app/screen/progress.h"
#include "base/mapped.h"
#include "runs/laboratory.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// A test of an input, which must outlive it.
LaboratoryOrder laboratory_order(const TestCase& test, const Input& input, const std::string& name);

/// Seed and size of a specimen, by which its tests are planned.
struct SpecimenSize
{
  std::uint64_t seed;
  std::size_t n_grains; ///< 0: it is not there yet
};

template <int dim>
std::vector<SpecimenSize> sizes_of(const std::vector<Specimen<dim>>& specimens)
{
  return mapped<SpecimenSize>(specimens, [](const Specimen<dim>& specimen) {
    return SpecimenSize{specimen.seed, specimen.grains.size()};
  });
}

/// The tests of a run, by variants, seeds and tests. Seeds are those of the specimens that exist already, for one out of a file
/// brings its own, else of the orders.
std::vector<LaboratoryOrder> plan_tests(const RunPlan& plan, const std::vector<SpecimenSize>& specimens);

/// Returns whether all processes of a run make its tests together.
bool makes_tests_together(const RunPlan& plan);

/// Leads all tests on the specimens in the folder as run_shared_tests() does, and shows it.
template <int dim>
void run_together(const RunPlan& plan, const std::filesystem::path& folder, Progress& progress);

/// Runs tests as run_tests() does, which takes the grains of the specimens, and shows it. `tells_failures`: whether a test
/// that cannot be made is said at once.
template <int dim>
std::vector<FinishedTest> run_programme(const RunPlan& plan, const std::vector<LaboratoryOrder>& tests,
                                        std::vector<Specimen<dim>>& specimens, const std::filesystem::path& folder,
                                        Progress& progress, bool tells_failures = true);
} // namespace feldspar
