#pragma once

#include "app/input/input.h"
#include "base/entries.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// One entry of the input: all there is to know about it.
struct Parameter
{
  std::string section;
  std::string_view entry;
  std::string unit; ///< in which it is shown; any other of its dimension may be written
  std::string range;
  std::string_view meaning;
  EntryFlags flags;
  std::optional<ParameterId> id;                      ///< of the member that it fills, by which libraries name it
  std::function<void(Input&, std::string_view)> read; ///< throws InputError, which says what is allowed
  std::function<std::string(const Input&)> write;     ///< as it would stand in an input file
  std::string name() const;                           ///< Section/Entry
  std::string default_text() const;
  std::string described() const; ///< the meaning, and the demands on other entries
};

/// The text of an entry that is not used.
inline constexpr std::string_view none = "none";
/// The range of every entry that names a file.
inline constexpr std::string_view none_or_a_file = "none, or a file";

/// The text, or `none` in place of an empty one.
std::string or_none(std::string text);

/// Every parameter, in the order of the reference. Reading, checking and the reference walk this.
const std::vector<Parameter>& parameter_table();

/// The sections in the order of the table, each once.
std::vector<std::string_view> section_names();

/// The entries of a section in the order of the table; none if there is no such section.
std::vector<std::string_view> entry_names(std::string_view section);

/// Parameter by its name, "Section/Entry"; null if there is none of that name.
const Parameter* find_parameter(std::string_view name);

/// Returns whether a flaw or mineral grains put smooth joints into the rock.
bool has_smooth_joints(const Input& input);

/// False for the sections of joint laws other than the input's own, and of smooth joints where there are none.
bool has_use_for(const Input& input, const Parameter& parameter);

/// The first of its demands on other entries that this input does not meet; null if there is none.
const Demand* unmet_demand(const Input& input, const Parameter& parameter);

/// Section and entry of a parameter that a library names; of one that the input does not have its name in the code.
InputPlace place_of(const ParameterId& id);

/// Sentences on the entries of all variants, each once.
std::vector<std::string> sentences_on(const std::vector<Variant>& variants,
                                      std::string (*sentence_on)(const Input&, const Parameter&));

/// Refuses entries that have no use on this body, unless they keep their defaults. Throws InputError.
void check_body(const Input& input, Body body);
} // namespace feldspar
