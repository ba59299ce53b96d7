// The laboratory as a user runs it, on small specimens.

#include "base/table/csv.h"
#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

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
const std::string small_rock = section("Specimen", "Width = 20 mm", "Height = 40 mm") +
                               section("Tests", "Stop stress over peak = 0.7") + section("Seeds", "Seeds = 3, 4");

/// Some ninety grains.
const std::string small_tension =
  section("Specimen", "Width = 12 mm", "Height = 24 mm") + section("Tests", "List = direct_tension");

/// Removes all that depends on the machine and not on the physics.
Json without_times(Json json)
{
  json.erase("host");
  json.erase("ensemble");
  for (auto& test : json["tests"])
    test.erase("wall_time_s");
  return json;
}

TEST(Lab, WritesWhatItPromisesWithTheSameBitsForAnyNumberOfThreadsAndAnyLocale)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  const auto outcome = run_to_end(folder, "lab rock.prm --threads 1", with_pictures);
  // Progress goes to standard error, in lines that fit a page, and begins with the size of the work.
  EXPECT_EQ(outcome.error.find("genesis of 2 specimens, some "), 0u) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "tests: 4 of 4 done ("));
  std::istringstream lines(outcome.error);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), 80u) << line;
  EXPECT_EQ(outcome.output.find("4 of 4 done"), std::string::npos) << outcome.output;
  EXPECT_TRUE(has_words(outcome.output, "How far to trust it: "));
  const fs::path results = folder / "rock-results-001";
  for (const char* file :
       {"summary.json", "cracks.csv", "log.txt", "specimen_seed_3.h5", "specimen_seed_4.h5",
        "curves/direct_tension_seed_3.csv", "curves/uniaxial_compression_seed_4.csv",
        "figures/direct_tension_seed_3_stress_strain.png", "figures/direct_tension_seed_3_stress_strain.svg",
        "figures/uniaxial_compression_seed_4_cracks.png"})
    EXPECT_GT(fs::file_size(results / file), 100u) << file;
  // The last line names the page; with --quiet the folder, for scripts.
  EXPECT_TRUE(outcome.output.ends_with("\nrock-results-001/report.html\n")) << outcome.output;

  const auto json = summary_of(results);
  EXPECT_EQ(json["schema_version"], 2);
  EXPECT_EQ(json["input"]["parameters"]["Specimen"]["Width"], "20 mm");
  ASSERT_EQ(json["tests"].size(), 4u);
  const auto& test = json["tests"][0];
  EXPECT_EQ(test["kind"], "direct_tension");
  EXPECT_EQ(test["seed"], 3);
  for (const std::string& key :
       words_of("confining_pressure_Pa peak_stress_Pa strain_at_peak youngs_modulus_initial_Pa "
                "youngs_modulus_tangent_Pa youngs_modulus_secant_Pa poissons_ratio_initial poissons_ratio_secant "
                "crack_initiation_stress_Pa n_tension_cracks n_shear_cracks n_tension_cracks_at_peak "
                "n_shear_cracks_at_peak n_grains n_joints coordination_number coordination_number_core "
                "installation_gap_ratio porosity energy_imbalance kinetic_to_strain_energy steps wall_time_s"))
    EXPECT_TRUE(test.contains(key) && (test[key].is_number() || test.contains(key + "_reason"))) << key;
  EXPECT_TRUE(test["servo_error"].is_null());
  EXPECT_FALSE(test["servo_error_reason"].get<std::string>().empty());
  EXPECT_EQ(json["ensemble"]["direct_tension"]["peak_stress_Pa"]["n"], 2);

  // Cracks are counted once: in the summary and row by row.
  std::size_t n_cracks = 0;
  for (const auto& one : json["tests"])
    n_cracks += one["n_tension_cracks"].get<std::size_t>() + one["n_shear_cracks"].get<std::size_t>();
  EXPECT_EQ(n_lines(content(results / "cracks.csv")), n_cracks + 1);

  // A second run goes beside the first. It has the same bits for any number of threads and any locale.
  make_german_locale(folder);
  run_to_end(folder, "lab rock.prm --quiet --threads 2",
             path_without_pictures() + " LOCPATH=" + folder.path().string() + " LC_ALL=de_DE.UTF-8");
  EXPECT_EQ(without_times(summary_of(folder / "rock-results-002")), without_times(json));
  expect_same_files(
    results, folder / "rock-results-002",
    {"cracks.csv", "emission.csv", "curves/direct_tension_seed_3.csv", "curves/uniaxial_compression_seed_4.csv"});
}

TEST(Lab, TestsASpecimenMadeBefore)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_tension);
  folder.write("again.prm", small_tension + section("Specimen", "Specimen file = fresh/specimen.h5"));
  run_to_end(folder, "lab rock.prm --output fresh --quiet");
  const auto again = run_to_end(folder, "lab again.prm --output again");
  EXPECT_EQ(content(folder / "fresh/cracks.csv"), content(folder / "again/cracks.csv"));
  // The file has its grains and joints, whatever else the input says of them.
  EXPECT_TRUE(
    has_words(again.error, "the specimen is that of fresh/specimen.h5", "have no effect on it: Specimen/Width"));
}

// Out to the forms of other codes and in again, to the last bit, with the joints that the list of bonds names.
TEST(Lab, WritesPackingsThatItReadsAgain)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_rock);
  const auto made = run_to_end(folder, "specimen rock.prm --packing yade --packing lammps --output made --quiet");
  EXPECT_TRUE(has_words(made.output, "made/packings/specimen_seed_4.data\n"));
  for (const char* const name : {"specimen_seed_3.txt", "specimen_seed_3.data"})
    {
      const auto again = run_to_end(
        folder.path(), fmt::format("specimen rock.prm --set 'Specimen/Packing file = made/packings/{}' --set "
                                   "'Seeds/Seeds = 3' --packing yade --packing lammps --output again --force --quiet",
                                   name));
      for (const char* const ending : {".txt", ".data"})
        EXPECT_TRUE(content(folder / fmt::format("again/packings/specimen{}", ending)) ==
                    content(folder / fmt::format("made/packings/specimen_seed_3{}", ending)))
          << name << " " << ending;
    }
  EXPECT_EQ(run_feldspar(folder, "specimen rock.prm --packing pfc --output none").exit_code, 2);
}

TEST(Lab, RefusesWhatItCannotDoAndLeavesNothing)
{
  const TemporaryFolder folder;
  folder.write("broken.h5", "no specimen");
  folder.write("packing.txt", "0.01 0.01 0.001\n0.011 0.01 0.001\n");
  folder.write("stages.csv", "axial_strain\n1e-3\n");
  const auto refused = [&](const std::vector<std::string>& commands, const std::string& input,
                           const std::string& words) {
    folder.write("rock.prm", input);
    for (const std::string& command : commands)
      expect_refused(folder, command, words);
  };
  const std::vector<std::string> makes{"lab rock.prm --quiet", "specimen rock.prm --quiet"};
  const std::string one = section("Specimen", "Width = 20 mm", "Height = 40 mm") + section("Seeds", "Seeds = 3");
  const std::string two = replaced(one, "3", "3, 4");
  refused(makes, two + section("Flat joint", "Coordination number = 9"), "this packing allows");
  refused(makes, two + section("Flat joint", "Coordination number = 1"), "this packing allows");
  refused(makes, two + section("Specimen", "Specimen file = broken.h5"), "is one specimen; it goes with one seed");
  refused(makes, one + section("Specimen", "Specimen file = broken.h5"), "broken.h5: not an HDF5 file");
  refused(makes, one + section("Specimen", "Packing file = packing.txt"), "packing.txt:2: overlaps");

  // A surrounding that a specimen cannot have, and loads that do not fit the body, the tests or each other.
  const std::vector<std::string> loads{"lab rock.prm", "parameters --check rock.prm --for lab"};
  const std::string tests = "feldspar: rock.prm: Tests/";
  refused(loads, section("Tests", "Intermediate stress = 30 MPa"),
          tests + "Intermediate stress = 30 MPa: presses on two sides of a box of grains in space");
  refused(loads, section("Tests", "Brazilian length ratio = 0.3"),
          tests + "Brazilian length ratio = 0.3: is the length of a disc in space");
  refused(loads,
          section("Specimen", "Dimension = 3") +
            section("Tests", "List = triaxial_compression", "Intermediate stress = 30 MPa", "Confinements = 40 MPa"),
          tests + "Intermediate stress = 30 MPa: must be at least the least stress, and Confinements has 40 MPa");
  refused(loads, section("Tests", "Gravity = -9.81 m/s^2"), "must be none, or have a component for each axis");
  refused(loads, section("Tests", "Gravity = 0, 0, -9.81 m/s^2"),
          "Tests/Gravity = 0, 0, -9.81 m/s^2: must have 2 components");
  refused(loads, section("Tests", "List = tilt", "Platen friction = 0.3"),
          "Tests/Gravity: the weight presses the body of tilt");
  refused(loads, section("Tests", "List = tilt", "Gravity = 0, -9.81 m/s^2"),
          "Tests/Platen friction = 0: must lie in (0, 0.25]");
  refused(loads, section("Tests", "Compression loading rate = 0.7 MPa"), "a rate > 0 of stress, force or travel");
  refused(loads, section("Tests", "Compression loading rate = 0.7 MPa/s", "Machine stiffness = 500 kN/mm"),
          "Tests/Compression loading rate = 0.7 MPa/s: a machine that raises its force has no stiffness");
  refused(loads, section("Tests", "List = own_loading", "Loading table = stages.csv", "Machine stiffness = 500 kN/mm"),
          "Tests/Machine stiffness: own_loading follows its table");
  folder.write("rock.prm", section("Specimen", "Width = 12 mm", "Height = 24 mm") +
                             section("Tests", "List = triaxial_compression", "Confinements = 40 GPa"));
  expect_refused(folder, "lab rock.prm --quiet", "Tests/Confinements: the walls cannot hold 40000 MPa");
  // Slit joints have no bonds to break: nothing is pulled.
  folder.write("rock.prm", section("Specimen", "Width = 8 mm", "Height = 12 mm") +
                             section("Flat joint", "Slit fraction = 1") +
                             section("Tests", "List = direct_tension", "Tension strain rate = 20 1/s"));
  expect_refused(folder, "lab rock.prm --quiet", "no bonds lead from one grip to the other");
  for (const char* const of_no_run : {"lab --resume .", "lab --resume missing", "lab"})
    expect_refused(folder, of_no_run, "");
}

TEST(Lab, TellsEntriesThatNoneOfItsTestsTakes)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Tests", "List = direct_tension", "Lateral boundary = membrane",
                                   "Compression loading rate = 0.7 MPa/s", "Platen friction = 0.3",
                                   "Seating transits = 5", "Confinements = 7 MPa", "Gravity = 0, -9.81 m/s^2"));
  const auto check = run_to_end(folder, "parameters --check rock.prm --for lab");
  EXPECT_TRUE(has_words(
    check.output,
    "Tests/Lateral boundary has no effect: it is of triaxial_compression, and Tests/List has direct_tension",
    "Tests/Compression loading rate has no effect: it is of uniaxial_compression, triaxial_compression, and",
    "Tests/Platen friction has no effect: it is of uniaxial_compression, triaxial_compression, own_loading, tilt, and",
    "Tests/Seating transits has no effect: it is of triaxial_compression, direct_shear, own_loading, tilt, and",
    "Tests/Confinements has no effect: it is of triaxial_compression, direct_shear, and"));
  EXPECT_EQ(n_lines(check.output), 6u) << check.output; // gravity acts in every test
}

TEST(Lab, TellsTheRateOfTheLaboratoryBesideItsOwn)
{
  // 0.1 mm/min on 24 mm are 6.94e-5 1/s; at 2/s the loading to a strain of 1e-3 is 28 800 times as fast.
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 12 mm", "Height = 24 mm") +
                             section("Tests", "List = uniaxial_compression", "Stop strain = 1e-3",
                                     "Compression strain rate = 2 1/s", "Compression loading rate = 0.1 mm/min"));
  run_to_end(folder, "lab rock.prm --output out");
  const auto test = summary_of(folder / "out")["tests"][0];
  EXPECT_NEAR(test["rate_over_laboratory"].get<double>(), 28800.0, 1.0);
  EXPECT_GT(test["steps_at_laboratory_rate"].get<double>(), 28800.0 * 1000.0);
  EXPECT_TRUE(test["stress_rate_Pa_per_s"].is_null());
  std::string words = content(folder / "out/log.txt");
  std::replace(words.begin(), words.end(), '\n', ' ');
  for (const std::string& text : {words, content(folder / "out/report.html")})
    EXPECT_TRUE(has_words(text, "The rate of the laboratory is 6.94e-05 1/s, that of the run 2 1/s"));
}

/// Some ninety grains; the programme takes a few seconds.
const std::string tiny_rock =
  section("Specimen", "Width = 12 mm", "Height = 24 mm") +
  section("Tests", "List = direct_tension, triaxial_compression", "Confinements = 10, 30 MPa",
          "Stop stress over peak = 0.9", "Steps between checkpoints = 4000");

TEST(Lab, KilledTenTimesAndResumedGivesTheBitsOfTheUnbrokenRun)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", replaced(tiny_rock, "checkpoints = 4000", "checkpoints = 1000"));
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  std::mt19937 random(7); // the moments need not be the same in every run: the bits must be
  const auto complete = [&] { return content(folder / "broken/run.json").find("true") != std::string::npos; };
  run_until(folder, "lab rock.prm --output broken --quiet", "test -e broken/run.json", "kill -KILL $!");
  ASSERT_TRUE(fs::exists(folder / "broken/run.json"));
  int n_kills = 1;
  for (; n_kills < 10 && !complete(); ++n_kills)
    run_feldspar(folder, "lab --resume broken --quiet",
                 fmt::format("timeout --foreground --signal=KILL {}", 0.3 + 0.05 * double(random() % 10)));
  EXPECT_GE(n_kills, 3);
  run_to_end(folder, "lab --resume broken --quiet");
  EXPECT_EQ(without_times(summary_of(folder / "whole")), without_times(summary_of(folder / "broken")));
  expect_same_files(folder / "whole", folder / "broken",
                    {"cracks.csv", "emission.csv", "curves/direct_tension_seed_1.csv",
                     "grains/direct_tension_seed_1.csv", "curves/triaxial_compression_30_MPa_seed_1.csv"});
  EXPECT_FALSE(fs::exists(folder / "broken/checkpoints"));
  EXPECT_TRUE(fs::exists(folder / "broken/report.html"));
  for (const std::string& name : names_in(folder / "broken"))
    EXPECT_FALSE(name.ends_with(".unfinished")) << name;
}

// Resumed, it names the file from the root; the checkpoint is of the same input none the less.
TEST(Lab, AKilledRunWithAFileBesideItsInputIsTakenUpFromItsCheckpoint)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock + section("Report", "Reference file = reference.json"));
  folder.write("reference.json", R"({"experiment": {"tensile_strength_MPa": 9}})");
  run_until(folder, "lab rock.prm --output broken --quiet", "ls broken/checkpoints/*.h5 >/dev/null 2>&1",
            "kill -KILL $!");
  ASSERT_FALSE(fs::is_empty(folder / "broken/checkpoints"));
  const auto resumed = run_to_end(folder, "lab --resume broken --quiet");
  EXPECT_EQ(resumed.error.find("going back"), std::string::npos) << resumed.error;
  const auto input = summary_of(folder / "broken")["input"];
  EXPECT_EQ(input["parameters"]["Report"]["Reference file"], "reference.json") << "as the input names it";
}

TEST(Lab, ATornOrForeignCheckpointIsRefusedAndTheOneBeforeItUsed)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", tiny_rock);
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  const fs::path checkpoints = folder / "broken/checkpoints";
  const fs::path torn = checkpoints / "triaxial_compression_30_MPa_seed_1.h5";
  const fs::path before = checkpoints / "triaxial_compression_30_MPa_seed_1.previous.h5";
  const fs::path foreign = checkpoints / "triaxial_compression_10_MPa_seed_1.h5";
  // Killed once there are two checkpoints of one test and one of another, and before they are gone again; both tests have
  // a while together.
  for (int tries = 0; tries < 5 && !(fs::exists(torn) && fs::exists(before) && fs::exists(foreign)); ++tries)
    run_until(folder, "lab rock.prm --output broken --force --quiet",
              fmt::format("test -e {} -a -e {} -a -e {}", torn.string(), before.string(), foreign.string()),
              "kill -KILL $!");
  ASSERT_TRUE(fs::exists(torn) && fs::exists(before) && fs::exists(foreign));
  fs::copy_file(torn, foreign, fs::copy_options::overwrite_existing);
  fs::resize_file(torn, fs::file_size(torn) / 2);
  const auto outcome = run_to_end(folder, "lab --resume broken --quiet");
  EXPECT_TRUE(has_words(outcome.error, "30_MPa_seed_1.h5: damaged or cut short",
                        "going back to the checkpoint before it", "10_MPa_seed_1.h5: of another test"));
  EXPECT_EQ(without_times(summary_of(folder / "whole")), without_times(summary_of(folder / "broken")));
}

TEST(Lab, TestsACylinderInThreeDimensions)
{
  // Some sixty spheres; what is asked is that every part of a run takes them.
  const TemporaryFolder folder;
  folder.write(
    "rock.prm",
    section("Specimen", "Dimension = 3", "Shape = cylinder", "Width = 6 mm", "Height = 8 mm", "Porosity = 0.42") +
      section("Tests", "List = direct_tension, triaxial_compression, brazilian", "Confinements = 10 MPa",
              "Lateral boundary = membrane", "Brazilian length ratio = 0.8", "Compression strain rate = 8 1/s",
              "Tension strain rate = 2 1/s", "Brazilian strain rate = 2 1/s", "Compression sampling strain = 1e-4",
              "Stop strain over peak strain = 1.1"));
  run_to_end(folder, "specimen rock.prm --output made --quiet");
  EXPECT_TRUE(fs::exists(folder / "made/specimen.h5"));
  run_to_end(folder, "lab rock.prm --output out --quiet", with_pictures);
  const fs::path out = folder / "out";
  const auto json = summary_of(out);
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
  fs::create_directory(folder / "bin");
  fs::create_symlink("/usr/bin/gnuplot", folder / "bin/gnuplot");
  run_to_end(folder, "report out", "PATH='" + (folder / "bin").string() + "'");
  expect_pictures({"direct_tension_seed_1_stress_strain"});
  for (const std::string of_body : {"cracks", "fragments"})
    EXPECT_FALSE(fs::exists(out / "figures" / ("direct_tension_seed_1_" + of_body + ".png"))) << of_body;
  const std::string page = content(out / "report.html");
  EXPECT_TRUE(has_words(page, "<noscript><p class=\"absent\""));
  EXPECT_EQ(page.find("\n<p class=\"absent\""), std::string::npos);
  // A box by three stresses.
  folder.write("box.prm", section("Specimen", "Dimension = 3", "Width = 6 mm", "Height = 8 mm", "Porosity = 0.42") +
                            section("Tests", "List = triaxial_compression", "Confinements = 5 MPa",
                                    "Intermediate stress = 15 MPa", "Stop strain = 1e-3",
                                    "Compression strain rate = 8 1/s", "Compression sampling strain = 1e-4") +
                            section("Variants", "Entry = Tests/Lateral boundary", "Values = wall; membrane"));
  run_to_end(folder, "lab box.prm --output box --quiet");
}

TEST(Lab, HoldsABodyInThePlaneByAMembrane)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 12 mm", "Height = 24 mm") +
                             section("Flaws", "Shapes = closed flaw from 0, 4 mm to 12, 20 mm smooth") +
                             section("Tests", "List = triaxial_compression", "Confinements = 10 MPa",
                                     "Stop strain = 2e-3", "Compression strain rate = 4 1/s") +
                             section("Variants", "Entry = Tests/Lateral boundary", "Values = wall; membrane"));
  run_to_end(folder, "lab rock.prm --output out --quiet");
  const auto json = summary_of(folder / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["servo_error"].is_number());
  EXPECT_TRUE(json["tests"][1]["servo_error"].is_null());
  EXPECT_LT(json["tests"][1]["energy_imbalance"].get<double>(), 0.01);
  // Rigid plates hold a plane through the body by more than the confinement; the remark advises the membrane.
  const std::string page = content(folder / "out/report.html");
  EXPECT_TRUE(has_words(page, "Tests/Lateral boundary = membrane has no such error"));
}

TEST(Lab, RunsVariantsOfOneEntry)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", small_tension + section("Variants", "Entry = Flat joint/Bond tensile strength",
                                                   "Values = 22 MPa; 44 MPa"));
  run_to_end(folder, "lab rock.prm --output out --quiet");
  const auto json = summary_of(folder / "out");
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
  EXPECT_TRUE(fs::exists(folder / "out/curves/direct_tension_bond_tensile_strength_22_MPa_seed_1.csv"));
  CsvReader table(folder / "out/tests.csv");
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
  EXPECT_TRUE(content(folder / "out/tables/comparison.csv")
                .starts_with("source,kind,Flat joint/Bond tensile strength [MPa],property,unit,mean,"));

  // A folder of before values were in names is resumed by its own names.
  auto record = read_json(folder / "out/run.json");
  record.erase("variants_named");
  record["complete"] = false;
  folder.write("out/run.json", record.dump());
  run_to_end(folder, "lab --resume out --quiet");
  const auto old = summary_of(folder / "out");
  EXPECT_EQ(old["tests"][1]["name"], "direct_tension_variant_2_seed_1");
  EXPECT_EQ(old["tests"][1]["peak_stress_Pa"], json["tests"][1]["peak_stress_Pa"]);
}

// A core is tested like any specimen, to the same bits for any number of threads; what it is stands in the results, in
// the log and on the page. Beside results on a body of another gap the log says so.
TEST(Lab, TestsCoresAndSaysWhatTheyAre)
{
  const TemporaryFolder folder;
  const std::string core =
    small_tension + section("Specimen", "Coring = free sides") + section("Tests", "Tension strain rate = 1 1/s");
  folder.write("wide.prm", core + section("Flat joint", "Installation gap ratio = 0.05"));
  folder.write("narrow.prm", core + section("Flat joint", "Installation gap ratio = 0.01") +
                               section("Report", "Reference results = one/summary.json"));
  run_to_end(folder, "lab wide.prm --output one --quiet --threads 1");
  run_to_end(folder, "lab wide.prm --output two --quiet --threads 2");
  EXPECT_EQ(content(folder / "one/curves/direct_tension_seed_1.csv"),
            content(folder / "two/curves/direct_tension_seed_1.csv"));
  const auto test = summary_of(folder / "one")["tests"][0];
  EXPECT_GT(test["n_cut_joints"].get<int>(), 10);
  EXPECT_GT(test["peak_stress_Pa"].get<double>(), 3e6);
  EXPECT_TRUE(has_words(content(folder / "one/log.txt"), "cored: joints cut / grains removed"));
  EXPECT_TRUE(has_words(content(folder / "one/report.html"), "Cored: packed without walls"));

  run_to_end(folder, "lab narrow.prm --output narrow --quiet");
  const std::string log = content(folder / "narrow/log.txt");
  EXPECT_TRUE(has_words(log, "this run: gap 0.0100 mean radii, coordination number ",
                        "reference one: gap 0.0500 mean radii", "this run and reference one are different rocks"));
  run_to_end(folder, "report one narrow --output both --quiet");
  EXPECT_TRUE(has_words(content(folder / "both/report.html"), "are different rocks"));

  for (const auto& [entry, words] :
       {std::pair("Specimen/Shape = periodic", "Specimen/Coring"), {"Specimen/Coring = none", "Specimen/Cells across"}})
    expect_refused(
      folder, fmt::format("specimen wide.prm --output bad --set 'Specimen/Cells across = 2' --set '{}'", entry), words);
}

TEST(Lab, VariantsOfTheTestsShareTheirSpecimens)
{
  // Variants differ in the rate: each seed is packed once, and is the specimen of a run without variants.
  const TemporaryFolder folder;
  const std::string rock = small_tension + section("Seeds", "Seeds = 3, 4");
  folder.write("one.prm", rock);
  folder.write("rates.prm",
               rock + section("Variants", "Entry = Tests/Tension strain rate", "Values = 0.164 1/s; 0.328 1/s"));
  run_to_end(folder, "lab one.prm --output one --quiet");
  run_to_end(folder, "lab rates.prm --output rates --quiet");
  std::vector<std::string> specimens;
  for (const auto& entry : fs::directory_iterator(folder / "rates"))
    if (const std::string name = entry.path().filename().string(); name.starts_with("specimen"))
      specimens.push_back(name);
  std::sort(specimens.begin(), specimens.end());
  EXPECT_EQ(specimens, (std::vector<std::string>{"specimen_seed_3.h5", "specimen_seed_4.h5"}));
  const auto one = summary_of(folder / "one");
  const auto rates = summary_of(folder / "rates");
  ASSERT_EQ(rates["tests"].size(), 4u);
  for (const std::size_t seed : {0, 1})
    {
      EXPECT_EQ(rates["tests"][seed]["peak_stress_Pa"], one["tests"][seed]["peak_stress_Pa"]);
      EXPECT_EQ(rates["tests"][seed + 2]["strain_rate_per_s"], 0.328);
    }
}

TEST(Lab, ForceStartsAnew)
{
  // Results that an earlier run left, of another strength here, are not taken for those of this one.
  const TemporaryFolder folder;
  folder.write("weak.prm", small_tension);
  folder.write("strong.prm", small_tension + section("Flat joint", "Bond tensile strength = 44 MPa"));
  run_to_end(folder, "lab strong.prm --output fresh --quiet");
  run_to_end(folder, "lab weak.prm --output used --quiet");
  expect_refused(folder, "lab strong.prm --output used --quiet", "used: is not empty");
  run_to_end(folder, "lab strong.prm --output used --force --quiet");
  EXPECT_EQ(content(folder / "fresh/cracks.csv"), content(folder / "used/cracks.csv"));
}

TEST(Lab, OneTestThatCannotBeMadeDoesNotCostTheOthers)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", replaced(tiny_rock, "10, 30 MPa", "10, 40000 MPa") + section("Seeds", "Seeds = 1, 2"));
  expect_mistake(folder, "lab rock.prm --output out --quiet",
                 "feldspar: triaxial_compression_40000_MPa_seed_1, triaxial_compression_40000_MPa_seed_2: "
                 "Tests/Confinements: the walls cannot hold 40000 MPa on this specimen; the other results are in "
                 "out\n");
  EXPECT_TRUE(has_words(content(folder / "out/log.txt"),
                        "on this specimen. The same holds for triaxial_compression_40000_MPa_seed_2."));
  const auto json = summary_of(folder / "out");
  ASSERT_EQ(json["tests"].size(), 6u);
  EXPECT_GT(json["tests"][1]["steps"], 0);
  EXPECT_TRUE(has_words(json["tests"][2]["peak_stress_Pa_reason"].get<std::string>(), "cannot hold"));
  // A run that is over says again how it ended.
  expect_mistake(folder, "lab --resume out --quiet", "the walls cannot hold 40000 MPa");
}

TEST(Lab, ATestWhoseNumbersGoWrongKeepsItsRowsAndDoesNotCostTheOthers)
{
  // The grips of this tension go more than a grain in a step.
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 8 mm", "Height = 12 mm") +
                             section("Tests", "List = uniaxial_compression, direct_tension",
                                     "Compression strain rate = 8 1/s", "Tension strain rate = 1e7 1/s"));
  const auto outcome = run_without_pictures(folder, "lab rock.prm --output out --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.error.find("feldspar: direct_tension_seed_1: numbers went wrong: grain "), 0u) << outcome.error;
  EXPECT_TRUE(has_words(outcome.error, "a lower rate would help"));
  EXPECT_EQ(n_lines(outcome.error), 1u) << outcome.error;
  const auto json = summary_of(folder / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["peak_stress_Pa"].is_number());
  EXPECT_TRUE(has_words(json["tests"][1]["failure"].get<std::string>(), " in step "));
  EXPECT_TRUE(has_words(json["tests"][1]["peak_stress_Pa_reason"].get<std::string>(), "numbers went wrong"));
  EXPECT_GE(content(folder / "out/curves/direct_tension_seed_1.csv").size(), 100u);
  EXPECT_TRUE(has_words(content(folder / "out/report.html"), "could not be finished: numbers went wrong"));
}

TEST(Lab, ObeysWithinASecondInALongRowAndInALongSeating)
{
  // A row of minutes; a seating of minutes.
  const TemporaryFolder folder;
  const std::string rock = section("Specimen", "Width = 8 mm", "Height = 12 mm");
  folder.write("row.prm", rock + section("Tests", "List = uniaxial_compression", "Compression strain rate = 1e-5 1/s"));
  folder.write("seating.prm", rock + section("Tests", "List = triaxial_compression", "Confinements = 10 MPa",
                                             "Seating transits = 1e4"));
  for (const auto& [name, signal] : {std::pair<std::string, std::string>{"row", "TERM"}, {"seating", "HUP"}})
    {
      const std::string out = name + signal;
      const auto outcome =
        run_until(folder, "lab " + name + ".prm --output " + out + " --quiet", "[ -e " + out + "/specimen.h5 ]",
                  "sleep 0.5\nkill -" + signal + " $!\nsleep 1\nkill -KILL $! 2> no-process");
      EXPECT_EQ(outcome.exit_code, 130) << out << ": " << outcome.error;
      EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar lab --resume " + out + "\n");
      EXPECT_EQ(fs::exists(folder / out / "checkpoints/uniaxial_compression_seed_1.h5"), name == "row");
    }
}

TEST(Lab, ATestThatCannotEvenBeSetUpDoesNotCostTheOthers)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 8 mm", "Height = 12 mm") +
                             section("Tests", "List = uniaxial_compression, direct_tension", "Grip ratio = 0.001"));
  expect_mistake(folder, "lab rock.prm --output out --quiet", "grip");
  const auto json = summary_of(folder / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  EXPECT_TRUE(json["tests"][0]["peak_stress_Pa"].is_number());
  EXPECT_TRUE(has_words(json["tests"][1]["peak_stress_Pa_reason"].get<std::string>(), "grip"));
}

TEST(Lab, MeasuresADiscByItsOwnSize)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 20 mm", "Height = 30 mm", "Packing relaxation = dynamics") +
                             section("Tests", "List = brazilian") + section("Seeds", "Seeds = 1, 2"));
  // Packed by motion, the disc of the first seed has no grain near its poles: its pads are those of the outermost ones.
  run_to_end(folder, "lab rock.prm --output out --quiet");
  const auto json = summary_of(folder / "out");
  ASSERT_EQ(json["tests"].size(), 2u);
  for (const auto& test : json["tests"])
    {
      EXPECT_TRUE(test["peak_stress_Pa"].is_number()) << test["name"];
      EXPECT_EQ(test["size_m"], Json({0.02, 0.02, 0})) << test["name"];
    }
  // Grains of the disc lie in a circle of 10 mm about the middle of this size.
  const auto grains = read_columns(folder / "out/grains/brazilian_seed_2.csv");
  const auto &x = grains.at("start_x_m"), &y = grains.at("start_y_m");
  for (std::size_t k = 0; k < x.size(); ++k)
    EXPECT_LE(std::hypot(x[k] - 0.01, y[k] - 0.01), 0.01) << k;
}

TEST(Lab, TakesEntriesOfTheCommandLineAndKeepsThemForAResume)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Specimen", "Width = 12 mm", "Height = 24 mm"));
  const std::string lab = "lab rock.prm --output out --set 'Tests/List = direct_tension' --set 'Specimen/Width = 8 mm' "
                          "--set 'Specimen/Height = 12 mm' ";
  run_to_end(folder, lab + "--quiet");
  auto json = summary_of(folder / "out");
  EXPECT_EQ(json["tests"].size(), 1u);
  EXPECT_EQ(json["input"]["parameters"]["Specimen"]["Width"], "8 mm");
  // A resumed run still has them.
  auto record = read_json(folder / "out/run.json");
  record["complete"] = false;
  folder.write("out/run.json", record.dump());
  run_to_end(folder, "lab --resume out --quiet");
  EXPECT_EQ(without_times(summary_of(folder / "out")), without_times(json));
  // One digit of them would go on as another specimen.
  record = read_json(folder / "out/run.json");
  record["complete"] = false;
  record["settings"][1] = "Specimen/Width = 9 mm";
  folder.write("out/run.json", record.dump());
  expect_refused(folder, "lab --resume out --quiet",
                 "feldspar: out: run.json in it is not as the run wrote it; undo the change, or begin another run\n");
  EXPECT_EQ(without_times(summary_of(folder / "out")), without_times(json));

  const auto refused = [&](const std::string& setting, const std::string& words) {
    expect_refused(folder, "lab rock.prm --set '" + setting + "'", "feldspar: --set" + words);
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
      const auto made = run_to_end(folder, "new " + name + " --output mine");
      const std::string command = name == "sample" ? "multiscale" : "lab";
      EXPECT_TRUE(has_words(made.output, "Next: feldspar " + command + " mine/" + name + ".prm"));
      const std::string text = content(folder / "mine" / (name + ".prm"));
      EXPECT_LT(n_lines(text), 200u) << "of a first year";
      EXPECT_TRUE(has_words(text, "\n  set Reference file = " + name + "-reference.json\n"));
      // Every line that is a comment would be read, too.
      const std::string all = std::regex_replace(text, std::regex("# set "), "set ");
      folder.write("mine/all.prm", all);
      for (const std::string& input : {name, std::string("all")})
        run_to_end(folder, "parameters --check mine/" + input + ".prm --for " + command);
      run_to_end(folder, command + " mine/" + name + ".prm --output " + name + " --quiet");
      EXPECT_TRUE(std::filesystem::exists(folder / name / "summary.json"));
    }

  // Neither file is written over, nor one of them made anew.
  folder.write("mine/study-reference.json", "mine");
  std::filesystem::remove(folder / "mine/study.prm");
  expect_refused(folder, "new study --output mine",
                 "feldspar: mine/study-reference.json: is there already; name another folder by --output\n");
  EXPECT_EQ(content(folder / "mine/study-reference.json"), "mine");
  expect_refused(folder, "new stone", "");
}

TEST(Help, IsThereByTheWordsThatUsersTry)
{
  const TemporaryFolder folder;
  const auto said = [&](const std::string& arguments) { return run_to_end(folder, arguments).output; };
  EXPECT_EQ(said("help"), said("--help"));
  EXPECT_EQ(said("help lab"), said("lab --help"));
  EXPECT_TRUE(has_words(said("help lab"), "Examples:\n  feldspar lab granite.prm"));
  EXPECT_EQ(said("version"), said("--version"));
  EXPECT_TRUE(has_words(said("parameters PLATEN"), "Tests/Platen friction\n    unit -; default 0"));
}

// The manual page has every command and every entry, and man makes no request of a line of text. The completion is asked as
// bash asks it.
TEST(Help, IsThereForManAndBash)
{
  const TemporaryFolder folder;
  const std::string page = run_feldspar(folder, "manual").output;
  for (const char* const command :
       {"lab", "rve", "multiscale", "specimen", "contact", "report", "parameters", "new", "help"})
    EXPECT_TRUE(has_words(page, fmt::format("\n.SS {}\n", command))) << command;
  std::string names = run_feldspar(folder, "parameters").output;
  const std::size_t further = names.find("\nFURTHER ENTRIES\n");
  ASSERT_NE(further, std::string::npos);
  std::size_t n_entries = 0;
  std::size_t n_basic = 0;
  for (std::size_t at = 0; (at = names.find("\n  ", at)) != std::string::npos; ++at)
    if (names[at + 3] != ' ')
      {
        n_basic += at < further;
        std::string entry = names.substr(at + 3, names.find('\n', at + 3) - at - 3);
        EXPECT_TRUE(has_words(page, "\\fB" + entry + "\\fR\n")) << entry;
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
  EXPECT_EQ(run_feldspar(folder, "completion", "bash ./complete").output,
            "lab\nmultiscale\n--resume\n\n--extract\nFlat\\ joint\nFlat\\ joint/Friction\\ =\\ \nSpecimen/Width = \n");
}

TEST(Lab, EndsCleanlyOnInterruptDuringGenesis)
{
  const TemporaryFolder folder;
  // Packing by motion takes seconds for a thousand grains to come to rest; the test is over at once.
  folder.write("rock.prm", section("Specimen", "Width = 35 mm", "Height = 70 mm", "Packing relaxation = dynamics") +
                             section("Tests", "List = direct_tension", "Stop strain = 1e-5"));
  const auto outcome =
    run_until(folder, "lab rock.prm --output out --quiet", "[ -e out/run.json ]", "sleep 0.1\nkill -INT $!");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.error, "feldspar: interrupted; go on with: feldspar lab --resume out\n");
  EXPECT_FALSE(fs::exists(folder / "out/specimen.h5"));
  EXPECT_FALSE(fs::exists(folder / "out/summary.json"));
  run_to_end(folder, "lab --resume out --quiet");
  run_to_end(folder, "lab rock.prm --output whole --quiet");
  EXPECT_EQ(without_times(summary_of(folder / "whole")), without_times(summary_of(folder / "out")));
}

TEST(Lab, EndsCleanlyOnInterrupt)
{
  const TemporaryFolder folder;
  // The test takes minutes at this rate.
  folder.write("large.prm", section("Specimen", "Width = 20 mm", "Height = 40 mm") +
                              section("Tests", "List = uniaxial_compression", "Compression strain rate = 0.01 1/s"));
  const auto outcome =
    run_until(folder, "lab large.prm", "[ -e large-results-001/specimen.h5 ]", "sleep 0.5\nkill -INT $!");
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_TRUE(has_words(outcome.error, "interrupted"));
  const auto json = summary_of(folder / "large-results-001");
  ASSERT_EQ(json["tests"].size(), 1u);
  EXPECT_EQ(json["tests"][0]["interrupted"], true);
  EXPECT_EQ(json["tests"][0]["peak_stress_Pa_reason"], "interrupted before its end");
  EXPECT_TRUE(has_words(outcome.error, "feldspar lab --resume large-results-001"));
}
} // namespace
} // namespace feldspar::tests
