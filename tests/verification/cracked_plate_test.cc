// The plate with a crack in its middle, between grips: its intensity factor against the solid's release of energy, its
// extension and the opening of its crack, as grains, against closed forms.

#include "dem/genesis/genesis.h"
#include "dem/lab/laboratory_run.h"
#include "dem/lab/protocols/grips.h"
#include "dem/lab/protocols/notch.h"
#include "dem/lab/protocols/protocols.h"
#include "dem/specimen/specimen_part.h"
#include "fem/materials/linear_elasticity.h"
#include "fem/solid/solid.h"
#include "tests/unit/small_specimen.h"
#include "tests/unit/whole_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace feldspar
{
namespace
{
// ---- the continuum

constexpr double modulus_of_solid = 50e9;
constexpr double ratio_of_solid = 0.2;
constexpr double plane_modulus = modulus_of_solid / (1.0 - ratio_of_solid * ratio_of_solid);
constexpr unsigned int n_across = 40; // elements across half the width

/// Force on the end of a quarter of a plate, of half a width of 1 m and this length between its middle and the grip, that is
/// moved by 1 m [N/m]; the grip holds its width. The crack spans so many elements from the middle.
double force(const double half_length, const unsigned int n_cracked)
{
  const auto n_along = unsigned(std::lround(half_length * n_across));
  auto mesh = fem::plane_sample(MPI_COMM_WORLD, 1.0, half_length, {n_across, n_along}, 0);
  const dealii::types::boundary_id ligament = 17;
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == mesh.boundary("bottom") &&
          face->center()[0] * n_across > n_cracked)
        face->set_boundary_id(ligament);
  mesh.boundaries["ligament"] = ligament;
  fem::Load<2> load;
  load.displacements = {{"top", 1, [](const auto&) { return 1.0; }},
                        {"top", 0, [](const auto&) { return 0.0; }},
                        {"left", 0, [](const auto&) { return 0.0; }},
                        {"ligament", 1, [](const auto&) { return 0.0; }}};
  fem::Solid<2> solid(mesh, {.order = 2},
                      fem::linear_elasticity<2>(fem::isotropic_stiffness<2>(modulus_of_solid, ratio_of_solid)));
  const auto report = solid.solve(load);
  EXPECT_TRUE(report.converged) << report.failure;
  solid.accept();
  return solid.reaction("top", 1);
}

/// K_I over the gross stress of such a plate, from the energy that it gives up where its crack grows between fixed
/// grips. The energy U is half the force times the way; each of the four quarters has its share of it, and there are
/// two tips: K² / E' = -2 dU/da.
double intensity_over_stress(const double half_length, const unsigned int n_cracked)
{
  const double released = (force(half_length, n_cracked - 1) - force(half_length, n_cracked + 1)) * 0.5 * n_across;
  return std::sqrt(plane_modulus * released) / force(half_length, n_cracked);
}

TestParameters cracked(const double notch_ratio, const double grip_ratio)
{
  TestParameters wanted;
  wanted.of<NotchParameters>().ratio = notch_ratio;
  wanted.of<TensionParameters>().grip_ratio = grip_ratio;
  return wanted;
}

TEST(ACrackedPlate, HasTheIntensityOfTheSolidBetweenItsGripsWhereItIsValid)
{
  // The formula is of a long plate under uniform stress; grips that hold the width change it in a short one.
  const Specimen<2> specimen = small_specimen();
  const double width = 0.012;
  const double height = 0.020;
  for (const double length_over_width : {0.8, 1.2, 1.4})
    for (const unsigned int n_cracked : {12u, 20u, 28u})
      {
        SCOPED_TRACE(testing::Message() << "length " << length_over_width << " widths, cracked " << n_cracked);
        const double ratio = double(n_cracked) / n_across;
        const auto wanted = cracked(ratio, 0.5 * (1.0 - (length_over_width + 1e-9) * width / height));
        const auto notch = (*centre_cracked_plate.set_up<2>())(specimen, 0.0, wanted, {}).loading.notch;
        ASSERT_TRUE(notch);
        EXPECT_EQ(notch->is_valid, length_over_width >= 1.2);
        const double over_formula =
          intensity_over_stress(length_over_width, n_cracked) * std::sqrt(0.5 * width) / notch->intensity_over_stress;
        // 0.992 to 1.013 where it is valid, of which 0.004 are the elements': as many more would be closer to 1 by that.
        if (notch->is_valid)
          EXPECT_NEAR(over_formula, 1.0, 0.015);
        else
          EXPECT_LT(over_formula, n_cracked == 12 ? 0.985 : 0.95);
      }
}

// ---- grains

/// Table 1 with bonds that do not break, in a plate of 24 × 48 mm, 29 grains wide.
Specimen<2> strong_plate(const std::uint64_t seed)
{
  SpecimenParameters wanted;
  wanted.width = 0.024;
  wanted.height = 0.048;
  wanted.minimum_radius = 0.31e-3;
  FlatJointParameters flat_joint;
  flat_joint.coordination_number = 4.2;
  flat_joint.bond_tensile_strength *= 100.0;
  flat_joint.bond_cohesion *= 100.0;
  return make_specimen<2>(wanted, flat_joint, {}, seed);
}

TestOutcome pulled(const LaboratoryProtocol& protocol, const Specimen<2>& specimen, const double notch_ratio)
{
  TestParameters wanted = cracked(notch_ratio, 0.1);
  wanted.of<TensionParameters>().strain_rate = 0.05;
  wanted.stop_strain = 3e-5;
  return tests::outcome_of<2>({protocol}, specimen, wanted);
}

/// Slope of the stress over the strain, through the origin, over the second half of the curve [Pa].
double slope(const std::vector<CurveSample>& curve)
{
  double of_both = 0.0;
  double of_strain = 0.0;
  for (std::size_t k = curve.size() / 2; k < curve.size(); ++k)
    {
      of_both += curve[k].axial_strain * curve[k].axial_stress;
      of_strain += curve[k].axial_strain * curve[k].axial_strain;
    }
  return of_both / of_strain;
}

/// Extension that a crack of the length 2 a adds to that of a plate of this width, over the stress over the modulus
/// [m]. Under a held force half its work is released at the two tips, so that d(extension)/da = 4 K² / (E' σ W), here
/// with Feddersen's K.
double extension_over_strain(const double a, const double width)
{
  constexpr int n = 1000;
  double sum = 0.0;
  for (int k = 0; k < n; ++k)
    {
      const double t = std::numbers::pi * a / width * (k + 0.5) / n;
      sum += t / std::cos(t) / n;
    }
  return 4.0 * a * sum;
}

/// The opening in the middle of the same crack, over the same [m]: 4 a in a wide plate, and for a plate of this width the fit
/// of Tada, Paris and Irwin, within 0.6 %.
double opening_over_strain(const double a, const double width)
{
  const double r = 2.0 * a / width;
  return 4.0 * a * (-0.071 - 0.535 * r + 0.169 * r * r + 0.020 * r * r * r - 1.071 / r * std::log(1.0 - r));
}

/// Mean motion along the axis of the grains beside the crack on one side, within two mean diameters of its line and a quarter
/// of its half length of its middle [m].
double motion_of_face(const TestOutcome& outcome, const Vector<2>& middle, const double a, const double side)
{
  double sum = 0.0;
  double count = 0.0;
  for (const GrainPicture& grain : outcome.appearance.grains_at_end)
    if (const double above = side * (grain.start[1] - middle[1]); std::abs(grain.start[0] - middle[0]) < 0.25 * a &&
                                                                  above > 0.0 &&
                                                                  above < 4.0 * outcome.record.specimen.mean_radius)
      {
        sum += grain.position[1] - grain.start[1];
        ++count;
      }
  return sum / count;
}

TEST(ACrackedPlate, OfGrainsExtendsAndOpensAsTheSolidDoes)
{
  // For the forces a hole ends half a mean diameter behind the line along which it was cut (docs/theory.md §3.1), and so does
  // this crack: by half a grain longer at each tip, 7 % of its length. Over these seeds the extension is 0.90 to 1.10
  // of the closed form, 1.00 on average, the opening 0.93 to 1.03. Over the forms of a crack as long as its cut they would be
  // 1.17 and 1.08 on average, over the extension of a crack in an infinite plate 1.22.
  constexpr double ratio = 0.5;
  constexpr unsigned int n_seeds = 4;
  double mean_extension = 0.0; // over the closed form
  for (unsigned int seed = 1; seed <= n_seeds; ++seed)
    {
      SCOPED_TRACE(seed);
      const Specimen<2> specimen = strong_plate(seed);
      const double width = specimen.size[0];
      const double length = 0.8 * specimen.size[1];
      const TestOutcome whole = pulled(direct_tension, specimen, ratio);
      const TestOutcome outcome = pulled(centre_cracked_plate, specimen, ratio);
      ASSERT_TRUE(whole.record.cracks.empty());
      ASSERT_TRUE(outcome.record.cracks.empty());

      const double a = 0.5 * ratio * width + specimen.report.mean_radius;
      const double modulus = slope(whole.record.curve);
      const double extension = (modulus / slope(outcome.record.curve) - 1.0) * length;
      EXPECT_NEAR(extension / extension_over_strain(a, width), 1.0, 0.15);
      mean_extension += extension / extension_over_strain(a, width) / n_seeds;
      const Vector<2> middle = 0.5 * specimen.size;
      const double opening = motion_of_face(outcome, middle, a, 1.0) - motion_of_face(outcome, middle, a, -1.0);
      const double strain = outcome.record.curve.back().axial_stress / modulus;
      EXPECT_NEAR(opening / (strain * opening_over_strain(a, width)), 1.0, 0.1);
    }
  EXPECT_NEAR(mean_extension, 1.0, 0.05);
}
} // namespace
} // namespace feldspar
