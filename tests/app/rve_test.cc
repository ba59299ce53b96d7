// A representative volume as a user strains it.

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
const std::string small_cell = section("Specimen", "Shape = periodic", "Width = 12 mm", "Height = 12 mm");

/// Some fifty spheres.
const std::string small_cell_in_space =
  section("Specimen", "Dimension = 3", "Shape = periodic", "Width = 6 mm", "Height = 6 mm");

const std::string along_file = section("Strain path", "File = path.csv");

double highest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

/// Within the strengths stress is stiffness times strain, in components of these names.
void expect_hooke(const fs::path& folder, const std::vector<std::string>& names)
{
  const auto stiffness = summary_of(folder)["stiffness_Pa"];
  const auto table = read_columns(folder / "curves/rve.csv");
  const std::size_t n_normal = names.size() / 2 + names.size() % 2; // 2 of 3, 3 of 6
  for (std::size_t row = 0; row < table.at("strain_xx").size(); ++row)
    for (std::size_t i = 0; i < names.size(); ++i)
      {
        double expected = 0.0;
        for (std::size_t j = 0; j < names.size(); ++j) // stiffness takes engineering shear
          expected += stiffness[i][j].get<double>() * (j < n_normal ? 1.0 : 2.0) * table.at("strain_" + names[j])[row];
        EXPECT_NEAR(table.at("stress_" + names[i] + "_Pa")[row], expected, 1e-3); // of some 1e6 Pa
      }
}

TEST(Rve, AnswersAnIntactStrainByItsStiffness)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + along_file);
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n1e-5,0,0\n1e-5,3e-5,0\n1e-5,3e-5,-2e-5\n0,0,0\n");
  const auto outcome = run_to_end(folder, "rve cell.prm --output out");
  EXPECT_TRUE(has_words(outcome.output, "nearest isotropic body"));
  for (const char* file : {"summary.json", "cracks.csv", "log.txt", "specimen.h5", "curves/rve.csv"})
    EXPECT_GT(fs::file_size(folder / "out" / file), 50u) << file;

  const auto json = summary_of(folder / "out");
  auto table = read_columns(folder / "out/curves/rve.csv");
  // Steps of 1e-5 at most: 1 + 3 + 2 + 3, and the rest before them.
  ASSERT_EQ(table["strain_xx"].size(), 10u);
  expect_hooke(folder / "out", {"xx", "yy", "xy"});
  EXPECT_EQ(table["n_tension_cracks"].back(), 0.0);
  EXPECT_EQ(table["boundary_work_J"].back(), 0.0);
  EXPECT_EQ(json["rves"][0]["n_grains"], 54);
}

TEST(Rve, GoesAlongMixedPaths)
{
  const TemporaryFolder folder;
  // The same pull by a direction and by a file, both with the sides free.
  folder.write("direction.prm", small_cell + section("Strain path", "Direction = free, 1, free", "Size = 3e-4") +
                                  section("Seeds", "Seeds = 2, 1"));
  folder.write("file.prm", small_cell + along_file);
  folder.write("path.csv", "stress_xx_Pa,strain_yy,stress_xy_Pa\n0,3e-4,0\n");
  run_to_end(folder, "rve direction.prm --output direction");
  run_to_end(folder, "rve file.prm --output file");
  EXPECT_EQ(content(folder / "direction/curves/rve_seed_1.csv"), content(folder / "file/curves/rve.csv"));
  auto table = read_columns(folder / "file/curves/rve.csv");
  const double peak = highest(table["stress_yy_Pa"]);
  EXPECT_GT(peak, 5e6);
  EXPECT_GT(table["n_tension_cracks"].back(), 5.0);
  EXPECT_LT(table["stress_yy_Pa"].back(), 0.5 * peak);
  for (std::size_t row = 0; row < table["stress_xx_Pa"].size(); ++row)
    EXPECT_LE(std::abs(table["stress_xx_Pa"][row]), 1e-5 * peak); // the final tolerance, over what the grains carry
  EXPECT_EQ(n_lines(content(folder / "file/cracks.csv")) - 1,
            std::size_t(table["n_tension_cracks"].back() + table["n_shear_cracks"].back()));
}

// Turned by a quarter the cell stands with its x axis along y: pulled along y it responds as it does along x unturned.
// Turned by a half it is the cell again. By 30 degrees it is another body.
TEST(Rve, ATurnedCellIsPulledInTheAxesOfThePath)
{
  const TemporaryFolder folder;
  const auto pull = [&](const std::string& name, const std::string& direction, const std::string& angle) {
    folder.write(name + ".prm", small_cell + section("Strain path", "Direction = " + direction, "Size = 1.5e-4",
                                                     "Cell angle = " + angle + " deg"));
    run_to_end(folder, "rve " + name + ".prm --quiet --output " + name);
    return read_columns(folder / name / "curves/rve.csv");
  };
  auto along_x = pull("along_x", "1, free, free", "0");
  auto along_y = pull("along_y", "free, 1, free", "0");
  auto quarter = pull("quarter", "free, 1, free", "90");
  auto half = pull("half", "free, 1, free", "180");
  auto oblique = pull("oblique", "free, 1, free", "30");
  const double peak_x = highest(along_x["stress_xx_Pa"]);
  const double peak_y = highest(along_y["stress_yy_Pa"]);
  // Equal but for the order of sums; the forces balance to 1e-6.
  EXPECT_NEAR(highest(quarter["stress_yy_Pa"]), peak_x, 1e-5 * peak_x);
  EXPECT_NEAR(highest(half["stress_yy_Pa"]), peak_y, 1e-5 * peak_y);
  EXPECT_EQ(quarter["n_tension_cracks"].back(), along_x["n_tension_cracks"].back());
  EXPECT_GT(std::abs(highest(oblique["stress_yy_Pa"]) - peak_y), 1e-3 * peak_y);

  folder.write("explicit.prm", small_cell + section("Strain path", "Direction = free, 1, free", "Cell angle = 30 deg",
                                                    "Solver = explicit"));
  expect_refused(folder, "rve explicit.prm --output explicit", "Strain path/Cell angle: needs Solver = event by event");
}

TEST(Rve, GivesTheValuesOfVariantsWithTheirUnits)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + section("Strain path", "Direction = 0, 1, 0", "Size = 1e-5") +
                             section("Variants", "Entry = Strain path/Cell angle", "Values = 0 deg; 30 deg"));
  run_to_end(folder, "rve cell.prm --output out --quiet");
  const auto rves = summary_of(folder / "out")["rves"];
  ASSERT_EQ(rves.size(), 2u);
  EXPECT_EQ(rves[1]["variant_values"]["Strain path/Cell angle"], (Json{{"value", 30}, {"unit", "deg"}}));
}

// The order of the stiffnesses as the theory has it (§9.6); the bounds in every summary are those of the extreme boundaries.
TEST(Rve, HoldsACellByEachBoundary)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + section("Strain path", "Direction = 0, 1, 0", "Size = 1e-5") +
                             section("Variants", "Entry = Representative volume/Boundary",
                                     "Values = minimal kinematic; weakly periodic; edge; periodic; affine"));
  run_to_end(folder, "rve cell.prm --output out --quiet");
  const auto rves = summary_of(folder / "out")["rves"];
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
  folder.write("cell.prm", small_cell_in_space + along_file);
  folder.write("path.csv", "strain_xx,strain_yy,strain_zz,strain_yz,strain_xz,strain_xy\n"
                           "1e-5,0,2e-5,-1e-5,0,5e-6\n0,1e-5,-1e-5,0,1e-5,0\n");
  run_to_end(folder, "rve cell.prm --output out");
  const auto json = summary_of(folder / "out");
  auto table = read_columns(folder / "out/curves/rve.csv");
  ASSERT_GT(table["strain_zz"].size(), 3u);
  expect_hooke(folder / "out", {"xx", "yy", "zz", "yz", "xz", "xy"});
  EXPECT_EQ(json["rves"][0]["fabric"].size(), 3u);

  // Pulled with its sides free until it cracks, which happens across the pull.
  folder.write("pull.prm", small_cell_in_space +
                             section("Strain path", "Direction = free, free, 1, free, free, free", "Size = 3e-4"));
  run_to_end(folder, "rve pull.prm --output pull");
  table = read_columns(folder / "pull/curves/rve.csv");
  const double peak = highest(table["stress_zz_Pa"]);
  EXPECT_GT(peak, 5e6);
  for (const char* side : {"xx", "yy", "yz", "xz", "xy"})
    for (const double stress : table[std::string("stress_") + side + "_Pa"])
      EXPECT_LE(std::abs(stress), 1e-5 * peak); // the final tolerance, over what the grains carry
  auto cracks = read_columns(folder / "pull/cracks.csv");
  ASSERT_EQ(double(cracks["normal_z"].size()), table["n_tension_cracks"].back() + table["n_shear_cracks"].back());
  ASSERT_GT(cracks["normal_z"].size(), 5u);
  const auto orientation = summary_of(folder / "pull")["rves"][0]["at_end"]["crack_orientation_per_m"];
  EXPECT_GT(orientation[2][2].get<double>(), orientation[0][0].get<double>() + orientation[1][1].get<double>());
}

TEST(Rve, TakesFlaws)
{
  // The sides of a closed flaw have no bond: pulled apart they carry what a saw cut of no width carries, nothing.
  // Pressed together they carry as before, but for what they slip along the grains.
  const TemporaryFolder folder;
  const std::string cell = section("Specimen", "Shape = periodic", "Width = 20 mm", "Height = 20 mm") +
                           section("Variants", "Entry = Flaws/Shapes",
                                   "Values = none; slot from 5, 10 mm to 15, 10 mm width 0 mm; "
                                   "closed flaw from 5, 10 mm to 15, 10 mm; hole centre 10, 10 mm radius 3 mm");
  const char* const none = "none";
  const char* const cut = "slot_from_5_10_mm_to_15_10_mm_width_0_mm";
  const char* const closed = "closed_flaw_from_5_10_mm_to_15_10_mm";
  const char* const hole = "hole_centre_10_10_mm_radius_3_mm";
  const auto stress = [&](const std::string& path, const char* flaws) {
    return std::abs(
      read_columns(folder / path / fmt::format("curves/rve_shapes_{}.csv", flaws))["stress_yy_Pa"].back());
  };
  folder.write("pulled.prm", cell + section("Strain path", "Direction = free, 1, free", "Size = 5e-5"));
  folder.write("pressed.prm", cell + section("Strain path", "Direction = 0, -1, 0", "Size = 5e-5"));
  for (const char* const path : {"pulled", "pressed"})
    {
      run_to_end(folder, fmt::format("rve {0}.prm --output {0} --quiet", path));
      // The hole takes 28 mm² out of 400 mm².
      const auto rves = summary_of(folder / path)["rves"];
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

  folder.write("smooth.prm", small_cell + section("Flaws", "Shapes = closed flaw from 2, 6 mm to 9, 6 mm smooth"));
  expect_refused(folder, "rve smooth.prm --output smooth",
                 "puts in smooth joints, which need Specimen/Shape = box or cylinder");
}

TEST(Rve, IsConfinedBeforeItIsStrained)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + section("Strain path", "Direction = free, -1, free", "Size = 1e-4",
                                                "Confining pressure = 20 MPa"));
  run_to_end(folder, "rve cell.prm --output out");
  auto table = read_columns(folder / "out/curves/rve.csv");
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
  const std::string free_sides = section("Strain path", "Direction = free, 1, free");
  const auto expect = [&](const std::string& prm, const std::string& error, const std::string& csv = "") {
    const TemporaryFolder folder;
    folder.write("bad.prm", prm);
    folder.write("path.csv", csv);
    expect_refused(folder, "rve bad.prm --output out", "feldspar: " + error);
  };
  const std::string bad_header = "path.csv:1: the header is \"";
  expect(small_cell + along_file, bad_header, "strain_xx,strain_yy\n0,1e-4\n");
  expect(small_cell + along_file, bad_header, "strain_yy,strain_xx,strain_zz\n0,1e-4,0\n");
  expect(small_cell + along_file, "path.csv:2: there must be 3", "strain_xx,strain_yy,strain_xy\n0,1e-4\n");
  expect(small_cell + along_file, "path.csv:2: strain_yy: \"inf\" is not a decimal number",
         "strain_xx,strain_yy,strain_xy\n0,inf,0\n");
  expect(small_cell + along_file, "path.csv: point 1: strain_yy = 0.2: must lie in [-0.1, 0.1]\n",
         "strain_xx,strain_yy,strain_xy\n0,0.2,0\n");
  expect(small_cell + along_file, "path.csv:1: strain_yy and stress_yy_Pa are both given",
         "strain_xx,strain_yy,strain_xy,stress_yy_Pa\n0,0,0,0\n");
  expect(small_cell, "bad.prm: Strain path/File: is missing");
  expect(small_cell + section("Strain path", "Direction = 5, 0, 0", "Size = 0.1"),
         "bad.prm: Strain path/Size: times 5 of Direction is a strain of 0.5; a cell takes strains of at most 0.1");
  expect(small_cell + section("Strain path", "Direction = free, 1, free", "File = path.csv"),
         "bad.prm: Strain path/Direction: excludes File");
  expect(small_cell_in_space + free_sides,
         "bad.prm:8: Strain path/Direction = free, 1, free: has 3 components; in 3 dimensions there must be 6: xx, yy");
  expect(small_cell_in_space + along_file, bad_header, "strain_xx,strain_yy,strain_xy\n0,1e-4,0\n");
  expect(free_sides, "bad.prm: Specimen/Shape = box: a representative volume needs Shape = periodic");
  expect(section("Specimen", "Shape = periodic", "Width = 4 mm") + free_sides,
         "bad.prm:3: Specimen/Width = 4 mm: must be at least 4.1168 mm");
  expect(small_cell + section("Strain path", "Direction = free, 1, free", "Largest step = 1e-20"),
         "bad.prm: Strain path/Largest step = 1e-20: Size = ");
  expect(small_cell + free_sides + section("Representative volume", "Boundary = edge", "Free axis = z"),
         "bad.prm: Representative volume/Free axis = z: in two dimensions it is x or y");
  const std::string clumps = section("Clumps", "Diameter = 4 mm");
  expect(free_sides + clumps,
         "bad.prm: Clumps/Diameter = 4 mm: a representative volume takes none; set Diameter = none");
  expect(small_cell + free_sides + clumps,
         "bad.prm:10: Clumps/Diameter = 4 mm: clumps are in a box, and Specimen/Shape is periodic: a representative "
         "volume takes none, set Diameter = none");
  expect(small_cell + free_sides + section("Representative volume", "Boundary = rigid"),
         "bad.prm:10: Representative volume/Boundary = rigid: must be periodic or minimal kinematic or weakly "
         "periodic or edge or affine");
  expect(small_cell + free_sides + section("Representative volume", "Traction pieces = 0"),
         "bad.prm:10: Representative volume/Traction pieces = 0: must be an integer in [1, 1000]");
  expect(small_cell + section("Representative volume", "Boundary = affine") +
           section("Strain path", "Direction = free, 1, free", "Solver = explicit"),
         "bad.prm: Representative volume/Boundary = affine: explicit dynamics have periodic cells only; set ");
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell);
  expect_refused(folder, "lab cell.prm",
                 "feldspar: cell.prm: Specimen/Shape = periodic: a laboratory test needs a specimen between walls");
}

TEST(Rve, RefusesAnRveThatNothingHolds)
{
  const TemporaryFolder folder;
  folder.write("apart.txt", "0.002 0.002 0.001\n0.007 0.007 0.001\n");
  folder.write("apart.prm",
               section("Specimen", "Shape = periodic", "Width = 10 mm", "Height = 10 mm", "Packing file = apart.txt") +
                 section("Flat joint", "Installation gap ratio = 0") +
                 section("Strain path", "Direction = free, 1, free"));
  expect_refused(folder, "rve apart.prm --output out --quiet",
                 "feldspar: Flat joint/Installation gap ratio: joins no two grains");
}

TEST(Rve, TakesSpecimensOfItsKindOnly)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell);
  folder.write("box.prm", section("Specimen", "Width = 12 mm", "Height = 12 mm"));
  run_to_end(folder, "specimen cell.prm --output cell");
  run_to_end(folder, "specimen box.prm --output box");
  const std::string path = section("Strain path", "Direction = 0, 1, 0", "Size = 1e-5");
  const auto with = [&](const std::string& file) {
    return section("Specimen", "Specimen file = " + file + "/specimen.h5") + path;
  };
  folder.write("with_cell.prm", with("cell"));
  folder.write("with_box.prm", with("box"));
  run_to_end(folder, "rve with_cell.prm --output good");
  expect_refused(folder, "rve with_box.prm --output bad --quiet",
                 "is a specimen between walls; a representative volume needs");
  expect_refused(folder, "lab with_cell.prm --output bad --quiet", "is a periodic cell; a laboratory test needs");
}

/// Some fifty grains pulled apart with their sides free.
const std::string pulled = small_cell + section("Strain path", "Direction = free, 1, free", "Size = 2e-4");
const std::string by_dynamics = section("Strain path", "Solver = explicit", "Steps per millistrain = 100000");

TEST(Rve, GoesItsPathByExplicitDynamicsToo)
{
  const TemporaryFolder folder;
  folder.write("events.prm", pulled + section("Strain path", "Solver = event by event"));
  folder.write("explicit.prm", pulled + by_dynamics);
  run_to_end(folder, "rve events.prm --output events");
  run_to_end(folder, "rve explicit.prm --output explicit");
  for (const char* file : {"summary.json", "cracks.csv", "log.txt", "specimen.h5", "curves/rve.csv"})
    EXPECT_GT(fs::file_size(folder / "explicit" / file), 50u) << file;

  const auto by_events = read_columns(folder / "events/curves/rve.csv");
  const auto table = read_columns(folder / "explicit/curves/rve.csv");
  const auto peak = [](const auto& of) { return highest(of.at("stress_yy_Pa")); };
  EXPECT_NEAR(peak(table), peak(by_events), 0.05 * peak(by_events)); // what the rate leaves, and samples 1e-5 apart
  EXPECT_EQ(table.at("strain_yy").size(), 21u);
  EXPECT_NEAR(table.at("strain_yy").back(), 2e-4, 1e-15);
  for (std::size_t row = 0; row < table.at("strain_yy").size(); ++row)
    {
      EXPECT_LT(std::abs(table.at("stress_xx_Pa")[row]), 0.05 * peak(table)) << row; // also as the crack runs
      EXPECT_LT(table.at("energy_imbalance")[row], 0.01) << row; // forces jump within a step: as in the laboratory
    }
  const auto rve = summary_of(folder / "explicit")["rves"][0];
  EXPECT_LT(rve["energy_imbalance"].get<double>(), 0.01);
  EXPECT_EQ(n_lines(content(folder / "explicit/cracks.csv")) - 1,
            std::size_t(table.at("n_tension_cracks").back() + table.at("n_shear_cracks").back()));
  EXPECT_GT(rve["at_end"]["crack_area_share"].get<double>(), 0.01);
  EXPECT_EQ(rve["at_end"]["n_tension_cracks"].get<double>(), table.at("n_tension_cracks").back());
}

// A table may begin at rest, where forces and energies are round-off: what they miss of each other is no imbalance.
TEST(Rve, CountsNoErrorsBeforeAPathSetsOff)
{
  const TemporaryFolder folder;
  folder.write("path.csv", "strain_xx,strain_yy,strain_xy\n0,0,0\n0,2e-5,0\n");
  folder.write("rest.prm", small_cell + along_file + by_dynamics);
  run_to_end(folder, "rve rest.prm --output out");
  EXPECT_EQ(read_columns(folder / "out/curves/rve.csv").at("strain_yy").at(1), 0.0);
  const auto rve = summary_of(folder / "out")["rves"][0];
  EXPECT_LT(rve["energy_imbalance"].get<double>(), 1e-6);
  EXPECT_LT(rve["boundary_stress_error"].get<double>(), 1e-2);
}

TEST(Rve, TakesBondsThatSoftenEventByEventAndByExplicitDynamics)
{
  const TemporaryFolder folder;
  const std::string law = section("Specimen", "Joint law = softening flat joint") +
                          section("Softening flat joint", "Softening opening = 1 um");
  folder.write("softening.prm", pulled + by_dynamics + law);
  folder.write("events.prm", pulled + law);
  folder.write("brittle.prm", pulled + by_dynamics);
  const auto strength = [&](const std::string& name) {
    run_to_end(folder, "rve " + name + ".prm --output " + name);
    return highest(column(folder / name / "curves/rve.csv", "stress_yy_Pa"));
  };
  const double softening = strength("softening");
  EXPECT_GT(softening, 1.1 * strength("brittle")) << "bonds beside one that softens share its stress";
  EXPECT_NEAR(strength("events"), softening, 0.03 * softening); // the saw, and motion
  for (const auto& [name, largest] : {std::pair("softening", 0.01), std::pair("events", 1e-4)})
    EXPECT_LT(highest(column(folder / name / "curves/rve.csv", "energy_imbalance")), largest) << name;
}

TEST(Rve, GivesTheSameBitsForAnyNumberOfThreads)
{
  const TemporaryFolder folder;
  for (const std::string& solver : {section("Strain path", "Solver = event by event"), by_dynamics})
    {
      folder.write("cell.prm", pulled + solver + section("Seeds", "Seeds = 1, 2"));
      for (const char* threads : {"1", "2"})
        run_to_end(folder, fmt::format("rve cell.prm --output {0} --threads {0} --force --quiet", threads));
      expect_same_files(folder / "1", folder / "2", {"cracks.csv", "curves/rve_seed_1.csv", "curves/rve_seed_2.csv"});
      EXPECT_GT(content(folder / "1/cracks.csv").size(), 500u) << solver;
    }
}

TEST(Rve, InterruptedAndResumedGivesTheBitsOfTheUnbrokenRun)
{
  const TemporaryFolder folder;
  // Increments so small that there are many moments to stop at.
  for (const std::string& solver :
       {section("Strain path", "Largest step = 3e-8"),
        section("Strain path", "Largest step = 2e-7", "Solver = explicit", "Steps per millistrain = 400000")})
    {
      folder.write("cell.prm", pulled + solver);
      run_to_end(folder, "rve cell.prm --output whole --force --quiet");
      fs::remove_all(folder / "broken");
      const auto checkpoint = folder / "broken/checkpoints/rve.h5";
      const auto is_complete = [&] {
        return content(folder / "broken/run.json").find("\"complete\": true") != std::string::npos;
      };
      // Until it is stopped on its path, which begins after the specimen is made: later where it had not begun, earlier where
      // it had ended. On a busy machine neither takes the same time twice, so that the two moments are moved apart again.
      double early = 0.0;
      double late = 60.0;
      double time = 0.1;
      for (int k = 0; k < 100 && !fs::exists(checkpoint); ++k)
        {
          run_feldspar(folder, "rve cell.prm --output broken --force --quiet",
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
      const auto n_rows_before = read_columns(folder / "broken/curves/rve.csv")["strain_yy"].size();
      run_to_end(folder, "rve --resume broken --quiet");
      EXPECT_GT(read_columns(folder / "broken/curves/rve.csv")["strain_yy"].size(), n_rows_before);
      expect_same_files(folder / "whole", folder / "broken", {"cracks.csv", "curves/rve.csv"});
      EXPECT_FALSE(fs::exists(folder / "broken/checkpoints"));
    }
}

TEST(Rve, InterruptedInGenesisKeepsTheSpecimensThatAreFinished)
{
  const TemporaryFolder folder;
  // A thousand grains a cell take a second or more; one cell at a time.
  const std::string cells = section("Specimen", "Shape = periodic", "Width = 45 mm", "Height = 45 mm") +
                            section("Seeds", "Seeds = 1, 2") +
                            section("Strain path", "Direction = free, 1, 0", "Size = 2e-5");
  folder.write("cells.prm", cells);
  const auto outcome = run_until(folder, "rve cells.prm --output out --quiet --threads 1",
                                 "[ -e out/specimen_seed_1.h5 ]", "kill -TERM $!");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar rve --resume out\n");
  ASSERT_TRUE(fs::exists(folder / "out/specimen_seed_1.h5"));
  EXPECT_FALSE(fs::exists(folder / "out/specimen_seed_2.h5"));
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
  const std::string kept = content(folder / "out/specimen_seed_1.h5");

  // A specimen that was damaged meanwhile is made anew.
  fs::resize_file(folder / "out/specimen_seed_1.h5", kept.size() / 2);
  const auto resumed = run_to_end(folder, "rve --resume out --quiet");
  EXPECT_TRUE(has_words(resumed.error, "specimen_seed_1.h5", "making it anew"));
  run_to_end(folder, "rve cells.prm --output whole --quiet");
  expect_same_files(folder / "whole", folder / "out", {"cracks.csv", "curves/rve_seed_1.csv", "curves/rve_seed_2.csv"});
}

TEST(Rve, ADamagedCheckpointIsRefusedAndAFullDiskSaidAndTheRunGoesOn)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", pulled + section("Strain path", "Largest step = 1e-8"));
  run_to_end(folder, "rve cell.prm --output whole --quiet");
  // Interrupted once there is a checkpoint; the interrupt writes one more.
  const auto interrupted =
    run_until(folder, "rve cell.prm --output broken --quiet", "[ -e broken/checkpoints/rve.h5 ]", "kill -INT $!");
  ASSERT_EQ(interrupted.exit_code, 130) << interrupted.error;
  const fs::path newest = folder / "broken/checkpoints/rve.h5";
  ASSERT_TRUE(fs::exists(newest) && fs::exists(folder / "broken/checkpoints/rve.previous.h5"));
  fs::resize_file(newest, fs::file_size(newest) / 2);
  const auto resumed = run_to_end(folder, "rve --resume broken --quiet");
  EXPECT_TRUE(has_words(resumed.error, "rve.h5: damaged or cut short", "going back to the checkpoint before it"));
  EXPECT_EQ(n_lines(resumed.error), 1u) << resumed.error;
  expect_same_files(folder / "whole", folder / "broken", {"cracks.csv", "curves/rve.csv"});

  // A limit on the size of files stands for the full disk: the specimen is within it, the curve of the whole path is not.
  const auto limit = fs::file_size(folder / "whole/curves/rve.csv") - 1;
  ASSERT_GT(limit, fs::file_size(folder / "whole/specimen.h5"));
  const auto outcome =
    run_feldspar(folder, "rve cell.prm --output full --quiet", fmt::format("prlimit --fsize={}", limit));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "cannot be written: File too large", "go on with: feldspar rve --resume full"));
  for (const std::string& name : names_in(folder / "full"))
    EXPECT_FALSE(name.ends_with(".unfinished")) << name;
  EXPECT_EQ(run_to_end(folder, "rve --resume full --quiet").error, "");
  expect_same_files(folder / "whole", folder / "full", {"cracks.csv", "curves/rve.csv"});
}

TEST(Rve, SaysWhenExplicitDynamicsCannotHoldAStress)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + along_file + by_dynamics);
  folder.write("path.csv", "stress_xx_Pa,stress_yy_Pa,stress_xy_Pa\n0,40e6,0\n");
  expect_mistake(folder, "rve cell.prm --output out --quiet",
                 "feldspar: rve: the given stress could not be held at stress_xx = 0 MPa, stress_yy = ");
}

TEST(Rve, PulledBeyondItsStrengthByStressSaysSoAndKeepsWhatWasBefore)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", small_cell + along_file);
  folder.write("path.csv", "stress_xx_Pa,stress_yy_Pa,stress_xy_Pa\n0,40e6,0\n");
  expect_mistake(folder, "rve cell.prm --output out --quiet",
                 "feldspar: rve: no equilibrium was found at stress_xx = 0 MPa, stress_yy = ");
  auto table = read_columns(folder / "out/curves/rve.csv");
  // The last state held is one in equilibrium, near the strength.
  EXPECT_GT(table["stress_yy_Pa"].back(), 5e6);
  EXPECT_LT(table["stress_yy_Pa"].back(), 20e6);
  EXPECT_LT(table["unbalanced_force_ratio"].back(), 1e-6);
  EXPECT_NE(summary_of(folder / "out")["rves"][0]["ended_early"], "");
}
} // namespace
} // namespace feldspar::tests
