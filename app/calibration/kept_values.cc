#include "app/calibration/kept_values.h"

#include "base/checksum/seal.h"

#include <nlohmann/json.hpp>

namespace feldspar::calibration
{
std::optional<KeptValues> read_values(const std::filesystem::path& file, const std::string& identity,
                                      const std::size_t n)
{
  const auto content = read_sealed(file);
  if (!content)
    return std::nullopt;
  const auto json = nlohmann::ordered_json::parse(*content, nullptr, false);
  if (!json.is_object() || !json.contains("identity") || json["identity"] != identity || !json.contains("values") ||
      !json["values"].is_array() || json["values"].size() != n)
    return std::nullopt; // of another program or input: it is made again
  KeptValues values;
  for (const auto& value : json["values"])
    {
      if (!value.is_number() && !value.is_null())
        return std::nullopt;
      values.push_back(value.is_number() ? std::optional(value.get<double>()) : std::nullopt);
    }
  return values;
}

void write_values(const std::filesystem::path& file, const std::string& identity, const KeptValues& values)
{
  nlohmann::ordered_json json{{"seal", seal_notice},
                              {"identity", identity},
                              {"values", nlohmann::ordered_json::array()}};
  for (const auto& value : values)
    json["values"].push_back(value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json());
  write_sealed(file, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}
} // namespace feldspar::calibration
