#include "results/folder/quakeml.h"

#include "base/input_error.h"
#include "base/quoted.h"
#include "base/table/quantity.h"
#include "base/text.h"
#include "base/whole_file.h"
#include "results/emission.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>

namespace feldspar
{
namespace
{
constexpr double earth_radius = 6371e3; // [m], of a sphere
constexpr double degree = std::numbers::pi / 180.0;

void add_text(pugi::xml_node parent, const char* const name, const std::string& text)
{
  parent.append_child(name).text() = text.c_str();
}

/// A quantity, whose number is an element of its own.
void add_value(pugi::xml_node parent, const char* const name, const double value)
{
  add_text(parent.append_child(name), "value", format_number(value));
}

pugi::xml_node add_resource(pugi::xml_node parent, const char* const name, const std::string& id)
{
  pugi::xml_node resource = parent.append_child(name);
  resource.append_attribute("publicID") = id.c_str();
  return resource;
}

/// Adds a magnitude, by the method of a paper; none where it is NaN. Returns its identifier.
std::string add_magnitude(pugi::xml_node event, const std::string& id, const char* const type, const double magnitude,
                          const char* const method)
{
  if (std::isnan(magnitude))
    return "";
  const std::string own_id = fmt::format("{}/magnitude/{}", id, type);
  pugi::xml_node element = add_resource(event, "magnitude", own_id);
  add_value(element, "mag", magnitude);
  add_text(element, "type", type);
  add_text(element, "originID", id + "/origin");
  add_text(element, "methodID", std::string("smi:local/feldspar/method/") + method);
  return own_id;
}

std::string as_text(const std::time_t start, const double seconds)
{
  const double whole = std::floor(seconds);
  return fmt::format("{:%FT%T}.{:09.0f}Z", fmt::gmtime(start + std::time_t(whole)),
                     std::min(std::round(1e9 * (seconds - whole)), 999999999.0));
}

void add_event(pugi::xml_node parent, const EmissionEvent& event, const int dimension, const std::string& id,
               const QuakemlOrigin& origin)
{
  const SourceMechanism source = mechanism(event, dimension);
  pugi::xml_node element = add_resource(parent, "event", id);
  add_text(element, "preferredOriginID", id + "/origin");
  add_text(element.append_child("comment"), "text",
           fmt::format("{}; breaks: {} in tension, {} in shear; released energy: {:.6g} J; extent: {:.6g} m",
                       source.kind.empty() ? "no moment" : source.kind, event.n_tension, event.n_shear,
                       event.released_energy, event.extent));

  const std::size_t north = dimension == 3 ? 1 : 2; // in the plane nothing is known along it, and it is 0
  const std::size_t up = dimension == 3 ? 2 : 1;
  pugi::xml_node place = add_resource(element, "origin", id + "/origin");
  add_text(place.append_child("time"), "value", as_text(origin.time, event.time));
  add_value(place, "latitude", origin.latitude + event.centroid[north] / earth_radius / degree);
  add_value(place, "longitude",
            origin.longitude + event.centroid[0] / (earth_radius * std::cos(origin.latitude * degree)) / degree);
  add_value(place, "depth", origin.depth - event.centroid[up]);

  const std::string moment_magnitude = add_magnitude(element, id, "Mw", source.magnitude, "Hanks-Kanamori-1979");
  add_magnitude(element, id, "Me", energy_magnitude(event.released_energy), "Choy-Boatwright-1995");
  if (moment_magnitude.empty())
    return;
  add_text(element, "preferredMagnitudeID", moment_magnitude);
  add_text(element, "preferredFocalMechanismID", id + "/mechanism");
  pugi::xml_node tensor =
    add_resource(add_resource(element, "focalMechanism", id + "/mechanism"), "momentTensor", id + "/moment-tensor");
  add_text(tensor, "derivedOriginID", id + "/origin");
  add_text(tensor, "momentMagnitudeID", moment_magnitude);
  add_value(tensor, "scalarMoment", source.scalar_moment);
  constexpr std::size_t place_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const auto moment = [&](const std::size_t i, const std::size_t k) { return event.moment[place_of[i][k]]; };
  pugi::xml_node components = tensor.append_child("tensor"); // r points up, t to the south, p to the east
  add_value(components, "Mrr", moment(up, up));
  add_value(components, "Mtt", moment(north, north));
  add_value(components, "Mpp", moment(0, 0));
  add_value(components, "Mrt", -moment(up, north) + 0.0); // no -0
  add_value(components, "Mrp", moment(up, 0));
  add_value(components, "Mtp", -moment(north, 0) + 0.0);
  add_text(tensor, "doubleCouple", format_number(source.double_couple));
  add_text(tensor, "clvd", format_number(std::abs(source.clvd))); // shares, whose signs are those of the tensor
  add_text(tensor, "iso", format_number(std::abs(source.isotropic)));
}
} // namespace

QuakemlOrigin parse_quakeml_origin(const std::string_view text)
{
  static const std::regex form("([0-9.]+) ([NS]), *([0-9.]+) ([EW]), *([^,]+), *([0-9-]+T[0-9:]+Z)");
  const auto refusal = [](const std::string_view reason) {
    return InputError("--quakeml must be latitude, longitude, depth and time of the origin of the axes, as in "
                      "\"41.0 N, 97.0 E, 500 m, 2026-01-01T00:00:00Z\": {}",
                      reason);
  };
  const std::string given(text);
  std::smatch part;
  if (!std::regex_match(given, part, form))
    throw refusal("found is " + in_quotes(text));
  QuakemlOrigin origin{};
  rephrased(
    [&] {
      origin.latitude = (part[2] == "N" ? 1.0 : -1.0) * parse_number(part[1].str());
      origin.longitude = (part[4] == "E" ? 1.0 : -1.0) * parse_number(part[3].str());
      origin.depth = parse_quantity(part[5].str(), length);
    },
    refusal);
  if (std::abs(origin.latitude) > 89.0 || std::abs(origin.longitude) > 180.0)
    throw refusal("the latitude must be at most 89 and the longitude at most 180 degrees");
  std::tm time{};
  const std::string of_time = part[6];
  const char* const end = strptime(of_time.c_str(), "%Y-%m-%dT%H:%M:%SZ", &time);
  const int day = time.tm_mday;
  origin.time = timegm(&time); // which makes 1 March of 29 February
  if (end == nullptr || *end != '\0' || time.tm_mday != day)
    throw refusal("there is no such time");
  return origin;
}

void write_quakeml(const std::vector<Series>& all, const QuakemlOrigin& origin, const std::filesystem::path& folder)
{
  constexpr double longest = 1e9; // of times [s], some 30 years
  bool any = false;
  for (const Series& series : all)
    for (const FinishedTest& test : series.tests)
      {
        const std::vector<EmissionEvent>& events = test.record.events;
        if (events.empty())
          continue;
        if (std::ranges::any_of(events, [](const auto& one) { return !(std::abs(one.time) < longest); }))
          throw InputError("--quakeml: an event of {} has no time up to {:g} s; samples have none", test.name, longest);
        pugi::xml_document document;
        pugi::xml_node root = document.append_child("q:quakeml");
        root.append_attribute("xmlns:q") = "http://quakeml.org/xmlns/quakeml/1.2";
        root.append_attribute("xmlns") = "http://quakeml.org/xmlns/bed/1.2";
        const std::string id = "smi:local/feldspar/" + test.name;
        pugi::xml_node catalogue = add_resource(root, "eventParameters", id);
        for (const EmissionEvent& event : events)
          add_event(catalogue, event, test.record.dimension(), fmt::format("{}/event/{}", id, event.number), origin);
        std::ostringstream text;
        document.save(text, " ");
        std::filesystem::create_directories(folder);
        write_whole_file(folder / (test.name + ".xml"), text.str());
        any = true;
      }
  if (!any)
    throw InputError("--quakeml: no test has events of acoustic emission; see emission.csv in the folder of the run");
}
} // namespace feldspar
