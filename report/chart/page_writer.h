#pragma once

#include "report/chart/chart.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

/// The data that the script of the page (report/page/page.js) draws from, in JSON.
namespace feldspar::live
{
/// The chart with its values under the pointer: five digits of each number, `null` in gaps. Empty for a chart of which the
/// page shows the picture alone: with circles, segments, texts or values by colour.
std::string chart_data(const Chart& chart);

/// Text of the data in which no tag can begin, so that it may stand in a page. Bytes that are not UTF-8 are replaced.
std::string text(const nlohmann::ordered_json& data);

/// Bytes as text of letters, digits, + and /.
std::string base64(const std::string& bytes);

/// Number with so many digits; null if the value is none.
nlohmann::ordered_json number(double value, int digits = 5);
} // namespace feldspar::live
