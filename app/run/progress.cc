#include "app/run/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace feldspar
{
namespace
{
using namespace std::chrono_literals;

constexpr int bar_length = 10;

std::size_t terminal_width()
{
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string bar(const double fraction)
{
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * bar_length);
  return fmt::format("[{:#<{}}{:.<{}}] ", "", full, "", bar_length - full);
}

std::string clock_text(const std::chrono::duration<double> time)
{
  return fmt::format("{:%H:%M:%S}", std::chrono::duration_cast<std::chrono::seconds>(time));
}
} // namespace

Progress::Progress(const bool quiet)
  : is_quiet(quiet)
  , on_terminal(isatty(STDOUT_FILENO))
{
}

void Progress::start(const std::string_view new_title)
{
  title = new_title;
  started = Clock::now();
  drawn = started;
  draw({fmt::format("{} ...", title)}, false);
}

void Progress::update(const double fraction, const std::string_view text, const std::vector<ProgressDetail>& details)
{
  const auto now = Clock::now();
  if (is_quiet || now - drawn < (on_terminal ? 100ms : 5000ms))
    return;
  drawn = now;
  std::string line = fmt::format("{}: ", title);
  if (!std::isnan(fraction))
    line += fmt::format("{}{:.0f} %, ", on_terminal ? bar(fraction) : "", 100.0 * fraction);
  if (fraction >= 0.001) // before that the guess is worth nothing
    line += fmt::format("{} left, ", clock_text((now - started) * ((1.0 - fraction) / fraction)));
  line += text;
  std::vector<std::string> lines{line};
  for (const auto& detail : details)
    lines.push_back(
      fmt::format("  {}{}", on_terminal ? bar(std::isnan(detail.fraction) ? 0.0 : detail.fraction) : "", detail.text));
  draw(lines, false);
}

void Progress::finish(const std::string_view text)
{
  draw({fmt::format("{}: {} ({})", title, text, clock_text(Clock::now() - started))}, true);
}

void Progress::draw(const std::vector<std::string>& lines, const bool last)
{
  if (is_quiet)
    return;
  std::string text;
  if (!on_terminal)
    text = fmt::format("{}\n", fmt::join(lines, "\n"));
  else
    {
      // Back to the first line of the last drawing, and clear from there down.
      if (n_lines_above > 0)
        text += fmt::format("\x1b[{}A", n_lines_above);
      text += "\r\x1b[J";
      for (std::size_t k = 0; k < lines.size(); ++k)
        text += fmt::format("{}{}", k > 0 ? "\n" : "", lines[k].substr(0, terminal_width() - 1));
      if (last)
        text += "\n";
      n_lines_above = last ? 0 : lines.size() - 1;
    }
  // Who reads along and goes away, or a full disk behind standard output, does not end the work.
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}
} // namespace feldspar
