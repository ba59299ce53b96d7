#include "app/input/strain_path.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/csv.h"

#include <fmt/format.h>

#include <cmath>

namespace feldspar
{
namespace
{
template <int dim>
std::vector<PathLeg<dim>> legs_along_direction(const StrainPathParameters& path)
{
  std::vector<PathLeg<dim>> legs;
  Control<dim> confinement;
  confinement.stress_given.fill(true);
  confinement.stress.template head<dim>().setConstant(-path.confining_pressure); // the normal components
  if (path.confining_pressure > 0.0)
    legs.push_back({confinement, false});
  Control<dim> straining = confinement;
  for (int k = 0; k < n_voigt<dim>; ++k)
    if (path.direction[k])
      {
        straining.stress_given[k] = false;
        straining.strain[k] = engineering_factor<dim>(k) * path.size * *path.direction[k];
      }
  legs.push_back({straining, true});
  return legs;
}

/// The column of a component, and whether it is a stress.
struct PathColumn
{
  std::size_t place = 0;
  bool is_stress = false;
};

/// The columns of the components, in the order of Voigt.
template <int dim>
std::array<PathColumn, n_voigt<dim>> path_columns(CsvReader& table, const std::string& file)
{
  std::string strains, names;
  std::array<PathColumn, n_voigt<dim>> columns;
  bool good = table.header().size() == std::size_t(n_voigt<dim>);
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const std::string strain_column = "strain_" + voigt_name<dim>(k);
      const std::string stress_column = "stress_" + voigt_name<dim>(k) + "_Pa";
      strains += fmt::format("{}{}", k > 0 ? "," : "", strain_column);
      names += fmt::format("{}{}", k > 0 ? ", " : "", voigt_name<dim>(k));
      const auto strain = table.find_in_si(strain_column);
      const auto stress = table.find_in_si(stress_column);
      if (strain && stress)
        throw InputError("{}:{}: {} and {} are both given; a component has its strain or its stress given", file,
                         table.line_of_header(), strain_column, stress_column);
      good = good && (strain || stress);
      columns[k] = {strain ? *strain : stress.value_or(0), stress.has_value()};
    }
  if (!good)
    throw InputError("{}:{}: the header is {}; it must be \"{}\", or stress_.._Pa in place of strain_.. "
                     "for some of {}, or units as in \"stress_{} [MPa]\"",
                     file, table.line_of_header(), in_quotes(fmt::format("{}", fmt::join(table.header(), ","))),
                     strains, names, voigt_name<dim>(0));
  return columns;
}

template <int dim>
std::vector<PathLeg<dim>> legs_from_file(const std::string& file)
{
  CsvReader table(file);
  Control<dim> control;
  const auto columns = path_columns<dim>(table, file);
  for (int k = 0; k < n_voigt<dim>; ++k)
    control.stress_given[k] = columns[k].is_stress;
  std::vector<PathLeg<dim>> legs;
  while (table.next())
    {
      for (int k = 0; k < n_voigt<dim>; ++k)
        {
          const double value = table.number(columns[k].place);
          if (!control.stress_given[k] && std::abs(value) > largest_strain)
            throw InputError("{}: point {}: strain_{} = {}: must lie in [-{}, {}]", file, legs.size() + 1,
                             voigt_name<dim>(k), value, largest_strain, largest_strain);
          (control.stress_given[k] ? control.stress[k] : control.strain[k]) =
            control.stress_given[k] ? value : engineering_factor<dim>(k) * value;
        }
      legs.push_back({control, false});
    }
  if (legs.empty())
    throw InputError("{}: there is no row below the header", file);
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
    throw InputError("Strain path/Largest step = {:g}: Size = {:g} would be more than {:g} increments",
                     path.largest_step, path.size, most_increments);
  for (const auto& component : path.direction)
    if (component && std::abs(path.size * *component) > largest_strain)
      throw InputError("Strain path/Size: times {:g} of Direction is a strain of {:g}; a cell "
                       "takes strains of at most {:g}",
                       *component, path.size * *component, largest_strain);
}

template <int dim>
std::vector<PathLeg<dim>> path_legs(const StrainPathParameters& path)
{
  return path.path_file.empty() ? legs_along_direction<dim>(path) : legs_from_file<dim>(path.path_file);
}

template std::vector<PathLeg<2>> path_legs<2>(const StrainPathParameters&);
template std::vector<PathLeg<3>> path_legs<3>(const StrainPathParameters&);
} // namespace feldspar
