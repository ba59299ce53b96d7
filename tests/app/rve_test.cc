// A representative volume as a user strains it.

#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Some fifty grains.
const std::string small_cell = R"(subsection Specimen
  set Shape = periodic
  set Width = 12 mm
  set Height = 12 mm
end
)";

/// Some fifty spheres.
const std::string small_cell_in_space = R"(subsection Specimen
  set Dimension = 3
  set Shape = periodic
  set Width = 6 mm
  set Height = 6 mm
end
)";

const std::string along_file = "subsection Strain path\n  set File = path.csv\nend\n";

nlohmann::json summary_of(const fs::path& folder) { return nlohmann::json::parse(content(folder / "summary.json")); }

/// A table by columns.
std::map<std::string, std::vector<double>> read_table(const fs::path& file)
{
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');)
    names.push_back(name);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(stream, line))
    {
      std::istringstream cells(line);
      std::size_t k = 0;
      for (std::string cell; std::getline(cells, cell, ',');)
        columns[names.at(k++)].push_back(std::strtod(cell.c_str(), nullptr));
    }
  return columns;
}

TEST(Rve, AnswersAnIntactStrainByItsStiffness)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + along_file);
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n1e-5,0,0\n1e-5,3e-5,0\n1e-5,3e-5,-2e-5\n0,0,0\n");
  const auto outcome = run_feldspar(folder.path(), "rve cell.prm --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(outcome.output.find("nearest isotropic body"), std::string::npos) << outcome.output;
  for (const char* file : {"summary.json", "cracks.csv", "log.txt", "specimen.h5", "curves/rve.csv"})
    EXPECT_GT(fs::file_size(folder.path() / "out" / file), 50u) << file;

  const auto json = summary_of(folder.path() / "out");
  const auto& stiffness = json["stiffness_Pa"];
  auto table = read_table(folder.path() / "out/curves/rve.csv");
  // Steps of 1e-5 at most: 1 + 3 + 2 + 3, and the rest before them.
  ASSERT_EQ(table["strain_xx"].size(), 10u);
  const std::array<const char*, 3> names{"xx", "yy", "xy"};
  for (std::size_t row = 0; row < 10; ++row)
    for (std::size_t i = 0; i < 3; ++i)
      {
        double expected = 0.0;
        for (std::size_t j = 0; j < 3; ++j)
          expected += stiffness[i][j].get<double>() * (j < 2 ? 1.0 : 2.0) * // stiffness takes engineering shear
                      table[std::string("strain_") + names[j]][row];
        EXPECT_NEAR(table[std::string("stress_") + names[i] + "_Pa"][row], expected, 1e-3); // of some 1e6 Pa
      }
  EXPECT_EQ(table["n_tension_cracks"].back(), 0.0);
  EXPECT_EQ(table["boundary_work_J"].back(), 0.0);
  EXPECT_EQ(json["rves"][0]["n_grains"], 54);
}

TEST(Rve, GoesAlongMixedPaths)
{
  const TemporaryFolder folder;
  // The same pull by a direction and by a file, both with the sides free.
  folder.write("direction.prm", small_cell + "subsection Strain path\n  set Direction = free, 1, free\n"
                                             "  set Size = 3e-4\nend\nsubsection Seeds\n  set Seeds = 2, 1\nend\n");
  folder.write("file.prm", small_cell + along_file);
  folder.write("path.csv", "stress_xx_Pa,strain_yy,stress_xy_Pa\n0,3e-4,0\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve direction.prm --output direction").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "rve file.prm --output file").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "direction/curves/rve_seed_1.csv"), content(folder.path() / "file/curves/rve.csv"));
  auto table = read_table(folder.path() / "file/curves/rve.csv");
  const double peak = *std::max_element(table["stress_yy_Pa"].begin(), table["stress_yy_Pa"].end());
  EXPECT_GT(peak, 5e6);
  EXPECT_GT(table["n_tension_cracks"].back(), 5.0);
  EXPECT_LT(table["stress_yy_Pa"].back(), 0.5 * peak);
  for (std::size_t row = 0; row < table["stress_xx_Pa"].size(); ++row)
    EXPECT_LE(std::abs(table["stress_xx_Pa"][row]), 1e-5 * peak); // the final tolerance, over what the grains carry
  const std::string cracks = content(folder.path() / "file/cracks.csv");
  EXPECT_EQ(std::count(cracks.begin(), cracks.end(), '\n') - 1,
            int(table["n_tension_cracks"].back() + table["n_shear_cracks"].back()));
}

// Turned by a quarter the cell stands with its x axis along y: pulled along y it responds as it does along x unturned.
// Turned by a half it is the cell again. By 30 degrees it is another body.
TEST(Rve, ATurnedCellIsPulledInTheAxesOfThePath)
{
  const TemporaryFolder folder;
  const auto pull = [&](const std::string& name, const std::string& direction, const std::string& angle) {
    folder.write(name + ".prm", small_cell + "subsection Strain path\n  set Direction = " + direction +
                                  "\n  set Size = 1.5e-4\n  set Cell angle = " + angle + " deg\nend\n");
    const auto outcome = run_feldspar(folder.path(), "rve " + name + ".prm --quiet --output " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    return read_table(folder.path() / name / "curves/rve.csv");
  };
  auto along_x = pull("along_x", "1, free, free", "0");
  auto along_y = pull("along_y", "free, 1, free", "0");
  auto quarter = pull("quarter", "free, 1, free", "90");
  auto half = pull("half", "free, 1, free", "180");
  auto oblique = pull("oblique", "free, 1, free", "30");
  const auto highest = [](const std::vector<double>& stress) {
    return *std::max_element(stress.begin(), stress.end());
  };
  const double peak_x = highest(along_x["stress_xx_Pa"]);
  const double peak_y = highest(along_y["stress_yy_Pa"]);
  // Equal but for the order of sums; the forces balance to 1e-6.
  EXPECT_NEAR(highest(quarter["stress_yy_Pa"]), peak_x, 1e-5 * peak_x);
  EXPECT_NEAR(highest(half["stress_yy_Pa"]), peak_y, 1e-5 * peak_y);
  EXPECT_EQ(quarter["n_tension_cracks"].back(), along_x["n_tension_cracks"].back());
  EXPECT_GT(std::abs(highest(oblique["stress_yy_Pa"]) - peak_y), 1e-3 * peak_y);

  folder.write("explicit.prm", small_cell + "subsection Strain path\n  set Direction = free, 1, free\n"
                                            "  set Cell angle = 30 deg\n  set Solver = explicit\nend\n");
  const auto outcome = run_feldspar(folder.path(), "rve explicit.prm --output explicit");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("Strain path/Cell angle: needs Solver = event by event"), std::string::npos)
    << outcome.error;
}

TEST(Rve, GivesTheValuesOfVariantsWithTheirUnits)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + "subsection Strain path\n  set Direction = 0, 1, 0\n  set Size = 1e-5\nend\n"
                                        "subsection Variants\n  set Entry = Strain path/Cell angle\n"
                                        "  set Values = 0 deg; 30 deg\nend\n");
  const auto run = run_feldspar(folder.path(), "rve cell.prm --output out --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto rves = summary_of(folder.path() / "out")["rves"];
  ASSERT_EQ(rves.size(), 2u);
  EXPECT_EQ(rves[1]["variant_values"]["Strain path/Cell angle"], (nlohmann::json{{"value", 30}, {"unit", "deg"}}));
}

// The order of the stiffnesses as the theory has it (§9.6); the bounds in every summary are those of the extreme boundaries.
TEST(Rve, HoldsACellByEachBoundary)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + "subsection Strain path\n  set Direction = 0, 1, 0\n  set Size = 1e-5\nend\n"
                                        "subsection Variants\n  set Entry = Representative volume/Boundary\n"
                                        "  set Values = minimal kinematic; weakly periodic; edge; periodic; affine\n"
                                        "end\n");
  const auto run = run_feldspar(folder.path(), "rve cell.prm --output out --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto rves = summary_of(folder.path() / "out")["rves"];
  ASSERT_EQ(rves.size(), 5u);
  const std::vector<std::string> names{"minimal kinematic", "weakly periodic, 4 pieces", "edge, x free", "periodic",
                                       "affine"};
  std::vector<double> stresses;
  for (std::size_t k = 0; k < rves.size(); ++k)
    {
      EXPECT_EQ(rves[k]["boundary"], names[k]);
      EXPECT_EQ(rves[k]["n_grains"], rves[3]["n_grains"]);
      EXPECT_EQ(rves[k]["n_joints"], rves[3]["n_joints"]);
      EXPECT_EQ(rves[k]["stiffness_minimal_kinematic_Pa"], rves[0]["stiffness_Pa"]);
      EXPECT_EQ(rves[k]["stiffness_affine_Pa"], rves[4]["stiffness_Pa"]);
      stresses.push_back(rves[k]["at_end"]["stress_yy_Pa"]);
      EXPECT_NEAR(stresses.back(), rves[k]["stiffness_Pa"][1][1].get<double>() * 1e-5, 1e-9 * stresses.back());
    }
  EXPECT_LT(stresses[0], stresses[1]);
  EXPECT_LT(stresses[1], stresses[3]);
  EXPECT_LT(stresses[2], stresses[3]);
  EXPECT_LT(stresses[3], stresses[4]);
}

TEST(Rve, TakesSpheres)
{
  const TemporaryFolder folder;
  const std::array<const char*, 6> names{"xx", "yy", "zz", "yz", "xz", "xy"};
  folder.write("cell.prm", small_cell_in_space + along_file);
  folder.write("path.csv", "strain_xx,strain_yy,strain_zz,strain_yz,strain_xz,strain_xy\n"
                           "1e-5,0,2e-5,-1e-5,0,5e-6\n0,1e-5,-1e-5,0,1e-5,0\n");
  const auto outcome = run_feldspar(folder.path(), "rve cell.prm --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const auto json = summary_of(folder.path() / "out");
  auto table = read_table(folder.path() / "out/curves/rve.csv");
  ASSERT_GT(table["strain_zz"].size(), 3u);
  for (std::size_t row = 0; row < table["strain_zz"].size(); ++row)
    for (std::size_t i = 0; i < 6; ++i)
      {
        double expected = 0.0;
        for (std::size_t j = 0; j < 6; ++j)
          expected += json["stiffness_Pa"][i][j].get<double>() * (j < 3 ? 1.0 : 2.0) * // engineering shear
                      table[std::string("strain_") + names[j]][row];
        EXPECT_NEAR(table[std::string("stress_") + names[i] + "_Pa"][row], expected, 1e-3); // of some 1e6 Pa
      }
  EXPECT_EQ(json["rves"][0]["fabric"].size(), 3u);

  // Pulled with its sides free until it cracks, which happens across the pull.
  folder.write("pull.prm", small_cell_in_space +
                             "subsection Strain path\n  set Direction = free, free, 1, free, free, free\n"
                             "  set Size = 3e-4\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve pull.prm --output pull").exit_code, 0);
  table = read_table(folder.path() / "pull/curves/rve.csv");
  const double peak = *std::max_element(table["stress_zz_Pa"].begin(), table["stress_zz_Pa"].end());
  EXPECT_GT(peak, 5e6);
  for (const char* side : {"xx", "yy", "yz", "xz", "xy"})
    for (const double stress : table[std::string("stress_") + side + "_Pa"])
      EXPECT_LE(std::abs(stress), 1e-5 * peak); // the final tolerance, over what the grains carry
  auto cracks = read_table(folder.path() / "pull/cracks.csv");
  ASSERT_EQ(double(cracks["normal_z"].size()), table["n_tension_cracks"].back() + table["n_shear_cracks"].back());
  ASSERT_GT(cracks["normal_z"].size(), 5u);
  const auto orientation = summary_of(folder.path() / "pull")["rves"][0]["at_end"]["crack_orientation_per_m"];
  EXPECT_GT(orientation[2][2].get<double>(), orientation[0][0].get<double>() + orientation[1][1].get<double>());
}

TEST(Rve, TakesFlaws)
{
  // The sides of a closed flaw have no bond: pulled apart they carry what a saw cut of no width carries, nothing.
  // Pressed together they carry as before, but for what they slip along the grains.
  const TemporaryFolder folder;
  const std::string cell =
    "subsection Specimen\n  set Shape = periodic\n  set Width = 20 mm\n  set Height = 20 mm\nend\n"
    "subsection Variants\n  set Entry = Flaws/Shapes\n  set Values = none; "
    "slot from 5, 10 mm to 15, 10 mm width 0 mm; closed flaw from 5, 10 mm to 15, 10 mm; "
    "hole centre 10, 10 mm radius 3 mm\nend\n";
  const char* const none = "none";
  const char* const cut = "slot_from_5_10_mm_to_15_10_mm_width_0_mm";
  const char* const closed = "closed_flaw_from_5_10_mm_to_15_10_mm";
  const char* const hole = "hole_centre_10_10_mm_radius_3_mm";
  const auto stress = [&](const std::string& path, const char* flaws) {
    return std::abs(
      read_table(folder.path() / path / fmt::format("curves/rve_shapes_{}.csv", flaws))["stress_yy_Pa"].back());
  };
  folder.write("pulled.prm",
               cell + "subsection Strain path\n  set Direction = free, 1, free\n  set Size = 5e-5\nend\n");
  folder.write("pressed.prm", cell + "subsection Strain path\n  set Direction = 0, -1, 0\n  set Size = 5e-5\nend\n");
  for (const char* const path : {"pulled", "pressed"})
    {
      const auto run = run_feldspar(folder.path(), fmt::format("rve {0}.prm --output {0} --quiet", path));
      ASSERT_EQ(run.exit_code, 0) << run.error;
      // The hole takes 28 mm² out of 400 mm².
      const auto rves = summary_of(folder.path() / path)["rves"];
      ASSERT_EQ(rves.size(), 4u);
      const double n_grains = rves[0]["n_grains"];
      EXPECT_NEAR(rves[3]["n_grains"].get<double>() / n_grains, 1.0 - 28.3 / 400.0, 0.02);
      EXPECT_EQ(rves[2]["n_joints"], rves[0]["n_joints"]);
      EXPECT_LT(rves[1]["n_joints"], rves[0]["n_joints"]);
      EXPECT_LT(stress(path, hole), 0.9 * stress(path, none));
    }
  EXPECT_LT(stress("pulled", cut), 0.8 * stress("pulled", none));
  EXPECT_NEAR(stress("pulled", closed), stress("pulled", cut), 1e-3 * stress("pulled", cut));
  EXPECT_NEAR(stress("pressed", closed), stress("pressed", none), 0.03 * stress("pressed", none));

  folder.write("smooth.prm",
               small_cell + "subsection Flaws\n  set Shapes = closed flaw from 2, 6 mm to 9, 6 mm smooth\nend\n");
  const auto refused = run_feldspar(folder.path(), "rve smooth.prm --output smooth");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.error.find("puts in smooth joints, which need Specimen/Shape = box or cylinder"), std::string::npos)
    << refused.error;
  EXPECT_FALSE(fs::exists(folder.path() / "smooth"));
}

TEST(Rve, IsConfinedBeforeItIsStrained)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + "subsection Strain path\n  set Direction = free, -1, free\n  set Size = 1e-4\n"
                                        "  set Confining pressure = 20 MPa\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve cell.prm --output out").exit_code, 0);
  auto table = read_table(folder.path() / "out/curves/rve.csv");
  // The pressure first on both sides, then the strain beside it.
  std::size_t confined = 0;
  while (std::abs(table["stress_xx_Pa"][confined] + 20e6) > 20.0)
    ASSERT_LT(++confined, table["stress_xx_Pa"].size());
  EXPECT_NEAR(table["stress_yy_Pa"][confined], -20e6, 20.0);
  EXPECT_NEAR(table["strain_yy"].back() - table["strain_yy"][confined], -1e-4, 1e-15);
  EXPECT_NEAR(table["stress_xx_Pa"].back(), -20e6, 20.0);
  EXPECT_LT(table["stress_yy_Pa"].back(), -26e6);
}

TEST(Rve, TellsAMistakeInOneLineAndLeavesNothing)
{
  const std::string free_sides = "subsection Strain path\n  set Direction = free, 1, free\nend\n";
  const auto expect = [&](const std::string& command, const std::string& prm, const std::string& csv,
                          const std::string& error) {
    const TemporaryFolder folder;
    folder.write("bad.prm", prm);
    folder.write("path.csv", csv);
    const auto outcome = run_feldspar(folder.path(), command + " bad.prm --output out");
    EXPECT_EQ(outcome.exit_code, 2) << prm;
    EXPECT_EQ(outcome.error.find("feldspar: " + error), 0u) << "found: " << outcome.error << "wanted: " << error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_FALSE(fs::exists(folder.path() / "out"));
  };
  const std::string bad_header = "path.csv:1: the header is \"";
  expect("rve", small_cell + along_file, "strain_xx,strain_yy\n0,1e-4\n", bad_header);
  expect("rve", small_cell + along_file, "strain_yy,strain_xx,strain_zz\n0,1e-4,0\n", bad_header);
  expect("rve", small_cell + along_file, "strain_xx,strain_yy,strain_xy\n0,1e-4\n", "path.csv:2: there must be 3");
  expect("rve", small_cell + along_file, "strain_xx,strain_yy,strain_xy\n0,inf,0\n",
         "path.csv:2: strain_yy: \"inf\" is not a decimal number");
  expect("rve", small_cell + along_file, "strain_xx,strain_yy,strain_xy\n0,0.2,0\n",
         "path.csv: point 1: strain_yy = 0.2: must lie in [-0.1, 0.1]\n");
  expect("rve", small_cell + along_file, "strain_xx,strain_yy,strain_xy,stress_yy_Pa\n0,0,0,0\n",
         "path.csv:1: strain_yy and stress_yy_Pa are both given");
  expect("rve", small_cell, "", "bad.prm: Strain path/File: is missing");
  expect("rve", small_cell + "subsection Strain path\n  set Direction = 5, 0, 0\n  set Size = 0.1\nend\n", "",
         "bad.prm: Strain path/Size: times 5 of Direction is a strain of 0.5; a cell takes strains of at most 0.1");
  expect("rve", small_cell + "subsection Strain path\n  set Direction = free, 1, free\n  set File = path.csv\nend\n",
         "", "bad.prm: Strain path/Direction: excludes File");
  expect("rve", small_cell_in_space + free_sides, "",
         "bad.prm:8: Strain path/Direction = free, 1, free: has 3 components; in 3 dimensions there must be 6: xx, yy");
  expect("rve", small_cell_in_space + along_file, "strain_xx,strain_yy,strain_xy\n0,1e-4,0\n", bad_header);
  expect("rve", free_sides, "", "bad.prm: Specimen/Shape = box: a representative volume needs Shape = periodic");
  expect("rve", "subsection Specimen\n  set Shape = periodic\n  set Width = 4 mm\nend\n" + free_sides, "",
         "bad.prm:3: Specimen/Width = 4 mm: must be at least 4.1168 mm");
  expect("rve",
         small_cell + "subsection Strain path\n  set Direction = free, 1, free\n  set Largest step = 1e-20\nend\n", "",
         "bad.prm: Strain path/Largest step = 1e-20: Size = ");
  const std::string held = "subsection Representative volume\n";
  expect("rve", small_cell + free_sides + held + "  set Boundary = edge\n  set Free axis = z\nend\n", "",
         "bad.prm: Representative volume/Free axis = z: in two dimensions it is x or y");
  const std::string clumps = "subsection Clumps\n  set Diameter = 4 mm\nend\n";
  expect("rve", free_sides + clumps, "",
         "bad.prm: Clumps/Diameter = 4 mm: a representative volume takes none; set Diameter = none");
  expect("rve", small_cell + free_sides + clumps, "",
         "bad.prm:10: Clumps/Diameter = 4 mm: clumps are in a box, and Specimen/Shape is periodic: a representative "
         "volume takes none, set Diameter = none");
  expect("rve", small_cell + free_sides + held + "  set Boundary = rigid\nend\n", "",
         "bad.prm:10: Representative volume/Boundary = rigid: must be periodic or minimal kinematic or weakly "
         "periodic or edge or affine");
  expect("rve", small_cell + free_sides + held + "  set Traction pieces = 0\nend\n", "",
         "bad.prm:10: Representative volume/Traction pieces = 0: must be an integer in [1, 1000]");
  expect("rve",
         small_cell + held +
           "  set Boundary = affine\nend\nsubsection Strain path\n  set Direction = free, 1, free\n"
           "  set Solver = explicit\nend\n",
         "", "bad.prm: Representative volume/Boundary = affine: explicit dynamics have periodic cells only; set ");
  expect("lab", small_cell, "", "bad.prm: Specimen/Shape = periodic: a laboratory test needs a specimen between walls");
}

TEST(Rve, RefusesAnRveThatNothingHolds)
{
  const TemporaryFolder folder;
  folder.write("apart.txt", "0.002 0.002 0.001\n0.007 0.007 0.001\n");
  folder.write("apart.prm",
               "subsection Specimen\n  set Shape = periodic\n  set Width = 10 mm\n  set Height = 10 mm\n"
               "  set Packing file = apart.txt\nend\nsubsection Flat joint\n  set Installation gap ratio = 0\nend\n"
               "subsection Strain path\n  set Direction = free, 1, free\nend\n");
  const auto outcome = run_feldspar(folder.path(), "rve apart.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error.find("feldspar: Flat joint/Installation gap ratio: joins no two grains"), 0u)
    << outcome.error;
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
}

TEST(Rve, TakesSpecimensOfItsKindOnly)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell);
  folder.write("box.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 12 mm\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "specimen cell.prm --output cell").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "specimen box.prm --output box").exit_code, 0);
  const std::string path = "subsection Strain path\n  set Direction = 0, 1, 0\n  set Size = 1e-5\nend\n";
  const auto with = [&](const std::string& file) {
    return "subsection Specimen\n  set Specimen file = " + file + "/specimen.h5\nend\n" + path;
  };
  folder.write("with_cell.prm", with("cell"));
  folder.write("with_box.prm", with("box"));
  EXPECT_EQ(run_feldspar(folder.path(), "rve with_cell.prm --output good").exit_code, 0);
  for (const auto& [arguments, error] :
       {std::pair("rve with_box.prm --output bad", "is a specimen between walls; a representative volume needs"),
        std::pair("lab with_cell.prm --output bad", "is a periodic cell; a laboratory test needs")})
    {
      const auto outcome = run_feldspar(folder.path(), std::string(arguments) + " --quiet");
      EXPECT_EQ(outcome.exit_code, 2);
      EXPECT_NE(outcome.error.find(error), std::string::npos) << outcome.error;
      EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
      EXPECT_FALSE(fs::exists(folder.path() / "bad"));
    }
}

/// Some fifty grains pulled apart with their sides free.
std::string pulled(const std::string& more)
{
  return small_cell + "subsection Strain path\n  set Direction = free, 1, free\n  set Size = 2e-4\n" + more + "end\n";
}
const std::string by_dynamics = "  set Solver = explicit\n  set Steps per millistrain = 100000\n";

TEST(Rve, GoesItsPathByExplicitDynamicsToo)
{
  const TemporaryFolder folder;
  folder.write("events.prm", pulled("  set Solver = event by event\n"));
  folder.write("explicit.prm", pulled(by_dynamics));
  ASSERT_EQ(run_feldspar(folder.path(), "rve events.prm --output events").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "rve explicit.prm --output explicit").exit_code, 0);
  for (const char* file : {"summary.json", "cracks.csv", "log.txt", "specimen.h5", "curves/rve.csv"})
    EXPECT_GT(fs::file_size(folder.path() / "explicit" / file), 50u) << file;

  const auto by_events = read_table(folder.path() / "events/curves/rve.csv");
  const auto table = read_table(folder.path() / "explicit/curves/rve.csv");
  const auto peak = [](const auto& of) {
    return *std::max_element(of.at("stress_yy_Pa").begin(), of.at("stress_yy_Pa").end());
  };
  EXPECT_NEAR(peak(table), peak(by_events), 0.05 * peak(by_events)); // what the rate leaves, and samples 1e-5 apart
  EXPECT_EQ(table.at("strain_yy").size(), 21u);
  EXPECT_NEAR(table.at("strain_yy").back(), 2e-4, 1e-15);
  for (std::size_t row = 0; row < table.at("strain_yy").size(); ++row)
    {
      EXPECT_LT(std::abs(table.at("stress_xx_Pa")[row]), 0.05 * peak(table)) << row; // also as the crack runs
      EXPECT_LT(table.at("energy_imbalance")[row], 0.01) << row; // forces jump within a step: as in the laboratory
    }
  const auto rve = summary_of(folder.path() / "explicit")["rves"][0];
  EXPECT_LT(rve["energy_imbalance"].get<double>(), 0.01);
  const std::string cracks = content(folder.path() / "explicit/cracks.csv");
  EXPECT_EQ(std::count(cracks.begin(), cracks.end(), '\n') - 1,
            int(table.at("n_tension_cracks").back() + table.at("n_shear_cracks").back()));
  EXPECT_GT(rve["at_end"]["crack_area_share"].get<double>(), 0.01);
  EXPECT_EQ(rve["at_end"]["n_tension_cracks"].get<double>(), table.at("n_tension_cracks").back());
}

// A table may begin at rest, where forces and energies are round-off: what they miss of each other is no imbalance.
TEST(Rve, CountsNoErrorsBeforeAPathSetsOff)
{
  const TemporaryFolder folder;
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n0,0,0\n0,2e-5,0\n");
  folder.write("rest.prm", small_cell + "subsection Strain path\n  set File = path.csv\n" + by_dynamics + "end\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve rest.prm --output out").exit_code, 0);
  EXPECT_EQ(read_table(folder.path() / "out/curves/rve.csv").at("strain_yy").at(1), 0.0);
  const auto rve = summary_of(folder.path() / "out")["rves"][0];
  EXPECT_LT(rve["energy_imbalance"].get<double>(), 1e-6);
  EXPECT_LT(rve["boundary_stress_error"].get<double>(), 1e-2);
}

TEST(Rve, TakesBondsThatSoftenEventByEventAndByExplicitDynamics)
{
  const TemporaryFolder folder;
  const std::string law = "subsection Specimen\n  set Joint law = softening flat joint\nend\n"
                          "subsection Softening flat joint\n  set Softening opening = 1 um\nend\n";
  folder.write("softening.prm", pulled(by_dynamics) + law);
  folder.write("events.prm", pulled("") + law);
  folder.write("brittle.prm", pulled(by_dynamics));
  const auto highest = [&](const std::string& name) {
    const auto run = run_feldspar(folder.path(), "rve " + name + ".prm --output " + name);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    const auto stress = read_table(folder.path() / name / "curves/rve.csv").at("stress_yy_Pa");
    return *std::max_element(stress.begin(), stress.end());
  };
  const double softening = highest("softening");
  EXPECT_GT(softening, 1.1 * highest("brittle")) << "bonds beside one that softens share its stress";
  EXPECT_NEAR(highest("events"), softening, 0.03 * softening); // the saw, and motion
  for (const auto& [name, largest] : {std::pair("softening", 0.01), std::pair("events", 1e-4)})
    {
      const auto curve = read_table(folder.path() / name / "curves/rve.csv");
      for (const double imbalance : curve.at("energy_imbalance"))
        EXPECT_LT(imbalance, largest) << name;
    }
}

TEST(Rve, GivesTheSameBitsForAnyNumberOfThreads)
{
  const TemporaryFolder folder;
  for (const std::string solver : {"  set Solver = event by event\n", by_dynamics.c_str()})
    {
      folder.write("cell.prm", pulled(solver) + "subsection Seeds\n  set Seeds = 1, 2\nend\n");
      for (const char* threads : {"1", "2"})
        {
          const auto outcome = run_feldspar(
            folder.path(), fmt::format("rve cell.prm --output {0} --threads {0} --force --quiet", threads));
          ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
        }
      for (const char* file : {"cracks.csv", "curves/rve_seed_1.csv", "curves/rve_seed_2.csv"})
        EXPECT_EQ(content(folder.path() / "1" / file), content(folder.path() / "2" / file)) << solver << file;
      EXPECT_GT(content(folder.path() / "1/cracks.csv").size(), 500u) << solver;
    }
}

TEST(Rve, InterruptedAndResumedGivesTheBitsOfTheUnbrokenRun)
{
  const TemporaryFolder folder;
  // Increments so small that there are many moments to stop at.
  for (const std::string& solver :
       {std::string("  set Largest step = 3e-8\n"),
        std::string("  set Largest step = 2e-7\n  set Solver = explicit\n  set Steps per millistrain = 400000\n")})
    {
      folder.write("cell.prm", pulled(solver));
      ASSERT_EQ(run_feldspar(folder.path(), "rve cell.prm --output whole --force --quiet").exit_code, 0);
      fs::remove_all(folder.path() / "broken");
      const auto checkpoint = folder.path() / "broken/checkpoints/rve.h5";
      const auto is_complete = [&] {
        return content(folder.path() / "broken/run.json").find("\"complete\": true") != std::string::npos;
      };
      // Until it is stopped on its path, which begins after the specimen is made: later where it had not begun, earlier where
      // it had ended. On a busy machine neither takes the same time twice, so that the two moments are moved apart again.
      double early = 0.0;
      double late = 60.0;
      double time = 0.1;
      for (int k = 0; k < 100 && !fs::exists(checkpoint); ++k)
        {
          run_feldspar(folder.path(), "rve cell.prm --output broken --force --quiet",
                       fmt::format("timeout --foreground --signal=INT {}", time));
          (is_complete() ? late : early) = time;
          if (late - early < 0.02 * late)
            {
              early *= 0.9;
              late *= 1.1;
            }
          time = late < 60.0 ? 0.5 * (early + late) : 1.15 * time;
        }
      ASSERT_TRUE(fs::exists(checkpoint)) << solver;
      const auto n_rows_before = read_table(folder.path() / "broken/curves/rve.csv")["strain_yy"].size();
      ASSERT_EQ(run_feldspar(folder.path(), "rve --resume broken --quiet").exit_code, 0);
      EXPECT_GT(read_table(folder.path() / "broken/curves/rve.csv")["strain_yy"].size(), n_rows_before);
      for (const char* file : {"cracks.csv", "curves/rve.csv"})
        EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "broken" / file)) << solver << file;
      EXPECT_FALSE(fs::exists(folder.path() / "broken/checkpoints"));
    }
}

TEST(Rve, InterruptedInGenesisKeepsTheSpecimensThatAreFinished)
{
  const TemporaryFolder folder;
  // A thousand grains a cell take a second or more; one cell at a time.
  const std::string cells =
    "subsection Specimen\n  set Shape = periodic\n  set Width = 45 mm\n  set Height = 45 mm\nend\n"
    "subsection Seeds\n  set Seeds = 1, 2\nend\n"
    "subsection Strain path\n  set Direction = free, 1, 0\n  set Size = 2e-5\nend\n";
  folder.write("cells.prm", cells);
  folder.write("interrupt", "\"$@\" &\n"
                            "until [ -e out/specimen_seed_1.h5 ]; do sleep 0.02; done\n"
                            "kill -TERM $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "rve cells.prm --output out --quiet --threads 1", "sh ./interrupt");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar rve --resume out\n");
  ASSERT_TRUE(fs::exists(folder.path() / "out/specimen_seed_1.h5"));
  EXPECT_FALSE(fs::exists(folder.path() / "out/specimen_seed_2.h5"));
  EXPECT_FALSE(fs::exists(folder.path() / "out/summary.json"));
  const std::string kept = content(folder.path() / "out/specimen_seed_1.h5");

  // A specimen that was damaged meanwhile is made anew.
  fs::resize_file(folder.path() / "out/specimen_seed_1.h5", kept.size() / 2);
  const auto resumed = run_feldspar(folder.path(), "rve --resume out --quiet");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_NE(resumed.error.find("specimen_seed_1.h5"), std::string::npos) << resumed.error;
  EXPECT_NE(resumed.error.find("making it anew"), std::string::npos) << resumed.error;
  ASSERT_EQ(run_feldspar(folder.path(), "rve cells.prm --output whole --quiet").exit_code, 0);
  for (const char* file : {"cracks.csv", "curves/rve_seed_1.csv", "curves/rve_seed_2.csv"})
    EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "out" / file)) << file;
}

/// Interrupted once there is a checkpoint; the interrupt writes one more.
const std::string interrupt_on_path = "\"$@\" &\n"
                                      "until [ -e broken/checkpoints/rve.h5 ]; do sleep 0.01; done\n"
                                      "kill -INT $!\nwait $!\n";

TEST(Rve, ADamagedCheckpointIsRefusedAndTheOneBeforeItUsed)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", pulled("  set Largest step = 1e-8\n"));
  ASSERT_EQ(run_feldspar(folder.path(), "rve cell.prm --output whole --quiet").exit_code, 0);
  folder.write("interrupt", interrupt_on_path);
  ASSERT_EQ(run_feldspar(folder.path(), "rve cell.prm --output broken --quiet", "sh ./interrupt").exit_code, 130);
  const fs::path newest = folder.path() / "broken/checkpoints/rve.h5";
  ASSERT_TRUE(fs::exists(newest) && fs::exists(folder.path() / "broken/checkpoints/rve.previous.h5"));
  fs::resize_file(newest, fs::file_size(newest) / 2);
  const auto resumed = run_feldspar(folder.path(), "rve --resume broken --quiet");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_NE(resumed.error.find("rve.h5: damaged or cut short"), std::string::npos) << resumed.error;
  EXPECT_NE(resumed.error.find("going back to the checkpoint before it"), std::string::npos) << resumed.error;
  EXPECT_EQ(std::count(resumed.error.begin(), resumed.error.end(), '\n'), 1) << resumed.error;
  for (const char* file : {"cracks.csv", "curves/rve.csv"})
    EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "broken" / file)) << file;
}

TEST(Rve, AFullDiskIsSaidInOneLineAndTheRunCanGoOn)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", pulled("  set Largest step = 3e-8\n"));
  ASSERT_EQ(run_feldspar(folder.path(), "rve cell.prm --output whole --quiet").exit_code, 0);
  // A limit on the size of files stands for the full disk: the specimen is within it, the curve of the whole path is not.
  const auto limit = fs::file_size(folder.path() / "whole/curves/rve.csv") - 1;
  ASSERT_GT(limit, fs::file_size(folder.path() / "whole/specimen.h5"));
  const auto outcome =
    run_feldspar(folder.path(), "rve cell.prm --output full --quiet", fmt::format("prlimit --fsize={}", limit));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_NE(outcome.error.find("cannot be written: File too large"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("go on with: feldspar rve --resume full"), std::string::npos) << outcome.error;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "full"))
    EXPECT_NE(entry.path().extension(), ".unfinished") << entry.path();
  const auto resumed = run_feldspar(folder.path(), "rve --resume full --quiet");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_EQ(resumed.error, "");
  for (const char* file : {"cracks.csv", "curves/rve.csv"})
    EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "full" / file)) << file;
}

TEST(Rve, SaysWhenExplicitDynamicsCannotHoldAStress)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + "subsection Strain path\n  set File = path.csv\n" + by_dynamics + "end\n");
  folder.write("path.csv", "stress_xx_Pa,stress_yy_Pa,stress_xy_Pa\n0,40e6,0\n");
  const auto outcome = run_feldspar(folder.path(), "rve cell.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error.find("feldspar: rve: the given stress could not be held at stress_xx = 0 MPa, stress_yy = "),
            0u)
    << outcome.error;
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
}

TEST(Rve, PulledBeyondItsStrengthByStressSaysSoAndKeepsWhatWasBefore)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + along_file);
  folder.write("path.csv", "stress_xx_Pa,stress_yy_Pa,stress_xy_Pa\n0,40e6,0\n");
  const auto outcome = run_feldspar(folder.path(), "rve cell.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error.find("feldspar: rve: no equilibrium was found at stress_xx = 0 MPa, stress_yy = "), 0u)
    << outcome.error;
  auto table = read_table(folder.path() / "out/curves/rve.csv");
  // The last state held is one in equilibrium, near the strength.
  EXPECT_GT(table["stress_yy_Pa"].back(), 5e6);
  EXPECT_LT(table["stress_yy_Pa"].back(), 20e6);
  EXPECT_LT(table["unbalanced_force_ratio"].back(), 1e-6);
  EXPECT_NE(summary_of(folder.path() / "out")["rves"][0]["ended_early"], "");
}
} // namespace
} // namespace feldspar::tests
