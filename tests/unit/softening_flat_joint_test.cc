// The softening segment: closed forms of its lines and energies in tension and shear, a wandering face against a plain
// program of fibres, and packs against numbers.

#include "base/random.h"
#include "dem/laws/softening_flat_joint.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace feldspar::softening
{
namespace
{
// Two grains of 1 mm, E = 80 GPa, μ = 0.5, one segment of four; σ_b = 20 MPa at 0.5 µm, c = 60 MPa, 30°.
const Face<double> face{40e12, 32e12, 1e-3, 1.0, 0.5};
const auto elements = face_elements<2>(4u);
const flat_joint::Segment<2, double> segment = place_segment(face, elements[0]).segment;
const Bond<double> bond{20e6, 60e6, std::tan(std::acos(-1.0) / 6.0)};
constexpr double elastic_opening = 20e6 / 40e12;
constexpr double softening_opening = 4e-6;

/// One segment with prescribed gap and shear, in steps that are small against both openings.
class LedSegment
{
public:
  explicit LedSegment(const double over_opening = softening_opening)
    : opening(over_opening)
  {
  }

  void go(const double to_gap, const double to_shear, const int n_steps)
  {
    const double from_gap = gap;
    const double from_shear = shear;
    for (int i = 1; i <= n_steps; ++i)
      {
        const double now = from_gap + (to_gap - from_gap) * i / n_steps;
        const double way = from_shear + (to_shear - from_shear) * i / n_steps;
        const auto update = softening::update<2, double>(segment, bond, opening, state, {gap, now, 0.0, {way - shear}});
        // Trapezoid of the force along the step.
        const double force_now = -update.normal.force;
        work += 0.5 * (force + force_now) * (now - gap) -
                0.5 * (state.shear_stress[0] + update.state.shear_stress[0]) * (way - shear) * segment.area();
        force = force_now;
        state = update.state;
        gap = now;
        shear = way;
        friction += update.slip_energy;
        released += update.released_energy;
        tension_breaks += update.tension_break;
        shear_breaks += update.shear_break;
      }
  }

  double stress() const { return force / segment.area(); }
  double tau() const { return state.shear_stress[0]; }
  double stored() const
  {
    const bool bonded = state.bonded;
    return (bonded ? (1.0 - state.more[0]) * softening::energy_of_bond(segment, gap, 0.0) : 0.0) +
           flat_joint::normal_energy(segment, gap, 0.0, false) +
           0.5 * tau() * tau() * segment.area() / segment.shear_stiffness;
  }
  /// Energy that the bond has dissipated, broken or not.
  double of_bond() const { return released + (state.bonded ? state.more[2] : 0.0); }

  softening::State<2, double> state{{0.0}, true, {0.0, 0.0, 0.0}};
  double work = 0.0, friction = 0.0, released = 0.0;
  int tension_breaks = 0, shear_breaks = 0;

private:
  double opening, gap = 0.0, shear = 0.0, force = 0.0;
};

TEST(SofteningSegment, PulledItFollowsItsLineAndGivesTheEnergyBelowIt)
{
  LedSegment one;
  one.go(elastic_opening, 0.0, 100);
  EXPECT_NEAR(one.stress(), 20e6, 1.0);
  EXPECT_EQ(one.of_bond(), 0.0);
  one.go(elastic_opening + 0.25 * softening_opening, 0.0, 4000);
  EXPECT_NEAR(one.stress(), 15e6, 1.0);
  one.go(elastic_opening + 0.75 * softening_opening, 0.0, 8000);
  EXPECT_NEAR(one.stress(), 5e6, 1.0);
  EXPECT_TRUE(one.state.bonded);
  one.go(elastic_opening + 1.001 * softening_opening, 0.0, 4004);
  EXPECT_EQ(one.stress(), 0.0);
  EXPECT_EQ(one.tension_breaks, 1);
  EXPECT_EQ(one.shear_breaks, 0);
  // ½ σ_b (w + σ_b/k_n), the work of the triangle; errors are of the order of a step over the opening, 1 nm/0.5 µm.
  const double energy = 0.5 * 20e6 * (softening_opening + elastic_opening) * segment.area();
  EXPECT_NEAR(one.work, energy, 1e-3 * energy);
  EXPECT_NEAR(one.released, energy, 2e-3 * energy);
  EXPECT_EQ(one.state.more[2], 0.0) << "counted with the break";
}

TEST(SofteningSegment, UnloadsToItsOriginPressesWithItsWholeStiffnessAndComesBackToItsLine)
{
  LedSegment one;
  const double half_way = elastic_opening + 0.5 * softening_opening;
  one.go(half_way, 0.0, 5000);
  const double given = one.of_bond();
  one.go(0.4 * half_way, 0.0, 10);
  EXPECT_NEAR(one.stress(), 0.4 * 10e6, 1.0);
  one.go(-1e-7, 0.0, 10);
  EXPECT_NEAR(one.stress(), -40e12 * 1e-7, 1.0);
  one.go(half_way, 0.0, 10);
  EXPECT_NEAR(one.stress(), 10e6, 1.0);
  EXPECT_DOUBLE_EQ(one.of_bond(), given);
}

TEST(SofteningSegment, ShearedUnderPressureFallsToFrictionAndGivesTheEnergyAboveIt)
{
  const double pressure = 10e6;
  const double strength = 60e6 + pressure * bond.friction_slope;
  const double friction = 0.5 * pressure;
  const double k_s = segment.shear_stiffness;
  LedSegment one;
  one.go(-pressure / segment.normal_stiffness, 0.0, 1);
  const double at_strength = strength / k_s;
  one.go(-pressure / segment.normal_stiffness, at_strength, 100);
  EXPECT_NEAR(one.tau(), -strength, 1.0);
  one.go(-pressure / segment.normal_stiffness, at_strength + 0.5 * softening_opening, 1000);
  EXPECT_NEAR(one.tau(), -0.5 * (strength + friction), 1.0);
  one.go(-pressure / segment.normal_stiffness, at_strength + 1.5 * softening_opening, 2000);
  EXPECT_NEAR(one.tau(), -friction, 1.0) << "friction stays";
  EXPECT_EQ(one.shear_breaks, 1);
  EXPECT_EQ(one.tension_breaks, 0);
  // Slip until the bond is gone: w and the elastic shear that the fall lets go.
  const double of_bond = strength - friction;
  const double slip = softening_opening + of_bond / k_s;
  const double energy = 0.5 * of_bond * slip * segment.area();
  EXPECT_NEAR(one.released, energy, 1e-3 * energy);
  const double rubbed = friction * (slip + 0.5 * softening_opening) * segment.area();
  EXPECT_NEAR(one.friction, rubbed, 1e-3 * rubbed);
  // Nothing is lost on the way.
  EXPECT_NEAR(one.work, one.stored() + one.friction + one.released, 1e-9 * one.work);
}

TEST(SofteningSegment, WhatTensionHasTakenShearHasNoLonger)
{
  LedSegment one;
  one.go(elastic_opening + 0.5 * softening_opening, 0.0, 5000);
  one.go(0.0, 0.0, 10);
  // At a gap of zero the strength is the cohesion, of which half is left.
  one.go(0.0, 30e6 / segment.shear_stiffness, 100);
  EXPECT_NEAR(one.tau(), -30e6, 10.0);
  const double given = one.of_bond();
  one.go(0.0, 30e6 / segment.shear_stiffness + 0.25 * softening_opening, 1000);
  EXPECT_NEAR(one.tau(), -15e6, 10.0);
  EXPECT_GT(one.of_bond(), given);
  one.go(0.0, 15e6 / segment.shear_stiffness + 0.25 * softening_opening, 10);
  EXPECT_NEAR(one.tau(), 0.0, 10.0);
  one.go(elastic_opening + 0.75 * softening_opening, 15e6 / segment.shear_stiffness + 0.25 * softening_opening, 10);
  EXPECT_NEAR(one.stress(), 0.25 * 20e6, 10.0) << "where the line has a quarter left";
}

TEST(SofteningSegment, BreaksInTheModeThatHasTakenMoreOfTheBond)
{
  // Pulled to d = 0.6 (or 0.4), then sheared to the end.
  for (const double pulled : {0.6, 0.4})
    {
      LedSegment one;
      one.go(elastic_opening + pulled * softening_opening, 0.0, 3000);
      one.go(0.0, 0.0, 10);
      one.go(0.0, 60e6 / segment.shear_stiffness + softening_opening, 3000);
      EXPECT_FALSE(one.state.bonded);
      EXPECT_EQ(one.tension_breaks, pulled > 0.5);
      EXPECT_EQ(one.shear_breaks, pulled < 0.5);
    }
}

TEST(SofteningSegment, WithoutAnOpeningItBreaksInTensionAsTheFlatJointDoes)
{
  for (const double slope : {0.0, 2e-4, -1e-3})
    {
      const flat_joint::SegmentMotion<2, double> motion{0.0, 1.001 * elastic_opening, slope, {1e-7}};
      const auto brittle = flat_joint::update<2, double>(segment, bond, {{1e6}, true}, motion);
      const auto softening = softening::update<2, double>(segment, bond, 0.0, {{1e6}, true, {0.0, 0.0, 0.0}}, motion);
      EXPECT_TRUE(softening.tension_break && brittle.tension_break);
      EXPECT_FALSE(softening.state.bonded);
      EXPECT_EQ(softening.normal.force, brittle.normal.force);
      EXPECT_EQ(softening.normal.moment, brittle.normal.moment);
      EXPECT_EQ(softening.state.shear_stress, brittle.state.shear_stress);
      // Shear energy: the flat joint gives what it stored by its product of stresses, this one by the slip's trapezoid.
      const double shear = 0.5 * 2e6 * 3.2e6 * segment.area() / segment.shear_stiffness;
      EXPECT_NEAR(softening.released_energy, brittle.released_energy, shear);
    }
}

/// A face by fibres: each of its four segments a row of them, one d a segment; written from the equations alone.
struct FibreFace
{
  static constexpr int n_fibres = 4000;
  std::array<double, 4> d{}, tau{};
  std::array<bool, 4> bonded{true, true, true, true};

  struct Forces
  {
    double normal = 0.0, shear = 0.0, moment = 0.0;
  };

  Forces go(const double gap_before, const double gap, const double slope_before, const double slope, const double way)
  {
    const double k_n = 40e12, k_s = 32e12, length = 0.5e-3, w = softening_opening, u_0 = 0.5e-6;
    Forces sum;
    for (int i = 0; i < 4; ++i)
      {
        const double middle = -0.75e-3 + length * i;
        const double g = gap - slope * middle;
        const double g_before = gap_before - slope_before * middle;
        // Secant of the line at the opening that goes with d.
        const auto left = [&] { return d[i] >= 1.0 ? 0.0 : 20e6 * (1.0 - d[i]) / (u_0 + d[i] * w) / k_n; };
        double trial = tau[i] - k_s * way;
        if (bonded[i])
          {
            d[i] = std::max(d[i], std::min(1.0, (g - u_0) / w));
            const double sigma = k_n * g * (g > 0.0 ? left() : 1.0);
            const double peak = std::max(0.0, 60e6 - sigma * bond.friction_slope);
            const double rest = std::min(peak, 0.5 * std::max(0.0, -sigma));
            const double over = std::abs(trial) - rest - (1.0 - d[i]) * (peak - rest);
            if (over > 0.0)
              {
                d[i] = std::min(1.0, d[i] + over / k_s / w);
                trial = std::copysign(rest + (1.0 - d[i]) * (peak - rest), trial);
              }
            bonded[i] = d[i] < 1.0;
            tau[i] = trial;
          }
        double normal = 0.0;
        const double factor = bonded[i] ? left() : 0.0;
        for (int f = 0; f < n_fibres; ++f)
          {
            const double s = length * ((f + 0.5) / n_fibres - 0.5);
            const double at = g - slope * s;
            const double force = -k_n * (at > 0.0 ? factor : 1.0) * at * length / n_fibres;
            normal += force;
            sum.moment -= (middle + s) * force;
          }
        if (!bonded[i] && d[i] == 1.0 && was_broken[i])
          {
            // Closed for a share of the step, then friction.
            const double share = (g_before < 0.0) == (g < 0.0) ? double(g < 0.0)
                                 : g < 0.0                     ? g / (g - g_before)
                                                               : g_before / (g_before - g);
            const double free = tau[i] - k_s * share * way;
            const double limit = 0.5 * std::max(0.0, normal / length);
            tau[i] = std::copysign(std::min(std::abs(free), limit), free);
          }
        was_broken[i] = !bonded[i];
        sum.normal += normal;
        sum.shear += tau[i] * length;
      }
    return sum;
  }

  std::array<bool, 4> was_broken{};
};

struct FaceStates
{
  std::vector<softening::State<2, double>> states{4, {{0.0}, true, {0.0, 0.0, 0.0}}};

  static Bond<double> bond(unsigned int) { return softening::bond; }
  const auto& state(const unsigned int i) const { return states[i]; }
  void set(const unsigned int i, const softening::Update<2, double>& update) { states[i] = update.state; }
};

TEST(SofteningFace, WanderingFollowsAPlainProgramOfFibres)
{
  SofteningFlatJointParameters wanted;
  wanted.softening_opening = softening_opening;
  const SofteningFlatJoint<2> law(wanted, {});
  unsigned int n_broken = 0;
  bool closed_after_break = false;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    {
      Random random(seed, RandomStream::positions);
      FaceStates states;
      FibreFace fibres;
      FaceMotion<2, double> motion{0.0, 0.0, {0.0}, {0.0}, {0.0}};
      for (int step = 0; step < 40 * int(seed * seed); ++step)
        {
          motion.opening_before = motion.opening;
          motion.rotation_before = motion.rotation;
          motion.opening += 4e-7 * (random.uniform() - 0.48);
          motion.rotation[0] += 4e-4 * (random.uniform() - 0.5);
          motion.slip_increment[0] = 6e-7 * (random.uniform() - 0.4);
          const auto sum = law.template update<double>(face, elements, motion, states);
          const auto plain = fibres.go(motion.opening_before, motion.opening, motion.rotation_before[0],
                                       motion.rotation[0], motion.slip_increment[0]);
          // Fibres err where the stress has its kink, by the square of their width: 1e-7 of 80 kN at an opening of 1 µm.
          ASSERT_NEAR(sum.normal_force, plain.normal, 0.1) << seed << " " << step;
          ASSERT_NEAR(sum.moment[0], plain.moment, 1e-4) << seed << " " << step;
          ASSERT_NEAR(sum.shear_force[0], plain.shear, 0.1) << seed << " " << step;
          closed_after_break = closed_after_break || (motion.opening < 0.0 && !states.states[0].bonded);
        }
      for (const auto& state : states.states)
        n_broken += !state.bonded;
    }
  EXPECT_GT(n_broken, 4u);
  EXPECT_LT(n_broken, 16u) << "some faces soften without breaking";
  EXPECT_TRUE(closed_after_break);
}

TEST(SofteningSegment, APackOfSegmentsHasTheBitsOfEachAlone)
{
  using simd::Pack;
  Random random(1, RandomStream::positions);
  const auto numbers = [&](const double from, const double to) {
    Pack pack(0.0);
    for (std::size_t i = 0; i < simd::width<Pack>; ++i)
      pack[i] = from + (to - from) * random.uniform();
    return pack;
  };
  unsigned int n_events = 0;
  for (int trial = 0; trial < 500; ++trial)
    {
      const flat_joint::Segment<2, Pack> segments{numbers(2e13, 5e13), numbers(1e13, 4e13), numbers(2e-4, 6e-4), 1.0,
                                                  0.5};
      const Bond<Pack> bonds{numbers(1e7, 3e7), numbers(4e7, 8e7), 0.2};
      const flat_joint::SegmentMotion<2, Pack> motion{numbers(-2e-6, 4e-6),
                                                      numbers(-2e-6, 5e-6),
                                                      numbers(-2e-3, 2e-3),
                                                      {numbers(-3e-6, 3e-6)}};
      const Pack damage = numbers(-0.5, 0.99);
      const softening::State<2, Pack> state{{numbers(-3e7, 3e7)},
                                            numbers(0.0, 1.0) > 0.3,
                                            {simd::larger(damage, Pack(0.0)), numbers(0.0, 0.5), numbers(0.0, 1e-3)}};
      const auto all = softening::update<2, Pack>(segments, bonds, softening_opening, state, motion);
      for (std::size_t i = 0; i < simd::width<Pack>; ++i)
        {
          const auto one = softening::update<2, double>(
            {segments.normal_stiffness[i], segments.shear_stiffness[i], segments.length[i], 1.0, 0.5},
            {bonds.tensile_strength[i], bonds.cohesion[i], 0.2}, softening_opening,
            {{state.shear_stress[0][i]}, bool(state.bonded[i]), {state.more[0][i], state.more[1][i], state.more[2][i]}},
            {motion.gap_before[i], motion.gap[i], motion.slope[i], {motion.shear_increment[0][i]}});
          EXPECT_EQ(all.normal.force[i], one.normal.force);
          EXPECT_EQ(all.normal.moment[i], one.normal.moment);
          EXPECT_EQ(all.state.shear_stress[0][i], one.state.shear_stress[0]);
          EXPECT_EQ(all.state.bonded[i], one.state.bonded);
          EXPECT_EQ(all.state.more[0][i], one.state.more[0]);
          EXPECT_EQ(all.state.more[1][i], one.state.more[1]);
          EXPECT_EQ(all.state.more[2][i], one.state.more[2]);
          EXPECT_EQ(all.tension_break[i], one.tension_break);
          EXPECT_EQ(all.shear_break[i], one.shear_break);
          EXPECT_EQ(all.slip_energy[i], one.slip_energy);
          EXPECT_EQ(all.released_energy[i], one.released_energy);
          n_events += one.tension_break || one.shear_break;
        }
    }
  EXPECT_GT(n_events, 100u);
}

TEST(SofteningSegment, ABondWithoutTensileStrengthBearsNoTensionAndNothingIsNotANumber)
{
  const Bond<double> no_tension{0.0, 60e6, 0.0};
  softening::State<2, double> state{{0.0}, true, {0.0, 0.0, 0.0}};
  auto update = softening::update<2, double>(segment, no_tension, softening_opening, state, {0.0, 1e-7, 0.0, {1e-7}});
  EXPECT_LT(-update.normal.force / segment.area(), 1.01) << "one pascal";
  EXPECT_TRUE(std::isfinite(update.state.shear_stress[0]) && std::isfinite(update.state.more[2]));
  update =
    softening::update<2, double>(segment, no_tension, softening_opening, update.state, {1e-7, -1e-7, 0.0, {0.0}});
  EXPECT_DOUBLE_EQ(update.normal.force, 4e6 * segment.area());
}
} // namespace
} // namespace feldspar::softening
