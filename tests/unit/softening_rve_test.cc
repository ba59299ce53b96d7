// Representative volumes whose bonds soften from event to event: one face against the law of the sweep, the energy of one bond
// in closed form, tangent, balances through breakage, explicit dynamics beside, and a resumed path.

#include "coupling/network/link_response.h"
#include "coupling/rve/equilibrium.h"
#include "coupling/rve/explicit_run.h"
#include "coupling/rve/path_run.h"
#include "tests/unit/small_rve.h"
#include "tests/unit/taken_up.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace feldspar
{
namespace
{
template <typename>
using SofteningRves = testing::Test;
TYPED_TEST_SUITE(SofteningRves, Dimensions);

constexpr double usual_opening = 1e-6;

/// The cell of small_rve.h with bonds that soften.
template <int dim>
Specimen<dim> softening_cell(const double over_opening = usual_opening)
{
  SofteningFlatJointParameters joint;
  joint.softening_opening = over_opening;
  return periodic_specimen<dim>(1, dim == 2 ? 0.012 : 0.006, joint);
}

template <int dim>
PathRun<dim> pulled(const double strain, const PathParameters& parameters = {})
{
  return {std::make_shared<const Network<dim>>(softening_cell<dim>()),
          {{with_free_sides<dim>(strain), true}},
          parameters};
}

TYPED_TEST(SofteningRves, ASoftenedFaceRespondsAsTheLawOfTheSweep)
{
  // Open, closed and, in the plane, closed in part; the first segment has not softened. So that none softens further here
  // the law of the sweep is given bonds that carry anything at their damage.
  constexpr int dim = TypeParam::value;
  const auto specimen = softening_cell<dim>();
  const Network<dim> network(specimen);
  const auto& law = std::get<SofteningFlatJoint<dim>>(network.law());
  const Face<double> face = network.links()[0].face(network.thickness());
  for (const double opening : {-4e-7, -2e-8, 3e-7})
    for (const double rotation : {1e-5, -2e-4})
      {
        Motion<dim> motion = Motion<dim>::Constant(rotation);
        motion[0] = opening;
        for (int c = 1; c < dim; ++c)
          motion[c] = 1e-7 * c;
        ActiveLink<dim> active{0, Motion<dim>::Zero(), std::vector<SegmentHistory<dim>>(network.links()[0].n_segments)};
        for (std::size_t i = 1; i < active.segments.size(); ++i)
          active.segments[i].more = {0.2 * double(i % 4), 0.0, 0.0};
        const LinkResponse<dim> found = response(network, active, motion);

        Motion<dim> forces = Motion<dim>::Zero();
        double stored = 0.0;
        for (std::uint32_t i = 0; i < active.segments.size(); ++i)
          {
            const FaceElement<dim>& element = network.elements()[i];
            const auto rows = element_rows(element, network.links()[0].half_length);
            const Vector<dim> way = rows * motion;
            const auto segment = place_segment(face, element).segment;
            flat_joint::SegmentMotion<dim, double> moves{0.0, way[0], dim == 2 ? motion[2] : 0.0, {}};
            for (int c = 0; c < dim - 1; ++c)
              moves.shear_increment[c] = way[c + 1];
            const Bond<double> bond{1e30, 1e30, 0.0};
            const auto update = softening::update<dim, double>(segment, bond, law.softening_opening(),
                                                               {{}, true, active.segments[i].more}, moves);
            ASSERT_EQ(update.state.more[0], active.segments[i].more[0]);
            Vector<dim> force;
            force[0] = -update.normal.force;
            for (int c = 0; c < dim - 1; ++c)
              force[c + 1] = -update.state.shear_stress[c] * segment.area();
            forces += rows.transpose() * force;
            if constexpr (dim == 2)
              forces[2] -= update.normal.moment;
          }
        const auto state_of = [&](const unsigned int i) {
          return softening::State<dim, double>{found.segments[i].shear_stress, true, active.segments[i].more};
        };
        std::array<double, n_rotations<dim>> turns;
        for (int c = 0; c < n_rotations<dim>; ++c)
          turns[c] = motion[dim + c];
        stored = law.stored_energy(face, network.elements(), motion[0], turns, state_of);
        EXPECT_LE((found.forces - forces).norm(), 1e-11 * forces.norm());
        EXPECT_NEAR(found.stored_energy, stored, 1e-11 * stored);

        expect_derivative_of_differences(found, network, active, motion);
        EXPECT_EQ(found.derivative, found.tangent);
      }
}

/// The first segment of a link moves to a motion, and its bond softens or breaks there if it is asked to.
std::optional<BondEvent> lead_to(const Network<2>& network, ActiveLink<2>& active, const Motion<2>& motion,
                                 const bool in_tension, const unsigned int n_steps)
{
  const Link<2>& link = network.links()[active.link];
  SegmentHistory<2>& segment = active.segments[0];
  const double least_step = 1.0 / n_steps;
  const auto now = response(network, active, motion);
  active.motion = motion;
  if (segment.has_softened())
    segment.shear_stress = now.segments[0].shear_stress;
  const bool overloaded =
    segment.has_softened()
      ? softening_demand(network, link, 0, segment, motion[0], segment.shear_stress, least_step).exceeded
      : is_overloaded(network.bond(link.first_segment), now.segments[0].bond_stress);
  return overloaded ? std::optional(loosen(network, active, 0, in_tension, least_step)) : std::nullopt;
}

/// One segment with prescribed opening, or prescribed shear under a constant opening, until its bond is gone.
struct Led
{
  double given_up; ///< by the bond, over the energy below its line
  unsigned int n_events;
};

Led lead(const unsigned int n_steps, const bool in_shear)
{
  constexpr double over_opening = 5e-6;
  const Network<2> network(softening_cell<2>(over_opening));
  const Link<2>& link = network.links()[0];
  const Bond<double>& bond = network.bond(link.first_segment);
  // Strength of the segment: in shear under pressure, so that friction acts beside the bond.
  const double pressed = in_shear ? -20e6 / link.normal_stiffness : 0.0;
  const double strength = in_shear ? shear_strength(bond, link.normal_stiffness * pressed) : bond.tensile_strength;
  const double residual = in_shear ? -link.friction * link.normal_stiffness * pressed : 0.0;
  const double stiffness = in_shear ? link.shear_stiffness : link.normal_stiffness;
  const double elastic = strength / stiffness;
  ActiveLink<2> active{0, Motion<2>::Zero(), std::vector<SegmentHistory<2>>(link.n_segments)};
  active.motion[0] = pressed;
  Led led{0.0, 0};
  constexpr int n_ways = 4000;
  for (int k = 1; k <= n_ways && active.segments[0].bonded; ++k)
    {
      const double way = double(k) / n_ways * 1.2 * (elastic + over_opening);
      Motion<2> motion = Motion<2>::Zero();
      motion[0] = in_shear ? pressed : way;
      motion[1] = in_shear ? -way : 0.0;
      ActiveLink<2> unmoved = active;
      const auto event = lead_to(network, active, motion, !in_shear, n_steps);
      if (!event)
        continue;
      // Energy that would be stored there without the event.
      const double before = response(network, unmoved, motion).stored_energy;
      ++led.n_events;
      EXPECT_EQ(event->broke && event->in_tension, event->broke && !in_shear);
      led.given_up += before - response(network, active, motion).stored_energy - event->slip_energy;
      if (event->broke)
        {
          EXPECT_NEAR(event->released_energy, led.given_up, 1e-9 * led.given_up);
        }
    }
  EXPECT_FALSE(active.segments[0].bonded);
  const double area = network.segment_area(link, 0);
  const double of_bond = strength - residual;
  led.given_up /= 0.5 * of_bond * (over_opening + of_bond / stiffness) * area;
  return led;
}

TEST(SofteningRve, ABondGivesTheEnergyBelowItsLineInAnyNumberOfSteps)
{
  // docs/theory.md §1.10. The teeth lie about the line, half a step above and half a step below, but for the first, which
  // begins at the strength, and the last.
  for (const bool in_shear : {false, true})
    {
      SCOPED_TRACE(in_shear ? "shear" : "tension");
      for (const unsigned int n_steps : {4u, 16u, 64u})
        {
          SCOPED_TRACE(n_steps);
          const Led led = lead(n_steps, in_shear);
          EXPECT_NEAR(led.given_up, 1.0, 0.8 / n_steps);
          EXPECT_LE(led.n_events, n_steps + 2);
          EXPECT_GE(led.n_events, 0.9 * n_steps); // each goes a little beyond where it is asked to
        }
    }
}

/// Opening and slip of a segment along a way from 0 to 1 [m].
using MixedWay = std::array<double, 2> (*)(double);

constexpr double mixed_over_opening = 5e-6;
constexpr int n_mixed_ways = 64000;

std::array<double, 2> at_once(const double s) { return {s * 5e-6, s * 24e-6}; }
std::array<double, 2> sheared_then_opened(const double s)
{
  return s < 0.5 ? std::array{0.0, s * 26e-6} : std::array{(s - 0.5) * 13e-6, 13e-6};
}
std::array<double, 2> opened_then_sheared(const double s)
{
  return s < 0.5 ? std::array{s * 5e-6, 0.0} : std::array{2.5e-6, (s - 0.5) * 40e-6};
}
std::array<double, 2> by_turns(const double s)
{
  const double wave = std::sin(8.0 * std::numbers::pi * s) / (8.0 * std::numbers::pi);
  return {6e-6 * (s + wave), 24e-6 * (s - wave)};
}

/// Energy that a bond has given up at the end of a way, by the law of the sweep in small steps [J].
double given_by_the_law(const Network<2>& network, const MixedWay way)
{
  const Link<2>& link = network.links()[0];
  const double length = network.segment_area(link, 0) / network.thickness();
  const flat_joint::Segment<2, double> segment{link.normal_stiffness, link.shear_stiffness, length, network.thickness(),
                                               link.friction};
  softening::State<2, double> state{{0.0}, true, {}};
  std::array<double, 2> before{};
  for (int k = 1; k <= n_mixed_ways; ++k)
    {
      const auto now = way(double(k) / n_mixed_ways);
      const auto update =
        softening::update_bonded<2, double>(segment, network.bond(link.first_segment), mixed_over_opening, state,
                                            {before[0], now[0], 0.0, {now[1] - before[1]}});
      if (!update.state.bonded)
        return update.released_energy;
      state = update.state;
      before = now;
    }
  ADD_FAILURE() << "the bond holds";
  return 0.0;
}

/// The same by events.
double given_by_events(const Network<2>& network, const MixedWay way, const unsigned int n_steps)
{
  ActiveLink<2> active{0, Motion<2>::Zero(), std::vector<SegmentHistory<2>>(network.links()[0].n_segments)};
  for (int k = 1; k <= n_mixed_ways; ++k)
    {
      const auto [opening, slip] = way(double(k) / n_mixed_ways);
      const auto event = lead_to(network, active, Motion<2>(opening, slip, 0.0), true, n_steps);
      if (event && event->broke)
        return event->released_energy;
    }
  ADD_FAILURE() << "the bond holds";
  return 0.0;
}

TEST(SofteningRve, ABondLedByOpeningAndShearGivesWhatTheLawOfTheSweepTakes)
{
  // An event may come a step of d earlier or later than the law would take it. The largest difference found is 0.93 / n.
  const Network<2> network(softening_cell<2>(mixed_over_opening));
  for (const auto& [name, way] : {std::pair("at once", &at_once),
                                  {"sheared, then opened", &sheared_then_opened},
                                  {"opened, then sheared", &opened_then_sheared},
                                  {"by turns", &by_turns}})
    {
      SCOPED_TRACE(name);
      const double expected = given_by_the_law(network, way);
      for (const unsigned int n_steps : {4u, 16u, 64u, 256u})
        EXPECT_NEAR(given_by_events(network, way, n_steps), expected, expected / n_steps) << n_steps;
    }
}

TYPED_TEST(SofteningRves, TheirTangentIsThatOfDifferences)
{
  constexpr int dim = TypeParam::value;
  RepresentativeVolume<dim> rve(std::make_shared<const Network<dim>>(softening_cell<dim>()),
                                {.event_tolerance = 1e-8, .final_tolerance = 1e-11});
  strain_to(rve, axial<dim>(dim == 2 ? 2.4e-4 : 3.2e-4) + uneven<dim>(1e-5), 5);
  ASSERT_FALSE(rve.state().softened.empty());
  const Voigt<dim> here = rve.state().strain;
  const auto trial = rve.trial(here, Bonds::frozen, true);
  EXPECT_LT(relative(trial.tangent->value, stiffness_by_differences(rve, here)), 1e-4);
  const Stiffness<dim> difference = rve.network().intact_stiffness() - trial.tangent->value;
  EXPECT_GT(difference(dim - 1, dim - 1), 0.001 * rve.network().intact_stiffness()(dim - 1, dim - 1));
}

TYPED_TEST(SofteningRves, WorkBalancesThroughSofteningAndBreakage)
{
  constexpr int dim = TypeParam::value;
  for (const Kinematics kinematics : {Kinematics::small_strains, Kinematics::finite})
    {
      PathParameters parameters;
      parameters.equilibrium.kinematics = kinematics;
      auto run = pulled<dim>(5e-4, parameters);
      while (!run.has_ended() && run.record().cracks.size() < 10)
        run.advance();
      EXPECT_GT(run.record().cracks.size(), 3u);
      expect_balances(run.record());
      // All that the bonds have given up: those that broke, and those that hold still.
      double of_bonds = 0.0;
      for (const auto& crack : run.record().cracks)
        of_bonds += crack.released_energy;
      for (const auto& softened : run.state().softened)
        of_bonds += softened.more[2];
      EXPECT_NEAR(run.state().work.released, of_bonds, 1e-9 * of_bonds);
    }
}

TEST(SofteningRve, IsThatOfExplicitDynamics)
{
  // The same cell pulled both ways. Softening grows with the bonds' energy: what the cell carries rises by the same
  // share in both.
  const auto specimen = softening_cell<2>();
  const std::vector<PathLeg<2>> pulling{{with_free_sides<2>(5e-4), true}};
  const auto by_dynamics = at_end(
    ExplicitRun<2>(specimen, std::make_shared<const Network<2>>(specimen), pulling, {.steps_per_millistrain = 100000}));
  const double expected = highest_axial_stress(by_dynamics.record());
  EXPECT_NEAR(highest_axial_stress(at_end(pulled<2>(5e-4)).record()), expected, 0.03 * expected);
  const PathRun<2> brittle(std::make_shared<const Network<2>>(softening_cell<2>(0.0)), pulling, {});
  EXPECT_GT(expected, 1.1 * highest_axial_stress(at_end(brittle).record()));
}

TYPED_TEST(SofteningRves, TakenUpGivesTheBitsOfTheUnbrokenRun)
{
  constexpr int dim = TypeParam::value;
  const auto begin = [] { return pulled<dim>(2.5e-4); };
  const auto [whole, broken] = tests::whole_and_taken_up(begin);
  ASSERT_FALSE(whole.state().softened.empty());
  ASSERT_EQ(broken.state().softened.size(), whole.state().softened.size());
  for (std::size_t k = 0; k < whole.state().softened.size(); ++k)
    EXPECT_EQ(broken.state().softened[k].more, whole.state().softened[k].more);
  EXPECT_EQ(broken.state().motions, whole.state().motions);
  EXPECT_EQ(broken.record().samples.back().work.released, whole.record().samples.back().work.released);
}
} // namespace
} // namespace feldspar
