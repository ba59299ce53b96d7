#include "dem/dynamics/walls.h"

#include "base/mapped.h"
#include "dem/laws/linear_contact_law.h"
#include "dem/laws/pivoting_plate.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace feldspar
{
namespace
{
/// A direction in which a grain slides along a plane, and the rotation by which its contact does so too.
struct Tangent
{
  int along;
  double sign; ///< 1 or -1, along the axis
  int about;
  double arm; ///< [m]
};

/// The wall is grain 1, without rotation; n points from it to the grain. In the plane t = n turned by +90°; in space the two
/// other axes in cyclic order. The contact lies at -d n from the centre: v + ω × (-d n).
template <int dim>
std::array<Tangent, dim - 1> tangents(const Wall& wall, const double distance)
{
  if constexpr (dim == 2)
    return {{{1 - wall.axis, wall.axis == 0 ? wall.side : -wall.side, 0, distance}}};
  else
    {
      const int one = (wall.axis + 1) % 3, two = (wall.axis + 2) % 3;
      return {{{one, 1.0, two, distance * wall.side}, {two, 1.0, one, -(distance * wall.side)}}};
    }
}

/// Distance of a grain from the middle of a plate that pivots [m]; 0 for other walls.
template <int dim>
double lever_of(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  return wall.pivots ? body.grains.position[extent_axis<dim>(wall)][grain] - wall.middle() : 0.0;
}

/// Distance of a grain from a wall, along `side` [m].
template <int dim>
double distance_from(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain, const double lever)
{
  return (wall_coordinate(body, wall, grain) - wall.position) * wall.side + wall.tilt * lever;
}

template <int dim>
double distance_from(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  return distance_from(body, wall, grain, lever_of(body, wall, grain));
}

/// Returns whether a grain stands above the plate, which may end.
template <int dim>
bool is_above(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  const double place = body.grains.position[extent_axis<dim>(wall)][grain];
  return wall.round || (place >= wall.extent[0] && place <= wall.extent[1]);
}

/// Returns whether a grain stands beyond the ends of a plate that pivots by at most half a width.
template <int dim>
bool is_beside(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  return std::abs(lever_of(body, wall, grain)) <= wall.extent[1] - wall.extent[0];
}

/// Returns whether a grain has come round the end of a plate so far that it is not pressed any more.
template <int dim>
bool is_past(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  return wall.ends() && distance_from(body, wall, grain) < 0.5 * body.grains.radius[grain];
}
} // namespace

template <int dim>
Vector<dim> wall_direction(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  if (!wall.round)
    return Vector<dim>::Unit(wall.axis);
  Vector<dim> from_axis = at<dim>(body.grains.position, grain) - 0.5 * body.size;
  from_axis[dim - 1] = 0.0;
  return from_axis.normalized();
}

template <int dim>
double wall_coordinate(const Specimen<dim>& body, const Wall& wall, const std::uint32_t grain)
{
  if (!wall.round)
    return body.grains.position[wall.axis][grain];
  return body.distance_from_axis(at<dim>(body.grains.position, grain));
}

template <int dim>
double gap_at(const Specimen<dim>& body, const Wall& wall, const std::vector<bool>& counts)
{
  double smallest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < body.grains.size(); ++i)
    if (counts[i] && is_above(body, wall, i))
      smallest = std::min(smallest, distance_from(body, wall, i) - body.grains.radius[i]);
  return smallest;
}

template <int dim>
std::size_t Walls<dim>::add(const Wall& wall)
{
  if (wall.pivots && !std::isfinite(wall.middle()))
    throw std::logic_error("a plate that pivots needs two ends");
  walls.push_back(wall);
  touches.emplace_back();
  forces.push_back(0.0);
  position_at_search.push_back(wall.position);
  tilt_at_search.push_back(wall.tilt);
  return walls.size() - 1;
}

template <int dim>
double Walls<dim>::stiffness(const Specimen<dim>& body, const double radius)
{
  const double modulus = body.particle_contact.modulus;
  return dim == 2 ? 2.0 * modulus * body.thickness : std::numbers::pi * modulus * radius;
}

template <int dim>
double Walls<dim>::stiffness_in_touch(const Specimen<dim>& body, const std::size_t wall) const
{
  if (!shared_stiffnesses.empty())
    return shared_stiffnesses[wall];
  const auto all = stiffnesses_in_touch(body, wall);
  return std::accumulate(all.begin(), all.end(), 0.0);
}

template <int dim>
std::vector<double> Walls<dim>::pressures(const std::size_t wall) const
{
  return mapped<double>(touches[wall], &WallTouch<dim>::normal_force);
}

template <int dim>
std::vector<double> Walls<dim>::stiffnesses_in_touch(const Specimen<dim>& body, const std::size_t wall) const
{
  return mapped<double>(touches[wall], [&](const WallTouch<dim>& touch) {
    return touch.overlap > 0.0 ? stiffness(body, body.grains.radius[touch.grain]) : 0.0;
  });
}

template <int dim>
void Walls<dim>::set_sums(const std::size_t wall, const std::vector<double>& pressures,
                          const std::vector<double>& stiffnesses)
{
  forces[wall] = std::accumulate(pressures.begin(), pressures.end(), 0.0);
  shared_stiffnesses.resize(walls.size());
  shared_stiffnesses[wall] = std::accumulate(stiffnesses.begin(), stiffnesses.end(), 0.0);
}

template <int dim>
void Walls<dim>::search(const Specimen<dim>& body, const GrainRange& own, const double skin, const ZeroForce zero_force,
                        EnergyLedger& ledger)
{
  const auto& radius = body.grains.radius;
  const bool placing = zero_force == ZeroForce::as_placed;
  for (std::size_t w = 0; w < walls.size(); ++w)
    {
      const auto& before = touches[w]; // ascending, as `near` will be
      auto known = before.begin();
      std::vector<WallTouch<dim>> near;
      // Energy of a grain that is still pressed where it crosses the end of a plate becomes vibration, which is soon
      // damped.
      const auto lose = [&](const WallTouch<dim>& touch) {
        ledger.slip_of_lost_contacts.add(touch.slip_energy + stored_energy(body, touch));
      };
      for (std::uint32_t i = own.first; i < own.end; ++i)
        {
          for (; known != before.end() && known->grain < i; ++known)
            lose(*known);
          const bool is_known = known != before.end() && known->grain == i;
          const double lever = is_known ? known->lever : lever_of(body, walls[w], i);
          const double distance = distance_from(body, walls[w], i, lever);
          const bool is_bedded = is_known ? known->zero_distance > radius[i]
                                          : placing && distance > radius[i] && distance <= radius[i] + walls[w].bed;
          const bool is_held = is_known && walls[w].pivots && (known->overlap > 0.0 || is_beside(body, walls[w], i));
          if ((distance > radius[i] + skin && !is_bedded) || (!is_held && !is_above(body, walls[w], i)))
            continue;
          if (!is_known && is_past(body, walls[w], i))
            continue;
          if (is_known)
            near.push_back(*known++);
          else if (is_bedded)
            near.push_back({i, distance, lever});
          else
            // A grain that came from beside a plate may lie deeper than its face: it is not thrown out.
            near.push_back({i, placing || walls[w].ends() ? std::min(radius[i], distance) : radius[i], lever});
        }
      for (; known != before.end(); ++known)
        lose(*known);
      touches[w] = std::move(near);
      position_at_search[w] = walls[w].position;
      tilt_at_search[w] = walls[w].tilt;
    }
}

template <int dim>
void Walls<dim>::clear()
{
  for (auto& list : touches)
    list.clear();
}

template <int dim>
double Walls<dim>::way_since_search(const std::size_t wall) const
{
  const Wall& plate = walls[wall];
  const double way = std::abs(plate.position - position_at_search[wall]);
  return plate.pivots ? way + std::abs(plate.tilt - tilt_at_search[wall]) * (plate.extent[1] - plate.middle()) : way;
}

template <int dim>
double Walls<dim>::smallest_gap_not_listed(const Specimen<dim>& body, const GrainRange& own,
                                           const std::size_t wall) const
{
  double smallest = std::numeric_limits<double>::max();
  auto listed = touches[wall].begin(); // in the order of the grains
  for (std::uint32_t i = own.first; i < own.end; ++i)
    if (listed != touches[wall].end() && listed->grain == i)
      ++listed;
    else if (is_above(body, walls[wall], i) && !is_past(body, walls[wall], i))
      smallest = std::min(smallest, distance_from(body, walls[wall], i) - body.grains.radius[i]);
  return smallest;
}

template <int dim>
double Walls<dim>::stored_energy(const Specimen<dim>& body, const WallTouch<dim>& touch) const
{
  const double k_n = stiffness(body, body.grains.radius[touch.grain]);
  double sum = 0.5 * k_n * touch.overlap * touch.overlap;
  for (const double shear : touch.shear_force)
    sum += 0.5 * shear * shear / (k_n / body.particle_contact.stiffness_ratio);
  return sum;
}

template <int dim>
void Walls<dim>::balance(const Specimen<dim>& body, const BodyShare<dim>& share, const std::size_t wall)
{
  Wall& plate = walls[wall];
  constexpr double at_pivot = 0.0; // where a plate has the distance that it has everywhere when it is level
  const auto springs = mapped<SpringOnPlate>(touches[wall], [&](const WallTouch<dim>& touch) {
    return SpringOnPlate{stiffness(body, body.grains.radius[touch.grain]), touch.lever,
                         touch.zero_distance - distance_from(body, plate, touch.grain, at_pivot)};
  });
  plate.tilt = balanced_tilt(share.gathered(springs), plate.tilt);
}

template <int dim>
bool Walls<dim>::press(const double dt, Specimen<dim>& body, const BodyShare<dim>& share)
{
  auto& grains = body.grains;
  bool contact_made = false;
  for (std::size_t w = 0; w < walls.size(); ++w)
    {
      if (walls[w].pivots)
        balance(body, share, w);
      const Wall& wall = walls[w];
      double sum = 0.0;
      for (auto& touch : touches[w])
        {
          const std::uint32_t i = touch.grain;
          const double distance = distance_from(body, wall, i, touch.lever);
          const double k_n = stiffness(body, grains.radius[i]);
          const double overlap = touch.zero_distance - distance;
          if (touch.overlap == 0.0 && overlap > 0.0)
            contact_made = true;
          // A grain that comes into contact, or a smooth wall, gathers no shear.
          std::array<double, dim - 1> slip{};
          const auto directions = tangents<dim>(wall, distance);
          for (int c = 0; c < dim - 1 && wall.friction > 0.0 && touch.overlap > 0.0; ++c)
            {
              const auto& [along, sign, about, arm] = directions[c];
              slip[c] = dt * (sign * grains.velocity[along][i] - arm * grains.spin[about][i]);
            }
          const auto response = linear_contact::update<dim, double>({k_n, k_n / body.particle_contact.stiffness_ratio},
                                                                    wall.friction, touch.shear_force, overlap, slip);
          touch.overlap = std::max(0.0, overlap);
          touch.shear_force = response.shear_force;
          touch.slip_energy += response.slip_energy;
          touch.normal_force = response.normal_force;
          if (wall.round)
            set<dim>(grains.force, i,
                     at<dim>(grains.force, i) + wall.side * response.normal_force * wall_direction(body, wall, i));
          else
            grains.force[wall.axis][i] += wall.side * response.normal_force;
          for (int c = 0; c < dim - 1 && wall.friction > 0.0; ++c)
            {
              const auto& [along, sign, about, arm] = directions[c];
              grains.force[along][i] += sign * response.shear_force[c];
              grains.couple[about][i] -= arm * response.shear_force[c];
            }
          sum += response.normal_force;
        }
      forces[w] = sum;
    }
  return contact_made;
}

template <int dim>
void Walls<dim>::add_energies(EnergySums& sums, const Specimen<dim>& body) const
{
  for_each_touch([&](const Wall&, const WallTouch<dim>& touch) {
    sums.slip.add(touch.slip_energy);
    sums.strain.add(stored_energy(body, touch));
  });
}

template Vector<2> wall_direction<2>(const Specimen<2>&, const Wall&, std::uint32_t);
template Vector<3> wall_direction<3>(const Specimen<3>&, const Wall&, std::uint32_t);
template double wall_coordinate<2>(const Specimen<2>&, const Wall&, std::uint32_t);
template double wall_coordinate<3>(const Specimen<3>&, const Wall&, std::uint32_t);
template double gap_at<2>(const Specimen<2>&, const Wall&, const std::vector<bool>&);
template double gap_at<3>(const Specimen<3>&, const Wall&, const std::vector<bool>&);
template class Walls<2>;
template class Walls<3>;
} // namespace feldspar
