#pragma once

#include "report/run.h"

#include <nlohmann/json.hpp>

namespace feldspar
{
/// The layout of summary.json.
inline constexpr int summary_schema_version = 1;

/// How every summary.json begins: layout, program, input and machine.
nlohmann::ordered_json as_json(const Provenance& provenance);
} // namespace feldspar
