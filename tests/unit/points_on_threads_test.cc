#include "coupling/sample/grain_material.h"
#include "coupling/sample/softening.h"
#include "fem/solid/material_points.h"
#include "tests/unit/small_rve.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <any>
#include <cmath>
#include <memory>
#include <vector>

/// The points of a sample are all that it works on by several threads; several points share a packing. The thread sanitizer
/// runs these tests without deal.II, PETSc and MPI, which it could not look into.
namespace feldspar
{
namespace
{
/// Record of points of RVEs that soften along a path.
template <int dim>
struct Record
{
  std::vector<typename fem::MaterialPoints<dim>::Responses> responses; ///< of each step
  std::vector<std::size_t> n_events;                                   ///< of each step
  std::vector<NetworkState<dim>> states;                               ///< of each point's RVE at the end
  bool has_softened = false;
};

template <int dim>
Record<dim> strained_by_threads(const int n_threads)
{
  std::vector<Realisation<dim>> realisations;
  for (const std::uint64_t seed : {1, 2})
    realisations.emplace_back(std::make_shared<const Network<dim>>(periodic_specimen<dim>(seed)));
  const double size = std::pow(realisations.front().inside->volume(), 1.0 / dim);
  const auto material = scaled_softening(grain_material<dim>(realisations, {}), size);
  constexpr unsigned int n_points = dim == 2 ? 12 : 4;
  fem::MaterialPoints<dim> points;
  for (unsigned int k = 0; k < n_points; ++k)
    points.add(material.make_point({fmt::format("0_1:{}", k), k, 0, std::vector<double>(dim, 0.0), size / 3.0}));

  // Number of threads as wanted, on fewer cores too.
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, std::size_t(n_threads));
  oneapi::tbb::task_arena arena(n_threads);
  Record<dim> record;
  constexpr int n_steps = dim == 2 ? 8 : 4;
  for (int step = 1; step <= n_steps; ++step)
    arena.execute([&] {
      typename fem::MaterialPoints<dim>::Strains strains;
      for (unsigned int k = 0; k < n_points; ++k)
        strains.push_back((1.0 + 0.1 * k) * step / n_steps * axial<dim>(dim == 2 ? 2e-4 : 4e-4));
      points.trial(strains);
      std::size_t n_events = 0;
      while (const std::size_t n = points.relax(strains))
        n_events += n;
      record.n_events.push_back(n_events);
      record.responses.push_back(points.trial(strains));
      if (step == n_steps / 2) // a step that is cut
        points.reject();
      else
        points.accept(strains);
    });
  for (unsigned int k = 0; k < n_points; ++k)
    {
      record.states.push_back(std::any_cast<GrainStructure<dim>>(points[k].structure()).state);
      record.has_softened = record.has_softened || points[k].fields().back() > 0.0;
    }
  return record;
}

template <typename>
using PointsOnThreads = testing::Test;
TYPED_TEST_SUITE(PointsOnThreads, Dimensions);

TYPED_TEST(PointsOnThreads, HaveTheBitsOfOneThread)
{
  constexpr int dim = TypeParam::value;
  const Record<dim> one = strained_by_threads<dim>(1);
  const Record<dim> several = strained_by_threads<dim>(4);
  EXPECT_GT(one.n_events.back(), 0u);
  EXPECT_TRUE(one.has_softened);
  EXPECT_EQ(one.n_events, several.n_events);
  for (std::size_t k = 0; k < one.states.size(); ++k)
    {
      const NetworkState<dim>& state = one.states[k];
      const NetworkState<dim>& other = several.states[k];
      EXPECT_EQ(state.motions, other.motions) << k;
      EXPECT_EQ(state.stress, other.stress) << k;
      EXPECT_EQ(state.work.released, other.work.released) << k;
      EXPECT_EQ(state.work.slip, other.work.slip) << k;
      ASSERT_EQ(state.unbonded.size(), other.unbonded.size()) << k;
      for (std::size_t n = 0; n < state.unbonded.size(); ++n)
        {
          EXPECT_EQ(state.unbonded[n].segment, other.unbonded[n].segment) << k;
          EXPECT_EQ(state.unbonded[n].shear_stress, other.unbonded[n].shear_stress) << k;
        }
    }
  for (std::size_t step = 0; step < one.responses.size(); ++step)
    for (std::size_t k = 0; k < one.responses[step].size(); ++k)
      {
        EXPECT_EQ(one.responses[step][k].stress, several.responses[step][k].stress) << step << " " << k;
        EXPECT_EQ(one.responses[step][k].tangent, several.responses[step][k].tangent) << step << " " << k;
      }
}
} // namespace
} // namespace feldspar
