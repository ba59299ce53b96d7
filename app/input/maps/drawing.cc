#include "app/input/maps/dxf.h"
#include "app/input/maps/traces.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

// Group codes and flags below are those of the AutoCAD DXF Reference, "ENTITIES Section" and "LAYER".
namespace feldspar
{
namespace
{
constexpr double flat = 1e-6; ///< part of a length by which CAD programs round

/// Entities that show no line of the rock.
const std::set<std::string, std::less<>> harmless{
  "ACAD_TABLE", "ARC_DIMENSION", "ATTDEF", "ATTRIB",      "DGNUNDERLAY", "DIMENSION", "DWFUNDERLAY",
  "IMAGE",      "LEADER",        "MTEXT",  "MULTILEADER", "OLE2FRAME",   "OLEFRAME",  "PDFUNDERLAY",
  "POINT",      "RTEXT",         "SEQEND", "TEXT",        "TOLERANCE",   "VIEWPORT",  "WIPEOUT"};

/// A point of a line with the height over the drawing and the bulge of the arc to the next point.
struct Corner
{
  Vector<2> place;
  double height = 0.0;
  double bulge = 0.0;
};

struct Line
{
  std::string entity;
  std::string where; ///< file and line
  std::string layer; ///< in small letters
  std::vector<Corner> corners;
  bool closed = false;
};

template <typename... T>
InputError refusal(const Line& line, fmt::format_string<T...> why, T&&... values)
{
  return InputError("{}: the {} {}", line.where, line.entity, fmt::format(why, std::forward<T>(values)...));
}

Line line_of(const DxfRecord& entity)
{
  return {entity.name,
          fmt::format("{}:{}", entity.file.string(), entity.line),
          in_small_letters(entity.text(8, "0")),
          {}};
}

/// Throws InputError for flags (group 70) that this entity does not have.
void check_flags(const Line& line, const DxfRecord& entity, const long known)
{
  if (const long flags = entity.integer(70, 0); (flags & ~known) != 0)
    throw refusal(line, "has unknown flags (group 70 = {}); save the drawing anew by a CAD program", flags);
}

Corner corner_of(const DxfRecord& entity)
{
  return {{entity.number(10), entity.number(20)}, entity.number(30, 0.0), entity.number(42, 0.0)};
}

Line straight_line(const DxfRecord& entity)
{
  Line line = line_of(entity);
  line.corners = {{{entity.number(10), entity.number(20)}, entity.number(30, 0.0)},
                  {{entity.number(11), entity.number(21)}, entity.number(31, 0.0)}};
  return line;
}

/// An entity in the plane whose normal is the extrusion direction (groups 210 to 230): seen from below its x axis is
/// turned round ("Arbitrary Axis Algorithm").
void turn(Line& line, const DxfRecord& entity)
{
  const Vector<3> direction(entity.number(210, 0.0), entity.number(220, 0.0), entity.number(230, 1.0));
  if (!(std::hypot(direction[0], direction[1]) <= flat * std::abs(direction[2])))
    throw refusal(line,
                  "lies in a tilted plane, whose normal is ({:g}, {:g}, {:g}); traces lie in the "
                  "plane of the drawing",
                  direction[0], direction[1], direction[2]);
  if (direction[2] < 0.0)
    for (Corner& corner : line.corners)
      corner.place[0] = -corner.place[0];
}

/// LWPOLYLINE: groups 10 and 20 of each vertex, and what belongs to it up to the next.
Line light_polyline(const DxfRecord& entity)
{
  constexpr long is_closed = 1, goes_on_in_line_type = 128;
  Line line = line_of(entity);
  check_flags(line, entity, is_closed | goes_on_in_line_type);
  line.closed = (entity.integer(70, 0) & is_closed) != 0;
  std::optional<double> y;
  const auto finish = [&] {
    if (!line.corners.empty() && !y)
      throw refusal(line, "has a vertex {} without a group 20", line.corners.size());
    if (y)
      line.corners.back().place[1] = *y;
    y.reset();
  };
  for (const auto& group : entity.groups)
    if (group.code == 10)
      {
        finish();
        line.corners.push_back({{number_of(entity, group), 0.0}});
      }
    else if (group.code == 20 && !line.corners.empty())
      y = number_of(entity, group);
    else if (group.code == 42 && !line.corners.empty())
      line.corners.back().bulge = number_of(entity, group);
  finish();
  if (const long n = entity.integer(90, long(line.corners.size())); n != long(line.corners.size()))
    throw refusal(line, "says that it has {} vertices (group 90) and has {}", n, line.corners.size());
  turn(line, entity);
  return line;
}

/// POLYLINE: each vertex is an entity after it.
class Polyline
{
public:
  explicit Polyline(const DxfRecord& entity)
    : head(entity)
    , line(line_of(entity))
  {
    constexpr long is_closed = 1, is_spline_fit = 4, is_mesh = 16, is_polyface = 64, all = 255;
    check_flags(line, entity, all);
    const long flags = entity.integer(70, 0);
    if ((flags & (is_mesh | is_polyface)) != 0)
      throw refusal(line, "is a {} mesh (group 70 = {}); traces are lines",
                    (flags & is_mesh) != 0 ? "polygon" : "polyface", flags);
    line.closed = (flags & is_closed) != 0;
    is_spline = (flags & is_spline_fit) != 0;
  }

  /// The control points of a spline (its frame) are no points of its curve, which its other vertices give.
  void add(const DxfRecord& vertex)
  {
    constexpr long is_control_point = 16, is_of_mesh = 64, is_of_polyface = 128;
    const long flags = vertex.integer(70, 0);
    if ((flags & (is_of_mesh | is_of_polyface)) != 0)
      throw refusal(line, "has a vertex of a mesh (group 70 = {}); traces are lines", flags);
    if ((flags & is_control_point) == 0)
      line.corners.push_back(corner_of(vertex));
    else if (is_spline)
      ++n_control_points;
    else
      throw refusal(line,
                    "has a control point of a spline (VERTEX, group 70 = {}), and is not marked as a "
                    "spline (POLYLINE, flag 4 of group 70)",
                    flags);
  }

  Line finish()
  {
    if (n_control_points > 0 && line.corners.empty())
      throw refusal(line,
                    "is a spline of which there are {} control points and no point of its curve; "
                    "explode it into lines",
                    n_control_points);
    constexpr long is_in_space = 8; // its vertices are given in space, otherwise in its plane
    if ((head.integer(70, 0) & is_in_space) == 0)
      turn(line, head);
    return std::move(line);
  }

private:
  DxfRecord head;
  Line line;
  bool is_spline = false;
  std::size_t n_control_points = 0;
};

/// The lines of a drawing, and the numbers of its entities that are not visible in model space.
class Drawing
{
public:
  explicit Drawing(const std::filesystem::path& drawing)
    : file(drawing)
  {
  }

  void add(DxfRecord&& record)
  {
    if (record.name == "SECTION")
      read_header(record);
    else if (record.section == "TABLES" && record.name == "LAYER")
      read_layer(record);
    else if (record.section.empty() && record.name != "ENDSEC")
      throw InputError("{}:{}: {} stands outside of a section", file.string(), record.line, in_quotes(record.name));
    else if (record.section == "ENTITIES")
      add_entity(record);
  }

  void end_polyline()
  {
    if (polyline)
      take(polyline->finish());
    polyline.reset();
    is_in_polyline = false;
  }

  long unit = 0; ///< $INSUNITS of the header
  std::vector<Line> lines;

  std::string left_out() const
  {
    std::vector<std::string> parts;
    for (const auto& [reason, n] : hidden)
      if (n > 0)
        parts.push_back(fmt::format("{} {}", n, reason));
    return parts.empty() ? ""
                         : fmt::format("{}: entities that are not to be seen in model space are not read: {}",
                                       file.string(), fmt::join(parts, ", "));
  }

private:
  void read_header(const DxfRecord& section)
  {
    for (std::size_t k = 0; k + 1 < section.groups.size(); ++k)
      if (section.groups[k].code == 9 && section.groups[k].value == "$INSUNITS")
        unit = DxfRecord{section.file, "", "$INSUNITS", section.line, {section.groups[k + 1]}}.integer(70, 0);
  }

  void read_layer(const DxfRecord& layer)
  {
    constexpr long is_frozen = 1;
    if (has_entities)
      throw InputError("{}:{}: the layers stand behind the entities; save the drawing anew by a CAD program",
                       file.string(), layer.line);
    if ((layer.integer(70, 0) & is_frozen) != 0 || layer.integer(62, 1) < 0)
      hidden_layers.insert(in_small_letters(layer.text(2, "")));
  }

  /// Returns whether an entity is to be seen in model space; counts it where it is not.
  bool is_shown(const DxfRecord& entity)
  {
    const std::array reasons{entity.integer(67, 0) != 0, hidden_layers.contains(in_small_letters(entity.text(8, "0"))),
                             entity.integer(60, 0) != 0};
    const auto reason = std::ranges::find(reasons, true);
    if (reason != reasons.end())
      ++hidden[std::size_t(reason - reasons.begin())].second;
    return reason == reasons.end();
  }

  void add_entity(const DxfRecord& entity)
  {
    if (entity.name == "VERTEX" && is_in_polyline)
      {
        if (polyline)
          polyline->add(entity);
        return;
      }
    has_entities = true;
    end_polyline();
    if (entity.name == "ENDSEC" || harmless.contains(entity.name))
      return;
    is_in_polyline = entity.name == "POLYLINE";
    if (!is_shown(entity))
      return;
    if (entity.name == "LINE")
      take(straight_line(entity));
    else if (entity.name == "LWPOLYLINE")
      take(light_polyline(entity));
    else if (entity.name == "POLYLINE")
      polyline.emplace(entity);
    else
      throw InputError("{}:{}: has an entity {}; traces are of LINE, LWPOLYLINE and POLYLINE, without arcs. "
                       "Explode it into lines, or put what is no trace on a layer that is off",
                       file.string(), entity.line, entity.name == "INSERT" ? "INSERT (a block)" : excerpt(entity.name));
  }

  /// Keeps a line of a drawing. Throws InputError for too many corners, each of which takes time with every joint of a
  /// specimen.
  void take(Line line)
  {
    constexpr std::size_t most_corners_of_all = 100000;
    n_corners += line.corners.size();
    if (line.corners.size() > most_corners)
      throw refusal(line, "has {} vertices; it must have at most {}", line.corners.size(), most_corners);
    if (n_corners > most_corners_of_all)
      throw refusal(line, "exceeds the limit: all lines together must have at most {} vertices", most_corners_of_all);
    lines.push_back(std::move(line));
    check_number_of_traces(lines.size(), file);
  }

  std::filesystem::path file;
  std::set<std::string> hidden_layers; ///< names are the same in capital and small letters
  bool has_entities = false;
  bool is_in_polyline = false;      ///< vertices follow
  std::optional<Polyline> polyline; ///< to which they belong; none of one that is not shown
  std::size_t n_corners = 0;
  /// Reasons why entities are not seen, and their numbers.
  std::array<std::pair<std::string_view, std::size_t>, 3> hidden{
    {{"in paper space", 0}, {"on layers that are off or frozen", 0}, {"marked as invisible", 0}}};
};

/// Metres of the drawing's unit; the codes are those of $INSUNITS in the reference of DXF.
double metres_of_unit(const long code, const std::filesystem::path& file)
{
  static const std::map<long, double> units{{1, 0.0254}, {2, 0.3048}, {4, 1e-3}, {5, 1e-2},
                                            {6, 1.0},    {7, 1e3},    {14, 0.1}};
  const auto known = units.find(code);
  if (known == units.end())
    throw InputError("{}: its $INSUNITS is {}; it must be 4 (mm), 5 (cm), 6 (m), 14 (dm), 7 (km), 1 "
                     "(inches) or 2 (feet)",
                     file.string(), code);
  return known->second;
}

/// Throws InputError for a line that leaves the plane or bends.
void check(const Line& line)
{
  const std::size_t n = line.corners.size();
  for (std::size_t k = 0; k + 1 < n + (line.closed ? 1 : 0); ++k)
    {
      const Corner& corner = line.corners[k];
      const Corner& next = line.corners[(k + 1) % n];
      if (std::abs(corner.bulge) > flat)
        throw refusal(line, "has arcs (group 42); traces are straight from point to point");
      if (std::abs(next.height - corner.height) > flat * (next.place - corner.place).norm())
        throw refusal(line, "is not level: z is {:g} and then {:g}; traces lie in the plane of the drawing",
                      corner.height, next.height);
    }
}
} // namespace

Traces read_drawing(const std::filesystem::path& file)
{
  Drawing drawing(file);
  for_each_record(file, [&](DxfRecord&& record) { drawing.add(std::move(record)); });
  drawing.end_polyline();

  Traces traces;
  traces.left_out = drawing.left_out();
  if (drawing.lines.empty())
    throw InputError(traces.left_out.empty() ? fmt::format("{}: has no LINE, LWPOLYLINE or POLYLINE", file.string())
                                             : traces.left_out + "; no LINE, LWPOLYLINE or POLYLINE is left");
  const double unit = metres_of_unit(drawing.unit, file);
  for (const Line& line : drawing.lines)
    {
      check(line);
      std::vector<Vector<2>> points;
      const auto add = [&](const Corner& corner) {
        if (points.empty() || unit * corner.place != points.back())
          points.push_back(unit * corner.place);
      };
      for (const Corner& corner : line.corners)
        add(corner);
      if (line.closed && !line.corners.empty())
        add(line.corners.front());
      if (points.size() < 2)
        throw InputError("{}: trace {} ends where it begins", file.string(), traces.shapes.size() + 1);
      traces.shapes.emplace_back(ClosedFlaw{points, std::nullopt, line.layer});
    }
  return traces;
}
} // namespace feldspar
