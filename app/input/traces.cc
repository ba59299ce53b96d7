#include "app/input/traces.h"

#include "base/csv.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/text.h"

#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t most_traces = 10000;

void check_number(const std::size_t n, const std::filesystem::path& file)
{
  if (n > most_traces)
    throw InputError(fmt::format("{}: must be at most {} traces", file.string(), most_traces));
}

std::vector<Shape> read_table(const std::filesystem::path& file)
{
  std::vector<Shape> traces;
  for (const auto& row : read_csv(file, header_of_traces))
    {
      traces.emplace_back(ClosedFlaw{{{row[0], row[1]}, {row[2], row[3]}}});
      check_number(traces.size(), file);
      if (row[0] == row[2] && row[1] == row[3])
        throw InputError(fmt::format("{}:{}: the trace ends where it begins", file.string(), traces.size() + 1));
    }
  return traces;
}

/// Collects the straight lines of a drawing, in its own unit. dxflib tells them entity by entity.
class Drawing : public DL_CreationAdapter
{
public:
  struct Line
  {
    std::vector<Vector<2>> points;
    bool closed = false;
  };

  int unit = 0;                    ///< $INSUNITS of the header
  std::vector<Line> lines;         ///< of LINE, LWPOLYLINE and POLYLINE
  std::string what_is_not_a_trace; ///< the first entity that would be lost; empty: none

  void setVariableInt(const std::string& key, const int value, int) override
  {
    if (key == "$INSUNITS")
      unit = value;
  }

  void addBlock(const DL_BlockData&) override { in_block = true; }
  void endBlock() override { in_block = false; }

  void addLine(const DL_LineData& line) override { begin({{{line.x1, line.y1}, {line.x2, line.y2}}}); }

  void addPolyline(const DL_PolylineData& line) override
  {
    constexpr int is_closed = 1, is_mesh = 16, is_polyface = 64;
    if (line.flags & (is_mesh | is_polyface))
      refuse("POLYLINE of a mesh");
    begin({{}, (line.flags & is_closed) != 0});
  }

  void addVertex(const DL_VertexData& vertex) override
  {
    if (in_block || lines.empty())
      return;
    if (vertex.bulge != 0.0)
      refuse("POLYLINE with arcs");
    lines.back().points.emplace_back(vertex.x, vertex.y);
  }

  void addArc(const DL_ArcData&) override { refuse("ARC"); }
  void addCircle(const DL_CircleData&) override { refuse("CIRCLE"); }
  void addEllipse(const DL_EllipseData&) override { refuse("ELLIPSE"); }
  void addSpline(const DL_SplineData&) override { refuse("SPLINE"); }
  void addInsert(const DL_InsertData&) override { refuse("INSERT (a block)"); }
  void addXLine(const DL_XLineData&) override { refuse("XLINE"); }
  void addRay(const DL_RayData&) override { refuse("RAY"); }

private:
  void begin(Line line)
  {
    if (!in_block)
      lines.push_back(std::move(line));
  }

  void refuse(const std::string& entity)
  {
    if (!in_block && what_is_not_a_trace.empty())
      what_is_not_a_trace = entity;
  }

  bool in_block = false; ///< of which only an INSERT would draw anything
};

/// Metres of the drawing's unit; the codes are those of $INSUNITS in the reference of DXF.
double metres_of_unit(const int code, const std::filesystem::path& file)
{
  static const std::map<int, double> units{{1, 0.0254}, {2, 0.3048}, {4, 1e-3}, {5, 1e-2},
                                           {6, 1.0},    {7, 1e3},    {14, 0.1}};
  const auto known = units.find(code);
  if (known == units.end())
    throw InputError(fmt::format("{}: its $INSUNITS is {}; it must be 4 (mm), 5 (cm), 6 (m), 14 (dm), 7 (km), 1 "
                                 "(inches) or 2 (feet)",
                                 file.string(), code));
  return known->second;
}

/// dxflib takes a word for a coordinate of 0, and a half drawing without the traces behind the cut. A DXF is pairs of lines, a
/// group code and its value; the codes 10 to 59 have real numbers (reference of DXF, group code value types).
void check_groups(const std::filesystem::path& file)
{
  ReadableFile stream(file);
  std::string code, value, last_value;
  for (std::size_t line = 2; std::getline(stream, code) && std::getline(stream, value); line += 2)
    {
      const std::string_view digits = trim(code);
      const bool is_real =
        digits.size() == 2 && digits[0] >= '1' && digits[0] <= '5' && digits[1] >= '0' && digits[1] <= '9';
      if (is_real && !is_decimal_number(trim(value)))
        throw InputError(fmt::format("{}:{}: {} is not a decimal number, as group code {} has", file.string(), line,
                                     in_quotes(trim(value)), digits));
      last_value = value;
    }
  if (trim(last_value) != "EOF")
    throw InputError(fmt::format("{}: does not end with EOF, as a complete DXF does", file.string()));
}

std::vector<Shape> read_drawing(const std::filesystem::path& file)
{
  // dxflib takes a file of any content, and nothing of a binary one.
  ReadableFile stream(file);
  std::string mark(22, '\0');
  stream.read(mark.data(), std::streamsize(mark.size()));
  if (mark.starts_with("AutoCAD Binary DXF"))
    throw InputError(fmt::format("{}: is a binary DXF; save it as text (ASCII)", file.string()));
  check_groups(file);

  Drawing drawing;
  if (DL_Dxf reader; !reader.in(file.string(), &drawing))
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  if (!drawing.what_is_not_a_trace.empty())
    throw InputError(fmt::format("{}: has an entity {}; traces are of LINE, LWPOLYLINE and POLYLINE, without arcs",
                                 file.string(), drawing.what_is_not_a_trace));
  if (drawing.lines.empty())
    throw InputError(fmt::format("{}: has no LINE, LWPOLYLINE or POLYLINE", file.string()));
  check_number(drawing.lines.size(), file);

  const double unit = metres_of_unit(drawing.unit, file);
  std::vector<Shape> traces;
  for (auto& [drawn, closed] : drawing.lines)
    {
      if (closed && !drawn.empty())
        drawn.push_back(drawn.front());
      std::vector<Vector<2>> points;
      for (const Vector<2>& point : drawn)
        if (points.empty() || unit * point != points.back())
          points.push_back(unit * point);
      const std::string name = fmt::format("{}: trace {}", file.string(), traces.size() + 1);
      for (const Vector<2>& point : points)
        if (!point.allFinite())
          throw InputError(name + " has a coordinate that is not a number");
      if (points.size() < 2)
        throw InputError(name + " ends where it begins");
      traces.emplace_back(ClosedFlaw{points});
    }
  return traces;
}
} // namespace

std::vector<Shape> read_traces(const std::filesystem::path& file)
{
  const std::string ending = file.extension().string();
  return ending == ".dxf" || ending == ".DXF" ? read_drawing(file) : read_table(file);
}
} // namespace feldspar
