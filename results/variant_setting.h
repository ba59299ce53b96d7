#pragma once

#include <optional>
#include <string>

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
} // namespace feldspar
