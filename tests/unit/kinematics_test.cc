#include "coupling/network/kinematics.h"
#include "coupling/rve/path_run.h"
#include "tests/unit/small_rve.h"

#include <Eigen/Geometry>

#include <cmath>

namespace feldspar
{
namespace
{
template <typename>
using TurnedLinks = testing::Test;
TYPED_TEST_SUITE(TurnedLinks, Dimensions);

/// All motions of two grains and a strain, none of them alike, of some per cent of the link's length.
template <int dim>
Unknowns moved(const Network<dim>& network, const Link<dim>& link, const double size)
{
  Unknowns position = Unknowns::Zero(network.n_unknowns());
  Random random(7, RandomStream::positions);
  constexpr int n = n_motions<dim>;
  for (const std::uint32_t grain : {link.grain_1, link.grain_2})
    for (int c = 0; c < n; ++c)
      position[n * Eigen::Index(grain) + c] = random.uniform(-1.0, 1.0) * size * (c < dim ? link.branch.norm() : 1.0);
  position.template tail<n_voigt<dim>>() = uneven<dim>(size);
  return position;
}

/// The unknowns that move a link.
template <int dim>
std::vector<Eigen::Index> unknowns_of(const Network<dim>& network, const Link<dim>& link)
{
  std::vector<Eigen::Index> all;
  for (const std::uint32_t grain : {link.grain_1, link.grain_2})
    for (int c = 0; c < n_motions<dim>; ++c)
      all.push_back(n_motions<dim> * Eigen::Index(grain) + c);
  for (int k = 0; k < n_voigt<dim>; ++k)
    all.push_back(network.n_unknowns() - n_voigt<dim> + k);
  return all;
}

TYPED_TEST(TurnedLinks, ChangeTheirMotionByTheirGradient)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  // The slope of a branch by its series, and by its quotient.
  for (const auto& [k, size] : {std::pair(0u, 1e-3), {5u, 0.04}, {11u, 0.3}})
    {
      const Link<dim>& link = network.links()[k];
      const Unknowns here = moved(network, link, size);
      const TurnedLink<dim> place(link, here);
      for (const Eigen::Index i : unknowns_of(network, link))
        {
          const double step = 1e-6 * (i % n_motions<dim> < dim ? link.branch.norm() : 1.0);
          const Unknowns change = step * Unknowns::Unit(network.n_unknowns(), i);
          const Motion<dim> difference =
            (TurnedLink<dim>(link, here + change).motion() - TurnedLink<dim>(link, here - change).motion()) / 2.0;
          // Central differences: the step's third power over length², and the round-off of two motions.
          const double tolerance = 1e-9 * difference.norm() + 1e-15 * place.motion().norm();
          EXPECT_LT((difference - link_motion(link, place.gradient(), change)).norm(), tolerance) << k << " " << i;
        }
    }
}

TYPED_TEST(TurnedLinks, GiveTheirGrainsTheTransposeOfTheirMotion)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const Link<dim>& link = network.links()[3];
  const Unknowns here = moved(network, link, 0.03);
  const TurnedLink<dim> place(link, here);
  const Motion<dim> forces = Motion<dim>::LinSpaced(1.0, 2.0);
  Unknowns sum = Unknowns::Zero(network.n_unknowns());
  add_forces(link, place.gradient(), forces, sum);
  const Unknowns any = moved(network, link, 1.0).reverse();
  EXPECT_NEAR(sum.dot(any), forces.dot(link_motion(link, place.gradient(), any)), 1e-13 * sum.norm() * any.norm());
}

TYPED_TEST(TurnedLinks, AreStiffenedByTheForcesThatTurnWithThem)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const Link<dim>& link = network.links()[2];
  const double angle = 0.01;
  const Unknowns here = moved(network, link, angle);
  const Motion<dim> forces = Motion<dim>::LinSpaced(1.0, 2.0);
  const auto on_grains = [&](const Unknowns& position) {
    Unknowns sum = Unknowns::Zero(network.n_unknowns());
    add_forces(link, TurnedLink<dim>(link, position).gradient(), forces, sum);
    return sum;
  };
  const TurnedLink<dim> place(link, here);
  const LinkTurn<dim> turn{place.gradient(), place.stiffness(forces), forces};
  for (const Eigen::Index i : unknowns_of(network, link))
    {
      const double step = 1e-6 * (i % n_motions<dim> < dim ? link.branch.norm() : 1.0);
      const Unknowns change = step * Unknowns::Unit(network.n_unknowns(), i);
      const Unknowns difference = (on_grains(here + change) - on_grains(here - change)) / 2.0;
      Unknowns stiffened = Unknowns::Zero(network.n_unknowns());
      add_forces_of_motion<dim, Unknowns>(link, turn, JointStiffness<dim>::Zero(), change, stiffened);
      // Beside terms of the square of the angle, round-off of sums of some newtons.
      EXPECT_LT((difference - stiffened).norm(), 3.0 * angle * angle * difference.norm() + 1e-15) << i;
    }
}

TYPED_TEST(TurnedLinks, AreThoseOfSmallStrainsInTheLimit)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const Link<dim>& link = network.links()[4];
  const auto error = [&](const double size) {
    const Unknowns here = moved(network, link, size);
    Motion<dim> difference = TurnedLink<dim>(link, here).motion() - link_motion(link, here);
    difference.template head<dim>() /= link.branch.norm();
    return difference.norm() / size;
  };
  EXPECT_NEAR(error(1e-4) / error(1e-3), 0.1, 0.01); // of the order of the strain
  EXPECT_LT(error(1e-6), 1e-5);
}

TEST(TurnedLink, IsNotMovedByARigidRotationInThePlane)
{
  const Network<2> network(periodic_specimen<2>());
  const Link<2>& link = network.links()[1];
  const double angle = 0.3;
  Unknowns position = Unknowns::Zero(network.n_unknowns());
  const Vector<2> way = (Eigen::Rotation2Dd(angle).toRotationMatrix() - Tensor<2>::Identity()) * link.branch;
  position.segment<2>(3 * Eigen::Index(link.grain_2)) = way;
  position[3 * Eigen::Index(link.grain_1) + 2] = position[3 * Eigen::Index(link.grain_2) + 2] = angle;
  EXPECT_LT(TurnedLink<2>(link, position).motion().norm(), 1e-15);
  EXPECT_GT(link_motion(link, position).norm(), 0.04 * link.branch.norm()); // (1 - cos 0.3) of the branch
}

/// Position of two grains in space after a rotation of both, before which the second has turned by itself.
Unknowns rotated(const Network<3>& network, const Link<3>& link, const Vector<3>& turn, const Vector<3>& of_second)
{
  const auto rotation = [](const Vector<3>& vector) { return Eigen::AngleAxisd(vector.norm(), vector.normalized()); };
  const Eigen::AngleAxisd second(rotation(turn) * Eigen::Quaterniond(rotation(of_second)));
  Unknowns position = Unknowns::Zero(network.n_unknowns());
  position.segment<3>(6 * Eigen::Index(link.grain_2)) = rotation(turn) * link.branch - link.branch;
  position.segment<3>(6 * Eigen::Index(link.grain_1) + 3) = turn;
  position.segment<3>(6 * Eigen::Index(link.grain_2) + 3) = second.angle() * second.axis();
  return position;
}

TEST(TurnedLink, IsNotMovedInSpaceByARigidRotationToItsSecondOrder)
{
  const Network<3> network(periodic_specimen<3>());
  const Link<3>& link = network.links()[1];
  const auto false_motion = [&](const double angle) { // with a twist and both tilts
    const Vector<3> turn = angle * link.axes.transpose() * Vector<3>(1.0, 0.7, -0.4);
    return TurnedLink<3>(link, rotated(network, link, turn, 1e-9 * Vector<3>::UnitX())).motion();
  };
  const double length = link.branch.norm();
  // The series leaves a sixth of products of three turns, which are some 1.3 times the angle together: half of the
  // third power of the angle bounds them and what follows.
  for (const double angle : {0.02, 0.2})
    EXPECT_LT(false_motion(angle).head<3>().norm(), 0.5 * std::pow(angle, 3) * length) << angle;
  EXPECT_NEAR(false_motion(0.1).head<3>().norm() / false_motion(0.05).head<3>().norm(), 8.0, 0.5);
  EXPECT_LT(false_motion(0.2).tail<3>().norm(), 2e-9); // of the turn of 1e-9
}

TEST(TurnedLink, KeepsItsBendAndTwistInARigidRotationInSpace)
{
  const Network<3> network(periodic_specimen<3>());
  const Link<3>& link = network.links()[1];
  const Vector<3> bent = link.axes.transpose() * Vector<3>(2e-3, -1e-3, 3e-3);
  const auto lost = [&](const double angle) {
    const Vector<3> turn = angle * link.axes.transpose() * Vector<3>(1.0, 0.7, -0.4);
    const Motion<3> motion = TurnedLink<3>(link, rotated(network, link, turn, bent)).motion();
    return (motion.tail<3>() - link.axes * bent).norm() / bent.norm();
  };
  // A difference of rotation vectors would lose half of the angle.
  EXPECT_LT(lost(0.05), 0.05 * 0.05);
  EXPECT_LT(lost(0.2), 0.2 * 0.2);
}

/// A path of compression, its sides held.
template <int dim>
PathRun<dim> pressed(const Kinematics kinematics, const double strain, const double modulus_share = 1.0)
{
  Specimen<dim> specimen = periodic_specimen<dim>();
  for (auto* stiffness : {&specimen.joints.normal_stiffness, &specimen.joints.shear_stiffness})
    for (double& value : *stiffness)
      value *= modulus_share;
  specimen.particle_contact.modulus *= modulus_share;
  Control<dim> sides;
  sides.stress_given.fill(true);
  for (int c = 0; c < dim; ++c)
    sides.stress[c] = -20e6;
  Control<dim> press = sides;
  press.stress_given[dim - 1] = false;
  press.strain[dim - 1] = -strain / modulus_share;
  PathParameters parameters;
  parameters.largest_step = 1e-4 / modulus_share;
  parameters.equilibrium.kinematics = kinematics;
  return {std::make_shared<const Network<dim>>(specimen), {{sides, false}, {press, true}}, parameters};
}

TYPED_TEST(TurnedLinks, KeepHillAndMandelAndTheEnergyOfADamagedCell)
{
  constexpr int dim = TypeParam::value;
  const auto run = at_end(pressed<dim>(Kinematics::finite, dim == 2 ? 8e-3 : 4e-3));
  EXPECT_EQ(run.record().failure, "");
  EXPECT_GT(run.record().cracks.size(), 20u);
  for (const auto& sample : run.record().samples)
    {
      EXPECT_LT(sample.hill_mandel_residual, 1e-5);
      EXPECT_LT(sample.energy_imbalance(), 1e-3);
      EXPECT_LT(sample.boundary_stress_error, 1e-5);
    }
}

// An intact network responds as in small strains; from where it leaves that response the energy has no gap.
TYPED_TEST(TurnedLinks, BeginWithTheEnergyOfTheIntactNetworkAsWork)
{
  constexpr int dim = TypeParam::value;
  EquilibriumParameters parameters;
  parameters.kinematics = Kinematics::finite;
  const RepresentativeVolume<dim> rve = small_rve<dim>(1, parameters);
  NetworkState<dim> state = rve.state();
  state.strain = uneven<dim>(1e-3);
  Equilibrium<dim> equilibrium(rve.network(), state, parameters);
  EXPECT_TRUE(equilibrium.link_forces().turns.empty());
  const double intact_energy = equilibrium.stored_energy();
  equilibrium.leave_intact_response();
  EXPECT_EQ(equilibrium.link_forces().turns.size(), rve.network().links().size());
  EXPECT_NE(equilibrium.stored_energy(), intact_energy);
  EXPECT_NEAR(equilibrium.stored_energy(), intact_energy, 0.01 * intact_energy); // of the order of the strain
  const double stored = equilibrium.stored_energy();
  EXPECT_EQ(equilibrium.state().work.boundary, stored);
}

// Near the first break turned contacts may hold where those of small strains break: a state in which nothing is broken is
// that of the intact network, whichever kinematics found it.
TYPED_TEST(TurnedLinks, LeaveAnIntactNetworkItsStress)
{
  constexpr int dim = TypeParam::value;
  EquilibriumParameters parameters;
  parameters.kinematics = Kinematics::finite;
  std::size_t n_on_the_brink = 0;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const RepresentativeVolume<dim> rve = small_rve<dim>(seed, parameters);
      for (const double sign : {1.0, -1.0})
        {
          const double first = rve.network().first_break(axial<dim>(sign)).factor;
          for (int k = -20; k < 200; ++k)
            {
              const Voigt<dim> strain = axial<dim>(sign * first * (1.0 + 1e-5 * k));
              const auto trial = rve.trial(strain);
              if (!trial.state.intact)
                break;
              n_on_the_brink += k > 0;
              EXPECT_EQ(trial.state.stress, Voigt<dim>(rve.network().intact_stiffness() * strain));
            }
        }
    }
  EXPECT_GT(n_on_the_brink, 0u);
}

// Strains of grains ten thousand times as stiff are ten thousand times as small, and so is the effect of turning.
TYPED_TEST(TurnedLinks, MakeNoDifferenceToStiffGrains)
{
  constexpr int dim = TypeParam::value;
  const auto peak = [](const PathRun<dim>& run) { return highest_axial_stress(at_end(run).record()); };
  const double strain = dim == 2 ? 6e-3 : 3e-3;
  const double small = peak(pressed<dim>(Kinematics::small_strains, strain, 1e4));
  const double finite = peak(pressed<dim>(Kinematics::finite, strain, 1e4));
  EXPECT_NEAR(finite, small, 1e-3 * small);
}

TYPED_TEST(TurnedLinks, KeepTheTangentOfADamagedCell)
{
  constexpr int dim = TypeParam::value;
  EquilibriumParameters sharp{.event_tolerance = 1e-8, .final_tolerance = 1e-11};
  sharp.kinematics = Kinematics::finite;
  RepresentativeVolume<dim> rve = small_rve<dim>(1, sharp, 0.0);
  const double first = rve.network().first_break(axial<dim>(1.0)).factor;
  ASSERT_GT(strain_to(rve, axial<dim>((dim == 2 ? 1.2 : 1.8) * first), 10), 2u);
  const Voigt<dim> here = rve.state().strain + axial<dim>(-3e-3) + uneven<dim>(1e-3);
  const auto centre = rve.trial(here, Bonds::frozen, true);
  ASSERT_TRUE(centre.in_equilibrium);
  // The stiffness of turning leaves out terms of the square of the angles of branches, some 1e-3 of the share of stress over
  // stiffness.
  EXPECT_LT(relative(stiffness_by_differences(rve, here), centre.tangent->value), 1e-5);
}
} // namespace
} // namespace feldspar
