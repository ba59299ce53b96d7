#pragma once

#include "app/input/input.h"
#include "app/programme/specimen_source.h"
#include "app/screen/progress.h"
#include "runs/laboratory.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// A test of an input, which must outlive it.
LaboratoryOrder laboratory_order(const TestCase& test, const Input& input, const std::string& name);

/// The tests of a run, by variants, seeds and tests. `seeds`: of the specimens; one out of a file brings its own.
std::vector<LaboratoryOrder> plan_tests(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                                        const std::vector<std::uint64_t>& seeds);

/// Seeds of the specimens that exist already, else of the orders.
template <int dim>
std::vector<std::uint64_t> seeds_of(const std::vector<SpecimenOrder>& orders,
                                    const std::vector<Specimen<dim>>& specimens)
{
  std::vector<std::uint64_t> seeds;
  for (std::size_t k = 0; k < orders.size(); ++k)
    seeds.push_back(specimens[k].grains.size() > 0 ? specimens[k].seed : orders[k].seed);
  return seeds;
}

/// Runs tests as run_tests() does, which takes the grains of the specimens, and shows it. `tells_failures`: whether a test
/// that cannot be made is said at once.
template <int dim>
std::vector<FinishedTest> run_programme(const std::vector<Variant>& variants, const std::vector<LaboratoryOrder>& tests,
                                        std::vector<Specimen<dim>>& specimens, const std::filesystem::path& folder,
                                        Progress& progress, bool tells_failures = true);
} // namespace feldspar
