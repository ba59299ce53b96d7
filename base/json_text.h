#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace feldspar
{
/// Parses JSON that a user wrote. Throws InputError, which begins with the name of the file, for text that is no JSON
/// (with line and column) and for names given twice, of which a parser would keep the last.
nlohmann::ordered_json parse_json(const std::string& file, const std::string& text);
} // namespace feldspar
