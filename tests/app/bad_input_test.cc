#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// A user's mistake: one line on standard error that says where and what, exit code 2, and nothing written.
namespace feldspar::tests
{
namespace
{
/// The line begins with this after `feldspar: `.
void expect_line(const TemporaryFolder& folder, const std::string& arguments, const std::string& start)
{
  expect_refused(folder, arguments, "feldspar: " + start);
}

constexpr std::string_view good_path = "normal_m,shear_m,rotation_rad\n0,0,0\n-1e-6,0,0\n";

/// A contact input that would run, but for the text added.
std::string contact_prm(const std::string& added) { return section("Contact path", "File = path.csv") + added; }

struct Mistake
{
  std::string added, error;
};

#define STRENGTH(text) "subsection Flat joint\n  set Bond tensile strength = " text "\nend\n"
#define STRENGTH_ERROR(text) "bad.prm:5: Flat joint/Bond tensile strength = " text ": "

TEST(BadPrm, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  for (const auto& [added, error] : std::vector<Mistake>{
         {STRENGTH("22"), STRENGTH_ERROR("22") "a unit is missing; write a stress, e.g. \"22 MPa\""},
         {STRENGTH("22 mm"), STRENGTH_ERROR("22 mm") "\"mm\" is not the unit of a stress"},
         {STRENGTH("22 MPa 3"), STRENGTH_ERROR("22 MPa 3") "\"MPa 3\" is not one unit"},
         {STRENGTH("5 10 MPa"), STRENGTH_ERROR("5 10 MPa") "\"10 MPa\" is not one unit"},
         {STRENGTH("MPa"), STRENGTH_ERROR("MPa") "a number is missing"},
         {STRENGTH("nan MPa"), STRENGTH_ERROR("nan MPa") "\"nan\" is not a decimal number"},
         {STRENGTH("1,5 MPa"), STRENGTH_ERROR("1,5 MPa") "\"1,5\" is not a decimal number"},
         {STRENGTH(""), STRENGTH_ERROR("") "a number is missing"},
         {"subsection Specimen\nset Minimum radius = -0.6 mm\nend", "bad.prm:5: Specimen/Minimum radius = -0.6 mm: "},
         {"subsection Contact\nset Radius 1 = 0 mm\nend", "bad.prm:5: Contact/Radius 1 = 0 mm: must be > 0 mm"},
         {"subsection Specimen\nset Radius ratio = 0.9\nend",
          "bad.prm:5: Specimen/Radius ratio = 0.9: must lie in [1, 100]"},
         {"subsection Flat joint\nset Segments = 0\nend", "bad.prm:5: Flat joint/Segments = 0: "},
         {"subsection Flat joint\nset Bond friction angle = 95 deg\nend",
          "bad.prm:5: Flat joint/Bond friction angle = 95 deg: must lie in [0 deg, 90 deg)"},
         {"subsection Specimen\nset Height = 4 mm\nend", "bad.prm:5: Specimen/Height = 4 mm: must be at least"},
         {"subsection Specimen\nset Dimension = 4\nend", "bad.prm:5: Specimen/Dimension = 4: must be 2 or 3"},
         {"subsection Flat joint\nset Segmnts = 3\nend", "bad.prm:5: Flat joint/Segmnts: no such entry"},
         {"subsection Contact path\nset File = path.csv\nend",
          "bad.prm:5: Contact path/File: is given twice, first in bad.prm:2"},
         {"subsection Flat joint\nset Segments = 3\n", "bad.prm:4: subsection Flat joint: is not closed"},
         {"end\n", "bad.prm:4: end: there is no open subsection"}})
    {
      folder.write("bad.prm", contact_prm(added));
      expect_line(folder, "contact bad.prm", error);
    }
}

TEST(BadJson, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  for (const auto& [added, error] : std::vector<Mistake>{
         {R"("Flat joint": {"Bond tensile strength": 22})",
          "bad.json: Flat joint/Bond tensile strength = 22: a unit is missing"},
         {R"("Flat joint": {"Bond friction angle": "95 deg"})", "bad.json: Flat joint/Bond friction angle = 95 deg: "},
         {R"("Contact path": {})", "bad.json: Contact path: is given twice"},
         {R"("Flat joint": {"Segmnts": 4})", "bad.json: Flat joint/Segmnts: no such entry"},
         {R"("Flat joint": {"Segments": 4)", "bad.json:1:69: is not valid JSON: "}})
    {
      folder.write("bad.json", R"({"Contact path": {"File": "path.csv"}, )" + added + "}");
      expect_line(folder, "contact bad.json", error);
    }
}

TEST(BadPath, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("bad.prm", contact_prm(""));
  for (const auto& [path, error] : std::vector<Mistake>{
         {"", "path.csv:1: the header is \"\""},
         {"0,0,0\n", "path.csv:1: the header is \"0,0,0\"; it must be \"normal_m,shear_m,rotation_rad\""},
         {"shear_m,rotation_rad\n0,0\n", "path.csv:1: the header is "},
         {"normal_m,shear_m,rotation_rad\n", "path.csv: there is no row"},
         {"normal_m,shear_m,rotation_rad\n0,0,0\n0,0\n",
          "path.csv:3: there must be 3 values, one for each of normal_m,shear_m,rotation_rad; found"},
         {"normal_m,shear_m,rotation_rad\n0,0,0,5\n",
          "path.csv:2: there must be 3 values, one for each of normal_m,shear_m,rotation_rad; found"},
         {"normal_m,shear_m,rotation_rad\n0,nan,0\n", "path.csv:2: shear_m: \"nan\" is not a decimal number"},
         {"normal_m,shear_m,rotation_rad\n0,0,\n", "path.csv:2: rotation_rad: a number is missing"}})
    {
      folder.write("path.csv", path);
      expect_line(folder, "contact bad.prm", error);
    }
}

TEST(BadFile, IsToldInOneLine)
{
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.prm");
  folder.write("input.txt", "");
  folder.write("binary.prm", std::string_view("\0\1\2", 3));
  folder.write("no_path.prm", section("Contact path", "File = path.csv"));
  folder.write("empty.prm", "");
  expect_line(folder, "contact missing.prm", "missing.prm: cannot be read: No such file");
  expect_line(folder, "contact folder.prm", "folder.prm: is a folder");
  expect_line(folder, "contact input.txt", "input.txt: the name must end in .prm or .json");
  expect_line(folder, "contact binary.prm", "binary.prm: is not a text file");
  expect_line(folder, "contact no_path.prm", "no_path.prm:2: Contact path/File = path.csv: there is no file");
  expect_line(folder, "contact empty.prm", "empty.prm: Contact path/File: is missing");
  folder.write("rock.json", "{\"experiment\": {\n");
  folder.write("rock.prm", section("Report", "Reference file = rock.json"));
  for (const char* command : {"lab rock.prm", "parameters --check rock.prm"})
    expect_line(folder, command, "rock.json:2:1: is not valid JSON");
}

// A check must not pass what its command refuses at once: for each command an input that it refuses before any work,
// and the same line by the check.
TEST(Check, RefusesWhatItsCommandRefusesAtOnce)
{
  const TemporaryFolder folder;
  folder.write("cell.prm", section("Specimen", "Shape = periodic", "Width = 8 mm", "Height = 8 mm"));
  run_to_end(folder, "specimen cell.prm --output cell --quiet");
  const std::string cell = section("Specimen", "Specimen file = cell/specimen.h5");
  struct Refused
  {
    const char* command;
    std::string input;
    const char* why;
  };
  const std::vector<Refused> all{
    {"lab", section("Tests", "Intermediate stress = 30 MPa"), "Tests/Intermediate stress = 30 MPa: presses "},
    {"lab", cell, "Specimen/Specimen file: is a periodic cell; "},
    {"lab", section("Specimen", "Dimension = 3", "Specimen file = cell/specimen.h5"), "cell/specimen.h5: "},
    {"rve", "", "Specimen/Shape = box: a representative volume needs Shape = periodic"},
    {"rve", cell, "Strain path/File: is missing; "},
    {"multiscale", cell + section("Sample", "Realisations = 1", "Elements across = 5000", "Elements along = 5000"),
     "Sample/Elements across = 5000, "},
    {"calibrate", "", "Report/Reference file: is needed; "},
    {"contact", "", "Contact path/File: is missing; "},
    {"specimen", section("Specimen", "Specimen file = cell/specimen.h5", "Joint law = parallel bond"),
     "Specimen/Joint law = parallel bond: the joints of "}};
  for (const auto& [command, input, why] : all)
    {
      folder.write("in.prm", input);
      const std::string words = std::string(command) + " in.prm --output never --quiet";
      const Outcome run = run_feldspar(folder, words);
      const Outcome check = run_feldspar(folder, std::string("parameters --check in.prm --for ") + command);
      EXPECT_EQ(run.exit_code, 2) << words;
      EXPECT_TRUE(has_words(run.error, why)) << words << ": ";
      EXPECT_EQ(check.exit_code, 2) << words;
      EXPECT_EQ(check.error, run.error);
      EXPECT_EQ(check.output, "");
    }
}

TEST(Check, SaysWhichCommandsTakeAnInput)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", "");
  const auto rock = run_to_end(folder, "parameters --check rock.prm");
  EXPECT_EQ(rock.output.find("rock.prm: OK for feldspar lab, specimen\n"), 0u) << rock.output;
  EXPECT_TRUE(has_words(rock.output, "\n  not for feldspar rve: Specimen/Shape = box: "));
  EXPECT_EQ(run_feldspar(folder, "parameters --check rock.prm --for lab").output, "rock.prm: OK for feldspar lab\n");
  expect_refused(folder, "parameters --check rock.prm --for slab", "");

  // A third stress in the plane: grains can be packed, and that is all.
  folder.write("plane.prm", section("Tests", "Intermediate stress = 30 MPa"));
  const Outcome plane =
    expect_mistake(folder, "parameters --check plane.prm",
                   "feldspar: plane.prm: no command that tests rock takes it; the reasons stand above\n");
  EXPECT_TRUE(has_words(plane.output, "  not for feldspar lab: Tests/Intermediate stress = 30 MPa: "));

  // Elements larger than the cell that softens for them are a remark of the run, too.
  folder.write("sample.prm",
               section("Specimen", "Shape = periodic", "Width = 8 mm", "Height = 8 mm") +
                 section("Sample", "Width = 50 mm", "Height = 100 mm", "Elements across = 2", "Elements along = 4"));
  const auto sample = run_to_end(folder, "parameters --check sample.prm --for multiscale");
  EXPECT_TRUE(has_words(sample.output, "are larger than the RVE of "));
}

TEST(Check, AsksAfterTheUnitOfAValueThatNoRockHas)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", section("Flat joint", "Bond tensile strength = 22 GPa") +
                             section("Tests", "List = triaxial_compression", "Confinements = 5, 10, 20 GPa") +
                             section("Variants", "Entry = Flat joint/Modulus", "Values = 80 MPa; 80 GPa"));
  const auto check = run_to_end(folder, "parameters --check rock.prm --for lab");
  EXPECT_EQ(check.output,
            "rock.prm: OK for feldspar lab\n"
            "  Flat joint/Modulus: 0.08 GPa lies far outside 0.1 GPa to 2000 GPa, the range of rocks and "
            "laboratories; is the unit meant?\n"
            "  Flat joint/Bond tensile strength: 22000 MPa lies far outside 0.001 MPa to 2000 MPa, the range "
            "of rocks and laboratories; is the unit meant?\n"
            "  Tests/Confinements: 5000 MPa lies far outside 0.001 MPa to 2000 MPa, the range of rocks and "
            "laboratories; is the unit meant?\n");
  // A run says it before it begins.
  const auto run = run_to_end(folder, "specimen rock.prm --set 'Specimen/Width = 8 mm' --set "
                                      "'Specimen/Height = 12 mm' --output specimen.h5");
  EXPECT_TRUE(has_words(run.error, "Flat joint/Modulus: 0.08 GPa lies far"));
}

TEST(BadCommandLine, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  expect_line(folder, "contct good.prm", "contct: no such command; did you mean \"contact\"?");
  expect_line(folder, "contact", "INPUT is required");
  expect_line(folder, "contact good.prm --threads 0", "--threads: ");
  expect_line(folder, "contact good.prm --sideways", "--sideways: contact has no such option; there are --help");
  expect_line(folder, "lab good.prm --thread 2", "--thread: lab has no such option; did you mean \"--threads\"?");
  expect_line(folder, "report a --refernce=b", "--refernce: report has no such option; did you mean \"--reference\"?");
  expect_line(folder, "--sideways", "The following argument was not expected: --sideways");
  expect_line(
    folder, "parameters 'Flat joints'",
    "Flat joints: no such section, and no entry has it in its name, meaning or choices; did you mean \"Flat joint\"?");
}

TEST(BadOutputFolder, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  std::filesystem::create_directory(folder / "used");
  folder.write("used/notes.txt", "mine");
  expect_line(folder, "contact good.prm --output used",
              "used: is not empty; choose another folder with --output, or leave --output out for a new one\n");
  expect_line(folder, "contact good.prm --output good.prm", "good.prm: cannot be written into: Not a directory");
  // Even root cannot make a folder below a file or in /proc; parents made on the way must go again.
  expect_line(folder, "contact good.prm --output good.prm/results", "good.prm/results: cannot be written into: ");
  expect_line(folder, "contact good.prm --output new/../good.prm/a", "new/../good.prm/a: cannot be written into: ");
  expect_line(folder, "contact good.prm --output /proc/results", "/proc/results: cannot be written into: ");
}

TEST(OutputFolder, IsFreshAndNumberedOrNamed)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  run_to_end(folder, "contact good.prm");
  EXPECT_EQ(run_feldspar(folder, "contact good.prm --quiet").output, "");
  run_to_end(folder, "contact good.prm --output some/where/");
  for (const char* name : {"good-results-001", "good-results-002", "some/where"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder / name / "contact.csv")) << name;

  folder.write("some/where/contact.csv", "old");
  folder.write("some/where/notes.txt", "mine");
  run_to_end(folder, "contact good.prm --output some/where --force");
  EXPECT_GT(std::filesystem::file_size(folder / "some/where/contact.csv"), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder / "some/where/notes.txt"));
}
} // namespace
} // namespace feldspar::tests
