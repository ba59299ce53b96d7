// The laboratory as a user runs it, on small specimens.

#include "base/table/csv.h"
#include "tests/app/run_command.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <sstream>
#include <string>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Some three hundred grains; both tests take a second.
const std::string small_rock = R"(subsection Specimen
  set Width = 20 mm
  set Height = 40 mm
end
subsection Tests
  set Stop stress over peak = 0.7
end
subsection Seeds
  set Seeds = 3, 4
end
)";

nlohmann::json summary(const fs::path& folder) { return nlohmann::json::parse(content(folder / "summary.json")); }

/// Removes all that depends on the machine and not on the physics.
nlohmann::json without_times(nlohmann::json json)
{
  json.erase("host");
  json.erase("ensemble");
  for (auto& test : json["tests"])
    test.erase("wall_time_s");
  return json;
}

TEST(Lab, WritesWhatItPromises)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  // Progress goes to standard error, in lines that fit a page, and begins with the size of the work.
  EXPECT_EQ(outcome.error.find("genesis of 2 specimens, some "), 0u) << outcome.error;
  EXPECT_NE(outcome.error.find("tests: 4 of 4 done ("), std::string::npos) << outcome.error;
  std::istringstream lines(outcome.error);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), 80u) << line;
  EXPECT_EQ(outcome.output.find("4 of 4 done"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("How far to trust it: "), std::string::npos) << outcome.output;
  const fs::path results = folder.path() / "rock-results-001";
  for (const char* file :
       {"summary.json", "cracks.csv", "log.txt", "specimen_seed_3.h5", "specimen_seed_4.h5",
        "curves/direct_tension_seed_3.csv", "curves/uniaxial_compression_seed_4.csv",
        "figures/direct_tension_seed_3_stress_strain.png", "figures/direct_tension_seed_3_stress_strain.svg",
        "figures/uniaxial_compression_seed_4_cracks.png"})
    EXPECT_GT(fs::file_size(results / file), 100u) << file;
  // The last line names the page; with --quiet the folder, for scripts.
  EXPECT_TRUE(outcome.output.ends_with("\nrock-results-001/report.html\n")) << outcome.output;

  const auto json = summary(results);
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["input"]["parameters"]["Specimen"]["Width"], "20 mm");
  ASSERT_EQ(json["tests"].size(), 4u);
  const auto& test = json["tests"][0];
  EXPECT_EQ(test["kind"], "direct_tension");
  EXPECT_EQ(test["seed"], 3);
  for (const char* key : {"confining_pressure_Pa",
                          "peak_stress_Pa",
                          "strain_at_peak",
                          "youngs_modulus_initial_Pa",
                          "youngs_modulus_tangent_Pa",
                          "youngs_modulus_secant_Pa",
                          "poissons_ratio_initial",
                          "poissons_ratio_secant",
                          "crack_initiation_stress_Pa",
                          "n_tension_cracks",
                          "n_shear_cracks",
                          "n_tension_cracks_at_peak",
                          "n_shear_cracks_at_peak",
                          "n_grains",
                          "n_joints",
                          "coordination_number",
                          "coordination_number_core",
                          "installation_gap_ratio",
                          "porosity",
                          "energy_imbalance",
                          "kinetic_to_strain_energy",
                          "steps",
                          "wall_time_s"})
    EXPECT_TRUE(test.contains(key) && (test[key].is_number() || test.contains(std::string(key) + "_reason"))) << key;
  EXPECT_TRUE(test["servo_error"].is_null());
  EXPECT_FALSE(test["servo_error_reason"].get<std::string>().empty());
  EXPECT_EQ(json["ensemble"]["direct_tension"]["peak_stress_Pa"]["n"], 2);

  // Cracks are counted once: in the summary and row by row.
  const std::string cracks = content(results / "cracks.csv");
  std::size_t n_rows = 0;
  for (const char c : cracks)
    n_rows += c == '\n';
  std::size_t n_cracks = 0;
  for (const auto& one : json["tests"])
    n_cracks += one["n_tension_cracks"].get<std::size_t>() + one["n_shear_cracks"].get<std::size_t>();
  EXPECT_EQ(n_rows, n_cracks + 1);

  // A second run goes beside the first.
  EXPECT_EQ(run_feldspar(folder.path(), "lab rock.prm --quiet").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "rock-results-002" / "summary.json"));
}

TEST(Lab, GivesTheSameBitsForAnyNumberOfThreadsAndAnyLocale)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  make_german_locale(folder.path());
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output one --threads 1 --quiet").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output two --threads 2 --quiet",
                         path_without_gnuplot() + " LOCPATH=" + folder.path().string() + " LC_ALL=de_DE.UTF-8")
              .exit_code,
            0);
  EXPECT_EQ(without_times(summary(folder.path() / "one")), without_times(summary(folder.path() / "two")));
  for (const char* file :
       {"cracks.csv", "emission.csv", "curves/direct_tension_seed_3.csv", "curves/uniaxial_compression_seed_4.csv"})
    EXPECT_EQ(content(folder.path() / "one" / file), content(folder.path() / "two" / file)) << file;
}

TEST(Lab, TestsASpecimenMadeBefore)
{
  const TemporaryFolder folder;
  std::string rock = small_rock;
  rock.replace(rock.find("3, 4"), 4, "3");
  folder.write("rock.prm", rock);
  ASSERT_EQ(run_feldspar(folder.path(), "specimen rock.prm --output made").exit_code, 0);
  rock.insert(rock.find("  set Width"), "  set Specimen file = made/specimen.h5\n");
  folder.write("again.prm", rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output fresh --quiet").exit_code, 0);
  const auto again = run_feldspar(folder.path(), "lab again.prm --output again");
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_EQ(content(folder.path() / "fresh/cracks.csv"), content(folder.path() / "again/cracks.csv"));
  // The file has its grains and joints, whatever else the input says of them.
  EXPECT_NE(again.error.find("the specimen is that of made/specimen.h5"), std::string::npos) << again.error;
  EXPECT_NE(again.error.find("have no effect on it: Specimen/Width"), std::string::npos) << again.error;
}

// Out to the forms of other codes and in again, to the last bit, with the joints that the list of bonds names.
TEST(Lab, WritesPackingsThatItReadsAgain)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  const auto made =
    run_feldspar(folder.path(), "specimen rock.prm --packing yade --packing lammps --output made --quiet");
  ASSERT_EQ(made.exit_code, 0) << made.error;
  EXPECT_NE(made.output.find("made/packings/specimen_seed_4.data\n"), std::string::npos) << made.output;
  for (const char* const name : {"specimen_seed_3.txt", "specimen_seed_3.data"})
    {
      const auto again = run_feldspar(
        folder.path(), fmt::format("specimen rock.prm --set 'Specimen/Packing file = made/packings/{}' --set "
                                   "'Seeds/Seeds = 3' --packing yade --packing lammps --output again --force --quiet",
                                   name));
      ASSERT_EQ(again.exit_code, 0) << again.error;
      for (const char* const ending : {".txt", ".data"})
        EXPECT_TRUE(content(folder.path() / fmt::format("again/packings/specimen{}", ending)) ==
                    content(folder.path() / fmt::format("made/packings/specimen_seed_3{}", ending)))
          << name << " " << ending;
    }
  EXPECT_EQ(run_feldspar(folder.path(), "specimen rock.prm --packing pfc --output none").exit_code, 2);
}

TEST(Lab, RefusesWhatItCannotDoAndLeavesNothing)
{
  const TemporaryFolder folder;
  folder.write("broken.h5", "no specimen");
  folder.write("packing.txt", "0.01 0.01 0.001\n0.011 0.01 0.001\n");
  const std::string sizes = "subsection Specimen\n  set Width = 20 mm\n  set Height = 40 mm\nend\n";
  std::string seeds = "subsection Seeds\n  set Seeds = 3, 4\nend\n";
  const auto refused = [&](const std::string& more, const std::string& expected) {
    folder.write("rock.prm", sizes + seeds + more);
    for (const char* command : {"lab", "specimen"})
      {
        const auto outcome = run_without_pictures(folder.path(), std::string(command) + " rock.prm --quiet");
        EXPECT_EQ(outcome.exit_code, 2) << more;
        EXPECT_NE(outcome.error.find(expected), std::string::npos) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        EXPECT_FALSE(fs::exists(folder.path() / "rock-results-001")) << more;
      }
  };
  refused("subsection Flat joint\n  set Coordination number = 9\nend\n", "this packing allows");
  refused("subsection Flat joint\n  set Coordination number = 1\nend\n", "this packing allows");
  refused("subsection Specimen\n  set Specimen file = broken.h5\nend\n", "is one specimen; it goes with one seed");
  seeds = "subsection Seeds\n  set Seeds = 3\nend\n";
  refused("subsection Specimen\n  set Specimen file = broken.h5\nend\n", "broken.h5: not an HDF5 file");
  refused("subsection Specimen\n  set Packing file = packing.txt\nend\n", "packing.txt:2: overlaps");
}

TEST(Lab, RefusesASurroundingThatItsSpecimenCannotHave)
{
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& specimen, const std::string& tests, const std::string& expected) {
    folder.write("rock.prm", "subsection Specimen\n" + specimen + "end\nsubsection Tests\n" + tests + "end\n");
    const auto outcome = run_feldspar(folder.path(), "lab rock.prm");
    EXPECT_EQ(outcome.exit_code, 2) << tests;
    EXPECT_EQ(outcome.error.find("feldspar: rock.prm: Tests/" + expected), 0u) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_FALSE(fs::exists(folder.path() / "rock-results-001")) << tests;
  };
  refused("", "  set Intermediate stress = 30 MPa\n",
          "Intermediate stress = 30 MPa: presses on two sides of a box of grains in space");
  refused("", "  set Brazilian length ratio = 0.3\n", "Brazilian length ratio = 0.3: is the length of a disc in space");
  refused("  set Dimension = 3\n",
          "  set List = triaxial_compression\n  set Intermediate stress = 30 MPa\n  set Confinements = 40 MPa\n",
          "Intermediate stress = 30 MPa: must be at least the least stress, and Confinements has 40 MPa");
}

TEST(Lab, RefusesLoadsThatDoNotFitTheBodyTheTestsOrEachOther)
{
  const TemporaryFolder folder;
  folder.write("stages.csv", "axial_strain\n1e-3\n");
  const auto refused = [&](const std::string& tests, const std::string& expected) {
    folder.write("rock.prm", "subsection Tests\n" + tests + "end\n");
    for (const char* const command : {"lab rock.prm", "parameters --check rock.prm --for lab"})
      {
        const auto outcome = run_feldspar(folder.path(), command);
        EXPECT_EQ(outcome.exit_code, 2) << tests;
        EXPECT_NE(outcome.error.find(expected), std::string::npos) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
      }
    EXPECT_FALSE(fs::exists(folder.path() / "rock-results-001")) << tests;
  };
  refused("  set Gravity = -9.81 m/s^2\n", "must be none, or have a component for each axis");
  refused("  set Gravity = 0, 0, -9.81 m/s^2\n", "Tests/Gravity = 0, 0, -9.81 m/s^2: must have 2 components");
  refused("  set List = tilt\n  set Platen friction = 0.3\n", "Tests/Gravity: the weight presses the body of tilt");
  refused("  set List = tilt\n  set Gravity = 0, -9.81 m/s^2\n", "Tests/Platen friction = 0: must lie in (0, 0.25]");
  refused("  set Compression loading rate = 0.7 MPa\n", "a rate > 0 of stress, force or travel");
  refused("  set Compression loading rate = 0.7 MPa/s\n  set Machine stiffness = 500 kN/mm\n",
          "Tests/Compression loading rate = 0.7 MPa/s: a machine that raises its force has no stiffness");
  refused("  set List = own_loading\n  set Loading table = stages.csv\n  set Machine stiffness = 500 kN/mm\n",
          "Tests/Machine stiffness: own_loading follows its table");
}

TEST(Lab, TellsEntriesThatNoneOfItsTestsTakes)
{
  const TemporaryFolder folder;
  folder.write("rock.prm",
               "subsection Tests\n  set List = direct_tension\n  set Lateral boundary = membrane\n"
               "  set Compression loading rate = 0.7 MPa/s\n  set Platen friction = 0.3\n"
               "  set Seating transits = 5\n  set Confinements = 7 MPa\n  set Gravity = 0, -9.81 m/s^2\nend\n");
  const auto check = run_feldspar(folder.path(), "parameters --check rock.prm --for lab");
  EXPECT_EQ(check.exit_code, 0) << check.error;
  for (
    const char* const remark :
    {"Tests/Lateral boundary has no effect: it is of triaxial_compression, and Tests/List has direct_tension",
     "Tests/Compression loading rate has no effect: it is of uniaxial_compression, triaxial_compression, and",
     "Tests/Platen friction has no effect: it is of uniaxial_compression, triaxial_compression, own_loading, tilt, and",
     "Tests/Seating transits has no effect: it is of triaxial_compression, direct_shear, own_loading, tilt, and",
     "Tests/Confinements has no effect: it is of triaxial_compression, direct_shear, and"})
    EXPECT_NE(check.output.find(remark), std::string::npos) << check.output;
  EXPECT_EQ(std::count(check.output.begin(), check.output.end(), '\n'), 6)
    << check.output; // gravity acts in every test
}

TEST(Lab, TellsTheRateOfTheLaboratoryBesideItsOwn)
{
  // 0.1 mm/min on 24 mm are 6.94e-5 1/s; at 2/s the loading to a strain of 1e-3 is 28 800 times as fast.
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                           "subsection Tests\n  set List = uniaxial_compression\n  set Stop strain = 1e-3\n"
                           "  set Compression strain rate = 2 1/s\n  set Compression loading rate = 0.1 mm/min\nend\n");
  const auto outcome = run_without_pictures(folder.path(), "lab rock.prm --output out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const auto test = summary(folder.path() / "out")["tests"][0];
  EXPECT_NEAR(test["rate_over_laboratory"].get<double>(), 28800.0, 1.0);
  EXPECT_GT(test["steps_at_laboratory_rate"].get<double>(), 28800.0 * 1000.0);
  EXPECT_TRUE(test["stress_rate_Pa_per_s"].is_null());
  std::string words = content(folder.path() / "out/log.txt");
  std::replace(words.begin(), words.end(), '\n', ' ');
  for (const std::string& text : {words, content(folder.path() / "out/report.html")})
    EXPECT_NE(text.find("The rate of the laboratory is 6.94e-05 1/s, that of the run 2 1/s"), std::string::npos);
}

/// Some ninety grains; the programme takes a few seconds.
const std::string tiny_rock = R"(subsection Specimen
  set Width = 12 mm
  set Height = 24 mm
end
subsection Tests
  set List = direct_tension, triaxial_compression
  set Confinements = 10, 30 MPa
  set Stop stress over peak = 0.9
  set Steps between checkpoints = 4000
end
)";

TEST(Lab, KilledTenTimesAndResumedGivesTheBitsOfTheUnbrokenRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  std::mt19937 random(7); // the moments need not be the same in every run: the bits must be
  const auto complete = [&] { return content(folder.path() / "broken/run.json").find("true") != std::string::npos; };
  run_and_kill_once(folder.path(), "lab rock.prm --output broken --quiet", "test -e broken/run.json");
  ASSERT_TRUE(fs::exists(folder.path() / "broken/run.json"));
  int n_kills = 1;
  for (; n_kills < 10 && !complete(); ++n_kills)
    run_feldspar(folder.path(), "lab --resume broken --quiet",
                 fmt::format("timeout --foreground --signal=KILL {}", 0.3 + 0.05 * double(random() % 10)));
  EXPECT_GE(n_kills, 3);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab --resume broken --quiet").exit_code, 0);
  EXPECT_EQ(without_times(summary(folder.path() / "whole")), without_times(summary(folder.path() / "broken")));
  for (const char* file :
       {"cracks.csv", "curves/direct_tension_seed_1.csv", "curves/triaxial_compression_30_MPa_seed_1.csv"})
    EXPECT_EQ(content(folder.path() / "whole" / file), content(folder.path() / "broken" / file)) << file;
  EXPECT_FALSE(fs::exists(folder.path() / "broken/checkpoints"));
}

// Resumed, it names the file from the root; the checkpoint is of the same input none the less.
TEST(Lab, AKilledRunWithAFileBesideItsInputIsTakenUpFromItsCheckpoint)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock + "subsection Report\n  set Reference file = reference.json\nend\n");
  folder.write("reference.json", R"({"experiment": {"tensile_strength_MPa": 9}})");
  const auto has_checkpoint = [&] {
    const fs::path checkpoints = folder.path() / "broken/checkpoints";
    return fs::exists(checkpoints) && !fs::is_empty(checkpoints);
  };
  run_and_kill_once(folder.path(), "lab rock.prm --output broken --quiet",
                    "ls broken/checkpoints/*.h5 >/dev/null 2>&1");
  ASSERT_TRUE(has_checkpoint());
  const auto resumed = run_without_pictures(folder.path(), "lab --resume broken --quiet");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.error;
  EXPECT_EQ(resumed.error.find("going back"), std::string::npos) << resumed.error;
  const auto input = summary(folder.path() / "broken")["input"];
  EXPECT_EQ(input["parameters"]["Report"]["Reference file"], "reference.json") << "as the input names it";
}

TEST(Lab, ATornOrForeignCheckpointIsRefusedAndTheOneBeforeItUsed)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const fs::path checkpoints = folder.path() / "broken/checkpoints";
  const fs::path torn = checkpoints / "triaxial_compression_30_MPa_seed_1.h5";
  const fs::path before = checkpoints / "triaxial_compression_30_MPa_seed_1.previous.h5";
  const fs::path foreign = checkpoints / "triaxial_compression_10_MPa_seed_1.h5";
  // Killed once there are two checkpoints of one test and one of another, and before they are gone again; both tests have
  // a while together.
  for (int tries = 0; tries < 5 && !(fs::exists(torn) && fs::exists(before) && fs::exists(foreign)); ++tries)
    run_and_kill_once(folder.path(), "lab rock.prm --output broken --force --quiet",
                      fmt::format("test -e {} -a -e {} -a -e {}", torn.string(), before.string(), foreign.string()));
  ASSERT_TRUE(fs::exists(torn) && fs::exists(before) && fs::exists(foreign));
  fs::copy_file(torn, foreign, fs::copy_options::overwrite_existing);
  fs::resize_file(torn, fs::file_size(torn) / 2);
  const auto outcome = run_without_pictures(folder.path(), "lab --resume broken --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  EXPECT_NE(outcome.error.find("30_MPa_seed_1.h5: damaged or cut short"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("going back to the checkpoint before it"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("10_MPa_seed_1.h5: of another test"), std::string::npos) << outcome.error;
  EXPECT_EQ(without_times(summary(folder.path() / "whole")), without_times(summary(folder.path() / "broken")));
}

TEST(Lab, AFullDiskIsSaidInOneLineAndTheRunCanGoOn)
{
  // A limit on the size of files stands for the full disk. Checkpoints grow with the curve: the first are within it.
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output full --quiet", "prlimit --fsize=350000");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_NE(outcome.error.find(".h5: cannot be written: File too large"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find("feldspar lab --resume full"), std::string::npos) << outcome.error;
  std::size_t n_checkpoints = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "full/checkpoints"))
    {
      EXPECT_EQ(entry.path().extension(), ".h5") << entry.path(); // nothing half written
      ++n_checkpoints;
    }
  EXPECT_GT(n_checkpoints, 0u);
  const auto resumed = run_without_pictures(folder.path(), "lab --resume full --quiet");
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_EQ(resumed.error, "");
  EXPECT_EQ(without_times(summary(folder.path() / "whole")), without_times(summary(folder.path() / "full")));
  // Nothing is left where not even the beginning can be kept.
  const auto none = run_feldspar(folder.path(), "lab rock.prm --output none --quiet", "prlimit --fsize=10");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_FALSE(fs::exists(folder.path() / "none"));
}

TEST(Lab, TestsACylinderInThreeDimensions)
{
  // Some sixty spheres; what is asked is that every part of a run takes them.
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Dimension = 3
  set Shape = cylinder
  set Width = 6 mm
  set Height = 8 mm
  set Porosity = 0.42
end
subsection Tests
  set List = direct_tension, triaxial_compression, brazilian
  set Confinements = 10 MPa
  set Lateral boundary = membrane
  set Brazilian length ratio = 0.8
  set Compression strain rate = 8 1/s
  set Tension strain rate = 2 1/s
  set Brazilian strain rate = 2 1/s
  set Compression sampling strain = 1e-4
  set Stop strain over peak strain = 1.1
end
)");
  ASSERT_EQ(run_feldspar(folder.path(), "specimen rock.prm --output made --quiet").exit_code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "made/specimen.h5"));
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const fs::path out = folder.path() / "out";
  const auto json = summary(out);
  ASSERT_EQ(json["tests"].size(), 3u);
  for (const auto& test : json["tests"])
    EXPECT_TRUE(test["peak_stress_Pa"].is_number()) << test["name"];
  EXPECT_EQ(json["input"]["parameters"]["Specimen"]["Dimension"], "3");
  const auto expect_pictures = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names)
      EXPECT_GT(fs::file_size(out / "figures" / (name + ".png")), 10'000u) << name;
  };
  expect_pictures(
    {"direct_tension_seed_1_cracks", "direct_tension_seed_1_fragments", "triaxial_compression_10_MPa_seed_1_cracks"});
  EXPECT_EQ(content(out / "report.html").find("class=\"absent\""), std::string::npos);
  // Without Chromium the viewer shows cracks and fragments in the place of their pictures.
  fs::remove_all(out / "figures");
  fs::create_directory(folder.path() / "bin");
  fs::create_symlink("/usr/bin/gnuplot", folder.path() / "bin/gnuplot");
  ASSERT_EQ(run_feldspar(folder.path(), "report out", "PATH='" + (folder.path() / "bin").string() + "'").exit_code, 0);
  expect_pictures({"direct_tension_seed_1_stress_strain"});
  for (const std::string of_body : {"cracks", "fragments"})
    EXPECT_FALSE(fs::exists(out / "figures" / ("direct_tension_seed_1_" + of_body + ".png"))) << of_body;
  const std::string page = content(out / "report.html");
  EXPECT_NE(page.find("<noscript><p class=\"absent\""), std::string::npos);
  EXPECT_EQ(page.find("\n<p class=\"absent\""), std::string::npos);
  // A box by three stresses.
  folder.write("box.prm", R"(subsection Specimen
  set Dimension = 3
  set Width = 6 mm
  set Height = 8 mm
  set Porosity = 0.42
end
subsection Tests
  set List = triaxial_compression
  set Confinements = 5 MPa
  set Intermediate stress = 15 MPa
  set Stop strain = 1e-3
  set Compression strain rate = 8 1/s
  set Compression sampling strain = 1e-4
end
subsection Variants
  set Entry = Tests/Lateral boundary
  set Values = wall; membrane
end
)");
  EXPECT_EQ(run_feldspar(folder.path(), "lab box.prm --output box --quiet").exit_code, 0);
}

TEST(Lab, HoldsABodyInThePlaneByAMembrane)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Width = 12 mm
  set Height = 24 mm
end
subsection Flaws
  set Shapes = closed flaw from 0, 4 mm to 12, 20 mm smooth
end
subsection Tests
  set List = triaxial_compression
  set Confinements = 10 MPa
  set Stop strain = 2e-3
  set Compression strain rate = 4 1/s
end
subsection Variants
  set Entry = Tests/Lateral boundary
  set Values = wall; membrane
end
)");
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output out --quiet").exit_code, 0);
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["servo_error"].is_number());
  EXPECT_TRUE(json["tests"][1]["servo_error"].is_null());
  EXPECT_LT(json["tests"][1]["energy_imbalance"].get<double>(), 0.01);
  // Rigid plates hold a plane through the body by more than the confinement; the remark advises the membrane.
  const std::string page = content(folder.path() / "out/report.html");
  EXPECT_NE(page.find("Tests/Lateral boundary = membrane has no such error"), std::string::npos);
}

TEST(Lab, RunsVariantsOfOneEntry)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Width = 12 mm
  set Height = 24 mm
end
subsection Tests
  set List = direct_tension
end
subsection Variants
  set Entry = Flat joint/Bond tensile strength
  set Values = 22 MPa; 44 MPa
end
)");
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output out --quiet").exit_code, 0);
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_EQ(json["tests"][1]["variant"], "Flat joint/Bond tensile strength = 44 MPa");
  // Same packing, the same joint fails at about twice the load; the deviation of the strengths stays 2.2 MPa.
  const double ratio =
    json["tests"][1]["peak_stress_Pa"].get<double>() / json["tests"][0]["peak_stress_Pa"].get<double>();
  EXPECT_NEAR(ratio, 2.0, 0.3);
  const auto& mean = json["ensemble"]["direct_tension_bond_tensile_strength_44_MPa"];
  EXPECT_EQ(mean["variant"], "Flat joint/Bond tensile strength = 44 MPa");
  EXPECT_EQ(mean["variant_values"]["Flat joint/Bond tensile strength"]["value"], 44);
  // Each variant is a rock with fits of its own, or the reason why there is none.
  ASSERT_EQ(json["fits_of_variants"].size(), 2u);
  EXPECT_EQ(json["fits_of_variants"][1]["variant_values"]["Flat joint/Bond tensile strength"]["value"], 44);
  EXPECT_FALSE(json["fits_of_variants"][1]["intact"]["with_tension_point"]["reason"].get<std::string>().empty());

  const auto& setting = json["tests"][1]["variant_values"]["Flat joint/Bond tensile strength"];
  EXPECT_EQ(setting["value"], 44);
  EXPECT_EQ(setting["unit"], "MPa");
  EXPECT_TRUE(fs::exists(folder.path() / "out/curves/direct_tension_bond_tensile_strength_22_MPa_seed_1.csv"));
  CsvReader table(folder.path() / "out/tests.csv");
  for (const auto& test : json["tests"])
    {
      ASSERT_TRUE(table.next());
      EXPECT_EQ(table.text(table.place("name")), test["name"].get<std::string>());
      EXPECT_EQ(table.number(table.place("Flat joint/Bond tensile strength [MPa]")),
                test["variant_values"]["Flat joint/Bond tensile strength"]["value"].get<double>());
      const double peak = test["peak_stress_Pa"].get<double>();
      EXPECT_NEAR(table.number(table.place("peak_stress_Pa")), peak, 1e-9 * peak); // ten digits
    }
  EXPECT_FALSE(table.next());
  EXPECT_TRUE(content(folder.path() / "out/tables/comparison.csv")
                .starts_with("source,kind,Flat joint/Bond tensile strength [MPa],property,unit,mean,"));

  // A folder of before values were in names is resumed by its own names.
  auto record = nlohmann::json::parse(content(folder.path() / "out/run.json"));
  record.erase("variants_named");
  record["complete"] = false;
  folder.write("out/run.json", record.dump());
  ASSERT_EQ(run_feldspar(folder.path(), "lab --resume out --quiet").exit_code, 0);
  const auto old = summary(folder.path() / "out");
  EXPECT_EQ(old["tests"][1]["name"], "direct_tension_variant_2_seed_1");
  EXPECT_EQ(old["tests"][1]["peak_stress_Pa"], json["tests"][1]["peak_stress_Pa"]);
}

// A core is tested like any specimen, to the same bits for any number of threads; what it is stands in the results, in
// the log and on the page. Beside results on a body of another gap the log says so.
TEST(Lab, TestsCoresAndSaysWhatTheyAre)
{
  const TemporaryFolder folder;
  const auto rock = [](const std::string& gap, const std::string& more) {
    return "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\n  set Coring = free sides\nend\n"
           "subsection Flat joint\n  set Installation gap ratio = " +
           gap + "\nend\nsubsection Tests\n  set List = direct_tension\n  set Tension strain rate = 1 1/s\nend\n" +
           more;
  };
  folder.write("wide.prm", rock("0.05", ""));
  folder.write("narrow.prm", rock("0.01", "subsection Report\n  set Reference results = one/summary.json\nend\n"));
  ASSERT_EQ(run_feldspar(folder.path(), "lab wide.prm --output one --quiet --threads 1").exit_code, 0);
  ASSERT_EQ(run_feldspar(folder.path(), "lab wide.prm --output two --quiet --threads 2").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "one/curves/direct_tension_seed_1.csv"),
            content(folder.path() / "two/curves/direct_tension_seed_1.csv"));
  const auto test = summary(folder.path() / "one")["tests"][0];
  EXPECT_GT(test["n_cut_joints"].get<int>(), 10);
  EXPECT_GT(test["peak_stress_Pa"].get<double>(), 3e6);
  EXPECT_NE(content(folder.path() / "one/log.txt").find("cored: joints cut / grains removed"), std::string::npos);
  EXPECT_NE(content(folder.path() / "one/report.html").find("Cored: packed without walls"), std::string::npos);

  const auto outcome = run_feldspar(folder.path(), "lab narrow.prm --output narrow --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const std::string log = content(folder.path() / "narrow/log.txt");
  EXPECT_NE(log.find("this run: gap 0.0100 mean radii, coordination number "), std::string::npos) << log;
  EXPECT_NE(log.find("reference one: gap 0.0500 mean radii"), std::string::npos) << log;
  EXPECT_NE(log.find("this run and reference one are different rocks"), std::string::npos) << log;
  ASSERT_EQ(run_feldspar(folder.path(), "report one narrow --output both --quiet").exit_code, 0);
  EXPECT_NE(content(folder.path() / "both/report.html").find("are different rocks"), std::string::npos);

  for (const auto& [entry, words] :
       {std::pair("Specimen/Shape = periodic", "Specimen/Coring"), {"Specimen/Coring = none", "Specimen/Cells across"}})
    {
      const auto bad = run_feldspar(folder.path(), "specimen wide.prm --output bad --set 'Specimen/Cells across = 2' "
                                                   "--set '" +
                                                     std::string(entry) + "'");
      EXPECT_EQ(bad.exit_code, 2) << entry;
      EXPECT_NE(bad.error.find(words), std::string::npos) << bad.error;
      EXPECT_FALSE(fs::exists(folder.path() / "bad"));
    }
}

TEST(Lab, VariantsOfTheTestsShareTheirSpecimens)
{
  // Variants differ in the rate: each seed is packed once, and is the specimen of a run without variants.
  const TemporaryFolder folder;
  const std::string rock = R"(subsection Specimen
  set Width = 12 mm
  set Height = 24 mm
end
subsection Tests
  set List = direct_tension
end
subsection Seeds
  set Seeds = 3, 4
end
)";
  folder.write("one.prm", rock);
  folder.write("rates.prm", rock + "subsection Variants\n  set Entry = Tests/Tension strain rate\n"
                                   "  set Values = 0.164 1/s; 0.328 1/s\nend\n");
  ASSERT_EQ(run_without_pictures(folder.path(), "lab one.prm --output one --quiet").exit_code, 0);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rates.prm --output rates --quiet").exit_code, 0);
  std::vector<std::string> specimens;
  for (const auto& entry : fs::directory_iterator(folder.path() / "rates"))
    if (const std::string name = entry.path().filename().string(); name.starts_with("specimen"))
      specimens.push_back(name);
  std::sort(specimens.begin(), specimens.end());
  EXPECT_EQ(specimens, (std::vector<std::string>{"specimen_seed_3.h5", "specimen_seed_4.h5"}));
  const auto one = summary(folder.path() / "one");
  const auto rates = summary(folder.path() / "rates");
  ASSERT_EQ(rates["tests"].size(), 4u);
  for (const std::size_t seed : {0, 1})
    {
      EXPECT_EQ(rates["tests"][seed]["peak_stress_Pa"], one["tests"][seed]["peak_stress_Pa"]);
      EXPECT_EQ(rates["tests"][seed + 2]["strain_rate_per_s"], 0.328);
    }
}

TEST(Lab, SaysWhenAConfinementCannotBeReached)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                           "subsection Tests\n  set List = triaxial_compression\n  set Confinements = 40 GPa\nend\n");
  const auto outcome = run_without_pictures(folder.path(), "lab rock.prm --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("Tests/Confinements: the walls cannot hold 40000 MPa"), std::string::npos)
    << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "rock-results-001"));
}

TEST(Lab, ForceStartsAnew)
{
  // Results that an earlier run left, of another strength here, are not taken for those of this one.
  const TemporaryFolder folder;
  const std::string rock = "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                           "subsection Tests\n  set List = direct_tension\nend\n";
  folder.write("weak.prm", rock);
  folder.write("strong.prm", rock + "subsection Flat joint\n  set Bond tensile strength = 44 MPa\nend\n");
  ASSERT_EQ(run_without_pictures(folder.path(), "lab strong.prm --output fresh --quiet").exit_code, 0);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab weak.prm --output used --quiet").exit_code, 0);
  EXPECT_EQ(run_without_pictures(folder.path(), "lab strong.prm --output used --quiet").exit_code, 2);
  ASSERT_EQ(run_without_pictures(folder.path(), "lab strong.prm --output used --force --quiet").exit_code, 0);
  EXPECT_EQ(content(folder.path() / "fresh/cracks.csv"), content(folder.path() / "used/cracks.csv"));
}

TEST(Lab, OneTestThatCannotBeMadeDoesNotCostTheOthers)
{
  const TemporaryFolder folder;
  std::string rock = tiny_rock;
  const std::string wanted = "10, 30 MPa";
  rock.replace(rock.find(wanted), wanted.size(), "10, 40000 MPa");
  folder.write("rock.prm", rock + "subsection Seeds\n  set Seeds = 1, 2\nend\n");
  const auto outcome = run_without_pictures(folder.path(), "lab rock.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error,
            "feldspar: triaxial_compression_40000_MPa_seed_1, triaxial_compression_40000_MPa_seed_2: "
            "Tests/Confinements: the walls cannot hold 40000 MPa on this specimen; the other results are in "
            "out\n");
  EXPECT_NE(content(folder.path() / "out/log.txt")
              .find("on this specimen. The same holds for triaxial_compression_40000_MPa_seed_2."),
            std::string::npos);
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 6u);
  EXPECT_GT(json["tests"][1]["steps"], 0);
  EXPECT_NE(json["tests"][2]["peak_stress_Pa_reason"].get<std::string>().find("cannot hold"), std::string::npos);
  // A run that is over says again how it ended.
  const auto again = run_without_pictures(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.error.find("the walls cannot hold 40000 MPa"), std::string::npos) << again.error;
}

TEST(Lab, ATestWhoseNumbersGoWrongKeepsItsRowsAndDoesNotCostTheOthers)
{
  // The grips of this tension go more than a grain in a step.
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Width = 8 mm
  set Height = 12 mm
end
subsection Tests
  set List = uniaxial_compression, direct_tension
  set Compression strain rate = 8 1/s
  set Tension strain rate = 1e7 1/s
end
)");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error.find("feldspar: direct_tension_seed_1: numbers went wrong: grain "), 0u) << outcome.error;
  EXPECT_NE(outcome.error.find("a lower rate would help"), std::string::npos) << outcome.error;
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["peak_stress_Pa"].is_number());
  EXPECT_NE(json["tests"][1]["failure"].get<std::string>().find(" in step "), std::string::npos);
  EXPECT_NE(json["tests"][1]["peak_stress_Pa_reason"].get<std::string>().find("numbers went wrong"), std::string::npos);
  EXPECT_GE(content(folder.path() / "out/curves/direct_tension_seed_1.csv").size(), 100u);
  EXPECT_NE(content(folder.path() / "out/report.html").find("could not be finished: numbers went wrong"),
            std::string::npos);
}

TEST(Lab, ObeysWithinASecondInALongRowAndInALongSeating)
{
  // A row of minutes; a seating of minutes.
  const TemporaryFolder folder;
  const std::string rock = "subsection Specimen\n  set Width = 8 mm\n  set Height = 12 mm\nend\nsubsection Tests\n";
  folder.write("row.prm", rock + "  set List = uniaxial_compression\n  set Compression strain rate = 1e-5 1/s\nend\n");
  folder.write("seating.prm",
               rock +
                 "  set List = triaxial_compression\n  set Confinements = 10 MPa\n  set Seating transits = 1e4\nend\n");
  for (const auto& [name, signal] : {std::pair<std::string, std::string>{"row", "TERM"}, {"seating", "HUP"}})
    {
      const std::string out = name + signal;
      folder.write("interrupt", "\"$@\" &\nuntil [ -e " + out +
                                  "/specimen.h5 ]; do sleep 0.02; done\nsleep 0.5\n"
                                  "kill -" +
                                  signal + " $!\nsleep 1\nkill -KILL $! 2> no-process\nwait $!\n");
      const auto outcome =
        run_feldspar(folder.path(), "lab " + name + ".prm --output " + out + " --quiet", "sh ./interrupt");
      EXPECT_EQ(outcome.exit_code, 130) << out << ": " << outcome.error;
      EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar lab --resume " + out + "\n");
      EXPECT_EQ(fs::exists(folder.path() / out / "checkpoints/uniaxial_compression_seed_1.h5"), name == "row");
    }
}

TEST(Lab, ATestThatCannotEvenBeSetUpDoesNotCostTheOthers)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Width = 8 mm
  set Height = 12 mm
end
subsection Tests
  set List = uniaxial_compression, direct_tension
  set Grip ratio = 0.001
end
)");
  const auto outcome = run_without_pictures(folder.path(), "lab rock.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("grip"), std::string::npos) << outcome.error;
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["peak_stress_Pa"].is_number());
  EXPECT_NE(json["tests"][1]["peak_stress_Pa_reason"].get<std::string>().find("grip"), std::string::npos);
}

TEST(Lab, MeasuresADiscByItsOwnSize)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 20 mm\n  set Height = 30 mm\n"
                           "  set Packing relaxation = dynamics\nend\n"
                           "subsection Tests\n  set List = brazilian\nend\n"
                           "subsection Seeds\n  set Seeds = 1, 2\nend\n");
  // Packed by motion, the disc of the first seed has no grain near its poles: its pads are those of the outermost ones.
  EXPECT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output out --quiet").exit_code, 0);
  const auto json = summary(folder.path() / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  for (const auto& test : json["tests"])
    EXPECT_TRUE(test["peak_stress_Pa"].is_number()) << test["name"];
  for (const auto& test : json["tests"])
    EXPECT_EQ(test["size_m"], nlohmann::json({0.02, 0.02, 0})) << test["name"];
  // Grains of the disc lie in a circle of 10 mm about the middle of this size.
  std::istringstream grains(content(folder.path() / "out/grains/brazilian_seed_2.csv"));
  std::string row;
  for (std::getline(grains, row); std::getline(grains, row);)
    {
      double x = 0.0;
      double y = 0.0;
      ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf", &x, &y), 2) << row;
      EXPECT_LE(std::hypot(x - 0.01, y - 0.01), 0.01) << row;
    }
}

TEST(Lab, TakesEntriesOfTheCommandLineAndKeepsThemForAResume)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n");
  const std::string lab = "lab rock.prm --output out --set 'Tests/List = direct_tension' --set 'Specimen/Width = 8 mm' "
                          "--set 'Specimen/Height = 12 mm' ";
  ASSERT_EQ(run_without_pictures(folder.path(), lab + "--quiet").exit_code, 0);
  auto json = summary(folder.path() / "out");
  EXPECT_EQ(json["tests"].size(), 1u);
  EXPECT_EQ(json["input"]["parameters"]["Specimen"]["Width"], "8 mm");
  // A resumed run still has them.
  auto record = nlohmann::json::parse(content(folder.path() / "out/run.json"));
  record["complete"] = false;
  folder.write("out/run.json", record.dump());
  ASSERT_EQ(run_without_pictures(folder.path(), "lab --resume out --quiet").exit_code, 0);
  EXPECT_EQ(without_times(summary(folder.path() / "out")), without_times(json));
  // One digit of them would go on as another specimen.
  record = nlohmann::json::parse(content(folder.path() / "out/run.json"));
  record["complete"] = false;
  record["settings"][1] = "Specimen/Width = 9 mm";
  folder.write("out/run.json", record.dump());
  const auto changed = run_without_pictures(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_EQ(changed.error, "feldspar: out: run.json in it is not as the run wrote it; undo the change, or begin "
                           "another run\n");
  EXPECT_EQ(without_times(summary(folder.path() / "out")), without_times(json));

  const auto refused = [&](const std::string& setting, const std::string& words) {
    const auto outcome = run_feldspar(folder.path(), "lab rock.prm --set '" + setting + "'");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.error.find("feldspar: --set" + words), 0u) << outcome.error;
  };
  refused("Width = 8 mm", " \"Width = 8 mm\": write \"Section/Entry = value\"");
  refused("Specimen/Widht = 8 mm", ": Specimen/Widht: no such entry; did you mean \"Width\"?");
  refused("Specimen/Width = 8", ": Specimen/Width = 8: a unit is missing");
  refused("Specimen/Width = 8 mm' --set 'Specimen/Width = 9 mm", ": Specimen/Width: is given twice");
}

// A template is an input of a first run as it stands, and its reference is one that a report can be set beside.
TEST(New, WritesInputsThatPassTheCheckAndRun)
{
  const TemporaryFolder folder;
  for (const std::string name : {"rock", "study", "sample"})
    {
      const auto made = run_feldspar(folder.path(), "new " + name + " --output mine");
      ASSERT_EQ(made.exit_code, 0) << made.error;
      const std::string command = name == "sample" ? "multiscale" : "lab";
      EXPECT_NE(made.output.find("Next: feldspar " + command + " mine/" + name + ".prm"), std::string::npos);
      const std::string text = content(folder.path() / "mine" / (name + ".prm"));
      EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 200) << "of a first year";
      EXPECT_NE(text.find("\n  set Reference file = " + name + "-reference.json\n"), std::string::npos);
      // Every line that is a comment would be read, too.
      const std::string all = std::regex_replace(text, std::regex("# set "), "set ");
      folder.write("mine/all.prm", all);
      for (const std::string& input : {name, std::string("all")})
        {
          const auto check = run_feldspar(folder.path(), "parameters --check mine/" + input + ".prm --for " + command);
          EXPECT_EQ(check.exit_code, 0) << check.error << all;
        }
      const auto run =
        run_without_pictures(folder.path(), command + " mine/" + name + ".prm --output " + name + " --quiet");
      EXPECT_EQ(run.exit_code, 0) << run.error;
      EXPECT_TRUE(std::filesystem::exists(folder.path() / name / "summary.json"));
    }

  // Neither file is written over, nor one of them made anew.
  folder.write("mine/study-reference.json", "mine");
  std::filesystem::remove(folder.path() / "mine/study.prm");
  const auto again = run_feldspar(folder.path(), "new study --output mine");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(again.error, "feldspar: mine/study-reference.json: is there already; name another folder by --output\n");
  EXPECT_EQ(content(folder.path() / "mine/study-reference.json"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "mine/study.prm"));
  EXPECT_EQ(run_feldspar(folder.path(), "new stone").exit_code, 2);
}

TEST(Help, IsThereByTheWordsThatUsersTry)
{
  const TemporaryFolder folder;
  const auto said = [&](const std::string& arguments) {
    const auto outcome = run_feldspar(folder.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    return outcome.output;
  };
  EXPECT_EQ(said("help"), said("--help"));
  EXPECT_EQ(said("help lab"), said("lab --help"));
  EXPECT_NE(said("help lab").find("Examples:\n  feldspar lab granite.prm"), std::string::npos) << said("help lab");
  EXPECT_EQ(said("version"), said("--version"));
  EXPECT_NE(said("parameters PLATEN").find("Tests/Platen friction\n    unit -; default 0"), std::string::npos);
}

// The manual page has every command and every entry, and man makes no request of a line of text. The completion is asked as
// bash asks it.
TEST(Help, IsThereForManAndBash)
{
  const TemporaryFolder folder;
  const std::string page = run_feldspar(folder.path(), "manual").output;
  for (const char* const command :
       {"lab", "rve", "multiscale", "specimen", "contact", "report", "parameters", "new", "help"})
    EXPECT_NE(page.find(fmt::format("\n.SS {}\n", command)), std::string::npos) << command;
  std::string names = run_feldspar(folder.path(), "parameters").output;
  const std::size_t further = names.find("\nFURTHER ENTRIES\n");
  ASSERT_NE(further, std::string::npos);
  std::size_t n_entries = 0;
  std::size_t n_basic = 0;
  for (std::size_t at = 0; (at = names.find("\n  ", at)) != std::string::npos; ++at)
    if (names[at + 3] != ' ')
      {
        n_basic += at < further;
        std::string entry = names.substr(at + 3, names.find('\n', at + 3) - at - 3);
        EXPECT_NE(page.find("\\fB" + entry + "\\fR\n"), std::string::npos) << entry;
        ++n_entries;
      }
  EXPECT_GT(n_entries, 100u);
  EXPECT_GT(n_basic, 50u);
  EXPECT_LT(n_basic, 70u);
  for (std::size_t at = 0; (at = page.find("\n.", at)) != std::string::npos; ++at)
    EXPECT_TRUE(std::isupper(page[at + 2])) << page.substr(at, 80); // TH, SH, SS, TP, PP, EX, EE

  folder.write("complete", R"bash(eval "$("$@")"
tell() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _feldspar; echo "${COMPREPLY[@]}"; }
tell feldspar la
tell feldspar help multi
tell feldspar lab --res
tell feldspar rve --ext
tell feldspar multiscale --ext
tell feldspar parameters Flat
tell feldspar lab --set 'Flat\ joint/Fri'
tell feldspar lab --set '"Specimen/Wi'
)bash");
  EXPECT_EQ(run_feldspar(folder.path(), "completion", "bash ./complete").output,
            "lab\nmultiscale\n--resume\n\n--extract\nFlat\\ joint\nFlat\\ joint/Friction\\ =\\ \nSpecimen/Width = \n");
}

TEST(Lab, SpeaksToWhoeverListens)
{
  // A reader that leaves costs neither the run nor its mark of completeness.
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 8 mm\n  set Height = 12 mm\nend\n"
                           "subsection Tests\n  set List = direct_tension\nend\n");
  folder.write("to_nobody", "\"$@\" | true\n");
  ASSERT_EQ(run_feldspar(folder.path(), "lab rock.prm --output out", "sh ./to_nobody").exit_code, 0);
  EXPECT_TRUE(nlohmann::json::parse(content(folder.path() / "out/run.json"))["complete"].get<bool>());
}

TEST(Lab, EndsEvenWhereNothingBreaks)
{
  // Slit joints have no bonds to break: nothing is pulled, which is said before the test.
  const TemporaryFolder folder;
  folder.write("rock.prm", "subsection Specimen\n  set Width = 8 mm\n  set Height = 12 mm\nend\n"
                           "subsection Flat joint\n  set Slit fraction = 1\nend\n"
                           "subsection Tests\n  set List = direct_tension\n  set Tension strain rate = 20 1/s\nend\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "timeout 60");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.error.find("no bonds lead from one grip to the other"), std::string::npos) << outcome.error;
}

TEST(Lab, RefusesAResumeOfWhatIsNoRun)
{
  const TemporaryFolder folder;
  for (const char* arguments : {"lab --resume .", "lab --resume missing", "lab"})
    {
      const auto outcome = run_feldspar(folder.path(), arguments);
      EXPECT_EQ(outcome.exit_code, 2) << arguments;
      EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    }
}

TEST(Lab, EndsCleanlyOnInterruptDuringGenesis)
{
  const TemporaryFolder folder;
  // Packing by motion takes seconds for a thousand grains to come to rest; the test is over at once.
  folder.write(
    "rock.prm",
    "subsection Specimen\n  set Width = 35 mm\n  set Height = 70 mm\n  set Packing relaxation = dynamics\nend\nsubsection Tests\n  set List = direct_tension\n  set Stop strain = 1e-5\nend\n");
  folder.write("interrupt", "\"$@\" &\n"
                            "until [ -e out/run.json ]; do sleep 0.02; done\n"
                            "sleep 0.1\nkill -INT $!\nwait $!\n");
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet", "sh ./interrupt");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar lab --resume out\n");
  EXPECT_FALSE(fs::exists(folder.path() / "out/specimen.h5"));
  EXPECT_FALSE(fs::exists(folder.path() / "out/summary.json"));
  const auto resumed = run_without_pictures(folder.path(), "lab --resume out --quiet");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.error;
  ASSERT_EQ(run_without_pictures(folder.path(), "lab rock.prm --output whole --quiet").exit_code, 0);
  EXPECT_EQ(without_times(summary(folder.path() / "whole")), without_times(summary(folder.path() / "out")));
}

TEST(Lab, EndsCleanlyOnInterrupt)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  // Genesis takes well under a second, the test at this rate minutes.
  folder.write("large.prm", "subsection Specimen\n  set Width = 20 mm\n  set Height = 40 mm\nend\n"
                            "subsection Tests\n  set List = uniaxial_compression\n"
                            "  set Compression strain rate = 0.01 1/s\nend\n");
  const auto outcome =
    run_feldspar(folder.path(), "lab large.prm", "timeout --foreground --signal=INT --preserve-status 8");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.error.find("interrupted"), std::string::npos) << outcome.error;
  const auto json = summary(folder.path() / "large-results-001");
  ASSERT_EQ(json["tests"].size(), 1u);
  EXPECT_EQ(json["tests"][0]["interrupted"], true);
  EXPECT_EQ(json["tests"][0]["peak_stress_Pa_reason"], "interrupted before its end");
  EXPECT_NE(outcome.error.find("feldspar lab --resume large-results-001"), std::string::npos) << outcome.error;
}
} // namespace
} // namespace feldspar::tests
