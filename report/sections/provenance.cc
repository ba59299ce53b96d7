#include "report/sections/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
/// Texts of the head of a report beside its title, with their words there.
constexpr std::pair<const char*, input_entries::EntryName> labels[] = {{"Client", input_entries::report_client},
                                                                       {"Specimen", input_entries::report_specimen},
                                                                       {"Author", input_entries::report_author},
                                                                       {"Date", input_entries::report_date}};

/// Entries of the input but for texts of the head of a report that are not there.
std::vector<InputEntry> told_entries(const Provenance& made_by)
{
  const auto is = [](const InputEntry& one, const input_entries::EntryName& name) {
    return one.section == name.section && one.entry == name.entry;
  };
  std::vector<InputEntry> told = made_by.input;
  std::erase_if(told, [&](const InputEntry& one) {
    return one.value == "none" &&
           (is(one, input_entries::report_title) ||
            std::ranges::any_of(labels, [&](const auto& label) { return is(one, label.second); }));
  });
  return told;
}
} // namespace

std::string sentence_of(const Provenance& made_by)
{
  const auto or_unknown = [](const std::string& text, const char* unknown) { return text.empty() ? unknown : text; };
  return fmt::format(
    "Made by feldspar {}{} from {} on {}, {}{} thread{}.", or_unknown(made_by.version, "of unknown version"),
    made_by.commit.empty() ? "" : ", commit " + made_by.commit, or_unknown(made_by.input_file, "an unknown input"),
    or_unknown(made_by.processor, "an unknown processor"),
    made_by.n_processes > 1 ? fmt::format("{} processes of ", made_by.n_processes) : "", made_by.n_threads,
    made_by.n_threads == 1 ? "" : "s");
}

std::string labels_of(const Provenance& made_by)
{
  std::string line;
  for (const auto& [word, entry] : labels)
    if (const std::string label = made_by.label_of(entry); !label.empty())
      line += fmt::format("{}{}: {}", line.empty() ? "" : " · ", word, label);
  return line;
}

std::string paper_head_of(const Provenance& made_by, const std::string& rock)
{
  if (labels_of(made_by).empty() && made_by.label_of(input_entries::report_title).empty())
    return "";
  std::string line = rock;
  for (const auto& entry : {input_entries::report_date, input_entries::report_specimen})
    if (const std::string label = made_by.label_of(entry); !label.empty())
      line += (line.empty() ? "" : " · ") + label;
  return line;
}

Table input_table(const Provenance& made_by, const std::string& name)
{
  Table table{name, "Input as it was understood", {"section", "entry", "value"}};
  for (const auto& entry : told_entries(made_by))
    table.rows.push_back({entry.section, entry.entry, entry.value});
  return table;
}

Table input_table(const Provenance& made_by, const std::string& name, const Provenance& first, const std::string& label)
{
  using Place = std::pair<std::string, std::string>;
  std::map<Place, std::string> of_first;
  for (const auto& entry : told_entries(first))
    of_first[{entry.section, entry.entry}] = entry.value;
  Table table{name, fmt::format("Input where it differs from that of {}", label), {"section", "entry", "value", label}};
  for (const auto& entry : told_entries(made_by))
    {
      const auto there = of_first.extract(Place{entry.section, entry.entry});
      if (there.empty() || there.mapped() != entry.value)
        table.rows.push_back({entry.section, entry.entry, entry.value, there.empty() ? "–" : there.mapped()});
    }
  for (const auto& [place, value] : of_first)
    table.rows.push_back({place.first, place.second, "–", value});
  return table;
}
} // namespace feldspar
