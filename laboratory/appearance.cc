#include "laboratory/appearance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace feldspar
{
std::optional<Fragments> fragments_of(const std::vector<GrainPicture>& grains, const int dimension)
{
  std::map<std::uint32_t, std::pair<std::uint64_t, double>> fragments; // grains, and volume
  double all = 0.0;
  for (const auto& grain : grains)
    {
      auto& [n_grains, size] = fragments[grain.fragment];
      ++n_grains;
      const double volume = std::pow(grain.radius, dimension);
      size += volume;
      all += volume;
    }
  if (fragments.empty())
    return std::nullopt;
  const auto n = std::ranges::count_if(fragments, [](const auto& f) { return f.second.first > 1; });
  return Fragments{std::uint64_t(n), fragments.begin()->second.second / all};
}
} // namespace feldspar
