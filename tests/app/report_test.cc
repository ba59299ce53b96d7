// The report as a user makes and reads it: out of small specimens, in a browser where one is there.

#include "tests/app/result_files.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

std::size_t count(const std::string& text, const std::string& what)
{
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size())
    ++n;
  return n;
}

/// Never run by a browser.
const std::string data_of_a_script = "<script type=\"application/json\" class=\"live-data\">";

/// The page without the data of its pictures and without its own script, which is its last one.
std::string page_words(const fs::path& page)
{
  std::string text = content(page);
  const std::size_t script = text.rfind("<script>");
  if (script != std::string::npos)
    text.erase(script, text.rfind("</script>") - script);
  for (std::size_t at = 0; (at = text.find(";base64,", at)) != std::string::npos;)
    text.erase(at, text.find('"', at) - at);
  return text;
}

/// One run, some ninety grains a specimen, that the tests of this file read and copy.
class Report : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    run = std::make_unique<TemporaryFolder>();
    run->write("rock.json", R"({"rock": "Test granite: grey", "citation": {"tests": "made up"},
      "experiment": {"label": "experiment", "tensile_strength_MPa": {"mean": 10, "min": 1, "max": 30},
                     "uniaxial_compressive_strength_MPa": {"mean": 900, "min": 800, "max": 1000}},
      "paper_model": {"label": "a model", "strength_at_10_MPa": {"mean": 300},
                      "hoek_brown": {"sigma_ci_MPa": 167, "m": 41.98, "s": 2.09, "a": 0.395}}})");
    run->write("rock.prm", "subsection Specimen\n  set Width = 12 mm\n  set Height = 24 mm\nend\n"
                           "subsection Tests\n  set List = direct_tension, uniaxial_compression, triaxial_compression\n"
                           "  set Confinements = 10, 20, 30 MPa\nend\n"
                           "subsection Seeds\n  set Seeds = 1, 2\nend\n"
                           "subsection Report\n  set Reference file = rock.json\nend\n");
    outcome = run_feldspar(run->path(), "lab rock.prm --output out --quiet");
  }
  static void TearDownTestSuite() { run.reset(); }

  void SetUp() override
  {
    ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
    fs::copy(run->path() / "out", folder / "out", fs::copy_options::recursive);
  }

  /// Makes the report anew and returns its words; pictures, which take the most time, only where a test needs them.
  std::string remade(const std::string& arguments = "report out", const bool drawn = false)
  {
    const auto answer = run_to_end(folder, arguments, drawn ? with_pictures : without_programs());
    EXPECT_TRUE(answer.error.starts_with("pictures ...\npictures: ")) << answer.error;
    EXPECT_TRUE(answer.error.ends_with(")\n")) << answer.error; // how long it took
    const std::string last_line = answer.output.substr(answer.output.rfind('\n', answer.output.size() - 2) + 1);
    return page_words(folder / last_line.substr(0, last_line.size() - 1));
  }

  std::string without_programs() const { return "PATH=" + (folder / "empty").string(); }

  static void holds(const std::string& text, const std::vector<std::string>& all_words)
  {
    for (const auto& words : all_words)
      EXPECT_TRUE(has_words(text, words));
  }

  static inline std::unique_ptr<TemporaryFolder> run;
  static inline Outcome outcome;
  const TemporaryFolder folder;
};

TEST_F(Report, IsOneFileThatNeedsNoOther)
{
  const fs::path page = folder / "out/report.html";
  EXPECT_LT(fs::file_size(page), 10'000'000u);
  const std::string words = page_words(page);
  for (const char* loaded : {"http:", "https:", "<link", "url(", "@import", "<iframe"})
    EXPECT_EQ(words.find(loaded), std::string::npos) << loaded;
  EXPECT_EQ(count(words, "<script"), count(words, data_of_a_script)); // its own, taken out, is the only one that runs
  EXPECT_GE(count(words, data_of_a_script), 18u); // 4 tests shown with 4 curves and a map of cracks each, but for one
  // Every picture is in it, with a text for who cannot see it.
  const std::regex image(
    "<img src=\"data:image/(svg\\+xml|png)\" alt=\"[^\"]{20,}\" width=\"[0-9]+\" height=\"[0-9]+\">");
  const auto n_images = std::distance(std::sregex_iterator(words.begin(), words.end(), image), {});
  EXPECT_EQ(std::size_t(n_images), count(words, "<img"));
  EXPECT_GE(n_images, 25); // 4 tests shown with 4 curves and 2 maps each, and the envelopes
  EXPECT_EQ(count(words, "<div class=\"picture\" style=\"--drawn: "), std::size_t(n_images)); // moved on a phone
  EXPECT_EQ(count(words, "class=\"absent\""), 0u);
  EXPECT_EQ(count(words, "{{"), 0u);
  // The tests side by side have a caption of their own beside that of the printed map.
  EXPECT_EQ(count(words, R"("what":"specimens")"), 1u);
  EXPECT_EQ(count(words, "<span class=\"of-live\">"), 1u);
  EXPECT_EQ(count(words, "<span class=\"of-picture\">"), 1u);
  holds(
    words,
    {"Test granite: model and rock", "Does the model match the rock?",
     "No. Uniaxial compressive strength is outside the measured range (2 specimens); 1 of 2 properties lies within.",
     "<li class=\"bad\"><span class=\"property\">uniaxial compressive strength</span>",
     "<li class=\"good\"><span class=\"property\">tensile strength</span>", "Strength envelope", "Only 2 specimens",
     "a model", "made up", "Width"});
}

// Each of the 2 x 26 series is a copy of the tests of one specimen under a label of its own: 52 are more than the 12 that a page
// shows in full.
TEST_F(Report, OfManySeriesHasARowForEach)
{
  auto summary = summary_of(folder / "out");
  const Json made = summary["tests"];
  summary["tests"].clear();
  for (int copy = 0; copy < 26; ++copy)
    for (Json test : made)
      {
        test["variant"] = fmt::format("copy {} of seed {}", copy, test["seed"].get<int>());
        summary["tests"].push_back(test);
      }
  std::ofstream(folder / "out/summary.json") << summary;
  const std::string words = remade();
  EXPECT_LT(fs::file_size(folder / "out/report.html"), 10'000'000u);
  const auto first_cells = [&](const std::string& name) {
    const auto begin = words.find("id=\"table_" + name + "\"");
    EXPECT_NE(begin, std::string::npos) << name;
    return count(words.substr(begin, words.find("</table>", begin) - begin), "<th scope=\"row\">copy ");
  };
  for (const char* name : {"verdicts", "comparison", "checks"})
    EXPECT_EQ(first_cells(name), 52u) << name;
  holds(words,
        {"0 of 52 series lie in every range that experiments give; 52 are not decided by their specimens.",
         "Pictures show the first 12 of 52 series.", "? 1: uniaxial compressive strength", "experiment, mean (range)"});
  const std::string cracks = words.substr(words.find("<section id=\"cracks\">"));
  EXPECT_EQ(count(cracks.substr(0, cracks.find("</section>")), "<h3>"), 12u);
  EXPECT_EQ(count(content(folder / "out/tables/verdicts.csv"), "\n"), 53u);
  // A series that has no block on the page has its tables beside it.
  for (const char* name : {"trust", "specimens", "envelopes"})
    EXPECT_TRUE(fs::exists(folder / fmt::format("out/tables/{}_52_copy_25_of_seed_2.csv", name))) << name;
}

/// A table for a data frame, read back with its quotes: rows of cells by the names of their columns.
using Frame = std::vector<std::map<std::string, std::string>>;

Frame read_frame(const fs::path& file)
{
  std::vector<std::vector<std::string>> lines{{""}};
  bool quoted = false;
  for (const char c : content(file))
    if (c == '"')
      quoted = !quoted; // a doubled quote inside would be lost; no name here has one
    else if (!quoted && c == ',')
      lines.back().emplace_back();
    else if (!quoted && c == '\n')
      lines.push_back({""});
    else
      lines.back().back() += c;
  lines.pop_back();
  Frame frame;
  for (std::size_t k = 1; k < lines.size(); ++k)
    {
      EXPECT_EQ(lines[k].size(), lines[0].size()) << file << ", row " << k;
      std::map<std::string, std::string> row;
      for (std::size_t c = 0; c < lines[0].size(); ++c)
        EXPECT_TRUE(row.emplace(lines[0][c], lines[k].at(c)).second) << file << ": " << lines[0][c] << " twice";
      frame.push_back(row);
    }
  return frame;
}

bool is_number(const std::string& text)
{
  std::size_t end = 0;
  try
    {
      std::stod(text, &end);
    }
  catch (const std::exception&)
    {
      return false;
    }
  return end == text.size();
}

/// The rows of a comparison, after it was seen that numbers stand alone and no two rows are of one source and property.
Frame read_comparison(const fs::path& folder)
{
  const Frame frame = read_frame(folder / "tables/comparison.csv");
  std::set<std::pair<std::string, std::string>> known;
  for (const auto& row : frame)
    {
      EXPECT_TRUE(known.emplace(row.at("source") + "|" + row.at("kind"), row.at("property")).second)
        << row.at("source") << ": " << row.at("property");
      for (const char* const column : {"mean", "standard_deviation", "n", "mean_95_low", "mean_95_high", "range_low",
                                       "range_high", "deviation_from_experiment"})
        EXPECT_TRUE(row.at(column).empty() || is_number(row.at(column))) << row.at(column);
      EXPECT_TRUE(row.at("mean").size() + row.at("range_low").size() > 0) << row.at("property");
    }
  return frame;
}

const std::map<std::string, std::string>& row_of(const Frame& frame, const std::string& source,
                                                 const std::string& property)
{
  const auto found = std::find_if(frame.begin(), frame.end(), [&](const auto& row) {
    return row.at("source") == source && row.at("property") == property;
  });
  if (found == frame.end())
    throw std::runtime_error("no row of " + source + ": " + property);
  return *found;
}

// Both strengths of the run are read off summary.json and compared with the reference, whose range is 1 to 30 and 800 to
// 1000 MPa.
TEST_F(Report, ComparisonIsATableForADataFrame)
{
  const Frame frame = read_comparison(folder / "out");
  const auto summary = summary_of(folder / "out");
  std::vector<double> strengths;
  for (const auto& test : summary["tests"])
    if (test["kind"] == "uniaxial_compression")
      strengths.push_back(test["peak_stress_Pa"].get<double>() / 1e6);
  ASSERT_EQ(strengths.size(), 2u);
  const double mean = (strengths[0] + strengths[1]) / 2.0;
  const double half_width = 12.706 * std::abs(strengths[0] - strengths[1]) / 2.0; // t of one degree of freedom

  const auto& ours = row_of(frame, "out", "uniaxial compressive strength");
  EXPECT_EQ(ours.at("kind"), "specimens");
  EXPECT_EQ(ours.at("unit"), "MPa");
  EXPECT_EQ(ours.at("n"), "2");
  EXPECT_NEAR(std::stod(ours.at("mean")), mean, 1e-8 * mean);
  EXPECT_NEAR(std::stod(ours.at("standard_deviation")), std::abs(strengths[0] - strengths[1]) / std::sqrt(2.0),
              1e-6 * mean);
  EXPECT_NEAR(std::stod(ours.at("mean_95_high")) - mean, half_width, 1e-4 * half_width);
  EXPECT_NEAR(std::stod(ours.at("deviation_from_experiment")), mean / 900.0 - 1.0, 1e-8);
  EXPECT_EQ(ours.at("in_experiment_range"), "false");
  ASSERT_LT(mean + half_width, 800.0);
  EXPECT_EQ(ours.at("verdict"), "outside");
  EXPECT_EQ(row_of(frame, "out", "tensile strength").at("in_experiment_range"), "true");
  const auto& strain = row_of(frame, "out", "strain at peak, compression"); // on the page in 1e-3
  EXPECT_EQ(strain.at("unit"), "");
  EXPECT_EQ(strain.at("in_experiment_range"), "");
  double strains = 0.0;
  for (const auto& test : summary["tests"])
    if (test["kind"] == "uniaxial_compression")
      strains += test["strain_at_peak"].get<double>();
  EXPECT_NEAR(std::stod(strain.at("mean")), strains / 2.0, 1e-8 * strains);

  const auto& rock = row_of(frame, "experiment", "uniaxial compressive strength");
  EXPECT_EQ(rock.at("kind"), "experiment");
  EXPECT_EQ(rock.at("mean"), "900");
  EXPECT_EQ(rock.at("range_low"), "800");
  EXPECT_EQ(rock.at("range_high"), "1000");
  EXPECT_EQ(rock.at("mean_95_low"), "");
  EXPECT_EQ(row_of(frame, "a model", "strength at 10 MPa confinement").at("mean"), "300");

  // The table behind the page's own link is that file.
  const std::string page = content(folder / "out/report.html");
  const std::size_t table = page.find("id=\"table_comparison\"");
  ASSERT_NE(table, std::string::npos);
  const std::string bytes = content(folder / "out/tables/comparison.csv");
  const std::string link = ";base64,";
  const std::size_t at = page.find(link, table) + link.size();
  EXPECT_EQ(page.find('"', at) - at, (bytes.size() + 2) / 3 * 4);
}

TEST_F(Report, LeavesFiguresAndTablesForAPaper)
{
  for (const char* name : {"envelope", "envelope_near_uniaxial", "envelopes", "compression_out", "residuals_out",
                           "uniaxial_compression_stress", "uniaxial_compression_cracks", "uniaxial_compression_energy",
                           "uniaxial_compression_crack_rate", "triaxial_compression_20_MPa_stress", "rose_out",
                           "shear_share", "fragment_sizes_out"})
    for (const char* ending : {".svg", ".pdf", ".gp"})
      EXPECT_GT(fs::file_size(folder / "out/figures" / (std::string(name) + ending)), 500u) << name << ending;
  for (const char* name : {"uniaxial_compression_seed_2_cracks.png", "uniaxial_compression_seed_1_fragments.png"})
    EXPECT_GT(fs::file_size(folder / "out/figures" / name), 5000u) << name;
  for (const char* name : {"envelopes", "residuals", "trust", "specimens", "input", "strengths", "tests"})
    EXPECT_GT(n_lines(content(folder / "out/tables" / (std::string(name) + ".csv"))), 2u) << name;
}

TEST_F(Report, MadeAnewFromTheFolderIsTheSame)
{
  const std::string first = content(folder / "out/report.html");
  fs::rename(folder / "out/figures", folder / "figures");
  std::this_thread::sleep_for(std::chrono::seconds(1)); // a PDF that kept the time of its drawing would have another
  fs::remove_all(folder / "out/tables");
  fs::remove(folder / "out/report.html");
  remade("report out", true);
  EXPECT_EQ(content(folder / "out/report.html"), first);
  for (const auto& entry : fs::directory_iterator(folder / "figures"))
    EXPECT_EQ(content(entry.path()), content(folder / "out/figures" / entry.path().filename())) << entry.path();
}

TEST_F(Report, SetsFoldersBesideOneAnother)
{
  fs::copy(folder / "out", folder / "other", fs::copy_options::recursive);
  const std::string words = remade("report out other --output both", true);
  holds(words, {"</span>out</h3>", "</span>other</h3>", "Strength of all series"});
  const Frame frame = read_comparison(folder / "both");
  for (const char* const source : {"out", "other"})
    EXPECT_EQ(row_of(frame, source, "tensile strength").at("mean"),
              row_of(frame, "out", "tensile strength").at("mean"));
  EXPECT_TRUE(is_number(row_of(frame, "other", "grains of a specimen").at("mean")));
  EXPECT_TRUE(fs::exists(folder / "both/figures/envelopes.svg"));
  // A folder that is in use is not written over unless that is wanted.
  expect_refused(folder, "report out other --output both", "");
  remade("report out other --output both --force");
  remade("report out other");
  EXPECT_TRUE(fs::exists(folder / "report-results-001/report.html"));
}

TEST_F(Report, SaysWhatIsMissingInAFolderAndIsStillMade)
{
  fs::remove(folder / "out/curves/uniaxial_compression_seed_1.csv");
  fs::remove(folder / "out/cracks.csv");
  fs::remove_all(folder / "out/grains");
  const std::string words = remade();
  holds(words, {"curves/uniaxial_compression_seed_1.csv: cannot be read: No such file",
                "out/cracks.csv: cannot be read: No such file", "No crack map", "Strength envelope"});
}

TEST_F(Report, DrawsNoEnvelopeOfOneConfinement)
{
  auto json = nlohmann::ordered_json::parse(content(folder / "out/summary.json"));
  std::erase_if(json["tests"].get_ref<nlohmann::ordered_json::array_t&>(),
                [](const auto& test) { return test["kind"] != "uniaxial_compression"; });
  folder.write("out/summary.json", json.dump());
  fs::remove(folder / "out/reference.json");
  for (const char* const drawn : {"out/figures", "out/tables"})
    fs::remove_all(folder / drawn);
  holds(remade(), {"All strengths of this series are at one confinement, so there is no envelope."});
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().filename().string().starts_with("envelope")) << entry.path();
}

TEST_F(Report, OfAnOlderLayoutSaysSoAndIsStillMade)
{
  auto json = nlohmann::ordered_json::parse(content(folder / "out/summary.json"));
  json["schema_version"] = 0;
  json.erase("input");
  json.erase("host");
  for (auto& test : json["tests"])
    for (const char* name : {"size_m", "group", "shear_share_at_peak", "n_fragments", "crack_damage_stress_Pa"})
      test.erase(name);
  folder.write("out/summary.json", json.dump());
  holds(remade(),
        {"summary.json has layout 0; this program writes layout 2", "from an unknown input", "Strength envelope"});
}

const std::string usual_header = "axial_strain [%],lateral_strain [%],axial_stress [MPa],confining_pressure [MPa]";

/// Axial and lateral strain in per cent, stress in MPa: 60 GPa, Poisson's ratio 0.2 to 60 MPa, 0.35 to 120 MPa, 0.9 to the peak
/// of 160 MPa.
std::vector<std::array<double, 3>> measured_rows()
{
  std::vector<std::array<double, 3>> rows;
  const auto expansion = [](const double stress) {
    return (0.2 * std::min(stress, 60.0) + 0.35 * std::clamp(stress - 60.0, 0.0, 60.0) +
            0.9 * std::max(stress - 120.0, 0.0)) /
           600.0;
  };
  const auto nine_decimals = [](const double value) { return std::round(1e9 * value) / 1e9; };
  for (int k = 0; k <= 200; ++k)
    rows.push_back(
      {nine_decimals(k / 600.0), nine_decimals(-expansion(std::min(double(k), 160.0))), k <= 160 ? k : 320.0 - k});
  return rows;
}

std::string measured_curve(const std::string& header = usual_header, const double sign_of_lateral = 1.0,
                           const double pressure = 0.0)
{
  std::string text = header + "\n";
  for (const auto& [axial, lateral, stress] : measured_rows())
    text += fmt::format("{:.9f},{:.9f},{},{}\n", axial, sign_of_lateral * lateral, stress + pressure, pressure);
  return text;
}

/// In single quotes of the shell.
std::string for_shell(const std::string& text)
{
  std::string result = "'";
  for (const char c : text)
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Returns whether a file of that name lies anywhere below a folder.
bool has_anywhere(const fs::path& folder, const std::string& name)
{
  return std::any_of(fs::recursive_directory_iterator(folder), {},
                     [&](const fs::directory_entry& entry) { return entry.path().filename() == name; });
}

TEST_F(Report, RunsNothingThatANameAsksFor)
{
  using Json = nlohmann::ordered_json;
  const std::string command = "a\nsystem \"touch marker\"\n'; system \"touch marker\"; `touch marker` @m \\";
  Json reference = Json::parse(content(folder / "out/reference.json"));
  reference["rock"] = command;
  reference["experiment"]["label"] = command + " <script>alert(1)</script>";
  reference["paper_model"]["label"] = command;
  reference["citation"]["tests"] = command;
  Json summary = Json::parse(content(folder / "out/summary.json"));
  for (auto& test : summary["tests"])
    {
      test["variant"] = test["seed"] == 1 ? command : "=1+2";
      test["group"] = command;
      test["peak_stress_Pa_reason"] = command;
    }
  summary["tests"].push_back(summary["tests"].front());
  summary["tests"].back()["name"] = "a; system \"touch marker\"\n";
  summary["tests"].push_back(summary["tests"].front());
  summary["tests"].back()["name"] = "../../escaped";
  summary["input"]["parameters"]["Seeds"]["Seeds"] = "=cmd|' /C calc'!A0";
  // A folder's name as well, which as an output of gnuplot's would be a program.
  const std::string odd = "|touch marker; `touch marker` $(touch marker)\nsystem \"touch marker\"\n' \" gr\xfcn";
  fs::copy(folder / "out", folder / odd, fs::copy_options::recursive);
  folder.write(odd + "/reference.json", reference.dump());
  fs::copy(folder / "out", folder / "-d", fs::copy_options::recursive);
  folder.write("-d/reference.json", reference.dump());
  folder.write("-d/summary.json", summary.dump());
  const std::string curve = "c\nsystem \"touch marker\"\n.csv";
  folder.write(curve, measured_curve());
  for (const std::string& arguments : {"report -- " + for_shell(odd), std::string("report -- -d"),
                                       "report --output alone --curve " + for_shell(curve)})
    {
      const std::string page = remade(arguments, true);
      EXPECT_EQ(count(page, "class=\"absent\""), 0u) << arguments;
      EXPECT_EQ(count(page, "<script"), count(page, data_of_a_script)) << arguments;
      EXPECT_FALSE(has_anywhere(folder, "marker")) << arguments;
    }
  EXPECT_FALSE(has_anywhere(folder, "escaped_stress_strain.gp"));
  EXPECT_GT(count(content(folder / "-d/report.html"), "a test was left out for its name"), 1u);
  std::string input; // of the first series; the others have the same
  for (const auto& table : fs::directory_iterator(folder / "-d/tables"))
    if (table.path().filename().string().starts_with("input_"))
      input += content(table.path());
  EXPECT_TRUE(has_words(input, "\nSeeds,Seeds,'=cmd|' /C calc'!A0"));

  // The test can fail: such a script does run, were it drawn.
  folder.write("asked.gp", "system \"touch marker\"\n");
  std::system(("cd " + for_shell(folder.path().string()) + " && gnuplot -d asked.gp").c_str());
  EXPECT_TRUE(has_anywhere(folder, "marker"));
}

TEST_F(Report, OfAForeignFolderIsRefusedInOneLine)
{
  folder.write("out/summary.json", "{\"stiffness_Pa\": [1, 2]}");
  for (const char* arguments : {"report out", "report nowhere", "report", "report out nowhere --output new"})
    expect_refused(folder, arguments, "");
}

TEST_F(Report, WithoutAPeakSaysSoInItsPlace)
{
  folder.write("early.prm", section("Specimen", "Width = 12 mm", "Height = 24 mm") +
                              section("Tests", "List = uniaxial_compression", "Stop strain = 0.0002"));
  run_to_end(folder, "lab early.prm --output early --quiet", with_pictures);
  holds(page_words(folder / "early/report.html"),
        {"uniaxial_compression_seed_1 has no strength: the stress never peaked",
         "No compression test of this series has a strength", "Nothing to compare with: there is no reference file",
         "No crack map"});
}

TEST_F(Report, WithoutGnuplotHasItsWordsAndTables)
{
  fs::remove_all(folder / "out/figures");
  const std::string words = remade();
  holds(words, {"Pictures are missing: ", "is gnuplot (package gnuplot-nox) installed?",
                "is outside the measured range", "class=\"absent\""});
  EXPECT_EQ(count(words, "<img"), 0u);
}

TEST_F(Report, WithoutItsReferenceSaysSoInItsPlace)
{
  expect_refused(folder, "report out --reference nowhere.json",
                 "feldspar: nowhere.json: cannot be read: No such file or directory\n");
  fs::remove(folder / "out/reference.json");
  holds(remade(), {"Nothing to compare with: there is no reference file"});
}

// Points of σ₁ = σ₃ + 100 sqrt(12 σ₃/100 + 1) MPa: the rock mass of GSI 45 then has m_b = 12 exp(-55/28) = 1.683, s = 0.0022
// and a = 0.508 (Hoek and others 2002). A strength under three different stresses is no point of it.
TEST_F(Report, OfAReferenceWithPrincipalStressesHasItsRockMass)
{
  folder.write("rock.json", R"({"experiment": {"rock_mass": {"GSI": 45}, "triaxial": [
    {"sigma_1_MPa": 100, "sigma_3_MPa": 0}, {"sigma_1_MPa": 158.3239697, "sigma_3_MPa": 10},
    {"sigma_1_MPa": 204.3908891, "sigma_3_MPa": 20}, {"sigma_1_MPa": 280.8318916, "sigma_3_MPa": 40},
    {"sigma_1_MPa": 300, "sigma_2_MPa": 60, "sigma_3_MPa": 20}]}})");
  run_to_end(folder, "report out --reference rock.json --output mass --quiet");
  EXPECT_TRUE(
    has_words(content(folder / "mass/tables/rock_mass.csv"), "experiment,100.0,12.0,1.683,0.0022,0.508,4.48,0.132"));
  EXPECT_TRUE(has_words(content(folder / "mass/tables/true_triaxial_experiment.csv"), "20.0,60.0,300.0"));
  EXPECT_TRUE(has_words(content(folder / "mass/tables/envelopes_experiment.csv"), "\"intact, regression\",✓,100.0"));
}

TEST_F(Report, SetsAMeasuredCurveBesideTheModel)
{
  folder.write("core.csv", measured_curve());
  holds(remade("report out --curve core.csv --output both"), {"</span>core.csv</h3>"});
  // The first screen has both curves, above the tiles.
  const std::string page = content(folder / "both/report.html");
  EXPECT_LT(page.find("Uniaxial compression: Stress against axial, lateral and volumetric strain"),
            page.find("<ul class=\"tiles\">"));
  remade("report --curve core.csv --output alone");
  const std::string comparison = content(folder / "alone/tables/comparison.csv");
  const Frame frame = read_comparison(folder / "alone");
  EXPECT_EQ(row_of(frame, "core.csv", "uniaxial compressive strength").at("kind"), "laboratory curve");
  const std::map<std::string, double> expected{{"uniaxial compressive strength", 160.0},
                                               {"Young's modulus, tangent 40-60 % of peak", 60.0},
                                               {"Young's modulus, initial", 60.0},
                                               {"Poisson's ratio, initial", 0.2},
                                               {"Poisson's ratio, secant at 50 % of peak", 0.2375},
                                               {"crack initiation stress, lateral strain", 60.0},
                                               {"crack damage stress", 120.0}};
  for (const auto& [property, value] : expected)
    EXPECT_NEAR(std::stod(row_of(frame, "core.csv", property).at("mean")), value, 0.005 * value) << property;

  // Under pressure it stands beside the model's tests at that pressure.
  folder.write("confined.csv", measured_curve(usual_header, 1.0, 10.0));
  remade("report out --curve confined.csv --output pressed");
  const std::string beside = content(folder / "pressed/tables/measured_2_confined.csv.csv");
  EXPECT_TRUE(beside.starts_with("property,confined.csv,out\n")) << beside;
  holds(beside, {"strength [MPa],170.0,", "\"Young's modulus, initial [GPa]\",60.0,",
                 "\"crack initiation stress, lateral strain [MPa]\",70.0,", "crack damage stress [MPa],130.0,"});

  // The same in other units and another order, with a column more.
  std::string other = "note,confining_pressure [Pa],axial_stress [kPa],lateral_strain [-],axial_strain [mm/m]\n";
  for (const auto& [axial, lateral, stress] : measured_rows())
    other += fmt::format("0,0,{},{:.12f},{:.9f}\n", 1e3 * stress, lateral / 100.0, 10.0 * axial);
  fs::create_directories(folder / "si");
  folder.write("si/core.csv", other);
  remade("report --curve si/core.csv --output units");
  EXPECT_EQ(content(folder / "units/tables/comparison.csv"), comparison);
}

TEST_F(Report, OfMeasuredCurvesHasTheirOwnTitlesAndNothingOfASimulation)
{
  for (const char* const of : {"north", "south"})
    {
      fs::create_directories(folder / of);
      folder.write(fmt::format("{}/core.csv", of), measured_curve());
    }
  folder.write("uniaxial_compression_seed_1.csv", measured_curve()); // the name of a test of the model
  const std::string page =
    remade("report out --curve north/core.csv --curve south/core.csv --curve uniaxial_compression_seed_1.csv");
  holds(page, {"</span>measured curves</h3>"}); // one rock
  for (const auto& [name, title] :
       {std::pair("core", "core: Uniaxial compression"),
        {"core_2", "core_2: Uniaxial compression"},
        {"uniaxial_compression_seed_1_2", "uniaxial_compression_seed_1_2: Uniaxial compression"}})
    {
      const std::string script = content(folder / fmt::format("out/figures/{}_stress_strain.gp", name));
      EXPECT_TRUE(has_words(script, fmt::format("set title '{}'", title)));
      for (const char* const of_a_simulation : {"seed 0", "broken segments", "cracks"})
        EXPECT_EQ(script.find(of_a_simulation), std::string::npos) << name << ": " << of_a_simulation;
    }
  const std::string of_model = content(folder / "out/figures/uniaxial_compression_seed_1_stress_strain.gp");
  EXPECT_TRUE(has_words(of_model, "seed 1", "broken segments"));
  // The table of all tests has what was measured, and no seed, count or cost.
  const Frame tests = read_frame(folder / "out/tables/tests.csv");
  const auto measured =
    std::find_if(tests.begin(), tests.end(), [](const auto& row) { return row.at("test") == "core_2"; });
  ASSERT_NE(measured, tests.end());
  EXPECT_EQ(measured->at("peak_stress_Pa"), "160000000");
  EXPECT_EQ(measured->at("confining_pressure_Pa"), "0");
  for (const char* const column : {"seed", "strain_rate_per_s", "n_tension_cracks", "n_grains",
                                   "energy_imbalance_over_work", "steps", "wall_time_s"})
    EXPECT_EQ(measured->at(column), "") << column;
}

// The curve has 60 GPa and a peak at 160 MPa, so that the strain there is 160/600 %, and the secant ratio is 0.2375. An
// extensometer that stands at 0.05 % and -0.02 % when the test begins, and platens that come 0.3 % of the way, add to strains
// and to nothing else.
TEST_F(Report, CountsMeasuredStrainsFromWhereTheLoadBegins)
{
  const auto shifted = [&](const double axial, const double lateral, const std::string& rows_before,
                           const double first_stress = 0.0) {
    std::string text = usual_header + "\n" + rows_before;
    for (const auto& [axial_of_it, lateral_of_it, stress] : measured_rows())
      if (stress >= first_stress || axial_of_it > 0.3)
        text += fmt::format("{:.9f},{:.9f},{},0\n", axial_of_it + axial, lateral_of_it + lateral, stress);
    return text;
  };
  const auto figures = [&](const std::string& text, const std::string& said) {
    folder.write("core.csv", text);
    const auto answer = run_to_end(folder, "report --curve core.csv --output new --force", without_programs());
    EXPECT_EQ(answer.output.find("core.csv: ") != std::string::npos, !said.empty()) << answer.output;
    holds(answer.output, {said});
    holds(page_words(folder / "new/report.html"), {said});
    const Frame frame = read_comparison(folder / "new");
    std::vector<double> values;
    for (const char* const property : {"strain at peak, compression", "Poisson's ratio, secant at 50 % of peak",
                                       "Young's modulus, tangent 40-60 % of peak", "uniaxial compressive strength"})
      values.push_back(std::stod(row_of(frame, "core.csv", property).at("mean")));
    return values;
  };
  const std::vector<double> true_figures = figures(shifted(0.0, 0.0, ""), "");
  EXPECT_NEAR(true_figures[0], 160.0 / 60e3, 1e-8);
  EXPECT_NEAR(true_figures[1], 0.2375, 1e-3);
  const auto expect_true_within = [&](const double tolerance, const std::vector<double>& values) {
    for (std::size_t k = 0; k < values.size(); ++k)
      EXPECT_NEAR(values[k], true_figures[k], tolerance * true_figures[k]) << k;
  };
  const auto expect_true = [&](const std::vector<double>& values) { expect_true_within(1e-6, values); };
  expect_true(
    figures(shifted(0.05, -0.02, ""),
            "core.csv: strains are counted from row 1 below the header, where the load begins; 0.05 % of axial and "
            "-0.02 % of lateral strain were taken off every row"));
  // The platen comes to the specimen: three rows without load.
  expect_true(figures(shifted(0.3, 0.0, "0,0,0,0\n0.1,0,0.05,0\n0.2,0,0.1,0\n"),
                      "core.csv: strains are counted from row 4 below the header"));
  // The same under a load cell that reads 0.8 MPa, 0.5 % of the peak, and under one that wavers about it.
  const std::string read_before =
    "core.csv: strains are counted from row 3 below the header, where the load begins; 0.3 % of "
    "axial and 0 % of lateral strain were taken off every row; the load of 0.8 MPa that is "
    "read before stays in the stresses";
  expect_true_within(2e-3, figures(shifted(0.3, 0.0, "0,0,0.8,0\n0.1,0,0.8,0\n0.3,0,0.8,0\n", 1.0), read_before));
  expect_true_within(2e-3, figures(shifted(0.3, 0.0, "0,0,0.8,0\n0.1,0,0.95,0\n0.2,0,0.7,0\n0.3,0,0.8,0\n", 1.0),
                                   "core.csv: strains are counted from row 4 below the header"));
  // A record that begins at 8 of 160 MPa has no row by which its zero is known: it is taken as it stands, and that is said.
  const auto preloaded =
    figures(shifted(0.0, 0.0, "", 8.0), "core.csv: the first row is under 5.0 % of the peak load already");
  expect_true(preloaded);
}

// A cell of nan in a table of grains once broke the script of the page, so that figures behind it stayed still.
TEST_F(Report, OfTablesWithNumbersThatAreNoneNamesThemAndStaysAlive)
{
  const auto spoil = [&](const std::string& table, const std::size_t line, const std::size_t cell, const char* with) {
    std::string text = content(folder / table);
    std::size_t at = 0;
    for (std::size_t k = 1; k < line; ++k)
      at = text.find('\n', at) + 1;
    for (std::size_t k = 0; k < cell; ++k)
      at = text.find(',', at) + 1;
    text.replace(at, text.find_first_of(",\n", at) - at, with);
    folder.write(table, text);
  };
  spoil("out/grains/uniaxial_compression_seed_1.csv", 17, 1, "nan");
  spoil("out/grains/triaxial_compression_10_MPa_seed_1.csv", 3, 6, "-inf");
  spoil("out/curves/uniaxial_compression_seed_1.csv", 20, 3, "inf");
  spoil("out/cracks.csv", 5, 6, "-nan");
  const std::string words = remade("report out", true);
  holds(words,
        {"out/grains/uniaxial_compression_seed_1.csv: line 17: start_y_m is nan, no finite number",
         "out/grains/triaxial_compression_10_MPa_seed_1.csv: line 3: radius_m is -inf",
         "out/curves/uniaxial_compression_seed_1.csv: line 20: axial_stress_Pa is inf", "out/cracks.csv: line 5: "});
  std::size_t n = 0;
  for (std::size_t at = 0; (at = words.find(data_of_a_script, at)) != std::string::npos; ++n)
    {
      at += data_of_a_script.size();
      const std::string data = words.substr(at, words.find("</script>", at) - at);
      EXPECT_TRUE(Json::accept(data)) << data.substr(0, 200);
    }
  EXPECT_GE(n, 18u);
  EXPECT_EQ(count(words, "class=\"absent\""), 0u);
}

TEST_F(Report, RefusesAMeasuredCurveItCannotReadInOneLine)
{
  const auto refused = [&](const std::string& text, const std::string& words) {
    folder.write("core.csv", text);
    expect_refused(folder, "report --curve core.csv --output new", words);
  };
  refused(measured_curve("axial_strain [%],lateral_strain [%],axial_stress,confining_pressure [MPa]"),
          "core.csv:1: \"axial_stress\" has no unit");
  refused(measured_curve("axial_strain [%],lateral_strain [%],axial_stress [mm],confining_pressure [MPa]"),
          "\"mm\" is not the unit of a stress");
  refused("axial_strain [%],lateral_strain [%],axial_stress [MPa],confining_pressure [MPa]\n0,0,0,0\n0.1,0,1e308,0\n",
          "core.csv:3: axial_stress [MPa]: \"1e308\" is beyond the range of numbers");
  refused(measured_curve("axial_strain [%],axial_stress [MPa],axial_stress [MPa],confining_pressure [MPa]"),
          "axial stress is there twice");
  refused(measured_curve(usual_header, -1.0), "lateral_strain grows with the load");
  refused(usual_header + "\n0,0,0,0\n0.1,-0.02,0,0\n0.2,-0.04,-10,0\n", "axial_stress never rises");
  refused(usual_header + "\n0,0,0,0\n-0.1,-0.02,50,0\n-0.2,-0.04,40,0\n", "shortening is positive");
  refused(usual_header + "\n0,0,5,5\n0.1,-0.02,50,9\n0.2,-0.04,40,5\n", "confining_pressure is");
  refused(usual_header + "\n0,0,0,10\n0.1,-0.02,5,10\n0.2,-0.04,0,10\n",
          "axial_stress reaches 5 MPa only, under a confining_pressure of 10 MPa");
  refused(usual_header + "\n0,0,0,0\n0.1,-0.02,much,0\n",
          "core.csv:3: axial_stress [MPa]: \"much\" is not a decimal number");
  refused("", "core.csv:1: there is no column axial_strain");
  // Only of its values: a byte-order mark, as spreadsheets write it, is no part of the header.
  refused("\xef\xbb\xbf" + usual_header + "\r\n0,0,0,0\r\n0.1,-0.02,much,0\r\n",
          "core.csv:3: axial_stress [MPa]: \"much\"");
}

// Python's reader is another than the one that writes: every event of emission.csv, with what a reader of earthquakes asks for.
TEST_F(Report, WritesTheAcousticEmissionAsQuakemlWhereItIsAskedFor)
{
  EXPECT_FALSE(fs::exists(folder / "out/quakeml"));
  remade("report out --quakeml '41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z'");
  folder.write("read.py", R"(import csv, glob, os
from xml.etree import ElementTree
bed = {"b": "http://quakeml.org/xmlns/bed/1.2"}
rows = list(csv.DictReader(open("out/emission.csv")))
n = 0
for file in glob.glob("out/quakeml/*.xml"):
    name = os.path.basename(file)[:-4]
    root = ElementTree.parse(file).getroot()
    assert root.tag == "{http://quakeml.org/xmlns/quakeml/1.2}quakeml", root.tag
    events = root.findall("b:eventParameters/b:event", bed)
    of_test = [row for row in rows if row["test"] == name]
    assert len(events) == len(of_test), name
    for event, row in zip(events, of_test):
        def number(path): return float(event.find(path, bed).text)
        assert event.find("b:origin/b:time/b:value", bed).text.startswith("2026-01-01T00:00:0")
        assert abs(number("b:origin/b:depth/b:value") - 500 + float(row["y_m"])) < 1e-9
        assert number("b:origin/b:latitude/b:value") == 41
        moment = "b:focalMechanism/b:momentTensor/"
        assert abs(number(moment + "b:tensor/b:Mpp/b:value") - float(row["moment_xx_Nm"])) <= 1e-8 * float(row["moment_Nm"])
        assert abs(number("b:magnitude[b:type='Mw']/b:mag/b:value") - float(row["magnitude"])) < 1e-7
        n += 1
print(n)
)");
  const Outcome read = run_command(folder, "/usr/bin/python3 -I read.py");
  EXPECT_EQ(read.exit_code, 0) << read.error;
  EXPECT_EQ(read.output, fmt::format("{}\n", n_lines(content(folder / "out/emission.csv")) - 1));

  fs::remove(folder / "out/emission.csv");
  for (const auto& [arguments, words] :
       {std::pair("out --quakeml '41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z'",
                  "--quakeml: no test has events of acoustic emission"),
        {"out --quakeml '41.0, 97.0, 500 m'", "--quakeml must be latitude, longitude, depth and time"},
        {"out out --quakeml '41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z'",
         "--quakeml needs the results of one folder"}})
    expect_refused(folder, fmt::format("report {}", arguments), words);
}

// 400 amplitudes whose number falls by a factor of ten every 20 dB, b = 1: of rank k above 40 dB 20 log10(400/k) more.
TEST_F(Report, SetsACatalogueOfALaboratoryBesideTheModel)
{
  std::string text = "time [s],axial stress [MPa],amplitude [dB]\n";
  for (int k = 0; k < 400; ++k)
    text += fmt::format("{},{},{:.4f}\n", k, 0.5 * k, 40.0 + 20.0 * std::log10(400.0 / ((k * 157) % 400 + 0.5)));
  folder.write("ae.csv", text);
  const std::string words = remade("report out --catalogue ae.csv --output both");
  holds(words, {"Acoustic emission of the laboratory and of the model", "magnitudes of ae.csv: amplitude in dB / 20"});
  // Beside the rows of the model.
  const std::string table = content(folder / "both/tables/emission.csv");
  EXPECT_TRUE(table.starts_with("test,deviator,events,breaks an event,largest magnitude,complete from,b,b-positive,"))
    << table;
  holds(table, {"\nUniaxial compression,"});
  const std::string line = table.substr(table.find("ae.csv"));
  double largest = 0.0, complete = 0.0, b = 0.0;
  ASSERT_EQ(std::sscanf(line.c_str(), "ae.csv,to the peak,400,–,%lf,%lf,%lf ± ", &largest, &complete, &b), 3) << line;
  EXPECT_NEAR(largest, 2.0 + std::log10(800.0), 0.01);
  EXPECT_NEAR(complete, 2.0, 0.01);
  EXPECT_NEAR(b, 1.0, 0.02);

  folder.write("ae.csv", "time [s],amplitude [V]\n1,2\n");
  expect_refused(folder, "report out --catalogue ae.csv --output new", "ae.csv:1: \"amplitude [V]\"");
}

/// Headless Chromium, which the report itself does not need.
class Browser
{
public:
  /// Shows a page with more arguments; what it printed and what the page's console said.
  static Outcome show(const fs::path& page, const std::string& arguments)
  {
    const TemporaryFolder profile; // with its crash reports and caches
    const std::string out = (profile / "out").string();
    const std::string command = fmt::format(
      "HOME='{0}' timeout 120 chromium --headless=new --no-sandbox --disable-gpu "
      "--enable-unsafe-swiftshader --disable-dev-shm-usage "
      "--user-data-dir='{0}/profile' --hide-scrollbars --enable-logging=stderr {1} 'file://{2}' >'{3}' 2>'{3}.err'",
      profile.path().string(), arguments, page.string(), out);
    Outcome outcome{};
    outcome.exit_code = std::system(command.c_str());
    outcome.output = content(out);
    std::istringstream errors(content(out + ".err"));
    for (std::string line; std::getline(errors, line);)
      // The browser remarks on its own speed when a picture by WebGL is copied.
      if (line.find(":CONSOLE") != std::string::npos && line.find("GL Driver Message") == std::string::npos)
        outcome.error += line + "\n";
    return outcome;
  }
};

/// The page with another script in the place of its policy, which forbids all but its own.
std::string with_script(std::string page, const std::string& script)
{
  const std::size_t policy = page.find("<meta http-equiv");
  return page.replace(policy, page.find('>', policy) + 1 - policy, "<script>" + script + "</script>");
}

/// Title of a page as the browser left it; a script's message stands there.
std::string title_of(const Outcome& shown)
{
  const std::size_t begin = shown.output.rfind("<title>") + std::string("<title>").size();
  return shown.output.substr(begin, shown.output.find("</title>", begin) - begin);
}

/// At desk and phone width, in light and dark mode, the page breaks no rule of its own and is no wider than its frame.
void expect_shown_in_a_browser(const fs::path& page)
{
  ASSERT_EQ(std::system("command -v chromium >/dev/null"), 0) << "the package chromium is missing";
  const TemporaryFolder folder;
  // The policy of the page forbids it to load anything; a breach of it, or a script that fails, stands in the console.
  for (const int width : {1280, 390})
    for (const char* mode : {"", "--force-dark-mode --blink-settings=preferredColorScheme=0"})
      {
        const fs::path shot = folder / "shot.png";
        const auto shown =
          Browser::show(page, fmt::format("{} --window-size={},900 --screenshot='{}'", mode, width, shot.string()));
        EXPECT_EQ(shown.exit_code, 0);
        EXPECT_EQ(shown.error, "");
        ASSERT_TRUE(fs::exists(shot));
        EXPECT_GT(fs::file_size(shot), 20'000u);
        fs::remove(shot);
      }

  // The figures on the first screen respond to the pointer: the policy lets the page's own script run.
  const std::string alive = Browser::show(page, "--window-size=1280,2500 --virtual-time-budget=5000 --dump-dom").output;
  EXPECT_TRUE(has_words(alive, "<figure class=\"live\"><div class=\"stage\">", "<canvas",
                        "<div class=\"key\"><button type=\"button\"")); // of words, which break lines

  // Tables scroll in their places. The probe replaces the policy, which forbids scripts; a window of the browser is never
  // as narrow as a phone, a frame in it is.
  folder.write("probe.html", with_script(content(page), "addEventListener('load', () => parent.postMessage('wide ' + "
                                                        "document.documentElement.scrollWidth + ' of ' + innerWidth, "
                                                        "'*'))"));
  for (const int width : {1280, 390})
    {
      folder.write("frame.html",
                   fmt::format("<title>none</title><script>addEventListener('message', event => {{ document.title = "
                               "event.data; }})</script><iframe src=\"probe.html\" width=\"{}\" height=\"900\" "
                               "style=\"border: 0\"></iframe>",
                               width));
      const auto shown = Browser::show(folder / "frame.html", "--dump-dom");
      EXPECT_EQ(title_of(shown), fmt::format("wide {} of {}", width, width));
    }
}

TEST_F(Report, ShowsInABrowserAtDeskAndPhoneWidthInLightAndDark)
{
  const fs::path page = folder / "out/report.html";
  expect_shown_in_a_browser(page);
  // A page that does load something is found out: the check above can fail.
  std::string loading = content(page);
  loading.insert(loading.find("<main>"), "<img src=\"http://127.0.0.1:9/missing.png\" alt=\"\">");
  folder.write("loading.html", loading);
  EXPECT_NE(
    Browser::show(folder / "loading.html", fmt::format("--screenshot='{}'", (folder / "shot.png").string())).error, "");
}

TEST_F(Report, AnswersToTheMouse)
{
  folder.write("probed.html", with_script(content(folder / "out/report.html"),
                                          content(std::string(FELDSPAR_SOURCE_DIR) + "/tests/app/page_probe.js")));
  const auto shown =
    Browser::show(folder / "probed.html", "--window-size=1280,900 --virtual-time-budget=15000 --dump-dom");
  const std::string title = title_of(shown);
  const std::size_t faces = title.find(" faces ");
  EXPECT_EQ(
    title.substr(0, faces),
    "probed +hover +zoom +whole range +hide +show +as printed +interactive again +4 tests side by side +grains "
    "+cracks +filled +marks at the end +slider +marks at the beginning +filter +stress +pick +events at the end "
    "+events half way +event picked +emission hidden +enlarge +whole");
  // Polygons of grains have a face where there is a joint; the load has moved a few pairs across the installation gap.
  const auto summary = summary_of(folder / "out");
  const auto n_joints = summary["tests"][0]["n_joints"].get<double>();
  ASSERT_NE(faces, std::string::npos) << title;
  EXPECT_NEAR(std::stod(title.substr(faces + 7)), n_joints, 0.1 * n_joints); // of another seed perhaps
}

TEST_F(Report, WritesTheCrackingAsAFilm)
{
  const auto made = run_to_end(folder, "report out --film --quiet", with_pictures);
  EXPECT_EQ(made.output, "out/report.html\nout/film.webp\n");
  const std::string film = content(folder / "out/film.webp");
  ASSERT_TRUE(film.starts_with("RIFF"));
  EXPECT_EQ(count(film, "ANMF"), 38u); // 32 steps, of which the last stands for a while
  // A browser plays it: another colour than that of the corner covers a good part of the first picture.
  folder.write(
    "film.html",
    fmt::format("<title>none</title><script>const film = new Image(); film.onload = () => {{"
                "const sheet = document.createElement('canvas'); sheet.width = film.naturalWidth; "
                "sheet.height = film.naturalHeight; const pen = sheet.getContext('2d'); pen.drawImage(film, 0, 0);"
                "const all = new Uint32Array(pen.getImageData(0, 0, sheet.width, sheet.height).data.buffer);"
                "document.title = sheet.width + ' ' + all.filter(one => one !== all[0]).length / all.length; }};"
                "film.src = 'out/film.webp';</script>"));
  std::istringstream shown(title_of(
    Browser::show(folder / "film.html", "--allow-file-access-from-files --virtual-time-budget=5000 --dump-dom")));
  double width = 0.0, share = 0.0;
  shown >> width >> share;
  EXPECT_GT(width, 700.0);
  EXPECT_GT(share, 0.2);
}

TEST_F(Report, NamesThePackageWithoutWhichThereIsNoFilm)
{
  expect_refused(folder, "report out --film",
                 "feldspar: --film: Chromium, which makes the film, is not installed (package chromium)\n",
                 without_programs());
  // A page without specimens has no film either.
  folder.write("core.csv", measured_curve());
  const auto without =
    run_feldspar(folder, "report --curve core.csv --output curve --film"); // known once the page is made
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_TRUE(has_words(without.error, "shows no specimen with cracks"));
  EXPECT_FALSE(fs::exists(folder / "curve/film.webp"));
}

// Both sides end at one height, and so does what the last figure of each shows, but for its padding of 0.6 rem = 9.6 px and
// its border: no field below the specimens or the curves is blank.
TEST_F(Report, LevelsBothSidesOfItsFirstScreen)
{
  const std::string sides =
    "addEventListener('load', () => { const below = side => side.lastElementChild.getBoundingClientRect().bottom;"
    "const ends = [...document.querySelector('.lead').children].map(side => { const last = side.lastElementChild;"
    "return [below(side), last.matches('figure') ? below(side) - below(last) : 0]; });"
    "document.title = Math.abs(ends[0][0] - ends[1][0]) < 1 && ends.every(([, blank]) => blank < 12) ? 'level' : "
    "JSON.stringify(ends); })";
  folder.write("probe.html", with_script(content(folder / "out/report.html"), sides));
  EXPECT_EQ(title_of(Browser::show(folder / "probe.html", "--window-size=1280,1700 --dump-dom")), "level");
}

TEST_F(Report, ShowsItsPicturesWithoutItsScript)
{
  // The page's own script is taken out; another one counts the pictures that are seen.
  std::string page = content(folder / "out/report.html");
  const std::size_t script = page.rfind("<script>");
  page.erase(script, page.find("</script>", script) - script);
  folder.write("bare.html", with_script(page, "addEventListener('load', () => { const all = "
                                              "[...document.images]; document.title = 'seen ' + all.filter(one => "
                                              "one.naturalWidth > 0 && (one.checkVisibility() || "
                                              "one.closest('details'))).length + ' of ' + all.length; })"));
  const auto shown = Browser::show(folder / "bare.html", "--dump-dom");
  const std::size_t n_pictures = count(page, "<img src=\"data:image/");
  EXPECT_GT(n_pictures, 10u);
  EXPECT_EQ(title_of(shown), fmt::format("seen {0} of {0}", n_pictures));
}

TEST_F(Report, PrintsEachPicture)
{
  const fs::path page = folder / "out/report.html";
  const fs::path paper = folder / "paper.pdf";
  Browser::show(page, fmt::format("--virtual-time-budget=15000 --print-to-pdf='{}'", paper.string()));
  const std::string printed = content(paper);
  EXPECT_TRUE(printed.starts_with("%PDF"));
  EXPECT_GT(count(printed, "/Type /Page\n"), 3u);
  // Pictures of grains and cracks are images; drawings are drawn there, too.
  const std::string text = content(page);
  EXPECT_EQ(count(printed, "/Subtype /Image"), count(text, "<img src=\"data:image/png"));
}

TEST_F(Report, CarriesItsPicturesForPapersWithIt)
{
  const std::string page = content(folder / "out/report.html");
  const std::size_t n_drawings = count(page, "<img src=\"data:image/svg");
  EXPECT_GT(n_drawings, 5u);
  EXPECT_EQ(count(page, "<a href=\"data:application/pdf;base64,JVBERi0"), n_drawings); // %PDF-
  EXPECT_EQ(count(page, "title=\"beside this page"), 0u);
}

/// A sample of finite elements, pulled apart, with small RVEs at its points.
std::string sample_input(const std::string& specimen, const std::string& sample)
{
  return "subsection Specimen\n  set Shape = periodic\n" + specimen + "end\nsubsection Sample\n" + sample +
         "  set Realisations = 1\n  set Tension step = 1e-5\nend\nsubsection Tests\n  set List = direct_tension\n"
         "  set Stop strain = 2.5e-4\nend\n";
}

/// The words of its report; the run is out.
std::string words_of_pulled(const TemporaryFolder& folder, const std::string& specimen, const std::string& sample)
{
  folder.write("pull.prm", sample_input(specimen, sample));
  run_to_end(folder, "multiscale pull.prm --output out --quiet", with_pictures);
  return page_words(folder / "out/report.html");
}

TEST(ReportOfASample, ShowsWhereItIsDamagedAndTheGrainsOfItsRves)
{
  const TemporaryFolder folder;
  const std::string words = words_of_pulled(folder, "  set Width = 14 mm\n  set Height = 14 mm\n",
                                            "  set Width = 24 mm\n  set Height = 48 mm\n  set Elements across = 2\n"
                                            "  set Elements along = 4\n");
  const fs::path page = folder / "out/report.html";
  for (const char* const wanted :
       {"The sample at its end", "share of the segments that are broken, in each cell, at the end",
        "Letters: the representative volumes drawn below", "the representative volumes (RVEs) that are drawn",
        "A, most damaged", "cell:point"})
    EXPECT_TRUE(has_words(words, wanted));
  EXPECT_EQ(words.find("class=\"absent\""), std::string::npos);
  for (const char* const name : {"sample.svg", "sample.pdf", "rves.png"})
    EXPECT_GT(fs::file_size(folder / "out/figures" / ("direct_tension_seed_1_" + std::string(name))), 4000u) << name;

  // The numbers of the table are those of the cracks: no point has more than A.
  std::map<std::string, int> n_broken;
  for (const double point : column(folder / "out/cracks.csv", "joint"))
    ++n_broken[fmt::format("{}:{}", int(point) / 4, int(point) % 4)];
  std::string line;
  std::istringstream rows(content(folder / "out/tables/rves_direct_tension_seed_1.csv"));
  std::getline(rows, line);
  const std::regex row("\"(.), (.*)\",\"?\\(.*\\) mm\"?,([0-9]+:[0-9]+),([0-9]+),.*");
  std::size_t n_rows = 0;
  for (; std::getline(rows, line); ++n_rows)
    {
      std::smatch found;
      ASSERT_TRUE(std::regex_match(line, found, row)) << line;
      EXPECT_EQ(std::stoi(found[4]), n_broken[found[3]]) << line;
      for (const auto& [place, n] : n_broken)
        EXPECT_TRUE(found[1] != "A" || n <= std::stoi(found[4])) << place;
    }
  EXPECT_GE(n_rows, 2u);
  expect_shown_in_a_browser(page);

  // The page shows the cells by any of their fields, and the numbers of one that is clicked.
  folder.write("probed.html", with_script(content(page), R"(addEventListener('load', () => {
    const sample = document.querySelector('.sample'), canvas = sample.querySelector('canvas');
    const select = sample.parentElement.querySelector('select'), before = canvas.toDataURL();
    select.value = 'stress_yy_Pa';
    select.dispatchEvent(new Event('change'));
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new MouseEvent('click', {clientX: box.left + 0.4 * box.width, clientY: box.top + 0.5 * box.height}));
    document.title = [canvas.toDataURL() !== before, sample.querySelector('.reading').textContent].join(' ');
  }))"));
  const std::string probed = title_of(Browser::show(folder / "probed.html", "--window-size=1280,6000 --dump-dom"));
  EXPECT_TRUE(std::regex_search(probed, std::regex("^true Cell [0-7]: .*stress yy [−0-9.]+ MPa"))) << probed;

  // A picture that is missing is reported in its place.
  fs::remove_all(folder / "out/points");
  run_to_end(folder, "report out", with_pictures);
  EXPECT_TRUE(has_words(page_words(page), "_grains.csv: cannot be read: No such file"));
  fs::remove_all(folder / "out/fields");
  run_to_end(folder, "report out", with_pictures);
  EXPECT_TRUE(has_words(page_words(page), "No picture of the sample"));
}

TEST(ReportOfASample, CutsACylinderAndDrawsItsRvesInSpace)
{
  const TemporaryFolder folder;
  const std::string words = words_of_pulled(folder, "  set Dimension = 3\n  set Width = 6 mm\n  set Height = 6 mm\n",
                                            "  set Geometry = axisymmetric\n  set Width = 12 mm\n  set Height = 24 mm\n"
                                            "  set Elements across = 1\n  set Elements along = 2\n");
  EXPECT_TRUE(has_words(words, "The left half is the mirror image of the right", "Grains behind the mid-plane"));
  EXPECT_EQ(words.find("class=\"absent\""), std::string::npos);
  EXPECT_GT(fs::file_size(folder / "out/figures/direct_tension_seed_1_rves.png"), 10'000u);
  EXPECT_TRUE(has_words(content(folder / "out/tables/rves_direct_tension_seed_1.csv"), "r = "));

  // A frame of the viewer for each RVE: 18 rem of 16 px, at two pixels each.
  const fs::path page = folder / "out/report.html";
  const std::string picture = content(folder / "out/figures/direct_tension_seed_1_rves.png");
  ASSERT_TRUE(picture.starts_with("\x89PNG"));
  const auto at = [&](const std::size_t k) { return std::size_t(static_cast<unsigned char>(picture[k])); };
  const std::size_t n_rves = summary_of(folder / "out")["tests"][0]["rves"].size();
  EXPECT_NEAR(double(256 * at(18) + at(19)), 2.0 * (288.0 * double(n_rves) + 16.0), 4.0);

  // Without Chromium the viewer takes the place of the picture, on the screen and on paper.
  run_to_end(folder, "report out", "PATH=" + (folder / "empty").string());
  EXPECT_FALSE(fs::exists(folder / "out/figures/direct_tension_seed_1_rves.png"));
  EXPECT_TRUE(
    has_words(content(page), "<noscript><p class=\"absent\">direct_tension_seed_1_rves.png is missing: Chromium"));
  const fs::path paper = folder / "paper.pdf";
  Browser::show(page, fmt::format("--virtual-time-budget=15000 --print-to-pdf='{}'", paper.string()));
  EXPECT_EQ(count(content(paper), "/Subtype /Image"), 1u);
}
} // namespace
} // namespace feldspar::tests
