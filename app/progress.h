#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace feldspar
{
/// Says how a run goes, on standard output: on a terminal one line that is drawn again and again, on a pipe a plain
/// line now and then.
class Progress
{
public:
  explicit Progress(bool quiet);

  /// A new stretch of work.
  void start(std::string_view title);

  /// fraction: how much of it is done, 0 … 1; NaN where that cannot be known. May be called as often as is handy.
  void update(double fraction, std::string_view text);

  void finish(std::string_view text);

private:
  using Clock = std::chrono::steady_clock;

  void draw(const std::string& line, bool last) const;

  const bool is_quiet;
  const bool on_terminal;
  std::string title;
  Clock::time_point started;
  Clock::time_point drawn;
};
} // namespace feldspar
