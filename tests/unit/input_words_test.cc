// The grammar of the input stands in the command, in files of entries, and with callers from outside, who give entries
// (library/, interfaces/, Python): all other libraries name no section, no entry and no command. Messages name parameters
// by base/parameter_id.h, results by laboratory/named_entries.h.

#include "app/input/parameter_table.h"
#include "laboratory/named_entries.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
namespace
{
namespace fs = std::filesystem;

const fs::path source_root = FELDSPAR_SOURCE_DIR;

/// Stands in files, so that it cannot change.
constexpr std::string_view mark_of_specimen_files = R"(format_name = "feldspar specimen")";

/// The functions that return entries are where their names belong.
std::string without_entries(const std::string& source)
{
  std::istringstream lines(source);
  std::string rest;
  bool declares_entries = false;
  for (std::string line; std::getline(lines, line);)
    {
      const bool begins = line.starts_with("std::vector<Entry<") || line.starts_with("inline std::vector<Entry<");
      declares_entries = declares_entries || (begins && !line.ends_with(';'));
      if (!declares_entries && !begins && line.find(mark_of_specimen_files) == std::string::npos)
        rest += line + '\n';
      declares_entries = declares_entries && line != "}";
    }
  return rest;
}

/// Returns what stands between quotation marks, pieces that the compiler joins as one.
std::string strings_of(const std::string& source)
{
  std::string strings;
  bool inside = false;
  for (std::size_t i = 0; i < source.size(); ++i)
    if (inside && source[i] == '\\')
      strings += source[i++];
    else if (source[i] == '"')
      {
        const std::size_t next = source.find_first_not_of(" \n", i + 1);
        if (inside && next != std::string::npos && source[next] == '"')
          i = next;
        else
          {
            inside = !inside;
            strings += '\n';
          }
      }
    else if (inside)
      strings += source[i];
  return strings;
}

bool is_letter(const char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

bool has_words(const std::string& text, const std::string& words)
{
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at)
    if ((at == 0 || !is_letter(text[at - 1])) &&
        (at + words.size() == text.size() || words.ends_with('/') || !is_letter(text[at + words.size()])))
      return true;
  return false;
}

/// Names of the input that a source has: an entry with its section or a command anywhere, an entry of several words alone
/// in a string, a section alone as a string.
std::vector<std::string> names_of_input(const std::string& source)
{
  std::vector<std::string> found;
  const std::string text = without_entries(source);
  const std::string strings = strings_of(text);
  static const std::regex command("`feldspar [a-z]+");
  if (std::smatch match; std::regex_search(text, match, command))
    found.push_back(match.str());
  for (const std::string_view section : section_names())
    if (strings.find('\n' + std::string(section) + '\n') != std::string::npos && section.find(' ') != std::string::npos)
      found.emplace_back(section);
  for (const Parameter& parameter : parameter_table())
    if (has_words(text, parameter.name()) || has_words(strings, parameter.name()))
      found.push_back(parameter.name());
    else if (parameter.entry.find(' ') != std::string_view::npos && has_words(strings, std::string(parameter.entry)))
      found.emplace_back(parameter.entry);
  return found;
}

std::string content(const fs::path& path)
{
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(InputWords, StandInTheCommandAndInFilesOfEntries)
{
  std::size_t n_files = 0;
  for (const char* const top :
       {"base", "laboratory", "dem", "fem", "coupling", "results", "report", "calibration", "runs"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source_root / top))
      {
        const fs::path& path = entry.path();
        if ((path.extension() != ".h" && path.extension() != ".cc") || path.stem().string().ends_with("entries"))
          continue;
        ++n_files;
        for (const std::string& name : names_of_input(content(path)))
          ADD_FAILURE() << fs::relative(path, source_root) << " names " << name;
      }
  EXPECT_GT(n_files, 300u) << "next to nothing was read under " << source_root;
}

TEST(InputWords, AreFoundWhereTheyAre)
{
  const auto has = [](const std::string& source) { return !names_of_input(source).empty(); };
  EXPECT_TRUE(has(R"(throw InputError("Specimen/Width: too small");)"));
  EXPECT_TRUE(has("refuse(\"make it larger (Specimen/Minimum \"\n       \"radius)\");"));
  EXPECT_TRUE(has(R"(return "another Packing stress ratio may do";)"));
  EXPECT_TRUE(has("// as `feldspar rve` does\n"));
  EXPECT_TRUE(has("std::vector<Entry<P>> some()\n{\n}\n\nauto section = \"Smooth joint\";\n"));
  EXPECT_FALSE(has("std::vector<Entry<P>> some()\n{\n  return {number(\"Grip ratio\", \"as Tests/List\")};\n}\n"));
  EXPECT_FALSE(has("std::vector<Entry<P>> some();\n// Normal stiffness of a grain\nnamespace feldspar\n"));
}

TEST(InputWords, OfLibrariesAreThoseOfTheInput)
{
  for (const input_entries::EntryName& name : input_entries::all)
    EXPECT_NE(find_parameter(name.text()), nullptr) << name.text();
  EXPECT_EQ(in_words(parameter_id<&SpecimenParameters::minimum_radius>()), "Specimen/Minimum radius");
  EXPECT_EQ(entry_in_words(parameter_id<&SpecimenParameters::height>()), "Height");
  EXPECT_EQ(in_words(parameter_id<&SofteningFlatJointParameters::coordination_number, SofteningFlatJointParameters>()),
            "Softening flat joint/Coordination number");
  EXPECT_EQ(in_words(parameters_id<SmoothJointParameters>()), "Smooth joint");
  EXPECT_EQ(in_words(parameters_id<FlawParameters>()), "Flaws");
  EXPECT_EQ(in_words(parameters_id<TestKind>()), "Tests/List");
  EXPECT_EQ(in_words(parameter_id<&TestCase::confining_pressure>()), "Tests/Confinements");
  EXPECT_EQ(in_words(Work::strain_path), "`feldspar rve`");
}

TEST(InputWords, AreCarriedByAnErrorAsData)
{
  const ParameterError error(parameter_id<&SpecimenParameters::width>(), "3 mm", "must be at least 4 mm");
  EXPECT_EQ(error.what(), std::string("Specimen/Width = 3 mm: must be at least 4 mm"));
  EXPECT_TRUE(error.parameter == parameter_id<&SpecimenParameters::width>());
  EXPECT_EQ(error.parameter.name, "width");
  EXPECT_EQ(error.value, "3 mm");
  EXPECT_EQ(error.reason, "must be at least 4 mm");
}
} // namespace
} // namespace feldspar
