#include "app/programme/reference_body.h"

#include "base/input_error.h"
#include "dem/lab/protocols/protocols.h"
#include "results/folder/result_folder.h"

#include <filesystem>

namespace feldspar
{
std::optional<BodyFigures> reference_body(const Input& input)
{
  if (input.reference_results.empty())
    return std::nullopt;
  const auto folder = std::filesystem::path(input.reference_results).parent_path();
  for (const Series& series : read_result_folder(folder, test_kinds()))
    if (auto figures = body_figures(series))
      {
        figures->label = "reference " + folder.filename().string();
        return figures;
      }
  throw InputError("Report/Reference results = {}: no test in it was made on grains", input.reference_results);
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
