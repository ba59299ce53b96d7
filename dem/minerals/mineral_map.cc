#include "dem/minerals/mineral_map.h"

#include "base/colour.h"
#include "base/mapped.h"
#include "base/parameter_id.h"
#include "base/quoted.h"

#define BOOST_ALLOW_DEPRECATED_HEADERS // which Boost.Geometry includes itself
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
[[noreturn]] void refuse(const std::string& why)
{
  throw ParameterError(parameter_id<&MineralParameters::map_file>(), why);
}

double slice_distance(const MineralParameters& wanted) { return wanted.slice_distance.value_or(*wanted.pixel_size); }

void check_cover(const MineralParameters& wanted, const std::array<double, 3>& size)
{
  const std::size_t n_rows = wanted.map->colour.size() / wanted.map->width;
  if (n_rows % wanted.n_slices != 0)
    refuse(fmt::format("{} has {} rows, which {} slices cannot share", wanted.map_file, n_rows, wanted.n_slices));
  const std::size_t n_rows_of_slice = n_rows / wanted.n_slices;
  const std::array<double, 3> shown{double(wanted.map->width) * *wanted.pixel_size,
                                    wanted.n_slices * slice_distance(wanted),
                                    double(n_rows_of_slice) * *wanted.pixel_size};
  constexpr double round_off = 1e-9;
  for (const std::size_t axis : {0, 2, 1})
    if (const bool is_shown = axis != 1 || wanted.n_slices > 1;
        is_shown && shown[axis] < (1.0 - round_off) * size[axis])
      refuse(
        fmt::format("{} shows {:g} mm of the {}, and the specimen has {:g} mm; give a larger map, larger pixels{} or a "
                    "smaller specimen",
                    wanted.map_file, 1e3 * shown[axis], std::array{"width", "depth", "height"}[axis], 1e3 * size[axis],
                    axis == 1 ? ", slices further apart" : ""));
}

/// Points in another unit, or of another place, would all be on one side of the body: they must span a third of it at least.
void check_span(const MineralParameters& wanted, const std::array<double, 3>& size)
{
  const bool in_space = size[1] > 0.0;
  for (const std::size_t axis : {0, 1, 2})
    {
      const double extent = in_space ? size[axis] : std::array{size[0], size[2], 0.0}[axis];
      double low = extent, high = 0.0;
      for (const auto& place : wanted.map->place)
        {
          low = std::min(low, std::max(place[axis], 0.0));
          high = std::max(high, std::min(place[axis], extent));
        }
      if (extent > 0.0 && 3.0 * (high - low) < extent)
        refuse(fmt::format(
          "the points of {} span {:g} mm of {:g} mm of the specimen along {}; give points over all of it, with "
          "their unit",
          wanted.map_file, 1e3 * std::max(high - low, 0.0), 1e3 * extent, "xyz"[axis]));
    }
}

/// The mineral at a point.
template <int dim>
using MineralAt = std::function<std::uint8_t(const Vector<dim>&)>;

template <int dim>
MineralAt<dim> mineral_at_cell(const MineralParameters& wanted, const std::vector<std::uint8_t>& minerals)
{
  const std::size_t width = wanted.map->width;
  const std::size_t height = minerals.size() / width / wanted.n_slices;
  const double pixel = *wanted.pixel_size;
  return [=, &wanted, &minerals](const Vector<dim>& point) {
    // A grain that sticks out of the picture meets its edge there.
    const auto cell = [](const double x, const double step, const std::size_t n) {
      return std::size_t(std::clamp(std::floor(x / step), 0.0, double(n - 1)));
    };
    const std::size_t slice = dim == 3 ? cell(point[1], slice_distance(wanted), wanted.n_slices) : 0;
    const std::size_t row = height - 1 - cell(point[dim - 1], pixel, height);
    return minerals[(slice * height + row) * width + cell(point[0], pixel, width)];
  };
}

template <int dim>
MineralAt<dim> mineral_at_point(const MineralMap& map, const std::vector<std::uint8_t>& minerals)
{
  namespace bg = boost::geometry;
  using Point = bg::model::point<double, 3, bg::cs::cartesian>;
  std::vector<std::pair<Point, std::size_t>> places;
  for (std::size_t k = 0; k < map.place.size(); ++k)
    places.emplace_back(Point(map.place[k][0], map.place[k][1], dim == 3 ? map.place[k][2] : 0.0), k);
  return [&minerals, tree = bg::index::rtree<std::pair<Point, std::size_t>, bg::index::quadratic<16>>(places)](
           const Vector<dim>& point) {
    const auto place = in_space<dim>(point);
    std::vector<std::pair<Point, std::size_t>> nearest;
    tree.query(bg::index::nearest(Point(place[0], place[1], place[2]), 1), std::back_inserter(nearest));
    return minerals[nearest.front().second];
  };
}

/// Points evenly over a disc or ball of radius 1, so many over a radius.
template <int dim>
std::vector<Vector<dim>> points_in_ball(const int n)
{
  std::vector<Vector<dim>> points;
  const auto add = [&](const auto& self, const int axis, Vector<dim> point) -> void {
    if (axis == dim)
      {
        if (point.squaredNorm() <= 1.0)
          points.push_back(point);
        return;
      }
    for (int k = 0; k < 2 * n; ++k)
      {
        point[axis] = (k + 0.5) / n - 1.0;
        self(self, axis + 1, point);
      }
  };
  add(add, 0, Vector<dim>::Zero());
  return points;
}
} // namespace

std::vector<std::uint8_t> minerals_of_map(const MineralParameters& wanted, const std::array<double, 3>& size)
{
  const MineralMap& map = *wanted.map;
  std::vector<std::uint8_t> result;
  if (map.colour.empty())
    {
      std::map<std::string, std::uint8_t> number;
      for (const Mineral& mineral : wanted.minerals)
        number.emplace(mineral.name, std::uint8_t(number.size()));
      for (const std::string& name : map.mineral_of_point)
        if (const auto found = number.find(name); found != number.end())
          result.push_back(found->second);
        else
          refuse(fmt::format("{} names {}, which is not in the table of minerals", wanted.map_file, in_quotes(name)));
      check_span(wanted, size);
      return result;
    }
  if (!wanted.pixel_size)
    throw ParameterError(parameter_id<&MineralParameters::pixel_size>(),
                         "a picture needs the size of its pixels, e.g. 0.05 mm");
  std::map<std::uint32_t, std::uint8_t> number;
  for (const Mineral& mineral : wanted.minerals)
    if (!number.emplace(mineral.colour, std::uint8_t(number.size())).second)
      throw ParameterError(
        parameter_id<&MineralParameters::table>(),
        fmt::format("two minerals have the colour {}; a picture needs a colour for each", colour_text(mineral.colour)));
  result.reserve(map.colour.size());
  for (std::size_t k = 0; k < map.colour.size(); ++k)
    if (const auto found = number.find(map.colour[k]); found != number.end())
      result.push_back(found->second);
    else
      {
        const auto colours = mapped<std::string>(
          wanted.minerals, [](const Mineral& mineral) { return colour_text(mineral.colour) + " " + mineral.name; });
        refuse(fmt::format("{}: the pixel in row {}, column {} has the colour {}, which no mineral has; the table "
                           "has {}",
                           wanted.map_file, k / map.width + 1, k % map.width + 1, colour_text(map.colour[k]),
                           excerpt(fmt::format("{}", fmt::join(colours, ", ")), 200)));
      }
  check_cover(wanted, size);
  return result;
}

template <int dim>
std::vector<std::uint32_t> minerals_of_grains(const Specimen<dim>& specimen, const MineralParameters& wanted)
{
  const MineralMap& map = *wanted.map;
  const auto minerals =
    minerals_of_map(wanted, {specimen.size[0], dim == 3 ? specimen.size[1] : 0.0, specimen.size[dim - 1]});
  const MineralAt<dim> mineral_at =
    map.colour.empty() ? mineral_at_point<dim>(map, minerals) : mineral_at_cell<dim>(wanted, minerals);
  // The points are as fine as the pixels, within reason.
  constexpr double fewest = dim == 2 ? 6.0 : 4.0, most = dim == 2 ? 40.0 : 12.0;
  const double wanted_points = map.colour.empty() ? fewest : specimen.report.mean_radius / *wanted.pixel_size;
  const auto points = points_in_ball<dim>(int(std::ceil(std::clamp(wanted_points, fewest, most))));
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      std::vector<std::size_t> n_points(wanted.minerals.size(), 0);
      for (const Vector<dim>& of_ball : points)
        {
          Vector<dim> point = at<dim>(specimen.grains.position, i) + specimen.grains.radius[i] * of_ball;
          for (int c = 0; c < dim; ++c)
            if (specimen.repeats(c))
              point[c] -= specimen.size[c] * std::floor(point[c] / specimen.size[c]);
          ++n_points[mineral_at(point)];
        }
      result.push_back(std::uint32_t(std::max_element(n_points.begin(), n_points.end()) - n_points.begin()));
    }
  return result;
}

template std::vector<std::uint32_t> minerals_of_grains<2>(const Specimen<2>&, const MineralParameters&);
template std::vector<std::uint32_t> minerals_of_grains<3>(const Specimen<3>&, const MineralParameters&);
} // namespace feldspar
