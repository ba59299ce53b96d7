#include "coupling/network/rigid_motions.h"
#include "tests/stress_tensor.h"
#include "tests/unit/small_rve.h"

#include "base/input_error.h"
#include "tests/unit/small_specimen.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numbers>

/// The intact network: condensed stiffness and first break against independent solutions, and what must not change them.
namespace feldspar
{
namespace
{
template <typename>
using Networks = testing::Test;
TYPED_TEST_SUITE(Networks, Dimensions);

/// C of a body turned by R, component by component.
template <int dim>
Stiffness<dim> turned(const Stiffness<dim>& stiffness, const Tensor<dim>& R)
{
  Stiffness<dim> result;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const Tensor<dim> unit = strain_tensor<dim>(Voigt<dim>::Unit(k));
      const Tensor<dim> stress =
        tests::stress_tensor<dim>(stiffness * strain_voigt<dim>(Tensor<dim>(R.transpose() * unit * R)));
      result.col(k) = stress_voigt<dim>(Tensor<dim>(R * stress * R.transpose()));
    }
  return result;
}

TYPED_TEST(Networks, RestIsFreeOfStress)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const NetworkState<dim> rest;
  const Equilibrium<dim> equilibrium(network, rest, {});
  EXPECT_EQ(equilibrium.stress(), (Voigt<dim>::Zero()));
  EXPECT_EQ(equilibrium.stored_energy(), 0.0);
  for (const auto& forces : link_forces(network, rest).values)
    EXPECT_EQ(forces, (Motion<dim>::Zero()));
}

TEST(Network, NeedsAPeriodicSpecimen) { EXPECT_THROW(Network<2>{small_specimen()}, InputError); }

TYPED_TEST(Networks, StiffnessIsThatOfADirectSolution)
{
  constexpr int dim = TypeParam::value;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      const Network<dim> network(periodic_specimen<dim>(seed));
      const DirectSolution<dim> direct(network, intact_stiffnesses(network));
      EXPECT_LT(relative(network.intact_stiffness(), direct.stiffness), 1e-8) << seed;
      // Rearrangement only softens: affine minus condensed is positive semidefinite.
      const Stiffness<dim> difference = direct.affine_stiffness - network.intact_stiffness();
      EXPECT_GT(difference.template selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
    }
}

TYPED_TEST(Networks, EnergyAndStressGiveTheSameStiffness)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const Stiffness<dim>& C = network.intact_stiffness();
  Random random(1, RandomStream::positions);
  for (unsigned int k = 0; k < 20; ++k)
    {
      NetworkState<dim> state;
      state.strain = 1e-5 * random_direction<dim>(random);
      const Equilibrium<dim> equilibrium(network, state, {});
      const double by_stress = 0.5 * network.volume() * state.strain.dot(C * state.strain);
      EXPECT_NEAR(equilibrium.stored_energy(), by_stress, 1e-8 * by_stress);
      EXPECT_LT(relative(equilibrium.stress(), C * state.strain), 1e-8);
    }
}

// Maxwell and Betti: stress i under strain j is stress j under strain i. The network hands out a mean of both; here each
// column comes from the forces of its links, and from a solution that shares nothing with it.
TYPED_TEST(Networks, StiffnessIsReciprocal)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  Stiffness<dim> by_forces;
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      NetworkState<dim> state;
      state.strain = 1e-6 * Voigt<dim>::Unit(k);
      by_forces.col(k) = stress_voigt<dim>(branch_stress(network, link_forces(network, state))) / 1e-6;
    }
  // A network is no isotropic body: entries that isotropy would leave zero are there to be compared.
  EXPECT_GT(std::abs(by_forces(0, n_voigt<dim> - 1)), 1e-4 * by_forces.norm());
  EXPECT_LT(relative(by_forces.transpose(), by_forces), 1e-10);
  EXPECT_LT(relative(network.intact_stiffness(), by_forces), 1e-10);
  const Stiffness<dim> direct = DirectSolution<dim>(network, intact_stiffnesses(network)).stiffness;
  EXPECT_LT(relative(direct.transpose(), direct), 1e-8);
}

TYPED_TEST(Networks, StressIsSymmetricAndThatOfTheSides)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  NetworkState<dim> state;
  state.strain = uneven<dim>(3e-5);
  const auto forces = link_forces(network, state);
  const Tensor<dim> stress = branch_stress(network, forces);
  // Forces and couples balance to the 1e-13 of the unit solutions, against forces of grains.
  EXPECT_LT((stress - stress.transpose()).norm(), 1e-10 * stress.norm());
  EXPECT_LT(relative(boundary_stress(network, *network.conditions(), forces), stress), 1e-10);
  EXPECT_LT(relative(stress_voigt<dim>(stress), network.intact_stiffness() * state.strain), 1e-10);
}

template <int dim>
std::vector<Tensor<dim>> turns()
{
  std::vector<Tensor<dim>> result;
  for (const double degrees : {17.0, 45.0, 90.0, 200.0})
    {
      const double angle = degrees * std::numbers::pi / 180.0;
      if constexpr (dim == 2)
        result.push_back(Eigen::Rotation2Dd(angle).toRotationMatrix());
      else
        result.push_back(Eigen::AngleAxisd(angle, Vector<3>(1.0, degrees / 90.0, -0.5).normalized()).matrix());
    }
  return result;
}

// Round-off in the sums of forces on what may float is multiplied by the inverse of the factor's regularity. In this cell,
// turned by 60 degrees, the solution once came to a hundred times the stiffness.
TEST(Network, KeepsItsStiffnessAtEveryAngle)
{
  SpecimenParameters wanted;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = 0.016;
  FlatJointParameters joint;
  joint.installation_gap_ratio = 0.0457;
  for (const std::uint64_t seed : {1, 2})
    {
      const auto specimen = make_specimen<2>(wanted, joint, {}, seed);
      const Stiffness<2> straight = Network<2>(specimen).intact_stiffness();
      for (int degrees = 5; degrees <= 180; degrees += 5)
        {
          const Tensor<2> R = Eigen::Rotation2Dd(degrees * std::numbers::pi / 180.0).toRotationMatrix();
          EXPECT_LT(relative(Network<2>(specimen, R).intact_stiffness(), turned<2>(straight, R)), 1e-9)
            << seed << " " << degrees;
        }
    }
}

// Two grains joined to each other alone shift and turn as one; what hangs on its images shifts only.
TYPED_TEST(Networks, RigidMotionsStrainNoJoint)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  Random random(5, RandomStream::positions);
  const auto uneven_motion = [&](const std::size_t n_grains) {
    Unknowns motion = Unknowns::Zero(n_motions<dim> * Eigen::Index(n_grains) + n_voigt<dim>);
    for (Eigen::Index k = 0; k < motion.size() - n_voigt<dim>; ++k)
      motion[k] = random.uniform(-1.0, 1.0);
    return motion;
  };
  const auto rigid_part = [](const RigidMotions<dim>& rigid, const Unknowns& motion) {
    return Unknowns(motion - rigid.removed_from(motion));
  };
  const RigidMotions<dim> of_all(network.links(), network.n_joints(), network.n_grains());
  const Unknowns motion = uneven_motion(network.n_grains());
  const Unknowns shift = rigid_part(of_all, motion);
  EXPECT_GT(shift.norm(), 0.01 * motion.norm());
  EXPECT_LT(rigid_part(of_all, of_all.removed_from(motion)).norm(), 1e-12 * motion.norm());
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    ASSERT_LT(link_motion(network.links()[j], shift).norm(), 1e-12 * motion.norm());

  const RigidMotions<dim> of_pair(network.links(), 1, network.n_grains());
  const Unknowns of_two = rigid_part(of_pair, motion);
  const Link<dim>& link = network.links()[0];
  EXPECT_LT(link_motion(link, of_two).norm(), 1e-12 * motion.norm());
  const auto turn = of_two.segment(n_motions<dim> * Eigen::Index(link.grain_1) + dim, n_rotations<dim>);
  EXPECT_GT(turn.norm(), 0.01);
}

TYPED_TEST(Networks, LinksMoveAsTheirGradientsSay)
{
  constexpr int dim = TypeParam::value;
  constexpr int n = n_motions<dim>;
  const Network<dim> network(periodic_specimen<dim>());
  Random random(1, RandomStream::dealing);
  // Motions of a strain, and turns of the same size; a link has six numbers of a few products each.
  UnitUnknowns<dim> several = UnitUnknowns<dim>::Zero(network.n_unknowns(), UnitUnknowns<dim>::ColsAtCompileTime);
  for (double& entry : several.reshaped())
    entry = random.uniform(-1.0, 1.0);
  for (const Link<dim>& link : network.links())
    {
      const RowsOf<n, UnitUnknowns<dim>> together = link_motion(link, several);
      for (Eigen::Index k = 0; k < several.cols(); ++k)
        {
          const Unknowns one = several.col(k);
          Eigen::Matrix<double, 2 * n, 1> of_grains;
          of_grains << one.segment<n>(n * Eigen::Index(link.grain_1)), one.segment<n>(n * Eigen::Index(link.grain_2));
          const Motion<dim> motion = link_motion(link, one);
          const Motion<dim> expected = link.by_grains * of_grains + link.by_strain * one.tail<n_voigt<dim>>();
          ASSERT_LT((motion - expected).cwiseAbs().maxCoeff(), 1e-14);
          ASSERT_LT((together.col(k) - expected).cwiseAbs().maxCoeff(), 1e-14);

          Unknowns sum = Unknowns::Zero(network.n_unknowns());
          add_forces(link, motion, sum);
          ASSERT_NEAR(sum.dot(one), motion.squaredNorm(), 1e-13 * motion.squaredNorm());
        }
    }
}

TYPED_TEST(Networks, TurnsWithItsCell)
{
  constexpr int dim = TypeParam::value;
  const Specimen<dim> specimen = periodic_specimen<dim>();
  const Network<dim> straight(specimen);
  for (const Tensor<dim>& R : turns<dim>())
    {
      const Network<dim> network(specimen, R);
      EXPECT_LT(relative(network.intact_stiffness(), turned<dim>(straight.intact_stiffness(), R)), 1e-9) << R;

      // The same segment breaks first under the strain that turned with it.
      const Voigt<dim> direction = uneven<dim>(1.0);
      const FirstBreak before = straight.first_break(direction);
      const FirstBreak after =
        network.first_break(strain_voigt<dim>(Tensor<dim>(R * strain_tensor<dim>(direction) * R.transpose())));
      EXPECT_EQ(after.segment, before.segment);
      EXPECT_NEAR(after.factor, before.factor, 1e-9 * before.factor);
    }
}

TYPED_TEST(Networks, KnowsNoOriginOfTheCell)
{
  constexpr int dim = TypeParam::value;
  Specimen<dim> specimen = periodic_specimen<dim>();
  const Network<dim> network(specimen);
  Components<dim> positions = specimen.grains.position;
  for (int c = 0; c < dim; ++c)
    for (double& x : positions[c])
      {
        x += (0.37 + 0.2 * c) * specimen.size[c];
        x -= specimen.size[c] * std::floor(x / specimen.size[c]);
      }
  specimen.grains.place(std::vector<double>(specimen.grains.radius), positions);
  const Network<dim> shifted(specimen);
  EXPECT_EQ(shifted.links().size(), network.links().size());
  EXPECT_LT(relative(shifted.intact_stiffness(), network.intact_stiffness()), 1e-9);
  // Other links cross the sides now; their mean is the same stress.
  NetworkState<dim> state;
  state.strain = uneven<dim>(3e-5);
  EXPECT_LT(relative(boundary_stress(shifted, *shifted.conditions(), link_forces(shifted, state)),
                     boundary_stress(network, *network.conditions(), link_forces(network, state))),
            1e-9);
}

/// Grain i becomes grain n - 1 - i, and joints count backwards.
template <int dim>
Specimen<dim> renumbered(const Specimen<dim>& specimen)
{
  Specimen<dim> result = specimen;
  const auto n = std::uint32_t(specimen.grains.size());
  std::vector<double> radii(specimen.grains.radius.rbegin(), specimen.grains.radius.rend());
  Components<dim> positions;
  for (int c = 0; c < dim; ++c)
    positions[c].assign(specimen.grains.position[c].rbegin(), specimen.grains.position[c].rend());
  result.grains.place(radii, positions);
  auto& joints = result.joints;
  const auto reverse = [](auto& values) { std::reverse(values.begin(), values.end()); };
  joints.visit_per_joint([&](const std::string&, auto& values) { reverse(values); });
  const auto n_joints = std::ptrdiff_t(joints.size());
  joints.visit_per_segment([&](const std::string&, auto& values) {
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

TYPED_TEST(Networks, KnowsNoNumbers)
{
  constexpr int dim = TypeParam::value;
  const Specimen<dim> specimen = periodic_specimen<dim>();
  const auto network = std::make_shared<const Network<dim>>(specimen);
  const auto other = std::make_shared<const Network<dim>>(renumbered(specimen));
  EXPECT_LT(relative(other->intact_stiffness(), network->intact_stiffness()), 1e-9);

  // Nor after breaks.
  const EquilibriumParameters sharp{.event_tolerance = 1e-11, .final_tolerance = 1e-11};
  RepresentativeVolume<dim> rve(network, sharp);
  RepresentativeVolume<dim> other_rve(other, sharp);
  const Voigt<dim> strain = axial<dim>((dim == 2 ? 1.15 : 1.8) * network->first_break(axial<dim>(1.0)).factor);
  const std::size_t n_breaks = strain_to(rve, strain, 5);
  EXPECT_GT(n_breaks, 3u);
  EXPECT_EQ(strain_to(other_rve, strain, 5), n_breaks);
  EXPECT_LT(relative(other_rve.state().stress, rve.state().stress), 1e-9);
}

/// The cell twice along each axis.
template <int dim>
Specimen<dim> replicated(const Specimen<dim>& specimen)
{
  constexpr std::uint32_t n_copies = 1u << dim;
  Specimen<dim> result = specimen;
  result.size = 2.0 * specimen.size;
  const auto n = std::uint32_t(specimen.grains.size());
  const std::size_t n_joints = specimen.joints.size();
  const auto place = [](const std::uint32_t copy, const int axis) { return copy >> axis & 1u; };
  std::vector<double> radii;
  Components<dim> positions;
  auto& joints = result.joints;
  joints.resize_all(n_copies * n_joints);
  for (std::uint32_t copy = 0; copy < n_copies; ++copy)
    for (std::uint32_t i = 0; i < n; ++i)
      {
        radii.push_back(specimen.grains.radius[i]);
        for (int c = 0; c < dim; ++c)
          positions[c].push_back(specimen.grains.position[c][i] + place(copy, c) * specimen.size[c]);
      }
  result.grains.place(radii, positions);

  std::vector<const PackedRow*> sources;
  Joints<dim> source = specimen.joints;
  source.visit_per_joint([&](const std::string&, PackedRow& values) { sources.push_back(&values); });
  source.visit_per_segment([&](const std::string&, PackedRow& values) { sources.push_back(&values); });
  std::size_t next = 0;
  const auto copy_rows = [&](const std::string&, PackedRow& values) {
    const PackedRow& from = *sources[next++];
    for (std::size_t row = 0; row < from.size() / n_joints; ++row)
      for (std::size_t copy = 0; copy < n_copies; ++copy)
        for (std::size_t j = 0; j < n_joints; ++j)
          values[(row * n_copies + copy) * n_joints + j] = from[row * n_joints + j];
  };
  joints.visit_per_joint(copy_rows);
  joints.visit_per_segment(copy_rows);
  for (std::uint32_t copy = 0; copy < n_copies; ++copy)
    for (std::size_t j = 0; j < n_joints; ++j)
      {
        const auto second = specimen.second_of(j);
        std::uint32_t leads_to = 0;
        for (int c = 0; c < dim; ++c)
          leads_to |= ((place(copy, c) + std::uint32_t(second.boxes[c] + 2)) & 1u) << c;
        joints.grain_1[copy * n_joints + j] = specimen.joints.grain_1[j] + copy * n;
        joints.grain_2[copy * n_joints + j] = specimen.joints.grain_2[j] + leads_to * n;
      }
  return result;
}

TYPED_TEST(Networks, RepeatedRespondsAsOne)
{
  constexpr int dim = TypeParam::value;
  constexpr std::size_t n_copies = std::size_t(1) << dim;
  const Specimen<dim> specimen = periodic_specimen<dim>();
  const auto network = std::make_shared<const Network<dim>>(specimen);
  const auto several = std::make_shared<const Network<dim>>(replicated(specimen));
  EXPECT_EQ(several->links().size(), n_copies * network->links().size());
  EXPECT_LT(relative(several->intact_stiffness(), network->intact_stiffness()), 1e-8);
  const Voigt<dim> direction = axial<dim>(1.0) + uneven<dim>(0.1);
  const double first = network->first_break(direction).factor;
  EXPECT_NEAR(several->first_break(direction).factor, first, 1e-8 * first);

  // The same segments break in all of them.
  const EquilibriumParameters sharp{.event_tolerance = 1e-11, .final_tolerance = 1e-11};
  RepresentativeVolume<dim> rve(network, sharp);
  RepresentativeVolume<dim> repeated(several, sharp);
  const Voigt<dim> strain = 1.1 * first * direction;
  const std::size_t n_breaks = strain_to(rve, strain, 3);
  EXPECT_GT(n_breaks, 0u);
  EXPECT_EQ(strain_to(repeated, strain, 3), n_copies * n_breaks);
  EXPECT_LT(relative(repeated.state().stress, rve.state().stress), 1e-8);
}

TYPED_TEST(Networks, FirstBreakIsThatOfTheFullSolution)
{
  constexpr int dim = TypeParam::value;
  const Network<dim> network(periodic_specimen<dim>());
  const DirectSolution<dim> direct(network, intact_stiffnesses(network));
  const auto overloaded = [&](const Voigt<dim>& strain) {
    const Unknowns unknowns = direct.at(strain);
    std::vector<std::uint32_t> segments;
    for (std::size_t j = 0; j < network.n_joints(); ++j)
      {
        const Link<dim>& link = network.links()[j];
        const Motion<dim> motion = link_motion(link, unknowns);
        std::array<double, n_rotations<dim>> rotation;
        std::copy(motion.data() + dim, motion.data() + motion.size(), rotation.begin());
        std::array<double, dim - 1> slip;
        std::copy(motion.data() + 1, motion.data() + dim, slip.begin());
        for (std::uint32_t i = 0; i < link.n_segments; ++i)
          {
            auto offset = network.elements()[i].offset;
            for (double& component : offset)
              component *= link.half_length;
            const double normal = link.normal_stiffness * flat_joint::gap_at(motion[0], rotation, offset);
            const double shear =
              link.shear_stiffness * flat_joint::magnitude(flat_joint::slip_at(slip, rotation[0], offset));
            const Bond<double>& bond = network.bond(link.first_segment + i);
            if (normal > bond.tensile_strength || shear > std::max(0.0, bond.cohesion - bond.friction_slope * normal))
              segments.push_back(link.first_segment + i);
          }
      }
    return segments;
  };
  Random random(7, RandomStream::positions);
  unsigned int n_touching = 0;
  for (unsigned int k = 0; k < 200; ++k)
    {
      const Voigt<dim> direction = random_direction<dim>(random);
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
      EXPECT_TRUE(network.stays_intact(Voigt<dim>((1.0 - 1e-6) * linear_until * direction))) << direction.transpose();
      EXPECT_FALSE(network.stays_intact(Voigt<dim>((1.0 + 1e-6) * linear_until * direction)));
    }
  EXPECT_LT(n_touching, 20u); // of 200
}

TYPED_TEST(Networks, NothingThatIsNoNumberStaysIntact)
{
  constexpr int dim = TypeParam::value;
  const RepresentativeVolume<dim> rve = small_rve<dim>();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
    {
      EXPECT_FALSE(rve.network().stays_intact(axial<dim>(bad)));
      EXPECT_FALSE(rve.trial(axial<dim>(bad)).in_equilibrium);
    }
}

TYPED_TEST(Networks, FabricHasAUnitTrace)
{
  constexpr int dim = TypeParam::value;
  EXPECT_NEAR(fabric(Network<dim>(periodic_specimen<dim>())).trace(), 1.0, 1e-12);
}

TEST(Homogenisation, ConstantsOfAnIsotropicPlane)
{
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

TEST(Homogenisation, ConstantsOfAnIsotropicBody)
{
  // C11 = λ + 2G, C12 = λ, C44 = G with λ = Eν/((1 + ν)(1 - 2ν)).
  constexpr double E = 70.0;
  constexpr double nu = 0.2;
  constexpr double G = E / (2.0 * (1.0 + nu));
  Stiffness<3> C = 2.0 * G * Stiffness<3>::Identity();
  C.topLeftCorner<3, 3>().array() += E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  C.bottomRightCorner<3, 3>() *= 0.5;
  const auto constants = isotropic_constants<3>(C);
  EXPECT_NEAR(constants.youngs_modulus, E, 1e-12 * E);
  EXPECT_NEAR(constants.poissons_ratio, nu, 1e-12);
  EXPECT_NEAR(constants.bulk_modulus, E / (3.0 * (1.0 - 2.0 * nu)), 1e-12 * E);
  EXPECT_NEAR(constants.shear_modulus, G, 1e-12 * E);
  EXPECT_NEAR(constants.anisotropy, 0.0, 1e-12);

  // One of three shear moduli off by ten per cent: one of five deviatoric directions.
  C(5, 5) *= 1.1;
  EXPECT_NEAR(isotropic_constants<3>(C).shear_modulus, 1.02 * G, 1e-12 * E);
  EXPECT_GT(isotropic_constants<3>(C).anisotropy, 0.01);
}
} // namespace
} // namespace feldspar
