#include "base/table/quantity.h"

#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>

#include <atomic>
#include <clocale>
#include <cstdlib>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

namespace feldspar
{
namespace
{
using tests::has;
using tests::refusal;

std::string stress_error(const std::string& text)
{
  return refusal([&] { parse_quantity(text, stress); });
}

TEST(Quantity, IsConvertedToSI)
{
  EXPECT_EQ(parse_quantity("22 MPa", stress), 22e6);
  EXPECT_EQ(parse_quantity("22 N/mm^2", stress), 22e6);
  EXPECT_EQ(parse_quantity("2.2e1 MN.m-2", stress), 22e6);
  EXPECT_EQ(parse_quantity("+.5 GPa", stress), 5e8);
  EXPECT_EQ(parse_quantity("-1 Pa", stress), -1.0);
  EXPECT_EQ(parse_quantity("2.7 g/cm^3", density), 2700.0);
  EXPECT_EQ(parse_quantity("0.164 1/s", rate), 0.164);
  EXPECT_EQ(parse_quantity("0.164 s^-1", rate), 0.164);
  EXPECT_DOUBLE_EQ(parse_quantity("5 \u00B5m", length), 5e-6);
}

TEST(Quantity, TakesAnglesInDegreesOrRadians)
{
  const double ten_degrees = std::numbers::pi / 18.0;
  for (const char* text : {"10 deg", "10 degree", "10 degrees", "10 \u00B0"})
    EXPECT_DOUBLE_EQ(parse_quantity(text, angle), ten_degrees) << text;
  EXPECT_EQ(parse_quantity("0.5 rad", angle), 0.5);
}

TEST(Quantity, RefusesUnitsOfAnotherDimension)
{
  EXPECT_NE(stress_error("22 mm"), "");
  EXPECT_NE(stress_error("22 deg"), "");
  EXPECT_NE(stress_error("22 MPa.rad"), "");
  for (const char* text : {"22 MPa", "22 %", "22 percent", "22 sr", "22 m"})
    EXPECT_NE(refusal([&] { parse_quantity(text, angle); }), "") << text;
}

TEST(Quantity, MustBeOneNumberOneSpaceOneUnit)
{
  // UDUNITS alone would take most of these: `22 MPa 3` as 66 MPa, `MPa since 1990` with an origin.
  for (const char* text : {"",
                           " ",
                           "22",
                           "MPa",
                           "22MPa",
                           "22  MPa",
                           "22 MPa ",
                           " 22 MPa",
                           "22 MPa 3",
                           "5 10 MPa",
                           "22 3MPa",
                           "22 3.MPa",
                           "22 MPa.3",
                           "22 MPa*3",
                           "22 MPa/3",
                           "22 1",
                           "22 MPa since 1990",
                           "22 Pa@3",
                           "22 lg(re_Pa)",
                           "22 (MPa)",
                           "22 MPa^",
                           "22 MPa-",
                           "22 Quark",
                           "1,5 MPa",
                           "1e MPa",
                           "1.2.3 MPa",
                           ". MPa",
                           "- MPa",
                           "--1 MPa",
                           "0x1p3 MPa",
                           "nan MPa",
                           "NaN MPa",
                           "inf MPa",
                           "-inf MPa",
                           "1e999 MPa",
                           "1e308 MPa",
                           "1e25 MPa",
                           "-1e300 GPa.m2.m-2",
                           "5, 10, 20 MPa"})
    EXPECT_NE(stress_error(text), "") << text;
}

TEST(Quantity, ErrorsShowTheRightForm)
{
  EXPECT_EQ(stress_error("22"), "a unit is missing; write a stress, e.g. \"22 MPa\"");
  EXPECT_EQ(stress_error("MPa"), "a number is missing; write a stress, e.g. \"22 MPa\"");
  EXPECT_TRUE(has(refusal([] { parse_quantity("22 m", angle); }), "\"10 deg\""));
  EXPECT_EQ(stress_error("1e25 MPa"), "is too large; a number is at most 1e+30 in SI units");
  EXPECT_EQ(stress_error("0 MPa"), "");
  for (const char* const vanishing : {"5e-324 MPa", "-1e-37 MPa"}) // in any product
    EXPECT_EQ(parse_quantity(vanishing, stress), 0.0);
  EXPECT_EQ(stress_error("1e308 MPa"), "1e+308 MPa is beyond the range of numbers; write a stress, e.g. \"22 MPa\"");
}

TEST(Quantity, ListHasItsUnitAtTheEnd)
{
  EXPECT_EQ(parse_quantities("5, 10,20 MPa", stress), (std::vector<double>{5e6, 10e6, 20e6}));
  EXPECT_EQ(parse_quantities("5 MPa", stress), (std::vector<double>{5e6}));
  for (const char* text : {"5, 10, 20", "5 MPa, 10 MPa", "5,, 20 MPa", "5, 20 MPa,", "5 10 MPa", ""})
    EXPECT_NE(refusal([&] { parse_quantities(text, stress); }), "") << text;
}

TEST(Quantity, ListMayHaveRanges)
{
  const std::vector<double> pressures{10e6, 20e6, 30e6};
  EXPECT_EQ(parse_quantities("10..30 MPa step 10", stress), pressures);
  EXPECT_EQ(parse_quantities("10..30 step 10 MPa", stress), pressures);
  EXPECT_EQ(parse_quantities("30..10 MPa step -10", stress), (std::vector<double>{30e6, 20e6, 10e6}));
  EXPECT_EQ(parse_quantities("1, 5..15 step 5, 40 MPa", stress), (std::vector<double>{1e6, 5e6, 10e6, 15e6, 40e6}));
  // The same bits as written out: 3 times 0.1 is not 0.3 in binary.
  EXPECT_EQ(values_of_range("0.1..0.4 step 0.1"), (std::vector<std::string>{"0.1", "0.2", "0.3", "0.4"}));
  EXPECT_EQ(values_of_range("2 .. 2 step 1"), (std::vector<std::string>{"2"}));
  EXPECT_EQ(values_of_range("../rock.h5"), (std::vector<std::string>{"../rock.h5"}));
  const auto list_error = [](const char* const text) { return refusal([&] { parse_quantities(text, stress); }); };
  EXPECT_EQ(list_error("10..30 MPa"),
            "\"10..30 MPa\": the step is missing; a range is written as in \"10..60 MPa step 10\"");
  for (const auto& [text, words] : {std::pair("10..30 MPa step 0", "the step is 0"),
                                    {"10..30 MPa step -10", "the step leads away from the last value"},
                                    {"30..10 MPa step 10", "the step leads away from the last value"},
                                    {"10..35 MPa step 10", "no whole number of steps"},
                                    {"0..1 MPa step 1e-9", "more than 10000 values"},
                                    {"10..x MPa step 10", "\"x\" is not a decimal number"},
                                    {"10..30 MPa step 10 MPa", "the unit stands once"},
                                    {"10..30 MPa step 10, 40 MPa", "the unit stands once"},
                                    {"10..30 step 10", "a unit is missing"}})
    EXPECT_TRUE(has(list_error(text), words)) << text;
}

TEST(Quantity, IsWrittenAsItIsRead)
{
  EXPECT_EQ(format_quantity(22e6, "MPa", stress), "22 MPa");
  EXPECT_EQ(format_quantity(6.2e-4, "mm", length), "0.62 mm");
  EXPECT_EQ(format_quantity(std::numbers::pi / 18.0, "deg", angle), "10 deg");
}

TEST(Number, IsDecimalAndBare)
{
  EXPECT_EQ(parse_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(parse_number("+4"), 4.0);
  for (const char* text : {"", "nan", "inf", "1,5", "0x10", "1 2", "4 MPa", "1e999"})
    EXPECT_NE(refusal([&] { parse_number(text); }), "") << text;
}

TEST(Quantity, ReadsTheSameWhereTheDecimalSignIsAComma)
{
  const tests::TemporaryFolder folder;
  tests::make_german_locale(folder.path());
  setenv("LOCPATH", folder.path().c_str(), 1);
  ASSERT_NE(std::setlocale(LC_NUMERIC, "de_DE.UTF-8"), nullptr);
  const bool comma = std::string_view(std::localeconv()->decimal_point) == ",";
  const double megapascals = parse_quantity("22.5 MPa", stress);
  const double inches = parse_quantity("1.5 inch", length); // 2.54 cm in the tables of UDUNITS
  const std::string refused = stress_error("22,5 MPa");
  const std::string written = format_quantity(22.5e6, "MPa", stress);
  std::setlocale(LC_NUMERIC, "C");
  unsetenv("LOCPATH");

  EXPECT_TRUE(comma);
  EXPECT_EQ(megapascals, 22.5e6);
  EXPECT_DOUBLE_EQ(inches, 0.0381);
  EXPECT_NE(refused, "");
  EXPECT_EQ(written, "22.5 MPa");
}
/// The library behind it keeps its place in global variables; inputs are read by independent tests at the same time.
TEST(Quantity, IsReadByManyThreadsAtOnce)
{
  constexpr int n_threads = 8;
  constexpr int n_readings = 500;
  std::atomic<int> n_wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < n_threads; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < n_readings; ++i)
          if (refusal([&] {
                if (parse_quantity("2 kg/m^3", density) != 2.0)
                  ++n_wrong;
              }) != "")
            ++n_wrong;
      });
  }
  EXPECT_EQ(n_wrong, 0);
}
} // namespace
} // namespace feldspar
