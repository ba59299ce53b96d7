#include "app/input/strain_path.h"

#include "base/csv.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace feldspar
{
namespace
{
template <int dim>
constexpr double engineering(const int k)
{
  return k < dim ? 1.0 : 2.0; // γ = 2ε
}

/// -p on the normal components, 0 on those of shear.
template <int dim>
Voigt<dim> pressure(const double p)
{
  Voigt<dim> stress = Voigt<dim>::Zero();
  stress.template head<dim>().setConstant(-p);
  return stress;
}

template <int dim>
std::vector<PathLeg<dim>> legs_along_direction(const StrainPathParameters& path)
{
  std::vector<PathLeg<dim>> legs;
  Control<dim> confinement;
  confinement.stress_given.fill(true);
  confinement.stress = pressure<dim>(path.confining_pressure);
  if (path.confining_pressure > 0.0)
    legs.push_back({confinement, false});
  Control<dim> straining = confinement;
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (path.direction[k])
      {
        straining.stress_given[k] = false;
        straining.strain[k] = engineering<dim>(k) * path.size * *path.direction[k];
      }
  legs.push_back({straining, true});
  return legs;
}

/// Returns which columns are stresses. Each component has one column, in the order of Voigt.
template <int dim>
std::array<bool, n_voigt<dim>> stress_columns(const std::string& file, const std::vector<std::string_view>& columns)
{
  std::string strains, names;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      strains += fmt::format("{}strain_{}", k > 0 ? "," : "", voigt_name<dim>(k));
      names += fmt::format("{}{}", k > 0 ? ", " : "", voigt_name<dim>(k));
    }
  std::array<bool, n_voigt<dim>> is_stress{};
  bool good = columns.size() == std::size_t(n_voigt<dim>);
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto count = [&](const std::string& name) { return std::count(columns.begin(), columns.end(), name); };
      const std::string strain_column = "strain_" + voigt_name<dim>(k);
      const std::string stress_column = "stress_" + voigt_name<dim>(k) + "_Pa";
      if (count(strain_column) > 0 && count(stress_column) > 0)
        throw InputError(fmt::format("{}:1: {} and {} are both given; a component has its strain or its stress given",
                                     file, strain_column, stress_column));
      if (good)
        is_stress[k] = columns[k] == stress_column;
      good = good && (is_stress[k] || columns[k] == strain_column);
    }
  if (!good)
    throw InputError(fmt::format("{}:1: the header is {}; it must be \"{}\", or stress_.._Pa in place of strain_.. "
                                 "for some of {}",
                                 file, in_quotes(fmt::format("{}", fmt::join(columns, ","))), strains, names));
  return is_stress;
}

template <int dim>
std::vector<PathLeg<dim>> legs_from_file(const std::string& file)
{
  CsvReader table(file);
  Control<dim> control;
  control.stress_given = stress_columns<dim>(file, table.header());
  std::vector<PathLeg<dim>> legs;
  while (table.next())
    {
      for (int k = 0; k < n_voigt<dim>; ++k)
        {
          const double value = table.number(std::size_t(k));
          if (!control.stress_given[k] && std::abs(value) > largest_strain)
            throw InputError(fmt::format("{}: point {}: strain_{} = {}: must lie in [-{}, {}]", file, legs.size() + 1,
                                         voigt_name<dim>(k), value, largest_strain, largest_strain));
          (control.stress_given[k] ? control.stress[k] : control.strain[k]) =
            control.stress_given[k] ? value : engineering<dim>(k) * value;
        }
      legs.push_back({control, false});
    }
  if (legs.empty())
    throw InputError(fmt::format("{}: there is no row below the header", file));
  return legs;
}
} // namespace

void check(const StrainPathParameters& path)
{
  if (path.path_file.empty() && path.direction.empty())
    throw InputError("Strain path/File: is missing; name a CSV file of strains, or a Direction");
  if (!path.path_file.empty() && !path.direction.empty())
    throw InputError("Strain path/Direction: excludes File, which is given too; keep one of them");
  if (!path.path_file.empty() && path.confining_pressure > 0.0)
    throw InputError("Strain path/Confining pressure: goes with a Direction; in a File give the stresses");
  if (path.cell_angle != 0.0 && path.solver == PathSolver::explicit_dynamics)
    throw InputError(
      "Strain path/Cell angle: needs Solver = event by event; explicit dynamics have a cell along the axes");
  if (constexpr double most_increments = 1e7; path.size / path.largest_step > most_increments)
    throw InputError(fmt::format("Strain path/Largest step = {:g}: Size = {:g} would be more than {:g} increments",
                                 path.largest_step, path.size, most_increments));
  for (const auto& component : path.direction)
    if (component && std::abs(path.size * *component) > largest_strain)
      throw InputError(fmt::format("Strain path/Size: times {:g} of Direction is a strain of {:g}; a cell "
                                   "takes strains of at most {:g}",
                                   *component, path.size * *component, largest_strain));
}

template <int dim>
std::vector<PathLeg<dim>> path_legs(const StrainPathParameters& path)
{
  return path.path_file.empty() ? legs_along_direction<dim>(path) : legs_from_file<dim>(path.path_file);
}

template std::vector<PathLeg<2>> path_legs<2>(const StrainPathParameters&);
template std::vector<PathLeg<3>> path_legs<3>(const StrainPathParameters&);
} // namespace feldspar
