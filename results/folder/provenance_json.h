#pragma once

#include "results/runs/run.h"
#include "results/variant_setting.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// The layout of summary.json. A key that is renamed or gone raises it; layout 1 had `volumes` for `rves`.
inline constexpr int summary_schema_version = 2;
/// The oldest layout that is read in full.
inline constexpr int oldest_summary_schema_version = 1;

/// Beginning of every summary.json: layout, program, input and machine.
nlohmann::ordered_json as_json(const Provenance& provenance);

/// Whole numbers are written as such.
nlohmann::ordered_json json_number(double value);

/// A result file of this content, with its last line ended. JSON has no nan and no inf: they are null with a `_reason` beside
/// them, in lists null alone. Text that is not UTF-8 is replaced.
std::string json_text(const nlohmann::ordered_json& json);

/// The values of a variant, by entry: a number with the unit it was written in, or the words.
nlohmann::ordered_json as_json(const std::vector<VariantSetting>& settings);

/// The same read back; what is not so described is left out.
std::vector<VariantSetting> read_settings(const nlohmann::ordered_json& json);

/// Reads the provenance as far as it is there.
Provenance read_provenance(const nlohmann::ordered_json& summary);

/// A text by its key; empty if there is none.
std::string text_of(const nlohmann::ordered_json& json, std::string_view key);
} // namespace feldspar
