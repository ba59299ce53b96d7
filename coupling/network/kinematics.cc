#include "coupling/network/kinematics.h"

#include <cmath>

namespace feldspar
{
namespace
{
template <typename Columns>
OwnTurns<Columns> own_turns(const Link<3>& link, const Columns& unknowns)
{
  const auto own = [&](const std::uint32_t grain) -> RowsOf<3, Columns> {
    return link.axes * unknowns.template middleRows<3>(n_motions<3> * Eigen::Index(grain) + 3);
  };
  return {own(link.grain_1), own(link.grain_2)};
}

Tensor<3> cross(const Vector<3>& left)
{
  Tensor<3> result;
  result << 0.0, -left[2], left[1], left[2], 0.0, -left[0], -left[1], left[0], 0.0;
  return result;
}

/// Change of ½ a φ_n (φ_1, φ_2), the slips that a turn takes beyond a φ × n, by the turn [m/rad]; [slips × turn].
Eigen::Matrix<double, 2, 3> more_slip(const double arm, const Vector<3>& turn)
{
  Eigen::Matrix<double, 2, 3> result;
  result << turn[1], turn[0], 0.0, turn[2], 0.0, turn[0];
  return 0.5 * arm * result;
}

/// Change of its transpose times the forces, by the turn [N m/rad]; symmetric.
Tensor<3> stiffness_of_more_slip(const double arm, const Motion<3>& forces)
{
  Tensor<3> result;
  result << 0.0, forces[1], forces[2], forces[1], 0.0, 0.0, forces[2], 0.0, 0.0;
  return 0.5 * arm * result;
}

/// A motion that turns make beyond motion_by_turns() once the grains have turned: the slips, then the turn of grain 2 from
/// grain 1 in the axes of the latter, φ_2 - φ_1 - ½ φ_1 × φ_2. To first order in `at`.
template <typename Columns>
void add_more_motion(const Link<3>& link, const OwnTurns<Unknowns>& at, const OwnTurns<Columns>& change,
                     RowsOf<n_motions<3>, Columns>& motion)
{
  motion.template middleRows<2>(1) -=
    more_slip(link.arm_1, at.of_1) * change.of_1 + more_slip(link.arm_2, at.of_2) * change.of_2;
  motion.template bottomRows<3>() += 0.5 * (cross(at.of_2) * change.of_1 - cross(at.of_1) * change.of_2);
}

template <typename Columns>
void add_own_couples(const Link<3>& link, const RowsOf<3, Columns>& on_1, const RowsOf<3, Columns>& on_2, Columns& sum)
{
  sum.template middleRows<3>(n_motions<3> * Eigen::Index(link.grain_1) + 3) += link.axes.transpose() * on_1;
  sum.template middleRows<3>(n_motions<3> * Eigen::Index(link.grain_2) + 3) += link.axes.transpose() * on_2;
}

/// The transpose of add_more_motion().
template <typename Columns>
void add_more_couples(const Link<3>& link, const OwnTurns<Unknowns>& at, const RowsOf<n_motions<3>, Columns>& forces,
                      Columns& sum)
{
  const auto slip = forces.template middleRows<2>(1);
  const auto couple = forces.template bottomRows<3>();
  add_own_couples<Columns>(link, -more_slip(link.arm_1, at.of_1).transpose() * slip - 0.5 * cross(at.of_2) * couple,
                           -more_slip(link.arm_2, at.of_2).transpose() * slip + 0.5 * cross(at.of_1) * couple, sum);
}

/// Adds the change of the couples of these forces with the turns.
template <typename Columns>
void add_change_of_couples(const Link<3>& link, const Motion<3>& forces, const OwnTurns<Columns>& change, Columns& sum)
{
  const Tensor<3> by_couple = 0.5 * cross(forces.tail<3>());
  add_own_couples<Columns>(link, by_couple * change.of_2 - stiffness_of_more_slip(link.arm_1, forces) * change.of_1,
                           -by_couple * change.of_1 - stiffness_of_more_slip(link.arm_2, forces) * change.of_2, sum);
}
} // namespace

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
  if constexpr (dim == 3)
    {
      turns = own_turns(link, position);
      // The value of a form of second order is its change by the turns, computed at half of them.
      add_more_motion<Unknowns>(link, {0.5 * turns.of_1, 0.5 * turns.of_2}, turns, its_motion);
    }
}

template <int dim>
TurnedGradient<dim> TurnedLink<dim>::gradient() const
{
  Tensor<dim> result;
  result.row(0) = end.transpose() / length;
  for (int c = 1; c < dim; ++c)
    {
      result.row(c) = length_at_rest * slope_change * end[c] * end.transpose();
      result(c, 0) = -length_at_rest * end[c] / (length * length);
      result(c, c) += length_at_rest * slope;
    }
  return {result, turns};
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
Motion<dim> link_motion(const Link<dim>& link, const TurnedGradient<dim>& gradient, const Unknowns& unknowns)
{
  Motion<dim> motion = motion_by_turns(link, unknowns);
  motion.template head<dim>() += gradient.by_way * way_of_centres(link, unknowns);
  if constexpr (dim == 3)
    add_more_motion(link, gradient.turns, own_turns(link, unknowns), motion);
  return motion;
}

template <int dim>
void add_forces(const Link<dim>& link, const TurnedGradient<dim>& gradient, const Motion<dim>& forces, Unknowns& sum)
{
  add_on_centres<dim, Unknowns>(link, gradient.by_way.transpose() * forces.template head<dim>(), sum);
  add_couples(link, forces, sum);
  if constexpr (dim == 3)
    add_more_couples<Unknowns>(link, gradient.turns, forces, sum);
}

template <int dim, typename Columns>
void add_forces_of_motion(const Link<dim>& link, const LinkTurn<dim>& turn, const JointStiffness<dim>& stiffness,
                          const Columns& motion, Columns& sum)
{
  const RowsOf<dim, Columns> of_centres = way_of_centres(link, motion);
  RowsOf<n_motions<dim>, Columns> of_link = motion_by_turns(link, motion);
  of_link.template topRows<dim>() += turn.gradient.by_way * of_centres;
  if constexpr (dim == 3)
    {
      const OwnTurns<Columns> of_turns = own_turns(link, motion);
      add_more_motion(link, turn.gradient.turns, of_turns, of_link);
      add_change_of_couples(link, turn.forces, of_turns, sum);
    }
  const RowsOf<n_motions<dim>, Columns> forces = stiffness * of_link;
  add_on_centres<dim, Columns>(
    link, turn.gradient.by_way.transpose() * forces.template topRows<dim>() + turn.stiffness * of_centres, sum);
  add_couples(link, forces, sum);
  if constexpr (dim == 3)
    add_more_couples<Columns>(link, turn.gradient.turns, forces, sum);
}

template class TurnedLink<2>;
template class TurnedLink<3>;
template Motion<2> link_motion(const Link<2>&, const TurnedGradient<2>&, const Unknowns&);
template Motion<3> link_motion(const Link<3>&, const TurnedGradient<3>&, const Unknowns&);
template void add_forces(const Link<2>&, const TurnedGradient<2>&, const Motion<2>&, Unknowns&);
template void add_forces(const Link<3>&, const TurnedGradient<3>&, const Motion<3>&, Unknowns&);
template void add_forces_of_motion(const Link<2>&, const LinkTurn<2>&, const JointStiffness<2>&, const Unknowns&,
                                   Unknowns&);
template void add_forces_of_motion(const Link<3>&, const LinkTurn<3>&, const JointStiffness<3>&, const Unknowns&,
                                   Unknowns&);
template void add_forces_of_motion(const Link<2>&, const LinkTurn<2>&, const JointStiffness<2>&, const UnitUnknowns<2>&,
                                   UnitUnknowns<2>&);
template void add_forces_of_motion(const Link<3>&, const LinkTurn<3>&, const JointStiffness<3>&, const UnitUnknowns<3>&,
                                   UnitUnknowns<3>&);
} // namespace feldspar
