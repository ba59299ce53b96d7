#pragma once

#include "report/run.h"

#include <nlohmann/json.hpp>

namespace feldspar
{
/// How every summary.json begins: layout, program, input and machine.
nlohmann::ordered_json as_json(const Provenance& provenance);
} // namespace feldspar
