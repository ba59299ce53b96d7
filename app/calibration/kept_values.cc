#include "app/calibration/kept_values.h"

#include "app/run/run_record.h"
#include "base/checksum/seal.h"

#include <nlohmann/json.hpp>

namespace feldspar::calibration
{
KeptValues::KeptValues(const std::filesystem::path& folder, const std::string& name, const Input& rock)
  : file(folder / "calibration" / (name + ".json"))
  , identity(run_identity(rock, name))
{
}

std::optional<KeptValues::Values> KeptValues::read(const std::size_t n) const
{
  const auto content = read_sealed(file);
  if (!content)
    return std::nullopt;
  const auto json = nlohmann::ordered_json::parse(*content, nullptr, false);
  if (!json.is_object() || !json.contains("identity") || json["identity"] != identity || !json.contains("values") ||
      !json["values"].is_array() || json["values"].size() != n)
    return std::nullopt; // of another program or input: it is made again
  Values values;
  for (const auto& value : json["values"])
    {
      if (!value.is_number() && !value.is_null())
        return std::nullopt;
      values.push_back(value.is_number() ? std::optional(value.get<double>()) : std::nullopt);
    }
  return values;
}

void KeptValues::write(const Values& values) const
{
  nlohmann::ordered_json json{{"seal", seal_notice},
                              {"identity", identity},
                              {"values", nlohmann::ordered_json::array()}};
  for (const auto& value : values)
    json["values"].push_back(value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json());
  std::filesystem::create_directories(file.parent_path());
  write_sealed(file, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}
} // namespace feldspar::calibration
