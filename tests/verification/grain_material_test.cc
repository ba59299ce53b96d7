#include "base/parallel.h"
#include "coupling/sample/grain_material.h"
#include "fem/solid/advance.h"
#include "fem/solid/platens.h"
#include "fem/solid/solid.h"
#include "tests/stress_tensor.h"
#include "tests/unit/small_rve.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace feldspar
{
namespace
{
EquilibriumParameters tight()
{
  EquilibriumParameters parameters;
  parameters.event_tolerance = 1e-11;
  parameters.final_tolerance = 1e-11;
  return parameters;
}

fem::Load<2> uniform_strain(const Voigt<2>& strain)
{
  fem::Load<2> load;
  const Tensor<2> gradient = strain_tensor<2>(strain);
  for (const char* const side : {"left", "right", "bottom", "top"})
    for (unsigned int c = 0; c < 2; ++c)
      load.displacements.push_back(
        {side, c, [=](const dealii::Point<2>& x) { return gradient(c, 0) * x[0] + gradient(c, 1) * x[1]; }});
  return load;
}

// Strained the same way, an element of one realisation in its own axes and the bare RVE take the same steps: intact,
// and through breaks.
TEST(GrainMaterial, OneElementIsTheBareRve)
{
  const auto network = std::make_shared<const Network<2>>(periodic_specimen());
  RepresentativeVolume<2> bare(network, tight());
  GrainMaterialParameters parameters;
  parameters.random_orientation = false;
  parameters.equilibrium = tight();
  const auto mesh = fem::plane_sample(MPI_COMM_WORLD, 0.01, 0.01, {1, 1}, 0);
  fem::Solid<2> element(mesh, {.newton_tolerance = 1e-12}, grain_material<2>({network}, parameters));
  const Voigt<2> direction(-2e-5, 3e-4, 4e-5);
  std::size_t n_breaks = 0;
  constexpr int n_steps = 10;
  for (int k = 1; k <= n_steps; ++k)
    {
      const Voigt<2> strain = double(k) / n_steps * direction;
      auto trial = bare.trial(strain);
      ASSERT_TRUE(trial.in_equilibrium);
      const bool breaks = !trial.breaks.empty();
      n_breaks += trial.breaks.size();
      bare.accept(std::move(trial));
      const auto report = element.solve(uniform_strain(strain));
      ASSERT_TRUE(report.converged) << report.failure;
      if (!breaks)
        {
          EXPECT_LE(report.n_iterations, 1u);
        }
      element.accept();
      // Round-off of the strain the element interpolates, over the stress of the step before the breaks.
      EXPECT_LT((element.mean_stress() - bare.state().stress).norm(), 1e-10 * 80e9 * strain.norm()) << k;
    }
  EXPECT_GT(n_breaks, 0u); // else nothing but elasticity was compared
}

template <typename>
using GrainMaterials = testing::Test;
TYPED_TEST_SUITE(GrainMaterials, Dimensions);

// An RVE turned by 30° under a strain responds as the RVE itself under the strain turned back.
TYPED_TEST(GrainMaterials, ATurnedRveRespondsInTheAxesOfTheSample)
{
  constexpr int dim = TypeParam::value;
  const auto network = std::make_shared<const Network<dim>>(periodic_specimen<dim>());
  const double angle = std::acos(-1.0) / 6.0;
  Tensor<dim> turn = Tensor<dim>::Identity();
  turn.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const GrainPoint<dim> point(network, turn, tight());
  const Voigt<dim> strain = uneven<dim>(3e-5);
  const auto response = point.trial(strain);
  const Tensor<dim> in_rve = turn.transpose() * strain_tensor<dim>(strain) * turn;
  const Voigt<dim> of_rve = network->intact_stiffness() * strain_voigt<dim>(in_rve);
  const Tensor<dim> expected = turn * tests::stress_tensor<dim>(of_rve) * turn.transpose();
  EXPECT_LT((tests::stress_tensor<dim>(response.stress) - expected).norm(), 1e-13 * expected.norm());
  EXPECT_LT((response.tangent * strain - response.stress).norm(), 1e-13 * response.stress.norm()); // linear so far
}

// Between smooth platens a sample whose points all have the same RVE strains evenly, each point with stress along the
// axis only, until strain gathers somewhere: it follows the curve of the RVE by itself under that control. Cascades run
// at constant strain here, at constant stress sideways there, so that a break may fall into the next step: half a percent.
void expect_curve_of_rve(const std::array<unsigned int, 2>& n_elements)
{
  std::size_t n_breaks = 0;
  for (const double step : {4e-6, -1e-4})
    {
      const auto network = std::make_shared<const Network<2>>(periodic_specimen());
      RepresentativeVolume<2> bare(network, tight());
      GrainMaterialParameters parameters;
      parameters.random_orientation = false;
      parameters.equilibrium = tight();
      const auto mesh = fem::plane_sample(MPI_COMM_WORLD, 0.01, 0.02, n_elements, 0);
      fem::Solid<2> sample(mesh, {.newton_tolerance = 1e-8}, grain_material<2>({network}, parameters));
      double before = 0.0;
      for (int k = 1; k <= 60; ++k) // or to where its stress falls
        {
          Control<2> control = strain_control<2>({0.0, k * step, 0.0});
          control.stress_given = {true, false, true};
          auto trial = bare.trial(control);
          ASSERT_TRUE(trial.in_equilibrium);
          if (std::abs(trial.state.stress[1]) < before)
            break;
          n_breaks += trial.breaks.size();
          bare.accept(std::move(trial));
          before = std::abs(bare.state().stress[1]);
          fem::advance<2, 2>(sample, fem::PlatenTest<2>().pressing(k * step * 0.02), {1.0, 1e-3, 1.0});
          EXPECT_NEAR(sample.reaction("top", 1) / 0.01, bare.state().stress[1], 5e-3 * before)
            << step << " " << k << " " << n_breaks;
        }
    }
  EXPECT_GT(n_breaks, 5u);
}

TEST(GrainMaterial, OneElementBetweenPlatensFollowsTheCurveOfItsRve) { expect_curve_of_rve({1, 1}); }
TEST(GrainMaterial, AHomogeneousSampleFollowsTheCurveOfItsRve) { expect_curve_of_rve({2, 4}); }

// The work of platens and pressures goes into what the RVEs store and lose and what elements set free on their way to
// equilibrium after breaks; none of them is computed from another. To round-off while nothing breaks, beyond to 1e-4 of the
// work (3e-5 in the avalanche of the pull, of which a large part is set free between the elements).
TEST(GrainMaterial, TheWorkOfThePlatensIsStoredLostAndSetFree)
{
  EquilibriumParameters equilibrium;
  equilibrium.final_tolerance = 1e-6;
  std::vector<Realisation<2>> realisations;
  for (const std::uint64_t seed : {1, 2})
    realisations.push_back(std::make_shared<const Network<2>>(periodic_specimen<2>(seed, 0.014)));
  const auto mesh = fem::plane_sample(MPI_COMM_WORLD, 0.012, 0.024, {1, 2}, 0);
  const auto check = [&](const double pressure, const double step, const int n_steps, const double tolerance) {
    fem::Solid<2> sample(mesh, {.newton_tolerance = 1e-5},
                         grain_material<2>(realisations, {.equilibrium = equilibrium}));
    const fem::PlatenTest<2> test{.confining_pressure = pressure};
    if (pressure > 0.0)
      fem::advance<2, 2>(sample, test.seating(), {1.0, 1.0 / 16, 1.0});
    const double start = sample.mean_displacement("top", 1);
    std::size_t n_cracks = 0;
    const auto count = [&](const fem::NewtonReport&) {
      for (std::size_t i = 0; i < sample.material_points().size(); ++i)
        n_cracks += sample.material_points()[i].cracks_of_last_step().size();
    };
    const auto swept = [&] { return sample.swept_volume("left") + sample.swept_volume("right"); };
    double pressures_at_first = 0.0;
    double swept_at_first = 0.0;
    for (int k = 1; k <= n_steps; ++k)
      {
        fem::advance<2, 2>(sample, test.pressing(start + k * step * 0.024), {1.0, 1.0 / 16, 1.0}, count);
        double accounted = sample.boundary_work().redistribution;
        for (std::size_t i = 0; i < sample.material_points().size(); ++i)
          {
            const auto energies = sample.material_points()[i].energies().value();
            accounted += sample.volumes()[i] * (energies.stored + energies.slip + energies.released + energies.settled);
          }
        const double work = sample.boundary_work().total();
        EXPECT_NEAR(accounted, work, (n_cracks == 0 ? 1e-9 : tolerance) * work) << pressure << " " << k;
        if (k == 1)
          {
            pressures_at_first = sample.boundary_work().pressures;
            swept_at_first = swept();
          }
      }
    EXPECT_GT(n_cracks, 100u) << pressure;
    // The top is free of its pressure after the first row: from then on only the sides work against theirs.
    const double by_sides = -pressure * (swept() - swept_at_first);
    EXPECT_NEAR(sample.boundary_work().pressures - pressures_at_first, by_sides, 1e-9 * std::abs(by_sides));
    return sample.boundary_work();
  };
  const fem::BoundaryWork pulled = check(0.0, 5e-6, 40, 1e-4);
  EXPECT_GT(pulled.redistribution, 0.05 * pulled.total());
  EXPECT_EQ(pulled.pressures, 0.0);
  const fem::BoundaryWork pressed = check(20e6, -1e-4, 40, 1e-4);
  EXPECT_GT(pressed.redistribution, 0.0);
}

// At a strain at which it has just been found stable a point accepts what was found there. At one where it has no response it
// says so, and stays as it was.
TEST(GrainMaterial, AcceptsWhatWasFoundStableOrLeavesThePointAsItIs)
{
  GrainPoint<2> point(std::make_shared<const Network<2>>(periodic_specimen()), Tensor<2>::Identity(), {});
  const Voigt<2> strain(0.0, 3e-4, 0.0);
  while (point.relax(strain) > 0)
    ;
  EXPECT_NO_THROW(point.accept(strain));
  const std::string before = point.stored();
  EXPECT_THROW(point.accept(Voigt<2>::Constant(std::numeric_limits<double>::quiet_NaN())), fem::PointFailure);
  EXPECT_EQ(point.stored(), before);
  EXPECT_NO_THROW(point.trial(strain));
}

// Kept factors decide the method by which the equations are solved, not the solution.
TEST(GrainMaterial, APointThatKeepsNoFactorsGivesTheSame)
{
  const auto network = std::make_shared<const Network<2>>(periodic_specimen());
  GrainPoint<2> keeping(network, Tensor<2>::Identity(), tight());
  GrainPoint<2> forgetting(network, Tensor<2>::Identity(), tight(), {}, false);
  for (const double strain : {1.5e-4, 2e-4, 2.5e-4, 3e-4})
    {
      const Voigt<2> pulled(0.0, strain, 0.0);
      for (GrainPoint<2>* point : {&keeping, &forgetting})
        {
          point->trial(pulled);
          while (point->relax(pulled) > 0)
            ;
        }
      const auto expected = keeping.trial(pulled), found = forgetting.trial(pulled);
      // Forces balance to 1e-11 of the mean; the tangent is found to 1e-5 of the motions.
      EXPECT_LT((found.stress - expected.stress).norm(), 1e-8 * expected.stress.norm()) << strain;
      EXPECT_LT((found.tangent - expected.tangent).norm(), 1e-6 * expected.tangent.norm()) << strain;
      keeping.accept(pulled);
      forgetting.accept(pulled);
    }
  EXPECT_GT(keeping.rve().state().n_tension_breaks, 5u);
  EXPECT_EQ(keeping.rve().state().n_tension_breaks, forgetting.rve().state().n_tension_breaks);
}

TEST(GrainMaterial, AStepThatIsGivenUpLeavesNothingBehind)
{
  GrainPoint<2> point(std::make_shared<const Network<2>>(periodic_specimen()), Tensor<2>::Identity(), {});
  const Voigt<2> strain(0.0, 3e-4, 0.0);
  point.trial(strain);
  ASSERT_GT(point.relax(strain), 0u);
  point.reject();
  EXPECT_TRUE(point.rve().state().intact);
  EXPECT_EQ(point.fields(), std::vector<double>(7, 0.0));
  EXPECT_TRUE(point.cracks_of_last_step().empty());

  // Cracks are reported once they are accepted, and only once.
  point.trial(strain);
  const std::size_t n_events = point.relax(strain);
  point.accept(strain);
  EXPECT_EQ(point.cracks_of_last_step().size(), n_events);
  EXPECT_GT(point.fields()[0], 0.0);
  point.accept(strain);
  EXPECT_TRUE(point.cracks_of_last_step().empty());
}

TEST(GrainMaterial, ASearchThatIsLeftLeavesNothingBehind)
{
  unsigned int n_left = 0; // until it is left
  const auto gives_up = [&] { return n_left > 0 && --n_left == 0; };
  const auto network = std::make_shared<const Network<2>>(periodic_specimen());
  GrainPoint<2> point(network, Tensor<2>::Identity(), {}, gives_up);
  GrainPoint<2> undisturbed(network, Tensor<2>::Identity(), {});
  const Voigt<2> strain(0.0, 3e-4, 0.0);
  const std::string before = point.stored();

  n_left = 10;
  point.trial(strain);
  EXPECT_THROW(point.relax(strain), GivenUp);
  point.reject();
  EXPECT_EQ(point.stored(), before);

  for (GrainPoint<2>* each : {&point, &undisturbed})
    {
      n_left = 0;
      each->trial(strain);
      while (each->relax(strain) > 0)
        ;
      n_left = 1;
      each->accept((1.0 - 1e-6) * strain); // has to be searched for, and is no matter of asking
      EXPECT_EQ(n_left, 1u);
    }
  EXPECT_FALSE(undisturbed.rve().state().unbonded.empty());
  EXPECT_EQ(point.rve().state().motions, undisturbed.rve().state().motions);
  EXPECT_EQ(point.rve().state().stress, undisturbed.rve().state().stress);
  EXPECT_EQ(point.fields(), undisturbed.fields());
}

// A quarter turn and the pull turned with it: the same cracks, their normals along x instead of y.
TEST(GrainMaterial, CracksAreFieldsInTheAxesOfTheSample)
{
  const auto network = std::make_shared<const Network<2>>(periodic_specimen());
  const auto pulled = [&](const Tensor<2>& turn, const Voigt<2>& strain) {
    GrainPoint<2> point(network, turn, {});
    point.trial(strain);
    EXPECT_GT(point.relax(strain), 0u);
    point.accept(strain);
    return point.fields();
  };
  const std::vector<double> upright = pulled(Tensor<2>::Identity(), {0.0, 3e-4, 0.0});
  Tensor<2> quarter;
  quarter << 0.0, -1.0, 1.0, 0.0;
  const std::vector<double> lying = pulled(quarter, {3e-4, 0.0, 0.0});
  constexpr int density = 3, xx = 4, yy = 5, xy = 6;
  EXPECT_GT(upright[yy], 0.7 * upright[density]); // across the pull
  EXPECT_NEAR(upright[xx] + upright[yy], upright[density], 1e-12 * upright[density]);
  EXPECT_DOUBLE_EQ(lying[density], upright[density]);
  EXPECT_NEAR(lying[xx], upright[yy], 1e-12 * upright[yy]);
  EXPECT_NEAR(lying[xy], -upright[xy], 1e-12 * upright[yy]);
}

// Each point draws by itself: the same seed deals the same whatever the order, another seed otherwise.
TEST(GrainMaterial, RvesAreDealtByTheSeed)
{
  std::vector<Realisation<2>> realisations;
  for (const std::uint64_t seed : {1, 2, 3})
    realisations.push_back(std::make_shared<const Network<2>>(periodic_specimen(seed)));
  const auto assigned = [&](const std::uint64_t seed, const unsigned int q) {
    GrainMaterialParameters parameters;
    parameters.seed = seed;
    const auto point = grain_material<2>(realisations, parameters).make_point({"0_0:", 0, q, {0.0, 0.0}, 0.01});
    const auto& grains = dynamic_cast<const GrainPoint<2>&>(*point);
    return std::pair(&grains.rve().network(), grains.orientation()(0, 0));
  };
  std::set<const Network<2>*> used;
  std::set<double> cosines;
  for (unsigned int q = 0; q < 30; ++q)
    {
      EXPECT_EQ(assigned(1, q), assigned(1, q));
      used.insert(assigned(1, q).first);
      cosines.insert(assigned(1, q).second);
    }
  EXPECT_EQ(used.size(), 3u); // missing one of three in 30 draws has odds of 2e-5
  EXPECT_EQ(cosines.size(), 30u);
  EXPECT_NE(assigned(1, 0), assigned(2, 0));
}

// Two cells of four points. To elements: the points of one have the same network and orientation, those of the other
// another orientation. Without replacement: with as many realisations as points (or elements) each is used once.
TEST(GrainMaterial, RvesAreDealtToElementsAndInTurn)
{
  std::vector<Realisation<2>> realisations;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    realisations.push_back(std::make_shared<const Network<2>>(periodic_specimen(seed)));
  using Assigned = std::pair<const Network<2>*, double>;
  const auto assigned = [&](const GrainMaterialParameters& parameters, const std::size_t n, const std::uint64_t cell,
                            const unsigned int q) -> Assigned {
    const auto material =
      grain_material<2>({realisations.begin(), realisations.begin() + std::ptrdiff_t(n)}, parameters);
    const auto point = material.make_point({cell == 0 ? "0_0:" : "1_0:", cell, q, {0.0, 0.0}, 0.01});
    const auto& grains = dynamic_cast<const GrainPoint<2>&>(*point);
    return {&grains.rve().network(), grains.orientation()(0, 0)};
  };

  GrainMaterialParameters to_elements;
  to_elements.to_elements = true;
  for (unsigned int q = 1; q < 4; ++q)
    {
      EXPECT_EQ(assigned(to_elements, 8, 0, q), assigned(to_elements, 8, 0, 0));
      EXPECT_EQ(assigned(to_elements, 8, 1, q), assigned(to_elements, 8, 1, 0));
    }
  EXPECT_NE(assigned(to_elements, 8, 0, 0).second, assigned(to_elements, 8, 1, 0).second);

  GrainMaterialParameters without_replacement;
  without_replacement.without_replacement = true;
  without_replacement.n_points_of_cell = 4;
  std::set<const Network<2>*> of_points;
  for (const std::uint64_t cell : {0, 1})
    for (unsigned int q = 0; q < 4; ++q)
      of_points.insert(assigned(without_replacement, 8, cell, q).first);
  EXPECT_EQ(of_points.size(), 8u);
  without_replacement.to_elements = true;
  EXPECT_NE(assigned(without_replacement, 2, 0, 0).first, assigned(without_replacement, 2, 1, 0).first);
  EXPECT_EQ(assigned(without_replacement, 2, 0, 3), assigned(without_replacement, 2, 0, 0));
}

// Elements on a free side have edges, open along its normal and never turned; others have periodic cells as before.
TEST(GrainMaterial, ElementsOnFreeSidesHaveEdges)
{
  const auto edges = realisation(periodic_specimen(), {.kind = BoundaryKind::edge});
  const auto material = grain_material<2>({edges}, {});
  const auto mesh = fem::plane_sample(MPI_COMM_WORLD, 0.036, 0.024, {3, 2}, 0);
  const fem::Solid<2> sample(mesh, {}, material);
  const auto usual = grain_material<2>({edges.inside}, {});
  std::size_t n_edges = 0;
  for (std::size_t i = 0; i < sample.material_points().size(); ++i)
    {
      const fem::PointPlace& place = sample.places()[i];
      const auto& grains = dynamic_cast<const GrainPoint<2>&>(sample.material_points()[i]);
      const bool outside = place.position[0] < 0.012 || place.position[0] > 0.024;
      if (outside)
        {
          EXPECT_EQ(grains.rve().network().boundary(), (Boundary{.kind = BoundaryKind::edge, .free_axis = 0}));
          EXPECT_EQ(grains.orientation(), (Tensor<2>::Identity()));
          ++n_edges;
        }
      else
        {
          const auto same = usual.make_point(place);
          EXPECT_EQ(&grains.rve().network(), edges.inside.get());
          EXPECT_EQ(grains.orientation(), dynamic_cast<const GrainPoint<2>&>(*same).orientation());
        }
    }
  EXPECT_EQ(n_edges, 4u * 4u); // two of three columns, two rows, four points each

  // A side that leans by 30 degrees: the first axis of the cell is its normal.
  const auto leaning = material.make_point({"0_0:", 0, 0, {0.0, 0.0}, 0.01, {std::sqrt(0.75), 0.5}});
  const Vector<2> first = dynamic_cast<const GrainPoint<2>&>(*leaning).orientation().col(0);
  EXPECT_NEAR(first[0], std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(first[1], 0.5, 1e-12);
}

// Weak cells change nothing else: each of their points has the twin of the RVE that it had without them, in the same
// axes, and the twin is the same network with bonds of that share of their strengths.
TEST(GrainMaterial, WeakCellsGetTheTwinsOfTheirRves)
{
  constexpr double share = 0.8;
  std::vector<Realisation<2>> realisations;
  std::vector<Realisation<2>> twins;
  for (const std::uint64_t seed : {1, 2})
    {
      const Specimen<2> specimen = periodic_specimen(seed);
      realisations.push_back(std::make_shared<const Network<2>>(specimen));
      twins.push_back(std::make_shared<const Network<2>>(weakened<2>(specimen, share)));
      twins.back().rock = "weak";
      const Network<2>& usual = *realisations.back().inside;
      const Network<2>& twin = *twins.back().inside;
      EXPECT_EQ(twin.intact_stiffness(), usual.intact_stiffness());
      for (std::uint32_t k = 0; k < usual.n_segments(); ++k)
        {
          EXPECT_EQ(twin.bond(k).tensile_strength, share * usual.bond(k).tensile_strength);
          EXPECT_EQ(twin.bond(k).cohesion, share * usual.bond(k).cohesion);
        }
      // The first to break does so in tension, at that share of the strain.
      const Voigt<2> pull = axial<2>(1.0);
      EXPECT_TRUE(usual.first_break(pull).in_tension);
      EXPECT_DOUBLE_EQ(twin.first_break(pull).factor, share * usual.first_break(pull).factor);
    }
  const auto plain = grain_material<2>(realisations, {});
  std::vector<Realisation<2>> all = realisations;
  all.insert(all.end(), twins.begin(), twins.end());
  const auto seeded = grain_material<2>(all, {}, {{"1_0:", "weak"}});
  std::set<const Network<2>*> twins_used;
  for (const std::string cell : {"0_0:", "1_0:"})
    for (unsigned int q = 0; q < 20; ++q)
      {
        const fem::PointPlace place{cell, 0, q, {0.0, 0.0}, 0.01};
        const auto grains_of = [](const auto& point) -> const GrainPoint<2>& {
          return dynamic_cast<const GrainPoint<2>&>(*point);
        };
        const auto without = plain.make_point(place);
        const auto with = seeded.make_point(place);
        EXPECT_EQ(grains_of(with).orientation(), grains_of(without).orientation());
        const Network<2>* const usual = &grains_of(without).rve().network();
        const Network<2>* expected = usual;
        if (cell == "1_0:")
          {
            expected = twins[usual == realisations[0].inside.get() ? 0 : 1].inside.get();
            twins_used.insert(expected);
          }
        EXPECT_EQ(&grains_of(with).rve().network(), expected);
      }
  EXPECT_EQ(twins_used.size(), 2u); // missing one in 20 draws has odds of 2e-6
}

// In space no direction is preferred: of n uniform turns the mean of each entry of R is 0 within 4/√(3n), of its square
// 1/3 within 4·√(4/45)/√n; angles uniform about fixed axes would fail the second.
TEST(GrainMaterial, AnyTurnInSpaceIsAsLikelyAsAnyOther)
{
  const auto network = std::make_shared<const Network<3>>(periodic_specimen<3>());
  const auto material = grain_material<3>({network}, {});
  constexpr unsigned int n = 2000;
  Tensor<3> mean = Tensor<3>::Zero();
  Tensor<3> mean_of_squares = Tensor<3>::Zero();
  for (unsigned int q = 0; q < n; ++q)
    {
      const auto point = material.make_point({"0_0:", 0, q, {}, 0.01});
      const Tensor<3> R = dynamic_cast<const GrainPoint<3>&>(*point).orientation();
      EXPECT_LT((R * R.transpose() - Tensor<3>::Identity()).norm(), 1e-14);
      EXPECT_GT(R.determinant(), 0.0);
      mean += R / n;
      mean_of_squares += R.cwiseAbs2() / n;
    }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 4.0 / std::sqrt(3.0 * n));
  EXPECT_LT((mean_of_squares.array() - 1.0 / 3.0).abs().maxCoeff(), 4.0 * std::sqrt(4.0 / 45.0 / n));
}
} // namespace
} // namespace feldspar
