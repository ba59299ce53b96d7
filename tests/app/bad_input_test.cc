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
namespace feldspar
{
namespace
{
using tests::Outcome;
using tests::run_feldspar;
using tests::TemporaryFolder;

std::set<std::string> names_in(const std::filesystem::path& folder)
{
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.insert(entry.path().string());
  return names;
}

/// Runs, and checks all that every mistake has in common; `start` is how the line begins after `feldspar: `.
void expect_mistake(const TemporaryFolder& folder, const std::string& arguments, const std::string_view start)
{
  const std::set<std::string> before = names_in(folder.path());
  const Outcome outcome = run_feldspar(folder.path(), arguments);
  EXPECT_EQ(outcome.exit_code, 2) << arguments;
  EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  EXPECT_EQ(outcome.error.find("feldspar: " + std::string(start)), 0u)
    << "found: " << outcome.error << "wanted: " << start;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(names_in(folder.path()), before) << outcome.error;
}

constexpr std::string_view good_path = "normal_m,shear_m,rotation_rad\n0,0,0\n-1e-6,0,0\n";

/// A contact input that would run, but for the text added.
std::string contact_prm(const std::string_view added)
{
  return "subsection Contact path\n  set File = path.csv\nend\n" + std::string(added);
}

struct Mistake
{
  std::string_view added;
  std::string_view error;

  friend std::ostream& operator<<(std::ostream& stream, const Mistake& mistake) { return stream << mistake.added; }
};

class BadPrm : public testing::TestWithParam<Mistake>
{
};

TEST_P(BadPrm, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("bad.prm", contact_prm(GetParam().added));
  expect_mistake(folder, "contact bad.prm", GetParam().error);
}

#define STRENGTH(text) "subsection Flat joint\n  set Bond tensile strength = " text "\nend\n"
#define STRENGTH_ERROR(text) "bad.prm:5: Flat joint/Bond tensile strength = " text ": "

INSTANTIATE_TEST_SUITE_P(
  Mistakes, BadPrm,
  testing::Values(
    Mistake{STRENGTH("22"), STRENGTH_ERROR("22") "a unit is missing; write a stress, e.g. \"22 MPa\""},
    Mistake{STRENGTH("22 mm"), STRENGTH_ERROR("22 mm") "\"mm\" is not the unit of a stress"},
    Mistake{STRENGTH("22 MPa 3"), STRENGTH_ERROR("22 MPa 3") "\"MPa 3\" is not one unit"},
    Mistake{STRENGTH("5 10 MPa"), STRENGTH_ERROR("5 10 MPa") "\"10 MPa\" is not one unit"},
    Mistake{STRENGTH("MPa"), STRENGTH_ERROR("MPa") "a number is missing"},
    Mistake{STRENGTH("nan MPa"), STRENGTH_ERROR("nan MPa") "\"nan\" is not a decimal number"},
    Mistake{STRENGTH("1,5 MPa"), STRENGTH_ERROR("1,5 MPa") "\"1,5\" is not a decimal number"},
    Mistake{STRENGTH(""), STRENGTH_ERROR("") "a number is missing"},
    Mistake{"subsection Specimen\nset Minimum radius = -0.6 mm\nend", "bad.prm:5: Specimen/Minimum radius = -0.6 mm: "},
    Mistake{"subsection Contact\nset Radius 1 = 0 mm\nend", "bad.prm:5: Contact/Radius 1 = 0 mm: must be > 0 mm"},
    Mistake{"subsection Specimen\nset Radius ratio = 0.9\nend",
            "bad.prm:5: Specimen/Radius ratio = 0.9: must lie in [1, 100]"},
    Mistake{"subsection Flat joint\nset Segments = 0\nend", "bad.prm:5: Flat joint/Segments = 0: "},
    Mistake{"subsection Flat joint\nset Bond friction angle = 95 deg\nend",
            "bad.prm:5: Flat joint/Bond friction angle = 95 deg: must lie in [0 deg, 90 deg)"},
    Mistake{"subsection Specimen\nset Height = 4 mm\nend", "bad.prm:5: Specimen/Height = 4 mm: must be at least"},
    Mistake{"subsection Specimen\nset Dimension = 4\nend", "bad.prm:5: Specimen/Dimension = 4: must be 2 or 3"},
    Mistake{"subsection Flat joint\nset Segmnts = 3\nend", "bad.prm:5: Flat joint/Segmnts: no such entry"},
    Mistake{"subsection Contact path\nset File = path.csv\nend",
            "bad.prm:5: Contact path/File: is given twice, first in bad.prm:2"},
    Mistake{"subsection Flat joint\nset Segments = 3\n", "bad.prm:4: subsection Flat joint: is not closed"},
    Mistake{"end\n", "bad.prm:4: end: there is no open subsection"}));

class BadJson : public testing::TestWithParam<Mistake>
{
};

TEST_P(BadJson, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("bad.json", R"({"Contact path": {"File": "path.csv"}, )" + std::string(GetParam().added) + "}");
  expect_mistake(folder, "contact bad.json", GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
  Mistakes, BadJson,
  testing::Values(Mistake{R"("Flat joint": {"Bond tensile strength": 22})",
                          "bad.json: Flat joint/Bond tensile strength = 22: a unit is missing"},
                  Mistake{R"("Flat joint": {"Bond friction angle": "95 deg"})",
                          "bad.json: Flat joint/Bond friction angle = 95 deg: "},
                  Mistake{R"("Contact path": {})", "bad.json: Contact path: is given twice"},
                  Mistake{R"("Flat joint": {"Segmnts": 4})", "bad.json: Flat joint/Segmnts: no such entry"},
                  Mistake{R"("Flat joint": {"Segments": 4)", "bad.json:1:69: is not valid JSON: "}));

class BadPath : public testing::TestWithParam<Mistake>
{
};

TEST_P(BadPath, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", GetParam().added);
  folder.write("bad.prm", contact_prm(""));
  expect_mistake(folder, "contact bad.prm", GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
  Mistakes, BadPath,
  testing::Values(
    Mistake{"", "path.csv:1: the header is \"\""},
    Mistake{"0,0,0\n", "path.csv:1: the header is \"0,0,0\"; it must be \"normal_m,shear_m,rotation_rad\""},
    Mistake{"shear_m,rotation_rad\n0,0\n", "path.csv:1: the header is "},
    Mistake{"normal_m,shear_m,rotation_rad\n", "path.csv: there is no row"},
    Mistake{"normal_m,shear_m,rotation_rad\n0,0,0\n0,0\n",
            "path.csv:3: there must be 3 values, one for each of normal_m,shear_m,rotation_rad; found"},
    Mistake{"normal_m,shear_m,rotation_rad\n0,0,0,5\n",
            "path.csv:2: there must be 3 values, one for each of normal_m,shear_m,rotation_rad; found"},
    Mistake{"normal_m,shear_m,rotation_rad\n0,nan,0\n", "path.csv:2: shear_m: \"nan\" is not a decimal number"},
    Mistake{"normal_m,shear_m,rotation_rad\n0,0,\n", "path.csv:2: rotation_rad: a number is missing"}));

TEST(BadFile, IsToldInOneLine)
{
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "folder.prm");
  folder.write("input.txt", "");
  folder.write("binary.prm", std::string_view("\0\1\2", 3));
  folder.write("no_path.prm", "subsection Contact path\n  set File = path.csv\nend\n");
  folder.write("empty.prm", "");
  expect_mistake(folder, "contact missing.prm", "missing.prm: cannot be read: No such file");
  expect_mistake(folder, "contact folder.prm", "folder.prm: is a folder");
  expect_mistake(folder, "contact input.txt", "input.txt: the name must end in .prm or .json");
  expect_mistake(folder, "contact binary.prm", "binary.prm: is not a text file");
  expect_mistake(folder, "contact no_path.prm", "no_path.prm:2: Contact path/File = path.csv: there is no file");
  expect_mistake(folder, "contact empty.prm", "empty.prm: Contact path/File: is missing");
  folder.write("rock.json", "{\"experiment\": {\n");
  folder.write("rock.prm", "subsection Report\n  set Reference file = rock.json\nend\n");
  for (const char* command : {"lab rock.prm", "parameters --check rock.prm"})
    expect_mistake(folder, command, "rock.json:2:1: is not valid JSON");
}

// A check must not pass what its command refuses at once: for each command an input that it refuses before any work,
// and the same line by the check.
TEST(Check, RefusesWhatItsCommandRefusesAtOnce)
{
  const TemporaryFolder folder;
  folder.write("cell.prm",
               "subsection Specimen\n  set Shape = periodic\n  set Width = 8 mm\n  set Height = 8 mm\nend\n");
  ASSERT_EQ(run_feldspar(folder.path(), "specimen cell.prm --output cell --quiet").exit_code, 0);
  const std::string cell = "subsection Specimen\n  set Specimen file = cell/specimen.h5\nend\n";
  struct Refused
  {
    const char* command;
    std::string input;
    const char* why;
  };
  const std::vector<Refused> all{
    {"lab", "subsection Tests\n  set Intermediate stress = 30 MPa\nend\n",
     "Tests/Intermediate stress = 30 MPa: presses "},
    {"lab", cell, "Specimen/Specimen file: is a periodic cell; "},
    {"lab", "subsection Specimen\n  set Dimension = 3\n  set Specimen file = cell/specimen.h5\nend\n",
     "cell/specimen.h5: "},
    {"rve", "", "Specimen/Shape = box: a representative volume needs Shape = periodic"},
    {"rve", cell, "Strain path/File: is missing; "},
    {"multiscale",
     cell +
       "subsection Sample\n  set Realisations = 1\n  set Elements across = 5000\n  set Elements along = 5000\nend\n",
     "Sample/Elements across = 5000, "},
    {"calibrate", "", "Report/Reference file: is needed; "},
    {"contact", "", "Contact path/File: is missing; "},
    {"specimen", "subsection Specimen\n  set Specimen file = cell/specimen.h5\n  set Joint law = parallel bond\nend\n",
     "Specimen/Joint law = parallel bond: the joints of "}};
  for (const auto& [command, input, why] : all)
    {
      folder.write("in.prm", input);
      const std::string words = std::string(command) + " in.prm --output never --quiet";
      const Outcome run = run_feldspar(folder.path(), words);
      const Outcome check = run_feldspar(folder.path(), std::string("parameters --check in.prm --for ") + command);
      EXPECT_EQ(run.exit_code, 2) << words;
      EXPECT_NE(run.error.find(why), std::string::npos) << words << ": " << run.error;
      EXPECT_EQ(check.exit_code, 2) << words;
      EXPECT_EQ(check.error, run.error);
      EXPECT_EQ(check.output, "");
    }
}

TEST(Check, SaysWhichCommandsTakeAnInput)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", "");
  const Outcome rock = run_feldspar(folder.path(), "parameters --check rock.prm");
  EXPECT_EQ(rock.exit_code, 0) << rock.error;
  EXPECT_EQ(rock.output.find("rock.prm: OK for feldspar lab, specimen\n"), 0u) << rock.output;
  EXPECT_NE(rock.output.find("\n  not for feldspar rve: Specimen/Shape = box: "), std::string::npos) << rock.output;
  EXPECT_EQ(run_feldspar(folder.path(), "parameters --check rock.prm --for lab").output,
            "rock.prm: OK for feldspar lab\n");
  EXPECT_EQ(run_feldspar(folder.path(), "parameters --check rock.prm --for slab").exit_code, 2);

  // A third stress in the plane: grains can be packed, and that is all.
  folder.write("plane.prm", "subsection Tests\n  set Intermediate stress = 30 MPa\nend\n");
  const Outcome plane = run_feldspar(folder.path(), "parameters --check plane.prm");
  EXPECT_EQ(plane.exit_code, 2);
  EXPECT_EQ(plane.error, "feldspar: plane.prm: no command that tests rock takes it; the reasons stand above\n");
  EXPECT_NE(plane.output.find("  not for feldspar lab: Tests/Intermediate stress = 30 MPa: "), std::string::npos)
    << plane.output;

  // Elements larger than the cell that softens for them are a remark of the run, too.
  folder.write("sample.prm",
               "subsection Specimen\n  set Shape = periodic\n  set Width = 8 mm\n  set Height = 8 mm\nend\n"
               "subsection Sample\n  set Width = 50 mm\n  set Height = 100 mm\n  set Elements across = 2\n"
               "  set Elements along = 4\nend\n");
  const Outcome sample = run_feldspar(folder.path(), "parameters --check sample.prm --for multiscale");
  EXPECT_EQ(sample.exit_code, 0) << sample.error;
  EXPECT_NE(sample.output.find("are larger than the RVE of "), std::string::npos) << sample.output;
}

TEST(Check, AsksAfterTheUnitOfAValueThatNoRockHas)
{
  const TemporaryFolder folder;
  folder.write("rock.prm",
               "subsection Flat joint\n  set Bond tensile strength = 22 GPa\nend\n"
               "subsection Tests\n  set List = triaxial_compression\n  set Confinements = 5, 10, 20 GPa\nend\n"
               "subsection Variants\n  set Entry = Flat joint/Modulus\n  set Values = 80 MPa; 80 GPa\nend\n");
  const Outcome check = run_feldspar(folder.path(), "parameters --check rock.prm --for lab");
  EXPECT_EQ(check.exit_code, 0) << check.error;
  EXPECT_EQ(check.output,
            "rock.prm: OK for feldspar lab\n"
            "  Flat joint/Modulus: 0.08 GPa lies far outside 0.1 GPa to 2000 GPa, the range of rocks and "
            "laboratories; is the unit meant?\n"
            "  Flat joint/Bond tensile strength: 22000 MPa lies far outside 0.001 MPa to 2000 MPa, the range "
            "of rocks and laboratories; is the unit meant?\n"
            "  Tests/Confinements: 5000 MPa lies far outside 0.001 MPa to 2000 MPa, the range of rocks and "
            "laboratories; is the unit meant?\n");
  // A run says it before it begins.
  const Outcome run = run_feldspar(folder.path(), "specimen rock.prm --set 'Specimen/Width = 8 mm' --set "
                                                  "'Specimen/Height = 12 mm' --output specimen.h5");
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_NE(run.error.find("Flat joint/Modulus: 0.08 GPa lies far"), std::string::npos) << run.error;
}

TEST(BadCommandLine, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  expect_mistake(folder, "contct good.prm", "contct: no such command; did you mean \"contact\"?");
  expect_mistake(folder, "contact", "INPUT is required");
  expect_mistake(folder, "contact good.prm --threads 0", "--threads: ");
  expect_mistake(folder, "contact good.prm --sideways", "--sideways: contact has no such option; there are --help");
  expect_mistake(folder, "lab good.prm --thread 2", "--thread: lab has no such option; did you mean \"--threads\"?");
  expect_mistake(folder, "report a --refernce=b",
                 "--refernce: report has no such option; did you mean \"--reference\"?");
  expect_mistake(folder, "--sideways", "The following argument was not expected: --sideways");
  expect_mistake(
    folder, "parameters 'Flat joints'",
    "Flat joints: no such section, and no entry has it in its name, meaning or choices; did you mean \"Flat joint\"?");
}

TEST(BadOutputFolder, IsToldInOneLine)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  std::filesystem::create_directory(folder.path() / "used");
  folder.write("used/notes.txt", "mine");
  expect_mistake(folder, "contact good.prm --output used",
                 "used: is not empty; choose another folder with --output, or leave --output out for a new one\n");
  expect_mistake(folder, "contact good.prm --output good.prm", "good.prm: cannot be written into: Not a directory");
  // Even root cannot make a folder below a file or in /proc; parents made on the way must go again.
  expect_mistake(folder, "contact good.prm --output good.prm/results", "good.prm/results: cannot be written into: ");
  expect_mistake(folder, "contact good.prm --output new/../good.prm/a", "new/../good.prm/a: cannot be written into: ");
  expect_mistake(folder, "contact good.prm --output /proc/results", "/proc/results: cannot be written into: ");
}

TEST(OutputFolder, IsFreshAndNumberedOrNamed)
{
  const TemporaryFolder folder;
  folder.write("path.csv", good_path);
  folder.write("good.prm", contact_prm(""));
  EXPECT_EQ(run_feldspar(folder.path(), "contact good.prm").exit_code, 0);
  EXPECT_EQ(run_feldspar(folder.path(), "contact good.prm --quiet").output, "");
  EXPECT_EQ(run_feldspar(folder.path(), "contact good.prm --output some/where/").exit_code, 0);
  for (const char* name : {"good-results-001", "good-results-002", "some/where"})
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path() / name / "contact.csv")) << name;

  folder.write("some/where/contact.csv", "old");
  folder.write("some/where/notes.txt", "mine");
  EXPECT_EQ(run_feldspar(folder.path(), "contact good.prm --output some/where --force").exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(folder.path() / "some/where/contact.csv"), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "some/where/notes.txt"));
}
} // namespace
} // namespace feldspar
