#include "dem/genesis/packing_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace feldspar
{
namespace
{
/// Position and, in the plane, a z of 0.
template <int dim>
std::array<double, 3> place_of(const Specimen<dim>& specimen, const std::size_t grain)
{
  return in_space<dim>(at<dim>(specimen.grains.position, grain));
}

template <int dim>
std::string lammps_data(const Specimen<dim>& specimen)
{
  const auto& grains = specimen.grains;
  const auto& joints = specimen.joints;
  std::string bonds;
  std::size_t n_bonds = 0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.holds(j))
      fmt::format_to(std::back_inserter(bonds), "{} 1 {} {}\n", ++n_bonds, joints.grain_1[j] + 1,
                     joints.grain_2[j] + 1);
  std::string text =
    fmt::format("LAMMPS data file: a packing of Feldspar, in metres\n\n{} atoms\n{} bonds\n1 atom types\n"
                "1 bond types\n\n",
                grains.size(), n_bonds);
  const double largest_radius = *std::ranges::max_element(grains.radius);
  for (int c = 0; c < 3; ++c)
    fmt::format_to(std::back_inserter(text), "{0} {1} {2}lo {2}hi\n", c < dim ? 0.0 : -largest_radius,
                   c < dim ? specimen.size[c] : largest_radius, "xyz"[c]);
  text += "\nAtoms # bpm/sphere\n\n"; // number, molecule, type, diameter, density, place
  for (std::size_t i = 0; i < grains.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{} 1 1 {} {} {}\n", i + 1, 2.0 * grains.radius[i],
                   grains.mass[i] / grain_volume<dim>(grains.radius[i], specimen.thickness),
                   fmt::join(place_of(specimen, i), " "));
  return text + (n_bonds > 0 ? "\nBonds\n\n" + bonds : "");
}
} // namespace

template <int dim>
std::string packing_text(const Specimen<dim>& specimen, const std::string_view form)
{
  if (form == "lammps")
    return lammps_data(specimen);
  std::string text = "#format x_y_z_r\n";
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{}\t{}\n", fmt::join(place_of(specimen, i), "\t"),
                   specimen.grains.radius[i]);
  return text;
}

template std::string packing_text<2>(const Specimen<2>&, std::string_view);
template std::string packing_text<3>(const Specimen<3>&, std::string_view);
} // namespace feldspar
