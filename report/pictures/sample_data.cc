#include "report/pictures/sample_view.h"

#include "base/prefixes.h"
#include "report/chart/page_writer.h"
#include "report/pictures/plot_style.h"
#include "report/pictures/rves.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <tuple>
#include <utility>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

constexpr std::size_t most_cells = 20'000; ///< some 4 MB

/// Name of a field in words, its unit and the size of this unit in SI.
struct FieldTitle
{
  std::string name;
  std::string unit;
  double size;
};

FieldTitle title_of(const std::string& field)
{
  for (const auto& [ending, unit, size] :
       {std::tuple("_share", "%", plot::percent), {"_Pa", "MPa", mega}, {"_per_m", "1/m", 1.0}, {"", "", 1.0}})
    if (field.ends_with(ending))
      {
        std::string name = field.substr(0, field.size() - std::string_view(ending).size());
        std::ranges::replace(name, '_', ' ');
        return {name, unit, size};
      }
  return {};
}

Json corners_of(const std::vector<PlanePoint>& points)
{
  Json corners = Json::array();
  for (const PlanePoint& point : points)
    for (const double x : point)
      corners.push_back(live::number(x / milli));
  return corners;
}
} // namespace

std::string sample_data(const FinishedTest& test, const SampleView& view, const std::vector<SamplePiece>& pieces,
                        const double scale)
{
  if (pieces.size() > most_cells)
    return "";
  const TestAppearance& appearance = test.appearance;
  const TestRecord& record = test.record;
  Json cells = Json::array();
  for (const SamplePiece& piece : pieces)
    cells.push_back(
      {{"cell", appearance.fields.of_each_cell.at("cell")[piece.cell]}, {"rest", corners_of(piece.rest)}});
  // Fields that belong to a row of the curve; the last ones in any case.
  std::vector<const SampleFields*> all_times;
  for (const SampleFields& earlier : appearance.fields_before)
    if (earlier.n_rows > 0 && earlier.n_rows < record.curve.size())
      all_times.push_back(&earlier);
  all_times.push_back(&appearance.fields);
  Json times = Json::array();
  for (const SampleFields* const fields : all_times)
    {
      std::string title = "the end";
      if (fields->n_rows > 0 && fields->n_rows <= record.curve.size())
        {
          const CurveSample& row = record.curve[fields->n_rows - 1];
          title = fmt::format("{} {:.3g}·10⁻³, {:.4g} MPa", record.kind.channel.strain_name,
                              record.kind.strain(row) / milli, record.kind.stress(row) / mega);
        }
      Json moved = Json::array();
      for (const SamplePiece& piece : SampleView(*fields, scale).pieces())
        moved.push_back(corners_of(piece.moved));
      times.push_back({{"title", title}, {"moved", std::move(moved)}});
    }
  Json all = Json::array();
  for (const auto& [field, last_values] : appearance.fields.of_each_cell)
    if (field != "cell")
      {
        const FieldTitle title = title_of(field);
        Json values = Json::array(); // of each time
        for (const SampleFields* const fields : all_times)
          {
            const auto found = fields->of_each_cell.find(field);
            Json of_pieces = Json::array();
            for (const SamplePiece& piece : pieces)
              of_pieces.push_back(found == fields->of_each_cell.end()
                                    ? Json()
                                    : live::number(found->second.at(piece.cell) / title.size, 4));
            values.push_back(std::move(of_pieces));
          }
        all.push_back({{"field", field}, {"name", title.name}, {"unit", title.unit}, {"values", std::move(values)}});
      }
  Json marks = Json::array();
  for (std::size_t k = 0; k < appearance.rves.size(); ++k)
    marks.push_back({{"letter", letter_of_rve(k)}, {"at", corners_of({view.place(appearance.rves[k])})}});
  return live::text({{"what", "sample"},
                     {"scale", live::number(scale)},
                     {"cells", cells},
                     {"times", times},
                     {"fields", all},
                     {"marks", marks}});
}
} // namespace feldspar
