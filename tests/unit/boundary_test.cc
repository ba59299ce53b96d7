// The boundaries of a representative volume: their order, their limits, and that what holds for the periodic one holds for
// all.

#include "coupling/network/network.h"
#include "coupling/rve/path_run.h"
#include "dem/genesis/coring.h"
#include "tests/unit/small_rve.h"
#include "tests/unit/taken_up.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <vector>

namespace feldspar
{
namespace
{
template <typename>
using Bounds = testing::Test;
TYPED_TEST_SUITE(Bounds, Dimensions);

template <int dim>
std::vector<Boundary> all_boundaries()
{
  return {{.kind = BoundaryKind::minimal_kinematic},
          {.kind = BoundaryKind::weakly_periodic, .n_pieces = dim == 2 ? 4u : 2u},
          {.kind = BoundaryKind::edge, .free_axis = 0},
          {.kind = BoundaryKind::affine}};
}

template <int dim>
Network<dim> network_under(const Boundary& boundary, const std::uint64_t seed = 1)
{
  return Network<dim>(periodic_specimen<dim>(seed), Tensor<dim>::Identity(), boundary);
}

template <int dim>
double least_eigenvalue(const Stiffness<dim>& matrix)
{
  return Eigen::SelfAdjointEigenSolver<Stiffness<dim>>(matrix).eigenvalues().minCoeff();
}

// Motions that an affine boundary admits are admitted by a periodic one, and these by a minimal kinematic one; the energy
// of an intact network is least over what is admitted, at every strain. Stiffnesses are therefore ordered as matrices.
TYPED_TEST(Bounds, MinimalKinematicIsBelowPeriodicBelowAffine)
{
  constexpr int dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const auto specimen = periodic_specimen<dim>(seed);
      const Stiffness<dim> periodic = Network<dim>(specimen).intact_stiffness();
      const auto bounds = stiffness_bounds(specimen);
      const double size = periodic.norm();
      // Well apart: a boundary that was periodic by mistake would be equal, to 1e-9.
      EXPECT_GT(least_eigenvalue<dim>(periodic - bounds.minimal_kinematic), 1e-4 * size) << seed;
      EXPECT_GT(least_eigenvalue<dim>(bounds.affine - periodic), 1e-5 * size) << seed;
      EXPECT_GT(least_eigenvalue<dim>(bounds.minimal_kinematic), 0.0) << seed;
    }
}

// A turned cell has turned bounds: the areas of its sides turn with it.
TEST(Bounds, TurnWithTheCell)
{
  const auto specimen = periodic_specimen<2>(1);
  Tensor<2> quarter;
  quarter << 0.0, -1.0, 1.0, 0.0;
  const auto upright = stiffness_bounds(specimen);
  const auto lying = stiffness_bounds(specimen, quarter);
  for (const auto& [one, other] :
       {std::pair(upright.minimal_kinematic, lying.minimal_kinematic), std::pair(upright.affine, lying.affine)})
    {
      EXPECT_NEAR(one(0, 0), other(1, 1), 1e-6 * one(0, 0));
      EXPECT_NEAR(one(0, 1), other(1, 0), 1e-6 * one(0, 0));
      EXPECT_NEAR(one(2, 2), other(2, 2), 1e-6 * one(0, 0));
    }
}

// The same rock in one, two and four cells each way: the periodic stiffness stays, and the layer in which a boundary
// changes it becomes a half and a quarter of the body. The bracket therefore narrows as 1/L; layers that meet in the
// smallest body and corners leave a tenth or two.
TEST(Bounds, NarrowAsOneOverTheSize)
{
  const auto cell = periodic_specimen<2>(1);
  std::vector<double> below, above;
  for (const unsigned int n : {1u, 2u, 4u})
    {
      const auto rock = repeated<2>(cell, {n, n});
      const auto bounds = stiffness_bounds(rock);
      const Stiffness<2> periodic = Network<2>(rock).intact_stiffness();
      below.push_back((periodic - bounds.minimal_kinematic).trace() / periodic.trace());
      above.push_back((bounds.affine - periodic).trace() / periodic.trace());
    }
  for (const auto& share : {below, above})
    {
      EXPECT_NEAR(share[1] / share[0], 0.5, 0.15);
      EXPECT_NEAR(share[2] / share[1], 0.5, 0.10);
    }
}

template <typename>
using Boundaries = testing::Test;
TYPED_TEST_SUITE(Boundaries, Dimensions);

// Each of these admits the motions of the next.
TYPED_TEST(Boundaries, ThatAdmitLessAreStiffer)
{
  constexpr int dim = TypeParam::value;
  using K = BoundaryKind;
  const std::vector<std::vector<Boundary>> chains{{{.kind = K::minimal_kinematic},
                                                   {.kind = K::weakly_periodic, .n_pieces = 2},
                                                   {.kind = K::weakly_periodic, .n_pieces = 4},
                                                   {.kind = K::weakly_periodic, .n_pieces = 8},
                                                   {}},
                                                  {{.kind = K::edge, .free_axis = 0}, {}, {.kind = K::affine}},
                                                  {{.kind = K::edge, .free_axis = dim - 1}, {}}};
  for (std::uint64_t seed = 1; seed <= (dim == 2 ? 2 : 1); ++seed)
    for (const auto& chain : chains)
      for (std::size_t k = 1; k < chain.size(); ++k)
        {
          const Stiffness<dim> wider = network_under<dim>(chain[k - 1], seed).intact_stiffness();
          const Stiffness<dim> narrower = network_under<dim>(chain[k], seed).intact_stiffness();
          EXPECT_GT(least_eigenvalue<dim>(narrower - wider), -1e-9 * narrower.norm())
            << name(chain[k - 1]) << " below " << name(chain[k]) << ", seed " << seed;
        }
}

TYPED_TEST(Boundaries, OfOnePieceIsMinimalKinematicAndOfTheFinestPiecesPeriodic)
{
  constexpr int dim = TypeParam::value;
  const auto with_pieces = [](const unsigned int n) {
    return network_under<dim>({.kind = BoundaryKind::weakly_periodic, .n_pieces = n});
  };
  EXPECT_EQ(with_pieces(1).intact_stiffness(),
            network_under<dim>({.kind = BoundaryKind::minimal_kinematic}).intact_stiffness());
  const Network<dim> finest = with_pieces(1000);
  const Network<dim> periodic = network_under<dim>({});
  EXPECT_EQ(finest.n_grains(), periodic.n_grains());
  EXPECT_EQ(finest.links().size(), periodic.links().size());
  EXPECT_EQ(finest.intact_stiffness(), periodic.intact_stiffness());
}

TYPED_TEST(Boundaries, KeepEveryJointOnceAndTheBranchesOfAll)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> periodic = network_under<dim>({});
  for (const Boundary& boundary : all_boundaries<dim>())
    {
      SCOPED_TRACE(name(boundary));
      const Network<dim> network = network_under<dim>(boundary);
      ASSERT_EQ(network.n_joints(), periodic.n_joints());
      EXPECT_EQ(network.n_own_grains(), periodic.n_own_grains());
      EXPECT_EQ(network.volume(), periodic.volume());
      for (std::size_t j = 0; j < network.n_joints(); ++j)
        {
          const Link<dim>& link = network.links()[j];
          // From centre to centre through what is left of the periodic sides.
          const Vector<dim> way = network.positions()[link.grain_2] - network.positions()[link.grain_1] +
                                  shift(PeriodicImage<dim>{link.grain_2, network.boxes_crossed()[j]}, network.cell());
          EXPECT_LT((way - link.branch).norm(), 1e-9 * link.branch.norm());
          EXPECT_EQ(link.branch, periodic.links()[j].branch);
        }
    }
}

TYPED_TEST(Boundaries, StiffnessIsThatOfADirectSolution)
{
  constexpr int dim = TypeParam::value;
  for (const Boundary& boundary : all_boundaries<dim>())
    {
      const Network<dim> network = network_under<dim>(boundary);
      const DirectSolution<dim> direct(network, intact_stiffnesses(network));
      EXPECT_LT(relative(network.intact_stiffness(), direct.stiffness), 1e-8) << name(boundary);
    }
}

// A grain and its image carry their share of one traction, and the stress is that of these tractions.
TYPED_TEST(Boundaries, BearTheirStressByUniformTractions)
{
  constexpr int dim = TypeParam::value;
  for (const Boundary& boundary : all_boundaries<dim>())
    {
      SCOPED_TRACE(name(boundary));
      const Network<dim> network = network_under<dim>(boundary);
      NetworkState<dim> state;
      state.strain = uneven<dim>(3e-5);
      const auto forces = link_forces(network, state);
      const Tensor<dim> stress = branch_stress(network, forces);
      EXPECT_LT((stress - stress.transpose()).norm(), 1e-8 * stress.norm());
      EXPECT_LT(relative(boundary_stress(network, *network.conditions(), forces), stress), 1e-8);
      EXPECT_LT(relative(stress_voigt<dim>(stress), network.intact_stiffness() * state.strain), 1e-8);

      Unknowns borne = Unknowns::Zero(network.n_unknowns());
      for (std::size_t k = 0; k < forces.values.size(); ++k)
        add_forces(network.links()[k], forces.values[k], borne);
      const auto on = [&](const std::uint32_t grain) -> Vector<dim> {
        return borne.segment<dim>(n_motions<dim> * Eigen::Index(grain));
      };
      for (const auto& piece : network.conditions()->pieces())
        {
          Vector<dim> whole = Vector<dim>::Zero(); // the images of a piece may lie on both of its sides
          double shares = 0.0;
          for (const auto& pair : piece)
            {
              whole += (pair.share > 0.0 ? 1.0 : -1.0) * on(pair.image);
              shares += std::abs(pair.share);
            }
          EXPECT_NEAR(shares, 1.0, 1e-12);
          for (const auto& pair : piece)
            EXPECT_LT((on(pair.image) - pair.share * whole).norm(), 1e-6 * whole.norm());
        }
    }
}

// No stress given across the free sides: nothing pulls at the grains there, and the cell is a plate.
TYPED_TEST(Boundaries, OfAnEdgeLeaveItsSidesFree)
{
  constexpr int dim = TypeParam::value;
  RepresentativeVolume<dim> rve = small_rve<dim>(1, {.event_tolerance = 1e-8, .final_tolerance = 1e-11}, 0.5,
                                                 {.kind = BoundaryKind::edge, .free_axis = 0});
  const auto trial = rve.trial(with_free_sides<dim>(1e-4)); // beyond the first breaks
  ASSERT_TRUE(trial.in_equilibrium);
  const auto forces = link_forces(rve.network(), trial.state).values;
  Unknowns borne = Unknowns::Zero(rve.network().n_unknowns());
  double largest = 0.0;
  for (std::size_t k = 0; k < forces.size(); ++k)
    {
      add_forces(rve.network().links()[k], forces[k], borne);
      largest = std::max(largest, forces[k].norm());
    }
  ASSERT_GT(rve.network().conditions()->pieces().front().size(), 2u);
  for (const auto& pair : rve.network().conditions()->pieces().front())
    EXPECT_LT(borne.segment<dim>(n_motions<dim> * Eigen::Index(pair.image)).norm(), 1e-7 * largest);
}

TYPED_TEST(Boundaries, KeepTangentAndBalancesBeyondTheFirstCrack)
{
  constexpr int dim = TypeParam::value;
  constexpr EquilibriumParameters sharp{.event_tolerance = 1e-8, .final_tolerance = 1e-11};
  for (const Boundary& boundary : all_boundaries<dim>())
    {
      SCOPED_TRACE(name(boundary));
      // Without friction a slipping segment is as the tangent takes it.
      RepresentativeVolume<dim> rve = small_rve<dim>(1, sharp, 0.0, boundary);
      const double first = rve.network().first_break(axial<dim>(1.0)).factor;
      ASSERT_GT(strain_to(rve, axial<dim>((dim == 2 ? 1.2 : 1.8) * first), 10), 2u);
      const Voigt<dim> here = rve.state().strain + axial<dim>(-2e-4) + uneven<dim>(3e-5); // pressed back
      const auto centre = rve.trial(here, Bonds::frozen, true);
      ASSERT_TRUE(centre.in_equilibrium);
      EXPECT_LT(relative(stiffness_by_differences(rve, here), centre.tangent->value), 1e-6);
      rve.accept(rve.trial(here, Bonds::frozen));
      Equilibrium<dim> equilibrium(rve.network(), rve.state(), sharp);
      const DirectSolution<dim> direct(rve.network(), equilibrium.link_tangents(), equilibrium.conditions());
      EXPECT_LT(relative(equilibrium.tangent(), direct.stiffness), 1e-7);
    }
}

template <int dim>
PathRun<dim> pulled_under(const Boundary& boundary)
{
  return {std::make_shared<const Network<dim>>(periodic_specimen<dim>(), Tensor<dim>::Identity(), boundary),
          {{with_free_sides<dim>(3e-4), true}},
          {}};
}

TYPED_TEST(Boundaries, KeepHillAndMandelAndTheEnergyThroughTheFall)
{
  constexpr int dim = TypeParam::value;
  for (const Boundary& boundary : all_boundaries<dim>())
    {
      SCOPED_TRACE(name(boundary));
      const PathRun<dim> run = at_end(pulled_under<dim>(boundary));
      EXPECT_EQ(run.record().failure, "");
      EXPECT_GT(run.record().cracks.size(), 5u);
      double highest = 0.0;
      for (const auto& sample : run.record().samples)
        {
          highest = std::max(highest, sample.stress[dim - 1]);
          EXPECT_LT(sample.hill_mandel_residual, 1e-5); // ten times the final tolerance
          EXPECT_LT(sample.energy_imbalance(), 1e-3);
          if (sample.stress[dim - 1] > 0.1 * highest)
            {
              EXPECT_LT(sample.boundary_stress_error, 1e-5);
            }
        }
    }
}

// A grain at a side that has lost its joints carries nothing, and the others of its piece carry its share.
TYPED_TEST(Boundaries, LetGoOfGrainsThatNothingHolds)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network = network_under<dim>({.kind = BoundaryKind::minimal_kinematic});
  const auto& pieces = network.conditions()->pieces();
  ASSERT_EQ(pieces.size(), std::size_t(dim));
  const std::uint32_t loose = pieces.front().front().image;
  const auto holds = [&](const std::uint32_t joint) {
    return network.links()[joint].grain_1 != loose && network.links()[joint].grain_2 != loose;
  };
  const auto left = network.conditions()->that_bear(network.links(), network.n_joints(), network.n_grains(), holds);
  ASSERT_EQ(left.pieces().size(), pieces.size());
  ASSERT_EQ(left.pieces().front().size(), pieces.front().size() - 1);
  double whole = 0.0;
  for (std::size_t k = 0; k < left.pieces().front().size(); ++k)
    {
      const auto& pair = left.pieces().front()[k];
      EXPECT_EQ(pair.image, pieces.front()[k + 1].image);
      EXPECT_NEAR(pair.share * (1.0 - std::abs(pieces.front().front().share)), pieces.front()[k + 1].share, 1e-12);
      whole += std::abs(pair.share);
    }
  EXPECT_NEAR(whole, 1.0, 1e-12);
  for (std::size_t p = 1; p < pieces.size(); ++p)
    EXPECT_EQ(left.pieces()[p].size(), pieces[p].size());

  // A body in two halves carries nothing from side to side: no pair has both of its grains in one of them.
  const auto nothing_holds = [](std::uint32_t) { return false; };
  EXPECT_TRUE(
    network.conditions()->that_bear(network.links(), network.n_joints(), network.n_grains(), nothing_holds).are_none());
}

TYPED_TEST(Boundaries, TakenUpGiveTheBitsOfTheUnbrokenRun)
{
  constexpr int dim = TypeParam::value;
  const auto [whole, broken] =
    tests::whole_and_taken_up([] { return pulled_under<dim>({.kind = BoundaryKind::weakly_periodic, .n_pieces = 2}); });
  EXPECT_GT(whole.record().cracks.size(), 5u);
  EXPECT_EQ(broken.rve().state().motions, whole.rve().state().motions);
  EXPECT_EQ(broken.rve().state().stress, whole.rve().state().stress);
}
} // namespace
} // namespace feldspar
