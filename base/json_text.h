#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace feldspar
{
/// Parses JSON from outside. Throws InputError, which begins with the name of the file, for text that is no JSON (with line
/// and column), for names given twice, of which a parser would keep the last, and for more than 100 levels or 20 000 names
/// in an object.
nlohmann::ordered_json parse_json(const std::string& file, const std::string& text);
} // namespace feldspar
