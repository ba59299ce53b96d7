#include "report/film.h"

#include "base/input_error.h"
#include "base/whole_file.h"
#include "report/page/browser.h"

namespace feldspar
{
void check_film_is_possible()
{
  if (browser() == nullptr)
    throw InputError("--film: Chromium, which makes the film, is not installed (package chromium)");
}

void write_film(const std::filesystem::path& page, const std::filesystem::path& file,
                const std::chrono::milliseconds longest)
{
  check_film_is_possible();
  const DrawnByBrowser drawn = drawn_by_browser(page, "#film", 1, longest, [] { return false; });
  if (drawn.end == ProgramEnd::hung)
    throw InputError("--film: {} did not end within {} s", browser(), std::chrono::duration<double>(longest).count());
  if (drawn.end != ProgramEnd::done)
    throw InputError("--film: {} cannot open {}", browser(), page.string());
  if (drawn.files.empty())
    throw InputError("--film: {} shows no specimen with cracks, or {} has no WebGL 2", page.string(), browser());
  write_whole_file(file, drawn.files.front());
}
} // namespace feldspar
