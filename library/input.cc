#include "app/input/parameter_table.h"
#include "base/table/quantity.h"
#include "feldspar_version.h"
#include "library/states.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <mutex>
#include <optional>

namespace feldspar::v1
{
Error::~Error() = default;
Stopped::~Stopped() = default;
const char* Stopped::what() const noexcept { return "stopped"; }

std::string version() { return std::string(feldspar::version); }

void set_threads(const std::size_t n)
{
  static std::mutex one_at_a_time;
  static std::optional<tbb::global_control> limit;
  const std::lock_guard lock(one_at_a_time);
  limit.reset();
  if (n > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, n);
}

double in_si(const std::string_view text, const std::string_view quantity)
{
  const std::map<std::string_view, Dimension> known{
    {"stress", feldspar::stress}, {"length", length}, {"angle", angle},
    {"density", density},         {"rate", rate},     {"duration", duration}};
  const auto found = known.find(quantity);
  if (found == known.end())
    throw Error(
      fmt::format("{}: no such quantity; there are stress, length, angle, density, rate and duration", quantity));
  return guarded([&] { return parse_quantity(text, found->second); });
}

std::vector<EntryDescription> entries()
{
  std::vector<EntryDescription> all;
  for (const Parameter& one : parameter_table())
    all.push_back({one.name(), one.unit, one.range, one.default_text(), one.described()});
  return all;
}

namespace
{
/// The entry of a name, "Section/Entry", with a value. Throws InputError.
GivenEntry entry_of(const std::string_view name, const std::string_view value)
{
  const std::size_t slash = name.find('/');
  if (slash == name.npos)
    throw InputError("{}: write \"Section/Entry\", such as \"Specimen/Width\"", name);
  GivenEntry given{std::string(name), std::string(value), "input"};
  check_section(std::string(name.substr(0, slash)), given.place);
  check_name(given);
  return given;
}

std::vector<GivenEntry> entries_of(const std::vector<std::pair<std::string, std::string>>& given)
{
  std::vector<GivenEntry> all;
  for (const auto& [name, value] : given)
    all.push_back(entry_of(name, value));
  return all;
}
} // namespace

feldspar::Input InputState::read() const { return read_input(GivenEntries(entries_of(given)), folder); }

Input::Input()
  : of(std::make_shared<InputState>())
{
}

Input::Input(const std::string& file)
  : Input()
{
  guarded([&] {
    const GivenEntries values{std::filesystem::path(file)};
    of->folder = std::filesystem::absolute(file).parent_path();
    for (const GivenEntry& one : values.all())
      of->given.emplace_back(one.name, one.value);
    read_input(values, of->folder); // errors name the lines of the file
  });
}

Input::Input(const Input& other)
  : of(std::make_shared<InputState>(*other.of))
{
}

Input& Input::operator=(const Input& other)
{
  of = std::make_shared<InputState>(*other.of);
  return *this;
}

Input::~Input() = default;

void Input::set(const std::string_view entry, const std::string_view value)
{
  guarded([&] {
    const GivenEntry given = entry_of(entry, value);
    feldspar::Input scratch;
    scratch.folder = of->folder;
    rephrased([&] { find_parameter(entry)->read(scratch, value); },
              [&](const std::string& what) { return GivenEntries({given}).error(given.name, what); });
  });
  const auto known = std::ranges::find_if(of->given, [&](const auto& one) { return one.first == entry; });
  if (known == of->given.end())
    of->given.emplace_back(entry, value);
  else
    known->second = value;
}

std::string Input::get(const std::string_view entry) const
{
  return guarded([&] { return GivenEntries(entries_of(of->given)).value(entry_of(entry, "").name); });
}

void Input::unset(const std::string_view entry)
{
  guarded([&] { entry_of(entry, ""); });
  std::erase_if(of->given, [&](const auto& one) { return one.first == entry; });
}

const std::vector<std::pair<std::string, std::string>>& Input::given() const { return of->given; }

void Input::check() const
{
  guarded([&] { of->read(); });
}
} // namespace feldspar::v1
