#pragma once

#include "dem/minerals/parameters.h"
#include "dem/specimen/specimen.h"

#include <optional>

/// The grain-based model (Potyondy 2010): a rock of polygonal mineral grains over a finer packing; docs/theory.md §3.2.
namespace feldspar
{
struct MineralGrainParameters
{
  std::optional<double> mean_size; ///< diameter of the circle or ball of the mean volume; none: no mineral grains [m]
};

/// Deals the grains of a specimen to the Voronoi cells of seeds thrown in at random, from the specimen's seed, and puts a
/// smooth joint at every bonded joint between two cells, with the normal of the plane between them and the area of its
/// face. Throws InputError if the cells cannot be.
template <int dim>
void put_in_mineral_grains(Specimen<dim>& specimen, const MineralGrainParameters& wanted,
                           const SmoothJointParameters& boundary);

/// Puts a smooth joint at every bonded joint between two mineral grains that are there, with the normal from centroid to centroid
/// and the ratios of their boundary. Throws InputError where there can be no smooth joints.
template <int dim>
void join_minerals_smoothly(Specimen<dim>& specimen, const MineralParameters& wanted,
                            const SmoothJointParameters& boundary);
} // namespace feldspar
