#include "app/input/traces.h"

#include "base/input_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace feldspar
{
namespace
{
using tests::TemporaryFolder;

/// A drawing in DXF: a group a pair of code and value.
std::string drawing(const std::string& entities, const std::string& unit = "4")
{
  return "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n" + unit + "\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
         "0\nENDSEC\n0\nEOF\n";
}

const std::string line_10_20_to_30_40 = "0\nLINE\n8\njoints\n10\n10\n20\n20\n30\n0\n11\n30\n21\n40\n31\n0\n";
const std::string closed_triangle =
  "0\nLWPOLYLINE\n8\njoints\n90\n3\n70\n1\n10\n1\n20\n1\n10\n5\n20\n1\n10\n5\n20\n4\n";

TEST(Traces, OfADrawingAreItsLinesInItsUnit)
{
  const TemporaryFolder folder;
  const auto traces = [&](const std::string& text) { return read_traces(folder.write("map.dxf", text)); };
  for (const auto& [unit, metres] : {std::pair("4", 1e-3), std::pair("5", 1e-2), std::pair("6", 1.0)})
    {
      const auto all = traces(drawing(line_10_20_to_30_40 + closed_triangle, unit));
      ASSERT_EQ(all.size(), 2u);
      const auto& line = std::get<ClosedFlaw>(all[0]).points;
      ASSERT_EQ(line.size(), 2u);
      EXPECT_EQ(line[0], metres * Vector<2>(10.0, 20.0));
      EXPECT_EQ(line[1], metres * Vector<2>(30.0, 40.0));
      const auto& triangle = std::get<ClosedFlaw>(all[1]).points;
      ASSERT_EQ(triangle.size(), 4u);
      EXPECT_EQ(triangle[2], metres * Vector<2>(5.0, 4.0));
      EXPECT_EQ(triangle[3], triangle[0]);
    }
  // The older form of a polyline, vertex by vertex.
  const auto old =
    traces(drawing("0\nPOLYLINE\n8\n0\n66\n1\n70\n0\n0\nVERTEX\n8\n0\n10\n1\n20\n2\n0\nVERTEX\n8\n0\n10\n3\n"
                   "20\n2\n0\nSEQEND\n"));
  ASSERT_EQ(old.size(), 1u);
  EXPECT_EQ(std::get<ClosedFlaw>(old[0]).points.back(), 1e-3 * Vector<2>(3.0, 2.0));
}

TEST(Traces, OfADrawingThatCannotBeReadAsSuchAreRefused)
{
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& expected, const std::string& line = "") {
    try
      {
        read_traces(folder.write("map.dxf", text));
        ADD_FAILURE() << expected << ": was read";
      }
    catch (const InputError& error)
      {
        EXPECT_NE(std::string(error.what()).find("map.dxf:" + line + " " + expected), std::string::npos)
          << error.what();
      }
  };
  refused(drawing(line_10_20_to_30_40, "0"), "its $INSUNITS is 0; it must be 4 (mm)");
  refused(drawing(line_10_20_to_30_40 + "0\nARC\n8\n0\n10\n1\n20\n1\n40\n2\n50\n0\n51\n90\n"),
          "has an entity ARC; traces are");
  refused(drawing("0\nLWPOLYLINE\n8\n0\n90\n2\n70\n0\n10\n1\n20\n1\n42\n0.5\n10\n5\n20\n1\n"),
          "has an entity POLYLINE with arcs");
  refused(drawing(""), "has no LINE, LWPOLYLINE or POLYLINE");
  refused("AutoCAD Binary DXF\r\n\x1a", "is a binary DXF; save it as text");
  refused("no drawing at all", "does not end with EOF");
  const std::string two_lines = drawing(line_10_20_to_30_40 + line_10_20_to_30_40);
  refused(two_lines.substr(0, two_lines.rfind("LINE")), "does not end with EOF");
  refused(drawing("0\nLINE\n8\n0\n10\n1\n20\n1\n11\n1\n21\n1\n"), "trace 1 ends where it begins");
  refused(drawing("0\nLINE\n8\n0\n 10\nabc\n20\n1\n11\n1\n21\n2\n"),
          "\"abc\" is not a decimal number, as group code 10 has", "20:");
}
} // namespace
} // namespace feldspar
