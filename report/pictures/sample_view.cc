#include "report/pictures/sample_view.h"

#include "report/pictures/plot_style.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

SamplePiece mirrored(SamplePiece piece)
{
  for (auto* points : {&piece.rest, &piece.moved})
    for (PlanePoint& point : *points)
      point[0] = -point[0];
  return piece;
}
} // namespace

SampleView::SampleView(const SampleFields& its_fields, const double its_scale)
  : fields(its_fields)
  , scale(its_scale)
{
  Limits<3> limits;
  for (const auto& node : fields.nodes)
    limits.include(node);
  // A little off the axis, where faces of cells may lie.
  cut = limits.low[1] + (0.5 + 1e-6) * limits.size(1);
}

std::vector<SamplePiece> SampleView::pieces() const
{
  std::vector<SamplePiece> all;
  for (std::size_t k = 0; k < fields.cells.size(); ++k)
    if (SamplePiece piece = fields.dimension == 2 ? flat(k) : section(k); piece.rest.size() >= 3)
      {
        if (fields.is_axisymmetric())
          all.push_back(mirrored(piece));
        all.push_back(std::move(piece));
      }
  return all;
}

PlanePoint SampleView::place(const PointRve& rve) const
{
  const bool in_space = fields.dimension == 3;
  std::array<double, 3> at = rve.position;
  if (!in_space && fields.has("crack_orientation_zz_per_m")) // the axes of the material: the last is the sample's
    at = {at[0], at[2], 0.0};
  // The displacement of the nodes of its cell, as near as a linear one comes to it.
  const auto& numbers = fields.of_each_cell.at("cell");
  const auto found = std::ranges::find(numbers, double(rve.cell));
  if (found == numbers.end())
    return in_picture(at);
  const auto& corners = fields.cells[std::size_t(found - numbers.begin())];
  Eigen::MatrixXd places(corners.size(), fields.dimension + 1);
  Eigen::MatrixXd displacements(corners.size(), 3);
  for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const auto row = Eigen::Index(k);
      places(row, fields.dimension) = 1.0;
      for (std::size_t c = 0; c < fields.dimension; ++c)
        places(row, Eigen::Index(c)) = fields.nodes[corners[k]][c] - at[c];
      for (std::size_t c = 0; c < 3; ++c)
        displacements(row, Eigen::Index(c)) = fields.displacement[corners[k]][c];
    }
  const Eigen::MatrixXd linear = places.colPivHouseholderQr().solve(displacements);
  for (std::size_t c = 0; c < 3; ++c)
    at[c] += scale * linear(fields.dimension, Eigen::Index(c));
  return in_picture(at);
}

PlanePoint SampleView::in_picture(const std::array<double, 3>& at) const
{
  return {at[0], fields.dimension == 2 ? at[1] : at[2]};
}

std::array<double, 3> SampleView::moved(const std::uint32_t i) const
{
  std::array<double, 3> at = fields.nodes[i];
  for (std::size_t c = 0; c < 3; ++c)
    at[c] += scale * fields.displacement[i][c];
  return at;
}

SamplePiece SampleView::flat(const std::size_t k) const
{
  SamplePiece piece{k, {}, {}};
  for (const std::uint32_t i : fields.cells[k])
    {
      piece.rest.push_back(in_picture(fields.nodes[i]));
      piece.moved.push_back(in_picture(moved(i)));
    }
  return piece;
}

SamplePiece SampleView::section(const std::size_t k) const
{
  static constexpr std::array<std::array<std::size_t, 2>, 12> edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  std::vector<std::pair<PlanePoint, PlanePoint>> corners; // at rest and moved
  for (const auto& [begin, end] : edges)
    {
      const std::uint32_t i = fields.cells[k][begin];
      const std::uint32_t j = fields.cells[k][end];
      const double a = fields.nodes[i][1] - cut;
      const double b = fields.nodes[j][1] - cut;
      if ((a < 0.0) == (b < 0.0))
        continue;
      const double share = a / (a - b);
      const auto between = [=](const auto& one, const auto& other) {
        std::array<double, 3> at{};
        for (std::size_t c = 0; c < 3; ++c)
          at[c] = (1.0 - share) * one[c] + share * other[c];
        return at;
      };
      corners.emplace_back(in_picture(between(fields.nodes[i], fields.nodes[j])),
                           in_picture(between(moved(i), moved(j))));
    }
  PlanePoint middle{};
  for (const auto& [rest, displaced] : corners)
    for (std::size_t c = 0; c < 2; ++c)
      middle[c] += rest[c] / double(corners.size());
  const auto angle = [&](const auto& corner) {
    return std::atan2(corner.first[1] - middle[1], corner.first[0] - middle[0]);
  };
  std::ranges::sort(corners, [&](const auto& one, const auto& other) { return angle(one) < angle(other); });
  SamplePiece piece{k, {}, {}};
  for (const auto& [rest, displaced] : corners)
    {
      piece.rest.push_back(rest);
      piece.moved.push_back(displaced);
    }
  return piece;
}

std::vector<ChartPoint> outline(const std::vector<SamplePiece>& pieces,
                                const std::vector<PlanePoint> SamplePiece::*drawn,
                                const std::function<bool(const SamplePiece&)>& inside)
{
  // Nodes of each cell are its own: those at one place are one.
  const auto key_of = [](const PlanePoint& point) {
    constexpr double small = 1e-8; // [m]
    return std::array{std::llround(point[0] / small), std::llround(point[1] / small)};
  };
  std::map<std::array<std::array<long long, 2>, 2>, std::pair<int, std::array<PlanePoint, 2>>> edges;
  for (const SamplePiece& piece : pieces)
    if (inside(piece))
      for (std::size_t k = 0; k < piece.rest.size(); ++k)
        {
          const std::size_t next = (k + 1) % piece.rest.size();
          std::array key{key_of(piece.rest[k]), key_of(piece.rest[next])};
          if (key[0] == key[1])
            continue;
          if (key[1] < key[0])
            std::swap(key[0], key[1]);
          const auto& points = piece.*drawn;
          auto& [n, ends] = edges[key];
          ++n;
          ends = {points[k], points[next]};
        }
  std::vector<ChartPoint> lines;
  for (const auto& [key, edge] : edges)
    if (edge.first == 1)
      {
        for (const PlanePoint& end : edge.second)
          lines.push_back({end[0] / milli, end[1] / milli});
        lines.push_back(gap);
      }
  return lines;
}

PlanePoint middle_of(const std::vector<PlanePoint>& corners)
{
  PlanePoint middle{};
  for (const PlanePoint& corner : corners)
    for (std::size_t c = 0; c < 2; ++c)
      middle[c] += corner[c] / double(corners.size());
  return middle;
}

double area_of(const std::vector<PlanePoint>& corners)
{
  double twice = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const PlanePoint& a = corners[k];
      const PlanePoint& b = corners[(k + 1) % corners.size()];
      twice += a[0] * b[1] - b[0] * a[1];
    }
  return 0.5 * std::abs(twice);
}

double visible_scale(const SampleFields& fields)
{
  double largest = 0.0;
  Limits<3> limits;
  for (std::size_t i = 0; i < fields.nodes.size(); ++i)
    {
      const auto& u = fields.displacement[i];
      largest = std::max(largest, std::hypot(u[0], u[1], u[2]));
      limits.include(fields.nodes[i]);
    }
  return largest > 0.0 ? std::max(1.0, round_number(0.06 * limits.size(fields.dimension - 1) / largest)) : 1.0;
}
} // namespace feldspar
