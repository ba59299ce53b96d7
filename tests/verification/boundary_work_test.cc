// The work that platens and pressures do on a solid, against what its points store and lose.

#include "fem/materials/linear_elasticity.h"
#include "fem/materials/mohr_coulomb.h"
#include "fem/solid/advance.h"
#include "fem/solid/platens.h"
#include "tests/brittle_point.h"
#include "tests/fem_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace feldspar::fem
{
namespace
{
constexpr double E = 50e9;
constexpr double nu = 0.2;
constexpr double height = 0.1;

template <int dim, int material_dim>
PointEnergies energies_of(const Solid<dim, material_dim>& solid)
{
  PointEnergies sum;
  for (std::size_t i = 0; i < solid.material_points().size(); ++i)
    {
      const PointEnergies densities = solid.material_points()[i].energies().value();
      sum.stored += solid.volumes()[i] * densities.stored;
      sum.slip += solid.volumes()[i] * densities.slip;
    }
  return sum;
}

template <int dim, int material_dim>
void go(Solid<dim, material_dim>& solid, const Load<dim>& load)
{
  const auto report = solve_and_accept(solid, load);
}

// Force times travel over two is stress times strain over two times the volume, on whatever steps it is reached.
TEST(BoundaryWork, OfAnElasticSampleIsHalfOfStressTimesStrainTimesVolume)
{
  const auto mesh = axisymmetric_sample(MPI_COMM_WORLD, 0.025, height, {2, 4}, 0);
  Solid<2, 3> solid(mesh, {.kinematics = Kinematics::axisymmetric},
                    linear_elasticity<3>(isotropic_stiffness<3>(E, nu)));
  const PlatenTest<2> test{.kinematics = Kinematics::axisymmetric};
  const double volume = std::numbers::pi * 0.025 * 0.025 * height;
  for (const double strain : {-2e-4, -1e-3, -3e-4})
    {
      go(solid, test.pressing(strain * height));
      const double expected = 0.5 * E * strain * strain * volume;
      EXPECT_NEAR(solid.boundary_work().total(), expected, 1e-9 * 0.5 * E * 1e-6 * volume) << strain;
      EXPECT_NEAR(energies_of(solid).stored, expected, 1e-9 * expected) << strain;
      EXPECT_EQ(solid.boundary_work().pressures, 0.0);
      EXPECT_NEAR(solid.boundary_work().redistribution, 0.0, 1e-9 * expected);
    }
}

// Pressure all round takes p²/(2K) per volume, K the bulk modulus; what platens and sides then do is stored too, whether the
// ends are smooth or rough, under the control of the platens or of the width.
TEST(BoundaryWork, OfAConfinedElasticSampleIsStored)
{
  constexpr double pressure = 20e6;
  const auto mesh = cylinder_sample(MPI_COMM_WORLD, 0.025, height, {3, 3}, 0);
  for (const Platens platens : {Platens::smooth, Platens::rough})
    {
      Solid<3> solid(mesh, {.kinematics = Kinematics::full}, linear_elasticity<3>(isotropic_stiffness<3>(E, nu)));
      const PlatenTest<3> test{.kinematics = Kinematics::full, .platens = platens, .confining_pressure = pressure};
      go(solid, test.seating());
      const double volume = solid.area("top") * height;
      if (platens == Platens::smooth)
        {
          const double bulk_modulus = E / (3.0 * (1.0 - 2.0 * nu));
          // The mesh has straight sides: its volume is that of its points.
          double of_points = 0.0;
          for (const double of_point : solid.volumes())
            of_points += of_point;
          const double expected = 0.5 * pressure * pressure / bulk_modulus * of_points;
          EXPECT_NEAR(solid.boundary_work().total(), expected, 1e-9 * expected);
        }
      EXPECT_NEAR(solid.boundary_work().reactions, 0.0, 1e-9 * solid.boundary_work().pressures); // nothing travels
      go(solid, test.pressing(-1e-3 * height));
      go(solid, test.widening(2.0 * 4e-4 * volume));
      EXPECT_GT(solid.boundary_work().reactions, 0.0);
      EXPECT_LT(solid.boundary_work().pressures, 0.0); // the sides widen against it
      const double stored = energies_of(solid).stored;
      EXPECT_NEAR(solid.boundary_work().total(), stored, 1e-8 * stored);
    }
}

// Up to the yield point half of q_u times the strain there, beyond it q_u times the strain, which is lost; exact where a
// step ends at the kink.
TEST(BoundaryWork, OfAPlasticSampleIsStoredAndLost)
{
  const MohrCoulombParameters rock{E, nu, 20e6, 0.7, 0.3};
  const double q_u = 2.0 * 20e6 * std::sqrt((1.0 + std::sin(0.7)) / (1.0 - std::sin(0.7)));
  const double yield_strain = q_u * (1.0 - nu * nu) / E;
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, height, {1, 2}, 0);
  Solid<2, 3> solid(mesh, {}, mohr_coulomb(rock));
  const double volume = 0.05 * height;
  for (const double multiple : {0.5, 1.0, 1.5, 3.0})
    go(solid, PlatenTest<2>().pressing(-multiple * yield_strain * height));
  const double stored = 0.5 * q_u * yield_strain * volume;
  const double lost = 2.0 * q_u * yield_strain * volume;
  EXPECT_NEAR(solid.boundary_work().total(), stored + lost, 1e-7 * lost);
  const PointEnergies energies = energies_of(solid);
  EXPECT_NEAR(energies.stored, stored, 1e-7 * lost);
  EXPECT_NEAR(energies.slip, lost, 1e-7 * lost);
}

// One row of eight breaks and keeps a tenth of its stiffness while the platens stand. They have done their work before;
// of what was stored, ½Eε²V, the break takes 9/10 of the eighth in the row, and equilibrium keeps 8/17. The missing
// part was set free on the way: with it the balance closes, without it not.
TEST(BoundaryWork, LeavesOutWhatIsSetFreeBetweenElements)
{
  constexpr double limit = 1e-4;
  const Material<2> brittle{[](const PointPlace& place) {
                              const bool weak = place.position[1] > 0.0375 && place.position[1] < 0.05;
                              return std::make_unique<BrittlePoint>(isotropic_stiffness<2>(E, 0.0),
                                                                    weak ? limit : 10.0 * limit, 0.1);
                            },
                            {"broken"}};
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, height, {4, 8}, 0);
  Solid<2> solid(mesh, {.newton_tolerance = 1e-12}, brittle);
  go(solid, PlatenTest<2>().pressing(0.6 * limit * height));
  const StoredSolid half_way = solid.stored();
  const double strain = 1.01 * limit;
  const double full = 0.5 * E * strain * strain * 0.05 * height;
  const auto check = [&](const BoundaryWork& work) {
    EXPECT_NEAR(work.total(), full, 1e-9 * full);
    EXPECT_NEAR(work.redistribution, full * (1.0 - 0.9 / 8.0 - 8.0 / 17.0), 1e-9 * full);
  };
  go(solid, PlatenTest<2>().pressing(strain * height));
  check(solid.boundary_work());
  // A solid that goes on from the stored state has the same.
  solid.restore(half_way);
  go(solid, PlatenTest<2>().pressing(strain * height));
  check(solid.boundary_work());
  // A step that is given up does no work.
  const double before = solid.boundary_work().total();
  solid.solve(PlatenTest<2>().pressing(2.0 * strain * height));
  solid.reject();
  EXPECT_EQ(solid.boundary_work().total(), before);
}
} // namespace
} // namespace feldspar::fem
