#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <fcntl.h>
#include <semaphore.h>

/// `feldspar multiscale` as a user runs it, on a sample of two elements with small RVEs.
namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

const std::string small =
  section("Specimen", "Shape = periodic", "Width = 14 mm", "Height = 14 mm") +
  section("Representative volume", "Final tolerance = 1e-6") +
  section("Sample", "Width = 12 mm", "Height = 24 mm", "Elements across = 1", "Elements along = 2", "Realisations = 2");

/// The same for what takes long.
const std::string of_small_cells = std::regex_replace(small, std::regex("14 mm"), "10 mm");

std::string of_one_rve(const std::string& sample = small)
{
  return replaced(sample, "Realisations = 2", "Realisations = 1");
}

/// Files of a test in tension that are the same, however a run came to its end.
const std::vector<std::string> of_tension{"cracks.csv", "emission.csv", "steps.csv",
                                          "curves/direct_tension_seed_1.csv"};

TEST(Multiscale, PullsASampleApartToTheSameBitsForAnyNumberOfThreads)
{
  TemporaryFolder folder;
  folder.write("pull.prm", of_small_cells +
                             section("Sample", "Order = 1", "Platens = smooth", "Orientation = random",
                                     "Tension step = 5e-6", "Compression step = 4e-5", "Most broken share = 0.01",
                                     "Smallest step share = 0.0625", "Newton tolerance = 1e-5", "Softening = scaled") +
                             section("Tests", "List = direct_tension"));
  run_to_end(folder, "multiscale pull.prm --output one --quiet --threads 1");
  const auto summary = summary_of(folder / "one");
  const auto& test = summary.at("tests").at(0);
  EXPECT_EQ(test.at("kind"), "direct_tension");
  // Small RVEs of few grains: weaker or stronger than the large one's 9 MPa, but a rock of Table 1's bonds
  // (22 MPa), of which stress concentrations leave a third to a half.
  EXPECT_GT(test.at("peak_stress_Pa").get<double>(), 5e6);
  EXPECT_LT(test.at("peak_stress_Pa").get<double>(), 15e6);
  EXPECT_GT(test.at("n_tension_cracks").get<int>(), 10);
  EXPECT_LT(test.at("energy_imbalance").get<double>(), 0.01);
  // A figure that such a test does not have is missing with its reason, not zero.
  EXPECT_EQ(test.at("body"), "finite_elements");
  for (const char* const figure : {"strain_rate_per_s", "kinetic_to_strain_energy", "p_wave_transits_to_peak",
                                   "n_fragments", "servo_error", "time_step_s"})
    {
      EXPECT_TRUE(test.at(figure).is_null()) << figure;
      EXPECT_FALSE(test.at(std::string(figure) + "_reason").get<std::string>().empty()) << figure;
    }
  for (const char* const file : {"one/fields/direct_tension_seed_1.xdmf", "one/cracks.csv", "one/report.html",
                                 "one/curves/direct_tension_seed_1.csv", "one/rves/specimen_seed_2.h5"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;

  // Each equilibrium is a row of steps.csv: together they took what the whole test took.
  const auto steps = [&](const char* const name) { return column(folder / "one/steps.csv", name); };
  const auto sum = [](const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); };
  const auto& work = test.at("solver_work");
  ASSERT_EQ(steps("step").size(), test.at("steps").get<std::size_t>());
  EXPECT_EQ(steps("step").front(), 1.0);
  EXPECT_EQ(double(steps("step").size()) + sum(steps("cuts")), work.at("solves").get<double>());
  EXPECT_LT(sum(steps("iterations")), work.at("iterations").get<double>()); // those of searches that were given up, too
  EXPECT_GT(sum(steps("cascades")), 0.0);
  EXPECT_GT(sum(steps("cuts")), 0.0) << "no step was cut";
  const std::vector<double> residuals = steps("residual");
  const double largest = *std::max_element(residuals.begin(), residuals.end());
  EXPECT_LE(largest, 1e-5);                                                        // Newton's tolerance
  EXPECT_NEAR(test.at("largest_residual").get<double>(), largest, 0.05 * largest); // two digits
  const auto strain = column(folder / "one/curves/direct_tension_seed_1.csv", "axial_strain");
  EXPECT_NEAR(steps("axial_strain").back(), strain.back(), 1e-8 * strain.back());
  const std::string trust = content(folder / "one/tables/trust.csv");
  EXPECT_TRUE(has_words(trust, "unbalanced over internal force of a sample"));

  run_to_end(folder, "multiscale pull.prm --output two --quiet --threads 2");
  expect_same_files(folder / "one", folder / "two", of_tension);

  // Beside a specimen of grains both are series of one report.
  folder.write("grains.prm",
               section("Specimen", "Width = 12 mm", "Height = 24 mm") + section("Tests", "List = direct_tension"));
  run_to_end(folder, "lab grains.prm --output grains --quiet");
  run_to_end(folder, "report grains one --output both", with_pictures);
  const std::string page = content(folder / "both/report.html");
  EXPECT_TRUE(has_words(page, "</span>grains</h3>", "</span>one</h3>",
                        "finite elements with a representative volume of grains at every point",
                        "broken segments of the representative volume at each point",
                        "Each row of a curve is an equilibrium, found without time"));
  EXPECT_EQ(page.find("class=\"absent\""), std::string::npos);
  const std::string strengths = content(folder / "both/tables/strengths.csv");
  EXPECT_TRUE(has_words(strengths, "Direct tension,grains,1,", "Direct tension,one,1,"));
}

/// With elements as large as their RVE, which needs no remark.
const std::string pull =
  replaced(replaced(of_small_cells, "Width = 12 mm", "Width = 10 mm"), "Height = 24 mm", "Height = 20 mm") +
  section("Sample", "Tension step = 5e-6") + section("Tests", "List = direct_tension", "Stop strain = 3e-4");

/// The forces of both ends are equal to Newton's tolerance, 1e-5, of what an end carries in this row or the one before.
void expect_ends_to_agree(const fs::path& curve)
{
  const auto stress = column(curve, "axial_stress_Pa");
  const auto difference = column(curve, "end_stress_difference_Pa");
  for (std::size_t k = 1; k < stress.size(); ++k)
    EXPECT_LE(std::abs(difference[k]), 1e-5 * std::max(std::abs(stress[k]), std::abs(stress[k - 1]))) << curve << k;
}

// Past the peak the sample widens from row to row by the step, and where it breaks the platens go back, which no test does
// that drives them; the stress falls without an end of the test. Columns of a curve have compression positive.
TEST(Multiscale, FollowsTheWidthOfASamplePastItsPeak)
{
  TemporaryFolder folder;
  folder.write("press.prm", of_small_cells +
                              section("Sample", "Compression step = 1e-4", "Control past the peak = lateral strain") +
                              section("Tests", "List = uniaxial_compression", "Stop stress over peak = 0.8"));
  run_to_end(folder, "multiscale press.prm --output run --quiet");
  const auto curve = folder / "run/curves/uniaxial_compression_seed_1.csv";
  const auto width = column(curve, "gauge_lateral_strain");
  const auto axial = column(curve, "axial_strain");
  const auto stress = column(curve, "axial_stress_Pa");
  ASSERT_GT(width.size(), 10u);
  expect_ends_to_agree(curve);
  std::size_t n_widened = 0;
  bool went_back = false;
  for (std::size_t k = 1; k < width.size(); ++k)
    if (std::abs(width[k - 1] - width[k] - 1e-4) < 1e-8)
      {
        ++n_widened;
        went_back = went_back || axial[k] < axial[k - 1];
      }
  EXPECT_GT(n_widened, 5u);
  EXPECT_TRUE(went_back);
  EXPECT_LE(stress.back(), 0.8 * *std::max_element(stress.begin(), stress.end()));
  EXPECT_FALSE(summary_of(folder / "run")["tests"][0].contains("ended_early"));
}

// Up, down, further up and down, then towards more than the sample carries. Cracks open above the highest strain there
// was (Kaiser's effect); what has cracked is softer, so that the way down is flatter each time, and some strain is
// left.
TEST(Multiscale, FollowsALoadingTable)
{
  TemporaryFolder folder;
  folder.write("cycles.csv", "axial_strain,axial_stress_Pa\n0.0016,\n,1e6\n0.0022,\n,1e6\n,900e6\n");
  folder.write("cycles.prm", of_small_cells + section("Sample", "Compression step = 1e-4") +
                               section("Tests", "List = own_loading", "Loading table = cycles.csv"));
  const auto run = run_to_end(folder, "multiscale cycles.prm --output run");
  const auto test = summary_of(folder / "run")["tests"][0];
  const auto& stages = test.at("stages");
  ASSERT_EQ(stages.size(), 5u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_TRUE(stages[k].at("reached")) << k;
  EXPECT_FALSE(stages[4].at("reached"));
  // On the screen and on the page, too.
  EXPECT_TRUE(has_words(run.output, "\n2: axial stress 1 MPa ", "\n5: axial stress 900 MPa, not reached "));
  EXPECT_TRUE(has_words(content(folder / "run/report.html"), "<th scope=\"row\">2: axial stress 1 MPa</th>"));
  EXPECT_FALSE(test.at("ended_early").get<std::string>().empty());
  const auto figure = [&](const std::size_t stage, const char* const name) {
    return stages[stage].at(name).get<double>();
  };
  EXPECT_GT(figure(0, "n_cracks"), 0.0);
  EXPECT_LT(figure(1, "n_cracks"), 0.05 * figure(0, "n_cracks"));
  EXPECT_GT(figure(2, "n_cracks"), 0.0);
  EXPECT_LT(figure(3, "n_cracks"), 0.05 * figure(2, "n_cracks"));
  EXPECT_LT(figure(3, "slope_Pa"), figure(1, "slope_Pa"));
  EXPECT_GT(figure(1, "axial_strain_at_end"), 0.0);
  EXPECT_LT(figure(1, "axial_strain_at_end"), 1e-4);
  // Down to the stress of the table, at most a row's beyond.
  EXPECT_NEAR(figure(1, "axial_stress_at_end_Pa"), 1e6, 0.1e6);
  const auto strain = column(folder / "run/curves/own_loading_seed_1.csv", "axial_strain");
  const auto cracks = column(folder / "run/curves/own_loading_seed_1.csv", "n_tension_cracks");
  const std::size_t turned = stages[2].at("first_row");
  for (std::size_t k = turned; k < strain.size() && strain[k] < 0.0014; ++k) // 0.0016 was the highest so far
    EXPECT_LT(cracks[k], cracks[turned] + 0.05 * figure(0, "n_cracks")) << strain[k];
}

TEST(Multiscale, KilledOrInterruptedAndResumedGoesOnToTheSameBits)
{
  const TemporaryFolder folder;
  folder.write("pull.prm", pull);
  run_to_end(folder, "multiscale pull.prm --output whole --quiet");
  // Killed once a state is there, and again and again after it; the last time left to its end.
  const std::string has_state = "ls {}/states/direct_tension_seed_1/step-* >/dev/null 2>&1";
  run_until(folder, "multiscale pull.prm --output broken --quiet", replaced(has_state, "{}", "broken"),
            "sleep 0.1\nkill -KILL $!");
  EXPECT_FALSE(fs::exists(folder / "broken/summary.json")); // else it was not killed on its way
  run_feldspar(folder, "multiscale --resume broken --quiet", "timeout --foreground --signal=KILL 0.6");
  run_to_end(folder, "multiscale --resume broken --quiet");
  expect_same_files(folder / "whole", folder / "broken", of_tension);
  expect_same_files(folder / "whole", folder / "broken", {"fields/direct_tension_seed_1.xdmf"});
  EXPECT_TRUE(has_words(run_feldspar(folder, "multiscale --resume broken").output, "this run is complete"));

  const auto outcome =
    run_until(folder, "multiscale pull.prm --output out --quiet", replaced(has_state, "{}", "out"), "kill -INT $!");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar multiscale --resume out\n");
  EXPECT_EQ(summary_of(folder / "out").at("tests").at(0).at("interrupted"), true);
  run_to_end(folder, "multiscale --resume out --quiet");
  expect_same_files(folder / "whole", folder / "out", of_tension);
}

// Open MPI's default guards each shared file by a semaphore of its name. It stays taken by a run that is killed meanwhile, and
// every later run that writes a file of that name waits for it: this one would be ended after half a minute.
TEST(Multiscale, DoesNotWaitForASemaphoreThatAKilledRunHasTaken)
{
  const TemporaryFolder folder;
  folder.write("press.prm", small + section("Sample", "Material = linear elasticity") +
                              section("Tests", "List = uniaxial_compression", "Stop strain = 1e-4"));
  const char* const name = "/OMPIO_uniaxial_compression_seed_1.h5";
  sem_t* const taken = sem_open(name, O_CREAT, 0600, 0);
  ASSERT_NE(taken, SEM_FAILED) << std::strerror(errno);
  const auto run = run_feldspar(folder, "multiscale press.prm --output out --quiet", "timeout 30 ");
  sem_close(taken);
  sem_unlink(name);
  EXPECT_EQ(run.exit_code, 0) << run.error << " (124: it waited)";
  EXPECT_TRUE(fs::exists(folder / "out/fields/uniaxial_compression_seed_1.xdmf"));
}

/// The number in a column of a row of a CSV file, both from 0 below the header.
double cell(const fs::path& file, const std::string& name, const std::size_t row) { return column(file, name).at(row); }

TEST(Multiscale, ExtractsTheRveAtAPointForRveAndParaView)
{
  TemporaryFolder folder;
  const std::string path = section("Strain path", "Direction = 0, 1, 0", "Size = 1e-6");
  const auto continued = [&](const std::string& rve) {
    folder.write("rve.prm", section("Specimen", "Shape = periodic", "Specimen file = " + rve) + path);
    run_to_end(folder, "rve rve.prm --output rve --force --quiet");
    return folder / "rve/curves/rve.csv";
  };

  // One RVE, not turned, at every point of a sample between smooth platens, nothing broken: strain is uniform, so
  // that the RVE has the strain and the stress of the sample, none sideways.
  const std::string even = of_one_rve(of_small_cells) + section("Sample", "Orientation = fixed") +
                           section("Tests", "List = direct_tension", "Stop strain = 3.9e-5");
  folder.write("even.prm", even);
  run_to_end(folder, "multiscale even.prm --output even --quiet");
  run_to_end(folder, "multiscale even --extract 1:3");
  const auto curve = continued("even/extracted/direct_tension_seed_1_cell_1_point_3.h5");
  const auto of_sample = folder / "even/curves/direct_tension_seed_1.csv";
  const std::size_t last = 20; // 4e-5 in steps of 2e-6, after the row at rest
  const double stress = cell(of_sample, "axial_stress_Pa", last);
  EXPECT_NEAR(cell(of_sample, "axial_strain", last), 4e-5, 1e-12);
  EXPECT_NEAR(cell(curve, "strain_yy", 0), 4e-5, 1e-9 * 4e-5);
  EXPECT_NEAR(cell(curve, "stress_yy_Pa", 0), stress, 1e-5 * stress); // Sample/Newton tolerance
  EXPECT_NEAR(cell(curve, "stress_xx_Pa", 0), 0.0, 1e-5 * stress);
  EXPECT_NEAR(cell(curve, "strain_yy", 1), 4.1e-5, 1e-9 * 4e-5); // and goes on from there

  // Between free sides the points have edges, whose states no other boundary takes. With one element across both
  // sides of the sample are free, and the strain is as uniform.
  folder.write("edges.prm", even + section("Representative volume", "Boundary = edge"));
  run_to_end(folder, "multiscale edges.prm --output edges --quiet");
  run_to_end(folder, "multiscale edges --extract 1:3");
  const std::string of_edge = "edges/extracted/direct_tension_seed_1_cell_1_point_3.h5";
  const std::string edge_rve = section("Specimen", "Shape = periodic", "Specimen file = " + of_edge) + path;
  folder.write("edge.prm", edge_rve);
  expect_refused(
    folder, "rve edge.prm --output edge --quiet",
    "its state is that of an RVE whose boundary is \"edge, x free\", and Representative volume/Boundary is "
    "periodic");
  folder.write("edge.prm", edge_rve + section("Representative volume", "Boundary = edge"));
  run_to_end(folder, "rve edge.prm --output edge --quiet");
  const double of_edges = cell(folder / "edges/curves/direct_tension_seed_1.csv", "axial_stress_Pa", last);
  EXPECT_NEAR(cell(folder / "edge/curves/rve.csv", "stress_yy_Pa", 0), of_edges, 1e-5 * of_edges);
  EXPECT_LT(of_edges, 0.999 * stress);

  // Broken: the cracks of that point and no others.
  folder.write("pull.prm", pull);
  run_to_end(folder, "multiscale pull.prm --output out --quiet");
  int most = 0;
  const auto places = column(folder / "out/cracks.csv", "joint");
  for (const int point : {1, 6}) // a process is slow to start
    {
      const std::string place = fmt::format("{}:{}", point / 4, point % 4);
      run_to_end(folder, "multiscale out --extract " + place);
      const auto n_cracks = int(std::count(places.begin(), places.end(), double(point)));
      const std::string name = fmt::format("direct_tension_seed_1_cell_{}_point_{}", point / 4, point % 4);
      const auto rows = continued("out/extracted/" + name + ".h5");
      EXPECT_EQ(cell(rows, "n_tension_cracks", 0) + cell(rows, "n_shear_cracks", 0), n_cracks) << place;
      EXPECT_TRUE(fs::exists(folder / "out/extracted" / (name + "_fields_grains.pvd")));
      EXPECT_EQ(fs::exists(folder / "out/extracted" / (name + "_fields_cracks.pvd")), n_cracks > 0);
      most = std::max(most, n_cracks);
    }
  EXPECT_GT(most, 5);

  // Who would begin without its state says so.
  const std::string in_its_state =
    section("Specimen", "Specimen file = out/extracted/direct_tension_seed_1_cell_0_point_1.h5");
  folder.write("sample.prm", of_one_rve() + section("Tests", "List = direct_tension") + in_its_state);
  folder.write("explicit.prm", in_its_state + path + section("Strain path", "Solver = explicit"));
  expect_refused(folder, "multiscale sample.prm --output refused --quiet", "a sample begins with intact ones");
  expect_refused(folder, "rve explicit.prm --output refused --quiet", "explicit dynamics begin at rest");
  expect_refused(folder, "multiscale out --extract 2:0",
                 "there is no point 0 in a cell 2: cells are 0 to 1, their points 0 to 3");
  expect_refused(folder, "multiscale out --extract 1", "--extract 1: must be CELL:POINT");
}

/// Two squares of 12 mm, one above the other. Physical group 4 is the top.
std::string two_squares(const std::string& top, const std::string& cells, const std::string& centre = "0.012 0.012")
{
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"left\"\n1 2 \"right\"\n1 3 \"bottom\"\n"
         "1 4 \"" +
         top + "\"\n2 5 \"rock\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 0.012 0 0\n3 0 0.012 0\n4 " + centre +
         " 0\n5 0 0.024 0\n6 0.012 0.024 0\n$EndNodes\n$Elements\n" + cells + "$EndElements\n";
}

const std::string sides = "1 1 2 3 1 1 2\n2 1 2 2 2 2 4\n3 1 2 2 2 4 6\n4 1 2 4 3 6 5\n5 1 2 1 4 5 3\n6 1 2 1 4 3 1\n";
const std::string squares = "8\n" + sides + "7 3 2 5 1 1 2 4 3\n8 3 2 5 1 3 4 6 5\n";

std::string two_squares_in_millimetres()
{
  return std::regex_replace(two_squares("top", squares), std::regex("0\\.0(12|24)"), "$1");
}

TEST(Multiscale, TakesAMeshOfGmshForItsSample)
{
  TemporaryFolder folder;
  folder.write("squares.msh", two_squares("top", squares));
  const std::string tests = section("Tests", "List = direct_tension", "Stop strain = 2e-5");
  folder.write("own.prm", of_small_cells + tests);
  folder.write("mesh.prm", of_small_cells + section("Sample", "Mesh file = squares.msh") + tests);
  folder.write("millimetres.msh", two_squares_in_millimetres());
  folder.write("scaled.prm",
               of_small_cells + section("Sample", "Mesh file = millimetres.msh", "Mesh unit = mm") + tests);
  // Top by another name, and a layer: a line between both squares.
  std::string layers = two_squares("roof", squares);
  layers.replace(layers.find("$Elements\n8"), 11, "$Elements\n9");
  folder.write("layers.msh", layers.replace(layers.find("7 3 2 5"), 0, "9 1 2 6 5 3 4\n"));
  folder.write("layers.prm",
               of_small_cells + section("Sample", "Mesh file = layers.msh", "Mesh names = top = roof") + tests);
  for (const std::string name : {"own", "mesh", "scaled", "layers"})
    {
      run_to_end(folder, "multiscale " + name + ".prm --output " + name + " --quiet");
    }
  // The mesh that Width, Height and the Elements of small make, in the same order: the points have the same volumes.
  const auto stress = [&](const std::string& name) {
    return cell(folder / name / "curves/direct_tension_seed_1.csv", "axial_stress_Pa", 10);
  };
  expect_ends_to_agree(folder / "own/curves/direct_tension_seed_1.csv");
  EXPECT_NEAR(stress("mesh"), stress("own"), 1e-9 * stress("own"));
  EXPECT_NEAR(stress("scaled"), stress("own"), 1e-9 * stress("own"));
  EXPECT_EQ(stress("layers"), stress("mesh"));
  EXPECT_GT(stress("own"), 1e6);
}

/// Cells of which a segment broke; four points a cell.
std::set<int> cells_that_broke(const fs::path& run)
{
  std::set<int> cells;
  for (const double point : column(run / "cracks.csv", "joint"))
    cells.insert(int(point) / 4);
  return cells;
}

/// Two columns of 6 mm by 24 mm, side by side: the groups of cells left_column and right_column.
const std::string two_columns =
  "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n1 1 \"left\"\n1 2 \"right\"\n1 3 \"bottom\"\n1 4 \"top\"\n"
  "2 5 \"left_column\"\n2 6 \"right_column\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 0.006 0 0\n3 0.012 0 0\n"
  "4 0 0.024 0\n5 0.006 0.024 0\n6 0.012 0.024 0\n$EndNodes\n$Elements\n8\n1 1 2 3 1 1 2\n2 1 2 3 1 2 3\n"
  "3 1 2 2 2 3 6\n4 1 2 4 3 6 5\n5 1 2 4 3 5 4\n6 1 2 1 4 4 1\n7 3 2 5 1 1 2 5 4\n8 3 2 6 2 2 3 6 5\n$EndElements\n";

// Columns of one packing side by side between smooth platens, the right one of joints half as stiff: both are strained
// alike, with no stress between them, so that the sample carries the mean of what each would carry alone. With a fifth of the
// strength the right one breaks, at a strain at which the left one holds.
TEST(Multiscale, TakesTheRocksOfTheGroupsOfItsMesh)
{
  TemporaryFolder folder;
  folder.write("columns.msh", two_columns);
  const auto run = [&](const std::string& name, const std::string& rocks, const std::string& stop) {
    folder.write(name + ".csv", rocks);
    folder.write(name + ".prm", of_one_rve(of_small_cells) +
                                  section("Sample", "Mesh file = columns.msh", "Orientation = fixed") +
                                  (rocks.empty() ? "" : section("Sample", "Rocks = " + name + ".csv")) +
                                  section("Tests", "List = direct_tension", "Stop strain = " + stop));
    run_to_end(folder, "multiscale " + name + ".prm --output " + name + " --quiet");
    return folder / name;
  };
  const auto stress = [](const fs::path& out) {
    return cell(out / "curves/direct_tension_seed_1.csv", "axial_stress_Pa", 10);
  };
  const double whole = stress(run("whole", "", "2e-5"));
  const double half = stress(run("half", "group,Flat joint/Modulus [GPa]\nright_column,40\n", "2e-5"));
  const double quarters =
    stress(run("both", "group,Flat joint/Modulus [GPa]\nleft_column,40\nright_column,20\n", "2e-5"));
  EXPECT_NEAR(half, 0.75 * whole, 1e-4 * whole); // Newton tolerance 1e-5
  EXPECT_NEAR(quarters, 0.375 * whole, 1e-4 * whole);

  const std::string weak =
    "group,Flat joint/Bond tensile strength [MPa],Flat joint/Bond cohesion [MPa]\nright_column,4,30\n";
  EXPECT_EQ(cells_that_broke(run("weak", weak, "5e-5")), (std::set<int>{1}));
  run_to_end(folder, "multiscale weak --extract 1:0 --quiet");
  folder.write("weak.csv", "group,Flat joint/Modulus [GPa]\nseam,20\n");
  expect_refused(folder, "multiscale weak --extract 1:0 --quiet", "weak.csv is not as it was when the run began");

  // A mineral has one number in all rocks: mica, the second one of the left column and the first one of the right column,
  // where it and its boundaries with biotite break.
  folder.write("strong.csv", "mineral,share [%],size [mm]\nquartz,50,4\nmica,50,4\n");
  folder.write("brittle.csv", "mineral,share [%],size [mm],tensile_strength_ratio,cohesion_ratio\n"
                              "mica,50,4,0.1,0.1\nbiotite,50,4,1,1\n");
  const fs::path mixed =
    run("mixed",
        "group,Minerals/Table,Flat joint/Bond tensile strength [MPa],Flat joint/Bond cohesion [MPa]\n"
        "left_column,strong.csv,60,500\nright_column,brittle.csv,40,300\n",
        "8e-5");
  EXPECT_EQ(cells_that_broke(mixed), (std::set<int>{1}));
  const auto one_side = column(mixed / "cracks.csv", "mineral_1");
  EXPECT_EQ(std::set<double>(one_side.begin(), one_side.end()), std::set{2.0});
  const auto other_side = column(mixed / "cracks.csv", "mineral_2");
  EXPECT_EQ(std::set<double>(other_side.begin(), other_side.end()), (std::set{2.0, 3.0}));

  const auto refused = [&](const std::string& rocks, const std::string& words) {
    folder.write("bad.csv", rocks);
    folder.write("bad.prm", small + section("Sample", "Mesh file = columns.msh", "Rocks = bad.csv") +
                              section("Tests", "List = direct_tension"));
    expect_refused(folder, "multiscale bad.prm --output bad", words);
  };
  refused("group,Flat joint/Modulus [GPa]\nseam,20\n",
          "Sample/Mesh file = columns.msh: no group of cells is named seam; the mesh has left_column, right_column");
  refused("rock,Flat joint/Modulus [GPa]\nseam,20\n", "bad.csv:1: ");
  refused("group,group\nleft_column,right_column\n", "bad.csv:1: the column \"group\" is there twice");
  refused("group,Specimen/Width [mm]\nleft_column,20\n", "Specimen/Width is one for all rocks of a sample");
  folder.write("half.csv", "mineral,share [%],size [mm]\nquartz,50,4\n");
  refused("group,Minerals/Table\nleft_column,strong.csv\nright_column,half.csv\n",
          "half.csv: the shares add up to 50 %");
  refused("group,Flat joint/Segments\nleft_column,3\nleft_column,4\n", "each row needs a group of its own; row 2 has");
}

TEST(Multiscale, SaysInOneLineWhatIsWrongWithAMesh)
{
  TemporaryFolder folder;
  folder.write("bad.prm", small + section("Sample", "Mesh file = bad.msh") + section("Tests", "List = direct_tension"));
  const auto refused = [&](const std::string& mesh, const std::string& words) {
    folder.write("bad.msh", mesh);
    expect_refused(folder, "multiscale bad.prm --output out",
                   "feldspar: bad.prm: Sample/Mesh file = bad.msh: " + words);
  };
  refused(two_squares("roof", squares),
          "no boundary is named top; the mesh has bottom, left, right, roof; set Mesh names = top = NAME");
  refused(two_squares("top", squares, "-0.001 0.012"), "the cell at");
  refused(two_squares("top", "10\n" + sides + "7 2 2 5 1 1 2 4\n8 2 2 5 1 1 4 3\n9 2 2 5 1 3 4 6\n10 2 2 5 1 3 6 5\n"),
          "has cells that are not quadrilaterals; in Gmsh recombine the mesh");
  // A second coordinate that counts the depth.
  const auto named = [](const std::string& low, const std::string& high) {
    std::string mesh = two_squares("name", squares);
    mesh.replace(mesh.find("\"bottom\""), 8, '"' + low + '"');
    return mesh.replace(mesh.find("\"name\""), 6, '"' + high + '"');
  };
  refused(named("top", "bottom"), "top lies below bottom: top at y = 0 m, bottom at y = 0.024 m; y counts upwards, so "
                                  "mirror a depth (y -> -y)");
  refused(two_squares_in_millimetres(),
          "in metres the mesh is 12 m wide and 24 m high; if its coordinates are in another unit, set "
          "Mesh unit = mm");
  // A section that begins beside the axis: the file is named once.
  std::string ring = two_squares("top", squares, "0.022 0.012");
  for (const auto& [there, instead] : {std::pair("\"left\"", "\"axis\""),
                                       {"\"right\"", "\"side\""},
                                       {"\n1 0 0 0\n2 0.012 0 0\n3 0 ", "\n1 0.01 0 0\n2 0.022 0 0\n3 0.01 "},
                                       {"\n5 0 0.024 0\n6 0.012 ", "\n5 0.01 0.024 0\n6 0.022 "}})
    ring.replace(ring.find(there), std::string(there).size(), instead);
  folder.write("bad.prm",
               section("Sample", "Material = linear elasticity", "Geometry = axisymmetric", "Mesh file = bad.msh") +
                 section("Tests", "List = direct_tension", "Stop strain = 1e-5"));
  refused(ring, "begins at x = 0.01 m; in r-z the axis is x = 0");
}

TEST(Multiscale, ASpecimenFileIsOneRealisation)
{
  TemporaryFolder folder;
  folder.write("cell.prm", small + section("Tests", "List = direct_tension"));
  run_to_end(folder, "specimen cell.prm --output cell --quiet");
  folder.write("pull.prm", small + section("Tests", "List = direct_tension") +
                             section("Specimen", "Specimen file = cell/specimen.h5"));
  expect_refused(folder, "multiscale pull.prm --output out", "Sample/Realisations: a Specimen file is one realisation");
}

TEST(Multiscale, RefusesAConfinementBeyondSmallStrains)
{
  // Below that no confinement is too much: in small strains pressure on all sides breaks no RVE for good.
  TemporaryFolder folder;
  folder.write("press.prm",
               small + section("Tests", "List = direct_tension, triaxial_compression", "Confinements = 20, 10000 MPa"));
  expect_refused(folder, "multiscale press.prm --output beyond --quiet",
                 "press.prm: Tests/Confinements: 10000 MPa would strain the intact RVE by");
}

TEST(Multiscale, ComparesWithLinearElasticityAndMohrCoulomb)
{
  const TemporaryFolder folder;
  const auto curve_of = [&](const std::string& material) {
    folder.write("press.prm", section("Sample", "Elements across = 1", "Elements along = 2", "Compression step = 1e-4",
                                      "Material = " + material) +
                                section("Continuum", "Modulus = 60 GPa", "Poisson ratio = 0.2", "Cohesion = 30 MPa",
                                        "Friction angle = 50 deg", "Dilation angle = 10 deg") +
                                section("Tests", "List = uniaxial_compression", "Stop strain = 0.004"));
    run_to_end(folder, "multiscale press.prm --output out --force --quiet");
    return read_columns(folder / "out/curves/uniaxial_compression_seed_1.csv");
  };
  const double volume = 0.05 * 0.1; // 50 mm x 100 mm x 1 m
  // The modulus and the ratio asked for are those of the curve.
  const auto elastic = curve_of("linear elasticity");
  EXPECT_NEAR(elastic.at("axial_stress_Pa").at(40), 60e9 * 0.004, 1e-6 * 60e9 * 0.004);
  EXPECT_NEAR(elastic.at("gauge_lateral_strain").at(40), -0.2 * 0.004, 1e-6 * 0.004);
  // The work of the platens: ½ σ ε of the volume where all of it is elastic, stored in full.
  EXPECT_NEAR(elastic.at("platen_work_J").at(40) / volume, 0.5 * 60e9 * 0.004 * 0.004,
              1e-6 * 0.5 * 60e9 * 0.004 * 0.004);
  const auto imbalance = [&] {
    return summary_of(folder / "out").at("tests").at(0).at("energy_imbalance_over_work").get<double>();
  };
  EXPECT_LT(imbalance(), 1e-6); // the strain of the tolerance
  // Elastic up to q_u = 2 c cos φ/(1 - sin φ) = 164.85 MPa at 2.7475e-3, and no further.
  const auto plastic = curve_of("Mohr-Coulomb");
  EXPECT_NEAR(plastic.at("axial_stress_Pa").at(20), 60e9 * 0.002, 1e-6 * 60e9 * 0.002);
  const double phi = 50.0 * std::numbers::pi / 180.0;
  const double strength = 2.0 * 30e6 * std::cos(phi) / (1.0 - std::sin(phi));
  EXPECT_NEAR(plastic.at("axial_stress_Pa").at(40), strength, 1e-4 * strength); // Sample/Newton tolerance
  const auto test = summary_of(folder / "out").at("tests").at(0);
  EXPECT_NEAR(test.at("peak_stress_Pa").get<double>(), strength, 1e-4 * strength); // though it never falls
  // Beyond the yield strain the work is σ of it, with an error of the trapezoid over the one step with the kink.
  const double expected = strength * (0.004 - 0.5 * strength / 60e9);
  EXPECT_NEAR(plastic.at("platen_work_J").at(40) / volume, expected, 2e-3 * expected);
  EXPECT_LT(imbalance(), 2e-3);
  expect_refused(folder, "multiscale out --extract 0:0", "the points of this sample have no grains");
}

// Without grains, so that the closed form is at hand: a cylinder under pressure, as half of its section and as a whole,
// responds with Young's modulus and Poisson's ratio; plane strain with E/(1 - ν²) and ν/(1 - ν).
TEST(Multiscale, TakesCylindersAndPlaneStrain)
{
  TemporaryFolder folder;
  const auto last_row = [&](const std::string& sample) {
    folder.write(
      "press.prm",
      section("Sample", "Width = 50 mm", "Height = 100 mm", "Material = linear elasticity", "Compression step = 1e-4") +
        sample + section("Continuum", "Modulus = 60 GPa", "Poisson ratio = 0.2") +
        section("Tests", "List = triaxial_compression", "Confinements = 10 MPa", "Stop strain = 0.001"));
    run_to_end(folder, "multiscale press.prm --output out --force --quiet");
    std::map<std::string, double> values;
    for (const auto& [name, column] : read_columns(folder / "out/curves/triaxial_compression_10_MPa_seed_1.csv"))
      values[name] = column.at(10);
    return values;
  };
  constexpr double E = 60e9;
  constexpr double nu = 0.2;
  for (const std::string& sample :
       {section("Sample", "Geometry = axisymmetric", "Elements across = 2", "Elements along = 4"),
        section("Sample", "Geometry = cylinder", "Elements across = 4", "Elements along = 4", "Order = 2",
                "Quadrature = reduced")})
    {
      auto last = last_row(sample);
      EXPECT_NEAR(last["axial_stress_Pa"], 10e6 + E * 1e-3, 1e-6 * E * 1e-3) << sample;
      EXPECT_NEAR(last["gauge_lateral_strain"], -nu * 1e-3, 1e-6 * 1e-3) << sample;
      EXPECT_NEAR(last["gauge_volumetric_strain"], (1.0 - 2.0 * nu) * 1e-3, 1e-6 * 1e-3) << sample;
    }
  auto strip = last_row(section("Sample", "Geometry = plane strain"));
  EXPECT_NEAR(strip["axial_stress_Pa"], 10e6 + E / (1.0 - nu * nu) * 1e-3, 1e-6 * E * 1e-3);
  EXPECT_NEAR(strip["gauge_lateral_strain"], -nu / (1.0 - nu) * 1e-3, 1e-6 * 1e-3);
}

// A cylinder of one realisation in the axes r, θ, z of each point is the same as a whole, by half of its section, and
// by its RVE alone, whose sides are free: also where segments break, up to nine tenths of the strength. The remaining
// difference: a ring and a radius have one strain on the axis, and an RVE of seventy spheres has not.
TEST(Multiscale, ACylinderIsTheSameAsAWholeByItsSectionAndByItsRve)
{
  TemporaryFolder folder;
  const std::string cell_of_spheres =
    section("Specimen", "Dimension = 3", "Shape = periodic", "Width = 7 mm", "Height = 7 mm");
  folder.write("rve.prm", cell_of_spheres + section("Strain path", "Direction = free, free, 1, free, free, free",
                                                    "Size = 2.4e-4", "Largest step = 1e-5"));
  run_to_end(folder, "rve rve.prm --output rve --quiet");
  const auto strain = column(folder / "rve/curves/rve.csv", "strain_zz");
  const auto stress = column(folder / "rve/curves/rve.csv", "stress_zz_Pa");
  const auto of_rve = [&](const double wanted) {
    for (std::size_t k = 1; k < strain.size(); ++k)
      if (strain[k] >= wanted)
        return stress[k - 1] + (stress[k] - stress[k - 1]) * (wanted - strain[k - 1]) / (strain[k] - strain[k - 1]);
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (const auto& [name, geometry, across] :
       {std::tuple<std::string, const char*, const char*>{"section", "Geometry = axisymmetric", "Elements across = 2"},
        {"whole", "Geometry = cylinder", "Elements across = 4"}})
    {
      folder.write(name + ".prm",
                   cell_of_spheres +
                     section("Sample", "Width = 12 mm", "Height = 24 mm", geometry, across, "Elements along = 4",
                             "Orientation = fixed", "Realisations = 1", "Tension step = 1e-5") +
                     section("Tests", "List = direct_tension", "Stop strain = 2e-4"));
      run_to_end(folder, fmt::format("multiscale {0}.prm --output {0} --quiet", name));
      const auto curve = folder / name / "curves/direct_tension_seed_1.csv";
      const auto its_strain = column(curve, "axial_strain");
      const auto its_stress = column(curve, "axial_stress_Pa");
      for (std::size_t k = 1; k < its_strain.size(); ++k)
        EXPECT_NEAR(its_stress[k], of_rve(its_strain[k]), 0.01 * of_rve(its_strain[k])) << name << " " << k;
      EXPECT_GT(its_stress.back(), 0.9 * *std::max_element(stress.begin(), stress.end())) << name;
      EXPECT_GT(column(curve, "n_tension_cracks").back(), 50.0) << name;
    }

  const auto extract = run_to_end(folder, "multiscale whole --extract 5:6");
  EXPECT_TRUE(has_words(extract.output, " deg about (0.000, 0.000, "));
}

// A sample between smooth platens is in one state as long as it does not soften: that of its RVE along the same path, within
// the tolerance of Newton's method.
TEST(Multiscale, TakesParallelBondsAndBondsThatSoften)
{
  TemporaryFolder folder;
  const std::string tension = "direct_tension", compression = "uniaxial_compression";
  for (const auto& [law, test, size, step] :
       std::vector<std::array<std::string, 4>>{{"parallel bond", tension, "7.2e-4", "4e-5"},
                                               {"parallel bond", compression, "1.1e-3", "1e-4"},
                                               {"softening flat joint", tension, "1.5e-4", "1e-5"},
                                               {"softening flat joint", compression, "1e-3", "5e-5"}})
    {
      SCOPED_TRACE(law + ", " + test);
      const std::string cell =
        section("Specimen", "Shape = periodic", "Width = 14 mm", "Height = 14 mm", "Joint law = " + law);
      folder.write("path.prm",
                   cell + section("Strain path",
                                  test == tension ? "Direction = free, 1, free" : "Direction = free, -1, free",
                                  "Size = " + size, "Largest step = " + step));
      folder.write("sample.prm", cell +
                                   section("Sample", "Width = 24 mm", "Height = 48 mm", "Elements across = 2",
                                           "Elements along = 4", "Orientation = fixed", "Realisations = 1",
                                           "Tension step = " + step, "Compression step = " + step) +
                                   section("Tests", "List = " + test, "Stop strain = " + size));
      run_to_end(folder, "rve path.prm --output path --quiet --force");
      run_to_end(folder, "multiscale sample.prm --output sample --quiet --force");
      const auto curve = folder / fmt::format("sample/curves/{}_seed_1.csv", test);
      const double modulus = column(folder / "path/curves/rve.csv", "stress_yy_Pa").back() /
                             column(folder / "path/curves/rve.csv", "strain_yy").back();
      const double of_sample = column(curve, "axial_stress_Pa").back() / column(curve, "axial_strain").back();
      EXPECT_NEAR(of_sample, modulus, 1e-3 * modulus) << test;
      EXPECT_GT(column(curve, "axial_stress_Pa").size(), 10u) << test;
    }
}

TEST(Multiscale, HoldsTheConfinementBetweenRoughPlatens)
{
  TemporaryFolder folder;
  folder.write("press.prm",
               small + section("Sample", "Platens = rough", "Orientation = fixed", "Order = 2") +
                 section("Tests", "List = triaxial_compression", "Confinements = 20 MPa", "Stop strain = 1e-4"));
  run_to_end(folder, "multiscale press.prm --output out --quiet");
  // Seated in one step: the strain counts from here, and the mean stress over all points balances the pressure.
  const auto curve = folder / "out/curves/triaxial_compression_20_MPa_seed_1.csv";
  EXPECT_TRUE(has_words(content(curve), "\n1,0,"));
  EXPECT_NEAR(cell(curve, "mid_stress_Pa", 0), 20e6, 1e-4 * 20e6); // Newton tolerance 1e-5
}

// One RVE at all points of three rows of two: but for the seed nothing tells them apart, and they break at a strain of
// 1.9e-4. With a fifth of the strength the seed breaks at a fifth of it, and what it leaves to its neighbours is at most
// twice that. The row at mid-height is that of the cells 2 and 3, its element to the right the latter.
TEST(Multiscale, BreaksFirstWhereItsWeakSeedIs)
{
  TemporaryFolder folder;
  const auto breaks_in = [&](const std::string& seed) {
    folder.write("weak.prm", replaced(replaced(of_one_rve(), "Elements across = 1", "Elements across = 2"),
                                      "Elements along = 2", "Elements along = 3") +
                               section("Sample", "Orientation = fixed", "Tension step = 5e-6", "Weak seed = " + seed,
                                       "Weak seed strength = 0.2") +
                               section("Tests", "List = direct_tension", "Stop strain = 5e-5"));
    run_to_end(folder, "multiscale weak.prm --output " + seed + " --force --quiet");
    return cells_that_broke(folder / seed);
  };
  EXPECT_EQ(breaks_in("row"), (std::set<int>{2, 3}));
  EXPECT_EQ(breaks_in("element"), (std::set<int>{3}));
  EXPECT_EQ(breaks_in("none"), (std::set<int>{}));
}

TEST(Multiscale, SaysInOneLineWhatItCannotDo)
{
  TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const std::string& part) {
    folder.write("bad.prm", text);
    expect_refused(folder, "multiscale bad.prm --output out", part);
  };
  expect(small + section("Tests", "List = brazilian"),
         "bad.prm: Tests/List: brazilian: the sample stands between platens");
  expect(section("Specimen", "Shape = box"), "bad.prm: Specimen/Shape = box: the RVE at a point needs");
  expect(small + section("Sample", "Control past the peak = lateral strain") +
           section("Tests", "List = uniaxial_compression"),
         "bad.prm: Sample/Control past the peak = lateral strain: the axial strain may go back");
  expect(small + section("Tests", "Lateral boundary = membrane"),
         "bad.prm: Tests/Lateral boundary = membrane: is of tests on specimens of grains");
  expect(small + section("Tests", "Intermediate stress = 30 MPa"),
         "bad.prm: Tests/Intermediate stress = 30 MPa: presses on two sides of a box");
  expect(replaced(replaced(small, "along = 2", "along = 10000"), "across = 1", "across = 1000"),
         "bad.prm: Sample/Elements across = 1000, Elements along = 10000: some 1e+07 cells");
  expect(small + section("Specimen", "Dimension = 3"), "bad.prm: Specimen/Dimension = 3: ");
  expect(small + section("Sample", "Geometry = cylinder"), "bad.prm: Specimen/Dimension = 2: the RVEs of such a");
  expect(std::regex_replace(small, std::regex("14 mm"), "6 mm") + section("Specimen", "Dimension = 3") +
           section("Sample", "Geometry = cylinder"),
         "bad.prm: Sample/Elements across = 1: a cylinder of 1 cells across: there must be at least 3");
  expect(small + section("Sample", "Quadrature = reduced"), "bad.prm: Sample/Quadrature = reduced: needs Order = 2");
  expect(small + section("Sample", "Order = 3"), "Sample/Order = 3: must be an integer in [1, 2]");
  expect(small + section("Sample", "Material = linear elasticity"),
         "bad.prm: Tests/Stop strain = none: linear elasticity does not soften");
  expect(small + section("Sample", "Material = Mohr-Coulomb", "Weak seed = row") +
           section("Tests", "Stop strain = 1e-5"),
         "bad.prm: Sample/Weak seed: weakens the bonds between grains; it needs Material = grains");
  expect(small + section("Sample", "Weak seed = row", "Weak seed strength = 1.1"),
         "Sample/Weak seed strength = 1.1: must lie in (0, 1]");
  expect(small + section("Tests", "Stop strain = 1e-5") + section("Continuum", "Dilation angle = 60 deg"),
         "bad.prm: Continuum/Dilation angle: must be at most Continuum/Friction angle");
}

TEST(Multiscale, TakesAFlawedRve)
{
  // One element between smooth platens is strained alike throughout: it carries what its RVE does alone, pulled with
  // its sides free.
  const TemporaryFolder folder;
  const std::string flaw = section("Flaws", "Shapes = closed flaw from 4, 7 mm to 10, 7 mm");
  const std::string sample =
    replaced(of_one_rve(), "along = 2", "along = 1") +
    section("Sample", "Platens = smooth", "Order = 1", "Orientation = fixed", "Tension step = 5e-6") +
    section("Tests", "List = direct_tension", "Stop strain = 5e-5") + flaw;
  folder.write("sample.prm", sample);
  folder.write("rve.prm", section("Specimen", "Shape = periodic", "Width = 14 mm", "Height = 14 mm") +
                            section("Strain path", "Direction = free, 1, free", "Size = 5e-5", "Largest step = 5e-6") +
                            flaw);
  const auto run = run_to_end(folder, "multiscale sample.prm --output sample --quiet");
  EXPECT_EQ(run.error.find("Flaws"), std::string::npos) << run.error;
  run_to_end(folder, "rve rve.prm --output rve --quiet");
  const double of_rve = column(folder / "rve/curves/rve.csv", "stress_yy_Pa").back();
  EXPECT_NEAR(column(folder / "sample/curves/direct_tension_seed_1.csv", "axial_stress_Pa").back(), of_rve,
              1e-5 * of_rve); // the tolerance of Newton's method

  // Turned at random, the flaws turn too, and it is said.
  folder.write("turned.prm", replaced(replaced(sample, "Orientation = fixed", "Orientation = random"),
                                      "Stop strain = 5e-5", "Stop strain = 5e-6"));
  const auto turned = run_to_end(folder, "multiscale turned.prm --output turned --quiet");
  EXPECT_TRUE(has_words(turned.error, "they keep their directions by Sample/Orientation = fixed"));
}

TEST(Multiscale, WarnsOfElementsLargerThanTheRve)
{
  TemporaryFolder folder;
  folder.write("large.prm",
               replaced(replaced(small, "Width = 12 mm", "Width = 40 mm"), "Height = 24 mm", "Height = 80 mm") +
                 section("Tests", "List = uniaxial_compression", "Stop strain = 4e-5"));
  const auto outcome = run_without_pictures(folder, "multiscale large.prm --output out --quiet");
  EXPECT_TRUE(has_words(outcome.error, "elements of 40.0 mm are larger than the RVE of 14.0 mm",
                        "Elements across = 3, Elements along = 6"));
}
} // namespace
} // namespace feldspar::tests
