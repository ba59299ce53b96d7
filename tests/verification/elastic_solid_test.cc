// The solid in linear elasticity, against closed forms.

#include "fem/materials/linear_elasticity.h"
#include "fem/solid/platens.h"
#include "fem/solid/solid.h"
#include "tests/fem_samples.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <gtest/gtest.h>

#include <cmath>

namespace feldspar::fem
{
namespace
{
using dealii::Point;
using dealii::Tensor;

constexpr double E = 50e9;
constexpr double nu = 0.2;
constexpr double G = E / (2.0 * (1.0 + nu));

const Material<2> plane_strain = linear_elasticity<2>(isotropic_stiffness<2>(E, nu));
const Material<3> in_space = linear_elasticity<3>(isotropic_stiffness<3>(E, nu));

template <int dim, int material_dim>
void solve(Solid<dim, material_dim>& solid, const Load<dim>& load)
{
  EXPECT_EQ(solve_and_accept(solid, load).n_iterations, 1u);
}

// ---- patch test: a linear displacement on the boundary of any mesh strains every point alike

template <int dim, int material_dim>
void expect_patch(const SolidParameters& parameters, const Material<material_dim>& material)
{
  SampleMesh<dim> mesh{std::make_unique<dealii::parallel::distributed::Triangulation<dim>>(MPI_COMM_WORLD),
                       {{"all", 0}}};
  dealii::GridGenerator::hyper_cube(*mesh.triangulation);
  mesh.triangulation->refine_global(2);
  dealii::GridTools::distort_random(0.3, *mesh.triangulation, true, 5);
  Tensor<2, dim> gradient;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      gradient[i][j] = 1e-4 * (1.0 + 2.0 * i - 0.7 * j * j);
  Load<dim> load;
  prescribe<dim>(load, "all", [&](const Point<dim>& x) { return Tensor<1, dim>(gradient * x); });
  Solid<dim, material_dim> solid(mesh, parameters, material);
  solve(solid, load);
  StrainVector<material_dim> expected = StrainVector<material_dim>::Zero();
  for (unsigned int c = 0; c < dim; ++c)
    expected += strain_of<dim, material_dim>(parameters.kinematics, c, 0.0, gradient[c], 1.0);
  for (const auto& strain : solid.strains())
    EXPECT_LT((strain - expected).norm(), 1e-9 * expected.norm());
}

TEST(PatchTest, HoldsOnDistortedMeshes)
{
  for (const SolidParameters& parameters : {SolidParameters{.order = 1}, SolidParameters{.order = 2},
                                            SolidParameters{.order = 2, .reduced_quadrature = true}})
    {
      expect_patch<2, 2>(parameters, plane_strain);
      expect_patch<2, 3>(parameters, in_space);
      auto full = parameters;
      full.kinematics = Kinematics::full;
      expect_patch<3, 3>(full, in_space);
    }
}

// ---- samples between platens

/// σ_yy of a plane-strain sample free sideways is this times ε_yy.
constexpr double plane_modulus = E / (1.0 - nu * nu);

TEST(ElasticSample, BetweenSmoothPlatensIsHomogeneous)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 1);
  for (const unsigned int order : {1u, 2u})
    {
      Solid<2> solid(mesh, {.order = order}, plane_strain);
      solve(solid, PlatenTest<2>().pressing(-1e-4));
      const double stress = plane_modulus * -1e-3;
      for (const auto& response : solid.responses())
        {
          EXPECT_NEAR(response.stress[0], 0.0, 1e-9 * std::abs(stress));
          EXPECT_NEAR(response.stress[1], stress, 1e-9 * std::abs(stress));
          EXPECT_NEAR(response.stress[2], 0.0, 1e-9 * std::abs(stress));
        }
      EXPECT_NEAR(solid.reaction("top", 1), stress * 0.05, 1e-9 * std::abs(stress) * 0.05);
      EXPECT_NEAR(solid.reaction("bottom", 1), -stress * 0.05, 1e-9 * std::abs(stress) * 0.05);
      EXPECT_NEAR(solid.mean_displacement("right", 0), nu / (1.0 - nu) * 1e-3 * 0.05, 1e-9 * 0.05e-3);
    }
}

TEST(ElasticSample, GivesTheSameInThePlaneWithAMaterialOfTheSpace)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 1);
  const auto load = PlatenTest<2>{.platens = Platens::rough}.pressing(-1e-4);
  Solid<2, 2> plane(mesh, {}, plane_strain);
  Solid<2, 3> space(mesh, {}, in_space);
  solve(plane, load);
  solve(space, load);
  for (std::size_t i = 0; i < plane.responses().size(); ++i)
    {
      const auto& expected = plane.responses()[i].stress;
      const auto& found = space.responses()[i].stress; // x, out of the plane, y
      const double scale = 1e-9 * expected.norm();
      EXPECT_NEAR(found[0], expected[0], scale);
      EXPECT_NEAR(found[2], expected[1], scale);
      EXPECT_NEAR(found[4], expected[2], scale);
      EXPECT_NEAR(found[1], nu * (expected[0] + expected[1]), scale);
    }
}

TEST(ElasticSample, IsStifferBetweenRoughPlatensUnlessNothingWidens)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {4, 8}, 2);
  const auto force = [&](const double poissons_ratio, const Platens platens, const unsigned int order) {
    Solid<2> solid(mesh, {.order = order}, linear_elasticity<2>(isotropic_stiffness<2>(E, poissons_ratio)));
    solve(solid, PlatenTest<2>{.platens = platens}.pressing(-1e-4));
    return solid.reaction("top", 1);
  };
  const double smooth = force(nu, Platens::smooth, 1);
  const double rough = force(nu, Platens::rough, 1);
  // Bounds: the same displacement with the sides free and with the sides held everywhere.
  const double held = E * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) * -1e-3 * 0.05;
  EXPECT_LT(rough, 1.005 * smooth);
  EXPECT_GT(rough, held);
  // Order 1 and 2 see the same sample; the corners are singular, so some 0.1 % apart.
  EXPECT_NEAR(rough / force(nu, Platens::rough, 2), 1.0, 2e-3);
  EXPECT_NEAR(force(0.0, Platens::rough, 1) / force(0.0, Platens::smooth, 1), 1.0, 1e-9);
}

TEST(ElasticSample, IsSeatedUnderPressureThenLoadedByPlatens)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 1);
  Solid<2> solid(mesh, {}, plane_strain);
  const double p = 20e6;
  const PlatenTest<2> test{.confining_pressure = p};
  solve(solid, test.seating());
  for (const auto& response : solid.responses())
    EXPECT_LT((response.stress - StressVector<2>(-p, -p, 0.0)).norm(), 1e-9 * p);
  EXPECT_NEAR(solid.reaction("bottom", 1), p * 0.05, 1e-9 * p * 0.05);

  const double seated = solid.mean_displacement("top", 1);
  solve(solid, test.pressing(seated - 1e-4));
  const double axial = -p + plane_modulus * -1e-3;
  for (const auto& response : solid.responses())
    EXPECT_LT((response.stress - StressVector<2>(-p, axial, 0.0)).norm(), 1e-9 * std::abs(axial));
  // The pressure of the plate has gone over into the reaction.
  EXPECT_NEAR(solid.reaction("top", 1), axial * 0.05, 1e-9 * std::abs(axial) * 0.05);
}

TEST(ElasticSample, HasItsPlaneUnderAFreePlateWhereItsStiffnessVaries)
{
  // A stiff left half under a plate that stays level takes its share of the force by stiffness; ν = 0 keeps the halves
  // from pushing each other.
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.04, 0.1, {4, 4}, 0);
  const StiffnessMatrix<2> soft = isotropic_stiffness<2>(E, 0.0);
  const Material<2> halves{[&](const PointPlace& place) {
                             const double factor = place.position[0] < 0.02 ? 3.0 : 1.0;
                             return std::make_unique<LinearElasticPoint<2>>(factor * soft);
                           },
                           {}};
  Solid<2> solid(mesh, {}, halves);
  Load<2> load = PlatenTest<2>().seating();
  load.pressures = {{"top", 10e6}};
  solve(solid, load);
  // Force p W = (3 E + E) W/2 ε.
  for (const auto& strain : solid.strains())
    EXPECT_NEAR(strain[1], -10e6 / (2.0 * E), 1e-9 * 10e6 / E);
}

TEST(ElasticSample, IsTheSameByEveryLinearSolver)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {4, 8}, 2);
  const auto load = PlatenTest<2>{.platens = Platens::rough}.pressing(-1e-4);
  const auto force = [&](const LinearSolver linear_solver) {
    Solid<2> solid(mesh, {.order = 2, .linear_solver = linear_solver}, plane_strain);
    solve(solid, load);
    return solid.reaction("top", 1);
  };
  const double direct = force(LinearSolver::mumps);
  EXPECT_NEAR(force(LinearSolver::conjugate_gradients), direct, 1e-8 * std::abs(direct));
  EXPECT_NEAR(force(LinearSolver::gmres), direct, 1e-8 * std::abs(direct));
}

TEST(ElasticCylinder, BetweenSmoothPlatensHasYoungsModulus)
{
  const auto mesh = axisymmetric_sample(MPI_COMM_WORLD, 0.025, 0.1, {2, 4}, 1);
  Solid<2, 3> solid(mesh, {.kinematics = Kinematics::axisymmetric}, in_space);
  solve(solid, PlatenTest<2>{.kinematics = Kinematics::axisymmetric}.pressing(-1e-4));
  const double area = std::numbers::pi * 0.025 * 0.025;
  EXPECT_NEAR(solid.reaction("top", 1), -E * 1e-3 * area, 1e-9 * E * 1e-3 * area);
  EXPECT_NEAR(solid.mean_displacement("side", 0), nu * 1e-3 * 0.025, 1e-9 * 0.025e-3);
  EXPECT_NEAR(solid.mean_strain()[1], nu * 1e-3, 1e-12); // around the axis
}

TEST(ElasticCylinder, InSpaceIsTheSameBetweenSmoothPlatens)
{
  const double p = 20e6;
  for (const unsigned int across : {3u, 4u}) // with and without a node on the axis
    for (const unsigned int order : {1u, 2u})
      {
        const auto mesh = cylinder_sample(MPI_COMM_WORLD, 0.025, 0.1, {across, 3}, 0);
        Solid<3> solid(mesh, {.kinematics = Kinematics::full, .order = order}, in_space);
        const PlatenTest<3> test{.kinematics = Kinematics::full, .confining_pressure = p};
        solve(solid, test.seating());
        for (const auto& response : solid.responses())
          EXPECT_LT((response.stress - (StressVector<3>() << -p, -p, -p, 0.0, 0.0, 0.0).finished()).norm(), 1e-8 * p);
        const double seated = solid.mean_displacement("top", 2);
        const double seated_side = solid.swept_volume("side");
        solve(solid, test.pressing(seated - 1e-4));
        const double axial = -p - E * 1e-3;
        for (const auto& response : solid.responses())
          EXPECT_LT((response.stress - (StressVector<3>() << -p, -p, axial, 0.0, 0.0, 0.0).finished()).norm(),
                    1e-8 * std::abs(axial));
        EXPECT_NEAR(solid.reaction("top", 2), axial * solid.area("top"), 1e-8 * std::abs(axial) * solid.area("top"));
        // Both ways across, whatever polygon the section is.
        const double widening = 2.0 * nu * 1e-3 * solid.area("top") * 0.1;
        EXPECT_NEAR(solid.swept_volume("side") - seated_side, widening, 1e-8 * widening);
      }
}

// Widening is ν times the shortening, so that the platens have to go so far; and back.
TEST(ElasticCylinder, ItsPlatensFollowItsWidth)
{
  const double p = 20e6;
  const auto mesh = axisymmetric_sample(MPI_COMM_WORLD, 0.025, 0.1, {2, 4}, 1);
  Solid<2, 3> solid(mesh, {.kinematics = Kinematics::axisymmetric}, in_space);
  const PlatenTest<2> test{.kinematics = Kinematics::axisymmetric, .confining_pressure = p};
  solve(solid, test.seating());
  const double seated = solid.mean_displacement("top", 1);
  const double seated_side = solid.swept_volume("side");
  for (const double strain : {1e-3, 0.4e-3})
    {
      const double widening = 2.0 * nu * strain * solid.area("top") * 0.1;
      solve(solid, test.widening(seated_side + widening));
      EXPECT_NEAR(solid.swept_volume("side") - seated_side, widening, 2e-6 * 2.0 * nu * 1e-3 * solid.area("top") * 0.1);
      EXPECT_NEAR(solid.mean_displacement("top", 1) - seated, -strain * 0.1, 2e-6 * 1e-3 * 0.1);
      EXPECT_NEAR(solid.reaction("top", 1), (-p - E * strain) * solid.area("top"),
                  2e-6 * (p + E * 1e-3) * solid.area("top"));
    }
}

// ---- convergence

/// Expects the errors of elements of order p, from one number of refinements to another, to fall by 2^(p + 1) each, within 5 %
/// of the order.
template <typename Error>
void expect_convergence(const unsigned int p, const unsigned int coarsest, const unsigned int finest,
                        const Error& error)
{
  double before = error(p, coarsest);
  for (unsigned int n_refinements = coarsest + 1; n_refinements <= finest; ++n_refinements)
    {
      const double now = error(p, n_refinements);
      EXPECT_NEAR(std::log2(before / now), p + 1.0, 0.05 * (p + 1.0)) << p << ", refinement " << n_refinements;
      before = now;
    }
}

/// Lamé's ring under inner and outer pressure, in plane strain: σ_r = A - B/r², σ_θ = A + B/r².
struct LameRing
{
  double a = 0.02;
  double b = 0.06;
  double inner_pressure = 30e6;
  double outer_pressure = 5e6;
  double A = (inner_pressure * a * a - outer_pressure * b * b) / (b * b - a * a);
  double B = (inner_pressure - outer_pressure) * a * a * b * b / (b * b - a * a);

  /// 2G u_r = (1 - 2ν) A r + B/r
  double radial_displacement(const double r) const { return ((1.0 - 2.0 * nu) * A * r + B / r) / (2.0 * G); }
};

TEST(Lame, RingInThePlane)
{
  const LameRing ring;
  const auto error = [&](const unsigned int order, const unsigned int n_refinements) {
    const auto mesh = quarter_ring(MPI_COMM_WORLD, ring.a, ring.b, n_refinements);
    Solid<2> solid(mesh, {.order = order}, plane_strain);
    Load<2> load;
    load.displacements = {{"x=0", 0, constant<2>(0.0)}, {"y=0", 1, constant<2>(0.0)}};
    load.pressures = {{"inner", ring.inner_pressure}, {"outer", ring.outer_pressure}};
    solve(solid, load);
    const double found = displacement_error<2, 2>(
      solid, [&](const Point<2>& x) { return ring.radial_displacement(x.norm()) / x.norm() * x; });
    if (n_refinements == 6)
      for (std::size_t i = 0; i < solid.places().size(); ++i)
        {
          const double x = solid.places()[i].position[0];
          const double y = solid.places()[i].position[1];
          const double r_squared = x * x + y * y;
          const double c = x / std::sqrt(r_squared);
          const double s = y / std::sqrt(r_squared);
          const auto& stress = solid.responses()[i].stress;
          const double hoop = s * s * stress[0] + c * c * stress[1] - 2.0 * s * c * stress[2];
          // Issue: within 1 %, of the largest hoop stress. Stress of order 1 converges as h, at points as h².
          EXPECT_NEAR(hoop, ring.A + ring.B / r_squared, 0.01 * (ring.A + ring.B / (ring.a * ring.a)));
        }
    return found;
  };
  for (const unsigned int order : {1u, 2u})
    expect_convergence(order, 3, 6, error);
}

TEST(Lame, RingInRZ)
{
  const LameRing ring;
  const auto error = [&](const unsigned int order, const unsigned int n_refinements) {
    SampleMesh<2> mesh{std::make_unique<dealii::parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD),
                       {{"inner", 0}, {"outer", 1}, {"bottom", 2}, {"top", 3}}};
    dealii::GridGenerator::hyper_rectangle(*mesh.triangulation, Point<2>(ring.a, 0.0), Point<2>(ring.b, 0.03), true);
    mesh.triangulation->refine_global(n_refinements);
    Solid<2, 3> solid(mesh, {.kinematics = Kinematics::axisymmetric, .order = order}, in_space);
    Load<2> load;
    load.displacements = {{"bottom", 1, constant<2>(0.0)}, {"top", 1, constant<2>(0.0)}};
    load.pressures = {{"inner", ring.inner_pressure}, {"outer", ring.outer_pressure}};
    solve(solid, load);
    const double found =
      displacement_error<2, 3>(solid, [&](const Point<2>& x) { return Point<2>(ring.radial_displacement(x[0]), 0.0); });
    // The force on the ends: σ_z = ν (σ_r + σ_θ) = 2νA everywhere.
    const double area = std::numbers::pi * (ring.b * ring.b - ring.a * ring.a);
    if (n_refinements == 6)
      {
        EXPECT_NEAR(solid.reaction("top", 1), 2.0 * nu * ring.A * area, 0.01 * std::abs(2.0 * nu * ring.A * area));
      }
    return found;
  };
  for (const unsigned int order : {1u, 2u})
    expect_convergence(order, 3, 6, error);
}

TEST(Lame, RingInSpace)
{
  const LameRing ring;
  const auto error = [&](const unsigned int order, const unsigned int n_refinements) {
    // A quarter of the ring, two cells along the axis and no more: nothing varies along it.
    dealii::Triangulation<2> section;
    dealii::GridGenerator::quarter_hyper_shell(section, Point<2>(), ring.a, ring.b, 0, true);
    section.refine_global(n_refinements);
    dealii::Triangulation<2> flat;
    dealii::GridGenerator::flatten_triangulation(section, flat);
    SampleMesh<3> mesh{std::make_unique<dealii::parallel::distributed::Triangulation<3>>(MPI_COMM_WORLD),
                       {{"inner", 0}, {"outer", 1}, {"x=0", 2}, {"y=0", 3}, {"bottom", 4}, {"top", 5}}};
    dealii::GridGenerator::extrude_triangulation(flat, 3, 0.01, *mesh.triangulation);
    for (const auto& cell : mesh.triangulation->active_cell_iterators())
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() <= mesh.boundary("outer"))
          face->set_all_manifold_ids(1);
    mesh.triangulation->set_manifold(1, dealii::CylindricalManifold<3>(2));
    Solid<3> solid(mesh, {.kinematics = Kinematics::full, .order = order}, in_space);
    Load<3> load;
    load.displacements = {{"x=0", 0, constant<3>(0.0)},
                          {"y=0", 1, constant<3>(0.0)},
                          {"bottom", 2, constant<3>(0.0)},
                          {"top", 2, constant<3>(0.0)}};
    load.pressures = {{"inner", ring.inner_pressure}, {"outer", ring.outer_pressure}};
    solve(solid, load);
    return displacement_error<3, 3>(solid, [&](const Point<3>& x) {
      const double r = std::hypot(x[0], x[1]);
      return ring.radial_displacement(r) / r * Tensor<1, 3>({x[0], x[1], 0.0});
    });
  };
  expect_convergence(1, 3, 5, error); // with coarser ones the orders are not yet theirs
  expect_convergence(2, 2, 4, error);
}

/// Kirsch's hole of radius a in a plate pulled by S along x, in plane strain.
struct KirschHole
{
  double a = 0.01;
  double S = 10e6;

  Tensor<1, 2> displacement(const Point<2>& x) const
  {
    const double r = x.norm() / a;
    const double theta = std::atan2(x[1], x[0]);
    const double kappa = 3.0 - 4.0 * nu;
    const double c = std::cos(2.0 * theta);
    const double s = std::sin(2.0 * theta);
    const double u_r =
      S * a / (8.0 * G) * (r * (kappa - 1.0 + 2.0 * c) + 2.0 / r * (1.0 + (kappa + 1.0) * c) - 2.0 / (r * r * r) * c);
    const double u_theta = -S * a / (8.0 * G) * s * (2.0 * r + 2.0 / r * (kappa - 1.0) + 2.0 / (r * r * r));
    Tensor<1, 2> u;
    u[0] = u_r * std::cos(theta) - u_theta * std::sin(theta);
    u[1] = u_r * std::sin(theta) + u_theta * std::cos(theta);
    return u;
  }

  double hoop_stress(const double x, const double y) const
  {
    const double q = a * a / (x * x + y * y);
    const double c = (x * x - y * y) / (x * x + y * y);
    return 0.5 * S * (1.0 + q) - 0.5 * S * (1.0 + 3.0 * q * q) * c;
  }
};

/// From the gradients of the displacement on the wall of the hole.
double largest_hoop_stress_on_wall(const Solid<2>& solid)
{
  dealii::FEFaceValues<2> values(solid.geometry(), solid.dofs().get_fe(), dealii::QGauss<1>(3),
                                 dealii::update_gradients | dealii::update_normal_vectors);
  std::vector<Tensor<2, 2>> gradients(3);
  double largest = 0.0;
  for (const auto& cell : solid.dofs().active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (cell->is_locally_owned() && face->at_boundary() && face->boundary_id() == 0)
        {
          values.reinit(cell, face);
          values[dealii::FEValuesExtractors::Vector(0)].get_function_gradients(solid.displacement(), gradients);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const Tensor<1, 2> along = dealii::cross_product_2d(values.normal_vector(q));
              const Tensor<2, 2> stress = 2.0 * G * 0.5 * (gradients[q] + transpose(gradients[q])) +
                                          2.0 * G * nu / (1.0 - 2.0 * nu) * trace(gradients[q]) *
                                            Tensor<2, 2>(dealii::unit_symmetric_tensor<2>());
              largest = std::max(largest, along * (stress * along));
            }
        }
  return dealii::Utilities::MPI::max(largest, solid.communicator());
}

TEST(Kirsch, HoleInAPlate)
{
  const KirschHole hole;
  const auto error = [&](const unsigned int order, const unsigned int n_refinements) {
    const auto mesh = quarter_ring(MPI_COMM_WORLD, hole.a, 4.0 * hole.a, n_refinements);
    Solid<2> solid(mesh, {.order = order}, plane_strain);
    Load<2> load;
    load.displacements = {{"x=0", 0, constant<2>(0.0)}, {"y=0", 1, constant<2>(0.0)}};
    // The displacement of the infinite plate on a circle about the hole.
    prescribe<2>(load, "outer", [&](const Point<2>& x) { return hole.displacement(x); });
    solve(solid, load);
    const double found = displacement_error<2, 2>(solid, [&](const Point<2>& x) { return hole.displacement(x); });
    if (n_refinements == 6)
      {
        for (std::size_t i = 0; order == 2 && i < solid.places().size(); ++i)
          {
            const double x = solid.places()[i].position[0];
            const double y = solid.places()[i].position[1];
            const auto& stress = solid.responses()[i].stress;
            const double hoop = (y * y * stress[0] + x * x * stress[1] - 2.0 * x * y * stress[2]) / (x * x + y * y);
            EXPECT_NEAR(hoop, hole.hoop_stress(x, y), 0.01 * 3.0 * hole.S);
          }
        EXPECT_NEAR(largest_hoop_stress_on_wall(solid), 3.0 * hole.S, 0.01 * 3.0 * hole.S);
      }
    return found;
  };
  for (const unsigned int order : {1u, 2u})
    expect_convergence(order, 4, 6, error);
}
} // namespace
} // namespace feldspar::fem
