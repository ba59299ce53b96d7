// The solid where its material yields or breaks: closed forms, Newton's method, cutting of steps.

#include "fem/materials/linear_elasticity.h"
#include "fem/materials/mohr_coulomb.h"
#include "fem/solid/advance.h"
#include "fem/solid/platens.h"
#include "tests/brittle_point.h"
#include "tests/fem_samples.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace feldspar::fem
{
namespace
{
using tests::has;

constexpr double E = 50e9;
constexpr double nu = 0.2;
const MohrCoulombParameters rock{E, nu, 20e6, 0.7, 0.3};
const double k = (1.0 + std::sin(0.7)) / (1.0 - std::sin(0.7));
const double m = (1.0 + std::sin(0.3)) / (1.0 - std::sin(0.3));
const double q_u = 2.0 * 20e6 * std::sqrt(k);

// ---- one element against closed forms

TEST(MohrCoulombElement, InUniaxialCompressionOfThePlane)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {1, 1}, 0);
  Solid<2, 3> solid(mesh, {}, mohr_coulomb(rock));
  const double yield_strain = -q_u * (1.0 - nu * nu) / E;
  const double elastic_lateral = -nu / (1.0 - nu) * yield_strain;
  for (const double multiple : {0.5, 1.5, 2.0, 4.0})
    {
      solve_and_accept(solid, PlatenTest<2>().pressing(multiple * yield_strain * 0.1));
      // σ_y ends at -q_u. Beyond, strain is flow on the plane of σ_x and σ_y: dε_x = -m dε_y, nothing out of the plane,
      // where the stress stays the elastic ν σ_y.
      const double stress = -q_u * std::min(multiple, 1.0);
      const double lateral =
        multiple < 1.0 ? multiple * elastic_lateral : elastic_lateral - m * (multiple - 1.0) * yield_strain;
      EXPECT_NEAR(solid.reaction("top", 1) / 0.05, stress, 1e-8 * q_u);
      EXPECT_NEAR(solid.mean_displacement("right", 0) / 0.05, lateral, 1e-8 * std::abs(yield_strain));
      EXPECT_NEAR(solid.mean_stress()[1], nu * stress, 1e-8 * q_u);
    }
  // Dissipation: -q_u times the plastic strain along y, that across works against nothing.
  EXPECT_NEAR(solid.material_points()[0].fields()[1], q_u * 3.0 * std::abs(yield_strain),
              1e-8 * q_u * std::abs(yield_strain));
}

TEST(MohrCoulombElement, InTriaxialCompressionOfACylinder)
{
  const auto mesh = axisymmetric_sample(MPI_COMM_WORLD, 0.025, 0.1, {1, 1}, 0);
  for (const double p : {0.0, 10e6, 60e6})
    {
      Solid<2, 3> solid(mesh, {.kinematics = Kinematics::axisymmetric}, mohr_coulomb(rock));
      const PlatenTest<2> test{.kinematics = Kinematics::axisymmetric, .confining_pressure = p};
      solve_and_accept(solid, test.seating());
      std::vector<double> axial_strain, radial_strain;
      for (const double strain : {-0.02, -0.03})
        {
          advance<2, 3>(solid, test.pressing(strain * 0.1), StepControl(1.0, 1e-3, 1.0));
          const double area = std::numbers::pi * 0.025 * 0.025;
          EXPECT_NEAR(solid.reaction("top", 1) / area, -(q_u + k * p), 1e-8 * q_u); // σ_1 = q_u + k σ_3
          axial_strain.push_back(solid.mean_displacement("top", 1) / 0.1);
          radial_strain.push_back(solid.mean_displacement("side", 0) / 0.025);
        }
      // On the edge σ_1 = σ_2 both lateral strains flow alike: dε_r = -m/2 dε_z.
      EXPECT_NEAR((radial_strain[1] - radial_strain[0]) / (axial_strain[1] - axial_strain[0]), -0.5 * m, 1e-7);
    }
}

// In space nothing but the elastic share of the tangent tells how the body distorts across its axis: it stays round.
TEST(MohrCoulombCylinder, YieldsEvenlyInSpaceAtAnyPressureAndStep)
{
  const auto mesh = cylinder_sample(MPI_COMM_WORLD, 0.025, 0.1, {3, 2}, 0);
  for (const double p : {0.0, 60e6})
    for (const unsigned int n_steps : {1u, 5u})
      {
        Solid<3> solid(mesh, {.kinematics = Kinematics::full}, mohr_coulomb(rock));
        const PlatenTest<3> test{.kinematics = Kinematics::full, .confining_pressure = p};
        solve_and_accept(solid, test.seating());
        std::vector<double> axial_strain, widening;
        for (const double strain : {-0.02, -0.03})
          {
            advance<3, 3>(solid, test.pressing(strain * 0.1), StepControl(1.0 / n_steps, 1e-3, 1.0 / n_steps));
            const double top = solid.reaction("top", 2);
            EXPECT_NEAR(top / solid.area("top"), -(q_u + k * p), 1e-8 * q_u) << p << ", " << n_steps;
            EXPECT_NEAR(top + solid.reaction("bottom", 2), 0.0, 1e-9 * std::abs(top)) << p << ", " << n_steps;
            axial_strain.push_back(solid.mean_displacement("top", 2) / 0.1);
            widening.push_back(solid.mean_strain()[0] + solid.mean_strain()[1]);
            EXPECT_NEAR(solid.mean_strain()[0], solid.mean_strain()[1], 1e-6 * std::abs(strain))
              << p << ", " << n_steps;
          }
        // On the edge both planes flow: dε_x + dε_y = -m dε_z, however they share it.
        EXPECT_NEAR((widening[1] - widening[0]) / (axial_strain[1] - axial_strain[0]), -m, 1e-6)
          << p << ", " << n_steps;
      }
}

// ---- Newton's method

/// Mohr and Coulomb's stress with the elastic tangent, as a wrong scheme.
class WithElasticTangent : public MaterialPoint<3>
{
public:
  MaterialResponse<3> trial(const StrainVector<3>& strain) const override
  {
    return {update(rock, {}, strain).response.stress, isotropic_stiffness<3>(E, nu)};
  }
};

TEST(Newton, ConvergesQuadraticallyWithTheConsistentTangent)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 2);
  // Rough platens, so that part of the sample yields; from nothing in one step.
  const auto load = PlatenTest<2>{.platens = Platens::rough}.pressing(-1.15 * 0.1 * q_u / E);
  Solid<2, 3> solid(mesh, {.order = 2, .newton_tolerance = 1e-12}, mohr_coulomb(rock));
  const auto report = solid.solve(load);
  ASSERT_TRUE(report.converged) << report.failure;
  const auto& r = report.residuals;
  const std::size_t n = r.size();
  ASSERT_GE(n, 4u);
  EXPECT_GT(r[n - 3], 1e-6); // far enough from round-off for squares to be seen
  EXPECT_LT(r[n - 2], 10.0 * r[n - 3] * r[n - 3]);
  EXPECT_LT(r[n - 1], 10.0 * r[n - 2] * r[n - 2] + 1e-13);

  Solid<2, 3> wrong(mesh, {.order = 2, .newton_tolerance = 1e-12},
                    {[](const PointPlace&) { return std::make_unique<WithElasticTangent>(); }, {}});
  EXPECT_FALSE(wrong.solve(load).converged);
}

/// Springs along both axes, each σ = E ε + B ε³, that respond to small strains only.
class StiffeningPoint : public MaterialPoint<2>
{
public:
  StiffeningPoint(const double its_cubic, const double its_limit)
    : cubic(its_cubic)
    , limit(its_limit)
  {
  }

  MaterialResponse<2> trial(const StrainVector<2>& strain) const override
  {
    if (strain.cwiseAbs().maxCoeff() > limit)
      throw PointFailure("too far");
    MaterialResponse<2> response{StressVector<2>::Zero(), StiffnessMatrix<2>::Zero()};
    for (int i = 0; i < 3; ++i)
      {
        response.stress[i] = E * strain[i] + cubic * strain[i] * strain[i] * strain[i];
        response.tangent(i, i) = E + 3.0 * cubic * strain[i] * strain[i];
      }
    return response;
  }

private:
  double cubic;
  double limit;
};

TEST(Newton, GoesOnlyAsFarAsThePointsRespond)
{
  // The strain is 0.4 P/E, for B = 0.6/0.4³ E³/P²; the first step of Newton's method would go to P/E.
  const double pressure = 10e6;
  const double first = pressure / E;
  const double cubic = 0.6 / 0.064 * pressure / (first * first * first);
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 2}, 0);
  Solid<2> solid(mesh, {},
                 {[&](const PointPlace&) { return std::make_unique<StiffeningPoint>(cubic, 0.7 * first); }, {}});
  PlatenTest<2> test;
  test.confining_pressure = pressure;
  auto report = solve_and_accept(solid, test.seating());
  EXPECT_NEAR(solid.mean_strain()[0], -0.4 * first, 1e-6 * first);

  Solid<2> short_of_breath(
    mesh, {}, {[&](const PointPlace&) { return std::make_unique<StiffeningPoint>(cubic, 0.01 * first); }, {}});
  report = short_of_breath.solve(test.seating());
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.failure, "a material point has no response to its strain");
}

// The first iterate goes to P/E, where the cubic term makes the force 1e6 P. A tolerance of that force would be 1e-3 P; of the
// state's own it is 1e-9 P.
TEST(Newton, MeasuresTheUnbalancedForceByTheStateItself)
{
  const double pressure = 10e6;
  const double first = pressure / E;
  const double cubic = 1e6 * pressure / (first * first * first);
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 2}, 0);
  Solid<2> solid(mesh, {.most_iterations = 40},
                 {[&](const PointPlace&) { return std::make_unique<StiffeningPoint>(cubic, 1.0); }, {}});
  PlatenTest<2> test;
  test.confining_pressure = pressure;
  const auto report = solid.solve(test.seating());
  ASSERT_TRUE(report.converged) << report.failure;
  EXPECT_GT(report.n_iterations, 10u); // its way leads through such iterates
  solid.accept();
  EXPECT_NEAR(solid.mean_stress()[0], -pressure, 2e-9 * pressure);
  EXPECT_NEAR(solid.mean_stress()[1], -pressure, 2e-9 * pressure);
}

// A body that is unloaded ends without any force to measure by.
TEST(Newton, FindsTheEquilibriumWithoutLoad)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 2}, 0);
  Solid<2, 3> solid(mesh, {}, mohr_coulomb(rock));
  solve_and_accept(solid, PlatenTest<2>().holding(0.5 * q_u));
  const auto report = solve_and_accept(solid, PlatenTest<2>().holding(0.0));
  EXPECT_NEAR(solid.mean_stress()[2], 0.0, 1e-9 * q_u);
}

// ---- freeze, solve, break

constexpr double limit_strain = 1e-4;

/// Eight rows of cells, of which the fourth is a little weaker, and all the others much stronger.
const Material<2> brittle{[](const PointPlace& place) {
                            const bool weak = place.position[1] > 0.0375 && place.position[1] < 0.05;
                            return std::make_unique<BrittlePoint>(isotropic_stiffness<2>(E, 0.0),
                                                                  weak ? limit_strain : 10.0 * limit_strain, 0.1);
                          },
                          {"broken"}};

Load<2> pull(const double strain) { return PlatenTest<2>().pressing(strain * 0.1); }

std::size_t n_broken(const Solid<2>& solid)
{
  std::size_t n = 0;
  for (std::size_t i = 0; i < solid.material_points().size(); ++i)
    n += solid.material_points()[i].fields()[0] == 1.0;
  return n;
}

TEST(Breaking, GoesOnUntilNothingBreaks)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {4, 8}, 0);
  Solid<2> solid(mesh, {}, brittle);
  auto report = solid.solve(pull(0.99 * limit_strain));
  ASSERT_TRUE(report.converged) << report.failure;
  EXPECT_EQ(report.n_iterations, 1u);
  EXPECT_EQ(report.n_events, 0u);
  solid.accept();
  EXPECT_NEAR(solid.reaction("top", 1) / 0.05, 0.99 * E * limit_strain, 1e-6 * E * limit_strain);

  report = solid.solve(pull(1.01 * limit_strain));
  ASSERT_TRUE(report.converged) << report.failure;
  EXPECT_EQ(report.n_events, 4u * 4u); // the points of the weak row, all at once
  EXPECT_EQ(report.n_cascades, 1u);
  EXPECT_EQ(report.n_iterations, 2u);
  EXPECT_EQ(n_broken(solid), 0u); // not yet accepted
  solid.accept();
  EXPECT_EQ(n_broken(solid), 16u);
  // Seven rows of stiffness E and one of E/10 in series: 8 ε = (7 + 10) σ/E.
  EXPECT_NEAR(solid.reaction("top", 1) / 0.05, E * 1.01 * limit_strain * 8.0 / 17.0, 1e-6 * E * limit_strain);
}

TEST(Breaking, IsTakenBackByAStepThatIsNotAccepted)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {4, 8}, 0);
  Solid<2> solid(mesh, {.most_events = 10}, brittle);
  solve_and_accept(solid, pull(0.9 * limit_strain));
  const double force = solid.reaction("top", 1);
  const auto report = solid.solve(pull(1.1 * limit_strain));
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.failure, "more than 10 events");
  solid.reject();
  EXPECT_EQ(n_broken(solid), 0u);
  EXPECT_EQ(solid.reaction("top", 1), force);
  // The points are whole at work too: the same strain responses as before.
  const auto again = solid.solve(pull(0.99 * limit_strain));
  EXPECT_EQ(again.n_events, 0u);
  solid.accept();
  EXPECT_NEAR(solid.reaction("top", 1), force * 0.99 / 0.9, 1e-9 * force);
}

TEST(Breaking, IsTakenBackWhereTheRunIsInterrupted)
{
  struct Stop
  {
  };
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {4, 8}, 0);
  bool stop = false;
  Solid<2> solid(mesh,
                 {.watch =
                    [&](const NewtonReport& report) {
                      if (stop && report.n_events > 0)
                        throw Stop();
                    }},
                 brittle);
  solve_and_accept(solid, pull(0.9 * limit_strain));
  const double force = solid.reaction("top", 1);
  stop = true;
  EXPECT_THROW(solid.solve(pull(1.1 * limit_strain)), Stop);
  EXPECT_EQ(n_broken(solid), 0u);
  EXPECT_EQ(solid.reaction("top", 1), force);
  stop = false;
  EXPECT_EQ(solid.solve(pull(0.99 * limit_strain)).n_events, 0u);
  solid.accept();
  EXPECT_EQ(n_broken(solid), 0u);
  EXPECT_NEAR(solid.reaction("top", 1), force * 0.99 / 0.9, 1e-9 * force);
}

// ---- cutting of steps

/// Elastic, but with no response to a strain along y that is more than a limit from the accepted one.
class ImpatientPoint : public MaterialPoint<2>
{
public:
  MaterialResponse<2> trial(const StrainVector<2>& strain) const override
  {
    if (std::abs(strain[1] - accepted[1]) > 2.1e-4)
      throw PointFailure("too far");
    return {stiffness * strain, stiffness};
  }
  void accept(const StrainVector<2>& strain) override { accepted = strain; }

private:
  StiffnessMatrix<2> stiffness = isotropic_stiffness<2>(E, nu);
  StrainVector<2> accepted = StrainVector<2>::Zero();
};

TEST(Advance, CutsStepsUntilTheyGo)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  const Material<2> material{[](const PointPlace&) { return std::make_unique<ImpatientPoint>(); }, {}};
  Solid<2> solid(mesh, {}, material);
  std::vector<double> strains;
  // 1.6e-3 in one step fails, as do 8e-4 and 4e-4; 2e-4 goes.
  advance<2, 2>(solid, pull(1.6e-3), StepControl(1.0, 1e-3, 1.0), [&](const NewtonReport& report) {
    EXPECT_EQ(report.n_iterations, 1u);
    strains.push_back(solid.mean_displacement("top", 1) / 0.1);
  });
  EXPECT_NEAR(strains.at(0), 2e-4, 1e-12);
  EXPECT_NEAR(strains.at(1), 4e-4, 1e-12);
  EXPECT_NEAR(strains.back(), 1.6e-3, 1e-12);
  EXPECT_NEAR(solid.reaction("top", 1) / 0.05, E / (1.0 - nu * nu) * 1.6e-3, 1.0);
}

TEST(Advance, StopsWhereNoStepGoesAndKeepsWhatWasReached)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  const Material<2> material{[](const PointPlace&) { return std::make_unique<ImpatientPoint>(); }, {}};
  Solid<2> solid(mesh, {}, material);
  solve_and_accept(solid, pull(2e-4));
  const auto beyond = [&] { advance<2, 2>(solid, pull(1.0), StepControl(1.0, 0.1, 1.0)); }; // steps of 0.1 at least
  EXPECT_TRUE(has(tests::refusal<StepFailure>(beyond), "a material point has no response to its strain"));
  EXPECT_NEAR(solid.mean_displacement("top", 1) / 0.1, 2e-4, 1e-12);
}
} // namespace
} // namespace feldspar::fem
