#include "dem/laws/contact_motion.h"
#include "dem/laws/flat_joint.h"
#include "dem/laws/flat_joint_law.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

namespace feldspar
{
namespace
{
using flat_joint::Bond;
using flat_joint::Segment;
using flat_joint::SegmentMotion;
using flat_joint::SegmentState;
using flat_joint::SegmentUpdate;

// Two grains of 1 mm, E = 80 GPa, four segments: k_n = E/(R1+R2), k_s = k_n/1.25, ℓ = 2R̄/4.
constexpr double modulus = 80e9;
constexpr double half_length = 1e-3;
constexpr unsigned int n_segments = 4;
const Face<double> face{modulus / 2e-3, modulus / 2e-3 / 1.25, half_length, 1.0, 0.5};
const auto elements = face_elements<2>(n_segments);
const Segment<2, double> segment = place_segment(face, elements[0]).segment;
const Bond<double> strong{1e30, 1e30, 0.0};
const Bond<double> table_1{22e6, 400e6, std::tan(10.0 * std::numbers::pi / 180.0)};

struct Response
{
  double force;
  double moment;
};

/// Force (compression positive) and moment of a segment from the stress profile itself: σ = k_n g where bonded or
/// closed. Midpoint rule; the only error is in the one cell in which the profile has its kink, O(1/n²).
Response quadrature(const double gap, const double slope, const bool bonded)
{
  constexpr int n = 200000;
  const double width = segment.length / n;
  Response sum{0.0, 0.0};
  for (int i = 0; i < n; ++i)
    {
      const double s = -0.5 * segment.length + (i + 0.5) * width;
      const double g = gap - slope * s;
      const double force = bonded || g < 0.0 ? -face.normal_stiffness * g * width * face.thickness : 0.0;
      sum.force += force;
      sum.moment -= s * force;
    }
  return sum;
}

struct NormalCase
{
  double gap;
  double slope;
  bool bonded;
};

void PrintTo(const NormalCase& one, std::ostream* out)
{
  *out << "gap " << one.gap << " m, slope " << one.slope << (one.bonded ? ", bonded" : ", unbonded");
}

class NormalResponse : public testing::TestWithParam<NormalCase>
{
};

TEST_P(NormalResponse, IsTheIntegralOfTheStressProfile)
{
  const auto [gap, slope, bonded] = GetParam();
  const auto exact = quadrature(gap, slope, bonded);
  const auto response = flat_joint::normal_response(segment, gap, slope, bonded);
  const double force_scale =
    face.normal_stiffness * segment.area() * (std::abs(gap) + std::abs(slope) * segment.length);
  EXPECT_NEAR(response.force, exact.force, 1e-9 * force_scale);
  EXPECT_NEAR(response.moment, exact.moment, 1e-9 * force_scale * segment.length);
  EXPECT_DOUBLE_EQ(mean_stress(segment, response), -response.force / segment.area());
}

INSTANTIATE_TEST_SUITE_P(BondedClosedOpenAndPartlyOpenTiltedBothWays, NormalResponse,
                         testing::Values(NormalCase{1e-7, 2e-4, true}, NormalCase{-1e-7, -2e-3, true},
                                         NormalCase{-1e-6, 1e-3, false}, NormalCase{-1e-6, -1e-3, false},
                                         NormalCase{1e-6, 1e-3, false}, NormalCase{1e-7, 1e-3, false},
                                         NormalCase{1e-7, -1e-3, false}, NormalCase{-1e-7, 1e-3, false},
                                         NormalCase{-1e-7, -1e-3, false}, NormalCase{0.0, 1e-3, false},
                                         NormalCase{0.0, 0.0, false}, NormalCase{-1e-7, 0.0, false}));

TEST(NormalResponse, EnergyIsTheWorkOfForceAndMoment)
{
  // dE = -F dg + M dθ: M is the couple on grain 2 and acts through θ with the sign of ∂g/∂ρ = -θ. Central
  // differences of a piecewise quadratic: exact to round-off, about 1e-16/1e-5.
  const double h = 1e-11;
  for (const bool bonded : {true, false})
    for (const double gap : {-2e-7, 1e-7})
      {
        const double slope = 1e-3;
        const auto energy = [&](const double g, const double theta) {
          return flat_joint::normal_energy(segment, g, theta, bonded);
        };
        const auto response = flat_joint::normal_response(segment, gap, slope, bonded);
        EXPECT_NEAR((energy(gap + h, slope) - energy(gap - h, slope)) / (2 * h), -response.force,
                    1e-4 * (1.0 + std::abs(response.force)));
        const double turn = 1e-8;
        EXPECT_NEAR((energy(gap, slope + turn) - energy(gap, slope - turn)) / (2 * turn), -response.moment,
                    1e-6 * (1e-6 + std::abs(response.moment)));
      }
}

/// Segments of one face that the tests own.
struct Segments
{
  std::vector<Bond<double>> bonds;
  std::vector<SegmentState<2, double>> states;
  std::vector<SegmentUpdate<2, double>> updates;

  explicit Segments(const Bond<double>& all, const bool bonded = true)
    : bonds(n_segments, all)
    , states(n_segments, {{0.0}, bonded})
    , updates(n_segments)
  {
  }

  Bond<double> bond(const unsigned int i) const { return bonds[i]; }
  SegmentState<2, double> state(const unsigned int i) const { return states[i]; }
  void set(const unsigned int i, const SegmentUpdate<2, double>& update)
  {
    states[i] = update.state;
    updates[i] = update;
  }
  unsigned int n_bonded() const
  {
    unsigned int n = 0;
    for (const auto& state : states)
      n += state.bonded;
    return n;
  }
};

TEST(Face, BondedIsTheContinuumBarWhateverTheNumberOfSegments)
{
  // F_n = -k_n 2R̄t U_n and M = -k_n ⅔R̄³t θ (second moment of the face); shear -k_s 2R̄t U_s.
  Segments segments(strong);
  const double opening = 3e-8;
  const double slip = -2e-8;
  const double theta = 5e-5;
  const auto response = update_face<2>(face, elements, {0.0, opening, {0.0}, {theta}, {slip}}, segments);
  const double area = 2.0 * half_length;
  EXPECT_NEAR(response.normal_force, -face.normal_stiffness * area * opening, 1e-12 * std::abs(response.normal_force));
  EXPECT_NEAR(response.shear_force[0], -face.shear_stiffness * area * slip, 1e-12 * std::abs(response.shear_force[0]));
  EXPECT_NEAR(response.moment[0], -face.normal_stiffness * (2.0 / 3.0) * std::pow(half_length, 3) * theta,
              1e-12 * std::abs(response.moment[0]));
}

TEST(Face, PartlyBrokenKeepsTheMomentOfWhatHolds)
{
  // Pure opening with the two outer segments of one side broken and open: F = -k_n A_2 U, and it acts at the centroid
  // of the two that hold, ρ = -R̄/2 (segments 3 and 4), so M = -ρF = ½R̄F.
  Segments segments(strong);
  segments.states[0].bonded = segments.states[1].bonded = false;
  const double opening = 1e-7;
  const auto response = update_face<2>(face, elements, {0.0, opening, {0.0}, {0.0}, {0.0}}, segments);
  const double force = -face.normal_stiffness * half_length * opening;
  EXPECT_NEAR(response.normal_force, force, 1e-12 * std::abs(force));
  EXPECT_NEAR(response.moment[0], 0.5 * half_length * force, 1e-12 * std::abs(half_length * force));
}

TEST(Face, BrokenRocksOnItsEdge)
{
  // A wholly broken face pressed and tilted, closed over the length c from its edge: a triangle of stress,
  // F = ½ k_n t θ c², acting c/3 from the edge: M = -(R̄ - c/3) F for θ > 0. Independent of the segments.
  Segments segments(strong, false);
  const double theta = 1e-3;
  const double c = 0.7 * half_length;
  const double opening = theta * (half_length - c); // g = 0 at ρ = R̄ - c
  const auto response = update_face<2>(face, elements, {opening, opening, {theta}, {theta}, {0.0}}, segments);
  const double force = 0.5 * face.normal_stiffness * theta * c * c;
  EXPECT_NEAR(response.normal_force, force, 1e-12 * force);
  EXPECT_NEAR(response.moment[0], -(half_length - c / 3.0) * force, 1e-12 * half_length * force);
}

TEST(Break, InTensionBeyondTheStrengthAndNotBefore)
{
  Segments segments(table_1);
  const double critical = table_1.tensile_strength / face.normal_stiffness;
  update_face<2>(face, elements, {0.0, 0.999 * critical, {0.0}, {0.0}, {0.0}}, segments);
  EXPECT_EQ(segments.n_bonded(), 4u);
  const auto broken =
    update_face<2>(face, elements, {0.999 * critical, 1.001 * critical, {0.0}, {0.0}, {0.0}}, segments);
  EXPECT_EQ(segments.n_bonded(), 0u);
  EXPECT_TRUE(segments.updates[0].tension_break);
  EXPECT_EQ(broken.normal_force, 0.0);
  // Lets go what it stored: ½ k_n A g².
  EXPECT_NEAR(segments.updates[0].released_energy,
              0.5 * face.normal_stiffness * segment.area() * std::pow(1.001 * critical, 2), 1e-12);
}

TEST(Break, InBendingOneSegmentAtATime)
{
  // θ < 0 opens the side of positive ρ; its outermost segment has ρ = ¾R̄, the next ¼R̄.
  Segments segments(table_1);
  const double critical = -table_1.tensile_strength / face.normal_stiffness / (0.75 * half_length);
  update_face<2>(face, elements, {0.0, 0.0, {0.0}, {0.99 * critical}, {0.0}}, segments);
  EXPECT_EQ(segments.n_bonded(), 4u);
  update_face<2>(face, elements, {0.0, 0.0, {0.99 * critical}, {1.01 * critical}, {0.0}}, segments);
  EXPECT_EQ(segments.n_bonded(), 3u);
  EXPECT_FALSE(segments.states[0].bonded);
}

TEST(Break, InShearByCohesionAndFriction)
{
  // Under a compression p, τ_c = c_b + p tan φ_b (15). The segment that broke has no shear in that step.
  const double pressure = 100e6;
  const double closing = -pressure / face.normal_stiffness;
  const double tau_c = table_1.cohesion + pressure * table_1.friction_slope;
  Segments segments(table_1);
  update_face<2>(face, elements, {0.0, closing, {0.0}, {0.0}, {0.999 * tau_c / face.shear_stiffness}}, segments);
  EXPECT_EQ(segments.n_bonded(), 4u);
  EXPECT_NEAR(segments.states[0].shear_stress[0], -0.999 * tau_c, 1e-6 * tau_c);
  const auto response =
    update_face<2>(face, elements, {closing, closing, {0.0}, {0.0}, {0.002 * tau_c / face.shear_stiffness}}, segments);
  EXPECT_EQ(segments.n_bonded(), 0u);
  EXPECT_TRUE(segments.updates[0].shear_break);
  EXPECT_EQ(response.shear_force[0], 0.0);
  EXPECT_NEAR(response.normal_force, pressure * 2.0 * half_length, 1e-6);
}

TEST(Break, TensionComesBeforeShear)
{
  // Overloaded both ways in one step: the tension check is first. The other order would count a shear crack.
  Segments segments(table_1);
  update_face<2>(face, elements,
                 {0.0,
                  2.0 * table_1.tensile_strength / face.normal_stiffness,
                  {0.0},
                  {0.0},
                  {2.0 * table_1.cohesion / face.shear_stiffness}},
                 segments);
  EXPECT_TRUE(segments.updates[0].tension_break);
  EXPECT_FALSE(segments.updates[0].shear_break);
}

TEST(Friction, SlidesAtTheLimitAndSticksOnReversal)
{
  const double pressure = 50e6;
  const double closing = -pressure / face.normal_stiffness;
  const double limit = face.friction * pressure;
  Segments segments(table_1, false);
  update_face<2>(face, elements, {closing, closing, {0.0}, {0.0}, {5.0 * limit / face.shear_stiffness}}, segments);
  EXPECT_NEAR(segments.states[0].shear_stress[0], -limit, 1e-9 * limit);
  // Slip of 4 limit/k_s under the mean of start and end stress, ½ limit: 2 limit²/k_s per area.
  EXPECT_NEAR(segments.updates[0].slip_energy, 2.0 * limit * limit / face.shear_stiffness * segment.area(), 1e-12);
  // Back by half the limit: elastic.
  update_face<2>(face, elements, {closing, closing, {0.0}, {0.0}, {-0.5 * limit / face.shear_stiffness}}, segments);
  EXPECT_NEAR(segments.states[0].shear_stress[0], -0.5 * limit, 1e-9 * limit);
  EXPECT_EQ(segments.updates[0].slip_energy, 0.0);
  // Slip past the limit on the other side.
  update_face<2>(face, elements, {closing, closing, {0.0}, {0.0}, {-3.0 * limit / face.shear_stiffness}}, segments);
  EXPECT_NEAR(segments.states[0].shear_stress[0], limit, 1e-9 * limit);
  // Opened, nothing is left.
  update_face<2>(face, elements, {closing, 1e-9, {0.0}, {0.0}, {0.0}}, segments);
  EXPECT_EQ(segments.states[0].shear_stress[0], 0.0);
}

TEST(Friction, GathersShearOnlyWhileClosed)
{
  // From a gap of +1 to -3: the last three quarters of the step are closed. A law that took the whole increment would
  // give 4/3 of this.
  const double slip = 1e-9;
  Segments segments(table_1, false);
  update_face<2>(face, elements, {1e-8, -3e-8, {0.0}, {0.0}, {slip}}, segments);
  EXPECT_NEAR(segments.states[0].shear_stress[0], -face.shear_stiffness * 0.75 * slip,
              1e-9 * face.shear_stiffness * slip);
}

TEST(Friction, ShearUnderAnEdgeWhileTheMiddleIsOpenIsSlip)
{
  // Under half of a shear stress that friction could carry; tilted, so that the middle is open and an edge presses.
  const double limit = face.friction * 50e6;
  const double slip = 0.5 * limit / face.shear_stiffness;
  const double gap = 1e-9;
  const double slope = 20.0 * 50e6 / face.normal_stiffness / segment.length;
  const SegmentState<2, double> old{{-0.5 * limit}, false};
  const auto update = flat_joint::update<2, double>(segment, strong, old, {gap, gap, slope, {slip}});
  // The stress stays, and over all of the way it does work: -τ ΔU_s per area.
  EXPECT_GT(update.normal.force, 0.0);
  EXPECT_EQ(update.state.shear_stress[0], -0.5 * limit);
  EXPECT_NEAR(update.slip_energy, 0.5 * limit * slip * segment.area(), 1e-12 * limit * slip);
}

/// Bit for bit: the sweep's vector lanes and the single contact are the same arithmetic.
template <int dim>
void expect_pack_as_its_members(const Segment<dim, double>& one, const Segment<dim, simd::Pack>& packed_one)
{
  using simd::Pack;
  const Bond<Pack> bonds{table_1.tensile_strength, table_1.cohesion, table_1.friction_slope};
  for (int k = 0; k < 200; ++k)
    {
      const auto gap_before = [k](const int i) { return 1e-7 * std::sin(1.0 + 3.7 * k + i); };
      const auto gap = [k](const int i) { return 1.2e-6 * std::sin(2.0 + 1.3 * k + i); };
      const auto slope = [k](const int i) { return dim == 2 ? 2e-3 * std::sin(3.0 + 2.1 * k + i) : 0.0; };
      const auto slip_1 = [k](const int i) { return 1.5e-5 * std::sin(4.0 + 0.7 * k + i); };
      const auto slip_2 = [k](const int i) { return 1.5e-5 * std::sin(0.5 + 2.3 * k + i); };
      const auto tau_1 = [k](const int i) { return 3e7 * std::sin(5.0 + 1.9 * k + i); };
      const auto tau_2 = [k](const int i) { return 3e7 * std::cos(2.0 + 0.4 * k + i); };
      const auto bonded = [k](const int i) { return (k + i) % 3 != 0; };
      // Along the one axis of the line or both of the plane.
      const auto across = [](const auto& first, [[maybe_unused]] const auto& second) {
        if constexpr (dim == 2)
          return std::array{first};
        else
          return std::array{first, second};
      };
      const Pack bonded_number([&](const auto i) { return double(bonded(i)); });
      const auto packed =
        flat_joint::update<dim, Pack>(packed_one, bonds, {across(Pack(tau_1), Pack(tau_2)), bonded_number > 0.5},
                                      {Pack(gap_before), Pack(gap), Pack(slope), across(Pack(slip_1), Pack(slip_2))});
      for (int i = 0; i < int(Pack::size()); ++i)
        {
          const auto single =
            flat_joint::update<dim, double>(one, table_1, {across(tau_1(i), tau_2(i)), bonded(i)},
                                            {gap_before(i), gap(i), slope(i), across(slip_1(i), slip_2(i))});
          for (int c = 0; c < dim - 1; ++c)
            EXPECT_EQ(double(packed.state.shear_stress[c][i]), single.state.shear_stress[c]);
          EXPECT_EQ(bool(packed.state.bonded[i]), single.state.bonded);
          EXPECT_EQ(double(packed.normal.force[i]), single.normal.force);
          if constexpr (dim == 2)
            {
              EXPECT_EQ(double(packed.normal.moment[i]), single.normal.moment);
            }
          EXPECT_EQ(double(packed.slip_energy[i]), single.slip_energy);
          EXPECT_EQ(double(packed.released_energy[i]), single.released_energy);
        }
    }
}

TEST(Law, RespondsAPackAsItsMembers)
{
  expect_pack_as_its_members<2>(
    segment, {segment.normal_stiffness, segment.shear_stiffness, segment.length, segment.thickness, segment.friction});
}

TEST(Law, RespondsAPackAsItsMembersInThreeDimensions)
{
  const Segment<3, double> element{face.normal_stiffness, face.shear_stiffness, 1e-7, 0.5};
  expect_pack_as_its_members<3>(element,
                                {element.normal_stiffness, element.shear_stiffness, element.element_area, 0.5});
}

TEST(AngleTurned, IsExactFromMicroradiansToHalfATurn)
{
  for (const double angle : {1e-9, -1e-4, 9.9e-3, 1.1e-2, 0.5, -3.0})
    {
      EXPECT_NEAR(angle_turned(std::sin(angle), std::cos(angle)), angle, 4e-16 * (1.0 + std::abs(angle)));
      const simd::Pack packed = angle_turned(simd::Pack(std::sin(angle)), simd::Pack(std::cos(angle)));
      EXPECT_EQ(double(packed[0]), angle_turned(std::sin(angle), std::cos(angle)));
    }
}
} // namespace
} // namespace feldspar
