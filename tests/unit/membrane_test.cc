// The membrane around a body in the plane, a box and a cylinder: where it lies, what it presses, and tests under it.

#include "dem/flaws/apply.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/membrane.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/lab/surroundings.h"
#include "results/evaluation.h"
#include "tests/unit/same_bits.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace feldspar
{
namespace
{
using std::numbers::pi;

template <int dim>
LateralSurface<dim> surface_of(const Specimen<dim>& specimen)
{
  return lateral_surface(specimen, std::vector<bool>(specimen.grains.size(), true), 0.0, specimen.size[dim - 1]);
}

/// Sum of the shares of the grains that `counts(centre)` [m²].
template <int dim, typename Counts>
Vector<dim> share_of(const Specimen<dim>& specimen, const LateralSurface<dim>& surface, const Counts& counts)
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    if (counts(at<dim>(specimen.grains.position, i)))
      sum += at<dim>(surface.inward_area, i);
  return sum;
}

/// side: area of the sides of the specimen [m²]; section: of its ends.
template <int dim>
void expect_lies_around(const Specimen<dim>& specimen, const double side, const double section)
{
  const auto surface = surface_of(specimen);
  double area = 0.0;
  for (std::size_t i = 0; i < specimen.grains.size(); ++i)
    {
      const Vector<dim> a = at<dim>(surface.inward_area, i);
      area += a.norm();
      if (a.norm() == 0.0)
        continue;
      EXPECT_EQ(a[dim - 1], 0.0);
      // Inwards, and from the side: no grain that lies two mean diameters in gets a share.
      const Vector<dim - 1> from_axis =
        (at<dim>(specimen.grains.position, i) - 0.5 * specimen.size).template head<dim - 1>();
      EXPECT_LT(a.template head<dim - 1>().dot(from_axis), 0.0);
      const double out = specimen.is_round() ? from_axis.norm() : from_axis.cwiseAbs().maxCoeff();
      EXPECT_GT(out + specimen.grains.radius[i], 0.5 * specimen.size[0] - 4.0 * specimen.report.mean_radius);
    }
  // The membrane sags between the grains.
  EXPECT_LT(area, (1.0 + 1e-12) * side);
  EXPECT_GT(area, 0.85 * side);
  EXPECT_LT(surface.cross_section, section);
  EXPECT_GT(surface.cross_section, 0.75 * section);
  EXPECT_LT(share_of(specimen, surface, [](const auto&) { return true; }).norm(), 1e-12 * side);
}
} // namespace

TEST(Membrane, LiesAroundTheBodyAndPressesOuterGrainsOnly)
{
  const auto plane = small_specimen();
  expect_lies_around(plane, 2.0 * plane.size[1], plane.size[0]);
  expect_lies_around(small_cylinder(), pi * 8e-3 * 12e-3, 0.25 * pi * 64e-6);
  expect_lies_around(small_cylinder(1, 1.0, BodyShape::box), 4.0 * 8e-3 * 12e-3, 64e-6);
}

TEST(Membrane, PressesEachSideByTheAreaThatIsSeenAlsoWhereItBends)
{
  auto specimen = small_specimen();
  const Vector<2> size = specimen.size;
  for (const double shift : {0.0, 3.0 * specimen.report.mean_radius})
    {
      auto bent = specimen;
      for (std::size_t i = 0; i < bent.grains.size(); ++i)
        if (bent.grains.position[1][i] > 0.5 * size[1])
          bent.grains.position[0][i] += shift;
      const auto surface = surface_of(bent);
      const Vector<2> of_left =
        share_of(bent, surface, [&](const Vector<2>& x) { return x[0] < 0.5 * size[0] + 0.5 * shift; });
      EXPECT_NEAR(of_left[0], size[1], 1e-12 * size[1]); // per metre of depth
      // The shift leaves the width, but for what the membrane spans in the corner at either side of the step.
      const double spanned = surface.cross_section - surface_of(specimen).cross_section;
      EXPECT_GE(spanned, 0.0);
      EXPECT_LE(spanned, 2.0 * shift * shift / size[1]);
    }
  // A grain that is no part of the body is not met; those behind it are.
  const auto surface = surface_of(specimen);
  std::vector<bool> counts(specimen.grains.size(), true);
  std::size_t outer = 0;
  while (surface.inward_area[0][outer] == 0.0)
    ++outer;
  counts[outer] = false;
  const auto without = lateral_surface(specimen, counts, 0.0, size[1]);
  EXPECT_EQ(without.inward_area[0][outer], 0.0);
  EXPECT_LT(share_of(specimen, without, [](const auto&) { return true; }).norm(), 1e-12 * size[1]);
}

TEST(Membrane, IsDividedWhereAClosedFlawComesToTheSide)
{
  // Above a plane from side to side the left side is longer by W tan β, of the width W within the membrane; between the
  // outer grains that stand nearest to the plane the sides would be divided some radii off. Where the plane comes to it, the
  // membrane lies up to 0.4 radii in front of or behind its mean.
  const double angle = 40.0 * pi / 180.0;
  const auto is_above = [&](const auto& x, const auto& middle) {
    return x[x.size() - 1] - middle[x.size() - 1] > std::tan(angle) * (x[0] - middle[0]);
  };
  for (const std::uint64_t seed : {1, 2, 3})
    {
      auto plane = small_specimen(seed);
      const Vector<2> middle = 0.5 * plane.size;
      const Vector<2> half = middle[0] * Vector<2>(1.0, std::tan(angle));
      put_in_flaws<2>(plane, {ClosedFlaw{{middle - half, middle + half}, SmoothSides{}}});
      const auto surface = surface_of(plane);
      const Vector<2> above = share_of(plane, surface, [&](const Vector<2>& x) { return is_above(x, middle); });
      EXPECT_NEAR(above[0], surface.cross_section * std::tan(angle), 0.8 * plane.report.mean_radius) << seed;

      auto cylinder = small_cylinder(seed);
      const Vector<2> centre(0.5 * cylinder.size[0], 0.5 * cylinder.size[2]);
      const Vector<2> to_side = centre[0] * Vector<2>(1.0, std::tan(angle));
      put_in_flaws<3>(cylinder, {ClosedFlaw{{centre - to_side, centre + to_side}, SmoothSides{}}});
      const auto around = surface_of(cylinder);
      const Vector<3> of_upper =
        share_of(cylinder, around, [&](const Vector<3>& x) { return is_above(x, Vector<3>(0.5 * cylinder.size)); });
      // Projected along the first axis, the plane is the section times tan β.
      EXPECT_NEAR(of_upper[0] / (around.cross_section * std::tan(angle)), 1.0, 0.05) << seed;
    }
}

/// Compression under the membrane against that without confinement, both of one body.
template <int dim>
void expect_stronger_under_it(const Specimen<dim>& specimen, TestParameters wanted)
{
  const auto run = [&](const LaboratoryCase& test_case) {
    return tests::outcome_of<dim>(test_case, specimen, wanted).record;
  };
  wanted.of<ConfinementParameters>().lateral_boundary = LateralBoundary::membrane;
  const auto record = run({triaxial_compression, 20e6});
  const auto results = evaluate(record);
  ASSERT_TRUE(results.peak_stress.value) << results.peak_stress.reason;
  EXPECT_GT(*results.peak_stress.value, *evaluate(run({uniaxial_compression})).peak_stress.value + 20e6);
  EXPECT_LT(results.energy_imbalance, 0.01);
  // The platens begin at the confinement, within the tolerance of the seating and the membrane's sag.
  EXPECT_NEAR(record.curve.front().axial_stress, -20e6, 0.01 * 20e6);
  EXPECT_NEAR(record.curve.back().lateral_stress, -20e6, 1.0); // the load itself, mean over a row
  EXPECT_EQ(results.servo_error.reason, "the test has no servo");
}

TestParameters quick_under_membrane()
{
  TestParameters wanted = quick_compression();
  wanted.of<CompressionParameters>().strain_rate = 4.0;
  wanted.stop_strain_over_peak_strain = 1.1;
  wanted.of<ConfinementParameters>().lateral_boundary = LateralBoundary::membrane;
  return wanted;
}

TEST(Membrane, MakesBodiesStrongerAndItsWorkIsCounted)
{
  expect_stronger_under_it(small_specimen(), quick_under_membrane());
  expect_stronger_under_it(small_cylinder(), quick_under_membrane());
  expect_stronger_under_it(small_cylinder(1, 1.0, BodyShape::box), quick_under_membrane());
}

TEST(Membrane, HoldsTheIntermediateStressOfABox)
{
  // At rest under three stresses the body strains as one that is isotropic within the scatter of some 150 grains: it
  // shortens most along the axis of the largest.
  auto wanted = quick_under_membrane();
  wanted.of<ConfinementParameters>().intermediate_stress = 40e6;
  const auto box = small_cylinder(1, 1e3, BodyShape::box);
  EXPECT_EQ(LabTest<3>({triaxial_compression, 10e6}, box, wanted, {}).finish(true).record.intermediate_stress, 40e6);
  auto set_up = triaxial_compression.set_up<3>().value()(box, 10e6, wanted, {});
  set_up.loading.seat(set_up.dynamics, [] {});
  const Vector<3> first(0.5 * box.size);
  double inwards[2] = {0.0, 0.0}; // moments of the displacement
  for (std::size_t i = 0; i < box.grains.size(); ++i)
    for (int c = 0; c < 2; ++c)
      inwards[c] -= (set_up.dynamics.specimen().grains.position[c][i] - box.grains.position[c][i]) *
                    (box.grains.position[c][i] - first[c]);
  EXPECT_GT(inwards[1], 2.0 * inwards[0]);
}

TEST(Membrane, GivesTheSameBitsOnTwoThreadsAndAfterACheckpoint)
{
  const LaboratoryCase under{triaxial_compression, 10e6};
  const auto plane = small_specimen(1, 0.2); // weak, so that it cracks soon
  tests::expect_same_bits_on_two_threads(plane, quick_under_membrane(), 30, under);
  tests::expect_same_bits_when_resumed(plane, plane, quick_under_membrane(), 15, 15, under);
  const auto cylinder = small_cylinder(1, 0.2);
  tests::expect_same_bits_when_resumed(cylinder, cylinder, quick_under_membrane(), 8, 12, under);
}
} // namespace feldspar
