#include "report/pictures/figures.h"

#include "base/system/hdf5_archive.h"
#include "dem/lab/protocols/protocols.h"
#include "report/pictures/rves.h"
#include "results/folder/result_folder.h"
#include "results/sample_fields.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

// Pictures of a sample of finite elements, from the fields it left.
namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

/// Squares or cubes of 10 mm, two in each direction from x = y = z = 0, whose top is lifted by 0.1 mm. Every node is of
/// one cell, as in the files.
SampleFields blocks(const unsigned int dimension)
{
  static constexpr std::array<std::array<int, 3>, 8> corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  SampleFields fields;
  fields.dimension = dimension;
  fields.n_rows = 31;
  const unsigned int n_corners = 1u << dimension;
  for (unsigned int k = 0; k < n_corners; ++k)
    {
      fields.cells.emplace_back();
      for (unsigned int i = 0; i < n_corners; ++i)
        {
          std::array<double, 3> node{};
          for (unsigned int c = 0; c < dimension; ++c)
            node[c] = 0.01 * ((k >> c & 1u) + unsigned(corners[i][c]));
          fields.cells.back().push_back(std::uint32_t(fields.nodes.size()));
          fields.nodes.push_back(node);
          fields.displacement.push_back({});
          fields.displacement.back()[dimension - 1] = 0.005 * node[dimension - 1];
        }
      fields.of_each_cell["cell"].push_back(k);
      fields.of_each_cell["broken_segments_share"].push_back(0.01 * k);
      fields.of_each_cell["stress_xx_Pa"].push_back(1e6);
    }
  return fields;
}

FinishedTest test_with(const SampleFields& fields)
{
  FinishedTest test;
  test.name = "direct_tension_seed_1";
  test.record.kind = direct_tension.kind;
  test.record.body = TestBody::finite_elements;
  test.record.seed = 1;
  test.record.curve.resize(31);
  test.appearance.fields = fields;
  return test;
}

Chart chart_of(const SampleFields& fields)
{
  const auto pictures = sample_picture(test_with(fields), "Direct tension");
  EXPECT_EQ(pictures.size(), 1u);
  return pictures.at(0).panels.at(0);
}

constexpr const char* outline = "displacements drawn 10 times";
constexpr const char* strokes_label = "mean direction of the cracks";

/// Points of the series of a label or, without one, of a kind; without gaps.
std::vector<ChartPoint> points_of(const Chart& chart, const std::string& label,
                                  const std::optional<ChartSeries::Kind> kind = std::nullopt)
{
  std::vector<ChartPoint> points;
  for (const ChartSeries& series : chart.series)
    if (series.label == label && (!kind || series.kind == *kind))
      std::copy_if(series.points.begin(), series.points.end(), std::back_inserter(points),
                   [](const ChartPoint& point) { return std::isfinite(point[0]); });
  return points;
}

std::size_t n_cells(const Chart& chart) { return points_of(chart, "", ChartSeries::Kind::area).size() / 4; }

TEST(SamplePicture, DrawsCellsAsTheyAreDisplacedAndSaysHowMuch)
{
  const auto test = test_with(blocks(2));
  const auto picture = sample_picture(test, "Direct tension").at(0);
  const Chart chart = picture.panels.at(0);
  EXPECT_EQ(n_cells(chart), 4u);
  // Lifted by 0.1 mm of 20: to be seen as at most 6 %, which is 12 times, round: 10 times.
  EXPECT_TRUE(has(picture.caption, "displacements drawn 10 times", "at the end"));
  double highest = 0.0;
  for (const auto& row : points_of(chart, outline))
    highest = std::max(highest, row.at(1));
  EXPECT_NEAR(highest, 21.0, 1e-9);
  // The outline of a square of four cells has eight of their edges, each of two ends.
  EXPECT_EQ(points_of(chart, outline).size(), 16u);
  EXPECT_EQ(points_of(chart, "at rest").size(), 16u);
  EXPECT_NEAR(chart.colour.to.value(), 3.0, 1e-9); // 3 % of the last cell
}

// A scale from 0 would show cells that broke nearly alike in one colour.
TEST(SamplePicture, HasTheColoursOfItsOwnCells)
{
  SampleFields fields = blocks(2);
  fields.of_each_cell["broken_segments_share"] = {0.031, 0.030, 0.0325, 0.032};
  const Picture alike = sample_picture(test_with(fields), "Direct tension").at(0);
  EXPECT_NEAR(alike.panels.at(0).colour.from.value(), 3.0, 1e-9);
  EXPECT_NEAR(alike.panels.at(0).colour.to.value(), 3.25, 1e-9);
  EXPECT_TRUE(has(alike.caption, "from the least share, 3 %, to the largest, 3.25 %"));
  // One share for all cells leaves a scale with room.
  fields.of_each_cell["broken_segments_share"] = {0.03, 0.03, 0.03, 0.03};
  const Picture same = sample_picture(test_with(fields), "Direct tension").at(0);
  EXPECT_LT(same.panels.at(0).colour.from.value(), same.panels.at(0).colour.to.value());
  EXPECT_TRUE(has(same.caption, "All cells have the same share, 3 %"));
}

TEST(SamplePicture, HasEveryFieldOfItsCellsForThePage)
{
  const auto picture = sample_picture(test_with(blocks(2)), "Direct tension").at(0);
  const auto json = nlohmann::json::parse(picture.live());
  EXPECT_EQ(json["what"], "sample");
  EXPECT_EQ(json["scale"], 10.0);
  ASSERT_EQ(json["cells"].size(), 4u);
  EXPECT_EQ(json["cells"][3]["rest"], nlohmann::json::parse("[10, 10, 20, 10, 20, 20, 10, 20]")); // mm
  ASSERT_EQ(json["times"].size(), 1u);
  EXPECT_EQ(json["times"][0]["moved"][3], nlohmann::json::parse("[10, 10.5, 20, 10.5, 20, 21, 10, 21]")); // 10 times
  EXPECT_EQ(json["fields"][0], nlohmann::json::parse(R"({"field": "broken_segments_share", "name": "broken segments",
    "unit": "%", "values": [[0, 1, 2, 3]]})"));
  EXPECT_EQ(json["fields"][1]["name"], "stress xx");
  EXPECT_EQ(json["fields"][1]["values"][0][0], 1.0); // MPa
}

TEST(SamplePicture, HasItsFieldsAtEachTimeThatBelongsToARow)
{
  auto test = test_with(blocks(2));
  SampleFields earlier = blocks(2);
  for (auto& displacement : earlier.displacement)
    displacement = {};
  earlier.of_each_cell["broken_segments_share"] = {0.0, 0.0, 0.0, 0.005};
  earlier.n_rows = 11;
  SampleFields of_older_curve = earlier;
  of_older_curve.n_rows = 100;
  test.appearance.fields_before = {earlier, of_older_curve};
  test.record.curve[10].axial_strain = 2e-4;
  test.record.curve[10].axial_stress = 9.5e6;
  const auto json = nlohmann::json::parse(sample_picture(test, "Direct tension").at(0).live());
  ASSERT_EQ(json["times"].size(), 2u);
  EXPECT_EQ(json["times"][0]["title"], "axial strain 0.2·10⁻³, 9.5 MPa");
  EXPECT_EQ(json["times"][0]["moved"][3], json["cells"][3]["rest"]);
  EXPECT_EQ(json["fields"][0]["values"], nlohmann::json::parse("[[0, 0, 0, 0.5], [0, 1, 2, 3]]"));
}

TEST(SamplePicture, SaysThatAnInterruptedTestIsShownAsLastWritten)
{
  auto test = test_with(blocks(2));
  test.appearance.fields.n_rows = 12;
  EXPECT_TRUE(has(sample_picture(test, "Direct tension").at(0).caption, "at row 12 of 31"));
}

TEST(SamplePicture, OutlinesWhatHasLocalisedWhereTheFieldsKnow)
{
  SampleFields fields = blocks(2);
  EXPECT_TRUE(points_of(chart_of(fields), "localised zone").empty());
  // The lower two cells together: six edges, none between them. A quarter of a cell's points is too few.
  fields.of_each_cell["localised_share"] = {1.0, 0.5, 0.25, 0.0};
  const auto zone = points_of(chart_of(fields), "localised zone");
  EXPECT_EQ(zone.size(), 12u);
  for (const auto& point : zone)
    EXPECT_LE(point.at(1), 10.5 + 1e-9);
  fields.of_each_cell["localised_share"] = {0.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(points_of(chart_of(fields), "localised zone").empty());
}

TEST(SamplePicture, StrokesLieInTheMeanCrack)
{
  SampleFields fields = blocks(2);
  EXPECT_TRUE(points_of(chart_of(fields), strokes_label).empty());
  const double along = std::sqrt(0.5);
  for (const auto& [name, values] : {std::pair("xx", std::vector{0.0, 0.0, 2.0, 0.5}),
                                     {"yy", std::vector{0.0, 3.0, 0.0, 0.5}},
                                     {"xy", std::vector{0.0, 0.0, 0.0, 0.5}}})
    fields.of_each_cell[fmt::format("crack_orientation_{}_per_m", name)] = values;
  const auto strokes = points_of(chart_of(fields), strokes_label);
  ASSERT_EQ(strokes.size(), 3u); // none where nothing broke
  // Normals all along y: a level crack, 0.8 of the cell's 10 mm, for no cell has more. All along x: upright, with two
  // thirds of the cracks. Along the diagonal: across it, with a third.
  const std::vector<std::array<double, 2>> directions{{1.0, 0.0}, {0.0, 1.0}, {-along, along}};
  const std::vector<double> lengths{8.0, 8.0 * 2.0 / 3.0, 8.0 / 3.0};
  for (std::size_t k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(std::abs(strokes[k].at(2) * directions[k][0] + strokes[k].at(3) * directions[k][1]), lengths[k], 1e-4)
        << k;
      EXPECT_NEAR(strokes[k].at(2) * directions[k][1] - strokes[k].at(3) * directions[k][0], 0.0, 1e-4) << k;
    }
  // Cracks of equal number in either direction have no direction.
  for (const char* name : {"xx", "yy"})
    fields.of_each_cell[fmt::format("crack_orientation_{}_per_m", name)] = {0.0, 1.0, 1.0, 1.0};
  fields.of_each_cell["crack_orientation_xy_per_m"] = {0.0, 0.0, 0.0, 0.0};
  for (const auto& row : points_of(chart_of(fields), strokes_label))
    EXPECT_NEAR(std::hypot(row.at(2), row.at(3)), 0.0, 1e-9);
}

TEST(SamplePicture, MirrorsAHalfSectionAndCutsABodyInSpace)
{
  SampleFields half = blocks(2);
  half.of_each_cell["stress_rr_Pa"] = half.of_each_cell["stress_xx_Pa"];
  const Chart both = chart_of(half);
  EXPECT_EQ(n_cells(both), 8u);
  // Around both halves: what lies on the axis is inside.
  EXPECT_EQ(points_of(both, outline).size(), 24u);
  EXPECT_EQ(both.x.label, "r [mm]");

  // The section between the cubes takes the four behind it.
  const Chart section = chart_of(blocks(3));
  EXPECT_EQ(n_cells(section), 4u);
  EXPECT_EQ(points_of(section, outline).size(), 16u);
  for (const auto& row : points_of(section, "at rest"))
    EXPECT_TRUE(row.at(0) >= 0.0 && row.at(0) <= 20.0 && row.at(1) >= 0.0 && row.at(1) <= 20.0);
}

TEST(SamplePicture, NeedsGrains)
{
  SampleFields fields = blocks(2);
  fields.of_each_cell.erase("broken_segments_share");
  EXPECT_TRUE(sample_picture(test_with(fields), "Direct tension").empty());
  EXPECT_TRUE(sample_picture(test_with({}), "Direct tension").empty());
}

PointRve rve()
{
  PointRve rve{"most damaged", 3, 1, {0.015, 0.012, 0.0}, 200, {}, {}};
  rve.grains = {{{0.01, 0.01, 0.0}, {0.0101, 0.01, 0.0}, 0.001, 0}, {{0.012, 0.01, 0.0}, {0.012, 0.01, 0.0}, 0.001, 1}};
  rve.cracks = {{CrackKind::tension, 4, 2, 9, 1e-4, {0.011, 0.01, 0.0}, {1.0, 0.0, 0.0}, 5e-4, 1e-3},
                {CrackKind::shear, 5, 0, 9, 1e-4, {0.011, 0.01, 0.0}, {0.0, 1.0, 0.0}, 5e-4, 1e-3}};
  return rve;
}

TEST(SamplePicture, MarksTheRvesThatAreDrawn)
{
  auto test = test_with(blocks(2));
  test.appearance.rves = {rve()};
  const auto sample = sample_picture(test, "Direct tension").at(0);
  const ChartSeries letters = sample.panels.at(0).series.back();
  EXPECT_EQ(letters.texts, std::vector<std::string>{"A"});
  EXPECT_NEAR(letters.points.at(0)[0], 15.0, 1e-9);
  EXPECT_NEAR(letters.points.at(0)[1], 12.6, 1e-9); // lifted by 0.06 mm, ten times
  const auto rves = rve_picture(test, "Direct tension").at(0);
  const Chart panel = rves.panels.at(0);
  EXPECT_EQ(panel.title, "A: most damaged");
  EXPECT_EQ(points_of(panel, "", ChartSeries::Kind::circles).size(), 1u);
  EXPECT_EQ(points_of(panel, "cut off").size(), 1u);
  // A crack stands across its normal.
  const auto tension = points_of(panel, "tension: 1").at(0);
  EXPECT_NEAR(tension.at(2), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(tension.at(3)), 0.5, 1e-9);
  EXPECT_EQ(broken_share(test.appearance.rves[0]), 0.01);
  EXPECT_EQ(standing_of(test.appearance.rves[0], test.appearance.fields), "(15.0, 12.0) mm");
}

/// Index as deal.II writes it, two times.
std::string index_of(const std::string& attributes)
{
  std::string grids;
  for (const int time : {2, 31})
    grids += fmt::format("<Grid Name=\"mesh\" GridType=\"Uniform\"><Time Value=\"{}\"/>\n<Geometry GeometryType=\"XY\">"
                         "<DataItem>\n  test.h5:/nodes\n</DataItem></Geometry><Topology><DataItem>test.h5:/cells"
                         "</DataItem></Topology>\n{}</Grid>\n",
                         time, attributes);
  return "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\"><Domain>\n"
         "<Grid Name=\"CellTime\" GridType=\"Collection\">" +
         grids + "</Grid></Domain></Xdmf>\n";
}

TEST(SampleFieldsFile, IsReadAsItLiesThere)
{
  const TemporaryFolder folder;
  const SampleFields wanted = blocks(2);
  std::vector<double> nodes, displacement, share, cell;
  std::vector<std::uint32_t> cells;
  for (std::size_t k = 0; k < 4; ++k)
    for (const std::uint32_t i : wanted.cells[k])
      {
        nodes.insert(nodes.end(), {wanted.nodes[i][0], wanted.nodes[i][1]});
        displacement.insert(displacement.end(), wanted.displacement[i].begin(), wanted.displacement[i].end());
        cells.push_back(i);
        cell.push_back(double(k));
        share.push_back(0.01 * double(k));
      }
  write_hdf5(folder.path() / "test.h5", [&](Hdf5Writer& root) {
    root.array("nodes", nodes, 2);
    root.array("cells", cells, 4);
  });
  const auto write_fields = [&](std::vector<double> shares) {
    write_hdf5(folder.path() / "test-0001.h5", [&](Hdf5Writer& root) {
      root.array("displacement", displacement, 3);
      root.array("broken_segments_share", shares);
      root.array("cell", cell);
    });
  };
  write_fields(share);
  std::string attributes;
  for (const char* name : {"displacement", "broken_segments_share", "cell"})
    attributes += fmt::format("<Attribute Name=\"{0}\" Center=\"Node\"><DataItem>\n test-0001.h5:/{0}\n</DataItem>"
                              "</Attribute>\n",
                              name);
  folder.write("test.xdmf", index_of(attributes));
  const SampleFields read = read_sample_fields(folder.path(), "test");
  EXPECT_EQ(read.n_rows, 31u);
  EXPECT_EQ(read.dimension, 2u);
  EXPECT_EQ(read.nodes, wanted.nodes);
  EXPECT_EQ(read.displacement, wanted.displacement);
  EXPECT_EQ(read.cells, wanted.cells);
  EXPECT_EQ(read.of_each_cell.at("broken_segments_share"), wanted.of_each_cell.at("broken_segments_share"));

  const auto objection = [&] { return tests::refusal([&] { read_sample_fields(folder.path(), "test"); }); };
  displacement.pop_back();
  write_fields(share);
  EXPECT_TRUE(has(objection(), "its arrays differ in length"));
  std::filesystem::remove(folder.path() / "test-0001.h5");
  EXPECT_TRUE(has(objection(), "test-0001.h5: cannot be read: No such file"));
  folder.write("test.xdmf", index_of(attributes).substr(0, 300));
  EXPECT_TRUE(has(objection(), "test.xdmf: not XDMF"));
  std::filesystem::remove(folder.path() / "test.xdmf");
  EXPECT_TRUE(has(objection(), "test.xdmf: cannot be read: No such file"));
}

TEST(ResultFolder, KeepsTheRvesOfASample)
{
  const TemporaryFolder folder;
  auto test = test_with({});
  test.record.curve.clear();
  test.appearance.rves = {rve()};
  write_result_folder({}, {test}, {}, folder.path());
  const auto all = read_result_folder(folder.path(), test_kinds());
  ASSERT_EQ(all.at(0).tests.at(0).appearance.rves.size(), 1u);
  const PointRve& read = all[0].tests[0].appearance.rves[0];
  const PointRve& was = test.appearance.rves[0];
  EXPECT_EQ(read.which, was.which);
  EXPECT_EQ(read.place(), "3:1");
  EXPECT_EQ(read.position, was.position);
  EXPECT_EQ(read.n_segments, was.n_segments);
  ASSERT_EQ(read.grains.size(), 2u);
  EXPECT_EQ(read.grains[1].fragment, 1u);
  EXPECT_EQ(read.grains[0].position, was.grains[0].position);
  ASSERT_EQ(read.cracks.size(), 2u);
  EXPECT_EQ(read.cracks[1].kind, CrackKind::shear);
  EXPECT_EQ(read.cracks[0].centroid, was.cracks[0].centroid);
  // A folder that lost them says so, and the test is there without them.
  std::filesystem::remove(folder.path() / "points/direct_tension_seed_1_cell_3_point_1_grains.csv");
  const auto without = read_result_folder(folder.path(), test_kinds());
  EXPECT_TRUE(without.at(0).tests.at(0).appearance.rves.empty());
  EXPECT_TRUE(has(tests::joined(without[0].problems), "point_1_grains.csv: cannot be read: No such file"));
}
} // namespace
} // namespace feldspar
