#include "app/commands/commands.h"
#include "app/screen/print_result.h"
#include "coupling/rve/path_sample.h"
#include "results/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace feldspar
{
namespace
{
/// Words in the order of their enumerators.
constexpr const char* subjects[] = {"the loading", "the rock", "the specimen", "the method", "the effort"};
constexpr const char* sources[] = {"given, not compared", "direct tension", "uniaxial compression", "Brazilian test",
                                   "notched bodies",      "tilt",           "several tests"};
constexpr const char* places_in_summary[] = {"", "at the end", "at the end", "largest"};

std::string bound_of(const TestQuantity& quantity)
{
  if (!quantity.bound)
    return "";
  return fmt::format("{} {:g}", quantity.bound->side == BoundSide::at_most ? "at most" : "at least",
                     quantity.bound->value);
}

/// Begins a table of Markdown.
void begin(const std::string_view title, const std::string_view introduction, const std::string_view header)
{
  print_result("\n## {}\n\n{}\n\n{}\n|", title, introduction, header);
  for (auto n = std::ranges::count(header, '|'); n > 1; --n)
    print_result("---|");
  print_result("\n");
}
} // namespace

void print_results_reference()
{
  print_result("# Results\n\nWritten by `feldspar parameters --results`. The definitions are in "
               "[theory](theory.md#5-results).\n");
  begin(
    "Quantities of a test",
    "Each test of `summary.json` and each row of `tests.csv` has these keys, which end in their SI units. A quantity "
    "that a test does not give is null, with the reason beside it. Stress and strain are positive in the sense of the "
    "test.",
    "| key | title | of | tests | doubtful unless | meaning |");
  for (const TestQuantity& one : test_quantities)
    print_result("| `{}` | {} | {} | {} | {} | {} |\n", one.name, with_unit(one.title, one.shown.unit),
                 subjects[std::size_t(one.of)], one.tests.words, bound_of(one), one.meaning);
  begin(
    "Properties of the rock",
    "A reference file may give these, and the strengths that [the report](report.md#the-reference) names. The range is "
    "that of a rock. The last column has the names of targets of `feldspar calibrate`.",
    "| key | title | range | from | target |");
  for (const RockProperty& one : rock_properties)
    print_result("| `{}` | {} | {:g} to {:g} | {} | {} |\n", one.key, one.title, one.least, one.most,
                 sources[std::size_t(one.source)], one.scale ? one.target() : "");
  begin("Curves of tests", "Columns of `curves/TEST.csv`; stress and strain are positive in the sense of the test.",
        "| column | of | meaning |");
  for (const auto& one : curve_columns)
    print_result("| `{}` | {} | {} |\n", one.name, one.is(only_of_samples) ? "samples" : "all tests", one.meaning);
  begin("Curves of representative volumes",
        "Columns of `curves/rve.csv` of `feldspar rve`, after a strain and a stress of each component (`strain_xx`, "
        "`stress_xx_Pa`, …; tensor shear, tension positive). `summary.json` has some of them.",
        "| column | summary.json | meaning |");
  for (const auto& one : path_columns<2>)
    print_result("| `{}` | {} | {} |\n", one.name, places_in_summary[std::size_t(one.in_summary)], one.meaning);
}
} // namespace feldspar
