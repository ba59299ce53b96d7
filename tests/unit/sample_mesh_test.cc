#include "fem/linear_elasticity.h"
#include "fem/platen_test.h"
#include "fem/solid.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace feldspar::fem
{
namespace
{
/// What a reader says of a file; empty if it takes it.
template <int dim>
std::string complaint(const std::string& content)
{
  const tests::TemporaryFolder folder;
  folder.write("mesh.msh", content);
  try
    {
      read_gmsh<dim>(MPI_COMM_WORLD, folder.path() / "mesh.msh", 0);
    }
  catch (const MeshError& error)
    {
      const std::string what = error.what();
      return what.substr(what.find("mesh.msh") + std::string("mesh.msh").size());
    }
  return "";
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
  ASSERT_TRUE(solid.solve(load).converged);
  solid.accept();
  EXPECT_NEAR(solid.reaction("top", 1), -1e9 * 1e-3 * 2.0, 1.0);
  EXPECT_NEAR(solid.mean_displacement("right", 1), -0.5e-3, 1e-12);
}

TEST(GmshMesh, SaysInOneLineWhatIsWrong)
{
  EXPECT_EQ(complaint<2>(two_squares(nodes, squares)), "");
  // Nodes of the first square in an order that crosses itself.
  const std::string crossed = "7\n" + boundary_lines + "6 3 2 5 1 1 2 4 5\n7 3 2 5 1 2 3 6 5\n";
  EXPECT_EQ(complaint<2>(two_squares(nodes, crossed)), ": the cell at (0.5, 0.5) m is inverted or flat at a corner");
  // A corner pushed through the opposite one.
  const std::string pushed = "6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 0.1 0.1 0\n6 2 1 0\n";
  EXPECT_EQ(complaint<2>(two_squares(pushed, squares)),
            ": the cell at (0.275, 0.275) m is inverted or flat at a corner");
  const std::string triangles =
    "9\n" + boundary_lines + "6 2 2 5 1 1 2 5\n7 2 2 5 1 1 5 4\n8 2 2 5 1 2 3 6\n9 2 2 5 1 2 6 5\n";
  EXPECT_EQ(complaint<2>(two_squares(nodes, triangles)),
            ": has cells that are not quadrilaterals; in Gmsh recombine the mesh");
  EXPECT_EQ(complaint<2>("not a mesh\n"),
            ": is not a Gmsh text mesh of quadrilaterals whose cells all have positive area");
  EXPECT_EQ(complaint<3>(two_squares(nodes, squares)),
            ": is not a Gmsh text mesh of hexahedra whose cells all have positive volume");
  EXPECT_THROW(read_gmsh<2>(MPI_COMM_WORLD, "/nowhere/mesh.msh", 0), MeshError);
}

TEST(SampleMesh, SaysWhichBoundariesThereAre)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  try
    {
      mesh.boundary("upper");
      FAIL();
    }
  catch (const MeshError& error)
    {
      EXPECT_STREQ(error.what(), "no boundary is named upper; the mesh has bottom, left, right, top");
    }
  Solid<2> solid(mesh, {}, linear_elasticity<2>(isotropic_stiffness<2>(1e9, 0.0)));
  auto load = PlatenTest<2>().pressing(-1e-4);
  load.pressures = {{"side", 1e6}};
  EXPECT_THROW(solid.solve(load), MeshError);
}

TEST(SampleMesh, RefusesAnEmptySample)
{
  EXPECT_THROW(plane_sample(MPI_COMM_WORLD, 0.0, 0.1, {2, 4}, 0), MeshError);
  EXPECT_THROW(plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 0}, 0), MeshError);
}

TEST(Solid, RefusesAnOrderItDoesNotHave)
{
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  const auto material = linear_elasticity<2>(isotropic_stiffness<2>(1e9, 0.0));
  EXPECT_THROW(Solid<2>(mesh, {.order = 3}, material), std::invalid_argument);
  EXPECT_THROW(Solid<2>(mesh, {.order = 1, .reduced_quadrature = true}, material), std::invalid_argument);
}
} // namespace feldspar::fem
