#include "coupling/network/kinematics.h"

#include <cmath>

namespace feldspar
{
template <int dim>
TurnedLink<dim>::TurnedLink(const Link<dim>& link, const Unknowns& position)
  : length_at_rest(link.branch.norm())
  , end(way_of_centres(link, position))
  , its_motion(motion_by_turns(link, position))
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
  Motion<dim> motion = motion_by_turns(link, unknowns);
  motion.template head<dim>() += gradient * way_of_centres(link, unknowns);
  return motion;
}

template <int dim>
void add_forces(const Link<dim>& link, const Tensor<dim>& gradient, const Motion<dim>& forces, Unknowns& sum)
{
  add_on_centres<dim, Unknowns>(link, gradient.transpose() * forces.template head<dim>(), sum);
  add_couples(link, forces, sum);
}

template <int dim, typename Columns>
void add_forces_of_motion(const Link<dim>& link, const LinkTurn<dim>& turn, const JointStiffness<dim>& stiffness,
                          const Columns& motion, Columns& sum)
{
  const RowsOf<dim, Columns> of_centres = way_of_centres(link, motion);
  RowsOf<n_motions<dim>, Columns> of_link = motion_by_turns(link, motion);
  of_link.template topRows<dim>() += turn.gradient * of_centres;
  const RowsOf<n_motions<dim>, Columns> forces = stiffness * of_link;
  add_on_centres<dim, Columns>(
    link, turn.gradient.transpose() * forces.template topRows<dim>() + turn.stiffness * of_centres, sum);
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
template void add_forces_of_motion(const Link<2>&, const LinkTurn<2>&, const JointStiffness<2>&, const UnitUnknowns<2>&,
                                   UnitUnknowns<2>&);
template void add_forces_of_motion(const Link<3>&, const LinkTurn<3>&, const JointStiffness<3>&, const UnitUnknowns<3>&,
                                   UnitUnknowns<3>&);
} // namespace feldspar
