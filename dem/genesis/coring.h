#pragma once

#include "dem/specimen/specimen.h"

#include <array>

/// Specimens without the voids and the missing joints that walls leave beside them: packed as a periodic cell, joined
/// everywhere, then cut free; docs/theory.md §3.
namespace feldspar
{
/// Joins equal cells side by side to one periodic cell, with the grains, joints and strengths of the single one. Its
/// report is that of the single cell except for the numbers of grains and joints and the resolution.
template <int dim>
Specimen<dim> repeated(const Specimen<dim>& cell, const std::array<unsigned int, dim>& n_cells);

/// Cuts a periodic cell at the faces of its box (one with walled ends at the sides only), and in space at the largest
/// upright cylinder in it for the shape of a cylinder. Grains stay whole and belong to the body where their centres do; joints that lead
/// out of it are cut. Groups of grains that lose their last joint to the body are removed. The report has the
/// coordination number, porosity and overlaps of what is left, and the installation gap of the cell.
template <int dim>
Specimen<dim> cored(Specimen<dim> cell, BodyShape shape);
} // namespace feldspar
