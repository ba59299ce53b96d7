#include "report/pictures/figures.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/rves.h"
#include "report/pictures/sample_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;

constexpr const char* share_field = "broken_segments_share";
constexpr const char* localised_field = "localised_share";

/// The crack orientation tensor of a cell in the plane of the picture, whose trace is the density of its cracks [1/m].
struct CrackDirections
{
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

CrackDirections directions(const SampleFields& fields, const std::size_t cell)
{
  const std::string last = fields.has("crack_orientation_zz_per_m") ? "z" : "y"; // the axis of the test
  const auto component = [&](const std::string& name) {
    const auto found = fields.of_each_cell.find(fmt::format("crack_orientation_{}_per_m", name));
    return found == fields.of_each_cell.end() ? 0.0 : found->second[cell];
  };
  return {component("xx"), component(last + last), component("x" + last)};
}

/// The line in which the plane that the mean crack lies in cuts the picture's: across the main direction of the crack
/// normals there, and as long as more cracks lie in it than across it. `size` where all the cracks of the densest cell
/// are alike: two or three that happen to be parallel make no long stroke. Zero where nothing broke.
PlanePoint stroke(const CrackDirections& cracks, const double size, const double most_dense)
{
  const auto [xx, yy, xy] = cracks;
  if (!(xx + yy > 0.0))
    return {};
  const double length = size * std::hypot(xx - yy, 2.0 * xy) / most_dense;
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {-length * std::sin(angle), length * std::cos(angle)};
}

} // namespace

Pictures sample_picture(const FinishedTest& test, const std::string& title)
{
  const SampleFields& fields = test.appearance.fields;
  if (fields.nodes.empty() || !fields.has(share_field) || !fields.has("cell"))
    return {};
  const double scale = visible_scale(fields);
  const SampleView view(fields, scale);
  const std::vector<SamplePiece> pieces = view.pieces();
  const auto& share = fields.of_each_cell.at(share_field);
  // Between the cells themselves: where most of them broke alike, a scale from 0 would show one colour.
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  double most_dense = 0.0;
  for (const SamplePiece& piece : pieces)
    {
      least = std::min(least, share[piece.cell]);
      most = std::max(most, share[piece.cell]);
      const CrackDirections cracks = directions(fields, piece.cell);
      most_dense = std::max(most_dense, cracks.xx + cracks.yy);
    }

  Limits<2> limits;
  ChartSeries cells{.kind = ChartSeries::Kind::area, .colours = ChartSeries::Colours::by_value, .rim = "#ffffff"};
  ChartSeries strokes{.kind = ChartSeries::Kind::segments,
                      .label = "mean direction of the cracks",
                      .colour = black,
                      .width = 2.0};
  for (const SamplePiece& piece : pieces)
    {
      for (const auto* points : {&piece.rest, &piece.moved})
        for (const PlanePoint& point : *points)
          limits.include(point);
      for (const PlanePoint& corner : piece.moved)
        cells.points.push_back({corner[0] / milli, corner[1] / milli, 0.0, share[piece.cell] / percent});
      cells.points.push_back(gap);
      const PlanePoint middle = middle_of(piece.moved);
      PlanePoint line = stroke(directions(fields, piece.cell), 0.8 * std::sqrt(area_of(piece.rest)), most_dense);
      if (fields.is_axisymmetric() && middle[0] < 0.0)
        line[0] = -line[0];
      if (line != PlanePoint{})
        strokes.points.push_back(
          {(middle[0] - 0.5 * line[0]) / milli, (middle[1] - 0.5 * line[1]) / milli, line[0] / milli, line[1] / milli});
    }
  ChartSeries around_strokes = strokes;
  around_strokes.label.clear();
  around_strokes.colour = "#ffffff";
  around_strokes.width = 4.5;
  const auto everywhere = [](const SamplePiece&) { return true; };
  ChartSeries zone{.label = "localised zone", .colour = teal, .width = 3.5};
  if (fields.has(localised_field))
    zone.points = outline(pieces, &SamplePiece::moved, [&](const SamplePiece& piece) {
      return fields.of_each_cell.at(localised_field)[piece.cell] >= 0.5;
    });
  ChartSeries discs{.kind = ChartSeries::Kind::circles, .colour = "#ffffff", .rim = black};
  ChartSeries letters{.kind = ChartSeries::Kind::texts, .colour = black, .size = 14.0};
  for (const PointRve& rve : test.appearance.rves)
    {
      const PlanePoint at = view.place(rve);
      discs.points.push_back({at[0] / milli, at[1] / milli, 0.022 * limits.size(1) / milli});
      letters.points.push_back(discs.points.back());
      letters.texts.push_back(letter_of_rve(letters.texts.size()));
    }
  std::string caption =
    fmt::format("{}, seed {}: share of the segments that are broken, in each cell, {}; displacements drawn {:g} times",
                title, test.record.seed,
                fields.n_rows >= test.record.curve.size() || test.record.curve.empty()
                  ? std::string("at the end")
                  : fmt::format("at row {} of {} of the curve", fields.n_rows, test.record.curve.size()),
                scale);
  caption += most > least ? fmt::format(". Colours go from the least share, {:.3g} %, to the largest, {:.3g} %",
                                        least / percent, most / percent)
                          : fmt::format(". All cells have the same share, {:.3g} %", most / percent);
  if (fields.is_axisymmetric())
    caption += ". The left half is the mirror image of the right";
  else if (fields.dimension == 3)
    caption += ". The section through the axis, seen from the front";
  if (!strokes.points.empty())
    caption += ". Strokes: where the mean crack would cut the picture, the longer the more cracks lie alike";
  if (!zone.points.empty())
    caption += ". Localised: at least half of a cell's points";
  else if (fields.has(localised_field))
    caption += ". Nowhere have half of a cell's points localised";
  if (!test.appearance.rves.empty())
    {
      caption += ". Letters: the representative volumes drawn below";
      if (fields.dimension == 3)
        caption += ", projected";
    }

  const double width = 1.12 * limits.size(0);
  const double height = 1.06 * limits.size(1);
  constexpr int inner_height = 620;
  const PlanePoint middle{0.5 * (limits.low[0] + limits.high[0]), 0.5 * (limits.low[1] + limits.high[1])};
  const bool stands_on_z = fields.dimension == 3 || fields.is_axisymmetric();
  Chart chart{.look = Chart::Look::map,
              .x = {.label = fields.is_axisymmetric() ? "r [mm]" : "x [mm]",
                    .from = (middle[0] - 0.5 * width) / milli,
                    .to = (middle[0] + 0.5 * width) / milli},
              .y = {.label = stands_on_z ? "z [mm]" : "y [mm]",
                    .from = (middle[1] - 0.5 * height) / milli,
                    .to = (middle[1] + 0.5 * height) / milli},
              .colour = {.label = "broken segments [%]",
                         .from = most > least ? least / percent : 0.0,
                         .to = most > 0.0 ? most / percent : 1.0},
              // Light where little broke, so that the strokes are seen; its brightness falls all the way.
              .palette = {"#f3f1ea", "#fdd49e", "#fc8d59", "#d7301f", "#a00000"},
              .equal_scales = true,
              .key_columns = 1,
              .series = {std::move(cells),
                         {.label = "at rest",
                          .colour = grey,
                          .width = 1.0,
                          .dashes = 2,
                          .points = outline(pieces, &SamplePiece::rest, everywhere)},
                         {.label = fmt::format("displacements drawn {:g} times", scale),
                          .colour = black,
                          .width = 1.2,
                          .points = outline(pieces, &SamplePiece::moved, everywhere)},
                         std::move(around_strokes),
                         std::move(strokes),
                         std::move(zone),
                         std::move(discs),
                         std::move(letters)}};
  return {
    {.name = test.name + "_sample",
     .caption = caption,
     .alternative =
       fmt::format("The deformed sample of {} (seed {}): at most {:.2g} % of a cell's segments are broken.", title,
                   test.record.seed, 100.0 * most),
     .width = std::max(480, int(inner_height * width / height) + 240),
     .height = inner_height + 160,
     .raster = pieces.size() > 3000,
     .vector = pieces.size() <= 3000,
     .panels = {std::move(chart)},
     .story = sample_data(test, view, pieces, scale),
     .live_caption = fmt::format(
       "{}, seed {}: the cells of the sample, coloured by one of their fields; displacements drawn {:g} times{}", title,
       test.record.seed, scale, test.appearance.rves.empty() ? "" : "; letters: the representative volumes below")}};
}
} // namespace feldspar
