#include "dem/lab/seating.h"

#include "base/parameter_id.h"
#include "dem/specimen/fragments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

namespace feldspar
{
namespace
{
/// The side of a body of grains is rough by about this much, over the mean radius: where it lies is not known better. At both
/// ends of twenty mean radii, the least width of a specimen, it is 5 % of the length, as much as strengths of specimens scatter.
constexpr double largest_gap = 0.5;

/// Grains that a packing pressed into one wall stand out differently, by no more than grains that it pressed together overlap,
/// over the mean radius: a wall that is brought to them lies on all. Never more than the end of a ground core, which is flat to
/// 0.02 mm (ISRM).
template <int dim>
double bed_of_brought_wall(const Specimen<dim>& specimen)
{
  return std::min(specimen.report.largest_overlap_ratio, 0.01);
}

struct Side
{
  std::string name;
  Wall wall;
};

template <int dim>
std::vector<Side> sides_of_box(const Specimen<dim>& specimen)
{
  constexpr int last = dim - 1;
  std::vector<Side> sides{{"lower end", {.axis = last}},
                          {"upper end", {.axis = last, .side = -1.0, .position = specimen.size[last]}}};
  if (specimen.is_round())
    sides.push_back({"round side", round_wall(specimen)});
  else
    for (int axis = 0; axis < last; ++axis)
      {
        sides.push_back({axis == 0 ? "left side" : "front side", {.axis = axis}});
        sides.push_back(
          {axis == 0 ? "right side" : "back side", {.axis = axis, .side = -1.0, .position = specimen.size[axis]}});
      }
  return sides;
}

std::string advice()
{
  return fmt::format("make {} and {} those of the grains, let a packing begin at 0, or take no end off by a flaw",
                     in_words(parameter_id<&SpecimenParameters::width>()),
                     entry_in_words(parameter_id<&SpecimenParameters::height>()));
}
} // namespace

template <int dim>
std::vector<bool> grains_of_body(const Specimen<dim>& specimen)
{
  const std::size_t n = specimen.grains.size();
  if (specimen.n_joints() == 0)
    return std::vector<bool>(n, true);
  std::vector<bool> is_part(n, false);
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    is_part[specimen.joints.grain_1[j]] = is_part[specimen.joints.grain_2[j]] = true;
  for (const auto& joint : specimen.smooth_joints)
    is_part[joint.grain_1] = is_part[joint.grain_2] = true;
  if (specimen.groups_are_rigid) // a set with one grain that has a joint is a part with all of its grains
    {
      DisjointSets pieces = connected_grains(specimen, Faces::all);
      const std::vector<bool> has_joint = is_part;
      for (std::uint32_t i = 0; i < n; ++i)
        if (has_joint[i])
          is_part[pieces.root(i)] = true;
      for (std::uint32_t i = 0; i < n; ++i)
        is_part[i] = is_part[pieces.root(i)];
    }
  return is_part;
}

template <int dim>
void check_fills_its_box(const Specimen<dim>& specimen)
{
  const std::vector<bool> is_part = grains_of_body(specimen);
  std::vector<std::string> gaps;
  double largest = 0.0;
  for (const auto& [name, wall] : sides_of_box(specimen))
    {
      const double gap = std::max(0.0, gap_at(specimen, wall, is_part));
      largest = std::max(largest, gap);
      gaps.push_back(fmt::format("{} {:.3g} mm", name, 1e3 * gap));
    }
  if (const double most = largest_gap * specimen.grains.mean_radius(); largest > most)
    throw ParameterError(parameters_id<SpecimenParameters>(),
                         fmt::format("its grains end inside of its box, by more than half of a mean radius, "
                                     "{:.3g} mm: {}; {}",
                                     1e3 * most, fmt::join(gaps, ", "), advice()));
}

template <int dim>
void check_leads_from_end_to_end(const Specimen<dim>& specimen)
{
  const std::size_t n = specimen.grains.size();
  if (specimen.n_joints() == 0)
    return;
  DisjointSets pieces = connected_grains(specimen, Faces::all);
  const double depth = 2.0 * largest_gap * specimen.grains.mean_radius();
  const auto lead_from_end_to_end = [&] {
    std::vector<bool> is_below(n, false);
    const auto& height = specimen.grains.position[dim - 1];
    for (std::uint32_t i = 0; i < n; ++i)
      if (height[i] - specimen.grains.radius[i] < depth)
        is_below[pieces.root(i)] = true;
    for (std::uint32_t i = 0; i < n; ++i)
      if (height[i] + specimen.grains.radius[i] > specimen.size[dim - 1] - depth && is_below[pieces.root(i)])
        return true;
    return false;
  };
  if (lead_from_end_to_end())
    return;
  for (const auto& [one, two] : pairs_within(specimen.grains, 0.0))
    pieces.merge(one, two);
  if (!lead_from_end_to_end())
    throw ParameterError(parameters_id<SpecimenParameters>(),
                         "no grains that are joined or touch lead from its lower to its upper end: an open flaw or a "
                         "gap in the packing goes right through it; let a flaw end inside, or close it");
}

template <int dim>
std::size_t stand_wall(SetUpTest<dim>& test, Wall wall, const std::string_view name)
{
  const Specimen<dim>& body = test.dynamics.specimen();
  const double gap = gap_at(body, wall, grains_of_body(body));
  const double radius = body.grains.mean_radius();
  if (const double most = largest_gap * radius; gap > most)
    throw ParameterError(parameters_id<SpecimenParameters>(),
                         fmt::format("the nearest grain is {:.3g} mm away from the {}, more than half of a mean "
                                     "radius, {:.3g} mm; {}",
                                     1e3 * gap, name, 1e3 * most, advice()));
  if (gap > 0.0)
    {
      wall.position += wall.side * gap;
      wall.bed = bed_of_brought_wall(body) * radius;
      test.loading.way_to_grains = std::max(test.loading.way_to_grains, gap);
    }
  return test.dynamics.add_wall(wall);
}

template std::vector<bool> grains_of_body<2>(const Specimen<2>&);
template std::vector<bool> grains_of_body<3>(const Specimen<3>&);
template void check_fills_its_box<2>(const Specimen<2>&);
template void check_fills_its_box<3>(const Specimen<3>&);
template void check_leads_from_end_to_end<2>(const Specimen<2>&);
template void check_leads_from_end_to_end<3>(const Specimen<3>&);
template std::size_t stand_wall<2>(SetUpTest<2>&, Wall, std::string_view);
template std::size_t stand_wall<3>(SetUpTest<3>&, Wall, std::string_view);
} // namespace feldspar
