#include "results/runs/quantity_values.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace feldspar
{
namespace
{
/// The place of a member in a test, const or not.
template <typename Test, typename T>
auto& place_in(Test& test, T TestResults::*member)
{
  return test.results.*member;
}

template <typename Test, typename T>
auto& place_in(Test& test, T TestRecord::*member)
{
  return test.record.*member;
}

template <typename Test, typename T>
auto& place_in(Test& test, T SpecimenReport::*member)
{
  return test.record.specimen.*member;
}

template <typename Test, typename T>
auto& place_in(Test& test, T RunBookkeeping::*member)
{
  return test.bookkeeping.*member;
}

Figure figure_of(const Figure& figure, const std::string_view) { return figure; }

template <typename Number>
Figure figure_of(const Number& number, const std::string_view reason_for_nan)
{
  const auto value = double(number);
  if (std::isfinite(value))
    return {value, ""};
  return {std::nullopt, std::isnan(value) ? std::string(reason_for_nan) : "it is no finite number"};
}

void put(Figure& place, const Figure& figure) { place = figure; }

template <typename Number>
void put(Number& place, const Figure& figure)
{
  const double value = figure.value.value_or(std::numeric_limits<double>::quiet_NaN());
  if constexpr (std::is_integral_v<Number>) // 0 of what is no count: foreign files hold anything
    place = value >= 0.0 && value < double(std::numeric_limits<Number>::max()) ? Number(value) : Number(0);
  else
    place = value;
}
} // namespace

Figure value_of(const TestQuantity& quantity, const FinishedTest& test)
{
  if (!test.record.failure.empty() && quantity.of != QuantityOf::loading)
    return {std::nullopt, test.record.failure};
  return std::visit([&](const auto member) { return figure_of(place_in(test, member), quantity.nan.reason); },
                    quantity.member);
}

void set_value(const TestQuantity& quantity, FinishedTest& test, const Figure& figure)
{
  std::visit([&](const auto member) { put(place_in(test, member), figure); }, quantity.member);
}
} // namespace feldspar
