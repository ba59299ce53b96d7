#include "fem/mesh/gmsh_mesh.h"

#include "fem/mesh/sample_mesh.h"
#include "tests/mutations.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

/// Meshes read by Gmsh's library, and damaged ones that deal.II must not see.
namespace feldspar::fem
{
namespace
{
using tests::has;

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

/// The problem reported for a mesh; empty if it is accepted.
std::string complaint(const std::string& content, const int dimension = 2)
{
  const tests::TemporaryFolder folder;
  return tests::refusal([&] { read_gmsh_mesh(folder.write("mesh.msh", content), dimension); });
}

std::string with(std::string text, const std::string& old, const std::string& other)
{
  return text.replace(text.find(old), old.size(), other);
}

/// A mesh that Gmsh 4.8.4 wrote: two squares in a rectangle of 2 m x 1 m with the groups bottom, right and rock, as text
/// and as bytes of the same numbers; or eight cubes in one of 1 m with the groups bottom and rock.
std::string written_by_gmsh(const std::string& name)
{
  std::ifstream file(std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus/mesh" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <typename Number>
std::string with_number(std::string bytes, const std::size_t place, const Number value)
{
  const auto of_number = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  std::copy(of_number.begin(), of_number.end(), bytes.begin() + std::ptrdiff_t(place));
  return bytes;
}
} // namespace

TEST(GmshMesh, TakesEveryFormatThatTheReaderKnows)
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

// The surface of a layer within the mesh, here between both squares, is no part of the boundary.
TEST(GmshMesh, LeavesOutLinesBetweenTwoCells)
{
  const tests::TemporaryFolder folder;
  const auto file = folder.write(
    "mesh.msh", with(with(squares_2_2, "7 3 3 6\n", "7 3 3 6\n6 1 2 9 4 2 5\n"), "$Elements\n5", "$Elements\n6"));
  EXPECT_EQ(read_gmsh_mesh(file, 2).sides.size(), 3u);
  EXPECT_EQ(read_gmsh<2>(MPI_COMM_WORLD, file, 0).triangulation->n_global_active_cells(), 2u);
}

// Group 1 has two lines below, group 7 one on the right; group 9 has no name.
TEST(GmshMesh, GivesGroupsTheNamesThatTheUserMaps)
{
  const tests::TemporaryFolder folder;
  const auto length_of = [&](const std::string& name, const BoundaryNames& names) {
    const auto file = folder.write(
      "mesh.msh", with(with(squares_2_2, "7 3 3 6\n", "7 3 3 6\n6 1 2 9 4 5 6\n"), "$Elements\n5", "$Elements\n6"));
    const auto mesh = read_gmsh<2>(MPI_COMM_WORLD, file, 0, 1.0, names);
    double length = 0.0;
    for (const auto& cell : mesh.triangulation->active_cell_iterators())
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == mesh.boundary(name))
          length += face->measure();
    return length;
  };
  EXPECT_EQ(length_of("top", {{"top", {"9"}}}), 1.0);
  EXPECT_EQ(length_of("side", {{"side", {"bottom", "right", "9"}}}), 4.0);
  EXPECT_EQ(length_of("bottom", {{"bottom", {"right"}}, {"right", {"bottom"}}}), 1.0); // exchanged
  EXPECT_EQ(tests::refusal<MeshError>([&] {
              length_of("top", {{"top", {"roof"}}});
            }),
            "no boundary is named roof; the mesh has 9, bottom, right");
}

// The cells of both squares are the group rock; a surface that is in a second group too has no single rock.
TEST(GmshMesh, GivesCellsTheirGroups)
{
  const tests::TemporaryFolder folder;
  const auto mesh = read_gmsh<2>(MPI_COMM_WORLD, folder.write("mesh.msh", squares_2_2), 0);
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    EXPECT_EQ(cell->material_id(), mesh.group("rock"));
  const auto complaint_on = [](const SampleMesh<2>& of, const std::string& group) {
    return tests::refusal<MeshError>([&] { of.group(group); });
  };
  EXPECT_EQ(complaint_on(mesh, "seam"), "no group of cells is named seam; the mesh has rock");
  const std::string both = with(squares_4_1, "1 0 0 0 2 1 0 0 1 3", "1 0 0 0 2 1 0 2 5 8 1 3");
  EXPECT_EQ(complaint_on(read_gmsh<2>(MPI_COMM_WORLD, folder.write("both.msh", both), 0), "5"),
            "the cell at (0.5, 0.5) m is in several physical groups, and a rock is that of one");
}

TEST(GmshMesh, TakesBinaryFiles)
{
  const tests::TemporaryFolder folder;
  for (const std::string version : {"2_2", "4_1"})
    {
      const auto mesh =
        read_gmsh<2>(MPI_COMM_WORLD, folder.write("m.msh", written_by_gmsh("of_gmsh_" + version + "_binary")), 0);
      EXPECT_EQ(mesh.triangulation->n_global_active_cells(), 2u);
      double length_of_right = 0.0;
      for (const auto& cell : mesh.triangulation->active_cell_iterators())
        for (const auto& face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == mesh.boundary("right"))
            length_of_right += face->measure();
      EXPECT_EQ(length_of_right, 1.0);
    }
  const auto cubes =
    read_gmsh<3>(MPI_COMM_WORLD, folder.write("cubes.msh", written_by_gmsh("cube_of_gmsh_4_1_binary")), 0);
  EXPECT_EQ(cubes.triangulation->n_global_active_cells(), 8u);
  EXPECT_EQ(cubes.boundary("bottom"), 3u);
}

TEST(GmshMesh, RefusesDamagedBinaryFiles)
{
  const std::string mesh = written_by_gmsh("of_gmsh_2_2_binary");
  const std::size_t count = mesh.find("$Nodes\n") + 7;        // the number 6 in a line
  const std::size_t elements = mesh.find("$Elements\n") + 12; // after the number 5 in a line: type, how many, tags
  EXPECT_EQ(complaint(mesh), "");
  const std::string unreadable = "is damaged, or its format is none that Gmsh reads";
  EXPECT_EQ(complaint(with(mesh, "2.2 1 8", "9.2 1 8")), "is damaged; Gmsh says: Unknown MSH file version 9.2");
  EXPECT_EQ(complaint(with_number(mesh, count, 'x')), unreadable);
  EXPECT_NE(complaint(with_number(mesh, elements, 10)), ""); // a type of more nodes than there are
  EXPECT_EQ(complaint(with_number(mesh, elements + 4, 2'000'000'000)), unreadable);
  EXPECT_EQ(complaint(with_number(mesh, count + 2 + 28, 1)), "is damaged; Gmsh says: Wrong node index 2");
  for (std::size_t length = 24; length + 14 < mesh.size(); length += 21) // 14: the end of the elements
    EXPECT_NE(complaint(mesh.substr(0, length)), "") << length;
}

// The library takes the counts of a file on trust; the memory of its process is limited.
TEST(GmshMesh, RefusesABinaryCountBeyondTheFile)
{
  const std::string mesh = written_by_gmsh("of_gmsh_4_1_binary");
  constexpr std::uint64_t huge = std::uint64_t(1) << 62;
  for (const std::string section : {"$Entities\n", "$Nodes\n", "$Elements\n"})
    EXPECT_NE(complaint(with_number(mesh, mesh.find(section) + section.size(), huge)), "") << section;
}

// Gmsh's library runs a file that is no mesh as a script, which may start programs, and a file of options beside a mesh.
TEST(GmshMesh, DoesNotRunScripts)
{
  const tests::TemporaryFolder folder;
  const auto trace = folder.path() / "trace";
  const std::string script = "SystemCall \"touch " + trace.string() + "\";\n";
  EXPECT_EQ(complaint(script), "is not a mesh of Gmsh, which begins with $MeshFormat");
  const auto mesh = folder.write("mesh.geo", squares_2_2);
  folder.write("mesh.geo.opt", script);
  EXPECT_EQ(read_gmsh_mesh(mesh, 2).cells.size(), 2u);
  complaint(squares_2_2 + script);
  EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(GmshMesh, NamesTheReason)
{
  const auto& mesh = squares_2_2;
  const std::string unreadable = "is damaged, or its format is none that Gmsh reads";
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "1.0 0")), unreadable);
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "2.2 2")), unreadable);
  for (const std::string n : {"100000000", "90", "5", "-1"})
    EXPECT_NE(complaint(with(mesh, "$Nodes\n6", "$Nodes\n" + n)), "") << n;
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "2 nan 0 0")), "node 2: a coordinate in metres is expected instead of nan");
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "2 1e300 0 0")),
            "node 2: a coordinate in metres is expected instead of 1e+300");
  EXPECT_EQ(complaint(with(mesh, "2 1 0 0", "1 1 0 0")), "is damaged; Gmsh says: Wrong node index 2");
  EXPECT_EQ(complaint(with(mesh, "1 2 5 4", "1 2 9 4")), "is damaged; Gmsh says: Wrong node index 9");
  EXPECT_EQ(complaint(with(mesh, "1 2 5 4", "1 2 2 4")), "element 4 has one node twice");
  EXPECT_EQ(complaint(cube), "elements of Gmsh's type 5; points, lines and quadrilaterals can be read");
  EXPECT_EQ(complaint(with(mesh, "7 3 3 6", "7 3 3 5")),
            "element 3 on the nodes 3 and 5, of the group right, is not the side of a cell");
  EXPECT_EQ(complaint(with(mesh, "3 1 2 7 3", "3 1 2 7 1")),
            "curve 1 is in the physical groups 1 and 7; a part of the boundary has one");
  EXPECT_EQ(complaint(with(mesh, "5 3 2 5 1 2 3 6 5\n", "")), unreadable);
  EXPECT_EQ(
    complaint(with(with(mesh, "$Elements\n5", "$Elements\n6"), "$EndElements", "6 3 2 5 1 2 3 6 5\n$EndElements")),
    "more than two cells meet at the nodes 2 and 5, or they do not fit together");
  EXPECT_EQ(complaint(with(cube, "4 3 2 1", "4 2 3 1"), 3),
            "element 1 on the nodes 1 and 3, of the group bottom, is not the side of a cell");
}

// deal.II gets the meshes that pass the check: it may refuse one, but neither crash nor hang.
TEST(GmshMesh, NoDamagedMeshCrashesTheReader)
{
  const tests::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const int dimension) {
    const auto file = folder.write("mesh.msh", text);
    const std::string words = tests::refusal<MeshError>([&] {
      dimension == 2 ? void(read_gmsh<2>(MPI_COMM_WORLD, file, 0)) : void(read_gmsh<3>(MPI_COMM_WORLD, file, 0));
    });
    EXPECT_FALSE(has(words, "\n"));
    return words != "";
  };
  constexpr std::uint64_t n_mutations = 30;
  std::uint64_t n_refused = 0;
  for (const auto& [text, dimension] :
       {std::pair(squares_2_2, 2), std::pair(squares_4_0, 2), std::pair(squares_4_1, 2), std::pair(cube, 3),
        std::pair(written_by_gmsh("of_gmsh_2_2_binary"), 2), std::pair(written_by_gmsh("of_gmsh_4_1_binary"), 2),
        std::pair(written_by_gmsh("cube_of_gmsh_4_1_binary"), 3)})
    for (std::uint64_t seed = 0; seed < n_mutations; ++seed)
      n_refused += refused(tests::Mutations(seed).of(text), dimension);
  EXPECT_GT(n_refused, 4 * n_mutations);
}
} // namespace feldspar::fem
