#include "tests/unit/small_volume.h"

#include "dem/input_error.h"
#include "tests/unit/small_specimen.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <numbers>

/// The intact network: condensed stiffness and first break against independent solutions, and what must not change them.
namespace feldspar
{
namespace
{
/// C of a body turned by R, component by component.
Stiffness<2> turned(const Stiffness<2>& stiffness, const Tensor<2>& R)
{
  Stiffness<2> result;
  for (int k = 0; k < 3; ++k)
    {
      const Tensor<2> unit = strain_tensor<2>(Voigt<2>::Unit(k));
      const Tensor<2> stress = stress_tensor<2>(stiffness * strain_voigt<2>(Tensor<2>(R.transpose() * unit * R)));
      result.col(k) = stress_voigt<2>(Tensor<2>(R * stress * R.transpose()));
    }
  return result;
}

TEST(Network, RestIsFreeOfStress)
{
  const Network<2> network(periodic_specimen());
  const NetworkState<2> rest;
  const Equilibrium<2> equilibrium(network, rest, {});
  EXPECT_EQ(equilibrium.stress(), (Voigt<2>::Zero()));
  EXPECT_EQ(equilibrium.stored_energy(), 0.0);
  for (const auto& forces : link_forces(network, rest))
    EXPECT_EQ(forces, (Motion<2>::Zero()));
}

TEST(Network, NeedsAPeriodicSpecimen) { EXPECT_THROW(Network<2>{small_specimen()}, InputError); }

TEST(Network, StiffnessIsThatOfADirectSolution)
{
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const Network<2> network(periodic_specimen(seed));
      const DirectSolution direct(network, intact_stiffnesses(network));
      EXPECT_LT(relative(network.intact_stiffness(), direct.stiffness), 1e-8) << seed;
      // Rearrangement only softens: affine minus condensed is positive semidefinite.
      const Stiffness<2> difference = direct.affine_stiffness - network.intact_stiffness();
      EXPECT_GT(difference.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
    }
}

TEST(Network, EnergyAndStressGiveTheSameStiffness)
{
  const Network<2> network(periodic_specimen());
  const Stiffness<2>& C = network.intact_stiffness();
  EXPECT_EQ(C, C.transpose());
  Random random(1, RandomStream::positions);
  for (unsigned int k = 0; k < 20; ++k)
    {
      NetworkState<2> state;
      state.strain = 1e-5 * random_direction(random);
      const Equilibrium<2> equilibrium(network, state, {});
      const double by_stress = 0.5 * network.volume() * state.strain.dot(C * state.strain);
      EXPECT_NEAR(equilibrium.stored_energy(), by_stress, 1e-8 * by_stress);
      EXPECT_LT(relative(equilibrium.stress(), C * state.strain), 1e-8);
    }
}

TEST(Network, StressIsSymmetricAndThatOfTheSides)
{
  const Network<2> network(periodic_specimen());
  NetworkState<2> state;
  state.strain = Voigt<2>(1e-5, -2e-5, 3e-5);
  const auto forces = link_forces(network, state);
  const Tensor<2> stress = branch_stress(network, forces);
  // Forces and couples balance to the 1e-13 of the unit solutions, against forces of grains.
  EXPECT_NEAR(stress(0, 1), stress(1, 0), 1e-10 * stress.norm());
  EXPECT_LT(relative(boundary_stress(network, forces), stress), 1e-10);
  EXPECT_LT(relative(stress_voigt<2>(stress), network.intact_stiffness() * state.strain), 1e-10);
}

TEST(Network, TurnsWithItsCell)
{
  const Specimen<2> specimen = periodic_specimen();
  const Network<2> straight(specimen);
  for (const double degrees : {17.0, 45.0, 90.0, 200.0})
    {
      const double angle = degrees * std::numbers::pi / 180.0;
      const Tensor<2> R = Eigen::Rotation2Dd(angle).toRotationMatrix();
      const Network<2> network(specimen, R);
      EXPECT_LT(relative(network.intact_stiffness(), turned(straight.intact_stiffness(), R)), 1e-9) << degrees;

      // The same segment breaks first under the strain that turned with it.
      const Voigt<2> direction(0.3, 1.0, 0.5);
      const FirstBreak before = straight.first_break(direction);
      const FirstBreak after =
        network.first_break(strain_voigt<2>(Tensor<2>(R * strain_tensor<2>(direction) * R.transpose())));
      EXPECT_EQ(after.segment, before.segment);
      EXPECT_NEAR(after.factor, before.factor, 1e-9 * before.factor);
    }
}

TEST(Network, KnowsNoOriginOfTheCell)
{
  Specimen<2> specimen = periodic_specimen();
  const Network<2> network(specimen);
  Components<2> positions = specimen.grains.position;
  for (int c = 0; c < 2; ++c)
    for (double& x : positions[c])
      {
        x += (0.37 + 0.2 * c) * specimen.size[c];
        x -= specimen.size[c] * std::floor(x / specimen.size[c]);
      }
  specimen.grains.place(std::vector<double>(specimen.grains.radius), positions);
  const Network<2> shifted(specimen);
  EXPECT_EQ(shifted.links().size(), network.links().size());
  EXPECT_LT(relative(shifted.intact_stiffness(), network.intact_stiffness()), 1e-9);
  // Other links cross the sides now; their mean is the same stress.
  NetworkState<2> state;
  state.strain = Voigt<2>(1e-5, -2e-5, 3e-5);
  EXPECT_LT(relative(boundary_stress(shifted, link_forces(shifted, state)),
                     boundary_stress(network, link_forces(network, state))),
            1e-9);
}

/// Grain i becomes grain n - 1 - i, and joints count backwards.
Specimen<2> renumbered(const Specimen<2>& specimen)
{
  Specimen<2> result = specimen;
  const auto n = std::uint32_t(specimen.grains.size());
  std::vector<double> radii(specimen.grains.radius.rbegin(), specimen.grains.radius.rend());
  Components<2> positions;
  for (int c = 0; c < 2; ++c)
    positions[c].assign(specimen.grains.position[c].rbegin(), specimen.grains.position[c].rend());
  result.grains.place(radii, positions);
  auto& joints = result.joints;
  const auto reverse = [](auto& values) { std::reverse(values.begin(), values.end()); };
  joints.visit_per_joint([&](const std::string&, std::vector<double>& values) { reverse(values); });
  const auto n_joints = std::ptrdiff_t(joints.size());
  joints.visit_per_segment([&](const std::string&, std::vector<double>& values) {
    for (auto row = values.begin(); row != values.end(); row += n_joints)
      std::reverse(row, row + n_joints);
  });
  for (auto* ends : {&joints.grain_1, &joints.grain_2})
    {
      reverse(*ends);
      for (std::uint32_t& grain : *ends)
        grain = n - 1 - grain;
    }
  return result;
}

TEST(Network, KnowsNoNumbers)
{
  const Specimen<2> specimen = periodic_specimen();
  const auto network = std::make_shared<const Network<2>>(specimen);
  const auto other = std::make_shared<const Network<2>>(renumbered(specimen));
  EXPECT_LT(relative(other->intact_stiffness(), network->intact_stiffness()), 1e-9);

  // Nor after breaks.
  const EquilibriumParameters sharp{.event_tolerance = 1e-11, .final_tolerance = 1e-11};
  RepresentativeVolume<2> volume(network, sharp);
  RepresentativeVolume<2> other_volume(other, sharp);
  const double first = network->first_break(Voigt<2>(0.0, 1.0, 0.0)).factor;
  const Voigt<2> strain(0.0, 1.15 * first, 0.0);
  const std::size_t n_breaks = strain_to(volume, strain, 5);
  EXPECT_GT(n_breaks, 3u);
  EXPECT_EQ(strain_to(other_volume, strain, 5), n_breaks);
  EXPECT_LT(relative(other_volume.state().stress, volume.state().stress), 1e-9);
}

/// The cell twice across and twice along.
Specimen<2> replicated(const Specimen<2>& specimen)
{
  Specimen<2> result = specimen;
  result.size = 2.0 * specimen.size;
  const auto n = std::uint32_t(specimen.grains.size());
  const std::size_t n_joints = specimen.joints.size();
  std::vector<double> radii;
  Components<2> positions;
  auto& joints = result.joints;
  joints.resize_all(4 * n_joints);
  for (std::uint32_t copy = 0; copy < 4; ++copy)
    for (std::uint32_t i = 0; i < n; ++i)
      {
        radii.push_back(specimen.grains.radius[i]);
        positions[0].push_back(specimen.grains.position[0][i] + (copy % 2) * specimen.size[0]);
        positions[1].push_back(specimen.grains.position[1][i] + (copy / 2) * specimen.size[1]);
      }
  result.grains.place(radii, positions);

  std::vector<const std::vector<double>*> sources;
  Joints<2> source = specimen.joints;
  source.visit_per_joint([&](const std::string&, std::vector<double>& values) { sources.push_back(&values); });
  source.visit_per_segment([&](const std::string&, std::vector<double>& values) { sources.push_back(&values); });
  std::size_t next = 0;
  const auto copy_rows = [&](const std::string&, std::vector<double>& values) {
    const std::vector<double>& from = *sources[next++];
    for (std::size_t row = 0; row < from.size() / n_joints; ++row)
      for (std::size_t copy = 0; copy < 4; ++copy)
        for (std::size_t j = 0; j < n_joints; ++j)
          values[(row * 4 + copy) * n_joints + j] = from[row * n_joints + j];
  };
  joints.visit_per_joint(copy_rows);
  joints.visit_per_segment(copy_rows);
  for (std::uint32_t copy = 0; copy < 4; ++copy)
    for (std::size_t j = 0; j < n_joints; ++j)
      {
        const auto second = specimen.second_of(j);
        const std::uint32_t column = (copy % 2 + std::uint32_t(second.boxes[0] + 2)) % 2;
        const std::uint32_t row = (copy / 2 + std::uint32_t(second.boxes[1] + 2)) % 2;
        joints.grain_1[copy * n_joints + j] = specimen.joints.grain_1[j] + copy * n;
        joints.grain_2[copy * n_joints + j] = specimen.joints.grain_2[j] + (2 * row + column) * n;
      }
  return result;
}

TEST(Network, RepeatedAnswersAsOne)
{
  const Specimen<2> specimen = periodic_specimen();
  const auto network = std::make_shared<const Network<2>>(specimen);
  const auto four = std::make_shared<const Network<2>>(replicated(specimen));
  EXPECT_EQ(four->links().size(), 4 * network->links().size());
  EXPECT_LT(relative(four->intact_stiffness(), network->intact_stiffness()), 1e-8);
  const Voigt<2> direction(0.1, 1.0, -0.2);
  EXPECT_NEAR(four->first_break(direction).factor, network->first_break(direction).factor,
              1e-8 * network->first_break(direction).factor);

  // The same segments break in all four.
  const EquilibriumParameters sharp{.event_tolerance = 1e-11, .final_tolerance = 1e-11};
  RepresentativeVolume<2> volume(network, sharp);
  RepresentativeVolume<2> repeated(four, sharp);
  const Voigt<2> strain = 1.1 * network->first_break(direction).factor * direction;
  const std::size_t n_breaks = strain_to(volume, strain, 3);
  EXPECT_GT(n_breaks, 0u);
  EXPECT_EQ(strain_to(repeated, strain, 3), 4 * n_breaks);
  EXPECT_LT(relative(repeated.state().stress, volume.state().stress), 1e-8);
}

TEST(Network, FirstBreakIsThatOfTheFullSolution)
{
  const Network<2> network(periodic_specimen());
  const DirectSolution direct(network, intact_stiffnesses(network));
  const auto overloaded = [&](const Voigt<2>& strain) {
    const Unknowns unknowns = direct.at(strain);
    std::vector<std::uint32_t> segments;
    for (std::size_t j = 0; j < network.n_joints(); ++j)
      {
        const Link<2>& link = network.links()[j];
        const Motion<2> motion = link_motion(link, unknowns);
        for (std::uint32_t i = 0; i < link.n_segments; ++i)
          {
            const double offset = link.half_length * network.elements()[i].offset[0];
            const double normal = link.normal_stiffness * (motion[0] - motion[2] * offset);
            const double shear = std::abs(link.shear_stiffness * motion[1]);
            const Strength& bond = network.strength(link.first_segment + i);
            if (normal > bond.tensile || shear > std::max(0.0, bond.cohesion - network.friction_slope() * normal))
              segments.push_back(link.first_segment + i);
          }
      }
    return segments;
  };
  Random random(7, RandomStream::positions);
  unsigned int n_touching = 0;
  for (unsigned int k = 0; k < 200; ++k)
    {
      const Voigt<2> direction = random_direction(random);
      const FirstBreak first = network.first_break(direction);
      double low = 0.0;
      double high = 0.1;
      while (high - low > 1e-9 * high)
        (overloaded(0.5 * (low + high) * direction).empty() ? low : high) = 0.5 * (low + high);
      EXPECT_NEAR(first.factor, high, 1e-6 * high);
      EXPECT_EQ(overloaded(high * direction), std::vector<std::uint32_t>{first.segment});

      // Pairs without a face stay apart until then, but for some directions that press from all sides.
      const double linear_until = std::min(first.factor, first.touch);
      n_touching += first.touch < first.factor;
      EXPECT_TRUE(network.stays_intact(Voigt<2>((1.0 - 1e-6) * linear_until * direction))) << direction.transpose();
      EXPECT_FALSE(network.stays_intact(Voigt<2>((1.0 + 1e-6) * linear_until * direction)));
    }
  EXPECT_LT(n_touching, 10u);
}

TEST(Network, NothingThatIsNoNumberStaysIntact)
{
  const RepresentativeVolume<2> volume = small_volume();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    {
      EXPECT_FALSE(volume.network().stays_intact(Voigt<2>(0.0, bad, 0.0)));
      EXPECT_FALSE(volume.trial(Voigt<2>(0.0, bad, 0.0)).in_equilibrium);
    }
}

TEST(Network, FabricAndConstantsOfAnIsotropicBody)
{
  const Network<2> network(periodic_specimen());
  EXPECT_NEAR(fabric(network).trace(), 1.0, 1e-12);

  // Plane stress: C11 = E/(1 - ν²), C12 = νC11, C33 = E/(2(1 + ν)).
  constexpr double E = 70.0;
  constexpr double nu = 0.2;
  Stiffness<2> C = Stiffness<2>::Zero();
  C(0, 0) = C(1, 1) = E / (1.0 - nu * nu);
  C(0, 1) = C(1, 0) = nu * C(0, 0);
  C(2, 2) = E / (2.0 * (1.0 + nu));
  const auto constants = isotropic_constants<2>(C);
  EXPECT_NEAR(constants.youngs_modulus, E, 1e-12 * E);
  EXPECT_NEAR(constants.poissons_ratio, nu, 1e-12);
  EXPECT_NEAR(constants.shear_modulus, C(2, 2), 1e-12 * E);
  EXPECT_NEAR(constants.anisotropy, 0.0, 1e-12);

  // A shear modulus off by ten per cent: the projection spreads it over both deviatoric directions.
  C(2, 2) *= 1.1;
  EXPECT_NEAR(isotropic_constants<2>(C).shear_modulus, 1.05 * E / (2.0 * (1.0 + nu)), 1e-12 * E);
  EXPECT_GT(isotropic_constants<2>(C).anisotropy, 0.01);
}
} // namespace
} // namespace feldspar
