#include "tests/unit/small_rve.h"

#include "base/input_error.h"
#include "base/parallel.h"
#include "coupling/rve/path_run.h"
#include "coupling/rve/path_sample.h"
#include "tests/temporary_folder.h"
#include "tests/unit/taken_up.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

/// Paths: interrupted and resumed, controlled in mixed ways, and on a path without equilibrium.
namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

template <typename>
using Paths = testing::Test;
TYPED_TEST_SUITE(Paths, Dimensions);

template <int dim>
PathRun<dim> pull(const double strain = 3e-4, const Kinematics kinematics = Kinematics::small_strains,
                  const double edge = dim == 2 ? 0.012 : 0.006)
{
  PathParameters parameters;
  parameters.equilibrium.kinematics = kinematics;
  return {std::make_shared<const Network<dim>>(periodic_specimen<dim>(1, edge)),
          {{with_free_sides<dim>(strain), true}},
          parameters};
}

template <int dim>
bool same(const PathSample<dim>& a, const PathSample<dim>& b)
{
  return a.strain == b.strain && a.stress == b.stress && a.work.boundary == b.work.boundary &&
         a.work.slip == b.work.slip && a.work.released == b.work.released && a.work.settled == b.work.settled &&
         a.stored_energy == b.stored_energy && a.hill_mandel_residual == b.hill_mandel_residual &&
         a.boundary_stress_error == b.boundary_stress_error && a.crack_density == b.crack_density;
}

/// Expects that a path resumed from checkpoints goes on to the bits of the unbroken one.
template <int dim>
void expect_same_bits_when_taken_up(const Kinematics kinematics)
{
  const auto pulled = [&] { return pull<dim>(3e-4, kinematics); };
  const auto [whole, broken] = tests::whole_and_taken_up(pulled);
  EXPECT_GT(whole.record().cracks.size(), 5u);
  ASSERT_EQ(broken.record().samples.size(), whole.record().samples.size());
  for (std::size_t k = 0; k < whole.record().samples.size(); ++k)
    EXPECT_TRUE(same(broken.record().samples[k], whole.record().samples[k])) << k;
  ASSERT_EQ(broken.record().cracks.size(), whole.record().cracks.size());
  for (std::size_t k = 0; k < whole.record().cracks.size(); ++k)
    EXPECT_EQ(broken.record().cracks[k].segment, whole.record().cracks[k].segment);
  EXPECT_EQ(broken.rve().state().motions, whole.rve().state().motions);

  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.h5";
  broken.write_checkpoint(file, "the same");
  PathRun<dim> other = pulled();
  EXPECT_THROW(other.read_checkpoint(file, "another"), InputError);
  PathRun<dim> of_another = pull<dim>(3e-4, kinematics, dim == 2 ? 0.014 : 0.007);
  ASSERT_NE(of_another.rve().network().n_grains(), whole.rve().network().n_grains());
  EXPECT_THROW(of_another.read_checkpoint(file, "the same"), InputError);
}

TYPED_TEST(Paths, TakenUpGivesTheBitsOfTheUnbrokenRun)
{
  for (const Kinematics kinematics : {Kinematics::small_strains, Kinematics::finite})
    {
      SCOPED_TRACE(kinematics == Kinematics::finite ? "finite" : "small strains");
      expect_same_bits_when_taken_up<TypeParam::value>(kinematics);
    }
}

// In the first iteration of an increment, in its second, ..., until an increment is gone before it is asked so often.
TYPED_TEST(Paths, LeftAmidAnyIncrementGoOnToTheSameBits)
{
  constexpr int dim = TypeParam::value;
  PathRun<dim> whole = pull<dim>();
  PathRun<dim> left = pull<dim>();
  unsigned int times_left = 0;
  unsigned int latest = 0;
  while (!whole.has_ended())
    {
      bool was_left = true;
      for (unsigned int last_asking = 1; was_left; ++last_asking)
        {
          unsigned int n_asked = 0;
          try
            {
              left.advance([&] { return ++n_asked == last_asking; });
              was_left = false;
            }
          catch (const GivenUp&)
            {
              ++times_left;
              latest = std::max(latest, last_asking);
              ASSERT_EQ(left.record().samples.size(), whole.record().samples.size());
              ASSERT_EQ(left.state().motions, whole.state().motions);
            }
        }
      whole.advance();
      ASSERT_EQ(left.record().samples.size(), whole.record().samples.size());
      ASSERT_TRUE(same(left.record().samples.back(), whole.record().samples.back()));
      ASSERT_EQ(left.state().motions, whole.state().motions);
    }
  EXPECT_TRUE(left.has_ended());
  EXPECT_GT(times_left, 50u);
  EXPECT_GT(latest, 10u); // in the searches that follow breaks, not in the first only
}

TEST(PathRun, KeepsTheStateBeforeWhereThereIsNoEquilibrium)
{
  // Pulled by a stress beyond all strength.
  Control<2> control;
  control.stress_given.fill(true);
  control.stress[1] = 60e6;
  const auto run = at_end(PathRun<2>(std::make_shared<const Network<2>>(periodic_specimen()), {{control, false}}, {}));
  EXPECT_EQ(run.record().failure.find("no equilibrium was found at stress_xx = 0 MPa, stress_yy = "), 0u);
  EXPECT_TRUE(has(run.record().failure, "in the search the cell strained by more than 0.1"));
  const auto& last = run.record().samples.back();
  EXPECT_GT(last.stress[1], 4e6);
  EXPECT_LE(last.unbalanced_ratio, EquilibriumParameters{}.final_tolerance);
  const NetworkState<2>& state = run.rve().state();
  EXPECT_EQ(state.stress[1], last.stress[1]);
  EXPECT_TRUE(run.rve().trial(state.strain).in_equilibrium);
}

TEST(PathRun, ARowWithANumberThatIsNotFiniteIsKnown)
{
  const double infinite = std::numeric_limits<double>::infinity();
  PathSample<2> row;
  EXPECT_TRUE(is_finite(row));
  for (double* const number : {&row.strain[2], &row.stress[0], &row.stored_energy, &row.work.boundary,
                               &row.hill_mandel_residual, &row.crack_density})
    for (const double wrong : {infinite, std::nan("")})
      {
        const double right = std::exchange(*number, wrong);
        EXPECT_FALSE(is_finite(row));
        *number = right;
      }
}

TEST(PathRun, EqualOverloadsBreakInTheOrderOfTheirNumbers)
{
  // All bonds the same and one joint's segments alike but for their turn: the worst is the first among equals.
  Specimen<2> specimen = periodic_specimen();
  std::fill(specimen.joints.tensile_strength.begin(), specimen.joints.tensile_strength.end(), 0.0);
  std::fill(specimen.joints.cohesion.begin(), specimen.joints.cohesion.end(), 1e12);
  const EquilibriumParameters one_by_one{.event_tolerance = 1e-3,
                                         .final_tolerance = 1e-6,
                                         .break_rule = BreakRule::only_worst,
                                         .most_iterations = 200};
  const Network<2> network(specimen);
  Equilibrium<2> equilibrium(network, {}, one_by_one);
  equilibrium.relax(strain_control<2>(Voigt<2>(0.0, 1e-6, 0.0)), 1e-3);
  // Without any strength every overload is infinite.
  const auto worst = equilibrium.overloads();
  ASSERT_EQ(worst.size(), 1u);
  for (std::uint32_t segment = 0; segment < worst.front().segment; ++segment)
    EXPECT_LE(network.unit_response(segment)(0, 1), 0.0);
}
} // namespace
} // namespace feldspar
