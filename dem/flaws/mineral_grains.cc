#include "dem/flaws/mineral_grains.h"

#include "base/parameter_id.h"
#include "dem/flaws/smooth_planes.h"
#include "dem/minerals/cells.h"
#include "dem/specimen/parameters.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

namespace feldspar
{
template <int dim>
void put_in_mineral_grains(Specimen<dim>& specimen, const MineralGrainParameters& wanted,
                           const SmoothJointParameters& boundary)
{
  if (!wanted.mean_size)
    return;
  const ParameterId size = parameter_id<&MineralGrainParameters::mean_size>();
  if (!specimen.groups.empty())
    throw ParameterError(size, "the specimen has mineral grains or clumps already; leave it out");
  if (specimen.is_periodic())
    throw ParameterError(size, fmt::format("a periodic specimen has no smooth joints; {} must be box or cylinder",
                                           in_words(parameter_id<&SpecimenParameters::shape>())));
  if (const std::string what = objection(boundary); !what.empty())
    throw ParameterError(parameters_id<SmoothJointParameters>(), what);
  const auto cells = throw_cells(specimen, {{"mineral grain", *wanted.mean_size}}, RandomStream::mineral_grains, size);
  specimen.groups = cells_of_grains(specimen, cells);

  const auto& joints = specimen.joints;
  std::vector<SmoothPlace<dim>> places;
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const std::uint32_t one = specimen.groups[joints.grain_1[j]];
      const std::uint32_t two = specimen.groups[joints.grain_2[j]];
      if (one != two && joints.holds(j))
        places.push_back({j, (cells[two].centre - cells[one].centre).normalized(), joints.face_area(j)});
    }
  put_smooth_joints(specimen, places, boundary, true);
}

template void put_in_mineral_grains<2>(Specimen<2>&, const MineralGrainParameters&, const SmoothJointParameters&);
template void put_in_mineral_grains<3>(Specimen<3>&, const MineralGrainParameters&, const SmoothJointParameters&);
} // namespace feldspar
