#include "report/pictures/plot_style.h"
#include "report/pictures/rves.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string_view>

namespace feldspar
{
extern const std::string_view space_scene; // report/pictures/space_scene.py

namespace
{
using namespace plot;
using Json = nlohmann::ordered_json; // JSON is Python, as far as it goes here

constexpr std::array fragment_colours{orange, sky, green, purple, vermillion, blue};

/// Box of a picture [m].
struct Box
{
  std::array<double, 3> low, high;

  /// A cube about the origin.
  explicit Box(const double half_width)
  {
    low.fill(-half_width);
    high.fill(half_width);
  }

  /// Returns whether a point is shown: with room for grains that bulge, not for those that flew away.
  bool shows(const std::array<double, 3>& point) const
  {
    for (std::size_t c = 0; c < 3; ++c)
      if (const double room = 0.15 * (high[c] - low[c]); point[c] < low[c] - room || point[c] > high[c] + room)
        return false;
    return true;
  }

  Json millimetres() const
  {
    Json corners = {Json::array(), Json::array()};
    for (std::size_t c = 0; c < 3; ++c)
      {
        corners[0].push_back(low[c] / milli);
        corners[1].push_back(high[c] / milli);
      }
    return corners;
  }
};

/// Discs of cracks, and how many there are of either kind.
struct Discs
{
  std::string rows;
  Json legend;
};

Discs discs_of(const std::vector<Crack>& cracks, const Box& box)
{
  std::string rows;
  std::array<std::size_t, 2> n{};
  for (const auto& crack : cracks)
    {
      const bool is_shear = crack.kind == CrackKind::shear;
      ++n[is_shear];
      if (!box.shows(crack.centroid))
        continue;
      for (const double x : crack.centroid)
        fmt::format_to(std::back_inserter(rows), "{:.5g} ", x / milli);
      for (const double component : crack.normal)
        fmt::format_to(std::back_inserter(rows), "{:.4g} ", component);
      // The disc of the element's area.
      fmt::format_to(std::back_inserter(rows), "{:.4g} {}\n", crack.size / std::sqrt(std::numbers::pi) / milli,
                     is_shear ? shear_colour : tension_colour);
    }
  return {rows, {{fmt::format("tension: {}", n[0]), tension_colour}, {fmt::format("shear: {}", n[1]), shear_colour}}};
}

/// Number of grains of each fragment.
std::map<std::uint32_t, std::size_t> numbers_of_grains(const std::vector<GrainPicture>& grains)
{
  std::map<std::uint32_t, std::size_t> n_grains;
  for (const auto& grain : grains)
    ++n_grains[grain.fragment];
  return n_grains;
}

/// The grains behind the mid-plane.
std::string spheres_behind(const std::vector<GrainPicture>& grains, const Box& box)
{
  std::map<std::uint32_t, std::size_t> n_grains = numbers_of_grains(grains);
  const double cut = 0.5 * (box.low[1] + box.high[1]);
  std::string rows;
  for (const auto& grain : grains)
    if (grain.start[1] >= cut && box.shows(grain.position))
      {
        for (const double x : grain.position)
          fmt::format_to(std::back_inserter(rows), "{:.5g} ", x / milli);
        fmt::format_to(std::back_inserter(rows), "{:.4g} {}\n", grain.radius / milli,
                       grain.fragment == 0             ? light_grey
                       : n_grains[grain.fragment] == 1 ? single_grain_colour
                                                       : fragment_colours[grain.fragment % fragment_colours.size()]);
      }
  return rows;
}

} // namespace

Picture space_picture_of_rves(const std::vector<PointRve>& rves, const std::vector<std::string>& headings)
{
  double reach = 0.0; // from an RVE's point
  for (const PointRve& rve : rves)
    for (const auto& grain : rve.grains)
      for (std::size_t c = 0; c < 3; ++c)
        reach = std::max(reach, std::abs(grain.position[c] - rve.position[c]) + grain.radius);
  const Box box(reach);
  Json panels = Json::array();
  for (std::size_t k = 0; k < rves.size(); ++k)
    {
      PointRve rve = rves[k];
      for (std::size_t c = 0; c < 3; ++c)
        {
          for (auto& grain : rve.grains)
            for (auto* place : {&grain.start, &grain.position})
              (*place)[c] -= rve.position[c];
          for (auto& crack : rve.cracks)
            crack.centroid[c] -= rve.position[c];
        }
      const Discs discs = discs_of(rve.cracks, box);
      panels.push_back({{"title", headings[k]},
                        {"box", box.millimetres()},
                        {"spheres", spheres_behind(rve.grains, box)},
                        {"discs", discs.rows},
                        {"opacity", 0.7},
                        {"legend", discs.legend}});
    }
  Picture picture;
  picture.width = 450 * int(panels.size());
  picture.height = 560;
  picture.raster = true;
  picture.vector = false;
  picture.scene = fmt::format("panels = {}\n{}", panels.dump(), space_scene);
  return picture;
}
} // namespace feldspar
