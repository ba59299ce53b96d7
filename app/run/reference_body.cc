#include "app/run/reference_body.h"

#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"
#include "results/folder/result_folder.h"

#include <fmt/format.h>

#include <filesystem>

namespace feldspar
{
std::optional<BodyFigures> reference_body(const Input& input)
{
  if (input.reference_folder.empty())
    return std::nullopt;
  for (const Series& series : read_result_folder(input.reference_folder, test_kinds()))
    if (auto figures = body_figures(series))
      {
        figures->label = "reference " + std::filesystem::path(input.reference_folder).filename().string();
        return figures;
      }
  throw InputError(
    fmt::format("Report/Reference folder = {}: no test in it was made on grains", input.reference_folder));
}

std::vector<std::string> beside_reference_body(const Input& input, const std::vector<SpecimenReport>& bodies)
{
  const auto reference = reference_body(input);
  const auto own = body_figures("this run", bodies);
  if (!reference || !own)
    return {};
  std::vector<std::string> lines{as_text(*own), as_text(*reference)};
  if (const std::string remark = gap_remark(*own, *reference); !remark.empty())
    lines.push_back(remark);
  return lines;
}
} // namespace feldspar
