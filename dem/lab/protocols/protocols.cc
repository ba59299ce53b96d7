#include "dem/lab/protocols/protocols.h"

#include "base/contains.h"
#include "base/mapped.h"
#include "base/parameter_id.h"
#include "dem/flaws/clumps.h"
#include "laboratory/entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <stdexcept>

namespace feldspar
{
namespace
{
std::string names_of(const std::function<bool(const LaboratoryProtocol&)>& is_wanted)
{
  std::vector<TestKind> kinds;
  for (const LaboratoryProtocol* protocol : laboratory_protocols())
    if (is_wanted(*protocol))
      kinds.push_back(protocol->kind);
  return names(kinds);
}
} // namespace

const std::vector<const LaboratoryProtocol*>& laboratory_protocols()
{
  static const std::vector<const LaboratoryProtocol*> all{
    &direct_tension,       &uniaxial_compression, &triaxial_compression, &brazilian,   &three_point_bending,
    &semicircular_bending, &centre_cracked_plate, &direct_shear,         &own_loading, &tilt};
  return all;
}

std::vector<Entry<TestParameters>> test_entries()
{
  std::vector<Entry<TestParameters>> all;
  std::vector<OwnEntries> taken;
  for (const LaboratoryProtocol* protocol : laboratory_protocols())
    for (const OwnEntries entries : protocol->own_entries)
      if (entries && !contains(taken, entries))
        {
          taken.push_back(entries);
          std::ranges::copy(entries(), std::back_inserter(all));
        }
  std::ranges::copy(common_test_entries(), std::back_inserter(all));
  return all;
}

std::vector<TestKind> kinds_that_take(const std::string_view entry)
{
  std::vector<TestKind> kinds;
  for (const LaboratoryProtocol* protocol : laboratory_protocols())
    for (const OwnEntries entries : protocol->own_entries)
      if (entries && std::ranges::any_of(entries(), [&](const auto& one) { return one.name == entry; }))
        kinds.push_back(protocol->kind);
  return kinds;
}

const std::vector<TestKind>& test_kinds()
{
  static const auto kinds = mapped<TestKind>(laboratory_protocols(), &LaboratoryProtocol::kind);
  return kinds;
}

const LaboratoryProtocol& protocol_of(const TestKind& kind)
{
  const auto& all = laboratory_protocols();
  const auto found = std::ranges::find_if(all, [&](const auto* one) { return one->kind == kind; });
  if (found == all.end())
    throw std::logic_error(fmt::format("\"{}\" is in no list of laboratory tests", kind.name));
  return **found;
}

std::string objection_to_finite_elements(const TestKind& kind)
{
  if (kind.runs_on_finite_elements)
    return "";
  return fmt::format("{}: {}: the sample stands between platens; it makes {}", in_words(parameters_id<TestKind>()),
                     kind.name, names_of([](const auto& one) { return one.kind.runs_on_finite_elements; }));
}

std::string objection_to_clumps(const TestKind& kind)
{
  if (protocol_of(kind).takes_clumps)
    return "";
  return fmt::format("{} takes no clumps; take it out, or set {} = none; tests that take them: {}", kind.name,
                     in_words(parameter_id<&ClumpParameters::diameter>()),
                     names_of([](const auto& one) { return one.takes_clumps; }));
}

std::string objection_to_grains(const TestKind& kind, const Body body)
{
  const auto is_made = [=](const LaboratoryProtocol& one) {
    return body == Body::plane_box ? one.set_up<2>().has_value()
                                   : one.set_up<3>().has_value() && (body != Body::cylinder || one.takes_cylinders);
  };
  if (is_made(protocol_of(kind)))
    return "";
  return fmt::format("{}: {}: is not made on {}; tests that are: {}", in_words(parameters_id<TestKind>()), kind.name,
                     body == Body::plane_box ? "boxes of discs"
                     : body == Body::box     ? "boxes of spheres"
                                             : "cylinders of spheres",
                     names_of(is_made));
}
} // namespace feldspar
