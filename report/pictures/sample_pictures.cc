#include "report/pictures/sample_pictures.h"

#include "report/pictures/plot_style.h"
#include "report/pictures/rve_pictures.h"
#include "report/pictures/sample_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

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

std::string corners_of_polygon(const std::vector<PlanePoint>& corners)
{
  std::string text;
  for (std::size_t k = 0; k <= corners.size(); ++k)
    text += fmt::format("{}{:.6g},{:.6g}", k == 0 ? "from " : " to ", corners[k % corners.size()][0] / milli,
                        corners[k % corners.size()][1] / milli);
  return text;
}

std::string percent_text(const double share) { return fmt::format("{:.2g} %", 100.0 * share); }
} // namespace

std::vector<Picture> sample_picture(const FinishedTest& test, const std::string& title)
{
  const SampleFields& fields = test.appearance.fields;
  if (fields.nodes.empty() || !fields.has(share_field) || !fields.has("cell"))
    return {};
  const double scale = visible_scale(fields);
  const SampleView view(fields, scale);
  const std::vector<SamplePiece> pieces = view.pieces();
  const auto& share = fields.of_each_cell.at(share_field);
  const double most = *std::max_element(share.begin(), share.end());

  double most_dense = 0.0;
  for (const SamplePiece& piece : pieces)
    {
      const CrackDirections cracks = directions(fields, piece.cell);
      most_dense = std::max(most_dense, cracks.xx + cracks.yy);
    }

  PlanePoint low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  PlanePoint high{-low[0], -low[1]};
  std::string objects;
  std::string colours; // gnuplot draws the bar of a palette only for what it plots
  std::string strokes;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const SamplePiece& piece = pieces[k];
      for (const auto* points : {&piece.rest, &piece.moved})
        for (const PlanePoint& point : *points)
          for (std::size_t c = 0; c < 2; ++c)
            {
              low[c] = std::min(low[c], point[c]);
              high[c] = std::max(high[c], point[c]);
            }
      const double value = share[piece.cell] / percent;
      objects += fmt::format("set object {} polygon {} behind fc palette cb {:.6g} fs solid border lc rgb '#ffffff' lw "
                             "0.4\n",
                             k + 1, corners_of_polygon(piece.moved), value);
      const PlanePoint middle = middle_of(piece.moved);
      fmt::format_to(std::back_inserter(colours), "{:.6g} {:.6g} {:.6g}\n", middle[0] / milli, middle[1] / milli,
                     value);
      PlanePoint line = stroke(directions(fields, piece.cell), 0.8 * std::sqrt(area_of(piece.rest)), most_dense);
      if (fields.is_axisymmetric() && middle[0] < 0.0)
        line[0] = -line[0];
      if (line != PlanePoint{})
        fmt::format_to(std::back_inserter(strokes), "{:.6g} {:.6g} {:.6g} {:.6g}\n",
                       (middle[0] - 0.5 * line[0]) / milli, (middle[1] - 0.5 * line[1]) / milli, line[0] / milli,
                       line[1] / milli);
    }
  const auto everywhere = [](const SamplePiece&) { return true; };
  std::string zone;
  if (fields.has(localised_field))
    zone = outline(pieces, &SamplePiece::moved, [&](const SamplePiece& piece) {
      return fields.of_each_cell.at(localised_field)[piece.cell] >= 0.5;
    });

  std::string letters;
  const double radius = 0.022 * (high[1] - low[1]) / milli;
  for (std::size_t k = 0; k < test.appearance.rves.size(); ++k)
    {
      const PlanePoint at = view.place(test.appearance.rves[k]);
      letters += fmt::format("set object {0} circle at {1:.6g},{2:.6g} size {3:.4g} front fc rgb '#ffffff' fs solid 1 "
                             "border lc rgb '{4}' lw 1\nset label '{5}' at {1:.6g},{2:.6g} center front tc rgb '{4}'\n",
                             pieces.size() + k + 1, at[0] / milli, at[1] / milli, radius, black, letter_of_rve(k));
    }

  std::string data = fmt::format("$rest << EOD\n{}EOD\n$outline << EOD\n{}EOD\n$cells << EOD\n{}EOD\n",
                                 outline(pieces, &SamplePiece::rest, everywhere),
                                 outline(pieces, &SamplePiece::moved, everywhere), colours);
  std::string plots =
    fmt::format("plot $cells using 1:2:3 with dots lc palette notitle, $rest with lines lw 1 dt 2 lc rgb "
                "'{}' title 'at rest', $outline with lines lw 1.2 lc rgb '{}' title 'displacements drawn {:g} times'",
                grey, black, scale);
  std::string caption =
    fmt::format("{}, seed {}: share of the segments that are broken, in each cell, {}; displacements drawn {:g} times",
                title, test.record.seed,
                fields.n_rows >= test.record.curve.size() || test.record.curve.empty()
                  ? std::string("at the end")
                  : fmt::format("at row {} of {} of the curve", fields.n_rows, test.record.curve.size()),
                scale);
  if (fields.is_axisymmetric())
    caption += ". The left half is the mirror image of the right";
  else if (fields.dimension == 3)
    caption += ". The section through the axis, seen from the front";
  if (!strokes.empty())
    {
      data += fmt::format("$strokes << EOD\n{}EOD\n", strokes);
      plots += fmt::format(", $strokes with vectors nohead lw 4.5 lc rgb '#ffffff' notitle, $strokes with "
                           "vectors nohead lw 2 lc rgb '{}' title 'mean direction of the cracks'",
                           black);
      caption += ". Strokes: where the mean crack would cut the picture, the longer the more cracks lie alike";
    }
  if (!zone.empty())
    {
      data += fmt::format("$zone << EOD\n{}EOD\n", zone);
      plots += fmt::format(", $zone with lines lw 3.5 lc rgb '{}' title 'localised zone'", teal);
      caption += ". Localised: at least half of a cell's points";
    }
  else if (fields.has(localised_field))
    caption += ". Nowhere have half of a cell's points localised";
  if (!test.appearance.rves.empty())
    {
      caption += ". Letters: the representative volumes drawn below";
      if (fields.dimension == 3)
        caption += ", projected";
    }

  const double width = 1.12 * (high[0] - low[0]);
  const double height = 1.06 * (high[1] - low[1]);
  constexpr int inner_height = 620;
  return {
    {.name = test.name + "_sample",
     .caption = caption,
     .alternative = fmt::format("The deformed sample of {} (seed {}): at most {} of a cell's segments are broken.",
                                title, test.record.seed, percent_text(most)),
     .width = std::max(480, int(inner_height * width / height) + 240),
     .height = inner_height + 160,
     .raster = pieces.size() > 3000,
     .vector = pieces.size() <= 3000,
     .script =
       data + fmt::format(
                "set size ratio -1\nset xlabel '{}' offset 0,0.4; set ylabel '{}'\nset tics nomirror out; "
                "set border 3\nset xrange [{:.6g}:{:.6g}]; set yrange [{:.6g}:{:.6g}]\nset key below center horizontal "
                "maxcols 1 Left reverse samplen 1.5 noenhanced\n"
                // Light where little broke, so that the strokes are seen; its brightness falls all the way.
                "set palette defined (0 '#f3f1ea', 1 '#fdd49e', 2 '#fc8d59', 3 '#d7301f', 4 '#a00000')\n"
                "set cbrange [0:{:.6g}]\nset cblabel 'broken segments [%]'\n{}{}{}\n",
                fields.is_axisymmetric() ? "r [mm]" : "x [mm]",
                fields.dimension == 3 || fields.is_axisymmetric() ? "z [mm]" : "y [mm]",
                (0.5 * (low[0] + high[0]) - 0.5 * width) / milli, (0.5 * (low[0] + high[0]) + 0.5 * width) / milli,
                (0.5 * (low[1] + high[1]) - 0.5 * height) / milli, (0.5 * (low[1] + high[1]) + 0.5 * height) / milli,
                most > 0.0 ? most / percent : 1.0, objects, letters, plots)}};
}
} // namespace feldspar
