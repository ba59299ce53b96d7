#pragma once

#include "results/runs/run.h"
#include "runs/paths.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Writes curves/NAME.csv for each RVE, cracks.csv and summary.json into a run's folder.
template <int dim>
void write_results(const Provenance& provenance, const std::vector<FinishedRve<dim>>& rves,
                   const std::filesystem::path& folder);

/// Text for a terminal: the homogenised constants and how the path went.
template <int dim>
std::string describe(const FinishedRve<dim>& rve);
} // namespace feldspar
