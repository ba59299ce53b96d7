#include "tests/unit/small_volume.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <cstring>

/// The volume beyond its first crack: tangents, balances, and that trying is not doing.
namespace feldspar
{
namespace
{
/// FNV-1a over all a volume remembers.
std::uint64_t hash(const NetworkState<2>& state)
{
  std::uint64_t value = 14695981039346656037u;
  const auto add = [&](const auto* data, const std::size_t n) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < n * sizeof(*data); ++i)
      value = (value ^ bytes[i]) * 1099511628211u;
  };
  add(state.strain.data(), 3);
  add(state.stress.data(), 3);
  add(&state.intact, 1);
  add(state.motions.data(), state.motions.size());
  for (const auto& segment : state.unbonded)
    {
      add(&segment.segment, 1);
      add(segment.shear_stress.data(), 1);
    }
  add(&state.n_tension_breaks, 1);
  add(&state.n_shear_breaks, 1);
  for (const double work : {state.work.boundary, state.work.slip, state.work.released, state.work.settled})
    add(&work, 1);
  return value;
}

constexpr EquilibriumParameters sharp{.event_tolerance = 1e-8, .final_tolerance = 1e-11};

/// Pulled until some segments have broken.
RepresentativeVolume<2> damaged_volume(const std::uint64_t seed = 1, const double friction = 0.5)
{
  RepresentativeVolume<2> volume = small_volume(seed, sharp, friction);
  const double first = volume.network().first_break(Voigt<2>(0.0, 1.0, 0.0)).factor;
  EXPECT_GT(strain_to(volume, Voigt<2>(0.0, 1.2 * first, 0.0), 10), 4u);
  return volume;
}

TEST(RepresentativeVolume, TrialLeavesNoTrace)
{
  for (auto volume : {small_volume(), damaged_volume()})
    {
      const std::uint64_t before = hash(volume.state());
      const Voigt<2> further = volume.state().strain + Voigt<2>(1e-5, 2e-4, 1e-5);
      const auto trial = volume.trial(further, Bonds::may_break, true);
      EXPECT_TRUE(trial.in_equilibrium);
      EXPECT_GT(trial.breaks.size(), 0u);
      EXPECT_EQ(hash(volume.state()), before);
      // Nor in the network all copies share: the same trial gives the same bits.
      const auto again = volume.trial(further, Bonds::may_break, true);
      EXPECT_EQ(hash(again.state), hash(trial.state));
      EXPECT_EQ(*again.tangent, *trial.tangent);
    }
}

TEST(RepresentativeVolume, IntactAnswerIsThatOfTheCascade)
{
  // A volume told that it is not intact relaxes its grains one by one.
  RepresentativeVolume<2> volume = small_volume(1, sharp);
  const Voigt<2> strain(2e-5, 5e-5, -3e-5);
  const auto closed_form = volume.trial(strain);
  NetworkState<2> state;
  state.intact = false;
  volume.restore(state);
  const auto relaxed = volume.trial(strain);
  EXPECT_TRUE(relaxed.in_equilibrium);
  EXPECT_LT(relative(relaxed.state.stress, closed_form.state.stress), 1e-9);
  EXPECT_NEAR(relaxed.state.work.boundary, closed_form.state.work.boundary, 1e-9 * closed_form.state.work.boundary);
}

/// Of a slipping segment the tangent takes the shear stress as it is, of a sticking one that it sticks all the way. So do
/// finite differences where friction is nothing, and where it is boundless and the faces have closed before.
struct Friction
{
  std::uint64_t seed;
  double coefficient;

  friend std::ostream& operator<<(std::ostream& stream, const Friction& friction)
  {
    return stream << "seed " << friction.seed << ", friction " << friction.coefficient;
  }
};

class Tangent : public testing::TestWithParam<Friction>
{
protected:
  RepresentativeVolume<2> pulled() const { return damaged_volume(GetParam().seed, GetParam().coefficient); }

  /// Faces close again, shear and turn.
  static Voigt<2> pressing(const RepresentativeVolume<2>& volume)
  {
    return volume.state().strain + Voigt<2>(2e-5, -2e-4, 5e-5);
  }
};

TEST_P(Tangent, IsThatOfADirectSolution)
{
  RepresentativeVolume<2> volume = pulled();
  for (const bool pressed : {false, true})
    {
      if (pressed)
        strain_to(volume, pressing(volume), 10);
      Equilibrium<2> equilibrium(volume.network(), volume.state(), sharp);
      const DirectSolution direct(volume.network(), equilibrium.link_tangents());
      const Stiffness<2> tangent = equilibrium.tangent();
      EXPECT_LT(relative(tangent, direct.stiffness), 1e-8);
      EXPECT_EQ(tangent, tangent.transpose());
      EXPECT_LT(relative(equilibrium.affine_tangent(), direct.affine_stiffness), 1e-12);
      const Stiffness<2> difference = equilibrium.affine_tangent() - tangent;
      EXPECT_GT(difference.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
      if (!pressed)
        {
          EXPECT_GT(relative(tangent, volume.network().intact_stiffness()), 0.02);
        }
    }
}

TEST_P(Tangent, IsThatOfFiniteDifferences)
{
  // Steps so small that no face opens, closes or begins to slide; the relaxation to 1e-11 leaves 1e-7 of them.
  RepresentativeVolume<2> volume = pulled();
  const Voigt<2> pulled_further = volume.state().strain + Voigt<2>(1e-6, 5e-6, -2e-6);
  for (const Voigt<2>& here : {pulled_further, pressing(volume)})
    {
      if (GetParam().coefficient > 0.0)
        volume.accept(volume.trial(here, Bonds::frozen));
      const auto centre = volume.trial(here, Bonds::frozen, true);
      ASSERT_TRUE(centre.in_equilibrium);
      constexpr double step = 1e-9;
      Stiffness<2> differences;
      for (int k = 0; k < 3; ++k)
        {
          const Voigt<2> change = step * Voigt<2>::Unit(k);
          const auto plus = volume.trial(Voigt<2>(here + change), Bonds::frozen);
          const auto minus = volume.trial(Voigt<2>(here - change), Bonds::frozen);
          ASSERT_TRUE(plus.in_equilibrium && minus.in_equilibrium);
          differences.col(k) = (plus.state.stress - minus.state.stress) / (2.0 * step);
        }
      EXPECT_LT(relative(differences, *centre.tangent), 1e-6);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Tangent,
                         testing::Values(Friction{1, 0.0}, Friction{2, 0.0}, Friction{3, 0.0}, Friction{1, 1e9},
                                         Friction{2, 1e9}, Friction{3, 1e9}));

TEST(LinkAnswer, WorkIsStoredOrSlidAwayAlsoWhereOnlyAnEdgePresses)
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
      LinkAnswer<2> before = answer(network, active, active.motion);
      const double stored_before = before.stored_energy;
      double work = 0.0;
      double slip = 0.0;
      for (int k = 1; k <= n_steps; ++k)
        {
          const LinkAnswer<2> after = answer(network, active, at(k));
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

TEST(RepresentativeVolume, IntactTangentIsThatOfFiniteDifferences)
{
  const auto volume = small_volume();
  constexpr double step = 1e-7;
  Stiffness<2> differences;
  for (int k = 0; k < 3; ++k)
    differences.col(k) = volume.trial(Voigt<2>(step * Voigt<2>::Unit(k))).state.stress / step;
  EXPECT_LT(relative(*volume.trial(Voigt<2>(Voigt<2>::Zero()), Bonds::frozen, true).tangent, differences), 1e-12);
}

TEST(RepresentativeVolume, SmallInMemory)
{
  const auto bytes = [](const NetworkState<2>& state) {
    return sizeof(RepresentativeVolume<2>) + state.motions.capacity() * sizeof(double) +
           state.unbonded.capacity() * sizeof(UnbondedSegment<2>);
  };
  RepresentativeVolume<2> volume(std::make_shared<const Network<2>>(periodic_specimen(1, 0.032)), {});
  EXPECT_GT(volume.network().n_grains(), 390u);
  EXPECT_LT(bytes(volume.state()), 1000u);
  strain_to(volume, Voigt<2>(0.0, 1.6e-4, 0.0), 8);
  EXPECT_GT(volume.state().n_tension_breaks, 20u);
  EXPECT_LT(bytes(volume.state()), 64000u);
}
} // namespace
} // namespace feldspar
