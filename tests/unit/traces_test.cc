#include "app/input/maps/traces.h"

#include "base/input_error.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

/// A drawing in DXF: a group a pair of code and value.
std::string drawing(const std::string& entities, const std::string& unit = "4")
{
  return "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n" + unit + "\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
         "0\nENDSEC\n0\nEOF\n";
}

Traces read(const std::string& text)
{
  const TemporaryFolder folder;
  return read_traces(folder.write("map.dxf", text));
}

std::string refusal_of(const std::string& text)
{
  return tests::refusal([&] { read(text); });
}

const std::string line_10_20_to_30_40 = "0\nLINE\n8\njoints\n10\n10\n20\n20\n30\n0\n11\n30\n21\n40\n31\n0\n";
const std::string closed_triangle =
  "0\nLWPOLYLINE\n8\njoints\n90\n3\n70\n1\n10\n1\n20\n1\n10\n5\n20\n1\n10\n5\n20\n4\n";

TEST(Traces, OfADrawingAreItsLinesInItsUnit)
{
  for (const auto& [unit, metres] : {std::pair("4", 1e-3), std::pair("5", 1e-2), std::pair("6", 1.0)})
    {
      const auto all = read(drawing(line_10_20_to_30_40 + closed_triangle, unit)).shapes;
      ASSERT_EQ(all.size(), 2u);
      EXPECT_EQ(std::get<ClosedFlaw>(all[0]).points,
                (std::vector<Vector<2>>{metres * Vector<2>(10.0, 20.0), metres * Vector<2>(30.0, 40.0)}));
      const auto& triangle = std::get<ClosedFlaw>(all[1]).points;
      ASSERT_EQ(triangle.size(), 4u);
      EXPECT_EQ(triangle[2], metres * Vector<2>(5.0, 4.0));
      EXPECT_EQ(triangle[3], triangle[0]);
    }
  // The older form of a polyline, vertex by vertex.
  const auto old =
    read(drawing("0\nPOLYLINE\n8\n0\n66\n1\n70\n0\n0\nVERTEX\n8\n0\n10\n1\n20\n2\n0\nVERTEX\n8\n0\n10\n3\n"
                 "20\n2\n0\nSEQEND\n"))
      .shapes;
  ASSERT_EQ(old.size(), 1u);
  EXPECT_EQ(std::get<ClosedFlaw>(old[0]).points.back(), 1e-3 * Vector<2>(3.0, 2.0));
}

TEST(Traces, OfADrawingThatCannotBeReadAsSuchAreRefused)
{
  const auto refused = [](const std::string& text, const std::string& expected, const std::string& line = "") {
    EXPECT_TRUE(has(refusal_of(text), "map.dxf:" + line + " " + expected));
  };
  refused(drawing(line_10_20_to_30_40, "0"), "its $INSUNITS is 0; it must be 4 (mm)");
  refused(drawing(line_10_20_to_30_40 + "0\nARC\n8\n0\n10\n1\n20\n1\n40\n2\n50\n0\n51\n90\n"),
          "has an entity ARC; traces are", "32:");
  refused(drawing("0\nLWPOLYLINE\n8\n0\n90\n2\n70\n0\n10\n1\n20\n1\n42\n0.5\n10\n5\n20\n1\n"),
          "the LWPOLYLINE has arcs", "16:");
  refused(drawing(""), "has no LINE, LWPOLYLINE or POLYLINE");
  refused("AutoCAD Binary DXF\r\n\x1a", "is a binary DXF; save it as text");
  refused("no drawing at all", "does not end with EOF");
  const std::string two_lines = drawing(line_10_20_to_30_40 + line_10_20_to_30_40);
  refused(two_lines.substr(0, two_lines.rfind("LINE")), "does not end with EOF");
  refused(drawing("0\nLINE\n8\n0\n10\n1\n20\n1\n11\n1\n21\n1\n"), "trace 1 ends where it begins");
  refused(drawing("0\nLINE\n8\n0\n 10\nabc\n20\n1\n11\n1\n21\n2\n"),
          "\"abc\" is not a decimal number, as group code 10 has", "20:");
}

/// The points of each trace of a drawing in millimetres.
std::vector<std::vector<Vector<2>>> points_of(const Traces& traces)
{
  std::vector<std::vector<Vector<2>>> all;
  for (const Shape& shape : traces.shapes)
    {
      all.emplace_back();
      for (const Vector<2>& point : std::get<ClosedFlaw>(shape).points)
        all.back().push_back(1e3 * point);
    }
  return all;
}

/// Groups as pairs between spaces.
std::string groups(std::string pairs)
{
  std::replace(pairs.begin(), pairs.end(), ' ', '\n');
  return pairs + "\n";
}

/// A drawing of entities and layers (name, colour, flags), in millimetres.
std::string layered(const std::string& entities, const std::string& layers, const std::string& end = "")
{
  return groups("0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 TABLES 0 TABLE 2 LAYER " + layers +
                "0 ENDTAB 0 ENDSEC 0 SECTION 2 ENTITIES " + entities + " 0 ENDSEC 0 EOF" + end);
}

const std::string plain_line = "0 LINE 8 rock 10 4 20 8 30 0 11 11 21 16 31 0";

TEST(Drawing, ShowsModelSpaceOfLayersThatAreOn)
{
  const std::vector<std::vector<Vector<2>>> one{{{4.0, 8.0}, {11.0, 16.0}}};
  const std::string layers = "0 LAYER 2 rock 70 0 62 7 0 LAYER 2 off 70 0 62 -7 0 LAYER 2 frozen 70 1 62 7 0 LAYER 2 "
                             "locked 70 4 62 7 ";
  const auto on = [](const std::string& layer, const std::string& more = "") {
    return " 0 LINE 8 " + layer + more + " 10 1 20 1 11 2 21 3";
  };

  const Traces plain = read(layered(plain_line, layers));
  EXPECT_EQ(points_of(plain), one);
  EXPECT_EQ(plain.left_out, "");
  // Paper space is the printed sheet.
  const Traces paper = read(layered(plain_line + on("rock", " 67 1") + " 0 VIEWPORT 67 1 10 0 20 0", layers));
  EXPECT_EQ(points_of(paper), one);
  EXPECT_TRUE(
    has(paper.left_out, "map.dxf: entities that are not to be seen in model space are not read: 1 in paper space"));
  // The older form of a polyline with its vertices; what would be refused hides nothing where it cannot be seen.
  const Traces hidden = read(layered(
    plain_line + " 0 POLYLINE 8 OFF 66 1 70 0 0 VERTEX 8 OFF 10 1 20 1 0 VERTEX 8 OFF 10 2 20 3 0 SEQEND 8 OFF" +
      on("frozen") + " 0 CIRCLE 8 Frozen 10 1 20 1 40 1" + on("rock", " 60 1") + on("locked") + on("unlisted"),
    layers));
  EXPECT_EQ(points_of(hidden).size(), 3u);
  EXPECT_TRUE(has(hidden.left_out, "not read: 3 on layers that are off or frozen, 1 marked as invisible"));
  // Words and dimensions show no line of the rock, and are nothing to speak of.
  const Traces words =
    read(layered(plain_line + " 0 TEXT 8 rock 10 1 20 1 40 1 1 N 0 DIMENSION 8 rock 2 *D1 10 0 20 0", layers));
  EXPECT_EQ(points_of(words), one);
  EXPECT_EQ(words.left_out, "");
}

TEST(Drawing, TellsTheLayerOfEachLine)
{
  const auto traces = read(layered(plain_line + " 0 LWPOLYLINE 8 Faults 90 2 70 0 10 1 20 1 10 5 20 5", ""));
  ASSERT_EQ(traces.shapes.size(), 2u);
  EXPECT_EQ(std::get<ClosedFlaw>(traces.shapes[0]).map_layer, "rock");
  EXPECT_EQ(std::get<ClosedFlaw>(traces.shapes[1]).map_layer, "faults");
}

TEST(Drawing, SeenFromBelowIsMirrored)
{
  const auto points = [](const std::string& entity) { return points_of(read(layered(entity, ""))); };
  const std::vector<std::vector<Vector<2>>> one{{{4.0, 8.0}, {11.0, 16.0}}};
  // Arbitrary axis algorithm: N = (0, 0, -1) has the x axis (0, 1, 0) × N = (-1, 0, 0).
  const std::string below = " 210 0 220 0 230 -1";
  EXPECT_EQ(points("0 LWPOLYLINE 8 0 90 2 70 0 10 -4 20 8 10 -11 20 16" + below), one);
  EXPECT_EQ(points("0 POLYLINE 8 0 66 1 70 0" + below + " 0 VERTEX 10 -4 20 8 0 VERTEX 10 -11 20 16 0 SEQEND"), one);
  // Lines, and polylines in space, are given in the coordinates of the drawing itself.
  EXPECT_EQ(points(plain_line + below), one);
  EXPECT_EQ(
    points("0 POLYLINE 8 0 66 1 70 8" + below + " 0 VERTEX 70 32 10 4 20 8 0 VERTEX 70 32 10 11 20 16 0 SEQEND"), one);
  // One that a spline smooths has the points of its frame besides.
  EXPECT_EQ(
    points("0 POLYLINE 8 0 66 1 70 4 0 VERTEX 70 16 10 4 20 8 0 VERTEX 70 16 10 0 20 30 0 VERTEX 70 8 10 4 20 8 0 "
           "VERTEX 70 8 10 11 20 16 0 SEQEND"),
    one);
  // At one height, and with the bulge of a side that an open line does not have.
  EXPECT_EQ(points("0 LWPOLYLINE 8 0 90 2 70 128 10 4 20 8 10 11 20 16"), one);
  EXPECT_EQ(points("0 LWPOLYLINE 8 0 90 2 70 0 38 5 10 4 20 8 10 11 20 16 42 1"), one);
}

TEST(Drawing, ThatShowsMoreThanLinesIsRefusedByName)
{
  for (const char* entity : {"ARC", "CIRCLE", "ELLIPSE", "SPLINE", "HATCH", "SOLID", "TRACE", "3DFACE", "MLINE", "MESH",
                             "REGION", "3DSOLID", "INSERT", "XLINE", "RAY", "HELIX", "BREP_OF_TOMORROW"})
    EXPECT_TRUE(has(refusal_of(layered(plain_line + " 0 " + entity + " 8 rock 10 1 20 1", "")),
                    std::string("map.dxf:44: has an entity ") + entity, "put what is no trace on a layer that is off"));
  const auto refused = [](const std::string& entity, const std::string& why) {
    const std::string words = refusal_of(layered(entity, ""));
    EXPECT_TRUE(has(words, why));
    EXPECT_FALSE(has(words, "\n"));
  };
  refused("0 LWPOLYLINE 8 0 90 2 70 0 10 4 20 8 10 11 20 16 210 1 220 0 230 0",
          "the LWPOLYLINE lies in a tilted plane");
  refused("0 LINE 8 0 10 4 20 8 30 0 11 11 21 16 31 3", "the LINE is not level: z is 0 and then 3");
  refused("0 LINE 8 0 10 4 20 8 11 11", "the LINE has no group 21");
  refused("0 POLYLINE 8 0 70 16 0 VERTEX 10 0 20 0 0 SEQEND", "the POLYLINE is a polygon mesh");
  refused("0 POLYLINE 8 0 70 64 0 VERTEX 70 128 10 0 20 0 0 SEQEND", "the POLYLINE is a polyface mesh");
  refused("0 POLYLINE 8 0 70 0 0 VERTEX 70 64 10 0 20 0 0 SEQEND", "the POLYLINE has a vertex of a mesh");
  // The frame of a spline is not its curve.
  refused("0 POLYLINE 8 0 70 4 0 VERTEX 70 16 10 0 20 0 0 VERTEX 70 16 10 4 20 9 0 SEQEND",
          "the POLYLINE is a spline of which there are 2 control points and no point of its curve");
  refused("0 POLYLINE 8 0 70 0 0 VERTEX 70 16 10 0 20 0 0 VERTEX 70 0 10 4 20 9 0 SEQEND",
          "the POLYLINE has a control point of a spline (VERTEX, group 70 = 16), and is not marked as a spline");
  refused("0 LWPOLYLINE 8 0 90 2 70 16 10 4 20 8 10 11 20 16", "the LWPOLYLINE has unknown flags (group 70 = 16)");
  refused("0 POLYLINE 8 0 70 256 0 VERTEX 10 0 20 0 0 VERTEX 10 4 20 0 0 SEQEND",
          "the POLYLINE has unknown flags (group 70 = 256)");
  refused("0 POLYLINE 8 0 70 1 0 VERTEX 10 0 20 0 0 VERTEX 10 4 20 0 42 1 0 SEQEND", "the POLYLINE has arcs");
  refused(plain_line + " 0 VERTEX 10 0 20 0", "has an entity VERTEX");
  refused("0 LINE 67 1 10 4 20 8 11 11 21 16", "1 in paper space; no LINE, LWPOLYLINE or POLYLINE is left");
  EXPECT_TRUE(has(refusal_of(groups("0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES " + plain_line +
                                    " 0 ENDSEC 0 SECTION 2 TABLES 0 LAYER 2 rock 70 1 0 ENDSEC 0 EOF")),
                  "map.dxf:38: the layers stand behind the entities"));
  // A line that is missing makes codes of values.
  EXPECT_TRUE(has(refusal_of(groups("0 SECTION 2 ENTITIES 0 LINE 8 10 4 20 8 0 ENDSEC 0 EOF")), "map.dxf:"));
}

TEST(Drawing, CountsAreThoseOfWhatIsThere)
{
  const auto words_of = [](const std::string& entity) { return refusal_of(layered(entity, "")); };
  for (const char* n : {"1073741825", "2", "-1", "0", "99999999999999999999", "two"})
    {
      const std::string words =
        words_of(std::string("0 LWPOLYLINE 8 0 90 ") + n + " 70 0 10 1 20 1 10 5 20 1 10 5 20 4");
      EXPECT_NE(words, "") << n;
      EXPECT_FALSE(has(words, "\n"));
    }
  EXPECT_TRUE(has(words_of("0 LWPOLYLINE 8 0 90 2 70 0 10 1 20 1 10 5 20 1 10 5 20 4"),
                  "the LWPOLYLINE says that it has 2 vertices (group 90) and has 3"));
  EXPECT_TRUE(has(words_of("0 SPLINE 8 0 74 1431655766 11 1 21 2"), "has an entity SPLINE"));
  EXPECT_TRUE(has(words_of("0 HATCH 8 0 91 1000000000 76 1000000000"), "has an entity HATCH"));
  std::string vertices;
  for (int k = 0; k < 60000; ++k)
    vertices += " 10 " + std::to_string(k) + " 20 1";
  EXPECT_TRUE(
    has(words_of("0 LWPOLYLINE 8 0 90 60000 70 0" + vertices), "has 60000 vertices; it must have at most 10000"));
}

TEST(Drawing, EndsAtItsEofWhateverBlankLinesFollow)
{
  const auto n_traces = [](const std::string& text) { return read(text).shapes.size(); };
  const std::string whole = layered(plain_line, "");
  EXPECT_EQ(n_traces(whole.substr(0, whole.size() - 1)), 1u); // no end of line at all
  for (const char* end : {"", "\n", "\n\n", "\n\n\n", "\r\n \t\n", "\x1a"})
    EXPECT_EQ(n_traces(whole + end), 1u) << end;
  EXPECT_EQ(n_traces("\xef\xbb\xbf"
                     "999\na comment\n" +
                     whole),
            1u);
  std::string with_returns;
  for (const char c : whole)
    with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(n_traces(with_returns), 1u);
  EXPECT_THROW(n_traces(whole + "0\nLINE\n"), InputError);
}
} // namespace
} // namespace feldspar
