#include "app/input/entry_parameter.h"
#include "app/input/input_entries.h"
#include "app/input/maps/traces.h"
#include "app/input/parameter_table.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/quantity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace feldspar
{
namespace
{
constexpr std::size_t most_shapes = 10000;

std::vector<std::string_view> words_of(std::string_view text)
{
  std::vector<std::string_view> words;
  while (!(text = trim(text)).empty())
    {
      const std::size_t end = std::min(text.find_first_of(" \t\n"), text.size());
      words.push_back(text.substr(0, end));
      text.remove_prefix(end);
    }
  return words;
}

std::string joined(const std::span<const std::string_view> words) { return fmt::format("{}", fmt::join(words, " ")); }

/// A text that is kept as it was written, but for its white space; empty of none.
std::string as_written(const std::string_view text) { return text == none ? "" : joined(words_of(text)); }

/// The quantities of a shape by their words, e.g. centre and radius.
class Quantities
{
  std::map<std::string_view, std::string> texts;

  template <typename Read>
  auto read(const std::string_view word, Read&& from_text) const
  {
    const auto found = texts.find(word);
    if (found == texts.end())
      throw InputError("{} is missing", word);
    return rephrased(
      [&] { return from_text(std::string_view(found->second)); },
      [&](const std::string& what) { return InputError("{} {}: {}", word, excerpt(found->second), what); });
  }

public:
  Quantities(std::span<const std::string_view> words, const std::vector<std::string_view>& known_words)
  {
    while (!words.empty())
      {
        const std::string_view word = words.front();
        if (!contains(known_words, word))
          throw InputError("{} is not one of its words; they are {}", in_quotes(word), fmt::join(known_words, ", "));
        std::size_t next = 1;
        while (next < words.size() && !contains(known_words, words[next]))
          ++next;
        if (!texts.emplace(word, joined(words.subspan(1, next - 1))).second)
          throw InputError("{} is given twice", word);
        words = words.subspan(next);
      }
  }

  bool has(const std::string_view word) const { return texts.contains(word); }

  /// Returns whether the shape is given in this way: by all of these words and by none of the others.
  bool is_given_by(const std::vector<std::string_view>& words, const std::vector<std::string_view>& others) const
  {
    const auto is_given = [&](const std::string_view word) { return has(word); };
    return std::ranges::all_of(words, is_given) && std::ranges::none_of(others, is_given);
  }

  /// A number in SI; its range is given in `unit`.
  double number(const std::string_view word, const Range& range, const Measure measure = Measure::number,
                const std::string_view unit = "") const
  {
    return read(word, [&](const std::string_view text) { return read_number(text, measure, unit, range); });
  }

  /// The same; none where it is not given.
  std::optional<double> number_if_given(const std::string_view word, const Range& range,
                                        const Measure measure = Measure::number, const std::string_view unit = "") const
  {
    return has(word) ? std::optional(number(word, range, measure, unit)) : std::nullopt;
  }

  double positive_length(const std::string_view word) const
  {
    return number(word, ranges::above_zero, Measure::length, "mm");
  }

  /// 0 where it is not given.
  double angle_or_zero(const std::string_view word) const
  {
    return has(word) ? read(word, [](const std::string_view text) { return parse_quantity(text, angle); }) : 0.0;
  }

  template <int dim>
  Vector<dim> point(const std::string_view word) const
  {
    return read(word, [](const std::string_view text) {
      const auto values = parse_quantities(text, length);
      if (values.size() != dim)
        throw InputError("has {} coordinate(s); there must be {}, e.g. \"{} mm\"", values.size(), dim == 2 ? "2" : "3",
                         dim == 2 ? "25, 50" : "25, 25, 50");
      return Vector<dim>(values.data());
    });
  }

  std::vector<Vector<2>> points(const std::string_view word, const std::size_t at_least) const
  {
    return read(word, [=](const std::string_view text) {
      const auto values = parse_quantities(text, length);
      if (values.size() % 2 != 0 || values.size() < 2 * at_least)
        throw InputError("has {} numbers; there must be x and y of {} points or more, e.g. "
                         "\"10, 20, 30, 25, 35, 40 mm\"",
                         values.size(), at_least);
      if (values.size() > 2 * most_corners)
        throw InputError("has {} points; there must be at most {}", values.size() / 2, most_corners);
      std::vector<Vector<2>> points;
      for (std::size_t k = 0; k < values.size(); k += 2)
        {
          points.emplace_back(values[k], values[k + 1]);
          if (k > 0 && points[k / 2] == points[k / 2 - 1])
            throw InputError("has the same point twice in a row");
        }
      return points;
    });
  }

  /// A word that stands alone.
  bool says(const std::string_view word) const
  {
    const auto found = texts.find(word);
    if (found == texts.end())
      return false;
    if (!found->second.empty())
      throw InputError("{} stands alone; {} follows it", word, excerpt(found->second));
    return true;
  }

  std::uint64_t count(const std::string_view word) const
  {
    return read(word, [](const std::string_view text) {
      if (const auto value = number_in<std::uint64_t>(text))
        return *value;
      throw InputError("must be an integer >= 0");
    });
  }
};

Shape read_hole(const Quantities& given)
{
  if (given.is_given_by({"centre", "radius"}, {"semi-axes", "corners", "angle"}))
    return EllipseHole{given.point<2>("centre"), Vector<2>::Constant(given.positive_length("radius"))};
  if (given.is_given_by({"centre", "semi-axes"}, {"radius", "corners"}))
    {
      const Vector<2> semi_axes = given.point<2>("semi-axes");
      if (!(semi_axes.minCoeff() > 0.0))
        throw InputError("semi-axes: must be > 0 mm");
      return EllipseHole{given.point<2>("centre"), semi_axes, given.angle_or_zero("angle")};
    }
  if (given.is_given_by({"corners"}, {"centre", "radius", "semi-axes", "angle"}))
    return PolygonHole{given.points("corners", 3)};
  throw InputError("is given by \"centre X, Y mm radius R mm\", \"centre X, Y mm semi-axes A, B mm angle D deg\" or "
                   "\"corners X1, Y1, X2, Y2, X3, Y3 mm\"");
}

Shape read_sphere(const Quantities& given)
{
  return SphereHole{given.point<3>("centre"), given.positive_length("radius")};
}

/// The ends of a line given by its ends, or by its centre, length and angle.
std::pair<Vector<2>, Vector<2>> read_line(const Quantities& given)
{
  if (given.has("from"))
    {
      const std::pair ends(given.point<2>("from"), given.point<2>("to"));
      if (ends.first == ends.second)
        throw InputError("ends where it begins");
      return ends;
    }
  const double turn = given.angle_or_zero("angle");
  const Vector<2> half = 0.5 * given.positive_length("length") * Vector<2>(std::cos(turn), std::sin(turn));
  const Vector<2> centre = given.point<2>("centre");
  return {centre - half, centre + half};
}

Shape read_slot(const Quantities& given)
{
  if (!given.is_given_by({"from", "to", "width"}, {"centre", "length", "angle"}) &&
      !given.is_given_by({"centre", "length", "width"}, {"from", "to"}))
    throw InputError(
      "is given by \"from X, Y mm to X, Y mm width W mm\" or \"centre X, Y mm length L mm angle D deg width W "
      "mm\"");
  const auto [from, to] = read_line(given);
  return Slot{from, to, given.number("width", ranges::from_zero, Measure::length, "mm")};
}

constexpr std::array<std::string_view, 7> words_of_smooth_sides{
  "normal-stiffness", "shear-stiffness", "friction", "dilation", "tensile-strength", "cohesion", "friction-angle"};

std::vector<std::string_view> and_smooth(std::vector<std::string_view> words)
{
  words.push_back("smooth");
  words.insert(words.end(), words_of_smooth_sides.begin(), words_of_smooth_sides.end());
  return words;
}

/// Smooth sides of a flaw; none if its joints keep their law.
std::optional<SmoothSides> read_smooth_sides(const Quantities& given)
{
  if (!given.says("smooth"))
    {
      for (const std::string_view word : words_of_smooth_sides)
        if (given.has(word))
          throw InputError("{} is of smooth sides; say smooth before it", word);
      return std::nullopt;
    }
  SmoothSides sides;
  constexpr Range steepness{'[', 0.0, 90.0, ')'};
  sides.normal_stiffness = given.number_if_given("normal-stiffness", ranges::above_zero, Measure::stiffness, "GPa/mm");
  sides.shear_stiffness = given.number_if_given("shear-stiffness", ranges::above_zero, Measure::stiffness, "GPa/mm");
  sides.friction = given.number_if_given("friction", ranges::from_zero);
  sides.dilation_angle = given.number_if_given("dilation", steepness, Measure::angle, "deg");
  sides.tensile_strength = given.number_if_given("tensile-strength", ranges::from_zero, Measure::stress, "MPa");
  sides.cohesion = given.number_if_given("cohesion", ranges::from_zero, Measure::stress, "MPa");
  sides.friction_angle = given.number_if_given("friction-angle", steepness, Measure::angle, "deg");
  return sides;
}

/// LAYER: smooth ... | LAYER: smooth ...
std::map<std::string, SmoothSides> read_layers(const std::string_view text)
{
  std::map<std::string, SmoothSides> layers;
  for (const std::string_view piece : split_at("|", text))
    {
      const std::size_t colon = std::min(piece.find(':'), piece.size());
      const std::string layer = in_small_letters(trim(piece.substr(0, colon)));
      const auto words = words_of(piece.substr(std::min(colon + 1, piece.size())));
      const auto sides = layer.empty() ? std::nullopt : read_smooth_sides(Quantities(words, and_smooth({})));
      if (!sides)
        throw InputError("{} is no layer with smooth sides; write LAYER: smooth, e.g. bedding: smooth friction 0.4",
                         in_quotes(piece));
      if (!layers.emplace(layer, *sides).second)
        throw InputError("{} is given twice", layer);
    }
  return layers;
}

Shape read_closed_flaw(const Quantities& given)
{
  if (given.is_given_by({"from", "to"}, {"centre", "length", "angle", "points"}) ||
      given.is_given_by({"centre", "length"}, {"from", "to", "points"}))
    {
      const auto [from, to] = read_line(given);
      return ClosedFlaw{{from, to}, read_smooth_sides(given)};
    }
  if (given.is_given_by({"points"}, {"from", "to", "centre", "length", "angle"}))
    return ClosedFlaw{given.points("points", 2), read_smooth_sides(given)};
  throw InputError(
    "is given by \"from X, Y mm to X, Y mm\", \"centre X, Y mm length L mm angle D deg\" or \"points X1, "
    "Y1, X2, Y2 mm\"");
}

/// Normal of a plane by its dip and dip direction: that of the steepest way down, from the first axis towards the second.
Vector<3> read_normal(const Quantities& given)
{
  const double dip = given.angle_or_zero("dip");
  const double direction = given.angle_or_zero("dip-direction");
  return {std::sin(dip) * std::cos(direction), std::sin(dip) * std::sin(direction), std::cos(dip)};
}

Shape read_disc_flaw(const Quantities& given)
{
  return DiscFlaw{given.point<3>("centre"), given.positive_length("radius"), read_normal(given),
                  read_smooth_sides(given)};
}

Shape read_joint_set(const Quantities& given)
{
  JointSet set{given.angle_or_zero("angle"), given.positive_length("spacing")};
  set.persistence = given.number_if_given("persistence", {'(', 0.0, 1.0, ']'}).value_or(set.persistence);
  if (given.has("trace-length") != (set.persistence < 1.0))
    throw InputError(set.persistence < 1.0
                       ? "trace-length is missing; with a persistence below 1 traces have a length"
                       : "trace-length: with a persistence of 1 traces run through; give a persistence below 1");
  if (set.persistence < 1.0)
    set.trace_length = given.positive_length("trace-length");
  if (given.has("seed"))
    set.seed = given.count("seed");
  set.smooth = read_smooth_sides(given);
  return set;
}

Shape read_disc_set(const Quantities& given)
{
  constexpr std::uint64_t most_discs = 20000;
  const double concentration = given.number("fisher", {'(', 0.0, 1e6, ']'});
  const std::uint64_t n = given.count("number");
  if (n < 1 || n > most_discs)
    throw InputError("number: must be from 1 to {}", most_discs);
  DiscSet set{read_normal(given), concentration, given.positive_length("radius"), n};
  if (given.has("seed"))
    set.seed = given.count("seed");
  set.smooth = read_smooth_sides(given);
  return set;
}

/// Form of a shape: its name, the words of its quantities, and its reader.
struct Form
{
  std::string_view name;
  std::vector<std::string_view> words;
  Shape (*read)(const Quantities&);
};

const std::vector<Form>& forms()
{
  static const std::vector<Form> all{
    {EllipseHole::name, {"centre", "radius", "semi-axes", "angle", "corners"}, read_hole},
    {SphereHole::name, {"centre", "radius"}, read_sphere},
    {Slot::name, {"from", "to", "centre", "length", "angle", "width"}, read_slot},
    {ClosedFlaw::name, and_smooth({"from", "to", "centre", "length", "angle", "points"}), read_closed_flaw},
    {DiscFlaw::name, and_smooth({"centre", "radius", "dip", "dip-direction"}), read_disc_flaw},
    {JointSet::name, and_smooth({"angle", "spacing", "persistence", "trace-length", "seed"}), read_joint_set},
    {DiscSet::name, and_smooth({"dip", "dip-direction", "fisher", "radius", "number", "seed"}), read_disc_set}};
  return all;
}

Shape parse_shape(const std::string_view text)
{
  const auto all_words = words_of(text);
  const std::span words(all_words);
  for (const Form& form : forms())
    if (const std::size_t n = words_of(form.name).size(); words.size() >= n && joined(words.first(n)) == form.name)
      return rephrased([&] { return form.read(Quantities(words.subspan(n), form.words)); },
                       [&](const std::string& what) { return InputError("{}: {}", form.name, what); });
  throw InputError("{} is no shape; it begins with one of: {}", in_quotes(text),
                   fmt::join(mapped<std::string_view>(forms(), &Form::name), ", "));
}
} // namespace

std::vector<Shape> parse_shapes(const std::string_view text)
{
  std::vector<Shape> shapes;
  for (const std::string_view piece : split_at("|", text))
    {
      if (shapes.size() == most_shapes)
        throw InputError("must be at most {} shapes", most_shapes);
      shapes.push_back(
        rephrased([&] { return parse_shape(piece); },
                  [&](const std::string& what) { return InputError("shape {}, {}", shapes.size() + 1, what); }));
    }
  return shapes;
}

std::vector<Entry<Input>> flaw_entries()
{
  return {
    {"Shapes",
     Entry<Input>::Text{"", "none, or shapes separated by upright bars",
                        [](Input& input, const std::string_view text) {
                          input.flaws.shapes = text == none ? std::vector<Shape>() : parse_shapes(text);
                          input.flaws.text = as_written(text);
                        },
                        [](const Input& input) { return or_none(input.flaws.text); }},
     "what is put into the finished specimen, in any number. A hole is `hole centre 25, 50 mm radius 5 mm`. "
     "`semi-axes 5, 3 mm angle 30 deg` may take the place of the radius, and `corners 20, 40, 30, 40, 25, 50 mm` that of both. A "
     "slot is `slot from 25, 0 mm to 25, 12 mm width 2 mm`. Unbonded joints: `closed flaw centre 25, 50 mm length 12 mm angle 45 deg`, or with `from` and "
     "`to`, or `points`. Many of them: `joint set angle 30 deg spacing 10 mm persistence 0.7 trace-length 8 mm seed 1`. In three "
     "dimensions all these run through the depth. There are also `sphere centre 25, 25, 50 mm radius 5 mm` and `disc flaw "
     "centre 25, 25, 50 mm radius 6 mm dip 45 deg dip-direction 0 deg`. A `disc set dip 60 deg dip-direction 30 deg fisher 20 "
     "radius 4 mm number 30 seed 1` has random centres, and normals of Fisher's distribution. A closed flaw, disc flaw or set "
     "that ends with `smooth` has joints in its plane, as section Smooth joint says. Words of its own may follow: `smooth "
     "friction 0.6 dilation 5 deg normal-stiffness 50 GPa/mm shear-stiffness 20 GPa/mm cohesion 1 MPa tensile-strength 0.5 MPa "
     "friction-angle 31 deg`. With a cohesion or tensile strength they are bonded. Angles are from the first axis towards that "
     "of the tests",
     {.varies = true, .of_specimen = true, .basic = true}},
    {"Traces file",
     Entry<Input>::Text{"", std::string(none_or_a_file),
                        [](Input& input, const std::string_view text) {
                          input.flaws.traces_file = readable_file(input, text);
                          Traces traces =
                            input.flaws.traces_file.empty() ? Traces() : read_traces(input.flaws.traces_file);
                          input.flaws.traces = std::move(traces.shapes);
                          input.flaws.left_out = std::move(traces.left_out);
                        },
                        [](const Input& input) { return or_none(input.flaws.traces_file); }},
     "closed flaws of a joint map: a CSV with the columns from_x_m,from_y_m,to_x_m,to_y_m (and layer), or a DXF whose lines "
     "and polylines are the traces, in the unit of its header (y along the axis of the tests). Parts outside of the "
     "specimen are left out",
     {.of_specimen = true}}};
}

std::vector<Entry<MapParameters>> map_entries()
{
  using P = MapParameters;
  const EntryFlags of_rock{.varies = true, .of_specimen = true};
  return {
    {"Traces origin",
     Entry<P>::Text{"mm", "X, Y mm",
                    [](P& map, const std::string_view text) {
                      const auto values = parse_quantities(text, length);
                      if (values.size() != 2)
                        throw InputError("must be two lengths, e.g. 120, 80 mm");
                      map.origin = {values[0], values[1]};
                    },
                    [](const P& map) {
                      return fmt::format("{}, {} mm", format_number(1e3 * map.origin[0]),
                                         format_number(1e3 * map.origin[1]));
                    }},
     "point of the joint map, in its lengths, that lies at the lower left corner of the specimen", of_rock},
    entry::quantity("Traces angle", &P::angle, Measure::angle, "deg", {'[', -360.0, 360.0, ']'},
                    "by which the joint map is turned about this point, from the first axis towards that of the tests",
                    of_rock),
    entry::number("Traces scale", &P::scale, ranges::above_zero,
                  "length in the specimen over that in the joint map: 0.01 of a map of 5 m in a model of 50 mm",
                  of_rock),
    {"Smooth layers",
     Entry<P>::Text{"", "none, or LAYER: smooth ..., separated by upright bars",
                    [](P& map, const std::string_view text) {
                      map.smooth_layers = text == none ? std::map<std::string, SmoothSides>() : read_layers(text);
                      map.text = as_written(text);
                    },
                    [](const P& map) { return or_none(map.text); }},
     "layers of the joint map whose traces are smooth joints, with the words of a closed flaw: `bedding: smooth friction "
     "0.4 | faults: smooth friction 0.3 cohesion 1 MPa`; the traces of other layers are unbonded joints",
     of_rock}};
}
} // namespace feldspar
