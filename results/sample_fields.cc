#include "results/sample_fields.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/readable_file.h"
#include "base/system/hdf5_archive.h"
#include "base/text.h"
#include "laboratory/named_entries.h"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <string_view>

namespace feldspar
{
namespace
{
std::string expected() { return fmt::format("a field of `{}`", input_entries::multiscale); }

InputError objection_to(const std::filesystem::path& index, const std::string_view what)
{
  return InputError("{}: {}", index.string(), what);
}

InputError objection_to_content(const std::filesystem::path& index)
{
  return objection_to(index, fmt::format("not XDMF of `{}`, or cut short", input_entries::multiscale));
}

/// "FILE:/ARRAY" of a <DataItem>.
struct Place
{
  std::string file;
  std::string array;
};

Place place_of(const pugi::xml_node& parent, const std::filesystem::path& index)
{
  std::string text = parent.child_value("DataItem");
  std::erase_if(text, [](const char c) { return c == ' ' || c == '\n' || c == '\t'; });
  const std::size_t colon = text.find(":/");
  if (colon == std::string::npos)
    throw objection_to(index, "a DataItem names no array of a file");
  Place place{text.substr(0, colon), text.substr(colon + 2)};
  if (!is_plain_name(place.file))
    throw objection_to(index, fmt::format("a DataItem names {}, which is no file of this folder that `{}` writes",
                                          in_quotes(place.file), input_entries::multiscale));
  return place;
}

/// A time of the index.
struct IndexedTime
{
  double time;
  Place nodes;
  Place cells;
  std::map<std::string, Place> fields;
};

/// Says whether elements are nested less deep than in a file that was made up.
struct LimitOfDepth : pugi::xml_tree_walker
{
  static constexpr int most_levels = 100;
  bool for_each(pugi::xml_node&) override { return depth() < most_levels; }
};

/// Times in an index in their order, one at least.
std::vector<IndexedTime> times_in(const std::filesystem::path& index)
{
  const std::string text = content_of(index);
  pugi::xml_document xml;
  const pugi::xml_parse_result parsed = xml.load_buffer(text.data(), text.size());
  if (LimitOfDepth limit; !xml.traverse(limit))
    throw objection_to(index, fmt::format("is nested more than {} levels deep", LimitOfDepth::most_levels));
  const pugi::xml_node all = xml.child("Xdmf").child("Domain").child("Grid");
  if (!parsed || !all)
    throw objection_to_content(index);
  std::vector<IndexedTime> times;
  for (const pugi::xml_node& grid : all.children("Grid"))
    {
      const std::string_view time = grid.child("Time").attribute("Value").value();
      if (!is_decimal_number(time))
        throw objection_to_content(index);
      times.push_back(
        {parse_number(time), place_of(grid.child("Geometry"), index), place_of(grid.child("Topology"), index), {}});
      for (const pugi::xml_node& attribute : grid.children("Attribute"))
        times.back().fields[attribute.attribute("Name").value()] = place_of(attribute, index);
    }
  if (times.empty())
    throw objection_to(index, "there is no time in it");
  return times;
}

/// Rows of `n_columns`, filled up to three.
std::vector<std::array<double, 3>> points_of(const std::vector<double>& values, const std::size_t n_columns)
{
  std::vector<std::array<double, 3>> points(values.size() / n_columns);
  for (std::size_t i = 0; i < points.size(); ++i)
    std::copy_n(values.begin() + std::ptrdiff_t(n_columns * i), n_columns, points[i].begin());
  return points;
}

/// The fields of a time of the index.
SampleFields fields_of(const std::filesystem::path& index, const IndexedTime& one)
{
  const std::filesystem::path folder = index.parent_path();
  SampleFields fields;
  constexpr double most_rows = 1e12;
  if (!(one.time >= 0.0 && one.time <= most_rows))
    throw objection_to(index, "a time is no number of rows");
  fields.n_rows = std::size_t(one.time);
  std::vector<double> nodes, displacement;
  std::vector<std::uint32_t> corners;
  read_foreign_hdf5(folder / one.nodes.file, expected(), [&](Hdf5Reader& root) {
    root.array(one.nodes.array, nodes);
    root.array(one.cells.array, corners);
  });
  if (one.fields.empty())
    throw objection_to(index, "there is no field in it");
  // Values of each node, those of cells too; all in one file.
  std::map<std::string, std::vector<double>> of_nodes;
  read_foreign_hdf5(folder / one.fields.begin()->second.file, expected(), [&](Hdf5Reader& root) {
    for (const auto& [name, place] : one.fields)
      root.array(place.array, of_nodes[name]);
  });

  // Every field has a value a node, and every node is of one cell.
  const std::size_t n_nodes = corners.size();
  fields.dimension = nodes.size() == 2 * n_nodes ? 2 : 3;
  const std::size_t n_corners = fields.dimension == 2 ? 4 : 8;
  const bool fits = n_nodes > 0 && nodes.size() == fields.dimension * n_nodes && n_nodes % n_corners == 0 &&
                    of_nodes["displacement"].size() == 3 * n_nodes &&
                    std::ranges::all_of(corners, [=](const std::uint32_t i) { return i < n_nodes; });
  if (!fits)
    throw objection_to(index, "its arrays differ in length");
  fields.nodes = points_of(nodes, fields.dimension);
  fields.displacement = points_of(of_nodes["displacement"], 3);
  for (std::size_t begin = 0; begin < n_nodes; begin += n_corners)
    fields.cells.emplace_back(corners.begin() + std::ptrdiff_t(begin),
                              corners.begin() + std::ptrdiff_t(begin + n_corners));
  for (const auto& [name, values] : of_nodes)
    if (values.size() == n_nodes)
      for (const auto& cell : fields.cells)
        fields.of_each_cell[name].push_back(values[cell.front()]);
  return fields;
}

std::filesystem::path index_of(const std::filesystem::path& folder, const std::string& name)
{
  return folder / (name + ".xdmf");
}
} // namespace

SampleFields read_sample_fields(const std::filesystem::path& folder, const std::string& name)
{
  const auto index = index_of(folder, name);
  return fields_of(index, times_in(index).back());
}

std::vector<SampleFields> read_earlier_sample_fields(const std::filesystem::path& folder, const std::string& name,
                                                     const std::size_t most_cells)
{
  std::vector<SampleFields> earlier;
  const auto index = index_of(folder, name);
  const auto times = times_in(index);
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    {
      earlier.push_back(fields_of(index, times[k]));
      if (earlier.front().cells.size() * (times.size() - 1) > most_cells)
        return {};
    }
  return earlier;
}

void for_each_time(const std::filesystem::path& folder, const std::string& name,
                   const std::function<void(const SampleFields&)>& use)
{
  const auto index = index_of(folder, name);
  for (const IndexedTime& one : times_in(index))
    use(fields_of(index, one));
}
} // namespace feldspar
