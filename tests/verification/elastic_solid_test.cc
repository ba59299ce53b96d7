// The solid in linear elasticity, against closed forms.

#include "fem/linear_elasticity.h"
#include "fem/solid.h"

#include <gtest/gtest.h>

namespace feldspar::fem
{
namespace
{
using dealii::Point;

constexpr double E = 50e9;
constexpr double nu = 0.2;

const Material<2> plane_strain = linear_elasticity<2>(isotropic_stiffness<2>(E, nu));

TEST(ElasticSample, BetweenSmoothPlatensIsHomogeneous)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 1);
  for (const unsigned int order : {1u, 2u})
    {
      Solid<2> solid(mesh, {.order = order}, plane_strain);
      auto load = platen_load<2>(Platens::smooth, -1e-4);
      load.pins = {{Point<2>(0.0, 0.0), 0}};
      const auto report = solid.solve(load);
      ASSERT_TRUE(report.converged) << report.failure;
      EXPECT_EQ(report.n_iterations, 1u);
      solid.accept();
      // Plane strain, free sideways: σ_yy = E/(1 - ν²) ε_yy, ε_xx = -ν/(1 - ν) ε_yy.
      const double stress = E / (1.0 - nu * nu) * -1e-3;
      for (const auto& answer : solid.answers())
        EXPECT_NEAR(answer.stress[1], stress, 1e-9 * std::abs(stress));
      EXPECT_NEAR(solid.reaction("top", 1), stress * 0.05, 1e-9 * std::abs(stress) * 0.05);
      EXPECT_NEAR(solid.reaction("bottom", 1), -stress * 0.05, 1e-9 * std::abs(stress) * 0.05);
      EXPECT_NEAR(solid.mean_displacement("right", 0), nu / (1.0 - nu) * 1e-3 * 0.05, 1e-9 * 0.05e-3);
    }
}
} // namespace
} // namespace feldspar::fem
