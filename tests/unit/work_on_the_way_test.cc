#include "coupling/rve/network_history.h"

#include "tests/unit/small_rve.h"

#include <gtest/gtest.h>

/// The work of a network between two events, where one broken joint slides in it.
namespace feldspar
{
namespace
{
template <typename>
using WorkOnTheWay = testing::Test;
TYPED_TEST_SUITE(WorkOnTheWay, Dimensions);

/// A network under pressure whose first joint has no bond left and carries as much shear along t (t_1) as friction lets
/// it.
template <int dim>
struct OneJointAtItsLimit
{
  Network<dim> network{periodic_specimen<dim>()};
  const Link<dim>& link = network.links().front();
  double limit;       ///< of the shear stress [Pa]
  double area = 0.0;  ///< of the face [m²]
  double elastic_way; ///< in which the shear stress grows from nothing to the limit [m]
  NetworkHistory<dim> history;

  OneJointAtItsLimit()
    : limit(-link.friction * link.normal_stiffness * link_motion(link, unknowns_of(network, pressed()))[0])
    , elastic_way(limit / link.shear_stiffness)
    , history(network, broken(), Kinematics::small_strains)
  {
    for (std::uint32_t i = 0; i < link.n_segments; ++i)
      area += network.segment_area(link, i);
  }

  NetworkState<dim> pressed() const
  {
    NetworkState<dim> state;
    state.strain.template head<dim>().setConstant(-1e-4); // so little that no pair without a face comes into contact
    state.intact = false;
    state.motions.assign(std::size_t(network.n_unknowns() - n_voigt<dim>), 0.0);
    return state;
  }

  NetworkState<dim> broken() const
  {
    NetworkState<dim> state = pressed();
    for (std::uint32_t i = 0; i < link.n_segments; ++i)
      {
        state.unbonded.push_back({link.first_segment + i, {}});
        state.unbonded.back().shear_stress[0] = limit;
      }
    return state;
  }

  /// While its second grain goes this way along one of the axes of the joint, against its shear stress.
  NetworkWork over(const int axis, const double way) const
  {
    Configuration<dim> present{history.position(), {}};
    present.position.template segment<dim>(n_motions<dim> * Eigen::Index(link.grain_2)) +=
      way * link.axes.row(axis).transpose();
    present.balance = history.balance(present.position);
    EXPECT_TRUE(present.balance.touches.empty());
    const Balance<dim> at_event = history.balance(history.position());
    const NetworkWork work = work_on_the_way(history, at_event, present);
    const double stored = present.balance.stored_energy - at_event.stored_energy;
    EXPECT_NEAR(work.boundary - work.settled, stored + work.slip, 1e-3 * work.slip);
    return work;
  }
};

TYPED_TEST(WorkOnTheWay, HasTheSlipOfAJointThatSlidesOn)
{
  const OneJointAtItsLimit<TypeParam::value> joint;
  const double way = 3.0 * joint.elastic_way;
  const double expected = joint.limit * joint.area * way; // from the beginning on
  EXPECT_NEAR(joint.over(1, -way).slip, expected, 1e-9 * expected);
}

TYPED_TEST(WorkOnTheWay, HasTheSlipOfAJointThatSlidesBack)
{
  // Shear stress is as large at both ends, and opposite: a single trapezoid would have no slip at all.
  const OneJointAtItsLimit<TypeParam::value> joint;
  const double way = 5.0 * joint.elastic_way;
  const double expected = joint.limit * joint.area * (way - 2.0 * joint.elastic_way);
  EXPECT_NEAR(joint.over(1, way).slip, expected, 3e-3 * expected); // a thousandth of all that is moved
}

TYPED_TEST(WorkOnTheWay, EndsWhereAPairThatPressedOpens)
{
  // Pairs without a face and without shear are not kept as active from one event to the next.
  constexpr int dim = TypeParam::value;
  const Network<dim> network{periodic_specimen<dim>()};
  NetworkState<dim> pressed;
  pressed.strain.template head<dim>().setConstant(-4e-2);
  pressed.intact = false;
  pressed.motions.assign(std::size_t(network.n_unknowns() - n_voigt<dim>), 0.0);
  const NetworkHistory<dim> history(network, pressed, Kinematics::small_strains);
  const Balance<dim> at_event = history.balance(history.position());
  ASSERT_FALSE(at_event.touches.empty());
  double stored_in_pairs = 0.0;
  for (const auto& [pair, touch] : at_event.touches)
    {
      ASSERT_FALSE(history.is_active(pair));
      stored_in_pairs += touch.stored_energy;
    }

  Configuration<dim> present{Unknowns::Zero(network.n_unknowns()), {}};
  present.balance = history.balance(present.position);
  ASSERT_TRUE(present.balance.touches.empty());
  const NetworkWork work = work_on_the_way(history, at_event, present);
  const double stored = present.balance.stored_energy - at_event.stored_energy;
  EXPECT_NEAR(work.boundary - work.settled, stored + work.slip, 1e-2 * stored_in_pairs);
}

TEST(WorkOnTheWayInSpace, HasTheSlipOfAJointThatTurnsAside)
{
  // Across its shear stress, which turns towards the new way: against the sum of many small parts.
  const OneJointAtItsLimit<3> joint;
  const double way = 4.0 * joint.elastic_way;
  constexpr int n = 100000;
  double expected = 0.0;
  Eigen::Vector2d before(joint.limit, 0.0), slip_before(0.0, 0.0);
  for (int k = 1; k <= n; ++k)
    {
      const Eigen::Vector2d trial(joint.limit, -joint.link.shear_stiffness * way * k / n);
      const Eigen::Vector2d now = joint.limit * trial.normalized();
      const Eigen::Vector2d slip = (trial - now) / joint.link.shear_stiffness;
      expected += 0.5 * (before + now).dot(slip - slip_before) * joint.area;
      before = now;
      slip_before = slip;
    }
  EXPECT_NEAR(joint.over(2, way).slip, expected, 3e-3 * expected);
}
} // namespace
} // namespace feldspar
