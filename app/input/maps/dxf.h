#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Drawings in DXF as text: pairs of lines, a group code and its value (AutoCAD DXF Reference, "ASCII DXF Files").
namespace feldspar
{
/// An entity, a layer, the header: all groups from a group code 0 to the next.
struct DxfRecord
{
  struct Group
  {
    int code;
    std::size_t line; ///< of the value
    std::string value;
  };

  std::filesystem::path file;
  std::string section; ///< in which it stands; empty: between sections
  std::string name;    ///< value of group 0
  std::size_t line;    ///< of the name
  std::vector<Group> groups;

  /// The first value of a group code, or else `otherwise`.
  std::string_view text(int code, std::string_view otherwise) const;

  /// The same as a whole number, and as a decimal number. Throws InputError for any other value.
  long integer(int code, long otherwise) const;
  double number(int code, double otherwise) const;

  /// The same; throws InputError where the group is missing.
  double number(int code) const;
};

/// Calls `visit` with each record of a drawing, one after the other. Throws InputError for a binary file, one that was
/// cut, and one whose lines are no pairs.
void for_each_record(const std::filesystem::path& file, const std::function<void(DxfRecord&&)>& visit);

/// The decimal number of a group; throws InputError.
double number_of(const DxfRecord& record, const DxfRecord::Group& group);
} // namespace feldspar
