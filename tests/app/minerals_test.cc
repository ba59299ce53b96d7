// Rocks of minerals, as the command tests them.

#include "base/table/csv.h"
#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

void write_rock(const TemporaryFolder& folder)
{
  folder.write("minerals.csv",
               "mineral,share [%],size [mm],colour,stiffness_ratio,tensile_strength_ratio,cohesion_ratio\n"
               "quartz,60,5,#b8c4d0,1.5,1,1\n"
               "mica,40,4,#505050,0.5,0.3,0.3\n");
  folder.write("rock.prm", section("Specimen", "Width = 14 mm", "Height = 28 mm") +
                             section("Minerals", "Table = minerals.csv", "Boundary strength = 0.5") +
                             section("Tests", "List = uniaxial_compression"));
}

/// The mean stress that all minerals together have at each step, and the sums of their shares.
TEST(Minerals, OfATestAreInItsFiles)
{
  const TemporaryFolder folder;
  write_rock(folder);
  run_to_end(folder, "lab rock.prm --output one --threads 1 --quiet");
  run_to_end(folder, "lab rock.prm --output two --threads 2 --quiet");
  expect_same_files(folder / "one", folder / "two",
                    {"minerals.csv", "cracks.csv", "grains/uniaxial_compression_seed_1.csv"});

  CsvReader table(folder / "one/minerals.csv");
  std::map<std::string, double> shares, last_within;
  while (table.next())
    {
      const std::string mineral(table.text(table.place("mineral")));
      shares[mineral] = table.number(table.place("share"));
      last_within[mineral] = table.number(table.place("n_cracks_within"));
    }
  EXPECT_NEAR(shares["quartz"], 0.6, 0.01);
  EXPECT_NEAR(shares["quartz"] + shares["mica"], 1.0, 1e-8);

  // Every crack is in a mineral or at a boundary; grains stand on both sides.
  auto cracks = read_columns(folder / "one/cracks.csv");
  double n_in_mica = 0.0;
  std::size_t n_on_boundaries = 0;
  for (std::size_t k = 0; k < cracks["mineral_1"].size(); ++k)
    {
      const double one = cracks["mineral_1"][k], two = cracks["mineral_2"][k];
      const bool on_boundary = cracks["on_boundary"][k] == 1.0;
      EXPECT_TRUE(1 <= one && one <= two && two <= 2 && (on_boundary || one == two));
      n_on_boundaries += on_boundary;
      n_in_mica += !on_boundary && one == 2.0;
    }
  EXPECT_EQ(n_in_mica, last_within["mica"]); // the last snapshot is the end
  EXPECT_GT(n_on_boundaries, 0u);

  const auto summary = summary_of(folder / "one");
  EXPECT_EQ(summary["tests"][0]["minerals"][1]["name"], "mica");
  EXPECT_EQ(summary["tests"][0]["minerals"][1]["colour"], "#505050");
  EXPECT_GT(summary["tests"][0]["boundary_crack_share_at_peak"], 0.2);

  // A page made anew from the files knows the minerals too.
  run_to_end(folder, "report one --output again");
  const std::string page = content(folder / "again/report.html");
  EXPECT_TRUE(has_words(page, "Cracks by mineral", "quartz | mica", "in mica"));
}

// One of two variants has no minerals, and so nothing that is rigid.
TEST(Minerals, MayBeOfOneVariantAlone)
{
  const TemporaryFolder folder;
  write_rock(folder);
  run_to_end(
    folder, "lab rock.prm --output out --quiet --set 'Minerals/Grains = rigid' --set 'Variants/Entry = Minerals/Table' "
            "--set 'Variants/Values = minerals.csv; none' --set 'Tests/Stop strain = 1e-5'");
  const auto tests = summary_of(folder / "out")["tests"];
  EXPECT_GT(tests[0]["n_clumps"], 0);
  EXPECT_EQ(tests[1]["n_clumps"], 0);
}

// The friction of the minerals is a part of what a checkpoint keeps.
TEST(Minerals, OfATestThatWasKilledGoOnToTheSameBits)
{
  const TemporaryFolder folder;
  write_rock(folder);
  folder.write("minerals.csv", "mineral,share [%],size [mm],tensile_strength_ratio,cohesion_ratio,friction_ratio\n"
                               "quartz,60,5,0.5,0.5,1.5\n"
                               "mica,40,4,0.3,0.3,0.2\n");
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  run_until(folder, "lab rock.prm --output out --quiet --set 'Tests/Steps between checkpoints = 500'",
            "[ -e out/checkpoints/uniaxial_compression_seed_1.h5 ]", "sleep 0.5\nkill -KILL $!");
  const auto outcome = run_to_end(folder, "lab --resume out");
  EXPECT_EQ(outcome.error.find("kept as"), std::string::npos) << outcome.error;
  expect_same_files(folder / "out", folder / "whole",
                    {"cracks.csv", "minerals.csv", "curves/uniaxial_compression_seed_1.csv"});
}

/// A periodic rock of quartz and mica in which joints that lie where `weak` says have a fortieth of the strength of all
/// others.
void write_volume(const TemporaryFolder& folder, const std::string& weak)
{
  const bool in_mica = weak == "in mica";
  folder.write("minerals.csv", "mineral,share [%],size [mm],tensile_strength_ratio,cohesion_ratio\n"
                               "quartz,60,5,20,20\nmica,40,4," +
                                 std::string(in_mica ? "0.5,0.5\n" : "20,20\n"));
  folder.write("boundaries.csv", "mineral_1,mineral_2,tensile_strength_ratio,cohesion_ratio\n"
                                 "quartz,quartz,20,20\nmica,mica,20,20\nmica,quartz," +
                                   std::string(in_mica ? "20,20\n" : "0.5,0.5\n"));
  folder.write("volume.prm", section("Specimen", "Shape = periodic", "Width = 14 mm", "Height = 14 mm") +
                               section("Minerals", "Table = minerals.csv", "Boundaries = boundaries.csv") +
                               section("Strain path", "Direction = free, 1, free", "Size = 2e-4") +
                               section("Sample", "Width = 12 mm", "Height = 24 mm", "Elements across = 1",
                                       "Elements along = 2", "Realisations = 2") +
                               section("Tests", "List = direct_tension", "Stop strain = 2e-4"));
}

/// Mineral on the one side, on the other, and whether a boundary is between them.
using Sides = std::array<double, 3>;

std::set<Sides> sides_of_cracks(const fs::path& file)
{
  auto cracks = read_columns(file);
  std::set<Sides> sides;
  for (std::size_t k = 0; k < cracks["mineral_1"].size(); ++k)
    sides.insert({cracks["mineral_1"][k], cracks["mineral_2"][k], cracks["on_boundary"][k]});
  return sides;
}

// All cracks are of the one kind of joint that can break.
TEST(Minerals, OfCracksInVolumesAndSamplesAreThoseThatAreWeak)
{
  const TemporaryFolder folder;
  for (const auto& [weak, sides] : {std::pair("in mica", Sides{2, 2, 0}), std::pair("between", Sides{1, 2, 1})})
    {
      write_volume(folder, weak);
      for (const std::string solver : {"event by event", "explicit"})
        {
          run_to_end(folder, "rve volume.prm --output rve --force --quiet --set 'Strain "
                             "path/Solver = " +
                               solver + "'");
          EXPECT_EQ(sides_of_cracks(folder / "rve/cracks.csv"), std::set{sides}) << weak << ", " << solver;
        }
      const auto rve = summary_of(folder / "rve")["rves"][0];
      EXPECT_EQ(rve["minerals"][1]["name"], "mica");

      run_to_end(folder, "multiscale volume.prm --output out --force --quiet");
      EXPECT_EQ(sides_of_cracks(folder / "out/cracks.csv"), std::set{sides}) << weak;
      const auto test = summary_of(folder / "out")["tests"][0];
      EXPECT_EQ(test["minerals"][1]["name"], "mica");
      EXPECT_NEAR(test["minerals"][0]["share"].get<double>() + test["minerals"][1]["share"].get<double>(), 1.0, 1e-12);
    }
}

/// K and G of a periodic volume lie between Hashin and Shtrikman's bounds in space and between Reuss's and Voigt's in the plane,
/// where a volume of so few mineral grains is not isotropic enough for the narrow ones.
void expect_within_bounds(const std::string& settings, const std::string& lower, const std::string& upper)
{
  const TemporaryFolder folder;
  write_rock(folder);
  run_to_end(folder, "rve rock.prm --output rve --quiet --set 'Specimen/Shape = periodic' --set "
                     "'Strain path/Size = 1e-6' " +
                       settings);
  const auto rve = summary_of(folder / "rve")["rves"][0];
  for (const char* const modulus : {"bulk_modulus_Pa", "shear_modulus_Pa"})
    {
      const auto bound = [&](const std::string& name) { return rve["mixture_bounds"][name][modulus].get<double>(); };
      EXPECT_LT(bound("reuss"), bound("hashin_shtrikman_lower"));
      EXPECT_LT(bound(lower), rve[modulus].get<double>()) << modulus;
      EXPECT_LT(rve[modulus].get<double>(), bound(upper)) << modulus;
      EXPECT_LT(bound("hashin_shtrikman_upper"), bound("voigt"));
    }
}

TEST(Minerals, OfAVolumeStandBetweenTheirBounds)
{
  expect_within_bounds("--set 'Specimen/Height = 14 mm' --set 'Strain path/Direction = 0, 1, 0'", "reuss", "voigt");
  expect_within_bounds(
    "--set 'Specimen/Dimension = 3' --set 'Specimen/Width = 10 mm' --set 'Specimen/Height = 10 mm' --set "
    "'Specimen/Minimum radius = 0.4 mm' --set 'Strain path/Direction = 0, 0, 1, 0, 0, 0'",
    "hashin_shtrikman_lower", "hashin_shtrikman_upper");
}
} // namespace
} // namespace feldspar::tests
