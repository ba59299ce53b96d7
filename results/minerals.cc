#include "results/minerals.h"

#include <cmath>
#include <limits>

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
          means[k].stress[c] += own * snapshot.stress[c][i];
      }
  const CracksByMineral cracks = cracks_by_mineral(record.cracks, snapshot.step);
  for (std::size_t k = 0; k < means.size(); ++k)
    {
      for (double& component : means[k].stress)
        component = volume[k] > 0.0 ? component / volume[k] : std::numeric_limits<double>::quiet_NaN();
      const auto number = std::uint32_t(k + 1);
      if (const auto found = cracks.within.find(number); found != cracks.within.end())
        means[k].n_cracks_within = found->second;
      for (const auto& [pair, n] : cracks.on_boundaries)
        if (pair.first == number || pair.second == number)
          means[k].n_cracks_on_boundaries += n;
    }
  return means;
}

CracksByMineral cracks_by_mineral(const std::vector<Crack>& cracks, const std::uint64_t last_step)
{
  CracksByMineral result;
  for (const Crack& crack : cracks)
    if (crack.mineral_1 > 0 && crack.step <= last_step)
      ++(crack.on_boundary ? result.on_boundaries[{crack.mineral_1, crack.mineral_2}] : result.within[crack.mineral_1]);
  return result;
}
} // namespace feldspar
