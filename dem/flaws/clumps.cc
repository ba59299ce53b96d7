#include "dem/flaws/clumps.h"

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/minerals/cells.h"
#include "dem/minerals/parameters.h"
#include "dem/specimen/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace feldspar
{
namespace
{
ParameterId size_id() { return parameter_id<&ClumpParameters::diameter>(); }

[[noreturn]] void refuse(const double diameter, const std::string& why)
{
  throw ParameterError(size_id(), fmt::format("{:g} mm", 1e3 * diameter), why);
}

template <int dim>
void check(const Specimen<dim>& specimen, const double diameter)
{
  if (dim == 3)
    refuse(diameter, fmt::format("clumps are of the plane; {} must be 2",
                                 in_words(parameter_id<&SpecimenParameters::dimension>())));
  if (specimen.is_periodic())
    refuse(diameter, fmt::format("a periodic specimen has no clumps; {} must be box",
                                 in_words(parameter_id<&SpecimenParameters::shape>())));
  if (!specimen.groups.empty())
    refuse(diameter, "the specimen has mineral grains or clumps already; leave it out");
  if (!specimen.flaws.empty() || !specimen.smooth_joints.empty())
    refuse(diameter, "the specimen has flaws, which clumps cannot have; leave one of both out");
  if (diameter < 4.0 * specimen.report.mean_radius)
    refuse(diameter, fmt::format("must be at least two mean diameters of the grains, {:.3g} mm",
                                 4e3 * specimen.report.mean_radius));
}

/// Neighbours of each grain by its joints, in the order of the joints' numbers.
template <int dim>
std::vector<std::vector<std::uint32_t>> joined(const Specimen<dim>& specimen)
{
  const auto& joints = specimen.joints;
  std::vector<std::vector<std::uint32_t>> others(specimen.grains.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints.holds(j))
      {
        others[joints.grain_1[j]].push_back(joints.grain_2[j]);
        others[joints.grain_2[j]].push_back(joints.grain_1[j]);
      }
  return others;
}

/// Groups grow from the grains in this order along the joints, to where grains do not belong together: grains that are connected
/// only across another group stay apart.
template <int dim>
void make_rigid(Specimen<dim>& specimen, const std::vector<std::uint32_t>& order,
                const std::function<bool(std::uint32_t, std::uint32_t)>& belong_together)
{
  const auto others = joined(specimen);
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> group(order.size(), none);
  std::uint32_t n_groups = 0;
  for (const std::uint32_t middle : order)
    {
      if (group[middle] != none)
        continue;
      std::vector<std::uint32_t> reached{middle};
      group[middle] = n_groups;
      for (std::size_t k = 0; k < reached.size(); ++k)
        for (const std::uint32_t other : others[reached[k]])
          if (group[other] == none && belong_together(middle, other))
            {
              group[other] = n_groups;
              reached.push_back(other);
            }
      ++n_groups;
    }

  specimen.groups = std::move(group);
  specimen.groups_are_rigid = true;
  specimen.report.n_clumps = n_groups;
  auto& joints = specimen.joints;
  joints.keep_if(
    [&](const std::size_t j) { return specimen.groups[joints.grain_1[j]] != specimen.groups[joints.grain_2[j]]; });
  specimen.report.n_joints = specimen.n_joints();
  specimen.number_joints();
}
} // namespace

template <int dim>
void put_in_clumps(Specimen<dim>& specimen, const ClumpParameters& wanted)
{
  if (!wanted.diameter)
    return;
  check(specimen, *wanted.diameter);
  const auto& grains = specimen.grains;
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0u);
  if (wanted.form == ClumpForm::stamped)
    {
      Random(specimen.seed, RandomStream::clumps).shuffle(order);
      const double reach = 0.5 * *wanted.diameter;
      make_rigid(specimen, order, [&, reach](const std::uint32_t middle, const std::uint32_t other) {
        return (at<dim>(grains.position, other) - at<dim>(grains.position, middle)).norm() < reach;
      });
    }
  else
    {
      const auto cell = cells_of_grains(
        specimen, throw_cells(specimen, {{"clump", *wanted.diameter}}, RandomStream::clumps, size_id()));
      make_rigid(specimen, order,
                 [&](const std::uint32_t one, const std::uint32_t two) { return cell[one] == cell[two]; });
    }
  if (specimen.joints.size() == 0)
    refuse(*wanted.diameter, "leaves no joint between two clumps; make it smaller");
}

template <int dim>
void make_minerals_rigid(Specimen<dim>& specimen)
{
  if (dim == 3 || specimen.shape != BodyShape::box || !specimen.flaws.empty())
    throw ParameterError(parameter_id<&MineralParameters::form>(),
                         "rigid mineral grains are in a box in the plane and without flaws");
  const auto groups = specimen.groups;
  std::vector<std::uint32_t> order(groups.size());
  std::iota(order.begin(), order.end(), 0u);
  make_rigid(specimen, order,
             [&](const std::uint32_t one, const std::uint32_t two) { return groups[one] == groups[two]; });
  if (specimen.joints.size() == 0)
    throw ParameterError(parameter_id<&MineralParameters::form>(),
                         "rigid leaves no joint between two mineral grains; make them smaller, or breakable");
}

template void put_in_clumps<2>(Specimen<2>&, const ClumpParameters&);
template void put_in_clumps<3>(Specimen<3>&, const ClumpParameters&);
template void make_minerals_rigid<2>(Specimen<2>&);
template void make_minerals_rigid<3>(Specimen<3>&);
} // namespace feldspar
