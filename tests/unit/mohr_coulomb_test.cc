#include "fem/materials/linear_elasticity.h"
#include "fem/materials/mohr_coulomb.h"
#include "tests/stress_tensor.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace feldspar::fem
{
namespace
{
const MohrCoulombParameters rock{50e9, 0.2, 20e6, 0.7, 0.3};
const double k = (1.0 + std::sin(0.7)) / (1.0 - std::sin(0.7));
const double q_u = 2.0 * 20e6 * std::sqrt(k);

/// σ_1 ≥ σ_2 ≥ σ_3.
Eigen::Vector3d principal(const StressVector<3>& stress)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tests::stress_tensor<3>(stress)).eigenvalues().reverse();
}

Eigen::Matrix3d some_rotation(const double a, const double b, const double c)
{
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(a, Vector3d::UnitX()) * AngleAxisd(b, Vector3d::UnitY()) * AngleAxisd(c, Vector3d::UnitZ()))
    .toRotationMatrix();
}

/// Trial strains, along principal axes, whose return ends in each region of the yield surface.
struct Region
{
  const char* name;
  Eigen::Vector3d strain;
};

const Region regions[] = {{"elastic", {1e-4, 0.0, -4e-4}},
                          {"plane", {2e-3, -1e-3, -6e-3}},
                          {"edge of triaxial compression", {1.0e-3, 0.99e-3, -9e-3}},
                          {"edge of triaxial extension", {3e-3, -4.0e-3, -4.01e-3}},
                          {"apex", {5e-3, 4e-3, 3e-3}}};
} // namespace

TEST(MohrCoulomb, ReturnsToThePartOfTheYieldSurfaceThatEachTrialBelongsTo)
{
  const double apex = 20e6 / std::tan(0.7); // c cot φ
  for (const Region& region : regions)
    {
      SCOPED_TRACE(region.name);
      const Eigen::Matrix3d axes = some_rotation(0.3, -1.1, 2.0);
      const auto response =
        update(rock, {}, strain_voigt<3>(axes * region.strain.asDiagonal() * axes.transpose())).response;
      const Eigen::Vector3d s = principal(response.stress);
      const double excess = k * s[0] - s[2] - q_u;
      const std::string name = region.name;
      const double round_off = 1e-9 * q_u;
      EXPECT_LT(excess, name == "elastic" ? 0.0 : round_off);
      EXPECT_EQ(std::abs(excess) < round_off, name != "elastic");
      const bool at_12 = std::abs(s[0] - s[1]) < round_off;
      const bool at_23 = std::abs(s[1] - s[2]) < round_off;
      EXPECT_EQ(at_12, name == "edge of triaxial compression" || name == "apex");
      EXPECT_EQ(at_23, name == "edge of triaxial extension" || name == "apex");
      EXPECT_EQ(std::abs(s.mean() - apex) < 1e-9 * apex, name == "apex");
    }
}

TEST(MohrCoulomb, HasTheTangentOfItsResponse)
{
  // Central differences of a function linear but for the turning of axes: their error is that of round-off, 1e-16 σ over
  // 1e-8, and curvature, (1e-8/1e-3)². The tangent at edges and at the apex has a share of the elastic one.
  const double step = 1e-8;
  const StiffnessMatrix<3> elastic = isotropic_stiffness<3>(rock.youngs_modulus, rock.poissons_ratio);
  for (const Region& region : regions)
    {
      SCOPED_TRACE(region.name);
      const Eigen::Matrix3d axes = some_rotation(0.3, -1.1, 2.0);
      const StrainVector<3> strain = strain_voigt<3>(axes * region.strain.asDiagonal() * axes.transpose());
      const auto response = update(rock, {}, strain).response;
      for (int c = 0; c < 6; ++c)
        {
          const StrainVector<3> change = step * StrainVector<3>::Unit(c);
          const StressVector<3> by_difference =
            (update(rock, {}, strain + change).response.stress - update(rock, {}, strain - change).response.stress) /
            (2.0 * step);
          const std::string name = region.name;
          const double share = name == "elastic" || name == "plane" ? 0.0 : elastic_share;
          const StressVector<3> expected = (1.0 - share) * by_difference + share * elastic.col(c);
          EXPECT_LT((response.tangent.col(c) - expected).cwiseAbs().maxCoeff(), 2e-7 * rock.youngs_modulus) << c;
        }
    }
}

TEST(MohrCoulomb, RespondsInTheRotatedFrameWithTheRotatedStress)
{
  for (const Region& region : regions)
    {
      const Eigen::Matrix3d axes = some_rotation(0.9, 0.2, -0.4);
      const Eigen::Matrix3d there = some_rotation(-2.0, 0.5, 1.3);
      const Eigen::Matrix3d strain = axes * region.strain.asDiagonal() * axes.transpose();
      const auto here = update(rock, {}, strain_voigt<3>(strain)).response.stress;
      const auto turned = update(rock, {}, strain_voigt<3>(there * strain * there.transpose())).response.stress;
      const Eigen::Matrix3d expected = there * tests::stress_tensor<3>(here) * there.transpose();
      EXPECT_LT((tests::stress_tensor<3>(turned) - expected).norm(), 1e-9 * q_u) << region.name;
    }
}

TEST(MohrCoulomb, StaysOnTheYieldSurfaceAndDissipatesAlongAnyPath)
{
  std::mt19937 engine(7); // its sequence is fixed by the standard
  const auto random = [&] { return double(engine()) / 4294967295.0 - 0.5; };
  // Without dilation: plastic volume would press the point ever deeper into the elastic cone.
  MohrCoulombParameters rock_without_dilation = rock;
  rock_without_dilation.dilation_angle = 0.0;
  MohrCoulombState state;
  StrainVector<3> strain = StrainVector<3>::Zero();
  unsigned int n_plastic = 0;
  for (int step = 0; step < 2000; ++step)
    {
      for (int c = 0; c < 6; ++c)
        strain[c] = 0.9 * strain[c] + 8e-3 * random();
      const auto updated = update(rock_without_dilation, state, strain);
      const Eigen::Vector3d s = principal(updated.response.stress);
      EXPECT_LT(k * s[0] - s[2], q_u * (1.0 + 1e-9));
      // Stress is the elastic one of what is not plastic.
      const StressVector<3> elastic = isotropic_stiffness<3>(50e9, 0.2) * (strain - updated.state.plastic_strain);
      EXPECT_LT((elastic - updated.response.stress).norm(), 1e-9 * q_u);
      EXPECT_GE(updated.state.dissipated, state.dissipated);
      n_plastic += updated.state.dissipated > state.dissipated;
      state = updated.state;
    }
  EXPECT_GT(n_plastic, 100u); // the path does yield, now and then
}

TEST(MohrCoulomb, RefusesParametersOutOfRange)
{
  EXPECT_THROW(mohr_coulomb({50e9, 0.2, 20e6, 0.7, 0.8}), std::invalid_argument); // dilation beyond friction
  EXPECT_THROW(mohr_coulomb({50e9, 0.5, 20e6, 0.7, 0.7}), std::invalid_argument);
  EXPECT_THROW(mohr_coulomb({50e9, 0.2, 0.0, 0.0, 0.0}), std::invalid_argument);
}
} // namespace feldspar::fem
