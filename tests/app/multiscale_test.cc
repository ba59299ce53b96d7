#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
namespace feldspar
{
namespace
{
using tests::run_feldspar;
using tests::run_without_pictures;
using tests::TemporaryFolder;

std::string input(const std::string& sample, const std::string& tests, const std::string& specimen = "")
{
  return "subsection Specimen\n  set Shape = periodic\n  set Width = 14 mm\n  set Height = 14 mm\n" + specimen +
         "end\n"
         "subsection Representative volume\n  set Final tolerance = 1e-6\nend\n"
         "subsection Sample\n"
         "  set Width = 12 mm\n  set Height = 24 mm\n  set Elements across = 1\n  set Elements along = 2\n"
         "  set Realisations = 2\n" +
         sample + "end\nsubsection Tests\n" + tests + "end\n";
}

std::string contents(const std::filesystem::path& file)
{
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A column of a table, by the name at its head.
std::vector<double> column(const std::filesystem::path& curve, const std::string& name)
{
  std::ifstream file(curve);
  std::string line;
  std::getline(file, line);
  std::size_t wanted = 0;
  std::istringstream head(line);
  for (std::string entry; std::getline(head, entry, ',') && entry != name;)
    ++wanted;
  std::vector<double> values;
  while (std::getline(file, line))
    {
      std::istringstream row(line);
      std::string entry;
      for (std::size_t k = 0; k <= wanted; ++k)
        std::getline(row, entry, ',');
      values.push_back(std::stod(entry));
    }
  return values;
}

TEST(Multiscale, PullsASampleApartToTheSameBitsForAnyNumberOfThreads)
{
  TemporaryFolder folder;
  folder.write("pull.prm", input("  set Order = 1\n  set Platens = smooth\n  set Orientation = random\n"
                                 "  set Tension step = 5e-6\n  set Compression step = 4e-5\n"
                                 "  set Most broken share = 0.01\n  set Smallest step share = 0.0625\n"
                                 "  set Newton tolerance = 1e-5\n  set Softening = scaled\n",
                                 "  set List = direct_tension\n"));
  const auto run = run_feldspar(folder.path(), "multiscale pull.prm --output one --quiet --threads 1");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto summary = nlohmann::json::parse(contents(folder.path() / "one/summary.json"));
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
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;

  // Each equilibrium is a row of steps.csv: together they took what the whole test took.
  const auto steps = [&](const char* const name) { return column(folder.path() / "one/steps.csv", name); };
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
  const auto strain = column(folder.path() / "one/curves/direct_tension_seed_1.csv", "axial_strain");
  EXPECT_NEAR(steps("axial_strain").back(), strain.back(), 1e-8 * strain.back());
  const std::string trust = contents(folder.path() / "one/tables/trust.csv");
  EXPECT_NE(trust.find("unbalanced over internal force of a sample"), std::string::npos) << trust;

  ASSERT_EQ(run_feldspar(folder.path(), "multiscale pull.prm --output two --quiet --threads 2").exit_code, 0);
  for (const char* const file : {"cracks.csv", "emission.csv", "steps.csv", "curves/direct_tension_seed_1.csv"})
    EXPECT_EQ(contents(folder.path() / "one" / file), contents(folder.path() / "two" / file)) << file;

  // Beside a specimen of grains both are series of one report.
  folder.write("grains.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                             "subsection Tests\n  set List = direct_tension\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "lab grains.prm --output grains --quiet").exit_code, 0);
  const auto report = run_feldspar(folder.path(), "report grains one --output both");
  ASSERT_EQ(report.exit_code, 0) << report.error;
  const std::string page = contents(folder.path() / "both/report.html");
  for (const char* const words : {"</span>grains</h3>", "</span>one</h3>",
                                  "finite elements with a representative volume of grains at every point",
                                  "broken segments of the representative volume at each point",
                                  "Each row of a curve is an equilibrium, found without time"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(page.find("class=\"absent\""), std::string::npos);
  const std::string strengths = contents(folder.path() / "both/tables/strengths.csv");
  EXPECT_NE(strengths.find("Direct tension,grains,1,"), std::string::npos) << strengths;
  EXPECT_NE(strengths.find("Direct tension,one,1,"), std::string::npos) << strengths;
}

const std::string pull =
  input("  set Tension step = 5e-6\n", "  set List = direct_tension\n  set Stop strain = 3e-4\n");

/// The forces of both ends are equal to Newton's tolerance, 1e-5, of what an end carries in this row or the one before.
void expect_ends_to_agree(const std::filesystem::path& curve)
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
  folder.write("press.prm", input("  set Compression step = 1e-4\n  set Control past the peak = lateral strain\n",
                                  "  set List = uniaxial_compression\n  set Stop stress over peak = 0.8\n"));
  const auto run = run_without_pictures(folder.path(), "multiscale press.prm --output run --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto curve = folder.path() / "run/curves/uniaxial_compression_seed_1.csv";
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
  EXPECT_FALSE(nlohmann::json::parse(contents(folder.path() / "run/summary.json"))["tests"][0].contains("ended_early"));
}

// Up, down, further up and down, then towards more than the sample carries. Cracks open above the highest strain there
// was (Kaiser's effect); what has cracked is softer, so that the way down is flatter each time, and some strain is
// left.
TEST(Multiscale, FollowsALoadingTable)
{
  TemporaryFolder folder;
  folder.write("cycles.csv", "axial_strain,axial_stress_Pa\n0.0016,\n,1e6\n0.0022,\n,1e6\n,900e6\n");
  folder.write("cycles.prm", input("  set Compression step = 1e-4\n",
                                   "  set List = own_loading\n  set Loading table = cycles.csv\n"));
  const auto run = run_feldspar(folder.path(), "multiscale cycles.prm --output run");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto test = nlohmann::json::parse(contents(folder.path() / "run/summary.json"))["tests"][0];
  const auto& stages = test.at("stages");
  ASSERT_EQ(stages.size(), 5u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_TRUE(stages[k].at("reached")) << k;
  EXPECT_FALSE(stages[4].at("reached"));
  // On the screen and on the page, too.
  EXPECT_NE(run.output.find("\n2: axial stress 1 MPa "), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("\n5: axial stress 900 MPa, not reached "), std::string::npos) << run.output;
  EXPECT_NE(contents(folder.path() / "run/report.html").find("<th scope=\"row\">2: axial stress 1 MPa</th>"),
            std::string::npos);
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
  const auto strain = column(folder.path() / "run/curves/own_loading_seed_1.csv", "axial_strain");
  const auto cracks = column(folder.path() / "run/curves/own_loading_seed_1.csv", "n_tension_cracks");
  const std::size_t turned = stages[2].at("first_row");
  for (std::size_t k = turned; k < strain.size() && strain[k] < 0.0014; ++k) // 0.0016 was the highest so far
    EXPECT_LT(cracks[k], cracks[turned] + 0.05 * figure(0, "n_cracks")) << strain[k];
}

TEST(Multiscale, KilledAndResumedGoesOnToTheSameBits)
{
  TemporaryFolder folder;
  folder.write("pull.prm", pull);
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet").exit_code, 0);
  // Killed once a state is there, and again and again after it; the last time left to its end.
  folder.write("kill", "\"$@\" &\n"
                       "until ls broken/states/direct_tension_seed_1/step-* >/dev/null 2>&1; do sleep 0.02; done\n"
                       "sleep 0.1\nkill -KILL $!\n");
  run_feldspar(folder.path(), "multiscale pull.prm --output broken --quiet", "sh ./kill");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "broken/summary.json")); // else it was not killed on its way
  run_feldspar(folder.path(), "multiscale --resume broken --quiet", "timeout --foreground --signal=KILL 0.6");
  const auto last = run_without_pictures(folder.path(), "multiscale --resume broken --quiet");
  ASSERT_EQ(last.exit_code, 0) << last.error;
  for (const char* const file : {"cracks.csv", "emission.csv", "steps.csv", "curves/direct_tension_seed_1.csv",
                                 "fields/direct_tension_seed_1.xdmf"})
    EXPECT_EQ(contents(folder.path() / "whole" / file), contents(folder.path() / "broken" / file)) << file;
  EXPECT_NE(run_feldspar(folder.path(), "multiscale --resume broken").output.find("this run is complete"),
            std::string::npos);
}

// Open MPI's default guards each shared file by a semaphore of its name. It stays taken by a run that is killed meanwhile, and
// every later run that writes a file of that name waits for it: this one would be ended after half a minute.
TEST(Multiscale, DoesNotWaitForASemaphoreThatAKilledRunHasTaken)
{
  const TemporaryFolder folder;
  folder.write("press.prm", input("  set Material = linear elasticity\n",
                                  "  set List = uniaxial_compression\n  set Stop strain = 1e-4\n"));
  const char* const name = "/OMPIO_uniaxial_compression_seed_1.h5";
  sem_t* const taken = sem_open(name, O_CREAT, 0600, 0);
  ASSERT_NE(taken, SEM_FAILED) << std::strerror(errno);
  const auto run = run_feldspar(folder.path(), "multiscale press.prm --output out --quiet", "timeout 30 ");
  sem_close(taken);
  sem_unlink(name);
  EXPECT_EQ(run.exit_code, 0) << run.error << " (124: it waited)";
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/fields/uniaxial_compression_seed_1.xdmf"));
}

TEST(Multiscale, EndsCleanlyOnInterruptAndSaysHowToResume)
{
  TemporaryFolder folder;
  folder.write("pull.prm", pull);
  folder.write("interrupt", "\"$@\" &\n"
                            "until ls out/states/direct_tension_seed_1/step-* >/dev/null 2>&1; do sleep 0.02; done\n"
                            "kill -INT $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "multiscale pull.prm --output out --quiet", "sh ./interrupt");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar multiscale --resume out\n");
  const auto summary = nlohmann::json::parse(contents(folder.path() / "out/summary.json"));
  EXPECT_EQ(summary.at("tests").at(0).at("interrupted"), true);
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale --resume out --quiet").exit_code, 0);
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale pull.prm --output whole --quiet").exit_code, 0);
  for (const char* const file : {"cracks.csv", "emission.csv", "steps.csv", "curves/direct_tension_seed_1.csv"})
    EXPECT_EQ(contents(folder.path() / "whole" / file), contents(folder.path() / "out" / file)) << file;
}

/// The number in a column of a row of a CSV file, both from 0 below the header.
double cell(const std::filesystem::path& file, const std::string& column, const std::size_t row)
{
  std::istringstream lines(contents(file));
  std::string line, name;
  std::getline(lines, line);
  std::size_t place = 0;
  for (std::istringstream names(line); std::getline(names, name, ',') && name != column;)
    ++place;
  for (std::size_t k = 0; k <= row; ++k)
    std::getline(lines, line);
  std::istringstream cells(line);
  for (std::size_t k = 0; k <= place; ++k)
    std::getline(cells, name, ',');
  return std::stod(name);
}

TEST(Multiscale, ExtractsTheRveAtAPointForRveAndParaView)
{
  TemporaryFolder folder;
  const std::string path = "subsection Strain path\n  set Direction = 0, 1, 0\n  set Size = 1e-6\nend\n";
  const auto continued = [&](const std::string& rve) {
    folder.write("rve.prm",
                 "subsection Specimen\n  set Shape = periodic\n  set Specimen file = " + rve + "\nend\n" + path);
    const auto run = run_feldspar(folder.path(), "rve rve.prm --output rve --force --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return folder.path() / "rve/curves/rve.csv";
  };

  // One RVE, not turned, at every point of a sample between smooth platens, nothing broken: strain is uniform, so
  // that the RVE has the strain and the stress of the sample, none sideways.
  std::string even = input("  set Orientation = fixed\n", "  set List = direct_tension\n  set Stop strain = 3.9e-5\n");
  even.replace(even.find("Realisations = 2"), 16, "Realisations = 1");
  folder.write("even.prm", even);
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale even.prm --output even --quiet").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "multiscale even --extract 1:3").exit_code, 0);
  const auto curve = continued("even/extracted/direct_tension_seed_1_cell_1_point_3.h5");
  const auto of_sample = folder.path() / "even/curves/direct_tension_seed_1.csv";
  const std::size_t last = 20; // 4e-5 in steps of 2e-6, after the row at rest
  const double stress = cell(of_sample, "axial_stress_Pa", last);
  EXPECT_NEAR(cell(of_sample, "axial_strain", last), 4e-5, 1e-12);
  EXPECT_NEAR(cell(curve, "strain_yy", 0), 4e-5, 1e-9 * 4e-5);
  EXPECT_NEAR(cell(curve, "stress_yy_Pa", 0), stress, 1e-5 * stress); // Sample/Newton tolerance
  EXPECT_NEAR(cell(curve, "stress_xx_Pa", 0), 0.0, 1e-5 * stress);
  EXPECT_NEAR(cell(curve, "strain_yy", 1), 4.1e-5, 1e-9 * 4e-5); // and goes on from there

  // Between free sides the points have edges, whose states no other boundary takes. With one element across both
  // sides of the sample are free, and the strain is as uniform.
  folder.write("edges.prm", even + "subsection Representative volume\n  set Boundary = edge\nend\n");
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale edges.prm --output edges --quiet").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "multiscale edges --extract 1:3").exit_code, 0);
  const std::string of_edge = "edges/extracted/direct_tension_seed_1_cell_1_point_3.h5";
  const std::string edge_rve =
    "subsection Specimen\n  set Shape = periodic\n  set Specimen file = " + of_edge + "\nend\n" + path;
  folder.write("edge.prm", edge_rve);
  const auto other = run_feldspar(folder.path(), "rve edge.prm --output edge --quiet");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.error.find("its state is that of an RVE whose boundary is \"edge, x free\", and Representative "
                             "volume/Boundary is periodic"),
            std::string::npos)
    << other.error;
  folder.write("edge.prm", edge_rve + "subsection Representative volume\n  set Boundary = edge\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve edge.prm --output edge --quiet").exit_code, 0);
  const double of_edges = cell(folder.path() / "edges/curves/direct_tension_seed_1.csv", "axial_stress_Pa", last);
  EXPECT_NEAR(cell(folder.path() / "edge/curves/rve.csv", "stress_yy_Pa", 0), of_edges, 1e-5 * of_edges);
  EXPECT_LT(of_edges, 0.999 * stress);

  // Broken: the cracks of that point and no others.
  folder.write("pull.prm", pull);
  ASSERT_EQ(run_without_pictures(folder.path(), "multiscale pull.prm --output out --quiet").exit_code, 0);
  int most = 0;
  for (const int point : {1, 6}) // a process is slow to start
    {
      const std::string place = fmt::format("{}:{}", point / 4, point % 4);
      const auto extract = run_feldspar(folder.path(), "multiscale out --extract " + place);
      ASSERT_EQ(extract.exit_code, 0) << extract.error;
      int n_cracks = 0;
      std::istringstream cracks(contents(folder.path() / "out/cracks.csv"));
      for (std::string line; std::getline(cracks, line);)
        n_cracks += line.find(fmt::format(",{},", point)) == line.find(',', line.find(',') + 1);
      const std::string name = fmt::format("direct_tension_seed_1_cell_{}_point_{}", point / 4, point % 4);
      const auto rows = continued("out/extracted/" + name + ".h5");
      EXPECT_EQ(cell(rows, "n_tension_cracks", 0) + cell(rows, "n_shear_cracks", 0), n_cracks) << place;
      EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/extracted" / (name + "_fields_grains.pvd")));
      EXPECT_EQ(std::filesystem::exists(folder.path() / "out/extracted" / (name + "_fields_cracks.pvd")), n_cracks > 0);
      most = std::max(most, n_cracks);
    }
  EXPECT_GT(most, 5);

  // Who would begin without its state says so.
  const std::string in_its_state = "  set Specimen file = out/extracted/direct_tension_seed_1_cell_0_point_1.h5\n";
  std::string sample = input("", "  set List = direct_tension\n", in_its_state);
  sample.replace(sample.find("Realisations = 2"), 16, "Realisations = 1");
  folder.write("sample.prm", sample);
  folder.write("explicit.prm", "subsection Specimen\n" + in_its_state + "end\n" + path +
                                 "subsection Strain path\n  set Solver = explicit\nend\n");
  for (const auto& [command, words] : {std::pair("multiscale sample.prm", "a sample begins with intact ones"),
                                       {"rve explicit.prm", "explicit dynamics begin at rest"}})
    {
      const auto outcome = run_without_pictures(folder.path(), std::string(command) + " --output refused --quiet");
      EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
      EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error;
      EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    }

  const auto refused = [&](const std::string& place, const std::string& words) {
    const auto outcome = run_feldspar(folder.path(), "multiscale out --extract " + place);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  };
  refused("2:0", "there is no point 0 in a cell 2: cells are 0 to 1, their points 0 to 3");
  refused("1", "--extract 1: must be CELL:POINT");
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
  const std::string tests = "  set List = direct_tension\n  set Stop strain = 2e-5\n";
  folder.write("own.prm", input("", tests));
  folder.write("mesh.prm", input("  set Mesh file = squares.msh\n", tests));
  folder.write("millimetres.msh", two_squares_in_millimetres());
  folder.write("scaled.prm", input("  set Mesh file = millimetres.msh\n  set Mesh unit = mm\n", tests));
  // Top by another name, and a layer: a line between both squares.
  std::string layers = two_squares("roof", squares);
  layers.replace(layers.find("$Elements\n8"), 11, "$Elements\n9");
  folder.write("layers.msh", layers.replace(layers.find("7 3 2 5"), 0, "9 1 2 6 5 3 4\n"));
  folder.write("layers.prm", input("  set Mesh file = layers.msh\n  set Mesh names = top = roof\n", tests));
  for (const std::string name : {"own", "mesh", "scaled", "layers"})
    {
      const auto run = run_without_pictures(folder.path(), "multiscale " + name + ".prm --output " + name + " --quiet");
      ASSERT_EQ(run.exit_code, 0) << run.error;
    }
  // The mesh that Width, Height and the Elements of input() make, in the same order: the points have the same volumes.
  const auto stress = [&](const std::string& name) {
    return cell(folder.path() / name / "curves/direct_tension_seed_1.csv", "axial_stress_Pa", 10);
  };
  expect_ends_to_agree(folder.path() / "own/curves/direct_tension_seed_1.csv");
  EXPECT_NEAR(stress("mesh"), stress("own"), 1e-9 * stress("own"));
  EXPECT_NEAR(stress("scaled"), stress("own"), 1e-9 * stress("own"));
  EXPECT_EQ(stress("layers"), stress("mesh"));
  EXPECT_GT(stress("own"), 1e6);
}

/// Cells of which a segment broke; four points a cell.
std::set<int> cells_that_broke(const std::filesystem::path& run)
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
    std::string text = input("  set Mesh file = columns.msh\n  set Orientation = fixed\n" +
                               (rocks.empty() ? "" : "  set Rocks = " + name + ".csv\n"),
                             "  set List = direct_tension\n  set Stop strain = " + stop + "\n");
    text.replace(text.find("Realisations = 2"), 16, "Realisations = 1");
    folder.write(name + ".prm", text);
    const auto outcome =
      run_without_pictures(folder.path(), "multiscale " + name + ".prm --output " + name + " --quiet");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    return folder.path() / name;
  };
  const auto stress = [](const std::filesystem::path& out) {
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
  ASSERT_EQ(run_feldspar(folder.path(), "multiscale weak --extract 1:0 --quiet").exit_code, 0);
  folder.write("weak.csv", "group,Flat joint/Modulus [GPa]\nseam,20\n");
  const auto changed = run_feldspar(folder.path(), "multiscale weak --extract 1:0 --quiet");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_NE(changed.error.find("weak.csv is not as it was when the run began"), std::string::npos) << changed.error;
  EXPECT_EQ(std::count(changed.error.begin(), changed.error.end(), '\n'), 1) << changed.error;

  // A mineral has one number in all rocks: mica, the second one of the left column and the first one of the right column,
  // where it and its boundaries with biotite break.
  folder.write("strong.csv", "mineral,share [%],size [mm]\nquartz,50,4\nmica,50,4\n");
  folder.write("brittle.csv", "mineral,share [%],size [mm],tensile_strength_ratio,cohesion_ratio\n"
                              "mica,50,4,0.1,0.1\nbiotite,50,4,1,1\n");
  const std::filesystem::path mixed =
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
    folder.write("bad.prm",
                 input("  set Mesh file = columns.msh\n  set Rocks = bad.csv\n", "  set List = direct_tension\n"));
    const auto outcome = run_feldspar(folder.path(), "multiscale bad.prm --output bad");
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
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
  folder.write("bad.prm", input("  set Mesh file = bad.msh\n", "  set List = direct_tension\n"));
  const auto refused = [&](const std::string& mesh, const std::string& words) {
    folder.write("bad.msh", mesh);
    const auto outcome = run_feldspar(folder.path(), "multiscale bad.prm --output out");
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find("feldspar: bad.prm: Sample/Mesh file = bad.msh: " + words), std::string::npos)
      << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
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
  folder.write("bad.prm", "subsection Sample\n  set Material = linear elasticity\n  set Geometry = axisymmetric\n"
                          "  set Mesh file = bad.msh\nend\nsubsection Tests\n  set List = direct_tension\n"
                          "  set Stop strain = 1e-5\nend\n");
  refused(ring, "begins at x = 0.01 m; in r-z the axis is x = 0");
}

TEST(Multiscale, ASpecimenFileIsOneRealisation)
{
  TemporaryFolder folder;
  folder.write("cell.prm", input("", "  set List = direct_tension\n"));
  ASSERT_EQ(run_feldspar(folder.path(), "specimen cell.prm --output cell --quiet").exit_code, 0);
  folder.write("pull.prm", input("", "  set List = direct_tension\n", "  set Specimen file = cell/specimen.h5\n"));
  const auto outcome = run_feldspar(folder.path(), "multiscale pull.prm --output out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("Sample/Realisations: a Specimen file is one realisation"), std::string::npos)
    << outcome.error;
}

TEST(Multiscale, RefusesAConfinementBeyondSmallStrains)
{
  // Below that no confinement is too much: in small strains pressure on all sides breaks no RVE for good.
  TemporaryFolder folder;
  folder.write("press.prm", input("", "  set List = direct_tension, triaxial_compression\n"
                                      "  set Confinements = 20, 10000 MPa\n"));
  const auto refused = run_without_pictures(folder.path(), "multiscale press.prm --output beyond --quiet");
  EXPECT_EQ(refused.exit_code, 2) << refused.error;
  EXPECT_NE(refused.error.find("press.prm: Tests/Confinements: 10000 MPa would strain the intact RVE by"),
            std::string::npos)
    << refused.error;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "beyond"));
}

TEST(Multiscale, ComparesWithLinearElasticityAndMohrCoulomb)
{
  TemporaryFolder folder;
  const std::string start = "subsection Sample\n  set Elements across = 1\n  set Elements along = 2\n"
                            "  set Compression step = 1e-4\n  set Material = ";
  const std::string rest = "end\nsubsection Continuum\n  set Modulus = 60 GPa\n  set Poisson ratio = 0.2\n"
                           "  set Cohesion = 30 MPa\n  set Friction angle = 50 deg\n  set Dilation angle = 10 deg\n"
                           "end\nsubsection Tests\n  set List = uniaxial_compression\n  set Stop strain = 0.004\nend\n";
  const auto row = [&](const std::string& material, const std::string& column, const std::size_t k) {
    folder.write("press.prm", start + material + "\n" + rest);
    const auto run = run_without_pictures(folder.path(), "multiscale press.prm --output out --force --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return cell(folder.path() / "out/curves/uniaxial_compression_seed_1.csv", column, k);
  };
  // The modulus and the ratio asked for are those of the curve.
  EXPECT_NEAR(row("linear elasticity", "axial_stress_Pa", 40), 60e9 * 0.004, 1e-6 * 60e9 * 0.004);
  EXPECT_NEAR(row("linear elasticity", "gauge_lateral_strain", 40), -0.2 * 0.004, 1e-6 * 0.004);
  // Elastic up to q_u = 2 c cos φ/(1 - sin φ) = 164.85 MPa at 2.7475e-3, and no further.
  EXPECT_NEAR(row("Mohr-Coulomb", "axial_stress_Pa", 20), 60e9 * 0.002, 1e-6 * 60e9 * 0.002);
  const double phi = 50.0 * std::numbers::pi / 180.0;
  const double strength = 2.0 * 30e6 * std::cos(phi) / (1.0 - std::sin(phi));
  EXPECT_NEAR(row("Mohr-Coulomb", "axial_stress_Pa", 40), strength, 1e-4 * strength); // Sample/Newton tolerance
  const auto test = nlohmann::json::parse(contents(folder.path() / "out/summary.json")).at("tests").at(0);
  EXPECT_NEAR(test.at("peak_stress_Pa").get<double>(), strength, 1e-4 * strength); // though it never falls
  // The work of the platens: ½ σ ε of the volume (50 mm x 100 mm x 1 m) where all of it is elastic, stored in full; beyond
  // the yield strain σ of it, with an error of the trapezoid over the one step with the kink.
  const double volume = 0.05 * 0.1;
  const auto press = [&](const std::string& material, const std::size_t k) {
    return row(material, "platen_work_J", k) / volume;
  };
  EXPECT_NEAR(press("linear elasticity", 40), 0.5 * 60e9 * 0.004 * 0.004, 1e-6 * 0.5 * 60e9 * 0.004 * 0.004);
  const auto elastic = nlohmann::json::parse(contents(folder.path() / "out/summary.json")).at("tests").at(0);
  EXPECT_LT(elastic.at("energy_imbalance_over_work").get<double>(), 1e-6); // the strain of the tolerance
  const double yield_strain = strength / 60e9;
  const double expected = strength * (0.004 - 0.5 * yield_strain);
  EXPECT_NEAR(press("Mohr-Coulomb", 40), expected, 2e-3 * expected);
  EXPECT_LT(test.at("energy_imbalance_over_work").get<double>(), 2e-3);

  const auto refused = run_feldspar(folder.path(), "multiscale out --extract 0:0");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.error.find("the points of this sample have no grains"), std::string::npos) << refused.error;
}

// Without grains, so that the closed form is at hand: a cylinder under pressure, as half of its section and as a whole,
// responds with Young's modulus and Poisson's ratio; plane strain with E/(1 - ν²) and ν/(1 - ν).
TEST(Multiscale, TakesCylindersAndPlaneStrain)
{
  TemporaryFolder folder;
  const auto last_row = [&](const std::string& sample, const std::string& column) {
    folder.write("press.prm", "subsection Sample\n  set Width = 50 mm\n  set Height = 100 mm\n"
                              "  set Material = linear elasticity\n  set Compression step = 1e-4\n" +
                                sample +
                                "end\nsubsection Continuum\n  set Modulus = 60 GPa\n  set Poisson ratio = 0.2\nend\n"
                                "subsection Tests\n  set List = triaxial_compression\n  set Confinements = 10 MPa\n"
                                "  set Stop strain = 0.001\nend\n");
    const auto run = run_without_pictures(folder.path(), "multiscale press.prm --output out --force --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return cell(folder.path() / "out/curves/triaxial_compression_10_MPa_seed_1.csv", column, 10);
  };
  constexpr double E = 60e9;
  constexpr double nu = 0.2;
  for (const std::string sample :
       {"  set Geometry = axisymmetric\n  set Elements across = 2\n  set Elements along = 4\n",
        "  set Geometry = cylinder\n  set Elements across = 4\n  set Elements along = 4\n  set Order = 2\n"
        "  set Quadrature = reduced\n"})
    {
      EXPECT_NEAR(last_row(sample, "axial_stress_Pa"), 10e6 + E * 1e-3, 1e-6 * E * 1e-3) << sample;
      EXPECT_NEAR(last_row(sample, "gauge_lateral_strain"), -nu * 1e-3, 1e-6 * 1e-3) << sample;
      EXPECT_NEAR(last_row(sample, "gauge_volumetric_strain"), (1.0 - 2.0 * nu) * 1e-3, 1e-6 * 1e-3) << sample;
    }
  const std::string strip = "  set Geometry = plane strain\n";
  EXPECT_NEAR(last_row(strip, "axial_stress_Pa"), 10e6 + E / (1.0 - nu * nu) * 1e-3, 1e-6 * E * 1e-3);
  EXPECT_NEAR(last_row(strip, "gauge_lateral_strain"), -nu / (1.0 - nu) * 1e-3, 1e-6 * 1e-3);
}

/// Small RVEs of spheres.
std::string input_in_space(const std::string& sample, const std::string& tests)
{
  std::string text = input(sample, tests, "  set Dimension = 3\n");
  for (const std::string entry : {"  set Width = 14 mm\n", "  set Height = 14 mm\n"})
    text.replace(text.find(entry), entry.size(), entry.substr(0, entry.find("14")) + "6 mm\n");
  return text;
}

// A cylinder of one realisation in the axes r, θ, z of each point is the same as a whole, by half of its section, and
// by its RVE alone, whose sides are free: also where segments break, up to nine tenths of the strength. The remaining
// difference: a ring and a radius have one strain on the axis, and an RVE of seventy spheres has not.
TEST(Multiscale, ACylinderIsTheSameAsAWholeByItsSectionAndByItsRve)
{
  TemporaryFolder folder;
  const std::string cell_of_spheres =
    "subsection Specimen\n  set Dimension = 3\n  set Shape = periodic\n  set Width = 7 mm\n  set Height = 7 mm\nend\n";
  folder.write("rve.prm", cell_of_spheres +
                            "subsection Strain path\n  set Direction = free, free, 1, free, free, free\n"
                            "  set Size = 2.4e-4\n  set Largest step = 1e-5\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "rve rve.prm --output rve --quiet").exit_code, 0);
  const auto strain = column(folder.path() / "rve/curves/rve.csv", "strain_zz");
  const auto stress = column(folder.path() / "rve/curves/rve.csv", "stress_zz_Pa");
  const auto of_rve = [&](const double wanted) {
    for (std::size_t k = 1; k < strain.size(); ++k)
      if (strain[k] >= wanted)
        return stress[k - 1] + (stress[k] - stress[k - 1]) * (wanted - strain[k - 1]) / (strain[k] - strain[k - 1]);
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (const auto& [name, sample] : {std::pair("section", "  set Geometry = axisymmetric\n  set Elements across = 2\n"),
                                     {"whole", "  set Geometry = cylinder\n  set Elements across = 4\n"}})
    {
      folder.write(std::string(name) + ".prm",
                   cell_of_spheres + "subsection Sample\n  set Width = 12 mm\n  set Height = 24 mm\n" + sample +
                     "  set Elements along = 4\n  set Orientation = fixed\n  set Realisations = 1\n"
                     "  set Tension step = 1e-5\nend\nsubsection Tests\n  set List = direct_tension\n"
                     "  set Stop strain = 2e-4\nend\n");
      const auto run =
        run_feldspar(folder.path(), fmt::format("multiscale {0}.prm --output {0} --quiet", std::string(name)));
      ASSERT_EQ(run.exit_code, 0) << run.error;
      const auto curve = folder.path() / name / "curves/direct_tension_seed_1.csv";
      const auto its_strain = column(curve, "axial_strain");
      const auto its_stress = column(curve, "axial_stress_Pa");
      for (std::size_t k = 1; k < its_strain.size(); ++k)
        EXPECT_NEAR(its_stress[k], of_rve(its_strain[k]), 0.01 * of_rve(its_strain[k])) << name << " " << k;
      EXPECT_GT(its_stress.back(), 0.9 * *std::max_element(stress.begin(), stress.end())) << name;
      EXPECT_GT(column(curve, "n_tension_cracks").back(), 50.0) << name;
    }

  const auto extract = run_feldspar(folder.path(), "multiscale whole --extract 5:6");
  ASSERT_EQ(extract.exit_code, 0) << extract.error;
  EXPECT_NE(extract.output.find(" deg about (0.000, 0.000, "), std::string::npos) << extract.output;
}

// A sample between smooth platens is in one state as long as it does not soften: that of its RVE along the same path, within the tolerance of Newton's
// method.
TEST(Multiscale, TakesParallelBondsAndBondsThatSoften)
{
  TemporaryFolder folder;
  for (const auto& [law, test, sign, size, step] :
       {std::tuple("parallel bond", "direct_tension", "1", "7.2e-4", "4e-5"),
        {"parallel bond", "uniaxial_compression", "-1", "1.1e-3", "1e-4"},
        {"softening flat joint", "direct_tension", "1", "1.5e-4", "1e-5"},
        {"softening flat joint", "uniaxial_compression", "-1", "1e-3", "5e-5"}})
    {
      SCOPED_TRACE(fmt::format("{}, {}", law, test));
      const std::string cell = fmt::format("subsection Specimen\n  set Shape = periodic\n  set Width = 14 mm\n"
                                           "  set Height = 14 mm\n  set Joint law = {}\nend\n",
                                           law);
      folder.write("path.prm",
                   fmt::format("{}subsection Strain path\n  set Direction = free, {}, free\n  set Size = {}\n"
                               "  set Largest step = {}\nend\n",
                               cell, sign, size, step));
      folder.write("sample.prm",
                   fmt::format("{}subsection Sample\n  set Width = 24 mm\n  set Height = 48 mm\n"
                               "  set Elements across = 2\n  set Elements along = 4\n  set Orientation = fixed\n"
                               "  set Realisations = 1\n  set Tension step = {}\n  set Compression step = {}\nend\n"
                               "subsection Tests\n  set List = {}\n  set Stop strain = {}\nend\n",
                               cell, step, step, test, size));
      for (const std::string command : {"rve path.prm --output path", "multiscale sample.prm --output sample"})
        {
          const auto run = run_without_pictures(folder.path(), command + " --quiet --force");
          ASSERT_EQ(run.exit_code, 0) << run.error;
        }
      const auto curve = folder.path() / fmt::format("sample/curves/{}_seed_1.csv", test);
      const double modulus = column(folder.path() / "path/curves/rve.csv", "stress_yy_Pa").back() /
                             column(folder.path() / "path/curves/rve.csv", "strain_yy").back();
      const double of_sample = column(curve, "axial_stress_Pa").back() / column(curve, "axial_strain").back();
      EXPECT_NEAR(of_sample, modulus, 1e-3 * modulus) << test;
      EXPECT_GT(column(curve, "axial_stress_Pa").size(), 10u) << test;
    }
}

TEST(Multiscale, HoldsTheConfinementBetweenRoughPlatens)
{
  TemporaryFolder folder;
  folder.write("press.prm", input("  set Platens = rough\n  set Orientation = fixed\n  set Order = 2\n",
                                  "  set List = triaxial_compression\n  set Confinements = 20 MPa\n"
                                  "  set Stop strain = 1e-4\n"));
  const auto run = run_without_pictures(folder.path(), "multiscale press.prm --output out --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  std::ifstream curve(folder.path() / "out/curves/triaxial_compression_20_MPa_seed_1.csv");
  std::string header, first;
  std::getline(curve, header);
  std::getline(curve, first);
  // Seated in one step: the strain counts from here, and the mean stress over all points balances the pressure.
  EXPECT_EQ(first.find("1,0,"), 0u) << first;
  std::istringstream names(header), values(first);
  std::string value;
  for (std::string name; name != "mid_stress_Pa";)
    ASSERT_TRUE(std::getline(names, name, ',') && std::getline(values, value, ',')) << header;
  EXPECT_NEAR(std::stod(value), 20e6, 1e-4 * 20e6); // Newton tolerance 1e-5
}

// One RVE at all points of three rows of two: but for the seed nothing tells them apart, and they break at a strain of
// 1.9e-4. With a fifth of the strength the seed breaks at a fifth of it, and what it leaves to its neighbours is at most
// twice that. The row at mid-height is that of the cells 2 and 3, its element to the right the latter.
TEST(Multiscale, BreaksFirstWhereItsWeakSeedIs)
{
  TemporaryFolder folder;
  const auto breaks_in = [&](const std::string& seed) {
    std::string text = input("  set Orientation = fixed\n  set Tension step = 5e-6\n  set Weak seed = " + seed +
                               "\n  set Weak seed strength = 0.2\n",
                             "  set List = direct_tension\n  set Stop strain = 5e-5\n");
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"Realisations = 2", "Realisations = 1"},
                                   {"Elements across = 1", "Elements across = 2"},
                                   {"Elements along = 2", "Elements along = 3"}})
      text.replace(text.find(from), from.size(), to);
    folder.write("weak.prm", text);
    const auto run = run_without_pictures(folder.path(), "multiscale weak.prm --output " + seed + " --force --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return cells_that_broke(folder.path() / seed);
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
    const auto outcome = run_feldspar(folder.path(), "multiscale bad.prm --output out");
    EXPECT_EQ(outcome.exit_code, 2) << outcome.error;
    EXPECT_NE(outcome.error.find(part), std::string::npos) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out")) << outcome.error;
  };
  expect(input("", "  set List = brazilian\n"), "bad.prm: Tests/List: brazilian: the sample stands between platens");
  expect("subsection Specimen\n  set Shape = box\nend\n", "bad.prm: Specimen/Shape = box: the RVE at a point needs");
  expect(input("  set Control past the peak = lateral strain\n", "  set List = uniaxial_compression\n"),
         "bad.prm: Sample/Control past the peak = lateral strain: the axial strain may go back");
  expect(input("", "  set Lateral boundary = membrane\n"),
         "bad.prm: Tests/Lateral boundary = membrane: is of tests on specimens of grains");
  expect(input("", "  set Intermediate stress = 30 MPa\n"),
         "bad.prm: Tests/Intermediate stress = 30 MPa: presses on two sides of a box");
  std::string many = input("", "");
  many.replace(many.find("Elements along = 2"), 18, "Elements along = 10000");
  many.replace(many.find("Elements across = 1"), 19, "Elements across = 1000");
  expect(many, "bad.prm: Sample/Elements across = 1000, Elements along = 10000: some 1e+07 cells");
  expect(input("", "", "  set Dimension = 3\n"), "bad.prm: Specimen/Dimension = 3: ");
  expect(input("  set Geometry = cylinder\n", ""), "bad.prm: Specimen/Dimension = 2: the RVEs of such a");
  expect(input_in_space("  set Geometry = cylinder\n", ""),
         "bad.prm: Sample/Elements across = 1: a cylinder of 1 cells across: there must be at least 3");
  expect(input("  set Quadrature = reduced\n", ""), "bad.prm: Sample/Quadrature = reduced: needs Order = 2");
  expect(input("  set Order = 3\n", ""), "Sample/Order = 3: must be an integer in [1, 2]");
  expect(input("  set Material = linear elasticity\n", ""),
         "bad.prm: Tests/Stop strain = none: linear elasticity does not soften");
  expect(input("  set Material = Mohr-Coulomb\n  set Weak seed = row\n", "  set Stop strain = 1e-5\n"),
         "bad.prm: Sample/Weak seed: weakens the bonds between grains; it needs Material = grains");
  expect(input("  set Weak seed = row\n  set Weak seed strength = 1.1\n", ""),
         "Sample/Weak seed strength = 1.1: must lie in (0, 1]");
  expect(input("", "  set Stop strain = 1e-5\nend\nsubsection Continuum\n  set Dilation angle = 60 deg\n"),
         "bad.prm: Continuum/Dilation angle: must be at most Continuum/Friction angle");
}

TEST(Multiscale, TakesAFlawedRve)
{
  // One element between smooth platens is strained alike throughout: it carries what its RVE does alone, pulled with
  // its sides free.
  const TemporaryFolder folder;
  const std::string flaw = "subsection Flaws\n  set Shapes = closed flaw from 4, 7 mm to 10, 7 mm\nend\n";
  std::string sample = input("  set Platens = smooth\n  set Order = 1\n  set Orientation = fixed\n"
                             "  set Tension step = 5e-6\n",
                             "  set List = direct_tension\n  set Stop strain = 5e-5\n") +
                       flaw;
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"along = 2", "along = 1"}, {"Realisations = 2", "Realisations = 1"}})
    sample.replace(sample.find(from), from.size(), to);
  folder.write("sample.prm", sample);
  folder.write("rve.prm",
               "subsection Specimen\n  set Shape = periodic\n  set Width = 14 mm\n  set Height = 14 mm\nend\n"
               "subsection Strain path\n  set Direction = free, 1, free\n  set Size = 5e-5\n"
               "  set Largest step = 5e-6\nend\n" +
                 flaw);
  const auto run = run_without_pictures(folder.path(), "multiscale sample.prm --output sample --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(run.error.find("Flaws"), std::string::npos) << run.error;
  ASSERT_EQ(run_feldspar(folder.path(), "rve rve.prm --output rve --quiet").exit_code, 0);
  const double of_rve = column(folder.path() / "rve/curves/rve.csv", "stress_yy_Pa").back();
  EXPECT_NEAR(column(folder.path() / "sample/curves/direct_tension_seed_1.csv", "axial_stress_Pa").back(), of_rve,
              1e-5 * of_rve); // the tolerance of Newton's method

  // Turned at random, the flaws turn too, and it is said.
  sample.replace(sample.find("Orientation = fixed"), 19, "Orientation = random");
  sample.replace(sample.find("Stop strain = 5e-5"), 18, "Stop strain = 5e-6");
  folder.write("turned.prm", sample);
  const auto turned = run_without_pictures(folder.path(), "multiscale turned.prm --output turned --quiet");
  ASSERT_EQ(turned.exit_code, 0) << turned.error;
  EXPECT_NE(turned.error.find("they keep their directions by Sample/Orientation = fixed"), std::string::npos)
    << turned.error;
}

TEST(Multiscale, WarnsOfElementsLargerThanTheRve)
{
  TemporaryFolder folder;
  std::string text = input("", "  set List = uniaxial_compression\n  set Stop strain = 4e-5\n");
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"Width = 12 mm", "Width = 40 mm"}, {"Height = 24 mm", "Height = 80 mm"}})
    text.replace(text.find(from), from.size(), to);
  folder.write("large.prm", text);
  const auto outcome = run_without_pictures(folder.path(), "multiscale large.prm --output out --quiet");
  EXPECT_NE(outcome.error.find("elements of 40.0 mm are larger than the RVE of 14.0 mm"), std::string::npos)
    << outcome.error;
  EXPECT_NE(outcome.error.find("Elements across = 3, Elements along = 6"), std::string::npos) << outcome.error;
}
} // namespace
} // namespace feldspar
