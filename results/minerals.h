#pragma once

#include "laboratory/appearance.h"
#include "laboratory/record.h"

#include <array>
#include <cstdint>
#include <vector>

/// Stress, strain and cracks in each mineral of a rock.
namespace feldspar
{
struct MineralMeans
{
  /// Mean stress of its grains, weighed by their volumes: xx, xy, xz, yy, yz, zz, tension positive [Pa]. Times the shares of the
  /// minerals they add up to the stress of the specimen.
  std::array<double, 6> stress{};
  std::array<double, 6> strain{};           ///< since the loading began, the same components
  std::uint64_t n_cracks_within = 0;        ///< so far
  std::uint64_t n_cracks_on_boundaries = 0; ///< so far, with itself or another
};

/// [n_minerals]; none of a rock without minerals. Stresses and strains are NaN where the snapshot has none.
std::vector<MineralMeans> mineral_means(const TestRecord& record, const Snapshot& snapshot,
                                        const std::vector<GrainPicture>& grains);
} // namespace feldspar
