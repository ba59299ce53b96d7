// A sample of finite elements that follows the stages of a loading table. Linear elasticity between smooth platens is
// in a uniform state, so that each stage ends where Hooke's law says.

#include "coupling/sample/checkpoints.h"
#include "coupling/sample/sample_run.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/loading_stages.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <vector>

namespace feldspar
{
namespace
{
constexpr double elastic_modulus = 50e9;
constexpr double poissons_ratio = 0.2;

SampleParameters elastic_sample(const SampleGeometry geometry)
{
  SampleParameters sample;
  sample.geometry = geometry;
  sample.material = "linear elasticity";
  sample.elements_across = 1;
  sample.elements_along = 2;
  sample.compression_step = 1e-4;
  return sample;
}

SampleTest staged_sample(const SampleGeometry geometry, const std::vector<LoadingStage>& stages)
{
  TestParameters wanted;
  wanted.of<LoadingTable>().stages = stages;
  return {{own_loading.kind}, elastic_sample(geometry), wanted, {elastic_modulus, poissons_ratio}};
}

void go_on(SampleTest& test, std::size_t n_rows = 1000)
{
  while (n_rows-- > 0 && !test.has_ended())
    test.advance([](const SampleStanding&) {}, [] {});
}

/// Strain from the seating at `start` to a state; compression positive.
struct ElasticState
{
  double axial;
  double lateral;

  double axial_strain_from(const ElasticState& start, const double n_lateral) const
  {
    return (axial - start.axial - poissons_ratio * n_lateral * (lateral - start.lateral)) / elastic_modulus;
  }
  double lateral_strain_from(const ElasticState& start, const double n_lateral) const
  {
    return (lateral - start.lateral -
            poissons_ratio * (axial - start.axial + (n_lateral - 1.0) * (lateral - start.lateral))) /
           elastic_modulus;
  }
};

class StagesOfASample : public testing::TestWithParam<SampleGeometry>
{
};

TEST_P(StagesOfASample, EndWhereHookesLawSays)
{
  const std::vector<LoadingStage> stages{
    {.axial_strain = 1e-3, .confining_pressure = 5e6},
    {.axial_stress = 20e6, .confining_pressure = 5e6},
    {.duration = 2e-4, .confining_pressure = 10e6},                      // the platens stand still
    {.axial_stress = 30e6, .duration = 3e-4, .confining_pressure = 1e6}, // they hold a stress
    {.axial_stress = 60e6, .confining_pressure = 1e6},                   // and close again
    {.lateral_strain = -6e-4, .confining_pressure = 2e6, .strain_rate = 0.25},
    {.axial_strain = 5e-4, .confining_pressure = 4e6}};
  SampleTest test = staged_sample(GetParam(), stages);
  go_on(test);
  const TestRecord record = test.finish(false).record;
  EXPECT_EQ(record.ended_early, "");
  ASSERT_EQ(record.stages.size(), stages.size());

  const double n_lateral = GetParam() == SampleGeometry::plane ? 1.0 : 2.0; // directions under the pressure
  const ElasticState seated{5e6, 5e6};
  const double row_of_stress = 1e-4 * elastic_modulus; // of one compression step
  for (std::size_t k = 0; k < stages.size(); ++k)
    {
      EXPECT_TRUE(record.stages[k].reached) << k;
      const CurveSample& end = record.curve[record.stages[k].last_row];
      const ElasticState state{-end.axial_stress, -end.lateral_stress};
      EXPECT_NEAR(state.lateral, stages[k].confining_pressure, 1e-6 * stages[k].confining_pressure) << k;
      // Newton's tolerance is 1e-5 of the forces; strains are of some 1e-3.
      EXPECT_NEAR(-end.axial_strain, state.axial_strain_from(seated, n_lateral), 1e-8) << k;
      EXPECT_NEAR(-end.gauge_lateral_strain, state.lateral_strain_from(seated, n_lateral), 1e-8) << k;
      const LoadingStage& wanted = stages[k];
      if (wanted.axial_strain)
        {
          EXPECT_NEAR(-end.axial_strain, *wanted.axial_strain, 1e-9) << k;
        }
      else if (wanted.axial_stress)
        {
          // Held to Newton's tolerance; or just beyond.
          const double tolerance = wanted.duration ? 1e-5 * *wanted.axial_stress : 0.01 * row_of_stress;
          EXPECT_NEAR(state.axial, *wanted.axial_stress, tolerance) << k;
        }
      else if (wanted.lateral_strain)
        {
          EXPECT_NEAR(-end.gauge_lateral_strain, *wanted.lateral_strain, 2e-7) << k;
        }
    }
  // Nothing moves where the platens stand still.
  const auto strain_at = [&](const std::uint64_t row) { return record.curve[row].axial_strain; };
  EXPECT_NEAR(strain_at(record.stages[2].first_row), strain_at(record.stages[2].last_row), 1e-12);
  EXPECT_NEAR(record.curve[record.stages[3].last_row].time - record.curve[record.stages[3].first_row].time, 3e-4, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kinematics, StagesOfASample,
                         testing::Values(SampleGeometry::plane, SampleGeometry::axisymmetric),
                         [](const auto& geometry) {
                           return geometry.param == SampleGeometry::plane ? "Plane" : "Axisymmetric";
                         });

// Held by a stress or by their place, the platens do work that an elastic body stores: back at the stresses of the seating
// all of it has come back.
TEST(StagesOfAnElasticSample, GiveBackTheWorkOfACycle)
{
  SampleTest test =
    staged_sample(SampleGeometry::plane, {{.axial_stress = 80e6, .confining_pressure = 5e6},
                                          {.axial_stress = 80e6, .duration = 3e-4, .confining_pressure = 20e6},
                                          {.axial_stress = 5e6, .confining_pressure = 20e6},
                                          {.axial_stress = 5e6, .duration = 3e-4, .confining_pressure = 5e6}});
  go_on(test);
  const TestRecord record = test.finish(false).record;
  ASSERT_EQ(record.stages.size(), 4u);
  const double at_start = record.curve.front().energies.boundary_work;
  double largest = 0.0;
  for (const CurveSample& row : record.curve)
    largest = std::max(largest, row.energies.boundary_work - at_start);
  EXPECT_GT(largest, 0.0);
  // The last hold ends at 5 MPa all round to Newton's tolerance of 1e-5 of the forces.
  EXPECT_NEAR(record.curve.back().energies.boundary_work, at_start, 1e-4 * largest);
  EXPECT_NEAR(record.curve.back().axial_strain, 0.0, 1e-8);
}

TEST(StagesOfAnElasticSample, TakenUpFromACheckpointGoOnToTheSameBits)
{
  const std::vector<LoadingStage> stages{{.axial_stress = 40e6, .confining_pressure = 5e6},
                                         {.axial_stress = 40e6, .duration = 5e-4, .confining_pressure = 15e6},
                                         {.lateral_strain = -3e-4, .confining_pressure = 15e6, .strain_rate = 0.25},
                                         {.axial_stress = 20e6, .confining_pressure = 15e6}};
  SampleTest whole = staged_sample(SampleGeometry::plane, stages);
  go_on(whole);
  const auto expected = whole.finish(false).record;
  for (const std::size_t n_rows : {3u, 11u, 16u})
    {
      const tests::TemporaryFolder folder;
      SampleTest first = staged_sample(SampleGeometry::plane, stages);
      go_on(first, n_rows);
      ASSERT_FALSE(first.has_ended()) << n_rows;
      first.write_state(folder.path(), "mine");
      SampleTest second = staged_sample(SampleGeometry::plane, stages);
      second.read_state(checkpoints_in(folder.path()).front(), "mine", folder.path(), "fields");
      go_on(second);
      const auto found = second.finish(false).record;
      ASSERT_EQ(found.curve.size(), expected.curve.size()) << n_rows;
      for (std::size_t k = 0; k < expected.curve.size(); ++k)
        {
          EXPECT_EQ(found.curve[k].axial_stress, expected.curve[k].axial_stress) << n_rows << ", row " << k;
          EXPECT_EQ(found.curve[k].time, expected.curve[k].time) << n_rows << ", row " << k;
        }
      ASSERT_EQ(found.stages.size(), expected.stages.size());
      EXPECT_EQ(found.stages.back().first_row, expected.stages.back().first_row);
    }
}
} // namespace
} // namespace feldspar
