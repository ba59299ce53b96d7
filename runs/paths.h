#pragma once

#include "coupling/network/network.h"
#include "coupling/rve/explicit_run.h"
#include "coupling/rve/path_run.h"
#include "dem/minerals/mixture_bounds.h"
#include "dem/specimen/specimen.h"
#include "results/variant_setting.h"
#include "runs/observer.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// Representative volumes along paths of strain or stress.
namespace feldspar
{
/// A path that is to be gone.
template <int dim>
struct PathOrder
{
  std::size_t specimen;                 ///< number among the cells of the run
  std::string name;                     ///< of its curve: rve, rve_seed_3
  std::string label;                    ///< Section/Entry = value of its variant; empty where there are none
  std::vector<VariantSetting> settings; ///< of the variant, entry by entry
  std::string identity;                 ///< of its checkpoints: program, input and path
  Tensor<dim> turn;                     ///< of the cell before its path begins
  Boundary boundary;
  std::vector<PathLeg<dim>> legs;
  std::variant<PathParameters, ExplicitParameters> solver;
  /// The state in which the path begins; empty, or none: at rest.
  std::function<std::optional<NetworkState<dim>>(const Network<dim>&)> start = {};
};

/// An RVE that has gone its path.
template <int dim>
struct FinishedRve
{
  std::string name; ///< as PathOrder has it, as the following
  std::string variant;
  std::vector<VariantSetting> settings;
  std::uint64_t seed = 0;
  SpecimenReport specimen;
  std::shared_ptr<const Network<dim>> network; ///< shared with the run that it was made for
  StiffnessBounds<dim> bounds;
  PathRecord<dim> record;
  NetworkState<dim> state;                   ///< at the end
  double wall_time = 0.0;                    ///< of the path [s]
  std::optional<MixtureBounds> mixture = {}; ///< of a rock of minerals, filled in by who made it
};

/// Runs paths, as many at a time as there are threads, each from where its checkpoint in `folder`/checkpoints stands to its
/// end, or to where the observer wants the end.
template <int dim>
std::vector<FinishedRve<dim>> run_paths(const std::vector<PathOrder<dim>>& orders,
                                        const std::vector<Specimen<dim>>& specimens,
                                        const std::filesystem::path& folder, RunObserver& observer);
} // namespace feldspar
