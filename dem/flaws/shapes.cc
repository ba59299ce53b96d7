#include "dem/flaws/shapes.h"

#include "base/parameter_id.h"
#include "base/random.h"
#include "dem/specimen/parameters.h"
#include "dem/storage/smooth_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace feldspar
{
namespace
{
constexpr double slack = 1e-9; // of the body's size: a notch begins on its edge
constexpr double most_traces = 20000.0;

double cross_product(const Vector<2>& a, const Vector<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

std::vector<Vector<2>> ellipse(const EllipseHole& hole)
{
  constexpr int n = 48;
  const Vector<2> first(std::cos(hole.angle), std::sin(hole.angle));
  const Vector<2> second(-first[1], first[0]);
  std::vector<Vector<2>> points;
  for (int k = 0; k <= n; ++k)
    {
      const double turn = 2.0 * std::numbers::pi * (k % n) / n;
      points.push_back(hole.centre + hole.semi_axes[0] * std::cos(turn) * first +
                       hole.semi_axes[1] * std::sin(turn) * second);
    }
  return points;
}

std::vector<Vector<2>> rectangle(const Slot& slot)
{
  const Vector<2> along = slot.to - slot.from;
  const Vector<2> across = 0.5 * slot.width * Vector<2>(-along[1], along[0]).normalized();
  return {slot.from + across, slot.to + across, slot.to - across, slot.from - across, slot.from + across};
}

template <int dim>
std::string text_of(const Vector<dim>& point)
{
  const Vector<dim> in_mm = 1e3 * point;
  return fmt::format("({:.4g}) mm", fmt::join(in_mm, ", "));
}

/// Stretch of a line, from `start` by multiples of `along`, that lies in a box of this size [m]; its end is not above its
/// beginning where none does.
std::pair<double, double> stretch_inside(const Vector<2>& start, const Vector<2>& along, double low, double high,
                                         const Vector<2>& size)
{
  for (int c = 0; c < 2; ++c)
    if (along[c] != 0.0)
      {
        const auto [near, far] = std::minmax({-start[c] / along[c], (size[c] - start[c]) / along[c]});
        low = std::max(low, near);
        high = std::min(high, far);
      }
    else if (start[c] < 0.0 || start[c] > size[c])
      high = low;
  return {low, high};
}

bool lies_in(const double value, const double size) { return value >= -slack * size && value <= (1.0 + slack) * size; }

/// The first of the points that lies outside, in the words of an error; empty if none does.
template <int dim>
std::string outside(const std::vector<Vector<dim>>& points, const Vector<dim>& size)
{
  for (const auto& point : points)
    for (int c = 0; c < dim; ++c)
      if (!lies_in(point[c], size[c]))
        return fmt::format("{} lies outside of the specimen, which reaches from 0 to {}", text_of<dim>(point),
                           text_of<dim>(size));
  return "";
}

/// Returns whether a ring of corners cuts itself.
bool cuts_itself(const std::vector<Vector<2>>& corners)
{
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if ((i != 0 || j + 1 != n) && cross(corners[i], corners[(i + 1) % n], corners[j], corners[(j + 1) % n]))
        return true;
  return false;
}
} // namespace

std::string_view name(const Shape& shape)
{
  return std::visit([](const auto& one) { return one.name; }, shape);
}

SmoothJointParameters SmoothSides::among(const SmoothJointParameters& all) const
{
  SmoothJointParameters one = all;
  one.normal_stiffness = normal_stiffness.value_or(all.normal_stiffness);
  one.shear_stiffness = shear_stiffness.value_or(all.shear_stiffness);
  one.friction = friction.value_or(all.friction);
  one.dilation_angle = dilation_angle.value_or(all.dilation_angle);
  one.tensile_strength = tensile_strength.value_or(0.0);
  one.cohesion = cohesion.value_or(0.0);
  one.friction_angle = friction_angle;
  return one;
}

const SmoothSides* smooth_sides(const Shape& shape)
{
  return std::visit(
    [](const auto& one) -> const SmoothSides* {
      if constexpr (requires { one.smooth; })
        return one.smooth ? &*one.smooth : nullptr;
      else
        return nullptr;
    },
    shape);
}

bool is_open(const Shape& shape)
{
  return !std::holds_alternative<ClosedFlaw>(shape) && !std::holds_alternative<DiscFlaw>(shape) &&
         !std::holds_alternative<JointSet>(shape) && !std::holds_alternative<DiscSet>(shape);
}

std::vector<Vector<2>> outline(const Shape& shape)
{
  if (const auto* hole = std::get_if<EllipseHole>(&shape))
    return ellipse(*hole);
  if (const auto* hole = std::get_if<PolygonHole>(&shape))
    {
      auto points = hole->corners;
      points.push_back(points.front());
      return points;
    }
  if (const auto* hole = std::get_if<SphereHole>(&shape))
    return ellipse({{hole->centre[0], hole->centre[2]}, {hole->radius, hole->radius}});
  if (const auto* slot = std::get_if<Slot>(&shape))
    return slot->width > 0.0 ? rectangle(*slot) : std::vector<Vector<2>>{slot->from, slot->to};
  if (const auto* flaw = std::get_if<ClosedFlaw>(&shape))
    return flaw->points;
  if (const auto* disc = std::get_if<DiscFlaw>(&shape))
    {
      // The plane of the disc cuts that of the picture along a line square to its normal.
      const Vector<2> along(-disc->normal[2], disc->normal[0]);
      if (!(along.norm() > 0.0))
        return {};
      const Vector<2> centre(disc->centre[0], disc->centre[2]);
      return {centre - disc->radius * along.normalized(), centre + disc->radius * along.normalized()};
    }
  return {};
}

bool cross(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c, const Vector<2>& d)
{
  const Vector<2> way = b - a;
  const Vector<2> line = d - c;
  const double denominator = cross_product(way, line);
  if (denominator == 0.0)
    return false; // along the line: the way does not lead across it
  const double on_way = cross_product(c - a, line) / denominator;
  const double on_line = cross_product(c - a, way) / denominator;
  return on_way >= 0.0 && on_way <= 1.0 && on_line >= 0.0 && on_line <= 1.0;
}

bool is_inside(const std::vector<Vector<2>>& corners, const Vector<2>& point)
{
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++)
    if ((corners[i][1] > point[1]) != (corners[j][1] > point[1]) &&
        point[0] < corners[i][0] +
                     (point[1] - corners[i][1]) * (corners[j][0] - corners[i][0]) / (corners[j][1] - corners[i][1]))
      inside = !inside;
  return inside;
}

std::vector<ClosedFlaw> traces(const JointSet& set, const Vector<2>& size)
{
  const Vector<2> along(std::cos(set.angle), std::sin(set.angle));
  const Vector<2> across(-along[1], along[0]);
  const Vector<2> middle = 0.5 * size;
  // Largest distances of the corners of the box from its middle, along and across the lines.
  double half_length = 0.0;
  double half_breadth = 0.0;
  for (const double x : {-middle[0], middle[0]})
    for (const double y : {-middle[1], middle[1]})
      {
        half_length = std::max(half_length, along.dot(Vector<2>(x, y)));
        half_breadth = std::max(half_breadth, across.dot(Vector<2>(x, y)));
      }
  Random random(set.seed, RandomStream::joint_sets);
  std::vector<ClosedFlaw> flaws;
  const bool through = set.persistence >= 1.0;
  const double period = through ? 2.0 * half_length : set.trace_length / set.persistence;
  const auto places = [](const double first, const double step, const double end) {
    std::vector<double> all(std::size_t(std::max(0.0, std::ceil((end - first) / step))));
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k] = first + double(k) * step;
    return all;
  };
  for (const double offset : places(-half_breadth + set.spacing * random.uniform(), set.spacing, half_breadth))
    {
      const Vector<2> start = middle + offset * across;
      const double first = through ? -half_length : -half_length - period * random.uniform();
      for (const double s : places(first, period, half_length))
        {
          const auto [low, high] = stretch_inside(start, along, s, s + (through ? period : set.trace_length), size);
          if (high > low)
            flaws.push_back({{start + low * along, start + high * along}, set.smooth});
        }
    }
  return flaws;
}

std::vector<DiscFlaw> discs(const DiscSet& set, const Vector<3>& size)
{
  Random random(set.seed, RandomStream::joint_sets);
  const auto [one, other] = plane_axes<3>(set.normal);
  std::vector<DiscFlaw> flaws;
  for (std::uint64_t k = 0; k < set.n; ++k)
    {
      Vector<3> centre;
      for (int c = 0; c < 3; ++c)
        centre[c] = random.uniform(0.0, size[c]);
      // The cosine z of the angle to the mean has the density exp(κz), between -1 and 1.
      const double u = random.uniform();
      const double z = std::max(-1.0, 1.0 + std::log1p(u * std::expm1(-2.0 * set.concentration)) / set.concentration);
      const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
      const Vector<3> normal =
        z * set.normal + std::sqrt(1.0 - z * z) * (std::cos(turn) * one + std::sin(turn) * other);
      flaws.push_back({centre, set.radius, normal.normalized(), set.smooth});
    }
  return flaws;
}

std::vector<Shape> FlawParameters::placed_traces() const
{
  const Vector<2> x(std::cos(map.angle), std::sin(map.angle));
  const Vector<2> y(-x[1], x[0]);
  std::vector<Shape> placed = traces;
  for (Shape& shape : placed)
    {
      auto& flaw = std::get<ClosedFlaw>(shape);
      for (Vector<2>& point : flaw.points)
        {
          const Vector<2> from_origin = map.scale * (point - map.origin);
          point = from_origin[0] * x + from_origin[1] * y;
        }
      if (const auto sides = map.smooth_layers.find(*flaw.map_layer); sides != map.smooth_layers.end())
        flaw.smooth = sides->second;
    }
  return placed;
}

std::vector<ClosedFlaw> parts_inside(const ClosedFlaw& flaw, const Vector<2>& size)
{
  std::vector<ClosedFlaw> parts;
  bool goes_on = false; // from the segment before
  for (std::size_t k = 0; k + 1 < flaw.points.size(); ++k)
    {
      const Vector<2> along = flaw.points[k + 1] - flaw.points[k];
      const auto [low, high] = stretch_inside(flaw.points[k], along, 0.0, 1.0, size);
      if (high > low)
        {
          if (!goes_on || low > 0.0)
            {
              parts.push_back(flaw);
              parts.back().points = {flaw.points[k] + low * along};
            }
          parts.back().points.push_back(high < 1.0 ? Vector<2>(flaw.points[k] + high * along) : flaw.points[k + 1]);
        }
      goes_on = high > low && high == 1.0;
    }
  return parts;
}

template <int dim>
std::string objection(const Shape& shape, const Vector<dim>& size)
{
  if (const auto* const flaw = std::get_if<ClosedFlaw>(&shape); flaw && flaw->map_layer)
    return ""; // its parts outside are left out

  const Vector<2> plane_size(size[0], size[dim - 1]);
  if (dim == 2 && (std::holds_alternative<SphereHole>(shape) || std::holds_alternative<DiscFlaw>(shape) ||
                   std::holds_alternative<DiscSet>(shape)))
    return fmt::format("lies in space; it needs {} = 3", in_words(parameter_id<&SpecimenParameters::dimension>()));
  if constexpr (dim == 3)
    {
      if (const auto* hole = std::get_if<SphereHole>(&shape))
        return outside<3>(
          {hole->centre - Vector<3>::Constant(hole->radius), hole->centre + Vector<3>::Constant(hole->radius)}, size);
      if (const auto* disc = std::get_if<DiscFlaw>(&shape))
        {
          // A disc reaches along each axis by its radius times the sine of its normal's angle to it.
          const Vector<3> reach = disc->radius * (1.0 - disc->normal.array().square()).max(0.0).sqrt();
          return outside<3>({disc->centre - reach, disc->centre + reach}, size);
        }
    }
  if (const auto* set = std::get_if<JointSet>(&shape))
    {
      const double length = set->persistence < 1.0 ? set->trace_length / set->persistence : plane_size.norm();
      if (plane_size.norm() / set->spacing * std::max(1.0, plane_size.norm() / length) > most_traces)
        return fmt::format("has more than {:g} traces in this specimen; widen the spacing or the traces", most_traces);
      return set->spacing >= plane_size.norm() ? "has a spacing larger than the specimen" : "";
    }
  if (const auto* hole = std::get_if<PolygonHole>(&shape); hole && cuts_itself(hole->corners))
    return "has an outline that cuts itself";
  if (const auto* slot = std::get_if<Slot>(&shape))
    return outside<2>({slot->from, slot->to}, plane_size);
  return outside<2>(outline(shape), plane_size);
}

template std::string objection<2>(const Shape&, const Vector<2>&);
template std::string objection<3>(const Shape&, const Vector<3>&);
} // namespace feldspar
