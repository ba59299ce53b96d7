// Acoustic emission as QuakeML, and as a laboratory records it.

#include "app/input/curves/laboratory_curve.h"
#include "results/folder/quakeml.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <regex>
#include <set>
#include <string>

namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

void refuse(const std::function<void()>& work, const std::string& words)
{
  const std::string said = tests::refusal(work);
  EXPECT_TRUE(has(said, words));
  EXPECT_FALSE(has(said, "\n"));
}

TEST(Quakeml, OriginsAreReadOrRefused)
{
  const QuakemlOrigin origin = parse_quakeml_origin("41.5 S, 97.25 W, 0.5 km, 2026-02-28T23:59:58Z");
  EXPECT_EQ(origin.latitude, -41.5);
  EXPECT_EQ(origin.longitude, -97.25);
  EXPECT_DOUBLE_EQ(origin.depth, 500.0);
  EXPECT_EQ(origin.time, 1772323198); // by `date`
  for (const auto& [text, words] : {std::pair("41, 97, 500 m, 2026-01-01T00:00:00Z", "as in \"41.0 N, 97.0 E, 500 m, "),
                                    {"97 E, 41 N, 500 m, 2026-01-01T00:00:00Z", "found is"},
                                    {"41 N, 97 E, 500, 2026-01-01T00:00:00Z", "a unit is missing"},
                                    {"41 N, 97 E, 500 s, 2026-01-01T00:00:00Z", "\"s\" is not the unit of a length"},
                                    {"4.1.0 N, 97 E, 500 m, 2026-01-01T00:00:00Z", "is not a decimal number"},
                                    {"90 N, 97 E, 500 m, 2026-01-01T00:00:00Z", "latitude must be at most 89"},
                                    {"41 N, 181 E, 500 m, 2026-01-01T00:00:00Z", "longitude at most 180"},
                                    {"41 N, 97 E, 500 m, 2026-02-29T00:00:00Z", "no such time"},
                                    {"41 N, 97 E, 500 m, 2026-01-01T24:00:00Z", "no such time"},
                                    {"41 N, 97 E, 500 m, 2026-01-01", "found is"}})
    refuse([&, of = text] { parse_quakeml_origin(of); }, words);
}

/// The event of a test as an element, with its namespaces and rules as the schema of the Basic Event Description 1.2 has them.
class QuakemlFile : public testing::Test
{
protected:
  pugi::xml_node event_of(const std::array<double, 3>& size, const EmissionEvent& event)
  {
    std::vector<Series> all(1);
    FinishedTest& test = all.front().tests.emplace_back();
    test.name = "uniaxial_compression_seed_1";
    test.record.size = size;
    test.record.events = {event, event};
    test.record.events[1].number = event.number + 1;
    write_quakeml(all, parse_quakeml_origin("60 N, 97 E, 500 m, 2026-12-31T23:59:59Z"), folder.path() / "xml");
    EXPECT_TRUE(document.load_file((folder.path() / "xml" / (test.name + ".xml")).c_str()));
    const pugi::xml_node root = document.child("q:quakeml");
    EXPECT_STREQ(root.attribute("xmlns:q").value(), "http://quakeml.org/xmlns/quakeml/1.2");
    EXPECT_STREQ(root.attribute("xmlns").value(), "http://quakeml.org/xmlns/bed/1.2");

    // Identifiers are of the schema's form, each is given once, and references are to those that there are.
    const std::regex form(R"((smi|quakeml):[\w\-.*()~']{3,}/[\w\-.*()~'][\w\-.*()+?~'=,;#/&]*)");
    std::set<std::string> ids;
    for (const auto& named : root.select_nodes("//*[@publicID]"))
      {
        const std::string id = named.node().attribute("publicID").value();
        EXPECT_TRUE(std::regex_match(id, form)) << id;
        EXPECT_TRUE(ids.insert(id).second) << id;
      }
    for (const auto& reference : root.select_nodes("//*[contains(name(), 'ID')]"))
      if (const std::string id = reference.node().child_value(); std::string(reference.node().name()) == "methodID")
        EXPECT_TRUE(std::regex_match(id, form)) << id;
      else
        EXPECT_TRUE(ids.contains(id)) << id;
    return root.select_node("eventParameters/event[1]").node();
  }

  static double value(const pugi::xml_node& event, const std::string& path)
  {
    return event.select_node((path + "/value").c_str()).node().text().as_double(std::nan(""));
  }

  const TemporaryFolder folder;
  pugi::xml_document document;
};

constexpr double degrees_a_metre = 180.0 / std::numbers::pi / 6371e3;

TEST_F(QuakemlFile, OfABodyInSpaceHasXToTheEastAndYToTheNorth)
{
  EmissionEvent event;
  event.number = 7;
  event.time = 1.25e-3;
  event.n_tension = 2;
  event.n_shear = 1;
  event.released_energy = 1e-3;
  event.centroid = {0.02, 0.03, 0.09};
  event.moment = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}; // xx, xy, xz, yy, yz, zz
  const pugi::xml_node element = event_of({0.05, 0.05, 0.1}, event);
  EXPECT_STREQ(element.select_node("origin/time/value").node().child_value(), "2026-12-31T23:59:59.001250000Z");
  // Nine digits after the point: to 1e-13 degrees, a hundredth of a micrometre.
  EXPECT_NEAR(value(element, "origin/latitude") - 60.0, 0.03 * degrees_a_metre, 2e-13);
  EXPECT_NEAR(value(element, "origin/longitude") - 97.0, 0.02 * degrees_a_metre / 0.5, 2e-13);
  EXPECT_NEAR(value(element, "origin/depth"), 500.0 - 0.09, 1e-9);
  const std::string tensor = "focalMechanism/momentTensor/tensor/";
  EXPECT_EQ(value(element, tensor + "Mrr"), 6.0);
  EXPECT_EQ(value(element, tensor + "Mtt"), 4.0);
  EXPECT_EQ(value(element, tensor + "Mpp"), 1.0);
  EXPECT_EQ(value(element, tensor + "Mrt"), -5.0); // t points to the south
  EXPECT_EQ(value(element, tensor + "Mrp"), 3.0);
  EXPECT_EQ(value(element, tensor + "Mtp"), -2.0);
  const SourceMechanism source = mechanism(event, 3);
  EXPECT_NEAR(value(element, "focalMechanism/momentTensor/scalarMoment"), source.scalar_moment,
              1e-13 * source.scalar_moment);
  EXPECT_NEAR(value(element, "magnitude[type='Mw']/mag"), source.magnitude, 1e-13);
  EXPECT_NEAR(value(element, "magnitude[type='Me']/mag"), -2.0 - 2.9, 1e-13); // ⅔ log10 of 1e-3 J
  EXPECT_STREQ(element.select_node("magnitude[type='Mw']/methodID").node().child_value(),
               "smi:local/feldspar/method/Hanks-Kanamori-1979");
  double shares = 0.0;
  for (const char* const share : {"doubleCouple", "clvd", "iso"})
    shares +=
      element.select_node((std::string("focalMechanism/momentTensor/") + share).c_str()).node().text().as_double();
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_TRUE(
    has(std::string(element.select_node("comment/text").node().child_value()), "breaks: 2 in tension, 1 in shear"));
}

TEST_F(QuakemlFile, OfABodyInThePlaneHasYUp)
{
  EmissionEvent event;
  event.number = 1;
  event.centroid = {0.02, 0.09, 0.0};
  event.moment = {1.0, 2.0, 0.0, 4.0, 0.0, 0.0};
  const pugi::xml_node element = event_of({0.05, 0.1, 0.0}, event);
  EXPECT_EQ(value(element, "origin/latitude"), 60.0);
  EXPECT_NEAR(value(element, "origin/depth"), 500.0 - 0.09, 1e-9);
  const std::string tensor = "focalMechanism/momentTensor/tensor/";
  EXPECT_EQ(value(element, tensor + "Mrr"), 4.0);
  EXPECT_EQ(value(element, tensor + "Mtt"), 0.0);
  EXPECT_EQ(value(element, tensor + "Mpp"), 1.0);
  EXPECT_EQ(value(element, tensor + "Mrp"), 2.0);
  EXPECT_FALSE(element.select_node("magnitude[type='Me']")); // no energy, no magnitude of it
}

TEST_F(QuakemlFile, OfAnEventWithoutAMomentHasNoMechanism)
{
  EmissionEvent event;
  event.number = 1;
  const pugi::xml_node element = event_of({0.05, 0.1, 0.0}, event);
  EXPECT_TRUE(element.child("origin"));
  EXPECT_FALSE(element.child("focalMechanism"));
  EXPECT_FALSE(element.child("magnitude"));
  event.time = 1e10;
  refuse(
    [&] {
      event_of({0.05, 0.1, 0.0}, event);
    },
    "an event of uniaxial_compression_seed_1 has no time up to 1e+09 s; samples have none");
  refuse([] { write_quakeml({}, {}, "nowhere"); }, "no test has events of acoustic emission");
}

class Catalogue : public testing::Test
{
protected:
  EmissionCatalogue read(const std::string& text) const
  {
    return read_emission_catalogue(folder.write("ae.csv", text));
  }

  const TemporaryFolder folder;
};

TEST_F(Catalogue, HasMagnitudesOfItsAmplitudesOrEnergies)
{
  const EmissionCatalogue hits = read(
    "channel;Time [ms];Amplitude [dB];Axial stress [MPa];x [mm];y [mm];z [mm]\n1;0,5;45;10;1;2,5;3\n2;2;60;20;4;5;6\n");
  ASSERT_EQ(hits.events.size(), 2u);
  EXPECT_EQ(hits.name, "ae.csv");
  EXPECT_EQ(hits.scale, "amplitude in dB / 20");
  EXPECT_DOUBLE_EQ(hits.events[0].stress, 1e7);
  EXPECT_DOUBLE_EQ(hits.events[0].magnitude, 2.25);
  EXPECT_DOUBLE_EQ(hits.events[1].magnitude, 3.0);

  // 1 aJ is 1e-18 J: ⅔ (−18) − 2.9. A hit without energy has no magnitude.
  const EmissionCatalogue energies = read("strain [%],energy [aJ]\n0.1,1\n0.2,0\n");
  EXPECT_NEAR(energies.events[0].magnitude, -14.9, 1e-12);
  EXPECT_TRUE(std::isnan(energies.events[0].stress));
  EXPECT_TRUE(std::isnan(energies.events[1].magnitude));
  EXPECT_NEAR(read("time [s],energy [eu]\n0.1,1000\n").events[0].magnitude, -0.9, 1e-12); // ⅔ 3 − 2.9
  EXPECT_DOUBLE_EQ(read("time [s],magnitude,amplitude [dB]\n0.1,-3.5,40\n").events[0].magnitude, -3.5);
  EXPECT_TRUE(std::isnan(read("time_s,magnitude\n0.1,nan\n").events[0].magnitude)); // as emission.csv has it
}

TEST_F(Catalogue, IsRefusedInOneLine)
{
  for (const auto& [text, words] :
       {std::pair("time [s],amplitude [mV]\n1,2\n",
                  "ae.csv:1: \"amplitude [mV]\": \"mV\" is not the unit of an amplitude; "
                  "write an amplitude, e.g. \"45 dB\""),
        {"time [MPa],amplitude [dB]\n1,2\n", "\"MPa\" is not the unit of a time"},
        {"time [s],amplitude\n1,2\n", "\"amplitude\": has no unit; write it as in \"amplitude [dB]\""},
        {"time [s],energy [dB]\n1,2\n", "is not a known unit; write an energy, e.g. \"2 aJ\""},
        {"time [s],hits\n1,2\n", "ae.csv:1: there is no column amplitude, energy or magnitude"},
        {"time [s],amplitude [dB]\n1,loud\n", "ae.csv:2: amplitude [dB]: \"loud\" is not a decimal number"},
        {"time [s],magnitude\n1,inf\n", "ae.csv:2: the magnitude (as the file has them) is inf"},
        {"time [s],amplitude [dB]\n2,40\n1,40\n", "ae.csv:3: time is 1 s after 2 s; rows must be in the order of time"},
        {"time [s],amplitude [dB]\n1,4000\n", "is 200; it must lie between -20 and 20"},
        {"time [s],energy [J]\n1,-1\n", "ae.csv:2: energy is -1; it must not be negative"},
        {"stress [MPa],energy [J]\n-1,1\n", "must be positive in the sense of the test"},
        {"time [s],amplitude [dB]\n", "there is no row below the header"},
        {"time [s],amplitude [dB]\n1,2,3\n", "ae.csv:2: "}})
    refuse([&, of = text] { read(of); }, words);
}
} // namespace
} // namespace feldspar
