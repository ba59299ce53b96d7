#include "results/minerals.h"

#include <cmath>
#include <limits>
#include <set>

namespace feldspar
{
std::vector<MineralMeans> mineral_means(const TestRecord& record, const Snapshot& snapshot,
                                        const std::vector<GrainPicture>& grains)
{
  std::vector<MineralMeans> means(record.minerals.size());
  std::vector<double> volume(means.size(), 0.0);
  const bool has_stress = snapshot.stress[0].size() == grains.size();
  for (std::size_t i = 0; i < grains.size() && has_stress; ++i)
    if (const std::uint32_t k = grains[i].mineral - 1; k < means.size())
      {
        const double own = std::pow(grains[i].radius, record.dimension());
        volume[k] += own;
        for (std::size_t c = 0; c < 6; ++c)
          means[k].stress[c] += snapshot.stress[c].empty() ? 0.0 : own * snapshot.stress[c][i];
      }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < means.size(); ++k)
    for (std::size_t c = 0; c < 6; ++c)
      {
        double& stress = means[k].stress[c];
        stress = volume[k] > 0.0 ? stress / volume[k] : unknown;
        means[k].strain[c] = k < snapshot.mineral_strain[c].size() ? snapshot.mineral_strain[c][k] : unknown;
      }
  for (const Crack& crack : record.cracks)
    if (crack.step <= snapshot.step && crack.mineral_1 > 0 && crack.mineral_2 <= means.size())
      {
        if (!crack.on_boundary)
          ++means[crack.mineral_1 - 1].n_cracks_within;
        else
          for (const std::uint32_t number : std::set{crack.mineral_1, crack.mineral_2})
            ++means[number - 1].n_cracks_on_boundaries;
      }
  return means;
}
} // namespace feldspar
