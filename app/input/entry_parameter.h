#pragma once

#include "app/input/parameter_table.h"

#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

/// From an entry beside its struct to a parameter of the input: text to members in SI, and back.
namespace feldspar
{
/// The place of a parameter's value within its part of the input.
template <typename T>
struct ValueForm
{
  std::string unit;
  std::string range;
  std::function<T(const Input&, std::string_view)> read; ///< throws InputError
  std::function<std::string(const T&)> write;
};

ValueForm<double> number_form(Measure measure, std::string_view unit, const Range& range);
ValueForm<std::optional<double>> optional_number_form(Measure measure, std::string_view unit, const Range& range);
ValueForm<unsigned int> integer_form(const Range& range);
ValueForm<std::string> file_form();
ValueForm<std::size_t> choice_form(const std::vector<std::string_view>& options);

/// `part` gives the struct within an Input, const or not.
template <typename P, typename Part>
Parameter parameter_of(const std::string_view section, const Entry<P>& entry, const Part& part)
{
  Parameter parameter{section, entry.name, "", "", entry.meaning, entry.flags, {}, {}};
  const auto use_form = [&](const auto& form, const auto& get, const auto& set) {
    parameter.unit = form.unit;
    parameter.range = form.range;
    parameter.read = [=](Input& input, const std::string_view text) { set(part(input), form.read(input, text)); };
    parameter.write = [=](const Input& input) { return form.write(get(part(input))); };
  };
  const auto use_member = [&](const auto& form, const auto member) {
    use_form(
      form, [=](const P& from) { return from.*member; }, [=](P& into, const auto& value) { into.*member = value; });
  };
  std::visit(
    [&](const auto& value) {
      using E = Entry<P>;
      using Kind = std::decay_t<decltype(value)>;
      if constexpr (std::is_same_v<Kind, typename E::Number>)
        use_member(number_form(value.measure, value.unit, value.range), value.member);
      else if constexpr (std::is_same_v<Kind, typename E::OptionalNumber>)
        use_member(optional_number_form(value.measure, value.unit, value.range), value.member);
      else if constexpr (std::is_same_v<Kind, typename E::Integer>)
        use_member(integer_form(value.range), value.member);
      else if constexpr (std::is_same_v<Kind, typename E::File>)
        use_member(file_form(), value.member);
      else if constexpr (std::is_same_v<Kind, typename E::Choice>)
        use_form(choice_form(value.options), value.get, value.set);
      else
        {
          parameter.unit = value.unit;
          parameter.range = value.range;
          parameter.read = [=](Input& input, const std::string_view text) { value.read(part(input), text); };
          parameter.write = [=](const Input& input) { return value.write(part(input)); };
        }
    },
    entry.value);
  return parameter;
}
} // namespace feldspar
