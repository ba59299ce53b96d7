#include "tests/unit/small_rve.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

/// The RVE beyond its first crack: tangents, balances, and that trying is not doing.
namespace feldspar
{
namespace
{
template <typename>
using Rves = testing::Test;
TYPED_TEST_SUITE(Rves, Dimensions);

/// FNV-1a over all an RVE keeps.
template <int dim>
std::uint64_t hash(const NetworkState<dim>& state)
{
  std::uint64_t value = 14695981039346656037u;
  const auto add = [&](const auto* data, const std::size_t n) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < n * sizeof(*data); ++i)
      value = (value ^ bytes[i]) * 1099511628211u;
  };
  add(state.strain.data(), n_voigt<dim>);
  add(state.stress.data(), n_voigt<dim>);
  add(&state.intact, 1);
  add(state.motions.data(), state.motions.size());
  for (const auto& segment : state.unbonded)
    {
      add(&segment.segment, 1);
      add(segment.shear_stress.data(), segment.shear_stress.size());
    }
  add(&state.n_tension_breaks, 1);
  add(&state.n_shear_breaks, 1);
  for (const double work : {state.work.boundary, state.work.slip, state.work.released, state.work.settled})
    add(&work, 1);
  return value;
}

constexpr EquilibriumParameters sharp{.event_tolerance = 1e-8, .final_tolerance = 1e-11};

/// Pulled until some segments have broken.
template <int dim>
RepresentativeVolume<dim> damaged_rve(const std::uint64_t seed = 1, const double friction = 0.5)
{
  RepresentativeVolume<dim> rve = small_rve<dim>(seed, sharp, friction);
  const double first = rve.network().first_break(axial<dim>(1.0)).factor;
  // In space a joint has twice as many segments and the first of them breaks earlier.
  EXPECT_GT(strain_to(rve, axial<dim>((dim == 2 ? 1.2 : 1.8) * first), 10), 4u);
  return rve;
}

TYPED_TEST(Rves, TrialLeavesNoTrace)
{
  constexpr int dim = TypeParam::value;
  for (auto rve : {small_rve<dim>(), damaged_rve<dim>()})
    {
      const std::uint64_t before = hash(rve.state());
      const Voigt<dim> further = rve.state().strain + axial<dim>(4e-4) + uneven<dim>(1e-5);
      const auto trial = rve.trial(further, Bonds::may_break, true);
      EXPECT_TRUE(trial.in_equilibrium);
      EXPECT_GT(trial.breaks.size(), 0u);
      EXPECT_EQ(hash(rve.state()), before);
      // Nor in the network all copies share: the same trial gives the same bits.
      const auto again = rve.trial(further, Bonds::may_break, true);
      EXPECT_EQ(hash(again.state), hash(trial.state));
      EXPECT_EQ(again.tangent->value, trial.tangent->value);
    }
}

TYPED_TEST(Rves, IntactResponseIsThatOfTheCascade)
{
  constexpr int dim = TypeParam::value;
  // An RVE told that it is not intact relaxes its grains one by one.
  RepresentativeVolume<dim> rve = small_rve<dim>(1, sharp);
  const Voigt<dim> strain = uneven<dim>(5e-5);
  const auto closed_form = rve.trial(strain);
  NetworkState<dim> state;
  state.intact = false;
  rve.restore(state);
  const auto relaxed = rve.trial(strain);
  EXPECT_TRUE(relaxed.in_equilibrium);
  EXPECT_LT(relative(relaxed.state.stress, closed_form.state.stress), 1e-9);
  EXPECT_NEAR(relaxed.state.work.boundary, closed_form.state.work.boundary, 1e-9 * closed_form.state.work.boundary);
}

/// Friction with which finite differences give the tangent. For a slipping segment the tangent takes the shear stress
/// as it is; for a sticking one it assumes that it sticks all the way. So do finite differences where friction is zero,
/// and where it is boundless and the faces have closed before.
struct Friction
{
  std::uint64_t seed;
  double coefficient;

  friend std::ostream& operator<<(std::ostream& stream, const Friction& friction)
  {
    return stream << "seed " << friction.seed << ", friction " << friction.coefficient;
  }
};
constexpr Friction frictions[] = {{1, 0.0}, {2, 0.0}, {3, 0.0}, {1, 1e9}, {2, 1e9}, {3, 1e9}};

/// Faces close again, shear and turn.
template <int dim>
Voigt<dim> pressing(const RepresentativeVolume<dim>& rve)
{
  return rve.state().strain + axial<dim>(-2e-4) + uneven<dim>(3e-5);
}

TYPED_TEST(Rves, TangentIsThatOfADirectSolution)
{
  constexpr int dim = TypeParam::value;
  for (const Friction& friction : frictions)
    {
      SCOPED_TRACE(friction);
      RepresentativeVolume<dim> rve = damaged_rve<dim>(friction.seed, friction.coefficient);
      for (const bool pressed : {false, true})
        {
          if (pressed)
            strain_to(rve, pressing(rve), 10);
          Equilibrium<dim> equilibrium(rve.network(), rve.state(), sharp);
          const DirectSolution<dim> direct(rve.network(), equilibrium.link_tangents());
          const Stiffness<dim> tangent = equilibrium.tangent();
          EXPECT_LT(relative(tangent, direct.stiffness), 1e-8);
          EXPECT_EQ(tangent, tangent.transpose());
          const Stiffness<dim> difference = direct.affine_stiffness - tangent;
          EXPECT_GT(difference.template selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
          if (!pressed)
            {
              EXPECT_GT(relative(tangent, rve.network().intact_stiffness()), 0.02);
            }
        }
    }
}

TYPED_TEST(Rves, TangentIsThatOfFiniteDifferences)
{
  constexpr int dim = TypeParam::value;
  for (const Friction& friction : frictions)
    {
      SCOPED_TRACE(friction);
      // The relaxation to 1e-11 leaves 1e-7 of the differences.
      RepresentativeVolume<dim> rve = damaged_rve<dim>(friction.seed, friction.coefficient);
      const Voigt<dim> pulled_further = rve.state().strain + axial<dim>(5e-6) + uneven<dim>(1e-6);
      for (const Voigt<dim>& here : {pulled_further, pressing(rve)})
        {
          if (friction.coefficient > 0.0)
            rve.accept(rve.trial(here, Bonds::frozen));
          const auto centre = rve.trial(here, Bonds::frozen, true);
          ASSERT_TRUE(centre.in_equilibrium);
          EXPECT_LT(relative(stiffness_by_differences(rve, here), centre.tangent->value), 1e-6);
        }
    }
}

TYPED_TEST(Rves, IntactTangentIsThatOfFiniteDifferences)
{
  constexpr int dim = TypeParam::value;
  const auto rve = small_rve<dim>();
  constexpr double step = 1e-7;
  Stiffness<dim> differences;
  for (int k = 0; k < n_voigt<dim>; ++k)
    differences.col(k) = rve.trial(Voigt<dim>(step * Voigt<dim>::Unit(k))).state.stress / step;
  EXPECT_LT(relative(rve.trial(Voigt<dim>(Voigt<dim>::Zero()), Bonds::frozen, true).tangent->value, differences),
            1e-12);
}

TEST(Rve, GrainsThatNothingJoinsComeToRestWhenTheyAreHit)
{
  const auto network = std::make_shared<const Network<2>>(periodic_specimen(2, 0.020));
  std::vector<bool> is_joined(network->n_grains(), false);
  for (std::size_t j = 0; j < network->n_joints(); ++j)
    is_joined[network->links()[j].grain_1] = is_joined[network->links()[j].grain_2] = true;
  ASSERT_GT(std::count(is_joined.begin(), is_joined.end(), false), 0);

  // With the intact network's stiffness as mass a loose grain has next to none: then this flies apart.
  EquilibriumParameters parameters;
  parameters.most_iterations = 1; // of Newton's method: the rest by motion
  const RepresentativeVolume<2> rve(network, parameters);
  EXPECT_TRUE(rve.trial(Voigt<2>(-0.02, -0.02, 0.0), Bonds::frozen).in_equilibrium);
}

TEST(LinkResponse, WorkIsStoredOrSlidAwayAlsoWhereOnlyAnEdgePresses)
{
  // A joint broken throughout, pressed and sheared, turned until only an edge presses, slid on that and pulled open.
  const Network<2> network(periodic_specimen());
  const Link<2>& link = network.links()[0];
  const double r = link.half_length;
  const std::vector<Motion<2>> corners{{-1e-3 * r, 0.0, 0.0},       {-1e-3 * r, 2e-4 * r, 0.0},
                                       {2e-4 * r, 3e-4 * r, 1e-3},  {4e-4 * r, 9e-4 * r, 1e-3},
                                       {4e-4 * r, -9e-4 * r, 1e-3}, {2e-3 * r, 0.0, 0.0}};
  ActiveLink<2> active{0, Motion<2>::Zero(), std::vector<SegmentHistory<2>>(link.n_segments, {false, {}})};
  double slid = 0.0;
  double most_stored = 0.0;
  for (const Motion<2>& corner : corners)
    {
      // Each leg is a way since an event.
      constexpr int n_steps = 4000;
      const auto at = [&](const int k) {
        return Motion<2>(active.motion + double(k) / n_steps * (corner - active.motion));
      };
      LinkResponse<2> before = response(network, active, active.motion);
      const double stored_before = before.stored_energy;
      double work = 0.0;
      double slip = 0.0;
      for (int k = 1; k <= n_steps; ++k)
        {
          const LinkResponse<2> after = response(network, active, at(k));
          work += 0.5 * (before.forces + after.forces).dot(at(k) - at(k - 1));
          for (std::uint32_t i = 0; i < link.n_segments; ++i)
            slip += 0.5 * (before.segments[i].shear_stress[0] + after.segments[i].shear_stress[0]) *
                    (after.segments[i].slip[0] - before.segments[i].slip[0]) * network.segment_area(link, i);
          before = after;
        }
      most_stored = std::max(most_stored, before.stored_energy);
      // Trapezoids err by 1/n² where it is smooth and 1/n where a contact opens or closes.
      EXPECT_NEAR(work, before.stored_energy - stored_before + slip, 1e-4 * most_stored);
      slid += slip;
      active.motion = corner;
      for (std::uint32_t i = 0; i < link.n_segments; ++i)
        active.segments[i].shear_stress = before.segments[i].shear_stress;
    }
  EXPECT_GT(slid, 0.1 * most_stored);
}

/// The derivative by which a relaxation finds its way: of one joint whose segments are broken, pressed and slid in many
/// directions, against central differences of its forces.
TYPED_TEST(Rves, DerivativeOfALinkIsThatOfFiniteDifferences)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const Link<dim>& link = network.links().front();
  const double length = link.half_length;
  Motion<dim> size; // of a motion that strains a face by about as much in each component
  size.template head<dim>().setConstant(1e-4 * length);
  size.template tail<n_rotations<dim>>().setConstant(1e-4);
  Random random(3, RandomStream::positions);
  const auto draw = [&] {
    return Motion<dim>(
      size.cwiseProduct(Motion<dim>::NullaryExpr([&](Eigen::Index) { return random.uniform(-1.0, 1.0); })));
  };
  unsigned int n_sliding = 0;
  unsigned int n_sticking = 0;
  for (unsigned int k = 0; k < 100; ++k)
    {
      ActiveLink<dim> active{0, draw(), std::vector<SegmentHistory<dim>>(link.n_segments)};
      active.motion[0] = -1.5e-4 * length;
      for (std::size_t i = 0; i < active.segments.size(); i += k % 2 + 1)
        active.segments[i].bonded = false;
      Motion<dim> now = k % 3 == 0 ? draw() : Motion<dim>(active.motion + 0.1 * draw());
      now[0] = k % 5 == 0 ? now[0] : -1e-4 * length;
      const auto here = response(network, active, now);
      for (std::size_t i = 0; i < active.segments.size(); ++i)
        if (!active.segments[i].bonded && here.segments[i].shear_stress[0] != 0.0) // it presses
          ++(here.segments[i].slip[0] != 0.0 ? n_sliding : n_sticking);
      if (here.forces.isZero()) // wholly open
        continue;
      JointStiffness<dim> differences;
      for (int c = 0; c < n_motions<dim>; ++c)
        {
          const Motion<dim> change = 1e-5 * size[c] * Motion<dim>::Unit(c);
          differences.col(c) = (response<dim>(network, active, now + change).forces -
                                response<dim>(network, active, now - change).forces) /
                               (2e-5 * size[c]);
        }
      // Per component in the units of its size; differences of second order in 1e-5.
      const auto in_units = [&](const JointStiffness<dim>& stiffness) {
        return JointStiffness<dim>(size.asDiagonal() * stiffness * size.asDiagonal());
      };
      EXPECT_LT(relative(in_units(here.derivative), in_units(differences)), 1e-6) << k;
    }
  EXPECT_GT(n_sliding, 50u);
  EXPECT_GT(n_sticking, 10u);
}

TYPED_TEST(Rves, SlipIsSummedAsFinelyAsManyEventsWould)
{
  // A cracked volume is sheared under pressure, with bonds frozen, so that cracks slide: in one step or in many, each
  // of which sums its own way. The balance of energies alone would not see slip that is counted too low.
  constexpr int dim = TypeParam::value;
  RepresentativeVolume<dim> cracked = small_rve<dim>();
  strain_to(cracked, axial<dim>(-1e-2), 8);
  ASSERT_GT(cracked.state().unbonded.size(), 20u);
  const Voigt<dim> shear = 1e-3 * Voigt<dim>::Unit(n_voigt<dim> - 1);
  const auto sheared = [&](const RepresentativeVolume<dim>& from, const Voigt<dim>& by, const unsigned int n_steps) {
    RepresentativeVolume<dim> rve = from;
    for (unsigned int k = 1; k <= n_steps; ++k)
      rve.accept(rve.trial(Voigt<dim>(from.state().strain + double(k) / n_steps * by), Bonds::frozen));
    return rve;
  };
  const auto slip_over = [&](const unsigned int n_steps) {
    return sheared(cracked, shear, n_steps).state().work.slip - cracked.state().work.slip;
  };
  const double in_many = slip_over(64);
  EXPECT_GT(in_many, 0.0);
  // To a few thousandths of what is moved, of which slip is a part.
  EXPECT_NEAR(slip_over(1), in_many, 0.015 * in_many);
  EXPECT_NEAR(slip_over(4), in_many, 0.002 * in_many);
}

TYPED_TEST(Rves, SmallInMemory)
{
  constexpr int dim = TypeParam::value;
  const auto bytes = [](const NetworkState<dim>& state) {
    return sizeof(RepresentativeVolume<dim>) + state.motions.capacity() * sizeof(double) +
           state.unbonded.capacity() * sizeof(UnbondedSegment<dim>);
  };
  // Some 400 discs; 125 spheres, of whose 600 500 kB are allowed.
  RepresentativeVolume<dim> rve(
    std::make_shared<const Network<dim>>(periodic_specimen<dim>(1, dim == 2 ? 0.032 : 0.008)), {});
  EXPECT_GT(rve.network().n_grains(), dim == 2 ? 390u : 115u);
  EXPECT_LT(bytes(rve.state()), 1000u);
  strain_to(rve, axial<dim>(dim == 2 ? 2e-4 : 2.4e-4), 8);
  EXPECT_GT(rve.state().n_tension_breaks, 20u);
  EXPECT_LT(bytes(rve.state()), dim == 2 ? 64000u : 500000u * 125u / 600u);
}
} // namespace
} // namespace feldspar
