#include "report/sections/provenance.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace feldspar
{
std::string sentence_of(const Provenance& made_by)
{
  const auto or_unknown = [](const std::string& text, const char* unknown) { return text.empty() ? unknown : text; };
  return fmt::format(
    "Made by feldspar {}{} from {} on {}, {} thread{}.", or_unknown(made_by.version, "of unknown version"),
    made_by.commit.empty() ? "" : ", commit " + made_by.commit, or_unknown(made_by.input_file, "an unknown input"),
    or_unknown(made_by.processor, "an unknown processor"), made_by.n_threads, made_by.n_threads == 1 ? "" : "s");
}

Table input_table(const Provenance& made_by, const std::string& name)
{
  Table table{name, "Input as it was understood", {"section", "entry", "value"}, {}};
  for (const auto& entry : made_by.input)
    table.rows.push_back({entry.section, entry.entry, entry.value});
  return table;
}

Table input_table(const Provenance& made_by, const std::string& name, const Provenance& first, const std::string& label)
{
  using Place = std::pair<std::string, std::string>;
  std::map<Place, std::string> of_first;
  for (const auto& entry : first.input)
    of_first[{entry.section, entry.entry}] = entry.value;
  Table table{name,
              fmt::format("Input where it differs from that of {}", label),
              {"section", "entry", "value", label},
              {}};
  for (const auto& entry : made_by.input)
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
