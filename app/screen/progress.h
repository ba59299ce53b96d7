#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// One of several things that run at the same time.
struct ProgressDetail
{
  double fraction;  ///< NaN where it cannot be known
  std::string name; ///< in ASCII; shortened where the line has no room for it beside the text
  std::string text;
};

/// Says how a run goes, on standard error: on a terminal lines that are drawn again and again, on a pipe plain lines now
/// and then. Lines fit the terminal, or 80 columns.
class Progress
{
public:
  explicit Progress(bool quiet);

  /// A new stretch of work.
  void start(std::string_view title);

  /// fraction: how much of it is done, 0 … 1; NaN where that cannot be known. May be called as often as is handy.
  /// details: a line each below the first, for what runs at the same time.
  void update(double fraction, std::string_view text, const std::vector<ProgressDetail>& details = {});

  void finish(std::string_view text);

  /// A sentence that stays, on lines of its own: what goes wrong, also where the progress is quiet. On a pipe it is one
  /// line, to be searched for.
  void note(std::string_view text);

  /// The same of what is good to know: not where the progress is quiet.
  void remark(std::string_view text);

private:
  using Clock = std::chrono::steady_clock;

  void draw(const std::vector<std::string>& lines, bool last);
  void clear();

  const bool is_quiet;
  const bool on_terminal;
  std::string title;
  Clock::time_point started;
  Clock::time_point drawn;
  double fraction_at_start = 0.0; ///< of a run that was resumed
  std::size_t n_lines_above = 0;  ///< of the last drawing, above the cursor
};
} // namespace feldspar
