#include "results/folder/tests_table.h"

#include "base/mapped.h"
#include "base/whole_file.h"
#include "results/runs/quantity_values.h"
#include "results/varied_columns.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace feldspar
{
namespace
{
/// Text of a cell, with quotes where a reader of CSV needs them.
std::string cell(const std::string& text)
{
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}
} // namespace

void write_tests(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  const auto settings = mapped<std::vector<VariantSetting>>(tests, [](const auto& test) { return test.settings; });
  const std::vector<VariedColumn> varied = varied_columns(settings);
  std::string text = "name,kind,seed";
  for (const VariedColumn& column : varied)
    text += fmt::format(",{}", cell(column.heading()));
  for (const TestQuantity& quantity : test_quantities)
    text += fmt::format(",{}", quantity.name);
  text += "\n";
  for (const auto& test : tests)
    {
      text += fmt::format("{},{},{}", cell(test.name), test.record.kind.name, test.record.seed);
      for (const VariedColumn& column : varied)
        text += fmt::format(",{}", cell(column.cell(test.settings)));
      for (const TestQuantity& quantity : test_quantities)
        {
          const Figure figure = value_of(quantity, test);
          text += figure.value && std::isfinite(*figure.value) ? fmt::format(",{:.10g}", *figure.value) : ",";
        }
      text += "\n";
    }
  write_whole_file(file, text);
}
} // namespace feldspar
