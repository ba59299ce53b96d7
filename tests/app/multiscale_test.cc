#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

/// `feldspar multiscale` as a user runs it, on a sample of two elements with small volumes.
namespace feldspar
{
namespace
{
using tests::run_feldspar;
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

TEST(Multiscale, PullsASampleApartToTheSameBitsForAnyNumberOfThreads)
{
  TemporaryFolder folder;
  folder.write("pull.prm", input("  set Order = 1\n  set Platens = smooth\n  set Orientation = random\n"
                                 "  set Tension step = 5e-6\n  set Compression step = 4e-5\n"
                                 "  set Most broken share = 0.01\n  set Smallest step share = 0.0625\n"
                                 "  set Newton tolerance = 1e-5\n",
                                 "  set List = direct_tension\n"));
  const auto run = run_feldspar(folder.path(), "multiscale pull.prm --output one --quiet --threads 1");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const auto summary = nlohmann::json::parse(contents(folder.path() / "one/summary.json"));
  const auto& test = summary.at("tests").at(0);
  EXPECT_EQ(test.at("kind"), "direct_tension");
  // Small volumes of few grains: weaker or stronger than the large one's 9 MPa, but a rock of Table 1's bonds
  // (22 MPa), of which stress concentrations leave a third to a half.
  EXPECT_GT(test.at("peak_stress_Pa").get<double>(), 5e6);
  EXPECT_LT(test.at("peak_stress_Pa").get<double>(), 15e6);
  EXPECT_GT(test.at("n_tension_cracks").get<int>(), 10);
  EXPECT_LT(test.at("energy_imbalance").get<double>(), 0.01);
  for (const char* const file : {"one/fields/direct_tension_seed_1.xdmf", "one/cracks.csv", "one/report.html",
                                 "one/curves/direct_tension_seed_1.csv", "one/volumes/specimen_seed_2.h5"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;

  ASSERT_EQ(run_feldspar(folder.path(), "multiscale pull.prm --output two --quiet --threads 2").exit_code, 0);
  for (const char* const file : {"cracks.csv", "curves/direct_tension_seed_1.csv"})
    EXPECT_EQ(contents(folder.path() / "one" / file), contents(folder.path() / "two" / file)) << file;
}

TEST(Multiscale, HoldsTheConfinementBetweenRoughPlatens)
{
  TemporaryFolder folder;
  folder.write("press.prm", input("  set Platens = rough\n  set Orientation = fixed\n  set Order = 2\n",
                                  "  set List = triaxial_compression\n  set Confinements = 20 MPa\n"
                                  "  set Stop strain = 1e-4\n"));
  const auto run = run_feldspar(folder.path(), "multiscale press.prm --output out --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.error;
  std::ifstream curve(folder.path() / "out/curves/triaxial_compression_20_MPa_seed_1.csv");
  std::string header, first;
  std::getline(curve, header);
  std::getline(curve, first);
  // Seated in one step: the axial stress is the confinement, the strain counts from here.
  EXPECT_EQ(first.find("1,0,-0,20000000,"), 0u) << first;
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
  expect(input("", "  set List = brazilian\n"), "bad.prm: Tests/List: brazilian: the sample is a rectangle");
  expect("subsection Specimen\n  set Shape = box\nend\n", "bad.prm: Specimen/Shape = box: the volume at a point needs");
  expect(input("", "", "  set Dimension = 3\n"), "bad.prm: Specimen/Dimension = 3: ");
  expect(input("  set Order = 3\n", ""), "Sample/Order = 3: must be an integer in [1, 2]");
}

TEST(Multiscale, WarnsOfElementsLargerThanTheVolume)
{
  TemporaryFolder folder;
  std::string text = input("", "  set List = uniaxial_compression\n  set Stop strain = 4e-5\n");
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"Width = 12 mm", "Width = 40 mm"}, {"Height = 24 mm", "Height = 80 mm"}})
    text.replace(text.find(from), from.size(), to);
  folder.write("large.prm", text);
  const auto outcome = run_feldspar(folder.path(), "multiscale large.prm --output out --quiet");
  EXPECT_NE(outcome.error.find("elements of 40.0 mm are larger than the volume of 14.0 mm"), std::string::npos)
    << outcome.error;
  EXPECT_NE(outcome.error.find("Elements across = 3, Elements along = 6"), std::string::npos) << outcome.error;
}
} // namespace
} // namespace feldspar
