#include "app/input/maps/mineral_files.h"

#include "base/colour.h"
#include "base/contains.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/table/csv.h"
#include "base/text.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
/// A table of which every column is known.
class MineralTable
{
public:
  explicit MineralTable(const std::filesystem::path& file)
    : name(file.string())
    , csv(file)
  {
  }

  bool next() { return csv.next(); }

  /// A number in SI within bounds, which are told in words; none of an empty cell or a missing column.
  std::optional<double> number(const std::string_view name_in_si, const double low, const double high,
                               const std::string_view allowed)
  {
    const auto place = csv.find_in_si(name_in_si);
    if (!place || csv.text(know(*place)).empty())
      return std::nullopt;
    const double value = csv.number(*place);
    if (!(value >= low && value <= high))
      refuse("{} = {} must lie in {}", csv.name_of(*place), csv.text(*place), allowed);
    return value;
  }

  std::string mineral(const std::string_view column)
  {
    const std::string text(csv.text(know(csv.place(column))));
    if (constexpr std::size_t longest = 40; !is_plain_name(text) || text.size() > longest)
      refuse("{} is no name of a mineral; it has 1 to {} letters, digits or ._-+ and begins with a letter or "
             "a digit",
             in_quotes(text), longest);
    return text;
  }

  /// 0xRRGGBB of #rrggbb; none of an empty cell or a missing column.
  std::optional<std::uint32_t> colour()
  {
    if (!csv.has("colour"))
      return std::nullopt;
    const std::string_view text = csv.text(know(csv.place("colour")));
    if (text.empty())
      return std::nullopt;
    const auto value = parse_colour(text);
    if (!value)
      refuse("{} is no colour; write red, green and blue as #rrggbb, e.g. #c0c0c0", in_quotes(text));
    return value;
  }

  template <typename... T>
  [[noreturn]] void refuse(fmt::format_string<T...> why, T&&... values) const
  {
    throw InputError("{}:{}: {}", name, csv.line_of_row(), fmt::format(why, std::forward<T>(values)...));
  }

  /// To be called after the first row has been read: a column that nothing asked for is a mistake.
  void check_columns(const std::string_view columns) const
  {
    for (std::size_t c = 0; c < csv.header().size(); ++c)
      if (!csv.name_of(c).empty() && !contains(known, c))
        throw InputError("{}:{}: {} is no column of this table; they are {}", name, csv.line_of_header(),
                         in_quotes(csv.name_of(c)), columns);
  }

  void check_number(const std::size_t n, const std::size_t most) const
  {
    if (n > most)
      refuse("must be at most {} rows", most);
  }

private:
  std::size_t know(const std::size_t column)
  {
    known.push_back(column);
    return column;
  }

  std::string name;
  CsvReader csv;
  std::vector<std::size_t> known;
};

constexpr double largest_ratio = 1e4;
constexpr double smallest_ratio = 1e-4; // of stiffness, which no joint is without

MineralBoundary ratios_of(MineralTable& table)
{
  return {"",
          "",
          table.number("stiffness_ratio", smallest_ratio, largest_ratio, "1e-4 to 1e4"),
          table.number("tensile_strength_ratio", 0.0, largest_ratio, "0 to 1e4"),
          table.number("cohesion_ratio", 0.0, largest_ratio, "0 to 1e4"),
          table.number("friction_ratio", 0.0, largest_ratio, "0 to 1e4")};
}

MineralMap read_points(const std::filesystem::path& file)
{
  MineralTable table(file);
  MineralMap map;
  constexpr double farthest = 1e3; // [m]
  constexpr std::size_t most_points = 5'000'000;
  while (table.next())
    {
      const auto coordinate = [&](const char* const name) {
        return table.number(name, -farthest, farthest, "-1000 to 1000 m");
      };
      const auto x = coordinate("x_m"), y = coordinate("y_m");
      if (!x || !y)
        table.refuse("a point needs x and y, e.g. in the columns x [mm] and y [mm]");
      map.place.push_back({*x, *y, coordinate("z_m").value_or(0.0)});
      map.mineral_of_point.push_back(table.mineral("mineral"));
      if (map.place.size() == 1)
        table.check_columns("x, y, z with a unit of length, and mineral");
      table.check_number(map.place.size(), most_points);
    }
  if (map.place.empty())
    throw InputError("{}: there is no point below the header", file.string());
  return map;
}

MineralMap read_picture(const std::filesystem::path& file)
{
  const std::string bytes = content_of(file);
  const auto refuse = [&](const std::string& why) { throw InputError("{}: {}", file.string(), why); };
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto not_png = [&] { refuse(fmt::format("is no PNG, or damaged ({})", printable(image.message))); };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    not_png();
  const auto [width, height, format] = std::tuple(image.width, image.height, image.format);
  std::string objection;
  if (constexpr double most_pixels = 5e7; double(width) * double(height) > most_pixels)
    objection = fmt::format("has {} × {} pixels; at most {:.0e} are read", width, height, most_pixels);
  else if ((format & PNG_FORMAT_FLAG_LINEAR) != 0)
    objection = "has 16 bits a colour; save it with 8";
  if (!objection.empty())
    {
      png_image_free(&image);
      refuse(objection);
    }
  // Many programs write an alpha channel of which every pixel is opaque.
  image.format = PNG_FORMAT_RGBA;
  std::vector<png_byte> rgba(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr) == 0)
    not_png();
  MineralMap map;
  map.width = width;
  map.colour.reserve(rgba.size() / 4);
  for (std::size_t k = 0; k < rgba.size(); k += 4)
    {
      constexpr png_byte opaque = 255;
      if (rgba[k + 3] != opaque)
        refuse("has transparent pixels; save it without transparency");
      map.colour.push_back(std::uint32_t(rgba[k]) << 16U | std::uint32_t(rgba[k + 1]) << 8U | rgba[k + 2]);
    }
  return map;
}
} // namespace

std::vector<Mineral> read_minerals(const std::filesystem::path& file)
{
  MineralTable table(file);
  std::vector<Mineral> minerals;
  // The colours of Okabe and Ito, which also the colour-blind tell apart.
  constexpr std::array<std::uint32_t, 7> colours{0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442, 0x0072b2, 0xd55e00, 0xcc79a7};
  while (table.next())
    {
      Mineral one;
      one.name = table.mineral("mineral");
      if (contains(minerals, one.name, &Mineral::name))
        table.refuse("{} is in the table twice", one.name);
      one.share = table.number("share", 0.0, 1.0, "0 to 100 %");
      constexpr double quarter_turn = 0.5 * std::numbers::pi;
      one.size = table.number("size_m", 0.0, 1e3, "0 to 1000 m").value_or(0.0);
      one.aspect_ratio = table.number("aspect_ratio", 1.0, 20.0, "1 to 20").value_or(1.0);
      one.angle = table.number("angle_rad", -quarter_turn, quarter_turn, "-90 to 90 deg");
      one.colour = table.colour().value_or(colours[minerals.size() % colours.size()]);
      one.density = table.number("density_kg_per_m3", 100.0, 1e5, "100 to 1e5 kg/m^3");
      const MineralBoundary ratios = ratios_of(table);
      one.within = {ratios.stiffness.value_or(1.0), ratios.tensile_strength.value_or(1.0),
                    ratios.cohesion.value_or(1.0), ratios.friction.value_or(1.0)};
      if (minerals.empty())
        table.check_columns("mineral, share, size, aspect_ratio, angle, colour, density, stiffness_ratio, "
                            "tensile_strength_ratio, cohesion_ratio, friction_ratio");
      minerals.push_back(std::move(one));
      table.check_number(minerals.size(), most_minerals);
    }
  if (minerals.empty())
    throw InputError("{}: there is no mineral below the header", file.string());
  return minerals;
}

std::vector<MineralBoundary> read_mineral_boundaries(const std::filesystem::path& file)
{
  MineralTable table(file);
  std::vector<MineralBoundary> boundaries;
  while (table.next())
    {
      MineralBoundary one = ratios_of(table);
      one.one = table.mineral("mineral_1");
      one.two = table.mineral("mineral_2");
      if (std::ranges::any_of(boundaries, [&](const MineralBoundary& other) {
            return (other.one == one.one && other.two == one.two) || (other.one == one.two && other.two == one.one);
          }))
        table.refuse("the boundary of {} and {} is in the table twice", one.one, one.two);
      if (boundaries.empty())
        table.check_columns(
          "mineral_1, mineral_2, stiffness_ratio, tensile_strength_ratio, cohesion_ratio, friction_ratio");
      boundaries.push_back(std::move(one));
      table.check_number(boundaries.size(), most_minerals * most_minerals);
    }
  return boundaries;
}

std::shared_ptr<const MineralMap> read_mineral_map(const std::filesystem::path& file)
{
  const std::string ending = in_small_letters(file.extension().string());
  if (ending != ".png" && ending != ".csv" && ending != ".txt")
    throw InputError("{}: is neither a picture in PNG (.png) nor a table of points (.csv, .txt)", file.string());
  return std::make_shared<const MineralMap>(ending == ".png" ? read_picture(file) : read_points(file));
}
} // namespace feldspar
