#pragma once

#include "coupling/rve/homogenisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace feldspar
{
/// The end of an increment. Tension positive, Voigt components with engineering shear.
template <int dim>
struct PathSample
{
  std::array<double, n_voigt<dim>> strain{};
  std::array<double, n_voigt<dim>> stress{}; ///< [Pa]
  std::uint64_t n_tension_cracks = 0;
  std::uint64_t n_shear_cracks = 0;
  NetworkWork work;
  double stored_energy = 0.0; ///< [J]
  double unbalanced_ratio = 0.0;
  double hill_mandel_residual = 0.0;
  double boundary_stress_error = 0.0;
  double crack_density = 0.0;

  /// Boundary work less all it went into [J].
  double unaccounted() const { return work.boundary - stored_energy - work.slip - work.released - work.settled; }
  /// The sum of the sizes of these terms [J].
  double turnover() const;
  /// |unaccounted| over the turnover.
  double energy_imbalance() const;
};

/// The place of a column of a path in summary.json.
enum class InSummary
{
  nowhere,
  count_at_end,
  at_end,
  largest ///< over the path
};

/// A column of the curve of a path, after its strains and stresses.
template <int dim>
struct PathColumn
{
  std::string_view name; ///< ends in its SI unit
  double (*value)(const PathSample<dim>& row);
  InSummary in_summary;
  std::string_view meaning;
};

template <int dim>
inline constexpr PathColumn<dim> path_columns[] = {
  {"n_tension_cracks", [](const auto& row) { return double(row.n_tension_cracks); }, InSummary::count_at_end,
   "segments broken in tension"},
  {"n_shear_cracks", [](const auto& row) { return double(row.n_shear_cracks); }, InSummary::count_at_end,
   "segments broken in shear"},
  {"boundary_work_J", [](const auto& row) { return row.work.boundary; }, InSummary::at_end,
   "of the stress on the strain of the cell"},
  {"strain_energy_J", [](const auto& row) { return row.stored_energy; }, InSummary::at_end,
   "stored in joints and contacts"},
  {"slip_energy_J", [](const auto& row) { return row.work.slip; }, InSummary::at_end, "dissipated by friction"},
  {"released_energy_J", [](const auto& row) { return row.work.released; }, InSummary::at_end,
   "by bonds that break or soften"},
  {"settling_energy_J", [](const auto& row) { return row.work.settled; }, InSummary::at_end,
   "dissipated on the way to equilibrium after breaks"},
  {"energy_imbalance", [](const auto& row) { return row.energy_imbalance(); }, InSummary::largest,
   "energy unaccounted for, over the sum of the sizes of all terms"},
  {"unbalanced_force_ratio", [](const auto& row) { return row.unbalanced_ratio; }, InSummary::largest,
   "largest unbalanced over mean contact force"},
  {"hill_mandel_residual", [](const auto& row) { return row.hill_mandel_residual; }, InSummary::largest,
   "of the increment: work of the homogenised stress less that of the contacts, over the size of both"},
  {"boundary_stress_error", [](const auto& row) { return row.boundary_stress_error; }, InSummary::largest,
   "magnitude of boundary stress - stress, over that of the stress"},
  {"crack_density_per_m", [](const auto& row) { return row.crack_density; }, InSummary::nowhere,
   "area of broken segments over volume"}};

/// Returns whether all numbers of a row are finite.
template <int dim>
bool is_finite(const PathSample<dim>& row)
{
  const auto all = [](const auto& numbers) {
    return std::ranges::all_of(numbers, [](const double one) { return std::isfinite(one); });
  };
  return all(row.strain) && all(row.stress) &&
         std::all_of(std::begin(path_columns<dim>), std::end(path_columns<dim>),
                     [&](const PathColumn<dim>& column) { return std::isfinite(column.value(row)); });
}
} // namespace feldspar
