#include "dem/flaws/apply.h"

#include "base/input_error.h"
#include "base/parameter_id.h"
#include "dem/flaws/smooth_planes.h"
#include "dem/specimen/fragments.h"
#include "dem/specimen/specimen_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
/// Grains that fall out of a hole's rim with it: at most so many connected ones.
constexpr std::uint32_t largest_crumb = 3;

/// The coordinates of the plane of the pictures.
template <int dim>
Vector<2> in_plane(const Vector<dim>& point)
{
  return {point[0], point[dim - 1]};
}

/// The effect of a shape on a grain's centre, and on the line between two centres.
template <int dim>
struct Effect
{
  std::function<bool(const Vector<dim>&, const Vector<dim>&)> cuts;
  std::function<bool(const Vector<dim>&)> takes_out = {}; ///< of an open flaw
  /// Normal of the plane of a closed flaw where it cuts.
  std::function<Vector<dim>(const Vector<dim>&, const Vector<dim>&)> normal = {};
};

/// A hole cuts a line whose middle it takes out.
template <int dim, typename Inside>
Effect<dim> hole_of(const Inside& inside)
{
  return {[=](const Vector<dim>& a, const Vector<dim>& b) { return inside(0.5 * (a + b)); }, inside};
}

template <int dim>
Effect<dim> effect_of(const EllipseHole& hole)
{
  const Vector<2> first(std::cos(hole.angle), std::sin(hole.angle));
  const Vector<2> second(-first[1], first[0]);
  const auto inside = [=](const Vector<dim>& point) {
    const Vector<2> from_centre = in_plane<dim>(point) - hole.centre;
    return std::hypot(from_centre.dot(first) / hole.semi_axes[0], from_centre.dot(second) / hole.semi_axes[1]) < 1.0;
  };
  return hole_of<dim>(inside);
}

template <int dim>
Effect<dim> effect_of(const PolygonHole& hole)
{
  const auto inside = [=](const Vector<dim>& point) { return is_inside(hole.corners, in_plane<dim>(point)); };
  return hole_of<dim>(inside);
}

template <int dim>
Effect<dim> effect_of(const SphereHole& hole)
{
  const auto inside = [=](const Vector<dim>& point) {
    if constexpr (dim == 3)
      return (point - hole.centre).norm() < hole.radius;
    else
      return false;
  };
  return hole_of<dim>(inside);
}

template <int dim>
Effect<dim> effect_of(const Slot& slot)
{
  const Vector<2> way = slot.to - slot.from;
  const double length = way.norm();
  const Vector<2> along = way / length;
  const auto inside = [=](const Vector<dim>& point) {
    const Vector<2> from_start = in_plane<dim>(point) - slot.from;
    const double s = from_start.dot(along);
    return s >= 0.0 && s <= length && (from_start - s * along).norm() < 0.5 * slot.width;
  };
  return {[=](const Vector<dim>& a, const Vector<dim>& b) {
            return cross(in_plane<dim>(a), in_plane<dim>(b), slot.from, slot.to);
          },
          inside};
}

template <int dim>
Effect<dim> effect_of(const ClosedFlaw& flaw)
{
  // The part of the line that is met first in its order; as many as parts where none is.
  const auto part_across = [=](const Vector<dim>& a, const Vector<dim>& b) {
    std::size_t k = 0;
    while (k + 1 < flaw.points.size() && !cross(in_plane<dim>(a), in_plane<dim>(b), flaw.points[k], flaw.points[k + 1]))
      ++k;
    return k;
  };
  return {[=](const Vector<dim>& a, const Vector<dim>& b) { return part_across(a, b) + 1 < flaw.points.size(); },
          {},
          [=](const Vector<dim>& a, const Vector<dim>& b) {
            const std::size_t k = part_across(a, b);
            const Vector<2> along = (flaw.points[k + 1] - flaw.points[k]).normalized();
            Vector<dim> normal = Vector<dim>::Zero();
            normal[0] = -along[1];
            normal[dim - 1] = along[0];
            return normal;
          }};
}

template <int dim>
Effect<dim> effect_of(const DiscFlaw& disc)
{
  return {[=](const Vector<dim>& a, const Vector<dim>& b) {
            if constexpr (dim == 3)
              {
                const double above_a = (a - disc.centre).dot(disc.normal);
                const double above_b = (b - disc.centre).dot(disc.normal);
                if (above_a * above_b > 0.0 || above_a == above_b)
                  return false;
                return (a + above_a / (above_a - above_b) * (b - a) - disc.centre).norm() <= disc.radius;
              }
            else
              return false;
          },
          {},
          [=](const Vector<dim>&, const Vector<dim>&) {
            if constexpr (dim == 3)
              return disc.normal;
            else
              return Vector<dim>(Vector<dim>::Zero());
          }};
}

template <int dim>
Effect<dim> effect_of(const JointSet&)
{
  return {}; // its flaws are closed flaws
}

template <int dim>
Effect<dim> effect_of(const DiscSet&)
{
  return {}; // its flaws are disc flaws
}

/// The joints that a shape meets; of a periodic body also where they lie from their second grain.
template <int dim>
std::vector<bool> joints_cut(const Specimen<dim>& specimen, const Effect<dim>& effect)
{
  const auto& joints = specimen.joints;
  std::vector<bool> cut(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    {
      const Vector<dim> branch = (joints.rest_distance[j] + joints.opening[j]) * at<dim>(joints.normal, j);
      const Vector<dim> one = at<dim>(specimen.grains.position, joints.grain_1[j]);
      cut[j] = effect.cuts(one, one + branch);
      if (specimen.is_periodic() && !cut[j])
        {
          const Vector<dim> two = at<dim>(specimen.grains.position, joints.grain_2[j]);
          cut[j] = effect.cuts(two - branch, two);
        }
    }
  return cut;
}

/// Returns which grains belong to the largest piece, connected by joints whether bonded or not; [n_grains].
template <int dim>
std::vector<bool> in_largest_piece(const Specimen<dim>& specimen)
{
  DisjointSets sets = connected_grains(specimen, Faces::all);
  const std::uint32_t largest = sets.largest();
  std::vector<bool> within(specimen.grains.size());
  for (std::uint32_t i = 0; i < within.size(); ++i)
    within[i] = sets.root(i) == largest;
  return within;
}

/// Removes joints; `dropped` says for each joint whether it is removed.
template <int dim>
void drop_joints(Specimen<dim>& specimen, const std::vector<bool>& dropped)
{
  specimen.joints.keep_if([&](const std::size_t j) { return !dropped[j]; });
  specimen.report.n_joints = specimen.n_joints();
  specimen.report.coordination_number = 2.0 * double(specimen.n_joints()) / double(specimen.grains.size());
}

/// Takes out grains and faces. A part that was connected with the body and is separated from it is taken out too where
/// it is a crumb.
template <int dim>
void open(Specimen<dim>& specimen, const Effect<dim>& effect, const bool may_take_no_grain, Flaw<dim>& flaw)
{
  const std::vector<bool> cut = joints_cut(specimen, effect);
  const std::vector<bool> of_body = in_largest_piece(specimen);
  const std::size_t n_grains = specimen.grains.size();
  std::vector<bool> kept(n_grains);
  for (std::uint32_t i = 0; i < n_grains; ++i)
    kept[i] = !effect.takes_out(at<dim>(specimen.grains.position, i));
  const auto n_kept = std::size_t(std::count(kept.begin(), kept.end(), true));
  const auto n_cut = std::size_t(std::count(cut.begin(), cut.end(), true));
  if (n_kept == n_grains && (!may_take_no_grain || n_cut == 0))
    throw InputError("takes out no grain: it is smaller than the grains, or lies between them");
  if (2 * n_kept < n_grains)
    throw InputError("takes out more than half of the grains");

  const std::size_t n_joints = specimen.joints.size();
  drop_joints(specimen, cut);
  // The rest of the body: pieces without a face to the largest are held by nothing.
  Specimen<dim> rest = part_of(specimen, kept);
  std::vector<std::uint32_t> old_number;
  for (std::uint32_t i = 0; i < n_grains; ++i)
    if (kept[i])
      old_number.push_back(i);
  DisjointSets sets = connected_grains(rest, Faces::all);
  const auto sizes = sets.sizes();
  const std::uint32_t largest = sets.largest();
  std::vector<bool> stays(rest.grains.size(), true);
  for (std::uint32_t i = 0; i < rest.grains.size(); ++i)
    if (const std::uint32_t root = sets.root(i); root != largest && of_body[old_number[i]])
      {
        if (sizes[root] > largest_crumb)
          {
            const Vector<2> where = 1e3 * in_plane<dim>(at<dim>(rest.grains.position, i));
            throw InputError("leaves a free piece of {} grains, near ({:.3g}, {:.3g}) mm, which nothing "
                             "would hold; shorten the shape or leave a bridge",
                             sizes[root], where[0], where[1]);
          }
        stays[i] = false;
      }
  specimen = part_of(std::move(rest), stays);
  flaw.n_grains = n_grains - specimen.grains.size();
  flaw.n_joints = n_joints - specimen.joints.size();
}

template <int dim>
void unbond(Specimen<dim>& specimen, const Effect<dim>& effect, Flaw<dim>& flaw)
{
  const std::vector<bool> cut = joints_cut(specimen, effect);
  auto& joints = specimen.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (cut[j])
      {
        for (unsigned int i = 0; i < joints.n_segments; ++i)
          joints.bonded[joints.segment(i, j)] = 0.0;
        ++flaw.n_joints;
      }
}

/// Area of the plane of a closed flaw within the specimen [m²].
template <int dim>
double area_of(const Shape& shape, const Specimen<dim>& specimen)
{
  if (const auto* disc = std::get_if<DiscFlaw>(&shape))
    return std::numbers::pi * disc->radius * disc->radius;
  const std::vector<Vector<2>> points = outline(shape);
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    length += (points[k + 1] - points[k]).norm();
  return length * (dim == 2 ? specimen.thickness : specimen.size[1]);
}

/// The faces that it crosses share its area; beside it no grain hooks on another.
template <int dim>
void make_smooth(Specimen<dim>& specimen, const Shape& shape, const Effect<dim>& effect, const SmoothSides& sides,
                 const SmoothJointParameters& all, Flaw<dim>& flaw)
{
  if (specimen.is_periodic())
    throw InputError("has smooth joints, which a periodic specimen cannot have; leave out its word smooth");
  const SmoothJointParameters wanted = sides.among(all);
  if (const std::string what = objection(wanted); !what.empty())
    throw InputError(what);
  const auto& joints = specimen.joints;
  const std::vector<bool> cut = joints_cut(specimen, effect);
  std::vector<SmoothPlace<dim>> places;
  double sum = 0.0;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (cut[j])
      {
        const Vector<dim> one = at<dim>(specimen.grains.position, joints.grain_1[j]);
        const Vector<dim> two = at<dim>(specimen.grains.position, joints.grain_2[j]);
        places.push_back({j, effect.normal(one, two), joints.face_area(j)});
        sum += places.back().area;
      }
  // Faces keep their own areas in a cylinder, and where a disc reaches out of the body.
  if (!specimen.is_round() && objection<dim>(shape, specimen.size).empty())
    for (auto& place : places)
      place.area *= area_of(shape, specimen) / sum;
  flaw.n_joints = places.size();
  put_smooth_joints(specimen, places, wanted, sides.are_bonded());
  keep_apart<dim>(specimen, effect.cuts);
}

template <int dim>
void put_in(Specimen<dim>& specimen, const Shape& shape, const SmoothJointParameters& smooth)
{
  Flaw<dim> flaw{std::string(name(shape)), is_open(shape), {}, 0, 0};
  for (const Vector<2>& point : outline(shape))
    {
      Vector<dim> placed = 0.5 * specimen.size;
      placed[0] = point[0];
      placed[dim - 1] = point[1];
      flaw.outline.push_back(placed);
    }
  const auto effect = std::visit([](const auto& one) { return effect_of<dim>(one); }, shape);
  if (flaw.open)
    open(specimen, effect, std::holds_alternative<Slot>(shape), flaw);
  else if (const SmoothSides* sides = smooth_sides(shape))
    make_smooth(specimen, shape, effect, *sides, smooth, flaw);
  else
    unbond(specimen, effect, flaw);
  specimen.flaws.push_back(std::move(flaw));
}

/// The flaws of a set; nothing of another shape.
template <int dim>
std::optional<std::vector<Shape>> members_of(const Shape& shape, const Vector<dim>& size)
{
  if (const auto* const set = std::get_if<JointSet>(&shape))
    {
      const auto flaws = traces(*set, in_plane<dim>(size));
      return std::vector<Shape>(flaws.begin(), flaws.end());
    }
  if constexpr (dim == 3)
    if (const auto* const set = std::get_if<DiscSet>(&shape))
      {
        const auto flaws = discs(*set, size);
        return std::vector<Shape>(flaws.begin(), flaws.end());
      }
  return std::nullopt;
}

std::string title(const std::vector<Shape>& shapes, const std::size_t k)
{
  return fmt::format("shape {}, {}", k + 1, name(shapes[k]));
}
} // namespace

template <int dim>
void put_in_flaws(Specimen<dim>& specimen, const std::vector<Shape>& shapes, const SmoothJointParameters& smooth)
{
  if (shapes.empty())
    return;
  if (const std::string what = objection<dim>(shapes, specimen.size); !what.empty())
    throw ParameterError(parameters_id<FlawParameters>(), what);
  for (std::size_t k = 0; k < shapes.size(); ++k)
    try
      {
        if (const auto members = members_of<dim>(shapes[k], specimen.size))
          {
            std::uint64_t n_joints = 0;
            for (const Shape& flaw : *members)
              {
                put_in(specimen, flaw, smooth);
                specimen.flaws.back().name = name(shapes[k]);
                n_joints += specimen.flaws.back().n_joints;
              }
            if (n_joints == 0)
              throw InputError("crosses no joint of the specimen");
          }
        else if (const auto* const trace = std::get_if<ClosedFlaw>(&shapes[k]); trace && trace->map_layer)
          {
            // A stub at a side may lie between grains, as no trace that the body holds whole.
            const auto parts = parts_inside(*trace, in_plane<dim>(specimen.size));
            for (const ClosedFlaw& part : parts)
              {
                put_in(specimen, Shape(part), smooth);
                if (part.points == trace->points && specimen.flaws.back().n_joints == 0)
                  throw InputError("crosses no joint: it is smaller than the grains, or lies between them");
                if (specimen.flaws.back().n_joints == 0)
                  specimen.flaws.pop_back();
              }
          }
        else
          {
            put_in(specimen, shapes[k], smooth);
            if (const auto& flaw = specimen.flaws.back(); !flaw.open && flaw.n_joints == 0)
              throw InputError("crosses no joint: it is smaller than the grains, or lies between them");
          }
      }
    catch (const InputError& error)
      {
        throw ParameterError(parameters_id<FlawParameters>(), fmt::format("{}: {}", title(shapes, k), error.what()));
      }
  // Numbers of joints are places in lists; those of the ones taken out are free.
  specimen.number_joints();
}

template <int dim>
std::string objection(const std::vector<Shape>& shapes, const Vector<dim>& size)
{
  for (std::size_t k = 0; k < shapes.size(); ++k)
    if (const std::string what = objection<dim>(shapes[k], size); !what.empty())
      return fmt::format("{}: {}", title(shapes, k), what);
  bool has_map = false;
  for (const Shape& shape : shapes)
    if (const auto* const trace = std::get_if<ClosedFlaw>(&shape); trace && trace->map_layer)
      {
        has_map = true;
        if (!parts_inside(*trace, in_plane<dim>(size)).empty())
          return "";
      }
  return has_map
           ? fmt::format("no trace of the map lies in the specimen, which reaches from 0 to {:.4g}, {:.4g} mm; see the "
                         "entries on its origin, angle and scale",
                         1e3 * size[0], 1e3 * size[dim - 1])
           : "";
}

template void put_in_flaws<2>(Specimen<2>&, const std::vector<Shape>&, const SmoothJointParameters&);
template void put_in_flaws<3>(Specimen<3>&, const std::vector<Shape>&, const SmoothJointParameters&);
template std::string objection<2>(const std::vector<Shape>&, const Vector<2>&);
template std::string objection<3>(const std::vector<Shape>&, const Vector<3>&);
} // namespace feldspar
