#include "fem/mesh/gmsh_binary.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "fem/mesh/gmsh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>

namespace feldspar::fem
{
namespace
{
/// A word of a line, by its place; empty beyond the last.
std::string_view word_of(std::string_view line, int place)
{
  for (;; --place)
    {
      line.remove_prefix(std::min(line.find_first_not_of(" \r"), line.size()));
      const std::string_view word = line.substr(0, line.find_first_of(" \r"));
      if (place == 0 || word.empty())
        return word;
      line.remove_prefix(word.size());
    }
}

/// A binary file from its first byte on, and its text up to there. Lines begin and end sections; the numbers between
/// them are as Gmsh's manual lists them: int of 4 bytes, size_t and double of 8.
class BinaryGmsh
{
public:
  explicit BinaryGmsh(const std::string_view content)
    : all(content)
  {
  }

  std::string as_text()
  {
    copy_format();
    for (;;)
      {
        const std::string_view section = copy_line();
        if (section == "$PhysicalNames")
          while (copy_line() != "$EndPhysicalNames")
            ;
        else if (section == "$Entities" && is_v4)
          copy_entities();
        else if (section == "$Nodes")
          is_v4 ? copy_nodes_v4() : copy_nodes_v2();
        else if (section == "$Elements")
          {
            is_v4 ? copy_elements_v4() : copy_elements_v2();
            return std::move(text);
          }
        else
          refuse(fmt::format("$Nodes is expected instead of {}", excerpt(section)));
      }
  }

private:
  [[noreturn]] void refuse(const std::string& problem) const
  {
    throw InputError(fmt::format("byte {}: {}", position, problem));
  }

  void need(const std::size_t n_bytes) const
  {
    if (all.size() - position < n_bytes)
      refuse("the file ends here");
  }

  template <typename Number>
  Number take()
  {
    need(sizeof(Number));
    Number value;
    std::memcpy(&value, all.data() + position, sizeof(Number));
    position += sizeof(Number);
    return value;
  }

  template <typename Number>
  Number copy()
  {
    const auto value = take<Number>();
    fmt::format_to(std::back_inserter(text), "{} ", value);
    return value;
  }

  template <typename Number>
  void copy(const std::uint64_t n)
  {
    for (std::uint64_t k = 0; k < n; ++k)
      copy<Number>();
  }

  void end_row() { text.back() = '\n'; }

  std::string_view copy_line()
  {
    need(1);
    const std::string_view line = all.substr(position, all.substr(position).find('\n'));
    position = std::min(position + line.size() + 1, all.size());
    text.append(line).append("\n");
    return line;
  }

  void expect_line(const std::string_view wanted)
  {
    const std::size_t begin = position;
    if (const std::string_view line = copy_line(); line != wanted)
      {
        position = begin;
        refuse(
          fmt::format("{} is expected instead of {}", wanted.empty() ? "the end of a section" : wanted, excerpt(line)));
      }
  }

  void end_section(const std::string_view name)
  {
    expect_line("");
    expect_line(name);
  }

  void copy_format()
  {
    expect_line("$MeshFormat");
    const std::string_view line = all.substr(position, all.substr(position).find('\n'));
    const std::string_view version = word_of(line, 0);
    is_v4 = version == "4.1";
    if (!is_v4 && version != "2" && version != "2.1" && version != "2.2")
      refuse(fmt::format("binary format {} of Gmsh; 2.2 and 4.1 can be read, and 4.0 as text", excerpt(version)));
    if (word_of(line, 2) != "8")
      refuse(fmt::format("numbers of {} bytes; 8 can be read", excerpt(word_of(line, 2))));
    position += line.size();
    fmt::format_to(std::back_inserter(text), "{} 0 8", version);
    expect_line("");
    if (take<std::int32_t>() != 1)
      refuse("the bytes of its numbers are in the order of another kind of machine; save the mesh as text");
    expect_line("");
    text.pop_back(); // a text has no line here
    expect_line("$EndMeshFormat");
  }

  void copy_entities()
  {
    std::array<std::uint64_t, 4> n;
    for (auto& of_dimension : n)
      of_dimension = copy<std::uint64_t>();
    end_row();
    for (std::size_t d = 0; d < 4; ++d)
      for (std::uint64_t k = 0; k < n[d]; ++k)
        {
          copy<std::int32_t>();
          copy<double>(d == 0 ? 3 : 6);
          copy<std::int32_t>(copy<std::uint64_t>()); // physical groups
          if (d > 0)
            copy<std::int32_t>(copy<std::uint64_t>()); // boundaries
          end_row();
        }
    end_section("$EndEntities");
  }

  /// The number of nodes or elements of format 2, which is a line of text.
  std::uint64_t copy_count()
  {
    const std::size_t begin = position;
    const std::string line(copy_line());
    std::size_t n_read = 0;
    std::uint64_t n = 0;
    if (!line.empty() && line.size() < 19 && line.find_first_not_of("0123456789\r") == std::string::npos)
      n = std::stoull(line, &n_read);
    if (n_read == 0)
      {
        position = begin;
        refuse(fmt::format("a number of nodes or elements is expected instead of {}", excerpt(line)));
      }
    return n;
  }

  void copy_nodes_v2()
  {
    const std::uint64_t n = copy_count();
    for (std::uint64_t k = 0; k < n; ++k)
      {
        copy<std::int32_t>();
        copy<double>(3);
        end_row();
      }
    end_section("$EndNodes");
  }

  void copy_nodes_v4()
  {
    const auto n_blocks = copy<std::uint64_t>();
    copy<std::uint64_t>(3);
    end_row();
    for (std::uint64_t block = 0; block < n_blocks; ++block)
      {
        copy<std::int32_t>(2);
        if (copy<std::int32_t>() != 0)
          refuse("nodes with parameters on their curve or surface; save the mesh without (Mesh.SaveParametric = 0)");
        const auto n = copy<std::uint64_t>();
        end_row();
        for (std::uint64_t k = 0; k < n; ++k)
          {
            copy<std::uint64_t>();
            end_row();
          }
        for (std::uint64_t k = 0; k < n; ++k)
          {
            copy<double>(3);
            end_row();
          }
      }
    end_section("$EndNodes");
  }

  std::size_t n_nodes_of(const std::int32_t type) const
  {
    const std::optional<std::size_t> n = n_nodes_of_gmsh_type(type);
    if (!n)
      refuse(fmt::format("elements of Gmsh's type {}; points, lines, quadrilaterals and hexahedra can be read", type));
    return *n;
  }

  void copy_elements_v2()
  {
    const std::uint64_t n = copy_count();
    for (std::uint64_t n_read = 0; n_read < n;)
      {
        const auto type = take<std::int32_t>();
        const auto n_of_type = take<std::int32_t>();
        const auto n_tags = take<std::int32_t>();
        const std::size_t n_nodes = n_nodes_of(type);
        if (n_of_type < 1 || std::uint64_t(n_of_type) > n - n_read || n_tags < 0)
          refuse(fmt::format("{} elements with {} tags follow, where {} of {} elements are left", n_of_type, n_tags,
                             n - n_read, n));
        for (std::int32_t k = 0; k < n_of_type; ++k)
          {
            copy<std::int32_t>();
            fmt::format_to(std::back_inserter(text), "{} {} ", type, n_tags);
            copy<std::int32_t>(std::uint64_t(n_tags) + n_nodes);
            end_row();
          }
        n_read += std::uint64_t(n_of_type);
      }
    end_section("$EndElements");
  }

  void copy_elements_v4()
  {
    const auto n_blocks = copy<std::uint64_t>();
    copy<std::uint64_t>(3);
    end_row();
    for (std::uint64_t block = 0; block < n_blocks; ++block)
      {
        copy<std::int32_t>(2);
        const std::size_t n_nodes = n_nodes_of(copy<std::int32_t>());
        const auto n = copy<std::uint64_t>();
        end_row();
        for (std::uint64_t k = 0; k < n; ++k)
          {
            copy<std::uint64_t>(1 + n_nodes);
            end_row();
          }
      }
    end_section("$EndElements");
  }

  std::string_view all;
  std::size_t position = 0;
  std::string text;
  bool is_v4 = false;
};
} // namespace

bool is_binary_gmsh(const std::string_view content)
{
  constexpr std::string_view first = "$MeshFormat\n";
  if (!content.starts_with(first))
    return false;
  const std::string_view rest = content.substr(first.size());
  return word_of(rest.substr(0, rest.find('\n')), 1) == "1";
}

std::string text_of_binary_gmsh(const std::string_view content) { return BinaryGmsh(content).as_text(); }
} // namespace feldspar::fem
