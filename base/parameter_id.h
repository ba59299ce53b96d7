#pragma once

#include "base/input_error.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>

/// Parameters in messages to the user. A library names a parameter by the member that holds it; the application, which
/// reads the input, knows its section and entry there.
namespace feldspar
{
/// A member of a struct of parameters, or all of the struct.
struct ParameterId
{
  std::type_index owner;
  std::optional<std::ptrdiff_t> place; ///< of the member in the struct [bytes]; none: all of the struct
  std::string_view name;               ///< of the member in the code

  bool operator==(const ParameterId& other) const { return owner == other.owner && place == other.place; }
};

template <typename Owner, typename T>
ParameterId id_of_member(T Owner::*const member, const std::string_view name = {})
{
  static const Owner any{};
  return {typeid(Owner), reinterpret_cast<const char*>(&(any.*member)) - reinterpret_cast<const char*>(&any), name};
}

namespace parameter_ids
{
/// Returns the name of the member, or type, in a text such as "... member = &feldspar::SpecimenParameters::width]".
constexpr std::string_view last_name(std::string_view text)
{
  text = text.substr(text.find(" = "));
  text = text.substr(0, text.find_first_of(";]"));
  while (text.ends_with(')'))
    text.remove_suffix(1);
  return text.substr(text.rfind(':') + 1);
}

template <auto member>
constexpr std::string_view name_of_member()
{
  return last_name(__PRETTY_FUNCTION__);
}

template <typename Parameters>
constexpr std::string_view name_of_type()
{
  return last_name(__PRETTY_FUNCTION__);
}

template <typename Owner, typename T>
Owner owner_of(T Owner::*);

template <typename Owner, auto member, typename Base, typename T>
ParameterId id(T Base::*)
{
  return id_of_member(static_cast<T Owner::*>(member), name_of_member<member>());
}
} // namespace parameter_ids

/// parameter_id<&SpecimenParameters::width>(). `Owner`: a struct that has the member from its base.
template <auto member, typename Owner = decltype(parameter_ids::owner_of(member))>
ParameterId parameter_id()
{
  return parameter_ids::id<Owner, member>(member);
}

/// All parameters of a struct; in the input a section of it, or the entry that gives all of it.
template <typename Parameters>
ParameterId parameters_id()
{
  return {typeid(Parameters), std::nullopt, parameter_ids::name_of_type<Parameters>()};
}

/// Place of a parameter in the input.
struct InputPlace
{
  std::string section;
  std::string entry; ///< empty: all of the section
};

/// Work that the application offers as a command.
enum class Work
{
  specimen,
  strain_path,
  sample,
  rve_out_of_sample
};

/// The words of the application; until it gives them messages have the names of the code.
struct InputWords
{
  InputPlace (*place)(const ParameterId&);
  std::string (*command)(Work);
};

/// To be called before any message is made.
void use_words_of_input(const InputWords& words);

/// "Section/Entry" or, of all parameters of a section, "Section".
std::string in_words(const ParameterId& parameter);

/// "Entry" alone, where its section has been named.
std::string entry_in_words(const ParameterId& parameter);

/// The command between backticks; "Feldspar" where there are no commands.
std::string in_words(Work work);

/// A parameter that cannot be used: "Section/Entry = value: reason".
struct ParameterError : InputError
{
  ParameterError(const ParameterId& parameter, std::string value, std::string reason);
  ParameterError(const ParameterId& parameter, std::string reason);

  ParameterId parameter;
  std::string value;  ///< with its unit; empty: the reason says it
  std::string reason; ///< what is wrong, what is allowed
};
} // namespace feldspar
