// The same solid on all ranks together and on each alone. Run by mpirun with two and with four.

#include "fem/materials/linear_elasticity.h"
#include "fem/materials/mohr_coulomb.h"
#include "fem/solid/advance.h"
#include "fem/solid/boundary_work.h"
#include "fem/solid/cell_balance.h"
#include "fem/solid/discretisation.h"
#include "fem/solid/platens.h"
#include "tests/brittle_point.h"
#include "tests/fem_samples.h"

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <petscvec.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace feldspar::fem
{
namespace
{
constexpr double E = 50e9;
constexpr double nu = 0.2;

/// Newton's tolerance is 1e-12; what it leaves is some condition number larger.
constexpr double tolerance = 1e-8;

template <int dim, int material_dim>
void expect_same_fields(const Solid<dim, material_dim>& together, const Solid<dim, material_dim>& alone)
{
  ASSERT_LT(together.places().size(), alone.places().size()) << "this test wants mpirun";
  std::map<std::pair<std::string, unsigned int>, std::size_t> index;
  for (std::size_t i = 0; i < alone.places().size(); ++i)
    index[{alone.places()[i].cell, alone.places()[i].quadrature_point}] = i;
  const double stress_scale = alone.mean_stress().norm();
  const double strain_scale = alone.mean_strain().norm();
  for (std::size_t i = 0; i < together.places().size(); ++i)
    {
      const std::size_t other = index.at({together.places()[i].cell, together.places()[i].quadrature_point});
      EXPECT_EQ(together.places()[i].position, alone.places()[other].position);
      EXPECT_LT((together.responses()[i].stress - alone.responses()[other].stress).norm(), tolerance * stress_scale);
      EXPECT_LT((together.strains()[i] - alone.strains()[other]).norm(), tolerance * strain_scale);
      EXPECT_NEAR(together.material_points()[i].fields().empty() ? 0.0 : together.material_points()[i].fields()[0],
                  alone.material_points()[other].fields().empty() ? 0.0 : alone.material_points()[other].fields()[0],
                  tolerance);
    }
}

TEST(SeveralRanks, PlasticSampleBetweenRoughPlatens)
{
  const double q_u = 86e6; // about, of the rock below
  const auto load = PlatenTest<2>{.platens = Platens::rough}.pressing(-1.15 * 0.1 * q_u / E);
  const auto solved = [&](const SampleMesh<2>& mesh, const LinearSolver linear_solver) {
    auto solid = std::make_unique<Solid<2, 3>>(
      mesh, SolidParameters{.order = 2, .linear_solver = linear_solver, .newton_tolerance = 1e-12},
      mohr_coulomb({E, nu, 20e6, 0.7, 0.3}));
    EXPECT_TRUE(solid->solve(load).converged);
    solid->accept();
    return solid;
  };
  const auto here = plane_sample(MPI_COMM_SELF, 0.05, 0.1, {2, 4}, 2);
  const auto everywhere = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 2);
  const auto alone = solved(here, LinearSolver::mumps);
  for (const LinearSolver linear_solver : {LinearSolver::mumps, LinearSolver::gmres})
    {
      const auto together = solved(everywhere, linear_solver);
      expect_same_fields(*together, *alone);
      EXPECT_NEAR(together->reaction("top", 1), alone->reaction("top", 1),
                  tolerance * std::abs(alone->reaction("top", 1)));
      EXPECT_NEAR(together->mean_displacement("right", 0), alone->mean_displacement("right", 0), tolerance * 1e-5);
    }
}

TEST(SeveralRanks, SampleUnderAFreePlate)
{
  // Stiffer to the left, so that the plate ties nodes that would part; the two ranks share it.
  const Material<2> halves{[](const PointPlace& place) {
                             return std::make_unique<LinearElasticPoint<2>>(
                               isotropic_stiffness<2>(place.position[0] < 0.025 ? 3.0 * E : E, nu));
                           },
                           {}};
  Load<2> load;
  load.displacements = {{"left", 0, constant<2>(0.0)}, {"bottom", 1, constant<2>(0.0)}};
  load.pressures = {{"right", 5e6}, {"top", 10e6}};
  load.free_plates = {{"top", 1}, {"right", 0}};
  const auto solved = [&](const SampleMesh<2>& mesh) {
    auto solid = std::make_unique<Solid<2>>(
      mesh, SolidParameters{.linear_solver = LinearSolver::conjugate_gradients, .newton_tolerance = 1e-12}, halves);
    const auto report = solid->solve(load);
    EXPECT_TRUE(report.converged) << report.failure;
    solid->accept();
    return solid;
  };
  const auto here = plane_sample(MPI_COMM_SELF, 0.05, 0.1, {2, 4}, 2);
  const auto everywhere = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 2);
  expect_same_fields(*solved(everywhere), *solved(here));
}

/// Eight rows of cells, each stronger than the one before by a tenth; broken ones keep 0.8 of the stress, so that all get
/// their turn.
template <typename BrittlePointType = BrittlePoint>
Material<2> brittle_rows()
{
  return {[](const PointPlace& place) {
            const double limit = 1e-4 * (1.0 + 0.1 * std::floor(place.position[1] / 0.0125));
            return std::make_unique<BrittlePointType>(isotropic_stiffness<2>(E, 0.0), limit, 0.8);
          },
          {"broken"}};
}

SampleMesh<2> eight_rows(const MPI_Comm communicator) { return plane_sample(communicator, 0.05, 0.1, {4, 8}, 0); }

/// The events of each step. No step ends at a limit.
std::vector<std::uint64_t> pull(Solid<2>& solid, const int first_step, const int last_step)
{
  std::vector<std::uint64_t> n_events;
  for (int step = first_step; step <= last_step; ++step)
    {
      const auto report = solid.solve(PlatenTest<2>().pressing(step * 0.23e-4 * 0.1));
      EXPECT_TRUE(report.converged) << report.failure;
      n_events.push_back(report.n_events);
      solid.accept();
    }
  return n_events;
}

constexpr std::uint64_t n_points_in_eight_rows = 8 * 4 * 4;

TEST(SeveralRanks, SampleThatBreaks)
{
  const auto here = eight_rows(MPI_COMM_SELF);
  const auto everywhere = eight_rows(MPI_COMM_WORLD);
  Solid<2> alone(here, {.newton_tolerance = 1e-12}, brittle_rows());
  Solid<2> together(everywhere, {.newton_tolerance = 1e-12}, brittle_rows());
  const auto expected = pull(alone, 1, 10);
  EXPECT_EQ(pull(together, 1, 10), expected);
  EXPECT_EQ(std::accumulate(expected.begin(), expected.end(), std::uint64_t(0)), n_points_in_eight_rows);
  expect_same_fields(together, alone);
}

TEST(SeveralRanks, StateGoesFromAnyNumberOfRanksToAnyOther)
{
  const SolidParameters parameters{.newton_tolerance = 1e-12};
  const auto everywhere = eight_rows(MPI_COMM_WORLD);
  const auto here = eight_rows(MPI_COMM_SELF);
  Solid<2> together(everywhere, parameters, brittle_rows());
  pull(together, 1, 6);

  // To one: each rank gets all.
  StoredSolid all{{}, together.stored().pressures};
  for (auto& of_rank : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, together.stored().cells))
    all.cells.insert(all.cells.end(), of_rank.begin(), of_rank.end());
  Solid<2> alone(here, parameters, brittle_rows());
  alone.restore(all);
  expect_same_fields(together, alone);
  EXPECT_NEAR(together.reaction("top", 1), alone.reaction("top", 1), tolerance * alone.reaction("top", 1));

  // From one: the last rank brings all.
  const auto everywhere_too = eight_rows(MPI_COMM_WORLD);
  Solid<2> together_again(everywhere_too, parameters, brittle_rows());
  const auto rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const bool is_last = rank + 1 == dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  together_again.restore(is_last ? alone.stored() : StoredSolid{{}, alone.stored().pressures});

  const auto expected = pull(together, 7, 10);
  EXPECT_EQ(pull(alone, 7, 10), expected);
  EXPECT_EQ(pull(together_again, 7, 10), expected);
  expect_same_fields(together, alone);
  expect_same_fields(together_again, alone);

  // A cell that is missing, or of another mesh, is known to all.
  all.cells.pop_back();
  EXPECT_THROW(alone.restore(all), std::invalid_argument);
  EXPECT_THROW(together.restore({{}, {}}), std::invalid_argument);
  all.cells.front().number = 1000;
  EXPECT_THROW(alone.restore(all), std::invalid_argument);
}

// PETSc keeps the norm of a vector until it is written. Where only some processes seem to have written it, the others skip the sum
// of the next norm, and the run stands still: seen where cells had moved so that one of four processes owned no node.
TEST(SeveralRanks, ReadingEntriesIsNoWriting)
{
  const auto rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const auto n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int n_owned = rank + 1 == n_ranks ? 0 : 3;
  NodalVector vector(MPI_COMM_WORLD, 3 * (n_ranks - 1), n_owned);
  vector = 2.0;
  EXPECT_DOUBLE_EQ(vector.l2_norm(), 2.0 * std::sqrt(3.0 * (n_ranks - 1)));
  dealii::IndexSet owned(3 * (n_ranks - 1));
  owned.add_range(std::min(3 * rank, 3 * (n_ranks - 1)), 3 * rank + n_owned);
  EXPECT_EQ(entries(vector, owned), std::vector<double>(n_owned, 2.0));
  PetscBool is_kept = PETSC_FALSE;
  PetscReal norm = 0.0;
  VecNormAvailable(vector, NORM_2, &is_kept, &norm);
  EXPECT_TRUE(is_kept);
}

// Times are given here and not measured: a busy machine may let one of four ranks wait for a core that it shares.
TEST(SeveralRanks, SharesAreEvenOnceCellsHaveMoved)
{
  const auto mesh = eight_rows(MPI_COMM_WORLD);
  Discretisation<2> elements(mesh, {});
  CellBalance<2> balance;
  const auto is_slow = [](const auto& cell) { return cell->center()[1] < 0.025; };
  const auto round = [&] {
    std::vector<double> seconds;
    for (const auto& cell : elements.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        seconds.push_back(is_slow(cell) ? 1.0 : 1e-3);
    balance.place(elements);
    balance.note_round(seconds);
    return balance.strike(MPI_COMM_WORLD);
  };
  const auto before = round();
  // 8 of 32 cells are slow; the first rank has them all, and of two ranks 8 others.
  const auto n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const double total = 8.0 + 24e-3;
  EXPECT_NEAR(before.balance.mean, total / n_ranks, 1e-12);
  EXPECT_NEAR(before.balance.longest, 8.0 + (n_ranks == 2 ? 8e-3 : 0.0), 1e-12);
  EXPECT_EQ(before.balance.longest_unmoved, before.balance.longest);
  ASSERT_TRUE(before.balance.moved);

  std::map<std::uint64_t, unsigned int> weights;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      weights.emplace(number_of(cell), before.weights[weights.size()]);
  const auto weigh = mesh.triangulation->signals.weight.connect(
    [&](const auto& cell, const auto /*status*/) { return weights.at(number_of(cell)); });
  mesh.triangulation->repartition();
  weigh.disconnect();
  elements.distribute();
  const auto after = round();
  EXPECT_NEAR(after.balance.mean, before.balance.mean, 1e-12);
  EXPECT_NEAR(after.balance.longest_unmoved, before.balance.longest, 1e-12);
  // A rank may get a cell more than its share, as a piece of the curve ends with a whole cell.
  EXPECT_LT(after.balance.longest, before.balance.mean + 1.0);
}

TEST(SeveralRanks, CellsMoveToWhereThereIsTime)
{
  // The lowest two rows of eight take a millisecond or more a point, so that some ranks have all the work.
  class SlowPoint : public BrittlePoint
  {
  public:
    SlowPoint(const StiffnessMatrix<2>& its_stiffness, const double its_limit, const double its_share)
      : BrittlePoint(its_stiffness, its_limit, its_share)
      , is_slow(its_limit < 1.15e-4)
    {
    }
    MaterialResponse<2> trial(const StrainVector<2>& strain) const override
    {
      volatile int work = 0;
      while (is_slow && work < 5'000'000)
        work = work + 1;
      return BrittlePoint::trial(strain);
    }

  private:
    bool is_slow;
  };
  const auto here = eight_rows(MPI_COMM_SELF);
  const auto everywhere = eight_rows(MPI_COMM_WORLD);
  Solid<2> alone(here, {.newton_tolerance = 1e-12}, brittle_rows());
  Solid<2> together(everywhere, {.newton_tolerance = 1e-12}, brittle_rows<SlowPoint>());
  const auto n_slow_points = [&] {
    return dealii::Utilities::MPI::max(std::count_if(together.places().begin(), together.places().end(),
                                                     [](const PointPlace& place) { return place.position[1] < 0.025; }),
                                       MPI_COMM_WORLD);
  };
  const auto expected = pull(alone, 1, 10);
  auto events = pull(together, 1, 3);
  const auto n_before = n_slow_points();
  const Balance before = together.rebalance();
  EXPECT_TRUE(before.moved);
  EXPECT_GT(before.longest, 1.5 * before.mean);
  EXPECT_EQ(before.longest, before.longest_unmoved);
  EXPECT_LT(n_slow_points(), n_before);

  for (const auto n : pull(together, 4, 10))
    events.push_back(n);
  const Balance after = together.rebalance();
  EXPECT_LT(after.longest, after.longest_unmoved);
  EXPECT_GT(after.longest_unmoved, 1.5 * after.mean);
  EXPECT_EQ(events, expected);
  expect_same_fields(together, alone);
}

TEST(SeveralRanks, FailureOfAPointOfOneRankIsKnownToAll)
{
  // Points of the upper half fail: all of one rank's, as the first cells go to the other.
  class FailingPoint : public LinearElasticPoint<2>
  {
  public:
    using LinearElasticPoint<2>::LinearElasticPoint;
    MaterialResponse<2> trial(const StrainVector<2>& strain) const override
    {
      if (strain.norm() > 0.0)
        throw PointFailure("never");
      return LinearElasticPoint<2>::trial(strain);
    }
  };
  const Material<2> material{[](const PointPlace& place) -> std::unique_ptr<MaterialPoint<2>> {
                               if (place.position[1] > 0.09)
                                 return std::make_unique<FailingPoint>(isotropic_stiffness<2>(E, nu));
                               return std::make_unique<LinearElasticPoint<2>>(isotropic_stiffness<2>(E, nu));
                             },
                             {}};
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 2);
  Solid<2> solid(mesh, {}, material);
  const auto report = solid.solve(PlatenTest<2>{.platens = Platens::rough}.pressing(-1e-5));
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.failure, "a material point has no response to its strain");
}
} // namespace
} // namespace feldspar::fem
