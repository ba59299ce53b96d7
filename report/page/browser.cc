#include "report/page/browser.h"

#include "base/readable_file.h"
#include "base/whole_file.h"

#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <unistd.h>

namespace feldspar
{
namespace
{
constexpr std::array browsers{"chromium", "google-chrome"};

/// Folder that goes with all that is in it.
struct ScratchFolder
{
  std::filesystem::path path;

  /// Makes it where temporary files are kept, or else in a folder that is there.
  explicit ScratchFolder(const std::filesystem::path& other)
  {
    std::error_code problem;
    const std::filesystem::path place = std::filesystem::temp_directory_path(problem);
    std::string name = ((problem ? other : place) / "feldspar-browser-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw OutputError(fmt::format("{}: no folder can be made there for the browser", name));
    path = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

/// Address of a file, in which every character but letters, digits and some signs is written as its number.
std::string address_of(const std::filesystem::path& file)
{
  std::string address = "file://";
  for (const char c : std::filesystem::absolute(file).string())
    if (std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/-_.~").find(c) != std::string_view::npos)
      address += c;
    else
      address += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return address;
}

std::string bytes_of_base64(std::string_view text)
{
  using namespace boost::archive::iterators;
  using Decoder = transform_width<binary_from_base64<std::string_view::const_iterator>, 8, 6>;
  text = text.substr(0, text.find('='));
  const std::size_t n_bytes = 3 * text.size() / 4;
  std::string bytes(n_bytes, '\0');
  std::copy_n(Decoder(text.begin()), n_bytes, bytes.begin());
  return bytes;
}
} // namespace

const char* browser()
{
  const auto* const found = std::ranges::find_if(browsers, is_installed);
  return found == browsers.end() ? nullptr : *found;
}

DrawnByBrowser drawn_by_browser(const std::filesystem::path& page, const std::string& fragment,
                                const int pixels_per_length, const std::chrono::milliseconds longest,
                                const std::function<bool()>& is_over)
{
  const ScratchFolder scratch(std::filesystem::absolute(page).parent_path());
  const std::filesystem::path text = scratch.path / "page";
  std::vector<std::string> command{browser(),
                                   "--headless=new",
                                   "--disable-gpu",
                                   "--enable-unsafe-swiftshader",
                                   "--disable-dev-shm-usage",
                                   "--hide-scrollbars",
                                   fmt::format("--force-device-scale-factor={}", pixels_per_length),
                                   "--window-size=1280,1600",
                                   "--user-data-dir=" + (scratch.path / "profile").string(),
                                   "--dump-dom"};
  if (geteuid() == 0)
    command.emplace_back("--no-sandbox"); // without which Chromium does not start for root
  command.push_back(address_of(page) + fragment);
  DrawnByBrowser drawn{run_program(command, scratch.path, longest, is_over, text), {}};
  if (drawn.end != ProgramEnd::done)
    return drawn;
  constexpr std::string_view begin = "<pre class=\"drawn\">";
  const std::string shown = content_of(text);
  for (std::size_t at = shown.find(begin); at != std::string::npos; at = shown.find(begin, at))
    {
      at += begin.size();
      drawn.files.push_back(bytes_of_base64(std::string_view(shown).substr(at, shown.find('<', at) - at)));
    }
  return drawn;
}
} // namespace feldspar
