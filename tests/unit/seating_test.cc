// Walls that hold a specimen before its test counts.

#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/protocols.h"
#include "laboratory/loading_stages.h"
#include "results/runs/run.h"
#include "results/runs/trust.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace feldspar
{
namespace
{
using tests::has;

/// In a box that is so much larger [m]: at the lower and the upper end and at each side.
template <int dim>
Specimen<dim> in_larger_box(Specimen<dim> specimen, const double below, const double above, const double beside = 0.0)
{
  for (int c = 0; c < dim; ++c)
    {
      const bool is_axis = c == dim - 1;
      specimen.size[c] += is_axis ? below + above : 2.0 * beside;
      for (double& x : specimen.grains.position[c])
        x += is_axis ? below : beside;
    }
  return specimen;
}

template <int dim>
std::string refusal(const LaboratoryProtocol& protocol, const Specimen<dim>& specimen,
                    const TestParameters& wanted = {})
{
  return tests::refusal([&] {
    LabTest<dim>({protocol, protocol.kind.takes_confining_pressure ? 5e6 : 0.0}, specimen, wanted, {});
  });
}

/// Loaded to this row of the curve.
template <int dim>
TestRecord loaded(const LaboratoryProtocol& protocol, const Specimen<dim>& specimen, const TestParameters& wanted = {},
                  const std::size_t n_rows = 25)
{
  LabTest<dim> test({protocol, protocol.kind.takes_confining_pressure ? 5e6 : 0.0}, specimen, wanted, {});
  while (test.curve().size() < n_rows && test.advance())
    ;
  return test.finish(false).record;
}

TestParameters pressed_by_a_table()
{
  TestParameters wanted;
  wanted.of<LoadingTable>().stages = {{.axial_strain = 1e-3}};
  return wanted;
}

/// Tests between platens: their stress at a strain of some 2e-4 is that without a gap.
template <int dim>
void expect_the_same_in_a_larger_box(const Specimen<dim>& specimen)
{
  const double radius = specimen.report.mean_radius;
  for (const LaboratoryProtocol* const protocol :
       {&uniaxial_compression, &triaxial_compression, &direct_shear, &own_loading})
    {
      SCOPED_TRACE(protocol->kind.name);
      const TestRecord tight = loaded(*protocol, specimen, pressed_by_a_table());
      EXPECT_EQ(tight.way_to_grains, 0.0); // walls of a genesis touch its grains
      const double expected = tight.kind.deviator(tight.curve.back(), tight.confining_pressure);
      ASSERT_GT(expected, 1e6);
      // The smaller gap is 1 µm at each side: just more than the furthest grain lies in its wall. A wall that touches one grain
      // stays where it is.
      for (const double gap : {2e-6, 0.4 * radius})
        {
          const TestRecord wide =
            loaded(*protocol, in_larger_box(specimen, 0.5 * gap, gap, 0.5 * gap), pressed_by_a_table());
          EXPECT_NEAR(wide.way_to_grains, gap,
                      0.002 * radius); // grains lie up to a thousandth of a radius in their walls
          // The area of the box is larger by the gaps, at most by 0.4 radii in a width of 14 or 7; where only the grains that
          // protrude furthest touch a wall at first, the stress lags by their overlap at the packing stress, some 1e-5 of the
          // strain.
          const double area = specimen.volume() / specimen.size[dim - 1];
          const double area_of_box = area * std::pow(1.0 + gap / specimen.size[0], dim - 1);
          const double counted = protocol->kind.takes_confining_pressure ? 1.0 : area_of_box / area;
          EXPECT_NEAR(wide.kind.deviator(wide.curve.back(), wide.confining_pressure) * counted, expected,
                      0.1 * expected)
            << gap;
        }
    }
}

TEST(Seating, BringsWallsToTheGrainsInThePlane) { expect_the_same_in_a_larger_box(small_specimen()); }
TEST(Seating, BringsWallsToTheGrainsInSpace)
{
  expect_the_same_in_a_larger_box(small_cylinder(1, 1.0, BodyShape::box));
}

TEST(Seating, RefusesABodyThatDoesNotFillItsBox)
{
  const auto specimen = small_specimen();
  const double radius = specimen.report.mean_radius; // some 0.8 mm, of which half is allowed
  for (const LaboratoryProtocol* const protocol : laboratory_protocols())
    {
      SCOPED_TRACE(protocol->kind.name);
      const std::string above = refusal(*protocol, in_larger_box(specimen, 0.0, 1e-3), pressed_by_a_table());
      EXPECT_TRUE(has(above, "lower end 0 mm, upper end 1 mm, left side 0 mm, right side 0 mm"));
      EXPECT_FALSE(has(above, "\n"));
      const std::string beside = refusal(*protocol, in_larger_box(specimen, 0.0, 0.0, 2e-3), pressed_by_a_table());
      EXPECT_TRUE(has(beside, "left side 2 mm, right side 2 mm"));
    }
  EXPECT_EQ(refusal(uniaxial_compression, in_larger_box(specimen, 0.0, 0.45 * radius)), "");
  const std::string round = refusal(triaxial_compression, in_larger_box(small_cylinder(), 0.0, 0.0, 1e-3));
  EXPECT_TRUE(has(round, "round side 0.999 mm")); // a grain lies in its wall by a micrometre
}

TEST(Seating, RefusesABodyInTwoPieces)
{
  // The upper half of the body is a tenth of a millimetre away, without a joint to the lower: an open flaw from side to
  // side.
  auto specimen = small_specimen();
  const double middle = 0.5 * specimen.size[1];
  std::vector<std::size_t> kept;
  const auto& y = specimen.grains.position[1];
  for (std::size_t j = 0; j < specimen.joints.size(); ++j)
    if ((y[specimen.joints.grain_1[j]] < middle) == (y[specimen.joints.grain_2[j]] < middle))
      kept.push_back(j);
  specimen.joints.keep(kept);
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    if (specimen.grains.position[1][i] >= middle)
      specimen.grains.position[1][i] += 1e-4;
  specimen.size[1] += 1e-4;
  for (const LaboratoryProtocol* const protocol :
       {&uniaxial_compression, &triaxial_compression, &direct_shear, &own_loading})
    EXPECT_TRUE(has(refusal(*protocol, specimen, pressed_by_a_table()), "goes right through")) << protocol->kind.name;
  EXPECT_TRUE(has(refusal(direct_tension, specimen), "no bonds lead from one grip to the other"));
}

TEST(Seating, IsToldInTheVerdict)
{
  const auto specimen = small_specimen();
  const auto verdict = [&](const double gap) {
    TestParameters wanted;
    wanted.stop_stress_over_peak = 0.8;
    const FinishedTest one =
      finished(tests::outcome_of<2>({uniaxial_compression}, in_larger_box(specimen, 0.0, gap), wanted),
               "uniaxial_compression", "uniaxial_compression_seed_1", "", {});
    return shortcomings({&one}, SeriesKind::specimens).front();
  };
  EXPECT_FALSE(has(verdict(0.0), "brought"));
  EXPECT_TRUE(has(verdict(2e-4), "walls were brought to the grains by up to 0.2 mm"));
}

// The outermost grain of this disc has no bond: held as its pad it was driven through the disc, which carried nothing
// up to a strain of 1 % and then "118 MPa". The disc has some 30 GPa from the start.
TEST(Seating, HoldsABrazilianDiscByGrainsThatAreBondedToIt)
{
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.05;
  SpecimenParameters wanted;
  wanted.width = 0.012;
  wanted.height = 0.024;
  const TestRecord record = loaded(brazilian, make_specimen<2>(wanted, joint, {}, 88));
  EXPECT_GT(record.kind.deviator(record.curve.back(), 0.0), 10e9 * -record.curve.back().axial_strain);
}
} // namespace
} // namespace feldspar
