#pragma once

#include "dem/specimen/specimen.h"

#include <array>
#include <string>
#include <string_view>

namespace feldspar
{
/// Form of a file of grains for other programs.
struct PackingForm
{
  std::string_view name;   ///< on the command line
  std::string_view ending; ///< of its files
};

/// yade: lines `x y z radius`; lammps: a data file with atoms of style bpm/sphere and the joints as bonds.
inline constexpr std::array packing_forms{PackingForm{"yade", ".txt"}, PackingForm{"lammps", ".data"}};

/// The grains of a specimen in a form of packing_forms, in metres. Numbers have all their digits, so that read_packing_table()
/// gives the same grains; a joint is a bond while one of its elements holds. In the plane z is 0.
template <int dim>
std::string packing_text(const Specimen<dim>& specimen, std::string_view form);
} // namespace feldspar
