// The parallel bond: pairs pulled, sheared, twisted and bent against closed forms, and a wandering one against a plain
// program; each beyond breakage.

#include "dem/dynamics/sweeps/joint_sweep.h"
#include "dem/laws/parallel_bond.h"
#include "tests/unit/parallel_bonds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace feldspar
{
namespace
{
using std::numbers::pi;
constexpr std::size_t n_pairs = 2 * pack_width + 3; // packs, and some over

const ParticleContactParameters contact{60e9, 1.5, 0.4};

template <typename>
using ParallelBondPair = testing::Test;
TYPED_TEST_SUITE(ParallelBondPair, Dimensions);

/// Pairs along x, far from each other, that are just in contact.
template <int dim>
Specimen<dim> pairs(const ParallelBondParameters& wanted = test_bonds())
{
  std::vector<double> radii;
  Components<dim> positions;
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const double one = 1e-3 + 2e-5 * double(k);
      const double two = 1.4e-3 - 1e-5 * double(k);
      for (const double radius : {one, two})
        {
          positions[0].push_back(radii.size() % 2 == 0 ? 0.0 : one + two);
          positions[1].push_back(0.01 * double(k));
          if constexpr (dim == 3)
            positions[2].push_back(0.0);
          radii.push_back(radius);
        }
    }
  Specimen<dim> specimen = placed_specimen<dim>(radii, positions);
  specimen.particle_contact = contact;
  install_joints(specimen, wanted);
  return specimen;
}

/// Sizes of a pair's bond as Potyondy and Cundall have them.
template <int dim>
struct Beam
{
  explicit Beam(const Specimen<dim>& specimen, const std::size_t pair)
  {
    const ParallelBondParameters bonds = test_bonds();
    const double one = specimen.grains.radius[2 * pair];
    const double two = specimen.grains.radius[2 * pair + 1];
    const double least = std::min(one, two);
    radius = bonds.radius_multiplier * least;
    area = dim == 2 ? 2.0 * radius : pi * radius * radius;
    second_moment = dim == 2 ? 2.0 / 3.0 * std::pow(radius, 3) : pi * std::pow(radius, 4) / 4.0;
    polar_moment = pi * std::pow(radius, 4) / 2.0;
    normal_stiffness = bonds.modulus / (one + two);
    shear_stiffness = normal_stiffness / bonds.stiffness_ratio;
    contact_normal_stiffness = contact.modulus * (dim == 2 ? 2.0 * least : pi * least * least) / (one + two);
    contact_shear_stiffness = contact_normal_stiffness / contact.stiffness_ratio;
  }
  double radius, area, second_moment, polar_moment;
  double normal_stiffness, shear_stiffness;                 ///< of the bond [Pa/m]
  double contact_normal_stiffness, contact_shear_stiffness; ///< [N/m]
};

/// Share of the strength to which pair k is strained, so that some bonds break and others hold: none lies at the limit
/// itself.
double share(const std::size_t k) { return 0.13 * double(k + 1); }

template <int dim>
Vector<dim> force_of(const Specimen<dim>& specimen, const std::size_t pair)
{
  return at<dim>(specimen.joints.force, pair);
}

/// Motion by an opening, a slip across and turns about the middle of the contact without slip.
template <int dim>
void move_pair(Specimen<dim>& specimen, const std::size_t pair, const double opening, const double across,
               const Rotation<dim>& turn)
{
  auto& grains = specimen.grains;
  grains.position[0][2 * pair + 1] += opening;
  const double mean_opening = specimen.joints.opening[pair] + 0.5 * opening;
  const double one = grains.radius[2 * pair] + 0.5 * mean_opening; // arms of the contact point
  const double two = grains.radius[2 * pair + 1] + 0.5 * mean_opening;
  // Both turn by -slip over the distance: no relative turn; then by shares of the relative one that leave no slip.
  Rotation<dim> both = Rotation<dim>::Zero();
  both[n_rotations<dim> - 1] = -across / (one + two);
  set<n_rotations<dim>>(grains.spin, 2 * pair, Rotation<dim>(both - two / (one + two) * turn));
  set<n_rotations<dim>>(grains.spin, 2 * pair + 1, Rotation<dim>(both + one / (one + two) * turn));
}

/// Sweeps the pairs: one break of each bond that is strained beyond its strength, all in this mode.
template <int dim>
void expect_breaks(Specimen<dim>& specimen, const bool in_tension)
{
  const auto breaks = sweep_joints(specimen.joints, specimen.grains, 1.0);
  std::size_t n_broken = 0;
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      n_broken += share(k) > 1.0;
      EXPECT_EQ(specimen.joints.holds(k), share(k) < 1.0);
    }
  ASSERT_EQ(breaks.size(), n_broken);
  ASSERT_GT(n_broken, 0u);
  for (const Break& event : breaks)
    EXPECT_EQ(event.in_tension, in_tension);
}

TYPED_TEST(ParallelBondPair, PulledBearsItsTensileStrengthThenNothing)
{
  constexpr int dim = TypeParam::value;
  auto specimen = pairs<dim>();
  ASSERT_EQ(specimen.joints.size(), n_pairs);
  const double strength = test_bonds().bond_tensile_strength;
  for (std::size_t k = 0; k < n_pairs; ++k)
    move_pair(specimen, k, share(k) * strength / Beam<dim>(specimen, k).normal_stiffness, 0.0, Rotation<dim>::Zero());
  expect_breaks(specimen, true);
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const double pull = share(k) * strength * Beam<dim>(specimen, k).area;
      const double round_off = 1e-8 * pull; // of openings as differences of positions
      EXPECT_NEAR(-force_of(specimen, k)[0], share(k) < 1.0 ? pull : 0.0, round_off);
    }

  // Pressed back beyond rest: where the bond has broken the contact alone acts, else both.
  for (std::size_t k = 0; k < n_pairs; ++k)
    specimen.grains.position[0][2 * k + 1] = specimen.grains.radius[2 * k] + specimen.grains.radius[2 * k + 1] - 1e-7;
  EXPECT_TRUE(sweep_joints(specimen.joints, specimen.grains, 1.0).empty());
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const Beam<dim> beam(specimen, k);
      const double of_bond = share(k) < 1.0 ? beam.normal_stiffness * beam.area * 1e-7 : 0.0;
      EXPECT_NEAR(force_of(specimen, k)[0], beam.contact_normal_stiffness * 1e-7 + of_bond,
                  1e-7 * beam.contact_normal_stiffness * 1e-7);
    }
}

TYPED_TEST(ParallelBondPair, BentBreaksAtTheEdgeAndThenRollsFreely)
{
  constexpr int dim = TypeParam::value;
  auto specimen = pairs<dim>();
  const ParallelBondParameters bonds = test_bonds();
  // Pressed by δ, so that the edge is at the strength σ_c = -k_n δ + β k_n θ R̄.
  constexpr double pressed = 2e-7;
  const auto angle = [&](const Beam<dim>& beam) {
    return (bonds.bond_tensile_strength / beam.normal_stiffness + pressed) / (bonds.moment_contribution * beam.radius);
  };
  Rotation<dim> axis = Rotation<dim>::Zero();
  axis[n_rotations<dim> - 1] = 1.0;
  for (std::size_t k = 0; k < n_pairs; ++k)
    move_pair<dim>(specimen, k, -pressed, 0.0, share(k) * angle(Beam<dim>(specimen, k)) * axis);
  expect_breaks(specimen, true);
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const Beam<dim> beam(specimen, k);
      const bool holds = share(k) < 1.0;
      const double moment = beam.normal_stiffness * beam.second_moment * share(k) * angle(beam);
      const auto& couple = specimen.joints.couple_2[n_rotations<dim> - 1];
      EXPECT_NEAR(couple[k], holds ? -moment : 0.0, 1e-9 * moment);
      EXPECT_NEAR(force_of(specimen, k)[0],
                  beam.contact_normal_stiffness * pressed + (holds ? beam.normal_stiffness * beam.area * pressed : 0.0),
                  1e-7 * beam.contact_normal_stiffness * pressed);
    }
}

TEST(ParallelBondInSpace, TwistedBreaksAtTheRimAndThenSpinsFreely)
{
  auto specimen = pairs<3>();
  const ParallelBondParameters bonds = test_bonds();
  // Without normal stress the shear strength is the cohesion: c = β k_s R̄ θ.
  const auto angle = [&](const Beam<3>& beam) {
    return bonds.bond_cohesion / (beam.shear_stiffness * bonds.moment_contribution * beam.radius);
  };
  for (std::size_t k = 0; k < n_pairs; ++k)
    move_pair<3>(specimen, k, 0.0, 0.0, share(k) * angle(Beam<3>(specimen, k)) * Rotation<3>::UnitX());
  expect_breaks(specimen, false);
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const Beam<3> beam(specimen, k);
      const double moment = beam.shear_stiffness * beam.polar_moment * share(k) * angle(beam);
      EXPECT_NEAR(specimen.joints.couple_2[0][k], share(k) < 1.0 ? -moment : 0.0, 1e-10 * moment);
      EXPECT_NEAR(specimen.joints.couple_1[0][k], share(k) < 1.0 ? moment : 0.0, 1e-10 * moment);
    }
}

TYPED_TEST(ParallelBondPair, ShearedUnderPressureBreaksByCoulombAndLeavesTheFrictionOfTheContact)
{
  constexpr int dim = TypeParam::value;
  auto specimen = pairs<dim>();
  const ParallelBondParameters bonds = test_bonds();
  // σ = -k_n δ, τ_c = c + k_n δ tan φ. The contact sticks up to μ K_n δ / K_s = μ κ_c δ and slides beyond.
  constexpr double pressed = 3e-7;
  const auto slip = [&](const Beam<dim>& beam) {
    return (bonds.bond_cohesion + beam.normal_stiffness * pressed * std::tan(bonds.bond_friction_angle)) /
           beam.shear_stiffness;
  };
  for (std::size_t k = 0; k < n_pairs; ++k)
    move_pair<dim>(specimen, k, -pressed, share(k) * slip(Beam<dim>(specimen, k)), Rotation<dim>::Zero());
  expect_breaks(specimen, false);
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      const Beam<dim> beam(specimen, k);
      const double way = share(k) * slip(beam);
      const double of_contact =
        std::min(beam.contact_shear_stiffness * way, contact.friction * beam.contact_normal_stiffness * pressed);
      const double of_bond = share(k) < 1.0 ? beam.shear_stiffness * beam.area * way : 0.0;
      EXPECT_NEAR(-force_of(specimen, k)[1], of_contact + of_bond, 1e-8 * (of_contact + of_bond));
      // Slid so far under its limit, from nothing: half of that is the mean force.
      const double slid = way - of_contact / beam.contact_shear_stiffness;
      EXPECT_NEAR(specimen.joints.slip_energy[k], 0.5 * of_contact * slid, 1e-8 * of_contact * way);
      // No moment but those of the force at both arms.
      EXPECT_NEAR(specimen.joints.couple_1[n_rotations<dim> - 1][k] + specimen.joints.couple_2[n_rotations<dim> - 1][k],
                  (of_contact + of_bond) * specimen.joints.rest_distance[k], 1e-3 * (of_contact + of_bond) * 1e-3);
    }
}

/// The model once more, written plainly and with increments as the source has them; one pair.
template <int dim>
struct PlainPair
{
  PlainPair(const Beam<dim>& of, const ParallelBondParameters& wanted)
    : beam(of)
    , bonds(wanted)
  {
  }

  Beam<dim> beam;
  ParallelBondParameters bonds;
  bool bonded = true;
  double gap = 0.0;
  double bond_normal = 0.0; ///< tension positive [N]
  double bond_twist = 0.0;
  std::vector<double> bond_shear = std::vector<double>(dim - 1, 0.0);
  std::vector<double> bond_bending = std::vector<double>(dim - 1, 0.0);
  std::vector<double> contact_shear = std::vector<double>(dim - 1, 0.0);
  double contact_normal = 0.0;
  double work = 0.0; ///< done on the pair, by trapezoids [J]
  double slip = 0.0;
  double released = 0.0;

  static double size(const std::vector<double>& v)
  {
    double squared = 0.0;
    for (const double c : v)
      squared += c * c;
    return std::sqrt(squared);
  }

  double stored_in_bond() const
  {
    double twice = bond_normal * bond_normal / (beam.normal_stiffness * beam.area);
    twice += size(bond_shear) * size(bond_shear) / (beam.shear_stiffness * beam.area);
    twice += size(bond_bending) * size(bond_bending) / (beam.normal_stiffness * beam.second_moment);
    if (dim == 3)
      twice += bond_twist * bond_twist / (beam.shear_stiffness * beam.polar_moment);
    return 0.5 * twice;
  }

  double stored() const
  {
    return stored_in_bond() + 0.5 * contact_normal * contact_normal / beam.contact_normal_stiffness +
           0.5 * size(contact_shear) * size(contact_shear) / beam.contact_shear_stiffness;
  }

  void step(const double opening, const std::vector<double>& across, const std::vector<double>& bend,
            const double twist)
  {
    gap += opening;
    if (bonded)
      {
        bond_normal += beam.normal_stiffness * beam.area * opening;
        bond_twist -= beam.shear_stiffness * beam.polar_moment * twist;
        for (int c = 0; c < dim - 1; ++c)
          {
            bond_shear[c] -= beam.shear_stiffness * beam.area * across[c];
            bond_bending[c] -= beam.normal_stiffness * beam.second_moment * bend[c];
          }
        const double beta = bonds.moment_contribution;
        const double sigma = bond_normal / beam.area;
        const double largest = sigma + beta * size(bond_bending) * beam.radius / beam.second_moment;
        double tau = size(bond_shear) / beam.area;
        if (dim == 3)
          tau += beta * std::abs(bond_twist) * beam.radius / beam.polar_moment;
        if (largest > bonds.bond_tensile_strength ||
            tau > std::max(0.0, bonds.bond_cohesion - sigma * std::tan(bonds.bond_friction_angle)))
          {
            bonded = false;
            bond_normal = bond_twist = 0.0;
            std::fill(bond_shear.begin(), bond_shear.end(), 0.0);
            std::fill(bond_bending.begin(), bond_bending.end(), 0.0);
          }
      }
    contact_normal = std::max(0.0, -beam.contact_normal_stiffness * gap);
    for (int c = 0; c < dim - 1; ++c)
      contact_shear[c] -= beam.contact_shear_stiffness * across[c];
    const double limit = contact.friction * contact_normal;
    if (const double now = size(contact_shear); now > limit)
      for (double& component : contact_shear)
        component *= limit / now;
  }
};

template <int dim>
OneFace<dim> bonded_face(const ParallelBondParameters& bonds)
{
  OneFace<dim> face{{bonds.bond_tensile_strength, bonds.bond_cohesion, std::tan(bonds.bond_friction_angle)}};
  face.update.state.bonded = true;
  return face;
}

TYPED_TEST(ParallelBondPair, WanderingAgreesWithAPlainProgramAndKeepsItsEnergy)
{
  constexpr int dim = TypeParam::value;
  const auto specimen = pairs<dim>();
  const ParallelBondParameters bonds = test_bonds();
  const ParallelBond<dim> law(bonds, contact);
  const Face<double> face = specimen.joints.face(0);
  const Beam<dim> beam(specimen, 0);
  auto elements = bonded_face<dim>(bonds);
  PlainPair<dim> plain(beam, bonds);

  constexpr int n_steps = 4000;
  const auto motion_at = [&](const int step) {
    // Opens and closes, slides to and fro, bends and twists, ever farther; in units of the way at which it would break.
    const double t = 2e-3 * step;
    const double way = 0.4 * t * bonds.bond_tensile_strength / beam.normal_stiffness;
    FaceMotion<dim, double> motion{};
    motion.opening = way * (std::sin(3.1 * t) - 0.7);
    for (int c = 0; c < dim - 1; ++c)
      motion.slip_increment[c] = 4.0 * way * std::sin(2.3 * t + c); // the slip itself, as yet
    for (int c = 0; c < n_rotations<dim>; ++c)
      motion.rotation[c] = 0.4 * way / beam.radius * std::sin(1.7 * t + 0.5 * c);
    return motion;
  };
  double work = 0.0, slip_energy = 0.0, released = 0.0, largest_stored = 0.0;
  FaceResultants<dim, double> before{};
  int broke_at = 0;
  for (int step = 1; step <= n_steps; ++step)
    {
      const auto old = motion_at(step - 1);
      auto motion = motion_at(step);
      motion.opening_before = old.opening;
      motion.rotation_before = old.rotation;
      std::vector<double> across, bend;
      for (int c = 0; c < dim - 1; ++c)
        {
          motion.slip_increment[c] -= old.slip_increment[c];
          across.push_back(motion.slip_increment[c]);
          bend.push_back(motion.rotation[dim == 2 ? 0 : c + 1] - old.rotation[dim == 2 ? 0 : c + 1]);
        }
      const auto sum = law.template update<double>(face, specimen.joints.elements, motion, elements);
      plain.step(motion.opening - old.opening, across, bend, dim == 3 ? motion.rotation[0] - old.rotation[0] : 0.0);
      if (broke_at == 0 && !plain.bonded)
        broke_at = step;

      ASSERT_EQ(elements.update.state.bonded, plain.bonded) << step;
      const double round_off = 1e-9 * beam.area * bonds.bond_tensile_strength; // of 4000 increments
      EXPECT_NEAR(sum.normal_force, plain.contact_normal - plain.bond_normal, round_off);
      for (int c = 0; c < dim - 1; ++c)
        {
          EXPECT_NEAR(sum.shear_force[c], plain.contact_shear[c] + plain.bond_shear[c], round_off);
          EXPECT_NEAR(sum.moment[dim == 2 ? 0 : c + 1], plain.bond_bending[c], round_off * beam.radius);
        }
      if constexpr (dim == 3)
        {
          EXPECT_NEAR(sum.moment[0], plain.bond_twist, round_off * beam.radius);
        }

      // The work done on the pair is stored, slid away or released.
      work -= 0.5 * (before.normal_force + sum.normal_force) * (motion.opening - old.opening);
      for (int c = 0; c < dim - 1; ++c)
        work -= 0.5 * (before.shear_force[c] + sum.shear_force[c]) * motion.slip_increment[c];
      for (int c = 0; c < n_rotations<dim>; ++c)
        work -= 0.5 * (before.moment[c] + sum.moment[c]) * (motion.rotation[c] - old.rotation[c]);
      slip_energy += sum.slip_energy;
      released += elements.update.released_energy;
      before = sum;
      const double stored = law.stored_energy(face, specimen.joints.elements, motion.opening, motion.rotation,
                                              [&](unsigned int) { return elements.update.state; });
      EXPECT_NEAR(stored, plain.stored(), 1e-8 * (plain.stored() + largest_stored));
      largest_stored = std::max(largest_stored, stored);
      // The trapezoid is off by some parts in the steps of a period squared where the contact closes within a step.
      EXPECT_NEAR(work, stored + slip_energy + released, 1e-5 * (work + largest_stored)) << step;
    }
  EXPECT_GT(broke_at, 100);
  EXPECT_LT(broke_at, n_steps / 2);
  EXPECT_GT(released, 0.0);
  EXPECT_GT(slip_energy, largest_stored) << "it slid to and fro";
}

TYPED_TEST(ParallelBondPair, ABreakLeavesTheContactAsIfThereHadBeenNoBond)
{
  // Pressed, sheared to breaking in some steps and on: at the end the force is that of a pair that never had a bond, to
  // the bit, for its contact has gone through the same.
  constexpr int dim = TypeParam::value;
  auto bonded = pairs<dim>();
  ParallelBondParameters none = test_bonds();
  none.slit_fraction = 1.0;
  auto unbonded = pairs<dim>(none);
  std::size_t n_breaks = 0;
  for (int step = 0; step < 20; ++step)
    {
      for (auto* specimen : {&bonded, &unbonded})
        for (std::size_t k = 0; k < n_pairs; ++k)
          move_pair<dim>(*specimen, k, -2e-8, step < 15 ? 1e-6 : -1e-7, Rotation<dim>::Zero());
      n_breaks += sweep_joints(bonded.joints, bonded.grains, 1.0).size();
      EXPECT_TRUE(sweep_joints(unbonded.joints, unbonded.grains, 1.0).empty());
    }
  ASSERT_EQ(n_breaks, n_pairs);
  for (std::size_t k = 0; k < n_pairs; ++k)
    {
      EXPECT_EQ(force_of(bonded, k), force_of(unbonded, k));
      EXPECT_NE(force_of(bonded, k)[1], 0.0);
      EXPECT_EQ(bonded.joints.slip_energy[k], unbonded.joints.slip_energy[k]);
    }
}

TYPED_TEST(ParallelBondPair, BrokenItStaysAFaceHoweverFarItSlidesAndGoesWhenItIsFarOpen)
{
  constexpr int dim = TypeParam::value;
  ParallelBondParameters none = test_bonds();
  none.slit_fraction = 1.0;
  auto specimen = pairs<dim>(none);
  const Beam<dim> beam(specimen, 0);
  move_pair<dim>(specimen, 0, -1e-7, 5.0 * beam.radius, Rotation<dim>::Zero());
  sweep_joints(specimen.joints, specimen.grains, 1.0);
  EXPECT_TRUE(has_face(specimen.joints, 0));
  move_pair<dim>(specimen, 0, 1.9 * beam.radius, 0.0, Rotation<dim>::Zero());
  sweep_joints(specimen.joints, specimen.grains, 1.0);
  EXPECT_TRUE(has_face(specimen.joints, 0));
  EXPECT_EQ(force_of(specimen, 0).norm(), 0.0);
  EXPECT_EQ(joint_energy(specimen.joints, 0), 0.0) << "nothing is lost when it goes";
  move_pair<dim>(specimen, 0, 0.2 * beam.radius, 0.0, Rotation<dim>::Zero());
  sweep_joints(specimen.joints, specimen.grains, 1.0);
  EXPECT_FALSE(has_face(specimen.joints, 0));
}

TYPED_TEST(ParallelBondPair, SmallStrainsSeeTheSameStiffnessAndStrength)
{
  // The network's share of the law against one small step of the sweep's, of a pressed pair.
  constexpr int dim = TypeParam::value;
  const auto specimen = pairs<dim>();
  const ParallelBondParameters bonds = test_bonds();
  const ParallelBond<dim> law(bonds, contact);
  const Face<double> face = specimen.joints.face(0);
  const auto rows = element_rows(specimen.joints.elements.front(), face.half_length);
  const JointStiffness<dim> stiffness = law.bonded_stiffness(face, specimen.joints.elements.front(), rows);
  Motion<dim> pressed = Motion<dim>::Constant(1e-5); // turns
  pressed[0] = -1e-7;
  pressed.template segment<dim - 1>(1).setConstant(1e-9);
  auto elements = bonded_face<dim>(bonds);
  const Motion<dim> forces =
    forces_of<dim>(law.template update<double>(face, specimen.joints.elements, step_to<dim>(pressed), elements));
  ASSERT_TRUE(elements.update.state.bonded);
  EXPECT_LT((stiffness * pressed - forces).norm(), 1e-12 * forces.norm());

  const Bond<double> bond = elements.strength;
  for (int c = 0; c < n_motions<dim>; ++c)
    for (const double direction : {1.0, -1.0})
      {
        // Along one motion and away from rest: the factor at which the path meets the strength is that of the sweep.
        const Motion<dim> unit = direction * Motion<dim>::Unit(c);
        const PathToBreak path = path_to_break(bond, law.bond_stress(face, law.strain(rows, unit)));
        if (c == 0 && direction < 0.0)
          {
            EXPECT_TRUE(std::isinf(path.factor));
            continue;
          }
        for (const double part : {0.999, 1.001})
          {
            const auto to = step_to<dim>(part * path.factor * unit);
            auto fresh = bonded_face<dim>(bonds);
            law.template update<double>(face, specimen.joints.elements, to, fresh);
            EXPECT_EQ(fresh.update.state.bonded, part < 1.0) << c;
            EXPECT_EQ(fresh.update.tension_break, part > 1.0 && path.in_tension) << c;
          }
      }
}
} // namespace
} // namespace feldspar
