#include "app/run/provenance.h"

#include "app/input/parameter_table.h"
#include "base/parallel.h"
#include "base/ranks/ranks.h"
#include "feldspar_version.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace feldspar
{
namespace
{
std::string processor_name()
{
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

/// The value of an entry as the input has it: a file is named from the folder of the input, wherever that lies on this
/// machine.
std::string as_in_input(const std::string& value, const std::filesystem::path& folder)
{
  const std::string beginning = (folder / "").string();
  if (!beginning.empty() && value.starts_with(beginning))
    return value.substr(beginning.size());
  std::error_code ignored; // Input::file_named finds a file above a folder that is gone
  const bool is_above = folder.is_absolute() && !std::filesystem::exists(folder, ignored) &&
                        value.starts_with((folder.parent_path() / "").string());
  return is_above ? std::filesystem::path(value).lexically_relative(folder).string() : value;
}
} // namespace

Provenance provenance(const Input& input, const std::filesystem::path& input_file)
{
  Provenance result;
  result.version = version;
  result.commit = commit;
  result.input_file = input_file.filename().string();
  const std::vector<Variant> all = variants(input);
  for (const auto& parameter : parameter_table())
    if (std::ranges::any_of(all, [&](const Variant& variant) { return has_use_for(variant.input, parameter); }))
      result.input.push_back({std::string(parameter.section), std::string(parameter.entry),
                              as_in_input(parameter.write(input), input.folder)});
  result.processor = processor_name();
  result.n_processes = ranks::number();
  result.n_threads = unsigned(number_of_threads());
  return result;
}
} // namespace feldspar
