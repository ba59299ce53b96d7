#include "results/sample_fields.h"

#include "base/input_error.h"
#include "base/readable_file.h"
#include "base/system/hdf5_archive.h"
#include "laboratory/named_entries.h"

#include <boost/property_tree/ptree.hpp>
#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>

namespace feldspar
{
namespace
{
using Xml = boost::property_tree::ptree;

std::string expected() { return fmt::format("a field of `{}`", input_entries::multiscale); }

std::string objection_to_content() { return fmt::format("not XDMF of `{}`, or cut short", input_entries::multiscale); }

/// Reads XML as boost/property_tree has it, attributes as children of <xmlattr>, but to a limited depth: readers that
/// descend into it use the stack.
class XmlReader
{
public:
  static Xml read(const std::filesystem::path& file)
  {
    const std::string text = content_of(file);
    XmlReader reader;
    const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), XML_ParserFree);
    if (!parser)
      throw std::bad_alloc();
    XML_SetUserData(parser.get(), &reader);
    XML_SetElementHandler(parser.get(), &XmlReader::begin, &XmlReader::end);
    XML_SetCharacterDataHandler(parser.get(), &XmlReader::add_text);
    constexpr std::size_t piece_size = std::size_t(1) << 20; // the parser counts in int
    bool is_xml = true;
    for (std::size_t at = 0; is_xml && !reader.is_too_deep && at < text.size(); at += piece_size)
      is_xml = XML_Parse(parser.get(), text.data() + at, int(std::min(piece_size, text.size() - at)),
                         at + piece_size >= text.size()) == XML_STATUS_OK;
    if (reader.is_too_deep)
      throw InputError(fmt::format("{}: is nested more than {} levels deep", file.string(), most_levels));
    if (!is_xml || text.empty())
      throw InputError(fmt::format("{}: {}", file.string(), objection_to_content()));
    return std::move(reader.root);
  }

private:
  static constexpr std::size_t most_levels = 100;

  static void begin(void* const reader, const char* const name, const char** attribute)
  {
    auto& self = *static_cast<XmlReader*>(reader);
    self.is_too_deep = self.is_too_deep || self.open.size() > most_levels;
    if (self.is_too_deep)
      return; // an exception cannot pass through the library
    Xml& element = self.open.back()->push_back({name, {}})->second;
    for (; *attribute; attribute += 2)
      element.push_back({"<xmlattr>", {}})->second.push_back({attribute[0], Xml(attribute[1])});
    self.open.push_back(&element);
  }

  static void end(void* const reader, const char*)
  {
    auto& self = *static_cast<XmlReader*>(reader);
    if (!self.is_too_deep)
      self.open.pop_back();
  }

  static void add_text(void* const reader, const char* const text, const int length)
  {
    auto& self = *static_cast<XmlReader*>(reader);
    if (!self.is_too_deep)
      self.open.back()->data().append(text, std::size_t(length));
  }

  Xml root;
  std::vector<Xml*> open{&root}; ///< elements, the outermost first
  bool is_too_deep = false;
};

/// "FILE:/ARRAY" of a <DataItem>.
struct Place
{
  std::string file;
  std::string array;
};

Place place_of(const Xml& parent)
{
  std::string text = parent.get<std::string>("DataItem");
  text.erase(std::remove_if(text.begin(), text.end(), [](const char c) { return c == ' ' || c == '\n' || c == '\t'; }),
             text.end());
  const std::size_t colon = text.find(":/");
  if (colon == std::string::npos)
    throw InputError("a DataItem names no array of a file");
  if (text.find('/') < colon)
    throw InputError("a DataItem names a file of another folder");
  return {text.substr(0, colon), text.substr(colon + 2)};
}

/// A time of the index.
struct IndexedTime
{
  double time;
  Place nodes;
  Place cells;
  std::map<std::string, Place> fields;
};

/// Times in an index in their order, one at least.
std::vector<IndexedTime> times_in(const std::filesystem::path& index)
{
  const Xml xml = XmlReader::read(index);
  std::vector<IndexedTime> times;
  for (const auto& [tag, child] : xml.get_child("Xdmf.Domain.Grid"))
    if (tag == "Grid")
      {
        times.push_back({child.get<double>("Time.<xmlattr>.Value"),
                         place_of(child.get_child("Geometry")),
                         place_of(child.get_child("Topology")),
                         {}});
        for (const auto& [part, attribute] : child)
          if (part == "Attribute")
            times.back().fields[attribute.get<std::string>("<xmlattr>.Name")] = place_of(attribute);
      }
  if (times.empty())
    throw InputError("there is no time in it");
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

SampleFields fields_of(const std::filesystem::path& folder, const IndexedTime& one)
{
  SampleFields fields;
  constexpr double most_rows = 1e12;
  if (!(one.time >= 0.0 && one.time <= most_rows))
    throw InputError("a time is no number of rows");
  fields.n_rows = std::size_t(one.time);
  std::vector<double> nodes, displacement;
  std::vector<std::uint32_t> corners;
  read_foreign_hdf5(folder / one.nodes.file, expected(), [&](Hdf5Reader& root) {
    root.array(one.nodes.array, nodes);
    root.array(one.cells.array, corners);
  });
  if (one.fields.empty())
    throw InputError("there is no field in it");
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
                    std::all_of(corners.begin(), corners.end(), [=](const std::uint32_t i) { return i < n_nodes; });
  if (!fits)
    throw InputError("its arrays differ in length");
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

/// Says which index it was that could not be read.
template <typename Work>
auto reading(const std::filesystem::path& index, Work&& work)
{
  if (const std::string objection = objection_to_reading(index); !objection.empty())
    throw InputError(fmt::format("{}: {}", index.string(), objection));
  try
    {
      return work();
    }
  catch (const boost::property_tree::ptree_error& error)
    {
      throw InputError(fmt::format("{}: {}", index.string(), objection_to_content()));
    }
}
} // namespace

SampleFields read_sample_fields(const std::filesystem::path& folder, const std::string& name)
{
  const auto index = index_of(folder, name);
  return reading(index, [&] { return fields_of(folder, times_in(index).back()); });
}

std::vector<SampleFields> read_earlier_sample_fields(const std::filesystem::path& folder, const std::string& name,
                                                     const std::size_t most_cells)
{
  const auto index = index_of(folder, name);
  return reading(index, [&] {
    std::vector<SampleFields> earlier;
    const auto times = times_in(index);
    for (std::size_t k = 0; k + 1 < times.size(); ++k)
      {
        earlier.push_back(fields_of(folder, times[k]));
        if (earlier.front().cells.size() * (times.size() - 1) > most_cells)
          return std::vector<SampleFields>();
      }
    return earlier;
  });
}

void for_each_time(const std::filesystem::path& folder, const std::string& name,
                   const std::function<void(const SampleFields&)>& look)
{
  const auto index = index_of(folder, name);
  reading(index, [&] {
    for (const IndexedTime& one : times_in(index))
      look(fields_of(folder, one));
  });
}
} // namespace feldspar
