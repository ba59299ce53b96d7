// Representative volumes of parallel bonds: the response of one face, the tangent, balances through breakage, explicit
// dynamics beside, and a resumed path.

#include "coupling/network/link_response.h"
#include "coupling/rve/equilibrium.h"
#include "coupling/rve/explicit_run.h"
#include "coupling/rve/path_run.h"
#include "tests/unit/parallel_bonds.h"
#include "tests/unit/small_rve.h"
#include "tests/unit/taken_up.h"

#include <gtest/gtest.h>

#include <cmath>

namespace feldspar
{
namespace
{
template <typename>
using ParallelBondRves = testing::Test;
TYPED_TEST_SUITE(ParallelBondRves, Dimensions);

constexpr EquilibriumParameters sharp_bonds{.event_tolerance = 1e-8, .final_tolerance = 1e-11};

template <int dim>
Specimen<dim> bonded_cell()
{
  SpecimenParameters wanted;
  wanted.dimension = dim;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = dim == 2 ? 0.012 : 0.006;
  wanted.porosity = dim == 2 ? 0.16 : 0.36;
  ParallelBondParameters bonds = test_bonds();
  bonds.bond_tensile_strength_deviation = bonds.bond_cohesion_deviation = 10e6;
  bonds.installation_gap_ratio = 0.05;
  return make_specimen<dim>(wanted, bonds, {}, 1);
}

template <int dim>
RepresentativeVolume<dim> bonded_rve(const EquilibriumParameters& parameters = sharp_bonds)
{
  return {std::make_shared<const Network<dim>>(bonded_cell<dim>()), parameters};
}

/// Shortened with free sides.
template <int dim>
std::vector<PathLeg<dim>> shortening(const double strain)
{
  return {{with_free_sides<dim>(-strain), true}};
}

TYPED_TEST(ParallelBondRves, AFaceRespondsAsTheLawOfTheSweep)
{
  // One step from rest, sticking and sliding, bonded and not: forces and energy as of the update in dem/, and the
  // derivative as by differences.
  constexpr int dim = TypeParam::value;
  const auto specimen = bonded_cell<dim>();
  const Network<dim> network(specimen);
  const ParallelBond<dim> law(test_bonds(), {});
  const Face<double> face = specimen.joints.face(0);
  for (const bool bonded : {true, false})
    for (const double slip : {1e-9, 3e-7})
      for (const double opening : {-2e-7, 2e-7})
        {
          Motion<dim> motion = Motion<dim>::Constant(1e-5); // turns
          motion[0] = opening;
          for (int c = 1; c < dim; ++c)
            motion[c] = slip * c;
          ActiveLink<dim> active{0, Motion<dim>::Zero(), {SegmentHistory<dim>{bonded, {}}}};
          const LinkResponse<dim> found = response(network, active, motion);

          OneFace<dim> elements{{1e30, 1e30, 0.0}};
          elements.update.state.bonded = bonded;
          const FaceMotion<dim, double> step = step_to<dim>(motion);
          const Motion<dim> forces =
            forces_of<dim>(law.template update<double>(face, specimen.joints.elements, step, elements));
          EXPECT_LE((found.forces - forces).norm(), 1e-12 * forces.norm());
          const double stored = law.stored_energy(face, specimen.joints.elements, step.opening, step.rotation,
                                                  [&](unsigned int) { return elements.update.state; });
          EXPECT_NEAR(found.stored_energy, stored, 1e-12 * stored);

          expect_derivative_of_differences(found, network, active, motion);
        }
}

TYPED_TEST(ParallelBondRves, TheirTangentIsThatOfADirectSolution)
{
  constexpr int dim = TypeParam::value;
  RepresentativeVolume<dim> rve = bonded_rve<dim>();
  for (const double strain : {1e-5, -3e-4})
    {
      // Pulled, then pressed: other contacts act.
      strain_to(rve, axial<dim>(strain) + uneven<dim>(0.1 * strain), 5);
      Equilibrium<dim> equilibrium(rve.network(), rve.state(), sharp_bonds);
      const DirectSolution<dim> direct(rve.network(), equilibrium.link_tangents());
      EXPECT_LT(relative(equilibrium.tangent(), direct.stiffness), 1e-8);
      // Softer than with all contacts pressed and none sliding.
      const Stiffness<dim> difference = rve.network().intact_stiffness() - equilibrium.tangent();
      EXPECT_GT(difference(dim - 1, dim - 1), 0.01 * rve.network().intact_stiffness()(dim - 1, dim - 1));
    }
  EXPECT_FALSE(rve.state().intact);
}

TYPED_TEST(ParallelBondRves, WorkBalancesThroughBreakage)
{
  constexpr int dim = TypeParam::value;
  PathRun<dim> run(std::make_shared<const Network<dim>>(bonded_cell<dim>()), shortening<dim>(3e-3),
                   {.largest_step = 5e-5});
  while (!run.has_ended() && run.record().cracks.size() < 30)
    run.advance();
  EXPECT_GT(run.record().cracks.size(), 3u);
  expect_balances(run.record());
  EXPECT_GT(run.record().samples.back().work.slip, 0.0);
}

TEST(ParallelBondRve, IsThatOfSlowExplicitDynamics)
{
  // Shortened by 4e-4 with the sides held: nothing breaks, but contacts press and slide. The slower, the nearer.
  const auto specimen = bonded_cell<2>();
  const auto network = std::make_shared<const Network<2>>(specimen);
  const Voigt<2> strain(0.0, -4e-4, 0.0);
  const std::vector<PathLeg<2>> legs{{strain_control<2>(strain), false}};
  const auto by_events = at_end(PathRun<2>(network, legs, {.largest_step = 2e-5}));
  ASSERT_TRUE(by_events.record().cracks.empty());
  const auto& expected = by_events.record().samples.back().stress;
  const auto error = [&](const std::uint64_t steps_per_millistrain) {
    const auto run = at_end(ExplicitRun<2>(specimen, network, legs, {.steps_per_millistrain = steps_per_millistrain}));
    const auto& stress = run.record().samples.back().stress;
    EXPECT_LT(run.record().samples.back().energy_imbalance(), 0.01);
    return std::hypot(stress[0] - expected[0], stress[1] - expected[1], stress[2] - expected[2]) /
           std::abs(expected[1]);
  };
  const double fast = error(100);
  const double slow = error(10000);
  EXPECT_LT(slow, fast);
  // Small strains neglect terms of the order of the strain, and the way of friction from step to step a little more.
  EXPECT_LT(slow, 2e-3);
}

TEST(ParallelBondRve, TakenUpGivesTheBitsOfTheUnbrokenRun)
{
  const auto begin = [] {
    return PathRun<2>(std::make_shared<const Network<2>>(bonded_cell<2>()), shortening<2>(3e-3),
                      {.largest_step = 1e-4});
  };
  const auto [whole, broken] = tests::whole_and_taken_up(begin);
  EXPECT_GT(whole.record().cracks.size(), 0u);
  EXPECT_EQ(broken.rve().state().motions, whole.rve().state().motions);
  EXPECT_EQ(broken.rve().state().contact_shear, whole.rve().state().contact_shear);
  EXPECT_EQ(broken.record().samples.back().work.slip, whole.record().samples.back().work.slip);
}
} // namespace
} // namespace feldspar
