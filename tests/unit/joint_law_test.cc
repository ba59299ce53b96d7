// The boundary of a joint law: one that is not in the list, as small as can be, goes through installation, storage, the
// sweep by packs, energies and the criterion of equilibria as the flat joint does.

#include "dem/dynamics/sweeps/joint_state_of_law.h"
#include "dem/dynamics/sweeps/joint_sweep_of_law.h"
#include "dem/genesis/joint_installation.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
struct ElasticBondParameters : FlatJointParameters
{
};

/// A spring over the whole face that breaks as one, carries no moment and leaves nothing. It stores the largest normal
/// stress that it ever carried.
template <int dim>
struct ElasticBond : CarriedPlane<dim>
{
  using Parameters = ElasticBondParameters;
  static constexpr std::string_view name = "elastic bond";
  static constexpr std::size_t n_more = 1;
  static constexpr bool face_outlives_bonds = false;
  static constexpr bool face_can_slide_off = false;
  static constexpr bool linear_while_bonded = true;
  static constexpr bool has_equilibria = false;

  ElasticBond() = default;
  explicit ElasticBond(const Parameters&, const ParticleContactParameters& = {}) {}

  template <typename Real>
  struct State
  {
    std::array<Real, dim - 1> shear_stress;
    decltype(Real() < Real()) bonded;
    std::array<Real, 1> more;
  };

  template <typename Real>
  struct Update
  {
    State<Real> state;
    decltype(Real() < Real()) tension_break;
    decltype(Real() < Real()) shear_break;
    Real released_energy;
  };

  static FaceDivision<dim> division(const Parameters&)
  {
    if constexpr (dim == 2)
      return {1};
    else
      return {1, 1};
  }

  static std::vector<Bond<double>> draw_bonds(const Parameters& wanted, const std::size_t n_elements, Random&)
  {
    return std::vector<Bond<double>>(
      n_elements, {wanted.bond_tensile_strength, wanted.bond_cohesion, std::tan(wanted.bond_friction_angle)});
  }

  static double friction(const Parameters&, const ParticleContactParameters&) { return 0.0; }
  static double normal_stress(const Face<double>& face, const FaceElement<dim>&, const FaceMotion<dim, double>& motion,
                              const Update<double>& update)
  {
    return update.state.bonded ? face.normal_stiffness * motion.opening : 0.0;
  }
  static FaceSprings stiffest(const Face<double>& face) { return face_springs<dim>(face); }

  template <typename Real>
  static Real area(const Face<Real>& face)
  {
    if constexpr (dim == 2)
      return 2.0 * face.thickness * face.half_length;
    else
      return std::numbers::pi * face.half_length * face.half_length;
  }

  template <typename Real, typename Elements>
  FaceResultants<dim, Real> update(const Face<Real>& face, const std::vector<FaceElement<dim>>&,
                                   const FaceMotion<dim, Real>& motion, Elements&& elements) const
  {
    const Bond<Real> bond = elements.bond(0);
    const State<Real> old = elements.state(0);
    const Real normal_stress = face.normal_stiffness * motion.opening;
    Update<Real> update;
    update.state.more[0] = simd::larger(old.more[0], simd::select(old.bonded, normal_stress, Real(0.0)));
    Real squared(0.0);
    for (int c = 0; c < dim - 1; ++c)
      {
        update.state.shear_stress[c] = old.shear_stress[c] - face.shear_stiffness * motion.slip_increment[c];
        squared += update.state.shear_stress[c] * update.state.shear_stress[c];
      }
    update.tension_break = old.bonded && normal_stress > bond.tensile_strength;
    update.shear_break =
      old.bonded && !update.tension_break && simd::square_root(squared) > shear_strength(bond, normal_stress);
    update.state.bonded = old.bonded && !(update.tension_break || update.shear_break);
    update.released_energy =
      0.5 * area(face) * (normal_stress * normal_stress / face.normal_stiffness + squared / face.shear_stiffness);

    FaceResultants<dim, Real> sum{simd::select(update.state.bonded, -normal_stress * area(face), Real(0.0)),
                                  {},
                                  {},
                                  Real(0.0)};
    sum.moment.fill(Real(0.0));
    for (int c = 0; c < dim - 1; ++c)
      {
        update.state.shear_stress[c] = simd::select(update.state.bonded, update.state.shear_stress[c], Real(0.0));
        sum.shear_force[c] = update.state.shear_stress[c] * area(face);
      }
    elements.set(0, update);
    return sum;
  }

  template <typename StateOf>
  double stored_energy(const Face<double>& face, const std::vector<FaceElement<dim>>&, const double opening,
                       const std::array<double, n_rotations<dim>>&, StateOf&& state_of) const
  {
    const State<double> state = state_of(0);
    double energy = state.bonded ? 0.5 * area(face) * face.normal_stiffness * opening * opening : 0.0;
    for (const double tau : state.shear_stress)
      energy += 0.5 * area(face) * tau * tau / face.shear_stiffness;
    return energy;
  }

  JointStiffness<dim> bonded_stiffness(const Face<double>& face, const FaceElement<dim>&,
                                       const ElementRows<dim>& rows) const
  {
    Vector<dim> springs = Vector<dim>::Constant(face.shear_stiffness * area(face));
    springs[0] = face.normal_stiffness * area(face);
    return rows.transpose() * springs.asDiagonal() * rows;
  }

  static Vector<dim> strain(const ElementRows<dim>& rows, const Motion<dim>& motion) { return rows * motion; }
  static BondStress bond_stress(const Face<double>& face, const Vector<dim>& strain)
  {
    const double normal = face.normal_stiffness * strain[0];
    return {normal, normal, face.shear_stiffness * strain.template tail<dim - 1>().norm()};
  }
};

static_assert(JointLaw<ElasticBond<2>, 2> && JointLaw<ElasticBond<3>, 3>);
static_assert(JointLaw<FlatJoint<2>, 2> && JointLaw<FlatJoint<3>, 3>);
static_assert(!JointLaw<CarriedPlane<2>, 2>, "moving with its grains alone makes no law");
static_assert(!JointLaw<FlatJoint<2>, 3>, "a law of the plane is none of space");

template <typename>
using JointLawBoundary = testing::Test;
TYPED_TEST_SUITE(JointLawBoundary, Dimensions);

/// Grains in a row along x that are just in contact; more than two packs of joints and some over.
template <int dim>
Specimen<dim> row_of_grains(const ElasticBondParameters& wanted)
{
  constexpr std::size_t n = 2 * pack_width + 4;
  std::vector<double> radii;
  Components<dim> positions;
  double x = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    {
      radii.push_back(1e-3 + 1e-5 * double(i));
      x += radii.back();
      for (int c = 0; c < dim; ++c)
        positions[c].push_back(c == 0 ? x : 0.0);
      x += radii.back();
    }
  Specimen<dim> specimen = placed_specimen<dim>(radii, positions);
  install_joints(specimen, ElasticBond<dim>(wanted), wanted);
  return specimen;
}

ElasticBondParameters wanted_bonds()
{
  ElasticBondParameters wanted;
  wanted.installation_gap_ratio = 1e-6;
  return wanted;
}

TYPED_TEST(JointLawBoundary, AForeignLawIsInstalledSweptAndForgottenByItsOwnRules)
{
  constexpr int dim = TypeParam::value;
  const ElasticBondParameters wanted = wanted_bonds();
  const ElasticBond<dim> law(wanted);
  Specimen<dim> specimen = row_of_grains<dim>(wanted);
  auto& joints = specimen.joints;
  auto& grains = specimen.grains;
  const std::size_t n = grains.size() - 1;
  ASSERT_EQ(joints.size(), n);
  ASSERT_EQ(joints.n_segments, 1u);

  // Pair j opens by 0.13 (j + 1) of what its bond carries.
  const auto critical = [&](const std::size_t j) { return wanted.bond_tensile_strength / joints.normal_stiffness[j]; };
  const auto opening = [&](const std::size_t j) { return 0.13 * double(j + 1) * critical(j); };
  const auto breaks_at = [](const std::size_t j) { return 0.13 * double(j + 1) > 1.0; };
  const auto open = [&](const double share) {
    double x = grains.position[0][0];
    for (std::size_t j = 0; j < n; ++j)
      grains.position[0][j + 1] = x += grains.radius[j] + grains.radius[j + 1] + share * opening(j);
  };
  open(1.0);
  SweepMemory<dim> memory(joints);
  const auto breaks = sweep_joints(law, joints, grains, 1.0, memory);

  std::size_t n_broken = 0;
  for (std::size_t j = 0; j < n; ++j)
    {
      const double area = face_area<dim>(joints.half_length[j], 1.0);
      const double pull = joints.normal_stiffness[j] * area * opening(j); // k_n A U_n
      const double round_off = 1e-8 * pull;                               // of openings as differences of positions
      EXPECT_NEAR(joints.force[0][j], breaks_at(j) ? 0.0 : -pull, round_off);
      EXPECT_NEAR(joint_energy(law, joints, j), breaks_at(j) ? 0.0 : 0.5 * pull * opening(j), round_off * opening(j));
      EXPECT_NEAR(joints.more(0)[j], joints.normal_stiffness[j] * opening(j), 1e-7 * wanted.bond_tensile_strength);
      EXPECT_EQ(has_face(law, joints, j), !breaks_at(j));
      EXPECT_TRUE(has_face(FlatJoint<dim>(), joints, j)) << "its faces have not gone past each other";
      if (breaks_at(j))
        {
          ASSERT_LT(n_broken, breaks.size());
          EXPECT_EQ(breaks[n_broken].joint, j);
          EXPECT_TRUE(breaks[n_broken].in_tension);
          EXPECT_NEAR(breaks[n_broken].released_energy, 0.5 * pull * opening(j), round_off * opening(j));
          ++n_broken;
        }
    }
  EXPECT_EQ(breaks.size(), n_broken);
  EXPECT_GT(n_broken, 0u);
  EXPECT_LT(n_broken, n);

  // Let go by half: the number of the law's own stays, here and in a copy of which joints have gone.
  open(0.5);
  EXPECT_TRUE(sweep_joints(law, joints, grains, 1.0, memory).empty());
  Joints<dim> kept = joints;
  std::vector<std::size_t> odd;
  for (std::size_t j = 1; j < n; j += 2)
    odd.push_back(j);
  kept.keep(odd);
  for (std::size_t k = 0; k < odd.size(); ++k)
    EXPECT_EQ(kept.more(0)[k], joints.more(0)[odd[k]]);
  EXPECT_GT(kept.more(0)[0], 1.9 * joints.normal_stiffness[1] * joints.opening[1]);

  // Storage names it for whoever writes it to a file.
  std::vector<std::string> names;
  joints.visit_per_segment([&](const std::string& name, const PackedRow&) { names.push_back(name); });
  EXPECT_EQ(names.back(), "more_1");
}

TYPED_TEST(JointLawBoundary, SlipBreaksItByTheCriterionOfAllLaws)
{
  constexpr int dim = TypeParam::value;
  ElasticBondParameters wanted = wanted_bonds();
  wanted.bond_cohesion = 10e6;
  const ElasticBond<dim> law(wanted);
  for (const double share : {0.999, 1.001})
    {
      Specimen<dim> specimen = row_of_grains<dim>(wanted);
      auto& joints = specimen.joints;
      // All turn alike by dt × spin: neighbours slip by the distance of their centres times the angle.
      const double distance = joints.rest_distance[0];
      const double angle = share * wanted.bond_cohesion / joints.shear_stiffness[0] / distance;
      auto& spin = specimen.grains.spin.back(); // about the axis across the row that makes it slip in the plane
      std::fill(spin.begin(), spin.end(), angle);
      SweepMemory<dim> memory(joints);
      const auto breaks = sweep_joints(law, joints, specimen.grains, 1.0, memory);
      // k_s ∝ 1/(R1 + R2) and slips ∝ R1 + R2: the same stress everywhere.
      EXPECT_EQ(breaks.size(), share > 1.0 ? joints.size() : 0u);
      for (const Break& event : breaks)
        EXPECT_FALSE(event.in_tension);
    }
}

TYPED_TEST(JointLawBoundary, TheNetworkSeesTheSameStiffnessAndStrengthAsTheSweep)
{
  constexpr int dim = TypeParam::value;
  const ElasticBondParameters wanted = wanted_bonds();
  const ElasticBond<dim> law(wanted);
  const Specimen<dim> specimen = row_of_grains<dim>(wanted);
  const auto& joints = specimen.joints;
  const Face<double> face = joints.face(0);
  const auto rows = element_rows(joints.elements.front(), face.half_length);
  const double area = face_area<dim>(face.half_length, 1.0);

  // Springs along the axes of the face, none against turning.
  JointStiffness<dim> expected = JointStiffness<dim>::Zero();
  expected(0, 0) = face.normal_stiffness * area;
  for (int c = 1; c < dim; ++c)
    expected(c, c) = face.shear_stiffness * area;
  const JointStiffness<dim> stiffness = law.bonded_stiffness(face, joints.elements.front(), rows);
  EXPECT_LT((stiffness - expected).norm(), 1e-12 * expected.norm());

  const Bond<double> bond{joints.tensile_strength[0], joints.cohesion[0], joints.friction_slope};
  const auto stress_at = [&](const Motion<dim>& motion) { return law.bond_stress(face, law.strain(rows, motion)); };
  const PathToBreak pulled = path_to_break(bond, stress_at(Motion<dim>::Unit(0)));
  EXPECT_TRUE(pulled.in_tension);
  EXPECT_DOUBLE_EQ(pulled.factor, wanted.bond_tensile_strength / face.normal_stiffness);
  const PathToBreak sheared = path_to_break(bond, stress_at(Motion<dim>::Unit(1)));
  EXPECT_FALSE(sheared.in_tension);
  EXPECT_DOUBLE_EQ(sheared.factor, wanted.bond_cohesion / face.shear_stiffness);

  // Pressed and sheared: (15) raises the strength; the path, the overload and the bound are of one surface.
  const Motion<dim> pressed = Motion<dim>::Unit(1) - 0.3 * Motion<dim>::Unit(0);
  const PathToBreak both = path_to_break(bond, stress_at(pressed));
  EXPECT_GT(both.factor, sheared.factor);
  EXPECT_FALSE(is_overloaded(bond, stress_at((1.0 - 1e-12) * both.factor * pressed)));
  EXPECT_TRUE(is_overloaded(bond, stress_at((1.0 + 1e-12) * both.factor * pressed)));
  EXPECT_NEAR(overload_ratio(bond, stress_at(both.factor * pressed)), 1.0, 1e-12);
  const BondStress rate = stress_at(pressed);
  EXPECT_GE(largest_overload(bond, {std::abs(rate.tension), std::abs(rate.normal), rate.shear}), 1.0 / both.factor);
}
} // namespace
} // namespace feldspar
