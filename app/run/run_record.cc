#include "app/run/run_record.h"

#include "app/input/parameter_table.h"
#include "app/run/run.h"
#include "base/checksum/fingerprint.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/readable_file.h"
#include "base/whole_file.h"
#include "feldspar_version.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
constexpr const char* record_name = "run.json";
constexpr const char* by_value = "by value";
constexpr const char* by_number = "by number";

/// JSON input keeps its ending: the ending tells how to read it.
std::filesystem::path copy_of_input(const std::filesystem::path& folder, const std::filesystem::path& input_file)
{
  return folder / ("input" + input_file.extension().string());
}

struct Contents
{
  std::string command;
  std::filesystem::path input_file;
  std::filesystem::path relative_to; ///< the folder of the input
  std::vector<std::string> settings;
  bool variants_by_value = true; ///< how their files are named; not in the folders of before they were
  std::string input_checksum;    ///< of the copy of the input; empty in the folders of before there were any
  std::map<std::string, std::string> checksums; ///< those of the files that the input names
  bool complete = false;
  std::string failure;
  int code_of_failure = 0;
};

/// The checksum of all that tells which rock and tests a resumed run goes on with. It leaves out whether the list is
/// complete and how its files are named, because these change no result.
std::string checksum_of(const Contents& contents)
{
  Fingerprint print;
  const auto add = [&](const std::string& text) {
    print.add(std::uint64_t(text.size()));
    print.add(text);
  };
  add(contents.command);
  add(contents.input_file.string());
  add(contents.relative_to.string());
  for (const std::string& setting : contents.settings)
    add(setting);
  add(contents.input_checksum);
  for (const auto& [file, checksum] : contents.checksums)
    {
      add(file);
      add(checksum);
    }
  return fmt::format("{:016x}", print.value());
}

/// The checksum of a file's bytes.
std::string checksum_of(const std::filesystem::path& file)
{
  ReadableFile stream(file);
  Fingerprint print;
  std::vector<char> piece(std::size_t(1) << 20);
  while (stream.read(piece.data(), std::streamsize(piece.size())) || stream.gcount() > 0)
    print.add(std::string_view(piece.data(), std::size_t(stream.gcount())));
  return fmt::format("{:016x}", print.value());
}

void write(const std::filesystem::path& folder, const Contents& contents)
{
  nlohmann::ordered_json json;
  json["command"] = contents.command;
  json["input_file"] = contents.input_file.string();
  json["relative_to"] = contents.relative_to.string();
  json["settings"] = contents.settings;
  json["variants_named"] = contents.variants_by_value ? by_value : by_number;
  json["input_checksum"] = contents.input_checksum;
  json["checksums"] = contents.checksums;
  json["complete"] = contents.complete;
  if (!contents.failure.empty())
    {
      json["failure"] = contents.failure;
      json["exit_code"] = contents.code_of_failure;
    }
  json["checksum"] = checksum_of(contents);
  write_whole_file(folder / record_name, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Contents read(const std::filesystem::path& folder)
{
  const std::filesystem::path file = folder / record_name;
  nlohmann::json json;
  Contents contents;
  try
    {
      json = nlohmann::json::parse(std::filesystem::exists(file) ? content_of(file) : std::string());
      // Older runs have no settings, names of variants, checksums.
      contents = {json.at("command").get<std::string>(),
                  json.at("input_file").get<std::string>(),
                  json.at("relative_to").get<std::string>(),
                  json.value("settings", contents.settings),
                  json.value("variants_named", "") == by_value,
                  json.value("input_checksum", ""),
                  json.value("checksums", contents.checksums),
                  json.at("complete").get<bool>(),
                  json.value("failure", ""),
                  json.value("exit_code", exit_code::user_error)};
    }
  catch (const nlohmann::json::exception&)
    {
      throw InputError("{}: not the folder of a run; {} is missing in it or damaged", folder.string(), record_name);
    }
  if (json.contains("checksum") && json["checksum"] != checksum_of(contents))
    throw InputError("{}: {} in it is not as the run wrote it; undo the change, or begin another run", folder.string(),
                     record_name);
  return contents;
}
} // namespace

std::vector<std::filesystem::path> named_files(const Input& input)
{
  std::vector<std::filesystem::path> files;
  for (const Variant& variant : variants(input))
    for (const Parameter& parameter : parameter_table())
      if (parameter.range == none_or_a_file)
        if (const std::string value = parameter.write(variant.input);
            value != none && !contains(files, std::filesystem::path(value)))
          files.emplace_back(value);
  return files;
}

void write_run_record(const std::string& command, const Input& input, const std::filesystem::path& input_file,
                      const std::vector<std::string>& settings, const std::filesystem::path& folder)
{
  std::map<std::string, std::string> checksums;
  for (const std::filesystem::path& file : named_files(input))
    checksums[std::filesystem::absolute(file).lexically_normal().string()] = checksum_of(file);
  write_whole_file(copy_of_input(folder, input_file), content_of(input_file));
  write(folder, {command, input_file, std::filesystem::absolute(input_file).parent_path(), settings, true,
                 checksum_of(copy_of_input(folder, input_file)), checksums, false, "", 0});
}

std::string run_identity(const Input& input, const std::string& part)
{
  // A run that is resumed names its files from the root: its input has another folder than it had at first.
  const auto text_of = [&](const Parameter& parameter) {
    const std::string value = parameter.write(input);
    return parameter.range == none_or_a_file && value != "none"
             ? std::filesystem::absolute(value).lexically_normal().string()
             : value;
  };
  std::string text = fmt::format("{} {}\n", version, part);
  for (const Parameter& parameter : parameter_table())
    if (has_use_for(input, parameter))
      text += fmt::format("{} = {}\n", parameter.name(), text_of(parameter));
  return text;
}

void mark_complete(const std::filesystem::path& folder, const std::string& failure, const int code_of_failure)
{
  Contents contents = read(folder);
  contents.complete = true;
  contents.failure = failure;
  contents.code_of_failure = code_of_failure;
  write(folder, contents);
}

RunRecord read_run_record(const std::string& command, const std::filesystem::path& folder, const bool goes_on)
{
  const Contents contents = read(folder);
  if (contents.command != command)
    throw InputError("{}: a run of `feldspar {}`; take it up with that", folder.string(), contents.command);
  const std::filesystem::path copy = copy_of_input(folder, contents.input_file);
  const auto check = [&](const std::filesystem::path& file, const std::string& checksum) {
    if (checksum_of(file) != checksum)
      throw InputError("{}: {} is not as it was when the run began (its checksum differs); put it "
                       "back, or begin a new run",
                       folder.string(), file.string());
  };
  if (!contents.complete)
    {
      if (!contents.input_checksum.empty())
        check(copy, contents.input_checksum);
      for (const auto& [file, checksum] : contents.checksums)
        check(file, checksum);
    }
  const std::filesystem::path named = contents.relative_to / contents.input_file.filename();
  std::string remark;
  if (objection_to_reading(named).empty() && checksum_of(named) != checksum_of(copy))
    remark = fmt::format("{}: has changed since the run began, and is not read; the run goes by {}", named.string(),
                         copy.string());
  Input input = read_input(copy, contents.relative_to, contents.settings);
  input.variants.named_by_number = !contents.variants_by_value;
  if (goes_on)
    for (const auto& [file, checksum] : contents.checksums)
      if (file != input.reference_file && file != input.reference_results) // beside the results
        check(file, checksum);
  return {std::move(input), contents.input_file,      contents.complete,
          contents.failure, contents.code_of_failure, std::move(remark)};
}
} // namespace feldspar
