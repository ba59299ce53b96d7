#include "report/pictures/sample_pictures.h"

#include "report/pictures/plot_style.h"
#include "report/pictures/space_pictures.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace feldspar
{
namespace
{
using namespace plot;
using Point = std::array<double, 2>;

constexpr const char* share_field = "broken_segments_share";
constexpr const char* localised_field = "localised_share";

/// A cell of the picture's plane, or what the plane cuts out of one: its corners around.
struct Piece
{
  std::size_t cell;
  std::vector<Point> rest;
  std::vector<Point> moved; ///< displacements drawn larger
};

/// The way from mesh to picture.
class View
{
public:
  View(const SampleFields& its_fields, const double its_scale)
    : fields(its_fields)
    , scale(its_scale)
  {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto& node : fields.nodes)
      {
        low = std::min(low, node[1]);
        high = std::max(high, node[1]);
      }
    // A little off the axis, where faces of cells may lie.
    cut = low + (0.5 + 1e-6) * (high - low);
  }

  std::vector<Piece> pieces() const
  {
    std::vector<Piece> all;
    for (std::size_t k = 0; k < fields.cells.size(); ++k)
      if (Piece piece = fields.dimension == 2 ? flat(k) : section(k); piece.rest.size() >= 3)
        {
          if (fields.is_axisymmetric())
            all.push_back(mirrored(piece));
          all.push_back(std::move(piece));
        }
    return all;
  }

  /// Where a volume is drawn: displaced with its cell.
  Point place(const PointVolume& volume) const
  {
    const bool in_space = fields.dimension == 3;
    std::array<double, 3> at = volume.position;
    if (!in_space && fields.has("crack_orientation_zz_per_m")) // the axes of the material: the last is the sample's
      at = {at[0], at[2], 0.0};
    // The displacement of the nodes of its cell, as near as a linear one comes to it.
    const auto& numbers = fields.of_each_cell.at("cell");
    const auto found = std::find(numbers.begin(), numbers.end(), double(volume.cell));
    if (found == numbers.end())
      return in_picture(at);
    const auto& corners = fields.cells[std::size_t(found - numbers.begin())];
    Eigen::MatrixXd places(corners.size(), fields.dimension + 1);
    Eigen::MatrixXd displacements(corners.size(), 3);
    for (std::size_t k = 0; k < corners.size(); ++k)
      {
        const auto row = Eigen::Index(k);
        places(row, fields.dimension) = 1.0;
        for (std::size_t c = 0; c < fields.dimension; ++c)
          places(row, Eigen::Index(c)) = fields.nodes[corners[k]][c] - at[c];
        for (std::size_t c = 0; c < 3; ++c)
          displacements(row, Eigen::Index(c)) = fields.displacement[corners[k]][c];
      }
    const Eigen::MatrixXd linear = places.colPivHouseholderQr().solve(displacements);
    for (std::size_t c = 0; c < 3; ++c)
      at[c] += scale * linear(fields.dimension, Eigen::Index(c));
    return in_picture(at);
  }

private:
  Point in_picture(const std::array<double, 3>& at) const { return {at[0], fields.dimension == 2 ? at[1] : at[2]}; }

  std::array<double, 3> moved(const std::uint32_t i) const
  {
    std::array<double, 3> at = fields.nodes[i];
    for (std::size_t c = 0; c < 3; ++c)
      at[c] += scale * fields.displacement[i][c];
    return at;
  }

  Piece flat(const std::size_t k) const
  {
    Piece piece{k, {}, {}};
    for (const std::uint32_t i : fields.cells[k])
      {
        piece.rest.push_back(in_picture(fields.nodes[i]));
        piece.moved.push_back(in_picture(moved(i)));
      }
    return piece;
  }

  /// Where the plane meets the edges of a hexahedron.
  Piece section(const std::size_t k) const
  {
    static constexpr std::array<std::array<std::size_t, 2>, 12> edges{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    std::vector<std::pair<Point, Point>> corners; // at rest and moved
    for (const auto& [begin, end] : edges)
      {
        const std::uint32_t i = fields.cells[k][begin];
        const std::uint32_t j = fields.cells[k][end];
        const double a = fields.nodes[i][1] - cut;
        const double b = fields.nodes[j][1] - cut;
        if ((a < 0.0) == (b < 0.0))
          continue;
        const double share = a / (a - b);
        const auto between = [=](const auto& one, const auto& other) {
          std::array<double, 3> at{};
          for (std::size_t c = 0; c < 3; ++c)
            at[c] = (1.0 - share) * one[c] + share * other[c];
          return at;
        };
        corners.emplace_back(in_picture(between(fields.nodes[i], fields.nodes[j])),
                             in_picture(between(moved(i), moved(j))));
      }
    Point middle{};
    for (const auto& [rest, displaced] : corners)
      for (std::size_t c = 0; c < 2; ++c)
        middle[c] += rest[c] / double(corners.size());
    const auto angle = [&](const auto& corner) {
      return std::atan2(corner.first[1] - middle[1], corner.first[0] - middle[0]);
    };
    std::sort(corners.begin(), corners.end(),
              [&](const auto& one, const auto& other) { return angle(one) < angle(other); });
    Piece piece{k, {}, {}};
    for (const auto& [rest, displaced] : corners)
      {
        piece.rest.push_back(rest);
        piece.moved.push_back(displaced);
      }
    return piece;
  }

  static Piece mirrored(Piece piece)
  {
    for (auto* points : {&piece.rest, &piece.moved})
      for (Point& point : *points)
        point[0] = -point[0];
    return piece;
  }

  const SampleFields& fields;
  double scale;
  double cut = 0.0; ///< y of the section of a body in space
};

/// Edges of pieces that `inside` holds of, each with where it is drawn, unless pieces on both sides are inside.
template <typename Inside>
std::string outline(const std::vector<Piece>& pieces, const std::vector<Point> Piece::*drawn, const Inside& inside)
{
  // Nodes of each cell are its own: those at one place are one.
  const auto key_of = [](const Point& point) {
    constexpr double small = 1e-8; // [m]
    return std::array{std::llround(point[0] / small), std::llround(point[1] / small)};
  };
  std::map<std::array<std::array<long long, 2>, 2>, std::pair<int, std::string>> edges;
  for (const Piece& piece : pieces)
    if (inside(piece))
      for (std::size_t k = 0; k < piece.rest.size(); ++k)
        {
          const std::size_t next = (k + 1) % piece.rest.size();
          std::array key{key_of(piece.rest[k]), key_of(piece.rest[next])};
          if (key[0] == key[1])
            continue;
          if (key[1] < key[0])
            std::swap(key[0], key[1]);
          auto& [n, rows] = edges[key];
          ++n;
          const auto& points = piece.*drawn;
          rows = fmt::format("{:.6g} {:.6g}\n{:.6g} {:.6g}\n\n", points[k][0] / milli, points[k][1] / milli,
                             points[next][0] / milli, points[next][1] / milli);
        }
  std::string rows;
  for (const auto& [key, edge] : edges)
    if (edge.first == 1)
      rows += edge.second;
  return rows;
}

Point middle_of(const std::vector<Point>& corners)
{
  Point middle{};
  for (const Point& corner : corners)
    for (std::size_t c = 0; c < 2; ++c)
      middle[c] += corner[c] / double(corners.size());
  return middle;
}

double area_of(const std::vector<Point>& corners)
{
  double twice = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Point& a = corners[k];
      const Point& b = corners[(k + 1) % corners.size()];
      twice += a[0] * b[1] - b[0] * a[1];
    }
  return 0.5 * std::abs(twice);
}

/// The line in which the plane that the mean crack lies in cuts the picture's: across the main direction of the crack
/// normals there, the longer the more alike they are. Zero where nothing broke.
Point stroke(const SampleFields& fields, const std::size_t cell, const double size)
{
  const std::string last = fields.has("crack_orientation_zz_per_m") ? "z" : "y"; // the axis of the test
  const auto component = [&](const std::string& name) {
    const auto found = fields.of_each_cell.find(fmt::format("crack_orientation_{}_per_m", name));
    return found == fields.of_each_cell.end() ? 0.0 : found->second[cell];
  };
  const double xx = component("xx");
  const double yy = component(last + last);
  const double xy = component("x" + last);
  if (!(xx + yy > 0.0))
    return {};
  const double difference = std::hypot(xx - yy, 2.0 * xy);
  const double length = 0.8 * size * difference / (xx + yy);
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {-length * std::sin(angle), length * std::cos(angle)};
}

/// A round number by which displacements can be multiplied to be seen: at most 6 % of the height.
double visible_scale(const SampleFields& fields)
{
  double largest = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = 0; i < fields.nodes.size(); ++i)
    {
      const auto& u = fields.displacement[i];
      largest = std::max(largest, std::hypot(u[0], u[1], u[2]));
      low = std::min(low, fields.nodes[i][fields.dimension - 1]);
      high = std::max(high, fields.nodes[i][fields.dimension - 1]);
    }
  if (!(largest > 0.0))
    return 1.0;
  const double wanted = 0.06 * (high - low) / largest;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digits = wanted / power;
  return std::max(1.0, power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0));
}

std::string corners_of_polygon(const std::vector<Point>& corners)
{
  std::string text;
  for (std::size_t k = 0; k <= corners.size(); ++k)
    text += fmt::format("{}{:.6g},{:.6g}", k == 0 ? "from " : " to ", corners[k % corners.size()][0] / milli,
                        corners[k % corners.size()][1] / milli);
  return text;
}

std::string percent_text(const double share) { return fmt::format("{:.2g} %", 100.0 * share); }
} // namespace

std::string letter_of_volume(const std::size_t k) { return {char('A' + k)}; }

double broken_share(const PointVolume& volume)
{
  return volume.n_segments > 0 ? double(volume.cracks.size()) / double(volume.n_segments) : 0.0;
}

std::string standing_of(const PointVolume& volume, const SampleFields& fields)
{
  const auto& at = volume.position;
  if (fields.is_axisymmetric())
    return fmt::format("r = {:.1f} mm, z = {:.1f} mm", at[0] / milli, at[2] / milli);
  if (fields.dimension == 3)
    return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", at[0] / milli, at[1] / milli, at[2] / milli);
  const bool in_space = fields.has("crack_orientation_zz_per_m");
  return fmt::format("({:.1f}, {:.1f}) mm", at[0] / milli, at[in_space ? 2 : 1] / milli);
}

std::vector<Picture> sample_picture(const FinishedTest& test, const std::string& title)
{
  const SampleFields& fields = test.fields;
  if (fields.nodes.empty() || !fields.has(share_field) || !fields.has("cell"))
    return {};
  const double scale = visible_scale(fields);
  const View view(fields, scale);
  const std::vector<Piece> pieces = view.pieces();
  const auto& share = fields.of_each_cell.at(share_field);
  const double most = *std::max_element(share.begin(), share.end());

  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-low[0], -low[1]};
  std::string objects;
  std::string colours; // gnuplot draws the bar of a palette only for what it plots
  std::string strokes;
  for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const Piece& piece = pieces[k];
      for (const auto* points : {&piece.rest, &piece.moved})
        for (const Point& point : *points)
          for (std::size_t c = 0; c < 2; ++c)
            {
              low[c] = std::min(low[c], point[c]);
              high[c] = std::max(high[c], point[c]);
            }
      const double value = share[piece.cell] / percent;
      objects += fmt::format("set object {} polygon {} behind fc palette cb {:.6g} fs solid border lc rgb '#ffffff' lw "
                             "0.4\n",
                             k + 1, corners_of_polygon(piece.moved), value);
      const Point middle = middle_of(piece.moved);
      fmt::format_to(std::back_inserter(colours), "{:.6g} {:.6g} {:.6g}\n", middle[0] / milli, middle[1] / milli,
                     value);
      Point line = stroke(fields, piece.cell, std::sqrt(area_of(piece.rest)));
      if (fields.is_axisymmetric() && middle[0] < 0.0)
        line[0] = -line[0];
      if (line != Point{})
        fmt::format_to(std::back_inserter(strokes), "{:.6g} {:.6g} {:.6g} {:.6g}\n",
                       (middle[0] - 0.5 * line[0]) / milli, (middle[1] - 0.5 * line[1]) / milli, line[0] / milli,
                       line[1] / milli);
    }
  const auto everywhere = [](const Piece&) { return true; };
  std::string zone;
  if (fields.has(localised_field))
    zone = outline(pieces, &Piece::moved,
                   [&](const Piece& piece) { return fields.of_each_cell.at(localised_field)[piece.cell] >= 0.5; });

  std::string letters;
  const double radius = 0.022 * (high[1] - low[1]) / milli;
  for (std::size_t k = 0; k < test.volumes.size(); ++k)
    {
      const Point at = view.place(test.volumes[k]);
      letters += fmt::format("set object {0} circle at {1:.6g},{2:.6g} size {3:.4g} front fc rgb '#ffffff' fs solid 1 "
                             "border lc rgb '{4}' lw 1\nset label '{5}' at {1:.6g},{2:.6g} center front tc rgb '{4}'\n",
                             pieces.size() + k + 1, at[0] / milli, at[1] / milli, radius, black, letter_of_volume(k));
    }

  std::string data =
    fmt::format("$rest << EOD\n{}EOD\n$outline << EOD\n{}EOD\n$cells << EOD\n{}EOD\n",
                outline(pieces, &Piece::rest, everywhere), outline(pieces, &Piece::moved, everywhere), colours);
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
      caption += ". Strokes: where the mean crack would cut the picture, the longer the more alike the cracks are";
    }
  if (!zone.empty())
    {
      data += fmt::format("$zone << EOD\n{}EOD\n", zone);
      plots += fmt::format(", $zone with lines lw 3.5 lc rgb '{}' title 'localised zone'", blue);
      caption += ". Localised: at least half of a cell's points";
    }
  else if (fields.has(localised_field))
    caption += ". Nowhere have half of a cell's points localised";
  if (!test.volumes.empty())
    {
      caption += ". Letters: the volumes drawn below";
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

std::vector<Picture> volume_picture(const FinishedTest& test, const std::string& title)
{
  const auto& volumes = test.volumes;
  if (volumes.empty() || std::any_of(volumes.begin(), volumes.end(), [](const auto& v) { return v.grains.empty(); }))
    return {};
  std::vector<std::string> headings;
  for (std::size_t k = 0; k < volumes.size(); ++k)
    headings.push_back(fmt::format("{}: {}", letter_of_volume(k), volumes[k].which));
  const std::string name = test.name + "_volumes";
  const std::string caption = fmt::format("{}, seed {}: grains and cracks of the volumes at a few points of the "
                                          "sample, along its axes, at the end",
                                          title, test.record.seed);
  const std::string alternative =
    fmt::format("Grains and cracks of {} volumes of {} (seed {}).", volumes.size(), title, test.record.seed);
  if (test.fields.dimension == 3 || test.fields.has("crack_orientation_zz_per_m"))
    {
      Picture picture = space_picture_of_volumes(volumes, headings);
      picture.name = name;
      picture.caption = caption +
                        ". Grains behind the mid-plane, every broken element as a disc; seen from the front, a "
                        "little from the right and from above";
      picture.alternative = alternative;
      return {picture};
    }

  std::string data;
  std::string plots;
  double reach = 0.0; // from a volume's point
  for (const PointVolume& volume : volumes)
    for (std::size_t c = 0; c < 2; ++c)
      {
        for (const auto& grain : volume.grains)
          reach = std::max(reach, std::abs(grain.position[c] - volume.position[c]) + grain.radius);
        for (const auto& crack : volume.cracks)
          reach = std::max(reach, std::abs(crack.centroid[c] - volume.position[c]) + 0.5 * crack.size);
      }
  reach *= 1.03 / milli;
  for (std::size_t k = 0; k < volumes.size(); ++k)
    {
      const auto& centre = volumes[k].position;
      std::string body;
      std::string loose;
      for (const auto& grain : volumes[k].grains)
        fmt::format_to(std::back_inserter(grain.fragment > 0 ? loose : body), "{:.6g} {:.6g} {:.6g}\n",
                       (grain.position[0] - centre[0]) / milli, (grain.position[1] - centre[1]) / milli,
                       grain.radius / milli);
      data += fmt::format("$grains{0} << EOD\n{1}EOD\n", k, body);
      plots +=
        fmt::format("set title {} noenhanced\nplot $grains{} with circles fill solid noborder lc rgb '{}' notitle",
                    gnuplot_text(headings[k]), k, light_grey);
      if (!loose.empty())
        {
          data += fmt::format("$loose{} << EOD\n{}EOD\n", k, loose);
          plots += fmt::format(", $loose{} with circles fill solid noborder lc rgb '{}' title 'cut off'", k,
                               single_grain_colour);
        }
      for (const CrackKind kind : {CrackKind::tension, CrackKind::shear})
        {
          std::string rows;
          for (const auto& crack : volumes[k].cracks)
            if (crack.kind == kind)
              {
                const double dx = -crack.normal[1] * crack.size;
                const double dy = crack.normal[0] * crack.size;
                fmt::format_to(std::back_inserter(rows), "{:.6g} {:.6g} {:.6g} {:.6g}\n",
                               (crack.centroid[0] - centre[0] - 0.5 * dx) / milli,
                               (crack.centroid[1] - centre[1] - 0.5 * dy) / milli, dx / milli, dy / milli);
              }
          add_cracks(data, plots, k, kind, rows, 2.2);
        }
      if (volumes[k].cracks.empty())
        plots += ", NaN with lines lc rgb '#ffffff' title 'nothing broken'";
      plots += "\n";
    }
  return {
    {.name = name,
     .caption =
       caption +
       ". Coordinates are from the point that the volume stands for; it is periodic, so that cracks at its rim go on at "
       "the other side",
     .alternative = alternative,
     .width = 400 * int(volumes.size()),
     .height = 480,
     .raster = true,
     .vector = false,
     .script =
       data +
       "set size ratio -1\nset xlabel 'x from the point [mm]' offset 0,0.4; set ylabel 'y from the point [mm]'\nset tics "
       "nomirror out; set border 3\nset key below center horizontal maxcols 3 Left reverse samplen 1.5 "
       "width 1 noenhanced\n" +
       fmt::format("set xrange [{0:.4g}:{1:.4g}]; set yrange [{0:.4g}:{1:.4g}]\nset multiplot layout 1,{2}\n"
                   "{3}unset multiplot\n",
                   -reach, reach, volumes.size(), plots)}};
}
} // namespace feldspar
