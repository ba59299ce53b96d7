#include "report/film.h"

#include "base/input_error.h"
#include "base/readable_file.h"
#include "base/system/program.h"
#include "base/whole_file.h"

#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace feldspar
{
namespace
{
constexpr std::array browsers{"chromium", "google-chrome"};

/// Name of the first browser that is installed; null without any.
const char* browser()
{
  const auto* const found = std::find_if(browsers.begin(), browsers.end(), is_installed);
  return found == browsers.end() ? nullptr : *found;
}
/// Folder that goes with all that is in it.
class ScratchFolder
{
public:
  ScratchFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "feldspar-film-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw OutputError(fmt::format("{}: no folder can be made there for the film", name));
    folder = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }

  const std::filesystem::path& path() const { return folder; }

private:
  std::filesystem::path folder;
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

void check_film_is_possible()
{
  if (browser() == nullptr)
    throw InputError("--film: Chromium, which makes the film, is not installed (package chromium)");
}

void write_film(const std::filesystem::path& page, const std::filesystem::path& file,
                const std::chrono::milliseconds longest)
{
  check_film_is_possible();
  const ScratchFolder scratch;
  const std::filesystem::path text = scratch.path() / "page";
  std::vector<std::string> command{browser(),
                                   "--headless=new",
                                   "--disable-gpu",
                                   "--enable-unsafe-swiftshader",
                                   "--disable-dev-shm-usage",
                                   "--hide-scrollbars",
                                   "--force-device-scale-factor=1",
                                   "--window-size=1280,1600",
                                   "--user-data-dir=" + (scratch.path() / "profile").string(),
                                   "--dump-dom"};
  if (geteuid() == 0)
    command.emplace_back("--no-sandbox"); // without which Chromium does not start for root
  command.push_back(address_of(page) + "#film");
  const ProgramEnd end = run_program(
    command, scratch.path(), longest, [] { return false; }, text);
  if (end == ProgramEnd::hung)
    throw InputError(
      fmt::format("--film: {} did not end within {} s", browser(), std::chrono::duration<double>(longest).count()));
  if (end != ProgramEnd::done)
    throw InputError(fmt::format("--film: {} cannot open {}", browser(), page.string()));
  constexpr std::string_view begin = "<pre id=\"film\">";
  const std::string shown = content_of(text);
  const std::size_t at = shown.rfind(begin);
  if (at == std::string::npos)
    throw InputError(
      fmt::format("--film: {} shows no specimen with cracks, or {} has no WebGL 2", page.string(), browser()));
  const std::size_t from = at + begin.size();
  write_whole_file(file, bytes_of_base64(std::string_view(shown).substr(from, shown.find('<', from) - from)));
}
} // namespace feldspar
