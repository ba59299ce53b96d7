#include "fem/mesh/gmsh_check.h"

#include "base/input_error.h"
#include "fem/mesh/gmsh_binary.h"
#include "fem/mesh/sample_mesh.h"
#include "tests/mutations.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

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

/// A mesh that Gmsh 4.8.4 wrote: two squares in a rectangle of 2 m x 1 m with the groups bottom, right and rock, as text
/// and as bytes of the same numbers; or eight cubes in one of 1 m with the groups bottom and rock.
std::string written_by_gmsh(const std::string& name)
{
  std::ifstream file(std::filesystem::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus/mesh" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::string> words_of(const std::string& text)
{
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

std::string complaint_of_bytes(const std::string& content)
{
  try
    {
      text_of_binary_gmsh(content);
    }
  catch (const InputError& error)
    {
      return error.what();
    }
  return "";
}

template <typename Number>
std::string with_number(std::string bytes, const std::size_t place, const Number value)
{
  const auto of_number = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  std::copy(of_number.begin(), of_number.end(), bytes.begin() + std::ptrdiff_t(place));
  return bytes;
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

// Gmsh wrote both from one mesh; its coordinates of 16 digits are the shortest that give the same bits again.
TEST(GmshCheck, TheTextOfABinaryFileIsWhatGmshWritesAsText)
{
  for (const std::string version : {"2_2", "4_1"})
    {
      const std::string text = written_by_gmsh("of_gmsh_" + version);
      const std::string bytes = written_by_gmsh("of_gmsh_" + version + "_binary");
      EXPECT_FALSE(is_binary_gmsh(text));
      ASSERT_TRUE(is_binary_gmsh(bytes));
      EXPECT_EQ(words_of(text_of_binary_gmsh(bytes)), words_of(text));
    }
}

TEST(GmshCheck, TakesBinaryFiles)
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

TEST(GmshCheck, NamesByteAndReasonInABinaryFile)
{
  const std::string mesh = written_by_gmsh("of_gmsh_2_2_binary");
  const std::size_t count = mesh.find("$Nodes\n") + 7;        // the number 6 in a line
  const std::size_t elements = mesh.find("$Elements\n") + 12; // behind the number 5 in a line: type, how many, tags
  EXPECT_EQ(complaint_of_bytes(mesh), "");
  EXPECT_EQ(complaint_of_bytes(with(mesh, "2.2 1", "4.0 1")),
            "byte 12: binary format 4.0 of Gmsh; 2.2 and 4.1 can be read, and 4.0 as text");
  EXPECT_EQ(complaint_of_bytes(with(mesh, "2.2 1 8", "2.2 1 4")), "byte 12: numbers of 4 bytes; 8 can be read");
  EXPECT_EQ(complaint_of_bytes(with_number(mesh, 20, 0x01000000)),
            "byte 24: the bytes of its numbers are in the order of another kind of machine; save the mesh as text");
  EXPECT_EQ(complaint_of_bytes(with_number(mesh, count, 'x')),
            fmt::format("byte {}: a number of nodes or elements is expected instead of x", count));
  // Five of six nodes: the sixth stands where the section should end.
  EXPECT_EQ(
    complaint_of_bytes(with_number(mesh, count, '5')),
    fmt::format("byte {}: the end of a section is expected instead of \\x06\\x00\\x00\\x00vH\\x00\\x00\\x00\\x00\\xf0?"
                "\\x00\\x00\\x00\\x00\\x00\\x00\\xf0?…",
                count + 2 + 5 * 28));
  EXPECT_EQ(complaint_of_bytes(with_number(mesh, elements, 10)),
            fmt::format("byte {}: elements of Gmsh's type 10; points, lines, quadrilaterals and hexahedra can be read",
                        elements + 12));
  EXPECT_EQ(
    complaint_of_bytes(with_number(mesh, elements + 4, 2'000'000'000)),
    fmt::format("byte {}: 2000000000 elements with 2 tags follow, where 5 of 5 elements are left", elements + 12));
  for (std::size_t length = 24; length + 13 < mesh.size(); ++length) // 13: "$EndElements" and the end of its line
    EXPECT_NE(complaint_of_bytes(mesh.substr(0, length)), "") << length;
  // Numbers that make no mesh are found in its text, as those of a file of text.
  const tests::TemporaryFolder folder;
  const auto file = folder.write("m.msh", with_number(mesh, count + 2 + 28, 1));
  try
    {
      read_gmsh<2>(MPI_COMM_WORLD, file, 0);
      FAIL();
    }
  catch (const MeshError& error)
    {
      EXPECT_EQ(std::string(error.what()), file.string() + ", as text: line 13: there is another node 1");
    }
}

// A count is no more than a promise: what it promises is not set aside.
TEST(GmshCheck, ABinaryCountBeyondTheFileEndsAtItsEnd)
{
  const std::string mesh = written_by_gmsh("of_gmsh_4_1_binary");
  constexpr std::uint64_t huge = std::uint64_t(1) << 62;
  for (const std::string section : {"$Entities\n", "$Nodes\n", "$Elements\n"})
    EXPECT_NE(complaint_of_bytes(with_number(mesh, mesh.find(section) + section.size(), huge)).find("byte"),
              std::string::npos);
}

TEST(GmshCheck, NamesLineAndReason)
{
  const auto& mesh = squares_2_2;
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "1.0 0")), "line 2: format 1.0 of Gmsh; 2.2, 4.0 and 4.1 can be read");
  EXPECT_EQ(complaint(with(mesh, "2.2 0", "2.2 2")), "line 2: 0 is expected instead of 2");
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
       {std::pair(squares_2_2, 2), std::pair(squares_4_0, 2), std::pair(squares_4_1, 2), std::pair(cube, 3),
        std::pair(written_by_gmsh("of_gmsh_2_2_binary"), 2), std::pair(written_by_gmsh("of_gmsh_4_1_binary"), 2),
        std::pair(written_by_gmsh("cube_of_gmsh_4_1_binary"), 3)})
    for (std::uint64_t seed = 0; seed < n_mutations; ++seed)
      n_refused += refused(tests::Mutations(seed).of(text), dimension);
  EXPECT_GT(n_refused, 4 * n_mutations);
}
} // namespace feldspar::fem
