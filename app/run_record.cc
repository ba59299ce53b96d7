#include "app/run_record.h"

#include "dem/input_error.h"
#include "report/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <system_error>

namespace feldspar
{
namespace
{
constexpr const char* record_name = "run.json";

/// JSON input keeps its ending: the ending tells how to read it.
std::filesystem::path copy_of_input(const std::filesystem::path& folder, const std::filesystem::path& input_file)
{
  return folder / ("input" + input_file.extension().string());
}
} // namespace

void write_run_record(const std::filesystem::path& input_file, const std::filesystem::path& folder)
{
  std::ifstream in(input_file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  write_text_file(copy_of_input(folder, input_file), text);
  nlohmann::ordered_json json;
  json["input_file"] = input_file.string();
  json["relative_to"] = std::filesystem::absolute(input_file).parent_path().string();
  write_text_file(folder / record_name, json.dump(2) + "\n");
}

void remove_run_record(const std::filesystem::path& folder)
{
  std::error_code ignored;
  std::filesystem::remove(folder / record_name, ignored);
  for (const char* name : {"input.prm", "input.json"})
    std::filesystem::remove(folder / name, ignored);
}

RunRecord read_run_record(const std::filesystem::path& folder)
{
  std::ifstream in(folder / record_name);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("input_file") || !json.contains("relative_to"))
    throw InputError(fmt::format("--resume {}: not the folder of a `feldspar lab` run; {} is missing in it or damaged",
                                 folder.string(), record_name));
  RunRecord run;
  run.input_file = json["input_file"].get<std::string>();
  run.input = read_input(copy_of_input(folder, run.input_file), json["relative_to"].get<std::string>());
  return run;
}
} // namespace feldspar
