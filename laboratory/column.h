#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

namespace feldspar
{
/// Properties of a column, joined by |.
enum ColumnFlags : unsigned int
{
  positive_in_test = 1, ///< changes sign to be positive in the sense of the test
  added_later = 2,      ///< older tables do without, and it is 0
  only_of_samples = 4,  ///< only curves of samples of finite elements have it
  perhaps_nan = 8       ///< a body may not have it, as a gauge with too few grains
};

/// A column of a table in a result file: its name, with the place of its number in a row.
template <typename Row>
struct Column
{
  std::string_view name; ///< ends in its SI unit
  double (*get)(const Row& row);
  void (*set)(Row& row, double value);
  double most; ///< of a count or a number of something, the largest that is one; 0 of what need not be whole
  std::string_view meaning;
  unsigned int flags;

  constexpr bool is(const ColumnFlags flag) const { return (flags & flag) != 0; }
};

/// A part of a part of a whole, by pointers to members and places in arrays.
template <auto first, auto... further, typename Whole>
constexpr auto& part_of(Whole& whole)
{
  if constexpr (sizeof...(further) > 0)
    return part_of<further...>(part_of<first>(whole));
  else if constexpr (std::is_member_object_pointer_v<decltype(first)>)
    return whole.*first;
  else
    return whole[std::size_t(first)];
}

/// column<Row, &Row::energies, &Energies::kinetic>("kinetic_energy_J", "of the grains")
template <typename Row, auto... place>
constexpr Column<Row> column(const std::string_view name, const std::string_view meaning = "",
                             const unsigned int flags = 0)
{
  using Number = std::remove_cvref_t<decltype(part_of<place...>(std::declval<Row&>()))>;
  return {name,
          [](const Row& row) { return double(part_of<place...>(row)); },
          [](Row& row, const double value) { part_of<place...>(row) = Number(value); },
          std::is_integral_v<Number> ? std::min(0x1p53, double(std::numeric_limits<Number>::max())) : 0.0,
          meaning,
          flags};
}
} // namespace feldspar
