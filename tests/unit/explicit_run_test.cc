#include "tests/unit/small_rve.h"
#include "tests/unit/taken_up.h"

#include "base/input_error.h"
#include "coupling/rve/explicit_run.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

/// Paths by explicit dynamics: against the stiffness of the intact network, with stresses given, and resumed.
namespace feldspar
{
namespace
{
using tests::TemporaryFolder;

ExplicitRun<2> explicit_run(const std::vector<PathLeg<2>>& legs, const std::uint64_t steps_per_millistrain)
{
  const Specimen<2> specimen = periodic_specimen();
  return {specimen,
          std::make_shared<const Network<2>>(specimen),
          legs,
          {.steps_per_millistrain = steps_per_millistrain}};
}

/// Largest over the path of |σ - C_0 ε| over the stress at its end.
double largest_error(const std::uint64_t steps_per_millistrain)
{
  const Voigt<2> strain(-2e-5, 5e-5, 3e-5); // nothing breaks: the weakest bond fails at some 1e-4
  const auto run = at_end(explicit_run({{strain_control<2>(strain), false}}, steps_per_millistrain));
  const Network<2> network(periodic_specimen());
  double largest = 0.0;
  for (const auto& sample : run.record().samples)
    largest = std::max(largest, (Eigen::Map<const Voigt<2>>(sample.stress.data()) -
                                 network.intact_stiffness() * Eigen::Map<const Voigt<2>>(sample.strain.data()))
                                  .norm());
  EXPECT_EQ(run.record().cracks.size(), 0u);
  EXPECT_LT((run.state().strain - strain).norm(), 1e-12);
  return largest / (network.intact_stiffness() * strain).norm();
}

TEST(ExplicitRun, ApproachesTheStiffnessOfTheNetworkAsItsRateFalls)
{
  // The grains set off with the cell, so that what is off is their fluctuation, in proportion to the rate, and below it
  // what turning and moving apart change: of the order of the strain, 7e-5.
  const double fast = largest_error(100);
  const double slow = largest_error(1000);
  EXPECT_LT(fast, 0.2);
  EXPECT_LT(slow, 0.1 * fast);
  EXPECT_LT(largest_error(10000), 0.1 * slow);
  EXPECT_LT(largest_error(100000), 2e-4);
}

TEST(ExplicitRun, TakenUpGivesTheBitsOfTheUnbrokenRun)
{
  const std::vector<PathLeg<2>> legs{{with_free_sides<2>(2e-4), true}, {with_free_sides<2>(1e-4), true}};
  const auto begin = [&] { return explicit_run(legs, 10000); };
  const auto [whole, broken] = tests::whole_and_taken_up(begin);
  EXPECT_GT(whole.record().cracks.size(), 5u);
  // Were the boundary's work taken from the mean stress of all contacts, which is not its traction out of equilibrium, 5 %
  // would be missing.
  for (const auto& sample : whole.record().samples)
    EXPECT_LT(sample.energy_imbalance(), 0.01);
  ASSERT_EQ(broken.record().samples.size(), whole.record().samples.size());
  for (std::size_t k = 0; k < whole.record().samples.size(); ++k)
    {
      const auto& one = broken.record().samples[k];
      const auto& other = whole.record().samples[k];
      EXPECT_EQ(one.strain, other.strain) << k;
      EXPECT_EQ(one.stress, other.stress) << k;
      EXPECT_EQ(one.work.boundary, other.work.boundary) << k;
      EXPECT_EQ(one.work.settled, other.work.settled) << k;
      EXPECT_EQ(one.hill_mandel_residual, other.hill_mandel_residual) << k;
      EXPECT_EQ(one.boundary_stress_error, other.boundary_stress_error) << k;
    }
  ASSERT_EQ(broken.record().cracks.size(), whole.record().cracks.size());
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  auto other = begin();
  other.advance();
  other.write_checkpoint(file, "the same");
  EXPECT_THROW(other.read_checkpoint(file, "another"), InputError);
}

TEST(ExplicitRun, HoldsGivenStresses)
{
  // Pressed by 20 MPa from all sides, then shortened with the sides held there.
  Control<2> confined;
  confined.stress_given.fill(true);
  confined.stress = Voigt<2>(-20e6, -20e6, 0.0);
  Control<2> shortened = confined;
  shortened.stress_given[1] = false;
  shortened.strain[1] = -5e-4;
  auto run = explicit_run({{confined, false}, {shortened, true}}, 100000);
  double worst = 0.0;
  bool confinement_is_over = false;
  while (!run.has_ended())
    {
      run.advance();
      const auto& stress = run.record().samples.back().stress;
      confinement_is_over = confinement_is_over || stress[0] < -19.9e6;
      if (confinement_is_over)
        worst = std::max({worst, std::abs(stress[0] + 20e6), std::abs(stress[2])});
    }
  EXPECT_EQ(run.record().failure, "");
  const auto& last = run.record().samples.back();
  EXPECT_LT(last.boundary_stress_error, 1e-3);
  EXPECT_LT(last.unbalanced_ratio, 1e-3);
  EXPECT_LT(last.hill_mandel_residual, 1e-3);
  EXPECT_LT(last.energy_imbalance(), 1e-5);
  EXPECT_LT(last.stress[1], -45e6);
  EXPECT_LT(worst, 1e-3 * 20e6); // of the motion: it follows a ramp without break to within its overshoots
}

TEST(ExplicitRun, SaysWhenAStressCannotBeHeld)
{
  Control<2> control;
  control.stress_given.fill(true);
  control.stress[1] = 60e6;
  const auto run = at_end(explicit_run({{control, false}}, 10000));
  EXPECT_EQ(run.record().failure.find("the given stress could not be held at stress_xx = 0 MPa, stress_yy = "), 0u)
    << run.record().failure;
}
} // namespace
} // namespace feldspar
