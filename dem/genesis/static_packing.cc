#include "dem/genesis/static_packing.h"

#include "base/parallel.h"
#include "base/parameter_id.h"
#include "dem/dynamics/walls.h"
#include "dem/laws/face_elements.h"
#include "dem/specimen/neighbours.h"
#include "dem/specimen/periodic_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

namespace feldspar
{
namespace
{
constexpr double packing_stress_tolerance = 1e-3; // of the packing stress
// Mean unbalanced over mean contact force. Joints begin without force, so that what is left moves no grain: it stands
// for 5e-3 of an overlap, 1e-6 of a radius.
constexpr double force_tolerance = 5e-3;

/// Stress of the dense packing as a share of the contact modulus. Grains are pressed together until they overlap by
/// half a percent of a radius, and then unloaded to the packing stress; otherwise the result would depend on the
/// requested porosity.
template <int dim>
constexpr double dense_stress_ratio = dim == 2 ? 3e-3 : 2e-3;

/// Forces balanced to this end the pressing: the longer it lasts, the denser the packing. Chosen so that packings are as
/// dense as those of damped dynamics.
template <int dim>
constexpr double pressed_tolerance = dim == 2 ? 5e-3 : 1e-2;

constexpr unsigned int most_iterations = 200000;

/// Another grain in reach.
struct Neighbour
{
  std::uint32_t grain;
  std::uint32_t box; ///< number of the shift to the box in which it lies
  double stiffness;  ///< of the contact, radii as drawn [N/m]
};

/// Sums over grains and contacts, the growth of the radii included.
struct Sums
{
  double power = 0.0;      ///< force times velocity
  double push = 0.0;       ///< force squared over inertia
  double motion = 0.0;     ///< inertia times velocity squared
  double virial = 0.0;     ///< Σ f·l over contacts and walls [J]
  double carried = 0.0;    ///< Σ |f| over both ends of contacts [N]
  double n_ends = 0.0;     ///< of contacts between grains
  double unbalanced = 0.0; ///< Σ |F| over grains [N]

  Sums& operator+=(const Sums& other)
  {
    power += other.power;
    push += other.push;
    motion += other.motion;
    virial += other.virial;
    carried += other.carried;
    n_ends += other.n_ends;
    unbalanced += other.unbalanced;
    return *this;
  }
};

/// The coordinates of the descent and their forces. Time, velocity and inertia are means of the descent (FIRE: Bitzek et
/// al. 2006, doi:10.1103/PhysRevLett.97.170201), not of the grains: inertia is a stiffness, and time has no unit.
template <int dim>
class Descent
{
public:
  Descent(const Specimen<dim>& loose, const std::function<void()>& check_within)
    : body(loose)
    , check(check_within)
  {
    const auto& all = loose.grains;
    const std::size_t n = all.size();
    grains.resize(n);
    velocity.assign(n, {});
    force.assign(n, {});
    inertia.resize(n);
    const auto order = spatial_order(all);
    for (std::size_t k = 0; k < n; ++k)
      {
        for (int c = 0; c < dim; ++c)
          grains[k][c] = all.position[c][order[k]];
        const double radius = all.radius[order[k]];
        grains[k].back() = radius;
        // Σ k (R1 + R2)² over contacts, its stiffness, is some 12 k R² a grain: slower than the grains, so that it waits.
        growth_inertia += 20.0 * radius * radius *
                          touch_stiffness<dim>(loose.particle_contact.modulus, radius, radius, loose.thickness);
      }
    mean_radius = all.mean_radius();
    largest_radius = *std::ranges::max_element(all.radius);
    skin = 0.2 * mean_radius;
    find_neighbours();
  }

  /// Sums all forces and, where radii grow, the missing part of the wanted stress [Pa].
  Sums sum_forces(const double wanted_stress, const bool radii_grow)
  {
    const double scale = multiplier();
    const double stiffening = dim == 3 ? scale : 1.0; // stiffness grows with the radius in space, not in the plane
    std::vector<Sums> of_block(n_blocks(grains.size()));
    for_each_block(grains.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
      Sums sums;
      for (std::size_t i = begin; i < end; ++i)
        {
          const Place here = grains[i];
          Components sum{};
          for (std::uint32_t e = first[i]; e < first[i + 1]; ++e)
            {
              const Place& there = grains[neighbours[e].grain];
              const Components& shift = shifts[neighbours[e].box];
              Components branch;
              double squared = 0.0;
              for (int c = 0; c < dim; ++c)
                {
                  branch[c] = there[c] + shift[c] - here[c];
                  squared += branch[c] * branch[c];
                }
              const double reach = scale * (here.back() + there.back());
              if (squared >= reach * reach)
                continue;
              const double distance = std::sqrt(squared);
              const double push = stiffening * neighbours[e].stiffness * (reach - distance);
              for (int c = 0; c < dim; ++c)
                sum[c] -= push / distance * branch[c];
              sums.carried += push;
              sums.n_ends += 1.0;
              sums.virial += 0.5 * push * distance;
            }
          const double radius = scale * here.back();
          visit_walls(here, radius, [&](const double distance, const Components& normal) {
            const double push = Walls<dim>::stiffness(body, radius) * (radius - distance);
            for (int c = 0; c < dim; ++c)
              sum[c] += push * normal[c];
            sums.virial += push * distance;
          });
          force[i] = sum;
          double force_squared = 0.0;
          double velocity_squared = 0.0;
          for (int c = 0; c < dim; ++c)
            {
              force_squared += sum[c] * sum[c];
              velocity_squared += velocity[i][c] * velocity[i][c];
              sums.power += sum[c] * velocity[i][c];
            }
          sums.unbalanced += std::sqrt(force_squared);
          sums.push += force_squared / inertia[i];
          sums.motion += velocity_squared * inertia[i];
        }
      of_block[block] = sums;
    });
    Sums all;
    for (const Sums& sums : of_block)
      all += sums;
    // The change of the overlap energy by a growth of all radii by d ln(multiplier), less the wanted stress's work.
    growth_force = dim * body.volume() * wanted_stress - all.virial;
    if (radii_grow)
      {
        all.power += growth_force * growth_velocity;
        all.push += growth_force * growth_force / growth_inertia;
        all.motion += growth_inertia * growth_velocity * growth_velocity;
      }
    return all;
  }

  /// Kicks velocities, of which a share is kept, by the force over so long, then moves.
  void advance(const double time_step, const double keep, const double kick, const bool radii_grow)
  {
    const double longest_way = 0.1 * mean_radius; // first overlaps are as large as grains
    constexpr double most_growth = 1e-3;
    std::vector<double> of_block(n_blocks(grains.size()));
    for_each_block(grains.size(), [&](const std::size_t block, const std::size_t begin, const std::size_t end) {
      double farthest = 0.0;
      for (std::size_t i = begin; i < end; ++i)
        {
          double squared = 0.0;
          for (int c = 0; c < dim; ++c)
            {
              velocity[i][c] = keep * velocity[i][c] + kick / inertia[i] * force[i][c];
              squared += velocity[i][c] * velocity[i][c];
            }
          const double way = time_step * std::sqrt(squared);
          const double share = way > longest_way ? longest_way / way : 1.0;
          double since_search = 0.0;
          for (int c = 0; c < dim; ++c)
            {
              velocity[i][c] *= share;
              grains[i][c] += time_step * velocity[i][c];
              since_search += (grains[i][c] - at_search[i][c]) * (grains[i][c] - at_search[i][c]);
            }
          farthest = std::max(farthest, since_search);
        }
      of_block[block] = farthest;
    });
    if (radii_grow)
      {
        growth_velocity = std::clamp(keep * growth_velocity + kick / growth_inertia * growth_force,
                                     -most_growth / time_step, most_growth / time_step);
        growth += time_step * growth_velocity;
      }
    const double way = std::sqrt(*std::ranges::max_element(of_block));
    const double grown = std::max(0.0, largest_radius * (std::exp(growth) - std::exp(growth_at_search)));
    if (2.0 * (way + grown) > skin)
      find_neighbours();
  }

  void stop_growth() { growth_velocity = 0.0; }

  double multiplier() const { return std::exp(growth); }
  std::size_t n_grains() const { return grains.size(); }
  Grains<dim> result() const
  {
    std::vector<double> radii;
    feldspar::Components<dim> positions;
    for (const Place& grain : grains)
      {
        radii.push_back(multiplier() * grain.back());
        for (int c = 0; c < dim; ++c)
          positions[c].push_back(grain[c]);
      }
    Grains<dim> all;
    all.place(radii, positions);
    return all;
  }

private:
  using Place = std::array<double, 4>; ///< position and, last, radius as drawn [m]: loaded as a whole
  using Components = std::array<double, dim>;

  void find_neighbours()
  {
    const std::size_t n = grains.size();
    for (int c = 0; c < dim; ++c)
      if (body.repeats(c))
        for (Place& grain : grains)
          grain[c] -= body.size[c] * std::floor(grain[c] / body.size[c]);
    const Grains<dim> own = result();
    const auto images = body.is_periodic() ? images_within(own, body.cell(), skin) : std::vector<PeriodicImage<dim>>();
    const Grains<dim> all = with_images(own, images, body.cell());

    std::map<std::array<int, dim>, std::uint32_t> number_of_box;
    shifts.clear();
    const auto box = [&](const std::array<int, dim>& boxes) {
      const auto [entry, is_new] = number_of_box.try_emplace(boxes, std::uint32_t(shifts.size()));
      if (is_new)
        {
          shifts.emplace_back();
          for (int c = 0; c < dim; ++c)
            shifts.back()[c] = boxes[c] * body.size[c];
        }
      return entry->second;
    };
    struct Pair
    {
      std::uint32_t one, two, box, box_back;
    };
    const std::uint32_t same_box = box({});
    std::vector<Pair> pairs;
    first.assign(n + 1, 0);
    for (const auto& [one, two] : pairs_within(all, skin, check))
      {
        if (one >= n || (two >= n && !counts(one, images[two - n])))
          continue;
        Pair pair{one, two, same_box, same_box};
        if (two >= n)
          {
            const auto& image = images[two - n];
            auto back = image.boxes;
            for (int& boxes : back)
              boxes = -boxes;
            pair = {one, image.owner, box(image.boxes), box(back)};
          }
        pairs.push_back(pair);
        ++first[pair.one + 1];
        ++first[pair.two + 1];
      }
    std::partial_sum(first.begin(), first.end(), first.begin());
    neighbours.resize(2 * pairs.size());
    // The inertia of a grain equals the stiffness of all its neighbours that could come into contact: (u_1 - u_2)² ≤ 2
    // (u_1² + u_2²) then bounds the stiffness of any motion by twice its inertia, and steps up to √2 are stable. A wall
    // counts half, because it does not move.
    for (std::size_t i = 0; i < n; ++i)
      {
        const double radius = grains[i].back();
        inertia[i] = 0.0;
        visit_walls(grains[i], own.radius[i] + skin,
                    [&](double, const Components&) { inertia[i] += 0.5 * Walls<dim>::stiffness(body, radius); });
      }
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const Pair& pair : pairs)
      {
        const double stiffness = touch_stiffness<dim>(body.particle_contact.modulus, grains[pair.one].back(),
                                                      grains[pair.two].back(), body.thickness);
        neighbours[next[pair.one]++] = {pair.two, pair.box, stiffness};
        neighbours[next[pair.two]++] = {pair.one, pair.box_back, stiffness};
        inertia[pair.one] += stiffness;
        inertia[pair.two] += stiffness;
      }
    for (std::size_t i = 0; i < n; ++i) // one that lies alone moves too
      inertia[i] = std::max(inertia[i], touch_stiffness<dim>(body.particle_contact.modulus, grains[i].back(),
                                                             grains[i].back(), body.thickness));
    at_search = grains;
    growth_at_search = growth;
  }

  /// Calls visit(distance from the centre, inward normal) for each wall nearer than `reach` [m].
  template <typename Visitor>
  void visit_walls(const Place& grain, const double reach, Visitor&& visit) const
  {
    for (int axis = body.is_round() ? dim - 1 : 0; axis < dim; ++axis)
      for (const double side : {1.0, -1.0})
        if (const double distance = side > 0.0 ? grain[axis] : body.size[axis] - grain[axis];
            !body.repeats(axis) && distance < reach)
          {
            Components normal{};
            normal[axis] = side;
            visit(distance, normal);
          }
    if (!body.is_round())
      return;
    const double x = grain[0] - 0.5 * body.size[0];
    const double y = grain[1] - 0.5 * body.size[0];
    const double from_axis = std::sqrt(x * x + y * y);
    if (const double distance = 0.5 * body.size[0] - from_axis; distance < reach)
      {
        Components normal{};
        normal[0] = -x / from_axis;
        normal[1] = -y / from_axis;
        visit(distance, normal);
      }
  }

  const Specimen<dim>& body;
  const std::function<void()>& check; ///< in the search for neighbours
  std::vector<Place> grains;
  std::vector<Components> velocity;
  std::vector<Components> force;
  std::vector<double> inertia; ///< [N/m]
  double mean_radius = 0.0;
  double largest_radius = 0.0;

  // ln of the radius multiplier
  double growth = 0.0;
  double growth_velocity = 0.0;
  double growth_force = 0.0;   ///< [J]
  double growth_inertia = 0.0; ///< [J]

  // State of the last search for neighbours
  double skin = 0.0;
  std::vector<Place> at_search;
  double growth_at_search = 0.0;
  std::vector<std::uint32_t> first; ///< of each grain in `neighbours`, [n_grains + 1]
  std::vector<Neighbour> neighbours;
  std::vector<Components> shifts;
};

/// The treatment of the radii.
enum class Stage
{
  as_drawn,   ///< the first overlaps are released
  pressed,    ///< grown or shrunk until grains are at rest under the dense stress
  let_go,     ///< the stress is lowered bit by bit: one that falls below on the way makes grains flow
  at_pressure ///< until at rest
};
} // namespace

template <int dim>
void pack_by_descent(Specimen<dim>& loose, const double stress, const std::function<void()>& check,
                     const std::function<void()>& check_within)
{
  constexpr unsigned int n_as_drawn = 300;
  constexpr unsigned int n_to_half = 100; // iterations in which the stress is halved
  // FIRE with the values of its authors, but for the steps, whose unit is that of inertia.
  constexpr double first_time_step = 0.2;
  constexpr double longest_time_step = 1.2;
  constexpr double least_time_step = 0.02;
  constexpr double first_turn = 0.1; // share of the velocity that is turned towards the force
  constexpr unsigned int n_steps_before_faster = 5;

  Descent<dim> descent(loose, check_within);
  const double dense_stress = std::max(2.0 * stress, dense_stress_ratio<dim> * loose.particle_contact.modulus);
  double wanted_stress = dense_stress;
  Stage stage = Stage::as_drawn;
  double time_step = first_time_step;
  double turn = first_turn;
  unsigned int n_downhill = 0;
  for (unsigned int k = 0;; ++k)
    {
      check();
      if (stage == Stage::as_drawn && k == n_as_drawn)
        stage = Stage::pressed;
      if (stage == Stage::let_go)
        {
          wanted_stress = std::max(stress, wanted_stress * std::exp2(-1.0 / n_to_half));
          if (wanted_stress == stress)
            stage = Stage::at_pressure;
        }
      const bool radii_grow = stage != Stage::as_drawn;
      const Sums sums = descent.sum_forces(wanted_stress, radii_grow);
      const double stress_now = sums.virial / (dim * loose.volume());
      const double unbalanced_ratio = // mean unbalanced force over mean contact force
        sums.n_ends > 0.0 ? sums.unbalanced / double(descent.n_grains()) / (sums.carried / sums.n_ends) : 1.0;
      const double error = std::abs(stress_now / wanted_stress - 1.0);
      if (stage == Stage::pressed && unbalanced_ratio <= pressed_tolerance<dim> && error <= 0.1)
        stage = Stage::let_go;
      if (stage == Stage::at_pressure && unbalanced_ratio <= force_tolerance && error <= packing_stress_tolerance)
        {
          loose.report.packing_stress = stress_now;
          loose.report.radius_multiplier = descent.multiplier();
          break;
        }
      if (k == most_iterations)
        throw ParameterError(
          parameters_id<SpecimenParameters>(),
          fmt::format(
            "no packing at rest at a mean stress of {:.3g} Pa within {} iterations (reached {:.3g} Pa, forces "
            "balanced to {:.2g}); another {}, {} or seed may do, or {} = dynamics",
            stress, most_iterations, stress_now, unbalanced_ratio,
            entry_in_words(parameter_id<&SpecimenParameters::porosity>()),
            entry_in_words(parameter_id<&SpecimenParameters::packing_stress_ratio>()),
            entry_in_words(parameter_id<&SpecimenParameters::packed_by_descent>())));

      double keep = 1.0;
      double kick = time_step;
      if (sums.power > 0.0)
        {
          keep = 1.0 - turn;
          kick += turn * std::sqrt(sums.motion / sums.push);
          if (++n_downhill > n_steps_before_faster)
            {
              time_step = std::min(1.1 * time_step, longest_time_step);
              turn *= 0.99;
            }
        }
      else if (k > 0)
        {
          keep = 0.0;
          descent.stop_growth();
          time_step = std::max(0.5 * time_step, least_time_step);
          kick = time_step;
          turn = first_turn;
          n_downhill = 0;
        }
      descent.advance(time_step, keep, kick, radii_grow);
    }
  loose.grains = descent.result();
}

template decltype(pack_by_descent<2>) pack_by_descent<2>;
template decltype(pack_by_descent<3>) pack_by_descent<3>;
} // namespace feldspar
