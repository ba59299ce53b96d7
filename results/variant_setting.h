#pragma once

#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// The value of one entry in a variant of an input.
struct VariantSetting
{
  std::string entry; ///< Section/Entry
  std::string value; ///< as it would stand in an input file, such as 80 MPa
};

/// A number with its unit, as it was written.
struct WrittenNumber
{
  double value;
  std::string unit; ///< empty: none
};

/// Number of a setting; none where the value is no single number, such as a name or a list.
std::optional<WrittenNumber> number_of(const VariantSetting& setting);

/// An entry that differs between variants, as a column of a table for a data frame.
struct VariedColumn
{
  std::string entry;               ///< Section/Entry
  std::optional<std::string> unit; ///< in which all have it; none where units differ, or where it is no number

  std::string heading() const; ///< Section/Entry [unit]
  /// The number alone where the column has a unit, else the value as it was written; empty where there is none.
  std::string cell(const std::vector<VariantSetting>& settings) const;
};

/// The columns for rows with these settings, in the order in which entries come first.
std::vector<VariedColumn> varied_columns(const std::vector<std::vector<VariantSetting>>& of_rows);
} // namespace feldspar
