#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <feldspar/feldspar.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

/// The volume as a user material of CalculiX and Abaqus, called in their order; docs/material.md.
namespace
{
using feldspar::tests::run_command;
using feldspar::tests::TemporaryFolder;

constexpr const char* rock =
  "subsection Specimen\n  set Shape = periodic\n  set Width = 10 mm\n  set Height = 10 mm\nend\n"
  "subsection Representative volume\n  set Final tolerance = 1e-9\nend\n"
  "subsection Sample\n  set Realisations = 1\n  set Orientation = fixed\nend\n";

std::string called(const TemporaryFolder& folder, const std::string& words)
{
  const auto outcome = run_command(folder, "'" FELDSPAR_UMAT_CALLER "' -i job " + words);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.error;
  return outcome.output;
}

/// Stresses of a row; of increment k of a point.
std::vector<double> stress_of(const std::string& rows, const int k, const int point)
{
  std::istringstream lines(rows);
  for (std::string line; std::getline(lines, line);)
    {
      std::istringstream words(line);
      int increment = 0, its_point = 0;
      words >> increment >> its_point;
      if (increment != k || its_point != point)
        continue;
      std::vector<double> stress;
      for (std::string word; stress.size() < 6 && words >> word;)
        stress.push_back(std::strtod(word.c_str(), nullptr));
      return stress;
    }
  ADD_FAILURE() << "no row of increment " << k << ", point " << point;
  return std::vector<double>(6, 0.0);
}

/// The last increments of a run.
std::string rows_from(const std::string& rows, const int first)
{
  std::istringstream lines(rows);
  std::string later;
  for (std::string line; std::getline(lines, line);)
    if (std::stoi(line) >= first)
      later += line + "\n";
  return later;
}

constexpr std::array<std::array<double, 3>, 4> ends{
  {{-3e-5, 3e-4, 0.0}, {1e-4, -1.2e-3, 0.0}, {0.0, 0.0, 8e-4}, {3e-4, -3e-5, 1e-4}}};

class Umat : public testing::Test
{
protected:
  void SetUp() override { folder.write("beishan.prm", rock); }
  TemporaryFolder folder;
};

// The volume follows the library along the same strains: with breaks at each iteration, it breaks at
// the strain of the increment.
TEST_F(Umat, TakesTheWayOfTheLibrary)
{
  constexpr int n = 40;
  const std::string rows = called(folder, "BEISHAN 1 1 40 40 1");
  const feldspar::Input input((folder / "beishan.prm").string());
  const feldspar::Rve intact(feldspar::Specimen(input, 1), input);
  for (int point = 1; point <= 4; ++point)
    {
      feldspar::Rve rve = intact;
      std::size_t n_breaks = 0;
      for (int k = 1; k <= n; ++k)
        {
          std::array<double, 3> strain = ends[std::size_t(point - 1)];
          for (double& component : strain)
            component *= double(k) / n;
          const feldspar::Trial trial = rve.relax(strain);
          n_breaks += trial.n_breaks();
          rve.accept(trial);
          const auto expected = trial.stress();
          const auto stress = stress_of(rows, k, point);
          const double scale = std::abs(*std::max_element(
            expected.begin(), expected.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
          const double tolerance = (rve.is_intact() ? 1e-12 : 1e-6) * scale;
          EXPECT_NEAR(stress[0], expected[0], tolerance) << point << ", " << k;
          EXPECT_NEAR(stress[1], expected[1], tolerance) << point << ", " << k;
          EXPECT_NEAR(stress[3], expected[2], tolerance) << point << ", " << k;
          EXPECT_EQ(stress[2], 0.0);
        }
      EXPECT_GT(n_breaks, 0u) << point; // the path tells something of broken volumes, too
    }
}

// Lagged, a volume breaks an increment later: the difference to each iteration falls with the increment.
TEST_F(Umat, LaggedNearsEachIterationWithTheIncrement)
{
  std::vector<double> differences;
  for (const int n : {20, 80, 320})
    {
      const std::string last = std::to_string(n) + " " + std::to_string(n);
      const std::string lagged = called(folder, "BEISHAN 0 1 " + last + " 2");
      const std::string at_once = called(folder, "BEISHAN 1 1 " + last + " 2");
      double sum = 0.0;
      for (int k = n / 20; k <= n; k += n / 20)
        sum += std::abs(stress_of(lagged, k, 1)[1] - stress_of(at_once, k, 1)[1]) / 20.0;
      differences.push_back(sum);
    }
  EXPECT_LT(differences[1], 0.5 * differences[0]);
  EXPECT_LT(differences[2], 0.5 * differences[1]);
}

TEST_F(Umat, GivesTheSameBitsForThreadsCutsAndRestarts)
{
  for (const std::string mode : {"0", "1"})
    {
      const std::string rows = called(folder, "BEISHAN " + mode + " 1 40 40 1");
      EXPECT_EQ(called(folder, "BEISHAN " + mode + " 1 40 40 4"), rows);
      EXPECT_EQ(called(folder, "BEISHAN " + mode + " 1 40 40 2 cut"), rows);
      // From half way, by the file of a job that went on, with cuts, and of one that ended there.
      EXPECT_EQ(called(folder, "BEISHAN " + mode + " 21 40 40 2"), rows_from(rows, 21));
      called(folder, "BEISHAN " + mode + " 1 20 40 2");
      called(folder, "BEISHAN " + mode + " 1 5 40 1"); // begun anew beside it: the file keeps what a restart needs
      EXPECT_EQ(called(folder, "BEISHAN " + mode + " 21 40 40 1"), rows_from(rows, 21));
    }
}

// A table by number would take sixteen gigabytes.
TEST_F(Umat, TakesElementsOfAnyNumberInLittleMemory)
{
  const std::string rows = called(folder, "BEISHAN 1 1 5 40 1");
  const auto outcome =
    run_command(folder, "ulimit -v 4000000 && '" FELDSPAR_UMAT_CALLER "' -i far BEISHAN 1 1 5 40 1 far");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.error;
  EXPECT_EQ(outcome.output, rows);
}

TEST_F(Umat, EndsTheJobWithOneSentence)
{
  const auto refused = [&](const std::string& words, const std::string& sentence) {
    const auto outcome = run_command(folder, "'" FELDSPAR_UMAT_CALLER "' -i job " + words);
    EXPECT_EQ(outcome.exit_code, 201);
    EXPECT_NE(outcome.output.find(" *ERROR in FELDSPAR: " + sentence), std::string::npos) << outcome.output;
  };
  refused("ELSE 0 1 2 40 1", "material ELSE: there is no input else.prm or .json in the folder of the job");
  refused("BEISHAN 0 1 2 40 1 nlgeom", "material BEISHAN: its strains are small; leave out NLGEOM");
  const std::string log = "job.beishan.feldspar";
  refused("BEISHAN 0 21 40 40 1", log + ": is missing; a restarted job needs the file .feldspar");
  called(folder, "BEISHAN 1 1 20 40 1");
  refused("BEISHAN 0 21 40 40 1", log + ": is of another input, mode or version");
  called(folder, "BEISHAN 0 1 20 80 1");
  refused("BEISHAN 0 22 40 37 1", log + ": has no strain from which element");
  folder.write("wrong.prm",
               "subsection Specimen\n  set Shape = box\nend\nsubsection Sample\n  set Orientation = fixed\nend\n");
  refused("WRONG 0 1 2 40 1", "the specimen stands between walls");
}
} // namespace
