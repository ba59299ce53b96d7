#pragma once

#include "coupling/network/stiffness_bounds.h"
#include "coupling/rve/path_run.h"
#include "results/evaluation.h"
#include "results/runs/run.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace feldspar
{
/// An RVE that has gone its path.
template <int dim>
struct FinishedRve
{
  std::string name;                     ///< of its curve: rve, rve_seed_3
  std::string variant;                  ///< Section/Entry = value; empty where there are none
  std::vector<VariantSetting> settings; ///< of the variant, entry by entry
  std::uint64_t seed = 0;
  SpecimenReport specimen;
  std::shared_ptr<const Network<dim>> network; ///< shared with the run that it was made for
  StiffnessBounds<dim> bounds;
  PathRecord<dim> record;
  NetworkState<dim> state; ///< at the end
  double wall_time = 0.0;  ///< of the path [s]
};

/// Writes curves/NAME.csv for each RVE, cracks.csv and summary.json into a run's folder.
template <int dim>
void write_results(const Provenance& provenance, const std::vector<FinishedRve<dim>>& rves,
                   const std::filesystem::path& folder);

/// Text for a terminal: the homogenised constants and how the path went.
template <int dim>
std::string describe(const FinishedRve<dim>& rve);
} // namespace feldspar
