#include "app/screen/print_result.h"

#include "base/quoted.h"
#include "base/text.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

namespace feldspar
{
std::string printable_lines(std::string_view text)
{
  std::string result;
  while (!text.empty())
    {
      const std::size_t end = std::min(text.find_first_of("\n\t"), text.size());
      result += printable(text.substr(0, end));
      if (end < text.size())
        result += text[end];
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  return result;
}

void write_result(const std::string_view words)
{
  const std::string text = printable_lines(words);
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written && errno == EPIPE && std::freopen("/dev/null", "w", stdout) != nullptr)
    std::clearerr(stdout);
}

namespace
{
std::string wrapped_line(const std::string_view line, const std::size_t width)
{
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  if (width_of(line) <= width || line.substr(indent).find("   ") != std::string_view::npos)
    return std::string(line);
  std::string text;
  for (const std::string& words : in_lines(line.substr(indent), width - std::min(indent, width), "  "))
    text += (text.empty() ? "" : "\n") + std::string(indent, ' ') + words;
  return text;
}
} // namespace

std::string wrapped(const std::string_view text, const std::size_t width)
{
  std::string result;
  for (std::size_t begin = 0; begin <= text.size();)
    {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      result += wrapped_line(text.substr(begin, end - begin), width);
      if (end < text.size())
        result += '\n';
      begin = end + 1;
    }
  return result;
}

std::string for_terminal(const std::string_view text)
{
  if (isatty(STDOUT_FILENO) == 0)
    return std::string(text);
  winsize size{};
  constexpr std::size_t usual = 80;
  return wrapped(text, ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > usual / 2 ? size.ws_col : usual);
}
} // namespace feldspar
