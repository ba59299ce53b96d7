#include "app/screen/progress.h"

#include "app/screen/print_result.h"
#include "base/quoted.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace feldspar
{
namespace
{
using namespace std::chrono_literals;

constexpr int bar_length = 10;

/// Prints on standard error, without an exception if nobody reads it or the disk is full.
void say(const std::string& text) { std::fputs(text.c_str(), stderr); }

constexpr std::size_t page_width = 80; // of a file or pipe

std::size_t width_of_lines(const bool on_terminal)
{
  winsize size{};
  const bool known = on_terminal && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1u : page_width;
}

std::string bar(const double fraction)
{
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * bar_length);
  return fmt::format("[{:#<{}}{:.<{}}] ", "", full, "", bar_length - full);
}

/// A name cut in its middle: names of several tests begin alike, so that the end tells more.
std::string beginning_and_end(const std::string& name, const std::size_t most_characters)
{
  if (name.size() <= most_characters)
    return name;
  const std::size_t at_end = 2 * most_characters / 3;
  return fmt::format("{}…{}", name.substr(0, most_characters - at_end - 1), name.substr(name.size() - at_end));
}

std::string clock_text(const std::chrono::duration<double> time)
{
  return fmt::format("{:%H:%M:%S}", std::chrono::duration_cast<std::chrono::seconds>(time));
}
} // namespace

Progress::Progress(const bool quiet)
  : is_quiet(quiet)
  , on_terminal(isatty(STDERR_FILENO))
{
}

void Progress::start(const std::string_view new_title)
{
  title = new_title;
  started = Clock::now();
  drawn = started;
  fraction_at_start = std::numeric_limits<double>::quiet_NaN();
  draw({fmt::format("{} ...", title)}, false);
}

void Progress::update(const double fraction, const std::string_view text, const std::vector<ProgressDetail>& details)
{
  if (std::isnan(fraction_at_start))
    fraction_at_start = fraction;
  const auto now = Clock::now();
  if (is_quiet || now - drawn < (on_terminal ? 100ms : 5000ms))
    return;
  drawn = now;
  std::string line = fmt::format("{}: ", title);
  if (!std::isnan(fraction))
    line += fmt::format("{}{:.0f} %, ", on_terminal ? bar(fraction) : "", 100.0 * fraction);
  if (const double done = fraction - fraction_at_start; done >= 0.001) // before that the guess is worth nothing
    line += fmt::format("{} left, ", clock_text((now - started) * ((1.0 - fraction) / done)));
  line += text;
  std::vector<std::string> lines{line};
  for (const auto& detail : details)
    {
      const std::string start = on_terminal ? bar(std::isnan(detail.fraction) ? 0.0 : detail.fraction) : "";
      constexpr std::size_t least = 12; // of a name
      const std::size_t others = 4 + start.size() + detail.text.size();
      const std::size_t width = width_of_lines(on_terminal);
      const std::string name = beginning_and_end(detail.name, width > others + least ? width - others : least);
      lines.push_back(fmt::format("  {}{}: {}", start, name, detail.text));
    }
  draw(lines, false);
}

void Progress::finish(const std::string_view text)
{
  draw({fmt::format("{}: {} ({})", title, text, clock_text(Clock::now() - started))}, true);
}

void Progress::note(const std::string_view text)
{
  if (on_terminal && !is_quiet)
    clear();
  const std::string line = fmt::format("feldspar: {}\n", text);
  say(on_terminal ? wrapped(line, width_of_lines(on_terminal)) : line);
}

void Progress::remark(const std::string_view text)
{
  if (is_quiet)
    return;
  if (on_terminal)
    clear();
  say(fmt::format("{}\n", wrapped(text, width_of_lines(on_terminal))));
}

/// Back to the first line of the last drawing, and all of it away from there down.
void Progress::clear()
{
  if (n_lines_above > 0)
    say(fmt::format("\x1b[{}A", n_lines_above));
  say("\r\x1b[J");
  n_lines_above = 0;
}

void Progress::draw(const std::vector<std::string>& lines, const bool last)
{
  if (is_quiet)
    return;
  const std::size_t width = width_of_lines(on_terminal);
  if (on_terminal)
    clear();
  for (std::size_t k = 0; k < lines.size(); ++k)
    say(fmt::format("{}{}", k > 0 ? "\n" : "", excerpt(lines[k], width)));
  if (!on_terminal || last)
    say("\n");
  else
    n_lines_above = lines.size() - 1;
  std::fflush(stderr);
}
} // namespace feldspar
