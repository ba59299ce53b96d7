#include "results/runs/run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace feldspar
{
std::string Provenance::value_of(const input_entries::EntryName& wanted) const
{
  const auto found = std::ranges::find_if(
    input, [&](const InputEntry& one) { return one.section == wanted.section && one.entry == wanted.entry; });
  return found == input.end() ? "" : found->value;
}

std::string Provenance::label_of(const input_entries::EntryName& wanted) const
{
  const std::string value = value_of(wanted);
  return value == "none" ? "" : value;
}

bool any_has_flaws(const std::vector<FinishedTest>& tests)
{
  return std::ranges::any_of(tests, &FinishedTest::has_flaws);
}

FinishedTest finished(TestOutcome outcome, std::string group, std::string name, std::string variant,
                      std::vector<VariantSetting> settings)
{
  TestResults results = evaluate(outcome.record);
  return {std::move(group),
          std::move(name),
          std::move(variant),
          std::move(settings),
          std::move(outcome.record),
          std::move(results),
          std::move(outcome.appearance),
          std::move(outcome.bookkeeping)};
}

namespace
{
/// The place of a member in a test, const or not.
template <typename Test, typename Owner, typename T>
auto& place_in(Test& test, T Owner::*member)
{
  if constexpr (std::is_same_v<Owner, TestResults>)
    return test.results.*member;
  else if constexpr (std::is_same_v<Owner, TestRecord>)
    return test.record.*member;
  else if constexpr (std::is_same_v<Owner, SpecimenReport>)
    return test.record.specimen.*member;
  else
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
