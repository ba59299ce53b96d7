#pragma once

#include "base/system/program.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Chromium, by which the script of a page draws without a screen.
namespace feldspar
{
/// Name of the first browser that is installed; null without any.
const char* browser();

/// Files that the script of a page drew.
struct DrawnByBrowser
{
  ProgramEnd end;
  std::vector<std::string> files;
};

/// Opens a page with a fragment ("#film") in browser(), which must not be null, and takes what its script hands over: an
/// element `<pre class="drawn">` with a file in base64 for each (report/page/page.js). A length of CSS is drawn with so many
/// pixels.
DrawnByBrowser drawn_by_browser(const std::filesystem::path& page, const std::string& fragment, int pixels_per_length,
                                std::chrono::milliseconds longest, const std::function<bool()>& is_over);
} // namespace feldspar
