#include "fem/mesh/gmsh_check.h"

#include "base/input_error.h"
#include "fem/mesh/sample_mesh.h"
#include "tests/mutations.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

/// Meshes that deal.II's reader must not see.
namespace feldspar::fem
{
namespace
{
/// Two unit squares side by side, in each of Gmsh's formats; line 7 is the right side.
const std::string squares_2_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "bottom"
1 7 "right"
2 5 "rock"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
5
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 7 3 3 6
4 3 2 5 1 1 2 5 4
5 3 2 5 1 2 3 6 5
$EndElements
)";

const std::string squares_4_0 = R"($MeshFormat
4 0 8
$EndMeshFormat
$PhysicalNames
1
1 7 "right"
$EndPhysicalNames
$Entities
0 1 1 0
3 2 0 0 2 1 0 1 7 0
1 0 0 0 2 1 0 0 1 3
$EndEntities
$Nodes
2 6
3 1 0 2
3 2 0 0
6 2 1 0
1 2 0 4
1 0 0 0
2 1 0 0
4 0 1 0
5 1 1 0
$EndNodes
$Elements
2 3
3 1 1 1
1 3 6
1 2 3 2
2 1 2 5 4
3 2 3 6 5
$EndElements
)";

const std::string squares_4_1 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
1 7 "right"
$EndPhysicalNames
$Entities
1 1 1 0
1 2 0 0 0
3 2 0 0 2 1 0 1 7 2 1 -2
1 0 0 0 2 1 0 0 1 3
$EndEntities
$Nodes
2 6 1 6
1 3 0 2
3
6
2 0 0
2 1 0
2 1 0 4
1
2
4
5
0 0 0
1 0 0
0 1 0
1 1 0
$EndNodes
$Elements
2 3 1 3
1 3 1 1
1 3 6
2 1 3 2
2 1 2 5 4
3 2 3 6 5
$EndElements
)";

/// A unit cube whose lower face has a name.
const std::string cube = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 3 "bottom"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
$EndNodes
$Elements
2
1 3 2 3 1 4 3 2 1
2 5 2 0 1 1 2 3 4 5 6 7 8
$EndElements
)";

/// What is said of a mesh; empty if it is taken.
std::string complaint(const std::string& text, const int dimension = 2)
{
  try
    {
      check_gmsh(text, dimension);
    }
  catch (const InputError& error)
    {
      return error.what();
    }
  return "";
}

std::string with(std::string text, const std::string& old, const std::string& other)
{
  return text.replace(text.find(old), old.size(), other);
}
} // namespace

TEST(GmshCheck, TakesEveryFormatThatTheReaderKnows)
{
  for (const std::string& squares : {squares_2_2, squares_4_0, squares_4_1})
    {
      EXPECT_EQ(complaint(squares), "");
      const tests::TemporaryFolder folder;
      const auto mesh = read_gmsh<2>(MPI_COMM_WORLD, folder.write("mesh.msh", squares), 0);
      EXPECT_EQ(mesh.triangulation->n_global_active_cells(), 2u);
      EXPECT_EQ(mesh.boundary("right"), 7u);
      unsigned int n_right = 0;
      for (const auto& cell : mesh.triangulation->active_cell_iterators())
        for (const auto& face : cell->face_iterators())
          n_right += face->at_boundary() && face->boundary_id() == 7u;
      EXPECT_EQ(n_right, 1u);
    }
  EXPECT_EQ(complaint(cube, 3), "");
}

TEST(GmshCheck, NamesLineAndReason)
{
  const auto& mesh = squares_2_2;
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "1.0 0")), "line 2: format 1.0 of Gmsh; 2.2, 4.0 and 4.1 can be read");
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "2.2 1")),
            "line 2: a binary file; write it as text: gmsh MESH.msh -save -format msh41 -o TEXT.msh");
  EXPECT_EQ(complaint(with(mesh, "$Nodes\n6", "$Nodes\n100000000")).substr(0, 8), "line 11:");
  EXPECT_EQ(complaint(with(mesh, "$Nodes\n6", "$Nodes\n90")).substr(0, 26), "line 11: 90 are announced,");
  EXPECT_EQ(complaint(with(mesh, "$Nodes\n6", "$Nodes\n-1")).substr(0, 23), "line 11: an integer fro");
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "2 nan 0 0")),
            "line 13: a coordinate in metres is expected instead of nan");
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "2 1e300 0 0")),
            "line 13: a coordinate in metres is expected instead of 1e300");
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "1 1 0 0")), "line 13: there is another node 1");
  EXPECT_EQ(complaint(with(mesh, "1 2 5 4", "1 2 9 4")), "line 24: there is no node 9");
  EXPECT_EQ(complaint(with(mesh, "1 2 5 4", "1 2 2 4")), "line 24: an element has one node twice");
  EXPECT_EQ(complaint(with(mesh, "4 3 2 5", "4 10 2 5")),
            "line 24: elements of Gmsh's type 10; points, lines and quadrilaterals can be read");
  EXPECT_EQ(complaint(with(mesh, "7 3 3 6", "7 3 3 5")), "the element on the nodes 3 and 5 is not the side of a cell");
  EXPECT_EQ(complaint(with(mesh, "$EndElements", "")), "line 27: the file ends here");
  EXPECT_EQ(
    complaint(with(with(mesh, "$Elements\n5", "$Elements\n6"), "$EndElements", "6 3 2 5 1 2 3 6 5\n$EndElements")),
    "more than two cells meet at the nodes 2 and 5, or they do not fit together");
  EXPECT_EQ(complaint(with(squares_4_1, "2 6 1 6", "2 7 1 6")), "line 29: 7 were announced, 6 are there");
  EXPECT_EQ(complaint(with(cube, "4 3 2 1", "4 2 3 1"), 3),
            "the element on the nodes 1 and 3 is not the side of a cell");
}

// The reader gets what the check lets pass: it may refuse it, but neither crash nor hang.
TEST(GmshCheck, LetsNoDamagedMeshReachTheReaderThatItCannotBear)
{
  const tests::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const int dimension) {
    const auto file = folder.write("mesh.msh", text);
    try
      {
        dimension == 2 ? void(read_gmsh<2>(MPI_COMM_WORLD, file, 0)) : void(read_gmsh<3>(MPI_COMM_WORLD, file, 0));
      }
    catch (const MeshError& error)
      {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return true;
      }
    return false;
  };
  constexpr std::uint64_t n_mutations = 300;
  std::uint64_t n_refused = 0;
  for (const auto& [text, dimension] :
       {std::pair(squares_2_2, 2), std::pair(squares_4_0, 2), std::pair(squares_4_1, 2), std::pair(cube, 3)})
    for (std::uint64_t seed = 0; seed < n_mutations; ++seed)
      n_refused += refused(tests::Mutations(seed).of(text), dimension);
  EXPECT_GT(n_refused, 2 * n_mutations);
}
} // namespace feldspar::fem
