#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
/// A specimen of a run.
struct SpecimenOrder
{
  std::vector<std::size_t> variants; ///< numbers of those that test it, among the run's
  std::uint64_t seed;
  std::string name; ///< of its file without ending: specimen, specimen_seed_3, specimen_friction_0.5_seed_3
};

/// The variants of an input and their specimens, one for each rock and seed: variants that differ in the tests alone share
/// theirs.
struct RunPlan
{
  explicit RunPlan(const Input& input);

  /// The input of a specimen.
  const Input& input_of(const SpecimenOrder& order) const { return variants[order.variants.front()].input; }

  /// The variants and the specimens that they test, by their numbers.
  std::vector<std::pair<std::size_t, std::size_t>> parts() const;

  std::vector<Variant> variants;
  std::vector<SpecimenOrder> orders;
};

/// Provides the specimens with these numbers, several at a time, and writes each into the folder; one that is there already, from
/// a run that was broken off, is read. The others are empty. Throws InputError, and Interrupted.
template <int dim>
std::vector<Specimen<dim>> provide_specimens(const RunPlan& plan, const std::set<std::size_t>& numbers,
                                             const std::filesystem::path& folder, Progress& progress);

/// The same of all.
template <int dim>
std::vector<Specimen<dim>> provide_specimens(const RunPlan& plan, const std::filesystem::path& folder,
                                             Progress& progress)
{
  std::set<std::size_t> all;
  for (std::size_t k = 0; k < plan.orders.size(); ++k)
    all.insert(k);
  return provide_specimens<dim>(plan, all, folder, progress);
}

/// Each process provides its share of them in the folder. Collective; else as provide_specimens().
template <int dim>
void share_out_specimens(const RunPlan& plan, const std::filesystem::path& folder, Progress& progress);

/// Provides those that parts of the run have for their `specimen`.
template <int dim, typename Part>
std::vector<Specimen<dim>> provide_specimens_of(const std::vector<Part>& parts, const RunPlan& plan,
                                                const std::filesystem::path& folder, Progress& progress)
{
  std::set<std::size_t> numbers;
  for (const Part& part : parts)
    numbers.insert(part.specimen);
  return provide_specimens<dim>(plan, numbers, folder, progress);
}

/// For a terminal: what genesis has to report.
std::string describe(const SpecimenReport& report);

/// Text for a terminal: the flaws that were put in, one line each kind; empty for intact rock.
template <int dim>
std::string describe(const std::vector<Flaw<dim>>& flaws);
} // namespace feldspar
