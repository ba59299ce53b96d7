#pragma once

#include "app/input/input.h"
#include "app/screen/progress.h"
#include "dem/specimen/specimen.h"

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

/// One for each rock and seed: variants that differ in the tests alone share theirs.
std::vector<SpecimenOrder> specimen_orders(const std::vector<Variant>& variants);

/// Provides the specimens, several at a time, and writes each into the folder; one that is there already, from a run
/// that was broken off, is read. Throws InputError, and Interrupted.
template <int dim>
std::vector<Specimen<dim>> provide_specimens(const std::vector<Variant>& variants,
                                             const std::vector<SpecimenOrder>& orders,
                                             const std::filesystem::path& folder, Progress& progress);

/// Each process provides its share of them in the folder. Collective; else as provide_specimens().
template <int dim>
void share_out_specimens(const std::vector<Variant>& variants, const std::vector<SpecimenOrder>& orders,
                         const std::filesystem::path& folder, Progress& progress);

/// Provides those that parts of the run have for their `specimen`; the others are empty.
template <int dim, typename Part>
std::vector<Specimen<dim>> provide_specimens_of(const std::vector<Part>& parts, const std::vector<Variant>& variants,
                                                const std::vector<SpecimenOrder>& orders,
                                                const std::filesystem::path& folder, Progress& progress)
{
  std::set<std::size_t> numbers;
  for (const Part& part : parts)
    numbers.insert(part.specimen);
  std::vector<Specimen<dim>> specimens(orders.size());
  if (numbers.empty())
    return specimens;
  std::vector<SpecimenOrder> needed;
  for (const std::size_t k : numbers)
    needed.push_back(orders[k]);
  auto provided = provide_specimens<dim>(variants, needed, folder, progress);
  for (auto one = provided.begin(); const std::size_t k : numbers)
    specimens[k] = std::move(*one++);
  return specimens;
}

/// For a terminal: what genesis has to report.
std::string describe(const SpecimenReport& report);

/// Text for a terminal: the flaws that were put in, one line each kind; empty for intact rock.
template <int dim>
std::string describe(const std::vector<Flaw<dim>>& flaws);
} // namespace feldspar
