#include "report/provenance_json.h"

namespace feldspar
{
nlohmann::ordered_json as_json(const Provenance& provenance)
{
  nlohmann::ordered_json json;
  json["schema_version"] = summary_schema_version;
  json["feldspar_version"] = provenance.version;
  json["commit"] = provenance.commit;
  json["input"]["file"] = provenance.input_file;
  for (const auto& entry : provenance.input)
    json["input"]["parameters"][entry.section][entry.entry] = entry.value;
  json["host"]["processor"] = provenance.processor;
  json["host"]["threads"] = provenance.n_threads;
  return json;
}
} // namespace feldspar
