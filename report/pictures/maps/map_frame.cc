#include "report/pictures/maps/map_frame.h"

#include "base/prefixes.h"

#include <fmt/format.h>

#include <algorithm>

namespace feldspar
{
std::size_t vertical_axis(const TestRecord& record) { return record.size[2] > 0.0 ? 2 : 1; }

std::string seed_of(const FinishedTest& test) { return fmt::format("seed {}", test.record.seed); }

std::string MapLimits::ranges() const
{
  return fmt::format("set xrange [{:.6g}:{:.6g}]; set yrange [{:.6g}:{:.6g}]\n", low[0] / milli, high[0] / milli,
                     low[1] / milli, high[1] / milli);
}

std::string MapFrame::remark() const
{
  return n_outside == 0 ? ""
                        : fmt::format("; {} grain{} flew out of the picture", n_outside, n_outside == 1 ? "" : "s");
}

MapFrame map_frame_of(const FinishedTest& test)
{
  const TestRecord& record = test.record;
  const auto axis_of = [&](const std::size_t c) { return c == 0 ? 0 : vertical_axis(record); };
  MapLimits start;
  for (const auto& grain : test.appearance.grains_at_end)
    for (std::size_t c = 0; c < 2; ++c)
      {
        start.low[c] = std::min(start.low[c], grain.start[axis_of(c)] - grain.radius);
        start.high[c] = std::max(start.high[c], grain.start[axis_of(c)] + grain.radius);
      }
  const std::array<double, 2> size{start.width(), start.height()};
  MapFrame result{start};
  for (const auto& grain : test.appearance.grains_at_end)
    {
      bool is_inside = true;
      for (std::size_t c = 0; c < 2; ++c)
        is_inside &= grain.position[axis_of(c)] > start.low[c] - 0.5 * size[c] &&
                     grain.position[axis_of(c)] < start.high[c] + 0.5 * size[c];
      result.n_outside += !is_inside;
      for (std::size_t c = 0; c < 2 && is_inside; ++c)
        {
          result.frame.low[c] = std::min(result.frame.low[c], grain.position[axis_of(c)] - grain.radius);
          result.frame.high[c] = std::max(result.frame.high[c], grain.position[axis_of(c)] + grain.radius);
        }
    }
  for (std::size_t c = 0; c < 2; ++c)
    {
      result.frame.low[c] -= 0.02 * size[c];
      result.frame.high[c] += 0.02 * size[c];
    }
  return result;
}

std::string map_set_up(const MapLimits& frame, const TestRecord& record)
{
  // Large letters: a phone shows the map at half its size or less.
  return fmt::format("set size ratio -1\nset xlabel 'x [mm]' font ',15'; set ylabel '{} [mm]' font ',15'\n"
                     "set xtics nomirror out font ',14'; set ytics nomirror out font ',14'; set border 3\n"
                     "set title font ',16'\nset key font ',14'\nset bmargin 7.5\n",
                     record.dimension() == 2 ? 'y' : 'z') +
         frame.ranges() + "set key below center horizontal maxcols 2 Left reverse samplen 1.5 width 1 noenhanced\n";
}

bool is_long(const MapLimits& frame) { return frame.width() > 1.5 * frame.height(); }

std::pair<int, int> panel_size(const MapLimits& frame)
{
  constexpr int inner_height = 620;
  const double ratio = frame.width() / frame.height();
  if (is_long(frame))
    return {1100, std::max(160, int(990.0 / ratio)) + 170};
  return {std::max(300, int(inner_height * ratio) + 110), inner_height + 170};
}

MapPaper paper_of(const MapLimits& frame)
{
  constexpr double pixels_of_letter = 17.0;
  return {frame.low, frame.high, pixels_of_letter * (is_long(frame) ? frame.width() / 990.0 : frame.height() / 620.0)};
}

std::vector<MapStage> map_stages(const TestRecord& record)
{
  std::vector<MapStage> result;
  if (const auto peak = peak_row(record))
    {
      if (const auto initiation = crack_initiation_row(record, *peak))
        result.push_back({"crack initiation", record.curve[*initiation].step});
      result.push_back({"peak", record.curve[*peak].step});
    }
  result.push_back({"end", std::numeric_limits<std::uint64_t>::max()});
  return result;
}

std::string in_words(const std::vector<MapStage>& all)
{
  std::string text;
  for (std::size_t k = 0; k < all.size(); ++k)
    text += (k == 0                ? ""
             : k + 1 == all.size() ? " and "
                                   : ", ") +
            (all[k].title == "crack initiation" ? "at " + all[k].title : "at the " + all[k].title);
  return text;
}
} // namespace feldspar
