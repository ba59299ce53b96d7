#pragma once

#include "base/body.h"
#include "base/contains.h"
#include "base/parameter_id.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

/// Entries of an input, written beside the struct of parameters that they fill: plain data, from which the application
/// reads, checks and documents them. No units are converted here.
namespace feldspar
{
/// The quantity that an entry gives.
enum class Measure
{
  number, ///< without unit
  stress,
  length,
  angle,
  density,
  rate,
  stiffness, ///< of a plane: stress over displacement
  spring     ///< stiffness of a spring: force over displacement
};

/// An interval as it is written in books: '[' and ']' take the bound in, '(' and ')' leave it out. Bounds in the unit in
/// which the entry is shown.
struct Range
{
  char left;
  double lower;
  double upper;
  char right;

  constexpr bool contains(const double value) const
  {
    return (left == '[' ? value >= lower : value > lower) && (right == ']' ? value <= upper : value < upper);
  }
};

namespace ranges
{
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Range above_zero{'(', 0.0, infinity, ')'};
inline constexpr Range from_zero{'[', 0.0, infinity, ')'};
inline constexpr Range fraction{'[', 0.0, 1.0, ']'};
} // namespace ranges

/// Condition of an entry on another one.
struct Demand
{
  std::string_view of_value;             ///< only of this value of its own; empty: of any but the default
  std::string_view other;                ///< Section/Entry
  std::vector<std::string_view> allowed; ///< values of the other one; none: its default
  std::string_view otherwise;            ///< the error: what is wrong, what to do
};

/// Further properties of an entry.
struct EntryFlags
{
  bool varies = false;              ///< may take one value after the other (section Variants)
  bool of_specimen = false;         ///< a part of the specimen's identity: genesis reads it
  std::vector<Body> bodies = {};    ///< that have a use for it; none named: all. In other bodies the entry keeps its
                                    ///< default
  std::string_view needs = {};      ///< such a body in words, for the error
  bool basic = false;               ///< needed in a first study: the reference shows it before the others
  std::string_view in_space = {};   ///< the default in three dimensions; empty: that of the plane
  std::vector<Demand> demands = {}; ///< on other entries; the first that is not met is the error
};

/// The place of a value within `Parameters`: a member, or one of a part of them.
template <typename Parameters, typename T>
struct Place
{
  std::function<const T&(const Parameters&)> get;
  std::function<T&(Parameters&)> at;
};

/// One entry that fills a member of `Parameters`.
template <typename Parameters>
struct Entry
{
  struct Number
  {
    Place<Parameters, double> place; ///< in SI
    Measure measure;
    std::string_view unit; ///< in which it is shown; any other of its measure may be written
    Range range;
  };

  struct OptionalNumber ///< none is allowed
  {
    Place<Parameters, std::optional<double>> place;
    Measure measure;
    std::string_view unit;
    Range range;
  };

  struct Integer
  {
    Place<Parameters, unsigned int> place;
    Range range;
  };

  struct File ///< none: an empty name
  {
    Place<Parameters, std::string> place;
  };

  struct Choice
  {
    std::vector<std::string_view> options;
    std::function<void(Parameters&, std::size_t)> set;
    std::function<std::size_t(const Parameters&)> get;
  };

  struct Text ///< of a form of its own, such as a list
  {
    std::string_view unit;
    std::string range;
    std::function<void(Parameters&, std::string_view)> read; ///< throws InputError
    std::function<std::string(const Parameters&)> write;
  };

  std::string_view name;
  std::variant<Number, OptionalNumber, Integer, File, Choice, Text> value;
  std::string_view meaning;
  EntryFlags flags;
  std::optional<ParameterId> id = {}; ///< of the member that it fills; none of a text, which fills several
};

/// Makers of entries, one for each kind.
namespace entry
{
template <typename P>
Entry<P> quantity(const std::string_view name, double P::*const member, const Measure measure,
                  const std::string_view unit, const Range& range, const std::string_view meaning,
                  const EntryFlags& flags = {})
{
  return {name, typename Entry<P>::Number{{member, member}, measure, unit, range}, meaning, flags,
          id_of_member(member)};
}

template <typename P>
Entry<P> number(const std::string_view name, double P::*const member, const Range& range,
                const std::string_view meaning, const EntryFlags& flags = {})
{
  return quantity(name, member, Measure::number, "", range, meaning, flags);
}

template <typename P>
Entry<P> optional_quantity(const std::string_view name, std::optional<double> P::*const member, const Measure measure,
                           const std::string_view unit, const Range& range, const std::string_view meaning,
                           const EntryFlags& flags = {})
{
  return {name, typename Entry<P>::OptionalNumber{{member, member}, measure, unit, range}, meaning, flags,
          id_of_member(member)};
}

template <typename P>
Entry<P> optional_number(const std::string_view name, std::optional<double> P::*const member, const Range& range,
                         const std::string_view meaning, const EntryFlags& flags = {})
{
  return optional_quantity(name, member, Measure::number, "", range, meaning, flags);
}

template <typename P>
Entry<P> integer(const std::string_view name, unsigned int P::*const member, const Range& range,
                 const std::string_view meaning, const EntryFlags& flags = {})
{
  return {name, typename Entry<P>::Integer{{member, member}, range}, meaning, flags, id_of_member(member)};
}

template <typename P>
Entry<P> file(const std::string_view name, std::string P::*const member, const std::string_view meaning,
              const EntryFlags& flags = {})
{
  return {name, typename Entry<P>::File{{member, member}}, meaning, flags, id_of_member(member)};
}

/// An entry of a form of its own: `read` makes the value of a text or throws InputError, `write` the text of a value.
template <typename P, typename T, typename Read, typename Write>
Entry<P> text(const std::string_view name, T P::*const member, const std::string_view unit, std::string range,
              const Read& read, const Write& write, const std::string_view meaning, const EntryFlags& flags = {})
{
  return {
    name,
    typename Entry<P>::Text{unit, std::move(range),
                            [=](P& parameters, const std::string_view found) { parameters.*member = read(found); },
                            [=](const P& parameters) { return write(parameters.*member); }},
    meaning, flags, id_of_member(member)};
}

/// `options`: what is written, and the value it stands for.
template <typename P, typename T>
Entry<P> choice(const std::string_view name, T P::*const member,
                const std::vector<std::pair<std::string_view, std::type_identity_t<T>>>& options,
                const std::string_view meaning, const EntryFlags& flags = {})
{
  typename Entry<P>::Choice value;
  for (const auto& option : options)
    value.options.push_back(option.first);
  value.set = [=](P& parameters, const std::size_t k) { parameters.*member = options[k].second; };
  value.get = [=](const P& parameters) {
    std::size_t k = 0;
    while (k + 1 < options.size() && options[k].second != parameters.*member)
      ++k;
    return k;
  };
  return {name, std::move(value), meaning, flags, id_of_member(member)};
}
} // namespace entry

/// The same entry of a struct that has `Parameters` as a part, which `get` reads and `at` writes.
template <typename Whole, typename Parameters, typename Get, typename At>
Entry<Whole> within(const Entry<Parameters>& entry, const Get& get, const At& at)
{
  using From = Entry<Parameters>;
  using To = Entry<Whole>;
  const auto moved = [&]<typename T>(const Place<Parameters, T>& place) {
    return Place<Whole, T>{[=](const Whole& whole) -> const T& { return place.get(get(whole)); },
                           [=](Whole& whole) -> T& { return place.at(at(whole)); }};
  };
  using Value = decltype(To::value);
  Value value = std::visit(
    [&](const auto& form) -> Value {
      using Kind = std::decay_t<decltype(form)>;
      if constexpr (std::is_same_v<Kind, typename From::Number>)
        return typename To::Number{moved(form.place), form.measure, form.unit, form.range};
      else if constexpr (std::is_same_v<Kind, typename From::OptionalNumber>)
        return typename To::OptionalNumber{moved(form.place), form.measure, form.unit, form.range};
      else if constexpr (std::is_same_v<Kind, typename From::Integer>)
        return typename To::Integer{moved(form.place), form.range};
      else if constexpr (std::is_same_v<Kind, typename From::File>)
        return typename To::File{moved(form.place)};
      else if constexpr (std::is_same_v<Kind, typename From::Choice>)
        return typename To::Choice{form.options, [=](Whole& whole, const std::size_t k) { form.set(at(whole), k); },
                                   [=](const Whole& whole) { return form.get(get(whole)); }};
      else
        return typename To::Text{form.unit, form.range,
                                 [=](Whole& whole, const std::string_view text) { form.read(at(whole), text); },
                                 [=](const Whole& whole) { return form.write(get(whole)); }};
    }, // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): what std::function holds is its own
    entry.value);
  return {entry.name, std::move(value), entry.meaning, entry.flags, entry.id};
}
} // namespace feldspar
