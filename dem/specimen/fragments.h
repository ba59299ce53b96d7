#pragma once

#include "dem/specimen/disjoint_sets.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <vector>

namespace feldspar
{
enum class Faces
{
  bonded, ///< with at least one bonded segment
  all
};

/// Grains connected by such faces, of smooth joints too, and by rigid groups.
template <int dim>
DisjointSets connected_grains(const Specimen<dim>& specimen, Faces faces);

/// The number of the fragment each grain belongs to; [n_grains]. Grains are connected by joints with at least one
/// bonded segment; the largest fragment is 0, equal ones are ordered by their first grain.
template <int dim>
std::vector<std::uint32_t> fragments(const Joints<dim>& joints, std::size_t n_grains);

/// The same of grains that are connected otherwise.
std::vector<std::uint32_t> fragments(DisjointSets sets, std::size_t n_grains);

/// The fragments of a specimen, whose smooth joints hold as well.
template <int dim>
std::vector<std::uint32_t> fragments(const Specimen<dim>& specimen);

/// Marks the grains that belong to none of the larger fragments; [n_grains].
template <int dim>
std::vector<bool> loose_grains(const Specimen<dim>& specimen);
} // namespace feldspar
