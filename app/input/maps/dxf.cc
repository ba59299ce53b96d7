#include "app/input/maps/dxf.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/text.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace feldspar
{
namespace
{
std::optional<long> whole_number(std::string_view text)
{
  text = trim(text);
  text.remove_prefix(text.starts_with('+'));
  return number_in<long>(text);
}

const DxfRecord::Group* first_of(const DxfRecord& record, const int code)
{
  const auto found = std::ranges::find(record.groups, code, &DxfRecord::Group::code);
  return found == record.groups.end() ? nullptr : &*found;
}

/// Reads the groups of a file with their lines.
class Groups
{
public:
  explicit Groups(const std::filesystem::path& drawing)
    : file(drawing)
    , stream(drawing)
  {
    std::string mark(22, '\0');
    stream.read(mark.data(), std::streamsize(mark.size()));
    if (mark.starts_with("AutoCAD Binary DXF"))
      throw InputError("{}: is a binary DXF; save it as text (ASCII)", file.string());
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    stream.clear();
    stream.seekg(mark.starts_with(byte_order_mark) ? std::streamoff(byte_order_mark.size()) : 0);
  }

  /// The next group that is no comment; none at the end of the file.
  std::optional<DxfRecord::Group> next()
  {
    constexpr int comment = 999;
    constexpr long most = 1071; // "Group Code Value Types"
    constexpr long least = -5;
    std::string code, value;
    while (std::getline(stream, code) && std::getline(stream, value))
      {
        n_lines += 2;
        const std::optional<long> number = whole_number(code);
        if (!number || *number < least || *number > most)
          throw InputError("{}:{}: {} is no group code of DXF; a drawing is pairs of lines, a code and its "
                           "value",
                           file.string(), n_lines - 1, in_quotes(trim(code)));
        // The codes of coordinates, whatever they stand in: a word there means that lines are missing.
        if (*number >= 10 && *number <= 59 && !is_decimal_number(trim(value)))
          throw InputError("{}:{}: {} is not a decimal number, as group code {} has", file.string(), n_lines,
                           in_quotes(trim(value)), *number);
        if (*number != comment)
          return DxfRecord::Group{int(*number), n_lines, std::string(trim(value))};
      }
    return std::nullopt;
  }

  /// Programs and mail add blank lines, and the end-of-file character of DOS, behind the end of a drawing.
  void end()
  {
    for (std::string line; std::getline(stream, line);)
      if (++n_lines; line.find_first_not_of(" \t\r\n\x1a") != std::string::npos)
        throw InputError("{}:{}: {} stands behind the EOF of the drawing", file.string(), n_lines,
                         in_quotes(trim(line)));
  }

private:
  std::filesystem::path file;
  ReadableFile stream;
  std::size_t n_lines = 0;
};
} // namespace

std::string_view DxfRecord::text(const int code, const std::string_view otherwise) const
{
  const Group* const group = first_of(*this, code);
  return group ? group->value : otherwise;
}

long DxfRecord::integer(const int code, const long otherwise) const
{
  const Group* const group = first_of(*this, code);
  if (!group)
    return otherwise;
  const std::optional<long> value = whole_number(group->value);
  if (!value)
    throw InputError("{}:{}: {} is no whole number, as group code {} has", file.string(), group->line,
                     in_quotes(group->value), code);
  return *value;
}

double DxfRecord::number(const int code, const double otherwise) const
{
  const Group* const group = first_of(*this, code);
  return group ? number_of(*this, *group) : otherwise;
}

double DxfRecord::number(const int code) const
{
  const Group* const group = first_of(*this, code);
  if (!group)
    throw InputError("{}:{}: the {} has no group {}", file.string(), line, name, code);
  return number_of(*this, *group);
}

double number_of(const DxfRecord& record, const DxfRecord::Group& group)
{
  return rephrased([&] { return parse_number(group.value); },
                   [&](const std::string& what) {
                     return InputError("{}:{}: group code {}: {}", record.file.string(), group.line, group.code, what);
                   });
}

void for_each_record(const std::filesystem::path& file, const std::function<void(DxfRecord&&)>& visit)
{
  Groups groups(file);
  std::string section;
  std::optional<DxfRecord> record;
  const auto finish = [&] {
    if (!record)
      return;
    if (record->name == "SECTION")
      record->section = section = record->text(2, "");
    else if (record->name == "ENDSEC")
      section.clear();
    visit(std::move(*record));
  };
  while (auto group = groups.next())
    {
      if (group->code != 0)
        {
          if (!record)
            throw InputError("{}:{}: group code {} stands before the first code 0; this is no drawing", file.string(),
                             group->line, group->code);
          record->groups.push_back(std::move(*group));
          continue;
        }
      finish();
      if (group->value == "EOF")
        {
          groups.end();
          return;
        }
      record = DxfRecord{file, section, std::move(group->value), group->line, {}};
    }
  throw InputError("{}: does not end with EOF, as a complete DXF does", file.string());
}
} // namespace feldspar
