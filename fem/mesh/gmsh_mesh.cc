#include "fem/mesh/gmsh_mesh.h"

#include "base/byte_archive.h"
#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/system/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmsh.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace feldspar::fem
{
template <typename Archive>
void transfer(Archive& archive, GmshMesh& mesh)
{
  archive.array("nodes", mesh.nodes);
  archive.array("cells", mesh.cells);
  archive.array("sides", mesh.sides);
  for (auto* const named : {&mesh.groups, &mesh.groups_of_cells})
    {
      std::vector<std::pair<std::string, std::uint32_t>> groups(named->begin(), named->end());
      std::uint64_t n_groups = groups.size();
      archive.value("number of groups", n_groups);
      groups.resize(n_groups);
      for (auto& [name, number] : groups)
        {
          archive.text("name", name);
          archive.value("group", number);
        }
      *named = {groups.begin(), groups.end()};
    }
}

namespace
{
/// A kind of element, by Gmsh's number.
struct Kind
{
  int number;
  int dimension;
  bool is_simplex = false;
};

// Point, line, triangle, quadrilateral, tetrahedron, hexahedron.
constexpr std::array<Kind, 6> kinds{{{15, 0}, {1, 1}, {2, 2, true}, {3, 2}, {4, 3, true}, {5, 3}}};

/// Has the library read a file, whose name it does not see: an ending or a file of options beside it would count.
void open_with_gmsh(const std::filesystem::path& file)
{
  const int opened = open(file.c_str(), O_RDONLY | O_NONBLOCK);
  constexpr std::string_view wanted = "$MeshFormat";
  std::string first(wanted.size(), ' ');
  if (opened < 0 || pread(opened, first.data(), first.size(), 0) != ssize_t(first.size()) || first != wanted)
    throw InputError("is not a mesh of Gmsh, which begins with $MeshFormat");
  const std::string name = fmt::format("/proc/self/fd/{}", opened);
  std::string problem;
  try
    {
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::merge(name);
      return;
    }
  catch (const std::string& error) // Gmsh 4.8
    {
      problem = error;
    }
  catch (const std::exception& error)
    {
      problem = error.what();
    }
  if (problem.find(name) == std::string::npos)
    throw InputError("is damaged; Gmsh says: {}", excerpt(problem));
  throw InputError("is damaged, or its format is none that Gmsh reads");
}

template <typename Nodes>
Nodes sorted(Nodes nodes)
{
  std::ranges::sort(nodes);
  return nodes;
}

/// Takes over and checks a mesh that the library has read.
class FromGmsh
{
public:
  explicit FromGmsh(const int its_dimension)
    : dimension(its_dimension)
  {
  }

  GmshMesh mesh()
  {
    take_nodes();
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities);
    for (const auto& [entity_dimension, entity] : entities)
      take_elements(entity_dimension, entity);
    if (cells.empty())
      throw InputError("has no {}", wanted);
    if (has_simplices)
      throw InputError("has cells that are not {}; in Gmsh recombine the mesh", wanted);
    for (auto* const elements : {&cells, &sides})
      std::ranges::sort(*elements, {}, &Element::number);
    check_sides();
    for (const auto& [all, checked] : {std::pair(&cells, &result.cells), std::pair(&sides, &result.sides)})
      for (const Element& element : *all)
        {
          checked->push_back({{}, std::uint32_t(element.group)});
          std::ranges::copy(element.nodes, checked->back().nodes.begin());
        }
    result.groups = groups_of(dimension - 1);
    result.groups_of_cells = groups_of(dimension);
    return std::move(result);
  }

private:
  struct Element
  {
    std::size_t number;
    std::vector<std::uint32_t> nodes;
    int group;
  };

  std::size_t number_of(const std::uint32_t node) const { return numbers[node]; }

  void take_nodes()
  {
    std::vector<double> coordinates, parameters;
    std::vector<std::size_t> in_file;
    gmsh::model::mesh::getNodes(in_file, coordinates, parameters);
    std::vector<std::size_t> order(in_file.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](const std::size_t k) { return in_file[k]; });
    for (const std::size_t k : order)
      {
        const std::array<double, 3> place{coordinates[3 * k], coordinates[3 * k + 1], coordinates[3 * k + 2]};
        constexpr double largest = 1e9; // [m]
        for (const double coordinate : place)
          if (!(std::abs(coordinate) <= largest))
            throw InputError("node {}: a coordinate in metres is expected instead of {:g}", in_file[k], coordinate);
        places.emplace(in_file[k], std::uint32_t(result.nodes.size()));
        numbers.push_back(in_file[k]);
        result.nodes.push_back(place);
      }
  }

  void take_elements(const int entity_dimension, const int entity)
  {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, entity_dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t)
      {
        const int type = types[t];
        const auto kind = std::ranges::find(kinds, type, &Kind::number);
        if (kind == kinds.end() || kind->dimension > dimension)
          throw InputError("elements of Gmsh's type {}; {} can be read", type,
                           dimension == 2 ? "points, lines and quadrilaterals"
                                          : "points, lines, quadrilaterals and hexahedra");
        if (kind->dimension < dimension - 1)
          continue;
        const bool is_cell = kind->dimension == dimension;
        has_simplices |= is_cell && kind->is_simplex;
        const int group = group_of(entity_dimension, entity);
        const std::size_t n_nodes = nodes[t].size() / elements[t].size();
        for (std::size_t k = 0; k < elements[t].size(); ++k)
          {
            Element element{elements[t][k], {}, group};
            for (std::size_t n = 0; n < n_nodes; ++n)
              element.nodes.push_back(places.at(nodes[t][k * n_nodes + n]));
            const auto in_order = sorted(element.nodes);
            if (std::ranges::adjacent_find(in_order) != in_order.end())
              throw InputError("element {} has one node twice", element.number);
            (is_cell ? cells : sides).push_back(std::move(element));
          }
      }
  }

  /// The library counts an entity with all its elements to a group, in files of format 2 too, which group each element.
  int group_of(const int entity_dimension, const int entity) const
  {
    std::vector<int> groups;
    gmsh::model::getPhysicalGroupsForEntity(entity_dimension, entity, groups);
    if (groups.size() > 1 && entity_dimension == dimension)
      return int(GmshMesh::several_groups);
    if (groups.size() > 1)
      throw InputError("{} {} is in the physical groups {} and {}; a part of the boundary has one",
                       entity_dimension == 1 ? "curve" : "surface", entity, groups[0], groups[1]);
    return groups.empty() ? 0 : groups[0];
  }

  /// The nodes around a side, begun at the least and gone on towards the lesser neighbour: the same however it is listed.
  static std::vector<std::uint32_t> as_cycle(std::vector<std::uint32_t> nodes)
  {
    std::rotate(nodes.begin(), std::ranges::min_element(nodes), nodes.end());
    if (nodes.size() > 2 && nodes.back() < nodes[1])
      std::reverse(nodes.begin() + 1, nodes.end());
    return nodes;
  }

  static std::string name_of(const int its_dimension, const int group)
  {
    std::string name;
    gmsh::model::getPhysicalName(its_dimension, group, name);
    return name.empty() ? fmt::format("{}", group) : name;
  }

  /// Drops the sides between two cells, such as the surface of a layer: no part of the boundary lies there.
  void check_sides()
  {
    const std::vector<std::vector<std::size_t>> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const std::vector<std::vector<std::size_t>> faces = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    struct Found
    {
      std::vector<std::uint32_t> cycle;
      int n_cells;
    };
    std::map<std::vector<std::uint32_t>, Found> by_nodes;
    for (const Element& cell : cells)
      for (const auto& corners : dimension == 2 ? edges : faces)
        {
          std::vector<std::uint32_t> side;
          for (const std::size_t corner : corners)
            side.push_back(cell.nodes[corner]);
          const auto cycle = as_cycle(side);
          Found& found = by_nodes.try_emplace(sorted(side), Found{cycle, 0}).first->second;
          if (++found.n_cells > 2 || found.cycle != cycle)
            throw InputError("more than two cells meet at the nodes {} and {}, or they do not fit together",
                             number_of(cycle[0]), number_of(cycle[1]));
        }
    std::erase_if(sides, [&](const Element& side) {
      const auto cycle = as_cycle(side.nodes);
      const auto found = by_nodes.find(sorted(cycle));
      if (found == by_nodes.end() || found->second.cycle != cycle)
        throw InputError("element {} on the nodes {} and {}{} is not the side of a cell", side.number,
                         number_of(cycle[0]), number_of(cycle[1]),
                         side.group == 0 ? "" : ", of the group " + excerpt(name_of(dimension - 1, side.group)) + ",");
      return found->second.n_cells == 2;
    });
  }

  static std::map<std::string, std::uint32_t> groups_of(const int its_dimension)
  {
    std::map<std::string, std::uint32_t> named;
    gmsh::vectorpair groups;
    gmsh::model::getPhysicalGroups(groups, its_dimension);
    for (const auto& [group_dimension, group] : groups)
      named.emplace(name_of(its_dimension, group), std::uint32_t(group));
    return named;
  }

  int dimension;
  const char* wanted = dimension == 2 ? "quadrilaterals" : "hexahedra";
  GmshMesh result;
  std::vector<std::size_t> numbers;                      ///< of the nodes in the file
  std::unordered_map<std::size_t, std::uint32_t> places; ///< of nodes, by their number in the file
  std::vector<Element> cells, sides;
  bool has_simplices = false;
};
} // namespace

GmshMesh read_gmsh_mesh(const std::filesystem::path& file, const int dimension)
{
  if (const std::string objection = objection_to_reading(file); !objection.empty())
    throw InputError(objection);
  const std::uint64_t size = std::filesystem::file_size(file);
  constexpr std::uint64_t megabyte = std::uint64_t(1) << 20;
  const ProcessLimits limits{10 + size / megabyte, 512 * megabyte + 64 * size};
  return from_bytes<GmshMesh>(made_by_child(
    "Gmsh's library", limits,
    [&] {
      open_with_gmsh(file);
      return to_bytes(FromGmsh(dimension).mesh());
    },
    [] {}));
}
} // namespace feldspar::fem
