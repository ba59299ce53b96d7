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

template <int dim>
void add_couples(const Link<dim>& link, const Motion<dim>& forces, Unknowns& sum)
{
  constexpr int n = n_rotations<dim>;
  sum.segment<n>(first_motion<dim>(link.grain_1) + dim) += by_turn(link, 0).transpose() * forces;
  sum.segment<n>(first_motion<dim>(link.grain_2) + dim) += by_turn(link, 1).transpose() * forces;
}
} // namespace

template <int dim>
TurnedLink<dim>::TurnedLink(const Link<dim>& link, const Unknowns& position)
  : length_at_rest(link.branch.norm())
  , end(way(link, position))
  , its_motion(by_turns(link, position))
{
  const double stretch = end[0];
  end[0] += length_at_rest;
  const double across_squared = end.template tail<dim - 1>().squaredNorm();
  length = end.norm();
  // The growth of the length, without the difference of two long ones.
  its_motion[0] += ((2.0 * length_at_rest + stretch) * stretch + across_squared) / (length + length_at_rest);

  // tan ψ = ρ over the way along the normal; by its series where the quotient would lose digits.
  const double along = end[0];
  const double s = across_squared / (along * along);
  if (along > 0.0 && s < 1e-4)
    {
      slope = (1.0 - s * (1.0 / 3.0 - s * (1.0 / 5.0 - s / 7.0))) / along;
      slope_change = -(2.0 / 3.0 - s * (4.0 / 5.0 - s * (6.0 / 7.0 - s * (8.0 / 9.0)))) / (along * along * along);
    }
  else
    {
      const double across = std::sqrt(across_squared);
      slope = std::atan2(across, along) / across;
      slope_change = (along / (length * length) - slope) / across_squared;
    }
  its_motion.template segment<dim - 1>(1) += length_at_rest * slope * end.template tail<dim - 1>();
}

template <int dim>
Tensor<dim> TurnedLink<dim>::gradient() const
{
  Tensor<dim> result;
  result.row(0) = end.transpose() / length;
  for (int c = 1; c < dim; ++c)
    {
      result.row(c) = length_at_rest * slope_change * end[c] * end.transpose();
      result(c, 0) = -length_at_rest * end[c] / (length * length);
      result(c, c) += length_at_rest * slope;
    }
  return result;
}

template <int dim>
Tensor<dim> TurnedLink<dim>::stiffness(const Motion<dim>& forces) const
{
  const Vector<dim> normal = end / length;
  Tensor<dim> result = forces[0] / length * (Tensor<dim>::Identity() - normal * normal.transpose());
  // Second derivatives of length at rest × ψ/ρ × the way across, component by component.
  const double inverse_square = 1.0 / (length * length);
  for (int c = 1; c < dim; ++c)
    {
      const double force = forces[c] * length_at_rest;
      const auto add = [&](const int i, const int j, const double value) {
        result(i, j) += force * value;
        if (i != j)
          result(j, i) += force * value;
      };
      add(0, 0, 2.0 * end[0] * end[c] * inverse_square * inverse_square);
      for (int d = 1; d < dim; ++d)
        {
          add(0, d, 2.0 * end[c] * end[d] * inverse_square * inverse_square - (c == d ? inverse_square : 0.0));
          for (int e = 1; e <= d; ++e)
            add(d, e, slope_change * ((c == d ? end[e] : 0.0) + (c == e ? end[d] : 0.0) + (d == e ? end[c] : 0.0)));
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
  add_couples(link, forces, sum);
}

template <int dim>
void add_forces_of_motion(const Link<dim>& link, const LinkTurn<dim>& turn, const JointStiffness<dim>& stiffness,
                          const Unknowns& motion, Unknowns& sum)
{
  const Vector<dim> of_centres = way(link, motion);
  Motion<dim> of_link = by_turns(link, motion);
  of_link.template head<dim>() += turn.gradient * of_centres;
  const Motion<dim> forces = stiffness * of_link;
  add_on_centres<dim>(link, turn.gradient.transpose() * forces.template head<dim>() + turn.stiffness * of_centres, sum);
  add_couples(link, forces, sum);
}

template class TurnedLink<2>;
template class TurnedLink<3>;
template Motion<2> link_motion(const Link<2>&, const Tensor<2>&, const Unknowns&);
template Motion<3> link_motion(const Link<3>&, const Tensor<3>&, const Unknowns&);
template void add_forces(const Link<2>&, const Tensor<2>&, const Motion<2>&, Unknowns&);
template void add_forces(const Link<3>&, const Tensor<3>&, const Motion<3>&, Unknowns&);
template void add_forces_of_motion(const Link<2>&, const LinkTurn<2>&, const JointStiffness<2>&, const Unknowns&,
                                   Unknowns&);
template void add_forces_of_motion(const Link<3>&, const LinkTurn<3>&, const JointStiffness<3>&, const Unknowns&,
                                   Unknowns&);
} // namespace feldspar
