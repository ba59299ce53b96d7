#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace feldspar
{
/// A mineral as results and pictures tell it from others.
struct MineralName
{
  std::string name;
  std::uint32_t colour = 0; ///< 0xRRGGBB
};

/// Share of a mineral in a specimen.
struct MineralShare
{
  MineralName mineral;
  std::uint64_t n_grains = 0;
  double share = 0.0; ///< of the grains' volume
};

/// Figures of a specimen as it came out of genesis.
struct SpecimenReport
{
  std::uint64_t n_grains = 0;
  std::uint64_t n_joints = 0;        ///< the smooth ones among them
  std::uint64_t n_smooth_joints = 0; ///< of flaws and of the boundaries of mineral grains
  std::uint64_t n_clumps = 0; ///< rigid groups of grains, single grains among them; 0: grains move each for itself
  double coordination_number = 0.0;
  double coordination_number_core = 0.0; ///< of grains more than three mean diameters from the walls; NaN if none
  double installation_gap_ratio = 0.0;   ///< over the mean radius
  double porosity = 0.0;
  double mean_overlap_ratio = 0.0; ///< of overlapping pairs, over the mean radius
  double largest_overlap_ratio = 0.0;
  double resolution = 0.0;            ///< width over mean diameter
  double radius_multiplier = 1.0;     ///< by which genesis scaled the drawn radii
  double packing_stress = 0.0;        ///< reached by genesis, compression positive [Pa]
  double mean_radius = 0.0;           ///< [m]
  std::uint64_t n_cut_joints = 0;     ///< by coring; 0 of a specimen that was packed between walls
  std::uint64_t n_removed_grains = 0; ///< that coring left without a way to the rest of the body
};
} // namespace feldspar
