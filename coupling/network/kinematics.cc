#include "coupling/network/kinematics.h"

#include <cmath>

namespace feldspar
{
namespace
{
template <int dim>
Eigen::Index first_motion(const std::uint32_t grain)
{
  return n_motions<dim> * Eigen::Index(grain);
}

/// Of the second centre from the first, beyond the branch at rest, in the axes at rest [m].
template <int dim>
Vector<dim> way(const Link<dim>& link, const Unknowns& unknowns)
{
  return link.axes * (unknowns.segment<dim>(first_motion<dim>(link.grain_2)) -
                      unknowns.segment<dim>(first_motion<dim>(link.grain_1))) +
         link.by_strain.template topRows<dim>() * unknowns.tail<n_voigt<dim>>();
}

/// Adds forces on the second centre, against them on the first, and what they do to the strain.
template <int dim>
void add_on_centres(const Link<dim>& link, const Vector<dim>& force, Unknowns& sum)
{
  const Vector<dim> on_two = link.axes.transpose() * force;
  sum.segment<dim>(first_motion<dim>(link.grain_1)) -= on_two;
  sum.segment<dim>(first_motion<dim>(link.grain_2)) += on_two;
  sum.tail<n_voigt<dim>>() += link.by_strain.template topRows<dim>().transpose() * force;
}

/// The motion of a link under the turn of one of its grains.
template <int dim>
auto by_turn(const Link<dim>& link, const int end)
{
  return link.by_grains.template block<n_motions<dim>, n_rotations<dim>>(0, n_motions<dim> * end + dim);
}

template <int dim>
Motion<dim> by_turns(const Link<dim>& link, const Unknowns& unknowns)
{
  constexpr int n = n_rotations<dim>;
  return by_turn(link, 0) * unknowns.segment<n>(first_motion<dim>(link.grain_1) + dim) +
         by_turn(link, 1) * unknowns.segment<n>(first_motion<dim>(link.grain_2) + dim);
}

/// The branch in the axes at rest: its length at rest, and where it ends now.
template <int dim>
struct Branch
{
  Branch(const Link<dim>& link, const Unknowns& position)
    : at_rest(link.branch.norm())
    , stretch(way(link, position))
    , end(stretch)
  {
    end[0] += at_rest;
    length = end.norm();
    across_squared = end.template tail<dim - 1>().squaredNorm();
  }

  /// Growth of the length, without the difference of two long ones.
  double growth() const
  {
    return (2.0 * at_rest + stretch[0]) * stretch[0] / (length + at_rest) + across_squared / (length + at_rest);
  }

  double at_rest;
  Vector<dim> stretch;
  Vector<dim> end;
  double length;
  double across_squared;
};

/// The angle of a branch from its normal at rest over its way across it, and how this changes with the square of the way:
/// ψ/ρ and (d(ψ/ρ)/dρ)/ρ with tan ψ = ρ/a [1/m, 1/m³].
struct Slope
{
  template <int dim>
  explicit Slope(const Branch<dim>& branch)
  {
    const double along = branch.end[0];
    const double s2 = branch.across_squared / (along * along);
    if (along > 0.0 && s2 < 1e-4)
      {
        value = (1.0 - s2 * (1.0 / 3.0 - s2 * (1.0 / 5.0 - s2 / 7.0))) / along;
        change = -(2.0 / 3.0 - s2 * (4.0 / 5.0 - s2 * (6.0 / 7.0 - s2 * (8.0 / 9.0)))) / (along * along * along);
        return;
      }
    const double across = std::sqrt(branch.across_squared);
    value = std::atan2(across, along) / across;
    change = (along / (branch.length * branch.length) - value) / branch.across_squared;
  }

  double value;
  double change;
};
} // namespace

template <int dim>
TurnedLink<dim> turned(const Link<dim>& link, const Unknowns& position)
{
  const Branch<dim> branch(link, position);
  const Slope slope(branch);
  TurnedLink<dim> result;
  result.motion = by_turns(link, position);
  result.motion[0] += branch.growth();
  result.gradient.row(0) = branch.end.transpose() / branch.length;
  for (int c = 1; c < dim; ++c)
    {
      result.motion[c] += branch.at_rest * slope.value * branch.end[c];
      result.gradient.row(c) = branch.at_rest * slope.change * branch.end[c] * branch.end.transpose();
      result.gradient(c, 0) = -branch.at_rest * branch.end[c] / (branch.length * branch.length);
      result.gradient(c, c) += branch.at_rest * slope.value;
    }
  return result;
}

template <int dim>
Tensor<dim> turning_stiffness(const Link<dim>& link, const Unknowns& position, const Motion<dim>& forces)
{
  const Branch<dim> branch(link, position);
  const Slope slope(branch);
  const Vector<dim> normal = branch.end / branch.length;
  Tensor<dim> result = forces[0] / branch.length * (Tensor<dim>::Identity() - normal * normal.transpose());
  const double inverse_square = 1.0 / (branch.length * branch.length);
  for (int c = 1; c < dim; ++c)
    {
      const double force = forces[c] * branch.at_rest;
      const auto add = [&](const int i, const int j, const double value) {
        result(i, j) += force * value;
        if (i != j)
          result(j, i) += force * value;
      };
      add(0, 0, 2.0 * branch.end[0] * branch.end[c] * inverse_square * inverse_square);
      for (int d = 1; d < dim; ++d)
        {
          add(0, d,
              2.0 * branch.end[c] * branch.end[d] * inverse_square * inverse_square - (c == d ? inverse_square : 0.0));
          for (int e = 1; e <= d; ++e)
            add(d, e,
                slope.change *
                  ((c == d ? branch.end[e] : 0.0) + (c == e ? branch.end[d] : 0.0) + (d == e ? branch.end[c] : 0.0)));
        }
    }
  return result;
}

template <int dim>
Motion<dim> link_motion(const Link<dim>& link, const Tensor<dim>& gradient, const Unknowns& unknowns)
{
  Motion<dim> motion = by_turns(link, unknowns);
  motion.template head<dim>() += gradient * way(link, unknowns);
  return motion;
}

template <int dim>
void add_forces(const Link<dim>& link, const Tensor<dim>& gradient, const Motion<dim>& forces, Unknowns& sum)
{
  add_on_centres<dim>(link, gradient.transpose() * forces.template head<dim>(), sum);
  constexpr int n = n_rotations<dim>;
  sum.segment<n>(first_motion<dim>(link.grain_1) + dim) += by_turn(link, 0).transpose() * forces;
  sum.segment<n>(first_motion<dim>(link.grain_2) + dim) += by_turn(link, 1).transpose() * forces;
}

template <int dim>
void add_turning_forces(const Link<dim>& link, const Tensor<dim>& stiffness, const Unknowns& unknowns, Unknowns& sum)
{
  add_on_centres<dim>(link, stiffness * way(link, unknowns), sum);
}

template TurnedLink<2> turned(const Link<2>&, const Unknowns&);
template TurnedLink<3> turned(const Link<3>&, const Unknowns&);
template Tensor<2> turning_stiffness(const Link<2>&, const Unknowns&, const Motion<2>&);
template Tensor<3> turning_stiffness(const Link<3>&, const Unknowns&, const Motion<3>&);
template Motion<2> link_motion(const Link<2>&, const Tensor<2>&, const Unknowns&);
template Motion<3> link_motion(const Link<3>&, const Tensor<3>&, const Unknowns&);
template void add_forces(const Link<2>&, const Tensor<2>&, const Motion<2>&, Unknowns&);
template void add_forces(const Link<3>&, const Tensor<3>&, const Motion<3>&, Unknowns&);
template void add_turning_forces(const Link<2>&, const Tensor<2>&, const Unknowns&, Unknowns&);
template void add_turning_forces(const Link<3>&, const Tensor<3>&, const Unknowns&, Unknowns&);
} // namespace feldspar
