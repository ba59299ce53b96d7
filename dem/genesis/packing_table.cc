#include "dem/genesis/packing_table.h"

#include "base/contains.h"
#include "base/input_error.h"
#include "base/mapped.h"
#include "base/quoted.h"
#include "base/table/csv.h"
#include "base/table/quantity.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace feldspar
{
namespace
{
struct NumberedLine
{
  std::size_t line;
  std::vector<double> values;
};

/// Numbers of a file, and what it says about them.
struct PackingLines
{
  std::vector<std::string> names; ///< of the columns; empty where the file has none
  std::size_t line_of_names = 1;
  std::array<double, 3> origin{}; ///< in the unit of the file
  std::vector<NumberedLine> rows;
  /// Atoms in data of LAMMPS may have the numbers of the boxes that they have crossed behind them.
  bool may_have_more = false;
  std::vector<NumberedLine> bonds; ///< their number, their type, and the numbers of two grains
};

/// The words of a line; a unit in brackets belongs to the word before it.
std::vector<std::string_view> words_of(const std::string_view line, const std::string_view separators)
{
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;
       at = line.find_first_not_of(separators, at))
    {
      const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
      std::string_view word = line.substr(at, end - at);
      if (!words.empty() && (word.front() == '[' || word.front() == '('))
        words.back() = line.substr(std::size_t(words.back().data() - line.data()),
                                   end - std::size_t(words.back().data() - line.data()));
      else
        words.push_back(word);
      at = end;
    }
  return words;
}

std::string_view without_quotes(const std::string_view word)
{
  return word.size() >= 2 && word.front() == '"' && word.back() == '"' ? word.substr(1, word.size() - 2) : word;
}

std::optional<double> as_number(const std::string_view word)
{
  const auto value = number_in<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Reads a file line by line.
class PackingReader
{
public:
  PackingReader(const std::filesystem::path& of_file, const std::function<void()>& its_check)
    : name(of_file.string())
    , stream(open_text(of_file))
    , check(its_check)
  {
  }

  PackingLines read()
  {
    PackingLines all;
    bool is_first = true;
    for (bool is_there = next(); is_there;)
      {
        if (words.front() == "ITEM:")
          {
            is_there = read_item(all);
            is_first = false;
            continue;
          }
        if ((is_first && line.find("LAMMPS") != std::string::npos) ||
            (all.rows.empty() && words.size() == 2 && words.back() == "atoms")) // below a title of other words
          {
            read_data(all);
            return all;
          }
        if (is_first && !value_of(words.front()))
          name_columns(all, words);
        else
          all.rows.push_back(numbers());
        is_first = false;
        is_there = next();
      }
    return all;
  }

private:
  /// The next line with something on it.
  bool next(const bool with_comments = false)
  {
    constexpr std::size_t lines_between_checks = 10000;
    do
      {
        if (!std::getline(*stream, line))
          return false;
        if (++number % lines_between_checks == 0)
          check();
        if (number == 1 && line.find("LAMMPS") != std::string::npos) // the title of a data file may begin with #
          std::ranges::replace(line, '#', ' ');
        if (constexpr std::string_view format = "#format "; line.starts_with(format)) // the column names of YADE
          {
            line.erase(0, format.size());
            std::ranges::replace(line, '_', ' ');
          }
        if (!with_comments)
          line.erase(std::min(line.find('#'), line.size()));
        if (separators.empty() && !trim(line).empty()) // the first line tells whether a comma is a decimal sign
          separators = line.find_first_of(";\t") != std::string::npos ? " \t\r;" : " \t\r,;";
        words = words_of(line, separators);
      }
    while (words.empty());
    return true;
  }

  /// The number that a word is, if it is one.
  std::optional<double> value_of(const std::string_view word)
  {
    std::string number_with_point(without_quotes(word));
    const std::size_t sign = number_with_point.find_first_of(".,");
    const char its_sign = sign == std::string::npos ? decimal_sign : number_with_point[sign];
    std::ranges::replace(number_with_point, ',', '.');
    const auto value = as_number(number_with_point);
    if (value && decimal_sign != 0 && its_sign != decimal_sign)
      throw InputError("{}:{}: {} has another decimal sign than the numbers before it", name, number, in_quotes(word));
    if (value)
      decimal_sign = its_sign;
    return value;
  }

  NumberedLine numbers()
  {
    // Words stand in columns that are not asked for, such as that of the material.
    return {number, mapped<double>(words, [&](const auto word) { return value_of(word).value_or(std::nan("")); })};
  }

  static void name_columns(PackingLines& all, const std::vector<std::string_view>& names)
  {
    all.names = mapped<std::string>(names, without_quotes);
  }

  /// A part of a dump; returns whether another follows.
  bool read_item(PackingLines& all)
  {
    const bool has_box = words.size() > 2 && words[1] == "BOX";
    const bool has_atoms = words.size() > 2 && words[1] == "ATOMS";
    if (has_box && words.size() > 3 && words[3] == "xy")
      throw InputError("{}:{}: a box that is not at right angles is not read", name, number);
    if (has_atoms)
      {
        name_columns(all, {words.begin() + 2, words.end()});
        all.line_of_names = number;
        all.rows.clear(); // of the step before
      }
    for (std::size_t k = 0; next();)
      {
        if (words.front() == "ITEM:")
          return true;
        if (has_box && k < 3)
          all.origin[k++] = as_number(words.front()).value_or(0.0);
        if (has_atoms)
          all.rows.push_back(numbers());
      }
    return false;
  }

  /// The names of the columns of atoms, from the style behind the name of their section: `Atoms # bpm/sphere`.
  void name_atoms(PackingLines& all) const
  {
    const std::vector<std::string_view> style(words.begin() + std::min<std::ptrdiff_t>(2, std::ssize(words)),
                                              words.end());
    if (style.empty() || (style.size() == 1 && style.front() == "sphere"))
      return;
    if (style.size() == 1 && style.front() == "bpm/sphere")
      all.names = {"id", "molecule", "type", "diameter", "density", "x", "y", "z"};
    else if (style.front() == "hybrid" && contains(style, "sphere"))
      {
        all.names = {"id", "type", "x", "y", "z"};
        for (std::size_t k = 1; k < style.size(); ++k)
          if (const std::string_view part = style[k]; part == "sphere")
            all.names.insert(all.names.end(), {"diameter", "density"});
          else if (part == "bond" || part == "angle" || part == "molecular")
            all.names.emplace_back("molecule");
          else
            throw InputError("{}:{}: a hybrid with {} is not read; it must be of sphere, bond, angle and "
                             "molecular",
                             name, number, in_quotes(part));
      }
    else
      throw InputError("{}:{}: atoms have the style {}; it must be sphere, bpm/sphere, or hybrid with sphere "
                       "and its other styles, which have diameters",
                       name, number, in_quotes(fmt::format("{}", fmt::join(style, " "))));
  }

  void read_data(PackingLines& all)
  {
    all.may_have_more = true;
    all.names = {"id", "type", "diameter", "density", "x", "y", "z"};
    std::string section;
    while (next(true))
      if (!value_of(words.front())) // the name of a section
        {
          section = words.front();
          if (section == "Atoms")
            name_atoms(all);
        }
      else if (section == "Atoms")
        all.rows.push_back(numbers());
      else if (section == "Bonds")
        all.bonds.push_back(numbers());
      else if (section.empty() && words.size() > 3)
        {
          if (words.size() > 5 && words[3] == "xy")
            throw InputError("{}:{}: a box that is not at right angles is not read", name, number);
          for (std::size_t axis = 0; axis < 3; ++axis)
            if (words[2] == std::array{"xlo", "ylo", "zlo"}[axis])
              all.origin[axis] = value_of(words.front()).value_or(0.0);
        }
  }

  std::string name;
  std::unique_ptr<std::istream> stream;
  const std::function<void()>& check;
  std::string line;
  std::vector<std::string_view> words;
  std::size_t number = 0;
  std::string_view separators; ///< of words; empty before the first line
  char decimal_sign = 0;       ///< as numbers have shown so far
};

/// A column of a table, and its unit in metres.
struct PackingColumn
{
  std::size_t place;
  double unit;
};

/// The column that has the first of these names that there is; none if there is no such. Names that end in _m are of metres;
/// `unit` is that of the others where they have none.
std::optional<PackingColumn> column_of(const PackingLines& lines, const std::vector<std::string_view>& names,
                                       const double unit, const std::string& file)
{
  for (const std::string_view wanted : names)
    for (std::size_t c = 0; c < lines.names.size(); ++c)
      {
        const auto [name, symbol] = title_of(lines.names[c]);
        if (in_small_letters(name) != wanted)
          continue;
        if (symbol.empty())
          return PackingColumn{c, wanted.ends_with("_m") ? 1.0 : unit};
        return rephrased(
          [&, its_symbol = symbol] {
            return PackingColumn{c, to_si(1.0, its_symbol, length)};
          },
          [&](const std::string& what) { return InputError("{}:{}: {}", file, lines.line_of_names, what); });
      }
  return std::nullopt;
}

/// Columns of x, y[, z] and the radius by their names.
std::vector<PackingColumn> columns_by_name(const PackingLines& lines, const int dim, const double unit,
                                           const std::string& file)
{
  std::vector<PackingColumn> columns;
  const std::vector<std::string_view> of_axis[] = {{"start_x_m", "x", "x_m", "position_x"},
                                                   {"start_y_m", "y", "y_m", "position_y"},
                                                   {"start_z_m", "z", "z_m", "position_z"}};
  const auto missing = [&](const std::string_view what) {
    return InputError("{}:{}: there is no column {}; there must be x, y{} and radius or diameter", file,
                      lines.line_of_names, what, dim == 3 ? ", z" : "");
  };
  for (int axis = 0; axis < dim; ++axis)
    if (const auto column = column_of(lines, of_axis[axis], unit, file))
      columns.push_back(*column);
    else
      throw missing(of_axis[axis][1]);
  if (const auto radius = column_of(lines, {"radius", "r", "radius_m"}, unit, file))
    columns.push_back(*radius);
  else if (const auto diameter = column_of(lines, {"diameter", "d", "diameter_m"}, unit, file))
    columns.push_back({diameter->place, 0.5 * diameter->unit});
  else
    throw missing("radius");
  return columns;
}

/// Columns of x, y[, z] and the radius by their order.
std::vector<PackingColumn> columns_by_order(const std::vector<NumberedLine>& rows, const int dim, const double unit,
                                            const std::string& file)
{
  const std::size_t n = rows.front().values.size();
  const auto is_numbered = [&] {
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (const double number = rows[k].values.front();
          number != std::floor(number) || (k > 0 && number <= rows[k - 1].values.front()))
        return false;
    return true;
  };
  const auto is_level = [&](const std::size_t column) {
    return std::ranges::all_of(rows, [&](const NumberedLine& row) {
      return row.values.size() == n && row.values[column] == rows.front().values[column];
    });
  };
  std::size_t first = 0;
  bool has_height = dim == 3;
  const auto n_wanted = std::size_t(dim) + 1;
  if (n == n_wanted + 1 && is_numbered()) // no packing has one grain a metre
    first = 1;
  else if (n == n_wanted + 1 && dim == 2 && is_level(2))
    has_height = true;
  else if (n == n_wanted + 2 && dim == 2 && is_numbered() && is_level(3))
    {
      first = 1;
      has_height = true;
    }
  else if (n != n_wanted)
    throw InputError("{}:{}: {} numbers found; a line is {}, in metres, perhaps after the number of the grain{}", file,
                     rows.front().line, n, dim == 2 ? "x y radius" : "x y z radius",
                     dim == 2 ? ", and with one z for all before the radius" : "");
  std::vector<PackingColumn> columns;
  columns.reserve(n_wanted);
  for (int axis = 0; axis < dim; ++axis)
    columns.push_back({first + std::size_t(axis), unit});
  columns.push_back({first + (has_height ? 3 : 2), unit});
  return columns;
}
/// The bonds by places of their grains, whose numbers are in the column id.
std::vector<PackedBond> bonds_of(const PackingLines& lines, const std::string& file)
{
  std::vector<PackedBond> bonds;
  if (lines.bonds.empty())
    return bonds;
  std::map<double, std::size_t> place_of; // the column of the number is the first one of atoms
  for (std::size_t k = 0; k < lines.rows.size(); ++k)
    place_of[lines.rows[k].values.front()] = k;
  for (const NumberedLine& bond : lines.bonds)
    {
      const std::size_t line = bond.line;
      const auto grain = [&](const std::size_t column) {
        const auto found = bond.values.size() < 4 || std::isnan(bond.values[column])
                             ? place_of.end()
                             : place_of.find(bond.values[column]);
        if (found == place_of.end())
          throw InputError("{}:{}: a bond is a line of its number, its type, and the numbers of two atoms "
                           "of the file",
                           file, line);
        return found->second;
      };
      bonds.push_back({line, grain(2), grain(3)});
      if (bonds.back().first == bonds.back().second)
        throw InputError("{}:{}: a bond joins an atom to itself", file, line);
    }
  return bonds;
}
} // namespace

PackingTable read_packing_table(const std::filesystem::path& path, const int dim, const double unit,
                                const std::function<void()>& check)
{
  const std::string file = path.string();
  const PackingLines lines = PackingReader(path, check).read();
  PackingTable packing;
  if (lines.rows.empty())
    return packing;
  const auto columns =
    lines.names.empty() ? columns_by_order(lines.rows, dim, unit, file) : columns_by_name(lines, dim, unit, file);
  packing.grains.reserve(lines.rows.size());
  for (const auto& [line, values] : lines.rows)
    {
      const std::size_t n_values = lines.names.empty() ? lines.rows.front().values.size() : lines.names.size();
      if (values.size() < n_values || (!lines.may_have_more && values.size() > n_values))
        throw InputError("{}:{}: {} numbers found; there must be {}, as in the lines before", file, line, values.size(),
                         n_values);
      PackedGrain grain{line, {}, 0.0};
      for (std::size_t c = 0; c < columns.size(); ++c)
        {
          const double value = columns[c].unit * values[columns[c].place];
          if (!std::isfinite(value))
            throw InputError("{}:{}: {} is not a number", file, line,
                             c + 1 == columns.size() ? "the radius" : std::string(1, "xyz"[c]));
          if (c + 1 == columns.size())
            grain.radius = value;
          else
            grain.position.push_back(value - unit * lines.origin[c]);
        }
      packing.grains.push_back(std::move(grain));
    }
  packing.bonds = bonds_of(lines, file);
  return packing;
}
} // namespace feldspar
