// Rocks of minerals, as the command tests them.

#include "base/table/csv.h"
#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
  folder.write("rock.prm", R"(subsection Specimen
  set Width  = 14 mm
  set Height = 28 mm
end
subsection Minerals
  set Table             = minerals.csv
  set Boundary strength = 0.5
end
subsection Tests
  set List = uniaxial_compression
end
)");
}

/// The mean stress that all minerals together have at each step, and the sums of their shares.
TEST(Minerals, OfATestAreInItsFiles)
{
  const TemporaryFolder folder;
  write_rock(folder);
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output one --threads 1 --quiet").exit_code, 0);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output two --threads 2 --quiet").exit_code, 0);
  for (const char* const file : {"minerals.csv", "cracks.csv", "grains/uniaxial_compression.csv"})
    EXPECT_EQ(content(folder.path() / "one" / file), content(folder.path() / "two" / file)) << file;

  CsvReader table(folder.path() / "one/minerals.csv");
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
  CsvReader cracks(folder.path() / "one/cracks.csv");
  std::map<std::string, double> within;
  std::size_t n_on_boundaries = 0;
  while (cracks.next())
    {
      const double one = cracks.number(cracks.place("mineral_1")), two = cracks.number(cracks.place("mineral_2"));
      EXPECT_TRUE(1 <= one && one <= two && two <= 2);
      if (cracks.number(cracks.place("on_boundary")) == 1.0)
        ++n_on_boundaries;
      else
        {
          EXPECT_EQ(one, two);
          ++within[one == 1.0 ? "quartz" : "mica"];
        }
    }
  EXPECT_EQ(within["mica"], last_within["mica"]); // the last snapshot is the end
  EXPECT_GT(n_on_boundaries, 0u);

  const auto summary = nlohmann::json::parse(content(folder.path() / "one/summary.json"));
  EXPECT_EQ(summary["tests"][0]["minerals"][1]["name"], "mica");
  EXPECT_EQ(summary["tests"][0]["minerals"][1]["colour"], "#505050");
  EXPECT_GT(summary["tests"][0]["boundary_crack_share_at_peak"], 0.2);

  // A page made anew from the files knows the minerals too.
  ASSERT_EQ(run_feldspar(folder.path(), "report one --output again").exit_code, 0);
  const std::string page = content(folder.path() / "again/report.html");
  for (const char* const words : {"Cracks by mineral", "quartz | mica", "in mica"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

// One of two variants has no minerals, and so nothing that is rigid.
TEST(Minerals, MayBeOfOneVariantAlone)
{
  const TemporaryFolder folder;
  write_rock(folder);
  const auto outcome = run_without_pictures(
    folder.path(),
    "lab rock.prm --output out --quiet --set 'Minerals/Grains = rigid' --set 'Variants/Entry = Minerals/Table' "
    "--set 'Variants/Values = minerals.csv; none' --set 'Tests/Stop strain = 1e-5'");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const auto tests = nlohmann::json::parse(content(folder.path() / "out/summary.json"))["tests"];
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
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  run_and_kill_once(folder.path(), "lab rock.prm --output out --quiet --set 'Tests/Steps between checkpoints = 500'",
                    "[ -e out/checkpoints/uniaxial_compression.h5 ] && sleep 0.5");
  const auto outcome = run_without_pictures(folder.path(), "lab --resume out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_EQ(outcome.error.find("kept as"), std::string::npos) << outcome.error;
  for (const char* const file : {"cracks.csv", "minerals.csv", "curves/uniaxial_compression.csv"})
    EXPECT_EQ(content(folder.path() / "out" / file), content(folder.path() / "whole" / file)) << file;
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
  folder.write("volume.prm", R"(subsection Specimen
  set Shape  = periodic
  set Width  = 14 mm
  set Height = 14 mm
end
subsection Minerals
  set Table      = minerals.csv
  set Boundaries = boundaries.csv
end
subsection Strain path
  set Direction = free, 1, free
  set Size      = 2e-4
end
subsection Sample
  set Width           = 12 mm
  set Height          = 24 mm
  set Elements across = 1
  set Elements along  = 2
  set Realisations    = 2
end
subsection Tests
  set List        = direct_tension
  set Stop strain = 2e-4
end
)");
}

/// Mineral on the one side, on the other, and whether a boundary is between them.
using Sides = std::array<double, 3>;

std::set<Sides> sides_of_cracks(const fs::path& file)
{
  CsvReader cracks(file);
  std::set<Sides> sides;
  while (cracks.next())
    sides.insert({cracks.number(cracks.place("mineral_1")), cracks.number(cracks.place("mineral_2")),
                  cracks.number(cracks.place("on_boundary"))});
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
          const auto path = run_feldspar(folder.path(), "rve volume.prm --output rve --force --quiet --set 'Strain "
                                                        "path/Solver = " +
                                                          solver + "'");
          ASSERT_EQ(path.exit_code, 0) << path.error;
          EXPECT_EQ(sides_of_cracks(folder.path() / "rve/cracks.csv"), std::set{sides}) << weak << ", " << solver;
        }
      const auto rve = nlohmann::json::parse(content(folder.path() / "rve/summary.json"))["rves"][0];
      EXPECT_EQ(rve["minerals"][1]["name"], "mica");

      const auto run = run_without_pictures(folder.path(), "multiscale volume.prm --output out --force --quiet");
      ASSERT_EQ(run.exit_code, 0) << run.error;
      EXPECT_EQ(sides_of_cracks(folder.path() / "out/cracks.csv"), std::set{sides}) << weak;
      const auto test = nlohmann::json::parse(content(folder.path() / "out/summary.json"))["tests"][0];
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
  ASSERT_EQ(run_feldspar(folder.path(), "rve rock.prm --output rve --quiet --set 'Specimen/Shape = periodic' --set "
                                        "'Strain path/Size = 1e-6' " +
                                          settings)
              .exit_code,
            0);
  const auto rve = nlohmann::json::parse(content(folder.path() / "rve/summary.json"))["rves"][0];
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
