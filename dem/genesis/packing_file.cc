#include "dem/genesis/packing_file.h"

#include "base/input_error.h"
#include "base/parameter_id.h"
#include "dem/genesis/packing_table.h"
#include "dem/specimen/periodic_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace feldspar
{
namespace
{
constexpr double largest_overlap = 0.05;  // of the smaller radius
constexpr double largest_gap_ratio = 1.0; // of bonded grains, over the mean radius: the largest that can get a joint

/// Throws InputError for two grains that overlap by more than is allowed; of a periodic packing across its sides too.
template <int dim>
void check_overlaps(const Grains<dim>& own, const SpecimenParameters& wanted, const std::vector<std::size_t>& line_of,
                    const std::function<void()>& check)
{
  Tensor<dim> cell = wanted.width * Tensor<dim>::Identity();
  cell(dim - 1, dim - 1) = wanted.height;
  const auto images = is_periodic(wanted.shape) ? images_within(own, cell, 0.0) : std::vector<PeriodicImage<dim>>();
  const Grains<dim> grains = with_images(own, images, cell);
  for_each_pair_within<dim>(
    grains, 0.0,
    [&](const GrainPair& pair) {
      const auto& [one, two] = pair;
      if (one >= own.size()) // two images, which overlap as their owners do
        return;
      const double overlap = grains.radius[one] + grains.radius[two] -
                             (at<dim>(grains.position, two) - at<dim>(grains.position, one)).norm();
      const double allowed = largest_overlap * std::min(grains.radius[one], grains.radius[two]);
      if (overlap <= allowed)
        return;
      const bool across = two >= own.size();
      const auto [first, second] = std::minmax(line_of[one], line_of[across ? images[two - own.size()].owner : two]);
      throw InputError("{}:{}: overlaps {} by {:.3g} m{}; allowed are {:.0f} % of the smaller radius, {:.3g} "
                       "m",
                       wanted.packing_file, second,
                       first == second ? "its own image" : fmt::format("the grain of line {}", first), overlap,
                       across ? " across the sides of the periodic box" : "", 100.0 * largest_overlap, allowed);
    },
    check);
}

/// Throws InputError for a grain that reaches through a wall of the specimen by more than grains may overlap: the wall would cut
/// it, and what it cuts off would be there without a force.
template <int dim>
void check_walls(const Grains<dim>& grains, const SpecimenParameters& wanted, const std::vector<std::size_t>& line_of)
{
  const bool is_round = wanted.shape == BodyShape::cylinder;
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const Vector<dim> x = at<dim>(grains.position, i);
      const double radius = grains.radius[i];
      const double allowed = largest_overlap * radius;
      const auto check_inside = [&](const double overlap, const std::string_view wall) {
        if (overlap > allowed)
          throw InputError("{}:{}: reaches through the {} by {:.3g} m; allowed are {:.0f} % of the radius, {:.3g} "
                           "m: make {} and {} those of the grains",
                           wanted.packing_file, line_of[i], wall, overlap, 100.0 * largest_overlap, allowed,
                           in_words(parameter_id<&SpecimenParameters::width>()),
                           entry_in_words(parameter_id<&SpecimenParameters::height>()));
      };
      for (int axis = is_round ? dim - 1 : 0; axis < dim; ++axis)
        {
          const bool is_end = axis == dim - 1;
          check_inside(radius - x[axis], is_end ? "lower end" : axis == 0 ? "left side" : "front side");
          check_inside(x[axis] + radius - (is_end ? wanted.height : wanted.width), is_end      ? "upper end"
                                                                                   : axis == 0 ? "right side"
                                                                                               : "back side");
        }
      if (is_round)
        check_inside(std::hypot(x[0] - 0.5 * wanted.width, x[1] - 0.5 * wanted.width) + radius - 0.5 * wanted.width,
                     "round side");
    }
}
/// A place along an axis; in a periodic cell that of the image inside it, whose two sides are one place.
double wrapped(const double x, const double length)
{
  const double inside = x - length * std::floor(x / length);
  return inside < length ? inside : 0.0;
}

/// The pairs that bonds join, in ascending order; throws InputError for a bond between grains too far apart for a joint.
template <int dim>
std::vector<GrainPair> pairs_of(const std::vector<PackedBond>& bonds, const Grains<dim>& grains,
                                const SpecimenParameters& wanted)
{
  Vector<dim> size = Vector<dim>::Constant(wanted.width);
  size[dim - 1] = wanted.height;
  std::vector<GrainPair> pairs;
  for (const auto& [line, first, second] : bonds)
    {
      Vector<dim> branch = at<dim>(grains.position, second) - at<dim>(grains.position, first);
      if (is_periodic(wanted.shape))
        branch -= (size.array() * (branch.array() / size.array()).round()).matrix();
      const double gap = branch.norm() - grains.radius[first] - grains.radius[second];
      if (const double allowed = largest_gap_ratio * grains.mean_radius(); gap > allowed)
        throw InputError("{}:{}: a bond joins grains with a gap of {:.3g} m; allowed is the mean radius, "
                         "{:.3g} m",
                         wanted.packing_file, line, gap, allowed);
      pairs.emplace_back(std::minmax(std::uint32_t(first), std::uint32_t(second)));
    }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}
} // namespace

template <int dim>
Packing<dim> read_packing(const SpecimenParameters& wanted, const std::function<void()>& check)
{
  constexpr double most_cells_away = 1000.0; // of a grain that has crossed sides of a periodic cell
  const PackingTable table = read_packing_table(wanted.packing_file, dim, wanted.packing_unit, check);
  std::vector<double> radii;
  Components<dim> positions;
  std::vector<std::size_t> line_of;
  if (!wanted.packing_shift.empty() && wanted.packing_shift.size() != std::size_t(dim))
    throw ParameterError(parameter_id<&SpecimenParameters::packing_shift>(),
                         fmt::format("{} lengths; there must be {}", wanted.packing_shift.size(), dim));
  for (auto [line, values, radius] : table.grains)
    {
      const std::string where = fmt::format("{}:{}", wanted.packing_file, line);
      if (radius <= 0.0)
        throw InputError("{}: radius {} m; a radius must be greater than 0", where, radius);
      for (int c = 0; c < dim; ++c)
        {
          const double length = c == dim - 1 ? wanted.height : wanted.width;
          values[c] += wanted.packing_shift.empty() ? 0.0 : wanted.packing_shift[c];
          const bool is_wrapped = is_periodic(wanted.shape) && std::abs(values[c]) <= most_cells_away * length;
          if (!is_wrapped && (values[c] < 0.0 || values[c] > length))
            throw InputError("{}: {} = {} m lies outside the specimen; allowed are 0 to {} m; {} and {} "
                             "bring grains of another unit or origin there",
                             where, "xyz"[c], values[c], length,
                             in_words(parameter_id<&SpecimenParameters::packing_unit>()),
                             in_words(parameter_id<&SpecimenParameters::packing_shift>()));
          // Before it has an image in each of very many boxes.
          if (const double overlap = 2.0 * radius - length;
              is_periodic(wanted.shape) && overlap > largest_overlap * radius)
            throw InputError("{}: overlaps its own image by {:.3g} m across the sides of the periodic box; "
                             "allowed are {:.0f} % of the radius, {:.3g} m",
                             where, overlap, 100.0 * largest_overlap, largest_overlap * radius);
          positions[c].push_back(is_wrapped ? wrapped(values[c], length) : values[c]);
        }
      if (wanted.shape == BodyShape::cylinder)
        if (const double r = std::hypot(values[0] - 0.5 * wanted.width, values[1] - 0.5 * wanted.width);
            r > 0.5 * wanted.width)
          throw InputError("{}: lies {} m from the axis of the cylinder; allowed are 0 to {} m", where, r,
                           0.5 * wanted.width);
      radii.push_back(radius);
      line_of.push_back(line);
    }
  if (radii.size() < 2)
    throw InputError("{}: {} grains; a packing has at least two", wanted.packing_file, radii.size());

  Packing<dim> packing;
  packing.grains.place(radii, positions);
  check_overlaps(packing.grains, wanted, line_of, check);
  if (!is_periodic(wanted.shape) && !wanted.is_cored())
    check_walls(packing.grains, wanted, line_of);
  packing.bonds = pairs_of(table.bonds, packing.grains, wanted);
  return packing;
}

template Packing<2> read_packing<2>(const SpecimenParameters&, const std::function<void()>&);
template Packing<3> read_packing<3>(const SpecimenParameters&, const std::function<void()>&);
} // namespace feldspar
