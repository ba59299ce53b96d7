#include "fem/materials/linear_elasticity.h"
#include "fem/solid/platens.h"
#include "fem/solid/solid.h"
#include "tests/fem_samples.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

namespace feldspar::fem
{
namespace
{
/// Message of a reader on a file, without its name; empty if the reader accepts it.
template <int dim>
std::string complaint(const std::string& content)
{
  const tests::TemporaryFolder folder;
  folder.write("mesh.msh", content);
  return tests::refusal<MeshError>([&] { read_gmsh<dim>(MPI_COMM_WORLD, folder.path() / "mesh.msh", 0); });
}

/// Two unit squares side by side; bottom, top and right have names. Format 2.
std::string two_squares(const std::string& nodes, const std::string& cells)
{
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
         "$PhysicalNames\n4\n1 1 \"bottom\"\n1 2 \"top\"\n1 7 \"right\"\n2 5 \"rock\"\n$EndPhysicalNames\n"
         "$Nodes\n" +
         nodes +
         "$EndNodes\n"
         "$Elements\n" +
         cells + "$EndElements\n";
}

const std::string nodes = "6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n";
const std::string boundary_lines = "1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 2 2 4 5\n4 1 2 2 2 5 6\n5 1 2 7 3 3 6\n";
const std::string squares = "7\n" + boundary_lines + "6 3 2 5 1 1 2 5 4\n7 3 2 5 1 2 3 6 5\n";
} // namespace

TEST(GmshMesh, BringsItsNamedBoundaries)
{
  const tests::TemporaryFolder folder;
  folder.write("mesh.msh", two_squares(nodes, squares));
  const auto mesh = read_gmsh<2>(MPI_COMM_WORLD, folder.path() / "mesh.msh", 1);
  EXPECT_EQ(mesh.triangulation->n_global_active_cells(), 8u);
  EXPECT_EQ(mesh.boundary("right"), 7u);
  // They are where they should be: a sample between them is compressed evenly.
  Solid<2> solid(mesh, {}, linear_elasticity<2>(isotropic_stiffness<2>(1e9, 0.0)));
  auto load = PlatenTest<2>{.platens = Platens::rough}.pressing(-1e-3);
  load.pressures.clear(); // this mesh has no boundary named left
  solve_and_accept(solid, load);
  EXPECT_NEAR(solid.reaction("top", 1), -1e9 * 1e-3 * 2.0, 1.0);
  EXPECT_NEAR(solid.mean_displacement("right", 1), -0.5e-3, 1e-12);
}

TEST(GmshMesh, SaysInOneLineWhatIsWrong)
{
  EXPECT_EQ(complaint<2>(two_squares(nodes, squares)), "");
  // Nodes of the first square in an order that crosses itself.
  const std::string crossed = "7\n" + boundary_lines + "6 3 2 5 1 1 2 4 5\n7 3 2 5 1 2 3 6 5\n";
  EXPECT_EQ(complaint<2>(two_squares(nodes, crossed)), "the cell at (0.5, 0.5) m is inverted or flat at a corner");
  // A corner pushed through the opposite one.
  const std::string pushed = "6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 0.1 0.1 0\n6 2 1 0\n";
  EXPECT_EQ(complaint<2>(two_squares(pushed, squares)), "the cell at (0.275, 0.275) m is inverted or flat at a corner");
  const std::string triangles =
    "9\n" + boundary_lines + "6 2 2 5 1 1 2 5\n7 2 2 5 1 1 5 4\n8 2 2 5 1 2 3 6\n9 2 2 5 1 2 6 5\n";
  EXPECT_EQ(complaint<2>(two_squares(nodes, triangles)),
            "has cells that are not quadrilaterals; in Gmsh recombine the mesh");
  EXPECT_EQ(complaint<2>("not a mesh\n"), "is not a mesh of Gmsh, which begins with $MeshFormat");
  EXPECT_EQ(complaint<3>(two_squares(nodes, squares)), "has no hexahedra");
  EXPECT_THROW(read_gmsh<2>(MPI_COMM_WORLD, "/nowhere/mesh.msh", 0), MeshError);
}

TEST(SampleMesh, SaysWhichBoundariesThereAre)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  EXPECT_EQ(tests::refusal<MeshError>([&] { mesh.boundary("upper"); }),
            "no boundary is named upper; the mesh has bottom, left, right, top");
  Solid<2> solid(mesh, {}, linear_elasticity<2>(isotropic_stiffness<2>(1e9, 0.0)));
  auto load = PlatenTest<2>().pressing(-1e-4);
  load.pressures = {{"side", 1e6}};
  EXPECT_THROW(solid.solve(load), MeshError);
}

// Round where it is refined, and no cell is narrower than a third of the diameter over those across.
TEST(CylinderSample, IsRound)
{
  constexpr double R = 0.025;
  constexpr double H = 0.1;
  for (const auto& [across, n_in_section] : {std::pair(3u, 5u), {4u, 12u}, {5u, 9u}, {8u, 48u}, {10u, 64u}})
    {
      const auto mesh = cylinder_sample(MPI_COMM_WORLD, R, H, {across, 2}, 1);
      EXPECT_EQ(mesh.triangulation->n_global_active_cells(), 8u * 2u * n_in_section) << across;
      double least = H;
      for (const auto& cell : mesh.triangulation->active_cell_iterators())
        {
          least = std::min(least, cell->minimum_vertex_distance());
          for (const auto& face : cell->face_iterators())
            if (face->at_boundary() && face->boundary_id() == mesh.boundary("side"))
              for (const unsigned int v : face->vertex_indices())
                {
                  EXPECT_NEAR(std::hypot(face->vertex(v)[0], face->vertex(v)[1]), R, 1e-12);
                }
        }
      EXPECT_GT(least, 0.3 * 2.0 * R / (2.0 * across)) << across;
    }
}

// The area of its ends as elements have it: a polygon of n_around sides, or arcs of parabolas, wrong by
// O(n_around^-2) and O(n_around^-4); and the volume beneath.
TEST(CylinderSample, HasTheVolumeOfACylinder)
{
  constexpr double R = 0.025;
  constexpr double H = 0.1;
  const double exact = std::numbers::pi * R * R;
  const auto mesh = cylinder_sample(MPI_COMM_WORLD, R, H, {4, 2}, 1); // 16 sides
  const auto material = linear_elasticity<3>(isotropic_stiffness<3>(1e9, 0.2));
  for (const unsigned int order : {1u, 2u})
    {
      const Solid<3> solid(mesh, {.kinematics = Kinematics::full, .order = order}, material);
      const double polygon = 16.0 / 2.0 * R * R * std::sin(2.0 * std::numbers::pi / 16.0);
      EXPECT_NEAR(solid.area("bottom"), order == 1 ? polygon : exact, (order == 1 ? 1e-9 : 1e-3) * exact);
      EXPECT_NEAR(std::accumulate(solid.volumes().begin(), solid.volumes().end(), 0.0), H * solid.area("top"),
                  1e-9 * H * exact);
    }
}

TEST(SampleMesh, RefusesAnEmptySample)
{
  EXPECT_THROW(plane_sample(MPI_COMM_WORLD, 0.0, 0.1, {2, 4}, 0), MeshError);
  EXPECT_THROW(plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 0}, 0), MeshError);
  EXPECT_THROW(cylinder_sample(MPI_COMM_WORLD, 0.025, 0.0, {4, 2}, 0), MeshError);
  EXPECT_THROW(cylinder_sample(MPI_COMM_WORLD, 0.025, 0.1, {2, 2}, 0), MeshError);
}

TEST(Solid, RefusesAnOrderItDoesNotHave)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  const auto material = linear_elasticity<2>(isotropic_stiffness<2>(1e9, 0.0));
  EXPECT_THROW(Solid<2>(mesh, {.order = 3}, material), std::invalid_argument);
  EXPECT_THROW(Solid<2>(mesh, {.order = 1, .reduced_quadrature = true}, material), std::invalid_argument);
}
} // namespace feldspar::fem
