// The files for ParaView, opened by VTK as ParaView opens them.

#include "dem/lab/protocols/protocols.h"
#include "results/emission.h"
#include "results/folder/result_folder.h"
#include "results/sample_fields.h"
#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Half a unit in the last place of single precision.
constexpr double single = 6e-8;

/// Data that VTK reads at one time.
struct Piece
{
  double time;
  std::vector<double> points; ///< [3 n]
  std::size_t n_cells;
  std::string cell; ///< what the first one is
  std::map<std::string, std::vector<double>> arrays;
  std::map<std::string, std::size_t> n_components;

  std::set<std::string> names() const
  {
    std::set<std::string> all;
    for (const auto& [name, values] : arrays)
      all.insert(name);
    return all;
  }
};

/// Reads by Debian's Python, to which its VTK belongs.
std::vector<Piece> read_time_series(const fs::path& file)
{
  const TemporaryFolder folder;
  const Outcome read = run_command(
    folder, fmt::format("/usr/bin/python3 -I '" FELDSPAR_SOURCE_DIR "/tests/app/read_vtk.py' '{}'", file.string()));
  EXPECT_EQ(read.exit_code, 0) << read.error;
  std::vector<Piece> series;
  std::istringstream lines(read.output);
  for (std::string line; std::getline(lines, line);)
    {
      const auto json = nlohmann::json::parse(line);
      Piece piece{json["time"], json["points"], json["n_cells"], json["cell"], {}, {}};
      for (const auto& [name, array] : json["arrays"].items())
        {
          piece.arrays[name] = array["values"].get<std::vector<double>>();
          piece.n_components[name] = array["components"];
        }
      series.push_back(piece);
    }
  return series;
}

/// These files hold what the test left behind, as its tables do, in single precision.
void expect_grains(const std::vector<Piece>& series, const FinishedTest& test, const std::string& group)
{
  std::set<std::string> names{"axial_strain_percent", "axial_stress_Pa", "displacement_m", "fragment",
                              "n_broken_segments",    "radius_m",        "stress_Pa"};
  if (!group.empty())
    names.insert(group);
  const auto& grains = test.appearance.grains_at_end;
  const auto& last_row = test.record.curve.back();
  ASSERT_GE(series.size(), 2u);
  EXPECT_EQ(series.front().time, 0.0);
  EXPECT_NEAR(series.back().time, 100.0 * test.record.kind.strain(last_row), 1e-12); // the end is always there
  for (std::size_t k = 0; k < series.size(); ++k)
    {
      const Piece& at_time = series[k];
      ASSERT_EQ(at_time.points.size(), 3 * grains.size());
      EXPECT_EQ(at_time.n_cells, grains.size());
      EXPECT_EQ(at_time.names(), names);
      EXPECT_EQ(at_time.n_components.at("stress_Pa"), 9u); // a tensor
      EXPECT_EQ(at_time.arrays.at("axial_strain_percent"), std::vector{at_time.time});
      EXPECT_TRUE(k == 0 || at_time.time > series[k - 1].time);
      const auto& stress = at_time.arrays.at("stress_Pa");
      for (std::size_t i = 0; i < grains.size(); ++i)
        {
          const auto& grain = grains[i];
          EXPECT_NEAR(at_time.arrays.at("radius_m")[i], grain.radius, single * grain.radius);
          for (std::size_t c = 0; c < 3; ++c)
            {
              const double displacement = at_time.arrays.at("displacement_m")[3 * i + c];
              const double place = at_time.points[3 * i + c];
              EXPECT_NEAR(place - displacement, grain.start[c], single * (std::abs(place) + std::abs(displacement)));
            }
          EXPECT_EQ(stress[9 * i + 1], stress[9 * i + 3]);
          if (!group.empty())
            {
              EXPECT_EQ(at_time.arrays.at(group)[i], grain.group);
            }
        }
    }
  // The mean over grains of the same weight would not be the stress of the test, but has its sign and size.
  double axial = 0.0;
  const std::size_t along = test.record.dimension() == 2 ? 4 : 8;
  const auto loaded = std::max_element(series.begin(), series.end(), [](const Piece& a, const Piece& b) {
    return std::abs(a.arrays.at("axial_stress_Pa").front()) < std::abs(b.arrays.at("axial_stress_Pa").front());
  });
  for (std::size_t i = 0; i < grains.size(); ++i)
    axial += loaded->arrays.at("stress_Pa")[9 * i + along] / double(grains.size());
  const double of_test = loaded->arrays.at("axial_stress_Pa").front();
  EXPECT_GT(axial / of_test, 0.5);
  EXPECT_LT(axial / of_test, 1.5);
  for (std::size_t i = 0; i < grains.size(); ++i)
    {
      EXPECT_EQ(series.back().arrays.at("fragment")[i], grains[i].fragment);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(series.back().points[3 * i + c], grains[i].position[c], single * std::abs(grains[i].position[c]));
    }
  const auto& broken = series.back().arrays.at("n_broken_segments");
  EXPECT_GT(*std::max_element(broken.begin(), broken.end()), 0.0);
}

/// The cracks of a test at each time are those up to the row of the curve with that strain: lines or squares of their
/// size about their places.
void expect_cracks(const std::vector<Piece>& series, const TestRecord& record)
{
  ASSERT_GE(series.size(), 2u);
  // Else a reader that takes all cracks at all times would pass.
  EXPECT_LT(series.front().n_cells, series.back().n_cells);
  const bool in_space = record.dimension() == 3;
  const std::size_t n_corners = in_space ? 4 : 2;
  for (const Piece& at_time : series)
    {
      EXPECT_EQ(at_time.names(), (std::set<std::string>{"axial_strain_percent", "axial_stress_Pa", "is_shear", "normal",
                                                        "released_energy_J", "size_m", "step"}));
      const auto row = std::find_if(record.curve.begin(), record.curve.end(), [&](const CurveSample& sample) {
        return std::abs(100.0 * record.kind.sign * sample.axial_strain - at_time.time) < 1e-12 * at_time.time ||
               sample.axial_strain == at_time.time;
      });
      ASSERT_NE(row, record.curve.end()) << at_time.time;
      const auto n = std::size_t(std::count_if(record.cracks.begin(), record.cracks.end(),
                                               [&](const Crack& crack) { return crack.step <= row->step; }));
      ASSERT_EQ(at_time.n_cells, n);
      EXPECT_TRUE(n == 0 || at_time.cell == (in_space ? "vtkQuad" : "vtkLine")) << at_time.cell;
      for (std::size_t i = 0; i < n; ++i)
        {
          const Crack& crack = record.cracks[i];
          EXPECT_NEAR(at_time.arrays.at("size_m")[i], crack.size, single * crack.size);
          EXPECT_NEAR(at_time.arrays.at("released_energy_J")[i], crack.released_energy,
                      single * std::abs(crack.released_energy));
          EXPECT_EQ(at_time.arrays.at("is_shear")[i], double(crack.kind == CrackKind::shear));
          EXPECT_EQ(at_time.arrays.at("step")[i], double(crack.step));
          const auto corner = [&](const std::size_t k, const std::size_t c) {
            return at_time.points[3 * (n_corners * i + k) + c];
          };
          double side = 0.0;
          for (std::size_t c = 0; c < 3; ++c)
            {
              double middle = 0.0;
              for (std::size_t k = 0; k < n_corners; ++k)
                middle += corner(k, c) / double(n_corners);
              const double reach = std::abs(crack.centroid[c]) + crack.size;
              EXPECT_NEAR(middle, crack.centroid[c], single * reach);
              side += std::pow(corner(1, c) - corner(0, c), 2);
            }
          // Two places, each rounded once.
          const double reach = std::hypot(crack.centroid[0], crack.centroid[1], crack.centroid[2]) + crack.size;
          EXPECT_NEAR(std::sqrt(side), crack.size, 4.0 * single * reach);
          double leaning = 0.0; // of a side on the normal
          for (std::size_t c = 0; c < 3; ++c)
            leaning += (corner(1, c) - corner(0, c)) * crack.normal[c];
          EXPECT_NEAR(leaning, 0.0, 4.0 * single * reach);
        }
    }
}

/// The events of a test at each time are those that had begun, with the numbers of emission.csv.
void expect_events(const std::vector<Piece>& series, const TestRecord& record)
{
  ASSERT_GE(series.size(), 2u);
  EXPECT_LT(series.front().n_cells, series.back().n_cells);
  ASSERT_EQ(series.back().n_cells, record.events.size());
  for (const Piece& at_time : series)
    {
      ASSERT_EQ(at_time.points.size(), 3 * at_time.n_cells);
      EXPECT_EQ(at_time.n_components.at("moment_tensor_Nm"), 9u);
      for (std::size_t i = 0; i < at_time.n_cells; ++i)
        {
          const EmissionEvent& event = record.events[i];
          const SourceMechanism source = mechanism(event, record.dimension());
          const auto& tensor = at_time.arrays.at("moment_tensor_Nm");
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(at_time.points[3 * i + c], event.centroid[c], single * std::abs(event.centroid[c]));
          constexpr std::size_t place_of[] = {0, 1, 2, 4, 5, 8};
          for (std::size_t c = 0; c < 6; ++c)
            EXPECT_NEAR(tensor[9 * i + place_of[c]], event.moment[c], single * std::abs(event.moment[c]));
          EXPECT_EQ(tensor[9 * i + 1], tensor[9 * i + 3]);
          const std::map<std::string, double> expected{{"event", double(event.number)},
                                                       {"step", double(event.step)},
                                                       {"axial_strain", record.kind.sign * event.axial_strain},
                                                       {"time_s", event.time},
                                                       {"n_breaks", double(event.n_breaks())},
                                                       {"extent_m", event.extent},
                                                       {"energy_J", event.released_energy},
                                                       {"moment_Nm", source.scalar_moment},
                                                       {"magnitude", source.magnitude},
                                                       {"isotropic_share", source.isotropic},
                                                       {"clvd_share", source.clvd},
                                                       {"double_couple_share", source.double_couple}};
          for (const auto& [name, value] : expected)
            EXPECT_NEAR(at_time.arrays.at(name)[i], value, 2.0 * single * std::abs(value) + 1e-15) << name;
        }
    }
}

/// The script for ParaView, run with a stand-in for its functions: it opens the series and colours by what they have.
void expect_script(const fs::path& fields, const std::string& name)
{
  const TemporaryFolder folder;
  fs::create_directories(folder / "paraview");
  folder.write("paraview/__init__.py", "");
  folder.write("paraview/simple.py", R"(class Anything:
    def __init__(self, *arguments, **named): pass
    def __getattr__(self, name): return Anything()
    def __call__(self, *arguments, **named): return Anything()
def PVDReader(FileName): open(FileName).close(); print("opens", FileName.split("/")[-1]); return Anything()
def ColorBy(shown, array): print("colours", *array)
def Calculator(Input, Function, ResultArrayName): print("calculates", Function); return Anything()
GetActiveViewOrCreate = Glyph = Show = GetAnimationScene = ResetCamera = Render = Anything()
)");
  const std::string script = (fields / (name + "_paraview.py")).string();
  EXPECT_EQ(run_command(folder, "PYTHONPATH='" + folder.path().string() + "' /usr/bin/python3 '" + script + "'").output,
            fmt::format("opens {0}_grains.pvd\ncolours POINTS fragment\nopens {0}_cracks.pvd\ncolours CELLS is_shear\n"
                        "opens {0}_emission.pvd\ncalculates moment_Nm^(1/3)\ncolours POINTS isotropic_share\n",
                        name));
}

/// Runs rock.prm. `group`: what its groups of grains are called, if there are any.
void expect_fields(const TemporaryFolder& folder, const std::size_t least, const std::size_t most,
                   const std::string& group = "")
{
  run_to_end(folder, "lab rock.prm --output out --quiet");
  const fs::path out = folder / "out";
  const auto series = read_result_folder(out, test_kinds());
  ASSERT_FALSE(series.front().tests.empty());
  for (const auto& test : series.front().tests)
    {
      SCOPED_TRACE(test.name);
      const auto grains = read_time_series(out / "fields" / (test.name + "_grains.pvd"));
      EXPECT_GE(grains.size(), least);
      EXPECT_LE(grains.size(), most);
      expect_grains(grains, test, group);
      expect_cracks(read_time_series(out / "fields" / (test.name + "_cracks.pvd")), test.record);
      expect_events(read_time_series(out / "fields" / (test.name + "_emission.pvd")), test.record);
      expect_script(out / "fields", test.name);
    }
}

TEST(FieldFiles, OfAPlaneTestAreReadByVtk)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 14 mm", "Height = 28 mm") +
                             section("Tests", "List = uniaxial_compression", "Stop stress over peak = 0.7"));
  expect_fields(folder, 16, 32);
}

// Each clump is one body: its grains keep their distances, which they would not with the numbers of other grains.
TEST(FieldFiles, OfClumpsHaveTheNumbersOfTheirGroups)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 14 mm", "Height = 28 mm") +
                             section("Clumps", "Diameter = 4 mm") +
                             section("Tests", "List = uniaxial_compression", "Stop stress over peak = 0.7"));
  expect_fields(folder, 16, 32, "clump");
  const auto grains = read_time_series(folder / "out/fields/uniaxial_compression_seed_1_grains.pvd");
  const auto& groups = grains.back().arrays.at("clump");
  std::size_t n_pairs = 0;
  for (std::size_t i = 0; i < groups.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (groups[i] == groups[k])
        {
          const auto distance = [&](const Piece& at_time) {
            return std::hypot(at_time.points[3 * i] - at_time.points[3 * k],
                              at_time.points[3 * i + 1] - at_time.points[3 * k + 1]);
          };
          EXPECT_NEAR(distance(grains.back()), distance(grains.front()), 10.0 * single * 0.028);
          ++n_pairs;
        }
  EXPECT_GT(n_pairs, groups.size() / 2);
}

// Numbers of mineral grains are those in grains/.
TEST(FieldFiles, OfMineralGrainsHaveTheirNumbers)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 14 mm", "Height = 28 mm") +
                             section("Mineral grains", "Mean size = 5 mm") +
                             section("Smooth joint", "Tensile strength = 10 MPa", "Cohesion = 80 MPa") +
                             section("Tests", "List = direct_tension"));
  expect_fields(folder, 3, 32, "mineral_grain");
}

TEST(FieldFiles, OfATestInSpaceAreReadByVtk)
{
  const TemporaryFolder folder;
  folder.write(
    "rock.prm",
    section("Specimen", "Dimension = 3", "Shape = cylinder", "Width = 6 mm", "Height = 8 mm", "Porosity = 0.42") +
      section("Tests", "List = triaxial_compression", "Confinements = 10 MPa", "Compression strain rate = 8 1/s",
              "Compression sampling strain = 1e-4", "Stop strain over peak strain = 1.1"));
  expect_fields(folder, 3, 32);
}

/// The series holds each cell by its own nodes, and at its end what the report reads from the fields.
void expect_sample(const fs::path& folder, const std::string& test, const std::string& cell, const std::size_t n_nodes)
{
  const std::vector<Piece> series = read_time_series(folder / "fields" / (test + ".pvd"));
  ASSERT_GE(series.size(), 2u);
  const SampleFields fields = read_sample_fields(folder / "fields", test);
  const Piece& last = series.back();
  EXPECT_EQ(last.cell, cell);
  ASSERT_EQ(last.n_cells, fields.cells.size());
  EXPECT_GT(last.time, series.front().time);
  EXPECT_EQ(last.arrays.at("axial_strain_percent"), std::vector{last.time});
  EXPECT_EQ(last.n_components.at("displacement_m"), 3u);
  for (std::size_t k = 0; k < fields.cells.size(); ++k)
    for (std::size_t n = 0; n < n_nodes; ++n)
      for (std::size_t c = 0; c < 3; ++c)
        {
          const std::uint32_t node = fields.cells[k][n];
          const std::size_t place = 3 * (n_nodes * k + n) + c;
          EXPECT_NEAR(last.points[place], fields.nodes[node][c], single * 0.1);
          EXPECT_NEAR(last.arrays.at("displacement_m")[place], fields.displacement[node][c], single * 1e-3);
        }
}

double of_tensor(const Piece& piece, const std::string& name, const std::size_t cell, const std::size_t row,
                 const std::size_t column)
{
  EXPECT_EQ(piece.n_components.at(name), 9u) << name;
  return piece.arrays.at(name).at(9 * cell + 3 * row + column);
}

// In the plane and by the section of a cylinder four-sided, in space eight-cornered; stress is where its axes are.
TEST(FieldFiles, OfASampleAreReadByVtk)
{
  const TemporaryFolder folder;
  const std::string sample =
    section("Sample", "Width = 20 mm", "Height = 40 mm", "Elements along = 2", "Tension step = 1e-5") +
    section("Tests", "List = direct_tension", "Stop strain = 5e-5");
  const std::string elastic = sample + section("Sample", "Material = linear elasticity");
  folder.write("plane.prm", sample + section("Sample", "Elements across = 1", "Realisations = 1") +
                              section("Specimen", "Shape = periodic", "Width = 10 mm", "Height = 10 mm"));
  folder.write("section.prm", elastic + section("Sample", "Geometry = axisymmetric", "Elements across = 1"));
  folder.write("whole.prm", elastic + section("Sample", "Geometry = cylinder", "Elements across = 3"));
  const std::string test = "direct_tension_seed_1";
  struct Body
  {
    std::string name;
    const char* cell;
    unsigned int n_nodes;
  };
  for (const Body& body :
       {Body{"plane", "vtkQuad", 4}, Body{"section", "vtkQuad", 4}, Body{"whole", "vtkHexahedron", 8}})
    {
      const std::string& name = body.name;
      run_to_end(folder, fmt::format("multiscale {0}.prm --output {0} --quiet", name));
      expect_sample(folder / name, test, body.cell, body.n_nodes);
      const SampleFields fields = read_sample_fields(folder / name / "fields", test);
      const Piece last = read_time_series(folder / name / "fields" / (test + ".pvd")).back();
      const auto near = [&](const std::string& field, const std::string& tensor, const std::size_t row,
                            const std::size_t column) {
        const auto& values = fields.of_each_cell.at(field);
        double largest = 0.0;
        for (const double value : values)
          largest = std::max(largest, std::abs(value));
        for (std::size_t k = 0; k < values.size(); ++k)
          EXPECT_NEAR(of_tensor(last, tensor, k, row, column), values[k], single * largest) << name << field;
      };
      const std::string axial = name == "plane" ? "yy" : "zz";
      const std::size_t row = name == "whole" ? 2 : 1;
      near("stress_" + axial + "_Pa", "stress_Pa", row, row);
      near("strain_" + axial, "strain", row, row);
      if (std::string(name) == "section")
        {
          near("stress_rz_Pa", "stress_Pa", 0, 1);
          near("stress_tt_Pa", "stress_Pa", 2, 2);
        }
      else
        near("stress_xy_Pa", "stress_Pa", 1, 0);
      EXPECT_EQ(last.arrays.contains("broken_segments_share"), std::string(name) == "plane");
      EXPECT_TRUE(fs::exists(folder / name / "fields" / (test + "_paraview.py")));
    }
}
} // namespace
} // namespace feldspar::tests
