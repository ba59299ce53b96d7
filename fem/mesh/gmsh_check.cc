#include "fem/mesh/gmsh_check.h"

#include "base/input_error.h"
#include "base/quoted.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

namespace feldspar::fem
{
namespace
{
/// The words of a text, one after another.
class Words
{
public:
  explicit Words(const std::string_view all)
    : text(all)
  {
  }

  [[noreturn]] void refuse(const std::string& problem) const
  {
    throw InputError(fmt::format("line {}: {}", line, problem));
  }

  std::string_view next()
  {
    skip_blanks();
    const std::size_t begin = position;
    while (position < text.size() && !is_blank(text[position]))
      ++position;
    if (position == begin)
      refuse("the file ends here");
    return text.substr(begin, position - begin);
  }

  /// Between the quotation marks that follow, on one line.
  void skip_name()
  {
    skip_blanks();
    const std::string_view rest = text.substr(position, text.substr(position).find('\n'));
    if (rest.size() < 2 || rest.front() != '"' || rest.find('"', 1) == std::string_view::npos)
      refuse("a name in quotation marks is expected");
    position += rest.size();
  }

  void expect(const std::string_view wanted)
  {
    if (const std::string_view word = next(); word != wanted)
      refuse(fmt::format("{} is expected instead of {}", wanted, excerpt(word)));
  }

  std::int64_t integer(const std::int64_t low, const std::int64_t high)
  {
    const std::string_view word = next();
    const std::optional<std::int64_t> value = read<std::int64_t>(word);
    if (!value || *value < low || *value > high)
      refuse(fmt::format("an integer from {} to {} is expected instead of {}", low, high, excerpt(word)));
    return *value;
  }

  /// A number of things that follow, each of some words.
  std::int64_t count(const std::int64_t words_of_each)
  {
    const std::int64_t n = integer(0, std::int64_t(text.size()));
    const auto room = std::int64_t(text.size() - position) / 2; // a word and a blank
    if (n > room / words_of_each)
      refuse(fmt::format("{} are announced, the rest of the file has room for {}", n, room / words_of_each));
    return n;
  }

  void coordinate()
  {
    constexpr double largest = 1e9; // [m]
    const std::string_view word = next();
    const std::optional<double> value = read<double>(word);
    if (!value || !(std::abs(*value) <= largest))
      refuse(fmt::format("a coordinate in metres is expected instead of {}", excerpt(word)));
  }

private:
  static bool is_blank(const char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void skip_blanks()
  {
    for (; position < text.size() && is_blank(text[position]); ++position)
      line += text[position] == '\n';
  }

  template <typename Number>
  static std::optional<Number> read(const std::string_view word)
  {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
  }

  std::string_view text;
  std::size_t position = 0;
  std::size_t line = 1;
};

constexpr std::int64_t largest_tag = 1'000'000'000; // numbers of nodes, elements, groups and entities

enum class Format
{
  v2,
  v4_0,
  v4_1
};

struct Kind
{
  int dimension;
  std::size_t n_nodes;
};

/// The kinds that a mesh of quadrilaterals or hexahedra is made of, and the simplices that Gmsh makes where nobody asked
/// it to recombine them, by Gmsh's numbers.
const std::map<std::int64_t, Kind> kinds = {{15, {0, 1}}, {1, {1, 2}}, {2, {2, 3}},
                                            {3, {2, 4}},  {4, {3, 4}}, {5, {3, 8}}};
constexpr std::int64_t quadrilateral = 3;
constexpr std::int64_t hexahedron = 5;

const std::vector<std::vector<std::size_t>> edges_of_quadrilateral = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
const std::vector<std::vector<std::size_t>> faces_of_hexahedron = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

using Nodes = std::vector<std::int64_t>;

/// The nodes around a side, begun at the least and gone on towards the lesser neighbour: the same however it is listed.
Nodes as_cycle(Nodes nodes)
{
  std::rotate(nodes.begin(), std::min_element(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.size() > 2 && nodes.back() < nodes[1])
    std::reverse(nodes.begin() + 1, nodes.end());
  return nodes;
}

Nodes sorted(Nodes nodes)
{
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// The file from its first word to $EndElements.
class GmshText
{
public:
  GmshText(const std::string_view text, const int its_dimension)
    : words(text)
    , dimension(its_dimension)
  {
  }

  void check()
  {
    read_format();
    std::string_view section = words.next();
    if (section == "$PhysicalNames")
      {
        read_names();
        section = words.next();
      }
    if (section == "$Entities" && format != Format::v2)
      {
        read_entities();
        section = words.next();
      }
    if (section != "$Nodes")
      words.refuse(fmt::format("$Nodes is expected instead of {}", excerpt(section)));
    read_nodes();
    words.expect("$EndNodes");
    words.expect("$Elements");
    read_elements();
    words.expect("$EndElements");
    check_cells();
  }

private:
  void read_format()
  {
    words.expect("$MeshFormat");
    const std::string_view version = words.next();
    const std::map<std::string_view, Format> known = {{"2", Format::v2},     {"2.1", Format::v2},
                                                      {"2.2", Format::v2},   {"4", Format::v4_0},
                                                      {"4.0", Format::v4_0}, {"4.1", Format::v4_1}};
    const auto found = known.find(version);
    if (found == known.end())
      words.refuse(fmt::format("format {} of Gmsh; 2.2, 4.0 and 4.1 can be read", excerpt(version)));
    format = found->second;
    words.expect("0"); // text
    words.expect("8");
    words.expect("$EndMeshFormat");
  }

  void read_names()
  {
    const std::int64_t n = words.count(3);
    for (std::int64_t k = 0; k < n; ++k)
      {
        words.integer(0, 3);
        words.integer(0, largest_tag);
        words.skip_name();
      }
    words.expect("$EndPhysicalNames");
  }

  void read_tags()
  {
    const std::int64_t n = words.count(1);
    for (std::int64_t k = 0; k < n; ++k)
      words.integer(-largest_tag, largest_tag); // of a boundary with its sign
  }

  void read_entities()
  {
    std::array<std::int64_t, 4> n;
    for (auto& of_dimension : n)
      of_dimension = words.count(1);
    for (int d = 0; d < 4; ++d)
      for (std::int64_t k = 0; k < n[d]; ++k)
        {
          words.integer(0, largest_tag);
          for (int c = 0; c < (d == 0 && format == Format::v4_1 ? 3 : 6); ++c)
            words.coordinate();
          const std::int64_t n_groups = words.count(1);
          for (std::int64_t g = 0; g < n_groups; ++g)
            words.integer(0, largest_tag);
          if (d > 0)
            read_tags();
        }
    words.expect("$EndEntities");
  }

  void read_node_number()
  {
    if (const std::int64_t node = words.integer(0, largest_tag); !nodes.insert(node).second)
      words.refuse(fmt::format("there is another node {}", node));
  }

  void read_coordinates()
  {
    for (int c = 0; c < 3; ++c)
      words.coordinate();
  }

  void read_nodes()
  {
    if (format == Format::v2)
      {
        const std::int64_t n = words.count(4);
        for (std::int64_t k = 0; k < n; ++k)
          {
            read_node_number();
            read_coordinates();
          }
        return;
      }
    const std::int64_t n_blocks = words.count(4);
    const std::int64_t n = words.count(4);
    read_range_of_tags();
    std::int64_t n_read = 0;
    for (std::int64_t block = 0; block < n_blocks; ++block)
      {
        words.integer(0, largest_tag); // tag and dimension of its entity, in either order
        words.integer(0, largest_tag);
        words.integer(0, 0); // coordinates alone, no parameters on a surface
        const std::int64_t n_in_block = words.count(4);
        n_read += n_in_block;
        if (format == Format::v4_0)
          for (std::int64_t k = 0; k < n_in_block; ++k)
            {
              read_node_number();
              read_coordinates();
            }
        else
          {
            for (std::int64_t k = 0; k < n_in_block; ++k)
              read_node_number();
            for (std::int64_t k = 0; k < n_in_block; ++k)
              read_coordinates();
          }
      }
    expect_count(n_read, n);
  }

  void read_range_of_tags()
  {
    if (format == Format::v4_1)
      for (int k = 0; k < 2; ++k)
        words.integer(0, largest_tag);
  }

  void expect_count(const std::int64_t found, const std::int64_t announced) const
  {
    if (found != announced)
      words.refuse(fmt::format("{} were announced, {} are there", announced, found));
  }

  const Kind& read_kind(std::int64_t& number)
  {
    number = words.integer(0, largest_tag);
    const auto kind = kinds.find(number);
    if (kind == kinds.end() || kind->second.dimension > dimension)
      words.refuse(fmt::format("elements of Gmsh's type {}; {} can be read", number,
                               dimension == 2 ? "points, lines and quadrilaterals"
                                              : "points, lines, quadrilaterals and hexahedra"));
    return kind->second;
  }

  void read_element_nodes(const std::int64_t number, const Kind& kind)
  {
    Nodes of_element(kind.n_nodes);
    for (auto& node : of_element)
      if (node = words.integer(0, largest_tag); !nodes.contains(node))
        words.refuse(fmt::format("there is no node {}", node));
    const Nodes in_order = sorted(of_element);
    if (std::adjacent_find(in_order.begin(), in_order.end()) != in_order.end())
      words.refuse("an element has one node twice");
    if (kind.dimension == dimension)
      {
        has_simplices |= number != quadrilateral && number != hexahedron;
        cells.push_back(std::move(of_element));
      }
    else if (kind.dimension == dimension - 1)
      sides.push_back(as_cycle(std::move(of_element)));
  }

  void read_elements()
  {
    if (format == Format::v2)
      {
        const std::int64_t n = words.count(4);
        for (std::int64_t k = 0; k < n; ++k)
          {
            words.integer(0, largest_tag);
            std::int64_t number = 0;
            const Kind& kind = read_kind(number);
            const std::int64_t n_tags = words.count(1);
            for (std::int64_t t = 0; t < n_tags; ++t)
              words.integer(t == 0 ? 0 : -largest_tag, largest_tag);
            read_element_nodes(number, kind);
          }
        return;
      }
    const std::int64_t n_blocks = words.count(4);
    const std::int64_t n = words.count(2);
    read_range_of_tags();
    std::int64_t n_read = 0;
    for (std::int64_t block = 0; block < n_blocks; ++block)
      {
        const std::int64_t first = words.integer(0, largest_tag);
        const std::int64_t second = words.integer(0, largest_tag);
        std::int64_t number = 0;
        const Kind& kind = read_kind(number);
        if ((format == Format::v4_0 ? second : first) != kind.dimension)
          words.refuse("elements of another dimension than their entity");
        const std::int64_t n_in_block = words.count(std::int64_t(1 + kind.n_nodes));
        n_read += n_in_block;
        for (std::int64_t k = 0; k < n_in_block; ++k)
          {
            words.integer(0, largest_tag);
            read_element_nodes(number, kind);
          }
      }
    expect_count(n_read, n);
  }

  void check_cells() const
  {
    const char* const wanted = dimension == 2 ? "quadrilaterals" : "hexahedra";
    if (cells.empty())
      throw InputError(fmt::format("has no {}", wanted));
    if (has_simplices)
      throw InputError(fmt::format("has cells that are not {}; in Gmsh recombine the mesh", wanted));

    struct Side
    {
      Nodes cycle;
      int n_cells;
    };
    std::map<Nodes, Side> by_nodes;
    for (const Nodes& cell : cells)
      for (const auto& places : dimension == 2 ? edges_of_quadrilateral : faces_of_hexahedron)
        {
          Nodes side;
          for (const std::size_t place : places)
            side.push_back(cell[place]);
          const Nodes cycle = as_cycle(side);
          Side& found = by_nodes.try_emplace(sorted(side), Side{cycle, 0}).first->second;
          if (++found.n_cells > 2 || found.cycle != cycle)
            throw InputError(fmt::format("more than two cells meet at the nodes {} and {}, or they do not fit together",
                                         cycle[0], cycle[1]));
        }
    for (const Nodes& side : sides)
      if (const auto found = by_nodes.find(sorted(side)); found == by_nodes.end() || found->second.cycle != side)
        throw InputError(fmt::format("the element on the nodes {} and {} is not the side of a cell", side[0], side[1]));
  }

  Words words;
  int dimension;
  Format format = Format::v2;
  std::unordered_set<std::int64_t> nodes;
  std::vector<Nodes> cells, sides;
  bool has_simplices = false;
};
} // namespace

void check_gmsh(const std::string_view text, const int dimension) { GmshText(text, dimension).check(); }

std::optional<std::size_t> n_nodes_of_gmsh_type(const std::int64_t type)
{
  const auto kind = kinds.find(type);
  return kind == kinds.end() ? std::nullopt : std::optional(kind->second.n_nodes);
}
} // namespace feldspar::fem
